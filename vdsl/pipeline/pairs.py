"""Two takes of a line by lot, side by side, with what is measured of them: what eyes prefer says how the
designer's criteria are to be weighed.

``python -m vdsl.pipeline.pairs OUT --lines 50`` draws sheets as :mod:`vdsl.pipeline.blind` does, of takes
without a fault where there are some, and ``pairs.json`` with the measures of each. Such a file with ``votes``
beside them, given instead, says in which share of the pairs the designer prefers what these do. Assumes the
library; no weights are asked for.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..propose.types import CameraProposal
from .blind import held_out_lines, sheets_of, strip
from .designer import appeal, judged
from .filming import Camerawork
from .selection import unlike

_FEW = 4  # with fewer takes without a fault than this, any are drawn


def pairs(out: Path, lines: int, seed: int = 0, device: str = "cpu") -> Path:
    """Draw pairs of ``lines`` lines into ``out``; returns ``pairs.json``. Raises OSError."""
    out.mkdir(parents=True, exist_ok=True)
    rng, camerawork = np.random.default_rng(seed), Camerawork(device)
    cells, found = [], []
    for number, (scene, shown) in enumerate(held_out_lines(seed, lines), 1):
        both = two_by_lot(shown.cameras, rng)
        for letter, i in zip("AB", both, strict=True):
            cells.append(
                (f"{number} {letter}", shown.shot, strip(camerawork, scene, shown, shown.cameras[i]))
            )
        measures = [{k: round(v, 4) for k, v in shown.cameras[i].measures.items()} for i in both]
        found.append({"line": number, "shot": shown.shot, "place": scene.place, "measures": measures})
        print(number, shown.shot, flush=True)
    sheets_of(cells, out)
    path = out / "pairs.json"
    path.write_text(json.dumps(found, indent=1) + "\n", "utf-8")
    return path


def two_by_lot(cameras: Sequence[CameraProposal], rng: np.random.Generator) -> tuple[int, int]:
    """Two proposals that do not look the same, of those without a fault where there are :data:`_FEW`, and
    where such look different."""
    opinion = judged(cameras)
    plain = np.flatnonzero(opinion > 0)
    pool = plain if len(plain) >= _FEW else np.arange(len(cameras))
    first = int(rng.choice(pool))
    others = unlike(cameras, first)
    near = [i for i in others if i in pool]
    return first, int(rng.choice(near or others))


def agreement(judged_pairs: Sequence[Mapping[str, Any]]) -> float:
    """Share of pairs in which the designer's appeal is greater for the take that the majority of ``votes``
    ("A", "B" or "=" each) prefers, of those in which there is one. Raises ValueError where there is none."""
    rows = [pair for pair in judged_pairs if _majority(pair["votes"])]
    if not rows:
        raise ValueError("no pair of which one take has a majority of the votes")
    names = set.intersection(*(set(m) for pair in rows for m in pair["measures"]))
    a, b = (
        appeal({name: np.array([pair["measures"][k][name] for pair in rows], float) for name in names})
        for k in (0, 1)
    )
    said: NDArray[np.float64] = np.array([_majority(pair["votes"]) for pair in rows], float)
    return float((np.sign(a - b) == said).mean())


def _majority(votes: Sequence[str]) -> int:
    """1 for A, −1 for B, 0 for neither."""
    a, b = (2 * votes.count(side) > len(votes) for side in "AB")
    return int(a) - int(b)


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("out", type=Path, help="a folder, or a file with votes")
    parser.add_argument("--lines", type=int, default=50)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    if options.out.is_file():
        print(f"{agreement(json.loads(options.out.read_text('utf-8'))):.3f}")
    else:
        print(pairs(options.out, options.lines, options.seed))


if __name__ == "__main__":
    main()
