"""Levels of detailed moving things: coarser for views in which they are small, a finer one for close-ups.

Assumes meshes of closed shells, as bodies are. Guarantees: a coarser level keeps to the vertices of the mesh,
so that skinning, normals and weights are shared; its faces take part, colour and material from the nearest
face of the same shell. What the finer one adds to the vertices comes after all others, and is skinned only
where it is seen. Which level is drawn depends on a view and its moment alone, so that a batch gives what its
views give one by one; a change of level moves outlines by about a pixel at most.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import fast_simplification
import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from ..mesh import Mesh
from ..rows import unique_rows
from .finer import Skin, finer
from .types import LOOSE, RenderScene

#: Share of the faces kept by each coarser level, and the pixels a metre below which it is drawn.
LEVELS = ((0.5, 300.0), (0.25, 100.0))
FINER = 700.0  # pixels a metre from which on the finer level is drawn
#: In pictures of so few rows, which are looked at as a whole, the same for the finer level and the others.
SMALL, IN_SMALL = 400, (1400.0, 400.0, 250.0)
FINEST, OWN = 0, 1  # the finer level, and the mesh as it is; coarser ones follow
COUNT = OWN + 1 + len(LEVELS)
SHELL = 250  # faces; shells of fewer, as eyes and teeth are, keep them
DETAILED = 2000  # faces; what has fewer is drawn as it is
#: Metres by which the inside of a look lies above its border while it is simplified.
LIFT = 0.04
#: Places in a face at which it is looked for.
_WITHIN = np.array([[2, 2, 2], [4, 1, 1], [1, 4, 1], [1, 1, 4], [3, 3, 0], [0, 3, 3], [3, 0, 3]]) / 6
REACH = 0.9  # metres; a body reaches no farther from its middle


@dataclass(frozen=True, eq=False)
class Levels:
    """Levels of B bodies in the faces of a scene.

    scene: with the faces of the other levels after its own; source: int32 [F'], the face that each of its
    skinned faces comes from; body, level: int32 [F'] of its skinned faces, the body (-1: of none, drawn as it
    is) and level, :data:`FINEST` first; middle: float64 [B, P, 4], what each palette entry adds to the middle
    of a body; person: int32 [B], its number among the people who may be left out, -1 for none; vertices: how
    many skinned vertices all levels but the finest have
    """

    scene: RenderScene
    body: NDArray[np.int32]
    level: NDArray[np.int32]
    source: NDArray[np.int32]
    middle: NDArray[np.float64]
    person: NDArray[np.int32]
    vertices: int

    @cached_property
    def drawn(self) -> int:
        """How many skinned faces a view has at most: of each body, those of its largest level."""
        if not len(self.middle):
            return len(self.body)
        leveled, bodies = self.body >= 0, len(self.middle)
        sizes = np.bincount(self.body[leveled] * COUNT + self.level[leveled], minlength=bodies * COUNT)
        return int(sizes.reshape(bodies, COUNT).max(axis=1).sum() + (~leveled).sum())

    @cached_property
    def _vertices(self) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
        """Which skinned vertices are of no body [V], and which each body has at each level [B, COUNT, V]."""
        faces, count = self.scene.skinned.faces, len(self.scene.skinned.vertices)
        loose = np.arange(count) < self.vertices
        of = np.zeros((len(self.middle), COUNT, count), np.bool_)
        for body in range(len(self.middle)):
            for level in range(COUNT):
                of[body, level, faces[(self.body == body) & (self.level == level)].reshape(-1)] = True
        of_bodies = of.any(axis=(0, 1))
        loose &= ~of_bodies
        loose[faces[self.body < 0].reshape(-1)] = True  # what they share
        return loose, of

    def used(self, shown: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Which skinned vertices are needed where some levels of bodies are shown, [B, COUNT]."""
        loose, of = self._vertices
        return np.asarray(loose | of[shown].any(axis=0))

    def chosen(
        self,
        palettes: NDArray[np.float32],
        moment: NDArray[np.int32],
        view: NDArray[np.float32],
    ) -> NDArray[np.int32]:
        """The level of each body in each view, int32 [N, B]; ``view`` as ``pack_views`` gives it."""
        if not len(self.middle):
            return np.zeros((len(view), 0), np.int32)
        count = self.middle.shape[1]
        middle = np.einsum("mpij,bpj->mbi", palettes[:, :count].astype(np.float64), self.middle)
        away = np.linalg.norm(middle[moment] - view[:, None, :3], axis=-1) - REACH
        scale = np.maximum(view[:, 12], view[:, 13])[:, None] / np.maximum(away, 1e-3)
        limits = np.array([[FINER, *(limit for _, limit in LEVELS)], IN_SMALL])
        small = (2 * view[:, 15] <= SMALL).astype(int)
        return (scale[..., None] < limits[small][:, None]).sum(axis=-1).astype(np.int32)


def with_levels(scene: RenderScene) -> Levels:
    """The scene with finer and coarser levels of whatever moves and is detailed."""
    mesh, ids = scene.skinned, scene.skinned_object
    fitting = np.full(len(ids), LOOSE, np.int32) if scene.fitting is None else scene.fitting
    names, sizes = np.unique(ids, return_counts=True)
    loose = np.isin(names, ids[fitting <= LOOSE])
    chosen = names[(sizes >= DETAILED) & loose]
    body = np.full(len(ids), -1, np.int32)
    faces, source, level = (
        [mesh.faces.astype(np.int64)],
        [np.arange(len(ids))],
        [np.full(len(ids), OWN, np.int32)],
    )
    skin = Skin(mesh.vertices, mesh.normals, scene.joints, scene.weights)
    palette = int(scene.joints.max(initial=-1)) + 1
    middle = np.zeros((len(chosen), palette, 4))
    for k, name in enumerate(chosen):
        own = np.flatnonzero(ids == name)
        body[own] = k
        middle[k] = _middle(scene, np.unique(mesh.faces[own]), palette)
        for step, (share, _) in enumerate(LEVELS):
            coarse, nearest = _coarser(mesh, own, share)
            faces.append(coarse)
            source.append(nearest)
            level.append(np.full(len(coarse), OWN + 1 + step, np.int32))
        skin, fine, of = finer(skin, mesh.faces[own].astype(np.int64))
        faces.append(fine)
        source.append(own[of])
        level.append(np.full(len(fine), FINEST, np.int32))
    source_of = np.concatenate(source)
    person = np.array([LOOSE - 1 - int(fitting[ids == name].min()) for name in chosen], np.int32)
    wider = Mesh(
        skin.place,
        np.concatenate(faces).astype(np.int32),
        skin.normal,
        mesh.colors[source_of],
        mesh.parts[source_of],
        mesh.materials[source_of],
    )
    wider_scene = replace(
        scene,
        skinned=wider,
        skinned_object=ids[source_of],
        fitting=fitting[source_of],
        joints=skin.joints,
        weights=skin.weights,
    )
    return Levels(
        wider_scene,
        body[source_of],
        np.concatenate(level),
        source_of.astype(np.int32),
        middle,
        person,
        len(mesh.vertices),
    )


def _middle(scene: RenderScene, used: NDArray[np.integer], palette: int) -> NDArray[np.float64]:
    """Rows [P, 4] whose products with the palette's matrices add up to the mean of some vertices."""
    points = np.concatenate([scene.skinned.vertices[used], np.ones((len(used), 1))], axis=1) / len(used)
    out = np.zeros((palette, 4))
    for k in range(4):
        np.add.at(out, scene.joints[used, k], points * scene.weights[used, k, None])
    return out


def _coarser(mesh: Mesh, own: NDArray[np.int64], share: float) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """A share of some faces, [F, 3] of the mesh's own vertices, and the original face nearest to each, [F].

    Shell by shell, so that neither skin nor cloth takes after the other; small shells stay as they are. What
    has one look is lifted before, but for its border: looks meet in valleys, which simplifying keeps, so that
    seams, lips and stripes stay where they are.
    """
    corners, look = mesh.faces[own], _looks(mesh, own)
    # sharp edges are split vertices: weld them, or they would come apart
    places, _, flat = unique_rows(mesh.vertices[corners.reshape(-1)])
    local = flat.reshape(-1, 3)
    up = np.zeros((len(places), 3))
    np.add.at(up, flat, mesh.normals[corners.reshape(-1)])
    up /= np.maximum(np.linalg.norm(up, axis=1, keepdims=True), 1e-9)
    first, last = np.full(len(places), len(own)), np.full(len(places), -1)
    np.minimum.at(first, flat, np.repeat(look, 3))
    np.maximum.at(last, flat, np.repeat(look, 3))
    lifted = places + LIFT * up * (first == last)[:, None]
    links = coo_matrix(
        (np.ones(2 * len(local)), (local[:, :2].reshape(-1), local[:, 1:].reshape(-1))),
        shape=(len(places),) * 2,
    )
    _, shell = connected_components(links, directed=False)
    shell = shell[local[:, 0]]
    out, nearest = [], []
    for name in np.unique(shell):
        here = np.flatnonzero(shell == name)
        if len(here) < SHELL:
            out.append(corners[here].astype(np.int64))
            nearest.append(own[here])
            continue
        used, inside = np.unique(local[here].reshape(-1), return_inverse=True)
        before = lifted[used].astype(np.float32), inside.reshape(-1, 3).astype(np.int32)
        _, _, steps = fast_simplification.simplify(
            *before, target_reduction=1.0 - share, return_collapses=True
        )
        points, faces, into = fast_simplification.replay_simplification(*before, steps)
        alone = np.where(first == last, first, -1)[local[here]]
        found, source = _taken_after(
            lifted[local[here]],
            into[inside].reshape(-1, 3),
            corners[here],
            (look[here], alone),
            points.astype(np.float64),
            faces,
        )
        out.append(found)
        nearest.append(own[here][source])
    return np.concatenate(out), np.concatenate(nearest)


def _looks(mesh: Mesh, own: NDArray[np.int64]) -> NDArray[np.int64]:
    """Which of some faces look alike: a number for each part, material and colour, [F]."""
    told = np.column_stack([mesh.parts[own], mesh.materials[own], mesh.colors[own]])
    return unique_rows(told)[2]


def _taken_after(
    places: NDArray[np.float64],
    into: NDArray[np.integer],
    corners: NDArray[np.integer],
    looks: tuple[NDArray[np.int64], NDArray[np.int64]],
    points: NDArray[np.float64],
    faces: NDArray[np.integer],
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """New faces by vertices near their corners, and the old faces nearest to them, [F, 3] and [F].

    A corner is the nearest of the vertices that were drawn together into it: one that was not may lie nearer
    and yet be elsewhere, as the insides of two legs lie within each other when they are lifted.

    places: of the corners of the old faces [N, 3, 3], where ``corners`` says which vertices these are, and
        ``into`` into which of the new ``points`` [V, 3] they were drawn; faces: of these
    looks: of the old faces [N], and of their corners [N, 3], -1 on a border. A new face has the look that
        all of its corners have that lie on no border, else that of the nearest old face
    """
    look, alone = looks
    triangles = points[faces]
    samples, middles = _WITHIN @ places, triangles.mean(axis=1)
    _, found = cKDTree(samples.reshape(-1, 3)).query(middles)
    guess = look[found // len(_WITHIN)]
    _, found = cKDTree(places.reshape(-1, 3)).query(triangles.reshape(-1, 3))
    inner = alone.reshape(-1)[found].reshape(-1, 3)
    most = inner.max(axis=1)
    sure = (most >= 0) & ((inner < 0) | (inner == most[:, None])).all(axis=1)
    taken = np.where(sure, most, guess)
    out = _drawn_together(places, into, corners, look, points, faces, taken)
    nearest = np.zeros(len(faces), np.int64)
    for name in np.unique(taken):
        here, alike = taken == name, np.flatnonzero(look == name)
        lost = here[:, None] & (out < 0)
        if lost.any():  # none of that look was drawn into it
            _, found = cKDTree(places[alike].reshape(-1, 3)).query(triangles[lost])
            out[lost] = corners[alike].reshape(-1)[found]
        _, found = cKDTree(samples[alike].reshape(-1, 3)).query(middles[here])
        nearest[here] = alike[found // len(_WITHIN)]
    real = (out[:, 0] != out[:, 1]) & (out[:, 1] != out[:, 2]) & (out[:, 2] != out[:, 0])
    return out[real], nearest[real]


def _drawn_together(
    places: NDArray[np.float64],
    into: NDArray[np.integer],
    corners: NDArray[np.integer],
    look: NDArray[np.int64],
    points: NDArray[np.float64],
    faces: NDArray[np.integer],
    taken: NDArray[np.int64],
) -> NDArray[np.int64]:
    """Of the vertices of a face's look that were drawn into its corners, those nearest to these, -1 where
    there is none: [F, 3]. Arguments as above; taken: the look of each new face, [F]."""
    looks = int(max(look.max(), taken.max(initial=0))) + 1
    key = (into * looks + look[:, None]).reshape(-1)
    away = np.linalg.norm(places - points[into], axis=-1).reshape(-1)
    order = np.lexsort((corners.reshape(-1), away, key))
    keys, first = np.unique(key[order], return_index=True)
    wanted = faces * looks + taken[:, None]
    at = np.minimum(np.searchsorted(keys, wanted), len(keys) - 1)
    vertex = corners.reshape(-1)[order[first]]
    return np.where(keys[at] == wanted, vertex[at], -1).astype(np.int64)
