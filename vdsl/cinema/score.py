"""One number for how well a take is composed and shot, from its measures alone."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

#: What counts, and how much; the weights sum to one.
WEIGHTS = {
    "visibility": 0.16,
    "in_frame": 0.12,
    "face": 0.28,
    "interest": 0.17,
    "size": 0.06,
    "headroom": 0.04,
    "lead_room": 0.03,
    "thirds": 0.06,
    "clearance": 0.03,
    "steadiness": 0.05,
}

#: Measures of what spoils a picture, and the share of the score each takes away where it is 1.
PENALTIES = {
    "backdrop_gap": 0.5,
    "floor_gap": 0.3,
    "foreground": 0.6,
    "face_covered": 0.4,
    "empty": 0.6,
    "walk_missed": 0.4,
    "act_missed": 0.4,
    "head_cropped": 0.2,
    "hands_missed": 0.15,
    "gesture_lost": 0.1,
    "company_cut": 0.25,
}

#: How much a full point of the geometry score moves the odds of a take, in logits: as a prior. By this much
#: designer's picks that are hidden among proposals come higher than by the pictures or the geometry alone.
PRIOR = 30.0
#: And by how much a fault in a criterion lowers it, times its gravity (:func:`vdsl.cinema.flaws.gravity`):
#: what is plainly amiss is not made up for by what else is good.
FLAW = 14.0


def parts(measures: Mapping[str, NDArray[np.float64] | float]) -> dict[str, NDArray[np.float64]]:
    """Every part of the score in 0..1, best 1 (see docs/cinema.md)."""
    m = {k: np.asarray(v, float) for k, v in measures.items()}
    calm = np.exp(-((m["angular_speed"] / 70.0) ** 2)) * np.exp(-((m["speed"] / 3.0) ** 2))
    # three-quarter to frontal is best; from straight behind is worst
    face = np.clip((m["face"] + 0.75) / 1.45, 0.0, 1.0)
    return {
        "visibility": m["visibility"] * (0.5 + 0.5 * m["head_visible"]),
        "in_frame": m["in_frame"],
        # the back of a head is not made up for by whom it looks at
        "interest": m["interest"] * np.minimum(1.5 * face, 1.0),
        "face": face,
        "size": np.exp(-((m["size_drift"] / 0.7) ** 2)),
        "headroom": np.exp(-((m["headroom_error"] / 0.12) ** 2)),
        "lead_room": np.clip(0.7 + 1.5 * m["lead_room"], 0.0, 1.0),
        "thirds": np.exp(-((m["thirds_error"] / 0.2) ** 2)),
        "clearance": np.clip(m["clearance"] / 0.8, 0.0, 1.0),
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
