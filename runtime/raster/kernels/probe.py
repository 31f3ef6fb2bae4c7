"""Whether a driver does what the rasteriser needs of it.

Assumes Taichi has been started. Mesa's lavapipe 22.3, for one, leaves a loop at its second
atomic operation, so that all but small triangles would have holes.
"""

# mypy: ignore-errors
# Taichi reads annotations as kernel types and parses the bodies itself.

import numpy as np
import taichi as ti

LANES = 32
TURNS = 9


@ti.kernel
def keep_largest(out: ti.types.ndarray(ti.u64, ndim=1)):
    """Fill LANES x TURNS numbers by atomic maxima in loops of different lengths, as triangles are filled."""
    for i in range(LANES):
        for x in range(i % TURNS, TURNS):
            ti.atomic_max(out[i * TURNS + x], (ti.u64(1) << 32) | ti.cast(x + 1, ti.u64))


def sound() -> bool:
    """Whether 64-bit atomic maxima inside loops come out right."""
    out = ti.ndarray(ti.u64, shape=(LANES * TURNS,))
    out.fill(0)
    keep_largest(out)
    x = np.arange(TURNS, dtype=np.uint64)
    drawn = x[None] >= np.arange(LANES, dtype=np.uint64)[:, None] % np.uint64(TURNS)
    expected = np.where(drawn, np.uint64(1 << 32) | (x + np.uint64(1)), np.uint64(0))
    return bool((out.to_numpy().reshape(LANES, TURNS) == expected).all())
