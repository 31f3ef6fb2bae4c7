"""H.264 files, written and read frame by frame.

Assumes uint8 RGB pictures of one even size. Guarantees: yuv420p with its colour space tagged
(BT.601, limited range), an exact rational frame rate, the index in front of the pictures (faststart)
so that a browser can start at once, memory that does not grow with length, and a file that is either
complete or not there. Identical frames mostly give identical bytes, but that is not promised: on a
busy machine x264 was seen to code the same pictures another way about once in 500 runs.
"""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterable, Iterator
from fractions import Fraction
from functools import partial
from pathlib import Path
from types import TracebackType
from typing import Any

import av
import cv2
import numpy as np
from av.error import FFmpegError
from numpy.typing import NDArray

from .worker import Worker

#: So many frames may wait for the encoder: what a renderer draws in one launch.
FRAMES_WAITING = 12
#: Threads of the encoder, beside the renderer's. Four take a tenth more processor time, for larger files.
ENCODER_THREADS = 2
#: x264's settings. Of its fastest, with what a drawn picture needs most beside: arithmetic coding, a filter
#: against blocks, and bits for what later frames are made of. Measured on takes at 720p: 0.4 times the
#: processor time of its preset "veryfast", for files half as large again that look the same.
_CODING = {
    "preset": "ultrafast",
    "x264-params": "cabac=1:deblock=1,0,0:mbtree=1:rc-lookahead=10:aq-mode=1",
}
#: How many frames x264 holds back to put B-frames in order: it makes none.
_REORDER_FRAMES = 0
_BT601, _LIMITED = 6, 1  # AVCOL_SPC_SMPTE170M and its primaries and transfer, AVCOL_RANGE_MPEG


class VideoError(OSError):
    """A video could not be written or read; the message names the file and the reason."""


class VideoWriter:
    """Writes one H.264 mp4, a frame at a time; use as a context manager.

    The frames go to a hidden temporary file beside ``path``, which takes the name ``path`` when the
    block ends well and is removed when it does not.

    size: (width, height) in pixels, both even; fps: (numerator, denominator)
    crf: 0 lossless .. 51, 18-23 is usual
    """

    def __init__(
        self,
        path: str | Path,
        size: tuple[int, int],
        fps: tuple[int, int],
        *,
        crf: int = 20,
    ) -> None:
        if size[0] <= 0 or size[1] <= 0 or size[0] % 2 or size[1] % 2:
            raise ValueError(f"a video's width and height must be even and positive, not {size[0]}x{size[1]}")
        self.path, self.size, self.fps = Path(path), size, Fraction(*fps)
        self.frames = 0
        self._part = self.path.with_name(f".{self.path.name}.{os.getpid()}.part")
        self._container: Any = None
        try:
            self._container = _open_mp4(self._part)
            self._stream = _h264_stream(self._container, size, self.fps, crf)
        except (FFmpegError, OSError) as error:
            self.discard()
            raise _video_error("cannot write", self.path, error) from error

    def write(self, frame: NDArray[np.uint8]) -> None:
        """Append a picture: uint8 [H, W, 3], sRGB."""
        width, height = self.size
        if frame.shape != (height, width, 3) or frame.dtype != np.uint8:
            raise ValueError(f"expected uint8 {(height, width, 3)}, got {frame.dtype} {frame.shape}")
        planes = cv2.cvtColor(np.ascontiguousarray(frame), cv2.COLOR_RGB2YUV_I420)
        picture = av.VideoFrame.from_ndarray(planes, format="yuv420p")
        picture.pts, picture.time_base = self.frames, 1 / self.fps
        picture.colorspace, picture.color_range = _BT601, _LIMITED
        self._encode(picture)
        self.frames += 1

    def _encode(self, picture: av.VideoFrame | None) -> None:
        try:
            for packet in self._stream.encode(picture):
                self._container.mux(packet)
        except (FFmpegError, OSError) as error:
            self.discard()
            raise _video_error("cannot write", self.path, error) from error

    def close(self) -> None:
        """Finish the file and give it its name."""
        if self._container is None:
            return
        if not self.frames:
            self.discard()
            raise VideoError(f"cannot write {self.path}: a video needs at least one frame")
        self._encode(None)
        try:
            self._container.close()
            os.replace(self._part, self.path)
        except (FFmpegError, OSError) as error:
            self.discard()
            raise _video_error("cannot write", self.path, error) from error
        self._container = None

    def discard(self) -> None:
        """Drop everything written so far; the path is left as it was."""
        _discard(self._container, self._part)
        self._container = None

    def __enter__(self) -> VideoWriter:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if kind is None:
            self.close()
        else:
            self.discard()


