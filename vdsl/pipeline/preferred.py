"""Four takes of a line side by side, with what is measured of them: which ones eyes put first says how the
criteria of the designer and of the geometry score are to be weighed.

``python -m vdsl.pipeline.preferred OUT --lines 50`` draws sheets as :mod:`vdsl.pipeline.blind` does, and
``preferred.json`` with the measures of each take. Such a file with ``orders`` in it, given instead, says of
which share of two takes of a line the designer, and the geometry, prefer the one that all these do. Assumes
the library; no weights are asked for.
"""

from __future__ import annotations

import argparse
import json
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import combinations
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..cinema.measures import MEASURES
from ..cinema.score import geometry_scores
from ..propose.types import CameraProposal
from .blind import held_out_lines, sheets_of, strip
from .designer import judged
from .filming import Camerawork
from .judging import prior
from .selection import ranked, unlike

LETTERS = "ABCD"
#: Opinions [T] of takes whose measures are arrays [T].
Opinion = Callable[[Mapping[str, NDArray[np.float64]]], NDArray[np.float64]]


def preferred(out: Path, lines: int, seed: int = 0, device: str = "cpu") -> Path:
    """Draw four takes each of ``lines`` lines into ``out``; returns ``preferred.json``. Raises OSError."""
    out.mkdir(parents=True, exist_ok=True)
    rng, camerawork = np.random.default_rng(seed), Camerawork(device)
    cells, found = [], []
    for number, (scene, shown) in enumerate(held_out_lines(seed, lines), 1):
        four = four_takes(shown.cameras, rng)
        for letter, i in zip(LETTERS, four, strict=True):
            picture = strip(camerawork, scene, shown, shown.cameras[i])
            cells.append((f"{number} {letter}", shown.shot, picture))
        measures = [[round(shown.cameras[i].measures[name], 3) for name in MEASURES] for i in four]
        found.append({"seed": seed, "line": number, "shot": shown.shot, "orders": [], "measures": measures})
        print(number, shown.shot, flush=True)
    sheets_of(cells, out)
    path = out / "preferred.json"
    path.write_text(json.dumps({"measures": list(MEASURES), "lines": found}) + "\n", "utf-8")
    return path


def four_takes(cameras: Sequence[CameraProposal], rng: np.random.Generator) -> list[int]:
    """Indices of four proposals in an order by lot: what the designer puts first, what the geometry does, and
    others by lot, of those that look different from these where there are such."""
    by_lot = [int(i) for i in rng.permutation(len(cameras))]
    firsts = [judged(cameras), np.array([prior(camera.measures) for camera in cameras])]
    kept: list[int] = []
    different = set(range(len(cameras)))

    def keep(order: Sequence[int], most: int) -> None:
        for i in order:
            if i in different and len(kept) < most:
                kept.append(i)
                different.intersection_update(unlike(cameras, i))

    for count, first in enumerate(firsts, 1):
        keep(ranked(first), count)
    keep(by_lot, len(LETTERS))
    kept += [i for i in by_lot if i not in kept][: len(LETTERS) - len(kept)]
    return [int(i) for i in rng.permutation(kept)]


def two_of_line(line: Mapping[str, Any]) -> Iterator[tuple[int, int]]:
    """Which of two takes of a line everybody prefers, and the other one: their numbers."""
    places = [placed(order) for order in line["orders"]]
    for a, b in combinations(range(len(LETTERS)), 2):
        said = {int(np.sign(place[b] - place[a])) for place in places}
        if said == {1}:
            yield a, b
        elif said == {-1}:
            yield b, a


def placed(order: str) -> tuple[int, ...]:
    """The places of the takes in an order such as ``C>A=D>B``, the best 0. Raises ValueError."""
    tiers = [re.findall(f"[{LETTERS}]", tier) for tier in order.split(">")]
    place = {letter: k for k, tier in enumerate(tiers) for letter in tier}
    if sorted(place) != sorted(LETTERS):
        raise ValueError(f"no order of {', '.join(LETTERS)}: {order!r}")
    return tuple(place[letter] for letter in LETTERS)


def agreement(found: Mapping[str, Any], opinion: Opinion) -> tuple[float, int]:
    """In which share of two takes of a line, of which all who were asked prefer the same one, so does
    ``opinion``; and how many there are. Raises ValueError where there is none."""
    right, count = 0, 0
    for line in found["lines"]:
        columns = np.array(line["measures"], float).T
        thought = opinion(dict(zip(found["measures"], columns, strict=True)))
        for better, worse in two_of_line(line):
            right, count = right + int(thought[better] > thought[worse]), count + 1
    if not count:
        raise ValueError("no two takes of which everybody prefers the same one")
    return right / count, count


def designers(measures: Mapping[str, NDArray[np.float64]]) -> NDArray[np.float64]:
    """What the designer thinks of takes with these measures [T]."""
    takes: list[Any] = [
        SimpleNamespace(measures=dict(zip(measures, row, strict=True)))
        for row in zip(*measures.values(), strict=True)
    ]
    return judged(takes)


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("out", type=Path, help="a folder, or a file with orders")
    parser.add_argument("--lines", type=int, default=50)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    if options.out.is_file():
        found = json.loads(options.out.read_text("utf-8"))
        for name, opinion in (("designer", designers), ("geometry", geometry_scores)):
            share, count = agreement(found, opinion)
            print(f"{name}: {share:.3f} of {count}")
    else:
        print(preferred(options.out, options.lines, options.seed))


if __name__ == "__main__":
    main()
