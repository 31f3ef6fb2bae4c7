"""The language: source, diagnostics, syntax tree, parser, checker and the checked storyboard."""

from .diagnostics import Diagnostic, Report
from .parse import parse
from .source import Source, Span

__all__ = ["Diagnostic", "Report", "Source", "Span", "parse"]
