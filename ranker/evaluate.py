"""How good a ranker is on clips it never saw: separation, by strength and kind, classes, hidden picks."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray

from .data import Dataset, scaled
from .guided import Guided
from .infer import Ranker, Scores
from .model import ShotRanker, frame_times, normalised
from .motion import motion

#: Upper ends of the strengths that negatives are reported by.
STRENGTHS = (0.25, 0.5, 0.75, 1.0)
#: The kind of negatives that are not spoilt takes, as the paper's are, but others to choose from that were
#: not chosen. They are counted apart.
PASSED_OVER = "passed-over"
_AT_ONCE = 32
Floats = NDArray[np.floating]


def evaluate(
    model: ShotRanker | Ranker, data: Dataset, clips: NDArray[np.int64], guided: bool = True
) -> dict[str, Any]:
    """Measure on the given clips, at the full picture size, as :class:`Ranker` scores them.

    guided: with the guides of those clips that have some, else all by pictures alone
    By p_b ``auc`` and ``auc_by_strength {upper end: auc}`` against what was spoilt, ``auc_all`` against all
    negatives, ``auc_by_kind`` of those that say their kind,
    ``accuracy {movement, scale, angle, professional}`` (classes over positives), ``clips``; a value is None
    where there is nothing to measure it on. Doubtful clips count for none but ``clips``.
    """
    ranker = model if isinstance(model, Ranker) else Ranker(_copy(model))
    classes, label = data.classes[clips], data.professional[clips] > 0.5
    logit, right = np.zeros(len(clips)), np.full((len(clips), 3), np.nan)
    told = data.guided[clips] & guided
    for group in (np.flatnonzero(told), np.flatnonzero(~told)):
        for begin in range(0, len(group), _AT_ONCE):
            rows = group[begin : begin + _AT_ONCE]
            guides = data.guides(clips[rows]) if told[rows[0]] else None
            scores = ranker.score(_frames(ranker, data, clips[rows]), guides)
            logit[rows] = scores.logit
            right[rows] = _right(scores, classes[rows])
    sure = ~data.doubtful[clips]
    strength = np.array([data.labels[i].strength for i in clips])
    kind = np.array([str(data.labels[i].about.get("kind", "")) for i in clips], object)
    by_strength, low = {}, -np.inf
    spoilt = sure & (kind != PASSED_OVER)
    for high in STRENGTHS:
        chosen = spoilt & (label | ((strength > low) & (strength <= high)))
        by_strength[f"{high:g}"] = auc(logit[chosen], label[chosen])
        low = high
    among = {k: sure & (label | (kind == k)) for k in sorted(set(kind[~label]) - {""})}
    return {
        "clips": len(clips),
        "auc": auc(logit[spoilt], label[spoilt]),
        "auc_all": auc(logit[sure], label[sure]),
        "auc_by_strength": by_strength,
        "auc_by_kind": {k: auc(logit[of], label[of]) for k, of in among.items()},
        "accuracy": {
            **{k: mean(right[label, i]) for i, k in enumerate(("movement", "scale", "angle"))},
            "professional": mean(((logit > 0) == label)[sure].astype(float)),
        },
    }


def agreement_with_fp32(
    model: ShotRanker, ranker: Ranker, data: Dataset, clips: NDArray[np.int64], guided: bool = True
) -> float | None:
    """Spearman's correlation between the margins of a ranker and of its model in float32; None below 2 clips.

    model: with the same weights, on any device; guided: as in :func:`evaluate`
    """
    if len(clips) < 2:
        return None
    device = next(model.parameters()).device
    times = frame_times(model.config).to(device)[None]
    exact, quick = [], []
    model.eval()
    for clip in clips:
        frames = _frames(ranker, data, np.array([clip]))
        told = bool(guided and model.config.guides and data.guided[clip])
        guides = data.guides(np.array([clip])) if told else None
        quick.append(float(ranker.score(frames, guides).margin[0]))
        with torch.inference_mode():
            moved = None
            if model.config.motion and guides is None:
                moved = motion(torch.from_numpy(frames).to(device))
            by = None if guides is None else Guided.of(guides, times[0])
            pictures = torch.from_numpy(scaled(frames[0], model.config.inner)[None]).to(device)
            out = model(normalised(pictures), times, moved, by)
            exact.append(float(model.margin(out)[0]))
    return spearman(np.array(exact), np.array(quick))


def auc(scores: Floats, positive: NDArray[np.bool_]) -> float | None:
    """Chance that a positive scores above a negative, ties half; None without one of either."""
    ups, downs = int(positive.sum()), int((~positive).sum())
    if not ups or not downs:
        return None
    return float((places(scores)[positive].sum() - ups * (ups + 1) / 2) / (ups * downs))


def spearman(one: Floats, two: Floats) -> float | None:
    """The correlation of two orders [N]; None where one of them is no order."""
    a, b = places(one), places(two)
    if len(a) < 2 or np.ptp(a) == 0 or np.ptp(b) == 0:
        return None
    return float(np.corrcoef(a, b)[0, 1])


def places(scores: Floats) -> NDArray[np.float64]:
    """Places 1..N by rising score, ties in their middle."""
    _, place, counts = np.unique(scores, return_inverse=True, return_counts=True)
    return np.asarray((np.cumsum(counts) - (counts - 1) / 2)[place], np.float64)


def hidden(scores: Floats, picked: NDArray[np.bool_]) -> dict[str, float | None]:
    """How high picks come among all proposals [P]: share in the top tenth, and their median place, per cent.

    Of equals the pick counts as the lowest: a ranker that gives all the same finds nobody.
    """
    if not picked.any():
        return {"picks_in_top_10pct": None, "picks_median_rank_pct": None}
    order = np.sort(np.asarray(scores, float))
    above = len(order) - np.searchsorted(order, np.asarray(scores, float)[picked], side="left")
    share = above / len(order)
    return {
        "picks_in_top_10pct": float((share <= 0.1).mean()),
        "picks_median_rank_pct": float(100 * np.median(share)),
    }


def agreement(
    by: Mapping[str, Floats], picked: NDArray[np.bool_], shot: Sequence[str]
) -> dict[str, dict[str, float]]:
    """How often the pick of a shot is first, and among the first five, of its proposals by several scores.

    by: {name: [P]}; picked: [P], one of each shot; shot: [P]. ``chance`` is what guessing gives; a pick among
    equals counts with the chance it has.
    """
    names = np.asarray(shot, object)
    groups = [np.flatnonzero(names == s) for s in dict.fromkeys(shot)]
    groups = [g for g in groups if picked[g].sum() == 1]
    if not groups:
        return {}
    out = {"chance": {f"top_{n}": float(np.mean([min(n / len(g), 1) for g in groups])) for n in (1, 5)}}
    for name, scores in by.items():
        found: dict[int, list[float]] = {1: [], 5: []}
        for g in groups:
            mine = np.asarray(scores, float)[g]
            own = mine[picked[g]][0]
            better, same = int((mine > own).sum()), int((mine == own).sum())
            for n, hits in found.items():
                hits.append(float(np.clip((n - better) / same, 0.0, 1.0)))
        out[name] = {f"top_{n}": float(np.mean(hits)) for n, hits in found.items()}
    return out


def mean(values: Floats) -> float | None:
    """The mean of what is known, None where nothing is."""
    known = values[np.isfinite(values)]
    return float(known.mean()) if len(known) else None


def _right(scores: Scores, classes: NDArray[np.int64]) -> NDArray[np.float64]:
    """Whether the likeliest classes are the true ones [B, 3], NaN where these are not known."""
    found = np.stack([p.argmax(1) for p in (scores.movement, scores.scale, scores.angle)], axis=1)
    return np.where(classes >= 0, (found == classes).astype(float), np.nan)


def _frames(ranker: Ranker, data: Dataset, clips: NDArray[np.int64]) -> NDArray[np.uint8]:
    count, size = ranker.config.frames, ranker.config.size
    return np.stack([data.clip(int(i), range(count), size) for i in clips])


def _copy(model: ShotRanker) -> ShotRanker:
    with torch.no_grad():
        copy = ShotRanker(model.config)
        copy.load_state_dict(model.state_dict())
    return copy
