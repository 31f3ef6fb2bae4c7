"""The Vulkan and CUDA backends against the CPU's, on whatever there is of them (in CI: Mesa's lavapipe).

A process draws on one device, so each draws the same pictures in a process of its own.
"""

from __future__ import annotations

import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from raster_scenes import LIGHT, box, looking, room, scene, sphere, still

from runtime.raster.types import RenderScene, Style, Views

HERE = Path(__file__).resolve()
NO_DEVICE = 77  # exit status of a process that found none
#: Widths that sixteen divides and does not, and heights over no whole block.
SIZES = ((160, 90), (61, 47))
SMALL = ((64, 36), (37, 29))
LIMIT = 900  # seconds: a device that is computed compiles every kernel on a machine that may be busy


def through_the_lens() -> tuple[RenderScene, Views]:
    """A floor under the eye and a wall that the near plane cuts."""
    content = scene(
        [box((-5, -5, -0.2), (5, 5, 0)), box((0.2, -5, 0), (0.4, 5, 3), (0.3, 0.5, 0.7))],
        [sphere((-0.5, 2.0, 1.0), (0.3, 0.2, 0.5), (0.8, 0.2, 0.2), rings=8)],
    )
    return content, looking([(0.0, 0.0, 1.2)], [(0.3, 3.0, 1.0)], focal=18)


def furnished() -> tuple[RenderScene, Views]:
    """The tests' room, with shadows, patterns and people, in two moments."""
    views = looking([(2.6, -1.8, 1.5), (0.5, 0.2, 1.6)], [(2.0, 1.8, 1.0)] * 2, moments=[0, 1])
    return room(), views


def by_lamplight() -> tuple[RenderScene, Views]:
    """A corner of two metres with a lamp that is on, and sun through a hole in its wall: volumes and charts
    of both are small."""
    parts = [
        box((-1, 0, -0.1), (1, 2, 0)),
        box((-1, 0, 1.5), (1, 2, 1.6)),
        box((-1, -0.1, 0), (-0.3, 0, 1.5), (0.5, 0.6, 0.7)),
        box((0.3, -0.1, 0), (1, 0, 1.5), (0.5, 0.6, 0.7)),
        box((0.4, 1.4, 0.5), (0.5, 1.5, 0.6), (1.0, 0.9, 0.7), "glow"),
    ]
    ball = sphere((0.0, 0.9, 0.3), (0.2, 0.2, 0.2), (0.8, 0.2, 0.2), rings=6)
    light = replace(LIGHT, sun=(0.0, -0.7, 0.714), lamps=1.0, windows=0.8)
    content = scene(parts, [ball], [-1, -1, 0, 0, -1], light)
    views = looking([(-0.7, 1.9, 1.2), (0.7, 1.9, 1.3)], [(0.1, 0.5, 0.1)] * 2, 18, moments=[0, 1], walls=1)
    return content, views


def draw_all(device: str, out: str) -> None:
    """In a process of its own: draw every scene at every size into a file of arrays."""
    from runtime.raster import passes
    from runtime.raster.device import DeviceError
    from runtime.raster.renderer import Renderer

    fine = passes.FINE
    try:
        drawer = Renderer(device, Style())
    except DeviceError as error:
        print(error, file=sys.stderr)
        sys.exit(NO_DEVICE)
    kept: dict[str, Any] = {}
    for make in (through_the_lens, furnished, by_lamplight):
        content, views = make()
        palettes = still(int(content.joints.max()) + 1, 2)
        palettes[1, :, 1, 3] = 0.2
        drawer.load(content)
        for size in SMALL if make is by_lamplight else SIZES:
            passes.FINE = 0 if size == SIZES[0] else fine  # edges to a part of a pixel, as in large pictures
            frames = drawer.render(palettes, views, size, ids=True)
            kept[f"{make.__name__} {size} color"] = frames.color
            kept[f"{make.__name__} {size} ids"] = frames.ids
    np.savez(out, **kept)


def drawn(device: str, folder: Path) -> dict[str, np.ndarray]:
    """What ``device`` draws; skips the test where there is no such device."""
    out = folder / f"{device}.npz"
    code = f"import sys; sys.path[:0] = {[str(HERE.parents[2]), str(HERE.parent)]!r}\n"
    code += f"from test_backends import draw_all; draw_all({device!r}, {str(out)!r})"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=LIMIT)
    expected = device == "cpu" or os.environ.get(f"VDS_EXPECT_{device.upper()}")
    if done.returncode == NO_DEVICE and not expected:
        pytest.skip(f"no {device} here: {done.stderr.strip().splitlines()[-1]}")
    assert done.returncode == 0, done.stderr
    return dict(np.load(out))


@pytest.mark.parametrize("device", ["vulkan", "cuda"])
def test_a_gpu_draws_what_the_cpu_draws(device: str, tmp_path: Path) -> None:
    other = drawn(device, tmp_path)
    host = drawn("cpu", tmp_path)
    assert set(host) == set(other)
    for name, picture in host.items():
        if name.endswith("ids"):
            assert (picture >= 0).mean() > 0.5, name  # there is something to see
            assert (picture == other[name]).mean() >= 0.999, name
        else:
            apart = np.abs(picture.astype(int) - other[name]).max(axis=-1)
            assert (apart <= 2).mean() >= 0.999, name
