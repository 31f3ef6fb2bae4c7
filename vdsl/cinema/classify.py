"""What a take turned out to be: size, angle and movement read off its track, whatever was asked."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .angles import LOOKS_DOWN, LOOKS_UP
from .framing import Array
from .sizes import PAPER_RADIUS, size_of
from .subject import Subject
from .track import CameraTrack, camera_axes, project

_SCALES = ("close-up", "medium", "full", "wide")


def achieved_size(track: CameraTrack, subject: Subject, frame: int, paper: bool = False) -> str:
    """The scale whose framing of the posed body comes closest at a frame; unbatched track."""
    axes = camera_axes(track.rotation[frame])
    names = list(subject.landmarks)
    points = np.stack([subject.landmarks[n][frame] for n in names])
    xy, depth = project(points, track.position[frame], axes, np.asarray(track.focal[frame]), track.sensor)
    view = max(float(depth[names.index("pocket")]), 0.01) * track.sensor[1] / float(track.focal[frame])
    best, least = _SCALES[0], np.inf
    for scale in _SCALES:
        if paper:
            error = abs(np.log(view / (PAPER_RADIUS[scale] * subject.height)))
        else:
            size = size_of(subject.kind, scale)
            stretch = xy[names.index(size.lower), 1] - xy[names.index(size.upper), 1]
            error = abs(np.log(max(float(stretch), 1e-4) / size.share))
        if error < least:
            best, least = scale, error
    return best


def achieved_angle(elevation: float) -> str:
    """From the camera's elevation over its aim in radians (positive: it looks down)."""
    if elevation > LOOKS_DOWN:
        return "high-angle"
    return "low-angle" if elevation < LOOKS_UP else "eye-level"


def achieved_movement(track: CameraTrack, position: NDArray[np.float64]) -> str:
    """The family a take's track looks like; unbatched track, and the subject's floor points [T, 3]."""
    moved = track.position[-1] - track.position[0]
    pitch, yaw = (float(np.ptp(track.rotation[:, k])) for k in (1, 2))
    ratio = float(track.focal[-1] / track.focal[0])
    to_subject: Array = track.position - position
    turned = np.unwrap(np.arctan2(to_subject[:, 1], to_subject[:, 0]))
    still = float(np.linalg.norm(np.ptp(track.position, axis=0))) < 0.05
    if abs(np.log(ratio)) > 0.02:
        return "zoom"
    if still:
        if max(pitch, yaw) < np.radians(5.0):
            return "static"
        return "pan" if yaw > pitch else "tilt"
    if abs(turned[-1] - turned[0]) > np.radians(60.0) and yaw > np.radians(45.0):
        return "arc"
    reach = np.linalg.norm(track.position - track.look_at, axis=-1)
    if abs(np.log(reach[-1] / reach[0])) > 0.03 and pitch < np.radians(20.0):
        return "push" if reach[-1] < reach[0] else "pull"
    if max(pitch, yaw) < np.radians(1.0):
        if abs(moved[2]) > np.hypot(moved[0], moved[1]):
            return "pedestal"
        walked = float(np.linalg.norm(position[-1] - position[0]))
        drift = float(np.linalg.norm((moved - (position[-1] - position[0]))[:2]))
        return "follow" if walked > 0.3 and drift < 0.35 * walked else "dolly"
    return "follow"
