"""A plan as marks on a sheet 400 wide: shapes and words with a role each, in the order they are drawn.

Assumes a :class:`~vdsl.emit.plan_ground.Plan`. Guarantees that words do not cover each other (the less
telling ones are left out), so that the same marks can be written as SVG or painted.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

from . import lettering
from .plan_ground import Box, Filmed, Plan, Point, Thing, Walker, extent

WIDTH, HEIGHT = 400, 300
_NAME, _SMALL = 14, 11  # letters, in the sheet's units
_HEAD = 6.5  # half the size of a person's mark
_STEPS = (0.5, 1.0, 2.0, 5.0, 10.0, 20.0)


class Mark(NamedTuple):
    """A shape or a word. role: what it is, and so how it looks (:data:`vdsl.emit.plan.ROLES`).

    shape: ``polygon``, ``line`` (points), ``circle`` (one point, size is the radius) or ``text`` (one point,
    its middle, size is the letters' height)
    """

    shape: str
    role: str
    points: tuple[Point, ...]
    size: float = 0.0
    text: str = ""
    anchor: str = "middle"


@dataclass(frozen=True)
class _Sheet:
    """From metres to the sheet's units, north up."""

    box: Box

    @property
    def scale(self) -> float:
        return WIDTH / (self.box[2] - self.box[0])

    def at(self, p: Point) -> Point:
        return (p[0] - self.box[0]) * self.scale, (self.box[3] - p[1]) * self.scale

    def all(self, points: Sequence[Point]) -> tuple[Point, ...]:
        return tuple(self.at(p) for p in points)


class _Words:
    """Words on the sheet, each where it covers no other."""

    def __init__(self) -> None:
        self._taken: list[Box] = []
        self.marks: list[Mark] = []

    def keep_free(self, box: Box) -> None:
        self._taken.append(box)

    def write(self, at: Sequence[Point], text: str, size: int, role: str) -> None:
        """At the first of some places that is free; nowhere if none is."""
        text = lettering.clean(text)[:28]
        half = 0.5 * lettering.width(text, size) + 1
        for x, y in at:
            x = min(max(x, half + 3), WIDTH - half - 3)
            box = (x - half, y - size * 0.55, x + half, y + size * 0.55)
            inside = box[1] >= 2 and box[3] <= HEIGHT - 2
            if inside and not any(_overlap(box, other) for other in self._taken):
                self._taken.append(box)
                self.marks.append(Mark("text", role, ((x, y),), size, text))
                return


def _overlap(a: Box, b: Box) -> bool:
    return a[0] < b[2] and b[0] < a[2] and a[1] < b[3] and b[1] < a[3]


def marks_of(plan: Plan) -> tuple[Mark, ...]:
    """The whole plan, from the floor up."""
    sheet, words = _Sheet(extent(plan, WIDTH / HEIGHT)), _Words()
    out = _cones(plan.cameras, sheet) + _place(plan, sheet)
    out += _line(plan, sheet)
    for number, walker in enumerate(plan.people):
        out += _person(walker, number % 4, sheet, words)
    for camera in plan.cameras:
        out += _camera(camera, len(plan.cameras) > 1, sheet, words)
    furniture = _furniture(sheet, plan.ground.level, words)
    for number, walker in enumerate(plan.people):
        x, y = sheet.at(walker.path[0])
        words.write(_about(x, y, 17), walker.name, _NAME, f"name person-{number % 4}")
    _name_things(plan, sheet, words)
    return tuple(out + furniture + words.marks)


# --- the place --------------------------------------------------------------------------------


def _place(plan: Plan, sheet: _Sheet) -> list[Mark]:
    ground, marked = plan.ground, plan.marked
    whose = {t.path for t in ground.things for path in marked if path[: len(t.path)] == t.path}
    out = [
        Mark("polygon", _thing_role(t, whose), sheet.all(t.outline))
        for t in sorted(ground.things, key=lambda t: not t.flat)
        if len(t.outline) > 2
    ]
    out += [
        Mark("polygon", "wild" if wall in plan.away else "wall", sheet.all(piece))
        for wall, piece in ground.walls
    ]
    for opening in ground.openings:
        a, b = sheet.all(opening.ends)
        out.append(Mark("line", opening.kind, (a, b)))
        if opening.kind == "door":
            out += _jambs(a, b)
    return out


def _thing_role(thing: Thing, whose: set[tuple[str, ...]]) -> str:
    return "marked" if thing.path in whose else "rug" if thing.flat else "thing"


def _jambs(a: Point, b: Point) -> list[Mark]:
    """Short strokes across the ends of a way through a wall."""
    away = math.dist(a, b) or 1.0
    n = (-(b[1] - a[1]) / away * 4, (b[0] - a[0]) / away * 4)
    return [Mark("line", "jamb", ((p[0] - n[0], p[1] - n[1]), (p[0] + n[0], p[1] + n[1]))) for p in (a, b)]


def _name_things(plan: Plan, sheet: _Sheet, words: _Words) -> None:
    """Names where there is room: first what the shot is about, then from the largest down."""
    x0, y0, x1, y1 = sheet.box

    def telling(t: Thing) -> tuple[bool, float]:
        return not any(path[: len(t.path)] == t.path for path in plan.marked), -_area(t.outline)

    for thing in sorted(plan.ground.things, key=telling):
        cx = sum(p[0] for p in thing.outline) / len(thing.outline)
        cy = sum(p[1] for p in thing.outline) / len(thing.outline)
        if not (x0 < cx < x1 and y0 < cy < y1) or thing.flat:
            continue
        about = [path for path in plan.marked if path[: len(thing.path)] == thing.path]
        x, y = sheet.at((cx, cy))
        room = lettering.width(thing.name, _SMALL) < 2.4 * sheet.scale * math.sqrt(_area(thing.outline))
        if about:
            words.write(_about(x, y, 13), about[0][-1].replace("_", " "), _SMALL, "marked-name")
        elif room:
            words.write([(x, y)], thing.name.replace("_", " "), _SMALL, "thing-name")


def _area(outline: Sequence[Point]) -> float:
    return 0.5 * abs(
        sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(outline, (*outline[1:], outline[0]), strict=True))
    )


