"""What stands between cameras and what they film, over upright boxes; vectorised over P cameras.

Walls are wild: one that stands between camera and subject, or behind which the camera stands, is taken
away for the whole take.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from runtime.world import Solids, World

from .vectors import clamped, dot, length

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

_AT_ONCE = 1 << 16  # lines of sight past bodies at a time: more no longer lie in a core's own cache
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
    low, high = world.wall_ends
    along = high - low
    eye = camera[..., None, :2]
    heart = np.broadcast_to(subject[None, :, None, :2], (*camera.shape[:2], 1, 2))
    targets = np.concatenate([heart, corners], axis=2)

    def side(points: Array) -> Array:
        x, y = points[..., 0, None], points[..., 1, None]
        return along[:, 0] * (y - low[:, 1]) - along[:, 1] * (x - low[:, 0])

    eye_side, target_side = side(eye), side(targets)  # [P, F, 1, W], [P, F, C + 1, W]
    apart = (eye_side[:, :, 0] > 0) != (target_side[:, :, 0] > 0)
    ray = targets - eye
    x, y, dx, dy = eye[..., 0, None], eye[..., 1, None], ray[..., 0, None], ray[..., 1, None]
    a = dx * (low[:, 1] - y) - dy * (low[:, 0] - x)
    b = dx * (high[:, 1] - y) - dy * (high[:, 0] - x)
    crossing = ((a > 0) != (b > 0)) & ((eye_side > 0) != (target_side > 0))
    return np.asarray((crossing.any(axis=2) & apart).any(axis=1))


def backdrop_gaps(world: World, hidden: Bools, camera: Array, subject: Array, rays: Array) -> Array:
    """Share [P] of looks across the frame in which the set is missing behind the subject.

    rays: [P, F, C, 2] unit floor-plan directions
    A look meets a hidden wall behind the subject; or, of a take for which walls are hidden, no wall that is
    shown, though the subject would meet one in that direction: the look goes past the room. Walls lower or
    higher than the subject make no room.
    """
    gaps = np.zeros(len(camera))
    if not world.walls or not hidden.any():
        return gaps
    some = hidden.any(axis=1)
    hidden, camera, rays = hidden[some, None, None, :], camera[some, :, None, :2], rays[some]
    heart = subject[None, :, None, :2]
    low, high = world.wall_ends
    met = _meetings(low, high, camera, rays)
    behind = (met > length(camera - heart)[..., None]) & hidden
    base, tall = np.array([w.base for w in world.walls]), np.array([w.height for w in world.walls])
    height = subject[:, 2].mean()
    around = (base < height) & (base + tall > height)
    past = ~((met > 0.0) & ~hidden & around).any(axis=-1)
    enclosed = ((_meetings(low, high, heart, rays) > 0.0) & around).any(axis=-1)
    gaps[some] = (behind.any(axis=-1) | (past & enclosed)).mean(axis=(1, 2))
    return gaps


def _meetings(low: Array, high: Array, origin: Array, rays: Array) -> Array:
    """How far along rays [..., 2] from origins [..., 2] walls are met, metres: [..., W]; -inf for never."""
    along = high - low
    x, y = low[:, 0] - origin[..., 0, None], low[:, 1] - origin[..., 1, None]
    dx, dy = rays[..., 0, None], rays[..., 1, None]
    denominator = dx * along[:, 1] - dy * along[:, 0]
    safe = np.where(np.abs(denominator) < 1e-9, 1e-9, denominator)
    t = (x * along[:, 1] - y * along[:, 0]) / safe
    s = (x * dy - y * dx) / safe
    return np.asarray(np.where((s >= 0) & (s <= 1), t, -np.inf))


def distances(solids: Solids, points: Array) -> Array:
    """Distance [N, B] from points [N, 3] to every box, negative inside."""
    d = points[:, None, :] - solids.centre
    c, s = solids.turn
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
    eye, own = camera.reshape(-1, 3), points.ndim == 4
    points = points.reshape(-1, K, 3)  # of every camera its own, or of every frame
    boxes = _between(solids, eye, points, ignore)
    if not len(boxes) or not len(eye):
        return np.ones((P, F, K), bool)
    middle, spread = _bounds(points)
    ray = middle - eye if own else (middle - camera).reshape(-1, 3)
    reach = length(spread) if own else np.tile(length(spread), P)
    near = _near(solids, boxes, eye, ray, reach)  # [P · F, B]
    wall = solids.wall[boxes]
    if hidden.shape[1] and (wall >= 0).any():
        gone = np.where(wall >= 0, hidden[:, np.maximum(wall, 0)], False)
        near &= ~np.repeat(gone, F, axis=0)
    n, b = np.divmod(np.flatnonzero(near), len(boxes))
    at = n if own else n % F
    meets = _meets(solids, boxes[b], eye[n], ray[n], spread[at])
    n, b, at = n[meets], b[meets], at[meets]
    m, k = np.nonzero(_cut(solids, boxes[b], eye[n], points[at]))
    seen = np.ones((P * F, K), bool)
    seen[n[m], k] = False
    return seen.reshape(P, F, K)


def _between(solids: Solids, eye: Array, points: Array, ignore: int | None) -> NDArray[np.int64]:
    """Boxes that reach into the space around all cameras [N, 3] and points [M, K, 3], some object's aside."""
    if not len(solids.centre) or not len(eye):
        return np.zeros(0, np.int64)
    low = np.minimum(eye.min(axis=0), points.min(axis=(0, 1)))
    high = np.maximum(eye.max(axis=0), points.max(axis=(0, 1)))
    least, most = solids.bounds
    inside = ((most > low) & (least < high)).all(axis=1)
    if ignore is not None:
        inside &= solids.object != ignore
    return np.flatnonzero(inside)


