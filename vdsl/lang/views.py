"""Whose shoulder or eyes a camera has, and who is in the picture with whom."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from . import ast, ir
from .camera import CameraWords
from .capitals import Named
from .diagnostics import Report, listing
from .ir import Target
from .targets import unknown_character

if TYPE_CHECKING:
    from .shots import LineContext

#: Sizes and movements proposed where the line says none.
_SCALES = {
    "ots": ("medium-close-up", "medium"),
    "pov": ir.SIZES,
    "two-shot": ("medium", "cowboy", "medium-long", "full"),
    "group": ("medium", "cowboy", "medium-long", "full", "wide"),
}
_MOVEMENTS = {"ots": ("static", "push"), "pov": ("follow",), "two-shot": ir.MOVEMENTS, "group": ir.MOVEMENTS}
#: Angles over a shoulder where the line says none: level, unless one of the two sits and the other stands.
_SHOULDER_ANGLES = ("eye-level", "low-angle", "high-angle")
#: Movements there are through somebody's eyes.
EYES = ("static", "follow")


@dataclass(frozen=True)
class View:
    """words: those of the camera, what was left free narrowed; whose: characters; focus: its own."""

    words: CameraWords
    whose: tuple[str, ...] = ()
    focus: Target | None = None


def read_view(
    node: ast.CameraNode | None,
    said: CameraWords,
    focus: ast.Name | None,
    context: LineContext,
    report: Report,
) -> View:
    """The view a camera asks for, with everybody found; errors where somebody is missing."""
    if not said.view or node is None:
        return View(said)
    if said.whose is not None:
        whose = Named(context.cast, lambda word: False)(said.whose.text)
        said = replace(said, whose=ast.Name((whose,), said.whose.span))
    scales = said.scales if "scale" in said.said else _SCALES[said.view]
    movements = said.movements if "movement" in said.said else _MOVEMENTS[said.view]
    words = replace(said, scales=scales, movements=movements)
    if said.view == "ots" and "angle" not in said.said:
        words = replace(words, angles=_SHOULDER_ANGLES)
    if said.whose is not None and said.whose.text not in context.cast:
        unknown_character(said.whose, context.cast, report)
        return View(words)
    involved = _involved(context)
    if said.view in ("two-shot", "group"):
        if said.view == "two-shot" and len(context.cast) < 2:
            _missing(
                node, "there is nobody else to be in the picture", "a two-shot needs two characters", report
            )
        named = (focus.text,) if focus is not None and focus.text in context.cast else ()
        return View(words, tuple(dict.fromkeys((*named, *involved))))
    if said.view == "pov":
        words = _through_eyes(node, words, report)
    return _between(node, words, involved, focus, context, report)


def _involved(context: LineContext) -> tuple[str, ...]:
    """The characters of a line, who acts first."""
    found = [beat.character for beat in context.beats]
    for beat in context.beats:
        found += [t.path[-1] for t in (beat.target, beat.second) if t is not None and t.kind == "character"]
    return tuple(dict.fromkeys(found))


def _between(
    node: ast.CameraNode,
    words: CameraWords,
    involved: tuple[str, ...],
    focus: ast.Name | None,
    context: LineContext,
    report: Report,
) -> View:
    """Over whose shoulder (through whose eyes), and at whom: of two on a line each stands for the other."""
    seen = focus.text if focus is not None else None
    if words.whose is not None:
        owner: str | None = words.whose.text
    elif words.view == "pov":
        owner = next((name for name in involved if name != seen), None)
    else:  # over the shoulder of the one who is not looked at
        at = seen or (involved[0] if involved else None)
        owner = next((name for name in involved if name != at), None)
    if owner is None:
        what = "shoulder" if words.view == "ots" else "eyes"
        _missing(
            node, f"whose {what}?", f"say `{words.view} NAME`; characters are {listing(context.cast)}", report
        )
        return View(words)
    if seen == owner:
        _missing(node, f"{owner} cannot be looked at from there", "focus somebody or something else", report)
        return View(words, (owner,))
    if focus is not None:
        return View(words, (owner,))
    targets = [t for beat in context.beats for t in (beat.target, beat.second) if t is not None]
    if context.subject is not None and context.subject.path[-1:] != (owner,):
        return View(words, (owner,))
    found = next((t for t in targets if t.path[-1:] != (owner,)), None)
    if found is None:
        other = next((name for name in involved if name != owner), None)
        if other is not None:
            span = node.span
            found = Target("character", (other,), other, span)
    if found is None:
        _missing(node, f"what does {owner} look at?", "say `focus NAME` after the camera", report)
    return View(words, (owner,), found)


def _through_eyes(node: ast.CameraNode, words: CameraWords, report: Report) -> CameraWords:
    """Eyes stay where they are: what moves or raises the camera is an error."""
    moved = [m for m in words.movements if m not in EYES]
    if moved or "angle" in words.said:
        report.error(
            "VDS048",
            node.span,
            label=f"eyes cannot {moved[0]}" if moved else "eyes are as high as they are",
            help=f"a point of view takes {listing(EYES)} and a size, no angle",
        )
        return replace(words, movements=EYES)
    return replace(words, angles=("eye-level",))


def _missing(node: ast.CameraNode, label: str, help: str, report: Report) -> None:
    report.error("VDS047", node.span, label=label, help=help)
