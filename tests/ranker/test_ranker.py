"""Training learns, stops and goes on; weights load or say why not; scores hang on the shot alone."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import torch
from ranker_clips import FRAMES, SIZE, TINY, WORDS, model_config, write_clips
from safetensors.torch import load_file

from ranker.batches import mirror_words, varied
from ranker.config import CPU, PAPER, Phase, to_json, train_from_json
from ranker.data import Dataset
from ranker.errors import RankerError
from ranker.evaluate import auc, evaluate
from ranker.infer import Ranker, fold_batch_norm
from ranker.model import ShotRanker, frame_times, normalised
from ranker.train import learning_rate, train, watch
from ranker.weights import SHIPPED, load_card, load_model, save_weights
from vdsl.pipeline.judging import DiscriminatorJudge


@pytest.fixture(scope="module")
def weights(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Random weights with batch-norm statistics that are not those of a new network."""
    torch.manual_seed(3)
    model = ShotRanker(model_config(moments=True, measures=3))
    for module in model.modules():
        if isinstance(module, torch.nn.BatchNorm2d):
            torch.nn.init.uniform_(module.weight, 0.5, 1.2)
            torch.nn.init.normal_(module.bias, 0, 0.2)
    model.train()(torch.randn(6, FRAMES, 3, SIZE, SIZE), frame_times(model.config).expand(6, -1))
    folder = tmp_path_factory.mktemp("weights")
    save_weights(folder, model, training={"seed": 3}, measured={"auc": 0.5})
    return folder


@pytest.fixture(scope="module")
def frames() -> np.ndarray:
    return np.random.default_rng(5).integers(0, 255, (7, FRAMES, SIZE, SIZE, 3), dtype=np.uint8)


def test_forty_clips_are_learnt_by_heart(tmp_path: Path) -> None:
    write_clips(tmp_path / "data", 40)
    lines: list[dict] = []
    long = replace(TINY, phases=(replace(TINY.phases[0], epochs=24),))  # fewer do not do on every processor
    train(tmp_path / "data", tmp_path / "out", long, lines.append)
    data = Dataset(tmp_path / "data")
    measured = evaluate(Ranker.load(tmp_path / "out" / "weights", "cpu"), data, np.arange(40))
    assert measured["auc"] == 1.0
    assert measured["auc_by_strength"] == dict.fromkeys(("0.25", "0.5", "0.75", "1"), 1.0) | {
        k: None for k, v in measured["auc_by_strength"].items() if v is None
    }
    assert measured["accuracy"] == {"movement": 1.0, "scale": 1.0, "angle": 1.0, "professional": 1.0}
    log = [json.loads(x) for x in (tmp_path / "out" / "log.jsonl").read_text().splitlines()]
    assert log == lines
    assert log[0]["loss"] > 2 * log[-2]["loss"]
    card = load_card(tmp_path / "out" / "weights")
    assert train_from_json(card.training) == long
    assert card.data["clips"] == 40


@pytest.mark.slow
def test_two_hundred_clips_are_learnt_by_heart(tmp_path: Path) -> None:
    write_clips(tmp_path / "data", 200)
    config = replace(TINY, phases=(Phase(8, SIZE, 2, 2, 20),), watched=200)
    train(tmp_path / "data", tmp_path / "out", config)
    model, data = load_model(tmp_path / "out" / "weights")[0], Dataset(tmp_path / "data")
    right = watch(model, data, np.arange(200), SIZE, config, torch.device("cpu"))
    assert right == dict.fromkeys(("professional", "movement", "scale", "angle"), 1.0)
    assert (tmp_path / "out" / "curves.svg").stat().st_size > 1000


