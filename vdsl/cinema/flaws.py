"""What film grammar takes for a fault of a take: bounds of its measures, by what they are about.

Assumes measures as :mod:`vdsl.cinema.measures` has them.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from .vectors import clamped

Measures = Mapping[str, NDArray[np.float64] | float]

#: What is a fault: (criterion, measure, the least or the most of it that will do, and what of it could not be
#: worse). Those of what hides, leads and
#: cuts feet are wide: within them eyes do as well with as without (docs/ranker.md).
LEAST = (
    ("visibility", "visibility", 0.8, 0.3),
    ("visibility", "head_visible", 0.85, 0.0),
    ("visibility", "ends_visible", 0.8, 0.0),
    ("visibility", "face", -0.6, -1.0),
    ("framing", "in_frame", 0.95, 0.3),
    ("framing", "view", 0.8, 0.0),
    ("lead_room", "lead_room", -0.3, -0.6),
    ("clearance", "clearance", 0.2, 0.0),
)
MOST = (
    ("visibility", "foreground", 0.05, 0.5),
    ("visibility", "face_covered", 0.3, 1.0),
    ("visibility", "backdrop_gap", 0.1, 0.4),
    ("visibility", "walk_missed", 0.5, 1.0),
    ("visibility", "act_missed", 0.5, 1.0),
    ("framing", "head_cut", 0.03, 0.4),
    ("framing", "feet_cut", 0.15, 0.4),
    ("framing", "head_cropped", 0.6, 1.0),
    ("framing", "size_error", 0.1, 0.4),
    ("framing", "empty", 0.25, 0.9),
    ("framing", "company_cut", 0.5, 1.0),
    ("headroom", "headroom_error", 0.2, 0.5),
    ("thirds", "thirds_error", 0.2, 0.5),
    ("steadiness", "jerk", 8.0, 30.0),
    ("steadiness", "speed", 3.5, 6.0),
)
#: Measures of which no picture tells: how near the walls around the camera are, and whether size and view are
#: those that were asked for.
UNSEEN = ("clearance", "size_error", "view")
#: All bounds, fault by fault.
_BOUNDS = (*LEAST, *MOST)
_LIMIT, _WORST = (np.array([entry[k] for entry in _BOUNDS]) for k in (2, 3))
CRITERIA = ("visibility", "framing", "headroom", "lead_room", "thirds", "clearance", "steadiness")


def flaws(measures: Measures, seen: bool = False) -> dict[str, NDArray[np.bool_]]:
    """By criterion, which of the takes [P] have a fault in it. seen: only those that a picture can show"""
    found = flaws_by_measure(measures)
    out = {name: np.zeros(np.shape(measures["visibility"]), bool) for name in CRITERIA}
    for criterion, name, *_ in (*LEAST, *MOST):
        if not (seen and name in UNSEEN):
            out[criterion] = out[criterion] | found[name]
    return out


def flaws_by_measure(measures: Measures) -> dict[str, NDArray[np.bool_]]:
    """By the name of a measure, which of the takes [P] have a fault in it."""
    found = _found(_told(measures))
    return {name: found[k] for k, (_, name, *_) in enumerate(_BOUNDS)}


def gravity(measures: Measures) -> dict[str, NDArray[np.float64]]:
    """By criterion, how grave the fault of takes [P] in it is: 0 for none, 1 for one that is hardly one, and
    up to 2 for what could not be worse. Of several faults in a criterion the gravest counts."""
    told = _told(measures)
    far = clamped((told - _beside(_LIMIT, told)) / _beside(_WORST - _LIMIT, told), 0.0, 1.0)
    grave = np.where(_found(told), 1.0 + far, 0.0)
    return {name: grave[rows].max(axis=0) for name, rows in _OF.items()}


#: Rows of the bounds that belong to a criterion.
_OF = {name: [k for k, entry in enumerate(_BOUNDS) if entry[0] == name] for name in CRITERIA}


def _told(measures: Measures) -> NDArray[np.float64]:
    """What there are bounds of, [N, ...]."""
    return np.array([measures[name] for _, name, *_ in _BOUNDS], float)


def _found(told: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Which is a fault, [N, ...]."""
    limit, least = _beside(_LIMIT, told), len(LEAST)
    return np.concatenate([told[:least] < limit[:least], told[least:] > limit[least:]])


def _beside(bounds: NDArray[np.float64], told: NDArray[np.float64]) -> NDArray[np.float64]:
    return bounds.reshape(-1, *[1] * (told.ndim - 1))
