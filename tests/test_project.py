"""``vdsc new`` and ``vds.toml``."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

from vdsl.cli import app
from vdsl.cli.check import check_or_exit
from vdsl.cli.wishes import options_of
from vdsl.pipeline.project import project_of
from vdsl.pipeline.script import ScriptError, load_storyboard

run = CliRunner().invoke


def test_a_new_project_is_complete_and_its_story_without_a_mistake(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    done = run(app, ["new", "night-train"])
    assert done.exit_code == 0
    place = tmp_path / "night-train"
    assert sorted(p.name for p in place.iterdir()) == [
        ".gitattributes", ".gitignore", "README.md", "night-train.vds", "vds.toml",
    ]  # fmt: skip
    checked = load_storyboard(place / "night-train.vds")
    assert not checked.report.diagnostics
    assert checked.storyboard.title == "Night train"
    assert len(checked.storyboard.lines) >= 5
    project = project_of(place / "night-train.vds")
    assert (project.settings.takes, project.settings.size) == (3, (1280, 720))
    assert options_of(place / "night-train.vds").rank == "discriminator"
    for file in ("README.md", ".gitattributes"):
        assert "{" not in (place / file).read_text("utf-8")
    assert run(app, ["check", str(place / "night-train.vds")]).exit_code == 0


def test_what_is_said_to_come_next_can_be_pasted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    done = run(app, ["new", "my films/rain"])
    assert "next: cd 'my films/rain' && vdsc serve rain.vds --watch" in done.stdout


def test_git_ignores_builds_and_keeps_the_lock(tmp_path: Path) -> None:
    assert run(app, ["new", str(tmp_path / "rain")]).exit_code == 0
    place = tmp_path / "rain"
    subprocess.run(["git", "init", "-q", place], check=True)
    for name in ("build/rain/index.html", "rain.vds.lock"):
        (place / name).parent.mkdir(parents=True, exist_ok=True)
        (place / name).write_text("x")
    asked = ["git", "-C", place, "ls-files", "--others", "--exclude-standard"]
    seen = subprocess.run(asked, check=True, capture_output=True, text=True).stdout.split()
    assert sorted(seen) == [
        ".gitattributes", ".gitignore", "README.md", "rain.vds", "rain.vds.lock", "vds.toml",
    ]  # fmt: skip
    told = subprocess.run(
        ["git", "-C", place, "check-attr", "diff", "rain.vds"], check=True, capture_output=True, text=True
    ).stdout
    assert told.strip() == "rain.vds: diff: vds"


def test_nothing_is_written_over(tmp_path: Path) -> None:
    place = tmp_path / "rain"
    place.mkdir()
    (place / "README.md").write_text("mine")
    done = run(app, ["new", str(place)])
    assert done.exit_code == 2
    assert "holds README.md already" in done.output
    assert [p.name for p in place.iterdir()] == ["README.md"]
    (tmp_path / "snow").write_text("no folder")
    done = run(app, ["new", str(tmp_path / "snow")])
    assert done.exit_code == 2
    assert "no folder" in done.output
    for name in ("1st", "a b", "..", "-x"):
        assert run(app, ["new", "--", str(tmp_path / name)]).exit_code == 2, name


def test_a_folder_that_has_none_of_a_projects_files_becomes_one(tmp_path: Path) -> None:
    place = tmp_path / "rain"
    (place / ".git").mkdir(parents=True)
    (place / "notes.txt").write_text("mine")
    assert run(app, ["new", str(place)]).exit_code == 0
    assert (place / "rain.vds").exists()
    assert (place / "notes.txt").read_text() == "mine"


@pytest.mark.parametrize(
    ("text", "line", "said"),
    [
        ("takes = 3\ntaks = 4\n", 2, "no setting `taks`"),
        ("\ntakes = 900\n", 2, "`takes` cannot be this"),
        ('size = "100x"\n', 1, "`size` cannot be this"),
        ("takes = [1]\n", 1, "`takes` cannot be this"),
        ("takes = true\n", 1, "`takes` cannot be this"),
        ('takes = "3\\ncharacter x = woman"\n', 1, "`takes` cannot be this"),
        ('[compile]\nrank = "dice"\n', 2, "`rank` cannot be this"),
        ('[compile]\nedit = "yes"\n', 2, "`edit` cannot be this"),
        ("[compile]\nsped = 1\n", 2, "no setting `sped`"),
        ("compile = 3\n", 1, "`compile` is a table"),
        ("takes = \n", 1, ""),
    ],
)
def test_a_wrong_setting_is_told_at_its_line(tmp_path: Path, text: str, line: int, said: str) -> None:
    (tmp_path / "vds.toml").write_text(text, "utf-8")
    with pytest.raises(ScriptError) as caught:
        project_of(tmp_path / "story.vds")
    (error,) = caught.value.report.errors
    assert (error.code, error.span.line_number) == ("VDS313", line)
    assert said in error.label
    assert error.help


def test_checking_a_script_reads_its_settings(tmp_path: Path) -> None:
    script, settings = tmp_path / "story.vds", tmp_path / "vds.toml"
    script.write_text("character anna = woman\nscene s = apartment.kitchen\nanna at door\n(anna wave)\n")
    settings.write_text("takes = 4\nfps = 30\n")
    board = check_or_exit(script).storyboard
    assert (board.fps, [s.takes for line in board.lines for s in line.shots]) == ((30, 1), [4])
    settings.write_text("colour = 1\n")
    for command in ("check", "stats", "compile"):
        told = run(app, [command, str(script)])
        assert (told.exit_code, "VDS313" in told.output) == (1, True), command


def test_settings_hold_where_nothing_else_is_said(tmp_path: Path) -> None:
    (tmp_path / "vds.toml").write_text(
        'fps = 25\nsize = "640x360"\ntakes = 4\nseed = 9\nrig = "paper"\nstyle = "ink"\n'
        '[compile]\nrank = "geometry"\nburn-in = true\narrows = false\n',
        "utf-8",
    )
    (tmp_path / "deep").mkdir()
    story = tmp_path / "deep" / "story.vds"
    story.write_text("aspect 2\ntakes 2\nscene a = apartment.kitchen\n/ (static wide)\n", "utf-8")
    board = load_storyboard(story, defaults=project_of(story).settings).storyboard
    assert (board.fps, board.seed, board.rig, board.style) == ((25, 1), 9, "paper", "ink")
    assert board.size == (1280, 640), "a size and an aspect go together"
    assert board.lines[0].shots[0].takes == 2
    assert (options_of(story).rank, options_of(story).burn_in) == ("geometry", True)
    assert options_of(story, rank="discriminator").rank == "discriminator"
    assert not options_of(story).arrows
    assert options_of(story, arrows=True).arrows


def test_completion_knows_the_shots(tmp_path: Path) -> None:
    story = tmp_path / "story.vds"
    story.write_text("scene a = apartment.kitchen\n/ (static wide)\n/ (pan wide) name pan\n", "utf-8")
    environment = os.environ | {
        "_VDSC_COMPLETE": "complete_bash",
        "COMP_WORDS": f"vdsc pick {story} ",
        "COMP_CWORD": "3",
    }
    told = subprocess.run(
        [Path(sys.executable).with_name("vdsc")], env=environment, capture_output=True, text=True
    )
    assert told.stdout.split() == ["a-establishing", "pan"], told.stderr
