"""Places on somebody else's body, and the point at which two people hold hands.

Assumes the other figure's torso is posed. Positions are metres in the world.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from runtime.body.skeleton import JOINT

from .figure import Figure

Array = NDArray[np.float64]

#: How a palm lies on each place: fingers inward, fingers up, thumb over.
LIE: dict[str, tuple[float, float, float]] = {
    "shoulder": (0.1, 0.35, 1.15), "hand": (0.3, 0.0, 0.0), "back": (1.45, 0.25, 0.0),
    "waist": (0.95, 0.1, 0.0), "head": (0.3, 0.9, 0.4), "cheek": (0.35, 0.8, 0.0),
    "chest": (0.2, 1.15, 0.0), "elbow": (0.4, 0.2, 0.0), "belly": (0.3, 0.2, 0.0),
}  # fmt: skip


def partner_place(other: Figure, place: str, hand: int, faced: bool) -> Array:
    """[T, 3]: a place on the other person for a palm of that hand (0 left, 1 right).

    faced: whether the two face each other, so that the other's right is before one's left
    """
    bind, h = other.skeleton.bind, other.skeleton.height
    side = 1 - hand if faced else hand
    m, s = 1.0 - 2.0 * side, "lr"[side]
    eye = bind[JOINT["eye_l"]] - bind[JOINT["head"]]
    mouth = bind[JOINT["mouth_l"]][2] - bind[JOINT["head"]][2]
    shoulder = bind[JOINT["upperarm_l"]] - bind[JOINT["chest"]]
    on_chest = {
        "shoulder": (0.01 * h, m * 0.86 * shoulder[1], shoulder[2] + 0.05 * h),
        "back": (-0.092 * h, m * 0.045 * h, 0.35 * shoulder[2]),
        "chest": (0.115 * h, m * 0.04 * h, 0.5 * shoulder[2]),
        "belly": (0.12 * h, 0.0, -0.09 * h),
    }
    if place in on_chest:
        return other.point("chest", np.array(on_chest[place]))
    if place == "waist":
        return other.point("spine", np.array((-0.03 * h, m * 0.10 * h, -0.01 * h)))
    if place == "head":
        return other.point("head", np.array((0.1 * eye[0], m * 2.0 * eye[1], 2.1 * eye[2])))
    if place == "cheek":
        return other.point("head", np.array((0.95 * eye[0], m * 2.2 * eye[1], mouth)))
    if place == "elbow":
        return other.point(f"forearm_{s}", np.array((0.0, m * 0.025 * h, 0.0)))
    offset = other.hands.offset[side, 0]
    return other.point(f"hand_{s}", offset)
