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
    """After the last line; those before it are people's places, and lines without a camera."""
    lines = tuple(f"{line} / (static full)" if line.startswith("(") else line for line in lines)
    last = sum(line.startswith("(") for line in lines) - 1
    act = stage_script(HEAD.format(place) + "\n".join(lines) + "\n", "s", line=last)
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
        ("apartment.kitchen", "(anna leans against the window)"),
        ("apartment.living", "(anna leans against the armchair)"),
        ("classroom", "(anna leans against the blackboard)"),
        ("house.hall", "(anna leans against the wardrobe)"),
    ],
)
def test_the_back_is_to_what_one_leans_against(place: str, line: str) -> None:
    state = state_after(place, line)
    assert behind(state, "anna") == pytest.approx(0.3, abs=0.04)


def test_two_lean_beside_each_other() -> None:
    state = state_after("alley", "anna at door", "ben at fence", "(they lean against the wall)")
    anna, ben = (state.actors[who].position for who in ("anna", "ben"))
    assert math.dist(anna, ben) > 0.4
    assert behind(state, "ben") == pytest.approx(0.3, abs=0.04)


@pytest.mark.parametrize(
    ("place", "first"),
    [
        ("apartment.living", "(anna sits against the wall)"),
        ("hospital.corridor", "(anna sits against the wall)"),
        ("alley", "(anna leans against the wall)"),
    ],
)
def test_nobody_sits_down_where_somebody_is(place: str, first: str) -> None:
    state = state_after(place, first, "(ben walks to anna)", "(ben sits against the wall)")
    anna, ben = (state.actors[who].position for who in ("anna", "ben"))
    assert state.actors["ben"].posture == "floor"
    assert math.dist(anna[:2], ben[:2]) > 0.5


@pytest.mark.parametrize(
    ("place", "where"), [("apartment.kitchen", "anna at door"), ("apartment.living", "anna at tv_stand")]
)
def test_nobody_sits_down_in_furniture(place: str, where: str) -> None:
    state = state_after(place, where, "(anna slides down the wall)")
    assert 0.1 < behind(state, "anna") < 0.3
    x, y, _ = state.actors["anna"].position
    inside = [
        item.path
        for item in state.world.objects
        if item.kind != "room"
        and item.low[2] < 0.5
        and item.low[0] < x < item.high[0]
        and item.low[1] < y < item.high[1]
    ]
    assert not inside


def test_the_wall_is_one_of_the_room() -> None:
    state = state_after("apartment.kitchen", "anna at counter_2", "(anna leans against the wall)")
    kitchen = next(item for item in state.world.objects if item.path == ("kitchen",))
    assert kitchen.low[0] < state.actors["anna"].position[0] < kitchen.high[0]


def test_where_there_is_no_wall_it_is_said() -> None:
    with pytest.raises(NoTrialError, match="cannot lean here: no wall near by"):
        stage_script(HEAD.format("desert") + "(anna leans against the wall) / (static full)\n", "s")
