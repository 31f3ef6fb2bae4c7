"""What an action is done to: the words after it into one or two :class:`vdsl.lang.ir.Target`.

Assumes the words of one line without those that say nothing (:mod:`vdsl.lang.phrases`). Guarantees that what
is no target is reported at its place, and what does not show is left out with a warning.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from itertools import pairwise

from . import ast, phrases, pronouns, words
from .bringing import carried_called
from .catalog import CatalogLike
from .definitions.types import DefinitionBase
from .diagnostics import Report, is_slip, listing, nearest
from .ir import Target
from .scope import Scope
from .source import Span

KIND_WORDS = {"place": "a place", "object": "a thing", "character": "someone"}


class TargetReader:
    """Reads the targets of the lines of one scene.

    scope: of the scene, None where its set is unknown (then no targets are); bring: what somebody takes out
    who has not got it, as a target, from its word, where that stands and who it is; None where that cannot be
    put_about: the same of what lies near them; stand_in: the same of what no prop is called
    """

    def __init__(
        self, catalog: CatalogLike, characters: tuple[str, ...], scope: Scope | None, report: Report
    ) -> None:
        self.catalog = catalog
        self.characters = characters
        self.scope = scope
        self.report = report
        self.bring: Callable[[str, Span, str], Target | None] | None = None
        self.put_about: Callable[[str, Span, str], Target | None] | None = None
        self.stand_in: Callable[[str, Span, str], Target | None] | None = None
        self.who: str | None = None  # who acts in the line that is read
        self.said: tuple[ast.Name, ...] = ()  # all words of it
        self.prose = False  # whether it is a sentence, as `anna opens the door`, and not `anna open door`

    def is_name(self, word: ast.Name) -> bool:
        """Whether a word is somebody's, or something's in the scene."""
        known = self.scope is not None and bool(self.scope.look_up(word.parts))
        return known or word.text in self.characters

    def is_thing(self, word: ast.Name) -> bool:
        """Whether a word is one for a prop."""
        return word.text in self.catalog.names("prop") or words.fold(word.text) in self.catalog.synonyms(
            "prop"
        )

    def in_hand(
        self, rest: tuple[ast.Name, ...], definition: DefinitionBase
    ) -> tuple[tuple[ast.Name, ...], Target | None]:
        """What follows an action that needs no hands without what who goes, stands or sits has in one, and
        that: ``walks in with a bag``."""
        still = getattr(definition, "needs", "none") == "none"
        at = next((k for k, word in enumerate(rest) if word.text == "with"), len(rest))
        end = next((k for k in range(at + 1, len(rest)) if rest[k].text in words.PREPOSITIONS), len(rest))
        group = list(rest[at + 1 : end])
        if not group or not still or getattr(definition, "group", "") not in ("going", "posture"):
            return rest, None
        whole, group = rest[at].span.to(group[-1].span), self._without_adjectives(group, True)
        word, span = "_".join(name.text for name in group), group[0].span.to(group[-1].span)
        before = {id(name): last.text for last, name in pairwise(self.said)}
        own = self.scope.carried_by(self.who, word) if self.scope is not None and self.who else None
        there = own is None and not self._is_nowhere(group) and group[0].text not in self.characters
        if self.bring is None or self.who is None or not (there or carried_called(word, self.catalog)):
            return rest, None
        thing = None
        if there and before.get(id(rest[at + 1])) == "the":  # it is somewhere in the scene: nobody has it yet
            self._leave_out(whole, f"nobody has it yet; `({self.who} picks up {word})` before does it")
        else:
            thing = self.bring(word, span, self.who)
        rest = rest[:at] + rest[end:]
        while rest and rest[-1].text in words.PREPOSITIONS and not self.is_name(rest[-1]):
            rest = rest[:-1]  # `hurries in`
        return rest, thing

    def named(
        self, rest: tuple[ast.Name, ...], definition: DefinitionBase, verb: ast.Name
    ) -> list[Target] | None:
        """The targets named; None where one was reported. verb: the last word of the action"""
        groups = self._split(rest)
        if groups is None:
            return None
        if groups and len(groups[0]) > 1 and self._is_given_to(groups[0][0], definition):
            groups = [groups[0][1:], groups[0][:1], *groups[1:]]  # `give ben the cup`
        elif self.prose and groups and len(groups[0]) > 1 and groups[0][0].text in self.characters:
            whom, *first = groups[0]  # `pours him a drink`
            if "character" not in _kinds(definition)[0] and not self._is_nothing(first):
                self._leave_out(whom.span, f"`{getattr(definition, 'name', 'it')}` is done for nobody")
                groups = [first, *groups[1:]]
        groups = self._taken(groups, (verb, *rest), definition)
        if getattr(definition, "anything", False):  # `write poem` is done at a desk
            groups = [g for g in groups if not self._is_nowhere(g) or self._is_like_something(g)]
        groups = self._there(groups, (verb, *rest), definition)
        if len(groups) > 2:
            self.report.error("VDS073", groups[2][0].span, label="an action has two targets at most")
            return None
        needs, with_first = getattr(definition, "needs", "none"), rest[:1] != () and rest[0].text == "with"
        held = {"target": 0, "any": 0, "second": 0 if with_first and len(groups) == 1 else 1}.get(needs)
        things = [(not k or "object" in k) and _is_done_to(definition) for k in _kinds(definition)]
        before = {id(word): last.text for last, word in pairwise((verb, *rest))}
        found = [
            self._target(group, n == held, n == 0, things[n] and before.get(id(group[0])) != "with")
            for n, group in enumerate(groups)
        ]
        known = [target for target in found if target is not None]
        return known if len(known) == len(found) else None

    def _taken(
        self, groups: list[list[ast.Name]], said: tuple[ast.Name, ...], definition: DefinitionBase
    ) -> list[list[ast.Name]]:
        """Without where it is done, where an action takes no more targets: `peeks at her over the paper`."""
        takes = [getattr(definition, name, "none") != "none" for name in ("target", "second")]
        most = 2 if takes[1] else int(takes[0])
        where: tuple[str, ...] = (*words.WHERE, *words.BESIDES)
        if self.prose:
            where = tuple(word for word in words.PREPOSITIONS if word not in words.WHITHER)
        before = {id(word): last for last, word in pairwise(said) if last.text in where}
        while groups and id(groups[-1][0]) in before:
            link = before[id(groups[-1][0])].text
            loose = link in words.BESIDES and self._is_nothing(groups[-1])
            loose = loose or (link in words.BY_SOMEBODY and self._is_wrongly_somebody(groups, definition))
            if not loose and (len(groups) <= most or (link == "with" and not self.prose)):
                break
            *groups, last = groups
            span = before[id(last[0])].span.to(last[-1].span)
            self._leave_out(span, f"`{getattr(definition, 'name', 'it')}` is done to no more")
        return groups

    def _leave_out(self, span: Span, why: str) -> None:
        self.report.warn("VDS082", span, label=f"`{span.text}` is left out", help=why)

    def _there(
        self, groups: list[list[ast.Name]], said: tuple[ast.Name, ...], definition: DefinitionBase
    ) -> list[list[ast.Name]]:
        """Without what a sentence looks or points at, or listens to, and the scene has not."""
        optional = getattr(definition, "target", "none") == "optional"
        going = getattr(definition, "group", "") in ("going", "posture")
        before = {id(word): last.text for last, word in pairwise(self.said)}
        thing = len(groups) == 1 and before.get(id(groups[0][0])) in words.ARTICLES
        if not (self.prose and optional and thing) or going or not self._is_nothing(groups[0]):
            return groups
        group = groups[0]
        help = f"nothing is called `{group[-1].text}` here; `vdsc assets props --search WORDS` finds things"
        self._leave_out(group[0].span.to(group[-1].span), help)
        return []

    def _is_wrongly_somebody(self, groups: list[list[ast.Name]], definition: DefinitionBase) -> bool:
        """Whether the last target is somebody, to whom an action is not done: `sleeps beside anna`."""
        first, second = len(groups) == 1, len(groups) == 2
        kinds = _kinds(definition)[0 if first else 1]
        optional = getattr(definition, "target" if first else "second", "none") == "optional"
        somebody = len(groups[-1]) == 1 and groups[-1][0].text in self.characters
        return (first or second) and somebody and optional and bool(kinds) and "character" not in kinds

    def _is_nothing(self, group: list[ast.Name]) -> bool:
        """Whether words name nothing in the scene or in the library, nor nearly."""
        for last in (group[-1], *phrases.of_several(group[-1])):
            said = [*group[:-1], last]
            if any(self._known(said[k:], True) for k in range(len(said))):
                return False
        return not self._is_like_something(group)

    def _is_given_to(self, word: ast.Name, definition: DefinitionBase) -> bool:
        """Whether somebody named before a thing is whom it is given to, shown to, thrown to."""
        second = getattr(definition, "second", "none")
        also: tuple[str, ...] = tuple(getattr(definition, "second_kinds", ()))
        return word.text in self.characters and second != "none" and (not also or "character" in also)

    def _split(self, rest: tuple[ast.Name, ...]) -> list[list[ast.Name]] | None:
        """Groups of words that name one target each, without prepositions."""
        groups: list[list[ast.Name]] = []
        fresh = True
        last: ast.Name | None = None
        for name in rest:
            if name.text in words.PREPOSITIONS and not self.is_name(name):
                fresh, last = True, name
            elif fresh:
                groups.append([name])
                fresh, last = False, None
            else:
                groups[-1].append(name)
        if last is not None:
            self.report.error("VDS072", last.span, label=f"a name is missing after `{last.text}`")
            return None
        return groups

    def _target(self, group: list[ast.Name], held: bool, first: bool, thing: bool) -> Target | None:
        """One target by its word, or by several words that are one name (``bus stop``), or end in one (``old
        car``).

        held: it is to be in a hand, so that what the scene has not is brought, if it is a prop; thing: it may
        be a thing, so that such a prop lies about; first: it is what something is done to, and not where
        """
        group = self._without_adjectives(group, held or thing)
        if len(group) > 1 and self.scope is not None:
            for joint in ("_", "-"):
                parts = (joint.join(name.text for name in group),)
                if self.scope.has(parts):
                    return self._resolve(ast.Name(parts, group[0].span.to(group[-1].span)))
            inside = ast.Name(tuple(name.text for name in group), group[0].span.to(group[-1].span))
            if self.scope.look_up(inside.parts):  # `kitchen door`
                return self._resolve(inside)
        about = self.put_about if thing and not self._is_kind(group) else None
        get = self.bring if held else about
        if get is not None and self.who is not None and self._is_nowhere(group):
            span = group[0].span.to(group[-1].span)
            brought = get("_".join(name.text for name in group), span, self.who)
            if brought is not None:
                return brought
        if first and (held or thing) and self._may_have_stand_in(group):
            assert self.stand_in is not None
            assert self.who is not None
            stands = self.stand_in(group[-1].text, group[-1].span, self.who)
            if stands is not None:
                return stands
        if len(group) > 1 and all(self._is_nowhere([name]) for name in group):
            return self._resolve(group[-1])  # `red dress`: there is no dress
        if len(group) > 1:
            names = group[0].span.to(group[-1].span).text
            help = f"a second target follows a word like `to`: `{group[0].text} to {group[1].text}`"
            if any(name.text == "and" for name in group):
                help = self._two_lines()
            self.report.error("VDS073", group[1].span, label=f"`{names}` is not one name", help=help)
            return None
        return self._resolve(group[0])

    def _may_have_stand_in(self, group: list[ast.Name]) -> bool:
        """Whether words of a sentence are an article or a possessive and a noun that nobody knows: ``her old
        harp``."""
        before = {id(word): last.text for last, word in pairwise(self.said)}
        noun = before.get(id(group[0])) in words.ARTICLES
        known = (*self.characters, *(self.scope.known() if self.scope is not None else ()))
        close = any(nearest(group[-1].text, [name]) is not None for name in self.characters)
        return (
            self.prose
            and noun
            and not close
            and self.stand_in is not None
            and self.who is not None
            and all(self._is_nowhere([name]) and len(name.parts) == 1 for name in group)
            and group[-1].text not in phrases.BODY
            and not pronouns.is_person(group[-1].text)
            and not any(is_slip(group[-1].text, name) for name in known)
        )

    def _without_adjectives(self, group: list[ast.Name], held: bool) -> list[ast.Name]:
        """The words from the first on with which they are a name, after words for what that is like; of
        several (``candles``), one."""
        if self.scope is None or any(name.text == "and" for name in group) or self._known(group, held):
            return group
        for last in (group[-1], *phrases.of_several(group[-1])):
            said = [*group[:-1], last]
            first = next((k for k in range(len(said)) if self._known(said[k:], held)), len(said))
            if first == len(said):
                continue
            two = any(self._known([word], held) for word in said[:first])  # names: `anna a note`
            if two or any(nearest(word.text, self.characters) for word in said[:first]):
                return group
            if first:
                names = [" ".join(name.text for name in part) for part in (said[:first], said[first:])]
                span = group[0].span.to(group[first - 1].span)
                left, kept = f"`{names[0]}` is left out", f"`{names[1]}` looks as it is defined"
                self.report.warn("VDS082", span, label=left, help=kept)
            return said[first:]
        return group

    def _known(self, said: list[ast.Name], held: bool) -> bool:
        """Whether words are somebody's name, or something's that is there, or is had if it is to be held."""
        if len(said) == 1 and not self._is_nowhere(said):
            return True
        parts = tuple(name.text for name in said)
        if self.scope is not None and any(
            self.scope.has(each) for each in (parts, ("_".join(parts),), ("-".join(parts),))
        ):
            return True
        return held and bool(carried_called("_".join(parts), self.catalog))

    def _two_lines(self) -> str:
        """What to write for a line that says two things."""
        said = [name.text for name in self.said]
        at = said.index("and")
        named = [word in self.characters for word in said]
        first = said[: at - 1] if all(named[at - 1 : at + 2 : 2]) else said[:1]  # `looks at anna and ben`
        lines = (said[:at], [*first, *said[at + 1 :]])
        one, other = (f"`({' '.join(words)})`" for words in lines)
        return f"a line says one thing; were these two meant, one below the other? {one} {other}"

    def _is_nowhere(self, group: list[ast.Name]) -> bool:
        """Whether words name neither anybody nor anything in the scene."""
        if self.scope is None or group[0].text in self.characters:
            return False
        parts = group[0].parts if len(group) == 1 else ("_".join(name.text for name in group),)
        who = self.who
        own = self.scope.carried_by(who, parts[-1]) if who and len(parts) == 1 else None
        return own is None and not self.scope.look_up(parts)

    def _is_kind(self, group: list[ast.Name]) -> bool:
        """Whether the scene has such a thing, whatever it is called."""
        return self.scope is not None and self.scope.has(("_".join(name.text for name in group),))

    def _is_like_something(self, group: list[ast.Name]) -> bool:
        """Whether words are probably a name in the scene, or somebody's, not quite written as it is."""
        known = (*self.characters, *(self.scope.known() if self.scope is not None else ()))
        return any(nearest(name.text, known) is not None for name in group)

    def _resolve(self, name: ast.Name) -> Target | None:
        who = self.who
        own = self.scope.carried_by(who, name.text) if self.scope and who else None
        if own is not None:
            return Target("object", own.path, name.text, name.span)
        return resolve(name, self.characters, self.scope, self.report, any_of=True)

    def fits(self, node: ast.BeatNode, action: str, definition: DefinitionBase, named: list[Target]) -> bool:
        """Whether the targets are what the action takes."""
        amiss = _amiss(node, action, definition, named)
        if amiss is not None:
            code, span, label, help = amiss
            self.report.error(code, span, label=label, help=help)
        return amiss is None


