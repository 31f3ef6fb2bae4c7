"""What pictures show in place of lines of sight: what hides whom, by how much, and what is asked of whom."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from company import FILMING, FRAMES, takes_of, two
from filmset import shot, world

from runtime.world import World
from vdsl.cinema.looking import Lines, Shown
from vdsl.cinema.measures import measure
from vdsl.cinema.takes import Pictures, samples
from vdsl.propose.subjects import subject_of

EYE, AIM = (3.5, 0.0, 1.4), (0.0, 0.0, 1.3)
SIDE = 64
PEOPLE = ("anna", "ben")


def pictures(what: int, near: float, rows: slice = slice(None), over: tuple[str, ...] = ()) -> Pictures:
    """Of one take: so much is so near in these rows, and nothing behind it."""
    count = len(samples(FRAMES))
    depth = np.full((1, count, SIDE, SIDE), np.inf, np.float32)
    kinds = np.zeros((1, count, SIDE, SIDE), np.uint8)
    depth[:, :, rows], kinds[:, :, rows] = near, what
    return Pictures(depth, kinds, PEOPLE, over)


def measured(
    shown: Pictures | None,
    ground: World = FILMING.world,
    eye: tuple[float, float, float] = EYE,
    aim: tuple[float, float, float] = AIM,
    beside: tuple[float, float] = (0.0, 0.9),
) -> dict[str, float]:
    subject = subject_of(shot(scale="medium"), two(beside), FILMING)
    takes = replace(takes_of("medium", "person", eye, aim), pictures=shown)
    return {k: float(v[0]) for k, v in measure(takes, subject, ground, 24.0).values.items()}


@pytest.mark.parametrize(
    ("what", "near", "seen"),
    [
        (Pictures.THING, 2.0, False),
        (Pictures.THING, 3.4, True),  # as near as what one sits on
        (Pictures.MOVED, 3.2, True),  # in the hand
        (Pictures.MOVED, 2.0, False),
        (Pictures.NOTHING, 2.0, True),  # what is filmed
        (Pictures.FIRST, 2.0, True),  # her own body, of which what is behind it is no less there
        (Pictures.FIRST + 1, 2.0, False),
    ],
)
def test_what_is_drawn_before_somebody_hides_them(what: int, near: float, seen: bool) -> None:
    found = measured(pictures(what, near))
    assert found["visibility"] == (1.0 if seen else 0.0)
    assert found["head_visible"] == (1.0 if seen else 0.0)


def test_a_branch_that_is_no_box_is_in_the_way() -> None:
    clear, hidden = (measured(shown) for shown in (None, pictures(Pictures.THING, 1.0)))
    assert clear["foreground"] == 0.0
    assert hidden["foreground"] == 1.0
    assert measured(pictures(Pictures.THING, 1.0, slice(0, SIDE // 8)))["foreground"] == 0.0


def test_a_thing_is_in_the_way_wherever_it_is_in_a_picture() -> None:
    """A basin a third of the way to her: eight looks across a picture go by it on either side."""
    basin = pictures(Pictures.THING, np.inf)
    basin.depth[..., SIDE // 2 - 12 : SIDE // 2 + 12, SIDE // 2 - 6 : SIDE // 2 + 6] = 1.0
    assert measured(basin)["foreground"] == pytest.approx(24 * 12 / SIDE**2, abs=0.05)


def test_no_picture_is_left_out_in_which_something_is_in_the_way() -> None:
    passing = pictures(Pictures.THING, np.inf)
    passing.depth[:, [2, 5]] = 1.0
    assert measured(passing)["foreground"] == pytest.approx(2 / len(samples(FRAMES)))


def test_the_ground_one_looks_down_on_is_not_in_the_way() -> None:
    eye, aim = (3.5, 0.0, 0.8), (2.9, 0.0, 0.0)
    lens = takes_of("medium", "person", eye, aim).track
    ahead = np.subtract(aim, eye) / np.linalg.norm(np.subtract(aim, eye))
    above = np.array((ahead[2], 0.0, -ahead[0]))
    across = ((np.arange(SIDE) + 0.5) / SIDE - 0.5) * lens.sensor[1] / lens.focal[0, 0]
    down = -(ahead[2] - across * above[2])  # of the rays of each row, for a metre along the axis
    floor = pictures(Pictures.THING, 0.0)
    floor.depth[:] = np.where(down > 0.0, eye[2] / np.maximum(down, 1e-6), np.inf)[:, None]
    assert measured(floor, eye=eye, aim=aim)["foreground"] == 0.0
    floor.depth[:] = np.minimum(floor.depth, 0.3)
    assert measured(floor, eye=eye, aim=aim)["foreground"] > 0.5


def test_one_who_is_quite_behind_another_is_not_apart_from_them() -> None:
    eye, aim = (4.0, 0.0, 1.5), (0.0, 0.0, 1.5)
    ben_alone = pictures(Pictures.FIRST + 1, 2.0)
    found = measured(ben_alone, eye=eye, aim=aim, beside=(1.0, 0.02))
    assert found["heads"] < 0.6
    assert found["together"] > 0.8


def test_a_head_behind_the_own_back_is_none_though_no_line_is_cut() -> None:
    assert measured(None)["heads"] == 1.0
    bent = measured(pictures(Pictures.FIRST, 3.0))  # her body, half a metre before where her head is
    assert bent["legible"] == 0.0
    assert bent["heads"] < 0.6
    assert measured(pictures(Pictures.FIRST, 3.4))["legible"] > 0.75


def test_over_whose_shoulder_one_looks_is_not_in_the_way_but_hides_a_face() -> None:
    ben = Pictures.FIRST + 1
    found = measured(pictures(ben, 1.0, over=("ben",)))
    assert found["foreground"] == 0.0
    assert found["visibility"] == 1.0
    assert found["legible"] == 0.0
    assert measured(pictures(ben, 1.0))["foreground"] == 1.0


@pytest.mark.parametrize("away", [0.5, 0.18])
def test_who_is_filmed_with_somebody_hides_them_as_far_as_pictures_show_it(away: float) -> None:
    """Of two who hug it counts what is seen of either, however near they are to each other."""
    told = two((-0.3, 0.5))
    subject = subject_of(replace(shot(scale="medium"), view="two-shot", whose=("anna", "ben")), told, FILMING)
    takes = takes_of("medium", "person", EYE, AIM)

    def of(shown: Pictures) -> dict[str, float]:
        found = measure(replace(takes, pictures=shown), subject, FILMING.world, 24.0).values
        return {k: float(v[0]) for k, v in found.items()}

    anna, ben = Pictures.FIRST, Pictures.FIRST + 1
    apart = pictures(anna, 3.4)
    apart.what[..., SIDE * 9 // 20 :], apart.depth[..., SIDE * 9 // 20 :] = ben, 3.7  # where he is
    assert of(apart)["head_visible"] == 1.0
    assert of(pictures(ben, 3.5 - away))["head_visible"] == 0.0
    assert of(pictures(ben, 3.5 - away))["foreground"] == 0.0  # but nobody is in the way of the two


def test_pictures_and_lines_agree_of_a_plain_thing_in_the_way() -> None:
    """A board before her legs, as a line meets it and as it is drawn."""
    board = world(boxes=((1.5, 0.0, 1.0, 0.02, 3.0, 0.3, 0.0),))
    by_lines = measured(None, board)
    high = [1.4 + (z - 1.4) * (3.5 / 2.0) for z in (0.7, 1.3)]  # of where it is seen, at her distance
    assert by_lines["visibility"] < 1.0
    lens = takes_of("medium", "person", EYE, AIM).track
    rows = sorted(_row(lens.focal[0, 0], lens.sensor[1], z) for z in high)
    drawn = measured(pictures(Pictures.THING, 2.0, slice(max(rows[0], 0), rows[1])))
    assert drawn["visibility"] == pytest.approx(by_lines["visibility"], abs=0.13)


def _row(focal: float, sensor: float, height: float) -> int:
    """Of a point over where she stands."""
    down = np.arctan2(EYE[2] - height, EYE[0]) - np.arctan2(EYE[2] - AIM[2], EYE[0])
    return round(float(SIDE * (0.5 + np.tan(down) * focal / sensor)))


def test_one_look_by_lines_and_by_pictures_asks_of_the_same_places() -> None:
    camera = np.tile(np.array(EYE), (1, 8, 1))
    axes = np.tile(np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [-1.0, 0.0, 0.0]]), (1, 8, 1, 1))
    shown = Shown(
        pictures(Pictures.THING, 2.0), camera, axes, np.full((1, 8), 35.0), (36.0, 36.0), frozenset()
    )
    lines = Lines(
        world(boxes=((1.5, 0.0, 1.4, 0.02, 9.0, 9.0, 0.0),)).solids, camera, np.zeros((1, 0), bool), []
    )
    behind, before = np.array([-1.0, 0.2, 1.3]), np.array([2.5, 0.2, 1.3])
    for looks in (shown, lines):
        one_by_one = looks.clear_each(np.zeros(2, int), np.array([0, 7]), np.stack([behind, before]))
        assert one_by_one.tolist() == [False, True]
        points = np.tile(np.stack([behind, before]), (8, 1, 1))
        assert looks.clear(points).tolist() == [[[False, True]] * 8]
        some = np.array([0, 3])
        assert looks.clear(points[None, :2], some=some).tolist() == [[[False, True]] * 2]
    away = np.tile(np.array([5.0, 0.0, 1.4]), (8, 1, 1))  # behind the camera nothing is hidden
    assert shown.clear(away).all()


def test_points_looked_at_together_are_seen_as_those_looked_at_one_by_one() -> None:
    lot = np.random.default_rng(7)
    boxes = [(*lot.uniform(-3, 3, 2), 0.5, *lot.uniform(0.1, 0.6, 3), lot.uniform(0, 3)) for _ in range(40)]
    frames, eye = 4, lot.uniform(-4, 4, (6, 4, 3)) * (1.0, 1.0, 0.3) + (0.0, 0.0, 1.2)
    foot = np.tile([0.5, 0.5, 0.0], (frames, 1))
    others = [(foot, np.tile([0.5, 0.5, 1.7], (frames, 1)), 0.25)]
    looks = Lines(world(boxes=tuple(boxes)).solids, eye, np.zeros((6, 0), bool), others)
    points = lot.uniform(-3, 3, (frames, 3, 5, 3)) * (1.0, 1.0, 0.5)

    def alone(one: np.ndarray, people: bool) -> np.ndarray:
        return np.concatenate([looks.clear(one[:, [k]], people) for k in range(one.shape[1])], axis=2)

    whole = np.stack([alone(points[:, k], people=k < 2) for k in range(3)], axis=2)
    assert 0.1 < whole.mean() < 0.9
    np.testing.assert_array_equal(looks.shown(("a", "b", "c"), points, people=2), whole)
    np.testing.assert_array_equal(looks.clear_apart(points[:, 0]), whole[:, :, 0])
