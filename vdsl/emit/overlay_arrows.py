"""Arrows in a still, as storyboard artists draw them: red for the camera's movement, white for people's.

Assumes a take with its track and the ways of its people. Guarantees that an arrow begins at the moment of
the still and shows what comes after it; that people's arrows lie in the picture's own space, on the floor
they walk on; and that nothing is drawn where nothing moves enough.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from ..cinema.track import CameraTrack, project
from .remember import remembering
from .types import BuiltTake, Walk

Array = NDArray[np.float64]
Point = tuple[float, float]

CAMERA, PERSON, RIM = (196, 48, 36, 255), (255, 253, 247, 236), (27, 28, 31, 255)
_FINE = 3  # drawn so many times larger, then reduced: smooth edges
_SHORTEST = 0.09  # of the picture's width: a way shorter than this needs no arrow
_INSIDE = (0.045, 0.955)
#: Half the width of a person's arrow: metres, and the least and most of the picture's width that may come to.
_RIBBON, _THIN, _THICK = 0.085, 0.007, 0.017
#: Half the width of an arrow's head, and its length, in half widths of the arrow.
_BARB, _HEAD = 2.5, 4.9
#: Sine of the angle at which the camera must look down on a floor for an arrow to lie on it.
_FLAT = 0.2
_AHEAD = 0.4  # metres in front of where somebody stands, so that the arrow is not on their feet


def arrowed(image: Image.Image, take: BuiltTake, frame: int) -> Image.Image:
    """A copy of a still of a take with arrows for what moves after it; frame: which one it is."""
    out = image.convert("RGBA")
    out.alpha_composite(_arrows(take.people, take.camera.movement, take.camera.track, frame, image.size))
    return out.convert("RGB")


@remembering(100)
def _arrows(
    people: Sequence[Walk], movement: str, track: CameraTrack, frame: int, size: tuple[int, int]
) -> Image.Image:
    """The arrows alone, RGBA."""
    large = Image.new("RGBA", (size[0] * _FINE, size[1] * _FINE), (0, 0, 0, 0))
    draw = ImageDraw.Draw(large)
    for walk in people:
        for polygon in _way(walk, track, frame):
            _fill(draw, polygon, large.size, PERSON, RIM)
    for polygon in camera_arrows(movement, track, frame):
        _fill(draw, polygon, large.size, CAMERA, (255, 253, 247, 255))
    return large.resize(size, Image.Resampling.BOX)


def _fill(
    draw: ImageDraw.ImageDraw,
    polygon: Sequence[Point],
    size: tuple[int, int],
    fill: tuple[int, int, int, int],
    rim: tuple[int, int, int, int],
) -> None:
    points = [(x * size[0], y * size[1]) for x, y in polygon]
    thick = max(2, round(min(size) / 150))
    draw.line([*points, points[0], points[1]], rim, 2 * thick, "curve")
    draw.polygon(points, fill)


# --- people -----------------------------------------------------------------------------------


def _way(walk: Walk, track: CameraTrack, frame: int) -> list[list[Point]]:
    """The arrow of somebody's way from a frame on, in shares of the picture; nothing where they stay."""
    path = _resampled(walk.position[frame:])
    if len(path) < 4:
        return []
    for lift in (0.02, 0.95, 1.35):
        seen = _seen(path + np.array([0.0, 0.0, lift]), track, frame)
        upright = lift > 0.5 or _grazed(seen, track, frame)
        if len(seen) >= 4 and _length(_pictured(seen, track, frame), track) > _SHORTEST:
            return [_ribbon(seen, upright, track, frame)]
    return []


def _grazed(path: Array, track: CameraTrack, frame: int) -> bool:
    """Whether the floor along a way is seen so flat that what lies on it is but a line."""
    if len(path) == 0:
        return True
    to = track.position[frame] - path.mean(0)
    return bool(abs(to[2]) < _FLAT * np.linalg.norm(to))


def _resampled(position: Array, step: float = 0.06) -> Array:
    """A way in steps of a few centimetres, without its beginning; empty where it is too short."""
    away = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(position, axis=0), axis=1))])
    if away[-1] < 2 * _AHEAD:
        return np.zeros((0, 3))
    at = np.arange(_AHEAD, away[-1], step)
    return np.stack([np.interp(at, away, position[:, i]) for i in range(3)], -1)


