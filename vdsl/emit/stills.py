"""Keyframes apart from films: kept as files for later runs, and as all there is of a take in a draft."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from runtime.video import VideoError

from .folder import write_bytes
from .guides import NO_GUIDES, Guides
from .overlay import guided
from .remember import remembering
from .types import TakeMedia
from .video import key_frames, reduced, take_paths, write_poster

Pictures = NDArray[np.uint8]


def write_keys(path: Path, keys: Sequence[Pictures]) -> None:
    """Pictures uint8 [h, w, 3] of one size, one below the other, as a PNG: without loss."""
    stack = cv2.cvtColor(np.concatenate(list(keys)), cv2.COLOR_RGB2BGR)
    done, data = cv2.imencode(".png", stack, [cv2.IMWRITE_PNG_COMPRESSION, 1])
    if not done:
        raise VideoError(f"cannot write {path}: the picture could not be encoded")
    write_bytes(path, data.tobytes())


def read_keys(path: Path, count: int = 3) -> tuple[Pictures, ...]:
    """What :func:`write_keys` wrote; not to be painted on."""
    keys = _keys_in(path.read_bytes(), count)
    if not keys:
        raise VideoError(f"cannot read {path}: it holds no keyframes")
    return keys


@remembering(40)
def _keys_in(data: bytes, count: int) -> tuple[Pictures, ...]:
    """The pictures in a file's contents; none if it is damaged."""
    stack = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_COLOR) if data else None
    if stack is None or len(stack) % count:
        return ()
    pictures = np.asarray(cv2.cvtColor(stack, cv2.COLOR_BGR2RGB), np.uint8)
    pictures.flags.writeable = False
    return tuple(np.split(pictures, count))


def write_stills(
    folder: Path,
    shot: str,
    count: int,
    frames_at: Callable[[NDArray[np.int64]], Pictures],
    guides: Guides = NO_GUIDES,
) -> TakeMedia:
    """The best take of a shot as a still alone: its keyframes are drawn, and no film.

    frames_at: draws frames [N] of the take, uint8 [N, H, W, 3]; count: the film's length, were it made
    """
    video, poster, _ = take_paths(folder, shot, 1)
    poster.parent.mkdir(parents=True, exist_ok=True)
    pictures = frames_at(np.array(key_frames(count)))
    write_poster(poster, guided(pictures[1], guides))
    return TakeMedia(video, poster, count, tuple(reduced(p) for p in pictures), sketched=True)
