"""How people in a picture stand to each other, and what spoils it: who stands before whom, who has no head in
it or is halved by its border, and what is in the way or missing (:mod:`ranker.foreground`).

An eye that puts good takes in order goes by these as much as by the face it looks for, and none of them is a
sum of marks: of two people it counts which one is nearer, and how far they are apart for how large they are.
Nothing here is learnt. Assumes marks and maps as :mod:`ranker.guides` has them. Guarantees numbers of about
the size of 1 that are known for any of them.
"""

from __future__ import annotations

from typing import NamedTuple

import torch
from torch import Tensor

from .composed import hidden
from .foreground import foreground_of, missing_of
from .framed import SENSOR
from .guides import FARTHEST, MARKS, PEOPLE

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
#: Cosine of a face to the camera below which one sees the back of a head, of which nothing is left where it
#: is cut above the brow; and above which nobody's shoulder is looked over.
_FACELESS, _SHOULDER = -0.2, 0.3
_OUT = 2.95  # half frames off the middle at which what is behind the camera is told of
#: What the last frame adds to somebody without a head; what they count who are halved, who stand before each
#: other, and whose feet are not in the picture; and how much all of it takes away.
_ENDS, _HALF, _CROWDED, _FOOTLESS = 0.3, 0.5, 0.45, 0.3
_SPOILT, _COVERED = 0.33, 0.95
#: Points of somebody, by their places in what follows.
_POINTS = ("crown", "eyes", "pocket", "waist", "feet")
_CROWN, _EYES, _CHEST, _WAIST, _FEET = range(len(_POINTS))
#: Where film grammar draws its lines, and on both sides of them, for how much is in the way and for how much
#: is spoilt; and within how much of each a shot may be told to be on one side of it.
_WAY = ((0.02, 0.015), (0.05, 0.015), (0.1, 0.05))
_CUT = ((0.35, 0.1), (0.5, 0.05), (0.7, 0.1))
_FINE = 5.0  # a fifth of what there may be is much
_FACE = 0.05  # length of the direction of a face that is none: a place has no face
#: Numbers of a frame and of a shot.
_FRAME = 12
CROWDED = 2 * _FRAME + 18 + 4 * (len(_WAY) + len(_CUT))
#: Places of some of them: of a frame's, which come on the average and then of the last; and of a shot's.
TOGETHER, LOST, HALVED, FOOTLESS, READ = 0, 2, 3, 4, 5
LEAST_TOGETHER, SPOILT, IN_THE_WAY, MISSING, BESIDES, ASKED = (2 * _FRAME + k for k in (0, 1, 6, 10, 12, 14))


