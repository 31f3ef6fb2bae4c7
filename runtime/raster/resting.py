"""What rests while other things move: moved once for all moments of a batch, and taken over in the others.

Assumes palettes of one scene. Guarantees that a vertex is said to rest only where all the matrices that move
it are the same in all moments, to the bit.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..rows import unique_rows
from .detail import COUNT, Levels
from .prepare import Prepared


@dataclass(frozen=True, eq=False)
class Lists:
    """Vertices that moments need. vertices: int32, lists one after another; begin: int32 [L + 1], where each
    begins; which: int32 [M], the list of each moment"""

    vertices: NDArray[np.int32]
    begin: NDArray[np.int32]
    which: NDArray[np.int32]

    @property
    def empty(self) -> bool:
        return not len(self.vertices)


def lists_of(masks: NDArray[np.bool_], which: NDArray[np.int32]) -> Lists:
    """Lists of the vertices in masks [L, V]."""
    begin = np.concatenate([[0], np.cumsum(masks.sum(axis=1))]).astype(np.int32)
    return Lists(np.nonzero(masks)[1].astype(np.int32), begin, which.reshape(-1).astype(np.int32))


class Taken(NamedTuple):
    """Moving clusters that belong to empty sets, as they rest.

    clusters: bool [C]; vertices: int32, theirs; entries: int32, what of a palette moves them
    """

    clusters: NDArray[np.bool_]
    vertices: NDArray[np.int32]
    entries: NDArray[np.int32]


class Rig:
    """Which matrices move each skinned vertex, each moving cluster and each thing of a scene.

    walls: of the set; what is in others is somebody, or a level of a body
    """

    def __init__(self, scene: Prepared, walls: int) -> None:
        joints, weights = scene.detail.scene.joints, scene.detail.scene.weights
        first = np.take_along_axis(joints, weights.argmax(axis=1)[:, None], axis=1) if len(joints) else joints
        used = np.sort(np.where(weights != 0, joints, first), axis=1)
        # few combinations of matrices move many vertices
        self._kinds, _, self._kind = unique_rows(used)
        moving = scene.clusters[scene.moving_first :]
        count, self._clusters = int(self._kinds.shape[0]), len(moving)
        faces = scene.faces[scene.static_faces :] - np.int32(len(scene.vertices))
        cluster = np.repeat(np.arange(len(moving)), moving[:, 1])
        pairs = cluster[:, None].astype(np.int64) * max(count, 1) + self._kind[faces]
        pairs = np.unique(pairs)
        self._cluster_of, self._kind_in = pairs // max(count, 1), pairs % max(count, 1)
        self._corners = faces
        self._cluster = cluster
        self._things = moving[:, 3] < walls if len(moving) else np.zeros(0, np.bool_)
        self._taken: Taken | None = None  # the last
        self._owner = scene.owner
        self._touching = scene.area > 0

    def moves(self, palettes: NDArray[np.float32]) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
        """The vertices, and the moving clusters, that are not in all moments as in the first one.

        palettes: [M, P, 3, 4]; of one moment everything is said to move
        """
        if len(palettes) < 2:
            return np.ones(len(self._kind), np.bool_), np.ones(self._clusters, np.bool_)
        words = np.ascontiguousarray(palettes).view(np.uint32)
        kinds = (words[1:] != words[:1]).any(axis=(0, 2, 3))[self._kinds].any(axis=1)
        clusters = np.zeros(self._clusters, np.bool_)
        clusters[self._cluster_of[kinds[self._kind_in]]] = True
        return kinds[self._kind], clusters

    def taken(self, moves: NDArray[np.bool_]) -> Taken | None:
        """What empty sets show of what moves: things that rest. moves: bool [C], of :meth:`moves`"""
        clusters = self._things & ~moves
        if not clusters.any():
            return None
        if self._taken is None or (self._taken.clusters != clusters).any():
            kinds = np.unique(self._kind_in[clusters[self._cluster_of]])
            self._taken = Taken(
                clusters,
                np.unique(self._corners[clusters[self._cluster]]).astype(np.int32),
                np.unique(self._kinds[kinds]).astype(np.int32),
            )
        return self._taken

    def touching(self, moving: NDArray[np.bool_]) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
        """First vertices and those after the last [R, 2] of the things that move, and of those that rest, of
        which some may darken what they stand on. moving: of :meth:`moves`"""
        owner = self._owner
        of_owner = np.zeros(int(owner.max(initial=-1)) + 1, np.bool_)
        of_owner[owner[moving[: len(owner)]]] = True
        moves = of_owner[owner]
        return _runs(self._touching & moves, owner), _runs(self._touching & ~moves, owner)


def _runs(chosen: NDArray[np.bool_], owner: NDArray[np.int32]) -> NDArray[np.int32]:
    """Stretches [R, 2] of chosen places with one owner."""
    at = np.flatnonzero(chosen)
    if not len(at):
        return np.zeros((0, 2), np.int32)
    apart = np.flatnonzero((np.diff(at) != 1) | (np.diff(owner[at]) != 0)) + 1
    return np.stack([at[np.append(0, apart)], at[np.append(apart, len(at)) - 1] + 1], axis=1).astype(np.int32)


def needed(
    detail: Levels, shown: NDArray[np.bool_], every: bool
) -> tuple[NDArray[np.bool_], NDArray[np.int32]]:
    """The skinned vertices that moments need, as masks [L, V], and which of them each moment takes, [M].

    shown: [M, bodies, COUNT], the levels of bodies that some view of a moment shows; every: whether all
    vertices are needed but those of the finest levels
    """
    flat = shown.reshape(len(shown), shown.shape[1] * COUNT)
    patterns, which = np.unique(flat, axis=0, return_inverse=True)
    masks = np.stack([detail.used(p.reshape(-1, COUNT)) for p in patterns])
    if every:
        masks[:, : detail.vertices] = True
    return masks, which.reshape(-1).astype(np.int32)
