"""Low postures: how hips, feet and hands lie in each, and which ones lie between two of them.

A posture is a row of numbers over the root, the floor point below the hips, seen along the heading.
Knees and elbows follow from inverse kinematics. Standing and sitting on a seat are not rows: they come
of the legs and of the seat (:mod:`.acting`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from runtime.body.skeleton import JOINT, Skeleton

from .feet import rolled

Triple = tuple[float, float, float]


@dataclass(frozen=True)
class Row:
    """One posture of one skeleton, metres and radians.

    hip: hip joints above the floor; pitch: of the pelvis; lean: of the spine on top; nod: of the head on top
    feet: of left and right, ankle ahead and out of the root, and heel up; poles: where the knees point
        (ahead, out, up)
    palms: where both palms are planted, ahead, out and up; on: a place on the body they rest on; both None:
        they hang
    swing: forward of hanging arms; splay: of the feet, to the outside
    """

    hip: float
    pitch: float
    lean: float
    nod: float
    feet: tuple[Triple, Triple]
    poles: tuple[Triple, Triple]
    palms: Triple | None = None
    on: str | None = None
    swing: float = 0.0
    splay: float = 0.1


#: How one gets from one posture to another: what lies between it and standing, seconds for that last bit,
#: and how far the root goes forward meanwhile (shares of height).
WAYS: dict[str, tuple[str, float, float]] = {
    "crouching": ("standing", 0.85, 0.0),
    "kneeling": ("standing", 1.6, -0.02),
    "one-knee": ("standing", 1.25, -0.13),
    "floor": ("standing", 1.9, -0.33),
    "lying": ("floor", 1.5, 0.0),
    "fours": ("kneeling", 0.95, -0.02),
    "prone": ("plank", 1.0, 0.0),
    "plank": ("fours", 0.9, 0.06),
}


def between(start: str, end: str) -> list[str]:
    """Postures to go through, from the one after ``start`` to ``end``."""
    up, down = _to_standing(start), _to_standing(end)
    common = next(p for p in up if p in down)
    return [*up[1 : up.index(common) + 1], *reversed(down[: down.index(common)])]


def _to_standing(posture: str) -> list[str]:
    way = [posture]
    while way[-1] in WAYS:
        way.append(WAYS[way[-1]][0])
    return way


def row(posture: str, skeleton: Skeleton) -> Row:
    """The row of a posture for a body."""
    bind, h = skeleton.bind, skeleton.height
    thigh = float(bind[JOINT["thigh_l"]][2] - bind[JOINT["shin_l"]][2])
    shin = float(bind[JOINT["shin_l"]][2] - bind[JOINT["foot_l"]][2])
    wide = float(bind[JOINT["thigh_l"]][1])
    trunk = float(bind[JOINT["upperarm_l"]][2] - bind[JOINT["thigh_l"]][2])
    arm = float(np.linalg.norm(bind[JOINT["hand_l"]] - bind[JOINT["upperarm_l"]]))
    knee = 0.034 * h
    tucked = 1.3
    heel = float(bind[JOINT["foot_l"]][2] + rolled(skeleton, np.array(tucked))[1])
    behind = -float(np.sqrt(max(shin**2 - (heel - knee) ** 2, 0.0)))
    down = (1.0, 0.0, -0.5)
    if posture == "crouching":
        foot = (0.0, 1.25 * wide, 0.5)
        return Row(0.17 * h, 0.35, 0.35, -0.3, (foot, foot), ((1.0, 0.35, 0.4),) * 2, on="knee", splay=0.3)
    if posture == "kneeling":
        foot = (behind, 1.1 * wide, tucked)
        return Row(knee + 0.995 * thigh, 0.02, 0.02, 0.0, (foot, foot), (down, down), swing=0.05)
    if posture == "one-knee":
        left, right = (0.13 * h, 1.15 * wide, 0.0), (behind - 0.03 * h, 1.15 * wide, tucked)
        return Row(knee + 0.97 * thigh, 0.05, 0.03, 0.0, (left, right), ((1.0, 0.1, 0.6), down))
    if posture == "floor":
        foot = (0.33 * h, 1.2 * wide, 0.0)
        pole = (0.2, 0.25, 1.0)
        return Row(0.056 * h, -0.28, 0.5, -0.1, (foot, foot), (pole, pole), on="knee")
    if posture == "lying":
        foot = (0.985 * (thigh + shin), 1.3 * wide, -1.15)
        return Row(0.062 * h, -1.57, 0.0, 0.12, (foot, foot), ((0.15, 0.1, 1.0),) * 2, swing=-0.12, splay=0.3)
    if posture == "prone":
        foot = (-0.9995 * (thigh + shin), 1.2 * wide, 2.55)
        out = float(bind[JOINT["upperarm_l"]][1]) + 0.08 * h
        palms = (trunk + 0.13 * h, out, 0.022 * h)
        return Row(0.068 * h, 1.55, 0.0, -0.75, (foot, foot), ((-0.1, 0.0, -1.0),) * 2, palms)
    shoulder = 1.0 * arm + 0.04 * h
    out = float(bind[JOINT["upperarm_l"]][1]) + 0.01 * h
    if posture == "plank":
        long = thigh + shin
        hip = 0.62 * shoulder
        foot = (-float(np.sqrt(max((0.985 * long) ** 2 - (hip - heel) ** 2, 0.0))), 0.9 * wide, tucked)
        pitch = float(np.arccos(np.clip((shoulder - hip) / trunk, -1.0, 1.0)))
        ahead = trunk * float(np.sin(pitch)) + 0.035 * h
        return Row(hip, pitch, 0.0, -0.6, (foot, foot), ((0.1, 0.0, -1.0),) * 2, (ahead, out, 0.022 * h))
    if posture != "fours":
        raise ValueError(f"no such posture: {posture}")
    hip = knee + 0.995 * thigh
    foot = (behind, 1.05 * wide, tucked)
    pitch = float(np.arccos(np.clip((0.87 * shoulder - hip) / trunk, -1.0, 1.0)))
    ahead = trunk * float(np.sin(pitch)) + 0.035 * h
    return Row(hip, pitch - 0.12, 0.24, -0.7, (foot, foot), (down, down), (ahead, out, 0.022 * h))
