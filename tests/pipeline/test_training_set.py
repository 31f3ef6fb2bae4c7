"""Random stories, spoilt takes and the training set made of them."""

from __future__ import annotations

import json
import random
from pathlib import Path

import numpy as np
import pytest

from ranker.data import Dataset
from vdsl.cinema.track import CameraTrack, look_at_rotation
from vdsl.lang import Report, Source
from vdsl.library import Catalog
from vdsl.pipeline.dataset import generate
from vdsl.pipeline.perturb import perturbed
from vdsl.pipeline.script import check_source
from vdsl.pipeline.stories import places, random_story


def _track(frames: int = 40) -> CameraTrack:
    t = np.linspace(0, 1, frames)[:, None]
    position = np.array([0.0, -3.0, 1.5]) + t * np.array([0.5, 0.0, 0.0])
    look_at = np.tile([0.0, 0.0, 1.3], (frames, 1))
    rotation = look_at_rotation(position, look_at)
    return CameraTrack(position, rotation, np.full(frames, 50.0), look_at, (36, 20.25))


def test_strength_grades_how_far_a_negative_is_off():
    track = _track()

    def off(strength: float, seed: int) -> float:
        spoilt = perturbed(track, strength, np.random.default_rng(seed))
        moved = np.linalg.norm(spoilt.position - track.position, axis=1).max()
        turned = np.abs(spoilt.rotation - track.rotation).max()
        return float(moved + turned + np.abs(np.log(spoilt.focal / track.focal)).max())

    assert off(0.0, 3) == pytest.approx(0.0, abs=1e-12)
    weak, strong = (np.mean([off(s, k) for k in range(40)]) for s in (0.2, 0.9))
    assert strong > 2.5 * weak > 0
    assert off(0.7, 5) == off(0.7, 5)


def test_negatives_stay_above_the_floor_and_keep_their_length():
    for seed in range(30):
        spoilt = perturbed(_track(), 1.0, np.random.default_rng(seed))
        assert spoilt.position[:, 2].min() >= 0.08
        assert spoilt.position.shape == (40, 3)
        assert (spoilt.focal > 0).all()


def test_random_stories_pass_the_same_check_as_a_writers():
    catalog = Catalog(Report())
    cast = tuple(sorted(catalog.names("cast")))
    grounds = places(catalog)
    assert {p.set for p in grounds} >= {"apartment", "office", "suburb_street"}
    seen = set()
    for number in range(60):
        place = grounds[number % len(grounds)]
        text = random_story(catalog, place, random.Random(number), 5, cast)
        storyboard = check_source(Source("<story>", text)).storyboard
        assert len(storyboard.lines) == 5
        seen |= {beat.action for line in storyboard.lines for beat in line.beats}
    assert len(seen) >= 15, seen


def test_a_training_set_is_half_good_and_goes_on_where_it_stopped(tmp_path: Path):
    first = generate(tmp_path, 16, seed=4, device="cpu")
    marker = json.loads((tmp_path / "stories.json").read_text())
    assert generate(tmp_path, 16, seed=4, device="cpu") == first
    assert json.loads((tmp_path / "stories.json").read_text()) == marker
    more = generate(tmp_path, first + 1, seed=4, device="cpu")
    data = Dataset(tmp_path)
    assert len(data.labels) == more > first
    good = [label for label in data.labels if label.professional]
    assert len(good) * 2 == more
    assert all(label.strength == 0 and label.movement for label in good)
    assert all(label.strength > 0 for label in data.labels if not label.professional)
    frames = data.clip(0, range(8), 224)
    assert frames.shape == (8, 224, 224, 3)
    assert frames.std() > 10
