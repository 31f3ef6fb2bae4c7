"""What is in the way of what a picture is of, and what is missing behind it.

A branch before the camera, a pillar that hides half of a room, a floor that ends: told by how near the cells
of a map are. Nothing here is learnt; it is looked in the places, and within the shares of the way, in which
film grammar looks (:mod:`vdsl.cinema.measures`), as far as maps tell. Assumes marks and maps as
:mod:`ranker.guides` has them. Guarantees numbers that are known for any of them.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import torch
from torch import Tensor

from .composed import away_of
from .framed import SENSOR
from .guides import CHANNELS, MARKS, SIDE

#: Where it is looked, half frames to the right and down, for what is near in the way of a subject and of a
#: place, and for what is missing of the floor.
_ASIDE = [(-0.891 + 0.198 * k, -0.75 + 0.27 * n) for k in range(10) for n in range(6)]
_ALL_OVER = [(-0.891 + 0.198 * k, y) for k in range(10) for y in (-0.5, 0.1, 0.6)]
_LOWER = [(x, y) for x in (-0.8, -0.3, 0.3, 0.8) for y in (0.3, 0.65, 0.95)]
#: Within which share of the way to the subject something is in it, and what that counts.
_IN_THE_WAY = ((0.5, 1.0), (0.72, 0.4))
#: Metres by which a thing has to be nearer than that, and somebody, or so much of the way; how much of the
#: way down to the floor something may be in the way of a look at it; the least way there is, metres.
_THING, _SOMEBODY, _FAR_OFF, _TO_THE_GROUND, _NEAREST = 0.14, 0.03, 0.01, 0.9, 0.2
#: Rows of a map, the lowest, where it is looked for the floor, and which share of what they show is no lower.
_LOWEST, _FLOOR = 4, 0.9
#: What the last frame counts of what is in the way, and of what is missing, were there nothing in all others.
_ENDS_BEHIND, _ENDS_MISSING = 0.4, 0.5
_LEVEL = 128.0  # what maps hold of a level line of sight
_CODE = math.pi / 2 / 127  # radians by which it rises with each step of that


class Foreground(NamedTuple):
    """Shares of pictures, [B, 2] each: beside a subject, and all over a place.

    way: something near covers; at_end: in the last frame; things, things_at_end: things alone, and nobody
    """

    way: Tensor
    at_end: Tensor
    things: Tensor
    things_at_end: Tensor


def foreground_of(told: Tensor, maps: Tensor) -> Foreground:
    """How much of pictures something near covers.

    told: marks of their frames [B, T, marks]; maps: their maps [B, T, SIDE, SIDE, channels]
    """
    marks = dict(zip(MARKS, told.unbind(-1), strict=True))
    lens = marks["lens"].nan_to_num(3.5).exp().unsqueeze(-1)
    x, y = (
        marks[f"{way}_waist"].nan_to_num(0.0).unsqueeze(-1) * half / lens
        for way, half in zip(("right", "up"), SENSOR, strict=True)
    )
    far = marks["distance"].nan_to_num(1.0).exp().unsqueeze(-1) / (1 + x * x + y * y).sqrt()
    high = _above_the_floor(marks, maps).unsqueeze(-1)
    found = [_before(maps, looks, lens, far.clamp_min(_NEAREST), high) for looks in (_ASIDE, _ALL_OVER)]
    means, ends = [], []
    for share in (part for kind in zip(*found, strict=True) for part in kind):  # all, then things alone
        ends.append(share[:, -1])
        means.append(torch.maximum(share.mean(1), _ENDS_BEHIND * share[:, -1]))
    way, at_end, things, things_at_end = (
        torch.stack(pair, 1) for pair in (means[:2], ends[:2], means[2:], ends[2:])
    )
    return Foreground(way, at_end, things, things_at_end)


def _before(
    maps: Tensor, looks: list[tuple[float, float]], lens: Tensor, far: Tensor, high: Tensor
) -> tuple[Tensor, Tensor]:
    """Of looks at frames the share that something is in the way of, [B, T]; and that a thing is.

    lens, millimetres; far, metres to the subject; high, metres above the floor: [B, T, 1]
    """
    code, own, others, rise = (
        _at(maps[..., CHANNELS.index(name)].float(), looks)
        for name in ("nearness", "subject", "others", "rise")
    )
    right, down = torch.tensor(looks, device=maps.device).unbind(1)
    falls = _long(right, down, lens) * -_angle(rise).sin()  # metres down a metre of depth
    away = torch.where(code > 0, away_of(code).exp(), torch.inf)
    way = torch.zeros_like(away)
    for share, counts in _IN_THE_WAY:
        until = share * far
        # The ground that one looks down on is in nobody's way, though it is nearer than what would be below.
        deep = falls * until
        until = until * torch.where(deep > high, _TO_THE_GROUND * high / deep.clamp_min(1e-6), 1.0)
        room = torch.where(others > 127, (_FAR_OFF * until).clamp_min(_SOMEBODY), _THING)
        way = torch.maximum(way, counts * (away < until - room))
    way = way * (1 - own / 255)
    return way.mean(-1), (way * (1 - others / 255)).mean(-1)


def _above_the_floor(marks: dict[str, Tensor], maps: Tensor) -> Tensor:
    """How high cameras are above the floor, metres [B, T]: above a subject's feet, but no higher than above
    what is seen at the lower border of the picture, since a place has no feet."""
    lens = marks["lens"].nan_to_num(3.5).exp()
    rise, code = (maps[..., CHANNELS.index(name)] for name in ("rise", "nearness"))
    middle = slice(SIDE // 2 - 1, SIDE // 2 + 1)
    level = _angle(rise[:, :, middle, middle]).mean((2, 3))
    waist, feet = (
        level + (marks[f"up_{point}"].nan_to_num(0.0) * SENSOR[1] / lens).atan()
        for point in ("waist", "feet")
    )
    along = marks["distance"].nan_to_num(1.0).exp() * waist.cos()
    across = (torch.arange(SIDE, device=rise.device) + 0.5) * 2 / SIDE - 1
    long = _long(across, across[-_LOWEST:].unsqueeze(1), lens[..., None, None])
    drop = long * -_angle(rise[:, :, -_LOWEST:]).sin() * away_of(code[:, :, -_LOWEST:]).exp()
    drop = torch.where(code[:, :, -_LOWEST:] > 0, drop, 0.0).flatten(2)
    ordered = drop.sort(-1).values  # torch's own quantile takes no empty batches
    place = _FLOOR * (ordered.shape[-1] - 1)
    floor = ordered[..., int(place)].lerp(ordered[..., int(place) + 1], place % 1)
    return torch.minimum(-along * feet.tan(), floor).clamp_min(0)


def _angle(rise: Tensor) -> Tensor:
    """By how much lines of sight rise, radians, of the codes of maps."""
    return (rise.float() - _LEVEL) * _CODE


def _long(right: Tensor, down: Tensor, lens: Tensor) -> Tensor:
    """Metres of a line of sight for a metre of depth, by half frames off the middle and focal length."""
    return (1 + (right * SENSOR[0] / lens) ** 2 + (down * SENSOR[1] / lens) ** 2).sqrt()


def missing_of(told: Tensor, maps: Tensor) -> Tensor:
    """How much of the picture shows nothing at all, [B, 2]: of its lower part, and beside the subject where
    walls are left out."""
    nothing = maps[..., CHANNELS.index("nothing")].float() / 255
    lower = _at(nothing, _LOWER).mean(-1)
    floor = torch.maximum(lower[:, [0, lower.shape[1] // 2, -1]].mean(1), _ENDS_MISSING * lower[:, -1])
    waist = told[..., MARKS.index("up_waist")].nan_to_num(0.0).clamp(-1, 1)
    row = ((1 - waist) / 2 * SIDE).long().clamp(0, SIDE - 1)
    across = nothing.gather(2, row[..., None, None].expand(-1, -1, 1, SIDE)).mean((2, 3))
    opened = told[..., MARKS.index("open")].nan_to_num(0.0)
    return torch.stack([floor, (across * opened).mean(1)], -1)


def _at(field: Tensor, looks: list[tuple[float, float]]) -> Tensor:
    """What fields [B, T, SIDE, SIDE] hold at places, [B, T, looks]."""
    column, row = (
        torch.tensor([min(int((look[k] + 1) * SIDE / 2), SIDE - 1) for look in looks], device=field.device)
        for k in (0, 1)
    )
    return field[:, :, row, column]
