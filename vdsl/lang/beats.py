"""The words of one ``(char do sth)`` into a :class:`vdsl.lang.ir.Beat`.

The first word is the character; the longest run after it that is an action is the action; what is
left are one or two targets, the second after a word like ``to`` or ``with``. A word for the manner
(``briskly``) may stand anywhere after the character.
"""

from __future__ import annotations

from dataclasses import replace

from runtime.motion.manner import MANNERS

from . import ast, capitals, clauses, nearly, phrases, pronouns, sentences, words
from .catalog import CatalogLike
from .definitions.types import DefinitionBase
from .diagnostics import Report, listing, nearest
from .fallback import STAYS, Fallback
from .ir import Beat, Target
from .pronouns import ONE, Mentions
from .scope import Scope
from .source import Span
from .targets import KIND_WORDS, TargetReader, kind_fits, unknown_character
from .things import thing

_MOST_ACTION_WORDS = 5
_MOST_LISTED = 30
#: `pour jug into glass` and `pour glass from jug` are one: what is in the hand is the second target.
_INTO = ("to", "in", "into", "on", "onto")
#: Options of one shot, which of what is done one after the other is the first.
_OF_ONE = ("duration", "say", "note", "name")
_NOT_SHOWN = "it is no action of theirs; what somebody else does at the same time is joined by `+`"
#: `talk on the phone` is done with it, `look at the phone` to it.
_BY_WHICH = ("on", "into")


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
        self.targets = TargetReader(catalog, characters, scope, report)
        self.mentions = mentions or Mentions(characters)
        self.it: tuple[str, ...] = ()  # the name of the thing that was spoken of last
        self._many = False  # whether it was several, so that `them` may be it
        self.actions = {words.fold(word): name for word, name in catalog.synonyms("action").items()}
        self.actions |= {words.fold(name): name for name in catalog.names("action")}
        self.fallback = Fallback(self)
        self.things = {words.fold(n) for n in (*catalog.names("prop"), *catalog.synonyms("prop"))}

    def read(self, node: ast.BeatNode) -> Beat | None:
        """What somebody does; of a sentence that cannot be acted as it is, as much as can."""
        found = self.fallback.thing(node)
        if found is not None:
            return self.fallback.about(node, found)
        mark = self.report.mark()
        somebody = node.words[0].text in self.characters and len(node.words) > 1
        if somebody and nearly.is_negated(node.words):
            return self.fallback.not_done(node)
        beat = self.act(node)
        if beat is not None or not somebody or self.fallback.is_strict(node):
            return beat
        wrong = self.report.take_back(mark, STAYS)
        beat = self.fallback.instead(node, [each for each in wrong if each.severity == "error"])
        if beat is None:
            self.report.put_back(wrong)
        return beat

    def act(self, node: ast.BeatNode) -> Beat | None:
        """What somebody does by the words of a beat; None where it was reported that they cannot."""
        character, mentions = self._character(node), self.mentions
        if character is None and node.words[0].text in words.ARTICLES:
            return None
        mentions.who = self.targets.who = character
        self.targets.said = node.words
        self.targets.prose = _is_prose(node.words)
        node, manner = self.without_manner(node)
        possessed = next((w.text for w in node.words if w.text in ("her", "his", "their")), "")
        spoken_of = mentions.meant(possessed)
        node = replace(node, words=phrases.plain(node.words, self.known()))
        mentions.read(character, [word.text for word in node.words if word.text in self.characters])
        if len(node.words) < 2:
            self.report.error(
                "VDS070",
                node.span,
                label="nothing is done here",
                help="as in `(anna walk door)`: character, action, target",
            )
            return None
        action, used = self.action_of(node)
        definition = None if action is None else self.catalog.get("action", action)
        if action is None or definition is None:
            return None
        if mentions.may_be_own(possessed) and self._is_of_a_body(node, used):
            spoken_of = ""  # `strokes his chin`
        rest = phrases.targets_alone(node.words[1 + used :], self.targets.is_name)
        if getattr(definition, "against", 0.0):
            rest = phrases.without_walls(rest, self.targets.is_name)
        rest, in_hand = self.targets.in_hand(rest, definition)
        named = self.targets.named(rest, definition, node.words[used])
        if named is None or character is None:
            return None
        whom = spoken_of if possessed else mentions.other()
        named = named or self._unsaid(node, used, definition, rest, whom if possessed else "")
        if named is None:
            return None
        if not (used > 1 and node.words[used].text == "up"):  # `grabs ben`, and not `picks up ben`
            action, definition = self._done_to(action, definition, named)
        if not named and whom and self.takes_somebody(action):
            named = [Target("character", (whom,), whom, node.span, implied=True)]
        if not named and in_hand is None and (alone := getattr(definition, "alone", "")):
            action, definition = alone, self.catalog.get("action", alone) or definition
        thing = next((t for t in named if t.kind == "object" and not t.implied), in_hand)
        if thing is not None:
            self.it = tuple(thing.written.split("."))
            self._many = thing.written.endswith("s") or thing.span.text.endswith("s")
        only_second = _is_second(definition, named)
        if not only_second and not self.targets.fits(node, action, definition, named):
            return None
        link = next((w.text for w in rest[1:] if w.text in words.PREPOSITIONS), "")
        if len(named) == 2 and link in _INTO and getattr(definition, "needs", "none") == "second":
            named = [named[1], named[0]]
        first, second = (*named, None, None)[:2]
        if only_second or (second is None and _works_with(definition, rest)):
            first, second = None, first
        for target in named:
            if target.kind == "character" and target.path[0] == character:
                self.report.error("VDS075", target.span, label=f"{character} cannot do this to themselves")
                return None
        ways = _ways(definition, self.targets.said[2:])
        return Beat(character, action, first, second, node.span, manner, in_hand, node.who, ways)

    def _is_of_a_body(self, node: ast.BeatNode, used: int) -> bool:
        """Whether what is done is done to a part of a body."""
        return phrases.first_is_of_a_body(node.words[1 + used :], self.targets.is_name)

    def _unsaid(
        self,
        node: ast.BeatNode,
        used: int,
        definition: DefinitionBase,
        rest: tuple[ast.Name, ...],
        whose: str,
    ) -> list[Target] | None:
        """What it is done to where that goes without saying; None where it was reported that there is
        nothing. whose: whose it is, besides who acts, or nobody's"""
        if not self._is_of_a_body(node, used):
            otherwise = getattr(definition, "otherwise", ()) if self.scope is not None else ()
            unsaid = (self.scope.first(word, node.span) for word in otherwise if self.scope is not None)
            return [target for target in unsaid if target is not None][:1]
        if whose and getattr(definition, "someone", ""):  # `reaches for her hand`
            return [Target("character", (whose,), whose, node.span, implied=True)]
        if not rest and getattr(definition, "needs", "none") != "none":
            body = " ".join(word.text for word in node.words[1 + used :])
            label = f"`{getattr(definition, 'name', '')}` is done with a thing, not with `{body}`"
            self.report.error("VDS072", node.span, label=label)
            return None
        return []

    def lines(self, node: ast.StoryNode) -> tuple[ast.StoryNode, ...]:
        """What a line says as lines in which everybody does one thing, ``while`` as at the same time."""
        beats: list[ast.BeatNode] = []
        later: list[ast.StoryNode] = []
        besides: list[ast.BeatNode] = []
        for beat in node.beats:
            said = capitals.small(beat.words, self.targets.is_name, self.characters)
            read = sentences.sentence(said, self.known())
            for left in read.left_out:
                span = left[0].span.to(left[-1].span)
                self.report.warn("VDS082", span, label=f"`{span.text}` is left out", help=_NOT_SHOWN)
            of_things = [thing(part.words, self.known()) is not None for part in read.parts]
            first, *others = (
                sentences.speaks(words, self.known()) if beat.spoken else words
                for words in (self._named_in(read.parts, n) for n in range(len(read.parts)))
            )
            whole = len(read.parts) == 1 and not read.left_out
            beats.append(replace(beat, words=first, span=beat.span if whole else _span(first)))
            for said, part, after_thing in zip(others, read.parts[1:], of_things, strict=False):
                done = ast.BeatNode(said, _span(said))
                # what a thing does is looked at by itself, and two speak one after the other
                meanwhile = part.meanwhile and not after_thing and len(beat.spoken) < 2
                if meanwhile and not later:
                    besides.append(done)
                elif meanwhile:
                    later[-1] = replace(later[-1], beats=(*later[-1].beats, done))
                else:
                    later += self.one_by_one(_filmed_alike(node, done))
        *lines, last = self.one_by_one(replace(node, beats=tuple(beats)))
        after: list[ast.StoryNode] = []
        for beat in besides:  # `anna cooks and sings`: the first at the same time
            one, *more = self.one_by_one(_filmed_alike(node, beat))
            last = replace(last, beats=(*last.beats, *one.beats))
            after += more
        return _with_speech((*lines, last, *after, *later), node)

    def _named_in(self, parts: tuple[clauses.Part, ...], n: int) -> tuple[ast.Name, ...]:
        """The words of a part, with a name for ``he`` where that is whom the part before was about."""
        said = parts[n].words
        if n == 0 or parts[n].fresh or said[0].text not in ONE:
            return said
        before = [word.text for word in parts[n - 1].words[1:] if word.text in self.characters]
        may = {name for name in before if self.mentions.may(said[0].text, name)}
        return said if len(may) != 1 else (ast.Name((may.pop(),), said[0].span), *said[1:])

    def one_by_one(self, node: ast.StoryNode) -> tuple[ast.StoryNode, ...]:
        """``(ben sits down and reads)`` as two lines, filmed alike; what is said of one is of the first."""
        if len(node.beats) != 1 or thing(node.beats[0].words, self.known()) is not None:
            return (node,)
        said = node.beats[0].words
        who, does = clauses.one_after_the_other(said, self.known())
        if len(does) == 1:
            return (node,)
        named, lines = who[0].span.to(who[-1].span), []
        for n, done in enumerate(does):
            begins = who[0] if n == 0 else done[0]
            beat = ast.BeatNode((*who, *done), begins.span.to(done[-1].span), None if n == 0 else named)
            lines.append(replace(node, beats=(beat,)) if n == 0 else _filmed_alike(node, beat))
        return tuple(lines)

    def _done_to(
        self, action: str, definition: DefinitionBase, named: list[Target]
    ) -> tuple[str, DefinitionBase]:
        """The action, or what it is where it is done to somebody."""
        kinds: tuple[str, ...] = tuple(getattr(definition, "target_kinds", ()))
        other: str = getattr(definition, "someone", "")
        if not other or not named or named[0].kind != "character" or "character" in kinds:
            return action, definition
        found = self.catalog.get("action", other)
        return (action, definition) if found is None else (other, found)

    def each_of(self, node: ast.BeatNode) -> tuple[tuple[ast.BeatNode, ...], bool]:
        """The beat for each of those it is of, as :func:`vdsl.lang.phrases.each_of` says."""
        self.mentions.who, self.mentions.acting = None, ()
        found, together = phrases.each_of(node, self.mentions, self.known())
        self.mentions.acting = ()
        self.mentions.group = tuple(each.words[0].text for each in found) if len(found) > 1 else ()
        return found, together

    def known(self) -> phrases.Known:
        own = self.mentions.may_be_own
        return phrases.Known(
            self.characters,
            self.mentions.meant,
            own,
            self.it,
            self._many,
            self._is_action,
            self.targets.is_name,
            self.targets.is_thing,
            self.mentions.may,
            self._is_person,
        )

    def _is_person(self, word: str) -> bool:
        cast = (*self.catalog.names("cast"), *self.catalog.synonyms("cast"))
        return words.fold(word) in map(words.fold, cast) or pronouns.is_person(word)

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
        word, *more = node.words
        if word.text in self.characters:
            return word.text
        somebody = more[0] if word.text in words.ARTICLES and more else word  # `the waiter walks in`
        unknown_character(somebody, self.characters, self.report)
        return None

    def without_manner(self, node: ast.BeatNode) -> tuple[ast.BeatNode, str]:
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

    def action_of(self, node: ast.BeatNode) -> tuple[str | None, int]:
        """The action, and how many words it took."""
        rest = node.words[1:]
        found: tuple[str, int] | None = None
        for size in range(min(_MOST_ACTION_WORDS, len(rest)), 0, -1):
            action = self._called(rest[:size])
            if action is None or (found is not None and not self._takes(action, rest[size:])):
                continue
            if size > 1 and rest[size - 1].text in words.PREPOSITIONS and phrases.only_how(rest[size:]):
                continue  # `dances with joy` is to dance, not to dance with somebody
            # `look at phone`, where there is a phone, and not `look-at-phone`
            names_something = size > 1 and self.targets.is_name(rest[size - 1])
            by_it = names_something and rest[size - 2].text in _BY_WHICH
            if by_it and rest[size - 1].text == self._brought_by(action):
                return action, size - 1  # `talk on the phone`, with the one that is there
            if not names_something and (size < len(rest) or not self._wants_target(action)):
                return action, size
            found = action, size  # unless fewer words leave a target: `serve ball`, not `serve-ball`
        if found is not None:
            return found
        word = words.fold(rest[0].text)
        meant = nearest(word, self.actions)
        if meant is None and len(rest) > 1:
            meant = nearest(f"{word}-{words.fold(rest[1].text)}", self.actions)
        if meant is None:  # walking, walked
            meant = next((a for a in self.actions if len(a) > 2 and word.startswith(a)), None)
        help = self._actions_in_words()
        if word in words.PREPOSITIONS and len(rest) > 1:  # `anna at table`
            meant, where = None, " ".join(each.span.text for each in node.words)
            help = f"`{where}` without parentheses says where somebody is from the start"
        self.report.error(
            "VDS071",
            rest[0].span,
            label=f"no action is called `{rest[0].text}`",
            help=help,
            suggestion=meant,
            fix=meant,
        )
        return None, 0

    def _called(self, said: tuple[ast.Name, ...]) -> str | None:
        """The action that all of some words name, the first as it is or in the third person."""
        first, *others = (words.fold(name.text) for name in said)
        forms = ("-".join((form, *others)) for form in (first, *words.plain_forms(first)))
        return next((self.actions[form] for form in forms if form in self.actions), None)

    def _is_action(self, said: tuple[ast.Name, ...]) -> bool:
        return bool(said) and self._called(said) is not None

    def _takes(self, action: str, said: tuple[ast.Name, ...]) -> bool:
        """Whether the last of some words is somebody, or something in the scene, to whom it can be done."""
        definition = self.catalog.get("action", action)
        if not said or self.scope is None or getattr(definition, "target", "none") == "none":
            return False
        kinds = tuple(getattr(definition, "target_kinds", ())) or tuple(KIND_WORDS)
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
    return bool(kinds) and bool(also) and not kind_fits(named[0], kinds) and kind_fits(named[0], also)


