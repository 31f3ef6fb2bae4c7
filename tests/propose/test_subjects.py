"""Who is in the way: as high as a hat, as broad as a head where the head is, and broader than deep."""

from __future__ import annotations

import numpy as np
import pytest
from filmset import shot, standing, story, world

from runtime.body.proportions import make_skeleton
from runtime.body.spec import BodySpec
from vdsl.cinema import sight, space
from vdsl.cinema.sight import clear_of_people
from vdsl.cinema.space import to_people
from vdsl.propose.subjects import Filming, pillars_of

TALL = 1.7


def seen_past(hat: str, over: float, aside: float = 0.0, view: str = "", yaw: float = 0.0) -> bool:
    """Whether somebody in the way leaves a line free that passes so far over their crown, or beside."""
    body = make_skeleton(BodySpec(height=TALL, hat=hat))
    acted = story({"ben": standing(body, np.zeros((4, 3)), np.full(4, yaw))})
    filming = Filming(world(), {"ben": body}, 24.0, 0)
    pillars = pillars_of(shot(view=view, whose=("ben",) if view else ()), acted, filming, set())
    level = TALL + over
    camera, point = np.array((-3.0, aside, level)), np.array((3.0, aside, level))
    clear = clear_of_people(np.tile(camera, (1, 4, 1)), np.tile(point, (4, 1, 1)), pillars)
    return bool(clear.all())


def test_hats_are_in_the_way() -> None:
    assert not seen_past("none", -0.05)
    assert seen_past("none", 0.05)
    assert not seen_past("knight-helmet", 0.05)
    assert seen_past("knight-helmet", 0.12)


def test_there_is_a_view_beside_a_head_over_the_shoulder() -> None:
    assert not seen_past("none", -0.1, 0.1)
    assert seen_past("none", -0.1, 0.16)
    assert not seen_past("none", -0.5, 0.16)  # the shoulders are broader
    assert seen_past("none", -0.1, 0.1, view="ots")  # that one is meant to be in the picture


def test_who_stands_sideways_hides_less() -> None:
    chest = -0.45
    assert not seen_past("none", chest, 0.25)
    assert not seen_past("none", chest, -0.25)
    assert seen_past("none", chest, 0.25, yaw=np.pi / 2)
    assert seen_past("none", chest, 0.19, yaw=np.pi / 2)
    assert seen_past("none", chest, 0.34)


@pytest.mark.parametrize("takes", [0, 1, 7])
def test_all_pillars_at_once_are_as_one_after_the_other(monkeypatch: pytest.MonkeyPatch, takes: int) -> None:
    rng = np.random.default_rng(takes)
    camera, points = rng.normal(0, 2, (takes, 4, 3)), rng.normal(0, 2, (4, 5, 3))
    feet = rng.normal(0, 1, (9, 4, 3)) * (1, 1, 0)
    bodies = [(foot, foot + np.array((0.0, 0.0, 1.7)), 0.1 * k) for k, foot in enumerate(feet, 1)]
    seen = np.ones((takes, 4, 5), bool)
    near = np.full(takes, space.REACH)
    for body in bodies:
        seen &= clear_of_people(camera, points, [body])
        near = np.minimum(near, to_people(camera, [body]))
    assert takes < 7 or (0 < seen.sum() < seen.size and near.min() < near.max())
    for at_once in (1, 1 << 7, 1 << 20):
        monkeypatch.setattr(sight, "_AT_ONCE", at_once)
        monkeypatch.setattr(space, "_AT_ONCE", at_once)
        np.testing.assert_array_equal(clear_of_people(camera, points, bodies), seen)
        np.testing.assert_array_equal(to_people(camera, bodies), near)
    assert clear_of_people(camera, points, []).all()
    own = [
        (*(np.tile(end, (takes, 1, 1)) for end in (foot, crown)), radius) for foot, crown, radius in bodies
    ]
    np.testing.assert_array_equal(to_people(camera, own), near)
