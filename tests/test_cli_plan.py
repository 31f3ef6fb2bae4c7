"""``vdsc preview --plan``: a plan before anything is compiled."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path

import pytest
from PIL import Image
from typer.testing import CliRunner, Result

from vdsl.cli import app

STORY = """\
storyboard "Plan"
proposals 8

character anna = woman
character ben = man

scene kitchen = apartment.kitchen
anna at door facing window
ben at chair_2 sitting

(anna wave)          / (static full eye-level)
(anna walk counter)  / (follow medium eye-level)
"""
SVG = "{http://www.w3.org/2000/svg}"


def vdsc(*arguments: object) -> Result:
    return CliRunner().invoke(app, [str(a) for a in arguments])


@pytest.fixture
def story(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "story.vds").write_text(STORY)
    return tmp_path / "story.vds"


def words(path: Path) -> list[str]:
    return [e.text or "" for e in ET.parse(path).getroot().iter(f"{SVG}text")]


def test_a_scene_with_all_its_cameras(story: Path) -> None:
    result = vdsc("preview", "story.vds", "--plan", "-o", "scene.svg")
    assert result.exit_code == 0, result.output
    told = words(Path("scene.svg"))
    # things that a camera stands upon may go without their name
    assert {"1", "2", "anna", "ben", "sink"} <= set(told)
    result = vdsc("preview", "story.vds", "--plan")
    assert result.stdout.strip() == "story-kitchen-plan.png"
    assert Image.open("story-kitchen-plan.png").size == (1200, 900)


def test_one_shot(story: Path) -> None:
    result = vdsc("preview", "story.vds", "--plan", "--shot", "walk", "-o", "shot.svg")
    assert result.exit_code == 0, result.output
    told = words(Path("shot.svg"))
    assert {"anna", "counter"} <= set(told)
    assert any(text.endswith(" mm") for text in told)
    assert "1" not in told


@pytest.mark.parametrize(
    ("more", "said"),
    [
        (["--shot", "1"], "add --plan"),
        (["--plan", "--from", "(static wide)"], "not both"),
        (["--plan", "--shot", "9"], "there is no shot 9"),
        (["--plan", "--scene", "kitchn"], "did you mean `kitchen`?"),
        (["--plan", "-o", "plan.pdf"], ".png or .svg"),
    ],
)
def test_what_cannot_be_drawn_is_said(story: Path, more: list[str], said: str) -> None:
    result = vdsc("preview", "story.vds", *more)
    assert result.exit_code == 2
    assert said in result.stderr
    assert [p.name for p in Path.cwd().iterdir()] == ["story.vds"]
