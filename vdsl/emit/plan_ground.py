"""What a plan shows of a shot: the room cut at breast height, who moves where, and from where it is filmed.

Assumes a world as it is built, and tracks in its coordinates (metres, Z up, +Y north). Guarantees frozen
values from which a plan can be drawn without the world; nothing here draws.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from runtime.world import World, WorldObject

from ..cinema.track import CameraTrack
from .types import BuiltShot, Walk

Point = tuple[float, float]
Box = tuple[float, float, float, float]

#: Metres above the floor at which walls are cut, as architects do: above sills, below lintels.
CUT = 1.2
#: What hangs higher than this, or lies on another floor, is not on the plan.
_REACH = (-0.6, 1.7)
#: A room no longer than this is shown whole; of a larger place, what surrounds the action.
_WHOLE = 12.0
_AROUND = 1.4
_LEAST = 5.0
_PLACES = ("room", "area")
_OPENINGS = {"door": "door", "doorway": "door", "window": "window"}
_BUILT = (*_PLACES, *_OPENINGS, "part", "wall", "stairs")


@dataclass(frozen=True)
class Thing:
    """Something that stands in a set. outline: corners of its convex hull seen from above, metres.

    path: its names from the set's root; flat: it lies on the floor, as a rug does
    """

    path: tuple[str, ...]
    outline: tuple[Point, ...]
    flat: bool = False

    @property
    def name(self) -> str:
        return self.path[-1]


@dataclass(frozen=True)
class Opening:
    """A door or window in a wall: kind ``door`` or ``window``, from end to end, metres."""

    kind: str
    ends: tuple[Point, Point]


@dataclass(frozen=True)
class Ground:
    """A scene's place from above. name: of the scene; level: of its floor, "" where there is but one.

    room: bounds of the scene's room, or of all of the set
    walls: pieces that are cut through, each the wild wall it belongs to and its corners
    """

    name: str
    level: str
    room: Box
    walls: tuple[tuple[int, tuple[Point, ...]], ...]
    openings: tuple[Opening, ...]
    things: tuple[Thing, ...]


@dataclass(frozen=True)
class Walker:
    """Somebody on a plan. path: where they go, metres; facing: (at the start, at the end), radians."""

    name: str
    path: tuple[Point, ...]
    facing: tuple[float, float]


@dataclass(frozen=True)
class Filmed:
    """A camera on a plan: its way, and what it takes in when it starts and when it ends.

    label: what to call it; yaw, spread: (start, end) direction and horizontal angle of view, radians
    reach: (start, end) metres from the camera, on the plan, to what it aims at
    """

    label: str
    path: tuple[Point, ...]
    yaw: tuple[float, float]
    spread: tuple[float, float]
    reach: tuple[float, float]

    @property
    def still(self) -> bool:
        """Whether it neither moves, turns nor zooms enough to be seen on a plan."""
        away = math.dist(self.path[0], self.path[-1])
        turn = abs(math.remainder(self.yaw[1] - self.yaw[0], math.tau))
        return away < 0.12 and turn < 0.06 and abs(self.spread[1] - self.spread[0]) < 0.03


@dataclass(frozen=True)
class Plan:
    """One shot, or all shots of a scene, from above.

    title: for whoever cannot see it; marked: paths of things the shot is about; line: the line of action
    between two people (the 180-degree line), or None; away: wild walls that are taken away for the shot
    """

    title: str
    ground: Ground
    people: tuple[Walker, ...] = ()
    cameras: tuple[Filmed, ...] = ()
    marked: tuple[tuple[str, ...], ...] = ()
    line: tuple[Point, Point] | None = None
    away: frozenset[int] = frozenset()


# --- the place --------------------------------------------------------------------------------


def ground_of(world: World, room: tuple[str, ...], name: str) -> Ground:
    """A scene's place; room: path of its room in the set, () for all of it."""
    places = [o for o in world.objects if o.kind in _PLACES]
    rooms = [o for o in places if room and o.path[: len(room)] == room] or places
    base = min((o.low[2] for o in rooms), default=0.0)
    things = tuple(t for o in world.objects if (t := _thing(world, o, base, {p.path for p in places})))
    openings = tuple(
        Opening(_OPENINGS[o.kind], _ends(o))
        for o in world.objects
        if o.kind in _OPENINGS and o.low[2] - base < CUT + 0.6 and o.high[2] - base > 0.6
    )
    return Ground(name, _level(world, base), _bounds(rooms), _walls(world, base), openings, things)


