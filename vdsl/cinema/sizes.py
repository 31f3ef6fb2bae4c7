"""Shot sizes: between which lines of the frame the body stands.

A size names an upper and a lower landmark of the posed body and the heights in the picture they are put
on, 0 at the top and 1 at the bottom (CINEMA.md's table: the lower line cuts at collar, waist, feet …).
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Size:
    """Where a body sits in the frame.

    upper, lower: landmark names; top, bottom: their lines in the picture, 0 top .. 1 bottom
    """

    name: str
    upper: str
    lower: str
    top: float
    bottom: float

    @property
    def share(self) -> float:
        """Height of the stretch between the landmarks as a share of the frame's."""
        return self.bottom - self.top


#: For people.
SIZES: dict[str, Size] = {
    s.name: s
    for s in (
        Size("extreme-close-up", "brow", "nose", 0.22, 0.72),
        Size("big-close-up", "hairline", "chin", 0.03, 0.97),
        Size("close-up", "crown", "collar", 0.08, 1.0),
        Size("medium-close-up", "crown", "pocket", 0.09, 1.0),
        Size("medium", "crown", "waist", 0.10, 1.0),
        Size("cowboy", "crown", "thigh", 0.09, 1.0),
        Size("medium-long", "crown", "knees", 0.09, 1.0),
        Size("full", "crown", "feet", 0.08, 0.94),
        Size("wide", "crown", "feet", 0.27, 0.85),
        Size("extreme-wide", "crown", "feet", 0.46, 0.74),
    )
}
#: For things and for places, whose ``crown`` and ``feet`` are the ends of what is to be shown.
THING_SIZES: dict[str, Size] = {
    name: Size(name, "crown", "feet", 0.5 - share / 2, 0.5 + share / 2)
    for name, share in (("close-up", 0.7), ("medium", 0.42), ("full", 0.26), ("wide", 0.14))
}
PLACE_SIZES: dict[str, Size] = {
    name: Size(name, "crown", "feet", 0.5 - share / 2, 0.5 + share / 2)
    for name, share in (("close-up", 1.6), ("medium", 1.2), ("full", 0.95), ("wide", 0.8))
}
#: The paper's distances at 50 mm as shares of the character's height (section 3.2, Shot Scale);
#: ``wide`` is ours, one step on.
PAPER_RADIUS = {"close-up": 0.2, "medium": 0.5, "full": 1.0, "wide": 2.0}
#: What ``rig paper`` looks at: height above the floor point as a share of the standing height.
#: Face, chest, and the body's centre.
PAPER_REFERENCE = {"close-up": 0.92, "medium": 0.75, "full": 0.52, "wide": 0.52}


def size_of(kind: str, scale: str) -> Size:
    """The size a scale means for a person, a thing or a place."""
    return {"person": SIZES, "thing": THING_SIZES, "place": PLACE_SIZES}[kind][scale]
