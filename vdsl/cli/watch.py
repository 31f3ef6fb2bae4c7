"""``vdsc watch``: compile a storyboard whenever it is saved."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from time import strftime
from typing import TYPE_CHECKING, Annotated

import typer

from .check import USAGE, stop
from .show import print_report, printable, write_line

if TYPE_CHECKING:
    from ..pipeline.options import Options
    from ..pipeline.progress import Progress
    from ..pipeline.watch import News


def watch(
    file: Annotated[Path, typer.Argument(help="The storyboard, a .vds file.", show_default=False)],
    out: Annotated[
        Path | None, typer.Option("--out", "-o", help="Where to put the build.", show_default="build/NAME")
    ] = None,
    rank: Annotated[
        str | None, typer.Option(help="Who puts the proposals in order.", show_default="discriminator")
    ] = None,
    device: Annotated[
        str | None,
        typer.Option(help="Where pictures are drawn: auto, cpu, cuda, vulkan.", show_default="auto"),
    ] = None,
    edit: Annotated[
        bool | None, typer.Option("--edit", help="Choose takes for the sequence.", show_default=False)
    ] = None,
) -> None:
    """Compile a storyboard now and whenever it is saved: first a draft of what changed, then the films.

    Mistakes are told here, and in the page if it is served; the last good build stays. Ctrl-C ends it.
    """
    if not file.is_file():
        stop(f"there is no file {file}", USAGE)
    # Only now: --help must not wait for numpy and taichi.
    from rich.console import Console

    from ..pipeline.watch import watch as watching
    from .progress import Bars
    from .wishes import options_of

    def wanted() -> Options:
        """Asked for anew with every compilation: ``vds.toml`` may say something else by then."""
        return options_of(file, rank=rank, device=device, edit=edit)

    @contextmanager
    def bars() -> Iterator[Progress]:
        with Bars(Console(stderr=True), transient=True) as shown:
            yield shown

    write_line(printable(f"watching {file}; Ctrl-C ends"), sys.stdout)
    try:
        watching(file, out, wanted, lambda news: _tell(news, file), bars)
    except KeyboardInterrupt:
        write_line("stopped", sys.stdout)


def _tell(news: News, file: Path) -> None:
    if news.report is not None and news.state not in ("draft", "firsts"):
        print_report(news.report, file=str(file))
    if news.state == "error":
        at = "; the last good build stays" if news.revision else ""
        if news.report is None:
            write_line(f"vdsc: {printable(news.message)}", sys.stderr)
        write_line(f"{strftime('%H:%M:%S')}  not compiled{at}", sys.stdout)
    else:
        write_line(printable(f"{strftime('%H:%M:%S')}  {news.message}"), sys.stdout)
    sys.stdout.flush()
