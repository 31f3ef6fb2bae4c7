"""``rig paper`` recomputed from a take's params and the subject's positions alone.

Nothing of ``vdsl.cinema`` is imported: the equations stand here a second time, written from the paper
(section 3.2) and docs/cinema.md, and the tracks must equal them to 1e-6.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from filmset import shot, skeleton, standing, story, world
from numpy.typing import NDArray
from paper_equations import recomputed

from vdsl.lang.ir import ANGLES, MOVEMENTS
from vdsl.propose.cameras import Filming, propose_cameras
from vdsl.propose.types import CameraProposal

HEIGHT = 1.73


def takes(
    movement: str, angle: str, scale: str, seed: int
) -> tuple[tuple[CameraProposal, ...], NDArray[np.float64]]:
    rng = np.random.default_rng([seed, len(movement)])
    frames = int(rng.integers(24, 60))
    t = np.linspace(0, 1, frames)[:, None]
    way = rng.normal(scale=0.5, size=3) * t + rng.normal(scale=0.1, size=3) * np.sin(3 * t)
    path = way * (1, 1, 0) + rng.normal(size=3) * (3, 3, 0)
    body = skeleton(HEIGHT)
    acted = story({"anna": standing(body, path, rng.uniform(-3, 3) + 0.4 * t[:, 0])})
    filming = Filming(world(), {"anna": body}, 24.0, seed, rig="paper")
    return propose_cameras(shot(movement, scale, angle, roll=0.1 * seed), [acted], filming).cameras, path


@pytest.mark.parametrize("angle", ANGLES)
@pytest.mark.parametrize("movement", MOVEMENTS)
def test_tracks_equal_the_equations(movement: str, angle: str) -> None:
    checked = 0
    for seed, scale in enumerate(("close-up", "medium", "full")):
        cameras, path = takes(movement, angle, scale, seed)
        for camera in cameras:
            position, rotation, focal = recomputed(camera.movement, camera.params, path)
            np.testing.assert_allclose(camera.track.position, position, atol=1e-6)
            np.testing.assert_allclose(camera.track.focal, focal, atol=1e-6)
            turned = camera.track.rotation - rotation
            turned[:, 2] -= 2 * np.pi * np.round(turned[:, 2] / (2 * np.pi))
            np.testing.assert_allclose(turned, 0.0, atol=1e-6)
            checked += 1
    assert checked >= 30


@pytest.mark.parametrize(("scale", "share"), [("close-up", 0.2), ("medium", 0.5), ("full", 1.0)])
def test_distances_and_angles_are_as_printed(scale: str, share: float) -> None:
    for angle, theta in (
        ("eye-level", math.pi / 2),
        ("high-angle", 2 * math.pi / 5),
        ("low-angle", 4 * math.pi / 5),
    ):
        cameras, _ = takes("static", angle, scale, 0)
        assert cameras
        for camera in cameras:
            assert camera.params["theta"] == pytest.approx(theta)
            assert camera.params["r"] == pytest.approx(share * HEIGHT)
            assert camera.track.focal[0] == pytest.approx(50.0)
            assert camera.track.sensor[1] == 50.0
