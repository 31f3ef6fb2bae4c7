"""Where a body goes and where its feet stand: walking, turning on the spot, stepping, jumping, sitting down.

A :class:`Route` is built by saying what comes after what; it is planned before any pose is made. The
root leads (an eased run along the path, heading along its tangent) and the feet follow: each foot lands
where the body will be in the middle of that foot's stance, and does not move until it is lifted again.
Positions are metres on the floor, times seconds from the shot's start.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from runtime.body.skeleton import JOINT, Skeleton
from runtime.world import Stairs

from .curves import ease, ramp, smooth, wander
from .feet import Feet, Footing, Step, foot_track, rolled
from .gait import (
    WALK,
    Gait,
    climbing,
    lengths,
    progress,
    resampled,
    seat_distance,
    tangents,
    timing,
    tread,
)
from .postures import WAYS, Row, between, row
from .rotations import wrap
from .types import FootMove, GaitStyle, Jump

Array = NDArray[np.float64]
Triple = tuple[float, float, float]
#: Planning steps a second; finer than any frame rate in use.
RATE = 60.0
GRAVITY = 9.81
_FACING = {"ahead": 0.0, "back": np.pi, "left": np.pi / 2, "right": -np.pi / 2}


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


@dataclass(frozen=True, eq=False)
class Going:
    """How a way is gone: gait, style, pace and what is particular about the person's steps.

    stride: factors on step length and on the time between steps; wobble: metres the way swerves
    stairs: flights on whose treads feet are set
    """

    gait: Gait = WALK
    speed: float = 1.0
    stride: tuple[float, float] = (1.0, 1.0)
    style: GaitStyle = field(default_factory=GaitStyle)
    wobble: float = 0.0
    stairs: tuple[Stairs, ...] = ()


class Route:
    """Builds the root's way and the steps; ask :meth:`root` and :meth:`feet` when all is said."""

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

    # -- going -----------------------------------------------------------------------------

    def wait(self, seconds: float) -> None:
        """Stays."""
        self.now += max(seconds, 0.0)

    def travel(
        self,
        path: Array | None,
        heading: float | None,
        going: Going | None = None,
        rng: np.random.Generator | None = None,
    ) -> None:
        """Goes along ``path`` [K, 2] or [K, 3] (None: stays where it is) and turns to ``heading``."""
        going = going if going is not None else Going()
        gait, speed = going.gait, going.speed
        line = self._swerved(resampled(self.at, path), going.wobble, rng)
        arc = lengths(line)
        goes = float(arc[-1]) > 0.04
        face = _FACING[going.style.facing] if goes else 0.0
        tangent = tangents(line) + face if goes else np.zeros(len(line))
        first = float(wrap(tangent[0] - self.heading)) if goes else 0.0
        end = self.heading + first + float(tangent[-1] - tangent[0])
        last = 0.0 if heading is None else float(wrap(heading - end))
        if not goes and abs(last) < 0.12:
            return
        step = gait.step * self.skeleton.height * going.stride[0] * (0.62 if face else 1.0)
        if going.stairs and goes:
            slow = climbing(line, going.stairs, step)
            arc = np.concatenate([[0.0], np.cumsum(np.diff(arc) * 0.5 * (slow[1:] + slow[:-1]))])
        if self.low and goes:  # palms planted ahead have the longer way around a bend
            ahead = self._palm_ahead()
            arc = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(arc), ahead * np.diff(tangent)))])
        period = gait.period * np.sqrt(self.skeleton.height / 1.7) * going.stride[1] / speed
        times = timing(float(arc[-1]), step / period, gait.ramp / speed, first, last, speed)
        xyz, yaw = self._root_way(line, arc, tangent, times, first, last)
        total = (len(xyz) - 1) / RATE
        self._footfalls(xyz, yaw, total, period, going, first if goes else last, rng)
        if goes:
            self.legs.append(Leg(self.now + times[1], self.now + times[1] + times[2], going.style, gait))
        self._push(xyz, yaw)
        self.now += total
        self.at, self.heading = xyz[-1].copy(), float(yaw[-1])
        self.floor = float(xyz[-1, 2])

    def _swerved(self, line: Array, wobble: float, rng: np.random.Generator | None) -> Array:
        """The line [N, 3] with slow curves to both sides, none at its ends."""
        arc = lengths(line)
        if wobble <= 0 or rng is None or arc[-1] < 0.8:
            return line
        ahead = np.gradient(line[:, :2], axis=0)
        across = np.stack([-ahead[:, 1], ahead[:, 0]], axis=1)
        across /= np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-9)
        fade = np.clip(np.minimum(arc, arc[-1] - arc) / 0.7, 0.0, 1.0)
        side = wobble * np.clip(wander(arc, rng, 1.7), -1.3, 1.3) * fade
        return line + np.concatenate([side[:, None] * across, np.zeros((len(line), 1))], axis=1)

    def _root_way(
        self, line: Array, arc: Array, tangent: Array, times: tuple[float, ...], first: float, last: float
    ) -> tuple[Array, Array]:
        turn_in, start, going, turn_out, out_start, total = times
        t = np.arange(int(np.ceil(total * RATE)) + 1) / RATE
        s = progress(t - start, going) * arc[-1]
        xyz = np.stack([np.interp(s, arc, line[:, k]) for k in range(3)], axis=1)
        yaw = self.heading + np.interp(s, arc, tangent - tangent[0])
        yaw = yaw + first * ramp(t, 0.0, turn_in) + last * ramp(t, out_start, out_start + turn_out)
        return xyz, smooth(yaw, 0.05 * RATE)

    def _footfalls(
        self,
        xyz: Array,
        yaw: Array,
        total: float,
        period: float,
        going: Going,
        turn: float,
        rng: np.random.Generator | None,
    ) -> None:
        gait, style = going.gait, going.style
        side = 0 if turn > 0.25 else 1 if turn < -0.25 else int(rng.random() < 0.5) if rng else 0
        falls = (
            _skipped(total, period) if gait.name == "skip" else _paced(total, period, gait.swing, style.limp)
        )
        times = np.arange(len(xyz)) / RATE
        for k, (foot, lift, land, stay) in enumerate(falls):
            foot = (side + foot) % 2
            ends = k >= len(falls) - 2
            mid = (
                total if ends else 0.5 * (land + stay) if gait.name == "skip" else land + 0.42 * (stay - land)
            )
            at = np.array([np.interp(mid, times, xyz[:, i]) for i in range(3)])
            facing = float(np.interp(mid, times, yaw))
            if self.low:
                place, pitch = self._low(foot, self.posture, at, facing), self.row(self.posture).feet[foot][2]
                palm = self._palm(1 - foot, at, facing)
                self._plant(1 - foot, self.now + lift, self.now + land, palm, float(at[2]))
            else:
                width = 1.0 if ends else 0.05 if gait.run == 1.0 else 0.2
                place = self._stance(at, facing, foot, width, style.width)
                pitch = 0.0 if ends else 0.62 * style.toes
            high = style.lift * self.scale * (0.3 if ends else 1.0)
            ground = float(at[2])
            trodden = tread(np.array([*place[:2], ground]), going.stairs, facing) if going.stairs else None
            if trodden is not None and not self.low:
                place, ground = (float(trodden[0]), float(trodden[1]), place[2]), float(trodden[2])
            self.steps.append(Step(foot, self.now + lift, self.now + land, place, gait.run, ground, pitch,
                                   high, style.stiff))  # fmt: skip
            self.feet_now[foot], self.pitch_now[foot] = place, pitch

    def _plant(self, hand: int, lift: float, land: float, place: Triple, ground: float) -> None:
        self.palm_steps.append(Step(hand, lift, land, place, ground=ground, high=0.04))
        self.palms_now[hand] = place

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

    # -- single steps and jumps ------------------------------------------------------------

    def step(self, move: FootMove, start: float, end: float) -> None:
        """One foot steps aside by itself; the root goes half the way with it."""
        foot = 0 if move.foot in ("left", "l") else 1
        x, y, yaw = self.feet_now[foot]
        m = 1.0 - 2.0 * foot
        c, s = np.cos(self.heading), np.sin(self.heading)
        by = np.array([move.ahead * c - m * move.out * s, move.ahead * s + m * move.out * c])
        around = _turned(np.array([x, y]) - self.at[:2], move.turn) + self.at[:2] + by
        place = (float(around[0]), float(around[1]), float(yaw + move.turn))
        self.steps.append(Step(foot, start, end, place, 0.0, self.floor, high=move.lift))
        self.feet_now[foot] = place
        wait = 0.12 * (end - start)
        self._move(start - wait, end + wait, 0.5 * by, 0.5 * move.turn)

    def jump(self, jump: Jump, start: float, end: float) -> None:
        """Off the floor with one foot or both, and down again."""
        height = jump.height or GRAVITY * (end - start) ** 2 / 8.0
        c, s = np.cos(self.heading), np.sin(self.heading)
        by = np.array([jump.ahead * c - jump.aside * s, jump.ahead * s + jump.aside * c])
        root = self.at[:2]
        hopping = {"both": (0, 1), "left": (0,), "right": (1,)}[jump.feet]
        for foot in (0, 1):
            x, y, yaw = self.feet_now[foot]
            xy = root + by + _turned(np.array([x, y]) - root, jump.turn)
            place = (float(xy[0]), float(xy[1]), float(yaw + jump.turn))
            tuck = jump.tuck if foot in hopping else 0.0
            self.steps.append(Step(foot, start, end, place, 0.0, self.floor, leap=height, tuck=tuck))
            self.feet_now[foot] = place
        self.flights.append(Flight(start, end, height))
        self._move(start - 0.06, end + 0.04, by, jump.turn)

    def carry(self, xyz: Array, yaw: Array, duration: float, steps: list[Step]) -> None:
        """Goes as is laid down elsewhere: floor points [K, 3] and headings [K] at :data:`RATE`, and steps."""
        for step in steps:
            self.steps.append(step)
            self.feet_now[step.foot], self.pitch_now[step.foot] = step.place, 0.0
        self._push(xyz, yaw)
        self.now += duration
        self.at, self.heading = xyz[-1].copy(), float(yaw[-1])

    # -- postures --------------------------------------------------------------------------

    def settle(self, posture: str, speed: float = 1.0, within: float = 0.0) -> None:
        """Takes a posture, by way of what lies between; within: seconds for all of it."""
        if self.seat is not None or posture == self.posture:
            return
        way = [self.posture, *between(self.posture, posture)]
        seconds = [_edge(a, b)[0] for a, b in pairwise(way)]
        factor = within / sum(seconds) if within > 0 else 1.0 / speed
        for (a, b), time in zip(pairwise(way), seconds, strict=True):
            self._change(a, b, time * factor)

    def _change(self, old: str, new: str, duration: float) -> None:
        start, end = self.now, self.now + duration
        ahead = _edge(old, new)[1] * self.skeleton.height
        by = ahead * np.array([np.cos(self.heading), np.sin(self.heading)])
        self._move(start + 0.1 * duration, start + 0.85 * duration, by, 0.0)
        self.posture = new
        late = 0.3 if old == "prone" else 0.08  # the hands come under the chest before it rises
        self.stances.append(Stance(start + late * duration, end, new, self.bed))
        order = (1, 0) if new != "standing" else (0, 1)
        spans = {order[0]: (0.06, 0.42), order[1]: (0.5, 0.86)}
        for foot in order:
            low = new != "standing"
            place = self._low(foot, new) if low else self._stance(self.at, self.heading, foot, 1.0)
            pitch = self.row(new).feet[foot][2] if low else 0.0
            old_place = self.feet_now[foot]
            far = np.hypot(place[0] - old_place[0], place[1] - old_place[1])
            near = far < 0.05 and abs(float(wrap(place[2] - old_place[2]))) < 0.3
            stays = near and abs(pitch - self.pitch_now[foot]) > 0.05
            if near and not stays:
                continue
            if stays:
                place = old_place
            a, b = (0.08, 0.9) if stays else spans[foot]
            ground = self.bed if low else self.floor
            a, b = start + a * duration, start + b * duration
            self.steps.append(Step(foot, a, b, place, 0.0, ground, pitch, slide=stays))
            self.feet_now[foot], self.pitch_now[foot] = place, pitch
        if new != "standing" and self.row(new).palms is not None:
            for hand in (0, 1):
                place = self._palm(hand)
                far = np.hypot(place[0] - self.palms_now[hand][0], place[1] - self.palms_now[hand][1])
                if far > 0.06:
                    a = start + (0.04 if hand else 0.2) * duration
                    self._plant(hand, a, a + 0.42 * duration, place, self.bed)
        self.now = end

    # -- beds ------------------------------------------------------------------------------

    @property
    def on_bed(self) -> bool:
        """Whether one lies on something."""
        return self.low and abs(self.bed - self.floor) > 0.05

    def lie(self, middle: Triple, head: float, duration: float) -> None:
        """Onto a bed beside which one stands: sits down on its edge, then swings the legs up and lies back.

        head: heading in which the head lies
        """
        self.bedside = self.at[:2].copy()
        away = self.at[:2] - np.array(middle[:2])
        self.travel(None, float(np.arctan2(away[1], away[0])))
        seat = self.at[:2] - seat_distance(self.skeleton, middle[2] - self.floor) * _ahead(self.heading)
        self.sit((float(seat[0]), float(seat[1]), middle[2]), 0.42 * duration)
        start, end = self.now, self.now + 0.58 * duration
        self.bed, self.posture, self.seat = middle[2], "lying", None
        turn = float(wrap(head + np.pi - self.heading))
        self._move(start, start + 0.8 * (end - start), np.array(middle[:2]) - self.at[:2], turn)
        self.stances.append(Stance(start + 0.1 * (end - start), end, "lying", middle[2]))
        self.sits.append(Sit(end, end + 0.02, False, (float(seat[0]), float(seat[1]), middle[2])))
        self._swing_feet(start, end, [self._low(k, "lying") for k in (0, 1)], middle[2], True)
        self.now = end

    def leave_bed(self, to: Array | None, duration: float) -> None:
        """Sits up on the edge of the bed, on the side of ``to`` (None: where one came from, else
        on the left), with the feet on the floor."""
        if to is None:
            to = self.bedside
        if to is None:
            to = self.at[:2] + 0.95 * _ahead(self.heading + 0.5 * np.pi)
        way = to - self.at[:2]
        heading = float(np.arctan2(way[1], way[0]))
        reach = seat_distance(self.skeleton, self.bed - self.floor)
        edge = to - reach * _ahead(heading)
        seat = (float(edge[0]), float(edge[1]), self.bed)
        start, end = self.now, self.now + duration
        self.sits.append(Sit(start - 0.02, start, True, seat))
        self._move(start + 0.15 * duration, end, edge - self.at[:2], float(wrap(heading - self.heading)))
        self.stances.append(Stance(start, start + 0.9 * duration, "standing", self.bed))
        self.posture, self.seat, self.bed = "sitting", seat, self.floor
        stand = np.array([*to, self.floor])
        places = [self._stance(stand, self.heading, k, 1.0) for k in (0, 1)]
        self._swing_feet(start, end, places, self.floor, False)
        self.now = end

    def _swing_feet(self, start: float, end: float, places: list[Triple], ground: float, low: bool) -> None:
        """Both feet through the air onto a bed or off it."""
        for k, (a, b) in enumerate(((0.1, 0.72), (0.22, 0.86))):
            pitch = self.row("lying").feet[k][2] if low else 0.0
            times = (start + a * (end - start), start + b * (end - start))
            self.steps.append(Step(k, *times, places[k], 0.0, ground, pitch, 0.08, 1.0))
            self.feet_now[k], self.pitch_now[k] = places[k], pitch

    # -- seats -----------------------------------------------------------------------------

    def sit(self, seat: Triple, duration: float) -> None:
        """Down onto a seat before which one stands, by :func:`seat_distance`."""
        self._shift(np.array(seat[:2]), duration)
        self.sits.append(Sit(self.now - duration, self.now, True, seat))
        self.seat, self.posture = seat, "sitting"

    def stand(self, duration: float) -> None:
        """Up from the seat, over the feet."""
        if self.seat is None:
            return
        seat = self.seat
        self._shift(self._before(seat, self.heading), duration)
        self.sits.append(Sit(self.now - duration, self.now, False, seat))
        self.seat, self.posture = None, "standing"

    def stand_point(self, seat: Triple, heading: float) -> Array:
        """[2], where one stands to sit down."""
        return self._before(seat, heading)

    def _shift(self, to: Array, duration: float) -> None:
        t = np.arange(int(np.ceil(duration * RATE)) + 1) / RATE
        share = ease(t / t[-1])
        there = np.array([to[0], to[1], self.at[2]])
        self._push(self.at + share[:, None] * (there - self.at), np.full(len(t), self.heading))
        self.now += duration
        self.at = there

    # -- asking ----------------------------------------------------------------------------

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


