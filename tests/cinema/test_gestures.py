"""Hands at work are to be seen: in the frame, and not behind the body they belong to."""

from __future__ import annotations

import numpy as np

from vdsl.cinema.gestures import _apart
from vdsl.pipeline.compile import Act
from vdsl.pipeline.trial import stage_script
from vdsl.propose.cameras import propose_cameras
from vdsl.propose.story import tell
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
