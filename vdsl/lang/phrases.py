"""What people write around an action and its names, brought to the words that count.

``the``, ``her`` and ``starts to`` say nothing to a storyboard; ``in front of`` is one preposition; of
``throws the phone away`` the verb is ``throw away``. Assumes the words of one beat, the character first.
Guarantees that no word is touched that is somebody's name, and that what is left keeps its place in the text.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from . import ast
from .words import ARTICLES, PREPOSITIONS, plain_forms

#: Before a verb, by itself or with ``to``, they say that it begins or goes on.
AUXILIARIES = ("is", "are", "start", "begin", "try", "continue", "keep", "proceed")
#: After a verb, or at the end: a direction, where no name follows.
PARTICLES = (
    "in",
    "out",
    "up",
    "down",
    "on",
    "off",
    "over",
    "away",
    "back",
    "past",
    "along",
    "around",
    "apart",
)
#: They say when, or how often; never what.
ADVERBS = ("again", "suddenly", "then", "finally", "together", "back", "away", "still", "now", "just")
#: Several words that are one preposition.
_JOINED = {
    ("in", "front", "of"): "before",
    ("on", "top", "of"): "on",
    ("across", "from"): "opposite",
    ("next", "to"): "beside",
    ("close", "to"): "near",
    ("away", "from"): "from",
    ("up", "to"): "to",
    ("over", "to"): "to",
    ("back", "to"): "to",
}
_LONGEST = max(len(words) for words in _JOINED)
#: Who acts is said by name.
PRONOUNS = ("he", "she", "they", "it", "both", "everyone", "everybody", "all", "we", "i", "you")
#: But for these, where two are about: they do it both, or to each other.
BOTH = ("they", "both")
#: Whom it is done to, where that is the only other one about.
_OBJECTS = ("him", "her", "them")
#: Parts of a body: an action knows which it needs.
_BODY = {
    "head", "face", "eyes", "eye", "ears", "nose", "mouth", "lips", "cheek", "cheeks", "chin", "forehead",
    "hair", "neck", "shoulder", "shoulders", "back", "chest", "belly", "arm", "arms", "elbow", "hand",
    "hands", "finger", "fingers", "fist", "fists", "wrist", "leg", "legs", "knee", "knees", "foot", "feet",
}  # fmt: skip

Words = tuple[ast.Name, ...]


def plain(said: Words, named: Sequence[str], other: str, is_action: Callable[[Words], bool]) -> Words:
    """The words of a beat without those that say nothing, with a verb's particle right after it.

    named: people of the storyboard; other: the only other one who is about, or ""; is_action: whether all of
    some words name an action
    """
    character, rest = said[:1], _without(_named(said[1:], named, other), named)
    rest = _one_each(_without_auxiliary(rest, is_action), is_action)
    while len(rest) > 1 and rest[-1].text in ADVERBS and rest[-1].text not in PARTICLES:
        rest = rest[:-1]
    if len(rest) > 2 and rest[-1].text in PARTICLES and is_action((rest[0], rest[-1])):
        rest = (rest[0], rest[-1], *rest[1:-1])
    return character + rest


def both(node: ast.BeatNode, about: Sequence[str], named: Sequence[str]) -> tuple[ast.BeatNode, ...]:
    """The beat, or where it is of ``they`` and two people are about, the same of each of them."""
    word = node.words[0]
    if word.text not in BOTH or word.text in named or len(about) != 2:
        return (node,)
    return tuple(replace(node, words=(ast.Name((who,), word.span), *node.words[1:])) for who in about)


def targets_alone(rest: Words, is_name: Callable[[ast.Name], bool]) -> Words:
    """What follows an action without adverbs, without parts of bodies, as in ``on the cheek``, and without a
    particle that no name follows."""
    kept: Words = ()
    for word in rest:
        if is_name(word) or word.text not in (*ADVERBS, *_BODY):
            kept = (*kept, word)
        elif word.text in _BODY and kept and kept[-1].text in PREPOSITIONS:
            kept = kept[:-1]
    while kept and kept[-1].text in PARTICLES and not is_name(kept[-1]):
        kept = kept[:-1]
    return kept


def _named(said: Words, named: Sequence[str], other: str) -> Words:
    """With a name for ``him`` and ``them``, and for ``her`` where it is not hers that something is."""
    out = []
    for n, word in enumerate(said):
        ends = n + 1 == len(said) or said[n + 1].text in (*PREPOSITIONS, *PARTICLES)
        object_ = word.text in _OBJECTS and word.text not in named and (word.text != "her" or ends)
        out.append(ast.Name((other,), word.span) if object_ and other else word)
    return tuple(out)


def _without(said: Words, named: Sequence[str]) -> Words:
    """Without articles, and without words for whose something is."""
    return tuple(word for word in said if word.text not in ARTICLES or word.text in named)


def _without_auxiliary(rest: Words, is_action: Callable[[Words], bool]) -> Words:
    """``cry`` of ``starts to cry`` and of ``is crying``."""
    if not rest or not {rest[0].text, *plain_forms(rest[0].text)} & {*AUXILIARIES}:
        return rest
    after = rest[2:] if len(rest) > 2 and rest[1].text == "to" else rest[1:]
    begins_one = any(is_action(after[:size]) for size in range(1, min(4, len(after)) + 1))
    return after if begins_one else rest


def _one_each(rest: Words, is_action: Callable[[Words], bool]) -> Words:
    """With every preposition as one word, but for those that belong to an action."""
    out: list[ast.Name] = []
    at = 0
    while at < len(rest):
        for size in range(_LONGEST, 1, -1):
            some = rest[at : at + size]
            one = _JOINED.get(tuple(word.text for word in some))
            if one is not None and not is_action((*out, *some)):
                out.append(ast.Name((one,), some[0].span.to(some[-1].span)))
                at += size
                break
        else:
            out.append(rest[at])
            at += 1
    return tuple(out)
