"""The rasteriser against its slow twin, and what it promises."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest
from raster_scenes import LIGHT, box, from_lists, looking, room, scene, sphere, still
from twin import trace

from runtime.raster.device import DeviceError
from runtime.raster.prepare import closed_faces, prepare
from runtime.raster.renderer import Renderer
from runtime.raster.types import STYLES, RenderScene, Style, Views

PLAIN = Style("plain", outline=False, tones=0, quiet=0.45, shadows=False, occlusion=False)
ODD = (47, 33)  # crosses every block size


@lru_cache(maxsize=4)
def renderer(style: Style) -> Renderer:
    return Renderer("cpu", style)


def draw(s: RenderScene, views: Views, size=ODD, style: Style = PLAIN, ids=True, palettes=None):
    r = renderer(style)
    r.load(s)
    if palettes is None:
        palettes = still(int(s.joints.max(initial=0)) + 1, int(views.moment.max()) + 1)
    return r.render(palettes, views, size, ids)


def depths(count: int, size) -> np.ndarray:
    """Depths of the last batch, metres, inf where nothing is."""
    vis = np.asarray(renderer(PLAIN)._buffers["vis"])[: count * size[0] * size[1]]
    w = (vis >> np.uint64(32)).astype(np.uint32).view(np.float32).astype(float)
    with np.errstate(divide="ignore"):
        return (1.0 / w).reshape(count, size[1], size[0])


def shrunk(mask: np.ndarray) -> np.ndarray:
    """Without the pixels that have a neighbour outside."""
    return mask & np.roll(mask, 1, 1) & np.roll(mask, -1, 1) & np.roll(mask, 1, 0) & np.roll(mask, -1, 0)


def small() -> RenderScene:
    return scene(
        [
            box((0, 0, -0.1), (4, 4, 0), (0.8, 0.7, 0.6)),
            box((0, 3.9, 0), (4, 4, 2.6), (0.7, 0.8, 0.8)),
            box((1.2, 1.4, 0), (1.9, 2.2, 0.75), (0.5, 0.4, 0.3)),
        ],
        [sphere((2.4, 1.5, 1.0), (0.3, 0.2, 0.5), (0.8, 0.2, 0.2), rings=6)],
        walls=[-1, 0, -1],
    )


EYES = [(2.0, -1.8, 1.5), (0.4, 0.3, 1.9), (3.9, 0.1, 0.4)]
AIMS = [(2.0, 2.0, 1.0), (2.2, 2.0, 0.7), (1.0, 2.5, 1.2)]


def test_matches_the_twin() -> None:
    s, views = small(), looking(EYES, AIMS, focal=24, walls=1)
    for size in (ODD, (64, 64), (31, 70)):
        frames = draw(s, views, size)
        z = depths(3, size)
        for n in range(3):
            t = trace(s, views, n, size, PLAIN.quiet)
            assert t.sure.mean() > 0.9
            assert (frames.ids[n] == t.ids)[t.sure].all()
            both = t.sure & np.isfinite(t.depth)
            assert both.any()
            np.testing.assert_allclose(z[n][both], t.depth[both], rtol=2e-5)
            assert np.isinf(z[n][t.sure & ~np.isfinite(t.depth)]).all()
            inside = t.sure.copy()
            for axis in (0, 1):
                for step in (-1, 1):
                    inside &= np.roll(t.ids, step, axis) == t.ids
            got = frames.color[n].astype(float)
            # pixels away from edges, which the smoothing leaves alone
            assert np.quantile(np.abs(got - t.color)[inside], 0.95) <= 1.0


def test_shared_edges_have_neither_gaps_nor_doubles() -> None:
    # an irregular fan over the whole picture, in one plane: every pixel in exactly one triangle
    rng = np.random.default_rng(3)
    angles = np.sort(rng.uniform(0, 2 * np.pi, 40))
    ring = np.stack([3 * np.cos(angles), np.zeros(40), 3 * np.sin(angles) + 1.0], axis=1)
    vertices = np.concatenate([[(0.013, 0.0, 1.007)], ring])
    faces = [(0, 1 + k, 1 + (k + 1) % 40) for k in range(40)]
    mesh = from_lists(vertices, faces, [(0, -1, 0)] * 41, (0.5, 0.5, 0.5))
    views = looking([(0.0, -2.0, 1.0)], [(0.0, 0.0, 1.0)])
    whole = draw(scene([mesh], []), views)
    assert (whole.ids == 0).all()
    hits = np.zeros(whole.ids.shape[1:], int)
    for k in range(40):
        one = from_lists(vertices, [faces[k]], [(0, -1, 0)] * 41, (0.5, 0.5, 0.5))
        hits += draw(scene([one], []), views).ids[0] == 0
    assert (hits == 1).all()


def test_a_wall_through_the_camera_is_clipped() -> None:
    # a floor passing below the eye and behind it, and a wall beside it on both sides of the lens
    s = scene([box((-5, -5, -0.2), (5, 5, 0)), box((0.2, -5, 0), (0.4, 5, 3), (0.3, 0.5, 0.7))], [])
    views = looking([(0.0, 0.0, 1.2)], [(0.3, 3.0, 1.0)], focal=18)
    frames = draw(s, views)
    t = trace(s, views, 0, ODD, PLAIN.quiet)
    assert {0, 1} <= set(np.unique(t.ids))
    assert (frames.ids[0] == t.ids)[t.sure].all()
    # the eye inside a slab, facing its far side from within
    inside = draw(s, looking([(0.3, 0.0, 1.2)], [(0.3, 3.0, 1.2)]))
    assert np.isfinite(inside.color).all()


def test_huge_and_degenerate_triangles() -> None:
    vertices = [(-1e5, 5, -1e5), (1e5, 5, -1e5), (0, 5, 1e5), (1, 1, 1), (1, 1, 1), (2, 2, 2), (3, 3, 3)]
    mesh = from_lists(
        vertices, [(0, 1, 2), (3, 4, 5), (3, 5, 6), (3, 3, 3)], [(0, -1, 0)] * 7, (0.5, 0.5, 0.5)
    )
    frames = draw(scene([mesh], []), looking([(0.0, 0.0, 1.0)], [(0.0, 5.0, 1.0)]))
    assert (frames.ids == 0).all()


def test_hidden_walls_are_not_drawn_and_only_they() -> None:
    s, views = small(), looking(EYES[:1] * 2, AIMS[:1] * 2, walls=1)
    hidden = views.hidden.copy()
    hidden[1, 0] = True
    frames = draw(s, Views(views.camera, views.moment, hidden))
    assert (frames.ids[0] == 1).any()
    assert not (frames.ids[1] == 1).any()
    others = (frames.ids[0] != 1) & (frames.ids[1] >= 0)
    assert (frames.ids[0] == frames.ids[1])[others].all()


def test_backs_are_culled_only_on_closed_shells() -> None:
    cube = box((0, 0, 0), (1, 1, 1))
    owner = np.zeros(len(cube.faces), np.int32)
    assert closed_faces(cube, owner).all()
    lid_off = replace(cube, **{k: getattr(cube, k)[2:] for k in ("faces", "colors", "parts", "materials")})
    assert not closed_faces(lid_off, owner[2:]).any()
    # a single sheet is seen from both sides
    sheet = from_lists([(-1, 1, 0), (1, 1, 0), (0, 1, 2)], [(0, 1, 2)], [(0, -1, 0)] * 3, (0.5, 0.5, 0.5))
    for y in (0.0, 2.0):
        ids = draw(scene([sheet], []), looking([(0.0, y, 0.7)], [(0.0, 1.0, 0.7)])).ids
        assert (ids == 0).any()


def test_moments_move_what_is_skinned() -> None:
    s = small()
    palettes = still(1, 2)
    palettes[1, 0, 0, 3] = -1.0
    views = looking(EYES[:1] * 2, AIMS[:1] * 2, moments=[0, 1], walls=1)
    ids = draw(s, views, palettes=palettes).ids
    columns = [np.flatnonzero((ids[n] == 3).any(axis=0)).mean() for n in range(2)]
    assert columns[1] < columns[0] - 3


@pytest.mark.parametrize("style", [PLAIN, Style(), STYLES["plain"]])
def test_same_bytes_twice_and_one_by_one(style: Style) -> None:
    s = room()
    eyes = [(2.6, -1.8, 1.5), (0.5, 0.2, 1.6), (4.0, 0.4, 1.1)]
    moments = [1, 0, 1]
    palettes = still(2, 2)
    palettes[1, :, 1, 3] = 0.15
    views = looking(eyes, [(2.0, 1.8, 1.0)] * 3, moments=moments)
    first = draw(s, views, (61, 45), style, palettes=palettes)
    again = draw(s, views, (61, 45), style, palettes=palettes)
    np.testing.assert_array_equal(first.color, again.color)
    for n in range(3):
        one = looking(eyes[n : n + 1], [(2.0, 1.8, 1.0)], moments=moments[n : n + 1])
        alone = draw(s, one, (61, 45), style, palettes=palettes)
        np.testing.assert_array_equal(first.color[n], alone.color[0])
        np.testing.assert_array_equal(first.ids[n], alone.ids[0])


def test_the_plain_look_is_smooth_shading_and_knows_what_it_sees() -> None:
    """Colours of the flat faces of the set are those the light gives them, ids those of the full look."""
    views = looking(EYES[:1], AIMS[:1])
    plain, full = draw(room(), views, (64, 48), STYLES["plain"]), draw(room(), views, (64, 48))
    np.testing.assert_array_equal(plain.ids, full.ids)
    floor = plain.color[plain.ids == plain.ids[0, -1, 32]]
    assert len(np.unique(floor.reshape(-1, 3), axis=0)) <= 6, "no shadows, no haze, no pattern"


def test_long_batches_are_cut_without_a_trace(monkeypatch: pytest.MonkeyPatch) -> None:
    s, views = small(), looking(EYES, AIMS, walls=1)
    whole = draw(s, views)
    monkeypatch.setattr("runtime.raster.renderer.budget", lambda backend: 1)
    np.testing.assert_array_equal(draw(s, views).color, whole.color)


def test_moments_that_views_share_are_moved_once(monkeypatch: pytest.MonkeyPatch) -> None:
    palettes = still(1, 3)
    palettes[:, 0, 0, 3] = 0.0, -1.0, 0.6
    views = looking(EYES[:1] * 5, AIMS[:1] * 5, moments=[2, 0, 2, 0, 2], walls=1)
    drawer = Renderer("cpu", PLAIN)
    drawer.load(small())
    whole = drawer.render(palettes, views, ODD).color
    moved: list[int] = []
    move = drawer._moments.move

    def counted(content, palettes, *rest) -> None:
        moved.append(len(palettes))
        move(content, palettes, *rest)

    monkeypatch.setattr(drawer._moments, "move", counted)
    drawer._most = 2  # views at a time
    np.testing.assert_array_equal(drawer.render(palettes, views, ODD).color, whole)
    assert moved == [2]
    moved.clear()
    drawer.budget = 1  # no room for more than one
    np.testing.assert_array_equal(drawer.render(palettes, views, ODD).color, whole)
    assert moved == [1] * 5


def test_people_throw_shadows_and_are_inked() -> None:
    s = scene(
        [box((-3, -3, -0.1), (3, 3, 0), (0.7, 0.7, 0.7))],
        [sphere((0, 0, 0.6), (0.25, 0.25, 0.6), (0.8, 0.2, 0.2))],
    )
    views = looking([(0.0, -4.0, 2.0)], [(0.0, 0.0, 0.5)])
    size = (160, 90)
    bare = draw(s, views, size, Style("bare", outline=False, shadows=False, occlusion=False))
    lit = draw(s, views, size, Style("lit", outline=False, occlusion=False))
    floor = bare.ids[0] == 0
    darker = bare.color[0].astype(int).sum(-1) - lit.color[0].astype(int).sum(-1)
    shade = floor & (darker > 60)
    # away from the sun, which stands to the right of and behind the camera: to the left
    assert 30 < shade.sum() < 0.2 * floor.sum()
    person = np.argwhere(bare.ids[0] == 1).mean(axis=0)
    assert np.argwhere(shade).mean(axis=0)[1] < person[1]
    assert (darker[floor] >= -3).all()  # each channel may round another way
    inked = draw(s, views, size, Style("inked", outline=True, shadows=False, occlusion=False))
    drop = bare.color[0].astype(int).sum(-1) - inked.color[0].astype(int).sum(-1)
    inside = bare.ids[0] == 1
    rim = inside & ~(
        np.roll(inside, 1, 1) & np.roll(inside, -1, 1) & np.roll(inside, 1, 0) & np.roll(inside, -1, 0)
    )
    assert np.median((drop / bare.color[0].sum(-1))[rim]) > 0.12
    deep = inside.copy()
    for _ in range(4):
        deep = shrunk(deep)
    assert np.abs(drop[deep]).max() == 0


def test_no_shadow_acne_on_open_ground() -> None:
    light = replace(LIGHT, sun=(0.6, -0.4, 0.69282))
    s = scene(
        [box((-3, -3, -0.1), (3, 3, 0)), sphere((0, 0, 0.5), (0.5, 0.5, 0.5), (0.6, 0.6, 0.6))],
        [],
        light=light,
    )
    views = looking([(1.5, -3.0, 1.6)], [(0.0, 0.0, 0.5)])
    style = Style("smooth", outline=False, tones=0, occlusion=False)
    bare = draw(s, views, (120, 90), replace(style, shadows=False))
    lit = draw(s, views, (120, 90), style)
    # the side of the ball that faces the light stays as it was
    face = bare.ids[0] == 1
    bright = face & (bare.color[0].sum(-1) > np.quantile(bare.color[0].sum(-1)[face], 0.5))
    assert np.abs(bare.color[0].astype(int) - lit.color[0].astype(int))[bright].max() <= 2


def test_refuses_what_cannot_be_drawn() -> None:
    s, views = small(), looking(EYES, AIMS, walls=1)
    r = renderer(PLAIN)
    r.load(s)
    good = still(1)
    bad = good.copy()
    bad[0, 0, 0, 0] = np.nan
    with pytest.raises(ValueError, match="palettes"):
        r.render(bad, views, ODD)
    for name in ("position", "axes", "focal"):
        array = getattr(views.camera, name).copy()
        array.reshape(-1)[0] = np.nan
        with pytest.raises(ValueError, match=name):
            r.render(good, replace(views, camera=replace(views.camera, **{name: array})), ODD)
    with pytest.raises(ValueError, match="moment"):
        r.render(good, replace(views, moment=np.array([0, 0, 1], np.int32)), ODD)
    with pytest.raises(ValueError, match="hidden"):
        r.render(good, replace(views, hidden=np.zeros((3, 2), bool)), ODD)
    with pytest.raises(ValueError, match="size"):
        r.render(good, views, (0, 10))
    with pytest.raises(ValueError, match="weights"):
        r.load(replace(s, weights=s.weights[:-1]))
    normals = s.static.normals.copy()
    normals[0, 0] = np.nan
    with pytest.raises(ValueError, match="static"):
        r.load(replace(s, static=replace(s.static, normals=normals)))


def test_empty_scenes_and_batches() -> None:
    s = scene([], [])
    views = looking([(0.0, -2.0, 1.0)], [(0.0, 0.0, 1.0)])
    frames = draw(s, views)
    assert (frames.ids == -1).all()
    assert frames.color.min() > 100
    r = renderer(PLAIN)
    none = Views(
        replace(
            views.camera,
            position=np.zeros((0, 3), np.float32),
            axes=np.zeros((0, 3, 3), np.float32),
            focal=np.zeros(0, np.float32),
        ),
        np.zeros(0, np.int32),
        np.zeros((0, 0), np.bool_),
    )
    assert r.render(still(0), none, ODD).color.shape == (0, 33, 47, 3)


def test_importing_the_package_does_not_load_taichi() -> None:
    code = "import sys, runtime.raster, runtime.raster.renderer; assert 'taichi' not in sys.modules"
    subprocess.run([sys.executable, "-c", code], check=True)


@pytest.mark.parametrize("band", [100_000, 200])  # pixels: a view in few bands, or four rows in each
def test_both_ways_of_filling_agree(monkeypatch: pytest.MonkeyPatch, band: int) -> None:
    # the one with atomics is for GPUs; it walks the same spans
    monkeypatch.setattr("runtime.raster.visibility.BAND_PIXELS", band)
    s, views = small(), looking(EYES, AIMS, focal=24, walls=1)
    alone = draw(s, views)
    r = renderer(PLAIN)
    r.serial = False
    try:
        shared = draw(s, views)
    finally:
        r.serial = True
    np.testing.assert_array_equal(alone.ids, shared.ids)
    np.testing.assert_array_equal(alone.color, shared.color)


def test_devices_that_cannot_be_used_are_named() -> None:
    renderer(PLAIN)
    with pytest.raises(DeviceError, match="abacus"):
        Renderer("abacus")
    with pytest.raises(DeviceError, match="renders on cpu"):
        Renderer("cuda")


def test_what_moves_in_the_set_is_drawn_like_it_and_goes_with_its_wall() -> None:
    loose_scene = replace(room(), wall_count=1)
    loose = prepare(loose_scene, PLAIN)
    fitting = np.zeros(len(loose_scene.skinned.faces), np.int32)
    fitted = prepare(replace(loose_scene, fitting=fitting), PLAIN)
    assert loose.area.sum() > 0
    assert fitted.area.sum() == 0  # no contact shadow
    assert len(fitted.casters) == 0
    moving = fitted.clusters[fitted.moving_first :]
    assert (moving[:, 3] == 0).all()
    assert fitted.moving_surface == len(fitted.surface_object)
    with pytest.raises(ValueError, match="fitting"):
        prepare(replace(loose_scene, fitting=fitting[1:]), PLAIN)
