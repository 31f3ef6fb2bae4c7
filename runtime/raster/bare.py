"""The plain look: smooth shading and nothing else, the quickest there is.

Assumes a prepared scene and a filled visibility buffer. Guarantees what the renderer does.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .device import Backend
from .prepare import Prepared

#: A buffer by name, as :meth:`runtime.raster.renderer.Renderer._buffer` gives it.
Buffers = Callable[[str, tuple[int, ...], type], Any]


class Plain:
    """Shades one scene plainly. film: scene light to sRGB, from :func:`runtime.raster.film.film_table`."""

    def __init__(self, backend: Backend, buffer: Buffers, film: Any) -> None:
        from .kernels import plain  # only now: it imports taichi

        self._backend, self._buffer, self._film, self._kernels = backend, buffer, film, plain

    def load(self, scene: Prepared, arrays: Mapping[str, Any]) -> None:
        """Make ``scene`` the one that is drawn; arrays: its uploaded arrays by name."""
        self._scene, self._arrays = scene, arrays
        self._card = self._backend.buffer((max(scene.static_faces, 1) * self._kernels.CARD,), np.float32)
        self._kernels.fold_plain(
            *(arrays[name] for name in ("vertices", "normals", "faces", "color", "info", "light")),
            self._film,
            scene.static_faces,
            self._card,
        )

    def draw(
        self,
        view: Any,
        moment: Any,
        moved: tuple[Any, Any],
        vis: Any,
        size: tuple[int, int],
        color: NDArray[np.uint8],
        objects: NDArray[np.int32] | None,
    ) -> None:
        """Fill ``color`` [N, H, W, 3], and ``objects`` [N, H, W] unless it is None.

        moved: positions and normals of the skinned vertices at each moment
        """
        a, scene = self._arrays, self._scene
        views, (width, height) = len(color), size
        pixels = views * width * height
        picture = self._buffer("picture", (pixels,), np.uint32)
        self._kernels.plain_rows(
            view,
            moment,
            a["normals"],
            *moved,
            a["faces"],
            a["color"],
            self._card,
            scene.static_faces,
            len(scene.vertices),
            a["light"],
            self._film,
            vis,
            picture,
            views,
            width,
            height,
            *self._backend.crew(views * height),
        )
        flat = color.reshape(-1)
        if pixels % 4 == 0:
            self._kernels.pack_words(picture, flat.view(np.uint32), pixels)
        else:
            self._kernels.pack_bytes(picture, flat, pixels)
        if objects is not None:
            self._kernels.ids_seen(vis, a["info"], a["surface_object"], objects.reshape(-1), pixels)
