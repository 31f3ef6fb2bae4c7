"""How many shots a second are judged: python -m tests.benchmarks.bench_ranker [--device cpu] [--shots 64]

The shipped network at the size its weights look at and at others, with guides and without. What it computes
takes as long whatever its weights are, so other sizes need no weights of their own.
"""

from __future__ import annotations

import argparse
import time
from dataclasses import replace
from statistics import median

import numpy as np
import torch

from ranker.guides import CHANNELS, FLOW, MARKS, SIDE, Guides, pairs
from ranker.infer import Ranker
from ranker.model import ShotRanker
from ranker.weights import load_model, load_ranges

TURNS = 5


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--device", default="auto")
    parser.add_argument("--shots", type=int, default=64, help="for each turn")
    parser.add_argument(
        "--sizes", type=int, nargs="+", default=[128, 224], help="sides of the pictures inside"
    )
    options = parser.parse_args()
    shipped, card = load_model()
    ranges, rng, count = load_ranges(None, shipped, card), np.random.default_rng(0), options.shots
    size, frames = shipped.config.size, shipped.config.frames
    pictures = rng.integers(0, 256, (count, frames, size, size, 3), dtype=np.uint8)
    guides = Guides(
        rng.integers(1, 256, (count, frames, SIDE, SIDE, len(CHANNELS)), dtype=np.uint8),
        rng.normal(0, 0.1, (count, len(pairs(frames)), FLOW, FLOW, 2)).astype(np.float16),
        rng.normal(0, 0.5, (count, frames, len(MARKS))).astype(np.float16),
    )
    rankers = {}
    for side in options.sizes:
        with torch.no_grad():
            model = ShotRanker(replace(shipped.config, inner=side))
            model.load_state_dict(shipped.state_dict())
        rankers[side] = Ranker(model, options.device, ranges)
    cases = {(side, told): [] for side in options.sizes for told in (True, False)}
    for turn in range(TURNS + 1):  # the first warms up
        for (side, told), rates in cases.items():
            begun = time.perf_counter()
            rankers[side].score(pictures, guides if told else None)
            if turn:
                rates.append(count / (time.perf_counter() - begun))
    for (side, told), rates in cases.items():
        ranker = rankers[side]
        print(
            f"{ranker.device.type} {ranker.engine}, {frames} x {side} x {side} inside, "
            f"{'with' if told else 'without'} guides: {median(rates):.1f} shots/s"
        )


if __name__ == "__main__":
    main()
