"""The virtual designer: which proposals somebody with an eye for framing would keep, by geometry alone.

It stands in for the people who picked the paper's positives. Assumes measured proposals
(:mod:`vdsl.cinema.measures`), by lines of sight or, once they are drawn, by what hides what in their pictures
(:mod:`vdsl.pipeline.drawn`); colours it never sees. Two steps, as with people: what has a fault is out;
what is left is put in order by how well it is composed, and of several that look alike only the first is
kept. A weak criterion is not made up for by strong ones: the order is by their weighted geometric mean,
other than :mod:`vdsl.cinema.score`, which is a sum.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..cinema.flaws import Measures, gravity
from ..cinema.score import parts
from ..propose.types import CameraProposal
from .selection import alike, ranked

Array = NDArray[np.float64]

#: How much each criterion counts in the order of what has no fault; variety comes from :func:`picks`.
#: Weighed, as all below, so that of the takes of a line it prefers those that eyes did (docs/ranker.md): who
#: is read in the picture tells far more than by how little a head is off its line.
COUNTS = {
    "visibility": 0.54,
    "framing": 0.41,
    "headroom": 0.01,
    "lead_room": 0.01,
    "thirds": 0.01,
    "clearance": 0.01,
    "steadiness": 0.01,
}
#: What visibility is made of: parts of the geometry score (:func:`vdsl.cinema.score.parts`); sums to one.
SEEN = {"legible": 0.4, "heads": 0.22, "apart": 0.16, "hands": 0.12, "visibility": 0.1}
_COVERED = 0.45  # of it, what a face that is covered takes away
#: What of the framing is that the subject is in it all the time; and what each of these takes away where it
#: is 1. A size that is off, as where a room is too small for it, reads as one between two.
_IN_FRAME = 0.3
SPOILS = {
    "size_error": 1.5,
    "foreground": 0.95,
    "backdrop_gap": 0.6,
    "company_cut": 0.33,
    "floor_gap": 0.3,
    "empty": 0.15,
}
_LITTLE = 0.02  # the worst a criterion is taken for


def qualities(measures: Measures) -> dict[str, Array]:
    """By criterion, how good the takes [P] are in it, 0..1."""
    m = {k: np.asarray(v, float) for k, v in measures.items()}
    found = parts(measures)
    seen = np.asarray(sum(share * found[name] for name, share in SEEN.items()))
    framing = 1.0 - _IN_FRAME + _IN_FRAME * m["in_frame"]
    for name, share in SPOILS.items():
        framing = framing * np.maximum(1.0 - share * m[name], 0.0)
    return {
        "visibility": seen * (1.0 - _COVERED * m["face_covered"]),
        "framing": framing,
        "headroom": _near(m["headroom_error"], 0.12),
        "lead_room": np.clip(0.75 + 1.5 * m["lead_room"], 0.0, 1.0),
        "thirds": _near(m["thirds_error"], 0.16),
        "clearance": np.clip(m["clearance"] / 0.7, 0.0, 1.0),
        "steadiness": _near(m["jerk"], 12.0) * _near(m["angular_speed"], 80.0) * _near(m["speed"], 3.0),
    }


def appeal(measures: Measures) -> Array:
    """How well takes [P] are composed and shot, 0..1; says nothing of their faults."""
    found = qualities(measures)
    logs = sum(COUNTS[k] * np.log(np.maximum(found[k], _LITTLE)) for k in COUNTS)
    return np.asarray(np.exp(logs))


def judged(cameras: Sequence[CameraProposal]) -> Array:
    """The designer's opinion of proposals [P]: their appeal, and less than 0 for what has a fault, the less
    the graver it is."""
    if not cameras:
        return np.zeros(0)
    measures = {k: np.array([c.measures[k] for c in cameras], float) for k in cameras[0].measures}
    wrong = np.sum(list(gravity(measures).values()), axis=0)
    return np.asarray(np.where(wrong > 0, appeal(measures) - 1.0 - wrong, appeal(measures)))


def picks(cameras: Sequence[CameraProposal], most: int) -> list[int]:
    """Indices of up to ``most`` proposals the designer keeps, best first; no two look alike."""
    opinion = judged(cameras)
    kept: list[int] = []
    for i in ranked(opinion):
        if len(kept) == most or opinion[i] < 0:
            break
        if not any(alike(cameras[i], cameras[j]) for j in kept):
            kept.append(i)
    return kept


def _near(error: Array, width: float) -> Array:
    return np.asarray(np.exp(-((error / width) ** 2)))
