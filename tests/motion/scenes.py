"""People, things and paths to try motion on, and what is measured on them."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

from runtime.body.proportions import make_skeleton
from runtime.body.skeleton import JOINT, PARENTS, Skeleton
from runtime.body.spec import BodySpec
from runtime.motion.timeline import Timeline
from runtime.motion.types import ActionClip, Actor, ActorState, PropState, SceneMotion, TargetPoint, Variant

Array = NDArray[np.float64]
FPS = 24.0


@cache
def skeleton(height: float = 1.7, age: float = 32.0) -> Skeleton:
    return make_skeleton(BodySpec(height=height, age=age))


def person(
    height: float = 1.7, x: float = 0.0, y: float = 0.0, heading: float = 0.0, **state: object
) -> Actor:
    age = 8.0 if height < 1.4 else 32.0
    return Actor(skeleton(height, age), ActorState((x, y, 0.0), heading, **state))  # type: ignore[arg-type]


def travelling(how: str = "walk") -> ActionClip:
    return ActionClip(how, (Variant("plain", 0.0, Timeline()),), travel=how)


def thing(x: float, y: float, z: float, grip: float = 0.05) -> PropState:
    matrix = np.eye(4)
    matrix[:3, 3] = x, y, z
    return PropState(matrix, (0.0, 0.0, grip))


def at(x: float, y: float, z: float, **more: object) -> TargetPoint:
    return TargetPoint((x, y, z), (x, y, z), **more)  # type: ignore[arg-type]


def random_path(rng: np.random.Generator, steps: int) -> Array:
    """A winding way of a few metres from the origin."""
    turns = np.cumsum(rng.uniform(-0.9, 0.9, steps)) + rng.uniform(-3, 3)
    lengths = rng.uniform(0.4, 1.5, steps)
    moves = np.stack([np.cos(turns), np.sin(turns)], axis=1) * lengths[:, None]
    return np.concatenate([np.zeros((1, 2)), np.cumsum(moves, axis=0)])


def joint(motion: SceneMotion, who: str, name: str) -> Array:
    """[T, 3]"""
    return motion.world_from_joint[who][:, JOINT[name], :3, 3].astype(np.float64)


def joint_rotation(motion: SceneMotion, who: str, name: str) -> Array:
    return motion.world_from_joint[who][:, JOINT[name], :3, :3].astype(np.float64)


def sole_points(motion: SceneMotion, who: str, body: Skeleton, side: str) -> Array:
    """Heel and ball of a foot on its sole [T, 2, 3]."""
    ankle = body.bind[JOINT[f"foot_{side}"]]
    ball = body.bind[JOINT[f"toe_{side}"]]
    heel = ankle + np.array([-0.30 * (ball - ankle)[0], 0.0, -ankle[2]])
    under = np.array([ball[0], ball[1], 0.0])
    foot, toe = joint_rotation(motion, who, f"foot_{side}"), joint_rotation(motion, who, f"toe_{side}")
    return np.stack(
        [
            joint(motion, who, f"foot_{side}") + foot @ (heel - ankle),
            joint(motion, who, f"toe_{side}") + toe @ (under - ball),
        ],
        axis=1,
    )


def angular_steps(motion: SceneMotion, who: str) -> Array:
    """Turn of every joint but the lids against its parent between frames [T - 1, J], radians."""
    world = motion.world_from_joint[who][..., :3, :3].astype(np.float64)
    local = world.copy()
    for j, p in enumerate(PARENTS):
        if p >= 0:
            local[:, j] = np.swapaxes(world[:, p], -1, -2) @ world[:, j]
    step = np.swapaxes(local[:-1], -1, -2) @ local[1:]
    trace = np.trace(step, axis1=-2, axis2=-1)
    out: Array = np.arccos(np.clip((trace - 1) / 2, -1, 1))
    out[:, [JOINT["lid_l"], JOINT["lid_r"]]] = 0.0  # a blink is quick
    return out
