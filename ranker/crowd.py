"""How people in a picture stand to each other, and what spoils it: who stands before whom, who has no head in
it or is halved by its border, what is near in the way, and what is missing behind.

An eye that puts good takes in order goes by these as much as by the face it looks for, and none of them is a
sum of marks: of two people it counts which one is nearer, and how far they are apart for how large they are.
Nothing here is learnt. Assumes marks and maps as :mod:`ranker.guides` has them. Guarantees numbers of about
the size of 1 that are known for any of them.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import torch
from torch import Tensor

from .composed import away_of, hidden
from .framed import SENSOR
from .guides import CHANNELS, FARTHEST, MARKS, PEOPLE, SIDE

#: Half the breadth of a head and its hair, of a trunk, and of one with its arms and some air beside it:
#: metres.
_HEAD, _TRUNK, _AIR = 0.11, 0.18, 0.42
#: Share of a body's length in the picture by which one is over another whom it does not cover, and the least
#: of that, metres; heads between two of them that are apart, and the least height of one, as from overhead.
_TALL, _FLAT = 0.65, 0.4
_HEADS, _FROM_ABOVE = 3.0, 0.2
#: Metres before the camera from which on somebody is in its picture; by how much nearer somebody's head is
#: than another it hides; share of a trunk's breadth behind somebody nearer from which on it is behind them,
#: and from which on nothing is left of it to see; how many times as far away as the subject somebody counts
#: hardly any more.
_BEFORE, _NEARER_HEAD = 0.2, 0.1
_BEHIND, _GONE, _FAR = 0.5, 0.85, 6.0
_OUT = 2.95  # half frames off the middle at which what is behind the camera is told of
#: What the last frame adds to somebody without a head; what they count who are halved, who stand before each
#: other, and whose feet are not in the picture; and how much all of it takes away.
_ENDS, _HALF, _CROWDED, _FOOTLESS = 0.3, 0.5, 0.45, 0.3
_SPOILT, _COVERED = 0.33, 0.95
#: What the last frame counts of what is in the way, and of what is missing, were there nothing in all others.
_ENDS_BEHIND, _ENDS_MISSING = 0.4, 0.5
#: Points of somebody, by their places in what follows.
_POINTS = ("crown", "eyes", "pocket", "waist", "feet")
_CROWN, _EYES, _CHEST, _WAIST, _FEET = range(len(_POINTS))
#: Where it is looked, half frames to the right and down, for what is near in the way of a subject and of a
#: place, and for what is missing of the floor; how much nearer (log) than the subject, and what that counts.
_ASIDE = [(x, y) for x in (-0.85, -0.3, 0.3, 0.85) for y in (-0.6, 0.5)]
_ALL_OVER = [(-0.891 + 0.198 * k, y) for k in range(10) for y in (-0.5, 0.1, 0.6)]
_LOWER = [(x, y) for x in (-0.8, -0.3, 0.3, 0.8) for y in (0.3, 0.65, 0.95)]
_IN_THE_WAY = ((math.log(2.0), 1.0), (-math.log(0.72), 0.4))
_FINE = 5.0  # a fifth of what there may be is much
_NOTHING = -9.0  # by how much nearer what is not there is
#: Numbers of a frame and of a shot.
_FRAME = 12
CROWDED = 2 * _FRAME + 12
#: Places of some of them: of a frame's, which come on the average and then of the last; and of a shot's.
TOGETHER, LOST, HALVED, FOOTLESS, READ = 0, 2, 3, 4, 5
LEAST_TOGETHER, SPOILT, IN_THE_WAY, MISSING = (2 * _FRAME + k for k in (0, 1, 6, 10))


class _People(NamedTuple):
    """Everybody in frames, the subject first if it is one of them: [B, T, K] each, or [B, T, K, points].

    own: whether the shot is about them; there: whether there is such a one before the camera
    right, up: half frames from the middle; aside, down: metres at a metre's distance; depth: metres
    inside: points that are in the frame; clear: and nothing is before them
    breadth: half frames of a metre where they are
    """

    own: Tensor
    there: Tensor
    right: Tensor
    up: Tensor
    aside: Tensor
    down: Tensor
    depth: Tensor
    inside: Tensor
    clear: Tensor
    breadth: Tensor

    @property
    def scale(self) -> Tensor:
        """What a metre is where they are, at a metre's distance."""
        return 1 / self.depth.clamp_min(_BEFORE)

    @property
    def before(self) -> Tensor:
        """Who [B, T, of these, by those] is the nearer one."""
        return (_by(self.depth) < _of(self.depth)) & (_by(self.depth) > _BEFORE)

    @property
    def others(self) -> Tensor:
        return ~torch.eye(self.depth.shape[-1], dtype=torch.bool, device=self.depth.device)


