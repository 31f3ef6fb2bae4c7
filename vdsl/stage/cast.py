"""Dresses the cast: from a cast definition and its arguments to the body the engine builds."""

from __future__ import annotations

from collections.abc import Mapping

from runtime.body.spec import AGES, BUILDS, BodySpec, Colour
from vdsl.lang.definitions.cast import DEFAULTS, CastDef
from vdsl.lang.definitions.looks import BODIES, NUMBERS, colour_of

_COLOURS = {
    "skin": "skin",
    "eyes": "eye_color",
    "hair-color": "hair_color",
    "top": "top_color",
    "shirt": "shirt_color",
    "bottom": "bottom_color",
    "shoes": "shoes_color",
    "hat-color": "hat_color",
    "accent": "accent_color",
}
_WORDS = {
    "hair": "hair",
    "facial-hair": "facial_hair",
    "top-kind": "top",
    "bottom-kind": "bottom",
    "shoes-kind": "shoes",
    "hat": "hat",
    "neck": "neck",
    "over": "over",
    "back": "back",
}
_SWITCHES = ("glasses", "belt", "gloves", "badge")


def body_spec(cast: CastDef, arguments: Mapping[str, float | str] | None = None) -> BodySpec:
    """The body of one person. Arguments are taken as checked; a number out of bounds is brought within."""
    look = cast.features(dict(arguments or {}))
    colours = {field: _colour(str(look[name]), name) for name, field in _COLOURS.items()}
    words = {field: str(look[name]) for name, field in _WORDS.items()}
    switches = {name: look[name] == "yes" for name in _SWITCHES}
    return BodySpec(
        height=_number("height", look["height"], {}),
        build=_number("build", look["build"], BUILDS),
        femininity=_number("body", look["body"], BODIES),
        age=_number("age", look["age"], AGES),
        **words,
        **switches,
        **colours,
    )


def _number(feature: str, value: float | str, words: Mapping[str, float]) -> float:
    number = words[value] if isinstance(value, str) else float(value)
    low, high = NUMBERS[feature]
    return min(max(number, low), high)


def _colour(word: str, feature: str) -> Colour:
    found = colour_of(word, feature)
    if found is None:  # checked before; a caller of its own may still pass anything
        found = colour_of(str(DEFAULTS[feature]), feature)
    assert found is not None
    return found
