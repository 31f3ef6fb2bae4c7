"""What stands between cameras and what they film, over upright boxes; vectorised over P cameras.

Walls are wild: one that stands between camera and subject, or behind which the camera stands, is taken
away for the whole take.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from runtime.world import Solids, World

from .vectors import dot, length

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

_TOUCH = 0.14  # metres before a landmark at which a box no longer hides it (the chair one sits on)


def hidden_walls(world: World, camera: Array, subject: Array, corners: Array) -> Bools:
    """Wild walls not drawn in each take.

    camera: [P, F, 3]; subject: [F, 3]; corners: [P, F, C, 2], floor-plan points across the frame at the
    subject's depth
    returns: bool [P, W]. A wall is hidden when at any frame it separates camera from subject and one
    of the lines from the camera to the subject or the frame's corners crosses it.
    """
    if not world.walls:
        return np.zeros((len(camera), 0), bool)
    low = np.array([w.low for w in world.walls])
    high = np.array([w.high for w in world.walls])
    along = high - low
    eye = camera[..., None, :2]
    heart = np.broadcast_to(subject[None, :, None, :2], (*camera.shape[:2], 1, 2))
    targets = np.concatenate([heart, corners], axis=2)

    def side(points: Array) -> Array:
        d = points[..., None, :] - low
        return along[:, 0] * d[..., 1] - along[:, 1] * d[..., 0]

    eye_side, target_side = side(eye), side(targets)  # [P, F, 1, W], [P, F, C + 1, W]
    apart = (eye_side[:, :, 0] > 0) != (target_side[:, :, 0] > 0)
    ray = targets - eye
    to_low, to_high = low - eye[..., None, :], high - eye[..., None, :]
    a = ray[..., None, 0] * to_low[..., 1] - ray[..., None, 1] * to_low[..., 0]
    b = ray[..., None, 0] * to_high[..., 1] - ray[..., None, 1] * to_high[..., 0]
    crossing = ((a > 0) != (b > 0)) & ((eye_side > 0) != (target_side > 0))
    return np.asarray((crossing.any(axis=2) & apart).any(axis=1))


def backdrop_gaps(world: World, hidden: Bools, camera: Array, subject: Array, rays: Array) -> Array:
    """Share [P] of looks across the frame that would meet a hidden wall behind the subject.

    rays: [P, F, C, 2] unit floor-plan directions
    """
    if not world.walls or not hidden.any():
        return np.zeros(len(camera))
    low = np.array([w.low for w in world.walls])
    along = np.array([w.high for w in world.walls]) - low
    d = low - camera[:, :, None, None, :2]
    denominator = rays[..., None, 0] * along[:, 1] - rays[..., None, 1] * along[:, 0]
    safe = np.where(np.abs(denominator) < 1e-9, 1e-9, denominator)
    t = (d[..., 0] * along[:, 1] - d[..., 1] * along[:, 0]) / safe
    s = (d[..., 0] * rays[..., None, 1] - d[..., 1] * rays[..., None, 0]) / safe
    reach = length(camera[..., :2] - subject[None, :, :2])[:, :, None, None]
    behind = (t > reach) & (s >= 0) & (s <= 1) & hidden[:, None, None, :]
    return np.asarray(behind.any(axis=3).mean(axis=(1, 2)))


def distances(solids: Solids, points: Array) -> Array:
    """Distance [N, B] from points [N, 3] to every box, negative inside."""
    d = points[:, None, :] - solids.centre
    c, s = np.cos(solids.yaw), np.sin(solids.yaw)
    local = np.stack([c * d[..., 0] + s * d[..., 1], c * d[..., 1] - s * d[..., 0], d[..., 2]], axis=-1)
    q = np.abs(local) - solids.half
    outside = np.linalg.norm(np.maximum(q, 0.0), axis=-1)
    return np.asarray(outside + np.minimum(q.max(axis=-1), 0.0))


def clear_lines(
    solids: Solids, camera: Array, points: Array, hidden: Bools, ignore: int | None = None
) -> Bools:
    """Whether each point can be seen.

    camera: [P, F, 3]; points: [F, K, 3], or [P, F, K, 3] where every take has its own
    hidden: [P, W] walls taken away; ignore: id of an object whose boxes do not count (the thing filmed)
    returns: bool [P, F, K]
    """
    P, F = camera.shape[:2]
    K = points.shape[-2]
    boxes = np.arange(len(solids.centre))
    if ignore is not None:
        boxes = boxes[solids.object != ignore]
    if not len(boxes):
        return np.ones((P, F, K), bool)
    near = _near(solids, boxes, camera, points)  # [P, F, B]
    wall = solids.wall[boxes]
    if hidden.shape[1]:
        near &= ~np.where(wall >= 0, hidden[:, np.maximum(wall, 0)], False)[:, None, :]
    p, f, b = np.nonzero(near)
    eye, at = camera[p, f], (f,) if points.ndim == 3 else (p, f)
    middle, spread = _bounds(points)
    meets = _meets(solids, boxes[b], eye, middle[at], spread[at])
    p, f, b = p[meets], f[meets], b[meets]
    at = (f,) if points.ndim == 3 else (p, f)
    blocked = _cut(solids, boxes[b], eye[meets], points[at])  # [M, K]
    seen = np.ones((P * F, K), bool)
    m, k = np.nonzero(blocked)
    seen[p[m] * F + f[m], k] = False
    return seen.reshape(P, F, K)


def _near(solids: Solids, boxes: NDArray[np.int64], camera: Array, points: Array) -> Bools:
    """Boxes whose bounding sphere comes close to the line from camera to the middle of the points."""
    middle = points.mean(axis=-2)
    spread = length(points - middle[..., None, :]).max(axis=-1)
    ray = (middle - camera).astype(np.float32)
    square = np.maximum(np.einsum("pfk,pfk->pf", ray, ray), 1e-9)
    centre = solids.centre[boxes].astype(np.float32)
    eye = camera.astype(np.float32)
    along = np.matmul(ray, centre.T) - np.einsum("pfk,pfk->pf", ray, eye)[..., None]
    t = np.clip(along / square[..., None], 0.0, 1.0)
    away = np.zeros(t.shape, np.float32)
    for k in range(3):
        away += (centre[:, k] - eye[..., k, None] - t * ray[..., k, None]) ** 2
    reach = np.linalg.norm(solids.half[boxes], axis=1).astype(np.float32) + spread[..., None].astype(
        np.float32
    )
    return np.asarray(away < reach**2)


def _bounds(points: Array) -> tuple[Array, Array]:
    """Middle of the points [..., K, 3] -> [..., 3], and how far they lie from it on the floor plan and in
    height [..., 2]."""
    middle = points.mean(axis=-2)
    off = points - middle[..., None, :]
    across, tall = length(off[..., :2]).max(axis=-1), np.abs(off[..., 2]).max(axis=-1)
    return middle, np.stack([across, tall], axis=-1)


def _meets(solids: Solids, box: NDArray[np.int64], camera: Array, middle: Array, spread: Array) -> Bools:
    """Whether the line from camera m to the middle of its points meets box m grown by their spread: only
    then one of its lines may cut the box. [M, 3], [M, 3], [M, 2] -> [M]."""
    c, s = np.cos(solids.yaw)[box], np.sin(solids.yaw)[box]
    half = solids.half[box] + spread[:, (0, 0, 1)]
    start, ray = camera - solids.centre[box], middle - camera
    enter, leave = np.zeros(len(box)), np.ones(len(box))
    for axis in range(3):
        if axis == 2:
            o, r = start[:, 2], ray[:, 2]
        else:
            k = 1.0 - 2.0 * axis
            o = c * start[:, axis] + k * s * start[:, 1 - axis]
            r = c * ray[:, axis] + k * s * ray[:, 1 - axis]
        inverse = 1.0 / np.where(np.abs(r) < 1e-9, 1e-9, r)
        near, far = -o * inverse, half[:, axis] * np.abs(inverse)
        np.maximum(enter, near - far, out=enter)
        np.minimum(leave, near + far, out=leave)
    return np.asarray(enter <= leave)


def _cut(solids: Solids, box: NDArray[np.int64], camera: Array, points: Array) -> Bools:
    """Whether box m cuts the lines from camera m to its points: [M, 3], [M, K, 3] -> [M, K]."""
    c, s = np.cos(solids.yaw)[box, None], np.sin(solids.yaw)[box, None]
    start, stop = camera - solids.centre[box], points - solids.centre[box][:, None]
    origin = (c[:, 0] * start[:, 0] + s[:, 0] * start[:, 1], c[:, 0] * start[:, 1] - s[:, 0] * start[:, 0])
    end = (c * stop[..., 0] + s * stop[..., 1], c * stop[..., 1] - s * stop[..., 0], stop[..., 2])
    half = solids.half[box]
    enter, leave = np.full(end[0].shape, -np.inf), np.full(end[0].shape, np.inf)
    square, within = np.zeros(end[0].shape), np.ones(end[0].shape, bool)
    for axis, o in enumerate((*origin, start[:, 2])):  # slab by slab: a reduction over three is slow
        o, h = o[:, None], half[:, axis, None]
        ray = end[axis] - o
        inverse = 1.0 / np.where(np.abs(ray) < 1e-9, 1e-9, ray)
        t1, t2 = (-h - o) * inverse, (h - o) * inverse
        np.maximum(enter, np.minimum(t1, t2), out=enter)
        np.minimum(leave, np.maximum(t1, t2), out=leave)
        square += ray * ray
        within &= np.abs(end[axis]) <= h + 0.05
    last = 1.0 - _TOUCH / np.maximum(np.sqrt(square), 2 * _TOUCH)
    return np.asarray((enter < np.minimum(leave, last)) & (leave > 0.0) & ~within)


def clear_of_people(camera: Array, points: Array, bodies: list[tuple[Array, Array, float]]) -> Bools:
    """Whether lines pass everybody else: bodies are (foot [F, 3], crown [F, 3], radius) pillars.

    camera: [P, F, 3]; points: [F, K, 3] or [P, F, K, 3] -> bool [P, F, K]
    """
    ends = points[None] if points.ndim == 3 else points
    seen = np.ones((*camera.shape[:2], points.shape[-2]), bool)
    for foot, crown, radius in bodies:
        eye = camera[:, :, None, :2]
        ray = ends[..., :2] - eye
        start = foot[None, :, None, :2] - eye
        square = np.maximum(dot(ray, ray), 1e-9)
        t = np.clip(dot(start, ray) / square, 0.0, 1.0)
        away = length(start - t[..., None] * ray)
        height = camera[:, :, None, 2] + t * (ends[..., 2] - camera[:, :, None, 2])
        seen &= ~((away < radius) & (height < crown[None, :, None, 2]) & (t < 0.97))
    return seen
