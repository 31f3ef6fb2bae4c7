"""What a network makes of the guides of shots: a small one beside that for pictures (:mod:`ranker.guides`).

It is quick to teach: a shot's guides are a fiftieth of its pictures. Assumes guides of the frames that are
looked at, or zeros in their maps where a shot has none. Guarantees that a shot without guides is judged as
if there were no such network.
"""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

import torch
from torch import Tensor, nn

from .guides import CHANNELS, FLOW, SIDE, Guides, pairs

_FRAME, _PAIR, _MOVED = 256, 64, 256  # numbers that describe a frame, a pair of frames, all pairs
_FINE = 20.0  # by what motion is multiplied, so that slow ones are seen


class Guided(NamedTuple):
    """Guides as the network takes them.

    maps: uint8 [B, T, SIDE, SIDE, channels]; flow: [B, pairs, FLOW, FLOW, 2]; times: [B, T] of the maps, 0..1
    """

    maps: Tensor
    flow: Tensor
    times: Tensor

    @classmethod
    def of(cls, guides: Guides, times: Tensor) -> Guided:
        device = times.device
        maps = torch.from_numpy(guides.maps).to(device)
        return cls(maps, torch.from_numpy(guides.flow).to(device).float(), times.expand(len(guides), -1))

    @property
    def known(self) -> Tensor:
        """Which shots have guides, bool [B]: no line of sight is told by a 0."""
        return (self.maps[..., CHANNELS.index("rise")] != 0).flatten(1).any(1)


class GuideNet(nn.Module):
    """A description of every frame by its maps, and of the camera's motion by its flow.

    frames: of a whole shot
    """

    def __init__(self, frames: int) -> None:
        super().__init__()
        widths = (len(CHANNELS), 48, 96, 128)
        steps: list[nn.Module] = []
        for before, after in pairwise(widths):
            steps += [nn.Conv2d(before, after, 3, 2, 1), nn.GroupNorm(8, after), nn.ReLU()]
        last = widths[-1] * (SIDE // 2 ** (len(widths) - 1)) ** 2
        self.maps = nn.Sequential(*steps, nn.Flatten(), nn.Linear(last, _FRAME), nn.ReLU())
        self.pairs = nn.Sequential(
            *(nn.Conv2d(4, 32, 3, 1, 1), nn.ReLU(), nn.Conv2d(32, 32, 3, 2, 1), nn.ReLU(), nn.Flatten()),
            *(nn.Linear(32 * (FLOW // 2) ** 2, _PAIR), nn.ReLU()),
        )
        self.moved = nn.Sequential(nn.Linear(_PAIR * len(pairs(frames)), _MOVED), nn.ReLU(), nn.Dropout(0.2))
        self.described, self.motion = _FRAME, _MOVED

    def forward(self, seen: Guided) -> tuple[Tensor, Tensor]:
        """Descriptions of frames float32 [B, T, described], and of motion [B, motion]; 0 where not known."""
        batch, count = seen.maps.shape[:2]
        maps = seen.maps.flatten(0, 1).movedim(-1, 1).float() / 255
        frames = self.maps(maps).view(batch, count, self.described)
        flow = seen.flow.flatten(0, 1).movedim(-1, 1).float().nan_to_num()
        fine = torch.asinh(flow * _FINE) / 3
        moved = self.pairs(torch.cat([flow, fine], 1)).view(batch, _PAIR * seen.flow.shape[1])
        return frames, self.moved(moved) * seen.flow.isfinite().flatten(1).all(1, keepdim=True)
