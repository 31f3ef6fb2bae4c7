"""The default rig: a 36 mm wide sensor and a distance solved from where the posed body is to sit.

Guarantees that at the key frame the size's landmarks project exactly onto its lines, whatever the lens,
the angle and the pose; only a camera that would be under the floor is raised, by turning θ towards eye
level at the same framing.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .framing import basis, direction, solve
from .moves import FLOOR_CLEARANCE
from .sizes import Size
from .subject import Subject
from .vectors import dot

Array = NDArray[np.float64]


def sensor(aspect: float) -> tuple[float, float]:
    """(width, height) in mm for a picture's width over its height: 36 × 20.25 at 16:9."""
    return 36.0, 36.0 / aspect


@dataclass(frozen=True, eq=False)
class Framing:
    """r, theta [P]; offset [P, 3] from the anchor to the aim; lifted [P]: radians θ was turned to stay
    above the floor."""

    r: Array
    theta: Array
    offset: Array
    lifted: Array


def frame(
    subject: Subject,
    size: Size,
    path: Array,
    at: NDArray[np.int64],
    theta: Array,
    phi: Array,
    focal: Array,
    film: tuple[float, float],
    lead: Array,
) -> Framing:
    """Framings of P cameras on a subject.

    path: [T, 3], what the cameras hold on to; at: [P] frame the framing is of; theta, phi: [P]
    lead: [P], how far from the middle (share of the frame's width) one who looks sideways is put,
        leaving room ahead
    """
    upper, lower = subject.landmarks[size.upper][at], subject.landmarks[size.lower][at]
    across = subject.landmarks["eyes"][at]
    if size.lower in ("feet", "knees"):
        across = (across + subject.landmarks["waist"][at]) / 2
    ones = np.ones(len(theta))

    def solved(polar: Array) -> tuple[Array, Array]:
        right = basis(polar, phi)[0]
        column = 0.5 - lead * dot(subject.face[at], right)
        return solve(
            upper, lower, across, polar, phi, focal, film, (size.top * ones, size.bottom * ones, column)
        )

    r, aim = solved(theta)
    turned = theta.copy()
    low = (aim + r[:, None] * direction(theta, phi))[:, 2] < FLOOR_CLEARANCE
    if low.any():
        under, over = theta.copy(), np.full_like(theta, np.pi / 2)
        for _ in range(12):  # halving, to about a millimetre of height
            turned = np.where(low, (under + over) / 2, theta)
            r, aim = solved(turned)
            sunk = (aim + r[:, None] * direction(turned, phi))[:, 2] < FLOOR_CLEARANCE
            under, over = np.where(sunk, turned, under), np.where(sunk, over, turned)
        turned = np.where(low, over, theta)
        r, aim = solved(turned)
    return Framing(r, turned, aim - path[at], np.abs(theta - turned))
