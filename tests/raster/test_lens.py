"""Depth of field: circles of the right size, nothing sharp that leaks, foregrounds that bleed softly."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest
from numpy.typing import NDArray
from raster_scenes import box, looking, scene, still

from runtime.raster.film import to_linear
from runtime.raster.optics import lens_of
from runtime.raster.renderer import Renderer
from runtime.raster.types import Camera, RenderScene, Style, Views

PLAIN = Style("plain", outline=False, tones=0, quiet=0.0, shadows=False, occlusion=False)
SIZE = (321, 183)  # odd: crosses tiles and halvings
RED, GREEN, BLUE = (0.8, 0.05, 0.05), (0.05, 0.7, 0.05), (0.05, 0.05, 0.8)


@lru_cache(maxsize=2)
def renderer(style: Style = PLAIN) -> Renderer:
    return Renderer("cpu", style)


def board(y: float, x: tuple[float, float], color: tuple[float, float, float]) -> object:
    """An upright board, ``y`` metres in front of the camera at the origin, which looks along +Y."""
    return box((x[0], y, -3.0), (x[1], y + 0.02, 3.0), color)


def shoot(
    s: RenderScene, focus: float | None, aperture: float = 2.0, focal: float = 50.0, count: int = 1
) -> NDArray[np.uint8]:
    r = renderer()
    r.load(s)
    views = looking([(0.0, 0.0, 0.0)] * count, [(0.0, 5.0, 0.0)] * count, focal=focal)
    camera = replace(views.camera, aperture=aperture)
    if focus is not None:
        camera = replace(camera, focus=np.full(count, focus, np.float32))
    return r.render(still(1), Views(camera, views.moment, views.hidden), SIZE).color


def radius(focus: float, aperture: float, depth: float, focal: float = 50.0) -> float:
    """Pixels, from the thin lens: half of f² |z − s| / (N z (s − f))."""
    s, z = 1000.0 * focus, 1000.0 * depth
    return 0.5 * focal**2 * abs(z - s) / (aperture * z * (s - focal)) * SIZE[0] / 36.0


def edge(color: NDArray[np.uint8], channel: int = 0) -> NDArray[np.float64]:
    """Light of the middle row in one channel, from 0 to 1."""
    row = to_linear(color[0, SIZE[1] // 2, :, channel] / 255.0)
    return (row - row.min()) / (row.max() - row.min())


def spread(light: NDArray[np.float64]) -> float:
    """Standard deviation in pixels of how light changes over an edge."""
    change = np.abs(np.diff(light))
    at = np.arange(len(change))
    middle = (change * at).sum() / change.sum()
    return float(np.sqrt((change * (at - middle) ** 2).sum() / change.sum()))


def test_without_focus_or_aperture_nothing_changes() -> None:
    s = scene([board(3.0, (-5.0, 0.1), RED), board(9.0, (-9.0, 9.0), GREEN)], [])
    sharp = shoot(s, None, 1.4)
    assert (shoot(s, 3.0, 0.0) == sharp).all()
    assert (shoot(s, 3.0, 64.0, focal=8.0) == shoot(s, None, focal=8.0)).all()  # nearly a pinhole


@pytest.mark.parametrize("aperture", [1.0, 1.4, 2.0, 2.8, 5.6])
def test_a_background_edge_is_as_wide_as_its_circle(aperture: float) -> None:
    s = scene([board(8.0, (-9.0, 0.0), RED), board(8.05, (0.0, 9.0), BLUE)], [])
    found = spread(edge(shoot(s, 2.0, aperture)))
    wanted = radius(2.0, aperture, 8.0)
    assert 0.85 < found / (wanted / 2.0) < 1.35 or abs(found - wanted / 2.0) < 0.5  # of a disc: r / 2


@pytest.mark.parametrize("aperture", [0.7, 1.4, 2.8, 5.6])
def test_a_foreground_bleeds_over_what_is_sharp_behind_it(aperture: float) -> None:
    s = scene([board(1.0, (-2.0, 0.0), RED), board(4.0, (-9.0, 9.0), BLUE)], [])
    light = edge(shoot(s, 4.0, aperture))
    wanted = radius(4.0, aperture, 1.0)
    assert 0.8 < spread(light) / (wanted / 2.0) < 1.35 or abs(spread(light) - wanted / 2.0) < 0.5
    assert (np.diff(light) < 0.02).all()  # no halo: ever less of it
    assert np.abs(np.diff(light)).max() < 1.5 / wanted + 0.06  # no hard edge either
    middle = int(np.argmin(np.abs(light - 0.5)))
    assert abs(middle - SIZE[0] / 2) < 0.2 * wanted + 1.5


def test_what_is_in_focus_neither_blurs_nor_leaks() -> None:
    person, wall = board(2.0, (-0.4, 0.4), RED), board(9.0, (-20.0, 20.0), GREEN)
    blurred, sharp = shoot(scene([person, wall], []), 2.01, 1.4), shoot(scene([person, wall], []), None)
    empty = shoot(scene([wall], []), 2.01, 1.4)
    on = sharp[0, :, :, 0].astype(int) > sharp[0, :, :, 1]
    inner, outer = on.copy(), ~on
    for mask in (inner, outer):
        for _ in range(2):  # but for the evened stair-steps
            mask &= np.roll(mask, 1, 1) & np.roll(mask, -1, 1)
    assert inner.any()
    assert outer.any()
    assert (np.abs(blurred[0].astype(int) - sharp[0])[inner] <= 1).all()
    assert (np.abs(blurred[0].astype(int) - empty[0])[outer] <= 2).all()


def test_something_blurred_does_not_run_over_what_stands_before_it() -> None:
    """Behind the focus too, but nearer: its own circle is what spreads."""
    s = scene([board(3.0, (-9.0, 0.0), RED), board(30.0, (-30.0, 30.0), BLUE)], [])
    light = edge(shoot(s, 2.5, 1.4))
    own, behind = radius(2.5, 1.4, 3.0), radius(2.5, 1.4, 30.0)
    assert behind > 4 * own
    middle = SIZE[0] // 2
    assert light[int(middle - 1.5 * own - 3)] > 0.97


def test_a_slanted_floor_blurs_without_steps() -> None:
    """From near through sharp to far: an even colour stays even."""
    floor = box((-9.0, 0.4, -1.02), (9.0, 60.0, -1.0), RED)
    for focus in (1.2, 2.5, 6.0):
        blurred, sharp = shoot(scene([floor], []), focus, 1.0)[0], shoot(scene([floor], []), None)[0]
        below = slice(SIZE[1] * 3 // 4, SIZE[1] - 1)
        assert np.abs(blurred[below].astype(int) - sharp[below]).max() <= 3


def test_a_batch_is_what_its_views_are_one_by_one() -> None:
    s = scene([board(1.0, (-2.0, 0.0), RED), board(4.0, (-9.0, 9.0), BLUE)], [])
    one = shoot(s, 2.0, 1.4)
    three = shoot(s, 2.0, 1.4, count=3)
    assert (three == one).all()
    assert (shoot(s, 2.0, 1.4) == one).all()


def test_lens_of_refuses_what_is_none() -> None:
    views = looking([(0.0, 0.0, 0.0)], [(0.0, 5.0, 0.0)], focal=50.0)

    def lens(focus: list[float], aperture: float) -> object:
        camera: Camera = replace(views.camera, focus=np.array(focus, np.float32), aperture=aperture)
        return lens_of(camera, 1, 1280)

    assert lens([2.0], 0.0) is None
    found = lens([2.0], 2.0)
    np.testing.assert_allclose(found, [[2500.0 / (4.0 * 1950.0) * 1280 / 36.0, 2.0]], rtol=1e-5)
    for focus, aperture in (
        ([2.0, 2.0], 2.0),
        ([np.nan], 2.0),
        ([-1.0], 2.0),
        ([2.0], -2.0),
        ([2.0], np.inf),
    ):
        with pytest.raises(ValueError, match=r"Camera\."):
            lens(focus, aperture)
