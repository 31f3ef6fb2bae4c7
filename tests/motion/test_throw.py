"""Throwing: what is thrown flies freely, lands where it was aimed, or is caught."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from motion.scenes import FPS, at, person, thing
from runtime.motion.perform import perform
from runtime.motion.timeline import Grasp, Timeline
from runtime.motion.types import ActionClip, SceneMotion, TargetPoint, Task, Variant

THROW = ActionClip(
    "throw",
    (Variant("plain", 1.5, Timeline(grasps=(Grasp("throw", "holding", 0.4),))),),
    travel="none",
    needs="target",
)


def thrown(aim: TargetPoint | None, two: bool = False) -> SceneMotion:
    ball = thing(0.0, 0.0, 1.0, 0.1)
    actors = {"anna": person(held=(("r", 1),))}
    if two:
        actors["ben"] = person(x=3.0, heading=np.pi)
    task = Task(THROW, target=at(0.0, 0.0, 1.0, object=1), second=aim)
    return perform(actors, {"anna": task}, {1: ball}, FPS, 1)


def test_what_is_thrown_lands_where_it_was_aimed_and_stays() -> None:
    motion = thrown(at(3.0, 0.5, 0.0))
    way = motion.props[1][:, :3, 3]
    assert np.allclose(way[-1], (3.0, 0.5, 0.0), atol=1e-3)
    assert motion.end_actors["anna"].held == ()
    assert np.allclose(motion.end_props[1].world_from_object[:3, 3], (3.0, 0.5, 0.0), atol=1e-3)


def test_it_falls_freely_on_the_way() -> None:
    way = thrown(at(4.0, 0.0, 0.0)).props[1][:, :3, 3].astype(np.float64)
    moving = np.nonzero(np.linalg.norm(np.diff(way, axis=0), axis=1) * FPS > 2.5)[0][1:-1]
    fall = np.diff(way[moving, 2], 2) * FPS**2
    assert np.allclose(fall, -9.81, atol=0.2)


def test_thrown_at_nobody_it_comes_to_the_floor() -> None:
    way = thrown(None).props[1][:, :3, 3]
    assert way[-1, 2] < 0.01
    assert way[-1, 0] > 2.0


def test_the_other_person_catches_it() -> None:
    motion = thrown(at(3.0, 0.0, 1.0, character="ben"), two=True)
    assert [thing for _, thing in motion.end_actors["ben"].held] == [1]
    assert motion.end_actors["anna"].held == ()
    step = np.linalg.norm(np.diff(motion.props[1][:, :3, 3], axis=0), axis=1) * FPS
    assert step.max() < 9.0  # no leap at the catch


def test_what_is_sent_off_leaves_from_where_it_lies() -> None:
    kick = ActionClip("kick", (Variant("plain", 1.0, Timeline(grasps=(Grasp("send", "near", 0.5),))),))
    task = Task(kick, target=at(0.4, 0.0, 0.0, object=1), second=at(4.0, 0.0, 0.0, character="ben"))
    actors = {"anna": person(), "ben": person(x=4.0, heading=np.pi)}
    motion = perform(actors, {"anna": task}, {1: thing(0.4, 0.0, 0.0)}, FPS, 1)
    way = motion.props[1][:, :3, 3]
    assert np.allclose(way[0], (0.4, 0.0, 0.0), atol=1e-6)
    assert np.allclose(way[-1], (3.5, 0.0, 0.0), atol=0.02)
    assert way[:, 2].max() > 0.05


def test_one_turns_to_whom_one_throws_after_taking_the_thing_from_elsewhere() -> None:
    clip = replace(THROW, faces="second")
    ball = thing(0.1, 0.5, 0.8, 0.1)
    task = Task(clip, target=at(0.1, 0.5, 0.9, object=1), second=at(3.0, 0.0, 1.3, character="ben"))
    actors = {"anna": person(heading=np.pi / 2), "ben": person(x=3.0, heading=np.pi)}
    motion = perform(actors, {"anna": task}, {1: ball}, FPS, 1)
    assert abs(motion.end_actors["anna"].heading) < 0.2
    assert [thing for _, thing in motion.end_actors["ben"].held] == [1]
