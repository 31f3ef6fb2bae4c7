"""glTF files as far as they can be judged without decoding a number: containers, lists, references, sizes.

Assumes nothing about the file. Guarantees of what :func:`read_gltf_file` returns: every index the rest of
this package follows leads somewhere, every accessor lies inside its buffer, the node tree is a tree, and all
counts are within :mod:`.limits`. The standard library alone is used, so that a script is checked at once.
"""

from __future__ import annotations

import json
import math
import re
import struct
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NoReturn

from . import limits
from .errors import ModelFileError
from .paths import beside, data_uri, read_bytes

COMPONENT_BYTES = {5120: 1, 5121: 1, 5122: 2, 5123: 2, 5125: 4, 5126: 4}
TYPE_WIDTH = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
TRIANGLE_MODES = (4, 5, 6)
#: Extensions that change nothing that would have to be decoded differently.
_KNOWN_EXTENSIONS = (
    "KHR_materials_",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
    "KHR_lights_punctual",
)
_LISTS = (
    *("nodes", "meshes", "accessors", "bufferViews", "buffers", "materials", "textures", "images"),
    *("samplers", "skins", "animations", "scenes", "cameras"),
)


_MOST = {"nodes": limits.NODES, "images": limits.IMAGES, "buffers": limits.BUFFERS}


@dataclass(frozen=True, eq=False)
class GltfFile:
    """A checked glTF.

    document: the JSON part; text: as written; buffers: the bytes of each buffer
    """

    path: Path
    document: dict[str, Any]
    text: str
    buffers: tuple[bytes, ...]

    def named(self, kind: str) -> list[str]:
        """Names of the items of a list, ``""`` where one has none."""
        return [str(item.get("name") or "") for item in self.document.get(kind, [])]

    def shown(self) -> list[int]:
        """Nodes of the scene that is shown, parents first."""
        nodes = self.document.get("nodes") or []
        scenes = self.document.get("scenes") or []
        if scenes:
            waiting = list(scenes[self.document.get("scene") or 0].get("nodes") or [])
        else:
            inside = {child for node in nodes for child in node.get("children") or []}
            waiting = [i for i in range(len(nodes)) if i not in inside]
        found: dict[int, None] = {}
        while waiting:
            i = waiting.pop(0)
            if i not in found:
                found[i] = None
                waiting[:0] = nodes[i].get("children") or []
        return list(found)

    def things(self) -> dict[int, str]:
        """Shown nodes with a mesh, and a name of its own for each, as the language may say it."""
        nodes, meshes = self.document.get("nodes") or [], self.named("meshes")
        shown = [i for i in self.shown() if nodes[i].get("mesh") is not None]
        names = [str(nodes[i].get("name") or meshes[nodes[i]["mesh"]] or "") for i in shown]
        return dict(zip(shown, words(names), strict=True))

    def clips(self) -> tuple[str, ...]:
        """Names of its motions; one without is called clip_1, clip_2 …"""
        return tuple(name or f"clip_{i + 1}" for i, name in enumerate(self.named("animations")))


def words(names: list[str]) -> list[str]:
    """Names as the language may say them, each its own: letters, digits, ``_`` and ``-``, lower case."""
    count: dict[str, int] = {}
    out = []
    for name in names:
        word = re.sub(r"[^\w-]+", "_", name).strip("_-").lower()[:60] or "part"
        word = word if not word[0].isdigit() else f"part_{word}"
        count[word] = times = count.get(word, 0) + 1
        out.append(word if times == 1 else f"{word}_{times}")
    return out


def read_gltf_file(path: Path, folder: Path) -> GltfFile:
    """A .glb or .gltf and the buffers it names inside ``folder``."""
    data = read_bytes(path)
    text, binary = _glb(path, data) if path.suffix.lower() == ".glb" else (data, None)
    document = _json(path, text)
    checker = _Checker(path, document)
    checker.lists()
    buffers = tuple(
        _buffer(path, b, i, binary, folder, checker) for i, b in enumerate(checker.items("buffers"))
    )
    checker.run()
    return GltfFile(path, document, text.decode("utf-8"), buffers)


