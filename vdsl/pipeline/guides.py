"""The guides of drawn shots: what the renderer knows of them, as the ranker takes it (:mod:`ranker.guides`).

Assumes pictures drawn with roles. Guarantees that all that is told is of where things are in the pictures, or
would be with a wider frame, and of how the camera goes and how much room it has: nothing of what was asked
for, and no judgement goes in.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ranker.guides import (
    ALL_POINTS,
    CHANNELS,
    FARTHEST,
    FLOW,
    MARKS,
    PEOPLE,
    PERSON_POINTS,
    POINTS,
    SIDE,
    Guides,
    pairs,
)
from ranker.guides import NEAREST as NEAREST_TOLD
from runtime.raster.types import FAR, GUIDE_SIDE, NEAREST, OTHERS, SUBJECT, Camera, Probed
from runtime.world import Solids

from ..cinema.gestures import at_work
from ..cinema.space import REACH, clearance, nearby, to_people
from ..cinema.track import CameraTrack, project
from ..lang.ir import Shot
from ..propose.subjects import Filming, company_of, find_object, people_beside, subject_of
from ..propose.types import ProposalGrid
from ..stage.assemble import StagedScene

assert GUIDE_SIDE == SIDE
assert (NEAREST, FAR) == (NEAREST_TOLD, FARTHEST)
_FARTHEST = 3.0  # half frames that something goes, or is off the middle, at most
_BEHIND = 0.05  # of a ray's length ahead: what is nearer to the plane of the lens counts as this


@dataclass(frozen=True, eq=False)
class Places:
    """Where in a performance of T frames is what a camera is about.

    points: float32 [T, len(ALL_POINTS), 3], NaN where there is no such point; face: [T, 3], its direction
    faces: [T, PEOPLE, 3], those of the people who are told of one by one, NaN where there is none
    meant: [PEOPLE], 1 where the camera is about them, 0 where not
    works: [T, 2], 1 where the left hand, or the right one, of who acts is at work, 0 where it hangs
    others: everybody but the subject, as pillars: foot and crown [T, 3], and radius
    seconds: how long the performance is
    """

    points: NDArray[np.float32]
    face: NDArray[np.float32]
    faces: NDArray[np.float32]
    meant: NDArray[np.float32]
    works: NDArray[np.float32]
    others: tuple[tuple[NDArray[np.float64], NDArray[np.float64], float], ...]
    seconds: float

    def at(self, frames: NDArray[np.integer]) -> Places:
        """The same in some of the frames."""
        others = tuple((foot[frames], crown[frames], radius) for foot, crown, radius in self.others)
        points, face, faces = (told[frames] for told in (self.points, self.face, self.faces))
        return replace(self, points=points, face=face, faces=faces, others=others)

    def works_about(self, frames: NDArray[np.integer]) -> NDArray[np.float64]:
        """For which share of the time about each of some frames the left and the right hand are at work:
        [k, 2]."""
        return np.array([self.works[a:b].mean(axis=0, dtype=float) for a, b in spans(frames)])


@dataclass(frozen=True, eq=False)
class About:
    """What the cameras of a shot are about: ids of objects, and where it is, by the performance's index."""

    objects: tuple[int, ...]
    places: dict[int, Places]


def spans(at: NDArray[np.integer]) -> list[tuple[int, int]]:
    """The frames about each of some [k], from half the way from the one before to half the way to the next:
    where they begin, and the first no more of them."""
    halves = (at[1:] + at[:-1]) // 2
    begins, ends = np.concatenate([at[:1], halves]), np.concatenate([halves, at[-1:]])
    return [(int(begin), int(max(end, begin + 1))) for begin, end in zip(begins, ends, strict=True)]


def about_of(shot: Shot, grid: ProposalGrid, filming: Filming, staged: StagedScene) -> About:
    """What the cameras of a shot are about, of all performances."""
    places = {}
    for story in grid.story:
        subject = subject_of(shot, story, filming)
        points = np.full((story.frames, len(ALL_POINTS), 3), np.nan, np.float32)
        for k, name in enumerate(POINTS):
            if name in subject.landmarks:
                points[:, k] = subject.landmarks[name]
        acts = subject.members[0] if subject.members else subject
        for name in ("hand_l", "hand_r"):  # halfway between those of several people there is no hand
            points[:, POINTS.index(name)] = acts.landmarks[name]
        works = np.zeros((story.frames, 2), np.float32)
        if acts.kind == "person":
            works[:] = at_work(acts, np.arange(story.frames))
        for name, path in zip(("other_1", "other_2"), story.interest, strict=False):
            points[:, POINTS.index(name)] = path
        faces, meant = np.full((story.frames, PEOPLE, 3), np.nan, np.float32), np.zeros(PEOPLE, np.float32)
        own, others = people_beside(subject, shot, story, filming)
        for k, one in enumerate((*own, *others)[:PEOPLE]):
            first = len(POINTS) + k * len(PERSON_POINTS)
            for n, name in enumerate(PERSON_POINTS):
                points[:, first + n] = one.landmarks[name]
            faces[:, k], meant[k] = one.face, float(k < len(own))
        face = subject.face.astype(np.float32)
        company = tuple(company_of(shot, story, filming, subject))
        places[story.index] = Places(points, face, faces, meant, works, company, story.frames / filming.fps)
    return About(_objects_of(shot, grid, filming, staged), places)


