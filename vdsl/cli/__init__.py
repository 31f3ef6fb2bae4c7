"""The command line: ``vdsc``. One module per verb; this one only names them.

Importing a verb's module imports no more than that verb needs, so that ``vdsc --help`` and
``vdsc check`` start without numpy, torch or taichi.
"""

from __future__ import annotations

from typing import Annotated

import typer

from .assets import assets
from .bench import bench
from .check import check
from .clean import clean
from .compile import compile_command
from .dataset import dataset
from .diff import diff
from .ends import ends_told
from .evaluate import evaluate
from .explain import explain
from .new import new
from .pick import pick
from .preview import preview
from .serve import serve
from .stats import stats
from .train import train
from .watch import watch
from .why import why

app = typer.Typer(
    name="vdsc",
    help="Turn a written storyboard into ranked moving shots.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
)
app.command("compile")(compile_command)
app.command()(check)
app.command()(explain)
app.command()(assets)
app.command()(preview)
app.command()(why)
app.command()(diff)
app.command()(stats)
app.command()(pick)
app.command()(watch)
app.command()(new)
app.command()(clean)
app.command()(serve)
app.command()(dataset)
app.command()(train)
app.command()(evaluate)
app.command()(bench)


def _version(wanted: bool) -> None:
    if wanted:
        from .. import __version__

        print(f"vdsc {__version__}")
        raise typer.Exit


@app.callback()
def _common(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version.")
    ] = False,
) -> None:
    """Turn a written storyboard into ranked moving shots."""


def main() -> None:
    """The ``vdsc`` command: :data:`app`, ending with a clear code however it is stopped."""
    with ends_told():
        app()
