"""Clothes, hats and everything worn: every word builds, stays within its triangles and hangs right."""

from __future__ import annotations

from dataclasses import fields

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from runtime.body.anatomy import Figure
from runtime.body.build import Body, make_body
from runtime.body.pieces import PARTS
from runtime.body.proportions import make_skeleton
from runtime.body.skeleton import JOINT, PALETTE
from runtime.body.spec import (
    BACKWEAR,
    BOTTOM_KINDS,
    FACIAL_HAIR,
    HAIR_STYLES,
    HATS,
    NECKWEAR,
    OVERWEAR,
    TOP_KINDS,
    BodySpec,
)
from runtime.body.surface import Patch
from runtime.body.tailoring import blazer
from vdsl.lang.definitions.cast import CastDef
from vdsl.library import Catalog
from vdsl.stage.cast import body_spec

from .poses import posed, turn

_SEATED = {
    **{f"thigh_{s}": turn((0, 1, 0), -88.0) for s in "lr"},
    **{f"shin_{s}": turn((0, 1, 0), 88.0) for s in "lr"},
}


def _outfits() -> list[BodySpec]:
    """As few people as wear every word there is, on bodies that differ."""
    columns = {
        "top": TOP_KINDS,
        "hat": HATS,
        "hair": HAIR_STYLES,
        "bottom": BOTTOM_KINDS,
        "facial_hair": FACIAL_HAIR,
        "neck": NECKWEAR,
        "over": OVERWEAR,
        "back": BACKWEAR,
        "shoes": ("shoes", "boots"),
    }
    people = []
    for k in range(max(len(words) for words in columns.values())):
        words = {name: each[k % len(each)] for name, each in columns.items()}
        people.append(
            BodySpec(
                height=(1.2, 1.62, 1.75, 1.9)[k % 4],
                age=(7.0, 25.0, 40.0, 75.0)[k % 4],
                build=(0.1, 0.5, 0.95)[k % 3],
                femininity=(0.0, 1.0, 0.5)[(k // 2) % 3],
                belt=k % 2 == 0,
                gloves=k % 3 == 0,
                badge=k % 5 == 0,
                glasses=k % 4 == 1,
                **words,
            )
        )
    return people


OUTFITS = _outfits()


@pytest.fixture(scope="module")
def dressed() -> list[Body]:
    return [make_body(spec) for spec in OUTFITS]


def test_whatever_is_worn_is_sound(dressed: list[Body]) -> None:
    for body in dressed:
        mesh, spec = body.mesh, body.spec
        assert 5_000 <= len(mesh.faces) <= 13_500, spec  # whoever wears one of everything
        assert np.isfinite(mesh.vertices).all()
        assert np.allclose(np.linalg.norm(mesh.normals, axis=1), 1.0, atol=1e-3)
        assert np.allclose(body.weights.sum(1), 1.0, atol=1e-5)
        assert (body.weights >= 0).all()
        assert body.joints.min() >= 0
        assert body.joints.max() < len(PALETTE)
        assert mesh.parts.max() < len(PARTS)
        low, high = mesh.vertices.min(0), mesh.vertices.max(0)
        assert -0.02 < low[2] < 0.02, spec
        assert spec.height - 0.03 < high[2] < spec.height + 0.22 * spec.height, spec
        assert high[1] < 0.45 * spec.height
        assert low[1] > -0.45 * spec.height


def test_no_two_outfits_are_the_same_shape() -> None:
    plain = make_body(BodySpec())
    seen = {len(plain.mesh.vertices)}
    for name, word in (
        ("hat", "cap"),
        ("neck", "tie"),
        ("over", "apron"),
        ("back", "cape"),
        ("shoes", "boots"),
    ):
        body = make_body(BodySpec(**{name: word}))
        assert len(body.mesh.vertices) not in seen, word
        seen.add(len(body.mesh.vertices))
    belted = make_body(BodySpec(belt=True, gloves=True, badge=True)).mesh
    assert {"belt", "gloves", "badge"} <= {PARTS[p] for p in np.unique(belted.parts)}


def test_every_feature_of_a_spec_counts_in_its_key() -> None:
    assert all(f.name in BodySpec().key() for f in fields(BodySpec))


def test_hats_sit_on_the_head_and_go_with_it() -> None:
    turned = turn((0, 1, 0), 30.0)
    for word in ("police-cap", "wizard-hat", "crown", "space-helmet"):
        body = make_body(BodySpec(hat=word))
        hat = np.unique(body.mesh.faces[body.mesh.parts == PARTS.index("hat")])
        assert body.mesh.vertices[hat, 2].min() > body.skeleton.bind[JOINT["neck"], 2] - 0.05
        moved = posed(body, {"head": turned})[hat]
        pivot = body.skeleton.bind[JOINT["head"]]
        rigid = (body.mesh.vertices[hat] - pivot) @ turned.T + pivot
        assert np.abs(moved - rigid).max() < 1e-4


@pytest.mark.parametrize("word", [*HATS, "afro", "bun", "curly", "mohawk", "topknot"])
def test_the_skeleton_knows_how_high_hats_and_hair_rise(word: str) -> None:
    """Above that of somebody with short hair, to a centimetre."""
    spec = BodySpec(hat=word) if word in HATS else BodySpec(hair=word)
    body, short = make_body(spec), make_body(BodySpec(hair="short"))
    rises = body.mesh.vertices[:, 2].max() - short.mesh.vertices[:, 2].max()
    assert body.skeleton.above == pytest.approx(max(rises, 0.0), abs=0.01)


def test_under_a_hat_hair_does_not_count() -> None:
    assert make_skeleton(BodySpec(hair="afro", hat="cap")).above == make_skeleton(BodySpec(hat="cap")).above
    assert make_skeleton(BodySpec(hair="afro", hat="tiara")).above > 0.02, "on a tiara it does"


def _outside_the_back(body: Body, pose: dict[str, NDArray[np.float64]]) -> NDArray[np.float64]:
    """How far the trousers' vertices above the shirt's hem come out of its back, metres."""
    mesh = body.mesh
    after = posed(body, pose)
    shirt = np.isin(mesh.parts, [PARTS.index("top"), PARTS.index("trim")])
    faces = mesh.faces[shirt]
    corner = after[faces]
    flat = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    normals = np.zeros_like(after)
    for k in range(3):
        np.add.at(normals, faces[:, k], flat)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    used = np.unique(faces)
    back = used[(np.abs(mesh.vertices[used, 1]) < 0.12) & (mesh.vertices[used, 0] < 0.0)]
    hem = mesh.vertices[back, 2].min()
    under = np.unique(mesh.faces[mesh.parts == PARTS.index("bottom")])
    under = under[(mesh.vertices[under, 2] > hem + 0.004) & (mesh.vertices[under, 0] < -0.05)]
    _, near = cKDTree(after[used]).query(after[under])
    return np.asarray(((after[under] - after[used[near]]) * normals[used[near]]).sum(1))


@pytest.mark.parametrize("build", [0.42, 0.95])
@pytest.mark.parametrize("bottom", ["trousers", "shorts"])
def test_seated_men_keep_their_trousers_under_the_shirt(build: float, bottom: str) -> None:
    body = make_body(BodySpec(height=1.8, femininity=0.0, build=build, top="shirt", bottom=bottom))
    out = _outside_the_back(body, _SEATED)
    assert out.max(initial=-1.0) < 0.006


@pytest.mark.parametrize("top", ["gown", "robe", "kimono"])
def test_long_clothes_let_legs_step_and_sit(top: str) -> None:
    """No edge tears, and the knees stay inside."""
    body = make_body(BodySpec(top=top, femininity=1.0))
    stride = {
        "thigh_l": turn((0, 1, 0), -30.0),
        "thigh_r": turn((0, 1, 0), 20.0),
        "shin_r": turn((0, 1, 0), 20.0),
    }
    for pose, longest in ((stride, 1.0), (_SEATED, 0.45)):
        after = posed(body, pose)
        corner = after[body.mesh.faces]
        assert np.linalg.norm(corner - np.roll(corner, 1, axis=1), axis=2).max() < longest
        cloth = np.unique(body.mesh.faces[body.mesh.parts == PARTS.index("top")])
        for side in "lr":
            knee = body.skeleton.bind[JOINT[f"shin_{side}"]]
            near = np.linalg.norm(body.mesh.vertices[cloth] - knee, axis=1)
            assert near.min() > 0.03


def test_a_long_beard_rests_on_the_chest_when_the_head_nods() -> None:
    body = make_body(BodySpec(facial_hair="long-beard", femininity=0.0))
    hair = np.unique(body.mesh.faces[body.mesh.parts == PARTS.index("hair")])
    tip = hair[np.argmin(body.mesh.vertices[hair, 2])]
    moved = posed(body, {"head": turn((0, 1, 0), 25.0)})[tip] - body.mesh.vertices[tip]
    assert np.linalg.norm(moved) < 0.06


def _outermost(patch: Patch, axis: NDArray[np.float64], way: NDArray[np.float64]) -> float:
    """How far from ``axis`` [3] a level ray leaves a surface for good; −inf where it meets none."""
    a, b, c = (patch.vertices[patch.faces[:, k]] for k in range(3))
    across = np.cross(way, c - a)
    size = ((b - a) * across).sum(1)
    start = axis - a
    with np.errstate(divide="ignore", invalid="ignore"):
        u = (start * across).sum(1) / size
        turned = np.cross(start, b - a)
        v = (way * turned).sum(1) / size
        far = ((c - a) * turned).sum(1) / size
    return float(far[(u >= 0) & (v >= 0) & (u + v <= 1) & (far > 0)].max(initial=-np.inf))


@pytest.mark.parametrize("name", ["businesswoman", "businessman", "doctor", "detective", "pirate"])
def test_a_jackets_collar_lies_around_the_shirts(name: str) -> None:
    """Both went around the neck at one radius, and came through each other in tatters."""
    cast = Catalog().get("cast", name)
    assert isinstance(cast, CastDef)
    figure = Figure(body_spec(cast))
    *_, inner, roll = blazer(figure)
    met = 0
    for angle in np.linspace(0.9, 3.0, 12):
        way = np.array([np.cos(angle), np.sin(angle), 0.0])
        for up in np.linspace(1.10, 1.22, 9):
            axis = np.array([figure.joint("neck")[0], 0.0, figure.level(up)])
            inside, outside = (_outermost(piece.patch, axis, way) for piece in (inner, roll))
            if np.isfinite(inside) and np.isfinite(outside):
                met += 1
                assert outside > inside + 0.0005, (angle, up)
    assert met > 20
