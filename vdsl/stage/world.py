"""From a set's definition to a :class:`World`: meshes, solids, floors, walls and light.

Assumes a set that :func:`check_set` found no error in; what is wrong all the same is left out.
Guarantees that the same set gives the same world, that every `stand` spot it keeps is free and on a
floor, and that movable things are not part of the static mesh.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from runtime.raster.lamps import find_lamps
from runtime.raster.types import Style
from runtime.world import Level, Solids, Wall, World, WorldObject

from ..lang.definitions.files import FileSetDef
from ..lang.definitions.set import PropCatalog, SetDef
from .furnishing import Furnisher
from .glazing import glazed
from .light import by_lamplight, make_light
from .models import FileSet, file_set, on_ground
from .pieces import Pieces
from .shell import WallBuilder, add_flight, add_ground, add_platform, add_room
from .standing import clear_spot
from .walls import Cut, Stretch, cut_of, cut_walls, stretches


def build_world(
    definition: SetDef, catalog: PropCatalog, time: str = "", room: tuple[str, ...] = ()
) -> World:
    """The whole set; ``room`` only says from where it is seen, for the light."""
    scenery = None
    if isinstance(definition, FileSetDef):
        scenery = file_set(definition.model)
        definition = on_ground(definition, scenery)
    pieces, walls = Pieces(), stretches(definition)
    furnisher = Furnisher(catalog, pieces, walls)
    _build_rooms(definition, scenery, walls, furnisher)
    for here in definition.rooms:
        furnisher.add_placed(here, here.placed, (here.name,))
        for platform in here.platforms:
            add_platform(platform, here, pieces)
            raised = replace(here, kind="area", at=platform.at, size=platform.size)
            furnisher.add_placed(raised, platform.placed, platform.path)
        for flight in here.flights:
            add_flight(flight, pieces)
    for flight in definition.flights:
        add_flight(flight, pieces)
    if scenery is not None:
        furnisher.add_things(scenery, definition.rooms[0])
    if definition.outdoor:
        add_ground(definition, pieces)
    return _world(definition, pieces, walls, time or definition.time, room)


def _build_rooms(
    definition: SetDef, scenery: FileSet | None, walls: list[Stretch], furnisher: Furnisher
) -> None:
    """Rooms, then the walls between them with their openings cut out, then what fills the openings."""
    ids = [add_room(room, definition, scenery, furnisher.pieces) for room in definition.rooms]
    cuts: list[list[Cut]] = [[] for _ in walls]
    openings = []
    for room in definition.rooms:
        for opening in room.openings:
            through = cut_walls(walls, room, opening)
            for index in through:
                cuts[index].append(cut_of(room, opening))
            openings += [(room, opening, through[0])] if through else []
    builder = WallBuilder(definition, ids, furnisher.pieces)
    for index, stretch in enumerate(walls):
        builder.add(index, stretch, cuts[index])
    for room, opening, index in openings:
        furnisher.add_opening(room, opening, index)


def _world(
    definition: SetDef, pieces: Pieces, walls: list[Stretch], time: str, room: tuple[str, ...]
) -> World:
    """The pieces as a world, its glass as it looks at this hour."""
    mesh, owners, mesh_wall = pieces.mesh()
    solids, levels = pieces.solids(), pieces.levels()
    mesh = glazed(mesh, owners, pieces.objects, definition, time)
    light = make_light(definition, time, room)
    heights = tuple(level.height for level in levels)
    lamps = find_lamps(mesh, owners, heights, light.lamps, Style())
    area = sum((x1 - x0) * (y1 - y0) for level in levels for x0, y0, x1, y1 in level.floors)
    light = by_lamplight(light, definition.outdoor, float(lamps.color.sum()) / 3 / max(area, 1.0))
    objects = [_with_clear_spots(o, solids, levels) for o in pieces.objects]
    for k, item in enumerate(objects):
        if item.hinge is not None and item.mesh is not None:
            own = np.full(len(item.mesh.faces), item.hinge.owner, np.int32)
            objects[k] = replace(item, mesh=glazed(item.mesh, own, objects, definition, time))
    return World(
        name=definition.name,
        mesh=mesh,
        mesh_object=owners,
        mesh_wall=mesh_wall,
        objects=tuple(objects),
        solids=solids,
        walls=tuple(Wall(s.point(s.start), s.point(s.end), s.height, s.base) for s in walls),
        floors=tuple(rect for level in levels for rect in level.floors),
        light=light,
        outdoor=definition.outdoor,
        levels=levels,
        stairs=tuple(pieces.stairs),
    )


def _with_clear_spots(item: WorldObject, solids: Solids, levels: tuple[Level, ...]) -> WorldObject:
    """The object with its `stand` spots moved to free floor nearby, or left out where there is none."""
    found = (clear_spot(spot, solids, levels) if spot.name == "stand" else spot for spot in item.spots)
    return replace(item, spots=tuple(spot for spot in found if spot is not None))
