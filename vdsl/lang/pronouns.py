"""Who is meant by ``she``, ``him``, ``they`` and ``each other``: who acted or was spoken of last in a scene.

Assumes lines in the order they are written in. Guarantees that what a word means hangs on the lines before it
in its scene alone, and that a word that may mean nobody means nobody.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

_BODIES = {
    "he": "masculine", "him": "masculine", "his": "masculine",
    "she": "feminine", "her": "feminine",
}  # fmt: skip
#: Who acts may be said so, where somebody acted or was spoken of before.
ONE = ("he", "she")
#: Whose something is, before it, and who that is.
OWNERS = {"his": "he", "her": "she"}
#: Two who are about, or acted or were spoken of last: they do it both, or to each other.
BOTH = ("they", "both")
#: All who are about.
ALL = ("everybody", "everyone", "all", "they all")

#: Words for people that are no name in a story.
_PEOPLE = frozenset(
    """
    actor actress artist assistant aunt babies baby baker banker barber bartender boss bouncer boy boys
    brother burglar bus-driver butcher butler captain cashier chef chief child children clerk client
    coach colleague cook cop couple cowboy criminal crowd customer dad dancer daughter dentist detective
    director doctor driver drummer enemy family fan farmer father fighter firefighter fireman fisherman
    friend gang gardener girl girls granddad grandfather grandma grandmother grandpa guard guest
    guitarist guy guys hero host hostess hunter husband inspector intruder janitor journalist judge kid
    kids king knight lady lawyer leader lover magician maid manager mayor mechanic men minister mom
    mother mum murderer musician neighbor neighbour nurse officer orchestra others owner painter partner
    passenger patient people person pianist pilot player plumber poet police policeman policewoman
    postman prince princess principal prisoner professor queen reporter robber sailor salesman scientist
    secretary sergeant sheriff singer sister soldier son spy stranger student students surgeon suspect
    teacher team teen teenager thief thieves trainer twin twins uncle victim villain visitor waiter
    waitress warrior wife witch witness wizard woman women worker writer youth
    """.split()  # noqa: SIM905 (a list of two hundred quoted words reads worse)
)
_ENDS = ("man", "woman", "men", "women")


def owner(word: str) -> str:
    """Whose something is by a word as ``carl's``; "" for another word."""
    return word[:-2] if word.casefold().endswith(("'s", "’s")) else ""


def is_person(word: str) -> bool:
    """Whether a word is one for people: ``waiter``, ``doctors``, ``fisherman``."""
    return word in _PEOPLE or word.removesuffix("s") in _PEOPLE or word.endswith(_ENDS)


@dataclass
class Mentions:
    """People as they are spoken of in a scene.

    about: who is in the scene; bodies: feminine or masculine, where that is known; partner: with whom who
    acts does it, where two are named; who: who acts in the line that is read; acting: all who do
    group: who acted together in the last line, if they were several
    """

    about: tuple[str, ...] = ()
    bodies: Mapping[str, str] = field(default_factory=dict)
    partner: str = ""
    who: str | None = None
    acting: tuple[str, ...] = ()
    group: tuple[str, ...] = ()
    _acted: tuple[str, ...] = ()  # who acted last first
    _spoken_of: tuple[str, ...] = ()  # who was spoken of last first, who acts after all others of a line

    def read(self, acting: str | None, named: Sequence[str]) -> None:
        """Take note of a line's people; named: in their order."""
        now = [name for name in reversed(named) if name != acting] + ([acting] if acting else [])
        self._spoken_of = tuple(dict.fromkeys((*now, *self._spoken_of)))
        if acting:
            self._acted = tuple(dict.fromkeys((acting, *self._acted)))

    def who_acts(self, pronoun: str) -> str:
        """Who acts by ``he`` or ``she``: who acted last of those it may mean, else who was spoken of last,
        else the only one it may mean; "" for nobody."""
        may = [name for name in self.about if self.may(pronoun, name)]
        last = next((name for name in (*self._acted, *self._spoken_of) if name in may), "")
        return last or (may[0] if len(may) == 1 else "")

    def last(self) -> str:
        """Who acted or was spoken of last, else the first one about; "" for nobody."""
        return next(
            (name for name in (*self._acted, *self._spoken_of, *self.about) if name in self.about), ""
        )

    def two(self) -> tuple[str, ...]:
        """Who ``they`` are: the two who are about, or of more those who acted together or were spoken of
        last."""
        if len(self.about) == 2:
            return self.about
        if len(self.group) == 2:
            return self.group
        last = self._spoken_of[:2]
        return tuple(name for name in self.about if name in last) if len(last) == 2 else ()

    def meant(self, pronoun: str = "") -> str:
        """Whom ``him`` means: of those whom it may mean the only one who is about besides who acts, or who
        was spoken of last; "" for nobody. Without a word the one with whom something is done."""
        if self.partner and not pronoun:
            return self.partner
        others = [name for name in self.about if name != self.who and name not in self.acting]
        may = [name for name in others if self.may(pronoun, name)]
        last = next((name for name in self._spoken_of if name in may), "")
        return may[0] if len(may) == 1 else last

    def other(self) -> str:
        """With whom it is done, else the only one who is about besides who acts; "" where there is none."""
        if self.partner:
            return self.partner
        others = [name for name in self.about if name != self.who]
        return others[0] if len(others) == 1 else ""

    def may_be_own(self, pronoun: str) -> bool:
        """Whether a word may mean who acts."""
        return pronoun in _BODIES and self.who is not None and self.may(pronoun, self.who)

    def may(self, pronoun: str, name: str) -> bool:
        """Whether a word may mean somebody."""
        body = _BODIES.get(pronoun, "")
        return not body or self.bodies.get(name, body) == body
