"""Where things stand on furniture the light falls off around them, and not on the floor below."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import pytest
from numpy.typing import NDArray
from raster_scenes import box, looking, scene, sphere, still

from runtime.raster import empty
from runtime.raster.renderer import Renderer
from runtime.raster.types import STYLES, RenderScene, Views
from runtime.world import Light

SIZE = (320, 180)
#: From all sides, so that nothing but what is close by keeps it off.
SKY = Light((0.0, 0.0, 1.0), (0, 0, 0), (0.9, 0.9, 0.9), (0.9, 0.9, 0.9), ((0.9,) * 3, (0.9,) * 3))
TOP = 0.8


@lru_cache(maxsize=2)
def drawer(style: str = "board") -> Renderer:
    return Renderer("cpu", STYLES[style])


def table() -> RenderScene:
    """A mug's width of a box on a table of 2 m, over a floor."""
    floor = box((-4, -4, -0.1), (4, 4, 0), (0.7, 0.7, 0.7))
    top = box((-1, -1, TOP - 0.05), (1, 1, TOP), (0.7, 0.7, 0.7), part=1)
    mug = box((-0.05, -0.05, TOP), (0.05, 0.05, TOP + 0.1), (0.7, 0.1, 0.1))
    return scene([floor, top], [mug, sphere((50, 50, 0.3), (0.1, 0.1, 0.1), (1, 1, 1))], light=SKY)


def lifted(heights: list[float], across: float = 0.0) -> NDArray[np.float32]:
    moments = still(2, len(heights))
    moments[:, 0, 2, 3] = heights
    moments[:, 0, 0, 3] = across
    return moments


def seen(palettes: NDArray[np.float32], views: Views) -> NDArray[np.float64]:
    """Lightness [N, H, W]."""
    return drawer().render(palettes, views, SIZE).color.astype(float).mean(axis=-1)


def above(count: int) -> Views:
    return looking([(0.0, -0.8, TOP + 1.2)] * count, [(0.0, 0.0, TOP)] * count, moments=list(range(count)))


def test_light_falls_off_around_what_stands_on_a_table() -> None:
    drawer().load(table())
    stands, up, away = seen(lifted([0.0, 0.35, 0.0], across=0.0), above(3))[:3]
    darker = up - stands
    near, far = darker[96:104, 138:182], darker[150:170, 20:60]
    assert near.max() > 8, "the table is darker at its foot"
    assert np.abs(far).max() < 2, "and as it was farther off"
    np.testing.assert_array_equal(stands, away)


def test_a_thing_that_is_lifted_leaves_its_shadow_behind() -> None:
    drawer().load(table())
    heights = [0.0, 0.05, 0.12, 0.4]
    rows = seen(lifted(heights), above(4))
    floor = rows[3]
    # left of the box, which rises along the middle of the picture
    lost = [float((floor - row)[92:108, 120:150].mean()) for row in rows]
    assert lost == sorted(lost, reverse=True)
    assert lost[0] > 1.5 * lost[2] > 0


def test_the_floor_under_a_table_does_not_see_what_stands_on_it() -> None:
    drawer().load(table())
    views = looking([(0.0, -2.4, 0.5)] * 2, [(0.0, 0.0, 0.0)] * 2, moments=[0, 1])
    on, off = seen(lifted([0.0, 0.0]) + 0, views), seen(lifted([3.0, 3.0]), views)
    assert np.abs(on - off)[:, 100:].max() < 1.0


@pytest.mark.parametrize("style", ["board", "clay"])
def test_a_camera_that_stands_still_sees_the_same(monkeypatch: pytest.MonkeyPatch, style: str) -> None:
    """What is taken over from the empty set has nothing of the shadow, and what has is drawn anew."""
    drawer(style).load(table())
    moments, views = lifted([0.0] * 5), above(5)
    moments[:, 0, 0, 3] = np.linspace(0, 0.4, 5)
    with monkeypatch.context() as patch:
        patch.setattr(empty, "REUSED", 10**9)
        expected = drawer(style).render(moments, views, SIZE).color
    got = drawer(style).render(moments, views, SIZE).color
    np.testing.assert_array_equal(got, expected)


def test_what_stood_there_before_is_forgotten() -> None:
    """One renderer, call after call, draws what a new one does: other places, more and fewer moments, other
    things at rest, another scene with as many cells, and one in which nothing moves."""
    grey = (0.7, 0.8, 0.9)
    dusk = Light((0.0, 0.0, 1.0), (0, 0, 0), grey, grey, (grey, grey))
    other = RenderScene(**{**vars(table()), "light": dusk})
    bare = scene([box((-4, -4, -0.1), (4, 4, 0), (0.7, 0.7, 0.7))], [], light=SKY)
    here, there = lifted([0.0, 0.0, 0.0]), lifted([0.0] * 5, across=0.4)
    here[:, 0, 1, 3] = (-0.3, 0.0, 0.3)
    rests = lifted([0.0, 0.0, 0.0], across=-0.5)
    rests[:, 1, :, 3] = (-50.0, -50.0, TOP), (-49.8, -50.0, TOP), (-49.6, -50.0, TOP)
    one = Renderer("cpu", STYLES["board"])
    for content, palettes in (
        (table(), here), (table(), there), (table(), here), (table(), rests), (table(), there[:2]),
        (other, here), (bare, still(1, 2)), (table(), rests), (table(), lifted([5.0, 5.0])),
    ):  # fmt: skip
        one.load(content)
        new = Renderer("cpu", STYLES["board"])
        new.load(content)
        views = above(len(palettes))
        for _ in range(2):
            got = one.render(palettes, views, SIZE).color
            np.testing.assert_array_equal(got, new.render(palettes, views, SIZE).color)
