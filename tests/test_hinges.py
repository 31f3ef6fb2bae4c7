"""What opens: parts of props, hands that follow their handles, doors on the way, and what stays open."""

from __future__ import annotations

import numpy as np
import pytest

from runtime.body.skeleton import JOINT
from runtime.motion.types import SceneMotion
from runtime.nav import BODY_RADIUS
from runtime.world import World, WorldObject
from vdsl.lang import Report, Source, Storyboard, check, parse
from vdsl.lang.definitions.prop import PropDef, read_prop
from vdsl.lang.parse import parse_definition
from vdsl.library.loader import Catalog
from vdsl.pipeline.staging import Stagehand
from vdsl.propose.cameras import Filming
from vdsl.propose.opening import parts_of, ways_through
from vdsl.propose.state import SceneState, opening_state
from vdsl.propose.story import motions, tell

BOX = """prop chest {
    box (40cm, 30cm, 2cm)
    hinge lid, at (0, 15cm, 20cm), axis x, open -100deg, ajar -25deg {
        box (40cm, 30cm, 2cm), at (0, 0, 20cm)
        spot handle, at (0, -15cm, 21cm)
    }
    repeat i 2 {
        slide drawer, along (0, -2, 0), open 20cm { box (30cm, 2cm, 8cm), at (0, -15cm, i * 9cm) }
    }
}
"""
FLAT = """
set flat {
    room hall, at (0, 0)m, size (4, 5, 2.6)m {
        door, wall east, at 2.5m, to den
        place fridge = fridge, wall north, at 1m
        spot middle, at (2, 2.5)m
    }
    room den, at (4, 0)m, size (4, 5, 2.6)m {
        place table = table, wall east, at 2.5m
        spot middle, at (1.8, 2.5)m
    }
}
"""


def prop(text: str, report: Report | None = None) -> PropDef:
    found = report if report is not None else Report()
    parsed = parse_definition(Source("test.vds", text), "prop", "chest", found)
    assert parsed is not None
    made = read_prop(parsed, found)
    assert made is not None
    return made


class Played:
    """A script played line by line: its state before each line, what was reported, and the motions."""

    def __init__(self, lines: str, people: str = "anna at hall.middle", sets: str = FLAT) -> None:
        self.report = Report()
        text = (
            "character anna = woman\ncharacter ben = man\nscene one = flat\n" + people + "\n" + lines + sets
        )
        script, _ = parse(Source("test.vds", text), self.report)
        catalog = Catalog.for_script(script, self.report)
        storyboard = check(script, catalog, self.report)
        assert isinstance(storyboard, Storyboard), self.report.diagnostics
        staged = Stagehand(catalog).stage(storyboard.scenes[0], storyboard.characters, storyboard.lines)
        skeletons = {name: body.skeleton for name, body in staged.bodies.items()}
        self.filming = Filming(staged.world, skeletons, 24.0, 1, catalog=catalog)
        first = opening_state(storyboard.scenes[0], staged.world, skeletons, self.report)
        self.states: list[SceneState] = [first]
        self.motions: list[list[SceneMotion]] = []
        self.lines = storyboard.lines
        for line in storyboard.lines:
            state = self.states[-1]
            self.motions.append([m for _, m in motions(state, line, self.filming, Report())])
            self.states.append(tell(state, line, self.filming, self.report).end)

    @property
    def codes(self) -> list[str]:
        return [d.code for d in self.report.diagnostics]


def part(world: World, *path: str) -> WorldObject:
    return next(o for o in world.objects if o.path == path)


# --- the language -----------------------------------------------------------------------


def test_parts_are_read_with_names_of_their_own() -> None:
    chest = prop(BOX)
    assert chest.parts == ("lid", "drawer", "drawer_2")
    assert chest.spots == ("handle",)
    lid, drawer, _ = chest.shape().parts
    assert lid.axis == (1.0, 0.0, 0.0)
    assert lid.open == pytest.approx(np.radians(-100))
    assert lid.ajar == pytest.approx(0.25)
    assert drawer.axis == (0.0, -1.0, 0.0)  # a direction, however long
    assert drawer.open == pytest.approx(0.2)


@pytest.mark.parametrize("entry", ["hinge lid, open 0deg { box (1, 1, 1)m }", "slide drawer { }"])
def test_a_part_that_does_not_move_is_a_mistake(entry: str) -> None:
    report = Report()
    prop(f"prop chest {{\n    box (1, 1, 1)m\n    {entry}\n}}", report)
    assert [d.code for d in report.diagnostics] == ["VDS240"]


def test_every_part_of_the_library_moves_clear_of_the_floor() -> None:
    catalog = Catalog()
    seen = 0
    for name in catalog.names("prop"):
        found = catalog.get("prop", name)
        assert isinstance(found, PropDef)
        for one in found.shape().parts:
            seen += 1
            assert one.shape.primitives, (name, one.name)
            assert one.kind == "slide" or abs(one.open) <= np.pi, (name, one.name)
    assert seen > 20


# --- in the world -----------------------------------------------------------------------


