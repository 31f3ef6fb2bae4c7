"""Where people are in a scene at first: placement lines, and those who appear without one.

Assumes characters and a scene that are known. Guarantees that everyone is placed once, that who sits at a
thing has a seat of their own, and that who acts has a place.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from . import ast, words
from .beats import BeatReader
from .bringing import held_at_first
from .diagnostics import Report, listing
from .hands import Hands
from .ir import Carried, Placement, Target
from .scope import Scope
from .source import Span
from .targets import resolve


@dataclass
class SceneBeingRead:
    """A scene, as far as it has been read. ``members``: all who are in it; ``acted``: who has acted."""

    index: int
    name: str
    set_name: str
    room: tuple[str, ...]
    time: str
    scope: Scope | None
    members: tuple[str, ...]
    hands: Hands
    span: Span
    reader: BeatReader | None = None
    carried: dict[tuple[str, ...], Carried] = field(default_factory=dict)
    placements: dict[str, Placement] = field(default_factory=dict)
    acted: set[str] = field(default_factory=set)


def place(
    line: ast.PlacementLine, scene: SceneBeingRead, characters: tuple[str, ...], report: Report
) -> None:
    """One placement line; the second one of a person, or one after they acted, is reported."""
    name = line.character.text
    if name in scene.placements and scene.placements[name].at.kind != "free":
        report.error(
            "VDS068",
            line.span,
            label=f"{name} is placed already",
            help="in a scene everyone is placed once",
            notes=[(scene.placements[name].span, "first here")],
        )
        return
    if name in scene.acted:
        report.error(
            "VDS068",
            line.span,
            label=f"{name} has acted already, and is where that left them",
            help="place people before the first story line, or let them walk",
        )
        return
    free = Target("free", (), "", line.span)
    at = free if line.at is None else _where(line.at, name, scene, characters, report)
    facing = None
    if line.facing is not None:
        facing = someone_or_something(line.facing, scene, characters, report)
    posture = line.posture.text if line.posture else "standing"
    if at is not None and posture == "sitting" and scene.scope is not None:
        _check_seat(at, line, scene.scope, scene.placements, report)
    holding = None if line.holding is None else held_at_first(line.holding, name, scene, report)
    scene.placements[name] = Placement(name, at or free, facing, posture, line.span, holding, line.beside)


def _where(
    name: ast.Name, who: str, scene: SceneBeingRead, characters: tuple[str, ...], report: Report
) -> Target | None:
    """Where somebody is: a place of the scene, or somebody who is placed already."""
    if name.text not in characters:
        there = [p.at.path for p in scene.placements.values() if p.at.kind not in ("free", "character")]
        return resolve(name, (), scene.scope, report, any_of=True, near=there)
    by, chain = name.text, [who]
    while by in scene.placements and by not in chain:
        chain.append(by)
        at = scene.placements[by].at
        by = at.path[0] if at.kind == "character" else ""
    if not by:
        return Target("character", (name.text,), name.text, name.span)
    if by in chain and len(chain) > 1:
        report.error(
            "VDS077", name.span, label=f"{name.text} is placed by {who}", help="place one by a thing"
        )
        return None
    report.error(
        "VDS077",
        name.span,
        label=f"{name.text} is not placed yet" if name.text != who else "this is who is placed",
        help=f"a line above says where {name.text} is, as `{name.text} at NAME`"
        if name.text != who
        else f"say where {who} is, as `{who} at NAME`",
    )
    return None


def _check_seat(
    at: Target, line: ast.PlacementLine, scope: Scope, placed: dict[str, Placement], report: Report
) -> None:
    if at.kind == "character" or (scope.may_have_seats_around(at) and not scope.has_seat(at)):
        return
    if at.kind == "free" or not scope.has_seat(at):
        written = line.at or line.posture or line.character
        seats = scope.seats()
        report.error(
            "VDS069",
            written.span,
            label=f"one cannot sit at `{written.text}`" if line.at else "sit where?",
            help=f"there are {listing(dict.fromkeys(seats), last='and')} to sit on"
            if seats
            else "this scene has no seats",
        )
        return
    sits = next(scope.sitting(at, placed.values()), None)
    if words.counts_under(at.written, at.path[-1]):
        return  # of several there may be another one
    if sits is None or scope.has_seat_left(at, placed.values()):
        return
    written = line.at or line.character
    others = [s for s in dict.fromkeys(scope.seats()) if s != written.text]
    report.error(
        "VDS069",
        written.span,
        label=f"{sits.character} sits here already",
        help=f"other seats: {listing(others, last='and')}" if others else "this scene has no other seat",
        notes=[(sits.span, "placed here")],
    )


def someone_or_something(
    name: ast.Name, scene: SceneBeingRead, characters: tuple[str, ...], report: Report
) -> Target | None:
    """What a camera is on, or someone faces: a character of this scene, or something in it."""
    target = resolve(name, characters, scene.scope, report)
    if target is not None and target.kind == "character" and target.path[0] not in scene.members:
        report.error(
            "VDS077",
            name.span,
            label=f"{name.text} is not in scene {scene.name}",
            help=f"place them first, as in `{name.text} at NAME`",
        )
        return None
    return target


def appear(word: ast.Name, scene: SceneBeingRead, report: Report) -> None:
    """Someone takes part; without a place they get the first free spot."""
    if word.text in scene.placements:
        return
    if scene.scope is not None:
        report.warn(
            "VDS079",
            word.span,
            label=f"{word.text} has not been placed in scene {scene.name}",
            help=f"a line like `{word.text} at NAME` above says where; else it is the first free spot",
        )
    free = Target("free", (), "", word.span)
    if word.text not in scene.members:  # of whom a pronoun spoke
        scene.members = (*scene.members, word.text)
    scene.placements[word.text] = Placement(word.text, free, None, "standing", word.span)
