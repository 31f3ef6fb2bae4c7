"""What somebody has in hand over a shot, for cameras: it may hide a face as an arm does."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from runtime.world import World

from ..cinema.in_hand import Box, box_of
from ..cinema.subject import Subject
from .types import StoryProposal

#: Metres between a hand's joint and the box of a thing it holds.
_REACH = 0.12


def in_hand(one: Subject, story: StoryProposal, world: World) -> tuple[Box, ...]:
    """The movable things that a hand of somebody is at, at some time."""
    hands = [one.landmarks[name] for name in ("hand_l", "hand_r")]
    with np.errstate(invalid="ignore"):
        return tuple(
            box for box in _boxes(story, world) if any((box.away(hand) < _REACH).any() for hand in hands)
        )


@lru_cache(maxsize=16)  # asked for again for everybody, and for every camera
def _boxes(story: StoryProposal, world: World) -> tuple[Box, ...]:
    out = []
    for number, moved in story.props.items():
        item = world.objects[number]
        if item.mesh is not None and item.hinge is None:
            points = item.mesh.vertices
            low, high = points.min(axis=0).astype(float), points.max(axis=0).astype(float)
            out.append(box_of(moved, low, high))
    return tuple(out)
