"""Shot angles: polar angles θ from +Z (π/2 is level), or heights of the lens; which may be called which."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

#: ``rig cinema``: low-angle mirrors high-angle. The levels turn away from the level only as far as a lens
#: at their height has to.
CINEMA_THETA = {
    "eye-level": math.pi / 2,
    "high-angle": 2 * math.pi / 5,
    "low-angle": 3 * math.pi / 5,
    "overhead": math.radians(8.0),
    "worms-eye": math.radians(140.0),
    "shoulder-level": math.pi / 2,
    "hip-level": math.pi / 2,
    "knee-level": math.pi / 2,
    "ground-level": math.pi / 2,
}
#: ``rig paper``: as printed (section 3.2, Shot Angle).
PAPER_THETA = {
    "eye-level": math.pi / 2,
    "high-angle": 2 * math.pi / 5,
    "low-angle": 4 * math.pi / 5,
}
#: Angles said by the height of the lens: the landmarks whose mean height it is, none for the ground.
LEVELS: dict[str, tuple[str, ...]] = {
    "shoulder-level": ("collar",),
    "hip-level": ("waist", "thigh"),
    "knee-level": ("knees",),
    "ground-level": (),
}
GROUND = 0.2  # metres over the floor of a camera at ground level
#: Heights over the floor of the same for things and places, metres.
_USUAL = {"shoulder-level": 1.4, "hip-level": 0.9, "knee-level": 0.5, "ground-level": GROUND}
#: Elevations beyond which a shot looks down or up, radians. Lower for looking up: a camera lifted off
#: the floor still reads as low when it is clearly below what it films.
LOOKS_DOWN, LOOKS_UP = math.radians(8.0), math.radians(-4.0)
OVERHEAD = math.radians(80.0)  # least elevation of a shot from overhead
_STEEP = math.radians(35.0)  # a worm's eye looks up so much, or lies on the ground
_LOW = 0.5  # metres over the floor
_LEVEL_HEIGHT = 0.1  # how far off its height a level may be, metres
_LEVEL_TURN = math.radians(30.0)  # how far a level may look up or down to have its size


def lens_height(angle: str, landmarks: Mapping[str, Array], floor: float, kind: str) -> Array | float | None:
    """Height of the lens an angle names, at every frame; None for angles that are said by θ."""
    if angle not in LEVELS:
        return None
    if kind != "person" or not LEVELS[angle]:
        return floor + _USUAL[angle]
    height = np.mean([landmarks[name][:, 2] for name in LEVELS[angle]], axis=0)
    return np.asarray(np.maximum(height, floor + GROUND))


def shows(angle: str, elevation: Array, height: Array, level: Array | float | None) -> NDArray[np.bool_]:
    """Whether takes may be called so.

    elevation: radians, positive looking down; height: of the camera over the floor; level: that of
    :func:`lens_height` over the floor, for angles that have one
    """
    if angle == "eye-level":
        return np.asarray((elevation <= LOOKS_DOWN) & (elevation >= LOOKS_UP))
    if angle == "high-angle":
        return np.asarray(elevation > LOOKS_DOWN)
    if angle == "low-angle":
        return np.asarray(elevation < LOOKS_UP)
    if angle == "overhead":
        return np.asarray(elevation >= OVERHEAD)
    if angle == "worms-eye":
        return np.asarray((elevation < LOOKS_UP) & ((elevation < -_STEEP) | (height < _LOW)))
    if level is None:
        return np.zeros(np.shape(elevation), bool)
    near = np.abs(height - level) <= _LEVEL_HEIGHT
    return np.asarray(near & (np.abs(elevation) <= _LEVEL_TURN))
