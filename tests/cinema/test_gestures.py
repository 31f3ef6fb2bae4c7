"""Hands at work are to be seen: in the frame, and not behind the body they belong to."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from vdsl.cinema.flaws import flaws_by_measure
from vdsl.cinema.gestures import _apart, face_covered, gesture_lost
from vdsl.cinema.in_hand import box_of
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


def test_a_face_looked_at_from_below_may_be_behind_the_chest() -> None:
    act, cameras = filmed("(anna clap)", "static close-up eye-level")
    told = tell(act.state, act.line, act.filming, shot=act.line.shots[0]).proposals[0]
    subject = subject_of(act.line.shots[0], told, act.filming)
    at = np.array([0])
    takes = Takes(cameras[0].track, (), np.ones((3, 1), bool), np.zeros(3, np.int64), 0.0, False, ())
    on_floor = subject.position[at] + (0.0, 0.0, 0.3)
    ahead = subject.face[at] * (1.0, 1.0, 0.0)
    camera = np.stack([on_floor + away * ahead for away in (0.2, 2.0, -2.0)])
    np.testing.assert_allclose(face_covered(takes, subject, at, camera), (1.0, 0.0, 0.0))


def test_who_guards_the_face_is_filmed_from_where_it_is_seen() -> None:
    _, cameras = filmed("(anna do yoga)", "static medium eye-level")
    covered = np.array([c.measures["face_covered"] for c in cameras])
    assert covered.max() > 0.3
    best = max(cameras, key=lambda c: c.measures["geometry"])
    assert best.measures["face_covered"] < 0.2


def test_a_camera_that_comes_when_all_is_done_has_a_fault() -> None:
    _, cameras = filmed("(anna raise hands)", "pan-left medium eye-level")
    missed = np.array([c.measures["act_missed"] for c in cameras])
    assert missed.min() < 0.5 < missed.max() <= 1.0
    late = cameras[int(missed.argmax())]
    assert bool(flaws_by_measure(late.measures)["act_missed"])
    best = max(cameras, key=lambda c: c.measures["geometry"])
    assert best.measures["act_missed"] < 0.5
    for line, camera in (("(anna clap)", "static medium"), ("(anna walk there)", "whip-pan-right medium")):
        assert {c.measures["act_missed"] for c in filmed(line, camera)[1]} == {0.0}, line


def test_a_thing_in_hand_before_the_face_counts_where_another_side_shows_it() -> None:
    act, cameras = filmed("(anna clap)", "static close-up eye-level")
    told = tell(act.state, act.line, act.filming, shot=act.line.shots[0]).proposals[0]
    plain = subject_of(act.line.shots[0], told, act.filming)
    every, at = np.ones((2, 2), bool), np.array([0, 5])
    takes = Takes(cameras[0].track, (), every, np.zeros(2, np.int64), 0.0, False, ())
    eyes, up = plain.landmarks["eyes"], np.array((0.0, 0.0, 1.0))
    left = np.cross(up, plain.face)
    camera = np.stack([eyes + 2.0 * plain.face, eyes + 2.0 * (0.5 * plain.face + 0.87 * left)])[:, at]

    def with_board(way: NDArray[np.float64], scale: float = 1.0) -> Subject:
        """With a board, 30 by 40 cm, 20 cm from the eyes in some direction."""
        moved = np.zeros((plain.frames, 4, 4))
        moved[:, :3, 0], moved[:, :3, 1], moved[:, :3, 2] = way, np.cross(up, way), up
        moved[:, :3, 3], moved[:, 3, 3] = eyes + 0.2 * way, 1.0
        moved[:, :3, :3] *= scale
        board = box_of(moved, np.array((-0.01, -0.15, -0.25)), np.array((0.01, 0.15, 0.15)))
        return replace(plain, in_hand=(board,))

    np.testing.assert_allclose(face_covered(takes, with_board(plain.face), at, camera), (1.0, 0.0))
    assert (face_covered(takes, with_board(-plain.face), at, camera) == 0.0).all()
    nowhere = with_board(plain.face, 0.0)  # as what is not out yet
    assert (face_covered(takes, nowhere, at, camera) == face_covered(takes, plain, at, camera)).all()
    higher = with_board(plain.face).shifted(0.7)
    assert (face_covered(takes, higher, at, camera + 0.7 * up)[0]) == 1.0


def test_lines_of_sight_meet_boxes_as_points_along_them_do() -> None:
    rng = np.random.default_rng(1)
    frames, at = 6, np.arange(6)
    turn = np.linalg.qr(rng.normal(size=(frames, 3, 3)))[0]
    moved = np.zeros((frames, 4, 4))
    moved[:, :3, :3], moved[:, :3, 3], moved[:, 3, 3] = 2.0 * turn, rng.uniform(-0.5, 0.5, (frames, 3)), 1.0
    box = box_of(moved, np.array((-0.1, -0.2, -0.3)), np.array((0.3, 0.2, 0.1)))
    camera, points = rng.uniform(-3, 3, (30, frames, 3)), rng.uniform(-3, 3, (frames, 4, 3))
    met = box.before(at, camera, points, 0.0)
    share = np.linspace(0, 1, 2001)[1:-1]
    along = camera[:, :, None, None] + share[:, None] * (points[None] - camera[:, :, None])[..., None, :]
    local = np.einsum("fij,pfksj->pfksi", box.axes, along - box.centre[:, None, None])
    inside = (np.abs(local) < box.half).all(axis=-1).any(axis=-1)
    assert (met == inside).mean() > 0.995
    assert inside.mean() > 0.03
    assert not (inside & ~met).any()


def test_what_is_held_is_known_to_cameras() -> None:
    text = 'storyboard "S"\ncharacter anna = woman\nscene s = park at day\nanna at bench\n'
    act = stage_script(text + "(anna wave flag) / (static medium-close-up eye-level)  proposals 8\n", "s")
    told = tell(act.state, act.line, act.filming, shot=act.line.shots[0]).proposals[0]
    (flag,) = subject_of(act.line.shots[0], told, act.filming).in_hand
    assert np.isfinite(flag.centre).any()
    assert flag.half.max() > 0.3
    plain = stage_script(text + "(anna clap) / (static medium)  proposals 8\n", "s")
    told = tell(plain.state, plain.line, plain.filming, shot=plain.line.shots[0]).proposals[0]
    assert subject_of(plain.line.shots[0], told, plain.filming).in_hand == ()


def test_a_tilt_that_ends_on_a_lap_has_a_fault() -> None:
    """Knees are somebody, and yet nothing to end on; hands that do something are."""
    _, cameras = filmed("(anna nod)", "tilt-down medium eye-level")
    empty = np.array([c.measures["empty"] for c in cameras])
    faulty = np.array([bool(flaws_by_measure(c.measures)["empty"]) for c in cameras])
    assert faulty.any()
    assert not faulty.all()
    assert (empty[faulty] >= 0.3).all()
    ends = np.array([c.params["ending"] for c in cameras])
    assert "off" in set(ends[faulty])
    best = max(cameras, key=lambda c: c.measures["geometry"])
    assert best.measures["empty"] < 0.25
