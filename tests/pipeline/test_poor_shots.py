"""What is told of shots that no camera can film as their line says."""

from __future__ import annotations

import json
from pathlib import Path

from typer.testing import CliRunner

import vdsl
from vdsl.cli import app

STORY = """\
storyboard "Narrow"
size 64x36
proposals 8
takes 1
character anna = woman
scene hall = classroom.corridor
anna at middle
(anna wave) / (arc wide high-angle) lens 80mm
(anna wave) / (static medium eye-level)
"""


def test_a_shot_without_cameras_says_why_and_what_would_work(tmp_path: Path) -> None:
    story = tmp_path / "story.vds"
    story.write_text(STORY)
    result = vdsl.compile(story, tmp_path / "out", rank="geometry", device="cpu")
    (warning,) = [d for d in result.warnings.diagnostics if d.code == "VDS190"]
    assert "the corridor is 2." in warning.label
    assert "a wide high-angle shot stands 10." in warning.label
    assert "rejected: " in warning.label
    assert "too far outside" in warning.label
    assert "`lens 35mm`" in warning.help
    shots = json.loads((tmp_path / "out" / "storyboard.json").read_text())["shots"]
    assert "lens 35mm" in shots[0]["advice"]["instead"]
    assert shots[0]["takes"] == []
    assert shots[1]["advice"] is None
    # what it names does work, of sixty without a fault too: in most a wall is missing behind
    story.write_text(STORY.replace("lens 80mm", "lens 35mm").replace("proposals 8", "proposals 60"))
    told = CliRunner().invoke(app, ["why", str(story), "1", "--fresh", "--json"])
    assert json.loads(told.stdout)["advice"] is None
    assert json.loads(told.stdout)["takes"]
    story.write_text(STORY)
    told = CliRunner().invoke(app, ["why", str(story), "1", "--fresh"])
    assert "no take: every proposal was rejected" in told.stdout
    assert "try `" in told.stdout