def _level(world: World, base: float) -> str:
    heights = sorted(level.height for level in world.storeys)
    if len(heights) < 2 or heights[-1] - heights[0] < 2.0:
        return ""
    return f"level {base:+.1f} m"


def _bounds(rooms: Sequence[WorldObject]) -> Box:
    if not rooms:
        return 0.0, 0.0, _LEAST, _LEAST
    low, high = np.array([o.low for o in rooms]).min(0), np.array([o.high for o in rooms]).max(0)
    return float(low[0]), float(low[1]), float(high[0]), float(high[1])


def _walls(world: World, base: float) -> tuple[tuple[int, tuple[Point, ...]], ...]:
    """Pieces of walls that a cut at breast height goes through."""
    solids = world.solids
    owner = np.array([o.kind in _PLACES for o in world.objects] + [True])  # the last for -1, nobody's
    low, high = solids.centre[:, 2] - solids.half[:, 2], solids.centre[:, 2] + solids.half[:, 2]
    cut = (low <= base + CUT) & (high > base + CUT) & (solids.wall >= 0) & owner[solids.object]
    rows = np.flatnonzero(cut)
    pieces = (tuple(map(_point, corners)) for corners in _corners(world, rows))
    return tuple(zip(solids.wall[rows].tolist(), pieces, strict=True))


def _ends(item: WorldObject) -> tuple[Point, Point]:
    """The middle line of an opening along its wall."""
    (x, y), (dx, dy) = (
        item.centre[:2],
        ((h - w) / 2 for w, h in zip(item.low[:2], item.high[:2], strict=True)),
    )
    return ((x - dx, y), (x + dx, y)) if dx >= dy else ((x, y - dy), (x, y + dy))


def _thing(world: World, item: WorldObject, base: float, places: set[tuple[str, ...]]) -> Thing | None:
    """The outline of what stands or lies on a floor; None for what is built in, or stands on another."""
    if item.kind in _BUILT or (item.path[:-1] and item.path[:-1] not in places):
        return None
    low, high = item.low[2] - base, item.high[2] - base
    if not (_REACH[0] < low < _REACH[1] and high > -0.05) or low > 1.25:
        return None
    flat = high < 0.06
    rows = np.flatnonzero(world.solids.object == item.id)
    corners = _corners(world, rows).reshape(-1, 2)
    if len(corners) == 0:
        (x0, y0), (x1, y1) = item.low[:2], item.high[:2]
        corners = np.array([(x0, y0), (x1, y0), (x1, y1), (x0, y1)])
    return Thing(item.path, _hull(corners), flat)


def _corners(world: World, rows: NDArray[np.intp]) -> NDArray[np.float64]:
    """Corners [N, 4, 2] of solids from above."""
    solids = world.solids
    c, s = np.cos(solids.yaw[rows]), np.sin(solids.yaw[rows])
    signs = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)], float)
    local = signs[None] * solids.half[rows][:, None, :2]
    turned = np.stack(
        [c[:, None] * local[..., 0] - s[:, None] * local[..., 1],
         s[:, None] * local[..., 0] + c[:, None] * local[..., 1]], -1
    )  # fmt: skip
    return np.asarray(turned + solids.centre[rows][:, None, :2])


def _hull(points: NDArray[np.float64]) -> tuple[Point, ...]:
    """Convex hull, counter-clockwise (Andrew's monotone chain: a dozen points, some of them in one line)."""
    ordered = sorted({_point(p) for p in points})
    if len(ordered) < 3:
        return tuple(ordered)

    def half(row: Iterable[Point]) -> list[Point]:
        out: list[Point] = []
        for p in row:
            while len(out) > 1 and _turn(out[-2], out[-1], p) <= 0:
                out.pop()
            out.append(p)
        return out[:-1]

    return tuple(half(ordered) + half(reversed(ordered)))


def _turn(a: Point, b: Point, c: Point) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _point(p: NDArray[np.float64]) -> Point:
    return round(float(p[0]), 4), round(float(p[1]), 4)


# --- what happens there -----------------------------------------------------------------------


def shot_plan(ground: Ground, built: BuiltShot, title: str, label: str = "") -> Plan:
    """The plan of a shot by its best take; of the place alone where it has none."""
    if not built.takes:
        return Plan(title, ground)
    best = built.takes[0]
    acting = [b.character for b in built.line.beats]
    met = [t for b in built.line.beats for t in (b.target, b.second) if t is not None]
    acting += [t.path[0] for t in met if t.kind == "character"]
    marked = tuple(dict.fromkeys(t.path for t in met if t.kind == "object"))
    people = tuple(_walker(walk) for walk in best.people)
    cameras = (_filmed(best.camera.track, label),)
    away = frozenset(np.flatnonzero(best.camera.hidden_walls).tolist())
    return Plan(title, ground, people, cameras, marked, action_line(people, acting), away)


