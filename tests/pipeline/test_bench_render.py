"""What ``vdsc bench --render`` compares is the same thing twice, and what is said to be outside is."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from runtime.raster.renderer import Renderer
from runtime.raster.types import STYLES, Style
from vdsl.pipeline.bench_first import first_picture
from vdsl.pipeline.bench_render import Case, _crowded, in_turns

sys.path.append(str(Path(__file__).resolve().parents[1] / "raster"))

from raster_scenes import looking, room, still


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
    for scene in (given.scene, _crowded(given)):
        drawer.load(scene)
        pictures.append(drawer.render(given.palettes, given.views, (160, 90), ids=True))
    assert len(_crowded(given).static.faces) == 4 * len(given.scene.static.faces)
    assert np.array_equal(pictures[0].ids, pictures[1].ids)


def test_opengl_draws_the_plain_look() -> None:
    pytest.importorskip("moderngl")
    from vdsl.pipeline.llvmpipe import LlvmpipeDrawer

    given = case()
    try:
        rival = LlvmpipeDrawer(given.scene, STYLES["plain"], given.palettes)
    except Exception as error:  # moderngl's own, without EGL
        pytest.skip(f"no OpenGL here: {error}")
    drawer = Renderer("cpu", STYLES["plain"])
    drawer.load(given.scene)
    views = given.only(5).views
    ours = drawer.render(given.palettes, views, (160, 90)).color
    for together in (1, 4):
        theirs = rival.draw(views, (160, 90), together)
        apart = np.abs(ours.astype(int) - theirs).max(axis=-1)
        assert (apart <= 3).mean() > 0.99


def test_a_first_picture_is_drawn() -> None:
    first_picture("cpu")
