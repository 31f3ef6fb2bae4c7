"""The looks: clay is of one material, ink is strokes on paper that stay where they are."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray
from raster_scenes import box, looking, room, scene, sphere, still

from runtime.materials import MATERIALS, SKIN_SHADE
from runtime.raster.kernels.hatch import LIGHTEST
from runtime.raster.looks import glass_colors, gloom, packed_light, paper_tones
from runtime.raster.renderer import Renderer
from runtime.raster.types import STYLES, RenderScene, Views
from runtime.world import Light

GREY = ((0.5, 0.5, 0.5), (0.5, 0.5, 0.5))


@lru_cache(maxsize=4)
def renderer(look: str) -> Renderer:
    return Renderer("cpu", STYLES[look])


def drawn(
    look: str, content: RenderScene, views: Views, size: tuple[int, int] = (160, 90)
) -> NDArray[np.uint8]:
    renderer(look).load(content)
    return renderer(look).render(still(2), views, size).color


EYE = looking([(2.6, -1.8, 1.5)], [(2.0, 1.8, 1.0)])


@pytest.mark.parametrize("look", sorted(STYLES))
def test_a_batch_gives_what_its_views_give_one_by_one(look: str) -> None:
    eyes, aims = [(2.6, -1.8, 1.5), (0.5, 0.2, 1.6)], [(2.0, 1.8, 1.0)] * 2
    both = drawn(look, room(), looking(eyes, aims), (61, 45))
    for n in range(2):
        alone = drawn(look, room(), looking(eyes[n : n + 1], aims[:1]), (61, 45))
        np.testing.assert_array_equal(both[n], alone[0])


def test_clay_has_hardly_any_colour_and_board_has() -> None:
    def colourfulness(look: str) -> float:
        picture = drawn(look, room(), EYE)[0].astype(float)
        return float(np.quantile(np.ptp(picture, axis=-1), 0.99))

    assert colourfulness("clay") < 60 < 90 < colourfulness("board")


def test_clay_is_deep_in_corners() -> None:
    content = scene([box((-2, -2, -0.1), (2, 2, 0)), box((-2, 1.9, 0), (2, 2, 2.6), part=1)], [])
    views = looking([(0.0, -2.5, 1.3)], [(0.0, 1.9, 0.4)])
    floor = drawn("clay", content, views)[0, :, 80].astype(float).mean(axis=-1)
    corner = int(np.argmin(floor[30:]) + 30)
    assert floor[corner] < 0.8 * floor[-1], "the light falls off towards the corner"


def test_ink_is_black_and_white() -> None:
    picture = drawn("ink", room(), EYE, (320, 180))[0].astype(float)
    assert np.ptp(picture, axis=-1).max() < 14, "no colour"
    luma = picture.mean(axis=-1)
    assert (luma > 235).mean() > 0.35, "paper"
    assert (luma < 140).mean() > 0.015, "ink"


DAY = Light(
    (0.3, 0.2, 0.9), (0.70, 0.66, 0.56), (1.12, 1.11, 1.10), (1.04, 1.0, 0.94), ((0.93,) * 3, (0.8,) * 3)
)
NIGHT = Light(
    (0.3, 0.2, 0.9), (0.33, 0.34, 0.41), (0.30, 0.34, 0.44), (0.2, 0.2, 0.3), ((0.46,) * 3, (0.23,) * 3)
)


def test_a_night_is_hatched_and_a_day_is_not() -> None:
    assert gloom(DAY) == 0.0
    assert gloom(NIGHT) == 1.0
    pale = box((-40, -40, -0.1), (40, 40, 0), color=(0.9, 0.9, 0.9))
    views = looking([(0.0, -3.0, 1.6)], [(0.0, 3.0, 1.6)])
    inked = {}
    for name, light in (("day", DAY), ("night", NIGHT)):
        picture = drawn("ink", scene([pale], [], light=light), views, (320, 180))[0].astype(float)
        inked[name] = [float((rows < 200).mean()) for rows in (picture[:70], picture[140:])]
    assert max(inked["day"]) == 0.0, "sky and floor stay white"
    assert min(inked["night"]) > 0.05, "both have strokes"
    assert max(inked["night"]) < 0.6, "and are not black"


def test_strokes_of_the_sky_stay_where_they_are() -> None:
    """A step to any side moves nothing in the sky, and a turn moves it as a whole."""
    content = scene([box((-4, 40, -0.1), (4, 41, 0))], [], light=NIGHT)
    eyes = [(0.0, 0.0, 1.5), (3.0, 1.0, 2.5)]
    views = looking(eyes, [(x, y + 100.0, z + 30.0) for x, y, z in eyes])
    first, second = drawn("ink", content, views, (320, 180))
    assert (first[:90] < 200).mean() > 0.05
    assert np.abs(first[:90].astype(int) - second[:90]).mean() < 0.5


JEANS = (0.2, 0.22, 0.3)  # sRGB


def figure(away: float, color: tuple[float, float, float] = JEANS) -> tuple[RenderScene, Views]:
    """Somebody like a post, so many metres away, before a wall at night that is hatched all over."""
    content = scene(
        [box((-30, 12.0, -20), (30, 12.1, 20), color=(0.3, 0.3, 0.3))],
        [box((-0.3, away, 0.2), (0.3, away + 0.3, 1.8), color=color)],
        light=NIGHT,
    )
    return content, looking([(0.0, 0.0, 1.0)], [(0.0, away, 1.0)])


def of_figure(
    away: float, size: tuple[int, int] = (320, 180)
) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Luma [H, W], and where the figure is."""
    content, views = figure(away)
    renderer("ink").load(content)
    frames = renderer("ink").render(still(2), views, size, ids=True)
    assert frames.ids is not None
    there = frames.ids[0] == content.skinned_object[0]
    return frames.color[0].astype(float).mean(axis=-1), there


