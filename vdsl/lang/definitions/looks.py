"""The words for how people look: which there are for each feature, and the colours they stand for.

Clothes take any of :mod:`vdsl.lang.definitions.colours`; skin, hair and eyes have names of their own
on top of those. A colour text such as ``"#c33a2b"`` does everywhere.
"""

from __future__ import annotations

from runtime.body.spec import (
    AGES,
    BACKWEAR,
    BOTTOM_KINDS,
    BUILDS,
    FACIAL_HAIR,
    HAIR_STYLES,
    HATS,
    NECKWEAR,
    OVERWEAR,
    SHOE_KINDS,
    TOP_KINDS,
)

from .colours import COLOURS, Colour, colour

SKINS = {
    "pale": "#f3d9c8", "fair": "#efcdb6", "light": "#e8bf9f", "medium": "#d3a27c", "olive": "#c39a70",
    "tan": "#bb8559", "brown": "#96633f", "dark": "#6f4630", "deep": "#523326",
}  # fmt: skip
HAIRS = {
    "black": "#2a2422", "dark": "#3a2b23", "brown": "#5a3b28", "chestnut": "#74452c", "auburn": "#843f27",
    "red": "#a64a26", "ginger": "#c0672f", "blond": "#d8b26c", "blonde": "#d8b26c", "sandy": "#b58f5c",
    "grey": "#9a9894", "gray": "#9a9894", "silver": "#c2c1be", "white": "#e6e3dc",
}  # fmt: skip
EYES = {
    "brown": "#5b3a22", "dark": "#33231a", "hazel": "#7d6234", "green": "#4f7a4c", "blue": "#3f78b0",
    "grey": "#6f8592", "gray": "#6f8592", "amber": "#9a6a28",
}  # fmt: skip
BODIES = {"feminine": 1.0, "masculine": 0.0, "neutral": 0.5}


class ColourWords(tuple[str, ...]):
    """The words of a kind of colour; anything :func:`colour_of` reads counts as one of them."""

    __slots__ = ()

    def __contains__(self, word: object) -> bool:
        return isinstance(word, str) and (tuple.__contains__(self, word) or colour(word) is not None)


SKIN_WORDS = ColourWords(SKINS)
HAIR_WORDS = ColourWords(HAIRS)
EYE_WORDS = ColourWords(EYES)
CLOTH_WORDS = ColourWords(COLOURS)
YES_NO = ("yes", "no")

#: What can be said of a person: a feature's words, None for what is a number only.
FEATURES: dict[str, tuple[str, ...] | None] = {
    "height": None,
    "build": tuple(BUILDS),
    "body": tuple(BODIES),
    "age": tuple(AGES),
    "skin": SKIN_WORDS,
    "eyes": EYE_WORDS,
    "hair": HAIR_STYLES,
    "hair-color": HAIR_WORDS,
    "facial-hair": FACIAL_HAIR,
    "glasses": YES_NO,
    "top": CLOTH_WORDS,
    "top-kind": TOP_KINDS,
    "shirt": CLOTH_WORDS,
    "bottom": CLOTH_WORDS,
    "bottom-kind": BOTTOM_KINDS,
    "shoes": CLOTH_WORDS,
    "shoes-kind": SHOE_KINDS,
    "hat": HATS,
    "hat-color": CLOTH_WORDS,
    "neck": NECKWEAR,
    "over": OVERWEAR,
    "back": BACKWEAR,
    "belt": YES_NO,
    "gloves": YES_NO,
    "badge": YES_NO,
    "accent": CLOTH_WORDS,
}
#: Features that may also be a number, with the numbers allowed.
NUMBERS: dict[str, tuple[float, float]] = {
    "height": (0.7, 2.4),
    "build": (0.0, 1.0),
    "body": (0.0, 1.0),
    "age": (3.0, 110.0),
}


def colour_of(word: str, feature: str) -> Colour | None:
    """sRGB 0..1 of a colour word as it is meant for a feature; None for a word that is none."""
    own = {"skin": SKINS, "hair-color": HAIRS, "eyes": EYES}.get(feature, {})
    return colour(own.get(word.casefold(), word))
