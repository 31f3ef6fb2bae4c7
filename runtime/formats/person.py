"""A skinned glTF as a person: our skeleton in its proportions, its mesh in our bind pose, on our joints.

Assumes nothing of the file but what :mod:`.gltf` guarantees. Guarantees a :class:`~runtime.body.build.Body`
like any other: facing +X, feet on z = 0, as tall as asked, every vertex on joints of ours.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from runtime.body.build import Body
from runtime.body.proportions import make_skeleton
from runtime.body.skeleton import JOINT, JOINTS, PARENTS, Skeleton
from runtime.body.spec import BodySpec
from runtime.mesh import Mesh

from . import limits
from .errors import ModelFileError
from .finish import shell
from .gltf import Gltf, Surface, open_gltf
from .model import upright
from .pose import bind_turns, posed
from .rig import Match, Rig, finger_joint, match

Array = NDArray[np.float64]
#: How far the way from hips to head may lean in a pose that serves as rest (cosine).
_UPRIGHT = 0.75


@dataclass(frozen=True, eq=False)
class Skin:
    """A skin and its skeleton in a pose that serves as rest, Z up, in the file's units.

    bones: node of each bone; rest: float64 [B, 3, 3], their turns in that pose
    points [V, 3], joints [V, 4] into the bones, weights [V, 4]
    """

    rig: Rig
    found: Match
    nodes: tuple[int, ...]
    rest: Array
    points: Array
    faces: NDArray[np.int64]
    colors: NDArray[np.float32]
    parts: NDArray[np.int32]
    joints: NDArray[np.int64]
    weights: Array


def read_person(path: Path, folder: Path, height: float, up: str = "", turn: float = 0.0) -> Body:
    """The person of a file, ``height`` metres tall."""
    skin = read_skin(open_gltf(path, folder), up, turn)
    return _body(path, skin, height)


def read_skin(gltf: Gltf, up: str = "", turn: float = 0.0) -> Skin:
    """The largest skinned mesh of a file with all others on the same skeleton."""
    tree = gltf.tree
    nodes = [i for i in gltf.file.things() if tree.nodes[i].skin is not None]
    if not nodes:
        raise ModelFileError(gltf.path, "it has no skeleton with a skin on it")
    linear = _about_z(turn) @ upright(up != "z")
    worlds = gltf.worlds()
    order = _bones(gltf, [tree.nodes[i].skin for i in nodes])
    rig_of = {node: k for k, node in enumerate(order)}
    parents = _bone_parents(gltf, order)
    reasons = []
    for pose in ("bind", "rest"):
        placed = worlds[order] if pose == "rest" else _bind_worlds(gltf, nodes, worlds, order)
        if placed is None:
            continue
        position = placed[:, :3, 3] @ linear.T
        rig = Rig(tuple(str(tree.nodes[n].name or "") for n in order), parents, position, position)
        found = match(rig)
        if found is None:
            reasons.append(
                "its bones are not those of a person: hips, two legs, a spine and two arms are needed"
            )
        elif not _stands(rig, found):
            reasons.append("its skeleton does not stand upright; say `up z` if its upward axis is Z")
        else:
            return _skin(gltf, nodes, rig_of, (rig, found, order, placed, linear, worlds))
    raise ModelFileError(gltf.path, reasons[0] if reasons else "its skeleton has no pose that can be used")


def _bones(gltf: Gltf, skins: list[int]) -> list[int]:
    """Nodes of all bones of the skins, and those between them, parents first."""
    wanted = {j for s in skins for j in gltf.tree.skins[s].joints}
    parents = gltf.parents()
    for joint in list(wanted):  # what lies between two bones is one
        path, node = [], parents[joint]
        while node >= 0 and node not in wanted:
            path.append(node)
            node = parents[node]
        if node >= 0:
            wanted.update(path)
    return [n for n in gltf.order() if n in wanted]


def _bone_parents(gltf: Gltf, order: list[int]) -> tuple[int, ...]:
    parents, index = gltf.parents(), {n: k for k, n in enumerate(order)}
    return tuple(index.get(parents[n], -1) for n in order)


def _bind_worlds(gltf: Gltf, nodes: list[int], worlds: Array, order: list[int]) -> Array | None:
    """[B, 4, 4] of the pose the skin was made in; None where the file does not say it for all bones."""
    found: dict[int, Array] = {}
    for node in nodes:
        skin = gltf.tree.skins[gltf.tree.nodes[node].skin]
        if skin.inverseBindMatrices is None:
            return None
        matrices = gltf.accessor(skin.inverseBindMatrices)[: len(skin.joints)].reshape(-1, 4, 4)
        for joint, inverse in zip(skin.joints, np.swapaxes(matrices, 1, 2), strict=True):
            if abs(np.linalg.det(inverse)) < 1e-12:
                raise ModelFileError(gltf.path, "a bone of it has no place in the skin")
            found.setdefault(joint, worlds[node] @ np.linalg.inv(inverse))
    local = {n: gltf.local(n) for n in order}
    parents = gltf.parents()
    for n in order:
        if n not in found:
            found[n] = found[parents[n]] @ local[n] if parents[n] in found else worlds[n]
    return np.stack([found[n] for n in order])


def _stands(rig: Rig, found: Match) -> bool:
    bones = found.bones
    shoulders = (rig.position[bones["upperarm_l"]] + rig.position[bones["upperarm_r"]]) / 2
    feet = (rig.position[bones["foot_l"]] + rig.position[bones["foot_r"]]) / 2
    way = shoulders - feet
    return bool(way[2] > _UPRIGHT * np.linalg.norm(way))


def _skin(
    gltf: Gltf, nodes: list[int], rig_of: dict[int, int],
    pose: tuple[Rig, Match, list[int], Array, Array, Array],
) -> Skin:  # fmt: skip
    """The meshes of the nodes in the given pose of their bones."""
    rig, found, order, placed, linear, _ = pose
    rows: list[tuple[Array, Surface, NDArray[np.int64], int]] = []
    for node in nodes:
        item = gltf.tree.nodes[node]
        skin = gltf.tree.skins[item.skin]
        bone_of = np.array([rig_of[j] for j in skin.joints])
        inverse = np.tile(np.eye(4), (len(bone_of), 1, 1))
        if skin.inverseBindMatrices is not None:
            flat = gltf.accessor(skin.inverseBindMatrices)[: len(bone_of)]
            inverse = np.swapaxes(flat.reshape(-1, 4, 4), 1, 2)
        matrices = placed[bone_of] @ inverse
        for surface in gltf.surfaces(item.mesh):
            if surface.joints is None or surface.weights is None:
                continue
            if surface.joints.max(initial=0) >= len(bone_of) or surface.joints.min(initial=0) < 0:
                raise ModelFileError(gltf.path, "some of its points hang on bones that are not there")
            weights = np.maximum(surface.weights, 0.0)
            weights = weights / np.maximum(weights.sum(1, keepdims=True), 1e-9)
            homogeneous = np.concatenate([surface.points, np.ones((len(surface.points), 1))], axis=1)
            moved = np.zeros((len(homogeneous), 3))
            for k in range(4):
                moved += weights[:, k, None] * np.einsum(
                    "vab,vb->va", matrices[surface.joints[:, k], :3], homogeneous
                )
            clean = Surface(surface.points, surface.faces, surface.colors, False, False, None, weights)
            rows.append((moved @ linear.T, clean, bone_of[surface.joints], len(rows)))
    if not any(len(s.faces) for _, s, _, _ in rows):
        raise ModelFileError(gltf.path, "nothing hangs on its skeleton")
    offsets = np.cumsum([0, *(len(points) for points, _, _, _ in rows[:-1])])
    turns = placed[:, :3, :3] / np.maximum(np.linalg.norm(placed[:, :3, :3], axis=1, keepdims=True), 1e-12)
    return Skin(
        rig,
        found,
        tuple(order),
        linear @ turns,
        np.concatenate([points for points, _, _, _ in rows]),
        np.concatenate([s.faces + o for (_, s, _, _), o in zip(rows, offsets, strict=True)]).astype(np.int64),
        np.concatenate([s.colors for _, s, _, _ in rows]),
        np.concatenate([np.full(len(s.faces), part, np.int32) for _, s, _, part in rows]),
        np.concatenate([joints for _, _, joints, _ in rows]),
        np.concatenate([s.weights for _, s, _, _ in rows if s.weights is not None]),
    )


# --- our body -------------------------------------------------------------------------


def _body(path: Path, skin: Skin, height: float) -> Body:
    turns = bind_turns(skin.rig, skin.found)
    at = posed(skin.rig, turns)
    points = np.zeros_like(skin.points)
    for k in range(4):
        bone = skin.joints[:, k]
        way = skin.points - skin.rig.position[bone]
        points += skin.weights[:, k, None] * (np.einsum("vab,vb->va", turns[bone], way) + at[bone])
    used = points[skin.faces.ravel()]
    low, high = used[:, 2].min(), used[:, 2].max()
    if not np.isfinite(used).all() or high - low < 1e-9:
        raise ModelFileError(path, "it has no height")
    bones = skin.found.bones
    middle = (at[bones["thigh_l"]] + at[bones["thigh_r"]]) / 2
    shift, scale = np.array([middle[0], middle[1], low]), height / float(high - low)
    points, at = (points - shift) * scale, (at - shift) * scale
    joint_of = _joints_of(skin)
    skeleton = _skeleton(at, points, skin, joint_of, height)
    made = shell(points, skin.faces, limits.BODY_TRIANGLES)
    joints, weights = _weights(joint_of, skin)
    mesh = Mesh(
        made.vertices.astype(np.float32),
        np.ascontiguousarray(made.faces, np.int32),
        made.normals.astype(np.float32),
        np.ascontiguousarray(skin.colors[made.face_source], np.float32),
        np.ascontiguousarray(skin.parts[made.face_source], np.int32),
        np.zeros(len(made.faces), np.int32),
    )
    return Body(
        BodySpec(height=float(np.clip(height, 0.7, 2.4))),
        skeleton,
        mesh,
        joints[made.source],
        weights[made.source],
    )


def _joints_of(skin: Skin) -> NDArray[np.int64]:
    """Our joint of each bone: its own, a finger's, or that of the nearest bone above that has one."""
    own = {bone: JOINT[joint] for joint, bone in skin.found.bones.items()}
    out: list[int] = []
    for i, parent in enumerate(skin.rig.parents):
        above = out[parent] if parent >= 0 else JOINT["hips"]
        joint = own.get(i, above)
        name = JOINTS[above]
        if i not in own and name[:-2] in ("hand", "fingers", "fingertips", "index", "indextip", "thumb"):
            finger = finger_joint(skin.rig.names[i])
            joint = JOINT[f"{finger}_{name[-1]}"] if finger else above
        out.append(joint)
    return np.array(out)


