"""What ``vdsc compile`` says at the end: what was made, how long it took, where to look."""

from __future__ import annotations

import sys
from pathlib import Path

from rich.console import Console
from rich.table import Table

from ..emit.types import Build
from ..emit.words import camera_words
from ..pipeline.compile import Result
from .show import as_json, count, print_report, printable, write_line


def print_outcome(result: Result, format: str, file: Path) -> None:
    """Warnings, a line a shot, and the files to open. As JSON: the warnings alone."""
    if format == "json":
        print(as_json(result.warnings, str(file)))
        return
    print_report(result.warnings)
    console = Console()
    if console.is_terminal:
        console.print(_table(result))
    shots, frames = result.build.shots, sum(s.frames for s in result.build.shots)
    num, den = result.build.storyboard.fps
    takes = sum(len(s.takes) for s in shots)
    film = f"{frames * den / num:.1f} s of film in {result.report.seconds:.0f} s"
    made = f"{count(len(shots), 'shot')}, {count(takes, 'take')}, {film}"
    write_line(made, sys.stdout)
    for text in _cutting(result.build):
        write_line(printable(text), sys.stdout)
    for name in ("index.html", "animatic.mp4", "sheet.png"):
        if (result.folder / name).exists():
            write_line(printable(str(result.folder / name)), sys.stdout)


def _cutting(build: Build) -> list[str]:
    """What the edit traded, and how many rules the cuts break."""
    hints = sum(c.finding.severity == "hint" for c in build.continuity)
    faults = len(build.continuity) - hints
    counts = [count(n, word) for n, word in ((faults, "continuity fault"), (hints, "continuity hint")) if n]
    lines = [trade.text for trade in build.trades]
    if counts:
        more = "" if build.edited else "; --edit chooses takes that cut together"
        at = count(len({c.cut for c in build.continuity}), "cut")
        lines.append(f"{' and '.join(counts)} at {at}{more}")
    return lines


def _table(result: Result) -> Table:
    table = Table(box=None, pad_edge=False)
    for title, justify in (("shot", "left"), ("camera", "left"), ("proposals", "right"), ("best", "right")):
        table.add_column(title, justify=justify)  # type: ignore[arg-type]
    for built in result.build.shots:
        best = f"{built.takes[0].score:.2f}" if built.takes else "–"
        table.add_row(
            printable(built.shot.id),
            camera_words(built) if built.takes else "none",
            str(built.proposals),
            best,
        )
    return table
