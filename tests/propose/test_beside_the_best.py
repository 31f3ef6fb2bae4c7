"""Where hardly any take has no fault, more are looked for beside the best; who is not seen at all is not
offered."""

from __future__ import annotations

from dataclasses import fields

import numpy as np
import pytest
from filmset import shot, skeleton, still_story, world

from vdsl.cinema.flaws import flaws
from vdsl.cinema.measures import LAST
from vdsl.cinema.space import stage_of
from vdsl.propose import cameras as proposing
from vdsl.propose.cameras import Filming, propose_cameras, try_cameras
from vdsl.propose.drawing import draw, generator, near, nudged
from vdsl.propose.rejection import SOFT
from vdsl.propose.subjects import subject_of
from vdsl.propose.types import ProposalGrid

BODY = skeleton()


def fenced() -> Filming:
    """Posts along the eight azimuths that hide the middle of who stands between them: the body is clear only
    from half-way between two azimuths, farther off than usual cameras stand."""
    boxes = tuple(
        (0.75 * np.cos(a), 0.75 * np.sin(a), 1.05, 0.03, 0.29, 0.3, a) for a in np.arange(8) * np.pi / 4
    )
    return Filming(world(boxes=boxes), {"anna": BODY}, 24.0, 0)


def faultless(grid: ProposalGrid) -> int:
    wrong = [sum(bool(v) for v in flaws(c.measures).values()) for c in grid.cameras]
    return wrong.count(0)


def test_takes_without_a_fault_are_found_beside_the_best(monkeypatch: pytest.MonkeyPatch) -> None:
    asked, story = shot("static", "medium", proposals=40), [still_story(BODY)]
    found = propose_cameras(asked, story, fenced())
    monkeypatch.setattr(proposing, "_SEARCHES", 0)
    usual = propose_cameras(asked, story, fenced())
    assert len(found.cameras) == len(usual.cameras) == 40
    assert faultless(usual) < 5 < faultless(found)
    assert found.considered > usual.considered


def test_where_enough_takes_have_no_fault_nothing_more_is_considered(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    asked, story = shot("static", "medium", proposals=40), [still_story(BODY)]
    open_air = Filming(world(), {"anna": BODY}, 24.0, 0)
    found = propose_cameras(asked, story, open_air)
    monkeypatch.setattr(proposing, "_SEARCHES", 0)
    assert found.considered == propose_cameras(asked, story, open_air).considered


def test_what_is_near_keeps_words_and_distance_and_stays_in_its_ranges() -> None:
    rng = generator(0, "s1", "test")
    usual = draw(shot("push", "medium", proposals=20), 3, 300, rng)
    other = near(usual, rng)
    for name in ("story", "movement", "scale", "angle", "azimuth", "key", "on", "before", "reach"):
        assert (getattr(other, name) == getattr(usual, name)).all(), name
    for name in ("lens", "mu", "turn", "travel", "lead"):
        moved = getattr(other, name)
        assert 0.0 <= moved.min() <= moved.max() <= 1.0
        assert 0.05 < np.abs(moved - getattr(usual, name)).mean() < 0.2, name
    assert np.abs(other.jitter - 0.5).max() <= 1.25  # half way to the next azimuth
    assert set(other.lam) <= set(usual.lam)
    some = other.only(np.array([5, 5, 2]))
    assert all(len(getattr(some, f.name)) == 3 for f in fields(some))


def test_who_is_not_seen_at_all_is_not_let_back_in() -> None:
    """A box without a door around somebody: no take of the four walls is offered instead."""
    sides = ((0.8, 0.0, 0.05, 0.85), (-0.8, 0.0, 0.05, 0.85), (0.0, 0.8, 0.85, 0.05), (0.0, -0.8, 0.85, 0.05))
    boxes = tuple((x, y, 1.2, half_x, half_y, 1.2, 0.0) for x, y, half_x, half_y in sides)
    filming = Filming(world(boxes=boxes), {"anna": BODY}, 24.0, 0)
    grid = propose_cameras(shot("static", "full"), [still_story(BODY)], filming)
    assert grid.rejected["subject_hidden"] > 100
    assert grid.cameras == ()


def test_what_was_drawn_from_all_around_is_not_nudged_farther() -> None:
    """Half way to the next azimuth is as far as there is a way to go."""
    rng = np.random.default_rng(2)
    asked = shot("push", "wide", proposals=20)
    usual, around = draw(asked, 1, 200, rng), draw(asked, 1, 200, rng, all_around=True)
    widest = np.abs(around.jitter - 0.5).max()
    assert np.abs(usual.jitter - 0.5).max() <= 0.5 < widest
    assert np.abs(nudged(around, rng, True).jitter - 0.5).max() == widest
    assert 0.5 < np.abs(nudged(usual, rng, True).jitter - 0.5).max() <= 22.5 / 18.0


def test_what_may_be_let_back_in_is_measured_in_full_only_where_too_few_are_good() -> None:
    asked, story, place = shot("static", "medium"), still_story(BODY), fenced()
    subject = subject_of(asked, story, place)
    stage = stage_of(place.world, subject.position[[0, -1]])
    sample = draw(asked, 1, 400, generator(0, "s1", "test"))
    enough, too_few = (
        try_cameras(asked, story, subject, stage, place, sample, np.arange(400), lacking)
        for lacking in (0, 1000)
    )
    np.testing.assert_array_equal(enough.reason, too_few.reason)
    assert enough.measured is not None
    assert too_few.measured is not None
    reason = enough.reason[enough.kept]
    soft, good = np.isin(reason, SOFT), reason < 0
    assert soft.any()
    assert good.any()
    for name in LAST:
        some, all_ = enough.measured.values[name], too_few.measured.values[name]
        np.testing.assert_array_equal(some[good], all_[good])
        assert np.isnan(some[soft]).all()
        assert not np.isnan(all_[soft]).any()
