"""Shot sizes: between which lines of the frame the body stands.

A size names an upper and a lower landmark of the posed body and the heights in the picture they are put
on, 0 at the top and 1 at the bottom (CINEMA.md's table: the lower line cuts at collar, waist, feet …).
Hats and high hair, from ``crown`` to ``top``, are in the frame from the medium close-up on; a close-up cuts
them.
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

    @property
    def whole_head(self) -> bool:
        """Whether all of the head is to be in the frame."""
        return self.upper in ("crown", "top")


#: For people.
SIZES: dict[str, Size] = {
    s.name: s
    for s in (
        Size("extreme-close-up", "brow", "nose", 0.22, 0.72),
        Size("big-close-up", "hairline", "chin", 0.03, 0.97),
        Size("close-up", "crown", "collar", 0.08, 1.0),
        Size("medium-close-up", "top", "pocket", 0.09, 1.0),
        Size("medium", "top", "waist", 0.10, 1.0),
        Size("cowboy", "top", "thigh", 0.09, 1.0),
        Size("medium-long", "top", "knees", 0.09, 1.0),
        Size("full", "top", "feet", 0.08, 0.94),
        Size("wide", "top", "feet", 0.27, 0.85),
        Size("extreme-wide", "top", "feet", 0.46, 0.74),
    )
}


def _centred(*shares: float) -> dict[str, Size]:
    """Sizes of a stretch from ``crown`` to ``feet`` about the middle of the picture, close ones first."""
    return {
        name: Size(name, "crown", "feet", 0.5 - share / 2, 0.5 + share / 2)
        for name, share in zip(SIZES, shares, strict=True)
    }


#: For things and for places, whose ``crown`` and ``feet`` are the ends of what is to be shown.
THING_SIZES: dict[str, Size] = _centred(1.5, 1.0, 0.7, 0.54, 0.42, 0.36, 0.31, 0.26, 0.14, 0.07)
PLACE_SIZES: dict[str, Size] = _centred(2.6, 2.0, 1.6, 1.4, 1.2, 1.1, 1.02, 0.95, 0.8, 0.5)
#: The landmark that has to be in the frame besides the eyes.
CORE: dict[str, str] = dict.fromkeys(SIZES, "chin") | {"extreme-close-up": "nose"}
CORE |= dict.fromkeys(("medium-long", "full", "wide", "extreme-wide"), "waist")
#: The paper's distances at 50 mm as shares of the character's height (section 3.2, Shot Scale);
#: ``wide`` is ours, one step on.
PAPER_RADIUS = {"close-up": 0.2, "medium": 0.5, "full": 1.0, "wide": 2.0}
#: What ``rig paper`` looks at: height above the floor point as a share of the standing height.
#: Face, chest, and the body's centre.
PAPER_REFERENCE = {"close-up": 0.92, "medium": 0.75, "full": 0.52, "wide": 0.52}


def size_of(kind: str, scale: str) -> Size:
    """The size a scale means for a person, a thing or a place."""
    return {"person": SIZES, "thing": THING_SIZES, "place": PLACE_SIZES}[kind][scale]
