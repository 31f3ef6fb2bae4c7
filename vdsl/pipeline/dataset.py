"""The discriminator's training set: random stories, filmed well and filmed badly.

Positives are what the virtual designer picks of a shot's proposals (:mod:`vdsl.pipeline.designer`);
negatives are picks shaken about at graded strengths, and picks made to show no type, as many as there are
positives and measured to be worse (:mod:`vdsl.pipeline.clips`). Every draw is keyed by the seed and the
story's number, whole stories go to disk in their order, and the set itself says which were: so it is the same
whether or not its making was stopped, and however many processes make it.
"""

from __future__ import annotations

import multiprocessing
import os
import signal
from collections import deque
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import suppress
from dataclasses import dataclass
from itertools import count
from multiprocessing.queues import Queue
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ranker.data import ShardWriter
from runtime.raster.types import LOOK_VERSION

from ..propose.types import ProposalGrid, StoryProposal
from .casting import Scene, Troupe
from .clips import clips_of
from .filming import SEGMENTS, Camerawork
from .hints import hints_of
from .labels import WORDS
from .progress import Progress, Silence

#: Raised when other takes or labels come of the same seed.
_RECIPE = 4
_PROPOSALS = 16
_SHARD = 64
#: Processes at most, and stories that each has waiting: a story's pictures take up to 80 MB.
_PROCESSES, _WAITING = 16, 2


@dataclass(frozen=True, eq=False)
class _Filmed:
    """The clips of a scene. frames: uint8 [N, T, S, S, 3]; labels: the rest that ``ShardWriter.add`` takes"""

    frames: NDArray[np.uint8]
    labels: list[tuple[Any, ...]]


def made(seed: int) -> dict[str, Any]:
    """What a training set says of how it is made: sets that differ in it are not put together."""
    return {"seed": seed, "look": LOOK_VERSION, "recipe": _RECIPE}


def generate(
    folder: Path,
    clips: int,
    seed: int = 0,
    device: str = "auto",
    progress: Progress | None = None,
    size: int = 224,
    processes: int | None = None,
) -> int:
    """Write at least ``clips`` clips into ``folder``, going on where an earlier call stopped.

    size: side of the frames in pixels; processes: None for one on each core. Returns how many there are.
    Raises OSError or :class:`ranker.RankerError` for a folder that cannot be used or holds another kind of
    set.
    """
    watcher = progress or Silence()
    with ShardWriter(folder, WORDS, (size, size), SEGMENTS, shard=1 << 30, made=made(seed)) as writer:
        first = 1 + max((int(label.about.get("story", -1)) for label in writer.labels), default=-1)
        begun, last = len(writer), perf_counter()
        watcher.begin("clips", max(0, clips - begun), "clips")
        if begun >= clips:
            return begun
        for story in _stories(first, seed, device, size, processes or min(_cores(), _PROCESSES)):
            for scene in story:
                for pictures, label in zip(scene.frames, scene.labels, strict=True):
                    writer.add(pictures, *label)
            now = perf_counter()
            watcher.advance("clips", sum(len(scene.labels) for scene in story), now - last)
            last = now
            if writer.pending >= _SHARD or len(writer) + writer.pending >= clips:
                writer.flush()
            if len(writer) >= clips:
                break
        return len(writer)


def _cores() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _stories(first: int, seed: int, device: str, size: int, processes: int) -> Iterator[list[_Filmed]]:
    """The filmed scenes of all stories from ``first`` on, story by story in their order."""
    if processes == 1:
        film = _maker(seed, device, size)
        yield from map(film, count(first))
        return
    context = multiprocessing.get_context("spawn")  # a forked process would share a renderer's threads
    others = set(multiprocessing.active_children())
    places: Queue[int] = context.Queue()
    for place in range(processes):
        places.put(place)
    pool = ProcessPoolExecutor(processes, context, _settle, (places, seed, device, size))
    waiting: deque[Future[list[_Filmed]]] = deque()
    try:
        for number in count(first):
            waiting.append(pool.submit(_film_here, number))
            if len(waiting) >= _WAITING * processes:
                yield waiting.popleft().result()
    except BrokenProcessPool as error:
        raise OSError(
            "a process that films stories was ended from outside, perhaps for want of memory; "
            "start again to go on from what is there"
        ) from error
    finally:  # what is still being filmed is not wanted any more
        for process in set(multiprocessing.active_children()) - others:
            process.terminate()
        pool.shutdown(cancel_futures=True)


_here: list[Callable[[int], list[_Filmed]]] = []


def _settle(places: Queue[int], seed: int, device: str, size: int) -> None:
    """Make this process one that films stories, on a core of its own; whoever began it says when to stop."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    place = places.get()
    with suppress(AttributeError, OSError):  # where processes cannot be kept to cores, they share them
        cores = sorted(os.sched_getaffinity(0))
        os.sched_setaffinity(0, {cores[place % len(cores)]})
    _here.append(_maker(seed, device, size))


def _film_here(number: int) -> list[_Filmed]:
    return _here[0](number)


def _maker(seed: int, device: str, size: int) -> Callable[[int], list[_Filmed]]:
    """What films a story by its number."""
    troupe, camerawork = Troupe(seed), Camerawork(device)

    def film(number: int) -> list[_Filmed]:
        scenes = troupe.scenes(number, _PROPOSALS)
        return [filmed for scene in scenes if (filmed := _filmed(scene, seed, camerawork, size)) is not None]

    return film


def _filmed(scene: Scene, seed: int, camerawork: Camerawork, size: int) -> _Filmed | None:
    """All clips of a scene, drawn in one go: they share its moments."""
    clips = clips_of(scene, np.random.default_rng((seed, scene.number, scene.shots[0].line)))
    if not clips:
        return None
    cameras, style = tuple(clip.camera for clip in clips), scene.shots[0].style
    frames = camerawork.judge_frames(scene.staged, style, stories_of(scene.grids), cameras, (size, size))
    labels = []
    for clip in clips:
        c = clip.camera
        about = {
            "story": scene.number,
            "kind": clip.kind,
            "camera": f"{c.movement} {c.scale} {c.angle}",
            "place": scene.place,
            "cast": list(scene.cast),
            "hints": hints_of(c),
            "frames": clip.frames,
        }
        group, good = scene.place.partition(".")[0], clip.kind == "designer"
        labels.append((good, *clip.words, group, clip.strength, scene.split, about))
    return _Filmed(frames, labels)


def stories_of(grids: tuple[ProposalGrid, ...]) -> tuple[StoryProposal, ...]:
    """The performances the grids of a scene share."""
    return grids[0].story
