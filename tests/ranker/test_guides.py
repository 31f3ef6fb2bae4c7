"""Guides beside pictures: on disk, in the mirror, and what a network makes of them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import torch
from ranker_clips import FRAMES, SIZE, TINY, WORDS, clip, model_config

from ranker.batches import batches, mirror_words
from ranker.composed import COMPOSED, EYES_INSIDE, SUMMED, composed, over_time
from ranker.config import Phase
from ranker.data import Dataset, ShardWriter
from ranker.errors import RankerError
from ranker.evaluate import agreement_with_fp32, evaluate
from ranker.guided import Evened, Guided, _paces
from ranker.guides import CHANNELS, FLOW, MARKS, POINTS, SIDE, SUBJECT_MARKS, Guides, joined, pairs
from ranker.infer import Ranker
from ranker.model import ShotRanker, frame_times, normalised
from ranker.train import train
from ranker.weights import load_model


def guides_of(rng: np.random.Generator, good: bool, movement: int) -> Guides:
    """A subject that is in the upper half where the shot is good, and a camera that pans."""
    maps = rng.integers(100, 110, (1, FRAMES, SIDE, SIDE, len(CHANNELS)), dtype=np.uint8)
    maps[..., 0] = 0
    top = 4 if good else 20
    maps[:, :, top : top + 8, 10:16, 0] = 255
    flow = rng.normal(0, 0.003, (1, len(pairs(FRAMES)), FLOW, FLOW, 2))
    flow[..., 0] += (0, 0.2, -0.2)[movement]
    marks = rng.normal(0, 0.1, (1, FRAMES, len(MARKS))).astype(np.float16)
    marks[..., MARKS.index("right_other_2")] = np.nan
    marks[..., len(SUBJECT_MARKS) :] = np.nan  # there is nobody else
    return Guides(maps, flow.astype(np.float16), marks)


def write_guided(folder: Path, count: int, bare: int = 0) -> None:
    """Clips whose pictures say nothing: only their guides tell the good and how the camera moves."""
    rng = np.random.default_rng(0)
    with ShardWriter(folder, WORDS, (SIZE, SIZE), FRAMES, shard=16) as writer:
        for i in range(count):
            good, m = i % 2 == 0, i // 2 % 3
            pictures = clip(rng, True, 0, 0, 0)
            words = WORDS.movements[m], WORDS.scales[0], WORDS.angles[0]
            about = {"grade": 0.25, "opinion": 0.8} if good else {"opinion": 0.4, "doubtful": i == 3}
            guides = guides_of(rng, good, m) if i >= bare else None
            writer.add(pictures, good, *words, f"group-{i % 5}", 1.0 - good, "", about, guides)


def test_guides_lie_beside_the_frames_of_their_clips(tmp_path: Path) -> None:
    write_guided(tmp_path, 40)
    data = Dataset(tmp_path)
    found = data.guides(np.array([39, 0, 17]))
    assert found is not None
    np.testing.assert_array_equal(found.maps[..., 0].max((1, 3, 2)) > 0, True)
    assert (found.maps[0, 0, 22, 12, 0], found.maps[1, 0, 6, 12, 0]) == (255, 255)
    some = data.guides(np.array([39]), [2, 0])
    assert some is not None
    np.testing.assert_array_equal(some.maps[0], found.maps[0][[2, 0]])
    np.testing.assert_array_equal(some.marks[0], found.marks[0][[2, 0]])
    np.testing.assert_array_equal(data.grade[:4], [0.25, 0, 0.25, 0])
    assert np.isnan(data.liked[3])  # that one is doubtful
    np.testing.assert_array_equal(data.liked[[1, 5, 7]], -3.0)  # bad ones are liked less than any
    np.testing.assert_array_equal(data.liked[::2], 0.0)  # all good ones are liked alike


def test_a_set_in_which_none_has_any_is_taught_without(tmp_path: Path) -> None:
    write_guided(tmp_path / "data", 24, bare=24)
    data = Dataset(tmp_path / "data")
    assert len(data) == 24
    assert data.guides(np.arange(3)) is None
    phases = (Phase(1, 0, batch=8), replace(TINY.phases[0], epochs=1))
    train(tmp_path / "data", tmp_path / "out", replace(TINY, phases=phases))
    assert Ranker.load(tmp_path / "out" / "weights", "cpu").config.guides == 0
    with pytest.raises(RankerError, match="no guides, and the recipe looks at nothing else"):
        train(tmp_path / "data", tmp_path / "other", replace(TINY, phases=phases[:1]))


def test_films_beside_clips_with_guides_are_learnt_by_their_pictures(tmp_path: Path) -> None:
    """A handful of films of cameras once switched off the guides of all other clips."""
    write_guided(tmp_path / "data", 60, bare=5)
    data = Dataset(tmp_path / "data")
    np.testing.assert_array_equal(data.guided, np.arange(60) >= 5)
    mixed = data.guides(np.array([2, 10]))
    assert mixed is not None
    known = Guided.of(mixed, frame_times(model_config())).known
    assert known.tolist() == [False, True]
    config = replace(TINY, guides=32, unguided=0.0, motion=32)
    (batch,) = batches(data, np.arange(5), config.phases[0], config, 0)
    assert batch.guides is not None
    assert not batch.guides.known.any()
    phases = (Phase(8, 0, batch=8), replace(TINY.phases[0], epochs=1))
    lines: list[dict] = []
    train(tmp_path / "data", tmp_path / "out", replace(config, phases=phases), lines.append)
    model, ranker = load_model(tmp_path / "out/weights")[0], Ranker.load(tmp_path / "out/weights", "cpu")
    assert ranker.config.guides == 32
    assert lines[0]["steps"] == 8 * 7 + 4  # of 55 by guides, of 60 by pictures
    told = evaluate(ranker, data, np.arange(60))
    alone = evaluate(ranker, data, np.arange(60), guided=False)
    assert told["auc"] > alone["auc"] + 0.2  # pictures say nothing
    films = np.array([0, 1, 2, 4])  # number 3 is doubtful
    by_pictures = ranker.score(_pictures(data, films)).logit > 0
    some = evaluate(ranker, data, films)["accuracy"]["professional"]
    assert some == np.mean(by_pictures == (data.professional[films] > 0.5))
    exact = agreement_with_fp32(model, ranker, data, np.arange(12), guided=False)
    assert exact is not None
    assert exact > 0.9


def _pictures(data: Dataset, clips: np.ndarray) -> np.ndarray:
    return np.stack([data.clip(int(i), range(FRAMES), SIZE) for i in clips])


def test_damaged_guides_are_told(tmp_path: Path) -> None:
    write_guided(tmp_path, 16)
    kept = np.load(tmp_path / "shard-00000.marks.npy")
    np.save(tmp_path / "shard-00000.marks.npy", kept[..., 1:])
    with pytest.raises(RankerError, match="damaged"):
        Dataset(tmp_path)
    np.save(tmp_path / "shard-00000.marks.npy", kept)
    Dataset(tmp_path)
    np.save(tmp_path / "shard-00000.flow.npy", np.zeros((3, 1, FLOW, FLOW, 2), np.float16))
    with pytest.raises(RankerError, match="damaged"):
        Dataset(tmp_path)


def test_the_mirror_turns_maps_and_motion() -> None:
    rng = np.random.default_rng(1)
    guides = joined([guides_of(rng, True, 1), guides_of(rng, False, 0)])
    mirrored = guides.mirrored()
    np.testing.assert_array_equal(mirrored.maps[:, :, :, 0], guides.maps[:, :, :, -1])
    np.testing.assert_array_equal(mirrored.flow[:, :, :, 0, 0], -guides.flow[:, :, :, -1, 0])
    np.testing.assert_array_equal(mirrored.flow[:, :, :, 0, 1], guides.flow[:, :, :, -1, 1])
    np.testing.assert_array_equal(mirrored.mirrored().maps, guides.maps)
    own, seen = ({n: g.marks[..., k] for k, n in enumerate(MARKS)} for g in (guides, mirrored))
    np.testing.assert_array_equal(seen["right_eyes"], -own["right_eyes"])
    np.testing.assert_array_equal(seen["right_face"], -own["right_face"])
    np.testing.assert_array_equal(seen["up_eyes"], own["up_eyes"])
    np.testing.assert_array_equal(seen["right_hand_l"], -own["right_hand_r"])  # the other hand
    np.testing.assert_array_equal(seen["covered_hand_r"], own["covered_hand_l"])
    np.testing.assert_array_equal(mirrored.mirrored().marks, guides.marks)


def test_composition_is_what_marks_say() -> None:
    marks = torch.zeros(1, 3, len(MARKS))
    at = {name: k for k, name in enumerate(MARKS)}
    marks[..., at["right_eyes"]] = torch.tensor([0.5, -0.4, 1.5])
    marks[..., at["up_eyes"]] = 1 / 3
    marks[..., at["up_top"]] = 1.4
    marks[..., at["up_crown"]] = 1.2
    marks[..., at["right_face"]] = -0.8
    marks[..., at["right_feet"]] = torch.nan
    marks[..., at["covered_eyes"]] = torch.tensor([0.02, 0.1, torch.nan])  # of 4 m: 8 and 38 cm nearer
    marks[..., at["distance"]] = np.log(4.0)
    marks[..., at["before_eyes"]] = torch.tensor([0.0, 0.1, torch.nan])
    near = torch.zeros(1, 3, SIDE, SIDE, dtype=torch.uint8)
    near[:, 1] = 1 + round(254 * np.log(64 / 1.0) / np.log(64 / 0.25))  # a metre away, all over the frame
    found = composed(marks, near)
    assert found.shape == (1, 3, COMPOSED)
    assert found.isfinite().all()
    here = found[0, :, EYES_INSIDE]
    assert here[0] > 0.99
    assert here[1] > 0.99
    assert here[2] < 0.01
    covered = found[0, :, EYES_INSIDE - len(POINTS)]
    assert covered[0] < 0.05
    assert covered[1] > 0.95
    own = len(SUBJECT_MARKS)
    there, begin = found[0, 0, own:], own + len(POINTS)
    assert there[: len(POINTS)].tolist() == [float(name != "feet") for name in POINTS]
    lead, thirds, aside, hat, above = found[0, :, begin : begin + 5].T
    torch.testing.assert_close(lead, torch.tensor([0.4, -0.32, 1.2]))
    assert thirds.abs().max() < 1e-6
    torch.testing.assert_close(aside, torch.tensor([0.5, 0.4, 1.5]))
    torch.testing.assert_close(hat, torch.full((3,), 0.4))
    torch.testing.assert_close(above, torch.full((3,), 0.2))
    whole, eyes, middle, head, hands, others, nobody = found[0, :, begin + 28 : begin + 35].T
    torch.testing.assert_close(whole[:2], torch.tensor([1.0, 6 / 7]), atol=0.02, rtol=0.0)  # of seven points
    torch.testing.assert_close(eyes, torch.tensor([1.0, 0.0, 0.0]), atol=0.06, rtol=0.0)
    torch.testing.assert_close(middle, torch.tensor([1.0, 1.0, 0.0]), atol=0.02, rtol=0.0)
    torch.testing.assert_close(head, middle)
    assert min(hands.min(), others.min()) > 0.95
    assert nobody.max() < 0.05
    before, hidden = found[0, :, begin + 10 : begin + 12].T  # whatever it is, their own hand too
    torch.testing.assert_close(before, torch.tensor([0.0, 0.381, 0.0]), atol=1e-3, rtol=0.0)
    torch.testing.assert_close(hidden, torch.tensor([0.0, 1.0, 0.0]), atol=0.02, rtol=0.0)
    off = found[0, :, begin + 12 : begin + 17]  # the lines that sizes put a head on
    torch.testing.assert_close(off[0], torch.tensor([0.58, 0.94, 1.32, 0.36, 0.0667]), atol=1e-3, rtol=0.0)
    looks = found[0, :, begin + 17 : begin + 28]  # and the shares that are nearer
    assert looks[0].max() < 0.01
    assert looks[1].min() > 0.95


def test_numbers_are_scaled_by_good_shots_and_none_is_lost_far_off() -> None:
    good = torch.tensor([[1.0, 5.0], [3.0, 5.0]])
    every = torch.cat([good, torch.tensor([[102.0, 7.0], [-90.0, 3.0]])])
    evened = Evened(2)
    evened.fit(good, every)
    near, far = evened(torch.tensor([[2.5, 5.0], [500.0, 6.0]]))
    spread = 0.1 * every[:, 0].std(correction=0)  # good ones are hardly apart beside all
    torch.testing.assert_close(near, torch.stack([torch.asinh(0.5 / spread), torch.tensor(0.0)]))
    assert 3 < far[0] < 5
    assert float(far[1]) == pytest.approx(
        np.arcsinh(1 / (0.1 * float(every[:, 1].std(correction=0)))), rel=1e-5
    )


def test_how_fast_a_camera_turns_is_what_its_flow_and_its_lens_say() -> None:
    guides = guides_of(np.random.default_rng(2), True, 0)
    flow = np.zeros_like(guides.flow)
    marks = guides.marks.copy()
    marks[..., MARKS.index("lens")], marks[..., MARKS.index("seconds")] = np.log(36.0), np.log(2.0)
    flow[:, 1, ..., 0] = 0.2  # between the second frame and the third
    times = torch.linspace(0, 1, FRAMES).expand(1, -1)
    fastest, mean, change = _paces(Guided.of(Guides(guides.maps, flow, marks), times[0]))[0].tolist()
    step = 2.0 / (FRAMES - 1)
    assert fastest == pytest.approx(np.arcsinh(0.2 * 18 / 36 / step / 0.2), rel=2e-2)
    assert mean == pytest.approx(fastest / (FRAMES - 1), rel=1e-4)
    assert change == pytest.approx(fastest, rel=1e-4)
    unknown = Guides(guides.maps, flow * np.float16(np.nan), marks)
    assert _paces(Guided.of(unknown, times[0])).abs().max() == 0


def test_what_is_summed_up_over_a_shot() -> None:
    times = torch.linspace(0, 1, 8).expand(1, -1)
    features = torch.arange(8.0).view(1, 8, 1)
    found = over_time(features, times, (times > 0.7).float())[0]
    assert found.shape == (SUMMED,)
    average, slope, _, least, most, quarter, half, last, second, inside = found.tolist()
    assert [average, slope, least, most] == pytest.approx([3.5, 7.0, 0.0, 7.0], abs=1e-4)
    assert quarter < 1 < half < 2.5
    assert last == pytest.approx(7 - quarter, abs=0.05)
    assert second == pytest.approx(7 - half, abs=0.05)
    assert inside == pytest.approx(6.0, abs=0.05)
    never = over_time(features, times, torch.zeros(1, 8))[0, -1]
    assert float(never) == 0.0


def test_a_shot_without_guides_is_judged_as_by_a_network_without() -> None:
    torch.manual_seed(0)
    config = model_config(guides=16, measures=3, marks=2)
    model = ShotRanker(config).eval()
    without = ShotRanker(replace(config, guides=0)).eval()
    own = model.state_dict()
    without.load_state_dict({name: own[name] for name in without.state_dict()})
    rng = np.random.default_rng(2)
    pictures = normalised(torch.from_numpy(np.stack([clip(rng, True, 1, 0, 0), clip(rng, False, 2, 1, 1)])))
    times = frame_times(config).expand(2, -1)
    guides = joined([guides_of(rng, True, 1), guides_of(rng, False, 0)])
    kept_back = Guides(np.zeros_like(guides.maps), np.full_like(guides.flow, np.nan), guides.marks)
    with torch.inference_mode():
        plain, none = without(pictures, times), model(pictures, times)
        empty = model(pictures, times, None, Guided.of(kept_back, times[0]))
        told = model(pictures, times, None, Guided.of(guides, times[0]))
    for name in ("logit", "movement", "scale", "angle", "told"):
        torch.testing.assert_close(getattr(none, name), getattr(plain, name))
        torch.testing.assert_close(getattr(empty, name), getattr(plain, name))
    assert (told.logit - plain.logit).abs().max() > 1e-4


def test_guides_are_learnt_from_and_a_shot_is_judged_by_its_own(tmp_path: Path) -> None:
    write_guided(tmp_path / "data", 60)
    phases = (Phase(120, 0, batch=16), replace(TINY.phases[0], epochs=1))
    config = replace(TINY, phases=phases, unguided=0.0, guides=32, motion=0)
    train(tmp_path / "data", tmp_path / "out", config)
    ranker = Ranker.load(tmp_path / "out" / "weights", "cpu")
    rng = np.random.default_rng(5)
    frames = np.stack([clip(rng, True, 0, 0, 0) for _ in range(6)])
    guides = joined([guides_of(rng, k % 2 == 0, k // 2) for k in range(6)])
    scores = ranker.score(frames, guides)
    assert scores.margin[::2].min() > scores.margin[1::2].max()
    np.testing.assert_array_equal(scores.movement.argmax(1), [0, 0, 1, 1, 2, 2])
    one = ranker.score(frames[3:4], guides[3:4])
    np.testing.assert_array_equal(one.margin, scores.margin[3:4])
    at = (0, 2)
    some = guides.maps[:, list(at)], np.full_like(guides.flow, np.nan), guides.marks[:, list(at)]
    glanced = ranker.glance(frames[:, list(at)], at, Guides(*some))
    assert glanced.margin[::2].min() > glanced.margin[1::2].max()
    assert ranker.judges_guides
    alone = ranker.by_guides(guides)
    assert alone.margin[::2].min() > alone.margin[1::2].max()
    assert alone.feature.shape == scores.feature.shape
    assert not alone.feature.any()
    with pytest.raises(ValueError, match="guides: expected"):
        ranker.by_guides(Guides(*some))
    untaught = Ranker(load_model(tmp_path / "out" / "weights")[0], "cpu")
    with pytest.raises(ValueError, match="need pictures"):
        untaught.by_guides(guides)
    with pytest.raises(ValueError, match="guides: expected"):
        ranker.score(frames, guides[:5])
    assert ranker.score(frames[:0], guides[:0]).margin.shape == (0,)


def test_a_good_clip_that_is_only_just_good_is_taught_as_less(tmp_path: Path) -> None:
    write_guided(tmp_path, 16)
    config = replace(TINY, graded=0.4)
    clips = np.arange(16)
    batch = next(batches(Dataset(tmp_path), clips, Phase(1, 0, batch=16), config, 0))
    assert batch.query is None
    by_clip = dict(zip(batch.clips.tolist(), batch.professional.tolist(), strict=True))
    assert [by_clip[i] for i in (0, 1, 2)] == pytest.approx([1 - 0.4 * 0.75, 0, 1 - 0.4 * 0.75])


def test_what_is_liked_better_is_taught_to_come_first(tmp_path: Path) -> None:
    """Good clips that differ in what is said of them alone: the labels put them all on one level."""
    rng = np.random.default_rng(6)
    with ShardWriter(tmp_path / "data", WORDS, (SIZE, SIZE), FRAMES, shard=16) as writer:
        for i in range(64):
            much = i % 4 == 0
            about = {"opinion": 0.95 if much else 0.75}
            guides = guides_of(rng, much, 0)
            writer.add(clip(rng, True, 0, 0, 0), True, None, None, None, f"g{i % 5}", 0.0, "", about, guides)
    phases = (Phase(30, 0, batch=16), replace(TINY.phases[0], epochs=1))
    config = replace(TINY, phases=phases, unguided=0.0, guides=32, motion=0, graded=0.0, smoothing=0.02)
    frames = np.stack([clip(rng, True, 0, 0, 0) for _ in range(6)])
    guides = joined([guides_of(rng, k % 2 == 0, 0) for k in range(6)])
    apart = []
    for weight in (0.0, 2.0):
        train(tmp_path / "data", tmp_path / f"{weight}", replace(config, order_weight=weight))
        ranker = Ranker.load(tmp_path / f"{weight}" / "weights", "cpu")
        scores = ranker.score(frames, guides)
        apart.append(scores.margin[::2].min() - scores.margin[1::2].max())
        assert (ranker.config.liking > 0) == (weight > 0)
        np.testing.assert_array_equal((scores.margin != scores.logit).all(), weight > 0)
    assert apart[1] > max(1.0, apart[0] + 0.5)
    # by deviations: a quarter is 1.73 above the mean, the rest 0.58 below
    np.testing.assert_allclose(
        Dataset(tmp_path / "data").liked[:4], [1.732, -0.577, -0.577, -0.577], atol=1e-3
    )


def test_clips_without_frames_are_learnt_from_by_their_guides_alone(tmp_path: Path) -> None:
    rng = np.random.default_rng(3)
    data = tmp_path / "data"
    with ShardWriter(data, WORDS, (SIZE, SIZE), FRAMES, shard=16) as writer:
        for i in range(48):
            good, m = i % 2 == 0, i // 2 % 3
            words = WORDS.movements[m], WORDS.scales[0], WORDS.angles[0]
            pictures = clip(rng, True, 0, 0, 0) if i % 4 == 1 else None
            writer.add(pictures, good, *words, "a", 1.0 - good, "", {"n": i}, guides_of(rng, good, m))
    assert len(writer) == 12
    found = Dataset(data)
    assert (found.about()["clips"], found.about()["bare"], len(found)) == (12, 36, 48)
    for index, label in enumerate(found.labels):
        assert label.bare == (label.about["n"] % 4 != 1) == found.bare[index]
        own = found.guides(np.array([index]))
        assert own is not None
        assert own.maps[0, 0, 6, 12, 0] == (255 if label.professional else 0)
        if not label.bare:
            assert found.clip(index, [0], SIZE).shape == (1, SIZE, SIZE, 3)
    with pytest.raises(ValueError, match="needs guides"):
        writer.add(None, True, None, None, None, "a", 0.0)
    phases = (Phase(120, 0, batch=16), replace(TINY.phases[0], epochs=1, batch=6))
    train(data, tmp_path / "out", replace(TINY, phases=phases, unguided=0.0, guides=32))
    ranker = Ranker.load(tmp_path / "out" / "weights", "cpu")
    frames = np.stack([clip(rng, True, 0, 0, 0) for _ in range(4)])
    guides = joined([guides_of(rng, k % 2 == 0, 0) for k in range(4)])
    margin = ranker.score(frames, guides).margin
    assert margin[::2].min() > margin[1::2].max()


def test_a_batch_of_guides_is_its_clips_some_of_them_in_the_mirror(tmp_path: Path) -> None:
    rng = np.random.default_rng(3)
    with ShardWriter(tmp_path, WORDS, (SIZE, SIZE), FRAMES, shard=16) as writer:
        for i in range(24):
            words = WORDS.movements[i % 3], WORDS.scales[0], WORDS.angles[0]
            about = {"hints": {"right_way": float(rng.normal()), "speed": float(rng.normal())}}
            about["frames"] = {"right_eyes": rng.normal(size=FRAMES).tolist()}
            writer.add(None, i % 2 == 0, *words, "a", 0.0, "", about, guides_of(rng, i % 2 == 0, i % 3))
    data = Dataset(tmp_path)
    phase, clips = Phase(1, 0, batch=24), np.arange(24)
    (batch,) = batches(data, clips, phase, replace(TINY, augment=True, glanced=0.0), 0)
    assert batch.guides is not None
    assert batch.query is None
    swapped = mirror_words(WORDS.movements)
    turned = 0
    for row, index in enumerate(batch.clips.tolist()):
        own = data.guides(np.array([index]))
        assert own is not None
        flipped = not np.array_equal(batch.guides.maps[row].numpy(), own.maps[0])
        seen = own.mirrored() if flipped else own
        np.testing.assert_array_equal(batch.guides.maps[row].numpy(), seen.maps[0])
        np.testing.assert_array_equal(batch.guides.flow[row].numpy(), seen.flow[0].astype(np.float32))
        np.testing.assert_array_equal(batch.guides.marks[row].numpy(), seen.marks[0].astype(np.float32))
        word, sign = int(data.classes[index, 0]), -1.0 if flipped else 1.0
        assert int(batch.classes[row, 0]) == (swapped[word] if flipped else word)
        np.testing.assert_array_equal(batch.hints[row].numpy(), data.hints[1][index] * (sign, 1.0))
        np.testing.assert_array_equal(batch.mapped[row].numpy(), data.frame_hints[1][index] * sign)
        turned += flipped
    assert 4 < turned < 20
    (glance,) = batches(data, clips, phase, replace(TINY, augment=True, glanced=1.0), 0)
    assert glance.guides is not None
    assert glance.guides.maps.shape[:2] == glance.query_times.shape == glance.mapped.shape[:2] == (24, 2)
    assert (glance.query_times[:, 0] < glance.query_times[:, 1]).all()
    assert glance.guides.flow.isnan().all()
