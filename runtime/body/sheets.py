"""Surfaces given point by point: lathes, plates laid on cloth, strands. For what is crisp or thin.

Everything here returns patches whose triangles look outwards; pieces made of them take their normals from
the triangles.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .field import Field, Points, Values, gradient
from .surface import Patch, compact

Grid = NDArray[np.float64]


def sheet(points: Grid, away: ArrayLike) -> Patch:
    """A sheet over a grid of points [R, C, 3], looking away from the point ``away``."""
    rows, columns = points.shape[:2]
    a = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).reshape(-1)
    faces = np.concatenate(
        [np.stack([a, a + columns, a + columns + 1], 1), np.stack([a, a + columns + 1, a + 1], 1)]
    )
    vertices = points.reshape(-1, 3)
    corner = vertices[faces]
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    if (normal * (corner.mean(1) - np.asarray(away, float))).sum() < 0:
        faces = faces[:, ::-1]
    return compact(Patch(vertices, faces))


def plate(points: Grid, under: Grid, away: ArrayLike, back: bool = False) -> Patch:
    """A sheet with a thickness: its border goes down to the grid ``under``, and all of that is drawn too
    where ``back`` says so."""
    parts = [sheet(points, away)]
    rims = ([points[0], under[0]], [points[-1], under[-1]], [points[:, 0], under[:, 0]],
            [points[:, -1], under[:, -1]])  # fmt: skip
    middle = 0.5 * (points + under).reshape(-1, 3).mean(0)
    for strip in rims:
        if np.linalg.norm(strip[0] - strip[1], axis=1).max() > 1e-6:
            parts.append(sheet(np.stack(strip), middle))
    if back:
        inner = sheet(under, away)
        parts.append(Patch(inner.vertices, inner.faces[:, ::-1]))
    return merged(parts)


def merged(patches: Sequence[Patch]) -> Patch:
    """Several patches as one, their vertices kept apart (so edges between them stay sharp)."""
    counts = np.cumsum([0] + [len(p.vertices) for p in patches])
    return Patch(
        np.concatenate([p.vertices for p in patches]),
        np.concatenate([p.faces + n for p, n in zip(patches, counts[:-1], strict=True)]),
    )


def lathe(
    profile: Sequence[tuple[float, float]],
    centre: ArrayLike,
    radii: tuple[float, float],
    turn: Values | None = None,
    tilt: float = 0.0,
) -> Patch:
    """A surface of revolution around an upright axis, its left half (Y >= 0 when centred there).

    profile: (share of the radii, height above the centre), from the border to the top; radii: along X and Y
    turn: angles from the front, radians; tilt: height gained per metre forward
    """
    return sheet(lathe_grid(profile, centre, radii, turn, tilt), np.asarray(centre, float) + _inside(profile))


def _inside(profile: Sequence[tuple[float, float]]) -> NDArray[np.float64]:
    return np.array([0.0, 0.0, float(np.mean([z for _, z in profile]))])


def lathe_grid(
    profile: Sequence[tuple[float, float]],
    centre: ArrayLike,
    radii: tuple[float, float],
    turn: Values | None = None,
    tilt: float = 0.0,
) -> Grid:
    """The points of :func:`lathe`: [len(profile), len(turn), 3]."""
    angle = np.linspace(0.0, np.pi, 13) if turn is None else turn
    r, z = np.array(profile, float).T
    x = r[:, None] * radii[0] * np.cos(angle)
    y = r[:, None] * radii[1] * np.sin(angle)
    y[:, np.abs(np.sin(angle)) < 1e-9] = 0.0
    points = np.stack([x, y, np.broadcast_to(z[:, None], x.shape) + tilt * x], -1)
    return np.asarray(points + np.asarray(centre, float))


def tube(line: Points, half_sizes: Points, up: Points, segments: int = 6) -> Patch:
    """A closed strand around a line: [N, 2] half sizes across and along ``up`` [N, 3]."""
    along = np.gradient(line, axis=0)
    along /= np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-9)
    across = np.cross(along, up)
    across /= np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-9)
    upright = np.cross(across, along)
    turn = np.arange(segments) * 2 * np.pi / segments
    ring = (
        across[:, None] * (half_sizes[:, :1] * np.cos(turn))[..., None]
        + upright[:, None] * (half_sizes[:, 1:] * np.sin(turn))[..., None]
    )
    n = len(line)
    vertices = np.concatenate([(line[:, None] + ring).reshape(-1, 3), line[:1], line[-1:]])
    faces = []
    for i in range(n - 1):
        for k in range(segments):
            a, b = i * segments + k, i * segments + (k + 1) % segments
            faces += [(a, b + segments, b), (a, a + segments, b + segments)]
    for k in range(segments):
        b = (k + 1) % segments
        faces += [(n * segments, k, b), (n * segments + 1, (n - 1) * segments + b, (n - 1) * segments + k)]
    return outward(Patch(vertices, np.array(faces, np.int64)))


def strand(line: ArrayLike, radius: float | Sequence[float], segments: int = 6) -> Patch:
    """A round strand through points [N, 3], of one radius or one for each point."""
    points = np.asarray(line, float)
    size = np.broadcast_to(np.asarray(radius, float), (len(points),))
    way = points[-1] - points[0]
    up = np.array([0.0, 0.0, 1.0]) if abs(way[2]) < 0.8 * np.linalg.norm(way) else np.array([1.0, 0.1, 0.0])
    return tube(points, np.stack([size, size], 1), np.tile(up, (len(points), 1)), segments)


def ellipsoid_patch(centre: ArrayLike, radii: ArrayLike, segments: int = 8, rings: int = 5) -> Patch:
    """A small ellipsoid."""
    polar = np.linspace(0.0, np.pi, rings + 1)[:, None]
    turn = np.linspace(0.0, 2 * np.pi, segments + 1)
    unit = np.stack(
        [np.sin(polar) * np.cos(turn), np.sin(polar) * np.sin(turn), np.cos(polar) + 0.0 * turn], -1
    )
    unit[:, -1] = unit[:, 0]
    points = np.asarray(centre, float) + unit * np.asarray(radii, float)
    return sheet(points, centre)


def outward(patch: Patch) -> Patch:
    """The patch with its triangles turned to enclose a positive volume about its middle."""
    a, b, c = (patch.vertices[patch.faces[:, k]] for k in range(3))
    middle = patch.vertices.mean(0)
    volume = float(((a - middle) * np.cross(b - middle, c - middle)).sum())
    return patch if volume > 0 else Patch(patch.vertices, patch.faces[:, ::-1])


def laid(solid: Field, points: Grid, lift: float) -> Grid:
    """Points [..., 3] moved onto the surface ``lift`` metres off a solid, along its gradient.

    Points on Y = 0 stay there. They have to be within some centimetres of the surface.
    """
    flat = points.reshape(-1, 3).copy()
    seam = np.abs(flat[:, 1]) < 1e-9
    for _ in range(5):
        slope = gradient(solid, flat, 2e-3)
        slope[seam, 1] = 0.0
        size = np.maximum((slope * slope).sum(1), 0.1)
        flat -= np.clip((solid(flat) - lift) / size, -0.05, 0.05)[:, None] * slope
    return np.asarray(flat.reshape(points.shape))


def cast(solid: Field, start: Points, way: ArrayLike, reach: float) -> Points:
    """Where rays from outside first enter a solid (about): [N, 3] along ``way`` ([3] or [N, 3]), ``reach``
    metres long."""
    direction = np.broadcast_to(np.asarray(way, float), start.shape)
    direction = direction / np.linalg.norm(direction, axis=1, keepdims=True)
    steps = np.linspace(0.0, reach, 28)
    each = solid((start[:, None] + steps[:, None] * direction[:, None]).reshape(-1, 3)).reshape(
        len(start), -1
    )
    inside = each < 0
    hit = np.where(inside.any(1), np.argmax(inside, axis=1), len(steps) - 1)
    high = steps[hit]
    low = steps[np.maximum(hit - 1, 0)]
    for _ in range(7):
        middle = 0.5 * (low + high)
        within = solid(start + middle[:, None] * direction) < 0
        low, high = np.where(within, low, middle), np.where(within, middle, high)
    return np.asarray(start + high[:, None] * direction)


def on_chest(solid: Field, across: Values, up: Values, lift: float, side: float = 1.0) -> Grid:
    """A grid [R, C, 3] over heights ``up`` [R] and widths ``across`` [C] or [R, C], ``lift`` metres off the
    front (``side`` 1) or the back (-1) of a solid."""
    y = np.broadcast_to(across, (len(up), across.shape[-1]))
    z = np.broadcast_to(up[:, None], y.shape)
    start = np.stack([np.full(y.shape, 0.5 * side), y, z], -1).reshape(-1, 3)
    points = cast(solid, start, (-side, 0.0, 0.0), 0.62)
    points[:, 0] += side * lift
    return np.asarray(points.reshape(*y.shape, 3))
