"""Sentences in the words of one beat: ``while ben cooks``, ``, smiling``, ``carl's hand``.

Assumes the words of one beat as they are written, commas among them. Guarantees words without commas and
possessives, and that whatever is left out of them is told.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from . import ast, phrases
from .phrases import AUXILIARIES, BODY, GIVING, Known, Words, says_how
from .pronouns import ALL, BOTH, ONE
from .words import ARTICLES, PREPOSITIONS, plain_forms

#: What they begin does not show: why, when, or what somebody thinks of it.
_CLAUSES = (
    "as", "because", "but", "if", "like", "since", "so", "than", "that", "till", "unless", "until", "when",
    "where", "which", "while", "who", "without",
)  # fmt: skip
#: What comes after them and somebody's name is done at the same time, or then.
_BESIDES = ("while", "as", "and", "then")
#: Whose something is, before it, and who that is.
OWNERS = {"his": "he", "her": "she"}
COMMA = ","
_MOST_ACTION_WORDS = 3


@dataclass(frozen=True)
class Sentence:
    """What a beat says.

    words: who does what; besides: what somebody else does, or (); later: whether they do it after that and
    not at the same time; left_out: what says nothing
    """

    words: Words
    besides: Words = ()
    later: bool = False
    left_out: tuple[Words, ...] = ()


def sentence(said: Words, known: Known) -> Sentence:
    """The words of a beat as they are written, taken apart."""
    begun = _begun_by_clause(said, known)
    if begun is not None:
        return begun
    said, left = _with_and(_owned(said, known), known)
    said, besides, clause = _without_clause(said, known)
    later = besides[:1] != () and besides[0].text == "then"
    left_out = tuple(part for part in (clause, *left) if part)
    return Sentence(said, besides[1:] if later else besides, later, left_out)


def _begun_by_clause(said: Words, known: Known) -> Sentence | None:
    """``while ben cooks, anna reads``; None for what begins with who acts."""
    first, *_ = said
    says_where = (
        says_how(first) or first.text in PREPOSITIONS
    )  # `on the other side of the street, carl waits`
    comma = next((k for k, word in enumerate(said) if word.text == COMMA), len(said))
    clause, main = said[1:comma], said[comma + 1 :]
    if (
        says_how(first)
        and len(said) > 2
        and not main
        and (said[1].text in known.named or said[1].text in ONE)
    ):
        return sentence(said[1:], known)  # `suddenly carl jumps up`
    if not (says_where or first.text in (*_CLAUSES, "after", "before")) or known.is_name(first) or not main:
        return None
    of_main = sentence(main, known)
    if first.text in ("while", "as", "when") and _acts_besides(main, clause, known) and not of_main.besides:
        does = sentence(clause, known).words
        if first.text == "when":  # one thing is what the other waits for
            return Sentence(does, of_main.words, True, of_main.left_out)
        return Sentence(of_main.words, does, False, of_main.left_out)
    return replace(of_main, left_out=((first, *clause), *of_main.left_out))


def owner(word: str) -> str:
    """Whose something is by a word as ``carl's``; "" for another word."""
    return word[:-2] if word.endswith(("'s", "’s")) else ""


def _owned(said: Words, known: Known) -> Words:
    """Without possessives: ``kiss anna by hand`` for ``kiss anna's hand``, ``anna tremble`` for ``anna's
    hands tremble``; whose thing it is shows only where somebody has one."""
    out: list[ast.Name] = []
    at = 0
    while at < len(said):
        word, after = said[at], said[at + 1 :]
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
        if at == 0:  # `anna's hands tremble`
            out.append(name if of_body or owner(word.text) else word)
            at += 1 + (len(group) if of_body else 0)
        elif who in known.named and of_body:
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


def _with_and(said: Words, known: Known) -> tuple[Words, tuple[Words, ...]]:
    """With ``and`` for the commas, and before the participles, after which something more is done; and what
    else stands after commas and names nobody and nothing."""
    out: list[ast.Name] = []
    left: list[Words] = []
    at = 0
    while at < len(said):
        word = said[at]
        if word.text != COMMA:
            if _is_participle(tuple(out), said[at:], known):
                out.append(ast.Name(("and",), word.span))
            out.append(word)
            at += 1
            continue
        at += 1
        while at < len(said) and said[at].text in (COMMA, "and"):
            at += 1
        if not out or at == len(said):
            continue
        joins, part = _after_comma(tuple(out), said[at:], known)
        if joins:
            out.append(ast.Name(("and",), word.span))
        elif part:
            left.append(part)
            at += len(part)
    return tuple(out), tuple(left)


def _after_comma(before: Words, after: Words, known: Known) -> tuple[bool, Words]:
    """Whether an ``and`` belongs where a comma stands; else what after it says nothing."""
    subjects = before[-1].text in known.named and (len(before) == 1 or before[-2].text in _BESIDES)
    who, *does = after[1:] if after[0].text == "then" else after
    other = who.text in known.named or who.text in ONE
    acts = _begins(tuple(does) if other else after, known) is not None
    if before[-1].text == "and" or (subjects and not other):
        if acts:
            return False, ()  # `anna, annoyed, sits down`: it comes after the second
    elif other or acts:
        return True, ()
    end = next((k for k, each in enumerate(after) if each.text == COMMA), len(after))
    part, inserted = after[:end], subjects and end < len(after)
    feels = part[-1].text.endswith(("ed", "ing")) or says_how(part[-1])  # `, puzzled`
    names = (len(part) == 1 and not feels) or any(known.is_name(each) for each in part)  # `walk, counter`
    return False, part if inserted or not names else ()


