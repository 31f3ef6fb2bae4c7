"""The walls of a set's rooms.

Rooms meet in the middle of the wall they share. Every stretch between two corners becomes one wild
wall, with a face in the colour of the room on either side; openings of the rooms on both sides are
cut out of it. Over a room with another above it the wall goes up to that one's floor.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from runtime.mesh import Mesh, join
from runtime.shapes import Colour, painted

from ..lang.definitions.set import WALL_THICKNESS, Opening, Room, SetDef

SKIRTING_HEIGHT, SKIRTING_DEPTH = 0.09, 0.014
#: As thick as floors between storeys may be, metres: so far a wall goes on above its room.
SLAB = 0.8
TRIM: Colour = (0.955, 0.94, 0.9)


@dataclass(frozen=True, eq=False)
class Stretch:
    """A wall between two corners, on the line ``across`` = constant.

    axis: 0 where it runs along X, 1 along Y; across: its middle line; start, end: along the axis
    before, after: indices of the rooms on its lower and upper side, or None for the outside
    extend: metres added at each end, below zero where it stops short of its corner
    base: height of its foot
    """

    axis: int
    across: float
    start: float
    end: float
    height: float
    before: int | None
    after: int | None
    extend: tuple[float, float]
    base: float = 0.0

    def point(self, along: float) -> tuple[float, float]:
        return (along, self.across) if self.axis == 0 else (self.across, along)


@dataclass(frozen=True, eq=False)
class Cut:
    """An opening in a wall: from ``low`` to ``high`` along it, from height ``sill`` to height ``top``."""

    low: float
    high: float
    sill: float
    top: float


def wall_line(room: Room, wall: str) -> tuple[int, float, float, float]:
    """(axis, across, start, end) of one wall of a room, in the set."""
    (x, y), (w, d) = room.at[:2], room.size[:2]
    if wall in ("north", "south"):
        return 0, y + (d if wall == "north" else 0.0), x, x + w
    return 1, x + (w if wall == "east" else 0.0), y, y + d


def stretches(definition: SetDef) -> list[Stretch]:
    """All walls of a set, in a fixed order."""
    sides: _Sides = {}
    for index, room in enumerate(definition.rooms):
        if room.kind != "room":
            continue
        for wall in ("south", "north", "west", "east"):
            axis, across, start, end = wall_line(room, wall)
            side = 1 if wall in ("south", "west") else 0  # a south wall has its room on the upper side
            key = (axis, round(across, 3))
            sides.setdefault(key, []).append((round(start, 3), round(end, 3), side, index))
    found = []
    for (axis, across), parts in sorted(sides.items()):
        bases = sorted({round(definition.rooms[index].at[2], 3) for *_, index in parts})
        for k, base in enumerate(bases):
            above = bases[k + 1] if k + 1 < len(bases) else None
            found += _storey(definition, sides, (axis, across), parts, base, above)
    return found


def _reaches(room: Room, height: float) -> bool:
    """Whether a room has wall at a height, and some way above it."""
    return room.at[2] <= height + 1e-3 and room.at[2] + room.size[2] > height + 0.3


def _storey(
    definition: SetDef,
    sides: _Sides,
    line: tuple[int, float],
    every: list[tuple[float, float, int, int]],
    base: float,
    above: float | None,
) -> list[Stretch]:
    """The stretches of one line that stand on ``base`` and end below ``above``."""
    axis, across = line
    parts = [p for p in every if _reaches(definition.rooms[p[3]], base)]
    ends = sorted({e for part in parts for e in part[:2]})
    spans = []

    def _over(height: float, start: float, end: float) -> bool:
        others = ((a, b, definition.rooms[i].at[2]) for a, b, _, i in every)
        return any(abs(z - height) < 1e-3 and a < end - 1e-3 and b > start + 1e-3 for a, b, z in others)

    for start, end in pairwise(ends):
        rooms: list[int | None] = [None, None]
        for a, b, side, index in parts:
            if a <= start and end <= b:
                rooms[side] = index
        if rooms != [None, None]:
            spans.append((start, end, rooms))
    found = []
    for start, end, (before, after) in spans:
        rooms_here = [definition.rooms[i] for i in (before, after) if i is not None]
        top = max(r.at[2] + r.size[2] for r in rooms_here)
        if above is not None and (above < top or (above < top + SLAB and _over(above, start, end))):
            top = above
        extend = (
            0.0 if any(s[1] == start for s in spans) else _reach(sides, axis, across, start),
            0.0 if any(s[0] == end for s in spans) else _reach(sides, axis, across, end),
        )
        found.append(Stretch(axis, across, start, end, top - base, before, after, extend, base))
    return found


_Sides = dict[tuple[int, float], list[tuple[float, float, int, int]]]


def _reach(sides: _Sides, axis: int, across: float, end: float) -> float:
    """How far a wall goes on beyond its corner: walls along X fill the corner, those along Y and those
    that run into the side of another end at its face, so that no two faces lie in one plane."""
    others = sides.get((1 - axis, end), [])
    below = any(s < across - 1e-3 and e >= across - 1e-3 for s, e, _, _ in others)
    above = any(e > across + 1e-3 and s <= across + 1e-3 for s, e, _, _ in others)
    if not (below or above):
        return 0.0
    return WALL_THICKNESS / 2 if axis == 0 and not (below and above) else -WALL_THICKNESS / 2


def find_stretch(walls: list[Stretch], room: Room, wall: str, at: float, up: float = 0.0) -> int | None:
    """Index of the stretch a place on a room's wall belongs to; ``up``: metres above the room's floor."""
    axis, across, start, _ = wall_line(room, wall)
    height = room.at[2] + up + 1e-3
    for index, stretch in enumerate(walls):
        here = stretch.axis == axis and abs(stretch.across - across) < 1e-3
        inside = stretch.start - 1e-6 <= start + at <= stretch.end + 1e-6
        if here and inside and stretch.base <= height < stretch.base + stretch.height:
            return index
    return None


def cut_walls(walls: list[Stretch], room: Room, opening: Opening) -> list[int]:
    """Indices of the stretches an opening goes through, that of its foot first."""
    first = find_stretch(walls, room, opening.wall, opening.at, opening.sill)
    if first is None:
        return []
    one, cut = walls[first], cut_of(room, opening)
    others = [
        k
        for k, s in enumerate(walls)
        if k != first
        and (s.axis, s.across, s.start, s.end) == (one.axis, one.across, one.start, one.end)
        and s.base < cut.top - 1e-3
        and s.base + s.height > cut.sill + 1e-3
    ]
    return [first, *others]


def cut_of(room: Room, opening: Opening) -> Cut:
    """What an opening takes out of its wall."""
    start = wall_line(room, opening.wall)[2]
    middle, sill = start + opening.at, room.at[2] + opening.sill
    return Cut(middle - opening.width / 2, middle + opening.width / 2, sill, sill + opening.height)


def wall_pieces(stretch: Stretch, cuts: list[Cut]) -> list[tuple[float, float, float, float]]:
    """The wall without its openings: (low, high, bottom, top) rectangles."""
    pieces = []
    base, crown = stretch.base, stretch.base + stretch.height
    position = stretch.start - stretch.extend[0]
    for cut in sorted(cuts, key=lambda c: c.low):
        low, high = max(cut.low, position), max(cut.high, position)
        if low > position + 1e-6:
            pieces.append((position, low, base, crown))
        if high > low:
            if cut.sill > base + 1e-6:
                pieces.append((low, high, base, min(cut.sill, crown)))
            if cut.top < crown - 1e-6:
                pieces.append((low, high, max(cut.top, base), crown))
        position = high
    last = stretch.end + stretch.extend[1]
    if position < last - 1e-6:
        pieces.append((position, last, base, crown))
    return pieces


def wall_mesh(
    stretch: Stretch,
    cuts: list[Cut],
    colors: tuple[Colour, Colour],
    parts: tuple[int, int, int],
    materials: tuple[str, str] = ("plaster", "plaster"),
) -> Mesh:
    """The wall's two faces, its cut edges and its top.

    colors, parts, materials: of the face on the lower and the upper side; the third part is that of the edges
    """
    half = WALL_THICKNESS / 2
    meshes = []
    for low, high, bottom, top in wall_pieces(stretch, cuts):
        for side in (0, 1):
            across = stretch.across + (half if side else -half)
            corners = [(low, across, bottom), (high, across, bottom), (high, across, top), (low, across, top)]
            facing = (0, 1 if side else -1, 0)
            meshes.append(
                _quad(stretch.axis, corners, facing, colors[side], parts[side], material=materials[side])
            )
        a, b = stretch.across - half, stretch.across + half
        edges = [([(low, a, top), (high, a, top), (high, b, top), (low, b, top)], (0, 0, 1))]
        if bottom > stretch.base:
            under = [(low, a, bottom), (high, a, bottom), (high, b, bottom), (low, b, bottom)]
            edges.append((under, (0, 0, -1)))
        meshes += [_quad(stretch.axis, corners, normal, TRIM, parts[2]) for corners, normal in edges]
        for end, sign in ((low, -1), (high, 1)):
            meshes.append(_end(stretch, end, sign, bottom, top, colors, parts[2]))
    return join(meshes)


def _end(
    stretch: Stretch,
    at: float,
    sign: int,
    bottom: float,
    top: float,
    colors: tuple[Colour, Colour],
    part: int,
) -> Mesh:
    """The end of a piece of wall: a reveal, an outer corner, or a joint.

    A joint lies a little inside, so that it never is in one plane with the side of the wall it meets. It is
    as wide as the wall and coloured between its sides, for it is seen where that one is taken away.
    """
    corner = stretch.start - stretch.extend[0] if sign < 0 else stretch.end + stretch.extend[1]
    outer = abs(at - corner) < 1e-6
    inset = 0.004 if outer and stretch.extend[0 if sign < 0 else 1] <= 0 else 0.0
    color = TRIM if not outer else colors[0] if stretch.before is None else colors[1]
    if outer and stretch.before is not None and stretch.after is not None:
        red, green, blue = ((x + y) / 2 for x, y in zip(*colors, strict=True))
        color = (red, green, blue)
    a, b = stretch.across - WALL_THICKNESS / 2, stretch.across + WALL_THICKNESS / 2
    at -= sign * inset
    corners = [(at, a, bottom), (at, b, bottom), (at, b, top), (at, a, top)]
    return _quad(stretch.axis, corners, (sign, 0, 0), color, part)


def skirting(stretch: Stretch, cuts: list[Cut], side: int, clip: tuple[float, float], part: int) -> Mesh:
    """A board along the foot of one side, within ``clip`` (the room's inside)."""
    half = WALL_THICKNESS / 2
    sign, foot = 1 if side else -1, stretch.base
    near = stretch.across + sign * half
    far = near + sign * SKIRTING_DEPTH
    meshes = []
    for low, high, bottom, _ in wall_pieces(stretch, cuts):
        low, high = max(low, clip[0]), min(high, clip[1])
        if bottom > foot or high - low < 0.02:
            continue
        h = foot + SKIRTING_HEIGHT
        front = [(low, far, foot), (high, far, foot), (high, far, h), (low, far, h)]
        top = [(low, near, h), (high, near, h), (high, far, h), (low, far, h)]
        meshes.append(_quad(stretch.axis, front, (0, sign, 0), TRIM, part))
        # lit like its front: a lip this thin is no edge of its own in a picture
        meshes.append(_quad(stretch.axis, top, (0, 0, 1), TRIM, part, (0, sign, 0)))
        for end, normal in ((low, -1), (high, 1)):
            cap = [(end, near, foot), (end, far, foot), (end, far, h), (end, near, h)]
            meshes.append(_quad(stretch.axis, cap, (normal, 0, 0), TRIM, part))
    return join(meshes)


def _quad(
    axis: int,
    corners: list[tuple[float, float, float]],
    normal: tuple[int, int, int],
    color: Colour,
    part: int,
    shading: tuple[int, int, int] | None = None,
    material: str = "plain",
) -> Mesh:
    """Four corners given as (along, across, up), facing ``normal`` in the same terms."""
    points = np.array(corners, np.float64)
    facing, lit = np.array(normal, np.float64), np.array(shading or normal, np.float64)
    if axis == 1:
        points, facing, lit = points[:, [1, 0, 2]], facing[[1, 0, 2]], lit[[1, 0, 2]]
    order: NDArray[np.int64] = np.array([[0, 1, 2], [0, 2, 3]])
    if np.cross(points[1] - points[0], points[2] - points[0]) @ facing < 0:
        order = order[:, ::-1]
    return painted(points, order, np.tile(lit, (4, 1)), color, material, part)
