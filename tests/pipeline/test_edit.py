"""Takes chosen for the sequence: exactly the best, and on the demo every fault that can be avoided is."""

from __future__ import annotations

import json
from dataclasses import replace
from functools import cache
from itertools import pairwise, product
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import vdsl
from vdsl.cinema.continuity import RULES, findings
from vdsl.cinema.edges import LOOKING, Edge
from vdsl.cinema.track import CameraTrack, look_at_rotation
from vdsl.cli import app
from vdsl.emit.storyboard_json import script_digest
from vdsl.lang import Settings
from vdsl.lang.codes import CODES
from vdsl.pipeline.edit import Slot, best_path, candidates, cut_findings, edit, edited
from vdsl.pipeline.rehearsal import SAID, rehearse
from vdsl.pipeline.script import load_storyboard
from vdsl.propose.types import CameraProposal

COFFEE = Path(__file__).parents[2] / "examples" / "coffee.vds"
STORY = """\
storyboard "Two and one"
size 64x36
proposals 16
takes 2
seed 3
character anna = woman
character ben = man
scene kitchen = apartment.kitchen
anna at counter
ben at chair_2 sitting
(anna nod) / (static close-up eye-level) 1s
(anna nod) / (static close-up eye-level) 1s
dissolve 4f
(anna nod) / (static close-up eye-level) 1s
"""


# -- the dynamic programming -------------------------------------------------------------------


@pytest.mark.parametrize("seed", range(60))
def test_the_path_is_the_best_of_all(seed: int) -> None:
    rng = np.random.default_rng(seed)
    counts = rng.integers(1, 5, rng.integers(1, 6))
    losses = [rng.random(n) for n in counts]
    faults = [rng.integers(0, 3, (a, b)) * 1e6 for a, b in pairwise(counts)]
    costs = [f + 0.05 * rng.integers(0, 2, f.shape) for f in faults]

    def total(path: tuple[int, ...]) -> float:
        lost = sum(loss[k] for loss, k in zip(losses, path, strict=True))
        return lost + sum(cost[i, j] for cost, i, j in zip(costs, path[:-1], path[1:], strict=True))

    best = min(product(*(range(n) for n in counts)), key=total)
    assert best_path(losses, costs) == list(best)


def test_no_shots_no_path() -> None:
    assert best_path([], []) == []
    assert edit([]) == ([], ())


def _side(degrees: float, view: float = 0.0) -> Edge:
    """Anna filmed from that many degrees around her, off the line to ben."""
    turn = np.radians(view)
    pair = ("anna", "ben")
    return Edge(
        "anna", True, (float(np.cos(turn)), float(np.sin(turn)), 0.0), 4.0, {"anna": 0.0, "ben": 0.0},
        frozenset(), {pair: LOOKING}, {pair: degrees}, {},
    )  # fmt: skip


def _slot(number: int, *options: tuple[float, float, float], joined: bool = True) -> Slot:
    """options: (score, side, direction of view) of takes that do not move, best first."""
    ends = tuple((_side(side, view), _side(side, view)) for _, side, view in options)
    scores = tuple(score for score, _, _ in options)
    return Slot(f"s{number}", number, joined, tuple(range(len(options))), scores, ends)


def test_the_cheapest_side_is_taken_and_what_it_costs_is_told() -> None:
    slots = [
        _slot(1, (0.9, 60, 0), (0.5, -60, 0)),
        _slot(2, (0.86, -40, 90), (0.85, -50, 95), (0.81, 40, 90)),
        _slot(3, (0.7, 70, 180)),
    ]
    texts = [c.text for c in cut_findings(slots, [0, 0, 0])]
    assert texts == [
        "cut 1→2 crosses the line by 40° (anna–ben)",
        "cut 2→3 crosses the line by 70° (anna–ben)",
    ]
    choice, (trade,) = edit(slots)
    assert choice == [0, 2, 0]
    assert trade.text == "shot 2: take 3 instead of 1 (score 0.81 instead of 0.86) keeps the line"
    assert not cut_findings(slots, choice)


def test_what_cannot_be_avoided_costs_nothing() -> None:
    slots = [_slot(1, (0.9, 60, 0)), _slot(2, (0.8, -60, 90), (0.7, -50, 95))]
    choice, trades = edit(slots)
    assert (choice, trades) == ([0, 0], ())
    assert len(cut_findings(slots, choice)) == 1


