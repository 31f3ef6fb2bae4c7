"""Faces: what is seen of eyes, jaw and nose, and that nothing comes through the skin from behind it."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from runtime.body.anatomy import Figure
from runtime.body.build import Body, make_body
from runtime.body.features import MOUTH, lip_colour
from runtime.body.head import Head, eye_lines
from runtime.body.pieces import PARTS
from runtime.body.spec import BodySpec
from runtime.materials import SKIN_SHADE
from vdsl.lang.definitions.cast import CastDef
from vdsl.library import Catalog
from vdsl.stage.cast import body_spec

from .poses import posed, turn

CATALOG = Catalog()
NAMES = CATALOG.names("cast")
#: Places in a triangle, off its edges.
WITHIN = np.array([[6, 3, 1], [1, 6, 3], [3, 1, 6], [6, 1, 3], [3, 6, 1], [1, 3, 6]]) / 10


def spec_of(name: str) -> BodySpec:
    cast = CATALOG.get("cast", name)
    assert isinstance(cast, CastDef)
    return body_spec(cast)


def skin_like(body: Body, factor: float) -> NDArray[np.bool_]:
    """Faces whose colour is the skin's by about ``factor``."""
    return np.abs(body.mesh.colors / np.array(body.spec.skin) - factor).max(1) < 0.08


def foremost(triangles: NDArray[np.float64], spot: NDArray[np.float64]) -> float:
    """How far ahead (X) triangles [N, 3, 3] are at a point's place as seen from the front."""
    flat = triangles[..., 1:] - spot[1:]
    following = np.roll(flat, -1, axis=1)
    turns = flat[..., 0] * following[..., 1] - flat[..., 1] * following[..., 0]
    around = (turns > 0).all(1) | (turns < 0).all(1)
    shares = np.roll(turns, -1, axis=1)[around]
    ahead = (triangles[around][..., 0] * shares).sum(1) / shares.sum(1)
    return float(ahead.max(initial=-np.inf))


@pytest.mark.parametrize("name", NAMES)
def test_eyes_are_open(name: str) -> None:
    """An opening is smaller than the triangles it is cut out of: nearly half of the cast had skin over a
    fifth of it or more."""
    body = make_body(spec_of(name))
    head = Head(Figure(body.spec))
    corners = head.units(body.mesh.vertices.astype(float))[body.mesh.faces]
    near = np.linalg.norm(corners.mean(1) - head.eye, axis=1) < 0.3
    skin = corners[near & (body.mesh.parts == PARTS.index("skin"))]
    ball = corners[near & (body.mesh.parts == PARTS.index("eye"))]
    _, ey, ez = head.eye
    y, z = np.meshgrid(np.linspace(ey - 0.09, ey + 0.09, 19), np.linspace(ez - 0.05, ez + 0.05, 11))
    spots = np.stack([np.full(y.size, 0.3), y.ravel() + 1e-5, z.ravel() + 1e-5], 1)
    inside = np.maximum.reduce([line(spots) for line in eye_lines(head)]) < -0.006
    covered = [foremost(skin, spot) > foremost(ball, spot) for spot in spots[inside]]
    assert len(covered) > 50
    assert np.mean(covered) < 0.2


@pytest.mark.parametrize("name", ["woman", "man", "girl", "old_man"])
def test_a_head_stands_out_from_its_neck(name: str) -> None:
    """Skin that never sees the light is darker: under the jaw, and under the nose."""
    body = make_body(spec_of(name))
    head = Head(Figure(body.spec))
    middle = head.units(body.mesh.vertices[body.mesh.faces].mean(1).astype(float))
    dark = skin_like(body, 0.78) & (np.abs(middle[:, 1]) < 0.15)
    ahead = dark & (middle[:, 0] > 0.1)
    assert (ahead & (middle[:, 2] > -0.25) & (middle[:, 2] < 0.05)).sum() > 20, "under the jaw"
    assert (ahead & (middle[:, 2] > 0.26) & (middle[:, 2] < 0.34)).sum() > 4, "under the nose"
    assert (body.mesh.materials[ahead] == SKIN_SHADE).all(), "told apart on paper"
    cheeks = (middle[:, 2] > 0.08) & (middle[:, 2] < 0.18) & (middle[:, 0] > 0.1)
    assert not (dark & cheeks).any()


@pytest.mark.parametrize(
    ("name", "degrees"), [("woman", 4.0), ("woman", 8.0), ("girl", 8.0), ("old_man", 12.0)]
)
def test_nothing_of_the_mouth_comes_through_below_the_lips(name: str, degrees: float) -> None:
    body = make_body(spec_of(name))
    corners = posed(body, {"jaw": turn((0.0, 1.0, 0.0), degrees)})[body.mesh.faces]
    dark = np.abs(body.mesh.colors - MOUTH).max(1) < 0.01
    lips = corners[np.abs(body.mesh.colors - lip_colour(Figure(body.spec))).max(1) < 0.01]
    spots = (WITHIN @ corners[dark]).reshape(-1, 3)
    assert len(spots)
    for spot in spots:
        lip = lips[np.abs(lips[..., 1] - spot[1]).min(1) < 0.006]
        if len(lip) and spot[2] < lip[..., 2].min():
            assert foremost(corners[~dark], spot) > spot[0], np.round(spot, 3)
