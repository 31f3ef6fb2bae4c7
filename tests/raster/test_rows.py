"""Rows taken from the shaded ones beside them: the same on every path, and close to shading them all."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from raster_scenes import looking, room, scene, sphere, still

from runtime.raster.kernels import rows
from runtime.raster.renderer import Renderer
from runtime.raster.types import Style, Views

SIZE = (320, 180)


def drawn(drawer: Renderer, views: Views) -> NDArray[np.uint8]:
    return drawer.render(still(2), views, SIZE).color


@pytest.fixture(scope="module")
def drawer() -> Renderer:
    made = Renderer("cpu", Style())
    made.load(room())
    return made


def test_every_row_is_shaded_or_lies_between_shaded_rows_of_its_band() -> None:
    lines, between = rows.planned(3, 77)
    assert sorted([*lines, *between[:, 0]]) == list(range(3 * 77))
    shaded = set(lines.tolist())
    for row, above, below, weight in between.tolist():
        assert {above, below} <= shaded
        assert above // 77 == below // 77
        assert above % 77 // rows.BAND == below % 77 // rows.BAND
        assert abs(weight / 256 - (row - above) / (below - above)) < 0.01


def test_sixteen_pixels_at_a_time_are_as_one_by_one(
    monkeypatch: pytest.MonkeyPatch, drawer: Renderer
) -> None:
    views = looking([(2.6, -1.8, 1.5)], [(2.0, 1.8, 1.0)])
    together = drawn(drawer, views)
    monkeypatch.setattr(drawer._passes, "_match_runs", None)
    assert (drawn(drawer, views) == together).all()


def test_close_to_shading_every_row(monkeypatch: pytest.MonkeyPatch, drawer: Renderer) -> None:
    views = looking([(2.6, -1.8, 1.5)], [(2.0, 1.8, 1.0)])
    some = drawn(drawer, views).astype(int)
    every = (np.arange(SIZE[1], dtype=np.int32), np.zeros((0, 4), np.int32))
    monkeypatch.setattr(rows, "planned", lambda views, height: every)
    apart = np.abs(drawn(drawer, views) - some).max(axis=-1)
    assert (apart > 0).any()
    assert (apart > 8).mean() < 0.005


def test_surfaces_of_triangles_as_small_as_pixels_are_not_shaded_row_by_row(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    ball = sphere((0, 0, 0), (0.5, 0.5, 0.5), (0.8, 0.4, 0.3), rings=128)
    drawer = Renderer("cpu", Style(outline=False))
    drawer.load(scene([], [ball]))
    views, size = looking([(0.0, -2.2, 0.3)], [(0.0, 0.0, 0.0)]), (192, 112)
    some = drawer.render(still(1), views, size, ids=True)
    left = drawer._buffers["left"][: size[0] * size[1] // 16].reshape(size[1], -1)
    bits = (left[..., None] >> np.arange(16) & 1).reshape(size[1], size[0]) == 1
    _, between = rows.planned(1, size[1])
    assert some.ids is not None
    shown = np.zeros(size[::-1], bool)
    shown[between[:, 0]] = some.ids[0][between[:, 0]] >= 0
    assert shown.sum() > 3000
    assert bits[shown].mean() < 0.2  # at the outline
    every = (np.arange(size[1], dtype=np.int32), np.zeros((0, 4), np.int32))
    monkeypatch.setattr(rows, "planned", lambda views, height: every)
    apart = np.abs(drawer.render(still(1), views, size).color.astype(int) - some.color).max(axis=-1)[0]
    assert (apart > 8).mean() < 0.002
