"""Small scenes made for the rasteriser's tests and benchmark."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np
from numpy.typing import NDArray

from runtime.mesh import MATERIALS, Mesh, empty, join
from runtime.raster.types import Camera, RenderScene, Views
from runtime.world import Light

LIGHT = Light(
    sun=(0.35, -0.55, 0.76),
    sun_color=(0.72, 0.68, 0.6),
    sky=(0.42, 0.46, 0.54),
    ground=(0.24, 0.22, 0.2),
    backdrop=((0.86, 0.89, 0.92), (0.62, 0.74, 0.88)),
)


def box(
    low: tuple[float, float, float],
    high: tuple[float, float, float],
    color: tuple[float, float, float] = (0.6, 0.6, 0.6),
    material: str = "plain",
    part: int = 0,
    inward: bool = False,
) -> Mesh:
    """An axis-aligned box with sharp edges; inward: seen from inside (a room)."""
    lo, hi = np.array(low, float), np.array(high, float)
    vertices, faces, normals = [], [], []
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for side, at in ((-1.0, lo), (1.0, hi)):
            quad = []
            for a, b in ((0, 0), (1, 0), (1, 1), (0, 1)):
                p = np.empty(3)
                p[axis] = at[axis]
                p[u] = (lo, hi)[a][u]
                p[v] = (lo, hi)[b][v]
                quad.append(p)
            if (side < 0) != inward:
                quad.reverse()
            n = np.zeros(3)
            n[axis] = -side if inward else side
            k = len(vertices)
            faces += [(k, k + 1, k + 2), (k, k + 2, k + 3)]
            vertices += quad
            normals += [n] * 4
    return from_lists(vertices, faces, normals, color, material, part)


def sphere(
    centre: tuple[float, float, float],
    radii: tuple[float, float, float],
    color: tuple[float, float, float],
    part: int = 0,
    rings: int = 16,
) -> Mesh:
    """A closed ellipsoid with smooth normals."""
    theta = np.linspace(0, np.pi, rings + 1)
    phi = np.arange(2 * rings) * np.pi / rings
    unit = np.stack(
        [
            np.outer(np.sin(theta), np.cos(phi)),
            np.outer(np.sin(theta), np.sin(phi)),
            np.outer(np.cos(theta), np.ones_like(phi)),
        ],
        axis=-1,
    )
    unit[0], unit[-1] = (0, 0, 1), (0, 0, -1)
    faces = []
    w = 2 * rings
    for i in range(rings):
        for j in range(w):
            a, b, c, d = i * w + j, (i + 1) * w + j, (i + 1) * w + (j + 1) % w, i * w + (j + 1) % w
            if i < rings - 1:
                faces.append((a, b, c))
            if i > 0:
                faces.append((a, c, d))
    unit = unit.reshape(-1, 3)
    r = np.array(radii)
    normals = unit / r
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return from_lists(unit * r + np.array(centre), faces, normals, color, "plain", part)


def from_lists(vertices, faces, normals, color, material="plain", part=0) -> Mesh:  # type: ignore[no-untyped-def]
    """A Mesh of one colour, material and part."""
    count = len(faces)
    return Mesh(
        np.array(vertices, np.float32).reshape(-1, 3),
        np.array(faces, np.int32).reshape(-1, 3),
        np.array(normals, np.float32).reshape(-1, 3),
        np.tile(np.array(color, np.float32), (count, 1)),
        np.full(count, part, np.int32),
        np.full(count, MATERIALS.index(material), np.int32),
    )


def scene(
    static: list[Mesh],
    skinned: list[Mesh],
    walls: list[int] | None = None,
    light: Light = LIGHT,
    homely: Collection[int] = (),
) -> RenderScene:
    """Objects 0.. of the static meshes, then of the skinned ones (joint k moves skinned mesh k). homely:
    those of the skinned ones that are at home where they are built"""
    walls = walls or [-1] * len(static)
    moving = join(skinned) if skinned else empty()
    joints = np.zeros((len(moving.vertices), 4), np.int32)
    if skinned:
        joints[:, 0] = np.repeat(np.arange(len(skinned)), [len(m.vertices) for m in skinned])
    weights = np.zeros((len(moving.vertices), 4), np.float32)
    weights[:, 0] = 1
    sizes = [len(m.faces) for m in static]
    return RenderScene(
        static=join(static),
        static_object=np.repeat(np.arange(len(static)), sizes).astype(np.int32),
        static_wall=np.repeat(np.array(walls, np.int64), sizes).astype(np.int32),
        skinned=moving,
        skinned_object=np.repeat(
            np.arange(len(skinned)) + len(static), [len(m.faces) for m in skinned]
        ).astype(np.int32),
        joints=joints,
        weights=weights,
        wall_count=max([w + 1 for w in walls], default=0),
        light=light,
        home=at_home(len(skinned), homely) if homely else None,
    )


def at_home(count: int, homely: Collection[int]) -> NDArray[np.float32]:
    """Where skinned meshes are at home: as they are built, or nowhere."""
    home = np.full((count, 3, 4), np.nan, np.float32)
    home[list(homely)] = np.eye(4, dtype=np.float32)[:3]
    return home


def still(count: int, moments: int = 1) -> NDArray[np.float32]:
    """Palettes that leave everything where it is."""
    return np.tile(np.eye(4, dtype=np.float32)[:3], (moments, max(count, 1), 1, 1))


def looking(
    eyes: list[tuple[float, float, float]],
    targets: list[tuple[float, float, float]],
    focal: float = 35.0,
    sensor: tuple[float, float] = (36.0, 20.25),
    moments: list[int] | None = None,
    walls: int = 0,
) -> Views:
    """Level cameras at ``eyes`` aimed at ``targets``."""
    e, t = np.array(eyes, float), np.array(targets, float)
    forward = t - e
    forward /= np.linalg.norm(forward, axis=1, keepdims=True)
    right = np.cross(forward, (0, 0, 1))
    right /= np.linalg.norm(right, axis=1, keepdims=True)
    up = np.cross(right, forward)
    camera = Camera(
        e.astype(np.float32),
        np.stack([right, up, forward], axis=1).astype(np.float32),
        np.full(len(e), focal, np.float32),
        sensor,
    )
    return Views(camera, np.array(moments or [0] * len(e), np.int32), np.zeros((len(e), walls), np.bool_))


def room() -> RenderScene:
    """A room with a window wall, a table, shelves, and two people of ellipsoids."""
    static = [
        box((0, 0, -0.1), (4.2, 3.6, 0), (0.80, 0.74, 0.66), "wood", 0),
        box((0, 3.6, 0), (4.2, 3.7, 2.6), (0.88, 0.86, 0.8), "plaster", 1),
        box((-0.1, 0, 0), (0, 3.6, 2.6), (0.86, 0.87, 0.84), "plaster", 2),
        box((1.4, 1.6, 0.70), (2.7, 2.4, 0.74), (0.62, 0.44, 0.28), "wood", 3),
    ]
    for k, (x, y) in enumerate(((1.45, 1.65), (2.6, 1.65), (1.45, 2.3), (2.6, 2.3))):
        static.append(box((x, y, 0), (x + 0.05, y + 0.05, 0.7), (0.55, 0.38, 0.25), "wood", 4 + k))
    static.append(box((0.0, 3.0, 0), (2.4, 3.6, 0.9), (0.56, 0.66, 0.64), "plain", 9))
    static.append(box((0.0, 2.98, 0.9), (2.42, 3.6, 0.94), (0.4, 0.38, 0.36), "concrete", 10))
    static.append(box((2.9, 3.3, 0), (3.8, 3.6, 1.9), (0.7, 0.55, 0.4), "wood", 11))
    people = []
    for x, y, top in ((1.0, 1.2, (0.76, 0.18, 0.2)), (3.2, 2.0, (0.16, 0.24, 0.45))):
        people.append(
            join(
                [
                    sphere((x, y, 1.52), (0.1, 0.085, 0.13), (0.9, 0.7, 0.58), 0, 24),
                    sphere((x, y, 1.13), (0.14, 0.2, 0.32), top, 1, 32),
                    sphere((x, y + 0.09, 0.45), (0.09, 0.08, 0.47), (0.2, 0.22, 0.3), 2, 24),
                    sphere((x, y - 0.09, 0.45), (0.09, 0.08, 0.47), (0.2, 0.22, 0.3), 3, 24),
                ]
            )
        )
    return scene(static, people)
