"""Small files of other programs, made by code: a box, a figure of sticks, its motion, a BVH."""

from __future__ import annotations

import json
import struct
import zlib
from pathlib import Path
from typing import Any

import numpy as np

#: Bones of a plain figure standing along +Y, facing +Z, arms out: name, parent, place.
FIGURE = (
    ("Hips", "", (0.0, 1.0, 0.0)), ("Spine", "Hips", (0.0, 1.15, 0.0)), ("Chest", "Spine", (0.0, 1.35, 0.0)),
    ("Neck", "Chest", (0.0, 1.5, 0.0)), ("Head", "Neck", (0.0, 1.6, 0.0)),
    ("LeftUpLeg", "Hips", (0.1, 0.95, 0.0)), ("LeftLeg", "LeftUpLeg", (0.1, 0.5, 0.0)),
    ("LeftFoot", "LeftLeg", (0.1, 0.1, 0.0)), ("LeftToeBase", "LeftFoot", (0.1, 0.03, 0.12)),
    ("RightUpLeg", "Hips", (-0.1, 0.95, 0.0)), ("RightLeg", "RightUpLeg", (-0.1, 0.5, 0.0)),
    ("RightFoot", "RightLeg", (-0.1, 0.1, 0.0)), ("RightToeBase", "RightFoot", (-0.1, 0.03, 0.12)),
    ("LeftArm", "Chest", (0.18, 1.42, 0.0)), ("LeftForeArm", "LeftArm", (0.45, 1.42, 0.0)),
    ("LeftHand", "LeftForeArm", (0.7, 1.42, 0.0)),
    ("RightArm", "Chest", (-0.18, 1.42, 0.0)), ("RightForeArm", "RightArm", (-0.45, 1.42, 0.0)),
    ("RightHand", "RightForeArm", (-0.7, 1.42, 0.0)),
)  # fmt: skip

CORNERS = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], np.float32)
FACES = np.array(
    [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1),
     (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)], np.uint16
)  # fmt: skip


class Buffer:
    """Collects arrays into one buffer with its views and accessors."""

    def __init__(self) -> None:
        self.data = b""
        self.views: list[dict[str, Any]] = []
        self.accessors: list[dict[str, Any]] = []

    def view(self, data: bytes) -> int:
        self.data += b"\0" * (-len(self.data) % 4)
        self.views.append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data)})
        self.data += data
        return len(self.views) - 1

    def add(self, values: np.ndarray, kind: str) -> int:
        component = {"float32": 5126, "uint16": 5123, "uint32": 5125}[str(values.dtype)]
        view = self.view(values.tobytes())
        self.accessors.append(
            {"bufferView": view, "componentType": component, "count": len(values), "type": kind}
        )
        return len(self.accessors) - 1

    def document(self, **parts: Any) -> dict[str, Any]:
        return {
            "asset": {"version": "2.0"},
            "buffers": [{"byteLength": len(self.data)}],
            "bufferViews": self.views,
            "accessors": self.accessors,
            **parts,
        }


def glb(path: Path, document: dict[str, Any], data: bytes) -> Path:
    """Writes a .glb."""
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    data += b"\0" * (-len(data) % 4)
    body = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(data), 0x004E4942) + data
    path.write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(body)) + body)
    return path


def box_parts(color: tuple[float, ...] = (1.0, 0.0, 0.0, 1.0)) -> tuple[Buffer, dict[str, Any]]:
    """A box of 1 x 2 x 1 (Y up), of one colour."""
    buffer = Buffer()
    points = buffer.add(CORNERS * np.array([1, 2, 1], np.float32), "VEC3")
    faces = buffer.add(FACES.reshape(-1, 1), "SCALAR")
    parts = {
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "name": "Box One"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": points}, "indices": faces, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {"baseColorFactor": list(color)}}],
    }
    return buffer, parts


def box(path: Path, **changes: Any) -> Path:
    """The box as .glb, parts of its document replaced."""
    buffer, parts = box_parts()
    return glb(path, buffer.document(**(parts | changes)), buffer.data)


def figure(path: Path, names: dict[str, str] | None = None, clip: bool = True, skinned: bool = True) -> Path:
    """A figure of sticks: one thin box a bone. ``names``: other names for bones; ``clip``: a squat of 1 s."""
    buffer = Buffer()
    index = {name: i for i, (name, _, _) in enumerate(FIGURE)}
    points, faces, joints = [], [], []
    for i, (_, _, place) in enumerate(FIGURE):
        ends = [np.array(p) for _, parent, p in FIGURE if parent == FIGURE[i][0]] or [
            np.array(place) + np.array([0.0, 0.12, 0.0])
        ]
        for end in ends:
            first = len(points)
            for at in (np.array(place), end):
                points += [at + np.array(o) for o in ((-0.03, 0, -0.03), (0.03, 0, -0.03), (0, 0, 0.03))]
            faces += [
                (first + a, first + b, first + c)
                for a, b, c in (
                    (0, 1, 2),
                    (3, 5, 4),
                    (0, 3, 1),
                    (1, 3, 4),
                    (1, 4, 2),
                    (2, 4, 5),
                    (2, 5, 0),
                    (0, 5, 3),
                )
            ]
            joints += [(i, 0, 0, 0)] * 6
    weights = np.tile(np.array([1, 0, 0, 0], np.float32), (len(points), 1))
    inverse = np.tile(np.eye(4, dtype=np.float32), (len(FIGURE), 1, 1))
    inverse[:, :3, 3] = -np.array([p for _, _, p in FIGURE])
    attributes = {"POSITION": buffer.add(np.array(points, np.float32), "VEC3")}
    if skinned:
        attributes["JOINTS_0"] = buffer.add(np.array(joints, np.uint16), "VEC4")
        attributes["WEIGHTS_0"] = buffer.add(weights, "VEC4")
    indices = buffer.add(np.array(faces, np.uint16).reshape(-1, 1), "SCALAR")
    matrices = buffer.add(np.swapaxes(inverse, 1, 2).reshape(-1, 16).copy(), "MAT4")
    nodes: list[dict[str, Any]] = []
    for name, parent, place in FIGURE:
        base = np.array(FIGURE[index[parent]][2]) if parent else np.zeros(3)
        children = [index[n] for n, p, _ in FIGURE if p == name]
        node: dict[str, Any] = {
            "name": (names or {}).get(name, name),
            "translation": (np.array(place) - base).tolist(),
        }
        nodes.append(node | ({"children": children} if children else {}))
    nodes.append({"name": "Body", "mesh": 0} | ({"skin": 0} if skinned else {}))
    parts: dict[str, Any] = {
        "scene": 0,
        "scenes": [{"nodes": [0, len(nodes) - 1]}],
        "nodes": nodes,
        "meshes": [{"primitives": [{"attributes": attributes, "indices": indices}]}],
        "skins": [{"joints": list(range(len(FIGURE))), "inverseBindMatrices": matrices}],
    }
    if clip:
        parts["animations"] = [_squat(buffer, index)]
    return glb(path, buffer.document(**parts), buffer.data)


