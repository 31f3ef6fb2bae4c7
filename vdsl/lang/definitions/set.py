"""Sets: rooms and areas, what is in their walls and what stands in them.

Assumes a parsed definition. :func:`read_set` needs nothing else and makes the tree of names;
:func:`check_set` looks up the props it places. Lengths are metres, angles radians. A room's `at` is
its south-west corner in the set; what is in a room is placed in the room's coordinates, and what is
on a prop in that prop's.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from runtime.materials import MATERIALS

from .. import ast
from ..diagnostics import Report, listing, nearest
from ..evaluate import Bound
from ..source import Span
from .colours import Colour, checked_colour
from .levels import Flight, Platform, flight_node, platform_node, read_flight, read_platform, settled
from .placing import (
    WALLS,
    Placed,
    PropCatalog,
    call_arguments,
    check_names,
    find_prop,
    numbered,
    placed_node,
    read_call,
    read_placed,
    walk_placed,
)
from .primitives import Point
from .prop import PropDef, PropSpot, read_spot, unrolled
from .reader import Reader, unknown_entry
from .types import DefinitionBase, SetNode

TIMES = ("dawn", "day", "dusk", "night")
#: Where a set's light comes from, whatever the hour: windows and sky, or lamps of a mood.
LIGHTS = ("daylight", "lamps", "cool", "warm", "dim")
OPENINGS = ("door", "window", "doorway")
SET_ENTRIES = ("time", "light", "facade", "ground", "room", "area", "stairs", "repeat")
ROOM_ENTRIES = (*OPENINGS, "place", "spot", "platform", "stairs", "repeat")
AREA_ENTRIES = ("place", "spot", "platform", "stairs", "repeat")
#: Thickness of a wall; rooms that share a wall meet in its middle.
WALL_THICKNESS = 0.12

_DOOR_SIZE = {"door": (0.88, 2.05, 0.0), "doorway": (1.2, 2.1, 0.0), "window": (1.4, 1.3, 0.9)}


@dataclass(frozen=True)
class Opening:
    """A door, a doorway or a window in a wall of a room.

    at: its middle, metres from the wall's west or south end; to: the room behind it, where said
    turn: how far a door stands open, radians
    """

    name: str
    kind: str
    call: ast.Call = field(compare=False, repr=False)
    env: Mapping[str, Bound] = field(compare=False, repr=False)
    wall: str
    at: float
    width: float
    height: float
    sill: float
    turn: float
    to: str | None
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True)
class Room:
    """A room (with walls) or an area (outdoors, without).

    at: south-west corner and height of the floor; size: x, y, height
    walls: material of its walls; open: without a ceiling, under the sky
    """

    name: str
    kind: str
    at: Point
    size: Point
    floor: str
    floor_color: Colour
    wall_color: Colour
    walls: str
    open: bool
    openings: tuple[Opening, ...]
    placed: tuple[Placed, ...]
    spots: tuple[PropSpot, ...]
    platforms: tuple[Platform, ...]
    flights: tuple[Flight, ...]
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True)
class SetDef(DefinitionBase):
    """A set as defined. ``root`` is its tree of names; ``light``: one of :data:`LIGHTS`; ``facade``
    colours walls outside; ``ground`` and ``earth`` are colour and material of the land around an
    outdoor set, ``deep`` metres below its floors; ``flights``: its stairs, those of rooms aside."""

    root: SetNode
    outdoor: bool
    time: str
    light: str
    rooms: tuple[Room, ...]
    facade: Colour
    ground: Colour
    earth: str
    deep: float
    flights: tuple[Flight, ...] = ()


def read_set(definition: ast.Definition, report: Report) -> SetDef | None:
    """Check a set by itself: all but the props it places."""
    if definition.parameters:
        report.error("VDS110", definition.parameters[0].span, label="a set has no parameters")
    time, light, rooms = "day", LIGHTS[0], []
    flights: list[Flight] = []
    facade, ground, earth, deep = (0.89, 0.86, 0.8), (0.77, 0.8, 0.7), "grass", 0.06
    for entry, env in unrolled(definition.body, {}, report):
        reader = Reader(entry, env, report)
        if reader.head == "time":
            time = reader.value_word(0, "day", TIMES)
            reader.done()
        elif reader.head == "light":
            light = reader.value_word(0, LIGHTS[0], LIGHTS)
            reader.done()
        elif reader.head in ("facade", "ground"):
            got = checked_colour(reader.value_word(0), entry.span, report)
            facade, ground = (got, ground) if reader.head == "facade" else (facade, got)
            if reader.head == "ground":
                earth, deep = reader.word("material", earth, MATERIALS), reader.length("deep", deep)
            reader.done()
        elif reader.head in ("room", "area"):
            room = _room(reader)
            if room is not None:
                rooms.append(room)
        elif reader.head == "stairs":
            flight = read_flight(reader, (), (0.0, 0.0, 0.0))
            flights += [flight] if flight is not None else []
        else:
            unknown_entry(entry, SET_ENTRIES, "a set", report)
    if not rooms:
        report.error("VDS111", definition.name.span, label="this set has no `room` and no `area`")
        return None
    check_names([(r.name, r.span) for r in rooms] + [(f.path[-1], f.span) for f in flights], report)
    _check_walls(rooms, report)
    floors = {r.name: r.at[2] for r in rooms}
    rooms = [replace(r, flights=_settled(r.flights, floors, report)) for r in rooms]
    outside = _settled(tuple(flights), floors, report)
    name = definition.name.text
    nodes = (*(_room_node(r) for r in rooms), *map(flight_node, outside))
    root = SetNode(name, "set", None, (), nodes, definition.span)
    outdoor = all(r.open for r in rooms)
    land = (facade, ground, earth, deep)
    return SetDef(name, (), definition.span, root, outdoor, time, light, tuple(rooms), *land, outside)


def _settled(flights: tuple[Flight, ...], floors: dict[str, float], report: Report) -> tuple[Flight, ...]:
    found = (settled(f, floors, report) for f in flights)
    return tuple(f for f in found if f is not None)


# --- reading ------------------------------------------------------------------------


def _room(reader: Reader) -> Room | None:
    entry, report, kind = reader.entry, reader.report, reader.head
    default_floor, default_color = ("wood", "oak") if kind == "room" else ("grass", "moss")
    name = reader.value_word(0)
    at = reader.point("at", (0.0, 0.0))
    size = reader.point("size", (), 3 if kind == "room" else 2)
    floor = reader.word("floor", default_floor, MATERIALS)
    floor_color = checked_colour(reader.colour("floor-color", default_color), entry.span, report)
    wall_color = checked_colour(reader.colour("wall-color", "#efe9dc"), entry.span, report)
    walls = reader.word("wall", "plaster", MATERIALS) if kind == "room" else "plaster"
    is_open = kind == "area" or not reader.flag("ceiling", True)
    body = reader.body()
    reader.done()
    if not size:
        reader.missing(
            "`size`, as in `size (4, 3, 2.6)m`" if kind == "room" else "`size`, as in `size (20, 8)m`"
        )
        return None
    if min(size) <= 0:
        report.error("VDS101", entry.span, label="a size here is zero or less")
        return None
    if len(at) not in (2, 3):
        report.error("VDS032", entry.span, label="`at` is (x, y), or (x, y, height)")
    corner = (at[0], at[1], at[2] if len(at) == 3 else 0.0) if len(at) > 1 else (0.0, 0.0, 0.0)
    openings: list[Opening] = []
    platforms: list[Platform] = []
    flights: list[Flight] = []
    placed: list[Placed] = []
    spots: list[PropSpot] = []
    for child, env in unrolled(body, reader.env, report):
        inner = Reader(child, env, report)
        if inner.head in OPENINGS and kind == "room":
            opening = _opening(inner)
            if opening is not None:
                openings.append(opening)
        elif inner.head == "place":
            item = read_placed(inner, parent=False)
            if item is not None:
                placed.append(item)
        elif inner.head == "spot":
            spots.append(read_spot(inner, 2))
        elif inner.head == "platform":
            platform = read_platform(inner, (name,), corner)
            platforms += [platform] if platform is not None else []
        elif inner.head == "stairs":
            flight = read_flight(inner, (name,), corner)
            flights += [flight] if flight is not None else []
        else:
            known, where = (ROOM_ENTRIES, "a room") if kind == "room" else (AREA_ENTRIES, "an area")
            unknown_entry(child, known, where, report)
    placed = numbered(placed)
    named = [(o.name, o.span) for o in openings] + [(p.name, p.span) for p in placed]
    named += [(p.path[-1], p.span) for p in platforms] + [(f.path[-1], f.span) for f in flights]
    check_names(named, report)
    full = size if len(size) == 3 else (*size, 0.0)
    span = entry.head.span.to(entry.values[0].span) if entry.values else entry.span
    shell = (floor_color, wall_color, walls, is_open)
    levels = (tuple(platforms), tuple(flights))
    return Room(
        name, kind, corner, full, floor, *shell, tuple(openings), tuple(placed), tuple(spots), *levels, span
    )


def _opening(reader: Reader) -> Opening | None:
    kind = reader.head
    width, height, sill = _DOOR_SIZE[kind]
    name = reader.value_word(0, kind)
    call = read_call(reader, kind)
    if not reader.entry.bound:
        call = ast.Call(ast.Name((kind,), reader.entry.head.span), (), reader.entry.head.span)
    wall = reader.word("wall", "", WALLS)
    if not wall and not reader.has("wall"):
        reader.missing(f"`wall`: {listing(WALLS)}")
    at = reader.length("at", None)
    if at is None:
        reader.missing("`at`, its middle measured from the wall's west or south end")
    width = reader.length("width", width)
    height = reader.length("height", height)
    sill = reader.length("sill", sill) if kind == "window" else 0.0
    turn = reader.angle("open", 0.0) if kind == "door" else 0.0
    to = reader.word("to", None)
    reader.done()
    if not wall or at is None:
        return None
    if min(width, height) <= 0 or sill < 0:
        reader.report.error("VDS101", reader.span, label="a size here is zero or less")
        return None
    return Opening(name, kind, call, reader.env, wall, at, width, height, sill, turn, to, reader.span)


def _room_node(room: Room) -> SetNode:
    spots = tuple(dict.fromkeys(s.name for s in room.spots))
    parts = [SetNode(o.name, "part", o.call.callee.text, (), (), o.span) for o in room.openings]
    parts += [*map(platform_node, room.platforms), *map(flight_node, room.flights)]
    return SetNode(room.name, room.kind, None, spots, (*parts, *map(placed_node, room.placed)), room.span)


# --- checking -----------------------------------------------------------------------


def wall_length(room: Room, wall: str) -> float:
    """Length of a room's wall, metres."""
    return room.size[0] if wall in ("north", "south") else room.size[1]


