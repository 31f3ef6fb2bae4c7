"""The words of one ``(char do sth)`` into a :class:`vdsl.lang.ir.Beat`.

The first word is the character; the longest run after it that is an action is the action; what is
left are one or two targets, the second after a word like ``to`` or ``with``. A word for the manner
(``briskly``) may stand anywhere after the character.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

from runtime.motion.manner import MANNERS

from . import ast, phrases, words
from .catalog import CatalogLike
from .definitions.types import DefinitionBase
from .diagnostics import Report, listing, nearest
from .ir import Beat, Target
from .pronouns import Mentions
from .scope import Scope
from .source import Span

_MOST_ACTION_WORDS = 5
_MOST_LISTED = 30
#: `pour jug into glass` and `pour glass from jug` are one: what is in the hand is the second target.
_INTO = ("to", "in", "into", "on", "onto")
#: `talk on the phone` is done with it, `look at the phone` to it.
_BY_WHICH = ("on", "into")
_KIND_WORDS = {"place": "a place", "object": "a thing", "character": "someone"}


class BeatReader:
    """Reads beats of one scene. ``scope`` is None where the scene's set is unknown (then no targets are)."""

    def __init__(
        self,
        catalog: CatalogLike,
        characters: tuple[str, ...],
        scope: Scope | None,
        report: Report,
        mentions: Mentions | None = None,
    ) -> None:
        self.catalog = catalog
        self.characters = characters
        self.scope = scope
        self.report = report
        self.bring: Callable[[str, Span, str], Target | None] | None = None
        self.mentions = mentions or Mentions(characters)
        self._said: tuple[ast.Name, ...] = ()
        self._it: tuple[str, ...] = ()  # the name of the thing that was spoken of last
        self._actions = {words.fold(word): name for word, name in catalog.synonyms("action").items()}
        self._actions |= {words.fold(name): name for name in catalog.names("action")}

    def read(self, node: ast.BeatNode) -> Beat | None:
        character, self._said = self._character(node), node.words
        mentions = self.mentions
        mentions.who = character
        node, manner = self._manner(node)
        possessed = next((w.text for w in node.words if w.text in ("her", "his", "their")), "")
        spoken_of = mentions.meant(possessed)
        known = phrases.Known(self.characters, mentions.meant, self._it, self._is_action)
        node = replace(node, words=phrases.plain(node.words, known))
        mentions.read(character, [word.text for word in node.words if word.text in self.characters])
        if len(node.words) < 2:
            self.report.error(
                "VDS070",
                node.span,
                label="nothing is done here",
                help="as in `(anna walk door)`: character, action, target",
            )
            return None
        action, used = self._action(node)
        if action is None:
            return None
        definition = self.catalog.get("action", action)
        rest = phrases.targets_alone(node.words[1 + used :], self._is_name)
        if getattr(definition, "against", 0.0):
            rest = phrases.without_walls(rest, self._is_name)
        named = None if definition is None else self._targets(rest, definition, node.words[used])
        link = next((w.text for w in rest[1:] if w.text in words.PREPOSITIONS), "")
        if definition is None or named is None or character is None:
            return None
        if not named and self.scope is not None:
            unsaid = (self.scope.first(word, node.span) for word in getattr(definition, "otherwise", ()))
            named = [target for target in unsaid if target is not None][:1]
        whom = spoken_of if possessed else mentions.other()
        if not named and whom and self.takes_somebody(action):
            named = [Target("character", (whom,), whom, node.span, implied=True)]
        things = (t for t in named if t.kind == "object" and not t.implied)
        self._it = next((tuple(t.written.split(".")) for t in things), self._it)
        only_second = _is_second(definition, named)
        if not only_second and not self._fits(node, action, definition, named):
            return None
        if len(named) == 2 and link in _INTO and getattr(definition, "needs", "none") == "second":
            named = [named[1], named[0]]
        first, second = (*named, None, None)[:2]
        if only_second or (second is None and _works_with(definition, rest)):
            first, second = None, first
        for target in named:
            if target.kind == "character" and target.path[0] == character:
                self.report.error("VDS075", target.span, label=f"{character} cannot do this to themselves")
                return None
        return Beat(character, action, first, second, node.span, manner)

    def takes_somebody(self, action: str) -> bool:
        """Whether an action is nothing without somebody it is done to, and one will do: ``hug``."""
        definition = self.catalog.get("action", action)
        wants, second = (getattr(definition, name, "none") for name in ("target", "second"))
        kinds = tuple(getattr(definition, "target_kinds", ()))
        return wants == "required" and second != "required" and kinds == ("character",)

    def between(self, action: str) -> bool:
        """Whether two who do an action both do it to each other if nobody is named: ``they talk``."""
        definition = self.catalog.get("action", action)
        return bool(getattr(definition, "mutual", False))

    # -- who and what ----------------------------------------------------------------

    def _character(self, node: ast.BeatNode) -> str | None:
        word = node.words[0]
        if word.text in self.characters:
            return word.text
        unknown_character(word, self.characters, self.report)
        return None

    def _manner(self, node: ast.BeatNode) -> tuple[ast.BeatNode, str]:
        """The beat without its word for the manner, and that word."""
        said = [w for w in node.words[1:] if w.text not in self.characters and words.fold(w.text) in MANNERS]
        for more in said[1:]:
            self.report.error(
                "VDS260",
                more.span,
                label=f"`{said[0].text}` already says how it is done",
                notes=[(said[0].span, "first here")],
            )
        rest = tuple(w for w in node.words if not any(w is s for s in said))
        return replace(node, words=rest), words.fold(said[0].text) if said else ""

    def _action(self, node: ast.BeatNode) -> tuple[str | None, int]:
        """The action, and how many words it took."""
        rest = node.words[1:]
        found: tuple[str, int] | None = None
        for size in range(min(_MOST_ACTION_WORDS, len(rest)), 0, -1):
            action = self._called(rest[:size])
            if action is None or (found is not None and not self._takes(action, rest[size:])):
                continue
            # `look at phone`, where there is a phone, and not `look-at-phone`
            names_something = size > 1 and self._is_name(rest[size - 1])
            by_it = names_something and rest[size - 2].text in _BY_WHICH
            if by_it and rest[size - 1].text == self._brought_by(action):
                return action, size - 1  # `talk on the phone`, with the one that is there
            if not names_something and (size < len(rest) or not self._wants_target(action)):
                return action, size
            found = action, size  # unless fewer words leave a target: `serve ball`, not `serve-ball`
        if found is not None:
            return found
        word = words.fold(rest[0].text)
        meant = nearest(word, self._actions)
        if meant is None and len(rest) > 1:
            meant = nearest(f"{word}-{words.fold(rest[1].text)}", self._actions)
        if meant is None:  # walking, walked
            meant = next((a for a in self._actions if len(a) > 2 and word.startswith(a)), None)
        self.report.error(
            "VDS071",
            rest[0].span,
            label=f"no action is called `{rest[0].text}`",
            help=self._actions_in_words(),
            suggestion=meant,
            fix=meant,
        )
        return None, 0

    def _called(self, said: tuple[ast.Name, ...]) -> str | None:
        """The action that all of some words name, the first as it is or in the third person."""
        first, *others = (words.fold(name.text) for name in said)
        forms = ("-".join((form, *others)) for form in (first, *words.plain_forms(first)))
        return next((self._actions[form] for form in forms if form in self._actions), None)

    def _is_action(self, said: tuple[ast.Name, ...]) -> bool:
        return bool(said) and self._called(said) is not None

    def _is_name(self, word: ast.Name) -> bool:
        """Whether a word is somebody's, or something's in the scene."""
        known = self.scope is not None and bool(self.scope.look_up(word.parts))
        return known or word.text in self.characters

    def _takes(self, action: str, said: tuple[ast.Name, ...]) -> bool:
        """Whether the last of some words is somebody, or something in the scene, to whom it can be done."""
        definition = self.catalog.get("action", action)
        if not said or self.scope is None or getattr(definition, "target", "none") == "none":
            return False
        kinds = tuple(getattr(definition, "target_kinds", ())) or tuple(_KIND_WORDS)
        if said[-1].text in self.characters:
            return "character" in kinds
        found = self.scope.look_up(said[-1].parts)
        return bool(found) and ("place" in kinds or (found[0].kind != "room" and "object" in kinds))

    def _brought_by(self, action: str) -> str:
        return str(getattr(self.catalog.get("action", action), "brings", ""))

    def _wants_target(self, action: str) -> bool:
        """Whether nothing can be done by it alone."""
        definition = self.catalog.get("action", action)
        required = getattr(definition, "target", "optional") == "required"
        return required and not getattr(definition, "otherwise", ())

    def _actions_in_words(self) -> str:
        names = self.catalog.names("action")
        if len(names) > _MOST_LISTED:
            return "`vdsc assets actions` lists them all, `--search WORDS` finds one"
        return f"actions are {listing(names, 40, last='and')}"

    # -- to what ---------------------------------------------------------------------

    def _targets(
        self, rest: tuple[ast.Name, ...], definition: DefinitionBase, verb: ast.Name
    ) -> list[Target] | None:
        """The targets named; None where one was reported. verb: the last word of the action"""
        groups = self._split(rest)
        if groups is None:
            return None
        if groups and len(groups[0]) > 1 and self._is_given_to(groups[0][0], definition):
            groups = [groups[0][1:], groups[0][:1], *groups[1:]]  # `give ben the cup`
        groups = self._taken(groups, (verb, *rest), definition)
        if getattr(definition, "anything", False):  # `write poem` is done at a desk
            groups = [g for g in groups if not self._is_nowhere(g) or self._is_like_something(g)]
        if len(groups) > 2:
            self.report.error("VDS073", groups[2][0].span, label="an action has two targets at most")
            return None
        needs, with_first = getattr(definition, "needs", "none"), rest[:1] != () and rest[0].text == "with"
        held = {"target": 0, "any": 0, "second": 0 if with_first and len(groups) == 1 else 1}.get(needs)
        found = [self.target(group, n == held) for n, group in enumerate(groups)]
        known = [target for target in found if target is not None]
        return known if len(known) == len(found) else None

    def _taken(
        self, groups: list[list[ast.Name]], said: tuple[ast.Name, ...], definition: DefinitionBase
    ) -> list[list[ast.Name]]:
        """Without where it is done, where an action takes no more targets: `peeks at her over the paper`."""
        takes = [getattr(definition, name, "none") != "none" for name in ("target", "second")]
        most = 2 if takes[1] else int(takes[0])
        before = {id(word): last for last, word in pairwise(said) if last.text in words.WHERE}
        while len(groups) > most and id(groups[-1][0]) in before:
            *groups, last = groups
            span = before[id(last[0])].span.to(last[-1].span)
            self.report.warn(
                "VDS082",
                span,
                label=f"`{span.text}` is left out",
                help=f"`{getattr(definition, 'name', 'it')}` is done to no more",
            )
        return groups

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
            if name.text in words.PREPOSITIONS and not self._is_name(name):
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

    def target(self, group: list[ast.Name], held: bool = False) -> Target | None:
        """One target by its word, or by several words that are one name (``bus stop``), or end in one (``old
        car``).

        held: it is to be in a hand, so that what the scene has not is brought, if it is a prop
        """
        group = self._without_adjectives(group, held)
        if len(group) > 1 and self.scope is not None:
            for joint in ("_", "-"):
                parts = (joint.join(name.text for name in group),)
                if self.scope.look_up(parts):
                    return self._resolve(ast.Name(parts, group[0].span.to(group[-1].span)))
            inside = ast.Name(tuple(name.text for name in group), group[0].span.to(group[-1].span))
            if self.scope.look_up(inside.parts):  # `kitchen door`
                return self._resolve(inside)
        if held and self.bring is not None and self.mentions.who is not None and self._is_nowhere(group):
            span = group[0].span.to(group[-1].span)
            brought = self.bring("_".join(name.text for name in group), span, self.mentions.who)
            if brought is not None:
                return brought
        if len(group) > 1:
            names = group[0].span.to(group[-1].span).text
            help = f"a second target follows a word like `to`: `{group[0].text} to {group[1].text}`"
            if any(name.text == "and" for name in group):
                help = self._two_lines()
            self.report.error("VDS073", group[1].span, label=f"`{names}` is not one name", help=help)
            return None
        return self._resolve(group[0])

    def _without_adjectives(self, group: list[ast.Name], held: bool) -> list[ast.Name]:
        """The words from the first on with which they are a name, after words for what that is like."""

        props = {*self.catalog.names("prop"), *self.catalog.synonyms("prop")}

        def known(words: list[ast.Name]) -> bool:
            joined = "_".join(name.text for name in words)
            return (
                any(
                    self._is_name(ast.Name((name,), words[0].span))
                    for name in (joined, joined.replace("_", "-"))
                )
                or (len(words) == 1 and not self._is_nowhere(words))
                or (self.scope is not None and bool(self.scope.look_up(tuple(name.text for name in words))))
                or (held and (joined.replace("_", "-") in props or joined in props))
            )

        if len(group) < 2 or self.scope is None or any(name.text == "and" for name in group) or known(group):
            return group
        first = next((k for k in range(1, len(group)) if known(group[k:])), 0)
        if any(known([word]) for word in group[:first]):  # two names: `anna a note`
            return group
        if first:
            said, rest = (" ".join(name.text for name in part) for part in (group[:first], group[first:]))
            self.report.warn(
                "VDS082",
                group[0].span.to(group[first - 1].span),
                label=f"`{said}` is left out",
                help=f"`{rest}` looks as it is defined",
            )
        return group[first:]

    def _two_lines(self) -> str:
        """What to write for a line that says two things."""
        said = [name.text for name in self._said]
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
        who = self.mentions.who
        own = self.scope.carried_by(who, parts[-1]) if who and len(parts) == 1 else None
        return own is None and not self.scope.look_up(parts)

    def _is_like_something(self, group: list[ast.Name]) -> bool:
        """Whether words are probably a name in the scene, or somebody's, not quite written as it is."""
        known = (*self.characters, *(self.scope.known() if self.scope is not None else ()))
        return any(nearest(name.text, known) is not None for name in group)

    def _resolve(self, name: ast.Name) -> Target | None:
        who = self.mentions.who
        own = self.scope.carried_by(who, name.text) if self.scope and who else None
        if own is not None:
            return Target("object", own.path, name.text, name.span)
        return resolve(name, self.characters, self.scope, self.report, any_of=True)

    def _fits(self, node: ast.BeatNode, action: str, definition: DefinitionBase, named: list[Target]) -> bool:
        """Whether the targets are what the action takes."""
        wants: str = getattr(definition, "target", "optional")
        second: str = getattr(definition, "second", "none")
        kinds: tuple[str, ...] = tuple(getattr(definition, "target_kinds", ()))
        kind_words = " or ".join(_KIND_WORDS.get(kind, kind) for kind in kinds) or "a target"
        if wants == "required" and not named:
            self.report.error(
                "VDS072",
                node.span,
                label=f"`{action}` needs {kind_words}",
                help=f"as in `({node.words[0].text} {action} …)`",
            )
            return False
        if wants == "none" and named:
            self.report.error(
                "VDS073", named[0].span, label=f"`{action}` takes no target", help="leave it out"
            )
            return False
        if second == "required" and len(named) == 1:
            self.report.error(
                "VDS072",
                node.span,
                label=f"`{action}` needs a second target",
                help=f"as in `({node.words[0].text} {action} {named[0].written} to …)`",
            )
            return False
        if second == "none" and len(named) == 2:
            self.report.error(
                "VDS073", named[1].span, label=f"`{action}` takes no second target", help="leave it out"
            )
            return False
        also: tuple[str, ...] = tuple(getattr(definition, "second_kinds", ()))
        if len(named) == 2 and also and not _kind_fits(named[1], also):
            second_words = " or ".join(_KIND_WORDS.get(kind, kind) for kind in also)
            self.report.error(
                "VDS074",
                named[1].span,
                label=f"the second target of `{action}` is {second_words}",
                help=f"`{named[1].written}` is {_is(named[1])}",
            )
            return False
        if named and kinds and not _kind_fits(named[0], kinds):
            self.report.error(
                "VDS074",
                named[0].span,
                label=f"`{action}` is done to {kind_words}, `{named[0].written}` is {_is(named[0])}",
            )
            return False
        return True


