"""People: their meshes, weights, bends, faces and the cache they are kept in."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from runtime.body import build
from runtime.body.anatomy import ARM_FRAME, Figure
from runtime.body.build import Body, build_body, make_body
from runtime.body.field import monotone
from runtime.body.pieces import PARTS
from runtime.body.proportions import make_skeleton, proportions
from runtime.body.skeleton import JOINT, JOINTS, PALETTE, forward_kinematics, skinning_matrices
from runtime.body.spec import BodySpec
from runtime.body.weights import body_weights, cape_weights

from .poses import elbow, posed, turn

SPECS = {
    "woman": BodySpec(height=1.66, femininity=1.0, hair="bob"),
    "man": BodySpec(height=1.80, femininity=0.0, build=0.9, hair="short", top="shirt", facial_hair="beard"),
    "child": BodySpec(height=1.2, femininity=1.0, age=7.0, hair="ponytail", top="dress", glasses=True),
    "elder": BodySpec(height=1.7, femininity=0.0, age=78.0, hair="tonsure", top="blazer", bottom="shorts"),
}


@pytest.fixture(scope="module", params=sorted(SPECS))
def body(request: pytest.FixtureRequest) -> Body:
    return make_body(SPECS[request.param])


@pytest.fixture(scope="module")
def woman() -> Body:
    return make_body(SPECS["woman"])


@pytest.fixture(scope="module")
def man() -> Body:
    return make_body(SPECS["man"])


def part(body: Body, name: str) -> NDArray[np.bool_]:
    return body.mesh.parts == PARTS.index(name)


def test_a_body_is_sound(body: Body) -> None:
    mesh = body.mesh
    assert 5_000 <= len(mesh.faces) <= 14_000
    assert np.isfinite(mesh.normals).all()
    assert np.allclose(np.linalg.norm(mesh.normals, axis=1), 1.0, atol=1e-4)
    assert np.allclose(body.weights.sum(1), 1.0, atol=1e-5)
    assert (body.weights >= 0).all()
    assert body.joints.max() < len(PALETTE)
    corner = mesh.vertices[mesh.faces].astype(float)
    area = np.linalg.norm(np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]), axis=1)
    assert (area > 0).all()
    assert ((mesh.colors >= 0) & (mesh.colors <= 1)).all()


def test_it_stands_on_the_floor_at_its_height(body: Body) -> None:
    z = body.mesh.vertices[:, 2]
    assert -0.012 < z.min() < 0.012
    assert abs(z.max() - body.spec.height) < 0.035 + 0.01 * (body.spec.hair == "short")


def test_triangles_look_outwards(body: Body) -> None:
    mesh = body.mesh
    corner = mesh.vertices[mesh.faces].astype(float)
    flat = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    flat /= np.maximum(np.linalg.norm(flat, axis=1, keepdims=True), 1e-12)
    agree = (flat * mesh.normals[mesh.faces].mean(1)).sum(1) > -0.2
    assert agree[~part(body, "glasses")].mean() > 0.94


def test_left_and_right_are_mirror_images(body: Body) -> None:
    """Everything but hair: each vertex has a twin on the other side."""
    faces = body.mesh.faces[~part(body, "hair")]
    points = body.mesh.vertices[np.unique(faces)].astype(float)
    keys = {tuple(row) for row in np.round(points * 1e4).astype(int)}
    twins = sum(tuple(row) in keys for row in np.round(points * [1e4, -1e4, 1e4]).astype(int))
    assert twins / len(points) > 0.995


def test_trousers_close_along_the_middle(woman: Body) -> None:
    """No edge on Y = 0 is open except at the hems: the two halves are one surface."""
    faces = woman.mesh.faces[part(woman, "bottom")]
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    ordered, count = np.unique(np.sort(edges, axis=1), axis=0, return_counts=True)
    ends = woman.mesh.vertices[ordered[count == 1]]
    middle = (np.abs(ends[..., 1]) < 1e-6).all(1)
    assert (np.abs(woman.mesh.vertices[faces][..., 1]) < 1e-6).any()
    assert middle.sum() <= 2


def test_two_builds_are_equal(woman: Body) -> None:
    again = make_body(SPECS["woman"])
    assert np.array_equal(again.mesh.vertices, woman.mesh.vertices)
    assert np.array_equal(again.weights, woman.weights)
    assert np.array_equal(again.mesh.faces, woman.mesh.faces)


def test_every_word_builds() -> None:
    for style in ("crop", "long", "bun", "curly", "afro", "bald"):
        spec = BodySpec(hair=style, bottom="skirt" if style == "long" else "trousers", top="sweater")
        mesh = make_body(spec).mesh
        has_hair = (mesh.parts == PARTS.index("hair")).any()
        assert has_hair == (style != "bald")
    coat = make_body(BodySpec(top="coat", facial_hair="moustache")).mesh
    assert (coat.parts == PARTS.index("shirt")).any()


def test_words_nobody_knows_are_refused() -> None:
    with pytest.raises(ValueError, match="hair"):
        BodySpec(hair="turquoise")
    with pytest.raises(ValueError, match="height"):
        BodySpec(height=5.0)


# --- skeleton -------------------------------------------------------------------------


def test_grown_ups_are_about_seven_heads_tall_and_children_fewer() -> None:
    for spec, low, high in ((SPECS["woman"], 7.0, 7.3), (SPECS["man"], 7.0, 7.3), (SPECS["child"], 5.4, 6.2)):
        p = proportions(spec)
        assert low < p.height / p.head < high


def test_skeletons_are_symmetric_and_in_an_a_pose() -> None:
    bind = make_skeleton(SPECS["man"]).bind
    for name in JOINTS:
        if name.endswith("_l"):
            left, right = bind[JOINT[name]], bind[JOINT[name[:-2] + "_r"]]
            assert np.allclose(left * [1, -1, 1], right)
    arm = bind[JOINT["hand_l"]] - bind[JOINT["upperarm_l"]]
    assert np.allclose(arm / np.linalg.norm(arm), [0, 0.5**0.5, -(0.5**0.5)])
    assert (bind[:, 2] > 0).all()


def test_half_joints_turn_half_way_and_twists_about_the_arm() -> None:
    skeleton = make_skeleton(SPECS["man"])
    rotations = np.tile(np.eye(3), (1, len(JOINTS), 1, 1))
    rotations[0, JOINT["forearm_l"]] = elbow("l", 120.0)
    rotations[0, JOINT["hand_r"]] = turn((0.0, -1.0, -1.0), 80.0)
    matrices = skinning_matrices(
        skeleton, forward_kinematics(skeleton, rotations, skeleton.bind[None, JOINT["hips"]])
    )[0]
    assert np.allclose(matrices[PALETTE.index("half-elbow_l"), :, :3], elbow("l", 60.0), atol=1e-6)
    assert np.allclose(matrices[PALETTE.index("twist_r"), :, :3], turn((0, -1, -1), 40.0), atol=1e-6)
    hinge = skeleton.bind[JOINT["forearm_l"]]
    for name, slack in (("half-elbow_l", 0.02), ("upperarm_l", 1e-5), ("forearm_l", 1e-5)):
        m = matrices[PALETTE.index(name)]
        assert np.linalg.norm(m[:, :3] @ hinge + m[:, 3] - hinge) < slack


# --- bends ----------------------------------------------------------------------------


def enclosed(vertices: NDArray[np.float64], faces: NDArray[np.int32]) -> float:
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    return float((a * np.cross(b, c)).sum() / 6.0)


def bent_volume(
    body: Body, near: str, radius: float, turns: dict[str, NDArray[np.float64]], part_name: str
) -> float:
    """Volume between a joint and the surface around it, posed against at rest."""
    hinge = body.skeleton.bind[JOINT[near]]
    faces = body.mesh.faces[part(body, part_name)]
    close = np.linalg.norm(body.mesh.vertices[faces].mean(1) - hinge, axis=1) < radius
    faces = faces[close]
    assert len(faces) > 20
    rest = enclosed(body.mesh.vertices.astype(float) - hinge, faces)
    return enclosed(posed(body, turns) - hinge, faces) / rest


def test_elbows_and_knees_stay_full_at_120_degrees(woman: Body, man: Body) -> None:
    assert bent_volume(woman, "forearm_l", 0.11, {"forearm_l": elbow("l", 120.0)}, "skin") > 0.72
    knee = {"shin_r": turn((0, 1, 0), 120.0)}
    for who in (woman, man):
        assert bent_volume(who, "shin_r", 0.16, knee, "bottom") > 0.72


def test_sleeves_bare_arms_and_trousers_have_rings_where_they_bend() -> None:
    """Of a straight tube long triangles were left, and a bent elbow was ragged."""
    for name, spec in SPECS.items():
        body, f = make_body(spec), Figure(spec)
        h = f.p.height
        local = (body.mesh.vertices - f.joint("upperarm_l")) @ ARM_FRAME.T
        arm = np.hypot(local[:, 1], local[:, 2])[body.mesh.faces].max(1) < 0.08 * h
        for along, joint, limb, most in (
            (local[:, 0], f.p.upper_arm, arm, 0.05),
            (body.mesh.vertices[:, 2], f.p.knee, part(body, "bottom"), 0.03),
        ):
            corners = along[body.mesh.faces]
            bends = limb & (np.abs(corners.mean(1) - joint) < 0.04 * h)
            if limb is not arm and (spec.bottom == "shorts" or spec.top == "dress"):
                continue
            assert bends.sum() > 40, name
            assert (corners.max(1) - corners.min(1))[bends].max() < most * h, name


def test_no_triangle_grows_out_of_hand_in_a_pose(body: Body) -> None:
    turns = {
        "upperarm_l": turn((1, 0, 0), 100.0),
        "upperarm_r": turn((1, 0, 0), 38.0),
        "forearm_r": elbow("r", 120.0),
        "thigh_l": turn((0, 1, 0), -90.0),
        "shin_l": turn((0, 1, 0), 90.0),
    }
    after, faces = posed(body, turns), body.mesh.faces
    assert np.isfinite(after).all()

    def longest(v: NDArray[np.float64]) -> NDArray[np.float64]:
        corner = v[faces]
        return np.linalg.norm(corner - np.roll(corner, 1, axis=1), axis=2).max(1)

    assert longest(after).max() < 0.45  # the lap of a dress between two legs
    assert np.percentile(longest(after) / longest(body.mesh.vertices.astype(float)), 98) < 2.5


def test_layers_hang_alike(man: Body) -> None:
    """A shirt's hem moves with the trousers under it."""
    after = posed(man, {"thigh_l": turn((0, 1, 0), -40.0)})
    top_v = np.unique(man.mesh.faces[part(man, "top")])
    bottom_v = np.unique(man.mesh.faces[part(man, "bottom")])
    moved = np.linalg.norm(after - man.mesh.vertices, axis=1)
    hem = top_v[man.mesh.vertices[top_v, 2] < man.mesh.vertices[top_v, 2].min() + 0.02]
    for v in hem[::7]:
        d = np.linalg.norm(man.mesh.vertices[bottom_v] - man.mesh.vertices[v], axis=1)
        nearest = bottom_v[np.argmin(d)]
        assert abs(moved[v] - moved[nearest]) < 0.012 + 0.9 * d.min()


