"""A film rehearsed: every shot proposed and put in order by its geometry, and what its cuts break.

Assumes a checked script. Nothing is drawn or written. Guarantees the same findings for the same text; a
compilation that judges by pictures, or proposes more, may choose other takes.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from ..emit.storyboard_json import SCHEMA, script_digest
from ..emit.types import CutFinding
from ..lang import Report
from ..lang.ir import Shot, Storyboard
from ..propose.story import propose
from .compile import stage_acts
from .edit import Reel, Slot, candidates, cut_findings, ends_of
from .judging import GeometryJudge
from .script import Checked

#: Proposals a shot: enough that the best is near what more would give.
PROPOSALS = 24
#: What is said of each rule: its code, and what can be done about it.
SAID = {
    "line": ("VDS280", "try `vdsc compile --edit`, or put a shot on the line itself between the two"),
    "direction": ("VDS281", "try `vdsc compile --edit`, or a shot between the two that they come towards"),
    "eyeline": ("VDS282", "try `vdsc compile --edit`"),
    "jump": (
        "VDS283",
        "try `vdsc compile --edit`, another size, or a shot of something else between the two",
    ),
    "size": ("VDS284", "where it is not meant, give one of the two a size between"),
}


def rehearse(checked: Checked, proposals: int = PROPOSALS) -> list[Slot]:
    """Every shot with its candidates, best first. Raises ScriptError for what cannot be played."""
    reel, judge = Reel(), GeometryJudge()
    for act in stage_acts(checked):
        for shot in act.line.shots:
            few = replace(shot, proposals=min(shot.proposals, proposals))
            grid = propose(act.line, few, act.state, act.filming)
            scores = judge.scores(grid.cameras, None)
            chosen = candidates(grid.cameras, scores, shot.takes)
            ends = ends_of(act.line, shot, grid, chosen, act.filming)
            reel.add(act.line, shot, chosen, [float(scores[i]) for i in chosen], ends)
    return reel.slots


def continuity_of_build(folder: Path, storyboard: Storyboard) -> list[dict[str, Any]] | None:
    """What the cuts of a build break, as in its ``storyboard.json``; None where it is not of this script."""
    try:
        document = json.loads((folder / "storyboard.json").read_text("utf-8"))
        if document["schema"] != SCHEMA or document["script"] != script_digest(storyboard):
            return None
        return [{k: entry[k] for k in ("rule", "shots", "cut", "text")} for entry in document["continuity"]]
    except (OSError, ValueError, KeyError, TypeError):
        return None


def continuity_in_memory(checked: Checked) -> list[dict[str, Any]]:
    """What the cuts between the best takes of a rehearsal break."""
    slots = rehearse(checked)
    return [_entry(cut) for cut in cut_findings(slots, [0] * len(slots))]


def _entry(cut: CutFinding) -> dict[str, Any]:
    return {"rule": cut.finding.rule, "shots": list(cut.shots), "cut": list(cut.cut), "text": cut.text}


def report_cuts(found: Iterable[Mapping[str, Any]], storyboard: Storyboard, report: Report) -> None:
    """Add findings to a report as warnings at the places of their shots."""
    shots: dict[str, Shot] = {s.id: s for line in storyboard.lines for s in line.shots}
    for entry in found:
        before, after = (shots.get(name) for name in entry["shots"])
        if before is None or after is None or entry["rule"] not in SAID:
            continue
        code, help = SAID[entry["rule"]]
        note = (before.span, f"shot {entry['cut'][0]}")
        report.warn(code, after.span, label=str(entry["text"]), help=help, notes=(note,))
