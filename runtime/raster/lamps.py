"""Practical lights: what glows in a set lights what is around it.

Whatever static thing is of the material ``glow`` is a lamp: a bulb, a shade, a flame, a screen, a lit window.
Faces of one object that are close together are one lamp. What lamps throw into the room is worked out once
per scene, as a volume of light that knows where it comes from mostly; things of the set shade it, people
do not.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..mesh import MATERIALS, Mesh
from ..rows import unique_rows
from .bake import Volume
from .film import to_linear
from .looks import LUMA
from .types import Style

ONE_LAMP = 0.9  # metres; glowing faces of one object within such a cube are one lamp
MOST_LAMPS = 64
BULB = 0.03  # square metres of glow that are as bright as a lamp in a room
HEIGHTS = (0.8, 4.5)  # metres: what a lamp is made to light is at least, at most so far below it
BLAZE = 2.4  # a fire that is this much smaller than a height is as bright as a lamp there
AGLOW = 3.0  # panes, screens and signals are made to light no more than what is so far, for their size
LEVEL = 0.62  # light that a bulb throws on what it is made to light, before it is turned up or down
HOOD = 0.75  # share of its light that a lamp under a hood sends down rather than all around
HOODED = (0.45, 0.02)  # metres around a lamp, and square metres of its own thing above it that are a hood
FLAT = 0.66  # share of a body's surface that faces one way, from which on it is a pane or a screen
THIN = 0.15  # how thick a lamp is for its width at most, to be one as well
PANEL = 0.4  # square metres from which on a flat lamp in a ceiling is a panel
OVERHEAD = 0.4  # how much of a bulb's light one throws for each metre across: there are several in a room
PANE = 0.6  # how much of a bulb's light a square metre of these throws, both sides together
REACH = 4.0  # how often as far as that it reaches at all
CELL = 0.12  # metres, finest cell of the volume
CELLS = 90_000  # most cells of it
HEADER = 8  # numbers before the cells: see :func:`header`
LAMP = 12  # numbers kept of each lamp: see :func:`packed_lamps`
CLAY_COLOR, CLAY_SHARE = 0.45, 0.6  # how much of the colour and of the light of its lamps clay keeps


@dataclass(frozen=True, eq=False)
class Lamps:
    """L lamps. place: metres, float64 [L, 3]; color: light it throws one metre away, linear [L, 3];
    radius, reach: metres, float64 [L]; facing: float64 [L, 3], where it mostly shines, of length 0
    (everywhere) to 1
    """

    place: NDArray[np.float64]
    color: NDArray[np.float64]
    radius: NDArray[np.float64]
    facing: NDArray[np.float64]
    reach: NDArray[np.float64]


def find_lamps(
    mesh: Mesh, object_ids: NDArray[np.int32], levels: tuple[float, ...], strength: float, style: Style
) -> Lamps:
    """The lamps of a static mesh; strength: how far they are turned up, 0 for off. The brightest are kept."""
    chosen = np.flatnonzero(mesh.materials == MATERIALS.index("glow"))
    if strength <= 0 or style.plain or not len(chosen):
        return Lamps(np.zeros((0, 3)), np.zeros((0, 3)), np.zeros(0), np.zeros((0, 3)), np.zeros(0))
    corners = mesh.vertices[mesh.faces[chosen]].astype(np.float64)
    cross = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) / 2
    area = np.maximum(np.linalg.norm(cross, axis=1), 1e-9)
    middle = corners.mean(axis=1)
    owners = object_ids[chosen]
    low = np.full((int(owners.max()) + 1, 3), np.inf)
    np.minimum.at(low, owners, middle)
    cell = np.floor((middle - low[owners]) / ONE_LAMP).astype(int)
    _, _, of = unique_rows(np.column_stack([owners, cell]))

    def gathered(values: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.stack([np.bincount(of, weights=values[:, k]) for k in range(3)], axis=1)

    whole = np.bincount(of, weights=area)
    place = gathered(middle * area[:, None]) / whole[:, None]
    color = gathered(to_linear(mesh.colors[chosen].astype(np.float64)) * area[:, None]) / whole[:, None]
    spread = np.sqrt(np.bincount(of, weights=area * ((middle - place[of]) ** 2).sum(1)) / whole)
    facing = gathered(cross) / whole[:, None]  # nothing of a closed body, of length 1 of a flat one
    sides = gathered(np.abs(cross))
    flat = (sides.max(axis=1) > FLAT * whole) & (sides.argmax(axis=1) < 2)  # upright ones
    wide = np.sqrt(gathered(area[:, None] * (middle - place[of]) ** 2) / whole[:, None])[:, :2]
    flat |= wide.min(axis=1) < THIN * wide.max(axis=1)  # a trace on a screen, letters of neon
    panel = (sides[:, 2] > FLAT * whole) & (whole > PANEL)
    first = np.unique(of, return_index=True)[1]
    floors = np.array(sorted(levels)) if levels else np.zeros(1)
    under = floors[np.clip(np.searchsorted(floors, place[:, 2], side="right") - 1, 0, None)]
    height, across = place[:, 2] - under, np.sqrt(whole)
    height = np.where(flat, np.minimum(height, AGLOW * across), np.maximum(height, BLAZE * across))
    height = np.clip(height, *HEIGHTS)
    power = strength * LEVEL * np.clip(np.sqrt(whole / BULB), 0.1, 1.35) * height**2
    _, thing, many = np.unique(owners[first], return_inverse=True, return_counts=True)
    hooded = ~flat & _hooded(mesh, object_ids, place, owners[first])
    facing[hooded] = (0.0, 0.0, -HOOD)
    pane = PANE * np.clip(across, 0.2, 1.0)  # a screen throws less than a lit window
    pane = np.where(flat, pane, np.where(panel, OVERHEAD * across, 1.0))
    power *= pane / np.sqrt(many[thing.reshape(-1)])  # many windows: one light
    color = color**1.3  # as the eye takes them beside daylight: warmer, stronger
    color /= np.maximum(color.max(axis=1, keepdims=True), 1e-6)
    if style.clay:
        color = (color @ LUMA)[:, None] + (color - (color @ LUMA)[:, None]) * CLAY_COLOR
        power *= CLAY_SHARE
    kept = np.argsort(-power, kind="stable")[:MOST_LAMPS]
    radius = np.clip(spread, 0.06, 0.6) + 0.22 * height
    return Lamps(
        place[kept], (color * power[:, None])[kept], radius[kept], facing[kept], REACH * height[kept]
    )


def _hooded(
    mesh: Mesh, object_ids: NDArray[np.int32], place: NDArray[np.float64], owner: NDArray[np.int32]
) -> NDArray[np.bool_]:
    """Which lamps hang under something opaque of their own thing: a shade, the head of a street lamp."""
    near, enough = HOODED
    out = np.zeros(len(place), np.bool_)
    opaque = mesh.materials != MATERIALS.index("glow")
    for k, (point, thing) in enumerate(zip(place, owner, strict=True)):
        corners = mesh.vertices[mesh.faces[opaque & (object_ids == thing)]].astype(np.float64)
        off = corners.mean(axis=1) - point
        above = (np.hypot(off[:, 0], off[:, 1]) < near) & (off[:, 2] > 0.0) & (off[:, 2] < near)
        u, v = corners[above, 1] - corners[above, 0], corners[above, 2] - corners[above, 0]
        # seen from below, front and back of a body count once
        out[k] = np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]).sum() / 4 > enough
    return out


def packed_lamps(lamps: Lamps) -> NDArray[np.float32]:
    """LAMP numbers of each: place 3, reach, colour 3, radius squared, facing 3, nothing."""
    out = np.zeros((max(len(lamps.place), 1), LAMP), np.float32)
    if len(lamps.place):
        out[:, 0:3], out[:, 3], out[:, 4:7] = lamps.place, lamps.reach, lamps.color
        out[:, 7], out[:, 8:11] = lamps.radius**2, lamps.facing
    return out.reshape(-1)


def extent(mesh: Mesh, lamps: Lamps) -> tuple[NDArray[np.float64], float, tuple[int, int, int]]:
    """Low corner, spacing and shape of a volume around all that lamps reach of a mesh."""
    points = mesh.vertices[mesh.faces.reshape(-1)].astype(np.float64)
    reach = lamps.reach[:, None]
    low = np.maximum(points.min(axis=0) - 0.3, (lamps.place - reach).min(axis=0))
    high = np.minimum(points.max(axis=0) + 0.3, (lamps.place + reach).max(axis=0))
    cell = max(CELL, float((np.prod(high - low) / CELLS) ** (1 / 3)))
    nx, ny, nz = (int(n) for n in np.ceil((high - low) / cell) + 2)
    return low, cell, (nx, ny, nz)


def header(low: NDArray[np.float64], cell: float, shape: tuple[int, int, int]) -> NDArray[np.float32]:
    """HEADER numbers: low corner 3, cells a metre (0: no lamp shines), shape 3, and how far off a surface
    its light is looked up, metres."""
    return np.array([*low, 1.0 / cell, *shape, 1.15 * cell], np.float32)


def lamp_volume(
    mesh: Mesh,
    object_ids: NDArray[np.int32],
    levels: tuple[float, ...],
    strength: float,
    style: Style,
    density: Volume,
    backend: object,
) -> object:
    """The light of a set's lamps where kernels can use it: HEADER numbers, and six of each cell (see
    ``kernels/lamps.py``); without a lamp that shines the header alone, of zeros.

    density: surface of the set in a cubic metre, that keeps lamplight off
    """
    lamps = find_lamps(mesh, object_ids, levels, strength, style)
    if not len(lamps.place):
        return backend.upload(np.zeros(HEADER, np.float32))  # type: ignore[attr-defined]
    from .kernels.lamps import shine  # only now: it imports taichi

    low, cell, shape = extent(mesh, lamps)
    volume = np.zeros(HEADER + 6 * int(np.prod(shape)), np.float32)
    volume[:HEADER] = header(low, cell, shape)
    out = backend.upload(volume)  # type: ignore[attr-defined]
    grid = np.array([*density.low, 1.0 / density.cell], np.float32)
    up = backend.upload  # type: ignore[attr-defined]
    shine(
        up(packed_lamps(lamps)), len(lamps.place), up(grid), *density.values.shape,
        up(density.values.reshape(-1)), out, int(np.prod(shape)),
    )  # fmt: skip
    return out
