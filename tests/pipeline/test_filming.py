"""Takes as they are filmed: frames that wait for a slow encoder are those that were drawn."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from runtime.video import FRAMES_WAITING, VideoWriter
from runtime.worker import Worker
from vdsl.emit.video import write_take
from vdsl.pipeline.bench_render import filmable
from vdsl.pipeline.filming import Camerawork

SIZE = (128, 72)
SCRIPT = """storyboard "t"
character anna = woman
scene s = apartment.kitchen
(anna walk counter) / (follow full eye-level)
"""


def test_frames_drawn_beside_a_slow_encoder_are_those_drawn_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "t.vds").write_text(SCRIPT, "utf-8")
    act, story, moving, fixed = filmable(tmp_path / "t.vds")
    work = Camerawork("cpu")
    alone = [
        np.array([frame.copy() for frame in work.take_frames(act.staged, "board", story, camera, SIZE)])
        for camera in (moving, fixed)
    ]
    assert len(alone[0]) > 2 * FRAMES_WAITING  # enough for memory to be used again
    encoded: dict[str, list[NDArray[np.uint8]]] = {"take-1.mp4": [], "take-2.mp4": []}
    write = VideoWriter.write

    def slow(writer: VideoWriter, frame: NDArray[np.uint8]) -> None:
        time.sleep(0.004)
        encoded[writer.path.name].append(frame.copy())
        write(writer, frame)

    monkeypatch.setattr(VideoWriter, "write", slow)
    with Worker(FRAMES_WAITING) as worker:
        for rank, camera in ((1, moving), (2, fixed)):
            frames = work.take_frames(act.staged, "board", story, camera, SIZE)
            write_take(tmp_path, "s", rank, frames, story.frames, (24, 1), worker=worker)
    for drawn, film in zip(alone, encoded.values(), strict=True):
        np.testing.assert_array_equal(np.array(film), drawn)
