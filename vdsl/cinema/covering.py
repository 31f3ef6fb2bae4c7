"""Who stands before whom in the picture: heads and bodies of several people, as cameras see them.

Assumes points in metres aside and down at a metre's distance (:func:`spread`), so that what is one metre
large is ``1 / depth`` there.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from .framing import Array
from .subject import Subject
from .takes import Bools, Takes, within
from .track import project
from .vectors import length

#: Metres before the camera from which on somebody is in its picture.
BEFORE = 0.2
_HEAD = 0.11  # half a head's width and its hair, metres
#: Half the width of a trunk, and of one with its arms and some air beside it, metres.
TRUNK, _AIR = 0.18, 0.42
#: Of the length of a body in the picture, how far the chests of two are apart of whom none covers the other,
#: one above the other; and the least of that, metres, as from overhead.
_TALL, _FLAT = 0.65, 0.4
#: Heights of a head between two of them that are apart; the least such height, as from overhead, metres.
_AIR_OF_HEADS, _FROM_ABOVE = 3.0, 0.2


@dataclass(frozen=True, eq=False)
class Crowd:
    """K people in the pictures of P takes: [P, F, K, 2] each, as :func:`spread` has them; depth: of their
    chests, head: of their eyes, [P, F, K]; inside: [P, F, K], whose chests are in the frame."""

    eyes: Array
    crowns: Array
    chins: Array
    feet: Array
    chests: Array
    head: Array
    depth: Array
    inside: Bools

    @cached_property
    def behind(self) -> tuple[Bools, Array]:
        """:func:`behind_bodies`, which is asked for more than once."""
        return behind_bodies(self)


def crowd_of(
    takes: Takes, people: tuple[Subject, ...], at: NDArray[np.int64], camera: Array, axes: Array
) -> Crowd:
    """Where people are in the pictures of the frames ``at``."""
    focal, names, count = takes.track.focal[:, at], ("eyes", "crown", "chin", "feet", "pocket"), len(people)
    points = np.stack([one.landmarks[name][at] for name in names for one in people], axis=1)
    xy, depth = project(points[None], camera, axes, focal, takes.track.sensor)
    chests = depth[..., -count:]
    inside = within(xy[..., -count:, :], chests, 0.0)
    marks = spread(xy, focal, takes.track.sensor)
    eyes, crowns, chins, feet, chest = np.split(marks, len(names), axis=2)
    return Crowd(eyes, crowns, chins, feet, chest, depth[..., :count], chests, inside)


def spread(xy: Array, focal: Array, sensor: tuple[float, float]) -> Array:
    """Picture coordinates [P, F, K, 2] in metres aside and down at a metre's distance."""
    return np.asarray(xy * (np.array(sensor) / focal[..., None])[:, :, None])


def behind_heads(xy: Array, depth: Array, feet: Array | None = None) -> Bools:
    """Which heads are behind another one, or behind its shoulders: [P, F, K]. xy: [P, F, K, 2], metres aside
    and down at a metre's distance; depth: [P, F, K]; feet: [P, F, K, 2], how far down each one's body goes,
    None for all the way"""
    wide = _HEAD / np.maximum(depth, 0.1)
    aside = np.abs(xy[..., :, None, 0] - xy[..., None, :, 0])  # [P, F, of this head, by that one]
    over = xy[..., None, :, 1] - xy[..., :, None, 1]
    nearer = (depth[..., None, :] < depth[..., :, None] - 0.1) & (depth[..., None, :] > BEFORE)
    if feet is not None:
        nearer &= feet[..., None, :, 1] > xy[..., :, None, 1]
    covered = nearer & (aside < wide[..., None, :] + 0.5 * wide[..., :, None]) & (over < wide[..., None, :])
    return np.asarray(covered.any(axis=-1))


