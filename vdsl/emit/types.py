"""What the writers of artefacts take: a finished film as frozen values, nothing left to compute.

The pipeline fills these in; no module of this package looks anything up elsewhere.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..lang.ir import Shot, Storyboard, StoryLine, Transition
from ..propose.types import CameraProposal

CUT = Transition("cut", 0.0)


@dataclass(frozen=True, eq=False)
class Subject:
    """Whom a take is about. height: metres; position: float64 [T, 3], the floor point below them."""

    name: str
    height: float
    position: NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class TakeMedia:
    """The pictures of a take, already on disk in the build's folder.

    frames: how many the video has
    keys: three frames in order, uint8 [h, w, 3], for the contact sheet; none but for the best take
    """

    video: Path
    poster: Path
    frames: int
    keys: tuple[NDArray[np.uint8], ...]


@dataclass(frozen=True, eq=False)
class BuiltTake:
    """One kept proposal. rank: 1 is the best; score: the judge's, higher is better."""

    rank: int
    score: float
    camera: CameraProposal
    variant: str
    subject: Subject | None
    media: TakeMedia


@dataclass(frozen=True, eq=False)
class BuiltShot:
    """A shot with its takes, best first (none where every proposal was rejected).

    transition: how this shot joins the one before; only the first shot of a line has one other than a cut
    story_proposals, camera_proposals, proposals: S, C and how many were judged
    rejected: proposals thrown out before judging, by reason
    """

    shot: Shot
    line: StoryLine
    scene: str
    transition: Transition
    takes: tuple[BuiltTake, ...]
    story_proposals: int
    camera_proposals: int
    proposals: int
    rejected: dict[str, int]

    @property
    def frames(self) -> int:
        """Length of the best take; 0 without one."""
        return self.takes[0].media.frames if self.takes else 0


@dataclass(frozen=True, eq=False)
class Build:
    """The whole film. judge: ``ranker`` or ``geometry``, by which the takes were put in order."""

    storyboard: Storyboard
    shots: tuple[BuiltShot, ...]
    judge: str = "ranker"

    @property
    def shown(self) -> tuple[BuiltShot, ...]:
        """The shots that have a take, in order: what the animatic shows."""
        return tuple(s for s in self.shots if s.takes)


@dataclass(frozen=True)
class Stage:
    """One stage of a run. count: things done (proposals, frames, …); unit: what they are."""

    name: str
    seconds: float
    count: int = 0
    unit: str = ""


@dataclass(frozen=True)
class RunReport:
    """What a run took. peak_mib: peak resident memory; device: what drew the pictures."""

    seconds: float
    stages: tuple[Stage, ...]
    cache_hits: int = 0
    cache_misses: int = 0
    peak_mib: float = 0.0
    device: str = "cpu"
    notes: tuple[str, ...] = field(default=())
