"""The rules of cutting on made-up scenes: what was built in is found, with the right degrees."""

from __future__ import annotations

from dataclasses import replace

import filmset as f
import numpy as np
import pytest

from vdsl.cinema.continuity import NEUTRAL, Finding, findings
from vdsl.cinema.edges import Edge, edges, ladder, steps
from vdsl.cinema.subject import Subject, person
from vdsl.cinema.track import CameraTrack, look_at_rotation

BODY = f.skeleton(1.7)
FPS, T = 24.0, 24


def stand(name: str, x: float, y: float, heading: float, walks: float = 0.0) -> Subject:
    """Somebody who stands, or walks so many metres a second where they look."""
    way = walks / FPS * np.arange(T)
    path = np.stack([x + way * np.cos(heading), y + way * np.sin(heading), np.zeros(T)], axis=1)
    body = f.standing(BODY, path, np.full(T, heading))
    return person(name, BODY, body.world_from_joint, body.position, body.heading)


def couple(distance: float = 2.0, axis: float = 0.0) -> dict[str, Subject]:
    """Anna and ben face to face; ``axis`` is the direction from her to him."""
    x, y = distance * np.cos(axis), distance * np.sin(axis)
    return {"anna": stand("anna", 0, 0, axis), "ben": stand("ben", x, y, axis + np.pi)}


def camera_at(point: np.ndarray, around: float, distance: float, focal: float = 50.0) -> CameraTrack:
    """A still camera that many radians around a point (of its first frame), aimed at it."""
    position = point + distance * np.array((np.cos(around), np.sin(around), 0.0))
    position, target = np.tile(position, (T, 1)), np.tile(point, (T, 1))
    return CameraTrack(position, look_at_rotation(position, target), np.full(T, focal), target, (36.0, 20.25))


def take(
    people: dict[str, Subject], of: str, around: float, distance: float = 3.0, focal: float = 50.0,
    acting: tuple[tuple[str, str], ...] = (("anna", "ben"),), frame: int = 0,
) -> tuple[Edge, Edge]:  # fmt: skip
    point = people[of].landmarks["eyes"][frame]
    return edges(camera_at(point, around, distance, focal), people[of], people, acting, FPS)


def cut(before: tuple[Edge, Edge], after: tuple[Edge, Edge]) -> dict[str, Finding]:
    return {finding.rule: finding for finding in findings(before[1], after[0])}


@pytest.mark.parametrize("seed", range(40))
def test_crossed_lines_are_found_with_their_degrees(seed: int) -> None:
    """The camera on one of the two, then on the other from the wrong side; the line is where they look."""
    rng = np.random.default_rng(seed)
    axis = rng.uniform(-np.pi, np.pi)
    people = couple(rng.uniform(1.0, 6.0), axis)
    one, two = rng.uniform(15, 165, 2)
    side = rng.choice((-1, 1))
    before = take(people, "anna", axis + np.radians(side * one), rng.uniform(1, 5))
    crossing = take(people, "ben", axis - np.radians(side * two), rng.uniform(1, 5))
    staying = take(people, "ben", axis + np.radians(side * two), rng.uniform(1, 5))
    found = cut(before, crossing)
    assert found["line"].degrees == pytest.approx(min(two, 180 - two), abs=1e-4)
    assert found["line"].numbers["before"] == pytest.approx(min(one, 180 - one), abs=1e-4)
    assert f"crosses the line by {min(two, 180 - two):.0f}°" in found["line"].words
    assert set(found) == {"line"}, "one mistake is told once"
    assert not cut(before, staying)


@pytest.mark.parametrize("seed", range(20))
def test_a_mirrored_world_has_the_same_faults(seed: int) -> None:
    rng = np.random.default_rng(100 + seed)
    axis, around = rng.uniform(-np.pi, np.pi, 2), rng.uniform(-np.pi, np.pi, 2)
    at, distance, walks = rng.uniform(-2, 2, 4), rng.uniform(1, 6, 2), rng.choice((0.0, 1.0), 2)

    def faults(mirror: float) -> list[tuple[str, float]]:
        people = {
            name: stand(name, at[2 * k], mirror * at[2 * k + 1], mirror * axis[k], walks[k])
            for k, name in enumerate(("anna", "ben"))
        }
        acting = (("anna", "ben"),) if seed % 2 else ()
        first = take(people, "anna", mirror * around[0], distance[0], acting=acting, frame=T - 1)
        then = take(people, ("anna", "ben")[seed % 3 == 0], mirror * around[1], distance[1], acting=acting)
        return [(x.rule, round(x.degrees, 6)) for x in findings(first[1], then[0])]

    assert faults(1.0) == faults(-1.0)


def test_near_the_line_no_side_is_taken() -> None:
    people = couple()
    on_it = take(people, "anna", np.radians(NEUTRAL - 1))
    for degrees in (60, -60, 120, -120):
        over = take(people, "ben", np.radians(degrees))
        assert "line" not in cut(on_it, over)
        assert "line" not in cut(over, on_it)


