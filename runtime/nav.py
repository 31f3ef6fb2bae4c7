"""Ways across a set's floor.

Assumes a :class:`~runtime.world.World` in metres whose ``floors`` are the ground people can stand on
and whose ``solids`` are what they would bump into. Guarantees that every point of a path, its first and
last half step aside (they may start from a chair or end close to a table), keeps the body's radius from
every obstacle, and that the same question always has the same answer.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from skimage.graph import MCP_Geometric

from .world import World

CELL = 0.05  # edge of a grid cell, metres
BODY_RADIUS = 0.25  # half of a person's width with room to swing the arms, metres
STEP_OVER, DUCK_UNDER = 0.1, 1.8  # boxes lower than the first or starting above the second do not block
SNAP = 0.9  # how far from walkable ground a start or goal may lie, metres
_SPACING = 0.08  # between the points of a finished path, metres

#: People in the way: (x, y, radius) each.
Discs = tuple[tuple[float, float, float], ...]


@dataclass(frozen=True, eq=False)
class Grid:
    """Floor of a world in cells of 5 cm.

    origin: world (x, y) of the corner of cell (0, 0)
    clearance: float32 [NX, NY], metres from the cell's centre to the nearest thing that blocks
    owner: int32 [NX, NY], id of the object whose box blocks the cell, -1 walkable, -2 no floor or a wall
    """

    origin: tuple[float, float]
    clearance: NDArray[np.float32]
    owner: NDArray[np.int32]

    def cell(self, points: NDArray[np.float64]) -> NDArray[np.int64]:
        """Indices [..., 2] of the cells of points [..., 2], kept inside the grid."""
        index = np.floor((np.asarray(points) - self.origin) / CELL).astype(np.int64)
        return np.clip(index, 0, np.array(self.clearance.shape) - 1)

    def point(self, cells: NDArray[np.int64]) -> NDArray[np.float64]:
        """Centres [..., 2] of cells [..., 2], metres."""
        return (np.asarray(cells) + 0.5) * CELL + np.array(self.origin)

    def clearance_at(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Metres to the nearest obstacle of points [..., 2]; 0 outside the grid."""
        index = np.floor((np.asarray(points) - self.origin) / CELL).astype(np.int64)
        inside = np.all((index >= 0) & (index < np.array(self.clearance.shape)), axis=-1)
        cell = self.cell(points)
        return np.where(inside, self.clearance[cell[..., 0], cell[..., 1]], 0.0)

    def with_people(self, people: Discs) -> Grid:
        """The same floor with people standing on it."""
        if not people:
            return self
        nx, ny = self.clearance.shape
        x = (np.arange(nx) + 0.5) * CELL + self.origin[0]
        y = (np.arange(ny) + 0.5) * CELL + self.origin[1]
        clearance = self.clearance.copy()
        for px, py, radius in people:
            away = np.hypot(x[:, None] - px, y[None, :] - py) - radius
            np.minimum(clearance, np.maximum(away, 0.0), out=clearance, casting="same_kind")
        return Grid(self.origin, clearance, self.owner)


@lru_cache(maxsize=16)
def grid_of(world: World) -> Grid:
    """The occupancy grid of a world, made once."""
    floors = np.array(world.floors, dtype=np.float64).reshape(-1, 4)
    if not len(floors):
        return Grid((0.0, 0.0), np.zeros((1, 1), np.float32), np.full((1, 1), -2, np.int32))
    low = floors[:, :2].min(axis=0) - 2 * CELL
    shape = np.ceil((floors[:, 2:].max(axis=0) + 2 * CELL - low) / CELL).astype(int)
    x = (np.arange(shape[0]) + 0.5) * CELL + low[0]
    y = (np.arange(shape[1]) + 0.5) * CELL + low[1]
    owner = np.full(tuple(shape), -2, np.int32)
    for x0, y0, x1, y1 in floors:
        owner[np.ix_((x >= x0) & (x <= x1), (y >= y0) & (y <= y1))] = -1
    solids = world.solids
    bottom, top = solids.centre[:, 2] - solids.half[:, 2], solids.centre[:, 2] + solids.half[:, 2]
    for b in np.flatnonzero((top > STEP_OVER) & (bottom < DUCK_UNDER)):
        _block(owner, x, y, solids.centre[b], solids.half[b], solids.yaw[b], int(solids.object[b]))
    clearance = ndimage.distance_transform_edt(owner == -1).astype(np.float32) * CELL
    return Grid((float(low[0]), float(low[1])), clearance, owner)


