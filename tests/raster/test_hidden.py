"""What a view leaves out: wild walls, and whoever it looks through the eyes of; each view its own."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from raster_scenes import box, looking, scene, sphere, still

from runtime.raster.renderer import Renderer
from runtime.raster.types import LOOSE, RenderScene, Style, Views

PLAIN = Style("plain", outline=False, tones=0, quiet=0.0, shadows=False, occlusion=False)
WALL, FLOOR, FIRST, SECOND, BALL = range(5)


def made() -> RenderScene:
    """A wall before two people and a ball that belongs to nobody."""
    people = [sphere((x, 2.0, 0.0), (0.25, 0.25, 0.6), (0.8, 0.3, 0.2), rings=8) for x in (-0.5, 0.5)]
    ball = sphere((0.0, 1.6, -0.4), (0.1, 0.1, 0.1), (0.2, 0.3, 0.8), rings=6)
    built = scene(
        [box((-2, 1, 0.2), (2, 1.1, 2), (0.7, 0.7, 0.7)), box((-4, 0, -0.8), (4, 6, -0.7), (0.6, 0.6, 0.5))],
        [*people, ball],
        walls=[0, -1],
    )
    sizes = [len(mesh.faces) for mesh in (*people, ball)]
    whose = np.repeat(np.array([LOOSE - 1, LOOSE - 2, LOOSE], np.int32), sizes)
    return replace(built, fitting=whose)


@pytest.mark.parametrize("serial", [True, False])
def test_each_view_leaves_out_what_it_is_told_to(serial: bool) -> None:
    renderer = Renderer("cpu", PLAIN)
    renderer.load(made())
    renderer.serial = serial
    views = looking([(0.0, -0.5, 0.2)] * 4, [(0.0, 3.0, 0.0)] * 4, focal=24.0, walls=1)
    hidden = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 1]], bool)  # wall, first, second
    frames = renderer.render(still(3), Views(views.camera, views.moment, hidden), (96, 54), ids=True)
    assert frames.ids is not None
    everything = {WALL, FLOOR, FIRST, SECOND, BALL}
    seen = [set(np.unique(ids)) - {-1} for ids in frames.ids]
    assert seen == [everything, everything - {WALL}, everything - {FIRST}, {FLOOR, BALL}]
    # who is left out leaves no hole: what stood behind is drawn there
    gone = (frames.ids[0] == FIRST) & (frames.ids[2] != FIRST)
    assert gone.any()
    assert not (frames.ids[2][gone] == SECOND).any()
    # and the others are where they were
    assert ((frames.ids[0] == SECOND) == (frames.ids[2] == SECOND)).all()


def test_people_need_not_be_said_where_all_are_drawn() -> None:
    renderer = Renderer("cpu", PLAIN)
    renderer.load(made())
    views = looking([(0.0, -0.5, 0.2)], [(0.0, 3.0, 0.0)], focal=24.0, walls=1)
    walls_only = Views(views.camera, views.moment, np.zeros((1, 1), bool))
    everybody = Views(views.camera, views.moment, np.zeros((1, 3), bool))
    one, other = (renderer.render(still(3), v, (96, 54)).color for v in (walls_only, everybody))
    assert (one == other).all()
