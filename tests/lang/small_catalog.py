"""A small catalog of its own, so that tests of the language do not hang on what the library has."""

from __future__ import annotations

from dataclasses import dataclass, field

from vdsl.lang.definitions.types import DefinitionBase, ParameterSpec, SetNode
from vdsl.lang.source import Source, Span

NOWHERE = Span(Source("<test>", ""), 0, 0)


@dataclass(frozen=True)
class Prop(DefinitionBase):
    spots: tuple[str, ...] = ()
    movable: bool = False


@dataclass(frozen=True)
class Set(DefinitionBase):
    root: SetNode = field(default=None)  # type: ignore[assignment]
    time: str = "day"


@dataclass(frozen=True)
class Move:
    kind: str


@dataclass(frozen=True)
class Part:
    moves: tuple[Move, ...]


@dataclass(frozen=True)
class Variant:
    part: Part


#: What has to be in a hand, and what the action does about it.
HANDS = {
    "pick-up": ("none", "take"),
    "put-down": ("any", "put"),
    "give": ("target", "pass"),
    "pour": ("second", "tip"),
    "drink": ("target", "tip"),
}


@dataclass(frozen=True)
class Action(DefinitionBase):
    target: str = "none"
    target_kinds: tuple[str, ...] = ()
    second: str = "none"
    second_kinds: tuple[str, ...] = ()
    needs: str = "none"
    variants: tuple[Variant, ...] = ()


def node(
    name: str, kind: str, *children: SetNode, prop: str | None = None, spots: tuple[str, ...] = ()
) -> SetNode:
    return SetNode(name, kind, prop, spots, children, NOWHERE)


def thing(name: str, prop: str, *children: SetNode) -> SetNode:
    return node(name, "object", *children, prop=prop)


PROPS = {
    "table": ("top", "stand"),
    "counter": ("top", "stand"),
    "chair": ("seat", "stand"),
    "cup": ("grip",),
    "stand_in": ("grip",),
    "sofa": ("seat_left", "seat_right", "stand"),
    "lamp": (),
    "bench": ("seat",),
}

APARTMENT = node(
    "apartment",
    "set",
    node(
        "kitchen",
        "room",
        node("door", "part"),
        node("window", "part"),
        thing("table", "table", thing("cup", "cup")),
        thing("counter", "counter"),
        thing("chair_1", "chair"),
        thing("chair_2", "chair"),
        spots=("middle",),
    ),
    node(
        "living",
        "room",
        node("window", "part"),
        thing("sofa", "sofa"),
        thing("lamp", "lamp"),
        thing("table", "table"),
    ),
    node("bedroom", "room", thing("lamp", "lamp"), node("window", "part")),
)
STREET = node(
    "street",
    "set",
    node("pavement", "area", thing("bench", "bench"), node("bus_stop", "object", prop="lamp")),
)

PLACE = ("place", "object", "character")
ACTIONS = {
    "walk": ("optional", PLACE, "none"),
    "run": ("optional", PLACE, "none"),
    "wave": ("optional", ("character",), "none"),
    "sit": ("required", ("object",), "none"),
    "stand-up": ("none", (), "none"),
    "pick-up": ("required", ("object",), "none"),
    "put-down": ("optional", ("object",), "optional"),
    "pour": ("required", ("object",), "optional"),
    "greet": ("required", ("character",), "none"),
    "give": ("required", ("object",), "required"),
    "look": ("required", PLACE, "none"),
    "wait": ("none", (), "none"),
    "drink": ("optional", ("object",), "none"),
}

PERSON = (
    ParameterSpec("height", "length", 1.66),
    ParameterSpec("build", "word", "average", ("slim", "average", "heavy")),
    ParameterSpec("hair", "word", "bob", ("bob", "short", "long")),
    ParameterSpec("top", "word", "crimson"),
)


class SmallCatalog:
    """Two sets, a few props and actions, a woman and a man."""

    def __init__(self) -> None:
        self._all: dict[tuple[str, str], DefinitionBase] = {}
        for name, spots in PROPS.items():
            self._all["prop", name] = Prop(name, (), NOWHERE, spots, movable=name in ("cup", "stand_in"))
        for root in (APARTMENT, STREET):
            self._all["set", root.name] = Set(root.name, (), NOWHERE, root)
        for name, (target, kinds, second) in ACTIONS.items():
            needs, move = HANDS.get(name, ("none", ""))
            variants = (Variant(Part((Move(move),))),) if move else ()
            also = ("character",) if name == "give" else ()
            self._all["action", name] = Action(
                name, (), NOWHERE, target, kinds, second, also, needs, variants
            )
        for name in ("woman", "man"):
            self._all["cast", name] = DefinitionBase(name, PERSON, NOWHERE)

    def names(self, kind: str) -> tuple[str, ...]:
        return tuple(sorted(name for k, name in self._all if k == kind))

    def synonyms(self, kind: str) -> dict[str, str]:
        return {}

    def get(self, kind: str, name: str) -> DefinitionBase | None:
        return self._all.get((kind, name))
