"""A storyboard counted: shots by what they are, how long they last, who is in them and who speaks.

Assumes a checked script. Where a build of that very script is at hand, its best takes are counted; otherwise
the words of the script, and how long its lines take to act. Guarantees a document of schema ``vds.stats/1``.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np

from ..cinema.track import camera_axes, project
from ..emit.storyboard_json import SCHEMA as BUILD_SCHEMA
from ..emit.storyboard_json import script_digest
from ..emit.timeline import place_shots
from ..emit.types import CUT
from ..lang.ir import Storyboard
from ..propose.story import tell
from .compile import stage_acts
from .facts import ShotFacts, facts_of_shots
from .script import Checked

SCHEMA = "vds.stats/1"
_SAMPLES = 12


@dataclass(frozen=True)
class Counted:
    """A shot as it is counted. seconds: its own length, with what it shares with its neighbours

    words: movement, size and angle; seen: seconds in which each of the people is in the picture, where known
    """

    facts: ShotFacts
    acting: tuple[str, ...]
    seconds: float
    words: Mapping[str, str]
    seen: Mapping[str, float] = field(default_factory=dict)


def counts(checked: Checked, folder: Path) -> dict[str, Any]:
    """The document, from the script and, where it is of the script as it stands, from the build in a folder.

    Raises :class:`~vdsl.pipeline.script.ScriptError` for what cannot be acted.
    """
    board = checked.storyboard
    built = _build_of(folder, board)
    shots = _by_script(checked) if built is None else _by_build(board, built, folder)
    out: dict[str, Any] = {
        "schema": SCHEMA,
        "file": board.source_name,
        "title": board.title,
        "counted": "script" if built is None else "build",
        "shots": len(shots),
        "lines": len(board.lines),
        "seconds": _rounded(_film_seconds(board, shots)),
        "length": _lengths(shots),
    }
    for name, key in (("sizes", "size"), ("angles", "angle"), ("movements", "movement")):
        out[name] = _table([(s.words[key], s.seconds) for s in shots])
    out["scenes"] = _table([(s.facts.facts["scene"], s.seconds) for s in shots])
    out["characters"] = {
        who.name: _character(who.name, shots, board, built is not None) for who in board.characters
    }
    out["build"] = None if built is None else _build_counts(built)
    return out


def _rounded(seconds: float) -> float:
    return round(seconds, 3) + 0.0


def _lengths(shots: Sequence[Counted]) -> dict[str, Any] | None:
    """Average and median length, and the two extremes; None where there is no shot that has a length."""
    timed = [s for s in shots if s.seconds > 0]
    if not timed:
        return None

    def one(shot: Counted) -> dict[str, Any]:
        return {"id": shot.facts.id, "number": shot.facts.number, "seconds": _rounded(shot.seconds)}

    seconds = [s.seconds for s in timed]
    return {
        "mean": _rounded(sum(seconds) / len(seconds)),
        "median": _rounded(median(seconds)),
        "longest": one(max(timed, key=lambda s: s.seconds)),
        "shortest": one(min(timed, key=lambda s: s.seconds)),
    }


def _table(entries: Sequence[tuple[str, float]]) -> dict[str, dict[str, Any]]:
    """Shots and seconds by word, the most frequent first."""
    names = sorted({word for word, _ in entries}, key=lambda w: (-sum(x == w for x, _ in entries), w))
    return {
        name: {
            "shots": sum(w == name for w, _ in entries),
            "seconds": _rounded(sum(s for w, s in entries if w == name)),
        }
        for name in names
    }


def _character(name: str, shots: Sequence[Counted], board: Storyboard, seen: bool) -> dict[str, Any]:
    """What somebody does in the film. seconds: of the shots they act in; in_picture: None where not known"""
    acts = [s for s in shots if name in s.acting]
    said = [s.facts.facts["say"] for s in acts if s.acting[0] == name and s.facts.facts["say"]]
    return {
        "shots": len(acts),
        "acts": sum(b.character == name for line in board.lines for b in line.beats),
        "seconds": _rounded(sum(s.seconds for s in acts)),
        "in_picture": _rounded(sum(s.seen.get(name, 0.0) for s in shots)) if seen else None,
        "says": len(said),
        "words": sum(len(text.split()) for text in said),
    }


def _film_seconds(board: Storyboard, shots: Sequence[Counted]) -> float:
    """The film's length, with what transitions share."""
    first = {line.shots[0].id: line.transition for line in board.lines if line.shots}
    frames = [round(s.seconds * board.fps[0] / board.fps[1]) for s in shots]
    shown = [(n, first.get(s.facts.id, CUT)) for n, s in zip(frames, shots, strict=True) if n]
    if not shown:
        return 0.0
    placed = place_shots([n for n, _ in shown], [t for _, t in shown], board.fps, board.ending)
    return max(p.start + p.frames for p in placed) * board.fps[1] / board.fps[0]


