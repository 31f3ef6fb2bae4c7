"""Scores of a shot's proposals by two looks: a glance at all of them, and a full look at the best of those.

Assumes a glance that puts proposals in nearly the order of a full look. Guarantees that whatever a shot keeps
was looked at in full, that its score is the same however many others were, and the same order every time.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..propose.types import CameraProposal, ProposalGrid
from ..stage.assemble import StagedScene
from .ahead import one_ahead
from .filming import SEGMENTS, Camerawork, Seen
from .guides import About
from .judging import Glance, Judge
from .progress import StageClock

#: Frames drawn and judged at a time: bounds memory, and lets progress be seen.
_DRAWN_AT_ONCE = 128

Scores = NDArray[np.float64]
#: Scores [N] of proposals, given by their indices.
Look = Callable[[Sequence[int]], Scores]


def second_looks(count: int, glance: Glance) -> int:
    """How many of so many proposals get a full look for certain; all of a few."""
    return min(count, max(glance.least, math.ceil(glance.share * count)))


@dataclass(frozen=True, eq=False)
class Screening:
    """Shows a judge some frames of some proposals.

    about: what their cameras are about; judge: asked for when there is something to judge
    """

    staged: StagedScene
    style: str
    grid: ProposalGrid
    about: About
    camerawork: Camerawork
    judge: Callable[[], Judge]
    clock: StageClock

    def scores(self, which: Sequence[int], glance: Glance | None = None) -> Scores:
        """Scores [N] of proposals by all eight frames, or by a glance."""
        clock, judge = self.clock, self.judge()
        frames, pictures = (glance.frames, glance.pictures) if glance else (range(SEGMENTS), True)
        clock.begin("draw", len(frames) * len(which), "frames")
        clock.begin("rank", len(frames) * len(which), "frames")
        parts, at_once = [], _DRAWN_AT_ONCE // len(frames)

        def drawn(cameras: tuple[CameraProposal, ...]) -> Seen:
            with clock.spent("draw", len(frames) * len(cameras)):
                about = [self.about] * len(cameras)
                return self.camerawork.judge_frames(
                    *(self.staged, self.style, self.grid.story, cameras),
                    which=frames,
                    about=about,
                    pictures=pictures,
                )

        batches = (
            tuple(self.grid.cameras[i] for i in which[begin : begin + at_once])
            for begin in range(0, len(which), at_once)
        )
        for cameras, seen in one_ahead(drawn, batches):
            with clock.spent("rank", len(frames) * len(cameras)):
                parts.append(judge.glance(cameras, seen) if glance else judge.scores(cameras, seen))
        return np.concatenate(parts)


class Scored:
    """The scores of proposals, made as far as they are wanted.

    glance: gives the scores [P] of all of them by a glance, between 0 and 1; asked once
    look: gives those of a full look; known: such scores from before, by index
    best: how many that a glance puts first get a full look
    """

    def __init__(
        self, glance: Callable[[], Scores], look: Look, known: Mapping[int, float], best: int = 0
    ) -> None:
        self._glance, self._look, self._best = glance, look, best
        self.known = dict(known)

    @classmethod
    def full(cls, scores: Scores) -> Scored:
        """Of proposals that need no second look."""
        return cls(lambda: scores, lambda which: scores[list(which)], dict(enumerate(scores.tolist())))

    @classmethod
    def of(cls, screening: Screening) -> Scored:
        """Of proposals nobody has looked at."""
        count, glance = len(screening.grid.cameras), screening.judge().glances
        best = second_looks(count, glance)
        if best == count:
            return cls(lambda: np.zeros(count), screening.scores, {}, best)
        return cls(lambda: screening.scores(range(count), glance), screening.scores, {}, best)

    @cached_property
    def first(self) -> Scores:
        """[P], by the glance."""
        return self._glance()

    def look(self, which: Sequence[int]) -> bool:
        """Look at these in full; whether there was any among them that had only been glanced at."""
        fresh = sorted(i for i in set(which) if i not in self.known)
        if fresh:
            self.known |= dict(zip(fresh, self._look(fresh).tolist(), strict=True))
        return bool(fresh)

    def look_at_best(self) -> None:
        """Look in full at those that a glance puts first."""
        self.look(np.argsort(-self.first, kind="stable")[: self._best].tolist())

    @property
    def order(self) -> Scores:
        """[P], to choose by: the scores of full looks, and behind them the rest by the glance."""
        out = self.first + (min(self.known.values(), default=0.0) - 1.0)
        out[list(self.known)] = list(self.known.values())
        return out
