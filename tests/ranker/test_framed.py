"""How shots frame their subject, by the frames that are meant to show it."""

from __future__ import annotations

import math

import pytest
import torch

from ranker.framed import FRAMED, framed
from ranker.guides import MARKS, POINTS

FRAMES = 4
HEIGHTS = {"top": 0.8, "crown": 0.8, "eyes": 1 / 3, "chin": 0.2, "pocket": -0.2, "waist": -0.6}
SHARE, ASKED, LOST, TURNED = 0, 1, 2, 20
SHOWN, GESTURE, DRIFT = -3, -2, -1


def marks_of(**marks: float | list[float]) -> torch.Tensor:
    """Of frames that show somebody from the waist up, 2 m away, who looks at the camera and does nothing."""
    plain: dict[str, float | list[float]] = dict.fromkeys(
        ("right_face", "up_face", "over", "right_roll", "work_l", "work_r"), 0.0
    )
    plain |= {"away_face": -1.0, "distance": math.log(2), "lens": math.log(35), "size": math.log(17.5)}
    for point in POINTS[:-2]:
        plain |= {f"right_{point}": 0.0, f"up_{point}": HEIGHTS.get(point, -1.5), f"covered_{point}": 0.0}
    told = torch.full((1, FRAMES, len(MARKS)), torch.nan)
    for name, value in (plain | marks).items():
        told[0, :, MARKS.index(name)] = torch.tensor(value)
    return told


def plain(told: torch.Tensor, meant: tuple[float, ...] = (1.0,) * FRAMES) -> list[float]:
    found = framed(told, torch.tensor([meant]))
    assert found.shape == (1, FRAMED)
    assert found.isfinite().all()
    return (found.sinh() / 5)[0].tolist()


def test_nothing_known_is_some_number() -> None:
    plain(torch.full((1, FRAMES, len(MARKS)), torch.nan))


def test_eyes_on_the_third_are_not_off_it_while_they_are_meant() -> None:
    told = marks_of(up_eyes=[1 / 3, 1 / 3, -1.0, 1.0])
    assert plain(told, (1.0, 1.0, 0.0, 0.0))[4] == pytest.approx(0.0, abs=1e-3)
    assert plain(told)[4] == pytest.approx((2 / 3 + 1 / 3) / 4, abs=1e-3)


def test_a_hand_at_work_is_lost_before_the_body_and_not_beside_it() -> None:
    before = {"right_hand_r": 0.0, "up_hand_r": -0.1, "work_r": 1.0}
    beside = before | {"right_hand_r": 0.6}  # where half the frame is 1 m across
    assert plain(marks_of())[GESTURE] == pytest.approx(0.0, abs=1e-3)
    assert plain(marks_of(**before))[GESTURE] == pytest.approx(1.0, abs=0.06)
    assert plain(marks_of(**beside))[GESTURE] == pytest.approx(0.0, abs=0.06)
    hidden = beside | {"covered_hand_r": 1.0}
    assert plain(marks_of(**hidden))[GESTURE] == pytest.approx(1.0, abs=0.06)
    sometimes = beside | {"work_r": [1.0, 1.0, 0.0, 0.0], "right_hand_r": [0.6, 0.0, 0.0, 0.0]}
    assert plain(marks_of(**sometimes))[GESTURE] == pytest.approx(0.5, abs=0.06)


def test_what_else_matters_may_be_seen_when_the_subject_is_not_meant() -> None:
    other = {"right_other_1": [3.0, 3.0, 0.2, 0.2], "up_other_1": 0.0, "covered_other_1": 0.0}
    found = plain(marks_of(**other), (1.0, 1.0, 0.0, 0.0))
    assert found[SHARE] == pytest.approx(0.0, abs=1e-3)
    assert found[SHOWN] == pytest.approx(1.0, abs=0.01)
    assert plain(marks_of())[SHOWN] == pytest.approx(1.0, abs=1e-3)  # there is nothing else


def test_a_face_is_turned_to_where_the_camera_stands() -> None:
    assert plain(marks_of())[TURNED] > 0.95
    assert plain(marks_of(away_face=1.0))[TURNED] < -0.95
    aside = {"right_eyes": 0.9, "right_face": 1.0, "away_face": 0.0}
    assert plain(marks_of(**aside))[TURNED] < -0.3  # to the right of one who stands there already
    assert plain(marks_of(**aside, right_hand_l=0.5))[TURNED] == plain(marks_of(**aside))[TURNED]


def test_how_much_a_size_changes_is_asked_of_the_frames_meant() -> None:
    told = marks_of(size=[3.0, 3.5, 0.0, 6.0])
    assert plain(told, (1.0, 1.0, 0.0, 0.0))[DRIFT] == pytest.approx(0.5, abs=1e-3)
