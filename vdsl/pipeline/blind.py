"""The ranker's choice beside a random take, unnamed: sheets to look at and say which is better.

``python -m vdsl.pipeline.blind docs/ranker/blind`` plays lines of stories for testing, which no training saw,
proposes cameras, and draws three frames each of the take that ``compile`` would put first and of one drawn by
lot among those that do not look the same, left and right by lot; ``key.json`` beside the sheets says which is
which. Assumes the library and weights.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterator, Sequence
from itertools import islice
from pathlib import Path

import numpy as np
from PIL import Image

from ..lang.shots import DEFAULT_PROPOSALS
from ..propose.types import CameraProposal, ProposalGrid
from .captions import grid
from .casting import TEST_EVERY, Scene, Troupe
from .filming import Camerawork
from .glance import Scored, Screening
from .judging import DiscriminatorJudge
from .progress import Silence, StageClock
from .selection import unlike
from .witness import best, vet

_SEED = 2_000_003  # added to the seed: other stories than of training sets and hidden picks
_LEAST = 8  # proposals that there have to be to choose from
_CELL = (256, 144)  # pixels of a frame
_AT = (0.1, 0.5, 0.9)  # of a take's length
_ROWS = 10  # of a sheet
_A_STORY = 2  # lines


def blind(out: Path, lines: int, weights: Path | None = None, seed: int = 0, device: str = "cpu") -> Path:
    """Draw sheets of ``lines`` lines into ``out``; returns the key. Raises RankerError, OSError."""
    out.mkdir(parents=True, exist_ok=True)
    judge, camerawork = DiscriminatorJudge(weights, device), Camerawork(device)
    cells, key = [], []
    for number, (scene, shown) in enumerate(held_out_lines(seed, lines), 1):
        scored = _scored(judge, camerawork, scene, shown)
        chosen = _first(scored, camerawork, scene, shown)
        sides = drawn(shown.cameras, chosen, seed, number)
        scored.look(sides)
        for letter, i in zip("AB", sides, strict=True):
            cells.append(
                (f"{number} {letter}", shown.shot, strip(camerawork, scene, shown, shown.cameras[i]))
            )
        said = {"line": number, "shot": shown.shot, "place": scene.place, "chosen": "AB"[sides.index(chosen)]}
        key.append(said | {"scores": [round(scored.known[i], 4) for i in sides]})
        print(number, shown.shot, flush=True)
    sheets_of(cells, out)
    path = out / "key.json"
    path.write_text(json.dumps(key, indent=1) + "\n", "utf-8")
    return path


def drawn(cameras: Sequence[CameraProposal], chosen: int, seed: int, line: int) -> list[int]:
    """The chosen take and one by lot of those that do not look the same, in an order by lot.

    The lots are of the seed and the line alone: beside the choices of two rankers stand the same takes, as
    far as these choices look different from them.
    """
    lots, others = np.random.default_rng((seed, line)), set(unlike(cameras, chosen))
    other = next(int(i) for i in lots.permutation(len(cameras)) if i in others)
    return [chosen, other] if lots.random() < 0.5 else [other, chosen]


def sheets_of(cells: Sequence[tuple[str, str, Image.Image]], out: Path) -> None:
    """Write pairs of strips, each with what is said below it, ten to a sheet."""
    for begin in range(0, len(cells), 2 * _ROWS):
        grid(cells[begin : begin + 2 * _ROWS], 2).save(out / f"sheet-{begin // (2 * _ROWS) + 1}.png")


def held_out_lines(
    seed: int, lines: int, proposals: int = DEFAULT_PROPOSALS
) -> Iterator[tuple[Scene, ProposalGrid]]:
    """Lines of stories that no training saw, with their proposals: the first few of every story."""
    troupe, number, found = Troupe(seed + _SEED), TEST_EVERY - 1, 0
    while found < lines:
        scenes = troupe.scenes(number, proposals, "test", most=1)
        fit = (scene for scene in scenes if len(scene.grids[0].cameras) >= _LEAST)
        for scene in islice(fit, min(_A_STORY, lines - found)):
            yield scene, scene.grids[0]
            found += 1
        number += TEST_EVERY


def _scored(judge: DiscriminatorJudge, camerawork: Camerawork, scene: Scene, shown: ProposalGrid) -> Scored:
    """The scores of a line's proposals, as ``compile`` comes by them."""
    shot, clock = scene.shots[0], StageClock(Silence())
    scored = Scored.of(Screening(scene.staged, shot, scene.filming, shown, camerawork, lambda: judge, clock))
    scored.look_at_best()
    return scored


def _first(scored: Scored, camerawork: Camerawork, scene: Scene, shown: ProposalGrid) -> int:
    """The take that ``compile`` would put first: the best that shows what it is about, as it was asked."""
    first_of, about = best(shown, 1), (scene.staged, scene.shots[0], scene.filming)
    while True:  # until it was looked at in full
        vetted = vet(shown, scored.order, first_of, about, camerawork)
        (first,) = first_of(vetted.order, vetted.failed)
        if not scored.look([first]):
            return first


def strip(camerawork: Camerawork, scene: Scene, shown: ProposalGrid, camera: CameraProposal) -> Image.Image:
    """Three frames of a take, side by side."""
    story = next(s for s in shown.story if s.index == camera.story)
    at = np.round(np.array(_AT) * (story.frames - 1)).astype(int)
    frames = camerawork.frames_at(scene.staged, scene.shots[0].style, story, camera, _CELL, at)
    return Image.fromarray(np.concatenate(list(frames), axis=1))


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("out", type=Path)
    parser.add_argument("--lines", type=int, default=50)
    parser.add_argument("--weights", type=Path)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    print(blind(options.out, options.lines, options.weights, options.seed))


if __name__ == "__main__":
    main()
