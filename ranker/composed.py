"""Composition from guides: what film grammar looks at in a frame, and how it goes over a shot.

Nothing here is learnt. Assumes marks and nearness as :mod:`ranker.guides` has them. Guarantees numbers of
about the size of 1 that are known for any marks.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

import torch
from torch import Tensor

from .guides import FARTHEST, NEAREST, POINTS, SIDE, SUBJECT_MARKS

_SHARP = 40.0  # how fast a point goes from in the frame to out of it, by half frames
_HARD = 12.0  # how sharp bounds of nearness (log) are
_CLEAR, _STEEP = 0.25, 25.0  # metres nearer than a point from which something covers it; how sharp that is
_FACE, _SKIN = 0.07, 60.0  # the same of the subject itself before its own eyes, as a hand
#: Means and deviations by which marks come near 0 and 1; the others are so of themselves.
_COMMON = {"size": (3.2, 0.7), "lens": (3.8, 0.35), "distance": (0.7, 0.7), "seconds": (1.4, 0.6)}
#: Places across the frame, half frames to the right and down, that are asked for what is much nearer than the
#: subject, and how much nearer (log) counts.
_LOOKS = [(x, y) for x in (-0.85, -0.3, 0.3, 0.85) for y in (-0.6, 0.5)]
_NEARER = (0.3, math.log(2), 1.1)

#: Where sizes put what is to be at the top: a point, and how high above the middle, half frames.
_TOPS = (("top", 0.82), ("top", 0.46), ("top", 0.08), ("crown", 0.84), ("eyes", 0.4))
#: Points of a body by which one says how much of it is seen.
BODY = [POINTS.index(p) for p in ("eyes", "chin", "pocket", "waist", "hand_l", "hand_r", "knees")]
HANDS = [POINTS.index(p) for p in ("hand_l", "hand_r")]
OTHERS = [POINTS.index(p) for p in ("other_1", "other_2")]

#: Numbers of :func:`composed` of a frame: marks, which points there are, composition, looks, what is seen,
#: and of each point whether it is covered, and whether it is in the frame.
COMPOSED = (
    len(SUBJECT_MARKS) + len(POINTS) + 12 + len(_TOPS) + len(_LOOKS) + len(_NEARER) + 7 + 2 * len(POINTS)
)
#: Which of them says whether the eyes are in the frame.
EYES_INSIDE = COMPOSED - len(POINTS) + POINTS.index("eyes")
#: Numbers that :func:`over_time` makes of each of a frame's, and :func:`over_window`.
SUMMED, WINDOWED = 10, 3
_APART = 8.0  # what keeps a frame that is not meant from being the least or the most


def composed(told: Tensor, nearness: Tensor) -> Tensor:
    """What film grammar looks at in frames, float32 [B, T, COMPOSED].

    told: their marks [B, T, marks], of which those of the subject count
    nearness: codes of their maps [B, T, SIDE, SIDE]

    Who composes a picture asks for sums and products of marks, as where the face points by where it is, or
    for bounds, as whether a point is within the frame: that is given rather than to be learnt.
    """
    names = SUBJECT_MARKS
    marks = dict(zip(names, told[..., : len(names)].unbind(-1), strict=True))
    common = [(marks[n] - _COMMON[n][0]) / _COMMON[n][1] if n in _COMMON else marks[n] for n in names]
    right, up, there, inside, covered = placed(marks)
    own = (1 - (-marks["before_eyes"].nan_to_num(-1.0)).exp()) * marks["distance"].exp()
    at = dict(zip(POINTS, up.unbind(-1), strict=True))
    eyes = POINTS.index("eyes")
    sideways = right[..., eyes]
    composition = [
        -marks["right_face"] * sideways,  # room ahead of the face
        ((1 - at["eyes"]) / 2 - 1 / 3).abs(),  # off the upper third
        sideways.abs(),
        (at["top"] - 1).clamp_min(0),
        (at["crown"] - 1).clamp_min(0),
        (at["chin"] - 1).clamp_min(0),
        (-1 - at["waist"]).clamp_min(0),
        (-1 - at["feet"]).clamp_min(0),
        at["crown"] - at["feet"],
        at["crown"] - at["chin"],
        own.clamp(0, 1),
        torch.sigmoid(_SKIN * (own - _FACE)) * inside[..., eyes],
        *((at[point] - high).abs().clamp_max(2) for point, high in _TOPS),
    ]
    looks, share = _foreground(nearness, marks["distance"])
    parts = [torch.stack(common, -1).nan_to_num(), there.float(), torch.stack(composition, -1)]
    return torch.cat([*parts, looks, share, _seen(inside, covered), covered, inside], -1)


class Placed(NamedTuple):
    """Where the points of a subject are in frames, [B, T, points] each.

    right, up: half frames from the middle, 3 for what there is not; there: whether there is such a point
    inside: whether it is in the frame, covered: and something is before it, 0..1
    """

    right: Tensor
    up: Tensor
    there: Tensor
    inside: Tensor
    covered: Tensor


def placed(marks: Mapping[str, Tensor]) -> Placed:
    """Where the subject's points are, by the marks of frames by their names, [B, T] each."""
    right, up, nearer = (
        torch.stack([marks[f"{what}_{point}"] for point in POINTS], -1) for what in ("right", "up", "covered")
    )
    there = right.isfinite()
    right, up = right.nan_to_num(3.0), up.nan_to_num(3.0)
    inside = in_frame(right, up) * there
    covered = hidden(nearer, marks["distance"].nan_to_num(0.0).unsqueeze(-1)) * inside
    return Placed(right, up, there, inside, covered)