def test_skirts_share_both_legs_and_capes_go_with_them() -> None:
    """The middle of a skirt goes with both legs alike, and a cape over it lies as the skirt does."""
    figure = Figure(BodySpec(top="gown", back="cape"))
    low = np.array([[x, 0.0, figure.p.knee] for x in (0.2, -0.2)])
    w = body_weights(figure, low, side_blend=0.042)
    left, right = (w[:, [PALETTE.index(f"{n}_{s}") for n in ("thigh", "half-knee", "shin")]] for s in "lr")
    assert np.allclose(left, right)
    assert left.sum() > 0.9
    assert np.allclose(cape_weights(figure, low), w)


def test_plates_of_the_thigh_are_whole() -> None:
    """Steel reaches around the thigh although some of its triangles are longer than it."""
    body = make_body(BodySpec(top="armour"))
    plates = body.mesh.vertices[body.mesh.faces[part(body, "plate")]]
    p = proportions(body.spec)
    middle = plates[(plates[..., 2].min(1) < p.knee + 0.2) & (plates[..., 2].max(1) > p.knee + 0.14)]
    turns = np.arctan2(middle[..., 1].ravel() - p.hip[0], middle[..., 0].ravel())
    assert np.histogram(turns, bins=8, range=(-np.pi, np.pi))[0].min() > 0


