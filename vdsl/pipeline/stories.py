"""Random stories over the library, as text: what the discriminator's training set is filmed from.

Written as scripts and not as checked storyboards, so that training data passes the same gate as
everything a writer types. Every draw comes from one seed.
"""

from __future__ import annotations

import random
from collections.abc import Iterator
from dataclasses import dataclass

from ..lang.definitions.action import ActionDef
from ..lang.definitions.set import SetDef
from ..lang.definitions.types import SetNode
from ..lang.ir import ANGLES, MOVEMENT_FAMILIES, SCALES
from ..library import Catalog

_TIMES = ("dawn", "day", "dusk", "night")
_NAMES = ("anna", "ben")


@dataclass(frozen=True)
class Place:
    """Somewhere a random story can be set: a room of a set, and the names of what is in it."""

    set: str
    room: str
    objects: tuple[str, ...]
    seats: tuple[str, ...]
    movable: tuple[str, ...]


def places(catalog: Catalog) -> tuple[Place, ...]:
    """Every room or area of every library set."""
    found: list[Place] = []
    for name in sorted(catalog.names("set")):
        definition = catalog.get("set", name)
        if isinstance(definition, SetDef):
            found.extend(
                _place(catalog, name, node)
                for node in definition.root.children
                if node.kind in ("room", "area")
            )
    return tuple(found)


def _place(catalog: Catalog, set_name: str, room: SetNode) -> Place:
    objects, seats, movable = [], [], []
    for node in _walk(room):
        definition = catalog.get("prop", node.prop) if node.prop else None
        spots = set(node.spots) | set(getattr(definition, "spots", ()))
        if getattr(definition, "movable", False):
            movable.append(node.name)
        elif "stand" in spots:
            objects.append(node.name)
        if "seat" in spots:
            seats.append(node.name)
    return Place(set_name, room.name, tuple(objects), tuple(seats), tuple(movable))


def _walk(node: SetNode) -> Iterator[SetNode]:
    for child in node.children:
        yield child
        yield from _walk(child)


def random_story(
    catalog: Catalog, place: Place, rng: random.Random, lines: int, cast: tuple[str, ...]
) -> str:
    """A script of so many story lines at a place, each with one fully named camera."""
    script = [f'storyboard "{place.set} {place.room}"']
    script.extend(
        f"character {who} = {person}" for who, person in zip(_NAMES, rng.sample(cast, 2), strict=True)
    )
    room = f"{place.set}.{place.room}"
    script.append(f"scene here = {room} at {rng.choices(_TIMES, (1, 5, 2, 1))[0]}")
    actions = [
        a
        for a in (catalog.get("action", n) for n in sorted(catalog.names("action")))
        if isinstance(a, ActionDef)
    ]
    script.extend(_story_line(place, rng, actions) for _ in range(lines))
    return "\n".join(script) + "\n"


def _story_line(place: Place, rng: random.Random, actions: list[ActionDef]) -> str:
    who, other = rng.sample(_NAMES, 2)
    movement = rng.choice(rng.choice(list(MOVEMENT_FAMILIES.values())))
    scale = rng.choices(SCALES[:3], (3, 4, 3))[0]
    camera = f"/ ({movement} {scale} {rng.choice(ANGLES)})"
    for _ in range(50):
        action = rng.choice(actions)
        if action.second == "required":
            continue
        target = _target(place, rng, action, other)
        if target is not None:
            return f"({who} {action.name}{target})  {camera}"
    return f"({who} look {other})  {camera}"


def _target(place: Place, rng: random.Random, action: ActionDef, other: str) -> str | None:
    """`` name`` to go with an action, empty for none, None where the place has nothing that fits."""
    if action.target == "none" or (action.target == "optional" and rng.random() < 0.3):
        return ""
    kinds: list[tuple[str, ...]] = []
    if "character" in action.target_kinds:
        kinds.append((other,))
    if action.name == "sit":
        kinds = [place.seats]
    elif {"place", "object"} & set(action.target_kinds):
        kinds.append(place.movable if "place" not in action.target_kinds else place.objects)
    names = [n for kind in kinds for n in kind]
    return f" {rng.choice(names)}" if names else None
