"""Solves where a camera must stand so that two points sit on two lines of its frame."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from .vectors import dot, length

Array = NDArray[np.float64]

#: Cosine between a stretch of the body and the picture's up below which it cannot stand between two lines
#: (one who lies, or is seen from above): it is framed as large as if it stood, about the picture's middle.
FLAT = 0.6


def direction(theta: Array, phi: Array) -> Array:
    """Unit vectors [..., 3] from the subject to the camera: (cos φ sin θ, sin φ sin θ, cos θ)."""
    return np.stack([np.cos(phi) * np.sin(theta), np.sin(phi) * np.sin(theta), np.cos(theta)], axis=-1)


def basis(theta: Array, phi: Array) -> tuple[Array, Array, Array]:
    """Right, up and backward (towards the camera) [..., 3] of a level camera looking along −direction."""
    back = direction(theta, phi)
    s, c, cot = np.sin(phi), np.cos(phi), np.cos(theta)
    right = np.stack([-s, c, np.zeros_like(phi)], axis=-1)
    return right, np.stack([-cot * c, -cot * s, np.sin(theta)], axis=-1), back


def rolled(right: Array, up: Array, roll: Array | float) -> tuple[Array, Array]:
    """The picture's right and up [..., 3] of a camera that leans to its right by ``roll`` radians [...]."""
    c, s = np.cos(roll)[..., None], np.sin(roll)[..., None]
    return c * right - s * up, s * right + c * up


def stretch(
    upper: Array, lower: Array, camera: Array, axes: Array, focal: Array, sensor: tuple[float, float]
) -> Array:
    """How much of the frame's height a stretch of the body fills [...]: between the lines of its ends, or by
    its length where it lies :data:`FLAT`. upper, lower, camera: [..., 3]; axes: [..., 3, 3]."""
    drop = upper - lower
    tall = length(drop)
    ahead_u, ahead_l = dot(upper - camera, axes[..., 2, :]), dot(lower - camera, axes[..., 2, :])
    high_u, high_l = dot(upper - camera, axes[..., 1, :]), dot(lower - camera, axes[..., 1, :])
    between = high_u / np.maximum(ahead_u, 0.01) - high_l / np.maximum(ahead_l, 0.01)
    flat = dot(drop, axes[..., 1, :]) < FLAT * tall
    across = tall / np.maximum((ahead_u + ahead_l) / 2, 0.01)
    return np.asarray(np.where(flat, across, between) * focal / sensor[1])


def solve(
    upper: Array,
    lower: Array,
    across: Array,
    theta: Array,
    phi: Array,
    focal: Array,
    sensor: tuple[float, float],
    lines: tuple[Array, Array, Array],
    roll: float | Array = 0.0,
) -> tuple[Array, Array]:
    """Distance and aim of P cameras.

    upper, lower: [P, 3] points to put on the lines; across: [P, 3] the point to put on a column
    theta, phi: [P] direction of the camera from its aim; focal: [P] mm; sensor: (width, height) mm
    lines: (top, bottom, column), [P] each: picture coordinates 0..1, y down
    roll: radians the camera leans to its right
    returns: r [P] metres and aim [P, 3], so that a camera at ``aim + r·direction`` looking at ``aim``
        projects ``upper`` to y = top, ``lower`` to y = bottom and ``across`` to x = column, exactly;
        what lies :data:`FLAT` in the picture is put about its middle, as large as if it stood

    With v the height of a point over the optical axis and b how far it lies towards the camera,
    ``k·v = y·(r − b)`` for each of the points, k = 2f/sensor height: two linear equations in r and in
    how far the aim moves along the picture's up.
    """
    right, up, back = basis(theta, phi)
    right, up = rolled(right, up, roll)
    y_top, y_bottom, x = 1.0 - 2.0 * lines[0], 1.0 - 2.0 * lines[1], 2.0 * lines[2] - 1.0
    ky, kx = 2.0 * focal / sensor[1], 2.0 * focal / sensor[0]
    drop = lower - upper
    low_up, low_back = dot(drop, up), dot(drop, back)
    r = (-ky * low_up - y_bottom * low_back) / (y_top - y_bottom)
    lift = -y_top * r / ky  # of the aim along up, seen from ``upper``
    side = across - upper
    shift = dot(side, right) - x * (r - dot(side, back)) / kx
    aim = upper + lift[..., None] * up + shift[..., None] * right
    tall = length(drop)
    flat = -low_up < FLAT * tall
    if flat.any():
        r = np.where(flat, tall / (lines[1] - lines[0]) * focal / sensor[1], r)
        aim = np.where(flat[..., None], (upper + lower) / 2, aim)
    return r, aim


def risen(
    upper: Array,
    lower: Array,
    across: Array,
    phi: Array,
    focal: Array,
    sensor: tuple[float, float],
    lines: tuple[Array, Array, Array],
    roll: float | Array = 0.0,
) -> Callable[[Array], Array]:
    """How high [P] a camera is that :func:`solve` finds for polar angles [P]. Arguments as there.

    Who looks for the angle of a height asks a dozen times. With S and C its sine and cosine, and of a vector
    a its part towards the camera on the floor plan, b that to the picture's right and z its height, ``up`` is
    S z − C a and ``back`` S a + C z: what does not depend on the angle is worked out once.
    """
    cos, sin, lean, level = np.cos(phi), np.sin(phi), np.sin(roll), np.cos(roll)
    y_top, y_bottom, x = 1.0 - 2.0 * lines[0], 1.0 - 2.0 * lines[1], 2.0 * lines[2] - 1.0
    ky, kx = 2.0 * focal / sensor[1], 2.0 * focal / sensor[0]

    def parts(v: Array) -> tuple[Array, Array, Array]:
        return cos * v[..., 0] + sin * v[..., 1], cos * v[..., 1] - sin * v[..., 0], v[..., 2]

    drop = lower - upper
    (a, b, z), (side_a, side_b, side_z) = parts(drop), parts(across - upper)
    tall = length(drop)
    lying = tall / (lines[1] - lines[0]) * focal / sensor[1]

    def height(theta: Array) -> Array:
        s, c = np.sin(theta), np.cos(theta)
        low_up = lean * b + level * (s * z - c * a)
        r = (-ky * low_up - y_bottom * (s * a + c * z)) / (y_top - y_bottom)
        lift = -y_top * r / ky
        aside = level * side_b - lean * (s * side_z - c * side_a)  # ``across``, along the picture's right
        shift = aside - x * (r - s * side_a - c * side_z) / kx
        stands = upper[..., 2] + (lift * level - shift * lean) * s + r * c
        lies = (upper[..., 2] + lower[..., 2]) / 2 + lying * c
        return np.asarray(np.where(-low_up < FLAT * tall, lies, stands))

    return height
