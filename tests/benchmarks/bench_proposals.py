"""How fast cameras are proposed: drawn, framed, moved, measured and judged, without acting or drawing.

``python tests/benchmarks/bench_proposals.py [MOVEMENT …]`` prints proposals offered a second of CPU time at
40, 400 and 4,000 proposals of some styles, the sum of two processes at work at once (a core each), and what
one of 4,000 costs against one of 40.
"""

from __future__ import annotations

import sys
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from time import process_time

from vdsl.cinema.styles import Style
from vdsl.pipeline.catalogue import Catalogue
from vdsl.propose.cameras import propose_cameras

COUNTS = (40, 400, 4000)
SHOWN = (
    Style("static", "medium", "eye-level"),
    Style("push", "medium", "high-angle"),
    Style("follow", "full", "eye-level", situation="walks"),
    Style("arc-left", "full", "eye-level"),
    Style("push+pan-left", "medium", "eye-level"),
)


def measured(style: Style) -> list[float]:
    """Seconds of CPU time for one proposal, at each of the counts; the best of some runs."""
    catalogue = Catalogue()
    act, stories = catalogue.situation(style)
    shot, _ = catalogue.propose(style, 8)
    out = []
    for count in COUNTS:
        wanted, best = replace(shot, proposals=count), float("inf")
        for _ in range(max(1, 600 // count)):
            begun = process_time()
            made = len(propose_cameras(wanted, stories, act.filming).cameras)
            best = min(best, (process_time() - begun) / made)
        out.append(best)
    return out


def main() -> None:
    """Print the table; words of movements narrow it down."""
    print("two cores".ljust(34), *(f"{count:>9d}" for count in COUNTS), "  4000/40")
    with ProcessPoolExecutor(2) as cores:
        for style in SHOWN:
            if len(sys.argv) > 1 and style.movement not in sys.argv[1:]:
                continue
            both = list(zip(*cores.map(measured, (style, style)), strict=True))
            rates = [sum(1 / cpu for cpu in costs) for costs in both]
            told = " ".join(f"{rate:7.0f}/s" for rate in rates)
            print(f"{style.words:34} {told} {rates[0] / rates[-1]:8.2f}", flush=True)


if __name__ == "__main__":
    main()
