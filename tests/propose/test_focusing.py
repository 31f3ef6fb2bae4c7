"""What is sharp in a take, where a rack-focus goes, and that it can be seen."""

from __future__ import annotations

import numpy as np
import pytest
from filmset import SPAN, shot, skeleton, standing, story, thing, walking_story, world

from runtime.world import Spot
from vdsl.cinema.focus import STOPS, TOLD, between, circles, depths, focus_distances, racked, shows_rack
from vdsl.cinema.subject import person
from vdsl.cinema.track import CameraTrack, camera_axes, project
from vdsl.lang.ir import Target
from vdsl.propose.cameras import Filming, propose_cameras, subject_of
from vdsl.propose.promise import achieved
from vdsl.propose.types import ProposalGrid, StoryProposal

BODY = skeleton()
BEN = Target("character", ("ben",), "ben", SPAN)


def two(apart: float = 2.2) -> StoryProposal:
    """Anna, and ben behind her left shoulder."""
    frames = 48
    here, there = np.zeros((frames, 3)), np.tile((-apart, 0.5, 0.0), (frames, 1))
    facing = np.zeros(frames)
    return story({"anna": standing(BODY, here, facing), "ben": standing(BODY, there, facing)})


def filming(**of_world: object) -> Filming:
    return Filming(world(**of_world), {"anna": BODY, "ben": BODY}, 24.0, 3)  # type: ignore[arg-type]


def filmed(movement: str, acted: StoryProposal | None = None, **said: object) -> ProposalGrid:
    return propose_cameras(shot(movement, **said), [acted or two()], filming())  # type: ignore[arg-type]


def eyes(name: str, acted: StoryProposal) -> np.ndarray:
    p = acted.performances[name]
    return person(name, BODY, p.world_from_joint, p.position, p.heading).landmarks["eyes"]


def depth_of(track: CameraTrack, points: np.ndarray) -> np.ndarray:
    """By another way: through the projection that pictures are drawn with."""
    _, depth = project(
        points[:, None], track.position, camera_axes(track.rotation), track.focal, track.sensor
    )
    return depth[:, 0]


def test_without_an_aperture_there_is_no_focus_to_keep() -> None:
    assert all(c.track.focus is None and c.track.aperture == 0.0 for c in filmed("static").cameras)


@pytest.mark.parametrize("movement", ["static", "push", "follow", "arc-left", "zoom-in"])
def test_the_eyes_are_sharp_all_along(movement: str) -> None:
    acted = walking_story(BODY)
    grid = filmed(movement, acted, aperture=1.4)
    assert grid.cameras
    for c in grid.cameras:
        assert c.track.aperture == 1.4
        depth = depth_of(c.track, eyes("anna", acted))
        seen = depth > 0.85 * np.linalg.norm(eyes("anna", acted) - c.track.position, axis=1)
        assert c.track.focus is not None
        np.testing.assert_allclose(c.track.focus[seen], depth[seen], rtol=1e-9)
        assert not shows_rack(c.track, [eyes("anna", acted)])


@pytest.mark.parametrize(
    "movement", ["rack-focus", "push+rack-focus", "rack-focus+crane-up", "arc-left+rack-focus"]
)
def test_a_rack_goes_from_one_to_the_other_and_is_recognised(movement: str) -> None:
    acted = two()
    grid = filmed(movement, acted, focus_to=BEN)
    assert len(grid.cameras) >= 8
    who = subject_of(shot(movement), acted, filming())
    for c in grid.cameras:
        t = c.track
        assert t.focus is not None
        here, there = eyes("anna", acted), eyes("ben", acted)
        assert t.focus[0] == pytest.approx(depth_of(t, here)[0], rel=1e-6)
        assert t.focus[-1] == pytest.approx(max(depth_of(t, there)[-1], 0.25), rel=0.03)
        axes = camera_axes(t.rotation[-1])
        head = there[-1] + np.array([[-0.13], [0.0], [0.13]]) * axes[0]  # from ear to ear, and some hair
        xy, _ = project(head, t.position[-1], axes, t.focal[-1], t.sensor)
        assert ((xy[1] > 0.04) & (xy[1] < 0.96)).all()
        assert ((xy[:, 0] > 0.0) & (xy[:, 0] < 1.0)).all()  # no side of the frame runs through it
        assert float(t.aperture) in STOPS
        assert achieved(c, who, "cinema").kept(c)["movement"]
        # no jolt: the focus starts and ends at rest, and goes evenly in between
        steps = np.diff(1.0 / t.focus - 1.0 / focus_distances(t, here))
        assert np.abs(np.diff(steps)).max() < 0.35 * np.abs(steps).max() + 1e-3