def test_over_a_dissolve_everything_may_change() -> None:
    slots = [_slot(1, (0.9, 60, 0)), _slot(2, (0.8, -60, 90), (0.7, 60, 90), joined=False)]
    assert not cut_findings(slots, [0, 0])
    assert edit(slots) == ([0, 0], ())


def test_a_jump_cut_is_told_apart_from_the_line() -> None:
    slots = [_slot(1, (0.9, 60, 0)), _slot(2, (0.8, 60, 10), (0.75, 60, 50))]
    choice, (trade,) = edit(slots)
    assert choice == [0, 1]
    assert trade.keeps == ("jump",)
    assert "avoids a jump cut" in trade.text


def test_the_chosen_take_comes_first_and_no_more_are_kept_than_were_asked() -> None:
    slots = [
        _slot(1, (0.9, 60, 0)),
        replace(_slot(2, (0.8, -60, 90), (0.7, -50, 90), (0.6, 60, 90)), proposals=(7, 3, 5)),
    ]
    result = edited(slots, {"s1": [0], "s2": [7, 3], "s3": []})
    assert result.takes == {"s1": [0], "s2": [5, 7], "s3": []}


def test_what_must_not_be_shown_is_no_candidate_unless_there_is_nothing_else() -> None:
    cameras = propose_some(6)
    scores = np.linspace(0.9, 0.4, 6)
    assert candidates(cameras, scores, 2) == list(range(6))
    assert candidates(cameras, scores, 2, failed={1, 4}) == [0, 2, 3, 5]
    assert candidates(cameras, scores, 2, failed=set(range(6))) == list(range(6))


def propose_some(count: int) -> tuple[CameraProposal, ...]:
    """Cameras around a point, all different."""
    out = []
    for i in range(count):
        position = np.tile((3 * np.cos(i), 3 * np.sin(i), 1.5), (4, 1))
        aim = np.zeros((4, 3))
        track = CameraTrack(position, look_at_rotation(position, aim), np.full(4, 50.0), aim, (36.0, 20.25))
        out.append(CameraProposal(i, 0, "static", "medium", "eye-level", {}, track, np.zeros(0, bool)))
    return tuple(out)


# -- on the demo -------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def coffee() -> list[Slot]:
    return rehearse(load_storyboard(COFFEE), proposals=32)


def _faults(slots: list[Slot], k: int, before: int, after: int) -> list[str]:
    """Rules broken into slot k, asked of the geometry again rather than of the edit."""
    if not slots[k].joined:
        return []
    found = findings(slots[k - 1].ends[before][1], slots[k].ends[after][0])
    return [f.rule for f in found if f.severity == "fault"]


def test_no_avoidable_fault_is_left_on_the_demo(coffee: list[Slot]) -> None:
    best = [0] * len(coffee)
    assert any(c.finding.severity == "fault" for c in cut_findings(coffee, best)), "nothing to mend, no test"
    choice, trades = edit(coffee)
    left = [c for c in cut_findings(coffee, choice) if c.finding.severity == "fault"]

    @cache
    def fewest(k: int, now: int) -> int:
        """Least number of faults after slot k, shown by its candidate ``now``."""
        if k + 1 == len(coffee):
            return 0
        return min(
            len(_faults(coffee, k + 1, now, j)) + fewest(k + 1, j) for j in range(len(coffee[k + 1].ends))
        )

    assert len(left) == min(fewest(0, i) for i in range(len(coffee[0].ends)))
    for cut in left:  # and none that any two candidates of the cut could avoid
        k = next(i for i, slot in enumerate(coffee) if slot.shot == cut.shots[1])
        pairs = product(range(len(coffee[k - 1].ends)), range(len(coffee[k].ends)))
        assert all(cut.finding.rule in _faults(coffee, k, i, j) for i, j in pairs)
    assert {t.shot for t in trades} == {s.shot for s, k in zip(coffee, choice, strict=True) if k}
    assert all(t.keeps and t.score <= t.best for t in trades)


def test_scenes_and_transitions_part_the_demo(coffee: list[Slot]) -> None:
    parted = [slot.shot for slot in coffee if not slot.joined]
    assert parted == ["kitchen-establishing", "street-establishing"]
    assert [slot.number for slot in coffee] == list(range(1, 13))


# -- through the front door --------------------------------------------------------------------


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("edit")
    (path / "story.vds").write_text(STORY)
    for name, on in (("plain", False), ("edited", True)):
        vdsl.compile(path / "story.vds", path / name, rank="geometry", device="cpu", edit=on)
    return path


