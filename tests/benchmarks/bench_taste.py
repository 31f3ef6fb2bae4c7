"""What few choices by one rule teach: in the film they were made in, and in another.

``python -m tests.benchmarks.bench_taste BUILD OTHER`` takes two builds with some takes a shot, as of
``taste_own.vds`` and ``taste_other.vds`` beside. For each rule (the lowest camera, the longest lens, …)
somebody chooses the take of every shot of BUILD that goes furthest by it; told is how often that take comes
first before and after, and how far what comes first in OTHER goes by the rule among all its takes (1 the
furthest).
"""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ranker.taste import Choice, learn
from vdsl.cinema.traits import TRAITS
from vdsl.pipeline.picked import picked_of

Traits = dict[str, NDArray[np.float64]]
RULES: dict[str, Callable[[Traits], NDArray[np.float64]]] = {
    "low cameras": lambda t: -t["height"],
    "looking up": lambda t: -t["elevation"],
    "high cameras": lambda t: t["height"],
    "faces": lambda t: t["face"],
    "faces turned away": lambda t: -t["face"],
    "lead room": lambda t: t["lead_room"],
    "long lenses": lambda t: t["focal"],
    "wide lenses": lambda t: -t["focal"],
    "calm cameras": lambda t: -t["speed"] - t["turning"],
    "hands": lambda t: t["hands_shown"] + 1e-3 * t["legible"],
    "by lot": lambda t: np.random.default_rng(int(1e6 * t["height"].sum())).random(len(t["height"])),
}


def takes_of(build: Path) -> list[Choice]:
    """The takes of every shot of a build, the first of each as chosen."""
    document = json.loads((build / "storyboard.json").read_text("utf-8"))
    shots = [
        picked_of(build, s["id"], s["takes"], s["takes"][0]["key"]) for s in document["shots"] if s["takes"]
    ]
    return [Choice(shot.traits, shot.odds, shot.chosen) for shot in shots if shot is not None]


def _by(rule: Callable[[Traits], NDArray[np.float64]], choice: Choice) -> NDArray[np.float64]:
    return rule(dict(zip(TRAITS, choice.traits.T, strict=True)))


def _place(by_rule: NDArray[np.float64], first: int) -> float:
    """Share of the other takes that go less far; ties for half."""
    less, same = (by_rule < by_rule[first]).sum(), (by_rule == by_rule[first]).sum() - 1
    return float((less + same / 2) / (len(by_rule) - 1))


def main(build: Path, other: Path) -> None:
    """Tell a row for every rule."""
    own, others = takes_of(build), takes_of(other)
    print(f"{len(own)} choices of {np.mean([len(c.margins) for c in own]):.0f} takes; ", end="")
    print(f"{len(others)} other shots of {np.mean([len(c.margins) for c in others]):.0f}")
    print(f"{'rule':18} {'chosen first':>14} {'place in other':>15} {'log odds lost':>14}")
    rows = []
    for name, rule in RULES.items():
        chosen = [replace(c, chosen=int(_by(rule, c).argmax())) for c in own]
        taste = learn(chosen, tuple(TRAITS))
        first = [(int(c.margins.argmax()), int((c.margins + taste.adds(c.traits)).argmax()))
                 for c in (*chosen, *others)]  # fmt: skip
        right = np.array([[f == c.chosen for f in two] for c, two in zip(chosen, first, strict=False)])
        place = np.array([[_place(_by(rule, c), f) for f in two]
                          for c, two in zip(others, first[len(chosen) :], strict=True)])  # fmt: skip
        lost = np.mean([c.margins[was] - c.margins[now]
                        for c, (was, now) in zip(others, first[len(chosen) :], strict=True)])  # fmt: skip
        rows.append((*right.mean(axis=0), *place.mean(axis=0), float(lost)))
        _tell(name, rows[-1])
    _tell("mean but by lot", tuple(np.mean(rows[:-1], axis=0)))
    spread = [float(np.ptp(c.margins)) for c in (*own, *others)]
    print(f"takes of a shot lie {min(spread):.1f} to {max(spread):.1f} log odds apart, ", end="")
    moved = []
    for c in own:
        for k in range(1, len(c.margins)):
            added = learn([replace(c, chosen=k)], tuple(TRAITS)).adds(c.traits)
            moved.append(float(added[k] - np.delete(added, k).mean()))
    print(f"and a single choice but the first moves its take by {np.mean(moved):.1f} against the others")


def _tell(name: str, row: tuple[float, ...]) -> None:
    was, now, before, after, lost = row
    print(f"{name:18} {was:6.2f} → {now:4.2f}  {before:6.2f} → {after:4.2f}  {lost:12.1f}", flush=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
