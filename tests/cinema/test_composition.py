"""Heads and bodies at the borders of the frame."""

from __future__ import annotations

import numpy as np
import pytest
from filmset import shot, skeleton, standing, story, world

from vdsl.cinema.track import camera_axes, project
from vdsl.propose.cameras import Filming, propose_cameras
from vdsl.propose.rejection import REASONS, SOFT


@pytest.mark.parametrize("movement", ["pedestal-up", "pedestal-down", "pan-left", "dolly-right"])
def test_better_takes_do_not_end_on_half_a_head(movement: str) -> None:
    body = skeleton(1.7)
    told = story({"anna": standing(body, np.zeros((48, 3)), np.zeros(48), 0.0)})
    filming = Filming(world(), {"anna": body}, 24.0, 3)
    cameras = propose_cameras(shot(movement, "wide", "eye-level", proposals=40), [told], filming).cameras
    cropped = np.array([c.measures["head_cropped"] for c in cameras])
    assert 0.0 <= cropped.min() <= cropped.max() <= 1.0
    best = max(cameras, key=lambda c: c.measures["geometry"])
    assert best.measures["head_cropped"] < 0.5


@pytest.mark.parametrize("movement", ["pan-left", "pan-right", "dolly-left"])
def test_better_takes_do_not_end_on_a_shoulder(movement: str) -> None:
    """Neither side of the frame is within an arm's breadth of the body where it begins or ends."""
    body = skeleton(1.7)
    told = story({"anna": standing(body, np.zeros((48, 3)), np.zeros(48), 0.0)})
    filming = Filming(world(), {"anna": body}, 24.0, 3)
    cameras = propose_cameras(shot(movement, "medium", "eye-level", proposals=40), [told], filming).cameras
    shoulders = []
    for c in cameras:
        for t in (0, -1):
            axes = camera_axes(c.track.rotation[t])
            ends = np.array((0.0, 0.0, 1.2)) + np.array([[-0.25], [0.25]]) * axes[0]
            xy, depth = project(ends, c.track.position[t], axes, c.track.focal[t], c.track.sensor)
            if depth.min() > 0.1 and ((xy[:, 0] > 0.0) & (xy[:, 0] < 1.0)).sum() == 1:
                shoulders.append(c)
                assert c.measures["head_cropped"] > 0.0
    assert shoulders, "no take cuts the body: the test says nothing"
    assert max(cameras, key=lambda c: c.measures["geometry"]) not in shoulders


def test_close_ups_that_cut_the_head_are_not_blamed_for_it() -> None:
    body = skeleton(1.7)
    told = story({"anna": standing(body, np.zeros((30, 3)), np.zeros(30), 0.0)})
    filming = Filming(world(), {"anna": body}, 24.0, 3)
    said = shot("static", "extreme-close-up", "eye-level", proposals=8)
    assert {c.measures["head_cropped"] for c in propose_cameras(said, [told], filming).cameras} == {0.0}


def test_nothing_that_is_not_as_asked_is_let_back_in() -> None:
    assert not {REASONS[k] for k in SOFT} & {"wrong_size", "wrong_angle", "wrong_movement", "wrong_view"}
