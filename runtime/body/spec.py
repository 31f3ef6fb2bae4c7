"""What a person looks like, in numbers and words: the only input of :mod:`runtime.body`.

A :class:`BodySpec` is complete and checked: every builder may rely on its words being known.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

#: Age words and the years they stand for.
AGES: dict[str, float] = {"child": 8.0, "teen": 15.0, "adult": 32.0, "middle-aged": 50.0, "elder": 72.0}
#: Build words and their place between thin (0) and heavy (1).
BUILDS: dict[str, float] = {
    "thin": 0.1,
    "slim": 0.25,
    "average": 0.42,
    "athletic": 0.5,
    "stocky": 0.7,
    "heavy": 0.95,
}
HAIR_STYLES = ("bob", "short", "crop", "long", "ponytail", "bun", "curly", "afro", "bald", "tonsure")
FACIAL_HAIR = ("none", "moustache", "beard", "stubble")
TOP_KINDS = ("tshirt", "shirt", "sweater", "blazer", "coat", "dress")
BOTTOM_KINDS = ("trousers", "skirt", "shorts")

Colour = tuple[float, float, float]

_WORDS = {
    "hair": HAIR_STYLES,
    "facial_hair": FACIAL_HAIR,
    "top": TOP_KINDS,
    "bottom": BOTTOM_KINDS,
}


@dataclass(frozen=True)
class BodySpec:
    """One person.

    height: metres, standing, to the crown; build: 0 thin .. 1 heavy; femininity: 0 .. 1; age: years
    colours: sRGB 0..1 triples; ``hair``, ``facial_hair``, ``top`` and ``bottom``: words of the tuples above
    shirt_color: what shows under an open blazer or coat
    """

    height: float = 1.72
    build: float = 0.42
    femininity: float = 0.5
    age: float = 32.0
    skin: Colour = (0.89, 0.70, 0.57)
    eye_color: Colour = (0.33, 0.22, 0.13)
    hair: str = "short"
    hair_color: Colour = (0.24, 0.15, 0.10)
    facial_hair: str = "none"
    glasses: bool = False
    top: str = "tshirt"
    top_color: Colour = (0.74, 0.13, 0.17)
    shirt_color: Colour = (0.93, 0.92, 0.88)
    bottom: str = "trousers"
    bottom_color: Colour = (0.17, 0.22, 0.38)
    shoes_color: Colour = (0.14, 0.13, 0.14)

    def __post_init__(self) -> None:
        for name, low, high in (
            ("height", 0.7, 2.4),
            ("build", 0.0, 1.0),
            ("femininity", 0.0, 1.0),
            ("age", 3.0, 110.0),
        ):
            if not low <= getattr(self, name) <= high:
                raise ValueError(f"BodySpec.{name}: {getattr(self, name)!r} is not in {low}..{high}")
        for name, words in _WORDS.items():
            if getattr(self, name) not in words:
                raise ValueError(f"BodySpec.{name}: {getattr(self, name)!r} is none of {', '.join(words)}")

    @property
    def youth(self) -> float:
        """1 for a small child, 0 from eighteen on."""
        return _smooth((18.0 - self.age) / 11.0)

    @property
    def eld(self) -> float:
        """0 up to fifty, 1 from seventy-five on."""
        return _smooth((self.age - 50.0) / 25.0)

    def key(self) -> str:
        """A text that is equal exactly where two specs build the same body."""
        return ";".join(f"{f.name}={getattr(self, f.name)!r}" for f in fields(self))


def _smooth(x: float) -> float:
    x = min(max(x, 0.0), 1.0)
    return x * x * (3.0 - 2.0 * x)