def scene_plan(ground: Ground, shots: Sequence[tuple[int, BuiltShot]], title: str) -> Plan:
    """All cameras of a scene, numbered as in the film; people where they start in its first shot."""
    filmed = [(number, built) for number, built in shots if built.takes]
    cameras = tuple(_filmed(built.takes[0].camera.track, str(number)) for number, built in filmed)
    first: dict[str, Walker] = {}
    for _, built in filmed:
        for walk in built.takes[0].people:
            found = _walker(walk)
            before = first.get(found.name)
            first[found.name] = found if before is None else _joined(before, found)
    return Plan(title, ground, tuple(first.values()), cameras)


def action_line(people: Sequence[Walker], acting: Collection[str]) -> tuple[Point, Point] | None:
    """Where two people face each other, or act on one another, the line between them as they start."""
    two = [p for p in people if p.name in acting]
    two = two if len(two) == 2 else list(people)
    if len(two) != 2 or math.dist(two[0].path[0], two[1].path[0]) < 0.25:
        return None
    return two[0].path[0], two[1].path[0]


def _walker(walk: Walk) -> Walker:
    path = _way(walk.position[:, :2])
    return Walker(walk.name, path, (float(walk.heading[0]), float(walk.heading[-1])))


def _joined(one: Walker, two: Walker) -> Walker:
    """One after the other; what lies between is no way, but a cut."""
    path = one.path if math.dist(one.path[-1], two.path[0]) < 0.05 else (*one.path, two.path[0])
    return Walker(one.name, (*path, *two.path[1:]), (one.facing[0], two.facing[1]))


def lens_words(track: CameraTrack) -> str:
    """``50 mm``, ``35–50 mm`` of a zoom."""
    low, high = f"{track.focal.min():.0f}", f"{track.focal.max():.0f}"
    return f"{low} mm" if low == high else f"{low}–{high} mm"


def _filmed(track: CameraTrack, label: str) -> Filmed:
    away = np.hypot(*(track.look_at - track.position)[:, :2].T)
    spread = 2 * np.arctan(track.sensor[0] / 2 / track.focal)
    yaw = track.rotation[:, 2]
    return Filmed(
        label,
        _way(track.position[:, :2]),
        (float(yaw[0]), float(yaw[-1])),
        (float(spread[0]), float(spread[-1])),
        (float(away[0]), float(away[-1])),
    )


def _way(points: NDArray[np.float64], nearer: float = 0.03) -> tuple[Point, ...]:
    """A path without the points that make no difference on a plan; its ends always."""
    kept, at = [0], points.tolist()
    for i in range(1, len(at)):
        if math.dist(at[i], at[kept[-1]]) >= nearer * 3:
            kept.append(i)
    if kept[-1] != len(points) - 1:
        kept.append(len(points) - 1)
    return tuple(_point(points[i]) for i in kept)


def extent(plan: Plan, shape: float) -> Box:
    """The rectangle to show, its width ``shape`` times its height: the room, or what surrounds the action."""
    x0, y0, x1, y1 = plan.ground.room
    spots = [p for walker in plan.people for p in walker.path]
    spots += [p for camera in plan.cameras for p in camera.path]
    if spots:
        xs, ys = ([p[i] for p in spots] for i in (0, 1))
        near = (min(xs) - _AROUND, min(ys) - _AROUND, max(xs) + _AROUND, max(ys) + _AROUND)
        whole = max(x1 - x0, y1 - y0) <= _WHOLE
        room = (x0 - 0.3, y0 - 0.3, x1 + 0.3, y1 + 0.3) if whole else near
        x0, y0, x1, y1 = (
            min(near[0], room[0]), min(near[1], room[1]), max(near[2], room[2]), max(near[3], room[3]),
        )  # fmt: skip
    else:
        x0, y0, x1, y1 = x0 - 0.3, y0 - 0.3, x1 + 0.3, y1 + 0.3
    height = max(y1 - y0, (x1 - x0) / shape, _LEAST)
    cx, cy = (x0 + x1) / 2, (y0 + y1) / 2
    return cx - height * shape / 2, cy - height / 2, cx + height * shape / 2, cy + height / 2
