"""The virtual designer: which proposals somebody with an eye for framing would keep, by geometry alone.

It stands in for the people who picked the paper's positives. Assumes measured proposals
(:mod:`vdsl.cinema.measures`) and never sees a picture. Two steps, as with people: what has a fault is out;
what is left is put in order by how well it is composed, and of several that look alike only the first is
kept. A weak criterion is not made up for by strong ones: the order is by their weighted geometric mean,
other than :mod:`vdsl.cinema.score`, which is a sum.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from ..propose.types import CameraProposal
from .selection import alike, ranked

Array = NDArray[np.float64]
Measures = Mapping[str, NDArray[np.float64] | float]

#: What is a fault: (criterion, measure, the least or the most of it that will do).
LEAST = (
    ("visibility", "visibility", 0.95),
    ("visibility", "head_visible", 0.85),
    ("visibility", "ends_visible", 0.8),
    ("visibility", "face", -0.6),
    ("framing", "in_frame", 0.95),
    ("framing", "view", 0.8),
    ("lead_room", "lead_room", -0.12),
    ("clearance", "clearance", 0.3),
)
MOST = (
    ("visibility", "foreground", 0.05),
    ("visibility", "backdrop_gap", 0.03),
    ("framing", "head_cut", 0.03),
    ("framing", "feet_cut", 0.03),
    ("framing", "size_error", 0.1),
    ("framing", "empty", 0.25),
    ("headroom", "headroom_error", 0.14),
    ("thirds", "thirds_error", 0.2),
    ("steadiness", "jerk", 8.0),
    ("steadiness", "speed", 3.5),
)
#: Measures of which no picture tells: how near the walls around the camera are, and whether size and view are
#: those that were asked for.
UNSEEN = ("clearance", "size_error", "view")
#: How much each criterion counts in the order of what has no fault; variety comes from :func:`picks`.
COUNTS = {
    "visibility": 0.24,
    "framing": 0.18,
    "headroom": 0.14,
    "lead_room": 0.12,
    "thirds": 0.12,
    "clearance": 0.08,
    "steadiness": 0.12,
}
CRITERIA = tuple(COUNTS)
_LITTLE = 0.02  # the worst a criterion is taken for


def faults(measures: Measures, seen: bool = False) -> dict[str, NDArray[np.bool_]]:
    """By criterion, which of the takes [P] have a fault in it. seen: only those that a picture can show"""
    found = faults_by_measure(measures)
    out = {name: np.zeros(np.shape(measures["visibility"]), bool) for name in CRITERIA}
    for criterion, name, _ in (*LEAST, *MOST):
        if not (seen and name in UNSEEN):
            out[criterion] = out[criterion] | found[name]
    return out


def faults_by_measure(measures: Measures) -> dict[str, NDArray[np.bool_]]:
    """By the name of a measure, which of the takes [P] have a fault in it."""
    m = {k: np.asarray(v, float) for k, v in measures.items()}
    least = {name: m[name] < bound for _, name, bound in LEAST}
    return least | {name: m[name] > bound for _, name, bound in MOST}


def qualities(measures: Measures) -> dict[str, Array]:
    """By criterion, how good the takes [P] are in it, 0..1."""
    m = {k: np.asarray(v, float) for k, v in measures.items()}
    turned = np.clip((m["face"] + 0.75) / 1.4, 0.0, 1.0)  # from behind to three-quarter and frontal
    return {
        "visibility": m["visibility"] * m["head_visible"] * (0.25 + 0.5 * turned + 0.25 * m["interest"]),
        "framing": m["in_frame"] * _near(m["size_drift"], 0.9) * (1.0 - m["foreground"]) * (1.0 - m["empty"]),
        "headroom": _near(m["headroom_error"], 0.12),
        "lead_room": np.clip(0.75 + 1.5 * m["lead_room"], 0.0, 1.0),
        "thirds": _near(m["thirds_error"], 0.16),
        "clearance": np.clip(m["clearance"] / 0.7, 0.0, 1.0),
        "steadiness": _near(m["jerk"], 12.0) * _near(m["angular_speed"], 80.0) * _near(m["speed"], 3.0),
    }


def appeal(measures: Measures) -> Array:
    """How well takes [P] are composed and shot, 0..1; says nothing of their faults."""
    found = qualities(measures)
    logs = sum(COUNTS[k] * np.log(np.maximum(found[k], _LITTLE)) for k in CRITERIA)
    return np.asarray(np.exp(logs))


def judged(cameras: Sequence[CameraProposal]) -> Array:
    """The designer's opinion of proposals [P]: their appeal, and less than 0 for what has a fault."""
    if not cameras:
        return np.zeros(0)
    measures = {k: np.array([c.measures[k] for c in cameras], float) for k in cameras[0].measures}
    wrong = np.sum(list(faults(measures).values()), axis=0)
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
