"""Camera words into the movements, scales and angles that may be proposed."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TypeAlias

from . import ast, ir, words
from .diagnostics import Report, nearest
from .source import Span

SLOTS = ("movement", "scale", "angle")
_MOST_WORDS = 4  # extreme close up shot


@dataclass(frozen=True)
class CameraWords:
    """What a camera line says; canonical words. ``said``: slots that were named, not left free.

    view: one of :data:`vdsl.lang.ir.VIEWS` or ""; whose: shoulder or eyes, where somebody was named
    lean: radians of a ``dutch`` picture
    """

    movements: tuple[str, ...]
    scales: tuple[str, ...]
    angles: tuple[str, ...]
    said: frozenset[str]
    view: str = ""
    whose: ast.Name | None = None
    lean: float | None = None


FREE = CameraWords(words.ANY["movement"], words.ANY["scale"], words.ANY["angle"], frozenset())

#: One position of a camera line: a star, or the words of a choice, joined where they were several.
_Term: TypeAlias = "ast.Star | tuple[tuple[str, Span], ...]"


def read_camera(node: ast.CameraNode | None, rig: str, report: Report) -> CameraWords:
    """The words of a camera line, in any order, as each says what it is; ``*`` takes the next free slot."""
    if node is None or not node.words:
        return FREE
    found: dict[str, tuple[str, ...]] = {}
    stars: list[ast.Star] = []
    whose: ast.Name | None = None
    terms = _terms(node.words)
    while terms:
        term = terms.pop(0)
        if isinstance(term, ast.Star):
            stars.append(term)
            continue
        _take(term, found, rig, report)
        if whose is None and _is_somebodys(term):
            whose = _owner(terms)
    free = [slot for slot in SLOTS if slot not in found]
    if len(stars) > len(free):
        report.error(
            "VDS043",
            stars[-1].span,
            label="there is nothing left for this `*`",
            help="a camera line has a movement, a scale and an angle",
        )
    return CameraWords(
        found.get("movement") or words.ANY["movement"],
        found.get("scale") or words.ANY["scale"],
        found.get("angle") or words.ANY["angle"],
        frozenset(slot for slot, value in found.items() if value),
        found.get("view", ("",))[0],
        whose,
        math.radians(words.DUTCH) if "lean" in found else None,
    )


def _is_somebodys(term: _Term) -> bool:
    """Whether a term is a view that is somebody's, whose name may follow."""
    meaning = None if isinstance(term, ast.Star) else words.meaning(term[0][0])
    return meaning is not None and meaning.slot == "view" and meaning.words[0] in ("ots", "pov")


def _owner(terms: list[_Term]) -> ast.Name | None:
    """Takes the name that stands after ``ots`` or ``pov`` out of the terms; None where a camera word does."""
    for skipped in (0, 1):  # ots of ben
        if len(terms) <= skipped:
            return None
        term = terms[skipped]
        if isinstance(term, ast.Star) or len(term) > 1:
            return None
        word, span = term[0]
        if skipped == 0 and word in ("of", "from", "at"):
            continue
        if words.meaning(word) is not None:
            return None
        del terms[: skipped + 1]
        return ast.Name(tuple(span.text.split(".")), span)
    return None


def _terms(items: tuple[ast.Name | ast.Star | ast.Choice, ...]) -> list[_Term]:
    """Words run together where several make one (``close up``, ``tilt up|tilt down``)."""
    # A flat list of words with where a choice joins them, then longest matches from the left.
    flat: list[tuple[str, Span, bool] | ast.Star] = []
    for item in items:
        if isinstance(item, ast.Star):
            flat.append(item)
            continue
        for i, part in enumerate(item.items if isinstance(item, ast.Choice) else (item,)):
            if isinstance(part, ast.Star):
                flat.append(part)
            else:
                flat.append((words.fold(part.span.text), part.span, i > 0))
    terms: list[_Term] = []
    i = 0
    while i < len(flat):
        piece = flat[i]
        if isinstance(piece, ast.Star):
            terms.append(piece)
            i += 1
            continue
        size = _longest(flat, i)
        run = [part for part in flat[i : i + size] if not isinstance(part, ast.Star)]
        word = ("-".join(part[0] for part in run), piece[1].to(run[-1][1]))
        last = terms[-1] if terms else None
        if piece[2] and isinstance(last, tuple):
            terms[-1] = (*last, word)
        else:
            terms.append((word,))
        i += size
    return terms


def _longest(flat: list[tuple[str, Span, bool] | ast.Star], start: int) -> int:
    """How many of the words from ``start`` on make one known word; 1 where none do."""
    for size in range(_MOST_WORDS, 1, -1):
        run = flat[start : start + size]
        if len(run) < size or any(isinstance(part, ast.Star) for part in run):
            continue
        if any(part[2] for part in run[1:] if not isinstance(part, ast.Star)):
            continue
        word = "-".join(part[0] for part in run if not isinstance(part, ast.Star))
        if words.meaning(word) is not None or word in words.INSTEAD:
            return size
    return 1


