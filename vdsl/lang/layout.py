"""Layout: a script cut into logical lines and braces, before any grammar.

Knows strings, comments, parentheses and braces and nothing else. A newline ends a logical line
except inside parentheses, and in the story not even there where the next line plainly starts
something new; so one forgotten parenthesis costs one line, not the file. Never fails: what does not
match is reported and cut so that the rest still reads.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field

from .diagnostics import Report
from .source import Source, Span

#: Longer logical lines are refused rather than read; no one writes them.
LONGEST_LINE = 20_000
DEEPEST = 40

_PIECE = re.compile(r'"(?:[^"\\\n]|\\[^\n])*"?|\#[^\n]*|[(){};\n]|[^"\#(){};\n]+')
_STORY_START = re.compile(
    r"[ \t]*(?:[(/\n\r]|$|(?:storyboard|character|scene|use|set|prop|cast|action|cut|dissolve|fade-in"
    r"|fade-out|wipe|fps|size|aspect|seed|rig|style|takes|proposals|aperture)\b(?!-))|[^\W\d][\w-]*[ \t]+at\b"
)


@dataclass
class Line:
    """A logical line ``[start, end)`` without comments after it, and what its braces hold.

    gap: a blank line stands before it
    """

    start: int
    end: int
    gap: bool
    body: list[Line] | None = None
    broken: bool = False


@dataclass
class _Cutter:
    source: Source
    report: Report
    stack: list[Line] = field(default_factory=list)
    top: list[Line] = field(default_factory=list)
    start: int = -1  # of the current logical line, -1 between lines
    end: int = 0
    gap: bool = False
    broken: bool = False
    parens: list[int] = field(default_factory=list)

    @property
    def lines(self) -> list[Line]:
        if not self.stack:
            return self.top
        body = self.stack[-1].body
        assert body is not None
        return body

    def span(self, start: int, end: int) -> Span:
        return Span(self.source, start, end)

    def text(self, start: int, end: int) -> None:
        if self.start < 0:
            self.start = start
        self.end = end

    def finish(self) -> None:
        """End the current logical line, if one has begun."""
        if self.parens and not self.broken:
            at = self.parens[0]
            self.broken = True
            self.report.error(
                "VDS002",
                self.span(at, at + 1),
                label="this parenthesis is not closed",
                help="add `)` before the end of the line",
            )
        if self.start >= 0:
            line = Line(self.start, self.end, self.gap, None, self.broken)
            if self.end - self.start > LONGEST_LINE:
                line.broken = True
                self.report.error(
                    "VDS005",
                    self.span(self.start, self.start + 1),
                    label=f"this line has {self.end - self.start:,} characters; {LONGEST_LINE:,} is the most",
                    help="split it into several lines",
                )
            self.lines.append(line)
            self.gap = False
        self.start = -1
        self.broken = False
        self.parens.clear()

    def open_brace(self, at: int) -> None:
        if len(self.stack) >= DEEPEST:
            self.broken = True
            self.report.error(
                "VDS006", self.span(at, at + 1), label=f"more than {DEEPEST} braces inside each other"
            )
        if self.start < 0:
            # A brace on a line of its own belongs to the line before it.
            if self.lines and self.lines[-1].body is None:
                owner = self.lines[-1]
            else:
                self.report.error("VDS003", self.span(at, at + 1), label="nothing stands before this brace")
                owner = Line(at, at, False, None, True)
                self.lines.append(owner)
        else:
            self.finish()
            owner = self.lines[-1]
        owner.body = []
        self.stack.append(owner)
        self.brace_at.append(at)

    brace_at: list[int] = field(default_factory=list)

    def close_brace(self, at: int) -> None:
        self.finish()
        if self.stack:
            self.stack.pop()
            self.brace_at.pop()
        else:
            self.report.error(
                "VDS003", self.span(at, at + 1), label="no brace is open here", help="remove it"
            )


def cut(source: Source, report: Report, start: int = 0, end: int | None = None) -> list[Line]:
    """The logical lines of a source (or of a part of it, by offsets), nested as its braces are."""
    text = source.text
    c = _Cutter(source, report)
    blank = False  # the physical line so far holds nothing
    for match in _PIECE.finditer(
        text, start or int(text.startswith("\ufeff")), len(text) if end is None else end
    ):
        piece, at = match.group(), match.start()
        first = piece[0]
        if first == "\n":
            if blank:
                c.gap = True
            blank = True
            if not c.parens or (not c.stack and (text[c.start] in "(/" or _STORY_START.match(text, at + 1))):
                c.finish()
            continue
        if first not in " \t\r\f\u00a0" or piece.strip():
            blank = False
        _take(c, piece, first, at)
    c.finish()
    for at in c.brace_at:
        report.error(
            "VDS003",
            c.span(at, at + 1),
            label="this brace is not closed",
            help="add `}` where the definition ends",
        )
    return c.top


def _take(c: _Cutter, piece: str, first: str, at: int) -> None:
    """Account for one piece that is no newline."""
    end = at + len(piece)
    if first == "#":
        return
    if first == '"':
        c.text(at, end)
        if len(piece) < 2 or not piece.endswith('"') or (piece.endswith('\\"') and _escaped(piece)):
            c.broken = True
            c.report.error(
                "VDS004",
                c.span(at, at + len(piece.rstrip())),
                label="this text is not closed",
                help='end it with `"`',
            )
    elif first == "(":
        c.text(at, end)
        c.parens.append(at)
        if len(c.parens) == DEEPEST + 1:
            c.broken = True
            c.report.error(
                "VDS006", c.span(at, end), label=f"more than {DEEPEST} parentheses inside each other"
            )
    elif first == ")":
        c.text(at, end)
        if c.parens:
            c.parens.pop()
        elif not c.broken:
            c.broken = True
            c.report.error("VDS002", c.span(at, end), label="no parenthesis is open here", help="remove it")
    elif first == "{":
        c.open_brace(at)
    elif first == "}":
        c.close_brace(at)
    elif first == ";":
        if c.stack and not c.parens:
            c.finish()
        elif c.parens:  # a mark in a sentence, if there it has a place
            c.text(at, end)
        elif not c.broken:
            c.text(at, end)
            c.broken = True
            c.report.error(
                "VDS007", c.span(at, end), label="`;` has no place here", help="start a new line instead"
            )
    else:
        stripped = piece.strip(" \t\r\f\u00a0")
        if stripped:
            begin = at + piece.index(stripped[0])
            c.text(begin, begin + len(stripped))


def _escaped(piece: str) -> bool:
    """Whether the quote a piece ends with is escaped (so that it does not close the text)."""
    slashes = len(piece) - 1 - len(piece[:-1].rstrip("\\"))
    return slashes % 2 == 1
