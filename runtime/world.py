"""A set as the engine sees it: something to draw, to bump into, to walk on and to use.

Built once per scene by whoever knows what a set is; frozen afterwards.
"""

from __future__ import annotations

from dataclasses import dataclass

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
class WorldObject:
    """A thing in the set with a place in its tree.

    id: index in :attr:`World.objects`, and what id buffers hold
    path: names from the set's root, e.g. ``("kitchen", "table", "cup")``
    kind: the name of the prop, or ``room`` / ``area`` / ``wall`` / ``door`` / ``window``
    low, high: axis-aligned bounds in the world, metres
    mesh: for a movable object its mesh in its own coordinates, else None (it is part of the static mesh)
    world_from_object: [4, 4], the placement (at rest for a movable object)
    grip: where a hand takes hold, in object coordinates, for a movable object
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


@dataclass(frozen=True)
class Wall:
    """A wild wall: not drawn, and not in the way, when it stands between camera and subject.

    low, high: end points of its foot on the floor (x, y); height in metres
    """

    low: tuple[float, float]
    high: tuple[float, float]
    height: float


@dataclass(frozen=True)
class Light:
    """Light of a scene; colours are linear RGB.

    sun: unit vector towards the key light; sun_color: its radiance; shadow: 0 none .. 1 black
    sky, ground: hemispheric ambient from above and below
    backdrop: (horizon, zenith) colours behind everything, sRGB 0..1
    """

    sun: tuple[float, float, float]
    sun_color: tuple[float, float, float]
    sky: tuple[float, float, float]
    ground: tuple[float, float, float]
    backdrop: tuple[tuple[float, float, float], tuple[float, float, float]]


@dataclass(frozen=True, eq=False)
class World:
    """A built set.

    mesh: everything that never moves, world coordinates
    mesh_object: int32 [F], object id of each face; mesh_wall: int32 [F], wild wall of each face, -1 for none,
        or -2 for faces seen from their front only (ceilings, so that a camera may look in from above)
    floors: walkable rectangles (x0, y0, x1, y1) in metres, joined where they touch or through door gaps
    """

    name: str
    mesh: Mesh
    mesh_object: NDArray[np.int32]
    mesh_wall: NDArray[np.int32]
    objects: tuple[WorldObject, ...]
    solids: Solids
    walls: tuple[Wall, ...]
    floors: tuple[tuple[float, float, float, float], ...]
    light: Light
    outdoor: bool
