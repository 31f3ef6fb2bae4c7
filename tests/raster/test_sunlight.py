"""Sun through windows: patches of the window's shape, people's shadows in them, and nothing elsewhere."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from raster_scenes import LIGHT, box, looking, scene, sphere, still

from runtime.mesh import Mesh
from runtime.raster.renderer import Renderer
from runtime.raster.types import STYLES

SIZE = (161, 121)
SUN = tuple(np.array((0.0, -0.7, 0.714)) / np.linalg.norm((0.0, -0.7, 0.714)))
INSIDE = replace(LIGHT, sun=SUN, windows=0.8)
FLOOR, CEILING = box((-2, 0, -0.2), (2, 4, 0)), box((-2.4, -0.2, 2.6), (2.4, 4, 2.8))
#: The south wall around a window from x -0.5 to 0.5 and from 1 m to 2 m: the sun falls on y 1 to 2.
WALL = [
    box((-2.4, -0.1, 0), (-0.5, 0, 2.6)),
    box((0.5, -0.1, 0), (2.4, 0, 2.6)),
    box((-0.5, -0.1, 0), (0.5, 0, 1)),
    box((-0.5, -0.1, 2), (0.5, 0, 2.6)),
]


@pytest.fixture(scope="module")
def renderer() -> Renderer:
    return Renderer("cpu", STYLES["board"])


def drawn(renderer: Renderer, windows: float, wall: list[Mesh], moving: list[Mesh]) -> NDArray[np.int64]:
    """The floor from under the ceiling, row 0 north: int64 [H, W], luma of a kind."""
    light = replace(INSIDE, windows=windows)
    content = scene([FLOOR, CEILING, *wall], moving, [-1, -1] + [0] * len(wall), light)
    renderer.load(content)
    views = looking([(0.0, 1.6, 2.55)], [(0.0, 1.65, 0.0)], focal=14, walls=1)
    color = renderer.render(still(max(len(moving), 1), 1), views, SIZE).color[0]
    return np.asarray(color.astype(np.int64).sum(2))


def at(x: float, y: float) -> tuple[int, int]:
    """The pixel of a place on the floor, about."""
    scale = 14 / 36 * SIZE[0] / 2.55
    return round(SIZE[1] / 2 - (y - 1.65) * scale), round(SIZE[0] / 2 + x * scale)


def test_a_window_throws_a_patch_of_its_shape(renderer: Renderer) -> None:
    """Lighter inside it, and exactly as without sun beside it, before it and behind it."""
    more = drawn(renderer, 0.8, WALL, []) - drawn(renderer, 0.0, WALL, [])
    assert more[at(0.0, 1.4)] > 30
    assert more[at(-0.35, 1.7)] > 30
    for beside in ((0.9, 1.4), (-0.9, 1.4), (0.0, 0.5), (0.0, 2.5)):
        assert more[at(*beside)] == 0, beside
    assert 0.03 < (more > 10).mean() < 0.25


def test_no_sun_comes_through_a_wall_or_ceiling(renderer: Renderer) -> None:
    """Without a window there is no patch, though walls and ceiling let the film light in."""
    shut = [*WALL, box((-0.5, -0.1, 1), (0.5, 0, 2))]
    assert (drawn(renderer, 0.8, shut, []) == drawn(renderer, 0.0, shut, [])).all()


def test_who_stands_in_the_sun_throws_a_shadow_in_the_patch(renderer: Renderer) -> None:
    """Where the ball's shadow falls, the patch is as dark as without sun."""
    ball = sphere((0.0, 1.2, 0.3), (0.2, 0.2, 0.2), (0.8, 0.2, 0.2))
    more = drawn(renderer, 0.8, WALL, [ball]) - drawn(renderer, 0.0, WALL, [ball])
    assert more[at(0.0, 1.55)] < 8
    assert more[at(0.38, 1.55)] > 30


def test_rows_that_are_shaded_later_keep_the_sun(renderer: Renderer) -> None:
    """What is shaded along with pixels that are left, in rows between shaded ones, is in the sun as well."""
    poles = [
        sphere((x, 1.5, 0.25), (0.03, 0.03, 0.25), (0.8, 0.2, 0.2), rings=6) for x in (-0.3, -0.1, 0.1, 0.3)
    ]
    without = drawn(renderer, 0.0, WALL, poles)
    more, floor = drawn(renderer, 0.8, WALL, poles) - without, without > 300  # the poles themselves are dark
    assert (more > 25).mean() > 0.03
    for thick in (1, 2):
        above, below = more[: -1 - thick], more[1 + thick :]
        for k in range(1, thick + 1):
            between = more[k : k - 1 - thick]
            lost = (above > 25) & (below > 25) & (between < 5)
            # at its foot a pole's own shadow is a pixel or two
            assert (lost & floor[k : k - 1 - thick]).sum() <= 2
    assert more.max() < 1.3 * more[at(0.0, 1.2)]
