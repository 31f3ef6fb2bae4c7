"""Tilts and pans keep whom they film in the picture, for the most part, and go where there is somebody."""

from __future__ import annotations

import numpy as np
import pytest
from filmset import shot, skeleton, standing, still_story, story, world
from numpy.typing import NDArray

from vdsl.cinema.measures import ENDS_EMPTY
from vdsl.cinema.subject import Subject, person
from vdsl.cinema.track import camera_axes, project
from vdsl.propose.cameras import Filming, propose_cameras
from vdsl.propose.types import CameraProposal, StoryProposal

BODY = skeleton()


def filmed(
    acted: StoryProposal, movement: str, scale: str = "medium", rig: str = "cinema"
) -> tuple[CameraProposal, ...]:
    filming = Filming(world(), {"anna": BODY}, 24.0, 5, rig)
    wanted = shot(movement, scale, proposals=120)
    return propose_cameras(wanted, [acted], filming).cameras


def subject_of(acted: StoryProposal) -> Subject:
    p = acted.performances["anna"]
    return person("anna", BODY, p.world_from_joint, p.position, p.heading)


def in_frame(camera: CameraProposal, points: NDArray[np.float64]) -> NDArray[np.bool_]:
    """At which frames [T] the picture has a point [T, 3]."""
    track = camera.track
    axes = camera_axes(track.rotation)
    xy, depth = project(points[:, None], track.position, axes, track.focal, track.sensor)
    inside = (xy > 0.0) & (xy < 1.0)
    return np.asarray((depth > 0) & inside.all(axis=-1))[:, 0]


@pytest.mark.parametrize("movement", ["pan-left", "pan-right"])
@pytest.mark.parametrize("scale", ["close-up", "medium", "full"])
def test_most_pans_pass_over_one_who_stays(movement: str, scale: str) -> None:
    acted = still_story(BODY)
    eyes, cameras = subject_of(acted).landmarks["eyes"], filmed(acted, movement, scale)
    shown = [bool(in_frame(c, eyes).all()) for c in cameras]
    assert len(cameras) >= 100
    assert 0.7 < np.mean(shown) < 1.0  # the rest as in the paper: to find somebody, or leave them
    turned = [abs(float(c.params["turn"])) for c, keeps in zip(cameras, shown, strict=True) if not keeps]
    assert np.degrees(min(turned)) > 29.9


def test_the_papers_pans_turn_as_far_as_the_paper_says() -> None:
    for c in filmed(still_story(BODY), "pan-left", rig="paper"):
        assert 29.9 < np.degrees(float(c.params["turn"])) < 60.1


def test_a_pan_goes_along_with_one_who_walks_its_way() -> None:
    t = np.linspace(0, 1, 72)
    path = np.stack([3.0 * t, np.zeros(72), np.zeros(72)], axis=1)
    acted = story({"anna": standing(BODY, path, np.zeros(72))})
    eyes = subject_of(acted).landmarks["eyes"]
    along = []
    for movement, sign in (("pan-left", 1.0), ("pan-right", -1.0)):
        for c in filmed(acted, movement, "full"):
            to = path[:, :2] - c.track.position[:, :2]
            bearing = np.unwrap(np.arctan2(to[:, 1], to[:, 0]))
            if 14.0 < sign * np.degrees(bearing[-1] - bearing[0]) < 65.0 and c.params["lambda"] == 1.0:
                along.append(float(in_frame(c, eyes).mean()))
    assert len(along) > 20
    assert np.mean(np.array(along) > 0.9) > 0.6


@pytest.mark.parametrize("scale", ["close-up", "medium"])
@pytest.mark.parametrize(("movement", "face"), [("tilt-up", -1), ("tilt-down", 0)])
def test_most_tilts_go_up_to_the_face_from_the_body_and_down_from_it(
    movement: str, face: int, scale: str
) -> None:
    acted = still_story(BODY)
    marks, cameras = subject_of(acted).landmarks, filmed(acted, movement, scale)
    shown = []
    for c in cameras:
        body = in_frame(c, marks["waist"]) | in_frame(c, marks["knees"]) | in_frame(c, marks["pocket"])
        shown.append(bool(in_frame(c, marks["eyes"])[face] and body[-1 - face]))
    assert len(cameras) >= 100
    assert np.mean(shown) > 0.6


def test_a_picture_with_a_body_in_it_is_not_empty() -> None:
    acted = still_story(BODY)
    marks = subject_of(acted).landmarks
    for c in filmed(acted, "tilt-up"):
        anything = [in_frame(c, marks[name]) for name in ("eyes", "chin", "pocket", "waist", "knees")]
        if np.any(anything, axis=0).all():
            assert c.measures["empty"] == 0.0


def test_an_end_on_nobody_counts_more_than_a_beginning() -> None:
    acted = still_story(BODY)
    marks = subject_of(acted).landmarks
    begins: list[float] = []  # how much more is counted than the time
    ends: list[float] = []
    for c in filmed(acted, "pan-left"):
        there = np.any([in_frame(c, marks[name]) for name in ("eyes", "waist", "hand_l", "hand_r")], axis=0)
        if there.any() and there[0] != there[-1]:
            time = 1.0 - float(there.mean())
            if time < 1.0 - ENDS_EMPTY:
                (ends if there[0] else begins).append(c.measures["empty"] - time)
    assert len(begins) >= 3
    assert len(ends) >= 3
    assert np.mean(begins) == pytest.approx(0.0, abs=0.08)
    assert np.mean(ends) == pytest.approx(ENDS_EMPTY, abs=0.08)
