"""What eyes prefer of pairs of takes by lot is what the designer prefers, as far as it goes."""

from __future__ import annotations

import json
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from vdsl.pipeline import pairs

FOUND = Path(__file__).parents[2] / "docs" / "ranker" / "pairs.json"


def test_the_designer_prefers_what_eyes_did() -> None:
    """A hundred and fifty pairs, each looked at by three: more than with even weights, far from all."""
    judged = json.loads(FOUND.read_text("utf-8"))
    assert len(judged) == 150
    together = [pair for pair in judged if len(set(pair["votes"])) == 1]
    assert len(together) > 100
    assert pairs.agreement(judged) > 0.69
    assert pairs.agreement(together) > 0.74


def test_agreement_counts_pairs_with_a_majority() -> None:
    judged = json.loads(FOUND.read_text("utf-8"))
    one = next(pair for pair in judged if set(pair["votes"]) == {"A"})
    turned = one | {"measures": one["measures"][::-1]}
    assert pairs.agreement([one]) + pairs.agreement([turned]) == 1.0
    split = one | {"votes": ["A", "B", "="]}
    assert pairs.agreement([one, split]) == pairs.agreement([one])


@pytest.mark.parametrize("faultless", [6, 1])
def test_two_by_lot_look_different_and_have_no_fault_where_there_are_such(
    faultless: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    cameras: list[Any] = [SimpleNamespace(at=k) for k in range(12)]
    monkeypatch.setattr(pairs, "judged", lambda found: np.where(np.arange(len(found)) < faultless, 0.5, -1.0))
    monkeypatch.setattr(pairs, "unlike", lambda found, first: [i for i in range(12) if abs(i - first) > 1])
    drawn = [pairs.two_by_lot(cameras, np.random.default_rng(seed)) for seed in range(40)]
    assert all(abs(a - b) > 1 for a, b in drawn)
    inside = [max(a, b) < faultless for a, b in drawn]
    assert all(inside) if faultless > 3 else not any(inside)
