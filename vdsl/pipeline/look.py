"""A scene of a script as it is placed, looked at from above or by a camera of the language."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from PIL import Image

from ..lang import Report, Source, read_source
from .compile import Act, stage_acts
from .preview import Studio, at_rest
from .script import Checked, ScriptError, check_source


def look_at(path: Path, scene: str, camera: str | None, device: str = "auto") -> tuple[Image.Image, Report]:
    """The scene before its first line, from above or by a camera such as ``(static wide high-angle)``.

    Returns the picture and the warnings. Raises ScriptError for a script or a camera with errors,
    :class:`~vdsl.pipeline.trial.NoTrialError` where no camera can film it.
    """
    checked = _with_a_look(path, scene, camera or "(static wide)")
    act = _opening(checked)
    studio = Studio(checked.catalog, device, checked.storyboard.style)
    if camera is not None:
        return studio.shot(act, checked.storyboard.size), checked.report
    room = checked.storyboard.scenes[act.line.scene].room
    return studio.plan(act.staged, at_rest(act), 1280, room), checked.report


def _with_a_look(path: Path, scene: str, camera: str) -> Checked:
    """The script with one more line: a camera on the scene."""
    report = Report()
    source = read_source(path, report)
    if source is None:
        raise ScriptError(report)
    camera = camera if camera.lstrip().startswith("(") else f"({camera})"
    return check_source(
        Source(source.name, f"{source.text}\n\nscene {scene}\n\n/ {camera} proposals 16\n"), report
    )


def _opening(checked: Checked) -> Act:
    """The added line, in the state the scene opens with."""
    acts = stage_acts(checked)
    look = acts[-1]
    first = next(a for a in acts if a.line.scene == look.line.scene)
    return replace(look, state=first.state)
