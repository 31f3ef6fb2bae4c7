"""Guides of drawn proposals: whom a shot is about, and how the camera makes the picture move."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import torch
from proposed_shots import proposed

from ranker.crowd import LEAST_TOGETHER, crowd_of
from ranker.guides import CHANNELS, FLOW, MARKS, SIDE, pairs
from runtime.body.skeleton import JOINT
from vdsl.cinema.gestures import at_work
from vdsl.cinema.takes import samples
from vdsl.cinema.track import CameraTrack, camera_axes, look_at_rotation, project
from vdsl.pipeline.acts import Act
from vdsl.pipeline.filming import SEGMENTS, Camerawork, segment_frames
from vdsl.pipeline.guides import About, about_of, paces_of, roles_of
from vdsl.pipeline.hints import frame_hints_of
from vdsl.propose.subjects import subject_of
from vdsl.propose.types import CameraProposal, ProposalGrid, StoryProposal

STORY = """storyboard "t"
proposals 16
character anna = woman
character ben = man
scene s = apartment.kitchen
anna at counter
ben at table
(anna wave) / (SHOT) FOCUS
"""


@pytest.fixture(scope="module")
def camerawork() -> Camerawork:
    return Camerawork("cpu")


def filmed(shot: str, focus: str = "") -> tuple[Act, ProposalGrid]:
    return proposed(STORY.replace("SHOT", shot).replace("FOCUS", focus))


@pytest.mark.parametrize("words", ["push medium", "pan-left full", "pedestal-up full", "zoom-in medium"])
def test_motion_is_where_what_is_seen_is_seen_next(words: str, camerawork: Camerawork) -> None:
    act, grid = filmed(words)
    camera = grid.cameras[0]
    story = next(s for s in grid.story if s.index == camera.story)
    about = [about_of(act.line.shots[0], grid, act.filming, act.staged)]
    seen = camerawork.judge_frames(act.staged, "board", grid.story, (camera,), about=about)
    assert seen.guides is not None
    flow = seen.guides.flow[0].astype(float)
    track, at = camera.track, segment_frames(story.frames)
    code = seen.guides.maps[0, ..., CHANNELS.index("nearness")]
    step, compared = SIDE // FLOW, 0
    for pair, (i, j) in enumerate(pairs(SEGMENTS)):
        axes = camera_axes(track.rotation[at[i]])
        for row in range(FLOW):
            for column in range(FLOW):
                block = code[i, row * step : (row + 1) * step, column * step : (column + 1) * step]
                if block.min() == 0 or np.ptp(block.astype(int)) > 3:
                    continue  # not of one depth
                depth = 0.25 * np.exp((255 - block.mean()) / 254 * np.log(256))
                x, y = ((k + 0.5) * 2 / FLOW - 1 for k in (column, row))
                lens = np.array(track.sensor) / (2 * track.focal[at[i]])
                ray = axes[2] + x * lens[0] * axes[0] - y * lens[1] * axes[1]
                point = track.position[at[i]] + depth * ray
                xy, away = project(
                    point[None, None],
                    track.position[at[j]][None],
                    camera_axes(track.rotation[at[j]])[None],
                    track.focal[at[j]][None],
                    track.sensor,
                )
                if away[0, 0] < 0.1:
                    continue
                there = np.clip(2 * xy[0, 0] - 1 - (x, y), -3, 3)
                np.testing.assert_allclose(flow[pair, row, column], there, atol=0.004, rtol=0.03)
                compared += 1
    assert compared > 50
    assert np.abs(flow).max() > 0.05


def test_a_still_camera_has_no_motion_and_a_glance_none_that_is_known(camerawork: Camerawork) -> None:
    act, grid = filmed("static full eye-level")
    about = [about_of(act.line.shots[0], grid, act.filming, act.staged)] * 2
    seen = camerawork.judge_frames(act.staged, "board", grid.story, grid.cameras[:2], about=about)
    assert seen.guides is not None
    assert np.abs(seen.guides.flow).max() < 1e-3
    rise = seen.guides.maps[..., CHANNELS.index("rise")].astype(int)
    assert (rise[:, :, 0] > rise[:, :, -1]).all()  # the top of a picture looks higher than its bottom
    assert np.abs(rise.mean((2, 3)) - 128).max() < 20
    glance = camerawork.judge_frames(
        act.staged, "board", grid.story, grid.cameras[:2], which=(1, 6), about=about
    )
    assert glance.guides is not None
    np.testing.assert_array_equal(glance.guides.maps, seen.guides.maps[:, [1, 6]])
    np.testing.assert_array_equal(glance.guides.marks, seen.guides.marks[:, [1, 6]])
    assert np.isnan(glance.guides.flow).all()


def test_whom_a_shot_is_about(camerawork: Camerawork) -> None:
    act, grid = filmed("static medium eye-level two-shot")
    ids = act.staged.object_ids
    assert set(about_of(act.line.shots[0], grid, act.filming, act.staged).objects) == set(ids.values())
    act, grid = filmed("static medium eye-level")
    (anna,) = about_of(act.line.shots[0], grid, act.filming, act.staged).objects
    assert anna == act.staged.object_ids["anna"]
    roles = roles_of(act.staged, [About((anna,), {}), About((), {})])
    assert roles[:, [anna, act.staged.object_ids["ben"]]].tolist() == [[1, 2], [2, 2]]
    assert (roles[:, : len(act.staged.world.objects)] == 0).all()
    act, grid = filmed("static medium eye-level", "focus counter")
    (counter,) = about_of(act.line.shots[0], grid, act.filming, act.staged).objects
    assert act.staged.world.objects[counter].path[-1] == "counter"


def test_marks_are_where_the_subject_is_and_what_is_before_it(camerawork: Camerawork) -> None:
    act, grid = filmed("static medium-close-up eye-level")
    shot, camera = act.line.shots[0], grid.cameras[0]
    story = next(s for s in grid.story if s.index == camera.story)
    subject, at = subject_of(shot, story, act.filming), segment_frames(story.frames)
    about = about_of(shot, grid, act.filming, act.staged)
    seen = camerawork.judge_frames(act.staged, "board", grid.story, (camera,), about=[about])
    assert seen.guides is not None
    told = {name: seen.guides.marks[0, :, k].astype(float) for k, name in enumerate(MARKS)}
    (known,) = frame_hints_of([camera], subject, at)
    for mark, hint in (("right_eyes", "right_eyes"), ("up_crown", "crown"), ("right_face", "right_face")):
        np.testing.assert_allclose(told[mark], known[hint], atol=3e-3)
    for mark, hint in (("size", "size"), ("lens", "lens"), ("over", "over"), ("right_roll", "right_roll")):
        np.testing.assert_allclose(told[mark], known[hint], atol=3e-3)
    np.testing.assert_allclose(told["seconds"], np.log(story.frames / act.filming.fps), atol=2e-3)
    assert np.abs(told["covered_eyes"]).max() < 0.3  # nothing before her face but its front
    assert 0.0 < told["before_eyes"].min() < told["before_eyes"].max() < 0.3  # which is before the eyes
    assert (told["open"] == camera.hidden_walls.any()).all()
    assert np.isnan(told["covered_feet"]).all()  # they are not in the picture
    assert np.isnan(told["right_other_2"]).all()

    behind = replace(camera, track=_from_behind_ben(camera, story, at))
    hidden = camerawork.judge_frames(act.staged, "board", grid.story, (behind,), about=[about])
    assert hidden.guides is not None
    covered = hidden.guides.marks[0, :, MARKS.index("covered_eyes")].astype(float)
    assert np.nanmin(covered) > 0.5
    walls = replace(camera, hidden_walls=~camera.hidden_walls)
    other = camerawork.judge_frames(act.staged, "board", grid.story, (walls, camera), about=[about] * 2)
    assert other.guides is not None
    opened = other.guides.marks[:, 0, MARKS.index("open")].tolist()
    assert opened == [float(walls.hidden_walls.any()), float(camera.hidden_walls.any())]
    assert max(opened) == 1.0


def _from_behind_ben(camera: CameraProposal, story: StoryProposal, at: np.ndarray) -> CameraTrack:
    """A look at anna's eyes with ben's head right before it."""
    anna, ben = (
        story.performances[name].world_from_joint[:, JOINT["head"], :3, 3].astype(float)
        for name in ("anna", "ben")
    )
    away = (ben - anna) / np.linalg.norm(ben - anna, axis=1, keepdims=True)
    place = ben + 0.5 * away
    return replace(camera.track, position=place, look_at=anna, rotation=look_at_rotation(place, anna))


def test_what_lies_behind_the_camera_is_told_of_and_what_there_is_not_is_not(camerawork: Camerawork) -> None:
    act, grid = proposed(
        STORY.replace("(anna wave)", "(anna greet ben)").replace("SHOT) FOCUS", "static medium)")
    )
    camera = grid.cameras[0]
    story = next(s for s in grid.story if s.index == camera.story)
    about = about_of(act.line.shots[0], grid, act.filming, act.staged)
    at = segment_frames(story.frames)
    between = replace(camera, track=_from_between(camera, story))
    seen = camerawork.judge_frames(act.staged, "board", grid.story, (between,), about=[about])
    assert seen.guides is not None
    told = {name: seen.guides.marks[0, :, k].astype(float) for k, name in enumerate(MARKS)}
    aside = np.maximum(np.abs(told["right_other_1"]), np.abs(told["up_other_1"]))
    np.testing.assert_allclose(aside, 3.0)  # ben, behind the camera: out of the picture, as far as is told
    assert np.isnan(told["covered_other_1"]).all()
    assert np.isnan(told["right_other_2"]).all()
    ben = story.performances["ben"].world_from_joint[at, JOINT["head"], :3, 3].astype(float)
    away = ben - between.track.position[at]
    side = np.einsum("tac,tc->ta", camera_axes(between.track.rotation[at])[:, :2], away)
    assert (np.sign(told["right_other_1"]) == np.sign(side[:, 0])).all()


def _from_between(camera: CameraProposal, story: StoryProposal) -> CameraTrack:
    """A look past anna with ben behind the camera, to one side of its axis."""
    anna, ben = (
        story.performances[name].world_from_joint[:, JOINT["head"], :3, 3].astype(float)
        for name in ("anna", "ben")
    )
    beside = np.array([[0.0, 0.0, 1.0]])
    beside = 0.3 * np.cross(ben - anna, beside) / np.linalg.norm(ben - anna, axis=1, keepdims=True)
    place, aim = anna + 0.4 * (ben - anna) + beside, anna + beside
    return replace(camera.track, position=place, look_at=aim, rotation=look_at_rotation(place, aim))


def test_how_much_room_a_camera_has_is_told(camerawork: Camerawork) -> None:
    act, grid = filmed("static medium eye-level")
    shot = act.line.shots[0]
    about = about_of(shot, grid, act.filming, act.staged)
    seen = camerawork.judge_frames(
        act.staged, "board", grid.story, grid.cameras, about=[about] * len(grid.cameras)
    )
    assert seen.guides is not None
    room = seen.guides.marks[:, :, MARKS.index("room")].astype(float)
    measured = np.array([c.measures["clearance"] for c in grid.cameras])
    assert np.abs(room.min(axis=1) - measured).max() < 0.02  # these cameras stand still
    near = replace(grid.cameras[0], track=_from_behind_ben(grid.cameras[0], grid.story[0], segment_frames(2)))
    close = camerawork.judge_frames(act.staged, "board", grid.story, (near,), about=[about])
    assert close.guides is not None
    assert (
        close.guides.marks[0, :, MARKS.index("room")].max() < 0.45
    )  # half a metre from the middle of his head


def test_hands_at_work_are_told_of_and_are_those_of_who_acts(camerawork: Camerawork) -> None:
    act, grid = filmed("static medium eye-level two-shot")
    shot, camera = act.line.shots[0], grid.cameras[0]
    story = next(s for s in grid.story if s.index == camera.story)
    at = segment_frames(story.frames)
    anna = subject_of(shot, story, act.filming).members[0]
    about = about_of(shot, grid, act.filming, act.staged)
    seen = camerawork.judge_frames(act.staged, "board", grid.story, (camera,), about=[about])
    assert seen.guides is not None
    told = {name: seen.guides.marks[0, :, k].astype(float) for k, name in enumerate(MARKS)}
    works = at_work(anna, np.arange(story.frames)).mean(axis=0)
    shares = np.array([told["work_l"].mean(), told["work_r"].mean()])
    assert np.abs(shares - works).max() < 0.15
    assert max(shares) > 0.3  # the hand that waves
    assert min(shares) == 0.0  # the other one hangs
    for side in "lr":
        xy, _ = project(
            anna.landmarks[f"hand_{side}"][at][:, None],
            camera.track.position[at],
            camera_axes(camera.track.rotation[at]),
            camera.track.focal[at],
            camera.track.sensor,
        )
        np.testing.assert_allclose(told[f"right_hand_{side}"], np.clip(2 * xy[:, 0, 0] - 1, -3, 3), atol=3e-3)


@pytest.mark.parametrize("frames", [8, 9, 30, 97, 240])
def test_what_is_measured_are_the_frames_that_the_ranker_is_shown(frames: int) -> None:
    np.testing.assert_array_equal(samples(frames), segment_frames(frames))


def test_people_are_told_of_one_by_one(camerawork: Camerawork) -> None:
    act, grid = filmed("static medium eye-level two-shot")
    shot, camera = act.line.shots[0], grid.cameras[0]
    story = next(s for s in grid.story if s.index == camera.story)
    at = segment_frames(story.frames)
    members = subject_of(shot, story, act.filming).members
    about = about_of(shot, grid, act.filming, act.staged)
    seen = camerawork.judge_frames(act.staged, "board", grid.story, (camera,), about=[about])
    assert seen.guides is not None
    told = {name: seen.guides.marks[0, :, k].astype(float) for k, name in enumerate(MARKS)}
    assert [one.name for one in members] == ["anna", "ben"]  # who acts comes first
    for k, one in enumerate(members, 1):
        xy, _ = project(
            one.landmarks["eyes"][at][:, None],
            camera.track.position[at],
            camera_axes(camera.track.rotation[at]),
            camera.track.focal[at],
            camera.track.sensor,
        )
        np.testing.assert_allclose(told[f"right_eyes_{k}"], np.clip(2 * xy[:, 0, 0] - 1, -3, 3), atol=3e-3)
        away = camera.track.position[at] - one.landmarks["eyes"][at]
        distance = np.linalg.norm(away, axis=1)
        np.testing.assert_allclose(told[f"distance_{k}"], np.log(distance), atol=3e-3)
        np.testing.assert_allclose(
            told[f"turned_{k}"], (one.face[at] * away).sum(axis=1) / distance, atol=3e-3
        )
        assert (told[f"about_{k}"] == 1).all()
    assert np.isnan(told["right_eyes_3"]).all()
    assert np.isnan(told["distance_3"]).all()

    behind = replace(camera, track=_from_behind_ben(camera, story, at))
    hidden = camerawork.judge_frames(act.staged, "board", grid.story, (behind,), about=[about])
    assert hidden.guides is not None
    before, own = (hidden.guides.marks[0, :, MARKS.index(f"covered_eyes_{k}")].astype(float) for k in (1, 2))
    assert np.nanmin(before) > 0.5  # behind the other, though both are what the shot is about
    assert np.nanmax(own) < 0.35

    act, grid = filmed("static medium eye-level over-shoulder ben")
    about = about_of(act.line.shots[0], grid, act.filming, act.staged)
    seen = camerawork.judge_frames(act.staged, "board", grid.story, grid.cameras[:1], about=[about])
    assert seen.guides is not None
    assert (seen.guides.marks[0, :, MARKS.index("about_1")] == 0).all()  # ben, whom it is not about
    assert (seen.guides.marks[0, :, MARKS.index("distance_1")] < 1.0).all()


def test_how_a_camera_goes_is_told() -> None:
    _, grid = filmed("static full eye-level")
    track = grid.cameras[0].track
    count, fps = len(track.position), 24.0
    at, seconds = segment_frames(count), np.arange(count) / fps
    straight = np.stack([0.5 * seconds, 0 * seconds, 0 * seconds], axis=1)
    turned = np.stack([0 * seconds, 0 * seconds, 0.3 * seconds], axis=1)
    even = paces_of(replace(track, position=straight, rotation=turned), at, count / fps)
    np.testing.assert_allclose(even, np.tile(np.sqrt((0.5, 0.3, 0.0)), (len(at), 1)), atol=2e-3)
    jolted = straight.copy()
    jolted[at[3] + 1 :, 2] += 0.05
    jerks = paces_of(replace(track, position=jolted, rotation=turned), at, count / fps)[:, 2]
    assert jerks[3] > 10
    assert max(*jerks[:2], *jerks[5:]) < 0.1


@pytest.mark.parametrize("words", ["static full", "static wide", "pedestal-up full"])
def test_how_near_two_heads_are_to_each_other_is_told_as_it_is_measured(
    words: str, camerawork: Camerawork
) -> None:
    act, grid = filmed(words)
    about = [about_of(act.line.shots[0], grid, act.filming, act.staged)] * len(grid.cameras)
    guides = camerawork.judge_frames(
        act.staged, "board", grid.story, grid.cameras, about=about, pictures=False
    ).guides
    assert guides is not None
    found = crowd_of(torch.from_numpy(guides.marks).float(), torch.from_numpy(guides.maps))
    told = np.sinh(found[:, LEAST_TOGETHER].numpy()) / 5
    measured = np.array([camera.measures["together"] for camera in grid.cameras])
    assert measured.max() > 0.2
    assert np.abs(told - measured).mean() < 0.05
    assert np.corrcoef(told, measured)[0, 1] > 0.8
