"""Clips out of films: real ones as positives, and the takes writers chose of their builds.

Assumes one shot a file. Guarantees eight frames as the discriminator sees a proposal: evenly spaced from the
first to the last, squeezed into a square as its pictures are. They have no guides, so they are learnt from by
their pictures alone. What cannot be read is told, not skipped in silence.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import av
import cv2
import numpy as np
from av.error import FFmpegError
from numpy.typing import NDArray

from ranker.data import ShardWriter, made_of
from ranker.errors import RankerError
from runtime.video import VideoError

from ..emit.video import take_paths
from ..lang.words import CAMERA_WORDS
from .filming import SEGMENTS, segment_frames
from .labels import WORDS, classes
from .picked import picked

FILMS = (".mp4", ".mov", ".m4v")
#: Every so many folders (or scripts), one is for testing: those whose digest says so.
_TEST_SHARE = 0.15


def clip_of(path: Path, size: int = 224) -> NDArray[np.uint8]:
    """A film's eight frames, uint8 [8, size, size, 3]. Raises :class:`runtime.video.VideoError`."""
    kept: list[NDArray[np.uint8]] = []
    try:
        # Twice through the file: what it says of its length is not always so.
        count = sum(1 for _ in _pictures(path))
        if count < SEGMENTS:
            raise VideoError(f"{path}: a clip needs at least {SEGMENTS} frames, this has {count}")
        wanted = set(segment_frames(count).tolist())
        for number, picture in enumerate(_pictures(path)):
            if number in wanted:
                kept.append(
                    cv2.resize(picture.to_ndarray(format="rgb24"), (size, size), interpolation=cv2.INTER_AREA)
                )
    except (FFmpegError, OSError, IndexError) as error:
        raise error if isinstance(error, VideoError) else VideoError(f"{path}: {error}") from error
    return np.stack(kept).astype(np.uint8)


def _pictures(path: Path) -> Iterator[av.VideoFrame]:
    with av.open(str(path)) as film:
        stream = film.streams.video[0]
        stream.thread_type = "AUTO"
        yield from film.decode(stream)


def add_films(
    folder: Path,
    films: Path,
    made: dict[str, Any],
    tell: Callable[[str], None] = lambda text: None,
    size: int = 224,
) -> int:
    """Add real clips below a folder as positives to a training set; returns how many were added.

    made: how the set is going to be made (:func:`vdsl.pipeline.dataset.made`), where there is none yet
    Camera words in a file's name are its labels (``pan-left_medium_eye-level_012.mp4``); what is not said is
    not known. Clips of one folder stay on one side of the split. Those added before are not added again.
    """
    paths = sorted(p for p in films.rglob("*") if p.suffix.lower() in FILMS)
    if not paths:
        raise RankerError(f"{films}: there are no clips ({', '.join(FILMS)})")
    with _writer(folder, made, size) as writer:
        known = {label.about.get("file") for label in writer.labels}
        added = 0
        for path in paths:
            name = path.relative_to(films).as_posix()
            if name in known:
                continue
            try:
                pictures = clip_of(path, size)
            except VideoError as error:
                tell(f"left out: {error}")
                continue
            group = f"film {path.parent.relative_to(films).as_posix()}"
            about = {"kind": "film", "file": name}
            writer.add(pictures, True, *words_of(path.stem), group, 0.0, _side(group), about)
            added += 1
        return added


def words_of(name: str) -> tuple[str | None, str | None, str | None]:
    """The classes that a file's name says, None for what it does not say."""
    said: dict[str, str] = {}
    for part in name.lower().replace(" ", "_").split("_"):
        meaning = CAMERA_WORDS.get(part)
        if meaning is not None and meaning.slot not in said:
            said[meaning.slot] = meaning.words[0]
    found = classes(said.get("movement", "+"), said.get("scale", ""), said.get("angle", ""))
    return found


def add_picks(folder: Path, scripts: list[Path], made: dict[str, Any], size: int = 224) -> int:
    """Add the takes chosen for scripts, out of their builds, as positives; returns how many were added.

    made: as in :func:`add_films`
    """
    with _writer(folder, made, size) as writer:
        known = {label.about.get("file") for label in writer.labels}
        added = 0
        for script in scripts:
            group = f"script {script.name}"
            for shot in picked(script):
                name, take = f"{script.name} {shot.id}", shot.takes[shot.chosen]
                if name in known:
                    continue
                about = {"kind": "picked", "file": name}
                labels = classes(take["movement"], take["scale"], take["angle"])
                film = clip_of(take_paths(shot.build, shot.id, take["rank"])[0], size)
                writer.add(film, True, *labels, group, 0.0, _side(group), about)
                added += 1
        return added


def _writer(folder: Path, made: dict[str, Any], size: int) -> ShardWriter:
    """Goes on with a set, however it is made: films are the same to all."""
    there = made_of(folder)
    return ShardWriter(folder, WORDS, (size, size), SEGMENTS, shard=64, made=there or made)


def _side(group: str) -> str:
    """Which side of the split a group is on: by its name alone."""
    share = int.from_bytes(hashlib.sha256(f"vds test {group}".encode()).digest()[:4], "big") / 2**32
    return "test" if share < _TEST_SHARE else "train"
