"""Things over time: lying, held, passed on, put down."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from runtime.body.skeleton import JOINT

from .contacts import SIDE, HandTracks
from .curves import ramp
from .figure import Figure
from .held import Held
from .rotations import blend
from .types import Point, PropState

Array = NDArray[np.float64]
GRAVITY = 9.81


@dataclass(frozen=True)
class Hold:
    """A hand holds a thing from ``start`` to ``end`` (±1e9: all along), then it stands at ``place``; if it
    was thrown, after ``flight`` seconds in the air. ``hand`` is empty for what is only sent off, from
    where it lies."""

    person: str
    hand: str
    start: float
    end: float
    place: Point | None
    flight: float = 0.0


def track_prop(
    prop: PropState,
    holds: list[Hold],
    t: Array,
    palms: dict[str, Array],
    figures: dict[str, Figure],
    tracks: dict[str, HandTracks],
    goals: dict[str, Array],
) -> Array:
    """world_from_object [T, 4, 4] of one thing.

    While held its grip is at the palm and it turns with the hand; taking and putting down are eased over
    a fraction of a second in which the hand stands still at it.
    """
    frames = len(t)
    if not holds:
        return np.repeat(prop.world_from_object[None], frames, axis=0)
    position = np.broadcast_to(prop.world_from_object[:3, 3], (frames, 3)).copy()
    rotation = np.broadcast_to(prop.world_from_object[:3, :3], (frames, 3, 3)).copy()
    grip = np.asarray(prop.grip, dtype=np.float64)
    for n, hold in enumerate(holds):
        if hold.person not in figures:
            continue
        if not hold.hand:
            stop = min(int(np.searchsorted(t, hold.end)), frames - 1)
            u = (t[stop:] - hold.end) / hold.flight
            position[stop:] = _thrown(position[stop], np.asarray(hold.place), u, hold.flight)
            continue
        k = SIDE[hold.hand]
        start = int(np.clip(np.searchsorted(t, hold.start), 0, frames - 1))
        held = Held(hold.start, rotation[start], grip)
        wished = tracks[hold.person].held_rotation(k, held)
        hand = figures[hold.person].rotation[:, JOINT[f"hand_{hold.hand}"]]
        turned = hand @ np.swapaxes(goals[hold.person][k], -1, -2) @ wished
        turned = blend(turned, wished, tracks[hold.person].wield.weight[k])
        at = palms[hold.person][k] - turned @ grip
        share = ramp(t, hold.start - 0.04, hold.start + 0.26)
        position = position + share[:, None] * (at - position)
        rotation = blend(rotation, turned, share)
        if hold.flight > 0:
            catcher = holds[n + 1] if n + 1 < len(holds) else None
            palm = palms[catcher.person][SIDE[catcher.hand]] if catcher is not None else None
            stop = min(int(np.searchsorted(t, hold.end)), frames - 1)
            landing = min(int(np.searchsorted(t, hold.end + hold.flight)), frames - 1)
            goal = np.asarray(hold.place) if palm is None else palm[landing] - rotation[stop] @ grip
            position[stop:] = _thrown(position[stop], goal, (t[stop:] - hold.end) / hold.flight, hold.flight)
            standing = np.broadcast_to(_upright(rotation[stop]), rotation.shape)
            rotation = blend(rotation, standing, ramp(t, hold.end, hold.end + hold.flight))
        elif hold.end < 1e8 and hold.place is not None:
            share = ramp(t, hold.end - 0.2, hold.end + 0.02)
            standing = _upright(rotation[min(int(np.searchsorted(t, hold.end)), frames - 1)])
            position = position + share[:, None] * (np.asarray(hold.place) - position)
            rotation = blend(rotation, np.broadcast_to(standing, rotation.shape), share)
        elif hold.end < 1e8:
            stop = min(int(np.searchsorted(t, hold.end)), frames - 1)
            position[stop:], rotation[stop:] = position[stop], rotation[stop]
    out = np.zeros((frames, 4, 4))
    out[:, :3, :3], out[:, :3, 3], out[:, 3, 3] = rotation, position, 1.0
    return out


def _thrown(start: Array, goal: Array, u: Array, flight: float) -> Array:
    """Places [T, 3] on the way of what falls freely from ``start`` to ``goal`` in ``flight`` seconds."""
    u = np.clip(u, 0.0, 1.0)[:, None]
    fall = np.array([0.0, 0.0, 0.5 * GRAVITY * flight**2])
    return np.asarray(start + u * (goal - start) + u * (1.0 - u) * fall)


def _upright(rotation: Array) -> Array:
    """The nearest rotation about Z alone."""
    yaw = np.arctan2(rotation[1, 0] - rotation[0, 1], rotation[0, 0] + rotation[1, 1])
    c, s = np.cos(yaw), np.sin(yaw)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
