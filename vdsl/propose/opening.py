"""What opens in a story: which part of a thing is meant, where one stands to move it, doors on the way."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from runtime.motion.types import Passage, TargetPoint
from runtime.nav import BODY_RADIUS, Discs, find_paths, grid_of, level_at, reachable
from runtime.world import World, WorldObject

from .places import Place, Point, Stop

Array = NDArray[np.float64]
Way = tuple[Array, tuple[Passage, ...]]

_ASIDE = 0.21  # metres between the middle of a body and whatever swings past it
_REACHES = (0.5, 0.45, 0.56, 0.62, 0.7, 0.78)  # metres on the floor to a handle, the handiest first
_TURNS = 24
_SHUT = 0.55  # a door standing less open than this is opened further
_THICK = 0.09  # metres around a leaf within which a way goes through it


def parts_of(item: WorldObject, world: World) -> list[WorldObject]:
    """What opens of a thing: itself, or the parts on it."""
    return [o for o in world.objects if o.hinge is not None and item.id in (o.id, o.hinge.owner)]


def part_to_move(item: WorldObject, world: World, openness: float, near: Point) -> WorldObject | None:
    """The handiest part that is not that far open yet (the handiest of all, where every one is)."""
    parts = parts_of(item, world)

    def rank(part: WorldObject) -> tuple[bool, int, float]:
        handle = handle_of(part)
        off = abs(handle[2] - near[2] - 1.1) / 0.45  # rather the fridge than the freezer under it
        return stands(part, openness), int(off), math.dist(handle, near)

    return min(parts, key=rank, default=None)


def stands(part: WorldObject, openness: float) -> bool:
    """Whether it is as far open as that already."""
    return abs(part.ajar - openness) < 0.1


def handle_of(part: WorldObject) -> Point:
    """Where a hand takes hold of it now."""
    assert part.hinge is not None
    x, y, z = (part.world_from_object @ np.array([*part.hinge.handle, 1.0]))[:3].tolist()
    return x, y, z


def part_point(part: WorldObject) -> TargetPoint:
    """It as a target for hands and eyes."""
    handle = handle_of(part)
    return TargetPoint(handle, handle, object=part.id)


def stand_to_move(
    part: WorldObject,
    openness: float,
    world: World,
    people: Discs,
    start: Place | None,
    before: Array | None = None,
) -> Stop | None:
    """A place with the handle in reach that the part does not sweep over; None where there is none.

    before: [2], a point on the side of the part one is to stand on
    """
    handle = np.array(handle_of(part))
    level = level_at(world, (handle[0], handle[1], handle[2] - 0.3))
    grid = grid_of(world, level).with_people(people)
    for x, y in _around(part, handle, before, start):
        place = (x, y, grid.height)
        if grid.clearance_at(np.array(place)) < 0.9 * BODY_RADIUS or _swept(part, openness, place):
            continue
        if start is None or reachable(world, start, place, people, 0.9 * BODY_RADIUS):
            return Stop(x, y, math.atan2(handle[1] - y, handle[0] - x), grid.height)
    return None


def _around(
    part: WorldObject, handle: Array, before: Array | None, start: Place | None
) -> Iterator[tuple[float, float]]:
    """Places round a handle: where one stands already, then those straight before it, near ones first."""
    assert part.hinge is not None
    centre, across = np.array(part.centre[:2]), _across(part)
    side = before if before is not None else handle[:2] + 0.3 * _front(part, handle)
    if (side - centre) @ across < 0:
        across = -across
    either = before is None and part.ajar > 0.3  # an open leaf is taken hold of from both sides
    if either and start is not None and (np.array(start[:2]) - centre) @ across < 0:
        across = -across
    straight = math.atan2(across[1], across[0])
    found = []
    if start is not None and before is None and 0.35 < math.dist(start[:2], handle[:2]) < 0.66:
        found.append((-1.0, float(start[0]), float(start[1])))
    for r, reach in enumerate(_REACHES):
        for k in range(_TURNS):
            turn = (k + 1) // 2 * (1 if k % 2 else -1) * 2 * math.pi / _TURNS
            at = handle[:2] + reach * np.array([math.cos(straight + turn), math.sin(straight + turn)])
            if either or (at - centre) @ across > 0.05:
                found.append((abs(turn) + 0.12 * r, float(at[0]), float(at[1])))
    return ((x, y) for _, x, y in sorted(found))


def _across(part: WorldObject) -> Array:
    """[2]: the direction across a leaf, on the floor plan."""
    assert part.hinge is not None
    middle, half, yaw = part.hinge.solids(part.ajar)
    if not len(middle):
        return np.asarray(part.hinge.closed[:2, 1])
    widest = half[int((half[:, 0] * half[:, 1] * half[:, 2]).argmax())]
    angle = yaw + (math.pi / 2 if widest[1] <= widest[0] else 0.0)
    return np.array([math.cos(angle), math.sin(angle)])


def _front(part: WorldObject, handle: Array) -> Array:
    """[2]: from a thing's middle towards its handle: the side it is opened from."""
    assert part.hinge is not None
    closed = part.hinge.closed
    away = handle[:2] - closed[:2, 3]
    return np.asarray(away / max(float(np.linalg.norm(away)), 1e-6))