def _squat(buffer: Buffer, index: dict[str, int]) -> dict[str, Any]:
    """Down and up again in a second, knees forward, feet where they were."""
    thigh = np.radians(50)
    shin = np.arcsin(0.45 * np.sin(thigh) / 0.4)
    drop = 0.45 * (1 - np.cos(thigh)) + 0.4 * (1 - np.cos(shin))
    times = buffer.add(np.array([[0.0], [0.5], [1.0]], np.float32), "SCALAR")
    down = buffer.add(np.array([[0, 1, 0], [0, 1 - drop, 0], [0, 1, 0]], np.float32), "VEC3")
    samplers = [{"input": times, "output": down}]
    channels = [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]
    for bone, angle in (("UpLeg", -thigh), ("Leg", thigh + shin), ("Foot", -shin)):
        turn = np.array(
            [[0, 0, 0, 1], [np.sin(angle / 2), 0, 0, np.cos(angle / 2)], [0, 0, 0, 1]], np.float32
        )
        samplers.append({"input": times, "output": buffer.add(turn, "VEC4")})
        for side in ("Left", "Right"):
            target = {"node": index[side + bone], "path": "rotation"}
            channels.append({"sampler": len(samplers) - 1, "target": target})
    return {"name": "Squat", "samplers": samplers, "channels": channels}


def bvh(path: Path, rows: list[list[float]] | None = None, seconds: float = 0.04) -> Path:
    """The figure's joints as .bvh (centimetres): it steps in place for a second, unless rows are given."""
    place = {name: np.array(p) * 100 for name, _, p in FIGURE}
    lines: list[str] = ["HIERARCHY"]
    channels = 0

    def joint(name: str, parent: str, depth: int) -> None:
        nonlocal channels
        pad = "  " * depth
        x, y, z = place[name] - (place[parent] if parent else 0)
        lines.append(f"{pad}{'JOINT' if parent else 'ROOT'} {name}")
        shift = "Xposition Yposition Zposition " if not parent else ""
        count = 3 if parent else 6
        channels += count
        lines.extend(
            [
                f"{pad}{{",
                f"{pad}  OFFSET {x:.4f} {y:.4f} {z:.4f}",
                f"{pad}  CHANNELS {count} {shift}Zrotation Xrotation Yrotation",
            ]
        )
        children = [n for n, p, _ in FIGURE if p == name]
        for child in children:
            joint(child, name, depth + 1)
        if not children:
            lines.extend([f"{pad}  End Site", f"{pad}  {{", f"{pad}    OFFSET 0 0 4", f"{pad}  }}"])
        lines.append(f"{pad}}}")

    joint("Hips", "", 0)
    if rows is None:
        rows = [[0.0, 100.0, 0.0] + [0.0] * (channels - 3) for _ in range(26)]
    lines += ["MOTION", f"Frames: {len(rows)}", f"Frame Time: {seconds}"]
    lines += [" ".join(f"{v:g}" for v in row) for row in rows]
    path.write_text("\n".join(lines) + "\n")
    return path


def png(width: int, height: int, pixels: bytes | None = None) -> bytes:
    """A PNG that declares a size; with pixels (RGB) it is whole."""

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    rows = (
        b""
        if pixels is None
        else b"".join(b"\0" + pixels[3 * width * y : 3 * width * (y + 1)] for y in range(height))
    )
    head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return (
        b"\x89PNG\r\n\x1a\n"
        + chunk(b"IHDR", head)
        + chunk(b"IDAT", zlib.compress(rows))
        + chunk(b"IEND", b"")
    )


def obj(path: Path, text: str | None = None) -> Path:
    """A unit box as .obj in two objects, with an .mtl beside it."""
    path.with_suffix(".mtl").write_text("newmtl red\nKd 0.8 0.1 0.1\nnewmtl blue\nKd 0.1 0.1 0.8\n")
    corners = "\n".join(f"v {x} {y} {z}" for x, y, z in CORNERS)
    faces = ["f " + " ".join(str(i + 1) for i in face) for face in FACES]
    whole = [f"mtllib {path.stem}.mtl", corners, "o Lower Half", "usemtl red", *faces[:6]]
    path.write_text("\n".join([*whole, "o Upper.Half", "usemtl blue", *faces[6:]]) if text is None else text)
    return path
