"""Compiles that are killed, and two at once: the build folder is always whole, and the next one succeeds."""

import json
import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from platformdirs import user_cache_path

SCRIPT = """\
size 64x36
proposals 4
takes 1
character anna = woman
scene kitchen = apartment.kitchen
anna at door
(anna wave) / (static medium eye-level) {0}s
(anna nod)  / (static full eye-level) {0}s
"""
RUN = "import sys; from vdsl.cli import main; sys.argv[1:] = {0!r}; main()"
MOMENTS = 20


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """A folder with results of its own; what does not concern them, as built sets, is the user's."""
    own = tmp_path / "cache" / "vdsl"
    own.mkdir(parents=True)
    for name in ("kernels", "bodies", "worlds"):
        (user_cache_path("vdsl") / name).mkdir(parents=True, exist_ok=True)
        (own / name).symlink_to(user_cache_path("vdsl") / name)
    return tmp_path


def started(project: Path) -> subprocess.Popen[bytes]:
    environment = os.environ | {"XDG_CACHE_HOME": str(project / "cache"), "VDS_CACHE_MIB": "64"}
    command = [sys.executable, "-c", RUN.format(["compile", "story.vds", "--rank", "geometry"])]
    return subprocess.Popen(
        command, cwd=project, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE
    )


def finished(project: Path) -> float:
    begun = time.monotonic()
    run = started(project)
    _, said = run.communicate(timeout=120)
    assert run.returncode == 0, said.decode()
    return time.monotonic() - begun


def whole(project: Path) -> str:
    """Which text the build is of; everything it names has to be there, and its own."""
    folder = project / "build" / "story"
    document = json.loads((folder / "storyboard.json").read_text("utf-8"))
    for name in ("index.html", "animatic.mp4", "sheet.png", "report.json"):
        assert (folder / name).stat().st_size > 0
    for shot in document["shots"]:
        for take in shot["takes"]:
            track = json.loads((folder / take["track"]).read_text("utf-8"))
            assert (track["shot"], track["frames"]) == (shot["id"], take["frames"])
            assert (folder / take["video"]).read_bytes()[4:8] == b"ftyp"
            assert (folder / take["poster"]).read_bytes()[:2] == b"\xff\xd8"
    assert (folder / "mine.txt").read_text() == "mine"
    return str(document["script"])


@pytest.mark.slow
def test_killed_at_any_moment_a_build_is_the_old_or_the_new_one(project: Path) -> None:
    rng = random.Random(7)
    story, folder = project / "story.vds", project / "build"
    texts = [SCRIPT.format(0.2), SCRIPT.format(0.25)]
    for text in texts:
        story.write_text(text, "utf-8")
        taken = finished(project)
    (folder / "story" / "mine.txt").write_text("mine")
    taken = finished(project)  # all of it was kept
    old, same = whole(project), 0
    for moment in range(MOMENTS):
        fresh = moment % 5 == 4  # else both texts are known, and most of a run is writing
        story.write_text(SCRIPT.format(0.3 + moment / 100) if fresh else texts[moment % 2], "utf-8")
        run = started(project)
        if moment % 3 == 0:
            time.sleep(rng.uniform(0.2, 1.1) * taken)
        else:  # while files are written and folders exchanged
            until = time.monotonic() + 60
            while run.poll() is None and time.monotonic() < until:
                if list(folder.glob(".story.new-*")):
                    break
                time.sleep(0.001)
            time.sleep(rng.uniform(0, 0.5) * taken)
        run.send_signal(signal.SIGKILL)
        run.communicate()
        now = whole(project)
        same += now == old
        old = now
    assert same > 0
    story.write_text(texts[0], "utf-8")
    finished(project)
    whole(project)
    assert [p.name for p in folder.iterdir()] == ["story"], "nothing is left lying about"


@pytest.mark.slow
def test_two_compiles_at_once_both_end_well(project: Path) -> None:
    (project / "story.vds").write_text(SCRIPT.format(0.25), "utf-8")
    runs = [started(project), started(project)]
    said = [run.communicate(timeout=120)[1].decode() for run in runs]
    assert [run.returncode for run in runs] == [0, 0], said
    (project / "build" / "story" / "mine.txt").write_text("mine")
    finished(project)
    whole(project)
    assert [p.name for p in (project / "build").iterdir()] == ["story"]
