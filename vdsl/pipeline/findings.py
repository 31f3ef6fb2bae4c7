"""Diagnostics as data: entries of the documents ``vds.diagnostics/1`` and ``vds.status/1``."""

from __future__ import annotations

from ..lang.diagnostics import Diagnostic
from ..lang.source import Span


def finding(d: Diagnostic) -> dict[str, object]:
    """One finding; lines and columns are 1-based, ends exclusive."""
    return {
        "code": d.code,
        "severity": d.severity,
        "title": d.title,
        "message": d.label,
        **_place(d.span),
        "help": d.help,
        "suggestion": d.suggestion,
        "fix": d.fix,
        "notes": [{"message": text, **_place(span)} for span, text in d.notes],
    }


def _place(span: Span) -> dict[str, object]:
    line, column = span.source.position(span.start)
    end_line, end_column = span.source.position(span.end)
    return {
        "file": span.source.name,
        "line": line + 1,
        "column": column + 1,
        "end_line": end_line + 1,
        "end_column": end_column + 1,
    }
