"""Diagnostics as a person or a program reads them.

For people: file, line and column, the source line with the span underlined, what is wrong, help, a did
you mean. Colours on a terminal (unless ``NO_COLOR`` is set), plain text in a pipe. For programs: JSON
of schema ``vds.diagnostics/1`` (see ``docs/language.md``). Nothing from a script reaches a terminal
unfiltered: characters that do not print are replaced.
"""

from __future__ import annotations

import json
import os
import sys
import unicodedata
from collections.abc import Iterable, Sequence
from typing import TextIO

from ..lang.diagnostics import Diagnostic, Report, listing
from ..lang.source import Span
from ..pipeline.findings import finding

SCHEMA = "vds.diagnostics/1"
WIDTH = 116
MOST_PRINTED = 200
_MOST_LINES = 8  # that are named where the same is said of several
_STYLES = {
    "error": "\x1b[1;31m", "warning": "\x1b[1;33m", "note": "\x1b[1;36m", "help": "\x1b[1;32m",
    "frame": "\x1b[34m", "bold": "\x1b[1m",
}  # fmt: skip
_RESET = "\x1b[0m"


def print_report(report: Report, format: str = "text", file: str = "", stream: TextIO | None = None) -> None:
    """Print all findings: ``text`` to the error stream, ``json`` to the output stream, unless told where."""
    if format == "json":
        write_line(as_json(report, file), stream or sys.stdout)
        return
    stream = stream or sys.stderr
    text = as_text(report.diagnostics, colour=wants_colour(stream))
    if text:
        write_line(text, stream)


def as_json(report: Report, file: str) -> str:
    """The document of schema ``vds.diagnostics/1``; lines and columns are 1-based, ends exclusive."""
    found = report.diagnostics
    document = {
        "schema": SCHEMA,
        "file": file,
        "errors": sum(d.severity == "error" for d in found),
        "warnings": sum(d.severity == "warning" for d in found),
        "diagnostics": [finding(d) for d in found],
    }
    text = json.dumps(document, ensure_ascii=False, indent=2)
    # A file's name may hold bytes that are no text; escaped they are still JSON.
    return text if _encodes(text) else json.dumps(document, indent=2)


def _encodes(text: str) -> bool:
    encoding = getattr(sys.stdout, "encoding", None) or "utf-8"
    try:
        text.encode(encoding)
    except UnicodeEncodeError:
        return False
    return True


def as_text(diagnostics: Iterable[Diagnostic], colour: bool = False) -> str:
    """All findings for reading, what is said of several places once, and a count of them at the end."""
    found = list(diagnostics)
    if not found:
        return ""
    paint = _Paint(colour)
    alike = _alike(found)
    parts = [_one(each[0], paint, [d.span for d in each[1:]]) for each in alike[:MOST_PRINTED]]
    left = sum(map(len, alike[MOST_PRINTED:]))
    if left:
        parts.append(f"… and {left:,} more; `--format json` has them all")
    errors = sum(d.severity == "error" for d in found)
    warnings = len(found) - errors
    counts = [count(n, word) for n, word in ((errors, "error"), (warnings, "warning")) if n]
    more = f"; `vdsc explain {found[0].code}` says more" if errors else ""
    parts.append(paint("error" if errors else "warning", " and ".join(counts)) + more)
    return "\n\n".join(parts)


def count(number: int, word: str) -> str:
    """``1 shot``, ``2 shots``"""
    return f"{number} {word}" if number == 1 else f"{number} {word}s"


class _Paint:
    def __init__(self, colour: bool) -> None:
        self.colour = colour

    def __call__(self, style: str, text: str) -> str:
        return f"{_STYLES[style]}{text}{_RESET}" if self.colour and text else text


def _alike(found: Iterable[Diagnostic]) -> list[list[Diagnostic]]:
    """Findings of which the same is said, in the order of the first of them."""
    by: dict[object, list[Diagnostic]] = {}
    for d in found:
        said = (d.severity, d.code, d.label, d.help, d.suggestion, d.notes, d.span.source.name)
        by.setdefault(said if d.label else id(d), []).append(d)
    return list(by.values())


