"""Measures in words: that they add up, and that what is said of two takes is so."""

from __future__ import annotations

import pytest

from vdsl.cinema.flaws import CRITERIA
from vdsl.cinema.measures import MEASURES
from vdsl.cinema.score import PENALTIES, WEIGHTS, geometry_score
from vdsl.cinema.telling import (
    _COMPARED,
    NOTES,
    advantages,
    compared,
    faults,
    is_good,
    number,
    penalties,
    terms,
)

BEST = dict.fromkeys(MEASURES, 0.0) | {
    "visibility": 1.0, "ends_visible": 1.0, "head_visible": 1.0, "in_frame": 1.0, "headroom": 0.1,
    "lead_room": 0.2, "interest": 1.0, "view": 1.0, "face": 0.9, "clearance": 1.0,
    "legible": 0.9, "heads": 1.0, "hands_shown": 1.0,
}  # fmt: skip


def test_every_measure_has_a_note_and_no_other() -> None:
    assert set(NOTES) == {*MEASURES, "picture_visibility"}
    assert all(is_good(name, value) for name, value in BEST.items())


def test_points_and_penalties_make_the_score() -> None:
    take = BEST | {"foreground": 0.3, "backdrop_gap": 0.1, "jerk": 9.0, "thirds_error": 0.2}
    total = sum(t.points for t in terms(take))
    for factor in penalties(take).values():
        total *= factor
    assert total == pytest.approx(geometry_score(take))
    assert sum(t.weight for t in terms(take)) == pytest.approx(sum(WEIGHTS.values())) == pytest.approx(1.0)


def test_differences_of_two_takes_add_up_nearly_to_that_of_their_scores() -> None:
    other = BEST | {"legible": 0.7, "foreground": 0.1, "angular_speed": 40.0}
    gains = advantages(BEST, other)
    assert sum(gains.values()) == pytest.approx(geometry_score(BEST) - geometry_score(other), rel=0.05)
    assert set(list(gains)[:3]) == {"legible", "foreground", "steadiness"}
    judged = advantages(BEST, other, {"logit": -2.5, "taste": 3.0}, 10.0)
    assert (judged["logit"], judged["taste"]) == (-2.5, 3.0)
    told = compared("taste", BEST | {"taste": 4.0}, other | {"taste": 1.0}, True, "take 2")
    assert told == "more to your taste than take 2 (4.00 against 1.00)"
    assert judged["foreground"] == pytest.approx(10.0 * gains["foreground"])


def test_a_fault_that_only_one_of_two_takes_has_counts_by_itself() -> None:
    other = BEST | {"lead_room": -0.35, "foreground": 0.1, "size_error": 0.3, "thirds_error": 0.05}
    plain, strict = (advantages(BEST, other, {"logit": 0.0}, 10.0, flaw) for flaw in (0.0, 3.0))
    more = {name: strict[name] - plain.get(name, 0.0) for name in strict}
    assert {name for name, gain in more.items() if gain} == {"lead_room", "visibility", "framing"}
    assert [more[name] for name in ("lead_room", "visibility", "framing")] == pytest.approx(
        [3.5, 10 / 3, 5.0]
    )
    back = advantages(other, BEST, {"logit": 0.0}, 10.0, 3.0)
    assert back["framing"] == pytest.approx(-5.0)
    assert compared("framing", BEST, other, True, "take 2") == "better framed than take 2"
    assert advantages(other, other | {"clearance": 0.9}, {"logit": 0.0}, 10.0, 3.0)["framing"] == 0.0


def test_what_is_said_of_two_takes_quotes_both() -> None:
    other = BEST | {"lead_room": -0.09, "legible": 0.4, "speed": 2.0}
    assert (
        compared("lead_room", BEST, other, True, "take 2")
        == "more lead room than take 2 (0.20 against −0.09)"
    )
    assert compared("steadiness", other, BEST, False) == "less steady (2.0 m/s against 0.0 m/s)"
    assert compared("legible", BEST, other, True) == "the face is read better (90 % against 40 %)"
    assert compared("heads", BEST, other, True) == "more heads are seen"  # nothing to quote: both alike


def test_every_part_of_the_score_and_every_criterion_can_be_told_of_two_takes() -> None:
    assert set(_COMPARED) == {*WEIGHTS, *PENALTIES, *CRITERIA, "logit", "taste"}


def test_faults_are_told_but_not_those_that_are_meant() -> None:
    assert faults(BEST, "static") == ()
    cut = BEST | {"feet_cut": 0.2, "visibility": 0.61}
    assert faults(cut, "follow") == ("hides part of the subject (61 % seen)", "cuts the feet")
    assert faults(cut, "push") == ("hides part of the subject (61 % seen)",)


def test_numbers_carry_their_units() -> None:
    assert number("visibility", 0.314) == "31 %"
    assert number("angular_speed", 12.3) == "12.3°/s"
    assert number("lead_room", -0.2) == "−0.20"
    assert number("clearance", 0.5) == "0.5 m"
