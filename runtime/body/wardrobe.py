"""From the words of a spec to everything worn from the neck to the wrists, and what is carried on it."""

from __future__ import annotations

from collections.abc import Callable

from .anatomy import Figure
from .armour import armour, spacesuit
from .pieces import Piece
from .pullovers import hoodie, scrubs, shirt, sweater, tank, tshirt, tunic
from .robes import dress, gown, kimono, robe
from .tailoring import blazer, chef_jacket, coat, jacket, lab_coat, suit, uniform

_TOPS: dict[str, Callable[[Figure], list[Piece]]] = {
    "tshirt": tshirt,
    "shirt": shirt,
    "sweater": sweater,
    "blazer": blazer,
    "coat": coat,
    "dress": dress,
    "tank": tank,
    "hoodie": hoodie,
    "suit": suit,
    "jacket": jacket,
    "uniform": uniform,
    "lab-coat": lab_coat,
    "chef-jacket": chef_jacket,
    "scrubs": scrubs,
    "tunic": tunic,
    "robe": robe,
    "gown": gown,
    "kimono": kimono,
    "armour": armour,
    "spacesuit": spacesuit,
}


def top(f: Figure) -> list[Piece]:
    """What the spec's ``top`` is, the left half; the first piece's solid is what the others lie on."""
    return _TOPS[f.spec.top](f)
