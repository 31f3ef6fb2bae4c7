"""Focus and aperture of drawn cameras, and whether a rack-focus of theirs can be seen.

Assumes tracks that are shot already; nothing is done where everything is sharp. Guarantees that what the
line is about is sharp whenever it is in the picture, and, of a rack-focus without an f-number, the smallest
opening that shows it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from runtime.world import Solids

from ..cinema.focus import PLAIN, STOPS, TOLD, between, circles, depths, focus_distances, racked
from ..cinema.framing import Array
from ..cinema.sight import clear_lines, clear_of_people
from ..cinema.track import CameraTrack, camera_axes, project
from ..lang.ir import RACK, Shot
from .candidates import Shooting

_EDGE = 0.05  # of the picture's width and height within which the other one is not looked for
_HALF_HEAD = 0.14  # m
_SEEN = 0.75  # of the looks at it, in the part of the take in which it is sharp
_RESTS = 0.4  # of the take at its start and at its end, in which what is sharp then is looked at
#: Of somebody, metres to the side and up from the eyes: across the head, and across the breast.
_OUTLINE = np.array(
    [(x, 0.0) for x in (0.0, -0.06, 0.06, -0.12, 0.12)] + [(x, -0.3) for x in (0.0, -0.07, 0.07, -0.14, 0.14)]
)


@dataclass(frozen=True, eq=False)
class Foci:
    """What is to be sharp: points [T, 3] each, several where the picture is of several; and where a
    rack-focus goes."""

    start: tuple[Array, ...]
    end: Array | None = None


@dataclass(frozen=True, eq=False)
class Held:
    """What a rack-focus rests on: points [T, 3], eyes where it is a person.

    others: everybody else as (foot [T, 3], crown [T, 3], radius)
    own: the object it is, which does not hide it
    """

    points: Array
    person: bool
    others: Sequence[tuple[Array, Array, float]]
    own: int | None = None


def focused(shooting: Shooting, shot: Shot, foci: Foci, fps: float) -> Shooting:
    """The same cameras with focus and aperture; as they are where everything is sharp."""
    if not shot.aperture and foci.end is None:
        return shooting
    track = shooting.track
    focus = between([focus_distances(track, points) for points in foci.start])
    aperture = np.full(len(focus), shot.aperture)
    if foci.end is not None:
        racks = np.array([RACK in movement.split("+") for movement in shooting.movements])
        there = focus_distances(track, foci.end)
        focus = np.where(racks[:, None], racked(focus, there, shooting.second.lam, fps), focus)
        if not shot.aperture:
            aperture = np.where(racks, _stops(replace(track, focus=focus), foci), 0.0)
    return replace(shooting, track=replace(track, focus=focus, aperture=aperture))


def _stops(track: CameraTrack, foci: Foci) -> Array:
    """The largest f-number of :data:`STOPS` for each track [P] with which its rack-focus is seen."""
    told = np.stack([_told(track, foci, np.full(len(track.focal), stop), PLAIN) for stop in STOPS])
    return np.asarray(STOPS)[np.where(told.any(axis=0), told.argmax(axis=0), len(STOPS) - 1)]


def _told(track: CameraTrack, foci: Foci, aperture: Array, least: float = TOLD) -> NDArray[np.bool_]:
    """Whether blur tells [P]: of where the focus goes at first, and of where it was in the end."""
    assert track.focus is not None
    assert foci.end is not None
    out = np.ones(len(track.focal), bool)
    for points, t in ((foci.end, 0), (foci.start[0], -1)):
        depth = depths(track, points)[:, t]
        size = circles(track.focal[:, t], track.sensor[1], aperture, track.focus[:, t], depth)
        out &= size > least
    return out


def unseen_racks(
    shooting: Shooting,
    foci: Foci,
    held: tuple[Held | None, Held | None],
    solids: Solids,
    hidden: NDArray[np.bool_],
    at: NDArray[np.int64],
) -> NDArray[np.bool_]:
    """Rack-focuses [P] from or to what is out of the picture or hidden while it is sharp, or that hardly
    change anything.

    held: what is sharp at first and in the end, None where that needs no looking at
    hidden: [P, W] walls taken away; at: [F] frames looked at
    """
    racks = np.array([RACK in movement.split("+") for movement in shooting.movements])
    if foci.end is None or not racks.any():
        return np.zeros(len(racks), bool)
    track = shooting.track
    aperture = np.broadcast_to(np.asarray(track.aperture, float), racks.shape)
    lost = ~_told(track, foci, np.maximum(aperture, 1e-3))
    spans = (at[at <= _RESTS * at[-1]], at[at >= (1.0 - _RESTS) * at[-1]])
    for one, frames, end in zip(held, spans, (0, -1), strict=True):
        if one is not None:
            seen = _seen(track, one, solids, hidden, frames)
            lost |= ~((seen.mean(axis=1) >= _SEEN) & seen[:, end])
    return np.asarray(racks & lost)


def _seen(
    track: CameraTrack, one: Held, solids: Solids, hidden: NDArray[np.bool_], frames: NDArray[np.int64]
) -> NDArray[np.bool_]:
    """Whether it is in the picture and nothing is before it, [P, F]; of somebody the head and the breast."""
    points = one.points[frames][:, None]  # [F, 1, 3]
    camera, axes = track.position[:, frames], camera_axes(track.rotation[:, frames])
    xy, depth = project(points[None], camera, axes, track.focal[:, frames], track.sensor)
    # as much as half a head with its hair stays off the sides, however near it is
    half = _HALF_HEAD * track.focal[:, frames, None] / (track.sensor[0] * np.maximum(depth, 0.3))
    border = np.stack([np.maximum(half, _EDGE), np.full_like(half, _EDGE)], axis=-1)
    seen = (depth > 0.3) & ((xy > border) & (xy < 1.0 - border)).all(axis=-1)
    people = [(foot[frames], crown[frames], radius) for foot, crown, radius in one.others]
    seen &= clear_of_people(camera, points, people)  # whose shoulder may be before a breast
    outline = _OUTLINE if one.person else _OUTLINE[:1]
    across = outline[:, :1] * axes[..., None, 0, :] + outline[:, 1:] * np.array((0.0, 0.0, 1.0))
    clear = clear_lines(solids, camera, points[None] + across, hidden, one.own)
    return np.asarray(seen[..., 0] & clear.all(axis=-1))
