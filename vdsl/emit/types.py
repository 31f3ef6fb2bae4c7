"""What the writers of artefacts take: a finished film as frozen values, nothing left to compute.

The pipeline fills these in; no module of this package looks anything up elsewhere.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..cinema.continuity import Finding
from ..lang.ir import Shot, Storyboard, StoryLine, Transition
from ..propose.promise import Achieved
from ..propose.types import Advice, CameraProposal

if TYPE_CHECKING:
    from .plan_ground import Ground

CUT = Transition("cut", 0.0)


@dataclass(frozen=True, eq=False)
class Subject:
    """Whom a take is about. height: metres; position: float64 [T, 3], the floor point below them."""

    name: str
    height: float
    position: NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Walk:
    """Where somebody goes in a take. position: float64 [T, 3], on the floor; heading: [T], radians

    head: [T, 3], the base of the head, where the neck ends
    """

    name: str
    position: NDArray[np.float64]
    heading: NDArray[np.float64]
    head: NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class TakeMedia:
    """The pictures of a take, already on disk in the build's folder.

    frames: how many the video has
    keys: three frames in order, uint8 [h, w, 3], for the contact sheet; none but for the best take
    sketched: whether there is no video yet, as in a draft
    """

    video: Path
    poster: Path
    frames: int
    keys: tuple[NDArray[np.uint8], ...]
    sketched: bool = False


@dataclass(frozen=True, eq=False)
class BuiltTake:
    """One kept proposal. rank: 1 is the best; score: the judge's, higher is better.

    achieved: what its track turned out to be
    logit: what the discriminator alone gave it, in log odds; None where it was not asked; taste: what a
        writer's taste added to that
    key: by which it is found again among the same proposals; chosen: whether somebody chose it
    people: everybody in the scene, and where they go
    """

    rank: int
    score: float
    camera: CameraProposal
    variant: str
    subject: Subject | None
    media: TakeMedia
    achieved: Achieved
    logit: float | None = None
    taste: float = 0.0
    key: str = ""
    chosen: bool = False
    people: tuple[Walk, ...] = ()


@dataclass(frozen=True, eq=False)
class BuiltShot:
    """A shot with its takes, best first (none where every proposal was rejected).

    transition: how this shot joins the one before; only the first shot of a line has one other than a cut
    story_proposals, camera_proposals, proposals: S, C and how many were judged
    rejected: proposals thrown out before judging, by reason
    advice: where no camera does what the line says, why, and what would
    depends: digest of what its line depends on
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
    advice: Advice | None = None
    depends: str = ""

    @property
    def frames(self) -> int:
        """Length of the best take; 0 without one."""
        return self.takes[0].media.frames if self.takes else 0


@dataclass(frozen=True)
class CutFinding:
    """A rule that the cut between two shots breaks. shots: their ids; cut: their numbers, from 1."""

    shots: tuple[str, str]
    cut: tuple[int, int]
    finding: Finding

    @property
    def text(self) -> str:
        """``cut 3→4 crosses the line by 41° (anna–ben)``."""
        return f"cut {self.cut[0]}→{self.cut[1]} {self.finding.words}"


#: What a shot does that is not shown by its best take, by the rule that take would break.
_KEEPS = {
    "line": "keeps the line",
    "direction": "keeps the screen direction",
    "eyeline": "keeps the eyeline",
    "jump": "avoids a jump cut",
    "size": "avoids a leap in size",
}


@dataclass(frozen=True)
class Trade:
    """A take that is shown for the sake of the sequence, in place of the best one of its shot.

    take: its place in the shot's ranking without the edit; score, best: its score, and the best one's
    keeps: the rules the best one would break
    """

    shot: str
    number: int
    take: int
    score: float
    best: float
    keeps: tuple[str, ...]

    @property
    def text(self) -> str:
        """``shot 4: take 3 instead of 1 (score 0.81 instead of 0.86) keeps the line``."""
        why = " and ".join(_KEEPS[rule] for rule in self.keeps)
        digits = 2 if f"{self.score:.2f}" != f"{self.best:.2f}" else 4
        scores = f"score {self.score:.{digits}f} instead of {self.best:.{digits}f}"
        return f"shot {self.number}: take {self.take} instead of 1 ({scores}) {why}"


@dataclass(frozen=True, eq=False)
class Build:
    """The whole film. judge: ``ranker`` or ``geometry``, by which the takes were put in order.

    continuity: what the cuts between the first takes break, in order; edited: whether the first takes were
    chosen for the sequence; trades: what was given up for it
    taste: digest of what a writer's choices taught the ranker, None where it ranked without
    made_with: versions that proposals and pictures go by, as (name, version)
    draft: whether some takes are stills alone, put in order by geometry, until their films are made
    waiting: how many shots have takes that are still to be filmed, and not shown yet
    grounds: the places of the storyboard's scenes from above, or none where no plans are wanted
    arrows: whether the contact sheet shows what moves
    """

    storyboard: Storyboard
    shots: tuple[BuiltShot, ...]
    judge: str = "ranker"
    continuity: tuple[CutFinding, ...] = ()
    edited: bool = False
    trades: tuple[Trade, ...] = ()
    made_with: tuple[tuple[str, str], ...] = ()
    draft: bool = False
    waiting: int = 0
    grounds: tuple[Ground, ...] = ()
    arrows: bool = True
    taste: str | None = None

    def into(self, shot: str) -> tuple[CutFinding, ...]:
        """What the cut into a shot breaks."""
        return tuple(c for c in self.continuity if c.shots[1] == shot)

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
    """What a run took. peak_mib: peak resident memory; device: what drew the pictures.

    options: what was asked for other than by default, as plain values
    """

    seconds: float
    stages: tuple[Stage, ...]
    cache_hits: int = 0
    cache_misses: int = 0
    peak_mib: float = 0.0
    device: str = "cpu"
    notes: tuple[str, ...] = field(default=())
    options: Mapping[str, Any] = field(default_factory=dict)
