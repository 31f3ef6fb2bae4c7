"""Props in numbers to meshes, and to the upright boxes that stand in for them.

Assumes what :meth:`PropDef.shape` guarantees. Nothing here knows where a prop will stand.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from runtime import shapes
from runtime.mesh import Mesh, join

from ..lang.definitions.primitives import Primitive
from ..lang.definitions.prop import PropShape, PropSpot
from .flush import told_apart
from .models import FileProp, file_prop

#: Boxes with no side longer than this are nothing to bump into.
SMALLEST_SOLID = 0.08

#: Columns: where a shape's own X, Y and Z go when its Z is laid along an axis.
_ALONG = {
    "z": ((1, 0, 0), (0, 1, 0), (0, 0, 1)),
    "-z": ((1, 0, 0), (0, -1, 0), (0, 0, -1)),
    "x": ((0, 1, 0), (0, 0, 1), (1, 0, 0)),
    "-x": ((0, -1, 0), (0, 0, 1), (-1, 0, 0)),
    "y": ((-1, 0, 0), (0, 0, 1), (0, 1, 0)),
    "-y": ((1, 0, 0), (0, 0, 1), (0, -1, 0)),
}


@dataclass(frozen=True, eq=False)
class BuiltProp:
    """A prop in its own coordinates.

    mesh: ``parts`` count from 0, one for each primitive that is set off by a line
    centre, half: float64 [B, 3], its solid boxes, aligned with its axes
    spots: those that follow from what it measures
    """

    mesh: Mesh
    centre: NDArray[np.float64]
    half: NDArray[np.float64]
    spots: tuple[PropSpot, ...] = ()


def build_prop(shape: PropShape) -> BuiltProp:
    """Mesh and solids of a prop."""
    meshes: list[Mesh] = []
    bounds = []
    part = -1
    for primitive in shape.primitives:
        mesh = primitive_mesh(primitive)
        part += 1 if primitive.line or part < 0 else 0
        meshes.append(with_part(mesh, part))
        if primitive.solid and len(mesh.vertices):
            bounds.append((mesh.vertices.min(0).astype(np.float64), mesh.vertices.max(0).astype(np.float64)))
    spots: tuple[PropSpot, ...] = ()
    if shape.model is not None:
        model = file_prop(shape.model)
        meshes.append(replace(model.mesh, parts=model.mesh.parts + np.int32(part + 1)))
        bounds.extend(model.boxes)
        spots = () if any(s.name == "stand" for s in shape.spots) else (before(model.mesh),)
    if shape.solids is not None:
        centre = np.array([(b.at[0], b.at[1], b.at[2] + b.size[2] / 2) for b in shape.solids]).reshape(-1, 3)
        half = np.array([b.size for b in shape.solids]).reshape(-1, 3) / 2
    else:
        boxes = merged_boxes(bounds)
        centre = np.array([(a + b) / 2 for a, b in boxes]).reshape(-1, 3)
        half = np.array([(b - a) / 2 for a, b in boxes]).reshape(-1, 3)
    return BuiltProp(join(told_apart(meshes)), centre, half, spots)


def built_file(thing: FileProp) -> BuiltProp:
    """A thing of a set out of a file."""
    low, high = np.array([b[0] for b in thing.boxes]), np.array([b[1] for b in thing.boxes])
    low, high = low.reshape(-1, 3), high.reshape(-1, 3)
    return BuiltProp(thing.mesh, (low + high) / 2, (high - low) / 2, (before(thing.mesh),))


def before(mesh: Mesh) -> PropSpot:
    """Where one stands to use a thing: before the middle of its front."""
    low, high = mesh.vertices.min(0).astype(float), mesh.vertices.max(0).astype(float)
    return PropSpot("stand", ((low[0] + high[0]) / 2, low[1] - 0.4, 0.0), math.pi / 2)


def with_part(mesh: Mesh, part: int) -> Mesh:
    """The mesh with every face of the given part."""
    parts = np.full(len(mesh.faces), part, np.int32)
    return Mesh(mesh.vertices, mesh.faces, mesh.normals, mesh.colors, parts, mesh.materials)


def primitive_mesh(primitive: Primitive) -> Mesh:
    """One primitive, placed in its prop."""
    mesh = _raw(primitive)
    matrix = np.eye(4)
    matrix[:3, :3] = np.array(_ALONG[primitive.along], float).T
    matrix[:3, 3] = primitive.at
    turn = _about_z(primitive.turn) @ _about_x(primitive.tilt) @ _about_y(primitive.lean)
    pivot = np.array(primitive.pivot if primitive.pivot is not None else primitive.at)
    rotation = np.eye(4)
    rotation[:3, :3] = turn
    rotation[:3, 3] = pivot - turn @ pivot
    return mesh.transformed(rotation @ matrix)


def _raw(p: Primitive) -> Mesh:
    if p.kind == "box":
        return shapes.box(p.size, p.rounding, p.steps, p.color, p.material)
    if p.kind == "cylinder":
        return shapes.cylinder(p.size[0], p.size[1], p.rounding, p.segments, p.color, p.material)
    if p.kind == "cone":
        return shapes.cone(p.size[0], p.size[1], p.size[2], p.rounding, p.segments, p.color, p.material)
    if p.kind == "sphere":
        return shapes.sphere(p.size, p.lumps, p.segments, p.color, p.material)
    if p.kind == "lathe":
        return shapes.lathe(p.points, p.segments, p.color, p.material)
    if p.kind == "extrude":
        return shapes.extrude(p.points, p.size[0], p.color, p.material)
    return shapes.tube(p.points, p.size[0], p.segments, p.color, p.material)


def _about_x(angle: float) -> NDArray[np.float64]:
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[1, 0, 0], [0, c, -s], [0, s, c]])


def _about_y(angle: float) -> NDArray[np.float64]:
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])


def _about_z(angle: float) -> NDArray[np.float64]:
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])


def placement(x: float, y: float, z: float, turn: float) -> NDArray[np.float64]:
    """target_from_prop [4, 4]: a turn about Z and a shift."""
    matrix = np.eye(4)
    matrix[:3, :3] = _about_z(turn)
    matrix[:3, 3] = (x, y, z)
    return matrix


Box = tuple[NDArray[np.float64], NDArray[np.float64]]


def merged_boxes(boxes: list[Box], waste: float = 1.12) -> list[Box]:
    """Fewer boxes that cover the given ones: joined where that adds little room, tiny ones left out."""
    left = [b for b in boxes if (b[1] - b[0]).max() > SMALLEST_SOLID]
    joined = True
    while joined:
        joined = False
        for i in range(len(left)):
            for j in range(i + 1, len(left)):
                low, high = np.minimum(left[i][0], left[j][0]), np.maximum(left[i][1], left[j][1])
                together = _room(low, high)
                if together <= waste * _union(left[i], left[j]):
                    left[i] = (low, high)
                    left.pop(j)
                    joined = True
                    break
            if joined:
                break
    return left


def _room(low: NDArray[np.float64], high: NDArray[np.float64]) -> float:
    """Volume of a box; a thin one counts as 2 cm thick, so that sheets may be joined too."""
    return float(np.prod(np.maximum(high - low, 0.02)))


def _union(a: Box, b: Box) -> float:
    low, high = np.maximum(a[0], b[0]), np.minimum(a[1], b[1])
    common = _room(low, high) if (high > low).all() else 0.0
    return _room(*a) + _room(*b) - min(common, _room(*a), _room(*b))
