"""Measures of takes of several people: whether all are seen, over whose shoulder it looks, and the worst off
of those who are one subject together.

Halfway between two people there is nobody: what is seen of a two-shot is what is seen of each. Assumes a
subject with members, who acts first of all.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .bodies import pillars
from .composition import broken
from .covering import behind_heads, spread
from .framing import Array
from .gestures import act_missed, face_covered, gesture_lost, hands_missed
from .looking import Sight
from .sight import clear_of_people
from .subject import SIGHT, Subject, marks_at
from .takes import Bools, Takes, mean_of, pictured, remembered, turned, visibility, within
from .track import project
from .vectors import dot, length

_HAIR, _CHEEK = 0.1, 0.02  # metres of a head to its side that hide, and of a face that is not to be hidden
#: Cosine to the camera from which on one over whose shoulder it looks shows it a face, and what that takes
#: away: it is a fault, but none for which there is to be no take at all.
_FACES, _TO_US = 0.35, 0.25
#: Who acts counts as much of the faces as that, all others share the rest; and a face turned to the camera
#: does not make up for a back: from this cosine on (nearly in profile) more is no better. It is as good among
#: several as that of three quarters is of somebody alone.
_WHO_ACTS, _ENOUGH, _ALONE = 0.6, 0.3, 0.7


def everybody_seen(
    takes: Takes,
    subject: Subject,
    at: NDArray[np.int64],
    camera: Array,
    axes: Array,
    looks: Sight,
) -> Array:
    """Whether all heads are in the frame and seen, or the near head of a view over a shoulder is where it
    belongs: a share of the window, [P]; 1 for a single one."""
    if takes.view == "ots" and subject.via is not None:
        return _over_a_shoulder(takes, subject, subject.via[at], at, camera, axes)
    if not subject.members:
        return np.ones(len(camera))
    points = np.stack([head[at] for head in subject.heads.values()], axis=1)
    xy, depth = project(points[None], camera, axes, takes.track.focal[:, at], takes.track.sensor)
    seen = within(xy, depth, 0.03) & looks.clear(points)
    if looks.by_pictures:
        seen &= looks.shown(tuple(subject.heads), points[:, :, None], people=len(subject.heads))[..., 0]
    else:
        seen &= ~behind_heads(spread(xy, takes.track.focal[:, at], takes.track.sensor), depth)
    return _held(np.asarray(seen.all(axis=-1)), takes.window)


def _over_a_shoulder(
    takes: Takes, subject: Subject, near: Array, at: NDArray[np.int64], camera: Array, axes: Array
) -> Array:
    """Share of the window [P] in which the near head [F, 3] is at the frame's side and off the face; less
    where it is a face that it shows the camera."""
    focal, eyes = takes.track.focal[:, at], subject.landmarks["eyes"][at]
    (xy, depth), (face, away) = (
        project(head[None, :, None], camera, axes, focal, takes.track.sensor) for head in (near, eyes)
    )
    aside, high = np.abs(xy[..., 0, 0] - 0.5), xy[..., 0, 1]
    nearer = (depth[..., 0] > 0.2) & (depth[..., 0] < 0.75 * length(camera - eyes))
    wide = _HAIR / np.maximum(depth[..., 0], 0.1) + _CHEEK / np.maximum(away[..., 0], 0.1)
    nearer &= np.abs(xy[..., 0, 0] - face[..., 0, 0]) > wide * focal / takes.track.sensor[0]
    there = nearer & (aside > 0.16) & (aside < 0.62) & (high > -0.6) & (high < 0.75)
    shows = np.zeros(len(camera))
    if subject.via_face is not None:
        to_camera = camera - near
        cosine = dot(to_camera, subject.via_face[None, at]) / np.maximum(length(to_camera), 1e-9)
        shows = mean_of(cosine > _FACES, takes.window)
    return _held(np.asarray(there), takes.window) * (1.0 - _TO_US * shows)


def _held(there: Bools, window: Bools) -> Array:
    """Share of the window [P] in which something holds; 0 where it does not at the window's first frame or
    its last, which are what cuts show."""
    rows, last = np.arange(len(there)), window.shape[1] - 1 - window[:, ::-1].argmax(axis=1)
    return np.where(there[rows, window.argmax(axis=1)] & there[rows, last], mean_of(there, window), 0.0)


def everybody_measured(
    takes: Takes,
    subject: Subject,
    at: NDArray[np.int64],
    camera: Array,
    axes: Array,
    looks: Sight,
) -> dict[str, Array]:
    """Of every member what :func:`~vdsl.cinema.measures.measure` would say, and of these the worst."""
    found: list[dict[str, Array]] = []
    for one in subject.members:
        picture = pictured(takes, one, at, camera, axes)
        points = marks_at(one, SIGHT, at)
        sight = [picture.names.index(n) for n in SIGHT]
        inside = within(picture.xy[:, :, sight], picture.depth[:, :, sight], 0.0)
        seen = _seen_among(subject.members, one, points, at, camera, looks)
        found.append(visibility(takes, inside, seen) | {"head_cropped": broken(takes, one, picture)})
        shown = (inside & seen)[:, :, [SIGHT.index(name) for name in ("hand_l", "hand_r")]]
        found[-1]["act_missed"] = act_missed(one, at, inside & seen)
        found[-1]["hands_missed"] = hands_missed(takes, one, at, camera, shown)
        found[-1]["gesture_lost"] = gesture_lost(takes, one, at, picture, shown)
    worst = {"head_cropped": np.max, "visibility": np.min, "head_visible": np.min, "ends_visible": np.min}
    out = {k: np.asarray(of([each[k] for each in found], axis=0)) for k, of in worst.items()}
    out |= {name: found[0][name] for name in ("act_missed", "hands_missed", "gesture_lost")}  # of who acts
    out["face_covered"] = face_covered(takes, subject.members[0], at, camera)
    return out | {"face": _faces(takes, subject, at, camera)}


def _seen_among(
    members: tuple[Subject, ...],
    one: Subject,
    points: Array,
    at: NDArray[np.int64],
    camera: Array,
    looks: Sight,
) -> Bools:
    """Which of somebody's points [F, K, 3] nothing hides, nor anybody, those they are filmed with among them,
    [P, F, K]."""
    if looks.by_pictures:
        return np.asarray(looks.shown((one.name,), points[:, None], people=1)[:, :, 0])
    bodies = [
        (foot[at], crown[at], radius)
        for other in members
        if other is not one
        for foot, crown, radius in pillars(other)
    ]
    return np.asarray(looks.clear(points) & clear_of_people(camera, points, bodies))


def turned_among(one: Subject, at: NDArray[np.int64], camera: Array) -> Array:
    """How well somebody among several is turned to the camera, [P, F]: as a cosine would be of one alone."""
    return -1.0 + (np.minimum(turned(one, at, camera), _ENOUGH) + 1.0) * (1.0 + _ALONE) / (1.0 + _ENOUGH)


def _faces(takes: Takes, subject: Subject, at: NDArray[np.int64], camera: Array) -> Array:
    total = np.zeros(len(camera))
    for i, one in enumerate(subject.members):
        share = _WHO_ACTS if i == 0 else (1.0 - _WHO_ACTS) / max(len(subject.members) - 1, 1)
        total += share * remembered(turned_among(one, at, camera), takes.window)
    return total
