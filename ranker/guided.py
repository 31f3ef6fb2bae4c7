"""What a network makes of the guides of shots: a small one beside that for pictures (:mod:`ranker.guides`).

It is quick to teach: a shot's guides are a fiftieth of its pictures. Assumes guides of the frames that are
looked at, or zeros in their maps where a shot has none. Guarantees that a shot without guides is judged as
if there were no such network.
"""

from __future__ import annotations

from typing import NamedTuple

import torch
from torch import Tensor, nn

from .composed import COMPOSED, EYES_INSIDE, SUMMED, WINDOWED, composed, over_time, over_window
from .crowd import CROWDED, crowd_of
from .framed import FRAMED, framed
from .guides import CHANNELS, FLOW, MARKS, SIDE, Guides, pairs
from .people import PEOPLED, SUMMED_UP, people_of

_MAPS, _WIDE, _FRAME = 128, 256, 160  # numbers that describe the maps of a frame, and all of a frame
_ALL, _SOME = 64, 24  # numbers of who learns from all that is told of people, and that come of it a frame
_PATCH, _PATCHES = 4, 32  # cells along what is first summed up of a map, and numbers that describe such
_PAIR, _MOVED = 64, 256  # and a pair of frames, all pairs
_PACES = 3  # numbers of how fast a camera turns
_HALF_SENSOR, _SLOW = 18.0, 0.2  # millimetres; radians a second
_ASKED, _MOMENTS = 64, 8  # of who tells which frames are meant: its width, and places in time it tells apart
_LEAST = 0.1  # of the deviation of all shots, that good ones are taken to have at least
_SAME = 1e-4  # deviation of numbers that are all the same but for rounding
_FINE = 20.0  # by what motion is multiplied, so that slow ones are seen


class Guided(NamedTuple):
    """Guides as the network takes them.

    maps: uint8 [B, T, SIDE, SIDE, channels]; flow: [B, pairs, FLOW, FLOW, 2]; marks: [B, T, marks]
    times: [B, T] of maps and marks, 0..1
    """

    maps: Tensor
    flow: Tensor
    marks: Tensor
    times: Tensor

    @classmethod
    def of(cls, guides: Guides, times: Tensor) -> Guided:
        device = times.device
        maps = torch.from_numpy(guides.maps).to(device)
        flow, marks = (torch.from_numpy(told).to(device).float() for told in (guides.flow, guides.marks))
        return cls(maps, flow, marks, times.expand(len(guides), -1))

    @property
    def known(self) -> Tensor:
        """Which shots have guides, bool [B]: no line of sight is told by a 0."""
        return (self.maps[..., CHANNELS.index("rise")] != 0).flatten(1).any(1)


class Evened(nn.Module):
    """Numbers [..., D] in deviations from those of good shots, the more compressed the further off.

    What tells good shots apart is small beside how far off bad ones are: scaled by all of them, or cut off,
    one or the other would be lost.
    """

    middle: Tensor
    spread: Tensor

    def __init__(self, count: int) -> None:
        super().__init__()
        self.register_buffer("middle", torch.zeros(count))
        self.register_buffer("spread", torch.ones(count))

    def fit(self, good: Tensor, every: Tensor) -> None:
        """Take means and deviations of numbers [N, D] of good shots; where these are all the same, of every
        one's."""
        self.middle.copy_(good.mean(0))
        spread = torch.maximum(good.std(0, correction=0), _LEAST * every.std(0, correction=0))
        self.spread.copy_(torch.where(spread > _SAME, spread, torch.ones_like(spread)))

    def forward(self, numbers: Tensor) -> Tensor:
        return torch.asinh((numbers - self.middle) / self.spread)


class Window(nn.Module):
    """Which frames of a shot are meant to show its subject, by what they show and how the camera moves: log
    odds [B, T].

    A pan that comes to somebody is to be judged by how it ends, one that leaves them by how it begins.
    """

    def __init__(self, frame: int, moved: int) -> None:
        super().__init__()
        self.moved, self.frame = nn.Linear(moved, _ASKED), nn.Linear(frame + _MOMENTS, _ASKED, bias=False)
        self.last = nn.Sequential(nn.ReLU(), nn.Linear(_ASKED, _ASKED), nn.ReLU(), nn.Linear(_ASKED, 1))

    def forward(self, frames: Tensor, moved: Tensor, times: Tensor) -> Tensor:
        """frames: [B, T, frame]; moved: of shots, [B, moved]; times: [B, T], 0..1"""
        marked = torch.arange(_MOMENTS, device=times.device) / (_MOMENTS - 1)
        moment = (1 - (_MOMENTS - 1) * (times.unsqueeze(2) - marked).abs()).clamp_min(0)
        seen = self.frame(torch.cat([frames, moment], 2)) + self.moved(moved).unsqueeze(1)
        return self.last(seen).squeeze(2)


class People(nn.Module):
    """A description of who is in a frame, one by one, and of how the camera goes: [B, T, described].

    What sums everybody up goes on as it is, beside what is learnt of each.
    """

    described = _SOME + SUMMED_UP

    def __init__(self) -> None:
        super().__init__()
        self.evened = Evened(PEOPLED)
        first = (nn.Linear(PEOPLED, _ALL), nn.ReLU())
        self.each = nn.Sequential(*first, nn.Linear(_ALL, _SOME), nn.ReLU())

    def forward(self, told: Tensor) -> Tensor:
        """told: marks of frames, [B, T, marks]"""
        numbers = self.evened(people_of(told))
        return torch.cat([self.each(numbers), numbers[..., -SUMMED_UP:]], 2)


