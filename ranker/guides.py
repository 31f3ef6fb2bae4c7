"""What whoever draws a shot can tell of its pictures beside their colours: the guides.

A renderer knows of every pixel whom it shows, how far away that is and how the line of sight rises, and how
the camera makes the picture move; none of that has to be learnt from colours. Assumes nothing of who draws.
Real clips have no guides, and a network that was taught with and without them judges those by colour alone.
Plain numpy: whoever only draws need not load a network.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

SIDE = 32  # cells along a map
#: What maps hold of each cell, each 0..255: the share of the subject, of its head, of the front of that, of
#: other people and of nothing at all; how near it is (logarithms; 0 for nothing); how its line of sight rises
#: (128 for level, from straight down to straight up).
CHANNELS = ("subject", "head", "face", "others", "nothing", "nearness", "rise")
FLOW = 8  # cells along a field of the camera's motion
_APART = 3  # frames between those of the longer pairs


@dataclass(frozen=True, eq=False)
class Guides:
    """Of P shots with T frames each. ``guides[rows]`` are those of some of the shots.

    maps: uint8 [P, T, SIDE, SIDE, len(CHANNELS)]
    flow: float16 [P, pairs, FLOW, FLOW, 2], how far what is seen in a cell of the first frame of a pair has
        gone in the second by the camera's motion alone, in half frames to the right and down; NaN where not
        known, as when only some of the frames were drawn
    """

    maps: NDArray[np.uint8]
    flow: NDArray[np.float16]

    def __len__(self) -> int:
        return len(self.maps)

    def __getitem__(self, rows: slice | NDArray[np.integer]) -> Guides:
        return Guides(self.maps[rows], self.flow[rows])

    def mirrored(self) -> Guides:
        """Of the same shots in the mirror."""
        flow = self.flow[:, :, :, ::-1] * np.array((-1, 1), np.float16)
        return Guides(self.maps[:, :, :, ::-1], flow)

    def check(self, shots: int, frames: int, whole: int) -> None:
        """Raises ValueError where these are not of so many shots and frames, of ``whole`` that they have."""
        maps = (shots, frames, SIDE, SIDE, len(CHANNELS))
        flow = (shots, len(pairs(whole)), FLOW, FLOW, 2)
        if self.maps.shape != maps or self.maps.dtype != np.uint8 or self.flow.shape != flow:
            raise ValueError(
                f"guides: expected {maps} and {flow}, got {self.maps.shape} and {self.flow.shape}"
            )


def joined(parts: list[Guides]) -> Guides:
    """Guides of several sets of shots, one after the other."""
    return Guides(np.concatenate([g.maps for g in parts]), np.concatenate([g.flow for g in parts]))


def pairs(frames: int) -> list[tuple[int, int]]:
    """Pairs of frames whose motion is told: neighbours, some further apart for slow movements, both ends."""
    near = [(i, i + 1) for i in range(frames - 1)]
    far = [(i, i + _APART) for i in range(0, frames - _APART, 2)]
    ends = [(0, frames - 1)] if frames > 2 else []
    return list(dict.fromkeys(near + far + ends))
