"""The rasteriser against its twin where it is easy to be wrong: fill rule, clipping, odd sizes, big and tiny.

Everything is drawn on the CPU, with the one-thread fill and with the one that GPUs use.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from raster_scenes import LIGHT, box, from_lists, looking, scene, sphere, still
from twin import covers, trace

from runtime.mesh import Mesh
from runtime.raster.renderer import Renderer
from runtime.raster.types import Camera, Frames, RenderScene, Style, Views
from runtime.raster.views import pack_views

PLAIN = Style("plain", outline=False, tones=0, quiet=0.45, shadows=False, occlusion=False)
TONED = replace(PLAIN, name="toned", tones=3)
#: One pixel, one row, one column, and widths on and beside the edges of runs and blocks.
SIZES = ((1, 1), (1, 29), (29, 1), (15, 17), (16, 16), (17, 15), (33, 9), (49, 37))


@pytest.fixture(scope="module", params=["serial", "atomic"])
def drawer(request: pytest.FixtureRequest) -> Renderer:
    made = Renderer("cpu", PLAIN)
    made.serial = request.param == "serial"
    return made


def compare(
    drawer: Renderer, content: RenderScene, views: Views, size: tuple[int, int], palettes: NDArray[np.float32]
) -> float:
    """Draw and trace every view, compare ids and depths; returns the share of pixels that were compared."""
    drawer.load(content)
    frames = drawer.render(palettes, views, size, ids=True, depth=True)
    assert frames.ids is not None
    assert frames.depth is not None
    z = frames.depth.astype(float)
    shares = []
    for n in range(len(views.moment)):
        t = trace(content, views, n, size, PLAIN.quiet, palettes=palettes)
        assert (frames.ids[n] == t.ids)[t.sure].all(), (n, size)
        both = t.sure & np.isfinite(t.depth)
        assert (np.abs(1.0 / z[n] - 1.0 / t.depth) <= t.slack)[both].all(), (n, size)
        assert np.isinf(z[n][t.sure & ~np.isfinite(t.depth)]).all()
        shares.append(t.sure.mean())
    return float(np.mean(shares))


def soup(rng: np.random.Generator, count: int, reach: float, spread: float) -> Mesh:
    """Loose triangles around the origin, all of them seen from both sides."""
    at = rng.normal(0, reach, (count, 1, 3)) + rng.normal(0, spread, (count, 3, 3))
    normals = rng.normal(0, 1, (3 * count, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return from_lists(at.reshape(-1, 3), np.arange(3 * count).reshape(-1, 3), normals, (0.5, 0.6, 0.7))


def tumbled(rng: np.random.Generator, count: int) -> NDArray[np.float32]:
    """Palettes [count, 2, 3, 4] that turn, stretch and move two bones."""
    out = still(2, count)
    turn, _ = np.linalg.qr(rng.normal(0, 1, (count, 2, 3, 3)))
    out[..., :3] = turn * rng.uniform(0.7, 1.4, (count, 2, 1, 1))
    out[..., 3] = rng.normal(0, 0.3, (count, 2, 3))
    return out


@pytest.mark.parametrize("size", SIZES)
def test_a_soup_of_triangles_around_the_eye(drawer: Renderer, size: tuple[int, int]) -> None:
    # about a third of them cross the near plane, many fill the picture, some are smaller than a pixel
    rng = np.random.default_rng(size[0] * 100 + size[1])
    content = scene(
        [soup(rng, 40, 2.0, 1.5), soup(rng, 40, 3.0, 0.05)],
        [soup(rng, 30, 1.5, 1.0), soup(rng, 30, 2.0, 0.1)],
    )
    eyes = [tuple(p) for p in rng.normal(0, 0.4, (3, 3))]
    aims = [tuple(p) for p in rng.normal(0, 2, (3, 3))]
    views = looking(eyes, aims, focal=20, moments=[0, 1, 1])
    share = compare(drawer, content, views, size, tumbled(rng, 2))
    assert share > 0.7 or 1 in size


def test_joints_blend(drawer: Renderer) -> None:
    rng = np.random.default_rng(4)
    content = scene([], [soup(rng, 60, 0.5, 0.3)] * 2)
    weights = rng.dirichlet((1, 1, 1, 1), len(content.joints)).astype(np.float32)
    joints = rng.integers(0, 2, content.joints.shape).astype(np.int32)
    content = replace(content, joints=joints, weights=weights)
    views = looking([(0.0, -3.0, 0.5)] * 2, [(0.0, 0.0, 0.0)] * 2, moments=[0, 1])
    assert compare(drawer, content, views, (49, 37), tumbled(rng, 2)) > 0.9


def test_a_wall_through_the_camera(drawer: Renderer) -> None:
    # static and moving, beside the lens, under it and across it
    slab = box((0.2, -5, -3), (0.4, 5, 3), (0.3, 0.5, 0.7))
    for content in (scene([box((-5, -5, -0.2), (5, 5, 0)), slab], []), scene([], [slab])):
        eyes = [(0.0, 0.0, 1.2), (0.19, 0.0, 1.2), (0.0, 0.0, 0.02)]
        aims = [(0.3, 3.0, 1.0), (0.3, 1.0, 1.0), (0.1, 3.0, 0.0)]
        views = looking(eyes, aims, focal=18)
        assert compare(drawer, content, views, (49, 37), still(1)) > 0.9


def test_a_beam_beside_the_eye_is_as_far_as_it_is(drawer: Renderer) -> None:
    """Long, narrow and across the eye's plane, off to the side: it came out metres too near or too far."""
    beam = box((-5, 3.0, 3.1), (15, 3.06, 3.4), (0.3, 0.5, 0.7))
    floor = box((-5, -2, -0.1), (15, 3, 0), (0.6, 0.6, 0.5))
    for content in (scene([floor, beam], []), scene([floor], [beam])):
        drawer.load(content)
        aims = [(8.0, 3.0 + 0.02 * k, 3.1) for k in range(4)]
        views = looking([(0.0, 0.0, 0.15)] * 4, aims, focal=30)
        size = (320, 180)
        z = drawer.render(still(1), views, size, depth=True).depth
        assert z is not None
        for n in range(4):
            t = trace(content, views, n, size, PLAIN.quiet, palettes=still(1))
            sure = t.sure & np.isfinite(t.depth)
            assert (t.ids[sure] == 1).sum() > 300
            np.testing.assert_allclose(z[n][sure], t.depth[sure], rtol=2e-4)


