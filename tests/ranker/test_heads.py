"""The last layers of a network taught alone, by clips that the rest was not taught by."""

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

from ranker.config import HEADS, Phase
from ranker.data import Dataset, ShardWriter
from ranker.errors import RankerError
from ranker.guided import Guided
from ranker.guides import CHANNELS, FLOW, MARKS, SIDE, SUBJECT_MARKS, Guides, pairs
from ranker.heads import teach_heads
from ranker.infer import Ranker
from ranker.model import Output, ShotRanker, frame_times
from ranker.starting import take_over
from ranker.train import train
from ranker.weights import load_model, save_weights

_HEADS = ("straight", "judged", "reader_guided", "reasons_guided", "faults_guided")
_NUMBERS = dict(
    guides=16, moments=True, marks=2, measures=3, first_fault=0, faults=1, people=True, crowd=True
)
_MINE = replace(HEADS, heads=60, threads=1, augment=False, glanced=0.0, autocast=False)


def write_hidden(folder: Path, count: int, seed: int) -> None:
    """Clips of somebody before whom something near is, or nothing: a fault, or a good shot."""
    rng = np.random.default_rng(seed)
    with ShardWriter(folder, WORDS, (SIZE, SIZE), FRAMES, shard=64) as writer:
        for i in range(count):
            fault = i % 2 == 1
            maps = rng.integers(1, 60, (1, FRAMES, SIDE, SIDE, len(CHANNELS)), dtype=np.uint8)
            maps[..., CHANNELS.index("rise")], maps[..., CHANNELS.index("subject")] = 128, 0
            if fault:
                maps[..., : SIDE // 3, CHANNELS.index("nearness")] = 250
            flow = np.zeros((1, len(pairs(FRAMES)), FLOW, FLOW, 2), np.float16)
            marks = rng.normal(0, 0.2, (1, FRAMES, len(MARKS)))
            marks[..., MARKS.index("distance")], marks[..., MARKS.index("lens")] = 1.4, 3.5
            marks[..., len(SUBJECT_MARKS) :] = np.nan
            about = {
                "hints": {"fault_foreground": float(fault), "good_all": 1.0 - fault, "speed": rng.normal()},
                "frames": {"near": rng.normal(size=FRAMES).tolist(), "far": rng.normal(size=FRAMES).tolist()},
                "opinion": float(rng.normal()) - 3 * fault,
            }
            words = WORDS.movements[0], WORDS.scales[i // 2 % 2], WORDS.angles[0]
            guides = Guides(maps, flow, marks.astype(np.float16))
            writer.add(
                clip(rng, True, 0, 0, 0), not fault, *words, f"g{i % 5}", float(fault), "", about, guides
            )


def judged(model: ShotRanker, data: Dataset) -> Output:
    """What a network says of clips by their guides alone."""
    guides, times = data.guides(np.arange(len(data))), frame_times(model.config)
    assert guides is not None
    nothing = torch.zeros(len(data), FRAMES, model.described)
    with torch.inference_mode():
        told = Guided.of(guides, times)
        return model.judge(nothing, times.expand(len(data), -1), None, told, pictures=False)


@pytest.fixture(scope="module")
def clips(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("hidden")
    write_hidden(folder, 96, 0)
    return folder


def some_network() -> ShotRanker:
    torch.manual_seed(0)
    return ShotRanker(model_config(**_NUMBERS)).eval()


def test_heads_learn_a_fault_and_nothing_else_changes(clips: Path) -> None:
    data, model = Dataset(clips), some_network()
    before = {name: value.clone() for name, value in model.state_dict().items()}
    lines: list[dict[str, float]] = []
    teach_heads(model, data, np.arange(len(data)), _MINE, lines.append)
    assert [line["heads"] for line in lines] == list(range(1, 61))
    assert lines[-1]["loss"] < 0.7 * lines[0]["loss"]
    faults = judged(model, data).told[:, 0].numpy()
    right = data.professional < 0.5
    assert faults[right].min() > faults[~right].max()
    for name, value in model.state_dict().items():
        if not name.startswith(_HEADS):
            assert torch.equal(value, before[name]), name
    assert all(p.requires_grad for p in model.parameters())


def test_heads_that_learn_nothing_tell_what_they_told(clips: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What is added is put into the heads without changing it."""
    data, model = Dataset(clips), some_network()
    torch.nn.init.normal_(model.straight.weight, std=0.02)
    before = judged(model, data)
    for name in ("_RATE", "_SIZES", "_JUDGES"):
        monkeypatch.setattr(f"ranker.heads.{name}", 0.0)
    teach_heads(model, data, np.arange(len(data)), replace(_MINE, heads=2))
    now = judged(model, data)
    torch.testing.assert_close(now.told, before.told, atol=1e-3, rtol=1e-3)
    torch.testing.assert_close(now.logit, before.logit, atol=1e-3, rtol=1e-3)


def test_a_training_of_heads_alone_begins_with_weights_and_says_so(clips: Path, tmp_path: Path) -> None:
    phases = (Phase(2, 0, batch=32), replace(TINY.phases[0], epochs=1))
    taught = replace(TINY, phases=phases, guides=16, motion=0, hint_weight=1.0, order_weight=1.0)
    train(clips, tmp_path / "first", taught)
    write_hidden(tmp_path / "others", 64, 1)
    alone = replace(taught, phases=(), heads=3, seed=4)
    first = tmp_path / "first" / "weights"
    train(tmp_path / "others", tmp_path / "out", alone, start=first)
    (one, before), (other, card) = (load_model(f) for f in (first, tmp_path / "out" / "weights"))
    assert card.training["heads"] == 3
    assert card.training["start"] == before.sha256
    lines = [json.loads(line) for line in (tmp_path / "out" / "log.jsonl").read_text().splitlines()]
    assert [line["heads"] for line in lines if "heads" in line] == [1, 2, 3]
    ours, theirs = one.state_dict(), other.state_dict()
    same = {n for n in ours if torch.equal(ours[n], theirs[n])}
    assert "guided.marks.0.weight" in same
    assert "backbone.conv1.weight" in same
    assert "straight.weight" not in same
    assert {"guided.evened.middle", "backbone.bn1.running_mean"} <= same  # what is usual is so as before
    assert Ranker.load(tmp_path / "out" / "weights", "cpu").judges_guides


def test_heads_alone_need_weights_and_guides(clips: Path, tmp_path: Path) -> None:
    with pytest.raises(RankerError, match="name some to start from"):
        train(clips, tmp_path / "out", HEADS)
    write_clips(tmp_path / "plain", 8)
    with pytest.raises(RankerError, match="there are none"):
        teach_heads(some_network(), Dataset(tmp_path / "plain"), np.arange(8), _MINE)


def test_a_network_starts_from_weights_of_fewer_numbers_about_people(tmp_path: Path, clips: Path) -> None:
    """Numbers that were added since say nothing at first, so that all is judged as before."""
    data, ours = Dataset(clips), some_network()
    torch.nn.init.normal_(ours.straight.weight, std=0.02)
    fewer, wide = 5, ours.straight.in_features
    with torch.no_grad():
        for head in (ours.straight, ours.get_submodule("gathered.0")):
            head.weight[:, wide - fewer :] = 0.0  # type: ignore[index, union-attr, operator]
    save_weights(tmp_path, ours)
    before = judged(load_model(tmp_path)[0], data)  # as they are kept
    _shorten(tmp_path, wide - fewer)
    other = some_network()
    _, taken = take_over(other, tmp_path)
    assert taken["straight.weight"][:, wide - fewer :].isnan().all()
    now = judged(other, data)
    torch.testing.assert_close(now.logit, before.logit, atol=1e-4, rtol=1e-4)
    torch.testing.assert_close(now.told, before.told, atol=1e-4, rtol=1e-4)


def _shorten(folder: Path, columns: int) -> None:
    """Make weights of those that read so many numbers of a shot."""
    path = folder / "model.safetensors"
    tensors = load_file(path)
    for name in ("straight.weight", "gathered.0.weight"):
        tensors[name] = tensors[name][:, :columns].contiguous()
    save_file(tensors, path)
    card = json.loads((folder / "config.json").read_text())
    card["sha256"] = hashlib.sha256(path.read_bytes()).hexdigest()
    (folder / "config.json").write_text(json.dumps(card))
