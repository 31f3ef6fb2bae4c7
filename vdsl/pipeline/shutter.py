"""Motion blur: what a film camera sees while its shutter is open.

A frame is the mean, in linear light, of pictures at several moments around it. Assumes that what moves goes
straight from one frame to the next. Guarantees that a frame in which hardly anything moves is drawn once, as
without a shutter.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from runtime.raster.film import to_encoded, to_linear
from runtime.raster.types import Camera

#: Pixels that something may move between two of the moments of a frame.
_GAP = 4.0
#: Pixels below which a frame is as good as still; and the most moments of a frame.
_STILL, _MOST = 0.75, 24
#: How far away what a camera passes is taken to be, metres.
_AWAY = 4.0

Pictures = NDArray[np.uint8]


def open_moments(frame: int, angle: float, count: int, frames: int) -> NDArray[np.float64]:
    """``count`` moments, in frames, evenly over the time the shutter is open around a frame of ``frames``."""
    offset = ((np.arange(count) + 0.5) / count - 0.5) * angle / 360.0
    return np.clip(frame + offset, 0, frames - 1)


def between(values: NDArray[np.floating], at: NDArray[np.floating]) -> NDArray[np.floating]:
    """Rows [T, ...] at moments [N] between them, straight from one to the next."""
    low = np.floor(at).astype(int)
    high = np.minimum(low + 1, len(values) - 1)
    part = (at - low).reshape(-1, *([1] * (values.ndim - 1)))
    return np.asarray(values[low] * (1 - part) + values[high] * part, values.dtype)


def camera_between(camera: Camera, at: NDArray[np.floating]) -> Camera:
    """A camera that has T poses, at moments [N] between them."""
    axes = between(camera.axes, at)
    forward = axes[:, 2] / np.linalg.norm(axes[:, 2], axis=1, keepdims=True)
    right = axes[:, 0] - forward * (axes[:, 0] * forward).sum(axis=1, keepdims=True)
    right /= np.linalg.norm(right, axis=1, keepdims=True)
    return replace(
        camera,
        position=between(camera.position, at),
        axes=np.stack([right, np.cross(forward, right) * _hand(camera), forward], axis=1).astype(np.float32),
        focal=between(camera.focal, at),
        focus=None if camera.focus is None else between(camera.focus, at),
    )


def _hand(camera: Camera) -> float:
    """1 where up is forward x right, else -1."""
    right, up, forward = camera.axes[0]
    return 1.0 if np.dot(np.cross(forward, right), up) > 0 else -1.0


def moments_needed(camera: Camera, points: NDArray[np.floating], size: tuple[int, int]) -> int:
    """How many moments a frame needs; camera: its poses when the shutter opens and closes; points: metres
    [2, K, 3], what moves at these times."""
    spread = np.array([(x, y) for x in (-0.9, 0.0, 0.9) for y in (-0.9, 0.0, 0.9)])
    half = np.array(camera.sensor) / 2 / camera.focal[0]
    rays = camera.axes[0, 2] + spread[:, :1] * half[0] * camera.axes[0, 0]
    rays = rays + spread[:, 1:] * half[1] * camera.axes[0, 1]
    passed = np.repeat((camera.position[0] + _AWAY * rays)[None], 2, axis=0)
    both = np.concatenate([points, passed], axis=1)
    places = np.zeros((2, both.shape[1], 2))
    seen = np.zeros(both.shape[1], bool)
    for k in range(2):
        x, y, z = camera.axes[k] @ (both[k] - camera.position[k]).T
        scale = camera.focal[k] / camera.sensor[0] * size[0] / np.maximum(z, 0.2)
        places[k] = np.stack([x * scale, y * scale], axis=1)
        seen |= (z > 0.2) & (np.abs(places[k]) < np.array(size)).all(axis=1)  # at least not far beside it
    moved = np.linalg.norm(places[1] - places[0], axis=1)[seen].max(initial=0.0)
    return 1 if moved < _STILL else int(np.clip(np.ceil(moved / _GAP) + 1, 3, _MOST))


@lru_cache(maxsize=1)
def _tables() -> tuple[NDArray[np.float32], Pictures]:
    """Linear light of sRGB bytes, and sRGB bytes of 4096 steps of linear light."""
    linear = to_linear(np.arange(256) / 255.0).astype(np.float32)
    return linear, np.round(to_encoded(np.arange(4096) / 4095.0) * 255.0).astype(np.uint8)


def mean_light(pictures: Pictures) -> Pictures:
    """The mean of pictures [N, H, W, 3] in linear light, uint8 [H, W, 3]."""
    if len(pictures) == 1:
        return pictures[0]
    linear, encoded = _tables()
    light = linear[pictures[0]]
    for picture in pictures[1:]:
        light += linear[picture]
    light *= 4095.0 / len(pictures)
    light += 0.5
    return np.asarray(encoded[light.astype(np.uint16)])


def exposed_frames(
    frames: NDArray[np.integer],
    count: int,
    angle: float,
    needed: Callable[[NDArray[np.float64]], int],
    draw: Callable[[NDArray[np.float64]], Pictures],
) -> Pictures:
    """Frames of a take of ``count``, uint8 [F, H, W, 3], each the mean of what the open shutter sees.

    needed: how many moments a frame needs by the two between which the shutter is open; draw: pictures
    [N, H, W, 3] at moments [N], in frames
    """
    times = []
    for frame in frames.tolist():
        ends = np.clip(np.array([-0.5, 0.5]) * angle / 360.0 + frame, 0, count - 1)
        many = needed(ends)
        times.append(open_moments(frame, angle, many, count) if many > 1 else np.array([float(frame)]))
    return np.stack([mean_light(draw(each)) for each in times])
