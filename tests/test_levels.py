"""Floors at heights: rooms over rooms, stairs, platforms, the ways between them, and cameras up there."""

from __future__ import annotations

import numpy as np
import pytest
from test_hinges import Played

from runtime.body.skeleton import JOINT
from runtime.grid import grid_of
from runtime.nav import BODY_RADIUS, find_paths, level_at, nearest_free, obstacles, reachable
from runtime.world import World
from vdsl.cinema.space import stage_of
from vdsl.lang.definitions.set import SetDef, read_set
from vdsl.lang.diagnostics import Report
from vdsl.lang.parse import parse_definition
from vdsl.lang.source import Source
from vdsl.library.loader import Catalog
from vdsl.propose.story import propose
from vdsl.stage.floors import without
from vdsl.stage.world import build_world

HOUSE = """set home {
    room hall, at (0, 0)m, size (5, 6, 2.6)m {
        door, wall south, at 2.6m
        stairs, at (0.62, 0.9)m, width 1m, to landing
        platform dais, at (2.6, 3.6)m, size (2, 1.8, 0.5)m, steps south {
            place chair = chair, at (1, 1.2)m
            spot middle, at (1, 0.6)m
        }
        spot middle, at (3, 2)m
    }
    room landing, at (0, 0, 2.85)m, size (5, 6, 2.4)m {
        window, wall west, at 3m
        place table = table, at (3.4, 2)m
        spot middle, at (3, 4)m
    }
}
"""


def read(text: str = HOUSE) -> tuple[SetDef | None, Report]:
    report = Report()
    parsed = parse_definition(Source("test.vds", text), "set", "home", report)
    assert parsed is not None
    return read_set(parsed, report), report


def world(text: str = HOUSE) -> World:
    definition, report = read(text)
    assert definition is not None
    assert not report.errors, report.diagnostics
    return build_world(definition, Catalog())


HERE, UP, DAIS = (3.0, 2.0, 0.0), (3.0, 4.0, 2.85), (3.6, 4.2, 0.5)

# --- building ---------------------------------------------------------------------------


def test_floors_are_at_their_heights() -> None:
    home = world()
    assert [level.height for level in home.storeys] == [0.0, 0.5, 2.85]
    stairs = home.stairs[0] if home.stairs[0].high[2] > 1 else home.stairs[1]
    assert stairs.steps == 17
    assert stairs.rise == pytest.approx(2.85 / 17)
    assert stairs.run == pytest.approx(0.28)
    assert [level_at(home, p) for p in (HERE, UP, DAIS)] == [0, 2, 1]
    assert level_at(home, (3.0, 2.0)) == 0  # without a height the lowest
    by_path = {o.path: o for o in home.objects}
    assert by_path[("landing", "table")].low[2] == pytest.approx(2.85)
    assert by_path[("hall", "dais", "chair")].low[2] == pytest.approx(0.5, abs=0.01)
    stand = by_path[("landing", "table")].spot("stand")
    assert stand is not None
    assert stand.position[2] == pytest.approx(2.85)


def test_walls_stand_on_their_own_floor_and_close_the_gap_between() -> None:
    walls = world().walls
    assert len(walls) == 8
    assert sorted({w.base for w in walls}) == [0.0, 2.85]
    assert {round(w.base + w.height, 3) for w in walls} == {2.85, 5.25}


def test_the_floor_is_open_over_the_stairs() -> None:
    home = world()
    upper = home.storeys[2]
    assert not any(x0 < 0.62 < x1 and y0 < 4.0 < y1 for x0, y0, x1, y1 in upper.floors)
    assert sum((x1 - x0) * (y1 - y0) for x0, y0, x1, y1 in upper.floors) < 4.88 * 5.88 - 2.0
    up = home.mesh.normals[home.mesh.faces[:, 0], 2] > 0.99
    middle = home.mesh.vertices[home.mesh.faces].mean(axis=1)
    above = up & (abs(middle[:, 2] - 2.85) < 1e-3) & (abs(middle[:, 0] - 0.62) < 0.4)
    assert not (above & (abs(middle[:, 1] - 4.0) < 0.8)).any()


def test_rectangles_less_others() -> None:
    left = without((0, 0, 4, 4), [(1, 1, 2, 2), (3, 3, 9, 9)])
    assert sum((c - a) * (d - b) for a, b, c, d in left) == pytest.approx(16 - 1 - 1)


@pytest.mark.parametrize(
    "entry",
    [
        "stairs, at (1, 1)m, to attic",
        "stairs, at (1, 1)m, to hall",
        "stairs, at (1, 1)m, height 2m, rise 50cm",
    ],
)
def test_stairs_to_nowhere_are_a_mistake(entry: str) -> None:
    _, report = read(HOUSE.replace("stairs, at (0.62, 0.9)m, width 1m, to landing", entry))
    assert [d.code for d in report.diagnostics] == ["VDS241"]


def test_stairs_need_an_end() -> None:
    _, report = read(HOUSE.replace(", to landing", ""))
    assert [d.code for d in report.diagnostics] == ["VDS029"]


# --- ways -------------------------------------------------------------------------------


