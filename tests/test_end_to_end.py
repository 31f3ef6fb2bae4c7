"""From a file to a build folder, through the command line's own front door."""

import errno
import json
import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

import vdsl
from runtime.video import VideoError, VideoWriter, read_video, video_info
from vdsl.cli import app
from vdsl.lang import Settings

STORY = """\
storyboard "Two shots"
fps 24
size 320x180
proposals 12
takes 2

character anna = woman(top crimson)
character ben = man

scene kitchen = apartment.kitchen
anna at door facing window
ben at chair_2 sitting

(anna walk counter)  / (follow full eye-level)
dissolve 6f
(ben greet anna)     / (push|static close-up eye-level) say "You're up early."
"""

FIVE_MISTAKES = """\
storyboard "Five"
character anna = womann
character ben = man
scene kitchen = apartment.kitchn
ben at chair_2 sitting
(ben wlk counter) / (follow full eye-level)
(ben walk counter) / (folow full eye-level)
(ben walk counter) / (follow full eye-level) lens 0mm
"""

runner = CliRunner()


def run(*arguments: str):
    return runner.invoke(app, [str(a) for a in arguments])


@pytest.fixture(scope="module")
def built(tmp_path_factory) -> tuple[Path, vdsl.Report, object]:
    folder = tmp_path_factory.mktemp("story")
    (folder / "story.vds").write_text(STORY)
    result = vdsl.compile(folder / "story.vds", folder / "out", rank="geometry", device="cpu")
    return folder, result.warnings, result


def _documents(folder: Path) -> dict[str, bytes]:
    files = [folder / "storyboard.json", *sorted((folder / "shots").rglob("*.json"))]
    return {str(f.relative_to(folder)): f.read_bytes() for f in files}


def test_a_build_holds_what_the_contract_says(built):
    folder, _, _ = built
    out = folder / "out"
    for name in ("index.html", "animatic.mp4", "sheet.png", "storyboard.json", "report.json"):
        assert (out / name).stat().st_size > 0, name
    document = json.loads((out / "storyboard.json").read_text())
    assert document["schema"] == "vds.storyboard/1"
    assert [len(s["takes"]) for s in document["shots"]] == [2, 2]
    for shot in document["shots"]:
        assert shot["proposals"] == 12
        for take in shot["takes"]:
            for key in ("video", "poster", "track"):
                assert (out / take[key]).is_file(), take[key]
            track = json.loads((out / take["track"]).read_text())
            size, fps, frames = video_info(out / take["video"])
            assert (size, fps, frames) == ((320, 180), (24, 1), track["frames"])
            for values in (
                track["camera"]["position"],
                track["camera"]["focal_mm"],
                track["subject"]["position"],
            ):
                assert len(values) == track["frames"]
        scores = [t["score"] for t in shot["takes"]]
        assert scores == sorted(scores, reverse=True)


def test_the_animatic_joins_the_best_takes_with_the_dissolve(built):
    out = built[0] / "out"
    shots = json.loads((out / "storyboard.json").read_text())["shots"]
    _, _, frames = video_info(out / "animatic.mp4")
    assert frames == sum(s["frames"] for s in shots) - 6


