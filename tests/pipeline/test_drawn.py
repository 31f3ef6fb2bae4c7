"""Takes measured anew by what pictures show of them, and what becomes of clips by that."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from vdsl.pipeline import dataset
from vdsl.pipeline.casting import Scene, Troupe
from vdsl.pipeline.clips import BAR, Clip, as_seen, clips_of
from vdsl.pipeline.dataset import _filmed, _Making
from vdsl.pipeline.designer import judged
from vdsl.pipeline.drawn import as_drawn
from vdsl.pipeline.filming import Camerawork, Seen
from vdsl.pipeline.guides import about_of
from vdsl.propose.types import CameraProposal

#: What pictures have no say in.
_BY_TRACKS = ("speed", "angular_speed", "jerk", "clearance", "headroom", "thirds_error", "size_error", "face")


@pytest.fixture(scope="module")
def scene() -> Scene:
    return next(iter(Troupe(2, lines=2).scenes(1, 12)))


@pytest.fixture(scope="module")
def seen(scene: Scene) -> Seen:
    shot, grid = scene.shots[0], scene.grids[0]
    about = [about_of(shot, grid, scene.filming, scene.staged)] * len(grid.cameras)
    return Camerawork("cpu").judge_frames(
        *(scene.staged, shot.style, grid.story, grid.cameras, (96, 96)),
        about=about,
        pictures=False,
        depths=True,
    )


def drawn(scene: Scene, seen: Seen) -> list[CameraProposal]:
    shot, grid = scene.shots[0], scene.grids[0]
    return as_drawn(shot, grid.story, scene.filming, scene.staged, grid.cameras, seen)


def test_pictures_tell_of_sight_and_of_nothing_else(scene: Scene, seen: Seen) -> None:
    before, after = scene.grids[0].cameras, drawn(scene, seen)
    assert [c.track for c in after] == [c.track for c in before]
    for name in _BY_TRACKS:
        assert [c.measures[name] for c in after] == pytest.approx([c.measures[name] for c in before])
    # where nothing is in the way lines and pictures say the same
    near = [
        abs(a.measures["visibility"] - b.measures["visibility"]) for a, b in zip(before, after, strict=True)
    ]
    assert np.median(near) < 0.05


def test_what_stands_before_the_lens_is_seen_in_pictures_alone(scene: Scene, seen: Seen) -> None:
    assert seen.ids is not None
    assert seen.depth is not None
    board = seen._replace(depth=np.full_like(seen.depth, 0.1), ids=np.full_like(seen.ids, -1))
    for camera in drawn(scene, board):
        assert camera.measures["foreground"] == 1.0
        assert camera.measures["visibility"] == 0.0
    with pytest.raises(ValueError, match="depths"):
        drawn(scene, Seen(seen.frames, seen.guides))


def hidden(camera: CameraProposal) -> CameraProposal:
    return replace(camera, measures=camera.measures | {"visibility": 0.0, "head_visible": 0.0})


def test_clips_are_good_or_bad_as_their_pictures_turned_out(scene: Scene) -> None:
    clips = clips_of(scene, np.random.default_rng(0))
    good = next(clip for clip in clips if clip.kind == "designer")
    bad = next(clip for clip in clips if clip.kind == "passed-over")
    fell, rose = as_seen([good, bad], [hidden(good.camera), good.camera])
    assert (fell.kind, fell.doubtful) == ("passed-over", False)
    assert fell.opinion < 0 < fell.strength
    assert (rose.kind, rose.strength, rose.opinion) == ("designer", 0.0, good.opinion)
    spoilt = next(clip for clip in clips if clip.kind == "perturbed" and clip.opinion < 0.5 * BAR)
    same, unsure = as_seen([spoilt, spoilt], [spoilt.camera, good.camera])
    assert (same.kind, same.opinion, same.doubtful) == (spoilt.kind, spoilt.opinion, spoilt.doubtful)
    assert unsure.doubtful, "nobody knows what it is"


def test_a_set_is_labelled_by_pictures(scene: Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    making = _Making(0, "cpu", 96, pictures=0.0)
    train = replace(scene, split="train")
    by_pictures = _filmed(train, making, Camerawork("cpu"))
    assert by_pictures is not None
    good = [label[0] for label in by_pictures.labels]
    assert 0 < sum(good) < len(good)

    def behind_a_board(shot, stories, filming, staged, cameras, seen):  # type: ignore[no-untyped-def]
        assert len(seen.ids) == len(cameras)
        return [hidden(camera) for camera in cameras]

    monkeypatch.setattr(dataset, "as_drawn", behind_a_board)
    boarded = _filmed(train, making, Camerawork("cpu"))
    assert boarded is not None
    assert len(boarded.labels) == len(good)
    assert not any(label[0] for label in boarded.labels)
    assert all(label[7]["opinion"] < 0 for label in boarded.labels)


def test_opinions_are_of_what_is_measured(scene: Scene, seen: Seen) -> None:
    cameras = drawn(scene, seen)
    clip = Clip(cameras[0], "designer", 0.0, 1.0, (None, None, None))
    assert as_seen([clip], cameras[:1])[0].opinion == float(judged(cameras[:1])[0])