# --- people -----------------------------------------------------------------------------------


def _line(plan: Plan, sheet: _Sheet) -> list[Mark]:
    """The line of action, a little beyond both people."""
    if plan.line is None:
        return []
    a, b = plan.line
    away = math.dist(a, b)
    beyond = max(0.8, 0.25 * away) / away
    ends = [(p[0] + (p[0] - q[0]) * beyond, p[1] + (p[1] - q[1]) * beyond) for p, q in ((a, b), (b, a))]
    return [Mark("line", "action-line", sheet.all(ends))]


def _person(walker: Walker, colour: int, sheet: _Sheet, words: _Words) -> list[Mark]:
    """Full where they start, hollow where they end, with noses; the way between ends in an arrow."""
    way = sheet.all(walker.path)
    length = sum(math.dist(a, b) for a, b in pairwise(way))
    role, out = f"person-{colour}", []
    if length > 2.2 * _HEAD:
        out.append(Mark("line", f"way {role}", way))
        out += _head(way[-1], walker.facing[1], f"end {role}")
        middle = _along(way, length / 2)
        if length > 6 * _HEAD:
            out.append(Mark("polygon", f"arrow {role}", _arrow(*middle, 6.0)))
        words.keep_free(_round(way[-1], _HEAD))
    out += _head(way[0], walker.facing[0], f"start {role}")
    words.keep_free(_round(way[0], _HEAD))
    return out


def _head(at: Point, facing: float, role: str) -> list[Mark]:
    """A disc with a nose."""
    x, y = at
    c, s = math.cos(facing), -math.sin(facing)
    tip = (x + 2.0 * _HEAD * c, y + 2.0 * _HEAD * s)
    sides = [(x + _HEAD * (0.62 * c - k * s), y + _HEAD * (0.62 * s + k * c)) for k in (0.78, -0.78)]
    return [Mark("polygon", f"nose {role}", (sides[0], tip, sides[1])), Mark("circle", role, (at,), _HEAD)]


def _along(way: Sequence[Point], length: float) -> tuple[Point, float]:
    """The point at a length along a way, and the direction there."""
    for a, b in pairwise(way):
        step = math.dist(a, b)
        if step and length <= step:
            share = length / step
            at = (a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]))
            return at, math.atan2(b[1] - a[1], b[0] - a[0])
        length -= step
    return way[-1], 0.0


def _arrow(tip: Point, heading: float, size: float) -> tuple[Point, ...]:
    """A head of an arrow whose middle is at ``tip``; heading in the sheet's sense."""
    c, s = math.cos(heading), math.sin(heading)
    corners = ((size, 0.0), (-0.7 * size, 0.75 * size), (-0.7 * size, -0.75 * size))
    return tuple((tip[0] + c * u - s * v, tip[1] + s * u + c * v) for u, v in corners)


# --- cameras ----------------------------------------------------------------------------------


