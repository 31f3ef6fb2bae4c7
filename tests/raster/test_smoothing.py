"""Smoothing: sixteen pixels at a time as one by one, and what it does to a stair-step."""

from types import SimpleNamespace

import numpy as np
import pytest
from numpy.typing import NDArray

from runtime.raster.device import aligned, start
from runtime.raster.film import to_encoded, to_linear
from runtime.raster.passes import Layer, Passes
from runtime.raster.types import Style

RUN = 16
LEVELS = 4


def packed(colors: NDArray[np.integer]) -> NDArray[np.uint32]:
    """Colours [..., 3] as pictures in between keep them: bytes, and the luma in the fourth."""
    c = colors.astype(np.uint32)
    luma = (c[..., 0] * 5 + c[..., 1] * 9 + c[..., 2] * 2) >> 4
    return c[..., 0] | (c[..., 1] << 8) | (c[..., 2] << 16) | (luma << 24)


def on_lines(array: NDArray[np.generic]) -> NDArray[np.generic]:
    out = aligned(array.shape, array.dtype)
    out[...] = array
    return out


def smoothed(
    colors: NDArray[np.integer], marks: NDArray[np.int32], level: NDArray[np.int32], by_runs: bool
) -> NDArray[np.uint8]:
    """Views [N, H, W, 3] smoothed by runs or pixel by pixel; what is not written stays 7."""
    views, height, width, _ = colors.shape
    passes = Passes(start("cpu"), lambda name, shape, dtype: aligned(shape, dtype), Style())
    out = on_lines(np.full(colors.size, 7, np.uint8)).reshape(colors.shape)
    picture = on_lines(packed(colors).reshape(-1))
    # nothing is seen in the pixels that could tell of edges
    none, nowhere = np.zeros(1, np.int32), np.zeros(picture.shape, np.uint64)
    layer = Layer(nowhere, picture, np.zeros_like(picture), none, marks.reshape(-1), level.reshape(-1))
    arrays = {"vertices": np.zeros((3, 3), np.float32), "faces": np.zeros((1, 3), np.int32)}
    arrays["beside"] = arrays["faces"] - 1
    scene = SimpleNamespace(static_faces=1, moving_surface=1)
    loaded = SimpleNamespace(arrays=arrays, static_vertices=3, scene=scene)
    moments = SimpleNamespace(position=np.zeros((1, 1, 3), np.float32))
    seen = (np.ones((views, 16), np.float32), np.zeros(views, np.int32), views)
    if not by_runs:
        passes.run = width + 1  # no row is whole runs
    passes.even_out(loaded, moments, layer, seen, out, (width, height))
    return out


def blocky(seed: int, views: int, height: int, width: int) -> NDArray[np.integer]:
    """Slanted bands of flat colours under a little noise, so that there are long edges and specks."""
    rng = np.random.default_rng(seed)
    y, x = np.mgrid[:height, :width]
    out = np.zeros((views, height, width, 3), np.int64)
    for view in range(views):
        slope = rng.uniform(-0.4, 0.4, 2)
        across, down = np.floor((x + slope[0] * y) / 13), np.floor((y + slope[1] * x) / 9)
        out[view] = rng.integers(0, 256, (64, 3))[(7 * across + down).astype(int) % 64]
    noise = rng.integers(-6, 7, out.shape) * (rng.random(out.shape[:-1]) < 0.3)[..., None]
    return np.clip(out + noise, 0, 255)


@pytest.mark.parametrize(("width", "height"), [(16, 33), (48, 37), (96, 5)])
def test_sixteen_at_a_time_give_the_bytes_of_one_by_one(width: int, height: int) -> None:
    rng = np.random.default_rng(5)
    views = 3
    colors = blocky(width, views, height, width)
    runs = (views, height, width // RUN)
    marks = rng.integers(0, 1 << RUN, runs).astype(np.int32) * (rng.random(runs) < 0.7)
    level = rng.integers(0, LEVELS, runs).astype(np.int32)
    quick = smoothed(colors, marks.astype(np.int32), level, True)
    slow = smoothed(colors, marks.astype(np.int32), level, False)
    assert np.array_equal(quick, slow)
    written = np.repeat(level > 0, RUN, axis=-1)
    assert (quick[~written] == 7).all()
    changed = (quick != colors).any(axis=-1)[written]
    assert 0.1 < changed.mean() < 0.9, "the picture has too little to smooth, or all of it was"


def test_a_stair_step_becomes_the_slope_it_stands_for() -> None:
    """Steps of eight columns: along each, a pixel beside the edge takes its share of the other side."""
    width, height = 64, 24
    y, x = np.mgrid[:height, :width]
    light = y > x // 8 + 6
    colors = np.where(light, 200, 40)[None, ..., None].repeat(3, axis=-1)
    marks = np.full((1, height, width // RUN), 0xFFFF, np.int32)
    out = smoothed(colors, marks, np.full_like(marks, 1), True)[0, ..., 0]
    # how much of each pixel lies under the slope through the middles of the steps
    share = np.clip(y + 0.5 - (x + 0.5 - 4) / 8 - 6.5, 0.0, 1.0)
    linear = to_linear(np.array([40, 200]) / 255.0)
    wanted = to_encoded(linear[0] + (linear[1] - linear[0]) * share) * 255.0
    inside = np.s_[2:-2, 12:-12]
    before, after = np.abs(colors[0, ..., 0] - wanted)[inside], np.abs(out - wanted)[inside]
    assert after.mean() < 0.4 * before.mean()
    flat = (share == 0) | (share == 1)
    far = flat & np.roll(flat, 1, 0) & np.roll(flat, -1, 0)
    assert np.array_equal(out[inside][far[inside]], colors[0, ..., 0][inside][far[inside]])
