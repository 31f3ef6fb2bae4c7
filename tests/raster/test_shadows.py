"""Shadows of what moves: as sharp in a large set as in a small one, and there whoever puts a thing where."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from raster_scenes import LIGHT, box, looking, scene, sphere, still

from runtime.mesh import Mesh
from runtime.raster.bake import light_basis
from runtime.raster.casting import Home, casting_of
from runtime.raster.device import start
from runtime.raster.prepare import prepare
from runtime.raster.renderer import Renderer
from runtime.raster.types import LOOSE, STYLES, RenderScene, Style

SIZE = (160, 96)
SUN = replace(LIGHT, sun=(0.5, -0.3, 0.8))
SHADED = Style("shaded", outline=False, tones=0, quiet=0.0, occlusion=False)


def open_ground(things: list[Mesh], homely: list[int]) -> RenderScene:
    floor = box((-30, -30, -0.1), (30, 30, 0), (0.7, 0.7, 0.7))
    return scene([floor], things, light=SUN, homely=homely)


def post(x: float, y: float, tall: float = 1.6) -> Mesh:
    return box((x - 0.05, y - 0.05, 0), (x + 0.05, y + 0.05, tall), (0.8, 0.3, 0.2))


def picture(
    content: RenderScene, moments: NDArray[np.float32] | None = None, style: Style = SHADED
) -> NDArray[np.int32]:
    """How light each pixel of the ground is, 0 where something stands before it."""
    drawer = Renderer("cpu", style)
    drawer.load(content)
    count = len(content.home) if content.home is not None else int(content.joints.max()) + 1
    views = looking([(0.0, -4.0, 2.2)], [(0.0, 0.0, 0.4)])
    drawn = drawer.render(still(count) if moments is None else moments, views, SIZE, ids=True)
    assert drawn.ids is not None
    floor = drawn.ids[0] <= 0
    return np.asarray(drawn.color[0].astype(np.int32).sum(axis=-1) * floor)


def test_a_persons_shadow_is_as_sharp_in_a_large_set_as_in_a_small_one() -> None:
    near, far = post(0, 0), [post(-25, 20), post(25, 20), post(25, -20)]
    alone = picture(open_ground([near], []))
    np.testing.assert_array_equal(picture(open_ground([near, *far], [1, 2, 3])), alone)
    blurred = picture(open_ground([near, *far], []))  # where nobody knows what is at home
    assert (blurred != alone).mean() > 0.005
    ground = alone > 0
    assert alone[ground].min() < blurred[ground].min() - 60, "a thin thing's shadow is lost in coarse texels"


@pytest.mark.parametrize("style", ["board", "ink"])
def test_a_thing_throws_its_shadow_at_home_and_away_and_only_one(style: str) -> None:
    content = open_ground([sphere((0, 0, 1), (0.1, 0.1, 0.1), (1, 0, 0)), post(0.6, 0)], [1])
    moved = still(2)
    moved[0, 1, 0, 3] = -1.2
    built = open_ground([sphere((0, 0, 1), (0.1, 0.1, 0.1), (1, 0, 0)), post(-0.6, 0)], [1])
    for moments, same in ((still(2), content), (moved, built)):
        told = picture(content, moments, STYLES[style])
        untold = picture(replace(content, home=None), moments, STYLES[style])
        assert (np.abs(told - untold) > 24).mean() < 0.01, "only its edge is another"
        assert (np.abs(told - picture(same, None, STYLES[style])) > 24).mean() < 0.01
    assert (np.abs(picture(content, None, STYLES[style]) - picture(content, moved, STYLES[style])) > 24).any()


def test_nobodys_shadow_changes_as_another_walks_off() -> None:
    """Each person has a map of its own, and so has what is carried away."""
    content = open_ground([post(0, 0), post(0.7, 0.3), post(-0.6, 0.3, 0.4)], [2])
    owner = content.skinned_object - content.skinned_object.min()
    people = np.where(owner < 2, LOOSE - 1 - owner, LOOSE).astype(np.int32)
    away = still(3)
    away[0, 1:, 0, 3] = 25.0
    together, gone = replace(content, fitting=people), picture(replace(content, fitting=people), away)
    np.testing.assert_array_equal(gone, picture(open_ground([post(0, 0)], [])))
    assert (picture(together) != gone).any()
    assert (picture(content, away) != gone).any(), "where nobody knows whose it is, all share one map"


def test_home_is_where_the_set_puts_things() -> None:
    content = open_ground([post(0, 0), post(3, 4), post(-2, 0)], [1, 2])
    prepared = prepare(content, STYLES["board"], True)
    casting = casting_of(prepared, content, 3)
    assert set(casting.entry[casting.points]) == {0, 1, 2}
    basis = light_basis(np.array(SUN.sun))
    home = Home(prepared, casting, content.home, basis, 0.006)
    assert home.any
    assert home.casts.tolist() == [False, True, True]
    moments = still(3, 3)
    moments[1, 1, 0, 3] = 1e-6
    moments[2, 0, 0, 3] = 2.0
    assert home.kept(moments).tolist() == [[False, True, True], [False, False, True], [False, True, True]]
    corner, size = np.array(home.frame(256)), 256
    for x, y in ((3, 4), (-2, 0)):  # both ends of both posts lie in the map
        for z in (0.0, 1.6):
            across = basis[:2] @ np.array([x, y, z])
            assert ((across - corner[:2]) * corner[2] > 2).all()
            assert ((across - corner[:2]) * corner[2] < size - 4).all()
    nowhere = Home(prepared, casting, None, basis, 0.006)
    assert not nowhere.any
    assert not nowhere.kept(moments).any()


def test_home_maps_are_cast_anew_only_where_something_came_or_went(monkeypatch: pytest.MonkeyPatch) -> None:
    content = open_ground([post(0, 0), post(0.8, 0.4)], [1])
    drawer = Renderer("cpu")
    drawer.load(content)
    shadows, cast = drawer._moments.shadows, []
    real = shadows._cast
    monkeypatch.setattr(shadows, "_cast", lambda *told: (cast.append(told[2][1]), real(*told)))
    views = looking([(0.0, -4.0, 2.2)], [(0.0, 0.0, 0.4)])

    def homes(moments: NDArray[np.float32], size: tuple[int, int] = SIZE) -> int:
        cast.clear()
        drawer.render(moments, views, size)
        return cast.count(shadows.home_size)

    assert homes(still(2)) == 1
    walks = still(2)
    walks[0, 0, 0, 3] = 0.5
    assert homes(walks) == 0
    carried = still(2)
    carried[0, 1, 2, 3] = 0.5
    assert homes(carried) == 1
    assert homes(walks) == 1
    assert homes(walks, (1280, 720)) == 1
    drawer.load(content)
    assert homes(walks, (1280, 720)) == 1


def test_what_all_of_a_map_keeps_the_light_off_has_none_whatever_rounding_says() -> None:
    start("cpu")
    from small_kernels import light_at

    from runtime.raster.kernels.light import summary_size

    size = 32
    depth, coarse = np.full(size**2, 1.0, np.float32), np.zeros(summary_size(size), np.float32)
    blocks = (size // 4) ** 2
    coarse[:blocks], coarse[blocks : 2 * blocks] = 2.0, -2.0  # so that every texel is looked at
    at = np.random.default_rng(3).uniform(4, 27, (4000, 3)).astype(np.float32)
    at[:2000, 2], at[2000:, 2] = 0.5, 1.5
    frame, out = np.array([[0.0, 0.0, 1.0]], np.float32), np.zeros(len(at), np.float32)
    light_at(at, frame, size, depth, coarse, out)
    assert (out[:2000] == 0.0).all()
    assert (out[2000:] == 1.0).all()
