"""What is seen of the set behind a subject, and of a subject that goes somewhere."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from filmset import shot, skeleton, standing, story, world

from runtime.world import Wall
from vdsl.cinema.flaws import flaws_by_measure
from vdsl.cinema.measures import measure
from vdsl.cinema.sight import backdrop_gaps
from vdsl.cinema.sizes import size_of
from vdsl.cinema.takes import SAMPLES, Takes
from vdsl.cinema.track import CameraTrack, look_at_rotation
from vdsl.propose.cameras import Filming, propose_cameras
from vdsl.propose.subjects import subject_of

ROOM = (
    Wall((0, 0), (4, 0), 2.6),
    Wall((4, 0), (4, 4), 2.6),
    Wall((4, 4), (0, 4), 2.6),
    Wall((0, 4), (0, 0), 2.6),
)
SOUTH = np.array([[True, False, False, False]])
HEART = np.array([[2.0, 2.0, 1.0]])


def gaps(
    camera: tuple[float, float], degrees: list[float], hidden: np.ndarray, walls: tuple[Wall, ...]
) -> float:
    """Of one camera that looks in these directions over the floor plan; 0 is along x, 90 along y."""
    angle = np.radians(degrees)
    rays = np.stack([np.cos(angle), np.sin(angle)], axis=-1)[None, None]
    eye = np.array([[[*camera, 1.0]]])
    return float(backdrop_gaps(world(walls=walls), hidden, eye, HEART, rays)[0])


def test_looks_past_the_room_are_gaps_of_the_backdrop() -> None:
    """From 3 m before a room of 4 m whose near wall is taken away."""
    assert gaps((2.0, -3.0), [75.0, 90.0, 105.0], SOUTH, ROOM) == 0.0
    assert gaps((2.0, -3.0), [30.0, 90.0, 90.0, 150.0], SOUTH, ROOM) == 0.5
    # aslant, beside the corner: what looks past the west wall finds nothing
    assert gaps((-2.0, -2.0), [45.0, 80.0], SOUTH | np.array([[False, False, False, True]]), ROOM) == 0.5
    assert gaps((2.0, 3.0), [270.0, 90.0], SOUTH, ROOM) == 0.5  # a wall that is missing behind the subject


def of_floor(eye: tuple[float, float, float], aim: tuple[float, float, float], **ground: Any) -> float:
    """Of somebody in the middle of a room of 6 m, without walls or with what is said."""
    body, frames = skeleton(1.7), 24
    told = story({"anna": standing(body, np.zeros((frames, 3)), np.zeros(frames))})
    room = replace(world(**({"outdoor": False} | ground)), floors=((-3.0, -3.0, 3.0, 3.0),))
    subject = subject_of(shot(scale="full"), told, Filming(room, {"anna": body}, 24.0, 3))
    at, to = (np.tile(p, (1, frames, 1)).astype(float) for p in (eye, aim))
    track = CameraTrack(at, look_at_rotation(at, to, 0.0), np.full((1, frames), 35.0), to, (36.0, 20.25))
    window, key = np.ones((1, SAMPLES), bool), np.zeros(1, np.int64)
    takes = Takes(track, (size_of("person", "full"),), window, key, 0.0, False, ())
    return float(measure(takes, subject, room, 24.0).values["floor_gap"][0])


def test_where_the_floor_of_a_room_ends_there_is_a_gap() -> None:
    within, over_the_edge = (2.5, 0.0, 1.5), (10.0, 0.0, 1.6)
    assert of_floor(within, (0.0, 0.0, 1.0)) == 0.0
    assert of_floor(over_the_edge, (0.0, 0.0, 1.0)) > 0.2
    assert of_floor(over_the_edge, (0.0, 0.0, 1.0), outdoor=True) == 0.0, "there is ground all around"
    before = ((9.0, 0.0, 1.2, 0.1, 9.0, 1.2, 0.0),)
    assert of_floor((10.0, 0.0, 1.6), (0.0, 0.0, 1.0), boxes=before) == 0.0, "something hides it"


def test_out_of_doors_the_sky_is_no_gap() -> None:
    house = (Wall((0, 0), (4, 0), 2.6),)
    taken = np.array([[True]])
    assert gaps((2.0, -3.0), [30.0, 90.0, 150.0], taken, house) == 0.0
    assert gaps((2.0, -3.0), [30.0, 90.0, 150.0], SOUTH & False, ROOM) == 0.0  # nothing is taken away
    low = tuple(Wall(w.low, w.high, 0.7) for w in ROOM)
    assert gaps((2.0, -3.0), [30.0, 150.0], SOUTH, low) == 0.0


@pytest.mark.parametrize("movement", ["pan-left", "pan-right"])
def test_the_best_pans_show_somebody_walk(movement: str) -> None:
    """Pans that come upon a walker when the walk is over are proposed, and come last."""
    body = skeleton(1.7)
    path = np.stack([np.linspace(0, 3, 72), np.zeros(72), np.zeros(72)], axis=1)
    told = story({"anna": standing(body, path, np.zeros(72))})
    asked = shot(movement, "medium", "eye-level", proposals=60)
    cameras = propose_cameras(asked, [told], Filming(world(), {"anna": body}, 24.0, 3)).cameras
    missed = np.array([c.measures["walk_missed"] for c in cameras])
    assert missed.min() < 0.5 < missed.max() <= 1.0
    best = max(cameras, key=lambda c: c.measures["geometry"])
    assert best.measures["walk_missed"] < 0.5
    late = cameras[int(missed.argmax())]
    assert bool(flaws_by_measure(late.measures)["walk_missed"])


def test_who_stays_walks_nowhere() -> None:
    body = skeleton(1.7)
    told = story({"anna": standing(body, np.zeros((48, 3)), np.zeros(48))})
    asked = shot("pan-left", "medium", "eye-level", proposals=20)
    cameras = propose_cameras(asked, [told], Filming(world(), {"anna": body}, 24.0, 3)).cameras
    assert {c.measures["walk_missed"] for c in cameras} == {0.0}
