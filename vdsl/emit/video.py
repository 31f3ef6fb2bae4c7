"""The films: one of every take, and the animatic of the best takes in order.

Frames are streamed; nothing here holds more than a transition's worth of them. Shots that join by
cuts go into the animatic as they were encoded; only shots in a transition are encoded again.
"""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from runtime.video import FRAMES_WAITING, VideoError, VideoWriter, join_videos, read_video, write_video
from runtime.worker import Worker

from .burnin import BurnIn, burn
from .folder import write_bytes
from .guides import NO_GUIDES, Guides
from .overlay import guided
from .timeline import OVERLAPPING, Placed, placed_shots
from .types import Build, TakeMedia

#: Where in a take the contact sheet's keyframes are; the middle one is the poster.
KEY_MOMENTS = (0.04, 0.5, 0.96)
KEY_WIDTH = 640


def take_paths(folder: Path, shot: str, rank: int) -> tuple[Path, Path, Path]:
    """Video, poster and track of a take in a build's folder."""
    base = folder / "shots" / shot
    return base / f"take-{rank}.mp4", base / f"take-{rank}.jpg", base / f"take-{rank}.json"


def write_take(
    folder: Path,
    shot: str,
    rank: int,
    frames: Iterable[NDArray[np.uint8]],
    count: int,
    fps: tuple[int, int],
    strip: BurnIn | None = None,
    guides: Guides = NO_GUIDES,
    keyed: bool = False,
    worker: Worker | None = None,
    finished: Callable[[TakeMedia], object] = lambda media: None,
) -> TakeMedia:
    """Encode a take and its poster. Only the best take of a shot keeps keyframes: the sheet shows no other.

    frames: ``count`` pictures uint8 [H, W, 3], which nobody writes to any more; strip: what to write on every
    frame, if anything; guides: what to draw over every frame; keyed: keep the keyframes of this one whatever
    its rank; worker: encodes while the next frames are drawn and after the return: the files are there once
    its work is done. Without one they are there at once. finished: called by the worker when they are
    """
    if worker is None:
        with Worker(FRAMES_WAITING) as own:
            return write_take(folder, shot, rank, frames, count, fps, strip, guides, keyed, own, finished)
    video, poster, _ = take_paths(folder, shot, rank)
    video.parent.mkdir(parents=True, exist_ok=True)
    wanted = key_frames(count)
    keys: dict[int, NDArray[np.uint8]] = {}
    take = _Developing(video, poster, wanted[1], fps, strip, guides)
    drawn = 0
    try:
        for drawn, frame in enumerate(frames, start=1):
            worker.do(partial(take.add, drawn - 1, frame), take.discard)
            if drawn - 1 in wanted and (keyed or rank == 1):
                keys[drawn - 1] = reduced(frame)
        if drawn != count:
            raise ValueError(f"{shot} take {rank}: expected {count} frames, got {drawn}")
        media = TakeMedia(video, poster, count, tuple(keys[i] for i in wanted if i in keys))
        worker.do(take.close, take.discard)
    except BaseException:
        worker.undo(take.discard)
        raise
    worker.do(partial(finished, media))
    return media


class _Developing:
    """A take's film and poster in the making. poster_at: the frame that is the poster"""

    def __init__(
        self,
        video: Path,
        poster: Path,
        poster_at: int,
        fps: tuple[int, int],
        strip: BurnIn | None,
        guides: Guides,
    ) -> None:
        self._video, self._poster, self._poster_at = video, poster, poster_at
        self._fps, self._strip, self._guides = fps, strip, guides
        self._writer: VideoWriter | None = None

    def add(self, index: int, frame: NDArray[np.uint8]) -> None:
        """Encode a frame, uint8 [H, W, 3], with what is written and drawn over it."""
        picture = guided(frame, self._guides)
        picture = burn(picture, self._strip, index) if self._strip is not None else picture
        if self._writer is None:
            self._writer = VideoWriter(self._video, (picture.shape[1], picture.shape[0]), self._fps)
        self._writer.write(picture)
        if index == self._poster_at:
            write_poster(self._poster, picture)

    def close(self) -> None:
        """Finish the film."""
        assert self._writer is not None
        self._writer.close()

    def discard(self) -> None:
        """Drop the film unless it is finished."""
        if self._writer is not None:
            self._writer.discard()


