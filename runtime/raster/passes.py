"""The passes from a visibility buffer to finished bytes: shade, dress, ink, smooth.

Assumes filled visibility buffers. Guarantees that a run of pixels whose level says so is left as it is, and
that a view comes out the same whatever else is in its batch.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .device import Backend, vectorised
from .film import film_table, to_encoded, to_linear
from .loaded import Loaded
from .moments import Moments
from .types import GUIDE_SIDE, Probed, Style

#: Rows of a picture above which its edges are drawn to a part of a pixel.
FINE = 360
Buffers = Callable[[str, tuple[int, ...], type], Any]


@dataclass(frozen=True, eq=False)
class Layer:
    """Buffers of views that are drawn together, all flat.

    vis: visibility, uint64; picture: uint32 colours; edge: uint32, what lines are drawn from; and for each
    run of pixels solid, marks (see the kernels) and level (what is left to do), int32
    """

    vis: Any
    picture: Any
    edge: Any
    solid: Any
    marks: Any
    level: Any


class Passes:
    """The passes of one style over one scene. run: pixels in a run; film, linear, table: tables of colours"""

    def __init__(self, backend: Backend, buffer: Buffers, style: Style) -> None:
        from .kernels import (
            edges,
            grain,
            hatch,
            ink,
            paint,
            pattern,
            rows,
            shading,
            smooth,
            sunlight,
        )  # only now: they import taichi

        self._backend, self._buffer, self._style = backend, buffer, style
        self._hatch, self._grain, self._edges, self._smooth = hatch, grain, edges, smooth
        self._grain_runs = vectorised(grain.grain_runs) if backend.on_host else None
        self._smooth_runs = vectorised(smooth.smooth_runs)
        self._sunlight = sunlight
        self._rows, self._upload = rows, backend.upload
        self._match_runs = vectorised(rows.match_runs) if backend.on_host else None
        self.SHADE: int = paint.SHADE
        self.shading = shading.shading_kernels(style)
        self._ink = ink.ink_kernels(style)
        self._ink_runs = vectorised(self._ink.runs) if backend.on_host else None
        self.run: int = self.shading.RUN
        table = np.round(to_encoded(np.arange(4096) / 4095.0) * 255.0).astype(np.uint32)
        self.film = backend.upload(film_table())
        self.linear = backend.upload(to_linear(np.arange(256) / 255.0).astype(np.float32))
        self.table = backend.upload(table)
        self._lattice = backend.upload(pattern.noise_lattice())

    def layer(self, name: str, views: int, size: tuple[int, int]) -> Layer:
        """Buffers for drawing some views; those of one name are the same memory."""
        pixels = views * size[0] * size[1]
        runs = views * size[1] * -(-size[0] // self.run)
        return Layer(
            self._buffer(name + "vis", (pixels,), np.uint64),
            self._buffer(name + "picture", (pixels,), np.uint32),
            self._buffer(name + "edge", (pixels,), np.uint32),
            self._buffer(name + "solid", (runs,), np.int32),
            self._buffer(name + "marks", (runs,), np.int32),
            self._buffer(name + "level", (runs,), np.int32),
        )

    def shade(
        self,
        loaded: Loaded,
        moments: Moments,
        layer: Layer,
        seen: tuple[Any, Any, int],
        size: tuple[int, int],
    ) -> None:
        """Light, and the patterns of materials or strokes. seen: views, moments, how many views"""
        view, moment, views = seen
        a, scene = loaded.arrays, loaded.scene
        lines, between = self._rows.planned(views, size[1])
        left = self._buffer("left", (views * size[1] * -(-size[0] // self.run),), np.int32)
        self._shade_rows(loaded, moments, layer, seen, size, lines, left, False)
        if len(between):
            self._match(loaded, layer, between, left, size)
            lines = np.ascontiguousarray(between[:, 0])
            self._shade_rows(loaded, moments, layer, seen, size, lines, left, True)
        extent = (views, *size)
        if self._style.hatch:
            places = (a["vertices"], a["rest"], moments.position, a["faces"])
            counts = (scene.static_faces, loaded.static_vertices)
            paper = (a["tone"], *loaded.paper, self._lattice)
            strokes = (layer.vis, layer.edge, layer.solid, layer.level, layer.picture)
            rows = self._backend.crew(views * size[1])
            self._hatch.hatch_rows(view, moment, *places, *counts, *paper, *strokes, *extent, *rows)
        elif not self._style.clay:
            self._lay_grain(loaded, layer, view, extent)

    def _lay_grain(self, loaded: Loaded, layer: Layer, view: Any, extent: tuple[int, int, int]) -> None:
        """Patterns of materials, over the shaded picture."""
        sheet = (loaded.sheet, loaded.scene.static_faces, self._lattice)
        runs, run, crew = (layer.solid, layer.level), self.run, self._backend.crew(extent[0] * extent[2])
        if self._grain_runs is None or extent[1] % run:
            self._grain.grain_rows(view, *sheet, layer.vis, *runs, layer.picture, *extent, *crew)
            return
        scratch = self._buffer("graining", (self._backend.threads * self._grain.SCRATCH * run,), np.float32)
        seen, picture = (x[: len(x) // run * run].reshape(-1, run) for x in (layer.vis, layer.picture))
        wide, word = (scratch.view(kind).reshape(-1, run) for kind in (np.float32, np.uint32))
        memory = (scratch, wide, word)
        self._grain_runs(
            view, *sheet, layer.vis, seen, *runs, picture, *memory, *extent, *crew[:2], self._backend.threads
        )

    def _shade_rows(
        self,
        loaded: Loaded,
        moments: Moments,
        layer: Layer,
        seen: tuple[Any, Any, int],
        size: tuple[int, int],
        lines: NDArray[np.int32],
        left: Any,
        sparse: bool,
    ) -> None:
        """Light of some rows, and what falls on them through windows. sparse: only of what is left"""
        view, moment, _ = seen
        a, scene = loaded.arrays, loaded.scene
        rows = (self._upload(lines), int(sparse), left)
        self.shading.rows(
            view,
            moment,
            a["vertices"],
            a["normals"],
            moments.position,
            moments.normal,
            a["faces"],
            a["color"],
            a["info"],
            loaded.sheet,
            loaded.chart.plot,
            loaded.chart.begin,
            loaded.chart.side,
            loaded.chart.kinds,
            scene.static_faces,
            loaded.static_vertices,
            a["light"],
            a["basis"],
            loaded.shadow.frame,
            loaded.shadow.size,
            loaded.shadow.depth,
            loaded.shadow.coarse,
            *moments.shadows.maps,
            *loaded.cells,
            a["volume_low"],
            a["values"],
            loaded.lamps,
            a["floor"],
            a["tops"],
            loaded.columns,
            loaded.rows,
            moments.ground.cells,
            self.film,
            self._lattice,
            layer.vis,
            layer.picture,
            layer.edge,
            layer.solid,
            layer.level,
            *rows,
            *size,
            *self._backend.crew(len(lines)),
        )
        if loaded.sunlight is not None:
            self._lay_sunlight(loaded, moments, layer, seen, rows, size)

    def _match(
        self, loaded: Loaded, layer: Layer, rows: NDArray[np.int32], left: Any, size: tuple[int, int]
    ) -> None:
        """Colours of rows that lie between shaded ones; ``left``: what cannot be had from those."""
        width, run, crew = size[0], self.run, self._backend.crew(len(rows))
        if self._match_runs is not None and width % run == 0:
            buffers = (layer.vis, layer.picture, layer.edge)
            wide = (x[: len(x) // run * run].reshape(-1, run) for x in buffers)
            named = (loaded.arrays["info"], loaded.arrays["one_color"])
            self._match_runs(
                rows, *named, *buffers, *wide, layer.solid, layer.level, left, width // run, *crew
            )
        else:
            kept = (layer.vis, layer.picture, layer.edge, layer.solid, layer.level)
            named = (loaded.arrays["info"], loaded.arrays["one_color"])
            self._rows.match_rows(self._upload(rows), *named, *kept, left, width, *crew)

    def _lay_sunlight(
        self,
        loaded: Loaded,
        moments: Moments,
        layer: Layer,
        seen: tuple[Any, Any, int],
        rows: tuple[Any, int, Any],
        size: tuple[int, int],
    ) -> None:
        """What falls through windows, over shaded rows."""
        sun, a, (view, moment, _) = loaded.sunlight, loaded.arrays, seen
        assert sun is not None
        self._sunlight.lay_sun(
            view,
            moment,
            *(loaded.sheet, a["light"], sun.color, a["basis"]),
            *(sun.shadow.frame, sun.shadow.size, sun.shadow.depth, sun.shadow.coarse),
            *moments.shadows.maps,
            *(sun.plot, sun.begin, sun.side, sun.chart, sun.whole, loaded.scene.static_faces),
            *(self.linear, self.table, layer.vis, layer.level, layer.solid, layer.picture),
            *rows,
            *size,
            *self._backend.crew(rows[0].shape[0]),
        )

    def looks_around(self, height: int) -> int:
        """How many pixels away what is shaded in a pixel may go by, in pictures so high."""
        return int(self._hatch.looks_around(height)) if self._style.hatch else 0

    def draw_lines(self, loaded: Loaded, layer: Layer, view: Any, views: int, size: tuple[int, int]) -> None:
        """Ink, and marks where something ends."""
        a, lookup = loaded.arrays, (self.linear, self.table)
        first, kept = loaded.scene.moving_surface, (layer.marks, layer.level)
        seen = (view, layer.picture, layer.edge, layer.vis)
        crew = self._backend.crew
        lines = views * size[1]
        if self._ink_runs is None or size[0] % self.run:
            named = (a["surface_object"], a["one_color"], first)
            self._ink.rows(*seen, layer.solid, *named, *lookup, *kept, views, *size, *crew(lines))
            return
        pixels = views * size[0] * size[1]
        found = self._found(views, size)
        vis, edge = layer.vis[:pixels], layer.edge[:pixels]
        words, numbers = (vis.view(kind).reshape(-1, self.run) for kind in (np.int32, np.float32))
        memory = (words, numbers, edge.view(np.int32).reshape(-1, self.run), layer.solid)
        named = (a["surface_object"], a["one_color"], first)
        told = (int(self._tells_kinds(size)), found, self._kinds(views, size), *kept)
        self._ink_runs(*seen, *memory, *named, *lookup, *told, views, *size, *crew(lines)[:2])

    def _tells_kinds(self, size: tuple[int, int]) -> bool:
        """Whether lines and edges are found by the same look at borders."""
        return (
            self._ink_runs is not None and self._style.outline and not size[0] % self.run and size[1] > FINE
        )

    def _found(self, views: int, size: tuple[int, int]) -> Any:
        """Where lines may be and what moves, three words of a run (``borders.find_borders``)."""
        return self._buffer("found", (3 * views * size[0] * size[1] // self.run,), np.int32)

    def _kinds(self, views: int, size: tuple[int, int]) -> Any:
        """What ends or bends beside each pixel, two words of a run, where that is told."""
        runs = views * size[1] * (size[0] // self.run) if self._tells_kinds(size) else 1
        return self._buffer("kinds", (2 * runs,), np.int32)

    def even_out(
        self,
        loaded: Loaded,
        moments: Moments,
        layer: Layer,
        seen: tuple[Any, Any, int],
        color: NDArray[np.uint8],
        size: tuple[int, int],
    ) -> None:
        """Smoothed bytes into ``color``. seen: views, moments, how many views"""
        a, scene, views = loaded.arrays, loaded.scene, seen[2]
        counts, lines = (scene.static_faces, loaded.static_vertices), views * size[1]
        fine = size[1] > FINE
        edges = self._buffer("edges", (lines * size[0] if fine else 1,), np.int32)
        if fine:
            meshes = (a["vertices"], moments.position, a["faces"], a["beside"], *counts)
            told = (int(self._tells_kinds(size)), self._kinds(views, size))
            shown = (layer.vis, layer.edge, layer.picture, layer.marks, layer.level, *told)
            extent = (views, *size)
            self._edges.find_edges(*seen[:2], *meshes, *shown, edges, *extent, *self._backend.crew(lines))
        shapes = (scene.moving_surface, layer.edge, edges, int(fine))
        final, runs = color.reshape(-1), (layer.marks, layer.level, self.linear, self.table)
        crew = self._backend.crew(views * size[1])
        if not self._backend.on_host or size[0] % self.run:
            self._smooth.smooth_rows(*shapes, layer.picture, *runs, final, views, *size, *crew)
            return
        run, kernels = self.run, self._smooth
        scratch = self._buffer("smoothing", (self._backend.threads * kernels.SCRATCH * run,), np.float32)
        # the buffer may be longer, from a picture of another width
        picture = layer.picture[: len(layer.picture) // run * run]
        self._smooth_runs(
            *shapes,
            self._found(views, size),
            picture,
            picture.view(np.int32).reshape(-1, run),
            picture.view(np.uint8).reshape(-1, run),
            *runs,
            scratch.reshape(-1, run),
            scratch.view(np.int32).reshape(-1, run),
            scratch,
            final,
            final.reshape(-1, run),
            views,
            *size,
            *crew[:2],
            self._backend.threads,
        )

    def object_ids(self, loaded: Loaded, layer: Layer, objects: NDArray[np.int32]) -> None:
        """Which object each pixel shows, into ``objects`` [N, H, W]."""
        out = objects.reshape(-1)
        self._smooth.object_ids(layer.edge, loaded.arrays["surface_object"], out, len(out))

    def guides(
        self,
        loaded: Loaded,
        vis: Any,
        roles: NDArray[np.uint8],
        size: tuple[int, int],
        out: NDArray[np.uint8],
    ) -> None:
        """What visibility buffers show cell by cell, into ``out`` (see ``types.GUIDES``)."""
        from .kernels import guides  # only where they are asked for: it is compiled then

        a, role = loaded.arrays, self._backend.upload(np.ascontiguousarray(roles).reshape(-1))
        tables = (a["info"], a["surface_object"], a["head"], role, roles.shape[1])
        cells = self._backend.buffer((out.size,), np.uint8)
        guides.gather_guides(vis, *tables, len(out), *size, GUIDE_SIDE, cells)
        out.reshape(-1)[:] = cells if self._backend.on_host else cells.to_numpy()

    def probe(
        self,
        loaded: Loaded,
        vis: Any,
        roles: NDArray[np.uint8],
        pixels: NDArray[np.int32],
        size: tuple[int, int],
        out: Probed,
    ) -> None:
        """What pixels [N, K] of visibility buffers show (see ``Renderer.render``), into ``out``."""
        from .kernels import guides  # only where they are asked for: it is compiled then

        a, up = loaded.arrays, self._backend.upload
        role = up(np.ascontiguousarray(roles).reshape(-1))
        first = np.arange(len(pixels), dtype=np.int32)[:, None] * np.int32(size[0] * size[1])
        flat = up(np.where(pixels < 0, np.int32(-1), pixels + first).reshape(-1))
        near, seen = (self._backend.buffer((pixels.size,), kind) for kind in (np.float32, np.uint8))
        tables = (a["info"], a["surface_object"], role, roles.shape[1])
        guides.probe(vis, *tables, flat, pixels.shape[1], pixels.size, near, seen)
        for found, here in ((near, out.near), (seen, out.role)):
            here.reshape(-1)[:] = found if self._backend.on_host else found.to_numpy()

    def objects_seen(self, loaded: Loaded, layer: Layer, objects: NDArray[np.int32]) -> None:
        """The same as :meth:`object_ids` of what was not shaded."""
        from .kernels import plain  # only where it is asked for

        a, out = loaded.arrays, objects.reshape(-1)
        plain.ids_seen(layer.vis, a["info"], a["surface_object"], out, len(out))