def _weights(joint_of: NDArray[np.int64], skin: Skin) -> tuple[NDArray[np.int32], NDArray[np.float32]]:
    """joints int32 [V, 4] and weights float32 [V, 4], each joint once a vertex."""
    joints, weights = joint_of[skin.joints], skin.weights.copy()
    for a in range(4):
        for b in range(a + 1, 4):
            same = joints[:, a] == joints[:, b]
            weights[same, a] += weights[same, b]
            weights[same, b] = 0.0
    lone = weights.sum(1) < 1e-6
    weights[lone, 0] = 1.0
    weights /= weights.sum(1, keepdims=True)
    return joints.astype(np.int32), weights.astype(np.float32)


def _skeleton(at: Array, points: Array, skin: Skin, joint_of: NDArray[np.int64], height: float) -> Skeleton:
    """Our skeleton with the file's joints where it has them, both sides the same; the rest by proportion."""
    default = make_skeleton(BodySpec(height=float(np.clip(height, 0.7, 2.4)))).bind * (
        height / float(np.clip(height, 0.7, 2.4))
    )
    bind = default.copy()
    known = {joint: at[bone] for joint, bone in skin.found.bones.items()}
    strongest = joint_of[skin.joints[np.arange(len(points)), skin.weights.argmax(1)]]
    bind[JOINT["hips"]] = known["hips"] * np.array([1.0, 0.0, 1.0])
    shoulders = (known["upperarm_l"] + known["upperarm_r"]) / 2
    hips = bind[JOINT["hips"]]
    for joint, share in (("spine", 0.22), ("chest", 0.55), ("neck", 1.06)):
        bind[JOINT[joint]] = hips + (shoulders - hips) * share
    for joint in ("spine", "chest", "neck", "head"):
        if joint in known:
            bind[JOINT[joint]] = known[joint]
        bind[JOINT[joint], 1] = 0.0
    if "spine" not in known:
        bind[JOINT["spine"]] = hips + 0.4 * (bind[JOINT["chest"]] - hips)
    if "head" not in known:
        bind[JOINT["head"]] = bind[JOINT["neck"]] + np.array([0.01, 0.0, 0.045]) * height
    _head(bind, default, height)
    for limb in ("thigh", "shin", "foot", "upperarm", "forearm", "hand"):
        _both(bind, limb, known[f"{limb}_l"], known[f"{limb}_r"])
    _arm_ends(bind, default, known, points, strongest)
    _feet(bind, default, known, points, strongest, height)
    return Skeleton(bind, height)


