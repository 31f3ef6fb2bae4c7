"""Surfaces in one plane, told apart: of two that are flush the later one lies over the earlier.

Where solids that are put together end in one plane, the depth of both is the same but for rounding, and which
of them a pixel shows would be left to chance, another one in the next frame. So the earlier one is sunk by a
hair. Nothing is ever raised: the whole stays as large as it is.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from runtime.mesh import Mesh
from runtime.rows import unique_rows

#: Metres that a surface is sunk below the one over it: less than a pixel but in the closest of close-ups, and
#: several times what rounding comes to at the far end of a set.
HAIR = 0.0004
#: Square metres; what is common to two surfaces and smaller is no surface.
_LEAST = 1e-5
_FLUSH = 0.00015  # metres that planes may be apart
_ALIKE = 0.003  # between the normals of planes that are one
_FAR = 0.1  # share of a distance that is told from that of another plane: 3 cm for normals' 0.003
_SAME_PLACE = 1e-5  # metres
#: Facets of a solid, and faces of a facet, that are still compared with others; and how many pairs are looked
#: at in all.
_MOST, _PAIRS = 4000, 1_000_000
_FEW, _BLOCK = 64, 65536  # pairs of triangles that are looked at one by one; that are compared at once
_THINNER = 0.2  # share of a solid's thickness that it may be sunk by

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class _Facets:
    """Facets: faces of one solid in one plane.

    face: int [N], which facet each face of ``corners`` is of; corners: float64 [N, 3, 3]
    solid: int [K], which mesh; normal, away: float64 [K, 3] and [K], the plane; low, high: float64 [K, 3]
    look: int [K], the same where no difference would be seen
    """

    face: NDArray[np.int64]
    corners: Floats
    solid: NDArray[np.int64]
    normal: Floats
    away: Floats
    low: Floats
    high: Floats
    look: NDArray[np.int64]


def told_apart(meshes: list[Mesh], hair: float = HAIR) -> list[Mesh]:
    """The meshes, what is flush with a later one sunk below it by ``hair`` metres or, where it is thin, less;
    the others are passed on as they are."""
    if len(meshes) < 2:
        return meshes
    facets, of_face = _facets(meshes)
    pairs = _flush_pairs(facets)
    if not len(pairs):
        return meshes
    depth = np.zeros(len(facets.solid), np.int64)
    for below, above in sorted(pairs.tolist(), key=lambda pair: (-pair[0], pair[1])):
        depth[below] = max(depth[below], depth[above] + 1)
    out = list(meshes)
    for k in np.unique(facets.solid[depth > 0]).tolist():
        out[k] = _sunk(meshes[k], of_face[k], facets, depth, k, hair)
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
    of_look = unique_rows(looks[where])[2]
    look, mixed = of_look[first], np.zeros(count, bool)
    mixed[facet[of_look != look[facet]]] = True
    look = np.where(mixed, -1 - np.arange(count), look)  # of several looks: like no other one
    of_face = np.full(len(every), -1)
    of_face[where] = facet
    ends = np.cumsum([len(c) for c in corners])[:-1]
    chosen = where[first]
    facets = _Facets(facet, every[real], solid[chosen], normal[chosen], away[chosen], low, high, look)
    return facets, np.split(of_face, ends)


def _flush_pairs(facets: _Facets) -> NDArray[np.int64]:
    """Pairs [P, 2] of facets of different meshes that are flush somewhere, the earlier mesh's first."""
    near = _of_one_plane(facets)
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
            facets.normal[b],
        )
        for a, b in near.tolist()
    ]
    return near[np.array(flush, bool)] if len(near) else near


