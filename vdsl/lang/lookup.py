"""Names of sets, rooms and cast: what a scene or a character line says, looked up in the catalog.

Everything unknown is reported; what comes back is as much as is known, so that checking goes on.
"""

from __future__ import annotations

from dataclasses import dataclass

from . import ast, words
from .catalog import CatalogLike
from .definitions.files import character_cast
from .definitions.types import DefinitionBase, SetNode
from .diagnostics import Report, listing, nearest
from .evaluate import evaluate_arguments
from .ir import Character
from .scope import ROOMS, node_at, walk
from .source import Span

SHORTEST_PERSON, TALLEST_PERSON = 0.7, 2.4


@dataclass(frozen=True)
class Setting:
    """The set a scene is in: its name, the room's path, the set's time of day; ``root``: None if unknown."""

    set_name: str
    room: tuple[str, ...]
    time: str
    root: SetNode | None


class Lookup:
    """Looks names up in one catalog."""

    def __init__(self, catalog: CatalogLike, report: Report) -> None:
        self.catalog = catalog
        self.report = report

    def definition(self, kind: str, name: ast.Name) -> DefinitionBase | None:
        """A definition by name; an unknown one is reported."""
        names = self.catalog.names(kind)
        if name.text in names:
            return self.catalog.get(kind, name.text)
        meant = nearest(name.text, names)
        what = {"cast": "cast member", "set": "set"}[kind]
        self.report.error(
            "VDS064" if kind == "cast" else "VDS062",
            name.span,
            label=f"no {what} is called `{name.text}`",
            help=f"there are {listing(names, 20, last='and')}",
            suggestion=meant,
            fix=meant,
        )
        return None

    def character(self, line: ast.CharacterLine) -> Character:
        """A character as dressed; without a cast where that is not known."""
        name = line.name.text
        if isinstance(line.cast, ast.Text):
            cast_name = character_cast(line.cast).name.text
            known = self.catalog.get("cast", cast_name) is not None  # else it is reported
            return Character(name, cast_name if known else "", (), line.span)
        callee = line.cast.callee if isinstance(line.cast, ast.Call) else line.cast
        arguments: dict[str, float | str] = {}
        cast = self.definition("cast", callee)
        if cast is not None and isinstance(line.cast, ast.Call):
            arguments = evaluate_arguments(line.cast.arguments, cast.parameters, {}, self.report, callee.text)
            self._height(line.cast, arguments)
        return Character(name, callee.text, tuple(arguments.items()), line.span)

    def _height(self, call: ast.Call, arguments: dict[str, float | str]) -> None:
        height = arguments.get("height")
        if isinstance(height, float) and not SHORTEST_PERSON <= height <= TALLEST_PERSON:
            span = next(a.span for a in call.arguments if a.name.text == "height")
            self.report.error(
                "VDS067",
                span,
                label=f"nobody is {height:g}m tall",
                help=f"from {SHORTEST_PERSON:g}m to {TALLEST_PERSON:g}m",
            )

    def time(self, time: ast.Name | None) -> str | None:
        """A time of day; None where none is said or known."""
        if time is None or time.text in words.TIMES:
            return time.text if time else None
        meant = nearest(time.text, words.TIMES)
        self.report.error(
            "VDS063",
            time.span,
            label=f"`{time.text}` is no time of day",
            help=f"it may be {listing(words.TIMES)}",
            suggestion=meant,
            fix=meant,
        )
        return None

    def setting(self, written: ast.Name) -> Setting:
        """The set and room a dotted name means."""
        name = ast.Name(
            written.parts[:1],
            Span(written.span.source, written.span.start, written.span.start + len(written.parts[0])),
        )
        if name.text not in self.catalog.names("set") and (near := self._room_elsewhere(written)):
            self.report.error(
                "VDS062",
                written.span,
                label=f"no set is called `{written.text}`",
                help="say which set the room is in",
                suggestion=near,
                fix=near,
            )
            return Setting(name.text, (), "day", None)
        definition = self.definition("set", name)
        root: SetNode | None = getattr(definition, "root", None)
        time = str(getattr(definition, "time", "day"))
        if root is None:
            return Setting(name.text, (), time, None)
        room = written.parts[1:]
        node = node_at(root, room)
        if node is None or node.kind not in ROOMS:
            rooms = [".".join((root.name, *path)) for path, each in walk(root) if each.kind in ROOMS and path]
            meant = nearest(written.text, rooms)
            self.report.error(
                "VDS062",
                written.span,
                label=f"`{name.text}` has no room `{'.'.join(room)}`",
                help=f"it has {listing(rooms, last='and')}" if rooms else "it has no rooms",
                suggestion=meant,
                fix=meant,
            )
            return Setting(name.text, (), time, None)
        return Setting(name.text, room, time, root)

    def _room_elsewhere(self, written: ast.Name) -> str | None:
        """The full name of a room that was named without its set."""
        for name in self.catalog.names("set"):
            root = getattr(self.catalog.get("set", name), "root", None)
            if root is not None and (node := node_at(root, written.parts)) is not None and node.kind in ROOMS:
                return ".".join((name, *written.parts))
        return None
