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


def rot_zyx(z: Array, y: Array, x: Array) -> Array:
    """``rot_z(z) @ rot_y(y) @ rot_x(x)`` in one go: angles [...] of the same shape -> [..., 3, 3]."""
    cz, sz, cy, sy, cx, sx = np.cos(z), np.sin(z), np.cos(y), np.sin(y), np.cos(x), np.sin(x)
    czsy, szsy = cz * sy, sz * sy
    out = np.empty((*sz.shape, 3, 3))
    out[..., 0, 0] = cz * cy
    out[..., 0, 1] = czsy * sx - sz * cx
    out[..., 0, 2] = czsy * cx + sz * sx
    out[..., 1, 0] = sz * cy
    out[..., 1, 1] = szsy * sx + cz * cx
    out[..., 1, 2] = szsy * cx - cz * sx
    out[..., 2, 0] = -sy
    out[..., 2, 1] = cy * sx
    out[..., 2, 2] = cy * cx
    return out


def rot_zy(z: Array, y: Array) -> Array:
    """``rot_z(z) @ rot_y(y)`` in one go."""
    cz, sz, cy, sy = np.cos(z), np.sin(z), np.cos(y), np.sin(y)
    out = np.zeros((*sz.shape, 3, 3))
    out[..., 0, 0] = cz * cy
    out[..., 0, 1] = -sz
    out[..., 0, 2] = cz * sy
    out[..., 1, 0] = sz * cy
    out[..., 1, 1] = cz
    out[..., 1, 2] = sz * sy
    out[..., 2, 0] = -sy
    out[..., 2, 2] = cy
    return out


def rotation(vector: Array) -> Array:
    """Rodrigues: rotation vectors [..., 3] -> matrices."""
    half = 0.5 * np.maximum(norm(vector), 1e-9)
    s = np.sin(half) / half
    # a quaternion's way to a matrix: no difference of nearly equal numbers at small angles
    q = (0.5 * s)[..., None] * vector
    w2 = 2.0 * np.cos(half)
    x, y, z = q[..., 0], q[..., 1], q[..., 2]
    x2, y2, z2 = x + x, y + y, z + z
    xx, yy, zz, xy, xz, yz = x * x2, y * y2, z * z2, x * y2, x * z2, y * z2
    wx, wy, wz = w2 * x, w2 * y, w2 * z
    out = np.empty((*half.shape, 3, 3))
    out[..., 0, 0] = 1.0 - (yy + zz)
    out[..., 1, 1] = 1.0 - (xx + zz)
    out[..., 2, 2] = 1.0 - (xx + yy)
    out[..., 0, 1] = xy - wz
    out[..., 1, 0] = xy + wz
    out[..., 0, 2] = xz + wy
    out[..., 2, 0] = xz - wy
    out[..., 1, 2] = yz - wx
    out[..., 2, 1] = yz + wx
    return out


def quaternion(matrix: Array) -> Array:
    """Unit quaternions (w, x, y, z) of rotation matrices, w >= 0. Stable for every angle: of the four
    ways to take the square root, the one with the largest is used (Shepperd 1978)."""
    m = matrix
    d0, d1, d2 = m[..., 0, 0], m[..., 1, 1], m[..., 2, 2]
    trace = d0 + d1 + d2
    q = np.empty((*trace.shape, 4))
    q[..., 0] = 1 + trace
    q[..., 1] = m[..., 2, 1] - m[..., 1, 2]
    q[..., 2] = m[..., 0, 2] - m[..., 2, 0]
    q[..., 3] = m[..., 1, 0] - m[..., 0, 1]
    wide = trace < 0.0  # more than a third of a turn: w is small
    if wide.any():
        q[wide] = _wide_quaternion(m[wide])
    q /= np.sqrt(np.einsum("...i,...i->...", q, q))[..., None]
    return np.where(q[..., :1] < 0, -q, q)


