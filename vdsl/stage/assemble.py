"""Puts a built set and its dressed cast together as one drawable scene.

Everything that moves becomes one skinned mesh over one palette of matrices: first the joints of
every person in the order given, then one entry for each movable object of the set.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from runtime.body.build import Body
from runtime.body.skeleton import JOINT, PALETTE, PARENTS, skinning_matrices
from runtime.mesh import Mesh, join
from runtime.raster.types import LOOSE, RenderScene
from runtime.world import World, WorldObject


def _of_head() -> tuple[int, ...]:
    found = {JOINT["head"]}
    for joint, parent in enumerate(PARENTS):  # parents come first
        if parent in found:
            found.add(joint)
    return tuple(sorted(found))


#: Joints of the head and of what is on it, as indices of a body's palette.
_HEAD = _of_head()


@dataclass(frozen=True, eq=False)
class StagedScene:
    """A scene ready to be performed in and drawn.

    bodies: by character name, in palette order; first_joint: palette index of each one's first joint
    prop_entry: palette index of each movable object, by object id; palette_size: P
    object_ids: object id of each character in id buffers
    """

    world: World
    bodies: dict[str, Body]
    render: RenderScene
    first_joint: dict[str, int]
    prop_entry: dict[int, int]
    palette_size: int
    object_ids: dict[str, int]


def assemble(world: World, bodies: Mapping[str, Body]) -> StagedScene:
    """Everything drawable of a scene as one :class:`~runtime.raster.types.RenderScene`."""
    meshes: list[Mesh] = []
    joints: list[NDArray[np.int32]] = []
    weights: list[NDArray[np.float32]] = []
    objects: list[NDArray[np.int32]] = []
    first_joint: dict[str, int] = {}
    object_ids: dict[str, int] = {}
    for k, (name, body) in enumerate(bodies.items()):
        first_joint[name] = k * len(PALETTE)
        object_ids[name] = len(world.objects) + k
        meshes.append(body.mesh)
        joints.append(body.joints + np.int32(first_joint[name]))
        weights.append(body.weights)
        objects.append(np.full(len(body.mesh.faces), object_ids[name], np.int32))
    fitting: list[NDArray[np.int32]] = [
        np.full(len(m.faces), LOOSE - 1 - k, np.int32) for k, m in enumerate(meshes)
    ]
    prop_entry: dict[int, int] = {}
    for thing in world.objects:
        if thing.mesh is None:
            continue
        prop_entry[thing.id] = len(bodies) * len(PALETTE) + len(prop_entry)
        count = len(thing.mesh.vertices)
        meshes.append(thing.mesh)
        joints.append(np.full((count, 4), prop_entry[thing.id], np.int32))
        weights.append(np.tile(np.array([1, 0, 0, 0], np.float32), (count, 1)))
        objects.append(np.full(len(thing.mesh.faces), thing.id, np.int32))
        fitting.append(np.full(len(thing.mesh.faces), _wall_of(thing, world), np.int32))
    home = np.full((len(bodies) * len(PALETTE) + len(prop_entry), 3, 4), np.nan, np.float32)
    for object_id, entry in prop_entry.items():
        home[entry] = world.objects[object_id].world_from_object[:3]
    skinned = join(_with_own_parts(meshes))
    return StagedScene(
        world=world,
        bodies=dict(bodies),
        render=RenderScene(
            static=world.mesh,
            static_object=world.mesh_object,
            static_wall=world.mesh_wall,
            skinned=skinned,
            skinned_object=np.concatenate(objects) if objects else np.zeros(0, np.int32),
            joints=np.concatenate(joints) if joints else np.zeros((0, 4), np.int32),
            weights=np.concatenate(weights) if weights else np.zeros((0, 4), np.float32),
            wall_count=len(world.walls),
            light=world.light,
            fitting=np.concatenate(fitting) if fitting else None,
            levels=tuple(level.height for level in world.storeys),
            heads=tuple(first + joint for first in first_joint.values() for joint in _HEAD),
            home=home,
        ),
        first_joint=first_joint,
        prop_entry=prop_entry,
        palette_size=len(home),
        object_ids=object_ids,
    )


def _wall_of(thing: WorldObject, world: World) -> int:
    """The wild wall a part goes away with, -1 for one in no wall, LOOSE for what is carried about."""
    if thing.hinge is None:
        return LOOSE
    of_owner = world.mesh_wall[world.mesh_object == thing.hinge.owner]
    return max(int(of_owner[0]), -1) if len(of_owner) else -1


def _with_own_parts(meshes: list[Mesh]) -> list[Mesh]:
    """The meshes with part labels made distinct between them."""
    out, offset = [], 0
    for mesh in meshes:
        out.append(replace(mesh, parts=mesh.parts + np.int32(offset)))
        offset += int(mesh.parts.max(initial=0)) + 1
    return out


def palettes(
    staged: StagedScene,
    world_from_joint: Mapping[str, NDArray[np.float32]],
    world_from_object: Mapping[int, NDArray[np.float32]],
    frames: NDArray[np.integer],
) -> NDArray[np.float32]:
    """Matrix palettes of the given frames of one performance.

    world_from_joint: by character, [T, J, 4, 4]; world_from_object: by object id, [T, 4, 4]
    (objects left out stay where the set puts them); frames: [M] indices
    returns: float32 [M, P, 3, 4]
    """
    out = np.empty((len(frames), staged.palette_size, 3, 4), np.float32)
    for name, first in staged.first_joint.items():
        skeleton = staged.bodies[name].skeleton
        out[:, first : first + len(PALETTE)] = skinning_matrices(skeleton, world_from_joint[name][frames])
    for object_id, entry in staged.prop_entry.items():
        track = world_from_object.get(object_id)
        if track is None:
            out[:, entry] = staged.world.objects[object_id].world_from_object[:3]
        else:
            out[:, entry] = track[frames, :3]
    return out
