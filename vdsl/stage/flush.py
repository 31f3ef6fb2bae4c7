"""Surfaces in one plane, told apart: of two that are flush the later one lies over the earlier.

Where solids that are put together end in one plane, the depth of both is the same but for rounding, and which
of them a pixel shows would be left to chance, another one in the next frame. So the earlier one is sunk by a
hair. Nothing is ever raised: the whole stays as large as it is.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from runtime.mesh import Mesh
from runtime.rows import unique_rows

#: Metres that a surface is sunk below the one over it: less than half a pixel wherever one looks, and several
#: times what rounding comes to at the far end of a set.
HAIR = 0.0004
#: Square metres; what is common to two surfaces and smaller is no surface.
_LEAST = 1e-5
_FLUSH = 0.00015  # metres that planes may be apart
_ALIKE = 0.003  # between the normals of planes that are one
_FAR = 0.1  # share of a distance that is told from that of another plane: 3 cm for normals' 0.003
_SAME_PLACE = 1e-5  # metres
_THINNER = 0.2  # share of a solid's thickness that it may be sunk by

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class _Facets:
    """Faces of one solid in one plane. face: int [N], which facet each face of ``corners`` is of;

    corners: float64 [N, 3, 3]; solid: int [K], which mesh; normal: float64 [K, 3]; low, high: float64 [K, 3];
    look: int [K], the same where no difference would be seen
    """

    face: NDArray[np.int64]
    corners: Floats
    solid: NDArray[np.int64]
    normal: Floats
    low: Floats
    high: Floats
    look: NDArray[np.int64]


def told_apart(meshes: list[Mesh]) -> list[Mesh]:
    """The meshes, what is flush with a later one sunk below it; the others are passed on as they are."""
    facets, vertices = _facets(meshes)
    pairs = _flush_pairs(facets)
    if not len(pairs):
        return meshes
    depth = np.zeros(len(facets.solid), np.int64)
    for below, above in sorted(pairs.tolist(), key=lambda pair: (-pair[0], pair[1])):
        depth[below] = max(depth[below], depth[above] + 1)
    out = list(meshes)
    for k in np.unique(facets.solid[depth > 0]).tolist():
        out[k] = _sunk(meshes[k], vertices[k], facets, depth, k)
    return out


def _facets(meshes: list[Mesh]) -> tuple[_Facets, list[NDArray[np.int64]]]:
    """All facets, those of earlier meshes first; and of each mesh which facet a face is of, -1 for none."""
    corners = [mesh.vertices[mesh.faces].astype(np.float64) for mesh in meshes]
    solid = np.repeat(np.arange(len(meshes)), [len(c) for c in corners])
    every = np.concatenate([np.zeros((0, 3, 3)), *corners])
    normal = np.cross(every[:, 1] - every[:, 0], every[:, 2] - every[:, 0])
    area = np.linalg.norm(normal, axis=1)
    real = area > 2e-8
    normal = normal / np.maximum(area, 1e-12)[:, None]
    away = (normal * every.mean(1)).sum(1)
    keys = np.concatenate([solid[:, None], np.round(normal * 500), np.round(away * 1000)[:, None]], 1)
    _, first, facet = unique_rows(keys[real])
    count, where = len(first), np.nonzero(real)[0]
    low, high = np.full((count, 3), np.inf), np.full((count, 3), -np.inf)
    np.minimum.at(low, facet, every[real].min(1))
    np.maximum.at(high, facet, every[real].max(1))
    looks = np.concatenate(
        [
            np.zeros((0, 5), np.int64),
            *(
                np.concatenate([np.round(m.colors * 255), m.parts[:, None], m.materials[:, None]], 1)
                for m in meshes
            ),
        ]
    )
    look = unique_rows(looks[where[first]])[2]
    of_face = np.full(len(every), -1)
    of_face[where] = facet
    ends = np.cumsum([len(c) for c in corners])[:-1]
    facets = _Facets(facet, every[real], solid[where[first]], normal[where[first]], low, high, look)
    return facets, np.split(of_face, ends)


def _flush_pairs(facets: _Facets) -> NDArray[np.int64]:
    """Pairs [P, 2] of facets of different meshes that are flush somewhere, the earlier mesh's first."""
    away = (facets.normal * (facets.low + facets.high) / 2).sum(1)
    places = np.concatenate([facets.normal, _FAR * away[:, None]], 1)
    if len(places) < 2:
        return np.zeros((0, 2), np.int64)
    near = cKDTree(places).query_pairs(_ALIKE, output_type="ndarray")
    low, high = np.maximum(*facets.low[near.T]), np.minimum(*facets.high[near.T])
    common = np.sort(high - low, axis=1)  # of flush ones the least is 0, and the others are sides
    a, b = near.T
    told = (facets.solid[a] != facets.solid[b]) & (facets.look[a] != facets.look[b])
    near = near[told & (common[:, 0] > -_FLUSH) & (common[:, 1] * common[:, 2] > _LEAST)]
    near = np.where(facets.solid[near[:, :1]] > facets.solid[near[:, 1:]], near[:, ::-1], near)
    order = np.argsort(facets.face, kind="stable")
    starts = np.searchsorted(facets.face[order], np.arange(len(facets.solid) + 1))
    flush = [
        _are_flush(
            facets.corners[order[starts[a] : starts[a + 1]]],
            facets.corners[order[starts[b] : starts[b + 1]]],
            facets.normal[a],
        )
        for a, b in near.tolist()
    ]
    return near[np.array(flush, bool)] if len(near) else near


