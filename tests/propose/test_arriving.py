"""Who has to get somewhere first is seen to arrive, where the camera would wait for them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from vdsl.pipeline.trial import stage_script
from vdsl.propose.arriving import arrival
from vdsl.propose.story import Told, tell

PLACE = """storyboard "t"
character anna = woman
character ben = man
scene kitchen = apartment.kitchen
anna at door facing counter
ben at chair_2 sitting

"""
FPS = 24.0


def way(metres: float, walk: float, rest: float) -> np.ndarray:
    """Somebody who waits for a quarter of a second, walks and stands: [T, 3]."""
    there = np.concatenate(
        [np.zeros(6), np.linspace(0, metres, round(walk * FPS)), np.full(round(rest * FPS), metres)]
    )
    return np.stack([there, 0 * there, 0 * there], axis=1)


def test_the_last_of_a_way_is_shown_and_all_after_it() -> None:
    path = way(4.0, 3.0, 2.0)
    first = arrival(path, FPS)
    assert len(path) - first == pytest.approx((2.0 + 0.6) * FPS, abs=2)
    assert 0.5 < path[-1, 0] - path[first, 0] < 1.2


@pytest.mark.parametrize(
    ("metres", "walk", "rest"), [(1.2, 1.0, 2.0), (4.0, 3.0, 0.5), (0.0, 3.0, 2.0), (6.0, 4.0, 0.0)]
)
def test_steps_walks_that_are_the_action_and_those_who_stay_are_shown_whole(
    metres: float, walk: float, rest: float
) -> None:
    assert arrival(way(metres, walk, rest), FPS) == 0


def told(line: str, rig: str = "cinema") -> Told:
    act = stage_script(PLACE + line + "\n", "t")
    return tell(act.state, act.line, replace(act.filming, rig=rig), shot=act.line.shots[0])


def test_a_camera_that_waits_cuts_to_the_arrival() -> None:
    whole, cut = told("(anna pick up cup) / (static full)"), told("(anna pick up cup) / (static medium)")
    for long, short in zip(whole.proposals, cut.proposals, strict=True):
        assert short.frames < long.frames - 12
        acted, all_of_it = short.performances["anna"], long.performances["anna"]
        assert len(acted.position) == len(acted.world_from_joint) == len(acted.heading) == short.frames
        assert all(len(moved) == short.frames for moved in short.props.values())
        assert all(len(point) == short.frames for point in short.interest)
        assert np.array_equal(acted.position, all_of_it.position[-short.frames :])
        assert np.linalg.norm(acted.position[-1] - acted.position[0]) < 1.5
    assert np.array_equal(cut.end.actors["anna"].position, whole.end.actors["anna"].position)


@pytest.mark.parametrize(
    "line",
    [
        "(anna pick up cup) / (follow medium)",
        "(anna pick up cup) / (pan medium)",
        "(anna pick up cup) / (static medium|wide)",
        "(anna pick up cup) + (ben wave) / (static medium)",
        "(anna walk counter) / (static medium)",
    ],
)
def test_where_the_way_is_seen_or_others_act_all_is_shown(line: str) -> None:
    shown, whole = told(line).proposals, told(line.split("/")[0] + "/ (static full)").proposals
    assert [story.frames for story in shown] == [story.frames for story in whole]


def test_the_papers_rig_shows_all_of_a_path() -> None:
    whole, shown = (told(f"(anna pick up cup) / (static {size})", "paper") for size in ("full", "medium"))
    assert [story.frames for story in shown.proposals] == [story.frames for story in whole.proposals]


def test_a_line_that_says_how_long_it_lasts_does() -> None:
    assert {story.frames for story in told("(anna pick up cup) / (static medium) 7s").proposals} == {168}
