"""Choices by the shots and takes they are for, in a script or build that has changed since they were made.

Assumes digests of what the shots' lines depend on (:mod:`vdsl.pipeline.depends`). Guarantees that a choice is
for one shot at most, and a shot has one choice at most.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .lock import Choice


def placed(choices: Sequence[Choice], depends: Mapping[str, str]) -> dict[str, Choice]:
    """Choices by the shots of a script that they are for.

    A choice belongs to the shot of its id; but where that one's line is another now, or is gone, and there is
    a shot whose line is as it was when it was chosen, then to that one: shots are renamed, and lines put
    above others that say the same.
    """
    exact = {c.shot: c for c in choices if depends.get(c.shot) == c.depends}
    moved: dict[str, Choice] = {}
    for choice in choices:
        if choice.shot in exact:
            continue
        twins = [s for s, d in depends.items() if d == choice.depends and s not in exact and s not in moved]
        if twins:
            moved[twins[0]] = choice
    stayed = {c.shot: c for c in choices if c.shot in depends and c not in moved.values()}
    return stayed | moved


def find(choice: Choice, keys: Sequence[str]) -> int | None:
    """The place of what was chosen among keys of proposals, or None."""
    mark = choice.key.partition("-")[2]
    alike = [i for i, key in enumerate(keys) if key.partition("-")[2] == mark]
    return next((i for i in alike if keys[i] == choice.key), alike[0]) if alike else None
