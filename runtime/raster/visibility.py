"""What each pixel of each view sees: triangles into visibility buffers.

On the host sixteen triangles and sixteen pixels are worked on at a time, each band of rows by one thread
(``kernels/gather.py``, ``kernels/spans.py``); elsewhere a few threads share a triangle and fill with atomic
maxima (``kernels/geometry.py``). Both give the same buffers.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from .device import Backend, vectorised

BAND_PIXELS = 100_000  # of a band of rows that one thread fills, 8 bytes each: what its cache holds
Buffers = Callable[[str, tuple[int, ...], type], Any]


class Triangles(Protocol):
    """What is read of a scene here, as in :class:`runtime.raster.prepare.Prepared`."""

    @property
    def vertices(self) -> NDArray[np.float32]: ...
    @property
    def faces(self) -> NDArray[np.int32]: ...
    @property
    def static_faces(self) -> int: ...
    @property
    def clusters(self) -> NDArray[np.int32]: ...
    @property
    def moving_first(self) -> int: ...
    @property
    def most_drawn(self) -> int: ...


class Visibility:
    """Fills visibility buffers of one scene; ``buffer`` gives kept memory by name, shape and type.

    name: what its own memory is called, if several are at work
    """

    def __init__(self, backend: Backend, buffer: Buffers, name: str = "") -> None:
        from .kernels import geometry

        self._backend = backend
        self._buffer: Buffers = lambda of, shape, dtype: buffer(name + of, shape, dtype)
        self._geometry = geometry
        if backend.on_host:
            from .kernels import gather, spans

            self._kernels = gather
            self._gather, self._paint = vectorised(gather.gather), vectorised(spans.paint)

    def load(self, scene: Triangles, arrays: dict[str, Any]) -> None:
        """Make ``scene`` the one that is drawn; ``arrays`` are its arrays where kernels can use them."""
        self._scene, self._arrays = scene, arrays
        if self._backend.on_host:
            vertices = arrays["vertices"].reshape(1, -1, 3)
            count = scene.moving_first
            wanted = np.ones((1, count + 1), np.int32)
            self._still = self._buffer("still", (max(count, 1) * self._each,), np.float32)
            self._arrange(self._still, wanted, (0, count), 0, 1, vertices)

    def move(
        self, position: Any, ball: Any, wanted: Any, rests: Any, moments: int, taken: Any = None
    ) -> None:
        """Take over the skinned vertices [M, V, 3] and the bounds of the moving clusters [M, C, 4].

        wanted: int32 [M, C], 1 where some view may show a cluster; rests: int32 [C], 1 for those that are
        wanted in the first moment alone, and taken over from it; taken: int32 [C], 1 for those of these that
        are in the sets that views begin from, None for none
        """
        self._position, self._ball, self._rests = position, ball, rests
        self._taken = np.zeros(rests.shape, np.int32) if taken is None else taken
        scene = self._scene
        if self._backend.on_host:
            part = (scene.moving_first, len(scene.clusters) - scene.moving_first)
            each = part[1] * self._each
            self._moving = self._buffer("moving", (max(moments, 1) * max(each, self._each),), np.float32)
            self._arrange(self._moving, wanted, part, len(scene.vertices), moments, position)

    @property
    def _each(self) -> int:
        """Numbers of the corners of a cluster as they are arranged."""
        return int(self._kernels.GROUPS * self._kernels.CORNERS * self._kernels.LANES)

    def _arrange(
        self, out: Any, wanted: Any, part: tuple[int, int], offset: int, moments: int, vertices: Any
    ) -> None:
        """Corners of clusters (first, count), for vectors: [M, count, GROUPS, CORNERS, LANES], flat."""
        if moments * part[1]:
            a = self._arrays
            self._kernels.arrange(a["faces"], a["clusters"], wanted, *part, offset, moments, vertices, out)

    def fill_empty(self, view: Any, moment: Any, hidden: Any, vis: Any, size: tuple[int, int]) -> None:
        """Fill the visibility buffers of views of the set and of what is taken into it, and remember them.
        Host only."""
        part = np.tile(np.array([0, len(self._scene.clusters)], np.int32), (len(view), 1))
        which = np.full(len(view), self._kernels.TAKEN, np.int32)
        self._fill_bands(view, moment, hidden, vis, size, (part, which), None)

    def fill(
        self,
        view: Any,
        moment: Any,
        hidden: Any,
        vis: Any,
        size: tuple[int, int],
        empty: NDArray[np.int32],
        serial: bool,
        movers: bool = True,
    ) -> None:
        """Fill the visibility buffers of views, flat.

        empty: int32 [N], which of the remembered views each begins from, -1: from nothing (the only way
        unless ``serial``); serial: whether each band of a view is filled by one thread (the host) or each
        triangle by several; movers: also what moves, always so unless ``serial``
        """
        views = len(empty)
        if serial:
            last = len(self._scene.clusters) if movers else self._scene.moving_first
            part = np.tile(np.array([0, last], np.int32), (views, 1))
            part[empty >= 0, 0] = self._scene.moving_first
            which = np.where(empty >= 0, self._kernels.OTHERS, self._kernels.EVERY).astype(np.int32)
            self._fill_bands(view, moment, hidden, vis, size, (part, which), empty)
            return
        scene, a = self._scene, self._arrays
        self._geometry.clear(vis, views * size[0] * size[1])
        self._geometry.raster_atomic(
            view,
            moment,
            hidden,
            a["vertices"],
            self._position,
            a["faces"],
            a["info"],
            scene.static_faces,
            len(scene.vertices),
            vis,
            views,
            *size,
        )

    def _fill_bands(
        self,
        view: Any,
        moment: Any,
        hidden: Any,
        vis: Any,
        size: tuple[int, int],
        drawn: tuple[NDArray[np.int32], NDArray[np.int32]],
        empty: NDArray[np.int32] | None,
    ) -> None:
        """Fill from the clusters in ``drawn``: from which to which [N, 2], and which of the moving ones [N];
        empty: None for sets alone, else as in :meth:`fill`."""
        scene, a, kernels, views = self._scene, self._arrays, self._kernels, len(drawn[0])
        width, height = size
        lanes, most = kernels.LANES, max(scene.most_drawn, 1)  # a triangle leaves two at most
        work = self._buffer("work", (views * (kernels.CORNERS + 1) * lanes,), np.float32)
        corner = self._buffer("corner", (views * 2 * most * kernels.CORNERS,), np.float32)
        tag = self._buffer("tag", (views * 2 * most * kernels.TAGS,), np.int32)
        clipped = self._buffer("clipped", (views * most,), np.int32)
        counts = self._buffer("counts", (views, 2), np.int32)
        extent = self._buffer("extent", (views * -(-2 * most // kernels.BUNDLE) * 2,), np.int32)
        self._gather(
            view,
            moment,
            hidden,
            a["clusters"],
            a["sphere"],
            self._ball,
            scene.moving_first,
            self._rests,
            self._taken,
            *drawn,
            self._still.reshape(-1, lanes),
            self._moving.reshape(-1, lanes),
            work.reshape(-1, lanes),
            work,
            corner,
            tag,
            clipped,
            counts,
            most,
            views,
            width,
            height,
            *self._backend.crew(views),
        )
        groups = -(-width // lanes)
        rows = max(
            1, min(BAND_PIXELS // (groups * lanes), -(-height * views // self._backend.threads), height)
        )
        kernels.clip(
            view,
            moment,
            a["vertices"],
            self._position,
            a["faces"],
            a["info"],
            scene.static_faces,
            len(scene.vertices),
            clipped,
            corner,
            tag,
            counts,
            extent,
            most,
            views,
            height,
            int(rows < height),
            *self._backend.crew(views),
        )
        (queue, slots, _), workers = self._backend.crew(views * -(-height // rows)), self._backend.threads
        line = self._buffer("line", (workers * 3 * lanes,), np.float32)
        depth = self._buffer("band_depth", (workers * rows * groups * lanes,), np.float32)
        owner = self._buffer("band_owner", (workers * rows * groups * lanes,), np.int32)
        bits, owners = depth.view(np.uint32), owner.view(np.uint32)
        even = width % lanes == 0
        planes = lanes if empty is not None and (empty < 0).all() else groups * lanes * height
        stored = views if empty is None else 1
        marks = 1 if planes == lanes else views * groups * height
        self.touched = self._buffer("touched", (marks,), np.int32)
        kept = [self._buffer(name, (stored * planes,), np.uint32) for name in ("empty_bits", "empty_owners")]
        # the buffer may be longer, from a picture of another width
        wide = vis[: len(vis) // lanes * lanes] if even else self._buffer("no_vis", (lanes,), np.uint64)
        self._paint(
            corner,
            tag,
            counts,
            extent,
            most,
            line.reshape(-1, lanes),
            line,
            depth.reshape(-1, lanes),
            owner.reshape(-1, lanes),
            bits.reshape(-1, lanes),
            owners.reshape(-1, lanes),
            empty is None,
            np.zeros(1, np.int32) if empty is None else empty,
            kept[0].reshape(-1, lanes),
            kept[1].reshape(-1, lanes),
            self.touched,
            wide.reshape(-1, lanes),
            bits,
            owners,
            vis,
            even,
            views,
            width,
            height,
            rows,
            queue,
            slots,
            workers,
        )
