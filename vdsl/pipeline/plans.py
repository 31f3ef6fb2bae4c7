"""Plans before anything is compiled: the best of a few proposals of each shot, from above.

Assumes a checked script. Guarantees that nothing is drawn in three dimensions and nothing is written; a
compilation that judges by pictures, or proposes more, may choose other takes.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from ..emit.plan_ground import Plan, ground_of, lens_words, scene_plan, shot_plan
from ..emit.types import CUT, BuiltShot, BuiltTake, TakeMedia
from ..emit.words import line_words
from ..propose.cameras import subject_of
from ..propose.promise import achieved
from ..propose.story import propose
from .compile import Act, stage_acts
from .judging import GeometryJudge
from .script import Checked
from .shooting import walk_of

PROPOSALS = 24


def plan_before(checked: Checked, scene: str, shot: str = "") -> Plan:
    """The plan of a shot by its id, or of a scene by its name with the cameras of all its shots.

    Raises :class:`~vdsl.pipeline.script.ScriptError` for what cannot be played.
    """
    board = checked.storyboard
    number = next(k for k, s in enumerate(board.scenes) if s.name == scene)
    acts = [act for act in stage_acts(checked) if act.line.scene == number]
    order = {s.id: k for k, s in enumerate((s for line in board.lines for s in line.shots), 1)}
    if not acts:
        raise ValueError(f"nothing happens in scene {scene}")
    ground = ground_of(acts[0].staged.world, board.scenes[number].room, scene)
    if shot:
        act = next(a for a in acts if any(s.id == shot for s in a.line.shots))
        built = _best(act, shot, scene)
        label = lens_words(built.takes[0].camera.track) if built.takes else ""
        return shot_plan(ground, built, f"Plan of shot {order[shot]}, {line_words(act.line, scene)}", label)
    shots = _all(acts, scene)
    return scene_plan(ground, [(order[b.shot.id], b) for b in shots], f"Plan of {scene}")


def _all(acts: Sequence[Act], scene: str) -> list[BuiltShot]:
    return [_best(act, shot.id, scene) for act in acts for shot in act.line.shots]


def _best(act: Act, name: str, scene: str) -> BuiltShot:
    """A shot with the best take its geometry gives, without pictures."""
    shot = next(s for s in act.line.shots if s.id == name)
    grid = propose(act.line, replace(shot, proposals=min(shot.proposals, PROPOSALS)), act.state, act.filming)
    takes: tuple[BuiltTake, ...] = ()
    if grid.cameras:
        scores = GeometryJudge().scores(grid.cameras, None)
        best = int(np.argmax(scores))
        camera = grid.cameras[best]
        story = next(s for s in grid.story if s.index == camera.story)
        people = tuple(walk_of(who, way) for who, way in story.performances.items())
        did = achieved(camera, subject_of(shot, story, act.filming), act.filming.rig)
        media = TakeMedia(Path(), Path(), story.frames, ())
        score = float(scores[best])
        takes = (BuiltTake(1, score, camera, story.variant, None, media, did, people=people),)
    count = len(grid.cameras)
    return BuiltShot(shot, act.line, scene, CUT, takes, len(grid.story), count, count, grid.rejected)