def write_poster(path: Path, frame: NDArray[np.uint8]) -> None:
    """A JPEG of one frame, uint8 [H, W, 3] sRGB."""
    done, data = cv2.imencode(".jpg", cv2.cvtColor(frame, cv2.COLOR_RGB2BGR), [cv2.IMWRITE_JPEG_QUALITY, 90])
    if not done:
        raise VideoError(f"cannot write {path}: the picture could not be encoded")
    write_bytes(path, data.tobytes())


#: Writes shots that are joined by transitions as one film: its path, their films and places, the frame rate.
WritePart = Callable[[Path, Sequence[tuple[Path, Placed]], tuple[int, int]], object]


def write_part(path: Path, shots: Sequence[tuple[Path, Placed]], fps: tuple[int, int]) -> None:
    """Consecutive shots with their transitions drawn, encoded again."""
    write_video(path, film_frames_of(shots), fps)


def write_animatic(path: Path, build: Build, part_to: WritePart = write_part) -> None:
    """The best take of every shot, joined as the script says. Writes nothing where no shot has a film.

    part_to: writes what is seen in transitions, or has it from where it was kept
    """
    shown = build.shown
    if not shown or build.draft:
        return
    fps = build.storyboard.fps
    videos = [s.takes[0].media.video for s in shown]
    placed = placed_shots(build)
    scratch = Path(tempfile.mkdtemp(prefix=".animatic-", dir=path.parent))
    try:
        parts = []
        for number, run in enumerate(_runs(placed)):
            if len(run) == 1 and _untouched(placed[run[0]]):
                parts.append(videos[run[0]])
                continue
            part = scratch / f"{number}.mp4"
            part_to(part, [(videos[i], placed[i]) for i in run], fps)
            parts.append(part)
        try:
            join_videos(path, parts)
        except VideoError as error:
            if error.errno:  # the disk's fault, not the parts'
                raise
            write_part(path, list(zip(videos, placed, strict=True)), fps)
    finally:
        shutil.rmtree(scratch, ignore_errors=True)


def film_frames_of(shots: Sequence[tuple[Path, Placed]]) -> Iterator[NDArray[np.uint8]]:
    """The frames of consecutive shots with their transitions drawn."""
    tail: list[NDArray[np.uint8]] = []
    for video, place in shots:
        held: list[NDArray[np.uint8]] = []
        keep_from = place.frames - (place.leave_frames if place.leave in OVERLAPPING else 0)
        for i, frame in enumerate(read_video(video)):
            picture = frame
            if i < place.enter_frames:
                share = (i + 1) / (place.enter_frames + 1)
                under = tail[i] if place.enter in OVERLAPPING and tail else np.zeros_like(frame)
                picture = wipe(under, frame, share) if place.enter == "wipe" else mix(under, frame, share)
            if i >= keep_from:
                held.append(picture)
                continue
            if place.leave == "fade-out" and i >= place.frames - place.leave_frames:
                share = (place.frames - i) / (place.leave_frames + 1)
                picture = mix(np.zeros_like(picture), picture, share)
            yield picture
        tail = held
    yield from tail


def mix(first: NDArray[np.uint8], second: NDArray[np.uint8], share: float) -> NDArray[np.uint8]:
    """``share`` of the second picture over the first."""
    return np.asarray(cv2.addWeighted(first, 1 - share, second, share, 0), np.uint8)


def wipe(first: NDArray[np.uint8], second: NDArray[np.uint8], share: float) -> NDArray[np.uint8]:
    """The second picture drawn over the first from the left, up to ``share`` of the width."""
    edge = round(first.shape[1] * share)
    return np.concatenate([second[:, :edge], first[:, edge:]], axis=1)


def _runs(placed: tuple[Placed, ...]) -> list[list[int]]:
    """Indices of shots grouped so that shots seen at once are together."""
    runs: list[list[int]] = []
    for i, place in enumerate(placed):
        if runs and place.enter in OVERLAPPING:
            runs[-1].append(i)
        else:
            runs.append([i])
    return runs


def _untouched(place: Placed) -> bool:
    return place.enter == "cut" and place.leave == "cut"


def key_frames(count: int) -> tuple[int, ...]:
    """Which frames of a take of a length are its keyframes."""
    """Where the keyframes of a take of so many frames are."""
    return tuple(round(q * (count - 1)) for q in KEY_MOMENTS)


def reduced(frame: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """A frame as it is kept for the contact sheet: no wider than that needs."""
    height, width = frame.shape[:2]
    if width <= KEY_WIDTH:
        return frame.copy()
    size = (KEY_WIDTH, max(1, round(height * KEY_WIDTH / width)))
    return np.asarray(cv2.resize(frame, size, interpolation=cv2.INTER_AREA), np.uint8)
