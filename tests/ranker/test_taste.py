"""What a writer's choices teach, and how it is kept."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from ranker.errors import RankerError
from ranker.taste import Choice, Taste, learn, load_taste, save_taste

WEIGHTS, TRAITS = "0" * 64, ("height", "speed", "face", "pan")


def _choices(count: int, seed: int = 0, likes: int = 3) -> list[Choice]:
    """Somebody who likes what has much of one feature, and a ranker that knows nothing of it."""
    rng = np.random.default_rng(seed)
    out = []
    for _ in range(count):
        features = rng.gamma(2.0, size=(5, 32)).astype(np.float32)
        unit = features / np.linalg.norm(features, axis=1, keepdims=True)
        traits, margins = rng.normal(size=(5, 4)), rng.normal(0, 0.3, 5).astype(np.float32)
        out.append(Choice(features, traits, margins, int(unit[:, likes].argmax())))
    return out


def _of_traits(count: int, seed: int = 0, spread: float = 8.0) -> list[Choice]:
    """Somebody who likes little of the second trait, and a ranker whose log odds of takes lie far apart."""
    rng = np.random.default_rng(seed)
    out = []
    for _ in range(count):
        traits = rng.normal(size=(4, 4))
        features, margins = rng.gamma(2.0, size=(4, 32)).astype(np.float32), rng.normal(0, spread, 4)
        out.append(Choice(features, traits, margins, int(traits[:, 1].argmin())))
    return out


def _right(choices: list[Choice], taste: Taste) -> float:
    found = [int((c.margins + taste.adds(c.traits, c.features)).argmax()) == c.chosen for c in choices]
    return float(np.mean(found))


def test_a_taste_is_learnt_and_holds_for_other_shots() -> None:
    taste = learn(_choices(60), TRAITS, WEIGHTS)
    others = _choices(100, seed=1)
    alone = np.mean([int(c.margins.argmax()) == c.chosen for c in others])
    assert alone < 0.35
    assert _right(others, taste) > 0.5


def test_eight_choices_by_one_rule_hold_for_another_film() -> None:
    taste = learn(_of_traits(8), TRAITS, WEIGHTS)
    others = _of_traits(200, seed=1)
    alone = np.mean([int(c.margins.argmax()) == c.chosen for c in others])
    assert alone < 0.3
    assert _right(others, taste) > alone + 0.15
    assert np.abs(taste.likes).argmax() == 1
    assert taste.likes[1] < -1.0


def test_choices_as_the_ranker_has_them_teach_nothing() -> None:
    """What it is sure of already asks for no taste; the same takes against its order do."""
    agreeing, against = [], []
    for c in _of_traits(12):
        agreeing.append(Choice(c.features, c.traits, 4 * c.margins, int(c.margins.argmax())))
        against.append(Choice(c.features, c.traits, 4 * c.margins, int(c.margins.argmin())))
    likes = [float(np.linalg.norm(learn(some, TRAITS, WEIGHTS).likes)) for some in (agreeing, against)]
    assert likes[0] < 0.25 * likes[1]


def test_few_choices_change_little_and_never_much() -> None:
    one, many = learn(_choices(1), TRAITS, WEIGHTS), learn(_choices(60), TRAITS, WEIGHTS)
    some = _choices(40, seed=2)
    features, traits = np.concatenate([c.features for c in some]), np.concatenate([c.traits for c in some])
    assert 0 < np.abs(one.adds(traits, features)).mean() < np.abs(many.adds(traits, features)).mean()
    assert np.abs(many.adds(1e6 * traits, features)).max() <= 12.0


def test_nothing_but_traits_is_known_before_pictures() -> None:
    taste, some = learn(_of_traits(8), TRAITS, WEIGHTS), _of_traits(1, seed=7)[0]
    by_traits = taste.adds(some.traits)
    assert not np.allclose(by_traits, taste.adds(some.traits, some.features))
    assert int(by_traits.argmax()) == some.chosen


def test_a_taste_survives_the_disk_and_is_small(tmp_path: Path) -> None:
    taste, path = learn(_choices(10), TRAITS, WEIGHTS), tmp_path / "vds.taste"
    save_taste(path, taste)
    again = load_taste(path, TRAITS, WEIGHTS)
    some = _choices(3, seed=5)[0]
    assert np.array_equal(again.adds(some.traits, some.features), taste.adds(some.traits, some.features))
    assert (again.choices, again.traits) == (10, TRAITS)
    assert path.stat().st_size < 64 * 1024
    assert [p.name for p in tmp_path.iterdir()] == ["vds.taste"]


@pytest.mark.parametrize("how", ["cut", "text", "empty", "flipped", "other weights", "missing", "older"])
def test_another_file_is_told(tmp_path: Path, how: str) -> None:
    path = tmp_path / "vds.taste"
    save_taste(path, learn(_choices(4), TRAITS, WEIGHTS))
    content = path.read_bytes()
    spoilt = {
        "cut": content[:-9],
        "text": b"anna likes close-ups",
        "empty": b"",
        "flipped": b"\xff" * 40 + content[40:],
        "older": content.replace(b"vds.taste/2", b"vds.taste/1"),
    }
    if how in spoilt:
        path.write_bytes(spoilt[how])
    elif how == "missing":
        path.unlink()
    with pytest.raises(RankerError, match=r"vds\.taste"):
        load_taste(path, TRAITS, "1" * 64 if how == "other weights" else WEIGHTS)


def test_nothing_chosen_is_told() -> None:
    with pytest.raises(RankerError, match="vdsc pick"):
        learn([], TRAITS, WEIGHTS)
