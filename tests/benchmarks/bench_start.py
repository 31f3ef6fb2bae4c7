"""Start to first picture: python -m tests.benchmarks.bench_start [--runs 5] [--cold]

Each figure comes from a process of its own that imports the rasteriser, starts Taichi, loads two boxes and
draws one picture of 1280 x 720, style by style. Warm: compiled kernels are in the user's cache folder.
Cold: the cache folder is empty, so every kernel is compiled. Files are in the system's cache either way.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from statistics import median

CODE = """
import json, sys, time
begun = time.perf_counter(), time.process_time()
def lap(): return time.perf_counter() - begun[0], time.process_time() - begun[1]
from vdsl.pipeline import bench_first
laps = {"import": lap()}
from runtime.raster.device import start
start("cpu")
laps["Taichi"] = lap()
bench_first.first_picture("cpu", sys.argv[1])
laps["first picture"] = lap()
bench_first.first_picture("cpu", sys.argv[1])
laps["second"] = lap()
print(json.dumps(laps))
"""


def fresh(style: str, cache: str | None) -> dict[str, list[float]]:
    """Seconds by the clock and of processor until each step of a new process was done."""
    env = os.environ | ({"XDG_CACHE_HOME": cache} if cache else {})
    done = subprocess.run(
        [sys.executable, "-c", CODE, style], env=env, capture_output=True, text=True, check=True
    )
    laps: dict[str, list[float]] = json.loads(done.stdout.splitlines()[-1])
    return laps


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--cold", action="store_true", help="also with an empty cache folder, once")
    options = parser.parse_args()
    for style in ("board", "plain"):
        fresh(style, None)
        show(f"{style}, warm", [fresh(style, None) for _ in range(options.runs)])
        if options.cold:
            with tempfile.TemporaryDirectory() as empty:
                show(f"{style}, cold", [fresh(style, empty)])


def show(name: str, runs: list[dict[str, list[float]]]) -> None:
    """The median of each step."""
    steps = [
        f"{step} {median(r[step][0] for r in runs):.2f} s ({median(r[step][1] for r in runs):.2f} busy)"
        for step in runs[0]
    ]
    print(f"{name:<14}" + ", ".join(steps))


if __name__ == "__main__":
    main()
