"""What people hide: somebody else behind them, and their own head where they bend away from the camera.

Assumes performed people with arms. A body is a trunk and either arm up to the shoulders, and the head up to
the top of hat or hair, each an upright pillar.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from .framing import Array
from .subject import Subject, marks_at
from .takes import Bools
from .vectors import dot, length

#: Foot and crown [T, 3], and radius in metres.
Pillar = tuple[Array, Array, float]

#: Radii, metres: of the trunk, which is wider than it is deep, and of a shoulder with the arm that hangs from
#: it; of a head with its hair, and how much a hat or high hair may add.
_TRUNK, _ARM = 0.17, 0.1
_SKULL, _HAT = 0.14, 0.04
#: Share of the way from the waist to the thighs at which the hips are; radius of a trunk that is in the way
#: of the own head, and how far before that it has to be: metres.
_HIPS, _BACK, _APART = 0.35, 0.15, 0.2
#: Radii of what a camera may not enter: trunk, head from chin to crown, and arms in wide sleeves: metres.
_CHEST, _HEAD, _SLEEVE = 0.17, 0.12, 0.09
_ALONG = (0.0, 0.5, 1.0)  # of the way from waist to chest


@lru_cache(maxsize=64)  # asked for again for every few cameras
def pillars(one: Subject) -> tuple[Pillar, ...]:
    """Somebody as pillars that hide what is behind them."""
    marks, floor = one.landmarks, one.position[:, 2]
    trunk = np.column_stack([marks["waist"][:, :2], marks["collar"][:, 2]])
    out = [(_down(marks["waist"], floor), trunk, _TRUNK)]
    arms = one.arms if one.arms is not None else np.zeros((one.frames, 0, 3, 3))
    for shoulder in np.moveaxis(arms[:, :, 0], 1, 0):
        out.append((_down(shoulder, floor), shoulder + np.array((0.0, 0.0, _ARM / 2)), _ARM))
    above = float(length(marks["top"] - marks["crown"]).max())
    return (*out, (_down(marks["crown"], floor), marks["top"], _SKULL + min(above, _HAT)))


def behind_own_back(one: Subject, at: NDArray[np.int64], camera: Array) -> Bools:
    """Whether somebody's head is behind their own hips, waist or chest, as of who bends down and away:
    camera [P, F, 3] -> bool [P, F]."""
    trunk = _trunk(one, tuple(at.tolist()))
    ray = (one.landmarks["eyes"][at] - camera)[:, :, None]
    away = np.maximum(length(ray), 1e-6)
    start = trunk[None] - camera[:, :, None]
    along = dot(start, ray) / away  # metres from the camera
    beside = np.sqrt(np.maximum(dot(start, start) - along**2, 0.0))
    hides = (beside < _BACK) & (along > 0.0) & (along < away - _APART)
    return np.asarray(hides.any(axis=-1))


@lru_cache(maxsize=64)
def limbs(one: Subject) -> tuple[Pillar, ...]:
    """Trunk, head and arms of somebody as they bend and reach, from end to end: what no camera may enter."""
    marks = one.landmarks
    hips = marks["waist"] + _HIPS * (marks["thigh"] - marks["waist"])
    out = [(hips, marks["waist"], _CHEST), (marks["waist"], marks["collar"], _CHEST)]
    out.append((marks["chin"], marks["crown"], _HEAD))
    if one.arms is not None:
        out += [(one.arms[:, k, j], one.arms[:, k, j + 1], _SLEEVE) for k in (0, 1) for j in (0, 1)]
    return tuple(out)


@lru_cache(maxsize=64)
def _trunk(one: Subject, frames: tuple[int, ...]) -> Array:
    """Points of somebody's hips, waist and chest, [F, K, 3]; not to be written to."""
    waist, chest, thigh = np.moveaxis(marks_at(one, ("waist", "pocket", "thigh"), np.array(frames)), 1, 0)
    hips = waist + _HIPS * (thigh - waist)
    return np.stack([hips, *(waist + share * (chest - waist) for share in _ALONG)], axis=1)


def _down(points: Array, floor: Array) -> Array:
    """What is below points [T, 3] on the floor they stand on."""
    return np.column_stack([points[:, :2], floor])
