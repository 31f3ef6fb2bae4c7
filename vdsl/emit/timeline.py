"""Where every shot stands in the film, and how it joins its neighbours, in whole frames."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ..lang.ir import Transition
from .types import Build, BuiltShot

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
    lengths: Sequence[int],
    transitions: Sequence[Transition],
    fps: tuple[int, int],
    ending: Transition | None = None,
) -> tuple[Placed, ...]:
    """Put shots of the given lengths (frames) one after another.

    ``transitions[i]`` joins shot i to the one before, ``ending`` is the fade-out of the last. A
    transition takes at most half of a shot, so that one at each end always fits; the first shot can
    only fade in.
    """

    def frames(seconds: float, *shots: int) -> int:
        return min(round(seconds * fps[0] / fps[1]), *(lengths[i] // 2 for i in shots), 10**9)

    enter = [("cut", 0)] * len(lengths)
    leave = [("cut", 0)] * len(lengths)
    for i, transition in enumerate(transitions):
        if transition.kind == "fade-in":
            enter[i] = _joined("fade-in", frames(transition.duration, i))
        if i == 0:
            continue
        if transition.kind in OVERLAPPING:
            leave[i - 1] = enter[i] = _joined(transition.kind, frames(transition.duration, i - 1, i))
        out = transition.duration if transition.kind == "fade-out" else transition.out
        if out > 0:
            leave[i - 1] = _joined("fade-out", frames(out, i - 1))
    if ending is not None and lengths:
        leave[-1] = _joined("fade-out", frames(ending.duration, len(lengths) - 1))
    placed: list[Placed] = []
    at = 0
    for i, length in enumerate(lengths):
        if enter[i][0] in OVERLAPPING:
            at -= enter[i][1]
        placed.append(Placed(at, length, *enter[i], *leave[i]))
        at += length
    return tuple(placed)


def _joined(kind: str, frames: int) -> tuple[str, int]:
    return (kind, frames) if frames > 0 else ("cut", 0)


def film_timeline(build: Build) -> dict[str, Placed]:
    """Places of all shots that have a take, by shot id."""
    return {s.shot.id: p for s, p in zip(build.shown, placed_shots(build), strict=True)}


def placed_shots(build: Build) -> tuple[Placed, ...]:
    """Places of the shots that have a take, in order."""
    board, shown = build.storyboard, build.shown
    return place_shots([s.frames for s in shown], [s.transition for s in shown], board.fps, board.ending)


def start_of_next(
    before: Sequence[BuiltShot], transition: Transition, frames: int, fps: tuple[int, int]
) -> int:
    """The first frame of a shot of a length, if it came after those that are built so far."""
    shown = [s for s in before if s.takes]
    lengths, transitions = [s.frames for s in shown], [s.transition for s in shown]
    return place_shots([*lengths, frames], [*transitions, transition], fps)[-1].start


def film_frames(build: Build) -> int:
    """Length of the animatic."""
    return max((p.start + p.frames for p in film_timeline(build).values()), default=0)
