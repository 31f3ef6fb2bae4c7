"""Products of many short vectors, and bounds of few numbers: over an axis of two or three numpy's own
reductions are slow, and so is its ``clip`` of little."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def dot(a: Array, b: Array) -> Array:
    """[..., K], [..., K] -> [...], broadcast."""
    return np.asarray(np.einsum("...i,...i->...", a, b))


def clamped(values: Array, low: float, high: float) -> Array:
    """Values within bounds, of any shape."""
    return np.minimum(np.maximum(values, low), high)


def length(vectors: Array) -> Array:
    """[..., K] -> [...]"""
    return np.asarray(np.sqrt(dot(vectors, vectors)))
