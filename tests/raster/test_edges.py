"""Edges are where they are to a part of a pixel: triangles tell, and surfaces are followed to their end."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from raster_scenes import LIGHT, box, from_lists, looking, room, scene, sphere, still

from runtime.mesh import Mesh, join
from runtime.raster import passes
from runtime.raster.adjacency import beside
from runtime.raster.film import to_linear
from runtime.raster.passes import Passes
from runtime.raster.renderer import Renderer
from runtime.raster.types import STYLES, Style

EVEN = replace(LIGHT, sun_color=(0.0, 0.0, 0.0), sky=(0.8, 0.8, 0.8), ground=(0.8, 0.8, 0.8))
BARE = Style("bare", outline=False, tones=0, shadows=False, occlusion=False)


def test_triangles_of_a_box_are_joined_at_all_edges() -> None:
    mesh = box((0, 0, 0), (1, 2, 3))
    joined = beside(mesh.vertices, mesh.faces, np.zeros(12, np.int32))
    assert (joined >= 0).all()  # though every side has corners of its own
    for face, others in enumerate(joined):
        for edge, other in enumerate(others):
            assert face in joined[other]
            ends = mesh.vertices[mesh.faces[face, [edge, (edge + 1) % 3]]]
            theirs = mesh.vertices[mesh.faces[other]]
            assert all((np.abs(theirs - end).max(axis=1) < 1e-9).any() for end in ends)


def test_only_triangles_of_a_piece_are_joined_and_no_more_than_two_at_an_edge() -> None:
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1]], float)
    fan = np.array([[0, 1, 2], [1, 0, 3], [0, 1, 4]], np.int32)
    assert beside(vertices, fan[:2], np.zeros(2, np.int32)).tolist() == [[1, -1, -1], [0, -1, -1]]
    assert (beside(vertices, fan[:2], np.array([0, 1], np.int32)) == -1).all()
    assert (beside(vertices, fan, np.zeros(3, np.int32)) == -1).all()
    assert beside(vertices, fan[:0], np.zeros(0, np.int32)).shape == (0, 3)
    flat = np.array([[0, 1, 1], [1, 0, 2]], np.int32)  # one without area joins nothing to itself
    assert (beside(vertices, flat, np.zeros(2, np.int32)) != np.arange(2)[:, None]).all()


def covered(drawer: Renderer, shift: float, axis: int, side: int) -> NDArray[np.float64]:
    """The light along a line across a thing in front of what is nearly black, 1 in its middle."""
    at = [0.0, -4.0, 0.0]
    at[(0, 2)[axis]] = shift
    target = (at[0], 0.0, at[2])
    views = looking([(at[0], at[1], at[2])], [target], sensor=(36.0, 36.0))
    color = drawer.render(still(1), views, (side, side)).color[0, ..., 1]
    line = color[side // 2] if axis == 0 else color[:, side // 2]
    light = to_linear(line / 255.0)
    return np.asarray((light - light.min()) / (light[side // 2] - light.min()))


@pytest.fixture(autouse=True)
def small_pictures_too(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(passes, "FINE", 0)


@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize(
    "thing",
    [
        box((-0.5, 0, -0.5), (0.5, 0.4, 0.5), (0.9, 0.9, 0.9)),
        sphere(
            (0, 0, 0), (0.5, 0.3, 0.5), (0.9, 0.9, 0.9), rings=64
        ),  # at whose outline triangles are narrow
    ],
    ids=["box", "ball"],
)
def test_an_outline_moves_by_parts_of_a_pixel(thing: Mesh, axis: int) -> None:
    """Carried over two pixels in small steps, a thing is as wide everywhere, and moves as far each time."""
    drawer = Renderer("cpu", BARE)
    drawer.load(scene([box((-9, 5, -9), (9, 6, 9), (0.01, 0.01, 0.01)), thing], [], light=EVEN))
    side, shifts = 96, np.linspace(0, 0.08, 13)
    lines = np.array([covered(drawer, shift, axis, side) for shift in shifts])
    width = lines.sum(axis=1)
    assert np.ptp(width) < 0.3
    places = (lines * np.arange(side)).sum(axis=1) / width
    moved = np.abs(np.diff(places))
    assert moved.min() > 0.3 * moved.mean()
    assert moved.max() < 2.0 * moved.mean()


def test_an_outline_is_as_sharp_wherever_it_passes_between_pixels() -> None:
    """Else a line would pulse as the camera turns."""
    drawer = Renderer("cpu", BARE)
    behind, thing = box((-9, 5, -9), (9, 6, 9), (0.01, 0.01, 0.01)), box((-0.5, 0, -0.5), (0.5, 0.4, 0.5))
    drawer.load(scene([behind, thing], [], light=EVEN))
    # half of a line across it: its two edges pass between pixels alike or not
    lines = np.array([covered(drawer, shift, 0, 96)[:48] for shift in np.linspace(0, 0.08, 13)])
    sharp = (np.diff(lines, axis=1) ** 2).sum(axis=1)
    assert sharp.max() < 1.35 * sharp.min()  # twice, where a pixel gets of its neighbour what is covered


@pytest.mark.parametrize("axis", [0, 1])
def test_where_things_run_into_each_other_moves_by_parts_of_a_pixel(axis: int) -> None:
    """A dark plate that comes out of a bright one, of which no edge is anywhere near."""
    drawer = Renderer("cpu", BARE)
    bright, dark = (box((-9, 0, -9), (9, 1, 9), (c, c, c)) for c in (0.9, 0.02))
    turn = np.radians(6.0)
    across, up = (0, 2)[axis], 1
    tilted = dark.vertices.copy()
    tilted[:, across] = np.cos(turn) * dark.vertices[:, across] - np.sin(turn) * dark.vertices[:, up]
    tilted[:, up] = np.sin(turn) * dark.vertices[:, across] + np.cos(turn) * dark.vertices[:, up]
    drawer.load(scene([bright, replace(dark, vertices=tilted)], [], light=EVEN))
    side, places = 96, []
    for shift in np.linspace(0.02, 0.1, 13):
        at = [0.0, -4.0, 0.0]
        at[across] = shift
        target = (at[0], 0.0, at[2])
        color = drawer.render(
            still(1), looking([(at[0], at[1], at[2])], [target], sensor=(36.0, 36.0)), (side, side)
        )
        line = color.color[0, side // 2, :, 1] if axis == 0 else color.color[0, :, side // 2, 1]
        light = to_linear(line / 255.0)
        places.append(float((light - light.min()).sum() / np.ptp(light)))
    moved = np.abs(np.diff(places))
    assert moved.min() > 0.5 * moved.mean()
    assert moved.max() < 1.5 * moved.mean()


@pytest.fixture
def by_both(monkeypatch: pytest.MonkeyPatch) -> list[tuple[NDArray[Any], NDArray[Any]]]:
    """What smoothing by runs made of each picture, and what it makes of it pixel by pixel."""
    seen: list[tuple[NDArray[Any], NDArray[Any]]] = []
    real = Passes.even_out

    def both(self: Passes, loaded, moments, layer, views, color, size) -> None:  # type: ignore[no-untyped-def]
        real(self, loaded, moments, layer, views, color, size)
        other, run = np.copy(color), self.run
        self.run = size[0] + 1  # no row is whole runs
        real(self, loaded, moments, layer, views, other, size)
        self.run = run
        seen.append((np.copy(color), other))

    monkeypatch.setattr(Passes, "even_out", both)
    return seen


@pytest.mark.parametrize("up", [1, -1], ids=["ceiling", "floor"])
def test_where_a_wall_meets_what_ends_within_it_is_one_line(up: int) -> None:
    """Seen at a slant, it is as dark everywhere, and straight."""
    pale, heights = (0.8, 0.8, 0.8), sorted((0.0, 0.1 * up))
    level = box((-8, -3, heights[0]), (8, 8.03, heights[1]), pale)
    wall = box((-8, 8, -3), (8, 8.3, 3), pale, part=1)
    drawer = Renderer("cpu", Style("lines", tones=0, shadows=False, occlusion=False))
    for things in ([level, wall], [wall, level]):
        drawer.load(scene(things, [], light=EVEN))
        views = looking([(0.0, -0.5, -1.0 * up)], [(0.6, 8.0, -0.1 * up)])
        picture = drawer.render(still(1), views, (640, 360)).color[0, ::up, 40:600, 1].astype(float)
        strip = picture[158:188]
        surface = strip[0] + (strip[-1] - strip[0]) * np.linspace(0, 1, 30)[:, None]
        line = np.clip(surface - strip - 1.0, 0.0, None)
        dark = line.sum(axis=0)
        at, across = (line * np.arange(30)[:, None]).sum(axis=0) / dark, np.arange(560)
        assert dark.min() > 0.6 * dark.max()
        assert np.abs(at - np.polyval(np.polyfit(across, at, 1), across)).max() < 0.2


@pytest.mark.parametrize("size", [(640, 360), (224, 126)])
def test_an_outline_stays_where_it_is_as_one_goes_away(size: tuple[int, int]) -> None:
    """Of an arm before its body it is on the arm, as near as it may be, and never gone."""
    pale = (0.8, 0.8, 0.8)
    arm = box((-0.5, -0.14, 0), (0.0, -0.12, 2), pale, part=0)
    body = box((-2, 0, 0), (2, 0.2, 2), pale, part=1)
    drawer = Renderer("cpu", Style("lines", tones=0, shadows=False, occlusion=False))
    drawer.load(scene([box((-9, 20, -9), (9, 21, 9), pale)], [join([arm, body])], light=EVEN))
    away = np.linspace(3.0, 12.0, 60)
    views = looking([(0.0, -z, 1.0) for z in away], [(0.0, 0.0, 1.0)] * len(away))
    rows = drawer.render(still(1), replace(views, moment=np.zeros(60, np.int32)), size).color[
        :, size[1] // 2, :, 1
    ]
    middle = rows[:, size[0] // 2 - 6 : size[0] // 2 + 7].astype(float)
    dark = middle.max(axis=1, keepdims=True) - middle
    assert dark.max(axis=1).min() > 0.7 * dark.max(axis=1).max()
    at = (dark * np.arange(-6, 7)).sum(axis=1) / dark.sum(axis=1)
    assert -2.5 < at.min() <= at.max() < -0.5


def test_a_speck_of_skin_has_no_lines_around_it() -> None:
    """A triangle that comes through another in a single pixel, turned elsewhere, makes no cross of ink."""
    skin, light = (0.8, 0.6, 0.5), replace(EVEN, sky=(0.9, 0.9, 0.9))
    ball = sphere((0, 0, 0), (0.5, 0.5, 0.5), skin, rings=48)
    speck = from_lists(
        [(-0.004, -0.502, -0.004), (0.008, -0.502, -0.004), (-0.004, -0.502, 0.008)],
        [(0, 1, 2)],
        [(1.0, 0.2, 0.0)] * 3,
        skin,
    )
    drawer, pictures = Renderer("cpu", Style("lines", tones=0, shadows=False, occlusion=False)), []
    for thing in (ball, join([ball, speck])):
        drawer.load(scene([box((-9, 5, -9), (9, 6, 9))], [thing], light=light))
        views = looking([(0.006, -3.0, 0.006)], [(0.006, 0.0, 0.006)])
        pictures.append(drawer.render(still(1), views, (224, 126)).color[0].astype(int))
    changed = np.abs(pictures[0] - pictures[1]).max(axis=-1) > 12
    assert changed.sum() <= 1


def test_a_step_a_pixel_wide_is_not_dashed() -> None:
    """A frame a few millimetres before a wall, whose side is met by samples here and there."""
    pale = (0.8, 0.8, 0.8)
    frame, wall = box((-2, -0.004, -2), (0.031, 0.3, 2), pale), box((-3, 0, -3), (3, 0.3, 3), pale, part=1)
    drawer = Renderer("cpu", Style("lines", tones=0, shadows=False, occlusion=False))
    drawer.load(scene([frame, wall], [], light=EVEN))
    views = looking([(1.5, -7.0, 1.2)], [(0.0, 0.0, 0.0)])
    strip = drawer.render(still(1), views, (640, 360)).color[0, 100:260, 280:370, 1].astype(float)
    surface = np.maximum(strip[:, :1], strip[:, -1:])
    dark = np.clip(surface - strip - 1.0, 0.0, None).sum(axis=1)
    assert 0 < dark.max() < 2 * dark.min()


@pytest.mark.parametrize("style", ["board", "clay"])
def test_runs_of_sixteen_are_drawn_to_edges_as_single_pixels_are(
    style: str, by_both: list[tuple[NDArray[Any], NDArray[Any]]]
) -> None:
    drawer = Renderer("cpu", STYLES[style])
    drawer.load(room())
    views = looking([(2.6, -1.8, 1.5), (-1.5, -1.9, 1.2)], [(1.7, 1.8, 1.0), (0.4, 1.0, 0.8)])
    drawer.render(still(2), views, (160, 96))
    for quick, slow in by_both:
        assert np.array_equal(quick, slow)
    assert by_both