def _objects_of(shot: Shot, grid: ProposalGrid, filming: Filming, staged: StagedScene) -> tuple[int, ...]:
    """Ids of what the cameras of a shot are about; of a place, which is everything there is, of who is in it:
    their heads and faces are what is looked at there."""
    if not grid.story:
        return ()
    subject = subject_of(shot, grid.story[0], filming)
    if subject.kind == "place":
        return tuple(staged.object_ids[one.name] for one in subject.company)
    if subject.kind == "person":
        names = tuple(subject.heads) or (subject.name,)
        return tuple(staged.object_ids[name] for name in names if name in staged.object_ids)
    item = find_object(filming.world, shot.focus) if subject.kind == "thing" and shot.focus else None
    return () if item is None else (item.id,)


def roles_of(staged: StagedScene, about: Sequence[About]) -> NDArray[np.uint8]:
    """The roles of all objects for each of P cameras, uint8 [P, objects]."""
    people = list(staged.object_ids.values())
    out = np.zeros((len(about), len(staged.world.objects) + len(people)), np.uint8)
    out[:, people] = OTHERS
    for row, subject in zip(out, about, strict=True):
        row[list(subject.objects)] = SUBJECT
    return out


class Pointed(NamedTuple):
    """Where points are in N pictures.

    place: [N, K, 2], half frames from the middle to the right and to the top, behind the camera as far off as
        is told, NaN where there is no such point
    depth: [N, K], metres along the axis; pixels: int32 [N, K] counted row by row, -1 out of the picture
    """

    place: NDArray[np.float64]
    depth: NDArray[np.float64]
    pixels: NDArray[np.int32]


def pointed(camera: Camera, places: Sequence[Places], size: tuple[int, int]) -> Pointed:
    """Where the points of P shots lie in their pictures of ``size`` (width, height)."""
    points = np.concatenate([p.points for p in places]).astype(float)
    position, focal = camera.position.astype(float), camera.focal.astype(float)
    xy, depth = project(points, position, camera.axes.astype(float), focal, camera.sensor)
    before = np.isfinite(depth) & (depth > _BEHIND)
    place = np.clip((2 * xy - 1) * (1, -1), -_FARTHEST, _FARTHEST)
    place = np.where(before[..., None], place, _aside(points, camera))
    inside = before & (np.abs(place) < 1).all(axis=-1)
    column, row = (np.where(inside, xy[..., k] * size[k], 0).astype(np.int32) for k in (0, 1))
    column, row = np.minimum(column, size[0] - 1), np.minimum(row, size[1] - 1)
    return Pointed(place, depth, np.where(inside, row * np.int32(size[0]) + column, np.int32(-1)))


def _aside(points: NDArray[np.float64], camera: Camera) -> NDArray[np.float64]:
    """To which side of N cameras points [N, K, 3] lie that are behind them, at the edge of what is told of
    places: that they are there, and not in the frame, is to be known."""
    axes, away = camera.axes.astype(float), points - camera.position.astype(float)[:, None]
    side = np.einsum("nac,nkc->nka", axes[:, :2], away)
    most = np.maximum(np.abs(side).max(axis=-1, keepdims=True), 1e-9)
    return np.asarray(_FARTHEST * side / most)


