"""A scene where the kernels can use it: its arrays, and what is worked out of them once.

Assumes a valid scene. Everything here stays as it is until the next scene is loaded.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .adjacency import beside
from .bake import light_basis, occlusion_volume
from .casting import Casting, Home, casting_of
from .device import Backend
from .lamps import lamp_volume
from .looks import glass_colors, gloom, packed_light, paper_level, paper_tones
from .panes import Glass, divided
from .prepare import Prepared, check, prepare
from .resting import Rig
from .sunlight import Sunlight, find_sunlight
from .types import RenderScene, Style, people_of

SET_SHADOW = 2048  # texels along the set's shadow map
TEXEL = 0.006  # metres, the finest of shadow maps
FLOOR_CELL = 0.05  # metres
FLOOR_CELLS = 512  # most cells along the floor
UPLOADED = (
    "vertices",
    "normals",
    "rest",
    "rest_normals",
    "faces",
    "color",
    "info",
    "clusters",
    "sphere",
    "surface_object",
    "one_color",
    "head",
    "area",
    "solid",
)


@dataclass(frozen=True, eq=False)
class ShadowMap:
    """A set's shadow map of size x size texels: frame, depth and coarse as in ``kernels/light.py``."""

    size: int
    frame: Any
    depth: Any
    coarse: Any


@dataclass(frozen=True, eq=False)
class Chart:
    """Where the set shades its own triangles: plot, begin, side and kinds as in ``kernels/chart.py``."""

    plot: Any
    begin: Any
    side: Any
    kinds: Any


@dataclass(frozen=True, eq=False)
class Loaded:
    """A scene on the device.

    scene: its flat arrays; arrays: those of them that kernels read, by name; glass: what is clear, None
    without; shadow: the set's map; sheet, chart: what shading needs of each triangle of the set; lamps:
    light of its lamps (``lamps.py``); sunlight: what falls through windows; cells: shape of the occlusion
    volume; columns, rows: of the floor's cells; walls, people: how many can be left out; palette: matrices
    that a moment needs; casting: what throws shadows; home: what is at home in the set; paper: for hatching,
    the luma that stays white, and how gloomy it is
    """

    scene: Prepared
    arrays: dict[str, Any]
    glass: Glass | None
    shadow: ShadowMap
    sheet: Any
    chart: Chart
    lamps: Any
    sunlight: Sunlight | None
    cells: tuple[int, int, int]
    columns: int
    rows: int
    highest: float
    rig: Rig
    walls: int
    people: int
    palette: int
    casting: Casting
    home: Home
    paper: tuple[float, float]

    @property
    def static_vertices(self) -> int:
        return len(self.scene.vertices)


def loaded(scene: RenderScene, style: Style, backend: Backend, shading: Any) -> Loaded:
    """Prepare and upload ``scene``; shading: the kernels of the style. Raises ValueError."""
    check(scene)
    people = people_of(scene)
    opaque, glass = divided(scene)
    if glass is not None:
        glass = replace(glass, color=glass_colors(glass.color, style))
    prepared = prepare(opaque, style, backend.on_host)
    arrays = _uploaded(prepared, opaque, style, backend)
    arrays["floor"], columns, rows = _floor(prepared, backend)
    arrays["tops"], highest = _tops(prepared, arrays, (columns, rows), style, backend)
    shadow = _set_shadow(prepared, arrays, style, backend, prepared.set_casters)
    count = prepared.static_faces
    sheet = backend.buffer((2 * max(count, 1) * shading.SHEET,), np.float32)
    shading.fold(
        *(arrays[name] for name in ("vertices", "normals", "faces", "color", "info", "light", "basis")),
        shadow.frame,
        shadow.size,
        shadow.depth,
        shadow.coarse,
        count,
        sheet,
    )
    chart = _chart(prepared, arrays, shadow, sheet, style, backend, shading)
    lamps = lamp_volume(
        opaque.static, opaque.static_object, scene.levels, scene.light.lamps, style, prepared.density, backend
    )
    cast = partial(_set_shadow, prepared, arrays, style, backend)
    sunlight = find_sunlight(prepared, arrays, opaque.light, style, backend, cast, chart)
    palette = int(opaque.joints.max()) + 1 if len(opaque.joints) else 0
    paper = paper_level(opaque.light), gloom(opaque.light)
    surfaces, extent = (shadow, sheet, chart, lamps, sunlight, prepared.density.values.shape), (columns, rows)
    moved, counts = (highest, Rig(prepared, opaque.wall_count)), (opaque.wall_count, people, palette)
    casting = casting_of(prepared, opaque, palette)
    for name in ("entry", "casters", "runs", "points", "point_end"):
        arrays[name] = backend.upload(getattr(casting, name))
    home = Home(prepared, casting, opaque.home, light_basis(np.array(opaque.light.sun)), TEXEL)
    return Loaded(prepared, arrays, glass, *surfaces, *extent, *moved, *counts, casting, home, paper)