def test_people_afar_have_a_wash_and_people_near_have_strokes() -> None:
    afar, there = of_figure(8.0)
    inner = cv2.erode(there.astype(np.uint8), np.ones((7, 7))) > 0
    assert inner.sum() > 50
    assert np.ptp(afar[inner]) < 8, "flat"
    assert 90 < afar[inner].mean() < 220, "grey"
    near, there = of_figure(0.5)
    inner = cv2.erode(there.astype(np.uint8), np.ones((7, 7))) > 0
    assert np.ptp(near[inner]) > 100, "strokes over a pale wash"


def test_strokes_of_a_set_end_before_people_and_are_paler_than_theirs() -> None:
    near, front = of_figure(0.5)
    luma, there = of_figure(8.0)
    around = [cv2.dilate(there.astype(np.uint8), np.ones((n, n))) > 0 for n in (3, 5, 13)]
    halo, wall = around[1] & ~around[0], ~around[2]
    assert (luma[wall] < 200).mean() > 0.1, "the wall is hatched"
    assert (luma[halo] < 200).mean() < 0.02
    assert luma[wall].min() > near[front].min() + 20, "black is for people"


def test_what_is_too_narrow_for_strokes_has_none() -> None:
    dark = (0.2, 0.2, 0.2)
    poles = [box((x, 4.0, -9), (x + wide, 4.0 + wide, 9), dark) for x, wide in ((-0.6, 0.02), (0.3, 0.3))]
    views = looking([(0.0, 0.0, 1.0)], [(0.0, 4.0, 1.0)])
    luma = drawn("ink", scene(poles, [], light=NIGHT), views, (1280, 720))[0].astype(float).mean(axis=-1)
    focal = 1280 * 35 / 36
    narrow, wide = (luma[50:670, 640 + round(x / 4 * focal)] for x in (-0.59, 0.45))
    flat, lined = (float(np.diff(np.quantile(each, (0.05, 0.95)))[0]) for each in (narrow, wide))
    assert flat < 35 < 100 < lined


