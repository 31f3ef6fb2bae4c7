"""Shots as they are named on the command line: by id, by a part of it, or by number; and completing them."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import typer

from ..lang.diagnostics import listing, nearest
from .check import USAGE, stop
from .show import count

if TYPE_CHECKING:
    from ..pipeline.script import Checked


def shot_named(checked: Checked, wanted: str) -> str:
    """The id of the shot that is meant; leaves where that is not clear."""
    ids = [s.id for line in checked.storyboard.lines for s in line.shots]
    if not ids:
        stop("this file has no shot", USAGE)
    if wanted in ids:
        return wanted
    if wanted.isdecimal():
        if 1 <= int(wanted) <= len(ids):
            return ids[int(wanted) - 1]
        stop(f"there is no shot {wanted}; the storyboard has {count(len(ids), 'shot')}", USAGE)
    found = [i for i in ids if wanted.lower() in i.lower()]
    if len(found) == 1:
        return found[0]
    if found:
        stop(f"`{wanted}` is a part of several shots: {listing(found, last='and')}", USAGE)
    meant = nearest(wanted, ids)
    hint = f"did you mean `{meant}`?" if meant else f"shots are {listing(ids, last='and')}"
    stop(f"there is no shot `{wanted}`; {hint}", USAGE)


def shot_ids(context: typer.Context, incomplete: str) -> list[str]:
    """Ids of the shots of the storyboard named before, for the shell to complete."""
    from ..pipeline.script import ScriptError, load_storyboard

    try:
        checked = load_storyboard(Path(str(context.params.get("file"))))
    except (ScriptError, OSError):
        return []
    ids = (s.id for line in checked.storyboard.lines for s in line.shots)
    return [i for i in ids if i.startswith(incomplete)]
