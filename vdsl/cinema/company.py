"""Who else is in the picture: people cut off beside the subject, and those in a place that is shown.

A place has no face, but whoever stands in it has one, and a picture of a room in which people turn their
backs, hide each other or lose their heads is a poor one. Assumes a subject that knows its company.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from .bodies import behind_own_back
from .composition import broken
from .covering import BEFORE, TRUNK, Crowd, behind_heads, covered, crowd_of, crowded
from .framing import Array
from .looking import Sight
from .subject import SIGHT, Subject, marks_at
from .takes import Bools, Picture, Takes, mean_of, pictured, remembered, turned, visibility, within
from .together import turned_among
from .track import project

#: One who is nearer than the subject counts in full, one so many times as far away hardly any more.
_FAR = 6.0
#: What the last frame adds; what somebody counts who has a head and is halved by a side of the frame; who
#: stands before another in the picture, or without air between them; and who is cut below and should not.
_ENDS, _HALF, _CROWDED, _FOOTLESS = 0.3, 0.5, 0.45, 0.3
#: Share of a trunk's breadth behind somebody nearer from which on nothing is left of it to see.
_GONE = 0.85
#: Cosine between a face and the direction to the camera below which one sees the back of a head.
_FACELESS = -0.2
#: Share of the frame along its borders in which nobody counts as shown in a place.
_EDGE = 0.06
#: What is to be seen of somebody in a place.
_UPPER = SIGHT[:3]
#: Half the width of a head, and how far to each side of a chest it is looked whether it is hidden: metres.
_HEAD_HALF, _SIDE = 0.08, 0.15
#: How much less somebody counts as shown who stands straight behind another.
_COVERED = 0.8
#: Sampled frames that are a while.
_WHILE = 2


def company_cut(
    takes: Takes,
    subject: Subject,
    at: NDArray[np.int64],
    camera: Array,
    axes: Array,
    picture: Picture,
    looks: Sight,
    crowd: Crowd | None,
) -> Array:
    """Share [P] of the time in which somebody beside the subject is in the picture without their head: it is
    out of the frame, or somebody else or a thing is before it; and more by :data:`_ENDS` where the last frame
    is such a one: it is what is remembered of a take. Who is halved by a side of the frame or by a thing,
    head and all, counts for :data:`_HALF` of that, two without air between them for up to :data:`_CROWDED`,
    and whose feet are below the frame of a place, or of a size that shows the whole, for :data:`_FOOTLESS`.

    crowd: of everybody, None for nobody
    """
    out, halves = np.zeros(camera.shape[:2]), np.zeros(camera.shape[:2])
    asked, everybody = subject.own, subject.everybody
    if crowd is None or len(everybody) < (1 if subject.kind == "place" else 2):
        return np.zeros(len(camera))
    own = np.maximum(picture.depth[:, :, picture.names.index("pocket")], BEFORE)
    headless, behind = crowd.behind
    headless = headless & (not looks.by_pictures)
    there = np.zeros(crowd.depth.shape)  # how much each counts who is to be seen
    there[..., : len(asked)] = crowd.inside[..., : len(asked)]
    for k, one in enumerate(subject.company, len(asked)):
        body, head, split, far = _beside_it(takes, one, at, camera, axes, looks)
        head &= ~headless[..., k]
        near = np.clip((_FAR - far / own) / (_FAR - 1.0), 0.0, 1.0)
        there[..., k] = (body & (head | (behind[..., k] < _GONE))) * near
        body &= behind[..., k] < _GONE
        out = np.maximum(out, (body & ~head) * near)
        halves = np.maximum(halves, (body & head) * near * split)
    lapped = crowded(crowd, there)
    cut = out.mean(axis=1) + _ENDS * out[:, -1]
    halves = np.maximum(out, halves)
    halved = _HALF * np.minimum(halves.mean(axis=1) + _ENDS * halves[:, -1], 1.0)
    ugly = np.maximum(halved, _CROWDED * np.maximum(lapped.mean(axis=1), lapped[:, -1]))
    whole = subject.kind == "place" or np.array([size.lower == "feet" for size in takes.sizes])
    feet = _FOOTLESS * whole * _footless(takes, everybody, at, camera, axes, there)
    ugly = np.maximum(ugly, feet)
    return np.asarray(np.clip(np.maximum(cut, ugly), 0.0, 1.0))


def _beside_it(
    takes: Takes,
    one: Subject,
    at: NDArray[np.int64],
    camera: Array,
    axes: Array,
    looks: Sight,
) -> tuple[Bools, Bools, Array, Array]:
    """Of somebody beside a subject, [P, F] each: whether some of the body is in the picture, and of the head,
    whoever may stand before them, how much the frame or a thing halves the body, 0..1, and how far away it
    is."""
    marks = ("eyes", "chin", "crown", "pocket", "waist")
    points = marks_at(one, marks, at)
    xy, depth = project(points[None], camera, axes, takes.track.focal[:, at], takes.track.sensor)
    far = depth[:, :, marks.index("pocket")]
    wide = takes.track.focal[:, at] / takes.track.sensor[0] / np.maximum(far, BEFORE)
    inside = _beside(xy[:, :, :3], depth[:, :, :3], _HEAD_HALF * wide)
    # a face may be cut above the brow; without one, what is left of a head is not told from a collar
    head = inside[:, :, :2].all(axis=2) & (inside[:, :, 2] | (turned(one, at, camera) > _FACELESS))
    body = _beside(xy[:, :, 3:], depth[:, :, 3:], TRUNK * wide).any(axis=2) & (far > BEFORE)
    if not body.any():
        return body, head, np.zeros(far.shape), far
    aside = _SIDE * axes[:, :, None, 0]  # to the picture's right
    beside = points[None, :, 3:4] + np.concatenate([-aside, aside], axis=2)
    middle = np.broadcast_to(points[:, 3:], (len(beside), *points[:, 3:].shape))
    trunk = looks.clear(np.concatenate([beside, middle], axis=2), people=False)
    body &= trunk.any(axis=2)
    sides = trunk[:, :, :2]
    head &= looks.shown((one.name,), points[:, None, :2], people=0)[:, :, 0].any(axis=2)
    if not looks.by_pictures:
        head &= ~behind_own_back(one, at, camera)
    split = np.maximum(_halved(xy[:, :, 3, 0], TRUNK * wide), sides[..., 0] != sides[..., 1])
    return body, head, split, far


def _footless(
    takes: Takes, people: tuple[Subject, ...], at: NDArray[np.int64], camera: Array, axes: Array, there: Array
) -> Array:
    """Of people [K] who count so much in the picture [P, F, K], the share whose feet are below it, [P]: all
    the time, or in the last frame where that is more."""
    feet = np.stack([one.landmarks["feet"][at] for one in people], axis=1)
    xy, depth = project(feet[None], camera, axes, takes.track.focal[:, at], takes.track.sensor)
    below = there * ((xy[..., 1] > 1.0) | (depth < BEFORE))
    share = below.sum(axis=-1) / np.maximum(there.sum(axis=-1), 1.0)
    return np.asarray(np.maximum(share.mean(axis=1), share[:, -1]))


def _halved(x: Array, half: Array) -> Array:
    """0 where a breadth about ``x`` [P, F] is in the frame or out of it, 1 where a side of it halves it."""
    share = np.clip((np.minimum(x + half, 1.0) - np.maximum(x - half, 0.0)) / (2.0 * half), 0.0, 1.0)
    return np.asarray(4.0 * share * (1.0 - share))


def _beside(xy: Array, depth: Array, aside: Array) -> Bools:
    """Which of points [P, F, K] are in the frame, or beside it by no more than so much of its width [P, F]:
    of what they are the middle of, a side is in it."""
    across = (xy[..., 0] > -aside[..., None]) & (xy[..., 0] < 1.0 + aside[..., None])
    return np.asarray(across & (xy[..., 1] > 0.0) & (xy[..., 1] < 1.0) & (depth > BEFORE))


def company_shown(
    takes: Takes,
    subject: Subject,
    at: NDArray[np.int64],
    camera: Array,
    axes: Array,
    looks: Sight,
) -> dict[str, Array]:
    """Of a place with people in it: ``interest``, how many of their heads are seen, ``face``, how they are
    turned to the camera, what is seen (:func:`~vdsl.cinema.takes.visibility`) of who is seen best, less of
    who is there for a shorter time, and ``head_cropped`` and ``head_cut``, of the worst off; two thirds of
    its ``visibility`` are that everybody is seen."""
    people, focal = subject.company, takes.track.focal[:, at]
    here = np.stack([subject.holds(one)[at] for one in people], axis=1)  # [F, people]
    eyes = np.stack([one.landmarks["eyes"][at] for one in people], axis=1)
    xy, depth = project(eyes[None], camera, axes, focal, takes.track.sensor)
    crowd, names = crowd_of(takes, people, at, camera, axes), tuple(one.name for one in people)
    seen = within(xy, depth, _EDGE) & looks.shown(names, eyes[:, :, None], people=0)[..., 0]
    if not looks.by_pictures:
        seen &= ~behind_heads(crowd.eyes, depth, crowd.feet)
        seen &= ~np.stack([behind_own_back(one, at, camera) for one in people], axis=-1)
    apart = 1.0 - _COVERED * covered(crowd)
    counts = here.sum(axis=1)
    share = np.where(counts > 0, (seen * apart * here).sum(axis=2) / np.maximum(counts, 1), 1.0)
    faces, cropped, cut = (np.zeros(len(camera)) for _ in range(3))
    stays = here.sum(axis=0) / max(int(here.sum(axis=0).max(initial=0)), 1)
    sight: dict[str, Array] = {}
    for k, one in enumerate(people):
        faces += remembered(turned_among(one, at, camera), takes.window & here[:, k]) / len(people)
        found = pictured(takes, one, at, camera, axes)
        own = replace(takes, window=takes.window & here[:, k])
        for name, value in _sight(own, one, at, found, looks).items():
            sight[name] = np.maximum(sight.get(name, 0.0), stays[k] * value)
        cropped = np.maximum(cropped, broken(takes, one, found))
        there = within(found.of("pocket"), found.depth[:, :, found.names.index("pocket")], 0.0)
        there = there & takes.window & here[:, k]
        over = np.where(there, -found.of("top")[..., 1], 0.0).max(axis=1)
        cut = np.maximum(cut, np.clip(over, 0.0, 2.0))
    shown = mean_of(share, takes.window)
    last = np.where(takes.window[:, -1], share[:, -1], shown)
    # the last picture is what is remembered, and whoever is lost for a while is looked for
    shown = (shown + np.minimum(shown, np.minimum(last, _worst(share, takes.window)))) / 2
    sight["visibility"] = (sight["visibility"] + 2.0 * shown) / 3.0
    return {"interest": shown, "face": faces, "head_cropped": cropped, "head_cut": cut} | sight


def _worst(share: Array, window: Bools) -> Array:
    """Mean over the :data:`_WHILE` frames of the window in which the share [P, F] is least: [P]."""
    least = np.sort(np.where(window, share, np.inf), axis=1)[:, :_WHILE]
    there = np.isfinite(least)
    return np.asarray(np.where(there, least, 0.0).sum(axis=1) / np.maximum(there.sum(axis=1), 1))


def _sight(
    takes: Takes,
    one: Subject,
    at: NDArray[np.int64],
    picture: Picture,
    looks: Sight,
) -> dict[str, Array]:
    """What is seen of somebody in a place: of head and chest, as tables and seats hide the rest."""
    index = [picture.names.index(name) for name in _UPPER]
    inside = within(picture.xy[:, :, index], picture.depth[:, :, index], 0.0)
    points = marks_at(one, _UPPER, at)
    return visibility(takes, inside, looks.clear(points, people=False))
