"""Which frames of a shot are meant to show its subject: told by the guides, and looked at by themselves."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import torch
from ranker_clips import FRAMES, SIZE, TINY, WORDS, clip, model_config

from ranker.composed import WINDOWED, over_window
from ranker.config import Phase
from ranker.data import Dataset, ShardWriter
from ranker.guided import Guided
from ranker.guides import CHANNELS, FLOW, MARKS, SIDE, SUBJECT_MARKS, Guides, joined, pairs
from ranker.model import Output, ShotRanker, frame_times
from ranker.starting import take_over
from ranker.train import train
from ranker.weights import load_model, save_weights


def guides_of(rng: np.random.Generator, ends: bool, good: bool) -> Guides:
    """A camera that pans to its subject or away from it, who stands high in the frames that are meant if the
    shot is good, and low if not; in the others they may stand anywhere."""
    maps = rng.integers(100, 110, (1, FRAMES, SIDE, SIDE, len(CHANNELS)), dtype=np.uint8)
    maps[..., 0] = 0
    for t in range(FRAMES):
        meant = (t >= FRAMES // 2) == ends
        top = (4 if good else 20) if meant else int(rng.choice((4, 20)))
        maps[:, t, top : top + 8, 10:16, 0] = 255
    flow = rng.normal(0, 0.003, (1, len(pairs(FRAMES)), FLOW, FLOW, 2))
    flow[..., 0] += 0.2 if ends else -0.2
    marks = np.zeros((1, FRAMES, len(MARKS)))
    marks[..., len(SUBJECT_MARKS) :] = np.nan  # there is nobody else
    return Guides(maps, flow.astype(np.float16), marks.astype(np.float16))


def write_panned(folder: Path, count: int) -> None:
    rng = np.random.default_rng(0)
    with ShardWriter(folder, WORDS, (SIZE, SIZE), FRAMES, shard=16) as writer:
        for i in range(count):
            good, ends = i % 2 == 0, i // 2 % 2 == 0
            meant = [int((t >= FRAMES // 2) == ends) for t in range(FRAMES)]
            about = {"hints": {"good_height": float(good)}, "meant": meant}
            words = WORDS.movements[1 + ends], WORDS.scales[0], WORDS.angles[0]
            writer.add(
                clip(rng, True, 0, 0, 0),
                good,
                *words,
                f"group-{i % 5}",
                1.0 - good,
                "",
                about if i % 7 else {**about, "meant": None},
                guides_of(rng, ends, good),
            )


def test_the_frames_meant_are_summed_up_by_themselves() -> None:
    features = torch.tensor([[[1.0], [2.0], [-3.0], [5.0]]])
    found = over_window(features, torch.tensor([[1.0, 1.0, 0.0, 0.0]]))
    assert found.shape == (1, WINDOWED)
    assert found[0].tolist() == pytest.approx([1.5, 1.0, 2.0], abs=1e-3)


def test_which_frames_are_meant_is_known_where_it_is_said(tmp_path: Path) -> None:
    write_panned(tmp_path, 8)
    meant = Dataset(tmp_path).meant
    assert meant.shape == (8, FRAMES)
    assert np.isnan(meant[[0, 7]]).all()
    assert meant[1].tolist() == [0.0] * (FRAMES // 2) + [1.0] * (FRAMES - FRAMES // 2)


def test_which_frames_are_meant_is_learnt_by_how_the_camera_moves(tmp_path: Path) -> None:
    write_panned(tmp_path / "data", 80)
    phases = (Phase(80, 0, batch=16), replace(TINY.phases[0], epochs=1))
    config = replace(TINY, phases=phases, unguided=0.0, guides=32, motion=0, hint_weight=1.0, good_weight=0.5)
    train(tmp_path / "data", tmp_path / "out", config)
    model, card = load_model(tmp_path / "out" / "weights")
    assert card.model.meant
    rng, kinds = np.random.default_rng(5), [(e, g) for e in (True, False) for g in (True, False)] * 3
    guides = joined([guides_of(rng, ends, good) for ends, good in kinds])
    out = judged(model, guides)
    late = np.arange(FRAMES) >= FRAMES // 2
    told = out.meant.numpy() > 0
    assert (told == [late == ends for ends, _ in kinds]).mean() > 0.95
    good = np.array([g for _, g in kinds])
    margin = model.margin(out).numpy()
    assert margin[good].min() > margin[~good].max()


def judged(model: ShotRanker, guides: Guides) -> Output:
    """What a network says of shots by their guides alone."""
    times, count = frame_times(model.config), len(guides)
    nothing = torch.zeros(count, FRAMES, model.described)
    with torch.inference_mode():
        told = Guided.of(guides, times)
        return model.judge(nothing, times.expand(count, -1), None, told, pictures=False)


def test_a_network_that_tells_them_starts_from_weights_that_do_not(tmp_path: Path) -> None:
    """What it adds says nothing at first, so that all is judged as before."""
    torch.manual_seed(0)
    shape = model_config(guides=16, moments=True, marks=2, measures=3)
    other = ShotRanker(shape).eval()
    torch.nn.init.normal_(other.straight.weight, std=0.02)
    save_weights(tmp_path, other)
    other = load_model(tmp_path)[0]
    ours = ShotRanker(replace(shape, meant=True)).eval()
    _, taken = take_over(ours, tmp_path)
    for name in ("gathered.0.weight", "straight.weight"):
        wide = other.state_dict()[name].shape[1]
        assert taken[name][:, :wide].isfinite().all()
        assert taken[name][:, wide:].isnan().all()
    rng = np.random.default_rng(3)
    guides = joined([guides_of(rng, True, True), guides_of(rng, False, False)])
    before, now = (judged(m, guides) for m in (other, ours))
    torch.testing.assert_close(now.logit, before.logit, atol=1e-4, rtol=1e-4)
    torch.testing.assert_close(now.told, before.told, atol=1e-4, rtol=1e-4)
    assert before.meant.shape == (2, 0)
    assert now.meant.shape == (2, FRAMES)


@pytest.mark.parametrize("look", ["people", "crowd"])
def test_a_network_that_looks_at_people_starts_from_weights_that_do_not(tmp_path: Path, look: str) -> None:
    torch.manual_seed(0)
    shape = model_config(guides=16, moments=True, marks=2, measures=3, meant=True)
    other = ShotRanker(shape).eval()
    torch.nn.init.normal_(other.straight.weight, std=0.02)
    save_weights(tmp_path, other)
    other = load_model(tmp_path)[0]
    ours = ShotRanker(replace(shape, **{look: True})).eval()
    _, taken = take_over(ours, tmp_path)
    assert taken["straight.weight"].isnan().any()
    rng = np.random.default_rng(3)
    guides = joined([guides_of(rng, True, True), guides_of(rng, False, False)])
    guides.marks[..., len(SUBJECT_MARKS) :] = rng.normal(0, 1, (2, FRAMES, len(MARKS) - len(SUBJECT_MARKS)))
    before, now = (judged(m, guides) for m in (other, ours))
    for name in ("logit", "told", "meant", "mapped"):
        torch.testing.assert_close(getattr(now, name), getattr(before, name), atol=1e-4, rtol=1e-4)
