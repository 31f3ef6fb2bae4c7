"""One thing is made while the last is used."""

from __future__ import annotations

import threading

import pytest

from vdsl.pipeline.ahead import one_ahead


def test_the_next_is_made_while_the_last_is_used() -> None:
    begun = [threading.Event() for _ in range(3)]

    def make(k: int) -> int:
        begun[k].set()
        return k * k

    out = []
    for k, made in one_ahead(make, range(3)):
        if k < 2:
            assert begun[k + 1].wait(10)  # without our asking for it
        out.append((k, made))
    assert out == [(0, 0), (1, 1), (2, 4)]
    assert list(one_ahead(make, [])) == []


def test_what_goes_wrong_comes_in_its_turn() -> None:
    made = one_ahead(lambda k: 1 // k, [2, 1, 0, 3])
    assert [next(made), next(made)] == [(2, 0), (1, 1)]
    with pytest.raises(ZeroDivisionError):
        next(made)