def test_a_build_says_what_was_traded_and_what_is_left(folder: Path) -> None:
    plain, cut = (json.loads((folder / n / "storyboard.json").read_text()) for n in ("plain", "edited"))
    assert (plain["edited"], plain["trades"], cut["edited"]) == (False, [], True)
    assert {c["rule"] for c in plain["continuity"]} >= {"jump"}, "the same close-up twice"
    assert cut["continuity"] == []
    assert all(c["cut"] == [1, 2] for c in plain["continuity"]), "3 follows by a dissolve"
    traded = {t["shot"]: t for t in cut["trades"]}
    assert traded
    for before, after in zip(plain["shots"], cut["shots"], strict=True):
        assert len(before["takes"]) == len(after["takes"]) == 2
        first = after["takes"][0]
        if before["id"] in traded:
            assert first["score"] == traded[before["id"]]["score"] <= before["takes"][0]["score"]
            assert after["takes"][1]["proposal"] == before["takes"][0]["proposal"]
        else:
            assert first["proposal"] == before["takes"][0]["proposal"]
        assert all("picture_visibility" in take["measures"] for take in after["takes"]), "all were looked at"
    notes = json.loads((folder / "edited" / "report.json").read_text())["notes"]
    assert notes == [t["text"] for t in cut["trades"]]


def test_checking_reads_the_build_where_it_is_of_this_script(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(folder)
    script, build = folder / "story.vds", folder / "build" / "story"
    board = load_storyboard(script).storyboard
    ids = [s.id for line in board.lines for s in line.shots]
    entry = {"rule": "line", "shots": ids[:2], "cut": [1, 2], "text": "cut 1→2 crosses the line by 77° (a–b)"}
    document = {"schema": "vds.storyboard/1", "script": script_digest(board), "continuity": [entry]}
    build.mkdir(parents=True)
    (build / "storyboard.json").write_text(json.dumps(document))
    told = CliRunner().invoke(app, ["check", "--continuity", "--format", "json", str(script)])
    assert told.exit_code == 0
    (found,) = json.loads(told.stdout)["diagnostics"]
    assert (found["code"], found["severity"], found["line"]) == ("VDS280", "warning", 12)
    assert found["message"] == entry["text"]
    assert found["notes"][0]["line"] == 11
    text = CliRunner().invoke(app, ["check", "--continuity", str(script)])
    assert "the takes in build/story; 1 found" in text.stdout

    script.write_text(STORY + "(anna nod)\n")  # another script by now: the build says nothing of it
    other = CliRunner().invoke(app, ["check", "--continuity", str(script)])
    script.write_text(STORY)
    assert other.exit_code == 0
    assert "77°" not in other.stderr
    assert "proposals a shot, by their geometry (the build in build/story is of another text)" in other.stdout


def test_checking_reads_the_build_that_is_named(folder: Path, tmp_path: Path) -> None:
    """What is told of a build by name is what was compiled, with the degrees, or why it cannot be told."""
    script, built = folder / "story.vds", json.loads((folder / "plain" / "storyboard.json").read_text())
    told = CliRunner().invoke(app, ["check", str(script), "--build", str(folder / "plain")])
    assert told.exit_code == 0
    assert built["continuity"]
    assert all(cut["text"] in told.stderr for cut in built["continuity"])
    assert f"the takes in {folder / 'plain'}; {len(built['continuity'])} found" in told.stdout
    none = CliRunner().invoke(app, ["check", str(script), "--build", str(tmp_path)])
    assert (none.exit_code, "there is no build at" in none.stderr) == (2, True)
    (tmp_path / "other.vds").write_text(STORY + "(anna nod)\n")
    other = CliRunner().invoke(app, ["check", str(tmp_path / "other.vds"), "--build", str(folder / "plain")])
    assert (other.exit_code, "is of another text" in other.stderr) == (2, True)


def test_every_rule_has_its_text() -> None:
    assert set(SAID) == set(RULES)
    assert {code for code, _ in SAID.values()} <= set(CODES)


def test_a_rehearsal_is_the_same_twice(folder: Path) -> None:
    checked = [load_storyboard(folder / "story.vds", Settings(proposals=8)) for _ in range(2)]
    one, two = (rehearse(c) for c in checked)
    assert [(s.shot, s.scores, s.ends) for s in one] == [(s.shot, s.scores, s.ends) for s in two]
