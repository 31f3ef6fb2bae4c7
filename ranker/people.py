"""Who is in a picture, one by one: what film grammar asks of each of several people, and how the camera goes.

A shot of two, or of a place, is as good as what is seen of each: halfway between two people there is nobody.
Nothing here is learnt. Assumes marks as :mod:`ranker.guides` has them. Guarantees numbers of about the size
of 1 that are known for any marks.
"""

from __future__ import annotations

import torch
from torch import Tensor

from .composed import hidden, in_frame
from .guides import PEOPLE, PEOPLE_MARKS, PERSON_POINTS, SUBJECT_MARKS

_AWAY = 1.0  # log metres, about which distances lie
_HEAD, _TRUNK = ("crown", "eyes"), ("pocket", "waist")
_CAMERA = ("pace", "turning", "jerk", "room", "work_l", "work_r")
_OWN = len(PEOPLE_MARKS) - len(_CAMERA)  # marks of people as they are
_EACH = (
    2 * len(PERSON_POINTS) + 7
)  # of somebody: what is in the frame, what of it is hidden, and what follows
#: Numbers of :func:`people_of` of a frame that sum up everybody and the camera, and of all of them; those of
#: each come first.
SUMMED_UP = 8 + len(_CAMERA)
PEOPLED = _OWN + PEOPLE * _EACH + SUMMED_UP


def people_of(told: Tensor) -> Tensor:
    """Numbers of the people in frames, float32 [B, T, PEOPLED]; told: marks [B, T, marks].

    Of each: which of their points are in the frame, and which of these are hidden; whether there is such a
    one, the share that is seen, whether the eyes are, whether they are in the picture without their head; how
    much they are turned to the camera where they are seen, the room ahead of their face, how tall they are.
    Of all: how many there are, how well the worst and the average are seen and turned, who lost a head, and
    how many are seen.
    """
    own = told[..., len(SUBJECT_MARKS) :]
    marks = dict(zip(PEOPLE_MARKS, own.unbind(-1), strict=True))
    plain = {name: value.nan_to_num(3.0 if name.startswith("up_") else 0.0) for name, value in marks.items()}
    for k in range(PEOPLE):
        away = marks[f"distance_{k + 1}"] - _AWAY
        plain[f"distance_{k + 1}"] = away.nan_to_num(0.0)
    each = [_one(marks, k) for k in range(PEOPLE)]
    there, share, eyes, cut, turned = (torch.stack([one[n] for one in each], -1) for n in _SUMMED)
    nobody = 1 - there
    count = there.sum(-1)
    among = count.clamp_min(1.0)
    total = (
        count / PEOPLE,
        (eyes + nobody).amin(-1),
        (eyes * there).sum(-1) / among,
        (turned + 2 * nobody).amin(-1),
        (turned * there).sum(-1) / among,
        (share + nobody).amin(-1),
        (cut * there).amax(-1),
        (share * there).sum(-1) / PEOPLE,
    )
    camera = [plain.pop(name) for name in _CAMERA]
    of_each = [value for one in each for value in (*one["points"].unbind(-1), *(one[n] for n in _TOLD))]
    return torch.stack([*plain.values(), *of_each, *total, *camera], -1)


_SUMMED = ("there", "share", "eyes", "cut", "turned")
_TOLD = (*_SUMMED, "ahead", "tall")


def _one(marks: dict[str, Tensor], k: int) -> dict[str, Tensor]:
    """What is told of the k-th, each [B, T]; points: [B, T, 2 points]."""
    names = [f"{point}_{k + 1}" for point in PERSON_POINTS]
    right, up, nearer = (
        torch.stack([marks[f"{what}_{n}"] for n in names], -1) for what in ("right", "up", "covered")
    )
    before = right.isfinite()
    inside = in_frame(right.nan_to_num(3.0), up.nan_to_num(3.0)) * before
    distance = marks[f"distance_{k + 1}"]
    covered = hidden(nearer, distance.nan_to_num(0.0).unsqueeze(-1)) * inside
    clear = dict(zip(PERSON_POINTS, (inside - covered).unbind(-1), strict=True))
    head, trunk = (torch.stack([clear[n] for n in part], -1) for part in (_HEAD, _TRUNK))
    shown = head.amax(-1)
    turned = marks[f"turned_{k + 1}"].nan_to_num(0.0)
    at = dict(zip(PERSON_POINTS, zip(right.unbind(-1), up.unbind(-1), strict=True), strict=True))
    return {
        "points": torch.cat([inside, covered], -1),
        "there": distance.isfinite().float(),
        "share": torch.stack(list(clear.values()), -1).mean(-1),
        "eyes": clear["eyes"],
        "cut": trunk.amax(-1) * (1 - inside[..., [PERSON_POINTS.index(n) for n in _HEAD]].amin(-1)),
        "turned": (1 + turned) * clear["eyes"],
        "ahead": (-marks[f"right_face_{k + 1}"] * at["eyes"][0]).nan_to_num(0.0) * shown,
        "tall": (at["crown"][1] - at["feet"][1]).nan_to_num(0.0),
    }
