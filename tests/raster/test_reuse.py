"""A fixed camera takes the set over from one drawing of it: never another byte, and less to do."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from raster_scenes import box, looking, room, scene, sphere, still

from runtime.mesh import MATERIALS
from runtime.raster import empty as module
from runtime.raster.renderer import Renderer
from runtime.raster.types import LOOSE, STYLES, Frames, RenderScene, Views

EYE, TARGET = (2.6, -1.8, 1.5), (2.0, 1.8, 1.0)


def walking(steps: int) -> NDArray[np.float32]:
    moments = still(2, steps)
    moments[:, 0, 1, 3] = np.linspace(0, 0.5, steps)
    moments[:, 1, 0, 3] = np.linspace(0, -0.4, steps)
    return moments


def fixed(steps: int) -> Views:
    return looking([EYE] * steps, [TARGET] * steps, moments=list(range(steps)))


def drawn(drawer: Renderer, views: Views, size: tuple[int, int], ids: bool = False) -> Frames:
    return drawer.render(walking(len(views.moment)), views, size, ids=ids)


def anew(monkeypatch: pytest.MonkeyPatch, drawer: Renderer, views: Views, size: tuple[int, int]) -> Frames:
    with monkeypatch.context() as patch:
        patch.setattr(module, "REUSED", 10**9)
        return drawn(drawer, views, size, ids=True)


def redrawn(drawer: Renderer, views: int, size: tuple[int, int]) -> float:
    """Share of the runs of pixels that were shaded, of the views drawn last."""
    level = drawer._buffers["level"][: views * size[1] * size[0] // 16]
    return float((level == 3).mean())


@pytest.mark.parametrize("style", ["board", "clay", "ink"])
@pytest.mark.parametrize("size", [(128, 72), (320, 180)])
def test_the_same_bytes_as_drawn_anew(
    monkeypatch: pytest.MonkeyPatch, style: str, size: tuple[int, int]
) -> None:
    drawer = Renderer("cpu", STYLES[style])
    drawer.load(room())
    views = fixed(5)
    expected = anew(monkeypatch, drawer, views, size)
    got = drawn(drawer, views, size)
    assert (got.color == expected.color).all()
    # of ink also what is around, which is most of a very small picture
    assert redrawn(drawer, 5, size) < 0.9 or (style == "ink" and size[1] < 100)
    with_ids = drawn(drawer, views, size, ids=True)
    assert (with_ids.color == expected.color).all()
    np.testing.assert_array_equal(with_ids.ids, expected.ids)


def test_less_is_redrawn_where_little_moves(monkeypatch: pytest.MonkeyPatch) -> None:
    ball = sphere((0, 0, 0.3), (0.3, 0.3, 0.3), (0.8, 0.2, 0.2))
    floor = box((-6, -6, -0.1), (6, 6, 0), (0.7, 0.7, 0.7), "wood")
    drawer = Renderer("cpu")
    drawer.load(scene([floor], [ball, sphere((0.8, 0, 0.2), (0.2, 0.2, 0.2), (0.2, 0.2, 0.8))]))
    size = (640, 360)
    views = looking([(0, -6, 2.5)] * 4, [(0, 0, 0.3)] * 4, moments=[0, 1, 2, 3])
    expected = anew(monkeypatch, drawer, views, size)
    assert (drawn(drawer, views, size).color == expected.color).all()
    assert redrawn(drawer, 4, size) < 0.15


def test_walls_and_cameras_are_kept_apart(monkeypatch: pytest.MonkeyPatch) -> None:
    content = room()
    wall = np.where(content.static_object == 1, 0, content.static_wall).astype(np.int32)
    drawer = Renderer("cpu")
    drawer.load(RenderScene(**{**vars(content), "static_wall": wall, "wall_count": 1}))
    eyes = [EYE, (1.0, -2.0, 1.2), EYE] * 4
    views = looking(eyes, [TARGET] * 12, moments=list(range(12)), walls=1)
    views.hidden[6:] = True
    expected = anew(monkeypatch, drawer, views, (128, 72))
    assert (drawn(drawer, views, (128, 72)).color == expected.color).all()
    assert redrawn(drawer, 12, (128, 72)) < 0.95


def test_a_set_is_kept_for_the_next_call_and_dropped_with_its_scene(monkeypatch: pytest.MonkeyPatch) -> None:
    drawer = Renderer("cpu")
    drawer.load(room())
    views, size = fixed(4), (128, 72)
    first = drawn(drawer, views, size)
    with monkeypatch.context() as patch:
        patch.setattr(drawer._visibility, "fill_empty", lambda *arguments: pytest.fail("drawn again"))
        assert (drawn(drawer, views, size).color == first.color).all()
    other = scene(
        [box((0, 0, -0.1), (4.2, 3.6, 0), (0.2, 0.5, 0.3))],
        [sphere((1, 1, 1), (0.2, 0.2, 0.2), (1, 0, 0))] * 2,
    )
    drawer.load(other)
    expected = anew(monkeypatch, drawer, views, size)
    assert (drawn(drawer, views, size).color == expected.color).all()


def test_odd_widths_are_drawn_anew() -> None:
    drawer = Renderer("cpu")
    drawer.load(room())
    together = drawn(drawer, fixed(3), (131, 77)).color
    for k in range(3):
        alone = looking([EYE], [TARGET], moments=[k])
        assert (drawer.render(walking(3), alone, (131, 77)).color[0] == together[k]).all()


def test_glass_is_taken_over_too_and_drawn_anew_where_it_moves(monkeypatch: pytest.MonkeyPatch) -> None:
    clear = MATERIALS.index("glass")
    things = [
        sphere((0.6, 0, 0.5), (0.12, 0.12, 0.2), (0.7, 0.8, 0.9)),
        sphere((0, 0, 0.3), (0.3,) * 3, (1, 0, 0)),
    ]
    things[0] = replace(things[0], materials=np.full(len(things[0].faces), clear, np.int32))
    content = scene(
        [
            box((-6, -6, -0.1), (6, 6, 0), (0.7, 0.7, 0.7), "wood"),
            box((-2, 1.0, 0.2), (2, 1.02, 1.6), (0.8, 0.9, 0.92), "glass"),
            box((-6, 4.0, 0), (6, 4.1, 3), (0.8, 0.4, 0.3)),
        ],
        things,
    )
    drawer = Renderer("cpu")
    drawer.load(content)
    size = (640, 368)
    views = looking([(0, -5, 1.2)] * 4, [(0, 0, 0.6)] * 4, moments=[0, 1, 2, 3])
    expected = anew(monkeypatch, drawer, views, size)
    assert (drawn(drawer, views, size).color == expected.color).all()
    assert redrawn(drawer, 4, size) < 0.25
    with_ids = drawn(drawer, views, size, ids=True)
    assert (with_ids.color == expected.color).all()


def with_a_door() -> RenderScene:
    """A floor with two balls, and a door beside them that is a part of the set: it is in its first wall."""
    balls = [
        sphere((0, 0, 0.3), (0.3, 0.3, 0.3), (0.8, 0.2, 0.2)),
        sphere((0.8, 0, 0.2), (0.2, 0.2, 0.2), (0.2, 0.2, 0.8)),
    ]
    leaf = box((-2.6, -0.5, 0), (-1.4, -0.4, 1.8), (0.6, 0.5, 0.4), "wood")
    floor = box((-6, -6, -0.1), (6, 6, 0), (0.7, 0.7, 0.7), "wood")
    content = scene([floor], [*balls, leaf])
    fitting = np.where(content.skinned_object == 3, 0, -2).astype(np.int32)
    return replace(content, fitting=fitting, wall_count=1)


@pytest.mark.parametrize("opens", [False, True])
@pytest.mark.parametrize("style", ["board", "ink"])
def test_a_door_that_rests_belongs_to_the_empty_set(
    monkeypatch: pytest.MonkeyPatch, style: str, opens: bool
) -> None:
    drawer, size = Renderer("cpu", STYLES[style]), (640, 360)
    eyes, aims = [(0, -6, 2.5)] * 4, [(-0.5, 0, 0.6)] * 4
    views = looking(eyes, aims, moments=[0, 1, 2, 3], walls=1)
    drawer.load(with_a_door())
    moments = np.concatenate([walking(4), still(1, 4)], axis=1)
    if opens:
        moments[2:, 2, 0, 3] = 0.2

    def drawn_anew() -> Frames:
        with monkeypatch.context() as patch:
            patch.setattr(module, "REUSED", 10**9)
            return drawer.render(moments, views, size, ids=True)

    expected = drawn_anew()
    got = drawer.render(moments, views, size)
    assert expected.ids is not None
    door = (expected.ids == 3).any(axis=0)
    assert door.mean() > 0.03
    assert (got.color == expected.color).all()
    level = drawer._buffers["level"][: 4 * size[0] * size[1] // 16].reshape(4, size[1], -1)
    shaded = np.repeat(level == 3, 16, axis=-1)[:, door].mean()
    assert shaded > 0.9 if opens else shaded < 0.2
    moments[:, 2, 0, 3] = 0.1  # the same door at another place, as in a later part of a take
    expected = drawn_anew()
    assert (drawer.render(moments, views, size).color == expected.color).all()


def furnished() -> RenderScene:
    """A floor and a wall, two balls that move, and crates and a vase that can be carried."""
    balls = [
        sphere((0, 0, 0.3), (0.3, 0.3, 0.3), (0.8, 0.2, 0.2)),
        sphere((0.8, 0, 0.2), (0.2, 0.2, 0.2), (0.2, 0.2, 0.8)),
    ]
    crate = box((-2.4, -0.6, 0.0), (-1.6, 0.2, 0.7), (0.6, 0.5, 0.3), "wood")
    vase = sphere((2.2, 0.6, 0.35), (0.2, 0.2, 0.35), (0.3, 0.6, 0.5))
    floor = box((-6, -6, -0.1), (6, 6, 0), (0.7, 0.7, 0.7), "wood")
    wall = box((-6, 3, 0), (6, 3.2, 3), (0.7, 0.6, 0.5), "plaster")
    corners = [
        box((x - 0.2, y - 0.2, 0), (x + 0.2, y + 0.2, 1.2), (0.5, 0.4, 0.3))
        for x in (-5, 5)
        for y in (-5, 2.5)
    ]
    content = scene([floor, wall], [*balls, crate, vase, *corners], homely=range(2, 8))
    somebody = content.skinned_object - content.skinned_object.min() < 2
    return replace(content, fitting=np.where(somebody, LOOSE - 1, LOOSE).astype(np.int32))


@pytest.mark.parametrize(
    ("style", "homely"), [("board", True), ("clay", True), ("ink", True), ("board", False)]
)
def test_things_that_rest_belong_to_the_empty_set(
    monkeypatch: pytest.MonkeyPatch, style: str, homely: bool
) -> None:
    drawer, size, content = Renderer("cpu", STYLES[style]), (640, 360), furnished()
    drawer.load(content if homely else replace(content, home=None))
    views = looking([(0, -6, 2.5)] * 4, [(0, 0, 0.6)] * 4, moments=[0, 1, 2, 3])
    moments = np.concatenate([walking(4), still(6, 4)], axis=1)

    def drawn_anew(moments: NDArray[np.float32]) -> Frames:
        with monkeypatch.context() as patch:
            patch.setattr(module, "REUSED", 10**9)
            return drawer.render(moments, views, size, ids=True)

    def shaded() -> NDArray[np.bool_]:
        level = drawer._buffers["level"][: 4 * size[0] * size[1] // 16].reshape(4, size[1], -1)
        return np.repeat(level == 3, 16, axis=-1)

    expected = drawn_anew(moments)
    assert (drawer.render(moments, views, size).color == expected.color).all()
    assert shaded().mean() < (0.2 if homely else 0.7)
    assert expected.ids is not None
    first = content.skinned_object.min()
    if homely:
        assert shaded()[expected.ids == first + 2].mean() < 0.15  # the crate
        assert shaded()[expected.ids == first + 3].mean() < 0.15  # the vase
    for move in range(
        3
    ):  # one is put elsewhere, is carried, and all of them are far away from where they were
        moments = moments.copy()
        moments[:, 3, 0, 3] = -0.4 if move == 0 else np.linspace(0.0, 0.3, 4)
        if move == 2:
            moments[:, :2, 0, 3] += np.linspace(-8.0, 8.0, 4)[:, None]
        expected = drawn_anew(moments)
        assert (drawer.render(moments, views, size).color == expected.color).all(), move


def test_walls_that_no_light_reaches_are_left_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """What moves stands between the light and a wall that is turned away from it."""
    drawer, size = Renderer("cpu"), (640, 360)
    drawer.load(furnished())
    direction = np.asarray(drawer._loaded.arrays["light"][:3], float)  # type: ignore[union-attr]
    side = -np.sign(direction[1])  # of the wall from which it is dark
    eye, target = (0.0, 3.1 + side * 6.0, 1.6), (0.0, 3.1, 1.5)
    views = looking([eye] * 4, [target] * 4, moments=[0, 1, 2, 3])
    moments = np.concatenate([walking(4), still(6, 4)], axis=1)
    moments[:, :2, 1, 3] += 3.1 - side  # on the lit side, close to the wall
    with monkeypatch.context() as patch:
        patch.setattr(module, "REUSED", 10**9)
        expected = drawer.render(moments, views, size, ids=True)
    assert (drawer.render(moments, views, size).color == expected.color).all()
    level = drawer._buffers["level"][: 4 * size[0] * size[1] // 16].reshape(4, size[1], -1)
    assert expected.ids is not None
    wall = expected.ids == np.bincount(expected.ids[expected.ids >= 0].reshape(-1)).argmax()
    assert wall.mean() > 0.3
    assert np.repeat(level == 3, 16, axis=-1)[wall].mean() < 0.1
