"""One number for how well a take is composed and shot, from its measures alone."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

#: What counts, and how much; the weights sum to one. Weighed, as the penalties are, so that of the takes of
#: a line it prefers those that eyes did (docs/ranker.md): where in the frame a head is tells them next to
#: nothing.
WEIGHTS = {
    "legible": 0.38,
    "heads": 0.14,
    "apart": 0.14,
    "in_frame": 0.13,
    "hands": 0.12,
    "visibility": 0.07,
    "headroom": 0.01,
    "steadiness": 0.01,
}

#: Measures of what spoils a picture, and the share of the score each takes away where it is 1.
PENALTIES = {
    "foreground": 0.9,
    "backdrop_gap": 0.6,
    "face_covered": 0.4,
    "floor_gap": 0.3,
    "company_cut": 0.25,
    "empty": 0.15,
}

#: How much a full point of the geometry score moves the odds of a take, in logits: as a prior. By this much
#: the order is nearer to that of eyes than by the pictures or the geometry alone (docs/ranker.md).
PRIOR = 150.0
#: And by how much a fault in a criterion lowers it, times its gravity (:func:`vdsl.cinema.flaws.gravity`).
#: The discriminator knows of faults by itself.
FLAW = 3.0


def parts(measures: Mapping[str, NDArray[np.float64] | float]) -> dict[str, NDArray[np.float64]]:
    """Every part of the score in 0..1, best 1 (see docs/cinema.md)."""
    m = {k: np.asarray(v, float) for k, v in measures.items()}
    calm = np.exp(-((m["angular_speed"] / 70.0) ** 2)) * np.exp(-((m["speed"] / 3.0) ** 2))
    return {
        "legible": m["legible"],
        "heads": m["heads"],
        "apart": 1.0 - m["together"],
        "in_frame": m["in_frame"],
        "hands": m["hands_shown"],
        "visibility": m["visibility"] * (0.5 + 0.5 * m["head_visible"]),
        "headroom": np.exp(-((m["headroom_error"] / 0.12) ** 2)),
        "steadiness": calm * np.exp(-m["jerk"] / 60.0),
    }


def geometry_scores(measures: Mapping[str, NDArray[np.float64] | float]) -> NDArray[np.float64]:
    """Scores 0..1 of takes whose measures are arrays [P]."""
    total = sum(WEIGHTS[name] * value for name, value in parts(measures).items())
    for name, share in PENALTIES.items():
        total = total * (1.0 - share * np.asarray(measures[name], float))
    return np.asarray(total)


def geometry_score(measures: Mapping[str, float]) -> float:
    """Score 0..1 of one take, what ``--rank geometry`` orders by."""
    return float(geometry_scores(measures))