class _Covered(NamedTuple):
    """Whom somebody before them covers, [B, T, K]: headless, whether it is their head; behind, which share of
    their trunk's breadth."""

    headless: Tensor
    behind: Tensor

    @property
    def any(self) -> Tensor:
        return self.headless | (self.behind > _BEHIND)


def crowd_of(told: Tensor, maps: Tensor) -> Tensor:
    """How people stand to each other in shots, and what spoils these, float32 [B, CROWDED].

    told: marks of their frames [B, T, marks]; maps: their maps [B, T, SIDE, SIDE, channels]
    """
    frames, people = _frames(told)
    near, missing = _in_the_way(told, maps), _missing(told, maps)
    mean, last, least = frames.mean(1), frames[:, -1], frames.amin(1)
    together, crowded, lost, halved, footless = (slice(k, k + 1) for k in range(5))
    cut = mean[:, lost] + _ENDS * last[:, lost]
    ugly = _HALF * (mean[:, halved] + _ENDS * last[:, halved]).clamp_max(1)
    ugly = torch.maximum(ugly, _CROWDED * torch.maximum(mean[:, crowded], last[:, crowded]))
    feet = _FOOTLESS * torch.maximum(mean[:, footless], last[:, footless])
    several = (people > 1).float().unsqueeze(1)
    spoilt = torch.maximum(cut, ugly).clamp(0, 1) * several
    with_feet = torch.maximum(spoilt, feet.clamp(0, 1) * several)
    logs = [(1 - _SPOILT * spoilt).log(), (1 - _SPOILT * with_feet).log()]
    logs.append((1 - _COVERED * near[:, :1]).clamp_min(0.05).log())
    numbers = torch.cat([mean, last, least[:, together], spoilt, with_feet, *logs, near, missing], 1)
    return torch.asinh(_FINE * numbers)


def _frames(told: Tensor) -> tuple[Tensor, Tensor]:
    """Numbers of frames [B, T, _FRAME], and how many people they are of at most [B].

    How near two heads are to each other, and how little people stand apart; how much somebody beside the
    subject lost their head, and is halved; how many lost their feet. Of all the share whose heads are seen,
    by who stands before them and by what is drawn, and the first of those it is about; how much of the trunk
    of one of these is behind somebody, and whether any is; the most that is of anybody's; how many there are.
    """
    who = _people(told)
    covered, share = _covered(who)
    head = who.clear[..., _EYES] & (who.inside[..., _CROWN] | _inside(who, _chin(who))) & who.there
    own, count = who.own & who.there, who.there.sum(-1)
    read = head & ~covered.headless
    parts = [
        _together(who, covered),
        *_company(who, covered),
        read.sum(-1) / count.clamp_min(1),
        head.sum(-1) / count.clamp_min(1),
        (read & own).sum(-1) / own.sum(-1).clamp_min(1),
        (covered.behind * own).amax(-1),
        (own & covered.any).any(-1),
        (share * who.others).amax((-1, -2)),
        count / (1 + PEOPLE),
    ]
    return torch.stack([part.float() for part in parts], -1), count.amax(1)


