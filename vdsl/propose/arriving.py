"""From where on a performance is shown: who first has to get somewhere is seen to arrive, not to come.

A camera that shows no more than a part of somebody and stays where it is would wait before an empty set until
they are there; an editor cuts to their last step. Where the camera goes along, looks around or shows the
whole figure, the line says how long it is to last, or others act meanwhile, all is shown.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..cinema.moves import families, of_camera
from ..lang.ir import SIZES, Shot

Array = NDArray[np.float64]

#: Sizes that do not show the whole figure, and movements that show a way.
_PARTS = frozenset(SIZES[: SIZES.index("full")])
_ALONG = frozenset(("follow", "pan", "whip-pan", "arc", "handheld"))
_COMES = 0.6  # seconds of the way that are left
_FAR = 1.5  # metres of a way that is worth a cut
_ACTS = 1.0  # seconds that are to be left after it
_STANDS = 0.15  # metres a second of somebody who has arrived
_RESTS = 0.3  # seconds of that


def shows_arrival(shot: Shot) -> bool:
    """Whether cameras of a shot need not see anybody come."""
    kinds = frozenset().union(*(families(of_camera(movement)) for movement in shot.movements))
    return shot.duration is None and set(shot.scales) <= _PARTS and not kinds & _ALONG


def arrival(position: Array, fps: float) -> int:
    """The first frame shown of one whose floor point goes along ``position`` [T, 3]; 0 for all of them."""
    step = np.linalg.norm(np.diff(position[:, :2], axis=0), axis=1)
    going = step * fps > _STANDS
    if not going.any():
        return 0
    least = max(round(_RESTS * fps), 1)
    begin = int(going.argmax())
    resting = np.convolve(~going[begin:], np.ones(least), "valid") >= least - 0.5
    if not resting.any():
        return 0
    there = begin + int(resting.argmax())
    far, left = float(step[:there].sum()), len(position) - there
    first = there - round(_COMES * fps)
    return first if far > _FAR and left > _ACTS * fps and first > 0.5 * fps else 0
