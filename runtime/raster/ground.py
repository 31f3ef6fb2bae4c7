"""How closely things stand over the floor and over furniture: cells that contact shadows are looked up in.

Guarantees that the cells of a moment depend on its palette alone. On a processor cells that hold nothing but
what rests are left as they are from call to call while that is the same: written anew are those around
people, of a beach as many as of a room.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .device import Backend
from .loaded import Loaded

Buffers = Callable[[str, tuple[int, ...], type], Any]


class Ground:
    """cells: float32 [(M + 1) * 2 * rows * columns] of M moments and of one more in which only what rests is
    there: two layers, the floor and the tops of furniture
    stained: int32 [M', 2 * 4], of each moment and layer the first column and the one after the last, and the
    first row and the one after the last, of cells with more than what rests, maybe. On the host only
    """

    def __init__(self, backend: Backend, buffer: Buffers) -> None:
        from .kernels import contact  # only now: it imports taichi

        self._backend, self._buffer, self._contact = backend, buffer, contact
        self.cells: Any = None
        self.stained = np.zeros((0, 8), np.int32)
        self._grid = (1, 1)  # rows and columns
        self._rests: NDArray[np.float32] | None = None  # what all cells hold that are not stained

    def reserve(self, rows: int, columns: int, moments: int) -> None:
        """Room for so many moments and the one in which nobody is there."""
        grid, have = (rows, columns), self.cells
        self.cells = self._buffer("ground", ((moments + 1) * 2 * rows * columns,), np.float32)
        if self._backend.on_host and (self.cells is not have or grid != self._grid):
            room = len(self.cells) // (2 * rows * columns)
            self.stained, self._rests = np.zeros((room, 8), np.int32), None
        self._grid = grid

    def clear(self) -> None:
        """Nothing stands anywhere in any moment."""
        nothing = self._rests is not None and not self._rests.any() and not self.stained.any()
        if not (self._backend.on_host and nothing):
            self.cells.fill(0.0)
            self.stained[:], self._rests = 0, np.zeros(2 * self._grid[0] * self._grid[1], np.float32)

    def of(self, moment: int) -> NDArray[np.float32]:
        """The cells of a moment. On the host only."""
        size = 2 * self._grid[0] * self._grid[1]
        cells: NDArray[np.float32] = self.cells[moment * size : (moment + 1) * size]
        return cells

    def count(self, loaded: Loaded, position: Any, moments: int, moving: NDArray[np.bool_]) -> None:
        """Find what stands where; of what rests, once. position: float32 [M + 1, V, 3]; moving: bool [V]"""
        runs, resting = loaded.rig.touching(moving)
        cells = 2 * self._grid[0] * self._grid[1]
        base = self._buffer("resting", (cells,), np.int32)
        if not len(resting):
            base.fill(0)
        if not self._backend.on_host:
            if len(resting):
                nothing = self._buffer("nothing", (cells,), np.int32)
                self._touch_on_gpu(loaded, position, resting, 1, nothing, base)
            counted = self._buffer("counted", (moments * cells,), np.int32)
            self._touch_on_gpu(loaded, position, runs, moments, base, counted)
            return
        if len(resting):
            self._touch(loaded, position, resting, 1, base, -1)
            self.of(moments)[:] = self.of(0)
            self.stained[0] = 0
        else:
            self.of(moments)[:] = 0.0
        if self._rests is None or not np.array_equal(self._rests, self.of(moments)):
            self.stained[:] = 2 * (0, self._grid[1], 0, self._grid[0])
            self._rests = self.of(moments).copy()
        self.stained[moments] = 0
        self._touch(loaded, position, runs, moments, base, moments)

    def bounds(self, moments: int) -> NDArray[np.int32]:
        """First and last column, first and last row of the stained cells of both layers, int32 [M, 4]."""
        left, right, low, high = np.moveaxis(self.stained[:moments].reshape(-1, 2, 4), 2, 0)
        empty = right <= left
        rows, columns = self._grid
        first = [np.where(empty, end, at).min(axis=1) for at, end in ((left, columns), (low, rows))]
        last = [np.where(empty, 0, at).max(axis=1) - 1 for at in (right, high)]
        return np.stack([first[0], last[0], first[1], last[1]], axis=1).astype(np.int32)

    def _touch(
        self, loaded: Loaded, position: Any, runs: NDArray[np.int32], moments: int, base: Any, still: int
    ) -> None:
        """What the vertices of runs leave in moments, over what rests, as it is in ``base`` and in the cells
        of moment ``still``; into ``base`` where that is -1."""
        a, (rows, columns) = loaded.arrays, self._grid
        queue, slots, host = self._backend.crew(moments)
        stretch = slots // self._backend.threads
        spare = self._buffer("spare", (slots // stretch * rows * columns * 5,), np.int32)
        nothing = self._buffer("nothing", (2 * rows * columns,), np.int32)
        resting, counted = (nothing, base) if still < 0 else (base, nothing)
        self._contact.touch(
            position, a["area"], a["solid"], self._backend.upload(runs), moments,
            a["floor"], a["tops"], loaded.highest, columns, rows,
            resting, still, spare, counted, self.stained, self.cells, queue, slots, stretch, host,
        )  # fmt: skip

    def _touch_on_gpu(
        self, loaded: Loaded, position: Any, runs: NDArray[np.int32], moments: int, begin: Any, out: Any
    ) -> None:
        """The same over ``begin``, in whole numbers into ``out``."""
        a, (rows, columns) = loaded.arrays, self._grid
        spare = self._buffer("spare", (moments * 2 * rows * columns,), np.int32)
        listed = [np.arange(first, end, dtype=np.int32) for first, end in runs]
        some = np.concatenate(listed) if listed else np.zeros(0, np.int32)
        self._contact.touch_atomic(
            position, a["area"], a["solid"], self._backend.upload(some), len(some), moments,
            a["floor"], a["tops"], loaded.highest, columns, rows, begin, spare, out, self.cells,
        )  # fmt: skip