def guides_of(
    drawn: NDArray[np.uint8],
    probed: Probed,
    at: Pointed,
    camera: Camera,
    places: Sequence[Places],
    opened: Sequence[bool],
    gone: NDArray[np.floating],
    which: Sequence[int],
    whole: int,
) -> Guides:
    """Guides of P shots by k frames each.

    drawn: uint8 [P k, SIDE, SIDE, 6] of the renderer; probed: [P k, points], what it saw ``at`` the points
    camera: of these P k pictures; places: [P] in these k frames; opened: [P], whether walls are left out
    gone: [P k, 6], how the camera goes as :func:`paces_of` tells it, its :func:`room_of`, and which hands
        work meanwhile
    which: the k frames they are, of ``whole``
    """
    shots = len(places)
    count = len(which)
    maps = np.empty((shots, count, SIDE, SIDE, len(CHANNELS)), np.uint8)
    maps[..., :-1] = drawn.reshape(shots, count, *drawn.shape[1:])
    rays = _rays(camera, SIDE)
    rise = np.arcsin(np.clip(rays[..., 2] / np.linalg.norm(rays, axis=-1), -1, 1)) / (np.pi / 2)
    maps[..., -1] = np.round(128 + 127 * rise).reshape(maps.shape[:-1])
    matched = pairs(whole)
    flow = np.full((shots, len(matched), FLOW, FLOW, 2), np.nan, np.float16)
    if count == whole:
        flow[:] = _flow(_nearness(maps[..., CHANNELS.index("nearness")]), camera, shots, matched)
    return Guides(maps, flow, _marks(probed, at, camera, places, opened, gone))


def paces_of(track: CameraTrack, at: NDArray[np.integer], seconds: float) -> NDArray[np.float64]:
    """How fast a camera goes, turns, and how unevenly it goes, about each of the frames ``at``: [k, 3].

    At most of the frames :func:`spans` of each, as ``PEOPLE_MARKS`` says.
    """
    frames = len(track.position)
    fps = frames / seconds
    step = np.linalg.norm(np.diff(track.position, axis=0), axis=1) * fps
    turn = (np.diff(track.rotation, axis=0) + np.pi) % (2 * np.pi) - np.pi
    turn *= fps
    turning = np.hypot(turn[:, 1], turn[:, 2] * np.cos(track.rotation[:-1, 1]))
    jerk = np.linalg.norm(np.diff(track.position, 3, axis=0), axis=1) * fps**3
    out = np.zeros((len(at), 3))
    for k, values in enumerate((step, turning, jerk)):
        for n, (begin, end) in enumerate(spans(at)):
            some = values[begin:end]
            out[n, k] = np.sqrt(some.max()) if len(some) else 0.0
    return out


def room_of(
    solids: Solids, position: NDArray[np.floating], hidden: NDArray[np.bool_], places: Sequence[Places]
) -> NDArray[np.float64]:
    """Metres from cameras to the nearest thing, drawn wall or person, at most ``REACH``: [P k].

    position: [P k, 3] of P shots; hidden: [P, W], walls that are left out; places: [P] in these k frames
    """
    camera = position.astype(float)[:, None]
    count = len(camera) // len(places)
    found = clearance(solids, nearby(solids, camera), np.repeat(hidden, count, axis=0))
    people = np.full(len(camera), REACH)
    for k, of in enumerate(places):
        rows = slice(k * count, (k + 1) * count)
        others = [(foot[:, None], crown[:, None], radius) for foot, crown, radius in of.others]
        people[rows] = to_people(camera[rows], others)
    return np.minimum(np.minimum(found.object, found.shown), people)


def _marks(
    probed: Probed,
    at: Pointed,
    camera: Camera,
    places: Sequence[Places],
    opened: Sequence[bool],
    gone: NDArray[np.floating],
) -> NDArray[np.float16]:
    """float16 [P, T, len(MARKS)]; probed: what is seen where the points are, [P T, points]."""
    shots, near = len(places), probed.near
    count = len(near) // shots
    points = np.concatenate([p.points for p in places]).astype(float)
    face = np.concatenate([p.face for p in places]).astype(float)
    position, focal = camera.position.astype(float), camera.focal.astype(float)
    axes = camera.axes.astype(float)
    inside, place = at.pixels >= 0, at.place
    own = np.log(FAR / np.maximum(at.depth, NEAREST, where=inside, out=np.ones_like(at.depth)))
    seen = np.log(FAR * np.clip(near, 1 / FAR, 1 / NEAREST))
    before = np.where(inside, np.where(near > 0, seen, -1.0) - own, np.nan)
    own_points = np.arange(len(ALL_POINTS)) < len(POINTS)  # where nobody stands in their own way
    covered = np.where(inside & own_points & (probed.role == SUBJECT), 0.0, before)
    told = np.stack([place[..., 0], place[..., 1], covered], axis=-1)
    waist, eyes = (points[:, POINTS.index(name)] for name in ("waist", "eyes"))
    away = np.maximum(np.linalg.norm(waist - position, axis=-1), 0.2)
    lean = np.arcsin(np.clip(-axes[:, 0, 2], -1, 1))
    seconds = np.repeat([p.seconds for p in places], count)
    alone = [*np.einsum("nac,nc->an", axes, face), np.log(focal / away), np.log(away), np.log(focal)]
    alone += [np.clip(position[:, 2] - eyes[:, 2], -_FARTHEST, _FARTHEST), lean, np.log(seconds)]
    alone += [before[:, POINTS.index("eyes")], np.repeat(np.asarray(opened, float), count)]
    of_people = _people(points, position, axes, places, count)
    first, others = (told[:, part].reshape(len(told), -1) for part in (own_points, ~own_points))
    marks = np.concatenate([first, np.stack(alone, axis=-1), others, of_people, gone], axis=1)
    assert marks.shape[1] == len(MARKS)
    return marks.reshape(shots, count, len(MARKS)).astype(np.float16)