def test_from_above_there_is_no_side() -> None:
    people = couple()
    point = people["anna"].landmarks["eyes"][0]
    above = np.tile(point + np.array((0.3, -0.3, 4.0)), (T, 1))
    aim = np.tile(point, (T, 1))
    track = CameraTrack(above, look_at_rotation(above, aim), np.full(T, 50.0), aim, (36.0, 20.25))
    top = edges(track, people["anna"], people, (("anna", "ben"),), FPS)
    assert "line" not in cut(take(people, "ben", np.radians(70)), top)


def test_people_who_have_nothing_to_do_with_each_other_have_no_line() -> None:
    """Neither acts on the other, they look away from each other, and never both are in the picture."""
    people = {"anna": stand("anna", 0, 0, np.pi), "ben": stand("ben", 8, 0, 0.0)}
    before = take(people, "anna", np.radians(120), acting=())
    after = take(people, "ben", np.radians(-60), acting=())
    assert "line" not in cut(before, after)
    assert "line" in cut(take(people, "anna", np.radians(120)), take(people, "ben", np.radians(-60)))


def test_the_way_somebody_goes_is_a_line() -> None:
    before, after = ({"anna": stand("anna", x, 0, 0.0, walks=1.2)} for x in (0.0, 1.2))
    first = take(before, "anna", np.radians(80), 4.0, acting=(), frame=T - 1)
    flipped = cut(first, take(after, "anna", np.radians(-50), 8.0, 35.0, acting=()))
    assert flipped["line"].degrees == pytest.approx(50, abs=0.5)
    assert flipped["line"].words.endswith("(anna's way)")
    assert "line" not in cut(first, take(after, "anna", np.radians(50), 8.0, 35.0, acting=()))
    back = {"anna": stand("anna", 1.2, 0, np.pi, walks=1.2)}
    assert "line" not in cut(first, take(back, "anna", np.radians(-50), 8.0, 35.0, acting=())), (
        "who turns round goes the other way"
    )


def test_a_turned_way_is_told_where_the_line_of_two_people_holds() -> None:
    """Ben watches from the side; anna's way lies across the line between them."""
    people = {"anna": stand("anna", 0, 0, np.pi / 2, walks=1.2), "ben": stand("ben", 3.0, 0.6, np.pi)}
    first = take(people, "anna", np.radians(60), 4.0, frame=T - 1)
    again = {"anna": stand("anna", 0, 1.2, np.pi / 2, walks=1.2), "ben": people["ben"]}
    found = cut(first, take(again, "anna", np.radians(130), 9.0))
    assert set(found) == {"direction"}
    assert "anna's way round" in found["direction"].words


def test_looks_that_do_not_meet() -> None:
    """The line is kept only just: one of the cameras stands on it, so the eyes decide."""
    people = couple()
    turned = {"anna": people["anna"], "ben": stand("ben", 2.0, 0.0, np.pi + np.radians(30))}
    before = take(turned, "anna", np.radians(-120))
    # on the line as the bodies stand, but ben's face is turned 30 degrees off it
    found = cut(before, take(turned, "ben", np.radians(180 + 4)))
    assert set(found) == {"eyeline"}
    assert found["eyeline"].degrees == pytest.approx(26, abs=0.1)
    assert "anna and ben both look" in found["eyeline"].words


@pytest.mark.parametrize(("turn", "distance", "jumps"), [
    (10, 3.0, True), (29, 3.0, True), (31, 3.0, False), (10, 1.5, False), (0, 3.2, True),
])  # fmt: skip
def test_thirty_degrees_or_another_size(turn: float, distance: float, jumps: bool) -> None:
    people = {"anna": stand("anna", 0, 0, 0.0)}
    before = take(people, "anna", 0.5, 3.0, acting=())
    after = take(people, "anna", 0.5 + np.radians(turn), distance, acting=())
    found = cut(before, after)
    assert ("jump" in found) == jumps
    if jumps:
        assert found["jump"].degrees == pytest.approx(turn, abs=2.0)
        assert found["jump"].severity == "fault"


def test_a_leap_in_size_is_a_hint() -> None:
    people = {"anna": stand("anna", 0, 0, 0.0)}
    found = cut(take(people, "anna", 0.5, 12.0, acting=()), take(people, "anna", 0.5, 0.9, acting=()))
    assert set(found) == {"size"}
    assert found["size"].severity == "hint"
    assert "closer to anna" in found["size"].words


def test_what_is_not_in_the_picture_does_not_jump() -> None:
    people = {"anna": stand("anna", 0, 0, 0.0)}
    seen = take(people, "anna", 0.5, acting=())
    away = tuple(replace(edge, seen=False) for edge in seen)
    assert "jump" in cut(seen, seen)
    assert not cut(seen, (away[0], away[1]))


def test_the_ladder_has_the_ten_sizes_in_order() -> None:
    rungs = ladder()
    assert len(rungs) == 10
    assert [round(steps(view), 6) for view in rungs] == list(range(10))
    assert steps(rungs[-1] * 2) == pytest.approx(11.0)
    assert steps(0.0) < 0 < steps(0.2)
