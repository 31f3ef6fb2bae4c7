"""Why the takes of a shot are in their order: facts from a build or from memory, and what they come to.

Assumes the documents of a build (docs/output.md) or a shot proposed just now. Guarantees that both are
explained alike, and that the points told add up to the score.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..cinema.measures import MEASURES
from ..cinema.score import geometry_score
from ..cinema.telling import NOTES, faults, is_good, penalties, terms
from ..emit.reasons import TakeFacts, gains_of, phrases_of, sentence
from ..emit.storyboard_json import SCHEMA as BUILD_SCHEMA
from ..emit.storyboard_json import script_digest
from ..lang.ir import Storyboard
from .judging import prior

SCHEMA = "vds.why/1"


class NoBuildError(Exception):
    """The build cannot be read; the message says why."""


@dataclass(frozen=True)
class ShotFacts:
    """A shot with its takes, best first.

    origin: ``build`` or ``memory``; stale: the script has changed since; judge: ``ranker`` or ``geometry``
    placed: why the first take stands before better ones, "" where it is the best
    """

    id: str
    line: int
    text: str
    asked: dict[str, list[str]]
    judge: str
    proposals: int
    rejected: dict[str, int]
    takes: tuple[TakeFacts, ...]
    advice: dict[str, Any] | None
    origin: str
    stale: bool = False
    placed: str = ""


# --- facts ------------------------------------------------------------------------------------


def facts_of_build(folder: Path, storyboard: Storyboard, shot: str) -> ShotFacts | None:
    """What a build says of a shot; None where it has no such shot. Raises :class:`NoBuildError`."""
    document = _read(folder / "storyboard.json")
    if document.get("schema") != BUILD_SCHEMA:
        raise NoBuildError(f"{folder} is no build of this version")
    try:
        entry = next((s for s in document["shots"] if s["id"] == shot), None)
        if entry is None:
            return None
        return ShotFacts(
            shot,
            int(entry["line"]),
            entry["text"],
            entry["asked"],
            document["judge"],
            int(entry["proposals"]),
            dict(entry["rejected"]),
            tuple(_take_facts(folder, take) for take in entry["takes"]),
            entry.get("advice"),
            "build",
            document.get("script") != script_digest(storyboard),
            _placed(document, entry),
        )
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise NoBuildError(f"{folder} is damaged ({type(error).__name__}: {error})") from error


def _placed(document: Mapping[str, Any], entry: Mapping[str, Any]) -> str:
    """Why the first take is not simply the best one."""
    if entry["takes"] and entry["takes"][0].get("chosen"):
        return "take 1 stands first because it was chosen"
    kept = [trade["text"] for trade in document.get("trades", ()) if trade["shot"] == entry["id"]]
    return f"take 1 stands first for the sake of the cuts: {kept[0]}" if kept else ""


def _read(path: Path) -> dict[str, Any]:
    try:
        document = json.loads(path.read_text("utf-8"))
    except (OSError, ValueError) as error:
        raise NoBuildError(f"cannot read {path}: {error}") from error
    if not isinstance(document, dict):
        raise NoBuildError(f"{path} is damaged")
    return document


def _take_facts(folder: Path, take: Mapping[str, Any]) -> TakeFacts:
    measures = {k: float(v) for k, v in take["measures"].items() if v is not None}
    track = _read(folder / take["track"])
    return TakeFacts(
        int(take["rank"]),
        float(take["score"]),
        {k: take[k] for k in ("movement", "scale", "angle")},
        take.get("achieved"),
        {name: 0.0 for name in MEASURES} | measures,
        dict(track["params"]),
        take.get("logit"),
        float(take.get("taste") or 0.0),
    )


# --- what they come to ------------------------------------------------------------------------


def explanation(facts: ShotFacts) -> dict[str, Any]:
    """The document of schema ``vds.why/1`` (docs/output.md), of the whole shot."""
    return {
        "schema": SCHEMA,
        "shot": facts.id,
        "line": facts.line,
        "text": facts.text,
        "asked": facts.asked,
        "origin": facts.origin,
        "stale": facts.stale,
        "judge": facts.judge,
        "placed": facts.placed,
        "proposals": facts.proposals,
        "rejected": dict(sorted(facts.rejected.items(), key=lambda item: (-item[1], item[0]))),
        "advice": facts.advice,
        "takes": [_told(facts, k) for k in range(len(facts.takes))],
    }


def _told(facts: ShotFacts, k: int) -> dict[str, Any]:
    take = facts.takes[k]
    geometry = geometry_score(take.measures)
    order = list(range(len(facts.takes)))
    if facts.placed:  # the others stand as they rank
        best = sum(other.score > facts.takes[0].score for other in facts.takes[1:])
        order = [*order[1 : best + 1], 0, *order[best + 1 :]]
    return {
        "rank": take.rank,
        "score": take.score,
        "sentence": sentence([facts.takes[i] for i in order], order.index(k)),
        "camera": take.camera,
        "achieved": take.achieved,
        "kept": kept(take),
        "faults": list(faults(take.measures, take.camera["movement"])),
        "measures": {
            name: {
                "value": round(take.measures[name], 6) + 0.0,
                "unit": NOTES[name].unit,
                "good": NOTES[name].good,
                "fine": is_good(name, take.measures[name]),
            }
            for name in NOTES
            if name in take.measures
        },
        "terms": [
            {
                "part": t.part,
                "value": round(t.value, 6),
                "weight": t.weight,
                "points": round(t.points, 6),
            }
            for t in terms(take.measures)
        ],
        "penalties": {name: round(value, 6) for name, value in penalties(take.measures).items()},
        "geometry": round(geometry, 6),
        "logit": take.logit,
        "prior": None if take.logit is None else round(prior(take.measures), 6),
        "taste": round(take.taste, 6),
        "against": [_against(facts.takes, k, other) for other in range(len(facts.takes)) if other != k],
    }


def kept(take: TakeFacts) -> dict[str, bool] | None:
    """Which of the take's own words its track came out as."""
    if take.achieved is None:
        return None
    return {
        "movement": take.camera["movement"] == take.achieved["movement"],
        "scale": take.camera["scale"] == take.achieved["scale"],
        "angle": take.camera["angle"] == take.achieved["angle"],
    }


def _against(takes: Sequence[TakeFacts], k: int, other: int) -> dict[str, Any]:
    gains = gains_of(takes[k], takes[other])
    return {
        "rank": takes[other].rank,
        "better": phrases_of(takes[k], takes[other], gains, True),
        "worse": phrases_of(takes[k], takes[other], gains, False),
        "gains": {name: round(value, 6) for name, value in gains.items()},
    }
