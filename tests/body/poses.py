"""Posing bodies in tests: local turns by joint name, linear blend skinning in plain numpy."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from runtime.body.build import Body
from runtime.body.skeleton import JOINT, JOINTS, forward_kinematics, skinning_matrices


def turn(axis: tuple[float, float, float], degrees: float) -> NDArray[np.float64]:
    """A rotation matrix about an axis."""
    unit = np.array(axis, float) / np.linalg.norm(axis)
    return Rotation.from_rotvec(np.radians(degrees) * unit).as_matrix()


def elbow(side: str, degrees: float) -> NDArray[np.float64]:
    """The forearm bent forward by so many degrees."""
    sign = 1.0 if side == "l" else -1.0
    down = np.array([0.0, sign * 0.5**0.5, -(0.5**0.5)])
    axis = np.cross(down, (1.0, 0.0, 0.0))
    return turn((axis[0], axis[1], axis[2]), degrees)


def posed(body: Body, turns: dict[str, NDArray[np.float64]]) -> NDArray[np.float64]:
    """Vertices [V, 3] of a body with the given local rotations, hips where they are in the bind pose."""
    rotations = np.tile(np.eye(3), (1, len(JOINTS), 1, 1))
    for name, matrix in turns.items():
        rotations[0, JOINT[name]] = matrix
    root = body.skeleton.bind[JOINT["hips"]][None]
    matrices = skinning_matrices(body.skeleton, forward_kinematics(body.skeleton, rotations, root))[0]
    points = np.concatenate([body.mesh.vertices, np.ones((len(body.mesh.vertices), 1))], axis=1)
    each = np.einsum("vkab,vb->vka", matrices[body.joints].astype(np.float64), points)
    return np.einsum("vka,vk->va", each, body.weights.astype(np.float64))