def _amiss(
    node: ast.BeatNode, action: str, definition: DefinitionBase, named: list[Target]
) -> tuple[str, Span, str, str | None] | None:
    """What is wrong with the targets of an action, as code, place, label and help: their number, then their
    kinds, the second one's first."""
    kinds, also = _kinds(definition)
    wants = {
        n: getattr(definition, n, default) for n, default in (("target", "optional"), ("second", "none"))
    }
    example = " ".join((node.words[0].text, action, *(target.written for target in named[:1])))
    if wants["target"] == "required" and not named:
        return "VDS072", node.span, f"`{action}` needs {_words(kinds)}", f"as in `({example} …)`"
    if wants["second"] == "required" and len(named) == 1:
        return "VDS072", node.span, f"`{action}` needs a second target", f"as in `({example} to …)`"
    if wants["target"] == "none" and named:
        return "VDS073", named[0].span, f"`{action}` takes no target", "leave it out"
    if wants["second"] == "none" and len(named) == 2:
        return "VDS073", named[1].span, f"`{action}` takes no second target", "leave it out"
    if len(named) == 2 and also and not kind_fits(named[1], also):
        label = f"the second target of `{action}` is {_words(also)}"
        return "VDS074", named[1].span, label, f"`{named[1].written}` is {_is(named[1])}"
    if named and kinds and not kind_fits(named[0], kinds):
        label = f"`{action}` is done to {_words(kinds)}, `{named[0].written}` is {_is(named[0])}"
        return "VDS074", named[0].span, label, None
    return None


