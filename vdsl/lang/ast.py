"""The syntax tree: what was written, with its places, before any name is looked up.

Two families: *values and entries*, the one general form in which sets, props, cast and
actions are defined (``head values, option values { entries }``), and *story statements*.
Every node carries the span it was read from. Spans take no part in equality.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TypeAlias

from .source import Source, Span

# --- values -------------------------------------------------------------------------


@dataclass(frozen=True)
class Number:
    """``1.68m``: the value as written and its unit: m cm mm deg s f % or None."""

    value: float
    unit: str | None
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True)
class Text:
    value: str
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True)
class Name:
    """A name or dotted path: ``chair_2.seat`` has parts ``("chair_2", "seat")``."""

    parts: tuple[str, ...]
    span: Span = field(compare=False, repr=False)

    @property
    def text(self) -> str:
        return ".".join(self.parts)


@dataclass(frozen=True)
class Group:
    """``(1, 2, 0.5)m``: comma-separated values in parentheses; the unit applies to bare numbers inside."""

    items: tuple[Value, ...]
    unit: str | None
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True)
class Range:
    """``35..85mm``: the unit of the end applies to a bare start."""

    low: Number
    high: Number
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True)
class Binary:
    """Arithmetic: ``op`` is one of ``+ - * /``."""

    op: str
    left: Value
    right: Value
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True)
class Negate:
    value: Value
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True)
class Argument:
    """``height 1.68m`` inside a call."""

    name: Name
    values: tuple[Value, ...]
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True)
class Call:
    """``woman(height 1.68m, hair bob)``: no space before the parenthesis."""

    callee: Name
    arguments: tuple[Argument, ...]
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True)
class Star:
    """``*``: any, the compiler proposes."""

    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True)
class Choice:
    """``slow-in|linear``: any of these (in options of story lines)."""

    items: tuple[Value, ...]
    span: Span = field(compare=False, repr=False)


Value: TypeAlias = Number | Text | Name | Group | Range | Binary | Negate | Call | Star | Choice


# --- definitions --------------------------------------------------------------------


@dataclass(frozen=True)
class Option:
    """``color oak`` after a comma."""

    name: Name
    values: tuple[Value, ...]
    span: Span = field(compare=False, repr=False)


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
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True)
class Parameter:
    """``width 1.2m`` in a definition's head: a name and its default."""

    name: Name
    default: tuple[Value, ...]
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True)
class Definition:
    """``prop table(width 1.2m) { … }``; ``kind`` is set, prop, cast or action."""

    kind: str
    name: Name
    parameters: tuple[Parameter, ...]
    body: tuple[Entry, ...]
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True)
class FileDefinition:
    """``prop lamp = "lamp.glb", height 40cm { … }``: a definition out of another program's file.

    body: its entries, () where no braces were written
    """

    kind: str
    name: Name
    path: Text
    options: tuple[Option, ...]
    body: tuple[Entry, ...]
    span: Span = field(compare=False, repr=False)


# --- the story ----------------------------------------------------------------------


@dataclass(frozen=True)
class Title:
    """``storyboard "Morning coffee"``"""

    text: Text | None
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True)
class Header:
    """``fps 24``, ``size 1280x720`` (two numbers), ``aspect 2.39``, ``rig paper`` …"""

    keyword: Name
    values: tuple[Value, ...]
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True)
class Use:
    """``use "common.vds"``"""

    path: Text
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True)
class CharacterLine:
    """``character anna = woman(height 1.68m)``"""

    name: Name
    cast: Name | Call | Text
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True)
class SceneLine:
    """``scene kitchen = apartment.kitchen at dusk``; without ``=`` the name is the set's too."""

    name: Name
    set: Name | None
    time: Name | None
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True)
class PlacementLine:
    """``anna at door facing window holding bag``; ``posture`` is None where not said; ``beside``: at the side
    of whom or what ``at`` is."""

    character: Name
    at: Name | None
    facing: Name | None
    posture: Name | None
    holding: Name | Call | None
    span: Span = field(compare=False, repr=False)
    beside: bool = False


@dataclass(frozen=True)
class BeatNode:
    """``(anna pick up cup)``: the words as written, the first one the character; who: where that stands if
    not in front of the others, as in ``(anna waves and laughs)``; spoken: what is said in it."""

    words: tuple[Name, ...]
    span: Span = field(compare=False, repr=False)
    who: Span | None = field(default=None, compare=False, repr=False)
    spoken: tuple[Text, ...] = ()


@dataclass(frozen=True)
class CameraNode:
    """``/ (push|static * eye level) lens 50mm``.

    words: names, ``*`` (Star) and choices (Choice of names), in the order written; None where only
        options follow the slash
    """

    words: tuple[Name | Star | Choice, ...] | None
    options: tuple[Option, ...]
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True)
class StoryNode:
    """A story line with its cameras; without beats an establishing shot."""

    beats: tuple[BeatNode, ...]
    options: tuple[Option, ...]
    cameras: tuple[CameraNode, ...]
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True)
class TransitionLine:
    """``dissolve 12f``"""

    kind: Name
    duration: Number | None
    span: Span = field(compare=False, repr=False)


Statement: TypeAlias = (
    Title
    | Header
    | Use
    | CharacterLine
    | SceneLine
    | PlacementLine
    | StoryNode
    | TransitionLine
    | Definition
    | FileDefinition
)


@dataclass(frozen=True)
class Broken:
    """A line that does not read: its first word, and the one after it where that is a name.

    The checker needs it so that one mistake is not told again wherever the line would have been used.
    """

    keyword: str
    name: str | None
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True)
class Script:
    """A whole file, its statements in the order written; lines with errors are left out.

    broken: what was left out
    """

    source: Source
    statements: tuple[Statement, ...]
    span: Span = field(compare=False, repr=False)
    broken: tuple[Broken, ...] = field(default=(), compare=False, repr=False)
