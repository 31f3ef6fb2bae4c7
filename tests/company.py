"""Two people, of whom one is filmed: takes of them, for tests of who is in the picture and how."""

from __future__ import annotations

import numpy as np
from filmset import skeleton, standing, story, world

from vdsl.cinema.sizes import size_of
from vdsl.cinema.takes import SAMPLES, Takes
from vdsl.cinema.track import CameraTrack, look_at_rotation
from vdsl.propose.cameras import Filming
from vdsl.propose.types import StoryProposal

BODY, FRAMES = skeleton(1.7), 24
FILMING = Filming(world(), {"anna": BODY, "ben": BODY}, 24.0, 3)


def two(ben: tuple[float, float], facing: float = 0.0) -> StoryProposal:
    """Anna at the origin looks along x; Ben stands somewhere."""
    places = {"anna": ((0.0, 0.0), 0.0), "ben": (ben, facing)}
    acted = {}
    for name, (at, way) in places.items():
        acted[name] = standing(BODY, np.tile((*at, 0.0), (FRAMES, 1)), np.full(FRAMES, way))
    return story(acted)


def takes_of(
    scale: str, kind: str, eye: tuple[float, float, float], aim: tuple[float, float, float]
) -> Takes:
    at, to = (np.tile(p, (1, FRAMES, 1)).astype(float) for p in (eye, aim))
    track = CameraTrack(at, look_at_rotation(at, to, 0.0), np.full((1, FRAMES), 35.0), to, (36.0, 20.25))
    window, key = np.ones((1, SAMPLES), bool), np.zeros(1, np.int64)
    return Takes(track, (size_of(kind, scale),), window, key, 0.0, False, ())
