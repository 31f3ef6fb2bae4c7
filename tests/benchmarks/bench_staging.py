"""How long a scene with its cast takes to build, cold and from the cache, and how much memory that takes.

Run as ``python -m tests.benchmarks.bench_staging``. Each figure comes from a fresh process with a cache
folder of its own (``XDG_CACHE_HOME``), imports and reading the script not counted. Nothing is asserted.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from statistics import median

SCENES = {
    "apartment.kitchen, 2": ("apartment.kitchen", ("woman", "man")),
    "courtroom, 3": ("courtroom", ("judge", "lawyer", "police_officer")),
    "medieval_hall, 4": ("medieval_hall", ("king", "queen", "knight", "wizard")),
}
_NAMES = ("anna", "ben", "carl", "dora")


def script(place: str, cast: tuple[str, ...]) -> str:
    """A story in which everybody is there."""
    people = list(zip(_NAMES, cast, strict=False))
    lines = ['storyboard "bench"', *(f"character {name} = {kind}" for name, kind in people)]
    lines += [f"scene s = {place}", "", "/ (static wide)", *(f"({name} wave)" for name, _ in people)]
    return "\n".join(lines) + "\n"


def measure() -> None:
    """In a process of its own: stages the script on standard input and prints its figures as JSON."""
    import resource
    import time

    from vdsl.lang import Source
    from vdsl.pipeline.script import check_source
    from vdsl.pipeline.staging import Stagehand

    checked = check_source(Source("bench.vds", sys.stdin.read()))
    board = checked.storyboard
    wall, busy = time.perf_counter(), time.process_time()
    staged = Stagehand(checked.catalog).stage(board.scenes[0], board.characters, board.lines)
    wall, busy = time.perf_counter() - wall, time.process_time() - busy
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    count = len(staged.world.mesh.faces) + sum(len(b.mesh.faces) for b in staged.bodies.values())
    print(json.dumps([wall, busy, peak, count]))


def fresh(text: str, cache: Path) -> list[float]:
    """Figures of one process: seconds, seconds of processor, MB at most, triangles."""
    command = [sys.executable, "-m", "tests.benchmarks.bench_staging", "--measure"]
    env = os.environ | {"XDG_CACHE_HOME": str(cache)}
    done = subprocess.run(command, input=text, env=env, capture_output=True, text=True, check=True)
    figures: list[float] = json.loads(done.stdout.splitlines()[-1])
    return figures


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--measure", action="store_true", help=argparse.SUPPRESS)
    parser.add_argument("--runs", type=int, default=3, help="of which the middle one is printed")
    options = parser.parse_args()
    if options.measure:
        measure()
        return
    for name, (place, cast) in SCENES.items():
        rows: dict[str, list[list[float]]] = {"cold": [], "warm": []}
        for _ in range(options.runs):
            with tempfile.TemporaryDirectory() as folder:
                for kind in rows:
                    rows[kind].append(fresh(script(place, cast), Path(folder)))
        for kind, found in rows.items():
            wall, busy, peak, count = (median(column) for column in zip(*found, strict=True))
            times = f"{wall:6.3f} s {busy:6.3f} s of processor"
            print(f"{name:22} {kind} {times} {peak:5.0f} MB {count:8.0f} triangles")


if __name__ == "__main__":
    main()
