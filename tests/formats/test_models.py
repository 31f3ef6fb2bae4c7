"""Models come in upright, to size, in their colours; sets find their ground; people their joints."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import trimesh

from runtime.body.skeleton import JOINT, PALETTE
from runtime.formats import limits
from runtime.formats.boxes import column_boxes, rectangles
from runtime.formats.clips import read_clip
from runtime.formats.detail import divided
from runtime.formats.finish import piece_mesh, shell
from runtime.formats.gltf import open_gltf
from runtime.formats.load import load_model
from runtime.formats.model import Fit, settled
from runtime.formats.outline import outline
from runtime.formats.person import read_person, read_skin
from runtime.formats.rig import plain
from runtime.formats.textures import sampled
from runtime.mesh import MATERIALS
from runtime.motion.perform import perform
from runtime.motion.timeline import Timeline
from runtime.motion.types import ActionClip, Actor, ActorState, Task, Variant
from tests.formats.files import CORNERS, FACES, Buffer, box, box_parts, bvh, figure, glb, obj, png
from tests.motion.checks import measure, violations

SHARED = Path(__file__).resolve().parents[3] / "shared" / "models"
needs_shared = pytest.mark.skipif(not SHARED.is_dir(), reason="the sample models are not here")


def bounds(pieces):
    points = np.concatenate([p.vertices for p in pieces])
    return points.min(0), points.max(0)


# --- things ---------------------------------------------------------------------------


def test_a_box_of_a_y_up_file_stands_on_the_floor_around_the_middle(tmp_path):
    path = box(tmp_path / "a.glb")
    assert outline(path, tmp_path).nodes == ("box_one",)
    pieces = settled(load_model(path, tmp_path), Fit())
    low, high = bounds(pieces)
    assert np.allclose(low, (-0.5, -0.5, 0))
    assert np.allclose(high, (0.5, 0.5, 2))
    assert np.allclose(pieces[0].colors, (1, 0, 0), atol=1e-6)


@pytest.mark.parametrize(
    ("fit", "size"),
    [
        (Fit(height=1.0), (0.5, 0.5, 1.0)),
        (Fit(width=2.0), (2.0, 2.0, 4.0)),
        (Fit(scale=0.01), (0.01, 0.01, 0.02)),
        (Fit(up="z"), (1.0, 2.0, 1.0)),
        (Fit(up="z", turn=np.pi / 2), (2.0, 1.0, 1.0)),
        (Fit(up="z", length=1.0), (0.5, 1.0, 0.5)),
    ],
)
def test_size_and_up_axis_can_be_said(tmp_path, fit, size):
    low, high = bounds(settled(load_model(box(tmp_path / "a.glb"), tmp_path), fit))
    assert np.allclose(high - low, size)


def test_normals_point_outward_and_edges_are_hard(tmp_path):
    mesh = piece_mesh(settled(load_model(box(tmp_path / "a.glb"), tmp_path), Fit()), 1000)
    assert len(mesh.vertices) == 24  # each corner once a side
    middle = mesh.vertices.mean(0)
    assert ((mesh.vertices - middle) * mesh.normals).sum(1).min() > 0
    corner = mesh.vertices[mesh.faces]
    flat = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    assert ((corner.mean(1) - middle) * flat).sum(1).min() > 0


def test_an_obj_brings_its_objects_and_materials(tmp_path):
    path = obj(tmp_path / "a.obj")
    assert outline(path, tmp_path).nodes == ("lower_half", "upper_half")
    pieces = load_model(path, tmp_path).pieces
    assert {p.name for p in pieces} == {"lower_half", "upper_half"}
    colors = {p.name: p.colors.mean(0) for p in pieces}
    assert np.allclose(colors["lower_half"], (0.8, 0.1, 0.1), atol=0.01)
    assert np.allclose(colors["upper_half"], (0.1, 0.1, 0.8), atol=0.01)


def test_an_obj_need_not_be_utf_8(tmp_path):
    path = obj(tmp_path / "a.obj")
    path.write_bytes(b"# B\xf6rse\n" + path.read_bytes())
    path.with_suffix(".mtl").write_bytes(b"# gr\xfcn\n" + path.with_suffix(".mtl").read_bytes())
    assert {p.name for p in load_model(path, tmp_path).pieces} == {"lower_half", "upper_half"}


def test_an_obj_without_its_materials_is_grey(tmp_path):
    path = obj(tmp_path / "a.obj")
    path.with_suffix(".mtl").unlink()
    assert len(load_model(path, tmp_path).pieces) >= 1


@pytest.mark.parametrize("kind", ["ply", "stl"])
def test_ply_and_stl_are_z_up(tmp_path, kind):
    path = tmp_path / f"a.{kind}"
    mesh = trimesh.Trimesh(CORNERS * (1, 1, 3), FACES, process=False)
    if kind == "ply":
        mesh.visual.face_colors = np.tile([0, 255, 0, 255], (len(FACES), 1))
    mesh.export(path)
    pieces = settled(load_model(path, tmp_path), Fit())
    low, high = bounds(pieces)
    assert np.allclose(high - low, (1, 1, 3))
    if kind == "ply":
        assert np.allclose(pieces[0].colors, (0, 1, 0), atol=0.01)


def test_a_texture_is_sampled_on_every_face(tmp_path):
    buffer, parts = box_parts((1.0, 1.0, 1.0, 1.0))
    left = (CORNERS[:, :1] < 0.5).astype(np.float32)
    uvs = buffer.add(
        np.concatenate([0.1 + 0.8 * (1 - left), np.full((8, 1), 0.5)], 1).astype(np.float32), "VEC2"
    )
    parts["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = uvs
    image = png(2, 1, bytes((255, 0, 0, 0, 0, 255)))
    texture = {
        "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
        "textures": [{"source": 0}],
        "images": [{"bufferView": buffer.view(image)}],
    }
    path = glb(tmp_path / "a.glb", buffer.document(**(parts | texture)), buffer.data)
    (piece,) = load_model(path, tmp_path).pieces
    side = piece.vertices[piece.faces][:, :, 0].mean(1)
    assert np.allclose(piece.colors[side < 0.1], (1, 0, 0))
    assert np.allclose(piece.colors[side > 0.9], (0, 0, 1))


def test_triangles_with_a_picture_are_divided_without_cracks(tmp_path):
    points = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], float)
    faces = np.array([(0, 1, 2), (0, 2, 3)])
    pixels = np.zeros((64, 64, 4), np.uint8)
    pixels[20:40, 5:30] = 255
    made = divided(points, points[:, :2], faces, pixels, 500)
    at = made.mix @ points
    corner = at[made.faces]
    area = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])[:, 2] / 2
    assert 50 < len(made.faces) <= 500
    assert area.min() > 0
    assert area.sum() == pytest.approx(1)
    edges = np.sort(np.stack([made.faces, np.roll(made.faces, -1, 1)], -1).reshape(-1, 2), axis=1)
    _, count = np.unique(edges, axis=0, return_counts=True)
    ends = at[np.unique(edges, axis=0)[count == 1]]  # only the rim has edges of one triangle
    rim = (np.isclose(ends, 0) | np.isclose(ends, 1))[..., :2]
    assert (rim[:, 0] & rim[:, 1]).any(1).all()
    middle = corner.mean(1)
    white = sampled(pixels, middle[:, :2])[:, 0] > 0.5
    assert area[white].sum() == pytest.approx(20 * 25 / 64**2, rel=0.25)


def test_a_gltf_with_its_buffer_beside_it_or_inside(tmp_path):
    buffer, parts = box_parts()
    document = buffer.document(**parts)
    (tmp_path / "a.bin").write_bytes(buffer.data)
    document["buffers"][0]["uri"] = "a.bin"
    (tmp_path / "a.gltf").write_text(json.dumps(document))
    assert len(load_model(tmp_path / "a.gltf", tmp_path).pieces[0].faces) == 12


def test_glass_and_what_glows(tmp_path):
    material = {"alphaMode": "BLEND", "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.5, 0.5, 0.2]}}
    path = box(tmp_path / "a.glb", materials=[material])
    mesh = piece_mesh(settled(load_model(path, tmp_path), Fit()), 100)
    assert set(mesh.materials) == {MATERIALS.index("glass")}
    path = box(tmp_path / "b.glb", materials=[{"emissiveFactor": [1, 0.9, 0.5]}])
    mesh = piece_mesh(settled(load_model(path, tmp_path), Fit()), 100)
    assert set(mesh.materials) == {MATERIALS.index("glow")}


def test_dense_models_are_thinned_out():
    ball = trimesh.creation.icosphere(6)
    made = shell(np.asarray(ball.vertices), np.asarray(ball.faces), 2000)
    assert 1500 < len(made.faces) <= 2000
    assert np.abs(np.linalg.norm(made.vertices, axis=1) - 1).max() < 0.02
    assert (made.vertices * made.normals).sum(1).min() > 0.95
    assert made.source.max() < len(ball.vertices)


def test_columns_leave_room_under_what_hangs():
    move = trimesh.transformations.translation_matrix
    frame = trimesh.util.concatenate(
        [trimesh.creation.box((0.3, 0.3, 2.4), transform=move((x, 0, 1.2))) for x in (-1.5, 1.5)]
        + [trimesh.creation.box((3.3, 0.3, 0.4), transform=move((0, 0, 2.6)))]
    )
    boxes = column_boxes(np.asarray(frame.vertices), np.asarray(frame.faces), 0.15, 24)
    under = [b for b in boxes if b[0][0] < 0 < b[1][0]]
    assert under
    assert min(b[0][2] for b in under) > 2.2
    assert any(b[0][2] < 0.05 and b[1][0] < -1.2 for b in boxes)


def test_rectangles_cover_every_cell_once():
    rng = np.random.default_rng(2)
    key = rng.integers(-1, 2, (17, 12))
    count = np.zeros_like(key)
    for i0, j0, i1, j1 in rectangles(key):
        count[i0:i1, j0:j1] += 1
        assert len(np.unique(key[i0:i1, j0:j1])) == 1
    assert (count == (key >= 0)).all()


# --- people ---------------------------------------------------------------------------

STYLES = {
    "mixamo": lambda n: f"mixamorig:{n}",
    "rigify": lambda n: {
        "LeftUpLeg": "DEF-thigh.L",
        "RightUpLeg": "DEF-thigh.R",
        "LeftLeg": "DEF-shin.L",
        "RightLeg": "DEF-shin.R",
        "LeftFoot": "DEF-foot.L",
        "RightFoot": "DEF-foot.R",
        "LeftArm": "DEF-upper_arm.L",
        "RightArm": "DEF-upper_arm.R",
        "Hips": "DEF-hips",
        "LeftForeArm": "DEF-forearm.L",
        "RightForeArm": "DEF-forearm.R",
        "LeftHand": "DEF-hand.L",
        "RightHand": "DEF-hand.R",
    }.get(n, n),
    "joints": lambda n: {
        "LeftUpLeg": "lHip",
        "RightUpLeg": "rHip",
        "LeftLeg": "lKnee",
        "RightLeg": "rKnee",
        "LeftFoot": "lAnkle",
        "RightFoot": "rAnkle",
        "LeftArm": "lShoulder",
        "RightArm": "rShoulder",
        "LeftForeArm": "lElbow",
        "RightForeArm": "rElbow",
        "LeftHand": "lWrist",
        "RightHand": "rWrist",
        "Hips": "root",
    }.get(n, n),
    "nothing": lambda n: "",
    "numbers": lambda n: f"bone_{3 * len(n)}",
}


@pytest.mark.parametrize("style", STYLES)
def test_a_person_is_found_by_names_or_by_structure(tmp_path, style):
    names = {
        n: STYLES[style](n)
        for n in (
            "Hips",
            "Spine",
            "Chest",
            "Neck",
            "Head",
            *(
                s + n
                for s in ("Left", "Right")
                for n in ("UpLeg", "Leg", "Foot", "ToeBase", "Arm", "ForeArm", "Hand")
            ),
        )
    }
    path = figure(tmp_path / "a.glb", names)
    body = read_person(path, tmp_path, 1.8)
    bind = body.skeleton.bind
    top = body.mesh.vertices[:, 2]
    assert top.min() == pytest.approx(0, abs=1e-3)
    assert top.max() == pytest.approx(1.8, abs=1e-3)
    for side, m in (("l", 1), ("r", -1)):
        hip, knee, ankle, toe = (bind[JOINT[f"{j}_{side}"]] for j in ("thigh", "shin", "foot", "toe"))
        assert m * hip[1] > 0.05
        assert np.allclose(hip[:2], knee[:2], atol=1e-6)
        assert hip[2] > knee[2] > ankle[2]
        assert toe[0] > ankle[0] + 0.03  # faces +X
        arm = bind[JOINT[f"hand_{side}"]] - bind[JOINT[f"upperarm_{side}"]]
        assert np.allclose(arm / np.linalg.norm(arm), (0, m * 0.5**0.5, -(0.5**0.5)), atol=1e-3)
    assert bind[JOINT["head"], 2] > bind[JOINT["neck"], 2] > bind[JOINT["chest"], 2] > bind[JOINT["hips"], 2]
    assert body.joints.max() < len(PALETTE)
    assert np.allclose(body.weights.sum(1), 1, atol=1e-5)


@pytest.mark.parametrize(
    ("name", "found"),
    [
        ("mixamorig:LeftForeArm", ("forearm", "l")), ("Skeleton_arm_joint_L__4_", ("arm", "l")),
        ("DEF-upper_arm.R", ("upperarm", "r")), ("leg_joint_R_2", ("leg", "r")),
        ("Bip01 L Thigh", ("thigh", "l")),
        ("Armature|Hips", ("hips", "")), ("rightfoot", ("foot", "r")),
        ("ValveBiped.Bip01_R_Calf", ("calf", "r")),
    ],
)  # fmt: skip
def test_names_of_bones(name, found):
    assert plain(name) == found


def played(capture, skeleton, heading=0.4):
    clip = ActionClip(
        "x", (Variant("plain", (len(capture.turns) - 1) / capture.fps, Timeline()),), capture=capture
    )
    actor = Actor(skeleton, ActorState((1.0, 2.0, 0.0), heading))
    return perform({"a": actor}, {"a": Task(clip)}, {}, 24, 3)


def test_a_clip_of_a_figure_plays_on_its_own_body(tmp_path):
    path = figure(tmp_path / "a.glb")
    assert outline(path, tmp_path).clips == ("Squat",)
    capture = read_clip(path, tmp_path, "Squat")
    body = read_person(path, tmp_path, 1.7)
    motion = played(capture, body.skeleton)
    hips = motion.world_from_joint["a"][:, JOINT["hips"], 2, 3]
    assert hips[0] - hips.min() > 0.12  # it goes down,
    measures = measure(motion, "a", body.skeleton)
    assert measures.slide < 2.0
    assert measures.sink < 1.0


def test_a_bvh_in_centimetres_stands_where_one_stands(tmp_path):
    capture = read_clip(bvh(tmp_path / "a.bvh"), tmp_path)
    body = read_person(figure(tmp_path / "b.glb"), tmp_path, 1.7)
    motion = played(capture, body.skeleton)
    assert np.allclose(motion.position["a"][:, :2], (1.0, 2.0), atol=0.06)
    assert motion.end_actors["a"].heading == pytest.approx(0.4, abs=0.05)
    assert not violations(measure(motion, "a", body.skeleton))


def test_a_part_of_a_motion_over_and_over_on_the_spot(tmp_path):
    path = figure(tmp_path / "a.glb")
    part = read_clip(path, tmp_path, cut=(0.2, 0.8))
    assert (len(part.turns) - 1) / part.fps == pytest.approx(0.6, abs=0.04)
    assert len(read_clip(path, tmp_path, times=3).turns) == 3 * (len(read_clip(path, tmp_path).turns) - 1) + 1


# --- the sample models ----------------------------------------------------------------


@needs_shared
def test_the_truck():
    path = SHARED / "CesiumMilkTruck.glb"
    pieces = settled(load_model(path, SHARED), Fit())
    low, high = bounds(pieces)
    assert low[2] == pytest.approx(0, abs=1e-6)
    assert 2 < high[2] < 3
    assert 4 < np.max(high - low) < 6
    mesh = piece_mesh(pieces, limits.PROP_TRIANGLES)
    assert len(mesh.faces) <= limits.PROP_TRIANGLES


@needs_shared
@pytest.mark.parametrize("name", ["CesiumMan.glb", "RiggedFigure.glb"])
def test_the_figures_have_our_joints(name):
    skin = read_skin(open_gltf(SHARED / name, SHARED))
    bones = {joint: skin.rig.names[bone] for joint, bone in skin.found.bones.items()}
    assert "leg_joint_L_2" in bones["shin_l"]
    assert "leg_joint_R_3" in bones["foot_r"]
    assert {"spine", "chest", "neck", "head"} <= set(bones)


@needs_shared
@pytest.mark.parametrize("height", [1.25, 1.9])
def test_the_captured_walk_keeps_feet_planted(height):
    body = read_person(SHARED / "CesiumMan.glb", SHARED, height)
    motion = played(read_clip(SHARED / "walk01.bvh", SHARED), body.skeleton)
    assert np.linalg.norm(motion.position["a"][-1] - motion.position["a"][0]) > 2.5
    assert motion.touches["a"].planted.mean() > 0.35
    assert not violations(measure(motion, "a", body.skeleton))


def test_buffers_pad_as_they_should():
    buffer = Buffer()
    buffer.view(b"abc")
    assert buffer.views[buffer.view(b"d")]["byteOffset"] == 4
