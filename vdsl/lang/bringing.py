"""Things people bring to a scene: what they hold when it opens, and what they take out of a pocket.

Assumes a scene whose set and people are known. Guarantees that everything brought can be carried, and that
who needs the same thing twice brings it once.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from . import ast
from .catalog import CatalogLike
from .definitions.types import DefinitionBase
from .diagnostics import Report, nearest
from .evaluate import evaluate_arguments
from .ir import Beat, Carried, Target
from .scope import Scope
from .source import Span
from .words import fold

if TYPE_CHECKING:
    from .placement import SceneBeingRead


#: Props that are also called by what is in them.
_VESSELS = ("glass", "cup", "wine_glass", "beer_glass", "can")


def held_at_first(
    written: ast.Name | ast.Call, who: str, scene: SceneBeingRead, report: Report
) -> Target | None:
    """``holding bag``, ``holding bag(color navy)``: the thing of the scene that is called so alone, if nobody
    holds it yet; else a prop.

    None where it was reported that there is no such thing, or that it is none to hold.
    """
    name = written.callee if isinstance(written, ast.Call) else written
    if scene.scope is None:
        return None
    there = scene.scope.look_up(name.parts) if isinstance(written, ast.Name) else []
    called = carried_called(name.text, scene.scope.catalog)
    free = len(there) == 1 and scene.hands.holder(there[0].path) is None
    if there and (free or not called):
        target = scene.scope.find(name, report)
        if target is None:
            return None
        node = scene.scope.node_of(target)
        prop = scene.scope.prop_of(node) if node is not None and target.kind == "object" else None
        if not getattr(prop, "movable", False):
            _cannot_be_held(name, report)
            return None
        scene.hands.give(who, target.path)
        return target
    prop = scene.scope.prop(called or name.text)
    if prop is None:
        known = scene.scope.props()
        if name.text not in known:
            meant = nearest(name.text, known)
            report.error(
                "VDS060",
                name.span,
                label=f"nothing is called `{name.text}` here, and no prop is",
                help="`vdsc assets props --search WORDS` finds one",
                suggestion=meant,
                fix=meant,
            )
        return None
    if not getattr(prop, "movable", False):
        _cannot_be_held(name, report)
        return None
    arguments: dict[str, float | str] = {}
    if isinstance(written, ast.Call):
        arguments = evaluate_arguments(written.arguments, prop.parameters, {}, report, prop.name)
    thing = Carried(who, name.text, called, tuple(arguments.items()), held=True)
    return carry(thing, scene, name.span)


def _cannot_be_held(name: ast.Name, report: Report) -> None:
    report.error(
        "VDS081",
        name.span,
        label=f"`{name.text}` is nothing one holds",
        help="what can be carried has a `grip`; `vdsc assets props` says which do",
    )


def carry(thing: Carried, scene: SceneBeingRead, span: Span) -> Target:
    """A thing as a target, known to the scene from here on."""
    assert scene.scope is not None
    scene.carried[thing.path] = thing
    scene.scope.carry(thing.path, thing.prop, span)
    if thing.held:
        scene.hands.give(thing.who, thing.path)
    return Target("object", thing.path, thing.name, span)


def bring(beat: Beat, scene: SceneBeingRead, catalog: CatalogLike) -> Beat:
    """The beat with what its action is done with, where its line names nothing.

    That is one of the kind that is in a hand already, else one that is taken out.
    """
    definition = catalog.get("action", beat.action)
    brings: str = getattr(definition, "brings", "")
    slot: str = getattr(definition, "needs", "none")
    if not brings or slot not in ("target", "second") or scene.scope is None:
        return beat
    if getattr(beat, slot) is not None:
        return beat
    held = scene.hands.held_by(beat.character)
    for path in held:
        if _kind_of(path, scene.scope) == brings:
            return replace(beat, brought=Target("object", path, path[-1], beat.span))
    if held and getattr(definition, "unless_held", False):
        return beat
    path = (beat.character, brings)
    if path in scene.carried and scene.carried[path].about:  # it lies there: that one is meant
        there = Target("object", path, brings, beat.span, implied=True)
        return replace(beat, target=there) if slot == "target" else replace(beat, second=there)
    if path not in scene.carried:
        if not getattr(scene.scope.prop(brings), "movable", False):
            return beat
        return replace(beat, brought=carry(Carried(beat.character, brings, brings), scene, beat.span))
    return replace(beat, brought=Target("object", path, brings, beat.span))


def bring_named(
    word: str, span: Span, who: str, scene: SceneBeingRead, catalog: CatalogLike
) -> Target | None:
    """What somebody has with them, by the name of its prop or another word for that.

    None where nothing that can be carried is called so.
    """
    called = carried_called(word, catalog)
    if scene.scope is None or not called:
        return None
    path = (who, word)
    if path not in scene.carried:
        carry(Carried(who, word, called), scene, span)
    return Target("object", path, word, span)


def put_about(
    word: str, span: Span, who: str, scene: SceneBeingRead, catalog: CatalogLike, report: Report
) -> Target | None:
    """What a line does something to and the scene has not: a prop that can be carried, lying near who acts.

    None where nothing that can be carried is called so.
    """
    called = carried_called(word, catalog)
    if scene.scope is None or not called or (called != word and called in _VESSELS):
        return None  # `looks at the water`
    report.warn(
        "VDS083",
        span,
        label=f"`{word}` is not in this scene: one is put near {who}",
        help=f"`{who} at NAME holding {word}` puts it into a hand, a set of your own where you like",
    )
    return carry(Carried(who, word, called, about=True), scene, span)


def carried_called(word: str, catalog: CatalogLike) -> str:
    """The prop that can be carried which a word is a name of; "" for none."""
    called = word if word in catalog.names("prop") else catalog.synonyms("prop").get(fold(word), "")
    return called if called and getattr(catalog.get("prop", called), "movable", False) else ""


def check_brings(definition: DefinitionBase, at: Span, catalog: CatalogLike, report: Report) -> None:
    """Report an action that brings what is no prop, or none to carry; ``at``: where it says so."""
    name: str = getattr(definition, "brings", "")
    known = catalog.names("prop")
    if name not in known:
        meant = nearest(name, known)
        report.error("VDS115", at, label=f"there is no prop `{name}`", suggestion=meant, fix=meant)
    elif (prop := catalog.get("prop", name)) is not None and not getattr(prop, "movable", False):
        report.error("VDS145", at, label=f"`{name}` is nothing one holds")


def check_others(definition: DefinitionBase, catalog: CatalogLike, report: Report) -> None:
    """Report an action that says it is another one, which there is not, where it is done to somebody, or to
    nobody."""
    known = catalog.names("action")
    said: tuple[tuple[str, Span], ...] = getattr(definition, "others_at", ())
    for entry, at in said:
        name: str = getattr(definition, entry)
        if name not in known:
            meant = nearest(name, known)
            report.error("VDS071", at, label=f"no action is called `{name}`", suggestion=meant, fix=meant)


def _kind_of(path: tuple[str, ...], scope: Scope) -> str | None:
    node = scope.node_of(Target("object", path, "", scope.root.span))
    return None if node is None else node.prop
