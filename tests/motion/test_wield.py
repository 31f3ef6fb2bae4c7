"""What is held points as it is wielded, and a second hand finds its place on it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from runtime.motion.perform import perform
from runtime.motion.timeline import Reach, Timeline, Track
from runtime.motion.types import ActionClip, PropState, Task, Variant

from .scenes import FPS, at, person

PITCH = 1.0
POINTING = tuple(
    Track(f"wield_r.{axis}", (0.0, 0.2, 1.0), (low, high, high))
    for axis, low, high in (("weight", 0.0, 1.0), ("pitch", PITCH, PITCH), ("grip", 0.5, 0.5))
)
BEFORE_ONE = Reach("right", "front", 0.1, 0.3, 1.0, 1.0, (-0.1, -0.12, 0.0))


def hammer() -> PropState:
    """Lies along X, held 11 cm behind its middle."""
    return PropState(np.eye(4), (-0.11, 0.0, 0.02), ("anna", "r"))


def played(*reaches: Reach) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The thing's placement and both palms at the end."""
    clip = ActionClip("strike", (Variant("plain", 3.0, Timeline(tracks=POINTING, reaches=reaches)),), "none")
    anna = person(held=(("r", 1),))
    motion = perform({"anna": anna}, {"anna": Task(clip, target=at(1.0, 0.0, 1.0))}, {1: hammer()}, FPS, 3)
    i = int(2.5 * FPS)
    return motion.props[1][i], motion.touches["anna"].palms[0][i], motion.touches["anna"].palms[1][i]


def test_a_wielded_thing_points_up_by_its_pitch() -> None:
    placed, _, right = played(BEFORE_ONE)
    assert placed[:3, 0] == pytest.approx([np.cos(PITCH), 0.0, np.sin(PITCH)], abs=0.03)
    grip = placed[:3, :3] @ np.array([-0.11, 0.0, 0.02]) + placed[:3, 3]
    assert np.linalg.norm(grip - right) < 0.005


def test_the_other_hand_lies_on_what_is_held() -> None:
    placed, left, _ = played(BEFORE_ONE, Reach("left", "held", 0.1, 0.4, 1.0, 1.0, (0.1, 0.0, 0.0)))
    there = placed[:3, :3] @ np.array([-0.01, 0.0, 0.02]) + placed[:3, 3]
    assert np.linalg.norm(there - left) < 0.03


def test_the_point_of_what_is_held_leads() -> None:
    """The far end, as far beyond the middle as the grip is before it, is where the reach leads."""
    led = replace(BEFORE_ONE, to="target", lead="point", offset=(0.0, 0.0, 0.0))
    clip = ActionClip("touch", (Variant("plain", 3.0, Timeline(tracks=POINTING, reaches=(led,))),), "none")
    aim = at(0.45, -0.1, 1.15)
    motion = perform(
        {"anna": person(held=(("r", 1),))}, {"anna": Task(clip, target=aim)}, {1: hammer()}, FPS, 3
    )
    placed = motion.props[1][int(2.5 * FPS)]
    end = placed[:3, :3] @ np.array([0.11, 0.0, 0.02]) + placed[:3, 3]
    assert np.linalg.norm(end - aim.position) < 0.03


def test_the_other_hand_finds_what_an_arm_holds_by_its_angles() -> None:
    """The hand that holds goes nowhere; the other one is to come to where its arm has it all the same."""
    placed, left, right = played(Reach("left", "held", 0.1, 0.4, 1.0, 1.0, (-0.04, 0.0, 0.0)))
    assert right[2] < 1.2  # and not at its shoulder
    there = placed[:3, :3] @ np.array([-0.15, 0.0, 0.02]) + placed[:3, 3]
    assert np.linalg.norm(there - left) < 0.04
