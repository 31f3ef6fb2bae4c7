"""Glass by the hour: it takes the colour of the sky, and at night houses have light in their windows."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from runtime.mesh import MATERIALS, Mesh
from runtime.world import WorldObject

from ..lang.definitions.set import SetDef
from .light import LAMPLIGHT, glass_tint

#: Props whose names end so have light in their windows at night.
INHABITED = ("house", "train")


def glazed(
    mesh: Mesh, owners: NDArray[np.int32], objects: list[WorldObject], definition: SetDef, time: str
) -> Mesh:
    """The mesh with its glass as it looks at an hour; owners: int32 [F], the object each face belongs to."""
    tint, share, material = glass_tint(time, definition.outdoor, definition.light)
    glass = mesh.materials == MATERIALS.index("glass")
    if share <= 0 or not glass.any():
        return mesh
    colors, materials = mesh.colors.copy(), mesh.materials.copy()
    own = colors[glass]
    relative = own.mean(1, keepdims=True) / max(float(own.mean()), 1e-6)
    # stained glass keeps its colours
    stain = (own.max(1, keepdims=True) - own.min(1, keepdims=True)) / np.maximum(
        own.max(1, keepdims=True), 1e-6
    )
    taken = np.float32(share) * np.clip(1.4 - 4.2 * stain, 0.25, 1)
    colors[glass] = (1 - taken) * own + taken * np.clip(np.asarray(tint, np.float32) * relative, 0, 1)
    materials[glass] = material
    if time == "night":
        homes = [o.id for o in objects if o.kind.endswith(INHABITED)]
        lit = glass & np.isin(owners, homes)
        colors[lit], materials[lit] = LAMPLIGHT, MATERIALS.index("glow")
    return Mesh(mesh.vertices, mesh.faces, mesh.normals, colors, mesh.parts, materials)
