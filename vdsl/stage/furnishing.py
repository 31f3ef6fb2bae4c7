"""What stands in a set and in its walls: props made to measure, their spots, solids and moving parts.

Assumes props that :func:`check_set` found no error in; one that there is not is left out. Guarantees that
what can be carried and what moves are objects with meshes of their own, and no part of the static mesh.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from runtime.world import Hinge, Spot, WorldObject

from ..lang.definitions.placing import Placed, PropCatalog, call_arguments, find_prop
from ..lang.definitions.prop import PropDef, PropPart, PropShape, PropSpot
from ..lang.definitions.set import WALL_THICKNESS, Opening, Room
from ..lang.diagnostics import Report
from .models import FileSet
from .pieces import Matrix, Pieces, bounds_of, placed_point, placed_spot
from .props import BuiltProp, build_prop, built_file, placement
from .walls import Stretch, find_stretch, wall_line

#: A prop put against a wall stands off it by this much, so that it does not sink into the skirting.
OFF_WALL = 0.016
#: How a prop whose back is at +Y is turned to have it at each wall.
_TURN = {"north": 0.0, "west": math.pi / 2, "south": math.pi, "east": -math.pi / 2}


@dataclass
class Furnisher:
    """Adds props to a world's pieces; ``walls``: those of the set."""

    catalog: PropCatalog
    pieces: Pieces
    walls: list[Stretch]
    _report: Report = field(default_factory=Report)
    _made: dict[tuple[object, ...], tuple[PropShape, BuiltProp]] = field(default_factory=dict)

    def add_opening(self, room: Room, opening: Opening, index: int) -> None:
        """What fills an opening of a wall, and the floor one walks on through it; ``index``: of the wall."""
        prop = find_prop(opening.call, self.catalog, self._report)
        if prop is None:
            return
        arguments = _measures(opening, prop)
        arguments |= call_arguments(opening.call, opening.env, prop, self._report)
        shape, built = self._make(prop, arguments)
        axis, across, start, _ = wall_line(room, opening.wall)
        stretch, middle = self.walls[index], start + opening.at
        matrix = placement(*stretch.point(middle), room.at[2], _TURN[opening.wall])
        self._add_prop((room.name, opening.name), opening.kind, shape, (), built, matrix, index)
        if opening.kind != "window" and stretch.before is not None and stretch.after is not None:
            half, wide = WALL_THICKNESS / 2 + 0.02, opening.width / 2
            gap = (middle - wide, across - half, middle + wide, across + half)
            self.pieces.add_floor(room.at[2], [gap if axis == 0 else (gap[1], gap[0], gap[3], gap[2])])

    def add_placed(self, room: Room, items: tuple[Placed, ...], path: tuple[str, ...]) -> None:
        """Props of a room, with all that stands on them; ``path``: names down to where they stand."""
        for item in items:
            prop = find_prop(item.call, self.catalog, self._report)
            if prop is None:
                continue
            made = self._make(prop, call_arguments(item.call, item.env, prop, self._report))
            matrix, wall = self._in_room(room, item, made[1])
            self._add_tree(item, prop, made, matrix, (*path, item.name), wall)

    def add_things(self, scenery: FileSet, ground: Room) -> None:
        """What a set's file holds, each an object on its ground."""
        taken = {item.name for item in ground.placed}
        for name, thing in scenery.things:
            path = (ground.name, name if name not in taken else f"{name}_file")
            built = built_file(thing)
            self._add_prop(path, name, PropShape((), (), None, None), (), built, np.eye(4), -1)

    # -- where a prop is ------------------------------------------------------------

    def _make(self, prop: PropDef, arguments: dict[str, float | str]) -> tuple[PropShape, BuiltProp]:
        """A prop made to measure, once however often it is placed."""
        key = (prop.name, *sorted(arguments.items()))
        if key not in self._made:
            shape = prop.shape(arguments, self._report)
            self._made[key] = shape, build_prop(shape)
        return self._made[key]

    def _in_room(self, room: Room, item: Placed, built: BuiltProp) -> tuple[Matrix, int]:
        """world_from_prop of what stands or hangs in a room, and the wild wall it hangs on, or -1."""
        if item.wall is None:
            x, y, z = room.at
            return placement(x + item.at[0], y + item.at[1], z + item.up, item.turn), -1
        hangs = item.up > 0
        wall = find_stretch(self.walls, room, item.wall, item.at[0], item.up) if hangs else None
        return _against_wall(room, item, item.wall, built), -1 if wall is None else wall

    def _add_tree(
        self, item: Placed, prop: PropDef, made: tuple[PropShape, BuiltProp], matrix: Matrix,
        path: tuple[str, ...], wall: int = -1,
    ) -> None:  # fmt: skip
        """A placed prop, then what stands on it."""
        shape, built = made
        self._add_prop(path, prop.name, shape, item.spots, built, matrix, wall)
        spots = {s.name: s.at for s in (*reversed(shape.spots), *reversed(item.spots))}
        for child in item.children:
            below = find_prop(child.call, self.catalog, self._report)
            if below is None:
                continue
            x, y, z = spots.get(child.on or "", (0.0, 0.0, 0.0))
            local = placement(x + child.at[0], y + child.at[1], z + child.up, child.turn)
            arguments = call_arguments(child.call, child.env, below, self._report)
            self._add_tree(child, below, self._make(below, arguments), matrix @ local, (*path, child.name))

    # -- what a prop brings ---------------------------------------------------------

    def _add_prop(
        self, path: tuple[str, ...], kind: str, shape: PropShape, extra: tuple[PropSpot, ...],
        built: BuiltProp, matrix: Matrix, wall: int,
    ) -> None:  # fmt: skip
        """``extra``: spots of its own in this place; ``wall``: the wild wall it is on, or -1."""
        mesh = self.pieces.numbered(built.mesh)
        placed = mesh.transformed(matrix)
        bounds = bounds_of(placed, matrix)
        spots = tuple(placed_spot(s, matrix) for s in (*extra, *shape.spots, *built.spots))
        if shape.grip is not None:
            x, y, z = shape.grip
            grip = Spot("grip", placed_point(shape.grip, matrix))
            self.pieces.add_object(path, kind, (*spots, grip), bounds, matrix, mesh, (x, y, z))
            return
        item = self.pieces.add_object(path, kind, spots, bounds, matrix)
        self.pieces.add_mesh(placed, item.id, wall)
        yaw = math.atan2(matrix[1, 0], matrix[0, 0])
        for centre, (x, y, z) in zip(built.centre, built.half.tolist(), strict=True):
            self.pieces.add_solid(placed_point(tuple(centre), matrix), (x, y, z), item.id, yaw, wall)
        for part in shape.parts:
            self._add_part(item, part, wall)

    def _add_part(self, item: WorldObject, part: PropPart, wall: int) -> None:
        """A part that moves: an object of its own, and the spots it carries named on its owner too."""
        built = build_prop(part.shape)
        mesh = self.pieces.numbered(built.mesh)
        hinge = _hinge(part, item, built)
        matrix = hinge.matrices(part.ajar)
        spots = tuple(placed_spot(s, matrix) for s in part.shape.spots)
        bounds = bounds_of(mesh.transformed(matrix), matrix)
        path = (*item.path, part.name)
        made = self.pieces.add_object(path, "part", spots, bounds, matrix, mesh, hinge=hinge, ajar=part.ajar)
        self.pieces.add_spots(item.id, tuple(s for s in spots if s.name != "stand"))
        centres, halves, yaw = hinge.solids(part.ajar)
        for centre, half in zip(centres.tolist(), halves.tolist(), strict=True):
            self.pieces.add_solid(tuple(centre), tuple(half), made.id, yaw, wall)


