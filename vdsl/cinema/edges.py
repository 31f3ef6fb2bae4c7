"""One end of a take, as a cut sees it: where the camera stands to people, lines, looks and ways.

Assumes a track and the performed people of a scene over the same frames. Guarantees plain numbers, small
enough that all pairs of many takes can be compared (:mod:`vdsl.cinema.continuity`). The floor plan (x, y)
decides, but for the change of view. Whether something stands before a person is not asked.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from itertools import combinations, permutations
from math import asin, atan2, degrees, hypot, log, sqrt

import numpy as np

from .sizes import SIZES
from .subject import Subject
from .track import CameraTrack, project
from .vectors import Array

_GOING = 0.3  # metres a second: who is slower is not going anywhere
_STRIDE = 0.5  # seconds a way is measured over
_RECENT = 2.0  # seconds from the cut after which a way is forgotten
_LOOKS = 45.0  # degrees off somebody's face within which it looks at them
_APART = 0.3  # metres between two people without which there is no line between them
_ABOVE = 0.35  # horizontal share of the distance below which a camera is above, on no side
_RUNGS = ("extreme-close-up", "big-close-up", "close-up", "medium-close-up", "medium", "cowboy",
          "medium-long", "full", "wide", "extreme-wide")  # fmt: skip

Pair = tuple[str, str]
#: How a pair is known to a shot: they act on each other, look at each other, or are both in the picture.
ACTING, LOOKING, SHOWN = 0, 1, 2


@dataclass(frozen=True)
class Way:
    """Where somebody goes near a cut. direction: unit, on the floor; side: degrees of the camera around
    them from that direction, −180..180; across: degrees their way leads to the picture's right."""

    direction: tuple[float, float]
    side: float
    across: float


@dataclass(frozen=True)
class Edge:
    """One end of a take.

    subject: name of the person, thing or place filmed; seen: whether it is in the frame
    view: unit vector from it to the camera; size: steps on the ladder of sizes, 0 the tightest
    looks: of everybody, degrees their face points to the picture's right of the way to or from the camera
    gazes: (who, whom) of all who look at somebody
    pairs: those who have a line between them here, and how that is known
    sides: by pair, degrees of the camera around whoever of them is filmed (or the middle between them)
        from the direction first to second, −180..180; None above them, or where they are too close
    ways: of those who are in the frame and go somewhere
    """

    subject: str
    seen: bool
    view: tuple[float, float, float]
    size: float
    looks: Mapping[str, float]
    gazes: frozenset[Pair]
    pairs: Mapping[Pair, int]
    sides: Mapping[Pair, float | None]
    ways: Mapping[str, Way]


def edges(
    track: CameraTrack, subject: Subject, people: Mapping[str, Subject], acting: Iterable[Pair], fps: float
) -> tuple[Edge, Edge]:
    """Start and end of a take.

    track: unbatched; subject: what it films; people: everybody in the scene, by name
    acting: pairs of whom one acts on the other, as the line says
    """
    acting = tuple(acting)
    first, last = (_edge(track, subject, people, acting, fps, end) for end in (False, True))
    return first, last


@lru_cache(maxsize=1)
def ladder() -> tuple[float, ...]:
    """Height of the picture at a standing subject, in shares of its height, by size, tightest first."""
    at = {"top": 1.0, "crown": 1.0, "hairline": 0.98, "brow": 0.95, "nose": 0.91, "chin": 0.87}
    at |= {"collar": 0.805, "pocket": 0.715, "waist": 0.60, "thigh": 0.42, "knees": 0.28, "feet": 0.0}
    sizes = [SIZES[name] for name in _RUNGS]
    return tuple(sorted((at[size.upper] - at[size.lower]) / size.share for size in sizes))


def steps(view: float) -> float:
    """A picture's height at its subject, in shares of its height, as a place on the ladder of sizes."""
    rungs = np.log(np.array(ladder()))
    x = log(max(view, 1e-6))
    half = log(sqrt(2.0))  # a step beyond either end
    if x < rungs[0]:
        return float((x - rungs[0]) / half)
    if x > rungs[-1]:
        return float(len(rungs) - 1 + (x - rungs[-1]) / half)
    return float(np.interp(x, rungs, np.arange(len(rungs))))


