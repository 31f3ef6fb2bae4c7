"""From saving an edited line to draft, film and all takes:

    python -m tests.benchmarks.bench_edit [--rank geometry]

Watches a copy of a story, changes one line once everything is made and loaded, and prints when the draft, the
film of first takes and the other takes were in their place, by the clock and in processor time, and which
shots were made anew.
What is made first is taken from the results kept for the user, or takes as long as a compilation does. How
quick the machine is by itself is told by what OpenGL on its processor draws of the same scene, and how long
the same would take where that draws 200 frames a second.
"""

from __future__ import annotations

import argparse
import queue
import tempfile
import threading
import time
from pathlib import Path
from statistics import median

from runtime.raster.types import STYLES
from vdsl.pipeline.bench_render import LARGE, case_of, filmable
from vdsl.pipeline.llvmpipe import LlvmpipeDrawer, NoOpenGLError
from vdsl.pipeline.options import Options
from vdsl.pipeline.watch import News, watch

DEMO = Path(__file__).parents[2] / "examples" / "coffee.vds"
#: Quiet for so long, a process has nothing left to load (s); and how long anything is waited for.
_QUIET, _PATIENCE = 1.5, 1800.0
#: Times OpenGL draws, after one to warm up.
_ROUNDS = 6
#: Plain frames of 1280 x 720 that OpenGL draws in a second on the machine times are compared with.
_COMPARED = 200.0


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--story", type=Path, default=DEMO)
    parser.add_argument("--old", default="lens 50mm", help="words of one line of the story")
    parser.add_argument(
        "--new", default=fresh_lens(), help="what they become; never seen before, unless said"
    )
    parser.add_argument("--rank", default="discriminator")
    options = parser.parse_args()
    text = options.story.read_text("utf-8")
    if text.count(options.old) != 1:
        parser.error(f"`{options.old}` has to be in the story once")
    with tempfile.TemporaryDirectory() as folder:
        measure(Path(folder), text, text.replace(options.old, options.new), options.rank)


def fresh_lens() -> str:
    """A lens no results are kept of."""
    return f"lens {40 + time.time() % 1e4 / 1e3:.4f}mm"


def measure(folder: Path, before: str, after: str, rank: str) -> None:
    """Watch a story, change its text, and print how long what took."""
    story, build = folder / "story.vds", folder / "build"
    story.write_text(before, "utf-8")
    news: queue.Queue[News] = queue.Queue()
    stop = threading.Event()
    watching = threading.Thread(
        target=watch,
        args=(story, build, lambda: Options(rank=rank), news.put),
        kwargs={"stop": stop},
        daemon=True,
    )
    watching.start()
    try:
        print(f"before: {until(news, 'done').message}")
        rest()
        files = times(build)
        begun, walls = (time.perf_counter(), time.process_time()), dict[str, float]()
        story.write_text(after, "utf-8")
        for state in ("draft", "firsts", "done"):
            told = until(news, state)
            wall, busy = time.perf_counter() - begun[0], time.process_time() - begun[1]
            walls[state] = wall
            print(f"{state:<6} after {wall:5.2f} s ({busy:5.2f} s of processor time): {told.message}")
            assert told.result is not None
            for stage in told.result.report.stages:
                print(f"    {stage.name:<8} {stage.seconds:5.2f} s  {stage.count} {stage.unit}")
        now = times(build)
        changed = sorted({path.parts[0] for path in now if now[path] != files.get(path)})
        same = sum(now[path] == files.get(path) for path in now)
        print(f"{same} of {len(now)} files of shots as they were; made anew: {', '.join(changed)}")
    finally:
        stop.set()
        watching.join()
    print(machine(walls))


def machine(walls: dict[str, float]) -> str:
    """How many frames of 1280 x 720 of the demo's scene OpenGL draws here in a second, in plain shading; and
    what ``walls`` [s] come to where it draws as many as are compared with."""
    act, story, moving, _ = filmable(DEMO)
    case = case_of(act, story, moving)
    try:
        drawer = LlvmpipeDrawer(case.scene, STYLES["plain"], case.palettes)
    except NoOpenGLError as error:
        return f"OpenGL on this processor: not measured ({error})"
    rates = []
    for _ in range(_ROUNDS):
        begun = time.perf_counter()
        rates.append(sum(1 for _ in drawer.sheets(case.views, LARGE)) / (time.perf_counter() - begun))
    rate = median(rates[1:])
    there = ", ".join(f"{state} after {wall * rate / _COMPARED:.1f} s" for state, wall in walls.items())
    return (
        f"OpenGL on this processor ({drawer.name}) draws {rate:.0f} plain frames/s\n"
        f"where it draws {_COMPARED:.0f}, that would be: {there}"
    )


def until(news: queue.Queue[News], state: str) -> News:
    """The next news of a state."""
    while True:
        told = news.get(timeout=_PATIENCE)
        if told.state == "error":
            raise SystemExit(told.message)
        if told.state == state:
            return told


def rest() -> None:
    """Wait until this process has nothing to do."""
    while True:
        busy = time.process_time()
        time.sleep(_QUIET)
        if time.process_time() - busy < 0.1 * _QUIET:
            return


def times(build: Path) -> dict[Path, int]:
    """When each file of the shots was written."""
    folder = build / "shots"
    return {p.relative_to(folder): p.stat().st_mtime_ns for p in folder.rglob("*") if p.is_file()}


if __name__ == "__main__":
    main()
