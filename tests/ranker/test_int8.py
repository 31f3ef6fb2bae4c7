"""Eight bits: near the exact scores, the same in any company, and what happens where they cannot be used."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import torch
from ranker_clips import FRAMES, SIZE, clip, model_config

from ranker import engine
from ranker.engine import HIGHEST, INT8, engine_for, engine_of, quick_bfloat16
from ranker.errors import RankerError
from ranker.evaluate import spearman
from ranker.infer import Ranker, fold_batch_norm
from ranker.int8 import Int8Backbone, Ranges, layers_of, least_loss, measured_ranges
from ranker.model import ShotRanker, frame_times, normalised
from ranker.weights import load_card, load_model, load_ranges, save_weights

BACKBONES = ("resnet18", "resnet50")
#: A processor that says so.
CPUINFO = {
    "int8": "fpu avx2 avx512bw avx512_vnni",
    "int7": "fpu avx2",
    "bfloat16": "fpu avx512bw",
    "float32": "fpu sse2",
}
#: What this one can do: sums in pairs are as right on those that need none.
HERE = engine_for("cpu", True)
CAN = {"int8": ("int8",), "int7": ("int8", "int7")}


@pytest.fixture(params=list(HIGHEST))
def whole(request: pytest.FixtureRequest, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """An engine in whole numbers, as if the machine were one where it is the quickest."""
    name: str = request.param
    if HERE not in CAN[name]:
        pytest.skip(f"the processor cannot compute as {name} does")
    pretend(name, tmp_path, monkeypatch)
    return name


def pretend(name: str, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = folder / "cpuinfo"
    path.write_text(f"processor\t: 0\nflags\t\t: {CPUINFO[name]}\n")
    monkeypatch.setattr(engine, "_CPU", path)


def clips(count: int, seed: int) -> np.ndarray:
    rng = np.random.default_rng(seed)
    return np.stack([clip(rng, i % 2 == 0, i % 3, i // 2 % 2, i // 4 % 2) for i in range(count)])


def network(backbone: str) -> ShotRanker:
    """Random weights whose batch norms are used to the clips and are not those of a new network."""
    torch.manual_seed(5)
    model = ShotRanker(model_config(backbone=backbone, moments=True, measures=3))
    for module in model.modules():
        if isinstance(module, torch.nn.BatchNorm2d):
            torch.nn.init.uniform_(module.weight, 0.5, 1.2)
            torch.nn.init.normal_(module.bias, 0, 0.2)
            module.momentum = None
    times = frame_times(model.config).expand(12, -1)
    for seed in range(3):
        model.train()(normalised(torch.from_numpy(clips(12, seed))), times)
    return model.eval()


def ranges_of(model: ShotRanker) -> Ranges:
    pictures = [normalised(torch.from_numpy(c)) for c in clips(12, 3)]
    return measured_ranges(fold_batch_norm(model.backbone), pictures)


@pytest.fixture(scope="module")
def weights(tmp_path_factory: pytest.TempPathFactory) -> Path:
    model, folder = network("resnet18"), tmp_path_factory.mktemp("weights")
    save_weights(folder, model, ranges=ranges_of(model))
    return folder


def test_the_order_of_shots_is_that_of_float32(whole: str) -> None:
    model, frames = network("resnet18"), clips(40, 9)
    with torch.no_grad():
        exact = model(normalised(torch.from_numpy(frames)), frame_times(model.config).expand(40, -1))
    ranker = Ranker(model, "cpu", ranges_of(model))
    assert ranker.engine == whole
    got = ranker.score(frames)
    order = spearman(exact.logit.numpy(), got.margin)
    assert order is not None
    assert order > 0.9  # of heads that never learnt to tell these shots apart


def test_the_shipped_weights_keep_their_features(whole: str) -> None:
    """One shot at full size: a window that goes along a soft picture with a figure in it."""
    model, card = load_model()
    size = card.model.size
    y, x = np.mgrid[0:size, 0 : 2 * size] / size
    wide = np.stack([90 + 60 * np.sin(3 * x + k) + 40 * np.cos(2 * y - k) for k in range(3)], -1)
    wide[y > 0.75] *= 0.5
    wide[((x - 1) / 0.12) ** 2 + ((y - 0.6) / 0.35) ** 2 < 1] = (150, 60, 40)
    frames = np.stack([wide[:, 28 * i : 28 * i + size] for i in range(card.model.frames)]).astype(np.uint8)
    ranges = load_ranges(None, model, card)
    assert ranges is not None
    folded = fold_batch_norm(model.backbone)
    with torch.no_grad():
        exact = folded(normalised(torch.from_numpy(frames)))
    got = Int8Backbone(folded, ranges, len(frames), size, HIGHEST[whole])(torch.from_numpy(frames))
    assert float((got - exact).norm()) < 0.08 * float(exact.norm())


def test_scores_in_whole_numbers_do_not_hang_on_the_batch(weights: Path, whole: str) -> None:
    ranker, frames = Ranker.load(weights, "cpu"), clips(5, 7)
    together = ranker.score(frames)
    for i in range(len(frames)):
        alone = ranker.score(frames[i : i + 1])
        for name in ("professional", "margin", "movement", "feature"):
            np.testing.assert_array_equal(getattr(alone, name)[0], getattr(together, name)[i])
    some = (0, 2)
    glanced = ranker.glance(frames[:, some], some)
    fewer = ranker.glance(frames[:2, some], some)
    np.testing.assert_allclose(fewer.margin, glanced.margin[:2], rtol=1e-4, atol=1e-6)
    np.testing.assert_array_equal(fewer.feature, glanced.feature[:2])


def test_plain_pictures_are_what_a_border_of_the_mean_makes_them(whole: str) -> None:
    """Pixels go in as they are: zero in the normalised picture is the mean colour, not black."""
    model = network("resnet18")
    folded = fold_batch_norm(model.backbone)
    bright = torch.full((FRAMES, SIZE, SIZE, 3), 255, dtype=torch.uint8)
    eight = Int8Backbone(folded, measured_ranges(folded, [normalised(bright)]), FRAMES, SIZE, HIGHEST[whole])
    with torch.no_grad():
        exact = folded(normalised(bright))
    got = eight(bright)
    assert float((got - exact).norm()) < 0.1 * float(exact.norm())


def test_layers_are_all_convolutions_once() -> None:
    for backbone in BACKBONES:
        network_ = ShotRanker(model_config(backbone=backbone)).backbone
        convolutions = {n for n, m in network_.named_modules() if isinstance(m, torch.nn.Conv2d)}
        found = layers_of(network_)
        assert set(found) == convolutions
        assert len(found) == len(convolutions)


def test_ranges_hold_the_bulk_and_not_the_outlier() -> None:
    counts = np.zeros(1024)
    counts[:256] = 1e5  # evenly up to a quarter
    counts[-1] = 1
    assert least_loss(counts, 0.0, 4.0)[0] == 0
    assert 0.95 < least_loss(counts, 0.0, 4.0)[1] < 1.5
    assert least_loss(np.full(1024, 1000.0), -2.0, 2.0) == pytest.approx((-2.0, 2.0), rel=0.02)


def test_the_quickest_numbers_of_a_processor(
    weights: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    bare = tmp_path / "bare"
    bare.mkdir()
    for name in CPUINFO:
        pretend(name, tmp_path, monkeypatch)
        assert engine_of(weights) == ("int7" if name == "bfloat16" else name)
        assert engine_of(bare) == {"int8": "bfloat16", "int7": "float32"}.get(name, name)
        assert engine_of(weights, "cuda") == "bfloat16"
        assert quick_bfloat16("cuda")
        assert quick_bfloat16("cpu") == (name in ("int8", "bfloat16"))
    monkeypatch.setattr(engine, "_CPU", tmp_path / "missing")
    assert engine_of(weights) == "float32"
    assert not quick_bfloat16("cpu")


@pytest.mark.parametrize("name", ["bfloat16", "float32"])
def test_without_whole_numbers_it_goes_on_in_fractions(
    name: str, weights: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    model, _ = load_model(weights)
    save_weights(tmp_path / "bare", model)
    frames = clips(2, 4)
    exact = Ranker.load(weights, "cpu").score(frames)
    pretend(name, tmp_path, monkeypatch)
    for folder in (weights, tmp_path / "bare")[name == "bfloat16" :]:
        ranker = Ranker.load(folder, "cpu")
        assert ranker.engine == name == engine_of(folder)
        np.testing.assert_allclose(ranker.score(frames).margin, exact.margin, atol=0.3)


@pytest.mark.parametrize(("whole_", "instead"), [("int8", "bfloat16"), ("int7", "float32")])
def test_a_torch_without_the_operators_goes_on_in_fractions(
    whole_: str, instead: str, weights: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def lacking(*given: object) -> None:
        raise AttributeError("'_OpNamespace' 'onednn' object has no attribute 'qconv_prepack'")

    pretend(whole_, tmp_path, monkeypatch)
    monkeypatch.setattr("ranker.infer.Int8Backbone", lacking)
    assert Ranker.load(weights, "cpu").engine == instead


def test_sums_of_pairs_stay_within_sixteen_bits(whole: str) -> None:
    """The whitest picture and the largest weights, next to each other: what would be cut off first."""
    model = network("resnet18")
    folded = fold_batch_norm(model.backbone)
    with torch.no_grad():
        for convolution in (folded.conv1, folded.layer1[0].conv1):
            convolution.weight.copy_(
                convolution.weight.sign() * convolution.weight.abs().amax((1, 2, 3), True)
            )
            convolution.weight.abs_()
    bright = torch.full((FRAMES, SIZE, SIZE, 3), 255, dtype=torch.uint8)
    ranges = measured_ranges(folded, [normalised(bright)])
    with torch.no_grad():
        exact = folded(normalised(bright))
    got = Int8Backbone(folded, ranges, FRAMES, SIZE, HIGHEST[whole])(bright)
    assert float((got - exact).norm()) < 0.1 * float(exact.norm())


@pytest.mark.parametrize("how", ["no json", "a list", "schema", "other weights", "a layer less", "no number"])
def test_a_wrong_file_of_ranges_is_named(weights: Path, tmp_path: Path, how: str) -> None:
    for file in weights.iterdir():
        (tmp_path / file.name).write_bytes(file.read_bytes())
    path = tmp_path / INT8
    values = json.loads(path.read_text())
    if how == "schema":
        values["schema"] = "vds.other/1"
    elif how == "other weights":
        values["weights"] = "0" * 64
    elif how == "a layer less":
        del values["ranges"]["layer1.0.conv1"]
    elif how == "no number":
        values["ranges"]["conv1"] = [0, float("nan")]
    path.write_text({"no json": "{", "a list": "[]"}.get(how) or json.dumps(values))
    with pytest.raises(
        RankerError, match=r"int8\.json: .*other weights" if how == "other weights" else "damaged"
    ):
        Ranker.load(tmp_path, "cpu")


def test_ranges_survive_the_disk_and_go_with_their_weights(tmp_path: Path) -> None:
    model = network("resnet18")
    ranges = ranges_of(model)
    save_weights(tmp_path, model, ranges=ranges)
    loaded, card = load_model(tmp_path)
    again = load_ranges(tmp_path, loaded, card)
    assert again is not None
    assert list(again) == list(ranges)
    np.testing.assert_allclose(list(again.values()), list(ranges.values()), rtol=1e-5)
    save_weights(tmp_path, model)
    assert load_ranges(tmp_path, loaded, load_card(tmp_path)) is None