def test_triangles_far_larger_than_the_picture(drawer: Renderer) -> None:
    far = 2000.0
    ground = from_lists(
        [(-far, -far, 0), (far, -far, 0), (far, far, 0), (-far, far, 0)],
        [(0, 1, 2), (0, 2, 3)],
        [(0, 0, 1)] * 4,
        (0.5, 0.5, 0.5),
    )
    sliver = from_lists(
        [(-far, 9, 1.0), (far, 9, 1.0), (0, 9, 1.001)], [(0, 1, 2)], [(0, -1, 0)] * 3, (0.9, 0.1, 0.1)
    )
    views = looking([(0.3, 0.1, 1.6), (0.0, 0.0, 1.0)], [(0.7, 30.0, 0.0), (5.0, 9.0, 1.0)], focal=24)
    assert compare(drawer, scene([ground, sliver], []), views, (49, 37), still(1)) > 0.85


def test_degenerate_triangles_draw_nothing(drawer: Renderer) -> None:
    at = [(0, 2, 1), (0.4, 2, 1), (0.8, 2, 1), (0.1, 2, 1.3), (0.1, 2, 1.3)]
    faces = [(0, 1, 2), (0, 0, 1), (3, 4, 3), (1, 2, 2), (0, 2, 1)]
    flat = from_lists(at, faces, [(0, -1, 0)] * 5, (0.5, 0.5, 0.5))
    for content in (scene([flat], []), scene([], [flat])):
        drawer.load(content)
        frames = drawer.render(still(1), looking([(0.0, 0.0, 1.0)], [(0.2, 2.0, 1.0)]), (49, 37), ids=True)
        assert frames.ids is not None
        assert (frames.ids == -1).all()