def _edge(
    track: CameraTrack,
    subject: Subject,
    people: Mapping[str, Subject],
    acting: tuple[Pair, ...],
    fps: float,
    end: bool,
) -> Edge:
    t = len(track.focal) - 1 if end else 0
    camera, heart = track.position[t], subject.landmarks["pocket"][t]
    depth = float((heart - camera) @ track.axes[t, 2])
    view = max(depth, 0.01) * track.sensor[1] / float(track.focal[t]) / max(subject.height, 1e-6)
    shown = frozenset(name for name, who in people.items() if _in_frame(track, who, t))
    gazes = frozenset((a, b) for a, b in permutations(people, 2) if _looks_at(people, a, b, t))
    pairs = _pairs(people, acting, shown, gazes)
    towards = camera - heart
    towards = towards / max(float(np.linalg.norm(towards)), 1e-9)
    return Edge(
        subject.name,
        _in_frame(track, subject, t),
        (float(towards[0]), float(towards[1]), float(towards[2])),
        steps(view),
        {name: _across(track, who.face[t], t) for name, who in people.items()},
        gazes,
        pairs,
        {pair: _side_of_pair(camera, people, pair, subject.name, t) for pair in pairs},
        _ways(track, people, fps, end),
    )


def _in_frame(track: CameraTrack, who: Subject, t: int) -> bool:
    """Whether eyes or chest are in the picture."""
    points = np.stack([who.landmarks["eyes"][t], who.landmarks["pocket"][t]])
    axes = track.axes[t]
    xy, depth = project(points, track.position[t], axes, np.asarray(track.focal[t]), track.sensor)
    return bool(((depth > 0.05) & (xy > 0.0).all(axis=-1) & (xy < 1.0).all(axis=-1)).any())


def _pairs(
    people: Mapping[str, Subject], acting: tuple[Pair, ...], shown: frozenset[str], gazes: frozenset[Pair]
) -> dict[Pair, int]:
    acted = {tuple(sorted(pair)) for pair in acting}
    out: dict[Pair, int] = {}
    for pair in combinations(sorted(people), 2):
        if pair in acted:
            out[pair] = ACTING
        elif {pair, pair[::-1]} <= gazes:
            out[pair] = LOOKING
        elif shown.issuperset(pair):
            out[pair] = SHOWN
    return out


def _looks_at(people: Mapping[str, Subject], who: str, whom: str, t: int) -> bool:
    way = people[whom].landmarks["eyes"][t] - people[who].landmarks["eyes"][t]
    return abs(turned(people[who].face[t], way)) < _LOOKS


def _side_of_pair(
    camera: Array, people: Mapping[str, Subject], pair: Pair, subject: str, t: int
) -> float | None:
    one, two = (people[name].landmarks["eyes"][t] for name in pair)
    if hypot(*(two - one)[:2]) < _APART:
        return None
    point = people[subject].landmarks["eyes"][t] if subject in pair else (one + two) / 2
    return _side(camera, point, two - one)


def _side(camera: Array, point: Array, along: Array) -> float | None:
    """Degrees of the camera around a point from a direction, on the floor; None from above or below."""
    to = camera - point
    if hypot(to[0], to[1]) < _ABOVE * float(np.linalg.norm(to)):
        return None
    return turned(along, to)


def turned(one: Array, two: Array) -> float:
    """Degrees from one direction to another on the floor, −180..180, positive to the left."""
    cross = float(one[0] * two[1] - one[1] * two[0])
    return degrees(atan2(cross, float(one[0] * two[0] + one[1] * two[1])))


def _across(track: CameraTrack, direction: Array, t: int) -> float:
    """Degrees by which a direction leads to the picture's right (positive) or left, −90..90."""
    yaw = float(track.rotation[t, 2])
    flat = hypot(float(direction[0]), float(direction[1]))
    if flat < 1e-6:
        return 0.0
    right = (float(direction[0]) * np.sin(yaw) - float(direction[1]) * np.cos(yaw)) / flat
    return degrees(asin(min(max(right, -1.0), 1.0)))


def _ways(track: CameraTrack, people: Mapping[str, Subject], fps: float, end: bool) -> dict[str, Way]:
    out: dict[str, Way] = {}
    for name, who in people.items():
        frames = who.frames
        stride = min(max(round(_STRIDE * fps), 1), frames - 1)
        if stride < 1:
            continue
        gone = who.position[stride:, :2] - who.position[:-stride, :2]
        going = np.flatnonzero(np.hypot(gone[:, 0], gone[:, 1]) > _GOING * stride / fps)
        if not len(going):
            continue
        k = int(going[-1 if end else 0])
        t = k + stride if end else k
        if (frames - 1 - t if end else t) > _RECENT * fps or not _in_frame(track, who, t):
            continue
        side = _side(track.position[t], who.landmarks["eyes"][t], gone[k])
        if side is None:
            continue
        x, y = (gone[k] / np.hypot(*gone[k])).tolist()
        out[name] = Way((x, y), side, _across(track, gone[k], t))
    return out
