"""What ``vdsc compile`` says at the end: what was made, and why so, how long it took, where to look."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table

from ..cinema.measures import MEASURES
from ..emit.reasons import TakeFacts, sentence
from ..emit.types import Build, BuiltShot, BuiltTake
from ..emit.video import take_paths
from ..emit.words import camera_words
from ..pipeline.compile import Result
from ..pipeline.findings import finding
from .posters import shown_posters
from .show import as_json, count, print_report, printable, write_line

SCHEMA = "vds.compile/1"


def print_outcome(result: Result, format: str, file: Path, show: str = "auto") -> None:
    """Warnings, a line a shot, and the files to open. As JSON: the warnings alone.

    show: ``auto`` shows posters where the terminal can show pictures, ``blocks`` anywhere, ``none`` nowhere
    """
    if format == "json":
        print(as_json(result.warnings, str(file)))
        return
    print_report(result.warnings)
    console = Console()
    shown_posters(_posters(result), console, show)
    if console.is_terminal:
        console.print(_table(result))
    shots, frames = result.build.shots, sum(s.frames for s in result.build.shots)
    num, den = result.build.storyboard.fps
    takes = sum(len(s.takes) for s in shots)
    film = f"{frames * den / num:.1f} s of film in {result.report.seconds:.0f} s"
    write_line(f"{count(len(shots), 'shot')}, {count(takes, 'take')}, {film}", sys.stdout)
    for text in (*_further(result), *_cutting(result.build)):
        write_line(printable(text), sys.stdout)
    for name in ("index.html", "animatic.mp4", "sheet.png"):
        if (result.folder / name).exists():
            write_line(printable(str(result.folder / name)), sys.stdout)


def print_document(result: Result, file: Path) -> None:
    """What was made, as a document of schema ``vds.compile/1``."""
    document = {
        "schema": SCHEMA,
        "file": str(file),
        "folder": str(result.folder),
        "seconds": round(result.report.seconds, 3),
        "cache": {"hits": result.report.cache_hits, "misses": result.report.cache_misses},
        "shots": [_entry(built) for built in result.build.shots],
        "warnings": [finding(d) for d in result.warnings.diagnostics],
    }
    write_line(json.dumps(document, ensure_ascii=False, indent=1), sys.stdout)


def _entry(built: BuiltShot) -> dict[str, Any]:
    best = built.takes[0] if built.takes else None
    return {
        "id": built.shot.id,
        "line": built.shot.line,
        "takes": len(built.takes),
        "best": best.key if best else None,
        "camera": camera_words(built) if best else None,
        "score": round(best.score, 6) if best else None,
        "chosen": bool(best and best.chosen),
        "why": _why(built),
    }


def _why(built: BuiltShot) -> str:
    """Why a shot is shown as it is, in words."""
    if not built.takes:
        return "no camera could film it"
    if built.takes[0].chosen:
        return "chosen"
    return sentence([_facts(take) for take in built.takes], 0).removeprefix("ranks first: ")


def _facts(take: BuiltTake) -> TakeFacts:
    camera = take.camera
    words = {"movement": camera.movement, "scale": camera.scale, "angle": camera.angle}
    measures = {name: 0.0 for name in MEASURES} | camera.measures
    return TakeFacts(take.rank, take.score, words, None, measures, camera.params, take.logit, take.taste)


def _further(result: Result) -> list[str]:
    """Of the shots of which further takes were asked for, how many there are now."""
    lines = []
    for shot, wanted in result.further.items():
        built = next(s for s in result.build.shots if s.shot.id == shot)
        less = len(built.takes) < wanted
        why = f"; no other of its {built.proposals} proposals looks different" if less else ""
        lines.append(f"{shot}: {count(len(built.takes), 'take')} now{why}")
    return lines


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


def _posters(result: Result) -> list[tuple[str, Path]]:
    shots = (s.shot.id for s in result.build.shots if s.takes)
    return [(name, take_paths(result.folder, name, 1)[1]) for name in shots]


def _table(result: Result) -> Table:
    table = Table(box=None, pad_edge=False)
    for title, justify in (
        ("line", "right"), ("shot", "left"), ("take", "left"), ("score", "right"), ("why", "left"),
    ):  # fmt: skip
        last = title == "why"
        table.add_column(title, justify=justify, no_wrap=last, overflow="ellipsis")  # type: ignore[arg-type]
    for built in result.build.shots:
        best = f"{built.takes[0].score:.2f}" if built.takes else "–"
        table.add_row(
            str(built.shot.line),
            printable(built.shot.id),
            camera_words(built) if built.takes else "none",
            best,
            printable(_why(built).partition("; ")[0]),
        )
    return table