def _ahead(heading: float) -> Array:
    """[2], one metre ahead."""
    return np.array([np.cos(heading), np.sin(heading)])


def _turned(offset: Array, angle: float) -> Array:
    """An offset [2] turned to the left."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([c * offset[0] - s * offset[1], s * offset[0] + c * offset[1]])


def _tracks(t: Array, first: list[Footing], steps: list[Step]) -> Feet:
    ordered = sorted(steps, key=lambda s: s.lift)
    tracks = [foot_track(t, first[k], [s for s in ordered if s.foot == k]) for k in (0, 1)]
    return Feet(*(np.stack(parts) for parts in zip(*tracks, strict=True)))


def _edge(old: str, new: str) -> tuple[float, float]:
    """Seconds from one posture to its neighbour, and how far forward (shares of height)."""
    if new in WAYS and WAYS[new][0] == old:
        return WAYS[new][1], WAYS[new][2]
    return WAYS[old][1], -WAYS[old][2]


Fall = tuple[int, float, float, float]


def _paced(total: float, period: float, swing_share: float, limp: float) -> list[Fall]:
    """Footfalls (foot after foot, lift, land, next lift) that fill the time of a way."""
    active = total - 0.06
    count = max(2, round(active / period - swing_share) + 1)
    period = active / (count - 1 + swing_share)
    swing = swing_share * period
    falls = []
    for k in range(count):
        late = 0.28 * limp * period * (k % 2) * (k < count - 1)
        lift = 0.03 + k * period + late
        land = 0.03 + k * period + swing
        falls.append((k % 2, lift, land, 0.03 + (k + 2) * period))
    return falls


def _skipped(total: float, period: float) -> list[Fall]:
    """Footfalls of skipping: each foot steps and hops once, then the other."""
    count = max(2, round((total - 0.1) / period))
    period = (total - 0.1) / count
    falls: list[Fall] = []
    lands = [0.05 + (k + 1) * period for k in range(count)]
    before: dict[int, float] = {0: 0.0, 1: 0.0}
    for k, land in enumerate(lands):
        foot, hop = (k // 2) % 2, k % 2 == 1
        lift = land - 0.55 * period if hop else max(before[foot], land - 2.2 * period)
        falls.append((foot, max(lift, 0.02), land, land + (0.45 if not hop else 0.6) * period))
        before[foot] = land + 0.35 * period
    last = {f for f, *_ in falls[-2:]}
    if len(last) == 1:  # the other foot closes up
        other = 1 - falls[-1][0]
        falls.append((other, max(before[other], total - 0.4), total - 0.02, total + 0.3))
    return falls
