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
from ..cinema.moves import family
from ..cinema.score import geometry_score
from ..cinema.telling import NOTES, advantages, compared, faults, is_good, penalties, terms
from ..emit.storyboard_json import SCHEMA as BUILD_SCHEMA
from ..emit.storyboard_json import script_digest
from ..lang.ir import Storyboard
from .judging import PRIOR, prior

SCHEMA = "vds.why/1"
_ORDINALS = ("first", "second", "third", "fourth", "fifth", "sixth", "seventh", "eighth", "ninth", "tenth")
_SAID = 2  # advantages in a sentence
_WORTH = 0.004  # points of the geometry score below which a difference is not told


class NoBuildError(Exception):
    """The build cannot be read; the message says why."""


@dataclass(frozen=True)
class TakeFacts:
    """One take as a build keeps it. camera: its words; achieved: as read off its track; None: not kept."""

    rank: int
    score: float
    camera: dict[str, str]
    achieved: dict[str, str] | None
    measures: dict[str, float]
    params: dict[str, float | str]
    logit: float | None


@dataclass(frozen=True)
class ShotFacts:
    """A shot with its takes, best first.

    origin: ``build`` or ``memory``; stale: the script has changed since; judge: ``ranker`` or ``geometry``
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
        )
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise NoBuildError(f"{folder} is damaged ({type(error).__name__}: {error})") from error


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
        "proposals": facts.proposals,
        "rejected": dict(sorted(facts.rejected.items(), key=lambda item: (-item[1], item[0]))),
        "advice": facts.advice,
        "takes": [_told(facts, k) for k in range(len(facts.takes))],
    }


def _told(facts: ShotFacts, k: int) -> dict[str, Any]:
    take = facts.takes[k]
    geometry = geometry_score(take.measures)
    return {
        "rank": take.rank,
        "score": take.score,
        "sentence": sentence(facts.takes, k),
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
        "against": [_against(facts.takes, k, other) for other in range(len(facts.takes)) if other != k],
    }


def kept(take: TakeFacts) -> dict[str, bool] | None:
    """Which of the take's own words its track came out as."""
    if take.achieved is None:
        return None
    return {
        "movement": family(take.camera["movement"]) == take.achieved["movement"],
        "scale": take.camera["scale"] == take.achieved["scale"],
        "angle": take.camera["angle"] == take.achieved["angle"] or "lifted" in take.params,
    }


def _against(takes: Sequence[TakeFacts], k: int, other: int) -> dict[str, Any]:
    gains = _gains(takes[k], takes[other])
    return {
        "rank": takes[other].rank,
        "better": _phrases(takes[k], takes[other], gains, True),
        "worse": _phrases(takes[k], takes[other], gains, False),
        "gains": {name: round(value, 6) for name, value in gains.items()},
    }


def _gains(take: TakeFacts, other: TakeFacts) -> dict[str, float]:
    """Of each part, in log odds where the discriminator judged, in points of the geometry score else."""
    if take.logit is None or other.logit is None:
        return advantages(take.measures, other.measures)
    return advantages(take.measures, other.measures, (take.logit, other.logit), PRIOR)


def _phrases(
    take: TakeFacts, other: TakeFacts, gains: Mapping[str, float], better: bool, rival: str = ""
) -> list[str]:
    """What sets two takes apart, most telling first."""
    least = _WORTH if take.logit is None else _WORTH * PRIOR
    told = [p for p, gain in gains.items() if (gain if better else -gain) > least]
    told.sort(key=lambda p: -abs(gains[p]))
    mine = take.measures | {"logit": take.logit or 0.0}
    theirs = other.measures | {"logit": other.logit or 0.0}
    return [compared(p, mine, theirs, better, rival if i == 0 else "") for i, p in enumerate(told)]


def sentence(takes: Sequence[TakeFacts], k: int) -> str:
    """``ranks first: steadier than take 2 and more lead room (0.18 against 0.09); take 3 cuts the feet``."""
    take = takes[k]
    place = _ORDINALS[k] if k < len(_ORDINALS) else f"number {k + 1}"
    if len(takes) == 1:
        wrong = faults(take.measures, take.camera["movement"])
        return "the only take" + (f": {_and(wrong[:_SAID])}" if wrong else "")
    rival = takes[1] if k == 0 else takes[k - 1]
    gains = _gains(take, rival)
    first = _phrases(take, rival, gains, k == 0, f"take {rival.rank}")
    second = _phrases(take, rival, gains, k != 0)
    words = f"ranks {place}"
    if first:
        words += f": {_and(first[:_SAID])}"
    elif k:
        words += f": nearly as good as take {rival.rank}"
    else:
        words += f": by a hair before take {rival.rank}"
    if second:
        words += f", though {_and(second[:1])}"
    return "; ".join([words, *_others(takes, k)])


def _others(takes: Sequence[TakeFacts], k: int) -> list[str]:
    """Of the best take what is wrong with those after it; of any other what is wrong with itself."""
    wrong = faults(takes[k].measures, takes[k].camera["movement"])
    if k:
        return [f"it {_and(wrong[:_SAID])}"] if wrong else []
    out = []
    for other in takes[1:]:
        worse = [w for w in faults(other.measures, other.camera["movement"]) if w not in wrong]
        out += [f"take {other.rank} {worse[0]}"] if worse else []
    return out[:_SAID]


def _and(words: Sequence[str]) -> str:
    return " and ".join(words)
