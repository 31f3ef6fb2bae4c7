"""Who else is in the picture: nobody loses their head beside the subject, and a room shows who is in it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from company import BODY, FILMING, FRAMES, takes_of, two
from filmset import shot, standing, world
from numpy.typing import NDArray

from runtime.world import World
from vdsl.cinema.flaws import flaws
from vdsl.cinema.measures import LAST, measure
from vdsl.cinema.score import geometry_score
from vdsl.cinema.subject import peopled, place
from vdsl.cinema.track import CameraTrack
from vdsl.propose.cameras import propose_cameras
from vdsl.propose.subjects import performed, subject_of
from vdsl.propose.types import STILL, StoryProposal


def measured(
    told: StoryProposal,
    eye: tuple[float, float, float],
    aim: tuple[float, float, float],
    ground: World = FILMING.world,
) -> float:
    """How long somebody else has no head in a medium close-up of Anna."""
    subject = subject_of(shot(scale="medium-close-up"), told, FILMING)
    assert [one.name for one in subject.company] == ["ben"]
    takes = takes_of("medium-close-up", "person", eye, aim)
    return float(measure(takes, subject, ground, 24.0).values["company_cut"][0])


def test_somebody_whose_body_is_in_the_picture_is_to_have_a_head_in_it() -> None:
    low = ((1.8, 0.0, 1.0), (0.0, 0.0, 0.7))  # camera and aim: to the waist, and no head of anybody
    assert measured(two((0.0, 0.6)), *low) == 1.0
    assert measured(two((0.0, 3.0)), *low) == 0.0, "beside the picture"
    assert measured(two((0.0, 0.9)), (3.5, 0.0, 1.4), (0.0, 0.0, 1.3)) < 1e-9, "whole"
    assert 0.2 < measured(two((-2.2, 0.3)), *low) < 0.99, "who is farther off counts less"
    assert measured(two((-5.0, 0.3)), *low) == 0.0


def test_a_side_of_somebody_counts_and_a_side_of_a_head_is_a_head() -> None:
    """The frame is 1.85 m wide where both stand, and their middles are just beside it."""
    beside, low, eyes = (
        two((0.0, 1.0)),
        ((1.8, 0.0, 1.0), (0.0, 0.0, 0.7)),
        ((1.8, 0.0, 1.4), (0.0, 0.0, 1.4)),
    )
    assert measured(beside, *low) > 0.99
    assert measured(two((0.0, 1.3)), *low) == 0.0
    assert 0.4 < measured(two((0.0, 0.97)), *eyes) <= 0.5, "half a person, head and all: ugly, and no fault"


def test_a_head_from_behind_is_to_be_there_with_its_crown() -> None:
    """Cut above the eyes, a face is still one, and the back of a head hardly told from a collar."""
    above = ((1.8, 0.0, 1.2), (0.0, 0.0, 1.08))
    assert measured(two((0.0, 0.5)), *above) < 0.2
    assert measured(two((0.0, 0.5), np.pi), *above) == 1.0


def test_a_head_behind_somebody_or_something_is_none() -> None:
    """Ben stands behind Anna, so that an arm or a side of his looks out beside her."""
    eye = ((2.5, 0.0, 1.4), (0.0, 0.0, 1.3))
    assert measured(two((-0.8, 0.12)), *eye) > 0.6, "his head is behind hers, his shoulder is not"
    assert measured(two((-0.8, 0.0)), *eye) <= 0.5, "nothing of him is seen"
    assert measured(two((-0.8, 0.8)), *eye) < 0.1, "apart"
    lamp = world(boxes=((0.6, 0.62, 1.6, 0.05, 0.25, 0.3, 0.0),))  # before his head, and not his body
    assert measured(two((0.0, 0.8)), (3.5, 0.0, 1.4), (0.0, 0.0, 1.3), lamp) > 0.9


def test_who_is_behind_the_camera_or_beside_one_from_above_hides_nobody() -> None:
    eye, aim = (2.5, 0.0, 1.4), (0.0, 0.0, 1.3)
    three = two((0.0, 0.9))
    behind = standing(BODY, np.tile((4.0, 0.3, 0.0), (FRAMES, 1)), np.zeros(FRAMES))
    told = replace(three, performances=three.performances | {"carla": behind})
    filming = replace(FILMING, skeletons=FILMING.skeletons | {"carla": BODY})
    subject = subject_of(shot(scale="medium-close-up"), told, filming)
    assert len(subject.company) == 2
    takes = takes_of("medium-close-up", "person", eye, aim)
    assert measure(takes, subject, FILMING.world, 24.0).values["company_cut"] < 0.1
    taller = measured(two((-1.0, 0.0)), (0.1, 0.0, 6.0), (0.0, 0.0, 1.0))
    assert taller < 0.1, "from overhead he lies below her in the picture, a metre away"


def test_a_head_that_looks_out_over_somebody_is_without_air() -> None:
    """Ben stands on something behind Anna."""
    told = two((-1.0, 0.0))
    ben = told.performances["ben"]
    up = np.array((0.0, 0.0, 0.45))
    matrices = ben.world_from_joint.copy()
    matrices[..., :3, 3] += up
    raised = replace(ben, world_from_joint=matrices, position=ben.position + up)
    over = replace(told, performances=told.performances | {"ben": raised})
    assert 0.2 < measured(over, (3.5, 0.0, 1.4), (0.0, 0.0, 1.4)) <= 0.5


def test_somebody_a_thing_halves_is_ugly_and_no_fault() -> None:
    post = world(boxes=((1.0, 0.65, 1.0, 0.05, 0.12, 1.0, 0.0),))  # before one side of Ben
    whole = measured(two((0.0, 1.1)), (3.5, 0.0, 1.4), (0.0, 0.0, 1.3))
    split = measured(two((0.0, 1.1)), (3.5, 0.0, 1.4), (0.0, 0.0, 1.3), post)
    assert whole < 0.1
    assert 0.4 < split <= 0.5


def test_people_are_best_shown_with_air_between_them() -> None:
    eye = ((5.0, 0.0, 1.4), (0.0, 0.0, 1.1))
    apart, near, lapped = (measured(two((0.0, y)), *eye) for y in (1.2, 0.6, 0.3))
    assert apart == 0.0
    assert 0.0 < near < lapped <= 0.5


def test_feet_of_people_in_a_place_are_best_in_the_picture() -> None:
    whole, cut = (in_a_place(two((0.0, 1.6)), (x, 0.8, 1.5)) for x in (5.5, 2.6))
    assert whole["company_cut"] < 1e-9
    assert 0.25 < cut["company_cut"] <= 0.3
    beside = two((0.0, 0.9))
    wide = takes_of("full", "person", (3.0, 0.0, 1.5), (0.0, 0.0, 1.3))
    full = measure(wide, subject_of(shot(scale="full"), beside, FILMING), FILMING.world, 24.0).values
    assert full["company_cut"] > 0.25, "a size that shows the whole"


def test_those_a_view_is_of_are_no_company() -> None:
    told, said = two((0.0, 0.6)), shot(scale="medium")
    both = subject_of(replace(said, view="two-shot", whose=("anna", "ben")), told, FILMING)
    over = subject_of(replace(said, view="ots", whose=("ben",)), told, FILMING)
    assert both.company == over.company == ()


def test_a_room_holds_who_stands_in_it_and_not_who_is_upstairs() -> None:
    room = place("hall", (-1.0, -1.0, 0.0), (1.0, 1.0, 2.6), FRAMES)
    told = two((0.0, 3.0))
    anna, ben = subject_of(replace(shot(), focus=None), replace(told, variant=STILL), FILMING).company
    assert room.holds(anna).all()
    assert not room.holds(ben).any()
    assert not room.holds(anna.shifted(3.0)).any()


def in_a_place(told: StoryProposal, eye: tuple[float, float, float]) -> dict[str, float]:
    area = place("hall", (-4.0, -4.0, 0.0), (4.0, 4.0, 3.0), FRAMES)
    people = subject_of(replace(shot(), focus=None), replace(told, variant=STILL), FILMING).company
    assert [one.name for one in people] == ["anna", "ben"]
    takes = takes_of("wide", "place", eye, (0.0, 0.0, 1.2))
    found = measure(takes, replace(area, company=people), FILMING.world, 24.0).values
    return {k: float(v[0]) for k, v in found.items()}


def test_a_picture_of_a_place_shows_who_is_in_it() -> None:
    told = two((0.0, 1.2))
    ahead, behind, aside = (
        in_a_place(told, eye) for eye in ((5.0, 0.6, 1.5), (-5.0, 0.6, 1.5), (0.0, -5.0, 1.5))
    )
    assert ahead["interest"] == 1.0
    assert ahead["face"] > 0.2
    assert behind["interest"] == 1.0
    assert behind["face"] < -0.8
    assert aside["interest"] == 0.5, "one hides the other"
    near = in_a_place(told, (1.0, 0.6, 1.0))
    assert near["interest"] < 1.0
    assert near["company_cut"] > 0.5


def behind_a_table(high: float) -> dict[str, float]:
    """Two people seen over something long that is so high."""
    boxes = ((2.0, 0.6, high / 2, 0.3, 4.0, high / 2, 0.0),)
    area = place("hall", (-4.0, -4.0, 0.0), (4.0, 4.0, 3.0), FRAMES)
    told, ground = replace(two((0.0, 1.2)), variant=STILL), world(boxes=boxes)
    people = subject_of(replace(shot(), focus=None), told, replace(FILMING, world=ground)).company
    takes = takes_of("wide", "place", (5.0, 0.6, 1.5), (0.0, 0.0, 1.2))
    found = measure(takes, replace(area, company=people), ground, 24.0).values
    return {k: float(v[0]) for k, v in found.items()}


def test_in_a_place_heads_and_chests_are_to_be_seen_and_legs_need_not() -> None:
    table, wall = behind_a_table(0.9), behind_a_table(2.4)
    seen = ("visibility", "head_visible", "ends_visible")
    assert [table[name] for name in seen] == [1.0, 1.0, 1.0]
    assert [wall[name] for name in seen] == [0.0, 0.0, 0.0]


def test_a_place_is_to_show_everybody_in_it() -> None:
    both, far = in_a_place(two((0.0, 1.2)), (5.0, 0.6, 1.5)), in_a_place(two((3.9, 3.9)), (5.0, 0.6, 1.5))
    assert both["interest"] == both["visibility"] == 1.0
    assert far["interest"] == 0.5, "Ben is beside the picture"
    assert abs(far["visibility"] - 2 / 3) < 1e-9
    assert far["head_visible"] == far["ends_visible"] == 1.0, "of who is seen best"
    assert not flaws(both)["visibility"].any()
    assert flaws(far)["visibility"].all()


def test_people_of_a_place_stand_side_by_side_in_its_picture() -> None:
    """One behind the other, head past head, is one clump; the farther one counts as shown in part."""
    eye = (5.0, 0.0, 1.5)
    beside, clump = (in_a_place(two((-1.5, y)), eye) for y in (1.0, 0.25))
    assert beside["interest"] == 1.0
    assert 0.7 < clump["interest"] < 0.92
    assert clump["visibility"] < beside["visibility"] == 1.0


def test_a_large_place_is_shown_where_its_people_are() -> None:
    corner = two((14.0, 3.0))
    anna, ben = (performed(name, acted, BODY) for name, acted in corner.performances.items())
    street = place("street", (-30.0, -8.0, 0.0), (30.0, 8.0, 3.0), FRAMES)
    room = place("room", (-3.0, -2.0, 0.0), (3.0, 2.0, 2.6), FRAMES)
    middle = peopled(street, (anna, ben)).landmarks["eyes"]
    np.testing.assert_allclose(middle[:, :2], np.tile((7.0, 1.5), (FRAMES, 1)), atol=0.2)
    np.testing.assert_allclose(middle[:, 2], street.landmarks["eyes"][:, 2])
    assert peopled(street, (anna, ben)).height > street.height, "they stand far apart"
    assert peopled(street, (anna,)).height == street.height
    assert peopled(street, ()) is street
    still = peopled(room, (anna,))
    np.testing.assert_allclose(still.landmarks["eyes"], room.landmarks["eyes"])
    assert still.bounds == room.bounds


def test_a_post_in_the_middle_of_a_place_is_in_the_way() -> None:
    """It stands where looks at the sides of a person do not go."""
    post = ((2.8, 0.6, 1.5, 0.15, 0.25, 1.5, 0.0),)
    area, told = place("hall", (-4.0, -4.0, 0.0), (4.0, 4.0, 3.0), FRAMES), two((0.0, 1.2))
    takes = takes_of("wide", "place", (5.0, 0.6, 1.5), (0.0, 0.6, 1.2))
    free, barred = (measure(takes, area, world(boxes=b), 24.0).values["foreground"] for b in ((), post))
    assert free == 0.0
    assert barred > 0.05
    of_her = subject_of(shot(scale="wide"), told, FILMING)
    assert measure(takes, of_her, world(boxes=post), 24.0).values["foreground"] == 0.0


def test_what_is_in_the_way_on_the_last_of_the_way_counts_for_less() -> None:
    told = subject_of(shot(scale="wide"), two((0.0, 3.9)), FILMING)
    takes = takes_of("wide", "person", (8.0, 0.0, 1.2), (0.0, 0.0, 1.2))
    near, later, beside = (
        measure(takes, told, world(boxes=((x, y, 1.5, 0.3, 0.7, 1.5, 0.0),)), 24.0).values["foreground"]
        for x, y in ((5.0, 1.2), (2.9, 1.8), (0.5, 3.0))
    )
    assert near > later > beside == 0.0


def test_of_a_room_with_people_faces_are_proposed_first() -> None:
    """Both look along x: the takes with the best geometry see them from before or aside, not from behind."""
    said = replace(shot("static", "full"), focus=None, proposals=60)
    told = replace(two((0.5, 1.0)), variant=STILL)
    cameras = propose_cameras(said, [told], FILMING).cameras
    assert len(cameras) > 10
    ranked: NDArray[np.int64] = np.argsort([-c.measures["geometry"] for c in cameras])
    faces = np.array([cameras[int(i)].measures["face"] for i in ranked])
    assert faces[:5].min() > -0.3
    assert faces.min() < -0.6, "there are others to choose from"


def dollying(told: StoryProposal, ground: World, ends: float) -> dict[str, float]:
    """A camera that goes aside from y = 0.6 before two people in a place."""
    area = place("hall", (-4.0, -4.0, 0.0), (4.0, 4.0, 3.0), FRAMES)
    people = subject_of(replace(shot(), focus=None), told, replace(FILMING, world=ground)).company
    takes = takes_of("wide", "place", (5.0, 0.6, 1.5), (0.0, 0.0, 1.2))
    away = np.array([0.0, 1.0, 0.0]) * np.linspace(0.0, ends - 0.6, FRAMES)[:, None]
    track = replace(takes.track, position=takes.track.position + away, look_at=takes.track.look_at + away)
    found = measure(replace(takes, track=track), replace(area, company=people), ground, 24.0).values
    return {k: float(v[0]) for k, v in found.items()}


def test_nothing_near_is_before_the_last_picture() -> None:
    """A post that the camera comes to at the very end is in one of eight frames, the one that stays."""
    told = replace(two((0.0, 1.2)), variant=STILL)
    ended = dollying(told, world(boxes=((2.8, 2.35, 1.5, 0.12, 0.3, 1.5, 0.0),)), 1.6)
    free = dollying(told, world(), 1.6)
    assert free["foreground"] == 0.0
    assert not flaws(free)["visibility"].any()
    assert flaws(ended)["visibility"].all()


def test_who_is_hidden_for_a_while_is_missed() -> None:
    """Ben walks past behind Anna: side by side in most of the pictures, and in two of them gone."""
    told = two((-1.5, 0.0))
    way = np.stack([np.full(FRAMES, -1.5), np.linspace(-1.2, 1.2, FRAMES), np.zeros(FRAMES)], 1)
    ben = standing(BODY, way, np.zeros(FRAMES))
    past = replace(told, performances={**told.performances, "ben": ben})
    eye = (5.0, 0.0, 1.5)
    beside, crossing = in_a_place(two((-1.5, 1.2)), eye), in_a_place(past, eye)
    assert not flaws(beside)["visibility"].any()
    assert crossing["interest"] < 0.88
    assert crossing["visibility"] < 0.97 < beside["visibility"], "less, and no fault as long as that is all"
    assert geometry_score(crossing) < geometry_score(beside)


def test_takes_that_are_not_wanted_are_measured_only_in_part() -> None:
    """Of those that are, all measures are what they would be beside any others."""
    told, eyes = two((0.0, 1.0)), ((3.0, 0.3, 1.5), (2.0, -2.0, 1.2), (-2.5, 0.4, 1.6), (4.0, 1.5, 2.0))
    subject = subject_of(shot(scale="medium"), told, FILMING)
    alone = [takes_of("medium", "person", eye, (0.0, 0.0, 1.3)) for eye in eyes]
    parts = [
        [getattr(one.track, name) for one in alone] for name in ("position", "rotation", "focal", "look_at")
    ]
    track = CameraTrack(*(np.concatenate(part) for part in parts), alone[0].track.sensor)
    takes = replace(
        alone[0],
        track=track,
        sizes=alone[0].sizes * 4,
        window=np.concatenate([one.window for one in alone]),
        key=np.zeros(4, np.int64),
    )
    wanted = np.array([True, False, True, False])
    ground = world(boxes=((1.0, 0.2, 0.5, 0.2, 0.2, 0.5, 0.4),))
    whole = measure(takes, subject, ground, 24.0).values
    part = measure(takes, subject, ground, 24.0, lambda first: wanted & (first.values["visibility"] >= 0.0))
    none = measure(takes, subject, ground, 24.0, lambda first: np.zeros(4, bool)).values
    assert whole.keys() == part.values.keys() == none.keys()
    for name, value in whole.items():
        np.testing.assert_array_equal(part.values[name][wanted], value[wanted], err_msg=name)
        assert np.isnan(part.values[name][~wanted]).all() or (part.values[name] == value).all(), name
    assert {name for name, value in part.values.items() if np.isnan(value).any()} == set(LAST)
    assert {name for name, value in none.items() if np.isnan(value).all()} == set(LAST)
