"""What people write around an action and its names, brought to the words that count.

``the``, ``her`` and ``starts to`` say nothing to a storyboard; ``in front of`` is one preposition; of
``throws the phone away`` the verb is ``throw away``. Assumes the words of one beat, the character first.
Guarantees that no word is touched that is somebody's name, and that what is left keeps its place in the text.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from . import ast
from .english import MODALS, is_past
from .pronouns import ALL, BOTH, ONE, Mentions
from .words import ARTICLES, PREPOSITIONS, WHERE, plain_forms

#: Before a verb, by itself or with ``to``, they say that it begins or goes on.
AUXILIARIES = (
    "is", "are", "was", "were", "been", "has", "had", "will", "would", "can", "could", "must", "may", "might",
    "should", "start", "begin", "try", "continue", "keep", "proceed", "pretend",
)  # fmt: skip
_BE = ("is", "are", "was", "were", "been")
#: With ``to`` before another verb they say no more than that who acts is about to.
_TOWARDS = (
    "come", "decide", "go", "hurry", "lean", "manage", "reach", "rush", "stop", "turn", "walk", "bend", "run",
)  # fmt: skip
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
#: The same at the end alone: `peeks inside`.
_NO_MORE = ("above", "across", "behind", "below", "by", "inside", "outside", "through", "under")
#: Several words that say how, and never what.
_SAID_HOW = (
    "up and down", "back and forth", "to and fro", "round and round", "over and over", "hand in hand",
    "arm in arm", "side by side", "face to face", "out loud", "at once", "in a row", "in row", "by and by",
    "in time", "on time", "as usual", "no more", "in vain", "on purpose", "by accident", "one by one",
)  # fmt: skip
#: They say when, or how often; never what.
ADVERBS = (
    "again", "suddenly", "then", "finally", "together", "back", "still", "now", "just", "too", "alone",
    "apart", "aside", "barefoot", "closed", "early", "late", "open", "shut", "sideways", "straight",
    "there", "here", "upside", "one", "two", "all", "own", "once", "last", "long", "alike", "first",
    "faster", "slower", "closer", "nearer", "louder", "harder", "quicker", "farther", "further",
    "shyly", "slyly", "flat", "himself", "herself", "themselves", "itself", "twice", "lower", "higher",
    "upright", "upstairs", "downstairs", "indoors", "outdoors", "forward", "forwards", "backwards",
    "downwards", "upwards", "little", "both",
)  # fmt: skip
#: Several words that are one preposition.
_JOINED = {
    ("in", "front", "of"): "before",
    ("on", "top", "of"): "on",
    ("across", "from"): "opposite",
    ("next", "to"): "beside",
    ("close", "to"): "near",
    ("up", "to"): "to",
    ("over", "to"): "to",
    ("back", "to"): "to",
}
_LONGEST = max(len(words) for words in _JOINED)
#: Words for who acts that are no names.
PRONOUNS = ("he", "she", "they", "it", "both", "everyone", "everybody", "all", "we", "i", "you")
#: Whom it is done to: the one who was spoken of last.
_OBJECTS = ("him", "her", "them")
_EACH_OTHER = (("each", "other"), ("one", "another"))
#: A part of the body after ``her``, and no direction.
_HER_BACK = tuple(("back", word) for word in ("against", "to", "on"))
#: What is about everywhere, and is named to say where: an action that needs no place needs none of these.
_EVERYWHERE = (
    "floor",
    "ground",
    "grass",
    "sky",
    "air",
    "ceiling",
    "room",
    "home",
    "street",
    "sand",
    "carpet",
)
#: They say how, when or why something is done: `with a sigh`, `at the last second`, `for a long time`.
_HOW = {
    "accident", "anger", "care", "dark", "darkness", "despair", "disgust", "disbelief", "effort",
    "fear", "force", "fun", "grin", "hurry", "joy", "kick", "laugh", "might", "minute", "moment", "nod",
    "pain", "panic", "prayer", "purpose", "rage", "relief", "scream", "second", "shrug", "sigh", "silence",
    "smile", "strength", "surprise", "tear", "tears", "time", "while",
}  # fmt: skip
_NO_ADVERBS = ("assembly", "beverly", "family", "supply")
#: They choose among several: they are not left out in silence.
_COUNTING = ("first", "second", "last", "one", "two", "other")
#: How much there is of something.
_MEASURES = (
    "bit",
    "bunch",
    "couple",
    "drop",
    "handful",
    "heap",
    "lot",
    "lots",
    "pair",
    "piece",
    "pile",
    "sheet",
    "sip",
    "slice",
    "slices",
    "stack",
)
#: Parts of a body: an action knows which it needs.
BODY = {
    "head", "face", "eyes", "eye", "ears", "nose", "mouth", "lips", "cheek", "cheeks", "chin", "forehead",
    "hair", "lip", "ear", "throat", "tongue", "teeth", "brow", "waist", "hip", "hips", "thigh", "toe", "toes",
    "heel", "heels", "thumb", "palm", "palms", "sleeve", "collar", "pocket", "pockets", "neck", "shoulder",
    "shoulders", "back", "chest", "belly", "arm", "arms", "elbow", "hand", "hands", "finger", "fingers",
    "stomach", "lap", "ribs", "jaw", "skirt", "pants", "trousers", "jeans", "shirt", "jacket", "coat",
    "dress", "shoe", "shoes", "boots", "sweater", "apron", "eyebrow", "eyebrows", "fist", "fists", "wrist",
    "leg", "legs", "knee", "knees", "foot", "feet",
}  # fmt: skip

#: Verbs that say nothing before a noun for what is done. What is also a thing is not among the nouns, as a
#: drink or a call; and who takes or has a punch does not hit.
#: After them somebody is named who gets something.
GIVING = ("give", "bring", "buy", "hand", "make", "offer", "pass", "pour", "show", "throw", "toss")
_LIGHT = {"give", "take", "do", "make", "have", "has", "throw", "steal"}
_DONE_ALONE = {
    "look", "glance", "bow", "walk", "run", "stroll", "nap", "stretch", "jump", "spin", "turn", "laugh",
    "peek", "hop", "sip", "dance", "sigh", "curtsy",
}  # fmt: skip
_DONE = _DONE_ALONE | {
    "hug", "kiss", "wave", "nod", "push", "slap", "punch", "pat", "salute", "shrug", "smile", "wink", "frown",
    "shout", "cheer", "cough", "high five", "fist bump", "thumbs up", "kick", "tickle", "lecture",
}  # fmt: skip

_WORN_ON = ("head", "face", "nose", "finger", "wrist", "neck", "feet", "hands")

Words = tuple[ast.Name, ...]


@dataclass(frozen=True)
class Known:
    """What a line's words may stand for.

    named: people of the storyboard; them: who, besides the one who acts, a pronoun means, or ""; own: whether
    it may mean who acts; it: the parts of the name of what was spoken of last, or (); many: whether it was
    several; is_action: whether all of some words name an action; is_name: whether a word is somebody's or
    something's in the scene; is_thing: whether it is one for a prop; may_be: whether a pronoun may mean
    somebody; is_person: whether a word is one for people, as ``waiter``
    """

    named: Sequence[str]
    them: Callable[..., str]
    own: Callable[[str], bool]
    it: tuple[str, ...]
    many: bool
    is_action: Callable[[Words], bool]
    is_name: Callable[[ast.Name], bool]
    is_thing: Callable[[ast.Name], bool]
    may_be: Callable[[str, str], bool]
    is_person: Callable[[str], bool]


def plain(said: Words, known: Known) -> Words:
    """The words of a beat without those that say nothing, with all words of a verb side by side."""
    character, rest = said[:1], _without(_with_names(_without_how(said[1:], known), known), known.named)
    while len(rest) > 1 and says_how(rest[0]) and not known.is_name(rest[0]):
        if any(known.is_action(rest[:size]) for size in (1, 2, 3)):  # `back away`
            break
        rest = rest[1:]  # `secretly pulls`
    rest = about_to(rest, known.is_action, known.is_name) or rest
    rest = _one_each(_without_auxiliary(rest, known.is_action), known.is_action)
    while len(rest) > 1 and rest[-1].text in ADVERBS and rest[-1].text not in (*PARTICLES, *known.named):
        if rest[-2].text in PREPOSITIONS and rest[-2].text not in PARTICLES:  # `to herself`
            break
        twice = len(rest) > 3 and rest[-2].text == "and" and rest[-3].text == rest[-1].text
        rest = rest[:-3] if twice else rest[:-1]  # `again and again`
    return character + _verb_first(_as_done(rest, known), known)


def each_of(node: ast.BeatNode, mentions: Mentions, known: Known) -> tuple[tuple[ast.BeatNode, ...], bool]:
    """The beat with a name for who acts, or where it is of several, as of ``anna and ben`` or ``they``, the
    same of each of them; and whether these do it with each other rather than with whoever else is about.

    Whom several do something to is found once for all of them.
    """
    first, count = node.words[0], 1
    while count + 1 < len(node.words) and node.words[count].text == "and" and "and" not in known.named:
        count += 2
    if count > 1:
        some = tuple(_who(word, mentions) for word in node.words[:count:2])
        mentions.acting = tuple(word.text for word in some)
        return _done_by(node, some, _with_names(node.words[count:], known, False)), True
    if first.text in known.named:
        return (node,), False
    rest = node.words[1:]
    if first.text == "they" and rest[:1] != () and rest[0].text == "all":
        first, rest = ast.Name(("all",), first.span.to(rest[0].span)), rest[1:]
    who: tuple[str, ...] = ()
    if first.text in ALL or first.text in BOTH:
        mentions.acting = mentions.two() if first.text in BOTH else ()
        rest = _with_names(rest, known, False)
        several = mentions.about if first.text in ALL else mentions.two()
        who = tuple(name for name in several if all(word.text != name for word in rest))  # all others
    elif first.text in ONE:
        who = (mentions.who_acts(first.text),)
    names = tuple(ast.Name((name,), first.span) for name in who if name)
    if not names:
        return (node,), False
    return _done_by(node, names, rest), len(names) == 2 and len(mentions.about) != 2


def _who(word: ast.Name, mentions: Mentions) -> ast.Name:
    """With a name for ``she``, where it may mean somebody."""
    name = mentions.who_acts(word.text) if word.text in ONE else ""
    return ast.Name((name,), word.span) if name else word


def looks_like_a_verb(said: Words, is_thing: Callable[[ast.Name], bool]) -> bool:
    """Whether words begin with a verb in the third person that nobody knows: ``whirls around``."""
    if len(said) < 2 or not is_third(said[0]) or any(map(is_thing, (said[0], *of_several(said[0])))):
        return False
    follows = (*ARTICLES, *PARTICLES, *PREPOSITIONS, *_OBJECTS, "it")
    return said[1].text in follows or said[1].text.endswith("self")


def is_third(verb: ast.Name) -> bool:
    """Whether a verb is in the third person: ``walks``, and not ``kiss``."""
    return verb.text.endswith("s") and not verb.text.endswith("ss")


def _done_by(node: ast.BeatNode, who: Words, rest: Words) -> tuple[ast.BeatNode, ...]:
    return tuple(replace(node, words=(one, *rest)) for one in who)


def targets_alone(rest: Words, is_name: Callable[[ast.Name], bool]) -> Words:
    """What follows an action without adverbs, without what says how, when or where in the world, as ``with a
    sigh``, ``on the cheek`` and ``on the floor``, without what a thing is full of, and without a particle at
    its end."""
    groups: list[Words] = [()]
    for word in rest:
        if word.text in PREPOSITIONS and not is_name(word):
            measures = [w.text in _MEASURES and not is_name(w) for w in groups[-1][-1:]]
            if word.text == "of" and any(measures):  # `a bunch of roses`
                groups[-1] = groups[-1][:-1]
                continue
            groups.append(())
        groups[-1] = (*groups[-1], word)
    kept: Words = ()
    for group in groups:
        begins = group[:1] if group[:1] != () and group[0].text in PREPOSITIONS else ()
        if begins != () and is_name(group[0]):
            begins = ()
        kept = (*kept, *_target_of(begins, group[len(begins) :], bool(kept), is_name))
    while kept and kept[-1].text in (*PARTICLES, *_NO_MORE) and not is_name(kept[-1]):
        kept = kept[:-1]
    return kept


def _target_of(begins: Words, said: Words, later: bool, is_name: Callable[[ast.Name], bool]) -> Words:
    """Of a preposition and what follows it, or of what follows a verb, what names a target; later: whether
    something was named before."""
    if begins and not said:
        return begins
    if begins and later and begins[0].text == "of":  # `a glass of water` is a glass
        return (*begins, *names) if (names := tuple(w for w in said if is_name(w))) else ()
    words = said
    while len(words) > (1 if begins else 0) and says_how(words[-1]) and not is_name(words[-1]):
        if words[-1].text in BODY:
            break
        words = words[:-1]
    named = any(is_name(word) for word in words)
    if not named and words and words[-1].text in _HOW and not begins:  # `the letter one last time`
        while words and (words[-1].text in _HOW or says_how(words[-1])):
            words = words[:-1]
        return words
    if not named and words and (words[-1].text in (*BODY, *_HOW, *_EVERYWHERE) or words[-1].text in ADVERBS):
        return ()  # `greasy hands`, `with a heavy sigh`, `to herself`
    words = tuple(w for w in words if is_name(w) or w.text in _COUNTING or not says_how(w))
    words = tuple(word for word in words if is_name(word) or word.text not in (*BODY, *_HOW, *_EVERYWHERE))
    return (*begins, *words) if words else ()


def is_small(word: str) -> bool:
    """Whether a word is one for how, when or why: of somebody called so it is no name where it is small."""
    return word in _HOW or word in ADVERBS or word in PREPOSITIONS or word in MODALS or word in AUXILIARIES


def says_how(word: ast.Name) -> bool:
    return word.text in ADVERBS or _is_adverb(word.text)


def _is_adverb(word: str) -> bool:
    """Whether a word looks like one: ``softly``, and not ``molly``, ``family`` or ``butterfly``."""
    return word.endswith("ly") and len(word) > 5 and not word.endswith("fly") and word not in _NO_ADVERBS


def of_several(name: ast.Name) -> tuple[ast.Name, ...]:
    """What one of several may be called: ``candle`` of ``candles``, ``glass`` of ``glasses``."""
    word, forms = name.text, []
    if len(name.parts) == 1 and word.endswith("s") and not word.endswith("ss"):
        forms = [word[:-1], *([f"{word[:-3]}y"] if word.endswith("ies") else [])]
        forms += [word[:-2]] if word.endswith(("ches", "shes", "xes", "sses")) else []
    return tuple(ast.Name((form,), name.span) for form in forms if form)


def first_is_of_a_body(rest: Words, is_name: Callable[[ast.Name], bool]) -> bool:
    """Whether what is done is done to a part of a body, and to nothing else: ``her eyes``."""
    first: Words = ()
    for word in rest:
        if word.text in PREPOSITIONS:
            break
        first = (*first, word)
    return first != () and first[-1].text in BODY and not any(is_name(word) for word in first)


def only_how(rest: Words) -> bool:
    """Whether words say how something is done and nothing else."""
    return rest != () and all(word.text in _HOW or says_how(word) for word in rest)


def without_walls(rest: Words, is_name: Callable[[ast.Name], bool]) -> Words:
    """What follows an action that is done against something, without the wall: it is the nearest one."""
    kept: Words = ()
    for word in rest:
        if is_name(word) or word.text not in ("wall", "walls"):
            kept = (*kept, word)
        elif kept and kept[-1].text in PREPOSITIONS:
            kept = kept[:-1]
    return kept


def _with_names(said: Words, known: Known, each_other: bool = True) -> Words:
    """With names for ``him``, ``them`` and ``it``, and for ``her`` where it is not hers that something is;
    and for ``each other`` unless that waits until it is known who."""
    out: list[ast.Name] = []
    for n, word in enumerate(said):
        if each_other and known.them() and tuple(w.text for w in said[n : n + 2]) in _EACH_OTHER:
            out.append(ast.Name((known.them(),), word.span.to(said[n + 1].span)))
            continue
        if each_other and n and tuple(w.text for w in said[n - 1 : n + 1]) in _EACH_OTHER:
            continue
        ends = n + 1 == len(said) or said[n + 1].text in (*PREPOSITIONS, *PARTICLES, *ARTICLES, *ADVERBS)
        ends = ends and tuple(w.text for w in said[n + 1 : n + 3]) not in _HER_BACK
        things = word.text == "it" or (word.text == "them" and known.many)
        meant: tuple[str, ...] = known.it if things else ()
        if not things and word.text in _OBJECTS and (word.text != "her" or ends) and known.them(word.text):
            meant = (known.them(word.text),)
        behind = ends and not meant and out != [] and out[-1].text in WHERE and known.own(word.text)
        if word.text in _OBJECTS and behind and (n + 1 == len(said) or said[n + 1].text not in BODY):
            out.pop()  # `behind her`, where she is who acts
            continue
        out.append(ast.Name(meant, word.span) if meant and word.text not in known.named else word)
    return tuple(out)


def _verb_first(rest: Words, known: Known) -> Words:
    """``throw away the phone`` for ``throw the phone away``, ``blow kiss ben`` for ``blow ben a kiss``,
    ``take hand ben`` for ``take ben by the hand``."""
    if len(rest) < 3 or known.is_action(rest[:2]):
        return rest
    verb, first, *others, last = rest
    worn = last.text in _WORN_ON and others[-1:] != [] and others[-1].text == "on" and first.text not in BODY
    if worn and known.is_action((verb, others[-1])):  # `puts the hat on her head`
        return (verb, others[-1], first, *others[:-1])
    if last.text in PARTICLES and known.is_action((verb, last)):
        return (verb, last, first, *others)
    if last.text in BODY and known.is_action((verb, last)) and first.text not in known.named:
        return (verb, last)  # `wash greasy hands`
    noun = next((k for k, word in enumerate(rest) if k > 1 and word.text in PREPOSITIONS), len(rest)) - 1
    light = {verb.text, *plain_forms(verb.text)} & {"take", "have"}
    if (
        light
        and noun > 1
        and known.is_action((verb, rest[noun]))
        and not any(known.is_name(w) for w in rest[1:noun])
    ):
        return (verb, rest[noun], *rest[noun + 1 :])  # `take a deep breath`
    by = not others or (len(others) == 1 and others[0].text in PREPOSITIONS)
    if first.text in known.named and by and known.is_action((verb, last)):
        return (verb, last, first)
    return rest


def _as_done(rest: Words, known: Known) -> Words:
    """``hug ben`` for ``give ben a hug``, ``nod`` for ``give a nod``, ``look at ben`` for ``take a look at
    ben``: the verb says nothing, and the noun is what is done."""
    verbs = {rest[0].text, *plain_forms(rest[0].text)} & _LIGHT if rest else set()
    if not verbs:
        return rest
    whom = rest[1:2] if len(rest) > 2 and rest[1].text in known.named else ()
    nouns = _DONE if verbs & {"give", "throw"} else _DONE_ALONE
    begin = 1 + len(whom)
    for at, size in ((begin, 2), (begin, 1), (begin + 1, 2), (begin + 1, 1)):  # `a quick look`
        noun, others = rest[at : at + size], rest[at + size :]
        if " ".join(word.text for word in noun) not in nouns or known.is_action((rest[0], *noun)):
            continue
        if known.is_action(noun) and (not others or others[0].text in (*PREPOSITIONS, *PARTICLES)):
            return (*noun, *whom, *others)
    return rest


def _without(said: Words, named: Sequence[str]) -> Words:
    """Without articles, and without words for whose something is."""
    return tuple(word for word in said if word.text not in ARTICLES or word.text in named)


def _without_how(rest: Words, known: Known) -> Words:
    """Without ``up and down`` and ``hand in hand``, where these are no part of an action."""
    out: Words = ()
    while rest:
        sizes = [len(said) for how in _SAID_HOW if _texts(rest[: len(said := how.split())]) == said]
        size = max(sizes, default=0)
        if out and size and not known.is_action((*out, *rest[:size])):
            rest = rest[size:]
        else:
            out, rest = (*out, rest[0]), rest[1:]
    return out


def _texts(said: Words) -> list[str]:
    return [word.text for word in said]


def _without_auxiliary(rest: Words, is_action: Callable[[Words], bool]) -> Words:
    """``cry`` of ``starts to cry``, of ``is crying`` and of ``goes on crying``."""
    if [word.text for word in rest[1:2]] == ["on"] and rest[2:] != () and rest[2].text.endswith("ing"):
        rest = rest[2:] if {rest[0].text, *plain_forms(rest[0].text)} & {"go"} else rest
    if not rest or not {rest[0].text, *plain_forms(rest[0].text)} & {*AUXILIARIES}:
        return rest
    after = rest[2:] if len(rest) > 2 and rest[1].text == "to" else rest[1:]
    if rest[0].text in _BE and is_past(after[0].text if after else ""):
        return rest  # `is kissed` is nothing one does
    if after and after[0].text in AUXILIARIES:
        return _without_auxiliary(after, is_action)  # `has been waiting`
    begins_one = any(is_action(after[:size]) for size in range(1, min(4, len(after)) + 1))
    return after if begins_one else rest


def about_to(rest: Words, is_action: Callable[[Words], bool], is_name: Callable[[ast.Name], bool]) -> Words:
    """``kiss anna`` of ``leans in to kiss anna``, ``()`` of other words: what somebody goes to do."""
    if not rest or not {rest[0].text, *plain_forms(rest[0].text)} & {*_TOWARDS}:
        return ()
    at = 1
    while at < len(rest) and rest[at].text in PARTICLES:
        at += 1
    after = rest[at + 1 :]
    if rest[at : at + 1] == () or rest[at].text != "to" or not after or is_name(after[0]):
        return ()
    if is_action(rest[: at + 2]):  # `goes to sleep`
        return ()
    return after if any(is_action(after[:size]) for size in range(1, min(4, len(after)) + 1)) else ()


def _one_each(rest: Words, is_action: Callable[[Words], bool]) -> Words:
    """With every preposition as one word, but for those that belong to an action."""
    out: list[ast.Name] = []
    at = 0
    while at < len(rest):
        for size in range(_LONGEST, 1, -1):
            some = rest[at : at + size]
            one = _JOINED.get(tuple(word.text for word in some))
            particle = some[-1].text in ("to", "from") and is_action((*out, some[0]))  # `steps back to`
            if one is not None and not particle and not is_action((*out, *some)):
                out.append(ast.Name((one,), some[0].span.to(some[-1].span)))
                at += size
                break
        else:
            out.append(rest[at])
            at += 1
    return tuple(out)
