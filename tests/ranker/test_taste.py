"""What a writer's choices teach, and how it is kept."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ranker.errors import RankerError
from ranker.taste import Choice, Taste, learn, load_taste, save_taste

TRAITS = ("height", "speed", "face", "pan")


def _choices(count: int, seed: int = 0, spread: float = 8.0) -> list[Choice]:
    """Somebody who likes little of the second trait, and a ranker whose log odds of takes lie far apart."""
    rng = np.random.default_rng(seed)
    out = []
    for _ in range(count):
        traits, margins = rng.normal(size=(4, 4)), rng.normal(0, spread, 4)
        out.append(Choice(traits, margins, int(traits[:, 1].argmin())))
    return out


def _right(choices: list[Choice], taste: Taste) -> float:
    return float(np.mean([int((c.margins + taste.adds(c.traits)).argmax()) == c.chosen for c in choices]))


def test_eight_choices_by_one_rule_hold_for_another_film() -> None:
    taste = learn(_choices(8), TRAITS)
    others = _choices(200, seed=1)
    alone = np.mean([int(c.margins.argmax()) == c.chosen for c in others])
    assert alone < 0.3
    assert _right(others, taste) > alone + 0.15
    assert np.abs(taste.likes).argmax() == 1
    assert taste.likes[1] < -1.0
    assert _right(others, learn(_choices(60), TRAITS)) > _right(others, taste)


def test_choices_as_the_ranker_has_them_teach_nothing() -> None:
    """What it is sure of already asks for no taste; the same takes against its order do."""
    agreeing, against = [], []
    for c in _choices(12):
        agreeing.append(Choice(c.traits, 4 * c.margins, int(c.margins.argmax())))
        against.append(Choice(c.traits, 4 * c.margins, int(c.margins.argmin())))
    likes = [float(np.linalg.norm(learn(some, TRAITS).likes)) for some in (agreeing, against)]
    assert likes[0] < 0.25 * likes[1]


def test_more_choices_change_more_and_none_more_than_the_most() -> None:
    one, many = learn(_choices(1), TRAITS), learn(_choices(60), TRAITS)
    traits = np.concatenate([c.traits for c in _choices(40, seed=2)])
    assert 0 < np.abs(one.adds(traits)).mean() < np.abs(many.adds(traits)).mean()
    assert np.abs(many.adds(1e6 * traits)).max() <= 12.0


def test_takes_without_scores_are_learnt_from_too() -> None:
    """As of a build by geometry alone."""
    some = [replace(c, margins=np.zeros(4)) for c in _choices(8)]
    assert learn(some, TRAITS).likes[1] < -1.0


def test_a_taste_survives_the_disk_as_text(tmp_path: Path) -> None:
    taste, path = learn(_choices(10), TRAITS), tmp_path / "vds.taste"
    save_taste(path, taste)
    again = load_taste(path, TRAITS)
    traits = _choices(3, seed=5)[0].traits
    assert np.array_equal(again.adds(traits), taste.adds(traits))
    assert (again.choices, again.traits) == (10, TRAITS)
    assert json.loads(path.read_text("utf-8"))["likes"]["speed"] == taste.likes[1]
    assert [p.name for p in tmp_path.iterdir()] == ["vds.taste"]


def test_traits_that_a_file_does_not_name_are_not_liked(tmp_path: Path) -> None:
    path = tmp_path / "vds.taste"
    path.write_text('{"schema": "vds.taste/1", "choices": 2, "likes": {"face": 2}, "usual": {}}', "utf-8")
    assert load_taste(path, TRAITS).likes.tolist() == [0.0, 0.0, 2.0, 0.0]


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"anna likes close-ups",
        b"\xff" * 40,
        b"[]",
        b"[" * 100_000,
        b'{"schema": "vds.taste/0", "choices": 2, "likes": {}, "usual": {}}',
        b'{"schema": "vds.taste/1", "choices": 2, "likes": {"beauty": 1.0}, "usual": {}}',
        b'{"schema": "vds.taste/1", "choices": 2, "likes": {"face": NaN}, "usual": {}}',
        b'{"schema": "vds.taste/1", "choices": 2, "likes": {"face": "much"}, "usual": {}}',
        b'{"schema": "vds.taste/1", "choices": 2, "likes": 3, "usual": {}}',
        b'{"schema": "vds.taste/1", "choices": 2, "likes": {"face": 1e308}, "usual": {}}',
        b'{"schema": "vds.taste/1", "choices": 2, "likes": {"face": 1' + b"0" * 400 + b'}, "usual": {}}',
        b'{"schema": "vds.taste/1", "choices": 1e999, "likes": {}, "usual": {}}',
        b" " * 2_000_000,
        None,
    ],
)
def test_another_file_is_told(tmp_path: Path, content: bytes | None) -> None:
    path = tmp_path / "vds.taste"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(RankerError, match=r"vds\.taste"):
        load_taste(path, TRAITS)


def test_nothing_chosen_is_told() -> None:
    with pytest.raises(RankerError, match="vdsc pick"):
        learn([], TRAITS)
