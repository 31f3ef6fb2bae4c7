"""What a take's framing turned out to be: size and angle read off its track, whatever was asked.

The movement is read by :mod:`.reading`.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from .angles import CINEMA_THETA, lens_height
from .framing import stretch
from .sizes import PAPER_RADIUS, SIZES, size_of
from .subject import Subject
from .track import CameraTrack, project

Array = NDArray[np.float64]


def achieved_size(track: CameraTrack, subject: Subject, frame: int, paper: bool = False) -> str:
    """The scale whose framing of the posed body comes closest at a frame; unbatched track."""
    axes = track.axes[frame]
    eye, focal = track.position[frame], np.asarray(track.focal[frame])
    if paper:
        scales = tuple(PAPER_RADIUS)
        _, depth = project(subject.landmarks["pocket"][frame][None], eye, axes, focal, track.sensor)
        filled = np.maximum(depth, 0.01) * track.sensor[1] / focal
        asked = np.array(list(PAPER_RADIUS.values())) * subject.height
    else:
        scales, (upper, lower, asked) = tuple(SIZES), _framed(subject, frame)
        filled = np.maximum(stretch(upper, lower, eye, axes, focal, track.sensor), 1e-4)
    return scales[int(np.abs(np.log(filled / asked)).argmin())]


@lru_cache(maxsize=32)
def _framed(subject: Subject, frame: int) -> tuple[Array, Array, Array]:
    """What the sizes frame at a frame: upper and lower end [K, 3], and the share of the picture between them
    [K]. The same for many takes."""
    sizes = [size_of(subject.kind, scale) for scale in SIZES]
    upper, lower = (
        np.array([subject.landmarks[getattr(size, end)][frame] for size in sizes])
        for end in ("upper", "lower")
    )
    return upper, lower, np.array([size.share for size in sizes])


@lru_cache(maxsize=32)
def _levels(subject: Subject, frame: int) -> dict[str, float]:
    """Heights over the floor of lenses that are called by them."""
    found = {}
    for angle in CINEMA_THETA:
        level = lens_height(angle, subject.landmarks, subject.floor, subject.kind)
        if level is not None:
            found[angle] = float(np.broadcast_to(level, subject.frames)[frame]) - subject.floor
    return found


def achieved_angles(track: CameraTrack, subject: Subject, frame: int) -> tuple[str, ...]:
    """All that the angle at a frame may be called, the plainest first; unbatched track.

    The bounds lie half way between what the words name, and are not those by which takes are thrown out.
    """
    eye, axes = track.position[frame], track.axes[frame]
    down = float(np.degrees(np.arcsin(np.clip(-axes[2, 2], -1.0, 1.0))))
    over = float(eye[2]) - subject.floor
    found = [word for word, low, high in _ANGLES if low <= down < high]
    if over < _AT_GROUND and down < 0.0:  # from the ground one looks up, if by little
        found += [word for word in ("low-angle", "worms-eye") if word not in found]
    for angle, wanted in _levels(subject, frame).items():
        if abs(over - wanted) < _BESIDE and abs(down) < _TURNED:
            found.append(angle)
    return tuple(found)


#: Degrees a camera looks down, from and to.
_ANGLES = (
    ("eye-level", -9.0, 9.0),
    ("high-angle", 7.0, 91.0),
    ("low-angle", -91.0, -5.0),
    ("overhead", 70.0, 91.0),
    ("worms-eye", -91.0, -33.0),
)
_AT_GROUND = 0.5  # metres over the floor
_BESIDE, _TURNED = 0.15, 33.0  # metres off a level, and degrees off the level
