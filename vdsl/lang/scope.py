"""Names of places and things in a scene: inside the scene first, then outward.

A :class:`Scope` is one scene's view of its set. A name is looked for in the scene's node, then in the
node around it, up to the set; at each of these the shallowest find wins, and several at the same
depth are ambiguous. Names of nodes and of spots the set gives come before the spots of props.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from .ast import Name
from .catalog import CatalogLike
from .definitions.types import DefinitionBase, SetNode
from .diagnostics import Report, listing, nearest
from .ir import Placement, Target
from .source import Span
from .words import counts_under, fold

ROOMS = ("set", "room", "area")


def _shared(a: tuple[str, ...], b: tuple[str, ...]) -> int:
    """How many parts two paths begin alike with."""
    return next((k for k, (x, y) in enumerate(zip(a, b, strict=False)) if x != y), min(len(a), len(b)))


@dataclass(frozen=True)
class Found:
    """A place in a set: ``path`` from the root, without the set's name; ``spot``: its last part is one."""

    path: tuple[str, ...]
    node: SetNode
    spot: bool

    @property
    def kind(self) -> str:
        if self.spot:
            return "spot"
        return "room" if self.node.kind in ROOMS else "object"


class Scope:
    """The names a scene sees. ``root`` is the set's tree, ``room`` the scene's path inside it."""

    def __init__(self, root: SetNode, room: tuple[str, ...], catalog: CatalogLike) -> None:
        self.root = root
        self.room = room
        self.catalog = catalog
        self._cache: dict[tuple[str, ...], list[Found]] = {}
        self._carried: dict[tuple[str, ...], SetNode] = {}

    def carry(self, path: tuple[str, ...], prop: str, span: Span) -> None:
        """Let a thing that somebody has with them be found: by their name and its own, and where nothing of
        the set is called so, by its own."""
        self._carried[path] = SetNode(path[-1], "object", prop, (), (), span)
        self._cache.clear()

    def carried_by(self, who: str, name: str) -> Found | None:
        """A thing that somebody has with them."""
        node = self._carried.get((who, name))
        return None if node is None else Found((who, name), node, False)

    def find(
        self,
        name: Name,
        report: Report,
        any_of: bool = False,
        near: Iterable[tuple[str, ...]] = (),
    ) -> Target | None:
        """The target a name stands for; None where it was reported to be unknown or ambiguous.

        any_of: of several of the same kind, or spots of several rooms, all in the scene, one is taken, with a
        warning: the first of those that share most of their path with one of ``near``
        """
        found = self.look_up(name.parts) or (self._alike(name.text) if any_of else [])
        if len(found) == 1:
            return Target(found[0].kind, found[0].path, name.text, name.span)
        alike = {(f.node.prop if f.node.prop else f.node.kind in ROOMS or f.path, f.spot) for f in found}
        here = all(f.path[: len(self.room)] == self.room for f in found)
        if any_of and found and here and len(alike) == 1:
            shared = [max((_shared(f.path, path) for path in near), default=0) for f in found]
            taken = found[shared.index(max(shared))]
            report.warn(
                "VDS061",
                name.span,
                label=f"`{name.text}` could be any of {len(found)}: `{self._shortest(taken)}` is taken",
                help=f"say which: {listing([self._shortest(f) for f in found])}",
            )
            return Target(taken.kind, taken.path, name.text, name.span)
        if found:
            paths = [".".join((self.root.name, *f.path)) for f in found]
            report.error(
                "VDS061",
                name.span,
                label=f"`{name.text}` could be any of {len(found)}",
                help=f"say which: {listing(paths)}",
                suggestion=self._shortest(found[0]),
            )
            return None
        self._unknown(name, report)
        return None

    def first(self, word: str, span: Span) -> Target | None:
        """What a word that nobody wrote stands for, the first of several; None where there is nothing.

        span: what it is said by
        """
        found = self.look_up((word,))
        return Target(found[0].kind, found[0].path, word, span, implied=True) if found else None

    def has(self, parts: tuple[str, ...]) -> bool:
        """Whether parts of a name mean something here, or are a word for what something here is."""
        return bool(self.look_up(parts) or (len(parts) == 1 and self._alike(parts[0])))

    def _alike(self, word: str) -> list[Found]:
        """What in the scene is no more than counted under a word (``desk_1``, ``desk_2``), or else what is of
        that kind, or of one of which that is another word, whatever it is called."""
        top = node_at(self.root, self.room) or self.root
        nodes = [Found(path, node, False) for path, node in walk(top, self.room) if path != self.room]
        counted = [f for f in nodes if counts_under(word, f.path[-1])]
        kinds = (word, self.catalog.synonyms("prop").get(fold(word), word))
        return counted or [f for f in nodes if f.node.prop in kinds]

    def look_up(self, parts: tuple[str, ...]) -> list[Found]:
        """Everything the parts of a name may mean; one where it is plain, none where it is unknown."""
        if parts not in self._cache:
            found = self._search(parts) or self._with_somebody(parts)
            small = tuple(part.casefold() for part in parts)
            self._cache[parts] = found or (self.look_up(small) if small != parts else [])
        return self._cache[parts]

    def _search(self, parts: tuple[str, ...]) -> list[Found]:
        if parts[0] == self.root.name:
            if len(parts) == 1:
                return [Found((), self.root, False)]
            inner = self._under(self.root, (), parts[1:], True)
            if inner:
                return inner
        for size in range(len(self.room), -1, -1):
            node = node_at(self.root, self.room[:size])
            if node is None:
                continue
            if parts == (node.name,) and size:
                return [Found(self.room[:size], node, False)]
            for deep in (False, True):
                found = self._shallowest(node, self.room[:size], parts, deep)
                if found:
                    return found
        return []

    def _with_somebody(self, parts: tuple[str, ...]) -> list[Found]:
        return [
            Found(path, node, False) for path, node in self._carried.items() if path[-len(parts) :] == parts
        ]

    def _shallowest(
        self, node: SetNode, path: tuple[str, ...], parts: tuple[str, ...], props: bool
    ) -> list[Found]:
        """Matches below a node, of the least depth at which there are any."""
        level = [(path, node)]
        while level:
            found: list[Found] = []
            for at, each in level:
                found.extend(self._under(each, at, parts, props))
            nodes = [f for f in found if not f.spot]
            if found:
                return nodes or found
            level = [((*at, child.name), child) for at, each in level for child in each.children]
        return []

    def _under(
        self, node: SetNode, path: tuple[str, ...], parts: tuple[str, ...], props: bool
    ) -> list[Found]:
        """What the parts mean read from directly below ``node``, part for part."""
        if len(parts) == 1 and parts[0] in self._spots(node, props):
            spots = [Found((*path, parts[0]), node, True)]
        else:
            spots = []
        found: list[Found] = []
        for child in node.children:
            if child.name != parts[0]:
                continue
            here = (*path, child.name)
            if len(parts) == 1:
                found.append(Found(here, child, False))
            else:
                found.extend(self._under(child, here, parts[1:], True))
        return found or spots

    def _spots(self, node: SetNode, props: bool) -> tuple[str, ...]:
        return (*node.spots, *self.prop_spots(node)) if props else node.spots

    def prop_spots(self, node: SetNode) -> tuple[str, ...]:
        """Spots and moving parts that come with the prop placed at a node."""
        if node.prop is None:
            return ()
        prop = self.catalog.get("prop", node.prop)
        return (*getattr(prop, "spots", ()), *getattr(prop, "parts", ()))

    def prop(self, name: str) -> DefinitionBase | None:
        """The definition of a prop; None where there is none."""
        return self.catalog.get("prop", name)

    def prop_of(self, node: SetNode) -> DefinitionBase | None:
        """The definition of what stands at a node."""
        return None if node.prop is None else self.prop(node.prop)

    def props(self) -> tuple[str, ...]:
        """Names of all props there are."""
        return self.catalog.names("prop")

    def node_of(self, target: Target) -> SetNode | None:
        """The tree's node of a target (for a spot, the node it is on)."""
        path = target.path[:-1] if target.kind == "spot" else target.path
        return self._carried.get(path) or node_at(self.root, path)

    def has_seat(self, target: Target) -> bool:
        """Whether one can sit at a target."""
        if target.kind == "spot":
            return target.path[-1].startswith("seat")
        node = self.node_of(target)
        return node is not None and self._is_seat(node)

    def may_have_seats_around(self, target: Target) -> bool:
        """Whether there are seats where a table or the like stands: which of them are at it, only the built
        set can tell."""
        node = node_at(self.root, target.path)
        around = node_at(self.root, target.path[:-1])
        if target.kind != "object" or node is None or around is None or not self._is_table(node):
            return False
        return any(self._is_seat(below) for child in around.children for _, below in walk(child))

    def _is_seat(self, node: SetNode) -> bool:
        return any(s.startswith("seat") for s in (*node.spots, *self.prop_spots(node)))

    def _is_table(self, node: SetNode) -> bool:
        return "top" in (*node.spots, *self.prop_spots(node))

    def sitting(self, target: Target, placed: Iterable[Placement]) -> Iterator[Placement]:
        """Those of the placed who sit at the thing a target is, or is a spot of."""
        node = self.node_of(target)
        for each in placed:
            somewhere = each.posture == "sitting" and each.at.kind not in ("free", "character")
            if somewhere and self.node_of(each.at) is node:
                yield each

    def has_seat_left(self, target: Target, placed: Iterable[Placement]) -> bool:
        """Whether somebody more can sit there; True also where only the built set can tell."""
        node = self.node_of(target)
        prop = self.catalog.get("prop", node.prop) if node and node.prop else None
        body = getattr(prop, "body", ())
        if node is None or any(e.head.text == "spot" for each in body if each.body for e in each.body):
            return True
        spots = [e.values[0] for e in body if e.head.text == "spot" and e.values]
        names = [*node.spots, *(s.text for s in spots if isinstance(s, Name))]
        return sum(1 for _ in self.sitting(target, placed)) < sum(n.startswith("seat") for n in names)

    def known(self) -> tuple[str, ...]:
        """All names of the set and of what people have with them."""
        return (*_names(self.root), *(path[-1] for path in self._carried))

    def seats(self) -> tuple[str, ...]:
        """Names of what one can sit on, in the scene."""
        top = node_at(self.root, self.room) or self.root
        return tuple(node.name for _, node in walk(top, self.room) if self._is_seat(node))

    def _unknown(self, name: Name, report: Report) -> None:
        top = node_at(self.root, self.room) or self.root
        carried = list(dict.fromkeys(path[-1] for path in self._carried))
        near = [*_names(top), *carried]
        every = [*_names(self.root), *carried]
        if len(name.parts) > 1:
            self._unknown_part(name, report)
            return
        meant = nearest(name.text, near) or nearest(name.text, every)
        things = [n for n in near if n != top.name]
        report.error(
            "VDS060",
            name.span,
            label=f"nothing is called `{name.text}` here",
            help=f"the scene has {listing(things, last='and')}" if things else None,
            suggestion=meant,
            fix=meant,
        )

    def _unknown_part(self, name: Name, report: Report) -> None:
        """Of a dotted name, say which part is wrong."""
        for size in range(len(name.parts) - 1, 0, -1):
            found = self.look_up(name.parts[:size])
            if len(found) != 1:
                continue
            node = found[0].node
            inside = [c.name for c in node.children] + list(self._spots(node, True))
            part = name.parts[size]
            meant = nearest(part, inside)
            whole = ".".join(name.parts[:size])
            report.error(
                "VDS060",
                name.span,
                label=f"`{whole}` has no `{part}`",
                help=f"it has {listing(dict.fromkeys(inside), last='and')}"
                if inside
                else "it has no parts or spots",
                suggestion=f"{whole}.{meant}" if meant else None,
                fix=f"{whole}.{meant}" if meant else None,
            )
            return
        first = name.parts[0]
        meant = nearest(first, _names(self.root))
        report.error("VDS060", name.span, label=f"nothing is called `{first}` here", suggestion=meant)

    def _shortest(self, found: Found) -> str:
        """The shortest dotted name that means this and nothing else."""
        for size in range(1, len(found.path) + 1):
            parts = found.path[-size:]
            if [f.path for f in self.look_up(parts)] == [found.path]:
                return ".".join(parts)
        return ".".join((self.root.name, *found.path))


def node_at(root: SetNode, path: tuple[str, ...]) -> SetNode | None:
    """The node at a path from the root, or None."""
    node: SetNode | None = root
    for part in path:
        node = next((child for child in node.children if child.name == part), None) if node else None
    return node


def walk(node: SetNode, path: tuple[str, ...] = ()) -> Iterator[tuple[tuple[str, ...], SetNode]]:
    """A node and everything below it, with paths."""
    yield path, node
    for child in node.children:
        yield from walk(child, (*path, child.name))


def _names(node: SetNode) -> list[str]:
    """Names of nodes and their spots below a node, each once."""
    return list(dict.fromkeys(name for _, each in walk(node) for name in (each.name, *each.spots)))
