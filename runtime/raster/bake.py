"""What is worked out once per scene: who casts shadows, and the ambient occlusion of the set.

Occlusion is a volume: the surface area of the set, blurred. Sampled a little off a surface it is
small in the open and large in corners, under tables and along skirtings; being smooth and fixed in
the world it neither flickers nor crawls.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter

from ..mesh import MATERIALS, Mesh

REACH = 0.16  # metres, standard deviation of the blur
CEILING = 1.9  # metres; broad things wholly above it do not block the key light of an interior
GROUND = 0.03  # metres; what is wholly below it casts no shadow worth drawing
BROAD = 1.5  # square metres
SHELTER = 0.27  # most of the ambient light that a set keeps off


@dataclass(frozen=True, eq=False)
class Volume:
    """Something known of the air around a set.

    values: float32 [X, Y, Z]; low: position of value [0, 0, 0], metres; cell: spacing, metres
    """

    values: NDArray[np.float32]
    low: NDArray[np.float64]
    cell: float


def key_casters(mesh: Mesh, wall: NDArray[np.int32], object_ids: NDArray[np.int32]) -> NDArray[np.int32]:
    """Indices of the static faces that throw a shadow in the key light.

    The shell of a room does not: the key light is a film light, set up where walls and ceiling are wild.
    """
    if not len(mesh.faces):
        return np.zeros(0, np.int32)
    corners = mesh.vertices[mesh.faces]
    low, high = corners[..., 2].min(axis=1), corners[..., 2].max(axis=1)
    solid = ~np.isin(mesh.materials, [MATERIALS.index("glass"), MATERIALS.index("glow")])
    keep = solid & (high > GROUND)
    if (wall >= 0).any():
        ids, index = np.unique(object_ids, return_inverse=True)
        index = index.reshape(-1)
        object_low = np.full(len(ids), np.inf)
        np.minimum.at(object_low, index, low)
        flat_area = np.abs(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[:, 2]) / 2
        area = np.bincount(index, weights=flat_area)
        ceiling = (low > CEILING) & (flat_area > BROAD / 2)
        keep &= (wall == -1) & ~ceiling & ~((object_low > CEILING) & (area > BROAD))[index]
    return np.flatnonzero(keep).astype(np.int32)


def stage_bounds(mesh: Mesh, casters: NDArray[np.int32]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Low and high corner of what stands in a set, without the plain around it."""
    chosen = mesh.faces[casters] if len(casters) else mesh.faces
    points = mesh.vertices[chosen.reshape(-1)].astype(np.float64)
    if not len(points):
        return np.zeros(3), np.zeros(3)
    return points.min(axis=0), points.max(axis=0)


def occlusion_volume(density: Volume) -> Volume:
    """How much of the ambient light a set keeps off, 0..SHELTER, from the blurred area of its surfaces."""
    cell = density.cell
    reach = max(REACH, 0.9 * cell)
    blurred = gaussian_filter(density.values.astype(np.float64), reach / cell, truncate=2.5)
    near = blurred * np.sqrt(2 * np.pi) * reach  # one plane gives 1 on it
    kept_off = SHELTER * (1.0 - np.exp(-1.3 * np.maximum(near - 0.38, 0.0)))
    return Volume(kept_off.astype(np.float32), density.low, cell)


def light_basis(sun: NDArray[np.floating]) -> NDArray[np.float64]:
    """Orthonormal rows [3, 3]: two across the light, and towards it."""
    towards = np.asarray(sun, np.float64) / np.linalg.norm(sun)
    helper = np.array([0.0, 0.0, 1.0]) if abs(towards[2]) < 0.9 else np.array([1.0, 0.0, 0.0])
    across = np.cross(helper, towards)
    across /= np.linalg.norm(across)
    return np.stack([across, np.cross(towards, across), towards])
