"""The best three of several rankers, side by side."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from filmset import shot, skeleton, standing, story, world
from PIL import Image

from ranker.weights import SHIPPED
from vdsl.pipeline.beside import beside, spread
from vdsl.propose.cameras import Filming, propose_cameras
from vdsl.propose.types import CameraProposal


def turned(camera: CameraProposal, degrees: float) -> CameraProposal:
    rotation = camera.track.rotation.copy()
    rotation[:, 2] += np.radians(degrees)
    return replace(camera, track=replace(camera.track, rotation=rotation))


def test_takes_are_as_far_apart_as_they_look() -> None:
    body = skeleton(1.7)
    told = story({"anna": standing(body, np.zeros((24, 3)), np.zeros(24), 0.0)})
    filming = Filming(world(), {"anna": body}, 24.0, 3)
    (camera,) = propose_cameras(shot("static", "medium", "eye-level", proposals=1), [told], filming).cameras
    assert spread([camera]) == 0.0
    assert spread([camera, camera]) == pytest.approx(0.0, abs=1e-3)
    assert spread([camera, turned(camera, 90.0)]) == pytest.approx(90.0, abs=6.0)
    assert spread([camera, turned(camera, 30.0), turned(camera, 60.0)]) == pytest.approx(40.0, abs=2.0)


@pytest.mark.slow
def test_two_rankers_are_drawn_below_each_other(tmp_path: Path) -> None:
    """The same weights under two names agree in everything."""
    told = beside(tmp_path / "both.png", {"one": SHIPPED, "other": SHIPPED}, 1, proposals=10)
    assert told["one"] == told["other"]
    assert told["one"]["lines"] == 1
    assert 0.0 <= told["one"]["faultless_share"] <= 1.0
    assert json.loads((tmp_path / "both.json").read_text("utf-8")) == told
    picture = np.asarray(Image.open(tmp_path / "both.png"))
    first, second = picture[14:131], picture[177:294]  # a row, and that below it
    np.testing.assert_array_equal(first, second)
    assert first.std() > 10
