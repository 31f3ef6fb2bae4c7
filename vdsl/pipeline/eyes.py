"""From where stills are taken: eyes around a point, at the doors of a set, and where a pose is best seen.

Metres and radians; a sensor 24 mm high whatever the picture's shape.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from runtime.body.skeleton import JOINT
from runtime.raster.types import Camera
from runtime.world import World, WorldObject

from ..cinema.sight import clear_lines, distances
from ..cinema.track import camera_axes, look_at_rotation, project
from ..propose.types import StoryProposal
from .trial import Trial

_SENSOR = 24.0  # mm high
_PLAN_FOCAL = 85.0  # mm: long enough that walls do not lean much


@dataclass(frozen=True)
class Eye:
    """Where a still is taken from: position and aim in metres, focal length in mm on a sensor 24 mm high."""

    position: tuple[float, float, float]
    aim: tuple[float, float, float]
    focal: float = 50.0


def around(
    aim: tuple[float, float, float], azimuth: float, polar: float, height: float, focal: float = 50.0
) -> Eye:
    """An eye that sees ``height`` metres at its aim, from an azimuth and a polar angle from +Z (radians)."""
    r = height * focal / _SENSOR
    offset = (
        r * math.cos(azimuth) * math.sin(polar),
        r * math.sin(azimuth) * math.sin(polar),
        r * math.cos(polar),
    )
    return Eye((aim[0] + offset[0], aim[1] + offset[1], max(aim[2] + offset[2], 0.08)), aim, focal)


def eyes_camera(eyes: Sequence[Eye], size: tuple[int, int]) -> Camera:
    """The eyes as a batch of cameras for pictures of a size."""
    position = np.array([e.position for e in eyes])
    rotation = look_at_rotation(position, np.array([e.aim for e in eyes]))
    return Camera(
        position.astype(np.float32),
        camera_axes(rotation).astype(np.float32),
        np.array([e.focal for e in eyes], np.float32),
        (_SENSOR * size[0] / size[1], _SENSOR),
    )


def straight_down(extent: tuple[float, float, float, float], width: int) -> tuple[Eye, tuple[int, int]]:
    """An eye over a rectangle (x0, y0, x1, y1), its longer side across, and the size of a picture of it."""
    x0, y0, x1, y1 = extent
    turned = (y1 - y0) > (x1 - x0) * 1.05
    span = ((y1 - y0), (x1 - x0)) if turned else ((x1 - x0), (y1 - y0))
    height = max(200, round(width * (span[1] + 1.0) / (span[0] + 1.0)))
    away = (span[1] + 1.0) * _PLAN_FOCAL / _SENSOR
    middle = ((x0 + x1) / 2, (y0 + y1) / 2)
    lean = 1e-4 * away  # straight down has no horizon: a hair off says which way is up
    off = (lean, 0.0) if turned else (0.0, -lean)
    eye = Eye((middle[0] + off[0], middle[1] + off[1], away), (*middle, 0.0), _PLAN_FOCAL)
    return eye, (width // 2 * 2, height // 2 * 2)


def seen_at(eye: Eye, point: tuple[float, float, float], size: tuple[int, int]) -> tuple[float, float] | None:
    """Where in a picture of a size (pixels) a point is seen; None behind the eye."""
    position = np.array(eye.position)
    axes = camera_axes(look_at_rotation(position, np.array(eye.aim)))
    sensor = (_SENSOR * size[0] / size[1], _SENSOR)
    at, depth = project(np.array([point], float), position, axes, np.array(eye.focal), sensor)
    if depth[0] <= 0:
        return None
    return float(at[0, 0]) * size[0], float(at[0, 1]) * size[1]


# --- sets -----------------------------------------------------------------------------------


def entrances(world: World, most: int = 2) -> list[Eye]:
    """Eyes at the doors of a set (at the rims of open ground), looking over its largest places."""
    rooms = [o for o in world.objects if o.kind in ("room", "area")]
    rooms = sorted(rooms, key=lambda o: (o.spot("middle") is None, -floor_area(o)))
    return [_entrance(world, room) for room in rooms[:most]]


def _entrance(world: World, room: WorldObject) -> Eye:
    """The place at a door or a rim from which most of a room is seen."""
    middle = next((s.position for s in room.spots if s.name == "middle"), room.centre)
    base = room.low[2]
    doors = [o for o in world.objects if o.kind in ("door", "doorway") and o.path[0] == room.path[0]]
    starts = [o.centre[:2] for o in doors] + _rims(room, 0.12)
    inward = [(x + 0.12 * (middle[0] - x), y + 0.12 * (middle[1] - y), base + 1.6) for x, y in starts]
    xs, ys = (
        np.linspace(0.2, 0.8, 5) * (b - a) + a for a, b in zip(room.low[:2], room.high[:2], strict=True)
    )
    ground = np.array([(x, y, base + z) for x in xs for y in ys for z in (0.6, 1.3)])
    eye = np.array(inward)[:, None]
    hidden = np.zeros((len(inward), len(world.walls)), bool)
    seen = clear_lines(world.solids, eye, ground[None], hidden).mean((1, 2))
    free = distances(world.solids, eye[:, 0]).min(1, initial=9.0) > 0.35
    far = np.linalg.norm(eye[:, 0, :2] - np.array(middle[:2]), axis=1)
    x, y, z = inward[int(np.argmax(seen * free + 0.004 * np.minimum(far, 12.0)))]
    return Eye((x, y, z), (middle[0], middle[1], base + 1.5), 20.0)


def floor_area(room: WorldObject) -> float:
    return (room.high[0] - room.low[0]) * (room.high[1] - room.low[1])


def _rims(room: WorldObject, inset: float) -> list[tuple[float, float]]:
    """Points a little inside a room's corners and the middles of its sides."""
    (x0, y0), (x1, y1) = room.low[:2], room.high[:2]
    shares = (inset, 0.5, 1 - inset)
    return [(x0 + a * (x1 - x0), y0 + b * (y1 - y0)) for a in shares for b in shares if (a, b) != (0.5, 0.5)]


