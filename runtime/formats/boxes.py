"""Upright boxes and floors that stand in for a model's triangles.

A model is looked at in columns over a grid: each column is solid from the lowest to the highest surface in
it, so that what is hollow is solid, and what one can pass under is not.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .model import Array

#: Surfaces this level, and this near the floor's height, are floor (cosine; metres).
LEVEL, NEAR_FLOOR = 0.94, 0.06
_MOST_SAMPLES = 2_000_000

Rect = tuple[float, float, float, float]


def surface_points(vertices: Array, faces: NDArray[np.integer], spacing: float) -> tuple[Array, Array]:
    """Points [N, 3] all over the triangles, no further apart than ``spacing`` (about), and their faces' unit
    normals [N, 3]."""
    corner = vertices[faces]
    edge = np.linalg.norm(corner - np.roll(corner, 1, axis=1), axis=2).max(1)
    count = np.clip(np.ceil(edge / spacing), 1, 200).astype(np.int64)
    while ((count + 1) * (count + 2) // 2).sum() > _MOST_SAMPLES and count.max() > 1:
        count = np.maximum(count // 2, 1)
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-20)
    points, normals = [], []
    for n in np.unique(count):
        own = count == n
        i, j = np.meshgrid(np.arange(n + 1), np.arange(n + 1), indexing="ij")
        keep = i + j <= n
        shares = np.stack([i[keep], j[keep], n - i[keep] - j[keep]], 1) / n
        points.append(np.einsum("sk,fkc->fsc", shares, corner[own]).reshape(-1, 3))
        normals.append(np.repeat(normal[own], len(shares), axis=0))
    return np.concatenate(points), np.concatenate(normals)


def column_boxes(
    vertices: Array, faces: NDArray[np.integer], cell: float, most: int, above: float = -np.inf
) -> list[tuple[Array, Array]]:
    """At most ``most`` boxes (low [3], high [3]) around the columns; nothing below ``above`` counts."""
    if not len(faces):
        return []
    while True:
        points, _ = surface_points(vertices, faces, 0.6 * cell)
        points = points[points[:, 2] > above]
        if not len(points):
            return []
        boxes = _boxes(points, cell)
        if len(boxes) <= most:
            return boxes
        cell *= 1.4


def _boxes(points: Array, cell: float) -> list[tuple[Array, Array]]:
    origin = points[:, :2].min(0)
    ij = np.floor((points[:, :2] - origin) / cell + 1e-9).astype(np.int64)
    shape = ij.max(0) + 1
    flat = ij[:, 0] * shape[1] + ij[:, 1]
    low, high = np.full(shape.prod(), np.inf), np.full(shape.prod(), -np.inf)
    np.minimum.at(low, flat, points[:, 2])
    np.maximum.at(high, flat, points[:, 2])
    used = np.isfinite(low)
    step = max(float(np.ptp(points[:, 2])) / 10.0, 0.03)
    key = np.full(len(low), -1, np.int64)
    key[used] = 1000 * np.floor(low[used] / step).astype(np.int64) + np.ceil(high[used] / step).astype(
        np.int64
    )
    key[used] -= key[used].min()
    top = points[:, :2].max(0)
    out = []
    for i0, j0, i1, j1 in rectangles(key.reshape(shape)):
        inside = np.ix_(range(i0, i1), range(j0, j1))
        x0, y0 = origin + np.array([i0, j0]) * cell
        x1, y1 = np.minimum(origin + np.array([i1, j1]) * cell, top)
        z0, z1 = low.reshape(shape)[inside].min(), high.reshape(shape)[inside].max()
        out.append((np.array([x0, y0, z0]), np.array([x1, y1, z1])))
    return out


def rectangles(key: NDArray[np.int64]) -> list[tuple[int, int, int, int]]:
    """Rectangles (i0, j0, i1, j1) of equal keys that cover all cells whose key is not below 0."""
    free = key >= 0
    out = []
    for i in range(key.shape[0]):
        for j in range(key.shape[1]):
            if not free[i, j]:
                continue
            same = free & (key == key[i, j])
            j1 = j + 1
            while j1 < key.shape[1] and same[i, j1]:
                j1 += 1
            i1 = i + 1
            while i1 < key.shape[0] and same[i1, j:j1].all():
                i1 += 1
            free[i:i1, j:j1] = False
            out.append((i, j, i1, j1))
    return out


def floor_height(points: Array, normals: Array) -> float | None:
    """The height of the ground: the lowest level surface of some size; None where nothing is level."""
    level = points[normals[:, 2] > LEVEL, 2]
    if len(level) < 3:
        return None
    step = 0.05
    count = np.bincount(np.floor((level - level.min()) / step).astype(np.int64))
    band = int(np.flatnonzero(count >= 0.35 * count.max())[0])
    inside = np.abs(level - level.min() - (band + 0.5) * step) <= step
    return float(np.median(level[inside]))


def floors(points: Array, normals: Array, cell: float = 0.25, most: int = 60) -> list[Rect]:
    """Rectangles (x0, y0, x1, y1) of the ground at height 0, at most ``most``."""
    on = points[(normals[:, 2] > LEVEL) & (np.abs(points[:, 2]) < NEAR_FLOOR), :2]
    if not len(on):
        return []
    low, high = on.min(0), on.max(0)
    while True:
        ij = np.floor((on - low) / cell + 1e-6).astype(np.int64)
        key = np.full(ij.max(0) + 1, -1, np.int64)
        key[ij[:, 0], ij[:, 1]] = 0
        found = rectangles(key)
        if len(found) <= most:
            break
        cell *= 1.5
    return [
        (
            *(low + np.array([i0, j0]) * cell).tolist(),
            *np.minimum(low + np.array([i1, j1]) * cell, high).tolist(),
        )
        for i0, j0, i1, j1 in found
    ]
