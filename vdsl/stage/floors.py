"""Floors, ceilings, platforms and stairs: what people walk on, as meshes, rectangles and boxes.

Heights are the set's. Where a flight of stairs comes up through a floor, the floor (and the ceiling under
it) has a hole as large as the flight.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from runtime.mesh import Mesh, join
from runtime.shapes import box, painted
from runtime.world import Rect, Stairs

from ..lang.definitions.levels import Flight, Platform
from ..lang.definitions.set import WALL_THICKNESS, Room, SetDef
from .props import placement, with_part

#: Thinner than this a floor is left of no use, metres.
_LEAST = 0.02
_HEADROOM = 2.0


def stairs_of(flight: Flight) -> Stairs:
    """The flight as the engine knows it."""
    ahead = (-math.sin(flight.turn), math.cos(flight.turn))
    reach = (flight.steps - 1) * flight.run
    x, y, z = flight.at
    high = (x + reach * ahead[0], y + reach * ahead[1], z + flight.height)
    return Stairs((x, y, z), high, flight.width, flight.steps, ahead)


def treads(flight: Flight) -> list[tuple[float, float]]:
    """(how far ahead of its foot it begins, its height over the foot) of each tread."""
    rise = flight.height / flight.steps
    return [(k * flight.run, (k + 1) * rise) for k in range(flight.steps - 1)]


def flight_matrix(flight: Flight) -> NDArray[np.float64]:
    """world_from_flight [4, 4]: its foot at 0, climbing along +Y."""
    x, y, z = flight.at
    return placement(x, y, z, flight.turn)


def flight_mesh(flight: Flight, part: int) -> Mesh:
    """Closed steps, each a box down to the floor, the tread standing out a little over its riser."""
    r, g, b = flight.color
    body = (0.92 * r, 0.92 * g, 0.92 * b)
    meshes = []
    for k, (ahead, height) in enumerate(treads(flight)):
        middle = ahead + flight.run / 2
        block = box((flight.width, flight.run, height - 0.03), 0.0, 1, body, flight.material)
        tread = box((flight.width + 0.02, flight.run + 0.02, 0.03), 0.004, 1, flight.color, flight.material)
        meshes.append(with_part(block.transformed(placement(0.0, middle, 0.0, 0.0)), part))
        shift = placement(0.0, middle - 0.01, height - 0.03, 0.0)
        meshes.append(with_part(tread.transformed(shift), part + 1 + k))
    return join(meshes).transformed(flight_matrix(flight))


def flight_boxes(flight: Flight) -> list[tuple[tuple[float, float, float], tuple[float, float, float]]]:
    """(centre, half) of the boxes that stand in for it, in its own coordinates."""
    found = []
    for ahead, height in treads(flight):
        half = (flight.width / 2, flight.run / 2, height / 2)
        found.append(((0.0, ahead + flight.run / 2, height / 2), half))
    return found


def platform_mesh(platform: Platform, part: int) -> Mesh:
    """Its sides and its floor."""
    w, d, h = platform.size
    side = box((w, d, h - 0.03), 0.0, 1, platform.color, "plain")
    top = box((w + 0.02, d + 0.02, 0.03), 0.006, 1, platform.floor_color, platform.floor)
    low = with_part(side, part)
    high = with_part(top.transformed(placement(0.0, 0.0, h - 0.03, 0.0)), part + 1)
    x, y, z = platform.at
    return join([low, high]).transformed(placement(x + w / 2, y + d / 2, z - h, 0.0))


def well(flight: Flight) -> Rect:
    """What a flight needs open above it, on the floor plan: along the axes, for quarter turns."""
    ahead = (-math.sin(flight.turn), math.cos(flight.turn))
    rise = flight.height / flight.steps
    open_from = max(0.0, (math.floor((flight.height - 0.2 - _HEADROOM) / rise)) * flight.run)
    reach, half = (flight.steps - 1) * flight.run, flight.width / 2 + 0.02
    ends = [(flight.at[0] + s * ahead[0], flight.at[1] + s * ahead[1]) for s in (open_from, reach)]
    across = (abs(ahead[1]) * half, abs(ahead[0]) * half)
    xs, ys = zip(*ends, strict=True)
    return min(xs) - across[0], min(ys) - across[1], max(xs) + across[0], max(ys) + across[1]


def wells(definition: SetDef, low: float, high: float) -> list[Rect]:
    """Holes in floors and ceilings: over flights that end at a height from ``low`` to ``high``."""
    flights = [*definition.flights, *(f for r in definition.rooms for f in r.flights)]
    return [well(f) for f in flights if low - 1e-3 <= f.at[2] + f.height <= high + 1e-3]


def without(rect: Rect, holes: Iterable[Rect]) -> list[Rect]:
    """A rectangle less others, as rectangles that do not overlap."""
    left = [rect]
    for hx0, hy0, hx1, hy1 in holes:
        found = []
        for x0, y0, x1, y1 in left:
            a0, b0, a1, b1 = max(x0, hx0), max(y0, hy0), min(x1, hx1), min(y1, hy1)
            if a1 <= a0 or b1 <= b0:
                found.append((x0, y0, x1, y1))
                continue
            pieces = ((x0, y0, a0, y1), (a1, y0, x1, y1), (a0, y0, a1, b0), (a0, b1, a1, y1))
            found += [p for p in pieces if p[2] - p[0] > _LEAST and p[3] - p[1] > _LEAST]
        left = found
    return left


def plan(room: Room) -> Rect:
    """A room's floor, to the middle of its walls."""
    (x, y), (w, d) = room.at[:2], room.size[:2]
    return x, y, x + w, y + d


