"""Two storyboards compared: which shots came, went, moved or changed, and what changed in words.

Assumes two checked storyboards. Guarantees that every shot of either is accounted for once, that the same two
storyboards give the same comparison, and that nothing is staged or drawn: comparing is quick.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from difflib import SequenceMatcher

from ..lang.ir import Storyboard
from .facts import ShotFacts, board_facts, facts_of_shots

#: How alike two shots must be to be the same one, changed (see :func:`_likeness`).
_SAME = 4.0


@dataclass(frozen=True)
class Change:
    """One thing that is not as it was. what: ``size``, ``lens``, …; before, after: in words, "" for none."""

    what: str
    before: str
    after: str

    @property
    def text(self) -> str:
        """``close-up → medium``, ``lens 35 mm → 50 mm``, ``anna walk counter → door``."""
        before, after = self.before or "none", self.after or "none"
        if self.what in ("size", "angle", "movement"):
            return (
                f"{before} → {after}" if "any" not in (before, after) else f"{self.what} {before} → {after}"
            )
        if self.what == "story":
            return _story(self.before, self.after)
        if self.what in ("say", "note"):
            before, after = (f"“{w}”" if w else "nothing" for w in (self.before, self.after))
        return f"{self.what} {before} → {after}"


def _story(before: str, after: str) -> str:
    """What happens, its common beginning said once: ``anna walk counter → door``."""
    one, two = before.split(" "), after.split(" ")
    same = 0
    while same < min(len(one), len(two)) - 1 and one[same] == two[same]:
        same += 1
    return f"{' '.join(one)} → {' '.join(two[same:])}" if same >= 2 else f"{before} → {after}"


@dataclass(frozen=True)
class ShotChange:
    """What became of a shot. status: ``added``, ``removed``, ``changed``, ``moved`` or ``same``.

    before, after: the shot in either storyboard, None where it is not in it
    changes: what is different; moved: whether it stands elsewhere among the others (also when it changed)
    """

    status: str
    before: ShotFacts | None
    after: ShotFacts | None
    changes: tuple[Change, ...] = ()
    moved: bool = False

    @property
    def text(self) -> str:
        """``shot 3: close-up → medium; lens 35 mm → 50 mm``"""
        here = self.after or self.before
        assert here is not None
        if self.status in ("added", "removed"):
            return f"shot {here.number} {self.status}: {here.words}"
        parts = [change.text for change in self.changes]
        if self.moved and self.before is not None:
            parts.insert(0, f"moved from {self.before.number} to {here.number}")
        return f"shot {here.number}: " + "; ".join(parts or ["the same"])


@dataclass(frozen=True)
class Comparison:
    """Two storyboards. board: what changed for all of it, the cast or the scenes; shots: all, in order of the
    second, each that was removed after the one it followed."""

    board: tuple[Change, ...]
    shots: tuple[ShotChange, ...]

    @property
    def changed(self) -> tuple[ShotChange, ...]:
        """The shots that are not as they were."""
        return tuple(s for s in self.shots if s.status != "same")

    @property
    def equal(self) -> bool:
        return not self.board and not self.changed


def compare(before: Storyboard, after: Storyboard) -> Comparison:
    """What is different between two storyboards."""
    one, two = facts_of_shots(before), facts_of_shots(after)
    pairs = _matched(one, two)
    moved = _moved([pairs[j] for j in sorted(pairs)])
    shots: list[ShotChange] = []
    for j, new in enumerate(two):
        if j not in pairs:
            shots.append(ShotChange("added", None, new))
            continue
        old = one[pairs[j]]
        changes = _changes(old.facts.items(), new.facts)
        elsewhere = pairs[j] in moved
        status = "changed" if changes else "moved" if elsewhere else "same"
        shots.append(ShotChange(status, old, new, changes, elsewhere))
    gone = sorted(set(range(len(one))) - set(pairs.values()))
    for i in gone:
        shots.insert(_place_of(i, shots), ShotChange("removed", one[i], None))
    old_board, new_board = board_facts(before), board_facts(after)
    return Comparison(_changes(old_board.items(), new_board), tuple(shots))


def _changes(before: Iterable[tuple[str, str]], after: dict[str, str]) -> tuple[Change, ...]:
    old = dict(before)
    names = [*old, *(name for name in after if name not in old)]
    pairs = ((name, old.get(name, ""), after.get(name, "")) for name in names)
    return tuple(Change(*pair) for pair in pairs if pair[1] != pair[2])


def _place_of(index: int, shots: Sequence[ShotChange]) -> int:
    """Where a shot that was removed is told: after the one it followed."""
    places = [k for k, s in enumerate(shots) if s.before is not None and s.before.number - 1 < index]
    return max(places) + 1 if places else 0


# --- which shot is which ----------------------------------------------------------------------


def _matched(one: Sequence[ShotFacts], two: Sequence[ShotFacts]) -> dict[int, int]:
    """For shots of the second, by index, which of the first they are: those that are the same in everything
    (first those in the same order), then those of the same id, then those that are alike."""
    pairs: dict[int, int] = {}
    free_one, free_two = set(range(len(one))), set(range(len(two)))

    def match(i: int, j: int) -> None:
        pairs[j] = i
        free_one.discard(i)
        free_two.discard(j)

    old, new = ([tuple(shot.facts.items()) for shot in shots] for shots in (one, two))
    for i, j, size in SequenceMatcher(None, old, new, autojunk=False).get_matching_blocks():
        for k in range(size):
            match(i + k, j + k)
    for j in sorted(free_two):
        same = next((i for i in sorted(free_one) if old[i] == new[j]), None)
        if same is not None:
            match(same, j)
    by_id = {one[i].id: i for i in free_one}
    for j in sorted(free_two):
        if two[j].id in by_id and by_id[two[j].id] in free_one:
            match(by_id[two[j].id], j)
    scored = sorted(
        ((_likeness(one[i], two[j]), -abs(i - j), -i, -j) for i in free_one for j in free_two), reverse=True
    )
    for score, _, i, j in scored:
        if score >= _SAME and -i in free_one and -j in free_two:
            match(-i, -j)
    return pairs


def _likeness(a: ShotFacts, b: ShotFacts) -> float:
    """How much two shots have in common: who does what weighs most, then what is said, then the camera."""
    one, two = a.facts, b.facts
    score = 1.5 * (one["scene"] == two["scene"])
    first, second = one["story"].split(" "), two["story"].split(" ")
    score += sum(w for w, x, y in zip((1.5, 1.5, 1.0), first, second, strict=False) if x == y)
    score += 2.0 * bool(one["say"] and one["say"] == two["say"]) + 1.0 * bool(
        one["note"] and one["note"] == two["note"]
    )
    weights = (("size", 0.7), ("angle", 0.4), ("movement", 0.7))
    return score + sum(w for name, w in weights if one[name] == two[name] != "any")


def _moved(places: Sequence[int]) -> set[int]:
    """Those of some places that are out of order: all but the longest run that rises."""
    ends: list[int] = []  # indices into places, of the last of the best run of each length
    before: list[int] = [-1] * len(places)
    for k, place in enumerate(places):
        at = bisect_left([places[e] for e in ends], place)
        before[k] = ends[at - 1] if at else -1
        ends[at : at + 1] = [k]
    kept, k = set(), ends[-1] if ends else -1
    while k >= 0:
        kept.add(places[k])
        k = before[k]
    return set(places) - kept
