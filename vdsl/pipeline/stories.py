"""Random stories over the library, as text: what the discriminator's training set is filmed from.

Written as scripts and not as checked storyboards, so that training data passes the same gate as everything
a writer types. Every draw comes from one seed. Guarantees that what is kept for testing goes by names
alone: whatever the seed, no set and nobody of the cast is ever on both sides.
"""

from __future__ import annotations

import hashlib
import random
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from ..lang.definitions.action import ActionDef
from ..lang.definitions.set import SetDef
from ..lang.definitions.types import SetNode
from ..lang.ir import ALL_ANGLES, ANGLES, FURTHER_MOVEMENTS, MOVEMENT_FAMILIES, SIZES
from ..library import Catalog

_TIMES = ("dawn", "day", "dusk", "night")
_NAMES = ("anna", "ben")
#: How many stories have a shot of the place, and how many lines are of somebody going somewhere, beside those
#: that are by lot.
_ESTABLISHED, _GOING = 0.5, 0.12
_TEST_SHARE = 0.2
#: How often a camera has a movement of the paper, one beyond it, or two at once.
_MOVEMENT_ODDS = (10, 4, 1)
#: How often one has a view of its own rather than the plain one.
_VIEW_ODDS = 0.12
#: In which sizes there is room for two.
_SCALES_OF_VIEWS = {
    "two-shot": ("medium-close-up", "medium", "cowboy", "medium-long", "full", "wide"),
    "ots": ("medium-close-up", "medium", "cowboy"),
}
_FURTHER = tuple(word for word in FURTHER_MOVEMENTS if word != "rack-focus")
_JOINED = (("push", "pull", "zoom-in", "pedestal-up"), ("pan-left", "pan-right", "tilt-up", "arc-left"))


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


def split_of(names: Sequence[str]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Names to train on, and a fifth of them, at least one, to test on; always the same of the same names."""
    order = sorted(names, key=lambda name: hashlib.sha256(f"vds test {name}".encode()).digest())
    count = max(1, round(_TEST_SHARE * len(order)))
    return tuple(sorted(order[count:])), tuple(sorted(order[:count]))


def random_story(
    catalog: Catalog,
    place: Place,
    rng: random.Random,
    lines: int,
    cast: tuple[str, ...],
    cameras: int = 1,
) -> str:
    """A script of so many story lines at a place, each with so many fully named cameras."""
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
    going = [a for a in actions if a.group == "going"]
    established = rng.randrange(lines) if rng.random() < _ESTABLISHED else None
    for number in range(lines):
        if number == established:
            script.extend(("", *dict.fromkeys(_establishing(rng) for _ in range(cameras)), ""))
        story, other = _story_line(place, rng, going if rng.random() < _GOING else actions)
        shots = dict.fromkeys(_camera(rng, other) for _ in range(cameras))
        script.extend((f"{story}  {next(iter(shots))}", *(f"    {camera}" for camera in list(shots)[1:])))
    return "\n".join(script) + "\n"


def _story_line(place: Place, rng: random.Random, actions: list[ActionDef]) -> tuple[str, str]:
    """A line without its cameras, and who else is there."""
    who, other = rng.sample(_NAMES, 2)
    for _ in range(50):
        action = rng.choice(actions)
        if action.second == "required":
            continue
        target = _target(place, rng, action, other)
        if target is not None:
            return f"({who} {action.name}{target})", other
    return f"({who} look {other})", other


def _camera(rng: random.Random, other: str) -> str:
    """A camera of the whole vocabulary; the paper's sizes and angles twice as often as the others."""
    kind = rng.choices(("paper", "further", "joined"), _MOVEMENT_ODDS)[0]
    if kind == "paper":
        movement = rng.choice(rng.choice(list(MOVEMENT_FAMILIES.values())))
    elif kind == "further":
        movement = rng.choice(_FURTHER)
    else:
        movement = "+".join(rng.choice(words) for words in _JOINED)
    scale = rng.choice((*SIZES, "close-up", "medium", "full"))
    angle = rng.choice((*ALL_ANGLES, *ANGLES, *ANGLES))
    view = ""
    if rng.random() < _VIEW_ODDS:
        view = rng.choice((" two-shot", f" ots {other}"))
        scale = rng.choice(_SCALES_OF_VIEWS[view.split()[0]])
    return f"/ ({movement} {scale} {angle}{view})"


def _establishing(rng: random.Random) -> str:
    """A camera of the place itself."""
    movement = rng.choice(
        rng.choice([words for name, words in MOVEMENT_FAMILIES.items() if name != "follow"])
    )
    return f"/ ({movement} {rng.choice(('wide', 'full'))} {rng.choice(ANGLES)})"


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
