"""Seats that are not named: at a table, beside somebody, at one of several desks."""

from __future__ import annotations

import math

from vdsl.pipeline.trial import stage_script
from vdsl.propose.state import SceneState
from vdsl.propose.story import tell

HEAD = 'storyboard "S"\ncharacter anna = woman\ncharacter ben = man\nscene s = {} at day\n'


def state_after(place: str, *lines: str) -> SceneState:
    act = stage_script(HEAD.format(place) + "\n".join(lines) + " / (static full)\n", "s")
    return tell(act.state, act.line, act.filming, shot=act.line.shots[0]).end


def test_one_sits_at_a_table_on_a_chair_drawn_up_to_it() -> None:
    placed = stage_script(
        HEAD.format("apartment.kitchen") + "anna at table sitting\n(anna nod) / (static)\n", "s"
    )
    anna = placed.state.actors["anna"]
    table = next(o for o in placed.filming.world.objects if o.path[-1] == "table")
    assert anna.posture == "sitting"
    away = [
        max(low - p, p - high, 0.0)
        for p, low, high in zip(anna.position[:2], table.low, table.high, strict=False)
    ]
    assert math.hypot(*away) < 0.8
    ahead = (table.centre[0] - anna.position[0], table.centre[1] - anna.position[1])
    assert math.cos(anna.heading) * ahead[0] + math.sin(anna.heading) * ahead[1] > 0.5 * math.hypot(*ahead)


def test_one_sits_beside_somebody_on_the_nearest_seat_that_is_free() -> None:
    state = state_after(
        "apartment.kitchen", "anna at chair_2 sitting", "ben at door", "(ben sits next to anna)"
    )
    anna, ben = state.actors["anna"], state.actors["ben"]
    assert ben.posture == "sitting"
    assert 0.4 < math.dist(anna.position, ben.position) < 2.3


def test_two_people_at_desk_are_at_two_desks() -> None:
    state = state_after("office", "anna at desk sitting", "ben at door", "(ben sits at desk)")
    anna, ben = state.actors["anna"], state.actors["ben"]
    assert anna.posture == ben.posture == "sitting"
    assert math.dist(anna.position, ben.position) > 1.0


def test_one_walks_to_a_table_and_not_to_its_chairs() -> None:
    state = state_after("apartment.kitchen", "anna at door", "ben at window", "(anna walks to the table)")
    seats = [s.position for o in state.world.objects for s in o.spots if s.name.startswith("seat")]
    x, y, _ = state.actors["anna"].position
    assert state.actors["anna"].posture == "standing"
    table = next(o for o in state.world.objects if o.path[-1] == "table")
    away = [max(low - p, p - high, 0.0) for p, low, high in zip((x, y), table.low, table.high, strict=False)]
    assert math.hypot(*away) < 0.7
    assert seats


def test_two_may_be_placed_at_what_is_counted() -> None:
    text = HEAD.format("office") + "anna at desk sitting\nben at desk sitting\n(anna nod) / (static)\n"
    people = stage_script(text, "s").state.actors
    assert people["anna"].posture == people["ben"].posture == "sitting"
    assert math.dist(people["anna"].position, people["ben"].position) > 0.5
