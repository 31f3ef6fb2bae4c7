"""``vdsc why`` as a writer meets it: from a build, from memory, and what is wrong with what was asked."""

from __future__ import annotations

import json
import re
import shutil
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

import vdsl
from vdsl.cli import app

STORY = """\
storyboard "Why"
size 128x72
proposals 10
takes 3

character anna = woman

scene kitchen = apartment.kitchen
anna at door facing window

(anna wave)          / (static|push full eye-level)
(anna walk counter)  / (follow medium eye-level)
"""
DOCS = Path(__file__).parents[1] / "docs" / "output.md"


def vdsc(*arguments: object) -> Result:
    return CliRunner().invoke(app, [str(a) for a in arguments])


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("why")
    (path / "story.vds").write_text(STORY)
    vdsl.compile(path / "story.vds", path / "out", rank="geometry", device="cpu")
    return path


def explained(*arguments: object) -> dict:  # type: ignore[type-arg]
    result = vdsc("why", *arguments, "--json")
    assert result.exit_code == 0, result.output
    return json.loads(result.stdout)  # type: ignore[no-any-return]


def test_a_build_is_explained_in_words_and_numbers(folder: Path) -> None:
    result = vdsc("why", folder / "story.vds", "1", "-b", folder / "out")
    assert result.exit_code == 0, result.output
    assert "asked: static|push full eye-level; 10 proposals judged" in result.stdout
    assert re.search(r"^take 1 \(0\.\d+\) ranks first: ", result.stdout, re.MULTILINE)
    assert re.search(r"^take 3 \(0\.\d+\) ranks third: ", result.stdout, re.MULTILINE)
    assert re.search(r"scale +full, came out as full", result.stdout)
    assert "rejected before judging: " in result.stdout
    assert "changed since" not in result.stdout


def test_the_numbers_are_those_of_the_build(folder: Path) -> None:
    told = explained(folder / "story.vds", "walk", "-b", folder / "out")
    built = json.loads((folder / "out" / "storyboard.json").read_text())["shots"][1]
    assert told["shot"] == built["id"]
    assert told["origin"] == "build"
    assert told["rejected"] == built["rejected"]
    assert [t["score"] for t in told["takes"]] == [t["score"] for t in built["takes"]]
    for take in told["takes"]:
        total = sum(t["points"] for t in take["terms"])
        for factor in take["penalties"].values():
            total *= factor
        assert total == pytest.approx(take["geometry"], abs=1e-4)
        assert take["geometry"] == pytest.approx(take["score"], abs=1e-4)
        assert take["logit"] is None
        assert all(take["kept"].values()), take["achieved"]
        assert {a["rank"] for a in take["against"]} == {1, 2, 3} - {take["rank"]}


def test_memory_says_what_the_build_says(folder: Path) -> None:
    fresh = explained(folder / "story.vds", "walk", "--fresh")
    kept = explained(folder / "story.vds", "walk", "-b", folder / "out")
    assert fresh["origin"] == "memory"
    assert [t["sentence"] for t in fresh["takes"]] == [t["sentence"] for t in kept["takes"]]
    assert fresh["rejected"] == kept["rejected"]


def test_one_take_and_a_changed_script(folder: Path, tmp_path: Path) -> None:
    changed = tmp_path / "story.vds"
    changed.write_text(STORY + "(anna wave)\n")
    result = vdsc("why", changed, "walk", 2, "-b", folder / "out")
    assert result.exit_code == 0
    assert "the script has changed since this build" in result.stdout
    assert "take 2 (" in result.stdout
    assert not re.search(r"^take 1", result.stdout, re.MULTILINE)


@pytest.mark.parametrize(
    ("shot", "said"),
    [
        ("9", "there is no shot 9; the storyboard has 2 shots"),
        ("anna", "is a part of several shots: kitchen-anna-wave and kitchen-anna-walk-counter"),
        ("kitchen-anna-wav3", "did you mean `kitchen-anna-wave`?"),
        ("zzz", "shots are kitchen-anna-wave and kitchen-anna-walk-counter"),
    ],
)
def test_unclear_shots_are_told(folder: Path, shot: str, said: str) -> None:
    result = vdsc("why", folder / "story.vds", shot)
    assert result.exit_code == 2
    assert said in result.output


