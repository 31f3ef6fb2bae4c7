"""Whether one reads at a glance who is there: heads seen, faces turned to the camera and large enough, people
apart from each other, hands in the picture.

Assumes a subject that knows its company. Eyes that were asked which of two takes of a line is the better one
went by this more than by where in the frame a head is (docs/ranker.md).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .bodies import behind_own_back
from .covering import Crowd, lapped_heads
from .framing import Array
from .looking import Sight
from .sizes import Size
from .subject import Subject, marks_at
from .takes import Bools, Takes, remembered, turned, within
from .track import project
from .vectors import length

_HEAD = ("crown", "eyes", "chin")
_HANDS = ("hand_l", "hand_r")
_MARKS = (*_HEAD, "pocket", *_HANDS)  # what is looked for of everybody
_OF_HEAD = np.isin(_MARKS, _HEAD)
#: Share of the frame's height from which on a head is large enough to be read; and, of sizes that show a
#: whole body or a place, metres that come to as much: a third more than a head, so that nearer is better.
_LARGE, _TALL = 0.15, 0.32
#: Share of a head from which on it is taken for shown.
_MOST_OF_IT = 0.6
#: Share of the frame along its borders in which no mark of a head is taken for seen: it would only touch it.
_BORDER = 0.015
#: Cosines to the camera between which a face is read ever better: from behind to three-quarter.
_BEHIND, _THREE_QUARTER = -0.75, 0.7


def facing(cosine: Array | float) -> Array:
    """How well a face is seen that is turned so to the camera: 0 from behind to 1 from three-quarter."""
    return np.asarray(np.clip((np.asarray(cosine) - _BEHIND) / (_THREE_QUARTER - _BEHIND), 0.0, 1.0))


def legibility(
    takes: Takes,
    subject: Subject,
    at: NDArray[np.int64],
    camera: Array,
    axes: Array,
    looks: Sight,
    crowd: Crowd | None,
) -> dict[str, Array]:
    """Measures [P] of how well one reads who is there; of a thing, or without people, nothing is missed.

    ``legible``: how well the face of whom it is about is read: how much of the head is seen, times how it is
    turned, times how large it is, of several the mean; the last frame for more. ``hands_shown``: share of the
    middle of the time in which one of their hands is seen. ``heads``: share of everybody, over all the time,
    whose head is seen. ``together``: how near two heads are to each other in the picture, when they are
    furthest apart or but one is in it. In a place people count while they are in it.

    crowd: of everybody, None for nobody
    """
    own = subject.own
    people = subject.everybody
    if crowd is None:
        nothing = np.zeros(len(camera))
        return {name: nothing + 1.0 for name in ("legible", "hands_shown", "heads")} | {"together": nothing}
    here = np.ones((len(at), len(people)), bool)
    if not own:
        here = np.stack([subject.holds(one)[at] for one in people], axis=1)
    there = _marks(takes, people, at, camera, axes, looks, len(own))  # who hides the company is asked below
    there &= here[..., None]
    headless = np.zeros(there.shape[:3], bool)
    if not looks.by_pictures:
        headless = np.stack([behind_own_back(one, at, camera) for one in people], axis=-1)
        headless |= crowd.behind[0]
    head = there[..., : len(_HEAD)]
    beside = np.asarray(there[..., : len(_HEAD) + 1].any(axis=-1))
    if looks.by_pictures:  # which say nothing of one who is quite behind another
        beside = _in_the_picture(takes, people, at, camera, axes, looks) & here
    hands = np.asarray(there[..., -len(_HANDS) :].any(axis=-1))
    asked = np.ones((len(camera), 1, len(people), len(_HEAD)))
    asked[:, 0, : len(own)] = np.array([_asked(size) for size in takes.sizes])[:, None]
    shown = (head * asked).sum(axis=-1) / asked.sum(axis=-1) * ~headless
    about = own or subject.company
    cosine = np.stack([turned(one, at, camera) for one in about], axis=-1)
    tall = length(crowd.crowns - crowd.chins) * takes.track.focal[:, at, None] / takes.track.sensor[1]
    size = np.minimum(tall / _large(takes, subject)[:, None, None], 1.0)
    read = (shown * size)[..., : len(about)] * facing(cosine)
    counts = here[:, : len(about)].sum(axis=1)
    middle = slice((len(at) - 1) // 2, len(at) // 2 + 1)
    return {
        "legible": remembered(read.sum(axis=-1) / np.maximum(counts, 1), np.ones_like(takes.window)),
        "hands_shown": hands[:, middle, : len(about)].sum(axis=(1, 2)) / max(counts[middle].sum(), 1),
        "heads": (shown > _MOST_OF_IT).sum(axis=(1, 2)) / max(here.sum(), 1),
        "together": lapped_heads(crowd, beside).min(axis=1),
    }


def _marks(
    takes: Takes,
    people: tuple[Subject, ...],
    at: NDArray[np.int64],
    camera: Array,
    axes: Array,
    looks: Sight,
    first: int,
) -> Bools:
    """Which of the marks of people are in the frame, and seen, [P, F, K, marks]. first: how many of the
    people others may hide of whom lines of sight know"""
    points = np.concatenate([marks_at(one, _MARKS, at) for one in people], axis=1)
    xy, depth = project(points[None], camera, axes, takes.track.focal[:, at], takes.track.sensor)
    inner = np.tile(_OF_HEAD, len(people))
    there = np.where(inner, within(xy, depth, _BORDER), within(xy, depth, 0.0))
    by_person = (len(at), len(people), len(_MARKS))
    seen = looks.shown(tuple(one.name for one in people), points.reshape(*by_person, 3), first)
    return np.asarray(there.reshape(len(there), *by_person) & seen)


def _in_the_picture(
    takes: Takes, people: tuple[Subject, ...], at: NDArray[np.int64], camera: Array, axes: Array, looks: Sight
) -> Bools:
    """Of whom a part from the crown to the pocket is in the frame and behind no thing, [P, F, K]."""
    marks = (*_HEAD, "pocket")
    points = np.concatenate([marks_at(one, marks, at) for one in people], axis=1)
    xy, depth = project(points[None], camera, axes, takes.track.focal[:, at], takes.track.sensor)
    there = within(xy, depth, 0.0) & looks.clear(points, people=False)
    return np.asarray(there.reshape(*there.shape[:2], len(people), len(marks)).any(axis=-1))


def _asked(size: Size) -> tuple[bool, ...]:
    """Which of crown, eyes and chin a size is to show of whom it is about."""
    return size.whole_head, True, size.lower != "nose"


def _large(takes: Takes, subject: Subject) -> Array:
    """From which share of the frame's height on a head is large enough, by the sizes of takes [P]."""
    whole = np.array([size.lower == "feet" for size in takes.sizes])
    share = np.array([size.share for size in takes.sizes])
    return np.where(whole, np.minimum(share * _TALL / subject.height, _LARGE), _LARGE)
