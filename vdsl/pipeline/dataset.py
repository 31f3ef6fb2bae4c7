"""The discriminator's training set: random stories, filmed well and filmed badly.

Positives are what the virtual designer picks of a shot's proposals (:mod:`vdsl.pipeline.designer`), and still
does when they are drawn (:mod:`vdsl.pipeline.drawn`); negatives are proposals passed over, picks shaken about
at graded strengths, and picks made to show no type, about as many as there are positives
(:mod:`vdsl.pipeline.clips`). Every draw is keyed by the seed and the
story's number, whole stories go to disk in their order, and the set itself says which were: so it is the same
whether or not its making was stopped, and however many processes make it.
"""

from __future__ import annotations

import multiprocessing
import os
import pickle
import signal
import tempfile
from collections import deque
from collections.abc import Callable, Generator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import closing, suppress
from dataclasses import dataclass
from itertools import count, islice
from multiprocessing.queues import Queue
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ranker.data import ShardWriter
from ranker.guides import joined
from runtime.raster.types import LOOK_VERSION

from ..propose.types import ProposalGrid, StoryProposal
from .casting import Scene, Troupe
from .clips import Clip, as_seen, clips_of
from .drawn import as_drawn
from .filming import SEGMENTS, Camerawork, Seen
from .hints import hints_of
from .labels import WORDS
from .progress import Progress, Silence

#: Raised when other takes or labels come of the same seed.
_RECIPE = 40
#: Proposals of a shot in most stories, and in every so many-th: of many, more are looked for beside the best
#: and off the grid, as where ``compile`` looks for a take.
_PROPOSALS, _MANY, _EVERY = 8, 32, 5
_DRAWN_AT_ONCE = 64
_SHARD = 64
#: Processes at most, and stories that each may be ahead by, since one takes up to eight times as long as
#: another. They wait on disk.
_PROCESSES, _WAITING = 16, 3


@dataclass(frozen=True, eq=False)
class _Filmed:
    """The clips of a scene. frames: uint8 [T, S, S, 3] of each of the first; labels: of all of them, the rest
    that ``ShardWriter.add`` takes"""

    frames: Sequence[NDArray[np.uint8]]
    labels: list[tuple[Any, ...]]


@dataclass(frozen=True)
class _Making:
    """What every process that films needs to know.

    pictures: share of the stories for training whose clips get pictures; all clips of the others are bare
    every: whether in those stories all clips get pictures, also what is passed over and spoilt besides
    """

    seed: int
    device: str
    size: int
    pictures: float = 1.0
    every: bool = False

    def pictured(self, scene: Scene) -> bool:
        """Whether a scene's clips get pictures: all for testing do, and of the others every so many-th."""
        n = scene.number
        return scene.split == "test" or int((n + 1) * self.pictures) > int(n * self.pictures)


def made(seed: int, pictures: float = 1.0, every: bool = False) -> dict[str, Any]:
    """What a training set says of how it is made: sets that differ in it are not put together."""
    shared = {} if pictures == 1.0 else {"pictures": pictures}
    whole = {"every": True} if every else {}
    return {"seed": seed, "look": LOOK_VERSION, "recipe": _RECIPE, **shared, **whole}


