"""The language: source, diagnostics, syntax tree, parser, checker and the checked storyboard."""

from .check import check
from .diagnostics import Diagnostic, Report
from .files import read_source
from .ir import Storyboard
from .parse import parse
from .settings import Settings
from .source import Source, Span

__all__ = [
    "Diagnostic",
    "Report",
    "Settings",
    "Source",
    "Span",
    "Storyboard",
    "check",
    "parse",
    "read_source",
]
