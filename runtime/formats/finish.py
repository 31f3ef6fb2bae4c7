"""From a model's triangles to a :class:`runtime.mesh.Mesh`: welded, thinned out, with normals of our own.

Authored normals are not used: they do not survive thinning out, and hard edges are found from the shape.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import fast_simplification
import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from runtime.mesh import MATERIALS, Mesh, join
from runtime.rows import unique_rows

from .model import Array, Piece

#: Faces that meet at more than this are parted by a hard edge.
CREASE = np.radians(42.0)


@dataclass(frozen=True, eq=False)
class Shell:
    """Triangles ready to be drawn. source: int64 [V], which vertex of the input each one came from or lies
    next to; the rest as of :class:`Mesh`."""

    vertices: Array
    normals: Array
    faces: NDArray[np.int64]
    face_source: NDArray[np.int64]
    source: NDArray[np.int64]


def shell(vertices: Array, faces: NDArray[np.integer], most: int) -> Shell:
    """Weld, drop empty triangles, thin out to ``most``, and give normals.

    face_source: which input face each kept one is, or is nearest to
    """
    size = float(np.ptp(vertices, axis=0).max()) if len(vertices) else 1.0
    grid = np.round(vertices / max(size * 1e-5, 1e-9)).astype(np.int64)
    _, first, inverse = unique_rows(grid)
    welded = inverse[faces]
    area = np.linalg.norm(_cross(vertices[first], welded), axis=1)
    sound = np.flatnonzero(area > 1e-14 * size**2)
    points, triangles, face_source, source = vertices[first], welded[sound], sound, first
    if len(triangles) > most:
        thin = fast_simplification.simplify(
            points.astype(np.float32), triangles.astype(np.int32), target_count=most, agg=5.0
        )
        new_points, new_faces = np.asarray(thin[0], np.float64), np.asarray(thin[1], np.int64)
        alive = np.linalg.norm(_cross(new_points, new_faces), axis=1) > 1e-14 * size**2
        new_faces = new_faces[alive]
        _, near = cKDTree(points[triangles].mean(1)).query(new_points[new_faces].mean(1))
        _, near_point = cKDTree(points).query(new_points)
        points, face_source, source = new_points, sound[near], first[near_point]
        triangles = new_faces
    return _with_normals(points, triangles, face_source, source)


def _cross(points: Array, faces: NDArray[np.integer]) -> Array:
    a, b, c = (points[faces[:, k]] for k in range(3))
    return np.cross(b - a, c - a)


def _with_normals(
    points: Array, faces: NDArray[np.int64], face_source: NDArray[np.int64], source: NDArray[np.int64]
) -> Shell:
    """Each corner's normal is the mean of the faces around its point that are not beyond a hard edge."""
    weighted = _cross(points, faces)
    flat = weighted / np.maximum(np.linalg.norm(weighted, axis=1, keepdims=True), 1e-20)
    corner_point = faces.ravel()
    corner_face = np.repeat(np.arange(len(faces)), 3)
    order = np.argsort(corner_point, kind="stable")
    at, of = corner_point[order], corner_face[order]
    total = weighted[of].copy()
    limit = np.cos(CREASE)
    step = 1
    while step < 48:
        same = np.flatnonzero(at[:-step] == at[step:])
        if not len(same):
            break
        a, b = same, same + step
        near = (flat[of[a]] * flat[of[b]]).sum(1) > limit
        np.add.at(total, a[near], weighted[of[b[near]]])
        np.add.at(total, b[near], weighted[of[a[near]]])
        step += 1
    length = np.linalg.norm(total, axis=1, keepdims=True)
    normal = np.where(length > 1e-20, total / np.maximum(length, 1e-20), flat[of])
    key = np.concatenate([at[:, None], np.round(normal * 64).astype(np.int64)], axis=1)
    _, first, inverse = unique_rows(key)
    corners = np.empty(len(order), np.int64)
    corners[order] = inverse
    used = at[first]
    return Shell(points[used], normal[first], corners.reshape(-1, 3), face_source, source[used])


def piece_mesh(pieces: Sequence[Piece], most: int) -> Mesh:
    """One mesh of pieces in metres; every piece of a name has a part of its own."""
    names = list(dict.fromkeys(p.name for p in pieces))
    total = sum(len(p.faces) for p in pieces)
    share = min(1.0, most / max(total, 1))
    out = []
    for name in names:
        own = [p for p in pieces if p.name == name]
        out.append(_named(own, names.index(name), max(16, int(share * sum(len(p.faces) for p in own)))))
    return join(out)


def _named(pieces: Sequence[Piece], part: int, most: int) -> Mesh:
    offsets = np.cumsum([0, *(len(p.vertices) for p in pieces[:-1])])
    vertices = np.concatenate([p.vertices for p in pieces])
    faces = np.concatenate([p.faces + o for p, o in zip(pieces, offsets, strict=True)])
    made = shell(vertices, faces, most)
    colors = np.concatenate([p.colors for p in pieces])[made.face_source]
    materials = np.zeros(len(made.faces), np.int32)
    materials[np.concatenate([p.glass for p in pieces])[made.face_source]] = MATERIALS.index("glass")
    materials[np.concatenate([p.glow for p in pieces])[made.face_source]] = MATERIALS.index("glow")
    return Mesh(
        made.vertices.astype(np.float32),
        np.ascontiguousarray(made.faces, np.int32),
        made.normals.astype(np.float32),
        np.ascontiguousarray(colors, np.float32),
        np.full(len(made.faces), part, np.int32),
        materials,
    )
