"""``vdsc pick FILE SHOT TAKE``: choose the take a shot is shown by, and keep the choice beside the script."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from .check import USAGE, WRONG, check_or_exit, stop
from .naming import shot_ids, shot_named
from .show import count, print_report, printable, write_line

if TYPE_CHECKING:
    from ..pipeline.lock import Lock

SCHEMA = "vds.choices/1"


def pick(
    file: Annotated[Path, typer.Argument(help="The storyboard, a .vds file.", show_default=False)],
    shot: Annotated[
        str | None,
        typer.Argument(
            help="Which shot: its id, a part of it, or its number.",
            show_default="list the choices",
            autocompletion=shot_ids,
        ),
    ] = None,
    take: Annotated[
        str | None,
        typer.Argument(help="Which take: its number in the build, or its key.", show_default=False),
    ] = None,
    build: Annotated[
        Path | None,
        typer.Option("--build", "-b", help="The build to choose from.", show_default="build/NAME"),
    ] = None,
    clear: Annotated[
        bool, typer.Option("--clear", help="Take the choice of the shot back; without a shot, all of them.")
    ] = False,
    as_json: Annotated[bool, typer.Option("--json", help="As a document of schema vds.choices/1.")] = False,
) -> None:
    """Choose the take a shot is shown by; without a shot, list what is chosen.

    Writes FILE.lock beside the storyboard, and nothing else; the next compile shows the chosen take first.
    Exit code 0 if all is well, 1 if storyboard or lock have errors, 2 where there is no such shot or take.
    """
    # Only now: --help must not wait for them.
    from ..pipeline import lock as locks
    from ..pipeline.script import ScriptError

    if clear and take is not None:
        stop("--clear takes a choice back: name no take with it", USAGE)
    try:
        if clear:
            folder = build or Path("build") / file.stem
            bad = locks.bad_path(file)
            gone = locks.clear(file, _chosen_shot(file, shot) if shot is not None else None, folder)
            if not as_json:
                told = f"{count(len(gone), 'choice')} taken back"
                if bad.exists():
                    told = f"the lock did not read; it is put aside as {bad}, and nothing is chosen now"
                write_line(printable(told), sys.stdout)
                return
        elif shot is not None:
            if take is None:
                stop(f"name a take of {shot} as well: its number in the build, or its key", USAGE)
            wanted = shot_named(check_or_exit(file, quiet_warnings=True), shot)
            folder = build or Path("build") / file.stem
            made = locks.choose(file, wanted, int(take) if take.isdecimal() else take, folder)
            if not as_json:
                told = f"{wanted}: {made.words} ({made.key}), kept in {locks.lock_path(file)}"
                write_line(printable(told), sys.stdout)
                return
        lock = locks.read_lock(locks.lock_path(file))
    except ScriptError as error:
        print_report(error.report, file=str(file))
        raise typer.Exit(WRONG) from None
    except locks.ChoiceError as error:
        stop(str(error), USAGE)
    _list(lock, file, as_json)


def _chosen_shot(file: Path, shot: str) -> str:
    """A shot of the script, or one that only the lock still knows."""
    from ..pipeline.lock import lock_path, read_lock

    if read_lock(lock_path(file)).choice(shot) is not None:
        return shot
    return shot_named(check_or_exit(file, quiet_warnings=True), shot)


def _list(lock: Lock, file: Path, as_json: bool) -> None:
    if as_json:
        document = {
            "schema": SCHEMA,
            "file": str(file),
            "seed": lock.seed,
            "versions": dict(lock.versions),
            "choices": [
                {"shot": c.shot, "take": c.key, "words": c.words, "proposals": c.proposals, "seed": c.seed}
                for c in lock.choices
            ],
        }
        write_line(json.dumps(document, ensure_ascii=False, indent=1), sys.stdout)
        return
    if not lock.choices:
        write_line("nothing is chosen; `vdsc pick FILE SHOT TAKE` chooses", sys.stdout)
        return
    wide, lost = max(len(c.shot) for c in lock.choices), _lost(lock, file)
    for c in lock.choices:
        write_line(printable(f"{c.shot:<{wide}}  {c.key:<13}  {c.words}{lost.get(c.shot, '')}"), sys.stdout)


def _lost(lock: Lock, file: Path) -> dict[str, str]:
    """What to say of choices, by their shots' ids, that the script as it is now has no shot or line for."""
    from ..pipeline.depends import shot_digests
    from ..pipeline.placing import placed
    from ..pipeline.project import project_of
    from ..pipeline.script import ScriptError, load_storyboard

    try:
        checked = load_storyboard(file, None, project_of(file).settings)
    except (ScriptError, OSError, MemoryError):
        return {}  # of a script that does not read nothing is known
    depends = shot_digests(checked.storyboard, checked.catalog)
    now = {choice.shot: shot for shot, choice in placed(lock.choices, depends).items()}
    said = {}
    for choice in lock.choices:
        if choice.shot not in now:
            said[choice.shot] = "  (there is no such shot any more)"
        elif depends[now[choice.shot]] != choice.depends:
            said[choice.shot] = "  (its line has changed since)"
    return said
