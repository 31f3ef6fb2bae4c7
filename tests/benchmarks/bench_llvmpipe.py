"""Our plain look against OpenGL on the same processor: python -m tests.benchmarks.bench_llvmpipe

Draws the benchmark's room and a line of examples/coffee.vds with both in turns, readback included; what moves
is skinned beforehand for OpenGL and by us in every frame. Needs moderngl and Mesa's EGL (llvmpipe).
On a machine that is shared, believe the ratios and the processor time rather than the rates.
"""

from __future__ import annotations

import argparse
import sys
from functools import partial
from pathlib import Path

import numpy as np

from runtime.raster.renderer import Renderer
from runtime.raster.types import STYLES
from vdsl.pipeline.bench_render import Case, case_of, filmable, in_turns
from vdsl.pipeline.llvmpipe import LlvmpipeDrawer

HERE = Path(__file__).resolve()
SIZES = {(1280, 720): 16, (224, 224): 64}


def cases() -> dict[str, Case]:
    """The scenes drawn: the tests' own, and one of a script."""
    sys.path[:0] = [str(HERE.parent), str(HERE.parents[1] / "raster")]
    from bench_raster import furnished
    from raster_scenes import looking, still

    palettes = still(2, 8)
    palettes[:, :, 1, 3] = np.linspace(0, 0.2, 8)[:, None]
    views = looking([(2.6, -1.8, 1.5)] * 8, [(2.0, 1.8, 1.0)] * 8, moments=list(range(8)))
    act, story, moving, _ = filmable(HERE.parents[2] / "examples" / "coffee.vds")
    return {"room": Case(furnished(), palettes, views), "coffee": case_of(act, story, moving)}


def ours_drawn(drawer: Renderer, case: Case, size: tuple[int, int]) -> int:
    """Draw all frames of a case; returns how many."""
    return len(drawer.render(case.palettes, case.views, size).color)


def theirs_drawn(drawer: LlvmpipeDrawer, case: Case, size: tuple[int, int], together: int) -> int:
    """The same by OpenGL."""
    return sum(together for _ in drawer.sheets(case.views, size, together))


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=5.0, help="for each scene and size")
    options = parser.parse_args()
    for name, case in cases().items():
        count = len(case.scene.static.faces) + len(case.scene.skinned.faces)
        ours = Renderer("cpu", STYLES["plain"])
        ours.load(case.scene)
        made = {
            kind: LlvmpipeDrawer(case.scene, STYLES["plain"], case.palettes, kind)
            for kind in ("vertex", "pixel")
        }
        print(f"{name}: {count:,} triangles, {made['vertex'].name}")
        for size, frames in SIZES.items():
            some = case.only(frames)
            pictures = ours.render(some.palettes, some.views, size).color
            apart = np.abs(pictures.astype(int) - made["vertex"].draw(some.views, size)).mean()
            turns = {"ours": partial(ours_drawn, ours, some, size)}
            for kind, drawer in made.items():
                for together in (1, 16):
                    label = f"OpenGL, light by {kind}, {together} at once"
                    turns[label] = partial(theirs_drawn, drawer, some, size, together)
            found = in_turns(turns, options.seconds)
            print(f"  {size[0]} x {size[1]}; mean difference of the pictures {apart:.3f} of 255")
            for what, (rate, busy) in found.items():
                print(
                    f"    {what:<36}{rate:8.0f} frames/s{busy:8.2f} ms busy a frame"
                    f"  ours is {found['ours'][0] / rate:.2f}x, busy {busy / found['ours'][1]:.2f}x less"
                )


if __name__ == "__main__":
    main()
