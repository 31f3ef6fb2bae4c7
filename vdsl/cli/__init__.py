"""The command line: ``vdsc``. One module per verb; this one only names them.

Importing a verb's module imports no more than that verb needs, so that ``vdsc --help`` and
``vdsc check`` start without numpy, torch or taichi.
"""

from __future__ import annotations

import typer

from .check import check
from .explain import explain

app = typer.Typer(
    name="vdsc",
    help="Turn a written storyboard into ranked moving shots.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)
app.command()(check)
app.command()(explain)


def main() -> None:
    """The ``vdsc`` command."""
    app()
