"""What stands beside the chosen take in the sheets that are looked at without the key."""

from __future__ import annotations

from typing import Any

import pytest

from vdsl.pipeline import blind


def test_beside_two_choices_stand_the_same_takes(monkeypatch: pytest.MonkeyPatch) -> None:
    cameras: list[Any] = list(range(20))
    monkeypatch.setattr(blind, "unlike", lambda found, first: [i for i in found if abs(i - first) > 1])
    lots = [[blind.drawn(cameras, chosen, 0, line) for line in range(40)] for chosen in (3, 12)]
    assert lots[0] == [blind.drawn(cameras, 3, 0, line) for line in range(40)]
    beside = [
        [i for sides in some for i in sides if i != chosen]
        for some, chosen in zip(lots, (3, 12), strict=True)
    ]
    assert all(abs(i - 3) > 1 for i in beside[0])
    assert sum(one == two for one, two in zip(*beside, strict=True)) > 20
    assert len(set(beside[0])) > 10
    assert {sides[0] == 3 for sides in lots[0]} == {True, False}
