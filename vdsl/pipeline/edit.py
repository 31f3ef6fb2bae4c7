"""Cutting shots together: what the chosen takes do at every cut, and takes chosen for the sequence.

Assumes proposals that were judged. Guarantees the best of all sequences of the candidates: fewest faults
(:mod:`vdsl.cinema.continuity`), then the least loss of score. Only cuts within a scene count: over a
dissolve, a wipe or a fade, and between scenes, everything may change.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from ..cinema.continuity import RULES, Finding, findings
from ..cinema.edges import Edge, Pair, edges
from ..emit.types import CutFinding, Trade
from ..lang.ir import Shot, StoryLine
from ..propose.cameras import Filming, subject_of
from ..propose.subjects import performed
from ..propose.types import CameraProposal, ProposalGrid
from .selection import choose_takes

#: Proposals of a shot that an edit chooses from: the best ones that are not the same picture twice.
CANDIDATES = 12
_FAULT = 1e6  # no loss of score outweighs a fault
_HINT = 0.05  # what may be meant is worth this much score
_ORDER = 1e-9  # of two that are as good the one that ranks higher

Array = NDArray[np.float64]
#: First and last moment of a take.
Ends: TypeAlias = tuple[Edge, Edge]


@dataclass(frozen=True, eq=False)
class Slot:
    """A shot in its place, with the takes it may be shown by.

    number: the shot's place in the film, from 1; joined: whether it follows the slot before by a cut
    within a scene; proposals, scores, ends: of the candidates in their order, best first; ends are
    the candidate's first and last moment
    """

    shot: str
    number: int
    joined: bool
    proposals: tuple[int, ...]
    scores: tuple[float, ...]
    ends: tuple[Ends, ...]


class Reel:
    """Collects the shots of a film in their order. Shots without candidates are no part of it."""

    def __init__(self) -> None:
        self.slots: list[Slot] = []
        self._number = 0
        self._last: StoryLine | None = None

    def add(
        self,
        line: StoryLine,
        shot: Shot,
        candidates: Sequence[int],
        scores: Sequence[float],
        ends: Sequence[Ends],
    ) -> None:
        """The next shot. candidates: indices of proposals, best first; scores, ends: of each of them."""
        self._number += 1
        if not candidates:
            return
        last = self._last
        joined = last is line or (
            last is not None and last.scene == line.scene and line.transition.kind == "cut"
        )
        self.slots.append(Slot(shot.id, self._number, joined, tuple(candidates), tuple(scores), tuple(ends)))
        self._last = line


def ends_of(
    line: StoryLine, shot: Shot, grid: ProposalGrid, candidates: Sequence[int], filming: Filming
) -> tuple[Ends, ...]:
    """First and last moment of each candidate."""
    wanted = {grid.cameras[i].story for i in candidates}
    subjects, people = {}, {}
    for story in grid.story:
        if story.index in wanted:
            subjects[story.index] = subject_of(shot, story, filming)
            people[story.index] = {
                name: performed(name, p, filming.skeletons[name]) for name, p in story.performances.items()
            }
    acting = _acting(line)
    return tuple(
        edges(camera.track, subjects[camera.story], people[camera.story], acting, filming.fps)
        for camera in (grid.cameras[i] for i in candidates)
    )


def _acting(line: StoryLine) -> tuple[Pair, ...]:
    """(who, on whom) of everybody in a line who acts on somebody."""
    return tuple(
        (beat.character, target.path[0])
        for beat in line.beats
        for target in (beat.target, beat.second)
        if target is not None and target.kind == "character"
    )


# -- what a sequence does ----------------------------------------------------------------------


def cut_findings(slots: Sequence[Slot], choice: Sequence[int]) -> tuple[CutFinding, ...]:
    """What every cut breaks; choice: which candidate of each slot is shown."""
    out: list[CutFinding] = []
    for k in range(1, len(slots)):
        one, two = slots[k - 1], slots[k]
        found = _between(slots, k, choice[k - 1], choice[k])
        out += [CutFinding((one.shot, two.shot), (one.number, two.number), f) for f in found]
    return tuple(out)


def _between(slots: Sequence[Slot], k: int, before: int, after: int) -> tuple[Finding, ...]:
    if not slots[k].joined:
        return ()
    return findings(slots[k - 1].ends[before][1], slots[k].ends[after][0])


# -- takes for the sequence --------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class Edited:
    """takes: proposals of each shot that are kept, first the one that the sequence wants; trades: what was
    given up for it."""

    takes: Mapping[str, list[int]]
    trades: tuple[Trade, ...]


def candidates(
    cameras: tuple[CameraProposal, ...], scores: Array, takes: int, failed: Collection[int] = ()
) -> list[int]:
    """Indices of the proposals an edit chooses from: those that would be kept as takes, then further ones.

    failed: proposals not to be shown for the sake of a cut, unless there are no others
    """
    kept = choose_takes(cameras, scores, takes)
    all_of_them = kept + [i for i in choose_takes(cameras, scores, CANDIDATES) if i not in kept]
    return [i for i in all_of_them if i not in failed] or all_of_them


def edited(slots: Sequence[Slot], takes: Mapping[str, Sequence[int]]) -> Edited:
    """The best sequence of the slots' candidates. takes: proposals that would be kept without it."""
    choice, trades = edit(slots)
    out = {shot: list(kept) for shot, kept in takes.items()}
    for slot, k in zip(slots, choice, strict=True):
        first = slot.proposals[k]
        others = [i for i in takes[slot.shot] if i != first]
        out[slot.shot] = [first, *others][: len(takes[slot.shot])]
    return Edited(out, trades)


