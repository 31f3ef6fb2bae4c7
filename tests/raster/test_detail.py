"""Levels of detailed bodies: chosen by what a view sees, coarser ones sharing vertices, a finer one round."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from raster_scenes import box, join, looking, scene, sphere, still

from runtime.body.build import make_body
from runtime.body.skeleton import PALETTE
from runtime.raster.detail import COUNT, FINEST, LEVELS, OWN, with_levels
from runtime.raster.finer import Skin, finer
from runtime.raster.renderer import Renderer
from runtime.raster.types import LOOSE, RenderScene
from runtime.raster.views import pack_views
from vdsl.lang.definitions.cast import CastDef
from vdsl.library import Catalog
from vdsl.stage.cast import body_spec


def body() -> RenderScene:
    """A detailed body of two shells, one of them small, on a floor; it is the first person."""
    person = join(
        [
            sphere((0, 0, 1.2), (0.3, 0.25, 0.5), (0.8, 0.2, 0.2), 1, 40),
            sphere((0.3, 0, 1.3), (0.03, 0.03, 0.03), (0.1, 0.1, 0.1), 2, 6),
        ]
    )
    made = scene([box((-9, -9, -0.1), (9, 9, 0), (0.7, 0.7, 0.7))], [person])
    fitting = np.full(len(made.skinned.faces), LOOSE - 1, np.int32)
    return RenderScene(**{**vars(made), "fitting": fitting})


def levels_at(*distances: float, size: tuple[int, int] = (224, 224), sensor: float = 36.0) -> list[int]:
    views = looking(
        [(d, 0.0, 1.2) for d in distances], [(0.0, 0.0, 1.2)] * len(distances), sensor=(sensor, sensor)
    )
    packed = pack_views(views.camera, len(distances), *size)
    return with_levels(body()).chosen(still(1), views.moment, packed)[:, 0].tolist()


def test_levels_share_vertices_and_keep_small_shells() -> None:
    plain = body()
    made = with_levels(plain)
    assert made.vertices == len(plain.skinned.vertices)
    assert (made.scene.skinned.vertices[: made.vertices] == plain.skinned.vertices).all()
    assert made.scene.skinned.faces[made.level != FINEST].max() < made.vertices
    finest = len(plain.skinned.faces)
    small = int((plain.skinned.parts == 2).sum())
    for level, (share, _) in enumerate(LEVELS, start=OWN + 1):
        chosen = made.level == level
        big = chosen & (made.scene.skinned.parts == 1)
        assert abs(big.sum() / (finest - small) - share) < 0.05
        assert (chosen & (made.scene.skinned.parts == 2)).sum() == small
        corners = plain.skinned.vertices[made.scene.skinned.faces[big]] - np.array([0, 0, 1.2])
        radius = np.linalg.norm(corners / np.array([0.3, 0.25, 0.5]), axis=-1)
        np.testing.assert_allclose(radius, 1, atol=1e-4)  # on the surface, and of the right shell
    assert made.person.tolist() == [0]
    assert made.scene.joints.max() == plain.joints.max()  # or a palette would be read beyond its end


def test_stripes_stay_stripes_at_coarser_levels() -> None:
    """A ball in four colours by its height: of each, as much is seen at every level, at the same heights."""
    ball = sphere((0, 0, 0), (0.5, 0.5, 0.5), (0.8, 0.2, 0.2), 1, 48)
    middle = ball.vertices[ball.faces].mean(axis=1)
    colors = ball.colors.copy()
    for low, colour in ((-0.3, (0.1, 0.2, 0.9)), (0.02, (0.9, 0.9, 0.9)), (0.1, (0.1, 0.6, 0.1))):
        colors[middle[:, 2] > low] = colour
    made = scene([box((-9, -9, -1), (9, 9, -0.6), (0.7, 0.7, 0.7))], [replace(ball, colors=colors)])
    found = with_levels(
        RenderScene(**{**vars(made), "fitting": np.full(len(ball.faces), LOOSE - 1, np.int32)})
    )
    mesh = found.scene.skinned
    corners = mesh.vertices[mesh.faces].astype(float)
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    for colour in np.unique(colors, axis=0):
        own = (mesh.colors == colour).all(axis=1)
        fine = own & (found.level == OWN)
        for level in range(OWN + 1, COUNT):
            coarse = own & (found.level == level)
            assert area[coarse].sum() == pytest.approx(area[fine].sum(), rel=0.18)
            for end in (np.min, np.max):
                assert end(corners[coarse][..., 2]) == pytest.approx(end(corners[fine][..., 2]), abs=0.03)


def test_farther_is_coarser_and_close_is_finest() -> None:
    chosen = levels_at(1.0, 1.3, 1.7, 3.0, 6.0, 20.0)
    assert chosen[0] == FINEST
    assert OWN in chosen
    assert chosen[-1] == COUNT - 1
    assert chosen == sorted(chosen)


def test_a_small_picture_is_content_with_a_coarser_body() -> None:
    """As many pixels a metre, on a small sensor's small picture and on a large one's large picture."""
    small = levels_at(1.2, 1.5, 1.8, 3.0, size=(200, 200), sensor=10.0)
    large = levels_at(1.2, 1.5, 1.8, 3.0, size=(600, 600), sensor=30.0)
    assert all(a >= b for a, b in zip(small, large, strict=True))
    assert small != large


def test_the_middle_follows_the_palette() -> None:
    made = with_levels(body())
    moved = still(1)
    moved[:, :, 0, 3] = 5.0
    views = looking([(6.5, 0, 1.2)], [(5.0, 0, 1.2)])
    packed = pack_views(views.camera, 1, 224, 224)
    near = made.chosen(moved, views.moment, packed)
    far = made.chosen(still(1), views.moment, packed)
    assert near[0, 0] < far[0, 0]


def test_a_coarser_level_covers_the_same_pixels(monkeypatch: pytest.MonkeyPatch) -> None:
    content, size = body(), (224, 224)
    views = looking([(7.0, 0.4, 1.3)], [(0.0, 0.0, 1.2)], sensor=(36.0, 36.0))
    coarse = Renderer("cpu")
    coarse.load(content)
    a = coarse.render(still(1), views, size, ids=True)
    monkeypatch.setattr("runtime.raster.detail.IN_SMALL", (1400.0, 0.0, 0.0))
    finest = Renderer("cpu")
    finest.load(content)
    b = finest.render(still(1), views, size, ids=True)
    assert a.ids is not None
    assert b.ids is not None
    covered = (b.ids == 1).sum()
    assert covered > 300
    assert (a.color != b.color).sum() > 0
    assert (a.ids != b.ids).sum() < 0.02 * covered


def test_a_person_left_out_is_left_out_at_every_level() -> None:
    drawer = Renderer("cpu")
    drawer.load(body())
    views = looking([(1.0, 0, 1.2), (3.0, 0, 1.2), (9.0, 0, 1.2)], [(0.0, 0.0, 1.2)] * 3, walls=1)
    seen = drawer.render(still(1), views, (96, 96), ids=True).ids
    views.hidden[:] = True
    gone = drawer.render(still(1), views, (96, 96), ids=True).ids
    assert seen is not None
    assert gone is not None
    assert (seen == 1).any(axis=(1, 2)).all()
    assert not (gone == 1).any()


def ball(rings: int) -> tuple[Skin, np.ndarray]:
    """A unit ball, blended between two joints from left to right."""
    made = sphere((0, 0, 0), (1, 1, 1), (1, 1, 1), 0, rings)
    share = made.vertices[:, :1] / 2 + 0.5
    weights = np.concatenate([share, 1 - share, 0 * share, 0 * share], axis=1).astype(np.float32)
    joints = np.tile(np.array([3, 1, 0, 0], np.int32), (len(share), 1))
    return Skin(made.vertices, made.normals, joints, weights), made.faces.astype(np.int64)


def edges(skin: Skin, faces: np.ndarray) -> list[bytes]:
    """Every directed edge by its places, as bytes."""
    corners = skin.place[faces]
    pairs = np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]])
    return [pair.tobytes() for pair in pairs]


def test_the_finer_level_is_rounder_and_closed() -> None:
    skin, faces = ball(10)
    made, cut, source = finer(skin, faces)
    assert len(cut) > 3 * len(faces)
    middles = np.linalg.norm(made.place[cut].mean(axis=1), axis=-1)
    coarse = np.linalg.norm(skin.place[faces].mean(axis=1), axis=-1)
    assert (1 - middles).max() < (1 - coarse).max() / 5
    there = set(edges(made, cut))
    corners = made.place[cut]
    back = np.concatenate([corners[:, [1, 0]], corners[:, [2, 1]], corners[:, [0, 2]]])
    real = np.any(back[:, 0] != back[:, 1], axis=-1)
    assert all(pair.tobytes() in there for pair in back[real])  # every edge has its neighbour
    assert np.abs((made.normal * made.place).sum(-1) - 1).max() < 0.01
    # weights go on between those of the ends, and stay whole
    np.testing.assert_allclose(made.weights.sum(-1), 1, atol=1e-5)
    right = (made.weights * (made.joints == 3)).sum(-1)
    np.testing.assert_allclose(right, made.place[:, 0] / 2 + 0.5, atol=0.08)
    assert source.max() < len(faces)


def test_flat_faces_are_not_cut() -> None:
    flat = box((-1, -1, -1), (1, 1, 1), (1, 1, 1))
    joints, weights = (
        np.zeros((len(flat.vertices), 4), np.int32),
        np.zeros((len(flat.vertices), 4), np.float32),
    )
    weights[:, 0] = 1
    made, cut, _ = finer(Skin(flat.vertices, flat.normals, joints, weights), flat.faces.astype(np.int64))
    assert len(cut) == len(flat.faces)
    assert len(made.place) == len(flat.vertices)


def test_the_levels_of_a_take_are_what_its_nearest_view_takes() -> None:
    drawer, size = Renderer("cpu"), (224, 224)
    drawer.load(body())
    views = looking([(6.0, 0, 1.2), (1.5, 0, 1.2), (2.2, 0, 1.2)], [(0.0, 0.0, 1.2)] * 3)
    own = drawer.levels(still(1), views, size)
    assert own[0, 0] > own[2, 0] > own[1, 0]
    free = drawer.render(still(1), views, size).color
    finest = np.repeat(own.min(axis=0, keepdims=True), 3, axis=0)
    steady = drawer.render(still(1), replace(views, detail=finest), size).color
    assert (free[1] == steady[1]).all()
    assert (free[0] != steady[0]).any()
    first = looking([(6.0, 0, 1.2)], [(0.0, 0.0, 1.2)])
    alone = drawer.render(still(1), replace(first, detail=finest[:1]), size).color
    assert (alone[0] == steady[0]).all()
    for wrong in (finest[:2], finest + COUNT):
        with pytest.raises(ValueError, match=r"Views\.detail"):
            drawer.render(still(1), replace(views, detail=wrong), size)


@pytest.mark.parametrize("name", ["man", "waiter", "soldier", "toddler"])
def test_no_coarser_level_spans_from_leg_to_leg(name: str) -> None:
    """The insides of two legs lie within each other while they are lifted: faces took corners of both, and a
    web hung between the knees of whoever walked some metres away."""
    cast = Catalog().get("cast", name)
    assert isinstance(cast, CastDef)
    made = make_body(body_spec(cast))
    faces = len(made.mesh.faces)
    plain = scene([box((-9, -9, -0.1), (9, 9, 0), (0.7, 0.7, 0.7))], [])
    whole = replace(
        plain,
        skinned=made.mesh,
        skinned_object=np.full(faces, 5, np.int32),
        joints=made.joints,
        weights=made.weights,
        fitting=np.full(faces, LOOSE - 1, np.int32),
    )
    found = with_levels(whole)
    of = np.zeros((len(made.weights), len(PALETTE)))
    np.add.at(of, (np.arange(len(of))[:, None], made.joints), made.weights)
    left, right = (of[:, [PALETTE.index(f"{n}_{s}") for n in ("shin", "foot", "toe")]].sum(1) for s in "lr")
    coarser = (found.level > OWN) & (found.body >= 0)
    corners = found.scene.skinned.faces[coarser]
    assert not ((left[corners].max(1) > 0.5) & (right[corners].max(1) > 0.5)).any()
