"""Whether one sees what hands do, how clearly, and whether they, the arms or what they hold are in the way of
the face.

Assumes landmarks of a posed body. Hands that hang or swing beside it do nothing one has to see.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from .framing import Array
from .subject import Subject, marks_at
from .takes import Bools, Picture, Takes, mean_of
from .vectors import clamped, dot, length

_HANGS = 0.26  # of the standing height from the collar down, as far as idle hands are at least
_CHEST = 0.075  # half of the trunk's breadth, of the standing height
#: How far beside the line from waist to chin a hand is in the picture that hardly stands out from the body,
#: and one that does so plainly, of the standing height.
_WITHIN, _PLAIN = 0.06, 0.24
#: Of an arm: its radius, and what a hand reaches beyond the wrist, of the standing height.
_ARM, _HAND = 0.026, 0.075
#: Metres before the face at which a line of sight ends: less is the skin itself.
_SKIN = 0.02
#: Directions to the sides of where a face points, radians, and metres from it, from which one tells how
#: little of it an action can cover.
_AROUND, _AWAY = np.radians((-60.0, -30.0, 0.0, 30.0, 60.0)), 2.0
_HANDS = ("hand_l", "hand_r")
#: Metres that hands at work go before one asks how much of that is seen.
_AN_ACT = 0.4
#: Sizes that show hands at work.
_SHOW_HANDS = ("waist", "thigh", "knees", "feet")


def hands_missed(takes: Takes, subject: Subject, at: NDArray[np.int64], camera: Array, shown: Bools) -> Array:
    """Share [P] of the time a person's hands are at work, while the window is open, in which neither is seen.

    shown: [P, F, 2], left and right, whether they are in the frame and nothing but their own body hides them
    0 for sizes too close to show hands, for what is no person, and where hands do nothing.
    """
    if subject.kind != "person":
        return np.zeros(len(camera))
    collar = subject.landmarks["collar"][at]
    trunk = subject.landmarks["waist"][at] - collar
    works, eye = at_work(subject, at), camera[:, :, None]
    hands = marks_at(subject, _HANDS, at)
    before = _apart(eye, 0.93 * (hands - eye), collar[:, None], trunk[:, None])
    seen = works & shown & (before > _CHEST * subject.height)
    asked = (works[:, 0] | works[:, 1]) & takes.window
    found = (seen[..., 0] | seen[..., 1]) & takes.window
    missed = 1.0 - found.sum(axis=1) / np.maximum(asked.sum(axis=1), 1)
    return np.where(_shows_hands(takes) & asked.any(axis=1), missed, 0.0)


def act_missed(subject: Subject, at: NDArray[np.int64], seen: Bools) -> Array:
    """Share [P] of the way a person's hands go at work, beside their body, on which nothing of that person is
    seen: of a camera that turns to somebody, how much of what they do is over by then.

    seen: bool [P, F, K], which of their points are in the frame and not hidden
    0 for what is no person, and where hands hardly move
    """
    if subject.kind != "person":
        return np.zeros(len(seen))
    works, body = at_work(subject, at), subject.landmarks["pocket"][at]
    hands = marks_at(subject, _HANDS, at) - body[:, None]
    steps = length(np.diff(hands, axis=0)) * (works[1:] | works[:-1])
    steps = steps.max(axis=1, initial=0.0)
    if steps.sum() < _AN_ACT:
        return np.zeros(len(seen))
    way = np.append(steps, 0.0) + np.append(0.0, steps)  # at every frame, there and back: twice
    return np.asarray((~seen.any(axis=2) * way).sum(axis=1) / way.sum())


def gesture_lost(
    takes: Takes, subject: Subject, at: NDArray[np.int64], picture: Picture, shown: Bools
) -> Array:
    """How little [P] of a person's hands at work stands out from the body in the picture, as silhouettes are
    judged: 0 where one of them is plainly beside it all the time, 1 where both are before it, hidden or out
    of the frame.

    shown: [P, F, 2] as above. 0 for sizes too close to show hands, for what is no person, and where hands do
    nothing.
    """
    if subject.kind != "person":
        return np.zeros(len(picture.xy))
    works = at_work(subject, at)
    # metres across the picture at the body's distance
    depth = np.maximum(picture.depth[:, :, picture.names.index("pocket")], 0.05)
    metres = depth[..., None] * np.array(takes.track.sensor) / takes.track.focal[:, at, None]
    waist, chin = picture.of("waist") * metres, picture.of("chin") * metres
    clear = np.zeros(depth.shape)
    for side, name in enumerate(_HANDS):
        beside = _off(picture.of(name) * metres, waist, chin) / subject.height
        plain = clamped((beside - _WITHIN) / (_PLAIN - _WITHIN), 0.0, 1.0)
        clear = np.maximum(clear, np.where(works[:, side] & shown[..., side], plain, 0.0))
    asked = (works[:, 0] | works[:, 1]) & takes.window
    return np.where(_shows_hands(takes) & asked.any(axis=1), 1.0 - mean_of(clear, asked), 0.0)


def at_work(subject: Subject, at: NDArray[np.int64]) -> Bools:
    """Whether the left hand and the right one are higher than hands that hang, bool [F, 2]; not to be
    written to."""
    return _at_work(subject, tuple(at.tolist()))


@lru_cache(maxsize=64)
def _at_work(subject: Subject, frames: tuple[int, ...]) -> Bools:
    at = np.array(frames)
    collar = subject.landmarks["collar"][at]
    trunk = subject.landmarks["waist"][at] - collar
    down = trunk / np.maximum(length(trunk), 1e-6)[..., None]
    hands = marks_at(subject, _HANDS, at) - collar[:, None]
    along: Array = dot(hands, down[:, None])
    return np.asarray(along < _HANGS * subject.height)


def _shows_hands(takes: Takes) -> Bools:
    """Which takes [P] are of a size that shows hands at work."""
    return np.array([s.lower in _SHOW_HANDS for s in takes.sizes])


def _off(point: Array, begin: Array, end: Array) -> Array:
    """Distance [P, F] of points [P, F, 2] to lines from ``begin`` to ``end``."""
    way = end - begin
    along = clamped(dot(point - begin, way) / np.maximum(dot(way, way), 1e-9), 0.0, 1.0)
    return length(point - begin - along[..., None] * way)


def face_covered(takes: Takes, subject: Subject, at: NDArray[np.int64], camera: Array) -> Array:
    """Share [P] of a person's face, while the window is open, that their own arms and hands hide, what these
    hold, or, looked at from below, their chest, beyond what they hide from everywhere before it: who buries
    the face in the hands cannot be seen otherwise.

    Asked of eyes and nose. 0 for what is no person.
    """
    if subject.arms is None:
        return np.zeros(len(camera))
    hidden = _face_hidden(subject, at, camera).mean(axis=-1)
    return mean_of(np.maximum(hidden - _least_hidden(subject, tuple(at.tolist())), 0.0), takes.window)


def _face_hidden(subject: Subject, at: NDArray[np.int64], camera: Array) -> Bools:
    """Which of eyes and nose are hidden from cameras [P, F, 3], [P, F, 2]."""
    assert subject.arms is not None
    face = subject.face[at]
    points = marks_at(subject, ("eyes", "nose"), at)
    behind = _behind_arms(camera, points, subject.arms[at], subject.height)
    chest = subject.landmarks["waist"][at], subject.landmarks["pocket"][at]
    behind |= _behind_chest(camera, points, face, *chest, subject.height)
    for box in subject.in_hand:
        behind |= box.before(at, camera, points, _SKIN)
    return behind


@lru_cache(maxsize=64)  # asked for again for every few cameras
def _least_hidden(subject: Subject, frames: tuple[int, ...]) -> Array:
    """The least share of a face that is hidden from anywhere before it, [F]; not to be written to."""
    at = np.array(frames)
    face = subject.face[at]
    cos, sin = np.cos(_AROUND)[:, None], np.sin(_AROUND)[:, None]
    around = [cos * face[:, 0] - sin * face[:, 1], sin * face[:, 0] + cos * face[:, 1]]
    level = np.stack([*around, np.broadcast_to(face[:, 2], around[0].shape)], axis=-1)
    before = subject.landmarks["eyes"][at] + _AWAY * level
    return np.asarray(_face_hidden(subject, at, before).mean(axis=-1).min(axis=0))


def _behind_arms(camera: Array, points: Array, arms: Array, height: float) -> Bools:
    """Which of points [F, K, 3] a body's arms [F, 2, 3, 3] hide from cameras [P, F, 3], [P, F, K]."""
    upper, lower = arms[:, :, 1] - arms[:, :, 0], arms[:, :, 2] - arms[:, :, 1]
    reach = 1.0 + _HAND * height / np.maximum(length(lower), 1e-6)
    begins = np.concatenate([arms[:, :, 0], arms[:, :, 1]], axis=1)[None, :, None]  # [1, F, 1, limbs, 3]
    limbs = np.concatenate([upper, reach[..., None] * lower], axis=1)[None, :, None]
    rays = points - camera[:, :, None]
    rays = rays * np.maximum(1.0 - _SKIN / np.maximum(length(rays), 1e-6), 0.0)[..., None]
    away = _apart(camera[:, :, None, None], rays[..., None, :], begins, limbs)
    return np.asarray((away < _ARM * height).any(axis=-1))


