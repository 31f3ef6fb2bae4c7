"""``vdsc diff``: what changed between two storyboards, shot by shot and in words.

Also what git needs to show storyboards: ``--git`` is a diff driver, ``--textconv`` writes a storyboard as
lines that git can compare itself (docs/compare.md).
"""

from __future__ import annotations

import difflib
import json
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NoReturn

import typer

from ..lang import Report
from ..pipeline.script import Checked, ScriptError
from .check import MACHINE, USAGE, WRONG, stop
from .show import count, print_report, printable, write_line

if TYPE_CHECKING:
    from ..pipeline.compare import Comparison
    from ..pipeline.compare_sides import Side

SCHEMA = "vds.diff/1"
_GIT_WORDS = (7, 9)  # what git passes to a diff driver; two more where a file was renamed


def diff(
    words: Annotated[
        list[str],
        typer.Argument(
            metavar="[A] [B] FILE",
            help="Two files; or a file, after one or two git revisions.",
            show_default=False,
        ),
    ],
    as_json: Annotated[bool, typer.Option("--json", help="As a document of schema vds.diff/1.")] = False,
    page: Annotated[
        Path | None,
        typer.Option("--page", help="Write keyframes side by side as a page.", show_default=False),
    ] = None,
    git: Annotated[bool, typer.Option("--git", help="Be git's diff driver (see docs/compare.md).")] = False,
    textconv: Annotated[
        bool, typer.Option("--textconv", help="Write one storyboard as lines for git to compare.")
    ] = False,
) -> None:
    """Say which shots came, went, moved or changed between two storyboards.

    `vdsc diff OLD.vds NEW.vds`, `vdsc diff HEAD~1 story.vds`, `vdsc diff v1 v2 story.vds`, or with the file
    alone what changed since it was committed last. Exit code 0 if both could be read.
    """
    if git:
        _drive_git(words)
    elif textconv:
        _write_as_lines(words)
    else:
        _compare(words, as_json, page)


def _compare(words: Sequence[str], as_json: bool, page: Path | None) -> None:
    from ..pipeline.compare import compare

    sides = _sides(words)
    checked = [_checked(side) for side in sides]
    found = compare(*(c.storyboard for c in checked))
    if as_json:
        write_line(json.dumps(_document(found, sides), indent=1, ensure_ascii=False), sys.stdout)
    else:
        for line in _lines(found, sides):
            write_line(printable(line), sys.stdout)
    if page is not None:
        _write_page(page, found, sides, checked)


def _sides(words: Sequence[str]) -> tuple[Side, Side]:
    from ..pipeline.compare_sides import NoSideError, sides_of

    try:
        return sides_of(words)
    except NoSideError as error:
        stop(str(error), USAGE)
    except ScriptError as error:
        _refused(error.report, words[-1])
    except OSError as error:
        stop(f"cannot read: {error}", MACHINE)


def _checked(side: Side) -> Checked:
    try:
        found = side.checked()
    except ScriptError as error:
        _refused(error.report, side.name)
    if found is None:
        stop(f"there is no {side.name}; the file is new", USAGE)
    return found


def _refused(report: Report, name: str) -> NoReturn:
    print_report(report, "text", name)
    stop(f"{name} has errors, so that there is no storyboard to compare", WRONG)


# --- as text and as JSON ----------------------------------------------------------------------


def _lines(found: Comparison, sides: tuple[Side, Side]) -> Iterator[str]:
    yield f"--- {sides[0].name}"
    yield f"+++ {sides[1].name}"
    if found.equal:
        yield "the same storyboard"
        return
    for change in found.board:
        yield f"~ {change.text}"
    marks = {"added": "+", "removed": "-", "changed": "~", "moved": ">"}
    for shot in found.changed:
        yield f"{marks[shot.status]} {shot.text}"
    yield summary(found)


