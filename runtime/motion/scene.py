"""Posing everybody of a shot, stage by stage: gaze, torso, hands, then the things they hold."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from runtime.body.skeleton import JOINT

from .acting import Performer
from .contacts import CARRYING, SIDE, Contacts, HandTracks, Layer, Wield, holding_weight, reach_layer
from .curves import plateau, ramp, wander
from .face import GazePull, fade, relative_gaze
from .figure import Figure
from .held import HANGS, Held
from .hinges import followed, handle_track, openness
from .holding import holds_of, spans_of
from .plan import Plan, Window
from .props import track_prop
from .rotations import wrap
from .timeline import Gaze, Reach
from .types import PropState, TargetPoint, Task
from .words import BODY_PLACES

Array = NDArray[np.float64]
#: Metres that what hangs from a hand or stands beside one is kept off the floor.
_OFF_FLOOR = 0.04


class Scene:
    """The stages of posing everybody, in the order of :meth:`run`."""

    def __init__(
        self,
        plans: dict[str, Plan],
        tasks: dict[str, Task],
        props: dict[int, PropState],
        t: Array,
        fps: float,
        seed: int,
    ) -> None:
        self.plans, self.tasks, self.t, self.fps = plans, tasks, t, fps
        self.rest = props
        self.seed = seed
        self.performers = {n: Performer(p, t, fps, seeded(seed, n, 2)) for n, p in plans.items()}
        self.holds = holds_of(plans, props)
        self.props: dict[int, Array] = {}
        self.open = {k: openness(p, plans.values(), k, t) for k, p in props.items() if p.hinge is not None}
        self.parts = {k: p.hinge.matrices(self.open[k]) for k, p in props.items() if p.hinge is not None}

    def run(self) -> None:
        eyes = {n: p.eye_point() for n, p in self.performers.items()}
        palms: dict[str, Array] = {}
        self.tracks: dict[str, HandTracks] = {}
        for name, performer in self.performers.items():
            performer.talk()
            performer.gaze(self._pulls(name, eyes))
            self.tracks[name] = self._tracks(name)
            performer.stand()
        order = self._arms_in_order()
        for name, performer in self.performers.items():
            performer.reach_body(self.tracks[name])
            performer.attend()
        for name, performer in order:
            palms[name] = performer.arms(Contacts(self.tracks[name]))
            performer.face()
        hands = {n: p.figure for n, p in self.performers.items()}
        self.props.update(self.parts)
        for k, prop in self.rest.items():
            if k in self.parts:
                continue
            self.props[k] = track_prop(prop, self.holds.get(k, []), self.t, palms, hands, self.tracks,
                                       {n: p.goal_rotation for n, p in self.performers.items()})  # fmt: skip

    def _arms_in_order(self) -> list[tuple[str, Performer]]:
        """Who takes the other by the arm comes after them; until then it hangs as it does by itself."""
        follows = {
            n: any(x.place_of in ("partner.hand", "partner.elbow") for x in tracks.layers)
            for n, tracks in self.tracks.items()
        }
        if any(follows.values()):
            for name, performer in self.performers.items():
                if not follows[name]:
                    performer.reach_body(self.tracks[name])
                performer.arms(Contacts(self.tracks[name]))
        return sorted(self.performers.items(), key=lambda item: follows[item[0]])

    # -- gaze ------------------------------------------------------------------------------

    def _pulls(self, name: str, eyes: dict[str, Array]) -> list[GazePull]:
        performer = self.performers[name]
        plan = performer.plan
        pulls = []
        if not plan.acts:
            pulls += self._watching(name, eyes)
        for window in plan.windows:
            for gaze in window.timeline.gazes:
                start = window.at(gaze.start)
                end = (
                    window.at(gaze.end) if gaze.end < 1.0 else min(1e9, window.until)
                )  # on into what follows
                weight = fade(self.t, start, end)
                pulls.append(self._pull(performer, gaze, window, weight, eyes))
        return pulls

    def _watching(self, name: str, eyes: dict[str, Array]) -> list[GazePull]:
        """Who has nothing to do looks at who acts, and sometimes elsewhere."""
        main = next((n for n in self.tasks if n != name), None)
        main = main or next((n for n in eyes if n != name), None)
        if main is None:
            return []
        performer = self.performers[name]
        rng = seeded(self.seed, name, 3)
        turn, down = relative_gaze(eyes[name], performer.yaw, performer.low.looks, eyes[main])
        near = 1.0 - np.clip((np.abs(wrap(turn)) - 1.5) / 0.6, 0.0, 1.0)
        away = wander(self.t + 40.0 * rng.random(), rng, 5.0)
        weight = near * (1.0 - np.clip(3.0 * (away - 0.9), 0.0, 1.0)) * plateau(self.t, -1, 0, 1e6, 2e6)
        return [GazePull(turn, down, np.asarray(weight), 0.65, eyes[main])]

    def _pull(
        self, performer: Performer, gaze: Gaze, window: Window, weight: Array, eyes: dict[str, Array]
    ) -> GazePull:
        zero = np.zeros(len(self.t))
        fixed = {"ahead": (0.0, 0.0), "down": (0.0, 0.55), "up": (0.15, -0.35), "aside": (0.55, 0.08)}
        if gaze.to in fixed:
            turn, down = fixed[gaze.to]
            return GazePull(zero + turn, zero + down, weight, gaze.share)
        if gaze.to == "around":
            rng = seeded(self.seed, performer.plan.name, 4)
            turn_track = 0.75 * wander(self.t, rng, 3.2)
            return GazePull(turn_track, 0.12 * wander(self.t, rng, 2.6), weight, gaze.share)
        if gaze.to == "held":
            side = -1.0 if window.hands.get("holding") == "r" else 1.0
            return GazePull(zero + 0.25 * side, zero + 0.6, weight, gaze.share)
        point = window.second if gaze.to == "second" else window.target
        who = window.partner if gaze.to == "partner" else point.character if point is not None else None
        if who is not None and who in eyes:
            at = eyes[who]
        elif point is not None:
            at = np.asarray(point.gaze, dtype=np.float64)
        else:
            return GazePull(zero, zero, 0.0 * weight, gaze.share)
        eye = eyes[performer.plan.name]
        turn_to, down_to = relative_gaze(eye, performer.yaw, performer.low.looks, at)
        point_track = np.broadcast_to(at, (len(self.t), 3))
        return GazePull(turn_to, down_to, weight, gaze.share, point_track)

    # -- hands ------------------------------------------------------------------------------

    def _tracks(self, name: str) -> HandTracks:
        performer = self.performers[name]
        t, plan = self.t, performer.plan
        posed = performer.channels.pair("arm", "weight")
        upright = (1 - performer.sitting) * (1 - performer.low.share) * (1 - posed)
        carry, bend = np.zeros((2, len(t))), np.full((2, len(t)), CARRYING)
        for k, side in enumerate("lr"):
            for thing, holds in self.holds.items():
                weight = holding_weight(t, spans_of(holds, name, side))
                carry[k] = np.maximum(carry[k], weight)
                bend[k] += weight * upright[k] * (self._bend(performer, thing) - CARRYING)
        tilt, dip = np.zeros((2, len(t))), np.zeros((2, len(t)))
        lap = performer.sitting * (1 - posed) * (1 - carry)
        layers = []
        if performer.sitting.max() > 0:
            layers = [Layer(k, lap[k], "lap", np.zeros(3), (0.35, -0.15, 1.35)) for k in (0, 1)]
        layers += performer.resting(posed, carry)
        for window in plan.windows:
            for tip in window.timeline.tilts:
                times = [window.at(x) for x in (tip.start, tip.arrive, tip.leave, tip.end)]
                side = window.hands[tip.hand]
                held = self._held(name, side, times[1])
                if held is not None and held.handle and not _to_body(window, side):
                    dip[SIDE[side]] += 0.55 * tip.angle * plateau(t, *times)  # a pot is tipped forward
                else:
                    tilt[SIDE[side]] += tip.angle * plateau(t, *times)
            for reach in window.timeline.reaches:
                layer = self._reach(performer, window, reach)
                if layer is not None and np.isfinite(window.until):
                    layer = replace(
                        layer, weight=layer.weight * (1 - ramp(t, window.until, window.until + 0.6))
                    )
                if layer is not None:
                    layers.append(layer)
        wield = Wield.of(performer.channels)
        return HandTracks(t, performer.yaw, carry, (tilt, dip), layers, performer.skeleton, wield, bend)

    def _bend(self, performer: Performer, thing: int) -> float:
        """Radians of the elbow somebody who stands carries a thing with: what hangs stays off the floor."""
        grip = self.rest[thing].grip
        if grip[2] < HANGS:
            return CARRYING
        arm = performer.figure.arm_length
        up = float(performer.skeleton.bind[JOINT["upperarm_l"], 2]) - grip[2] - _OFF_FLOOR
        return float(np.clip(np.arccos(np.clip(2.0 * up / arm - 1.0, -1.0, 1.0)), 0.12, CARRYING))

    def _reach(self, performer: Performer, window: Window, reach: Reach) -> Layer | None:
        side = window.hands[reach.hand]
        k = SIDE[side]
        arrive = window.at(reach.arrive)
        held_id = self._held_id(performer.plan.name, side, arrive + 1e-3)
        held = self._held(performer.plan.name, side, arrive + 1e-3)
        extra = np.zeros(3)
        fingers = None
        other: tuple[Figure, bool] | None = None
        led: tuple[Held, str] | None = None
        tipped = held is not None and any(
            window.hands[x.hand] == side and x.start < reach.end and x.end > reach.start
            for x in window.timeline.tilts
        )
        place: Array | str | None
        if reach.to in ("target", "second"):
            point = window.second if reach.to == "second" else window.target
            place = self._point(point, held_id, arrive)
            if place is not None and reach.palm == "ahead":  # pushed at the chest, however high it is
                chest = 0.72 * performer.height + performer.plan.actor.state.position[2]
                place = np.minimum(place, [np.inf, np.inf, chest])
            if point is not None and point.object in self.parts:
                track = handle_track(self.rest[point.object], self.parts[point.object])
                place = followed(track, self.t, arrive, window.at(reach.leave))
            puts = held_id is not None and self._put_here(window, side)
            if puts:
                place = self._put_at(performer.plan.name, side, held_id)
            if held is not None:
                led = (held, "spout") if tipped else (held, "foot") if puts else None
                extra[2] = 0.003 if puts else 0.0
            if held is None and point is not None and point.object in self.rest:
                there = self.rest[point.object]
                thing = Held(arrive, there.world_from_object[:3, :3], np.asarray(there.grip))
                fingers = thing.axis_yaw if thing.handle else None
        elif reach.to in ("meet", "clasp"):
            place = self._meet(performer, window, arrive, clasped=reach.to == "clasp")
        elif reach.to.startswith("partner."):
            other = self._other(performer, window, arrive)
            place = reach.to if other is not None else None
        else:
            place = reach.to
            if held is not None and tipped:
                led = (held, "rim")
                extra[0] = 0.03
        if reach.lead == "point" and held is not None:
            led = (held, "point")
        if reach.to == "held":
            beside = self._held(performer.plan.name, "lr"[1 - k], arrive + 1e-3)
            led, place = (None, None) if beside is None else ((beside, "along"), place)
            extra[0 if beside is not None and beside.handle else 2] += reach.along
        if place is None:
            return None
        xy, heading, _ = performer.plan.route.root(np.array([arrive]))
        return reach_layer(reach, k, (window.start, window.duration), self.t, place,
                           (xy[0], float(heading[0]), performer.skeleton), led,
                           extra, fingers, other)  # fmt: skip

    def _put_here(self, window: Window, side: str) -> bool:
        return any(g.kind == "put" and window.hands[g.hand] == side for g in window.timeline.grasps)

    def _put_at(self, name: str, side: str, thing: int | None) -> Array | None:
        """Where the thing in a hand is going to stand [T, 3]."""
        holds = self.holds.get(thing, []) if thing is not None else []
        place = next((h.place for h in holds if h.person == name and h.hand == side and h.place), None)
        return None if place is None else np.broadcast_to(np.asarray(place), (len(self.t), 3))

    def _point(self, point: TargetPoint | None, held: int | None, time: float) -> Array | None:
        """A target's contact point [T, 3] in the world; where a thing to be put down is to stand."""
        if point is None:
            return None
        at = np.asarray(point.position, dtype=np.float64)
        if point.object is not None and point.object in self.rest and point.object != held:
            prop = self._prop_before(point.object, time)
            at = (prop @ np.array([*self.rest[point.object].grip, 1.0]))[:3]
        elif point.object is not None and point.object == held:
            return None
        if point.character is not None and point.character in self.performers:
            other = self.performers[point.character]
            h = other.height
            xy = other.root
            return np.concatenate([xy, np.full((len(xy), 1), 0.80 * h)], axis=1) * np.array([1.0, 1.0, 1.0])
        return np.broadcast_to(at, (len(self.t), 3))

    def _prop_before(self, thing: int, time: float) -> Array:
        """Where a thing lies before ``time`` (put-downs of this shot count)."""
        matrix = self.rest[thing].world_from_object
        for hold in self.holds.get(thing, []):
            if hold.end < time and hold.place is not None:
                matrix = matrix.copy()
                matrix[:3, 3] = hold.place
        return matrix

    def _frame(self, time: float) -> int:
        """The frame at a time; what began in a shot before, at the first."""
        return min(max(int(time * self.fps), 0), len(self.t) - 1)

    def _other(self, performer: Performer, window: Window, time: float) -> tuple[Figure, bool] | None:
        """The other person's figure, and whether the two face each other."""
        other = self.performers.get(window.partner or "")
        if other is None:
            return None
        i = self._frame(time)
        return other.figure, bool(np.cos(other.yaw[i] - performer.yaw[i]) < 0)

    def _meet(self, performer: Performer, window: Window, time: float, clasped: bool = False) -> Array | None:
        """Where hands meet between two people; where they clasp each other it goes along with both."""
        other = self.performers.get(window.partner or "")
        if other is None:
            return None
        i = self._frame(time)
        mine, theirs = performer.root[i], other.root[i]
        gap = theirs - mine
        middle = 0.5 * (mine + theirs) - 0.045 * gap / max(float(np.linalg.norm(gap)), 1e-6)
        low = [p.eye_point()[i, 2] - 0.30 * p.height for p in (performer, other)]
        up = 0.5 * sum(low)
        if clasped:
            between = 0.5 * (performer.root + other.root)
            return np.concatenate([between, np.full((len(self.t), 1), up)], axis=1)
        return np.broadcast_to(np.array([*middle, up]), (len(self.t), 3))

    def _held(self, name: str, side: str, time: float) -> Held | None:
        """The thing in a hand just before ``time``, as it was when that hand took it."""
        thing = self._held_id(name, side, time)
        if thing is None:
            return None
        prop = self.rest[thing]
        hold = next(h for h in reversed(self.holds[thing]) if h.person == name and h.hand == side)
        return Held(hold.start, prop.world_from_object[:3, :3], np.asarray(prop.grip))

    def _held_id(self, name: str, side: str, time: float) -> int | None:
        for thing, holds in self.holds.items():
            for hold in holds:
                if hold.person == name and hold.hand == side and hold.start < time <= hold.end + 1e-3:
                    return thing
        return None

    # -- the end ------------------------------------------------------------------------------

    def held_at_end(self, name: str) -> tuple[tuple[str, int], ...]:
        pairs = [
            (h[-1].hand, k) for k, h in self.holds.items() if h and h[-1].person == name and h[-1].end > 1e8
        ]
        unknown = [x for x in self.plans[name].actor.state.held if x[1] not in self.rest]
        return tuple(sorted([*pairs, *unknown]))

    def end_props(self) -> dict[int, PropState]:
        out = {}
        for k, prop in self.rest.items():
            holds = self.holds.get(k, [])
            last = holds[-1] if holds else None
            holder = (last.person, last.hand) if last is not None and last.end > 1e8 else None
            home = prop.stands if holder is not None else None
            share = float(self.open[k][-1]) if k in self.open else 0.0
            matrix = self.props[k][-1].astype(np.float64)
            out[k] = PropState(matrix, prop.grip, holder, home, prop.hinge, share)
        return out


def _to_body(window: Window, side: str) -> bool:
    """Whether that hand goes to the person's own body in this window, as for drinking."""
    return any(r.to in BODY_PLACES and window.hands[r.hand] == side for r in window.timeline.reaches)


def seeded(seed: int, name: str, purpose: int) -> np.random.Generator:
    """A generator for one person and one purpose."""
    return np.random.default_rng([seed & 0xFFFFFFFF, purpose, *name.encode()])
