"""Over shoulders, through eyes, two and all together: who is seen where."""

from __future__ import annotations

import numpy as np
import pytest
from filmset import SPAN, shot, skeleton, standing, story, world

from vdsl.cinema.sizes import SIZES
from vdsl.cinema.subject import person
from vdsl.cinema.track import camera_axes, project
from vdsl.lang.ir import Target
from vdsl.propose.cameras import Filming, propose_cameras
from vdsl.propose.types import CameraProposal, StoryProposal

ANNA, BEN = skeleton(1.66), skeleton(1.82)


def facing(apart: float, turn: float = 0.3, frames: int = 36) -> StoryProposal:
    """Anna at the origin, Ben ``apart`` metres from her, face to face."""
    way = np.array((np.cos(turn), np.sin(turn), 0.0))
    here, there = np.zeros((frames, 3)), np.tile(apart * way, (frames, 1))
    return story(
        {
            "anna": standing(ANNA, here, np.full(frames, turn)),
            "ben": standing(BEN, there, np.full(frames, turn + np.pi)),
        }
    )


def filmed(acted: StoryProposal, **said: object) -> tuple[CameraProposal, ...]:
    filming = Filming(world(), {"anna": ANNA, "ben": BEN}, 24.0, 5)
    focus = Target("character", ("anna",), "anna", SPAN)
    return propose_cameras(shot(focus=focus, **said), [acted], filming).cameras  # type: ignore[arg-type]


def eyes(acted: StoryProposal, name: str) -> np.ndarray:
    p, body = acted.performances[name], ANNA if name == "anna" else BEN
    return person(name, body, p.world_from_joint, p.position, p.heading).landmarks["eyes"]


def seen(c: CameraProposal, points: np.ndarray, frame: int = 0) -> tuple[np.ndarray, np.ndarray]:
    axes = camera_axes(c.track.rotation[frame])
    return project(points, c.track.position[frame], axes, c.track.focal[frame], c.track.sensor)


@pytest.mark.parametrize("scale", ["medium-close-up", "medium"])
@pytest.mark.parametrize("apart", [0.9, 1.3, 1.6])
def test_a_shoulder_stands_at_the_side_and_the_size_holds(scale: str, apart: float) -> None:
    acted = facing(apart)
    cameras = filmed(acted, scale=scale, view="ots", whose=("ben",))
    assert len(cameras) == 40
    p = acted.performances["anna"]
    marks = person("anna", ANNA, p.world_from_joint, p.position, p.heading).landmarks
    sides = set()
    for c in cameras:
        size = SIZES[scale]
        ends, _ = seen(c, np.stack([marks[size.upper][0], marks[size.lower][0]]))
        assert ends[:, 1] == pytest.approx((size.top, size.bottom), abs=0.01)
        both, depth = seen(c, np.stack([eyes(acted, "ben")[0], eyes(acted, "anna")[0]]))
        assert depth[0] < depth[1] - 0.3
        assert abs(both[0, 0] - 0.5) > 0.2
        assert (both[0, 0] - 0.5) * (both[1, 0] - 0.5) < 0
        assert c.unseen == ""
        sides.add(bool(both[0, 0] > 0.5))
    assert sides == {True, False}


def test_eyes_look_from_where_they_are_and_their_owner_is_not_drawn() -> None:
    acted = facing(1.5)
    scales = tuple(SIZES)
    cameras = filmed(acted, movements=("follow", "static"), scales=scales, view="pov", whose=("ben",))
    assert cameras
    for c in cameras:
        assert np.abs(c.track.position - eyes(acted, "ben")).max() < 1e-3
        assert c.unseen == "ben"
        xy, _ = seen(c, eyes(acted, "anna")[:1])
        assert 0.3 < xy[0, 0] < 0.7
        assert 30.0 <= c.track.focal[0] <= 80.0
        assert c.measures["size_error"] <= 0.25


@pytest.mark.parametrize(("view", "apart"), [("two-shot", 0.8), ("two-shot", 1.3), ("group", 1.3)])
def test_two_heads_are_in_the_frame(view: str, apart: float) -> None:
    acted = facing(apart)
    scales = ("medium", "cowboy", "full")
    cameras = filmed(acted, scales=scales, view=view, whose=("anna", "ben"))
    assert len(cameras) == 40
    for c in cameras:
        for frame in (0, -1):
            xy, depth = seen(c, np.stack([eyes(acted, n)[frame] for n in ("anna", "ben")]), frame)
            assert (depth > 0).all()
            assert ((xy > 0) & (xy < 1)).all()