def _wide_quaternion(m: Array) -> Array:
    """Of matrices [N, 3, 3] with a negative trace, not normalised."""
    d0, d1, d2 = m[:, 0, 0], m[:, 1, 1], m[:, 2, 2]
    yz, zx, xy = m[:, 2, 1] - m[:, 1, 2], m[:, 0, 2] - m[:, 2, 0], m[:, 1, 0] - m[:, 0, 1]
    sxy, sxz, syz = m[:, 0, 1] + m[:, 1, 0], m[:, 0, 2] + m[:, 2, 0], m[:, 1, 2] + m[:, 2, 1]
    rows = np.stack(
        [
            np.stack([yz, 1 + d0 - d1 - d2, sxy, sxz], axis=-1),
            np.stack([zx, sxy, 1 - d0 + d1 - d2, syz], axis=-1),
            np.stack([xy, sxz, syz, 1 - d0 - d1 + d2], axis=-1),
        ],
        axis=-2,
    )
    best = np.argmax(np.stack([d0, d1, d2], axis=-1), axis=-1)
    return np.asarray(rows[np.arange(len(m)), best])


def rotation_vector(matrix: Array) -> Array:
    """The shortest rotation vector of each matrix."""
    q = quaternion(matrix)
    sine = norm(q[..., 1:])
    angle = 2.0 * np.arctan2(sine, q[..., 0])
    scale = np.where(sine < 1e-9, 2.0, angle / np.maximum(sine, 1e-12))
    return q[..., 1:] * scale[..., None]


def steady(vector: Array) -> Array:
    """Rotation vectors [..., T, 3] that do not jump to the other way round from frame to frame.

    The same rotations, but turns beyond half a circle are followed rather than flipped.
    """
    angle = norm(vector)
    axis = vector / np.maximum(angle, 1e-12)[..., None]
    follow = dot(axis[..., 1:, :], axis[..., :-1, :])
    sign = np.ones_like(angle)
    sign[..., 1:] = np.cumprod(np.where(follow < 0, -1.0, 1.0), axis=-1)
    return axis * (sign * unwrapped(angle * sign))[..., None]


def blend(start: Array, end: Array, share: Array) -> Array:
    """The way from ``start`` to ``end`` [..., T, 3, 3] by ``share`` [..., T].

    Along the shortest turn on the first frame, and from there on without flipping.
    """
    relative = np.swapaxes(start, -1, -2) @ end
    return start @ rotation(steady(rotation_vector(relative)) * share[..., None])


def dot(a: Array, b: Array) -> Array:
    """[..., 3], [..., 3] -> [...]"""
    return np.asarray(np.einsum("...i,...i->...", a, b))


def norm(vector: Array) -> Array:
    """[..., 3] -> [...] (several times quicker than numpy's on short axes)"""
    return np.sqrt(dot(vector, vector))


def cross(a: Array, b: Array) -> Array:
    """[..., 3], [..., 3] -> [..., 3] (several times quicker than numpy's)"""
    x, y, z = a[..., 0], a[..., 1], a[..., 2]
    u, v, w = b[..., 0], b[..., 1], b[..., 2]
    first = y * w - z * v
    out = np.empty((*first.shape, 3))
    out[..., 0] = first
    out[..., 1] = z * u - x * w
    out[..., 2] = x * v - y * u
    return out


def turned(matrix: Array, vector: Array) -> Array:
    """[..., 3, 3] times [..., 3], with the usual broadcasting."""
    return np.asarray((matrix @ vector[..., None])[..., 0])


def unit(vector: Array) -> Array:
    """Vectors [..., 3] to length 1 (zero stays zero)."""
    return vector / np.maximum(norm(vector), 1e-12)[..., None]


def across(vector: Array, axis: Array) -> Array:
    """The part of ``vector`` at right angles to the unit ``axis``, to length 1."""
    return unit(vector - dot(vector, axis)[..., None] * axis)


def unwrapped(angle: Array) -> Array:
    """Angles [..., T] without jumps of a full turn; most have none, and finding that out is quick."""
    jumps = angle.shape[-1] > 1 and np.abs(angle[..., 1:] - angle[..., :-1]).max(initial=0.0) > np.pi
    return np.unwrap(angle, axis=-1) if jumps else angle


def wrap(angle: Array | float) -> Array:
    """Angles into (-π, π]."""
    return np.asarray(np.pi - np.mod(np.pi - np.asarray(angle, dtype=np.float64), 2 * np.pi))