# --- poses ----------------------------------------------------------------------------------

#: From where poses are drawn, off the direction a person faces at the end; of two people, off the line
#: between them. The first from which most is seen is taken.
_SIDES = tuple(math.radians(a) for a in (-38, 38, -72, 72, -110, 110, -150))
_TWO_SIDES = tuple(math.radians(a) for a in (-78, 78, -50, 50))
_SEEN_JOINTS = ("head", "chest", "hips", "hand_l", "hand_r", "shin_l", "shin_r")


def _facing(trial: Trial, way: StoryProposal, frame: int) -> float:
    people = [way.performances[name] for name in trial.people]
    if len(people) == 1:
        turned = np.exp(1j * people[0].heading).mean()  # on the whole, with the way there
        return float(np.angle(turned))
    a, b = (p.position[frame] for p in people)
    return math.atan2(b[1] - a[1], b[0] - a[0])


def _pose_eye(trial: Trial, way: StoryProposal, frame: int, azimuth: float, cell: tuple[int, int]) -> Eye:
    """As near as shows everybody, heads to feet."""
    people = [way.performances[name] for name in trial.people]
    points = np.concatenate([p.world_from_joint[frame][:, :3, 3] for p in people])
    low, high = points.min(0), points.max(0)
    ground = min(float(p.position[frame, 2]) for p in people)
    aim = ((low[0] + high[0]) / 2, (low[1] + high[1]) / 2, max((low[2] + high[2]) / 2 + 0.04, ground + 0.78))
    across = np.array([-math.sin(azimuth), math.cos(azimuth)])
    wide = float(np.ptp(points[:, :2] @ across)) + 0.55
    tall = max(2.0, float(high[2]) + 0.42 - min(float(low[2]), ground))
    return around(aim, azimuth, math.radians(82), max(tall, wide * cell[1] / cell[0]))


def _share_seen(trial: Trial, way: StoryProposal, frames: NDArray[np.int64], eyes: Sequence[Eye]) -> float:
    """Share of the actors' joints that nothing solid hides."""
    joints = [JOINT[name] for name in _SEEN_JOINTS]
    points = np.concatenate(
        [way.performances[name].world_from_joint[frames][..., :3, 3][:, joints] for name in trial.people],
        axis=1,
    ).astype(np.float64)
    camera = np.array([[eye.position for eye in eyes]])
    world = trial.staged.world
    hidden = np.zeros((1, len(world.walls)), bool)
    return round(float(clear_lines(world.solids, camera, points, hidden).mean()), 1)


def pose_eyes(
    trial: Trial, way: StoryProposal, frames: NDArray[np.int64], cell: tuple[int, int]
) -> list[Eye]:
    """An eye for each frame of a performance, all from the side from which most is seen; cell: pixels."""
    sides = _TWO_SIDES if len(trial.people) > 1 else _SIDES
    turns = [(int(f), _facing(trial, way, int(f))) for f in frames]
    choices = [[_pose_eye(trial, way, frame, turn + off, cell) for frame, turn in turns] for off in sides]
    return max(choices, key=lambda eyes: _share_seen(trial, way, frames, eyes))