def _of_one_plane(facets: _Facets) -> NDArray[np.int64]:
    """Pairs [P, 2] of facets whose planes are about one. Left out are solids of many facets and facets of
    many faces, the sooner the more pairs there would be: scans and landscapes, nearly flat everywhere."""
    sizes = np.bincount(facets.solid)[facets.solid]
    sizes = np.maximum(sizes, np.bincount(facets.face, minlength=len(facets.solid)))
    places = np.concatenate([facets.normal, _FAR * facets.away[:, None]], 1)
    for most in (_MOST, _MOST // 8, _MOST // 64):
        few = np.flatnonzero(sizes <= most)
        if not len(few):
            break
        tree = cKDTree(places[few])
        if tree.count_neighbors(tree, _ALIKE) - len(few) <= 2 * _PAIRS:
            return few[tree.query_pairs(_ALIKE, output_type="ndarray")]
    return np.zeros((0, 2), np.int64)


def _are_flush(ours: Floats, theirs: Floats, normal: Floats, other: Floats) -> bool:
    """Whether triangles [N, 3, 3] and [M, 3, 3] of two planes lie in each other somewhere. normal, other: of
    the planes, which are about the same. In plain numbers: mostly they are a few triangles."""
    axis = int(np.argmax(np.abs(normal)))
    u, v = ((1, 2), (2, 0), (0, 1))[axis] if normal[axis] > 0 else ((2, 1), (0, 2), (1, 0))[axis]
    flat = [u, v]
    least = _LEAST * abs(float(normal[axis]))  # as it looks along that axis
    a, b = ours[..., flat].tolist(), theirs[..., flat].tolist()
    for i, j in _overlapping(ours[..., flat], theirs[..., flat]):
        area, x, y = _common(a[i], b[j])
        if area > least:
            axes = (u, v, axis)
            up = _height(x, y, ours[i, 0], normal, axes) - _height(x, y, theirs[j, 0], other, axes)
            if abs(up * float(normal[axis])) < _FLUSH:
                return True
    return False


def _overlapping(ours: Floats, theirs: Floats) -> Iterator[tuple[int, int]]:
    """Pairs of triangles [N, 3, 2] and [M, 3, 2] that may overlap, a block of them at a time."""
    block = max(_BLOCK // len(theirs), 1)
    for begin in range(0, len(ours), block):
        some = ours[begin : begin + block]
        if len(some) * len(theirs) <= _FEW:
            yield from ((begin + i, j) for i in range(len(some)) for j in range(len(theirs)))
            continue
        low = np.maximum(some.min(1)[:, None], theirs.min(1)[None])
        high = np.minimum(some.max(1)[:, None], theirs.max(1)[None])
        yield from ((begin + i, j) for i, j in np.argwhere((high - low > 0).all(-1)).tolist())


def _height(x: float, y: float, point: Floats, normal: Floats, axes: tuple[int, int, int]) -> float:
    """How far along the last axis a plane lies where the other two are x and y."""
    u, v, w = axes
    beside = normal[u] * (x - point[u]) + normal[v] * (y - point[v])
    return float(point[w] - beside / normal[w])


def _common(a: list[list[float]], b: list[list[float]]) -> tuple[float, float, float]:
    """Area of what two triangles of corners (x, y), both counter-clockwise, share, and the middle of it."""
    shape = a
    for k in range(3):
        (x0, y0), (x1, y1) = b[k - 1], b[k]
        inside = [(x1 - x0) * (y - y0) - (y1 - y0) * (x - x0) for x, y in shape]
        if min(inside) >= 0:
            continue
        if max(inside) <= 0:
            return 0.0, 0.0, 0.0
        cut = []
        for i, (x, y) in enumerate(shape):
            before, here = inside[i - 1], inside[i]
            if (before >= 0) != (here >= 0):
                t = before / (before - here)
                x_before, y_before = shape[i - 1]
                cut.append([x_before + t * (x - x_before), y_before + t * (y - y_before)])
            if here >= 0:
                cut.append([x, y])
        shape = cut
    double = sum(shape[i - 1][0] * y - shape[i - 1][1] * x for i, (x, y) in enumerate(shape))
    return double / 2, sum(x for x, _ in shape) / len(shape), sum(y for _, y in shape) / len(shape)


def _sunk(
    mesh: Mesh,
    of_face: NDArray[np.int64],
    facets: _Facets,
    depth: NDArray[np.int64],
    solid: int,
    hair: float,
) -> Mesh:
    """The mesh with its facets as many hairs deep as they lie under others, vertices that meet together."""
    place = unique_rows(np.round(mesh.vertices / _SAME_PLACE).astype(np.int64))[2]
    by_place = np.zeros((int(place.max()) + 1, 3))
    size = mesh.vertices.max(0).astype(float) - mesh.vertices.min(0)
    for facet in np.nonzero((facets.solid == solid) & (depth > 0))[0].tolist():
        normal = facets.normal[facet]
        thick = float(np.abs(normal) @ size)
        each = min(hair, _THINNER * thick / int(depth.max())) if thick > _SAME_PLACE else hair
        by = each * int(depth[facet])
        there = np.unique(place[mesh.faces[of_face == facet]])
        # what was sunk with another facet of about this normal is that deep already; the back of a sheet of
        # no thickness, that went down with its front, is left there
        raised = by_place[there] @ normal
        by_place[there] -= np.where(raised > 0, 0.0, np.maximum(by + raised, 0.0))[:, None] * normal
    vertices = (mesh.vertices + by_place[place]).astype(np.float32)
    return replace(mesh, vertices=vertices)