@pytest.mark.parametrize(("start", "goal"), [(HERE, UP), (UP, HERE), (HERE, DAIS), (DAIS, UP)])
def test_a_way_goes_over_the_steps(start: tuple[float, ...], goal: tuple[float, ...]) -> None:
    home = world()
    paths = find_paths(home, start, goal, 3)
    assert paths
    for path in paths:
        np.testing.assert_allclose(path[[0, -1]], [start, goal], atol=1e-9)
        assert np.linalg.norm(np.diff(path, axis=0), axis=1).max() < 0.2
        flat = np.linalg.norm(np.diff(path[:, :2], axis=0), axis=1)
        assert (np.abs(np.diff(path[:, 2])) <= 0.95 * flat + 1e-6).all()  # never steeper than the steps
        for height in {p[2] for p in (start, goal)}:
            on = path[np.abs(path[:, 2] - height) < 1e-6]
            ends = np.array([end for s in home.stairs for end in (s.low, s.high)])
            near = np.linalg.norm(on[:, None] - ends, axis=2).min(axis=1)
            level = level_at(home, (*on[0, :2].tolist(), height))
            assert grid_of(home, level).clearance_at(on[near > 0.95]).min(initial=9.0) >= 0.9 * BODY_RADIUS
        climbing = path[(path[:, 2] > 0.6) & (path[:, 2] < 2.8)]
        assert (np.abs(climbing[:, 0] - 0.62) < 0.3).all()  # on the flight, nowhere else


def test_nothing_joins_floors_without_stairs() -> None:
    home = world(HOUSE.replace("stairs, at (0.62, 0.9)m, width 1m, to landing", ""))
    assert not reachable(home, HERE, UP)
    assert find_paths(home, HERE, UP, 3) == []
    assert obstacles(home, HERE, UP) == []
    assert reachable(home, HERE, DAIS)
    bare = world(HOUSE.replace(", steps south", ""))
    assert not reachable(bare, HERE, DAIS)


def test_the_nearest_free_place_is_on_the_floor_that_is_meant() -> None:
    home = world()
    below, above = nearest_free(home, (3.4, 2.0, 0.0)), nearest_free(home, (3.4, 2.0, 2.85))
    assert below is not None
    assert above is not None
    assert below[2] == 0.0
    assert above[2] == pytest.approx(2.85)
    assert np.hypot(below[0] - 3.4, below[1] - 2.0) < 0.1  # the table is upstairs
    assert np.hypot(above[0] - 3.4, above[1] - 2.0) > 0.5
    assert nearest_free(home, (3.4, 2.0, 2.85), start=HERE) == above


def test_people_are_in_the_way_on_their_own_floor_only() -> None:
    home = world()
    (path,) = find_paths(home, HERE, (1.8, 3.4, 0.0), people=((2.4, 2.7, 0.4, 2.85),))
    straight = np.hypot(1.2, 1.4)
    assert np.linalg.norm(np.diff(path, axis=0), axis=1).sum() == pytest.approx(straight, rel=0.02)


# --- cameras ----------------------------------------------------------------------------


def test_cameras_are_in_the_room_of_their_subject() -> None:
    home = world()
    assert stage_of(home, np.array([HERE])).ceiling == pytest.approx(2.6)
    assert stage_of(home, np.array([UP])).ceiling == pytest.approx(5.25)
    assert stage_of(home, np.array([HERE, UP])).ceiling == pytest.approx(5.25)
    assert len(stage_of(home, np.array([UP])).rooms) == 1


# --- in a story -------------------------------------------------------------------------

FLAT = "\n" + HOUSE.replace("set home", "set flat")


def test_somebody_goes_upstairs_and_cameras_stay_up_there_with_her() -> None:
    played = Played("(anna walk table) / (static full eye-level) proposals 12\n", "anna at hall.middle", FLAT)
    assert not played.codes
    for motion in played.motions[0]:
        assert motion.position["anna"][-1, 2] == pytest.approx(2.85)
        soles = [JOINT["toe_l"], JOINT["toe_r"]]
        low = motion.world_from_joint["anna"][:, soles][..., 2, 3].min(axis=1)
        assert (low > motion.position["anna"][:, 2] - 0.3).all()
    again = Played("(anna wave) / (static full low-angle) proposals 12\n", "anna at landing.middle", FLAT)
    line = again.lines[0]
    grid = propose(line, line.shots[0], again.states[0], again.filming)
    assert len(grid.cameras) > 4
    for camera in grid.cameras:
        assert camera.track.position[:, 2].min() > 2.85 + 0.1


def test_what_is_missing_is_said() -> None:
    bare = FLAT.replace("stairs, at (0.62, 0.9)m, width 1m, to landing", "")
    played = Played("(anna walk table)\n", "anna at hall.middle", bare)
    (found,) = played.report.diagnostics
    assert found.code == "VDS170"
    assert "no stairs lead there" in found.label
    walled = FLAT.replace("spot middle, at (3, 2)m", "spot middle, at (3, 2)m\n" + WALL)
    played = Played("(anna walk table)\n", "anna at hall.middle", walled)
    assert [d.code for d in played.report.diagnostics] == ["VDS170"]
    assert "`wardrobe`" in played.report.diagnostics[0].label


WALL = "        repeat i 4 { place wardrobe = wardrobe, at (1.7, 0.85 + i * 1.5)m, turn 90deg }"
