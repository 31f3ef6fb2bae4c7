"""From a task to a plan: what comes after what, where, with which hand. No poses yet.

A plan has a :class:`~runtime.motion.gait.Route`, windows in which timelines play, and the moments at
which things change hands. Everything is decided here from positions and times alone.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from runtime.body.skeleton import JOINT

from .channels import enlarged
from .gait import GAITS, WALK
from .manner import PLAIN, Manner, manner_of
from .postures import WAYS
from .replay import Replay, fitted
from .rotations import wrap
from .route import RATE, Going, Route
from .types import (
    Actor,
    Capture,
    Drive,
    FootMove,
    GaitStyle,
    Gaze,
    Grasp,
    Jump,
    Kept,
    Passage,
    Point,
    PropState,
    Reach,
    TargetPoint,
    Task,
    Timeline,
    Track,
)

Array = NDArray[np.float64]

#: Opening a door one comes to: a hand on the handle, which it lets go of before the leaf has swung away.
PASS = Timeline(
    tracks=(Track("fingers_near.curl", (0.0, 0.3, 0.4, 0.66, 1.0), (0.25, 0.2, 0.75, 0.7, 0.25)),),
    reaches=(Reach("near", "target", 0.0, 0.36, 0.68, 1.0),),
    gazes=(Gaze("target", 0.0, 0.5),),
    drives=(Drive("target", 1.0, 0.38, 0.9),),
)
PASS_TIME = 1.5
#: Taking hold of a thing that an action needs and that is not in a hand yet.
PICK = Timeline(
    reaches=(Reach("near", "target", 0.12, 0.55, 0.68, 1.0),),
    grasps=(Grasp("take", "near", 0.6),),
    gazes=(Gaze("target", 0.0, 0.75),),
)
PICK_TIME = 1.25
STAND_TIME = 1.25
#: Two people who stood closer than this for an action step apart again, metres.
_ROOM = 0.62
SIT_TIME = 1.3


@dataclass(frozen=True, eq=False)
class Window:
    """A timeline played from ``start`` for ``duration`` seconds by one person.

    hands: hand words to ``l`` / ``r``; partner: the other person's name
    """

    timeline: Timeline
    start: float
    duration: float
    hands: dict[str, str]
    target: TargetPoint | None
    second: TargetPoint | None
    partner: str | None
    until: float = np.inf  # seconds, when what stays of it is over

    def at(self, share: float) -> float:
        return self.start + share * self.duration


@dataclass(frozen=True)
class Event:
    """At ``time`` a hand takes, puts down (at ``place``), passes on (to ``receiver``), throws or (without
    a hand) sends off a thing, which then flies for ``flight`` seconds."""

    time: float
    kind: str
    person: str
    hand: str
    object: int
    place: Point | None = None
    receiver: str | None = None
    flight: float = 0.0


@dataclass(eq=False)
class Plan:
    """One person's shot. Busy until ``end`` seconds; ``held`` is what each hand holds as planned so far.

    feelings: (word, start, end in seconds) of what shows on the face
    kept: the window of which the last pose stays
    """

    name: str
    actor: Actor
    route: Route
    held: dict[str, int]
    homes: dict[int, Point] = field(default_factory=dict)
    windows: list[Window] = field(default_factory=list)
    events: list[Event] = field(default_factory=list)
    replays: list[Replay] = field(default_factory=list)
    opened: set[int] = field(default_factory=set)
    feelings: list[tuple[str, float, float]] = field(default_factory=list)
    end: float = 0.0
    acts: bool = False
    kept: Window | None = None
    manner: Manner = PLAIN


def begin(name: str, actor: Actor) -> Plan:
    """A plan in which nothing happens yet."""
    state = actor.state
    person = np.random.default_rng([*name.encode(), 77])
    seat = state.seat if state.posture == "sitting" else None
    if state.posture == "sitting" and seat is None:
        seat = (*state.position[:2], state.position[2] + 0.45)
    if state.posture in WAYS:
        seat = state.seat
    route = Route(actor.skeleton, state.position, state.heading, seat, person, state.posture)
    plan = Plan(name, actor, route, dict(state.held))
    if state.kept is not None:
        k = state.kept
        plan.kept = Window(k.timeline, -k.since, k.duration, dict(k.hands), k.target, k.second, k.partner)
        plan.windows.append(plan.kept)
    return plan


def keep(plan: Plan, seconds: float) -> Kept | None:
    """The pose that stays for the next shot, which begins after ``seconds``."""
    w = plan.kept
    if w is None or np.isfinite(w.until):
        return None
    still = replace(w.timeline, beats=(), grasps=(), talks=(), drives=(), steps=(), jumps=())
    return Kept(still, seconds - w.start, w.duration, tuple(w.hands.items()), w.target, w.second, w.partner)


def plan_task(
    plan: Plan, task: Task, props: dict[int, PropState], rng: np.random.Generator, delay: float
) -> None:
    """Adds a task: getting there, taking what is needed, then the clip."""
    clip, route = task.clip, plan.route
    variant = clip.variant(task.variant)
    plan.acts = True
    plan.manner = manner_of(task.manner)
    plan.homes = {k: p.stands for k, p in props.items() if p.stands is not None}
    route.wait(delay)
    clip_start = route.now
    if plan.kept is not None and _moves_on(task):
        plan.kept = replace(plan.kept, until=route.now)
        plan.windows = [plan.kept]
    if task.fetch is not None:
        _fetch(plan, task, props, rng)
        clip_start = route.now
    going = _going(plan, task)
    _go(plan, task, going, rng)
    _sit_or_stand(plan, task, going, rng)
    partner = _close_in(plan, task, going)
    bed = task.target.bed if task.target is not None else None
    if clip.posture == "lying" and bed is not None and not route.low:
        route.lie(*bed, 3.4 / task.speed)
    elif clip.posture:
        route.settle(clip.posture, task.speed, clip.posture_time / task.speed)
    if clip.capture is not None:
        _rise(route, task)
    holds = len(plan.held)
    _take_needed(plan, task, props)
    if len(plan.held) > holds:  # what plays on the way there needs it in the hand
        clip_start = route.now
    duration = variant.duration / (task.speed * plan.manner.tempo)
    if task.duration is not None:
        left = task.duration - route.now
        duration = float(np.clip(left, 0.7 * duration, 1.5 * duration)) if duration > 0 else 0.0
    start = clip_start if clip.lead else route.now
    if clip.lead:
        duration = max(duration, route.now - clip_start)
    if duration > 0:
        timeline = enlarged(variant.timeline, plan.manner.amplitude)
        window = _play(plan, timeline, start, duration, task)
        plan.kept = window if clip.hold else plan.kept
        if clip.capture is not None:
            _replay(plan, clip.capture, window)
        route.now = max(route.now, window.start + duration)
    if partner is not None and clip.apart < _ROOM and not clip.hold:
        away = route.at[:2] - partner
        back = partner + away / max(float(np.hypot(*away)), 1e-6) * (_ROOM + 0.08)
        route.travel(back[None], route.heading, replace(going, gait=WALK, style=GaitStyle(facing="back")))
    if clip.rises:
        _rise(route, task)
    plan.end = route.now


def _close_in(plan: Plan, task: Task, going: Going) -> Array | None:
    """Steps up to somebody, or back, to be as far apart as the clip wants; where they are, if it does."""
    route, apart = plan.route, task.clip.apart
    person = next((p for p in (task.second, task.target) if p is not None and p.character), None)
    if not apart or person is None or route.low or route.seat is not None:
        return None
    partner = np.array(person.gaze[:2])
    away = route.at[:2] - partner
    far = max(float(np.hypot(*away)), 1e-6)
    facing = float(np.arctan2(-away[1], -away[0]))
    if abs(far - apart) > 0.05:
        there = partner + away / far * apart
        style = GaitStyle(facing="back") if far < apart else GaitStyle()
        going = replace(going, gait=WALK, wobble=0.0, style=style)
        route.travel(there[None], facing, going)
    elif abs(wrap(facing - route.heading)) > 0.2:
        route.travel(None, facing, Going(speed=task.speed))
    return partner


def _replay(plan: Plan, capture: Capture, window: Window) -> None:
    """The body goes through captured motion from where it stands, over the whole of a window."""
    route = plan.route
    at = (float(route.at[0]), float(route.at[1]))
    replay = Replay(
        fitted(capture, plan.actor.skeleton), window.start, window.duration, at, route.heading, route.floor
    )
    route.now = window.start
    route.carry(*replay.way(RATE), window.duration, replay.steps())
    plan.replays.append(replay)


def _moves_on(task: Task) -> bool:
    """Whether a task ends the pose that was held before it: by going, or by hands and posture of its own."""
    clip, own = task.clip, task.clip.variant(task.variant).timeline
    goes = task.path is not None or task.fetch is not None
    return bool(goes or clip.posture or clip.seat != "keep" or own.reaches or own.steps or own.jumps)


def _going(plan: Plan, task: Task, gait: str = "") -> Going:
    """How this person goes anywhere in this task: the variant's gait, done in the task's manner."""
    variant, manner = task.clip.variant(task.variant), plan.manner
    style, (length, time) = variant.gait, variant.stride
    style = replace(
        style,
        lift=style.lift + manner.lift,
        bounce=style.bounce + manner.bounce,
        arms=style.arms * manner.arms,
        width=style.width * manner.width,
        toes=max(style.toes, manner.toes),
    )
    return Going(
        GAITS.get(gait or task.clip.travel, WALK), task.speed,
        (length * manner.stride, time * manner.cadence), style, manner.wobble, task.stairs,
    )  # fmt: skip


def _fetch(
    plan: Plan,
    task: Task,
    props: dict[int, PropState],
    rng: np.random.Generator,
) -> None:
    """Goes to the thing needed, if there is a way to go, and takes it."""
    assert task.fetch is not None
    if len(task.fetch) > 1:
        _rise(plan.route, task, task.fetch)
        _travel(plan, task, task.fetch, task.fetch_heading, _going(plan, task), rng)
    _take_needed(plan, task, props)


def _travel(
    plan: Plan, task: Task, path: Array, heading: float | None, going: Going, rng: np.random.Generator
) -> None:
    """Goes along a path [K, 2 or 3]; opens the doors that are shut on it, each before going on."""
    rest = np.asarray(path, dtype=np.float64)
    for door in task.passages:
        near = np.linalg.norm(rest[:, :2] - np.array(door.place[:2]), axis=1)
        at = int(near.argmin())
        if near[at] > 0.3 or door.object in plan.opened:
            continue
        if at > 0 or np.hypot(*(plan.route.at[:2] - rest[at, :2])) > 0.1:
            plan.route.travel(rest[: at + 1], door.heading, going, rng)
        _open_door(plan, task, door)
        rest = rest[at:]
    plan.route.travel(rest, heading, going, rng)


def _open_door(plan: Plan, task: Task, door: Passage) -> None:
    """A hand opens the door one stands at; with both full it is pushed open."""
    plan.opened.add(door.object)
    target = TargetPoint(door.handle, door.handle, door.object)
    duration = PASS_TIME / (task.speed * plan.manner.tempo)
    timeline = PASS if len(plan.held) < 2 else Timeline(drives=PASS.drives)
    hands = choose_hands(plan, target, plan.route.now)
    plan.windows.append(Window(timeline, plan.route.now, duration, hands, target, None, None))
    plan.route.wait(duration)


def _rise(route: Route, task: Task, way: Array | None = None) -> None:
    """Stands up, from whatever one is on; off a bed to the side on which the ``way`` goes on."""
    if route.on_bed:
        way = np.asarray(way, dtype=np.float64)[:, :2] if way is not None else np.zeros((0, 2))
        free = [p for p in way if np.hypot(*(p - route.at[:2])) > 0.45]
        route.leave_bed(free[0] if free else None, 2.2 / task.speed)
    if route.seat is not None:
        route.stand(STAND_TIME / task.speed)
    route.settle("standing", task.speed)


def _go(plan: Plan, task: Task, going: Going, rng: np.random.Generator) -> None:
    clip, route = task.clip, plan.route
    path = task.path if clip.travel != "none" else None
    if path is not None and (len(path) == 0 or _path_length(path) < 0.05):
        path = None
    heading = task.arrive_heading
    if path is not None:
        if clip.travel == "crawl":
            _on_all_fours(plan, task, path)
            _travel(plan, task, path, None, going, rng)
            return
        _rise(route, task, path)
        end = np.asarray(path, dtype=np.float64)[-1, :2]
        if heading is None and clip.seat != "down":
            heading = _facing(task, end)
        if clip.seat == "down" and task.target is not None and task.target.seat is not None:
            return  # the way leads on to the seat, see _sit_or_stand
        _travel(plan, task, path, heading, going, rng)
    elif route.seat is None and clip.seat == "keep" and not route.low:
        turn = clip.turn * (1.0 if rng.random() < 0.5 else -1.0) if clip.turn and task.target is None else 0.0
        to = heading if heading is not None else _facing(task, route.at[:2])
        if turn:
            route.travel(None, route.heading + turn, Going(speed=task.speed), rng)
        elif to is not None and (heading is not None or abs(wrap(to - route.heading)) > 0.6):
            route.travel(None, to, Going(speed=task.speed), rng)


def _on_all_fours(plan: Plan, task: Task, path: Array) -> None:
    """Turns to where the way begins while still standing, then goes down: it is hard to turn there."""
    route = plan.route
    d = np.asarray(path, dtype=np.float64)[:, :2] - route.at[:2]
    ahead = next((v for v in d if np.hypot(*v) > 0.3), d[-1])
    if not route.low:
        _rise(route, task, path)
        route.travel(None, float(np.arctan2(ahead[1], ahead[0])), Going(speed=task.speed))
    route.settle("fours", task.speed)


def _facing(task: Task, at: Array) -> float | None:
    """Heading towards what the clip faces, from ``at``."""
    point = (
        task.target if task.clip.faces == "target" else task.second if task.clip.faces == "second" else None
    )
    if point is None:
        return None
    if point.facing is not None and task.path is not None and point.character is None:
        return point.facing
    d = np.array(point.gaze[:2]) - at
    return float(np.arctan2(d[1], d[0])) if np.hypot(*d) > 0.15 else None


def _sit_or_stand(plan: Plan, task: Task, going: Going, rng: np.random.Generator) -> None:
    clip, route = task.clip, plan.route
    if clip.seat == "up":
        _rise(route, task)
    seat = task.target.seat if task.target is not None else None
    if clip.seat != "down" or seat is None or task.target is None:
        return
    if route.seat is not None and np.hypot(route.seat[0] - seat[0], route.seat[1] - seat[1]) < 0.3:
        return
    _rise(route, task)
    facing = task.target.facing if task.target.facing is not None else task.arrive_heading
    if facing is None:
        away = route.at[:2] - np.array(seat[:2])
        facing = float(np.arctan2(away[1], away[0]))
    stand = route.stand_point(seat, facing)
    ways = [np.asarray(task.path, dtype=np.float64)] if task.path is not None and len(task.path) else []
    if ways and ways[0].shape[1] > 2:
        stand = np.array([*stand[:2], ways[0][-1, 2]])
    if ways:  # drop the path's end where it overshoots the place before the seat
        near = np.linalg.norm((ways[0] - stand)[:, :2], axis=1) > 0.35
        ways[0] = ways[0][: int(np.max(np.nonzero(near)[0])) + 1] if near.any() else ways[0][:1]
    _travel(plan, task, np.concatenate([*ways, stand[None]]), facing, going, rng)
    route.sit(seat, SIT_TIME / task.speed)


def _take_needed(plan: Plan, task: Task, props: dict[int, PropState]) -> None:
    need = {"target": task.target, "second": task.second}.get(task.clip.needs)
    if need is None or need.object is None or need.object in plan.held.values():
        return
    prop = props.get(need.object)
    if prop is None or len(plan.held) == 2:
        return
    grip = prop.world_from_object @ np.array([*prop.grip, 1.0])
    at = TargetPoint((float(grip[0]), float(grip[1]), float(grip[2])), need.gaze, need.object)
    duration = PICK_TIME / task.speed
    pick = PICK
    side = task.clip.needs_hand
    if side and side[0] not in plan.held:
        pick = replace(
            PICK, reaches=(replace(PICK.reaches[0], hand=side),), grasps=(Grasp("take", side, 0.6),)
        )
    window = _play(plan, pick, plan.route.now, duration, replace(task, target=at, second=None))
    plan.route.now = window.start + duration
    to = _facing(replace(task, path=None), plan.route.at[:2]) if task.clip.travel == "none" else None
    if to is not None and plan.route.posture == "standing" and abs(wrap(to - plan.route.heading)) > 0.4:
        plan.route.travel(None, to, Going(speed=task.speed))  # it was taken from elsewhere


def _play(plan: Plan, timeline: Timeline, start: float, duration: float, task: Task) -> Window:
    """Adds a window and the moments its grasps stand for; turns first to what would be behind."""
    target, second = task.target, task.second
    if not task.clip.lead:
        start += _turn_to_reach(plan, timeline, task)
    partner = next((p.character for p in (second, target) if p is not None and p.character), None)
    hands = choose_hands(plan, target, start)
    window = Window(timeline, start, duration, hands, target, second, partner)
    plan.windows.append(window)
    _footwork(plan, window)
    for grasp in timeline.grasps:
        _grasp(plan, grasp, hands, window.at(grasp.time), target, second, partner)
    return window


def _footwork(plan: Plan, window: Window) -> None:
    """Steps and jumps of a timeline, for somebody on their feet."""
    route = plan.route
    if route.seat is not None or route.low:
        return
    moves: list[FootMove | Jump] = sorted(
        (*window.timeline.steps, *window.timeline.jumps), key=lambda m: m.start
    )
    for move in moves:
        start, end = window.at(move.start), window.at(move.end)
        if isinstance(move, Jump):
            route.jump(move, start, end)
        else:
            route.step(move, start, end)


def _turn_to_reach(plan: Plan, timeline: Timeline, task: Task) -> float:
    """Seconds spent on turning to the first thing a hand goes to, where that is not before one."""
    route = plan.route
    words = [r.to for r in timeline.reaches if r.to in ("target", "second", "meet")]
    if not words or route.seat is not None or route.low:
        return 0.0
    point = task.second if words[0] in ("second", "meet") else task.target
    if point is None or (point.object is not None and point.object in plan.held.values()):
        return 0.0
    d = np.array(point.position[:2]) - route.at[:2]
    bearing = float(wrap(np.arctan2(d[1], d[0]) - route.heading))
    both = len({r.hand for r in timeline.reaches if r.to == words[0]}) > 1
    if abs(bearing) < (0.4 if both else 1.1) or np.hypot(*d) < 0.12:
        return 0.0
    began = route.now
    route.travel(None, route.heading + bearing, Going(speed=task.speed))
    return route.now - began


def _grasp(
    plan: Plan,
    grasp: Grasp,
    hands: dict[str, str],
    time: float,
    target: TargetPoint | None,
    second: TargetPoint | None,
    partner: str | None,
) -> None:
    hand = hands.get(grasp.hand, grasp.hand)
    if grasp.kind == "take":
        thing = target.object if target is not None and _in_reach(plan, target) else None
        if thing is not None and thing not in plan.held.values() and hand not in plan.held:
            plan.held[hand] = thing
            plan.events.append(Event(time, "take", plan.name, hand, thing))
    elif grasp.kind == "send":
        thing = target.object if target is not None else None
        if thing is not None and thing not in plan.held.values():
            plan.events.append(_throw(plan, time, "", thing, target, second))
    elif hand in plan.held:
        thing = plan.held[hand]
        if grasp.kind == "put":
            place = put_place(thing, target, second) or _home(plan, thing)
            if place is None:
                return  # nowhere to put it: it stays in the hand
            del plan.held[hand]
            plan.events.append(Event(time, "put", plan.name, hand, thing, place=place))
        elif grasp.kind == "throw":
            del plan.held[hand]
            plan.events.append(_throw(plan, time, hand, thing, target, second))
        elif partner is not None:
            del plan.held[hand]
            plan.events.append(Event(time, "pass", plan.name, hand, thing, receiver=partner))


def _throw(
    plan: Plan, time: float, hand: str, thing: int, target: TargetPoint | None, second: TargetPoint | None
) -> Event:
    """To the second thing or person named, else the first unless it is the thing itself, else ahead.

    Without a ``hand`` it leaves from where it lies, and comes to lie before a person.
    """
    aim = next((p for p in (second, target) if p is not None and p.object != thing), None)
    heading = np.array([np.cos(plan.route.heading), np.sin(plan.route.heading)])
    at = np.array(aim.position[:2]) if aim is not None else plan.route.at[:2] + 2.6 * heading
    flight = float(np.clip(np.hypot(*(at - plan.route.at[:2])) / 6.0, 0.3, 1.1))
    receiver = aim.character if aim is not None else None
    if receiver and not hand:
        at, receiver = at - 0.5 * heading, None
        aim = None
    floor = (float(at[0]), float(at[1]), plan.route.floor)
    place = None if receiver else aim.position if aim is not None else floor
    return Event(time, "throw" if hand else "send", plan.name, hand, thing, place, receiver, flight)


def _in_reach(plan: Plan, target: TargetPoint) -> bool:
    """Whether a hand can get to a thing from where one stands: what is farther off is not taken."""
    away = np.hypot(*(np.array(target.position[:2]) - plan.route.at[:2]))
    return bool(away < 0.72 * plan.actor.skeleton.height)


def put_place(thing: int, target: TargetPoint | None, second: TargetPoint | None) -> Point | None:
    """Where a held thing is put: the second thing named, else the first unless it is the thing itself."""
    for point in (second, target):
        if point is not None and point.object != thing and point.character is None:
            return point.position
    return None


def _home(plan: Plan, thing: int) -> Point | None:
    """Where a thing was taken from, if one can put it back without a step."""
    place = plan.homes.get(thing)
    if place is None or np.hypot(*(np.array(place[:2]) - plan.route.at[:2])) > 1.25:
        return None
    return place


def choose_hands(plan: Plan, target: TargetPoint | None, time: float) -> dict[str, str]:
    """What the hand words mean for this person now."""
    xy, yaw, _ = plan.route.root(np.array([time]))
    side = "r"
    if target is not None:
        d = np.array(target.position[:2]) - xy[0]
        across = -np.sin(yaw[0]) * d[0] + np.cos(yaw[0]) * d[1]
        side = "l" if across > 0.08 else "r"
    if target is not None and target.object in plan.held.values():
        holding = next(h for h, o in plan.held.items() if o == target.object)
    else:
        holding = next(iter(sorted(plan.held, reverse=True)), side)
    near = side if side not in plan.held or len(plan.held) == 2 else other(side)
    free = other(holding) if holding in plan.held else near
    return {
        "left": "l", "right": "r", "l": "l", "r": "r",
        "near": near, "other": other(near), "holding": holding, "free": free,
    }  # fmt: skip


def other(hand: str) -> str:
    return "r" if hand == "l" else "l"


def add_partner(plan: Plan, timeline: Timeline, window: Window, giver: Plan, close: bool) -> None:
    """The other person's part of an action, in step with ``window`` of the one who acts; close: nearer than
    for talking, so that they have to face each other."""
    head = float(giver.actor.skeleton.bind[JOINT["head"]][2])
    xy, _, _ = giver.route.root(np.array([window.at(0.5)]))
    x, y = float(xy[0, 0]), float(xy[0, 1])
    point = TargetPoint((x, y, 0.8 * head), (x, y, head), character=giver.name)
    route = plan.route
    if route.seat is None and not route.low:
        to = float(np.arctan2(*(xy[0] - route.at[:2])[::-1]))
        if abs(wrap(to - route.heading)) > (0.3 if close else 0.9):
            route.now = max(0.0, window.start - 0.6)
            route.travel(None, to)
    hands = choose_hands(plan, point, window.start)
    if not plan.held:
        hands.update(near="r", free="r", holding="r", other="l")
    mine = Window(timeline, window.start, window.duration, hands, point, None, giver.name)
    plan.windows.append(mine)
    _footwork(plan, mine)
    plan.end = max(plan.end, route.now)


def _path_length(path: Array) -> float:
    return float(np.sum(np.linalg.norm(np.diff(np.asarray(path)[:, :2], axis=0), axis=1)))
