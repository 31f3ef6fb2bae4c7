"""Shapes: closed, the right way out, of the right volume, crisp where they turn sharply."""

from __future__ import annotations

import math
from collections import Counter

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from runtime import shapes
from runtime.mesh import Mesh

SHAPES = {
    "box": (shapes.box((1, 2, 3)), 6.0),
    "narrowly bevelled box": (shapes.box((1, 2, 3), 0.01), 6.0),
    "bevelled box": (shapes.box((1, 2, 3), 0.1), 5.88),
    "soft box": (shapes.box((1, 2, 3), 0.3, 4), 5.55),
    "cylinder": (shapes.cylinder(0.5, 2.0), math.pi * 0.25 * 2),
    "soft cylinder": (shapes.cylinder(0.5, 2.0, 0.05), math.pi * 0.25 * 2),
    "cone": (shapes.cone(0.5, 0.0, 3.0), math.pi * 0.25),
    "stump": (shapes.cone(1.0, 0.5, 1.0), math.pi * (1 + 0.5 + 0.25) / 3),
    "ball": (shapes.sphere(0.5), 4 / 3 * math.pi * 0.125),
    "ellipsoid": (shapes.sphere((1.0, 0.5, 0.25)), 4 / 3 * math.pi * 0.125),
    "lumpy": (shapes.sphere(0.5, 0.2), 4 / 3 * math.pi * 0.125),
    "cup": (shapes.lathe(((0, 0), (0.5, 0), (0.5, 1), (0.4, 1), (0.4, 0.1), (0, 0.1))), 0.785 - 0.452),
    "ring": (shapes.lathe(((1, 0), (1.2, 0), (1.2, 0.2), (1, 0.2), (1, 0))), math.pi * 0.44 * 0.2),
    "angle": (shapes.extrude(((0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)), 1.0), 3.0),
    "tube": (shapes.tube(((0, 0, 0), (0, 0, 1), (1, 0, 1)), 0.1), math.pi * 0.01 * 2),
}  # fmt: skip


def loose_edges(mesh: Mesh) -> int:
    """Edges that do not have exactly one partner running the other way (vertices joined by place)."""
    _, place = np.unique(np.round(mesh.vertices, 5), axis=0, return_inverse=True)
    faces = place.reshape(-1)[mesh.faces]
    directed = Counter((int(f[k]), int(f[(k + 1) % 3])) for f in faces for k in range(3))
    return sum(1 for (a, b), count in directed.items() if directed[b, a] != count)


def flat_normals(mesh: Mesh) -> np.ndarray:
    corners = mesh.vertices[mesh.faces].astype(float)
    return np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])


@pytest.mark.parametrize("name", SHAPES)
def test_closed_and_the_right_way_out(name: str) -> None:
    mesh, volume = SHAPES[name]
    assert loose_edges(mesh) == 0
    assert shapes.volume(mesh) == pytest.approx(volume, rel=0.1)
    assert np.allclose(np.linalg.norm(mesh.normals, axis=1), 1, atol=1e-4)
    flat = flat_normals(mesh)
    assert (np.linalg.norm(flat, axis=1) > 1e-10).all(), "a face of no area"
    for k in range(3):  # no vertex normal looks into the shape
        assert (np.einsum("fi,fi->f", flat, mesh.normals[mesh.faces[:, k]]) > 0).all()


def test_loose_edges_are_seen() -> None:
    mesh, _ = SHAPES["box"]
    open_box = Mesh(
        mesh.vertices, mesh.faces[1:], mesh.normals, mesh.colors[1:], mesh.parts[1:], mesh.materials[1:]
    )
    assert loose_edges(open_box) == 3


def test_profile_may_run_either_way() -> None:
    profile = ((0, 0), (0.5, 0), (0.3, 1), (0, 1))
    up, down = shapes.lathe(profile), shapes.lathe(profile[::-1])
    assert shapes.volume(up) == pytest.approx(shapes.volume(down), rel=1e-6)
    assert shapes.volume(up) > 0


def test_outline_may_run_either_way() -> None:
    outline = ((0, 0), (2, 0), (2, 1), (0, 1))
    assert shapes.volume(shapes.extrude(outline[::-1], 0.5)) == pytest.approx(1.0, rel=1e-6)


