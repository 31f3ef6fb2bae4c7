"""How a shot frames its subject while it is meant to show it: what film grammar asks of a frame in its own
units, averaged over the frames that are meant.

The network for guides compresses what it is told before it sums it up (:class:`ranker.guided.Evened`), and
what a shot is on the average is lost in that where a frame is far off. Nothing here is learnt. Assumes marks
as :mod:`ranker.guides` has them. Guarantees numbers of about the size of 1 that are known for any marks.
"""

from __future__ import annotations

import torch
from torch import Tensor

from .composed import BODY, HANDS, OTHERS, placed
from .guides import MARKS, PEOPLE, POINTS

#: Lines that sizes put a point at the top on, from the frame's top as a share of its height; points between
#: chin and crown by how far they are from the one to the other.
_LINES = (
    ("top", 0.08),
    ("top", 0.1),
    ("top", 0.27),
    ("top", 0.46),
    ("crown", 0.08),
    (0.86, 0.03),
    (0.6, 0.22),
)
#: What is at the bottom of a size, for those who lie or are seen from above: the middle is where they belong.
_BOTTOMS = ("chin", "pocket", "waist", "thigh", "knees", "feet")
_WORK = [MARKS.index(f"work_{side}") for side in "lr"]
#: Millimetres of half a sensor of 16 to 9, to the right and to the top.
SENSOR = (18.0, 10.125)
#: Metres beside the line from waist to chin at which hands before a body hardly stand out from it, and at
#: which they do so plainly.
_WITHIN, _PLAIN = 0.1, 0.41
#: A face among several is hardly the better for being turned more to the camera than by this cosine.
_ENOUGH = 0.3
#: Numbers of a frame, and of a shot.
_FRAME = 2 + len(_LINES) + len(_BOTTOMS) + 12
FRAMED = _FRAME + 3
_FINE = 5.0  # a fifth of a frame's height is much
_APART = 4.0  # what keeps a frame that is not meant from being the least or the most


def framed(told: Tensor, meant: Tensor) -> Tensor:
    """How shots frame what they are about, float32 [B, FRAMED].

    told: marks of their frames [B, T, marks]; meant: which of these are meant to show it, 0..1, [B, T]
    """
    of_frames = _frames(told)
    weight = meant / (meant.sum(1, keepdim=True) + 1e-3)
    rest = 1 - meant
    share, asked, lost, size = (of_frames[..., k] for k in range(4))
    aside = rest / (rest.sum(1, keepdim=True) + 1e-3)
    shown = torch.maximum((share * weight).sum(1), (share * aside).sum(1))
    gesture = (lost * meant).sum(1) / ((asked * meant).sum(1) + 0.05)
    apart = _APART * (1 - meant)
    drift = (size - apart).amax(1) - (size + apart).amin(1)
    average = (weight.unsqueeze(2) * of_frames).sum(1)
    return torch.asinh(_FINE * torch.cat([average, torch.stack([shown, gesture, drift], 1)], 1))


def _frames(told: Tensor) -> Tensor:
    """What is asked of frames, [B, T, _FRAME].

    Of the other points that matter the share that is seen; whether hands are at work, and how far none of
    them stands out from the body then; how large it is (log). Then where eyes and ends of the body are off
    their lines, how the face is turned and what room it has, and how much is seen of what is in the frame.
    """
    marks = dict(zip(MARKS, told.unbind(-1), strict=True))
    right, up, there, inside, covered = placed(marks)
    clear = inside - covered
    at = dict(zip(POINTS, up.unbind(-1), strict=True))
    x, y = (side[..., POINTS.index("eyes")] for side in (right, up))
    size = marks["size"].nan_to_num(0.0)
    others = there[..., OTHERS].float()
    share = (clear[..., OTHERS].sum(-1) + (others.sum(-1) == 0)) / others.sum(-1).clamp_min(1)
    work = told[..., _WORK].nan_to_num(0.0)
    metres = torch.stack([right * SENSOR[0], up * SENSOR[1]], -1) / size.exp()[..., None, None]
    waist, chin = (metres[..., POINTS.index(p), :] for p in ("waist", "chin"))
    beside = torch.stack([_off(metres[..., k, :], waist, chin) for k in HANDS], -1)
    plain = ((beside - _WITHIN) / (_PLAIN - _WITHIN)).clamp(0, 1) * clear[..., HANDS]
    asked = work.amax(-1)
    lost = asked * (1 - (plain * (work > 0)).amax(-1))
    lines = []
    for point, line in _LINES:
        high = at[point] if isinstance(point, str) else at["chin"] + point * (at["crown"] - at["chin"])
        lines.append(((1 - high) / 2 - line).abs())
    flat = [((at["top"] + at[point]) / 4).abs() for point in _BOTTOMS]
    turned = _turned(marks, x, y)
    seen = clear[..., BODY].sum(-1) / inside[..., BODY].sum(-1).clamp_min(0.5)
    eyes, chest = inside[..., POINTS.index("eyes")], inside[..., POINTS.index("waist")]
    room = -marks["right_face"].nan_to_num(0.0) * x
    parts = [share, asked, lost, size - 3.2]
    parts += [((1 - y) / 2 - 1 / 3).abs(), (y.abs() / 2 - 1 / 6).clamp_min(0), *lines, *flat, room, turned]
    parts += [*_faces(marks), seen, clear[..., POINTS.index("eyes")], eyes, eyes * chest]
    return torch.stack(parts, -1)


def _off(point: Tensor, begin: Tensor, end: Tensor) -> Tensor:
    """Distance of points [..., 2] from lines between two others."""
    way = end - begin
    along = (((point - begin) * way).sum(-1) / (way * way).sum(-1).clamp_min(1e-6)).clamp(0, 1)
    return (point - begin - along.unsqueeze(-1) * way).norm(dim=-1)


def _turned(marks: dict[str, Tensor], x: Tensor, y: Tensor) -> Tensor:
    """Cosine between the subject's face and the way to the camera, 0 for what has no face."""
    lens = marks["lens"].nan_to_num(3.5).exp()
    ray = torch.stack([x * SENSOR[0] / lens, y * SENSOR[1] / lens, torch.ones_like(lens)], -1)
    face = torch.stack([marks[f"{way}_face"].nan_to_num(0.0) for way in ("right", "up", "away")], -1)
    return -(face * ray).sum(-1) / ray.norm(dim=-1)


def _faces(marks: dict[str, Tensor]) -> tuple[Tensor, Tensor]:
    """How the faces of several whom a shot is about are turned to the camera: the first of them, and the
    average of the others; 0 where there are none."""
    about = [marks[f"about_{k + 1}"].nan_to_num(0.0) for k in range(PEOPLE)]
    turned = [marks[f"turned_{k + 1}"].nan_to_num(0.0).clamp_max(_ENOUGH) for k in range(PEOPLE)]
    others = torch.stack(about[1:], -1)
    rest = (torch.stack(turned[1:], -1) * others).sum(-1) / others.sum(-1).clamp_min(1)
    return turned[0] * about[0], rest
