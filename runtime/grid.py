"""The floor of one level in cells: what is free, how far the next obstacle is, and what it belongs to.

Assumes a :class:`~runtime.world.World` in metres whose floors are the ground people can stand on and whose
solids are what they would bump into. The leaf of a door one passes through does not block its opening: it
counts as standing open, where it is then in the way.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from .world import Rect, World

CELL = 0.05  # edge of a grid cell, metres
BODY_RADIUS = 0.25  # half of a person's width with room to swing the arms, metres
STEP_OVER, DUCK_UNDER = 0.1, 1.8  # boxes lower than the first or starting above the second do not block
SNAP = 0.9  # how far from walkable ground a start or goal may lie, metres
STANDS_OPEN = 0.6  # openness from which a door's leaf is passed as it is

#: People in the way: (x, y, radius) each, or (x, y, radius, z) for those on one level only.
Discs = tuple[tuple[float, ...], ...]
Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Grid:
    """Floor of a level in cells of 5 cm.

    origin: world (x, y) of the corner of cell (0, 0); height: of its floors
    clearance: float32 [NX, NY], metres from the cell's centre to the nearest thing that blocks
    owner: int32 [NX, NY], id of the object whose box blocks the cell, -1 walkable, -2 no floor or a wall
    """

    origin: tuple[float, float]
    clearance: NDArray[np.float32]
    owner: NDArray[np.int32]
    height: float = 0.0

    def cell(self, points: Array) -> NDArray[np.int64]:
        """Indices [..., 2] of the cells of points [..., 2 or 3], kept inside the grid."""
        index = np.floor((np.asarray(points)[..., :2] - self.origin) / CELL).astype(np.int64)
        return np.clip(index, 0, np.array(self.clearance.shape) - 1)

    def point(self, cells: NDArray[np.int64]) -> Array:
        """Centres [..., 2] of cells [..., 2], metres."""
        return (np.asarray(cells) + 0.5) * CELL + np.array(self.origin)

    def clearance_at(self, points: Array) -> Array:
        """Metres to the nearest obstacle of points [..., 2 or 3]; 0 outside the grid."""
        index = np.floor((np.asarray(points)[..., :2] - self.origin) / CELL).astype(np.int64)
        inside = np.all((index >= 0) & (index < np.array(self.clearance.shape)), axis=-1)
        cell = self.cell(points)
        return np.where(inside, self.clearance[cell[..., 0], cell[..., 1]], 0.0)

    def with_people(self, people: Discs) -> Grid:
        """The same floor with people standing on it."""
        here = [p for p in people if len(p) < 4 or abs(p[3] - self.height) < 0.5]
        if not here:
            return self
        nx, ny = self.clearance.shape
        x = (np.arange(nx) + 0.5) * CELL + self.origin[0]
        y = (np.arange(ny) + 0.5) * CELL + self.origin[1]
        clearance = self.clearance.copy()
        for px, py, radius, *_ in here:
            away = np.hypot(x[:, None] - px, y[None, :] - py) - radius
            np.minimum(clearance, np.maximum(away, 0.0), out=clearance, casting="same_kind")
        return Grid(self.origin, clearance, self.owner, self.height)

    def free(self, radius: float) -> NDArray[np.bool_]:
        """Cells [NX, NY] in which a body of that radius may stand."""
        return np.asarray(self.clearance >= radius)

    def snap(self, point: Array, radius: float, within: float = SNAP) -> tuple[int, int] | None:
        """The nearest walkable cell to a point [2 or more], if it is near enough."""
        at = np.asarray(point, np.float64)[:2]
        i, j = self.cell(at)
        if self.clearance[i, j] >= radius and self.clearance_at(at) >= radius:
            return int(i), int(j)
        span = int(within / CELL) + 1
        i0, j0 = max(0, i - span), max(0, j - span)
        near = self.clearance[i0 : i + span + 1, j0 : j + span + 1] >= radius
        cells = np.argwhere(near) + np.array((i0, j0))
        if not len(cells):
            return None
        away = np.linalg.norm(self.point(cells) - at, axis=1)
        best = int(np.argmin(away))
        return (int(cells[best, 0]), int(cells[best, 1])) if away[best] <= within else None


def level_at(world: World, point: tuple[float, ...] | Array) -> int:
    """Which of :attr:`World.storeys` a point (x, y) or (x, y, z) is on; without z the lowest there."""
    at = [float(v) for v in point]
    levels = world.storeys
    here = [
        k
        for k, level in enumerate(levels)
        if any(
            x0 - 0.1 <= at[0] <= x1 + 0.1 and y0 - 0.1 <= at[1] <= y1 + 0.1 for x0, y0, x1, y1 in level.floors
        )
    ] or list(range(len(levels)))
    if len(at) < 3:
        return here[0]
    under = [k for k in here if levels[k].height <= at[2] + 0.3]
    return under[-1] if under else here[0]


def _within(point: list[float], rect: Rect, margin: float = 0.1) -> bool:
    x0, y0, x1, y1 = rect
    return x0 - margin <= point[0] <= x1 + margin and y0 - margin <= point[1] <= y1 + margin


@lru_cache(maxsize=32)
def grid_of(world: World, level: int = 0) -> Grid:
    """The occupancy grid of a level of a world, made once."""
    storey = world.storeys[level]
    floors = np.array(storey.floors, dtype=np.float64).reshape(-1, 4)
    if not len(floors):
        return Grid((0.0, 0.0), np.zeros((1, 1), np.float32), np.full((1, 1), -2, np.int32), storey.height)
    low = floors[:, :2].min(axis=0) - 2 * CELL
    shape = np.ceil((floors[:, 2:].max(axis=0) + 2 * CELL - low) / CELL).astype(int)
    x = (np.arange(shape[0]) + 0.5) * CELL + low[0]
    y = (np.arange(shape[1]) + 0.5) * CELL + low[1]
    owner = np.full(tuple(shape), -2, np.int32)
    for x0, y0, x1, y1 in floors:
        owner[np.ix_((x >= x0) & (x <= x1), (y >= y0) & (y <= y1))] = -1
    centre, half, yaw = _boxes(world)
    bottom = centre[:, 2] - half[:, 2] - storey.height
    top = centre[:, 2] + half[:, 2] - storey.height
    for b in np.flatnonzero((top > STEP_OVER) & (bottom < DUCK_UNDER)):
        _block(owner, x, y, centre[b], half[b], float(yaw[b]), int(world.solids.object[b]))
    clearance = ndimage.distance_transform_edt(owner == -1).astype(np.float32) * CELL
    return Grid((float(low[0]), float(low[1])), clearance, owner, storey.height)


def _boxes(world: World) -> tuple[Array, Array, Array]:
    """Centres, half extents and turns of the solids, with the leaves of doors that are shut standing open."""
    solids = world.solids
    centre, half, yaw = solids.centre, solids.half, solids.yaw
    for item in world.objects:
        if item.hinge is None or not item.hinge.way or item.ajar >= STANDS_OPEN:
            continue
        rows = np.flatnonzero(solids.object == item.id)
        if len(rows):
            centre, half, yaw = centre.copy(), half.copy(), yaw.copy()
            centre[rows], half[rows], yaw[rows] = item.hinge.solids(1.0)
    return centre, half, yaw


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
