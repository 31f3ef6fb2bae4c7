"""A world while it is being put together: its objects, meshes, solids and floors, in the order they come.

Guarantees that every object's id is its place in :attr:`Pieces.objects`, that every face has an owner, and
that no two things share a part number, so that a line is drawn between them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from runtime.mesh import Mesh, join
from runtime.world import Hinge, Level, Rect, Solids, Spot, Stairs, WorldObject

from ..lang.definitions.prop import PropSpot
from .flush import HAIR, told_apart

#: Metres by which a thing is sunk that is flush with a later one: other than by which parts of props are, so
#: that both do not come to lie in one plane.
_HAIR = 0.7 * HAIR
Matrix = NDArray[np.float64]
Vector = tuple[float, float, float]


@dataclass(frozen=True)
class _Solid:
    centre: Vector
    half: Vector
    yaw: float
    wall: int
    object: int


@dataclass
class Pieces:
    """Collects the pieces of one world. ``floors``: rectangles by their height."""

    objects: list[WorldObject] = field(default_factory=list)
    stairs: list[Stairs] = field(default_factory=list)
    floors: dict[float, list[Rect]] = field(default_factory=dict)
    _meshes: list[Mesh] = field(default_factory=list)
    _owners: list[NDArray[np.int32]] = field(default_factory=list)
    _walls: list[NDArray[np.int32]] = field(default_factory=list)
    _solids: list[_Solid] = field(default_factory=list)
    _parts: int = 0

    def add_object(
        self, path: tuple[str, ...], kind: str, spots: tuple[Spot, ...], bounds: tuple[Vector, Vector],
        matrix: Matrix, mesh: Mesh | None = None, grip: Vector | None = None, hinge: Hinge | None = None,
        ajar: float = 0.0,
    ) -> WorldObject:  # fmt: skip
        """An object of the world (see :class:`WorldObject`), with the next id."""
        item = WorldObject(len(self.objects), path, kind, spots, *bounds, matrix, mesh, grip, hinge, ajar)
        self.objects.append(item)
        return item

    def add_spots(self, owner: int, spots: tuple[Spot, ...]) -> None:
        """More spots of an object that is there already."""
        item = self.objects[owner]
        self.objects[owner] = replace(item, spots=(*item.spots, *spots))

    def add_mesh(self, mesh: Mesh, owner: int, wall: int = -1) -> None:
        """Something to draw that never moves; ``wall``: index of the wild wall it is on, -1 for none."""
        self.add_faces(mesh, np.full(len(mesh.faces), owner, np.int32), wall)

    def add_faces(self, mesh: Mesh, owners: NDArray[np.int32], wall: int) -> None:
        """As :meth:`add_mesh`, with an owner for each face, int32 [F]."""
        self._meshes.append(mesh)
        self._owners.append(owners)
        self._walls.append(np.full(len(mesh.faces), wall, np.int32))

    def add_solid(self, centre: Vector, half: Vector, owner: int, yaw: float = 0.0, wall: int = -1) -> None:
        """An upright box in the way, turned by ``yaw`` about Z."""
        self._solids.append(_Solid(centre, half, yaw, wall, owner))

    def add_floor(self, height: float, rects: list[Rect]) -> None:
        """Rectangles one walks on."""
        self.floors.setdefault(round(height, 4), []).extend(rects)

    def new_parts(self, count: int = 1) -> int:
        """The first of ``count`` new part numbers."""
        first = self._parts
        self._parts += count
        return first

    def numbered(self, mesh: Mesh) -> Mesh:
        """The mesh with part numbers of its own."""
        first = self.new_parts(int(mesh.parts.max()) + 1 if len(mesh.parts) else 0)
        return replace(mesh, parts=mesh.parts + np.int32(first))

    # -- the whole ------------------------------------------------------------------

    def mesh(self) -> tuple[Mesh, NDArray[np.int32], NDArray[np.int32]]:
        """All that never moves as one mesh, with the owner and the wall of each face, int32 [F]."""
        none = np.zeros(0, np.int32)
        return (
            join(told_apart(self._meshes, _HAIR)),
            np.concatenate([*self._owners, none]),
            np.concatenate([*self._walls, none]),
        )

    def solids(self) -> Solids:
        """All boxes in the way."""
        return Solids(
            np.array([s.centre for s in self._solids], np.float64).reshape(-1, 3),
            np.array([s.half for s in self._solids], np.float64).reshape(-1, 3),
            np.array([s.yaw for s in self._solids], np.float64),
            np.array([s.wall for s in self._solids], np.int32),
            np.array([s.object for s in self._solids], np.int32),
        )

    def levels(self) -> tuple[Level, ...]:
        """The floors, lowest first."""
        return tuple(Level(z, tuple(rects)) for z, rects in sorted(self.floors.items()))


def placed_spot(spot: PropSpot, matrix: Matrix) -> Spot:
    """A spot of a thing in the world; ``matrix``: world_from_thing."""
    turn = math.atan2(matrix[1, 0], matrix[0, 0])
    facing = None if spot.facing is None else math.remainder(spot.facing + turn, 2 * math.pi)
    return Spot(spot.name, placed_point(spot.at, matrix), facing)


def placed_point(point: tuple[float, ...], matrix: Matrix) -> Vector:
    """A point (x, y, z) of a thing in the world; ``matrix``: world_from_thing."""
    x, y, z = (matrix @ np.array([*point, 1.0]))[:3].tolist()
    return x, y, z


def bounds_of(mesh: Mesh, matrix: Matrix) -> tuple[Vector, Vector]:
    """The lowest and highest corner of a mesh in the world; of an empty one, where its thing is."""
    points = mesh.vertices if len(mesh.vertices) else matrix[:3, 3][None]
    low, high = points.min(0).tolist(), points.max(0).tolist()
    return (low[0], low[1], low[2]), (high[0], high[1], high[2])
