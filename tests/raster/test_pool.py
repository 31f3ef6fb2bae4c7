"""Memory of pictures comes back when nobody has them, and only then."""

from __future__ import annotations

from runtime.raster.pool import KEPT, Pool


def test_memory_comes_back_only_when_nobody_has_it() -> None:
    pool = Pool()
    first = pool.bytes((4, 6, 3))
    place = first.ctypes.data
    assert place % 64 == 0
    part = first[1, 2:]
    second = pool.bytes((4, 6, 3))
    assert second.ctypes.data != place
    del first
    assert pool.bytes((4, 6, 3)).ctypes.data != place, "a part of it is still looked at"
    del part
    again = pool.bytes((2, 6, 3))
    assert again.ctypes.data == place
    assert again.shape == (2, 6, 3)


def test_only_a_few_blocks_are_kept() -> None:
    pool = Pool()
    held = [pool.bytes((10,)) for _ in range(KEPT + 4)]
    assert len({a.ctypes.data for a in held}) == len(held)
    assert len(pool._blocks) == KEPT