def _glb(path: Path, data: bytes) -> tuple[bytes, bytes | None]:
    """The JSON chunk and the binary chunk."""
    if len(data) < 20 or data[:4] != b"glTF":
        raise ModelFileError(path, "it is no .glb file: the first bytes are not `glTF`")
    version, length = struct.unpack_from("<II", data, 4)
    if version != 2:
        raise ModelFileError(path, f"it is glTF version {version}; version 2 is read")
    if length > len(data):
        raise ModelFileError(path, f"it is cut off: {length:,} bytes are declared, {len(data):,} are there")
    chunks: dict[int, bytes] = {}
    at = 12
    while at + 8 <= length:
        size, kind = struct.unpack_from("<II", data, at)
        at += 8
        if size > length - at:
            raise ModelFileError(path, "it is cut off: a part of it is longer than the file")
        chunks.setdefault(kind, data[at : at + size])
        at += size
    if 0x4E4F534A not in chunks:
        raise ModelFileError(path, "it has no description of what is in it")
    return chunks[0x4E4F534A], chunks.get(0x004E4942)


def _json(path: Path, text: bytes) -> dict[str, Any]:
    if len(text) > limits.JSON_BYTES:
        raise ModelFileError(path, f"its description is larger than {limits.JSON_BYTES // limits.MIB} MiB")

    def no_number(word: str) -> NoReturn:
        raise ModelFileError(path, f"its description has {word} for a number")

    try:
        document = json.loads(text.decode("utf-8"), parse_constant=no_number)
    except (ValueError, RecursionError):
        raise ModelFileError(path, "its description cannot be read: not JSON") from None
    asset = document.get("asset") if isinstance(document, dict) else None
    if not isinstance(asset, dict) or not str(asset.get("version", "")).startswith("2"):
        raise ModelFileError(path, "it is no glTF of version 2")
    return dict(document)


def _buffer(
    path: Path, buffer: dict[str, Any], index: int, binary: bytes | None, folder: Path, checker: _Checker
) -> bytes:
    length = checker.count(buffer, "byteLength", "a buffer", limits.FILE_BYTES)
    uri = buffer.get("uri")
    if uri is None:
        data = binary if index == 0 and binary is not None else b""
    elif not isinstance(uri, str):
        checker.fail("a buffer's address is no text")
    else:
        inline = data_uri(path, uri)
        data = inline if inline is not None else read_bytes(beside(path, uri, folder))
    if len(data) < length:
        checker.fail(f"it is cut off: a buffer of {length:,} bytes has {len(data):,}")
    return data


