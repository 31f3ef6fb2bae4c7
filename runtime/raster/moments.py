"""What is done once for each moment, however many views look at it: skinning, bounds, shadows, contact.

Assumes finite palettes. Guarantees that what is kept of a moment depends on its palette alone.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .detail import COUNT, FINEST
from .device import Backend, vectorised
from .ground import Ground
from .loaded import Loaded
from .resting import Lists, Taken, lists_of, needed
from .shadows import Shadows
from .types import Style

Buffers = Callable[[str, tuple[int, ...], type], Any]


class Moments:
    """The moments that are drawn at a time, M of them, and one more in which nobody is there, but only what
    rests.

    position, normal: float32 [M + 1, V, 3] of skinned vertices
    wanted: int32 [M, C], 1 for moving clusters that some view of a moment may show; rests: int32 [C], 1 for
    those that are in all moments as in the first one, where alone they are wanted; ball: float32
    [M + 1, C, 4], bounds of the wanted ones; taken: int32 [C], 1 for those of the last moment, things that
    rest, None without; still: what says how it looks, for whoever keeps pictures of it
    shadows: what falls into their light; ground: what stands on the floor and on furniture
    """

    def __init__(self, backend: Backend, buffer: Buffers, style: Style) -> None:
        from .kernels import geometry, skinning  # only now: they import taichi

        self._backend, self._buffer, self._style = backend, buffer, style
        self._geometry, self._skinning = geometry, skinning
        self._blend = vectorised(skinning.skin_blended) if backend.on_host else None
        self.count, self.shadows, self.ground = 1, Shadows(backend, buffer), Ground(backend, buffer)
        nothing = np.zeros((1, 1), np.int32)
        self.wanted, self.rests = backend.upload(nothing), backend.upload(nothing[0])
        self.taken: NDArray[np.int32] | None = None
        self.still = b""

    def move(
        self,
        loaded: Loaded,
        palettes: NDArray[np.float32],
        height: int,
        hidden: NDArray[np.int32],
        lit: bool,
    ) -> None:
        """Take ``palettes`` as the moments, for pictures of ``height`` rows.

        hidden: int32 [M, W], 0 for what some view of a moment may show; lit: whether shadows and contact are
        asked for
        """
        scene, up = loaded.scene, self._backend.upload
        clusters = len(scene.clusters) - scene.moving_first
        levels = hidden[:, loaded.walls + loaded.people : hidden.shape[1] - 1]
        shown = (levels == 0).reshape(len(levels), -1, COUNT)
        finest = bool(shown[..., FINEST].any())
        skinned = len(scene.rest) if finest else scene.detail.vertices
        self._reserve(loaded, len(palettes), height, skinned, lit)
        self.taken, self.still = None, b""
        if not len(palettes) or not (clusters or loaded.glass is not None):
            return
        moments = len(palettes)
        moving, restless = loaded.rig.moves(palettes)
        masks, which = needed(scene.detail, shown, lit)
        self._skin(loaded, palettes, masks, which, moving)
        if not clusters:
            return
        wall = scene.clusters[scene.moving_first :, 3]
        wanted = (wall < 0) | (hidden[:, wall] == 0)
        wanted[0] |= wanted.any(axis=0) & ~restless
        wanted[1:] &= restless
        self.wanted, self.rests = up(wanted.astype(np.int32)), up((~restless).astype(np.int32))
        self._bound(loaded, self.wanted, moments, self.position, self.ball)
        taken = self._rest(loaded, palettes, restless) if lit and self._backend.on_host else None
        self.shadows.cast(loaded, self.position, palettes, None if taken is None else taken.entries)
        if self._style.occlusion and lit:
            self.ground.count(loaded, self.position, moments, moving)
        if lit and self._backend.on_host:
            rest: list[NDArray[Any]] = [self.ground.of(moments)]
            rest += [] if taken is None else [taken.clusters, palettes[0, taken.entries]]
            self.still = b"".join(np.ascontiguousarray(part).tobytes() for part in rest)

    def _skin(
        self,
        loaded: Loaded,
        palettes: NDArray[np.float32],
        masks: NDArray[np.bool_],
        which: NDArray[np.int32],
        moving: NDArray[np.bool_],
    ) -> None:
        """Move the vertices that each moment needs; masks [L, V], which [M]: of :func:`needed`."""
        still = masks & ~moving
        self._blended(loaded, palettes, lists_of(masks & moving, which), self.position, self.normal)
        everywhere = lists_of(np.any(still, axis=0, keepdims=True), np.zeros(1, np.int32))
        if everywhere.empty:
            return
        self._blended(loaded, palettes[:1], everywhere, self.position, self.normal)
        lists, up = lists_of(still, which), self._backend.upload
        told = (up(lists.vertices), up(lists.begin), up(lists.which))
        self._skinning.repeat(*told, 0, len(palettes), self.position, self.normal)

    def _blended(
        self, loaded: Loaded, palettes: NDArray[np.float32], lists: Lists, position: Any, normal: Any
    ) -> None:
        """Skin the vertices of lists in their moments."""
        if lists.empty:
            return
        a, up, moments = loaded.arrays, self._backend.upload, len(palettes)
        rest = (a["rest"], a["rest_normals"], a["joints"], a["weights"])
        told = (up(lists.vertices), up(lists.begin), up(lists.which), moments)
        if self._blend is None:
            matrices = up(palettes.astype(np.float32))
            self._skinning.skin(matrices, *rest, *told, position, normal)
            return
        lanes, entries, workers = self._skinning.LANES, palettes.shape[1], self._backend.threads
        wide = self._buffer("matrices", (moments * entries * lanes,), np.float32)
        wide[: moments * entries * lanes].reshape(-1, lanes)[:, :12] = palettes.reshape(-1, 12)
        work = self._buffer("blends", (workers * lanes,), np.float32)
        memory = (work.reshape(-1, lanes), work)
        crew = self._backend.crew(moments * self._skinning.PARTS)[:2]
        matrices = wide.reshape(-1, lanes)
        self._blend(matrices, entries, *rest, *told, *memory, position, normal, *crew, workers)

    def _bound(self, loaded: Loaded, wanted: Any, moments: int, position: Any, ball: Any) -> None:
        a, first = loaded.arrays, loaded.scene.moving_first
        places = (first, loaded.static_vertices, moments, position, ball)
        self._geometry.bound(a["faces"], a["clusters"], wanted, *places)

    def _rest(
        self, loaded: Loaded, palettes: NDArray[np.float32], restless: NDArray[np.bool_]
    ) -> Taken | None:
        """In the moment in which nobody is there, the things that rest, as they are in the first one. Host
        only."""
        taken = loaded.rig.taken(restless)
        if taken is None:
            return None
        here = slice(len(palettes), len(palettes) + 1)
        whole = np.array([0, len(taken.vertices)], np.int32)
        lists = Lists(taken.vertices, whole, np.zeros(1, np.int32))
        self._blended(loaded, palettes[:1], lists, self.position[here], self.normal[here])
        self.taken = taken.clusters.astype(np.int32)
        return taken

    def _reserve(self, loaded: Loaded, palettes: int, height: int, skinned: int, lit: bool) -> None:
        """Buffers, and the moment in which nobody is there. lit: whether with shadow maps"""
        scene = loaded.scene
        moments, vertices = max(palettes, 1), max(skinned, 1)
        clusters = len(scene.clusters) - scene.moving_first
        self.position = self._buffer("position", (moments + 1, vertices, 3), np.float32)
        self.normal = self._buffer("normal", (moments + 1, vertices, 3), np.float32)
        self.ball = self._buffer("ball", (moments + 1, max(clusters, 1), 4), np.float32)
        self.count = moments
        self.shadows.reserve(loaded, moments, height, bool(palettes) and self._style.shadows and lit)
        self.ground.reserve(loaded.rows, loaded.columns, moments)
        if not (clusters and palettes):
            self.ground.clear()  # another scene may have left something
