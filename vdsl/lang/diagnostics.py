"""Errors as data: what is wrong, where, and what would be right.

Nothing here prints. A :class:`Report` collects; whoever shows it sorts and draws. Raising is kept for
our own bugs: whatever a writer can type ends up as a :class:`Diagnostic`.
"""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from dataclasses import dataclass, field

from .source import Span


@dataclass(frozen=True)
class Diagnostic:
    """One finding.

    code: ``VDSnnn``, a row of :mod:`vdsl.lang.codes`; severity: ``error`` or ``warning``
    title: the code's title; label: what is said at the span; help: how to put it right
    suggestion: the name that was probably meant; fix: text to put in place of the span
    notes: further places, each with what is to be seen there
    """

    code: str
    severity: str
    title: str
    span: Span
    label: str
    help: str | None = None
    suggestion: str | None = None
    fix: str | None = None
    notes: tuple[tuple[Span, str], ...] = ()


@dataclass
class Report:
    """Collects diagnostics. The same code at the same place is kept once."""

    _found: dict[tuple[str, str, int, int], Diagnostic] = field(default_factory=dict)

    def error(
        self,
        code: str,
        span: Span,
        *,
        label: str = "",
        help: str | None = None,
        suggestion: str | None = None,
        fix: str | None = None,
        notes: Iterable[tuple[Span, str]] = (),
    ) -> None:
        """Add an error; the storyboard will not be compiled."""
        self._add("error", code, span, label, help, suggestion, fix, tuple(notes))

    def warn(
        self,
        code: str,
        span: Span,
        *,
        label: str = "",
        help: str | None = None,
        suggestion: str | None = None,
        fix: str | None = None,
        notes: Iterable[tuple[Span, str]] = (),
    ) -> None:
        """Add a warning; the storyboard compiles all the same."""
        self._add("warning", code, span, label, help, suggestion, fix, tuple(notes))

    def _add(
        self,
        severity: str,
        code: str,
        span: Span,
        label: str,
        help: str | None,
        suggestion: str | None,
        fix: str | None,
        notes: tuple[tuple[Span, str], ...],
    ) -> None:
        from .codes import title  # here: the table is text that only a finding needs

        key = (code, span.source.name, span.start, span.end)
        entry = Diagnostic(code, severity, title(code), span, label, help, suggestion, fix, notes)
        self._found.setdefault(key, entry)

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """All findings, by file, then by place; errors before warnings at the same place."""
        return tuple(
            sorted(
                self._found.values(),
                key=lambda d: (d.span.source.name, d.span.start, d.severity, d.span.end, d.code),
            )
        )

    @property
    def errors(self) -> tuple[Diagnostic, ...]:
        return tuple(d for d in self.diagnostics if d.severity == "error")

    @property
    def has_errors(self) -> bool:
        return any(d.severity == "error" for d in self._found.values())

    def __len__(self) -> int:
        return len(self._found)


def nearest(word: str, candidates: Iterable[str]) -> str | None:
    """The candidate that was probably meant, or None where nothing is near."""
    folded = {_fold(c): c for c in candidates}
    plain = _fold(word)
    if plain in folded:
        return folded[plain]
    if len(plain) > 64:
        return None
    close = difflib.get_close_matches(plain, folded, n=1, cutoff=0.6)
    if close:
        return folded[close[0]]
    starts = [
        c for f, c in folded.items() if len(plain) >= 3 and (f.startswith(plain) or plain.startswith(f))
    ]
    return min(starts, key=len) if starts else None


def _fold(word: str) -> str:
    return word.casefold().replace("_", "-")


def listing(words: Iterable[str], limit: int = 12) -> str:
    """``a, b or c``, shortened where it would be long."""
    all_words = list(words)
    shown = all_words[:limit]
    if len(all_words) > limit:
        return ", ".join(shown) + f" … ({len(all_words) - limit} more)"
    if len(shown) > 1:
        return ", ".join(shown[:-1]) + " or " + shown[-1]
    return shown[0] if shown else "nothing"
