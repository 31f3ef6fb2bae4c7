"""How the pipeline tells whoever watches how far it is."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from time import perf_counter
from typing import Protocol


class Progress(Protocol):
    """Somebody watching. Stages come one at a time or interleaved; amounts are in the stage's unit."""

    def begin(self, stage: str, total: int, unit: str) -> None:
        """A stage with so many units of work ahead; called again, the total grows by that much."""

    def advance(self, stage: str, amount: int, seconds: float) -> None:
        """So many more units are done, in so many seconds of work."""


class Silence:
    """Nobody watching."""

    def begin(self, stage: str, total: int, unit: str) -> None:
        pass

    def advance(self, stage: str, amount: int, seconds: float) -> None:
        pass


@dataclass
class StageClock:
    """Seconds spent and units done in each stage, for ``report.json`` and the benchmark."""

    watcher: Progress
    seconds: dict[str, float] = field(default_factory=dict)
    units: dict[str, int] = field(default_factory=dict)

    def begin(self, stage: str, total: int, unit: str) -> None:
        self.watcher.begin(stage, total, unit)

    @contextmanager
    def spent(self, stage: str, amount: int, quiet: bool = False) -> Iterator[None]:
        """Counts the block's time and, when it ends well, ``amount`` units as done.

        quiet: a stage too short for the watcher to be told of
        """
        start = perf_counter()
        try:
            yield
        finally:
            seconds = perf_counter() - start
            self.seconds[stage] = self.seconds.get(stage, 0.0) + seconds
        self.units[stage] = self.units.get(stage, 0) + amount
        if not quiet:
            self.watcher.advance(stage, amount, seconds)