def test_the_picture_shows_the_character_where_the_track_says(built):
    """The crimson of the shirt is in the frame, near where the camera looks."""
    out = built[0] / "out"
    shot = json.loads((out / "storyboard.json").read_text())["shots"][0]
    frame = list(read_video(out / shot["takes"][0]["video"]))[shot["frames"] // 2].astype(int)
    red = (frame[..., 0] > 110) & (frame[..., 1] < 70) & (frame[..., 2] < 90)
    assert red.mean() > 0.002
    columns = red.nonzero()[1] / frame.shape[1]
    assert 0.15 < columns.mean() < 0.85


def test_the_same_text_and_seed_give_the_same_bytes_and_another_seed_others(built):
    folder, _, _ = built
    vdsl.compile(folder / "story.vds", folder / "again", rank="geometry", device="cpu")
    assert _documents(folder / "again") == _documents(folder / "out")
    first = sorted((folder / "out").rglob("take-1.jpg"))[0].relative_to(folder / "out")
    assert (folder / "again" / first).read_bytes() == (folder / "out" / first).read_bytes()
    vdsl.compile(folder / "story.vds", folder / "other", Settings(seed=1), rank="geometry", device="cpu")
    assert _documents(folder / "other") != _documents(folder / "out")


def test_the_discriminator_judges_the_same_way_twice(built):
    folder, _, _ = built
    settings = Settings(proposals=6, takes=2)
    for name in ("judged", "judged-again"):
        vdsl.compile(folder / "story.vds", folder / name, settings, device="cpu")
    assert _documents(folder / "judged") == _documents(folder / "judged-again")
    document = json.loads((folder / "judged" / "storyboard.json").read_text())
    takes = [take for shot in document["shots"] for take in shot["takes"]]
    assert len({take["logit"] for take in takes}) == 4
    assert all(0.0 <= take["score"] <= 1.0 for take in takes)  # to six decimals: of several with faults 0
    report = json.loads((folder / "judged" / "report.json").read_text())
    assert next(s["count"] for s in report["stages"] if s["name"] == "rank") == 12 * 8  # frames


def test_the_command_line_wins_over_the_header(built):
    folder, _, _ = built
    done = run("compile", folder / "story.vds", "-o", folder / "cli", "--takes", "1", "--proposals", "4",
               "--size", "160x90", "--rank", "geometry", "--device", "cpu", "--burn-in")  # fmt: skip
    assert done.exit_code == 0, done.output
    document = json.loads((folder / "cli" / "storyboard.json").read_text())
    assert document["size"] == [160, 90]
    assert [(s["proposals"], len(s["takes"])) for s in document["shots"]] == [(4, 1), (4, 1)]


def test_five_mistakes_are_all_told_and_nothing_is_written(tmp_path):
    (tmp_path / "five.vds").write_text(FIVE_MISTAKES)
    done = run("compile", tmp_path / "five.vds", "-o", tmp_path / "out", "--format", "json")
    assert done.exit_code == 1
    found = json.loads(done.stdout)["diagnostics"]
    places = {(d["line"], d["suggestion"]) for d in found if d["severity"] == "error"}
    assert {(2, "woman"), (4, "apartment.kitchen"), (6, "walk"), (7, "follow")} <= places
    assert any(line == 8 for line, _ in places)
    assert not (tmp_path / "out").exists()
    assert [p.name for p in tmp_path.iterdir()] == ["five.vds"]


def test_a_target_that_cannot_be_reached_is_an_error_at_its_place(tmp_path):
    (tmp_path / "cage.vds").write_text(
        'storyboard "Cage"\n'
        "set cage {\n"
        "    area yard, at (0, 0)m, size (8, 8)m, floor grass {\n"
        "        place toy = ball, at (6, 6)m\n"
        "        place a = bookshelf(width 2.4m), at (6, 5)m\n"
        "        place b = bookshelf(width 2.4m), at (6, 7)m\n"
        "        place c = bookshelf(width 2.4m), at (5, 6)m, turn 90deg\n"
        "        place d = bookshelf(width 2.4m), at (7, 6)m, turn 90deg\n"
        "    }\n}\n"
        "character anna = woman\nscene here = cage\n(anna pick up toy) / (static full eye-level)\n"
    )
    done = run(
        "compile", tmp_path / "cage.vds", "-o", tmp_path / "out", "--rank", "geometry", "--format", "json"
    )
    assert done.exit_code == 1, done.output
    assert [d["line"] for d in json.loads(done.stdout)["diagnostics"] if d["severity"] == "error"] == [13]
    assert not (tmp_path / "out").exists()


def test_a_failing_run_leaves_the_last_good_build(built, monkeypatch):
    folder, _, _ = built
    before = _documents(folder / "out")

    def full(*_: object, **__: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device", "take-2.mp4")

    monkeypatch.setattr("vdsl.pipeline.shooting.write_take", full)
    done = run("compile", folder / "story.vds", "-o", folder / "out", "--rank", "geometry", "--seed", "9")
    assert done.exit_code == 3
    assert "disk is full" in done.output
    assert _documents(folder / "out") == before
    assert not list(folder.glob(".out.new*"))


@pytest.mark.parametrize("method", ["write", "close"])
def test_an_encoder_that_fails_beside_the_drawing_fails_the_run(built, monkeypatch, method):
    folder, _, _ = built
    before = _documents(folder / "out")
    wanted, works = "take-2.mp4", getattr(VideoWriter, method)

    def fails(writer: VideoWriter, *frame: object) -> None:
        if writer.path.name == wanted:
            raise VideoError(errno.ENOSPC, "No space left on device", wanted)
        works(writer, *frame)

    monkeypatch.setattr(VideoWriter, method, fails)
    arguments = ("--rank", "geometry", "--seed", "9", "--no-cache")
    done = run("compile", folder / "story.vds", "-o", folder / "out", *arguments)
    assert done.exit_code == 3
    assert "disk is full" in done.output
    assert _documents(folder / "out") == before
    assert not list(folder.glob(".out.new*"))


def test_an_interrupted_run_ends_with_130_and_leaves_the_last_good_build(built, monkeypatch):
    folder, _, _ = built
    before = _documents(folder / "out")

    def interrupt(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("vdsl.pipeline.shooting.write_take", interrupt)
    done = run("compile", folder / "story.vds", "-o", folder / "out", "--rank", "geometry", "--seed", "9")
    assert done.exit_code == 130
    assert _documents(folder / "out") == before


def test_a_place_that_cannot_be_written_is_exit_code_3(built):
    folder, _, _ = built
    (folder / "a-file").write_text("in the way")
    done = run("compile", folder / "story.vds", "-o", folder / "a-file" / "out", "--rank", "geometry")
    assert done.exit_code == 3
    assert "a-file" in done.output


def test_missing_weights_are_named_and_the_way_on_is_told(built):
    folder, _, _ = built
    done = run("compile", folder / "story.vds", "-o", folder / "w", "--weights", folder / "no-such")
    assert done.exit_code == 3
    assert "no-such" in done.output
    assert "--rank geometry" in done.output
    assert not (folder / "w").exists()


@pytest.mark.parametrize("size", ["1280", "0x0", "101x77", "axb"])
def test_a_wrong_size_is_a_usage_error(built, size):
    done = run("compile", built[0] / "story.vds", "--size", size)
    assert done.exit_code == 2
    assert size in done.output


def test_the_installed_command_runs_in_a_pipe_without_decoration(built):
    done = subprocess.run(
        [sys.executable, "-c", "from vdsl.cli import main; main()", "check", str(built[0] / "story.vds")],
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0
    assert "\x1b" not in done.stdout + done.stderr
