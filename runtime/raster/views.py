"""Views as the kernels read them, and what is wrong with those that cannot be drawn.

Guarantees that whatever is not finite or of the wrong shape ends in a ValueError here, before any kernel.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .detail import COUNT, Levels
from .types import Camera, Views


def check_moments(palettes: NDArray[np.float32], views: Views, palette: int) -> NDArray[np.int32]:
    """The moment of each view, int32 [N]. Raises ValueError; palette: matrices that a scene needs."""
    if palettes.ndim != 4 or palettes.shape[2:] != (3, 4) or palettes.shape[1] < palette:
        raise ValueError(f"palettes: expected [M, {palette} or more, 3, 4], got {palettes.shape}")
    if not np.isfinite(palettes).all():
        raise ValueError("palettes: not all numbers are finite")
    moment = np.asarray(views.moment, np.int32)
    if len(moment) and not (moment.min() >= 0 and moment.max() < max(len(palettes), 1)):
        raise ValueError("Views.moment: an index is outside the palettes")
    return moment


def left_out(views: Views, walls: int, people: int) -> NDArray[np.int32]:
    """What is not drawn in each view, int32 [N, walls + people], 1 or 0. Raises ValueError."""
    count, most = len(views.moment), walls + people
    hidden = np.asarray(views.hidden)
    if hidden.shape not in ((count, walls), (count, most)):
        raise ValueError(f"Views.hidden: expected {(count, walls)}, got {hidden.shape}")
    shown = np.zeros((count, most - hidden.shape[1]), hidden.dtype)
    return np.concatenate([hidden, shown], axis=1).astype(np.int32)


def check_levels(levels: NDArray[np.int32], count: int, detail: Levels) -> NDArray[np.int32]:
    """The levels of ``Views.detail``. Raises ValueError."""
    levels = np.asarray(levels, np.int32)
    if levels.shape != (count, len(detail.middle)):
        raise ValueError(f"Views.detail: expected {(count, len(detail.middle))}, got {levels.shape}")
    if levels.size and not (levels.min() >= 0 and levels.max() < COUNT):
        raise ValueError(f"Views.detail: a level is not below {COUNT}")
    return levels


def check_roles(roles: NDArray[np.uint8], count: int, objects: int) -> None:
    """Raises ValueError for roles that do not name all objects of every view."""
    if roles.ndim != 2 or len(roles) != count or roles.shape[1] < objects or roles.dtype != np.uint8:
        raise ValueError(
            f"roles: expected uint8 [{count}, {objects} or more], got {roles.dtype} {roles.shape}"
        )


def check_pixels(
    pixels: NDArray[np.int32], count: int, size: tuple[int, int], roles: NDArray[np.uint8] | None
) -> None:
    """Raises ValueError for pixels that are not some of every view, or without the roles they are to tell."""
    if roles is None:
        raise ValueError("pixels: what they show is told by its role, and no roles are given")
    if pixels.ndim != 2 or len(pixels) != count or pixels.dtype != np.int32:
        raise ValueError(f"pixels: expected int32 [{count}, K], got {pixels.dtype} {pixels.shape}")
    if pixels.size and pixels.max() >= size[0] * size[1]:
        raise ValueError(f"pixels: {pixels.max()} is in no picture of {size[0]} × {size[1]}")


def with_other_levels(
    hidden: NDArray[np.int32], detail: Levels, chosen: NDArray[np.int32], walls: int
) -> NDArray[np.int32]:
    """``hidden`` [N, W + people], after it all but the ``chosen`` [N, B] level of each body, and a 0."""
    level = chosen[..., None] != np.arange(COUNT)
    for k, person in enumerate(detail.person):
        if person >= 0:
            level[:, k] |= hidden[:, walls + person, None] != 0
    parts = [hidden, level.reshape(len(hidden), level.shape[1] * level.shape[2]), np.zeros((len(hidden), 1))]
    return np.concatenate(parts, axis=1).astype(np.int32)


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
