"""The rules of cutting: what a cut between two neighbouring takes does to the viewer's sense of place.

Assumes takes of one scene, the same people in both, and that the second begins where the first ends.
Guarantees findings that come from the geometry alone (:mod:`vdsl.cinema.edges`): nothing is drawn. Angles
are degrees.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import atan2, degrees

import numpy as np

from .edges import Edge, turned

#: The rules in the order of findings of one cut; the worst first.
RULES = ("line", "direction", "eyeline", "jump", "size")
#: What merely may be unwelcome; the other rules' findings are faults.
HINTS = ("size",)

NEUTRAL = 10.0  # degrees off a line, or off the way to the camera, within which no side is taken
TURN = 30.0  # degrees between two views of one subject below which the second is no other view
STEP = 1.0  # steps of the ladder of sizes that make another picture
LEAP = 5.5  # steps on one subject that are many
_SAME_WAY = 60.0  # degrees between two ways that are one


@dataclass(frozen=True)
class Finding:
    """One rule that a cut breaks.

    degrees: how far; 0 for a rule that is not about an angle; numbers: all that was measured, by name
    words: what the cut does, to follow ``cut 3→4``
    """

    rule: str
    degrees: float
    numbers: Mapping[str, float]
    words: str

    @property
    def severity(self) -> str:
        """``fault``, or ``hint`` for what may be meant."""
        return "hint" if self.rule in HINTS else "fault"


def findings(before: Edge, after: Edge) -> tuple[Finding, ...]:
    """What a cut from the end of one take to the start of another breaks, in the order of :data:`RULES`.

    One mistake is told once: where the line is crossed, turned ways and looks of the same people follow
    from it and are left out.
    """
    line, of = _line(before, after)
    found = [line, *(_direction(before, after, n) for n in sorted(before.ways) if n not in of)]
    if not of.issuperset((before.subject, after.subject)):
        found.append(_eyeline(before, after))
    found += [_jump(before, after), _leap(before, after)]
    return tuple(f for f in found if f is not None)


def _line(before: Edge, after: Edge) -> tuple[Finding | None, frozenset[str]]:
    """Whether the line is crossed, and whose line it is; the line of two people goes before ways."""
    shared = [pair for pair in before.pairs if pair in after.pairs]
    if shared:
        pair = min(shared, key=lambda p: (max(before.pairs[p], after.pairs[p]), before.pairs[p], p))
        one, two = before.sides[pair], after.sides[pair]
        if one is None or two is None:
            return None, frozenset()
        found = _crossed(one, two, f"({pair[0]}–{pair[1]})")
        return found, frozenset(pair) if found else frozenset()
    for name in sorted(before.ways):
        if _same_way(before, after, name):
            found = _crossed(before.ways[name].side, after.ways[name].side, f"({name}'s way)")
            if found:
                return found, frozenset((name,))
    return None, frozenset()


def _crossed(one: float, two: float, whose: str) -> Finding | None:
    """One: the side before; two: the side after, both as degrees around from the line's direction."""
    before, after = _off(one), _off(two)
    if (one > 0) == (two > 0) or before < NEUTRAL or after < NEUTRAL:
        return None
    numbers = {"before": before, "after": -after}
    return Finding("line", after, numbers, f"crosses the line by {after:.0f}° {whose}")


def _off(side: float) -> float:
    """Degrees off the line, 0..90, on whichever side and towards whichever end."""
    return min(abs(side), 180.0 - abs(side))


def _same_way(before: Edge, after: Edge, name: str) -> bool:
    if name not in before.ways or name not in after.ways:
        return False
    one, two = before.ways[name].direction, after.ways[name].direction
    return abs(turned(np.array(one), np.array(two))) < _SAME_WAY


def _direction(before: Edge, after: Edge, name: str) -> Finding | None:
    """Somebody who goes on the same way goes the other way across the picture."""
    if not _same_way(before, after, name):
        return None
    one, two = before.ways[name].across, after.ways[name].across
    if (one > 0) == (two > 0) or min(abs(one), abs(two)) < NEUTRAL:
        return None
    words = f"turns {name}'s way round, from {_hand(one)} to {_hand(two)}"
    return Finding("direction", abs(two), {"before": one, "after": two}, words)


def _eyeline(before: Edge, after: Edge) -> Finding | None:
    """Two who look at each other, filmed one after the other, look the same way across the picture."""
    one, two = before.subject, after.subject
    if one == two or not (before.seen and after.seen):
        return None
    if (one, two) not in before.gazes or (two, one) not in after.gazes:
        return None
    first, second = before.looks[one], after.looks[two]
    if (first > 0) != (second > 0) or min(abs(first), abs(second)) < NEUTRAL:
        return None
    words = f"breaks the eyeline: {one} and {two} both look {_hand(first)}"
    return Finding("eyeline", min(abs(first), abs(second)), {"before": first, "after": second}, words)


def _jump(before: Edge, after: Edge) -> Finding | None:
    """The same subject again, from nearly the same side and nearly as large."""
    if before.subject != after.subject or not (before.seen and after.seen):
        return None
    turn = _between(before.view, after.view)
    change = after.size - before.size
    if turn >= TURN or abs(change) >= STEP:
        return None
    words = f"jumps: {before.subject} again, {turn:.0f}° aside and {abs(change):.1f} sizes apart"
    return Finding("jump", turn, {"turn": turn, "size_change": change}, words)


def _leap(before: Edge, after: Edge) -> Finding | None:
    """The same subject many sizes larger or smaller."""
    if before.subject != after.subject or not (before.seen and after.seen):
        return None
    change = after.size - before.size
    if abs(change) <= LEAP:
        return None
    words = f"leaps {abs(change):.1f} sizes {'closer to' if change < 0 else 'away from'} {before.subject}"
    return Finding("size", 0.0, {"turn": _between(before.view, after.view), "size_change": change}, words)


def _between(one: tuple[float, float, float], two: tuple[float, float, float]) -> float:
    """Degrees between two unit vectors."""
    a, b = np.array(one), np.array(two)
    return degrees(atan2(float(np.linalg.norm(np.cross(a, b))), float(a @ b)))


def _hand(across: float) -> str:
    return "right" if across > 0 else "left"
