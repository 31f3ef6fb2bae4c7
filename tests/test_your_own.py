"""The walk-through in ``docs/your-own.md``: its pieces are the example's, and the example films."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

import vdsl
from vdsl.lang import Report, Settings
from vdsl.pipeline.compile import stage_acts
from vdsl.pipeline.script import load_storyboard
from vdsl.propose.story import begin

ROOT = Path(__file__).resolve().parents[1]
EXAMPLE = ROOT / "examples" / "lighthouse.vds"
PIECES = re.findall(
    r"```vds\n(.*?)```", (ROOT / "docs" / "your-own.md").read_text(encoding="utf-8"), re.DOTALL
)


def plain(text: str) -> str:
    """Without comments and blank lines."""
    lines = (re.sub(r"(^|\s)# .*", "", line).rstrip() for line in text.splitlines())
    return "\n".join(line for line in lines if line)


@pytest.mark.parametrize("piece", PIECES, ids=[piece.split("{")[0].strip() for piece in PIECES])
def test_the_pieces_are_the_examples(piece: str) -> None:
    assert plain(piece) in plain(EXAMPLE.read_text(encoding="utf-8"))


def test_there_is_one_of_each() -> None:
    assert {piece.split()[0] for piece in PIECES} >= {"prop", "set", "cast", "action"}


def test_what_is_defined_there_works_in_the_story() -> None:
    checked = load_storyboard(EXAMPLE)
    acts = stage_acts(checked)
    last = acts[-1]
    state = begin(last.state, last.line, last.filming, Report()).end
    by_name = {thing.path[-1]: thing.id for thing in last.staged.world.objects}
    assert state.props[by_name["lid"]].open > 0.9  # what is opened stays open
    held = [thing for _, thing in state.actors["tom"].held]
    assert held == [by_name["lantern"]]
    assert not checked.report.diagnostics


def test_it_films(tmp_path: Path) -> None:
    settings = Settings(size=(256, 144), proposals=4, takes=1)
    result = vdsl.compile(EXAMPLE, tmp_path / "out", settings, rank="geometry", device="cpu")
    document = json.loads((result.folder / "storyboard.json").read_text())
    assert len(document["shots"]) == 5
    assert all(shot["takes"] for shot in document["shots"])
