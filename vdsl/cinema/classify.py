"""What a take turned out to be: size, angle and movement read off its track, whatever was asked."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .angles import CINEMA_THETA, lens_height, shows
from .framing import Array, stretch
from .sizes import PAPER_RADIUS, SIZES, size_of
from .subject import Subject
from .track import CameraTrack, camera_axes, project


def achieved_size(track: CameraTrack, subject: Subject, frame: int, paper: bool = False) -> str:
    """The scale whose framing of the posed body comes closest at a frame; unbatched track."""
    axes = camera_axes(track.rotation[frame])
    eye, focal = track.position[frame], np.asarray(track.focal[frame])
    _, depth = project(subject.landmarks["pocket"][frame][None], eye, axes, focal, track.sensor)
    view = max(float(depth[0]), 0.01) * track.sensor[1] / float(focal)
    best, least = "medium", np.inf
    for scale in PAPER_RADIUS if paper else SIZES:
        if paper:
            error = abs(np.log(view / (PAPER_RADIUS[scale] * subject.height)))
        else:
            size = size_of(subject.kind, scale)
            upper, lower = subject.landmarks[size.upper][frame], subject.landmarks[size.lower][frame]
            filled = float(stretch(upper, lower, eye, axes, focal, track.sensor))
            error = abs(np.log(max(filled, 1e-4) / size.share))
        if error < least:
            best, least = scale, error
    return best


def achieved_angles(elevation: float, height: float, subject: Subject, frame: int) -> tuple[str, ...]:
    """All that an angle may be called: a low one is high over nothing, but may be at the knees' level too.

    elevation: radians the camera looks down on its aim; height: metres of the camera over the floor
    """
    found = []
    for angle in CINEMA_THETA:
        level = lens_height(angle, subject.landmarks, subject.floor, subject.kind)
        over = None if level is None else float(np.broadcast_to(level, subject.frames)[frame]) - subject.floor
        if shows(angle, np.asarray(elevation), np.asarray(height), over):
            found.append(angle)
    return tuple(found)


def achieved_angle(elevation: float) -> str:
    """Up, level or down, from the camera's elevation over its aim in radians (positive: it looks down)."""
    nobody = np.asarray(0.0)
    for angle in ("overhead", "high-angle", "low-angle"):
        if shows(angle, np.asarray(elevation), nobody, None):
            return angle
    return "eye-level"


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
