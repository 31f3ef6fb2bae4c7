"""The guides of drawn shots: what the renderer knows of them, as the ranker takes it (:mod:`ranker.guides`).

Assumes pictures drawn with roles. Guarantees that all that is told is of what the pictures show: no plan of
the camera's, no measure and no judgement goes in.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ranker.guides import CHANNELS, FLOW, SIDE, Guides, pairs
from runtime.raster.types import FAR, GUIDE_SIDE, NEAREST, OTHERS, SUBJECT, Camera

from ..lang.ir import Shot
from ..propose.subjects import Filming, find_object, subject_of
from ..propose.types import ProposalGrid
from ..stage.assemble import StagedScene

assert GUIDE_SIDE == SIDE
_FARTHEST = 3.0  # half frames that something goes at most
_BEHIND = 0.05  # of a ray's length ahead: what is nearer to the plane of the lens counts as this


def objects_of(shot: Shot, grid: ProposalGrid, filming: Filming, staged: StagedScene) -> tuple[int, ...]:
    """Ids of what the cameras of a shot are about; none for a place, which is everything there is."""
    if not grid.story:
        return ()
    subject = subject_of(shot, grid.story[0], filming)
    if subject.kind == "person":
        names = tuple(subject.heads) or (subject.name,)
        return tuple(staged.object_ids[name] for name in names if name in staged.object_ids)
    item = find_object(filming.world, shot.focus) if subject.kind == "thing" and shot.focus else None
    return () if item is None else (item.id,)


def roles_of(staged: StagedScene, about: Sequence[tuple[int, ...]]) -> NDArray[np.uint8]:
    """The roles of all objects for each of P cameras, uint8 [P, objects]. about: the ids of their subjects"""
    people = list(staged.object_ids.values())
    out = np.zeros((len(about), len(staged.world.objects) + len(people)), np.uint8)
    out[:, people] = OTHERS
    for row, ids in zip(out, about, strict=True):
        row[list(ids)] = SUBJECT
    return out


def guides_of(
    drawn: NDArray[np.uint8], camera: Camera, shots: int, which: Sequence[int], whole: int
) -> Guides:
    """Guides of P shots by k frames each.

    drawn: uint8 [P k, SIDE, SIDE, 6] of the renderer; camera: of these P k pictures; which: the k frames they
    are, of ``whole``
    """
    count = len(which)
    maps = np.empty((shots, count, SIDE, SIDE, len(CHANNELS)), np.uint8)
    maps[..., :-1] = drawn.reshape(shots, count, *drawn.shape[1:])
    rays = _rays(camera, SIDE)
    rise = np.arcsin(np.clip(rays[..., 2] / np.linalg.norm(rays, axis=-1), -1, 1)) / (np.pi / 2)
    maps[..., -1] = np.round(128 + 127 * rise).reshape(maps.shape[:-1])
    matched = pairs(whole)
    flow = np.full((shots, len(matched), FLOW, FLOW, 2), np.nan, np.float16)
    if count == whole:
        near = _nearness(maps[..., CHANNELS.index("nearness")])
        flow[:] = _flow(near, camera, shots, matched)
    return Guides(maps, flow)


def _rays(camera: Camera, side: int) -> NDArray[np.float32]:
    """Directions of the middles of cells, one ahead, in the world: float32 [N, side, side, 3]."""
    along = (np.arange(side, dtype=np.float32) + 0.5) * 2 / side - 1
    right = along[None, None, :, None] * camera.sensor[0] / 2 / camera.focal[:, None, None, None]
    up = -along[None, :, None, None] * camera.sensor[1] / 2 / camera.focal[:, None, None, None]
    axes = camera.axes[:, None, None]
    return np.asarray(axes[..., 2, :] + right * axes[..., 0, :] + up * axes[..., 1, :], np.float32)


def _nearness(code: NDArray[np.uint8]) -> NDArray[np.float32]:
    """1/z in the cells of a field of flow, float32 [P, T, FLOW, FLOW]; code: [P, T, SIDE, SIDE]."""
    table = np.exp((np.arange(256) - 1) / 254 * np.log(FAR / NEAREST)) / FAR
    table[0] = 0.0
    step = SIDE // FLOW
    shape = (*code.shape[:2], FLOW, step, FLOW, step)
    return np.asarray(table.astype(np.float32)[code].reshape(shape).mean((3, 5)))


def _flow(
    near: NDArray[np.float32], camera: Camera, shots: int, matched: list[tuple[int, int]]
) -> NDArray[np.float32]:
    """Where the camera's motion takes what is seen, float32 [P, pairs, FLOW, FLOW, 2]."""
    before, after = (np.array(side) for side in zip(*matched, strict=True))

    def by_shot(values: NDArray[np.floating]) -> NDArray[np.floating]:
        return values.reshape(shots, -1, *values.shape[1:])

    ray, place = by_shot(_rays(camera, FLOW))[:, before], by_shot(camera.position)
    gone = (place[:, before] - place[:, after])[:, :, None, None]
    ahead = ray + near[:, before, :, :, None] * gone  # homogeneous: what is far only turns
    seen = np.einsum("npyxc,npac->npyxa", ahead, by_shot(camera.axes)[:, after])
    depth = np.maximum(seen[..., 2:], _BEHIND)
    lens = 2 * by_shot(camera.focal)[:, after, None, None, None] / np.array(camera.sensor)
    there = lens * seen[..., :2] / depth * (1, -1)
    along = (np.arange(FLOW) + 0.5) * 2 / FLOW - 1
    here = np.stack(np.meshgrid(along, along), axis=-1)
    return np.asarray(np.clip(there - here, -_FARTHEST, _FARTHEST), np.float32)
