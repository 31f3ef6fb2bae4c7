"""Those over whose shoulder or through whose eyes a line is seen: they face what they look at.

On a set, whoever is only looked past is turned as the picture wants them; nobody sees it, since the shot
begins so. Assumes a checked line. Guarantees that who acts, sits, lies or holds a pose stays as they are.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..lang.ir import Shot, StoryLine
from .state import SceneState

_ASIDE = 0.8  # radians off what they look at from which on they are turned to it


def beholding(state: SceneState, line: StoryLine) -> SceneState:
    """The state with beholders who stand, and have nothing to do in the line, turned to the one filmed."""
    acting = {beat.character for beat in line.beats}
    actors = dict(state.actors)
    for shot in line.shots:
        looked_at = _looked_at(shot, line)
        if shot.view not in ("ots", "pov") or looked_at not in actors:
            continue
        for name in shot.whose:
            actor = actors.get(name)
            if actor is None or name in acting or name == looked_at:
                continue
            x, y = np.subtract(actors[looked_at].position, actor.position)[:2]
            to = float(np.arctan2(y, x))
            off = abs((to - actor.heading + np.pi) % (2 * np.pi) - np.pi)
            if actor.posture == "standing" and actor.seat is None and actor.kept is None and off > _ASIDE:
                actors[name] = replace(actor, heading=to)
    return replace(state, actors=actors)


def _looked_at(shot: Shot, line: StoryLine) -> str:
    if shot.focus is not None and shot.focus.kind == "character":
        return shot.focus.path[-1]
    return line.beats[0].character if line.beats and shot.focus is None else ""
