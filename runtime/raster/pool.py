"""Memory for finished pictures, used again when nobody looks at it any more.

Fresh memory is dear: the system clears each page as it is first written to, which costs as much as
writing a picture's bytes. Guarantees never to hand out memory that an array still refers to.
"""

from __future__ import annotations

import sys

import numpy as np
from numpy.typing import NDArray

KEPT = 3  # blocks
LINE = 64  # bytes; where blocks begin, as kernels of vectors want it
LARGEST = 64 << 20  # bytes of a block that is kept
UNSHARED = 3  # references to a block that nobody has: the list's, the loop's and the count's own


class Pool:
    """A few blocks of memory that come back by themselves when the arrays made of them are gone."""

    def __init__(self) -> None:
        self._blocks: list[NDArray[np.uint8]] = []

    def bytes(self, shape: tuple[int, ...]) -> NDArray[np.uint8]:
        """An uninitialised uint8 array."""
        count = int(np.prod(shape))
        for block in self._blocks:
            if len(block) >= count + LINE and sys.getrefcount(block) == UNSHARED:
                break
        else:
            block = np.empty(count + LINE, np.uint8)
            if count <= LARGEST:
                self._blocks = [*self._blocks[-(KEPT - 1) :], block]
        begin = -block.ctypes.data % LINE
        return block[begin : begin + count].reshape(shape)
