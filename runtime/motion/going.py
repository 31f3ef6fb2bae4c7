"""Getting there: the ways of a task, the doors on them, standing up, sitting down, and stepping up to people.

Each function adds to a plan's route; nothing is posed.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from .gait import GAITS, WALK
from .plan import Plan, Window, choose_hands
from .rotations import wrap
from .route import Going, Route
from .timeline import Drive, Gaze, Reach, Timeline, Track
from .types import GaitStyle, Passage, TargetPoint, Task

Array = NDArray[np.float64]
#: Opening a door one comes to: a hand on the handle, which it lets go of before the leaf has swung away.
PASS = Timeline(
    tracks=(Track("fingers_near.curl", (0.0, 0.3, 0.4, 0.66, 1.0), (0.25, 0.2, 0.75, 0.7, 0.25)),),
    reaches=(Reach("near", "target", 0.0, 0.36, 0.68, 1.0),),
    gazes=(Gaze("target", 0.0, 0.5),),
    drives=(Drive("target", 1.0, 0.38, 0.9),),
)
PASS_TIME = 1.5
STAND_TIME = 1.25
SIT_TIME = 1.3


def close_in(plan: Plan, task: Task, going: Going) -> Array | None:
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


def going_of(plan: Plan, task: Task, gait: str = "") -> Going:
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


def travel(
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


def rise(route: Route, task: Task, way: Array | None = None) -> None:
    """Stands up, from whatever one is on; off a bed to the side on which the ``way`` goes on."""
    if route.on_bed:
        way = np.asarray(way, dtype=np.float64)[:, :2] if way is not None else np.zeros((0, 2))
        free = [p for p in way if np.hypot(*(p - route.at[:2])) > 0.45]
        route.leave_bed(free[0] if free else None, 2.2 / task.speed)
    if route.seat is not None:
        route.stand(STAND_TIME / task.speed)
    route.settle("standing", task.speed)


def go(plan: Plan, task: Task, going: Going, rng: np.random.Generator) -> None:
    clip, route = task.clip, plan.route
    path = task.path if clip.travel != "none" else None
    if path is not None and (len(path) == 0 or _path_length(path) < 0.05):
        path = None
    heading = task.arrive_heading
    if path is not None:
        if clip.travel == "crawl":
            _on_all_fours(plan, task, path)
            travel(plan, task, path, None, going, rng)
            return
        rise(route, task, path)
        end = np.asarray(path, dtype=np.float64)[-1, :2]
        if heading is None and clip.seat != "down":
            heading = facing_of(task, end)
        if clip.seat == "down" and task.target is not None and task.target.seat is not None:
            return  # the way leads on to the seat, see sit_or_stand
        travel(plan, task, path, heading, going, rng)
    elif route.seat is None and clip.seat == "keep" and not route.low:
        turn = clip.turn * (1.0 if rng.random() < 0.5 else -1.0) if clip.turn and task.target is None else 0.0
        to = heading if heading is not None else facing_of(task, route.at[:2])
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
        rise(route, task, path)
        route.travel(None, float(np.arctan2(ahead[1], ahead[0])), Going(speed=task.speed))
    route.settle("fours", task.speed)


def facing_of(task: Task, at: Array) -> float | None:
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


def sit_or_stand(plan: Plan, task: Task, going: Going, rng: np.random.Generator) -> None:
    clip, route = task.clip, plan.route
    if clip.seat == "up":
        rise(route, task)
    seat = task.target.seat if task.target is not None else None
    if clip.seat != "down" or seat is None or task.target is None:
        return
    if route.seat is not None and np.hypot(route.seat[0] - seat[0], route.seat[1] - seat[1]) < 0.3:
        return
    rise(route, task)
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
    travel(plan, task, np.concatenate([*ways, stand[None]]), facing, going, rng)
    route.sit(seat, SIT_TIME / task.speed)


def _path_length(path: Array) -> float:
    return float(np.sum(np.linalg.norm(np.diff(np.asarray(path)[:, :2], axis=0), axis=1)))
