"""Each loss against the formula written out, the dictionary against a list, the fusion by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest
import torch
from ranker_clips import model_config

from ranker.composed import fuse
from ranker.dictionary import Dictionary, follow, momentum_copy
from ranker.losses import (
    STEPS,
    binary_loss,
    class_loss,
    contrast_loss,
    fault_loss,
    hint_loss,
    liking_loss,
    measures_loss,
)
from ranker.model import ShotRanker, normalised


def unit(rng: np.random.Generator, *shape: int) -> np.ndarray:
    v = rng.normal(size=shape)
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


@pytest.mark.parametrize("smoothing", [0.0, 0.1])
def test_binary_loss_is_cross_entropy(smoothing: float) -> None:
    logit, label = np.array([2.0, -1.0, 0.3, -4.0]), np.array([1, 0, 0, 1])
    total = 0.0
    for x, y in zip(logit, label, strict=True):
        p = 1 / (1 + math.exp(-x))
        y = y * (1 - smoothing) + smoothing / 2
        total -= y * math.log(p) + (1 - y) * math.log(1 - p)
    got = binary_loss(torch.tensor(logit), torch.tensor(label), smoothing)
    assert float(got) == pytest.approx(total / 4, rel=1e-6)


def test_class_loss_sums_the_three_over_known_labels() -> None:
    rng = np.random.default_rng(1)
    scores = [rng.normal(size=(5, n)) for n in (4, 3, 2)]
    labels = [[0, 3, -1, 2, 1], [2, -1, -1, 0, 1], [-1, -1, -1, -1, -1]]
    want = 0.0
    for table, row in zip(scores, labels, strict=True):
        parts = [
            -math.log(math.exp(s[y]) / sum(np.exp(s))) for s, y in zip(table, row, strict=True) if y >= 0
        ]
        want += sum(parts) / len(parts) if parts else 0.0
    got = class_loss(tuple(map(torch.tensor, scores)), tuple(map(torch.tensor, labels)))
    assert float(got) == pytest.approx(want, rel=1e-6)


def test_hint_loss_is_square_near_and_straight_far_over_what_is_known() -> None:
    told = torch.tensor([[0.2, 9.0], [3.0, -1.0]])
    hints = torch.tensor([[0.0, math.nan], [0.0, -1.0]])
    near, far = 0.2**2 / 2 / 0.3, 3.0 - 0.3 / 2
    assert float(hint_loss(told, hints)) == pytest.approx((near + far + 0.0) / 3)
    assert float(hint_loss(told, torch.full((2, 2), math.nan))) == 0.0


def test_fault_loss_is_cross_entropy_over_what_is_known() -> None:
    told = torch.tensor([[2.0, 9.0], [-1.0, 0.5]])
    known = torch.tensor([[1.0, math.nan], [0.0, 1.0]])
    expected = [math.log(1 + math.exp(-2.0)), math.log(1 + math.exp(-1.0)), math.log(1 + math.exp(-0.5))]
    assert float(fault_loss(told, known)) == pytest.approx(sum(expected) / 3, rel=1e-6)
    assert float(fault_loss(told, torch.full((2, 2), math.nan))) == 0.0


def test_measures_are_weighed_by_what_they_are_of() -> None:
    told = np.array([[0.1, 2.0, -1.0, 0.5, 1.4], [0.0, -0.7, 0.2, -2.0, 0.3]])
    known = np.array([[0.3, 1.0, 0.0, 0.4, math.nan], [2.0, 0.0, math.nan, -2.1, 0.1]])

    def straight(columns: list[int]) -> float:
        off = np.abs(told - known)[:, columns]
        off = off[np.isfinite(off)]
        return float(np.mean(np.where(off < 0.3, off**2 / 2 / 0.3, off - 0.15)))

    odds = [(x, y) for x, y in zip(told[:, 1:3].ravel(), known[:, 1:3].ravel(), strict=True) if y == y]
    faults = np.mean([-math.log(1 / (1 + math.exp(-x if y else x))) for x, y in odds])
    got = measures_loss(torch.tensor(told), torch.tensor(known), slice(1, 3), slice(3, 5), 5.0, 0.5)
    assert float(got) == pytest.approx(straight([0, 3, 4]) + 0.5 * straight([3, 4]) + 5.0 * faults, rel=1e-6)


def test_liking_loss_asks_of_every_step_whether_a_shot_is_above_it() -> None:
    rng = np.random.default_rng(1)
    told, liked = rng.normal(size=(4, len(STEPS))), np.array([0.5, math.nan, -3.0, 3.0])
    expected = []
    for row, value in zip(told, liked, strict=True):
        for odds, step in zip(row, STEPS, strict=True):
            p = 1 / (1 + math.exp(-odds))
            if not math.isnan(value):
                expected.append(-math.log(p if value > step else 1 - p))
    found = float(liking_loss(torch.tensor(told), torch.tensor(liked)))
    assert found == pytest.approx(np.mean(expected), rel=1e-5)
    assert float(liking_loss(torch.tensor(told), torch.full((4,), math.nan))) == 0.0


def test_contrast_loss_is_the_papers_ratio() -> None:
    rng = np.random.default_rng(2)
    query, key, others = unit(rng, 4, 6), unit(rng, 4, 6), unit(rng, 9, 6)
    same = np.zeros((4, 9), bool)
    same[1, [2, 5]] = True
    tau, want = 0.2, 0.0
    for i in range(4):
        own = math.exp(query[i] @ key[i] / tau)
        rest = sum(math.exp(query[i] @ others[k] / tau) for k in range(9) if not same[i, k])
        want -= math.log(own / (own + rest)) / 4
    got = contrast_loss(*map(torch.tensor, (query, key, others)), tau, torch.tensor(same))
    assert float(got) == pytest.approx(want, rel=1e-6)


def test_dictionary_wraps_like_a_ring() -> None:
    ring = Dictionary(10, 3)
    kept: list[tuple[int, float]] = []
    for start in range(0, 28, 4):
        clips = torch.arange(start, start + 4)
        ring.push(clips[:, None].float().expand(-1, 3), clips)
        kept = (kept + [(int(c), float(c)) for c in clips])[-10:]
    assert sorted(zip(ring.clips.tolist(), ring.vectors[:, 0].tolist(), strict=True)) == kept
    assert int(ring.place) == 28 % 10
    assert ring.same(torch.tensor([27, 3])).sum(1).tolist() == [1, 0]


def test_papers_sizes_wrap() -> None:
    ring = Dictionary(6553, 2)
    for step in range(60):
        ring.push(torch.full((128, 2), float(step)), torch.full((128,), step))
    counts = torch.bincount(ring.clips)
    assert counts[-51:].tolist() == [128] * 51
    assert int(counts[:-51].sum()) == 6553 - 51 * 128
    assert int(ring.place) == 60 * 128 % 6553


def test_a_batch_larger_than_the_ring_leaves_its_last() -> None:
    ring = Dictionary(3, 1)
    ring.push(torch.arange(8.0)[:, None], torch.arange(8))
    assert sorted(ring.clips.tolist()) == [5, 6, 7]


def test_key_encoder_follows_by_momentum() -> None:
    torch.manual_seed(0)
    model = ShotRanker(model_config())
    keys = momentum_copy(model)
    before = {n: p.clone() for n, p in keys.named_parameters()}
    with torch.no_grad():
        for parameter in model.parameters():
            parameter.add_(torch.randn_like(parameter))
        model.backbone.bn1.running_mean.fill_(7)
    follow(keys, model, 0.9)
    ours = dict(model.named_parameters())
    for name, parameter in keys.named_parameters():
        torch.testing.assert_close(parameter, 0.9 * before[name] + 0.1 * ours[name])
        assert not parameter.requires_grad
    assert float(keys.backbone.bn1.running_mean[0]) == 7


def test_fusion_is_average_slope_and_spread() -> None:
    rng = np.random.default_rng(3)
    features, times = rng.normal(size=(2, 5, 3)), np.sort(rng.random((2, 5)))
    got = fuse(torch.tensor(features), torch.tensor(times)).numpy()
    for b in range(2):
        for d in range(3):
            series = features[b, :, d]
            want = (series.mean(), np.polyfit(times[b], series, 1)[0], series.std())
            np.testing.assert_allclose(got[b, d::3], want, rtol=1e-4)
    still = fuse(torch.ones(1, 1, 3), torch.zeros(1, 1))
    assert still[0, :6].tolist() == [1, 1, 1, 0, 0, 0]


def test_fusion_tells_left_from_right() -> None:
    features, times = torch.randn(1, 6, 4), torch.linspace(0, 1, 6)[None]
    there, back = fuse(features, times), fuse(features.flip(1), times)
    torch.testing.assert_close(there[:, :4], back[:, :4])
    torch.testing.assert_close(there[:, 4:8], -back[:, 4:8])


def test_pictures_are_normalised_per_channel() -> None:
    picture = np.zeros((1, 2, 2, 3), np.uint8)
    picture[..., 1] = 255
    got = normalised(torch.from_numpy(picture))
    assert got.shape == (1, 3, 2, 2)
    np.testing.assert_allclose(
        got[0, :, 0, 0].numpy(), [-0.485 / 0.229, (1 - 0.456) / 0.224, -0.406 / 0.225], rtol=1e-5
    )
