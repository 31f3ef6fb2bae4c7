"""A build appears whole or not at all, and never in the place of something else."""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest

from vdsl.emit import folder as folder_module
from vdsl.emit.folder import BuildFolderError, staged_build, write_text


def put_build(target: Path, text: str) -> None:
    with staged_build(target) as stage:
        write_text(stage / "storyboard.json", json.dumps({"schema": "vds.storyboard/1", "text": text}))
        (stage / "shots").mkdir()


def text_of(target: Path) -> str:
    return json.loads((target / "storyboard.json").read_text())["text"]


def test_new_build_takes_the_place_of_the_old(tmp_path: Path) -> None:
    target = tmp_path / "build" / "story"
    put_build(target, "one")
    (target / "shots" / "left.mp4").write_text("old")
    put_build(target, "two")
    assert text_of(target) == "two"
    assert not (target / "shots" / "left.mp4").exists()
    assert [p.name for p in target.parent.iterdir()] == ["story"]


@pytest.mark.parametrize("stop", [RuntimeError, KeyboardInterrupt])
def test_failure_in_the_middle_leaves_the_old_build(tmp_path: Path, stop: type[BaseException]) -> None:
    target = tmp_path / "story"
    put_build(target, "one")
    with pytest.raises(stop), staged_build(target) as stage:  # noqa: PT012
        write_text(stage / "storyboard.json", "{}")
        raise stop
    assert text_of(target) == "one"
    assert [p.name for p in tmp_path.iterdir()] == ["story"]


def test_failure_of_the_swap_puts_the_old_build_back(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    target = tmp_path / "story"
    put_build(target, "one")
    rename = os.rename

    def failing(a: Path, b: Path) -> None:
        if ".new-" in str(a):
            raise OSError(28, "No space left on device")
        rename(a, b)

    monkeypatch.setattr(folder_module, "exchange", lambda one, two: False)
    monkeypatch.setattr(folder_module.os, "rename", failing)
    with pytest.raises(BuildFolderError, match="No space left") as caught:
        put_build(target, "two")
    assert caught.value.errno == 28
    assert text_of(target) == "one"
    assert [p.name for p in tmp_path.iterdir()] == ["story"]


def test_interrupted_swap_is_undone_by_the_next_run(tmp_path: Path) -> None:
    target = tmp_path / "story"
    put_build(target, "one")
    os.rename(target, tmp_path / ".story.old")
    with pytest.raises(RuntimeError), staged_build(target):
        raise RuntimeError
    assert text_of(target) == "one"


def test_the_writers_own_files_stay(tmp_path: Path) -> None:
    target = tmp_path / "story"
    put_build(target, "one")
    (target / "picks.json").write_text("mine")
    (target / "sheet-2.png").write_text("stale")
    put_build(target, "two")
    assert (target / "picks.json").read_text() == "mine"
    assert not (target / "sheet-2.png").exists()


def test_other_folders_and_files_are_not_replaced(tmp_path: Path) -> None:
    (tmp_path / "photos").mkdir()
    (tmp_path / "photos" / "cat.jpg").write_text("cat")
    with pytest.raises(BuildFolderError, match="not a build"):
        put_build(tmp_path / "photos", "one")
    assert (tmp_path / "photos" / "cat.jpg").read_text() == "cat"
    (tmp_path / "note").write_text("note")
    with pytest.raises(BuildFolderError, match="it is a file"):
        put_build(tmp_path / "note", "one")
    (tmp_path / "empty").mkdir()
    put_build(tmp_path / "empty", "one")


def test_a_place_that_cannot_be_written(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("x")
    with pytest.raises(BuildFolderError, match="cannot write"):
        put_build(tmp_path / "file" / "story", "one")
