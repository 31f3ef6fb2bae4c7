"""Where one stands with one's back against something: a wall, a tree, a counter.

Assumes a world with solid boxes. Guarantees a place that can be walked to, turned away from a side of what is
leant against, with room ahead.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from runtime.nav import BODY_RADIUS, Discs, grid_of, level_at, reachable
from runtime.world import World

from ..lang.ir import Target
from .cameras import find_object
from .places import Stop
from .state import SceneState

Array = NDArray[np.float64]

_WALL, _SUPPORT = 1.7, 0.6  # metres over the floor that a wall, and that a thing one names, has to reach
_BELOW = 0.35  # metres over the floor from which it may begin
_BROAD = 0.8  # metres that a wall is long at least
_EVERY, _MARGIN = 0.4, 0.5  # metres between the places that are looked at, and off the ends together
_AHEAD, _ROOM = 0.7, 0.2  # metres in front, and how much free floor is to be about that
_FARTHEST = 15.0  # metres off, for a wall nobody names
_TRIES = 40  # places that are asked whether one gets there


@dataclass(frozen=True)
class _Sides:
    """Upright sides of boxes: middle [S, 2] of each, outward normal [S, 2], length [S]."""

    middle: Array
    normal: Array
    length: Array


def stop_against(
    target: Target | None, state: SceneState, who: str, taken: Discs, away: float
) -> Stop | None:
    """The nearest place with a support behind one's back; None where there is none.

    target: what is leant against, None for the nearest wall; taken: places others are about to stand at
    away: metres from the support to the middle of the feet
    """
    world, actor = state.world, state.actors[who]
    x, y, z = actor.position
    item = None if target is None else find_object(world, target)
    if target is not None and (item is None or item.kind in ("room", "area")):
        target = None
    sides = _sides(world, z, None if item is None or target is None else item.id)
    places, headings = _along(sides, away)
    if not len(places):
        return None
    people = state.people(but=who) + taken
    grid = grid_of(world, level_at(world, (x, y, z))).with_people(people)
    ahead = places + _AHEAD * np.stack([np.cos(headings), np.sin(headings)], axis=1)
    free = grid.clearance_at(places) >= 0.8 * min(BODY_RADIUS, away)
    free &= grid.clearance_at(ahead) >= _ROOM
    far = np.hypot(*(places - (x, y)).T)
    if target is None:
        free &= far < _FARTHEST
    tried = np.flatnonzero(free)
    for k in tried[np.argsort(far[tried], kind="stable")][:_TRIES]:
        px, py = (float(v) for v in places[k])
        if reachable(world, (x, y, z), (px, py, z), people):
            return Stop(px, py, float(headings[k]), z)
    return None


def _sides(world: World, floor: float, thing: int | None) -> _Sides:
    """The sides of what supports a back: of one thing, or of all walls and houses."""
    solids = world.solids
    bottom, top = (solids.centre[:, 2] + sign * solids.half[:, 2] - floor for sign in (-1, 1))
    parts = {item.id for item in world.objects if item.hinge is not None or item.mesh is not None}
    if thing is None:
        of_it = ~np.isin(solids.object, list(parts))
    else:
        own = [o.id for o in world.objects if o.hinge is not None and o.hinge.owner == thing]
        of_it = np.isin(solids.object, [thing, *own])
    rows = np.flatnonzero(of_it & (bottom < _BELOW) & (top > (_WALL if thing is None else _SUPPORT)))
    half, yaw = solids.half[rows], solids.yaw[rows]
    along = np.stack([np.cos(yaw), np.sin(yaw)], axis=1)
    across = np.stack([-along[:, 1], along[:, 0]], axis=1)
    middle, normal, length = [], [], []
    for axis, deep, wide in ((along, half[:, 0], half[:, 1]), (across, half[:, 1], half[:, 0])):
        for sign in (1.0, -1.0):
            normal.append(sign * axis)
            middle.append(solids.centre[rows, :2] + sign * axis * deep[:, None])
            length.append(2.0 * wide)
    sides = _Sides(np.concatenate(middle), np.concatenate(normal), np.concatenate(length))
    broad = sides.length >= (_BROAD if thing is None else 0.0)
    return _Sides(sides.middle[broad], sides.normal[broad], sides.length[broad])


def _along(sides: _Sides, away: float) -> tuple[Array, Array]:
    """Places [P, 2] before the sides, and headings [P] away from them."""
    places, headings = [], []
    for middle, normal, length in zip(sides.middle, sides.normal, sides.length, strict=True):
        count = int(max(length - _MARGIN, 0.0) / _EVERY) + 1
        at = (np.arange(count) - (count - 1) / 2) * _EVERY
        beside = np.array((-normal[1], normal[0]))
        places.append(middle + away * normal + at[:, None] * beside)
        headings.append(np.full(len(at), math.atan2(normal[1], normal[0])))
    if not places:
        return np.zeros((0, 2)), np.zeros(0)
    return np.concatenate(places), np.concatenate(headings)
