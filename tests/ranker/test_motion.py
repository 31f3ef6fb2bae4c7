"""How the picture moves: matched blocks find shifts, zooms and turns, and heads may do without."""

from __future__ import annotations

import threading
from pathlib import Path

import cv2
import numpy as np
import pytest
import torch
from ranker_clips import FRAMES, SIZE, model_config, write_clips

from ranker import motion as of_motion
from ranker.data import Dataset
from ranker.model import ShotRanker, frame_times, normalised
from ranker.motion import NUMBERS, SIDE, mirrored, motion, motions, pairs


def moving(affine: np.ndarray, frames: int = 8, seed: int = 0) -> torch.Tensor:
    """A textured plane seen by frames of 112 x 112, the k-th moved by ``affine`` [2, 3] k times."""
    rng = np.random.default_rng(seed)
    plane = cv2.GaussianBlur(rng.uniform(0, 255, (400, 400)).astype(np.float32), (0, 0), 4)
    plane = (plane - plane.min()) / np.ptp(plane) * 255
    step = np.vstack([affine, [0, 0, 1]])
    centre = np.array([[1, 0, -200], [0, 1, -200], [0, 0, 1]], float)
    out = []
    for k in range(frames):
        to = np.array([[1, 0, 56], [0, 1, 56], [0, 0, 1]]) @ np.linalg.matrix_power(step, k) @ centre
        picture = cv2.warpAffine(plane, to[:2], (112, 112), flags=cv2.INTER_LINEAR)
        out.append(np.repeat(picture[..., None], 3, 2).astype(np.uint8))
    return torch.from_numpy(np.stack(out))[None]


@pytest.mark.parametrize("way", [(3.0, 0.0), (0.0, -4.0), (-5.0, 2.5), (0.0, 0.0)])
def test_a_shift_is_found(way: tuple[float, float]) -> None:
    x, y = way
    found = motion(moving(np.array([[1, 0, x], [0, 1, y]], float)))[0].numpy()
    near = [k for k, (i, j) in enumerate(pairs(8)) if j == i + 1]
    small = SIDE / 112
    assert np.abs(found[near, 0] - x * small).max() < 0.25
    assert np.abs(found[near, 1] - y * small).max() < 0.25
    assert np.abs(found[near, 2:6]).max() < 0.4
    assert found[near, 7].min() > 0.7  # nearly all blocks fit


def test_zoom_and_roll_are_found() -> None:
    near = [k for k, (i, j) in enumerate(pairs(8)) if j == i + 1]
    half = 3 / 7 * SIDE  # from the middle to the outermost blocks
    larger = motion(moving(np.array([[1.04, 0, 0], [0, 1.04, 0]], float)))[0, near].numpy()
    assert np.abs(np.median(larger[:, [2, 5]], 0) / half - 0.04).max() < 0.02
    turn = np.deg2rad(2.0)
    turned = motion(moving(np.array([[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0]])))
    a = np.median(turned[0, near].numpy(), 0)
    assert abs(a[3] / half - turn) < 0.012  # y along x
    assert abs(a[4] / half + turn) < 0.012


def test_the_mirror_turns_what_goes_across() -> None:
    frames = moving(np.array([[1.02, 0.01, 3], [0, 1.02, -1.5]], float))
    want = motion(frames.flip(3))[0].numpy()
    got = mirrored(motion(frames))[0].numpy()
    near = [k for k, (i, j) in enumerate(pairs(8)) if j == i + 1]
    assert np.abs(want[near, :2] - got[near, :2]).max() < 0.35
    assert np.abs(want[near, 2:6] - got[near, 2:6]).max() < 0.5


def test_somebody_who_moves_alone_counts_little() -> None:
    frames = moving(np.array([[1, 0, 4.0], [0, 1, 0]])).numpy()
    rng = np.random.default_rng(1)
    patch = rng.integers(0, 255, (40, 24, 3), dtype=np.uint8)
    for k in range(8):
        frames[0, k, 40:80, 70 - 6 * k : 94 - 6 * k] = patch
    found = motion(torch.from_numpy(frames))[0].numpy()
    near = [k for k, (i, j) in enumerate(pairs(8)) if j == i + 1]
    assert np.abs(np.median(found[near, 0]) - 4.0 * SIDE / 112) < 0.3


def test_pairs_join_both_ends_and_none_twice() -> None:
    assert pairs(1) == []
    assert pairs(2) == [(0, 1)]
    for frames in (3, 4, 8, 13):
        found = pairs(frames)
        assert (0, frames - 1) in found
        assert len(set(found)) == len(found)
        assert all(0 <= i < j < frames for i, j in found)


def test_the_motion_of_a_set_is_kept_and_worked_out_anew_where_it_does_not_fit(tmp_path: Path) -> None:
    write_clips(tmp_path, 10)
    data = Dataset(tmp_path)
    first = motions(data)
    assert first.shape == (10, len(pairs(FRAMES)), NUMBERS)
    kept = tmp_path / "shard-00000.motion.npy"
    np.save(kept, first + 1)
    assert np.array_equal(motions(data), first + 1)  # taken from there
    for damage in (b"nothing", b""):
        kept.write_bytes(damage)
        assert np.array_equal(motions(data), first)
    np.save(kept, first[:3])
    assert np.array_equal(motions(data), first)


@pytest.mark.parametrize(("device", "alone"), [("cpu", False), ("meta", True)])
def test_equations_are_solved_by_one_thread_but_on_the_processor(
    device: str, alone: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """On a GPU several threads that ask torch for the first time fail; `meta` stands for one here."""
    asked: set[int] = set()

    def noted(clips: torch.Tensor) -> torch.Tensor:
        assert clips.device.type == device
        asked.add(threading.get_ident())
        return torch.zeros(len(clips), len(pairs(FRAMES)), NUMBERS)

    monkeypatch.setattr(of_motion, "motion", noted)
    frames = np.zeros((9, FRAMES, SIZE, SIZE, 3), np.uint8)
    assert of_motion._of_shard(frames, torch.device(device)).shape == (9, len(pairs(FRAMES)), NUMBERS)
    assert (asked == {threading.get_ident()}) == alone


def test_heads_hear_of_motion_only_where_it_is_known() -> None:
    torch.manual_seed(0)
    model = ShotRanker(model_config(motion=16)).eval()
    frames = torch.randint(0, 255, (2, FRAMES, SIZE, SIZE, 3), dtype=torch.uint8)
    times, moved = frame_times(model.config).expand(2, -1), motion(frames)
    with torch.inference_mode():
        without = model(normalised(frames), times)
        told = model(normalised(frames), times, moved)
        half = model(normalised(frames), times, torch.stack([moved[0], torch.full_like(moved[1], torch.nan)]))
    assert not torch.equal(told.logit, without.logit)
    assert not torch.equal(told.movement, without.movement)
    assert torch.equal(told.scale, without.scale)
    assert torch.equal(half.logit[1], without.logit[1])
    assert torch.equal(half.movement[0], told.movement[0])
