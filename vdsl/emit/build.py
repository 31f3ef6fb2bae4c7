"""Everything around the takes: one call writes the rest of a build into its staged folder."""

from __future__ import annotations

from pathlib import Path

from .page import write_page
from .sheet import write_sheets
from .storyboard_json import write_storyboard
from .track_json import write_tracks
from .types import Build
from .video import write_animatic


def write_build(folder: Path, build: Build) -> None:
    """Write tracks, animatic, sheet, ``storyboard.json`` and page beside the takes already in ``folder``.

    ``report.json`` is written last by whoever measured the run (:mod:`vdsl.emit.report_json`).
    """
    write_tracks(folder, build)
    write_animatic(folder / "animatic.mp4", build)
    write_sheets(folder, build)
    write_page(folder / "index.html", build)
    write_storyboard(folder / "storyboard.json", build)
