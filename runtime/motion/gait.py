"""Where a body goes and where its feet stand: walking, running, turning on the spot, sitting down.

A :class:`Route` is built by saying what comes after what; it is planned before any pose is made. The
root leads (an eased run along the path, heading along its tangent) and the feet follow: each foot lands
where the body will be in the middle of that foot's stance, and does not move until it is lifted again.
Positions are metres on the floor, times seconds from the shot's start.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from runtime.body.skeleton import JOINT, Skeleton

from .curves import ease, ramp, smooth
from .feet import Feet, Step, foot_track
from .rotations import wrap

Array = NDArray[np.float64]
#: Planning steps a second; finer than any frame rate in use.
RATE = 60.0


@dataclass(frozen=True)
class Manner:
    """How one gets along. Lengths are shares of body height; seconds.

    step: between two footfalls; period: time between them; swing: share of the period a foot is in the
    air (above 1 both are at times); ramp: time to get going and to stop
    """

    name: str
    step: float
    period: float
    swing: float
    ramp: float


WALK = Manner("walk", 0.39, 0.52, 0.80, 0.62)
RUN = Manner("run", 0.61, 0.335, 1.36, 0.7)
MANNERS = {"walk": WALK, "run": RUN}


@dataclass(frozen=True)
class Sit:
    """Down onto a seat or up from it, between two times."""

    start: float
    end: float
    down: bool
    seat: tuple[float, float, float]


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


class Route:
    """Builds the root's way and the steps; ask :meth:`root` and :meth:`feet` when all is said."""

    def __init__(
        self,
        skeleton: Skeleton,
        position: tuple[float, float, float],
        heading: float,
        seat: tuple[float, float, float] | None,
        person: np.random.Generator,
    ) -> None:
        self.skeleton = skeleton
        self.floor = position[2] if seat is None else 0.0
        self.hip = float(skeleton.bind[JOINT["thigh_l"]][1])
        self.splay = 0.14 + 0.08 * person.random(2)
        self.uneven = 0.03 * (person.random() - 0.5)
        self.now = 0.0
        self.heading = heading
        self.seat = seat
        self.sits: list[Sit] = []
        self.steps: list[Step] = []
        self._xy: list[Array] = []
        self._yaw: list[Array] = []
        self._starts: list[float] = []
        self.start_seated = seat is not None
        self.at = np.array(position[:2] if seat is None else seat[:2], dtype=np.float64)
        foot_at = self.at if seat is None else self._before(seat, heading)
        self.places = [self._stance(foot_at, heading, k, 1.0) for k in (0, 1)]
        self.first = tuple(self.places)

    def _before(self, seat: tuple[float, float, float], heading: float) -> Array:
        reach = seat_distance(self.skeleton, seat[2] - self.floor)
        return np.array(seat[:2]) + reach * np.array([np.cos(heading), np.sin(heading)])

    def _stance(self, xy: Array, yaw: float, foot: int, width: float) -> tuple[float, float, float]:
        """Where a foot stands under a body at ``xy`` facing ``yaw``; ``width`` 1 standing, less walking."""
        m = 1.0 - 2.0 * foot
        side = m * self.hip * (0.55 + 0.5 * width)
        ahead = m * self.uneven * width
        c, s = np.cos(yaw), np.sin(yaw)
        splay = m * self.splay[foot] * (0.4 + 0.6 * width)
        return (float(xy[0] + ahead * c - side * s), float(xy[1] + ahead * s + side * c), float(yaw + splay))

    # -- building --------------------------------------------------------------------------

    def wait(self, seconds: float) -> None:
        """Stays."""
        self.now += max(seconds, 0.0)

    def travel(
        self,
        path: Array | None,
        heading: float | None,
        manner: Manner,
        speed: float,
        stride: tuple[float, float] = (1.0, 1.0),
        rng: np.random.Generator | None = None,
    ) -> None:
        """Walks or runs along ``path`` [K, 2] (None: stays where it is) and turns to ``heading``."""
        line = _resampled(self.at, path)
        arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
        length = float(arc[-1])
        goes = length > 0.04
        tangent = _tangents(line) if goes else np.zeros(len(line))
        first = float(wrap(tangent[0] - self.heading)) if goes else 0.0
        end = self.heading + first + float(tangent[-1] - tangent[0])
        last = 0.0 if heading is None else float(wrap(heading - end))
        if not goes and abs(last) < 0.12:
            self.heading += last if goes else 0.0
            return
        step = manner.step * self.skeleton.height * stride[0]
        period = manner.period * np.sqrt(self.skeleton.height / 1.7) * stride[1] / speed
        timing = _timing(length, step / period, manner.ramp / speed, first, last, speed)
        xy, yaw, total = self._root_way(line, arc, tangent, timing, first, last)
        self._footfalls(xy, yaw, total, period, manner, first if goes else last, rng)
        self._push(xy, yaw)
        self.now += total
        self.at, self.heading = xy[-1].copy(), float(yaw[-1])

    def _root_way(
        self, line: Array, arc: Array, tangent: Array, timing: tuple[float, ...], first: float, last: float
    ) -> tuple[Array, Array, float]:
        turn_in, start, going, turn_out, out_start, total = timing
        t = np.arange(int(np.ceil(total * RATE)) + 1) / RATE
        share = _progress(t - start, going, timing)
        s = share * arc[-1]
        xy = np.stack([np.interp(s, arc, line[:, 0]), np.interp(s, arc, line[:, 1])], axis=1)
        yaw = self.heading + np.interp(s, arc, tangent - tangent[0])
        yaw = yaw + first * ramp(t, 0.0, turn_in) + last * ramp(t, out_start, out_start + turn_out)
        return xy, smooth(yaw, 0.05 * RATE), t[-1]

    def _footfalls(
        self,
        xy: Array,
        yaw: Array,
        total: float,
        period: float,
        manner: Manner,
        turn: float,
        rng: np.random.Generator | None,
    ) -> None:
        active = total - 0.06
        swing_share = manner.swing
        count = max(2, round(active / period - swing_share) + 1)
        period = active / (count - 1 + swing_share)
        swing, begin = swing_share * period, 0.03
        side = 0 if turn > 0.25 else 1 if turn < -0.25 else int(rng.random() < 0.5) if rng else 0
        run = 1.0 if manner.name == "run" else 0.0
        times = np.arange(len(xy)) / RATE
        for k in range(count):
            foot = (side + k) % 2
            lift = begin + k * period
            land = lift + swing
            mid = total if k >= count - 2 else land + 0.42 * (2 * period - swing)
            at = np.array([np.interp(mid, times, xy[:, 0]), np.interp(mid, times, xy[:, 1])])
            width = 1.0 if k >= count - 2 else 0.05 if run else 0.2
            place = self._stance(at, float(np.interp(mid, times, yaw)), foot, width)
            self.steps.append(Step(foot, self.now + lift, self.now + land, place, run))
            self.places[foot] = place

    def _push(self, xy: Array, yaw: Array) -> None:
        self._starts.append(self.now)
        self._xy.append(xy)
        self._yaw.append(yaw)

    def sit(self, seat: tuple[float, float, float], heading: float, duration: float) -> None:
        """Down onto a seat before which one stands, by :func:`seat_distance`."""
        self._shift(np.array(seat[:2]), duration)
        self.sits.append(Sit(self.now - duration, self.now, True, seat))
        self.seat = seat

    def stand(self, duration: float) -> None:
        """Up from the seat, over the feet."""
        if self.seat is None:
            return
        seat = self.seat
        self._shift(self._before(seat, self.heading), duration)
        self.sits.append(Sit(self.now - duration, self.now, False, seat))
        self.seat = None

    def stand_point(self, seat: tuple[float, float, float], heading: float) -> Array:
        """[2], where one stands to sit down."""
        return self._before(seat, heading)

    def _shift(self, to: Array, duration: float) -> None:
        t = np.arange(int(np.ceil(duration * RATE)) + 1) / RATE
        share = ease(t / t[-1])
        self._push(self.at + share[:, None] * (to - self.at), np.full(len(t), self.heading))
        self.now += duration
        self.at = to.copy()

    # -- asking ----------------------------------------------------------------------------

    def root(self, t: Array) -> tuple[Array, Array]:
        """Floor point [T, 2] and heading [T] at times ``t``; held before, between and after."""
        if not self._xy:
            return np.broadcast_to(self.at, (len(t), 2)).copy(), np.full(len(t), self.heading)
        stamps = np.concatenate(
            [s + np.arange(len(x)) / RATE for s, x in zip(self._starts, self._xy, strict=True)]
        )
        xy, yaw = np.concatenate(self._xy), np.unwrap(np.concatenate(self._yaw))
        return (
            np.stack([np.interp(t, stamps, xy[:, 0]), np.interp(t, stamps, xy[:, 1])], axis=1),
            np.interp(t, stamps, yaw),
        )

    def sitting(self, t: Array) -> Array:
        """[T]: 0 standing .. 1 on the seat."""
        share = np.full(len(t), 1.0 if self.start_seated else 0.0)
        for sit in self.sits:
            way = ramp(t, sit.start, sit.end)
            share = share + (way if sit.down else -way)
        return np.clip(share, 0.0, 1.0)

    def seat_height(self, t: Array, first: tuple[float, float, float] | None) -> Array:
        """[T]: height of the seat that is or will be sat on."""
        height = np.full(len(t), 0.45 if first is None else first[2])
        for sit in self.sits:
            height = np.where(t >= sit.start, sit.seat[2], height)
        return height

    def feet(self, t: Array) -> Feet:
        """Both feet at times ``t`` [T]."""
        tracks = [foot_track(t, self.first[k], [s for s in self.steps if s.foot == k]) for k in (0, 1)]
        return Feet(*(np.stack(parts) for parts in zip(*tracks, strict=True)))