def _seen(path: Array, track: CameraTrack, frame: int) -> Array:
    """The first stretch of a way that is in the picture."""
    at = _pictured(path, track, frame)
    low, high = _INSIDE
    inside = np.asarray(np.isfinite(at).all(1) & (at > low).all(1) & (at < high).all(1))
    if not inside.any():
        return path[:0]
    first = int(np.argmax(inside))
    gone = np.flatnonzero(~inside[first:])
    return path[first : first + (int(gone[0]) if len(gone) else len(path))]


def _pictured(points: Array, track: CameraTrack, frame: int) -> Array:
    """Shares of the picture [K, 2]; not a number behind the camera."""
    at, depth = project(points, track.position[frame], track.axes[frame], track.focal[frame], track.sensor)
    return np.where(depth[:, None] > 0.2, at, np.nan)


def _length(at: Array, track: CameraTrack) -> float:
    """Of a way in the picture, in widths of it."""
    steps = np.diff(at, axis=0) * (1.0, track.sensor[1] / track.sensor[0])
    return float(np.linalg.norm(steps, axis=1).sum())


def _ribbon(path: Array, upright: bool, track: CameraTrack, frame: int) -> list[Point]:
    """An arrow along a way as a band of metres, lying on the floor or upright, as the camera sees it."""
    distance = float(np.linalg.norm(path.mean(0) - track.position[frame]))
    metre = float(track.focal[frame]) / track.sensor[0] / max(distance, 0.2)  # in widths of the picture
    half = min(max(_RIBBON, _THIN / metre), _THICK / metre)
    up = np.array([0.0, 0.0, 1.0])
    if upright:
        path = path + _BARB * half * up
    aside = np.broadcast_to(up, path.shape) if upright else np.cross(up, _along(path))
    at = _pictured(_outline(path, aside, half), track, frame)
    return [(float(x), float(y)) for x, y in at[np.isfinite(at).all(1)]]


def _along(line: Array) -> Array:
    """Its direction at every point, of length 1."""
    along = np.gradient(line, axis=0)
    return np.asarray(along / np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-9))


def _outline(line: Array, aside: Array, half: float) -> Array:
    """The outline of an arrow along a line [K, D]; aside: [K, D], to its side; half: half its width."""
    away = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
    head = min(_HEAD * half, 0.6 * away[-1])
    neck = max(1, int(np.searchsorted(away, away[-1] - head)))
    shaft, wide = line[: neck + 1], half * aside[: neck + 1]
    barb = _BARB * half * aside[neck]
    return np.concatenate(
        [shaft + wide, [line[neck] + barb], line[-1:], [line[neck] - barb], (shaft - wide)[::-1]]
    )


# --- the camera -------------------------------------------------------------------------------

#: Straight arrows at the picture's edges: where the tail is, and which way it points.
_STRAIGHT = {
    "dolly-left": ((0.18, 0.10), (-1, 0)), "dolly-right": ((0.82, 0.10), (1, 0)),
    "pedestal-up": ((0.05, 0.42), (0, -1)), "pedestal-down": ((0.05, 0.58), (0, 1)),
    "crane-up": ((0.05, 0.42), (0, -1)), "crane-down": ((0.05, 0.58), (0, 1)),
}  # fmt: skip
#: Bent arrows for a camera that turns where it stands.
_BENT = {
    "pan-left": ((0.18, 0.10), (-1, 0)), "pan-right": ((0.82, 0.10), (1, 0)),
    "whip-pan-left": ((0.18, 0.10), (-1, 0)), "whip-pan-right": ((0.82, 0.10), (1, 0)),
    "tilt-up": ((0.08, 0.42), (0, -1)), "tilt-down": ((0.08, 0.58), (0, 1)),
}  # fmt: skip
_NEARER = ("push", "zoom-in", "dolly-zoom-in")
_FARTHER = ("pull", "zoom-out", "dolly-zoom-out")


