"""The losses: L = L_b + L_c + L_q of the paper's section 3.3, L_h, of what is known in numbers,
and L_o, of what is liked better."""

from __future__ import annotations

import math

import torch
from torch import Tensor
from torch.nn import functional

#: Bounds of L_o, deviations from the mean of good shots: a good one in six is above the fourth, one in thirty
#: above the last.
STEPS = (-1.0, -0.3, 0.3, 1.0, 1.6)
#: Log odds that a good shot is above each, were they liked as normal deviations are spread.
STEP_ODDS = tuple(-math.log(2 / math.erfc(step / math.sqrt(2)) - 1) for step in STEPS)
_STRAIGHT = 0.3  # deviations: small ones count too, since takes of a shot differ by little


def binary_loss(logit: Tensor, label: Tensor, smoothing: float = 0.0) -> Tensor:
    """L_b = −[y log p_b + (1 − y) log(1 − p_b)], the mean over [B] (as printed it has a sign slip).

    label: 1 for professional, 0 for not, [B], NaN for what is not known; smoothing pulls both towards a half
    """
    known = label.isfinite()
    if not known.any():
        return logit.new_zeros(())
    target = label[known].float() * (1 - smoothing) + smoothing / 2
    return functional.binary_cross_entropy_with_logits(logit[known], target)


def class_loss(logits: tuple[Tensor, ...], labels: tuple[Tensor, ...], smoothing: float = 0.0) -> Tensor:
    """L_c = −Σ_c y_c log p_c, summed over movement, scale and angle, each the mean over its known labels.

    logits: [B, classes] each; labels: int64 [B] each, −1 where the class of a shot is not known
    """
    total = logits[0].new_zeros(())
    for scores, label in zip(logits, labels, strict=True):
        known = label >= 0
        if known.any():
            total = total + functional.cross_entropy(scores[known], label[known], label_smoothing=smoothing)
    return total


def liking_loss(told: Tensor, liked: Tensor) -> Tensor:
    """L_o: whether shots are liked better than each of :data:`STEPS`, told [B, steps] as log odds.

    Ordinal regression by one binary problem a step (Frank and Hall 2001): which shot is the better one is
    asked of good and bad ones alike, and most sharply among the best.
    liked: [B], how well, in deviations from the mean of good ones, less than all steps for bad ones; NaN is
    not known, and with nothing known it is 0
    """
    known = liked.isfinite()
    if not known.any():
        return told.new_zeros(())
    above = (liked[known, None] > told.new_tensor(STEPS)).float()
    return functional.binary_cross_entropy_with_logits(told[known], above)


def contrast_loss(
    query: Tensor,
    key: Tensor,
    others: Tensor,
    temperature: float,
    same: Tensor | None = None,
) -> Tensor:
    """L_q = −log(exp(z_q·z_+ /τ) / Σ_k exp(z_q·z_k /τ)), the mean over the batch.

    query, key: unit vectors [B, C] of two sets of frames of the same shots; others: the dictionary's
    [K, C]; the sum runs over the shot's own key and the dictionary, as in MoCo
    same: bool [B, K], entries of the dictionary that are the query's own shot: left out of the sum
    """
    positive = (query * key).sum(1, keepdim=True)
    negative = query @ others.T
    if same is not None:
        negative = negative.masked_fill(same, float("-inf"))
    scores = torch.cat([positive, negative], 1) / temperature
    return functional.cross_entropy(scores, torch.zeros(len(query), dtype=torch.long, device=query.device))


def hint_loss(told: Tensor, hints: Tensor) -> Tensor:
    """L_h: how far what is told of shots is from what is known of them, [B, K] both.

    Smooth L1 (Girshick 2015) in deviations; NaN is not known, and with nothing known it is 0
    """
    return _apart(told, hints)


def fault_loss(told: Tensor, known: Tensor) -> Tensor:
    """The part of L_h that is of faults: cross-entropy of log odds told [B, K] of having each against whether
    a shot has it, the mean over what is known; NaN is not known, and with nothing known it is 0."""
    sure = known.isfinite()
    if not sure.any():
        return told.new_zeros(())
    return functional.binary_cross_entropy_with_logits(told[sure], known[sure])


def measures_loss(
    told: Tensor, hints: Tensor, faults: slice, goods: slice, fault_weight: float, good_weight: float
) -> Tensor:
    """The part of L_h that is of whole shots, told and hints [B, K] both: faults by whether there are such,
    weighed by ``fault_weight``; all else by how far off it is, and how good a shot is by each criterion once
    more, weighed by ``good_weight``."""
    plain = torch.ones(told.shape[1], dtype=torch.bool, device=told.device)
    plain[faults] = False
    loss = hint_loss(told[:, plain], hints[:, plain])
    loss = loss + good_weight * hint_loss(told[:, goods], hints[:, goods])
    return loss + fault_weight * fault_loss(told[:, faults], hints[:, faults])


def _apart(told: Tensor, known: Tensor) -> Tensor:
    """Smooth L1, straight from ``_STRAIGHT`` on, the mean over what is not NaN."""
    sure = known.isfinite()
    if not sure.any():
        return told.new_zeros(())
    return functional.smooth_l1_loss(told[sure], known[sure], beta=_STRAIGHT)