def on_screen(corners: NDArray[np.int64], size: tuple[int, int]) -> tuple[Mesh, Camera]:
    """Triangles [F, 3, 2] in quarters of a pixel as a mesh, and the camera that sees them exactly so."""
    width, height = size
    at = np.ones((len(corners) * 3, 3))
    flat = corners.reshape(-1, 2) / 4.0
    at[:, 0] = (flat[:, 0] - width / 2) / 64
    at[:, 2] = -(flat[:, 1] - height / 2) / 64
    mesh = from_lists(
        at, np.arange(len(at)).reshape(-1, 3), np.tile((0.0, -1.0, 0.0), (len(at), 1)), (0.5, 0.5, 0.5)
    )
    axes = np.array([[[1, 0, 0], [0, 0, 1], [0, 1, 0]]], np.float32)
    camera = Camera(
        np.zeros((1, 3), np.float32), axes, np.array([64], np.float32), (float(width), float(height))
    )
    assert (pack_views(camera, 1, width, height)[0, 12:14] == 64).all()  # nothing is rounded on the way
    return mesh, camera


def each_alone(
    drawer: Renderer, corners: NDArray[np.int64], size: tuple[int, int], moving: bool
) -> NDArray[np.bool_]:
    """What each triangle fills when the others are hidden, [F, H, W]."""
    mesh, camera = on_screen(corners, size)
    count = len(corners)
    content = scene([], [mesh]) if moving else scene([mesh], [])
    own = np.arange(count, dtype=np.int32)
    if moving:
        content = replace(content, fitting=own, wall_count=count)
    else:
        content = replace(content, static_wall=own, wall_count=count)
    many = Camera(
        np.repeat(camera.position, count, axis=0),
        np.repeat(camera.axes, count, axis=0),
        np.repeat(camera.focal, count),
        camera.sensor,
    )
    drawer.load(content)
    views = Views(many, np.zeros(count, np.int32), ~np.eye(count, dtype=bool))
    ids = drawer.render(still(1), views, size, ids=True).ids
    assert ids is not None
    return ids == 0


@pytest.mark.parametrize("moving", [False, True])
@pytest.mark.parametrize("size", [(32, 24), (25, 19)])
def test_left_and_top_edges_belong_to_a_triangle(
    drawer: Renderer, size: tuple[int, int], moving: bool
) -> None:
    # corners lie on quarters of pixels, so that many edges pass exactly through centres
    rng = np.random.default_rng(size[0])
    low, high = np.array([-20, -20]), np.array(size) * 4 + 20
    corners = rng.integers(low, high, (60, 3, 2))
    corners[:20, 1, 0] = corners[:20, 0, 0]  # upright edges
    corners[10:30, 2, 1] = corners[10:30, 0, 1]  # level edges
    corners[:30] = corners[:30] // 4 * 4 + 2  # through centres
    filled = each_alone(drawer, corners, size, moving)
    for k, triangle in enumerate(corners):
        inside, slanted = covers(triangle, size)
        assert (filled[k] == inside)[~slanted].all(), triangle


@pytest.mark.parametrize("moving", [False, True])
def test_neighbours_leave_neither_gaps_nor_doubles(drawer: Renderer, moving: bool) -> None:
    # a crooked net over the whole picture, its corners on quarters of pixels, many right on centres
    rng = np.random.default_rng(8)
    size = (32, 24)
    x, y = np.meshgrid(np.linspace(-16, 144, 6), np.linspace(-16, 112, 5))
    net = np.rint(np.stack([x, y], axis=-1)).astype(np.int64)
    net[1:-1, 1:-1] += rng.integers(-8, 9, (3, 4, 2))
    net[1:-1, 1:-1] = net[1:-1, 1:-1] // 2 * 2
    triangles = []
    for i in range(4):
        for j in range(5):
            a, b, c, d = net[i, j], net[i, j + 1], net[i + 1, j + 1], net[i + 1, j]
            triangles += [(a, b, c), (a, c, d)] if (i + j) % 2 else [(a, b, d), (b, c, d)]
    filled = each_alone(drawer, np.array(triangles), size, moving)
    assert (filled.sum(axis=0) == 1).all()


