"""Products of many short vectors, and bounds of few numbers: over an axis of two or three numpy's own
reductions are slow, and so is its ``clip`` of little."""

from __future__ import annotations

from contextlib import suppress
from typing import Any

import numpy as np
from numpy.typing import NDArray

einsum: Any = np.einsum
with suppress(ImportError):  # what that calls in the end: with few numbers, its own checks take half the time
    from numpy._core.multiarray import c_einsum as einsum

Array = NDArray[np.float64]


def dot(a: Array, b: Array) -> Array:
    """[..., K], [..., K] -> [...], broadcast."""
    return np.asarray(einsum("...i,...i->...", a, b))


def clamped(values: Array, low: float, high: float) -> Array:
    """Values within bounds, of any shape."""
    return np.minimum(np.maximum(values, low), high)


def length(vectors: Array) -> Array:
    """[..., K] -> [...]"""
    return np.asarray(np.sqrt(dot(vectors, vectors)))
