"""The solids props are made of: boxes, cylinders, lathes and the like, from an entry to numbers.

Assumes a parsed entry. Guarantees that a solid's numbers are finite, in metres and radians, and that it has
a size; what is wrong is reported at its place and left out.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from runtime.materials import MATERIALS

from .. import ast
from ..source import Span
from .colours import Colour, checked_colour
from .reader import Reader

Point = tuple[float, ...]

PRIMITIVES = ("box", "cylinder", "sphere", "cone", "lathe", "extrude", "tube")
#: Directions a shape's own axis may be laid along.
AXES = ("x", "y", "z", "-x", "-y", "-z")


@dataclass(frozen=True)
class Primitive:
    """One solid of a prop, in numbers.

    kind: one of :data:`PRIMITIVES`
    size: box (x, y, z); cylinder (radius, height); sphere three radii; cone (low, high, height);
        extrude (height,); tube (radius,); lathe ()
    points: profile (r, z), outline (x, y) or path (x, y, z), metres
    at: centre of the foot; of a sphere the centre
    turn, tilt, lean: radians about Z, X and Y, in the order lean, tilt, turn; about ``pivot`` or ``at``
    along: where the shape's own Z points, one of :data:`AXES`; of an outline, Y stays up
    line: whether an ink line parts it from the primitive before it
    """

    kind: str
    size: Point
    points: tuple[Point, ...]
    at: Point
    turn: float
    tilt: float
    lean: float
    pivot: Point | None
    along: str
    rounding: float
    steps: int
    segments: int | None
    lumps: float
    color: Colour
    material: str
    solid: bool
    line: bool


def read_primitive(reader: Reader, strict: bool) -> Primitive | None:
    """A solid; None where it has no size left, which is a mistake only where ``strict``."""
    size, points = _measures(reader)
    span = reader.span
    material = reader.word("material", "plain", MATERIALS)
    written = reader.colour("color", "#d0d0cc")
    shade = reader.number("shade", 1.0)
    base = checked_colour(written, _option_span(reader, "color"), reader.report)
    segments = reader.number("segments", None)
    primitive = Primitive(
        kind=reader.head,
        size=size,
        points=points,
        at=reader.point("at", (0.0, 0.0, 0.0), 3),
        turn=reader.angle("turn", 0.0),
        tilt=reader.angle("tilt", 0.0),
        lean=reader.angle("lean", 0.0),
        pivot=reader.point("pivot", None, 3),
        along=read_axis(reader),
        rounding=reader.length("round", 0.0),
        steps=int(min(max(reader.number("steps", 1.0), 1), 6)) if reader.head == "box" else 1,
        segments=None if segments is None else int(min(max(segments, 3), 64)),
        lumps=reader.number("lumps", 0.0) if reader.head == "sphere" else 0.0,
        color=(min(base[0] * shade, 1.0), min(base[1] * shade, 1.0), min(base[2] * shade, 1.0)),
        material=material,
        solid=reader.flag("solid", True),
        line=reader.flag("line", True),
    )
    reader.done()
    fewest = {"lathe": 2, "extrude": 3, "tube": 2}.get(primitive.kind, 0)
    if len(points) < fewest:
        reader.report.error("VDS103", span, label=f"`{primitive.kind}` needs {fewest} points or more")
        return None
    if primitive.kind == "cone" and min(size[:2]) == 0 < max(size[:2]) and size[2] > 0:
        return primitive
    if size and min(size) <= 0:
        if strict:
            reader.report.error("VDS101", span, label="a size here is zero or less")
        return None
    return replace(primitive, rounding=max(primitive.rounding, 0.0))


def _measures(reader: Reader) -> tuple[Point, tuple[Point, ...]]:
    """What is particular to each kind: its size and its points."""
    kind = reader.head
    if kind == "box":
        return reader.value_point(0, None, 3), ()
    if kind == "cylinder":
        return (reader.value_length(0), _height(reader)), ()
    if kind == "cone":
        return (reader.value_length(0), reader.value_length(1), _height(reader)), ()
    if kind == "sphere":
        if isinstance(reader.value(0), ast.Group) and len(reader.value(0).items) == 3:  # type: ignore[union-attr]
            return reader.value_point(0, None, 3), ()
        return (reader.value_length(0),) * 3, ()
    if kind == "lathe":
        return (), _points(reader, "profile", 2)
    if kind == "extrude":
        return (_height(reader),), _points(reader, "outline", 2)
    return (reader.value_length(0),), _points(reader, "path", 3)


def _height(reader: Reader) -> float:
    height = reader.length("height", None)
    if height is None:
        reader.missing("`height`")
        return 1.0
    return height


def _points(reader: Reader, name: str, size: int) -> tuple[Point, ...]:
    points = reader.points(name)
    if any(len(p) != size for p in points):
        label = f"every point of `{name}` has {size} numbers"
        reader.report.error("VDS103", _option_span(reader, name), label=label)
        return ()
    return points


#: Unit vectors of :data:`AXES`.
UNIT: dict[str, Point] = {
    sign + name: tuple((-1.0 if sign else 1.0) * float(i == k) for k in range(3))
    for i, name in enumerate("xyz")
    for sign in ("", "-")
}


def read_axis(reader: Reader, option: str = "along") -> str:
    """One of :data:`AXES`; z where nothing is said."""
    values = reader.option(option)
    if values is None:
        return "z"
    value = values[0] if len(values) == 1 else None
    sign = ""
    if isinstance(value, ast.Negate):
        sign, value = "-", value.value
    if isinstance(value, ast.Name) and sign + value.text in AXES:
        return sign + value.text
    reader.report.error(
        "VDS104", _option_span(reader, option), label=f"`{option}` is one of x, y, z, -x, -y and -z"
    )
    return "z"


def _option_span(reader: Reader, name: str) -> Span:
    """Where an option's value is written, or the whole entry."""
    for option in reader.entry.options:
        if option.name.text == name:
            return option.values[0].span if option.values else option.span
    return reader.span
