"""``vdsc preview``: a scene as it is placed, before anything is compiled."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..lang.diagnostics import listing, nearest
from .check import USAGE, check_or_exit, stop
from .show import print_report

if TYPE_CHECKING:
    from ..pipeline.script import Checked

_TOP = "top"


def preview(
    file: Annotated[Path, typer.Argument(help="The storyboard, a .vds file.", show_default=False)],
    scene: Annotated[str, typer.Option("--scene", "-s", help="Which scene.", show_default="the first")] = "",
    view: Annotated[
        str, typer.Option("--from", help='"top", or a camera such as "(static wide high-angle)".')
    ] = _TOP,
    out: Annotated[
        Path | None, typer.Option("--out", "-o", help="The PNG to write.", show_default="NAME-SCENE.png")
    ] = None,
    device: Annotated[str, typer.Option(help="Where pictures are drawn: auto, cpu, cuda, vulkan.")] = "auto",
) -> None:
    """Draw a scene as it is placed, with names on people, things and spots."""
    from .failures import failures_told

    checked = check_or_exit(file, "text")
    name = _scene(checked, scene)
    path = out or Path(f"{file.stem}-{name}.png")
    with failures_told(file):
        from ..pipeline.look import look_at
        from ..pipeline.trial import NoTrialError

        try:
            image, warnings = look_at(file, name, None if view == _TOP else view, device)
        except NoTrialError as error:
            stop(str(error), USAGE)
        image.save(path)
        if warnings.diagnostics:
            print_report(warnings, "text", str(file))
    print(path, file=sys.stdout)


def _scene(checked: Checked, wanted: str) -> str:
    names = [scene.name for scene in checked.storyboard.scenes]
    if not names:
        stop("this file has no scene; add one, such as `scene kitchen = apartment.kitchen`", USAGE)
    if not wanted:
        return names[0]
    if wanted not in names:
        meant = nearest(wanted, names)
        hint = f"did you mean `{meant}`?" if meant else f"scenes are {listing(names, last='and')}"
        stop(f"there is no scene `{wanted}`; {hint}", USAGE)
    return wanted
