"""Shards: what goes in comes out, writing goes on where it stopped, groups stay together."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from ranker_clips import FRAMES, SIZE, WORDS, clip, write_clips

from ranker import data as data_module
from ranker.data import Dataset, ShardWriter
from ranker.errors import RankerError


@pytest.fixture(autouse=True)
def small_shards(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(data_module, "SHARD", 8)


def test_clips_come_back(tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    clips = [clip(rng, i % 2 == 0, i % 3, 0, 1) for i in range(20)]
    with ShardWriter(tmp_path, WORDS, (SIZE, SIZE), FRAMES) as writer:
        for i, frames in enumerate(clips):
            writer.add(frames, i % 2 == 0, WORDS.movements[i % 3], None, "low-angle", f"g{i % 4}", i / 20)
    data = Dataset(tmp_path)
    assert len(data) == 20
    assert len(list(tmp_path.glob("*.npy"))) == 3
    for i, frames in enumerate(clips):
        np.testing.assert_array_equal(data.clip(i, [2, 0], SIZE), frames[[2, 0]])
    assert data.classes.tolist() == [[i % 3, -1, 1] for i in range(20)]
    assert data.professional.tolist() == [1.0, 0.0] * 10
    assert data.labels[7].strength == pytest.approx(0.35)
    assert data.clip(0, [1], 16).shape == (1, 16, 16, 3)
    assert data.about() == {"clips": 20, "positives": 10, "negatives": 10, "groups": 4}


def test_writing_goes_on_after_a_stop(tmp_path: Path) -> None:
    write_clips(tmp_path / "whole", 30)
    for part in (11, 12, 30):
        write_clips(tmp_path / "parts", part)
    whole, parts = Dataset(tmp_path / "whole"), Dataset(tmp_path / "parts")
    assert parts.labels == whole.labels

    stopped = ShardWriter(tmp_path / "stopped", WORDS, (SIZE, SIZE), FRAMES)
    frames = clip(np.random.default_rng(0), True, 0, 0, 0)
    for _ in range(11):
        stopped.add(frames, True, None, None, None, "g", 0.0)
    (tmp_path / "stopped" / "shard-00001.npy").write_bytes(
        b"half a shard"
    )  # without labels it does not count
    again = ShardWriter(tmp_path / "stopped", WORDS, (SIZE, SIZE), FRAMES)
    assert len(again) == 8
    for _ in range(8):
        again.add(frames, True, None, None, None, "g", 0.0)
    assert len(Dataset(tmp_path / "stopped")) == len(again) == 16


def test_split_keeps_groups_together(tmp_path: Path) -> None:
    write_clips(tmp_path, 40)
    data = Dataset(tmp_path)
    train, held = data.split(0.3, seed=1)
    assert sorted([*train, *held]) == list(range(40))
    sides = [{data.labels[i].group for i in side} for side in (train, held)]
    assert len(held) == 16
    assert not sides[0] & sides[1]
    assert data.split(0.3, seed=1)[1].tolist() == held.tolist()
    assert any(data.split(0.3, seed=s)[1].tolist() != held.tolist() for s in range(2, 6))
    assert len(data.split(0.0, seed=1)[1]) == 0


def test_wrong_clips_and_sets_are_refused(tmp_path: Path) -> None:
    with pytest.raises(RankerError, match="not a training set"):
        Dataset(tmp_path)
    write_clips(tmp_path, 9)
    with pytest.raises(RankerError, match="another kind"):
        ShardWriter(tmp_path, WORDS, (64, 64), FRAMES)
    writer = ShardWriter(tmp_path, WORDS, (SIZE, SIZE), FRAMES)
    with pytest.raises(ValueError, match="expected uint8"):
        writer.add(np.zeros((FRAMES, 8, 8, 3), np.uint8), True, None, None, None, "g", 0.0)
    with pytest.raises(ValueError, match="'spin' is not one"):
        writer.add(np.zeros((FRAMES, SIZE, SIZE, 3), np.uint8), True, "spin", None, None, "g", 0.0)
    (tmp_path / "shard-00000.npy").write_bytes(b"\x93NUMPY\x01\x00 nonsense")
    with pytest.raises(RankerError, match="damaged"):
        Dataset(tmp_path)


def test_hints_are_scaled_and_unknown_ones_are_nan(tmp_path: Path) -> None:
    rng = np.random.default_rng(1)
    with ShardWriter(tmp_path, WORDS, (SIZE, SIZE), FRAMES) as writer:
        for i in range(13):
            good = i < 12
            told = {} if i == 3 else {"size": float(i if good else 400), "right_way": 1.0 + i % 2}
            writer.add(clip(rng, good, 0, 0, 0), good, None, None, None, "g", 0.0, about={"hints": told})
    names, hints = Dataset(tmp_path).hints
    assert names == ("right_way", "size")
    hints = np.sinh(hints)  # the far ones are drawn nearer
    far = hints[12, 1]
    hints = hints[:12]
    known = np.delete(hints, 3, 0)
    assert np.isnan(hints[3]).all()
    assert known[:, 1].mean() == pytest.approx(0, abs=1e-6)
    every = np.delete(np.append(np.arange(12), 400), 3)
    spread = 0.2 * np.sqrt(np.mean((every - np.delete(np.arange(12), 3).mean()) ** 2))  # the least there is
    assert known[:, 1].std() == pytest.approx(np.delete(np.arange(12), 3).std() / spread, rel=1e-4)
    assert far == pytest.approx((400 - np.delete(np.arange(12), 3).mean()) / spread, rel=1e-4)
    assert (known[:, 0] > 0).all()  # a mirrored one has to be the negative, so the middle stays 0
    write_clips(tmp_path / "none", 4)
    assert Dataset(tmp_path / "none").hints[1].shape == (4, 0)


def test_frames_that_may_be_written_to_are_copied_and_others_not(tmp_path: Path) -> None:
    rng = np.random.default_rng(1)
    frames = clip(rng, True, 0, 0, 1)
    for flagged in (False, True):
        given = frames.copy()
        given.flags.writeable = not flagged
        with ShardWriter(tmp_path / f"{flagged}", WORDS, (SIZE, SIZE), FRAMES) as writer:
            writer.add(given, True, None, None, None, "g", 0.0)
            assert np.shares_memory(writer._frames[0], given) == flagged
            if not flagged:
                given[:] = 0
        np.testing.assert_array_equal(Dataset(tmp_path / f"{flagged}").clip(0, range(FRAMES), SIZE), frames)
    one, other = (tmp_path / f"{flagged}" / "shard-00000.npy" for flagged in (False, True))
    assert one.read_bytes() == other.read_bytes()
    np.testing.assert_array_equal(np.load(one), frames[None])
