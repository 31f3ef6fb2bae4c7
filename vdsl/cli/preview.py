"""``vdsc preview``: a scene as it is placed, before anything is compiled."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..lang.diagnostics import listing, nearest
from .check import USAGE, check_or_exit, stop
from .naming import shot_ids, shot_named
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
    plan: Annotated[
        bool, typer.Option("--plan", help="Draw a plan: walls, people's ways and the cameras of all shots.")
    ] = False,
    shot: Annotated[
        str,
        typer.Option(
            help="With --plan, of one shot: its id, a part of it, or its number.",
            show_default=False,
            autocompletion=shot_ids,
        ),
    ] = "",
    out: Annotated[
        Path | None,
        typer.Option(
            "--out", "-o", help="The PNG to write; of a plan also SVG.", show_default="NAME-SCENE.png"
        ),
    ] = None,
    device: Annotated[str, typer.Option(help="Where pictures are drawn: auto, cpu, cuda, vulkan.")] = "auto",
) -> None:
    """Draw a scene as it is placed, with names on people, things and spots; or its plan."""
    from .failures import failures_told

    if shot and not plan:
        stop("--shot is for a plan: add --plan", USAGE)
    if plan and view != _TOP:
        stop("a plan is seen from above: give --plan or --from, not both", USAGE)
    checked = check_or_exit(file, "text")
    if plan:
        _draw_plan(checked, file, scene, shot, out)
        return
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


def _draw_plan(checked: Checked, file: Path, scene: str, shot: str, out: Path | None) -> None:
    """Write a plan of a scene or of a shot, and print where."""
    from .failures import failures_told

    wanted = shot_named(checked, shot) if shot else ""
    lines = checked.storyboard.lines
    inside = next((line.scene for line in lines if any(s.id == wanted for s in line.shots)), None)
    name = checked.storyboard.scenes[inside].name if inside is not None else _scene(checked, scene)
    path = out or Path(f"{file.stem}-{wanted or name}-plan.png")
    if path.suffix.lower() not in (".png", ".svg"):
        stop(f"a plan is written as .png or .svg, not as {path.name}", USAGE)
    if not wanted and not any(checked.storyboard.scenes[line.scene].name == name for line in lines):
        stop(f"nothing happens in scene {name}, so that there is no camera to show", USAGE)
    with failures_told(file):
        from ..emit.folder import write_text
        from ..emit.plan import plan_picture, plan_svg, write_plan_picture
        from ..pipeline.plans import plan_before

        found = plan_before(checked, name, wanted)
        if path.suffix.lower() == ".svg":
            write_text(path, plan_svg(found))
        else:
            write_plan_picture(path, plan_picture(found))
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
