"""Turns a RenderScene into the flat arrays that kernels read.

Assumes a valid scene (checked here, ValueError otherwise). Guarantees: static triangles come first,
both parts are cut into clusters of neighbouring triangles that share wall, culling and object.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from ..materials import LAST, NIGHT_GLASS
from ..mesh import MATERIALS, Mesh
from ..rows import unique_rows
from .bake import Volume, key_casters, stage_bounds
from .density import density_volume
from .detail import COUNT, Levels, with_levels
from .film import to_linear
from .looks import surface_colors
from .types import LOOSE, ONE_SIDED, RenderScene, Style

CLUSTER = 64  # triangles
WELD = 1e-5  # metres
FLAT = 1  # surface flag: the triangle's three normals are one
MOVES = 2  # surface flag: skinned
CLOSED = 4  # surface flag: its back is never seen
CASTING = 3  # level of bodies that throws shadows
_AHEAD = 0.35  # of a head's normal in the bind pose, along X: what counts as its front
_SOLID = 0.05  # metres a thing has to be high to keep all of the light off what it stands on
SHIFT = 8  # flags sit above the material in info


@dataclass(frozen=True, eq=False)
class Prepared:
    """Flat arrays of a scene. V static vertices, K skinned ones, F triangles, C clusters, S surfaces.

    vertices, normals: float32 [V, 3]; rest, rest_normals: float32 [K, 3]
    faces: int32 [F, 3] into both one after the other; color: float32 [F, 3] linear
    info: int32 [F, 3]: surface index, material | flags << SHIFT, wall or -1; people and the levels of
    detailed bodies are walls too, after those of the set
    clusters: int32 [C, 4]: first triangle, count, cull, wall; moving_first: index of the first skinned one;
    sphere: float32 [C, 4], bounds of the static ones
    surface_object: int32 [S]: object id of each surface, a surface being one part of one object
    one_color: int32 [S], 1 where all faces of a surface have one colour
    moving_surface: index of the first skinned surface; static_faces: number of static triangles
    set_casters, casters: int32, triangles that throw shadows, static and skinned, of which the first
    closed_casters are of closed shells
    area: float32 [K], square metres a skinned vertex stands for; solid: float32 [K], the same without what is
    flat; owner: int32 [K], the object it is of; density: surface of the set in the air; stage: corners of
    what stands in it; levels: heights of its floors; detail: the levels of bodies; head: uint8 [F], 1 for a
    triangle of a head, 2 for one of its front
    """

    vertices: NDArray[np.float32]
    normals: NDArray[np.float32]
    rest: NDArray[np.float32]
    rest_normals: NDArray[np.float32]
    faces: NDArray[np.int32]
    color: NDArray[np.float32]
    info: NDArray[np.int32]
    clusters: NDArray[np.int32]
    moving_first: int
    sphere: NDArray[np.float32]
    surface_object: NDArray[np.int32]
    one_color: NDArray[np.int32]
    moving_surface: int
    static_faces: int
    set_casters: NDArray[np.int32]
    casters: NDArray[np.int32]
    closed_casters: int
    area: NDArray[np.float32]
    solid: NDArray[np.float32]
    owner: NDArray[np.int32]
    density: Volume
    stage: tuple[NDArray[np.float64], NDArray[np.float64]]
    levels: tuple[float, ...]
    detail: Levels
    head: NDArray[np.uint8]

    @property
    def most_drawn(self) -> int:
        """How many faces a view has at most: of what has levels of detail, one of them."""
        return self.static_faces + self.detail.drawn


def check(scene: RenderScene) -> None:
    """Raise ValueError for a scene that cannot be drawn."""
    for name, mesh, ids in (
        ("static", scene.static, scene.static_object),
        ("skinned", scene.skinned, scene.skinned_object),
    ):
        if not np.isfinite(mesh.normals).all() or not np.isfinite(mesh.colors).all():
            raise ValueError(f"RenderScene.{name}: normals and colours must be finite")
        if len(ids) != len(mesh.faces):
            raise ValueError(f"RenderScene.{name}_object: {len(ids)} ids for {len(mesh.faces)} faces")
        if len(mesh.materials) and not (mesh.materials.min() >= 0 and mesh.materials.max() <= LAST):
            raise ValueError(f"RenderScene.{name}: a material is not in MATERIALS")
    if len(scene.static_wall) != len(scene.static.faces):
        raise ValueError("RenderScene.static_wall: expected one number for each static face")
    if len(scene.static_wall) and scene.static_wall.max() >= scene.wall_count:
        raise ValueError("RenderScene.static_wall: a wall is not below wall_count")
    fitting = scene.fitting
    if fitting is not None and len(fitting) != len(scene.skinned.faces):
        raise ValueError("RenderScene.fitting: expected one number for each skinned face")
    if fitting is not None and len(fitting) and fitting.max() >= scene.wall_count:
        raise ValueError("RenderScene.fitting: a wall is not below wall_count")
    shape = (len(scene.skinned.vertices), 4)
    if scene.joints.shape != shape or scene.weights.shape != shape:
        raise ValueError(f"RenderScene.joints, weights: expected {shape}")
    if not np.isfinite(scene.weights).all():
        raise ValueError("RenderScene.weights: not all are finite")


def closed_faces(mesh: Mesh, object_ids: NDArray[np.int32]) -> NDArray[np.bool_]:
    """Which faces belong to a closed, consistently wound shell, so that their backs are never seen.

    Vertices at one place are one; a shell is the faces connected by edges within an object.
    """
    count = len(mesh.faces)
    if not count:
        return np.zeros(0, np.bool_)
    _, _, welded = unique_rows(np.round(mesh.vertices / WELD).astype(np.int64))
    faces = welded[mesh.faces]
    start = faces[:, [0, 1, 2]].reshape(-1)
    end = faces[:, [1, 2, 0]].reshape(-1)
    owner = np.repeat(np.arange(count), 3)
    keys = np.stack([np.minimum(start, end), np.maximum(start, end), object_ids[owner]], axis=1)
    _, _, edge = unique_rows(keys)
    balance = np.bincount(edge, weights=np.where(start < end, 1.0, -1.0))
    real = start != end
    bad_face = np.zeros(count, np.bool_)
    np.logical_or.at(bad_face, owner[real], balance[edge[real]] != 0)
    edges = int(edge.max()) + 1
    graph = coo_matrix((np.ones(len(edge)), (owner, count + edge)), shape=(count + edges, count + edges))
    _, shell = connected_components(graph, directed=False)
    open_shell = np.zeros(shell.max() + 1, np.bool_)
    np.logical_or.at(open_shell, shell[:count], bad_face)
    return ~open_shell[shell[:count]]


def _clusters(
    mesh: Mesh,
    object_ids: NDArray[np.int32],
    wall: NDArray[np.int32],
    cull: NDArray[np.bool_],
    later: NDArray[np.bool_] | None = None,
) -> tuple[NDArray[np.int64], NDArray[np.int32]]:
    """Order of the faces, and clusters [C, 4] over that order; later: [F], faces that come after others."""
    if not len(mesh.faces):
        return np.zeros(0, np.int64), np.zeros((0, 4), np.int32)
    after = np.zeros(len(wall), np.bool_) if later is None else later
    order = np.lexsort((np.arange(len(wall)), object_ids, cull, wall, after))
    key = np.stack([wall, object_ids, cull, after], axis=1)[order]
    change = np.flatnonzero((key[1:] != key[:-1]).any(axis=1)) + 1
    begins = np.concatenate([[0], change, [len(order)]])
    rows = [
        (at, min(CLUSTER, stop - at), int(key[at, 2]), int(key[at, 0]))
        for begin, stop in pairwise(begins)
        for at in range(begin, stop, CLUSTER)
    ]
    return order, np.array(rows, np.int32)


def spheres(
    vertices: NDArray[np.float32], faces: NDArray[np.int32], clusters: NDArray[np.int32]
) -> NDArray[np.float32]:
    """Bounds of clusters, float32 [C, 4]: middle and radius."""
    out = np.zeros((len(clusters), 4), np.float32)
    for i, (begin, count, _, _) in enumerate(clusters):
        points = vertices[faces[begin : begin + count]].reshape(-1, 3)
        low, high = points.min(axis=0), points.max(axis=0)
        out[i, :3] = (low + high) / 2
        out[i, 3] = np.linalg.norm(high - low) / 2 * 1.0001 + 1e-6
    return out


def _ordered(mesh: Mesh, order: NDArray[np.int64]) -> Mesh:
    return Mesh(
        mesh.vertices,
        np.ascontiguousarray(mesh.faces[order]),
        mesh.normals,
        mesh.colors[order],
        mesh.parts[order],
        mesh.materials[order],
    )


def quieted(color: NDArray[np.floating], quiet: float) -> NDArray[np.float64]:
    """Linear colours drawn towards a pale, slightly grey tint of themselves."""
    color = np.asarray(color, np.float64)
    luma = color @ np.array([0.2126, 0.7152, 0.0722])
    softened = luma[:, None] + (color - luma[:, None]) * (1.0 - 0.55 * quiet)
    pale = np.array([0.74, 0.72, 0.69])
    return softened + (pale - softened) * 0.5 * quiet


def prepare(scene: RenderScene, style: Style, on_host: bool = False) -> Prepared:
    """Check, order and pack a scene. on_host: whether kernels run on this processor. Raises ValueError."""
    check(scene)
    one_sided = scene.static_wall == ONE_SIDED
    static_wall = np.where(one_sided, np.int32(-1), scene.static_wall)
    static_cull = closed_faces(scene.static, scene.static_object) | one_sided
    owner = _owners(scene)
    touching, solid = _touching_area(scene), _solid_area(scene, owner)
    moving_cull = closed_faces(scene.skinned, scene.skinned_object)
    detail = with_levels(scene)
    scene, moving_cull = detail.scene, moving_cull[detail.source]
    order, clusters = _clusters(scene.static, scene.static_object, static_wall, static_cull)
    static = _ordered(scene.static, order)
    fitting = _fitting(scene)
    people = np.where(fitting < LOOSE, scene.wall_count + LOOSE - 1 - fitting, -1)
    own_wall = np.maximum(np.maximum(fitting, people), -1)
    after = scene.wall_count + max(LOOSE - int(fitting.min(initial=LOOSE)), 0)
    level_wall = after + detail.body * COUNT + detail.level
    own_wall = np.where(detail.body >= 0, level_wall, own_wall).astype(np.int32)
    casting = (detail.body < 0) | (detail.level == CASTING)
    loose = fitting <= LOOSE
    moving_order, moving_clusters = _clusters(
        scene.skinned, scene.skinned_object, own_wall, moving_cull, loose
    )
    fitting, own_wall = fitting[moving_order], own_wall[moving_order]
    skinned = _ordered(scene.skinned, moving_order)
    moving_clusters = moving_clusters.copy()
    moving_clusters[:, 0] += len(order)

    object_ids = np.concatenate([scene.static_object[order], scene.skinned_object[moving_order]])
    # panes of glass and lamps are not divided by lines
    panes = [MATERIALS.index("glass"), MATERIALS.index("glow"), NIGHT_GLASS]
    clear = np.isin(static.materials, panes)
    clear_part = np.isin(skinned.materials, panes) & (fitting > LOOSE)
    parts = np.concatenate([np.where(clear, -1, static.parts), np.where(clear_part, -1, skinned.parts)])
    moves = np.concatenate([np.zeros(len(order), int), (fitting <= LOOSE).astype(int)])
    surfaces, _, surface = unique_rows(np.stack([moves, object_ids, parts], axis=1))
    if len(surfaces) >= 0xFFFF:
        raise ValueError(f"RenderScene: {len(surfaces)} parts of objects; 65534 is the most")
    flags = np.concatenate([_flat(static) * FLAT, _flat(skinned) * FLAT + MOVES]).astype(np.int32)
    flags += np.concatenate([static_cull[order], moving_cull[moving_order]]) * np.int32(CLOSED)
    materials = np.concatenate([static.materials, skinned.materials])
    wall = np.concatenate([static_wall[order], own_wall])
    quiet = np.where(clear[:, None], to_linear(static.colors), quieted(to_linear(static.colors), style.quiet))
    bright = to_linear(skinned.colors)
    calm = (fitting > LOOSE) & ~clear_part
    color = np.concatenate([quiet, np.where(calm[:, None], quieted(bright, style.quiet), bright)])
    color = surface_colors(color, moves == 1, style)
    casters, closed_casters = _casters(skinned, fitting, casting[moving_order], moving_cull[moving_order])
    set_casters = key_casters(static, static_wall[order], scene.static_object[order])
    return Prepared(
        vertices=static.vertices,
        normals=static.normals,
        rest=skinned.vertices,
        rest_normals=skinned.normals,
        faces=np.concatenate([static.faces, skinned.faces + np.int32(len(static.vertices))]).astype(np.int32),
        color=color.astype(np.float32),
        info=np.stack([surface, materials | (flags << SHIFT), wall], axis=1).astype(np.int32),
        clusters=np.concatenate([clusters, moving_clusters]).astype(np.int32),
        moving_first=len(clusters),
        sphere=spheres(static.vertices, static.faces, clusters),
        surface_object=surfaces[:, 1].astype(np.int32),
        one_color=_one_color(color, surface, len(surfaces)),
        moving_surface=int((surfaces[:, 0] == 0).sum()),
        static_faces=len(order),
        set_casters=set_casters,
        casters=(casters + len(order)).astype(np.int32),
        closed_casters=closed_casters,
        area=touching,
        solid=solid,
        owner=owner,
        density=density_volume(static, set_casters, on_host),
        stage=stage_bounds(static, set_casters),
        levels=scene.levels,
        detail=detail,
        head=np.concatenate([np.zeros(len(order), np.uint8), _heads(scene, skinned)]),
    )


def _heads(scene: RenderScene, skinned: Mesh) -> NDArray[np.uint8]:
    """Which of the skinned triangles are of heads, and which of these look ahead, uint8 [F]."""
    if not scene.heads or not len(skinned.faces):
        return np.zeros(len(skinned.faces), np.uint8)
    main = np.take_along_axis(scene.joints, scene.weights.argmax(axis=1)[:, None], axis=1)[:, 0]
    of_head = np.isin(main, scene.heads)[skinned.faces[:, 0]]
    ahead = skinned.normals[skinned.faces].mean(axis=1)[:, 0] > _AHEAD
    return (of_head * (1 + ahead)).astype(np.uint8)


def _fitting(scene: RenderScene) -> NDArray[np.int32]:
    return np.full(len(scene.skinned.faces), LOOSE, np.int32) if scene.fitting is None else scene.fitting


def _casters(
    skinned: Mesh, fitting: NDArray[np.int32], casting: NDArray[np.bool_], closed: NDArray[np.bool_]
) -> tuple[NDArray[np.integer], int]:
    """Skinned faces that throw shadows: none of doors and windows, whose walls throw none, and of each body
    one level, the same in all views. First those of closed shells; and how many these are."""
    nobody = np.full(len(skinned.faces), -1, np.int32)
    found = key_casters(skinned, nobody, nobody)
    found = found[(fitting[found] < 0) & casting[found]]
    return found[np.argsort(~closed[found], kind="stable")], int(closed[found].sum())


def _touching_area(scene: RenderScene) -> NDArray[np.float32]:
    """Surface of each skinned vertex that darkens the floor under it: nothing of what belongs to the set."""
    area = _vertex_area(scene.skinned)
    area[scene.skinned.faces[_fitting(scene) > LOOSE].reshape(-1)] = 0.0
    return area


def _owners(scene: RenderScene) -> NDArray[np.int32]:
    """The object that each skinned vertex is of, int32 [K]; 0 for those of no face."""
    owner = np.zeros(len(scene.skinned.vertices), np.int32)
    owner[scene.skinned.faces.reshape(-1)] = np.repeat(scene.skinned_object, 3)
    return owner


def _solid_area(scene: RenderScene, owner: NDArray[np.int32]) -> NDArray[np.float32]:
    """Of these vertices, what keeps light off the furniture it lies on: nothing of a sheet of paper."""
    area, faces = _touching_area(scene), scene.skinned.faces
    if not len(faces):
        return area
    height = scene.skinned.vertices[:, 2]
    count = int(scene.skinned_object.max()) + 1
    low, high = np.full(count, np.inf, np.float32), np.full(count, -np.inf, np.float32)
    np.minimum.at(low, scene.skinned_object, height[faces].min(axis=1))
    np.maximum.at(high, scene.skinned_object, height[faces].max(axis=1))
    tall = np.where(np.isfinite(low), high - low, 0.0)
    return np.asarray(area * np.minimum(tall[owner] / _SOLID, 1.0), np.float32)


def _flat(mesh: Mesh) -> NDArray[np.int32]:
    """1 where a face's three normals are the same."""
    n = mesh.normals[mesh.faces]
    return ((n[:, 0] == n[:, 1]).all(axis=1) & (n[:, 0] == n[:, 2]).all(axis=1)).astype(np.int32)


def _one_color(color: NDArray[np.float64], surface: NDArray[np.int64], surfaces: int) -> NDArray[np.int32]:
    """1 where all faces of a surface have the same colour, int32 [S]."""
    low, high = np.full((surfaces, 3), np.inf), np.full((surfaces, 3), -np.inf)
    np.minimum.at(low, surface, color)
    np.maximum.at(high, surface, color)
    return (high - low < 1e-3).all(axis=1).astype(np.int32)


def _vertex_area(mesh: Mesh) -> NDArray[np.float32]:
    """A third of the area of the faces around each vertex, float32 [V]."""
    corners = mesh.vertices[mesh.faces].astype(np.float64)
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 6
    out = np.bincount(mesh.faces.reshape(-1), weights=np.repeat(area, 3), minlength=len(mesh.vertices))
    return out.astype(np.float32)