def _ways(definition: DefinitionBase, said: tuple[ast.Name, ...]) -> tuple[str, ...]:
    """The variants of an action that a line names, as ``cheek`` in ``kisses ben on the cheek``; where it
    names a part of the body that none is of, those that are of no part; else () for all."""
    names = [str(getattr(variant, "name", "")) for variant in getattr(definition, "variants", ())]
    texts = {words.fold(word.text) for word in said}
    named = tuple(name for name in names if name and texts.issuperset(words.fold(name).split("-")))
    of_body = [name for name in names if name in phrases.BODY]
    if not named and of_body and texts & phrases.BODY:
        return tuple(name for name in names if name not in of_body)
    return named


def _is_prose(said: tuple[ast.Name, ...]) -> bool:
    """Whether a line is a sentence of somebody who tells a story, ``anna opens the door``: in these there is
    much besides what is done and to what."""
    article = any(word.text in words.ARTICLES for word in said)
    third = [w.text for w in said[1:3] if w.text.endswith("s") and not w.text.endswith("ss")]
    return article or bool(third)


def _with_speech(lines: tuple[ast.StoryNode, ...], node: ast.StoryNode) -> tuple[ast.StoryNode, ...]:
    """Lines with what is said in the words they were taken from, each where it is said."""
    texts = [text for beat in node.beats for text in beat.spoken]
    if not texts:
        return lines
    seen: set[int] = set()
    begin: list[int] = []
    for line in lines:  # who acts in several of them is named in the first
        starts = {word.span.start for beat in line.beats for word in beat.words}
        begin.append(min(starts - seen or starts, default=0))
        seen |= starts
    said: dict[int, list[ast.Text]] = {}
    for text in texts:
        at = max((n for n, start in enumerate(begin) if start <= text.span.start), default=0)
        said.setdefault(at, []).append(text)
    return tuple(_saying(line, said[n]) if n in said else line for n, line in enumerate(lines))


