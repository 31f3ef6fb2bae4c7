"""The discriminator measured on what it never saw: everything ``vdsc evaluate`` says, as plain values.

Assumes a training set that keeps sets and people apart (:mod:`vdsl.pipeline.dataset`).
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ranker.data import Dataset, Words
from ranker.errors import RankerError
from ranker.evaluate import agreement_with_fp32, evaluate
from ranker.infer import Ranker
from ranker.weights import load_model

from .hiding import hide, told
from .progress import Progress, Silence


def evaluated(
    data: Path,
    weights: Path | None = None,
    proposals: int = 20_000,
    clips: int | None = None,
    exact: int = 200,
    seed: int = 0,
    device: str = "auto",
    progress: Progress | None = None,
    by_guides: bool = False,
) -> dict[str, Any]:
    """Measure weights on the clips of a set that are for testing, and by picks hidden among proposals.

    ``by_pictures_alone``: the clips without their guides, as films of cameras have none
    by_guides: judge the latter by their guides alone, for which nobody has to draw pictures
    Raises :class:`ranker.RankerError` for a set or weights that cannot be used, OSError.
    """
    watcher = progress or Silence()
    held_set = Dataset(data)
    model, card = load_model(weights)
    ranker = Ranker.load(weights, device if device in ("cpu", "cuda") else "auto")
    if by_guides and not ranker.judges_guides:
        raise RankerError("these weights were never taught by guides alone: leave out --by-guides")
    ranker.fits(held_set.frames)
    test = np.array(
        [i for i, label in enumerate(held_set.labels) if label.split == "test" and not label.bare], np.int64
    )
    if not len(test):
        raise RankerError(f"{data}: keeps no clips for testing; film one with `vdsc dataset`")
    if clips is not None:
        test = np.sort(np.random.default_rng(seed).permutation(test)[:clips])
    watcher.begin("clips", 2 * len(test), "clips")
    c = ranker.config
    held_set.words = Words(c.movements, c.scales, c.angles)  # what the ranker was taught, maybe others
    found = evaluate(ranker, held_set, test)
    watcher.advance("clips", len(test), 0.0)
    some = np.random.default_rng(seed + 1).permutation(test)[:exact]
    found["spearman_fp32"] = agreement_with_fp32(model, ranker, held_set, some)
    # As films of cameras are judged, of which nothing is told but what they show.
    alone = evaluate(ranker, held_set, test, guided=False)
    watcher.advance("clips", len(test), 0.0)
    alone["spearman_fp32"] = agreement_with_fp32(model, ranker, held_set, some, guided=False)
    found["by_pictures_alone"] = alone
    judged = "guides" if by_guides else ranker.engine
    kept = data / "hidden" / f"{card.sha256[:12]}-{judged}.jsonl"
    found |= told(hide(ranker, kept, proposals, seed, device, progress, not by_guides) if proposals else [])
    return {"weights": card.sha256, "engine": ranker.engine, "data": held_set.about(), **found}
