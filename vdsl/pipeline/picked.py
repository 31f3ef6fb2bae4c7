"""The takes that somebody chose for a script, among the takes of its build.

Assumes a lock and ``storyboard.json`` beside the script or here. Guarantees that a choice whose take is not
in the build, or alone in its shot, is left out, and that damaged documents are told.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ranker.errors import RankerError

from ..cinema.measures import MEASURES
from ..cinema.traits import traits_of
from .judging import prior
from .lock import lock_path, read_lock


@dataclass(frozen=True, eq=False)
class Picked:
    """A shot whose take somebody chose. build: the folder; takes: two at least, as in ``storyboard.json``

    chosen: which of them; traits: theirs [T, M] (:mod:`vdsl.cinema.traits`); odds: log odds [T] by which they
    were put in order but for a taste, zeros where the discriminator was not asked
    """

    build: Path
    id: str
    takes: tuple[Mapping[str, Any], ...]
    chosen: int
    traits: NDArray[np.float64]
    odds: NDArray[np.float64]


def picked(script: Path, build: Path | None = None) -> list[Picked]:
    """The shots of a script that somebody chose a take for.

    build: its folder, None for ``build/NAME`` where one is, beside the script or here. Raises
    :class:`RankerError` where there are choices but no build with several takes, ScriptError for a lock that
    does not read.
    """
    lock = read_lock(lock_path(script))
    if not lock.choices:
        return []
    folder = build or _build_of(script)
    try:
        document = json.loads((folder / "storyboard.json").read_text("utf-8"))
        shots = {shot["id"]: shot["takes"] for shot in document["shots"]}
        found = [
            picked_of(folder, choice.shot, shots[choice.shot], choice.key)
            for choice in lock.choices
            if choice.shot in shots
        ]
    except FileNotFoundError as error:
        raise RankerError(f"{folder}: has no takes of {script}; compile it first") from error
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise RankerError(f"{folder}: is no build of this version; compile {script} again") from error
    some = [shot for shot in found if shot is not None]
    if not some:
        raise RankerError(f"{folder}: has no other takes beside those chosen; compile {script} whole first")
    return some


def picked_of(folder: Path, shot: str, takes: list[Mapping[str, Any]], key: str) -> Picked | None:
    """A shot of a build with the take of a key chosen; None where it is not there or alone."""
    keys = [take["key"] for take in takes]
    if key not in keys or len(takes) < 2:
        return None
    traits = np.stack([_traits(folder, take) for take in takes])
    odds = np.array([_odds(take) for take in takes])
    return Picked(folder, shot, tuple(takes), keys.index(key), traits, odds)


def _traits(folder: Path, take: Mapping[str, Any]) -> NDArray[np.float64]:
    focal = json.loads((folder / take["track"]).read_text("utf-8"))["camera"]["focal_mm"]
    return traits_of(_measures(take), take["movement"], take["scale"], np.array(focal, float))


def _odds(take: Mapping[str, Any]) -> float:
    logit, _ = take["logit"], take["taste"]  # older builds, without a taste, have it in the first
    return 0.0 if logit is None else float(logit) + prior(_measures(take))


def _measures(take: Mapping[str, Any]) -> dict[str, float]:
    """What is no number is written as null."""
    known = {name: float(value) for name, value in take["measures"].items() if value is not None}
    return dict.fromkeys(MEASURES, 0.0) | known


def _build_of(script: Path) -> Path:
    here, beside = Path("build") / script.stem, script.parent / "build" / script.stem
    return here if (here / "storyboard.json").exists() or not beside.exists() else beside