def _are_flush(ours: Floats, theirs: Floats, normal: Floats) -> bool:
    """Whether triangles [N, 3, 3] and [M, 3, 3] of two planes of one normal lie in each other somewhere."""
    least = int(np.argmin(np.abs(normal)))
    side = np.cross(normal, np.eye(3)[least])
    side /= np.linalg.norm(side)
    flat = np.stack([side, np.cross(normal, side)], 1)
    a, b = ours @ flat, theirs @ flat
    low = np.maximum(a.min(1)[:, None], b.min(1)[None])
    high = np.minimum(a.max(1)[:, None], b.max(1)[None])
    for i, j in np.argwhere((high - low > 0).all(-1)).tolist():
        area, middle = _common(a[i], b[j])
        if area > _LEAST:
            at = ours[i, 0] + flat @ (middle - a[i, 0])
            if abs(float((theirs[j, 0] - at) @ normal)) < _FLUSH:
                return True
    return False


def _common(a: Floats, b: Floats) -> tuple[float, Floats]:
    """Area and middle of what two triangles [3, 2], both counter-clockwise, have in common."""
    shape = a.tolist()
    for k in range(3):
        (x0, y0), (x1, y1) = b[k].tolist(), b[(k + 1) % 3].tolist()
        inside = [(x1 - x0) * (y - y0) - (y1 - y0) * (x - x0) for x, y in shape]
        cut = []
        for i, (x, y) in enumerate(shape):
            if inside[i] >= 0:
                cut.append((x, y))
            j = (i + 1) % len(shape)
            if (inside[i] >= 0) != (inside[j] >= 0):
                t = inside[i] / (inside[i] - inside[j])
                cut.append((x + t * (shape[j][0] - x), y + t * (shape[j][1] - y)))
        shape = cut
        if len(shape) < 3:
            return 0.0, np.zeros(2)
    points = np.array(shape)
    x, y = points.T
    area = float((x * np.roll(y, -1) - np.roll(x, -1) * y).sum()) / 2
    return area, points.mean(0)


def _sunk(
    mesh: Mesh, of_face: NDArray[np.int64], facets: _Facets, depth: NDArray[np.int64], solid: int
) -> Mesh:
    """The mesh with its facets as many hairs deep as they lie under others, vertices that meet together."""
    place = unique_rows(np.round(mesh.vertices / _SAME_PLACE).astype(np.int64))[2]
    by_place = np.zeros((int(place.max()) + 1, 3))
    size = mesh.vertices.max(0).astype(float) - mesh.vertices.min(0)
    for facet in np.nonzero((facets.solid == solid) & (depth > 0))[0].tolist():
        normal = facets.normal[facet]
        thick = float(np.abs(normal) @ size)
        by = min(HAIR * depth[facet], _THINNER * thick) if thick > _SAME_PLACE else HAIR * depth[facet]
        there = np.unique(place[mesh.faces[of_face == facet]])
        # what was sunk with another facet of about this normal is that deep already
        by_place[there] -= np.maximum(by + by_place[there] @ normal, 0.0)[:, None] * normal
    vertices = (mesh.vertices + by_place[place]).astype(np.float32)
    return replace(mesh, vertices=vertices)