def resolve(
    name: ast.Name, characters: tuple[str, ...], scope: Scope | None, report: Report, any_of: bool = False
) -> Target | None:
    """A character or something in the scene; ``any_of``: of several of one kind the first will do."""
    if name.text in characters:
        return Target("character", (name.text,), name.text, name.span)
    if scope is None:
        return None
    near = nearest(name.text, characters)
    if near is not None and not scope.look_up(name.parts):
        unknown_character(name, characters, report)
        return None
    return scope.find(name, report, any_of)


def unknown_character(word: ast.Name, characters: tuple[str, ...], report: Report) -> None:
    """Report a name that is no character's."""
    meant = nearest(word.text, characters)
    if characters:
        help = f"characters are {listing(characters, last='and')}"
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


def _works_with(definition: DefinitionBase, rest: tuple[ast.Name, ...]) -> bool:
    """Whether what stands after the action is only what it is done with: ``sweep with broom``."""
    optional = getattr(definition, "target", "none") == "optional"
    return (
        optional
        and getattr(definition, "needs", "none") == "second"
        and rest[:1] != ()
        and rest[0].text == "with"
    )


def _is_second(definition: DefinitionBase, named: list[Target]) -> bool:
    """Whether the only target named is none to do it to, but one of the second kind: ``toast to ben``."""
    if len(named) != 1 or getattr(definition, "target", "none") != "optional":
        return False
    kinds, also = (tuple(getattr(definition, name, ())) for name in ("target_kinds", "second_kinds"))
    return bool(kinds) and bool(also) and not _kind_fits(named[0], kinds) and _kind_fits(named[0], also)


def _kind_fits(target: Target, kinds: tuple[str, ...]) -> bool:
    if target.kind == "character":
        return "character" in kinds
    if target.kind == "room":
        return "place" in kinds
    return "place" in kinds or "object" in kinds


def _is(target: Target) -> str:
    return {"character": "someone", "room": "a room", "spot": "a place", "object": "a thing"}[target.kind]
