"""The discriminator's training set: random stories, filmed well and filmed badly.

Positives are what the virtual designer picks of a shot's proposals (:mod:`vdsl.pipeline.designer`);
negatives are picks shaken about at graded strengths, and picks made to show no type, as many as there are
positives and measured to be worse (:mod:`vdsl.pipeline.clips`). Every draw is keyed by the seed and the
story's number, whole stories go to disk, and the set itself says which were: so it is the same whether or
not its making was stopped.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ranker.data import ShardWriter
from runtime.raster.types import LOOK_VERSION

from ..propose.types import ProposalGrid, StoryProposal
from .casting import Scene, Troupe
from .clips import Clip, clips_of
from .filming import SEGMENTS, Camerawork
from .labels import WORDS
from .progress import Progress, Silence

#: Raised when other takes or labels come of the same seed.
_RECIPE = 2
_PROPOSALS = 16
_SHARD = 64
_AHEAD = 2  # scenes drawn while the next are staged and proposed


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
) -> int:
    """Write at least ``clips`` clips into ``folder``, going on where an earlier call stopped.

    size: side of the frames in pixels. Returns how many there are. Raises OSError or
    :class:`ranker.RankerError` for a folder that cannot be used or holds another kind of set.
    """
    watcher = progress or Silence()
    with ShardWriter(folder, WORDS, (size, size), SEGMENTS, shard=1 << 30, made=made(seed)) as writer:
        number = 1 + max((int(label.about.get("story", -1)) for label in writer.labels), default=-1)
        begun = len(writer)
        watcher.begin("clips", max(0, clips - begun), "clips")
        if begun >= clips:
            return begun
        for scene, made_of, frames, seconds in _drawn(Troupe(seed), number, seed, Camerawork(device), size):
            if scene.number != number:  # a story is whole
                if writer.pending >= _SHARD or len(writer) + writer.pending >= clips:
                    writer.flush()
                number = scene.number
                if len(writer) >= clips:
                    break
            for clip, pictures in zip(made_of, frames, strict=True):
                _add(writer, scene, clip, pictures)
            watcher.advance("clips", len(made_of), seconds)
        return len(writer)


def _add(writer: ShardWriter, scene: Scene, clip: Clip, pictures: NDArray[np.uint8]) -> None:
    c = clip.camera
    about = {
        "story": scene.number,
        "kind": clip.kind,
        "camera": f"{c.movement} {c.scale} {c.angle}",
        "place": scene.place,
        "cast": list(scene.cast),
    }
    group = scene.place.partition(".")[0]
    good = clip.kind == "designer"
    writer.add(pictures, good, *clip.words, group, clip.strength, scene.split, about)


def _drawn(
    troupe: Troupe, first: int, seed: int, camerawork: Camerawork, size: int
) -> Iterator[tuple[Scene, list[Clip], NDArray[np.uint8], float]]:
    """The scenes of all stories from ``first`` on with their clips and the frames of these, in order.

    One thread draws while this one stages and proposes what comes next.
    """
    waiting: deque[tuple[Scene, list[Clip], Future[NDArray[np.uint8]]]] = deque()
    last = perf_counter()
    with ThreadPoolExecutor(1) as drawer:
        for scene in _scenes(troupe, first):
            clips = clips_of(scene, np.random.default_rng((seed, scene.number, scene.shots[0].line)))
            if clips:
                waiting.append((scene, clips, drawer.submit(_frames, camerawork, scene, clips, size)))
            while len(waiting) > _AHEAD:
                done, of, frames = waiting.popleft()
                pictures, now = frames.result(), perf_counter()
                yield done, of, pictures, now - last
                last = now


def _scenes(troupe: Troupe, first: int) -> Iterator[Scene]:
    number = first
    while True:
        yield from troupe.scenes(number, _PROPOSALS)
        number += 1


def _frames(camerawork: Camerawork, scene: Scene, clips: list[Clip], size: int) -> NDArray[np.uint8]:
    """All clips of a scene in one go: they share its moments."""
    cameras = tuple(clip.camera for clip in clips)
    return camerawork.judge_frames(
        scene.staged, scene.shots[0].style, stories_of(scene.grids), cameras, (size, size)
    )


def stories_of(grids: tuple[ProposalGrid, ...]) -> tuple[StoryProposal, ...]:
    """The performances the grids of a scene share."""
    return grids[0].story