def test_training_goes_on_where_it_stopped(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("ranker.train._WORTH_KEEPING", 0.0)
    write_clips(tmp_path / "data", 20)
    config = replace(TINY, phases=(Phase(3, SIZE, 2, 1, 8),), augment=True, held_out=0.2)

    class StopError(Exception):
        pass

    def stop_after_two(line: dict) -> None:
        if line.get("epoch") == 2:
            raise StopError

    train(tmp_path / "data", tmp_path / "whole", config)
    with pytest.raises(StopError):
        train(tmp_path / "data", tmp_path / "parts", config, stop_after_two)
    epochs: list[dict] = []
    train(tmp_path / "data", tmp_path / "parts", config, epochs.append)
    assert [e["epoch"] for e in epochs if "epoch" in e] == [2, 3]
    a, b = (load_file(tmp_path / run / "weights" / "model.safetensors") for run in ("whole", "parts"))
    for name in a:
        torch.testing.assert_close(a[name], b[name], rtol=1e-3, atol=1e-3)
    with pytest.raises(RankerError, match="other settings"):
        train(tmp_path / "data", tmp_path / "parts", replace(config, seed=1))
    (tmp_path / "parts" / "checkpoint.pt").write_bytes(b"broken")
    with pytest.raises(RankerError, match=r"checkpoint\.pt: is damaged"):
        train(tmp_path / "data", tmp_path / "parts", config)


def test_scores_do_not_hang_on_the_batch(weights: Path, frames: np.ndarray) -> None:
    ranker = Ranker.load(weights, "cpu")
    together = ranker.score(frames)
    for i in range(len(frames)):
        alone = ranker.score(frames[i : i + 1])
        for name in ("professional", "margin", "movement", "feature"):
            np.testing.assert_array_equal(getattr(alone, name)[0], getattr(together, name)[i])
    backwards = ranker.score(frames[::-1])
    np.testing.assert_array_equal(backwards.margin[::-1], together.margin)
    assert together.professional.shape == (7,)
    np.testing.assert_allclose(together.movement.sum(1), 1, rtol=1e-5)
    assert ranker.score(frames[:0]).angle.shape == (0, 2)
    with pytest.raises(ValueError, match="expected uint8"):
        ranker.score(frames.astype(np.float32))


def test_quick_scores_are_near_the_exact_ones(weights: Path, frames: np.ndarray) -> None:
    model, card = load_model(weights)
    with torch.no_grad():
        out = model(normalised(torch.from_numpy(frames)), frame_times(card.model).expand(7, -1))
    got = Ranker.load(weights, "cpu").score(frames)
    np.testing.assert_allclose(got.feature, out.feature, atol=0.03 * float(out.feature.abs().max()))
    np.testing.assert_allclose(got.movement, out.movement.softmax(1), atol=0.05)


def test_a_glance_is_what_some_of_the_frames_say(weights: Path, frames: np.ndarray) -> None:
    model, card = load_model(weights)
    ranker, at = Ranker.load(weights, "cpu"), (1, card.model.frames - 2)
    with torch.no_grad():
        some = normalised(torch.from_numpy(frames[:, at]))
        out = model(some, frame_times(card.model)[list(at)].expand(7, -1))
    got = ranker.glance(frames[:, at], at).margin
    np.testing.assert_allclose(got, out.logit, atol=0.05 * float(out.logit.abs().max()) + 0.01)
    np.testing.assert_array_equal(ranker.glance(frames[:, at], at).margin, got)
    assert ranker.glance(frames[:0, at], at).margin.shape == (0,)
    with pytest.raises(ValueError, match=r"expected uint8 \[P, 2"):
        ranker.glance(frames, at)


def test_folding_batch_norm_changes_nothing(weights: Path) -> None:
    backbone = load_model(weights)[0].backbone
    pictures = torch.randn(3, 3, SIZE, SIZE)
    folded = fold_batch_norm(backbone)
    assert not [m for m in folded.modules() if isinstance(m, torch.nn.BatchNorm2d)]
    with torch.no_grad():
        torch.testing.assert_close(folded(pictures), backbone(pictures), rtol=1e-3, atol=1e-4)


def test_weights_survive_the_disk(tmp_path: Path, weights: Path) -> None:
    model, card = load_model(weights)
    assert card.model == model_config(moments=True, measures=3)
    assert card.training == {"seed": 3}
    save_weights(tmp_path, model)
    again, _ = load_model(tmp_path)
    for (name, a), (_, b) in zip(model.state_dict().items(), again.state_dict().items(), strict=True):
        torch.testing.assert_close(a, b, msg=name)


def test_what_norms_learn_is_kept_as_coarse_as_convolutions(tmp_path: Path, weights: Path) -> None:
    save_weights(tmp_path, load_model(weights)[0])
    kept = load_file(tmp_path / "model.safetensors")
    assert kept["backbone.bn1.weight"].dtype == torch.float16
    assert kept["backbone.bn1.running_var"].dtype == torch.float32


def test_the_shipped_weights_are_no_larger_than_they_may_be() -> None:
    assert sum(path.stat().st_size for path in SHIPPED.iterdir()) <= 60_000_000


def damage(folder: Path, how: str) -> str:
    """Break the weights in one way; returns the file that is to be blamed."""
    config, content = folder / "config.json", folder / "model.safetensors"
    values = json.loads(config.read_text())
    if how == "no weights":
        content.unlink()
    elif how == "cut off":
        content.write_bytes(content.read_bytes()[:-100])
    elif how == "one bit":
        data = bytearray(content.read_bytes())
        data[-5] ^= 1
        content.write_bytes(data)
    elif how == "other model":
        values["model"]["backbone"] = "resnet50"
        config.write_text(json.dumps(values))
    else:
        text = {"no config": None, "not json": "{", "a list": "[]", "other schema": '{"schema": "x"}'}[how]
        config.write_text(text) if text is not None else config.unlink()
        return "config.json"
    return "model.safetensors"


@pytest.mark.parametrize(
    "how",
    ["no weights", "cut off", "one bit", "other model", "no config", "not json", "a list", "other schema"],
)
def test_bad_weights_are_named(tmp_path: Path, weights: Path, how: str) -> None:
    for file in weights.iterdir():
        (tmp_path / file.name).write_bytes(file.read_bytes())
    blamed = damage(tmp_path, how)
    with pytest.raises(RankerError) as caught:
        Ranker.load(tmp_path, "cpu")
    assert str(tmp_path / blamed) in str(caught.value)
    assert "--rank geometry" in str(caught.value)


def test_weights_for_other_pictures_are_told(weights: Path) -> None:
    ranker = Ranker.load(weights, "cpu")
    ranker.fits(FRAMES, SIZE)
    ranker.fits(FRAMES)
    for frames, size in ((FRAMES, 224), (FRAMES + 1, SIZE), (FRAMES + 1, None)):
        with pytest.raises(RankerError, match=r"vdsc train.*--rank geometry"):
            ranker.fits(frames, size)
    with pytest.raises(RankerError, match="8 frames of 224 × 224"):
        DiscriminatorJudge(weights, "cpu")


def test_auc_counts_pairs() -> None:
    rng = np.random.default_rng(0)
    scores, positive = rng.integers(0, 6, 40).astype(float), rng.random(40) < 0.4
    pairs = [(a > b) + 0.5 * (a == b) for a in scores[positive] for b in scores[~positive]]
    assert auc(scores, positive) == pytest.approx(np.mean(pairs))
    assert auc(scores, np.ones(40, bool)) is None


def test_mirrored_clips_have_mirrored_words() -> None:
    assert mirror_words(WORDS.movements) == [0, 2, 1]
    assert mirror_words(("arc-left", "tilt-up")) == [0, 1]
    clip = np.arange(2 * 4 * 4 * 3, dtype=np.uint8).reshape(2, 4, 4, 3)
    seen = {varied(clip, np.random.default_rng(s))[1] for s in range(8)}
    assert seen == {True, False}
    for seed in range(8):
        out, flipped = varied(
            np.repeat(np.arange(4, dtype=np.uint8)[None, None, :, None] * 60, 3, -1),
            np.random.default_rng(seed),
        )
        assert (np.diff(out[0, 0, :, 0].astype(int)) < 0).all() == flipped


def test_varied_light_keeps_what_is_dark_and_light_and_can_take_the_colour_away() -> None:
    ramp = np.repeat(np.arange(0, 240, 8, dtype=np.uint8)[None, None, :, None], 3, -1)
    coloured = np.zeros((1, 2, 2, 3), np.uint8) + np.array([200, 80, 40], np.uint8)
    spread = []
    for seed in range(40):
        out, flipped = varied(ramp, np.random.default_rng(seed))
        assert (np.diff(out[0, 0, :, 1].astype(int)) * (-1 if flipped else 1) >= 0).all()
        assert abs(float(out.mean()) - float(ramp.mean())) < 40
        spread.append(np.ptp(varied(coloured, np.random.default_rng(seed))[0][0, 0, 0].astype(int)))
    assert min(spread) < 40
    assert max(spread) > 140


def test_learning_rate_warms_up_and_falls() -> None:
    rates = [learning_rate(CPU, s, 100) for s in range(100)]
    assert np.argmax(rates) in (9, 10)
    assert max(rates) == pytest.approx(CPU.learning_rate)
    assert rates[0] == pytest.approx(CPU.learning_rate / 10)
    assert rates[-1] < 0.02 * CPU.learning_rate
    assert np.all(np.diff(rates[10:]) < 0)


def test_the_papers_recipe_is_the_papers() -> None:
    assert [(p.epochs, p.size, p.batch, p.frames + p.key_frames) for p in PAPER.phases] == [(60, 224, 128, 8)]
    assert (PAPER.learning_rate, PAPER.dictionary, PAPER.backbone) == (1e-3, 6553, "resnet50")
    assert (PAPER.class_weight, PAPER.contrast_weight) == (1, 1)
    assert train_from_json(json.loads(json.dumps(to_json(CPU)))) == CPU