def test_curves_go_through_their_points_and_no_further() -> None:
    x, y = np.array([0.0, 1.0, 1.5, 4.0]), np.array([0.0, 2.0, 2.0, -1.0])
    curve = monotone(x, y)
    assert np.allclose(curve(x), y)
    between = curve(np.linspace(-1.0, 5.0, 200))
    assert between.min() >= -1.0
    assert between.max() <= 2.0


# --- faces ----------------------------------------------------------------------------


def iris_centre(body: Body, vertices: NDArray[np.float64]) -> NDArray[np.float64]:
    eyes = part(body, "eye") & (np.abs(body.mesh.colors - np.array(body.spec.eye_color)).max(1) < 1e-3)
    used = np.unique(body.mesh.faces[eyes])
    used = used[body.mesh.vertices[used, 1] > 0]
    return vertices[used].mean(0)


def test_gaze_moves_the_iris(body: Body) -> None:
    left = posed(body, {"eye_l": turn((0, 0, 1), 25.0)})
    down = posed(body, {"eye_l": turn((0, 1, 0), 20.0)})
    rest = iris_centre(body, body.mesh.vertices.astype(float))
    assert iris_centre(body, left)[1] - rest[1] > 0.004
    assert rest[2] - iris_centre(body, down)[2] > 0.003


