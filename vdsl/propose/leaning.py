"""Where one stands, or sits down, with one's back against something: a wall, a tree, a counter.

Assumes a world with solid boxes. Guarantees a place that can be walked to, turned away from a side of what is
leant against, with nothing and nobody between the two, and room ahead.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from runtime.motion.types import ActionClip
from runtime.nav import BODY_RADIUS, Discs, grid_of, level_at, reachable
from runtime.world import Solids, World, WorldObject

from ..lang.ir import Target
from .cameras import find_object
from .places import Stop
from .state import SceneState, floor_under

Array = NDArray[np.float64]

_WALL = 1.7  # metres over the floor that a wall reaches
_BACK, _SEATED_BACK = (
    0.6,
    0.3,
)  # that a named thing has to reach, for who stands and for who sits on the floor
_BELOW = 0.5  # metres over the floor from which what one leans against may begin
_THIN = 0.08  # metres that a thing is deep at least
_BROAD, _HOUSE = 0.8, (2.0, 2.2)  # how long a wall is at least; how wide and high what stands outdoors
_EVERY, _MARGIN = 0.4, 0.5  # metres between the places that are looked at, and off the ends together
_AHEAD, _ROOM = 0.8, 0.15  # metres before what is leant against, and how much free floor is about that
_SHOULDERS = 0.2  # half of the width in which nothing may be between feet and back
_FARTHEST = 15.0  # metres off, for a wall nobody names
_BESIDE = 1.3  # metres from what hangs on a wall, or is let into it, to where one leans
_TRIES = 40  # places that are asked whether one gets there


@dataclass(frozen=True, eq=False)
class _Sides:
    """Upright sides: middle [S, 2] of each, outward normal [S, 2], length [S].

    own [B]: which solid boxes are what they are the sides of
    """

    middle: Array
    normal: Array
    length: Array
    own: NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class _Spots:
    """Places before sides: feet [P, 2], heading [P], and where the back is [P, 2]."""

    feet: Array
    heading: Array
    back: Array


def stop_against(
    target: Target | None, state: SceneState, who: str, taken: Discs, clip: ActionClip
) -> Stop | None:
    """The nearest place with a support behind one's back; None where there is none.

    target: what is leant against, None for the nearest wall; taken: places others are about to stand at
    clip: ``against`` of it is how far from the support the middle of the feet is, metres
    """
    world, actor = state.world, state.actors[who]
    here = actor.position
    item = None if target is None else find_object(world, target)
    if item is not None and item.kind in ("room", "area"):
        item = None
    floor = here[2] if item is None else floor_under(world, (*item.centre[:2], item.low[2]))
    goal, reach = here, _FARTHEST if item is None else math.inf
    low = _SEATED_BACK if clip.posture == "floor" else _BACK
    sides = _walls(world, floor) if item is None else _sides_of(item, world, floor, low)
    if item is not None and not len(sides.length):  # it hangs on a wall, or is let into it
        own, goal, reach = sides.own, item.centre, _BESIDE
        sides = _walls(world, floor, _BACK)
        sides = replace(sides, own=sides.own | own)
    spots = _along(sides, clip.against)
    people = state.people(but=who) + taken
    free = _free(spots, sides.own, world, floor, people, clip.against)
    far = np.hypot(*(spots.feet - goal[:2]).T)
    free &= far < reach
    elsewhere = ~_in_room(spots.feet, here, world) if item is None else np.zeros(len(far), bool)
    tried = np.flatnonzero(free)
    order = np.lexsort((far[tried], elsewhere[tried]))
    for k in tried[order][:_TRIES]:
        x, y = (float(v) for v in spots.feet[k])
        if reachable(world, here, (x, y, floor), people):
            return Stop(x, y, float(spots.heading[k]), floor)
    return None


def _walls(world: World, floor: float, least: float = _WALL) -> _Sides:
    """The sides of walls of rooms, and outdoors of houses. least: metres they reach over the floor"""
    solids = world.solids
    built = [o.id for o in world.objects if o.kind in ("room", "area")]
    wide = 2.0 * np.max(solids.half[:, :2], axis=1)
    high = solids.centre[:, 2] + solids.half[:, 2] - floor
    fixed = [o.id for o in world.objects if o.hinge is None and o.mesh is None]
    house = np.isin(solids.object, fixed) & (wide > _HOUSE[0]) & (high > _HOUSE[1])
    wall = np.isin(solids.object, built) | (solids.object < 0) | house
    sides = _of_boxes(solids, np.flatnonzero(wall & _upright(solids, floor, least)), wall)
    broad = sides.length >= _BROAD
    return _Sides(sides.middle[broad], sides.normal[broad], sides.length[broad], wall)


def _sides_of(item: WorldObject, world: World, floor: float, least: float) -> _Sides:
    """The sides of one thing; none of what does not stand on the floor."""
    solids = world.solids
    parts = [o.id for o in world.objects if o.hinge is not None and o.hinge.owner == item.id]
    own = np.isin(solids.object, [item.id, *parts])
    rows = np.flatnonzero(own & _upright(solids, floor, least))
    low, high = np.array(item.low), np.array(item.high)
    stands = low[2] - floor < _BELOW and high[2] - floor > least and min(high[:2] - low[:2]) > _THIN
    if len(rows) or not stands:
        return _of_boxes(solids, rows, own)
    (x, y), (a, b) = (low[:2] + high[:2]) / 2, (high[:2] - low[:2]) / 2
    normal = np.array([(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)])
    return _Sides((x, y) + normal * (a, b), normal, 2.0 * np.array([b, b, a, a]), own)


def _upright(solids: Solids, floor: float, least: float) -> NDArray[np.bool_]:
    """Which boxes begin near the floor and reach so far over it."""
    bottom, top = (solids.centre[:, 2] + sign * solids.half[:, 2] - floor for sign in (-1, 1))
    return np.asarray((bottom < _BELOW) & (top > least))


def _of_boxes(solids: Solids, rows: NDArray[np.int64], own: NDArray[np.bool_]) -> _Sides:
    half, yaw = solids.half[rows], solids.yaw[rows]
    along = np.stack([np.cos(yaw), np.sin(yaw)], axis=1)
    across = np.stack([-along[:, 1], along[:, 0]], axis=1)
    middle, normal, length = [], [], []
    for axis, deep, wide in ((along, half[:, 0], half[:, 1]), (across, half[:, 1], half[:, 0])):
        for sign in (1.0, -1.0):
            normal.append(sign * axis)
            middle.append(solids.centre[rows, :2] + sign * axis * deep[:, None])
            length.append(2.0 * wide)
    return _Sides(np.concatenate(middle), np.concatenate(normal), np.concatenate(length), own)


def _along(sides: _Sides, away: float) -> _Spots:
    """Places before the sides, every :data:`_EVERY` metres along them."""
    backs, normals = [np.zeros((0, 2))], [np.zeros((0, 2))]
    for middle, normal, length in zip(sides.middle, sides.normal, sides.length, strict=True):
        count = int(max(length - _MARGIN, 0.0) / _EVERY) + 1
        at = (np.arange(count) - (count - 1) / 2) * _EVERY
        backs.append(middle + at[:, None] * np.array((-normal[1], normal[0])))
        normals.append(np.tile(normal, (count, 1)))
    back, normal = np.concatenate(backs), np.concatenate(normals)
    return _Spots(back + away * normal, np.arctan2(normal[:, 1], normal[:, 0]), back)


def _free(
    spots: _Spots, own: NDArray[np.bool_], world: World, floor: float, people: Discs, away: float
) -> NDArray[np.bool_]:
    """Where feet have room, there is some ahead, and nothing and nobody is between feet and back."""
    grid = grid_of(world, level_at(world, (*spots.feet[0], floor)) if len(spots.feet) else 0)
    ahead = np.stack([np.cos(spots.heading), np.sin(spots.heading)], axis=1)
    free = grid.clearance_at(spots.feet) >= 0.55 * min(BODY_RADIUS, away)
    free &= grid.clearance_at(spots.back + max(_AHEAD, away) * ahead) >= _ROOM
    for x, y, radius, *_ in people:
        t = np.clip(np.sum(((x, y) - spots.back) * ahead, axis=1), 0.0, away)
        gap = np.hypot(*(spots.back + t[:, None] * ahead - (x, y)).T)
        free &= gap > radius + _SHOULDERS
    for k in np.flatnonzero(free):
        free[k] = not _blocked(spots.back[k], ahead[k], own, world.solids, floor, away)
    return np.asarray(free)


def _blocked(
    back: Array, ahead: Array, own: NDArray[np.bool_], solids: Solids, floor: float, away: float
) -> bool:
    """Whether a box other than the support reaches into where a body will be."""
    aside = np.array((-ahead[1], ahead[0]))
    points = np.array([
        back + t * ahead + s * aside
        for t in np.arange(0.08, away, 0.08) for s in (-_SHOULDERS, 0.0, _SHOULDERS)
    ])  # fmt: skip
    bottom, top = (solids.centre[:, 2] + sign * solids.half[:, 2] - floor for sign in (-1, 1))
    near = (top > 0.1) & (bottom < 1.5) & ~own
    reach = np.hypot(solids.half[:, 0], solids.half[:, 1]) + away
    near &= np.hypot(*(solids.centre[:, :2] - back).T) < reach
    if not near.any():
        return False
    d = points[:, None] - solids.centre[near, :2]
    c, s = np.cos(solids.yaw[near]), np.sin(solids.yaw[near])
    u, v = c * d[..., 0] + s * d[..., 1], c * d[..., 1] - s * d[..., 0]
    return bool(((np.abs(u) < solids.half[near, 0]) & (np.abs(v) < solids.half[near, 1])).any())


def _in_room(places: Array, here: tuple[float, ...], world: World) -> NDArray[np.bool_]:
    """Which places [P, 2] are in the room that somebody is in; all of them where they are in none."""
    inside = np.ones(len(places), bool)
    for item in world.objects:
        low, high = item.low, item.high
        if item.kind == "room" and low[0] < here[0] < high[0] and low[1] < here[1] < high[1]:
            inside = np.all((places > low[:2]) & (places < high[:2]), axis=1)
    return inside
