"""People who are placed by somebody: face to face, side by side, and on the seat beside theirs."""

from __future__ import annotations

import math

import pytest

from vdsl.lang import Report, Source
from vdsl.lang.ir import Target
from vdsl.lang.source import Span
from vdsl.pipeline.compile import stage_acts
from vdsl.pipeline.script import ScriptError, check_source
from vdsl.propose.places import approach, near_on_foot, open_between
from vdsl.propose.state import SceneState

ANNA = Target("character", ("anna",), "anna", Span(Source("x.vds", ""), 0, 0))
HEAD = "character ben = man\ncharacter anna = woman\nscene s = {} at day\n"


def opened(place: str, *lines: str) -> SceneState:
    text = HEAD.format(place) + "\n".join((*lines, "(anna wave)\n"))
    return stage_acts(check_source(Source("x.vds", text), Report()))[0].state


@pytest.mark.parametrize("how", ["in front of", "at", "by", "near"])
def test_face_to_face(how: str) -> None:
    """Also where who is placed second is named first in the script."""
    state = opened("park", "anna at fountain", f"ben {how} anna")
    anna, ben = state.actors["anna"], state.actors["ben"]
    assert 0.7 < math.dist(anna.position, ben.position) < 1.5
    assert math.cos(anna.heading - ben.heading) < -0.7


@pytest.mark.parametrize("how", ["beside", "next to"])
def test_side_by_side(how: str) -> None:
    state = opened("park", "anna at the fountain", f"ben {how} anna")
    anna, ben = state.actors["anna"], state.actors["ben"]
    assert math.cos(anna.heading - ben.heading) > 0.99
    x, y = (b - a for a, b in zip(anna.position[:2], ben.position[:2], strict=True))
    ahead = x * math.cos(anna.heading) + y * math.sin(anna.heading)
    assert abs(ahead) < 0.45
    assert 0.6 < math.hypot(x, y) < 0.9


def test_facing_counts_for_who_is_placed_by_them() -> None:
    state = opened("park", "anna at fountain facing pond", "ben beside anna")
    assert math.cos(state.actors["anna"].heading - state.actors["ben"].heading) > 0.999
    state = opened("apartment.living", "anna at window facing sofa", "ben in front of anna")
    anna, ben = state.actors["anna"], state.actors["ben"]
    toward = math.atan2(ben.position[1] - anna.position[1], ben.position[0] - anna.position[0])
    assert math.cos(toward - anna.heading) > 0.4


def test_nobody_is_placed_behind_a_wall() -> None:
    state = opened("apartment", "anna at living.coats", "ben in front of anna")
    anna, ben = state.actors["anna"], state.actors["ben"]
    assert near_on_foot(state.world, anna.position, ben.position)


def test_nobody_comes_up_to_somebody_from_behind_the_shelf_they_look_at() -> None:
    """As to shake hands, with a bookshelf between."""
    state = opened("house.living", "anna at bookshelf facing bookshelf", "ben at stairs")
    anna, ben = state.actors["anna"], state.actors["ben"]
    stop = approach(ANNA, state, "ben", ben.position)
    assert stop is not None
    assert 0.7 < math.dist(anna.position[:2], (stop.x, stop.y)) < 1.5
    assert near_on_foot(state.world, anna.position, (stop.x, stop.y, stop.z))


def test_nobody_steps_up_to_somebody_through_a_tree() -> None:
    """Who does something to somebody comes nearer than they stand at first, straight on."""
    state = opened("park.lawn", "anna at tree_2 facing tree_2", "ben at bench")
    anna, ben = state.actors["anna"], state.actors["ben"]
    stop = approach(ANNA, state, "ben", ben.position)
    assert stop is not None
    assert open_between(state.world, anna.position, (stop.x, stop.y, stop.z))
    tree = next(item for item in state.world.objects if item.path[-1] == "tree_2")
    x, y = (2 * c - a for c, a in zip(tree.centre[:2], anna.position[:2], strict=True))
    assert not open_between(state.world, anna.position, (x, y, 0.0)), "on its other side"


def test_two_who_are_placed_by_each_other_are_an_error() -> None:
    report = Report()
    text = HEAD.format("park") + "anna facing pond\nben at anna\nanna at ben\n(anna wave)\n"
    with pytest.raises(ScriptError):
        check_source(Source("x.vds", text), report)
    assert [d.code for d in report.errors] == ["VDS077"]


def test_on_the_seat_beside_theirs() -> None:
    state = opened("apartment.living", "anna at sofa sitting", "ben beside anna sitting")
    anna, ben = state.actors["anna"], state.actors["ben"]
    assert ben.posture == "sitting"
    assert 0.4 < math.dist(anna.position, ben.position) < 2.0


def test_of_spots_of_several_rooms_that_where_others_are_is_taken() -> None:
    report = Report()
    text = HEAD.format("apartment") + "anna at kitchen.door\nben at middle\n(anna wave)\n"
    acts = stage_acts(check_source(Source("x.vds", text), report))
    anna, ben = acts[0].state.actors["anna"], acts[0].state.actors["ben"]
    kitchen = next(o for o in acts[0].staged.world.objects if o.path == ("kitchen",))
    for actor in (anna, ben):
        assert kitchen.low[0] - 0.5 < actor.position[0] < kitchen.high[0] + 0.5
        assert kitchen.low[1] - 0.5 < actor.position[1] < kitchen.high[1] + 0.5
    (warning,) = report.diagnostics
    assert warning.code == "VDS061"
    assert "`kitchen.middle` is taken" in warning.label