class Description(NamedTuple):
    """What a network says of B shots by their guides: of frames float32 [B, T, frame], and of shots
    [B, shot]; meant: log odds [B, T] that a frame is meant to show the subject, [B, 0] where that is not told
    """

    frames: Tensor
    shot: Tensor
    meant: Tensor


class GuideNet(nn.Module):
    """A description of every frame by its maps and marks, and of a shot by these and the camera's motion.

    frames: of a whole shot; meant: whether it tells which of them are meant to show the subject, and sums
        these up as well; people: whether it looks at people one by one; crowd: and at how they stand to each
        other
    """

    def __init__(self, frames: int, meant: bool = False, people: bool = False, crowd: bool = False) -> None:
        super().__init__()
        first = (nn.Conv2d(len(CHANNELS), _PATCHES, _PATCH, _PATCH), nn.ReLU())
        second = (nn.Conv2d(_PATCHES, 2 * _PATCHES, 3, 2, 1), nn.GroupNorm(8, 2 * _PATCHES), nn.ReLU())
        last = 2 * _PATCHES * (SIDE // _PATCH // 2) ** 2
        self.maps = nn.Sequential(*first, *second, nn.Flatten(), nn.Linear(last, _MAPS), nn.ReLU())
        self.evened = Evened(COMPOSED)  # a tenth may be much for one number
        wide = nn.Sequential(nn.Linear(_MAPS + COMPOSED, _WIDE), nn.ReLU())
        self.marks = nn.Sequential(*wide, nn.Linear(_WIDE, _FRAME), nn.ReLU())
        self.pairs = nn.Sequential(
            *(nn.Conv2d(4, 32, 3, 1, 1), nn.ReLU(), nn.Conv2d(32, 32, 3, 2, 1), nn.ReLU(), nn.Flatten()),
            *(nn.Linear(32 * (FLOW // 2) ** 2, _PAIR), nn.ReLU()),
        )
        self.moved = nn.Sequential(nn.Linear(_PAIR * len(pairs(frames)), _MOVED), nn.ReLU(), nn.Dropout(0.1))
        self.people = People() if people else None
        self.frame = _FRAME + COMPOSED + (0 if self.people is None else self.people.described)
        self.shot = SUMMED * self.frame + _MOVED + _PACES
        self.window: Window | None = None
        if meant:
            self.window = Window(self.frame, _MOVED + _PACES)
            self.shot += WINDOWED * self.frame + FRAMED
        self.crowd = crowd
        self.shot += CROWDED * crowd

    @torch.no_grad()
    def fit(self, seen: Guided, good: Tensor) -> None:
        """Take what is usual from guides of shots of which some are good, bool [B]."""
        numbers = composed(seen.marks, seen.maps[..., CHANNELS.index("nearness")])
        chosen = good if good.any() else torch.ones_like(good)
        self.evened.fit(numbers[chosen].flatten(0, 1), numbers.flatten(0, 1))
        if self.people is not None:
            everybody = people_of(seen.marks)
            self.people.evened.fit(everybody[chosen].flatten(0, 1), everybody.flatten(0, 1))

    def forward(self, seen: Guided) -> Description:
        batch, count = seen.maps.shape[:2]
        maps = seen.maps.flatten(0, 1).movedim(-1, 1).float() / 255
        with torch.autocast(maps.device.type, enabled=False):
            marks = composed(seen.marks, seen.maps[..., CHANNELS.index("nearness")])
            inside = marks[..., EYES_INSIDE]
            marks = self.evened(marks)
        both = torch.cat([self.maps(maps).view(batch, count, _MAPS), marks], 2)
        parts = [self.marks(both), marks]
        if self.people is not None:
            parts.append(self.people(seen.marks))
        frames = torch.cat(parts, 2)
        flow = seen.flow.flatten(0, 1).movedim(-1, 1).float().nan_to_num()
        fine = torch.asinh(flow * _FINE) / 3
        moved = self.pairs(torch.cat([flow, fine], 1)).view(batch, _PAIR * seen.flow.shape[1])
        moved = self.moved(moved) * seen.flow.isfinite().flatten(1).all(1, keepdim=True)
        with torch.autocast(maps.device.type, enabled=False):
            frames, goes = frames.float(), torch.cat([moved.float(), _paces(seen)], 1)
            shot = torch.cat([over_time(frames, seen.times, inside), goes], 1)
            meant, parts = shot[:, :0], [shot]
            if self.window is not None:
                meant = self.window(frames, goes, seen.times)
                asked = meant.detach().sigmoid()  # who judges is not to say what was meant
                parts += [over_window(frames, asked), framed(seen.marks, asked)]
            if self.crowd:
                parts.append(crowd_of(seen.marks, seen.maps))
            return Description(frames, torch.cat(parts, 1), meant)


def _paces(seen: Guided) -> Tensor:
    """How fast the camera turns between neighbouring frames: the fastest, the mean, how much it changes at
    most, [B, 3]; 0 where it is not known."""
    count = seen.times.shape[1]
    if not seen.flow.isfinite().all(dim=(1, 2, 3, 4)).any() or count < 3:
        return seen.times.new_zeros(len(seen.times), _PACES)
    middle = slice(FLOW // 2 - 1, FLOW // 2 + 1)
    gone = seen.flow[:, : count - 1, middle, middle].nan_to_num().mean((2, 3)).norm(dim=-1)  # half frames
    lens, seconds = (seen.marks[:, :-1, MARKS.index(name)].nan_to_num() for name in ("lens", "seconds"))
    turned = gone * _HALF_SENSOR / lens.exp() / (seen.times.diff() * seconds.exp()).clamp_min(1e-3)
    pace = torch.asinh(turned / _SLOW)
    return torch.stack([pace.amax(1), pace.mean(1), pace.diff().abs().amax(1)], 1)
