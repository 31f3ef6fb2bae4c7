"""Files that are broken, hostile or too large: each is refused with a reason, and nothing else happens."""

from __future__ import annotations

import contextlib
import json
import os
import struct
from pathlib import Path

import numpy as np
import pytest
import trimesh

from runtime.formats import limits
from runtime.formats.clips import read_clip
from runtime.formats.errors import ModelFileError
from runtime.formats.load import load_model
from runtime.formats.model import Fit, settled
from runtime.formats.outline import outline
from runtime.formats.person import read_person
from tests.formats.files import Buffer, box, box_parts, bvh, figure, glb, obj, png


def refused(path: Path, words: str, folder: Path | None = None) -> None:
    """Reading the file to the end is refused for this reason."""
    with pytest.raises(ModelFileError, match=words) as error:
        settled(load_model(path, folder or path.parent), Fit())
    assert error.value.path.name == path.name


def refused_at_once(path: Path, words: str) -> None:
    """It is refused before anything is decoded, when a script is checked."""
    with pytest.raises(ModelFileError, match=words):
        outline(path, path.parent)


# --- containers -----------------------------------------------------------------------


def test_an_empty_file(tmp_path):
    for name in ("a.glb", "a.gltf", "a.obj", "a.ply", "a.stl", "a.bvh"):
        path = tmp_path / name
        path.write_bytes(b"")
        refused_at_once(path, "empty")


def test_a_folder_and_a_pipe_are_not_read(tmp_path):
    (tmp_path / "a.glb").mkdir()
    refused_at_once(tmp_path / "a.glb", "not a file")
    os.mkfifo(tmp_path / "b.glb")
    refused_at_once(tmp_path / "b.glb", "not a file")


def test_a_file_of_another_kind(tmp_path):
    path = tmp_path / "a.glb"
    path.write_bytes(b"PK\x03\x04" + b"\0" * 400)
    refused_at_once(path, "no .glb file")


@pytest.mark.parametrize("keep", [3, 15, 30, 200, 0.9])
def test_a_file_that_is_cut_off(tmp_path, keep):
    path = box(tmp_path / "a.glb")
    data = path.read_bytes()
    path.write_bytes(data[: keep if isinstance(keep, int) else int(keep * len(data))])
    refused_at_once(path, "cut off|no .glb")


def test_every_cut_of_a_figure_is_refused(tmp_path):
    path = figure(tmp_path / "a.glb")
    data = path.read_bytes()
    for keep in range(0, len(data) - 1, 997):
        path.write_bytes(data[:keep])
        with pytest.raises(ModelFileError):
            read_person(path, tmp_path, 1.7)


def test_random_damage_is_refused_or_read_but_never_crashes(tmp_path):
    path = figure(tmp_path / "a.glb")
    data = bytearray(path.read_bytes())
    rng = np.random.default_rng(5)
    for _ in range(60):
        broken = bytearray(data)
        for at in rng.integers(0, len(data), 6):
            broken[at] = int(rng.integers(0, 256))
        path.write_bytes(bytes(broken))
        for read in (lambda: read_person(path, tmp_path, 1.7), lambda: read_clip(path, tmp_path)):
            with contextlib.suppress(ModelFileError):
                read()


@pytest.mark.parametrize("kind", ["obj", "ply", "stl", "bvh"])
def test_random_damage_to_other_kinds(tmp_path, kind):
    path = tmp_path / f"a.{kind}"
    if kind in ("obj", "bvh"):
        (obj if kind == "obj" else bvh)(path)
    else:
        trimesh.creation.icosphere(1).export(path)
    data = path.read_bytes()
    rng = np.random.default_rng(7)
    for _ in range(40):
        broken = bytearray(data)
        for at in rng.integers(0, len(data), 4):
            broken[at] = int(rng.integers(32, 127))
        path.write_bytes(bytes(broken))
        with contextlib.suppress(ModelFileError):
            if kind == "bvh":
                read_clip(path, tmp_path)
            else:
                settled(load_model(path, tmp_path), Fit())


