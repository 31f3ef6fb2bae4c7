"""BVH: a skeleton as text and its motion as rows of numbers. Read by ourselves, within limits."""

from __future__ import annotations

import re
import warnings
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from . import limits
from .errors import ModelFileError
from .paths import read_bytes

Array = NDArray[np.float64]
#: Frames a second that are kept of faster motion, about.
MOST_RATE = 60.0
_HEAD = re.compile(r"\s*Frames:\s*(\d{1,15})\s+Frame\s+Time:\s*(\d*\.?\d+(?:[eE][-+]?\d+)?)\s", re.ASCII)
_AXES = {"Xrotation": 0, "Yrotation": 1, "Zrotation": 2}
_SHIFTS = {"Xposition": 0, "Yposition": 1, "Zposition": 2}


@dataclass(frozen=True, eq=False)
class Bvh:
    """A motion in the file's own axes and units.

    names, parents: of the joints, parents first; end sites are joints without a name
    offsets: float64 [B, 3] from each one's parent; turns: [T, B, 3, 3] local; shifts: [T, B, 3] by channels
    """

    names: tuple[str, ...]
    parents: tuple[int, ...]
    offsets: Array
    turns: Array
    shifts: Array
    seconds: float

    def rest(self) -> Array:
        """[B, 3]: where the joints are with nothing turned."""
        at = self.offsets.copy()
        for i, parent in enumerate(self.parents):
            if parent >= 0:
                at[i] += at[parent]
        return at

    def world(self) -> tuple[Array, Array]:
        """Turns [T, B, 3, 3] and positions [T, B, 3] of all joints."""
        turns, at = self.turns.copy(), self.offsets[None] + self.shifts
        for i, parent in enumerate(self.parents):
            if parent >= 0:
                at[:, i] = at[:, parent] + (turns[:, parent] @ at[:, i, :, None])[..., 0]
                turns[:, i] = turns[:, parent] @ turns[:, i]
        return turns, at


class _Words:
    """The words of the file, one after the other."""

    def __init__(self, path: Path, text: str) -> None:
        self.path = path
        self.words = text.split()
        self.at = 0

    def next(self) -> str:
        if self.at >= len(self.words):
            raise ModelFileError(self.path, "it is cut off in its skeleton")
        self.at += 1
        return self.words[self.at - 1]

    def expect(self, word: str) -> None:
        found = self.next()
        if found.upper() != word.upper():
            raise ModelFileError(self.path, f"`{word}` is wanted in its skeleton where `{found[:30]}` stands")

    def number(self) -> float:
        word = self.next()
        try:
            value = float(word)
        except ValueError:
            raise ModelFileError(self.path, f"a number is wanted where `{word[:30]}` stands") from None
        if not abs(value) < 1e9:
            raise ModelFileError(self.path, "some of its numbers are none (NaN, infinite or beyond measure)")
        return value


@dataclass(eq=False)
class _Skeleton:
    names: list[str]
    parents: list[int]
    offsets: list[list[float]]
    channels: list[tuple[int, str]]


def read_bvh(path: Path) -> Bvh:
    """The motion of a file."""
    try:
        text = read_bytes(path, limits.MOTION_BYTES).decode("utf-8-sig")
    except UnicodeDecodeError:
        raise ModelFileError(path, "it is no .bvh file: it is not text") from None
    head, motion, rows = text.partition("MOTION")
    if not motion:
        raise ModelFileError(path, "it has no MOTION: it is cut off, or no .bvh file")
    if len(head) > limits.MIB:
        raise ModelFileError(path, "its skeleton is longer than any")
    words = _Words(path, head)
    words.expect("HIERARCHY")
    words.expect("ROOT")
    skeleton = _Skeleton([], [], [], [])
    _joint(words, skeleton, -1, 0, words.next())
    if not skeleton.channels:
        raise ModelFileError(path, "nothing in it moves")
    values, seconds = _rows(path, rows, len(skeleton.channels), len(skeleton.names))
    return _built(skeleton, values, seconds)


