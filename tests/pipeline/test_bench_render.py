"""What ``vdsc bench --render`` compares is the same thing twice, and what is said to be outside is."""

from __future__ import annotations

import os
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from runtime.raster.detail import COUNT
from runtime.raster.prepare import prepare
from runtime.raster.renderer import Renderer
from runtime.raster.types import LOOSE, STYLES, Style
from vdsl.pipeline.bench_first import first_picture
from vdsl.pipeline.bench_render import Case, _against_opengl, _crowded, case_of, filmable, in_turns
from vdsl.pipeline.llvmpipe import LlvmpipeDrawer, NoOpenGLError

sys.path.append(str(Path(__file__).resolve().parents[1] / "raster"))

from raster_scenes import box, looking, room, scene, sphere, still

DEMO = Path(__file__).resolve().parents[2] / "examples" / "coffee.vds"


def case() -> Case:
    views = looking([(2.6, -1.8, 1.5), (0.5, 0.2, 1.6)], [(2.0, 1.8, 1.0)] * 2, moments=[0, 1])
    palettes = still(2, 2)
    palettes[1, :, 1, 3] = 0.2
    return Case(room(), palettes, views)


def test_turns_are_taken_and_counted() -> None:
    order: list[str] = []

    def turn(name: str) -> int:
        order.append(name)
        return 5

    found = in_turns({"a": lambda: turn("a"), "b": lambda: turn("b")}, 0.0)
    assert order == ["a", "b"] * 4  # once to warm up
    assert all(rate > 0 and busy >= 0 for rate, busy in found.values())


def test_frames_are_gone_through_over_and_over() -> None:
    some = case().only(5).views
    assert list(some.moment) == [0, 1, 0, 1, 0]
    assert np.array_equal(some.camera.position[4], some.camera.position[0])


def test_the_crowd_is_outside_every_frame() -> None:
    given = case()
    given = replace(given, views=given.only(1).views)
    drawer = Renderer("cpu", Style("bare", outline=False, shadows=False, occlusion=False))
    pictures = []
    for content in (given.scene, _crowded(given)):
        drawer.load(content)
        pictures.append(drawer.render(given.palettes, given.views, (160, 90), ids=True))
    assert len(_crowded(given).static.faces) == 4 * len(given.scene.static.faces)
    assert np.array_equal(pictures[0].ids, pictures[1].ids)


def opengl(given: Case) -> LlvmpipeDrawer:
    """OpenGL's side; skips the test where there is none and none was installed for it."""
    try:
        return LlvmpipeDrawer(given.scene, STYLES["plain"], given.palettes)
    except NoOpenGLError as error:
        if os.environ.get("VDS_EXPECT_OPENGL"):
            raise
        pytest.skip(f"no OpenGL here: {error}")


def alike(given: Case, size: tuple[int, int], together: int) -> float:
    """The share of pixels in which our picture and OpenGL's are the same but for rounding."""
    drawer = Renderer("cpu", STYLES["plain"])
    drawer.load(given.scene)
    ours = drawer.render(given.palettes, given.views, size).color
    theirs = opengl(given).draw(given.views, size, together)
    return float((np.abs(ours.astype(int) - theirs).max(axis=-1) <= 3).mean())


@pytest.mark.parametrize("together", [1, 4])
def test_opengl_draws_the_plain_look(together: int) -> None:
    assert alike(case().only(5), (160, 90), together) > 0.99


def crowded_with_detail() -> Case:
    """Two people with levels of detail, one left out of the second view, behind glass that is clear."""
    people = [sphere((x, 0, 1.2), (0.3, 0.25, 0.9), (0.8, 0.3, 0.2 + 0.3 * x), 1, 40) for x in (0.0, 1.0)]
    pane = box((-2, -0.8, 0), (2, -0.79, 2.4), (0.8, 0.9, 0.92), "glass")
    made = scene([box((-9, -9, -0.1), (9, 9, 0), (0.7, 0.7, 0.7)), pane], people, walls=[-1, 0])
    persons = LOOSE - 1 - (made.skinned_object - 2)
    views = looking([(0.5, -d, 1.4) for d in (1.7, 3.0, 12.0)], [(0.5, 0, 1.2)] * 3, walls=3)
    views.hidden[1, 2] = True
    return Case(replace(made, fitting=persons.astype(np.int32)), still(2), views)


def test_opengl_draws_the_level_of_detail_that_we_draw() -> None:
    given, size = crowded_with_detail(), (800, 450)
    drawer = Renderer("cpu", STYLES["plain"])
    drawer.load(given.scene)
    assert len(np.unique(drawer.levels(given.palettes, given.views, size))) > 2
    assert alike(given, size, 1) > 0.995
    coarse = replace(given.views, detail=np.full((3, 2), COUNT - 1, np.int32))
    assert alike(replace(given, views=coarse), size, 1) > 0.995
    apart = opengl(given).draw(given.views, size) != opengl(given).draw(coarse, size)
    assert apart[0].any()  # it does take the levels it is told


def test_opengl_draws_a_line_of_the_demo() -> None:
    act, story, moving, _ = filmable(DEMO)
    given = case_of(act, story, moving)
    assert len(prepare(given.scene, STYLES["plain"]).detail.middle) > 0
    assert alike(given.only(2), (1280, 720), 1) > 0.98


def test_both_are_measured_where_there_is_opengl() -> None:
    given = crowded_with_detail()
    opengl(given)
    rows, rival = _against_opengl(given, "cpu", 0.0)
    assert "not measured" not in rival
    assert [row.key for row in rows if row.ratio] == ["plain_720p", "plain_224_single", "plain_224_batch"]


def test_a_first_picture_is_drawn() -> None:
    first_picture("cpu")


def test_a_camera_that_is_held_stands_still_while_people_move() -> None:
    act, story, moving, _ = filmable(DEMO)
    given = case_of(act, story, moving).only(6)
    camera, held = given.views.camera, given.held().views
    assert np.ptp(camera.position, axis=0).max() > 0
    for name in ("position", "axes", "focal"):
        kept, first = getattr(held.camera, name), getattr(camera, name)[0]
        np.testing.assert_array_equal(kept, np.broadcast_to(first, kept.shape))
    np.testing.assert_array_equal(held.moment, given.views.moment)
