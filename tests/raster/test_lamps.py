"""Practical lights: what is a lamp, how it lights what is around it, and that off it changes nothing."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from raster_scenes import LIGHT, box, looking, scene, sphere, still

from runtime.mesh import join
from runtime.raster.lamps import MOST_LAMPS, find_lamps
from runtime.raster.renderer import Renderer
from runtime.raster.types import STYLES, RenderScene

SIZE = (161, 97)
DIM = replace(LIGHT, sun_color=(0.1, 0.1, 0.1), sky=(0.2, 0.2, 0.2), ground=(0.2, 0.2, 0.2))
WARM = (1.0, 0.9, 0.7)
FLOOR = box((-4, -4, -0.2), (4, 4, 0))


def lit(lamps: float, *extra: object, lamp: object = None, moving: object = None) -> RenderScene:
    """A floor and a lamp over it, turned up so far."""
    bulb = lamp if lamp is not None else box((-0.06, -0.06, 1.0), (0.06, 0.06, 1.12), WARM, "glow")
    content = scene([FLOOR, bulb, *extra], [moving] if moving is not None else [])  # type: ignore[list-item]
    return replace(content, light=replace(DIM, lamps=lamps))


def drawn(renderer: Renderer, content: RenderScene) -> NDArray[np.int64]:
    """The floor from above, with something moving where the scene has it: int64 [H, W, 3]."""
    renderer.load(content)
    views = looking([(0.0, -0.3, 5.0)], [(0.0, 0.0, 0.0)])
    palettes = still(int(content.joints.max(initial=0)) + 1, 1)
    return renderer.render(palettes, views, SIZE).color[0].astype(np.int64)


@pytest.fixture(scope="module")
def renderer() -> Renderer:
    return Renderer("cpu", STYLES["board"])


def test_a_lamp_makes_a_warm_pool_that_fades(renderer: Renderer) -> None:
    """Lighter than without it, warmer than grey, and the less so the farther away."""
    more = drawn(renderer, lit(1.0)) - drawn(renderer, lit(0.0))
    row = more[SIZE[1] // 2 + 6]
    near, middle, far = row[92], row[112], row[150]
    assert near.sum() > middle.sum() > far.sum() >= 0
    assert near[0] > 25
    assert near[0] > near[2] + 5  # red over blue


def test_what_stands_between_keeps_lamplight_off(renderer: Renderer) -> None:
    """Behind a screen that hangs beside the bulb the floor stays as dark as without a lamp."""
    screen = box((0.4, -1.5, 0.05), (0.5, 1.5, 2.0))
    free, behind = drawn(renderer, lit(1.0)), drawn(renderer, lit(1.0, screen))
    dark = drawn(renderer, lit(0.0, screen))
    at = (SIZE[1] // 2, 118)  # behind the screen, and not hidden by it
    assert free[at].sum() - dark[at].sum() > 20
    assert behind[at].sum() - dark[at].sum() < 0.4 * (free[at].sum() - dark[at].sum())


def test_people_are_lit_on_the_side_of_the_lamp(renderer: Renderer) -> None:
    """A ball beside the bulb gets more light on the near side than on the far one."""
    ball = sphere((1.0, 0.0, 1.0), (0.35, 0.35, 0.35), (0.7, 0.7, 0.7))
    more = drawn(renderer, lit(1.0, moving=ball)) - drawn(renderer, lit(0.0, moving=ball))
    on_ball = np.abs(more).sum(2)[SIZE[1] // 2 - 1]
    columns = np.arange(SIZE[0])
    near, far = on_ball[(columns > 104) & (columns < 112)], on_ball[(columns > 120) & (columns < 126)]
    assert near.mean() > 1.5 * max(far.mean(), 1.0)


@pytest.mark.parametrize("look", ["board", "clay"])
def test_lamps_that_are_off_change_nothing(look: str) -> None:
    """The same bytes whether a lamp stands there turned off, for all but the lamp itself."""
    renderer = Renderer("cpu", STYLES[look])
    aside = box((2.9, 2.9, 0.0), (3.0, 3.0, 0.1), WARM, "glow")
    off = drawn(renderer, lit(0.0, lamp=aside))
    without = drawn(renderer, lit(1.0, lamp=box((2.9, 2.9, 0.0), (3.0, 3.0, 0.1), WARM)))
    assert (off[:, :100] == without[:, :100]).all()


def test_what_is_a_lamp() -> None:
    """One lamp for what glows in one place of one thing; a hood sends its light down; off there is none."""
    bulb = box((0, 0, 2.0), (0.1, 0.1, 2.1), WARM, "glow")
    hood = box((-0.2, -0.2, 2.15), (0.3, 0.3, 2.2), part=1)
    two = box((3, 0, 1.0), (3.1, 0.1, 1.1), WARM, "glow")
    mesh = join([bulb, hood, two])
    ids = np.repeat(np.array([0, 0, 1], np.int32), 12)
    lamps = find_lamps(mesh, ids, (0.0,), 1.0, STYLES["board"])
    assert np.allclose(lamps.place, [(0.05, 0.05, 2.05), (3.05, 0.05, 1.05)], atol=0.01)
    assert lamps.facing[0][2] < -0.5
    assert np.linalg.norm(lamps.facing[1]) < 0.01
    assert lamps.reach[0] > lamps.reach[1]  # it hangs higher, so it is made to shine farther
    assert not len(find_lamps(mesh, ids, (0.0,), 0.0, STYLES["board"]).place)
    assert not len(find_lamps(mesh, ids, (0.0,), 1.0, STYLES["plain"]).place)


def test_only_the_brightest_of_very_many_lamps_are_kept() -> None:
    """So that a city's windows cost no more than a street's."""
    lights = [box((i, 0, 1), (i + 0.05, 0.05, 1.02 + 0.0003 * i), WARM, "glow") for i in range(80)]
    ids = np.repeat(np.arange(80, dtype=np.int32), 12)
    lamps = find_lamps(join(lights), ids, (0.0,), 1.0, STYLES["board"])
    assert len(lamps.place) == MOST_LAMPS
    assert lamps.place[:, 0].min() > 80 - MOST_LAMPS - 1


def of_lamp(lamp: object) -> float:
    """How much the lamp of a scene throws one metre away."""
    content = lit(1.0, lamp=lamp)
    found = find_lamps(content.static, content.static_object, (0.0,), 1.0, STYLES["board"])
    assert len(found.place) == 1
    return float(found.color.sum())


def test_a_signal_high_up_is_no_street_lamp() -> None:
    """A disc that faces the road is seen from afar, but does not light the ground under it."""
    signal = box((-0.1, -0.02, 3.0), (0.1, 0.02, 3.2), WARM, "glow")
    bulb = box((-0.08, -0.08, 3.0), (0.08, 0.08, 3.16), WARM, "glow")
    assert of_lamp(signal) < 0.05 * of_lamp(bulb)


def test_a_ceiling_panel_leaves_light_for_others() -> None:
    """Each throws a part of what a single bulb at its height does, so that a row of them does not dazzle."""
    panel = box((-0.3, -0.3, 2.7), (0.3, 0.3, 2.72), WARM, "glow")
    bulb = box((-0.1, -0.1, 2.7), (0.1, 0.1, 2.9), WARM, "glow")
    assert 0.2 * of_lamp(bulb) < of_lamp(panel) < 0.5 * of_lamp(bulb)