def _saying(line: ast.StoryNode, texts: list[ast.Text]) -> ast.StoryNode:
    """A line with what is said in it, before what its option says."""
    option = next((each for each in line.options if words.fold(each.name.text) == "say"), None)
    later = [value for value in option.values if isinstance(value, ast.Text)] if option else []
    span = texts[0].span
    whole = ast.Text(" ".join(text.value for text in (*texts, *later)), span)
    others = tuple(each for each in line.options if each is not option)
    beats = list(line.beats)
    for text in texts:  # the words of whoever says it go on as far
        at = max((k for k, b in enumerate(beats) if b.span.start <= text.span.start), default=len(beats) - 1)
        if beats[at].span.end < text.span.end:
            beats[at] = replace(beats[at], span=beats[at].span.to(text.span))
    say = ast.Option(ast.Name(("say",), span), (whole,), span)
    return replace(line, beats=tuple(beats), options=(*others, say))


def _span(said: tuple[ast.Name, ...]) -> Span:
    """Where the words of a part stand, but for what was put behind them from elsewhere."""
    first, before = said[0], said[1:2] if said[1:2] != () and said[1].span.start < said[0].span.start else ()
    said = (first, *said[1 + len(before) :])
    count = next((k for k in range(1, len(said)) if said[k].span.start < said[k - 1].span.start), len(said))
    return (before or (first,))[0].span.to(said[count - 1].span)  # `slowly, ben turns`


def _filmed_alike(node: ast.StoryNode, beat: ast.BeatNode) -> ast.StoryNode:
    """The line of a beat that comes after the first one of ``node``."""

    def kept(options: tuple[ast.Option, ...]) -> tuple[ast.Option, ...]:
        return tuple(each for each in options if words.fold(each.name.text) not in _OF_ONE)

    cameras = tuple(replace(camera, options=kept(camera.options)) for camera in node.cameras)
    return replace(node, beats=(beat,), options=kept(node.options), cameras=cameras)
