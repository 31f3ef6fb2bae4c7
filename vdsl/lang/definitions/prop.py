"""Props: from the entries of a definition to numbers.

Assumes a parsed definition. Guarantees that a mistake is reported at its place and left out; what
:meth:`PropDef.shape` returns is all finite numbers in metres and radians, ready to be made a mesh of.
A prop's front looks along -Y, and its foot stands on z = 0.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from .. import ast
from ..diagnostics import Report
from ..evaluate import Bound, Quantity, parameter_env, read_parameters
from .primitives import PRIMITIVES, UNIT, Point, Primitive, read_axis, read_primitive
from .reader import Reader, unknown_entry
from .types import DefinitionBase, ModelFile

MOVING = ("hinge", "slide")
ENTRIES = (*PRIMITIVES, "spot", "grip", "solid", *MOVING, "repeat", "also")
PART_ENTRIES = (*PRIMITIVES, "spot", "solid", "repeat")
MAX_REPEAT = 200


@dataclass(frozen=True)
class PropSpot:
    """A named place on a prop, in its coordinates; facing in radians or None."""

    name: str
    at: Point
    facing: float | None


@dataclass(frozen=True)
class SolidBox:
    """An upright box that stands in for (a part of) a prop: size, and the centre of its foot."""

    size: Point
    at: Point


@dataclass(frozen=True)
class PropPart:
    """A part that moves: ``hinge NAME, at …, axis z, open 95deg { … }``, ``slide NAME, along …, open 40cm``.

    All in the prop's coordinates, with the part closed. kind: hinge or slide
    at: a point of the axis (hinge); axis: unit vector it turns about or slides along
    open: radians (right-handed about the axis) or metres when fully open; ajar: share of it at first, 0..1
    way: one passes where it closes an opening: nobody walks around it, it is opened on the way
    """

    name: str
    kind: str
    at: Point
    axis: Point
    open: float
    ajar: float
    way: bool
    shape: PropShape


@dataclass(frozen=True)
class PropShape:
    """A prop with its arguments filled in.

    solids: None where they follow from the primitives, () for nothing in the way
    grip: where a hand takes hold, None for what cannot be carried
    parts: what moves on it, with names of their own; model: the file it comes out of
    """

    primitives: tuple[Primitive, ...]
    spots: tuple[PropSpot, ...]
    grip: Point | None
    solids: tuple[SolidBox, ...] | None
    parts: tuple[PropPart, ...] = ()
    model: ModelFile | None = None


@dataclass(frozen=True)
class PropDef(DefinitionBase):
    """A prop as defined. ``spots``: names, in order, those of its parts too; ``movable``: it has a grip;
    ``parts``: names of what opens."""

    spots: tuple[str, ...]
    movable: bool
    parts: tuple[str, ...]
    body: tuple[ast.Entry, ...] = field(compare=False, repr=False)

    def shape(
        self, arguments: Mapping[str, float | str] | None = None, report: Report | None = None
    ) -> PropShape:
        """The prop in numbers; arguments override the defaults. Parts with no size left are left out."""
        report = Report() if report is None else report
        return _shape(self.body, parameter_env(self.parameters, arguments), report)


def read_prop(definition: ast.Definition, report: Report) -> PropDef | None:
    """Check a prop's definition, with its defaults filled in."""
    parameters = read_parameters(definition.parameters, report)
    shape = _shape(definition.body, parameter_env(parameters), report, strict=True)
    moving = [spot.name for part in shape.parts for spot in part.shape.spots]
    spots = tuple(dict.fromkeys([*(spot.name for spot in shape.spots), *moving]))
    parts = tuple(part.name for part in shape.parts)
    return PropDef(
        definition.name.text,
        parameters,
        definition.span,
        spots,
        shape.grip is not None,
        parts,
        definition.body,
    )


def unrolled(
    entries: tuple[ast.Entry, ...], env: Mapping[str, Bound], report: Report
) -> Iterator[tuple[ast.Entry, Mapping[str, Bound]]]:
    """Entries in order with the names they may use, ``repeat NAME COUNT { }`` written out."""
    for entry in entries:
        if entry.head.text != "repeat":
            yield entry, env
            continue
        reader = Reader(entry, env, report)
        name = reader.value(0)
        count = reader.value_number(1)
        body = reader.body()
        reader.done()
        if not isinstance(name, ast.Name) or len(name.parts) != 1:
            reader.missing("a name to count with, as in `repeat i 4 { … }`")
            continue
        if not (0 <= count <= MAX_REPEAT and count == int(count)):
            label = f"a whole number from 0 to {MAX_REPEAT} is wanted here"
            report.error("VDS102", entry.values[1].span if len(entry.values) > 1 else entry.span, label=label)
            continue
        for i in range(int(count)):
            yield from unrolled(body, {**env, name.text: Quantity(float(i), "number")}, report)


