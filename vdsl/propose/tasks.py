"""A beat to a task of the engine: what it is aimed at, where one has to stand for it, and the ways there."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from runtime.body.skeleton import Skeleton
from runtime.motion.timeline import Talk, Timeline
from runtime.motion.types import ActionClip, Passage, TargetPoint, Task
from runtime.nav import Discs, nearest_free

from ..lang.diagnostics import Report
from ..lang.ir import Beat, Shot, Target
from .bringing import with_brought
from .cameras import find_object
from .hindrance import report_no_seat, report_no_support, report_nothing_opens, report_unreachable
from .leaning import stop_against
from .opening import Way, part_point, part_to_move, stand_to_move, stands, ways_through
from .places import (
    ARM,
    Stop,
    approach,
    object_target,
    on_top_of,
    own_seats,
    seat_of,
    spot_target,
    target_point,
)
from .pouring import something_to_pour
from .state import PERSON_RADIUS, SceneState

_NEAR_ENOUGH = 1.25  # metres between people who can hand each other things or talk without moving
#: Where one goes who has no place to go to: radians off ahead, and metres.
_ROAM_TURNS, _ROAM_FAR = (0.0, 0.5, -0.5, 1.0, -1.0, 1.6, -1.6, 2.4, -2.4, 3.1), (4.5, 3.6, 2.8, 2.0, 1.4)
_STANDS_THERE = 0.2  # metres from the place to stand within which nobody takes a step
_LEANS_THERE = 0.06  # the same where the back is to be against something


@dataclass(frozen=True, eq=False)
class Errand:
    """What a beat comes to: a task without its way, and the ways there are.

    paths: from where the person is, empty where they stay; fetch: the way to the thing needed first
    stop: where they end up, None where they stay
    doors: for each path, the doors opened on it
    """

    task: Task
    paths: tuple[NDArray[np.float64], ...]
    stop: Stop | None
    doors: tuple[tuple[Passage, ...], ...] = ()


def errand(
    beat: Beat,
    clip: ActionClip,
    shot: Shot | None,
    state: SceneState,
    skeletons: Mapping[str, Skeleton],
    taken: Discs,
    report: Report,
    ways: int = 3,
) -> Errand | None:
    """The beat as an errand; None (and a diagnostic) where it cannot be done.

    taken: places where others of the same line are about to stand
    """
    beat = with_brought(beat, clip, state)
    found = _errand(beat, clip, shot, state, skeletons, taken, report, ways)
    return (
        None
        if found is None
        else replace(found, task=replace(found.task, manner=beat.manner, stairs=state.world.stairs))
    )


def _errand(
    beat: Beat,
    clip: ActionClip,
    shot: Shot | None,
    state: SceneState,
    skeletons: Mapping[str, Skeleton],
    taken: Discs,
    report: Report,
    ways: int,
) -> Errand | None:
    actor = state.actors[beat.character]
    target = _point(beat.target, state, actor.position, skeletons)
    second = _point(beat.second, state, actor.position, skeletons)
    if second is not None and _puts(clip):
        second = replace(second, position=on_top_of(beat.second, state) or second.position)
    elif _puts(clip) and actor.held:
        beat, second = _somewhere_to_put(beat, target, state)
    if clip.needs == "second" and second is None and not actor.held:
        beat, second = something_to_pour(beat, target, state)
    if clip.seat == "down":
        seat = seat_of(beat.target, state, beat.character, to_sit=True)
        if seat is not None and (beat.target is None or seat not in own_seats(beat.target, state.world)):
            beat = replace(beat, target=spot_target(seat, state.world))
        if seat is None:
            report_no_seat(beat, state, report)
            return None
        target = TargetPoint(seat.position, seat.position, facing=seat.facing, seat=seat.position)
        if actor.posture == "sitting" and actor.seat and math.dist(actor.seat, seat.position) < 0.3:
            return Errand(_task(clip, target, second, shot), (), None)
    driven = _driven(clip)
    if driven is not None and beat.target is not None:
        return _moving(beat, clip, driven, target, shot, state, taken, report, ways)
    if clip.needs in ("target", "second"):
        points = {"target": target, "second": second}
        fetched = _fetching(beat, clip, points, state, taken, _task(clip, target, second, shot))
        if fetched is not None:
            return fetched
    if clip.seat == "up" and actor.posture == "lying" and actor.seat is not None:
        free = nearest_free(state.world, actor.position, state.people(but=beat.character) + taken)
        way = np.array([actor.position, free]) if free is not None else np.zeros((0, 3))
        return Errand(_task(clip, target, second, shot), (way,), None)
    if clip.against:
        return _leaning(beat, clip, target, shot, state, taken, report, ways)
    where = _where_to(beat, clip, target, second, state)
    if where is None and clip.roams and target is None and _is_on_the_way(clip):
        roaming = _roaming(beat.character, state, taken)
        if roaming is not None:
            way_there, there = roaming
            task = replace(_task(clip, None, second, shot), arrive_heading=there.heading)
            return Errand(task, (way_there,), there)
    if where is None:
        turned = _turned_to(beat, clip, target, state)
        return Errand(replace(_task(clip, target, second, shot), arrive_heading=turned), (), None)
    here = actor.position
    stop = approach(where, state, beat.character, here, taken)
    if stop is None:
        report_unreachable(beat, where, state, here, report)
        return None
    if clip.seat != "down" and math.dist(stop.place, here) < _STANDS_THERE:
        turn = replace(_task(clip, target, second, shot), arrive_heading=stop.heading)
        return Errand(turn if actor.posture == "standing" else _task(clip, target, second, shot), (), stop)
    going = _going(_task(clip, target, second, shot), stop, beat, state, taken, ways)
    if going is None:
        report_unreachable(beat, where, state, here, report)
    return going


def _leaning(
    beat: Beat,
    clip: ActionClip,
    target: TargetPoint | None,
    shot: Shot | None,
    state: SceneState,
    taken: Discs,
    report: Report,
    ways: int,
) -> Errand | None:
    """To a place with the back against something."""
    here = state.actors[beat.character].position
    stop = stop_against(beat.target, state, beat.character, taken, clip)
    if stop is None:
        report_no_support(beat, report)
        return None
    task = _task(clip, target, None, shot)
    if math.dist(stop.place, here) < _LEANS_THERE:
        return Errand(replace(task, arrive_heading=stop.heading), (), stop)
    going = _going(task, stop, beat, state, taken, ways)
    if going is None:
        report_no_support(beat, report)
    return going


def _going(task: Task, stop: Stop, beat: Beat, state: SceneState, taken: Discs, ways: int) -> Errand | None:
    """The task with the ways to a place to stand; None where there is none."""
    here, people = state.actors[beat.character].position, state.people(but=beat.character) + taken
    found = ways_through(state.world, here, stop.place, ways, people)
    return _with_ways(replace(task, arrive_heading=stop.heading), found, stop) if found else None


def _with_ways(task: Task, found: list[Way], stop: Stop) -> Errand:
    return Errand(task, tuple(path for path, _ in found), stop, tuple(doors for _, doors in found))


def _somewhere_to_put(
    beat: Beat, target: TargetPoint | None, state: SceneState
) -> tuple[Beat, TargetPoint | None]:
    """The nearest table as the beat's second target, for what is put down where no place is named: if it
    came from farther off than one can reach from here."""
    actor = state.actors[beat.character]
    thing = target.object if target is not None else actor.held[-1][1]
    x, y, floor = actor.position
    home = state.props[thing].stands if thing in state.props else None
    near_home = home is not None and math.hypot(home[0] - x, home[1] - y) <= 1.25
    if near_home or thing not in {held for _, held in actor.held}:
        return beat, None
    reach = 4.0 if actor.posture == "standing" else 1.0
    best: Target | None = None
    for item in state.world.objects:
        top = item.spot("top")
        if top is None or item.id in state.props or not 0.3 < top.position[2] - floor < 1.3:
            continue
        away = math.hypot(top.position[0] - x, top.position[1] - y)
        if away < reach and item.path[: len(state.room)] == state.room:
            best, reach = object_target(item), away
    return (
        (beat, None)
        if best is None
        else (replace(beat, second=best), target_point(best, state, actor.position))
    )


def _puts(clip: ActionClip) -> bool:
    """Whether something is put down in it."""
    return any(g.kind == "put" for v in clip.variants for g in v.timeline.grasps)


def _driven(clip: ActionClip) -> float | None:
    """How far the action opens its target; None where it moves no part of it."""
    drives = (d for v in clip.variants for d in v.timeline.drives if d.target == "target")
    return next((d.openness for d in drives), None)


def _moving(
    beat: Beat,
    clip: ActionClip,
    openness: float,
    target: TargetPoint | None,
    shot: Shot | None,
    state: SceneState,
    taken: Discs,
    report: Report,
    ways: int,
) -> Errand | None:
    """To the handle of what is opened or closed, out of the way of what swings or slides."""
    assert beat.target is not None
    actor = state.actors[beat.character]
    item = find_object(state.world, beat.target)
    part = None if item is None else part_to_move(item, state.world, openness, actor.position)
    if part is None:
        report_nothing_opens(beat.target, state, report)
        return Errand(_task(clip, target, None, shot), (), None)
    if stands(part, openness):
        label = f"`{beat.target.written}` is {'open' if openness > 0.5 else 'closed'} already"
        report.warn("VDS243", beat.target.span, label=label)
    task = _task(clip, part_point(part), None, shot)
    people, here = state.people(but=beat.character) + taken, actor.position
    stop = stand_to_move(part, openness, state.world, people, here)
    stop = stop or approach(beat.target, state, beat.character, here, taken)
    if stop is None:
        report_unreachable(beat, beat.target, state, here, report)
        return None
    if math.dist(stop.place, here) < _STANDS_THERE:
        return Errand(replace(task, arrive_heading=stop.heading), (), stop)
    going = _going(task, stop, beat, state, taken, ways)
    if going is None:
        report_unreachable(beat, beat.target, state, here, report)
    return going


def _task(
    clip: ActionClip, target: TargetPoint | None, second: TargetPoint | None, shot: Shot | None
) -> Task:
    speed = shot.speed if shot is not None else 1.0
    duration = shot.duration if shot is not None else None
    return Task(clip, clip.variants[0].name, None, None, target, second, speed, duration)


def _point(
    target: Target | None,
    state: SceneState,
    near: tuple[float, float, float],
    skeletons: Mapping[str, Skeleton],
) -> TargetPoint | None:
    if target is None:
        return None
    height = skeletons[target.path[-1]].height if target.kind == "character" else 1.65
    return target_point(target, state, near, height)


def _fetching(
    beat: Beat,
    clip: ActionClip,
    points: dict[str, TargetPoint | None],
    state: SceneState,
    taken: Discs,
    task: Task,
) -> Errand | None:
    """Two ways in one: to the thing the clip needs in a hand, then to whoever or whatever it is for.

    None where one way (or none) is enough, or there is no such pair of ways.
    """
    actor = state.actors[beat.character]
    need, goal = points.get(clip.needs), points["second" if clip.needs == "target" else "target"]
    if need is None or goal is None or need.object is None or goal.object == need.object:
        return None
    if clip.travel == "none" or need.object in {thing for _, thing in actor.held}:
        return None
    wanted = {"target": (beat.target, beat.second), "second": (beat.second, beat.target)}[clip.needs]
    if wanted[0] is None or wanted[1] is None:
        return None
    here = actor.position
    people = state.people(but=beat.character) + taken
    way, heading = np.zeros((0, 3)), None
    if _away(need, here) > ARM:
        first = approach(wanted[0], state, beat.character, here, taken)
        ways = ways_through(state.world, here, first.place, 1, people) if first else []
        if first is None or not ways:
            return None
        (way, doors), heading, here = ways[0], first.heading, first.place
        task = replace(task, passages=doors)
    task = replace(task, fetch=way, fetch_heading=heading)
    if _away(goal, here) <= (_NEAR_ENOUGH if goal.character else ARM):
        facing = heading if heading is not None else actor.heading
        return Errand(task, (), Stop(here[0], here[1], facing, here[2]))
    stop = approach(wanted[1], state, beat.character, here, taken)
    opened = tuple(door.object for door in task.passages)
    found = ways_through(state.world, here, stop.place, 2, people, opened) if stop else []
    if stop is None or not found:
        return None
    return _with_ways(replace(task, arrive_heading=stop.heading), found, stop)


def _away(point: TargetPoint, here: tuple[float, ...]) -> float:
    """Metres on the floor to a thing, or to where a person stands."""
    at = point.gaze if point.character else point.position
    return math.hypot(at[0] - here[0], at[1] - here[1])


def _turned_to(beat: Beat, clip: ActionClip, target: TargetPoint | None, state: SceneState) -> float | None:
    """Heading for what hands go to from where one stands, None where it lies ahead already."""
    actor = state.actors[beat.character]
    if target is None or actor.posture != "standing" or not _touches(clip, "target"):
        return None
    if target.object is not None and target.object in {thing for _, thing in actor.held}:
        return None
    to = math.atan2(target.position[1] - actor.position[1], target.position[0] - actor.position[0])
    off = (to - actor.heading + math.pi) % (2 * math.pi) - math.pi
    return to if abs(off) > 0.7 else None


def _touches(clip: ActionClip, word: str) -> bool:
    """Whether hands go to that place in any variant."""
    places = {word, "meet", "clasp"} if word != "meet" else {"meet", "clasp"}
    return any(
        r.to in places or r.to.startswith("partner.") for v in clip.variants for r in v.timeline.reaches
    )


def _where_to(
    beat: Beat, clip: ActionClip, target: TargetPoint | None, second: TargetPoint | None, state: SceneState
) -> Target | None:
    """The target one has to go to before the clip, None where one can stay."""
    actor = state.actors[beat.character]
    held = {thing for _, thing in actor.held}
    if clip.travel == "none":
        return None
    if clip.seat == "down":
        return beat.target
    if clip.posture == "lying" and target is not None and target.bed is not None:
        there = actor.seat is not None and math.dist(actor.seat, target.bed[0]) < 0.3
        return None if there and actor.posture == "lying" else beat.target
    if _is_on_the_way(clip) and beat.target is not None:
        carried = target is not None and target.object is not None and target.object in held
        return beat.second if carried else beat.target
    pairs = ((beat.second, second, "second"), (beat.target, target, "target"))
    for written, point, word in pairs:
        if written is None or point is None or (point.object in held and point.object is not None):
            continue
        touched = _touches(clip, word) or clip.needs == word or (clip.apart > 0 and point.character)
        if not touched and not (point.character and _touches(clip, "meet")):
            continue
        if _away(point, actor.position) > (_NEAR_ENOUGH if point.character else ARM):
            return written
    return None


def _is_on_the_way(clip: ActionClip) -> bool:
    """Whether it is to get somewhere that matters, rather than what is done there."""
    return not any(v.duration > 0 and _plays(v.timeline) for v in clip.variants) or clip.lead or clip.goes


def _roaming(who: str, state: SceneState, taken: Discs) -> tuple[NDArray[np.float64], Stop] | None:
    """A way for who is to go, and nobody says where to: some steps on free floor, ahead if there is room."""
    actor = state.actors[who]
    people = state.people(but=who) + taken
    x, y, z = actor.position
    best: tuple[float, NDArray[np.float64], Stop] | None = None
    for off in _ROAM_TURNS:
        heading = actor.heading + off
        for far in _ROAM_FAR:
            there = (x + far * math.cos(heading), y + far * math.sin(heading), z)
            spot = nearest_free(state.world, there, people, within=0.3)
            found = ways_through(state.world, actor.position, spot, 1, people) if spot is not None else []
            if spot is None or not found or found[0][1]:  # not through doors that are shut
                continue
            path = found[0][0]
            length = float(np.linalg.norm(np.diff(path[:, :2], axis=0), axis=1).sum())
            if length < 1.15 * far + 0.3 and (best is None or far - abs(off) > best[0]):
                best = far - abs(off), path, Stop(spot[0], spot[1], heading, spot[2])
            break
    return None if best is None else best[1:]


def _plays(timeline: Timeline) -> bool:
    return bool(timeline.tracks or timeline.reaches or timeline.beats or timeline.gazes or timeline.talks)


def speaking(clip: ActionClip) -> ActionClip:
    """The clip with the mouth moving, for a line that says something."""
    variants = tuple(
        v
        if v.timeline.talks
        else replace(
            v, duration=max(v.duration, 0.6), timeline=replace(v.timeline, talks=(Talk(0.04, 0.96),))
        )
        for v in clip.variants
    )
    return replace(clip, variants=variants)


def disc(stop: Stop) -> tuple[float, float, float, float]:
    """A place somebody is about to stand at, as an obstacle."""
    return stop.x, stop.y, PERSON_RADIUS, stop.z


def as_said(clip: ActionClip, ways: tuple[str, ...]) -> ActionClip:
    """The clip with those of its variants that the line names, all where it names none."""
    variants = tuple(v for v in clip.variants if v.name in ways)
    return replace(clip, variants=variants) if variants else clip
