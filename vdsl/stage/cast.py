"""Dresses the cast: from a cast definition and its arguments to the body the engine builds."""

from __future__ import annotations

from collections.abc import Mapping

from runtime.body.spec import AGES, BUILDS, BodySpec, Colour
from vdsl.lang.definitions.cast import DEFAULTS, CastDef
from vdsl.lang.definitions.looks import BODIES, NUMBERS, colour_of


def body_spec(cast: CastDef, arguments: Mapping[str, float | str] | None = None) -> BodySpec:
    """The body of one person. Arguments are taken as checked; a number out of bounds is brought within."""
    look = cast.features(dict(arguments or {}))

    def word(name: str) -> str:
        return str(look[name])

    def tint(name: str) -> Colour:
        return _colour(word(name), name)

    return BodySpec(
        height=_number("height", look["height"], {}),
        build=_number("build", look["build"], BUILDS),
        femininity=_number("body", look["body"], BODIES),
        age=_number("age", look["age"], AGES),
        skin=tint("skin"),
        eye_color=tint("eyes"),
        hair=word("hair"),
        hair_color=tint("hair-color"),
        facial_hair=word("facial-hair"),
        glasses=word("glasses") == "yes",
        top=word("top-kind"),
        top_color=tint("top"),
        shirt_color=tint("shirt"),
        bottom=word("bottom-kind"),
        bottom_color=tint("bottom"),
        shoes=word("shoes-kind"),
        shoes_color=tint("shoes"),
        hat=word("hat"),
        hat_color=tint("hat-color"),
        neck=word("neck"),
        over=word("over"),
        back=word("back"),
        belt=word("belt") == "yes",
        gloves=word("gloves") == "yes",
        badge=word("badge") == "yes",
        accent_color=tint("accent"),
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
