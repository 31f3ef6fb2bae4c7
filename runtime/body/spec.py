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
HAIR_STYLES = (
    "bob", "short", "crop", "long", "ponytail", "bun", "curly", "afro", "bald", "tonsure",
    "pixie", "wavy", "braids", "locs", "mohawk", "topknot",
)  # fmt: skip
FACIAL_HAIR = ("none", "moustache", "beard", "stubble", "goatee", "long-beard")
TOP_KINDS = (
    "tshirt", "shirt", "sweater", "blazer", "coat", "dress", "tank", "hoodie", "suit", "jacket", "uniform",
    "lab-coat", "chef-jacket", "scrubs", "tunic", "robe", "gown", "kimono", "armour", "spacesuit",
)  # fmt: skip
BOTTOM_KINDS = ("trousers", "skirt", "shorts", "long-skirt", "pencil-skirt", "overalls")
SHOE_KINDS = ("shoes", "boots")
HATS = (
    "none", "cap", "police-cap", "beanie", "beret", "brimmed-hat", "straw-hat", "toque", "hard-hat",
    "fire-helmet", "helmet", "crown", "tiara", "tricorn", "wizard-hat", "nurse-cap", "scrub-cap", "hood",
    "veil", "knight-helmet", "space-helmet",
)  # fmt: skip
#: Worn around the neck, over the clothes, on the back.
NECKWEAR = ("none", "tie", "bow-tie", "scarf", "stethoscope")
OVERWEAR = ("none", "apron", "vest", "waistcoat")
BACKWEAR = ("none", "backpack", "cape")

Colour = tuple[float, float, float]

_WORDS = {
    "hair": HAIR_STYLES,
    "facial_hair": FACIAL_HAIR,
    "top": TOP_KINDS,
    "bottom": BOTTOM_KINDS,
    "shoes": SHOE_KINDS,
    "hat": HATS,
    "neck": NECKWEAR,
    "over": OVERWEAR,
    "back": BACKWEAR,
}


@dataclass(frozen=True)
class BodySpec:
    """One person.

    height: metres, standing, to the crown; build: 0 thin .. 1 heavy; femininity: 0 .. 1; age: years
    colours: sRGB 0..1 triples; ``hair``, ``facial_hair``, ``top`` … ``back``: words of the tuples above
    shirt_color: what shows under an open blazer or coat
    accent_color: tie, scarf, apron, vest, cape, pack and the trimmings of uniforms and robes
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
    shoes: str = "shoes"
    shoes_color: Colour = (0.14, 0.13, 0.14)
    hat: str = "none"
    hat_color: Colour = (0.17, 0.22, 0.38)
    neck: str = "none"
    over: str = "none"
    back: str = "none"
    belt: bool = False
    gloves: bool = False
    badge: bool = False
    accent_color: Colour = (0.66, 0.16, 0.18)

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
