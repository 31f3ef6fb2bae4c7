"""``vdsc compile``: a storyboard into videos, a contact sheet and a page."""

from __future__ import annotations

from enum import Enum
from pathlib import Path
from typing import Annotated, Any

import typer

from ..emit.guides import Guides, guides_of
from ..lang import Settings
from .check import USAGE, Format, check_or_exit, stop
from .naming import shot_ids, shot_named


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


class Show(str, Enum):
    """How posters are shown in the terminal."""

    auto = "auto"
    blocks = "blocks"
    none = "none"


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
    rank: Annotated[
        Judge | None, typer.Option(help="Who puts the proposals in order.", show_default="discriminator")
    ] = None,
    weights: Annotated[
        Path | None, typer.Option(help="Weights of the discriminator.", show_default="the shipped ones")
    ] = None,
    device: Annotated[
        Device | None, typer.Option(help="Where pictures are drawn.", show_default="auto")
    ] = None,
    burn_in: Annotated[
        bool | None,
        typer.Option(
            "--burn-in",
            help="Write shot, take, timecode, lens and movement on every frame.",
            show_default=False,
        ),
    ] = None,
    guides: Annotated[
        str, typer.Option(help="Draw over every frame: safe,thirds,cross, and a mask such as 2.39.")
    ] = "",
    arrows: Annotated[
        bool | None,
        typer.Option("--arrows/--no-arrows", help="Show on the sheet what moves.", show_default="arrows"),
    ] = None,
    shutter: Annotated[
        float | None,
        typer.Option(
            min=0,
            max=360,
            help="Motion blur of films: the shutter angle in degrees, 180 as in most films, 0 for none.",
            show_default="0",
        ),
    ] = None,
    edit: Annotated[
        bool | None,
        typer.Option(
            "--edit",
            help="Choose takes for the sequence, so that cuts keep to the rules.",
            show_default=False,
        ),
    ] = None,
    more: Annotated[
        list[str] | None,
        typer.Option(
            help="Draw further takes of this shot, and go on with the build as it was made.",
            metavar="SHOT",
            show_default=False,
            autocompletion=shot_ids,
        ),
    ] = None,
    cache: Annotated[
        bool, typer.Option("--cache/--no-cache", help="Take shots that did not change from earlier runs.")
    ] = True,
    show: Annotated[
        Show, typer.Option(help="Posters at the end: pictures where the terminal can, blocks, or none.")
    ] = Show.auto,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print what was made as a document of schema vds.compile/1.")
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
    drawn = _guides(guides)
    # The cheap check first: a script with errors is told so before anything heavy is loaded.
    checked = check_or_exit(file, format.value, settings, quiet_warnings=True)
    if not file.is_file():  # a pipe is empty by now, and the check was only the first reading
        stop(f"{file} is no ordinary file; save the storyboard first", USAGE)
    how: dict[str, Any] = {
        "further": tuple(shot_named(checked, shot) for shot in more or ()) or None,
        "settings": settings,
        "rank": rank.value if rank else None,
        "weights": weights,
        "device": device.value if device else None,
        "burn_in": burn_in,
        "shutter": shutter,
        "edit": edit,
        "arrows": arrows,
        "guides": drawn,
        "cache": cache,
    }
    if more:
        how = _as_made(out or Path("build") / file.stem, how)
    _run(file, out, how, format.value, show.value, as_json)


def _run(file: Path, out: Path | None, how: dict[str, Any], format: str, show: str, as_json: bool) -> None:
    # Only now: --help and scripts with errors must not wait for numpy, torch and taichi.
    from rich.console import Console

    from ..pipeline.compile import compile_file
    from .failures import failures_told
    from .outcome import print_document, print_outcome
    from .progress import Bars
    from .wishes import options_of

    console = Console(stderr=True)
    with failures_told(file, format):
        options = options_of(file, **how)
        with Bars(console) as bars:
            result = compile_file(file, out, options, bars)
    if as_json:
        print_document(result, file)
    else:
        print_outcome(result, format, file, show)


def _as_made(build: Path, how: dict[str, Any]) -> dict[str, Any]:
    """What was said, and what was not as it was said for the build that is there."""
    from ..pipeline.options import made_by

    made = made_by(build)
    if not (build / "storyboard.json").is_file():
        stop(f"there is no build at {build} to go on with; compile without --more first", USAGE)
    made_settings: Settings = made.pop("settings", Settings())
    how["settings"].complete(made_settings)
    how["guides"] = how["guides"] or made.pop("guides", how["guides"])
    return made | {name: value for name, value in how.items() if value is not None}


def _guides(text: str) -> Guides:
    try:
        return guides_of(text)
    except ValueError as error:
        raise typer.BadParameter(str(error), param_hint="--guides") from None


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