class _Checker:
    """Checks one document; every method raises where something is wrong."""

    def __init__(self, path: Path, document: dict[str, Any]) -> None:
        self.path = path
        self.document = document

    def fail(self, reason: str) -> NoReturn:
        raise ModelFileError(self.path, reason)

    def items(self, name: str) -> list[dict[str, Any]]:
        return self.document.get(name) or []

    def run(self) -> None:
        self._extensions()
        for view in self.items("bufferViews"):
            self._view(view)
        for accessor in self.items("accessors"):
            self._accessor(accessor)
        triangles = [self._mesh(mesh) for mesh in self.items("meshes")]
        self._nodes(triangles)
        self._looks()
        for skin in self.items("skins"):
            self._skin(skin)
        for animation in self.items("animations"):
            self._animation(animation)

    def lists(self) -> None:
        for name in _LISTS:
            found = self.document.get(name, [])
            if not isinstance(found, list) or not all(isinstance(item, dict) for item in found):
                self.fail(f"`{name}` in it is no list of things")
            most = _MOST.get(name, limits.LIST_ITEMS)
            if len(found) > most:
                self.fail(f"it has {len(found):,} {name}; {most:,} are the most")

    def _extensions(self) -> None:
        required = self.document.get("extensionsRequired", [])
        for name in required if isinstance(required, list) else []:
            if not str(name).startswith(_KNOWN_EXTENSIONS):
                self.fail(f"it needs the extension {str(name)[:60]}, which is not read; export it without")

    def index(self, item: dict[str, Any], key: str, kind: str, required: bool = False) -> int | None:
        """``item[key]`` as an index into the list ``kind``."""
        value = item.get(key)
        if value is None and not required:
            return None
        if not isinstance(value, int) or isinstance(value, bool) or not 0 <= value < len(self.items(kind)):
            self.fail(f"it names {kind} that are not there")
        return value

    def count(self, item: dict[str, Any], key: str, what: str, most: int, default: int | None = None) -> int:
        value = item.get(key, default)
        if not isinstance(value, int) or isinstance(value, bool) or value < 0:
            self.fail(f"{what} in it has no sound `{key}`")
        if value > most:
            self.fail(f"{what} in it has {value:,} as its `{key}`; {most:,} is the most")
        return value

    def numbers(self, item: dict[str, Any], key: str, width: int) -> None:
        value = item.get(key)
        if value is None:
            return
        sound = isinstance(value, list) and len(value) == width
        if not sound or not all(
            isinstance(v, int | float) and abs(v) < 1e12 and math.isfinite(v) for v in value
        ):
            self.fail(f"`{key}` in it has to be {width} finite numbers")

    def _view(self, view: dict[str, Any]) -> None:
        buffer = self.index(view, "buffer", "buffers", required=True)
        offset = self.count(view, "byteOffset", "a part of a buffer", limits.FILE_BYTES, 0)
        length = self.count(view, "byteLength", "a part of a buffer", limits.FILE_BYTES)
        self.count(view, "byteStride", "a part of a buffer", 252, 0)
        assert buffer is not None
        if offset + length > self.items("buffers")[buffer]["byteLength"]:
            self.fail("a part of it reaches beyond its buffer")

    def _accessor(self, accessor: dict[str, Any]) -> None:
        component, kind = accessor.get("componentType"), accessor.get("type")
        if component not in COMPONENT_BYTES or kind not in TYPE_WIDTH:
            self.fail("it has numbers of a kind there is not")
        count = self.count(accessor, "count", "an accessor", limits.ACCESSOR_ITEMS)
        if "sparse" in accessor:
            self.fail("it has sparse accessors, which are not read; export it without")
        view = self.index(accessor, "bufferView", "bufferViews")
        if view is None:
            return
        found = self.items("bufferViews")[view]
        size = COMPONENT_BYTES[component] * TYPE_WIDTH[kind]
        offset = self.count(accessor, "byteOffset", "an accessor", limits.FILE_BYTES, 0)
        stride = found.get("byteStride") or size
        if count and offset + stride * (count - 1) + size > found["byteLength"]:
            self.fail(f"it declares {count:,} numbers that are not in it")

    def _mesh(self, mesh: dict[str, Any]) -> tuple[int, int]:
        """Triangles and vertices of a mesh, as declared."""
        primitives = mesh.get("primitives")
        if not isinstance(primitives, list) or not all(isinstance(p, dict) for p in primitives):
            self.fail("a mesh in it has no primitives")
        triangles = vertices = 0
        for primitive in primitives:
            attributes = primitive.get("attributes")
            if not isinstance(attributes, dict):
                self.fail("a mesh in it has no attributes")
            for name in attributes:
                self.index(attributes, name, "accessors", required=True)
            self.index(primitive, "material", "materials")
            self.count(primitive, "mode", "a mesh", 6, 4)
            indices = self.index(primitive, "indices", "accessors")
            position = self.index(attributes, "POSITION", "accessors")
            if position is None:
                continue
            points = self.items("accessors")[position]["count"]
            corners = points if indices is None else self.items("accessors")[indices]["count"]
            triangles += corners // 3 if primitive.get("mode", 4) == 4 else max(corners - 2, 0)
            vertices += points
        return triangles, vertices

    def _nodes(self, meshes: list[tuple[int, int]]) -> None:
        nodes = self.items("nodes")
        parents = [-1] * len(nodes)
        triangles = vertices = 0
        for i, node in enumerate(nodes):
            children = node.get("children", [])
            if not isinstance(children, list):
                self.fail("a node's children in it are no list")
            for k in range(len(children)):
                child = self.index({"child": children[k]}, "child", "nodes", required=True)
                assert child is not None
                if parents[child] >= 0 or child == i:
                    self.fail("its nodes are no tree: one has two parents, or is inside itself")
                parents[child] = i
            mesh = self.index(node, "mesh", "meshes")
            self.index(node, "skin", "skins")
            for key, width in (("matrix", 16), ("translation", 3), ("rotation", 4), ("scale", 3)):
                self.numbers(node, key, width)
            if mesh is not None:
                triangles, vertices = triangles + meshes[mesh][0], vertices + meshes[mesh][1]
        if triangles > limits.TRIANGLES or vertices > limits.VERTICES:
            self.fail(f"it declares {triangles:,} triangles of {vertices:,} points; "
                      f"{limits.TRIANGLES:,} and {limits.VERTICES:,} are the most")  # fmt: skip
        self._tree(parents)
        for scene in self.items("scenes"):
            roots = scene.get("nodes", [])
            for root in roots if isinstance(roots, list) else [None]:
                self.index({"root": root}, "root", "nodes", required=True)
        self.index(self.document, "scene", "scenes")

    def _tree(self, parents: list[int]) -> None:
        """Every node is reached from a root, within the depth allowed."""
        depth = [0] * len(parents)
        waiting = [i for i, p in enumerate(parents) if p < 0]
        reached = 0
        while waiting:
            i = waiting.pop()
            reached += 1
            if depth[i] > limits.DEPTH:
                self.fail(f"its nodes are nested deeper than {limits.DEPTH}")
            for child in self.items("nodes")[i].get("children", []):
                depth[child] = depth[i] + 1
                waiting.append(child)
        if reached < len(parents):
            self.fail("its nodes are no tree: some are inside themselves")

    def _looks(self) -> None:
        for image in self.items("images"):
            self.index(image, "bufferView", "bufferViews")
        for texture in self.items("textures"):
            self.index(texture, "source", "images")
        for material in self.items("materials"):
            plain = material.get("pbrMetallicRoughness", {})
            if not isinstance(plain, dict):
                self.fail("a material in it is no set of values")
            self.numbers(plain, "baseColorFactor", 4)
            self.numbers(material, "emissiveFactor", 3)
            looked_up = plain.get("baseColorTexture")
            if looked_up is not None:
                if not isinstance(looked_up, dict):
                    self.fail("a material in it is no set of values")
                self.index(looked_up, "index", "textures", required=True)

    def _skin(self, skin: dict[str, Any]) -> None:
        joints = skin.get("joints")
        if not isinstance(joints, list) or not 0 < len(joints) <= limits.JOINTS:
            self.fail(f"a skeleton in it has to have from 1 to {limits.JOINTS} joints")
        for joint in joints:
            self.index({"joint": joint}, "joint", "nodes", required=True)
        matrices = self.index(skin, "inverseBindMatrices", "accessors")
        if matrices is not None:
            accessor = self.items("accessors")[matrices]
            if accessor["type"] != "MAT4" or accessor["count"] < len(joints):
                self.fail("a skeleton in it has fewer bind matrices than joints")

    def _dicts(self, animation: dict[str, Any], key: str) -> list[dict[str, Any]]:
        found = animation.get(key)
        if not isinstance(found, list) or not all(isinstance(x, dict) for x in found):
            self.fail("a motion in it has no channels")
        if len(found) > limits.CHANNELS:
            self.fail(f"a motion in it has {len(found):,} channels; {limits.CHANNELS:,} are the most")
        return found

    def _animation(self, animation: dict[str, Any]) -> None:
        channels, samplers = self._dicts(animation, "channels"), self._dicts(animation, "samplers")
        for sampler in samplers:
            times = self.index(sampler, "input", "accessors", required=True)
            self.index(sampler, "output", "accessors", required=True)
            assert times is not None
            if self.items("accessors")[times]["count"] > limits.FRAMES:
                self.fail(f"a motion in it has more than {limits.FRAMES:,} keys")
        for channel in channels:
            number = channel.get("sampler")
            if not isinstance(number, int) or not 0 <= number < len(samplers):
                self.fail("a motion in it names keys that are not there")
            target = channel.get("target")
            if not isinstance(target, dict):
                self.fail("a motion in it moves nothing")
            self.index(target, "node", "nodes")
