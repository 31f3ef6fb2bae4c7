"""Sets: rooms and areas, what is in their walls and what stands in them.

Assumes a parsed definition. :func:`read_set` needs nothing else and makes the tree of names;
:func:`check_set` looks up the props it places. Lengths are metres, angles radians. A room's `at` is
its south-west corner in the set; what is in a room is placed in the room's coordinates, and what is
on a prop in that prop's.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Protocol

from .. import ast
from ..diagnostics import Report, listing, nearest
from ..evaluate import Bound, evaluate_arguments
from ..source import Span
from .colours import Colour, checked_colour, colour
from .prop import MATERIALS, Point, PropDef, PropSpot, read_spot, unrolled
from .reader import Reader, unknown_entry
from .types import DefinitionBase, SetNode

WALLS = ("north", "south", "east", "west")
TIMES = ("dawn", "day", "dusk", "night")
OPENINGS = ("door", "window", "doorway")
SET_ENTRIES = ("time", "facade", "ground", "room", "area", "repeat")
ROOM_ENTRIES = (*OPENINGS, "place", "spot", "repeat")
PLACE_ENTRIES = ("place", "spot", "repeat")
#: Thickness of a wall; rooms that share a wall meet in its middle.
WALL_THICKNESS = 0.12

_DOOR_SIZE = {"door": (0.88, 2.05, 0.0), "doorway": (1.2, 2.1, 0.0), "window": (1.4, 1.3, 0.9)}


class PropCatalog(Protocol):
    """What is needed of the library."""

    def names(self, kind: str) -> object: ...
    def get(self, kind: str, name: str) -> object: ...


@dataclass(frozen=True)
class Placed:
    """``place table = table(width 1.3m), at (2, 1)m, turn 90deg { … }``.

    at: x, y in the room (or in the parent prop, from its spot ``on``); up: metres above that floor
    wall: the prop's back is put against it, and ``at`` is one number, along it from its west or south end
    call: the prop and its arguments as written; env: names these may use
    """

    name: str
    call: ast.Call = field(compare=False, repr=False)
    env: Mapping[str, Bound] = field(compare=False, repr=False)
    at: Point
    up: float
    turn: float
    wall: str | None
    on: str | None
    spots: tuple[PropSpot, ...]
    children: tuple[Placed, ...]
    span: Span = field(compare=False, repr=False)
    on_span: Span = field(compare=False, repr=False)

    @property
    def prop(self) -> str:
        return self.call.callee.text


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
    """A room (with walls) or an area (outdoors, without). at: south-west corner; size: x, y, height."""

    name: str
    kind: str
    at: Point
    size: Point
    floor: str
    floor_color: Colour
    wall_color: Colour
    openings: tuple[Opening, ...]
    placed: tuple[Placed, ...]
    spots: tuple[PropSpot, ...]
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True)
class SetDef(DefinitionBase):
    """A set as defined. ``root`` is its tree of names; ``facade`` colours walls outside; ``ground`` is
    the colour of the earth around an outdoor set."""

    root: SetNode
    outdoor: bool
    time: str
    rooms: tuple[Room, ...]
    facade: Colour
    ground: Colour


def read_set(definition: ast.Definition, report: Report) -> SetDef | None:
    """Check a set by itself: all but the props it places."""
    if definition.parameters:
        report.error("VDS110", definition.parameters[0].span, label="a set has no parameters")
    time, rooms = "day", []
    facade, ground = (0.89, 0.86, 0.8), (0.77, 0.8, 0.7)
    for entry, env in unrolled(definition.body, {}, report):
        reader = Reader(entry, env, report)
        if reader.head == "time":
            time = reader.value_word(0, "day", TIMES)
            reader.done()
        elif reader.head in ("facade", "ground"):
            got = checked_colour(reader.value_word(0), entry.span, report)
            facade, ground = (got, ground) if reader.head == "facade" else (facade, got)
            reader.done()
        elif reader.head in ("room", "area"):
            room = _room(reader)
            if room is not None:
                rooms.append(room)
        else:
            unknown_entry(entry, SET_ENTRIES, "a set", report)
    if not rooms:
        report.error("VDS111", definition.name.span, label="this set has no `room` and no `area`")
        return None
    _check_names([(r.name, r.span) for r in rooms], report)
    _check_walls(rooms, report)
    name = definition.name.text
    root = SetNode(name, "set", None, (), tuple(_room_node(r) for r in rooms), definition.span)
    outdoor = all(r.kind == "area" for r in rooms)
    return SetDef(name, (), definition.span, root, outdoor, time, tuple(rooms), facade, ground)


# --- reading ------------------------------------------------------------------------


def _room(reader: Reader) -> Room | None:
    entry, report, kind = reader.entry, reader.report, reader.head
    default_floor, default_color = ("wood", "oak") if kind == "room" else ("grass", "moss")
    name = reader.value_word(0)
    at = reader.point("at", (0.0, 0.0), 2)
    size = reader.point("size", (), 3 if kind == "room" else 2)
    floor = reader.word("floor", default_floor, MATERIALS)
    floor_color = checked_colour(reader.colour("floor-color", default_color), entry.span, report)
    wall_color = checked_colour(reader.colour("wall-color", "#efe9dc"), entry.span, report)
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
    openings: list[Opening] = []
    placed: list[Placed] = []
    spots: list[PropSpot] = []
    for child, env in unrolled(body, reader.env, report):
        inner = Reader(child, env, report)
        if inner.head in OPENINGS and kind == "room":
            opening = _opening(inner)
            if opening is not None:
                openings.append(opening)
        elif inner.head == "place":
            item = _placed(inner, parent=False)
            if item is not None:
                placed.append(item)
        elif inner.head == "spot":
            spots.append(read_spot(inner, 2))
        else:
            known, where = (ROOM_ENTRIES, "a room") if kind == "room" else (PLACE_ENTRIES, "an area")
            unknown_entry(child, known, where, report)
    placed = _numbered(placed)
    _check_names([(o.name, o.span) for o in openings] + [(p.name, p.span) for p in placed], report)
    full = size if len(size) == 3 else (*size, 0.0)
    span = entry.head.span.to(entry.values[0].span) if entry.values else entry.span
    colors = (floor_color, wall_color)
    return Room(name, kind, at, full, floor, *colors, tuple(openings), tuple(placed), tuple(spots), span)


def _call(reader: Reader, default: str) -> ast.Call:
    if not reader.entry.bound:
        name = ast.Name((default,), reader.entry.head.span)
        if reader.entry.values:
            name = ast.Name((default,), reader.entry.values[0].span)
        return ast.Call(name, (), name.span)
    return reader.bound_call() or ast.Call(ast.Name((default,), reader.span), (), reader.span)


def _opening(reader: Reader) -> Opening | None:
    kind = reader.head
    width, height, sill = _DOOR_SIZE[kind]
    name = reader.value_word(0, kind)
    call = _call(reader, kind)
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


def _placed(reader: Reader, parent: bool) -> Placed | None:
    name = reader.value_word(0)
    call = _call(reader, name)
    wall = None if parent else reader.word("wall", None, WALLS)
    on = reader.word("on", None) if parent else None
    if wall is None:
        at = reader.point("at", (0.0, 0.0), 2)
    else:
        along = reader.length("at", None)
        if along is None:
            reader.missing("`at`, its middle measured from the wall's west or south end")
        at = (along or 0.0,)
    up = reader.length("up", 0.0)
    turn = reader.angle("turn", 0.0)
    body = reader.body()
    reader.done()
    spots: list[PropSpot] = []
    children: list[Placed] = []
    for child, env in unrolled(body, reader.env, reader.report):
        inner = Reader(child, env, reader.report)
        if inner.head == "place":
            item = _placed(inner, parent=True)
            if item is not None:
                children.append(item)
        elif inner.head == "spot":
            spots.append(read_spot(inner, 3))
        else:
            unknown_entry(child, PLACE_ENTRIES, "a placed prop", reader.report)
    if not name:
        return None
    children = _numbered(children)
    _check_names([(c.name, c.span) for c in children], reader.report)
    on_span = next((o.span for o in reader.entry.options if o.name.text == "on"), reader.span)
    return Placed(
        name, call, reader.env, at, up, turn, wall, on, tuple(spots), tuple(children), reader.span, on_span
    )


def _room_node(room: Room) -> SetNode:
    spots = tuple(dict.fromkeys(s.name for s in room.spots))
    parts = [SetNode(o.name, "part", o.call.callee.text, (), (), o.span) for o in room.openings]
    return SetNode(room.name, room.kind, None, spots, (*parts, *map(_placed_node, room.placed)), room.span)


def _placed_node(item: Placed) -> SetNode:
    spots = tuple(dict.fromkeys(s.name for s in item.spots))
    return SetNode(item.name, "object", item.prop, spots, tuple(map(_placed_node, item.children)), item.span)


# --- checking -----------------------------------------------------------------------


def _numbered(items: list[Placed]) -> list[Placed]:
    """What a ``repeat`` places again and again is called tree, tree_2, tree_3 …"""
    count: dict[int, int] = {}
    found = []
    for item in items:
        count[item.span.start] = times = count.get(item.span.start, 0) + 1
        found.append(item if times == 1 else replace(item, name=f"{item.name}_{times}"))
    return found


def _check_names(named: list[tuple[str, Span]], report: Report) -> None:
    seen: dict[str, Span] = {}
    for name, span in named:
        if name in seen:
            report.error(
                "VDS112", span, label=f"`{name}` is already here", notes=[(seen[name], "the first one")]
            )
        elif name:
            seen[name] = span


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
    return abs(far - near) < 1e-3 and inside


def walk_placed(
    items: tuple[Placed, ...], parent: Placed | None = None
) -> Iterator[tuple[Placed, Placed | None]]:
    """Every placed prop with the one it stands on."""
    for item in items:
        yield item, parent
        yield from walk_placed(item.children, item)


def check_set(definition: SetDef, catalog: PropCatalog, report: Report) -> None:
    """Look up every prop of the set: unknown ones, wrong arguments, missing spots."""
    for room in definition.rooms:
        for opening in room.openings:
            prop = find_prop(opening.call, catalog, report)
            if prop is not None:
                call_arguments(opening.call, opening.env, prop, report)
        for item, parent in walk_placed(room.placed):
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


def find_prop(call: ast.Call, catalog: PropCatalog, report: Report) -> PropDef | None:
    """The prop a call names, or None where it was reported to be unknown."""
    name = call.callee.text
    names = [str(n) for n in catalog.names("prop")]  # type: ignore[attr-defined]
    found = catalog.get("prop", name) if name in names else None
    if isinstance(found, PropDef):
        return found
    if name not in names:
        meant = nearest(name, names)
        report.error(
            "VDS115", call.callee.span, label=f"there is no prop `{name}`", suggestion=meant, fix=meant
        )
    return None


def call_arguments(
    call: ast.Call, env: Mapping[str, Bound], prop: PropDef, report: Report
) -> dict[str, float | str]:
    """The arguments of a placed prop; lengths below zero are reported and left out."""
    found = evaluate_arguments(call.arguments, prop.parameters, env, report, prop.name)
    kinds = {spec.name: spec for spec in prop.parameters}
    for argument in call.arguments:
        value = found.get(argument.name.text)
        spec = kinds.get(argument.name.text)
        if spec is None or value is None:
            continue
        if spec.kind == "length" and isinstance(value, float) and value < 0:
            report.error("VDS101", argument.span, label=f"`{spec.name}` is below zero")
            del found[spec.name]
        elif isinstance(value, str) and colour(str(spec.default)) is not None:
            checked_colour(value, argument.values[0].span, report)
    return found
