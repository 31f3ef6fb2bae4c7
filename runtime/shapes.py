"""Solids from few numbers: the primitives every prop and set is made of.

Every function returns a closed :class:`Mesh` (faces counter-clockwise seen from outside, positive
volume) in one colour, one material and part 0. Edges that turn by more than :data:`CREASE` are
split, so that they look crisp; gentler ones share their normal, so that curves look smooth.
Metres; the foot of a shape is at z = 0 and its axis is Z, except for the sphere, whose centre is
the origin.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from .mesh import MATERIALS, Mesh
from .rows import unique_rows

#: Radians an edge may turn before it is drawn as a crease.
CREASE = math.radians(40.0)

Colour = tuple[float, float, float]
Point2 = Sequence[float]
GREY: Colour = (0.8, 0.8, 0.8)


def painted(
    vertices: NDArray[np.floating],
    faces: NDArray[np.integer],
    normals: NDArray[np.floating],
    color: Colour = GREY,
    material: str = "plain",
    part: int = 0,
) -> Mesh:
    """A mesh of one colour: vertices [V, 3], faces [F, 3], normals [V, 3] (any length), sRGB colour."""
    count = len(faces)
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    return Mesh(
        np.ascontiguousarray(vertices, np.float32),
        np.ascontiguousarray(faces, np.int32),
        (normals / np.maximum(length, 1e-12)).astype(np.float32),
        np.tile(np.asarray(color, np.float32), (count, 1)),
        np.full(count, part, np.int32),
        np.full(count, MATERIALS.index(material), np.int32),
    )


def box(
    size: Sequence[float],
    rounding: float = 0.0,
    steps: int = 1,
    color: Colour = GREY,
    material: str = "plain",
) -> Mesh:
    """A box of ``size`` (x, y, z), its foot centred on the origin.

    rounding: radius of the edges in metres; steps: 1 for one bevel (44 triangles) that the normals make look
        round where it is wider than :data:`NARROW`, 2 and more for truly round, soft edges
    """
    half = np.asarray(size, np.float64) / 2
    radius = float(min(max(rounding, 0.0), half.min() * 0.98))
    if radius <= 1e-6:
        vertices, faces, normals = _sharp_box(half)
    elif steps <= 1:
        vertices, faces, normals = _bevelled_box(half, radius)
    else:
        vertices, faces, normals = _round_box(half, radius, steps)
    vertices[:, 2] += half[2]
    return painted(vertices, faces, normals, color, material)


#: For each of the six sides: the normal's axis and sign, and the two axes along it (right-handed).
_SIDES = ((0, 1, 1, 2), (0, -1, 2, 1), (1, 1, 2, 0), (1, -1, 0, 2), (2, 1, 0, 1), (2, -1, 1, 0))
#: Metres; bevels of at most this radius are a pixel or two wide in most shots, hit here and missed there.
#: They are lit as one of the sides that they join, so that an edge is one line, and not a row of dashes.
NARROW = 0.0201
_Arrays = tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.float64]]


def _sharp_box(half: NDArray[np.float64]) -> _Arrays:
    vertices: list[NDArray[np.float64]] = []
    normals: list[NDArray[np.float64]] = []
    faces: list[tuple[int, ...]] = []
    for axis, sign, u, v in _SIDES:
        start = len(vertices)
        for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
            corner = np.zeros(3)
            corner[axis], corner[u], corner[v] = sign, a, b
            vertices.append(corner * half)
            normals.append(np.eye(3)[axis] * sign)
        faces += [(start, start + 1, start + 2), (start, start + 2, start + 3)]
    return np.array(vertices), np.array(faces), np.array(normals)


def _bevelled_box(half: NDArray[np.float64], radius: float) -> _Arrays:
    """Six flat sides, twelve bevels, eight corners.

    Bevels take the normals of both sides and look round; up to :data:`NARROW` that of one, the top or the
    bottom before the others.
    """
    vertices: list[NDArray[np.float64]] = []
    normals: list[NDArray[np.float64]] = []
    faces: list[tuple[int, ...]] = []
    index: dict[tuple[int, tuple[int, int, int]], int] = {}
    for axis in range(3):
        for corner in np.ndindex(2, 2, 2):
            signs = np.array(corner) * 2.0 - 1.0
            point = signs * (half - radius)
            point[axis] = signs[axis] * half[axis]
            index[axis, (corner[0], corner[1], corner[2])] = len(vertices)
            vertices.append(point)
            normals.append(np.eye(3)[axis] * signs[axis])

    def add(*ring: int) -> None:
        corners = np.array([vertices[i] for i in ring])
        normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
        order = ring if normal @ corners.mean(0) > 0 else ring[::-1]
        faces.extend((order[0], order[i], order[i + 1]) for i in range(1, len(order) - 1))

    bits = (0, 1)
    for axis, sign, u, v in _SIDES:
        ring = []
        for a, b in ((0, 0), (1, 0), (1, 1), (0, 1)):
            bit = [0, 0, 0]
            bit[axis], bit[u], bit[v] = (sign + 1) // 2, a, b
            ring.append(index[axis, (bit[0], bit[1], bit[2])])
        add(*ring)
    copies: dict[tuple[int, int], int] = {}

    def bevel(axis: int, *ring: int) -> None:
        """A bevel that, where it is narrow, goes with the side along an axis."""
        if radius <= NARROW:
            for vertex in ring:
                if (vertex, axis) not in copies:
                    copies[vertex, axis] = len(vertices)
                    vertices.append(vertices[vertex])
                    normals.append(np.eye(3)[axis] * np.sign(vertices[vertex][axis]))
            ring = tuple(copies[vertex, axis] for vertex in ring)
        add(*ring)

    for axis in range(3):  # bevels run along this axis, between the sides u and v
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for i in bits:
            for j in bits:
                low, high = [0, 0, 0], [0, 0, 0]
                low[u] = high[u] = i
                low[v] = high[v] = j
                high[axis] = 1
                k0, k1 = (low[0], low[1], low[2]), (high[0], high[1], high[2])
                bevel(max(u, v), index[u, k0], index[u, k1], index[v, k1], index[v, k0])
    for corner in np.ndindex(2, 2, 2):
        key = (corner[0], corner[1], corner[2])
        bevel(2, index[0, key], index[1, key], index[2, key])
    return np.array(vertices), np.array(faces), np.array(normals)


def _round_box(half: NDArray[np.float64], radius: float, steps: int) -> _Arrays:
    """The sum of a box and a ball: each side a grid whose rim bends over by 45°."""
    bend = np.tan(np.linspace(-math.pi / 4, 0, steps))
    slope = np.concatenate([bend, -bend[::-1]])
    core = np.concatenate([-np.ones(steps), np.ones(steps)])
    n = 2 * steps
    vertices: list[NDArray[np.float64]] = []
    normals: list[NDArray[np.float64]] = []
    faces: list[NDArray[np.int64]] = []
    for axis, sign, u, v in _SIDES:
        direction = np.zeros((n, n, 3))
        centre = np.zeros((n, n, 3))
        direction[..., axis], centre[..., axis] = sign, sign
        direction[..., u], centre[..., u] = slope[:, None], core[:, None]
        direction[..., v], centre[..., v] = slope[None, :], core[None, :]
        direction /= np.linalg.norm(direction, axis=-1, keepdims=True)
        start = len(vertices) * n * n
        vertices.append((centre * (half - radius) + radius * direction).reshape(-1, 3))
        normals.append(direction.reshape(-1, 3))
        i, j = np.mgrid[: n - 1, : n - 1]
        a = start + (i * n + j).ravel()
        quads = np.stack([a, a + n, a + n + 1, a + 1], 1)
        faces.append(np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]))
    return np.concatenate(vertices), np.concatenate(faces), np.concatenate(normals)


def round_segments(radius: float) -> int:
    """How many sides a circle of that radius needs to look round in a picture."""
    return int(np.clip(4 + 80 * math.sqrt(max(radius, 0.0)), 8, 32)) // 2 * 2


def lathe(
    profile: Sequence[Point2],
    segments: int | None = None,
    color: Colour = GREY,
    material: str = "plain",
    crease: float = CREASE,
) -> Mesh:
    """A profile of (radius, z) points turned about Z.

    Open ends are closed to the axis; a profile that ends where it starts makes a ring. It may run in
    either direction: the outside is found by the volume's sign.
    """
    points = np.maximum(np.asarray(profile, np.float64), (0.0, -np.inf))
    ring = len(points) > 3 and np.allclose(points[0], points[-1])
    if not ring:
        ends = [np.array([[0.0, points[k, 1]]]) if points[k, 0] > 1e-9 else np.zeros((0, 2)) for k in (0, -1)]
        points = np.concatenate([ends[0], points, ends[1]])
    points = points[np.concatenate([[True], np.linalg.norm(np.diff(points, axis=0), axis=1) > 1e-7])]
    r, z = points[:, 0], points[:, 1]
    # Pappus: the volume is that of the profile's signed area carried round the axis.
    volume = np.sum((r[:-1] ** 2 + r[:-1] * r[1:] + r[1:] ** 2) * np.diff(z))
    if ring:
        volume += (r[-1] ** 2 + r[-1] * r[0] + r[0] ** 2) * (z[0] - z[-1])
    if volume < 0:
        points = points[::-1]
    sides = segments or round_segments(float(r.max()))
    vertices, faces, normals = _revolve(points, ring, max(sides, 3), crease)
    return painted(vertices, faces, normals, color, material)


def _revolve(points: NDArray[np.float64], ring: bool, sides: int, crease: float) -> _Arrays:
    step = np.diff(points, axis=0)
    first, last = _end_normals(step, ring, crease)
    count = len(step)
    angle = np.arange(sides) * (2 * math.pi / sides)
    cos, sin = np.cos(angle), np.sin(angle)
    vertices, normals, faces = [], [], []
    k, following = np.arange(sides), (np.arange(sides) + 1) % sides
    for e in range(count):
        start = 2 * sides * e
        for point, normal in ((points[e], first[e]), (points[e + 1], last[e])):
            vertices.append(np.stack([point[0] * cos, point[0] * sin, np.full(sides, point[1])], 1))
            normals.append(np.stack([normal[0] * cos, normal[0] * sin, np.full(sides, normal[1])], 1))
        low, high = start + k, start + sides + k
        low_next, high_next = start + following, start + sides + following
        if points[e, 0] > 1e-9:
            faces.append(np.stack([low, low_next, high_next if points[e + 1, 0] > 1e-9 else high], 1))
        if points[e + 1, 0] > 1e-9:
            faces.append(np.stack([low, high_next, high], 1))
    return np.concatenate(vertices), np.concatenate(faces), np.concatenate(normals)


def _end_normals(
    edges: NDArray[np.float64], ring: bool, crease: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Normals [E, 2] of the edges of an outline at their starts and ends, of any length: those of neighbours
    mixed where they meet in less than ``crease``, by their lengths, so that beside a narrow rounding a side
    still looks straight."""
    normal = np.stack([edges[:, 1], -edges[:, 0]], 1)
    unit = normal / np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-12)
    first, last = normal.copy(), normal.copy()
    count = len(edges)
    for i in range(count if ring else count - 1):
        j = (i + 1) % count
        if unit[i] @ unit[j] > math.cos(crease):
            first[j] = last[i] = normal[i] + normal[j]
    return first, last


