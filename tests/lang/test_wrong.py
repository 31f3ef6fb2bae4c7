"""Wrong scripts, with what is wrong annotated in them: exactly those diagnostics, at exactly those places.

An annotation stands below the line it is about: ``# error: VDS060 12-18 conter``, 1-based columns, end
exclusive, then the text that is underlined. ``# suggests: counter`` below it checks the did-you-mean.
Run ``python tests/lang/test_wrong.py --write`` to annotate anew, and read the difference before keeping it.
"""

from __future__ import annotations

import re
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest
from small_catalog import SmallCatalog

from vdsl.lang import Diagnostic, Report, Source, check, parse

FOLDER = Path(__file__).with_name("wrong")
SCRIPTS = sorted(FOLDER.glob("*.vds"))
_ANNOTATION = re.compile(r"^\s*# (error|warning): (VDS\d{3}) (\d+)-(\d+)(?: (.*))?$")
_SUGGESTS = re.compile(r"^\s*# suggests: (.*)$")


@dataclass(frozen=True)
class Expected:
    """One annotation; ``line`` is the 1-based line it is about."""

    severity: str
    code: str
    line: int
    start: int
    end: int
    text: str
    suggestion: str | None


def expectations(text: str) -> list[Expected]:
    found: list[Expected] = []
    about = 0
    lines = text.split("\n")
    for number, line in enumerate(lines, 1):
        match = _ANNOTATION.match(line)
        if match is None:
            if not _SUGGESTS.match(line):
                about = number
            continue
        after = _SUGGESTS.match(lines[number]) if number < len(lines) else None
        severity, code, start, end, shown = match.groups()
        suggestion = after.group(1) if after else None
        found.append(Expected(severity, code, about, int(start), int(end), shown or "", suggestion))
    return found


def diagnose(path: Path) -> tuple[Diagnostic, ...]:
    report = Report()
    source = Source(str(path), path.read_text(encoding="utf-8"))
    script, _ = parse(source, report)
    check(script, SmallCatalog(), report)
    return report.diagnostics


def actual(found: tuple[Diagnostic, ...]) -> list[Expected]:
    return [_as_expected(d) for d in found]


def _as_expected(d: Diagnostic) -> Expected:
    line, column = d.span.source.position(d.span.start)
    shown = d.span.text.split("\n")[0].rstrip()
    end = column + 1 + len(shown)
    return Expected(d.severity, d.code, line + 1, column + 1, end, shown, d.suggestion)


@pytest.mark.parametrize("path", SCRIPTS, ids=[path.stem for path in SCRIPTS])
def test_exactly_the_annotated_mistakes(path: Path) -> None:
    expected = expectations(path.read_text(encoding="utf-8"))
    assert expected, "a wrong script says what is wrong with it"
    assert actual(diagnose(path)) == expected


def test_there_are_enough() -> None:
    assert len(SCRIPTS) >= 40


@pytest.mark.parametrize("path", SCRIPTS, ids=[path.stem for path in SCRIPTS])
def test_every_finding_says_something(path: Path) -> None:
    for d in diagnose(path):
        assert d.label, d
        assert d.title != d.code, f"{d.code} has no row in the table"
        assert 0 <= d.span.start <= d.span.end <= len(d.span.source.text)


def annotate(path: Path) -> None:
    """Write what is found into a script, in place of the annotations it has."""
    plain = [
        line
        for line in path.read_text(encoding="utf-8").split("\n")
        if not _ANNOTATION.match(line) and not _SUGGESTS.match(line)
    ]
    path.write_text("\n".join(plain), encoding="utf-8")
    notes: dict[int, list[str]] = {}
    for e in actual(diagnose(path)):
        lines = notes.setdefault(e.line, [])
        lines.append(f"# {e.severity}: {e.code} {e.start}-{e.end} {e.text}".rstrip())
        if e.suggestion is not None:
            lines.append(f"# suggests: {e.suggestion}")
    out = [text for number, line in enumerate(plain, 1) for text in (line, *notes.get(number, []))]
    path.write_text("\n".join(out), encoding="utf-8")


if __name__ == "__main__" and "--write" in sys.argv:
    for each in SCRIPTS:
        annotate(each)
