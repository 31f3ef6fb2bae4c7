"""Who puts the proposals of a shot in order."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from ..cinema.flaws import gravity
from ..cinema.score import FLAW, PRIOR, geometry_score
from ..cinema.traits import TRAITS, traits_of
from ..propose.types import CameraProposal
from .filming import JUDGE_SIZE, SEGMENTS, Seen

if TYPE_CHECKING:
    from ranker.infer import Scores


class Glance(NamedTuple):
    """What a judge wants to see of all proposals, to tell which deserve a full look.

    frames: which of the eight; pictures: whether shaded, or guides alone; share: of the proposals, those that
    get a full look, and least: how many do at least
    """

    frames: tuple[int, ...]
    pictures: bool
    share: float
    least: int


#: The pictures of two frames, for judges that have to see pictures.
BY_PICTURES = Glance((1, 6), True, 0.25, 16)
#: Guides of all frames. They are drawn in a fraction of the time, and put proposals nearer to the order of
#: full looks (Spearman 0.995, against 0.977 by the pictures of two frames).
BY_GUIDES = Glance(tuple(range(SEGMENTS)), False, 0.15, 12)


@dataclass(frozen=True)
class Opinion:
    """logit: what the pictures alone say of a take, in log odds, None where none were seen; taste: what a
    writer's taste adds"""

    logit: float | None
    taste: float


class Judge(Protocol):
    """Scores proposals; higher is better.

    name: as the build's documents call it; looks: whether it needs to see frames
    """

    name: str
    looks: bool

    @property
    def glances(self) -> Glance:
        """What it wants to see of all proposals first."""
        ...

    def scores(self, cameras: tuple[CameraProposal, ...], seen: Seen | None) -> NDArray[np.float64]:
        """Scores [P] of P proposals; their eight frames of 224 × 224 where the judge looks."""
        ...

    def glance(self, cameras: tuple[CameraProposal, ...], seen: Seen) -> NDArray[np.float64]:
        """Scores [P] by what ``glances`` asks for."""
        ...

    def opinion(self, camera: CameraProposal, score: float) -> Opinion:
        """What a score given before is made of, besides the prior."""
        ...


class GeometryJudge:
    """Measured geometry alone (``--rank geometry``): nothing is drawn to choose."""

    name = "geometry"
    looks = False
    glances = BY_PICTURES

    def scores(self, cameras: tuple[CameraProposal, ...], seen: Seen | None) -> NDArray[np.float64]:
        return np.array([geometry_score(c.measures) for c in cameras])

    def glance(self, cameras: tuple[CameraProposal, ...], seen: Seen) -> NDArray[np.float64]:
        return self.scores(cameras, None)

    def opinion(self, camera: CameraProposal, score: float) -> Opinion:
        return Opinion(None, 0.0)


_PRIOR_MIDDLE = 0.75
#: What log odds are divided by before they become a score (the temperature of a softmax): those of a line lie
#: dozens apart, and as they are nearly all scores would read 0.00 or 1.00.
_TEMPERATURE = 15.0


def log_odds(score: float) -> float:
    """What puts takes in order, of a discriminator's score: its margin, the prior and what a taste adds."""
    score = min(max(score, 1e-300), 1.0 - 1e-15)
    return _TEMPERATURE * math.log(score / (1.0 - score))


def prior(measures: Mapping[str, float]) -> float:
    """What the geometry adds to the discriminator's log odds, and its faults take off."""
    wrong = sum(float(found) for found in gravity(measures).values())
    return PRIOR * (geometry_score(measures) - _PRIOR_MIDDLE) - FLAW * wrong


class DiscriminatorJudge:
    """The shot ranking discriminator (p_b of the paper's section 3.3), with measured geometry as prior.

    The score is the probability whose log odds are the discriminator's plus :func:`prior`, tempered. taste:
    a file of what a writer's choices taught, which counts with the discriminator's.
    Raises :class:`ranker.RankerError` if the weights or the taste are missing or unreadable.
    """

    name = "ranker"
    looks = True

    def __init__(self, weights: Path | None, device: str, taste: Path | None = None) -> None:
        # Only now: a geometry run must not pay for torch.
        from ranker.infer import Ranker
        from ranker.taste import load_taste

        self._ranker = Ranker.load(weights, device="cuda" if device == "cuda" else "cpu")
        self._ranker.fits(SEGMENTS, JUDGE_SIZE[0])
        self._taste = load_taste(taste, tuple(TRAITS)) if taste is not None else None

    def scores(self, cameras: tuple[CameraProposal, ...], seen: Seen | None) -> NDArray[np.float64]:
        if seen is None:
            raise ValueError("the discriminator judges by frames")
        return self._scored(cameras, self._ranker.score(seen.frames, seen.guides))

    @property
    def glances(self) -> Glance:
        """By guides where the weights were taught by such alone."""
        return BY_GUIDES if self._ranker.judges_guides else BY_PICTURES

    def glance(self, cameras: tuple[CameraProposal, ...], seen: Seen) -> NDArray[np.float64]:
        if self.glances.pictures:
            return self._scored(cameras, self._ranker.glance(seen.frames, self.glances.frames, seen.guides))
        if seen.guides is None:
            raise ValueError("a glance by guides needs some")
        return self._scored(cameras, self._ranker.by_guides(seen.guides))

    def _scored(self, cameras: tuple[CameraProposal, ...], seen: Scores) -> NDArray[np.float64]:
        """From the logit: p_b itself runs out of digits near 1."""
        logit = seen.margin.astype(np.float64)
        added = np.array([prior(c.measures) + self._liked(c) for c in cameras])
        return np.asarray(1.0 / (1.0 + np.exp(-(logit + added) / _TEMPERATURE)))

    def opinion(self, camera: CameraProposal, score: float) -> Opinion:
        liked = self._liked(camera)
        return Opinion(log_odds(score) - prior(camera.measures) - liked, liked)

    def _liked(self, camera: CameraProposal) -> float:
        if self._taste is None:
            return 0.0
        traits = traits_of(camera.measures, camera.movement, camera.scale, camera.track.focal)
        return float(self._taste.adds(traits[None])[0])
