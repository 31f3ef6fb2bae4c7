"""Takes beyond those that a script asks for, wanted shot by shot by somebody who likes none that were kept.

    {"schema": "vds.further/1", "shots": {"kitchen-anna-wave": {"takes": 10, "depends": "9c41d2e07a55"}}}

They stand in the build's folder and go over from one build to the next. Assumes nothing of the file: one that
does not read wants nothing. Guarantees that a wish counts only as long as its shot is what it was.
"""

from __future__ import annotations

import json
from collections.abc import Collection, Mapping
from dataclasses import asdict, dataclass
from pathlib import Path

from ..emit.folder import WISHES, write_text
from ..emit.page_view import MOST
from ..lang.ir import Storyboard

SCHEMA = "vds.further/1"
#: Takes that are drawn at a time.
STEP = 5


@dataclass(frozen=True)
class Wish:
    """takes: how many of a shot, in all; depends: the digest of what its line depends on."""

    takes: int
    depends: str


def wishes(folder: Path, depends: Mapping[str, str]) -> dict[str, Wish]:
    """What is wanted of a build's shots, as far as they are what they were; depends: their digests, by id."""
    try:
        document = json.loads((folder / WISHES).read_text("utf-8"))
        said = document["shots"].items() if document["schema"] == SCHEMA else ()
        found = {shot: Wish(int(w["takes"]), str(w["depends"])) for shot, w in said}
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return {}
    return {
        shot: Wish(min(wish.takes, MOST), wish.depends)
        for shot, wish in found.items()
        if depends.get(shot) == wish.depends
    }


def with_further(
    known: Mapping[str, Wish], wanted: Collection[str], board: Storyboard, depends: Mapping[str, str]
) -> dict[str, Wish]:
    """The wishes, and for the shots that are wanted further takes of so many more."""
    takes = {shot.id: shot.takes for line in board.lines for shot in line.shots}
    more = {}
    for shot in (s for s in wanted if s in takes):
        so_far = max(takes[shot], known[shot].takes if shot in known else 0)
        more[shot] = Wish(min(so_far + STEP, MOST), depends[shot])
    return {**known, **more}


def write_wishes(folder: Path, wishes: Mapping[str, Wish]) -> None:
    """Keep wishes in a build's folder. Raises OSError."""
    document = {"schema": SCHEMA, "shots": {shot: asdict(wish) for shot, wish in sorted(wishes.items())}}
    write_text(folder / WISHES, json.dumps(document, indent=1) + "\n")
