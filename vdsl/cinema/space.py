"""Room for the camera itself: distances to solids, people, floor, ceiling and the edge of the set."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from runtime.world import Solids, World

from .vectors import clamped, dot, length

Array = NDArray[np.float64]

_AT_ONCE = 1 << 14  # numbers of cameras past pillars at a time: more no longer lie in a core's own cache
REACH = 1.0  # metres up to which clearance is measured


@dataclass(frozen=True, eq=False)
class Clearance:
    """Least distances over a take, [P], capped at :data:`REACH`; negative inside.

    object: to furniture and other things; shown: to walls that are drawn; wall: to any wall
    """

    object: Array
    shown: Array
    wall: Array


@dataclass(frozen=True, eq=False)
class Nearby:
    """Boxes close to cameras, as M pairs: take [M], box [M], and the least distance over the frames [M].

    count: how many takes there are; a pair's distance may be over :data:`REACH`, those closer are all there
    """

    count: int
    take: NDArray[np.int64]
    box: NDArray[np.int64]
    away: Array

    def only(self, rows: NDArray[np.int64]) -> Nearby:
        """Of some of the takes (rows in rising order)."""
        number = np.full(self.count, -1)
        number[rows] = np.arange(len(rows))
        kept = number[self.take] >= 0
        return Nearby(len(rows), number[self.take[kept]], self.box[kept], self.away[kept])


def nearby(solids: Solids, camera: Array) -> Nearby:
    """The boxes near cameras [P, F, 3]."""
    P, F = camera.shape[:2]
    points = camera.reshape(-1, 3)
    if not len(solids.centre) or not len(points):
        return Nearby(P, np.zeros(0, np.int64), np.zeros(0, np.int64), np.zeros(0))
    low, high = points.min(axis=0) - REACH, points.max(axis=0) + REACH
    radius = solids.radius
    kept = np.flatnonzero(
        ((solids.centre + radius[:, None] > low) & (solids.centre - radius[:, None] < high)).all(axis=1)
    )
    n, k = np.nonzero(_close(points, solids.centre[kept], radius[kept] + REACH))
    b = kept[k]
    d = points[n] - solids.centre[b]
    c, s = (of[b] for of in solids.turn)
    half = solids.half[b]
    x = np.abs(c * d[:, 0] + s * d[:, 1]) - half[:, 0]
    y = np.abs(c * d[:, 1] - s * d[:, 0]) - half[:, 1]
    z = np.abs(d[:, 2]) - half[:, 2]
    outside = np.sqrt(np.maximum(x, 0.0) ** 2 + np.maximum(y, 0.0) ** 2 + np.maximum(z, 0.0) ** 2)
    away = outside + np.minimum(np.maximum(np.maximum(x, y), z), 0.0)
    best = np.full((P, len(kept)), np.inf)
    np.minimum.at(best, (n // F, k), away)
    take, k = np.nonzero(best < REACH)
    return Nearby(P, take, kept[k], best[take, k])


def _close(points: Array, centres: Array, reach: Array) -> NDArray[np.bool_]:
    """[N, B]: points no farther from centres than ``reach`` [B]; axis by axis, in single precision."""
    p, c = points.astype(np.float32), centres.astype(np.float32)
    square = np.zeros((len(p), len(c)), np.float32)
    for axis in range(3):
        gap = p[:, axis, None] - c[:, axis]
        gap *= gap
        square += gap
    return np.asarray(square < (reach**2).astype(np.float32))


def clearance(solids: Solids, near: Nearby, hidden: NDArray[np.bool_]) -> Clearance:
    """Clearance of takes; hidden: [P, W] walls taken away."""
    best = [np.full(near.count, REACH) for _ in range(3)]
    wall = solids.wall[near.box]
    gone = np.zeros(len(wall), bool)
    if hidden.shape[1]:
        gone = (wall >= 0) & hidden[near.take, np.maximum(wall, 0)]
    for out, chosen in zip(best, (wall < 0, (wall >= 0) & ~gone, wall >= 0), strict=True):
        np.minimum.at(out, near.take[chosen], near.away[chosen])
    return Clearance(*best)


def to_people(camera: Array, bodies: list[tuple[Array, Array, float]]) -> Array:
    """Least distance [P] from cameras [P, F, 3] to pillars (foot [F, 3], crown [F, 3], radius), or to such as
    every take has its own of, [P, F, 3]."""
    best = np.full(len(camera), REACH)
    at_once = max(_AT_ONCE // max(camera.size, 1), 1)
    for begin in range(0, len(bodies), at_once):
        some = bodies[begin : begin + at_once]
        foot, crown = (np.array([body[k] for body in some]) for k in (0, 1))
        if foot.ndim == 3:
            foot, crown = foot[:, None], crown[:, None]  # [B, 1, F, 3]
        axis, start = crown - foot, camera - foot
        t = clamped(dot(start, axis) / np.maximum(dot(axis, axis), 1e-9), 0.0, 1.0)
        radius = np.array([body[2] for body in some])[:, None, None]
        away = length(start - t[..., None] * axis) - radius
        np.minimum(best, away.min(axis=(0, 2)), out=best)
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
    rooms, ceilings = [], list[tuple[float, float]]()
    for item in world.objects:
        if item.kind not in ("room", "area"):
            continue
        low, high = np.array(item.low), np.array(item.high)
        if ((places >= low - 0.1) & (places <= high + np.array((0.1, 0.1, -0.1)))).all(axis=1).any():
            rooms.append((low[0], low[1], high[0], high[1]))
            if item.kind == "room" and high[2] - low[2] > 2.0:
                ceilings.append((float(low[2]), float(high[2])))
    ceiling = None
    if ceilings and not world.outdoor:  # of rooms above each other, that of the upper one
        ceiling = min(high for low, high in ceilings if low > max(ceilings)[0] - 1.0)
    return Stage(tuple(rooms) or tuple(world.floors), ceiling)
