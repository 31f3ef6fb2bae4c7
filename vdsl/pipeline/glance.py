"""Scores of a shot's proposals by two looks: a glance at all of them, and a full look at the best of those.

Assumes a glance that puts proposals in nearly the order of a full look. Guarantees that whatever a shot keeps
was looked at in full, that it is measured by what its pictures show and not by the lines of sight it was
proposed by, that its score is the same however many others were, and the same order every time.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..lang.ir import Shot
from ..propose.subjects import Filming
from ..propose.types import CameraProposal, ProposalGrid
from ..stage.assemble import StagedScene
from .ahead import one_ahead
from .drawn import as_drawn
from .filming import SEGMENTS, Camerawork, Seen
from .guides import About, about_of
from .judging import Glance, Judge
from .progress import StageClock

#: Frames drawn and judged at a time: bounds memory, and lets progress be seen.
_DRAWN_AT_ONCE = 128

Scores = NDArray[np.float64]
Measures = Mapping[str, float]


class Looked(NamedTuple):
    """What came of looking at N proposals.

    scores: [N]; measures: of each by its pictures, or by lines of sight where not all frames were drawn
    """

    scores: Scores
    measures: tuple[Measures, ...]


#: Looks at proposals, given by their indices.
Look = Callable[[Sequence[int]], Looked]


def second_looks(count: int, glance: Glance) -> int:
    """How many of so many proposals get a full look for certain; all of a few."""
    return min(count, max(glance.least, math.ceil(glance.share * count)))


@dataclass(frozen=True, eq=False)
class Screening:
    """Shows a judge some frames of some proposals of a shot.

    judge: asked for when there is something to judge
    """

    staged: StagedScene
    shot: Shot
    filming: Filming
    grid: ProposalGrid
    camerawork: Camerawork
    judge: Callable[[], Judge]
    clock: StageClock

    @cached_property
    def about(self) -> About:
        """What its cameras are about."""
        return about_of(self.shot, self.grid, self.filming, self.staged)

    def look(self, which: Sequence[int], glance: Glance | None = None) -> Looked:
        """N proposals by all eight frames, or by a glance."""
        clock, judge = self.clock, self.judge()
        frames, pictures = (glance.frames, glance.pictures) if glance else (range(SEGMENTS), True)
        clock.begin("draw", len(frames) * len(which), "frames")
        clock.begin("rank", len(frames) * len(which), "frames")
        whole = len(frames) == SEGMENTS
        parts: list[Scores] = []
        measures: list[Measures] = []
        at_once = _DRAWN_AT_ONCE // len(frames)

        def drawn(cameras: tuple[CameraProposal, ...]) -> Seen:
            with clock.spent("draw", len(frames) * len(cameras)):
                about = [self.about] * len(cameras)
                return self.camerawork.judge_frames(
                    *(self.staged, self.shot.style, self.grid.story, cameras),
                    which=frames,
                    about=about,
                    pictures=pictures,
                    depths=whole,
                )

        batches = (
            tuple(self.grid.cameras[i] for i in which[begin : begin + at_once])
            for begin in range(0, len(which), at_once)
        )
        for cameras, seen in one_ahead(drawn, batches):
            with clock.spent("rank", len(frames) * len(cameras)):
                if whole:
                    story = self.grid.story
                    cameras = tuple(as_drawn(self.shot, story, self.filming, self.staged, cameras, seen))
                parts.append(judge.glance(cameras, seen) if glance else judge.scores(cameras, seen))
                measures += [camera.measures for camera in cameras]
        return Looked(np.concatenate(parts), tuple(measures))


class Scored:
    """The scores of proposals, made as far as they are wanted.

    glance: gives the scores [P] of all of them by a glance, between 0 and 1; asked once
    look: looks at some in full; known, measures: what came of that before, by index
    best: how many that a glance puts first get a full look
    """

    def __init__(
        self,
        glance: Callable[[], Scores],
        look: Look,
        known: Mapping[int, float] | None = None,
        measures: Mapping[int, Measures] | None = None,
        best: int = 0,
    ) -> None:
        self._glance, self._look, self._best = glance, look, best
        self.known, self.measures = dict(known or {}), dict(measures or {})

    @classmethod
    def full(cls, scores: Scores, cameras: Sequence[CameraProposal]) -> Scored:
        """Of proposals that need no second look, and are measured as they were proposed."""
        measures = [camera.measures for camera in cameras]

        def look(which: Sequence[int]) -> Looked:
            return Looked(scores[list(which)], tuple(measures[i] for i in which))

        return cls(lambda: scores, look, dict(enumerate(scores.tolist())), dict(enumerate(measures)))

    @classmethod
    def of(cls, screening: Screening) -> Scored:
        """Of proposals nobody has looked at."""
        count, glance = len(screening.grid.cameras), screening.judge().glances
        best = second_looks(count, glance)
        if best == count:
            return cls(lambda: np.zeros(count), screening.look, best=best)
        return cls(lambda: screening.look(range(count), glance).scores, screening.look, best=best)

    @cached_property
    def first(self) -> Scores:
        """[P], by the glance."""
        return self._glance()

    def look(self, which: Sequence[int]) -> bool:
        """Look at these in full; whether there was any among them that had only been glanced at."""
        fresh = sorted(i for i in set(which) if i not in self.known)
        if fresh:
            looked = self._look(fresh)
            self.known |= dict(zip(fresh, looked.scores.tolist(), strict=True))
            self.measures |= dict(zip(fresh, looked.measures, strict=True))
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
