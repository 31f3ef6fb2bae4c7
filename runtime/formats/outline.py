"""What a file of another program holds, found out without decoding it: :func:`outline`.

The standard library alone is used. What is found wrong here is told when a script is checked; the rest when
the file is decoded.
"""

from __future__ import annotations

import re
import struct
from dataclasses import dataclass
from pathlib import Path

from . import limits
from .errors import ModelFileError
from .gltf_file import read_gltf_file, words
from .paths import read_bytes

MODELS = (".glb", ".gltf", ".obj", ".ply", ".stl")
FIGURES = (".glb", ".gltf")
MOTIONS = (".bvh", ".glb", ".gltf")


@dataclass(frozen=True)
class Outline:
    """nodes: names of its things, in order; clips: names of its motions; skinned: it has skin on a skeleton.

    y_up: whether the format's upward axis is Y
    """

    nodes: tuple[str, ...] = ()
    clips: tuple[str, ...] = ()
    skinned: bool = False
    y_up: bool = True


def outline(path: Path, folder: Path) -> Outline:
    """Check a file as far as that is quick, and say what is in it."""
    suffix = path.suffix.lower()
    if suffix in (".glb", ".gltf"):
        return _gltf(path, folder)
    data = read_bytes(path)
    if suffix == ".obj":
        return _obj(path, data)
    if suffix == ".ply":
        return _ply(path, data)
    if suffix == ".stl":
        return _stl(path, data)
    if suffix == ".bvh":
        if not data.lstrip()[:9].upper() == b"HIERARCHY":
            raise ModelFileError(path, "it is no .bvh file: it does not begin with HIERARCHY")
        return Outline(clips=("motion",))
    raise ModelFileError(path, f"files ending in {suffix or 'nothing'} are not read")


def _gltf(path: Path, folder: Path) -> Outline:
    file = read_gltf_file(path, folder)
    nodes = file.document.get("nodes") or []
    skinned = any(nodes[i].get("skin") is not None for i in file.things())
    return Outline(tuple(file.things().values()), file.clips(), skinned, True)


def _obj(path: Path, data: bytes) -> Outline:
    if b"\0" in data[:4096]:
        raise ModelFileError(path, "it is no .obj file: it is not text")
    points = len(re.findall(rb"^[ \t]*v[ \t]", data, re.MULTILINE))
    _counts(path, 0, points)
    faces = 0
    for line in re.finditer(rb"^[ \t]*f[ \t]+(.*)$", data, re.MULTILINE):
        faces += max(len(line.group(1).split()) - 2, 0)
        _counts(path, faces, points)
    if points == 0 or faces == 0:
        raise ModelFileError(path, "it has no faces")
    names = [
        m.decode("utf-8", "replace").strip()
        for m in re.findall(rb"^[ \t]*[og][ \t]+(.+)$", data, re.MULTILINE)
    ]
    return Outline(tuple(words(list(dict.fromkeys(names)))), y_up=True)


def _ply(path: Path, data: bytes) -> Outline:
    head, end, _ = data[:65536].partition(b"end_header")
    if not data.startswith(b"ply") or not end:
        raise ModelFileError(path, "it is no .ply file, or its head is cut off")
    counts = {}
    for kind, number in re.findall(rb"^element\s+(\w+)\s+(\d{1,18})\s*$", head, re.MULTILINE):
        counts[kind] = int(number)
    if not counts.get(b"vertex") or not counts.get(b"face"):
        raise ModelFileError(path, "it has no faces")
    _counts(path, counts[b"face"], counts[b"vertex"])
    if sum(counts.values()) > 4 * limits.VERTICES:
        raise ModelFileError(path, "it declares more than can be read")
    if 3 * sum(counts.values()) > len(data):
        raise ModelFileError(path, f"it is cut off: {counts[b'face']:,} faces are declared and not there")
    return Outline(y_up=False)


def _stl(path: Path, data: bytes) -> Outline:
    if data[:5].lower() == b"solid" and b"facet" in data[:2048]:
        faces = data.count(b"endfacet")
    elif len(data) < 84:
        raise ModelFileError(path, "it is no .stl file: it is too short")
    else:
        (faces,) = struct.unpack_from("<I", data, 80)
        _counts(path, faces, 0)
        if 84 + 50 * faces > len(data):
            raise ModelFileError(path, f"it is cut off: {faces:,} faces are declared and not there")
    if faces == 0:
        raise ModelFileError(path, "it has no faces")
    _counts(path, faces, 0)
    return Outline(y_up=False)


def _counts(path: Path, triangles: int, points: int) -> None:
    if triangles > limits.TRIANGLES or points > limits.VERTICES:
        raise ModelFileError(
            path,
            f"it declares {triangles:,} faces of {points:,} points; "
            f"{limits.TRIANGLES:,} and {limits.VERTICES:,} are the most",
        )