def _block(
    owner: NDArray[np.int32],
    x: NDArray[np.float64],
    y: NDArray[np.float64],
    centre: NDArray[np.float64],
    half: NDArray[np.float64],
    yaw: float,
    object_id: int,
) -> None:
    """Mark the cells under one box (in place, on the grid being built)."""
    reach = float(np.hypot(half[0], half[1]))
    i0, i1 = np.searchsorted(x, (centre[0] - reach, centre[0] + reach))
    j0, j1 = np.searchsorted(y, (centre[1] - reach, centre[1] + reach))
    dx, dy = x[i0:i1, None] - centre[0], y[None, j0:j1] - centre[1]
    c, s = np.cos(yaw), np.sin(yaw)
    inside = (np.abs(c * dx + s * dy) <= half[0] + CELL / 2) & (np.abs(c * dy - s * dx) <= half[1] + CELL / 2)
    owner[i0:i1, j0:j1][inside] = object_id if object_id >= 0 else -2


def nearest_free(
    world: World,
    point: tuple[float, float],
    people: Discs = (),
    radius: float = BODY_RADIUS,
    within: float = 3.0,
    start: tuple[float, float] | None = None,
) -> tuple[float, float] | None:
    """The walkable place closest to a point, None if there is none within that many metres.

    start: where somebody would come from; only places joined to it by walkable ground count
    """
    grid = grid_of(world).with_people(people)
    free = _component(grid, radius, start) if start is not None else grid.clearance >= radius
    cells = np.argwhere(free)
    if not len(cells):
        return None
    centres = grid.point(cells)
    away = np.hypot(centres[:, 0] - point[0], centres[:, 1] - point[1])
    best = int(np.argmin(away))
    if away[best] > within:
        return None
    return float(centres[best, 0]), float(centres[best, 1])


def reachable(
    world: World,
    start: tuple[float, float],
    goal: tuple[float, float],
    people: Discs = (),
    radius: float = BODY_RADIUS,
) -> bool:
    """Whether walkable ground joins the two places."""
    grid = grid_of(world).with_people(people)
    a, b = _snap(grid, start, radius), _snap(grid, goal, radius)
    if a is None or b is None:
        return False
    labels, _ = ndimage.label(grid.clearance >= radius, structure=np.ones((3, 3)))
    return bool(labels[a] == labels[b])


def obstacles(world: World, start: tuple[float, float], goal: tuple[float, float]) -> list[int]:
    """Ids of the objects that would have to go for a way from start to goal, in its order; −1 for walls."""
    grid = grid_of(world)
    cost = np.where(grid.clearance >= BODY_RADIUS, 1.0, np.where(grid.owner >= -1, 60.0, 900.0))
    first, last = grid.cell(np.array(start)), grid.cell(np.array(goal))
    cells = _shortest(cost, (int(first[0]), int(first[1])), (int(last[0]), int(last[1])))
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
    start: tuple[float, float],
    goal: tuple[float, float],
    count: int = 1,
    radius: float = BODY_RADIUS,
    people: Discs = (),
) -> list[NDArray[np.float64]]:
    """Up to ``count`` truly different smooth ways from start to goal, the shortest first.

    Two ways differ when somewhere they are 0.4 m apart or more; none is longer than 1.8 times the first.
    people: (x, y, radius) of others standing in the way
    returns: float64 [K, 2] arrays, metres, about 8 cm between points; empty when there is no way
    """
    start_xy, goal_xy = np.array(start, float)[:2], np.array(goal, float)[:2]
    grid = grid_of(world).with_people(people)
    first = _snap(grid, (float(start_xy[0]), float(start_xy[1])), radius)
    last = _snap(grid, (float(goal_xy[0]), float(goal_xy[1])), radius)
    if first is None or last is None:
        return []
    free = grid.clearance >= radius
    base = np.where(free, 1.0 + 1.5 * np.clip(1.0 - grid.clearance / (2.2 * radius), 0.0, 1.0), -1.0)
    paths: list[NDArray[np.float64]] = []
    cost = base
    for _ in range(2 * count):
        cells = _shortest(cost, first, last)
        if cells is None:
            break
        path = _finish(grid, free, cost, cells, start_xy, goal_xy)
        if not paths or (_apart(path, paths) >= 0.4 and _length(path) <= 1.8 * _length(paths[0]) + 0.5):
            paths.append(path)
        if len(paths) == count:
            break
        cost = _discourage(grid, cost, free, path)
    return paths


def _snap(grid: Grid, point: tuple[float, float], radius: float) -> tuple[int, int] | None:
    """The nearest walkable cell to a point, if it is near enough."""
    i, j = grid.cell(np.array(point))
    if grid.clearance[i, j] >= radius and grid.clearance_at(np.array(point)) >= radius:
        return int(i), int(j)
    span = int(SNAP / CELL) + 1
    i0, j0 = max(0, i - span), max(0, j - span)
    cells = np.argwhere(grid.clearance[i0 : i + span + 1, j0 : j + span + 1] >= radius) + np.array((i0, j0))
    if not len(cells):
        return None
    away = np.linalg.norm(grid.point(cells) - np.array(point), axis=1)
    best = int(np.argmin(away))
    return (int(cells[best, 0]), int(cells[best, 1])) if away[best] <= SNAP else None


