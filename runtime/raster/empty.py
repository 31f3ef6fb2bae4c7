"""The empty sets of cameras that stand still: drawn once, and taken over where nothing has changed.

An empty set is a view of the set and of the things in it that rest. For the host, and for rows of whole
runs. Guarantees the same bytes as views that are drawn anew.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter

from .device import Backend, vectorised
from .glazing import Box, Glazing
from .loaded import Loaded
from .moments import Moments
from .passes import Layer, Passes
from .visibility import Visibility

REUSED = 3  # views of one camera from which on the set is drawn once for all of them

Buffers = Callable[[str, tuple[int, ...], type], Any]


class EmptySets:
    """The empty sets of the views drawn last."""

    def __init__(self, backend: Backend, buffer: Buffers, passes: Passes, visibility: Visibility) -> None:
        from .kernels import reuse  # only now: it imports taichi

        self._crew, self._buffer = backend.crew, buffer
        self._passes, self._visibility = passes, visibility
        self._reuse, self._copy = reuse, vectorised(reuse.take_over)
        self._kept: tuple[tuple[int, int], bytes] | None = None  # what is drawn: size, cameras and walls

    def forget(self) -> None:
        """Draw them anew the next time: the scene, or the memory they are in, is gone."""
        self._kept = None

    def drawn_for(
        self,
        loaded: Loaded,
        moments: Moments,
        glazing: Glazing | None,
        seen: tuple[NDArray[np.float32], NDArray[np.int32]],
        size: tuple[int, int],
    ) -> NDArray[np.int32]:
        """Draw the empty sets that pay, once for all views of one camera and the same walls, with all things
        that are in all moments as they are at first.

        seen: views, hidden. Returns which empty set each view goes by, int32 [N]; -1 where it would not pay.
        """
        view, hidden = seen
        walls = hidden[:, : loaded.walls].astype(np.float32)
        key = np.ascontiguousarray(np.concatenate([view, walls], axis=1))
        _, first, of, count = np.unique(
            key, axis=0, return_index=True, return_inverse=True, return_counts=True
        )
        chosen = np.flatnonzero(count >= REUSED)
        number = np.full(len(count), -1, np.int32)
        number[chosen] = np.arange(len(chosen))
        wanted = (size, key[first[chosen]].tobytes() + moments.still)
        if len(chosen) and wanted != self._kept:
            self._kept = wanted
            self._draw(loaded, moments, glazing, view[first[chosen]], hidden[first[chosen]], size)
        return number[of.reshape(-1)]

    def _draw(
        self,
        loaded: Loaded,
        moments: Moments,
        glazing: Glazing | None,
        cameras: NDArray[np.float32],
        hidden: NDArray[np.int32],
        size: tuple[int, int],
    ) -> None:
        sets, passes = len(cameras), self._passes
        layer = passes.layer("empty_", sets, size)
        moment = np.full(sets, moments.count, np.int32)  # in which nobody is there
        self._visibility.fill_empty(cameras, moment, hidden, layer.vis, size)
        layer.level.fill(passes.SHADE)
        passes.shade(loaded, moments, layer, (cameras, moment, sets), size)
        pixels = sets * size[0] * size[1]
        self._shaded = self._buffer("empty_shaded", (pixels,), np.uint32)
        self._shaded[:pixels] = layer.picture[:pixels]
        passes.draw_lines(loaded, layer, cameras, sets, size)
        if glazing is not None:
            box, _ = glazing.boxes(cameras, np.zeros_like(moment), hidden, size)
            glazing.lay(passes, moments, layer, (cameras, moment, hidden, box), size, True, movers=False)
        self._final = self._buffer("empty_final", (pixels * 3,), np.uint8)
        passes.even_out(loaded, moments, layer, (cameras, moment, sets), self._final[: pixels * 3], size)
        tiles = sets * -(-size[1] // self._reuse.BAND) * -(-size[0] // passes.run)
        self._reach = self._buffer("reach", (tiles * self._reuse.REACH,), np.float32)
        crew = self._crew(sets * -(-size[1] // self._reuse.BAND))
        a, chart, sun = loaded.arrays, loaded.chart, loaded.sunlight
        of_set = (loaded.sheet, loaded.scene.static_faces, chart.plot, chart.begin, chart.side, chart.kinds)
        through = (chart.begin, chart.side, chart.kinds, chart.kinds)
        if sun is not None:
            through = (sun.begin, sun.side, sun.chart, sun.whole)
        ground = (a["floor"], a["tops"], loaded.columns, loaded.rows)
        parts = (a["faces"], loaded.static_vertices, moments.normal, moments.position, moments.count)
        told = (a["basis"], *of_set, int(sun is not None), *through, *parts, a["light"], *ground)
        self._reuse.reach_of(cameras, layer.vis, *told, sets, *size, self._reach, *crew)
        blocks = sets * -(-size[1] // passes.run) * -(-size[0] // passes.run)
        self._wide = self._buffer("wide_reach", (blocks * self._reuse.REACH,), np.float32)
        self._reuse.widen(self._reach, sets, *size, self._wide)

    def take_over(
        self,
        loaded: Loaded,
        moments: Moments,
        layer: Layer,
        seen: tuple[NDArray[np.int32], NDArray[np.int32], Box],
        size: tuple[int, int],
        color: NDArray[np.uint8],
        whole: bool,
    ) -> None:
        """Copy what is as in the empty sets, and note in ``layer.level`` what is left to do.

        seen: the moment of each view, what :meth:`drawn_for` returned, and where glass may move; whole:
        complete pictures, unsmoothed
        """
        (moment, empty, box), shadows = seen, moments.shadows
        source = self._passes.layer("empty_", int(empty.max()) + 1, size)
        run, views, a = self._passes.run, len(empty), loaded.arrays
        block = self._buffer("block", (views * -(-size[1] // run) * -(-size[0] // run),), np.int32)
        bounds = moments.ground.bounds(moments.count)
        cells, bands = (loaded.columns, loaded.rows), views * -(-size[1] // run)
        self._reuse.find(
            moment,
            empty,
            layer.vis,
            source.vis,
            self._visibility.touched,
            self._reach,
            self._wide,
            *(shadows.frame, shadows.size, shadows.coarse, shadows.each),
            *(shadows.home, shadows.home_frame, shadows.home_size, shadows.home_changed),
            a["floor"],
            *cells,
            moments.ground.cells,
            moments.count,
            bounds,
            box,
            views,
            *size,
            layer.level,
            block,
            *self._crew(bands),
        )
        runs = size[0] // run
        if around := self._passes.looks_around(size[1]):
            self._widen(around, layer.level, block, views, size)
        copied = self._buffer("copied", (views * runs * size[1],), np.int32)
        crew = self._crew(bands)
        self._reuse.settle(block, int(whole), views, *size, layer.level, copied, *crew)
        colors = (self._shaded, source.edge, source.picture, layer.picture, layer.edge)
        shaded, edge, inked, picture_to, edge_to = (x[: len(x) // run * run].reshape(-1, run) for x in colors)
        self._copy(
            empty,
            copied,
            shaded,
            edge,
            source.solid,
            inked,
            source.marks,
            self._final[: len(self._final) // 48 * 48].view(np.uint32).reshape(-1, 4),
            picture_to,
            edge_to,
            layer.solid,
            layer.marks,
            color.reshape(-1).view(np.uint32).reshape(-1, 4),
            views,
            runs,
            size[1],
            *self._crew(views * size[1]),
        )

    def _widen(self, around: int, level: Any, block: Any, views: int, size: tuple[int, int]) -> None:
        """Draw what is so many pixels from tiles that are drawn anew as well, as it may go by these."""
        band, runs = self._reuse.BAND, size[0] // self._passes.run
        assert band == self._passes.run  # a block is a tile
        rows = level[: views * size[1] * runs].reshape(views, size[1], runs)
        tiles = rows[:, ::band] == self._passes.SHADE
        side = 2 * -(-around // band) + 1
        near = maximum_filter(tiles, (1, side, side))
        rows[np.repeat(near & ~tiles, band, axis=1)[:, : size[1]]] = self._passes.SHADE
        block[: near.size] = near.reshape(-1)
