"""What eyes prefer of four takes of a line is what the designer prefers, as far as it goes."""

from __future__ import annotations

import json
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from vdsl.cinema.measures import MEASURES
from vdsl.cinema.score import geometry_scores
from vdsl.pipeline import preferred

KEPT = Path(__file__).parents[2] / "docs" / "ranker" / "preferred.json"


@pytest.fixture(scope="module")
def found() -> dict[str, Any]:
    return dict(json.loads(KEPT.read_text("utf-8")))


def test_the_designer_and_the_geometry_prefer_what_eyes_did(found: dict[str, Any]) -> None:
    """Two hundred lines, each looked at by two: more than by any of its parts, far from all."""
    assert found["measures"] == list(MEASURES)
    assert len(found["lines"]) == 200
    assert all(len(line["orders"]) == 2 for line in found["lines"])
    by_designer, count = preferred.agreement(found, preferred.designers)
    by_geometry, _ = preferred.agreement(found, geometry_scores)
    assert count > 1000
    assert by_designer > 0.77
    assert by_geometry > 0.8
    for name in MEASURES:
        alone = (preferred.agreement(found, lambda m, name=name, s=s: s * m[name])[0] for s in (1, -1))
        assert max(alone) < by_designer, name


def test_agreement_counts_what_all_prefer() -> None:
    line = {"orders": ["C>A=D>B", "C>B>A>D"], "measures": [[0.2], [0.1], [0.9], [0.3]]}
    assert set(preferred.two_of_line(line)) == {(2, 0), (2, 1), (2, 3)}
    share, count = preferred.agreement({"measures": ["x"], "lines": [line]}, lambda m: m["x"])
    assert (share, count) == (1.0, 3)
    assert preferred.agreement({"measures": ["x"], "lines": [line]}, lambda m: -m["x"])[0] == 0.0
    with pytest.raises(ValueError, match="everybody"):
        preferred.agreement({"measures": ["x"], "lines": []}, lambda m: m["x"])


def test_an_order_names_every_take_once() -> None:
    assert preferred.placed("C>A=D>B") == (1, 2, 0, 1)
    for wrong in ("A>B>C", "A>B>C>E", ""):
        with pytest.raises(ValueError, match="no order"):
            preferred.placed(wrong)


def test_four_takes_are_the_firsts_and_others_that_look_different(monkeypatch: pytest.MonkeyPatch) -> None:
    cameras: list[Any] = [SimpleNamespace(measures={"at": k}) for k in range(12)]
    monkeypatch.setattr(preferred, "judged", lambda found: np.arange(12.0))
    monkeypatch.setattr(preferred, "prior", lambda measures: float(measures["at"] == 4))
    monkeypatch.setattr(
        preferred, "unlike", lambda found, first: [i for i in range(12) if abs(i - first) > 1]
    )
    for seed in range(20):
        four = preferred.four_takes(cameras, np.random.default_rng(seed))
        assert {11, 4} <= set(four)
        assert len(set(four)) == 4
        assert min(abs(a - b) for a in four for b in four if a != b) > 1
    monkeypatch.setattr(preferred, "unlike", lambda found, first: [])
    assert len(set(preferred.four_takes(cameras, np.random.default_rng(0)))) == 4
