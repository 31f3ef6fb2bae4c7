"""From a set's definition to a :class:`World`: meshes, solids, floors, walls and light.

Assumes a set that :func:`check_set` found no error in; what is wrong all the same is left out.
Guarantees that the same set gives the same world, that every `stand` spot it keeps is free and on a
floor, and that movable things are not part of the static mesh.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from runtime.mesh import MATERIALS, Mesh, join
from runtime.raster.types import ONE_SIDED
from runtime.shapes import painted
from runtime.world import Hinge, Level, Rect, Solids, Spot, Stairs, Wall, World, WorldObject

from ..lang.definitions.files import FileSetDef
from ..lang.definitions.levels import Flight, Platform
from ..lang.definitions.prop import PropDef, PropPart, PropShape, PropSpot
from ..lang.definitions.set import (
    WALL_THICKNESS,
    Opening,
    Placed,
    PropCatalog,
    Room,
    SetDef,
    call_arguments,
    find_prop,
)
from ..lang.diagnostics import Report
from .floors import (
    ceiling_mesh,
    flight_boxes,
    flight_matrix,
    flight_mesh,
    floor_mesh,
    inside,
    plan,
    platform_mesh,
    slab_mesh,
    stairs_of,
    treads,
    wells,
    without,
)
from .light import LAMPLIGHT, glass_tint, make_light
from .models import FileSet, file_set, on_ground
from .props import BuiltProp, build_prop, built_file, placement
from .standing import clear_spot
from .walls import (
    SLAB,
    Cut,
    Stretch,
    cut_of,
    cut_walls,
    find_stretch,
    skirting,
    stretches,
    wall_line,
    wall_mesh,
    wall_pieces,
)

Matrix = NDArray[np.float64]
#: A prop put against a wall stands off it by this much, so that it does not sink into the skirting.
OFF_WALL = 0.016
#: Props whose names end so have light in their windows at night.
INHABITED = ("house", "train")
#: A board runs along the foot of walls of these materials.
SKIRTED = ("plain", "plaster", "wood")
#: The earth around an outdoor set reaches this far beyond it, metres.
GROUND_REACH = 22.0


def build_world(
    definition: SetDef, catalog: PropCatalog, time: str = "", room: tuple[str, ...] = ()
) -> World:
    """The whole set; ``room`` only says from where it is seen, for the light."""
    scenery = file_set(definition.model) if isinstance(definition, FileSetDef) else None
    builder = _Builder(definition if scenery is None else on_ground(definition, scenery), catalog, scenery)
    builder.build()
    return builder.world(time or definition.time, room)


@dataclass
class _Solid:
    centre: tuple[float, float, float]
    half: tuple[float, float, float]
    yaw: float
    wall: int
    object: int


@dataclass
class _Builder:
    """Collects the pieces of one world."""

    definition: SetDef
    catalog: PropCatalog
    scenery: FileSet | None = None
    report: Report = field(default_factory=Report)
    objects: list[WorldObject] = field(default_factory=list)
    meshes: list[Mesh] = field(default_factory=list)
    mesh_object: list[NDArray[np.int32]] = field(default_factory=list)
    mesh_wall: list[NDArray[np.int32]] = field(default_factory=list)
    solids: list[_Solid] = field(default_factory=list)
    floors: dict[float, list[Rect]] = field(default_factory=dict)
    stairs: list[Stairs] = field(default_factory=list)
    walls: list[Stretch] = field(default_factory=list)
    made: dict[tuple[object, ...], tuple[PropShape, BuiltProp]] = field(default_factory=dict)
    parts: int = 0
    face_parts: dict[tuple[int, float, int, int], int] = field(default_factory=dict)

    # -- the whole ------------------------------------------------------------------

    def build(self) -> None:
        rooms = self.definition.rooms
        self.walls = stretches(self.definition)
        cuts: list[list[Cut]] = [[] for _ in self.walls]
        room_ids = [self._room(room) for room in rooms]
        openings = []
        for room in rooms:
            for opening in room.openings:
                through = cut_walls(self.walls, room, opening)
                for index in through:
                    cuts[index].append(cut_of(room, opening))
                openings += [(room, opening, through[0])] if through else []
        for index, stretch in enumerate(self.walls):
            self._wall(index, stretch, cuts[index], room_ids)
        for room, opening, index in openings:
            self._opening(room, opening, index)
        for room in rooms:
            for item in room.placed:
                self._placed(room, item, (room.name, item.name), None, {})
            for platform in room.platforms:
                self._platform(room, platform)
            for flight in room.flights:
                self._flight(flight)
        for flight in self.definition.flights:
            self._flight(flight)
        if self.scenery is not None:
            self._things(self.scenery, rooms[0])
        if self.definition.outdoor:
            self._ground()

    def world(self, time: str, room: tuple[str, ...]) -> World:
        owners = np.concatenate([*self.mesh_object, np.zeros(0, np.int32)])
        mesh = self._glazed(join(self.meshes), time, owners)
        solids = self._packed_solids()
        levels = tuple(Level(z, tuple(rects)) for z, rects in sorted(self.floors.items()))
        kept = [_with_clear_spots(o, solids, levels) for o in self.objects]
        for k, item in enumerate(kept):
            if item.hinge is not None and item.mesh is not None:
                own = np.full(len(item.mesh.faces), item.hinge.owner, np.int32)
                kept[k] = replace(item, mesh=self._glazed(item.mesh, time, own))
        walls = tuple(Wall(s.point(s.start), s.point(s.end), s.height, s.base) for s in self.walls)
        return World(
            self.definition.name,
            mesh,
            np.concatenate([*self.mesh_object, np.zeros(0, np.int32)]),
            np.concatenate([*self.mesh_wall, np.zeros(0, np.int32)]),
            tuple(kept),
            solids,
            walls,
            tuple(rect for level in levels for rect in level.floors),
            make_light(self.definition, time, room),
            self.definition.outdoor,
            levels,
            tuple(self.stairs),
        )

    def _glazed(self, mesh: Mesh, time: str, owners: NDArray[np.int32]) -> Mesh:
        """Glass takes the colour of the hour; at night houses have light in their windows."""
        tint, share, material = glass_tint(time, self.definition.outdoor, self.definition.light)
        glass = mesh.materials == MATERIALS.index("glass")
        if share <= 0 or not glass.any():
            return mesh
        colors, materials = mesh.colors.copy(), mesh.materials.copy()
        own = colors[glass]
        relative = own.mean(1, keepdims=True) / max(float(own.mean()), 1e-6)
        colors[glass] = (1 - share) * own + share * np.clip(np.asarray(tint, np.float32) * relative, 0, 1)
        materials[glass] = MATERIALS.index(material)
        if time == "night":
            homes = [o.id for o in self.objects if o.kind.endswith(INHABITED)]
            lit = glass & np.isin(owners, homes)
            colors[lit], materials[lit] = LAMPLIGHT, MATERIALS.index("glow")
        return Mesh(mesh.vertices, mesh.faces, mesh.normals, colors, mesh.parts, materials)

    def _packed_solids(self) -> Solids:
        return Solids(
            np.array([s.centre for s in self.solids], np.float64).reshape(-1, 3),
            np.array([s.half for s in self.solids], np.float64).reshape(-1, 3),
            np.array([s.yaw for s in self.solids], np.float64),
            np.array([s.wall for s in self.solids], np.int32),
            np.array([s.object for s in self.solids], np.int32),
        )

    def _add(self, mesh: Mesh, owner: int, wall: int) -> None:
        self.meshes.append(mesh)
        self.mesh_object.append(np.full(len(mesh.faces), owner, np.int32))
        self.mesh_wall.append(np.full(len(mesh.faces), wall, np.int32))

    def _parts(self, count: int = 1) -> int:
        """The first of ``count`` new part numbers."""
        first = self.parts
        self.parts += count
        return first

    def _face_part(self, key: tuple[int, float, int, int]) -> int:
        """One part for all of a room's wall on one line, so that no ink runs where two walls meet in it."""
        if key not in self.face_parts:
            self.face_parts[key] = self._parts()
        return self.face_parts[key]

    # -- rooms ----------------------------------------------------------------------

    def _room(self, room: Room) -> int:
        owner = len(self.objects)
        (x, y, z), h = room.at[:3], room.size[2]
        x0, y0, x1, y1 = inside(room)
        matrix = placement(x, y, z, 0.0)
        spots = tuple(_spot(s, matrix) for s in room.spots)
        low, high = (x0, y0, z), (x1, y1, z + (h if room.kind == "room" else 2.6))
        self.objects.append(WorldObject(owner, (room.name,), room.kind, spots, low, high, matrix))
        holes = wells(self.definition, z, z)
        if self.scenery is None or not self.scenery.own_ground:
            self._add(floor_mesh(room, self._parts(), holes), owner, -1)
        if not room.open:
            above = wells(self.definition, z + h, z + h + SLAB)
            self._add(ceiling_mesh(room, self._parts(), above), owner, ONE_SIDED)
        walked = without((x0, y0, x1, y1), holes) if self.scenery is None else list(self.scenery.floors)
        self._floor(z, walked)
        if z > SLAB:
            self._slab(room, holes, owner)
        return owner

    def _floor(self, height: float, rects: list[Rect]) -> None:
        self.floors.setdefault(round(height, 4), []).extend(rects)

    def _slab(self, room: Room, holes: list[Rect], owner: int) -> None:
        """What is between an upper floor and the ceiling under it."""
        high = room.at[2] - 0.004
        rects = without(plan(room), holes)
        self._add(slab_mesh(rects, high - 0.19, high, room.wall_color, self._parts()), owner, -1)
        for x0, y0, x1, y1 in rects:
            middle, half = ((x0 + x1) / 2, (y0 + y1) / 2, high - 0.095), ((x1 - x0) / 2, (y1 - y0) / 2, 0.095)
            self.solids.append(_Solid(middle, half, 0.0, -1, owner))

    def _platform(self, room: Room, platform: Platform) -> None:
        owner = len(self.objects)
        (x, y, z), (w, d, h) = platform.at, platform.size
        matrix = placement(x, y, z, 0.0)
        spots = tuple(_spot(s, matrix) for s in platform.spots)
        low, high = (x, y, z), (x + w, y + d, max(z + 2.0, room.at[2] + room.size[2]))
        self.objects.append(WorldObject(owner, platform.path, "area", spots, low, high, matrix))
        self._add(platform_mesh(platform, self._parts(2)), owner, -1)
        self.solids.append(_Solid((x + w / 2, y + d / 2, z - h / 2), (w / 2, d / 2, h / 2), 0.0, -1, owner))
        self._floor(z, [(x, y, x + w, y + d)])
        for flight in platform.flights():
            self._flight(flight)
        here = replace(room, kind="area", at=platform.at, size=platform.size)
        for item in platform.placed:
            self._placed(here, item, (*platform.path, item.name), None, {})

    def _flight(self, flight: Flight) -> None:
        owner, matrix = len(self.objects), flight_matrix(flight)
        stairs = stairs_of(flight)
        (ax, ay), (lx, ly, lz), (hx, hy, hz) = stairs.ahead, stairs.low, stairs.high
        facing = math.atan2(ay, ax)
        spots = (
            Spot("foot", (lx - 0.45 * ax, ly - 0.45 * ay, lz), facing),
            Spot("head", (hx + 0.45 * ax, hy + 0.45 * ay, hz), facing),
        )
        mesh = flight_mesh(flight, self._parts(1 + len(treads(flight))))
        low, high = _bounds(mesh, matrix)
        self.objects.append(WorldObject(owner, flight.path, "stairs", spots, low, high, matrix))
        self._add(mesh, owner, -1)
        self.stairs.append(stairs)
        for (x, y, z), half in flight_boxes(flight):
            cx, cy, cz = (matrix @ np.array([x, y, z, 1.0]))[:3].tolist()
            self.solids.append(_Solid((cx, cy, cz), half, flight.turn, -1, owner))

    def _wall(self, index: int, stretch: Stretch, cuts: list[Cut], room_ids: list[int]) -> None:
        facade = self.definition.facade
        sides = (stretch.before, stretch.after)
        colors = tuple(facade if i is None else self.definition.rooms[i].wall_color for i in sides)
        owners = [room_ids[i] for i in sides if i is not None]
        line = (stretch.axis, round(stretch.across, 3))
        faces = [self._face_part((*line, side, -1 if r is None else r)) for side, r in enumerate(sides)]
        edge = self._face_part((*line, 2, -1))
        kinds = tuple("plaster" if i is None else self.definition.rooms[i].walls for i in sides)
        parts = (faces[0], faces[1], edge)
        mesh = wall_mesh(stretch, cuts, (colors[0], colors[1]), parts, (kinds[0], kinds[1]))
        self._add(mesh, owners[0], index)
        if len(owners) == 2:  # each face belongs to the room it looks into
            self.mesh_object[-1][mesh.parts == faces[1]] = owners[1]
        for side, room in enumerate(sides):
            if room is None or kinds[side] not in SKIRTED:
                continue
            r, i = self.definition.rooms[room], stretch.axis
            inset = WALL_THICKNESS / 2
            clip = (r.at[i] + inset, r.at[i] + r.size[i] - inset)
            self._add(
                skirting(stretch, cuts, side, clip, self._face_part((*line, 3 + side, room))),
                room_ids[room],
                index,
            )
        for low, high, bottom, top in wall_pieces(stretch, cuts):
            middle = stretch.point((low + high) / 2)
            along, across = (high - low) / 2, WALL_THICKNESS / 2
            half = (along, across) if stretch.axis == 0 else (across, along)
            self.solids.append(
                _Solid((*middle, (bottom + top) / 2), (*half, (top - bottom) / 2), 0.0, index, owners[0])
            )

    def _opening(self, room: Room, opening: Opening, index: int) -> None:
        prop = find_prop(opening.call, self.catalog, self.report)
        if prop is None:
            return
        own = {
            "width": opening.width,
            "height": opening.height,
            "sill": opening.sill,
            "depth": WALL_THICKNESS,
            "open": opening.turn,
        }
        known = {spec.name for spec in prop.parameters}
        arguments: dict[str, float | str] = {k: v for k, v in own.items() if k in known}
        arguments |= call_arguments(opening.call, opening.env, prop, self.report)
        shape, built = self._made(prop, arguments)
        axis, across, start, _ = wall_line(room, opening.wall)
        stretch = self.walls[index]
        x, y = stretch.point(start + opening.at)
        matrix = placement(x, y, room.at[2], _TURN[opening.wall])
        self._object((room.name, opening.name), opening.kind, shape, (), built, matrix, index)
        if opening.kind != "window" and stretch.before is not None and stretch.after is not None:
            half = WALL_THICKNESS / 2 + 0.02
            low, high = start + opening.at - opening.width / 2, start + opening.at + opening.width / 2
            gap = (low, across - half, high, across + half)
            self._floor(room.at[2], [gap if axis == 0 else (gap[1], gap[0], gap[3], gap[2])])

    # -- props ----------------------------------------------------------------------

    def _made(self, prop: PropDef, arguments: dict[str, float | str]) -> tuple[PropShape, BuiltProp]:
        """A prop made to measure, once however often it is placed."""
        key = (prop.name, *sorted(arguments.items()))
        if key not in self.made:
            shape = prop.shape(arguments, self.report)
            self.made[key] = shape, build_prop(shape)
        return self.made[key]

    def _placed(
        self,
        room: Room,
        item: Placed,
        path: tuple[str, ...],
        parent: Matrix | None,
        parent_spots: dict[str, PropSpot],
    ) -> None:
        prop = find_prop(item.call, self.catalog, self.report)
        if prop is None:
            return
        shape, built = self._made(prop, call_arguments(item.call, item.env, prop, self.report))
        wall = -1
        if parent is not None:
            rest = parent_spots.get(item.on or "", PropSpot("", (0.0, 0.0, 0.0), None)).at
            local = placement(rest[0] + item.at[0], rest[1] + item.at[1], rest[2] + item.up, item.turn)
            matrix = parent @ local
        elif item.wall is not None:
            matrix = self._against_wall(room, item, built)
            if item.up > 0:
                found = find_stretch(self.walls, room, item.wall, item.at[0], item.up)
                wall = -1 if found is None else found
        else:
            x, y, z = room.at
            matrix = placement(x + item.at[0], y + item.at[1], z + item.up, item.turn)
        self._object(path, prop.name, shape, item.spots, built, matrix, wall)
        spots = {s.name: s for s in (*reversed(shape.spots), *reversed(item.spots))}
        for child in item.children:
            self._placed(room, child, (*path, child.name), matrix, spots)

    def _against_wall(self, room: Room, item: Placed, built: BuiltProp) -> Matrix:
        """Back to the wall: the prop's +Y side touches it."""
        assert item.wall is not None
        axis, across, start, _ = wall_line(room, item.wall)
        depth = float(built.mesh.vertices[:, 1].max()) if len(built.mesh.vertices) else 0.0
        inset = (WALL_THICKNESS / 2 if room.kind == "room" else 0.0) + (OFF_WALL if item.up <= 0 else 0.001)
        inward = -1.0 if item.wall in ("north", "east") else 1.0
        along, off = start + item.at[0], across + inward * (inset + depth)
        x, y = (along, off) if axis == 0 else (off, along)
        return placement(x, y, room.at[2] + item.up, _TURN[item.wall] + item.turn)

    def _object(
        self,
        path: tuple[str, ...],
        kind: str,
        shape: PropShape,
        extra: tuple[PropSpot, ...],
        built: BuiltProp,
        matrix: Matrix,
        wall: int,
    ) -> None:
        owner, grip = len(self.objects), shape.grip
        mesh = self._numbered(built.mesh)
        placed = mesh.transformed(matrix)
        low, high = _bounds(placed, matrix)
        named = [_spot(s, matrix) for s in (*extra, *shape.spots, *built.spots)]
        if grip is not None:
            x, y, z = (matrix @ np.array([*grip, 1.0]))[:3].tolist()
            named.append(Spot("grip", (x, y, z)))
        item = WorldObject(owner, path, kind, tuple(named), low, high, matrix)
        if grip is not None:
            self.objects.append(replace(item, mesh=mesh, grip=(grip[0], grip[1], grip[2])))
            return
        self.objects.append(item)
        self._add(placed, owner, wall)
        self._solids(built, matrix, wall, owner)
        for part in shape.parts:
            self._part(item, part, wall)

    def _things(self, scenery: FileSet, ground: Room) -> None:
        """What a set's file holds, each an object on its ground."""
        taken = {item.name for item in ground.placed}
        for name, thing in scenery.things:
            path = (ground.name, name if name not in taken else f"{name}_file")
            built = built_file(thing)
            self._object(path, name, PropShape((), (), None, None), (), built, np.eye(4), -1)

    def _numbered(self, mesh: Mesh) -> Mesh:
        """The mesh with parts of its own."""
        first = self._parts(int(mesh.parts.max()) + 1 if len(mesh.parts) else 0)
        parts = mesh.parts + np.int32(first)
        return Mesh(mesh.vertices, mesh.faces, mesh.normals, mesh.colors, parts, mesh.materials)

    def _solids(self, built: BuiltProp, matrix: Matrix, wall: int, owner: int) -> None:
        yaw = math.atan2(matrix[1, 0], matrix[0, 0])
        for centre, half in zip(built.centre, built.half, strict=True):
            x, y, z = (matrix @ np.array([*centre, 1.0]))[:3].tolist()
            self.solids.append(_Solid((x, y, z), (half[0], half[1], half[2]), yaw, wall, owner))

    def _part(self, item: WorldObject, part: PropPart, wall: int) -> None:
        """A part that moves: an object of its own, and the spots it carries named on its owner too."""
        owner, built = len(self.objects), build_prop(part.shape)
        mesh = self._numbered(built.mesh)
        handle = next((s.at for s in part.shape.spots if s.name == "handle"), None)
        middle = (mesh.vertices.min(0) + mesh.vertices.max(0)) / 2
        hinge = Hinge(
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
        matrix = hinge.matrices(part.ajar)
        spots = tuple(_spot(s, matrix) for s in part.shape.spots)
        low, high = _bounds(mesh.transformed(matrix), matrix)
        path = (*item.path, part.name)
        self.objects.append(
            WorldObject(owner, path, "part", spots, low, high, matrix, mesh, None, hinge, part.ajar)
        )
        carried = (*self.objects[item.id].spots, *(s for s in spots if s.name != "stand"))
        self.objects[item.id] = replace(self.objects[item.id], spots=carried)
        centres, halves, yaw = hinge.solids(part.ajar)
        for centre, half in zip(centres.tolist(), halves.tolist(), strict=True):
            self.solids.append(_Solid(tuple(centre), tuple(half), yaw, wall, owner))

    def _ground(self) -> None:
        """Earth all around, lower than the floors, so that the set does not end in the air."""
        rects = [rect for floors in self.floors.values() for rect in floors]
        if not rects:
            return
        box = np.array(rects)
        (x0, y0), (x1, y1) = box[:, :2].min(0) - GROUND_REACH, box[:, 2:].max(0) + GROUND_REACH
        gx, gy = np.meshgrid(np.linspace(x0, x1, 9), np.linspace(y0, y1, 9), indexing="ij")
        vertices = np.stack([gx.ravel(), gy.ravel(), np.full(gx.size, -self.definition.deep)], 1)
        i, j = np.meshgrid(np.arange(8), np.arange(8), indexing="ij")
        a = (i * 9 + j).ravel()
        quads = np.stack([a, a + 9, a + 10, a + 1], 1)
        faces = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
        normals = np.tile([0.0, 0.0, 1.0], (len(vertices), 1))
        hue, material = self.definition.ground, self.definition.earth
        ground = painted(vertices, faces, normals, hue, material, self._parts())
        self._add(ground, 0, -1)


#: How a prop whose back is at +Y is turned to have it at each wall.
_TURN = {"north": 0.0, "west": math.pi / 2, "south": math.pi, "east": -math.pi / 2}


def _spot(spot: PropSpot, matrix: Matrix) -> Spot:
    x, y, z = (matrix @ np.array([*spot.at, 1.0]))[:3].tolist()
    turn = math.atan2(matrix[1, 0], matrix[0, 0])
    facing = None if spot.facing is None else math.remainder(spot.facing + turn, 2 * math.pi)
    return Spot(spot.name, (x, y, z), facing)


def _one_box(built: BuiltProp) -> NDArray[np.float64]:
    """[B, 2, 3]: the box around all boxes of a part, as centre and half extents; none where it has none."""
    if not len(built.centre):
        return np.zeros((0, 2, 3))
    low, high = (built.centre - built.half).min(0), (built.centre + built.half).max(0)
    return np.array([[(low + high) / 2, (high - low) / 2]])


def _bounds(mesh: Mesh, matrix: Matrix) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
    points = mesh.vertices if len(mesh.vertices) else matrix[:3, 3][None]
    low, high = points.min(0).tolist(), points.max(0).tolist()
    return (low[0], low[1], low[2]), (high[0], high[1], high[2])


def _with_clear_spots(item: WorldObject, solids: Solids, levels: tuple[Level, ...]) -> WorldObject:
    """The object with its `stand` spots moved to free floor nearby, or left out where there is none."""
    spots = []
    for spot in item.spots:
        if spot.name != "stand":
            spots.append(spot)
            continue
        clear = clear_spot(spot, solids, levels)
        if clear is not None:
            spots.append(clear)
    return replace(item, spots=tuple(spots))