def inside(room: Room) -> Rect:
    """A room's floor within its walls."""
    x0, y0, x1, y1 = plan(room)
    inset = WALL_THICKNESS / 2 if room.kind == "room" else 0.0
    return x0 + inset, y0 + inset, x1 - inset, y1 - inset


def floor_mesh(room: Room, part: int, holes: list[Rect]) -> Mesh:
    """A room's floor, to the middle of its walls, in quads about 2 m wide."""
    sheets = [_sheet(rect, room.at[2]) for rect in without(plan(room), holes)]
    vertices, faces = _stacked(sheets)
    normals = np.tile([0.0, 0.0, 1.0], (len(vertices), 1))
    return painted(vertices, faces, normals, room.floor_color, room.floor, part)


def ceiling_mesh(room: Room, part: int, holes: list[Rect]) -> Mesh:
    """A room's ceiling, facing down, a little lighter than its walls."""
    sheets = [_sheet(rect, room.at[2] + room.size[2]) for rect in without(plan(room), holes)]
    vertices, faces = _stacked(sheets)
    normals = np.tile([0.0, 0.0, -1.0], (len(vertices), 1))
    r, g, b = (c + (1.0 - c) * 0.4 for c in room.wall_color)
    return painted(vertices, faces[:, ::-1], normals, (r, g, b), "plaster", part)


def _sheet(rect: Rect, z: float) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    x0, y0, x1, y1 = rect
    return sheet(rect, z, max(1, round((x1 - x0) / 2.0)), max(1, round((y1 - y0) / 2.0)))


def sheet(rect: Rect, z: float, nx: int, ny: int) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """A level sheet at height z in ``nx`` by ``ny`` quads, facing up: vertices [V, 3], triangles [F, 3]."""
    x0, y0, x1, y1 = rect
    gx, gy = np.meshgrid(np.linspace(x0, x1, nx + 1), np.linspace(y0, y1, ny + 1), indexing="ij")
    vertices = np.stack([gx.ravel(), gy.ravel(), np.full(gx.size, z)], 1)
    i, j = np.meshgrid(np.arange(nx), np.arange(ny), indexing="ij")
    a = (i * (ny + 1) + j).ravel()
    quads = np.stack([a, a + ny + 1, a + ny + 2, a + 1], 1)
    return vertices, np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def _stacked(
    sheets: list[tuple[NDArray[np.float64], NDArray[np.int64]]],
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    counts = np.cumsum([0, *(len(v) for v, _ in sheets)])
    vertices = np.concatenate([np.zeros((0, 3)), *(v for v, _ in sheets)])
    shifted = (f + n for (_, f), n in zip(sheets, counts[:-1], strict=True))
    return vertices, np.concatenate([np.zeros((0, 3), np.int64), *shifted])


def slab_mesh(
    rects: list[Rect], low: float, high: float, color: tuple[float, float, float], part: int
) -> Mesh:
    """The sides of a floor between two storeys, seen in the well of the stairs."""
    meshes = [
        box((x1 - x0, y1 - y0, high - low), 0.0, 1, color, "plaster").transformed(
            placement((x0 + x1) / 2, (y0 + y1) / 2, low, 0.0)
        )
        for x0, y0, x1, y1 in rects
    ]
    return with_part(join(meshes), part)
