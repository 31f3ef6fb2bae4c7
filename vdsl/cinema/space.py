"""Room for the camera itself: distances to solids, people, floor, ceiling and the edge of the set."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from runtime.world import Solids, World

Array = NDArray[np.float64]

REACH = 1.0  # metres up to which clearance is measured


@dataclass(frozen=True, eq=False)
class Clearance:
    """Least distances over a take, [P], capped at :data:`REACH`; negative inside.

    object: to furniture and other things; shown: to walls that are drawn; wall: to any wall
    """

    object: Array
    shown: Array
    wall: Array


def clearance(solids: Solids, camera: Array, hidden: NDArray[np.bool_]) -> Clearance:
    """Clearance of cameras [P, F, 3]; hidden: [P, W] walls taken away."""
    P, F = camera.shape[:2]
    best = [np.full(P, REACH) for _ in range(3)]
    if len(solids.centre):
        n, b, away = _pairs(solids, camera.reshape(-1, 3))
        p, wall = n // F, solids.wall[b]
        gone = np.zeros(len(b), bool)
        if hidden.shape[1]:
            gone = (wall >= 0) & hidden[p, np.maximum(wall, 0)]
        for out, chosen in zip(best, (wall < 0, (wall >= 0) & ~gone, wall >= 0), strict=True):
            np.minimum.at(out, p[chosen], away[chosen])
    return Clearance(*best)


def _pairs(solids: Solids, points: Array) -> tuple[NDArray[np.int64], NDArray[np.int64], Array]:
    """Pairs (point, box) closer than about :data:`REACH`, and their signed distances."""
    low, high = points.min(axis=0) - REACH, points.max(axis=0) + REACH
    radius = np.linalg.norm(solids.half, axis=1)
    kept = np.flatnonzero(
        ((solids.centre + radius[:, None] > low) & (solids.centre - radius[:, None] < high)).all(axis=1)
    )
    gap = points[:, None].astype(np.float32) - solids.centre[kept].astype(np.float32)
    n, k = np.nonzero((gap**2).sum(-1) < ((radius[kept] + REACH) ** 2).astype(np.float32))
    b = kept[k]
    d = points[n] - solids.centre[b]
    c, s = np.cos(solids.yaw[b]), np.sin(solids.yaw[b])
    local = np.stack([c * d[:, 0] + s * d[:, 1], c * d[:, 1] - s * d[:, 0], d[:, 2]], axis=-1)
    q = np.abs(local) - solids.half[b]
    away = np.linalg.norm(np.maximum(q, 0.0), axis=-1) + np.minimum(q.max(axis=-1), 0.0)
    return n, b, away


def to_people(camera: Array, bodies: list[tuple[Array, Array, float]]) -> Array:
    """Least distance [P] from cameras [P, F, 3] to pillars (foot [F, 3], crown [F, 3], radius)."""
    best = np.full(len(camera), REACH)
    for foot, crown, radius in bodies:
        axis = crown - foot
        square = np.maximum((axis**2).sum(-1), 1e-9)
        t = np.clip(((camera - foot) * axis).sum(-1) / square, 0.0, 1.0)
        away = np.linalg.norm(camera - foot - t[..., None] * axis, axis=-1) - radius
        np.minimum(best, away.min(axis=1), out=best)
    return best


@dataclass(frozen=True)
class Stage:
    """Where cameras may be: rectangles (x0, y0, x1, y1) of the rooms filmed, and the ceiling or None."""

    rooms: tuple[tuple[float, float, float, float], ...]
    ceiling: float | None

    def outside(self, camera: Array) -> Array:
        """Greatest distance [P] of cameras [P, F, 3] from the rooms, on the floor plan."""
        best = np.full(camera.shape[:2], np.inf)
        for x0, y0, x1, y1 in self.rooms:
            dx = np.maximum(np.maximum(x0 - camera[..., 0], camera[..., 0] - x1), 0.0)
            dy = np.maximum(np.maximum(y0 - camera[..., 1], camera[..., 1] - y1), 0.0)
            best = np.minimum(best, np.hypot(dx, dy))
        return best.max(axis=1) if self.rooms else np.zeros(len(camera))


def stage_of(world: World, places: Array) -> Stage:
    """The rooms in which the points [N, 3] lie (all floors where none does) and their lowest ceiling."""
    rooms, ceilings = [], []
    for item in world.objects:
        if item.kind not in ("room", "area"):
            continue
        low, high = np.array(item.low), np.array(item.high)
        if ((places[:, :2] >= low[:2] - 0.1) & (places[:, :2] <= high[:2] + 0.1)).all(axis=1).any():
            rooms.append((low[0], low[1], high[0], high[1]))
            if item.kind == "room" and high[2] > 2.0:
                ceilings.append(float(high[2]))
    ceiling = min(ceilings) if ceilings and not world.outdoor else None
    return Stage(tuple(rooms) or tuple(world.floors), ceiling)
