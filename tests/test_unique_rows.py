"""Rows that are alike, found as numpy finds them."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from runtime.rows import unique_rows

LOT = np.random.default_rng(3)


@pytest.mark.parametrize(
    "rows",
    [
        LOT.integers(-4, 4, (500, 3)),
        LOT.integers(0, 9, (500, 3)).astype(np.float32) / 7,
        LOT.integers(0, 2, (200, 6)).astype(bool),
        LOT.integers(-(2**62), 2**62, (300, 5)),  # more than fits into a key at once
        np.repeat(LOT.integers(-(2**62), 2**62, (30, 5)), 4, axis=0),
        np.array([[0.0, 1.0], [-0.0, 1.0]]),
        np.zeros((0, 3)),
    ],
    ids=["whole", "single", "truth", "wide", "wide and alike", "minus nothing", "none"],
)
def test_rows_are_told_apart_as_numpy_does(rows: NDArray[np.generic]) -> None:
    found = unique_rows(rows)
    expected = np.unique(rows, axis=0, return_index=True, return_inverse=True)
    for ours, theirs in zip(found, expected, strict=True):
        np.testing.assert_array_equal(ours, theirs.reshape(ours.shape))
    np.testing.assert_array_equal(found[0][found[2]], rows)
