"""``vdsc stats FILE``: a storyboard counted."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Annotated, Any

import typer

from .check import USAGE, check_or_exit, stop
from .show import count, printable, write_line

_BAR = 24


def stats(
    file: Annotated[Path, typer.Argument(help="The storyboard, a .vds file.", show_default=False)],
    build: Annotated[
        Path | None, typer.Option("--build", "-b", help="The build to count.", show_default="build/NAME")
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="As a document of schema vds.stats/1.")] = False,
) -> None:
    """Count shots by size, angle, movement, scene and character, and how long they last.

    Counts the best takes of the last build where that is of the script as it stands; otherwise the words of
    the script, and how long its lines take to act. Exit code 0 if all is well, 1 if the script has errors.
    """
    checked = check_or_exit(file, "text", quiet_warnings=True)
    from .failures import failures_told

    with failures_told(file):
        from ..pipeline.counts import counts

        document = counts(checked, build or Path("build") / file.stem)
    if build is not None and document["counted"] != "build":
        stop(f"{build} is no build of {file} as it stands; `vdsc compile {file}` makes one", USAGE)
    if as_json:
        write_line(json.dumps(document, indent=1, ensure_ascii=False), sys.stdout)
        return
    for line in _lines(document):
        write_line(printable(line), sys.stdout)


def _lines(document: Mapping[str, Any]) -> Iterator[str]:
    head = f"{count(document['shots'], 'shot')} in {count(len(document['scenes']), 'scene')}"
    yield f"{document['title'] or document['file']}: {head}, {document['seconds']:.1f} s of film"
    if document["counted"] == "script":
        yield "counted from the script; lengths as its lines are acted"
    length = document["length"]
    if length:
        yield f"a shot lasts {length['mean']:.1f} s on average, {length['median']:.1f} s in the middle"
        for name in ("longest", "shortest"):
            shot = length[name]
            yield f"{name:<9} {shot['seconds']:5.1f} s  shot {shot['number']}, {shot['id']}"
    for title, name in (
        ("size", "sizes"),
        ("angle", "angles"),
        ("movement", "movements"),
        ("scene", "scenes"),
    ):
        yield ""
        yield from _table(title, document[name])
    if document["characters"]:
        yield ""
        yield from _people(document["characters"])
    if document["build"]:
        yield ""
        yield _build(document["build"])


def _table(title: str, rows: Mapping[str, Mapping[str, Any]]) -> Iterator[str]:
    """Shots and seconds by word, with bars of the seconds."""
    wide = max([len(title), *map(len, rows)])
    most = max([row["seconds"] for row in rows.values()], default=0.0) or 1.0
    yield f"{title:<{wide}}  shots  seconds"
    for name, row in rows.items():
        bar = "▇" * max(1, round(_BAR * row["seconds"] / most)) if row["seconds"] else ""
        yield f"{name:<{wide}}  {row['shots']:>5}  {row['seconds']:>7.1f}  {bar}".rstrip()


def _people(rows: Mapping[str, Mapping[str, Any]]) -> Iterator[str]:
    wide = max([len("character"), *map(len, rows)])
    seen = any(row["in_picture"] is not None for row in rows.values())
    yield f"{'character':<{wide}}  shots  acts  seconds{'  in picture' if seen else ''}  says  words"
    for name, row in rows.items():
        picture = f"  {row['in_picture']:>10.1f}" if seen else ""
        yield (
            f"{name:<{wide}}  {row['shots']:>5}  {row['acts']:>4}  {row['seconds']:>7.1f}{picture}"
            f"  {row['says']:>4}  {row['words']:>5}"
        )


def _build(row: Mapping[str, Any]) -> str:
    parts = [
        f"{count(row['takes'], 'take')} of {count(row['proposals'], 'proposal')}, judged by {row['judge']}",
        f"{sum(row['rejected'].values())} rejected before",
    ]
    if row["mean_score"] is not None:
        parts.append(f"best takes score {row['mean_score']:.2f} on average")
    if row["without_take"]:
        parts.append(f"{count(row['without_take'], 'shot')} without a take")
    if row["cuts_broken"]:
        parts.append(f"{count(row['cuts_broken'], 'cut')} break a rule")
    return "; ".join(parts)
