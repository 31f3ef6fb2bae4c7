"""Clauses of one sentence: ``while ben cooks``, ``, smiling``, ``carl's hand``, ``as the phone rings``.

Assumes the words of a sentence as they are written, commas among them. Guarantees parts in the order they are
done in, each beginning with who does it, without commas and possessives, and that what is left out is told.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from runtime.motion.manner import MANNERS

from . import ast, phrases
from .diagnostics import is_slip
from .english import is_not
from .phrases import AUXILIARIES, BODY, Known, Words, is_third, says_how
from .pronouns import ALL, BOTH, ONE, OWNERS, owner
from .things import thing
from .words import ARTICLES, PREPOSITIONS, fold, plain_forms

#: What they begin does not show: why, when, or what somebody thinks of it.
CLAUSES = (
    "as", "because", "but", "if", "like", "since", "so", "than", "till", "unless", "until", "when", "where",
    "which", "while", "who", "without",
)  # fmt: skip
#: What somebody else does is at the same time, or later.
_MEANWHILE, LATER = ("while", "as", "and"), ("and", "then")
#: What a part of a body does is what its owner does: `her hands tremble`.
_OF_A_BODY = ("tremble", "shake", "shiver", "quiver", "twitch")
#: Somebody does them to what somebody else is doing.
_PERCEIVES = {
    "look",
    "watch",
    "see",
    "hear",
    "listen",
    "notice",
    "catch",
    "find",
    "smell",
    "spot",
    "wave",
    "point",
}
_JOIN = ("and", "then", "but")
#: How much what follows is so.
_STRONGER = ("very", "quite", "rather", "so", "really", "ever")
COMMA = ","
_MOST_ACTION_WORDS = 3


@dataclass(frozen=True)
class Part:
    """Who does what. meanwhile: at the same time as the part before, else after it; fresh: in a sentence of
    its own"""

    words: Words
    meanwhile: bool = False
    fresh: bool = False


@dataclass(frozen=True)
class Sentence:
    """What a beat says: its parts, and what says nothing to a picture."""

    parts: tuple[Part, ...]
    left_out: tuple[Words, ...] = ()


def one_sentence(said: Words, known: Known) -> Sentence:
    """The words of a sentence without possessives, taken apart."""
    said = _in_one_manner(said, known)
    begun = _begun(said, known)
    if begun is not None:
        return begun
    said, left = _with_and(said, known)
    parts, clauses = _parts(said, known)
    return Sentence(parts, (*clauses, *left))


def _in_one_manner(said: Words, known: Known) -> Words:
    """Without the ``and`` of ``quickly and quietly``, which joins nothing that is done."""
    hows = [says_how(word) and word.text not in known.named for word in said]
    out: list[ast.Name] = []
    for k, word in enumerate(said):
        after = next((n for n in range(k, len(said)) if said[n].text not in _JOIN), k)
        before = next((n for n in range(k - 1, -1, -1) if said[n].text not in _JOIN), k)
        if after == k or before == k or not (hows[before] and hows[after]):
            out.append(word)
            continue
        first = next((n for n in range(before, 0, -1) if not hows[n - 1]), 0)
        done = said[after + 1].text if after + 1 < len(said) else ""
        if first > subject(said, known) and done and done not in PREPOSITIONS and done not in ARTICLES:
            out.append(word)  # `sits quietly and slowly eats`
    return tuple(out)


def one_after_the_other(said: Words, known: Known) -> tuple[Words, tuple[Words, ...]]:
    """Who acts, and what they do one after the other: ``sits down`` and ``reads`` of ``ben sits down and
    reads``."""
    count = max(1, subject(said, known))
    who, rest = said[:count], said[count:]
    third = _is_prose(said, known)
    cuts: list[tuple[int, int]] = []
    for k, word in enumerate(rest):
        joins = word.text == "and" or (word.text == "then" and rest[k - 1].text != "and")
        verb_at = _goes_on(rest, k, known, third) if k and joins and (not cuts or k > cuts[-1][1]) else None
        if verb_at:
            cuts.append((k, verb_at))
    ends = zip([0, *(verb_at for _, verb_at in cuts)], [*(k for k, _ in cuts), len(rest)], strict=True)
    return who, tuple(rest[begin:end] for begin, end in ends)


def _goes_on(rest: Words, k: int, known: Known, third: bool) -> int | None:
    """Where a verb in the form of the first one stands after the ``and`` at ``k``; None for nowhere."""
    after = rest[k + 1 :]
    at = next((n for n, word in enumerate(after) if not says_how(word)), len(after) - 1)
    found = begins(after, known, third if rest[k].span.text == "and" else None)
    if found is None and (not third or not phrases.looks_like_a_verb(after[at:], known.is_thing)):
        return None
    at = k + 1 + (at if found is None else found)
    if any(known.is_action(rest[: at + size]) for size in (1, 2) if at + size <= len(rest)):
        return None  # `trips and falls` is one action
    object_before = (
        k > 1
        and rest[k - 2].text not in ("and", COMMA)
        and rest[k - 1].text not in phrases.PARTICLES
        and not says_how(rest[k - 1])
    )
    several = is_third(rest[k - 1])  # `the hats and boxes`
    if (
        object_before
        and at + 1 == len(rest)
        and (several or not third or not is_third(rest[at]))
        and any(map(known.is_thing, (rest[at], *phrases.of_several(rest[at]))))
    ):
        return None  # `the hat and box`
    return at


# --- who acts, and verbs -----------------------------------------------------------------


def subject(said: Words, known: Known) -> int:
    """How many words name who acts at the beginning of some; 0 for nobody."""
    if not said or not (said[0].text in known.named or said[0].text in (*ONE, *BOTH, *ALL)):
        return 0
    if [word.text for word in said[:2]] == ["they", "all"]:
        return 2
    count = 1
    while (
        count + 1 < len(said) and said[count].text in ("and", COMMA) and said[count + 1].text in known.named
    ):
        after = said[count + 2 :]
        if said[count].text == COMMA and after and after[0].text not in ("and", COMMA) and count == 1:
            alone = len(said) > count + 2 and begins(after, known) is not None and not is_third(after[0])
            if not alone:  # `anna, ben and carl` is a list, `anna, ben waves` is none
                break
        count += 2
    return count


def _subjects(said: Words, known: Known) -> tuple[str, ...]:
    return tuple(word.text for word in said[: subject(said, known)] if word.text not in ("and", COMMA))


def _is_prose(said: Words, known: Known) -> bool:
    """Whether the first verb is in the third person."""
    verb = next((word for word in _does(said, subject(said, known)) if not says_how(word)), None)
    return verb is not None and (is_third(verb) or is_not(verb.text))


def _does(said: Words, who: int) -> Words:
    """What follows those who act, but for what is inserted: ``sits down`` of ``anna, annoyed, sits down``."""
    if said[who : who + 1] == () or said[who].text != COMMA:
        return said[who:]
    comma = next((k for k in range(who + 1, len(said)) if said[k].text == COMMA), who)
    return said[comma + 1 :]


def is_ing(word: ast.Name, known: Known) -> bool:
    """Whether a word is a participle of a known verb: ``smiling``, and not ``ring``."""
    forms = plain_forms(word.text) if word.text.endswith("ing") else ()
    return any(len(form) > 2 and known.is_action((ast.Name((form,), word.span),)) for form in forms)


def begins(after: Words, known: Known, third: bool | None = None) -> int | None:
    """After how many words for the manner an action begins; None where none does. third: whether its verb is
    in the third person, or a participle; None for either"""
    at = 0
    while at + 1 < len(after) and (says_how(after[at]) or after[at].text == "then"):
        at += 1
    if not after or after[at].text in ARTICLES or known.is_name(after[at]):
        return None
    if third is not None and third != is_third(after[at]) and not is_ing(after[at], known):
        return None
    rest = (after[at], *(word for word in after[at + 1 :] if word.text not in ARTICLES))
    if {rest[0].text, *plain_forms(rest[0].text)} & {*AUXILIARIES}:
        rest = rest[2:] if rest[1:2] != () and rest[1].text == "to" else rest[1:]
    if [word.text for word in rest[1:2]] == ["on"] and rest[2:] != () and rest[2].text.endswith("ing"):
        rest = rest[2:]  # `goes on crying`
    sizes = range(1, min(_MOST_ACTION_WORDS, len(rest)) + 1)
    apart = any(known.is_action((rest[0], word)) for word in rest[1:4] if word.text in phrases.PARTICLES)
    return at if apart or any(known.is_action(rest[:size]) for size in sizes) else None


def _somebody_acts(after: Words, known: Known) -> int:
    """How many words name who does something by some; 0 where nobody does, or nothing."""
    count = subject(after, known)
    if count:
        does = _does(after, count)
        unknown = bool(does) and is_third(does[0]) and not {*plain_forms(does[0].text)} & {*AUXILIARIES, "ha"}
        named = after[0].text in known.named
        return count if begins(does, known) is not None or (named and unknown and len(does) > 0) else 0
    slip = bool(after) and _is_slip(after[:1], known)
    return 1 if slip and begins(after[1:], known, True) is not None else 0


# --- what stands before who acts ---------------------------------------------------------


def _begun(said: Words, known: Known) -> Sentence | None:
    """``while ben cooks, anna reads``; None for what begins with who acts."""
    if not said or subject(said, known) or said[0].text == COMMA:
        return None
    first = said[0]
    comma = next((k for k, word in enumerate(said) if word.text == COMMA), len(said))
    clause, main = said[1:comma], said[comma + 1 :]
    hows, alone = _how_first(said, known)
    if hows:
        who = subject(alone, known)
        if not who:
            return one_sentence(alone, known) if thing(alone, known, True) is not None else None
        how = tuple(word for word in hows if fold(word.text) in MANNERS)[:1]
        return one_sentence((*alone[:who], *how, *alone[who:]), known)  # `suddenly carl jumps up`
    of_thing = thing(said[:comma], known, True) is not None
    if of_thing and main and (subject(main, known) or thing(main, known, True) is not None):
        of_main = one_sentence(main, known)  # `the phone rings, ben jumps`
        return replace(of_main, parts=(Part(said[:comma]), *of_main.parts))
    if known.is_name(first) or not subject(main, known):
        return None
    of_main = one_sentence(main, known)
    things_do = thing(clause, known, True) is not None
    acts = bool(_somebody_acts(clause, known)) or things_do
    if first.text in ("when", "after", "once", "before", "while", "as") and acts:
        does = one_sentence(clause, known)
        left = (*of_main.left_out, *does.left_out)
        if first.text == "before":
            return Sentence((*of_main.parts, *does.parts), left)
        if first.text not in ("while", "as") or things_do:  # one thing is what the other waits for
            return Sentence((*does.parts, *of_main.parts), left)
        if _is_other(main, clause, known):
            one, *others = of_main.parts
            while_ = (replace(part, meanwhile=True) for part in does.parts)
            return Sentence((one, *while_, *others), left)
    if first.text in (*CLAUSES, "after", "before", "once"):
        return replace(of_main, left_out=(said[:comma], *of_main.left_out))
    if first.text in PREPOSITIONS or is_ing(first, known):  # `on the sofa, ben sleeps`; `smiling, anna nods`
        joint = () if first.text in PREPOSITIONS else (ast.Name(("and",), said[comma].span),)
        one, *others = of_main.parts
        return replace(of_main, parts=(Part((*one.words, *joint, *said[:comma])), *others))
    if begins(clause, known) is None and not _is_slip(
        said[:comma], known
    ):  # `awkward silence, they look away`
        return replace(of_main, left_out=(said[:comma], *of_main.left_out))
    return None


def _how_first(said: Words, known: Known) -> tuple[Words, Words]:
    """The words for how it is done that stand before who does it, ``very slowly and quietly`` without what
    joins and strengthens them, and what follows; () and all of them where there are none."""
    hows: list[ast.Name] = []
    after = 0
    for k, word in enumerate(said):
        if (says_how(word) or fold(word.text) in MANNERS) and word.text not in known.named:
            hows.append(word)
            after = k + 1
        elif word.text not in _STRONGER and not (hows and word.text in (*_JOIN, COMMA)):
            break
    if hows and said[after : after + 1] != () and said[after].text == COMMA:
        after += 1
    return tuple(hows), said[after:]


def _is_slip(said: Words, known: Known) -> bool:
    return any(is_slip(word.text, name) for word in said for name in known.named)


# --- whose something is ------------------------------------------------------------------


def owned(said: Words, known: Known) -> Words:
    """Without possessives: ``kiss anna by hand`` for ``kiss anna's hand``, ``anna tremble`` for ``anna's
    hands tremble``; whose thing it is shows only where somebody has one."""
    out: list[ast.Name] = []
    at = 0
    while at < len(said):
        word, after = said[at], said[at + 1 :]
        acts = all(each.text in (*known.named, "and", COMMA) for each in out)  # who acts is named here
        who = owner(word.text) or (OWNERS.get(word.text, "") if at == 0 else "")
        if not who:
            out.append(word)
            at += 1
            continue
        name = ast.Name((who,), word.span)
        group: Words = ()
        for each in after:
            if each.text in (*PREPOSITIONS, "and", COMMA) and not known.is_name(each):
                break
            group = (*group, each)
            if each.text in BODY:
                break
        of_body = group != () and group[-1].text in BODY
        if acts:
            verb = after[len(group) :][:1]
            forms = {verb[0].text, *plain_forms(verb[0].text)} if verb and of_body else set()
            moves = bool(forms & {*_OF_A_BODY})  # `anna's hands tremble`
            out.append(name if moves else word)
            at += 1 + (len(group) if moves else 0)
        elif of_body:
            out += [name, ast.Name(("by",), word.span), group[-1]]
            at += 1 + len(group)
        elif who in known.named and after and known.is_name(ast.Name((who, after[0].text), word.span)):
            out.append(ast.Name((who, after[0].text), word.span.to(after[0].span)))
            at += 2
        elif who in known.named:
            at += 1
        else:  # `the car's door`
            out.append(name)
            at += 1
    return tuple(out)


# --- commas ------------------------------------------------------------------------------


def _with_and(said: Words, known: Known) -> tuple[Words, tuple[Words, ...]]:
    """With ``and`` for the commas, and before the participles, after which something more is done; and what
    else stands after commas and names nobody and nothing."""
    third = _is_prose(said, known)
    out: list[ast.Name] = []
    left: list[Words] = []
    at = 0
    while at < len(said):
        word = said[at]
        if word.text != COMMA:
            if _is_done_besides(tuple(out), said[at:], known):
                out.append(ast.Name(("and",), word.span))
            out.append(word)
            at += 1
            continue
        at += 1
        while at < len(said) and said[at].text in (COMMA, "and"):
            at += 1
        if not out or at == len(said):
            continue
        begun = out[subject(tuple(out), known) :]
        if begun and len(begun) < len(out) and all(says_how(w) or fold(w.text) in MANNERS for w in begun):
            continue  # `anna, slowly, opens the fridge`
        joins, part = _after_comma(tuple(out), said[at:], known, third)
        if joins:
            out.append(ast.Name(("and",), word.span))
        elif part:
            left.append(part)
            at += len(part)
    return tuple(out), tuple(left)


def _after_comma(before: Words, after: Words, known: Known, third: bool) -> tuple[bool, Words]:
    """Whether an ``and`` belongs where a comma stands; else what after it says nothing."""
    subjects = before[-1].text in known.named and (
        len(before) == 1 or before[-2].text in (*_MEANWHILE, "then")
    )
    does = after[1:] if after[0].text == "then" else after
    other = (
        bool(_somebody_acts(does, known))
        or _is_stranger(does, known)
        or (subjects and bool(subject(does, known)))
    )
    verb = third and phrases.looks_like_a_verb(does, known.is_thing)
    acts = verb or (bool(does) and begins(does, known, third) is not None)
    if before[-1].text == "and" or (subjects and not other):
        if acts:
            return False, ()  # `anna, annoyed, sits down`: it comes after the second
    elif other or acts:
        return True, ()
    end = next((k for k, each in enumerate(after) if each.text == COMMA), len(after))
    part, inserted = after[:end], subjects and end < len(after)
    bare = [word for word in part if word.text not in ARTICLES]
    if len(bare) == 1 and (fold(bare[0].text) in MANNERS or known.is_name(bare[0])):
        return False, ()  # `walk, counter`; `, nervously, `
    feels = part[-1].text.endswith(("ed", "ing")) or says_how(part[-1])  # `, puzzled`
    return False, () if len(bare) == 1 and not feels and not inserted else part


def _is_done_besides(before: Words, after: Words, known: Known) -> bool:
    """Whether something more is done from here on, as in ``sits by the window reading a book``."""
    word, last = after[0], before[-1].text if before else ""
    who = subject(before, known)
    if any(is_not(each.text) for each in before[who : who + 3]):
        return False  # `is not sitting`
    if len(before) < who + 2 or not is_ing(word, known) or known.is_name(word):
        return False
    aux = {last, *plain_forms(last)} & {*AUXILIARIES, "go", "come", "stop"}
    belongs = (*ARTICLES, *PREPOSITIONS, *CLAUSES, "and", COMMA)  # `the blinking light`
    if aux or last in belongs or any(each.text == "with" for each in before) or _is_of_another(before, known):
        return False
    whole = (known.is_action((*before[at:], word)) for at in range(who, len(before)))
    return begins(after, known) == 0 and not any(whole)


def _is_of_another(before: Words, known: Known) -> bool:
    """Whether what is done after some words is done by whom or by what they end in: ``watches ben …``."""
    verb = before[subject(before, known)]
    perceives = {verb.text, *plain_forms(verb.text)} & _PERCEIVES
    return before[-1].text in (*known.named, "him", "them", "her") or bool(perceives)


# --- clauses -----------------------------------------------------------------------------


def _parts(said: Words, known: Known) -> tuple[tuple[Part, ...], tuple[Words, ...]]:
    """Who does what, one part for all that the same people do one after the other; and the clauses of which
    nothing shows."""
    left: list[Words] = []
    who, third = subject(said, known), _is_prose(said, known)
    k = who + 1
    while k < len(said):
        word, after = said[k], said[k + 1 :]
        whole = any(known.is_action(said[at : k + 1]) for at in range(max(who, k - 3), k))
        if known.is_name(word) or whole:
            k += 1
            continue
        does = after[1:] if after[:1] != () and after[0].text == "then" else after
        links = word.text in (*_MEANWHILE, *LATER, "when")
        if links and (_is_stranger(does, known) or thing(does, known, True) is not None):
            others, more = _parts(does, known)
            return (Part(said[:k]), *others), (*left, *more)
        if word.text in (*_MEANWHILE, *LATER) and _somebody_acts(does, known):
            joint = "then" if does is not after else word.text
            meanwhile = joint in _MEANWHILE and _is_other(said, does, known)
            if joint == "and" and _is_done_to(said[:k], does, known):
                meanwhile = False  # `gives the cup to ben and he drinks`
            if meanwhile or joint in LATER:
                others, more = _parts(does, known)
                first = replace(others[0], meanwhile=meanwhile)
                return (Part(said[:k]), first, *others[1:]), (*left, *more)
        if word.text == "before" and after and is_ing(after[0], known):
            said = (*said[:k], ast.Name(("and",), word.span), *after)
            continue
        after_ing = word.text == "after" and bool(after) and is_ing(after[0], known)
        thought = word.text == "that" and bool(subject(after, known))  # `the letter that she wrote`
        purpose = word.text == "to" and _is_purpose(said, k, known)
        if word.text in CLAUSES or after_ing or thought or purpose or _is_let(said, k, known, third):
            end = _clause_end(said, k, known, third)
            left.append(said[k:end])
            said = (*said[:k], *said[end:])
            continue
        k += 1
    return (Part(said),), tuple(left)


def _is_stranger(does: Words, known: Known) -> bool:
    """Whether somebody acts who is not of the story: ``the waiter leaves``."""
    third = len(does) > 2 and (is_third(does[2]) or is_third(does[-1]))
    return third and does[0].text in ARTICLES and known.is_person(does[1].text)


def _clause_end(said: Words, begin: int, known: Known, third: bool) -> int:
    """Where a clause ends: before the next ``and`` or ``then`` after which something is done."""
    for k in range(begin + 1, len(said) - 1):
        if said[k].text not in LATER:
            continue
        does = said[k + 2 :] if said[k + 1].text == "then" else said[k + 1 :]
        if does and (_somebody_acts(does, known) or begins(does, known, third) is not None):
            return k
    return len(said)


def _is_other(said: Words, after: Words, known: Known) -> bool:
    """Whether somebody else than who acts is at the beginning of some words, so that both act at once."""
    acting, others = _subjects(said, known), _subjects(after, known)
    if not others or not acting:
        return True  # a slip of the finger, which is told
    if any(who in (*BOTH, *ALL, "they all") for who in (*acting, *others)):
        return False
    if others[0] in ONE or acting[0] in ONE:
        pronoun, who = (others[0], acting[0]) if others[0] in ONE else (acting[0], others[0])
        return pronoun != who if who in ONE else not known.may_be(pronoun, who)
    return not set(acting) & set(others)


def _is_done_to(before: Words, after: Words, known: Known) -> bool:
    """Whether somebody acts to whom something has just been done."""
    named = [word.text for word in before[subject(before, known) :] if word.text in known.named]
    others = _subjects(after, known)
    return any(who in named or (who in ONE and known.may_be(who, name)) for who in others for name in named)


def _is_let(said: Words, at: int, known: Known, third: bool) -> bool:
    """Whether what somebody else does begins at a place: ``helps ben sit down``, ``watches ben cooking``."""
    word = said[at]
    joined = said[at - 1].text in (*LATER, COMMA)
    if at < subject(said, known) + 2 or not _is_of_another(said[:at], known) or not third or joined:
        return False
    if is_ing(word, known):
        return begins(said[at:], known) == 0
    whom = said[at - 1].text in (*known.named, "him", "them")
    if not whom or is_third(word) or word.text in PREPOSITIONS or says_how(word):
        return False
    return begins(said[at:], known) == 0


def _is_purpose(said: Words, at: int, known: Known) -> bool:
    """Whether ``to`` at a place says what something is done for, as in ``stops to catch his breath``."""
    after = said[at + 1 :]
    if not after or is_third(after[0]) or begins(after, known) != 0:
        return False
    joint = tuple(word.text for word in after[:2])
    if len(joint) == 2 and any(
        known.is_name(ast.Name((mark.join(joint),), after[0].span)) for mark in ("_", "-")
    ):
        return False  # `to the dance floor`
    begin = max((k + 1 for k in range(at) if said[k].text in LATER), default=subject(said, known))
    done, last = said[begin:at], said[at - 1].text
    if phrases.about_to(done, known.is_action, known.is_name) or phrases.about_to(
        said[begin:], known.is_action, known.is_name
    ):
        return False
    return not {last, *plain_forms(last)} & {*AUXILIARIES} and any(
        known.is_action(done[:size]) for size in range(1, len(done) + 1)
    )
