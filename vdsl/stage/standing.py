"""Where a person can stand: free of everything solid, with room around, on a floor.

The same rule as navigation's: a solid is in the way when it rises above 0.1 m and starts below 1.8 m.
"""

from __future__ import annotations

import math

import numpy as np

from runtime.world import Level, Solids, Spot

BODY_RADIUS = 0.25
LOW, HIGH = 0.1, 1.8
_STEPS = (0.0, 0.08, 0.16, 0.25, 0.35, 0.5, 0.7)


def level_of(levels: tuple[Level, ...], z: float) -> Level | None:
    """The level a height belongs to: the highest that is not above it, else the lowest."""
    under = [level for level in levels if level.height <= z + 0.3]
    return under[-1] if under else (levels[0] if levels else None)


def is_clear(x: float, y: float, solids: Solids, level: Level, radius: float = BODY_RADIUS) -> bool:
    """Whether a body of that radius fits at (x, y), metres, on a level."""
    if not any(x0 <= x <= x1 and y0 <= y <= y1 for x0, y0, x1, y1 in level.floors):
        return False
    bottom = solids.centre[:, 2] - solids.half[:, 2] - level.height
    top = solids.centre[:, 2] + solids.half[:, 2] - level.height
    near = (top > LOW) & (bottom < HIGH)
    dx, dy = x - solids.centre[near, 0], y - solids.centre[near, 1]
    c, s = np.cos(solids.yaw[near]), np.sin(solids.yaw[near])
    gap_x = np.abs(c * dx + s * dy) - solids.half[near, 0]
    gap_y = np.abs(-s * dx + c * dy) - solids.half[near, 1]
    distance = np.hypot(np.maximum(gap_x, 0.0), np.maximum(gap_y, 0.0))
    return bool((distance >= radius).all())


def clear_spot(
    spot: Spot, solids: Solids, levels: tuple[Level, ...], radius: float = BODY_RADIUS + 0.02
) -> Spot | None:
    """The spot, or the nearest free place a little back and to the side of it on its level, or None."""
    level = level_of(levels, spot.position[2])
    if level is None:
        return None
    facing = 0.0 if spot.facing is None else spot.facing
    ahead = (math.cos(facing), math.sin(facing))
    shifts = sorted(
        ((b, s * k) for b in _STEPS for s in _STEPS for k in (1, -1)), key=lambda o: abs(o[0]) + abs(o[1])
    )
    for back, side in shifts:
        x = spot.position[0] - back * ahead[0] - side * ahead[1]
        y = spot.position[1] - back * ahead[1] + side * ahead[0]
        if is_clear(x, y, solids, level, radius):
            return Spot(spot.name, (x, y, level.height), spot.facing)
    return None