def _both(bind: Array, joint: str, left: Array, right: Array) -> None:
    """Sets a joint of both sides to the mean of left and mirrored right."""
    flip = np.array([1.0, -1.0, 1.0])
    mean = (left + right * flip) / 2
    bind[JOINT[f"{joint}_l"]], bind[JOINT[f"{joint}_r"]] = mean, mean * flip


def _head(bind: Array, default: Array, height: float) -> None:
    """Face joints from the head joint, as large as what is above it."""
    own, usual = bind[JOINT["head"]], default[JOINT["head"]]
    size = (height - own[2]) / max(height - usual[2], 1e-6)
    size = float(np.clip(size, 0.5, 2.5))
    inside = {JOINT["head"]}
    for j, parent in enumerate(PARENTS):
        if parent in inside:
            inside.add(j)
            bind[j] = own + (default[j] - usual) * size


def _arm_ends(
    bind: Array, default: Array, known: dict[str, Array], points: Array, strongest: NDArray[np.int64]
) -> None:
    """Collar bones and fingers: by proportion, fingers as long as the hand is."""
    _both(bind, "clavicle", *(known.get(f"clavicle_{s}", _collar(bind, default, s)) for s in "lr"))
    hand = bind[JOINT["hand_l"]]
    way = hand - bind[JOINT["forearm_l"]]
    way = way / max(float(np.linalg.norm(way)), 1e-9)
    fingers = [JOINT[f"{n}_l"] for n in ("hand", "fingers", "fingertips", "index", "indextip", "thumb")]
    own = points[np.isin(strongest, fingers)]
    usual = float(np.linalg.norm(default[JOINT["fingers_l"]] - default[JOINT["hand_l"]]))
    reach = float(np.percentile((own - hand) @ way, 98)) if len(own) > 5 else 2.0 * usual
    size = float(np.clip(reach / (2.0 * usual), 0.4, 2.5))
    for joint in ("fingers", "fingertips", "index", "indextip", "thumb"):
        offset = default[JOINT[f"{joint}_l"]] - default[JOINT["hand_l"]]
        flip = np.array([1.0, -1.0, 1.0])
        bind[JOINT[f"{joint}_l"]] = hand + size * offset
        bind[JOINT[f"{joint}_r"]] = (hand + size * offset) * flip


