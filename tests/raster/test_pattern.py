"""Procedural materials: they stay near the base colour, fade with distance, and show when they should."""

from functools import lru_cache
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from raster_scenes import box, looking, scene, still

from runtime.mesh import MATERIALS
from runtime.raster.device import start
from runtime.raster.renderer import Renderer
from runtime.raster.types import Style, Views

SURFACES = [m for m in MATERIALS if m not in ("plain", "glass", "glow")]
#: What a landscape, an old wall or a machine is made of, and must be told from by its surface alone.
TELLING = ("water", "sand", "stone", "metal", "leaves", "earth", "marble", "cobble", "parquet", "plate")

#: Put on while shading, or too faint for pictures as small as here.
UNSEEN = ("concrete", "plaster", "cloth")


@lru_cache(maxsize=1)
def sampler() -> Any:
    start("cpu")
    import taichi as ti

    from runtime.raster.kernels.pattern import Alone, broad_pattern, noise_lattice, pattern

    lattice = noise_lattice()

    @ti.kernel
    def fill(
        material: ti.i32,
        upright: ti.i32,
        blur: ti.f32,
        lattice: ti.types.ndarray(dtype=ti.f32, ndim=1),
        points: ti.types.ndarray(dtype=ti.f32, ndim=2),
        out: ti.types.ndarray(dtype=ti.f32, ndim=1),
    ):
        for i in range(points.shape[0]):
            p = ti.Vector([points[i, 0], points[i, 1], points[i, 2]])
            n = ti.Vector([0.0, -1.0, 0.0]) if upright == 1 else ti.Vector([0.0, 0.0, 1.0])
            out[i] = broad_pattern(material, p, n, lattice)
            out[i] *= pattern(material, p.x, p.y, p.z, n, blur, Alone, (lattice,))

    return lambda material, upright, blur, points, out: fill(material, upright, blur, lattice, points, out)


def factors(material: str, upright: bool, blur: float, side: float = 8.0, count: int = 160) -> NDArray[Any]:
    """Factors on a square of the floor or of a wall, [count, count]."""
    u, v = np.meshgrid(*(np.linspace(-side / 2, side / 2, count),) * 2)
    level = np.full(u.shape, 0.35)
    points = np.stack([u, level, v] if upright else [u, v, level], -1).reshape(-1, 3).astype(np.float32)
    out = np.zeros(len(points), np.float32)
    sampler()(MATERIALS.index(material), int(upright), blur, points, out)
    return out.reshape(u.shape)


@pytest.mark.parametrize("material", SURFACES)
@pytest.mark.parametrize("upright", [False, True])
def test_a_material_stays_near_its_colour(material: str, upright: bool) -> None:
    near, far = factors(material, upright, 0.002), factors(material, upright, 0.4)
    for f in (near, far):
        assert f.min() > 0.6
        assert f.max() < 1.42
        assert abs(f.mean() - 1.0) < 0.1
    assert abs(near.mean() - far.mean()) < 0.1, "a floor changes its tone with distance"
    # far away only what is broader than a few pixels is left
    assert far.std() < 0.06
    rough = np.abs(np.diff(far, axis=0)).max()
    assert rough < 0.08


def test_plain_is_plain() -> None:
    assert (factors("plain", False, 0.01) == 1.0).all()


@pytest.mark.parametrize("material", TELLING)
def test_a_material_reads_at_thumbnail_size(material: str) -> None:
    """A floor or a wall of it, two metres off, in a picture of 224 pixels, is not a plain one."""
    style = Style("plain", outline=False, tones=0, shadows=False, occlusion=False)
    r = Renderer("cpu", style)
    pictures = {}
    for name in ("plain", material):
        floor = box((-6, -6, -0.1), (6, 6, 0), (0.7, 0.68, 0.62), name, 0)
        wall = box((-6, 6, 0), (6, 6.2, 5), (0.7, 0.68, 0.62), name, 1)
        r.load(scene([floor, wall], []))
        views = looking([(0.0, 0.0, 1.7)], [(0.4, 5.0, 0.9)], sensor=(36.0, 36.0))
        pictures[name] = r.render(still(1), views, (224, 224)).color[0].astype(float).mean(2)
    apart = np.abs(pictures[material] - pictures["plain"])
    assert (apart > 2).mean() > 0.2, f"{(apart > 2).mean():.3f} of the pixels differ"
    assert abs(pictures[material].mean() - pictures["plain"].mean()) < 8


def close_and_far() -> Views:
    """A floor near enough for its grain, and one so far that little of it is left."""
    return looking([(0.0, 0.0, 0.2), (0.3, -1.0, 1.7)], [(0.2, 0.3, 0.0), (0.4, 5.0, 0.9)])


@pytest.mark.parametrize("material", [m for m in SURFACES if m not in UNSEEN])
def test_sixteen_pixels_at_a_time_are_as_one_by_one(material: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Floor, walls, and a crowd of small boxes, so that runs show several triangles, and slanting rims."""
    drawer = Renderer("cpu", Style("grained", outline=False, shadows=False, occlusion=False))
    floor = box((-6, -6, -0.1), (6, 6, 0), (0.7, 0.68, 0.62), material, 0)
    wall = box((-6, 6, 0), (6, 6.2, 5), (0.7, 0.68, 0.62), material, 1)
    crowd = [
        box((x, 2.0 + x * x / 3, 0), (x + 0.1, 2.1 + x * x / 3, 0.4), (0.5, 0.5, 0.6), kind, 2)
        for x, kind in zip(np.arange(-2.0, 2.0, 0.2), [material, "plain"] * 10, strict=True)
    ]
    drawer.load(scene([floor, wall, *crowd], []))
    together = drawer.render(still(1), close_and_far(), (320, 176)).color.astype(int)
    monkeypatch.setattr(drawer._passes, "_grain_runs", None)
    alone = drawer.render(still(1), close_and_far(), (320, 176)).color.astype(int)
    apart = np.abs(together - alone).max(axis=-1)
    assert (apart > 2).mean() < 0.001, f"{apart.max()} apart at most"
    monkeypatch.setattr(drawer._passes, "_lay_grain", lambda *_: None)
    bare = drawer.render(still(1), close_and_far(), (320, 176)).color.astype(int)
    assert (np.abs(bare - alone).max(axis=-1) > 0).mean() > 0.15, "there is nothing to compare"