def cylinder(
    radius: float,
    height: float,
    rounding: float = 0.0,
    segments: int | None = None,
    color: Colour = GREY,
    material: str = "plain",
) -> Mesh:
    """A cylinder standing on z = 0; ``rounding`` softens both rims."""
    return cone(radius, radius, height, rounding, segments, color, material)


def cone(
    low: float,
    high: float,
    height: float,
    rounding: float = 0.0,
    segments: int | None = None,
    color: Colour = GREY,
    material: str = "plain",
) -> Mesh:
    """A cone or a stump from radius ``low`` at z = 0 to radius ``high`` at ``height``."""
    soft = min(max(rounding, 0.0), height * 0.45, max(low, high) * 0.9)
    profile: list[Point2] = []
    for radius, z, inward in ((low, 0.0, 1.0), (high, height, -1.0)):
        bevel = min(soft, radius * 0.9)
        start, middle, end = radius - bevel, radius - 0.29 * bevel, z + inward * bevel
        rim = [(start, z), (middle, z + inward * 0.29 * bevel), (radius, end)]
        corner: list[Point2] = list(rim) if bevel > 1e-6 else [(radius, z)]
        profile += corner if inward > 0 else corner[::-1]
    crease = math.radians(50.0) if soft > 1e-6 else CREASE
    return lathe(profile, segments or round_segments(max(low, high)), color, material, crease)