def edit(slots: Sequence[Slot]) -> tuple[list[int], tuple[Trade, ...]]:
    """The candidate of each slot with which the sequence has the fewest faults at the least loss of score,
    and what was given up for it."""
    losses = [
        max(s.scores) - np.array(s.scores) + _ORDER * np.arange(len(s.scores), dtype=float) for s in slots
    ]
    choice = best_path(losses, [_costs(slots, k) for k in range(1, len(slots))])
    return choice, _trades(slots, choice)


def _costs(slots: Sequence[Slot], k: int) -> Array:
    """What each cut from a candidate of the slot before to one of a slot costs, [K before, K]."""
    before, after = len(slots[k - 1].ends), len(slots[k].ends)
    out = np.zeros((before, after))
    for i, j in np.ndindex(before, after):
        out[i, j] = sum(_FAULT if f.severity == "fault" else _HINT for f in _between(slots, k, i, j))
    return out


def best_path(losses: Sequence[Array], costs: Sequence[Array]) -> list[int]:
    """The cheapest way through a row of choices, exactly (Viterbi).

    losses: [K_n] of every choice of the n-th; costs: [K_n, K_n+1] of one after the other, one fewer
    """
    if not losses:
        return []
    total, back = np.asarray(losses[0], float), []
    for loss, cost in zip(losses[1:], costs, strict=True):
        ways = total[:, None] + cost
        back.append(ways.argmin(axis=0))
        total = ways.min(axis=0) + loss
    path = [int(total.argmin())]
    for came in reversed(back):
        path.append(int(came[path[-1]]))
    return path[::-1]


def _trades(slots: Sequence[Slot], choice: Sequence[int]) -> tuple[Trade, ...]:
    """For every slot that is not shown by its best: what putting that one back would break."""
    out: list[Trade] = []
    now = [_rules(slots, choice, k) for k in range(len(slots))]
    for k, slot in enumerate(slots):
        if choice[k] == 0:
            continue
        back = _rules(slots, [*choice[:k], 0, *choice[k + 1 :]], k)
        kept = tuple(rule for rule in RULES if back.count(rule) > now[k].count(rule))
        out.append(Trade(slot.shot, slot.number, choice[k] + 1, slot.scores[choice[k]], slot.scores[0], kept))
    return tuple(out)


def _rules(slots: Sequence[Slot], choice: Sequence[int], k: int) -> list[str]:
    """Rules broken at the two cuts of a slot."""
    cuts = [n for n in (k, k + 1) if 0 < n < len(slots)]
    return [f.rule for n in cuts for f in _between(slots, n, choice[n - 1], choice[n])]