def _cones(cameras: Sequence[Filmed], sheet: _Sheet) -> list[Mark]:
    """What each camera takes in as it starts, and dashed as it ends."""
    out: list[Mark] = []
    for camera in cameras:
        alone = len(cameras) == 1
        out.append(Mark("polygon", "view" if alone else "view among", _cone(camera, 0, sheet, alone)))
        if not camera.still and alone:
            out.append(Mark("polygon", "view-end", _cone(camera, 1, sheet, alone)))
    return out


def _cone(camera: Filmed, end: int, sheet: _Sheet, alone: bool) -> tuple[Point, ...]:
    x, y = sheet.at(camera.path[-end])
    reach = max(camera.reach[end] * 1.3, 0.8) if alone else min(max(camera.reach[end], 0.6), 1.4)
    length = reach * sheet.scale
    yaw, half = camera.yaw[end], camera.spread[end] / 2
    rim = [yaw - half + k * half / 4 for k in range(9)]
    return ((x, y), *((x + length * math.cos(a), y - length * math.sin(a)) for a in rim))


def _camera(camera: Filmed, among: bool, sheet: _Sheet, words: _Words) -> list[Mark]:
    """Its way, the camera where it starts, and its outline where it ends."""
    way = sheet.all(camera.path)
    length = sum(math.dist(a, b) for a, b in pairwise(way))
    out: list[Mark] = []
    if length > 6:
        out.append(Mark("line", "camera-way", way))
        if length > 16:
            out += [Mark("polygon", "camera-arrow", _arrow(*_along(way, length * 0.62), 6.0))]
        if not among:
            out += _body(way[-1], camera.yaw[1], "camera-end")
    x, y = way[0]
    if among:
        out.append(Mark("circle", "number-disc", (way[0],), 8.5))
        out.append(Mark("text", "number", (way[0],), _SMALL, camera.label))
        words.keep_free(_round(way[0], 9))
        return out
    out += _body(way[0], camera.yaw[0], "camera")
    for point in (way[0], way[-1]):
        words.keep_free(_round(point, 8))
    if camera.label:
        words.write(_about(x, y, 19), camera.label, _SMALL, "lens")
    return out


def _body(at: Point, yaw: float, role: str) -> list[Mark]:
    """A camera seen from above: a box, and the lens towards what it films."""
    c, s = math.cos(yaw), -math.sin(yaw)

    def turned(corners: Sequence[Point]) -> tuple[Point, ...]:
        return tuple((at[0] + c * u - s * v, at[1] + s * u + c * v) for u, v in corners)

    lens = ((-1.0, 0.0), (6.0, -5.0), (6.0, 5.0))
    box = ((-11.0, -5.5), (0.0, -5.5), (0.0, 5.5), (-11.0, 5.5))
    return [Mark("polygon", role, turned(lens)), Mark("polygon", role, turned(box))]


# --- the rest ---------------------------------------------------------------------------------


def _furniture(sheet: _Sheet, level: str, words: _Words) -> list[Mark]:
    """Scale bar at the lower left, north at the lower right, the level beside it."""
    step = max((s for s in _STEPS if s * sheet.scale <= WIDTH * 0.22), default=_STEPS[0])
    length, y, east = step * sheet.scale, HEIGHT - 12, WIDTH - 14
    text = f"{step:g} m"
    room = 24 + length + lettering.width(text, _SMALL)
    out = [
        Mark("polygon", "plate", ((4, y - 11), (room, y - 11), (room, HEIGHT - 3), (4, HEIGHT - 3))),
        Mark("line", "scale", ((10, y - 4), (10, y), (10 + length, y), (10 + length, y - 4))),
        Mark("text", "scale-name", ((14 + length, y - 2),), _SMALL, text, "start"),
        Mark("polygon", "north", ((east, y - 22), (east - 5, y - 8), (east, y - 12), (east + 5, y - 8))),
        Mark("text", "scale-name", ((east, y),), _SMALL, "N"),
    ]  # fmt: skip
    words.keep_free((4, y - 12, room, HEIGHT))
    words.keep_free((WIDTH - 26, y - 26, WIDTH, HEIGHT))
    if level:
        out.append(Mark("text", "scale-name", ((WIDTH - 30, y),), _SMALL, level, "end"))
        words.keep_free((WIDTH - 34 - lettering.width(level, _SMALL), y - 8, WIDTH, HEIGHT))
    return out


def _about(x: float, y: float, off: float) -> list[Point]:
    """Places for a word about a point: above, below, and to its sides."""
    return [
        (x, y - off),
        (x, y + off),
        (x + 2 * off, y),
        (x - 2 * off, y),
        (x, y - 1.8 * off),
        (x, y + 1.8 * off),
    ]


def _round(at: Point, radius: float) -> Box:
    return at[0] - radius, at[1] - radius, at[0] + radius, at[1] + radius