def generate(
    folder: Path,
    clips: int,
    seed: int = 0,
    device: str = "auto",
    progress: Progress | None = None,
    size: int = 224,
    processes: int | None = None,
    pictures: float = 1.0,
    every: bool = False,
) -> int:
    """Write at least ``clips`` clips with pictures into ``folder``, going on where an earlier call stopped.

    size: side of the frames in pixels; processes: None for one on each core; pictures: share of the stories
    for training whose clips get pictures, where the rest are wanted for their guides; every: whether all
    clips of these stories get some, which makes five times as many in hardly more time, five in six of them
    bad. Returns how many clips have pictures.
    Raises OSError or :class:`ranker.RankerError` for a folder that cannot be used or holds another kind of
    set.
    """
    watcher = progress or Silence()
    with ShardWriter(
        folder, WORDS, (size, size), SEGMENTS, shard=1 << 30, made=made(seed, pictures, every)
    ) as writer:
        first = 1 + max((int(label.about.get("story", -1)) for label in writer.labels), default=-1)
        begun, last = len(writer), perf_counter()
        watcher.begin("clips", max(0, clips - begun), "clips")
        if begun >= clips:
            return begun
        making = _Making(seed, device, size, pictures, every)
        stories = _stories(first, making, processes or min(_cores(), _PROCESSES), folder)
        with closing(stories):  # what is still being filmed in the end is not wanted
            for story in stories:
                for scene in story:
                    for k, label in enumerate(scene.labels):
                        writer.add(scene.frames[k] if k < len(scene.frames) else None, *label)
                now = perf_counter()
                watcher.advance("clips", sum(len(scene.frames) for scene in story), now - last)
                last = now
                enough = len(writer) + writer.pending >= clips
                if writer.pending >= _SHARD or enough:
                    writer.flush()
                if enough:
                    break
        return len(writer)


def _cores() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _stories(
    first: int, making: _Making, processes: int, folder: Path
) -> Generator[list[_Filmed], None, None]:
    """The filmed scenes of all stories from ``first`` on, story by story in their order.

    folder: where processes leave for a moment what they filmed. Through a pipe it would go in pieces, and who
    waits for the rest of what a terminated process began to send waits for ever.
    """
    if processes == 1:
        film = _maker(making)
        yield from map(film, count(first))
        return
    context = multiprocessing.get_context("spawn")  # a forked process would share a renderer's threads
    others = set(multiprocessing.active_children())
    places: Queue[int] = context.Queue()
    for place in range(processes):
        places.put(place)
    waiting: deque[Future[Path]] = deque()
    # what is mapped cannot be removed on every disk
    between = tempfile.TemporaryDirectory(prefix=".filmed-", dir=folder, ignore_cleanup_errors=True)
    about = (places, making, Path(between.name))
    pool = ProcessPoolExecutor(processes, context, _settle, about)
    try:
        for number in count(first):
            waiting.append(pool.submit(_film_here, number))
            if len(waiting) >= _WAITING * processes:
                yield _taken(waiting.popleft().result(), making.size)
    except BrokenProcessPool as error:
        raise OSError(
            "a process that films stories was ended from outside, perhaps for want of memory; "
            "start again to go on from what is there"
        ) from error
    finally:  # what is still being filmed is not wanted any more
        for process in set(multiprocessing.active_children()) - others:
            process.terminate()
        pool.shutdown(cancel_futures=True)
        between.cleanup()


_here: list[Callable[[int], Path]] = []


