"""``vdsc stats``: a script counted alone, and with its build."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner, Result

import vdsl
from vdsl.cli import app

STORY = """\
storyboard "Counted"
size 128x72
proposals 8
takes 2

character anna = woman
character ben = man

scene kitchen = apartment.kitchen
anna at door facing window
ben at chair_2 sitting

(anna wave)          / (static|push full eye-level) 2s, say "Good morning to you."
(anna walk counter)  / (follow medium eye-level)
dissolve 12f
(ben wave)           / (static close-up high-angle) 3s
"""
DOCS = Path(__file__).parents[1] / "docs" / "compare.md"


def vdsc(*arguments: object) -> Result:
    return CliRunner().invoke(app, [str(a) for a in arguments])


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("stats")
    (path / "story.vds").write_text(STORY)
    (path / "bare.vds").write_text(STORY)
    vdsl.compile(path / "story.vds", path / "out", rank="geometry", device="cpu")
    return path


def counted(*arguments: object) -> dict[str, Any]:
    result = vdsc("stats", *arguments, "--json")
    assert result.exit_code == 0, result.output
    return json.loads(result.stdout)  # type: ignore[no-any-return]


def test_a_script_is_counted_alone(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(folder)
    found = counted("bare.vds")
    assert found["schema"] == "vds.stats/1"
    assert found["counted"] == "script"
    assert found["build"] is None
    assert (found["shots"], found["lines"]) == (3, 3)
    assert found["sizes"]["close-up"] == {"shots": 1, "seconds": 3.0}
    assert found["movements"]["static|push"] == {"shots": 1, "seconds": 2.0}
    assert found["scenes"] == {"kitchen": {"shots": 3, "seconds": pytest.approx(found["seconds"] + 0.5)}}
    walk = found["sizes"]["medium"]["seconds"]
    assert walk > 1  # as long as the walk takes
    assert found["characters"]["anna"] == {
        "shots": 2, "acts": 2, "seconds": pytest.approx(2 + walk), "in_picture": None, "says": 1, "words": 4,
    }  # fmt: skip
    length = found["length"]
    assert length["mean"] == pytest.approx((5 + walk) / 3, abs=1e-3)
    assert length["median"] == sorted((2.0, 3.0, walk))[1]
    assert length["shortest"]["seconds"] == min(2.0, walk)


def test_a_build_adds_what_it_knows(folder: Path) -> None:
    found = counted(folder / "story.vds", "-b", folder / "out")
    built = json.loads((folder / "out" / "storyboard.json").read_text())
    assert found["counted"] == "build"
    assert found["seconds"] == pytest.approx(built["statistics"]["seconds"], abs=1e-3)
    assert {k: v["shots"] for k, v in found["movements"].items()} == built["statistics"]["movements"]
    assert found["build"]["takes"] == built["statistics"]["takes"]
    assert found["build"]["judge"] == "geometry"
    assert 0 < found["build"]["mean_score"] <= 1
    anna, ben = found["characters"]["anna"], found["characters"]["ben"]
    assert anna["in_picture"] >= 0.7 * anna["seconds"]  # the camera is on her
    assert 0.7 * 3 <= ben["in_picture"] <= found["seconds"] + 0.5


def test_a_build_of_another_text_is_not_counted(folder: Path) -> None:
    other = folder / "other.vds"
    other.write_text(STORY.replace("3s", "4s"))
    result = vdsc("stats", other, "-b", folder / "out")
    assert result.exit_code == 2
    assert "is no build of" in result.stderr


def test_it_can_be_read(folder: Path) -> None:
    text = vdsc("stats", folder / "story.vds", "-b", folder / "out").stdout
    assert text.startswith("Counted: 3 shots in 1 scene, ")
    assert re.search(r"^longest +\d+\.\d s  shot \d, kitchen-", text, re.MULTILINE)
    assert re.search(r"^close-up +1 +3\.0  ▇+$", text, re.MULTILINE)
    assert re.search(r"^character +shots +acts +seconds +in picture +says +words$", text, re.MULTILINE)
    assert "6 takes of 24 proposals, judged by geometry" in text


def test_every_field_is_documented(folder: Path) -> None:
    told = set(re.findall(r"^\| `([^`]+)` \|", DOCS.read_text(), re.MULTILINE))
    found = counted(folder / "story.vds", "-b", folder / "out")
    made = set(found) | {f"build.{k}" for k in found["build"]} | {f"length.{k}" for k in found["length"]}
    made |= {f"characters.*.{k}" for k in found["characters"]["anna"]}
    assert made <= told
