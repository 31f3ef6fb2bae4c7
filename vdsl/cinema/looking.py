"""What of points can be seen: by lines of sight while nothing is drawn, and by pictures once they are.

Cameras are proposed by lines past upright boxes and pillars; branches, arms and a back that is bent are none.
Assumes the frames that are measured (:func:`~vdsl.cinema.takes.samples`). What is out of a picture counts as
seen there: whether it is in the frame is for others to ask.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from runtime.world import Solids

from .framing import Array
from .sight import clear_lines, clear_of_people
from .takes import Bools, Pictures, Takes
from .track import project

#: Metres by which what is seen in a point's place has to be nearer to hide it: a thing that stands, as the
#: chair one sits on; one that is moved, which may be in the hand; somebody else, whom pictures tell from the
#: one they are before, however near they are; the own body, whose surface is not where its joints are.
_THING, _MOVED, _SOMEBODY, _OWN = 0.14, 0.5, 0.03, 0.3
_FAR_OFF = 0.01  # of the way, the same of somebody else: a pixel there is as broad as that
_AT_ONCE = 4096  # groups of lines
_NEAREST = 0.05  # metres before the camera from which on something is in its picture


class Sight(Protocol):
    """Whether points can be seen from P cameras in F frames."""

    def clear(self, points: Array, people: bool = True, some: NDArray[np.int64] | None = None) -> Bools:
        """Which of points [F, K, 3], or [P, F, K, 3], no wall or thing hides, nor, with ``people``, anybody
        but the subject: [P, F, K]. some: which of the frames they are of, all unless said"""
        ...

    def clear_apart(self, points: Array) -> Bools:
        """The same of points [F, K, 3] that lie far from each other, people and all."""
        ...

    def clear_each(self, takes: NDArray[np.int64], frames: NDArray[np.int64], points: Array) -> Bools:
        """Which of points [N, 3], each of one take and one frame, nothing hides: [N]. Lines of sight know of
        walls and things alone."""
        ...

    def shown(self, owners: tuple[str, ...], points: Array, people: int) -> Bools:
        """Which of points of people, [F, owners, K, 3], are seen: [P, F, owners, K]. Where pictures tell,
        nobody else hides them nor the own body; else as :meth:`clear`, with people for the first so many of
        the owners."""
        ...

    @property
    def by_pictures(self) -> bool:
        """Whether it tells what pictures show, own bodies and those of all people among it."""
        ...


@dataclass(frozen=True, eq=False)
class Lines:
    """Lines of sight. camera: [P, F, 3]; hidden: [P, W] walls taken away; others: pillars in these frames"""

    solids: Solids
    camera: Array
    hidden: Bools
    others: list[tuple[Array, Array, float]]
    ignore: int | None = None
    by_pictures: bool = False

    def clear(self, points: Array, people: bool = True, some: NDArray[np.int64] | None = None) -> Bools:
        eye, others = self.camera, self.others
        if some is not None:
            eye, others = eye[:, some], [(foot[some], crown[some], r) for foot, crown, r in others]
        seen = clear_lines(self.solids, eye, points, self.hidden, self.ignore)
        return np.asarray(seen & clear_of_people(eye, points, others)) if people else seen

    def clear_each(self, takes: NDArray[np.int64], frames: NDArray[np.int64], points: Array) -> Bools:
        eye, lines = self.camera[takes, frames][:, None], points[:, None, None]
        return clear_lines(self.solids, eye, lines, self.hidden[takes], self.ignore)[:, 0, 0]

    def clear_apart(self, points: Array) -> Bools:
        seen = self._by_groups(points[:, :, None])[..., 0]
        return np.asarray(seen & clear_of_people(self.camera, points, self.others))

    def shown(self, owners: tuple[str, ...], points: Array, people: int) -> Bools:
        seen = self._by_groups(points)
        if people:
            first = points[:, :people].reshape(len(points), -1, 3)
            passed = clear_of_people(self.camera, first, self.others)
            seen[:, :, :people] &= passed.reshape(*passed.shape[:2], people, -1)
        return seen

    def _by_groups(self, points: Array) -> Bools:
        """Which of points [F, G, K, 3] no wall or thing hides, [P, F, G, K]. What may be in the way is looked
        for group by group: of points that lie close together it is little."""
        ends = points.reshape(-1, *points.shape[2:])
        takes = max(_AT_ONCE // max(len(ends), 1), 1)  # at a time: what is near all of them is much memory
        seen = [np.zeros((0, *ends.shape[:2]), bool)]
        for begin in range(0, len(self.camera), takes):
            eye = np.repeat(self.camera[begin : begin + takes], points.shape[1], axis=1)
            hidden = self.hidden[begin : begin + takes]
            seen.append(clear_lines(self.solids, eye, ends, hidden, self.ignore))
        return np.concatenate(seen).reshape(len(self.camera), *points.shape[:3])


@dataclass(frozen=True, eq=False)
class Shown:
    """What pictures show. camera: [P, F, 3]; axes: [P, F, 3, 3]; focal: [P, F]

    own: by name those whom the shot is about, who are not in their own way, and over whom it looks
    """

    pictures: Pictures
    camera: Array
    axes: Array
    focal: Array
    sensor: tuple[float, float]
    own: frozenset[str]
    by_pictures: bool = True

    def clear(self, points: Array, people: bool = True, some: NDArray[np.int64] | None = None) -> Bools:
        frames = slice(None) if some is None else some
        ends = points if points.ndim == 4 else points[None]
        xy, depth = project(
            ends, self.camera[:, frames], self.axes[:, frames], self.focal[:, frames], self.sensor
        )
        count, many = depth.shape[:2]
        rows = np.arange(count)[:, None, None]
        columns = np.arange(many)[None, :, None] if some is None else some[None, :, None]
        others = [k for k, name in enumerate(self.pictures.people) if name not in self.own]
        return self._clear(rows, columns, xy, depth, others if people else [])

    def clear_apart(self, points: Array) -> Bools:
        return self.clear(points)

    def clear_each(self, takes: NDArray[np.int64], frames: NDArray[np.int64], points: Array) -> Bools:
        eye, axes, focal = (of[takes, frames] for of in (self.camera, self.axes, self.focal))
        xy, depth = project(points[:, None], eye, axes, focal, self.sensor)
        inside, _, near = self._at(takes[:, None], frames[:, None], xy, depth)
        return np.asarray(~(inside & (near < depth - _THING)))[:, 0]

    def shown(self, owners: tuple[str, ...], points: Array, people: int) -> Bools:
        out = []
        for k, name in enumerate(owners):
            xy, depth = project(points[None, :, k], self.camera, self.axes, self.focal, self.sensor)
            rows, frames = np.arange(len(depth))[:, None, None], np.arange(depth.shape[1])[None, :, None]
            others = [i for i, known in enumerate(self.pictures.people) if known != name]
            out.append(self._clear(rows, frames, xy, depth, others, name))
        return np.stack(out, axis=2)

    def _clear(
        self,
        takes: NDArray[np.int64],
        frames: NDArray[np.int64],
        xy: Array,
        depth: Array,
        others: list[int],
        owner: str = "",
    ) -> Bools:
        """others: the people who may be in the way; owner: whose points they are, if the own body may"""
        inside, what, near = self._at(takes, frames, xy, depth)
        room = np.full(1 + Pictures.FIRST + len(self.pictures.people), np.inf)
        room[Pictures.THING], room[Pictures.MOVED] = _THING, _MOVED
        room[Pictures.FIRST + np.array(others, int)] = _SOMEBODY
        if owner in self.pictures.people:
            room[Pictures.FIRST + self.pictures.people.index(owner)] = _OWN
        far = np.where(room[what] == _SOMEBODY, np.maximum(_SOMEBODY, _FAR_OFF * depth), room[what])
        return np.asarray(~(inside & (near < depth - far)))

    def _at(
        self, takes: NDArray[np.int64], frames: NDArray[np.int64], xy: Array, depth: Array
    ) -> tuple[Bools, NDArray[np.uint8], NDArray[np.float32]]:
        """Which of places are in the picture, what it shows there, and how far away that is."""
        high, wide = self.pictures.what.shape[2:]
        inside = (depth > _NEAREST) & (xy > 0.0).all(axis=-1) & (xy < 1.0).all(axis=-1)
        x, y = ((np.where(inside, xy[..., k], 0.0) * size).astype(int) for k, size in ((0, wide), (1, high)))
        return inside, self.pictures.what[takes, frames, y, x], self.pictures.depth[takes, frames, y, x]


def sight_of(takes: Takes, own: frozenset[str], solids: Solids, at: NDArray[np.int64],
             camera: Array, axes: Array, hidden: Bools) -> Sight:  # fmt: skip
    """How takes are looked at: by their pictures where they were drawn, else by lines of sight."""
    pictures = takes.pictures
    if pictures is not None:
        own = own.union(pictures.over)
        return Shown(pictures, camera, axes, takes.track.focal[:, at], takes.track.sensor, own)
    others = [(foot[at], crown[at], radius) for foot, crown, radius in takes.others]
    return Lines(solids, camera, hidden, others, takes.ignore)
