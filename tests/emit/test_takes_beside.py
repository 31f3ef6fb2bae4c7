"""Takes encoded by a worker while the next are drawn: the same films, and nothing of one that failed."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from emit_film import FPS, pictures
from numpy.typing import NDArray

from runtime.video import FRAMES_WAITING, VideoError, VideoWriter, read_video
from runtime.worker import Worker
from vdsl.emit.types import TakeMedia
from vdsl.emit.video import write_take


def test_a_take_is_drawn_while_the_one_before_is_finished(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    begun, seen, close = threading.Event(), list[bool](), VideoWriter.close

    def closed_late(writer: VideoWriter) -> None:
        seen.append(begun.wait(10))
        close(writer)

    def second() -> Iterator[NDArray[np.uint8]]:
        begun.set()
        yield from pictures(6, 90)

    monkeypatch.setattr(VideoWriter, "close", closed_late)
    finished: list[TakeMedia] = []
    with Worker(FRAMES_WAITING) as worker:
        for rank, frames in ((1, pictures(6, 30)), (2, second())):
            write_take(tmp_path, "s", rank, frames, 6, FPS, worker=worker, finished=finished.append)
    assert seen == [True, True]
    assert [m.video.name for m in finished] == ["take-1.mp4", "take-2.mp4"]
    monkeypatch.undo()
    for rank, shade in ((1, 30), (2, 90)):
        alone = write_take(tmp_path, "alone", rank, pictures(6, shade), 6, FPS)
        films = (list(read_video(v)) for v in (alone.video, finished[rank - 1].video))
        for a, b in zip(*films, strict=True):
            assert np.abs(a.astype(int) - b).max() <= 1  # the encoder may code the same frames in two ways


def test_an_encoder_that_fails_halfway_is_told_and_leaves_nothing_of_the_take(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write = VideoWriter.write

    def fails(writer: VideoWriter, frame: NDArray[np.uint8]) -> None:
        if writer.path.name == "take-2.mp4" and writer.frames == 3:
            raise VideoError("cannot write take-2.mp4: No space left on device")
        write(writer, frame)

    monkeypatch.setattr(VideoWriter, "write", fails)
    finished: list[TakeMedia] = []
    with pytest.raises(VideoError, match="take-2"), Worker(FRAMES_WAITING) as worker:  # noqa: PT012
        for rank in (1, 2, 3):
            write_take(
                tmp_path, "s", rank, pictures(30, 90), 30, FPS, worker=worker, finished=finished.append
            )
        raise AssertionError("more frames were drawn than can wait")
    assert [m.video.name for m in finished] == ["take-1.mp4"]
    assert not [p.name for p in (tmp_path / "shots" / "s").glob(".*")]
    assert not list(tmp_path.rglob("take-2.mp4"))
    assert not list(tmp_path.rglob("take-3.*"))


def test_a_take_that_is_left_halfway_leaves_the_one_before_whole(tmp_path: Path) -> None:
    def interrupted() -> Iterator[NDArray[np.uint8]]:
        yield from pictures(5, 90)
        raise KeyboardInterrupt

    finished: list[TakeMedia] = []
    with pytest.raises(KeyboardInterrupt), Worker(FRAMES_WAITING) as worker:  # noqa: PT012
        write_take(tmp_path, "s", 1, pictures(30, 90), 30, FPS, worker=worker, finished=finished.append)
        write_take(tmp_path, "s", 2, interrupted(), 30, FPS, worker=worker, finished=finished.append)
    assert [len(list(read_video(m.video))) for m in finished] == [30]
    assert sorted(p.name for p in (tmp_path / "shots" / "s").iterdir()) == ["take-1.jpg", "take-1.mp4"]
