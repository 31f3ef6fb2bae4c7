"""A slow numpy twin of the rasteriser: one triangle at a time over all pixels, in float64.

Only what can be said simply: skinning, coverage, depth, and shading without shadows, patterns and ink. It
clips by rejecting samples behind the near plane, walks no spans and keeps no keys. :func:`covers` is
the fill rule alone, in whole numbers.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from runtime.mesh import Mesh
from runtime.raster.film import exposed, to_encoded, to_linear, unexposed
from runtime.raster.prepare import closed_faces, quieted
from runtime.raster.types import RenderScene, Views

NEAR = 0.03


@dataclass
class Traced:
    """depth [H, W] metres (inf: nothing); ids [H, W]; color [H, W, 3] 0..255; sure [H, W]: no edge nearby;
    slack [H, W]: how far 1/depth may be off in single precision, 1/m; more on what the near plane cuts"""

    depth: NDArray[np.float64]
    ids: NDArray[np.int32]
    color: NDArray[np.float64]
    sure: NDArray[np.bool_]
    slack: NDArray[np.float64]


def skinned(scene: RenderScene, palette: NDArray[np.floating]) -> Mesh:
    """What moves, where one palette [P, 3, 4] puts it, with its normals turned."""
    mesh, bones = scene.skinned, palette.astype(float)[scene.joints]
    blend = (scene.weights[..., None, None] * bones).sum(axis=1)
    at = np.einsum("vij,vj->vi", blend[..., :3], mesh.vertices) + blend[..., 3]
    normals = np.einsum("vij,vj->vi", blend[..., :3], mesh.normals)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    return replace(mesh, vertices=at.astype(np.float32), normals=normals.astype(np.float32))


def toned(light: NDArray[np.float64], tones: int) -> NDArray[np.float64]:
    """Light 0..1 in ``tones`` steps with soft edges; 0: smooth."""
    if tones == 0:
        return np.maximum(light, 0)
    steps = [(0.22, 12.5)] if tones == 2 else []
    if tones >= 3:
        steps = [(0.10 + 0.42 * k / (tones - 2), 1 / (0.06 + 0.05 * k)) for k in range(tones - 1)]
    t = [np.clip((light - at) * steepness + 0.5, 0, 1) for at, steepness in steps]
    return np.mean([x * x * (3 - 2 * x) for x in t], axis=0)


def covers(corners: NDArray[np.int64], size: tuple[int, int]) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Which pixels a triangle fills, [H, W], and which centres lie on a slanted edge (either is right there).

    corners: [3, 2] in quarters of a pixel. A centre is filled if it is inside, or on a left or top edge.
    """
    width, height = size
    x, y = np.meshgrid(np.arange(width) * 4 + 2, np.arange(height) * 4 + 2)
    (ax, ay), (bx, by), (cx, cy) = corners
    turn = np.sign((bx - ax) * (cy - ay) - (cx - ax) * (by - ay))
    inside = np.full((height, width), turn != 0)
    slanted = np.zeros((height, width), bool)
    for (px, py), (qx, qy) in ((corners[k], corners[(k + 1) % 3]) for k in range(3)):
        side = turn * ((qx - px) * (y - py) - (qy - py) * (x - px))
        # walked clockwise as seen, left edges go up and top edges to the right
        left = turn * (qy - py) < 0
        top = qy == py and turn * (qx - px) > 0
        inside &= (side > 0) | ((side == 0) & (left or top))
        slanted |= (side == 0) & (qx != px) & (qy != py)
    return inside, slanted