def _acting(board: Storyboard) -> dict[str, tuple[str, ...]]:
    return {
        s.id: tuple(dict.fromkeys(b.character for b in line.beats))
        for line in board.lines
        for s in line.shots
    }


# --- the script alone -------------------------------------------------------------------------


def _by_script(checked: Checked) -> list[Counted]:
    """Words as asked; lengths as the lines are acted, in the first of the ways they may be."""
    board = checked.storyboard
    seconds: dict[str, float] = {}
    for act in stage_acts(checked):
        for shot in act.line.shots:
            ways = tell(act.state, act.line, act.filming, shot=shot, most=1).proposals
            seconds[shot.id] = ways[0].frames * board.fps[1] / board.fps[0] if ways else 0.0
    acting = _acting(board)
    return [
        Counted(
            facts,
            acting[facts.id],
            seconds[facts.id],
            {k: facts.facts[k] for k in ("size", "angle", "movement")},
        )
        for facts in facts_of_shots(board)
    ]


# --- a build ----------------------------------------------------------------------------------


def _build_of(folder: Path, board: Storyboard) -> dict[str, Any] | None:
    """The ``storyboard.json`` of a build of this very script."""
    try:
        document = json.loads((folder / "storyboard.json").read_text("utf-8"))
        fits = document["schema"] == BUILD_SCHEMA and document["script"] == script_digest(board)
        known = {s["id"] for s in document["shots"]} == {s.id for line in board.lines for s in line.shots}
        return document if fits and known else None
    except (OSError, ValueError, KeyError, TypeError):
        return None


def _by_build(board: Storyboard, document: Mapping[str, Any], folder: Path) -> list[Counted]:
    """Words and lengths of the best takes; a shot without one counts with the words asked, and no time."""
    acting, entries = _acting(board), {s["id"]: s for s in document["shots"]}
    rate = board.fps[1] / board.fps[0]
    out = []
    for facts in facts_of_shots(board):
        shot = entries[facts.id]
        words = {k: facts.facts[k] for k in ("size", "angle", "movement")}
        counted = Counted(facts, acting[facts.id], shot["frames"] * rate, words)
        if shot["takes"]:
            best = shot["takes"][0]
            words = {"size": best["scale"], "angle": best["angle"], "movement": best["movement"]}
            counted = replace(counted, words=words, seen=_seen(folder / best["track"], counted.seconds))
        out.append(counted)
    return out


def _seen(track: Path, seconds: float) -> dict[str, float]:
    """Seconds in which each of the people has the head in the frame, hidden or not."""
    try:
        document = json.loads(track.read_text("utf-8"))
        camera, people = document["camera"], document["people"]
        at = np.unique(np.linspace(0, document["frames"] - 1, _SAMPLES).round().astype(int))
        position, focal = np.array(camera["position"])[at], np.array(camera["focal_mm"])[at]
        axes = camera_axes(np.deg2rad(np.array(camera["rotation_deg"])[at]))
        out = {}
        for who in people:
            spot, depth = project(
                np.array(who["head"])[at][:, None], position, axes, focal, tuple(document["sensor_mm"])
            )
            inside = (depth[:, 0] > 0) & (spot[:, 0] >= 0).all(1) & (spot[:, 0] <= 1).all(1)
            out[who["name"]] = float(inside.mean()) * seconds
        return out
    except (OSError, ValueError, KeyError, TypeError, IndexError):
        return {}


def _build_counts(document: Mapping[str, Any]) -> dict[str, Any]:
    scores = [s["takes"][0]["score"] for s in document["shots"] if s["takes"]]
    return {
        "judge": document["judge"],
        "takes": document["statistics"]["takes"],
        "proposals": document["statistics"]["proposals"],
        "rejected": document["statistics"]["rejected"],
        "without_take": sum(not s["takes"] for s in document["shots"]),
        "mean_score": round(sum(scores) / len(scores), 6) if scores else None,
        "cuts_broken": len({tuple(c["cut"]) for c in document["continuity"]}),
    }