def test_a_file_that_is_too_large(tmp_path, monkeypatch):
    path = box(tmp_path / "a.glb")
    monkeypatch.setattr("runtime.formats.paths.read_bytes.__defaults__", (100,))
    refused_at_once(path, "are the most")


def test_json_that_is_none(tmp_path):
    path = tmp_path / "a.gltf"
    for text in (b"{", b"[" * 100_000, b"\xff\xfe", b"[]", b'{"asset": 3}', b'{"asset": {"version": "1.0"}}'):
        path.write_bytes(text)
        refused_at_once(path, "cannot be read|no glTF")


# --- counts and references ------------------------------------------------------------


def test_ten_million_triangles_are_refused_by_what_is_declared(tmp_path):
    buffer, parts = box_parts()
    buffer.accessors[1]["count"] = 30_000_000
    refused_at_once(glb(tmp_path / "a.glb", buffer.document(**parts), buffer.data), "30,000,000")
    stl = tmp_path / "a.stl"
    stl.write_bytes(b"\0" * 80 + struct.pack("<I", 10_000_000) + b"\0" * 500)
    refused_at_once(stl, "10,000,000")
    ply = tmp_path / "a.ply"
    ply.write_text(
        "ply\nformat ascii 1.0\nelement vertex 10000000\nproperty float x\nelement face 10000000\n"
        "property list uchar int vertex_indices\nend_header\n0\n"
    )
    refused_at_once(ply, "10,000,000")


def test_a_mesh_shown_many_times_counts_each_time(tmp_path, monkeypatch):
    monkeypatch.setattr(limits, "TRIANGLES", 100)
    nodes = [{"mesh": 0} for _ in range(10)]
    path = box(tmp_path / "a.glb", nodes=nodes, scenes=[{"nodes": list(range(10))}])
    refused_at_once(path, "120 triangles")


def test_too_many_things(tmp_path):
    path = box(tmp_path / "a.glb", nodes=[{}] * (limits.NODES + 1))
    refused_at_once(path, "nodes")


@pytest.mark.parametrize(
    "nodes",
    [
        [{"children": [0]}],
        [{"children": [1]}, {"children": [2]}, {"children": [0]}],
        [{"children": [1, 1]}, {}],
        [{"children": [2]}, {"children": [2]}, {}],
    ],
)
def test_nodes_that_are_no_tree(tmp_path, nodes):
    refused_at_once(box(tmp_path / "a.glb", nodes=nodes), "no tree")


def test_nodes_without_end(tmp_path):
    deep = [{"children": [i + 1]} for i in range(limits.DEPTH + 5)] + [{}]
    refused_at_once(box(tmp_path / "a.glb", nodes=deep), "nested deeper")


