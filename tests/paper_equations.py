"""The paper's camera equations (section 3.2), written a second time for the tests.

Nothing of ``vdsl.cinema`` is imported: what stands here comes from the paper and docs/cinema.md.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray


def w(lam: float, t: float) -> float:
    return t if lam == 1.0 else (lam**t - 1.0) / (lam - 1.0)


def sphere(r: float, theta: float, phi: float) -> NDArray[np.float64]:
    return r * np.array([math.cos(phi) * math.sin(theta), math.sin(phi) * math.sin(theta), math.cos(theta)])


def recomputed(
    movement: str, p: dict[str, float | str], path: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Positions [T, 3], (roll, pitch, yaw) [T, 3] and focal lengths [T] by the equations alone."""
    T, kind = len(path), movement.split("-")[0]
    v = {k: float(x) for k, x in p.items() if not isinstance(x, str)}
    up = np.array([0.0, 0.0, v["reference_height"]])
    key = path[-1] if p["reference"] == "end" else path[0]
    positions, looks, focals = [], [], []

    def off_floor(c: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.array([c[0], c[1], max(c[2], v["floor_clearance"])])

    def between(time: float) -> NDArray[np.float64]:
        i = min(int(time * (T - 1)), T - 2)
        f = time * (T - 1) - i
        return (1 - f) * path[i] + f * path[i + 1]

    def ahead(pitch: float, yaw: float) -> NDArray[np.float64]:
        return np.array([math.cos(pitch) * math.cos(yaw), math.cos(pitch) * math.sin(yaw), math.sin(pitch)])

    framed = off_floor(key + up + sphere(v["r"], v["theta"], v["phi"]))
    level = key + up - framed
    for t in range(T):
        e = w(v["lambda"], t / (T - 1))
        focal, p_hat = v["focal"], path[t] + up
        if kind == "static":
            camera, look = framed, level
        elif kind == "follow":
            camera = off_floor(between(e) + up + sphere(v["r"], v["theta"], v["phi"]))
            look = p_hat - camera
        elif kind in ("push", "pull"):
            r = ((v["mu"] - 1) * e + 1) * v["r"]
            camera = off_floor(p_hat + sphere(r, v["theta"], v["phi"]))
            look = p_hat - camera
        elif kind == "zoom":
            camera = off_floor(path[0] + up + sphere(v["r"], v["theta"], v["phi"]))
            look = p_hat - camera
            focal = v["focal"] / ((v["mu"] - 1) * e + 1)
        elif kind == "arc":
            camera = off_floor(p_hat + sphere(v["r"], v["theta"], v["phi"] + v["turn"] * e))
            look = p_hat - camera
        elif kind in ("dolly", "pedestal"):
            start, end = (np.array([v[f"{s}_{a}"] for a in "xyz"]) for s in ("start", "end"))
            camera, look = start + e * (end - start), level
        else:
            angle = v["turn"] * (e - 1 if p["ending"] == "on" else e)
            pitch = math.atan2(level[2], math.hypot(level[0], level[1]))
            yaw = math.atan2(level[1], level[0])
            tilts = kind == "tilt"
            camera = framed
            look = ahead(pitch + angle, yaw) if tilts else ahead(pitch, yaw + angle)
        positions.append(camera)
        looks.append(look)
        focals.append(focal)
    d = np.array(looks)
    pitch = np.arctan2(d[:, 2], np.hypot(d[:, 0], d[:, 1]))
    rotation = np.stack([np.full(T, v["roll"]), pitch, np.arctan2(d[:, 1], d[:, 0])], axis=1)
    return np.array(positions), rotation, np.array(focals)
