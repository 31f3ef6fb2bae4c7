"""Triangles with a picture on them, divided until one colour each will do.

All triangles that share an edge are divided at the same point of it, so that no cracks open. What hangs on
points (places, weights) follows by :attr:`Divided.mix`: each new point is the mean of two others.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix, identity, vstack

from runtime.rows import unique_rows

from .model import Array
from .textures import Pixels, sampled

#: Colours (sRGB) within this of each other on a face are one; at most so many rounds.
NEAR, ROUNDS = 0.13, 5
#: Edges shorter than this share of the model's size are not divided.
SHORTEST = 0.008
#: Places on a face where its colours are looked at, as shares of its corners.
_SPOTS = np.array([(i, j, 5 - i - j) for i in range(6) for j in range(6 - i)]) / 5 * 0.94 + 0.02


@dataclass(frozen=True, eq=False)
class Divided:
    """faces: int64 [F', 3]; mix: sparse [V', V], the points as means of those there were."""

    faces: NDArray[np.int64]
    mix: csr_matrix


def divided(points: Array, uv: Array, faces: NDArray[np.integer], pixels: Pixels, most: int) -> Divided:
    """The faces divided where the picture has more than one colour, up to ``most`` of them."""
    current: NDArray[np.int64] = np.asarray(faces, np.int64)
    mix = identity(len(points), format="csr")
    size = float(np.ptp(points, axis=0).max()) if len(points) else 0.0
    for _ in range(ROUNDS):
        wanted = _wanted(points, uv, current, pixels, SHORTEST * size)
        room = (most - len(current)) // 4  # a divided face is four, and its neighbours are two
        if room <= 0 or not len(wanted):
            break
        current, halves = _split(points, current, wanted[:room])
        rows = np.repeat(np.arange(len(halves)), 2)
        half = csr_matrix((np.full(2 * len(halves), 0.5), (rows, halves.ravel())), (len(halves), len(points)))
        step = vstack([identity(len(points), format="csr"), half], format="csr")
        points, uv, mix = step @ points, step @ uv, step @ mix
    return Divided(current, mix)


def _wanted(
    points: Array, uv: Array, faces: NDArray[np.int64], pixels: Pixels, shortest: float
) -> NDArray[np.int64]:
    """Faces with several colours on them, those that show most first."""
    at = np.einsum("sk,fkc->fsc", _SPOTS, uv[faces])
    colors = sampled(pixels, at.reshape(-1, 2))[:, :3].reshape(len(faces), len(_SPOTS), 3)
    spread = np.ptp(colors, axis=1).max(1)
    corner = points[faces]
    edge = np.linalg.norm(corner - np.roll(corner, 1, axis=1), axis=2).max(1)
    area = np.linalg.norm(np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]), axis=1)
    found = np.flatnonzero((spread > NEAR) & (edge > shortest))
    return np.asarray(found[np.argsort(-(spread * area)[found], kind="stable")])


def _split(
    points: Array, faces: NDArray[np.int64], wanted: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Faces with the wanted ones in four and what touches them in two or three, and the pairs of points
    [N, 2] that the new points lie between. Edges are one where they lie on each other, whatever their points.
    """
    grid = np.round(points / max(float(np.abs(points).max()), 1e-12) * 1e6)
    _, _, place = unique_rows(grid)
    ends = np.stack([faces, np.roll(faces, -1, axis=1)], axis=-1)  # edge k from corner k to the next
    spot = np.sort(place[ends], axis=-1)
    key = spot[..., 0] * (int(place.max()) + 1) + spot[..., 1]
    marked = np.isin(key, np.unique(key[wanted]))
    own = np.sort(ends, axis=-1)
    edge_key = own[..., 0] * len(points) + own[..., 1]
    halves, index = np.unique(edge_key[marked], return_inverse=True)
    middle = np.full(faces.shape, -1, np.int64)
    middle[marked] = len(points) + index.reshape(-1)
    out = [faces[~marked.any(1)]]
    count = marked.sum(1)
    for turn in range(3):
        a, b, c = (np.roll(faces, -turn, axis=1)[:, k] for k in range(3))
        m = np.roll(middle, -turn, axis=1)
        on = np.roll(marked, -turn, axis=1)
        one = (count == 1) & on[:, 0]
        two = (count == 2) & on[:, 0] & on[:, 1]
        out += [np.stack(t, 1)[one] for t in ((a, m[:, 0], c), (m[:, 0], b, c))]
        out += [np.stack(t, 1)[two] for t in ((a, m[:, 0], c), (m[:, 0], b, m[:, 1]), (m[:, 0], m[:, 1], c))]
        if turn == 0:
            all_three = count == 3
            out += [
                np.stack(t, 1)[all_three]
                for t in ((a, m[:, 0], m[:, 2]), (m[:, 0], b, m[:, 1]), (m[:, 2], m[:, 1], c),
                          (m[:, 0], m[:, 1], m[:, 2]))
            ]  # fmt: skip
    return np.concatenate(out), np.stack([halves // len(points), halves % len(points)], 1)
