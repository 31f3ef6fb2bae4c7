"""The one skeleton every person shares.

Joints are listed parents first. In the bind pose the person stands on Z = 0 facing +X with +Y
to their left, arms 45° out (an A), and every joint frame is aligned with the model axes: a local
rotation turns about the model's X (forward), Y (left) and Z (up).

Signs worth knowing, for the left side (mirror for the right): thumbs point forward and palms face the
thighs, so fingers curl by a negative turn about X; the jaw opens by a positive turn about Y; a positive
turn of an eye about Z looks left, about Y looks down; a lid closes by a positive turn about Y, an
``underlid`` by a negative one. Brows, mouth corners and ``lip`` (the upper lip) are moved by small turns of
their joints, which sit deep in the head: positive about Y lowers, negative raises. ``browin`` moves the
inner end of a brow on top of ``brow``. ``index`` hangs on ``fingers`` and curls with it; turned by the
inverse of ``fingers`` it points. ``indextip`` is its second half, as ``fingertips`` is of the other three.
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
    ("lip", "head"),
)
_SIDE = (
    ("eye", "head"),
    ("lid", "head"),
    ("underlid", "head"),
    ("brow", "head"),
    ("browin", "brow"),
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

#: Helpers of the skin that nobody animates, and the joint each follows (see :func:`skinning_matrices`).
HELPERS: tuple[tuple[str, str], ...] = tuple(
    (f"{kind}_{s}", f"{joint}_{s}")
    for s in "lr"
    for kind, joint in (
        ("half-shoulder", "upperarm"),
        ("half-elbow", "forearm"),
        ("twist", "hand"),
        ("half-hip", "thigh"),
        ("half-knee", "shin"),
    )
)
#: How far kneecap and elbow come forward (back, where negative) when bent, as shares of the height.
_PUSH = {"half-knee": 0.020, "half-elbow": -0.010}
#: Everything a vertex of a body may hang on: the joints, then the helpers.
PALETTE: tuple[str, ...] = JOINTS + tuple(name for name, _ in HELPERS)


@dataclass(frozen=True, eq=False)
class Skeleton:
    """A skeleton of one person's proportions.

    bind: float64 [J, 3], joint positions in the bind pose, metres, model coordinates
    height: standing height to the crown, metres
    above: how far a hat or hair rises above that of somebody with short hair, metres
    """

    bind: NDArray[np.float64]
    height: float
    above: float = 0.0

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

    rotations: [T, J, 3, 3], local rotation of each joint relative to the bind pose;
        the root's is in the world
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
    """World-from-bind matrices for linear blend skinning: float32 [T, len(PALETTE), 3, 4].

    world_from_joint: [T, J, 4, 4], one for each of :data:`JOINTS`. The helpers that follow them in
    :data:`PALETTE` are derived here: a half joint turns half as far as its joint does against its parent
    and keeps elbows, knees, shoulders and hips full when they bend; a twist takes half of the hand's turn
    about the forearm.
    """
    frames = len(world_from_joint)
    world = np.empty((frames, len(PALETTE), 3, 4))
    world[:, : len(JOINTS)] = world_from_joint[..., :3, :]
    bind = np.concatenate([skeleton.bind, np.zeros((len(HELPERS), 3))])
    for k, (name, joint) in enumerate(HELPERS, len(JOINTS)):
        j = JOINT[joint]
        parent = PARENTS[j]
        base, linear = world_from_joint[:, parent, :3, :3], world_from_joint[:, j, :3, :3]
        turn = _quaternion(np.swapaxes(base, -1, -2) @ linear)
        if name.startswith("twist"):
            axis = skeleton.bind[j] - skeleton.bind[parent]
            axis = axis / np.linalg.norm(axis)
            turn = np.concatenate([turn[:, :1], (turn[:, 1:] @ axis)[:, None] * axis], axis=1)
        bend = 1.0 - turn[:, 0] ** 2  # sin² of half the angle
        turn[:, 0] += np.linalg.norm(turn, axis=1) + 1e-9  # halfway to no turn
        half = base @ _matrix(turn)
        push = np.array([_PUSH.get(name[:-2], 0.0) * skeleton.height, 0.0, 0.0])
        world[:, k, :, :3] = half
        world[:, k, :, 3] = world_from_joint[:, j, :3, 3] + bend[:, None] * (half @ push)
        bind[k] = skeleton.bind[j]
    world[..., 3] -= np.einsum("tjab,jb->tja", world[..., :3], bind)
    return world.astype(np.float32)


def _quaternion(rotation: NDArray[np.floating]) -> NDArray[np.float64]:
    """Unit quaternions (w, x, y, z) with w >= 0 of rotation matrices [T, 3, 3]."""
    m = np.asarray(rotation, np.float64)
    xx, yy, zz = m[:, 0, 0], m[:, 1, 1], m[:, 2, 2]
    size = np.stack([1 + xx + yy + zz, 1 + xx - yy - zz, 1 - xx + yy - zz, 1 - xx - yy + zz], axis=1)
    a, b, c = m[:, 2, 1] - m[:, 1, 2], m[:, 0, 2] - m[:, 2, 0], m[:, 1, 0] - m[:, 0, 1]
    d, e, f = m[:, 1, 0] + m[:, 0, 1], m[:, 0, 2] + m[:, 2, 0], m[:, 2, 1] + m[:, 1, 2]
    rows = np.stack(
        [
            np.stack([size[:, 0], a, b, c], axis=1),
            np.stack([a, size[:, 1], d, e], axis=1),
            np.stack([b, d, size[:, 2], f], axis=1),
            np.stack([c, e, f, size[:, 3]], axis=1),
        ],
        axis=1,
    )
    q = rows[np.arange(len(m)), np.argmax(size, axis=1)]
    q = q / np.linalg.norm(q, axis=1, keepdims=True)
    return np.where(q[:, :1] < 0, -q, q)


def _matrix(quaternion: NDArray[np.float64]) -> NDArray[np.float64]:
    """Rotation matrices [T, 3, 3] of quaternions of any length."""
    w, x, y, z = (quaternion / np.linalg.norm(quaternion, axis=1, keepdims=True)).T
    return np.stack(
        [
            np.stack([1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)], axis=1),
            np.stack([2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)], axis=1),
            np.stack([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)], axis=1),
        ],
        axis=1,
    )
