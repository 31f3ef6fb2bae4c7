"""A finer level of smooth meshes, for views that come so close that facets of their outlines would show.

Assumes shells whose neighbours share places (a sharp edge has several vertices at a place) and weights that
are the same wherever places are. Guarantees: old vertices stay, new ones come after them; nothing opens
between neighbours, as where an edge is cut depends on its ends alone; flat regions get no triangles.

Edges are bent as in curved PN triangles: the middle of the cubic that leaves both ends at right angles to
their normals.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..rows import unique_rows

Index = NDArray[np.int64]
Floats = NDArray[np.float32]

BENT = 6e-4  # metres an edge's middle has to be off the surface for the edge to be cut
ROUNDS = 2  # how often an edge may be halved
STEEPEST = 0.14  # most that a middle is moved, in lengths of its edge: sharper bends are meant


@dataclass(frozen=True, eq=False)
class Skin:
    """Vertices as they are skinned.

    place, normal: float32 [V, 3]; joints: int32 [V, 4]; weights: float32 [V, 4]
    """

    place: Floats
    normal: Floats
    joints: NDArray[np.int32]
    weights: Floats


def finer(skin: Skin, faces: Index) -> tuple[Skin, Index, Index]:
    """Faces cut where the surface is bent: the vertices with new ones after them, faces [F', 3] and the face
    that each comes from, [F']."""
    source = np.arange(len(faces))
    for _ in range(ROUNDS):
        skin, found, of = _halved(skin, faces)
        if len(found) == len(faces):
            break
        faces, source = found, source[of]
    return skin, faces, source


def _halved(skin: Skin, faces: Index) -> tuple[Skin, Index, Index]:
    """Every bent edge cut once, and the face that each of the new faces comes from."""
    start = faces.reshape(-1)
    end = np.roll(faces, -1, axis=1).reshape(-1)
    count = len(skin.place)
    keys, edge = np.unique(np.minimum(start, end) * count + np.maximum(start, end), return_inverse=True)
    a, b = keys // count, keys % count
    middle, bent = _middles(skin.place, skin.normal, a, b)
    a, b = a[bent], b[bent]
    added = Skin(middle[bent], _between(skin.normal, a, b), *_blended(skin.joints, skin.weights, a, b))
    new = np.full(len(keys), -1, np.int64)
    new[bent] = count + np.arange(int(bent.sum()))
    joined = Skin(
        *(
            np.concatenate([getattr(skin, name), getattr(added, name)])
            for name in ("place", "normal", "joints", "weights")
        )
    )
    return joined, *_cut(faces, new[edge.reshape(-1)].reshape(-1, 3))


def _middles(place: Floats, normal: Floats, a: Index, b: Index) -> tuple[Floats, NDArray[np.bool_]]:
    """The middle of each edge on the bent surface, and whether it is far enough off the straight one.

    The same at every edge between two places, whichever vertices it has there: what is moved is the mean.
    """
    used = np.unique(np.concatenate([a, b]))
    at = np.zeros(len(place), np.int64)
    at[used] = unique_rows(place[used])[2]
    low, high = np.minimum(at[a], at[b]), np.maximum(at[a], at[b])
    _, edge = np.unique(low * (int(at.max()) + 1) + high, return_inverse=True)
    edge = edge.reshape(-1)
    p, q = place[a].astype(np.float64), place[b].astype(np.float64)
    m, n = normal[a].astype(np.float64), normal[b].astype(np.float64)
    along = q - p
    off = -((along * m).sum(1, keepdims=True) * m - (along * n).sum(1, keepdims=True) * n) / 8
    shares = np.bincount(edge)[:, None]
    off = (np.stack([np.bincount(edge, off[:, k]) for k in range(3)], axis=1) / shares)[edge]
    size = np.linalg.norm(off, axis=1, keepdims=True)
    off *= np.minimum(1.0, STEEPEST * np.linalg.norm(along, axis=1, keepdims=True) / np.maximum(size, 1e-12))
    return ((p + q) / 2 + off).astype(np.float32), size[:, 0] > BENT


def _between(normal: Floats, a: Index, b: Index) -> Floats:
    """Normals in the middle of edges, as shading has them there: bent ones would show how rough a mesh is."""
    both = normal[a] + normal[b]
    return np.asarray(both / np.maximum(np.linalg.norm(both, axis=1, keepdims=True), 1e-9), np.float32)


def _blended(
    joints: NDArray[np.int32], weights: Floats, a: Index, b: Index
) -> tuple[NDArray[np.int32], Floats]:
    """The four strongest of both ends' joints, and their weights."""
    dense = np.zeros((len(a), max(int(joints.max(initial=0)) + 1, 4)), np.float32)
    row = np.arange(len(a))
    for end in (a, b):
        for k in range(4):
            np.add.at(dense, (row, joints[end, k]), weights[end, k] / 2)
    best = np.argsort(-dense, axis=1, kind="stable")[:, :4]
    chosen = np.take_along_axis(dense, best, 1)
    best = np.where(chosen > 0, best, best[:, :1])  # of fewer than four joints, no other is named
    return best.astype(np.int32), chosen / chosen.sum(1, keepdims=True)


def _cut(faces: Index, new: Index) -> tuple[Index, Index]:
    """Faces with the cuts of their edges (first to second corner, …; -1: none), and where each comes from."""
    cut = (new >= 0).sum(axis=1)
    out, source = [faces[cut == 0]], [np.flatnonzero(cut == 0)]
    for count in (1, 2, 3):
        here = np.flatnonzero(cut == count)
        # turned so that the one edge cut, or the one not cut, comes first
        turn = np.argmax((new[here] >= 0) == (count == 1), axis=1) if count < 3 else np.zeros(len(here), int)
        order = (turn[:, None] + np.arange(3)) % 3
        a, b, c = np.take_along_axis(faces[here], order, 1).T
        ab, bc, ca = np.take_along_axis(new[here], order, 1).T
        parts = {
            1: ((a, ab, c), (ab, b, c)),
            2: ((a, b, bc), (a, bc, ca), (ca, bc, c)),
            3: ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)),
        }[count]
        out += [np.stack(part, axis=1) for part in parts]
        source += [here] * len(parts)
    return np.concatenate(out), np.concatenate(source)
