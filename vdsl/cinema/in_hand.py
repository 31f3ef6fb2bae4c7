"""Things that somebody holds, as boxes over time, and whether they are in a line of sight."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from .framing import Array
from .vectors import length


@dataclass(frozen=True, eq=False)
class Box:
    """A thing over T frames by the box about it.

    centre: float64 [T, 3], NaN where it is nowhere to be seen; axes: float64 [T, 3, 3], its own as rows of
    unit length; half: float64 [3], half of its extents along these, metres
    """

    centre: Array
    axes: Array
    half: Array

    def shifted(self, up: float) -> Box:
        """The same so many metres higher."""
        return replace(self, centre=self.centre + np.array((0.0, 0.0, up)))

    def away(self, points: Array) -> Array:
        """Distance [T] of points [T, 3] from the box, 0 within it; NaN where it is nowhere."""
        beyond = np.maximum(np.abs(self._local(points)) - self.half, 0.0)
        return np.asarray(length(beyond))

    def before(self, at: NDArray[np.int64], camera: Array, points: Array, skin: float) -> NDArray[np.bool_]:
        """Whether it is between cameras [P, F, 3] and points [F, K, 3] of the frames ``at``, [P, F, K].

        Lines of sight end ``skin`` metres before the points. By slabs (Kay and Kajiya 1986).
        """
        turn = self.axes[at]
        begin = np.einsum("fij,pfj->pfi", turn, camera - self.centre[at])[:, :, None]
        ray = np.einsum("fij,pfkj->pfki", turn, points[None] - camera[:, :, None])
        ray = np.where(np.abs(ray) < 1e-9, 1e-9, ray)
        one, other = (-self.half - begin) / ray, (self.half - begin) / ray
        enters = np.minimum(one, other).max(axis=-1)
        leaves = np.maximum(one, other).min(axis=-1)
        end = np.maximum(1.0 - skin / np.maximum(length(ray), 1e-6), 0.0)
        return np.asarray((enters <= leaves) & (leaves > 0.0) & (enters < end))

    def _local(self, points: Array) -> Array:
        return np.einsum("tij,tj->ti", self.axes, points - self.centre)


def box_of(moved: NDArray[np.floating], low: Array, high: Array) -> Box:
    """The box from ``low`` to ``high`` of a thing that moves by matrices [T, 4, 4] of its own coordinates
    into the world; these may scale it, to nothing as well."""
    matrix = np.asarray(moved, float)
    columns = np.moveaxis(matrix[:, :3, :3], 1, 2)  # rows: where its axes go
    scale = length(columns)
    there: NDArray[np.bool_] = np.asarray((scale > 1e-6).all(axis=1))
    axes = columns / np.maximum(scale, 1e-9)[..., None]
    centre = np.einsum("tij,j->ti", matrix[:, :3, :3], (low + high) / 2) + matrix[:, :3, 3]
    half = (high - low) / 2 * (scale[there].mean(axis=0) if there.any() else 1.0)
    return Box(np.where(np.broadcast_to(there[:, None], centre.shape), centre, np.nan), axes, half)
