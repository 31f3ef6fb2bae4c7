"""Where things are in a picture is part of what describes it, and what is known in numbers is judged by."""

from __future__ import annotations

import hashlib
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import torch
from ranker_clips import FRAMES, SIZE, TINY, WORDS, clip, model_config, write_clips
from safetensors.torch import load_file, save_file

from ranker.config import Phase, model_from_json, to_json
from ranker.data import Dataset, ShardWriter, Words
from ranker.errors import RankerError
from ranker.infer import Ranker
from ranker.model import Pool, ShotRanker, frame_times, normalised
from ranker.starting import take_over
from ranker.train import train
from ranker.weights import load_model, save_weights


def test_moments_say_where_a_feature_is() -> None:
    maps = torch.zeros(1, 2, 4, 8)
    maps[0, 1, 3, 2] = 32.0  # the lowest row, third of eight columns
    average, right, down = Pool(True)(maps).view(3, 2)
    assert average.tolist() == [0.0, 1.0]
    assert right.tolist() == [0.0, -0.375]
    assert down.tolist() == [0.0, 0.75]
    torch.testing.assert_close(Pool(False)(maps), average[None])


def test_moments_mean_the_same_at_any_size() -> None:
    small = torch.rand(3, 5, 4, 4)
    large = small.repeat_interleave(3, 2).repeat_interleave(3, 3)
    torch.testing.assert_close(Pool(True)(large), Pool(True)(small))


def test_a_mirrored_picture_has_mirrored_moments() -> None:
    maps = torch.rand(2, 3, 6, 6)
    here, there = Pool(True)(maps).view(2, 3, 3), Pool(True)(maps.flip(3)).view(2, 3, 3)
    torch.testing.assert_close(there, here * torch.tensor([1.0, -1.0, 1.0])[:, None])


def test_weights_of_before_there_were_moments_still_describe_a_network() -> None:
    values = to_json(model_config())
    for name in ("moments", "measures", "marks", "motion"):
        del values[name]
    assert model_from_json(values) == model_config()


