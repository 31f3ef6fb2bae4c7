"""Feet over time: planted, rolling over the ball, swung, set down on the heel.

Assumes steps in order of time for each foot. Guarantees that a foot does not move between landing and
lifting, however it rolls.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from runtime.body.skeleton import JOINT, Skeleton

from .curves import ease, ramp

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Step:
    """A foot (0 left, 1 right) leaves the floor at ``lift`` and lands at ``land`` on (x, y, yaw)."""

    foot: int
    lift: float
    land: float
    place: tuple[float, float, float]
    run: float  # 1 running, 0 walking


@dataclass(frozen=True, eq=False)
class Feet:
    """Both feet over T frames, [2, T]: ``place`` [2, T, 3] (x, y, yaw of the flat foot), heel-up pitch,
    lift off the floor, toes' flex, and ``air``: 1 in the middle of a swing, 0 planted."""

    place: Array
    pitch: Array
    lift: Array
    air: Array
    run: Array


def foot_track(
    t: Array, first: tuple[float, float, float], steps: list[Step]
) -> tuple[Array, Array, Array, Array, Array]:
    """place [T, 3], pitch, lift, air, run [T] of one foot."""
    places = np.array([first, *(s.place for s in steps)])
    places[:, 2] = np.unwrap(places[:, 2])
    if not steps:
        zero = np.zeros(len(t))
        return np.repeat(places, len(t), 0), zero, zero, zero, zero
    lift = np.array([s.lift for s in steps])
    land = np.array([s.land for s in steps])
    run = np.array([s.run for s in steps])
    moved = np.linalg.norm(np.diff(places[:, :2], axis=0), axis=1)
    k = np.searchsorted(lift, t, side="right") - 1  # the step last begun
    now, upcoming = np.clip(k, 0, None), np.clip(k + 1, 0, len(steps) - 1)
    u = np.where(k >= 0, np.clip((t - lift[now]) / (land - lift)[now], 0.0, 1.0), 0.0)
    go = ease((u - 0.05) / 0.89)  # up before forward, forward before down
    place = places[now] + (places[now + 1] - places[now]) * go[:, None]
    off = np.clip(moved / 1.1, 0.15, 1.0) * (0.98 + 0.25 * run)  # heel-off angle of each step
    strike = np.clip(moved / 1.2 - 0.15, 0.0, 1.0) * (0.34 - 0.2 * run)
    peel = np.where(run > 0, 0.16, 0.30)
    due = (k + 1 < len(steps)) & ((u >= 1) | (k < 0))
    rising = np.where(due, off[upcoming] * ease((t - lift[upcoming] + peel[upcoming]) / peel[upcoming]), 0.0)
    settle = np.where(k >= 0, -strike[now] * (1.0 - ramp(t - land[now], 0.0, 0.11)), 0.0)
    swing = off[now] * (1.0 - ease(u / 0.72)) - strike[now] * ease((u - 0.4) / 0.6)
    swing = swing + run[now] * 0.55 * np.clip(moved[now] / 1.8, 0, 1) * _bump(u, 0.32)
    flying = (k >= 0) & (u < 1)
    pitch = np.where(flying, swing, rising + settle)
    height = 0.022 + 0.03 * np.clip(moved, 0, 1.4) + run * 0.19 * np.clip(moved / 1.8, 0, 1)
    up = np.where(flying, height[now] * np.where(run[now] > 0, _bump(u, 0.40), _bump(u, 0.42)), 0.0)
    air = np.where(flying, _bump(u, 0.5), 0.0)
    return place, pitch, up, air, np.where(k >= 0, run[now], run[0])


def _bump(u: Array, peak: float) -> Array:
    """0 at both ends with no slope, 1 at ``peak``."""
    v = np.where(u < peak, 0.5 * u / peak, 0.5 + 0.5 * (u - peak) / (1 - peak))
    return np.asarray(np.sin(np.pi * np.clip(v, 0, 1)) ** 2)


def ankle_positions(skeleton: Skeleton, feet: Feet, floor: float) -> tuple[Array, Array]:
    """Ankles [2, T, 3] and toes' flex [2, T] of feet that roll over ball and heel without sliding."""
    bind = skeleton.bind
    ankle_z = float(bind[JOINT["foot_l"]][2])
    ball = bind[JOINT["toe_l"]] - bind[JOINT["foot_l"]]
    heel = np.array([-0.30 * ball[0], 0.0, -ankle_z])
    p = feet.pitch
    c, s = np.cos(p), np.sin(p)
    lever_x = np.where(p > 0, ball[0], heel[0])
    lever_z = np.where(p > 0, ball[2], heel[2])
    dx = lever_x - (c * lever_x + s * lever_z)
    dz = lever_z - (-s * lever_x + c * lever_z)
    yaw = feet.place[..., 2]
    x = feet.place[..., 0] + dx * np.cos(yaw)
    y = feet.place[..., 1] + dx * np.sin(yaw)
    z = floor + ankle_z + dz + feet.lift
    return np.stack([x, y, z], axis=-1), np.maximum(p, 0.0)
