"""What is in the way in pictures, by the maps and marks of their frames."""

from __future__ import annotations

import numpy as np
import pytest
import torch

from ranker.foreground import foreground_of
from ranker.guides import CHANNELS, FARTHEST, MARKS, NEAREST, SIDE

FRAMES, FOCAL, FAR = 8, 35.0, 4.0
_HALF = (18.0, 10.125)  # millimetres of a sensor
_ALONG = (np.arange(SIDE) + 0.5) * 2 / SIDE - 1


def code(metres: np.ndarray) -> np.ndarray:
    return np.round(1 + 254 * (1 - np.log(metres / NEAREST) / np.log(FARTHEST / NEAREST))).astype(np.uint8)


def marks(high: float, down: float = 0.0) -> torch.Tensor:
    """Of somebody 4 m away who stands on the floor; the camera so high above it, and looking so far down
    (radians)."""
    told = torch.full((1, FRAMES, len(MARKS)), torch.nan)
    along, up = FAR * np.cos(down) - (1 - high) * np.sin(down), FAR * np.sin(down) + (1 - high) * np.cos(down)
    feet = FAR * np.cos(down) + high * np.sin(down), FAR * np.sin(down) - high * np.cos(down)
    values = {"lens": np.log(FOCAL), "distance": np.log(np.hypot(FAR, 1 - high)), "right_waist": 0.0}
    values |= {"up_waist": up / along * FOCAL / _HALF[1], "up_feet": feet[1] / feet[0] * FOCAL / _HALF[1]}
    for name, value in values.items():
        told[..., MARKS.index(name)] = value
    return told


def maps(high: float, down: float = 0.0) -> torch.Tensor:
    """Of a wall 9 m away on a floor, seen from so high above it by a camera that looks so far down."""
    rise = np.arctan(-_ALONG * _HALF[1] / FOCAL) - down  # in the middle column, and nearly so beside it
    out = np.zeros((SIDE, SIDE, len(CHANNELS)), np.uint8)
    depth = np.where(rise < 0, np.minimum(9.0, high / np.maximum(-np.sin(rise), 1e-6)), 9.0)
    depth *= np.cos(np.arctan(_ALONG * _HALF[1] / FOCAL))  # along the axis
    out[..., CHANNELS.index("nearness")] = code(depth)[:, None]
    out[..., CHANNELS.index("rise")] = np.round(128 + rise / (np.pi / 2) * 127)[:, None]
    return torch.from_numpy(np.tile(out, (1, FRAMES, 1, 1, 1)))


def put(pictures: torch.Tensor, channel: str, value: int, frames: slice = slice(None)) -> torch.Tensor:
    """Something in the left quarter of the frames."""
    out = pictures.clone()
    out[:, frames, :, : SIDE // 4, CHANNELS.index(channel)] = value
    return out


@pytest.mark.parametrize(("high", "down"), [(1.5, 0.0), (0.2, 0.0), (2.5, 0.4), (4.0, 0.7)])
def test_the_ground_one_looks_down_on_is_in_nobodys_way(high: float, down: float) -> None:
    found = foreground_of(marks(high, down), maps(high, down))
    assert torch.cat(found).abs().max() == 0


def test_what_is_near_is_in_the_way_as_far_as_it_covers_the_picture() -> None:
    told, pictures = marks(1.5), maps(1.5)
    near, halfway, beside = (put(pictures, "nearness", int(code(np.array(m)))) for m in (1.0, 2.5, 3.5))
    share = 2 / 10  # of ten looks across
    assert foreground_of(told, near).way[0].tolist() == pytest.approx([share, share])
    assert foreground_of(told, halfway).way[0].tolist() == pytest.approx([0.4 * share] * 2)
    assert foreground_of(told, beside).way.max() == 0


def test_of_no_shots_nothing_is_told() -> None:
    found = foreground_of(marks(1.5)[:0], maps(1.5)[:0])
    assert [tuple(part.shape) for part in found] == [(0, 2)] * 4


def test_the_subject_is_in_nobodys_way_and_people_are_no_things() -> None:
    told = marks(1.5)
    near = put(maps(1.5), "nearness", int(code(np.array(1.0))))
    assert foreground_of(told, put(near, "subject", 255)).way.max() == 0
    somebody = foreground_of(told, put(near, "others", 255))
    assert somebody.way.min() > 0.1
    assert somebody.things.max() == 0


def test_what_is_in_the_way_at_the_end_counts_for_more_than_its_time() -> None:
    told, pictures, near = marks(1.5), maps(1.5), int(code(np.array(1.0)))
    first, last = (put(pictures, "nearness", near, frames) for frames in (slice(0, 1), slice(7, 8)))
    early, late = foreground_of(told, first), foreground_of(told, last)
    assert early.way[0, 0] == pytest.approx(0.2 / FRAMES)
    assert late.way[0, 0] == pytest.approx(0.4 * 0.2)
    assert early.at_end.max() == 0
    assert late.at_end[0, 0] == pytest.approx(0.2)
    assert late.things_at_end[0, 0] == pytest.approx(0.2)
