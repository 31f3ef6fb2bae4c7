"""Story proposals on the library's own apartment: ways, seats, carried states, and what cannot be done."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache

import numpy as np
import pytest

from runtime.body.proportions import make_skeleton
from runtime.body.spec import BodySpec
from runtime.nav import grid_of
from runtime.world import World
from vdsl.lang import Report, Source, check, parse
from vdsl.lang.definitions.set import SetDef
from vdsl.lang.ir import Storyboard
from vdsl.library import Catalog
from vdsl.propose.cameras import Filming
from vdsl.propose.state import SceneState, opening_state
from vdsl.propose.story import begin, propose, tell
from vdsl.propose.types import StoryProposal
from vdsl.stage.world import build_world

HEAD = """storyboard "t"
character anna = woman
character ben = man
scene kitchen = apartment.kitchen
"""
FOLLOWED = """anna at door
ben at chair_2 sitting
(anna walk counter) / (follow full eye-level)  proposals 40
"""


@cache
def built(name: str) -> World:
    catalog = Catalog()
    definition = catalog.get("set", name)
    assert isinstance(definition, SetDef)
    return build_world(definition, catalog, "day", ("kitchen",))


@dataclass(frozen=True, eq=False)
class Played:
    storyboard: Storyboard
    filming: Filming
    states: list[SceneState]  # before every line, and after the last
    report: Report

    def stories(self, line: int) -> tuple[StoryProposal, ...]:
        return tell(self.states[line], self.storyboard.lines[line], self.filming).proposals


def play(lines: str, seed: int = 0) -> Played:
    script, report = parse(Source("t.vds", HEAD + lines))
    catalog = Catalog.for_script(script, report)
    storyboard = check(script, catalog, report)
    assert storyboard is not None, [(d.code, d.label) for d in report.diagnostics]
    world = built("apartment")
    skeletons = {"anna": make_skeleton(BodySpec(height=1.66)), "ben": make_skeleton(BodySpec(height=1.8))}
    filming = Filming(world, skeletons, 24.0, seed, room=("kitchen",), catalog=catalog)
    report = Report()
    states = [opening_state(storyboard.scenes[0], world, skeletons, report)]
    for line in storyboard.lines:
        states.append(begin(states[-1], line, filming, report).end)
    return Played(storyboard, filming, states, report)


def spot(path: tuple[str, ...], name: str) -> tuple[float, float, float]:
    item = next(o for o in built("apartment").objects if o.path == path)
    found = item.spot(name)
    assert found is not None
    return found.position


def test_a_scene_opens_as_it_is_written() -> None:
    played = play("anna at door facing window\nben at chair_2 sitting\n(anna wave ben)\n")
    anna, ben = played.states[0].actors["anna"], played.states[0].actors["ben"]
    assert not played.report.errors
    assert ben.posture == "sitting"
    assert ben.seat == spot(("kitchen", "chair_2"), "seat")
    assert anna.posture == "standing"
    window = next(o for o in built("apartment").objects if o.path == ("kitchen", "window"))
    to = math.atan2(window.centre[1] - anna.position[1], window.centre[0] - anna.position[0])
    assert math.cos(to - anna.heading) > 0.99


def test_unplaced_people_stand_free_and_apart() -> None:
    state = play("(anna wave ben)\n").states[0]
    places = np.array([a.position[:2] for a in state.actors.values()])
    assert np.linalg.norm(places[0] - places[1]) > 1.0
    assert grid_of(state.world).clearance_at(places).min() >= 0.25


def test_walking_ends_at_the_stand_and_never_in_furniture() -> None:
    played = play("anna at door\nben at chair_2 sitting\n(anna walk counter)\n")
    stories = played.stories(0)
    assert len({s.variant for s in stories}) >= 2
    assert len({s.path for s in stories}) >= 2
    stand = spot(("kitchen", "counter"), "stand")
    grid = grid_of(played.filming.world)
    for s in stories:
        walked = s.performances["anna"].position
        assert math.dist(walked[-1][:2], stand[:2]) < 0.15
        assert grid.clearance_at(walked[:, :2]).min() > 0.1
        apart = np.linalg.norm(walked[:, :2] - s.performances["ben"].position[:, :2], axis=1)
        assert apart.min() > 0.35


def test_all_proposals_of_a_line_begin_alike_and_the_state_carries_on() -> None:
    played = play("anna at counter\nben at chair_2 sitting\n(anna pick-up cup)\n(anna walk window)\n")
    cup = next(o.id for o in built("apartment").objects if o.path[-1] == "cup")
    held = dict((thing, hand) for hand, thing in played.states[1].actors["anna"].held)
    assert cup in held
    for s in played.stories(1):
        begin = s.performances["anna"].position[0]
        assert math.dist(begin[:2], played.states[1].actors["anna"].position[:2]) < 0.12
        # the cup goes where she goes
        away = np.linalg.norm(s.props[cup][:, :2, 3] - s.performances["anna"].position[:, :2], axis=1)
        assert away.max() < 0.9


def test_giving_fetches_the_thing_and_goes_to_the_person() -> None:
    played = play("anna at door\nben at chair_2 sitting\n(anna give cup to ben)\n")
    assert not played.report.errors
    cup = next(o.id for o in built("apartment").objects if o.path[-1] == "cup")
    end = played.states[1]
    assert cup in [thing for _, thing in end.actors["ben"].held]
    assert cup not in [thing for _, thing in end.actors["anna"].held]
    assert math.dist(end.actors["anna"].position[:2], end.actors["ben"].position[:2]) < 1.3


def test_sitting_takes_a_free_seat_and_reports_a_taken_one() -> None:
    played = play("anna at door\nben at chair_2 sitting\n(anna sit chair_1)\n")
    assert played.states[1].actors["anna"].posture == "sitting"
    taken = play("anna at door\nben at chair_2 sitting\n(anna sit chair_2)\n")
    (error,) = taken.report.errors
    assert error.code == "VDS171"
    assert error.span.text == "chair_2"
    assert "chair_1" in (error.help or "")
    assert taken.states[1].actors["anna"].posture == "standing"


ISLAND = """set pen {
    room cell, at (0, 0)m, size (6, 4, 2.6)m {
        place left = table(width 1m), at (1.2, 3.2)m
        place fence = counter(width 4m), at (3, 2)m, turn 90deg
        place right = table(width 1m), at (4.8, 3.2)m
    }
}
storyboard "t"
character anna = woman
scene here = pen.cell
anna at left
(anna walk right) / (static full eye-level)
"""


def test_a_target_that_cannot_be_reached_is_explained() -> None:
    script, report = parse(Source("t.vds", ISLAND))
    catalog = Catalog.for_script(script, report)
    storyboard = check(script, catalog, report)
    assert storyboard is not None, [(d.code, d.label) for d in report.diagnostics]
    definition = catalog.get("set", "pen")
    assert isinstance(definition, SetDef)
    world = build_world(definition, catalog, "day", ("cell",))
    skeletons = {"anna": make_skeleton(BodySpec())}
    filming = Filming(world, skeletons, 24.0, 0, room=("cell",), catalog=catalog)
    state = opening_state(storyboard.scenes[0], world, skeletons, report)
    end = begin(state, storyboard.lines[0], filming, report).end
    (error,) = report.errors
    assert error.code == "VDS170"
    assert error.span.text == "right"
    assert "fence" in error.label
    assert end.actors["anna"].position[0] < 3.0


def test_the_same_line_is_acted_the_same_way() -> None:
    text = FOLLOWED
    a, b, other = play(text), play(text), play(text, seed=5)
    one, two = a.stories(0), b.stories(0)
    for x, y in zip(one, two, strict=True):
        for name in x.performances:
            np.testing.assert_array_equal(
                x.performances[name].world_from_joint, y.performances[name].world_from_joint
            )
    three = other.stories(0)
    assert not np.array_equal(
        one[0].performances["anna"].world_from_joint[:20], three[0].performances["anna"].world_from_joint[:20]
    )


def test_a_line_becomes_a_grid_that_fills_its_budget() -> None:
    played = play(FOLLOWED)
    line = played.storyboard.lines[0]
    grid = propose(line, line.shots[0], played.states[0], played.filming)
    assert len(grid.cameras) == 40
    assert grid.subject == "anna"
    stories = {s.index for s in grid.story}
    shown = {c.story for c in grid.cameras}
    assert shown <= stories
    assert len(shown) >= len(stories) - 1 >= 3  # one goes where no camera sees it well
    assert grid.rejected["in_wall"] > 0


def test_a_thing_is_looked_for_at_its_middle() -> None:
    played = play("anna at counter\n(anna pick up coffee_pot) / (static medium eye-level)\n")
    story = played.stories(0)[0]
    pot = next(o for o in built("apartment").objects if o.path[-1] == "coffee_pot")
    middle = np.add(pot.low, pot.high) / 2
    assert pot.high[2] - pot.low[2] > 0.1
    np.testing.assert_allclose(story.interest[0][0], middle, atol=0.01)
    assert np.linalg.norm(story.interest[0][-1] - middle) > 0.1, "and where it is carried"


AWAY = "anna at counter\nben at fridge facing window\n"


def looks(played: Played, who: str = "ben", at: str = "anna", line: int = 0) -> float:
    """Radians between the way somebody faces at first and the way to another."""
    acted = played.stories(line)[0].performances
    to = acted[at].position[0] - acted[who].position[0]
    off = acted[who].heading[0] - np.arctan2(to[1], to[0])
    return float(abs(np.angle(np.exp(1j * off))))


def test_who_is_looked_past_faces_the_one_filmed() -> None:
    plain = play(AWAY + "(anna wave) / (static medium eye-level)\n")
    assert looks(plain) > 1.0
    assert looks(play(AWAY + "(anna wave) / (static medium eye-level ots ben)\n")) < 0.1


def test_any_shot_of_the_line_counts() -> None:
    """All shots of a line see the same performance."""
    assert looks(play(AWAY + "(anna wave) / (static full eye-level) / (static medium ots ben)\n")) < 0.1


def test_the_next_line_begins_as_this_one_ended() -> None:
    lines = "(anna wave) / (static medium ots ben)\n(anna nod) / (static full eye-level)\n"
    assert looks(play(AWAY + lines), line=1) < 0.3


def test_who_acts_or_sits_stays_as_the_line_has_it() -> None:
    both = "(anna wave) + (ben wave) / (static medium eye-level"
    assert looks(play(AWAY + f"{both} ots ben)\n")) == pytest.approx(looks(play(AWAY + f"{both})\n")))
    sits = "anna at counter\nben at chair_2 sitting\n(anna wave) / (static medium eye-level"
    assert looks(play(sits + " ots ben)\n")) == pytest.approx(looks(play(sits + ")\n")))


@pytest.mark.parametrize(
    ("action", "goes"),
    [("walk", True), ("run", True), ("crawl", True), ("wander", True), ("turn", False), ("talk", False)],
)
def test_who_is_to_go_and_nobody_says_where_to_goes_some_steps(action: str, goes: bool) -> None:
    """Once it was a shot of nine frames in which nobody moved."""
    played = play(f"(anna {action})\n")
    for story in played.stories(0):
        way = story.performances["anna"].position
        assert (float(np.linalg.norm(way[-1] - way[0])) > 1.2) == goes
        assert story.frames > 24


def test_a_line_that_is_begun_is_told_as_one_that_is_not() -> None:
    played = play(FOLLOWED)
    line, state = played.storyboard.lines[0], played.states[0]
    begun = begin(state, line, played.filming)
    told = tell(state, line, played.filming, begun=begun)
    anew = tell(state, line, played.filming)
    assert len(told.proposals) == len(anew.proposals) > 1
    for one, other in zip(told.proposals, anew.proposals, strict=True):
        assert (one.variant, one.path, one.frames) == (other.variant, other.path, other.frames)
        for name, moves in one.performances.items():
            np.testing.assert_array_equal(moves.world_from_joint, other.performances[name].world_from_joint)
    np.testing.assert_array_equal(told.end.actors["anna"].position, played.states[1].actors["anna"].position)
