"""Two-bone inverse kinematics with pole hints, and bone frames. All inputs may carry leading axes.

A limb is a root, a middle joint (elbow, knee) and an end (wrist, ankle). Its ``hinge`` is the unit
axis about which the middle joint flexes; ``pole`` points to where the middle joint should bulge.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .rotations import across, cross, norm, unit

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Limb:
    """Solved limb: positions [..., 3] of middle and end, and the hinge axis [..., 3]."""

    middle: Array
    end: Array
    hinge: Array


def soft_length(distance: Array, full: Array | float, start: float = 0.965, stop: float = 0.998) -> Array:
    """Distance a limb of length ``full`` really spans for a wished one: exact up to ``start`` of it,
    then creeping towards ``stop`` without ever snapping straight."""
    x = distance / full
    span = stop - start
    soft = start + span * (1.0 - np.exp(-np.maximum(x - start, 0.0) / span))
    out: Array = np.where(x > start, soft, x) * full
    return out


def two_bone(
    root: Array,
    target: Array,
    upper: Array | float,
    lower: Array | float,
    pole: Array,
    soft: bool = True,
    fold: float = 2.8,
) -> Limb:
    """Reaches from ``root`` [..., 3] for ``target`` [..., 3] with bones of lengths ``upper``, ``lower``.

    A target too far is approached in its direction. The middle joint never passes straight, and bends by
    ``fold`` radians at most.
    """
    offset = target - root
    wished = norm(offset)
    axis = offset / np.maximum(wished, 1e-9)[..., None]
    full = np.asarray(upper + lower)
    reach = soft_length(wished, full) if soft else np.minimum(wished, full * 0.9999)
    closed = np.sqrt(np.asarray(upper**2 + lower**2 + 2.0 * upper * lower * np.cos(fold)))
    reach = np.maximum(reach, closed)
    cosine = np.clip((upper**2 + reach**2 - lower**2) / (2 * upper * reach), -1.0, 1.0)
    sine = np.sqrt(1.0 - cosine**2)
    side = across(pole, axis)
    middle = root + axis * (upper * cosine)[..., None] + side * (upper * sine)[..., None]
    return Limb(middle, root + axis * reach[..., None], cross(side, axis))


def bind_frame(bind: Array, bind_side: Array) -> Array:
    """[..., 3, 3], what :func:`bone_rotation` needs of the bind pose: the bone's direction [..., 3], and
    where it swings to on flexing [3]."""
    b = unit(bind)
    s = across(bind_side, b)
    return np.stack([b, s, cross(b, s)], axis=-2)


def bone_rotation(direction: Array, hinge: Array, frame: Array) -> Array:
    """World rotation of a bone that points along ``direction`` with its flexion axis on ``hinge``.

    frame: its :func:`bind_frame`, broadcast against the leading axes
    """
    d = unit(direction)
    e = unit(cross(hinge, d))
    world = np.empty((*d.shape, 3))
    world[..., 0], world[..., 1], world[..., 2] = d, e, cross(d, e)
    return world @ frame
