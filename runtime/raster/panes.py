"""Clear glass: taken out of a scene before it is drawn, and laid over the picture afterwards.

Assumes faces of the material ``glass``. Guarantees that what is seen through glass is drawn, and its ids
given, as if there were none. Glass in the set with something close behind it (the windows of a house that
is a closed box, a framed picture) stays what it was: opaque and pale.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..mesh import MATERIALS, Mesh
from ..rows import unique_rows
from .film import to_linear
from .types import LOOSE, ONE_SIDED, RenderScene

SMALL = 0.6  # metres: up to here glass is outlined, beyond it mirrors in streaks
OPEN = 0.22  # metres of free space on both sides of a pane that is clear
PROBES = 4  # faces of a pane that are tried
STREAKS, OUTLINED, HELD = 1, 2, 4  # flags of a face of glass

_GLASS = MATERIALS.index("glass")
Bools = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Glass:
    """G clear faces, those of the set first, and by what hides them.

    faces: int32 [G, 3] into the static vertices and the skinned ones after them; still: how many are static
    info: int32 [G, 3]: 0, 0, column of what hides it in ``Views.hidden`` or -1
    group: int32 [G, 2]: number of the pane or thing, flags; color: float32 [G, 3], linear
    """

    faces: NDArray[np.int32]
    still: int
    info: NDArray[np.int32]
    group: NDArray[np.int32]
    color: NDArray[np.float32]


def divided(scene: RenderScene) -> tuple[RenderScene, Glass | None]:
    """The scene without its clear glass, and that; the scene itself where there is none."""
    fitting = scene.fitting
    if fitting is None:
        fitting = np.full(len(scene.skinned.faces), LOOSE, np.int32)
    still = clear_faces(scene.static, scene.static_object)
    moving = clear_faces(scene.skinned, scene.skinned_object) | (
        (scene.skinned.materials == _GLASS) & (fitting <= LOOSE)
    )
    if not still.any() and not moving.any():
        return scene, None
    people = np.where(fitting < LOOSE, scene.wall_count + LOOSE - 1 - fitting, -1)
    hides = np.concatenate([scene.static_wall[still], np.maximum(fitting, people)[moving]])
    hides = np.where(hides == ONE_SIDED, -1, np.maximum(hides, -1))
    faces = np.concatenate(
        [scene.static.faces[still], scene.skinned.faces[moving] + len(scene.static.vertices)]
    )
    owner = np.concatenate([scene.static_object[still], scene.skinned_object[moving]])
    flags = np.concatenate(
        [
            _flags(scene.static, scene.static_object)[still],
            _flags(scene.skinned, scene.skinned_object)[moving],
        ]
    )
    flags[int(still.sum()) :] |= np.where(fitting[moving] <= LOOSE, HELD, 0)
    colors = np.concatenate([scene.static.colors[still], scene.skinned.colors[moving]])
    order = np.lexsort((owner, hides, np.arange(len(faces)) >= int(still.sum())))
    info = np.zeros((len(faces), 3), np.int32)
    info[:, 2] = hides
    glass = Glass(
        faces[order].astype(np.int32),
        int(still.sum()),
        info[order],
        np.stack([owner, flags], axis=1)[order].astype(np.int32),
        to_linear(colors[order]).astype(np.float32),
    )
    opaque = replace(
        scene,
        static=_only(scene.static, ~still),
        static_object=scene.static_object[~still],
        static_wall=scene.static_wall[~still],
        skinned=_only(scene.skinned, ~moving),
        skinned_object=scene.skinned_object[~moving],
        fitting=None if scene.fitting is None else scene.fitting[~moving],
    )
    return opaque, glass


def _only(mesh: Mesh, kept: Bools) -> Mesh:
    return Mesh(
        mesh.vertices,
        mesh.faces[kept],
        mesh.normals,
        mesh.colors[kept],
        mesh.parts[kept],
        mesh.materials[kept],
    )


def clear_faces(mesh: Mesh, owner: NDArray[np.int32]) -> Bools:
    """Which faces are of clear glass, bool [F]."""
    out = np.zeros(len(mesh.faces), np.bool_)
    glass = mesh.materials == _GLASS
    if not glass.any():
        return out
    corners = mesh.vertices[mesh.faces].astype(np.float64)
    solid = corners[~glass]
    low, high = solid.min(axis=1), solid.max(axis=1)
    for members in _panes(mesh, owner):
        mine = corners[members]
        at, to = mine.min(axis=(0, 1)), mine.max(axis=(0, 1))
        near = ((low <= to + OPEN) & (high >= at - OPEN)).all(axis=1)
        out[members] = _open(mine, solid[near])
    return out


def _panes(mesh: Mesh, owner: NDArray[np.int32]) -> list[NDArray[np.int64]]:
    """Faces of glass by object and part."""
    glass = np.flatnonzero(mesh.materials == _GLASS)
    _, _, group = unique_rows(np.stack([owner[glass], mesh.parts[glass]], axis=1))
    order = np.argsort(group, kind="stable")
    ends = np.flatnonzero(np.diff(group[order])) + 1
    return [np.asarray(part, np.int64) for part in np.split(glass[order], ends)]


def _flags(mesh: Mesh, owner: NDArray[np.int32]) -> NDArray[np.int32]:
    """Streaks on what is large, outlines around what is small, int32 [F]."""
    out = np.zeros(len(mesh.faces), np.int32)
    for members in _panes(mesh, owner) if (mesh.materials == _GLASS).any() else []:
        points = mesh.vertices[mesh.faces[members]].reshape(-1, 3)
        out[members] = OUTLINED if np.linalg.norm(np.ptp(points, axis=0)) <= SMALL else STREAKS
    return out


def _open(pane: NDArray[np.float64], solid: NDArray[np.float64]) -> bool:
    """Whether most of a pane's largest faces [F, 3, 3] have free space before and behind them."""
    normal = np.cross(pane[:, 1] - pane[:, 0], pane[:, 2] - pane[:, 0])
    area = np.linalg.norm(normal, axis=1)
    tried = np.argsort(-area, kind="stable")[:PROBES]
    free = 0
    for k in tried:
        n = normal[k] / max(float(area[k]), 1e-12)
        middle = pane[k].mean(axis=0)
        free += not (_hits(middle, n, solid) or _hits(middle, -n, solid))
    return 2 * free > len(tried)


def _hits(start: NDArray[np.float64], along: NDArray[np.float64], solid: NDArray[np.float64]) -> bool:
    """Whether a ray meets one of some triangles within :data:`OPEN` (Möller and Trumbore 1997)."""
    if not len(solid):
        return False
    a, b = solid[:, 1] - solid[:, 0], solid[:, 2] - solid[:, 0]
    p = np.cross(along, b)
    det = (a * p).sum(axis=1)
    safe = np.where(np.abs(det) < 1e-12, np.inf, det)
    s = start - solid[:, 0]
    u = (s * p).sum(axis=1) / safe
    q = np.cross(s, a)
    v = q @ along / safe
    t = (b * q).sum(axis=1) / safe
    return bool(((u >= 0) & (v >= 0) & (u + v <= 1) & (t > 1e-4) & (t < OPEN)).any())