def _joint(words: _Words, skeleton: _Skeleton, parent: int, depth: int, name: str) -> None:
    """One joint from its opening brace to the closing one, and all inside it."""
    if depth > limits.DEPTH:
        raise ModelFileError(words.path, f"its joints are nested deeper than {limits.DEPTH}")
    if len(skeleton.names) >= limits.JOINTS:
        raise ModelFileError(words.path, f"it has more than {limits.JOINTS} joints")
    own = len(skeleton.names)
    skeleton.names.append(name)
    skeleton.parents.append(parent)
    skeleton.offsets.append([0.0, 0.0, 0.0])
    words.expect("{")
    while (word := words.next()) != "}":
        if word.upper() == "OFFSET":
            skeleton.offsets[own] = [words.number() for _ in range(3)]
        elif word.upper() == "CHANNELS":
            count = words.number()
            if not 0 <= count <= 9:
                raise ModelFileError(words.path, "a joint in it has more channels than there are")
            for _ in range(int(count)):
                channel = words.next()
                if channel not in _AXES and channel not in _SHIFTS:
                    raise ModelFileError(words.path, f"`{channel[:30]}` is no channel")
                skeleton.channels.append((own, channel))
        elif word.upper() == "JOINT":
            _joint(words, skeleton, own, depth + 1, words.next())
        elif word.upper() == "END":
            words.next()
            _joint(words, skeleton, own, depth + 1, "")
        else:
            raise ModelFileError(words.path, f"`{word[:30]}` has no place in its skeleton")


def _rows(path: Path, text: str, channels: int, joints: int) -> tuple[Array, float]:
    """The numbers [T, C], no more of them than a film needs, and the seconds of a frame."""
    head = _HEAD.match(text)
    if head is None:
        raise ModelFileError(path, "its motion does not say how many frames it has, and how long one is")
    frames, seconds = int(head.group(1)), float(head.group(2))
    if not 1 <= frames <= limits.FRAMES:
        raise ModelFileError(path, f"it declares {frames:,} frames; from 1 to {limits.FRAMES:,} are read")
    if not 1e-4 < seconds < 10.0 or frames * seconds > limits.SECONDS:
        raise ModelFileError(
            path, f"its motion is longer than {limits.SECONDS:g} s, or its frame time is no time"
        )
    every = max(1, round(1.0 / (MOST_RATE * seconds)))
    if frames * channels > limits.MOTION_NUMBERS or frames // every * joints > limits.MOTION_NUMBERS // 4:
        raise ModelFileError(path, f"it has {frames:,} frames of {channels} numbers: that is too many")
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # numpy warns of what is no number, and goes on
        try:
            values = np.fromstring(text[head.end() :], np.float64, sep=" ")[: frames * channels]
        except (ValueError, DeprecationWarning):
            raise ModelFileError(
                path, f"something in it is no number, or it is cut off: {frames:,} frames are declared"
            ) from None
    if len(values) < frames * channels:
        raise ModelFileError(path, f"it is cut off: {frames:,} frames of {channels} numbers are declared")
    if not np.isfinite(values).all() or np.abs(values).max() > 1e7:
        raise ModelFileError(path, "some of its numbers are none (NaN, infinite or beyond measure)")
    return values.reshape(frames, channels)[::every], seconds * every


def _built(skeleton: _Skeleton, values: Array, seconds: float) -> Bvh:
    frames, joints = len(values), len(skeleton.names)
    turns = np.tile(np.eye(3), (frames, joints, 1, 1))
    shifts = np.zeros((frames, joints, 3))
    offsets = np.array(skeleton.offsets)
    for column, (joint, channel) in enumerate(skeleton.channels):
        if channel in _AXES:
            turns[:, joint] = turns[:, joint] @ _about(_AXES[channel], np.radians(values[:, column]))
        else:  # positions replace the offset
            axis = _SHIFTS[channel]
            shifts[:, joint, axis] = values[:, column] - offsets[joint, axis]
    return Bvh(tuple(skeleton.names), tuple(skeleton.parents), offsets, turns, shifts, seconds)


def _about(axis: int, angle: Array) -> Array:
    out = np.zeros((len(angle), 3, 3))
    i, j = (axis + 1) % 3, (axis + 2) % 3
    out[:, axis, axis] = 1.0
    out[:, i, i] = out[:, j, j] = np.cos(angle)
    out[:, j, i] = np.sin(angle)
    out[:, i, j] = -np.sin(angle)
    return out
