"""Slow pans are steady: what a surface shows in one frame it shows in the next."""

from __future__ import annotations

import numpy as np
import pytest
from raster_scenes import box, looking, room, scene, still

from runtime.raster.renderer import Renderer
from runtime.raster.types import STYLES, Style
from vdsl.pipeline.eyes import entrances, eyes_camera
from vdsl.pipeline.steadiness import panned, steadiness
from vdsl.pipeline.trial import stage_script
from vdsl.stage.assemble import palettes

NOBODY = np.zeros(0, np.bool_)


# strokes of hatching are dark and two pixels wide: carried over by half pixels they blur, and
# that counts as change
@pytest.mark.parametrize(("style", "most"), [("board", 0.001), ("clay", 0.001), ("ink", 0.008)])
def test_a_slow_pan_does_not_crawl(style: str, most: float) -> None:
    drawer = Renderer("cpu", STYLES[style])
    drawer.load(room())
    views = looking([(2.6, -1.8, 1.5)], [(1.7, 1.8, 1.0)])
    for degrees in (0.02, 0.125):  # a fifth of a pixel a frame, and three degrees a second
        found = steadiness(drawer, still(2)[0], panned(views.camera, 4, degrees), NOBODY, (1280, 720))
        assert found.worst < most, degrees


# furniture has edges thinner than a pixel, which one sample a pixel meets by chance
@pytest.mark.parametrize(("style", "most"), [("board", 0.003), ("ink", 0.012)])
def test_a_furnished_set_stays_as_steady_as_it_is(style: str, most: float) -> None:
    staged = stage_script('storyboard "set"\nscene s = cafe at day\n\n/ (static wide)\n', "cafe").staged
    camera = eyes_camera(entrances(staged.world, 1), (1280, 720))
    drawer = Renderer("cpu", STYLES[style])
    drawer.load(staged.render)
    palette = palettes(staged, {}, {}, np.array([0]))[0]
    hidden = np.zeros(len(staged.world.walls), np.bool_)
    found = steadiness(drawer, palette, panned(camera, 3, 0.125), hidden, (1280, 720))
    assert found.worst < most


@pytest.mark.parametrize("sky", [False, True])
def test_what_does_change_is_found(sky: bool) -> None:
    # a patch of the middle frame is half as bright
    drawer = Renderer("cpu", Style("bare", outline=False, tones=0, shadows=False, occlusion=False))
    drawer.load(scene([box((0, 0, -0.1), (4, 4, 0), (0.8, 0.7, 0.6))], []) if sky else room())
    views = looking([(2.6, -1.8, 1.5)], [(1.7, 1.8, 2.4 if sky else 1.0)])
    camera = panned(views.camera, 3, 0.1)
    real = drawer.render

    def flickering(*given, **more):  # type: ignore[no-untyped-def]
        frames = real(*given, **more)
        frames.color[1, 200:400, 200:600] //= 2
        return frames

    assert steadiness(drawer, still(2)[0], camera, NOBODY, (1280, 720)).share < 0.005
    drawer.render = flickering  # type: ignore[method-assign]
    found = steadiness(drawer, still(2)[0], camera, NOBODY, (1280, 720))
    assert 0.05 < found.share < 0.15
    assert found.changed[220:380, 220:580].mean() > 0.95
    assert found.changed[450:].mean() < 0.005