def _words(kinds: tuple[str, ...]) -> str:
    return " or ".join(KIND_WORDS.get(kind, kind) for kind in kinds) or "a target"


def _kinds(definition: DefinitionBase) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """What an action may be done to, first and second; () for anything."""
    first, second = (getattr(definition, name, ()) for name in ("target_kinds", "second_kinds"))
    return tuple(first), tuple(second)


def _is_done_to(definition: DefinitionBase) -> bool:
    """Whether an action is done to a thing as such: it goes nowhere, nobody sits or lies on it, and moves no
    part of it, as a door's leaf, which things that are carried have not."""
    moves = (move for variant in getattr(definition, "variants", ()) for move in variant.part.moves)
    still = getattr(definition, "group", "") not in ("going", "posture")
    return still and not any(move.kind == "drive" for move in moves)


def resolve(
    name: ast.Name,
    characters: tuple[str, ...],
    scope: Scope | None,
    report: Report,
    any_of: bool = False,
    near: Iterable[tuple[str, ...]] = (),
) -> Target | None:
    """A character or something in the scene; any_of, near: as in :meth:`.scope.Scope.find`"""
    if name.text in characters:
        return Target("character", (name.text,), name.text, name.span)
    if scope is None:
        return None
    meant = nearest(name.text, characters)
    if meant is not None and not scope.look_up(name.parts):
        unknown_character(name, characters, report)
        return None
    return scope.find(name, report, any_of, near)


def unknown_character(word: ast.Name, characters: tuple[str, ...], report: Report) -> None:
    """Report a name that is no character's."""
    meant = nearest(word.text, characters)
    if characters:
        known = f"characters are {listing(characters, last='and')}"
        help = known
        small = phrases.is_small(word.text) or phrases.says_how(word)
        if pronouns.is_person(word.text) or word.span.text.istitle() or not (meant or small):
            help = f"{known}; a line `character {word.text} = woman`, or `man`, makes one more"
        if word.text in phrases.PRONOUNS:
            help = f"say who by name, of {listing(characters, last='and')}"
    else:
        help = f"add a line `character {word.text} = woman` above"
    report.error(
        "VDS065",
        word.span,
        label=f"no character is called `{word.text}`",
        help=help,
        suggestion=meant,
        fix=meant,
    )


def kind_fits(target: Target, kinds: tuple[str, ...]) -> bool:
    if target.kind == "character":
        return "character" in kinds
    if target.kind == "room":
        return "place" in kinds
    return "place" in kinds or "object" in kinds


def _is(target: Target) -> str:
    return {"character": "someone", "room": "a room", "spot": "a place", "object": "a thing"}[target.kind]
