"""Triangle meshes as everything in the engine passes them on.

A mesh is frozen: functions return new ones. Metres, right-handed, Z up.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .materials import MATERIALS

__all__ = ["MATERIALS", "Mesh", "empty", "join"]


@dataclass(frozen=True, eq=False)
class Mesh:
    """Triangles with smooth normals and flat colours.

    vertices: float32 [V, 3], metres
    faces: int32 [F, 3], counter-clockwise seen from outside
    normals: float32 [V, 3], unit length (split vertices where an edge is to look sharp)
    colors: float32 [F, 3], sRGB-encoded 0..1
    parts: int32 [F]; the ink line is drawn where it changes between neighbouring pixels
    materials: int32 [F], index into :data:`MATERIALS`
    """

    vertices: NDArray[np.float32]
    faces: NDArray[np.int32]
    normals: NDArray[np.float32]
    colors: NDArray[np.float32]
    parts: NDArray[np.int32]
    materials: NDArray[np.int32]

    def __post_init__(self) -> None:
        v, f = len(self.vertices), len(self.faces)
        expected = {
            "vertices": ((v, 3), np.float32),
            "faces": ((f, 3), np.int32),
            "normals": ((v, 3), np.float32),
            "colors": ((f, 3), np.float32),
            "parts": ((f,), np.int32),
            "materials": ((f,), np.int32),
        }
        for name, (shape, dtype) in expected.items():
            array = getattr(self, name)
            if array.shape != shape or array.dtype != dtype:
                raise ValueError(
                    f"Mesh.{name}: expected {np.dtype(dtype)} {shape}, got {array.dtype} {array.shape}"
                )
        if f and (self.faces.min() < 0 or self.faces.max() >= v):
            raise ValueError("Mesh.faces: an index is outside the vertices")
        if not np.isfinite(self.vertices).all():
            raise ValueError("Mesh.vertices: not all are finite")

    def transformed(self, target_from_mesh: NDArray[np.floating]) -> Mesh:
        """The mesh moved by an affine matrix [4, 4] (rotation, translation, scale)."""
        linear = target_from_mesh[:3, :3]
        vertices = self.vertices @ linear.T + target_from_mesh[:3, 3]
        normals = self.normals @ np.linalg.inv(linear)
        length = np.linalg.norm(normals, axis=1, keepdims=True)
        normals = normals / np.maximum(length, 1e-12)
        faces = self.faces if np.linalg.det(linear) > 0 else self.faces[:, ::-1]
        return Mesh(
            vertices.astype(np.float32),
            np.ascontiguousarray(faces),
            normals.astype(np.float32),
            self.colors,
            self.parts,
            self.materials,
        )


def join(meshes: list[Mesh]) -> Mesh:
    """One mesh of all the given ones. ``parts`` are kept as they are (make them distinct first)."""
    if not meshes:
        return empty()
    offsets = np.cumsum([0] + [len(m.vertices) for m in meshes[:-1]])
    return Mesh(
        np.concatenate([m.vertices for m in meshes]),
        np.concatenate([m.faces + np.int32(o) for m, o in zip(meshes, offsets, strict=True)]).astype(
            np.int32
        ),
        np.concatenate([m.normals for m in meshes]),
        np.concatenate([m.colors for m in meshes]),
        np.concatenate([m.parts for m in meshes]),
        np.concatenate([m.materials for m in meshes]),
    )


def empty() -> Mesh:
    """A mesh of nothing."""
    return Mesh(
        np.zeros((0, 3), np.float32),
        np.zeros((0, 3), np.int32),
        np.zeros((0, 3), np.float32),
        np.zeros((0, 3), np.float32),
        np.zeros(0, np.int32),
        np.zeros(0, np.int32),
    )