def _swept(part: WorldObject, openness: float, place: Point) -> bool:
    """Whether a body standing there is in the part's way."""
    assert part.hinge is not None
    for share in np.linspace(part.ajar, openness, 9):
        centre, half, yaw = part.hinge.solids(float(share))
        high = (centre[:, 2] + half[:, 2] > place[2] + 0.1) & (centre[:, 2] - half[:, 2] < place[2] + 1.8)
        if high.any() and _gap(centre[high], half[high], yaw, np.array(place[:2])) < _ASIDE:
            return True
    return False


def _gap(centre: Array, half: Array, yaw: float, point: Array) -> float:
    """Metres on the floor plan from a point to the nearest box."""
    d = point - centre[:, :2]
    c, s = math.cos(yaw), math.sin(yaw)
    local = np.abs(np.stack([c * d[:, 0] + s * d[:, 1], c * d[:, 1] - s * d[:, 0]], axis=1)) - half[:, :2]
    return float(np.linalg.norm(np.maximum(local, 0.0), axis=1).min())


# --- doors on the way -----------------------------------------------------------------------


def ways_through(
    world: World, here: Place, goal: Point, count: int, people: Discs, opened: tuple[int, ...] = ()
) -> list[Way]:
    """Up to ``count`` different ways, each with the doors that are shut on it; all open the same ones.

    A way leads to each door, to a place where its leaf swings past one, and on from there.
    """
    paths = find_paths(world, here, goal, count, people=people)
    if not paths:
        return []
    crossed = _first_shut(world, paths[0], opened)
    if crossed is None:
        return [(p, ()) for p in paths if _first_shut(world, p, opened) is None]
    part, at = crossed
    path = paths[0]
    before = path[max(at - 8, 0), :2]
    stop = stand_to_move(part, 1.0, world, people, here, before)
    if stop is None:
        x, y, z = path[max(at - 8, 0)].tolist()
        aim = handle_of(part)
        stop = Stop(x, y, math.atan2(aim[1] - y, aim[0] - x), z)
    door = Passage(part.id, stop.place, stop.heading, handle_of(part))
    to = [
        p
        for p in find_paths(world, here, stop.place, count, people=people)
        if _first_shut(world, p, opened) is None
    ] or [path[: max(at - 8, 0) + 1]]
    on = ways_through(world, stop.place, goal, count, people, (*opened, part.id))
    out: list[Way] = []
    for k in range(max(len(to), len(on)) if on else 0):
        first, (rest, doors) = to[min(k, len(to) - 1)], on[min(k, len(on) - 1)]
        out.append((np.concatenate([first, rest[1:]]), (door, *doors)))
    return out[:count]


def _first_shut(world: World, path: Array, opened: tuple[int, ...]) -> tuple[WorldObject, int] | None:
    """The first door a path goes through that is shut, and at which of its points."""
    best: tuple[WorldObject, int] | None = None
    for part in world.objects:
        if part.hinge is None or not part.hinge.way or part.ajar >= _SHUT or part.id in opened:
            continue
        centre, half, yaw = part.hinge.solids(part.ajar)
        for c, h in zip(centre, half, strict=True):
            d = path[:, :2] - c[:2]
            cos, sin = math.cos(yaw), math.sin(yaw)
            x, y = np.abs(cos * d[:, 0] + sin * d[:, 1]), np.abs(cos * d[:, 1] - sin * d[:, 0])
            level = (path[:, 2] > c[2] - h[2] - 0.3) & (path[:, 2] < c[2] + h[2])
            inside = np.flatnonzero((x < h[0] + _THICK) & (y < h[1] + _THICK) & level)
            if len(inside) and (best is None or inside[0] < best[1]):
                best = (part, int(inside[0]))
    return best