def behind_bodies(crowd: Crowd) -> tuple[Bools, Array]:
    """Which people's heads are behind the head or the body of somebody nearer, and what share of the breadth
    of their trunks is behind such a body: [P, F, K] each."""
    half = TRUNK / np.maximum(crowd.depth, BEFORE)
    nearer = _nearer(crowd)
    x, y, top = crowd.chests[..., 0], crowd.chests[..., 1], crowd.crowns[..., 1]
    low, high = x - half, x + half
    last, first = high[..., :, None], low[..., :, None]
    both = np.minimum(last, high[..., None, :]) - np.maximum(first, low[..., None, :])
    share = np.clip(both / (2.0 * half[..., :, None]), 0.0, 1.0)
    ends = crowd.feet[..., None, :, 1]
    over = nearer & (top[..., None, :] < y[..., :, None]) & (ends > y[..., :, None])
    hidden = (share * over).max(axis=-1)
    eyes = crowd.eyes
    aside, high = np.abs(eyes[..., :, None, 0] - x[..., None, :]), eyes[..., :, None, 1]
    trunk = nearer & (aside < half[..., None, :]) & (y[..., None, :] < high) & (ends > high)
    headless = behind_heads(eyes, crowd.head, crowd.feet) | trunk.any(axis=-1)
    return np.asarray(headless), np.asarray(hidden)


def covered(crowd: Crowd) -> Array:
    """How far somebody nearer stands before each of people [P, F, K], by where their chests are in the
    picture: 0 for side by side, 1 for straight behind."""
    return _lapped(crowd, _nearer(crowd), TRUNK)


def crowded(crowd: Crowd, there: Array) -> Array:
    """How little people stand apart from each other in the picture, of those worst off [P, F]: 0 with air
    between them, 1 for one straight behind another, over whom the head still looks out. there: [P, F, K], how
    much each counts, 0 for who is not to be seen"""
    others = ~np.eye(there.shape[-1], dtype=bool)
    pairs = np.minimum(there[..., :, None], there[..., None, :]) * others
    return np.asarray(_lapped(crowd, pairs, _AIR).max(axis=-1))


def lapped_heads(crowd: Crowd, there: Bools) -> Array:
    """How near two heads are to each other in the picture, beside each other, of those that are nearest
    [P, F]: 0 from :data:`_AIR_OF_HEADS` heights of the larger one on, and for one so far over the other that
    bodies do not meet, 1 for one behind the other. there: [P, F, K], who is in it"""
    scale = 1.0 / np.maximum(crowd.depth, BEFORE)
    large = np.maximum(length(crowd.crowns - crowd.chins), _FROM_ABOVE * scale)
    high = _one_over_the_other(crowd)
    aside, above = np.moveaxis(np.abs(crowd.eyes[..., :, None, :] - crowd.eyes[..., None, :, :]), -1, 0)
    larger, higher = (np.maximum(of[..., :, None], of[..., None, :]) for of in (large, high))
    both = there[..., :, None] & there[..., None, :] & ~np.eye(there.shape[-1], dtype=bool)
    near = np.clip(1.0 - aside / (_AIR_OF_HEADS * larger), 0.0, 1.0) * (above < higher) * both
    return np.asarray(near.max(axis=(-1, -2)))


def _one_over_the_other(crowd: Crowd) -> Array:
    """How far one is over another in the picture, [P, F, K], whose bodies do not meet."""
    long = np.abs(crowd.feet[..., 1] - crowd.crowns[..., 1])
    return np.asarray(np.maximum(_TALL * long, _FLAT / np.maximum(crowd.depth, BEFORE)))


def _nearer(crowd: Crowd) -> Bools:
    """Whom [P, F, of these, by those] somebody nearer may stand before."""
    depth = crowd.depth
    return np.asarray((depth[..., None, :] < depth[..., :, None]) & (depth[..., None, :] > BEFORE))


def _lapped(crowd: Crowd, pairs: Array | Bools, half: float) -> Array:
    """How far bodies of so many metres to each side lap, by pairs [P, F, K, K]: of each the most."""
    scale = 1.0 / np.maximum(crowd.depth, BEFORE)  # of metres there
    wide, high = half * scale, _one_over_the_other(crowd)
    x, y = crowd.chests[..., 0], crowd.chests[..., 1]
    beside = np.abs(x[..., :, None] - x[..., None, :]) / (wide[..., :, None] + wide[..., None, :])
    above = np.abs(y[..., :, None] - y[..., None, :]) / high[..., None, :]
    over = np.clip(1.0 - beside, 0.0, 1.0) * np.clip(1.0 - above, 0.0, 1.0) * pairs
    return np.asarray(over.max(axis=-1))
