"""Rotations of many frames at once: matrices [..., 3, 3] and rotation vectors [..., 3], radians."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def rot_x(angle: Array) -> Array:
    """Turns about X: [...] -> [..., 3, 3]; positive takes Y to Z."""
    return _about(angle, 1, 2)


def rot_y(angle: Array) -> Array:
    """Turns about Y; positive takes Z to X (a nod, a bow)."""
    return _about(angle, 2, 0)


def rot_z(angle: Array) -> Array:
    """Turns about Z; positive takes X to Y (to the left)."""
    return _about(angle, 0, 1)


def _about(angle: Array, i: int, j: int) -> Array:
    angle = np.asarray(angle, dtype=np.float64)
    out = np.zeros((*angle.shape, 3, 3))
    k = 3 - i - j
    c, s = np.cos(angle), np.sin(angle)
    out[..., k, k] = 1.0
    out[..., i, i] = c
    out[..., j, j] = c
    out[..., j, i] = s
    out[..., i, j] = -s
    return out


def rotation(vector: Array) -> Array:
    """Rodrigues: rotation vectors [..., 3] -> matrices."""
    angle = np.linalg.norm(vector, axis=-1)
    x, y, z = vector[..., 0], vector[..., 1], vector[..., 2]
    safe = np.maximum(angle, 1e-12)
    a = np.where(angle < 1e-6, 1.0, np.sin(angle) / safe)
    b = np.where(angle < 1e-6, 0.5, (1.0 - np.cos(angle)) / (safe * safe))
    out = np.empty((*angle.shape, 3, 3))
    out[..., 0, 0] = 1.0 - b * (y * y + z * z)
    out[..., 1, 1] = 1.0 - b * (x * x + z * z)
    out[..., 2, 2] = 1.0 - b * (x * x + y * y)
    out[..., 0, 1] = b * x * y - a * z
    out[..., 1, 0] = b * x * y + a * z
    out[..., 0, 2] = b * x * z + a * y
    out[..., 2, 0] = b * x * z - a * y
    out[..., 1, 2] = b * y * z - a * x
    out[..., 2, 1] = b * y * z + a * x
    return out


def quaternion(matrix: Array) -> Array:
    """Unit quaternions (w, x, y, z) of rotation matrices, w >= 0. Stable for every angle (Bar-Itzhack's
    four candidates, the largest is taken)."""
    m = matrix
    d0, d1, d2 = m[..., 0, 0], m[..., 1, 1], m[..., 2, 2]
    squares = np.stack([1 + d0 + d1 + d2, 1 + d0 - d1 - d2, 1 - d0 + d1 - d2, 1 - d0 - d1 + d2], axis=-1)
    best = np.argmax(squares, axis=-1)
    yz, zx, xy = m[..., 2, 1] - m[..., 1, 2], m[..., 0, 2] - m[..., 2, 0], m[..., 1, 0] - m[..., 0, 1]
    sxy, sxz, syz = m[..., 0, 1] + m[..., 1, 0], m[..., 0, 2] + m[..., 2, 0], m[..., 1, 2] + m[..., 2, 1]
    rows = np.stack(
        [
            np.stack([squares[..., 0], yz, zx, xy], axis=-1),
            np.stack([yz, squares[..., 1], sxy, sxz], axis=-1),
            np.stack([zx, sxy, squares[..., 2], syz], axis=-1),
            np.stack([xy, sxz, syz, squares[..., 3]], axis=-1),
        ],
        axis=-2,
    )
    q = np.take_along_axis(rows, best[..., None, None], axis=-2)[..., 0, :]
    q = q / np.linalg.norm(q, axis=-1, keepdims=True)
    return np.where(q[..., :1] < 0, -q, q)


def rotation_vector(matrix: Array) -> Array:
    """The shortest rotation vector of each matrix."""
    q = quaternion(matrix)
    sine = np.linalg.norm(q[..., 1:], axis=-1)
    angle = 2.0 * np.arctan2(sine, q[..., 0])
    scale = np.where(sine < 1e-9, 2.0, angle / np.maximum(sine, 1e-12))
    return q[..., 1:] * scale[..., None]


def blend(start: Array, end: Array, share: Array) -> Array:
    """The way from ``start`` to ``end`` by ``share`` [...], along the shortest turn."""
    relative = np.swapaxes(start, -1, -2) @ end
    return start @ rotation(rotation_vector(relative) * share[..., None])


def unit(vector: Array) -> Array:
    """Vectors [..., 3] to length 1 (zero stays zero)."""
    return vector / np.maximum(np.linalg.norm(vector, axis=-1, keepdims=True), 1e-12)


def across(vector: Array, axis: Array) -> Array:
    """The part of ``vector`` at right angles to the unit ``axis``, to length 1."""
    return unit(vector - np.sum(vector * axis, axis=-1, keepdims=True) * axis)


def wrap(angle: Array | float) -> Array:
    """Angles into (-π, π]."""
    return np.asarray(np.pi - np.mod(np.pi - np.asarray(angle, dtype=np.float64), 2 * np.pi))