def summary(found: Comparison) -> str:
    """``1 shot added, 2 changed; 9 the same``"""
    counts = {
        s: sum(x.status == s for x in found.shots) for s in ("added", "removed", "changed", "moved", "same")
    }
    told = [f"{n} {status}" for status, n in counts.items() if n and status != "same"]
    changed = ", ".join(told) if told else "no shot changed"
    first = count(sum(x.status == "same" for x in found.shots), "shot")
    return f"{changed}; {first} the same"


def _document(found: Comparison, sides: tuple[Side, Side]) -> dict[str, Any]:
    def place(shot: Any) -> dict[str, Any] | None:
        return None if shot is None else {"id": shot.id, "number": shot.number, "line": shot.line}

    def changes(found: Sequence[Any]) -> list[dict[str, str]]:
        return [{"what": c.what, "before": c.before, "after": c.after, "text": c.text} for c in found]

    return {
        "schema": SCHEMA,
        "before": sides[0].name,
        "after": sides[1].name,
        "board": changes(found.board),
        "shots": [
            {
                "status": s.status,
                "before": place(s.before),
                "after": place(s.after),
                "moved": s.moved,
                "changes": changes(s.changes),
                "text": s.text,
            }
            for s in found.shots
        ],
    }


# --- git --------------------------------------------------------------------------------------


def _drive_git(words: Sequence[str]) -> None:
    """``path old-file old-hex old-mode new-file new-hex new-mode``: print, and never fail: git would stop."""
    from ..pipeline.compare import compare
    from ..pipeline.compare_sides import NoSideError, on_disk

    if len(words) not in _GIT_WORDS:
        stop("--git is for git to call: git config diff.vds.command 'vdsc diff --git'", USAGE)
    path = Path(words[0])
    try:
        old, new = (on_disk(Path(name), path) for name in (words[1], words[4]))
        one, two = old.checked(), new.checked()
    except (NoSideError, ScriptError, OSError):
        _plain(words[0], words[1], words[4])
        return
    if one is None or two is None:
        _plain(words[0], words[1], words[4])
        return
    write_line(printable(f"diff --vds {path}"), sys.stdout)
    for line in list(_lines(compare(one.storyboard, two.storyboard), (old, new)))[2:]:
        write_line(printable(line), sys.stdout)


def _plain(name: str, old: str, new: str) -> None:
    """What is no storyboard (yet), line by line."""
    before, after = (Path(p).read_bytes().decode("utf-8", "replace").splitlines() for p in (old, new))
    for line in difflib.unified_diff(before, after, f"a/{name}", f"b/{name}", lineterm=""):
        write_line(printable(line), sys.stdout)


def _write_as_lines(words: Sequence[str]) -> None:
    """Every fact on a line of its own; the text as it is where it is no storyboard."""
    from ..pipeline.facts import board_facts, facts_of_shots
    from ..pipeline.script import load_storyboard

    if len(words) != 1:
        stop("--textconv takes one file", USAGE)
    path = Path(words[0])
    try:
        board = load_storyboard(path).storyboard
    except (ScriptError, OSError):
        try:
            write_line(path.read_bytes().decode("utf-8", "replace").rstrip("\n"), sys.stdout)
        except OSError as error:
            stop(f"cannot read {path}: {error.strerror or error}", MACHINE)
        return
    for name, value in board_facts(board).items():
        if value:
            write_line(printable(f"{name}: {value}"), sys.stdout)
    for shot in facts_of_shots(board):
        write_line("", sys.stdout)
        write_line(printable(f"shot {shot.id}"), sys.stdout)
        for name, value in shot.facts.items():
            if value:
                write_line(printable(f"    {name}: {value}"), sys.stdout)


# --- as a page --------------------------------------------------------------------------------


def _write_page(page: Path, found: Comparison, sides: tuple[Side, Side], checked: Sequence[Checked]) -> None:
    from .failures import failures_told

    with failures_told(page):
        from ..emit.folder import write_text
        from ..pipeline.compare_stills import comparison_page

        write_text(page, comparison_page(found, sides, checked, summary(found)))
    write_line(printable(str(page)), sys.stdout)
