"""Who puts the proposals of a shot in order."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ..cinema.score import geometry_score
from ..propose.types import CameraProposal


class Judge(Protocol):
    """Scores proposals; higher is better.

    name: as the build's documents call it; looks: whether it needs to see frames
    """

    name: str
    looks: bool

    def scores(
        self, cameras: tuple[CameraProposal, ...], frames: NDArray[np.uint8] | None
    ) -> NDArray[np.float64]:
        """Scores [P] of P proposals; frames are uint8 [P, 8, 224, 224, 3] where the judge looks."""
        ...

    def logit(self, camera: CameraProposal, score: float) -> float | None:
        """What the pictures alone added to a score given before, in log odds; None where none were seen."""
        ...


class GeometryJudge:
    """Measured geometry alone (``--rank geometry``): nothing is drawn to choose."""

    name = "geometry"
    looks = False

    def scores(
        self, cameras: tuple[CameraProposal, ...], frames: NDArray[np.uint8] | None
    ) -> NDArray[np.float64]:
        return np.array([geometry_score(c.measures) for c in cameras])

    def logit(self, camera: CameraProposal, score: float) -> float | None:
        return None


#: How much a full point of the geometry score moves the odds of a take, in logits: as a prior, it breaks
#: what the pictures leave nearly even. About the spread of the discriminator's own logits over a shot.
PRIOR = 10.0
_PRIOR_MIDDLE = 0.75


def prior(measures: Mapping[str, float]) -> float:
    """What the geometry adds to the discriminator's log odds."""
    return PRIOR * (geometry_score(measures) - _PRIOR_MIDDLE)


class DiscriminatorJudge:
    """The shot ranking discriminator (p_b of the paper's section 3.3), with measured geometry as prior.

    The score is the probability whose log odds are the discriminator's plus :func:`prior`.
    Raises :class:`ranker.RankerError` if the weights are missing or unreadable.
    """

    name = "ranker"
    looks = True

    def __init__(self, weights: Path | None, device: str) -> None:
        # Only now: a geometry run must not pay for torch.
        from ranker.infer import Ranker

        self._ranker = Ranker.load(weights, device="cuda" if device == "cuda" else "cpu")

    def scores(
        self, cameras: tuple[CameraProposal, ...], frames: NDArray[np.uint8] | None
    ) -> NDArray[np.float64]:
        if frames is None:
            raise ValueError("the discriminator judges by frames")
        # From the logit: p_b itself runs out of digits near 1.
        logit = self._ranker.score(frames).margin.astype(np.float64)
        priors = np.array([prior(c.measures) for c in cameras])
        return np.asarray(1.0 / (1.0 + np.exp(-(logit + priors))))

    def logit(self, camera: CameraProposal, score: float) -> float | None:
        score = min(max(score, 1e-15), 1.0 - 1e-15)
        return math.log(score / (1.0 - score)) - prior(camera.measures)