def _measures(opening: Opening, prop: PropDef) -> dict[str, float | str]:
    """An opening's measures, as far as what fills it takes them for arguments."""
    own = {
        "width": opening.width, "height": opening.height, "sill": opening.sill, "depth": WALL_THICKNESS,
        "open": opening.turn,
    }  # fmt: skip
    known = {spec.name for spec in prop.parameters}
    return {name: value for name, value in own.items() if name in known}


def _against_wall(room: Room, item: Placed, wall: str, built: BuiltProp) -> Matrix:
    """world_from_prop with its back to the wall: the prop's +Y side touches it."""
    axis, across, start, _ = wall_line(room, wall)
    depth = float(built.mesh.vertices[:, 1].max()) if len(built.mesh.vertices) else 0.0
    inset = (WALL_THICKNESS / 2 if room.kind == "room" else 0.0) + (OFF_WALL if item.up <= 0 else 0.001)
    inward = -1.0 if wall in ("north", "east") else 1.0
    along, off = start + item.at[0], across + inward * (inset + depth)
    x, y = (along, off) if axis == 0 else (off, along)
    return placement(x, y, room.at[2] + item.up, _TURN[wall] + item.turn)


def _hinge(part: PropPart, item: WorldObject, built: BuiltProp) -> Hinge:
    """How a part moves; without a spot `handle` it is taken hold of in its middle."""
    handle = next((s.at for s in part.shape.spots if s.name == "handle"), None)
    mesh = built.mesh
    middle = (mesh.vertices.min(0) + mesh.vertices.max(0)) / 2
    return Hinge(
        part.kind,
        np.array(part.at, np.float64),
        np.array(part.axis, np.float64),
        part.open,
        np.array(handle if handle is not None else middle.tolist(), np.float64),
        item.world_from_object,
        item.id,
        _one_box(built),
        part.way,
    )


def _one_box(built: BuiltProp) -> NDArray[np.float64]:
    """[B, 2, 3]: the box around all boxes of a part, as centre and half extents; none where it has none."""
    if not len(built.centre):
        return np.zeros((0, 2, 3))
    low, high = (built.centre - built.half).min(0), (built.centre + built.half).max(0)
    return np.array([[(low + high) / 2, (high - low) / 2]])
