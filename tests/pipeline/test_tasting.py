"""From a take that somebody chooses to another order of takes, through the command line's own doors."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from proposed_shots import proposed
from tastes import some_taste
from typer.testing import CliRunner

from ranker.taste import load_taste, save_taste
from vdsl.cinema.traits import TRAITS
from vdsl.cli import app
from vdsl.pipeline import cache as cache_module
from vdsl.pipeline.filming import Camerawork
from vdsl.pipeline.guides import about_of
from vdsl.pipeline.judging import DiscriminatorJudge, log_odds
from vdsl.pipeline.picked import picked
from vdsl.pipeline.tasting import digest_of

SCRIPT = """\
size 128x72
proposals 24
takes 3
character anna = woman(top crimson)
scene room = apartment.living
anna at door
(anna wave)  / (static medium) 0.5s
(anna nod)  / (static medium) 0.5s
"""

runner = CliRunner()


def run(*arguments: str | Path) -> str:
    result = runner.invoke(app, [str(a) for a in arguments], catch_exceptions=False)
    assert result.exit_code == 0, result.output
    return result.stdout


def odds_of(build: Path) -> dict[str, dict[str, float]]:
    """Log odds of the takes of every shot, by key."""
    document = json.loads((build / "storyboard.json").read_text("utf-8"))
    return {s["id"]: {t["key"]: log_odds(t["score"]) for t in s["takes"]} for s in document["shots"]}


def heights_of(build: Path) -> dict[str, dict[str, float]]:
    """Metres of the cameras of the takes of every shot, by key."""
    return {
        s["id"]: {t["key"]: t["measures"]["height"] for t in s["takes"]} for s in document_of(build)["shots"]
    }


def document_of(build: Path) -> dict[str, Any]:
    found: dict[str, Any] = json.loads((build / "storyboard.json").read_text("utf-8"))
    return found


@pytest.mark.slow
def test_choices_change_the_order_of_takes_and_are_forgotten_with_their_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(cache_module, "results_folder", lambda: tmp_path / "kept")
    monkeypatch.chdir(tmp_path)
    story, build = tmp_path / "story.vds", tmp_path / "build" / "story"
    story.write_text(SCRIPT, "utf-8")
    run("compile", story)
    before = odds_of(build)
    assert document_of(build)["taste"] is None
    chosen = {shot: min(takes, key=lambda key: takes[key]) for shot, takes in heights_of(build).items()}
    high = np.mean([height for takes in heights_of(build).values() for height in takes.values()])
    for shot, key in chosen.items():
        run("pick", story, shot, key)
    for some in picked(story):
        assert some.odds.tolist() == pytest.approx(list(before[some.id].values()), abs=1e-3)

    told = json.loads(run("train", "--picks", story, "--json"))
    taste = tmp_path / "vds.taste"
    assert (told["taste"], told["choices"], list(told["likes"])) == (str(taste), 2, list(TRAITS))
    assert load_taste(taste, tuple(TRAITS)).choices == 2
    (tmp_path / "story.vds.lock").unlink()  # so that its order is the judge's
    run("compile", story)
    assert document_of(build)["taste"] == digest_of(taste)
    after = odds_of(build)
    assert np.mean([h for takes in heights_of(build).values() for h in takes.values()]) < high - 0.1
    for shot, key in chosen.items():
        assert key in after[shot]
        for other in after[shot].keys() & before[shot].keys() - {key}:
            was, now = (odds[shot][key] - odds[shot][other] for odds in (before, after))
            assert now > was + 0.1

    for shot, key in chosen.items():
        run("pick", story, shot, key)
    for some in picked(story):  # what was learnt before is learnt anew, not on top
        for take, odds in zip(some.takes, some.odds, strict=True):
            assert odds + take["taste"] == pytest.approx(after[some.id][take["key"]], abs=1e-3)
            if take["key"] in before[some.id]:
                assert odds == pytest.approx(before[some.id][take["key"]], abs=1e-3)
    assert "from your choices" in run("why", story, "room-anna-wave", "1")

    taste.unlink()
    (tmp_path / "story.vds.lock").unlink()
    run("compile", story, "-o", tmp_path / "third")
    assert odds_of(tmp_path / "third") == before


def test_a_taste_counts_at_a_glance_too_and_is_told_apart(tmp_path: Path) -> None:
    act, grid = proposed(SCRIPT.rpartition("\n(")[0] + "\n")
    cameras, about = grid.cameras[:6], [about_of(act.line.shots[0], grid, act.filming, act.staged)] * 6
    seen = Camerawork("cpu").judge_frames(
        act.staged, act.line.shots[0].style, grid.story, cameras, about=about
    )
    save_taste(tmp_path / "vds.taste", some_taste(height=-2.0))
    plain, tasting = DiscriminatorJudge(None, "cpu"), DiscriminatorJudge(None, "cpu", tmp_path / "vds.taste")
    steps = np.array([camera.measures["height"] for camera in cameras]) / TRAITS["height"].step
    for judged in ("glance", "scores"):
        was, now = (
            np.array([log_odds(score) for score in getattr(judge, judged)(cameras, seen)])
            for judge in (plain, tasting)
        )
        np.testing.assert_allclose(now - was, 12.0 * np.tanh(-2.0 * steps / 12.0), atol=1e-3)
    for camera, before, after in zip(cameras, was, now, strict=True):
        alone, tasted = (
            judge.opinion(camera, 1.0 / (1.0 + np.exp(-odds / 15.0)))
            for judge, odds in ((plain, before), (tasting, after))
        )
        assert (alone.taste, tasted.taste) == (0.0, pytest.approx(after - before, abs=1e-3))
        assert alone.logit is not None
        assert tasted.logit == pytest.approx(alone.logit, abs=1e-3)
