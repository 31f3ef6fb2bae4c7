"""Surfaces in one plane are told apart, the later over the earlier, and nothing else is touched."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from numpy.typing import NDArray

from runtime import shapes
from runtime.mesh import Mesh, join
from runtime.raster.renderer import Renderer
from runtime.raster.types import STYLES, Camera
from vdsl.library import Catalog
from vdsl.pipeline.steadiness import panned, steadiness
from vdsl.pipeline.trial import stage_script
from vdsl.stage.assemble import palettes
from vdsl.stage.flush import HAIR, told_apart
from vdsl.stage.world import build_world

RED, BLUE, GREEN = (0.8, 0.2, 0.2), (0.2, 0.2, 0.8), (0.2, 0.7, 0.2)


def block(size: tuple[float, float, float], at: tuple[float, float, float], color: shapes.Colour) -> Mesh:
    matrix = np.eye(4)
    matrix[:3, 3] = at
    return shapes.box(size, color=color).transformed(matrix)


def tops(meshes: list[Mesh]) -> list[float]:
    return [float(mesh.vertices[:, 2].max()) for mesh in meshes]


def test_the_later_one_lies_over_the_earlier_one() -> None:
    low, high = block((1, 1, 0.5), (0, 0, 0), RED), block((0.5, 0.5, 0.5), (0.3, 0, 0), BLUE)
    below, above = told_apart([low, high])
    assert above is high
    assert tops([below, above]) == pytest.approx([0.5 - HAIR, 0.5])
    # only what is common: tops and feet, not the sides, of which none is
    moved = np.abs(below.vertices - low.vertices).max(axis=0)
    assert moved == pytest.approx([0, 0, HAIR], abs=1e-6)
    swapped = told_apart([high, low])
    assert tops(swapped) == pytest.approx([0.5 - HAIR, 0.5])


def test_each_of_several_lies_over_those_before_it() -> None:
    three = [block((1 - 0.2 * k, 1, 0.5), (0, 0, 0), c) for k, c in enumerate((RED, BLUE, GREEN))]
    got = tops(told_apart(three))
    assert got[2] == 0.5
    assert all(b - a == pytest.approx(HAIR, abs=1e-6) for a, b in pairwise(got))
    whole = join(told_apart(three)).vertices
    assert (whole.min(0) == join(three).vertices.min(0)).all()
    assert (whole.max(0) == join(three).vertices.max(0)).all()


@pytest.mark.parametrize(
    "other",
    [
        block((1, 1, 0.5), (0, 0, 0.5), BLUE),  # stands on it: their faces look at each other
        block((1, 1, 0.5), (1, 0, 0), BLUE),  # beside it: in one plane, but nowhere both
        block((1, 1, 0.5), (0.2, 0.2, 0.002), BLUE),  # two millimetres higher
        block((0.5, 0.5, 0.5), (0.3, 0, 0), RED),  # of one colour: no pixel tells them apart
    ],
)
def test_what_is_not_flush_is_left_as_it_is(other: Mesh) -> None:
    given = [block((1, 1, 0.5), (0, 0, 0), RED), other]
    assert all(a is b for a, b in zip(told_apart(given), given, strict=True))
    assert told_apart([]) == []


def test_turned_ones_far_out_are_told_apart_too() -> None:
    angle = np.radians(33.0)
    turn = np.eye(4)
    turn[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    turn[:3, 3] = (41.0, -37.0, 3.0)
    flush = [block((1, 1, 0.5), (0, 0, 0), RED), block((0.4, 0.4, 0.5), (0, -0.3, 0), BLUE)]
    below, above = told_apart([mesh.transformed(turn) for mesh in flush])
    ahead = turn[:3, :3] @ (0, -1, 0)
    fronts = [float((mesh.vertices @ ahead).max()) for mesh in (below, above)]
    assert fronts[1] - fronts[0] == pytest.approx(HAIR, abs=3e-5)
    corners = np.unique(below.vertices.round(4), axis=0)
    assert len(corners) == 8, "it stays closed"


def test_a_sheet_is_not_turned_inside_out() -> None:
    sheet, over = block((1, 1, 0.001), (0, 0, 0), RED), block((0.5, 1, 0.001), (0.2, 0, 0), BLUE)
    below, _ = told_apart([sheet, over])
    assert 0.0005 < float(np.ptp(below.vertices[:, 2])) < 0.001


def front_of(world_low: tuple[float, ...], world_high: tuple[float, ...]) -> Camera:
    """From the front and below, at what is under the roof."""
    low, high = np.array(world_low), np.array(world_high)
    aim = np.array([(low[0] + high[0]) / 2, low[1] + 0.3, high[2] - 0.6])
    eye = np.array([low[0] - 1.0, low[1] - 2.5, 1.2])
    ahead = (aim - eye) / np.linalg.norm(aim - eye)
    right = np.cross(ahead, (0, 0, 1))
    right /= np.linalg.norm(right)
    axes = np.stack([right, np.cross(right, ahead), ahead])
    one = np.ones(1, np.float32)
    return Camera(eye[None].astype(np.float32), axes[None].astype(np.float32), 35 * one, (36.0, 20.25))


def test_a_roof_flush_with_its_gable_does_not_flicker() -> None:
    """The beach's huts, on a slow pan: stripes ran over the undersides of their gables."""
    staged = stage_script('storyboard "x"\nscene s = beach at day\n\n/ (static wide)\n', "beach").staged
    hut = next(o for o in staged.world.objects if o.path[-1] == "hut_3")
    drawer = Renderer("cpu", STYLES["board"])
    drawer.load(staged.render)
    camera = panned(front_of(hut.low, hut.high), 4, 0.125)
    hidden = np.zeros(len(staged.world.walls), np.bool_)
    palette = palettes(staged, {}, {}, np.array([0]))[0]
    assert steadiness(drawer, palette, camera, hidden, (640, 360)).worst < 0.008


