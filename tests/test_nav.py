"""Ways across floors: clear of everything, truly different, the same every time."""

from __future__ import annotations

import numpy as np
import pytest
from filmset import thing, world

from runtime.nav import BODY_RADIUS, find_paths, grid_of, nearest_free, obstacles, reachable

TABLE = (2.5, 1.5, 0.37, 0.6, 0.4, 0.37, 0.3)
ROOM = (0.0, 0.0, 5.0, 3.0)


def length(path: np.ndarray) -> float:
    return float(np.linalg.norm(np.diff(path, axis=0), axis=1).sum())


def test_the_way_round_a_table_keeps_the_body_s_radius() -> None:
    place = world((ROOM,), (TABLE,))
    (path,) = find_paths(place, (0.5, 1.5), (4.5, 1.5))
    np.testing.assert_allclose(path[[0, -1]], [(0.5, 1.5, 0), (4.5, 1.5, 0)])
    assert grid_of(place).clearance_at(path).min() >= BODY_RADIUS
    assert 4.0 < length(path) < 5.0
    # independent of the grid: no point is within the radius of the turned table
    d = path[:, :2] - np.array((2.5, 1.5))
    c, s = np.cos(0.3), np.sin(0.3)
    q = np.abs(np.stack([c * d[:, 0] + s * d[:, 1], c * d[:, 1] - s * d[:, 0]], axis=1)) - (0.6, 0.4)
    assert np.linalg.norm(np.maximum(q, 0), axis=1).min() > BODY_RADIUS - 0.05


def test_several_ways_are_truly_different() -> None:
    place = world((ROOM,), (TABLE,))
    paths = find_paths(place, (0.5, 1.5), (4.5, 1.5), 2)
    assert len(paths) == 2
    sides = {bool(p[np.abs(p[:, 0] - 2.5).argmin(), 1] > 1.5) for p in paths}
    assert sides == {True, False}


def test_ways_are_smooth() -> None:
    for path in find_paths(world((ROOM,), (TABLE,)), (0.5, 0.4), (4.5, 2.6), 3):
        step = np.diff(path, axis=0)
        heading = np.unwrap(np.arctan2(step[:, 1], step[:, 0]))
        assert np.abs(np.diff(heading)).max() < np.radians(50)
        assert np.linalg.norm(step, axis=1).max() < 0.12


def test_low_things_are_stepped_over_and_high_ones_passed_under() -> None:
    rug, lamp = (2.5, 1.5, 0.02, 0.8, 1.5, 0.02, 0.0), (2.5, 1.5, 2.2, 0.8, 1.5, 0.3, 0.0)
    (path,) = find_paths(world((ROOM,), (rug, lamp)), (0.5, 1.5), (4.5, 1.5))
    assert length(path) == pytest.approx(4.0, abs=0.02)


def test_floors_join_through_a_door_and_not_through_a_wall() -> None:
    rooms = ((0.0, 0.0, 2.0, 3.0), (2.1, 0.0, 4.0, 3.0))
    assert not reachable(world(rooms), (1.0, 1.5), (3.0, 1.5))
    assert find_paths(world(rooms), (1.0, 1.5), (3.0, 1.5)) == []
    door = (1.9, 2.0, 2.2, 2.85)
    (path,) = find_paths(world((*rooms, door)), (1.0, 0.5), (3.0, 0.5))
    crossing = path[np.abs(path[:, 0] - 2.05).argmin()]
    assert 2.25 <= crossing[1] <= 2.6


def test_people_are_walked_around() -> None:
    place = world((ROOM,))
    (path,) = find_paths(place, (0.5, 1.5), (4.5, 1.5), people=((2.5, 1.5, 0.22),))
    assert np.linalg.norm(path[:, :2] - (2.5, 1.5), axis=1).min() >= 0.22 + BODY_RADIUS - 0.03


def test_what_stands_in_the_way_is_named() -> None:
    shelf = (2.5, 1.5, 1.0, 0.2, 1.5, 1.0, 0.0)
    place = world((ROOM,), (shelf,), objects=(thing(0, "shelf", (2.3, 0, 0), (2.7, 3, 2)),))
    assert find_paths(place, (0.5, 1.5), (4.5, 1.5)) == []
    assert obstacles(place, (0.5, 1.5), (4.5, 1.5)) == [0]


def test_the_nearest_free_place_is_beside_the_table_on_the_right_side() -> None:
    place = world((ROOM,), (TABLE,))
    spot = nearest_free(place, (2.5, 1.5))
    assert spot is not None
    assert 0.6 < np.hypot(spot[0] - 2.5, spot[1] - 1.5) < 0.8
    cut = world(((0.0, 0.0, 2.0, 3.0), (2.1, 0.0, 4.0, 3.0)))
    beside = nearest_free(cut, (2.2, 1.0), start=(1.0, 1.0))
    assert beside is not None
    assert beside[0] < 2.0


def test_the_same_question_has_the_same_answer() -> None:
    a = find_paths(world((ROOM,), (TABLE,)), (0.5, 1.0), (4.5, 2.0), 3)
    b = find_paths(world((ROOM,), (TABLE,)), (0.5, 1.0), (4.5, 2.0), 3)
    assert len(a) == len(b)
    for p, q in zip(a, b, strict=True):
        np.testing.assert_array_equal(p, q)
