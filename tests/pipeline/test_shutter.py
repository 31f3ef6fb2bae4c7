"""Motion blur: when the shutter is open, how many moments a frame needs, and what they add up to."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from runtime.raster.types import Camera
from vdsl.pipeline.filming import Camerawork
from vdsl.pipeline.options import Options
from vdsl.pipeline.shutter import (
    between,
    camera_between,
    exposed_frames,
    mean_light,
    moments_needed,
    open_moments,
)
from vdsl.pipeline.trial import stage_script
from vdsl.propose.cameras import propose_cameras
from vdsl.propose.story import tell

SIZE = (320, 180)
NOBODY = np.zeros((2, 0, 3))


def turned(degrees: float) -> Camera:
    """A camera at the origin that looks north, then turned to the west by so much."""
    axes = []
    for angle in np.radians([0.0, degrees]):
        forward = np.array([-np.sin(angle), np.cos(angle), 0.0])
        axes.append([np.cross(forward, (0, 0, 1)), (0, 0, 1), forward])
    focal = np.full(2, 35, np.float32)
    return Camera(np.zeros((2, 3), np.float32), np.array(axes, np.float32), focal, (36, 20.25))


def test_the_shutter_is_open_around_the_frame() -> None:
    """Half of a frame's time at 180 degrees, and never before the take or after it."""
    at = open_moments(5, 180.0, 4, 10)
    assert at.mean() == pytest.approx(5.0)
    assert np.allclose(np.diff(at), 0.125)
    assert open_moments(0, 180.0, 4, 10).min() == 0.0
    assert open_moments(9, 360.0, 4, 10).max() == 9.0


def test_a_camera_between_two_frames_is_a_camera() -> None:
    """It looks half-way, and its axes stay unit and upright to each other, up where it was."""
    half = camera_between(turned(20.0), np.array([0.5]))
    assert np.allclose(half.axes[0] @ half.axes[0].T, np.eye(3), atol=1e-5)
    assert np.degrees(np.arctan2(-half.axes[0, 2, 0], half.axes[0, 2, 1])) == pytest.approx(10.0, abs=0.1)
    assert half.axes[0, 1, 2] > 0.99


def test_the_faster_the_more_moments() -> None:
    """None more where nothing moves; for a pan by as many pixels as it passes; at most 24."""
    needed = [moments_needed(turned(d), NOBODY, SIZE) for d in (0.0, 1.0, 5.0, 80.0)]
    assert needed[0] == 1
    assert needed[0] < needed[1] < needed[2] < needed[3] == 24
    walker = np.array([[[0.0, 3.0, 0.0]], [[0.2, 3.0, 0.0]]])
    assert 3 < moments_needed(turned(0.0), walker, SIZE) < 12
    assert moments_needed(turned(0.0), walker - (0.0, 9.0, 0.0), SIZE) == 1  # behind the camera


def test_light_is_what_is_averaged() -> None:
    """Black and white make the grey of half the light, 188, not 128; one picture stays as it is."""
    black, white = np.zeros((2, 3, 3), np.uint8), np.full((2, 3, 3), 255, np.uint8)
    assert (mean_light(np.stack([black, white])) == 188).all()
    every = np.arange(256, dtype=np.uint8).reshape(1, 16, 16)[..., None].repeat(3, -1)
    assert (np.abs(mean_light(every.repeat(5, 0)).astype(int) - every[0]) <= 1).all()


def test_frames_are_drawn_at_the_moments_they_need() -> None:
    """A frame at rest once, at its own time; a moving one at as many as it needs."""
    asked: list[NDArray[np.float64]] = []

    def draw(at: NDArray[np.float64]) -> NDArray[np.uint8]:
        asked.append(at)
        return np.zeros((len(at), 2, 2, 3), np.uint8)

    got = exposed_frames(np.array([3, 4]), 9, 180.0, lambda ends: 1 if ends[0] < 3 else 6, draw)
    assert got.shape == (2, 2, 2, 3)
    assert asked[0].tolist() == [3.0]
    assert len(asked[1]) == 6
    assert between(np.arange(9.0), asked[1]).tolist() == asked[1].tolist()


def test_a_wave_is_blurred_and_what_is_still_is_not() -> None:
    """A take with a shutter differs from one without where somebody moves, and only there."""
    script = 'storyboard "t"\ncharacter anna = woman\ncharacter ben = man\nscene s = cafe at day\n'
    script += "anna at middle facing ben\nben at queue facing anna\n"
    act = stage_script(script + "(anna wave ben) / (static medium eye-level)\n", "t", line=-1)
    shot = act.line.shots[0]
    told = tell(act.state, act.line, act.filming, shot=shot)
    camera = propose_cameras(shot, told.proposals, act.filming).cameras[0]
    story = replace(next(s for s in told.proposals if s.index == camera.story))
    work = Camerawork("cpu")
    frame = story.frames // 2
    sharp = next_frame(work, act.staged, story, camera, frame, 0.0)
    smeared = next_frame(work, act.staged, story, camera, frame, 180.0)
    differs = (np.abs(sharp.astype(int) - smeared) > 8).any(axis=-1)
    assert 0.002 < differs.mean() < 0.4
    assert (sharp == smeared).all(axis=-1).mean() > 0.5


def next_frame(work, staged, story, camera, frame: int, shutter: float) -> NDArray[np.uint8]:  # type: ignore[no-untyped-def]
    """One frame of a take."""
    frames = work.take_frames(staged, "board", story, camera, SIZE, shutter)
    return next(picture for k, picture in enumerate(frames) if k == frame)


@pytest.mark.parametrize("angle", [-1.0, 361.0, float("nan")])
def test_an_angle_that_no_shutter_has_is_refused(angle: float) -> None:
    with pytest.raises(ValueError, match="shutter: expected degrees from 0"):
        Options(shutter=angle)