def flush_area(corners: NDArray[np.float64], colors: NDArray[np.float32]) -> float:
    """Square metres that faces [F, 3, 3] of two colours share: of those that look straight up, by points of a
    grid of 2 cm."""
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    up = normal[:, 2] > 0.9999 * np.linalg.norm(normal, axis=1)
    seen: dict[tuple[int, int, int], tuple[float, ...]] = {}
    found: set[tuple[int, int, int]] = set()
    for (a, b, c), color in zip(corners[up], colors[up].tolist(), strict=True):
        low, high = np.minimum(np.minimum(a, b), c), np.maximum(np.maximum(a, b), c)
        if (high - low)[:2].max() > 3.0:
            continue  # floors, which nothing is flush with
        x, y = np.meshgrid(*(np.arange(np.ceil(low[k] / 0.02), high[k] / 0.02) for k in (0, 1)))
        points = np.stack([x.ravel(), y.ravel()], 1)
        inside = np.ones(len(points), bool)
        for p, q in ((a, b), (b, c), (c, a)):
            edge = (q - p)[:2]
            to = points * 0.02 - p[:2]
            inside &= edge[0] * to[:, 1] - edge[1] * to[:, 0] > 1e-5
        for place in points[inside].astype(int).tolist():
            key = (place[0], place[1], round(float(a[2]) * 1e4))
            if seen.setdefault(key, tuple(color)) != tuple(color):
                found.add(key)
    return len(found) * 0.02**2


@pytest.mark.parametrize("name", ["shop", "bar", "library"])
def test_no_two_colours_share_a_top_in_a_set(name: str) -> None:
    catalog = Catalog()
    definition = catalog.get("set", name)
    assert definition is not None
    mesh = build_world(definition, catalog).mesh
    assert flush_area(mesh.vertices[mesh.faces].astype(float), mesh.colors) == 0


def test_a_rough_landscape_is_left_alone_and_costs_little() -> None:
    """Nearly flat everywhere: compared facet by facet it would fill the memory."""
    side = 220
    x, y = np.meshgrid(np.arange(side) * 0.1, np.arange(side) * 0.1, indexing="ij")
    z = np.random.default_rng(1).normal(0, 1e-4, x.shape)
    a = (np.arange(side - 1)[:, None] * side + np.arange(side - 1)).ravel()
    faces = np.concatenate([np.stack([a, a + side, a + side + 1], 1), np.stack([a, a + side + 1, a + 1], 1)])
    vertices = np.stack([x, y, z], -1).reshape(-1, 3)
    land = shapes.painted(vertices, faces, np.tile([0.0, 0.0, 1.0], (len(vertices), 1)), GREEN)
    trunk, plate = block((0.2, 0.2, 2), (3, 3, 0), RED), block((0.1, 0.2, 2), (3, 3, 0), BLUE)
    got = told_apart([land, trunk, plate])
    assert got[0] is land
    assert tops(got[1:]) == pytest.approx([2 - HAIR, 2])


@pytest.mark.parametrize("turned", [False, True])
def test_a_slanting_triangle_and_what_is_flush_with_it(turned: bool) -> None:
    """As of a hipped roof: the middle of its bounds lies far off its plane."""

    def slab(corners: list[tuple[float, float]]) -> Mesh:
        made = shapes.extrude(corners, 0.1, RED if len(corners) == 3 else BLUE)
        lean = np.eye(4)
        lean[:3, :3] = np.linalg.qr(np.array([[1.0, 0.3, 0.2], [-0.2, 1.0, 0.4], [-0.3, -0.5, 1.0]]))[0]
        return made.transformed(lean)

    roof, patch = slab([(0, 0), (4, 0), (0, 4)]), slab([(0.5, 0.5), (1, 0.5), (1, 1), (0.5, 1)])
    angle = np.radians(33.0 if turned else 0.0)
    turn = np.eye(4)
    turn[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    below, above = told_apart([roof.transformed(turn), patch.transformed(turn)])
    assert below is not roof
    assert np.abs(below.vertices - roof.transformed(turn).vertices).max() == pytest.approx(HAIR, abs=2e-4)
    assert (above.vertices == patch.transformed(turn).vertices).all()


def test_thin_sheets_lie_in_their_order() -> None:
    sheets = [block((1 - 0.1 * k, 1, 0.0015), (0, 0, 0), c) for k, c in enumerate((RED, BLUE, GREEN))]
    got = tops(told_apart(sheets))
    assert got == sorted(got)
    assert min(b - a for a, b in pairwise(got)) > 1e-4


def test_large_flat_grids_are_compared_in_little_memory() -> None:
    def grid(color: shapes.Colour, z: float) -> Mesh:
        side = 40
        x, y = np.meshgrid(np.arange(side) * 0.1, np.arange(side) * 0.1, indexing="ij")
        a = (np.arange(side - 1)[:, None] * side + np.arange(side - 1)).ravel()
        faces = [np.stack([a, a + side, a + side + 1], 1), np.stack([a, a + side + 1, a + 1], 1)]
        vertices = np.stack([x, y, np.full_like(x, z)], -1).reshape(-1, 3)
        up = np.tile([0.0, 0.0, 1.0], (len(vertices), 1))
        return shapes.painted(vertices, np.concatenate(faces), up, color)

    below, above = told_apart([grid(RED, 1.0), grid(BLUE, 1.0)])
    assert above.vertices[0, 2] - below.vertices[0, 2] == pytest.approx(HAIR, abs=1e-6)
