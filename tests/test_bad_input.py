"""What people, disks and terminals do to a compiler: the right exit code, a clear line, no traceback."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from vdsl.cli import app
from vdsl.emit.folder import BuildFolderError, staged_build

SCENE = "scene kitchen = apartment.kitchen\n"
PAIR = "character anna = woman\ncharacter ben = man\n"
STORY = PAIR + SCENE + "anna at door\nben at table\n(anna wave ben)\n"
COMMAND = [sys.executable, "-c", "from vdsl.cli import main; main()"]
SMALL = ["--rank", "geometry", "--device", "cpu", "--proposals", "4", "--takes", "1", "--size", "64x36"]


def checked(folder: Path, text: str) -> Result:
    (folder / "story.vds").write_text(text, encoding="utf-8")
    return CliRunner().invoke(app, ["check", str(folder / "story.vds")])


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ("age 500", "from 3 to 110, or child"),
        ("age -3", "from 3 to 110"),
        ("age 5m", "this is a length"),
        ("build 5", "from 0 to 1, or thin"),
        ("build banana", "it may be thin"),
        ("height 20m", "nobody is 20m tall"),
        ("top banana", "it may be white"),
        ("wings 2", "has no parameter `wings`"),
        ("age 5, age 6", "`age` is given twice"),
    ],
)
def test_absurd_people_are_refused_where_they_are_made(tmp_path: Path, arguments: str, said: str) -> None:
    result = checked(tmp_path, f"character anna = woman({arguments})\n{SCENE}anna at door\n(anna wave)\n")
    assert result.exit_code == 1
    assert said in result.stderr
    assert "story.vds:1:" in result.stderr
    assert "1 error;" in result.stderr


def test_years_and_shares_do_for_words(tmp_path: Path) -> None:
    text = f"character anna = woman(age 63, build 0.2)\n{SCENE}anna at door\n(anna wave)\n"
    assert checked(tmp_path, text).exit_code == 0


@pytest.mark.parametrize("second", ["chair_2", "chair_2.seat"])
def test_two_people_do_not_sit_on_one_chair(tmp_path: Path, second: str) -> None:
    result = checked(
        tmp_path, f"{PAIR}{SCENE}anna at chair_2 sitting\nben at {second} sitting\n(anna wave ben)\n"
    )
    assert result.exit_code == 1
    assert "story.vds:5:8" in result.stderr
    assert "anna sits here already" in result.stderr


def test_two_people_do_sit_on_one_sofa_and_three_do_not(tmp_path: Path) -> None:
    head = f"{PAIR}character carl = man\nscene living = apartment.living\n"
    two = "anna at sofa sitting\nben at sofa sitting\n"
    assert checked(tmp_path, head + two + "(anna wave ben)\n").exit_code == 0
    assert checked(tmp_path, head + two + "carl at sofa sitting\n(anna wave ben)\n").exit_code == 1


def test_a_dangling_link_is_not_what_was_meant(tmp_path: Path) -> None:
    (tmp_path / "a.vds").symlink_to(tmp_path / "nowhere")
    result = CliRunner().invoke(app, ["check", str(tmp_path / "a.vds")])
    assert result.exit_code == 2
    assert "Did you mean" not in result.stderr


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs /dev/full")
@pytest.mark.parametrize(("stream", "text"), [("stdout", STORY), ("stderr", "(nobody knows)\n")])
def test_output_that_cannot_be_written_is_the_machines_fault(tmp_path: Path, stream: str, text: str) -> None:
    (tmp_path / "story.vds").write_text(text)
    streams = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    with open("/dev/full", "w") as full:
        done = subprocess.run(
            [*COMMAND, "check", str(tmp_path / "story.vds")], **{**streams, stream: full}, text=True
        )
    assert done.returncode == 3
    assert "Traceback" not in (done.stderr or "")


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs named pipes")
def test_a_pipe_cannot_be_compiled(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    with subprocess.Popen(
        [*COMMAND, "compile", str(tmp_path / "pipe"), *SMALL], stderr=subprocess.PIPE, text=True
    ) as running:
        (tmp_path / "pipe").write_text(STORY)
        _, said = running.communicate(timeout=60)
    assert running.returncode == 2
    assert "is no ordinary file" in said


@pytest.mark.parametrize("place", ["/", "n" * 300])
def test_places_no_build_can_have_are_named(tmp_path: Path, place: str) -> None:
    target = tmp_path / place  # an absolute path stands for itself
    with pytest.raises(BuildFolderError, match="cannot"), staged_build(target):
        pytest.fail("there is no such place")


def test_what_a_killed_run_left_is_cleared_and_a_running_one_is_not(tmp_path: Path) -> None:
    for name in (".film.new-old", ".film.new-young"):
        (tmp_path / name / "shots").mkdir(parents=True)
    long_ago = time.time() - 100_000
    for path in (tmp_path / ".film.new-old" / "shots", tmp_path / ".film.new-old"):
        os.utime(path, (long_ago, long_ago))
    with staged_build(tmp_path / "film"):
        pass
    assert sorted(p.name for p in tmp_path.iterdir()) == [".film.new-young", "film"]


def test_without_a_home_it_films_all_the_same(tmp_path: Path) -> None:
    (tmp_path / "story.vds").write_text(STORY)
    nowhere = {k: v for k, v in os.environ.items() if k not in ("HOME", "XDG_CACHE_HOME")}
    done = subprocess.run(
        [*COMMAND, "compile", "story.vds", *SMALL], cwd=tmp_path, env=nowhere, capture_output=True, text=True
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert (tmp_path / "build" / "story" / "animatic.mp4").exists()


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_asked_to_stop_it_cleans_up_and_leaves_the_last_good_build(tmp_path: Path, number: int) -> None:
    (tmp_path / "story.vds").write_text(STORY)
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "storyboard.json").write_text('{"schema": "vds.storyboard/1"}')
    running = subprocess.Popen(
        [*COMMAND, "compile", "story.vds", "-o", "out", *SMALL],
        cwd=tmp_path,
        stderr=subprocess.PIPE,
        text=True,
        # whoever starts the tests in the background may have had Ctrl-C ignored
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )
    deadline = time.monotonic() + 60
    while not list(tmp_path.glob(".out.new-*")) and running.poll() is None and time.monotonic() < deadline:
        time.sleep(0.02)
    running.send_signal(number)
    _, said = running.communicate(timeout=60)
    assert (running.returncode, said) == (130, "vdsc: interrupted; the last good build is as it was\n")
    assert sorted(p.name for p in tmp_path.iterdir()) == ["out", "story.vds"]
    assert [p.name for p in (tmp_path / "out").iterdir()] == ["storyboard.json"]


def test_heads_are_taught_on_top_of_weights_and_nothing_is_filmed_without(tmp_path: Path) -> None:
    told = CliRunner().invoke(app, ["train", str(tmp_path / "out"), "--recipe", "heads"])
    assert told.exit_code == 3
    assert "name some to start from (--weights)" in told.stderr
    assert not (tmp_path / "out").exists()
    other = CliRunner().invoke(app, ["train", str(tmp_path / "out"), "--recipe", "hands"])
    assert other.exit_code == 3
    assert "there is no recipe hands: paper, cpu, heads, or a JSON file" in other.stderr