def test_a_rack_that_is_not_seen_is_not_offered() -> None:
    closed = filmed("rack-focus", focus_to=BEN, aperture=64.0)
    assert not closed.cameras
    assert closed.rejected["wrong_movement"] > 0

    cupboard = (-1.0, 0.3, 1.25, 0.05, 4.0, 1.25, 0.0)
    away = propose_cameras(
        shot("rack-focus", angle="eye-level", focus_to=BEN), [two()], filming(boxes=(cupboard,))
    )
    assert not away.cameras  # a cupboard stands between the two


@pytest.mark.parametrize(("who", "at"), [("anna", 0), ("ben", -1)])
def test_nothing_stands_before_a_person_while_in_focus(who: str, at: int) -> None:
    """Posts stand around both of them: a thin one may not even halve a head or a breast."""
    acted = two()
    around = np.arange(4) * (np.pi / 2)
    posts = [
        (x + 0.8 * np.cos(a), y + 0.8 * np.sin(a), 1.25, 0.05, 0.05, 1.25, 0.0)
        for x, y in ((0.0, 0.0), (-2.2, 0.5))
        for a in around
    ]
    grid = propose_cameras(shot("rack-focus", "medium", focus_to=BEN), [acted], filming(boxes=tuple(posts)))
    assert len(grid.cameras) >= 4
    eye = eyes(who, acted)[at]
    for c in grid.cameras:
        camera, right = c.track.position[at], camera_axes(c.track.rotation[at])[0]
        for aside, up in ((-0.1, 0.0), (0.0, 0.0), (0.1, 0.0), (-0.14, -0.3), (0.14, -0.3)):
            line = (eye + aside * right + (0.0, 0.0, up) - camera) * np.linspace(0.0, 0.9, 400)[:, None]
            for x, y, *_ in posts:
                away = np.abs((camera + line)[:, :2] - (x, y)).max(axis=1)
                assert away.min() > 0.05, "a post is before the one in focus"


def test_focus_on_a_spot_is_on_the_spot() -> None:
    table = thing(3, "table", (1.0, -0.4, 0.0), (2.2, 0.4, 0.8), (Spot("end", (2.2, 0.0, 0.8)),))
    focus = Target("spot", ("table", "end"), "table.end", SPAN)
    grid = propose_cameras(shot("static", focus=focus, aperture=2.0), [two()], filming(objects=(table,)))
    assert grid.cameras
    for c in grid.cameras:
        assert c.track.focus is not None
        spot = np.tile((2.2, 0.0, 0.8), (len(c.track.focus), 1))
        np.testing.assert_allclose(c.track.focus, focus_distances(c.track, spot), rtol=1e-9)


def test_two_in_one_picture_blur_alike() -> None:
    s = between([np.array([2.0]), np.array([4.0])])
    near, far = (circles(np.array(50.0), 20.25, np.array(2.0), s, np.array([z])) for z in (2.0, 4.0))
    np.testing.assert_allclose(near, far, rtol=1e-9)


def test_circles_are_those_of_a_thin_lens() -> None:
    """50 mm at f/2 focused at 2 m: a point at 4 m is 0.32 mm wide on the sensor."""
    found = circles(np.array(50.0), 20.0, np.array(2.0), np.array(2.0), np.array(4.0))
    assert float(found) == pytest.approx(50.0**2 / 2 / 1950 * 0.5 / 20.0, rel=1e-9)


def test_racking_rests_on_both_ends_with_its_own_easing() -> None:
    near, far = np.full((3, 97), 1.5), np.full((3, 97), 6.0)
    out = racked(near, far, np.array([0.1, 1.0, 10.0]), 24.0)
    np.testing.assert_allclose(out[:, :20], 1.5)
    np.testing.assert_allclose(out[:, -20:], 6.0)
    assert (np.diff(out, axis=1) >= -1e-12).all()
    half = (1.0 / out < (1 / 1.5 + 1 / 6.0) / 2).argmax(axis=1)
    assert half[0] < half[1] < half[2]  # fast first, even, slow first


def test_telling_needs_a_change_of_sharpness() -> None:
    acted = two()
    (c, *_) = filmed("static", acted, aperture=1.4).cameras
    assert not shows_rack(c.track, [eyes("anna", acted)])
    sizes = circles(
        c.track.focal, c.track.sensor[1], np.asarray(c.track.aperture), c.track.focus,
        depths(c.track, eyes("anna", acted)),
    )  # fmt: skip
    assert sizes.max() < TOLD


def test_a_spot_in_a_room_is_framed_as_if_somebody_stood_there() -> None:
    room = thing(1, "hall", (-5.0, -5.0, 0.0), (5.0, 5.0, 3.0), (Spot("mark", (3.0, 1.0, 0.0), 0.0),), "room")
    focus = Target("spot", ("hall", "mark"), "mark", SPAN)
    subject = subject_of(shot("static", "full", focus=focus), two(), filming(objects=(room,)))
    assert (subject.name, subject.kind) == ("mark", "thing")
    np.testing.assert_allclose(subject.position[0], (3.0, 1.0, 0.0))
    assert 1.5 < subject.height < 1.8