def test_a_door_is_hatched_like_the_wall_it_is_in() -> None:
    leaf = box((-1, 2, 0), (1, 2.1, 2), color=(0.05, 0.06, 0.1))
    views = looking([(0.0, -1.0, 1.0)], [(0.0, 2.0, 1.0)])

    def ink(content: RenderScene) -> float:
        renderer("ink").load(content)
        palettes = still(1 + int(content.joints.max(initial=0)))
        picture = renderer("ink").render(palettes, views, (160, 90)).color
        return float((picture[0, 30:60, 60:100] < 160).mean())

    hung = replace(scene([], [leaf]), fitting=np.full(len(leaf.faces), -1, np.int32))
    assert ink(hung) > 0.05
    assert ink(hung) == pytest.approx(ink(scene([leaf], [])), abs=0.02)


def test_strokes_stay_on_what_they_are_drawn_on() -> None:
    """A step to the side moves the strokes of a ball with the ball."""
    content = scene([], [sphere((0, 3, 1.5), (0.8, 0.8, 0.8), (0.35, 0.3, 0.3), rings=40)])
    size, step = (320, 180), 0.02
    views = looking([(0.0, 0.0, 1.5), (step, 0.0, 1.5)], [(0.0, 3.0, 1.5), (step, 3.0, 1.5)])
    pictures = drawn("ink", content, views, size)
    first, second = (p.astype(float).mean(axis=-1) for p in pictures)
    focal = 320 * 35 / 36
    inner = slice(60, 120), slice(120, 200)

    def apart(shift: int) -> float:
        return float(np.abs(first - np.roll(second, shift, axis=1))[inner].mean())

    near = round(step / 2.2 * focal)
    assert min(apart(near), apart(near - 1)) < 0.6 * apart(-near)


def test_paper_takes_dark_cloth_for_black_and_leaves_skin_open() -> None:
    light = Light((0.3, 0.2, 0.9), (0.7, 0.66, 0.56), (1.1, 1.1, 1.1), (1.0, 1.0, 1.0), GREY)
    cloth, plain = MATERIALS.index("cloth"), MATERIALS.index("plain")
    pale, tan, navy = (0.8, 0.8, 0.8), (0.5, 0.3, 0.16), (0.015, 0.02, 0.06)
    tones = paper_tones(np.array([pale, tan, navy]), np.array([cloth, plain, cloth]), light)
    assert tones[0].tolist() == [1.0, 0.0, 0.0]
    assert tones[1, 1:].max() < 0.05
    assert tones[2, 1:].min() > 0.7
    as_skin, as_cloth = paper_tones(np.array([tan, tan]) / 3, np.array([plain, cloth]), light)
    assert (as_skin < as_cloth)[1:].all()


def test_paper_has_strokes_below_the_jaw_in_any_light() -> None:
    for share in (0.3, 1.0):
        light = Light((0.3, 0.2, 0.9), (share, share, share), (share, share, share), (0.6, 0.6, 0.6), GREY)
        tan = np.array([(0.5, 0.3, 0.16)] * 2)
        (_, skin, _), (_, below, _) = paper_tones(
            tan, np.array([MATERIALS.index("plain"), SKIN_SHADE]), light
        )
        assert skin < LIGHTEST[0] < below


def test_clay_is_nearly_as_light_at_night_as_by_day() -> None:
    def sky(share: float) -> float:
        sun, above = (share, 0.97 * share, 0.87 * share), (0.76 * share, 0.8 * share, 0.85 * share)
        packed = packed_light(Light((0.3, 0.2, 0.9), sun, above, (0.6, 0.58, 0.54), GREY), STYLES["clay"])
        return float(packed[6:9].sum())

    assert 0.7 * sky(1.0) < sky(0.4) < 0.9 * sky(1.0)


def test_glass_has_its_tint_only_where_there_are_colours() -> None:
    tinted = np.array([[0.2, 0.5, 0.3]])
    assert (glass_colors(tinted, STYLES["board"]) == tinted.astype(np.float32)).all()
    for name in ("clay", "ink"):
        assert np.ptp(glass_colors(tinted, STYLES[name])) == 0
