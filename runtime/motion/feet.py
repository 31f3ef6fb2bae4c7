"""Feet over time: planted, rolling over the ball, swung, set down on the heel; on treads, or off the ground.

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
    """A foot (0 left, 1 right) leaves the floor at ``lift`` and lands at ``land`` on (x, y, yaw).

    run: 1 running, 0 walking; ground: height of what it lands on; pitch: heel up while it stands there
    high: metres it is swung higher; stiff: 0..1, how little it rolls; slide: turns on the ball without
        leaving the floor
    leap: metres the whole body is in the air meanwhile; tuck: metres the foot is drawn up to the body
    """

    foot: int
    lift: float
    land: float
    place: tuple[float, float, float]
    run: float = 0.0
    ground: float = 0.0
    pitch: float = 0.0
    high: float = 0.0
    stiff: float = 0.0
    slide: bool = False
    leap: float = 0.0
    tuck: float = 0.0


@dataclass(frozen=True)
class Footing:
    """How a foot stands before its first step: (x, y, yaw), height of the floor, heel up."""

    place: tuple[float, float, float]
    ground: float = 0.0
    pitch: float = 0.0


@dataclass(frozen=True, eq=False)
class Feet:
    """Both feet over T frames, [2, T]: ``place`` [2, T, 3] (x, y, yaw of the flat foot), heel-up pitch,
    lift off the floor, ``air``: 1 in the middle of a swing, 0 planted; run; height of the floor below."""

    place: Array
    pitch: Array
    lift: Array
    air: Array
    run: Array
    ground: Array


def foot_track(t: Array, first: Footing, steps: list[Step]) -> tuple[Array, ...]:
    """place [T, 3], pitch, lift, air, run, ground [T] of one foot."""
    places = np.array([first.place, *(s.place for s in steps)])
    places[:, 2] = np.unwrap(places[:, 2])
    if not steps:
        flat, zero = np.ones(len(t)), np.zeros(len(t))
        return np.repeat(places, len(t), 0), first.pitch * flat, zero, zero, zero, first.ground * flat
    names = ("lift", "land", "run", "high", "stiff", "leap", "tuck")
    lift, land, run, high, stiff, leap, tuck = (np.array([getattr(s, n) for s in steps]) for n in names)
    rest = np.array([first.pitch, *(s.pitch for s in steps)])
    ground = np.array([first.ground, *(s.ground for s in steps)])
    loose = np.array([0.0 if s.slide else 1.0 for s in steps])
    moved = np.linalg.norm(np.diff(places[:, :2], axis=0), axis=1)
    k = np.searchsorted(lift, t, side="right") - 1  # the step last begun
    now, upcoming = np.clip(k, 0, None), np.clip(k + 1, 0, len(steps) - 1)
    u = np.where(k >= 0, np.clip((t - lift[now]) / np.maximum(land - lift, 1e-6)[now], 0.0, 1.0), 0.0)
    go = ease((u - 0.05) / 0.89)  # up before forward, forward before down
    go = np.where(loose[now] > 0, go, ease(u))
    place = places[now] + (places[now + 1] - places[now]) * go[:, None]
    flat = (1.0 - stiff) * loose * np.clip(1.0 - 1.6 * np.maximum(rest[1:], rest[:-1]), 0.0, 1.0)
    off = np.clip(moved / 1.1, 0.15, 1.0) * (0.98 + 0.25 * run) * flat  # heel-off angle of each step
    strike = np.clip(moved / 1.2 - 0.15, 0.0, 1.0) * (0.34 - 0.2 * run) * flat * (leap <= 0)
    peel = np.where(run > 0, 0.16, 0.30)
    due = (k + 1 < len(steps)) & ((u >= 1) | (k < 0))
    rising = np.where(due, off[upcoming] * ease((t - lift[upcoming] + peel[upcoming]) / peel[upcoming]), 0.0)
    settle = np.where(k >= 0, -strike[now] * (1.0 - ramp(t - land[now], 0.0, 0.11)), 0.0)
    swing = off[now] * (1.0 - ease(u / 0.72)) - strike[now] * ease((u - 0.4) / 0.6)
    swing = swing + run[now] * 0.55 * np.clip(moved[now] / 1.8, 0, 1) * _bump(u, 0.32)
    swing = swing + np.where(leap[now] > 0, 0.6 * _bump(u, 0.5), 0.0)
    flying = (k >= 0) & (u < 1)
    pitch = np.where(flying, swing, rising + settle) + rest[now] + (rest[now + 1] - rest[now]) * ease(u)
    height = 0.022 + 0.03 * np.clip(moved, 0, 1.4) + run * 0.19 * np.clip(moved / 1.8, 0, 1) + high
    height = np.maximum(height, 0.012) * loose * (leap <= 0)
    climb = np.diff(ground)
    height = height + np.where(climb > 0, 0.5, 0.1) * np.abs(climb)
    up = height[now] * np.where(run[now] > 0, _bump(u, 0.40), _bump(u, 0.42))
    up = up + leap[now] * 4.0 * u * (1.0 - u) + tuck[now] * _bump(u, 0.5)
    up = np.where(flying, up, 0.0)
    air = np.where(flying, _bump(u, 0.5) * loose[now], 0.0)
    rise = np.where(ground[now + 1] > ground[now], ease(u / 0.6), ease((u - 0.35) / 0.6))
    floor = ground[now] + (ground[now + 1] - ground[now]) * rise
    return place, pitch, up, air, np.where(k >= 0, run[now], run[0]), floor


def _bump(u: Array, peak: float) -> Array:
    """0 at both ends with no slope, 1 at ``peak``."""
    v = np.where(u < peak, 0.5 * u / peak, 0.5 + 0.5 * (u - peak) / (1 - peak))
    return np.asarray(np.sin(np.pi * np.clip(v, 0, 1)) ** 2)


def rolled(skeleton: Skeleton, pitch: Array) -> tuple[Array, Array]:
    """How far an ankle goes forward and up when the foot rolls over ball (pitch above 0) or heel."""
    bind = skeleton.bind
    ankle_z = float(bind[JOINT["foot_l"]][2])
    ball = bind[JOINT["toe_l"]] - bind[JOINT["foot_l"]]
    c, s = np.cos(pitch), np.sin(pitch)
    lever_x = np.where(pitch > 0, ball[0], -0.30 * ball[0])
    lever_z = np.where(pitch > 0, ball[2], -ankle_z)
    return lever_x - (c * lever_x + s * lever_z), lever_z - (-s * lever_x + c * lever_z)


def ankle_positions(skeleton: Skeleton, feet: Feet) -> tuple[Array, Array]:
    """Ankles [2, T, 3] and toes' flex [2, T] of feet that roll over ball and heel without sliding."""
    dx, dz = rolled(skeleton, feet.pitch)
    yaw = feet.place[..., 2]
    x = feet.place[..., 0] + dx * np.cos(yaw)
    y = feet.place[..., 1] + dx * np.sin(yaw)
    z = feet.ground + float(skeleton.bind[JOINT["foot_l"]][2]) + dz + feet.lift
    flex = np.clip(feet.pitch, 0.0, 1.35) * np.clip((2.3 - feet.pitch) / 0.8, 0.0, 1.0)
    return np.stack([x, y, z], axis=-1), flex
