"""Clear glass laid over inked pictures.

Assumes the glass of a scene, taken out of it (:mod:`.panes`). Guarantees that a view in which there is none
costs a test of bounds, and one in which there is some not much more than the pixels around it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .device import Backend
from .loaded import Loaded
from .moments import Moments
from .panes import Glass
from .passes import Buffers, Layer, Passes
from .prepare import spheres
from .visibility import Visibility

CHUNK = 64  # faces of a cluster
NEAR = 0.03  # metres
MARGIN = 3  # pixels around what bounds say
Box = NDArray[np.int32]  # [N, 4]: first column, column after the last, first row, row after the last


@dataclass(frozen=True, eq=False)
class Sheets:
    """The faces of clear glass as :class:`runtime.raster.visibility.Visibility` reads a scene."""

    vertices: NDArray[np.float32]
    faces: NDArray[np.int32]
    static_faces: int
    clusters: NDArray[np.int32]
    moving_first: int

    @property
    def most_drawn(self) -> int:
        """How many faces a view has at most."""
        return len(self.faces)


class Glazing:
    """Lays the clear glass of one scene over pictures; buffer: where kept arrays come from."""

    def __init__(self, backend: Backend, buffer: Buffers, loaded: Loaded, glass: Glass) -> None:
        from .kernels import geometry  # only now: they import taichi
        from .kernels import glass as kernels

        self._backend, self._buffer = backend, buffer
        self._bound, self._lay = geometry.bound, kernels.lay
        clusters, first = _clusters(glass)
        vertices = loaded.scene.vertices
        self._sheets = Sheets(vertices, glass.faces, glass.still, clusters, first)
        self._sphere = spheres(vertices, glass.faces, clusters[:first])
        up = backend.upload
        self._arrays = {
            "vertices": loaded.arrays["vertices"],
            "faces": up(glass.faces),
            "info": up(glass.info),
        }
        self._arrays |= {"clusters": up(clusters), "sphere": up(self._sphere)}
        self._group, self._color = up(glass.group), up(glass.color)
        self._visibility = Visibility(backend, buffer, "pane_")
        self._visibility.load(self._sheets, self._arrays)

    def move(self, moments: Moments) -> None:
        """Take over what moves."""
        sheets, a = self._sheets, self._arrays
        moving = len(sheets.clusters) - sheets.moving_first
        count, up = moments.count, self._backend.upload
        wanted, none = up(np.ones((count, max(moving, 1)), np.int32)), up(np.zeros(max(moving, 1), np.int32))
        self._ball = self._buffer("pane_ball", (count, max(moving, 1), 4), np.float32)
        if moving:
            places = (sheets.moving_first, len(sheets.vertices), count, moments.position, self._ball)
            self._bound(a["faces"], a["clusters"], wanted, *places)
        self._visibility.move(moments.position, self._ball, wanted, none, count if moving else 0)

    def boxes(
        self,
        view: NDArray[np.float32],
        moment: NDArray[np.int32],
        hidden: NDArray[np.int32],
        size: tuple[int, int],
    ) -> tuple[Box, Box]:
        """Where each view may show glass of the set, and glass that moves."""
        sheets = self._sheets
        first, wall = sheets.moving_first, sheets.clusters[:, 3]
        shown = (wall < 0) | (hidden[:, np.maximum(wall, 0)] == 0)
        still = np.broadcast_to(self._sphere, (len(view), first, 4))
        ball = self._ball if self._backend.on_host else self._ball.to_numpy()
        moving = ball[moment][:, : len(wall) - first] if len(wall) > first else np.zeros((len(view), 0, 4))
        return _boxes(view, still, shown[:, :first], size), _boxes(view, moving, shown[:, first:], size)

    def lay(
        self,
        passes: Passes,
        moments: Moments,
        layer: Layer,
        seen: tuple[NDArray[np.float32], NDArray[np.int32], NDArray[np.int32], Box],
        size: tuple[int, int],
        serial: bool,
        movers: bool = True,
    ) -> None:
        """Over what is inked anew of the pictures.

        seen: views, moments, hidden, boxes; serial: as in ``Visibility.fill``; movers: also what moves
        """
        view, moment, hidden, box = seen
        of = np.flatnonzero(box[:, 1] > box[:, 0]).astype(np.int32)
        if not len(of):
            return
        sheets, a, up = self._sheets, self._arrays, self._backend.upload
        pane = self._buffer("pane", (len(of) * size[0] * size[1],), np.uint64)
        chosen = (up(view[of]), up(moment[of]), up(hidden[of]))
        self._visibility.fill(*chosen, pane, size, np.full(len(of), -1, np.int32), serial, movers)
        self._lay(
            *chosen[:2], a["vertices"], moments.position, a["faces"], self._group, self._color,
            sheets.static_faces, len(sheets.vertices), up(of), up(box[of]), pane, layer.vis, layer.level,
            layer.picture, layer.marks, passes.linear, passes.table, passes.run, len(of), *size,
            *self._backend.crew(len(of) * size[1]),
        )  # fmt: skip


def _clusters(glass: Glass) -> tuple[NDArray[np.int32], int]:
    """Clusters [C, 4] as in ``Prepared``, of faces of one thing, and the first that moves."""
    count = len(glass.faces)
    key = np.stack([np.arange(count) >= glass.still, glass.info[:, 2], glass.group[:, 0]], axis=1)
    ends = [*(np.flatnonzero((key[1:] != key[:-1]).any(axis=1)) + 1), count]
    rows, begin = [], 0
    for end in ends:
        rows += [(k, min(CHUNK, end - k), 0, int(key[begin, 1])) for k in range(begin, end, CHUNK)]
        begin = end
    clusters = np.array(rows, np.int32)
    return clusters, int((clusters[:, 0] < glass.still).sum())


def _boxes(
    view: NDArray[np.float32],
    sphere: NDArray[np.floating],
    shown: NDArray[np.bool_],
    size: tuple[int, int],
) -> Box:
    """The part of each picture in which some of the spheres [N, C, 4] may be; nothing is 0, 0, 0, 0."""
    to = sphere[..., :3].astype(np.float64) - view[:, None, :3]
    axes = view[:, 3:12].reshape(-1, 3, 3).astype(np.float64)
    right, up, ahead = np.moveaxis(np.einsum("nij,ncj->nci", axes, to), -1, 0)
    radius = sphere[..., 3].astype(np.float64)
    shown = shown & (ahead + radius > NEAR)
    whole = ahead - radius <= NEAR  # the camera may be inside
    nearest = np.where(whole, 1.0, ahead - radius)
    farthest = np.maximum(ahead + radius, NEAR)
    spans = []
    for x, scale, middle, length in (
        (right, view[:, 12:13], view[:, 14:15], size[0]),
        (-up, view[:, 13:14], view[:, 15:16], size[1]),
    ):
        low, high = x - radius, x + radius
        low = middle + scale * low / np.where(low < 0, nearest, farthest)
        high = middle + scale * high / np.where(high > 0, nearest, farthest)
        low, high = np.where(whole, 0.0, low), np.where(whole, length, high)
        shown = shown & (high > -MARGIN) & (low < length + MARGIN)
        spans.append((low, high, length))
    box = np.zeros((len(view), 4), np.int32)
    for axis, (low, high, length) in enumerate(spans):
        first = np.where(shown, low, length).min(axis=1, initial=length)
        last = np.where(shown, high, 0.0).max(axis=1, initial=0.0)
        box[:, 2 * axis] = np.clip(first - MARGIN, 0, length)
        box[:, 2 * axis + 1] = np.clip(last + MARGIN, 0, length)
    box[~shown.any(axis=1)] = 0
    return box


def merged(a: Box, b: Box) -> Box:
    """Boxes around both of two, where there is any."""
    out = np.stack(
        [
            np.minimum(a[:, 0], b[:, 0]),
            np.maximum(a[:, 1], b[:, 1]),
            np.minimum(a[:, 2], b[:, 2]),
            np.maximum(a[:, 3], b[:, 3]),
        ],
        axis=1,
    )
    out = np.where((a[:, :1] == a[:, 1:2]), b, np.where(b[:, :1] == b[:, 1:2], a, out))
    return out.astype(np.int32)
