"""Hands reach what they touch, things go with the hand, seats are sat on, states carry over."""

from __future__ import annotations

import numpy as np
import pytest

from runtime.body.skeleton import JOINT
from runtime.motion.hands import Hands
from runtime.motion.perform import perform
from runtime.motion.types import PropState, SceneMotion, Task

from .library import clips
from .scenes import FPS, Array, angular_steps, at, joint, joint_rotation, person, skeleton, thing

CUP = 7
HEIGHTS = [1.2, 1.55, 1.72, 1.95]


def palm(motion: SceneMotion, who: str, side: str, height: float) -> Array:
    body = skeleton(height, 8.0 if height < 1.4 else 32.0)
    offset = Hands(body).offset["lr".index(side), 0]
    return joint(motion, who, f"hand_{side}") + joint_rotation(motion, who, f"hand_{side}") @ offset


def grip(motion: SceneMotion, prop: PropState) -> Array:
    return (motion.props[CUP].astype(np.float64) @ np.array([*prop.grip, 1.0]))[:, :3]


def pick(height: float, x: float, y: float, z: float, name: str = "pick-up", **more: object) -> SceneMotion:
    prop = thing(x, y, z)
    target = at(x, y, z + 0.05, object=CUP)
    task = Task(clips()[name], target=target, **more)  # type: ignore[arg-type]
    return perform({"a": person(height)}, {"a": task}, {CUP: prop}, FPS, 1)


PLACES = [(0.45, -0.15, 0.74), (0.4, 0.2, 0.9), (0.35, 0.0, 0.42), (0.35, -0.2, 0.0)]


@pytest.mark.parametrize("height", HEIGHTS)
@pytest.mark.parametrize(("x", "y", "z"), PLACES)
def test_hands_reach_grips_and_things_go_with_them(height: float, x: float, y: float, z: float) -> None:
    motion = pick(height, x, y, z)
    prop = thing(x, y, z)
    side = motion.end_actors["a"].held[0][0]
    apart = np.linalg.norm(palm(motion, "a", side, height) - grip(motion, prop), axis=1)
    moved = np.linalg.norm(grip(motion, prop) - grip(motion, prop)[0], axis=1)
    first = int(np.argmax(moved > 0.002))
    assert 0 < first < motion.frames - 5
    assert apart[max(first - 2, 0)] < 0.012  # it touches before the thing stirs
    assert apart[first + 8 :].max() < 0.01
    assert motion.end_actors["a"].held == ((side, CUP),)
    assert motion.end_props[CUP].holder == ("a", side)
    assert grip(motion, prop)[-1, 2] > min(z + 0.05, 0.5 * height)


def test_what_is_out_of_reach_is_not_taken() -> None:
    motion = pick(1.7, 2.2, 0.0, 0.74)
    assert motion.end_actors["a"].held == ()
    assert np.ptp(motion.props[CUP][:, :3, 3], axis=0).max() < 1e-6


def test_a_thing_stays_upright_while_it_is_carried() -> None:
    motion = pick(1.7, 0.45, -0.1, 0.74)
    up = motion.props[CUP][:, :3, 2]
    assert up[-8:, 2].min() > 0.97


def test_put_down_leaves_it_where_it_was_asked() -> None:
    first = pick(1.7, 0.45, -0.1, 0.74)
    actors = {"a": person(1.7, held=first.end_actors["a"].held)}
    task = Task(clips()["put-down"], target=at(0.4, -0.35, 0.9))
    motion = perform(actors, {"a": task}, first.end_props, FPS, 2)
    assert np.allclose(motion.end_props[CUP].world_from_object[:3, 3], (0.4, -0.35, 0.9), atol=1e-3)
    assert motion.end_props[CUP].holder is None
    assert motion.end_actors["a"].held == ()
    assert motion.end_props[CUP].world_from_object[2, 2] > 0.999
    steps = np.linalg.norm(np.diff(motion.props[CUP][:, :3, 3], axis=0), axis=1)
    assert steps.max() < 0.12  # no jump: 3 m/s at most
    assert steps[-6:].max() < 1e-6


