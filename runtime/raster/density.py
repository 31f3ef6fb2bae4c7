"""How much opaque surface of a set there is where: what ambient occlusion and reflected light are made of.

Triangles are cut into small ones, and the area of each goes to the eight cells around its middle. Assumes
metres. Guarantees the same bits whether numpy adds up, or a kernel does on the processor's threads.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..mesh import MATERIALS, Mesh
from .bake import REACH, Volume, stage_bounds

CELLS = 500_000  # most cells of a volume
CELL = 0.07  # metres, finest cell
_SPACING = 0.7  # of a cell, between the middles of small triangles
_MOST = 400  # pieces a side of a triangle is cut into at most


@dataclass(frozen=True, eq=False)
class _Cut:
    """Triangles to be cut, in the order in which they are added up.

    corner: float64 [F, 3, 3], a corner of each and the edges from it; area: float64 [F], of each small one
    steps: int32 [F], pieces of a side
    """

    corner: NDArray[np.float64]
    area: NDArray[np.float64]
    steps: NDArray[np.int32]


@dataclass(frozen=True, eq=False)
class _Grid:
    """Cells between two corners of a box, metres."""

    low: NDArray[np.float64]
    high: NDArray[np.float64]
    cell: float
    shape: tuple[int, int, int]


def density_volume(mesh: Mesh, casters: NDArray[np.int32], on_host: bool = False) -> Volume:
    """How much opaque surface of a static mesh there is, square metres in a cubic metre.

    on_host: whether kernels run on this processor, so that one can do it: several times as fast as numpy
    """
    if not len(mesh.faces):
        return Volume(np.zeros((2, 2, 2), np.float32), np.zeros(3), 1.0)
    solid = ~np.isin(mesh.materials, [MATERIALS.index("glass"), MATERIALS.index("glow")])
    corners = mesh.vertices[mesh.faces[solid]].astype(np.float64)
    margin = 2.5 * REACH
    low, high = stage_bounds(mesh, casters)
    low, high = low - margin, high + margin
    cell = max(CELL, float((np.prod(high - low) / CELLS) ** (1 / 3)))
    nx, ny, nz = (int(n) for n in np.ceil((high - low) / cell).astype(int) + 2)
    inside = ((corners.max(axis=1) > low) & (corners.min(axis=1) < high)).all(axis=1)
    cut, grid = _cut(corners[inside], cell * _SPACING), _Grid(low, high, cell, (nx, ny, nz))
    values = _by_kernel(cut, grid) if on_host and len(cut.steps) else _by_numpy(cut, grid)
    return Volume((values.reshape(grid.shape) / cell**3).astype(np.float32), low, cell)


def _cut(corners: NDArray[np.float64], spacing: float) -> _Cut:
    """How triangles [F, 3, 3] are cut so that the middles are about ``spacing`` apart."""
    a, u, v = corners[:, 0], corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    area = np.linalg.norm(np.cross(u, v), axis=1) / 2
    longest = np.linalg.norm(np.stack([u, v, u - v]), axis=2).max(axis=0)
    steps = np.clip(np.ceil(longest / spacing), 1, _MOST).astype(np.int32)
    order = np.argsort(steps, kind="stable")
    corner = np.stack([a, u, v], axis=1)[order]
    return _Cut(corner, (area / steps.astype(int) ** 2)[order], steps[order])


def _by_kernel(cut: _Cut, grid: _Grid) -> NDArray[np.float64]:
    from .kernels import density  # only now: it imports taichi

    cells = int(np.prod(grid.shape))
    corners = np.zeros(8 * cells)
    bounds = (1 / 3, grid.low, grid.high, grid.cell, *grid.shape)
    density.spread(cut.corner, cut.area, cut.steps, len(cut.steps), *bounds, corners)
    values = np.zeros(cells)
    for part in corners.reshape(8, cells):
        values += part
    return values


def _by_numpy(cut: _Cut, grid: _Grid) -> NDArray[np.float64]:
    points, areas = _middles(cut)
    within = ((points > grid.low) & (points < grid.high)).all(axis=1)
    points, areas = points[within], areas[within]
    where = (points - grid.low) / grid.cell
    base = np.floor(where).astype(np.int64)
    part = where - base
    weights = [(1 - part[:, a], part[:, a]) for a in range(3)]
    strides = (grid.shape[1] * grid.shape[2], grid.shape[2], 1)
    first = base @ np.array(strides)
    values = np.zeros(int(np.prod(grid.shape)))
    for i, j, k in np.ndindex(2, 2, 2):
        share = weights[0][i] * weights[1][j] * weights[2][k]
        index = first + (i * strides[0] + j * strides[1] + k)
        values += np.bincount(index, weights=share * areas, minlength=len(values))
    return values


def _middles(cut: _Cut) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The middles [N, 3] of all small triangles, and the area of each."""
    points, areas = [np.zeros((0, 3))], [np.zeros(0)]
    for n in np.unique(cut.steps):
        chosen = cut.steps == n
        a, u, v = (cut.corner[chosen, None, k] for k in range(3))
        i, j = np.meshgrid(np.arange(n), np.arange(n), indexing="ij")
        upright = i + j < n
        turned = i + j < n - 1
        s = np.concatenate([(i[upright] + 1 / 3) / n, (i[turned] + 2 / 3) / n])
        t = np.concatenate([(j[upright] + 1 / 3) / n, (j[turned] + 2 / 3) / n])
        points.append((a + s[:, None] * u + t[:, None] * v).reshape(-1, 3))
        areas.append(np.repeat(cut.area[chosen], n * n))
    return np.concatenate(points), np.concatenate(areas)
