"""Beats of sentences that cannot be acted as they are written, and of those in which nobody acts.

Assumes a reader of beats, which reports what is wrong. Guarantees that a beat that is shown in place of
another has the words of that, for the boards, and a warning that says what is shown and why.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING

from . import ast, nearly, phrases
from .diagnostics import Diagnostic, is_mixed_up
from .english import MODALS, VERBS
from .ir import Beat
from .pronouns import BOTH, ONE, OWNERS, owner
from .things import Thing, thing
from .words import ARTICLES

if TYPE_CHECKING:
    from .beats import BeatReader

#: Warnings of things that are in the scene from now on, though they were put there for nothing.
STAYS = ("VDS083", "VDS084")
#: What one may say to somebody who is not named.
_COMMON = {*ARTICLES, *MODALS, *VERBS, *BOTH, *ONE, "and", "been", "not"}
#: After them a word in capitals is a name, and no month or film.
_TO_SOMEBODY = ("at", "to", "with", "from", "for", "behind", "beside")
_NO_NAMES = ("everything", "goodbye", "hello", "nothing", "something", "sorry", "thanks", "words")


class Fallback:
    """What is shown where a beat cannot be read; of one reader."""

    def __init__(self, reader: BeatReader) -> None:
        self.reader = reader
        self.report = reader.report
        self.acting: set[str] = set()  # who acts in the line that is read

    # -- sentences that cannot be acted ------------------------------------------------

    def is_strict(self, node: ast.BeatNode) -> bool:
        """Whether a line is no sentence, has things by their full names, or somebody whom nobody knows."""
        reader = self.reader
        titles = all(word.span.text.istitle() for word in node.words[:3])
        for k, word in enumerate(node.words):
            owned = owner(word.span.text).casefold() == word.text.casefold()
            who = owner(word.text) or (word.text if owned else "")
            known = reader.targets.is_name(word) or reader.targets.is_thing(word)
            unknown = bool(who) and who not in (*reader.characters, *ONE) and not known
            known = known or word.text in _COMMON or phrases.is_small(word.text)
            like = any(is_mixed_up(word.text, name) for name in reader.characters)
            to_somebody = k > 0 and node.words[k - 1].text in _TO_SOMEBODY
            name = to_somebody and not titles and word.span.text.istitle()
            if unknown or len(word.parts) > 1 or (not known and (like or name)):
                return True
        return not nearly.is_told(node.words, (node.who or node.span).text)

    def instead(self, node: ast.BeatNode, wrong: Sequence[Diagnostic]) -> Beat | None:
        """The beat that is shown for a sentence of which that was reported; None where it stays an error."""
        reader = self.reader
        if not nearly.is_forgiven(wrong, reader.actions, reader.things) or self._is_nobody(node, wrong):
            return None
        found = self._first(node, self._readings(node))
        return None if found is None else self._told(node, found, nearly.why(wrong[0]), wrong[0].suggestion)

    def _is_nobody(self, node: ast.BeatNode, wrong: Sequence[Diagnostic]) -> bool:
        """Whether it is done to people alone, and what is named is nobody: ``hugs carl``."""
        mark = self.report.mark()
        action, _ = self.reader.action_of(replace(node, words=phrases.plain(node.words, self.reader.known())))
        self.report.take_back(mark)
        definition = self.reader.catalog.get("action", action) if action else None
        kinds = tuple(getattr(definition, "target_kinds", ()))
        before = {word.span.start: last.text for last, word in pairwise(node.words)}
        somebody = any(word.text in self.reader.characters for word in node.words[1:])
        return (
            kinds == ("character",)
            and not somebody
            and any(
                each.code == "VDS060"
                and before.get(each.span.start) not in ARTICLES
                and each.span.text not in _NO_NAMES
                for each in wrong
            )
        )

    def not_done(self, node: ast.BeatNode) -> Beat | None:
        """Of what somebody does not do."""
        who, *rest = node.words
        found = self._first(node, nearly.looks(who, self._named_among(rest, who.text), node.span))
        return None if found is None else self._told(node, found, "what is not done does not show", None)

    def _readings(self, node: ast.BeatNode) -> Iterator[tuple[ast.Name, ...]]:
        reader, mark = self.reader, self.report.mark()
        who, *rest = phrases.plain(reader.without_manner(node)[0].words, reader.known())
        action, used = reader.action_of(ast.BeatNode((who, *rest), node.span)) if rest else (None, 0)
        self.report.take_back(mark)
        after = tuple(rest[used:])
        definition = reader.catalog.get("action", action) if action else None
        by_itself = getattr(definition, "target", "required") != "required"
        by_itself = by_itself or bool(getattr(definition, "otherwise", ()))  # `leaves crying`
        whose = phrases.BODY & {word.text for word in after}  # `bites her lip` is not to bite something
        alone = by_itself and not (whose and getattr(definition, "needs", "none") != "none")
        return nearly.readings(who, tuple(rest[:used]), after, self._named_among(after, who.text), alone)

    def _named_among(self, said: Sequence[ast.Name], who: str) -> list[ast.Name]:
        return [word for word in said if self.reader.targets.is_name(word) and word.text != who]

    # -- sentences in which nobody acts -------------------------------------------------

    def thing(self, node: ast.BeatNode) -> Thing | None:
        """What a beat is about in which nobody acts, if it is such a one."""
        return thing(node.words, self.reader.known())

    def about(self, node: ast.BeatNode, found: Thing) -> Beat | None:
        """``the phone rings``: the camera is on it, and somebody who is there looks at it."""
        who = next((name for name in self._people(node, found) if name and name not in self.acting), "")
        if not who:
            why = "whoever is there does something else; on a line of its own it is a shot of it"
            self.report.warn("VDS082", node.span, label=f"`{node.span.text}` is left out", help=why)
            return None
        self.acting.add(who)
        names = self._name(found)
        if not names and self._is_slip(found):
            return None
        looks = nearly.looks(ast.Name((who,), node.span), names, node.span)
        shown = self._first(node, looks)
        if shown is None:
            return None
        beat = self._told(node, shown, "nobody acts here: what a thing does is a shot of it", None)
        return replace(beat, about=beat.target)

    def _people(self, node: ast.BeatNode, found: Thing) -> Iterator[str]:
        """Who may look at a thing: whose it is, whom the sentence names, who acted or was spoken of last."""
        mentions = self.reader.mentions
        yield mentions.who_acts(found.owner) if found.owner in ONE else found.owner
        yield from (word.text for word in node.words if word.text in self.reader.characters)
        yield from (mentions.meant(w.text) for w in node.words if w.text in ("him", "her", "them"))
        yield mentions.last()
        yield from mentions.about

    def _is_slip(self, found: Thing) -> bool:
        """Whether the name of a thing is mistyped, which is reported."""
        reader, word = self.reader, found.named[-1] if found.named else None
        if word is None or reader.targets.is_thing(word):
            return False
        here = reader.scope.known() if reader.scope is not None else ()
        meant = next((name for name in here if is_mixed_up(word.text, name)), None)
        alike = (name for name in sorted(reader.things) if is_mixed_up(word.text, name, missing=False))
        meant = meant or next(alike, None)
        if meant is not None:
            label = f"nothing is called `{word.text}` here"
            self.report.error("VDS060", word.span, label=label, suggestion=meant, fix=meant)
        return meant is not None

    def _name(self, found: Thing) -> list[ast.Name]:
        """The name of a thing that is there."""
        group = found.named
        if not group:
            return []
        if len(group) == 1 and group[0].text.startswith("it"):
            return [ast.Name(self.reader.it, group[0].span)] if self.reader.it else []
        span, is_name = group[0].span.to(group[-1].span), self.reader.targets.is_name
        whole = [ast.Name((joint.join(word.text for word in group),), span) for joint in ("_", "-")]
        several = phrases.of_several(group[-1])
        owned = [ast.Name((found.owner, group[-1].text), span)] if found.owner else []
        return [name for name in (*owned, *whole, group[-1], *several) if is_name(name)][:1]

    # -- both --------------------------------------------------------------------------

    def _first(
        self, node: ast.BeatNode, readings: Iterator[tuple[ast.Name, ...]]
    ) -> tuple[Beat, tuple[ast.Name, ...]] | None:
        """The first of some readings that is one, with its words."""
        for said in readings:
            mark = self.report.mark()
            beat = self.reader.act(replace(node, words=said))
            if beat is not None:
                return beat, said
            self.report.take_back(mark, STAYS)
        return None

    def _told(
        self, node: ast.BeatNode, found: tuple[Beat, tuple[ast.Name, ...]], why: str, meant: str | None
    ) -> Beat:
        beat, words = found
        said = " ".join(word.text for word in words)
        label = f"this is shown as `{said}`"
        self.report.warn("VDS085", node.span, label=label, help=why, suggestion=meant)
        text = " ".join((node.who.text if node.who else "", node.span.text)).strip()
        text = text.removeprefix("(").removesuffix(")").strip()
        first, *more = text.split() or [""]
        if first.casefold() in ONE:
            text = " ".join((beat.character, *more))
        elif first.casefold() in OWNERS:
            text = " ".join((f"{beat.character}'s", *more))
        return replace(beat, said=text)
