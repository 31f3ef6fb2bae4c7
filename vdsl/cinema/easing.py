"""The paper's easing of a movement's rhythm."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def ease(t: NDArray[np.float64] | float, lam: NDArray[np.float64] | float) -> NDArray[np.float64]:
    """``w_λ(t) = (λ^t − 1)/(λ − 1)``, and ``t`` for λ = 1 (the paper's easing function, section 3.2).

    t: 0..1; lam: positive, broadcast against ``t``. Near λ = 1 the limit is taken through ``expm1``,
    so the function is continuous in λ to machine precision.
    """
    t, lam = np.broadcast_arrays(np.asarray(t, np.float64), np.asarray(lam, np.float64))
    if (lam <= 0).any():
        raise ValueError("easing: λ must be positive")
    rate = np.log(lam)
    even = np.abs(rate) < 1e-12
    safe = np.where(even, 1.0, rate)
    return np.asarray(np.where(even, t, np.expm1(safe * t) / np.expm1(safe)))


def clock(frames: int) -> NDArray[np.float64]:
    """``t/(T − 1)`` for every frame: 0..1, [T]; a single frame is at 0."""
    return np.arange(frames) / max(frames - 1, 1)
