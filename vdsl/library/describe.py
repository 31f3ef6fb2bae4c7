"""What the library holds, in words: a row for each definition, and the tree of a set.

Assumes a catalog; definitions with mistakes in them are left out. The rows are plain values, ready for a
table, a page or JSON; ``docs/library`` is made of them.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import asdict, dataclass

from ..lang.definitions.action import ActionDef
from ..lang.definitions.cast import CastDef
from ..lang.definitions.prop import PropDef
from ..lang.definitions.set import SetDef
from ..lang.definitions.types import DefinitionBase, ParameterSpec, SetNode
from .loader import Catalog

#: Kinds as one asks for them, and as the language calls them.
PLURALS = {"sets": "set", "props": "prop", "cast": "cast", "actions": "action"}


@dataclass(frozen=True)
class Row:
    """A definition in words; ``about`` is the comment above it, ``own`` whether it is the script's."""

    name: str
    kind: str
    about: str


@dataclass(frozen=True)
class SetRow(Row):
    """places: rooms and areas, each with its path, kind, spots and the names of what is in it."""

    time: str
    outdoor: bool
    places: tuple[dict[str, object], ...]


@dataclass(frozen=True)
class PropRow(Row):
    """parameters: name to default; parts: what swings or slides; movable: it can be carried."""

    parameters: dict[str, str]
    spots: tuple[str, ...]
    parts: tuple[str, ...]
    movable: bool


@dataclass(frozen=True)
class CastRow(Row):
    parameters: dict[str, str]


@dataclass(frozen=True)
class ActionRow(Row):
    """also: other words for it; target, second: ``none``, ``optional`` or ``required``, with kinds; duration
    of the first way, s."""

    group: str
    also: tuple[str, ...]
    target: str
    target_kinds: tuple[str, ...]
    second: str
    second_kinds: tuple[str, ...]
    needs: str
    brings: str
    posture: str
    feeling: str
    duration: float
    variants: tuple[str, ...]
    example: str
    props: tuple[str, ...]


def describe(catalog: Catalog, kind: str, name: str) -> Row | None:
    """The row of one definition; kind: set, prop, cast or action. None where it cannot be read."""
    definition = catalog.get(kind, name)
    if definition is None:
        return None
    head = (name, kind, _about(kind, definition))
    if isinstance(definition, SetDef):
        places = tuple(_places(definition.root))
        return SetRow(*head, definition.time, definition.outdoor, places)
    if isinstance(definition, PropDef):
        parts = tuple(getattr(definition, "parts", ()))
        spots = tuple(dict.fromkeys(definition.spots))
        return PropRow(*head, _parameters(definition.parameters), spots, parts, definition.movable)
    if isinstance(definition, CastDef):
        said = {entry.head.text for entry in definition.body} | set(_written(definition))
        specs = tuple(spec for spec in definition.parameters if spec.name in said)
        return CastRow(*head, _parameters(specs))
    if isinstance(definition, ActionDef):
        return ActionRow(
            *head,
            definition.group,
            definition.also,
            definition.target,
            definition.target_kinds,
            definition.second,
            definition.second_kinds,
            definition.needs,
            definition.brings,
            definition.posture,
            definition.feeling,
            round(definition.variants[0].duration, 3),
            tuple(variant.name for variant in definition.variants),
            definition.example,
            definition.props,
        )
    return None


def rows(catalog: Catalog, kind: str, search: str = "") -> list[Row]:
    """Rows of a kind in order of the alphabet; only those in which all words of ``search`` occur."""
    found = (describe(catalog, kind, name) for name in sorted(catalog.names(kind)))
    wanted = search.casefold().split()
    return [row for row in found if row is not None and all(word in _text(row) for word in wanted)]


def _text(row: Row) -> str:
    return repr(asdict(row)).casefold()


def _written(definition: CastDef) -> Iterator[str]:
    """Features the definition's own text says."""
    text = definition.span.text
    for spec in definition.parameters:
        if spec.name in text:
            yield spec.name


def _parameters(specs: tuple[ParameterSpec, ...]) -> dict[str, str]:
    return {spec.name: in_words(spec) for spec in specs}


def in_words(spec: ParameterSpec) -> str:
    """A parameter's default as one would write it."""
    if isinstance(spec.default, str):
        return spec.default
    if spec.kind == "length":
        return f"{spec.default:.4g}m"
    if spec.kind == "angle":
        return f"{math.degrees(spec.default):.4g}deg"
    return f"{spec.default:.4g}" + ("s" if spec.kind == "seconds" else "")


def _places(root: SetNode) -> Iterator[dict[str, object]]:
    for node in root.children:
        if node.kind not in ("room", "area"):
            continue
        things = [child.name for child in node.children]
        yield {"name": node.name, "kind": node.kind, "spots": node.spots, "things": tuple(things)}


def tree(node: SetNode, catalog: Catalog) -> Iterator[tuple[int, str, str, tuple[str, ...]]]:
    """A set's nodes from the root's children down: depth, name, kind (or prop), spots."""

    def walk(node: SetNode, depth: int) -> Iterator[tuple[int, str, str, tuple[str, ...]]]:
        prop = catalog.get("prop", node.prop) if node.prop else None
        spots = (*node.spots, *(prop.spots if isinstance(prop, PropDef) else ()))
        yield depth, node.name, node.prop or node.kind, tuple(dict.fromkeys(spots))
        for child in node.children:
            yield from walk(child, depth + 1)

    for child in node.children:
        yield from walk(child, 0)


def _about(kind: str, definition: DefinitionBase) -> str:
    """The comment above a definition: its first paragraph, without the marks."""
    text = definition.span.source.text[: definition.span.start].rstrip(" \t")
    lines = text.split("\n")[:-1] if text.endswith("\n") or not text else text.split("\n")
    if kind == "set" and lines and not lines[-1].strip():
        lines = lines[:-1]
    found: list[str] = []
    for line in reversed(lines):
        if not line.lstrip().startswith("#"):
            break
        found.insert(0, line.strip().lstrip("#").strip())
    return " ".join(found)
