"""``rig paper`` recomputed from a take's params and the subject's positions alone.

Nothing of ``vdsl.cinema`` is imported: the equations stand here a second time, written from the paper
(section 3.2) and docs/cinema.md, and the tracks must equal them to 1e-6.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from filmset import shot, skeleton, standing, story, world
from numpy.typing import NDArray

from vdsl.lang.ir import ANGLES, MOVEMENTS
from vdsl.propose.cameras import Filming, propose_cameras
from vdsl.propose.types import CameraProposal

HEIGHT = 1.73


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


def takes(
    movement: str, angle: str, scale: str, seed: int
) -> tuple[tuple[CameraProposal, ...], NDArray[np.float64]]:
    rng = np.random.default_rng([seed, len(movement)])
    frames = int(rng.integers(24, 60))
    t = np.linspace(0, 1, frames)[:, None]
    way = rng.normal(scale=0.5, size=3) * t + rng.normal(scale=0.1, size=3) * np.sin(3 * t)
    path = way * (1, 1, 0) + rng.normal(size=3) * (3, 3, 0)
    body = skeleton(HEIGHT)
    acted = story({"anna": standing(body, path, rng.uniform(-3, 3) + 0.4 * t[:, 0])})
    filming = Filming(world(), {"anna": body}, 24.0, seed, rig="paper")
    return propose_cameras(shot(movement, scale, angle, roll=0.1 * seed), [acted], filming).cameras, path


@pytest.mark.parametrize("angle", ANGLES)
@pytest.mark.parametrize("movement", MOVEMENTS)
def test_tracks_equal_the_equations(movement: str, angle: str) -> None:
    checked = 0
    for seed, scale in enumerate(("close-up", "medium", "full")):
        cameras, path = takes(movement, angle, scale, seed)
        for camera in cameras:
            position, rotation, focal = recomputed(camera.movement, camera.params, path)
            np.testing.assert_allclose(camera.track.position, position, atol=1e-6)
            np.testing.assert_allclose(camera.track.focal, focal, atol=1e-6)
            turned = camera.track.rotation - rotation
            turned[:, 2] -= 2 * np.pi * np.round(turned[:, 2] / (2 * np.pi))
            np.testing.assert_allclose(turned, 0.0, atol=1e-6)
            checked += 1
    assert checked >= 30


@pytest.mark.parametrize(("scale", "share"), [("close-up", 0.2), ("medium", 0.5), ("full", 1.0)])
def test_distances_and_angles_are_as_printed(scale: str, share: float) -> None:
    for angle, theta in (
        ("eye-level", math.pi / 2),
        ("high-angle", 2 * math.pi / 5),
        ("low-angle", 4 * math.pi / 5),
    ):
        cameras, _ = takes("static", angle, scale, 0)
        assert cameras
        for camera in cameras:
            assert camera.params["theta"] == pytest.approx(theta)
            assert camera.params["r"] == pytest.approx(share * HEIGHT)
            assert camera.track.focal[0] == pytest.approx(50.0)
            assert camera.track.sensor[1] == 50.0
