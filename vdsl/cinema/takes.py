"""Takes to be measured, and what all measures need of them: the frames looked at, the window, where the
landmarks are in the picture.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from . import space
from .framing import Array
from .sizes import Size
from .subject import Subject, marks_at
from .track import CameraTrack, project
from .vectors import dot, length

Bools = NDArray[np.bool_]

#: Frames of a take that are looked at, at most: as many as the ranker is shown, and the same ones.
SAMPLES = 8
#: How much the last frame counts beside the mean of all, of what is :func:`remembered`.
_ENDS = 0.35


@dataclass(frozen=True, eq=False)
class Pictures:
    """What small pictures of P takes show in the F frames that are measured.

    depth: float32 [P, F, H, W], metres along the optical axis, inf where nothing is
    what: uint8 [P, F, H, W], NOTHING, a THING, a thing that is MOVED, or FIRST and on one of the people; what
        is filmed itself counts as NOTHING
    people: their names, in this order; over: of them over whose shoulders it looks, who are to be near
    """

    depth: NDArray[np.float32]
    what: NDArray[np.uint8]
    people: tuple[str, ...]
    over: tuple[str, ...] = ()

    NOTHING: ClassVar[int] = 0
    THING: ClassVar[int] = 1
    MOVED: ClassVar[int] = 2
    FIRST: ClassVar[int] = 3

    def only(self, rows: NDArray[np.int64]) -> Pictures:
        """Of some of the takes."""
        return replace(self, depth=self.depth[rows], what=self.what[rows])


@dataclass(frozen=True, eq=False)
class Takes:
    """P takes to measure.

    sizes: of every take; window: bool [P, F] on the sampled frames; key: [P] frame the size is asked at
    paper: whether sizes are meant as the paper's distances rather than landmarks on lines
    others: pillars (foot [T, 3], crown [T, 3], radius) of everybody else
    ignore: object id whose boxes hide nothing (the thing filmed)
    interest: [T, 3] each, other points one would like to see
    view: one of :data:`vdsl.lang.ir.VIEWS`, or ""
    pictures: what they show, where they were drawn
    near: the boxes near the cameras at the sampled frames, where somebody has looked already
    """

    track: CameraTrack
    sizes: tuple[Size, ...]
    window: Bools
    key: NDArray[np.int64]
    roll: float
    paper: bool
    others: tuple[tuple[Array, Array, float], ...]
    ignore: int | None = None
    interest: tuple[Array, ...] = ()
    near: space.Nearby | None = None
    view: str = ""
    pictures: Pictures | None = None

    def only(self, rows: NDArray[np.int64]) -> Takes:
        """Some of the takes (rows in rising order)."""
        return replace(
            self,
            track=self.track.only(rows),
            sizes=tuple(self.sizes[row] for row in rows),
            window=self.window[rows],
            key=self.key[rows],
            near=None if self.near is None else self.near.only(rows),
            pictures=None if self.pictures is None else self.pictures.only(rows),
        )


def samples(frames: int) -> NDArray[np.int64]:
    """Indices of the frames looked at."""
    count = min(frames, SAMPLES)
    return np.asarray((np.arange(count) * ((frames - 1) / max(count - 1, 1))).round().astype(np.int64))


@dataclass(frozen=True, eq=False)
class Picture:
    """xy: [P, F, K, 2] picture coordinates of the landmarks; depth: [P, F, K]."""

    names: list[str]
    xy: Array
    depth: Array

    def of(self, name: str) -> Array:
        return np.asarray(self.xy[:, :, self.names.index(name)])


def pictured(takes: Takes, one: Subject, at: NDArray[np.int64], camera: Array, axes: Array) -> Picture:
    """Where somebody's landmarks are in the pictures of the frames ``at``."""
    names = list(one.landmarks)
    points = marks_at(one, names, at)
    return Picture(names, *project(points[None], camera, axes, takes.track.focal[:, at], takes.track.sensor))


def turned(one: Subject, at: NDArray[np.int64], camera: Array) -> Array:
    """Cosine between a face and the direction from its eyes to the camera, [P, F]."""
    to_camera = camera - one.landmarks["eyes"][at]
    return np.asarray(dot(to_camera, one.face[None, at]) / np.maximum(length(to_camera), 1e-9))


def mean_of(values: Array | Bools, window: Bools) -> Array:
    """Mean over the window's frames: [P, F] -> [P]."""
    return np.asarray((values * window).sum(axis=1) / np.maximum(window.sum(axis=1), 1))


def remembered(values: Array | Bools, window: Bools) -> Array:
    """The same, the last frame counting for :data:`_ENDS` where it is one of the window: it is what is left
    of a take when the next one begins."""
    mean = mean_of(values, window)
    return np.asarray(np.where(window[:, -1], (1.0 - _ENDS) * mean + _ENDS * values[:, -1], mean))


def key_sample(takes: Takes, at: NDArray[np.int64]) -> NDArray[np.int64]:
    return np.asarray(np.abs(at[None] - takes.key[:, None]).argmin(axis=1))


def within(xy: Array, depth: Array, margin: float) -> Bools:
    """Which points are before the camera and inside the frame by so much of its size."""
    x, y, far = xy[..., 0], xy[..., 1], 1.0 - margin
    return np.asarray((depth > 0.05) & (x > margin) & (x < far) & (y > margin) & (y < far))


def visibility(takes: Takes, inside: Bools, seen: Bools) -> dict[str, Array]:
    """Measures of how much of a subject is seen, by which of its points [P, F, K] are in the frame, and which
    nothing hides; the eyes come first."""
    window = takes.window[:, :, None]
    shown = (inside & window).sum(axis=(1, 2))
    clear = (inside & seen & window).sum(axis=(1, 2))
    some = (inside & seen).sum(axis=2) / np.maximum(inside.sum(axis=2), 1)
    first, last = takes.window.argmax(axis=1), len(some[0]) - 1 - takes.window[:, ::-1].argmax(axis=1)
    rows = np.arange(len(some))
    head = (inside[:, :, 0] & seen[:, :, 0] & takes.window).sum(axis=1) / np.maximum(
        takes.window.sum(axis=1), 1
    )
    return {
        "visibility": clear / np.maximum(shown, 1),
        "head_visible": head,
        "ends_visible": np.minimum(some[rows, first], some[rows, last]),
    }