def test_a_thing_put_down_nowhere_in_particular_goes_back_where_it_stood() -> None:
    first = pick(1.7, 0.45, -0.1, 0.74)
    actors = {"a": person(1.7, held=first.end_actors["a"].held)}
    task = Task(clips()["put-down"], target=at(0.4, -0.1, 1.0, object=CUP))
    motion = perform(actors, {"a": task}, first.end_props, FPS, 2)
    assert np.allclose(motion.end_props[CUP].world_from_object[:3, 3], (0.45, -0.1, 0.74), atol=1e-3)
    assert motion.end_actors["a"].held == ()
    far = perform({"a": person(1.7, 4.0, held=actors["a"].state.held)}, {"a": task}, first.end_props, FPS, 2)
    assert far.end_actors["a"].held == actors["a"].state.held  # better in the hand than in the air


def test_pouring_takes_the_bottle_first_and_tips_it_over_the_cup() -> None:
    cup, bottle = thing(0.45, 0.05, 0.74), thing(0.45, -0.3, 0.74, 0.12)
    into, from_ = at(0.45, 0.05, 0.79, object=8), at(0.45, -0.3, 0.86, object=CUP)
    task = Task(clips()["pour"], target=into, second=from_)
    motion = perform({"a": person()}, {"a": task}, {8: cup, CUP: bottle}, FPS, 0)
    up = motion.props[CUP][:, :3, 2]
    tipped = int(np.argmin(up[:, 2]))
    assert up[tipped, 2] < 0.15
    tip = (motion.props[CUP][tipped] @ np.array([0, 0, 0.24, 1.0]))[:3]
    assert np.linalg.norm(tip[:2] - (0.45, 0.05)) < 0.06
    assert 0.79 < tip[2] < 1.05
    assert np.allclose(motion.props[8], cup.world_from_object, atol=1e-6)
    assert motion.props[CUP][:, 2, 3].min() > 0.70  # never through the table


@pytest.mark.parametrize("height", HEIGHTS)
def test_drinking_brings_the_cup_to_the_mouth(height: float) -> None:
    body = skeleton(height, 8.0 if height < 1.4 else 32.0)
    motion = pick(height, 0.4, -0.1, 0.7, "drink")
    head = joint(motion, "a", "head")
    mouth = body.bind[[JOINT["mouth_l"], JOINT["mouth_r"]]].mean(axis=0) - body.bind[JOINT["head"]]
    mouth[0] = 1.3 * (body.bind[JOINT["eye_l"]] - body.bind[JOINT["head"]])[0]
    lips = head + joint_rotation(motion, "a", "head") @ mouth
    rim = (motion.props[CUP].astype(np.float64) @ np.array([0, 0, 0.1, 1.0]))[:, :3]
    assert np.linalg.norm(rim - lips, axis=1).min() < 0.05


def test_giving_passes_the_thing_on() -> None:
    held = thing(0.4, 0, 0.9)
    prop = PropState(held.world_from_object, held.grip, ("a", "r"))
    actors = {"a": person(1.6, held=(("r", CUP),)), "b": person(1.85, 1.0, 0.1, 2.6)}
    task = Task(clips()["give"], target=at(0.4, 0, 0.9, object=CUP), second=at(1.0, 0.1, 1.4, character="b"))
    motion = perform(actors, {"a": task}, {CUP: prop}, FPS, 0)
    assert motion.end_actors["a"].held == ()
    ((side, thing_id),) = motion.end_actors["b"].held
    assert thing_id == CUP
    a, b = palm(motion, "a", "r", 1.6), palm(motion, "b", side, 1.85)
    assert np.linalg.norm(a - b, axis=1).min() < 0.13
    at_grip = grip(motion, prop)
    assert np.linalg.norm(at_grip - a, axis=1)[2:20].max() < 0.02
    assert np.linalg.norm(at_grip - b, axis=1)[-8:].max() < 0.02
    assert np.linalg.norm(np.diff(at_grip, axis=0), axis=1).max() < 0.12