def _shape(
    body: tuple[ast.Entry, ...],
    env: Mapping[str, Bound],
    report: Report,
    strict: bool = False,
    known: tuple[str, ...] = ENTRIES,
) -> PropShape:
    primitives: list[Primitive] = []
    spots: list[PropSpot] = []
    parts: list[PropPart] = []
    grip: Point | None = None
    solids: list[SolidBox] | None = None
    for entry, names in unrolled(body, env, report):
        reader = Reader(entry, names, report)
        head = reader.head
        if head not in known:
            unknown_entry(entry, known, "a prop" if known == ENTRIES else "a part of a prop", report)
        elif head in PRIMITIVES:
            primitive = read_primitive(reader, strict)
            if primitive is not None:
                primitives.append(primitive)
        elif head == "spot":
            spots.append(read_spot(reader, 3))
        elif head == "grip":
            grip = reader.value_point(0, None, 3)
            reader.done()
        elif head == "also":  # other words for it, which the catalogue finds
            for index in range(reader.count):
                reader.value_word(index, "")
            reader.done()
        elif head in MOVING:
            part = _part(reader, [p.name for p in parts], strict)
            if part is not None:
                parts.append(part)
        else:
            solids = solids or []
            box = _solid(reader)
            if box is not None:
                solids.append(box)
    boxes = None if solids is None else tuple(solids)
    return PropShape(tuple(primitives), tuple(spots), grip, boxes, tuple(parts))


def _part(reader: Reader, taken: list[str], strict: bool) -> PropPart | None:
    """A ``hinge`` or a ``slide``; one of a name that is there already is numbered, as what is repeated is."""
    value, kind = reader.value(0), reader.head
    name = value.text if isinstance(value, ast.Name) else reader.value_word(0)
    axis: Point
    if kind == "hinge":
        at = reader.point("at", (0.0, 0.0, 0.0), 3)
        axis = UNIT[read_axis(reader, "axis")]
        open, ajar = reader.angle("open", math.pi / 2), reader.angle("ajar", 0.0)
    else:
        at, along = (0.0, 0.0, 0.0), reader.point("along", (0.0, -1.0, 0.0), 3, "number")
        length = math.hypot(*along)
        axis = tuple(v / length for v in along) if length > 1e-9 else (0.0, -1.0, 0.0)
        open, ajar = reader.length("open", 0.4), reader.length("ajar", 0.0)
    way = reader.flag("way")
    shape = _shape(reader.body(), reader.env, reader.report, strict, PART_ENTRIES)
    reader.done()
    if abs(open) < 1e-6 or not shape.primitives:
        lacks = "`open` more than nothing" if shape.primitives else "shapes in braces: what moves"
        if strict:
            reader.report.error("VDS240", reader.span, label=f"`{kind}` needs {lacks}")
        return None
    count = sum(1 for other in taken if other == name or other.rpartition("_")[0] == name)
    share = min(max(ajar / open, 0.0), 1.0)
    return PropPart(f"{name}_{count + 1}" if count else name, kind, at, axis, open, share, way, shape)


def read_spot(reader: Reader, size: int) -> PropSpot:
    """``spot NAME, at (x, y, z), facing 90deg``; in a room (x, y)."""
    value = reader.value(0)  # a name of its own, even where a parameter is called the same
    name = value.text if isinstance(value, ast.Name) else reader.value_word(0)
    at = reader.point("at", (0.0,) * size, size)
    facing = reader.angle("facing", None)
    reader.done()
    return PropSpot(name, (*at, 0.0)[:3], facing)


def _solid(reader: Reader) -> SolidBox | None:
    """``solid no`` or ``solid (width, depth, height), at (x, y, z)``."""
    value = reader.value(0)
    at = reader.point("at", (0.0, 0.0, 0.0), 3)
    if isinstance(value, ast.Group):
        size = reader.value_point(0, None, 3)
        reader.done()
        return SolidBox(size, at) if min(size) > 0 else None
    reader.value_word(0, None, ("no",))
    reader.done()
    return None