def test_a_leaf_turns_about_its_hinge_and_takes_its_handle_along() -> None:
    played = Played("(anna walk table)")
    world = played.states[0].world
    leaf = part(world, "hall", "door", "leaf")
    assert leaf.hinge is not None
    closed, wide = leaf.hinge.matrices(0.0), leaf.hinge.matrices(1.0)
    np.testing.assert_allclose(closed @ [*leaf.hinge.pivot, 1], wide @ [*leaf.hinge.pivot, 1], atol=1e-9)
    swung = leaf.hinge.matrices(np.array([0.0, 0.5, 1.0]))
    assert swung.shape == (3, 4, 4)
    moved = world.opened({leaf.id: 1.0})
    after = part(moved, "hall", "door", "leaf")
    handle, owner = after.spot("handle"), part(moved, "hall", "door").spot("handle")
    assert handle is not None
    assert owner == handle
    expected = wide @ [*leaf.hinge.handle, 1]
    np.testing.assert_allclose(handle.position, expected[:3], atol=1e-6)
    np.testing.assert_allclose(leaf.world_from_object, closed, atol=1e-12)  # the world before is untouched
    rows = world.solids.object == leaf.id
    assert np.abs(moved.solids.centre[rows] - world.solids.centre[rows]).max() > 0.2
    assert world.opened({leaf.id: 0.0}) is world


# --- opening and closing ----------------------------------------------------------------


def test_the_hand_stays_on_the_handle_and_what_is_opened_stays_open() -> None:
    played = Played("(anna open fridge)\n(anna walk table)\n(anna close fridge)\n")
    door = part(played.states[0].world, "hall", "fridge", "door")
    assert door.hinge is not None
    for motion in played.motions[0]:
        track = motion.props[door.id].astype(float)
        handle = track[:, :3, :3] @ door.hinge.handle + track[:, :3, 3]
        swing = np.linalg.norm(handle - handle[0], axis=1)
        held = (swing > 0.02) & (swing < 0.45 * swing.max())
        joints = motion.world_from_joint["anna"][:, [JOINT["hand_l"], JOINT["hand_r"]]][..., :3, 3]
        away = np.linalg.norm(joints - handle[:, None], axis=2).min(axis=1)
        assert away[held].max() < 0.16  # the wrist is a palm's length from it
        body = motion.position["anna"][:, :2]
        edge = handle[:, :2]
        assert np.linalg.norm(body - edge, axis=1).min() > 0.2  # nobody is hit by the door
    opens = [state.props[door.id].open for state in played.states]
    assert opens == pytest.approx([0.0, 1.0, 1.0, 0.0], abs=1e-6)
    assert part(played.states[2].world, "hall", "fridge", "door").ajar == pytest.approx(1.0)
    assert not played.codes


def test_what_is_open_or_does_not_open_is_told_kindly() -> None:
    played = Played(
        "(anna close fridge)\n(anna open fridge.freezer)\n(anna open fridge.freezer)\n(anna open table)\n"
    )
    assert played.codes == ["VDS243", "VDS243", "VDS242"]
    assert not played.report.has_errors
    freezer = part(played.states[0].world, "hall", "fridge", "freezer")
    assert [s.props[freezer.id].open > 0.5 for s in played.states] == [False, False, True, True, True]


def test_the_handiest_part_is_meant() -> None:
    world = Played("(anna walk table)").states[0].world
    parts = parts_of(part(world, "hall", "fridge"), world)
    assert [p.path[-1] for p in parts] == ["door", "freezer"]


# --- doors on the way -------------------------------------------------------------------


def crossed(motion: SceneMotion, who: str, leaf: WorldObject) -> float:
    """Least distance of the body's middle from the leaf's box over the shot, on the floor plan."""
    assert leaf.hinge is not None
    best = np.inf
    track = motion.props[leaf.id].astype(float)
    for t in range(motion.frames):
        local = np.linalg.inv(track[t]) @ [*motion.position[who][t], 1.0]
        gap = np.abs(local[:2] - leaf.hinge.boxes[0, 0, :2]) - leaf.hinge.boxes[0, 1, :2]
        best = min(best, float(np.linalg.norm(np.maximum(gap, 0.0))))
    return best


@pytest.mark.parametrize("start", ["hall", "den"])
def test_a_shut_door_is_opened_on_the_way(start: str) -> None:
    other = {"hall": "den", "den": "hall"}[start]
    played = Played(f"(anna walk {other}.middle)\n", f"anna at {start}.middle")
    leaf = part(played.states[0].world, "hall", "door", "leaf")
    assert leaf.ajar == 0.0
    assert len(played.motions[0]) >= 3
    for motion in played.motions[0]:
        assert crossed(motion, "anna", leaf) > 0.12
        assert motion.end_props[leaf.id].open == pytest.approx(1.0)
        assert np.hypot(*(motion.position["anna"][-1, :2] - motion.position["anna"][0, :2])) > 2.5
    assert not played.codes


def test_the_second_finds_the_door_open() -> None:
    played = Played("(anna walk den.middle)\n(ben walk table)\n", "anna at hall.middle\nben at fridge")
    leaf = part(played.states[0].world, "hall", "door", "leaf")
    for motion in played.motions[1]:
        assert np.ptp(motion.props[leaf.id], axis=0).max() == 0.0
        assert crossed(motion, "ben", leaf) > 0.12


def test_ways_through_an_open_door_pass_no_handle() -> None:
    world = Played("(anna walk table)").states[0].world
    leaf = part(world, "hall", "door", "leaf")
    ((_, doors), *_) = ways_through(world, (2.0, 2.5, 0.0), (5.8, 2.5, 0.0), 3, ())
    assert [d.object for d in doors] == [leaf.id]
    ajar = world.opened({leaf.id: 0.9})
    found = ways_through(ajar, (2.0, 2.5, 0.0), (5.8, 2.5, 0.0), 3, ())
    assert found
    assert all(not doors for _, doors in found)
    assert ways_through(world, (2.0, 2.5, 0.0), (5.8, 2.5, 0.0), 1, ((4.0, 2.5, 0.9),)) == []
    assert BODY_RADIUS == 0.25
