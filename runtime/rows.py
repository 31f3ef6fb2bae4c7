"""Which rows of an array are alike. numpy compares rows as wholes, which of many rows of a few numbers is
several times as slow."""

from __future__ import annotations

from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

Scalar = TypeVar("Scalar", bound=np.generic)

_MOST = 1 << 62  # of a key


def unique_rows(rows: NDArray[Scalar]) -> tuple[NDArray[Scalar], NDArray[np.int64], NDArray[np.int64]]:
    """The different rows of ``rows`` [N, K] in rising order [U, K], where each is found first [U], and which
    of them every row is [N]: ``np.unique(rows, axis=0, return_index=True, return_inverse=True)`` of rows
    without NaN."""
    key, most = np.zeros(len(rows), np.int64), 1
    for column in rows.T:
        values, rank = np.unique(column, return_inverse=True)
        if most * max(len(values), 1) > _MOST:
            key = np.unique(key, return_inverse=True)[1].reshape(-1)
            most = int(key.max(initial=0)) + 1
        key, most = key * len(values) + rank.reshape(-1), most * max(len(values), 1)
    _, first, inverse = np.unique(key, return_index=True, return_inverse=True)
    return rows[first], first, inverse.reshape(-1)
