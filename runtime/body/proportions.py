"""From a :class:`BodySpec` to the lengths of a body and to its skeleton.

Adults stand about 7.15 heads tall with slightly large heads and hands, children about 5.7: a shade
above life, so that faces and gestures read at the size of a storyboard picture.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .skeleton import JOINT, JOINTS, Skeleton
from .spec import BodySpec

#: How far hats, and hair where no hat is on it, rise above the crown as they are modelled, in heads; others
#: hardly rise above short hair.
_SHORT = 0.083
_RISES = {
    "cap": 0.15, "police-cap": 0.17, "beanie": 0.20, "beret": 0.14, "brimmed-hat": 0.25, "straw-hat": 0.14,
    "toque": 0.46, "hard-hat": 0.27, "fire-helmet": 0.36, "helmet": 0.23, "crown": 0.22, "tricorn": 0.18,
    "wizard-hat": 1.01, "nurse-cap": 0.14, "scrub-cap": 0.12, "hood": 0.21, "veil": 0.13,
    "knight-helmet": 0.45, "space-helmet": 0.23,
    "bun": 0.12, "curly": 0.19, "afro": 0.25, "mohawk": 0.27, "topknot": 0.20,
}  # fmt: skip


@dataclass(frozen=True)
class Proportions:
    """Lengths in metres, of one spec; heights are above the floor.

    ``head`` is chin to crown; ``arm`` is the unit direction of the left arm in the bind pose;
    ``girth`` scales the thickness of limbs and ``belly`` that of the waist.
    """

    height: float
    head: float
    chin: float
    neck: float
    shoulder: tuple[float, float]
    hip: tuple[float, float]
    pelvis: float
    knee: float
    ankle: float
    upper_arm: float
    forearm: float
    hand: float
    foot: float
    stoop: float
    girth: float
    belly: float


def _mix(a: float, b: float, t: float) -> float:
    return a + (b - a) * t


def proportions(spec: BodySpec) -> Proportions:
    """The lengths a spec stands for."""
    h, c, e, f = spec.height, spec.youth, spec.eld, spec.femininity
    head = h / _mix(_mix(7.25, 7.1, f), 5.75, c) * (1.0 + 0.02 * e)
    chin = h - head
    build = spec.build
    shoulder_half = h * _mix(_mix(0.1005, 0.087, f) + 0.010 * (build - 0.42), 0.088, c)
    return Proportions(
        height=h,
        head=head,
        chin=chin,
        neck=chin - h * _mix(0.037, 0.028, c),
        shoulder=(shoulder_half, chin - h * _mix(0.061, 0.052, c)),
        hip=(h * _mix(_mix(0.051, 0.053, f) + 0.004 * (build - 0.42), 0.053, c), h * _mix(0.530, 0.478, c)),
        pelvis=h * _mix(0.562, 0.507, c),
        knee=h * _mix(0.288, 0.263, c),
        ankle=h * _mix(0.044, 0.046, c),
        upper_arm=h * _mix(0.168, 0.155, c),
        forearm=h * _mix(0.147, 0.138, c),
        hand=h * _mix(_mix(0.113, 0.108, f), 0.113, c),
        foot=h * _mix(_mix(0.153, 0.144, f), 0.156, c),
        stoop=e,
        girth=_mix(0.90, 1.28, build) * _mix(1.0, 0.92, f) * _mix(1.0, 1.04, c),
        belly=_mix(0.88, 1.5, build) + 0.06 * e,
    )


def make_skeleton(spec: BodySpec) -> Skeleton:
    """The skeleton of a spec in the bind pose: standing on Z = 0, facing +X, arms 45° out, legs straight."""
    p = proportions(spec)
    h, head = p.height, p.head
    lean = 0.016 * h * p.stoop
    bind: dict[str, tuple[float, float, float]] = {
        "hips": (0.0, 0.0, p.pelvis),
        "spine": (0.0, 0.0, _mix(p.pelvis, p.shoulder[1], 0.22)),
        "chest": (-0.004 * h, 0.0, _mix(p.pelvis, p.shoulder[1], 0.55)),
        "neck": (-0.008 * h + 0.5 * lean, 0.0, p.neck - 0.012 * h),
        "head": (0.002 * h + 1.6 * lean, 0.0, p.chin + 0.20 * head),
    }
    hx, _, _ = bind["head"]
    bind["jaw"] = bind["lip"] = (hx + 0.06 * head, 0.0, p.chin + 0.32 * head)
    sides = {**_face(hx, p.chin, head), **_arm(p, 0.8 * lean), **_leg(p)}
    for name, (x, y, z) in sides.items():
        bind[f"{name}_l"] = (x, y, z)
        bind[f"{name}_r"] = (x, -y, z)
    positions: NDArray[np.float64] = np.zeros((len(JOINTS), 3))
    for name, at in bind.items():
        positions[JOINT[name]] = at
    rise = _RISES.get(spec.hat, _RISES.get(spec.hair, _SHORT))
    return Skeleton(positions, h, head * max(0.0, rise - _SHORT))


def _face(hx: float, chin: float, head: float) -> dict[str, tuple[float, float, float]]:
    """Left-hand joints of the face; brows and mouth corners turn about points inside the head."""
    eye = (hx + 0.235 * head, 0.150 * head, chin + 0.470 * head)
    brow = (hx + 0.02 * head, 0.15 * head, chin + 0.58 * head)
    return {
        "eye": eye,
        "lid": eye,
        "underlid": eye,
        "brow": brow,
        "browin": brow,
        "mouth": (hx + 0.06 * head, 0.10 * head, chin + 0.22 * head),
    }


def _arm(p: Proportions, lean: float) -> dict[str, tuple[float, float, float]]:
    s = 0.5**0.5
    y, z = p.shoulder
    x = -0.008 * p.height + lean

    def along(length: float, forward: float = 0.0, palm: float = 0.0) -> tuple[float, float, float]:
        """A point down the arm, moved forward and towards the palm's side."""
        return (x + forward, y + s * length - s * palm, z - s * length - s * palm)

    wrist = p.upper_arm + p.forearm
    k = p.hand
    return {
        "clavicle": (x + 0.012 * p.height, 0.16 * y, z + 0.006 * p.height),
        "upperarm": (x, y, z),
        "forearm": along(p.upper_arm),
        "hand": along(wrist),
        "fingers": along(wrist + 0.50 * k),
        "fingertips": along(wrist + 0.73 * k),
        "index": along(wrist + 0.50 * k, 0.15 * k),
        "indextip": along(wrist + 0.73 * k, 0.16 * k),
        "thumb": along(wrist + 0.16 * k, 0.15 * k, 0.06 * k),
    }


def _leg(p: Proportions) -> dict[str, tuple[float, float, float]]:
    y, hip = p.hip
    return {
        "thigh": (0.0, y, hip),
        "shin": (0.0, y, p.knee),
        "foot": (0.0, y, p.ankle),
        "toe": (0.50 * p.foot, y, 0.10 * p.foot),
    }
