"""Further takes of one shot: drawn behind those that there are, kept from build to build, chosen like any."""

import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from vdsl.cli import app
from vdsl.emit.guides import Guides
from vdsl.lang import Settings
from vdsl.pipeline import cache as cache_module
from vdsl.pipeline.compile import Result, Workshop, compile_file
from vdsl.pipeline.further import STEP, wishes
from vdsl.pipeline.lock import choose
from vdsl.pipeline.options import Options, made_by, options_document
from vdsl.pipeline.selection import alike, choose_takes, further_takes

SCRIPT = """\
size 96x54
proposals 24
takes 2
character anna = woman(top crimson)
scene room = apartment.living
anna at door
(anna wave)  / (static medium eye-level) 0.3s
(anna nod)   / (push medium eye-level) 0.3s
"""
WAVE = "room-anna-wave"
WORKSHOP = Workshop()


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv(cache_module.VARIABLE, "512")
    monkeypatch.setattr(cache_module, "results_folder", lambda: tmp_path / "kept")
    (tmp_path / "story.vds").write_text(SCRIPT, "utf-8")
    return tmp_path


def made(project: Path, text: str = SCRIPT, *further: str) -> Result:
    (project / "story.vds").write_text(text, "utf-8")
    options = Options(rank="geometry", further=further)
    return compile_file(project / "story.vds", project / "build", options, workshop=WORKSHOP)


def keys(result: Result, shot: int = 0) -> list[str]:
    return [t.key for t in result.build.shots[shot].takes]


def times(project: Path) -> dict[str, int]:
    folder = project / "build" / "shots"
    return {str(p.relative_to(folder)): p.stat().st_mtime_ns for p in folder.rglob("*.mp4")}


def test_more_takes_come_behind_those_there_are_and_stay(project: Path) -> None:
    first, files = made(project), times(project)
    more = made(project, SCRIPT, WAVE)
    assert keys(more)[:2] == keys(first)
    assert keys(more, 1) == keys(first, 1)
    assert 2 < len(keys(more)) == len(set(keys(more))) <= 2 + STEP
    assert more.further == {WAVE: 2 + STEP}
    assert {name: time for name, time in times(project).items() if name in files} == files
    cameras = [t.camera for t in more.build.shots[0].takes]
    assert not any(alike(a, b) for i, b in enumerate(cameras) if i >= 2 for a in cameras[:i])

    again = made(project)
    assert keys(again) == keys(more)
    assert again.report.cache_misses == 0

    last = more.build.shots[0].takes[-1]
    choose(project / "story.vds", WAVE, last.key, project / "build")
    chosen = made(project)
    assert keys(chosen) == [last.key, *keys(more)[:-1]]
    assert chosen.build.shots[0].takes[0].chosen
    assert not chosen.warnings.diagnostics

    (project / "build" / "further.json").unlink()  # what is chosen stays without the wish
    without = made(project)
    assert keys(without) == [last.key, keys(first)[0]]
    assert not without.warnings.diagnostics


def test_a_line_that_changes_has_what_the_script_asks_for(project: Path) -> None:
    made(project)
    assert len(keys(made(project, SCRIPT, WAVE))) > 2
    assert len(keys(made(project, SCRIPT.replace("(static medium", "(static full")))) == 2
    assert len(keys(made(project))) > 2, "as it was, it is wanted again"


def test_a_shot_that_has_no_other_says_so(project: Path) -> None:
    few = SCRIPT.replace("proposals 24", "proposals 2")
    made(project, few)
    asked = made(project, few, WAVE)
    assert len(keys(asked)) == 2 < asked.further[WAVE]


@pytest.mark.parametrize(
    "text",
    ["", "{half", "[]", '{"schema": "vds.further/1", "shots": {"a": 3}}', '{"schema": "x", "shots": {}}'],
)
def test_wishes_that_do_not_read_want_nothing(tmp_path: Path, text: str) -> None:
    (tmp_path / "further.json").write_text(text)
    assert wishes(tmp_path, {"a": "1" * 12}) == {}


def test_options_are_read_as_they_were_told(tmp_path: Path) -> None:
    said = Options(
        Settings(size=(320, 180), fps=(30, 1), takes=3), rank="geometry", guides=Guides(safe=True, mask=2.39),
        weights=tmp_path / "weights", edit=True, further=("a",), cache=False,
    )  # fmt: skip
    (tmp_path / "report.json").write_text(json.dumps({"options": options_document(said)}))
    assert Options(**made_by(tmp_path)) == Options(
        said.settings, rank="geometry", guides=said.guides, weights=said.weights, edit=True
    )
    (tmp_path / "report.json").write_text("{}")
    assert made_by(tmp_path) == {}


def test_none_of_the_further_looks_like_another_or_has_failed(project: Path) -> None:
    cameras = tuple(
        t.camera for t in made(project, SCRIPT.replace("takes 2", "takes 12")).build.shots[0].takes
    )
    scores = np.linspace(1, 0, len(cameras))
    known = choose_takes(cameras, scores, 2)
    found = further_takes(cameras, scores, known, (), 3)
    assert found == sorted(found)
    assert further_takes(cameras, scores, known, (found[0],), 3)[:2] == found[1:3]
    assert set(further_takes(cameras, scores, known, (), 99)).isdisjoint(known)


def test_the_command_draws_more_of_a_build_as_it_was_made(project: Path) -> None:
    run, script = CliRunner().invoke, str(project / "story.vds")
    out = ["--out", str(project / "build")]
    none = run(app, ["compile", script, *out, "--more", "wave"])
    assert (none.exit_code, "compile without --more first" in none.output) == (2, True)
    assert run(app, ["compile", script, *out, "--rank", "geometry", "--takes", "1"]).exit_code == 0
    done = run(app, ["compile", script, *out, "--more", "wave"])
    assert done.exit_code == 0
    assert f"{WAVE}: 6 takes now" in done.output
    document = json.loads((project / "build" / "storyboard.json").read_text())
    assert document["judge"] == "geometry"
    assert [len(s["takes"]) for s in document["shots"]] == [6, 1]
    assert run(app, ["compile", script, *out, "--more", "nobody"]).exit_code == 2
    assert run(app, ["clean", str(project / "build")]).exit_code == 0
    assert not (project / "build").exists()
