"""OBJ, PLY and STL through trimesh, with what they name beside them kept inside the project's folder."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import numpy as np
import trimesh
from numpy.typing import NDArray
from trimesh.resolvers import Resolver

from . import limits
from .detail import divided
from .errors import ModelFileError
from .gltf_file import words
from .model import Array, Model, Piece
from .outline import outline
from .paths import beside, read_bytes
from .textures import Pixels, decode, on_faces, srgb

_GREY = (0.72, 0.71, 0.69)


class _Beside(Resolver):
    """Gives trimesh the files a model names, if they may be read; textures are looked at first."""

    def __init__(self, path: Path, folder: Path) -> None:
        self.path, self.folder = path, folder
        self.read = 0
        self.refused: ModelFileError | None = None

    def get(self, name: str) -> bytes:
        try:
            return self._bytes(str(name).strip())
        except ModelFileError as error:  # trimesh would go on without: it is told afterwards
            self.refused = self.refused or error
            raise

    def _bytes(self, name: str) -> bytes:
        self.read += 1
        if self.read > limits.IMAGES:
            raise ModelFileError(self.path, f"it names more than {limits.IMAGES} other files")
        found = beside(self.path, name, self.folder)
        if not found.is_file():
            raise FileNotFoundError(name)  # what is missing is done without
        data = read_bytes(found)
        if found.suffix.lower() == ".mtl":
            return _as_text(data)
        decode(self.path, data)
        return data

    def keys(self) -> list[str]:
        return []

    def write(self, name: str, data: bytes) -> None:
        raise ModelFileError(self.path, "nothing is written")

    def namespaced(self, namespace: str) -> _Beside:
        return self


def read_mesh(path: Path, folder: Path) -> Model:
    """An .obj, .ply or .stl: its objects by name, with their materials' colours."""
    about = outline(path, folder)
    kind = path.suffix.lower()[1:]
    options: dict[str, Any] = {"process": False, "maintain_order": True}
    beside_it = _Beside(path, folder)
    if kind == "obj":
        options |= {"resolver": beside_it, "split_objects": True, "group_material": True}
    try:
        with np.errstate(all="ignore"):
            data = read_bytes(path)
            if kind == "obj" or (kind == "ply" and b"format ascii" in data[:200]):
                data = _as_text(data)
            loaded = trimesh.load_scene(io.BytesIO(data), file_type=kind, **options)
            detail = limits.DETAIL_TRIANGLES // max(len(loaded.geometry), 1)
            pieces = [
                _piece(path, _owner(name, about.nodes), mesh, detail)
                for name, mesh in loaded.geometry.items()
                if isinstance(mesh, trimesh.Trimesh) and len(mesh.faces)
            ]
    except ModelFileError:
        raise
    except MemoryError:
        raise ModelFileError(path, "there is not enough memory for it") from None
    except Exception as error:  # its readers raise whatever a broken file leads to
        raise ModelFileError(path, f"it does not read: {_said(error)}") from None
    if beside_it.refused is not None:
        raise beside_it.refused
    if not pieces:
        raise ModelFileError(path, "it has no triangles")
    if sum(len(p.faces) for p in pieces) > limits.TRIANGLES:
        raise ModelFileError(path, f"it has more than {limits.TRIANGLES:,} triangles")
    return Model(path, tuple(pieces), about.y_up)


def _as_text(data: bytes) -> bytes:
    """As UTF-8, whatever it was: numbers and names of a script are plain letters in every encoding."""
    return data.decode("utf-8", "replace").encode("utf-8")


def _owner(name: str, objects: tuple[str, ...]) -> str:
    """The object of the file a geometry belongs to: trimesh adds the material to the name."""
    (word,) = words([name])
    return max((o for o in objects if word.startswith(o)), key=len, default=word)


def _said(error: Exception) -> str:
    words = " ".join(str(error).split())
    return words[:100] if words else type(error).__name__


def _piece(path: Path, name: str, mesh: trimesh.Trimesh, detail: int) -> Piece:
    vertices = np.asarray(mesh.vertices, np.float64).reshape(-1, 3)
    faces = np.asarray(mesh.faces, np.int64).reshape(-1, 3)
    if faces.min() < 0 or faces.max() >= len(vertices):
        raise ModelFileError(path, "a triangle of it has corners that are not there")
    if not np.isfinite(vertices[faces.ravel()]).all():
        raise ModelFileError(path, "some of its points are no numbers (NaN or infinite)")
    vertices = np.nan_to_num(vertices)
    picture = _picture(mesh)
    if picture is not None:
        pixels, uv = picture
        more = divided(vertices, uv, faces, pixels, len(faces) + detail)
        vertices, faces = more.mix @ vertices, more.faces
        colors = srgb(on_faces(pixels, more.mix @ uv, faces)[:, :3]).astype(np.float32)
    else:
        colors = _colors(mesh, faces)
    off = np.zeros(len(faces), bool)
    return Piece(name, vertices, faces.astype(np.int32), colors, off, off)


def _picture(mesh: trimesh.Trimesh) -> tuple[Pixels, Array] | None:
    """The texture uint8 [H, W, 4] and the points' places on it [V, 2], v down; None where there is none."""
    if mesh.visual.kind != "texture" or mesh.visual.uv is None:
        return None
    material = mesh.visual.material
    image = getattr(material, "image", None) or getattr(material, "baseColorTexture", None)
    uv = np.asarray(mesh.visual.uv, np.float64)
    if image is None or len(uv) < len(mesh.vertices) or not np.isfinite(uv).all():
        return None
    small = image.convert("RGBA")
    small.thumbnail((1024, 1024))
    return np.asarray(small, np.uint8), np.stack([uv[:, 0], 1.0 - uv[:, 1]], 1)[: len(mesh.vertices)]


def _colors(mesh: trimesh.Trimesh, faces: NDArray[np.int64]) -> NDArray[np.float32]:
    """sRGB [F, 3] of faces without a texture: of their material, their own or their points', or grey."""
    plain = np.tile(np.array(_GREY), (len(faces), 1))
    visual = mesh.visual
    if visual.kind == "texture":
        plain[:] = np.asarray(visual.material.main_color, np.float64).reshape(-1)[:3] / 255.0
    elif visual.kind == "face":
        plain = np.asarray(visual.face_colors, np.float64)[:, :3] / 255.0
    elif visual.kind == "vertex":
        plain = np.asarray(visual.vertex_colors, np.float64)[faces][:, :, :3].mean(1) / 255.0
    return np.clip(plain, 0.0, 1.0).astype(np.float32)