def _component(grid: Grid, radius: float, start: tuple[float, float]) -> NDArray[np.bool_]:
    """Walkable cells joined to the start."""
    cell = _snap(grid, start, radius)
    labels, _ = ndimage.label(grid.clearance >= radius, structure=np.ones((3, 3)))
    if cell is None:
        return np.zeros(labels.shape, bool)
    return np.asarray(labels == labels[cell])


def _shortest(
    cost: NDArray[np.float64], first: tuple[int, int], last: tuple[int, int]
) -> NDArray[np.int64] | None:
    search = MCP_Geometric(cost)
    total, _ = search.find_costs([first], [last])
    if not np.isfinite(total[last]):
        return None
    return np.array(search.traceback(last), dtype=np.int64)


def _discourage(
    grid: Grid, cost: NDArray[np.float64], free: NDArray[np.bool_], path: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Make ground near a way already found expensive, its two ends aside."""
    length = _length(path)
    along = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))]
    end = min(0.4, 0.2 * length)
    middle = path[(along >= end) & (along <= length - end)]
    if not len(middle):
        return cost
    mark = np.ones(cost.shape, bool)
    cells = grid.cell(middle)
    mark[cells[:, 0], cells[:, 1]] = False
    away = ndimage.distance_transform_edt(mark) * CELL
    return np.where(free, cost + 6.0 * np.clip(1.0 - away / 0.7, 0.0, 1.0), -1.0)


def _finish(
    grid: Grid,
    free: NDArray[np.bool_],
    cost: NDArray[np.float64],
    cells: NDArray[np.int64],
    start: NDArray[np.float64],
    goal: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Cells to a smooth polyline between the true ends, never through what the cells avoid."""
    knots = grid.point(_pull(cost, cells))
    if len(knots) > 1:
        if free[tuple(grid.cell(start))]:
            knots[0] = start
        if free[tuple(grid.cell(goal))]:
            knots[-1] = goal
    for rounds in (3, 2, 1, 0):
        smooth = knots
        for _ in range(rounds):
            smooth = _cut_corners(smooth)
        dense = _resample(smooth)
        index = grid.cell(dense)
        if rounds == 0 or free[index[:, 0], index[:, 1]].all():
            break
    ends = [dense]
    if np.linalg.norm(dense[0] - start) > 1e-6:
        ends.insert(0, start[None])
    if np.linalg.norm(dense[-1] - goal) > 1e-6:
        ends.append(goal[None])
    return _resample(np.concatenate(ends))


def _pull(cost: NDArray[np.float64], cells: NDArray[np.int64]) -> NDArray[np.int64]:
    """Drop cells wherever the straight line between their neighbours costs no more."""
    steps = np.linalg.norm(np.diff(cells, axis=0), axis=1)
    price = cost[cells[:, 0], cells[:, 1]]
    spent = np.r_[0.0, np.cumsum(steps * 0.5 * (price[1:] + price[:-1]))]
    kept, i = [0], 0
    while i < len(cells) - 1:
        j, stride = i + 1, max(1, (len(cells) - 1 - i) // 24)
        for k in range(len(cells) - 1, i + 1, -stride):
            straight = _line_cost(cost, cells[i], cells[k])
            if straight is not None and straight <= (spent[k] - spent[i]) * 1.02:
                j = k
                break
        kept.append(j)
        i = j
    return cells[kept]


def _line_cost(cost: NDArray[np.float64], a: NDArray[np.int64], b: NDArray[np.int64]) -> float | None:
    """Cost of the straight line between two cells, None when it leaves walkable ground."""
    (x, y), (dx, dy) = a.tolist(), (b - a).tolist()
    length = math.hypot(dx, dy)
    steps = math.ceil(length * 2)
    t = np.arange(steps + 1) / max(steps, 1)
    price = cost[np.rint(x + t * dx).astype(np.int64), np.rint(y + t * dy).astype(np.int64)]
    return None if price.min() < 0 else float(price.sum()) / (steps + 1) * length


def _cut_corners(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """One round of corner cutting; no cut is longer than half a metre."""
    if len(points) < 3:
        return points
    out = [points[0]]
    for before, corner, after in zip(points[:-2], points[1:-1], points[2:], strict=True):
        for end in (before, after):
            d = end - corner
            out.append(corner + d * min(0.25, 0.5 / max(float(np.linalg.norm(d)), 1e-9)))
    out.append(points[-1])
    return np.array(out)


def _resample(points: NDArray[np.float64]) -> NDArray[np.float64]:
    along = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]
    count = max(2, int(np.ceil(along[-1] / _SPACING)) + 1)
    at = np.linspace(0.0, along[-1], count)
    return np.stack([np.interp(at, along, points[:, k]) for k in range(2)], axis=1)


def _length(path: NDArray[np.float64]) -> float:
    return float(np.linalg.norm(np.diff(path, axis=0), axis=1).sum())


def _apart(path: NDArray[np.float64], others: list[NDArray[np.float64]]) -> float:
    """The least, over the others, of the greatest distance from this path to that one."""
    return min(
        float(np.linalg.norm(path[:, None] - other[None], axis=2).min(axis=1).max()) for other in others
    )
