"""Draws batches of views.

Assumes scenes and cameras in metres, Z up. Guarantees: the same input gives the same bytes, a batch
gives what its views give one by one, and memory is bounded however long the batch is.

This is where a batch is cut into chunks and the passes are called in turn. What a pass does is in
``visibility``, ``moments``, ``passes``, ``empty``, ``panes`` and ``optics``.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .bare import Plain
from .detail import COUNT, FINEST
from .device import Backend, start
from .empty import EmptySets
from .glazing import Glazing, merged
from .landing import Landing
from .loaded import Loaded, loaded
from .memory import budget, bytes_of_moment, bytes_of_view
from .moments import Moments
from .optics import Lens, lens_of
from .passes import Passes
from .pool import Pool
from .types import GUIDE_SIDE, GUIDES, Frames, Probed, RenderScene, Style, Views
from .views import (
    check_levels,
    check_moments,
    check_pixels,
    check_roles,
    left_out,
    pack_views,
    with_other_levels,
)
from .visibility import Visibility


class Renderer:
    """One scene at a time, any number of views of it.

    device: ``cpu``, ``cuda``, ``vulkan`` or ``auto`` (a GPU if there is one)
    """

    def __init__(self, device: str = "auto", style: Style | None = None) -> None:
        self.style = style or Style()
        self.backend: Backend = start(device)
        self.serial = self.backend.on_host  # one thread a band of a view, no atomics
        self._buffers: dict[str, Any] = {}
        self._most = 1 << 20  # views at a time; fewer once memory has run out
        self.budget = 0  # bytes that the views drawn at a time may take, from :meth:`load` on
        self._pool, self._landing = Pool(), Landing(self.backend.name == "cuda")
        self._passes = Passes(self.backend, self._buffer, self.style)
        self._plain = Plain(self.backend, self._buffer, self._passes.film) if self.style.plain else None
        self._moments = Moments(self.backend, self._buffer, self.style)
        self._visibility = Visibility(self.backend, self._buffer)
        self._empty = EmptySets(self.backend, self._buffer, self._passes, self._visibility)
        self._loaded: Loaded | None = None
        self._glazing: Glazing | None = None
        self._lens: Lens | None = None

    def load(self, scene: RenderScene) -> None:
        """Make ``scene`` the one that is drawn. Raises ValueError for a scene that cannot be."""
        content = loaded(scene, self.style, self.backend, self._passes.shading)
        self._visibility.load(content.scene, content.arrays)
        self._empty.forget()
        if self._plain is not None:
            self._plain.load(content.scene, content.arrays)
        self._glazing = None
        if content.glass is not None and self._plain is None:
            self._glazing = Glazing(self.backend, self._buffer, content, content.glass)
        self._loaded = content
        self.budget = budget(self.backend)

    def render(
        self,
        palettes: NDArray[np.float32],
        views: Views,
        size: tuple[int, int],
        ids: bool = False,
        depth: bool = False,
        roles: NDArray[np.uint8] | None = None,
        pictures: bool = True,
        pixels: NDArray[np.int32] | None = None,
    ) -> Frames:
        """Draw every view.

        palettes: float32 [M, P, 3, 4], world-from-bind matrices of each moment; size: (width, height)
        roles: uint8 [N, objects], NO_ROLE, SUBJECT or OTHERS of each object in each view, for guides
        pictures: whether to shade; colours [N, 0, 0, 3] are quick where ids, depths or guides are enough
        pixels: int32 [N, K], with roles: some of each view, counted row by row, less than 0 for none; what
            they show is told
        returns colours uint8 [N, H, W, 3], and if asked for object ids int32 and depths float32 [N, H, W],
            guides, and what the pixels show
        """
        content = self._loaded
        if content is None:
            raise RuntimeError("load a scene before rendering")
        width, height = int(size[0]), int(size[1])
        view, moment, hidden = self._checked(content, palettes, views, (width, height))
        count = len(moment)
        lens = lens_of(views.camera, count, width)
        color = self._pool.bytes((count, height if pictures else 0, width if pictures else 0, 3))
        objects = np.empty((count, height, width), np.int32) if ids else None
        far = np.empty((count, height, width), np.float32) if depth else None
        guides = None
        if roles is not None:
            check_roles(roles, count, int(content.scene.surface_object.max(initial=-1)) + 1)
            guides = np.empty((count, GUIDE_SIDE, GUIDE_SIDE, len(GUIDES)), np.uint8)
        probed = None
        if pixels is not None:
            check_pixels(pixels, count, (width, height), roles)
            probed = Probed(np.empty(pixels.shape, np.float32), np.empty(pixels.shape, np.uint8))
        chunk = self._chunk(content, hidden, (width, height))
        chunk = -(-count // max(-(-count // chunk), 1))  # as few of them as fit, of one size
        several = len(np.unique(moment))
        # moments that many views share are moved once for all chunks, if there is room for all of them
        room = bytes_of_moment(content, height, skinned(content, hidden))
        every = several < count and several * room <= self.budget
        moved = slice(0)
        begin = 0
        while begin < count:
            part = slice(begin, min(count, begin + chunk))
            try:
                if moved.stop < part.stop:
                    moved = slice(begin, count) if every else part
                    used, inverse = np.unique(moment[moved], return_inverse=True)
                    local = inverse.reshape(-1).astype(np.int32)
                    some = palettes[used] if len(palettes) else palettes
                    self._move(content, some, local, height, hidden[moved], pictures)
                self._draw(
                    view[part],
                    local[begin - moved.start : part.stop - moved.start],
                    hidden[part],
                    (width, height),
                    color[part],
                    objects[part] if objects is not None else None,
                    lens[part] if lens is not None else None,
                )
                if far is not None:
                    far[part] = self._depths(far[part].shape)
                if guides is not None and roles is not None:
                    self._passes.guides(
                        content, self._buffers["vis"], roles[part], (width, height), guides[part]
                    )
                if probed is not None and pixels is not None and roles is not None:
                    here = Probed(probed.near[part], probed.role[part])
                    self._passes.probe(
                        content, self._buffers["vis"], roles[part], pixels[part], (width, height), here
                    )
            except (MemoryError, RuntimeError) as error:
                if part.stop - begin == 1 or not out_of_memory(error):
                    raise
                chunk = (part.stop - begin) // 2  # less at a time, from now on
                self._most = min(chunk, self._most)
                self._buffers.clear()
                self._landing.release()
                self._empty.forget()
                moved, every = slice(0), False
                continue
            begin = part.stop
        return Frames(color, objects, far, guides, probed)

    def levels(self, palettes: NDArray[np.float32], views: Views, size: tuple[int, int]) -> NDArray[np.int32]:
        """The level of detail that each view takes of each detailed body, int32 [N, B]; finer is less.

        For ``Views.detail``: the least of some views is fine enough for all of them. Raises ValueError.
        """
        if self._loaded is None:
            raise RuntimeError("load a scene before asking for its levels")
        moment = check_moments(palettes, views, self._loaded.palette)
        view = pack_views(views.camera, len(moment), int(size[0]), int(size[1]))
        return self._loaded.scene.detail.chosen(palettes, moment, view)

    def _checked(
        self, content: Loaded, palettes: NDArray[np.float32], views: Views, size: tuple[int, int]
    ) -> tuple[NDArray[np.float32], NDArray[np.int32], NDArray[np.int32]]:
        """Views, their moments and what is left out of them, as the kernels read them; or ValueError."""
        if size[0] < 1 or size[1] < 1:
            raise ValueError(f"size: {size[0]} x {size[1]} has no pixels")
        moment = check_moments(palettes, views, content.palette)
        hidden = left_out(views, content.walls, content.people)
        view = pack_views(views.camera, len(moment), *size)
        detail = content.scene.detail
        if views.detail is None:
            chosen = detail.chosen(palettes, moment, view)
        else:
            chosen = check_levels(views.detail, len(moment), detail)
        return view, moment, with_other_levels(hidden, detail, chosen, content.walls)

    def _chunk(self, content: Loaded, hidden: NDArray[np.int32], size: tuple[int, int]) -> int:
        """How many views of ``size`` are drawn at a time."""
        each = bytes_of_view(content, size, self._passes.run, skinned(content, hidden))
        return max(1, min(self._most, self.budget // each))

    def _buffer(self, name: str, shape: tuple[int, ...], dtype: type) -> Any:
        """A buffer at least as large as asked for (flat ones) or of that shape, kept for the next time."""
        have = self._buffers.get(name)
        enough = have is not None and (
            have.shape[0] >= shape[0] and tuple(have.shape[1:]) == tuple(shape[1:])
        )
        if not enough:
            have = self._buffers[name] = self.backend.buffer(shape, dtype)
        return have

    def _move(
        self,
        content: Loaded,
        palettes: NDArray[np.float32],
        moment: NDArray[np.int32],
        height: int,
        hidden: NDArray[np.int32],
        pictures: bool,
    ) -> None:
        """Make ``palettes`` the moments that are drawn; of what is not shaded, or plainly, nothing else.

        moment, hidden: of the views that look at them
        """
        moments = self._moments
        by_moment = np.ones((max(len(palettes), 1), hidden.shape[1]), np.int32)
        np.minimum.at(by_moment, moment, hidden)
        moments.move(content, palettes, height, by_moment, pictures and self._plain is None)
        some = moments.count if len(content.scene.clusters) > content.scene.moving_first else 0
        moved = (moments.position, moments.ball, moments.wanted, moments.rests)
        self._visibility.move(*moved, some, moments.taken)
        if self._glazing is not None:
            self._glazing.move(moments)

    def _draw(
        self,
        view: NDArray[np.float32],
        moment: NDArray[np.int32],
        hidden: NDArray[np.int32],
        size: tuple[int, int],
        color: NDArray[np.uint8],
        objects: NDArray[np.int32] | None,
        lens: NDArray[np.float32] | None,
    ) -> None:
        """Draw the views of a chunk into ``color`` and ``objects``."""
        content, moments, passes, views = self._loaded, self._moments, self._passes, len(view)
        assert content is not None
        glazing = self._glazing
        up = self.backend.upload
        layer = passes.layer("", views, size)
        view_, moment_, hidden_ = up(view), up(moment), up(hidden)
        empty = np.full(views, -1, np.int32)
        shaded = color.size > 0
        if shaded and self.serial and self._plain is None and size[0] % passes.run == 0:
            empty = self._empty.drawn_for(content, moments, glazing, (view, hidden), size)
        self._visibility.fill(view_, moment_, hidden_, layer.vis, size, empty, self.serial)
        if not shaded:
            if objects is not None:
                passes.objects_seen(content, layer, objects)
            return
        if self._plain is not None:
            moved = (moments.position, moments.normal)
            landed = self._landing.bytes(color).reshape(color.shape)
            self._plain.draw(view_, moment_, moved, layer.vis, size, landed, objects)
            self._landing.fetch(color)
            return
        layer.level.fill(passes.SHADE)
        box = (np.zeros((views, 4), np.int32),) * 2  # where there may be glass: of the set, and what moves
        if glazing is not None:
            box = glazing.boxes(view, moment, hidden, size)
        if (empty >= 0).any():
            whole = lens is not None or objects is not None
            self._empty.take_over(content, moments, layer, (moment, empty, box[1]), size, color, whole)
        passes.shade(content, moments, layer, (view_, moment_, views), size)
        passes.draw_lines(content, layer, view_, views, size)
        if glazing is not None:
            seen = (view, moment, hidden, merged(*box))
            glazing.lay(passes, moments, layer, seen, size, self.serial)
        if lens is not None:
            self._lens = self._lens or Lens(self._buffer, up)
            self._lens.blur(lens, layer.vis, layer.picture, (passes.linear, passes.table), size)
        landed = self._landing.bytes(color).reshape(color.shape)
        passes.even_out(content, moments, layer, (view_, moment_, views), landed, size)
        self._landing.fetch(color)
        if objects is not None:
            passes.object_ids(content, layer, objects)

    def _depths(self, shape: tuple[int, ...]) -> NDArray[np.float32]:
        """Depths of the views drawn last, float32 [N, H, W]."""
        vis = self._buffers["vis"]
        keys = (vis if self.backend.on_host else vis.to_numpy())[: int(np.prod(shape))]
        with np.errstate(divide="ignore"):
            return (1.0 / (keys >> np.uint64(32)).astype(np.uint32).view(np.float32)).reshape(shape)


def skinned(content: Loaded, hidden: NDArray[np.int32]) -> int:
    """How many vertices have to be moved: those of the finest level only where it is seen."""
    finest = hidden[:, content.walls + content.people + FINEST : -1 : COUNT]
    return len(content.scene.rest) if (finest == 0).any() else content.scene.detail.vertices


def out_of_memory(error: Exception) -> bool:
    """Whether an error of numpy's, of Taichi's or of a driver's says that memory has run out."""
    said = str(error).lower()
    return isinstance(error, MemoryError) or "out of memory" in said or "out_of_memory" in said
