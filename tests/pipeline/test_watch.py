"""``vdsc watch``: a draft, first takes, then the others; mistakes; saves while something is made."""

import json
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from watchfiles import Change

from vdsl.cli.wishes import options_of
from vdsl.pipeline import cache as cache_module
from vdsl.pipeline.options import Options
from vdsl.pipeline.progress import Silence
from vdsl.pipeline.watch import News, _Ears, watch

SCRIPT = """\
size 96x54
proposals 6
takes 2
character anna = woman(top crimson)
scene room = apartment.living
anna at door
(anna wave)  / (static medium eye-level) 0.5s
(anna nod)   / (push medium eye-level) 0.5s
"""


def wanted(script: Path) -> Options:
    return options_of(script, rank="geometry")


class Desk:
    """A watched script: what was told, and how to wait for more."""

    def __init__(self, folder: Path) -> None:
        self.script, self.out = folder / "story.vds", folder / "build"
        self.news: list[News] = []
        self.films = 0
        self._more = threading.Condition()

    def told(self, news: News) -> None:
        with self._more:
            self.news.append(news)
            self._more.notify_all()

    def until(self, state: str, count: int = 1) -> News:
        """The next news of that state, from the count-th on."""
        with self._more:
            assert self._more.wait_for(lambda: sum(n.state == state for n in self.news) >= count, 100), (
                self.news
            )
            return [n for n in self.news if n.state == state][count - 1]

    def status(self) -> dict[str, object]:
        return dict(json.loads((self.out / "status.json").read_text("utf-8")))


@contextmanager
def watched(folder: Path, slow: float = 0.0) -> Iterator[Desk]:
    desk, stop = Desk(folder), threading.Event()

    class Counting(Silence):
        def advance(self, stage: str, amount: int, seconds: float) -> None:
            if stage == "film":
                desk.films += 1
                time.sleep(slow)

    @contextmanager
    def counting() -> Iterator[Counting]:
        yield Counting()

    desk.script.write_text(SCRIPT, "utf-8")
    loop = threading.Thread(
        target=watch, args=(desk.script, desk.out, lambda: wanted(desk.script), desk.told, counting, stop)
    )
    loop.start()
    try:
        yield desk
    finally:
        stop.set()
        loop.join(60)
        assert not loop.is_alive()


@pytest.fixture(autouse=True)
def kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(cache_module.VARIABLE, "512")
    monkeypatch.setattr(cache_module, "results_folder", lambda: tmp_path / "kept")


def test_a_draft_comes_first_and_a_mistake_leaves_the_last_build(tmp_path: Path) -> None:
    with watched(tmp_path) as desk:
        draft, firsts, done = desk.until("draft"), desk.until("firsts"), desk.until("done")
        assert (draft.revision, firsts.revision, done.revision) == (1, 2, 3)
        assert firsts.result is not None
        assert [len(shot.takes) for shot in firsts.result.build.shots] == [1, 1]
        assert all(shot.takes[0].media.video for shot in firsts.result.build.shots)
        assert draft.result is not None
        assert draft.result.build.draft
        assert desk.status()["state"] == "done"
        assert desk.status()["revision"] == 3
        good = (desk.out / "storyboard.json").read_bytes()

        desk.script.write_text(SCRIPT.replace("(anna wave)", "(anna wavve)"), "utf-8")
        wrong = desk.until("error")
        assert wrong.report is not None
        assert wrong.report.errors[0].span.text == "wavve"
        status = desk.status()
        assert (status["schema"], status["state"], status["revision"]) == ("vds.status/1", "error", 3)
        (finding,) = status["diagnostics"]  # type: ignore[misc]
        assert (finding["line"], finding["code"]) == (7, "VDS071")
        assert (desk.out / "storyboard.json").read_bytes() == good

        desk.script.write_text(SCRIPT, "utf-8")  # as it was: nothing to draft, nothing to film
        desk.until("done", 2)
        assert desk.films == 4
        assert sum(n.state == "draft" for n in desk.news) == 1
    assert desk.status()["message"] == "stopped"


def test_a_save_meanwhile_starts_anew_and_loses_nothing(tmp_path: Path) -> None:
    with watched(tmp_path, slow=1.0) as desk:
        desk.until("draft")
        while not desk.films:
            time.sleep(0.01)
        desk.script.write_text(SCRIPT.replace("(push medium", "(pull medium"), "utf-8")
        done = desk.until("done")
        assert done.result is not None
        assert [s.shot.movements for s in done.result.build.shots] == [("static",), ("pull",)]
        assert desk.films == 4, "the first shot's films were kept from the run that was left"
        assert sum(n.state == "done" for n in desk.news) == 1


def test_what_is_written_before_the_first_build_is_in_nobodys_way(tmp_path: Path) -> None:
    (tmp_path / "build").mkdir()
    (tmp_path / "build" / "status.json").write_text("{}")
    with watched(tmp_path) as desk:
        assert desk.until("done").revision == 3


def test_settings_beside_the_script_are_read_anew(tmp_path: Path) -> None:
    settings = tmp_path / "vds.toml"
    settings.write_text("[compile]\nburn-in = maybe\n")
    with watched(tmp_path) as desk:
        wrong = desk.until("error")  # from the very start: it goes on, and waits for it to be mended
        assert wrong.report is not None
        assert (wrong.report.errors[0].code, wrong.revision) == ("VDS313", 0)
        settings.write_text("[compile]\nburn-in = false\n")
        plain = desk.until("done").result
        settings.write_text("[compile]\nburn-in = true\n")
        burned = desk.until("done", 2).result
        assert plain is not None
        assert burned is not None
        assert desk.films == 8, "all four takes were filmed again, with words on them"


def test_what_is_no_file_of_the_script_is_not_heard_of(tmp_path: Path) -> None:
    script, build = tmp_path / "story.vds", tmp_path / "build"
    build.mkdir()
    (tmp_path / "notes").mkdir()
    ears = _Ears(script, build, threading.Event())
    names = (
        *("build", "notes", ".build.new-1-x", ".story.vds.swp", "story.vds~", "other.vds.lock"),
        *("watch.log", "notes.txt", "story"),  # what is kept on being written there would never let it film
        *("story.vds", "story.vds.lock", "vds.toml", "vds.taste", "common.vds", "chair.glb", "chair.mtl"),
    )
    heard = [name for name in names if ears._matters(Change.modified, str(tmp_path / name))]
    assert heard == list(names[-7:])
    build.rmdir()  # between two builds, where they cannot be exchanged
    assert not ears._matters(Change.deleted, str(build))