@pytest.mark.parametrize(
    "changes",
    [
        {"nodes": [{"mesh": 7}]},
        {"nodes": [{"mesh": -1}]},
        {"nodes": [{"mesh": True}]},
        {"nodes": [{"children": [9]}]},
        {"nodes": [{"children": "all"}]},
        {"nodes": 3},
        {"nodes": [4]},
        {"scene": 5},
        {"scenes": [{"nodes": [44]}]},
        {"meshes": [{}]},
        {"meshes": [{"primitives": [{"attributes": {"POSITION": 99}}]}]},
        {"meshes": [{"primitives": [{"attributes": [1]}]}]},
        {"materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 4}}}]},
        {"materials": [{"pbrMetallicRoughness": {"baseColorFactor": [1, 2]}}]},
        {"nodes": [{"mesh": 0, "translation": [0, 0, "far"]}]},
        {"nodes": [{"mesh": 0, "scale": [1e300, 1, 1]}]},
        {"skins": [{"joints": []}]},
        {"skins": [{"joints": [77]}]},
        {"animations": [{"channels": [{"sampler": 3, "target": {}}], "samplers": []}]},
        {"bufferViews": [{"buffer": 0, "byteLength": 99_999}]},
        {"bufferViews": [{"buffer": 3, "byteLength": 4}]},
        {"accessors": [{"bufferView": 0, "componentType": 1, "count": 3, "type": "VEC3"}]},
        {"accessors": [{"bufferView": 0, "componentType": 5126, "count": -3, "type": "VEC3"}]},
        {"accessors": [{"bufferView": 0, "componentType": 5126, "count": 9, "type": "MAT4"}]},
        {"extensionsRequired": ["KHR_draco_mesh_compression"]},
    ],
)
def test_references_and_values_that_lead_nowhere(tmp_path, changes):
    refused_at_once(box(tmp_path / "a.glb", **changes), ".")


def test_an_index_beyond_the_points(tmp_path):
    buffer = Buffer()
    points = buffer.add(np.zeros((3, 3), np.float32), "VEC3")
    faces = buffer.add(np.array([[0], [1], [500]], np.uint16), "SCALAR")
    parts = {
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": points}, "indices": faces}]}],
    }
    refused(glb(tmp_path / "a.glb", buffer.document(**parts), buffer.data), "corners that are not there")


# --- numbers --------------------------------------------------------------------------


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_points_that_are_no_numbers(tmp_path, value):
    buffer = Buffer()
    points = buffer.add(np.array([[0, 0, 0], [1, 0, 0], [value, 1, 0]], np.float32), "VEC3")
    parts = {"nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": points}}]}]}
    refused(glb(tmp_path / "a.glb", buffer.document(**parts), buffer.data), "NaN or infinite")
    path = obj(tmp_path / "b.obj", f"v 0 0 0\nv 1 0 0\nv {value} 1 0\nf 1 2 3\n")
    refused(path, "NaN or infinite|does not read")
    stl = tmp_path / "c.stl"
    floats = np.array([0, 0, 1, 0, 0, 0, 1, 0, 0, value, 1, 0], "<f4").tobytes()
    stl.write_bytes(b"\0" * 80 + struct.pack("<I", 1) + floats + b"\0\0")
    refused(stl, "NaN or infinite")


def test_nan_written_into_the_description(tmp_path):
    path = tmp_path / "a.gltf"
    path.write_text('{"asset": {"version": "2.0"}, "nodes": [{"translation": [NaN, 0, 0]}]}')
    refused_at_once(path, "NaN for a number")


def test_a_model_of_no_size_or_beyond_measure(tmp_path):
    refused(obj(tmp_path / "a.obj", "v 0 0 0\nv 1e-7 0 0\nv 0 1e-7 0\nf 1 2 3\n"), "large; say")
    refused(obj(tmp_path / "b.obj", "v 0 0 0\nv 1e7 0 0\nv 0 1e7 0\nf 1 2 3\n"), "large; say")
    refused(obj(tmp_path / "c.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"), "no faces")


# --- what files name ------------------------------------------------------------------


@pytest.mark.parametrize(
    "uri", ["http://example.org/a.bin", "https://example.org/a.bin", "file:///etc/passwd", "//host/a"]
)
def test_addresses_are_not_followed(tmp_path, uri):
    path = tmp_path / "a.gltf"
    path.write_text(json.dumps({"asset": {"version": "2.0"}, "buffers": [{"byteLength": 4, "uri": uri}]}))
    refused_at_once(path, "elsewhere")


