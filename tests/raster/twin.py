"""A slow numpy twin of the rasteriser: one pixel and one triangle at a time, in float64.

Only what can be said simply: coverage, depth, and smooth shading without shadows. It clips by
rejecting samples behind the near plane, walks no spans and keeps no keys.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from runtime.raster.film import exposed, to_encoded, to_linear, unexposed
from runtime.raster.prepare import quieted
from runtime.raster.types import RenderScene, Views

NEAR = 0.03


@dataclass
class Traced:
    """depth [H, W] metres (inf: nothing); ids [H, W]; color [H, W, 3] 0..255; sure [H, W]: no edge nearby."""

    depth: NDArray[np.float64]
    ids: NDArray[np.int32]
    color: NDArray[np.float64]
    sure: NDArray[np.bool_]


def trace(scene: RenderScene, views: Views, n: int, size: tuple[int, int], quiet: float) -> Traced:
    """Cast one ray through the centre of each pixel of view ``n`` (unskinned positions)."""
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
    light = scene.light
    horizon, zenith = unexposed(to_linear(np.array(light.backdrop)))
    fill = axes[1] * 0.6 - axes[0] * 0.62 - axes[2] * 0.5
    fill /= np.linalg.norm(fill)
    up = rays[..., 2] / np.linalg.norm(rays, axis=-1)
    color[:] = horizon + (zenith - horizon) * np.clip(up * 1.6, 0, 1)[..., None]
    for mesh, owner, walls, still in (
        (scene.static, scene.static_object, scene.static_wall, True),
        (scene.skinned, scene.skinned_object, None, False),
    ):
        base = to_linear(mesh.colors)
        if still:
            base = quieted(base, quiet)
        for f, corner in enumerate(mesh.faces):
            if walls is not None and walls[f] >= 0 and views.hidden[n, walls[f]]:
                continue
            p = mesh.vertices[corner].astype(float) - eye
            if np.linalg.norm(np.cross(p[1] - p[0], p[2] - p[0])) == 0:
                continue
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
                slope = np.linalg.norm(np.stack(np.gradient(bary, axis=(0, 1))), axis=(0, -1))
            margin = 2e-3 * np.maximum(slope, 1e-9)[..., None]
            sure &= ~(ahead & (bary > -margin).all(axis=-1) & (bary < margin).any(axis=-1))
            sure &= ~((np.abs(z - NEAR) < 1e-4) & (bary >= -0.1).all(axis=-1))
            sure &= ~(inside & (z < depth * (1 + 1e-5)) & (z > depth * (1 - 1e-5)))
            nearer = inside & (z < depth)
            depth[nearer] = z[nearer]
            ids[nearer] = owner[f]
            n3 = bary[nearer] @ mesh.normals[corner].astype(float)
            n3 /= np.linalg.norm(n3, axis=-1, keepdims=True)
            if np.dot(np.cross(p[1] - p[0], p[2] - p[0]), p[0]) > 0:
                n3 = -n3
            ambient = np.array(light.ground) + (np.array(light.sky) - np.array(light.ground)) * (
                n3[:, 2:] * 0.5 + 0.5
            )
            key = np.maximum(n3 @ np.array(light.sun), 0)
            if still:
                key = 0.3 + 0.7 * key
            else:
                key = 0.08 + 0.92 * np.maximum(key, 0.42 * np.maximum(n3 @ fill, 0))
            lit = base[f] * (ambient + np.array(light.sun_color) * key[:, None])
            haze = np.clip((z[nearer] - 2.0) * 0.04, 0, 1)[:, None] * (0.36 if still else 0.15)
            color[nearer] = lit + (horizon - lit) * haze
    return Traced(depth, ids, to_encoded(exposed(color)) * 255, sure)
