"""The one skeleton every person shares.

Joints are listed parents first. In the bind pose the person stands on Z = 0 facing +X with +Y
to their left, arms 45° out (an A), and every joint frame is aligned with the model axes: a local
rotation turns about the model's X (forward), Y (left) and Z (up).

Signs worth knowing, for the left side (mirror for the right): thumbs point forward and palms face the
thighs, so fingers curl by a negative turn about X; the jaw opens by a positive turn about Y; a positive
turn of an eye about Z looks left, about Y looks down; a lid closes by a positive turn about Y. Brows and
mouth corners are moved by small turns of their joints, which sit deep in the head: positive about Y
lowers, negative raises. ``index`` hangs on ``fingers`` and curls with it; turned by the inverse of
``fingers`` it points. ``indextip`` is its second half, as ``fingertips`` is of the other three.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

_CENTRE = (
    ("hips", None),
    ("spine", "hips"),
    ("chest", "spine"),
    ("neck", "chest"),
    ("head", "neck"),
    ("jaw", "head"),
)
_SIDE = (
    ("eye", "head"),
    ("lid", "head"),
    ("brow", "head"),
    ("mouth", "head"),
    ("clavicle", "chest"),
    ("upperarm", "clavicle"),
    ("forearm", "upperarm"),
    ("hand", "forearm"),
    ("fingers", "hand"),
    ("fingertips", "fingers"),
    ("index", "fingers"),
    ("indextip", "index"),
    ("thumb", "hand"),
    ("thigh", "hips"),
    ("shin", "thigh"),
    ("foot", "shin"),
    ("toe", "foot"),
)

#: Joint names, parents first: the centre chain, then all of the left (``_l``), then the right (``_r``).
JOINTS: tuple[str, ...] = tuple(n for n, _ in _CENTRE) + tuple(f"{n}_{s}" for s in "lr" for n, _ in _SIDE)
JOINT: dict[str, int] = {name: i for i, name in enumerate(JOINTS)}


def _parents() -> tuple[int, ...]:
    centre = [-1 if p is None else JOINT[p] for _, p in _CENTRE]
    names = {n for n, _ in _SIDE}
    sides = [JOINT[f"{p}_{s}" if p in names else p] for s in "lr" for _, p in _SIDE]
    return tuple(centre + sides)


#: Index of each joint's parent, -1 for the root.
PARENTS: tuple[int, ...] = _parents()


@dataclass(frozen=True, eq=False)
class Skeleton:
    """A skeleton of one person's proportions.

    bind: float64 [J, 3], joint positions in the bind pose, metres, model coordinates
    height: standing height to the crown, metres
    """

    bind: NDArray[np.float64]
    height: float

    @property
    def offsets(self) -> NDArray[np.float64]:
        """[J, 3]: each joint's position from its parent's in the bind pose; the root's from the origin."""
        parents = np.array(PARENTS)
        offsets = self.bind.copy()
        offsets[1:] -= self.bind[parents[1:]]
        return offsets


def forward_kinematics(
    skeleton: Skeleton, rotations: NDArray[np.floating], root: NDArray[np.floating]
) -> NDArray[np.float64]:
    """World transforms of all joints.

    rotations: [T, J, 3, 3], local rotation of each joint relative to the bind pose; the root's is in the world
    root: [T, 3], position of the hips joint in the world, metres
    returns: float64 [T, J, 4, 4] world_from_joint
    """
    frames = len(rotations)
    world = np.zeros((frames, len(JOINTS), 4, 4))
    world[:, :, 3, 3] = 1.0
    offsets = skeleton.offsets
    for j, parent in enumerate(PARENTS):
        if parent < 0:
            world[:, j, :3, :3] = rotations[:, j]
            world[:, j, :3, 3] = root
        else:
            linear = world[:, parent, :3, :3]
            world[:, j, :3, :3] = linear @ rotations[:, j]
            world[:, j, :3, 3] = world[:, parent, :3, 3] + linear @ offsets[j]
    return world


def skinning_matrices(skeleton: Skeleton, world_from_joint: NDArray[np.floating]) -> NDArray[np.float32]:
    """World-from-bind matrices for linear blend skinning: float32 [T, J, 3, 4]."""
    out = np.array(world_from_joint[..., :3, :], dtype=np.float64)
    out[..., 3] -= np.einsum("tjab,jb->tja", out[..., :3], skeleton.bind)
    return out.astype(np.float32)
