"""What a storyboard says of its shots and of itself, as words by name: what is compared, counted and listed.

Assumes a checked storyboard. Guarantees the same names in the same order for every shot, and "" where nothing
was said; nothing heavier than the language is loaded.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..emit.words import line_words
from ..lang.ir import MOVEMENT_FAMILIES, MOVEMENTS, Shot, Storyboard, StoryLine

_EASES = {0.1: "slow-out", 1.0: "linear", 10.0: "slow-in"}
_MANY = 3


@dataclass(frozen=True)
class ShotFacts:
    """A shot. number: in the film, from 1; line: of the script, from 1; facts: words by name."""

    id: str
    number: int
    line: int
    facts: dict[str, str]

    @property
    def words(self) -> str:
        """``anna walk counter, follow full eye-level``"""
        camera = " ".join(self.facts[k] for k in ("movement", "size", "angle") if self.facts[k] != "any")
        return f"{self.facts['story']}{', ' if camera else ''}{camera}"


def facts_of_shots(board: Storyboard) -> tuple[ShotFacts, ...]:
    """Every shot of a storyboard, in order."""
    shots = [(line, shot) for line in board.lines for shot in line.shots]
    return tuple(
        ShotFacts(shot.id, k, shot.line, _facts(board, line, shot)) for k, (line, shot) in enumerate(shots, 1)
    )


def _facts(board: Storyboard, line: StoryLine, shot: Shot) -> dict[str, str]:
    first = line.shots[0] is shot
    joins = line.transition if first else None
    return {
        "story": line_words(line, board.scenes[line.scene].name),
        "how": ", ".join(f"{b.character} {b.manner}" for b in line.beats if b.manner),
        "size": _choice(shot.scales),
        "angle": _choice(shot.angles),
        "movement": _movements(shot.movements),
        "view": " ".join((shot.view, *shot.whose)) if shot.view else "",
        "lens": "any" if shot.any_lens else _range(*shot.lens, "mm"),
        "aperture": f"f/{shot.aperture:g}" if shot.aperture else "",
        "roll": f"{math.degrees(shot.roll):.3g}°" if shot.roll else "",
        "ease": "|".join(_EASES.get(e, f"{e:g}") for e in shot.ease) if len(shot.ease) < _MANY else "any",
        "length": f"{shot.duration:.4g} s" if shot.duration is not None else "",
        "focus": shot.focus.written if shot.focus else "",
        "focus goes to": shot.focus_to.written if shot.focus_to else "",
        "say": shot.say or "",
        "note": shot.note or "",
        "feelings": ", ".join(f"{who} {word}" for who, word in shot.feelings),
        "speed": f"{shot.speed:g}" if shot.speed != 1 else "",
        "joined by": _transition(joins.kind, joins.duration) if joins else "",
        "scene": board.scenes[line.scene].name,
        "look": shot.style,
        "proposals": str(shot.proposals),
        "takes": str(shot.takes),
    }


def board_facts(board: Storyboard) -> dict[str, str]:
    """What holds for all of a storyboard, its cast and its scenes."""
    rate = board.fps[0] / board.fps[1]
    out = {
        "title": board.title,
        "fps": f"{rate:.6g}",
        "picture": f"{board.size[0]}x{board.size[1]}",
        "seed": str(board.seed),
        "rig": board.rig,
        "ending": _transition(board.ending.kind, board.ending.duration) if board.ending else "",
    }
    for who in board.characters:
        dressed = ", ".join(f"{name} {_value(value)}" for name, value in who.arguments)
        out[f"character {who.name}"] = who.cast + (f" ({dressed})" if dressed else "")
    for scene in board.scenes:
        place = ".".join((scene.set, *scene.room))
        placed = [
            " ".join(
                [p.character, "at", p.at.written or "somewhere"]
                + (["facing", p.facing.written] if p.facing else [])
                + ([p.posture] if p.posture != "standing" else [])
                + (["holding", p.holding.written] if p.holding else [])
            )
            for p in scene.placements
        ]
        out[f"scene {scene.name}"] = "; ".join([f"{place} at {scene.time}", *placed])
    return out


def _movements(words: tuple[str, ...]) -> str:
    """The same of movements, both directions of one by the word for both: ``pan|dolly``."""
    if set(words) >= set(MOVEMENTS):
        return "any"
    left, out = list(words), list[str]()
    for family, members in MOVEMENT_FAMILIES.items():
        if len(members) > 1 and set(members) <= set(left):
            out.append(family)
            left = [w for w in left if w not in members]
    return "|".join((*out, *left))


def _choice(words: tuple[str, ...]) -> str:
    """``medium``, ``medium|full``, or ``any`` where the choice is wide."""
    return "|".join(words) if len(words) <= _MANY else "any"


def _range(low: float, high: float, unit: str) -> str:
    return f"{low:g} {unit}" if low == high else f"{low:g}–{high:g} {unit}"


def _value(value: float | str) -> str:
    return value if isinstance(value, str) else f"{value:.4g}"


def _transition(kind: str, seconds: float) -> str:
    return kind if kind == "cut" else f"{kind} {seconds:.3g} s"
