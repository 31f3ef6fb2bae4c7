"""A body out of its pieces: what hides what, both sides, normals, colours and weights."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ..materials import number_of
from ..mesh import Mesh
from .anatomy import Figure
from .build import Body
from .extras import extras
from .features import head_pieces, limb_pieces
from .field import Field, gradient
from .head import Head
from .legwear import bare_legs, bottom, shoes
from .pieces import PARTS, Piece, drawn_in, other_side, tucked
from .spec import BodySpec
from .surface import Patch, clip
from .wardrobe import top
from .weights import (
    beard_weights,
    body_weights,
    brow_weights,
    cape_weights,
    face_weights,
    mouth_weights,
    rigid,
    strongest,
    swapped,
    tooth_weights,
)


def make_body(spec: BodySpec) -> Body:
    """Builds a body."""
    figure = Figure(spec)
    pieces = _pieces(figure)
    rows = [_finish(figure, piece) for piece in pieces if len(piece.patch.faces)]
    counts = np.cumsum([0] + [len(r[0]) for r in rows])
    faces = np.concatenate([r[2] + n for r, n in zip(rows, counts[:-1], strict=True)])
    sizes = [len(r[2]) for r in rows]
    looks = [p for p in pieces if len(p.patch.faces)]
    mesh = Mesh(
        np.concatenate([r[0] for r in rows]).astype(np.float32),
        faces.astype(np.int32),
        np.concatenate([r[1] for r in rows]).astype(np.float32),
        np.repeat(np.array([p.colour for p in looks], np.float32), sizes, axis=0),
        np.repeat(np.array([PARTS.index(p.part) for p in looks], np.int32), sizes),
        np.repeat(np.array([number_of(p.material) for p in looks], np.int32), sizes),
    )
    joints, weights = strongest(np.concatenate([r[3] for r in rows]))
    return Body(spec, figure.skeleton, mesh, joints, weights)


def _pieces(figure: Figure) -> list[Piece]:
    """Everything a person is made of; what is worn under the top keeps under it."""
    upper = top(figure)
    cover = upper[0].solid
    under = [*head_pieces(figure), *limb_pieces(figure), *bottom(figure)]
    if cover is not None:
        hem = _hem(figure, upper)
        under = [_kept_under(figure, p, cover, hem) if p.tucks else p for p in under]
    if figure.spec.bottom == "overalls":
        upper = [_inside_overalls(figure, p, under) for p in upper]
    return [*under, *upper, *extras(figure, upper), *shoes(figure), *bare_legs(figure)]


def _kept_under(figure: Figure, piece: Piece, cover: Field, hem: float) -> Piece:
    """What is worn under the top: drawn in below it, and left out behind where it could never be seen."""
    h = figure.p.height
    if piece.rule == "face":
        nape, back = figure.level(1.12), figure.joint("neck")[0]

        def bare(p: NDArray[np.float64]) -> NDArray[np.float64]:
            return np.asarray(
                cover(p) + 10.0 * np.maximum(0.0, p[:, 0] - back + 0.01) + np.maximum(0.0, p[:, 2] - nape)
            )

        return drawn_in(tucked(piece, cover), bare, 0.010, -1.0)
    if piece.part != "bottom":
        return tucked(piece, cover)
    inner = drawn_in(piece, cover, 0.010 * h, hem)
    line = hem + 0.010 * h

    def hidden(p: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.asarray(np.maximum(np.maximum(cover(p) + 0.003, line - p[:, 2]), p[:, 0] - 0.01))

    return replace(inner, patch=clip(inner.patch, hidden, keep_outside=True))


def _inside_overalls(figure: Figure, piece: Piece, under: list[Piece]) -> Piece:
    """The top without what overalls hide of it."""
    shell = next((p.solid for p in under if p.part == "over" and p.solid is not None), None)
    if shell is None or piece.solid is None:
        return piece
    waist = figure.level(0.20)
    hidden: Field = lambda p: np.maximum(shell(p) - 0.004, p[:, 2] - waist)  # noqa: E731
    return replace(piece, patch=clip(piece.patch, hidden, keep_outside=True))


def _hem(figure: Figure, upper: list[Piece]) -> float:
    """Height of the lower edge of a top, behind."""
    lowest = []
    for piece in upper:
        if piece.solid is upper[0].solid:
            v = piece.patch.vertices
            lowest.append(v[(v[:, 0] < 0.0) & (v[:, 1] < 0.03 * figure.p.height), 2].min(initial=np.inf))
    return float(min(lowest))


def _finish(
    figure: Figure, piece: Piece
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.int64], NDArray[np.float64]]:
    """Vertices, normals, faces and dense weights of a piece, both sides where it has two."""
    vertices, faces = piece.patch.vertices, piece.patch.faces
    normals = _whole(_normals(figure, piece))
    weights = _weights(figure, piece, normals)
    if piece.symmetry == "whole":
        return vertices, normals, faces, weights
    twin = other_side(piece)
    n = len(vertices)
    index = np.arange(n) + n
    if piece.symmetry == "half":
        seam = np.abs(vertices[:, 1]) < 1e-9
        normals[seam, 1] = 0.0
        normals = _whole(normals)
        index[seam] = np.flatnonzero(seam)
    faces = np.concatenate([faces, index[twin.patch.faces]])
    flipped = normals * np.array([1.0, -1.0, 1.0])
    vertices = np.concatenate([vertices, twin.patch.vertices])
    normals = np.concatenate([normals, flipped])
    weights = np.concatenate([weights, swapped(weights)])
    used, inverse = np.unique(faces, return_inverse=True)
    return vertices[used], normals[used], inverse.reshape(-1, 3), weights[used]


def _normals(figure: Figure, piece: Piece) -> NDArray[np.float64]:
    """Unit normals, smoothed so that tones have calm borders; a face's lean towards a plain oval's."""
    if piece.solid is None:
        return _unit(vertex_normals(piece.patch))
    normals = _unit(gradient(piece.solid, piece.patch.vertices, 4e-3))
    if piece.part == "eye":
        return normals
    seam = (np.abs(piece.patch.vertices[:, 1]) < 1e-9) & (piece.symmetry == "half")
    for _ in range(2):
        total = normals.copy()
        for a, b in ((0, 1), (1, 2), (2, 0)):
            np.add.at(total, piece.patch.faces[:, a], normals[piece.patch.faces[:, b]])
            np.add.at(total, piece.patch.faces[:, b], normals[piece.patch.faces[:, a]])
        total[seam, 1] = 0.0
        normals = _unit(total)
    if piece.rule == "face" and piece.part == "skin":
        normals = _unit(normals + _oval(figure, piece.patch.vertices))
    return normals


def _oval(figure: Figure, points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Normals of a plain oval around the face, fading out towards the neck and the nose."""
    p = Head(figure).units(points)
    d = (p - np.array([-0.02, 0.0, 0.45])) / np.array([0.42, 0.33, 0.62]) ** 2
    nose = 1.0 - 0.75 * np.exp(-((p[:, 1] / 0.055) ** 2) - ((p[:, 2] - 0.38) / 0.10) ** 2)
    share = (
        1.3 * np.clip((p[:, 2] - 0.02) / 0.14, 0.0, 1.0) * np.clip((p[:, 0] + 0.05) / 0.12, 0.0, 1.0) * nose
    )
    return _unit(d) * share[:, None]


