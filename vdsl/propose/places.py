"""Names of a story to points of its world: where a hand goes, where eyes rest, where one stands to do it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from runtime.motion.types import TargetPoint
from runtime.nav import BODY_RADIUS, Discs, find_paths, grid_of, level_at, nearest_free, reachable
from runtime.paths import length
from runtime.world import Spot, World, WorldObject

from ..lang.ir import Target
from ..lang.source import Source, Span
from ..lang.words import counts_under
from .cameras import find_object
from .state import SceneState, floor_under, room_middle

ARM = 0.75  # metres on the floor within which a hand reaches a thing
TALKING = 0.88  # metres between two people face to face
_ABREAST = 0.75  # metres between two people side by side
_FACE_TO_FACE = (TALKING, TALKING + 0.15, TALKING + 0.35)
#: Where to stand by somebody, from where they look: face to face, else aside; and at their sides.
_AHEAD = (0.0, 0.35, -0.35, 0.7, -0.7, 1.1, -1.1, 1.6, -1.6, 2.2, -2.2, math.pi)
_SIDES = (math.pi / 2, -math.pi / 2, 2.0, -2.0)
_EYES = 0.93  # of the standing height
_BESIDE = 0.16  # metres between things on a table top
_AT_TABLE, _FACES = 0.75, 0.5  # metres from a seat to what it is drawn up to; how far it faces it, a cosine
_TO_A_SEAT, _STEP = 0.45, 0.1  # metres to somebody that a seat takes, and at which it is looked on the way
_BY_SOMEBODY = 2.2  # metres to somebody at whose side, or opposite of whom, one sits

Point = tuple[float, float, float]
Place = tuple[float, ...]  # (x, y) or (x, y, z) on a floor


@dataclass(frozen=True)
class Stop:
    """A place on a floor to stand at, metres, and the heading to have there, radians."""

    x: float
    y: float
    heading: float
    z: float = 0.0

    @property
    def place(self) -> Point:
        return self.x, self.y, self.z


def target_point(target: Target, state: SceneState, near: Point, height: float = 1.65) -> TargetPoint:
    """What a target is to hands and eyes, seen by somebody whose floor point is ``near``.

    height: standing height of the character, where the target is one
    """
    if target.kind == "character":
        return _person_point(target.path[-1], state, near, height)
    item = find_object(state.world, target)
    if target.kind == "spot" and item is not None:
        spot = item.spot(target.path[-1])
        if spot is not None:
            return _spot_point(spot, state.world)
    if item is None or item.kind in ("room", "area"):
        x, y, z = room_middle(state) if item is None else _middle(item)
        return TargetPoint((x, y, z), (x, y, z + 1.2))
    return _object_point(item, state, near)


def object_target(item: WorldObject) -> Target:
    """An object as a target nobody wrote."""
    return Target("object", item.path, item.path[-1], Span(Source("<set>", ""), 0, 0))


def spot_target(spot: Spot, world: World) -> Target:
    """A spot of something as a target nobody wrote."""
    owner = next(item for item in world.objects if spot in item.spots)
    return Target("spot", (*owner.path, spot.name), spot.name, Span(Source("<set>", ""), 0, 0))


def _middle(item: WorldObject) -> Point:
    spot = item.spot("middle")
    x, y, _ = spot.position if spot is not None else item.centre
    return x, y, item.low[2]


def _spot_point(spot: Spot, world: World) -> TargetPoint:
    x, y, z = spot.position
    floor = floor_under(world, spot.position)
    seat = spot.position if spot.name.startswith("seat") else None
    gaze = (x, y, z if z > floor + 0.3 else floor + 1.2)
    return TargetPoint(spot.position, gaze, facing=spot.facing, seat=seat, bed=_bed(spot))


def _bed(spot: Spot | None) -> tuple[Point, float] | None:
    """Where one can lie: the middle of the surface, and the heading of the head."""
    if spot is None or not spot.name.startswith("lie"):
        return None
    return spot.position, spot.facing if spot.facing is not None else 0.0


def _person_point(name: str, state: SceneState, near: Point, height: float) -> TargetPoint:
    actor = state.actors[name]
    x, y, z = actor.position
    eyes = z + _EYES * height
    if actor.posture == "sitting":
        eyes = (actor.seat[2] if actor.seat else z + 0.45) + 0.43 * height
    away = max(math.hypot(near[0] - x, near[1] - y), 1e-6)
    reach = min(0.3, away / 2)
    hand = (x + (near[0] - x) / away * reach, y + (near[1] - y) / away * reach, eyes - 0.33 * height)
    return TargetPoint(hand, (x, y, eyes), character=name)


def _object_point(item: WorldObject, state: SceneState, near: Point) -> TargetPoint:
    prop = state.props.get(item.id)
    if prop is not None and prop.hinge is None:
        matrix = prop.world_from_object
        grip = matrix[:3, :3] @ prop.grip + matrix[:3, 3]
        if prop.holder is not None and prop.holder[0] in state.actors:
            x, y, z = state.actors[prop.holder[0]].position
            at: Point = (x, y, float(grip[2]) if grip[2] > z + 0.4 else z + 1.1)
        else:
            at = (float(grip[0]), float(grip[1]), float(grip[2]))
        return TargetPoint(at, at, object=item.id)
    seat = next((s for s in item.spots if s.name.startswith("seat")), None)
    stand = _best_stand(item, near)
    centre = item.centre
    grip_spot = item.spot("grip")
    top = min(
        (s for s in item.spots if s.name.startswith("top")),
        key=lambda s: math.dist(s.position, near),
        default=None,
    )
    if grip_spot is not None:
        contact = grip_spot.position
    elif top is not None:
        contact = _free_top(item, top, state, stand, near)
    else:
        floor = floor_under(state.world, (centre[0], centre[1], item.low[2]))
        contact = (centre[0], centre[1], min(centre[2], floor + 1.1))
    gaze = centre if top is None else (centre[0], centre[1], top.position[2])
    facing = seat.facing if seat is not None else (stand.facing if stand is not None else None)
    bed = _bed(next((s for s in item.spots if s.name.startswith("lie")), None))
    place = seat.position if seat is not None else None
    return TargetPoint(contact, gaze, facing=facing, seat=place, bed=bed)


def on_top_of(target: Target | None, state: SceneState) -> Point | None:
    """Where something is put that goes on or into a movable thing, None where the thing has no such place."""
    item = find_object(state.world, target) if target is not None and target.kind == "object" else None
    prop = state.props.get(item.id) if item is not None else None
    top = item.spot("top") if item is not None else None
    if prop is None or prop.hinge is not None or top is None or item is None:
        return None
    inside = np.linalg.inv(np.asarray(item.world_from_object, float)) @ np.array([*top.position, 1.0])
    x, y, z = (float(v) for v in (prop.world_from_object @ inside)[:3])
    return x, y, z


def _best_stand(item: WorldObject, near: Point) -> Spot | None:
    stands = [s for s in item.spots if s.name.startswith("stand")]
    return min(
        stands,
        key=lambda s: math.dist(s.position, near),
        default=None,
    )


def _free_top(item: WorldObject, top: Spot, state: SceneState, stand: Spot | None, near: Point) -> Point:
    """A place on a top where nothing stands yet, within reach of the one who puts something there."""
    x, y, z = top.position
    foot = stand.position if stand is not None else near
    things = [
        p.world_from_object[:3, 3] for p in state.props.values() if p.holder is None and p.hinge is None
    ]
    options = []
    for back in (0.42, 0.5, 0.34):
        for side in (0.0, 0.16, -0.16, 0.3, -0.3, 0.42, -0.42):
            a = math.atan2(y - foot[1], x - foot[0])
            px = foot[0] + back * math.cos(a) - side * math.sin(a)
            py = foot[1] + back * math.sin(a) + side * math.cos(a)
            inside = (
                item.low[0] + 0.06 <= px <= item.high[0] - 0.06
                and item.low[1] + 0.06 <= py <= item.high[1] - 0.06
            )
            free = all(math.hypot(px - t[0], py - t[1]) > _BESIDE or abs(t[2] - z) > 0.3 for t in things)
            if inside and free:
                options.append((px, py, z))
    return options[0] if options else top.position


# --- seats ----------------------------------------------------------------------------------


def seats(target: Target, world: World) -> list[Spot]:
    """The seat spots a target has; at what has none, as a table, those of seats that are drawn up to it."""
    found, item = own_seats(target, world), find_object(world, target)
    if not found and item is not None and target.kind == "object" and item.kind not in ("room", "area"):
        return _drawn_up(item, world)
    return found


def _counted(target: Target, world: World) -> list[Target]:
    """The others of a number of things, where a line says ``desk`` and means ``desk_1`` or another one."""
    word = target.written
    if target.kind != "object" or not counts_under(word, target.path[-1]):
        return []
    paths = (item.path for item in world.objects if item.path[:-1] == target.path[:-1])
    return [replace(target, path=p) for p in paths if counts_under(word, p[-1]) and p != target.path]


def own_seats(target: Target, world: World) -> list[Spot]:
    """The seat spots a target has itself."""
    item = find_object(world, target)
    if item is None:
        return []
    found = [s for s in item.spots if s.name.startswith("seat")]
    if target.kind == "spot":
        named = [s for s in found if s.name == target.path[-1]]
        return named
    return found


def _drawn_up(table: WorldObject, world: World) -> list[Spot]:
    """Seats from which one faces a thing, near by."""
    low, high = table.low, table.high
    out = []
    for seat in (s for o in world.objects for s in o.spots if s.name.startswith("seat")):
        x, y, z = seat.position
        dx, dy = (max(low[k] - p, 0.0) - max(p - high[k], 0.0) for k, p in enumerate((x, y)))
        away = math.hypot(dx, dy)
        ahead = 0.0 if seat.facing is None else math.cos(seat.facing) * dx + math.sin(seat.facing) * dy
        faces = seat.facing is None or ahead > _FACES * away
        if away <= _AT_TABLE and faces and low[2] - 0.3 < z < high[2]:
            out.append(seat)
    return out


def seat_of(target: Target | None, state: SceneState, who: str, to_sit: bool = False) -> Spot | None:
    """A seat of the target nobody else sits on; without a target the nearest one of the whole scene.

    to_sit: also a seat drawn up to a table, of somebody the one nearest to them, and of a number of things
    that of another one
    """
    is_somebody = to_sit and target is not None and target.kind == "character"
    somebody = state.actors.get(target.path[0]) if is_somebody and target is not None else None
    if target is not None and somebody is None:
        found = (seats if to_sit else own_seats)(target, state.world)
    else:
        found = [s for o in state.world.objects for s in o.spots if s.name.startswith("seat")]
    if somebody is not None:
        away = {id(s): math.dist(s.position, somebody.seat or somebody.position) for s in found}
        found = [s for s in found if away[id(s)] < _BY_SOMEBODY]
    taken = [a.seat for name, a in state.actors.items() if name != who and a.seat is not None]

    def free_of(found: list[Spot]) -> list[Spot]:
        return [s for s in found if all(math.dist(s.position, t) > 0.35 for t in taken)]

    free = free_of(found)
    if not free and target is not None and to_sit:
        free = free_of([s for other in _counted(target, state.world) for s in seats(other, state.world)])
    if somebody is not None:
        free.sort(key=lambda s: away[id(s)])
    elif who in state.actors:
        here = state.actors[who].position
        free.sort(key=lambda s: math.dist(s.position, here))
    return free[0] if free else None


# --- where to stand -------------------------------------------------------------------------


def approach(
    target: Target,
    state: SceneState,
    who: str,
    start: Place | None,
    taken: Discs = (),
) -> Stop | None:
    """Where to stand to be at a target; None when there is no such place joined to ``start``.

    start: where they come from, None for anywhere; taken: places others are about to stand at
    """
    people = state.people(but=who) + taken
    if target.kind == "character":
        return _before(target.path[-1], state, people, start)
    item = find_object(state.world, target)
    if target.kind == "spot" and item is not None:
        spot = item.spot(target.path[-1])
        if spot is not None and not spot.name.startswith("seat"):
            high = spot.position[2] - floor_under(state.world, spot.position)
            return _at_spot(spot, state.world, people, start, wide=high > 0.2)
    seat = seat_of(target, state, who)
    if seat is not None:
        stands = [s for s in item.spots if s.name.startswith("stand")] if item is not None else []
        return _before_seat(seat, stands, state.world, people, start)
    if item is None or item.kind in ("room", "area"):
        middle = room_middle(state) if item is None else _middle(item)
        return _at_spot(Spot("middle", middle), state.world, people, start, wide=True)
    if item.id in state.props and state.props[item.id].hinge is None:
        holder = state.props[item.id].holder
        if holder is not None and holder[0] in state.actors:
            return None if holder[0] == who else _before(holder[0], state, people, start)
        point = target_point(target, state, (0.0, 0.0, 0.0)).position
        return _beside(point, state.world, people, start, ARM + 0.1)
    stand = next(
        (s for s in item.spots if s.name.startswith("stand") and _usable(s, state.world, people, start)), None
    )
    if stand is not None:
        x, y, z = stand.position
        facing = stand.facing if stand.facing is not None else _towards((x, y), item.centre)
        return Stop(x, y, facing, z)
    return _around(item, state.world, people, start)


def _towards(a: tuple[float, ...], b: tuple[float, ...]) -> float:
    return math.atan2(b[1] - a[1], b[0] - a[0])


def _usable(spot: Spot, world: World, people: Discs, start: Place | None) -> bool:
    clear = _clear(world, spot.position, people)
    return clear >= 0.8 * BODY_RADIUS and (start is None or reachable(world, start, spot.position, people))


def _clear(world: World, point: Point, people: Discs) -> float:
    """Metres from a place on a floor to what is nearest."""
    grid = grid_of(world, level_at(world, point)).with_people(people)
    return float(grid.clearance_at(np.array(point)))


def _at_spot(spot: Spot, world: World, people: Discs, start: Place | None, wide: bool) -> Stop | None:
    x, y, _ = spot.position
    found = nearest_free(world, spot.position, people, within=1.6 if wide else 1.3, start=start)
    if found is None:
        return None
    moved = math.hypot(found[0] - x, found[1] - y)
    if moved < 0.05:
        found = (x, y, found[2])
    facing = spot.facing if spot.facing is not None else (_towards(found, (x, y)) if moved > 0.05 else 0.0)
    return Stop(found[0], found[1], facing, found[2])


def _beside(point: Point, world: World, people: Discs, start: Place | None, within: float) -> Stop | None:
    """The nearest free floor to a point, facing it."""
    found = nearest_free(world, point, people, within=within, start=start)
    return None if found is None else Stop(found[0], found[1], _towards(found, point), found[2])


def _around(item: WorldObject, world: World, people: Discs, start: Place | None) -> Stop | None:
    """Free floor nearest to an object's bounds, facing its middle."""
    centre = item.centre
    reach = math.hypot(item.high[0] - item.low[0], item.high[1] - item.low[1]) / 2
    best: Stop | None = None
    score = math.inf
    for k in range(16):
        a = 2 * math.pi * k / 16
        edge = (
            min(max(centre[0] + 2 * reach * math.cos(a), item.low[0]), item.high[0]),
            min(max(centre[1] + 2 * reach * math.sin(a), item.low[1]), item.high[1]),
            item.low[2],
        )
        found = nearest_free(world, edge, people, within=0.8, start=start)
        if found is not None:
            away = math.hypot(found[0] - edge[0], found[1] - edge[1])
            come = math.hypot(found[0] - start[0], found[1] - start[1]) if start is not None else 0.0
            if away + 0.3 * come < score:
                best = Stop(found[0], found[1], _towards(found, centre), found[2])
                score = away + 0.3 * come
    return best