def _settle(places: Queue[int], making: _Making, between: Path) -> None:
    """Make this process one that films stories, on a core of its own; whoever began it says when to stop."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    place = places.get()
    with suppress(AttributeError, OSError):  # where processes cannot be kept to cores, they share them
        cores = sorted(os.sched_getaffinity(0))
        os.sched_setaffinity(0, {cores[place % len(cores)]})
    film = _maker(making)

    def left(number: int) -> Path:
        path = between / str(number)
        _leave(path, film(number))
        return path

    _here.append(left)


def _film_here(number: int) -> Path:
    return _here[0](number)


def _leave(path: Path, scenes: list[_Filmed]) -> None:
    """Write a story for :func:`_taken`."""
    with path.with_suffix(".frames").open("wb") as file:
        for scene in scenes:
            file.writelines(np.ascontiguousarray(clip).data for clip in scene.frames)
    with path.open("wb") as file:
        told = [(len(scene.frames), scene.labels) for scene in scenes]
        pickle.dump(told, file, pickle.HIGHEST_PROTOCOL)


def _taken(path: Path, size: int) -> list[_Filmed]:
    """What a process of ours left: labels, and frames of ``size`` that stay on disk until they are read."""
    with path.open("rb") as file:
        told: list[tuple[int, list[tuple[Any, ...]]]] = pickle.load(file)
    count, frames = sum(n for n, _ in told), path.with_suffix(".frames")
    shape = (count, SEGMENTS, size, size, 3)
    if os.name == "nt" or not count:  # what is mapped cannot be removed there, nothing cannot be mapped
        clips = np.fromfile(frames, np.uint8).reshape(shape)
        clips.flags.writeable = False
    else:
        clips = np.memmap(frames, np.uint8, "r", shape=shape)
    each = iter(clips)
    found = [_Filmed(list(islice(each, n)), labels) for n, labels in told]
    path.unlink()
    frames.unlink()
    return found


def _maker(making: _Making) -> Callable[[int], list[_Filmed]]:
    """What films a story by its number."""
    troupe, camerawork = Troupe(making.seed), Camerawork(making.device)

    def film(number: int) -> list[_Filmed]:
        scenes = troupe.scenes(number, _PROPOSALS if number % _EVERY else _MANY)
        return [filmed for scene in scenes if (filmed := _filmed(scene, making, camerawork)) is not None]

    return film


def _filmed(scene: Scene, making: _Making, camerawork: Camerawork) -> _Filmed | None:
    """All clips of a scene; those that are drawn at a time share its moments."""
    clips = clips_of(scene, np.random.default_rng((making.seed, scene.number, scene.shots[0].line)))
    clips.sort(key=lambda clip: clip.bare)
    if not clips:
        return None
    count = sum(making.every or not clip.bare for clip in clips) if making.pictured(scene) else 0
    size = making.size
    drawn: list[Seen] = []
    seen: list[Clip] = []
    for part, pictures in ((clips[:count], True), (clips[count:], False)):
        for begin in range(0, len(part), _DRAWN_AT_ONCE):
            some = part[begin : begin + _DRAWN_AT_ONCE]
            cameras, about = tuple(clip.camera for clip in some), [clip.about for clip in some]
            stories, style = stories_of(scene.grids), scene.shots[0].style
            found = camerawork.judge_frames(
                *(scene.staged, style, stories, cameras, (size, size)),
                about=about,
                pictures=pictures,
                depths=True,
            )
            seen += _as_seen(scene, some, found)
            drawn.append(Seen(found.frames, found.guides))
    frames = [clip for found in drawn if found.frames.size for clip in found.frames]
    guides = joined([found.guides for found in drawn if found.guides is not None])
    labels = []
    hints = hints_of([clip.camera for clip in seen])
    for k, clip in enumerate(seen):
        c = clip.camera
        told = {
            "story": scene.number,
            "kind": clip.kind,
            "camera": f"{c.movement} {c.scale} {c.angle}",
            "place": scene.place,
            "cast": list(scene.cast),
            "hints": hints[k],
            "frames": clip.frames,
            "meant": clip.meant,
            "opinion": round(clip.opinion, 4),
            **({"grade": round(clip.grade, 4)} if clip.kind == "designer" else {}),
            **({"doubtful": True} if clip.doubtful else {}),
        }
        group, good = scene.place.partition(".")[0], clip.kind == "designer"
        labels.append((good, *clip.words, group, clip.strength, scene.split, told, guides[k : k + 1]))
    return _Filmed(frames, labels)


def _as_seen(scene: Scene, clips: list[Clip], drawn: Seen) -> list[Clip]:
    """Clips as their pictures turned out."""
    out = list(clips)
    for shot in scene.shots:
        rows = [i for i, clip in enumerate(clips) if clip.shot is shot]
        if rows:
            cameras = [clips[i].camera for i in rows]
            stories = stories_of(scene.grids)
            found = as_drawn(shot, stories, scene.filming, scene.staged, cameras, drawn.only(rows))
            for i, clip in zip(rows, as_seen([clips[i] for i in rows], found), strict=True):
                out[i] = clip
    return out


def stories_of(grids: tuple[ProposalGrid, ...]) -> tuple[StoryProposal, ...]:
    """The performances the grids of a scene share."""
    return grids[0].story
