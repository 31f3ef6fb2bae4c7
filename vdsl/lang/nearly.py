"""What is shown of a sentence that cannot be acted as it is written: as much of it as can.

Assumes the words of a beat, and what was reported when it was read. Guarantees that a slip of the finger
stays an error, so that it is told, and that there is always something somebody can do: they look at what the
sentence names, or wait.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from itertools import pairwise

from . import ast
from .diagnostics import Diagnostic, is_slip
from .phrases import Known, Words, is_third, of_several, says_how
from .pronouns import ALL, BOTH, ONE
from .source import Span
from .words import ARTICLES, PREPOSITIONS, fold, plain_forms

#: What is wrong with a sentence that is shown all the same: nothing, nobody or no action is called so, it
#: needs a target or takes none, it is done to something else, or to one of several, or its words are no name.
_FORGIVEN = {"VDS060", "VDS061", "VDS065", "VDS071", "VDS072", "VDS073", "VDS074"}
_OWN = ("her", "his", "their")
_IT = ("it", "it's", "there's", "that's")
_MOST_NOUN_WORDS = 4
#: Verbs that are no slips of others, and after which a thing does something.
_HELPERS = (
    "doesn't",
    "don't",
    "won't",
    "isn't",
    "can't",
    "does",
    "starts",
    "goes",
    "is",
    "has",
    "was",
    "tries",
)
#: What is named after them has nothing done to it.
_NOT_TO = ("from", "of", "without")
_SHORTEST = 3  # letters of a word that may be mistyped


def is_told(words: Words, said: str) -> bool:
    """Whether words are of a sentence, and no line as ``anna walk door``. said: the beat as it is written"""
    first = said.strip().removeprefix("(").split(maxsplit=1)[:1]
    pronoun = bool(first) and first[0].casefold() in (*ONE, *BOTH, *ALL)
    third = any(w.text.endswith("s") and not w.text.endswith("ss") for w in words[1:3])
    return pronoun or third or any(word.text in (*ARTICLES, *_OWN, *_HELPERS) for word in words)


def thing(words: Words, known: Known) -> Words:
    """The words that name what a sentence is about in which nobody acts, as ``the phone rings``; () for
    another."""
    if words[0].text in _IT[1:] and len(words) > 1:
        return words[:1]
    article = words[0].text in ARTICLES
    noun = tuple(word for word in words if not says_how(word))
    noun = noun[1:] if article else noun
    verb = next((k for k in range(1, min(_MOST_NOUN_WORDS + 1, len(noun))) if _is_verb(noun[k:])), 0)
    end = verb or (len(noun) if article else 0)  # `a loud bang from outside`
    group = noun[: next((k for k in range(1, end) if noun[k].text in PREPOSITIONS), end)]
    if not group or any(word.text in known.named for word in group):
        return ()
    last = group[-1]
    is_one = last.text in _IT or known.is_name(last) or any(map(known.is_thing, (last, *of_several(last))))
    unknown = article and not known.is_person(last.text)
    slip = any(is_slip(word.text, name) for word in group for name in known.named)
    return () if slip or not (is_one or unknown) else group


def _is_verb(words: Words) -> bool:
    return is_third(words[0]) or words[0].text in _HELPERS


def is_forgiven(wrong: Sequence[Diagnostic], actions: Collection[str], things: Collection[str]) -> bool:
    """Whether a sentence of which that was reported is shown as far as it can be. actions, things: what they
    may be called"""
    return bool(wrong) and all(
        each.code in _FORGIVEN and not _is_slip(each, actions, things) for each in wrong
    )


def why(wrong: Diagnostic) -> str:
    """What is wrong, and where what there is can be found."""
    kind = {"VDS060": "props", "VDS071": "actions"}.get(wrong.code)
    more = f"`vdsc assets {kind} --search WORDS` finds what there is" if kind else wrong.help
    return "; ".join(filter(None, (wrong.label, more)))


def _is_slip(wrong: Diagnostic, actions: Collection[str], things: Collection[str]) -> bool:
    word = fold(wrong.span.text)
    if wrong.code == "VDS071":
        forms = {word, *plain_forms(word)}
        return wrong.span.text not in _HELPERS and any(
            is_mistyped(form, name) for form in forms for name in actions
        )
    meant = wrong.suggestion and fold(wrong.suggestion)
    near = bool(meant and abs(len(meant) - len(word)) <= 1)
    return near or (wrong.code == "VDS060" and any(is_mistyped(word, name) for name in things))


def is_mistyped(word: str, name: str) -> bool:
    """Whether a word is a name but that a letter is missing or twice there, or two changed places. Of English
    verbs too many are a letter more or other than some action: ``weaves``, ``chugs``, ``blows``."""
    if word == name or len(word) < _SHORTEST or not is_slip(word, name):
        return False
    twice = any(word[:k] + word[k + 1 :] == name and word[k] == word[k - 1] for k in range(1, len(word)))
    return len(word) < len(name) or twice or sorted(word) == sorted(name)


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
        linked: list[ast.Name] = []
        for k, word in enumerate(rest):
            if any(word is name for name in names):
                linked += [rest[k - 1], word] if k and rest[k - 1].text in PREPOSITIONS else [word]
        if linked:
            yield (who, *verb, *linked)
        for name in names:
            yield (who, *verb, name)
    if verb and alone:
        yield (who, *verb)
    span = (verb or rest or (who,))[0].span
    yield from looks(who, names, span)


def looks(who: ast.Name, names: Sequence[ast.Name], span: Span) -> Iterator[Words]:
    """That somebody looks at one of these, or waits. span: what stands for it in the script"""
    for name in names:
        yield (who, ast.Name(("look",), span), ast.Name(("at",), span), name)
    yield (who, ast.Name(("wait",), span))
