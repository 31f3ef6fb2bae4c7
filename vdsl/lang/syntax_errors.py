"""What is said about a line that does not read: specific where the mistake is a known one.

The order of the table is the order of asking; the last resort says what would have been allowed.
"""

from __future__ import annotations

from lark.exceptions import UnexpectedCharacters, UnexpectedInput, UnexpectedToken

from .diagnostics import Report, nearest
from .source import Span

FORMS: dict[str, str] = {
    "storyboard": 'storyboard "Morning coffee"',
    "header": "fps 24, size 1280x720, aspect 2.39, seed 7, rig cinema, style board, takes 5 or proposals 80",
    "use": 'use "common.vds"',
    "character": "character anna = woman(height 1.68m)",
    "scene": "scene kitchen = apartment.kitchen at dusk",
    "placement": "anna at door facing window",
    "transition": "cut, dissolve 12f, fade-out 1s, fade-in 1s or wipe",
    "story": "(anna walk counter) / (follow full eye-level) lens 50mm, 4s",
    "cameras": "/ (follow full eye-level) lens 50mm, 4s",
    "definition_head": "prop table(width 1.2m) { … }",
    "definition_file": 'prop lamp = "lamp.glb"',
    "entry": "box (1, 2, 3)m, at (0, 0, 0), color oak",
}


def explain_syntax(error: UnexpectedInput, start: str, line: Span, report: Report) -> None:
    """Report one syntax error of a logical line read with the start rule ``start``."""
    source = line.source
    if isinstance(error, UnexpectedToken) and error.token.type != "$END":
        at = line.start + (error.token.start_pos or 0)
        span = Span(source, at, min(at + len(error.token), line.end))
        label = f"`{span.text}` has no place here"
    elif isinstance(error, UnexpectedCharacters):
        at = line.start + (error.pos_in_stream or 0)
        span = Span(source, at, min(at + 1, line.end))
        label = f"`{span.text}` has no place here"
    else:
        span = Span(source, max(line.start, line.end - 1), line.end)
        label = "the line ends too early"
    report.error("VDS001", span, label=label, help=f"such a line looks like: {FORMS[start]}")


def unknown_statement(line: Span, word: str | None, report: Report) -> None:
    """A line that begins like no statement."""
    words = ("storyboard", "character", "scene", "use", "set", "prop", "cast", "action", "cut", "dissolve",
             "fade-out", "fade-in", "wipe", "fps", "size", "aspect", "seed", "rig", "style", "takes", "proposals")  # fmt: skip
    span = Span(line.source, line.start, line.start + len(word or line.text[:1]))
    suggestion = nearest(word, words) if word else None
    report.error(
        "VDS013",
        span,
        label="no line begins like this",
        help="a story line is `(anna walk door)`, a camera line `/ (static full eye-level)`",
        suggestion=suggestion,
    )
