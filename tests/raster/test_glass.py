"""Clear glass: what stands behind it is seen through it, and what has no room behind it stays opaque."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest
from raster_scenes import box, from_lists, looking, scene, sphere, still

from runtime.materials import NIGHT_GLASS
from runtime.mesh import MATERIALS, Mesh
from runtime.raster.panes import OPEN, divided
from runtime.raster.renderer import Renderer
from runtime.raster.types import LOOSE, Frames, RenderScene, Style, Views

PLAIN = Style("plain", outline=False, tones=0, quiet=0.0, shadows=False, occlusion=False)
SIZE = (97, 61)
RED, PALE = (0.8, 0.1, 0.1), (0.8, 0.9, 0.92)


@lru_cache(maxsize=2)
def renderer(style: Style = PLAIN) -> Renderer:
    return Renderer("cpu", style)


def draw(s: RenderScene, views: Views | None = None, serial: bool = True, style: Style = PLAIN) -> Frames:
    r = renderer(style)
    r.load(s)
    was, r.serial = r.serial, serial
    try:
        views = views or ahead(s)
        return r.render(still(int(s.joints.max(initial=0)) + 1), views, SIZE, ids=True)
    finally:
        r.serial = was


def ahead(s: RenderScene, hidden: list[int] | None = None) -> Views:
    """From the origin along +Y; hidden: columns left out."""
    views = looking([(0.0, 0.0, 0.0)], [(0.0, 3.0, 0.0)], walls=s.wall_count)
    mask = np.zeros((1, s.wall_count), bool)
    mask[0, hidden or []] = True
    return replace(views, hidden=mask)


def wall(y: float, color: tuple[float, float, float] = RED) -> object:
    return box((-9.0, y, -9.0), (9.0, y + 0.1, 9.0), color)


def pane(y: float, wide: float = 0.8) -> object:
    return box((-wide, y, -wide), (wide, y + 0.01, wide), PALE, "glass")


def of_glass(mesh: Mesh) -> Mesh:
    return replace(mesh, materials=np.full(len(mesh.faces), MATERIALS.index("glass"), np.int32))


def middle(frames: Frames) -> np.ndarray:
    return frames.color[0, SIZE[1] // 2 - 1, SIZE[0] // 2 - 1].astype(int)


def test_what_stands_behind_is_seen_and_known() -> None:
    s, bare = scene([pane(2.5), wall(4.0)], []), scene([wall(4.0)], [])
    through, plain = draw(s), draw(bare)
    assert (through.ids == 1).all()  # the wall, as if there were no glass
    seen, direct = middle(through), middle(plain)
    assert (seen != direct).any()
    assert seen[0] > seen[1] + 20  # still red
    assert seen[1] > direct[1]  # and a little of the pane
    assert (through.color[0, 0, 0] == plain.color[0, 0, 0]).all()  # beside the pane


@pytest.mark.parametrize("gap", [0.02, OPEN - 0.05])
def test_glass_with_no_room_behind_stays_opaque(gap: float) -> None:
    frames = draw(scene([pane(2.0), wall(2.01 + gap)], []))
    assert frames.ids[0, SIZE[1] // 2, SIZE[0] // 2] == 0


def test_a_scene_without_clear_glass_is_left_alone() -> None:
    s = scene([wall(4.0)], [])
    assert divided(s) == (s, None)


def test_glass_goes_with_the_wall_it_is_in() -> None:
    s = scene([pane(2.0), wall(4.0)], [], walls=[0, -1])
    shown, gone = draw(s), draw(s, ahead(s, [0]))
    assert (shown.color != gone.color).any()
    assert (gone.color == draw(scene([wall(4.0)], [])).color).all()


def test_things_of_nothing_but_glass_are_drawn() -> None:
    thing = sphere((0.0, 2.0, 0.0), (0.2, 0.2, 0.2), PALE)
    glass = of_glass(thing)
    with_it, bare = draw(scene([wall(4.0)], [glass])), draw(scene([wall(4.0)], []))
    differs = (with_it.color != bare.color).any(-1)[0]
    assert 0.01 < differs.mean() < 0.2
    assert (with_it.ids == 0).all()


def test_small_things_have_an_outline_and_panes_have_none() -> None:
    """The darkest pixel of a drinking glass is on its border."""
    thing = sphere((0.0, 1.5, 0.0), (0.15, 0.15, 0.15), PALE, rings=24)
    glass = of_glass(thing)
    bright = (0.9, 0.9, 0.9)
    small = draw(scene([wall(4.0, bright)], [glass])).color[0].astype(int).sum(-1)
    bare = draw(scene([wall(4.0, bright)], [])).color[0].astype(int).sum(-1)
    dark = np.argwhere(small < 0.75 * bare)
    away = np.hypot(*(dark - (np.array(SIZE[::-1]) - 1) / 2).T)
    assert len(dark) > 20
    assert np.ptp(away) < 3.5
    large = draw(scene([pane(2.0), wall(4.0, bright)], [])).color[0].astype(int).sum(-1)
    assert (large > 0.75 * bare).all()


def test_somebody_left_out_takes_their_glasses_along() -> None:
    lens = from_lists(
        [(-0.1, 2, -0.1), (0.1, 2, -0.1), (0, 2, 0.1)], [(0, 1, 2)], [(0, -1, 0)] * 3, PALE, "glass"
    )
    s = scene([wall(4.0)], [lens], walls=[-1])
    s = replace(s, fitting=np.full(1, LOOSE - 1, np.int32))
    views = ahead(s)
    shown = draw(s, replace(views, hidden=np.zeros((1, 1), bool)))
    gone = draw(s, replace(views, hidden=np.ones((1, 1), bool)))
    assert (shown.color != gone.color).any()
    assert (gone.color == draw(scene([wall(4.0)], [])).color).all()


def test_both_ways_of_filling_give_the_same_glass() -> None:
    glass = box((-0.2, 1.2, -0.3), (0.1, 1.4, 0.2), PALE, "glass")
    s = scene([pane(2.0), wall(4.0)], [glass])
    one, other = draw(s, style=Style()), draw(s, serial=False, style=Style())
    assert (one.color == other.color).all()
    assert (one.ids == other.ids).all()


def test_a_pane_before_the_night_keeps_its_colour() -> None:
    """A set's colours are drawn quiet; dark glass would become grey, and no more look like a night."""
    night = (0.25, 0.32, 0.47)
    dark = wall(1.5, night)
    drawn: list[np.ndarray] = []
    for material in (MATERIALS.index("plain"), NIGHT_GLASS):
        made = replace(dark, materials=np.full_like(dark.materials, material))
        drawn.append(middle(draw(scene([made], []), style=replace(PLAIN, quiet=0.45))).astype(float))
    plain, glass = drawn
    assert glass[2] - glass[0] > 1.5 * (plain[2] - plain[0])
    assert glass[2] < plain[2] - 5
