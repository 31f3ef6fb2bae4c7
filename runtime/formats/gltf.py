"""Decoding glTF: accessors to arrays, nodes to places, primitives to coloured triangles.

Assumes what :func:`runtime.formats.gltf_file.read_gltf_file` guarantees. What only numbers can tell (NaN,
indices beyond the points) is checked here.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from pygltflib import GLTF2, Material, Primitive
from scipy.sparse import csr_matrix

from . import limits
from .detail import divided
from .errors import ModelFileError
from .gltf_file import GltfFile, read_gltf_file
from .gltf_rules import TRIANGLE_MODES, TYPE_WIDTH
from .model import Array, Model, Piece
from .paths import beside, data_uri, read_bytes
from .textures import Pixels, decode, on_faces, srgb

_DTYPES = {5120: np.int8, 5121: np.uint8, 5122: np.int16, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}
_LARGEST = {5120: 127.0, 5121: 255.0, 5122: 32767.0, 5123: 65535.0}


@dataclass(frozen=True, eq=False)
class Surface:
    """One primitive as it stands in its mesh.

    points: float64 [V, 3]; faces: int32 [F, 3]; colors, glass, glow: as of :class:`Piece`
    joints: int [V, 4] into the skin's joints and weights: float64 [V, 4], where the mesh hangs on a skeleton
    """

    points: Array
    faces: NDArray[np.int32]
    colors: NDArray[np.float32]
    glass: bool
    glow: bool
    joints: NDArray[np.int64] | None
    weights: Array | None


@dataclass(eq=False)
class Gltf:
    """An open glTF. detail: triangles it may still be given so that its textures can be read."""

    path: Path
    folder: Path
    file: GltfFile
    tree: GLTF2
    detail: int = limits.DETAIL_TRIANGLES
    _images: dict[int, Pixels] = field(default_factory=dict)
    _accessors: dict[int, Array] = field(default_factory=dict)

    # -- numbers ---------------------------------------------------------------------

    def accessor(self, index: int) -> Array:
        """float64 [count, width] of an accessor; normalized integers as 0..1. Not finite: an error."""
        if index not in self._accessors:
            self._accessors[index] = self._decoded(index)
        return self._accessors[index]

    def _decoded(self, index: int) -> Array:
        accessor = self.tree.accessors[index]
        width, count = TYPE_WIDTH[accessor.type], accessor.count
        if accessor.bufferView is None:
            return np.zeros((count, width))
        view = self.tree.bufferViews[accessor.bufferView]
        dtype = np.dtype(_DTYPES[accessor.componentType]).newbyteorder("<")
        size = dtype.itemsize * width
        stride = view.byteStride or size
        start = (view.byteOffset or 0) + (accessor.byteOffset or 0)
        data = self.file.buffers[view.buffer]
        if count == 0:
            return np.zeros((0, width))
        rows = np.lib.stride_tricks.as_strided(
            np.frombuffer(data, np.uint8, stride * (count - 1) + size, start), (count, size), (stride, 1)
        )
        values = np.ascontiguousarray(rows).view(dtype).reshape(count, width).astype(np.float64)
        if accessor.normalized and accessor.componentType in _LARGEST:
            values = np.maximum(values / _LARGEST[accessor.componentType], -1.0)
        if not np.isfinite(values).all():
            raise ModelFileError(self.path, "some of its numbers are none (NaN or infinite)")
        return values

    # -- places ----------------------------------------------------------------------

    def local(self, node: int) -> Array:
        """[4, 4] parent_from_node."""
        item = self.tree.nodes[node]
        if item.matrix is not None:
            return np.array(item.matrix, np.float64).reshape(4, 4).T
        return transform(
            item.translation or (0, 0, 0), item.rotation or (0, 0, 0, 1), item.scale or (1, 1, 1)
        )

    def parents(self) -> list[int]:
        """The parent of each node, -1 for roots."""
        out = [-1] * len(self.tree.nodes)
        for i, node in enumerate(self.tree.nodes):
            for child in node.children or []:
                out[child] = i
        return out

    def worlds(self) -> Array:
        """[N, 4, 4] world_from_node of all nodes at rest."""
        parents = self.parents()
        out = np.zeros((len(parents), 4, 4))
        for i in self.order():
            local = self.local(i)
            out[i] = local if parents[i] < 0 else out[parents[i]] @ local
        return out

    def order(self) -> list[int]:
        """All nodes, parents first."""
        parents = self.parents()
        waiting = [i for i, p in enumerate(parents) if p < 0]
        found = []
        while waiting:
            i = waiting.pop()
            found.append(i)
            waiting.extend(self.tree.nodes[i].children or [])
        return found

    # -- surfaces --------------------------------------------------------------------

    def surfaces(self, mesh: int) -> list[Surface]:
        """The triangles of a mesh."""
        found = (self._surface(p) for p in self.tree.meshes[mesh].primitives)
        return [s for s in found if s is not None]

    def _surface(self, primitive: Primitive) -> Surface | None:
        mode = 4 if primitive.mode is None else primitive.mode
        if mode not in TRIANGLE_MODES or primitive.attributes.POSITION is None:
            return None
        points = self._wide(primitive.attributes.POSITION, 3)
        count = len(points)
        if primitive.indices is None:
            index = np.arange(count)
        else:
            index = self.accessor(primitive.indices)[:, 0].astype(np.int64)
            if len(index) and index.max() >= count:
                raise ModelFileError(self.path, "a triangle of it has corners that are not there")
        faces = _triangles(index, mode)
        hung = self._hung(primitive, count)
        uv, pixels = self._picture(primitive, count)
        painted = self._painted(primitive, count)
        if pixels is not None and self.detail > 0:
            more = divided(points, uv, faces, pixels, len(faces) + self.detail)
            self.detail -= len(more.faces) - len(faces)
            faces, points, uv = more.faces, more.mix @ points, more.mix @ uv
            painted = None if painted is None else more.mix @ painted
            hung = None if hung is None else _mixed(more.mix, *hung)
        colors, glass, glow = self._colors(primitive, faces, painted, uv, pixels)
        joints, weights = (None, None) if hung is None else hung
        return Surface(points, faces.astype(np.int32), colors, glass, glow, joints, weights)

    def _hung(self, primitive: Primitive, count: int) -> tuple[NDArray[np.int64], Array] | None:
        """joints [V, 4] into the skin's and weights [V, 4]; None for what hangs on no skeleton."""
        if primitive.attributes.JOINTS_0 is None or primitive.attributes.WEIGHTS_0 is None:
            return None
        joints = self._wide(primitive.attributes.JOINTS_0, 4)[:count].astype(np.int64)
        weights = self._wide(primitive.attributes.WEIGHTS_0, 4)[:count]
        if len(joints) < count or len(weights) < count or joints.max(initial=0) >= limits.JOINTS:
            raise ModelFileError(self.path, "some of its points hang on bones that are not there")
        return joints, weights

    def _wide(self, index: int, width: int) -> Array:
        values = self.accessor(index)
        if values.shape[1] != width:
            raise ModelFileError(self.path, f"its points have {values.shape[1]} numbers each, not {width}")
        return values

    def _painted(self, primitive: Primitive, count: int) -> Array | None:
        """Linear RGB [V, 3] of points, where they have colours."""
        index = getattr(primitive.attributes, "COLOR_0", None)
        if index is None:
            return None
        painted = self.accessor(index)
        return painted[:count, :3] if len(painted) >= count and painted.shape[1] >= 3 else None

    def _picture(self, primitive: Primitive, count: int) -> tuple[Array, Pixels | None]:
        """Places [V, 2] on the texture of the material's colour, and its pixels; None where it has none."""
        none = np.zeros((0, 2)), None
        if primitive.material is None:
            return none
        plain = self.tree.materials[primitive.material].pbrMetallicRoughness
        texture = plain.baseColorTexture if plain else None
        if texture is None:
            return none
        accessor = getattr(primitive.attributes, f"TEXCOORD_{texture.texCoord or 0}", None)
        source = self.tree.textures[texture.index].source
        if accessor is None or source is None:
            return none
        uv = self._wide(accessor, 2)
        if len(uv) < count:
            raise ModelFileError(self.path, "some of its points have no place on the texture")
        return uv[:count], self.image(source)

    def _colors(
        self, primitive: Primitive, faces: NDArray[np.int64], painted: Array | None, uv: Array,
        pixels: Pixels | None,
    ) -> tuple[NDArray[np.float32], bool, bool]:  # fmt: skip
        """sRGB [F, 3] of faces; whether they are glass, whether they glow."""
        material = Material() if primitive.material is None else self.tree.materials[primitive.material]
        plain = material.pbrMetallicRoughness
        factor = np.array((plain.baseColorFactor if plain else None) or (1, 1, 1, 1), np.float64)
        rgba = np.tile(factor, (len(faces), 1))
        if painted is not None:
            rgba[:, :3] *= painted[faces].mean(1)
        if pixels is not None:
            rgba *= on_faces(pixels, uv, faces)
        clear = material.alphaMode == "BLEND" and bool(len(rgba)) and float(rgba[:, 3].mean()) < 0.6
        glow = np.array(material.emissiveFactor or (0, 0, 0), np.float64)
        if glow.max(initial=0.0) > 0.5 and material.emissiveTexture is None:
            rgba[:, :3] = glow
        return srgb(rgba[:, :3]).astype(np.float32), clear, bool(glow.max(initial=0.0) > 0.5)

    def image(self, index: int) -> Pixels:
        """uint8 [H, W, 4]"""
        if index not in self._images:
            item = self.tree.images[index]
            if item.bufferView is not None:
                view = self.tree.bufferViews[item.bufferView]
                start = view.byteOffset or 0
                data = self.file.buffers[view.buffer][start : start + view.byteLength]
            elif isinstance(item.uri, str):
                inline = data_uri(self.path, item.uri)
                data = inline if inline is not None else read_bytes(beside(self.path, item.uri, self.folder))
            else:
                raise ModelFileError(self.path, "a texture of it has no picture")
            self._images[index] = decode(self.path, data)
        return self._images[index]


