"""The virtual designer: faults are out, weak criteria count, and nothing is picked twice."""

from __future__ import annotations

import numpy as np
import pytest

from vdsl.cinema.flaws import CRITERIA, LEAST, MOST, flaws, gravity
from vdsl.cinema.measures import MEASURES
from vdsl.cinema.score import FLAW
from vdsl.cinema.track import CameraTrack, look_at_rotation
from vdsl.pipeline.designer import COUNTS, appeal, judged, picks
from vdsl.pipeline.judging import prior
from vdsl.propose.types import CameraProposal

GOOD = dict.fromkeys(MEASURES, 0.0) | {
    "visibility": 1.0, "ends_visible": 1.0, "head_visible": 1.0, "in_frame": 1.0, "view": 1.0, "face": 0.6,
    "interest": 1.0, "clearance": 1.0, "headroom": 0.1, "lead_room": 0.1, "height": 1.5,
    "legible": 0.9, "heads": 1.0, "hands_shown": 1.0,
}  # fmt: skip


def camera(index: int, azimuth: float = 0.0, **measures: float) -> CameraProposal:
    position = np.tile(3.0 * np.array([np.cos(azimuth), np.sin(azimuth), 0.5]), (20, 1))
    look_at = np.tile([0.0, 0.0, 1.4], (20, 1))
    track = CameraTrack(
        position, look_at_rotation(position, look_at), np.full(20, 50.0), look_at, (36.0, 20.25)
    )
    hidden = np.zeros(0, bool)
    return CameraProposal(
        index, 0, "static", "medium", "eye-level", {}, track, hidden, measures=GOOD | measures
    )


def test_every_criterion_has_faults_and_counts() -> None:
    assert {c for c, *_ in (*LEAST, *MOST)} == set(CRITERIA)
    assert sum(COUNTS.values()) == pytest.approx(1.0)
    assert not any(flaws(GOOD).values())
    for criterion, name, limit, _ in LEAST:
        assert flaws(GOOD | {name: limit - 0.01})[criterion], name
    for criterion, name, limit, _ in MOST:
        assert flaws(GOOD | {name: limit * 1.05})[criterion], name


WORSE = {
    "legible": 0.7, "heads": 0.5, "together": 0.4, "hands_shown": 0.5, "visibility": 0.9, "face_covered": 0.2,
    "foreground": 0.04, "backdrop_gap": 0.08, "company_cut": 0.4, "floor_gap": 0.3, "empty": 0.2,
    "in_frame": 0.96, "headroom_error": 0.1, "lead_room": -0.2, "thirds_error": 0.15, "clearance": 0.35,
    "jerk": 6.0, "size_error": 0.06,
}  # fmt: skip


@pytest.mark.parametrize("name", WORSE)
def test_what_is_worse_in_one_thing_appeals_less(name: str) -> None:
    assert appeal(GOOD | {name: WORSE[name]}) < appeal(GOOD) - 0.0005


def test_a_weak_criterion_is_not_made_up_for() -> None:
    even = appeal(GOOD | {"headroom_error": 0.05, "thirds_error": 0.07})
    uneven = appeal(GOOD | {"headroom_error": 0.3})
    assert uneven < even


def test_faulty_takes_are_never_picked_and_no_two_look_alike() -> None:
    cameras = (
        camera(0, 0.0, thirds_error=0.1),
        camera(1, 0.01),
        camera(2, 1.0, headroom_error=0.05),
        camera(3, 2.0, visibility=0.5),
        camera(4, 3.0, jerk=50.0),
    )
    assert picks(cameras, 4) == [1, 2]
    assert picks(cameras, 1) == [1]
    assert picks((), 3) == []
    opinion = judged(cameras)
    assert (opinion[[3, 4]] < 0).all()
    assert (opinion[[0, 1, 2]] > 0).all()


def test_a_fault_counts_in_what_the_geometry_adds_once_a_criterion() -> None:
    best = prior(GOOD)  # size_error and view are in no part of the geometry score
    assert prior(GOOD | {"size_error": 0.1001}) == pytest.approx(best - FLAW, abs=0.1)
    assert prior(GOOD | {"size_error": 0.4}) == pytest.approx(best - 2 * FLAW)
    assert prior(GOOD | {"size_error": 0.25, "view": 0.79}) == pytest.approx(best - 1.5 * FLAW)
    assert prior(GOOD | {"size_error": 0.25, "ends_visible": 0.4}) == pytest.approx(best - 3 * FLAW)


def test_of_faults_the_graver_one_counts_more_and_none_more_than_two() -> None:
    for criterion, name, bound, worst in (*LEAST, *MOST):
        shares = (0.01, 0.5, 1.0, 1.5)
        found = [
            float(gravity(GOOD | {name: bound + share * (worst - bound)})[criterion]) for share in shares
        ]
        assert found == pytest.approx([1.01, 1.5, 2.0, 2.0]), name
    assert not any(gravity(GOOD).values())
    less, more = judged((camera(0, empty=0.3), camera(1, empty=0.7)))
    assert more < less < 0
