"""``vdsc check``: read and check a storyboard, and say everything that is wrong with it.

Imports the language and the library and nothing heavier. Exit codes: 0 fine, 1 the storyboard has
errors, 2 usage, 3 the machine failed.
"""

from __future__ import annotations

import sys
from enum import Enum
from pathlib import Path
from typing import Annotated, NoReturn

import typer

from ..lang.diagnostics import nearest
from ..lang.ir import Storyboard
from ..lang.settings import Settings
from ..pipeline.project import project_of
from ..pipeline.script import Checked, ScriptError, load_storyboard
from .show import print_report, printable, write_line

FINE, WRONG, USAGE, MACHINE = 0, 1, 2, 3


class Format(str, Enum):
    """How findings are printed."""

    text = "text"
    json = "json"


def check_or_exit(
    path: Path, format: str = "text", overrides: Settings | None = None, quiet_warnings: bool = False
) -> Checked:
    """A storyboard without errors; else print what is wrong and leave with the right code.

    It has the settings of its ``vds.toml`` where neither it nor ``overrides`` says others.
    quiet_warnings: print nothing where there are only warnings
    """
    if not path.exists():
        siblings = [p.name for p in path.parent.glob("*.vds") if p.exists()] if path.parent.is_dir() else []
        meant = nearest(path.name, siblings)
        hint = f" Did you mean {path.parent / meant}?" if meant else ""
        stop(f"there is no file {path}.{hint}", USAGE)
    if path.is_dir():
        stop(f"{path} is a folder; name a .vds file in it.", USAGE)
    try:
        checked = load_storyboard(path, overrides, project_of(path).settings)
    except ScriptError as error:
        print_report(error.report, format, str(path))
        raise typer.Exit(WRONG) from None
    except OSError as error:
        stop(f"cannot read {path}: {error.strerror or error}", MACHINE)
    except MemoryError:
        stop(f"not enough memory to read {path}", MACHINE)
    if not quiet_warnings:
        print_report(checked.report, format, str(path))
    return checked


def stop(message: str, code: int) -> NoReturn:
    """Print one line of why, and leave."""
    write_line(f"vdsc: {printable(message)}", sys.stderr)
    raise typer.Exit(code)


def check(
    file: Annotated[Path, typer.Argument(help="The storyboard, a .vds file.", show_default=False)],
    format: Annotated[Format, typer.Option(help="How to print what is found.")] = Format.text,
    continuity: Annotated[
        bool, typer.Option("--continuity", help="Say as well which cuts break the rules of cutting.")
    ] = False,
    build: Annotated[
        Path | None,
        typer.Option("--build", "-b", help="The build whose cuts are told.", show_default="build/NAME"),
    ] = None,
) -> None:
    """Check a storyboard and print every mistake, without making anything.

    With --continuity the cuts of its last build, build/NAME, are told; where there is none of the script as
    it is, a few proposals of every shot are put in order by their geometry and the best ones looked at. With
    --build no other takes are looked at than those of that build.
    Exit code 0 if all is well, 1 if the storyboard has errors.
    """
    checked = check_or_exit(file, format.value, quiet_warnings=continuity or build is not None)
    if continuity or build is not None:
        told = _check_cuts(file, checked, format.value, build)
        print_report(checked.report, format.value, str(file))
        if format is Format.text:
            write_line(printable(told), sys.stdout)
    if format is Format.text:
        write_line(f"{printable(str(file))}: {summary(checked.storyboard)}", sys.stdout)


def _check_cuts(file: Path, checked: Checked, format: str, build: Path | None) -> str:
    """Add what cuts break to the findings; returns what was looked at."""
    # Only now: a plain check must not wait for numpy.
    from ..pipeline.rehearsal import PROPOSALS, continuity_in_memory, continuity_of_build, report_cuts
    from .failures import failures_told

    folder = build or Path("build") / file.stem
    looked = f"continuity: the takes in {folder}"
    made = (folder / "storyboard.json").is_file()
    if build is not None and not made:
        stop(f"there is no build at {folder}; `vdsc compile {file} -o {folder}` makes one", USAGE)
    with failures_told(file, format):
        found = continuity_of_build(folder, checked.storyboard)
        if found is None and build is not None:
            stop(f"the build at {folder} is of another text than {file}; compile it again", USAGE)
        if found is None:
            looked = f"continuity: the best of up to {PROPOSALS} proposals a shot, by their geometry"
            looked += f" (the build in {folder} is of another text)" if made else ""
            found = continuity_in_memory(checked)
        report_cuts(found, checked.storyboard, checked.report)
    return f"{looked}; {len(found)} found"


def summary(storyboard: Storyboard) -> str:
    """``fine, 2 scenes, 10 lines, 12 shots``"""
    shots = sum(len(line.shots) for line in storyboard.lines)
    if not storyboard.lines:
        return "fine, definitions only"
    counts = ((len(storyboard.scenes), "scene"), (len(storyboard.lines), "line"), (shots, "shot"))
    return "fine, " + ", ".join(f"{n} {word}" if n == 1 else f"{n} {word}s" for n, word in counts)
