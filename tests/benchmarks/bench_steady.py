"""How steady sets of the library are on a slow pan: the share of pixels that change by more than 16 of 255.

    python -m tests.benchmarks.bench_steady [--time night] [--style ink] [SET ...]

A woman waves in the set's first free place, filmed in a few sizes by the proposal whose camera moves least;
from there the camera pans by three degrees a second, at 1280 x 720.
"""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path

import numpy as np

from runtime.raster.renderer import Renderer
from runtime.raster.types import STYLES
from vdsl.library import Catalog
from vdsl.pipeline.bench_render import case_of, filmable
from vdsl.pipeline.steadiness import SEEN, panned, steadiness

SIZES = ("wide", "medium-long", "close-up")
FRAMES, DEGREES = 8, 0.125
SCRIPT = """character anna = woman(height 1.68m, hair bob, top crimson)
scene s = {name} at {time}
(anna wave) / (static {size})
"""


def share(name: str, time: str, size: str, drawer: Renderer) -> float:
    """Of the pixels compared, those that change."""
    with tempfile.TemporaryDirectory() as folder:
        script = Path(folder) / "steady.vds"
        script.write_text(SCRIPT.format(name=name, time=time, size=size))
        act, story, _, still = filmable(script)
    case = case_of(act, story, still)
    drawer.load(case.scene)
    camera = panned(case.only(1).views.camera, FRAMES, DEGREES)
    return steadiness(drawer, case.palettes[0], camera, case.views.hidden[0], (1280, 720)).share


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("sets", nargs="*")
    parser.add_argument("--time", default="day")
    parser.add_argument("--style", default="board", choices=STYLES)
    told = parser.parse_args()
    drawer, found = Renderer("cpu", STYLES[told.style]), []
    print(f"{told.style}, {told.time}: % of the pixels that change by more than {SEEN} of 255")
    print(f"{'':20}" + "".join(f"{size:>14}" for size in SIZES))
    for name in told.sets or sorted(Catalog().names("set")):
        row = [100 * share(name, told.time, size, drawer) for size in SIZES]
        found += row
        print(f"{name:20}" + "".join(f"{value:14.2f}" for value in row), flush=True)
    over = sum(value >= 0.5 for value in found)
    middle, most = float(np.median(found)), max(found)
    print(f"in the middle {middle:.2f}, at most {most:.2f}; {over} of {len(found)} at 0.5 or more")


if __name__ == "__main__":
    main()
