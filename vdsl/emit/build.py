"""Everything around the takes: one call writes the rest of a build into its staged folder."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from runtime.worker import Worker

from .page import write_page
from .plan import write_plans
from .sheet import write_sheets
from .storyboard_json import write_storyboard
from .track_json import write_tracks
from .types import Build
from .video import WritePart, write_animatic, write_part

#: Sheets that may wait to be written.
_PAGES_WAITING = 2


def write_build(
    folder: Path,
    build: Build,
    part_to: WritePart = write_part,
    films: Callable[[], object] = lambda: None,
) -> None:
    """Write tracks, sheet, plans, page, ``storyboard.json`` and animatic beside the takes in ``folder``.

    part_to: writes those parts of the animatic that are encoded again, or has them from where they were kept
    films: waits until the takes' films are there, which are needed only at the end
    ``report.json`` is written last by whoever measured the run (:mod:`vdsl.emit.report_json`).
    """
    with Worker(_PAGES_WAITING) as worker:  # sheets are large, and are pressed meanwhile
        write_sheets(folder, build, worker)
        write_tracks(folder, build)
        write_plans(folder, build)
        write_page(folder / "index.html", build)
        write_storyboard(folder / "storyboard.json", build)
        worker.wait()
    films()
    write_animatic(folder / "animatic.mp4", build, part_to)