def _people(
    points: NDArray[np.float64],
    position: NDArray[np.float64],
    axes: NDArray[np.float64],
    places: Sequence[Places],
    count: int,
) -> NDArray[np.float64]:
    """Of each of the people where the face points, how much to the camera, how far they are, and whether the
    shot is about them: [P k, 4 PEOPLE]."""
    faces = np.concatenate([p.faces for p in places]).astype(float)
    first = len(POINTS) + PERSON_POINTS.index("eyes")
    eyes = points[:, first : first + PEOPLE * len(PERSON_POINTS) : len(PERSON_POINTS)]
    to_camera = position[:, None] - eyes
    away = np.maximum(np.linalg.norm(to_camera, axis=-1), 0.2)
    right = np.einsum("nc,nkc->nk", axes[:, 0], faces)
    turned = np.einsum("nkc,nkc->nk", faces, to_camera) / away
    meant = np.repeat(np.stack([p.meant for p in places]), count, axis=0)
    meant = np.where(np.isfinite(away), meant, np.nan)
    return np.stack([right, turned, np.log(away), meant], axis=-1).reshape(len(points), -1)


def _rays(camera: Camera, side: int) -> NDArray[np.float32]:
    """Directions of the middles of cells, one ahead, in the world: float32 [N, side, side, 3]."""
    along = (np.arange(side, dtype=np.float32) + 0.5) * 2 / side - 1
    right = along[None, None, :, None] * camera.sensor[0] / 2 / camera.focal[:, None, None, None]
    up = -along[None, :, None, None] * camera.sensor[1] / 2 / camera.focal[:, None, None, None]
    axes = camera.axes[:, None, None]
    return np.asarray(axes[..., 2, :] + right * axes[..., 0, :] + up * axes[..., 1, :], np.float32)


def _nearness(code: NDArray[np.uint8]) -> NDArray[np.float32]:
    """1/z in the cells of a field of flow, float32 [P, T, FLOW, FLOW]; code: [P, T, SIDE, SIDE]."""
    table = np.exp((np.arange(256) - 1) / 254 * np.log(FAR / NEAREST)) / FAR
    table[0] = 0.0
    step = SIDE // FLOW
    shape = (*code.shape[:2], FLOW, step, FLOW, step)
    return np.asarray(table.astype(np.float32)[code].reshape(shape).mean((3, 5)))


def _flow(
    near: NDArray[np.float32], camera: Camera, shots: int, matched: list[tuple[int, int]]
) -> NDArray[np.float32]:
    """Where the camera's motion takes what is seen, float32 [P, pairs, FLOW, FLOW, 2]."""
    before, after = (np.array(side) for side in zip(*matched, strict=True))

    def by_shot(values: NDArray[np.floating]) -> NDArray[np.floating]:
        return values.reshape(shots, -1, *values.shape[1:])

    ray, place = by_shot(_rays(camera, FLOW))[:, before], by_shot(camera.position)
    gone = (place[:, before] - place[:, after])[:, :, None, None]
    ahead = ray + near[:, before, :, :, None] * gone  # homogeneous: what is far only turns
    seen = np.einsum("npyxc,npac->npyxa", ahead, by_shot(camera.axes)[:, after])
    depth = np.maximum(seen[..., 2:], _BEHIND)
    lens = 2 * by_shot(camera.focal)[:, after, None, None, None] / np.array(camera.sensor)
    there = lens * seen[..., :2] / depth * (1, -1)
    along = (np.arange(FLOW) + 0.5) * 2 / FLOW - 1
    here = np.stack(np.meshgrid(along, along), axis=-1)
    return np.asarray(np.clip(there - here, -_FARTHEST, _FARTHEST), np.float32)