def sphere(
    radius: float | Sequence[float],
    lumps: float = 0.0,
    segments: int | None = None,
    color: Colour = GREY,
    material: str = "plain",
) -> Mesh:
    """A ball or an ellipsoid (three radii) about the origin.

    lumps: 0..1, how far the surface is pushed about, for foliage and stones; always the same way
    """
    radii = np.broadcast_to(np.asarray(radius, np.float64), 3)
    around = segments or max(round_segments(float(radii.max())), 10)
    latitude = np.linspace(-math.pi / 2, math.pi / 2, around // 2 + 1)
    profile = np.stack([np.cos(latitude), np.sin(latitude)], 1)
    profile[[0, -1], 0] = 0.0
    unit = lathe([tuple(p) for p in profile], around, color, material, math.pi)
    direction = unit.vertices.astype(np.float64)
    push = 1.0 + lumps * _lumps(direction)
    vertices = direction * push[:, None] * radii
    if lumps <= 0:
        return painted(vertices, unit.faces, direction / radii, color, material)
    return painted(vertices, unit.faces, _smooth_normals(vertices, unit.faces), color, material)


def _lumps(direction: NDArray[np.float64]) -> NDArray[np.float64]:
    """A fixed, smooth pattern of bumps on the unit sphere, about -1..1: [V, 3] -> [V]."""
    waves = ((5.1, 2.3, -3.7, 0.4), (-2.9, 6.1, 1.7, 2.1), (3.3, -4.9, 5.3, 4.4))
    return np.mean([np.sin(direction @ np.array(w[:3]) + w[3]) for w in waves], axis=0)


def _smooth_normals(vertices: NDArray[np.float64], faces: NDArray[np.integer]) -> NDArray[np.float64]:
    """Area-weighted normals, shared by vertices in the same place."""
    _, _, same = unique_rows(np.round(vertices, 6))
    corners = vertices[faces]
    flat = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    total = np.zeros((same.max() + 1, 3))
    for k in range(3):
        np.add.at(total, same[faces[:, k]], flat)
    return total[same]


def extrude(
    outline: Sequence[Point2],
    height: float,
    color: Colour = GREY,
    material: str = "plain",
    crease: float = CREASE,
) -> Mesh:
    """A simple polygon of (x, y) points, convex or not, raised from z = 0 to ``height``."""
    points = np.asarray(outline, np.float64)
    if len(points) > 3 and np.allclose(points[0], points[-1]):
        points = points[:-1]
    following = np.roll(points, -1, axis=0)
    if np.sum(points[:, 0] * following[:, 1] - points[:, 1] * following[:, 0]) < 0:
        points = points[::-1]
    count = len(points)
    first, last = _end_normals(np.roll(points, -1, axis=0) - points, True, crease)
    vertices, normals, faces = [], [], []
    for i in range(count):
        a, b = points[i], points[(i + 1) % count]
        s = 4 * i
        vertices += [(*a, 0.0), (*b, 0.0), (*b, height), (*a, height)]
        normals += [(*first[i], 0.0), (*last[i], 0.0), (*last[i], 0.0), (*first[i], 0.0)]
        faces += [(s, s + 1, s + 2), (s, s + 2, s + 3)]
    cap = _ears(points)
    for z, up in ((0.0, -1.0), (height, 1.0)):
        s = len(vertices)
        vertices += [(*p, z) for p in points]
        normals += [(0.0, 0.0, up)] * count
        faces += [(s + a, s + b, s + c) if up > 0 else (s + a, s + c, s + b) for a, b, c in cap]
    return painted(np.array(vertices), np.array(faces), np.array(normals), color, material)


def _ears(points: NDArray[np.float64]) -> list[tuple[int, int, int]]:
    """Triangles of a counter-clockwise simple polygon, by cutting ears off."""

    def cross(o: int, a: int, b: int) -> float:
        u, v = points[a] - points[o], points[b] - points[o]
        return float(u[0] * v[1] - u[1] * v[0])

    left = list(range(len(points)))
    triangles = []
    while len(left) > 3:
        for k in range(len(left)):
            a, b, c = left[k - 1], left[k], left[(k + 1) % len(left)]
            others = (p for p in left if p not in (a, b, c))
            if cross(a, b, c) > 1e-12 and not any(
                cross(a, b, p) >= 0 and cross(b, c, p) >= 0 and cross(c, a, p) >= 0 for p in others
            ):
                break
        else:  # degenerate: cut anything, the polygon still closes
            k = 0
            a, b, c = left[-1], left[0], left[1]
        triangles.append((a, b, c))
        left.pop(k)
    triangles.append((left[0], left[1], left[2]))
    return triangles


def tube(
    path: Sequence[Sequence[float]],
    radius: float,
    segments: int | None = None,
    color: Colour = GREY,
    material: str = "plain",
) -> Mesh:
    """A round bar along a polyline of (x, y, z) points, mitred at its bends, closed at its ends."""
    points = np.asarray(path, np.float64)
    points = points[np.concatenate([[True], np.linalg.norm(np.diff(points, axis=0), axis=1) > 1e-7])]
    sides = segments or max(6, round_segments(radius) - 2)
    ahead = np.diff(points, axis=0)
    ahead /= np.linalg.norm(ahead, axis=1, keepdims=True)
    tangent = np.concatenate([ahead[:1], ahead[:-1] + ahead[1:], ahead[-1:]])
    tangent /= np.maximum(np.linalg.norm(tangent, axis=1, keepdims=True), 1e-9)
    axis = np.eye(3)[np.argmin(np.abs(tangent[0]))]
    angle = np.arange(sides) * (2 * math.pi / sides)
    rings, outward, before = [], [], tangent[0]
    for i, (point, along) in enumerate(zip(points, tangent, strict=True)):
        arm = ahead[min(i, len(ahead) - 1)]
        cosine = max(float(arm @ along), 0.5)
        bend = along * cosine - arm
        bend /= max(float(np.linalg.norm(bend)), 1e-9)
        stretch = 1.0 / cosine - 1.0
        # turned as the bar turns, so that the rings do not twist (parallel transport)
        u = axis - (before + along) * ((axis @ along) / max(1.0 + float(before @ along), 1e-9))
        u -= along * (u @ along)
        u /= max(float(np.linalg.norm(u)), 1e-9)
        axis, before = u, along
        v = np.cross(along, u)
        out = np.cos(angle)[:, None] * u + np.sin(angle)[:, None] * v
        outward.append(out)
        # wider across a bend, so that the bar keeps its thickness along both of its arms
        rings.append(point + radius * (out + np.outer(out @ bend, bend * stretch)))
    count = len(points)
    vertices = np.concatenate([*rings, rings[0], rings[-1]])
    normals = np.concatenate([*outward, np.tile(-tangent[0], (sides, 1)), np.tile(tangent[-1], (sides, 1))])
    k, following = np.arange(sides), (np.arange(sides) + 1) % sides
    faces = []
    for i in range(count - 1):
        low, high = i * sides, (i + 1) * sides
        faces.append(np.stack([low + k, low + following, high + following], 1))
        faces.append(np.stack([low + k, high + following, high + k], 1))
    fan = np.arange(1, sides - 1)
    start, end = count * sides, (count + 1) * sides
    faces.append(np.stack([np.full(len(fan), start), start + fan + 1, start + fan], 1))
    faces.append(np.stack([np.full(len(fan), end), end + fan, end + fan + 1], 1))
    return painted(vertices, np.concatenate(faces), normals, color, material)


def volume(mesh: Mesh) -> float:
    """Signed volume enclosed by a closed mesh, m³; positive when the faces look outward."""
    corners = mesh.vertices[mesh.faces].astype(np.float64)
    return float(np.einsum("fi,fi->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6.0)
