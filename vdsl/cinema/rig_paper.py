"""The rig as the paper prints it: r ∈ {0.2h, 0.5h, h}, θ ∈ {π/2, 2π/5, 4π/5}, h the character's height.

The printed distances name the visible height at the subject only for a sensor as high as the focal
length is long, so the sensor is 50 mm high. The reference point is a fixed height above the subject's
floor point: face, chest or body centre.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .angles import PAPER_THETA
from .sizes import PAPER_RADIUS, PAPER_REFERENCE

SENSOR_HEIGHT = 50.0  # mm
FOCAL = 50.0  # mm, what the printed distances are for


def sensor(aspect: float) -> tuple[float, float]:
    """(width, height) in mm."""
    return SENSOR_HEIGHT * aspect, SENSOR_HEIGHT


def radius(scale: str, height: float, focal: NDArray[np.float64]) -> NDArray[np.float64]:
    """r [P] in metres; other lenses than 50 mm keep the visible height."""
    return PAPER_RADIUS[scale] * height * focal / FOCAL


def theta(angle: str) -> float:
    """Polar angle as printed."""
    return PAPER_THETA[angle]


def reference_height(scale: str, height: float) -> float:
    """Metres above the floor point of what is looked at."""
    return PAPER_REFERENCE[scale] * height
