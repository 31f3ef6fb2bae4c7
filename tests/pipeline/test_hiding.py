"""Picks hidden among proposals: whom the designer picks of all, and how high they are said to come."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path

import numpy as np
import pytest

from ranker.evaluate import spearman
from ranker.infer import Ranker
from vdsl.pipeline import dataset, hiding
from vdsl.pipeline.hiding import Scored, _read, best_of_all, hide, told

HEAD = {"seed": 0, "look": 1, "schema": 4}


def shot(name: str, opinions: list[float], choices: list[int], margins: list[float]) -> Scored:
    count = len(opinions)
    flat = [0.0] * count
    return Scored(name, choices[0], choices, opinions, flat, margins, flat, {"geometry score": opinions})


def hundred(best: float, others: float) -> list[float]:
    return [best, best - 0.01, *[others] * 98]


def test_one_in_a_hundred_is_picked_the_best_liked_of_any_shot() -> None:
    good, poor = hundred(0.95, 0.6), hundred(0.5, -2.0)
    shots = [shot("poor", poor, [0, 1], poor), shot("good", good, [0, 1], good)]
    best = best_of_all(shots)
    assert best.nonzero()[0].tolist() == [100, 101]
    alike = [shots[0], shot("good", good, [0], good)]  # the second looks like the first
    assert best_of_all(alike).nonzero()[0].tolist() == [0, 100]


def test_how_high_picks_come_is_told_of_the_ranker_and_with_the_prior() -> None:
    good, poor = hundred(0.95, 0.6), hundred(0.5, -2.0)
    blind = [0.0] * 100
    found = told([shot("poor", poor, [0], poor), shot("good", good, [0, 1], blind)])
    assert (found["picks"], found["proposals"]) == (2, 200)
    assert found["picks_in_top_10pct"] == 0.0  # equals count as the lowest
    assert found["best_of_each_shot"]["designer"]["picks_in_top_10pct"] == 0.5
    assert found["agreement"]["ranker"]["top_1"] == pytest.approx((1 + 1 / 100) / 2)
    assert found["agreement"]["geometry score"]["top_1"] == 1.0
    seen = [Scored(**{**asdict(s), "priors": s.opinions}) for s in (shot("good", good, [0, 1], blind),)]
    assert told(seen)["with_prior"]["picks_in_top_10pct"] == 1.0
    assert found["by_p_b"]["picks_median_rank_pct"] == 100.0  # it says the same of all
    assert told([])["picks"] == 0


def test_what_was_scored_before_is_gone_on_with_and_of_another_kind_left(tmp_path: Path) -> None:
    kept, scored = tmp_path / "kept.jsonl", shot("a", hundred(0.9, 0.1), [0], hundred(0.9, 0.1))
    text = json.dumps(HEAD) + "\n" + json.dumps(asdict(scored)) + "\n"
    kept.write_text(text + '{"shot": "cut o', "utf-8")
    assert _read(kept, HEAD) == ([scored], {"a"})
    assert kept.read_text("utf-8") == text
    assert _read(kept, HEAD | {"look": 2}) == ([], set())
    assert not kept.exists()


def test_by_guides_alone_proposals_come_in_nearly_the_order_of_pictures(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(hiding, "_A_SHOT", 24)
    ranker = Ranker.load(device="cpu")
    kept = tmp_path / "guides.jsonl"
    (by_guides,) = hide(ranker, kept, 1, device="cpu", pictures=False)
    (by_pictures,) = hide(ranker, tmp_path / "pictures.jsonl", 1, device="cpu")
    assert by_guides.opinions == by_pictures.opinions
    assert len(by_guides.margins) > 10
    alike = spearman(np.array(by_guides.margins), np.array(by_pictures.margins))
    assert alike is not None
    assert alike > 0.97
    monkeypatch.setattr(hiding, "_scored", None)  # what was scored is not scored again
    assert hide(ranker, kept, 1, device="cpu", pictures=False) == [by_guides]
    monkeypatch.setattr(dataset, "_RECIPE", -1)  # by another designer it is
    with pytest.raises(TypeError):
        hide(ranker, kept, 1, device="cpu", pictures=False)
