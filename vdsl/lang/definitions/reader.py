"""Reading one entry of a definition: typed, with defaults, and nothing left unread.

A reader asks for what it knows, by name or by position, and ends with :meth:`Reader.done`, which
reports every option and value nobody asked for, at its place. All getters report what is wrong and
answer the default, so that reading goes on.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import TypeVar

from .. import ast
from ..build import UNITS
from ..diagnostics import Report, listing, nearest
from ..evaluate import Bound, bad_word, evaluate, evaluate_point
from ..source import Span

T = TypeVar("T")


class Reader:
    """One entry and the names its values may use.

    env: names to numbers in SI units (or ``Quantity``), or to words
    """

    def __init__(self, entry: ast.Entry, env: Mapping[str, Bound], report: Report) -> None:
        self.entry = entry
        self.env = env
        self.report = report
        self._options: dict[str, ast.Option] = {}
        self._read: set[str] = set()
        self._asked: dict[str, None] = {}
        self._values_read: set[int] = set()
        self._bound_read = False
        self._body_read = False
        for option in entry.options:
            name = option.name.text
            if name in self._options:
                report.error("VDS023", option.span, label=f"`{name}` is said twice on this line")
            else:
                self._options[name] = option

    @property
    def head(self) -> str:
        return self.entry.head.text

    @property
    def span(self) -> Span:
        return self.entry.span

    # -- options by name -------------------------------------------------------------

    def has(self, name: str) -> bool:
        """Whether the option is written; it still has to be read."""
        self._asked[name] = None
        return name in self._options

    def option(self, name: str) -> tuple[ast.Value, ...] | None:
        """The raw values of an option, or None where it is not written."""
        self._asked[name] = None
        option = self._options.get(name)
        if option is None:
            return None
        self._read.add(name)
        return option.values

    def _one(self, name: str) -> ast.Value | None:
        values = self.option(name)
        if values is None:
            return None
        if len(values) != 1:
            option = self._options[name]
            self.report.error(
                "VDS024",
                option.span if len(values) > 1 else option.name.span,
                label=f"`{name}` takes one value, {len(values) or 'none'} is written"
                if len(values) < 2
                else f"`{name}` takes one value, {len(values)} are written",
                help="separate options with commas" if len(values) > 1 else None,
            )
            return None
        return values[0]

    def _number(self, name: str, default: T, want: str) -> float | T:
        value = self._one(name)
        return default if value is None else _float(evaluate(value, self.env, want, self.report), default)

    def length(self, name: str, default: T) -> float | T:
        """Metres."""
        return self._number(name, default, "length")

    def angle(self, name: str, default: T) -> float | T:
        """Radians."""
        return self._number(name, default, "angle")

    def number(self, name: str, default: T) -> float | T:
        return self._number(name, default, "number")

    def seconds(self, name: str, default: T) -> float | T:
        return self._number(name, default, "seconds")

    def word(self, name: str, default: T, choices: Iterable[str] | None = None) -> str | T:
        value = self._one(name)
        return default if value is None else self._as_word(value, default, choices)

    def words(self, name: str) -> tuple[str, ...]:
        """All the words after an option; () where it is not written."""
        found = (evaluate(value, self.env, "word", self.report) for value in self.option(name) or ())
        return tuple(word for word in found if isinstance(word, str))

    def text(self, name: str, default: T) -> str | T:
        value = self._one(name)
        got = None if value is None else evaluate(value, self.env, "text", self.report)
        return got if isinstance(got, str) else default

    def point(
        self, name: str, default: T, size: int | None = None, want: str = "length"
    ) -> tuple[float, ...] | T:
        """Metres; ``size`` numbers where given."""
        value = self._one(name)
        return default if value is None else self._as_point(value, default, size, want)

    def points(self, name: str) -> tuple[tuple[float, ...], ...]:
        """``profile ((r, z), (r, z))``: a group of groups, metres; an outer unit serves the inner groups."""
        value = self._one(name)
        return () if value is None else self._as_points(value)

    def colour(self, name: str, default: T) -> str | T:
        """A colour as written, a word or ``"#c33a2b"``; what it means is for the stage."""
        return self.word(name, default)

    def flag(self, name: str, default: bool = False) -> bool:
        """``glow`` alone or ``glow yes`` / ``glow no``."""
        values = self.option(name)
        if values is None:
            return default
        if not values:
            return True
        word = self.word(name, "yes" if default else "no", ("yes", "no"))
        return word == "yes"

    # -- values by position ------------------------------------------------------------

    @property
    def count(self) -> int:
        """How many values stand before the ``=`` or the first comma."""
        return len(self.entry.values)

    def value(self, index: int) -> ast.Value | None:
        """The raw value at a place, or None."""
        if index >= len(self.entry.values):
            return None
        self._values_read.add(index)
        return self.entry.values[index]

    def values(self) -> tuple[ast.Value, ...]:
        """All the positional values, raw."""
        self._values_read.update(range(len(self.entry.values)))
        return self.entry.values

    def _value(self, index: int, default: object, what: str) -> ast.Value | None:
        value = self.value(index)
        if value is None and default is None:
            self.missing(what)
        return value

    def value_length(self, index: int, default: float | None = None) -> float:
        """Metres; without a default a missing value is an error (and 0)."""
        return self._value_number(index, default, "length", "a length")

    def value_angle(self, index: int, default: float | None = None) -> float:
        """Radians."""
        return self._value_number(index, default, "angle", "an angle")

    def value_seconds(self, index: int, default: float | None = None) -> float:
        return self._value_number(index, default, "seconds", "a time")

    def value_number(self, index: int, default: float | None = None) -> float:
        return self._value_number(index, default, "number", "a number")

    def _value_number(self, index: int, default: float | None, want: str, what: str) -> float:
        value = self._value(index, default, what)
        fallback = 0.0 if default is None else default
        return fallback if value is None else _float(evaluate(value, self.env, want, self.report), fallback)

    def value_word(self, index: int, default: str | None = None, choices: Iterable[str] | None = None) -> str:
        """A word; without a default a missing one is an error (and '')."""
        value = self._value(index, default, "a word")
        fallback = "" if default is None else default
        return fallback if value is None else self._as_word(value, fallback, choices)

    def value_text(self, index: int, default: str | None = None) -> str:
        value = self._value(index, default, "a text")
        got = None if value is None else evaluate(value, self.env, "text", self.report)
        return got if isinstance(got, str) else (default or "")

    def value_point(
        self,
        index: int,
        default: tuple[float, ...] | None = None,
        size: int | None = None,
        want: str = "length",
    ) -> tuple[float, ...]:
        """Metres; without a default a missing one is an error (and zeros)."""
        value = self._value(index, default, "a point")
        fallback = (0.0,) * (size or 3) if default is None else default
        return fallback if value is None else self._as_point(value, fallback, size, want)

    # -- after the "=" -------------------------------------------------------------------

    def bound(self) -> tuple[ast.Value, ...]:
        """The raw values after ``=``; () where there is none."""
        self._bound_read = True
        return self.entry.bound

    def bound_call(self) -> ast.Call | None:
        """``= table(width 1.2m)``, or ``= table`` as a call without arguments."""
        values = self.bound()
        if len(values) == 1 and isinstance(values[0], ast.Call):
            return values[0]
        if len(values) == 1 and isinstance(values[0], ast.Name):
            return ast.Call(values[0], (), values[0].span)
        self.missing("`= NAME` or `= NAME(…)`")
        return None

    def body(self) -> tuple[ast.Entry, ...]:
        """The entries in braces; () where there are none."""
        self._body_read = True
        return self.entry.body or ()

    # -- the end -------------------------------------------------------------------------

    def missing(self, what: str) -> None:
        """Report that the entry lacks something."""
        self.report.error("VDS029", self.entry.span, label=f"`{self.head}` needs {what}")

    def done(self) -> None:
        """Report everything written that nobody has read."""
        for name, option in self._options.items():
            if name not in self._read:
                self.report.error(
                    "VDS030",
                    option.name.span,
                    label=f"`{self.head}` has no option `{name}`",
                    help=f"it has {listing(self._asked, last='and')}" if self._asked else "it has no options",
                    suggestion=nearest(name, self._asked),
                )
        for index, value in enumerate(self.entry.values):
            if index not in self._values_read:
                unit = isinstance(value, ast.Name) and value.text in UNITS
                help = "a unit follows without a space: `(1, 2)m`" if unit else "is a comma missing?"
                self.report.error("VDS031", value.span, label=f"`{self.head}` takes no value here", help=help)
                break
        if self.entry.bound and not self._bound_read:
            self.report.error(
                "VDS031", self.entry.bound[0].span, label=f"nothing can be set to `{self.head}`"
            )
        if self.entry.body is not None and not self._body_read:
            self.report.error("VDS031", self.entry.span, label=f"`{self.head}` takes no braces")

    # -- helpers -------------------------------------------------------------------------

    def _as_word(self, value: ast.Value, default: T, choices: Iterable[str] | None) -> str | T:
        got = evaluate(value, self.env, "word", self.report)
        if not isinstance(got, str):
            return default
        if choices is not None:
            choices = tuple(choices)
            if got not in choices:
                bad_word(value.span, got, choices, self.report)
                return default
        return got

    def _as_point(self, value: ast.Value, default: T, size: int | None, want: str) -> tuple[float, ...] | T:
        got = evaluate_point(value, self.env, self.report, want)
        if got is None:
            return default
        if size is not None and len(got) != size:
            self.report.error(
                "VDS032", value.span, label=f"{size} numbers are wanted here, {len(got)} are written"
            )
            return default
        return got

    def _as_points(self, value: ast.Value) -> tuple[tuple[float, ...], ...]:
        if not isinstance(value, ast.Group):
            self.report.error(
                "VDS021", value.span, label="points are wanted here", help="such as ((0, 0), (1, 0), (1, 2))m"
            )
            return ()
        found = []
        for item in value.items:
            if isinstance(item, ast.Group) and item.unit is None:
                item = ast.Group(item.items, value.unit, item.span)
            point = evaluate_point(item, self.env, self.report)
            if point is not None:
                found.append(point)
        return tuple(found)


def unknown_entry(entry: ast.Entry, known: Iterable[str], where: str, report: Report) -> None:
    """Report an entry whose head means nothing in this place (``where``: "a prop", "a room" …)."""
    known = tuple(known)
    head = entry.head.text
    meant = nearest(head, known)
    report.error(
        "VDS033",
        entry.head.span,
        label=f"{where} has no `{head}`",
        help=f"it has {listing(known, 20, last='and')}",
        suggestion=meant,
        fix=meant,
    )


def _float(got: float | str | None, default: T) -> float | T:
    return got if isinstance(got, float) and math.isfinite(got) else default