def test_a_closed_body_has_no_pinholes(drawer: Renderer) -> None:
    # from within, in the dark of its own far side: every pixel is covered whatever the size
    ball = sphere((0, 0, 0), (1.0, 1.3, 0.8), (0.5, 0.5, 0.5), rings=24)
    inside_out = replace(ball, faces=np.ascontiguousarray(ball.faces[:, ::-1]), normals=-ball.normals)
    for content in (scene([inside_out], []), scene([], [inside_out])):
        drawer.load(content)
        for size in ((61, 47), (128, 72)):
            views = looking([(0.1, 0.2, 0.1)] * 2, [(1.0, 0.3, 0.2), (-0.4, -1.0, 0.5)], focal=14)
            ids = drawer.render(still(1), views, size, ids=True).ids
            assert ids is not None
            assert (ids == 0).all()


def shaded(style: Style, content: RenderScene, views: Views, size: tuple[int, int]) -> Frames:
    made = Renderer("cpu", style)
    made.load(content)
    return made.render(still(1), views, size, ids=True)


@pytest.mark.parametrize("style", [PLAIN, TONED], ids=["smooth", "toned"])
def test_colours_are_the_twins(style: Style) -> None:
    content = scene(
        [
            box((-2, -2, -0.1), (2, 2, 0), (0.8, 0.7, 0.6)),
            box((-2, 1.9, 0), (2, 2, 2.6), (0.4, 0.6, 0.8)),
            sphere((-0.9, 0.4, 0.5), (0.5, 0.5, 0.5), (0.7, 0.6, 0.3), rings=24),
        ],
        [sphere((0.6, 0.2, 0.9), (0.4, 0.3, 0.8), (0.8, 0.2, 0.2), rings=9)],
        light=replace(LIGHT, sun=(0.48, -0.6, 0.64)),
    )
    size = (80, 57)
    views = looking([(0.4, -3.0, 1.6), (2.0, -1.5, 0.7)], [(0.0, 0.5, 0.7), (-0.5, 0.6, 0.5)], focal=28)
    frames = shaded(style, content, views, size)
    for n in range(2):
        t = trace(content, views, n, size, style.quiet, style.tones)
        flat = t.sure.copy()
        for axis in (0, 1):
            for step in (-1, 1):
                flat &= np.roll(t.ids, step, axis) == t.ids
        flat[[0, -1]] = flat[:, [0, -1]] = False
        apart = np.abs(frames.color[n].astype(float) - t.color).max(axis=-1)[flat]
        assert flat.mean() > 0.7
        # colours are looked up every few pixels and lie between; the edge of a tone is a little softer
        assert np.quantile(apart, 0.9) <= 1.5
        assert np.quantile(apart, 0.99) <= (3.0 if style.tones == 0 else 12.0)


def test_what_is_not_finite_is_refused_where_it_enters() -> None:
    at = np.zeros((3, 3), np.float32)
    for bad in (np.nan, np.inf):
        at[1, 2] = bad
        with pytest.raises(ValueError, match="vertices"):
            from_lists(at, [(0, 1, 2)], [(0, 0, 1)] * 3, (0.5, 0.5, 0.5))
    content = scene([], [sphere((0, 2, 1), (0.3, 0.3, 0.3), (0.5, 0.5, 0.5), rings=4)])
    drawer = Renderer("cpu", PLAIN)
    weights = content.weights.copy()
    weights[0, 0] = np.nan
    with pytest.raises(ValueError, match="weights"):
        drawer.load(replace(content, weights=weights))
    drawer.load(content)
    palettes = still(1)
    palettes[0, 0, 1, 3] = np.inf
    with pytest.raises(ValueError, match="palettes"):
        drawer.render(palettes, looking([(0.0, 0.0, 1.0)], [(0.0, 2.0, 1.0)]), (9, 9))
