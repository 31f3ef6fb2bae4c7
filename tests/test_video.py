"""Videos come back as they went in: frames, rate, pixel format, and an index in front."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import av
import numpy as np
import pytest

from runtime.video import VideoError, VideoWriter, join_videos, read_video, video_info, write_video


def clip(count: int, size: tuple[int, int] = (96, 64), start: int = 0) -> list[np.ndarray]:
    """A bright square that moves two pixels a frame over flat colour."""
    frames = []
    for i in range(start, start + count):
        frame = np.full((size[1], size[0], 3), (40, 120, 200), np.uint8)
        frame[16:40, (2 * i) % 64 : (2 * i) % 64 + 24] = (240, 220, 60)
        frames.append(frame)
    return frames


@pytest.mark.parametrize("fps", [(24, 1), (25, 1), (24000, 1001), (30000, 1001)])
def test_frames_and_rate_survive(tmp_path: Path, fps: tuple[int, int]) -> None:
    frames = clip(30)
    assert write_video(tmp_path / "a.mp4", frames, fps) == 30
    back = list(read_video(tmp_path / "a.mp4"))
    assert video_info(tmp_path / "a.mp4") == ((96, 64), fps, 30)
    assert len(back) == 30
    for sent, got in zip(frames, back, strict=True):
        assert np.abs(sent.astype(int) - got).mean() < 6
    assert [p.name for p in tmp_path.iterdir()] == ["a.mp4"]


def test_stream_is_what_browsers_play(tmp_path: Path) -> None:
    write_video(tmp_path / "a.mp4", clip(5), (24, 1))
    with av.open(str(tmp_path / "a.mp4")) as container:
        stream = container.streams.video[0]
        assert (stream.codec_context.name, stream.pix_fmt) == ("h264", "yuv420p")
        frame = next(container.decode(video=0))
        assert int(frame.colorspace) in (5, 6)
    data = (tmp_path / "a.mp4").read_bytes()
    assert 0 < data.index(b"moov") < data.index(b"mdat")


def test_joined_parts_are_the_frames_in_order(tmp_path: Path) -> None:
    first, second, third = clip(20), clip(1, start=9), clip(13, start=5)
    for name, frames in (("1.mp4", first), ("2.mp4", second), ("3.mp4", third)):
        write_video(tmp_path / name, frames, (24000, 1001))
    parts = [tmp_path / f"{i}.mp4" for i in (1, 2, 3)]
    assert join_videos(tmp_path / "all.mp4", parts) == 34
    assert video_info(tmp_path / "all.mp4") == ((96, 64), (24000, 1001), 34)
    want = [frame for part in parts for frame in read_video(part)]
    got = list(read_video(tmp_path / "all.mp4"))
    assert len(got) == 34
    assert all(np.array_equal(a, b) for a, b in zip(want, got, strict=True))
    with av.open(str(tmp_path / "all.mp4")) as container:
        times = [float(f.time) for f in container.decode(video=0)]
    np.testing.assert_allclose(times, np.arange(34) * 1001 / 24000, atol=2e-4)


def test_parts_that_do_not_fit_are_refused(tmp_path: Path) -> None:
    write_video(tmp_path / "1.mp4", clip(4), (24, 1))
    write_video(tmp_path / "2.mp4", clip(4, size=(128, 64)), (24, 1))
    with pytest.raises(VideoError, match=r"2\.mp4"):
        join_videos(tmp_path / "all.mp4", [tmp_path / "1.mp4", tmp_path / "2.mp4"])
    assert sorted(p.name for p in tmp_path.iterdir()) == ["1.mp4", "2.mp4"]


def test_failure_keeps_the_old_file(tmp_path: Path) -> None:
    path = tmp_path / "a.mp4"
    write_video(path, clip(3), (24, 1))
    before = path.read_bytes()
    with pytest.raises(RuntimeError), VideoWriter(path, (96, 64), (24, 1)) as writer:  # noqa: PT012
        writer.write(clip(1)[0])
        raise RuntimeError("stopped")
    assert path.read_bytes() == before
    assert [p.name for p in tmp_path.iterdir()] == ["a.mp4"]


def test_clear_errors(tmp_path: Path) -> None:
    with pytest.raises(VideoError, match="missing"):
        VideoWriter(tmp_path / "missing" / "a.mp4", (96, 64), (24, 1))
    with pytest.raises(ValueError, match="even"):
        VideoWriter(tmp_path / "a.mp4", (95, 64), (24, 1))
    with pytest.raises(VideoError, match="at least one frame"):
        write_video(tmp_path / "a.mp4", [], (24, 1))
    with pytest.raises(VideoError, match=r"nothing\.mp4"):
        list(read_video(tmp_path / "nothing.mp4"))
    (tmp_path / "text.mp4").write_text("not a film")
    with pytest.raises(VideoError, match=r"text\.mp4"):
        list(read_video(tmp_path / "text.mp4"))
    with (
        pytest.raises(ValueError, match="expected uint8"),
        VideoWriter(tmp_path / "a.mp4", (96, 64), (24, 1)) as w,
    ):
        w.write(np.zeros((64, 96), np.uint8))


FULL_DISK = """
import resource, signal, sys
import numpy as np
from runtime.video import VideoError, write_video
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (60_000, 60_000))
noise = np.random.default_rng(0).integers(0, 255, (64, 96, 3), dtype=np.uint8)
try:
    write_video(sys.argv[1], (np.roll(noise, i, 0) for i in range(200)), (24, 1))
except VideoError as error:
    print("VideoError:", error)
"""


def test_a_disk_that_fills_up_is_a_video_error(tmp_path: Path) -> None:
    path = tmp_path / "a.mp4"
    done = subprocess.run(
        [sys.executable, "-c", FULL_DISK, str(path)], capture_output=True, text=True, timeout=60
    )
    assert done.stdout.startswith("VideoError: cannot write"), done.stdout + done.stderr
    assert list(tmp_path.iterdir()) == []
