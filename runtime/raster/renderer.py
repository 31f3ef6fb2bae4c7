"""Draws batches of views.

Assumes scenes and cameras in metres, Z up. Guarantees: the same input gives the same bytes, a batch
gives what its views give one by one, and memory is bounded however long the batch is.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .bake import light_basis
from .device import Backend, start
from .film import film_table, to_encoded, to_linear, unexposed
from .prepare import Prepared, prepare
from .types import LOOSE, Camera, Frames, RenderScene, Style, Views

CHUNK_PIXELS = 8_000_000  # pixels in flight; about 30 bytes each
CHUNK_VERTICES = 2_000_000  # skinned vertices in flight; about 50 bytes each
SET_SHADOW = 2048  # texels along the set's shadow map
SET_TEXEL = 0.006  # metres, finest
SHADOW = 512  # texels along a moment's shadow map, for large pictures; half for small ones
TEXEL = 0.004  # metres, finest
FLOOR_CELL = 0.05  # metres
FLOOR_CELLS = 512  # most cells along the floor


class Renderer:
    """One scene at a time, any number of views of it.

    device: ``cpu``, ``cuda``, ``vulkan`` or ``auto`` (a GPU if there is one)
    """

    def __init__(self, device: str = "auto", style: Style | None = None) -> None:
        self.style = style or Style()
        self.backend: Backend = start(device)
        # Only now: the kernels import taichi, which costs a second.
        from .kernels import finish, geometry, light, shading

        self._geometry = geometry
        self._light = light
        self._shading = shading.shading_kernels(self.style)
        self._finish = finish.finish_kernels(self.style)
        table = np.round(to_encoded(np.arange(4096) / 4095.0) * 255.0).astype(np.uint32)
        self._film = self.backend.upload(film_table())
        self._table = self.backend.upload(table)
        self._linear = self.backend.upload(to_linear(np.arange(256) / 255.0).astype(np.float32))
        self._buffers: dict[str, Any] = {}
        self.serial = self.backend.on_host  # one thread a view, no atomics
        self._scene: Prepared | None = None

    def load(self, scene: RenderScene) -> None:
        """Make ``scene`` the one that is drawn. Raises ValueError for a scene that cannot be."""
        prepared = prepare(scene, self.style)
        up = self.backend.upload
        self._arrays = {
            name: up(getattr(prepared, name))
            for name in (
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
                "casters",
                "area",
            )
        }
        self._arrays["joints"] = up(scene.joints.astype(np.int32))
        self._arrays["weights"] = up(scene.weights.astype(np.float32))
        light = scene.light
        horizon, zenith = unexposed(to_linear(np.array(light.backdrop)))
        packed = np.concatenate([light.sun, light.sun_color, light.sky, light.ground, horizon, zenith])
        if not np.isfinite(packed).all():
            raise ValueError("Light: not all numbers are finite")
        self._arrays["light"] = up(packed.astype(np.float32))
        basis = light_basis(np.array(light.sun))
        self._arrays["basis"] = up(basis.astype(np.float32).reshape(-1))
        volume = prepared.volume
        self._arrays["values"] = up(volume.values.reshape(-1))
        self._arrays["volume_low"] = up(np.array([*volume.low, 1.0 / volume.cell], np.float32))
        self._volume_shape = volume.values.shape
        a, count = self._arrays, prepared.static_faces
        self._sheet = self.backend.buffer((2 * max(count, 1) * self._shading.SHEET,), np.float32)
        self._shading.fold(
            *(a[name] for name in ("vertices", "normals", "faces", "color", "info", "light")),
            count,
            self._sheet,
        )
        self._load_floor(prepared)
        self._load_shadow(prepared)
        self._walls = scene.wall_count
        fitting = scene.fitting if scene.fitting is not None else np.zeros(0, np.int32)
        self._people = max(LOOSE - int(fitting.min(initial=LOOSE)), 0)
        self._palette_size = int(scene.joints.max()) + 1 if len(scene.joints) else 0
        self._scene = prepared

    def _load_floor(self, prepared: Prepared) -> None:
        """The grid of floor cells on which people leave their contact shadow."""
        low, high = (corner[:2] for corner in prepared.stage)
        low, high = low - 0.5, high + 0.5
        cell = max(FLOOR_CELL, float((high - low).max()) / FLOOR_CELLS)
        self._columns, self._rows = (int(n) for n in np.ceil((high - low) / cell) + 2)
        corner = low - cell
        floor = np.array([*corner, 1.0 / cell, *prepared.levels], np.float32)
        self._arrays["floor"] = self.backend.upload(floor)

    def _load_shadow(self, prepared: Prepared) -> None:
        """The shadow map of the set."""
        a, size, up = self._arrays, SET_SHADOW, self.backend.upload
        self._set_frame = up(np.array([[1e6, 1e6, 100.0]], np.float32))  # no map: out of reach
        if len(prepared.set_casters) and self.style.shadows:
            # only what casts, so that the map is not spent on the plain around
            used, corners = np.unique(prepared.faces[prepared.set_casters], return_inverse=True)
            vertices = up(prepared.vertices[used][None])
            faces = up(corners.reshape(-1, 3).astype(np.int32))
            casters = up(np.arange(len(prepared.set_casters), dtype=np.int32))
            self._set_size = size
            self._set_depth = self._buffer("set_depth", (size * size,), np.float32)
            self._set_coarse = self._buffer("set_coarse", ((size // self._light.BLOCK) ** 2,), np.float32)
            spare = self._buffer("set_spare", ((size // self._light.BLOCK) ** 2,), np.float32)
            seen = self.backend.buffer(vertices.shape, np.float32)
            self._light.fit(vertices, a["basis"], SET_TEXEL, size, len(used), 1, seen, self._set_frame)
            self._light.cast(
                seen, faces, casters, 0, self._set_frame, size, 1, self._set_depth, spare, self._set_coarse
            )
        else:
            self._set_size = 1
            self._set_depth = self._set_coarse = up(np.zeros(1, np.float32))

    def render(
        self, palettes: NDArray[np.float32], views: Views, size: tuple[int, int], ids: bool = False
    ) -> Frames:
        """Draw every view.

        palettes: float32 [M, P, 3, 4], world-from-bind matrices of each moment; size: (width, height)
        returns colours uint8 [N, H, W, 3], and object ids int32 [N, H, W] if asked for
        """
        if self._scene is None:
            raise RuntimeError("load a scene before rendering")
        width, height = int(size[0]), int(size[1])
        view, moment, hidden = self._check(palettes, views, width, height)
        count = len(moment)
        color = np.empty((count, height, width, 3), np.uint8)
        objects = np.empty((count, height, width), np.int32) if ids else None
        chunk = max(1, min(CHUNK_PIXELS // (width * height), CHUNK_VERTICES // max(len(self._scene.rest), 1)))
        for begin in range(0, count, chunk):
            part = slice(begin, min(count, begin + chunk))
            used, local = np.unique(moment[part], return_inverse=True)
            self._move(palettes[used] if len(palettes) else palettes, SHADOW if height > 400 else SHADOW // 2)
            self._draw(
                view[part],
                local.reshape(-1).astype(np.int32),
                hidden[part],
                (width, height),
                color[part],
                objects[part] if objects is not None else None,
            )
        return Frames(color, objects)

    def _check(
        self, palettes: NDArray[np.float32], views: Views, width: int, height: int
    ) -> tuple[NDArray[np.float32], NDArray[np.int32], NDArray[np.int32]]:
        """Views packed for the kernels, or ValueError."""
        if width < 1 or height < 1:
            raise ValueError(f"size: {width} x {height} has no pixels")
        if palettes.ndim != 4 or palettes.shape[2:] != (3, 4) or palettes.shape[1] < self._palette_size:
            raise ValueError(
                f"palettes: expected [M, {self._palette_size} or more, 3, 4], got {palettes.shape}"
            )
        if not np.isfinite(palettes).all():
            raise ValueError("palettes: not all numbers are finite")
        moment = np.asarray(views.moment, np.int32)
        count = len(moment)
        if count and not (moment.min() >= 0 and moment.max() < max(len(palettes), 1)):
            raise ValueError("Views.moment: an index is outside the palettes")
        hidden = np.asarray(views.hidden)
        most = self._walls + self._people
        if hidden.shape not in ((count, self._walls), (count, most)):
            raise ValueError(f"Views.hidden: expected {(count, self._walls)}, got {hidden.shape}")
        shown = np.zeros((count, most + 1 - hidden.shape[1]), hidden.dtype)  # never without a column
        hidden = np.concatenate([hidden, shown], axis=1)
        return pack_views(views.camera, count, width, height), moment, hidden.astype(np.int32)

    def _buffer(self, name: str, shape: tuple[int, ...], dtype: type) -> Any:
        """A buffer at least as large as asked for (flat ones) or of that shape, kept for the next time."""
        have = self._buffers.get(name)
        enough = have is not None and (
            have.shape[0] >= shape[0] and tuple(have.shape[1:]) == tuple(shape[1:])
        )
        if not enough:
            have = self._buffers[name] = self.backend.buffer(shape, dtype)
        return have

    def _move(self, palettes: NDArray[np.float32], size: int) -> None:
        """Skin all moments of a chunk, and draw their shadow maps of size x size texels."""
        scene, a = self._scene, self._arrays
        assert scene is not None
        moments, vertices = max(len(palettes), 1), max(len(scene.rest), 1)
        self._position = self._buffer("position", (moments, vertices, 3), np.float32)
        self._normal = self._buffer("normal", (moments, vertices, 3), np.float32)
        clusters = len(scene.clusters) - scene.moving_first
        self._ball = self._buffer("ball", (moments, max(clusters, 1), 4), np.float32)
        self._size = size if len(scene.casters) and len(palettes) and self.style.shadows else 1
        self._frame = self._buffer("frame", (moments, 3), np.float32)
        self._depth = self._buffer("depth", (moments * self._size**2,), np.float32)
        blocks = max(1, self._size // self._light.BLOCK)
        self._coarse = self._buffer("coarse", (moments * blocks**2,), np.float32)
        cells = self._rows * self._columns
        self._ground = self._buffer("ground", (moments * cells,), np.float32)
        if clusters and len(palettes):
            palette = self.backend.upload(palettes.astype(np.float32))
            self._geometry.skin(
                palette,
                a["rest"],
                a["rest_normals"],
                a["joints"],
                a["weights"],
                len(palettes),
                self._position,
                self._normal,
            )
            self._geometry.bound(
                a["faces"],
                a["clusters"],
                scene.moving_first,
                len(scene.vertices),
                len(palettes),
                self._position,
                self._ball,
            )
            if self._size > 1:
                seen = self._buffer("seen", (moments, vertices, 3), np.float32)
                blur = self._buffer("blur", (moments * blocks**2,), np.float32)
                self._light.fit(
                    self._position, a["basis"], TEXEL, size, len(scene.rest), len(palettes), seen, self._frame
                )
                self._light.cast(
                    seen,
                    a["faces"],
                    a["casters"],
                    len(scene.vertices),
                    self._frame,
                    size,
                    len(palettes),
                    self._depth,
                    blur,
                    self._coarse,
                )
            if self.style.occlusion:
                spare = self._buffer("spare", (moments * cells,), np.float32)
                self._light.touch(
                    self._position,
                    a["area"],
                    len(palettes),
                    a["floor"],
                    self._columns,
                    self._rows,
                    spare,
                    self._ground,
                )

    def _draw(
        self,
        view: NDArray[np.float32],
        moment: NDArray[np.int32],
        hidden: NDArray[np.int32],
        size: tuple[int, int],
        color: NDArray[np.uint8],
        objects: NDArray[np.int32] | None,
    ) -> None:
        scene, a, up = self._scene, self._arrays, self.backend.upload
        assert scene is not None
        width, height = size
        views = len(view)
        pixels = views * width * height
        vis = self._buffer("vis", (pixels,), np.uint64)
        picture = self._buffer("picture", (pixels,), np.uint32)
        edge = self._buffer("edge", (pixels,), np.uint32)
        runs = views * height * -(-width // self._shading.RUN)
        solid = self._buffer("solid", (runs,), np.int32)
        marks = self._buffer("marks", (runs,), np.int32)
        view_, moment_, hidden_ = up(view), up(moment), up(hidden)
        self._rasterise(view_, moment_, hidden_, vis, size, views)
        self._shading.rows(
            view_,
            moment_,
            a["vertices"],
            a["normals"],
            self._position,
            self._normal,
            a["faces"],
            a["color"],
            a["info"],
            self._sheet,
            scene.static_faces,
            len(scene.vertices),
            a["light"],
            a["basis"],
            self._set_frame,
            self._set_size,
            self._set_depth,
            self._set_coarse,
            self._frame,
            self._size,
            self._depth,
            self._coarse,
            *self._volume_shape,
            a["volume_low"],
            a["values"],
            a["floor"],
            self._columns,
            self._rows,
            self._ground,
            self._film,
            vis,
            picture,
            edge,
            solid,
            views,
            width,
            height,
        )
        self._finish.ink_rows(
            view_,
            picture,
            edge,
            vis,
            solid,
            a["surface_object"],
            a["one_color"],
            scene.moving_surface,
            self._linear,
            self._table,
            marks,
            views,
            width,
            height,
        )
        final = color.reshape(-1)
        smooth = self._finish.smooth_rows
        if width % 4 == 0:
            final, smooth = final.view(np.uint32), self._finish.smooth_words
        smooth(picture, marks, self._linear, self._table, final, views, width, height)
        if objects is not None:
            self._finish.object_ids(edge, a["surface_object"], objects.reshape(-1), pixels)

    def _rasterise(
        self, view: Any, moment: Any, hidden: Any, vis: Any, size: tuple[int, int], views: int
    ) -> None:
        """Fill the visibility buffers: a view or band a thread on the host, a triangle a thread elsewhere."""
        scene, a = self._scene, self._arrays
        assert scene is not None
        width, height = size
        if not self.serial:
            self._geometry.clear(vis, views * width * height)
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
                width,
                height,
            )
            return
        seen = self._buffer("screen", (views, max(len(scene.rest), 1), 3), np.float32)
        self._geometry.project(view, moment, self._position, len(scene.rest), views, seen)
        bands = 1 if views >= 2 * self.backend.threads else min(height, 2 * self.backend.threads)
        self._geometry.raster_serial(
            view,
            moment,
            hidden,
            a["vertices"],
            self._position,
            seen,
            a["faces"],
            a["clusters"],
            a["sphere"],
            self._ball,
            scene.moving_first,
            len(scene.vertices),
            vis,
            views,
            width,
            height,
            bands,
        )


def pack_views(camera: Camera, count: int, width: int, height: int) -> NDArray[np.float32]:
    """Cameras as the kernels read them, float32 [N, 16]. Raises ValueError.

    Position, right, up, forward, focal lengths in pixels (x, y), half size in pixels (x, y).
    """
    arrays = {
        "position": (np.asarray(camera.position, np.float32), (count, 3)),
        "axes": (np.asarray(camera.axes, np.float32), (count, 3, 3)),
        "focal": (np.asarray(camera.focal, np.float32), (count,)),
    }
    for name, (array, shape) in arrays.items():
        if array.shape != shape:
            raise ValueError(f"Camera.{name}: expected {shape}, got {array.shape}")
        if not np.isfinite(array).all():
            raise ValueError(f"Camera.{name}: not all numbers are finite")
    focal = arrays["focal"][0]
    if (focal <= 0).any() or not min(camera.sensor) > 0:
        raise ValueError("Camera: focal lengths and sensor must be positive")
    out = np.empty((count, 16), np.float32)
    out[:, 0:3] = arrays["position"][0]
    out[:, 3:12] = arrays["axes"][0].reshape(count, 9)
    out[:, 12] = focal / np.float32(camera.sensor[0]) * np.float32(width)
    out[:, 13] = focal / np.float32(camera.sensor[1]) * np.float32(height)
    out[:, 14] = width / 2
    out[:, 15] = height / 2
    return out
