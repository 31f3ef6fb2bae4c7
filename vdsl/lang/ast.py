"""The syntax tree: what was written, with its places, before any name is looked up.

Two families: *values and entries*, the one general form in which sets, props, cast and
actions are defined (``head values, option values { entries }``), and *story statements*.
Every node carries the span it was read from. Spans take no part in equality.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TypeAlias

from .source import Span


def _span() -> Span:
    return field(compare=False, repr=False)  # type: ignore[no-any-return]


# --- values -------------------------------------------------------------------------


@dataclass(frozen=True)
class Number:
    """``1.68m``: the value as written and its unit: m cm mm deg s f % or None."""

    value: float
    unit: str | None
    span: Span = _span()


@dataclass(frozen=True)
class Text:
    value: str
    span: Span = _span()


@dataclass(frozen=True)
class Name:
    """A name or dotted path: ``chair_2.seat`` has parts ``("chair_2", "seat")``."""

    parts: tuple[str, ...]
    span: Span = _span()

    @property
    def text(self) -> str:
        return ".".join(self.parts)


@dataclass(frozen=True)
class Group:
    """``(1, 2, 0.5)m``: comma-separated values in parentheses; the unit applies to bare numbers inside."""

    items: tuple[Value, ...]
    unit: str | None
    span: Span = _span()


@dataclass(frozen=True)
class Range:
    """``35..85mm``: the unit of the end applies to a bare start."""

    low: Number
    high: Number
    span: Span = _span()


@dataclass(frozen=True)
class Binary:
    """Arithmetic: ``op`` is one of ``+ - * /``."""

    op: str
    left: Value
    right: Value
    span: Span = _span()


@dataclass(frozen=True)
class Negate:
    value: Value
    span: Span = _span()


@dataclass(frozen=True)
class Argument:
    """``height 1.68m`` inside a call."""

    name: Name
    values: tuple[Value, ...]
    span: Span = _span()


@dataclass(frozen=True)
class Call:
    """``woman(height 1.68m, hair bob)``: no space before the parenthesis."""

    callee: Name
    arguments: tuple[Argument, ...]
    span: Span = _span()


Value: TypeAlias = Number | Text | Name | Group | Range | Binary | Negate | Call


# --- definitions --------------------------------------------------------------------


@dataclass(frozen=True)
class Option:
    """``color oak`` after a comma."""

    name: Name
    values: tuple[Value, ...]
    span: Span = _span()


@dataclass(frozen=True)
class Entry:
    """One line of a definition: ``place table = table(width 1.2m), at (1, 2)m { … }``.

    ``values`` stand between the head and the ``=`` (or first comma); ``bound`` after the ``=``.
    ``body`` is None where no braces were written.
    """

    head: Name
    values: tuple[Value, ...]
    bound: tuple[Value, ...]
    options: tuple[Option, ...]
    body: tuple[Entry, ...] | None
    span: Span = _span()


@dataclass(frozen=True)
class Parameter:
    """``width 1.2m`` in a definition's head: a name and its default."""

    name: Name
    default: tuple[Value, ...]
    span: Span = _span()


@dataclass(frozen=True)
class Definition:
    """``prop table(width 1.2m) { … }``; ``kind`` is set, prop, cast or action."""

    kind: str
    name: Name
    parameters: tuple[Parameter, ...]
    body: tuple[Entry, ...]
    span: Span = _span()
