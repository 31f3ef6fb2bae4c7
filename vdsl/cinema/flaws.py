"""What film grammar takes for a fault of a take: bounds of its measures, by what they are about.

Assumes measures as :mod:`vdsl.cinema.measures` has them.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

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
    ("visibility", "face_covered", 0.3),
    ("visibility", "backdrop_gap", 0.03),
    ("visibility", "walk_missed", 0.5),
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
CRITERIA = ("visibility", "framing", "headroom", "lead_room", "thirds", "clearance", "steadiness")


def flaws(measures: Measures, seen: bool = False) -> dict[str, NDArray[np.bool_]]:
    """By criterion, which of the takes [P] have a fault in it. seen: only those that a picture can show"""
    found = flaws_by_measure(measures)
    out = {name: np.zeros(np.shape(measures["visibility"]), bool) for name in CRITERIA}
    for criterion, name, _ in (*LEAST, *MOST):
        if not (seen and name in UNSEEN):
            out[criterion] = out[criterion] | found[name]
    return out


def flaws_by_measure(measures: Measures) -> dict[str, NDArray[np.bool_]]:
    """By the name of a measure, which of the takes [P] have a fault in it."""
    m = {k: np.asarray(v, float) for k, v in measures.items()}
    least = {name: m[name] < bound for _, name, bound in LEAST}
    return least | {name: m[name] > bound for _, name, bound in MOST}
