"""How a training set is made: stopped and gone on with, by several processes, with few pictures or many."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from ranker.data import Dataset
from ranker.errors import RankerError
from ranker.guides import MARKS
from vdsl.pipeline.casting import Troupe
from vdsl.pipeline.dataset import _Filmed, _leave, _taken, generate


def test_a_training_set_is_nearly_half_good_and_goes_on_where_it_stopped(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("vdsl.pipeline.dataset.Troupe", partial(Troupe, lines=2, cameras=2))
    at_once = generate(tmp_path / "a", 1, seed=4, device="cpu", size=64, processes=1)
    assert generate(tmp_path / "a", 1, seed=4, device="cpu", size=64, processes=1) == at_once
    data = Dataset(tmp_path / "a")
    framed = [label for label in data.labels if not label.bare]
    assert len(framed) == at_once == data.about()["clips"]
    assert data.about()["bare"] == len(data) - at_once > at_once
    good = [label for label in framed if label.professional]
    assert 0.35 * at_once < len(good) <= 0.5 * at_once  # some are none when they are drawn
    assert all(label.strength == 0 and label.about["kind"] == "designer" for label in good)
    assert all(label.strength > 0 and label.split for label in framed if not label.professional)
    names, hints = data.hints
    assert {"thirds_error", "face", "right_panning", "nearness"} <= set(names)
    assert np.isfinite(hints).all()
    names, marks = data.frame_hints
    assert {"right_eyes", "feet", "pitch", "size"} <= set(names)
    assert marks.shape[:2] == (len(data), 8)
    assert np.isfinite(marks).mean() > 0.95
    assert all(0 <= label.about["grade"] <= 1 for label in good)
    guides = data.guides(np.arange(len(data)))
    assert guides is not None
    assert guides.maps.shape == (len(data), 8, 32, 32, 7)
    somebody = np.abs(guides.marks[:, 0, MARKS.index("away_face")]) > 0  # a place has no face
    shown = guides.maps[(data.professional > 0.5) & somebody, ..., 0].max((1, 2, 3))
    assert (shown > 200).mean() > 0.8  # whom a good clip is about is seen in it
    frames = data.clip(0, range(8), 64)
    assert frames.shape == (8, 64, 64, 3)
    assert frames.std() > 10
    with pytest.raises(RankerError, match="another kind"):
        generate(tmp_path / "a", at_once + 1, seed=5, device="cpu", size=64, processes=1)


def test_where_few_stories_get_pictures_the_others_have_guides_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("vdsl.pipeline.dataset.Troupe", partial(Troupe, lines=1, cameras=1))
    film = partial(generate, tmp_path, seed=4, device="cpu", size=48, processes=1)
    framed = film(1, pictures=0.01)
    data = Dataset(tmp_path)
    assert framed == sum(not label.bare for label in data.labels) > 0
    assert {label.split for label in data.labels if not label.bare} == {"test"}
    learnt = [label for label in data.labels if label.split == "train"]
    assert {label.about["kind"] for label in learnt} >= {"designer", "passed-over"}
    assert all(label.bare for label in learnt)
    guides = data.guides(np.arange(len(data)))
    assert guides is not None
    assert data.made["pictures"] == 0.01
    with pytest.raises(RankerError, match="another kind"):
        film(framed + 1)


def test_all_clips_of_a_story_may_get_pictures(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("vdsl.pipeline.dataset.Troupe", partial(Troupe, lines=1, cameras=1))
    film = partial(generate, seed=4, device="cpu", size=48, processes=1)
    film(tmp_path / "some", 1)
    film(tmp_path / "all", 1, every=True)
    some, every = Dataset(tmp_path / "some"), Dataset(tmp_path / "all")
    assert not any(label.bare for label in every.labels)
    assert len(every) == len(some) > sum(not label.bare for label in some.labels)
    again = every.clip(len(every) - 1, range(8), 48)
    assert again.std() > 10
    with pytest.raises(RankerError, match="another kind"):
        film(tmp_path / "all", len(every) + 1)


def test_what_is_stopped_and_gone_on_with_is_the_same_to_the_byte(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    stopping: list[int] = []

    def maker(making: object) -> object:
        def film(number: int) -> list[_Filmed]:
            if number in stopping:
                stopping.remove(number)
                raise KeyboardInterrupt
            rng = np.random.default_rng(number)
            count = int(rng.integers(0, 9))  # of some stories nothing comes
            frames = rng.integers(0, 255, (count, 8, 32, 32, 3), dtype=np.uint8)
            about = {"story": number, "kind": "designer"}
            labels = [(True, "static", None, None, "kitchen", 0.0, "train", about) for _ in range(count)]
            return [_Filmed(frames, labels)] if count else []

        return film

    monkeypatch.setattr("vdsl.pipeline.dataset._maker", maker)
    film = partial(generate, clips=400, seed=4, device="cpu", size=32, processes=1)
    whole = film(tmp_path / "whole")
    for number in (3, 30, 70):
        stopping.append(number)
        with pytest.raises(KeyboardInterrupt):
            film(tmp_path / "stopped")
    assert len(Dataset(tmp_path / "stopped")) < whole
    assert film(tmp_path / "stopped") == whole >= 400
    names = sorted(path.name for path in (tmp_path / "whole").iterdir())
    assert names == sorted(path.name for path in (tmp_path / "stopped").iterdir())
    assert len(names) > 10
    for name in names:
        assert (tmp_path / "whole" / name).read_bytes() == (tmp_path / "stopped" / name).read_bytes(), name


@pytest.mark.slow
def test_several_processes_make_the_set_that_one_makes(tmp_path: Path) -> None:
    for processes in (1, 2):
        generate(tmp_path / f"{processes}", 100, seed=3, device="cpu", size=48, processes=processes)
    one, two = (sorted((tmp_path / f"{n}").iterdir()) for n in (1, 2))
    assert [path.name for path in one] == [path.name for path in two]
    for a, b in zip(one, two, strict=True):
        assert a.read_bytes() == b.read_bytes(), a.name


def test_a_process_that_is_lost_is_told_and_loses_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    class LostPool(ThreadPoolExecutor):
        """Its second story is never told."""

        def __init__(
            self, processes: int, context: object, settle: object, about: tuple[object, ...]
        ) -> None:
            super().__init__(1)
            self.between = Path(str(about[-1]))

        def submit(self, film, number: int):  # type: ignore[no-untyped-def,override]
            return super().submit(self._film, number)

        def _film(self, number: int) -> Path:
            if number > 0:
                raise BrokenProcessPool
            label = (True, None, None, None, "kitchen", 0.0, "train", {"story": number})
            _leave(self.between / "0", [_Filmed([np.zeros((8, 48, 48, 3), np.uint8)], [label])])
            return self.between / "0"

    monkeypatch.setattr("vdsl.pipeline.dataset.ProcessPoolExecutor", LostPool)
    monkeypatch.setattr("vdsl.pipeline.dataset._SHARD", 1)
    with pytest.raises(OSError, match="start again to go on"):
        generate(tmp_path, 10, seed=3, device="cpu", size=48, processes=2)
    assert [label.about["story"] for label in Dataset(tmp_path).labels] == [0]
    assert not list(tmp_path.glob(".filmed-*"))


def test_what_a_process_leaves_is_taken_as_it_was(tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    clips = rng.integers(0, 255, (5, 8, 16, 16, 3), dtype=np.uint8)
    for scenes in (
        [_Filmed(clips[:2], [("a",)] * 3), _Filmed([], [("b",)]), _Filmed(clips[2:], [("c",)] * 3)],
        [_Filmed([], [("b",)])],
        [],
    ):
        _leave(tmp_path / "7", scenes)
        found = _taken(tmp_path / "7", 16)
        assert not list(tmp_path.iterdir())
        assert [scene.labels for scene in found] == [scene.labels for scene in scenes]
        for one, other in zip(found, scenes, strict=True):
            assert len(one.frames) == len(other.frames)
            for frames, were in zip(one.frames, other.frames, strict=True):
                np.testing.assert_array_equal(frames, were)
                assert not frames.flags.writeable


def test_what_goes_wrong_with_writing_ends_the_filming(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    ended: list[bool] = []

    def stories(*_: object) -> Iterator[list[_Filmed]]:
        try:
            while True:
                yield [_Filmed([np.zeros((8, 32, 32, 3), np.uint8)], [("no", "label")])]
        finally:
            ended.append(True)

    monkeypatch.setattr("vdsl.pipeline.dataset._stories", stories)
    try:
        generate(tmp_path, 4, device="cpu", size=32)
    except TypeError:
        assert ended == [True]
    else:
        pytest.fail("a label like that cannot be written")
