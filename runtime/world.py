"""A set as the engine sees it: something to draw, to bump into, to walk on and to use.

Built once per scene by whoever knows what a set is; frozen afterwards.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from .mesh import Mesh


@dataclass(frozen=True)
class Spot:
    """A named, useful place on an object or in a room, world coordinates.

    name: ``stand``, ``seat``, ``top``, ``grip`` or a name of the set's own
    position: metres; for ``stand`` on the floor where the feet go, for ``seat`` the middle of the
        seat's surface, for ``grip`` where a hand takes hold
    facing: heading in radians (0 is +X, counter-clockwise) or None where any will do
    """

    name: str
    position: tuple[float, float, float]
    facing: float | None = None


@dataclass(frozen=True, eq=False)
class Hinge:
    """How a part moves on the thing it belongs to. Coordinates are those of the part's mesh, with it closed.

    kind: ``hinge`` turns about ``axis`` [3] through ``pivot`` [3]; ``slide`` goes along ``axis``
    open: radians or metres when fully open; handle: [3], where a hand takes hold of it
    closed: [4, 4] world_from_part with it closed; owner: id of the object it is a part of
    boxes: [B, 2, 3] centres and half extents of what stands in for it, closed
    way: whether it closes an opening people pass through
    """

    kind: str
    pivot: NDArray[np.float64]
    axis: NDArray[np.float64]
    open: float
    handle: NDArray[np.float64]
    closed: NDArray[np.float64]
    owner: int
    boxes: NDArray[np.float64]
    way: bool = False

    def matrices(self, openness: NDArray[np.float64] | float) -> NDArray[np.float64]:
        """world_from_part [..., 4, 4] at openness [...], 0 closed .. 1 fully open."""
        share = np.asarray(openness, np.float64)
        local = np.zeros((*share.shape, 4, 4))
        local[..., 3, 3] = 1.0
        if self.kind == "slide":
            local[..., :3, :3] = np.eye(3)
            local[..., :3, 3] = share[..., None] * self.open * self.axis
        else:
            x, y, z = self.axis
            cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
            angle = (share * self.open)[..., None, None]
            turn = np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * (cross @ cross)
            local[..., :3, :3] = turn
            local[..., :3, 3] = self.pivot - turn @ self.pivot
        return np.asarray(self.closed @ local)

    def solids(self, openness: float) -> tuple[NDArray[np.float64], NDArray[np.float64], float]:
        """Its boxes [B, 3] centres, [B, 3] half extents and their turn about Z, at an openness."""
        moved = np.linalg.inv(self.closed) @ self.matrices(openness)
        turn = float(np.arctan2(moved[1, 0], moved[0, 0])) if abs(moved[2, 2]) > 0.999 else 0.0
        c, s = np.cos(turn), np.sin(turn)
        back = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]) @ moved[:3, :3]
        centre = self.boxes[:, 0] @ moved[:3, :3].T + moved[:3, 3]
        half = self.boxes[:, 1] @ np.abs(back).T
        centre = centre @ self.closed[:3, :3].T + self.closed[:3, 3]
        return centre, half, turn + float(np.arctan2(self.closed[1, 0], self.closed[0, 0]))


@dataclass(frozen=True, eq=False)
class WorldObject:
    """A thing in the set with a place in its tree.

    id: index in :attr:`World.objects`, and what id buffers hold
    path: names from the set's root, e.g. ``("kitchen", "table", "cup")``
    kind: the name of the prop, or ``room``, ``area``, ``stairs``, ``door``, ``window``, or ``part`` of a prop
    low, high: axis-aligned bounds in the world, metres
    mesh: for what moves its mesh in its own coordinates, else None (it is part of the static mesh)
    world_from_object: [4, 4], the placement (at rest for a movable object)
    grip: where a hand takes hold, in object coordinates, for a movable object
    hinge: how it moves, for a part that opens; ajar: how far it stands open at first, 0..1
    bearer: who has it about them, for what is nowhere to be seen until they take it out
    """

    id: int
    path: tuple[str, ...]
    kind: str
    spots: tuple[Spot, ...]
    low: tuple[float, float, float]
    high: tuple[float, float, float]
    world_from_object: NDArray[np.float64]
    mesh: Mesh | None = None
    grip: tuple[float, float, float] | None = None
    hinge: Hinge | None = None
    ajar: float = 0.0
    bearer: str = ""

    @property
    def centre(self) -> tuple[float, float, float]:
        return tuple((a + b) / 2 for a, b in zip(self.low, self.high, strict=True))  # type: ignore[return-value]

    def spot(self, name: str) -> Spot | None:
        """The first spot of that name, or None."""
        return next((s for s in self.spots if s.name == name), None)


@dataclass(frozen=True, eq=False)
class Solids:
    """Upright boxes standing in for everything solid, for collision and line of sight.

    centre: float64 [B, 3]; half: float64 [B, 3] half extents; yaw: float64 [B] turn about Z, radians
    wall: int32 [B], the wild wall the box belongs to, or -1
    object: int32 [B], id of the object it belongs to, or -1
    """

    centre: NDArray[np.float64]
    half: NDArray[np.float64]
    yaw: NDArray[np.float64]
    wall: NDArray[np.int32]
    object: NDArray[np.int32]

    @cached_property
    def turn(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Cosine and sine of the yaw, [B] each."""
        return np.cos(self.yaw), np.sin(self.yaw)

    @cached_property
    def radius(self) -> NDArray[np.float64]:
        """Of the spheres around the boxes, [B]."""
        return np.asarray(np.sqrt((self.half**2).sum(axis=1)))

    @cached_property
    def bounds(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Least and greatest corner, [B, 3] each, of the boxes turned any way about Z."""
        half = self.half.copy()
        half[:, :2] = np.sqrt((half[:, :2] ** 2).sum(axis=1))[:, None]
        return self.centre - half, self.centre + half


@dataclass(frozen=True)
class Wall:
    """A wild wall: not drawn, and not in the way, when it stands between camera and subject.

    low, high: end points of its foot on the floor (x, y); height in metres, from ``base`` up
    """

    low: tuple[float, float]
    high: tuple[float, float]
    height: float
    base: float = 0.0


Rect = tuple[float, float, float, float]


@dataclass(frozen=True)
class Level:
    """Floors at one height. floors: walkable rectangles (x0, y0, x1, y1), metres."""

    height: float
    floors: tuple[Rect, ...]


@dataclass(frozen=True)
class Stairs:
    """A straight flight. low: middle of the foot of its first riser; high: middle of the edge of the floor it
    leads to; ``steps`` risers of equal height, ``steps - 1`` treads between them."""

    low: tuple[float, float, float]
    high: tuple[float, float, float]
    width: float
    steps: int
    ahead: tuple[float, float]

    @property
    def rise(self) -> float:
        return (self.high[2] - self.low[2]) / self.steps

    @property
    def run(self) -> float:
        """Depth of a tread, metres."""
        length = float(np.hypot(self.high[0] - self.low[0], self.high[1] - self.low[1]))
        return length / max(self.steps - 1, 1)


@dataclass(frozen=True)
class Light:
    """Light of a scene; colours are linear RGB.

    sun: unit vector towards the key light; sun_color: its radiance; shadow: 0 none .. 1 black
    sky, ground: hemispheric ambient from above and below
    backdrop: (horizon, zenith) colours behind everything, sRGB 0..1
    windows: how much the sun lightens what it falls on through windows, indoors
    lamps: how far what glows is turned up and lights its surroundings: 0 is off, 1 lamps at night
    """

    sun: tuple[float, float, float]
    sun_color: tuple[float, float, float]
    sky: tuple[float, float, float]
    ground: tuple[float, float, float]
    backdrop: tuple[tuple[float, float, float], tuple[float, float, float]]
    lamps: float = 0.0
    windows: float = 0.0


@dataclass(frozen=True, eq=False)
class World:
    """A built set.

    mesh: everything that never moves, world coordinates
    mesh_object: int32 [F], object id of each face; mesh_wall: int32 [F], wild wall of each face, -1 for none,
        or -2 for faces seen from their front only (ceilings, so that a camera may look in from above)
    floors: walkable rectangles (x0, y0, x1, y1) in metres, joined where they touch or through door gaps;
        those of all levels
    levels: the same floors by height, lowest first; stairs: what joins them
    """

    name: str
    mesh: Mesh
    mesh_object: NDArray[np.int32]
    mesh_wall: NDArray[np.int32]
    objects: tuple[WorldObject, ...]
    solids: Solids
    walls: tuple[Wall, ...]
    floors: tuple[Rect, ...]
    light: Light
    outdoor: bool
    levels: tuple[Level, ...] = ()
    stairs: tuple[Stairs, ...] = ()

    @cached_property
    def wall_ends(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Where its wild walls begin and where they end on the floor plan, [W, 2] each."""
        low, high = ([getattr(wall, end) for wall in self.walls] for end in ("low", "high"))
        return np.array(low, float).reshape(-1, 2), np.array(high, float).reshape(-1, 2)

    @property
    def storeys(self) -> tuple[Level, ...]:
        """Its levels; all floors at 0 where none are given."""
        return self.levels or (Level(0.0, self.floors),)

    def opened(self, openness: Mapping[int, float]) -> World:
        """The same world with parts standing open as far as said, by object id; itself where nothing moves.

        Placement, bounds, spots and solids follow, also the spots a part lends to its owner.
        """
        moved = {
            k: share
            for k, share in openness.items()
            if self.objects[k].hinge is not None and abs(share - self.objects[k].ajar) > 1e-6
        }
        if not moved:
            return self
        objects = list(self.objects)
        centre, half, yaw = (a.copy() for a in (self.solids.centre, self.solids.half, self.solids.yaw))
        for k, share in moved.items():
            part, hinge = objects[k], objects[k].hinge
            assert hinge is not None
            matrix = hinge.matrices(share)
            shift = matrix @ np.linalg.inv(part.world_from_object)
            turn = float(np.arctan2(shift[1, 0], shift[0, 0]))
            spots = {s: _moved(s, shift, turn) for s in part.spots}
            rows = np.flatnonzero(self.solids.object == k)
            if len(rows):
                centre[rows], half[rows], yaw[rows] = hinge.solids(share)
            low, high = _bounds(part, matrix)
            named = tuple(spots.values())
            objects[k] = replace(part, spots=named, low=low, high=high, world_from_object=matrix, ajar=share)
            owner = objects[hinge.owner]
            lent = tuple(spots.get(s, s) for s in owner.spots)
            objects[hinge.owner] = replace(owner, spots=lent)
        solids = Solids(centre, half, yaw, self.solids.wall, self.solids.object)
        return replace(self, objects=tuple(objects), solids=solids)


def _moved(spot: Spot, shift: NDArray[np.float64], turn: float) -> Spot:
    x, y, z = (shift @ np.array([*spot.position, 1.0]))[:3].tolist()
    return Spot(spot.name, (x, y, z), None if spot.facing is None else spot.facing + turn)


def _bounds(
    part: WorldObject, matrix: NDArray[np.float64]
) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
    assert part.mesh is not None
    points = part.mesh.vertices @ matrix[:3, :3].T + matrix[:3, 3]
    (a, b, c), (d, e, f) = points.min(0).tolist(), points.max(0).tolist()
    return (a, b, c), (d, e, f)
