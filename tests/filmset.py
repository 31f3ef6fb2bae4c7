"""Small worlds and people made by hand, for the tests of framing, proposing and walking."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from runtime.body.proportions import make_skeleton
from runtime.body.skeleton import JOINTS, Skeleton, forward_kinematics
from runtime.body.spec import BodySpec
from runtime.mesh import empty
from runtime.world import Light, Solids, Spot, Wall, World, WorldObject
from vdsl.lang.ir import Shot, Target
from vdsl.lang.source import Source, Span
from vdsl.propose.types import Performance, StoryProposal

SPAN = Span(Source("<test>", ""), 0, 0)
LIGHT = Light((0, 0, 1), (1, 1, 1), (1, 1, 1), (1, 1, 1), ((1, 1, 1), (1, 1, 1)))
Box = tuple[float, float, float, float, float, float, float]


def world(
    floors: tuple[tuple[float, float, float, float], ...] = ((-15.0, -15.0, 15.0, 15.0),),
    boxes: tuple[Box, ...] = (),
    walls: tuple[Wall, ...] = (),
    box_walls: tuple[int, ...] = (),
    objects: tuple[WorldObject, ...] = (),
    outdoor: bool = True,
) -> World:
    """boxes: (x, y, z, half x, half y, half z, yaw); box_walls: wall of each, −1 for furniture."""
    b = np.array(boxes, float).reshape(-1, 7)
    wall = np.array(box_walls or (-1,) * len(b), np.int32)
    owner = np.where(wall >= 0, -1, np.arange(len(b))).astype(np.int32)
    solids = Solids(b[:, :3], b[:, 3:6], b[:, 6], wall, owner)
    none = np.zeros(0, np.int32)
    return World("test", empty(), none, none, objects, solids, walls, floors, LIGHT, outdoor)


def thing(
    id: int,
    name: str,
    low: tuple[float, float, float],
    high: tuple[float, float, float],
    spots: tuple[Spot, ...] = (),
    kind: str = "box",
) -> WorldObject:
    return WorldObject(id, (name,), kind, spots, low, high, np.eye(4))


def skeleton(height: float = 1.7) -> Skeleton:
    return make_skeleton(BodySpec(height=height))


def standing(
    body: Skeleton, path: NDArray[np.float64], heading: NDArray[np.float64], lean: float = 0.0
) -> Performance:
    """A stiff figure carried along a floor path [T, 3], bent forward at the hips by ``lean``."""
    frames = len(path)
    rotations = np.tile(np.eye(3), (frames, len(JOINTS), 1, 1))
    c, s = np.cos(heading), np.sin(heading)
    turn = np.zeros((frames, 3, 3))
    turn[:, 0, 0], turn[:, 0, 1], turn[:, 1, 0], turn[:, 1, 1], turn[:, 2, 2] = c, -s, s, c, 1
    bend = np.array([[np.cos(lean), 0, np.sin(lean)], [0, 1, 0], [-np.sin(lean), 0, np.cos(lean)]])
    rotations[:, 0] = turn
    rotations[:, JOINTS.index("spine")] = bend
    joints = forward_kinematics(body, rotations, path + np.array((0.0, 0.0, body.bind[0, 2])))
    return Performance(joints.astype(np.float32), path, heading)


def story(performances: dict[str, Performance], index: int = 0) -> StoryProposal:
    frames = len(next(iter(performances.values())).position)
    return StoryProposal(index, "plain", 0, frames, performances, {})


def still_story(body: Skeleton, frames: int = 48, at: tuple[float, float] = (0.0, 0.0)) -> StoryProposal:
    path = np.tile((*at, 0.0), (frames, 1))
    return story({"anna": standing(body, path, np.zeros(frames))})


def walking_story(body: Skeleton, frames: int = 72, metres: float = 3.0) -> StoryProposal:
    t = np.linspace(0, 1, frames)
    path = np.stack([metres * t, 0.3 * np.sin(2 * t), np.zeros(frames)], axis=1)
    return story({"anna": standing(body, path, 0.2 * t)})


def shot(
    movement: str = "static", scale: str = "medium", angle: str = "eye-level", **changes: object
) -> Shot:
    given: dict[str, object] = {
        "id": "s1",
        "line": 1,
        "movements": (movement,),
        "scales": (scale,),
        "angles": (angle,),
        "lens": (30.0, 80.0),
        "ease": (0.1, 1.0, 10.0),
        "duration": None,
        "roll": 0.0,
        "focus": Target("character", ("anna",), "anna", SPAN),
        "say": None,
        "note": None,
        "proposals": 40,
        "takes": 5,
        "speed": 1.0,
        "style": "board",
        "span": SPAN,
    }
    return Shot(**(given | changes))  # type: ignore[arg-type]
