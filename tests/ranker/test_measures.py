"""What evaluation says: orders, hidden picks, agreement, and the curves of a training."""

from __future__ import annotations

import json
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np
import pytest
import torch
from ranker_clips import model_config, write_clips
from scipy.stats import spearmanr

from ranker.ablation import diversity, table
from ranker.curves import draw_curves
from ranker.data import Dataset
from ranker.evaluate import agreement, agreement_with_fp32, evaluate, hidden, spearman
from ranker.infer import Ranker
from ranker.model import ShotRanker


def test_spearman_is_the_usual_one() -> None:
    rng = np.random.default_rng(2)
    one, two = rng.integers(0, 9, 60).astype(float), rng.normal(size=60)
    assert spearman(one, two) == pytest.approx(spearmanr(one, two).statistic)
    assert spearman(two, np.exp(two)) == pytest.approx(1.0)
    assert spearman(np.ones(4), two[:4]) is None


def test_hidden_picks_are_counted_from_the_top() -> None:
    scores = np.arange(100.0)
    picked = np.zeros(100, bool)
    picked[[99, 95, 50]] = True
    found = hidden(scores, picked)
    assert found["picks_in_top_10pct"] == pytest.approx(2 / 3)
    assert found["picks_median_rank_pct"] == pytest.approx(5.0)
    level = hidden(np.zeros(100), picked)
    assert level == {"picks_in_top_10pct": 0.0, "picks_median_rank_pct": 100.0}
    assert hidden(scores, np.zeros(100, bool))["picks_in_top_10pct"] is None


def test_agreement_is_counted_shot_by_shot_and_against_chance() -> None:
    shots = ["a"] * 10 + ["b"] * 20
    picked = np.zeros(30, bool)
    picked[[3, 12]] = True
    knows = picked.astype(float)
    misses = np.arange(30.0)  # the pick of a is seventh, that of b eighteenth
    found = agreement({"knows": knows, "misses": misses, "level": np.zeros(30)}, picked, shots)
    assert found["chance"] == {"top_1": pytest.approx(0.075), "top_5": pytest.approx(0.375)}
    assert found["knows"] == {"top_1": 1.0, "top_5": 1.0}
    assert found["misses"] == {"top_1": 0.0, "top_5": 0.0}
    assert found["level"] == found["chance"]


def test_a_ranker_is_measured_on_whole_sets(tmp_path: Path) -> None:
    torch.manual_seed(1)
    model = ShotRanker(model_config()).eval()
    write_clips(tmp_path, 12)
    data = Dataset(tmp_path)
    clips = np.arange(len(data))
    ranker = Ranker(model, "cpu")
    found = evaluate(ranker, data, clips)
    again = evaluate(ranker, data, clips[::-1])
    assert found["auc"] == again["auc"]
    assert set(found["auc_by_strength"]) == {"0.25", "0.5", "0.75", "1"}
    close = agreement_with_fp32(model, ranker, data, clips)
    assert close is not None
    assert close > 0.9
    apart = diversity(ranker, data, clips)
    assert apart is not None
    assert 0 < apart < 2
    assert "L_b + L_q" in table({"b+q": found | {"diversity": apart}})


def test_what_was_passed_over_counts_apart_from_what_was_spoilt(tmp_path: Path) -> None:
    torch.manual_seed(2)
    model = ShotRanker(model_config()).eval()
    write_clips(tmp_path, 24)
    plain = evaluate(Ranker(model, "cpu"), Dataset(tmp_path), np.arange(24))
    assert plain["auc"] == plain["auc_all"]
    told = []
    for path in sorted(tmp_path.glob("shard-*.jsonl")):
        lines = [json.loads(line) for line in path.read_text("utf-8").splitlines()]
        for k, line in enumerate(line for line in lines if not line["professional"]):
            line["about"] = line["about"] | {"kind": "passed-over" if k % 2 else "perturbed"}
        told += lines
        path.write_text("".join(json.dumps(line) + "\n" for line in lines), "utf-8")
    assert sum(not line["professional"] for line in told) > 4
    found = evaluate(Ranker(model, "cpu"), Dataset(tmp_path), np.arange(24))
    assert found["auc"] == found["auc_by_kind"]["perturbed"]
    assert found["auc_all"] == plain["auc"]
    assert set(found["auc_by_kind"]) == {"passed-over", "perturbed"}


def test_curves_are_drawn_of_every_epoch_once(tmp_path: Path) -> None:
    lines = [
        {"epoch": e, "epochs": 3, "loss": 2.0 / n, "binary": 0.5, "class": 1.0, "contrast": None,
         "hint": 0.3 / n, "order": 0.0,
         "held_out": {"professional": 0.5 + e / 10, "movement": None}}
        for n, e in enumerate((1, 2, 2, 3), 1)
    ]  # fmt: skip
    (tmp_path / "log.jsonl").write_text("".join(json.dumps(x) + "\n" for x in [*lines, {"measured": {}}]))
    draw_curves(tmp_path)
    drawing = ElementTree.parse(tmp_path / "curves.svg").getroot()
    curves = [e.attrib["points"].split() for e in drawing.iter() if e.tag.endswith("polyline")]
    assert [len(points) for points in curves] == [3, 3, 3, 3, 3]
    width = float(drawing.attrib["viewBox"].split()[2])
    for label in (e for e in drawing.iter() if e.tag.endswith("text") and "text-anchor" not in e.attrib):
        assert float(label.attrib["x"]) + 7.5 * len(label.text or "") < width, label.text
    said = "".join(drawing.itertext())
    assert "professional 0.8" in said
    assert "hint" in said
    assert "order" not in said  # what is left out of a training is no curve