def _near(solids: Solids, boxes: NDArray[np.int64], eye: Array, ray: Array, spread: Array) -> Bools:
    """[N, B]: boxes whose bounding sphere comes within ``spread`` [N] of the lines from ``eye`` [N, 3] along
    ``ray`` [N, 3]; axis by axis, in single precision."""
    start, along, centre = (a.astype(np.float32) for a in (eye, ray, solids.centre[boxes]))
    gaps = [centre[:, k] - start[:, k, None] for k in range(3)]
    t = np.zeros(gaps[0].shape, np.float32)
    for k, gap in enumerate(gaps):
        t += gap * along[:, k, None]
    t /= np.maximum((along * along).sum(axis=1), 1e-9)[:, None]
    np.clip(t, 0.0, 1.0, out=t)
    away = np.zeros(t.shape, np.float32)
    for k, gap in enumerate(gaps):
        gap -= t * along[:, k, None]
        gap *= gap
        away += gap
    reach = solids.radius[boxes] + spread[:, None]
    return np.asarray(away < (reach * reach).astype(np.float32))


def _bounds(points: Array) -> tuple[Array, Array]:
    """Middle of the points [..., K, 3] -> [..., 3], and how far they lie from it on the floor plan and in
    height [..., 2]."""
    middle = points.mean(axis=-2)
    off = points - middle[..., None, :]
    across, tall = length(off[..., :2]).max(axis=-1), np.abs(off[..., 2]).max(axis=-1)
    return middle, np.stack([across, tall], axis=-1)


def _meets(solids: Solids, box: NDArray[np.int64], camera: Array, ray: Array, spread: Array) -> Bools:
    """Whether the line from camera m along its ray, to the middle of its points, meets box m grown by their
    spread: only then one of its lines may cut the box. [M, 3], [M, 3], [M, 2] -> [M]."""
    c, s = (of[box] for of in solids.turn)
    half = solids.half[box] + spread[:, (0, 0, 1)]
    start = camera - solids.centre[box]
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
    c, s = (of[box, None] for of in solids.turn)
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


def blockers(solids: Solids, camera: Array, points: Array) -> dict[int, int]:
    """How many of the lines from cameras [N, 3] to points [K, 3] each object cuts, by its id; walls aside."""
    boxes = np.flatnonzero(solids.wall < 0)
    n, k = np.divmod(np.arange(len(camera) * len(boxes)), max(len(boxes), 1))
    ends = np.broadcast_to(points, (len(n), *points.shape))
    cut = _cut(solids, boxes[k], camera[n], ends)
    owner = np.repeat(solids.object[boxes[k]], points.shape[0])[cut.ravel()]
    ids, counts = np.unique(owner, return_counts=True)
    return {int(i): int(c) for i, c in zip(ids, counts, strict=True)}


def clear_of_people(camera: Array, points: Array, bodies: list[tuple[Array, Array, float]]) -> Bools:
    """Whether lines pass everybody else: bodies are (foot [F, 3], crown [F, 3], radius) pillars.

    camera: [P, F, 3]; points: [F, K, 3] or [P, F, K, 3] -> bool [P, F, K]
    """
    ends = points[None] if points.ndim == 3 else points
    seen = np.ones((*camera.shape[:2], points.shape[-2]), bool)
    eye, high = camera[:, :, None, :2], camera[:, :, None, 2]
    ray, rise = ends[..., :2] - eye, ends[..., 2] - high
    square = np.maximum(dot(ray, ray), 1e-9)
    at_once = max(_AT_ONCE // max(seen.size, 1), 1)
    for begin in range(0, len(bodies), at_once):
        some = bodies[begin : begin + at_once]
        foot = np.array([foot[:, :2] for foot, _, _ in some])[:, None, :, None]  # [B, 1, F, 1, 2]
        tall = np.array([crown[:, 2] for _, crown, _ in some])[:, None, :, None]
        radius = np.array([radius for _, _, radius in some])[:, None, None, None]
        start = foot - eye
        t = clamped(dot(start, ray) / square, 0.0, 1.0)
        away = length(start - t[..., None] * ray)
        seen &= ~((away < radius) & (high + t * rise < tall) & (t < 0.97)).any(axis=0)
    return seen
