"""Ways across one level: the cheapest line of cells, made smooth, and others that differ from it."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from skimage.graph import MCP_Geometric

from .grid import CELL, Grid

_SPACING = 0.08  # between the points of a finished path, metres
_APART = 0.4  # how far two ways have to be from each other somewhere, metres
Array = NDArray[np.float64]


def price(grid: Grid, radius: float) -> Array:
    """What walking over each cell costs, more close to things; -1 where a body does not fit."""
    near = np.clip(1.0 - grid.clearance / (2.2 * radius), 0.0, 1.0)
    return np.where(grid.free(radius), 1.0 + 1.5 * near, -1.0)


def costs(cost: Array, first: tuple[int, int]) -> Array:
    """What it costs to get to each cell from one of them; inf where there is no way."""
    total, _ = MCP_Geometric(cost).find_costs([first])
    return np.asarray(total)


def ways(grid: Grid, start: Array, goal: Array, count: int, radius: float) -> list[Array]:
    """Up to ``count`` truly different smooth ways [K, 2] from start [2] to goal [2], the cheapest first."""
    first, last = grid.snap(start, radius), grid.snap(goal, radius)
    if first is None or last is None:
        return []
    free, cost = grid.free(radius), price(grid, radius)
    paths: list[Array] = []
    for _ in range(3 * count):
        cells = shortest(cost, first, last)
        if cells is None:
            break
        path = _finish(grid, free, cost, cells, start, goal)
        if not paths or (apart(path, paths) >= _APART and length(path) <= 1.8 * length(paths[0]) + 0.5):
            paths.append(path)
        if len(paths) == count:
            break
        cost = _discourage(grid, cost, free, path)
    return [*paths[:1], *sorted(paths[1:], key=length)]


def shortest(cost: Array, first: tuple[int, int], last: tuple[int, int]) -> NDArray[np.int64] | None:
    search = MCP_Geometric(cost)
    total, _ = search.find_costs([first], [last])
    if not np.isfinite(total[last]):
        return None
    return np.array(search.traceback(last), dtype=np.int64)


def _discourage(grid: Grid, cost: Array, free: NDArray[np.bool_], path: Array) -> Array:
    """Make ground near a way already found expensive, its two ends aside."""
    whole = length(path)
    along = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))]
    end = min(0.4, 0.2 * whole)
    middle = path[(along >= end) & (along <= whole - end)]
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
    cost: Array,
    cells: NDArray[np.int64],
    start: Array,
    goal: Array,
) -> Array:
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
        dense = resample(smooth)
        index = grid.cell(dense)
        if rounds == 0 or free[index[:, 0], index[:, 1]].all():
            break
    ends = [dense]
    if np.linalg.norm(dense[0] - start) > 1e-6:
        ends.insert(0, start[None])
    if np.linalg.norm(dense[-1] - goal) > 1e-6:
        ends.append(goal[None])
    return resample(np.concatenate(ends))


def _pull(cost: Array, cells: NDArray[np.int64]) -> NDArray[np.int64]:
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


def _line_cost(cost: Array, a: NDArray[np.int64], b: NDArray[np.int64]) -> float | None:
    """Cost of the straight line between two cells, None when it leaves walkable ground."""
    (x, y), (dx, dy) = a.tolist(), (b - a).tolist()
    far = math.hypot(dx, dy)
    steps = math.ceil(far * 2)
    t = np.arange(steps + 1) / max(steps, 1)
    price = cost[np.rint(x + t * dx).astype(np.int64), np.rint(y + t * dy).astype(np.int64)]
    return None if price.min() < 0 else float(price.sum()) / (steps + 1) * far


def _cut_corners(points: Array) -> Array:
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


def resample(points: Array) -> Array:
    along = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]
    count = max(2, int(np.ceil(along[-1] / _SPACING)) + 1)
    at = np.linspace(0.0, along[-1], count)
    return np.stack([np.interp(at, along, points[:, k]) for k in range(points.shape[1])], axis=1)


def length(path: Array) -> float:
    return float(np.linalg.norm(np.diff(path, axis=0), axis=1).sum())


def apart(path: Array, others: list[Array]) -> float:
    """The least, over the others, of the greatest distance from this path to that one."""
    return min(
        float(np.linalg.norm(path[:, None] - other[None], axis=2).min(axis=1).max()) for other in others
    )
