"""What few choices by one rule teach: in the film they were made in, and in another.

``python -m tests.benchmarks.bench_taste BUILD OTHER`` takes two builds with some takes a shot. For each rule
(the lowest camera, the longest lens, …) somebody chooses the take of every shot of BUILD that goes furthest
by it; told is how often that take comes first before and after, and how far what comes first in OTHER goes
by the rule among all its takes (1 the furthest).
"""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ranker.infer import Ranker
from ranker.taste import Choice, learn
from vdsl.cinema.traits import TRAITS
from vdsl.pipeline.realclips import preference

_LOT = np.random.default_rng(0)
Traits = dict[str, NDArray[np.float64]]
RULES: dict[str, Callable[[Traits], NDArray[np.float64]]] = {
    "low cameras": lambda t: -t["elevation"],
    "high cameras": lambda t: t["height"],
    "faces": lambda t: t["face"],
    "faces turned away": lambda t: -t["face"],
    "lead room": lambda t: t["lead_room"],
    "long lenses": lambda t: t["focal"],
    "wide lenses": lambda t: -t["focal"],
    "calm cameras": lambda t: -t["speed"] - t["turning"],
    "hands": lambda t: t["hands_shown"] + 1e-3 * t["legible"],
    "by lot": lambda t: _LOT.random(len(t["face"])),
}


def takes_of(build: Path, ranker: Ranker) -> list[Choice]:
    """The takes of every shot of a build, the first of each as chosen."""
    document = json.loads((build / "storyboard.json").read_text("utf-8"))
    found = []
    for shot in document["shots"]:
        if len(shot["takes"]) > 1:
            liked = preference(build, document, shot, shot["takes"][0]["key"], ranker.config.size)
            assert liked is not None
            found.append(Choice(ranker.score(liked.frames).feature, liked.traits, liked.odds, 0))
    return found


def _by(rule: Callable[[Traits], NDArray[np.float64]], choice: Choice) -> NDArray[np.float64]:
    return rule(dict(zip(TRAITS, choice.traits.T, strict=True)))


def _place(by_rule: NDArray[np.float64], first: int) -> float:
    """Share of the other takes that go less far; ties for half."""
    less, same = (by_rule < by_rule[first]).sum(), (by_rule == by_rule[first]).sum() - 1
    return float((less + same / 2) / (len(by_rule) - 1))


def main(build: Path, other: Path) -> None:
    """Tell a row for every rule."""
    ranker = Ranker.load(device="cpu")
    own, others = takes_of(build, ranker), takes_of(other, ranker)
    print(f"{len(own)} choices of {np.mean([len(c.margins) for c in own]):.0f} takes; ", end="")
    print(f"{len(others)} other shots of {np.mean([len(c.margins) for c in others]):.0f}")
    print(f"{'rule':18} {'chosen first':>14} {'place in other':>15} {'log odds lost':>14}")
    rows = []
    for name, rule in RULES.items():
        chosen = [replace(c, chosen=int(_by(rule, c).argmax())) for c in own]
        taste = learn(chosen, tuple(TRAITS), "")
        first = [(int(c.margins.argmax()), int((c.margins + taste.adds(c.traits, c.features)).argmax()))
                 for c in (*chosen, *others)]  # fmt: skip
        right = np.array([[f == c.chosen for f in two] for c, two in zip(chosen, first, strict=False)])
        place = np.array([[_place(_by(rule, c), f) for f in two]
                          for c, two in zip(others, first[len(chosen) :], strict=True)])  # fmt: skip
        lost = np.mean([c.margins[was] - c.margins[now]
                        for c, (was, now) in zip(others, first[len(chosen) :], strict=True)])  # fmt: skip
        rows.append((*right.mean(axis=0), *place.mean(axis=0), float(lost)))
        _tell(name, rows[-1])
    _tell("mean but by lot", tuple(np.mean(rows[:-1], axis=0)))


def _tell(name: str, row: tuple[float, ...]) -> None:
    was, now, before, after, lost = row
    print(f"{name:18} {was:6.2f} → {now:4.2f}  {before:6.2f} → {after:4.2f}  {lost:12.1f}", flush=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