def open_gltf(path: Path, folder: Path) -> Gltf:
    """A .glb or .gltf, checked and open."""
    file = read_gltf_file(path, folder)
    try:
        tree = GLTF2.from_json(file.text, infer_missing=True)
    except Exception as error:  # its reader raises whatever a wrong type leads to
        raise ModelFileError(path, f"its description does not read: {type(error).__name__}") from None
    return Gltf(path, folder, file, tree)


def read_gltf(path: Path, folder: Path) -> Model:
    """All that a glTF shows, at rest: one piece a node with a mesh."""
    gltf = open_gltf(path, folder)
    worlds = gltf.worlds()
    pieces = []
    for node, name in gltf.file.things().items():
        item = gltf.tree.nodes[node]
        world = worlds[node] if item.skin is None else np.eye(4)
        for surface in gltf.surfaces(item.mesh):
            pieces.append(_piece(name, surface, world))
    return Model(path, tuple(pieces), y_up=True)


def _piece(name: str, surface: Surface, world: Array) -> Piece:
    points = surface.points @ world[:3, :3].T + world[:3, 3]
    faces = surface.faces if np.linalg.det(world[:3, :3]) >= 0 else surface.faces[:, ::-1].copy()
    glass, glow = (np.full(len(faces), x) for x in (surface.glass, surface.glow))
    return Piece(name, points, faces, surface.colors, glass, glow)


