"""Guides: who is where in a picture and how near, cell by cell, against the picture's own ids and depths."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from numpy.typing import NDArray
from raster_scenes import LIGHT, box, looking, room, scene, sphere, still

from runtime.raster.renderer import Renderer
from runtime.raster.types import (
    FAR,
    GUIDE_SIDE,
    GUIDES,
    NEAREST,
    OTHERS,
    STYLES,
    SUBJECT,
    Frames,
    RenderScene,
)

PERSON, OTHER = 11, 12  # objects of the room


def cells(mask: NDArray[np.bool_] | NDArray[np.floating]) -> NDArray[np.float64]:
    """The mean of [H, W] in every cell."""
    height, width = mask.shape
    rows, columns = (np.arange(GUIDE_SIDE + 1) * n // GUIDE_SIDE for n in (height, width))
    return np.array([[mask[a:b, c:d].mean() for c, d in pairwise(columns)] for a, b in pairwise(rows)])


def drawn(
    content: RenderScene, size: tuple[int, int], style: str = "board", roles: dict[int, int] | None = None
) -> Frames:
    drawer = Renderer("cpu", STYLES[style])
    drawer.load(content)
    views = looking([(2.6, -1.8, 1.5), (2.6, -1.8, 1.5), (0.5, 0.2, 1.6)], [(2.0, 1.8, 1.0)] * 3)
    table = np.zeros((3, 13), np.uint8)
    for thing, role in (roles or {PERSON: SUBJECT, OTHER: OTHERS}).items():
        table[:, thing] = role
    return drawer.render(still(2), views, size, ids=True, depth=True, roles=table)


@pytest.mark.parametrize(
    ("style", "size"),
    [("board", (224, 224)), ("board", (20, 15)), *((style, (97, 61)) for style in STYLES)],
)
def test_guides_are_shares_of_what_the_ids_show(style: str, size: tuple[int, int]) -> None:
    frames = drawn(room(), size, style)
    assert frames.guides is not None
    assert frames.ids is not None
    assert frames.depth is not None
    if min(size) < GUIDE_SIDE:  # more cells than pixels: some have none
        assert frames.guides[..., 0].max() == 255
        return
    for guides, ids, depth in zip(frames.guides, frames.ids, frames.depth, strict=True):
        told = dict(zip(GUIDES, np.moveaxis(guides, -1, 0).astype(float), strict=True))
        for name, mask in (("subject", ids == PERSON), ("others", ids == OTHER), ("nothing", ids < 0)):
            np.testing.assert_allclose(told[name] / 255, cells(mask), atol=0.003, err_msg=name)
        near = cells(np.where(np.isfinite(depth), 1 / depth, 0.0))
        code = 255 - 254 * np.log(np.clip(1 / np.maximum(near, 1e-9), NEAREST, FAR) / NEAREST) / np.log(
            FAR / NEAREST
        )
        np.testing.assert_allclose(told["nearness"], np.where(near > 0, code, 0), atol=0.51)
    assert (frames.guides[..., 0].max((1, 2)) == 255).all()


@pytest.mark.parametrize("size", [(224, 224), (97, 61)])
def test_pixels_show_what_ids_and_depths_say(size: tuple[int, int]) -> None:
    drawer = Renderer("cpu", STYLES["board"])
    drawer.load(room())
    views = looking([(2.6, -1.8, 1.5), (2.6, -1.8, 1.5), (0.5, 0.2, 1.6)], [(2.0, 1.8, 1.0)] * 3)
    roles = np.zeros((3, 13), np.uint8)
    roles[:, PERSON], roles[1, OTHER] = SUBJECT, OTHERS
    pixels = np.random.default_rng(0).integers(-1, size[0] * size[1], (3, 400)).astype(np.int32)
    pixels[:, :20] = -1
    asked = {"ids": True, "depth": True, "roles": roles}
    frames = drawer.render(still(2), views, size, pixels=pixels, **asked)
    assert frames.probed is not None
    assert frames.ids is not None
    assert frames.depth is not None
    at = np.maximum(pixels, 0)
    far, ids = (np.take_along_axis(a.reshape(3, -1), at, 1) for a in (frames.depth, frames.ids))
    shown = (pixels >= 0) & (ids >= 0)
    near = np.where(shown, 1 / np.where(shown, far, 1.0), 0.0)
    np.testing.assert_allclose(frames.probed.near, near, rtol=1e-5)
    role = np.where(shown, np.take_along_axis(roles, np.maximum(ids, 0), 1), 0)
    np.testing.assert_array_equal(frames.probed.role, role)
    assert {int(r) for r in np.unique(role)} == {0, SUBJECT, OTHERS}
    bare = drawer.render(still(2), views, size, pixels=pixels, roles=roles, pictures=False).probed
    assert bare is not None
    np.testing.assert_array_equal(bare.near, frames.probed.near)
    with pytest.raises(ValueError, match="no roles are given"):
        drawer.render(still(2), views, size, pixels=pixels)
    for wrong in (pixels[:2], pixels.astype(np.int64), pixels + size[0] * size[1]):
        with pytest.raises(ValueError, match="pixels"):
            drawer.render(still(2), views, size, pixels=wrong, **asked)


def test_a_head_and_its_front_are_told_apart() -> None:
    head = sphere((0.0, 0.0, 1.5), (0.2, 0.2, 0.2), (0.9, 0.7, 0.6), 0, 24)
    body = sphere((0.0, 0.0, 0.8), (0.3, 0.3, 0.5), (0.2, 0.3, 0.6), 1, 24)
    content = scene([box((-3, -3, -0.1), (3, 3, 0))], [head, body])
    content = replace(content, skinned_object=np.ones_like(content.skinned_object), heads=(0,), light=LIGHT)
    drawer = Renderer("cpu", STYLES["board"])
    drawer.load(content)
    eyes = [(3.0, 0.0, 1.2), (-3.0, 0.0, 1.2), (0.0, -3.0, 1.2)]  # before it, behind it, beside it
    roles = np.tile(np.array([0, SUBJECT], np.uint8), (3, 1))
    frames = drawer.render(still(2), looking(eyes, [(0.0, 0.0, 1.0)] * 3), (96, 96), roles=roles)
    assert frames.guides is not None
    subject, top, face = (frames.guides[..., k].astype(float).sum((1, 2)) for k in range(3))
    assert ((subject > 1.5 * top) & (top > 0)).all()
    assert face[0] > 0.8 * top[0]
    assert face[1] == 0
    assert 0.15 < face[2] / top[2] < 0.6
    assert frames.guides[2, ..., 2].nonzero()[1].mean() > GUIDE_SIDE / 2  # to the right: X is there


def test_a_batch_tells_what_its_views_tell_one_by_one_and_who_is_meant_may_differ() -> None:
    drawer = Renderer("cpu", STYLES["board"])
    drawer.load(room())
    views = looking([(2.6, -1.8, 1.5), (0.5, 0.2, 1.6)], [(2.0, 1.8, 1.0)] * 2)
    roles = np.zeros((2, 13), np.uint8)
    roles[0, PERSON], roles[1, OTHER] = SUBJECT, SUBJECT
    both = drawer.render(still(2), views, (96, 54), roles=roles).guides
    assert both is not None
    for k in range(2):
        camera = views.camera
        one = replace(
            views,
            camera=replace(
                camera,
                position=camera.position[k : k + 1],
                axes=camera.axes[k : k + 1],
                focal=camera.focal[k : k + 1],
            ),
            moment=views.moment[k : k + 1],
            hidden=views.hidden[k : k + 1],
        )
        alone = drawer.render(still(2), one, (96, 54), roles=roles[k : k + 1]).guides
        assert alone is not None
        np.testing.assert_array_equal(alone[0], both[k])
    assert (both[0, ..., 0] != both[1, ..., 0]).any()


def test_a_reused_set_gives_the_same_guides() -> None:
    """A camera that stands still is drawn over its empty set."""
    drawer = Renderer("cpu", STYLES["board"])
    drawer.load(room())
    roles = np.zeros((6, 13), np.uint8)
    roles[:, PERSON] = SUBJECT
    palettes = still(2, 6)
    palettes[:, :, 0, 3] = np.linspace(0, 0.5, 6)[:, None]
    views = looking([(2.6, -1.8, 1.5)] * 6, [(2.0, 1.8, 1.0)] * 6, moments=list(range(6)))
    reused = drawer.render(palettes, views, (96, 96), roles=roles).guides
    assert reused is not None
    for k in range(6):
        once = looking([(2.6, -1.8, 1.5)], [(2.0, 1.8, 1.0)], moments=[k])
        alone = drawer.render(palettes, once, (96, 96), roles=roles[:1]).guides
        assert alone is not None
        np.testing.assert_array_equal(alone[0], reused[k])


def test_roles_that_do_not_fit_are_told() -> None:
    drawer = Renderer("cpu", STYLES["board"])
    drawer.load(room())
    views = looking([(2.6, -1.8, 1.5)], [(2.0, 1.8, 1.0)])
    for wrong in (np.zeros((1, 5), np.uint8), np.zeros((2, 13), np.uint8), np.zeros((1, 13))):
        with pytest.raises(ValueError, match="roles: expected uint8"):
            drawer.render(still(2), views, (32, 32), roles=wrong)


@pytest.mark.parametrize("style", ["board", "plain"])
def test_what_is_not_shaded_shows_the_same(style: str) -> None:
    drawer = Renderer("cpu", STYLES[style])
    drawer.load(room())
    views = looking(
        [(2.6, -1.8, 1.5)] * 4 + [(0.5, 0.2, 1.6)], [(2.0, 1.8, 1.0)] * 5, moments=[0, 1, 2, 3, 0]
    )
    palettes, roles = still(2, 4), np.zeros((5, 13), np.uint8)
    palettes[:, :, 0, 3] = np.linspace(0, 0.5, 4)[:, None]
    roles[:, PERSON] = SUBJECT
    whole, bare = (
        drawer.render(palettes, views, (96, 54), ids=True, depth=True, roles=roles, pictures=pictures)
        for pictures in (True, False)
    )
    assert bare.color.shape == (5, 0, 0, 3)
    for name in ("ids", "depth", "guides"):
        np.testing.assert_array_equal(getattr(bare, name), getattr(whole, name), err_msg=name)
