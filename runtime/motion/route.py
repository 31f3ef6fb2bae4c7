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

from runtime.world import Stairs

from .curves import ramp, smooth, wander
from .feet import Step
from .footfalls import paced, skipped
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
from .postures import WAYS, between
from .rotations import wrap
from .timeline import FootMove, Jump
from .trail import RATE, Flight, Leg, Sit, Stance, Trail
from .types import GaitStyle

Array = NDArray[np.float64]
Triple = tuple[float, float, float]
GRAVITY = 9.81
_FACING = {"ahead": 0.0, "back": np.pi, "left": np.pi / 2, "right": -np.pi / 2}


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


class Route(Trail):
    """Builds the root's way and the steps; ask :meth:`root` and :meth:`feet` when all is said."""

    # -- going -----------------------------------------------------------------------------

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
            skipped(total, period) if gait.name == "skip" else paced(total, period, gait.swing, style.limp)
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


def _ahead(heading: float) -> Array:
    """[2], one metre ahead."""
    return np.array([np.cos(heading), np.sin(heading)])


def _turned(offset: Array, angle: float) -> Array:
    """An offset [2] turned to the left."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([c * offset[0] - s * offset[1], s * offset[0] + c * offset[1]])


def _edge(old: str, new: str) -> tuple[float, float]:
    """Seconds from one posture to its neighbour, and how far forward (shares of height)."""
    if new in WAYS and WAYS[new][0] == old:
        return WAYS[new][1], WAYS[new][2]
    return WAYS[old][1], -WAYS[old][2]
