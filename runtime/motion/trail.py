"""Where a body and its feet are over time, as it is laid down piece by piece; asked when all is said.

Positions are metres in the world, headings radians, times seconds from the shot's start. The root is held
before, between and after the pieces; a foot does not move until it is lifted.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from runtime.body.skeleton import JOINT, Skeleton

from .curves import ease, ramp
from .feet import Feet, Footing, Step, foot_track, rolled
from .gait import (
    Gait,
    seat_distance,
)
from .postures import Row, row
from .types import GaitStyle

Array = NDArray[np.float64]
Triple = tuple[float, float, float]
#: Planning steps a second; finer than any frame rate in use.
RATE = 60.0


@dataclass(frozen=True)
class Sit:
    """Down onto a seat or up from it, between two times."""

    start: float
    end: float
    down: bool
    seat: Triple


@dataclass(frozen=True)
class Stance:
    """A low posture taken (or left, for ``standing``) between two times, on a floor or bed of that height."""

    start: float
    end: float
    name: str
    ground: float


@dataclass(frozen=True)
class Leg:
    """A stretch of the way in one gait and style, between two times."""

    start: float
    end: float
    style: GaitStyle
    gait: Gait


@dataclass(frozen=True)
class Flight:
    """The body off the floor between two times, ``height`` metres up in the middle."""

    start: float
    end: float
    height: float


def _tracks(t: Array, first: list[Footing], steps: list[Step]) -> Feet:
    ordered = sorted(steps, key=lambda s: s.lift)
    tracks = [foot_track(t, first[k], [s for s in ordered if s.foot == k]) for k in (0, 1)]
    return Feet(*(np.stack(parts) for parts in zip(*tracks, strict=True)))


class Trail:
    """What is laid down so far: the root, steps, sits and stances by time. ``now`` is where the next begins;
    ``at``, ``heading``, ``floor``, ``seat``, ``posture`` and ``feet_now`` are how one is then."""

    def __init__(
        self,
        skeleton: Skeleton,
        position: Triple,
        heading: float,
        seat: Triple | None,
        person: np.random.Generator,
        posture: str = "standing",
    ) -> None:
        self.skeleton = skeleton
        self.posture = posture
        sits = posture == "sitting" and seat is not None
        self.seat = seat if sits else None
        self.floor = position[2]
        self.hip = float(skeleton.bind[JOINT["thigh_l"]][1])
        self.scale = skeleton.height / 1.7
        self.splay = 0.14 + 0.08 * person.random(2)
        self.uneven = 0.03 * (person.random() - 0.5)
        self.now = 0.0
        self.heading = heading
        self.start_seat = self.seat
        self.sits: list[Sit] = []
        self.steps: list[Step] = []
        self.palm_steps: list[Step] = []
        self.stances: list[Stance] = []
        self.legs: list[Leg] = []
        self.flights: list[Flight] = []
        self._xyz: list[Array] = []
        self._yaw: list[Array] = []
        self._starts: list[float] = []
        self._moves: list[tuple[float, float, Array]] = []  # start, end, (x, y, z, yaw) on top
        self._moved = np.zeros(4)
        ground = seat[2] if seat is not None and not sits else self.floor
        self.bed = ground
        self.bedside: Array | None = None
        self.at = np.array([*(self.seat or position)[:2], self.floor])
        foot_at = self.at if self.seat is None else np.array([*self._before(self.seat, heading), self.floor])
        self.rows: dict[str, Row] = {}
        if self.low:
            self.stances.append(Stance(-2e6, -1e6, posture, ground))
        low = posture not in ("standing", "sitting")
        self.feet_now = [
            self._low(k, posture) if low else self._stance(foot_at, heading, k, 1.0) for k in (0, 1)
        ]
        pitches = [self.row(posture).feet[k][2] if low else 0.0 for k in (0, 1)]
        self.first = [Footing(p, ground, q) for p, q in zip(self.feet_now, pitches, strict=True)]
        self.pitch_now = pitches
        self.palms_first = [Footing(self._palm(k)) for k in (0, 1)]
        self.palms_now = [p.place for p in self.palms_first]

    def row(self, posture: str) -> Row:
        """The row of a low posture for this body."""
        if posture not in self.rows:
            self.rows[posture] = row(posture, self.skeleton)
        return self.rows[posture]

    @property
    def low(self) -> bool:
        """Whether one is neither standing nor on a seat."""
        return self.posture not in ("standing", "sitting")

    @property
    def on_bed(self) -> bool:
        """Whether one lies on something."""
        return self.low and abs(self.bed - self.floor) > 0.05

    # -- where feet and palms go ---------------------------------------------------------------

    def _before(self, seat: Triple, heading: float) -> Array:
        reach = seat_distance(self.skeleton, seat[2] - self.floor)
        return np.array(seat[:2]) + reach * np.array([np.cos(heading), np.sin(heading)])

    def _stance(self, xy: Array, yaw: float, foot: int, width: float, wide: float = 1.0) -> Triple:
        """Where a foot stands under a body at ``xy`` facing ``yaw``; ``width`` 1 standing, less walking."""
        m = 1.0 - 2.0 * foot
        side = m * self.hip * (0.55 + 0.5 * width) * wide
        ahead = m * self.uneven * width
        c, s = np.cos(yaw), np.sin(yaw)
        splay = m * self.splay[foot] * (0.4 + 0.6 * width)
        return (float(xy[0] + ahead * c - side * s), float(xy[1] + ahead * s + side * c), float(yaw + splay))

    def _from_root(self, ahead: float, left: float, turn: float, at: Array, yaw: float) -> Triple:
        c, s = np.cos(yaw), np.sin(yaw)
        return (float(at[0] + ahead * c - left * s), float(at[1] + ahead * s + left * c), float(yaw + turn))

    def _low(self, foot: int, posture: str, at: Array | None = None, yaw: float | None = None) -> Triple:
        """Where a foot lies in a low posture, so that its ankle is where the row says."""
        r = self.row(posture)
        ahead, out, pitch = r.feet[foot]
        m = 1.0 - 2.0 * foot
        back = float(rolled(self.skeleton, np.array(pitch))[0])
        at, yaw = self.at if at is None else at, self.heading if yaw is None else yaw
        place = self._from_root(ahead, m * out, m * r.splay, at, yaw)
        return (place[0] - back * np.cos(place[2]), place[1] - back * np.sin(place[2]), place[2])

    def _palm(self, hand: int, at: Array | None = None, yaw: float | None = None) -> Triple:
        """Where a palm is planted on all fours."""
        palms = self.row(self.posture).palms if self.low else None
        out = palms[1] if palms is not None else self.hip
        at, yaw = self.at if at is None else at, self.heading if yaw is None else yaw
        return self._from_root(self._palm_ahead(), (1.0 - 2.0 * hand) * out, 0.0, at, yaw)

    def _palm_ahead(self) -> float:
        """How far before the root a palm is planted."""
        palms = self.row(self.posture).palms if self.low else None
        return palms[0] if palms is not None else 0.3

    # -- laying down ---------------------------------------------------------------------------

    def wait(self, seconds: float) -> None:
        """Stays."""
        self.now += max(seconds, 0.0)

    def _push(self, xyz: Array, yaw: Array) -> None:
        self._starts.append(self.now)
        self._xyz.append(xyz - self._moved[:3])
        self._yaw.append(yaw - self._moved[3])

    def _move(self, start: float, end: float, by: Array, turn: float) -> None:
        """The root goes ``by`` (x, y) between two times, and turns; on top of all else."""
        change = np.array([by[0], by[1], 0.0, turn])
        self._moves.append((start, end, change))
        self._moved = self._moved + change
        self.at = self.at + change[:3]
        self.heading += turn

    def _shift(self, to: Array, duration: float) -> None:
        t = np.arange(int(np.ceil(duration * RATE)) + 1) / RATE
        share = ease(t / t[-1])
        there = np.array([to[0], to[1], self.at[2]])
        self._push(self.at + share[:, None] * (there - self.at), np.full(len(t), self.heading))
        self.now += duration
        self.at = there

    def _plant(self, hand: int, lift: float, land: float, place: Triple, ground: float) -> None:
        self.palm_steps.append(Step(hand, lift, land, place, ground=ground, high=0.04))
        self.palms_now[hand] = place

    # -- asking --------------------------------------------------------------------------------

    def root(self, t: Array) -> tuple[Array, Array, Array]:
        """Floor point [T, 2], heading [T] and height of the floor [T] at times ``t``; held before, between
        and after."""
        if not self._xyz:
            base = np.broadcast_to([*self.at, self.heading], (len(t), 4)) - self._moved
        else:
            stamps = np.concatenate(
                [s + np.arange(len(x)) / RATE for s, x in zip(self._starts, self._xyz, strict=True)]
            )
            xyz, yaw = np.concatenate(self._xyz), np.unwrap(np.concatenate(self._yaw))
            columns = [*xyz.T, yaw]
            base = np.stack([np.interp(t, stamps, c) for c in columns], axis=1)
        out = base.copy()
        for start, end, change in self._moves:
            out += ramp(t, start, end)[:, None] * change
        return out[:, :2], out[:, 3], out[:, 2]

    def sitting(self, t: Array) -> Array:
        """[T]: 0 standing .. 1 on the seat."""
        share = np.full(len(t), 0.0 if self.start_seat is None else 1.0)
        for sit in self.sits:
            way = ramp(t, sit.start, sit.end)
            share = share + (way if sit.down else -way)
        return np.clip(share, 0.0, 1.0)

    def seat_height(self, t: Array) -> Array:
        """[T]: height of the seat that is or will be sat on."""
        height = np.full(len(t), 0.45 if self.start_seat is None else self.start_seat[2])
        for sit in self.sits:
            height = np.where(t >= sit.start, sit.seat[2], height)
        return height

    def feet(self, t: Array) -> Feet:
        """Both feet at times ``t`` [T]."""
        return _tracks(t, self.first, self.steps)

    def palms(self, t: Array) -> Feet:
        """Both palms planted on the floor at times ``t`` [T]."""
        return _tracks(t, self.palms_first, self.palm_steps)