def _behind_chest(
    camera: Array, points: Array, face: Array, waist: Array, chest: Array, height: float
) -> Bools:
    """Which of points [F, K, 3] of a face that is turned to cameras [P, F, 3] the own trunk hides, from waist
    [F, 3] to chest [F, 3]: [P, F, K]."""
    rays = points - camera[:, :, None]
    away = _apart(camera[:, :, None], rays, waist[:, None], (chest - waist)[:, None])
    return np.asarray((away < _CHEST * height) & (dot(rays, face[:, None]) < 0.0))


def _apart(camera: Array, ray: Array, begin: Array, limb: Array) -> Array:
    """Least distance [P, F, ...] between lines of sight [P, F, ..., 3] from cameras and limbs from where they
    begin."""
    start = camera - begin
    a, e, f = dot(ray, ray), np.maximum(dot(limb, limb), 1e-9), dot(limb, start)
    b, c = dot(ray, limb), dot(ray, start)
    spread = np.maximum(a * e - b * b, 1e-9)
    along = clamped((b * f - c * e) / spread, 0.0, 1.0)  # of the ray, where lines are nearest
    down = clamped((b * along + f) / e, 0.0, 1.0)  # of the limb
    along = clamped((b * down - c) / np.maximum(a, 1e-9), 0.0, 1.0)
    return length(start + along[..., None] * ray - down[..., None] * limb)