def _whole(normals: NDArray[np.float64]) -> NDArray[np.float64]:
    """Normals of unit length; where there is none (the edge of a plate, on Y = 0) they face forward."""
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    return np.where(length > 1e-6, normals / np.maximum(length, 1e-6), np.array([1.0, 0.0, 0.0]))


def _unit(v: NDArray[np.float64]) -> NDArray[np.float64]:
    return v / np.maximum(np.linalg.norm(v, axis=1, keepdims=True), 1e-9)


def vertex_normals(patch: Patch) -> NDArray[np.float64]:
    """Area-weighted normals of the triangles around each vertex."""
    corner = patch.vertices[patch.faces]
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    out = np.zeros_like(patch.vertices)
    for k in range(3):
        np.add.at(out, patch.faces[:, k], normal)
    return out


def _weights(figure: Figure, piece: Piece, normals: NDArray[np.float64]) -> NDArray[np.float64]:
    points = piece.patch.vertices
    if piece.rule == "body":
        return body_weights(figure, points, normals=normals)
    if piece.rule == "legs":
        return body_weights(figure, points, arms=False)
    if piece.rule == "cape":
        return cape_weights(figure, points)
    if piece.rule == "skirt":
        return body_weights(figure, points, side_blend=0.042, normals=normals)
    own = {
        "face": face_weights,
        "brow": brow_weights,
        "mouth": mouth_weights,
        "teeth": tooth_weights,
        "beard": beard_weights,
    }
    if piece.rule in own:
        return own[piece.rule](figure, points)
    return rigid(piece.rule, len(points))
