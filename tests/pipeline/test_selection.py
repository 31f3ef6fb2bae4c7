"""Which judged proposals become takes."""

from __future__ import annotations

import numpy as np

from vdsl.cinema.track import CameraTrack, look_at_rotation
from vdsl.pipeline.filming import segment_frames
from vdsl.pipeline.selection import choose_takes, unlike
from vdsl.propose.types import CameraProposal


def _proposal(index: int, azimuth: float, distance: float = 3.0, focal: float = 50.0) -> CameraProposal:
    frames = 10
    offset = distance * np.array([np.cos(azimuth), np.sin(azimuth), 0.0])
    look_at = np.tile([0.0, 0.0, 1.4], (frames, 1))
    position = look_at + offset
    track = CameraTrack(
        position, look_at_rotation(position, look_at), np.full(frames, focal), look_at, (36.0, 20.25)
    )
    return CameraProposal(index, 0, "static", "medium", "eye-level", {}, track, np.zeros(0, bool))


def test_the_best_come_first_and_twins_are_passed_over():
    cameras = (_proposal(0, 0.0), _proposal(1, 0.02), _proposal(2, 1.5), _proposal(3, 3.0))
    assert choose_takes(cameras, np.array([0.9, 0.8, 0.7, 0.6]), 3) == [0, 2, 3]


def test_another_lens_from_the_same_place_is_no_twin():
    cameras = (_proposal(0, 0.0), _proposal(1, 0.0, focal=70.0))
    assert choose_takes(cameras, np.array([0.1, 0.2]), 2) == [1, 0]


def test_twins_fill_up_where_nothing_else_is_left_in_order_of_score():
    cameras = tuple(_proposal(i, 0.001 * i) for i in range(4))
    assert choose_takes(cameras, np.array([0.1, 0.4, 0.3, 0.2]), 3) == [1, 2, 3]


def test_fewer_proposals_than_takes_give_what_there_is():
    assert choose_takes((_proposal(0, 0.0),), np.array([0.5]), 5) == [0]
    assert choose_takes((), np.zeros(0), 5) == []


def test_unlike_a_take_are_no_twins_of_it_unless_there_is_nothing_else():
    cameras = (_proposal(0, 0.0), _proposal(1, 0.02), _proposal(2, 1.5), _proposal(3, 3.0))
    assert unlike(cameras, 1) == [2, 3]
    assert unlike(cameras[:2], 1) == [0]


def test_segments_are_sampled_in_their_middles():
    assert segment_frames(80).tolist() == [0, 11, 23, 34, 45, 56, 68, 79]
    assert segment_frames(1).tolist() == [0] * 8
    assert segment_frames(3).max() == 2
