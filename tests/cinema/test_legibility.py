"""Whether one reads at a glance who is there: faces turned and large, all heads, air between them, hands."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from company import BODY, FILMING, FRAMES, takes_of, two
from filmset import shot, standing, world

from runtime.world import World
from vdsl.cinema.legibility import facing
from vdsl.cinema.measures import measure
from vdsl.cinema.score import WEIGHTS, geometry_score
from vdsl.cinema.subject import peopled, place
from vdsl.propose.subjects import performed, pillars_of, subject_of
from vdsl.propose.types import StoryProposal

EYE, AIM = (3.5, 0.0, 1.4), (0.0, 0.0, 1.3)


def measured(
    told: StoryProposal,
    eye: tuple[float, float, float] = EYE,
    aim: tuple[float, float, float] = AIM,
    ground: World = FILMING.world,
    scale: str = "medium",
) -> dict[str, float]:
    subject = subject_of(shot(scale=scale), told, FILMING)
    values = measure(takes_of(scale, "person", eye, aim), subject, ground, 24.0).values
    return {name: float(value[0]) for name, value in values.items()}


def test_a_face_is_read_that_is_turned_to_the_camera_seen_and_large() -> None:
    told = two((0.0, 0.9))
    front = measured(told)
    assert front["legible"] > 0.75
    assert measured(told, (-3.5, 0.0, 1.4))["legible"] < 0.05, "from behind"
    assert 0.3 < measured(told, (0.0, -3.5, 1.4))["legible"] < 0.7, "in profile"
    assert measured(told, (14.0, 0.0, 1.4))["legible"] < 0.3 * front["legible"], "far off"
    lamp = world(boxes=((1.0, 0.0, 1.5, 0.05, 0.3, 0.3, 0.0),))
    assert measured(told, ground=lamp)["legible"] < 0.1, "a thing before it"
    assert measured(two((1.0, 0.0)))["legible"] < 0.1, "somebody before it"


def test_what_is_large_goes_by_the_size() -> None:
    """Of a wide shot no head is as tall as of a close one."""
    told, eye, aim = two((0.0, 0.9)), (9.0, 0.0, 1.2), (0.0, 0.0, 0.9)
    wide, medium = (measured(told, eye, aim, scale=scale)["legible"] for scale in ("wide", "medium"))
    assert wide > 1.2 * medium


def test_of_a_face_that_fills_the_frame_no_crown_is_asked() -> None:
    told = two((0.0, 3.0))
    eye, aim = (0.9, 0.0, 1.58), (0.0, 0.0, 1.58)
    near = {scale: measured(told, eye, aim, scale=scale) for scale in ("extreme-close-up", "close-up")}
    assert near["extreme-close-up"]["legible"] > 0.95
    assert near["extreme-close-up"]["heads"] == 0.5, "hers, and not Ben's"


def test_all_heads_are_counted_and_are_to_be_apart() -> None:
    assert measured(two((0.0, 0.9)))["heads"] == 1.0
    assert measured(two((0.0, 4.0)))["heads"] == 0.5, "beside the picture"
    assert measured(two((-1.0, 0.0)))["heads"] == 0.5, "behind her"
    near, apart = (measured(two((0.0, y)))["together"] for y in (0.3, 0.9))
    assert apart == 0.0 < 0.3 < near < 1.0
    assert measured(two((-1.0, 0.02)))["together"] > 0.8, "one before the other"


def test_who_is_far_over_somebody_in_the_picture_is_apart() -> None:
    """From overhead, a metre and a half apart along the picture's height, and along its width."""
    eye, aim = (0.1, 0.0, 6.0), (0.0, 0.0, 1.0)
    assert measured(two((-1.5, 0.0)), eye, aim)["together"] == 0.0
    assert measured(two((0.0, 1.5)), eye, aim)["together"] == 0.0
    assert measured(two((0.1, 0.3)), eye, aim)["together"] > 0.3


def test_a_back_one_looks_over_hides_a_face() -> None:
    told, said = two((1.6, 0.0), np.pi), shot(scale="medium")
    subject = subject_of(replace(said, view="ots", whose=("ben",)), told, FILMING)
    assert subject.company == ()
    takes = takes_of("medium", "person", EYE, AIM)
    pillars = pillars_of(said, told, FILMING, {"anna"})
    alone, behind = (
        measure(replace(takes, others=tuple(others), view="ots"), subject, FILMING.world, 24.0).values
        for others in ((), pillars)
    )
    assert alone["legible"] > 0.7
    assert alone["heads"] == 1.0
    assert behind["legible"] < 0.1
    assert behind["heads"] == 0.0


def test_in_a_place_people_count_while_they_are_in_it() -> None:
    room = place("room", (-3.0, -3.0, 0.0), (3.0, 3.0, 2.6), FRAMES)
    there = two((0.0, 0.9))
    away = np.tile((0.0, 0.9, 0.0), (FRAMES, 1))
    away[FRAMES // 2 :, 1] = 9.0  # next door
    leaves = replace(there, performances=there.performances | {"ben": standing(BODY, away, np.zeros(FRAMES))})
    found = []
    for told in (there, leaves):
        people = [performed(name, acted, BODY) for name, acted in told.performances.items()]
        subject = replace(peopled(room, people), company=tuple(people))
        takes = takes_of("full", "place", (4.5, 0.4, 1.5), (0.0, 0.4, 1.2))
        found.append(measure(takes, subject, FILMING.world, 24.0).values)
    both, one = found
    assert both["heads"] == one["heads"] == 1.0
    assert abs(both["legible"] - one["legible"]) < 0.1


def test_hands_are_looked_for_in_the_middle() -> None:
    assert measured(two((0.0, 0.9)), aim=(0.0, 0.0, 0.9))["hands_shown"] == 1.0
    assert measured(two((0.0, 0.9)), (1.2, 0.0, 1.6), (0.0, 0.0, 1.6))["hands_shown"] == 0.0


def test_facing_is_monotonous_from_behind_to_three_quarters() -> None:
    turned = facing(np.array([-1.0, -0.75, -0.2, 0.3, 0.7, 1.0]))
    assert turned[0] == turned[1] == 0.0
    assert turned[4] == turned[5] == 1.0
    assert (np.diff(turned[1:5]) > 0).all()


def test_the_geometry_prefers_who_is_read() -> None:
    told = two((0.0, 0.9))
    assert abs(sum(WEIGHTS.values()) - 1.0) < 1e-9
    assert geometry_score(measured(told)) > geometry_score(measured(told, (-3.5, 0.0, 1.4))) + 0.2
    assert geometry_score(measured(two((0.0, 0.9)))) > geometry_score(measured(two((-0.6, 0.1)))) + 0.05
