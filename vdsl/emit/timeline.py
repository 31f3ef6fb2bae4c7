"""Where every shot stands in the film, and how it joins its neighbours, in whole frames."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ..lang.ir import Transition
from .types import Build

#: Transitions in which both shots are seen at once, so that the film gets shorter by their length.
OVERLAPPING = ("dissolve", "wipe")


@dataclass(frozen=True)
class Placed:
    """A shot in the film: it is seen in frames [start, start + frames).

    enter, enter_frames: the transition it begins with (``cut``, ``fade-in``, ``dissolve``, ``wipe``)
    leave, leave_frames: the one it ends with (``cut``, ``fade-out``, ``dissolve``, ``wipe``)
    """

    start: int
    frames: int
    enter: str
    enter_frames: int
    leave: str
    leave_frames: int


def place_shots(
    lengths: Sequence[int], transitions: Sequence[Transition], fps: tuple[int, int]
) -> tuple[Placed, ...]:
    """Put shots of the given lengths (frames) one after another.

    ``transitions[i]`` joins shot i to the one before. A transition takes at most half of a shot, so
    that one at each end always fits; the first shot can only fade in.
    """
    enter: list[tuple[str, int]] = []
    leave: list[tuple[str, int]] = [("cut", 0)] * len(lengths)
    for i, transition in enumerate(transitions):
        kind = transition.kind
        touched = {"fade-in": (i,), "fade-out": (i - 1,)}.get(kind, (i - 1, i))
        wanted = round(transition.duration * fps[0] / fps[1])
        frames = min(wanted, *(lengths[t] // 2 for t in touched))
        enter.append(("cut", 0))
        if frames <= 0 or kind == "cut" or (i == 0 and kind != "fade-in"):
            continue
        if kind != "fade-out":
            enter[i] = (kind, frames)
        if kind != "fade-in":
            leave[i - 1] = (kind, frames)
    placed: list[Placed] = []
    at = 0
    for i, length in enumerate(lengths):
        if enter[i][0] in OVERLAPPING:
            at -= enter[i][1]
        placed.append(Placed(at, length, *enter[i], *leave[i]))
        at += length
    return tuple(placed)


def film_timeline(build: Build) -> dict[str, Placed]:
    """Places of all shots that have a take, by shot id."""
    shown = build.shown
    placed = place_shots([s.frames for s in shown], [s.transition for s in shown], build.storyboard.fps)
    return {s.shot.id: p for s, p in zip(shown, placed, strict=True)}


def film_frames(build: Build) -> int:
    """Length of the animatic."""
    return max((p.start + p.frames for p in film_timeline(build).values()), default=0)
