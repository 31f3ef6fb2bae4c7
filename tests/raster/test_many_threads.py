"""What GPUs do with a thread for each vertex, triangle or block comes to what a CPU does with one for each
moment or map."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from raster_scenes import LIGHT, box, looking, scene, sphere, still

from runtime.raster.kernels import contact, light
from runtime.raster.landing import Landing
from runtime.raster.renderer import Renderer
from runtime.raster.types import STYLES


def draw() -> None:
    """Two things at a time over a floor and a table: one that moves, one that rests, one far off."""
    floor = box((-4, -4, -0.1), (4, 4, 0), (0.7, 0.7, 0.7))
    table = box((-1, -1, 0.75), (1, 1, 0.8), (0.7, 0.7, 0.7), part=1)
    mug = box((-0.05, -0.05, 0.8), (0.05, 0.05, 0.9), (0.7, 0.1, 0.1))
    ball = sphere((-3.9, 2.0, 0.1), (0.1, 0.1, 0.1), (0.2, 0.3, 0.9))
    jar = box((0.5, 0.5, 0.8), (0.6, 0.6, 1.0), (0.1, 0.6, 0.3))
    drawer = Renderer("cpu", STYLES["board"])
    drawer.load(scene([floor, table], [mug, ball, jar], light=LIGHT, homely=[2]))
    moments = still(3, 4)
    moments[:, 0, 0, 3] = (0.0, 0.4, 0.8, 30.0)
    moments[:, 1, 2, 3] = (0.0, 0.1, 0.2, 0.3)
    views = looking([(0.0, -3.0, 2.0)] * 4, [(0.0, 0.0, 0.5)] * 4, moments=list(range(4)))
    drawer.render(moments, views, (160, 96))


def test_what_stands_near_is_counted_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    one_by_one, calls = contact.touch, 0

    def both(
        position: NDArray[np.float32], area: object, solid: object, runs: NDArray[np.int32], *rest: object
    ) -> None:
        nonlocal calls
        moments, *floor = rest[:6]
        begin, kept, spare, out, _, ground, *_ = rest[6:]
        listed = np.concatenate([np.arange(*run, dtype=np.int32) for run in runs])
        cells = moments * 2 * floor[3] * floor[4]
        counted, found = np.zeros(cells, np.int32), np.zeros_like(ground)
        memory = (begin, np.full(cells, 7, np.int32), counted, found)
        contact.touch_atomic(position, area, solid, listed, len(listed), moments, *floor, *memory)
        one_by_one(position, area, solid, runs, *rest)
        if kept < 0:
            np.testing.assert_array_equal(counted, out[:cells])
        np.testing.assert_array_equal(found[:cells], ground[:cells])
        assert not spare.any()
        assert counted.any()
        calls += 1

    monkeypatch.setattr(contact, "touch", both)
    draw()
    assert calls == 2, "what rests, and what moves"


def test_shadow_maps_are_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    one_by_one, sizes = light.cast, set()

    def both(*told: object) -> None:
        *things, depth, spare, coarse, _, _, _ = told
        frame, size, maps = things[-3:]
        atomic = [np.zeros_like(x) for x in (depth, spare, coarse)]
        light.cast_atomic(*things, *atomic)
        one_by_one(*told)
        there = np.flatnonzero(frame[:maps, 0] < light.FAR_OFF)
        assert len(there)
        for want, got, each in ((depth, atomic[0], size**2), (coarse, atomic[2], light.summary_size(size))):
            for m in there:
                part = slice(m * each, (m + 1) * each)
                np.testing.assert_array_equal(got[part], want[part])
            assert (want[: maps * each] > light.NOWHERE).any()
        sizes.add(size)

    monkeypatch.setattr(light, "cast", both)
    draw()
    assert sizes >= {160, 512}, "maps of what is away, and of what is at home"


def test_without_a_device_of_its_own_pictures_are_written_where_they_belong() -> None:
    landing, out = Landing(on_device=False), np.zeros((2, 3), np.uint8)
    landing.bytes(out)[:] = 5
    landing.fetch(out)
    landing.release()
    assert (out == 5).all()
