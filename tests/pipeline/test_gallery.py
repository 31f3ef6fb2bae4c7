"""The gallery: its cases can be drawn, its index names every picture, its sets show whole people."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from vdsl.cinema.sight import distances
from vdsl.library import Catalog
from vdsl.pipeline.eyes import Eye
from vdsl.pipeline.gallery import LOOKS, TIMES, Gallery, index, nearer
from vdsl.pipeline.gallery_cases import CASES, Case
from vdsl.pipeline.preview import at_rest
from vdsl.pipeline.trial import stage_script

FOLDER = Path(__file__).parents[2] / "docs" / "gallery"


@pytest.fixture(scope="module")
def gallery() -> Gallery:
    return Gallery(Catalog(), "cpu", scale=0.16)


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_every_script_of_a_case_can_be_played(case: Case) -> None:
    for text in {shot.script for shot in case.shots}:
        assert stage_script(text, case.name, line=-1).line.shots


def test_the_index_names_every_picture_and_they_are_there(gallery: Gallery) -> None:
    page = (FOLDER / "README.md").read_text(encoding="utf-8")
    assert page == index(gallery.catalog)
    names = [name for name, _ in gallery.pictures()]
    assert len(names) == len(set(names)) == page.count(".jpg)")
    assert sorted(names) == sorted(path.stem for path in FOLDER.glob("*.jpg"))
    assert sum(path.stat().st_size for path in FOLDER.iterdir()) <= 4 * 1024 * 1024


def test_a_set_is_drawn_by_day_and_night_in_every_look(gallery: Gallery) -> None:
    picture = np.asarray(gallery.set("interview_room"), float)
    assert picture.shape[1] > len(LOOKS) * 64
    assert picture.shape[0] > len(TIMES) * 36
    looks = np.array_split(picture[:60], len(LOOKS), axis=1)
    assert np.ptp(looks[0], axis=-1).max() > 60  # colours
    assert np.ptp(looks[2], axis=-1).max() < 20  # paper and ink


def test_an_eye_comes_near_enough_to_a_person() -> None:
    world = stage_script('storyboard "s"\nscene s = desert at day\n\n/ (static wide)\n', "s").staged.world
    person = (14.0, 9.0, 0.0)
    far = Eye((2.0, 2.0, 1.6), (14.0, 9.0, 1.5), 20.0)
    near = nearer(far, person, world)
    assert 5.9 < math.dist(near.position[:2], person[:2]) < 0.6 * math.dist(far.position[:2], person[:2])
    assert distances(world.solids, np.array([near.position])).min() > 0.6, "not in a thing"
    assert near.position[2] == far.position[2]
    close = Eye((11.0, 9.0, 1.6), far.aim, 20.0)
    assert nearer(close, person, world) == close


def test_people_in_a_set_turn_a_face_to_the_eye(gallery: Gallery) -> None:
    for name in ("house", "hospital", "cafe"):
        act, eye = gallery._peopled(name, "day")
        for who, acted in at_rest(act).performances.items():
            across, along = np.array(eye.position[:2]) - acted.position[0, :2]
            aside = math.remainder(float(acted.heading[0]) - math.atan2(along, across), math.tau)
            assert abs(aside) < math.radians(75), (name, who)
