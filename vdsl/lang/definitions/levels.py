"""Floors at heights: stairs that join them, and platforms in a room.

Assumes parsed entries of a set or a room. Lengths are metres, angles radians. What is read here is in the
set's coordinates, heights included.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

from runtime.materials import MATERIALS

from ..diagnostics import Report, nearest
from ..source import Span
from .colours import Colour, checked_colour
from .placing import WALLS, Placed, placed_node, read_standing
from .primitives import Point
from .prop import PropSpot
from .reader import Reader
from .types import SetNode

#: A step a person takes without thinking, metres.
RISE, RUN = 0.17, 0.28
#: Higher than this nobody steps.
HIGHEST_RISE = 0.4


@dataclass(frozen=True)
class Flight:
    """``stairs NAME, at (x, y), turn 90deg, width 1m, to landing``: a straight flight.

    at: middle of the foot of its first riser, x, y, z; turn: 0 climbs north, as a prop's back lies
    height: of the whole flight, 0 where it is that of the room ``to`` until it is settled
    rise: about how high a step is; run: depth of a tread
    path: names from the set's root
    """

    path: tuple[str, ...]
    at: Point
    turn: float
    width: float
    height: float
    rise: float
    run: float
    color: Colour
    material: str
    to: str | None
    span: Span = field(compare=False, repr=False)

    @property
    def steps(self) -> int:
        """How many risers, all of one height."""
        return max(1, round(self.height / self.rise))


@dataclass(frozen=True)
class Platform:
    """``platform stage, at (x, y), size (6, 3, 0.6)m, steps south``: a floor raised in a room.

    at: south-west corner, x, y and the height of its floor; size: x, y and how high it stands over the room
    steps: sides with steps along them
    """

    path: tuple[str, ...]
    at: Point
    size: Point
    floor: str
    floor_color: Colour
    color: Colour
    steps: tuple[str, ...]
    rise: float
    run: float
    placed: tuple[Placed, ...]
    spots: tuple[PropSpot, ...]
    span: Span = field(compare=False, repr=False)

    def flights(self) -> tuple[Flight, ...]:
        """Its steps as stairs, one for each side that has them."""
        (x, y, z), (w, d, h) = self.at, self.size
        reach = (max(1, round(h / self.rise)) - 1) * self.run
        feet = {
            "south": (x + w / 2, y - reach, 0.0, w),
            "north": (x + w / 2, y + d + reach, math.pi, w),
            "west": (x - reach, y + d / 2, -math.pi / 2, d),
            "east": (x + w + reach, y + d / 2, math.pi / 2, d),
        }
        found = []
        for side in self.steps:
            fx, fy, turn, width = feet[side]
            where, path = (fx, fy, z - h), (*self.path, f"steps_{side}")
            look = (self.rise, self.run, self.color, self.floor, None, self.span)
            found.append(Flight(path, where, turn, width, h, *look))
        return tuple(found)


def read_flight(reader: Reader, path: tuple[str, ...], corner: Point) -> Flight | None:
    """A flight of stairs; ``corner``: where the coordinates of its room begin. Height 0: that of ``to``."""
    name = reader.value_word(0, "stairs")
    at = reader.point("at", (0.0, 0.0))
    turn = reader.angle("turn", 0.0)
    width = reader.length("width", 1.0)
    height = reader.length("height", None)
    to = reader.word("to", None)
    rise, run = reader.length("rise", RISE), reader.length("run", RUN)
    material = reader.word("material", "wood", MATERIALS)
    written = reader.colour("color", "oak")
    color = checked_colour(written, reader.span, reader.report)
    reader.done()
    if (height is None) == (to is None):
        reader.missing("either `to`, the room above, or a `height`")
        return None
    if min(width, rise, run, 1.0 if height is None else height) <= 0:
        reader.report.error("VDS101", reader.span, label="a size here is zero or less")
        return None
    where = tuple(a + b for a, b in zip(corner, (*at, 0.0)[:3], strict=True))
    return Flight(
        (*path, name), where, turn, width, height or 0.0, rise, run, color, material, to, reader.span
    )


def settled(flight: Flight, floors: dict[str, float], report: Report) -> Flight | None:
    """The flight with the height of the room it leads to; ``floors``: height of each room's floor."""
    if flight.to is not None and flight.to not in floors:
        label = f"there is no room `{flight.to}`"
        report.error("VDS241", flight.span, label=label, suggestion=nearest(flight.to, floors))
        return None
    if flight.to is not None:
        flight = replace(flight, height=floors[flight.to] - flight.at[2])
    if flight.height <= 0:
        report.error("VDS241", flight.span, label=f"`{flight.to}` is no higher than these stairs begin")
        return None
    if flight.height / flight.steps > HIGHEST_RISE:
        label = f"a step of {flight.height / flight.steps:.2g} m is too high"
        report.error("VDS241", flight.span, label=label)
        return None
    return flight


def read_platform(reader: Reader, path: tuple[str, ...], corner: Point) -> Platform | None:
    """A platform with what stands on it; in its braces (0, 0) is its south-west corner."""
    name = reader.value_word(0, "platform")
    at = reader.point("at", (0.0, 0.0), 2)
    size = reader.point("size", (), 3)
    floor = reader.word("floor", "wood", MATERIALS)
    floor_color = checked_colour(reader.colour("floor-color", "oak"), reader.span, reader.report)
    color = checked_colour(reader.colour("color", "walnut"), reader.span, reader.report)
    steps = tuple(w for w in reader.words("steps") if _is_side(w, reader))
    rise, run = reader.length("rise", RISE), reader.length("run", RUN)
    body = reader.body()
    reader.done()
    if not size:
        reader.missing("`size`, as in `size (6, 3, 0.6)m`")
        return None
    if min(*size, rise, run) <= 0:
        reader.report.error("VDS101", reader.span, label="a size here is zero or less")
        return None
    placed, spots = read_standing(body, reader, "a platform", parent=False)
    x, y, z = corner
    return Platform(
        (*path, name), (x + at[0], y + at[1], z + size[2]), size, floor, floor_color, color, steps,
        rise, run, placed, spots, reader.span,
    )  # fmt: skip


def _is_side(word: str, reader: Reader) -> bool:
    if word in WALLS:
        return True
    label = f"`{word}` is no side of it"
    reader.report.error("VDS241", reader.span, label=label, suggestion=nearest(word, WALLS))
    return False


def flight_node(flight: Flight) -> SetNode:
    """Its place in the tree of names."""
    return SetNode(flight.path[-1], "part", None, ("foot", "head"), (), flight.span)


def platform_node(platform: Platform) -> SetNode:
    """Its place in the tree of names, with what stands on it."""
    spots = tuple(dict.fromkeys(s.name for s in platform.spots))
    children = tuple(map(placed_node, platform.placed))
    return SetNode(platform.path[-1], "area", None, spots, children, platform.span)