def _chart(
    prepared: Prepared,
    arrays: dict[str, Any],
    shadow: ShadowMap,
    sheet: Any,
    style: Style,
    backend: Backend,
    shading: Any,
) -> Chart:
    """Which parts of the set's triangles its own shadow falls on."""
    from .kernels import chart  # only now: it imports taichi

    count = prepared.static_faces
    plot, begin, side = chart.plots(prepared.vertices, prepared.faces[:count])
    kinds = backend.buffer((max(int(begin[-1]), 1),), np.uint8)
    out = Chart(backend.upload(plot), backend.upload(begin), backend.upload(side), kinds)
    if style.shadows:
        shading.survey(
            *(arrays[name] for name in ("vertices", "normals", "faces", "light", "basis")),
            *(shadow.frame, shadow.size, shadow.depth, shadow.coarse),
            sheet,
            *(out.begin, out.side, count, kinds),
        )
    return out


def _uploaded(prepared: Prepared, scene: RenderScene, style: Style, backend: Backend) -> dict[str, Any]:
    up, volume = backend.upload, occlusion_volume(prepared.density)
    arrays = {name: up(getattr(prepared, name)) for name in UPLOADED}
    corners, pieces = np.concatenate([prepared.vertices, prepared.rest]), prepared.info[:, [0, 2]]
    arrays["beside"] = up(beside(corners, prepared.faces, pieces))
    arrays["joints"] = up(prepared.detail.scene.joints.astype(np.int32))
    arrays["weights"] = up(prepared.detail.scene.weights.astype(np.float32))
    arrays["light"] = up(packed_light(scene.light, style))
    if style.hatch:
        tones = paper_tones(prepared.color, prepared.info[:, 1] & 0xFF, scene.light)
        tones[prepared.info[:, 0] < prepared.moving_surface, 1] = -1.0  # doors and sashes with the set
        arrays["tone"] = up(tones)
    arrays["basis"] = up(light_basis(np.array(scene.light.sun)).astype(np.float32).reshape(-1))
    arrays["values"] = up(volume.values.reshape(-1))
    arrays["volume_low"] = up(np.array([*volume.low, 1.0 / volume.cell], np.float32))
    return arrays


def _floor(prepared: Prepared, backend: Backend) -> tuple[Any, int, int]:
    """The grid of floor cells on which people leave their contact shadow, its columns and rows."""
    low, high = (corner[:2] for corner in prepared.stage)
    low, high = low - 0.5, high + 0.5
    cell = max(FLOOR_CELL, float((high - low).max()) / FLOOR_CELLS)
    columns, rows = (int(n) for n in np.ceil((high - low) / cell) + 2)
    floor = np.array([*(low - cell), 1.0 / cell, *prepared.levels], np.float32)
    return backend.upload(floor), columns, rows


def _tops(
    prepared: Prepared, arrays: dict[str, Any], cells: tuple[int, int], style: Style, backend: Backend
) -> tuple[Any, float]:
    """How high the furniture is over each of these cells, and over which height nothing touches."""
    from .kernels import contact  # only now: it imports taichi

    tops = backend.upload(np.full(cells[0] * cells[1], contact.NOWHERE, np.float32))
    if style.occlusion:
        faces = (arrays["vertices"], arrays["faces"], prepared.static_faces)
        contact.find_tops(*faces, arrays["floor"], *cells, tops)
    furniture = float((tops if backend.on_host else tops.to_numpy()).max()) + contact.REACH[1]
    return tops, max(furniture, max(prepared.levels) + contact.REACH[0])


def _set_shadow(
    prepared: Prepared, arrays: dict[str, Any], style: Style, backend: Backend, casting: NDArray[np.int32]
) -> ShadowMap:
    """The shadow map of triangles of the set."""
    from .kernels import light  # only now: it imports taichi

    size, up = SET_SHADOW, backend.upload
    frame = up(np.array([[1e6, 1e6, 100.0]], np.float32))  # no map: out of reach
    if not len(casting) or not style.shadows:
        nothing = up(np.zeros(1, np.float32))
        return ShadowMap(1, frame, nothing, nothing)
    # only what casts, so that the map is not spent on the plain around
    used, corners = np.unique(prepared.faces[casting], return_inverse=True)
    vertices = up(prepared.vertices[used][None])
    faces = up(corners.reshape(-1, 3).astype(np.int32))
    casters = up(np.arange(len(casting), dtype=np.int32))
    depth = backend.buffer((size * size,), np.float32)
    coarse = backend.buffer((light.summary_size(size),), np.float32)
    spare = backend.buffer((light.summary_size(size),), np.float32)
    count, one = len(used), up(np.zeros(1, np.int32))
    things = (
        vertices,
        arrays["basis"],
        up(np.zeros(count, np.int32)),
        up(np.ones((1, 1), np.int32)),
        one,
        one,
    )
    points = (up(np.arange(count, dtype=np.int32)), up(np.array([count], np.int32)))
    light.fit(*things, *points, TEXEL, size, 1, frame, *backend.crew(1))
    runs = up(np.array([[0, 0, len(casting)]], np.int32))
    target = (frame, size, 1, depth, spare, coarse)
    light.cast_by(backend.crew(1), *things, faces, casters, runs, 0, *target)
    return ShadowMap(size, frame, depth, coarse)
