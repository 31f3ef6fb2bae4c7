"""Ways of getting along, and how a path is run through: an eased way over a smooth line.

Positions are metres, times seconds.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from runtime.body.skeleton import JOINT, Skeleton
from runtime.world import Stairs

from .curves import ramp, smooth

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Gait:
    """How one gets along. Lengths are shares of body height; seconds.

    step: between two footfalls; period: time between them; swing: share of the period a foot is in the
    air (above 1 both are at times); ramp: time to get going and to stop; run: 1 where one runs
    """

    name: str
    step: float
    period: float
    swing: float
    ramp: float
    run: float = 0.0


WALK = Gait("walk", 0.39, 0.52, 0.80, 0.62)
GAITS = {
    "walk": WALK,
    "run": Gait("run", 0.61, 0.335, 1.36, 0.7, 1.0),
    "skip": Gait("skip", 0.34, 0.33, 0.0, 0.6, 0.6),
    "crawl": Gait("crawl", 0.15, 0.5, 0.85, 0.5),
}


def seat_distance(skeleton: Skeleton, seat_height: float) -> float:
    """How far before the middle of a seat the feet stand."""
    bind = skeleton.bind
    thigh = bind[JOINT["thigh_l"]][2] - bind[JOINT["shin_l"]][2]
    rise = min(seat_height + sit_clearance(skeleton) - bind[JOINT["shin_l"]][2], level_thigh(skeleton))
    return float(np.sqrt(max(thigh**2 - rise**2, (0.55 * thigh) ** 2)) * 0.93)


def level_thigh(skeleton: Skeleton) -> float:
    """How far the knees may be below the hip joints, sitting, before the thighs go through the seat."""
    return 0.045 * skeleton.height


def sit_clearance(skeleton: Skeleton) -> float:
    """Hip joints above the seat's surface, sitting."""
    return 0.056 * skeleton.height


def resampled(at: Array, path: Array | None) -> Array:
    """The path [K, 2] or [K, 3] from ``at`` [3] on, a point [N, 3] every 4 cm, corners eased."""
    if path is None or len(path) == 0:
        return np.stack([at, at])
    points = np.asarray(path, dtype=np.float64)
    if points.shape[1] == 2:
        points = np.concatenate([points, np.full((len(points), 1), at[2])], axis=1)
    if np.linalg.norm(points[0] - at) < 0.6 and len(points) > 1:
        points = points[1:]
    points = np.concatenate([at[None], points])
    keep = np.concatenate([[True], np.linalg.norm(np.diff(points[:, :2], axis=0), axis=1) > 1e-4])
    points = points[keep]
    if len(points) < 2:
        return np.stack([at, at])
    arc = lengths(points)
    s = np.linspace(0.0, arc[-1], max(3, int(arc[-1] / 0.04) + 1))
    line = np.stack([np.interp(s, arc, points[:, k]) for k in range(3)], axis=1)
    chord = line[0] + (line[-1] - line[0]) * (s / max(arc[-1], 1e-9))[:, None]
    eased = chord + smooth(line - chord, 4.0)
    fade = np.minimum(1.0, np.minimum(s, arc[-1] - s) / 0.3)[:, None]
    return eased * fade + line * (1 - fade)


def climbing(line: Array, stairs: tuple[Stairs, ...], step: float) -> Array:
    """How many times slower one gets on at each point of a line [N, 3]: a tread takes the time of a step."""
    slow = np.ones(len(line))
    for flight in stairs:
        if flight.steps < 2:  # a single step has no tread
            continue
        u, beside, within = _on(flight, line)
        inside = (u > -0.5 * flight.run) & (u < flight.run * (flight.steps - 0.5)) & beside & within
        slow = np.where(inside, max(step / flight.run, 1.0), slow)
    return slow


def tread(place: Array, stairs: tuple[Stairs, ...], heading: float) -> Array | None:
    """Where a foot near ``place`` [3] is set on the tread there, [3]; None off all stairs."""
    for flight in stairs:
        if flight.steps < 2:
            continue
        (u,), (beside,), (within,) = _on(flight, place[None])
        k = int(np.floor(u / flight.run))
        if not (beside and within and 0 <= k < flight.steps - 1):
            continue
        ahead = np.array(flight.ahead)
        up = float(np.cos(heading) * ahead[0] + np.sin(heading) * ahead[1])
        to = (k + 0.5 - 0.14 * np.sign(up)) * flight.run
        xy = place[:2] + (to - u) * ahead
        return np.array([*xy, flight.low[2] + (k + 1) * flight.rise])
    return None


def _on(flight: Stairs, points: Array) -> tuple[Array, NDArray[np.bool_], NDArray[np.bool_]]:
    """Of points [N, 3]: metres along a flight, whether they are within its width, and its heights."""
    ahead = np.array(flight.ahead)
    off = points[:, :2] - np.array(flight.low[:2])
    across = np.abs(off[:, 0] * ahead[1] - off[:, 1] * ahead[0])
    z = points[:, 2]
    return off @ ahead, across < 0.5 * flight.width, (z > flight.low[2] - 0.1) & (z < flight.high[2] + 0.1)


def lengths(line: Array) -> Array:
    """Metres on the floor from the beginning of a line [N, 3] to each of its points."""
    return np.asarray(
        np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line[:, :2], axis=0), axis=1))])
    )


def tangents(line: Array) -> Array:
    d = np.gradient(line, axis=0)
    return np.asarray(smooth(np.unwrap(np.arctan2(d[:, 1], d[:, 0])), 4.0))


def timing(
    length: float, pace: float, slack: float, first: float, last: float, speed: float
) -> tuple[float, ...]:
    """(turn in, travel start, travel time, turn out, its start, total) in seconds."""
    turn_in = (0.3 + 0.42 * abs(first)) / speed if abs(first) > 0.3 else 0.35
    start = 0.62 * turn_in if abs(first) > 0.3 else 0.0
    if length <= 0.04:
        turn = (0.55 + 0.45 * abs(last)) / speed
        return (0.3, 0.0, 0.0, turn, 0.0, turn + 0.1)
    going = length / pace + slack if length > pace * slack else 2 * np.sqrt(length * slack / pace)
    going = max(going, 0.55)
    turn_out = (0.25 + 0.42 * abs(last)) / speed
    out_start = start + going - min(0.75 * turn_out, 0.5 * slack)
    total = max(start + going, out_start + turn_out if abs(last) > 0.05 else 0.0) + 0.12
    return (turn_in, start, going, turn_out, out_start, total)


def progress(t: Array, going: float) -> Array:
    """Share of the path covered: eased start, even pace, eased stop."""
    if going <= 0:
        return np.zeros(len(t))
    slack = min(0.62, 0.5 * going)
    speed = ramp(t, 0.0, slack) * (1.0 - ramp(t, going - slack, going))
    covered = np.concatenate([[0.0], np.cumsum(0.5 * (speed[1:] + speed[:-1]))])
    return np.asarray(covered / max(covered[-1], 1e-9))
