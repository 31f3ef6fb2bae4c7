"""``vdsc clean``: remove builds of the storyboards here, and with ``--all`` what earlier runs kept."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Annotated

import typer

from .check import MACHINE, stop
from .show import printable, write_line

SCHEMA = "vds.clean/1"


def clean(
    folder: Annotated[
        Path, typer.Argument(help="The folder that builds are in.", show_default="build")
    ] = Path("build"),
    everything: Annotated[
        bool, typer.Option("--all", help="Remove the results kept from earlier runs as well.")
    ] = False,
    as_json: Annotated[bool, typer.Option("--json", help="As a document of schema vds.clean/1.")] = False,
) -> None:
    """Remove builds, and say what that freed.

    Only folders that are builds are removed, and only files of theirs: what else is in them stays.
    Storyboards, locks and choices are never touched.
    """
    from ..emit.folder import builds_in, remove_build
    from ..pipeline.cache import cleared, results_folder

    gone: list[tuple[Path, int]] = []
    try:
        for place in builds_in(folder):
            gone.append((place, remove_build(place)))
        if everything:
            gone.append((results_folder(), cleared()))
        if folder.is_dir() and not any(folder.iterdir()):
            folder.rmdir()
    except OSError as error:
        stop(f"cannot remove {error.filename or folder}: {error.strerror or error}", MACHINE)
    freed = sum(size for _, size in gone)
    if as_json:
        removed = [{"path": str(place), "bytes": size} for place, size in gone]
        write_line(json.dumps({"schema": SCHEMA, "removed": removed, "bytes": freed}, indent=1), sys.stdout)
        return
    for place, size in gone:
        write_line(printable(f"{_size(size):>9}  {place}"), sys.stdout)
    write_line(
        f"{_size(freed)} freed" if gone else f"there is no build in {printable(str(folder))}", sys.stdout
    )


def _size(count: float) -> str:
    for unit in ("B", "KiB", "MiB"):
        if count < 1024:
            return f"{count:.0f} {unit}" if unit == "B" else f"{count:.1f} {unit}"
        count /= 1024
    return f"{count:.1f} GiB"