def _covered(who: _People) -> tuple[_Covered, Tensor]:
    """Whom somebody before them covers; and the share of trunks that is, by pairs."""
    scale, before = who.scale, who.before
    head, trunk = _HEAD * scale, _TRUNK * scale
    eyes, eyes_down, chest, chest_down = (
        place[..., point] for point in (_EYES, _CHEST) for place in (who.aside, who.down)
    )
    crown, feet = who.down[..., _CROWN], who.down[..., _FEET]
    reaches = _by(feet) > _of(eyes_down)
    beside = (_of(eyes) - _by(eyes)).abs() < _by(head) + 0.5 * _of(head)
    nearer = before & (_of(who.depth) - _by(who.depth) > _NEARER_HEAD)
    over = beside & (_by(eyes_down) - _of(eyes_down) < _by(head)) & nearer & reaches
    back = (
        before & ((_of(eyes) - _by(chest)).abs() < _by(trunk)) & (_by(chest_down) < _of(eyes_down)) & reaches
    )
    first, last = (chest - trunk, chest + trunk)
    both = torch.minimum(_of(last), _by(last)) - torch.maximum(_of(first), _by(first))
    share = (both / (2 * _of(trunk))).clamp(0, 1)
    share = share * (before & (_by(crown) < _of(chest_down)) & (_by(feet) > _of(chest_down)))
    return _Covered((over | back).any(-1), share.amax(-1)), share


def _together(who: _People, covered: _Covered) -> Tensor:
    """How near two heads are to each other in the picture, of those that are nearest, [B, T]: 0 from three
    heads' heights on, 1 for one behind the other."""
    shown = who.clear[..., : _CHEST + 1].any(-1)
    # Who is hidden by somebody alone is in the picture for all that.
    shown = shown | (covered.any & (who.inside[..., _EYES] | who.inside[..., _CHEST]))
    shown = shown & who.there
    eyes, down = who.aside[..., _EYES], who.down[..., _EYES]
    tall = torch.hypot(who.aside[..., _CROWN] - eyes, who.down[..., _CROWN] - down) * 2
    large = torch.maximum(tall, _FROM_ABOVE * who.scale)
    high = _one_over_the_other(who)
    far = (_of(eyes) - _by(eyes)).abs() / (_HEADS * torch.maximum(_of(large), _by(large)))
    level = (_of(down) - _by(down)).abs() < torch.maximum(_of(high), _by(high))
    return ((1 - far).clamp(0, 1) * level * (_of(shown) & _by(shown) & who.others)).amax((-1, -2))


def _company(who: _People, covered: _Covered) -> tuple[Tensor, Tensor, Tensor, Tensor]:
    """Of everybody, [B, T] each: how little they stand apart; how much somebody beside the subject is in the
    picture without a head; how much that, or halved by a side of it; and the share whose feet are below."""
    trunk, head = _TRUNK * who.breadth.clamp(0.02 / _TRUNK), _HEAD * who.breadth.clamp(0.01 / _HEAD)
    right, up = who.right, who.up
    beside, high = right.abs() < 1 + trunk.unsqueeze(-1), up.abs() < 1
    hides = who.inside.any(-1) & ~who.clear.any(-1) & ~covered.any  # a thing does
    body = (beside & high)[..., _CHEST : _WAIST + 1].any(-1) & who.there & ~hides
    whole = (right[..., _EYES].abs() < 1 + head) & high[..., _EYES] & (_chin(who).abs() < 1)
    seen = who.clear[..., _CROWN : _EYES + 1].any(-1) | ~who.inside[..., _EYES]
    whole = whole & ~covered.headless & seen

    nearest = torch.where(who.own & who.there, who.depth, torch.inf).amin(-1, keepdim=True)
    subject = nearest.where(nearest.isfinite(), who.depth).clamp_min(_BEFORE)
    counts = ((_FAR - who.depth / subject) / (_FAR - 1)).clamp(0, 1)
    left = covered.behind < _GONE
    company = body & left & ~who.own
    lost = (company & ~whole) * counts
    x = right[..., _CHEST]
    within = (((x + trunk).clamp_max(1) - (x - trunk).clamp_min(-1)) / (2 * trunk)).clamp(0, 1)
    halves = (company & whole) * counts * 4 * within * (1 - within)

    there = torch.where(
        who.own, (who.inside[..., _CHEST] & who.there).float(), (body & (whole | left)) * counts
    )
    air, high_up = _AIR * who.scale, _one_over_the_other(who)
    chest, down = who.aside[..., _CHEST], who.down[..., _CHEST]
    aside = ((_of(chest) - _by(chest)).abs() / (_of(air) + _by(air))).clamp(0, 1)
    above = ((_of(down) - _by(down)).abs() / _by(high_up)).clamp(0, 1)
    lapped = (1 - aside) * (1 - above) * torch.minimum(_of(there), _by(there)) * who.others
    below = (there * (up[..., _FEET] < -1)).sum(-1) / there.sum(-1).clamp_min(1)
    return lapped.amax((-1, -2)), lost.amax(-1), torch.maximum(halves, lost).amax(-1), below


