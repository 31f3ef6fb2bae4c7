"""Things in hands over the lines of a story, and people who hold each other."""

from __future__ import annotations

import numpy as np
import pytest

from runtime.body.skeleton import JOINT
from runtime.motion.types import SceneMotion
from vdsl.lang import Report, Source
from vdsl.pipeline.compile import Act, stage_acts
from vdsl.pipeline.script import check_source
from vdsl.propose.story import motions

from .checks import measure

STAGE = """storyboard "handling"
set room_set {{
    time day
    area floor, at (-6, -6)m, size (12, 12)m, floor plain {{
        place table = table(width 1.6m), at (6, 6.9)m {{
            place cup = cup, on top, at (-0.4, -0.16)m
            place basket = basket, on top, at (0.3, -0.1)m
        }}
        place shelf = table(width 1m), at (9, 9)m
        place piano = piano, at (3, 8)m
        place box_parcel = box_parcel, at (7.5, 4)m
        spot start, at (6, 6)m, facing 90deg
        spot other, at (3.5, 4)m, facing 0deg
        spot far, at (9, 8.1)m, facing 90deg
    }}
}}
character anna = woman
character ben = man
scene trial = room_set
anna at start
ben at other
{lines}
"""


def last(*beats: str) -> tuple[Act, SceneMotion]:
    """The last of some lines, performed."""
    text = STAGE.format(lines="\n".join(f"({b}) / (static full eye-level)" for b in beats))
    report = Report()
    acts = stage_acts(check_source(Source("handling", text), report))
    _, motion = next(iter(motions(acts[-1].state, acts[-1].line, acts[-1].filming, report, most=1)))
    assert not report.has_errors
    return acts[-1], motion


def thing(act: Act, motion: SceneMotion, name: str) -> np.ndarray:
    """[T, 3], where a thing is."""
    item = next(o for o in act.state.world.objects if o.path[-1] == name)
    return np.asarray(motion.props[item.id][:, :3, 3], float)


def test_what_came_from_far_is_put_on_the_nearest_table() -> None:
    act, motion = last("anna pick up cup", "anna walk far", "anna put down cup")
    x, y, z = thing(act, motion, "cup")[-1]
    assert abs(x - 3) < 0.5
    assert abs(y - 3) < 0.5
    assert z == pytest.approx(0.74, abs=0.02)


def test_things_go_on_top_of_a_basket_not_to_its_handle() -> None:
    act, motion = last("anna pack cup in basket")
    table, basket = 0.74, 0.2
    assert thing(act, motion, "cup")[-1, 2] == pytest.approx(table + basket, abs=0.03)


def test_what_is_in_the_hand_already_is_carried_on() -> None:
    act, motion = last("anna pick up cup", "anna carry cup to far")
    assert np.hypot(*(motion.position["anna"][-1, :2] - [3, 2.1])) < 0.4
    assert thing(act, motion, "cup")[-1, 2] > 0.8


def test_a_box_is_carried_with_both_hands() -> None:
    act, motion = last("anna carry box_parcel")
    touches = motion.touches["anna"]
    assert (touches.hands[:, -1] > 0.99).all()
    box = thing(act, motion, "box_parcel")[-1]
    assert (np.linalg.norm(touches.palms[:, -1] - box, axis=-1) < 0.4).all()


def test_arms_go_around_who_is_hugged() -> None:
    act, motion = last("anna hug ben")
    middle = motion.touches["anna"].hands.min(axis=0).argmax()
    ben = motion.world_from_joint["ben"][middle, JOINT["chest"]]
    inside = np.linalg.inv(ben)
    for palm in motion.touches["anna"].palms[:, middle]:
        ahead, _, _, _ = inside @ np.array([*palm, 1.0])
        assert -0.22 < ahead < -0.1  # on his back
    assert measure(motion, "anna", act.filming.skeletons["anna"]).hand < 3.0


def test_an_arrested_person_is_turned_round() -> None:
    _, motion = last("anna arrest ben")
    turned = motion.heading["ben"][-1] - motion.heading["anna"][-1]
    assert np.cos(turned) > 0.9


def test_one_sits_down_at_a_piano_from_its_side() -> None:
    act, motion = last("anna play-piano piano")
    xy = motion.position["anna"][:, :2]
    piano = (np.abs(xy[:, 0] + 3) < 0.75) & (np.abs(xy[:, 1] - 2) < 0.35)
    assert not piano.any()
    assert motion.end_actors["anna"].posture == "sitting"
    found = measure(motion, "anna", act.filming.skeletons["anna"], act.filming.fps, act.state.world)
    assert found.clearance is not None
    assert found.clearance > -0.03


def test_the_head_does_what_the_eyes_cannot() -> None:
    act, motion = last("anna whisper to ben")
    assert measure(motion, "anna", act.filming.skeletons["anna"]).gaze < 10.0