@pytest.mark.parametrize(
    "uri", ["../secret.bin", "%2e%2e/secret.bin", "sub/../../secret.bin", "/etc/passwd", "link.bin"]
)
def test_nothing_outside_the_folder_is_read(tmp_path, uri):
    (tmp_path / "secret.bin").write_bytes(b"abcdefgh")
    inside = tmp_path / "project"
    inside.mkdir()
    (inside / "link.bin").symlink_to(tmp_path / "secret.bin")
    path = inside / "a.gltf"
    path.write_text(json.dumps({"asset": {"version": "2.0"}, "buffers": [{"byteLength": 4, "uri": uri}]}))
    refused_at_once(path, "leaves the project's folder")
    buffer, parts = box_parts()
    texture = {
        "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
        "textures": [{"source": 0}],
        "images": [{"uri": uri}],
    }
    uvs = buffer.add(np.zeros((8, 2), np.float32), "VEC2")
    parts["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = uvs
    refused(glb(inside / "b.glb", buffer.document(**(parts | texture)), buffer.data), "leaves the project's")


def test_an_obj_may_name_only_what_is_beside_it(tmp_path):
    (tmp_path / "secret.mtl").write_text("newmtl a\nKd 1 0 0\n")
    (tmp_path / "project").mkdir()
    path = obj(tmp_path / "project" / "a.obj", "mtllib ../secret.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    refused(path, "leaves the project's folder")


def test_a_picture_that_would_fill_the_memory(tmp_path):
    buffer, parts = box_parts()
    uvs = buffer.add(np.zeros((8, 2), np.float32), "VEC2")
    parts["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = uvs
    texture = {
        "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
        "textures": [{"source": 0}],
        "images": [{"bufferView": buffer.view(png(60_000, 60_000))}],
    }
    refused(glb(tmp_path / "a.glb", buffer.document(**(parts | texture)), buffer.data), "pixels")


def test_a_picture_that_is_none(tmp_path):
    buffer, parts = box_parts()
    uvs = buffer.add(np.zeros((8, 2), np.float32), "VEC2")
    parts["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = uvs
    texture = {
        "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
        "textures": [{"source": 0}],
        "images": [{"bufferView": buffer.view(b"no picture")}],
    }
    refused(glb(tmp_path / "a.glb", buffer.document(**(parts | texture)), buffer.data), "texture")


# --- motion ---------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (("Frames: 26", "Frames: 99999999"), "declares"),
        (("Frames: 26", "Frames: 27"), "cut off"),
        (("Frames: 26", "Frames: 0"), "declares"),
        (("Frames: 26", "Frames: many"), "how many frames"),
        (("Frame Time: 0.04", "Frame Time: 0"), "no time"),
        (("Frame Time: 0.04", "Frame Time: nan"), "how long one is"),
        (("OFFSET 10.0000", "OFFSET nan"), "none"),
        (("OFFSET 10.0000", "OFFSET far"), "number"),
        (("CHANNELS 3", "CHANNELS 44"), "channels"),
        (("Zrotation", "Wrotation"), "channel"),
        (("MOTION", "MOTON"), "no MOTION"),
        (("ROOT", "ROT"), "ROOT"),
        (("\n0 100 0", "\n0 nan 0"), "none"),
        (("\n0 100 0", "\n0 x 0"), "no number"),
    ],
)
def test_broken_bvh(tmp_path, change, words):
    path = bvh(tmp_path / "a.bvh")
    text = path.read_text()
    assert change[0] in text
    path.write_text(text.replace(*change))
    with pytest.raises(ModelFileError, match=words):
        read_clip(path, tmp_path)


def test_a_bvh_nested_without_end(tmp_path):
    path = tmp_path / "a.bvh"
    depth = 5_000
    joints = "".join(
        f"JOINT j{i} {{ OFFSET 0 1 0 CHANNELS 3 Zrotation Xrotation Yrotation " for i in range(depth)
    )
    path.write_text(
        "HIERARCHY ROOT r { OFFSET 0 0 0 CHANNELS 3 Zrotation Xrotation Yrotation "
        + joints
        + "}" * (depth + 1)
        + "\nMOTION\nFrames: 1\nFrame Time: 0.1\n0\n"
    )
    with pytest.raises(ModelFileError, match="nested deeper"):
        read_clip(path, tmp_path)


def test_bones_that_are_nobodys(tmp_path):
    path = figure(tmp_path / "a.glb", skinned=True)
    text = path.read_bytes()
    assert b'"joints"' in text
    two = box(tmp_path / "b.glb")
    with pytest.raises(ModelFileError, match="no skeleton"):
        read_person(two, tmp_path, 1.7)
    chain = tmp_path / "c.bvh"
    chain.write_text(
        "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\nJOINT b\n{\n"
        "OFFSET 0 1 0\nCHANNELS 3 Zrotation Xrotation Yrotation\nEnd Site\n{\nOFFSET 0 1 0\n}\n}\n}\n"
        "MOTION\nFrames: 2\nFrame Time: 0.1\n0 0 0 0 0 0\n0 0 0 0 0 0\n"
    )
    with pytest.raises(ModelFileError, match="not those of a person"):
        read_clip(chain, tmp_path)
