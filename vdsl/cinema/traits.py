"""In what takes of a shot differ that somebody may like better, without either being wrong.

Assumes measures of :mod:`.measures`. Guarantees numbers that can be compared: one step of a trait is a
difference that is seen, of about the same weight as a step of any other.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .moves import families
from .sizes import SIZES


class Trait(NamedTuple):
    """step: how much of it is a difference, in its own unit; more, less: what a take with more of it has,
    and one with less"""

    step: float
    more: str
    less: str


#: Measures that are a matter of liking, by name.
_MEASURED = {
    "elevation": Trait(10.0, "looking down", "looking up"),
    "height": Trait(0.5, "a high camera", "a low camera"),
    "face": Trait(0.4, "faces to the camera", "faces turned away"),
    "legible": Trait(0.2, "faces that are read", "faces that are hardly read"),
    "lead_room": Trait(0.3, "room ahead of the face", "room behind the head"),
    "headroom": Trait(0.1, "air over the head", "little air over the head"),
    "thirds_error": Trait(0.1, "eyes off the upper third", "eyes on the upper third"),
    "interest": Trait(0.3, "what is acted on", "who acts alone"),
    "heads": Trait(0.3, "all heads", "fewer heads"),
    "together": Trait(0.3, "heads close together", "heads apart"),
    "hands_shown": Trait(0.5, "hands", "no hands"),
    "foreground": Trait(0.1, "something near in the picture", "nothing near in the picture"),
}
#: Measured otherwise.
_FURTHER = {
    "slant": Trait(10.0, "a camera that is not level", "a level camera"),
    "closeness": Trait(1.5, "closer sizes", "wider sizes"),  # sizes
    "focal": Trait(0.3, "longer lenses", "wider lenses"),  # log of millimetres
    "speed": Trait(0.3, "a camera that goes fast", "a camera that hardly goes"),  # log of 1 + m/s
    "turning": Trait(0.5, "a camera that turns fast", "a camera that hardly turns"),  # of 1 + 10 °/s
}
_MOVEMENTS = (
    *("static", "follow", "push", "pull", "zoom", "tilt", "pan", "dolly", "pedestal", "arc", "crane", "roll"),
    *("dolly-zoom", "whip-pan", "handheld"),
)
TRAITS: dict[str, Trait] = {
    **_MEASURED,
    **_FURTHER,
    **{name: Trait(1.0, f"{name} shots", f"no {name} shots") for name in _MOVEMENTS},
}
_CLOSENESS = {name: -float(rank) for rank, name in enumerate(SIZES)}  # from close to wide


def traits_of(
    measures: Mapping[str, float], movement: str, scale: str, focal: NDArray[np.float64]
) -> NDArray[np.float64]:
    """The traits of a take in steps, [M] in the order of :data:`TRAITS`.

    measures: by the names of :mod:`.measures`; movement, scale: canonical words; focal: of its frames, mm
    """
    moves = families(movement)
    found = {
        **{name: measures[name] for name in _MEASURED},
        "slant": abs(measures["elevation"]),
        "closeness": _CLOSENESS.get(scale, 0.0),
        "focal": math.log(float(np.mean(focal))),
        "speed": math.log1p(measures["speed"]),
        "turning": math.log1p(measures["angular_speed"] / 10.0),
        **{name: float(name in moves) for name in _MOVEMENTS},
    }
    return np.array([found[name] / trait.step for name, trait in TRAITS.items()])
