"""Places on one's own body that a palm may go to."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from runtime.body.skeleton import JOINT

from .figure import Figure
from .rotations import dot, unit

Array = NDArray[np.float64]


def body_place(figure: Figure, place: str, hand: int, yaw: Array) -> Array:
    """[T, 3]: a place on the person's own body for a palm of that hand (0 left, 1 right)."""
    bind, h = figure.skeleton.bind, figure.skeleton.height
    m = 1.0 - 2.0 * hand
    eye = bind[JOINT["eye_l"]] - bind[JOINT["head"]]
    mouth_z = bind[JOINT["mouth_l"]][2] - bind[JOINT["head"]][2]
    on_head = {
        "mouth": (1.42 * eye[0], 0.0, mouth_z),
        "ear": (0.45 * eye[0], m * 2.7 * eye[1], 0.05 * eye[2]),
        "chin": (1.25 * eye[0], m * 0.3 * eye[1], mouth_z - 0.85 * eye[2]),
        "head": (0.2 * eye[0], m * 1.9 * eye[1], 2.3 * eye[2]),
        "eyes": (1.75 * eye[0], m * 0.8 * eye[1], eye[2]),
        "cheek": (1.15 * eye[0], m * 2.4 * eye[1], mouth_z),
        "forehead": (1.35 * eye[0], m * 1.0 * eye[1], 1.75 * eye[2]),
        "neck": (-1.05 * eye[0], m * 0.6 * eye[1], 0.9 * mouth_z),
    }
    if place in on_head:
        return figure.point("head", np.array(on_head[place]))
    shoulder = bind[JOINT["upperarm_l"]] - bind[JOINT["chest"]]
    on_chest = {
        "chest": (0.105 * h, m * 0.35 * shoulder[1], 0.35 * shoulder[2]),
        "heart": (0.105 * h, 0.25 * shoulder[1], 0.45 * shoulder[2]),
        "front": (0.24 * h, m * 0.75 * shoulder[1], -0.06 * h),
        "elbow": (0.12 * h, -m * 0.75 * shoulder[1], -0.08 * h),
        "belly": (0.115 * h, m * 0.15 * shoulder[1], -0.10 * h),
        "shoulder": (0.105 * h, -m * 0.8 * shoulder[1], 0.8 * shoulder[2]),
        "back": (-0.1 * h, m * 0.2 * shoulder[1], -0.14 * h),
    }
    if place in on_chest:
        return figure.point("chest", np.array(on_chest[place]))
    if place in ("lap", "thigh", "knee"):
        side = "lr"[hand]
        hip, knee = (figure.position[:, JOINT[f"{j}_{side}"]] for j in ("thigh", "shin"))
        along = unit(knee - hip)
        square = np.stack([np.cos(yaw), np.sin(yaw), np.ones_like(yaw)], axis=1)
        square = unit(square - dot(square, along)[:, None] * along)
        out: Array = hip + {"lap": 0.62, "thigh": 0.7, "knee": 0.97}[place] * (knee - hip)
        if place == "lap":
            out[:, 2] += 0.062 * h
            return out
        return np.asarray(out + (0.052 if place == "thigh" else 0.046) * h * square)
    if place == "floor":
        feet = [figure.position[:, JOINT[f"foot_{s}"]] for s in "lr"]
        middle: Array = 0.5 * (feet[0] + feet[1])
        middle[:, 2] = np.minimum(feet[0][:, 2], feet[1][:, 2]) - bind[JOINT["foot_l"]][2]
        return middle
    hip_y = bind[JOINT["thigh_l"]][1]
    return figure.point("hips", np.array([0.035 * h, m * (hip_y + 0.055 * h), 0.035 * h]))