def _mixed(mix: csr_matrix, joints: NDArray[np.int64], weights: Array) -> tuple[NDArray[np.int64], Array]:
    """joints and weights [V', 4] of points that are means of others: the strongest four."""
    rows = np.repeat(np.arange(len(joints)), 4)
    width = int(joints.max(initial=0)) + 4
    table = (mix @ csr_matrix((weights.ravel(), (rows, joints.ravel())), (len(joints), width))).toarray()
    strongest = np.argsort(-table, axis=1)[:, :4]
    return strongest, np.take_along_axis(table, strongest, axis=1)


def _triangles(index: NDArray[np.int64], mode: int) -> NDArray[np.int64]:
    """[F, 3] of a list of triangles (4), a strip (5) or a fan (6)."""
    if mode == 4:
        return index[: len(index) // 3 * 3].reshape(-1, 3)
    if len(index) < 3:
        return np.zeros((0, 3), np.int64)
    if mode == 6:
        return np.stack([np.full(len(index) - 2, index[0]), index[1:-1], index[2:]], 1)
    strip = np.stack([index[:-2], index[1:-1], index[2:]], 1)
    strip[1::2] = strip[1::2, [1, 0, 2]]
    return strip


def transform(translation: object, rotation: object, scale: object) -> Array:
    """[4, 4] of a shift [3], a quaternion (x, y, z, w) and a scale [3]."""
    x, y, z, w = np.array(rotation, np.float64) / max(float(np.linalg.norm(np.array(rotation))), 1e-12)
    out = np.eye(4)
    out[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    out[:3, :3] *= np.array(scale, np.float64)
    out[:3, 3] = np.array(translation, np.float64)
    return out
