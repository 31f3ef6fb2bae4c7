"""What throws shadows among what moves: whose it is, and which things are where the set puts them.

Assumes a prepared scene. Guarantees that a thing is said to be at home only where its matrix is the set's, to
the bit.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .prepare import Prepared
from .types import LOOSE, RenderScene

MARGIN = 3  # texels around what is in a map


@dataclass(frozen=True, eq=False)
class Casting:
    """What throws shadows, in G groups: things, then each person.

    entry: int32 [K], what of a palette moves each skinned vertex, most of all; group: int32 [P], whose it is
    casters: int32, triangles, group by group; runs: int32 [G, 3], where those of each begin, where those of
    closed shells end, which come first, and where all end; points: int32, their vertices, group by group, and
    point_end: int32 [G], where those of each end
    """

    entry: NDArray[np.int32]
    group: NDArray[np.int32]
    casters: NDArray[np.int32]
    runs: NDArray[np.int32]
    points: NDArray[np.int32]
    point_end: NDArray[np.int32]


def casting_of(scene: Prepared, drawn: RenderScene, palette: int) -> Casting:
    """What throws shadows in a scene. drawn: it as it was before; palette: matrices that a moment needs"""
    joints, weights = scene.detail.scene.joints, scene.detail.scene.weights
    entry = _main(joints, weights)
    group = np.zeros(max(palette, 1), np.int32)
    if drawn.fitting is not None:
        whose = np.maximum(LOOSE - drawn.fitting, 0)
        group[_main(drawn.joints, drawn.weights)[drawn.skinned.faces].T] = whose
    corners = scene.faces[scene.casters] - np.int32(len(scene.vertices))
    of = group[entry[corners[:, 0]]]
    order = np.argsort(of, kind="stable")  # closed ones stay first
    count = int(group.max()) + 1
    number, closed = (np.bincount(some, minlength=count) for some in (of, of[: scene.closed_casters]))
    end = np.cumsum(number)
    runs = np.stack([end - number, end - number + closed, end], axis=1).astype(np.int32)
    points = [np.unique(corners[of == g]) for g in range(count)]
    point_end = np.cumsum([len(p) for p in points]).astype(np.int32)
    every = np.concatenate(points).astype(np.int32)
    return Casting(entry, group, scene.casters[order].astype(np.int32), runs, every, point_end)


def _main(joints: NDArray[np.integer], weights: NDArray[np.floating]) -> NDArray[np.int32]:
    main = (
        np.take_along_axis(joints, weights.argmax(axis=1)[:, None], axis=1)[:, 0] if len(joints) else joints
    )
    return main.reshape(-1).astype(np.int32)


class Home:
    """What is at home somewhere.

    casts: bool [P], what of a palette is at home somewhere and throws a shadow; any: whether there is such
    """

    def __init__(
        self,
        scene: Prepared,
        casting: Casting,
        poses: NDArray[np.float32] | None,
        basis: NDArray[np.float64],
        finest: float,
    ) -> None:
        """poses: ``RenderScene.home``; basis [3, 3]: rows across the light and towards it; finest: metres,
        least size of a texel"""
        palette = len(casting.group)
        self._poses = np.full((palette, 3, 4), np.nan, np.float32)
        if poses is not None:
            things = casting.group[: len(poses)] == 0
            self._poses[: len(poses)][things] = poses[:palette][things]
        known = np.isfinite(self._poses).all(axis=(1, 2))
        points, entry = casting.points[: casting.point_end[0]], casting.entry
        self.casts = np.zeros(palette, np.bool_)
        self.casts[entry[points]] = True
        self.casts &= known
        self.any = bool(self.casts.any())
        self._finest = finest
        self._low, self._extent = np.zeros(2), 0.0
        if self.any:
            at = points[self.casts[entry[points]]]
            pose = self._poses[entry[at]].astype(np.float64)
            where = np.einsum("vij,vj->vi", pose[:, :, :3], scene.rest[at]) + pose[:, :, 3]
            across = where @ basis[:2].T
            self._low = across.min(axis=0)
            self._extent = float(np.ptp(across, axis=0).max())

    def kept(self, palettes: NDArray[np.float32]) -> NDArray[np.bool_]:
        """What is at home in each moment, bool [M, P]. palettes: [M, P or more, 3, 4]"""
        count = min(len(self._poses), palettes.shape[1])
        at_home = np.zeros((len(palettes), len(self._poses)), np.bool_)
        at_home[:, :count] = (palettes[:, :count] == self._poses[:count]).all(axis=(2, 3))
        return at_home

    def frame(self, size: int) -> tuple[float, float, float]:
        """Where a map of size x size texels lies, as ``light.fit`` says it: over all that is at home."""
        texel = self._finest
        while texel * (size - 2 - 2 * MARGIN) < self._extent:
            texel *= math.sqrt(2.0)
        x, y = (np.floor(self._low / texel) - MARGIN) * texel
        return float(x), float(y), 1.0 / texel
