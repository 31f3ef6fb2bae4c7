"""Source text and places in it.

Offsets are 0-based character offsets into the decoded text, ends are exclusive;
one is added only where a person reads a line or a column.
"""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass
from functools import cached_property


@dataclass(frozen=True)
class Source:
    """A script as read: ``name`` is shown to people (a path, or ``<text>``)."""

    name: str
    text: str

    @cached_property
    def line_starts(self) -> tuple[int, ...]:
        """Offset of the first character of every line."""
        starts = [0]
        starts.extend(i + 1 for i, c in enumerate(self.text) if c == "\n")
        return tuple(starts)

    def position(self, offset: int) -> tuple[int, int]:
        """0-based (line, column) of an offset."""
        line = bisect_right(self.line_starts, offset) - 1
        return line, offset - self.line_starts[line]

    def line(self, index: int) -> str:
        """The text of a 0-based line, without its line end."""
        start = self.line_starts[index]
        end = self.line_starts[index + 1] if index + 1 < len(self.line_starts) else len(self.text)
        return self.text[start:end].rstrip("\r\n")


@dataclass(frozen=True)
class Span:
    """A half-open range ``[start, end)`` of a source."""

    source: Source
    start: int
    end: int

    @property
    def text(self) -> str:
        return self.source.text[self.start : self.end]

    @property
    def line_number(self) -> int:
        """1-based line, as a person reads it."""
        return self.source.position(self.start)[0] + 1

    def to(self, other: Span) -> Span:
        """The range from the start of this span to the end of ``other``."""
        return Span(self.source, self.start, other.end)

    def __repr__(self) -> str:  # the text of a whole file in every repr helps nobody
        return f"Span({self.source.name}:{self.start}-{self.end})"