def camera_arrows(movement: str, track: CameraTrack, frame: int) -> list[list[Point]]:
    """Outlines of arrows for a movement, in shares of the picture; none for a camera that stays.

    movement: a word of the language, or two joined by ``+``
    """
    shape = track.sensor[0] / track.sensor[1]
    words = movement.split("+")
    return [polygon for word in words for polygon in _arrows_of(word, track, frame, shape)]


def _arrows_of(word: str, track: CameraTrack, frame: int, shape: float) -> list[list[Point]]:
    if word in _STRAIGHT:
        return [_bent(*_STRAIGHT[word], 0.0, shape)]
    if word in _BENT:
        return [_bent(*_BENT[word], 0.28, shape)]
    if word in _NEARER or word in _FARTHER:
        return _corners(word in _NEARER, shape)
    if word.startswith("arc-"):
        return [_orbit(1.0 if word == "arc-right" else -1.0, shape)]
    if word.startswith("roll-"):
        return [_rolled(1.0 if word == "roll-right" else -1.0, shape)]
    return _followed(track, frame, shape) if word == "follow" else []


def _followed(track: CameraTrack, frame: int, shape: float) -> list[list[Point]]:
    """Where a camera that goes along with somebody goes: sideways or up as an arrow, in depth as corners."""
    away = track.position[-1] - track.position[frame]
    right, up, forward = track.axes[frame] @ away
    if max(abs(right), abs(up), abs(forward)) < 0.3:
        return []
    if abs(forward) > max(abs(right), abs(up)):
        return _corners(forward > 0, shape)
    if abs(right) > abs(up):
        word = "dolly-right" if right > 0 else "dolly-left"
    else:
        word = "pedestal-up" if up > 0 else "pedestal-down"
    return [_bent(*_STRAIGHT[word], 0.0, shape)]


def _bent(tail: Point, way: tuple[int, int], bend: float, shape: float) -> list[Point]:
    """An arrow of a tenth of the picture's width, bent to one side by a share of its length."""
    length = 0.15
    t = np.linspace(0, 1, 24)
    line = np.stack([t * way[0], t * way[1]], -1) * length
    bulge = -bend * length * 4 * t * (1 - t)
    line += bulge[:, None] * np.array([abs(way[1]), abs(way[0])])
    return _stroked(line, tail, shape)


def _orbit(side: float, shape: float) -> list[Point]:
    """Half an ellipse along the foot of the picture, towards where the camera goes."""
    t = np.linspace(math.pi * 0.94, math.pi * 0.06, 40)
    line = np.stack([0.3 * np.cos(t) * side, 0.085 * np.sin(t)], -1)
    return _stroked(line, (0.5, 0.80), shape)


def _rolled(side: float, shape: float) -> list[Point]:
    """Most of a circle in the upper corner."""
    t = np.linspace(-0.8 * math.pi, 0.45 * math.pi, 40)
    line = 0.055 * np.stack([side * np.sin(t), -np.cos(t)], -1)
    return _stroked(line, (0.90, 0.16), shape)


def _corners(nearer: bool, shape: float) -> list[list[Point]]:
    """An arrow in every corner, inwards or outwards."""
    out = []
    for x, y in ((0, 0), (1, 0), (1, 1), (0, 1)):
        outer = np.array([0.035 if x == 0 else 0.965, 0.035 * shape if y == 0 else 1 - 0.035 * shape])
        inner = outer + np.array([0.105 if x == 0 else -0.105, (0.07 if y == 0 else -0.07) * shape])
        start, end = (outer, inner) if nearer else (inner, outer)
        line = np.linspace(0, 1, 12)[:, None] * ((end - start) * (1.0, 1 / shape))
        out.append(_stroked(line, (float(start[0]), float(start[1])), shape))
    return out


def _stroked(line: Array, start: Point, shape: float) -> list[Point]:
    """A line [K, 2] in widths of the picture, made an arrow and put at a place of the picture."""
    along = _along(line)
    outline = _outline(line, np.stack([-along[:, 1], along[:, 0]], -1), 0.0085)
    return [(start[0] + float(x), start[1] + float(y) * shape) for x, y in outline]
