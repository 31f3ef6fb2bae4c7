"""``vdsc why FILE SHOT [TAKE]``: why a take ranks where it does, and what the next ones lack."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..lang.diagnostics import listing
from .check import USAGE, check_or_exit, stop
from .naming import shot_ids, shot_named
from .show import count, printable, write_line

if TYPE_CHECKING:
    from ..pipeline.script import Checked
    from ..pipeline.why import ShotFacts


def why(
    file: Annotated[Path, typer.Argument(help="The storyboard, a .vds file.", show_default=False)],
    shot: Annotated[
        str,
        typer.Argument(
            help="Which shot: its id, a part of it, or its number.",
            show_default=False,
            autocompletion=shot_ids,
        ),
    ],
    take: Annotated[
        int | None, typer.Argument(min=1, help="Which take.", show_default="the best, and a word on each")
    ] = None,
    build: Annotated[
        Path | None, typer.Option("--build", "-b", help="The build to explain.", show_default="build/NAME")
    ] = None,
    fresh: Annotated[
        bool, typer.Option("--fresh", help="Propose the shot again in memory, ordered by geometry.")
    ] = False,
    space: Annotated[
        bool, typer.Option("--space", help="Show instead what cameras of the shot are drawn from.")
    ] = False,
    as_json: Annotated[bool, typer.Option("--json", help="As a document of schema vds.why/1.")] = False,
) -> None:
    """Explain why a take ranks where it does, in words and numbers.

    Reads the last build of the storyboard; where there is none, or none with this shot, the shot is proposed
    in memory and put in order by its geometry. Exit code 0 if all is well, 1 if the storyboard has errors.
    """
    checked = check_or_exit(file, "text", quiet_warnings=True)
    wanted = shot_named(checked, shot)
    if space:
        _show_space(checked, wanted, as_json)
        return
    facts = _facts(checked, wanted, file, build, fresh)
    if take is not None and take > len(facts.takes):
        has = count(len(facts.takes), "take") if facts.takes else "no take"
        stop(f"the shot {wanted} has {has}", USAGE)
    from ..pipeline.why import explanation

    document = explanation(facts)
    if take is not None:
        document["takes"] = [t for t in document["takes"] if t["rank"] == take]
    text = json.dumps(document, indent=1) if as_json else "\n".join(_lines(document, take))
    for line in text.split("\n"):
        write_line(printable(line), sys.stdout)


def _facts(checked: Checked, wanted: str, file: Path, build: Path | None, fresh: bool) -> ShotFacts:
    from ..pipeline.why import NoBuildError, facts_of_build
    from .failures import failures_told

    if build is not None and fresh:
        stop("--fresh proposes anew and reads no build: give --fresh or --build, not both", USAGE)
    folder = build or Path("build") / file.stem
    if build is not None and not (folder / "storyboard.json").is_file():
        stop(f"there is no build at {folder}; `vdsc compile {file}` makes one", USAGE)
    if not fresh and (folder / "storyboard.json").is_file():
        try:
            facts = facts_of_build(folder, checked.storyboard, wanted)
        except NoBuildError as error:
            if build is not None:
                stop(str(error), USAGE)
            facts = None
        if facts is not None:
            return facts
        if build is not None:
            stop(f"the build at {folder} has no shot {wanted}; compile the storyboard again", USAGE)
    with failures_told(file):
        from ..pipeline.audition import facts_in_memory

        return facts_in_memory(checked, wanted)


def _show_space(checked: Checked, wanted: str, as_json: bool) -> None:
    """What is fixed and what is free, for every style the shot may have."""
    from ..cinema.subspaces import subspace
    from ..propose.subjects import films_place

    board = checked.storyboard
    line, shot = next((line, s) for line in board.lines for s in line.shots if s.id == wanted)
    place = films_place(shot, bool(line.beats))
    styles = [(m, s, a) for m in shot.movements for s in shot.scales for a in shot.angles]
    spaces = [(" ".join(x), subspace(*x, shot.lens, shot.ease, board.rig, shot.view, place)) for x in styles]
    if as_json:
        entries = [
            {
                "style": words,
                "fixed": dict(found.fixed),
                "free": [
                    {"symbol": v.symbol, "name": v.name, "unit": v.unit, "grid": list(v.grid)}
                    | ({} if v.grid else {"low": v.low, "high": v.high})
                    for v in found.free
                ],
            }
            for words, found in spaces
        ]
        document = {"schema": "vds.space/1", "shot": wanted, "proposals": shot.proposals, "spaces": entries}
        write_line(json.dumps(document, indent=1, ensure_ascii=False), sys.stdout)
        return
    for words, found in spaces:
        write_line(f"{words}: {shot.proposals if len(spaces) == 1 else 'some'} proposals of", sys.stdout)
        for symbol, held in found.fixed:
            write_line(f"  {symbol:<8} fixed: {held}", sys.stdout)
        for variable in found.free:
            write_line(f"  {variable.symbol:<8} {variable}, {variable.name}", sys.stdout)


# --- as text ----------------------------------------------------------------------------------


def _lines(document: dict[str, Any], take: int | None) -> Iterable[str]:
    yield f"{document['shot']}  (line {document['line']}: {document['text']})"
    asked = " ".join("|".join(w) if len(w) <= 3 else "*" for w in document["asked"].values())
    yield f"asked: {asked}; {count(document['proposals'], 'proposal')} judged"
    if document["origin"] == "memory":
        yield "proposed just now and ordered by geometry; nothing was drawn"
    elif document["stale"]:
        yield "the script has changed since this build; --fresh proposes the shot as it is now"
    if document["placed"]:
        yield document["placed"]
    for number, told in enumerate(document["takes"]):
        if number == 0:
            yield from _take(told, document["judge"], document["asked"])
        else:
            yield f"take {told['rank']} ({told['score']:.3f}) {told['sentence']}"
    if not document["takes"]:
        yield "no take: every proposal was rejected"
    yield ""
    if document["advice"]:
        instead = listing(f"`{words}`" for words in document["advice"]["instead"])
        faulty = document["advice"].get("faulty")
        said = "no take is without a fault" if faulty else "no camera does quite what the line says"
        yield f"{said}: {document['advice']['why']}" + (f"; try {instead}" if instead else "")
    if document["rejected"]:
        reasons = (f"{n} {why.replace('_', ' ')}" for why, n in document["rejected"].items())
        yield f"rejected before judging: {', '.join(reasons)}"
    else:
        yield "rejected before judging: none"


def _take(told: dict[str, Any], judge: str, asked: dict[str, list[str]]) -> Iterable[str]:
    """All of one take."""
    yield ""
    yield f"take {told['rank']} ({told['score']:.3f}) {told['sentence']}"
    yield ""
    for word, meant in told["camera"].items():
        line = f"  {word:<9} {meant}"
        if told["achieved"] is not None:
            line += f", came out as {told['achieved'][word]}"
            line += "" if told["kept"][word] else "  (!)"
        if len(asked[word]) > 1:
            line += f"; {listing(asked[word], 4)} was asked"
        yield line
    yield ""
    for name, m in told["measures"].items():
        mark = " " if m["fine"] else "!"
        shown = f"{round(m['value'], 3) + 0.0:.3f}".replace("-", "−")
        yield f"{mark} {name.replace('_', ' '):<18} {shown:>9} {m['unit']:<13} {m['good']}"
    yield ""
    for t in told["terms"]:
        yield f"  {t['part'].replace('_', ' '):<18} {t['value']:9.3f} × {t['weight']:.2f} = {t['points']:.3f}"
    for name, left in told["penalties"].items():
        if left < 0.9995:
            yield f"  {name.replace('_', ' '):<18} × {left:.3f}"
    yield f"  {'geometry score':<18} {told['geometry']:9.3f}"
    if judge == "ranker" and told["logit"] is not None:
        taste = f", {told['taste']:+.2f} from your choices" if told["taste"] else ""
        geometry = f"{told['prior']:+.2f} from the geometry"
        yield f"  log odds: {told['logit']:.2f} from the pictures, {geometry}{taste}"
    yield ""
