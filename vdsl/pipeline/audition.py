"""One shot of a script proposed and put in order in memory, by its geometry; nothing is drawn or written."""

from __future__ import annotations

from dataclasses import asdict, replace

from ..emit.words import line_words
from ..lang.ir import Shot, StoryLine
from ..propose.cameras import subject_of
from ..propose.promise import achieved
from ..propose.story import propose
from ..propose.types import ProposalGrid
from .compile import Act, stage_acts
from .judging import GeometryJudge
from .script import Checked
from .selection import choose_takes
from .why import ShotFacts, TakeFacts
from .witness import best, counted, vet_tracks


def facts_in_memory(checked: Checked, wanted: str) -> ShotFacts:
    """A shot as ``vdsc compile --rank geometry`` would propose it.

    Raises ScriptError where a line before it cannot be played.
    """
    act, line, shot = _staged(checked, wanted)
    grid = propose(line, shot, act.state, act.filming, advised=True)
    judge = GeometryJudge()
    scores = judge.scores(grid.cameras, None)
    vetted = vet_tracks(grid, scores, best(grid, shot.takes), shot, act.filming)
    chosen = choose_takes(grid.cameras, vetted.order, shot.takes)
    takes = tuple(_take(grid, act, shot, i, rank, float(scores[i])) for rank, i in enumerate(chosen, start=1))
    return ShotFacts(
        shot.id,
        shot.line,
        line_words(line, checked.storyboard.scenes[line.scene].name),
        {"movement": list(shot.movements), "scale": list(shot.scales), "angle": list(shot.angles)},
        judge.name,
        len(grid.cameras),
        counted(grid.rejected, vetted.failed, chosen),
        takes,
        asdict(grid.advice) if grid.advice else None,
        "memory",
    )


def _staged(checked: Checked, wanted: str) -> tuple[Act, StoryLine, Shot]:
    """The shot's line in its scene, as the lines of the scene before it leave it."""
    lines = checked.storyboard.lines
    at, shot = next((i, s) for i, line in enumerate(lines) for s in line.shots if s.id == wanted)
    before = tuple(line for line in lines[: at + 1] if line.scene == lines[at].scene)
    acts = stage_acts(replace(checked, storyboard=replace(checked.storyboard, lines=before)))
    return acts[-1], acts[-1].line, shot


def _take(grid: ProposalGrid, act: Act, shot: Shot, i: int, rank: int, score: float) -> TakeFacts:
    camera = grid.cameras[i]
    story = next(s for s in grid.story if s.index == camera.story)
    found = achieved(camera, subject_of(shot, story, act.filming), act.filming.rig)
    words = {"movement": camera.movement, "scale": camera.scale, "angle": camera.angle}
    return TakeFacts(rank, score, words, asdict(found), camera.measures, camera.params, None)