def in_frame(right: Tensor, up: Tensor) -> Tensor:
    """Whether points are in the frame, 0..1, of their places in half frames from its middle."""
    return torch.sigmoid(_SHARP * (1 - right.abs())) * torch.sigmoid(_SHARP * (1 - up.abs()))


def hidden(nearer: Tensor, distance: Tensor) -> Tensor:
    """Whether what is seen in the place of points is before them, 0..1.

    nearer: by how much it is nearer (log), NaN where not known; distance: log metres of the points
    """
    ahead = (1 - (-nearer.nan_to_num(-1.0)).exp()) * distance.exp()  # metres
    return torch.sigmoid(_STEEP * (ahead - _CLEAR))


def _seen(inside: Tensor, covered: Tensor) -> Tensor:
    """How much is seen of whom, [B, T, 7]: of the body's points in the frame the share that nothing covers;
    the eyes; head and middle in the frame, and all of the head; a hand at least; of the others the most; and
    whether there is nobody at all."""
    clear = inside - covered
    body, there = clear[..., BODY].sum(-1), inside[..., BODY].sum(-1)
    eyes, chin, waist = (inside[..., POINTS.index(p)] for p in ("eyes", "chin", "waist"))
    hands, others = clear[..., HANDS].amax(-1), clear[..., OTHERS].amax(-1)
    somebody = torch.stack([clear[..., BODY].amax(-1), eyes, others], -1).amax(-1)
    told = (body / there.clamp_min(0.5), clear[..., POINTS.index("eyes")], eyes * waist, eyes * chin)
    return torch.stack([*told, hands, others, 1 - somebody], -1)


def away_of(nearness: Tensor) -> Tensor:
    """How far away (log metres) is what codes of maps that are not 0 stand for."""
    return (1 - (nearness.float() - 1) / 254) * math.log(FARTHEST / NEAREST) + math.log(NEAREST)


def _foreground(nearness: Tensor, distance: Tensor) -> tuple[Tensor, Tensor]:
    """Whether what is seen at the looks is much nearer than the subject, [B, T, looks], and the shares of the
    picture that are nearer by so much, [B, T, 3]. nearness: codes [B, T, SIDE, SIDE]; distance: its log"""
    by = torch.where(nearness > 0, distance[..., None, None] - away_of(nearness), -2.0)
    column, row = (torch.tensor([int((look[k] + 1) * SIDE / 2) for look in _LOOKS]) for k in (0, 1))
    looks = torch.sigmoid(_HARD * (by[:, :, row.to(by.device), column.to(by.device)] - math.log(2)))
    return looks, torch.stack([(by > least).float().mean((2, 3)) for least in _NEARER], -1)


def over_time(features: Tensor, times: Tensor, inside: Tensor) -> Tensor:
    """What becomes of features of frames over a shot: [B, T, D] and [B, T] -> [B, 10 D].

    Average, slope and spread; the extremes, for what is amiss only for a time; and averages of the beginning
    and the end, a quarter or a half, and of when the subject is in the frame: a pan is about it at one end
    alone. inside: how much it is, [B, T]
    """
    begins = [(1 - times / 0.35).clamp_min(0), torch.sigmoid(20 * (0.55 - times))]
    ends = [(1 - (1 - times) / 0.35).clamp_min(0), torch.sigmoid(20 * (times - 0.45))]
    weight = torch.stack([*begins, *ends, inside], 1)
    weight = weight / (weight.sum(2, keepdim=True) + 1e-3)
    parts = torch.einsum("bwt,btd->bwd", weight, features).flatten(1)
    return torch.cat([fuse(features, times), features.amin(1), features.amax(1), parts], 1)


def over_window(features: Tensor, meant: Tensor) -> Tensor:
    """Average, least and most of features [B, T, D] of the frames that are meant [B, T], 0..1: [B, 3 D]."""
    share = meant.unsqueeze(2)
    average = (share * features).sum(1) / (share.sum(1) + 1e-3)
    apart = _APART * (1 - share)
    return torch.cat([average, (features + apart).amin(1), (features - apart).amax(1)], 1)


def fuse(features: Tensor, times: Tensor) -> Tensor:
    """Average, least-squares slope and spread over time: [B, T, D] and [B, T] -> [B, 3 D].

    All three mean the same for any subset of a shot's frames. One frame has no slope and no spread.
    """
    average = features.mean(1)
    offset = (times - times.mean(1, keepdim=True)).unsqueeze(2)
    change = features - average.unsqueeze(1)
    slope = (offset * change).sum(1) / offset.square().sum(1).clamp_min(1e-6)
    spread = (change.square().mean(1) + 1e-6).sqrt()
    return torch.cat([average, slope, spread], 1)
