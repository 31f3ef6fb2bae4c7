"""What is shown of a sentence that cannot be acted as it is written: as much of it as can.

Assumes the words of a beat, and what was reported when it was read. Guarantees that there is always something
somebody can do: they look at what the sentence names, or wait. A word that is an action's or a name but for a
letter stays an error, as far as it is told from another English word.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from itertools import pairwise

from . import ast
from .diagnostics import Diagnostic, is_mixed_up, is_slip
from .english import MODALS, PAST, VERBS, is_not
from .phrases import Words, is_small
from .pronouns import ALL, BOTH, ONE
from .source import Span
from .stand_in import NO_THINGS
from .words import ARTICLES, PREPOSITIONS, fold, plain_forms

#: What is wrong with a sentence that is shown all the same: nothing, nobody or no action is called so, it
#: needs a target or takes none, it is done to something else, or to one of several, or its words are no name.
_FORGIVEN = {"VDS060", "VDS061", "VDS065", "VDS071", "VDS072", "VDS073", "VDS074"}
_OWN = ("her", "his", "their")
#: What is named after them has nothing done to it.
_NOT_TO = ("from", "of", "without")


def is_told(words: Words, said: str) -> bool:
    """Whether words are of a sentence, and no line as ``anna walk door``. said: the beat as it is written"""
    first = said.strip().removeprefix("(").split(maxsplit=1)[:1]
    pronoun = bool(first) and first[0].casefold() in (*ONE, *BOTH, *ALL)
    third = any(w.text.endswith("s") and not w.text.endswith("ss") for w in words[1:3])
    past = any(w.text.endswith("ed") or w.text in PAST for w in words[1:3])
    marks = (*ARTICLES, *_OWN, *MODALS)
    return pronoun or third or past or any(word.text in marks or is_not(word.text) for word in words)


def is_negated(words: Words) -> bool:
    """Whether a sentence says what somebody does not do: ``anna doesn't move``."""
    return any(is_not(word.text) for word in words[1:3])


def is_forgiven(wrong: Sequence[Diagnostic], actions: Collection[str], things: Collection[str]) -> bool:
    """Whether a sentence of which that was reported is shown as far as it can be. actions, things: what they
    may be called"""
    return bool(wrong) and all(
        each.code in _FORGIVEN and not _is_slip(each, actions, things) for each in wrong
    )


def why(wrong: Diagnostic) -> str:
    """What is wrong, and where what there is can be found."""
    kind, label = {"VDS060": "props", "VDS071": "actions"}.get(wrong.code), wrong.label
    if wrong.code == "VDS060" and _is_done_too(wrong.span):
        kind, label = "actions", f"no action is called `{wrong.span.text}`"
    more = f"`vdsc assets {kind} --search WORDS` finds what there is" if kind else wrong.help
    return "; ".join(filter(None, (label, more)))


def _is_done_too(span: Span) -> bool:
    """Whether what names no thing is a verb after an ``and``: ``sits down and yodels``, not ``and milk``."""
    before = span.source.text[max(0, span.start - 16) : span.start].split()[-1:]
    word = fold(span.text)
    return before == ["and"] and word not in VERBS and bool({*plain_forms(word)} & VERBS)


def _is_slip(wrong: Diagnostic, actions: Collection[str], things: Collection[str]) -> bool:
    word = fold(wrong.span.text)
    if wrong.code == "VDS071":
        return is_mistyped(wrong.span.text, actions)
    common = word in things or word in VERBS or word in NO_THINGS or word in (*ONE, *BOTH) or is_small(word)
    if common or wrong.code != "VDS060":
        return False
    near = wrong.suggestion is not None and is_mixed_up(word, fold(wrong.suggestion))
    return near or any(is_mixed_up(word, name, missing=False) for name in things)


def is_mistyped(verb: str, actions: Collection[str]) -> bool:
    """Whether a word is no English verb that is known here, but an action's but for a letter."""
    word = fold(verb)
    if {word, *plain_forms(word)} & VERBS or verb in MODALS or is_not(verb):
        return False
    ends = ("s", "es", "ed", "d", "ing")
    forms = {f"{name}{end}" for name in actions for end in ("", *ends)}
    forms |= {f"{name[:-1]}ing" for name in actions if name.endswith("e")}
    return any(is_slip(word, form) for form in forms)


def readings(
    who: ast.Name, verb: Words, rest: Words, names: Sequence[ast.Name], alone: bool
) -> Iterator[Words]:
    """Words of beats that somebody might be shown doing instead, the nearest first.

    verb: the words of the action, () for none that is known; names: whoever and whatever of ``rest`` is
    there; alone: whether the action is something without a target
    """
    before = {id(word): last.text for last, word in pairwise(rest)}
    names = [name for name in names if before.get(id(name)) not in _NOT_TO]
    if verb:
        for some in _choices(names):
            linked = [_linked(name, rest) for name in some]
            yield (who, *verb, *(word for words in linked for word in words))
        for name in names:
            yield (who, *verb, name)
    if verb and alone:
        yield (who, *verb)
    yield from looks(who, names, (verb or rest or (who,))[0].span)


def _choices(names: Sequence[ast.Name]) -> Iterator[Sequence[ast.Name]]:
    """Names that may all belong to an action: all, the first and the last, the first two, one by one."""
    if len(names) > 2:
        yield names
        yield (names[0], names[-1])
    if len(names) > 1:
        yield names[:2]
    for name in names:
        yield (name,)


def _linked(name: ast.Name, rest: Words) -> Words:
    """A name with the preposition before it."""
    k = next(k for k, word in enumerate(rest) if word is name)
    return (rest[k - 1], name) if k and rest[k - 1].text in PREPOSITIONS else (name,)


def looks(who: ast.Name, names: Sequence[ast.Name], span: Span) -> Iterator[Words]:
    """That somebody looks at one of these, or waits. span: what stands for it in the script"""
    for name in names:
        yield (who, ast.Name(("look",), span), ast.Name(("at",), span), name)
    yield (who, ast.Name(("wait",), span))
