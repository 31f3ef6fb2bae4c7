"""``vdsc compile``: a storyboard into videos, a contact sheet and a page."""

from __future__ import annotations

from enum import Enum
from pathlib import Path
from typing import Annotated

import typer

from ..lang import Settings
from .check import USAGE, Format, check_or_exit, stop


class Device(str, Enum):
    """Where pictures are drawn."""

    auto = "auto"
    cpu = "cpu"
    cuda = "cuda"
    vulkan = "vulkan"


class Judge(str, Enum):
    """Who puts the proposals in order."""

    discriminator = "discriminator"
    geometry = "geometry"


class Rig(str, Enum):
    """How camera words become positions."""

    cinema = "cinema"
    paper = "paper"


def compile_command(
    file: Annotated[Path, typer.Argument(help="The storyboard, a .vds file.", show_default=False)],
    out: Annotated[
        Path | None, typer.Option("--out", "-o", help="Where to put the build.", show_default="build/NAME")
    ] = None,
    proposals: Annotated[
        int | None, typer.Option(min=1, max=2000, help="Proposals a shot.", show_default="80")
    ] = None,
    takes: Annotated[
        int | None, typer.Option(min=1, max=40, help="Takes kept a shot.", show_default="5")
    ] = None,
    seed: Annotated[
        int | None, typer.Option(min=0, help="Another seed, other proposals.", show_default="0")
    ] = None,
    size: Annotated[
        str | None, typer.Option(help="Picture size, as 1920x1080.", show_default="1280x720")
    ] = None,
    rig: Annotated[
        Rig | None, typer.Option(help="How camera words become positions.", show_default="cinema")
    ] = None,
    rank: Annotated[Judge, typer.Option(help="Who puts the proposals in order.")] = Judge.discriminator,
    weights: Annotated[
        Path | None, typer.Option(help="Weights of the discriminator.", show_default="the shipped ones")
    ] = None,
    device: Annotated[Device, typer.Option(help="Where pictures are drawn.")] = Device.auto,
    burn_in: Annotated[
        bool, typer.Option("--burn-in", help="Write shot, take, timecode, lens and movement on every frame.")
    ] = False,
    edit: Annotated[
        bool, typer.Option("--edit", help="Choose takes for the sequence, so that cuts keep to the rules.")
    ] = False,
    format: Annotated[Format, typer.Option(help="How to print what is found wrong.")] = Format.text,
) -> None:
    """Turn a storyboard into ranked moving shots.

    Writes index.html (the storyboard page), animatic.mp4, sheet.png and every take into build/NAME.
    Exit code 0 if all is well, 1 if the storyboard has errors, 3 if the machine failed.
    """
    settings = Settings(
        proposals=proposals,
        takes=takes,
        seed=seed,
        size=_size(size),
        rig=rig.value if rig else None,
    )
    # The cheap check first: a script with errors is told so before anything heavy is loaded.
    check_or_exit(file, format.value, settings, quiet_warnings=True)
    if not file.is_file():  # a pipe is empty by now, and the check was only the first reading
        stop(f"{file} is no ordinary file; save the storyboard first", USAGE)
    _run(file, out, settings, rank.value, weights, device.value, burn_in, edit, format.value)


def _run(
    file: Path,
    out: Path | None,
    settings: Settings,
    rank: str,
    weights: Path | None,
    device: str,
    burn_in: bool,
    edit: bool,
    format: str,
) -> None:
    # Only now: --help and scripts with errors must not wait for numpy, torch and taichi.
    from rich.console import Console

    from ..pipeline.compile import compile_file
    from ..pipeline.options import Options
    from .failures import failures_told
    from .outcome import print_outcome
    from .progress import Bars

    options = Options(settings, device, rank, weights, burn_in, edit)
    console = Console(stderr=True)
    with failures_told(file, format), Bars(console) as bars:
        result = compile_file(file, out, options, bars)
    print_outcome(result, format, file)


def _size(text: str | None) -> tuple[int, int] | None:
    if text is None:
        return None
    width, cross, height = text.lower().replace("×", "x").partition("x")
    if not (cross and width.isdecimal() and height.isdecimal()):
        raise typer.BadParameter(f"{text!r} is no picture size; write it as 1280x720", param_hint="--size")
    w, h = int(width), int(height)
    if w % 2 or h % 2 or not (16 <= w <= 7680 and 16 <= h <= 7680):
        raise typer.BadParameter(
            f"{text!r}: both sides must be even and between 16 and 7680", param_hint="--size"
        )
    return w, h