@pytest.mark.parametrize("height", HEIGHTS)
@pytest.mark.parametrize("seat_height", [0.38, 0.45, 0.62])
def test_sitting_down_is_on_the_seat_with_feet_on_the_floor(height: float, seat_height: float) -> None:
    seat = at(1.6, 0.0, seat_height, facing=np.pi, seat=(1.6, 0.0, seat_height))
    path = np.array([[0.0, 0.0], [0.8, 0.3], [1.1, 0.0]])
    motion = perform({"a": person(height)}, {"a": Task(clips()["sit"], path=path, target=seat)}, {}, FPS, 0)
    hips = 0.5 * (joint(motion, "a", "thigh_l") + joint(motion, "a", "thigh_r"))[-1]
    assert np.linalg.norm(hips[:2] - (1.6, 0.0)) < 0.08
    assert 0.04 < hips[2] - seat_height < 0.14
    end = motion.end_actors["a"]
    assert (end.posture, end.seat) == ("sitting", (1.6, 0.0, seat_height))
    for s in "lr":
        knee, foot = joint(motion, "a", f"shin_{s}")[-1], joint(motion, "a", f"foot_{s}")[-1]
        assert knee[0] < hips[0] - 0.12  # the knees are before the seat
        assert knee[2] > seat_height - 0.12
        if seat_height < (0.25 if height < 1.4 else 0.27) * height:
            assert foot[2] < 0.06 * height


def test_sit_talk_and_stand_up_carry_over() -> None:
    seat = at(1.0, 0.0, 0.45, facing=0.0, seat=(1.0, 0.0, 0.45))
    actors = {"a": person(1.7, 1.5, 0.3, 2.0)}
    sat = perform(actors, {"a": Task(clips()["sit"], target=seat)}, {}, FPS, 0)
    seated = {"a": type(actors["a"])(actors["a"].skeleton, sat.end_actors["a"])}
    talked = perform(seated, {"a": Task(clips()["talk"])}, {}, FPS, 1)
    assert talked.end_actors["a"].posture == "sitting"
    assert np.abs(joint(talked, "a", "hips") - joint(sat, "a", "hips")[-1]).max() < 0.06
    up = perform(seated, {"a": Task(clips()["stand-up"])}, {}, FPS, 2)
    assert up.end_actors["a"].posture == "standing"
    assert joint(up, "a", "hips")[-1, 2] > joint(sat, "a", "hips")[-1, 2] + 0.25
    way = np.array([[1.4, 0.0], [3.0, 1.0]])
    walked = perform(seated, {"a": Task(clips()["walk"], path=way)}, {}, FPS, 3)
    assert walked.end_actors["a"].posture == "standing"
    assert np.allclose(walked.end_actors["a"].position[:2], way[-1])
    for motion in (sat, talked, up, walked):
        assert angular_steps(motion, "a").max() < 0.6


def test_a_shot_can_be_cut_short_or_stretched() -> None:
    task = Task(clips()["wave"], duration=1.5)
    assert perform({"a": person()}, {"a": task}, {}, FPS, 0).frames == 36
    assert perform({"a": person()}, {}, {}, FPS, 0, duration=5.0).frames == 120


def test_eyes_lead_the_head() -> None:
    target = at(0.3, 2.0, 1.5)
    motion = perform({"a": person()}, {"a": Task(clips()["look"], target=target)}, {}, FPS, 0)
    head = joint_rotation(motion, "a", "head")
    eye = joint_rotation(motion, "a", "eye_l")
    head_yaw, eye_yaw = (np.arctan2(r[:, 1, 0], r[:, 0, 0]) for r in (head, eye))
    wanted = np.arctan2(2.0, 0.3)
    assert eye_yaw[-8] == pytest.approx(wanted, abs=0.25)
    assert int(np.argmax(eye_yaw > 0.5 * wanted)) <= int(np.argmax(head_yaw > 0.5 * head_yaw[-8]))
    assert np.abs(head_yaw).max() < 1.8


def test_odd_requests_are_survived() -> None:
    nowhere = Task(clips()["walk"], path=np.zeros((0, 2)))
    on_the_spot = Task(clips()["walk"], path=np.array([[0.0, 0], [0.1, 0], [-0.2, 0]]), duration=0.3)
    to_nobody = Task(clips()["give"], target=at(0.4, 0, 0.8, object=CUP), second=at(9, 9, 1, character="z"))
    for task in (nowhere, on_the_spot, to_nobody):
        motion = perform({"a": person()}, {"a": task}, {CUP: thing(0.4, 0, 0.75)}, 24000 / 1001, -5)
        assert motion.frames >= 2
        assert np.isfinite(motion.world_from_joint["a"]).all()
        assert np.isfinite(motion.props[CUP]).all()
    kept = perform({"a": person(held=(("r", 99),))}, {"a": Task(clips()["drink"])}, {}, FPS, 0)
    assert kept.end_actors["a"].held == (("r", 99),)
