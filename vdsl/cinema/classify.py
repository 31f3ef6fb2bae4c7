"""What a take turned out to be: size, angle and movement read off its track, whatever was asked."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from .angles import CINEMA_THETA, lens_height, shows
from .framing import Array, stretch
from .moves import family
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
    """The family of one movement a take's track looks like; unbatched track, and the subject's floor points
    [T, 3]. Two at once are asked for with :func:`shows_movement`."""
    for kind in ("roll", "whip-pan", "dolly-zoom", "handheld"):
        if shows_movement(kind, track, position):
            return kind
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
    craned = pitch > np.radians(8.0) and abs(turned[-1] - turned[0]) < np.radians(30.0)
    if craned and shows_movement("crane", track, position):
        return "crane"
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


def shows_movement(movement: str, track: CameraTrack, position: NDArray[np.float64]) -> bool:
    """Whether a track does what one of the families does, whatever else it does besides.

    position: [T, 3], the subject's floor points; ``push+pan`` asks for both
    """
    return all(_SHOWS[family(part)](track, position) for part in movement.split("+"))


def _away(track: CameraTrack, position: Array) -> tuple[Array, Array, Array]:
    """Distance, azimuth and elevation [T] of the camera from the subject, at the height looked at first."""
    middle = position.copy()
    middle[:, 2] += float(track.look_at[[0, -1], 2].mean() - position[[0, -1], 2].mean())
    d = track.position - middle
    flat = np.hypot(d[:, 0], d[:, 1])
    return np.hypot(flat, d[:, 2]), np.unwrap(np.arctan2(d[:, 1], d[:, 0])), np.arctan2(d[:, 2], flat)


def _changes(values: Array) -> float:
    return float(values[-1] - values[0])


def _reaches(track: CameraTrack, position: Array) -> float:
    distance = _away(track, position)[0]
    return float(np.log(distance[-1] / distance[0]))


def _dolly_zooms(track: CameraTrack, position: Array) -> bool:
    ratio = np.log(track.focal / track.focal[0])
    reach = np.linalg.norm(track.position - track.look_at, axis=-1)
    return bool(abs(ratio[-1]) > 0.1 and np.abs(np.log(reach / reach[0]) - ratio).max() < 0.05)


def _shakes(track: CameraTrack, position: Array) -> bool:
    """A wobble of some millimetres or tenths of a degree that no eased way has."""
    found = np.column_stack([track.position, track.rotation[:, 1:] * 2.0])
    t = np.linspace(-1.0, 1.0, len(found))
    smooth = np.polynomial.polynomial.polyfit(t, found, min(5, max(len(t) - 2, 0)))
    rest = found - np.polynomial.polynomial.polyval(t, smooth).T
    turns = (np.diff(np.sign(np.diff(rest, axis=0)), axis=0) != 0).sum(axis=0)
    strong = (rest.std(axis=0) > 1e-3) & (turns >= 3)
    return bool(strong[3:].all() and strong[:3].sum() >= 2)


def _whips(track: CameraTrack, position: Array) -> bool:
    step = np.abs(np.diff(track.rotation[:, 2]))
    still = np.linalg.norm(np.ptp(track.position, axis=0)) < 0.05
    return bool(still and step.sum() > np.radians(50.0) and step.max() > 4.0 * step.mean())


def _right(track: CameraTrack, position: Array) -> float:
    """Metres moved along the first picture's right, less the subject's own."""
    moved = track.position[-1] - track.position[0]
    return abs(float(moved @ camera_axes(track.rotation[0])[0]))


def _aside(track: CameraTrack, position: Array, axis: int) -> float:
    """Radians a track turns away from where its subject is."""
    _, azimuth, elevation = _away(track, position)
    own = track.rotation[:, 2] - azimuth if axis == 2 else track.rotation[:, 1] + elevation
    return float(np.ptp(np.unwrap(own)))


def _stands(track: CameraTrack, position: Array) -> bool:
    """Neither moved nor turned, but for what a second movement adds."""
    return True


def _keeps(track: CameraTrack, position: Array) -> bool:
    """Stays turned to its subject."""
    return max(_aside(track, position, 1), _aside(track, position, 2)) < np.radians(25.0)


_SHOWS: dict[str, Callable[[CameraTrack, Array], bool]] = {
    "static": _stands,
    "follow": _keeps,
    "push": lambda track, position: _reaches(track, position) < -0.1,
    "pull": lambda track, position: _reaches(track, position) > 0.02,
    "zoom": lambda track, position: bool(abs(np.log(track.focal[-1] / track.focal[0])) > 0.02),
    "tilt": lambda track, position: _aside(track, position, 1) > np.radians(15.0),
    "pan": lambda track, position: _aside(track, position, 2) > np.radians(15.0),
    "dolly": lambda track, position: _right(track, position) > 0.15,
    "pedestal": lambda track, position: bool(abs(_changes(track.position[:, 2])) > 0.08),
    "arc": lambda track, position: abs(_changes(_away(track, position)[1])) > np.radians(60.0),
    "crane": lambda track, position: abs(_changes(_away(track, position)[2])) > np.radians(8.0),
    "roll": lambda track, position: float(np.ptp(track.rotation[:, 0])) > np.radians(5.0),
    "dolly-zoom": _dolly_zooms,
    "handheld": _shakes,
    "whip-pan": _whips,
}
