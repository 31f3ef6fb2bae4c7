"""Which triangles share an edge, so that a surface can be followed to where it ends.

Corners count as one where they are at one place, whatever normals and colours they have: meshes keep a corner
for each. Assumes finite vertices.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

_NEAR = 2e-5  # metres within which two corners are one
_ODD = np.array([0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9], np.uint64)  # for hashing


def beside(
    vertices: NDArray[np.floating], faces: NDArray[np.int32], piece: NDArray[np.int32]
) -> NDArray[np.int32]:
    """For each edge of each triangle the other triangle that has it, int32 [F, 3]; -1 where there is none.

    vertices: [V, 3], metres; faces: [F, 3]; edges go from the first corner to the second, the second to the
    third, the third to the first; piece: [F] or [F, K], only triangles of the same are joined. An edge of
    more than two triangles joins none.
    """
    out = np.full((len(faces), 3), -1, np.int32)
    if not len(faces):
        return out
    place = np.rint(vertices[faces.reshape(-1)].astype(np.float64) / _NEAR).astype(np.int64)
    own = np.repeat(piece.reshape(len(faces), -1), 3, axis=0)
    corner = np.unique(_hashed(place, own), return_inverse=True)[1].reshape(-1, 3)
    ends = np.stack([corner, np.roll(corner, -1, axis=1)], axis=-1).reshape(-1, 2)
    low, high = ends.min(axis=1), ends.max(axis=1)
    key = low * np.int64(corner.max() + 1) + high
    order = np.argsort(key, kind="stable")
    ranked = key[order]
    first = np.flatnonzero(np.concatenate([[True], ranked[1:] != ranked[:-1]]))
    count = np.diff(np.append(first, len(ranked)))
    pairs = first[count == 2]
    one, other = order[pairs], order[pairs + 1]
    whole = (low[one] != high[one]) & (one // 3 != other // 3)
    one, other = one[whole], other[whole]
    flat = out.reshape(-1)
    flat[one], flat[other] = other // 3, one // 3
    return out


def _hashed(*columns: NDArray[np.integer]) -> NDArray[np.uint64]:
    """A number for each row; different ones for different rows, but for one case in 2^64."""
    out = np.zeros(len(columns[0]), np.uint64)
    for table in columns:
        for column in table.T:
            out = (out ^ column.astype(np.int64).view(np.uint64)) * _ODD[0]
            out ^= out >> np.uint64(29)
            out = out * _ODD[1] + _ODD[2]
    return out
