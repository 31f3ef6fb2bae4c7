"""Which guides are drawn over a picture, as words: ``safe,thirds,cross,2.39``.

Assumes nothing of the text. Guarantees a frozen value or a ValueError that says what was meant to be written.
No picture is touched here, so that the command line can read its options before anything heavy is loaded.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

WORDS = ("safe", "thirds", "cross")
_ASPECT = re.compile(r"(\d{1,5}(?:\.\d{1,4})?)(?:[:/x](\d{1,5}(?:\.\d{1,4})?))?")
#: Aspects a mask may have: from an upright telephone to the widest of cinemas.
NARROWEST, WIDEST = 0.4, 4.0


@dataclass(frozen=True)
class Guides:
    """What is drawn over every picture.

    safe: action and title safe areas; thirds: lines at the thirds; cross: a cross in the middle
    mask: width over height of the picture meant, the rest is darkened; None for all of it
    """

    safe: bool = False
    thirds: bool = False
    cross: bool = False
    mask: float | None = None

    def __bool__(self) -> bool:
        return self.safe or self.thirds or self.cross or self.mask is not None


#: Nothing is drawn.
NO_GUIDES = Guides()


def guides_of(text: str) -> Guides:
    """Guides from words between commas: ``safe``, ``thirds``, ``cross``, an aspect (``2.39``, ``16:9``)."""
    named: set[str] = set()
    mask: float | None = None
    for word in filter(None, (w.strip().lower() for w in text.split(","))):
        if word in WORDS:
            named.add(word)
        elif mask is None:
            mask = _aspect(word)
        else:
            raise ValueError(f"{word!r} is a second aspect; one picture has one")
    return Guides("safe" in named, "thirds" in named, "cross" in named, mask)


def _aspect(word: str) -> float:
    found = _ASPECT.fullmatch(word)
    if found is None:
        raise ValueError(f"{word!r} is no guide; write safe, thirds, cross or an aspect such as 2.39 or 16:9")
    width, height = float(found[1]), float(found[2] or 1.0)
    if not (height > 0 and NARROWEST <= width / height <= WIDEST):
        raise ValueError(f"{word!r}: an aspect is between {NARROWEST:g} and {WIDEST:g}")
    return width / height
