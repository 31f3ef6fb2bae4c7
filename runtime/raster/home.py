"""Things where the set puts them: which of them are there, and how the maps of their shadows lie.

Assumes a prepared scene. Guarantees that a thing is said to be at home only where its matrix is the set's, to
the bit.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from .prepare import Prepared

MARGIN = 3  # texels around what is in a map


def entries_of(scene: Prepared) -> NDArray[np.int32]:
    """What of a palette moves each skinned vertex, most of all: int32 [K]; -1 for those of no triangle that
    throws a shadow."""
    joints, weights = scene.detail.scene.joints, scene.detail.scene.weights
    out = np.full(len(joints), -1, np.int32)
    casting = np.unique(scene.faces[scene.casters]) - len(scene.vertices)
    main = weights[casting].argmax(axis=1)
    out[casting] = joints[casting, main]
    return out


class Home:
    """What is at home somewhere.

    casts: bool [P], what of a palette is at home somewhere and throws a shadow; any: whether there is such
    """

    def __init__(
        self,
        scene: Prepared,
        entry: NDArray[np.int32],
        poses: NDArray[np.float32] | None,
        palette: int,
        basis: NDArray[np.float64],
        finest: float,
    ) -> None:
        """entry: of :func:`entries_of`; poses: ``RenderScene.home``; palette: matrices that a moment needs;
        basis [3, 3]: rows across the light and towards it; finest: metres, least size of a texel"""
        self._poses = np.full((palette, 3, 4), np.nan, np.float32) if poses is None else poses[:palette]
        known = np.isfinite(self._poses).all(axis=(1, 2))
        self.casts = np.zeros(palette, np.bool_)
        self.casts[entry[entry >= 0]] = True
        self.casts &= known
        self.any = bool(self.casts.any())
        self._finest = finest
        self._low, self._extent = np.zeros(2), 0.0
        if self.any:
            at = np.flatnonzero((entry >= 0) & self.casts[entry])
            pose = self._poses[entry[at]].astype(np.float64)
            where = np.einsum("vij,vj->vi", pose[:, :, :3], scene.rest[at]) + pose[:, :, 3]
            across = where @ basis[:2].T
            self._low = across.min(axis=0)
            self._extent = float(np.ptp(across, axis=0).max())

    def kept(self, palettes: NDArray[np.float32]) -> NDArray[np.bool_]:
        """What is at home in each moment, bool [M, P]. palettes: [M, P or more, 3, 4]"""
        at_home: NDArray[np.bool_] = (palettes[:, : len(self._poses)] == self._poses).all(axis=(2, 3))
        return at_home

    def frame(self, size: int) -> tuple[float, float, float]:
        """Where a map of size x size texels lies, as ``light.fit`` says it: over all that is at home."""
        texel = self._finest
        while texel * (size - 2 - 2 * MARGIN) < self._extent:
            texel *= math.sqrt(2.0)
        x, y = (np.floor(self._low / texel) - MARGIN) * texel
        return float(x), float(y), 1.0 / texel