def _resampled(at: Array, path: Array | None) -> Array:
    """The path from ``at`` on, a point every 4 cm, corners eased."""
    if path is None or len(path) == 0:
        return np.stack([at, at])
    points = np.asarray(path, dtype=np.float64)[:, :2]
    if np.linalg.norm(points[0] - at) < 0.6 and len(points) > 1:
        points = points[1:]
    points = np.concatenate([at[None], points])
    keep = np.concatenate([[True], np.linalg.norm(np.diff(points, axis=0), axis=1) > 1e-4])
    points = points[keep]
    if len(points) < 2:
        return np.stack([at, at])
    arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    s = np.linspace(0.0, arc[-1], max(3, int(arc[-1] / 0.04) + 1))
    line = np.stack([np.interp(s, arc, points[:, 0]), np.interp(s, arc, points[:, 1])], axis=1)
    chord = line[0] + (line[-1] - line[0]) * (s / max(arc[-1], 1e-9))[:, None]
    eased = chord + smooth(line - chord, 4.0)
    fade = np.minimum(1.0, np.minimum(s, arc[-1] - s) / 0.3)[:, None]
    return eased * fade + line * (1 - fade)


def _tangents(line: Array) -> Array:
    d = np.gradient(line, axis=0)
    return np.asarray(smooth(np.unwrap(np.arctan2(d[:, 1], d[:, 0])), 4.0))


def _timing(
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


def _progress(t: Array, going: float, timing: tuple[float, ...]) -> Array:
    """Share of the path covered: eased start, even pace, eased stop."""
    if going <= 0:
        return np.zeros(len(t))
    slack = min(0.62, 0.5 * going)
    speed = ramp(t, 0.0, slack) * (1.0 - ramp(t, going - slack, going))
    covered = np.concatenate([[0.0], np.cumsum(0.5 * (speed[1:] + speed[:-1]))])
    return np.asarray(covered / max(covered[-1], 1e-9))
