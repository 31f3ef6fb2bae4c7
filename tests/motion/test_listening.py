"""Who is spoken to turns to who speaks, where they could not well look at them otherwise."""

from __future__ import annotations

import numpy as np
import pytest

from runtime.motion.perform import perform
from runtime.motion.timeline import Talk, Timeline
from runtime.motion.types import ActionClip, Actor, SceneMotion, TargetPoint, Task, Variant

from .scenes import FPS, joint, joint_rotation, person

TALK = ActionClip("talk", (Variant("plain", 3.6, Timeline(talks=(Talk(0.05, 0.95),))),), faces="target")
SILENT = ActionClip("nod", (Variant("plain", 3.6, Timeline()),), faces="target")


def spoken_to(listener: Actor, clip: ActionClip = TALK, also: dict[str, Task] | None = None) -> SceneMotion:
    """Ben, two metres to the east of the origin, speaks to Anna."""
    x, y, _ = listener.state.position
    target = TargetPoint((x, y, 1.3), (x, y, 1.6), character="anna")
    tasks = {"ben": Task(clip, target=target), **(also or {})}
    return perform({"anna": listener, "ben": person(1.8, 2.0, 0.0, np.pi)}, tasks, {}, FPS, 5)


def facing(motion: SceneMotion) -> tuple[float, float]:
    """How far off the speaker Anna's head is at the start and at the end, radians."""
    out = []
    for frame in (0, -1):
        to = joint(motion, "ben", "head")[frame] - joint(motion, "anna", "head")[frame]
        ahead = joint_rotation(motion, "anna", "head")[frame, :, 0]
        out.append(
            float(abs(np.angle(np.exp(1j * (np.arctan2(ahead[1], ahead[0]) - np.arctan2(to[1], to[0]))))))
        )
    return out[0], out[1]


@pytest.mark.parametrize("heading", [np.pi, 2.2, -1.8])
def test_a_speaker_behind_is_turned_to(heading: float) -> None:
    motion = spoken_to(person(heading=heading))
    before, after = facing(motion)
    assert before > 0.7
    assert after < 0.35
    assert abs(np.sin(motion.end_actors["anna"].heading / 2)) < 0.1, "and so the next shot begins"


def test_one_turns_once_there_is_something_to_hear() -> None:
    yaw = spoken_to(person(heading=np.pi)).heading["anna"]
    speaks = round((0.05 * 3.6) * FPS)
    assert np.abs(np.angle(np.exp(1j * (yaw[:speaks] - np.pi)))).max() < 0.05


def test_who_has_the_speaker_before_them_stays_as_they_are() -> None:
    motion = spoken_to(person(heading=0.6))
    assert np.ptp(np.unwrap(motion.heading["anna"])) < 0.05


def test_nobody_turns_without_a_word() -> None:
    motion = spoken_to(person(heading=np.pi), SILENT)
    assert np.ptp(np.unwrap(motion.heading["anna"])) < 0.05


def test_who_sits_or_has_something_to_do_stays_as_they_are() -> None:
    seated = person(heading=np.pi, posture="sitting", seat=(0.0, 0.0, 0.45))
    assert np.ptp(np.unwrap(spoken_to(seated).heading["anna"])) < 0.05
    busy = spoken_to(person(heading=np.pi), also={"anna": Task(SILENT)})
    assert np.ptp(np.unwrap(busy.heading["anna"])) < 0.05