def _before_seat(
    seat: Spot, stands: list[Spot], world: World, people: Discs, start: Place | None
) -> Stop | None:
    """Before a seat; where there is no room (a piano, a tractor), beside it, where its ``stands`` say."""
    facing = seat.facing if seat.facing is not None else 0.0
    x = seat.position[0] + 0.55 * math.cos(facing)
    y = seat.position[1] + 0.55 * math.sin(facing)
    beside = [s for s in stands if _usable(s, world, people, start)]
    if beside and _clear(world, (x, y, beside[0].position[2]), people) <= 0.0:
        near = seat.position if start is None else (*start[:2], 0.0)
        spot = min(beside, key=lambda s: math.dist(s.position[:2], near[:2]))
        return Stop(*spot.position[:2], facing, spot.position[2])
    found = nearest_free(world, (x, y, seat.position[2]), people, within=0.7, start=start)
    if found is None:  # a chair pushed in: from the side or from behind
        found = nearest_free(world, seat.position, people, within=1.3, start=start)
    return None if found is None else Stop(found[0], found[1], facing, found[2])


def with_somebody(name: str, who: str, state: SceneState, beside: bool) -> Stop | None:
    """Face to face with somebody, or at their side and looking where they look, with no wall between; None
    where there is no room."""
    other, people = state.actors[name], state.people(but=who)

    def near(goal: Point) -> bool:
        return near_on_foot(state.world, other.position, goal)

    if beside and (goal := _by_somebody(name, state, people, _SIDES, (_ABREAST,), near)) is not None:
        return Stop(*goal[:2], other.heading, goal[2])
    return _before(name, state, people, None)