def test_takes_and_builds_that_are_not_there_are_told(folder: Path, tmp_path: Path) -> None:
    story = folder / "story.vds"
    result = vdsc("why", story, "1", "4", "-b", folder / "out")
    assert (result.exit_code, "has 3 takes" in result.output) == (2, True)
    result = vdsc("why", story, "1", "-b", tmp_path)
    assert (result.exit_code, "there is no build at" in result.output) == (2, True)
    (tmp_path / "storyboard.json").write_text('{"schema": "vds.storyboard/1"}')
    result = vdsc("why", story, "1", "-b", tmp_path)
    assert (result.exit_code, "is damaged" in result.output) == (2, True)
    assert vdsc("why", story, "1", "--fresh", "-b", tmp_path).exit_code == 2
    assert vdsc("why", tmp_path / "none.vds", "1").exit_code == 2


def test_a_take_that_was_put_first_is_not_said_to_rank_first(folder: Path, tmp_path: Path) -> None:
    """Of a build with a choice or an edit, the first take's place by its score is told, and why."""
    built = tmp_path / "out"
    shutil.copytree(folder / "out", built)
    document = json.loads((built / "storyboard.json").read_text())
    takes = document["shots"][0]["takes"]
    takes[0]["score"], takes[0]["chosen"] = takes[1]["score"] - 1e-6, True
    (built / "storyboard.json").write_text(json.dumps(document))
    said = vdsc("why", folder / "story.vds", "1", "-b", built).stdout
    assert "take 1 stands first because it was chosen" in said
    assert re.search(r"^take 1 \(0\.\d+\) ranks second: ", said, re.MULTILINE)
    assert re.search(r"^take 2 \(0\.\d+\) ranks first: ", said, re.MULTILINE)
    takes[0]["chosen"] = False
    text = "shot 1: take 2 instead of 1 (score 0.71 instead of 0.72) keeps the line"
    document["trades"] = [{"shot": document["shots"][0]["id"], "text": text}]
    (built / "storyboard.json").write_text(json.dumps(document))
    told = explained(folder / "story.vds", "1", "-b", built)
    assert told["placed"] == f"take 1 stands first for the sake of the cuts: {text}"
    assert told["takes"][1]["sentence"].startswith("ranks first")
    assert explained(folder / "story.vds", "2", "-b", built)["placed"] == ""


def test_the_space_of_a_shot_is_shown(folder: Path) -> None:
    shown = vdsc("why", folder / "story.vds", "1", "--space").stdout
    assert "static full eye-level: " in shown
    assert "push full eye-level: " in shown
    assert "μ ∈ [0.5, 0.8]" in shown
    assert "φ ∈ {0, 45, 90, 135, 180, 225, 270, 315} °" in shown
    told = json.loads(vdsc("why", folder / "story.vds", "2", "--space", "--json").stdout)
    assert told["proposals"] == 10
    (space,) = told["spaces"]
    assert space["style"] == "follow medium eye-level"
    assert {v["symbol"] for v in space["free"]} == {"φ", "Δφ", "f", "lead", "λ"}


def fields(value: object, prefix: str = "") -> set[str]:
    """Paths of all fields; those of free-form maps are none."""
    out: set[str] = set()
    if isinstance(value, dict):
        for key, inner in value.items():
            free = key in ("measures", "rejected", "penalties", "gains", "fixed")
            out |= {prefix + key} | (set() if free else fields(inner, f"{prefix}{key}."))
    elif isinstance(value, list):
        out |= {field for inner in value for field in fields(inner, prefix[:-1] + "[].")}
    return out


def documented_fields(schema: str) -> set[str]:
    section = DOCS.read_text("utf-8").split(f"## `{schema}`", 1)[1].split("\n## ", 1)[0]
    return set(re.findall(r"^\| `([^`]+)` \|", section, re.MULTILINE))


def test_documented_fields_are_the_fields(folder: Path) -> None:
    space = json.loads(vdsc("why", folder / "story.vds", "1", "--space", "--json").stdout)
    assert documented_fields("vds.space/1") == fields(space)
    told = explained(folder / "story.vds", "1", "-b", folder / "out")
    assert documented_fields("vds.why/1") - {"advice.why", "advice.instead", "advice.faulty"} == fields(told)


def test_cameras_of_a_place_stand_all_around_it(tmp_path: Path) -> None:
    (tmp_path / "place.vds").write_text(
        STORY.partition("(anna wave)")[0] + "/ (static wide)\n/ (static close-up)\n"
    )

    def aside(line: str) -> float:
        told = json.loads(vdsc("why", tmp_path / "place.vds", line, "--space", "--json").stdout)
        return next(float(v["high"]) for v in told["spaces"][0]["free"] if v["symbol"] == "Δφ")

    assert aside("1") == 22.5
    assert aside("2") == 9.0, "of her"
