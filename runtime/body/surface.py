"""From fields to triangles: narrow-band marching cubes, simplification, exact cuts, rims, mirroring.

A :class:`Patch` is a piece of surface on its way into the body: vertices and faces only.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import fast_simplification
import numpy as np
from numpy.typing import ArrayLike, NDArray
from skimage.measure import marching_cubes

from ..rows import unique_rows
from .field import Field, Points, Values, gradient

Faces = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Patch:
    """vertices: float64 [V, 3], metres; faces: int64 [F, 3], counter-clockwise seen from outside."""

    vertices: Points
    faces: Faces


def polygonise(field: Field, low: ArrayLike, high: ArrayLike, step: float) -> Patch:
    """The zero surface of a field inside a box, by marching cubes on a grid of ``step`` metres.

    Fine values are taken only near the surface, found on grids four times and twice as coarse: parts
    thinner than about two steps may be missed. Vertices lie on the grid's edges, by linear interpolation.
    """
    lo, hi = np.asarray(low, float), np.asarray(high, float)
    blocks = np.maximum(np.ceil((hi - lo) / (4 * step)).astype(int), 1)
    axes = [lo[i] + 4 * step * (np.arange(blocks[i]) + 0.5) for i in range(3)]
    centres = np.stack(np.meshgrid(*axes, indexing="ij"), -1).reshape(-1, 3)
    coarse = field(centres)
    near = np.flatnonzero(np.abs(coarse) < 4.4 * step)
    values = np.repeat(np.where(coarse > 0, step, -step), 64).reshape(-1, 4, 4, 4)
    values[near] = _refined(field, centres[near], step)
    volume = values.reshape(*blocks, 4, 4, 4)
    volume = volume.transpose(0, 3, 1, 4, 2, 5).reshape(*(blocks * 4))
    volume = np.pad(volume, 1, constant_values=step)
    if not (volume < 0).any():
        return Patch(np.zeros((0, 3)), np.zeros((0, 3), np.int64))
    vertices, faces, _, _ = marching_cubes(volume.astype(np.float32), 0.0, spacing=(step,) * 3)
    vertices = vertices.astype(np.float64) + (lo + 0.5 * step - step)
    return Patch(vertices, faces.astype(np.int64))


def _refined(field: Field, centres: Points, step: float) -> NDArray[np.float64]:
    """Values [N, 4, 4, 4] around the centres of blocks; far from the surface only their sign is right."""
    corner = np.stack(np.meshgrid(*[(-1.0, 1.0)] * 3, indexing="ij"), -1).reshape(-1, 3)
    middles = (centres[:, None] + corner * step).reshape(-1, 3)
    rough = field(middles)
    near = np.flatnonzero(np.abs(rough) < 2.6 * step)
    values = np.repeat(np.where(rough > 0, step, -step), 8).reshape(-1, 8)
    values[near] = field((middles[near, None] + corner * (0.5 * step)).reshape(-1, 3)).reshape(-1, 8)
    return values.reshape(-1, 2, 2, 2, 2, 2, 2).transpose(0, 1, 4, 2, 5, 3, 6).reshape(-1, 4, 4, 4)


def settle(field: Field, vertices: Points, reach: float) -> Points:
    """Points moved onto the zero surface, by at most ``reach`` metres."""
    slope = gradient(field, vertices)
    length2 = np.maximum((slope * slope).sum(1), 0.05)
    move = -(field(vertices) / length2)[:, None] * slope
    size = np.linalg.norm(move, axis=1, keepdims=True)
    return vertices + move * np.minimum(1.0, reach / np.maximum(size, 1e-9))


@dataclass(frozen=True)
class Focus:
    """A ball in which simplification keeps more detail: space there counts as ``factor`` times as large."""

    centre: tuple[float, float, float]
    radius: float
    factor: float = 2.5

    def _radii(self) -> tuple[Values, Values]:
        r = self.radius * np.linspace(0.0, 7.0, 500) ** 2
        return r, r * (1.0 + (self.factor - 1.0) / (1.0 + (r / self.radius) ** 2))

    def warp(self, points: Points, inverse: bool = False) -> Points:
        plain, wide = self._radii()
        d = points - np.array(self.centre)
        r = np.linalg.norm(d, axis=1) + 1e-12
        to = np.interp(r, wide, plain, right=np.inf) if inverse else np.interp(r, plain, wide, right=np.inf)
        factor = np.where(np.isfinite(to), to / r, 1.0)
        return np.array(self.centre) + d * factor[:, None]


@dataclass(frozen=True)
class Bend:
    """Where a straight limb is going to bend: it counts as ringed there, so that simplification leaves rings.

    Of a straight tube nothing would be left between its ends, and long triangles make a ragged elbow.
    centre: of the joint; axis: unit, along the limb; reach: metres to either side of the joint that bend;
    wide: metres from the axis within which all is limb; bulge: of the rings, metres, at most a fifth of that
    """

    centre: tuple[float, float, float]
    axis: tuple[float, float, float]
    reach: float
    wide: float
    bulge: float

    def warp(self, points: Points, inverse: bool = False) -> Points:
        axis = np.array(self.axis)
        d = points - np.array(self.centre)
        along = d @ axis
        across = d - along[:, None] * axis
        radius = np.linalg.norm(across, axis=1)
        rings = np.cos(np.clip(along / self.reach, -1.0, 1.0) * 1.5 * np.pi) ** 2 * self.bulge
        out = radius + rings * self._share(radius)
        if inverse:
            out = radius
            for _ in range(24):  # a contraction
                out = radius - rings * self._share(out)
        return (
            np.array(self.centre) + along[:, None] * axis + across * (out / np.maximum(radius, 1e-9))[:, None]
        )

    def _share(self, radius: Values) -> Values:
        """1 within the limb, falling to 0 at its border."""
        t = np.clip((self.wide - radius) / (0.4 * self.wide), 0.0, 1.0)
        return t * t * (3.0 - 2.0 * t)


def simplify(
    patch: Patch, faces: int, field: Field | None = None, focus: Sequence[Focus | Bend] = ()
) -> Patch:
    """At most about ``faces`` triangles by quadric error; settled on ``field`` again where given."""
    if len(patch.faces) <= faces:
        return patch
    before = patch.vertices
    for each in focus:
        before = each.warp(before)
    vertices, out = fast_simplification.simplify(
        before.astype(np.float32), patch.faces.astype(np.int32), target_count=faces, agg=7
    )
    points = vertices.astype(np.float64)
    for each in reversed(focus):
        points = each.warp(points, inverse=True)
    if field is not None:
        points = settle(field, points, 4e-3)
    return Patch(points, out.astype(np.int64))


def clip(patch: Patch, cut: Field, keep_outside: bool = False) -> Patch:
    """The part where ``cut`` is negative; triangles across the border are split exactly along it."""
    inside, outside = split(patch, cut)
    return outside if keep_outside else inside


def split(patch: Patch, cut: Field) -> tuple[Patch, Patch]:
    """The parts of a patch where ``cut`` is negative and positive.

    Border points are found on the edges by a secant step and are shared by both parts' geometry, so
    nothing opens between them.
    """
    values = _off_zero(cut(patch.vertices))
    edges, position = _border(patch, cut, values)
    vertices = np.concatenate([patch.vertices, position])
    n = len(patch.vertices)
    keys = edges[:, 0] * n + edges[:, 1]

    def between(p: NDArray[np.int64], q: NDArray[np.int64]) -> NDArray[np.int64]:
        return n + np.searchsorted(keys, np.minimum(p, q) * n + np.maximum(p, q))

    negative = (values < 0)[patch.faces]
    count = negative.sum(1)
    parts = {True: [patch.faces[count == 3]], False: [patch.faces[count == 0]]}
    for number, lone in ((1, True), (2, False)):  # one corner inside, or one outside
        faces = patch.faces[count == number]
        at = np.argmax(negative[count == number] == lone, axis=1)
        a, b, c = (np.take_along_axis(faces, (at[:, None] + k) % 3, 1)[:, 0] for k in range(3))
        ab, ac = between(a, b), between(a, c)
        parts[lone].append(np.stack([a, ab, ac], 1))
        parts[not lone] += [np.stack([ab, b, c], 1), np.stack([ab, c, ac], 1)]
    inside, outside = (Patch(vertices, np.concatenate(parts[side])) for side in (True, False))
    return compact(inside), compact(outside)


def cut_out(patch: Patch, region: Field, lines: list[Field]) -> tuple[Patch, Patch]:
    """What lies in a region and inside every one of ``lines``, and a patch without it.

    Cut one smooth line after the other, and no further than the region, it may be smaller than the triangles:
    of those that have no corner in it a single cut would see nothing.
    """
    rest, outside = split(patch, region)
    parts = [outside]
    for line in lines:
        rest, outside = split(rest, line)
        parts.append(outside)
    return rest, welded(parts)


def welded(parts: list[Patch]) -> Patch:
    """Patches as one: vertices are shared where they are at the same place, and where one lies on an edge of
    another triangle, that is divided there, so that nothing shows between them."""
    counts = np.cumsum([0, *(len(part.vertices) for part in parts)])
    vertices = np.concatenate([part.vertices for part in parts])
    faces = np.concatenate([part.faces + n for part, n in zip(parts, counts[:-1], strict=True)])
    _, first, index = unique_rows(vertices)
    joined = Patch(vertices[first], index[faces])
    edges = boundary(joined)
    loose = np.unique(edges)
    on = {(p, q): found for p, q in edges.tolist() if len(found := _between(joined.vertices, (p, q), loose))}
    divided = [part for face in joined.faces.tolist() for part in _divided(tuple(face), on)]
    return compact(Patch(joined.vertices, np.array(divided, np.int64)))


def _divided(
    face: tuple[int, int, int], on: dict[tuple[int, int], NDArray[np.int64]]
) -> list[tuple[int, int, int]]:
    """A triangle in parts, by the vertices that lie on its edges."""
    a, b, c = face
    for p, q, r in ((a, b, c), (b, c, a), (c, a, b)):
        if (p, q) in on:
            way = [p, *on[p, q].tolist(), q]
            return [part for s, t in pairwise(way) for part in _divided((s, t, r), on)]
    return [face]


def _between(vertices: Points, edge: tuple[int, int], others: NDArray[np.int64]) -> NDArray[np.int64]:
    """Those of some vertices that lie on an edge, on the way from its start to its end."""
    start, way = vertices[edge[0]], vertices[edge[1]] - vertices[edge[0]]
    away = vertices[others] - start
    along = away @ way / max(float(way @ way), 1e-18)
    off = np.linalg.norm(away - along[:, None] * way, axis=1)
    found = (off < 1e-6) & (along > 1e-6) & (along < 1.0 - 1e-6)
    return others[found][np.argsort(along[found])]


def _off_zero(values: Values) -> Values:
    return np.where(np.abs(values) < 2e-4, np.where(values < 0, -2e-4, 2e-4), values)


def _border(patch: Patch, cut: Field, values: Values) -> tuple[NDArray[np.int64], Points]:
    p, q = patch.faces, np.roll(patch.faces, -1, axis=1)
    across = (values[p] < 0) != (values[q] < 0)
    n = len(patch.vertices)
    keys = np.unique(np.minimum(p, q)[across] * n + np.maximum(p, q)[across])
    pairs = np.stack([keys // n, keys % n], 1)
    a, b = patch.vertices[pairs[:, 0]], patch.vertices[pairs[:, 1]]
    t0, t1 = np.zeros(len(pairs)), np.ones(len(pairs))
    f0, f1 = values[pairs[:, 0]], values[pairs[:, 1]]
    t = f0 / (f0 - f1)
    for _ in range(3):
        f = cut(a + (b - a) * t[:, None]) if len(pairs) else f0
        low = (f < 0) == (f0 < 0)
        t0, f0 = np.where(low, t, t0), np.where(low, f, f0)
        t1, f1 = np.where(low, t1, t), np.where(low, f1, f)
        step = f0 - f1
        t = np.where(np.abs(step) > 1e-9, t0 + (t1 - t0) * f0 / np.where(np.abs(step) > 1e-9, step, 1.0), t)
    t = np.clip(t, 0.02, 0.98)
    return pairs, a + (b - a) * t[:, None]


def compact(patch: Patch) -> Patch:
    """Without unused vertices and without triangles of no area."""
    corner = patch.vertices[patch.faces]
    area = np.linalg.norm(np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]), axis=1)
    faces = patch.faces[area > 1e-11]
    used = np.zeros(len(patch.vertices), bool)
    used[faces] = True
    return Patch(patch.vertices[used], (np.cumsum(used) - 1)[faces])


def cull(patch: Patch, solid: Field, depth: float) -> Patch:
    """Without the triangles that lie deeper than ``depth`` metres inside another solid."""
    hidden = solid(patch.vertices) < -depth
    return compact(Patch(patch.vertices, patch.faces[~hidden[patch.faces].all(1)]))


def boundary(patch: Patch) -> NDArray[np.int64]:
    """Directed edges [E, 2] of the border, each as its triangle runs."""
    edges = np.concatenate([patch.faces[:, [0, 1]], patch.faces[:, [1, 2]], patch.faces[:, [2, 0]]])
    n = len(patch.vertices)
    forward = edges[:, 0] * n + edges[:, 1]
    return edges[~np.isin(forward, edges[:, 1] * n + edges[:, 0])]


def rim(patch: Patch, field: Field, depth: float) -> Patch:
    """A strip from the patch's border straight into the surface: the thickness of a hem."""
    edges = boundary(patch)
    if not len(edges):
        return Patch(np.zeros((0, 3)), np.zeros((0, 3), np.int64))
    used, inverse = np.unique(edges, return_inverse=True)
    a, b = inverse.reshape(-1, 2).T
    outer = patch.vertices[used]
    slope = gradient(field, outer)
    slope /= np.maximum(np.linalg.norm(slope, axis=1, keepdims=True), 1e-9)
    n = len(used)
    faces = np.concatenate([np.stack([b, a, a + n], 1), np.stack([b, a + n, b + n], 1)])
    return Patch(np.concatenate([outer, outer - slope * depth]), faces.astype(np.int64))


def mirror(patch: Patch) -> Patch:
    """The patch on the other side of Y = 0."""
    return Patch(patch.vertices * np.array([1.0, -1.0, 1.0]), np.ascontiguousarray(patch.faces[:, ::-1]))


def half(patch: Patch) -> Patch:
    """The part at Y >= 0, its border pulled exactly onto Y = 0."""
    kept = clip(patch, lambda p: -p[:, 1])
    vertices = kept.vertices.copy()
    vertices[np.abs(vertices[:, 1]) < 5e-4, 1] = 0.0
    return compact(Patch(vertices, kept.faces))
