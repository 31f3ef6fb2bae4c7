"""What rests in a batch is moved once: no picture tells it, and nothing that moves is taken for it."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from raster_scenes import box, looking, scene, sphere, still

from runtime.raster.loaded import loaded
from runtime.raster.renderer import Renderer
from runtime.raster.types import STYLES, RenderScene

SIZE = (96, 64)
MOMENTS = 5


def furnished(homely: tuple[int, ...] = ()) -> RenderScene:
    """Somebody with two limbs and a detailed head, two things that may rest, on a floor with a table."""
    floor, top = box((-4, -4, -0.1), (4, 4, 0), (0.7, 0.7, 0.7)), box((-1, -1, 0.7), (1, 1, 0.8), part=1)
    head = sphere((0.6, 0.0, 1.2), (0.2, 0.2, 0.25), (0.8, 0.5, 0.4), rings=40)
    arm = sphere((0.9, 0.0, 0.5), (0.1, 0.1, 0.5), (0.2, 0.3, 0.8))
    mug, crate = (
        box((-0.1, -0.1, 0.8), (0.1, 0.1, 0.95), (0.7, 0.1, 0.1)),
        box((-2, -1, 0), (-1.4, -0.4, 0.5)),
    )
    return scene([floor, top], [head, arm, mug, crate], homely=homely)


def acted(crate: list[float] | None = None) -> NDArray[np.float32]:
    """The head nods and the arm swings, the mug stands, and the crate, where it is not said where that is."""
    moments = still(4, MOMENTS)
    moments[:, 0, 2, 3] = np.linspace(0.0, 0.3, MOMENTS)
    moments[:, 1, 0, 3] = np.linspace(0.0, -0.5, MOMENTS)
    if crate is not None:
        moments[:, 3, 1, 3] = crate
    return moments


@pytest.mark.parametrize("look", ["board", "clay", "plain"])
@pytest.mark.parametrize("crate", [None, [0.0, 0.0, 0.0, 0.0, 0.7], [0.2] * MOMENTS])
@pytest.mark.parametrize("homely", [(), (2, 3)])
def test_a_batch_with_things_that_rest_gives_what_its_moments_give(
    look: str, crate: list[float] | None, homely: tuple[int, ...]
) -> None:
    drawer, palettes = Renderer("cpu", STYLES[look]), acted(crate)
    drawer.load(furnished(homely))
    # near and far, so that moments want other levels of detail
    eyes = [(0.6, -0.9 - 2.0 * (k % 2), 1.4) for k in range(MOMENTS)]
    views = looking(eyes, [(0.2, 0.0, 0.8)] * MOMENTS, moments=list(range(MOMENTS)))
    together = drawer.render(palettes, views, SIZE, ids=True)
    for k in range(MOMENTS):
        one = looking(eyes[k : k + 1], [(0.2, 0.0, 0.8)])
        alone = drawer.render(palettes[k : k + 1], one, SIZE, ids=True)
        np.testing.assert_array_equal(together.color[k], alone.color[0])
        np.testing.assert_array_equal(together.ids[k], alone.ids[0])  # type: ignore[index]


def test_what_rests_is_what_no_matrix_moves() -> None:
    content = loaded(furnished(), STYLES["board"], Renderer("cpu", STYLES["board"]).backend, _shading())
    rig, owner = content.rig, content.scene.owner
    vertices, clusters = rig.moves(acted())
    moving = {int(o) for o in np.unique(owner[vertices[: len(owner)]])}
    assert moving == {2, 3}, "head and arm"
    first = content.scene.moving_first
    objects = content.scene.surface_object[content.scene.info[content.scene.clusters[first:, 0], 0]]
    assert set(objects[clusters]) == {2, 3}
    assert set(objects[~clusters]) == {4, 5}
    runs, resting = rig.touching(vertices)
    assert {int(owner[a]) for a, _ in runs} == {2, 3}
    assert {int(owner[a]) for a, _ in resting} == {4, 5}
    assert rig.moves(acted()[:1])[0].all(), "of one moment nothing is known"
    minus = acted()
    minus[1, 2, 0, 1] = -0.0  # the same number, and other bits
    assert set(np.unique(owner[rig.moves(minus)[0][: len(owner)]])) == {2, 3, 4}


def _shading():  # type: ignore[no-untyped-def]
    from runtime.raster.kernels.shading import shading_kernels

    return shading_kernels(STYLES["board"])


def test_contact_shadows_add_up_whatever_rests() -> None:
    """On the floor between a thing that rests and one that comes near, both darken it."""
    drawer = Renderer("cpu", STYLES["board"])
    floor = box((-4, -4, -0.1), (4, 4, 0), (0.7, 0.7, 0.7))
    left, right = box((-0.5, -0.2, 0), (-0.1, 0.2, 0.3)), box((0.1, -0.2, 0), (0.5, 0.2, 0.3))
    drawer.load(scene([floor], [left, right]))
    palettes = still(2, 3)
    palettes[:, 1, 0, 3] = (1.5, 0.15, 0.0)
    views = looking([(0.0, -1.0, 2.2)] * 3, [(0.0, 0.0, 0.0)] * 3, moments=[0, 1, 2])
    seen = drawer.render(palettes, views, (160, 96)).color.astype(float).mean(axis=-1)
    between = seen[:, 40:52, 76:84].mean(axis=(1, 2))
    assert between[0] > between[1] > between[2]


def floor_of(metres: float, things: bool = True) -> RenderScene:
    floor = box((-metres, -metres, -0.1), (metres, metres, 0), (0.7, 0.7, 0.7))
    mug = box((-0.2, -0.2, 0), (0.2, 0.2, 0.5), (0.7, 0.1, 0.1))
    return scene([floor], [mug, mug] if things else [])


def test_nothing_is_left_of_another_scene() -> None:
    """Scratch and shadows of a large floor, where smaller and emptier ones are drawn by the same drawer."""
    moments = 200
    rng, used = np.random.default_rng(0), Renderer("cpu", STYLES["board"])
    views = looking([(0.0, -2.5, 2.2)] * moments, [(0.0, 0.0, 0.0)] * moments, moments=list(range(moments)))
    for metres in (8.0, 6.5, 5.0, 1.5):
        palettes = still(2, moments)
        palettes[:, :, :2, 3] = rng.uniform(-metres, metres, (moments, 2, 2))
        fresh = Renderer("cpu", STYLES["board"])
        drawn = []
        for drawer in (used, fresh):
            drawer.load(floor_of(metres))
            drawn.append(drawer.render(palettes, views, (48, 32)).color)
        np.testing.assert_array_equal(*drawn)
    one, drawn = looking([(0.0, -2.5, 2.2)], [(0.0, 0.0, 0.0)]), []
    for drawer in (used, Renderer("cpu", STYLES["board"])):
        drawer.load(floor_of(1.5, things=False))
        drawn.append(drawer.render(still(1), one, (160, 96)).color)
    np.testing.assert_array_equal(*drawn)


def test_a_set_is_drawn_without_any_moment() -> None:
    drawer = Renderer("cpu", STYLES["board"])
    drawer.load(floor_of(2.0, things=False))
    one = looking([(0.0, -2.5, 2.2)], [(0.0, 0.0, 0.0)])
    some = drawer.render(still(1), one, (48, 32)).color
    np.testing.assert_array_equal(
        drawer.render(np.zeros((0, 0, 3, 4), np.float32), one, (48, 32)).color, some
    )
