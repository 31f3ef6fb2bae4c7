"""Measures of takes from the geometry: per frame first, then one number a take; P takes of one
performance at once.

Frames are sampled (eight a take, first and last among them) where sight and space are concerned; motion is
measured on all. A take that turns or moves onto its subject, or off it, is judged on the part of its
time in which the subject is meant to be there: the window.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from runtime.world import World

from . import space
from .company import company_cut, company_shown
from .composition import framing, size_error
from .covering import crowd_of
from .framing import Array
from .gestures import act_missed, at_work, face_covered, gesture_lost, hands_missed
from .legibility import legibility
from .looking import Sight, sight_of
from .score import geometry_score as geometry_score
from .sight import backdrop_gaps, hidden_walls
from .subject import SIGHT, Subject, marks_at
from .takes import Bools, Picture, Takes, key_sample, mean_of, remembered, samples, turned, visibility, within
from .together import everybody_measured, everybody_seen
from .track import CameraTrack, camera_axes, project
from .vectors import dot, length
from .void import floor_gaps

#: Names of what :func:`measure` returns, each [P].
MEASURES = (
    "visibility",  # share of the subject's points in the frame that nothing hides, 0..1
    "ends_visible",  # the same at the first or last frame of the window, whichever is less
    "head_visible",  # share of the window in which the eyes are in the frame and not hidden
    "in_frame",  # share of the window in which head and middle of what is framed are in the frame
    "size_error",  # |log| of the framed stretch's height against the asked one, at the key frame
    "size_drift",  # the greatest |log| of the visible height at the subject against the key frame's
    "headroom",  # height of the frame above the crown, share of the frame, mean over the window
    "headroom_error",  # the same, off the size's own headroom
    "head_cut",  # how far what the size puts at the top is above the frame, share of its height, the greatest
    "head_cropped",  # how much a border of the frame cuts the head, or a side the body, first or last
    "feet_cut",  # the same below the frame, for sizes that are to show the whole; 0 for the others
    "view",  # share of the window in which everybody a two-shot is of, or the shoulder it is over, is seen so
    "lead_room",  # more room ahead of the face than behind: −1..1, 0 where it looks at the camera
    "thirds_error",  # distance of the eyes from the upper third (from above: the middle one), of its height
    "interest",  # share of the other points that matter (thing in hand, partner) in the frame and not hidden
    "empty",  # share of the time in which neither any of the subject nor any of those points is in the frame,
    # and more by ENDS_EMPTY where the last frame is such a one, or shows of a person neither face nor hands
    # that do something
    "walk_missed",  # share of the way the subject goes on which nothing of it is seen; 0 for a step or two
    "act_missed",  # share of the way hands go at work on which nothing of the subject is seen
    "hands_missed",  # share of the time hands are at work in which neither is seen; 0 for close-ups
    "gesture_lost",  # how little hands at work stand out from the body in the picture; 0 for close-ups
    "face_covered",  # share of the face that the own arms, what these hold, or the chest hide, and need not
    "legible",  # how well the face of whom it is about is read: seen, turned to the camera, large; to its end
    "heads",  # share of everybody, over all the time, whose head is in the frame and not hidden
    "together",  # how near two heads are to each other in the picture, when they are furthest apart: 0..1
    "hands_shown",  # share of the middle of the time in which a hand is in the frame and not hidden
    "company_cut",  # share of the time somebody beside the subject is in the picture without their head, and
    # more where the last frame is such a one
    "foreground",  # share of the picture covered by something much nearer than the subject, or ENDS_BEHIND
    # of the share in the last frame where that is more
    "face",  # cosine between face and direction to the camera: 1 frontal, 0 profile, −1 from behind; a mean,
    # the last frame for more
    "clearance",  # metres from the camera to the nearest solid or person, at most 1
    "speed",  # metres a second, the greatest
    "angular_speed",  # degrees a second, the greatest
    "jerk",  # metres a second cubed, root mean square
    "horizon",  # degrees off the asked roll, the greatest
    "backdrop_gap",  # share of the picture's width where the set is missing behind the subject
    "floor_gap",  # share of the picture's lower part where one looks past the floor of a room into nothing,
    # or half of the share in the last frame where that is more
    "elevation",  # degrees the camera looks down (positive) at its aim, at the key frame
    "height",  # metres of the camera over the subject's floor, at the key frame
)

_A_WALK = 1.0  # metres that count as going somewhere
#: What an end on nobody and nothing counts in ``empty``: of a camera that comes from somewhere one waits for
#: what it finds; one that leaves somebody is to lead to something.
ENDS_EMPTY = 0.3
#: How much what is in the way in the last frame counts, were there nothing in all others.
ENDS_BEHIND = 0.4
#: What is in the way within a share of the distance to the subject, and how much it counts; how many of the
#: sampled frames are looked at along lines; of pictures all are.
_NEAR, _LOOKED_AT = ((0.5, 1.0), (0.72, 0.4)), 6
_TO_THE_GROUND = 0.9  # of the way to the floor, as far as something may be in the way of a look down
#: Where in the frame, −1..1, it is looked whether something near is in the way: of a subject beside it, of a
#: place all over the picture but for its lowest part, where the floor and what stands there may begin near.
#: Pictures are looked at closely; a line past boxes is dear.
_ASIDE = np.array([(x, y) for x in (-0.85, -0.3, 0.3, 0.85) for y in (-0.6, 0.5)])
_ALL_OVER = np.array([(x, y) for x in np.linspace(-0.9, 0.9, 10) for y in (-0.5, 0.1, 0.6)])
_CLOSELY = np.array([(x, y) for x in np.linspace(-0.9, 0.9, 10) for y in np.linspace(-0.75, 0.6, 6)])


@dataclass(frozen=True, eq=False)
class Measured:
    """values: [P] by the names of :data:`MEASURES`; hidden: [P, W] walls taken away
    shown, people: [P] least distance to walls that are drawn, and to other people, metres
    """

    values: dict[str, Array]
    hidden: Bools
    shown: Array
    people: Array


#: What is worked out last, and not of takes that are of no use anyway.
LAST = (
    "walk_missed",
    "act_missed",
    "hands_missed",
    "gesture_lost",
    "face_covered",
    "interest",
    "empty",
    "company_cut",
    "legible",
    "heads",
    "together",
    "hands_shown",
    "floor_gap",
)


@dataclass(frozen=True, eq=False)
class _Looks:
    """Takes and what they look at in the sampled frames ``at``.

    points: [F, K, 3], the subject's landmarks, by the names of ``picture``; camera: [P, F, 3]
    axes: [P, F, 3, 3]; hidden: [P, W]; inside: [P, F, K], which landmarks are in the frame
    seen: [P, F, points of SIGHT], which of these points are in the frame and nothing hides them
    sight: how takes are looked at
    """

    takes: Takes
    at: NDArray[np.int64]
    points: Array
    camera: Array
    axes: Array
    picture: Picture
    hidden: Bools
    inside: Bools
    seen: Bools
    sight: Sight

    def only(self, rows: NDArray[np.int64], subject: Subject, world: World) -> _Looks:
        """Some of the takes."""
        if len(rows) == len(self.camera):
            return self
        takes = self.takes.only(rows)
        camera, axes, hidden = self.camera[rows], self.axes[rows], self.hidden[rows]
        return replace(
            self,
            takes=takes,
            camera=camera,
            axes=axes,
            picture=replace(self.picture, xy=self.picture.xy[rows], depth=self.picture.depth[rows]),
            hidden=hidden,
            inside=self.inside[rows],
            seen=self.seen[rows],
            sight=sight_of(takes, _named(subject), world.solids, self.at, camera, axes, hidden),
        )


def measure(
    takes: Takes,
    subject: Subject,
    world: World,
    fps: float,
    wanted: Callable[[Measured], Bools] | None = None,
) -> Measured:
    """All measures of all takes of one performance.

    wanted: which takes [P] all measures are wanted of, by what is quickly worked out of them; of the others
        those in ``LAST`` are NaN, but for what is told of several, or of a place, anyway
    """
    track, at = takes.track, samples(subject.frames)
    camera, rotation = track.position[:, at], track.rotation[:, at]
    axes = camera_axes(rotation)
    names = list(subject.landmarks)
    points = marks_at(subject, names, at)  # [F, K, 3]
    xy, depth = project(points[None], camera, axes, track.focal[:, at], track.sensor)
    picture = Picture(names, xy, depth)

    hidden = _hidden(world, track, at, camera, axes, picture, points[:, names.index("waist")])
    values, inside = framing(takes, subject, at, picture)
    sight_index = [names.index(n) for n in SIGHT]
    looks = sight_of(takes, _named(subject), world.solids, at, camera, axes, hidden)
    seen = looks.clear(points[:, sight_index])
    values["view"] = everybody_seen(takes, subject, at, camera, axes, looks)
    values |= visibility(takes, inside[:, :, sight_index], seen)
    across = _ALL_OVER if subject.kind == "place" else _CLOSELY if looks.by_pictures else _ASIDE
    values["foreground"] = _foreground(takes, subject.floor, at, camera, axes, picture, looks, across)
    values |= _motion(track, takes.roll, fps)
    values["face"] = remembered(turned(subject, at, camera), takes.window)
    if len(subject.members) > 1:
        values |= everybody_measured(takes, subject, at, camera, axes, looks)
    if subject.kind == "place":  # nobody misses the edges of the box that stands for it
        values |= {name: np.zeros(len(camera)) for name in ("head_cut", "feet_cut", "thirds_error")}
        if subject.company:
            values |= company_shown(takes, subject, at, camera, axes, looks)
    rows, key = np.arange(len(camera)), key_sample(takes, at)
    values["elevation"] = np.degrees(-rotation[rows, key, 1])
    values["height"] = camera[rows, key, 2] - subject.floor
    if not takes.paper:
        values["size_error"] = size_error(takes, points, names, camera[rows, key], axes[rows, key], key, at)
    values["backdrop_gap"] = _gaps(world, hidden, track, at, camera, axes, points[:, names.index("waist")])

    near = takes.near if takes.near is not None else space.nearby(world.solids, camera)
    room = space.clearance(world.solids, near, hidden)
    others = [(foot[at], crown[at], radius) for foot, crown, radius in takes.others]
    people = space.to_people(camera, others)
    values["clearance"] = np.minimum(np.minimum(room.object, room.shown), people)
    found = Measured(values, hidden, room.shown, people)
    asked = rows if wanted is None else np.flatnonzero(wanted(found))
    in_sight = inside[:, :, sight_index] & seen
    whole = _Looks(takes, at, points, camera, axes, picture, hidden, inside, in_sight, looks)
    last = _last(whole.only(asked, subject, world), subject, world) if len(asked) else {}
    for name in LAST:  # of several, and of a place, some are told already
        if name not in values:
            values[name] = np.full(len(camera), np.nan)
            values[name][asked] = last.get(name, np.nan)
    return found


def _named(subject: Subject) -> frozenset[str]:
    """Whom a shot is about, who are not in their own way."""
    return frozenset((subject.name, *subject.heads)) if subject.kind == "person" else frozenset()


def _last(of: _Looks, subject: Subject, world: World) -> dict[str, Array]:
    """The measures in ``LAST``: what one sees of what is done, who else is there, and what is missing."""
    takes, at, camera, axes, picture = of.takes, of.at, of.camera, of.axes, of.picture
    waist, eyes = (picture.names.index(name) for name in ("waist", "eyes"))
    hands = of.seen[:, :, [SIGHT.index(name) for name in ("hand_l", "hand_r")]]
    shown = _shown(takes, at, camera, axes, of.sight)
    somebody = of.seen.any(axis=-1) | of.inside[:, :, eyes] | shown.any(axis=-1)
    ends = _worth_ending_on(subject, at, of.seen[:, -1]) | of.inside[:, -1, eyes] | shown[:, -1].any(axis=-1)
    crowd = crowd_of(takes, subject.everybody, at, camera, axes) if subject.everybody else None
    return {
        "walk_missed": _missed(of.points[:, waist], of.seen),
        "act_missed": act_missed(subject, at, of.seen),
        "hands_missed": hands_missed(takes, subject, at, camera, hands),
        "gesture_lost": gesture_lost(takes, subject, at, picture, hands),
        "face_covered": face_covered(takes, subject, at, camera),
        "interest": _interest(takes, shown),
        "empty": np.minimum(1.0 - somebody.mean(axis=1) + ENDS_EMPTY * ~ends, 1.0),
        "company_cut": company_cut(takes, subject, at, camera, axes, picture, of.sight, crowd),
        "floor_gap": floor_gaps(takes, world, subject.floor, at, camera, axes, of.sight),
    } | legibility(takes, subject, at, camera, axes, of.sight, crowd)


def _worth_ending_on(subject: Subject, at: NDArray[np.int64], seen: Bools) -> Bools:
    """Which takes [P] show of a subject what one may end on: of a person the face, or hands at work.

    seen: bool [P, K] of the points of SIGHT, in the last frame
    """
    if subject.kind != "person":
        return np.asarray(seen.any(axis=-1))
    face = seen[:, [SIGHT.index(name) for name in ("eyes", "chin")]].any(axis=-1)
    hands = seen[:, [SIGHT.index(name) for name in ("hand_l", "hand_r")]] & at_work(subject, at[-1:])
    return np.asarray(face | hands.any(axis=-1))


def _missed(waist: Array, seen: Bools) -> Array:
    """Share [P] of a way [F, 3] on which none of the points [P, F, K] that are to be seen is."""
    steps = length(np.diff(waist[:, :2], axis=0))
    if steps.sum() < _A_WALK:
        return np.zeros(len(seen))
    way = np.append(steps, 0.0) + np.append(0.0, steps)  # at every frame, there and back: twice
    return np.asarray((~seen.any(axis=2) * way).sum(axis=1) / way.sum())


def _shown(
    takes: Takes,
    at: NDArray[np.int64],
    camera: Array,
    axes: Array,
    looks: Sight,
) -> Bools:
    """Which of the other points that matter are in the frame and not hidden, [P, F, K]."""
    if not takes.interest:
        return np.zeros((*camera.shape[:2], 0), bool)
    points = np.stack([path[at] for path in takes.interest], axis=1)
    seen = looks.clear_apart(points)
    xy, depth = project(points[None], camera, axes, takes.track.focal[:, at], takes.track.sensor)
    return within(xy, depth, 0.02) & seen


def _interest(takes: Takes, shown: Bools) -> Array:
    if not shown.shape[2]:
        return np.ones(len(shown))
    share = shown.mean(axis=-1)
    # a pan may lead from the subject to the other one, so both parts of the time count
    return np.maximum(mean_of(share, takes.window), mean_of(share, ~takes.window))


def _foreground(
    takes: Takes,
    floor: float,
    at: NDArray[np.int64],
    camera: Array,
    axes: Array,
    picture: Picture,
    looks: Sight,
    across: Array,
) -> Array:
    """Looks [L, 2] across the frame on some of the sampled frames, of pictures on all: whether something is
    in the way half way to the subject and, for less, on the last of the way to it."""
    some = np.arange(len(at))
    if not looks.by_pictures:
        some = _some_of(len(at))
    track = takes.track
    far = np.maximum(picture.depth[:, some, picture.names.index("pocket")], 0.2)
    eye, ax = camera[:, some, None], axes[:, some, None]
    ends = []
    for share, _ in _NEAR:
        depth = share * far
        half = depth[..., None, None] / (2 * track.focal[:, at[some], None, None])
        points = (
            eye
            + depth[..., None, None] * ax[..., 2, :]
            + half * track.sensor[0] * across[:, :1] * ax[..., 0, :]
            + half * track.sensor[1] * across[:, 1:] * ax[..., 1, :]
        )
        ends.append(_above(floor, eye, points) if looks.by_pictures else points)
    clear = looks.clear(np.concatenate(ends, axis=2), some=some)  # at once: they lie along the same lines
    clear = clear.reshape(*clear.shape[:2], len(_NEAR), len(across))
    blocked = np.where(clear, 0.0, np.array([counts for _, counts in _NEAR])[:, None]).max(axis=2)
    share = blocked.mean(axis=2)
    return np.asarray(np.maximum(share.mean(axis=1), ENDS_BEHIND * share[:, -1]))


@lru_cache(maxsize=16)
def _some_of(frames: int) -> NDArray[np.int64]:
    """Those of so many sampled frames that are looked at, evenly spaced; not to be written to."""
    return np.unique((np.arange(_LOOKED_AT) * ((frames - 1) / (_LOOKED_AT - 1))).round().astype(int))


def _above(floor: float, eye: Array, points: Array) -> Array:
    """Places [P, F, L, 3], those under the floor on the way there but a little above it: the ground that one
    looks down on is in nobody's way, though pictures show it nearer than what would be below."""
    high, down = np.maximum(eye[..., 2] - floor, 0.0), eye[..., 2] - points[..., 2]
    share = np.where(down > high, _TO_THE_GROUND * high / np.maximum(down, 1e-9), 1.0)
    return np.asarray(eye + share[..., None] * (points - eye))


