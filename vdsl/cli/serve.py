"""``vdsc serve``: the storyboard page live, to choose takes in."""

from __future__ import annotations

import socket
from pathlib import Path
from typing import Annotated

import typer

from .check import MACHINE, USAGE, stop

#: Where the page is unless something else is there; then it is one of the next.
PORT, TRIED = 8765, 20


def serve(
    file: Annotated[Path, typer.Argument(help="The storyboard, a .vds file.", show_default=False)],
    out: Annotated[
        Path | None, typer.Option("--out", "-o", help="Where the build is.", show_default="build/NAME")
    ] = None,
    port: Annotated[
        int | None, typer.Option(min=1, max=65535, help="Where to listen.", show_default=f"{PORT} or next")
    ] = None,
    no_open: Annotated[bool, typer.Option("--no-open", help="Open no browser.")] = False,
    watch: Annotated[bool, typer.Option("--watch", help="Compile whenever the script is saved.")] = False,
    device: Annotated[str, typer.Option(help="Where pictures are drawn: auto, cpu, cuda, vulkan.")] = "auto",
) -> None:
    """Show the storyboard page live, on this machine only, and choose takes in it.

    A choice is written to FILE.lock, which compile honours. More takes of a shot are drawn when asked for;
    the page loads itself anew with every build. Ctrl-C ends it.
    """
    if not file.is_file():
        stop(f"there is no file {file}", USAGE)
    build = out or Path("build") / file.stem
    if not watch and not (build / "index.html").is_file():
        stop(f"there is no build at {build}; compile {file} first, or add --watch", USAGE)
    listening = _listen(port)
    from ..pipeline.serving_run import serve_until_stopped  # here: vdsc --help must not wait for a server

    number = listening.getsockname()[1]
    print(f"http://127.0.0.1:{number}/ shows {build}; Ctrl-C ends", flush=True)
    serve_until_stopped(file, build, listening, device, opening=not no_open, watching=watch)


def _listen(port: int | None) -> socket.socket:
    """A listening socket on the loopback address."""
    tried = [port] if port is not None else range(PORT, PORT + TRIED)
    for number in tried:
        listening = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
        listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            listening.bind(("127.0.0.1", number))
            listening.listen()  # now, that nobody else who begins at this moment gets the same port
            return listening
        except OSError as error:
            listening.close()
            why = error.strerror or str(error)
    stop(f"cannot listen on 127.0.0.1:{tried[-1]}: {why}", MACHINE)
