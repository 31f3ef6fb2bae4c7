"""Depth of field of a batch of views: what the lens makes of it, and the passes that draw it.

Assumes an inked picture and its visibility buffer. Guarantees that what is in focus is not touched, and that
a view is blurred the same whatever else is in its batch. Buffers hold one view and are kept.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .types import Camera

NEAREST = 2.0  # focal lengths: no lens is focused closer

Buffers = Callable[[str, tuple[int, ...], type], Any]


def lens_of(camera: Camera, count: int, width: int) -> NDArray[np.float32] | None:
    """What the circle of confusion of each view follows from, float32 [N, 2]; None where all is sharp.

    The first number is the circle's radius in pixels of what is infinitely far, f² / (2 N (s − f)) on the
    sensor, the second the distance s of the focus in metres; at depth z the radius is first · (s / z − 1).
    Raises ValueError.
    """
    if camera.focus is None or not camera.aperture:
        return None
    if not (np.isfinite(camera.aperture) and camera.aperture > 0):
        raise ValueError("Camera.aperture: an f-number is positive; 0 means that all is sharp")
    focus = np.asarray(camera.focus, np.float64)
    if focus.shape != (count,):
        raise ValueError(f"Camera.focus: expected {(count,)}, got {focus.shape}")
    if not np.isfinite(focus).all() or (focus <= 0).any():
        raise ValueError("Camera.focus: distances must be finite and positive")
    focal = np.asarray(camera.focal, np.float64)
    distance = np.maximum(1000.0 * focus, NEAREST * focal)  # mm
    radius = focal**2 / (2.0 * camera.aperture * (distance - focal))
    return np.stack([radius * width / camera.sensor[0], distance / 1000.0], axis=1).astype(np.float32)


class Lens:
    """The passes of one picture size after another; buffer: where scratch arrays come from."""

    def __init__(self, buffer: Buffers, upload: Callable[[NDArray[Any]], Any]) -> None:
        from .kernels import lens  # only now: it imports taichi

        self._k = lens
        self._buffer = buffer
        self._upload = upload
        self._area = upload(_areas(lens.STEPS, 6.0))
        steps = np.arange(lens.SPAN)
        self._away = upload(np.hypot(steps[:, None], steps).astype(np.float32).reshape(-1))

    def blur(
        self,
        lens: NDArray[np.float32],
        vis: Any,
        picture: Any,
        tables: tuple[Any, Any],
        size: tuple[int, int],
    ) -> None:
        """Blur the pictures of all views in place; tables: sRGB to linear light, and back."""
        up = self._upload(lens)
        for n in np.flatnonzero(lens[:, 0] > 0):
            self._blur_one(int(n), up, vis, picture, tables, size)

    def _blur_one(
        self, n: int, lens: Any, vis: Any, picture: Any, tables: tuple[Any, Any], size: tuple[int, int]
    ) -> None:
        k, (width, height) = self._k, size
        across, down = -(-width // k.TILE), -(-height // k.TILE)
        sizes, starts = _levels(width, height, k.FILLS)
        cells = starts[k.LEVELS]
        far = self._buffer("lens_far", (cells * k.CELL,), np.float32)
        near = self._buffer("lens_near", (cells * k.CELL,), np.float32)
        out = self._buffer("lens_out", (cells * 4,), np.float32)
        reach = self._buffer("lens_reach", (2 * sizes[0][0] * sizes[0][1],), np.float32)
        tiles = self._buffer("lens_tiles", (3 * across * down,), np.float32)
        survey = self._buffer("lens_survey", (k.SURVEY * across * down,), np.float32)
        k.split(n, lens, vis, picture, tables[0], far, near, tiles, width, height)
        widest = k.look_round(tiles, survey, across, down)
        grid = (survey, across, down)
        levels = range(k.LEVELS)
        for i in levels[:-1]:
            k.halve_far(far, starts[i] * k.CELL, *sizes[i], starts[i + 1] * k.CELL, *sizes[i + 1])
        for i in levels:
            low = 0.6 * (k.HAND_OVER[i - 1][0] if i else 0.0)
            high = min(k.HAND_OVER[i][1], k.MOST)
            begin, cells_here = starts[i] * k.CELL, sizes[i][0] * sizes[i][1]
            k.reach_far(far, begin, cells_here, i, reach)
            k.gather_far(far, begin, *sizes[i], i, low, high, reach, self._away, *grid, out, starts[i] * 4)
        for i in reversed(levels[:-1]):
            finer = (far, starts[i] * k.CELL, *sizes[i], i, *grid, out, starts[i] * 4)
            k.join_far(*finer, starts[i + 1] * 4, *sizes[i + 1], *k.HAND_OVER[i])
        k.put_far(n, lens, vis, picture, *tables, out, tiles, width, height)
        if widest <= k.SHARP:
            return
        for i in levels[:-1]:
            begin, to = starts[i] * k.CELL, starts[i + 1] * k.CELL
            k.halve_near(near, begin, *sizes[i], to, *sizes[i + 1], *k.HAND_OVER[i])
        for i in levels:
            high = min(k.HAND_OVER[i][1], k.MOST)
            begin = starts[i] * k.CELL
            k.reach_near(near, begin, sizes[i][0] * sizes[i][1], i, high, self._area, reach)
            k.gather_near(near, begin, *sizes[i], i, high, reach, self._away, *grid, out, starts[i] * 4)
        for i in reversed(levels[:-1]):
            k.join_near(*sizes[i], i, *grid, out, starts[i] * 4, starts[i + 1] * 4, *sizes[i + 1])
        fill = self._buffer("lens_fill", (starts[-1] * 4,), np.float32)
        k.open_fill(n, lens, vis, picture, tables[0], survey, fill, width, height)
        for i in range(k.FILLS - 1):
            k.halve_fill(fill, starts[i] * 4, *sizes[i], starts[i + 1] * 4, *sizes[i + 1])
        for i in reversed(range(k.FILLS - 1)):
            above = (starts[i + 1] * 4, *sizes[i + 1])
            k.close_fill(fill, starts[i] * 4, *sizes[i], i, tiles, survey, across, *above)
        k.put_near(n, lens, vis, picture, *tables, out, fill, survey, width, height)


def _levels(width: int, height: int, count: int) -> tuple[list[tuple[int, int]], list[int]]:
    """Cells (across, down) of the halved pictures, and where each begins; one more for the end."""
    sizes, starts = [], [0]
    for _ in range(count):
        width, height = -(-width // 2), -(-height // 2)
        sizes.append((width, height))
        starts.append(starts[-1] + width * height)
    return sizes, starts


def _areas(steps: int, most: float) -> NDArray[np.float32]:
    """Cells that a circle covers, borders by their share, for radii in steps of a cell."""
    y, x = np.mgrid[-8:9, -8:9]
    radius = np.arange(int(most * steps) + 2) / steps
    return np.clip(radius[:, None, None] - np.hypot(x, y) + 0.5, 0.0, 1.0).sum(axis=(1, 2)).astype(np.float32)
