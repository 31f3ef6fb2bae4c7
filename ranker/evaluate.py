"""How good a ranker is on clips it never saw: separation, by strength, and the class heads."""

from __future__ import annotations

from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray

from .data import Dataset
from .infer import Ranker
from .model import ShotRanker

#: Upper ends of the strengths that negatives are reported by.
STRENGTHS = (0.25, 0.5, 0.75, 1.0)


def evaluate(model: ShotRanker | Ranker, data: Dataset, clips: NDArray[np.int64]) -> dict[str, Any]:
    """Measure on the given clips, at the full picture size, as :class:`Ranker` scores them.

    ``auc``, ``auc_by_strength {upper end: auc}``, ``accuracy {movement, scale, angle, professional}``
    (classes over positives), ``clips``; a value is None where there is nothing to measure it on
    """
    ranker = model if isinstance(model, Ranker) else Ranker(_copy(model))
    config = ranker.config
    margins, correct = [], []
    classes, label = data.classes[clips], data.professional[clips] > 0.5
    for index, truth in zip(clips, classes, strict=True):
        scores = ranker.score(data.clip(int(index), range(config.frames), config.size)[None])
        margins.append(float(scores.margin[0]))
        found = [int(p[0].argmax()) for p in (scores.movement, scores.scale, scores.angle)]
        correct.append([float(f == t) if t >= 0 else np.nan for f, t in zip(found, truth, strict=True)])
    margin, right = np.array(margins), np.array(correct).reshape(-1, 3)
    strength = np.array([data.labels[i].strength for i in clips])
    by_strength, low = {}, -np.inf
    for high in STRENGTHS:
        chosen = label | (~label & (strength > low) & (strength <= high))
        by_strength[f"{high:g}"] = auc(margin[chosen], label[chosen])
        low = high
    return {
        "clips": len(clips),
        "auc": auc(margin, label),
        "auc_by_strength": by_strength,
        "accuracy": {
            **{k: _mean(right[label, i]) for i, k in enumerate(("movement", "scale", "angle"))},
            "professional": _mean(((margin > 0) == label).astype(float)),
        },
    }


def auc(scores: NDArray[np.floating], positive: NDArray[np.bool_]) -> float | None:
    """Chance that a positive scores above a negative, ties half; None without one of either."""
    ups, downs = int(positive.sum()), int((~positive).sum())
    if not ups or not downs:
        return None
    _, place, counts = np.unique(scores, return_inverse=True, return_counts=True)
    ranks = (np.cumsum(counts) - (counts - 1) / 2)[place]
    return float((ranks[positive].sum() - ups * (ups + 1) / 2) / (ups * downs))


def _mean(values: NDArray[np.floating]) -> float | None:
    known = values[np.isfinite(values)]
    return float(known.mean()) if len(known) else None


def _copy(model: ShotRanker) -> ShotRanker:
    with torch.no_grad():
        copy = ShotRanker(model.config)
        copy.load_state_dict(model.state_dict())
    return copy
