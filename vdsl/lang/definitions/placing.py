"""What stands in a set: props at places, with their arguments, and what stands on them.

Assumes parsed entries. Lengths are metres, angles radians; a prop is placed in the coordinates of its
room, or of the prop it stands on.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Protocol

from .. import ast
from ..diagnostics import Report, nearest
from ..evaluate import Bound, evaluate_arguments
from ..source import Span
from .colours import checked_colour, colour
from .primitives import Point
from .prop import PropDef, PropSpot, read_spot, unrolled
from .reader import Reader, unknown_entry
from .types import SetNode

WALLS = ("north", "south", "east", "west")
PLACE_ENTRIES = ("place", "spot", "repeat")


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


# --- reading ------------------------------------------------------------------------


def read_call(reader: Reader, default: str) -> ast.Call:
    """``= table(width 1.3m)``; the prop ``default`` without arguments where nothing is said."""
    if not reader.entry.bound:
        name = ast.Name((default,), reader.entry.head.span)
        if reader.entry.values:
            name = ast.Name((default,), reader.entry.values[0].span)
        return ast.Call(name, (), name.span)
    return reader.bound_call() or ast.Call(ast.Name((default,), reader.span), (), reader.span)


def read_placed(reader: Reader, parent: bool) -> Placed | None:
    """One ``place`` with all in its braces; ``parent``: it stands on a prop, and may say on which spot."""
    name = reader.value_word(0)
    call = read_call(reader, name)
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
    children, spots = read_standing(body, reader, "a placed prop", parent=True)
    if not name:
        return None
    on_span = next((o.span for o in reader.entry.options if o.name.text == "on"), reader.span)
    return Placed(name, call, reader.env, at, up, turn, wall, on, spots, children, reader.span, on_span)


def read_standing(
    body: tuple[ast.Entry, ...], reader: Reader, where: str, parent: bool
) -> tuple[tuple[Placed, ...], tuple[PropSpot, ...]]:
    """The props and spots in braces of ``where``: on a prop, as ``parent`` says, or on a floor."""
    placed: list[Placed] = []
    spots: list[PropSpot] = []
    for child, env in unrolled(body, reader.env, reader.report):
        inner = Reader(child, env, reader.report)
        if inner.head == "place":
            item = read_placed(inner, parent)
            if item is not None:
                placed.append(item)
        elif inner.head == "spot":
            spots.append(read_spot(inner, 3 if parent else 2))
        else:
            unknown_entry(child, PLACE_ENTRIES, where, reader.report)
    placed = numbered(placed)
    check_names([(p.name, p.span) for p in placed], reader.report)
    return tuple(placed), tuple(spots)


def placed_node(item: Placed) -> SetNode:
    """Its place in the tree of names, with what stands on it."""
    spots = tuple(dict.fromkeys(s.name for s in item.spots))
    return SetNode(item.name, "object", item.prop, spots, tuple(map(placed_node, item.children)), item.span)


def numbered(items: list[Placed]) -> list[Placed]:
    """What a ``repeat`` places again and again is called tree, tree_2, tree_3 …"""
    count: dict[int, int] = {}
    found = []
    for item in items:
        count[item.span.start] = times = count.get(item.span.start, 0) + 1
        found.append(item if times == 1 else replace(item, name=f"{item.name}_{times}"))
    return found


def check_names(named: list[tuple[str, Span]], report: Report) -> None:
    """Names used twice side by side, each at its second place."""
    seen: dict[str, Span] = {}
    for name, span in named:
        if name in seen:
            report.error(
                "VDS112", span, label=f"`{name}` is already here", notes=[(seen[name], "the first one")]
            )
        elif name:
            seen[name] = span


def walk_placed(
    items: tuple[Placed, ...], parent: Placed | None = None
) -> Iterator[tuple[Placed, Placed | None]]:
    """Every placed prop with the one it stands on."""
    for item in items:
        yield item, parent
        yield from walk_placed(item.children, item)


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
