"""Tastes as nobody learnt them."""

from __future__ import annotations

import numpy as np

from ranker.taste import Taste
from vdsl.cinema.traits import TRAITS


def some_taste(**likes: float) -> Taste:
    """Of traits by their names, log odds a step."""
    return Taste(np.array([likes.get(name, 0.0) for name in TRAITS]), np.zeros(len(TRAITS)), tuple(TRAITS), 1)