def test_edges_of_a_box_are_crisp_and_a_cylinder_is_smooth() -> None:
    box = shapes.box((1, 1, 1))
    assert np.allclose(np.sort(np.abs(box.normals), axis=1), (0, 0, 1))
    cylinder = shapes.cylinder(0.5, 1.0, segments=16)
    side = np.abs(cylinder.normals[:, 2]) < 0.5
    radial = cylinder.vertices[side] * (1, 1, 0)
    assert np.allclose(cylinder.normals[side], radial / 0.5, atol=1e-5)


def test_rounding_is_kept_within_the_box() -> None:
    mesh = shapes.box((0.1, 1.0, 1.0), 0.4, 3)
    assert shapes.volume(mesh) > 0
    assert mesh.vertices.min(0) == pytest.approx([-0.05, -0.5, 0.0], abs=1e-6)
    assert mesh.vertices.max(0) == pytest.approx([0.05, 0.5, 1.0], abs=1e-6)


sizes = st.floats(0.005, 5.0)


@settings(max_examples=40, deadline=None, derandomize=True)
@given(sizes, sizes, sizes, st.floats(0.0, 1.0), st.integers(1, 4))
def test_any_box_is_closed(x: float, y: float, z: float, rounding: float, steps: int) -> None:
    mesh = shapes.box((x, y, z), rounding, steps)
    assert 0 < shapes.volume(mesh) <= x * y * z * 1.0001


@settings(max_examples=40, deadline=None, derandomize=True)
@given(st.lists(st.tuples(st.floats(0.02, 2), st.floats(0, 2 * math.pi)), min_size=3, max_size=9))
def test_any_star_can_be_extruded(rays: list[tuple[float, float]]) -> None:
    """A star-shaped polygon: its triangles add up to its area, whatever its corners."""
    count = len(rays)
    outline = [
        (r * math.cos(2 * math.pi * i / count), r * math.sin(2 * math.pi * i / count))
        for i, (r, _) in enumerate(rays)
    ]
    x, y = np.array(outline).T
    area = 0.5 * abs(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))
    assert shapes.volume(shapes.extrude(outline, 2.0)) == pytest.approx(2 * area, rel=1e-3)


def normals_of_faces(rounding: float) -> tuple[np.ndarray, np.ndarray]:
    """Normals at the corners of all faces of a box [F, 3, 3], and those of its flat sides alone."""
    mesh = shapes.box((0.6, 0.4, 0.02 + 2 * rounding), rounding)
    corners = mesh.normals[mesh.faces]
    return corners, corners[:12]


def test_narrow_bevels_are_lit_as_one_side_and_wide_ones_look_round() -> None:
    for rounding in (0.002, 0.01, 0.02):
        corners, sides = normals_of_faces(rounding)
        assert len(corners) == 44
        assert (corners == corners[:, :1]).all(), "a bevel's light differs from that of both sides"
        assert {tuple(n) for n in corners[:, 0]} == {tuple(n) for n in sides[:, 0]}
    corners, _ = normals_of_faces(0.03)
    assert (corners != corners[:, :1]).any(axis=(1, 2)).sum() == 32


def test_a_side_beside_a_narrow_rounding_stays_straight() -> None:
    """Tones on the side of a jar are upright bands, not wedges."""
    for mesh, up in (
        (shapes.cylinder(0.05, 0.12, rounding=0.01, segments=18), 2),
        (shapes.extrude([(0, 0), (0.2, 0), (0.208, 0.004), (0.208, 0.2), (0, 0.2)], 0.1, crease=1.2), 0),
    ):
        corners = mesh.vertices[mesh.faces]
        long = np.ptp(corners[..., up], axis=1) > 0.08
        walls = long & (np.abs(mesh.normals[mesh.faces][..., up]).max(axis=1) < 0.5)
        assert walls.any()
        assert np.abs(mesh.normals[mesh.faces][walls][..., up]).max() < 0.1


@pytest.mark.parametrize(
    "path",
    [
        ((-0.1, 0, 0), (-0.1, 0, 0.4), (0.1, 0, 0.4), (0.1, 0, 0)),  # a handle
        ((0, 0, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1), (0, 1, 0)),
        ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0.1, 0)),
    ],
)
def test_a_tube_is_as_thick_after_its_bends(path: tuple[tuple[float, float, float], ...]) -> None:
    mesh = shapes.tube(path, 0.01, 12)
    length = float(np.linalg.norm(np.diff(np.array(path), axis=0), axis=1).sum())
    across = 12 / 2 * np.sin(2 * np.pi / 12) * 0.01**2
    assert shapes.volume(mesh) == pytest.approx(length * across, rel=0.01)
    np.testing.assert_allclose(np.linalg.norm(mesh.normals, axis=1), 1, atol=1e-5)