class _People(NamedTuple):
    """Everybody in frames, the subject first if it is one of them: [B, T, K] each, or [B, T, K, points].

    own: whether the shot is about them; there: whether there is such a one before the camera
    right, up: half frames from the middle; aside, down: metres at a metre's distance; depth: metres
    inside: points that are in the frame; clear: and nothing is before them
    breadth: half frames of a metre where they are; turned: cosine of the face to the camera
    place: [B, T, 1], whether the shot is about a place, and they are those in it
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
    turned: Tensor
    place: Tensor

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
    who = _people(told)
    frames, people = _frames(who)
    mean, last, least = frames.mean(1), frames[:, -1], frames.amin(1)
    spoilt, besides = _spoilt(frames, people), _spoilt(*_frames(_without_shoulders(who)))
    near, missing = foreground_of(told, maps), missing_of(told, maps)
    logs = [(1 - _SPOILT * part).log() for part in spoilt]
    logs.append((1 - _COVERED * near.way[:, :1]).clamp_min(0.05).log())
    of_place = who.place.any(1)
    asked = [torch.where(of_place, found[:, 1:], found[:, :1]) for found in near]
    numbers = [mean, last, least[:, :1], *spoilt, *logs, near.way, near.at_end, missing, *besides, *asked]
    sides = [*_sides(asked[0], _WAY), *_sides(asked[2], _WAY)]
    sides += [*_sides(spoilt[0], _CUT), *_sides(besides[0], _CUT)]
    beyond = torch.cat(sides, 1)
    return torch.cat([torch.asinh(_FINE * torch.cat(numbers, 1)), beyond, beyond * of_place], 1)


def _sides(values: Tensor, bounds: tuple[tuple[float, float], ...]) -> list[Tensor]:
    """On which side of bounds values [B, 1] are, -1..1."""
    return [torch.tanh((values - bound) / within) for bound, within in bounds]


def _spoilt(frames: Tensor, people: Tensor) -> tuple[Tensor, Tensor]:
    """How much numbers of frames [B, T, _FRAME] spoil shots of so many people [B], by all but feet and by
    these too: [B, 1] each."""
    mean, last = frames.mean(1), frames[:, -1]
    crowded, lost, halved, footless = (slice(k, k + 1) for k in range(1, 5))
    cut = mean[:, lost] + _ENDS * last[:, lost]
    ugly = _HALF * (mean[:, halved] + _ENDS * last[:, halved]).clamp_max(1)
    ugly = torch.maximum(ugly, _CROWDED * torch.maximum(mean[:, crowded], last[:, crowded]))
    feet = _FOOTLESS * torch.maximum(mean[:, footless], last[:, footless])
    several = (people > 1).float().unsqueeze(1)
    spoilt = torch.maximum(cut, ugly).clamp(0, 1) * several
    return spoilt, torch.maximum(spoilt, feet.clamp(0, 1) * several)


def _without_shoulders(who: _People) -> _People:
    """Everybody but one over whose shoulder the subject may be meant to be seen: the first of the others,
    if most of the time nearer than it and not facing the camera. Who is there by intent spoils nothing."""
    first = torch.zeros_like(who.there)
    first[..., 1] = True  # the subject, alone, is before all others
    over = first & who.own[..., :1] & ~who.own & (who.depth < who.depth[..., :1]) & (who.turned < _SHOULDER)
    there = who.there & (over.float().mean(1, keepdim=True) <= 0.5)
    seen = there.unsqueeze(-1)
    return who._replace(there=there, inside=who.inside & seen, clear=who.clear & seen)


def _frames(who: _People) -> tuple[Tensor, Tensor]:
    """Numbers of frames [B, T, _FRAME], and how many people they are of at most [B].

    How near two heads are to each other, and how little people stand apart; how much somebody beside the
    subject lost their head, and is halved; how many lost their feet. Of all the share whose heads are seen,
    by who stands before them and by what is drawn, and the first of those it is about; how much of the trunk
    of one of these is behind somebody, and whether any is; the most that is of anybody's; how many there are.
    """
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
    whole = whole & (high[..., _CROWN] | (who.turned > _FACELESS))
    seen = who.clear[..., _CROWN : _EYES + 1].any(-1) | ~who.inside[..., _EYES]
    whole = whole & ~covered.headless & seen

    nearest = torch.where(who.own & who.there, who.depth, torch.inf).amin(-1, keepdim=True)
    subject = nearest.where(nearest.isfinite(), who.depth).clamp_min(_BEFORE)
    counts = ((_FAR - who.depth / subject) / (_FAR - 1)).clamp(0, 1)
    left = covered.behind < _GONE
    company = body & left & (~who.own | who.place)
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
    place = about.any(-1, keepdim=True) & (face.norm(dim=-1, keepdim=True) < _FACE)
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
    turned = torch.stack([marks[f"turned_{k}"].nan_to_num(0.0) for k in numbers], -1)
    turned = torch.cat([-marks["away_face"].nan_to_num(0.0).unsqueeze(-1), turned], -1)
    own = torch.cat([alone, about], -1)
    return _People(own, there, right, up, aside, down, depth, inside, clear, breadth, turned, place)


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
