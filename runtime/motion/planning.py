"""From a task to a plan: getting there, taking what is needed, then the clip. No poses yet.

Everything is decided here from positions and times alone.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from runtime.body.skeleton import JOINT

from .channels import enlarged
from .gait import WALK
from .going import close_in, facing_of, go, going_of, rise, sit_or_stand, travel
from .grasping import grasp_at
from .manner import manner_of
from .plan import Plan, Window, choose_hands
from .replay import Replay, fitted
from .rotations import wrap
from .route import Going
from .timeline import FootMove, Gaze, Grasp, Jump, Reach, Timeline
from .trail import RATE
from .types import Capture, GaitStyle, PropState, TargetPoint, Task

Array = NDArray[np.float64]

#: Taking hold of a thing that an action needs and that is not in a hand yet.
PICK = Timeline(
    reaches=(Reach("near", "target", 0.12, 0.55, 0.68, 1.0),),
    grasps=(Grasp("take", "near", 0.6),),
    gazes=(Gaze("target", 0.0, 0.75),),
)
PICK_TIME = 1.25
#: Seconds until one turns to who speaks, and how far aside they have to be for that, radians.
_HEARD, _ASIDE = 0.25, 1.1
#: Two people who stood closer than this for an action step apart again, metres.
_ROOM = 0.62


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
    going = going_of(plan, task)
    go(plan, task, going, rng)
    sit_or_stand(plan, task, going, rng)
    partner = close_in(plan, task, going)
    bed = task.target.bed if task.target is not None else None
    if clip.posture == "lying" and bed is not None and not route.low:
        route.lie(*bed, 3.4 / task.speed)
    elif clip.posture:
        route.settle(clip.posture, task.speed, clip.posture_time / task.speed)
    if clip.capture is not None:
        rise(route, task)
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
        rise(route, task)
    plan.end = route.now


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


def _fetch(
    plan: Plan,
    task: Task,
    props: dict[int, PropState],
    rng: np.random.Generator,
) -> None:
    """Goes to the thing needed, if there is a way to go, and takes it."""
    assert task.fetch is not None
    if len(task.fetch) > 1:
        rise(plan.route, task, task.fetch)
        travel(plan, task, task.fetch, task.fetch_heading, going_of(plan, task), rng)
    _take_needed(plan, task, props)


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
    to = facing_of(replace(task, path=None), plan.route.at[:2]) if task.clip.travel == "none" else None
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
        grasp_at(plan, grasp, hands, window.at(grasp.time), target, second, partner)
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


def listen(plan: Plan, speaker: Plan, window: Window) -> None:
    """Who is spoken to in a window, and has nothing to do, turns to a speaker they could not well look at."""
    xy, _, _ = speaker.route.root(np.array([window.at(0.5)]))
    _turn_to(plan, xy[0], window.at(min(t.start for t in window.timeline.talks)) + _HEARD, _ASIDE)
    plan.end = max(plan.end, plan.route.now)


def _turn_to(plan: Plan, place: Array, time: float, beyond: float) -> None:
    """On their feet, turns to a place from ``time`` on, if that is more than ``beyond`` radians aside."""
    route = plan.route
    if route.seat is not None or route.low:
        return
    to = float(np.arctan2(*(place - route.at[:2])[::-1]))
    if abs(wrap(to - route.heading)) > beyond:
        route.now = max(0.0, time)
        route.travel(None, to)


def add_partner(plan: Plan, timeline: Timeline, window: Window, giver: Plan, close: bool) -> None:
    """The other person's part of an action, in step with ``window`` of the one who acts; close: nearer than
    for talking, so that they have to face each other."""
    head = float(giver.actor.skeleton.bind[JOINT["head"]][2])
    xy, _, _ = giver.route.root(np.array([window.at(0.5)]))
    x, y = float(xy[0, 0]), float(xy[0, 1])
    point = TargetPoint((x, y, 0.8 * head), (x, y, head), character=giver.name)
    route = plan.route
    _turn_to(plan, xy[0], window.start - 0.6, 0.3 if close else 0.9)
    hands = choose_hands(plan, point, window.start)
    if not plan.held:
        hands.update(near="r", free="r", holding="r", other="l")
    mine = Window(timeline, window.start, window.duration, hands, point, None, giver.name)
    plan.windows.append(mine)
    _footwork(plan, mine)
    plan.end = max(plan.end, route.now)
