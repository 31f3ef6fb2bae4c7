"""The same training with and without L_c and L_q, as one call."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
import torch
from ranker_clips import TINY, write_clips

from ranker.ablation import ablate
from ranker.config import Phase
from ranker.train import train
from ranker.weights import load_model

SHORT = replace(TINY, phases=(Phase(2, 32, 2, 2, batch=16),), held_out=0.3, watched=8)


def test_four_trainings_differ_in_their_losses_alone_and_are_told_side_by_side(tmp_path: Path) -> None:
    write_clips(tmp_path / "clips", 40)
    lines: list[dict[str, Any]] = []
    found = ablate(tmp_path / "clips", tmp_path / "out", SHORT, lines.append)
    assert list(found) == ["b", "b+c", "b+q", "b+c+q"]
    assert json.loads((tmp_path / "out" / "ablation.json").read_text("utf-8")) == found
    rows = (tmp_path / "out" / "ablation.md").read_text("utf-8").splitlines()
    assert [row.split(" | ")[0] for row in rows[2:]] == [
        "| L_b",
        "| L_b + L_c",
        "| L_b + L_q",
        "| L_b + L_c + L_q",
    ]
    for name, measured in found.items():
        assert measured["clips"] > 0
        assert measured["diversity"] > 0
        recipe = load_model(tmp_path / "out" / name / "weights")[1].training
        assert (recipe["class_weight"] > 0, recipe["contrast_weight"] > 0) == ("c" in name, "q" in name)
        logged = [json.loads(line) for line in (tmp_path / "out" / name / "log.jsonl").open(encoding="utf-8")]
        contrast = [line["contrast"] for line in logged if "epoch" in line]
        assert all(value > 0 for value in contrast) == ("q" in name)

    lines.clear()
    assert (
        ablate(tmp_path / "clips", tmp_path / "out", SHORT, lines.append) == found
    )  # nothing is taught again
    assert not any("epoch" in line for line in lines)


def test_half_precision_teaches_too_and_weights_stay_whole(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Where a machine is quicker by it, networks compute in bfloat16 while they learn."""
    monkeypatch.setattr("ranker.train.quick_bfloat16", lambda kind: True)
    used: list[torch.dtype] = []
    first = torch.nn.Conv2d.forward

    def watched(self: torch.nn.Conv2d, pictures: torch.Tensor) -> torch.Tensor:
        out = first(self, pictures)
        if self.training:
            used.append(out.dtype)
        return out

    monkeypatch.setattr(torch.nn.Conv2d, "forward", watched)
    write_clips(tmp_path / "clips", 40)
    lines: list[dict[str, Any]] = []
    config = replace(TINY, phases=(Phase(8, 32, 2, 2, batch=16),), autocast=True)
    train(tmp_path / "clips", tmp_path / "out", config, lines.append)
    assert set(used) == {torch.bfloat16}
    losses = [line["binary"] for line in lines if "epoch" in line]
    assert losses[-1] < 0.7 * losses[0]
    model = load_model(tmp_path / "out" / "weights")[0]
    assert {p.dtype for p in model.parameters()} == {torch.float32}