def _one(d: Diagnostic, paint: _Paint, also: Sequence[Span] = ()) -> str:
    """also: where the same is said"""
    lines = [f"{paint(d.severity, f'{d.severity}[{d.code}]')}: {paint('bold', printable(d.title))}"]
    lines += _excerpt(d.span, d.severity, d.label, "-->", paint)
    edge = paint("frame", " " * len(str(d.span.line_number)) + " =")
    if d.suggestion:
        lines.append(f"{edge} {paint('help', 'did you mean')} `{printable(d.suggestion)}`?")
    if d.help:
        lines.append(f"{edge} {paint('help', 'help')}: {printable(d.help)}")
    for span, text in d.notes:
        lines.append(f"{edge} {paint('note', 'note')}: {printable(text)}")
        lines += _excerpt(span, "note", "", "-->", paint)
    lower = list(dict.fromkeys(span.line_number for span in also if span.line_number != d.span.line_number))
    if lower:
        rest = [f"{len(lower) - _MOST_LINES} more"] if len(lower) > _MOST_LINES else []
        where = listing([*map(str, lower[:_MOST_LINES]), *rest], last="and")
        word = "line" if len(lower) == 1 else "lines"
        lines.append(f"{edge} {paint('note', 'note')}: the same on {word} {where}")
    return "\n".join(lines)


def _excerpt(span: Span, style: str, label: str, arrow: str, paint: _Paint) -> list[str]:
    """The place, and its line with the span underlined."""
    line, column = span.source.position(span.start)
    gutter = str(line + 1)
    pad = " " * len(gutter)
    place = f"{printable(span.source.name)}:{line + 1}:{column + 1}"
    lines = [f"{pad}{paint('frame', arrow)} {place}"]
    if not span.source.text:
        return [*lines, f"{pad} {paint('frame', '=')} {printable(label)}"] if label else lines
    text = span.source.line(line)
    end = min(len(text), column + max(1, span.end - span.start))
    text, start, end = _window(text, column, end)
    before, marked = _cells(text[:start]), max(1, _cells(text[start:end]))
    mark = ("^" if style != "note" else "-") * marked
    lines.append(f"{paint('frame', gutter + ' |')} {printable(text)}")
    lines.append(
        f"{paint('frame', pad + ' |')} {' ' * before}{paint(style, (mark + ' ' + printable(label)).rstrip())}"
    )
    return lines


def _window(text: str, start: int, end: int) -> tuple[str, int, int]:
    """A long line cut to the part around the span, with where the span is in it."""
    text = text.expandtabs(1)
    if len(text) <= WIDTH:
        return text, start, end
    left = max(0, min(start - WIDTH // 3, len(text) - WIDTH))
    right = left + WIDTH
    head, tail = "…" if left else "", "…" if right < len(text) else ""
    shift = len(head) - left
    return head + text[left:right] + tail, start + shift, min(end, right) + shift


def printable(text: str) -> str:
    """Text without anything that could steer a terminal."""
    return "".join(c if c.isprintable() else " " if c in "\t\n\r" else "\ufffd" for c in text)


def _cells(text: str) -> int:
    """Columns a terminal needs for a text."""
    return sum(
        0 if unicodedata.combining(c) else 2 if unicodedata.east_asian_width(c) in "WF" else 1 for c in text
    )


def wants_colour(stream: TextIO) -> bool:
    """Whether colours are welcome on a stream."""
    if os.environ.get("NO_COLOR") or os.environ.get("TERM") == "dumb":
        return False
    return stream.isatty()


def write_line(text: str, stream: TextIO) -> None:
    """Print, also where the stream's encoding knows fewer characters than the text."""
    encoding = getattr(stream, "encoding", None) or "utf-8"
    print(text.encode(encoding, "replace").decode(encoding), file=stream)