def _check_walls(rooms: list[Room], report: Report) -> None:
    names = [r.name for r in rooms]
    for room in rooms:
        for opening in room.openings:
            length = wall_length(room, opening.wall)
            if opening.at - opening.width / 2 < 0.05 or opening.at + opening.width / 2 > length - 0.05:
                label = f"this reaches beyond the {opening.wall} wall, which is {length:g} m long"
                report.error("VDS113", opening.span, label=label)
            if opening.sill + opening.height > room.size[2] - 0.02:
                label = f"this is higher than the room, which is {room.size[2]:g} m"
                report.error("VDS113", opening.span, label=label)
            if opening.to is not None and opening.to not in names:
                label = f"there is no room `{opening.to}`"
                report.error("VDS114", opening.span, label=label, suggestion=nearest(opening.to, names))
            elif opening.to is not None and not _behind(room, opening, rooms[names.index(opening.to)]):
                label = f"`{opening.to}` is not behind the {opening.wall} wall here"
                report.error("VDS114", opening.span, label=label)


def _behind(room: Room, opening: Opening, other: Room) -> bool:
    """Whether ``other`` lies on the far side of the opening."""
    i = 0 if opening.wall in ("north", "south") else 1
    far = room.at[1 - i] + (room.size[1 - i] if opening.wall in ("north", "east") else 0.0)
    near = other.at[1 - i] + (0.0 if opening.wall in ("north", "east") else other.size[1 - i])
    middle = room.at[i] + opening.at
    inside = (
        other.at[i] < middle - opening.width / 2 and middle + opening.width / 2 < other.at[i] + other.size[i]
    )
    return abs(far - near) < 1e-3 and abs(room.at[2] - other.at[2]) < 1e-3 and inside


def check_set(definition: SetDef, catalog: PropCatalog, report: Report) -> None:
    """Look up every prop of the set: unknown ones, wrong arguments, missing spots."""
    for room in definition.rooms:
        for opening in room.openings:
            prop = find_prop(opening.call, catalog, report)
            if prop is not None:
                call_arguments(opening.call, opening.env, prop, report)
        standing = (*room.placed, *(p for platform in room.platforms for p in platform.placed))
        for item, parent in walk_placed(standing):
            prop = find_prop(item.call, catalog, report)
            if prop is not None:
                call_arguments(item.call, item.env, prop, report)
            if parent is None or item.on is None:
                continue
            under = catalog.get("prop", parent.prop)
            spots = {s.name for s in parent.spots} | set(under.spots if isinstance(under, PropDef) else ())
            if item.on not in spots:
                report.error(
                    "VDS116", item.on_span, label=f"`{parent.name}` has no spot `{item.on}`",
                    help=f"it has {listing(sorted(spots))}" if spots else "it has no spots",
                    suggestion=nearest(item.on, spots),
                )  # fmt: skip