def trace(
    scene: RenderScene,
    views: Views,
    n: int,
    size: tuple[int, int],
    quiet: float,
    tones: int = 0,
    palettes: NDArray[np.floating] | None = None,
) -> Traced:
    """Cast one ray through the centre of each pixel of view ``n``; palettes: None leaves all where it is."""
    width, height = size
    cam = views.camera
    eye, axes = cam.position[n].astype(float), cam.axes[n].astype(float)
    fx = float(cam.focal[n]) / cam.sensor[0] * width
    fy = float(cam.focal[n]) / cam.sensor[1] * height
    xs, ys = np.meshgrid(np.arange(width) + 0.5, np.arange(height) + 0.5)
    rays = (
        axes[2] + ((xs - width / 2) / fx)[..., None] * axes[0] - ((ys - height / 2) / fy)[..., None] * axes[1]
    )
    depth = np.full((height, width), np.inf)
    ids = np.full((height, width), -1, np.int32)
    color = np.zeros((height, width, 3))
    sure = np.ones((height, width), bool)
    slack = np.zeros((height, width))
    light = scene.light
    horizon, zenith = unexposed(to_linear(np.array(light.backdrop)))
    fill = axes[1] * 0.6 - axes[0] * 0.62 - axes[2] * 0.5
    fill /= np.linalg.norm(fill)
    up = rays[..., 2] / np.linalg.norm(rays, axis=-1)
    color[:] = horizon + (zenith - horizon) * np.clip(up * 1.6, 0, 1)[..., None]
    moving = scene.skinned if palettes is None else skinned(scene, palettes[views.moment[n]])
    for mesh, owner, walls, still in (
        (scene.static, scene.static_object, scene.static_wall, True),
        (moving, scene.skinned_object, None, False),
    ):
        base = to_linear(mesh.colors)
        closed = closed_faces(scene.static if still else scene.skinned, owner)
        if still:
            base = quieted(base, quiet)
        for f, corner in enumerate(mesh.faces):
            if walls is not None and walls[f] >= 0 and views.hidden[n, walls[f]]:
                continue
            p = mesh.vertices[corner].astype(float) - eye
            if np.linalg.norm(np.cross(p[1] - p[0], p[2] - p[0])) == 0:
                continue
            if closed[f] and np.dot(np.cross(p[1] - p[0], p[2] - p[0]), p[0]) >= 0:
                continue  # the back of a closed shell, seen only where the near plane opens it
            # weights of the corners in ray = w . p, by Cramer
            matrix = np.stack(p, axis=1)
            if abs(np.linalg.det(matrix)) < 1e-12:
                continue
            w = rays @ np.linalg.inv(matrix).T
            total = w.sum(axis=-1)
            with np.errstate(divide="ignore", invalid="ignore"):
                z = 1.0 / total
                bary = w / total[..., None]
            ahead = (total > 0) & (z > NEAR)
            inside = ahead & (bary >= 0).all(axis=-1)
            with np.errstate(divide="ignore", invalid="ignore"):
                # how fast the weights change from pixel to pixel; total is even over the picture
                rise = np.stack([axes[0] / fx, axes[1] / fy]) @ np.linalg.inv(matrix).T
                change = (rise[:, None, None] - rise.sum(axis=-1)[:, None, None, None] * bary) / total[
                    ..., None
                ]
                slope = np.linalg.norm(change, axis=(0, -1))
            # what the near plane cuts reaches far out of the picture, where single precision is coarse
            is_cut = ((p @ axes[2]) <= NEAR).any()
            margin = (0.03 if is_cut else 2e-3) * np.maximum(slope, 1e-9)[..., None]
            off = 2e-5 * np.abs(total) + (1e-3 if is_cut else 0.0)
            sure &= ~(ahead & (bary > -margin).all(axis=-1) & (bary < margin).any(axis=-1))
            sure &= ~((np.abs(z - NEAR) < 1e-4) & (bary >= -0.1).all(axis=-1))
            sure &= ~(inside & (np.abs(total - 1.0 / depth) < np.maximum(off, slack)))
            nearer = inside & (z < depth)
            depth[nearer] = z[nearer]
            slack[nearer] = off[nearer]
            ids[nearer] = owner[f]
            n3 = bary[nearer] @ mesh.normals[corner].astype(float)
            n3 /= np.linalg.norm(n3, axis=-1, keepdims=True)
            if np.dot(np.cross(p[1] - p[0], p[2] - p[0]), p[0]) > 0:
                n3 = -n3
            ambient = np.array(light.ground) + (np.array(light.sky) - np.array(light.ground)) * (
                n3[:, 2:] * 0.5 + 0.5
            )
            key = toned(n3 @ np.array(light.sun), tones)
            if still:
                key = 0.3 + 0.7 * key
            else:
                key = 0.08 + 0.92 * np.maximum(key, 0.42 * toned(n3 @ fill, tones))
            lit = base[f] * (ambient + np.array(light.sun_color) * key[:, None])
            haze = np.clip((z[nearer] - 2.0) * 0.04, 0, 1)[:, None] * (0.27 if still else 0.12)
            color[nearer] = lit + (horizon - lit) * haze
    return Traced(depth, ids, to_encoded(exposed(color)) * 255, sure, slack)
