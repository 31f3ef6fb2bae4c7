"""What people bring to a set, as movable objects beside its own.

Assumes things whose props there are, and that these have a grip. Guarantees that the set's own objects keep
their ids, and that nothing of what is brought is to be seen where it has not been put into a hand.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from runtime.world import World, WorldObject

from ..lang.definitions.prop import PropDef
from ..lang.definitions.set import PropCatalog
from ..lang.ir import Carried
from .pieces import bounds_of
from .props import build_prop


def with_carried(world: World, carried: Sequence[Carried], catalog: PropCatalog) -> World:
    """The world with a further object for each thing carried, in their order.

    Where they rest is no place: the matrix draws them together to a point in the middle of the floor.
    """
    objects = list(world.objects)
    for thing in carried:
        prop = catalog.get("prop", thing.prop)
        if not isinstance(prop, PropDef):
            continue  # it is reported
        shape = prop.shape(dict(thing.arguments))
        mesh = build_prop(shape).mesh
        nowhere = np.zeros((4, 4))
        nowhere[:3, 3], nowhere[3, 3] = _middle(world), 1.0
        whole = nowhere.copy()
        whole[:3, :3] = np.eye(3)
        low, high = bounds_of(mesh.transformed(whole), whole)
        bearer = "" if thing.held or thing.about else thing.who
        assert shape.grip is not None, thing.prop
        x, y, z = shape.grip
        objects.append(
            WorldObject(
                len(objects), thing.path, prop.name, (), low, high, nowhere, mesh, (x, y, z), bearer=bearer
            )
        )
    return replace(world, objects=tuple(objects))


def _middle(world: World) -> tuple[float, float, float]:
    levels = [level for level in world.storeys if level.floors]
    if not levels:
        return 0.0, 0.0, 0.0
    x0, y0, x1, y1 = levels[0].floors[0]
    return (x0 + x1) / 2, (y0 + y1) / 2, levels[0].height