def test_what_is_told_of_a_shot_is_learnt_and_judged_by(tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    with ShardWriter(tmp_path / "data", WORDS, (SIZE, SIZE), FRAMES) as writer:
        for i in range(48):
            good, movement, scale, angle = i % 2 == 0, i % 3, i // 2 % 2, i // 4 % 2
            told = {"redness": float(good), "right_way": float((0, -1, 1)[movement])}
            shown = {"right_place": [(0, -1, 1)[movement] * (3.0 * k - 4) for k in range(FRAMES)]}
            words = WORDS.movements[movement], WORDS.scales[scale], WORDS.angles[angle]
            frames = clip(rng, good, movement, scale, angle)
            writer.add(
                frames, good, *words, "g", 0.0 if good else 0.5, about={"hints": told, "frames": shown}
            )
    train(tmp_path / "data", tmp_path / "out", replace(TINY, hint_weight=4.0))
    model, data = load_model(tmp_path / "out" / "weights")[0], Dataset(tmp_path / "data")
    assert (model.config.measures, model.config.marks) == (2, 1)
    frames = torch.from_numpy(np.stack([data.clip(i, range(FRAMES), SIZE) for i in range(48)]))
    with torch.inference_mode():
        out = model(normalised(frames), frame_times(model.config).expand(48, -1))
        for column, known in enumerate(data.hints[1].T):
            assert np.corrcoef(out.told[:, column], known)[0, 1] > 0.8
        place = data.frame_hints[1][:, :, 0]
        assert np.corrcoef(out.marked[:, :, 0].flatten(), place.flatten())[0, 1] > 0.8
        more = model.reasons(torch.eye(2, 5))
    assert float((more[0] - more[1]).abs().max()) > 0.01  # what is told counts


def test_how_well_shots_seem_composed_counts_for_their_order() -> None:
    config = model_config(measures=5, liking=1.0)
    frames = torch.rand(6, FRAMES, 3, SIZE, SIZE)
    torch.manual_seed(0)
    model = ShotRanker(config).eval()
    with torch.inference_mode():
        out = model(frames, frame_times(config).expand(6, -1))
    alone = model.margin(out)
    model.config = replace(config, appeal=3, appealing=2.0)
    torch.testing.assert_close(model.margin(out), alone + 2.0 * out.told[:, 3])
    loaded = model_from_json(to_json(model.config))
    assert (loaded.appeal, loaded.appealing) == (3, 2.0)
    with pytest.raises(RankerError, match="out of range"):
        model_from_json(to_json(replace(config, appeal=5, appealing=2.0)))


def test_one_fault_is_enough_for_a_shot_not_to_be_good() -> None:
    config = model_config(measures=5, first_fault=1, faults=3)
    model = ShotRanker(config)
    told = torch.tensor(
        [[9.0, -8.0, -8.0, -8.0, 9.0], [0.0, -8.0, 6.0, -8.0, 0.0], [0.0, -1.0, -2.0, 0.5, 0.0]]
    )
    judged = torch.tensor([[2.0] * 17]).expand(3, -1)
    found = model._faultless(judged, told, torch.tensor([1.0, 1.0, 2.0]))
    assert found[0, 0] == pytest.approx(2.0, abs=0.02)  # no fault is told: only what else there is counts
    assert found[1, 0] < -5
    p = [1 / (1 + np.exp(x)) for x in (-1.0, -2.0, 0.5)]  # of not having each
    p = p[0] * p[1] * p[2] ** 2 / (1 + np.exp(-2.0))
    assert found[2, 0] == pytest.approx(np.log(p / (1 - p)), rel=1e-4)
    assert torch.equal(found[:, 0], found[:, 3])  # it cannot be liked for that either
    assert torch.equal(found[:, 6:], judged[:, 6:])  # but shows what it shows
    loaded = model_from_json(to_json(config))
    assert (loaded.first_fault, loaded.faults) == (1, 3)
    with pytest.raises(RankerError, match="out of range"):
        model_from_json(to_json(replace(config, faults=9)))


def test_a_training_starts_from_other_weights_as_far_as_they_fit(tmp_path: Path) -> None:
    torch.manual_seed(1)
    other = ShotRanker(model_config(moments=True))
    card = save_weights(tmp_path / "other", other)
    same = ShotRanker(model_config(moments=True, motion=8))
    assert take_over(same, tmp_path / "other")[0] == card.sha256
    torch.testing.assert_close(same.angle.weight, other.angle.weight.half().float())

    words = Words(("static", "zoom", "roll"), WORDS.scales, WORDS.angles)
    changed = ShotRanker(replace(model_config(moments=True), movements=words.movements))
    own = changed.movement.weight.clone()
    take_over(changed, tmp_path / "other")
    assert torch.equal(changed.movement.weight, own)  # its outputs are of other words
    torch.testing.assert_close(changed.scale.weight, other.scale.weight.half().float())

    plain = ShotRanker(model_config())
    own = plain.scale.weight.clone()
    take_over(plain, tmp_path / "other")
    assert torch.equal(plain.scale.weight, own)  # reads less of a shot
    torch.testing.assert_close(plain.backbone.conv1.weight, other.backbone.conv1.weight.half().float())
    with pytest.raises(RankerError, match="of a resnet18, and no resnet50"):
        take_over(ShotRanker(model_config(backbone="resnet50")), tmp_path / "other")


def test_what_is_told_of_goes_by_its_name_where_more_is_told(tmp_path: Path) -> None:
    torch.manual_seed(3)
    before, now = ["a", "fault_b", "fault_d", "z"], ["a", "fault_b", "fault_c", "fault_d", "y", "z"]
    shape = model_config(moments=True, marks=2, guides=16, motion=8)
    other = ShotRanker(replace(shape, measures=4, first_fault=1, faults=2))
    save_weights(tmp_path / "other", other, data={"hints": before})
    wider = replace(shape, measures=6, first_fault=1, faults=3)
    ours, fresh = ShotRanker(wider), ShotRanker(wider)
    fresh.load_state_dict(ours.state_dict())
    _, taken = take_over(ours, tmp_path / "other", now)
    kept = [0, 1, 3, 5]
    for name in ("reader.weight", "reader_guided.bias", "reader_moved.weight"):
        new, old = ours.state_dict()[name], other.state_dict()[name].half().float()
        torch.testing.assert_close(new[kept], old, atol=1e-3, rtol=1e-3)
        assert torch.equal(new[[2, 4]], fresh.state_dict()[name][[2, 4]])  # nothing is known of these
        assert taken[name][[2, 4]].isnan().all()
    new, old = ours.state_dict()["reasons_guided.0.weight"], other.state_dict()["reasons_guided.0.weight"]
    torch.testing.assert_close(new[:, [*kept, *range(6, 12)]], old.half().float())
    new, old = ours.state_dict()["straight.weight"], other.state_dict()["straight.weight"].half().float()
    judged = len(old) - 4
    torch.testing.assert_close(new[[*range(judged), *(judged + k for k in kept)]], old)
    with torch.no_grad():
        other.faults_guided.copy_(torch.tensor([0.3, 0.7]))
    save_weights(tmp_path / "other", other, data={"hints": before})
    take_over(ours, tmp_path / "other", now)
    assert ours.faults_guided.tolist() == pytest.approx([0.3, 1.0, 0.7])


def test_weights_that_are_anchored_end_between_where_they_began_and_where_they_got(tmp_path: Path) -> None:
    write_clips(tmp_path / "data", 20)
    short = replace(TINY, phases=(Phase(1, SIZE, 2, 1, 8),), held_out=0.2)
    train(tmp_path / "data", tmp_path / "first", short)
    start = tmp_path / "first" / "weights"
    runs = {}
    for share in (0.0, 0.25, 1.0):
        config = replace(short, seed=5, anchored=share)
        train(tmp_path / "data", tmp_path / str(share), config, start=start)
        runs[share] = load_file(tmp_path / str(share) / "weights" / "model.safetensors")
    began = load_file(start / "model.safetensors")
    for name in ("angle.weight", "backbone.conv1.weight", "contrast.0.weight"):
        free, between, kept = (runs[share][name].float() for share in (0.0, 0.25, 1.0))
        assert not torch.equal(free, kept)
        torch.testing.assert_close(kept, began[name].float())
        torch.testing.assert_close(between, 0.75 * free + 0.25 * kept, rtol=2e-3, atol=2e-3)


def test_a_training_that_goes_on_from_weights_says_so_and_is_ahead(tmp_path: Path) -> None:
    write_clips(tmp_path / "data", 40)
    train(tmp_path / "data", tmp_path / "first", TINY)
    short = replace(TINY, phases=(Phase(1, SIZE, 2, 2, 16),))
    logs: dict[str, list[dict]] = {"random": [], "ahead": []}
    train(tmp_path / "data", tmp_path / "random", short, logs["random"].append)
    train(tmp_path / "data", tmp_path / "ahead", short, logs["ahead"].append, tmp_path / "first" / "weights")
    assert logs["ahead"][0]["class"] < 0.5 * logs["random"][0]["class"]
    cards = [json.loads((tmp_path / n / "weights" / "config.json").read_text()) for n in ("first", "ahead")]
    assert cards[1]["training"]["start"] == cards[0]["sha256"]


def test_an_epoch_may_go_through_a_share_of_the_clips(tmp_path: Path) -> None:
    write_clips(tmp_path / "data", 40)
    lines: list[dict] = []
    config = replace(TINY, phases=(Phase(2, SIZE, 2, 2, 8, share=0.4), Phase(1, SIZE, 2, 2, 8)))
    train(tmp_path / "data", tmp_path / "out", config, lines.append)
    assert [line["step"] for line in lines if "step" in line] == [2, 4, 9]


def test_pictures_are_scaled_to_what_the_network_was_taught_by(tmp_path: Path) -> None:
    torch.manual_seed(2)
    large = ShotRanker(model_config(size=2 * SIZE, inner=SIZE))
    small = ShotRanker(model_config())
    small.load_state_dict(large.state_dict())
    frames = np.random.default_rng(1).integers(0, 255, (2, FRAMES, 2 * SIZE, 2 * SIZE, 3), dtype=np.uint8)
    shrunk = frames.reshape(2, FRAMES, SIZE, 2, SIZE, 2, 3).mean((3, 5)).round().astype(np.uint8)
    by_large, by_small = Ranker(large, "cpu"), Ranker(small, "cpu")
    np.testing.assert_allclose(by_large.score(frames).feature, by_small.score(shrunk).feature, atol=0.05)
    some = (0, 2)
    np.testing.assert_allclose(
        by_large.glance(frames[:, some], some).feature,
        by_small.glance(shrunk[:, some], some).feature,
        atol=0.05,
    )
    save_weights(tmp_path, large)
    assert load_model(tmp_path)[0].config.inner == SIZE
    with pytest.raises(RankerError, match="sizes out of range"):
        model_from_json(to_json(large.config) | {"inner": 4 * SIZE})


def test_a_training_starts_from_weights_of_a_network_that_is_no_more(tmp_path: Path) -> None:
    """Heads of other widths than today's are left out, and the rest is taken over."""
    other = ShotRanker(model_config(moments=True))
    save_weights(tmp_path / "other", other)
    path = tmp_path / "other" / "model.safetensors"
    tensors = load_file(path)
    tensors["liked.weight"], tensors["liked.bias"] = tensors["liked.weight"][:1], tensors["liked.bias"][:1]
    save_file({k: v.contiguous() for k, v in tensors.items()}, path)
    card = json.loads((tmp_path / "other" / "config.json").read_text("utf-8"))
    card["sha256"] = hashlib.sha256(path.read_bytes()).hexdigest()
    (tmp_path / "other" / "config.json").write_text(json.dumps(card), "utf-8")
    with pytest.raises(RankerError, match="does not hold weights of this model"):
        load_model(tmp_path / "other")
    ours = ShotRanker(model_config(moments=True))
    own = ours.liked.weight.clone()
    assert take_over(ours, tmp_path / "other")[0] == card["sha256"]
    assert torch.equal(ours.liked.weight, own)
    torch.testing.assert_close(ours.angle.weight, other.angle.weight.half().float())