def _is_participle(before: Words, after: Words, known: Known) -> bool:
    """Whether something more is done from here on, as in ``sits by the window reading a book``."""
    word, last = after[0].text, before[-1].text if before else ""
    if len(before) < 3 or not word.endswith("ing") or known.is_name(after[0]):
        return False
    no_verb = not any(known.is_action((each,)) for each in before[1:-1])
    aux = {last, *plain_forms(last)} & {*AUXILIARIES, "go", "come", "stop"}
    belongs = (*ARTICLES, *PREPOSITIONS, *_CLAUSES, "and", COMMA)  # `the blinking light`
    if no_verb or aux or last in belongs or any(each.text == "with" for each in before):
        return False
    return _begins(after, known) == 0 and not any(
        known.is_action((*before[at:], *after[:1])) for at in range(1, len(before))
    )


def _begins(after: Words, known: Known) -> int | None:
    """After how many words for the manner an action begins; None where none does."""
    at = 0
    while at + 1 < len(after) and (says_how(after[at]) or after[at].text == "then"):
        at += 1
    if not after or known.is_name(after[at]):
        return None
    rest = tuple(word for word in after[at:] if word.text not in ARTICLES) or after[at:]
    if {rest[0].text, *plain_forms(rest[0].text)} & {*AUXILIARIES}:
        rest = rest[2:] if rest[1:2] != () and rest[1].text == "to" else rest[1:]
    sizes = range(1, min(_MOST_ACTION_WORDS, len(rest)) + 1)
    return at if any(known.is_action(rest[:size]) for size in sizes) else None


def _without_clause(said: Words, known: Known) -> tuple[Words, Words, Words]:
    """Who does what; what somebody else does, after a ``then`` if they do it later; and the words of a clause
    of which nothing shows."""
    for k in range(2, len(said)):
        word, after = said[k], said[k + 1 :]
        verb = next((at for at in range(1, k) if known.is_action(said[at : at + 1])), k)
        if known.is_name(word) or any(known.is_action(said[at : k + 1]) for at in range(1, k)):
            continue
        if word.text in ("and", "then") and verb < k and _all_then(after, known):
            return said[:k], (ast.Name(("then",), word.span), *after), ()
        if verb + 1 < k and _is_let(said, k, known):
            return said[:k], (), said[k:]
        if word.text in _BESIDES and (verb < k or k > 3) and _acts_besides(said, after, known):
            plural = (
                said[0].text in (*BOTH, *ALL) and word.text == "and"
            )  # who does both, one after the other
            then = ast.Name(("then",), word.span)
            return said[:k], (then, *after) if plural or word.text == "then" else after, ()
        if word.text == "before" and after and after[0].text.endswith("ing") and _begins(after, known) == 0:
            return (*said[:k], ast.Name(("and",), word.span), *after), (), ()
        if word.text in _CLAUSES or (word.text == "to" and _is_purpose(said, k, known)):
            return said[:k], (), said[k:]
    return said, (), ()


def _all_then(after: Words, known: Known) -> bool:
    """Whether words say what ``they`` do next."""
    return len(after) > 1 and after[0].text in BOTH and _begins(after[1:], known) is not None


def _is_let(said: Words, at: int, known: Known) -> bool:
    """Whether what somebody does begins at a place whom something is done to: ``helps ben sit down``."""
    word, before = said[at], said[at - 1].text
    whom = before in known.named or before in ("him", "them")
    verbs = any({each.text, *plain_forms(each.text)} & {*GIVING} for each in said[1:at])
    if at < 3 or not whom or verbs or word.text.endswith("s") or word.text in PREPOSITIONS:
        return False
    return not says_how(word) and _begins(said[at:], known) == 0


def _acts_besides(said: Words, after: Words, known: Known) -> bool:
    """Whether somebody else than who acts does something by the words after ``while``."""
    after = after[1:] if after[:1] != () and after[0].text == "then" else after
    if len(after) < 2:
        return False
    who = after[0].text
    if who in known.named:
        other = all(word.text != who for word in said[:1])
    else:
        other = who in ONE and said[0].text in known.named and not known.may_be(who, said[0].text)
    return other and _begins(after[1:], known) is not None


def _is_purpose(said: Words, at: int, known: Known) -> bool:
    """Whether ``to`` at a place says what something is done for, as in ``stops to catch his breath``."""
    after = said[at + 1 :]
    if not after or after[0].text.endswith("s") or _begins(after, known) != 0:
        return False
    joint = tuple(word.text for word in after[:2])
    if len(joint) == 2 and any(
        known.is_name(ast.Name((mark.join(joint),), after[0].span)) for mark in ("_", "-")
    ):
        return False  # `to the dance floor`
    done, last = said[1:at], said[at - 1].text
    if phrases.about_to(said[1:], known.is_action, known.is_name):
        return False
    return not {last, *plain_forms(last)} & {*AUXILIARIES} and any(
        known.is_action(done[:size]) for size in range(1, len(done) + 1)
    )
