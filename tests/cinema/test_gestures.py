"""Hands at work are to be seen: in the frame, and not behind the body they belong to."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from vdsl.cinema.gestures import _apart, face_covered, gesture_lost
from vdsl.cinema.sizes import size_of
from vdsl.cinema.subject import Subject
from vdsl.cinema.takes import Takes, pictured
from vdsl.cinema.track import CameraTrack, camera_axes, look_at_rotation
from vdsl.pipeline.compile import Act
from vdsl.pipeline.trial import stage_script
from vdsl.propose.cameras import propose_cameras
from vdsl.propose.story import tell
from vdsl.propose.subjects import subject_of
from vdsl.propose.types import CameraProposal

FLOOR = "set floor { area floor, at (-9, -9)m, size (18, 18)m { spot here, at (9, 9)m, facing 0deg\n"
FLOOR += "spot there, at (13, 9)m } }"


def filmed(line: str, camera: str) -> tuple[Act, tuple[CameraProposal, ...]]:
    text = "\n".join(
        ('storyboard "S"', FLOOR, "character anna = woman", "scene s = floor", "anna at here",
         f"{line} / ({camera})  proposals 60", "")
    )  # fmt: skip
    act = stage_script(text, "s")
    told = tell(act.state, act.line, act.filming, shot=act.line.shots[0])
    return act, propose_cameras(act.line.shots[0], told.proposals[:1], act.filming).cameras


def test_from_behind_one_does_not_see_what_hands_do() -> None:
    _, cameras = filmed("(anna clap)", "static full eye-level")
    face, missed = (np.array([c.measures[k] for c in cameras]) for k in ("face", "hands_missed"))
    assert missed[face > 0.5].max() == 0.0
    assert missed[face < -0.9].mean() > 0.4
    best = max(cameras, key=lambda c: c.measures["geometry"])
    assert best.measures["hands_missed"] == 0.0


def test_hands_that_swing_or_are_not_in_a_close_up_are_not_missed() -> None:
    for line, camera in (("(anna walk there)", "static full eye-level"), ("(anna clap)", "static close-up")):
        assert {c.measures["hands_missed"] for c in filmed(line, camera)[1]} == {0.0}, line


def test_what_hands_do_is_filmed_from_where_it_stands_out_from_the_body() -> None:
    """An arm that points at the camera is lost before the body; from aside it is plain."""
    act, cameras = filmed("(anna stretch)", "static full eye-level")
    told = tell(act.state, act.line, act.filming, shot=act.line.shots[0]).proposals[0]
    body = subject_of(act.line.shots[0], told, act.filming)
    at = np.arange(0, body.frames, 8)
    before = {"hand_l": 0.5 * body.face, "hand_r": 0.5 * body.face}
    marks = body.landmarks
    pointing = replace(body, landmarks=marks | {k: marks["collar"] + v for k, v in before.items()})
    track = cameras[0].track
    left = np.cross((0.0, 0.0, 1.0), body.face)
    shown = np.ones((2, len(at), 2), bool)
    places = np.stack([marks["pocket"] + 4.0 * way for way in (body.face, left)])
    ways = look_at_rotation(places, np.stack([marks["pocket"]] * 2), 0.0)
    both = CameraTrack(places, ways, np.full(places.shape[:2], 35.0), places, track.sensor)
    sizes = (size_of("person", "full"),) * 2
    takes = Takes(both, sizes, np.ones((2, len(at)), bool), np.zeros(2, np.int64), 0.0, False, ())
    camera, axes = places[:, at], camera_axes(ways[:, at])

    def lost(one: Subject, takes: Takes = takes) -> NDArray[np.float64]:
        return gesture_lost(takes, one, at, pictured(takes, one, at, camera, axes), shown)

    ahead, aside = lost(pointing)
    assert ahead > 0.9
    assert aside < 0.1
    hanging = replace(body, landmarks=marks | {k: marks["thigh"] for k in before})
    assert (lost(hanging) == 0.0).all(), "they do nothing"
    near = replace(takes, sizes=(size_of("person", "close-up"),) * 2)
    assert (lost(pointing, near) == 0.0).all(), "a close-up shows no hands"
    hidden = np.array([c.measures["hands_missed"] == 1.0 for c in cameras])
    assert all(c.measures["gesture_lost"] > 0.99 for c, h in zip(cameras, hidden, strict=True) if h)


def test_a_line_of_sight_keeps_its_distance_to_the_trunk() -> None:
    """Against many points of both."""
    rng = np.random.default_rng(4)
    camera = rng.uniform(-3, 3, (40, 5, 3))
    hand, collar = rng.uniform(-0.6, 0.6, (1, 5, 3)), rng.uniform(-0.3, 0.3, (1, 5, 3))
    trunk = np.array((0.05, 0.0, -0.4)) + rng.uniform(-0.1, 0.1, (1, 5, 3))
    along, down = np.linspace(0, 0.93, 300), np.linspace(0, 1, 60)
    ray = camera[..., None, :] + along[:, None] * (hand - camera)[..., None, :]
    body = collar[..., None, :] + down[:, None] * trunk[..., None, :]
    least = np.linalg.norm(ray[..., :, None, :] - body[..., None, :, :], axis=-1).min(axis=(-1, -2))
    np.testing.assert_allclose(_apart(camera, 0.93 * (hand - camera), collar, trunk), least, atol=0.012)


def test_an_arm_before_the_face_counts_where_another_side_shows_it() -> None:
    """A forearm upright before the face hides it from ahead; hands all around it hide it from everywhere."""
    act, cameras = filmed("(anna clap)", "static close-up eye-level")
    told = tell(act.state, act.line, act.filming, shot=act.line.shots[0]).proposals[0]
    plain = subject_of(act.line.shots[0], told, act.filming)
    every, at = np.ones((2, 2), bool), np.array([0, 5])
    takes = Takes(cameras[0].track, (), every, np.zeros(2, np.int64), 0.0, False, ())
    eyes = plain.landmarks["eyes"][at]
    ahead, left = plain.face[at], np.cross((0.0, 0.0, 1.0), plain.face[at])
    camera = np.stack([eyes + 2.0 * ahead, eyes + 2.0 * (0.5 * ahead + 0.87 * left)])

    def before(*ways: NDArray[np.float64]) -> Subject:
        """With an upright forearm 15 cm from the eyes in each of two directions."""
        arms = np.empty((plain.frames, 2, 3, 3))
        for side, way in enumerate(ways):
            elbow = plain.landmarks["eyes"] + 0.15 * way[0] - (0.0, 0.0, 0.2)
            heights = np.array((-0.3, 0.0, 0.25))[:, None] * (0.0, 0.0, 1.0)  # of shoulder, elbow and wrist
            arms[:, side] = elbow[:, None] + heights
        return replace(plain, arms=arms)

    away = -ahead
    covered = face_covered(takes, before(ahead, away), at, camera)
    np.testing.assert_allclose(covered, (1.0, 0.0))
    assert (face_covered(takes, before(away, away), at, camera) == 0.0).all()
    assert (face_covered(takes, replace(plain, arms=None), at, camera) == 0.0).all()


def test_who_guards_the_face_is_filmed_from_where_it_is_seen() -> None:
    _, cameras = filmed("(anna do yoga)", "static medium eye-level")
    covered = np.array([c.measures["face_covered"] for c in cameras])
    assert covered.max() > 0.3
    best = max(cameras, key=lambda c: c.measures["geometry"])
    assert best.measures["face_covered"] < 0.2
