"""Products of many short vectors at once; numpy's own reductions are slow over an axis of two or three."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def dot(a: Array, b: Array) -> Array:
    """[..., K], [..., K] -> [...], broadcast."""
    return np.asarray(np.einsum("...i,...i->...", a, b))


def length(vectors: Array) -> Array:
    """[..., K] -> [...]"""
    return np.asarray(np.sqrt(dot(vectors, vectors)))
