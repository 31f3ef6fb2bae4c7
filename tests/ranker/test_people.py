"""What is told of the people in a picture, one by one."""

from __future__ import annotations

import numpy as np
import pytest
import torch

from ranker.guides import MARKS, PEOPLE, PEOPLE_MARKS, PERSON_POINTS
from ranker.people import PEOPLED, SUMMED_UP, people_of

FRAMES = 4


def marks_of(**marks: float) -> torch.Tensor:
    """Of frames in which nobody is but whom the marks are of."""
    told = torch.full((1, FRAMES, len(MARKS)), torch.nan)
    for name, value in marks.items():
        told[..., MARKS.index(name)] = value
    return told


def somebody(k: int, right: float, turned: float, up: float = 0.3, covered: float = 0.0) -> dict[str, float]:
    """The k-th, 3 m away and 1.2 half frames tall."""
    high = dict(zip(PERSON_POINTS, (0.1, 0.0, -0.4, -0.6, -1.1), strict=True))
    out = {
        f"{side}_{p}_{k}": at for p in PERSON_POINTS for side, at in (("right", right), ("up", up + high[p]))
    }
    out |= {f"covered_{p}_{k}": covered for p in PERSON_POINTS}
    return out | {
        f"right_face_{k}": -0.5,
        f"turned_{k}": turned,
        f"distance_{k}": float(np.log(3)),
        f"about_{k}": 1,
    }


def summed(told: torch.Tensor) -> dict[str, float]:
    found = people_of(told)
    assert found.shape == (1, FRAMES, PEOPLED)
    assert found.isfinite().all()
    names = ("count", "least_eyes", "eyes", "least_turned", "turned", "least_share", "cut", "share")
    return dict(zip(names, found[0, 0, -SUMMED_UP:].tolist(), strict=False))


def test_nobody_is_known_as_nobody() -> None:
    found = summed(marks_of())
    assert found["count"] == found["eyes"] == found["cut"] == found["share"] == 0
    assert found["least_eyes"] == found["least_share"] == 1


def test_of_two_the_worst_counts_by_itself() -> None:
    both = summed(marks_of(**somebody(1, -0.4, 0.8), **somebody(2, 0.4, -0.9)))
    assert both["count"] == pytest.approx(2 / PEOPLE)
    assert both["least_eyes"] == pytest.approx(1, abs=0.02)
    assert both["turned"] == pytest.approx((1.8 + 0.1) / 2, abs=0.03)
    assert both["least_turned"] == pytest.approx(0.1, abs=0.02)
    hidden = summed(marks_of(**somebody(1, -0.4, 0.8), **somebody(2, 0.4, 0.9, covered=0.5)))  # by 1.2 m
    assert hidden["least_eyes"] == pytest.approx(0, abs=0.02)
    assert hidden["eyes"] == pytest.approx(0.5, abs=0.02)
    assert hidden["least_share"] < 0.05


def test_who_lost_a_head_is_known_and_who_is_out_of_the_picture_lost_none() -> None:
    assert summed(marks_of(**somebody(1, 0.0, 0.8)))["cut"] < 0.05
    assert summed(marks_of(**somebody(1, 0.0, 0.8, up=1.3)))["cut"] > 0.95
    assert summed(marks_of(**somebody(1, 1.6, 0.8, up=1.3)))["cut"] < 0.05


def test_how_the_camera_goes_comes_last() -> None:
    told = marks_of(pace=0.5, turning=0.25, jerk=2.0, room=0.75, work_l=1.0, work_r=0.0)
    assert people_of(told)[0, 0, -6:].tolist() == [0.5, 0.25, 2.0, 0.75, 1.0, 0.0]
    assert PEOPLE_MARKS[-6:] == ("pace", "turning", "jerk", "room", "work_l", "work_r")