def write_video(path: str | Path, frames: Iterable[NDArray[np.uint8]], fps: tuple[int, int]) -> int:
    """Write all frames (uint8 [H, W, 3] each) and return how many there were.

    Each is encoded while the next ones are made; nobody writes to one that was given.
    """
    writer: VideoWriter | None = None
    with Worker(FRAMES_WAITING) as worker:
        try:
            for frame in frames:
                writer = writer or VideoWriter(path, (frame.shape[1], frame.shape[0]), fps)
                worker.do(partial(writer.write, frame))
            if writer is None:
                raise VideoError(f"cannot write {path}: a video needs at least one frame")
            worker.do(writer.close)
            worker.wait()
        except BaseException:
            if writer is not None:
                worker.undo(writer.discard)
            raise
    return writer.frames


def read_video(path: str | Path) -> Iterator[NDArray[np.uint8]]:
    """The frames of a video in order, each uint8 [H, W, 3] sRGB."""
    with _opened(path) as container:
        try:
            for frame in container.decode(video=0):
                if frame.format.name == "yuv420p":  # the exact inverse of what the writer does, and quicker
                    yield cv2.cvtColor(frame.to_ndarray(), cv2.COLOR_YUV2RGB_I420).astype(
                        np.uint8, copy=False
                    )
                else:
                    yield frame.to_ndarray(format="rgb24")
        except FFmpegError as error:
            raise _video_error("cannot read", path, error) from error


def video_info(path: str | Path) -> tuple[tuple[int, int], tuple[int, int], int]:
    """(width, height), fps as (numerator, denominator) and the number of frames, without decoding."""
    with _opened(path) as container:
        stream = container.streams.video[0]
        rate = stream.average_rate or Fraction(0)
        return (stream.width, stream.height), (rate.numerator, rate.denominator), stream.frames


def join_videos(path: str | Path, parts: Iterable[str | Path]) -> int:
    """Put videos of one size, rate and encoder setting end to end without encoding again.

    Returns the number of frames. Raises :class:`VideoError` where the parts do not fit together.
    """
    path = Path(path)
    part_name = path.with_name(f".{path.name}.{os.getpid()}.part")
    output: Any = None
    frames = packets = 0
    try:
        output = _open_mp4(part_name)
        stream: Any = None
        first: Any = None
        for part in parts:
            with _opened(part) as source:
                video = source.streams.video[0]
                if stream is None:
                    stream, first = output.add_stream_from_template(video), _signature(video)
                elif _signature(video) != first:
                    raise VideoError(
                        f"cannot join {part}: its size, rate or encoding differs from the others"
                    )
                ticks = round(1 / (video.average_rate * video.time_base))
                for packet in source.demux(video):
                    if packet.dts is None:
                        continue
                    # Every packet is one frame, so decoding times are counted through all the parts.
                    packet.pts += frames * ticks
                    packet.dts = (packets - _REORDER_FRAMES) * ticks
                    packet.stream = stream
                    output.mux(packet)
                    packets += 1
                frames = packets
        if stream is None:
            raise VideoError(f"cannot write {path}: a video needs at least one frame")
        output.close()
        os.replace(part_name, path)
    except (FFmpegError, OSError) as error:
        _discard(output, part_name)
        if isinstance(error, VideoError):
            raise
        raise _video_error("cannot write", path, error) from error
    except BaseException:
        _discard(output, part_name)
        raise
    return frames


def _signature(video: Any) -> tuple[Any, ...]:
    return (
        video.width,
        video.height,
        video.average_rate,
        video.time_base,
        bytes(video.codec_context.extradata),
    )


def _open_mp4(path: Path) -> Any:
    path.open("wb").close()  # av opens the file only with the first frame: find out now
    return av.open(str(path), "w", format="mp4", options={"movflags": "+faststart", "fflags": "+bitexact"})


def _h264_stream(container: Any, size: tuple[int, int], fps: Fraction, crf: int) -> Any:
    stream = container.add_stream("libx264", rate=fps)
    stream.width, stream.height = size
    stream.pix_fmt = "yuv420p"
    stream.options = {**_CODING, "crf": str(crf), "g": str(round(fps * 2))}
    context = stream.codec_context
    context.thread_count = ENCODER_THREADS
    context.colorspace = context.color_primaries = context.color_trc = _BT601
    context.color_range = _LIMITED
    return stream


def _opened(path: str | Path) -> Any:
    try:
        container = av.open(str(path))
    except (FFmpegError, OSError, ValueError) as error:
        raise _video_error("cannot read", path, error) from error
    if not container.streams.video:
        container.close()
        raise VideoError(f"cannot read {path}: there is no video in it")
    return container


def _discard(container: Any, part: Path) -> None:
    if container is not None:
        # It is being thrown away, and the first error is the one worth reporting.
        with contextlib.suppress(FFmpegError, OSError, ValueError):
            container.close()
    part.unlink(missing_ok=True)


def _video_error(what: str, path: str | Path, error: BaseException) -> VideoError:
    number = getattr(error, "errno", None)
    reason = os.strerror(number) if isinstance(number, int) and 0 < number < 200 else str(error)
    failure = VideoError(f"{what} {path}: {reason}")
    failure.errno = number if isinstance(number, int) else None
    return failure
