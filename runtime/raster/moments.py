"""What is done once for each moment, however many views look at it: skinning, bounds, shadows.

Assumes finite palettes. Guarantees that what is kept of a moment depends on its palette alone.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .device import Backend
from .loaded import Loaded
from .types import Style

SHADOW = 512  # texels along a moment's shadow map, for large pictures; half for small ones
LARGE = 400  # rows of a picture from which on it is large
TEXEL = 0.006  # metres, finest
OUT_OF_REACH = (1e6, 1e6, 100.0)  # frame of a map that is not there

Buffers = Callable[[str, tuple[int, ...], type], Any]


class Moments:
    """The moments that are drawn at a time, M of them, and one more in which nobody is there.

    position, normal: float32 [M + 1, V, 3] of skinned vertices; ball: float32 [M + 1, C, 4] bounds of moving
    clusters; of the last one of parts of the set alone, those that ``resting`` int32 [C] says, None without
    hinges: float32 [M, K, 3, 4], matrices of these parts; frame [M + 1, 3], size, depth, coarse: their shadow
    maps; ground: [M + 1, 2, rows, columns] how closely things stand over the floor, and over furniture
    """

    def __init__(self, backend: Backend, buffer: Buffers, style: Style) -> None:
        from .kernels import contact, geometry, light  # only now: they import taichi

        self._backend, self._buffer, self._style = backend, buffer, style
        self._geometry, self._light, self._contact = geometry, light, contact
        self.count, self.size = 1, 1

    def move(
        self,
        loaded: Loaded,
        palettes: NDArray[np.float32],
        height: int,
        wanted: Any,
        skinned: int,
        only: NDArray[np.int32] | None = None,
    ) -> None:
        """Take ``palettes`` as the moments, for pictures of ``height`` rows.

        wanted: int32 [C], 1 for clusters that some view may show; skinned: how many vertices are needed
        only: which ones, where neither shadows nor contact are asked for; None: all, and these as well
        """
        scene, a = loaded.scene, loaded.arrays
        clusters = len(scene.clusters) - scene.moving_first
        self._reserve(loaded, len(palettes), height, skinned, only is None)
        self.resting, self.hinges = None, palettes[:, scene.hinges]
        if not len(palettes):
            return
        moments, moved = len(palettes), (self.position, self.normal)
        if clusters or loaded.glass is not None:
            palette = self._backend.upload(palettes.astype(np.float32))
            rest = (a["rest"], a["rest_normals"], a["joints"], a["weights"])
            vertices = np.arange(skinned, dtype=np.int32) if only is None else only
            self._geometry.skin(palette, *rest, self._backend.upload(vertices), moments, *moved)
        if not clusters:
            return
        still = loaded.static_vertices
        places = (scene.moving_first, still, moments, self.position, self.ball)
        self._geometry.bound(a["faces"], a["clusters"], wanted, *places)
        self.resting = self._rest(loaded, palettes) if only is None else None
        if self.size > 1:
            self._cast(loaded, moments, skinned)
        if self._style.occlusion and only is None:
            spare = self._buffer("spare", (moments * loaded.rows * loaded.columns,), np.float32)
            floor = (a["floor"], a["tops"], loaded.columns, loaded.rows, spare, self.ground)
            crew = self._backend.crew(moments)
            self._contact.touch(self.position, a["area"], a["solid"], moments, *floor, *crew)

    def _rest(self, loaded: Loaded, palettes: NDArray[np.float32]) -> Any:
        """In the moment in which nobody is there, parts of the set that move, as they are in the first one.

        Returns which clusters these are, int32 [C]; None where there are none, and but on the host.
        """
        scene, a = loaded.scene, loaded.arrays
        if not self._backend.on_host or not len(scene.leaves):
            return None
        wanted = np.zeros(len(scene.clusters), np.int32)
        wanted[scene.moving_first : scene.loose_first] = 1
        here = slice(len(palettes), len(palettes) + 1)
        rest = (a["rest"], a["rest_normals"], a["joints"], a["weights"], scene.leaves, 1)
        first = np.ascontiguousarray(palettes[:1], np.float32)
        self._geometry.skin(first, *rest, self.position[here], self.normal[here])
        places = (scene.moving_first, loaded.static_vertices, 1, self.position[here], self.ball[here])
        self._geometry.bound(a["faces"], a["clusters"], wanted, *places)
        return wanted

    def _reserve(self, loaded: Loaded, palettes: int, height: int, skinned: int, lit: bool) -> None:
        """Buffers, and the moment in which nobody is there. lit: whether with shadow maps"""
        scene = loaded.scene
        moments, vertices = max(palettes, 1), max(skinned, 1)
        clusters = len(scene.clusters) - scene.moving_first
        self.position = self._buffer("position", (moments + 1, vertices, 3), np.float32)
        self.normal = self._buffer("normal", (moments + 1, vertices, 3), np.float32)
        self.ball = self._buffer("ball", (moments + 1, max(clusters, 1), 4), np.float32)
        texels = SHADOW if height > LARGE else SHADOW // 2
        self.size = texels if len(scene.casters) and palettes and self._style.shadows and lit else 1
        self.count = moments
        self.frame = self._buffer("frame", (moments + 1, 3), np.float32)
        self.depth = self._buffer("depth", (moments * self.size**2,), np.float32)
        summary = max(1, self._light.summary_size(self.size))
        self.coarse = self._buffer("coarse", (moments * summary,), np.float32)
        cells = loaded.rows * loaded.columns
        self.ground = self._buffer("ground", ((moments + 1) * 2 * cells,), np.float32)
        if self._backend.on_host:
            self.frame[0 if self.size == 1 else moments :] = OUT_OF_REACH
            self.ground[moments * 2 * cells :] = 0.0

    def _cast(self, loaded: Loaded, moments: int, skinned: int) -> None:
        """The shadow map of each moment."""
        scene, a, size = loaded.scene, loaded.arrays, self.size
        seen = self._buffer("seen", (moments, max(skinned, 1), 3), np.float32)
        blur = self._buffer("blur", (moments * self._light.summary_size(size),), np.float32)
        fitted = (TEXEL, size, scene.detail.vertices, moments, seen, self.frame)
        crew = self._backend.crew
        self._light.fit(self.position, a["basis"], *fitted, *crew(moments))
        kept = (self.frame, size, moments, self.depth, blur, self.coarse)
        self._light.cast(seen, a["faces"], a["casters"], loaded.static_vertices, *kept, *crew(moments))