def _people(told: Tensor) -> _People:
    """A subject that is one person is told of apart from the others; of several each is one of those."""
    marks = dict(zip(MARKS, told.unbind(-1), strict=True))
    numbers = [k + 1 for k in range(PEOPLE)]
    about = torch.stack([marks[f"about_{k}"].nan_to_num(0.0) for k in numbers], -1) > 0.5
    face = torch.stack([marks[f"{way}_face"].nan_to_num(0.0) for way in ("right", "up", "away")], -1)
    alone = (~about.any(-1) & (face.norm(dim=-1) > 0.5)).unsqueeze(-1)  # things have no face
    suffixes = ("", *(f"_{k}" for k in numbers))
    right, up, nearer = (
        torch.stack([torch.stack([marks[f"{what}_{p}{s}"] for p in _POINTS], -1) for s in suffixes], -2)
        for what in ("right", "up", "covered")
    )
    far = torch.stack([marks["distance"], *(marks[f"distance_{k}"] for k in numbers)], -1)
    there = torch.cat([alone, far[..., 1:].isfinite()], -1) & right[..., _EYES].isfinite()
    right, up, far = right.nan_to_num(3.0), up.nan_to_num(3.0), far.nan_to_num(4.0)
    there = there & (torch.maximum(right.abs(), up.abs()).amin(-1) <= _OUT)
    lens = marks["lens"].nan_to_num(3.5).exp().unsqueeze(-1)
    aside, down = right * SENSOR[0] / lens.unsqueeze(-1), -up * SENSOR[1] / lens.unsqueeze(-1)
    x, y = (  # a subject's distance is that of its waist, of people it is that of their eyes
        torch.cat([place[..., :1, _WAIST], place[..., 1:, _EYES]], -1) for place in (aside, down)
    )
    depth = torch.where(there, far.exp() / (1 + x * x + y * y).sqrt(), FARTHEST)
    inside = (right.abs() < 1) & (up.abs() < 1) & there.unsqueeze(-1)
    clear = inside & (hidden(nearer, depth.log().unsqueeze(-1)) < 0.5)
    breadth = lens / SENSOR[0] / depth.clamp_min(_BEFORE)
    return _People(
        torch.cat([alone, about], -1), there, right, up, aside, down, depth, inside, clear, breadth
    )


def _chin(who: _People) -> Tensor:
    """How far up chins are, which lie as far below the eyes as crowns above."""
    return 2 * who.up[..., _EYES] - who.up[..., _CROWN]


def _inside(who: _People, up: Tensor) -> Tensor:
    return (up.abs() < 1) & (who.right[..., _EYES].abs() < 1)


def _one_over_the_other(who: _People) -> Tensor:
    """How far one is over another in the picture whose bodies do not meet, [B, T, K]."""
    long = (who.down[..., _FEET] - who.down[..., _CROWN]).abs()
    return torch.maximum(_TALL * long, _FLAT * who.scale)


def _of(values: Tensor) -> Tensor:
    """Of these, by pairs [..., of these, by those]."""
    return values.unsqueeze(-1)


def _by(values: Tensor) -> Tensor:
    """By those."""
    return values.unsqueeze(-2)


def _in_the_way(told: Tensor, maps: Tensor) -> Tensor:
    """How much of the picture something near covers, [B, 4]: beside a subject, and all over a place; then
    what there is of both at the end."""
    code = maps[..., CHANNELS.index("nearness")]
    distance = told[..., MARKS.index("distance")].nan_to_num(1.0)
    by = torch.where(code > 0, distance[..., None, None] - away_of(code), _NOTHING)
    own = maps[..., CHANNELS.index("subject")].float() / 255
    way = torch.stack([(by > least) * counts for least, counts in _IN_THE_WAY], -1).amax(-1) * (1 - own)
    found = torch.stack([_at(way, looks).mean(-1) for looks in (_ASIDE, _ALL_OVER)], -1)
    last = found[:, -1]
    return torch.cat([torch.maximum(found.mean(1), _ENDS_BEHIND * last), last], 1)


def _missing(told: Tensor, maps: Tensor) -> Tensor:
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
