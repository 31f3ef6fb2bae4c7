"""What must hold of a glTF document before a number of it is decoded: its lists, references and sizes.

Assumes a JSON object, and nothing about what is in it. Guarantees, once :meth:`Checker.lists` and
:meth:`Checker.run` have returned, what :mod:`.gltf_file` says of a checked file.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any, NoReturn

from . import limits
from .errors import ModelFileError

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


class Checker:
    """Checks one document. Every method raises :class:`ModelFileError` where something is wrong."""

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
