"""Ways across a set's floors, up its stairs and through its doors.

Assumes a :class:`~runtime.world.World` in metres. Guarantees that every point of a path, its first and
last half step aside (they may start from a chair or end close to a table), keeps the body's radius from
every obstacle, and that the same question always has the same answer. Places are (x, y) or (x, y, z);
z says which floor is meant.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from .grid import BODY_RADIUS, CELL, SNAP, Discs, Grid, grid_of, level_at
from .paths import apart, costs, length, price, resample, shortest, ways
from .world import Stairs, World

__all__ = [
    "BODY_RADIUS",
    "CELL",
    "SNAP",
    "Discs",
    "Grid",
    "find_paths",
    "grid_of",
    "level_at",
    "nearest_free",
    "obstacles",
    "reachable",
]

Array = NDArray[np.float64]
Place = tuple[float, ...]
_LANDING = 0.42  # how far before the first step and after the last one walks onto the stairs, metres
_LANE = 0.9  # how far apart people go up side by side, metres


@dataclass(frozen=True)
class _Lane:
    """A line up a flight of stairs: levels it joins, and where it begins and ends on them."""

    low: int
    high: int
    foot: tuple[float, float, float]
    head: tuple[float, float, float]
    stairs: Stairs

    def end(self, level: int) -> tuple[float, float, float]:
        return self.foot if level == self.low else self.head

    def other(self, level: int) -> int:
        return self.high if level == self.low else self.low


@lru_cache(maxsize=16)
def _lanes(world: World) -> tuple[_Lane, ...]:
    """All ways up and down; a wide flight has several."""
    found = []
    for stairs in world.stairs:
        (lx, ly, lz), (hx, hy, hz), (ax, ay) = stairs.low, stairs.high, stairs.ahead
        room = max(stairs.width - 2 * BODY_RADIUS - 0.1, 0.0)
        count = int(room / _LANE) + 1
        for k in range(count):
            side = (k - (count - 1) / 2) * (room / max(count - 1, 1))
            dx, dy = -side * ay, side * ax
            foot = (lx + dx - _LANDING * ax, ly + dy - _LANDING * ay, lz)
            head = (hx + dx + _LANDING * ax, hy + dy + _LANDING * ay, hz)
            low, high = level_at(world, foot), level_at(world, head)
            if low != high:
                found.append(_Lane(low, high, foot, head, stairs))
    return tuple(found)


def nearest_free(
    world: World,
    point: Place,
    people: Discs = (),
    radius: float = BODY_RADIUS,
    within: float = 3.0,
    start: Place | None = None,
) -> tuple[float, float, float] | None:
    """The walkable place closest to a point, on its floor; None if there is none within that many metres.

    start: where somebody would come from; only places joined to it by walkable ground and stairs count
    """
    level = level_at(world, start if len(point) < 3 and start is not None else point)
    grid = grid_of(world, level).with_people(people)
    free = grid.free(radius) if start is None else _joined(world, start, people, radius).get(level)
    cells = np.argwhere(free) if free is not None else np.zeros((0, 2), np.int64)
    if not len(cells):
        return None
    centres = grid.point(cells)
    away = np.hypot(centres[:, 0] - point[0], centres[:, 1] - point[1])
    best = int(np.argmin(away))
    if away[best] > within:
        return None
    return float(centres[best, 0]), float(centres[best, 1]), grid.height


def reachable(
    world: World, start: Place, goal: Place, people: Discs = (), radius: float = BODY_RADIUS
) -> bool:
    """Whether walkable ground and stairs join the two places."""
    level = level_at(world, goal)
    cell = grid_of(world, level).with_people(people).snap(np.array(goal), radius)
    free = _joined(world, start, people, radius).get(level)
    return cell is not None and free is not None and bool(free[cell])


@lru_cache(maxsize=32)
def _joined(world: World, start: Place, people: Discs, radius: float) -> dict[int, NDArray[np.bool_]]:
    """The cells of each level that can be walked to from a place."""
    first = level_at(world, start)
    found: dict[int, NDArray[np.bool_]] = {}
    labels: dict[int, tuple[Grid, NDArray[np.int32]]] = {}

    def spread(level: int, point: Place, within: float) -> bool:
        """Add the ground around a point; whether there was any that is new."""
        if level not in labels:
            grid = grid_of(world, level).with_people(people)
            labels[level] = grid, ndimage.label(grid.free(radius), structure=np.ones((3, 3)))[0]
        grid, label = labels[level]
        cell = grid.snap(np.array(point), radius, within)
        if cell is None or (level in found and found[level][cell]):
            return False
        found[level] = found.get(level, np.zeros(label.shape, bool)) | (label == label[cell])
        return True

    open_ = [first] if spread(first, start, SNAP) else []
    while open_:
        level = open_.pop()
        for lane in _lanes(world):
            if level not in (lane.low, lane.high):
                continue
            cell = labels[level][0].snap(np.array(lane.end(level)), radius, 0.3)
            beyond = lane.other(level)
            if cell is not None and found[level][cell] and spread(beyond, lane.end(beyond), 0.3):
                open_.append(beyond)
    return found


def obstacles(world: World, start: Place, goal: Place) -> list[int]:
    """Ids of the objects that would have to go for a way from start to goal, in its order; −1 for walls.

    On two floors: of what is in the way to the nearest stairs, nothing where none join them.
    """
    a, b = level_at(world, start), level_at(world, goal)
    if a == b:
        return _obstacles(grid_of(world, a), start, goal)
    found: list[int] = []
    for route in _routes(world, a, b)[:1]:
        here = start
        for level, lane in zip(_levels(route, a), route, strict=True):
            found += _obstacles(grid_of(world, level), here, lane.end(level))
            here = lane.end(lane.other(level))
        found += _obstacles(grid_of(world, b), here, goal)
    return list(dict.fromkeys(found))


def _obstacles(grid: Grid, start: Place, goal: Place) -> list[int]:
    cost = np.where(grid.clearance >= BODY_RADIUS, 1.0, np.where(grid.owner >= -1, 60.0, 900.0))
    first, last = grid.cell(np.array(start)), grid.cell(np.array(goal))
    cells = shortest(cost, (int(first[0]), int(first[1])), (int(last[0]), int(last[1])))
    if cells is None:
        return []
    reach = int(BODY_RADIUS / CELL)
    found: list[int] = []
    for i, j in cells[cost[cells[:, 0], cells[:, 1]] > 1.0]:
        near = grid.owner[max(0, i - reach) : i + reach + 1, max(0, j - reach) : j + reach + 1]
        found.extend(int(k) for k in np.unique(near) if k >= 0)
        if grid.owner[i, j] == -2:
            found.append(-1)
    return list(dict.fromkeys(found))


def find_paths(
    world: World,
    start: Place,
    goal: Place,
    count: int = 1,
    radius: float = BODY_RADIUS,
    people: Discs = (),
) -> list[Array]:
    """Up to ``count`` truly different smooth ways from start to goal, the shortest first.

    Two ways differ when somewhere they are 0.4 m apart or more; none is longer than 1.8 times the first.
    people: others standing in the way
    returns: float64 [K, 3] arrays, metres, about 8 cm between points; z is that of the floor, and rises
        evenly from the foot of stairs to their head; empty when there is no way
    """
    a, b = level_at(world, start), level_at(world, goal)
    if a == b:
        grid = grid_of(world, a).with_people(people)
        flat = ways(grid, np.array(start[:2], float), np.array(goal[:2], float), count, radius)
        if flat:
            return [_at_height(path, grid.height) for path in flat]
    found: list[Array] = []
    for route in _cheapest(world, start, goal, people, radius):
        for path in _along(world, route, start, goal, count, radius, people):
            if not found or (apart(path, found) >= 0.4 and length(path) <= 1.8 * length(found[0]) + 0.5):
                found.append(path)
            if len(found) == count:
                return found
    return found


def _at_height(path: Array, height: float) -> Array:
    return np.concatenate([path, np.full((len(path), 1), height)], axis=1)


def _levels(route: tuple[_Lane, ...], first: int) -> list[int]:
    """The level each lane of a route is entered from."""
    levels = [first]
    for lane in route[:-1]:
        levels.append(lane.other(levels[-1]))
    return levels[: len(route)]


def _routes(world: World, first: int, last: int, most: int = 4) -> list[tuple[_Lane, ...]]:
    """Ways over stairs from level to level, none visited twice; from a level to itself over another."""
    out: list[tuple[_Lane, ...]] = []

    def go(level: int, taken: tuple[_Lane, ...], seen: frozenset[int]) -> None:
        for lane in _lanes(world):
            if level not in (lane.low, lane.high) or lane in taken:
                continue
            beyond = lane.other(level)
            if beyond == last:
                out.append((*taken, lane))
            elif beyond not in seen and len(taken) + 1 < most:
                go(beyond, (*taken, lane), seen | {beyond})

    go(first, (), frozenset({first}))
    return out


def _cheapest(
    world: World, start: Place, goal: Place, people: Discs, radius: float
) -> list[tuple[_Lane, ...]]:
    """Routes over stairs that can be walked, the cheapest first; of the lanes of one flight only one."""
    a, b = level_at(world, start), level_at(world, goal)
    maps: dict[tuple[int, Place], Array] = {}

    def spent(level: int, origin: Place, to: Place) -> float:
        grid = grid_of(world, level).with_people(people)
        if (level, origin) not in maps:
            cell = grid.snap(np.array(origin), radius)
            blocked = np.full(grid.clearance.shape, np.inf)
            maps[level, origin] = blocked if cell is None else costs(price(grid, radius), cell)
        end = grid.snap(np.array(to), radius, 0.3)
        return math.inf if end is None else float(maps[level, origin][end]) * CELL

    priced: list[tuple[float, int, tuple[_Lane, ...]]] = []
    for number, route in enumerate(_routes(world, a, b)):
        levels = _levels(route, a)
        total = spent(a, start, route[0].end(a)) + spent(b, goal, route[-1].end(b))
        for before, lane, level in zip(route[:-1], route[1:], levels[1:], strict=True):
            total += spent(level, before.end(level), lane.end(level))
        total += sum(1.5 * math.dist(lane.foot, lane.head) for lane in route)
        if math.isfinite(total):
            priced.append((total, number, route))
    kept: dict[tuple[Stairs, ...], tuple[_Lane, ...]] = {}
    for _, _, route in sorted(priced, key=lambda p: p[:2]):
        kept.setdefault(tuple(lane.stairs for lane in route), route)
    return list(kept.values())


def _along(
    world: World,
    route: tuple[_Lane, ...],
    start: Place,
    goal: Place,
    count: int,
    radius: float,
    people: Discs,
) -> list[Array]:
    """Ways that go over these stairs, leg by leg."""
    legs: list[list[Array]] = []
    here: Place = start
    a, b = level_at(world, start), level_at(world, goal)
    stops = [(level, lane.end(level), lane) for level, lane in zip(_levels(route, a), route, strict=True)]
    for level, to, lane in [*stops, (b, goal, None)]:
        grid = grid_of(world, level).with_people(people)
        flat = ways(grid, np.array(here[:2], float), np.array(to[:2], float), count, radius)
        if not flat:
            return []
        legs.append([_at_height(path, grid.height) for path in flat])
        if lane is not None:
            legs.append([_climb(lane, up=lane.low == level)])
            here = lane.end(lane.other(level))
    out = []
    for k in range(max(len(leg) for leg in legs)):
        out.append(np.concatenate([leg[min(k, len(leg) - 1)] for leg in legs]))
    return [path[np.r_[True, np.linalg.norm(np.diff(path, axis=0), axis=1) > 1e-6]] for path in out]


def _climb(lane: _Lane, up: bool) -> Array:
    """[K, 3]: over the steps, from landing to landing; level on the landings, even between."""
    s = lane.stairs
    ahead = np.array([*s.ahead, 0.0])
    foot, head = np.array(lane.foot), np.array(lane.head)
    points = np.array([foot, foot + _LANDING * ahead, head - _LANDING * ahead, head])
    points[1, 2], points[2, 2] = foot[2], head[2]
    line = resample(points)
    return line if up else line[::-1].copy()
