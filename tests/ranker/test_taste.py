"""What a writer's choices teach, and how it is kept."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from ranker.errors import RankerError
from ranker.taste import Choice, learn, load_taste, save_taste

WEIGHTS = "0" * 64


def _choices(count: int, seed: int = 0, likes: int = 3) -> list[Choice]:
    """Somebody who likes what has much of one feature, and a ranker that knows nothing of it."""
    rng = np.random.default_rng(seed)
    out = []
    for _ in range(count):
        features = rng.gamma(2.0, size=(5, 32)).astype(np.float32)
        unit = features / np.linalg.norm(features, axis=1, keepdims=True)
        out.append(Choice(features, rng.normal(0, 0.3, 5).astype(np.float32), int(unit[:, likes].argmax())))
    return out


def _right(choices: list[Choice], taste: object) -> float:
    return float(np.mean([int((c.margins + taste.adds(c.features)).argmax()) == c.chosen for c in choices]))  # type: ignore[attr-defined]


def test_a_taste_is_learnt_and_holds_for_other_shots() -> None:
    taste = learn(_choices(60), WEIGHTS)
    others = _choices(100, seed=1)
    alone = np.mean([int(c.margins.argmax()) == c.chosen for c in others])
    assert alone < 0.35
    assert _right(others, taste) > 0.6


def test_few_choices_change_little_and_never_much() -> None:
    one, many = learn(_choices(1), WEIGHTS), learn(_choices(60), WEIGHTS)
    some = np.concatenate([c.features for c in _choices(40, seed=2)])
    assert 0 < np.abs(one.adds(some)).mean() < np.abs(many.adds(some)).mean()
    assert np.abs(many.adds(1e6 * some)).max() <= 6.0


def test_a_taste_survives_the_disk_and_is_small(tmp_path: Path) -> None:
    taste, path = learn(_choices(10), WEIGHTS), tmp_path / "vds.taste"
    save_taste(path, taste)
    again = load_taste(path, WEIGHTS)
    some = _choices(3, seed=5)[0].features
    assert np.array_equal(again.adds(some), taste.adds(some))
    assert again.choices == 10
    assert path.stat().st_size < 64 * 1024
    assert [p.name for p in tmp_path.iterdir()] == ["vds.taste"]


@pytest.mark.parametrize("how", ["cut", "text", "empty", "flipped", "other weights", "missing"])
def test_another_file_is_told(tmp_path: Path, how: str) -> None:
    path = tmp_path / "vds.taste"
    save_taste(path, learn(_choices(4), WEIGHTS))
    content = path.read_bytes()
    spoilt = {
        "cut": content[:-9],
        "text": b"anna likes close-ups",
        "empty": b"",
        "flipped": b"\xff" * 40 + content[40:],
    }
    if how in spoilt:
        path.write_bytes(spoilt[how])
    elif how == "missing":
        path.unlink()
    with pytest.raises(RankerError, match=r"vds\.taste"):
        load_taste(path, "1" * 64 if how == "other weights" else WEIGHTS)


def test_nothing_chosen_is_told() -> None:
    with pytest.raises(RankerError, match="vdsc pick"):
        learn([], WEIGHTS)
