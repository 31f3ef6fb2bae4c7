"""With the back against a wall, or what else is upright."""

from __future__ import annotations

import math

import numpy as np
import pytest

from vdsl.pipeline.trial import NoTrialError, stage_script
from vdsl.propose.state import SceneState
from vdsl.propose.story import tell

HEAD = 'storyboard "S"\ncharacter anna = woman\ncharacter ben = man\nscene s = {} at day\n'


def state_after(place: str, *lines: str) -> SceneState:
    act = stage_script(HEAD.format(place) + "\n".join(lines) + " / (static full)\n", "s")
    return tell(act.state, act.line, act.filming, shot=act.line.shots[0]).end


def behind(state: SceneState, who: str) -> float:
    """Metres from somebody's feet straight back to the nearest solid box, at the height of the hips."""
    actor, solids = state.actors[who], state.world.solids
    x, y, z = actor.position
    for away in np.arange(0.0, 2.0, 0.01):
        at = (x - away * math.cos(actor.heading), y - away * math.sin(actor.heading))
        dx, dy = at[0] - solids.centre[:, 0], at[1] - solids.centre[:, 1]
        c, s = np.cos(solids.yaw), np.sin(solids.yaw)
        inside = (np.abs(c * dx + s * dy) <= solids.half[:, 0]) & (
            np.abs(c * dy - s * dx) <= solids.half[:, 1]
        )
        if (inside & (np.abs(solids.centre[:, 2] - z - 0.7) <= solids.half[:, 2])).any():
            return float(away)
    return math.inf


@pytest.mark.parametrize(
    ("place", "line"),
    [
        ("apartment.kitchen", "(anna leans against the wall)"),
        ("apartment.kitchen", "(anna leans against the fridge)"),
        ("alley", "(anna leans against the wall)"),
        ("city_street", "(anna leans against the wall)"),
        ("city_street", "(anna leans against the tree)"),
    ],
)
def test_the_back_is_to_what_one_leans_against(place: str, line: str) -> None:
    state = state_after(place, line)
    assert behind(state, "anna") == pytest.approx(0.3, abs=0.04)


def test_two_lean_beside_each_other_and_one_sits_down_against_the_wall() -> None:
    script = (
        HEAD.format("alley") + "anna at door\nben at fence\n(they lean against the wall) / (static full)\n"
    )
    act = stage_script(script, "s")
    state = tell(act.state, act.line, act.filming, shot=act.line.shots[0]).end
    anna, ben = (state.actors[who].position for who in ("anna", "ben"))
    assert math.dist(anna, ben) > 0.4
    assert behind(state, "ben") == pytest.approx(0.3, abs=0.04)
    sits = state_after("alley", "(ben sits against the wall)")
    assert sits.actors["ben"].posture == "floor"
    assert behind(sits, "ben") < 0.3


def test_where_there_is_no_wall_it_is_said() -> None:
    with pytest.raises(NoTrialError, match="cannot lean here: no wall near by"):
        stage_script(HEAD.format("desert") + "(anna leans against the wall) / (static full)\n", "s")