def _take(
    term: tuple[tuple[str, Span], ...], found: dict[str, tuple[str, ...]], rig: str, report: Report
) -> None:
    """Put the words of one term into their slot."""
    slot: str | None = None
    meant: list[str] = []
    for word, span in term:
        meaning = words.meaning(word)
        if meaning is None:
            slot = _unknown(word, span, found, report) or slot
            continue
        if word == words.MEDIUM_CLOSE_SHOT[0]:
            _warn_mcs(span, report)
        if slot is not None and meaning.slot != slot:
            report.error(
                "VDS042",
                span,
                label=f"`{span.text}` is {_a(meaning.slot)}, a choice is among {slot}s",
                help="separate movement, scale and angle with spaces",
            )
            continue
        if rig == "paper":
            _on_paper(meaning, span, report)
            if meaning.slot == "view":
                continue
        if meaning.slot == "movement" and not _go_together(meaning.words[0], span, report):
            slot = slot or "movement"
            continue
        slot = meaning.slot
        meant.extend(w for w in meaning.words if w not in meant)
    if slot is None:
        return
    if slot in found:
        span = term[0][1].to(term[-1][1])
        report.error(
            "VDS042",
            span,
            label=f"this is a second {slot}",
            help="join choices with a bar, as in push|static",
        )
        return
    found[slot] = tuple(meant)


def _unknown(word: str, span: Span, found: dict[str, tuple[str, ...]], report: Report) -> str | None:
    """Report a word the camera does not understand; its slot where that is plain."""
    if "+" in word:
        _no_pair(word, span, report)
        found.setdefault("movement", ())
        return None
    meant, told = words.INSTEAD.get(word, (nearest(word, words.CAMERA_WORDS), ""))
    if meant in words.CAMERA_WORDS:
        meaning = words.CAMERA_WORDS[meant]
        canonical = meaning.words[0] if len(meaning.words) == 1 else meant
        report.error(
            "VDS040",
            span,
            label="the camera does not know this word",
            suggestion=canonical,
            fix=canonical,
            help=told or _slot_help(meaning.slot),
        )
        found.setdefault(meaning.slot, ())
        return None
    free = [slot for slot in SLOTS if slot not in found]
    report.error(
        "VDS040",
        span,
        label="the camera does not know this word",
        help=_slot_help(free[0] if free else "movement"),
    )
    return None


def _on_paper(meaning: words.Meaning, span: Span, report: Report) -> None:
    """Report a word for which the paper gives no numbers."""
    known = (*ir.MOVEMENTS, *ir.SCALES, *ir.ANGLES)
    if meaning.slot == "lean" or set(meaning.words) <= set(known):
        return
    near = next((words.paper_word(word) for word in meaning.words if word not in known), None)
    near = near if near in known else None
    report.error(
        "VDS046",
        span,
        label="the paper has no numbers for this",
        suggestion=near,
        fix=near,
        help=f"say {near}, or frame with `rig cinema`" if near else "frame with `rig cinema`",
    )


def _go_together(movement: str, span: Span, report: Report) -> bool:
    """Whether two movements can be done at once; reports it where they cannot."""
    parts = movement.split("+")
    alone = next((p for p in parts if p.startswith("whip-pan")), None)
    same = len(parts) == 2 and _kind(parts[0]) == _kind(parts[1])
    if len(parts) == 1 or not (alone or same):
        return True
    report.error(
        "VDS049",
        span,
        label="a whip pan goes alone" if alone else "these two are of one kind",
        help="two movements at once are of two kinds, as in push+pan-left",
    )
    return False


def _kind(movement: str) -> str:
    """What a movement moves: two that move the same are no pair."""
    kinds = {"push": "reach", "pull": "reach", "dolly": "reach" if "zoom" in movement else "dolly"}
    first = movement.split("-")[0]
    return kinds.get(first, first)


def _no_pair(word: str, span: Span, report: Report) -> None:
    """Report what cannot be done at once, or is no movement."""
    parts = word.split("+")
    wrong = next((p for p in parts if (m := words.meaning(p)) is None or m.slot != "movement"), None)
    movements = [w for w, meaning in words.CAMERA_WORDS.items() if meaning.slot == "movement"]
    meant = nearest(wrong, movements) if wrong else None
    report.error(
        "VDS040",
        span,
        label=f"`{wrong}` is no movement" if wrong else "at most two movements go on at once",
        help="as in push+pan-left",
        suggestion="+".join(meant if p == wrong else p for p in parts) if meant else None,
    )


def _slot_help(slot: str) -> str:
    if slot == "movement":
        families = "static, follow, push, pull, zoom, tilt, pan, dolly, pedestal, arc"
        families += ", crane, roll, dolly-zoom, handheld, whip-pan, rack-focus"
        return f"movements: {families} (and -in, -out, -up, -down, -left, -right)"
    if slot == "scale":
        return f"scales: {', '.join(ir.SIZES)}"
    return f"angles: {', '.join(ir.ALL_ANGLES)}"


def _warn_mcs(span: Span, report: Report) -> None:
    report.warn(
        "VDS044",
        span,
        label="MCS is a medium close shot, not a cowboy shot; taken as medium-close-up",
        help="say medium-close-up for down to the breast pocket, or cowboy for down to the thigh",
        suggestion="medium-close-up",
    )


def _a(word: str) -> str:
    return f"an {word}" if word[0] in "aeiou" else f"a {word}"
