"""``vdsc new NAME``: a project to begin with: a story that compiles at once, settings, and what git needs."""

from __future__ import annotations

import re
import shlex
import sys
from pathlib import Path
from typing import Annotated

import typer

from .check import MACHINE, USAGE, stop
from .show import printable, write_line

_NAME = re.compile(r"[^\W\d][\w-]*")

_STORY = """\
# {title}: a first storyboard. Change a line, save, and see what becomes of it:
#
#     vdsc serve {file} --watch
#
# A line says who does what, and after the slash how it is filmed: movement, size, angle.
# Where you say nothing, or write *, many ways are tried and the best are kept.

storyboard "{title}"

character mara = woman(hair bun, top mustard)
character jonas = man(build slim, top navy)

# --- Late in the evening -----------------------------------------------------------

scene home = apartment.kitchen at night
mara at chair_2 sitting
jonas at door

/ (push wide eye-level) 3s                              # the place, before anything happens

(jonas walk table)         / (follow medium-long eye-level)
(jonas talk mara)          / (static medium eye-level)  say "You are still awake."
(mara talk jonas)          / (* close-up *)             say "I was waiting for the rain."
(jonas walk window)        / (pan medium eye-level)
(jonas point window)       / (arc medium low-angle)     say "There. Do you hear it?"
fade-out 1s
"""

_SETTINGS = """\
# Settings of all the storyboards in this folder. Header lines of a storyboard win over them, and so does
# the command line.

size = "1280x720"
takes = 3           # of every shot, to choose from
proposals = 80      # cameras tried for every shot

[compile]
rank = "discriminator"    # or "geometry": quicker, without the look at pictures
"""

_IGNORE = """\
# What vdsc makes; the storyboard and its lock, which keeps the chosen takes, belong in git.
/build/
"""

_ATTRIBUTES = """\
# `git diff` in words: shots added, removed, changed. Once for each clone:
#     git config diff.vds.command "vdsc diff --git"
*.vds text diff=vds
*.vds.lock text
"""

_README = """\
# {title}

A moving storyboard, written in `{file}`.

    vdsc serve {file} --watch    # compile on every save; a page shows it, to choose takes in
    vdsc pick {file} 3 2         # or here: show shot 3 by its take 2
    vdsc compile {file}          # the whole film once: build/{name}/index.html, animatic.mp4
"""


def new(
    name: Annotated[str, typer.Argument(help="What the project is called; its folder as well.")],
) -> None:
    """Begin a project: a folder with a story that compiles at once, settings, and what git needs."""
    place = Path(name)
    if not _NAME.fullmatch(place.name):
        stop(f"{name!r} is no name for a project: letters, digits, - and _, a letter first", USAGE)
    title = place.name.replace("-", " ").replace("_", " ").capitalize()
    words = {"name": place.name, "title": title, "file": f"{place.name}.vds"}
    files = {
        words["file"]: _STORY,
        "vds.toml": _SETTINGS,
        ".gitignore": _IGNORE,
        ".gitattributes": _ATTRIBUTES,
        "README.md": _README,
    }
    there = [file for file in files if (place / file).exists()]
    if there:
        stop(f"{place} holds {', '.join(there)} already; nothing was changed", USAGE)
    if place.exists() and not place.is_dir():
        stop(f"{place} is there already and is no folder; nothing was changed", USAGE)
    try:
        place.mkdir(parents=True, exist_ok=True)
        for file, text in files.items():
            (place / file).write_text(text.format(**words), encoding="utf-8")
    except OSError as error:
        stop(f"cannot write {error.filename or place}: {error.strerror or error}", MACHINE)
    write_line(printable(f"{place} holds {', '.join(files)}"), sys.stdout)
    write_line(
        printable(f"next: cd {shlex.quote(str(place))} && vdsc serve {words['file']} --watch"), sys.stdout
    )
