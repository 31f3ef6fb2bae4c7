"""Errors as data: what is wrong, where, and what would be right.

Nothing here prints. A :class:`Report` collects; whoever shows it sorts and draws. Raising is kept for
our own bugs: whatever a writer can type ends up as a :class:`Diagnostic`.
"""

from __future__ import annotations

from collections.abc import Container, Iterable
from dataclasses import dataclass, field
from functools import lru_cache

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


#: No more are kept: a file with so many is no script.
MOST_FINDINGS = 20_000


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

        if len(self._found) >= MOST_FINDINGS:
            return
        key = (code, span.source.name, span.start, span.end)
        entry = Diagnostic(code, severity, title(code), span, label, help, suggestion, fix, notes)
        self._found.setdefault(key, entry)

    def mark(self) -> int:
        """A point from which on errors can be taken back."""
        return len(self._found)

    def take_back(self, mark: int, but: Container[str] = ()) -> list[Diagnostic]:
        """What was added since a mark, but for warnings of some codes; it is no longer kept."""
        since = list(self._found.items())[mark:]
        keys = [key for key, each in since if each.severity == "error" or each.code not in but]
        return [self._found.pop(key) for key in keys]

    def put_back(self, found: Iterable[Diagnostic]) -> None:
        """Add what was taken back."""
        for each in found:
            key = (each.code, each.span.source.name, each.span.start, each.span.end)
            self._found.setdefault(key, each)

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
    """The candidate that was probably meant, or None where nothing is near.

    Near is: the same but for case and ``_``; few slips of the finger (a third of the letters at most);
    or the same beginning, four letters or more.
    """
    return _nearest(word, tuple(candidates))


def is_slip(word: str, name: str) -> bool:
    """Whether a word is a name but for a letter more, less or other, or two that changed places."""
    word, name = word.casefold(), name.casefold()
    if abs(len(word) - len(name)) > 1 or len(word) < 3:
        return False
    short = min(len(word), len(name))
    same = next((k for k in range(short) if word[k] != name[k]), short)
    a, b = word[same:], name[same:]
    swapped = len(a) > 1 and a[:2] == b[:2][::-1] and a[2:] == b[2:]
    return a[1:] == b[1:] or a == b[1:] or a[1:] == b or swapped


def is_mixed_up(word: str, name: str, missing: bool = True) -> bool:
    """Whether a word is a name but that a letter is twice there, or two changed places, or one is missing: of
    short names other words are a letter more or other (``bend``, ``room`` and ``broom``)."""
    word, name = word.casefold(), name.casefold()
    if word == name or len(word) < 3 or name == f"{word}s" or not is_slip(word, name):
        return False
    twice = any(
        word[:k] + word[k + 1 :] == name and (word[k] == word[k - 1] or word[k].isdigit())
        for k in range(1, len(word))
    )
    return (missing and len(word) < len(name)) or twice or sorted(word) == sorted(name)


@lru_cache(maxsize=1024)
def _nearest(word: str, candidates: tuple[str, ...]) -> str | None:
    folded = {_fold(c): c for c in candidates}
    plain = _fold(word)
    if plain in folded:
        return folded[plain]
    if not plain or len(plain) > 64:
        return None
    slips = {f: _distance(plain, f) for f in folded if abs(len(f) - len(plain)) <= len(plain) // 3 + 1}
    best = min(slips, key=lambda f: slips[f], default=None)
    if best is not None and slips[best] <= max(1, len(plain) // 3):
        return folded[best]
    alike = [f for f in folded if _same_start(plain, f)]
    return folded[min(alike, key=lambda f: abs(len(f) - len(plain)))] if alike else None


def _same_start(a: str, b: str) -> bool:
    common = next((i for i, (x, y) in enumerate(zip(a, b, strict=False)) if x != y), min(len(a), len(b)))
    return common >= 4 or (common >= 3 and common in (len(a), len(b)))


def _distance(a: str, b: str) -> int:
    """Letters added, left out, changed or swapped with their neighbour."""
    before: list[int] = []
    row = list(range(len(b) + 1))
    for i, x in enumerate(a, 1):
        last, before = before, row
        row = [i]
        for j, y in enumerate(b, 1):
            cost = min(before[j] + 1, row[j - 1] + 1, before[j - 1] + (x != y))
            if i > 1 and j > 1 and x == b[j - 2] and a[i - 2] == y:
                cost = min(cost, last[j - 2] + 1)
            row.append(cost)
    return row[-1]


def _fold(word: str) -> str:
    return word.casefold().replace("_", "-")


def listing(words: Iterable[str], limit: int = 12, last: str = "or") -> str:
    """``a, b or c``, shortened where it would be long."""
    all_words = list(words)
    shown = all_words[:limit]
    if len(all_words) > limit:
        return ", ".join(shown) + f" … ({len(all_words) - limit} more)"
    if len(shown) > 1:
        return ", ".join(shown[:-1]) + f" {last} " + shown[-1]
    return shown[0] if shown else "nothing"