def _by_somebody(
    name: str,
    state: SceneState,
    people: Discs,
    turns: tuple[float, ...],
    aways: tuple[float, ...],
    will_do: Callable[[Point], bool],
) -> Point | None:
    """The first free place by somebody, so far away and at such an angle from where they look."""
    other = state.actors[name]
    x, y, z = other.position
    for turn in turns:
        for far in aways:
            a = other.heading + turn
            goal = (x + far * math.cos(a), y + far * math.sin(a), z)
            if _clear(state.world, goal, people) >= BODY_RADIUS and will_do(goal):
                return goal
    return None


def near_on_foot(world: World, start: Point, goal: Point) -> bool:
    """Whether the way between two places is hardly longer than they are apart."""
    ways = find_paths(world, start, goal)
    return bool(ways) and length(ways[0]) < 1.5 * math.dist(start[:2], goal[:2]) + 0.6


def open_between(world: World, somebody: Point, place: Point) -> bool:
    """Whether one can step straight up to somebody from a place, up to the seat they may be on."""
    grid, away = grid_of(world, level_at(world, place)), math.dist(somebody[:2], place[:2])
    steps = np.arange(min(_TO_A_SEAT / max(away, 1e-6), 1.0), 1.0, _STEP / max(away, _STEP))
    way = np.array(somebody)[:2] + steps[:, None] * (np.array(place)[:2] - np.array(somebody)[:2])
    return all(float(grid.clearance_at(np.array((*at, place[2])))) > 0.0 for at in way)


def _before(name: str, state: SceneState, people: Discs, start: Place | None) -> Stop | None:
    """Face to face with somebody: in front of them with nothing between, else as near to that as there is
    room."""
    other, world = state.actors[name], state.world

    def joined(goal: Point) -> bool:
        return start is None or reachable(world, start, goal, people)

    def near(goal: Point) -> bool:
        return joined(goal) and near_on_foot(world, other.position, goal)

    def open_to(goal: Point) -> bool:
        return near(goal) and open_between(world, other.position, goal)

    # not behind a tree or on the other side of a shelf that they look at, if there is a choice
    for will_do in (open_to, near, joined):
        goal = _by_somebody(name, state, people, _AHEAD, _FACE_TO_FACE, will_do)
        if goal is not None:
            return Stop(goal[0], goal[1], _towards(goal, other.position), goal[2])
    found = nearest_free(world, other.position, people, within=1.6, start=start)
    if found is None:
        return None
    return Stop(found[0], found[1], _towards(found, other.position), found[2])
