"""The default rig: a 36 mm wide sensor and a distance solved from where the posed body is to sit.

Guarantees that at the key frame the size's landmarks project exactly onto its lines, whatever the lens,
the angle and the pose; only a camera that would be under the floor is raised, by turning θ towards eye
level at the same framing.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .framing import basis, risen, solve
from .moves import FLOOR_CLEARANCE
from .sizes import Size
from .subject import Subject
from .vectors import dot

Array = NDArray[np.float64]

_RAISE = np.radians(20.0)  # how far above eye level a camera may be turned that would be in the floor
_STEEP = np.radians(45.0)  # how far up or down one looks who has to be at some height


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
    roll: float | Array = 0.0,
    level: Array | None = None,
    aside: Array | None = None,
) -> Framing:
    """Framings of P cameras on a subject.

    path: [T, 3], what the cameras hold on to; at: [P] frame the framing is of; theta, phi: [P]
    lead: [P], how far from the middle (share of the frame's width) one who looks sideways is put,
        leaving room ahead
    roll: radians the cameras lean; level: [P] height the camera is to have, which θ is solved for (as far
        as it goes); NaN for those that keep theirs
    aside: [P] column the eyes are put on, instead of ``lead``; NaN for those that are put by that
    """
    upper, lower = subject.landmarks[size.upper][at], subject.landmarks[size.lower][at]
    across = subject.landmarks["eyes"][at]
    if size.lower in ("feet", "knees", "thigh"):
        across = (across + subject.landmarks["waist"][at] + lower) / 3
    ones = np.ones(len(theta))
    column = 0.5 - lead * dot(subject.face[at], basis(theta, phi)[0])  # whose right does not depend on θ
    if aside is not None:
        column = np.where(np.isnan(aside), column, aside)
    lines = (size.top * ones, size.bottom * ones, column)
    height = risen(upper, lower, across, phi, focal, film, lines, roll)

    asked, goal = theta, np.full(len(theta), FLOOR_CLEARANCE)
    under, over = theta, np.minimum(theta, np.pi / 2) - _RAISE
    loose = height(theta) < FLOOR_CLEARANCE
    if level is not None and not np.isnan(level).all():
        given = ~np.isnan(level)
        goal, loose = np.where(given, np.fmax(level, FLOOR_CLEARANCE), goal), loose | given
        under, over = np.where(given, np.pi / 2 + _STEEP, under), np.where(given, np.pi / 2 - _STEEP, over)
    if loose.any():
        for _ in range(14):  # halving, to less than a millimetre of height
            middle = (under + over) / 2
            sunk = height(np.where(loose, middle, theta)) < goal
            under, over = np.where(sunk, middle, under), np.where(sunk, over, middle)
        theta = np.where(loose, over, theta)
        if level is not None:
            asked = np.where(np.isnan(level), asked, theta)
    r, aim = solve(upper, lower, across, theta, phi, focal, film, lines, roll)
    return Framing(r, theta, aim - path[at], np.abs(asked - theta))
