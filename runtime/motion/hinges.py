"""What opens and closes over a shot: doors on the way, and whatever an action drives.

Assumes plans whose windows say what is driven when. Guarantees that a part stands as it stood before the
first drive and after the last one, that it never goes beyond its stops, and that the handle's track is
where the part is, so that a hand which follows it stays on it.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from .curves import ramp
from .plan import Plan
from .types import PropState

Array = NDArray[np.float64]


def openness(prop: PropState, plans: Iterable[Plan], thing: int, t: Array) -> Array:
    """[T]: how far a part stands open at times ``t``; 0 closed, 1 as far as it goes."""
    drives = [
        (window.at(drive.start), window.at(drive.end), drive.openness)
        for plan in plans
        for window in plan.windows
        for drive in window.timeline.drives
        for point in (window.second if drive.target == "second" else window.target,)
        if point is not None and point.object == thing
    ]
    out = np.full(len(t), float(prop.open))
    for start, end, wanted in sorted(drives):
        out += ramp(t, start, end) * (np.clip(wanted, 0.0, 1.0) - out)
    return out


def handle_track(prop: PropState, matrices: Array) -> Array:
    """[T, 3]: where the handle of a part is, for matrices [T, 4, 4] of it."""
    assert prop.hinge is not None
    return np.asarray(matrices[:, :3, :3] @ prop.hinge.handle + matrices[:, :3, 3])


def followed(track: Array, t: Array, arrive: float, leave: float) -> Array:
    """[T, 3]: a hand's place on a moving handle: it waits where it takes hold, and stays where it lets go."""
    at = np.clip(t, arrive, leave)
    return np.stack([np.interp(at, t, track[:, k]) for k in range(3)], axis=1)
