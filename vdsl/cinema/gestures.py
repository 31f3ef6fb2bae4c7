"""Whether one sees what hands do.

Assumes landmarks of a posed body. Hands that hang or swing beside it do nothing one has to see.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .framing import Array
from .subject import Subject
from .takes import Bools, Takes
from .vectors import dot, length

_HANGS = 0.26  # of the standing height from the collar down, as far as idle hands are at least
_CHEST = 0.075  # half of the trunk's breadth, of the standing height
#: Sizes that show hands at work.
_SHOW_HANDS = ("waist", "thigh", "knees", "feet")


def hands_missed(takes: Takes, subject: Subject, at: NDArray[np.int64], camera: Array, shown: Bools) -> Array:
    """Share [P] of the time a person's hands are at work, while the window is open, in which neither is seen.

    shown: [P, F, 2], left and right, whether they are in the frame and nothing but their own body hides them
    0 for sizes too close to show hands, for what is no person, and where hands do nothing.
    """
    if subject.kind != "person":
        return np.zeros(len(camera))
    marks = {name: subject.landmarks[name][at] for name in ("collar", "waist", "hand_l", "hand_r")}
    trunk = marks["waist"] - marks["collar"]
    down = trunk / np.maximum(length(trunk), 1e-6)[..., None]
    at_work, seen = [], []
    for side, name in enumerate(("hand_l", "hand_r")):
        works = dot(marks[name] - marks["collar"], down) < _HANGS * subject.height
        before = _apart(camera, marks[name][None], marks["collar"][None], trunk[None])
        at_work.append(works)
        seen.append(works[None] & shown[..., side] & (before > _CHEST * subject.height))
    asked = (at_work[0] | at_work[1])[None] & takes.window
    found = (seen[0] | seen[1]) & takes.window
    sizes = np.array([s.lower in _SHOW_HANDS for s in takes.sizes])
    missed = 1.0 - found.sum(axis=1) / np.maximum(asked.sum(axis=1), 1)
    return np.where(sizes & asked.any(axis=1), missed, 0.0)


def _apart(camera: Array, hand: Array, collar: Array, trunk: Array) -> Array:
    """Least distance [P, F] between the line from the camera to a hand, but for its end, and the trunk."""
    ray = 0.93 * (hand - camera)
    start = camera - collar
    a, e, f = dot(ray, ray), np.maximum(dot(trunk, trunk), 1e-9), dot(trunk, start)
    b, c = dot(ray, trunk), dot(ray, start)
    spread = np.maximum(a * e - b * b, 1e-9)
    along = np.clip((b * f - c * e) / spread, 0.0, 1.0)  # of the ray, where lines are nearest
    down = np.clip((b * along + f) / e, 0.0, 1.0)  # of the trunk
    along = np.clip((b * down - c) / np.maximum(a, 1e-9), 0.0, 1.0)
    return length(start + along[..., None] * ray - down[..., None] * trunk)
