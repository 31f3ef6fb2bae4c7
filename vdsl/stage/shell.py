"""What a set is built of before anything stands in it: rooms, walls, floors at heights, stairs, land around.

Assumes a set that :func:`check_set` found no error in. Each function adds one thing to the world's pieces,
with its mesh, the boxes that stand in for it and the floor it brings.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from runtime.raster.types import ONE_SIDED
from runtime.shapes import painted
from runtime.world import Rect, Spot

from ..lang.definitions.levels import Flight, Platform
from ..lang.definitions.set import WALL_THICKNESS, Room, SetDef
from .floors import (
    ceiling_mesh,
    flight_boxes,
    flight_matrix,
    flight_mesh,
    floor_mesh,
    inside,
    plan,
    platform_mesh,
    sheet,
    slab_mesh,
    stairs_of,
    treads,
    wells,
    without,
)
from .models import FileSet
from .pieces import Pieces, bounds_of, placed_point, placed_spot
from .props import placement
from .walls import SLAB, Cut, Stretch, skirting, wall_mesh, wall_pieces

#: A board runs along the foot of walls of these materials.
SKIRTED = ("plain", "plaster", "wood")
#: The earth around an outdoor set reaches this far beyond it, metres.
GROUND_REACH = 22.0
#: From the middle of a flight's first and last riser to where one stands before and after it, metres.
_LANDING = 0.45
#: As high as places under the sky reach, and people on a platform, metres.
_OPEN_HEIGHT, _PERSON = 2.6, 2.0
#: A floor between storeys: how far under the surface it begins, and how thick it is, metres.
_UNDER_FLOOR, _FLOOR_THICKNESS = 0.004, 0.19


def add_room(room: Room, definition: SetDef, scenery: FileSet | None, pieces: Pieces) -> int:
    """A room or an area with its floor and ceiling; its id. ``scenery``: the file the set comes out of."""
    (x, y, z), h = room.at[:3], room.size[2]
    x0, y0, x1, y1 = inside(room)
    matrix = placement(x, y, z, 0.0)
    spots = tuple(placed_spot(s, matrix) for s in room.spots)
    bounds = (x0, y0, z), (x1, y1, z + (h if room.kind == "room" else _OPEN_HEIGHT))
    owner = pieces.add_object((room.name,), room.kind, spots, bounds, matrix).id
    holes = wells(definition, z, z)
    if scenery is None or not scenery.own_ground:
        pieces.add_mesh(floor_mesh(room, pieces.new_parts(), holes), owner)
    if not room.open:
        above = wells(definition, z + h, z + h + SLAB)
        pieces.add_mesh(ceiling_mesh(room, pieces.new_parts(), above), owner, ONE_SIDED)
    walked = without((x0, y0, x1, y1), holes) if scenery is None else list(scenery.floors)
    pieces.add_floor(z, walked)
    if z > SLAB:
        _add_slab(room, holes, owner, pieces)
    return owner


def _add_slab(room: Room, holes: list[Rect], owner: int, pieces: Pieces) -> None:
    """What is between an upper floor and the ceiling under it."""
    high, half = room.at[2] - _UNDER_FLOOR, _FLOOR_THICKNESS / 2
    rects = without(plan(room), holes)
    low = high - _FLOOR_THICKNESS
    pieces.add_mesh(slab_mesh(rects, low, high, room.wall_color, pieces.new_parts()), owner)
    for x0, y0, x1, y1 in rects:
        middle = ((x0 + x1) / 2, (y0 + y1) / 2, high - half)
        pieces.add_solid(middle, ((x1 - x0) / 2, (y1 - y0) / 2, half), owner)


def add_platform(platform: Platform, room: Room, pieces: Pieces) -> None:
    """A floor raised in a room, with its steps; what stands on it is not added here."""
    (x, y, z), (w, d, h) = platform.at, platform.size
    matrix = placement(x, y, z, 0.0)
    spots = tuple(placed_spot(s, matrix) for s in platform.spots)
    bounds = (x, y, z), (x + w, y + d, max(z + _PERSON, room.at[2] + room.size[2]))
    owner = pieces.add_object(platform.path, "area", spots, bounds, matrix).id
    pieces.add_mesh(platform_mesh(platform, pieces.new_parts(2)), owner)
    pieces.add_solid((x + w / 2, y + d / 2, z - h / 2), (w / 2, d / 2, h / 2), owner)
    pieces.add_floor(z, [(x, y, x + w, y + d)])
    for flight in platform.flights():
        add_flight(flight, pieces)


def add_flight(flight: Flight, pieces: Pieces) -> None:
    """A flight of stairs, with a spot before its foot and one after its head."""
    stairs, matrix = stairs_of(flight), flight_matrix(flight)
    (ax, ay), (lx, ly, lz), (hx, hy, hz) = stairs.ahead, stairs.low, stairs.high
    facing = math.atan2(ay, ax)
    spots = (
        Spot("foot", (lx - _LANDING * ax, ly - _LANDING * ay, lz), facing),
        Spot("head", (hx + _LANDING * ax, hy + _LANDING * ay, hz), facing),
    )
    mesh = flight_mesh(flight, pieces.new_parts(1 + len(treads(flight))))
    owner = pieces.add_object(flight.path, "stairs", spots, bounds_of(mesh, matrix), matrix).id
    pieces.add_mesh(mesh, owner)
    pieces.stairs.append(stairs)
    for centre, half in flight_boxes(flight):
        pieces.add_solid(placed_point(centre, matrix), half, owner, flight.turn)


@dataclass
class WallBuilder:
    """Adds the walls of a set; ``room_ids``: ids of its rooms' objects."""

    definition: SetDef
    room_ids: list[int]
    pieces: Pieces
    _face_parts: dict[tuple[int, float, int, int], int] = field(default_factory=dict)

    def add(self, index: int, stretch: Stretch, cuts: list[Cut]) -> None:
        """A wall with its skirting; ``index``: its place among the set's walls."""
        rooms = self.definition.rooms
        sides = (stretch.before, stretch.after)
        before, after = (self.definition.facade if i is None else rooms[i].wall_color for i in sides)
        kinds = tuple("plaster" if i is None else rooms[i].walls for i in sides)
        owners = [self.room_ids[i] for i in sides if i is not None]
        parts = (*(self._part(stretch, side, room) for side, room in enumerate(sides)),
                 self._part(stretch, 2, None))  # fmt: skip
        mesh = wall_mesh(stretch, cuts, (before, after), (parts[0], parts[1], parts[2]), (kinds[0], kinds[1]))
        face_owners = np.full(len(mesh.faces), owners[0], np.int32)
        face_owners[mesh.parts == parts[1]] = owners[-1]  # each face belongs to the room it looks into
        self.pieces.add_faces(mesh, face_owners, index)
        for side, room in enumerate(sides):
            if room is not None and kinds[side] in SKIRTED:
                self._add_skirting(index, stretch, cuts, side, room)
        for low, high, bottom, top in wall_pieces(stretch, cuts):
            middle = (*stretch.point((low + high) / 2), (bottom + top) / 2)
            along, across = (high - low) / 2, WALL_THICKNESS / 2
            half = (along, across) if stretch.axis == 0 else (across, along)
            self.pieces.add_solid(middle, (*half, (top - bottom) / 2), owners[0], wall=index)

    def _add_skirting(self, index: int, stretch: Stretch, cuts: list[Cut], side: int, room: int) -> None:
        found, i, inset = self.definition.rooms[room], stretch.axis, WALL_THICKNESS / 2
        clip = (found.at[i] + inset, found.at[i] + found.size[i] - inset)
        part = self._part(stretch, 3 + side, room)
        self.pieces.add_mesh(skirting(stretch, cuts, side, clip, part), self.room_ids[room], index)

    def _part(self, stretch: Stretch, face: int, room: int | None) -> int:
        """One part for all of a room's wall on one line, so that no ink runs where two walls meet in it."""
        key = (stretch.axis, round(stretch.across, 3), face, -1 if room is None else room)
        if key not in self._face_parts:
            self._face_parts[key] = self.pieces.new_parts()
        return self._face_parts[key]


def add_ground(definition: SetDef, pieces: Pieces) -> None:
    """Earth all around, lower than the floors, so that the set does not end in the air."""
    rects = [rect for floors in pieces.floors.values() for rect in floors]
    if not rects:
        return
    box = np.array(rects)
    (x0, y0), (x1, y1) = box[:, :2].min(0) - GROUND_REACH, box[:, 2:].max(0) + GROUND_REACH
    vertices, faces = sheet((x0, y0, x1, y1), -definition.deep, 8, 8)
    normals = np.tile([0.0, 0.0, 1.0], (len(vertices), 1))
    hue, material = definition.ground, definition.earth
    pieces.add_mesh(painted(vertices, faces, normals, hue, material, pieces.new_parts()), 0)
