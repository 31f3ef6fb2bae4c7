"""How fast pictures are drawn: python tests/benchmarks/bench_raster.py [--device cpu] [--seconds 4]

Pairs full style against bare shading, size by size, taking turns, and prints medians: on a machine that
is shared, believe the ratios and the processor time rather than the rates.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path
from statistics import median

import numpy as np

HERE = Path(__file__).resolve()
sys.path[:0] = [str(HERE.parents[2]), str(HERE.parents[1] / "raster")]

from raster_scenes import box, join, looking, room, scene, sphere, still  # noqa: E402

from runtime.raster.renderer import Renderer  # noqa: E402
from runtime.raster.types import RenderScene, Style  # noqa: E402

STYLES = {"board": Style(), "bare": Style("bare", outline=False, shadows=False, occlusion=False)}
SIZES = {(1280, 720): 8, (224, 224): 64}


def furnished() -> RenderScene:
    """The tests' room with people of 7,000 triangles each and 30,000 triangles of clutter."""
    plain = room()
    rng = np.random.default_rng(1)
    clutter = [
        sphere((*rng.uniform((0.2, 3.05), (2.2, 3.5)), 1.0), (0.05, 0.05, 0.06), (0.6, 0.5, 0.4), rings=16)
        for _ in range(30)
    ]
    people = [
        join(
            [
                sphere((x, y, 1.52), (0.1, 0.085, 0.13), (0.9, 0.7, 0.58), 0, 30),
                sphere((x, y, 1.13), (0.14, 0.2, 0.32), (0.76, 0.18, 0.2), 1, 40),
                sphere((x, y + 0.09, 0.45), (0.09, 0.08, 0.47), (0.2, 0.22, 0.3), 2, 24),
                sphere((x, y - 0.09, 0.45), (0.09, 0.08, 0.47), (0.2, 0.22, 0.3), 3, 24),
            ]
        )
        for x, y in ((1.0, 1.2), (3.2, 2.0))
    ]
    floor = [box((0, 0, -0.1), (4.2, 3.6, 0), (0.8, 0.74, 0.66), "wood"), plain.static]
    return scene([*floor, *clutter], people)


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--device", default="cpu")
    parser.add_argument("--seconds", type=float, default=4.0, help="for each size")
    options = parser.parse_args()
    content = furnished()
    drawers = {name: Renderer(options.device, style) for name, style in STYLES.items()}
    for drawer in drawers.values():
        drawer.load(content)
    print(f"{len(content.static.faces) + len(content.skinned.faces)} triangles, 8 moments")
    moments = still(2, 8)
    moments[:, :, 1, 3] = np.linspace(0, 0.2, 8)[:, None]
    for size, count in SIZES.items():
        views = looking(
            [(2.6, -1.8, 1.5)] * count, [(2.0, 1.8, 1.0)] * count, moments=[k % 8 for k in range(count)]
        )
        rates: dict[str, list[float]] = {name: [] for name in drawers}
        costs: dict[str, list[float]] = {name: [] for name in drawers}
        for drawer in drawers.values():
            drawer.render(moments, views, size)
        until = time.perf_counter() + options.seconds
        while time.perf_counter() < until or len(rates["board"]) < 3:
            for name, drawer in drawers.items():
                wall, busy = time.perf_counter(), time.process_time()
                drawer.render(moments, views, size)
                rates[name].append(count / (time.perf_counter() - wall))
                costs[name].append((time.process_time() - busy) / count * 1000)
        for name in drawers:
            print(
                f"{size[0]}x{size[1]} {name:6} {median(rates[name]):7.0f} frames/s"
                f"  {median(costs[name]):6.2f} ms of processor a frame"
            )


if __name__ == "__main__":
    main()
