"""Sentences in which nobody acts: ``the phone rings``, ``ben's cup falls``, ``it tips over``.

Assumes words of one beat in small letters, but for names. Guarantees that people are no things, be they of
the story (``ben``) or not (``the waiter``), nor slips of the finger in their names.
"""

from __future__ import annotations

from dataclasses import dataclass

from .diagnostics import is_mixed_up
from .english import MODALS, PAST, VERBS, is_not
from .phrases import Known, Words, is_third, of_several, says_how
from .pronouns import OWNERS, owner
from .words import ARTICLES, PREPOSITIONS, plain_forms

_IT = ("it", "it's", "that's")
_THERE = ("there", "there's")
#: Nobody and nothing in particular does something.
_INDEFINITE = (
    "everything",
    "music",
    "nobody",
    "nothing",
    "silence",
    "somebody",
    "someone",
    "something",
    "time",
)
#: Of these `it` says nothing of a thing: `it's raining`.
_WEATHER = (
    "cold", "dark", "early", "hot", "late", "light", "midnight", "morning", "night", "noon", "over",
    "raining", "rains", "snowing", "snows", "storming", "time", "warm", "windy",
)  # fmt: skip
_MOST_WORDS = 4  # of a noun and what it is like


@dataclass(frozen=True)
class Thing:
    """named: the words for it, () for nothing in particular; owner: whose it is, a name or ``he`` or ``she``,
    or nobody's"""

    named: Words
    owner: str


def thing(words: Words, known: Known, acting: bool = False) -> Thing | None:
    """What a sentence is about in which nobody acts; None for any other. acting: only where it says, by a
    verb, what the thing does"""
    if not words or words[0].text in known.named:
        return None
    first = words[0].text
    if first in (*_IT, *_THERE, *_INDEFINITE) and len(words) > 1:
        return _unnamed(words, known)
    whose = _owner(first, known)
    article = first in ARTICLES or bool(whose)
    noun = tuple(word for word in words if not says_how(word))[1 if article else 0 :]
    verb = _verb(noun, known)
    if acting and not (verb and article):
        return None
    end = verb or (len(noun) if article else 0)  # `a loud bang from outside`
    group = noun[: next((k for k in range(1, end) if noun[k].text in PREPOSITIONS), end)]
    somebody = any(word.text in known.named for word in group)
    if not group or (somebody and (not article or len(group) > 1)):
        return None
    last = group[-1]
    is_one = known.is_name(last) or any(map(known.is_thing, (last, *of_several(last))))
    person = any(map(known.is_person, (word.text for word in group)))
    slip = any(is_mixed_up(word.text, name) for word in group for name in known.named)
    if (slip and not is_one) or not (is_one or (article and not person)):
        return None
    return Thing(group, whose)


def _owner(word: str, known: Known) -> str:
    """Whose something is by the word before it."""
    name = owner(word)
    return name if name in known.named else OWNERS.get(word, "")


def _unnamed(words: Words, known: Known) -> Thing | None:
    first, rest = words[0].text, words[1:]
    if first in _THERE:  # `there's a knock at the door`
        rest = rest[1:] if rest and rest[0].text in MODALS else rest
        found = thing(rest, known) if rest and rest[0].text in ARTICLES else None
        return Thing(found.named if found else (), "")
    weather = any(word.text in _WEATHER for word in rest[:2])
    return Thing(words[:1] if first in _IT and not weather else (), "")


def _verb(noun: Words, known: Known) -> int:
    """At which of the words after a noun a verb stands; 0 for nowhere."""
    for k in range(1, min(_MOST_WORDS + 1, len(noun))):
        word, several = noun[k].text, is_third(noun[k - 1])
        does = is_third(noun[k]) or word in (*PAST, *MODALS) or is_not(word)
        plain = several and (word in VERBS or known.is_action(noun[k : k + 1]))  # `the cups fall`
        past = word.endswith("ed") and bool({*plain_forms(word)} & VERBS or known.is_action(noun[k : k + 1]))
        if does or plain or past:
            return k
    return 0