def _collar(bind: Array, default: Array, side: str) -> Array:
    arm, usual = bind[JOINT[f"upperarm_{side}"]], default[JOINT[f"upperarm_{side}"]]
    offset = default[JOINT[f"clavicle_{side}"]] - usual
    return np.asarray(arm + offset * (arm[1] / usual[1]))


def _feet(
    bind: Array,
    default: Array,
    known: dict[str, Array],
    points: Array,
    strongest: NDArray[np.int64],
    height: float,
) -> None:
    """The ball of the foot: the file's, or as far before the ankle as the foot is long."""
    ankle = bind[JOINT["foot_l"]]
    own = points[np.isin(strongest, [JOINT["foot_l"], JOINT["toe_l"]])]
    front = float(own[:, 0].max()) if len(own) else ankle[0] + 0.11 * height
    flip = np.array([1.0, -1.0, 1.0])
    least = 0.5 * max(front - ankle[0], 0.03 * height)
    ball = ankle + np.array([least, 0.0, 0.0])
    if "toe_l" in known and "toe_r" in known:
        toe = (known["toe_l"] + known["toe_r"] * flip) / 2
        ball = np.array([max(toe[0], ball[0]), toe[1], toe[2]])
    _both(bind, "toe", ball, ball * flip)
    low = default[JOINT["toe_l"], 2]
    for side in "lr":
        bind[JOINT[f"toe_{side}"], 2] = min(bind[JOINT[f"toe_{side}"], 2], max(low, 0.5 * ankle[2]))


def _about_z(angle: float) -> Array:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
