"""Where a set ends in the picture: the floor of a room reaches so far, and beyond it there is nothing.

Assumes floors as rectangles. Outdoors there is ground all around.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from runtime.world import World

from .framing import Array
from .looking import Sight
from .takes import Bools, Takes

#: Where in the lower part of the frame, −1..1, it is looked; y is down.
_LOOKS = np.array([(x, y) for x in (-0.8, -0.3, 0.3, 0.8) for y in (0.3, 0.65, 0.95)])
#: Metres beside a floor that walls and sills may take; least downward slope of a look.
_WALL, _DOWN = 0.35, 0.02
#: How much the last frame counts, were there nothing missing in all others.
_ENDS = 0.5


def floor_gaps(
    takes: Takes,
    world: World,
    floor: float,
    at: NDArray[np.int64],
    camera: Array,
    axes: Array,
    looks: Sight,
) -> Array:
    """Share [P] of looks at the lower part of the picture that go past the floors of a set indoors into
    nothing, first, halfway and last; or :data:`_ENDS` of the share in the last frame where that is more.

    floor: height of the one the subject is on
    """
    if world.outdoor or not world.floors:
        return np.zeros(len(camera))
    some = np.unique(np.array((0, len(at) // 2, len(at) - 1)))
    eye, ax = camera[:, some, None], axes[:, some, None]
    half = 1.0 / (2.0 * takes.track.focal[:, at[some], None, None])
    rays = (
        ax[..., 2, :]
        + half * takes.track.sensor[0] * _LOOKS[:, :1] * ax[..., 0, :]
        - half * takes.track.sensor[1] * _LOOKS[:, 1:] * ax[..., 1, :]
    )
    down = (rays[..., 2] < -_DOWN) & (eye[..., 2] > floor)
    away = np.where(down, (floor - eye[..., 2]) / np.minimum(rays[..., 2], -_DOWN), 0.0)
    points = eye + away[..., None] * rays
    past = down & ~_on_floors(world, points)
    p, f, k = np.nonzero(past)  # line by line: most looks end on a floor, and these lie far apart
    past[p, f, k] = looks.clear_each(p, some[f], points[p, f, k])
    share = past.mean(axis=2)
    return np.asarray(np.maximum(share.mean(axis=1), _ENDS * share[:, -1]))


def _on_floors(world: World, points: Array) -> Bools:
    """Which of points [..., 3] lie over a floor of any storey, or within a wall beside it."""
    low, high = np.array(world.floors)[:, :2] - _WALL, np.array(world.floors)[:, 2:] + _WALL
    inside = (points[..., None, :2] > low) & (points[..., None, :2] < high)
    return np.asarray(inside.all(axis=-1).any(axis=-1))
