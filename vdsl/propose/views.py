"""Cameras that look over somebody's shoulder, or through somebody's eyes.

Assumes ``subject.via``: the eyes of the one whose shoulder or eyes it is. Guarantees the size's lines for a
shoulder; for eyes, which stand where they stand, the lens that comes nearest to the size.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from ..cinema.framing import direction
from ..cinema.moves import Draw
from ..cinema.rig_cinema import Framing
from ..cinema.sizes import Size
from ..cinema.subject import Subject
from ..cinema.track import CameraTrack, camera_axes, look_at_rotation, project

Array = NDArray[np.float64]
Film = tuple[float, float]

_NEAREST, _FARTHEST = 0.5, 1.0  # metres from the near head to the camera behind it
_ASIDE = 0.38  # how far off the middle the near head is put, share of the width
_EAR = 0.1  # metres under the near eyes of a lens that looks past the ear
_NODS = np.radians(3.3)  # how far from level it may look up, and half as far as down
_MAKES_ROOM = 0.1  # how far to the other side the one looked at is put
_STEADY = 0.25  # seconds over which a look's sway is evened


def over_shoulder(
    subject: Subject,
    size: Size,
    path: Array,
    at: NDArray[np.int64],
    lens: tuple[float, float],
    film: Film,
    right: NDArray[np.bool_],
    u: Array,
    framed: Callable[[Array, Array, Array, Array], Framing],
) -> tuple[Framing, Array, Array]:
    """Framing, azimuth and focal length [P] of cameras behind the near head, put at the frame's side.

    right: whether to its right side; u: 0..1, how far behind; framed: solves the size for an azimuth, focal
    length, column of the subject and radians to look down
    """
    assert subject.via is not None
    near, eyes = subject.via[at], subject.landmarks["eyes"][at]
    apart = near - eyes
    reach = np.hypot(apart[:, 0], apart[:, 1]) + _NEAREST + (_FARTHEST - _NEAREST) * u
    tall = _tall(subject, size, at)
    focal = np.clip(reach * film[1] * size.share / tall, *lens)
    phi = np.arctan2(apart[:, 1], apart[:, 0])
    middle = (subject.landmarks[size.upper][at] + subject.landmarks[size.lower][at]) / 2
    down = np.clip(np.arctan2(near[:, 2] - _EAR - middle[:, 2], reach), -_NODS, 2 * _NODS)
    side = np.where(right, 1.0, -1.0)
    column, goal = 0.5 - _MAKES_ROOM * side, 0.5 + _ASIDE * side

    def miss(azimuth: Array) -> tuple[Array, Framing]:
        framing = framed(azimuth, focal, column, down)
        aim = path[at] + framing.offset
        camera = aim + framing.r[:, None] * direction(framing.theta, azimuth)
        axes = camera_axes(look_at_rotation(camera, aim))
        xy, depth = project(near[:, None], camera, axes, focal, film)
        return np.where(depth[:, 0] > 0.1, xy[:, 0, 0] - goal, 0.0), framing

    for _ in range(6):  # Newton's steps, with the slope between two azimuths
        off, _framing = miss(phi)
        beside, _framing = miss(phi + 1e-3)
        slope = (beside - off) / 1e-3
        step = np.where(np.abs(slope) > 1e-3, off / np.where(np.abs(slope) > 1e-3, slope, 1.0), 0.0)
        phi = phi - np.clip(step, -0.3, 0.3)
    return miss(phi)[1], phi, focal


def _tall(subject: Subject, size: Size, at: NDArray[np.int64]) -> Array:
    """Length [P] of the size's stretch of the posed body."""
    stretch = subject.landmarks[size.upper][at] - subject.landmarks[size.lower][at]
    return np.asarray(np.linalg.norm(stretch, axis=1))


def through_eyes(
    subject: Subject, size: Size, path: Array, at: NDArray[np.int64], lens: tuple[float, float], film: Film
) -> tuple[Framing, Array, Array]:
    """Framing, azimuth and focal length [P] of looks from the eyes at the subject."""
    assert subject.via is not None
    upper, lower = subject.landmarks[size.upper][at], subject.landmarks[size.lower][at]
    aim = upper + ((0.5 - size.top) / size.share) * (lower - upper)
    to_eyes = subject.via[at] - aim
    r = np.maximum(np.linalg.norm(to_eyes, axis=1), 0.2)
    theta, phi = np.arccos(np.clip(to_eyes[:, 2] / r, -1, 1)), np.arctan2(to_eyes[:, 1], to_eyes[:, 0])
    focal = np.clip(r * film[1] * size.share / _tall(subject, size, at), *lens)
    return Framing(r, theta, aim - path[at], np.zeros(len(r))), phi, focal


def eyes_track(
    subject: Subject, path: Array, draw: Draw, film: Film, roll: float, follows: bool, fps: float
) -> CameraTrack:
    """Tracks [P, T, …] from the eyes, evened; looking where they look first or last, or following."""
    assert subject.via is not None
    frames = len(path)
    eyes = gaussian_filter1d(subject.via, sigma=max(_STEADY * fps, 0.5), axis=0, mode="nearest")
    position = np.tile(eyes, (len(draw.r), 1, 1))
    held = path[np.where(draw.key == 1, frames - 1, 0)][:, None] + np.zeros((1, frames, 1))
    look_at = (path[None] if follows else held) + draw.offset[:, None]
    rotation = look_at_rotation(position, look_at, roll)
    rotation[..., 2] = np.unwrap(rotation[..., 2], axis=-1)
    focal = np.repeat(draw.focal[:, None], frames, axis=1)
    return CameraTrack(position, rotation, focal, look_at, film)
