"""``rig cinema``: solved landmarks, level horizons, lenses in range, smooth tracks; over random bodies."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from filmset import shot, skeleton, standing, still_story, story, walking_story, world

from vdsl.cinema import rig_cinema
from vdsl.cinema.angles import CINEMA_THETA
from vdsl.cinema.classify import achieved_angles, achieved_size
from vdsl.cinema.framing import direction, risen, solve, stretch
from vdsl.cinema.moves import FLOOR_CLEARANCE
from vdsl.cinema.reading import read_movement
from vdsl.cinema.sizes import SIZES
from vdsl.cinema.subject import Subject, person
from vdsl.cinema.track import camera_axes, project
from vdsl.lang.ir import ANGLES, MOVEMENTS
from vdsl.propose.cameras import Filming, propose_cameras
from vdsl.propose.types import CameraProposal, StoryProposal


def subject_of(acted: StoryProposal, height: float) -> Subject:
    p = acted.performances["anna"]
    return person("anna", skeleton(height), p.world_from_joint, p.position, p.heading)


def filmed(acted: StoryProposal, height: float, **said: object) -> tuple[CameraProposal, ...]:
    filming = Filming(world(), {"anna": skeleton(height)}, 24.0, 3)
    return propose_cameras(shot(**said), [acted], filming).cameras  # type: ignore[arg-type]


@pytest.mark.parametrize("scale", SIZES)
@pytest.mark.parametrize("angle", ANGLES)
def test_landmarks_sit_on_the_frame_s_lines(scale: str, angle: str) -> None:
    rng = np.random.default_rng(len(scale) + len(angle))
    for _ in range(4):
        height, lean = float(rng.uniform(1.1, 1.95)), float(rng.uniform(0.0, 0.5))
        path = np.tile((*rng.uniform(-3, 3, 2), 0.0), (12, 1))
        body = skeleton(height)
        acted = story({"anna": standing(body, path, np.full(12, rng.uniform(-3, 3)), lean)})
        marks, size = subject_of(acted, height).landmarks, SIZES[scale]
        cameras = filmed(acted, height, movement="static", scale=scale, angle=angle)
        assert len(cameras) == 40
        for c in cameras:
            axes = camera_axes(c.track.rotation[0])
            points = np.stack([marks[size.upper][0], marks[size.lower][0]])
            xy, _ = project(points, c.track.position[0], axes, c.track.focal[0], c.track.sensor)
            assert xy[0, 1] == pytest.approx(size.top, abs=0.01)
            assert xy[1, 1] == pytest.approx(size.bottom, abs=0.01)
            assert 0.3 < xy[0, 0] < 0.7
            # straight up in the world is straight up in the picture
            assert abs(axes[0, 2]) < 1e-9


@pytest.mark.parametrize("movement", MOVEMENTS)
def test_tracks_are_smooth_level_and_within_the_lens(movement: str) -> None:
    cameras = filmed(walking_story(skeleton()), 1.7, movement=movement, scale="medium", lens=(35.0, 70.0))
    assert cameras
    for c in cameras:
        assert c.track.focal.min() >= 30.0 - 1e-9
        assert c.track.focal.max() <= 80.0 + 1e-9
        assert 35.0 - 1e-9 <= c.track.focal[0] <= 70.0 + 1e-9
        assert np.abs(c.track.rotation[:, 0]).max() == 0.0
        assert c.track.position[:, 2].min() >= FLOOR_CLEARANCE - 1e-9
        step = np.linalg.norm(np.diff(c.track.position, axis=0), axis=1)
        change = np.linalg.norm(np.diff(c.track.position, n=2, axis=0), axis=1)
        assert step.max() < 0.25
        assert change.max() < 0.04
        assert np.abs(np.diff(c.track.rotation[:, 2])).max() < 0.15


@pytest.mark.parametrize("movement", MOVEMENTS)
def test_a_take_moves_as_it_is_called(movement: str) -> None:
    acted = still_story(skeleton())
    subject = subject_of(acted, 1.7)
    for c in filmed(acted, 1.7, movement=movement):
        assert movement in read_movement(c.track, subject)


@pytest.mark.parametrize(
    ("movement", "sign"),
    [("pan-left", 1), ("pan-right", -1), ("tilt-up", 1), ("tilt-down", -1)],
)
def test_turns_go_the_named_way(movement: str, sign: int) -> None:
    k = 2 if movement.startswith("pan") else 1
    for c in filmed(still_story(skeleton()), 1.7, movement=movement):
        turned = sign * np.degrees(c.track.rotation[-1, k] - c.track.rotation[0, k])
        assert 12.0 - 1e-6 <= turned <= 60.0 + 1e-6


@pytest.mark.parametrize(
    ("movement", "sign"), [("dolly-left", -1), ("dolly-right", 1), ("arc-left", -1), ("arc-right", 1)]
)
def test_sideways_moves_go_the_named_way(movement: str, sign: int) -> None:
    for c in filmed(still_story(skeleton()), 1.7, movement=movement):
        right = camera_axes(c.track.rotation[0])[0]
        assert sign * float((c.track.position[1:] - c.track.position[:1])[5] @ right) > 0


def test_pedestals_rise_and_sink() -> None:
    for movement, sign in (("pedestal-up", 1), ("pedestal-down", -1)):
        for c in filmed(still_story(skeleton()), 1.7, movement=movement):
            assert sign * (c.track.position[-1, 2] - c.track.position[0, 2]) > 0.1
            assert np.ptp(c.track.position[:, :2], axis=0).max() < 1e-9


@pytest.mark.parametrize("scale", SIZES)
def test_achieved_size_and_angle_are_what_was_asked(scale: str) -> None:
    acted = still_story(skeleton())
    subject = subject_of(acted, 1.7)
    for angle in ANGLES:
        for c in filmed(acted, 1.7, scale=scale, angle=angle):
            assert achieved_size(c.track, subject, 0) == scale
            assert angle in achieved_angles(c.track, subject, 0)


@pytest.mark.parametrize("roll", [-0.5, 0.15, 0.4])
def test_landmarks_sit_on_the_lines_of_a_leaning_picture(roll: float) -> None:
    acted = still_story(skeleton())
    marks = subject_of(acted, 1.7).landmarks
    for scale in ("close-up", "cowboy", "full"):
        size = SIZES[scale]
        for c in filmed(acted, 1.7, scale=scale, roll=roll):
            axes = camera_axes(c.track.rotation[0])
            points = np.stack([marks[size.upper][0], marks[size.lower][0], marks["eyes"][0]])
            xy, _ = project(points, c.track.position[0], axes, c.track.focal[0], c.track.sensor)
            assert xy[0, 1] == pytest.approx(size.top, abs=0.01)
            assert xy[1, 1] == pytest.approx(size.bottom, abs=0.01)
            assert 0.1 < xy[2, 0] < 0.9
            assert c.track.rotation[0, 0] == roll


def laid(acted: StoryProposal, height: float) -> StoryProposal:
    """The same figure on its back, head towards −x, half a metre up."""
    p = acted.performances["anna"]
    turn = np.array([[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]])
    joints = p.world_from_joint.copy()
    joints[..., :3, :] = turn @ joints[..., :3, :]
    joints[..., 2, 3] += 0.5
    return story({"anna": replace(p, world_from_joint=joints)})


@pytest.mark.parametrize("scale", ["extreme-close-up", "close-up", "medium", "full", "wide"])
@pytest.mark.parametrize("angle", ["eye-level", "high-angle", "overhead"])
def test_one_who_lies_is_as_large_as_one_who_stands(scale: str, angle: str) -> None:
    acted = laid(still_story(skeleton()), 1.7)
    subject = subject_of(acted, 1.7)
    size = SIZES[scale]
    cameras = filmed(acted, 1.7, scale=scale, angle=angle)
    assert len(cameras) == 40
    for c in cameras:
        axes = camera_axes(c.track.rotation[0])
        ends = (subject.landmarks[size.upper][0], subject.landmarks[size.lower][0])
        filled = stretch(*ends, c.track.position[0], axes, c.track.focal[0], c.track.sensor)
        assert float(filled) == pytest.approx(size.share, rel=0.01)
        assert achieved_size(c.track, subject, 0) == scale


def test_overhead_looks_straight_down_and_a_worm_lies_on_the_ground() -> None:
    for scale in ("medium", "full"):
        for c in filmed(still_story(skeleton()), 1.7, scale=scale, angle="overhead"):
            assert c.measures["elevation"] >= 80.0
        for c in filmed(still_story(skeleton()), 1.7, scale=scale, angle="worms-eye"):
            assert c.measures["elevation"] < -35.0 or c.measures["height"] < 0.5


@pytest.mark.parametrize(
    ("angle", "share", "scale"),
    [
        ("shoulder-level", 0.80, "medium"),
        ("hip-level", 0.50, "full"),
        ("knee-level", 0.27, "full"),
        ("ground-level", None, "wide"),
    ],
)
def test_levels_put_the_lens_at_their_height(angle: str, share: float | None, scale: str) -> None:
    for height in (1.2, 1.9):
        acted = still_story(skeleton(height))
        cameras = filmed(acted, height, scale=scale, angle=angle)
        assert cameras
        size, marks = SIZES[scale], subject_of(acted, height).landmarks
        for c in cameras:
            wanted = 0.2 if share is None else share * height
            assert c.track.position[0, 2] == pytest.approx(wanted, abs=0.06)
            axes = camera_axes(c.track.rotation[0])
            points = np.stack([marks[size.upper][0], marks[size.lower][0]])
            xy, _ = project(points, c.track.position[0], axes, c.track.focal[0], c.track.sensor)
            assert xy[:, 1] == pytest.approx((size.top, size.bottom), abs=0.01)


def test_low_cameras_say_that_they_were_lifted() -> None:
    cameras = filmed(still_story(skeleton()), 1.7, scale="wide", angle="low-angle", lens=(80.0, 80.0))
    assert cameras
    for c in cameras:
        assert float(c.params["lifted"]) > 0.05
        assert c.track.position[0, 2] == pytest.approx(FLOOR_CLEARANCE, abs=0.01)


def test_a_follow_keeps_its_distance() -> None:
    acted = walking_story(skeleton(), metres=4.0)
    cameras = filmed(acted, 1.7, movement="follow", scale="full", ease=(1.0,))
    moved = np.array([c.track.position[-1] - c.track.position[0] for c in cameras])
    walked = acted.performances["anna"].position
    np.testing.assert_allclose(
        moved, np.tile(walked[-1] - walked[0], (len(moved), 1)), atol=0.4
    )  # starts softly
    for c in cameras:
        reach = np.linalg.norm(c.track.position - c.track.look_at, axis=1)
        np.testing.assert_allclose(reach, reach[0], atol=1e-6)


@pytest.mark.parametrize("angle", ["eye-level", "overhead"])
def test_headroom_is_asked_of_the_upright_and_the_middle_of_others(angle: str) -> None:
    for c in filmed(still_story(skeleton()), 1.7, movement="static", scale="medium", angle=angle):
        assert c.measures["headroom_error"] < 0.05
        assert c.measures["thirds_error"] < 0.2
    # as much too low as it is off the middle
    far = filmed(walking_story(skeleton(), metres=1.5), 1.7, movement="static", scale="wide", angle=angle)
    assert max(c.measures["headroom_error"] for c in far) > 0.02


@pytest.mark.parametrize("roll", [0.0, 0.3])
@pytest.mark.parametrize("angle", ["eye-level", "high-angle", "overhead"])
def test_the_height_asked_for_while_halving_is_that_of_the_camera_found(angle: str, roll: float) -> None:
    lot, count = np.random.default_rng(5), 40
    upper = lot.normal((0.0, 0.0, 1.6), 0.4, (count, 3))
    lower = upper - (0.0, 0.0, 0.7) + lot.normal(0.0, 0.4, (count, 3))  # some of them lie
    across = upper + lot.normal(0.0, 0.2, (count, 3))
    phi, focal = lot.uniform(-3.0, 3.0, count), lot.uniform(20.0, 90.0, count)
    film, ones = rig_cinema.sensor(16 / 9), np.ones(count)
    lines = (0.1 * ones, 0.9 * ones, lot.uniform(0.3, 0.7, count))
    theta = CINEMA_THETA[angle] + lot.uniform(-0.2, 0.2, count)
    r, aim = solve(upper, lower, across, theta, phi, focal, film, lines, roll)
    found = risen(upper, lower, across, phi, focal, film, lines, roll)(theta)
    np.testing.assert_allclose(found, (aim + r[:, None] * direction(theta, phi))[:, 2], atol=1e-12)
