"""Movements beyond the paper's and two at once: framed, smooth, exact, and what they are called."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from filmset import shot, skeleton, still_story, walking_story, world

from vdsl.cinema.further import shakes, whip
from vdsl.cinema.moves import family
from vdsl.cinema.reading import canonical, read_movement
from vdsl.cinema.sizes import SIZES
from vdsl.cinema.subject import person
from vdsl.cinema.track import camera_axes, project
from vdsl.lang.ir import FURTHER_MOVEMENTS
from vdsl.propose.cameras import Filming, propose_cameras
from vdsl.propose.promise import achieved
from vdsl.propose.types import CameraProposal, StoryProposal

BODY = skeleton()
PAIRS = (
    "push+pan-left",
    "pull+tilt-up",
    "arc-left+crane-up",
    "push+arc-right",
    "dolly-right+zoom-in",
    "static+handheld",
    "follow+handheld",
    "push+pedestal-up",
    "roll-left+push",
    "dolly-left+tilt-down",
    "push+tilt-up",
    "pull+tilt-down",
)


def subject(acted: StoryProposal) -> object:
    p = acted.performances["anna"]
    return person("anna", BODY, p.world_from_joint, p.position, p.heading)


def filmed(
    acted: StoryProposal, movement: str, scale: str = "medium", **said: object
) -> tuple[CameraProposal, ...]:
    filming = Filming(world(), {"anna": BODY}, 24.0, 3)
    return propose_cameras(shot(movement, scale, **said), [acted], filming).cameras  # type: ignore[arg-type]


@pytest.mark.parametrize("movement", [*(m for m in FURTHER_MOVEMENTS if m != "rack-focus"), *PAIRS])
def test_it_is_framed_smooth_and_called_rightly(movement: str) -> None:
    acted = still_story(BODY)
    who = subject(acted)
    cameras = filmed(acted, movement)
    assert len(cameras) == 40
    size, marks = SIZES["medium"], who.landmarks  # type: ignore[attr-defined]
    for c in cameras:
        assert achieved(c, who, "cinema").movement == movement  # type: ignore[arg-type]
        key = -1 if c.params["reference"] == "end" else 0
        t = c.track
        points = np.stack([marks[size.upper][key], marks[size.lower][key]])
        if not {"dolly", "pedestal"} & {family(m) for m in movement.split("+")}:
            xy, _ = project(points, t.position[key], camera_axes(t.rotation[key]), t.focal[key], t.sensor)
            assert xy[:, 1] == pytest.approx((size.top, size.bottom), abs=0.01)
        assert np.abs(np.diff(t.position, n=2, axis=0)).max() < 0.03
        assert t.focal.min() >= 30.0 - 1e-9
        assert t.focal.max() <= 80.0 + 1e-9
        if not movement.startswith("whip"):
            assert np.abs(np.diff(t.rotation, n=2, axis=0)).max() < 0.03
        if "roll" not in movement:
            assert not t.rotation[:, 0].any()


@pytest.mark.parametrize("movement", ["dolly-zoom-in", "dolly-zoom-out"])
def test_a_dolly_zoom_keeps_the_visible_height(movement: str) -> None:
    for c in filmed(walking_story(BODY), movement):
        t = c.track
        view = np.linalg.norm(t.position - t.look_at, axis=1) * t.sensor[1] / t.focal
        np.testing.assert_allclose(view, view[0], rtol=1e-9)
        nearer = np.linalg.norm(t.position - t.look_at, axis=1)
        assert (nearer[-1] < 0.7 * nearer[0]) == movement.endswith("in")


@pytest.mark.parametrize(("movement", "sign"), [("crane-up", 1), ("crane-down", -1)])
def test_a_crane_rises_on_a_sphere_about_its_subject(movement: str, sign: int) -> None:
    for c in filmed(still_story(BODY), movement, "full"):
        t = c.track
        assert sign * (t.position[-1, 2] - t.position[0, 2]) > 0.4
        reach = np.linalg.norm(t.position - t.look_at, axis=1)
        np.testing.assert_allclose(reach, reach[0], atol=0.02)


@pytest.mark.parametrize(("movement", "sign"), [("roll-left", -1), ("roll-right", 1)])
def test_a_roll_leans_that_way(movement: str, sign: int) -> None:
    for c in filmed(still_story(BODY), movement, roll=0.1):
        roll = c.track.rotation[:, 0]
        assert np.radians(15) - 1e-9 <= sign * (roll[-1] - roll[0]) <= np.radians(40) + 1e-9
        assert roll[-1 if c.params["ending"] == "on" else 0] == pytest.approx(0.1)


@pytest.mark.parametrize("movement", ["roll-left", "roll-right"])
def test_a_roll_goes_with_one_who_walks(movement: str) -> None:
    acted = walking_story(BODY)
    who = subject(acted)
    cameras = filmed(acted, movement, "medium")
    assert len(cameras) == 40
    for c in cameras:
        assert achieved(c, who, "cinema").movement == movement  # type: ignore[arg-type]
        assert c.measures["in_frame"] > 0.85
        assert np.linalg.norm(c.track.position[-1] - c.track.position[0]) > 2.5


def test_a_whip_is_still_then_quick_then_still() -> None:
    w = whip(72, 24.0)
    assert (w[:11] == 0).all()
    assert (w[20:] == 1).all()
    assert ((w > 0) & (w < 1)).sum() <= 8
    for c in filmed(still_story(BODY), "whip-pan-left"):
        yaw = c.track.rotation[:, 2]
        assert np.radians(60) - 1e-9 <= yaw[-1] - yaw[0] <= np.radians(100) + 1e-9


def test_shakes_are_band_limited_and_the_same_for_a_seed() -> None:
    noise = shakes(np.array([3, 4, 3]), 480, 24.0)
    assert np.array_equal(noise[0], noise[2])
    assert not np.array_equal(noise[0], noise[1])
    assert noise.std() == pytest.approx(1.0, abs=0.25)
    power = np.abs(np.fft.rfft(noise * np.hanning(480)[:, None], axis=1)) ** 2
    hertz = np.fft.rfftfreq(480, 1 / 24.0)
    assert power[:, hertz > 2.8].sum() < 0.01 * power.sum()


def test_each_of_two_has_its_own_easing_unless_one_is_said() -> None:
    cameras = filmed(still_story(BODY), "push+pan-left", proposals=80)
    assert len({(c.params["lambda"], c.params["lambda_2"]) for c in cameras}) >= 7
    for c in filmed(still_story(BODY), "push+pan-left", ease=(10.0,)):
        assert c.params["lambda"] == c.params["lambda_2"] == 10.0


def test_two_at_once_do_both() -> None:
    acted = still_story(BODY)
    for c in filmed(acted, "push+pan-left"):
        assert read_movement(c.track, subject(acted))[0] == canonical("push+pan-left") == "pan-left+push"  # type: ignore[arg-type]


def test_coming_nearer_while_looking_up_a_body_is_no_rise_unless_it_rises() -> None:
    acted = still_story(BODY)
    found = set()
    for c in filmed(acted, "push+tilt-up"):
        assert read_movement(c.track, subject(acted))[0] == "push+tilt-up"  # type: ignore[arg-type]
        climb = np.linspace(0.0, 1.2, len(c.track.position))[:, None] * [0.0, 0.0, 1.0]
        found.add(
            read_movement(replace(c.track, position=c.track.position + climb - [0, 0, 1.2]), subject(acted))[
                0
            ]
        )  # type: ignore[arg-type]
    assert all("pedestal-up" in words for words in found)