def _motion(track: CameraTrack, roll: float, fps: float) -> dict[str, Array]:
    frames = track.position.shape[1]
    zero = np.zeros(len(track.position))
    step = np.diff(track.position, axis=1) * fps
    turn = np.degrees(np.diff(track.rotation, axis=1)) * fps
    pitch = track.rotation[:, :-1, 1]
    speed = length(step)
    angular = np.sqrt(turn[..., 1] ** 2 + (turn[..., 2] * np.cos(pitch)) ** 2)
    jerk = np.diff(track.position, n=3, axis=1) * fps**3 if frames > 3 else np.zeros((len(zero), 1, 3))
    return {
        "speed": speed.max(axis=1) if frames > 1 else zero,
        "angular_speed": angular.max(axis=1) if frames > 1 else zero,
        "jerk": np.sqrt(dot(jerk, jerk).mean(axis=1)),
        "horizon": np.degrees(np.abs(track.rotation[..., 0] - roll).max(axis=1)),
    }


def _columns(track: CameraTrack, at: NDArray[np.int64], axes: Array) -> Array:
    """Floor-plan directions [P, F, 5, 2] of five columns across the frame, per metre of depth."""
    half = track.sensor[0] / (2 * track.focal[:, at])
    x = np.linspace(-1.0, 1.0, 5)
    return axes[:, :, None, 2, :2] + (half[..., None] * x)[..., None] * axes[:, :, None, 0, :2]


def _hidden(
    world: World,
    track: CameraTrack,
    at: NDArray[np.int64],
    camera: Array,
    axes: Array,
    picture: Picture,
    heart: Array,
) -> Bools:
    depth = np.maximum(picture.depth[:, :, picture.names.index("waist")], 0.1)
    corners = camera[:, :, None, :2] + depth[..., None, None] * _columns(track, at, axes)
    return hidden_walls(world, camera, heart, corners)


def _gaps(
    world: World,
    hidden: Bools,
    track: CameraTrack,
    at: NDArray[np.int64],
    camera: Array,
    axes: Array,
    heart: Array,
) -> Array:
    rays = _columns(track, at, axes)
    rays = rays / np.maximum(length(rays), 1e-9)[..., None]
    return backdrop_gaps(world, hidden, camera, heart, rays)