def test_the_jaw_opens_the_mouth_and_the_corners_smile(woman: Body) -> None:
    lips = np.unique(woman.mesh.faces[part(woman, "skin")])
    head = proportions(woman.spec)
    points = woman.mesh.vertices
    chin = lips[(points[lips, 0] > 0.05) & (np.abs(points[lips, 2] - head.chin - 0.06 * head.head) < 0.01)]
    nose = lips[(points[lips, 0] > 0.08) & (np.abs(points[lips, 2] - head.chin - 0.36 * head.head) < 0.01)]
    opened = posed(woman, {"jaw": turn((0, 1, 0), 15.0)})
    assert (points[chin, 2] - opened[chin, 2]).mean() > 0.008
    assert np.abs(opened[nose] - points[nose]).max() < 0.002
    smiled = posed(woman, {"mouth_l": turn((0, 1, 0), -9.0)})
    assert (smiled[:, 2] - points[:, 2]).max() > 0.004


def test_a_lid_closes_over_the_eye(woman: Body) -> None:
    """Shut, the lid stands in front of the pupil; open, nothing does."""
    eye = woman.skeleton.bind[JOINT["eye_l"]]
    lid = (woman.joints[:, 0] == JOINT["lid_l"]) & (woman.weights[:, 0] > 0.99)

    def in_front(vertices: NDArray[np.float64]) -> int:
        d = vertices[lid] - eye
        return int(((d[:, 0] > 0.015) & (np.abs(d[:, 1]) < 0.008) & (np.abs(d[:, 2]) < 0.007)).sum())

    assert in_front(woman.mesh.vertices.astype(float)) == 0
    assert in_front(posed(woman, {"lid_l": turn((0, 1, 0), 55.0)})) > 0


# --- cache ----------------------------------------------------------------------------


def test_bodies_are_kept_and_a_damaged_file_is_made_anew(
    tmp_path: Path, woman: Body, monkeypatch: pytest.MonkeyPatch
) -> None:
    calls = []
    monkeypatch.setattr(build, "make_body", lambda spec: (calls.append(spec), woman)[1])
    spec = SPECS["woman"]
    first = build_body(spec, tmp_path)
    second = build_body(spec, tmp_path)
    assert len(calls) == 1
    assert np.array_equal(first.mesh.vertices, second.mesh.vertices)
    assert np.array_equal(first.joints, second.joints)
    (file,) = tmp_path.iterdir()
    for damage in (b"", b"not a zip", file.read_bytes()[: file.stat().st_size // 2]):
        file.write_bytes(damage)
        third = build_body(spec, tmp_path)
        assert np.array_equal(third.weights, first.weights)
    assert len(calls) == 4
    assert [p.suffix for p in tmp_path.iterdir()] == [".npz"]


def test_a_folder_that_cannot_be_written_is_no_error(
    tmp_path: Path, woman: Body, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(build, "make_body", lambda spec: woman)
    blocked = tmp_path / "file"
    blocked.write_text("in the way")
    assert build_body(SPECS["woman"], blocked / "bodies").mesh is woman.mesh


def test_specs_differ_in_the_cache(tmp_path: Path, woman: Body, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(build, "make_body", lambda spec: woman)
    build_body(SPECS["woman"], tmp_path)
    build_body(SPECS["man"], tmp_path)
    assert len(list(tmp_path.iterdir())) == 2
