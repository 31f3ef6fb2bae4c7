"""``storyboard.json``: everything a program needs of a build, and no timings (docs/output.md)."""

from __future__ import annotations

import hashlib
from dataclasses import asdict
from pathlib import Path
from typing import Any

from ..lang.ir import Beat, Storyboard
from ..propose.types import Advice
from .documents import MEASURE_DECIMALS, numbers, rounded, write_document
from .statistics import statistics
from .timeline import Placed, film_timeline
from .types import Build, BuiltShot, BuiltTake, CutFinding, Trade
from .words import line_words

SCHEMA = "vds.storyboard/1"


def write_storyboard(path: Path, build: Build) -> None:
    """Write the document; the same build gives the same bytes."""
    write_document(path, storyboard_document(build))


def storyboard_document(build: Build) -> dict[str, Any]:
    """The document as plain values."""
    board = build.storyboard
    placed = film_timeline(build)
    return {
        "schema": SCHEMA,
        "title": board.title,
        "fps": list(board.fps),
        "size": list(board.size),
        "seed": board.seed,
        "rig": board.rig,
        "style": board.style,
        "source": board.source_name,
        "script": script_digest(board),
        "judge": build.judge,
        "taste": build.taste,
        "made_with": dict(build.made_with),
        "draft": build.draft,
        "characters": [c.name for c in board.characters],
        "cast": [
            {"name": c.name, "cast": c.cast, "arguments": numbers(dict(c.arguments))}
            for c in board.characters
        ],
        "scenes": [
            {"name": s.name, "set": s.set, "room": ".".join(s.room), "time": s.time} for s in board.scenes
        ],
        "shots": [_shot(s, placed.get(s.shot.id)) for s in build.shots],
        "edited": build.edited,
        "trades": [_trade(t) for t in build.trades],
        "continuity": [_cut(c) for c in build.continuity],
        "statistics": statistics(build),
    }


def script_digest(board: Storyboard) -> str:
    """SHA-256 of the script's text, by which a build is known to be of it."""
    text = board.lines[0].span.source.text if board.lines else ""
    return hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()


def _shot(built: BuiltShot, place: Placed | None) -> dict[str, Any]:
    shot, line = built.shot, built.line
    asked = {"movement": shot.movements, "scale": shot.scales, "angle": shot.angles}
    best = built.takes[0].camera if built.takes else None
    taken = {"movement": best.movement, "scale": best.scale, "angle": best.angle} if best else {}
    return {
        "id": shot.id,
        "line": shot.line,
        "text": line_words(line, built.scene),
        "scene": built.scene,
        "story": _beat(line.beats[0]) if line.beats else None,
        "together": [_beat(b) for b in line.beats[1:]],
        "camera": {k: taken.get(k, words[0] if len(words) == 1 else None) for k, words in asked.items()},
        "asked": {k: list(words) for k, words in asked.items()},
        "focus": ".".join(shot.focus.path) if shot.focus else None,
        "focus_to": ".".join(shot.focus_to.path) if shot.focus_to else None,
        "aperture": shot.aperture,
        "say": shot.say,
        "note": shot.note,
        "enter": {"kind": place.enter, "frames": place.enter_frames} if place else None,
        "leave": {"kind": place.leave, "frames": place.leave_frames} if place else None,
        "start": place.start if place else None,
        "frames": built.frames,
        "story_proposals": built.story_proposals,
        "camera_proposals": built.camera_proposals,
        "wanted": shot.proposals,
        "proposals": built.proposals,
        "rejected": dict(sorted(built.rejected.items())),
        "advice": _advice(built.advice),
        "depends": built.depends,
        "takes": [_take(shot.id, t) for t in built.takes],
    }


def _trade(trade: Trade) -> dict[str, Any]:
    return {
        "shot": trade.shot,
        "take": trade.take,
        "score": rounded(trade.score, MEASURE_DECIMALS),
        "best": rounded(trade.best, MEASURE_DECIMALS),
        "keeps": list(trade.keeps),
        "text": trade.text,
    }


def _cut(cut: CutFinding) -> dict[str, Any]:
    found = cut.finding
    return {
        "rule": found.rule,
        "severity": found.severity,
        "shots": list(cut.shots),
        "cut": list(cut.cut),
        "degrees": rounded(found.degrees, MEASURE_DECIMALS),
        "numbers": numbers(found.numbers),
        "text": cut.text,
    }


def _advice(advice: Advice | None) -> dict[str, Any] | None:
    if advice is None:
        return None
    return {"why": advice.why, "instead": list(advice.instead), "faulty": advice.faulty}


def _beat(beat: Beat) -> dict[str, Any]:
    return {
        "char": beat.character,
        "do": beat.action,
        "target": beat.target.written if beat.target else None,
        "second": beat.second.written if beat.second else None,
    }


def _take(shot: str, take: BuiltTake) -> dict[str, Any]:
    base = f"shots/{shot}/take-{take.rank}"
    return {
        "rank": take.rank,
        "proposal": take.camera.index,
        "key": take.key,
        "chosen": take.chosen,
        "score": rounded(take.score, MEASURE_DECIMALS),
        "logit": None if take.logit is None else rounded(take.logit, MEASURE_DECIMALS),
        "taste": rounded(take.taste, MEASURE_DECIMALS),
        "story": take.camera.story,
        "variant": take.variant,
        "movement": take.camera.movement,
        "scale": take.camera.scale,
        "angle": take.camera.angle,
        "achieved": asdict(take.achieved),
        "frames": take.media.frames,
        "video": None if take.media.sketched else f"{base}.mp4",
        "poster": f"{base}.jpg",
        "track": f"{base}.json",
        "measures": numbers(take.camera.measures),
    }
