"""What is in focus: how far away it is, how the focus goes from one to another, and how much the rest blurs.

Metres and mm; arrays may carry leading batch axes as tracks do. A lens is thin: what lies at depth z, while
the focus is at s, is a circle of diameter f² |1 − s / z| / (N (s − f)) on the sensor.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from .easing import clock, ease
from .track import CameraTrack

Array = NDArray[np.float64]

NEAREST = 0.25  # metres: closest that anything is focused
#: F-numbers tried for a rack-focus whose line says none: the first that shows it.
STOPS = (2.8, 2.0, 1.4)
#: Diameters of circles of confusion, as shares of the picture's height: up to the first all is sharp; from
#: the second on a blur is seen; from the third on it tells at a glance what the shot is not about.
SHARP, TOLD, PLAIN = 0.004, 0.008, 0.02
_RACK_SECONDS, _RACK_SHARE = (
    1.2,
    (0.25, 0.7),
)  # how long a rack lasts, and what share of a take at least, at most
_ASIDE = 0.8  # of the distance: as near as the plane of focus comes of what is out of the picture


def forward(rotation: Array) -> Array:
    """The optical axis [..., 3] of roll, pitch, yaw [..., 3]."""
    pitch, yaw = rotation[..., 1], rotation[..., 2]
    return np.stack([np.cos(pitch) * np.cos(yaw), np.cos(pitch) * np.sin(yaw), np.sin(pitch)], axis=-1)


def depths(track: CameraTrack, points: Array) -> Array:
    """Depth [..., T] of points [T, 3] along the optical axis, negative behind the camera."""
    away = points - track.position
    return np.asarray((away * forward(track.rotation)).sum(axis=-1))


def focus_distances(track: CameraTrack, points: Array) -> Array:
    """Where the focus is [..., T] for points [T, 3] to be sharp; it waits for what is out of the picture."""
    away = np.linalg.norm(points - track.position, axis=-1)
    return np.maximum(np.maximum(depths(track, points), _ASIDE * away), NEAREST)


def between(distances: list[Array]) -> Array:
    """The focus at which the nearest and the farthest of several blur alike."""
    return 2.0 / (1.0 / np.min(distances, axis=0) + 1.0 / np.max(distances, axis=0))


def racked(start: Array, end: Array, lam: Array, fps: float) -> Array:
    """The focus [..., T] going from one distance [..., T] to another, by an easing λ [...] of its own.

    It rests on either end; in between it goes evenly in 1/s, as the ring of a lens does, without a jolt.
    """
    frames = start.shape[-1]
    share = np.clip(_RACK_SECONDS * fps / max(frames - 1, 1), *_RACK_SHARE)
    t = np.clip((clock(frames) - 0.5) / share + 0.5, 0.0, 1.0)
    w = ease(t**3 * (10.0 - 15.0 * t + 6.0 * t**2), np.asarray(lam)[..., None])
    return np.asarray(1.0 / ((1.0 - w) / start + w / end))


def circles(focal: Array, sensor_height: float, aperture: Array, focus: Array, depth: Array) -> Array:
    """Diameter of the circle of confusion, as a share of the picture's height; focal: mm, the rest metres."""
    s = np.maximum(1000.0 * focus, 2.0 * focal)
    on_sensor = focal**2 / (aperture * (s - focal)) * np.abs(1.0 - focus / np.maximum(depth, 0.05))
    return np.asarray(on_sensor / sensor_height)


def shows_rack(track: CameraTrack, subjects: Iterable[Array]) -> bool:
    """Whether the focus goes to or from somebody while a take runs; unbatched track.

    subjects: points [T, 3] each. Read from the track alone: one of them is sharp at one end, and blurred
    beyond a doubt at the other
    """
    if track.focus is None or not np.all(track.aperture):
        return False
    ends = np.array([0, -1])
    for points in subjects:
        depth, aperture = depths(track, points)[ends], np.asarray(track.aperture)
        found = circles(track.focal[ends], track.sensor[1], aperture, track.focus[ends], depth)
        if found.min() < SHARP and found.max() > TOLD:
            return True
    return False
