"""The command line: ``vdsc``. One module per verb; this one only names them.

Importing a verb's module imports no more than that verb needs, so that ``vdsc --help`` and
``vdsc check`` start without numpy, torch or taichi.
"""

from __future__ import annotations

import typer

from .bench import bench
from .check import check
from .compile import compile_command
from .explain import explain

app = typer.Typer(
    name="vdsc",
    help="Turn a written storyboard into ranked moving shots.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)
app.command("compile")(compile_command)
app.command()(check)
app.command()(explain)
app.command()(bench)


def main() -> None:
    """The ``vdsc`` command."""
    app()
