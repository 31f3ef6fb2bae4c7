"""What ``vdsc evaluate`` says, key by key."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from ranker.data import ShardWriter
from vdsl.cli import app
from vdsl.pipeline.dataset import made
from vdsl.pipeline.hiding import Scored
from vdsl.pipeline.labels import WORDS

CLIPS = 10


def write(folder: Path) -> None:
    """Clips of noise for testing, in which the good ones are grey: films of cameras, without guides."""
    rng = np.random.default_rng(0)
    with ShardWriter(folder, WORDS, (224, 224), 8, made=made(0)) as writer:
        for n in range(CLIPS):
            good = n % 2 == 0
            frames = rng.integers(0, 255, (8, 224, 224, 3), dtype=np.uint8)
            frames[:] = 128 if good else frames
            kind = "designer" if good else ("perturbed", "passed-over")[n // 2 % 2]
            words = ("static", "medium", "eye-level") if good else (None, None, None)
            writer.add(frames, good, *words, "park", 0.0 if good else 0.3, "test", {"kind": kind})


def hidden(*_: object) -> list[Scored]:
    """Two shots of a hundred, of which the ranker puts the best first."""
    liked = [1.0 - 0.02 * n for n in range(100)]
    flat = [0.0] * 100
    return [Scored(name, 0, [0], liked, flat, liked, flat, {"geometry score": flat}) for name in "ab"]


@pytest.fixture
def data(tmp_path: Path) -> Path:
    write(tmp_path / "data")
    return tmp_path / "data"


def test_an_evaluation_has_the_keys_that_are_promised(data: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("vdsl.pipeline.evaluating.hide", hidden)
    result = CliRunner().invoke(app, ["evaluate", str(data), "--exact", "3", "--json"])
    assert result.exit_code == 0, result.output
    found = json.loads(result.stdout)
    assert found["schema"] == "vds.evaluation/1"
    assert set(found["auc_by_strength"]) == {"0.25", "0.5", "0.75", "1"}
    assert set(found["accuracy"]) == {"movement", "scale", "angle", "professional"}
    assert (found["picks"], found["proposals"], found["clips"]) == (2, 200, CLIPS)
    assert found["picks_in_top_10pct"] == 1.0  # a share
    assert found["picks_median_rank_pct"] == 1.0  # per cent
    assert found["agreement"]["ranker"] == {"top_1": 1.0, "top_5": 1.0}
    assert found["agreement"]["chance"] == {"top_1": 0.01, "top_5": 0.05}
    for told in (found, found["by_pictures_alone"]):
        assert 0 <= told["auc"] <= 1
        assert -1 <= told["spearman_fp32"] <= 1
        assert 0 <= told["accuracy"]["movement"] <= 1
    # Nothing is known of films of cameras but what they show.
    assert found["auc"] == found["by_pictures_alone"]["auc"]
    assert found["accuracy"] == found["by_pictures_alone"]["accuracy"]


def test_an_evaluation_is_told_in_lines_too(data: Path) -> None:
    result = CliRunner().invoke(app, ["evaluate", str(data), "--exact", "0", "--proposals", "0"])
    assert result.exit_code == 0, result.output
    lines = {line[:24].strip(): line[24:].strip() for line in result.stdout.splitlines()}
    assert lines["clips for testing"] == str(CLIPS)
    assert "by pictures alone" in result.stdout
    empty = CliRunner().invoke(app, ["evaluate", str(data / "nowhere")])
    assert empty.exit_code == 3
    assert "not a training set" in empty.stderr
