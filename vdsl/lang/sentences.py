"""What a beat says, sentence by sentence: ``She stops. The phone rings; both of them look up.``

Assumes the words of one beat as they are written, full stops and commas among them. Guarantees parts in the
order they are done in, each beginning with who does it, and that what is left out is told.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from runtime.motion.manner import MANNERS

from . import ast
from .clauses import (
    CLAUSES,
    COMMA,
    LATER,
    Part,
    Sentence,
    begins,
    is_ing,
    one_sentence,
    owned,
    subject,
)
from .english import is_past
from .phrases import Known, Words, says_how
from .pronouns import owner
from .things import thing
from .words import ARTICLES, PREPOSITIONS, fold

STOP = "."
#: Who does it, of one word with what they are: `she's crying`.
_IS = {"she's": "she", "he's": "he", "they're": "they"}
_BE = ("is", "are", "was", "were", "gets", "got")
_OBJECTS = ("him", "her", "them", "it")
_COUNTED = ("second", "minute", "hour", "time", "step", "metre", "meter")
_SEVERAL = {
    ("both", "of", "them"): "both",
    ("the", "two", "of", "them"): "both",
    ("the", "two"): "both",
    ("all", "of", "them"): "all",
}


def sentence(said: Words, known: Known) -> Sentence:
    """The words of a beat as they are written, taken apart."""
    parts: list[Part] = []
    left: list[Words] = []
    who: Words = ()
    *before, last = _until_stops(said)
    for each in (*before, last):
        words = owned(_plainly(_several(_uncounted(each)), known), known)
        if not parts and each is not last and not _is_about(words, known):
            left.append(words)  # `Footsteps; anna ducks`
            continue
        if parts and not _is_about(words, known):
            if begins(words, known) is None:  # `She stops. Silence.`
                left.append(words)
                continue
            words = (*who, *words)  # `She stops. Turns.`
        one = one_sentence(words, known)
        parts += [replace(one.parts[0], meanwhile=False, fresh=True), *one.parts[1:]] if parts else one.parts
        left += one.left_out
        who = words[: subject(words, known)] or who
    return Sentence(tuple(parts), tuple(left))


def speaks(said: Words, known: Known) -> Words:
    """Words with ``talk`` where they say only who says something, how, and to whom: ``anna to ben``."""
    said = tuple(word for word in said if word.text != COMMA) if len(said) < 4 else said
    count = subject(said, known)
    after = next((k for k in range(count, len(said)) if not _is_how(said[k])), len(said))
    if not count or (after < len(said) and said[after].text not in PREPOSITIONS):
        return said
    return (*said[:count], ast.Name(("talk",), said[count - 1].span), *said[count:])


def _is_how(word: ast.Name) -> bool:
    return says_how(word) or fold(word.text) in MANNERS


def _until_stops(said: Words) -> Iterator[Words]:
    """The sentences between full stops; there is at least one, be it empty."""
    ends = [k for k, word in enumerate(said) if word.text == STOP]
    found = [said[a:b] for a, b in zip([0, *(k + 1 for k in ends)], [*ends, len(said)], strict=True)]
    yield from [words for words in found if words] or [said[:1]]


def _is_about(words: Words, known: Known) -> bool:
    """Whether words begin with who acts, with a thing that does something, or with when or how it is."""
    begun = any(word.text in (COMMA, *CLAUSES, *LATER) for word in words[:3]) or says_how(words[0])
    return bool(subject(words, known)) or begun or thing(words, known, True) is not None


def _uncounted(said: Words) -> Words:
    """Without ``for 3 seconds``, ``2 times``."""
    out: list[ast.Name] = []
    for word in said:
        if out and out[-1].text.isdigit() and word.text.removesuffix("s") in _COUNTED:
            out.pop()
            if len(out) > 1 and out[-1].text == "for":
                out.pop()
            continue
        out.append(word)
    return tuple(out)


def _plainly(said: Words, known: Known) -> Words:
    """``she cries`` for ``she's crying``, ``anna`` for ``a nervous anna``, who does it first where it is done
    by somebody: ``ben kissed anna`` for ``anna is kissed by ben``; and the pasts that are other verbs too."""
    if not said:
        return said
    first, after = said[0], said[1:]
    who = _IS.get(first.text) or owner(first.text)
    does = bool(after) and (after[0].text in PREPOSITIONS or is_ing(after[0], known))
    if first.text in _IS or (who in known.named and does):
        said = (ast.Name((who,), first.span), ast.Name(("is",), first.span), *after)
    at = next((k for k in range(1, min(4, len(said))) if said[k].text in known.named), 0)
    if at and first.text in ARTICLES and (at > 1 or said[at].span.text.istitle()):
        said = said[at:]  # `the old carl`
    count = subject(said, known)
    if count and said[count : count + 2] != () and len(said) > count + 1:
        verb, whom = said[count], said[count + 1]
        somebody = whom.text in (*ARTICLES, *known.named, *_OBJECTS)
        if verb.text == "saw" and somebody:
            return (*said[:count], ast.Name(("sees",), verb.span), *said[count + 1 :])
        after = said[count + 2 :]
        if verb.text == "lay" and whom.text == "down" and (not after or after[0].text in PREPOSITIONS):
            return (*said[:count], ast.Name(("lies",), verb.span), *said[count + 1 :])
        by = next((k for k in range(count, len(said) - 1) if said[k].text == "by"), 0)
        if verb.text in _BE and is_past(whom.text) and by and said[by + 1].text in known.named:
            return (said[by + 1], whom, *said[:count], *said[count + 2 : by], *said[by + 2 :])
    return said


def _several(said: Words) -> Words:
    """``both`` for ``both of them`` and ``the two``, ``all`` for ``all of them``."""
    texts = [word.text for word in said[:4]]
    for phrase, one in _SEVERAL.items():
        count = len(phrase)
        if tuple(texts[:count]) == phrase:
            return (ast.Name((one,), said[0].span.to(said[count - 1].span)), *said[count:])
    return said
