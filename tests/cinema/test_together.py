"""Several people as one subject: nobody stands halfway between them, so each is looked at."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from filmset import SPAN, shot, skeleton, standing, story, world

from vdsl.cinema.covering import behind_heads
from vdsl.cinema.track import camera_axes
from vdsl.lang.ir import Target
from vdsl.propose.cameras import Filming, propose_cameras
from vdsl.propose.types import CameraProposal, ProposalGrid, StoryProposal

BODY = skeleton(1.7)
FILMING = Filming(world(), {"anna": BODY, "ben": BODY}, 24.0, 3)
ANNA, BEN = np.array((0.0, 0.5, 0.0)), np.array((0.0, -0.5, 0.0))


def pair(anna: float, ben: float, apart: float = 1.0) -> StoryProposal:
    """Anna to the left of who looks along x; the way either faces, radians."""
    acted = {"anna": (ANNA * apart, anna), "ben": (BEN * apart, ben)}
    return story(
        {n: standing(BODY, np.tile(at, (48, 1)), np.full(48, way)) for n, (at, way) in acted.items()}
    )


def two_shots(told: StoryProposal, first: str = "anna", movement: str = "static") -> ProposalGrid:
    whose = ("anna", "ben") if first == "anna" else ("ben", "anna")
    said = shot(movement, "medium", "eye-level", proposals=48)
    focus = Target("character", (first,), first, SPAN)
    return propose_cameras(replace(said, focus=focus, view="two-shot", whose=whose), [told], FILMING)


def cosine(camera: CameraProposal, at: np.ndarray, way: float) -> float:
    to = camera.track.position[0] - at - np.array((0.0, 0.0, 1.6))
    return float(np.dot(to, (np.cos(way), np.sin(way), 0.0)) / np.linalg.norm(to))


def test_a_head_behind_a_nearer_one_is_not_seen() -> None:
    """Seen from 2 m and 3 m: the far one behind the near one, beside it, and well over it."""
    depth = np.array([[[2.0, 3.0]]])
    for far, hidden in (((0.0, 0.0), True), ((0.2, 0.0), False), ((0.0, 0.3), True), ((0.0, -0.2), False)):
        xy = np.array([[[(0.0, 0.0), far]]])
        assert behind_heads(xy, depth).tolist() == [[[False, hidden]]], far
        assert not behind_heads(xy, -depth[..., ::-1] * (1, -1)).any(), (
            "who is behind the camera hides nobody"
        )


def test_a_two_shot_shows_both_at_its_first_frame_and_its_last() -> None:
    """Two who stand a metre apart: no arc begins or ends with one of them behind the other."""
    grid = two_shots(pair(0.0, 0.0), movement="arc-left")
    assert len(grid.cameras) >= 8
    assert grid.rejected["wrong_view"] > 0
    for camera in grid.cameras:
        for t in (0, -1):
            eyes = [at + np.array((0.0, 0.0, 1.6)) - camera.track.position[t] for at in (ANNA, BEN)]
            a, b = (np.arctan2(e[1], e[0]) for e in eyes)
            assert abs((a - b + np.pi) % (2 * np.pi) - np.pi) > np.radians(1.5)


@pytest.mark.parametrize("first", ["anna", "ben"])
def test_the_best_two_shot_shows_the_face_of_who_acts(first: str) -> None:
    """Both look the same way: from one side one sees two faces, from the other none."""
    cameras = two_shots(pair(0.0, 0.0), first).cameras
    best = max(cameras, key=lambda c: c.measures["geometry"])
    assert min(cosine(best, ANNA, 0.0), cosine(best, BEN, 0.0)) > -0.1
    assert min(c.measures["face"] for c in cameras) < -0.4


def test_two_who_face_each_other_are_best_from_beside() -> None:
    """Not over one's back, though the other's face is all the nearer to the camera for it."""
    cameras = two_shots(pair(-np.pi / 2, np.pi / 2)).cameras
    for c in cameras:
        turned = [cosine(c, ANNA, -np.pi / 2), cosine(c, BEN, np.pi / 2)]
        mean = 0.6 * min(turned[0], 0.3) + 0.4 * min(turned[1], 0.3)
        assert c.measures["face"] == pytest.approx((mean + 1.0) * 1.7 / 1.3 - 1.0, abs=0.08)
    best = max(cameras, key=lambda c: c.measures["geometry"])
    assert cosine(best, ANNA, -np.pi / 2) > -0.45


def test_who_is_partly_behind_the_other_is_less_seen() -> None:
    """Two close together: beside them one sees all of both, from where one stands before the other less."""
    cameras = two_shots(pair(-np.pi / 2, np.pi / 2, 0.7)).cameras
    along = [abs(c.track.position[0, 1]) / np.hypot(*c.track.position[0, :2]) for c in cameras]
    seen = np.array([c.measures["visibility"] for c in cameras])
    beside, behind = np.array(along) < 0.3, np.array(along) > 0.75
    assert beside.any()
    assert behind.any()
    assert seen[beside].min() == 1.0
    assert seen[behind].max() < 0.9


def test_a_side_of_the_frame_that_halves_one_of_them_is_seen() -> None:
    """As for one alone: whoever is cut at the first frame or the last."""
    cameras = two_shots(pair(0.0, 0.0), movement="pan-left").cameras
    cut = 0
    for c in cameras:
        axes = camera_axes(c.track.rotation[-1])
        for at in (ANNA, BEN):
            away = at + np.array((0.0, 0.0, 1.2)) - c.track.position[-1]
            x = np.array([np.dot(away + s * 0.2 * axes[0], axes[0]) for s in (-1, 1)]) / np.dot(away, axes[2])
            half = c.track.sensor[0] / (2 * c.track.focal[-1])
            if ((np.abs(x) < half).sum()) == 1:
                cut += 1
                assert c.measures["head_cropped"] > 0.0
    assert cut, "no take cuts anybody: the test says nothing"


@pytest.mark.parametrize(("ben", "shows"), [(np.pi / 2, False), (-np.pi / 2, True)])
def test_the_one_over_whose_shoulder_it_looks_shows_no_face(ben: float, shows: bool) -> None:
    """Anna faces Ben; he looks at her, or away from her and so into the camera behind him."""
    said = shot("static", "medium", "eye-level", proposals=24)
    focus = Target("character", ("anna",), "anna", SPAN)
    said = replace(said, focus=focus, view="ots", whose=("ben",))
    cameras = propose_cameras(said, [pair(-np.pi / 2, ben)], FILMING).cameras
    assert len(cameras) >= 8, "it is a fault, but there are takes"
    assert {c.measures["view"] < 0.8 for c in cameras} == {shows}
