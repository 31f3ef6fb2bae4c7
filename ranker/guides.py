"""What whoever draws a shot can tell of its pictures beside their colours: the guides.

A renderer knows of every pixel whom it shows, how far away that is and how the line of sight rises, how
the camera makes the picture move, and where in the picture the subject's head, waist and feet are, in it or
out of it; none of that has to be learnt from colours. Assumes nothing of who draws.
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
NEAREST, FARTHEST = 0.25, 64.0  # metres that nearness of 255 and of 1 stand for
#: Points that marks are of: the subject's, of several people those halfway between them but for the hands,
#: which are of who acts, and two of what else matters, as who is spoken to.
POINTS = (
    "top",
    "crown",
    "eyes",
    "chin",
    "pocket",
    "waist",
    "thigh",
    "knees",
    "feet",
    "hand_l",
    "hand_r",
    "other_1",
    "other_2",
)
#: So many people are told of one by one: those a shot is about if they are several, or who are in a place,
#: who acts first; then others. Of each the points of these names.
PEOPLE = 3
PERSON_POINTS = ("crown", "eyes", "pocket", "waist", "feet")
#: All points marks are of, in their order: the subject's, then those of the people.
ALL_POINTS = (*POINTS, *(f"{point}_{k + 1}" for k in range(PEOPLE) for point in PERSON_POINTS))
#: Marks that every shot has, whoever is in it. Of each point how far it is to the right and to the top, in
#: half frames from the middle, no further than 3, and by how much nearer than the point (log) what is seen in
#: its place is, 0 where that is the subject itself; of a point behind the camera the side it lies on, at 3.
#: Where the face points, to the right, up and away.
#: Logarithms: of the focal length (mm) by the distance of the waist, of that distance (metres) and of the
#: focal length. Metres of the camera above the eyes; radians it leans to the right; the logarithm of the
#: seconds the shot lasts. By how much nearer than the eyes (log) what is seen in their place is, the subject
#: itself too, as a hand before the face; and 1 where walls of the set are left out, which the camera would
#: stand behind, 0 else.
SUBJECT_MARKS = (
    *(f"{what}{point}" for point in POINTS for what in ("right_", "up_", "covered_")),
    *("right_face", "up_face", "away_face", "size", "distance", "lens", "over", "right_roll", "seconds"),
    *("before_eyes", "open"),
)
#: Marks of who is told of one by one, and of how the camera goes. Of each point the same as above, with their
#: own body and that of others alike counting as what is seen in its place; where the face points to the
#: right, and the cosine between it and the way to the camera; how far the eyes are away (log metres); and 1
#: where the shot is about them, 0 where not. Then how fast the camera goes, turns, and how unevenly it goes
#: at most between half the way from the judged frame before and half the way to the next: square roots of
#: metres a second, of radians a second, and of metres by the third power of a second. How far it is to the
#: nearest thing, drawn wall or person, in metres, at most 1. And for which share of that time the hands of
#: who acts are higher than hands that hang.
PEOPLE_MARKS = (
    *(f"{what}{point}" for point in ALL_POINTS[len(POINTS) :] for what in ("right_", "up_", "covered_")),
    *(f"{what}_{k + 1}" for k in range(PEOPLE) for what in ("right_face", "turned", "distance", "about")),
    *("pace", "turning", "jerk", "room", "work_l", "work_r"),
)
#: All marks of a frame. In the mirror those of ``right`` change their sign.
MARKS = (*SUBJECT_MARKS, *PEOPLE_MARKS)
_TURNED = np.array([name.startswith("right") for name in MARKS])
_HANDS = {"l": "r", "r": "l"}  # a left hand in the mirror is a right one
_SWAPPED = [MARKS.index(n[:-1] + _HANDS[n[-1]] if n.endswith(("_l", "_r")) else n) for n in MARKS]


@dataclass(frozen=True, eq=False)
class Guides:
    """Of P shots with T frames each. ``guides[rows]`` are those of some of the shots.

    maps: uint8 [P, T, SIDE, SIDE, len(CHANNELS)]
    flow: float16 [P, pairs, FLOW, FLOW, 2], how far what is seen in a cell of the first frame of a pair has
        gone in the second by the camera's motion alone, in half frames to the right and down; NaN where not
        known, as when only some of the frames were drawn
    marks: float16 [P, T, len(MARKS)]; NaN for what there is not: what is out of the frame is not covered by
        anything
    """

    maps: NDArray[np.uint8]
    flow: NDArray[np.float16]
    marks: NDArray[np.float16]

    @classmethod
    def unknown(cls, shots: int, frames: int) -> Guides:
        """Of shots that nothing is told of: zeros, and motion that is not known."""
        flow = np.full((shots, len(pairs(frames)), FLOW, FLOW, 2), np.nan, np.float16)
        marks = np.zeros((shots, frames, len(MARKS)), np.float16)
        return cls(np.zeros((shots, frames, SIDE, SIDE, len(CHANNELS)), np.uint8), flow, marks)

    def __len__(self) -> int:
        return len(self.maps)

    def __getitem__(self, rows: slice | NDArray[np.integer]) -> Guides:
        return Guides(self.maps[rows], self.flow[rows], self.marks[rows])

    def mirrored(self) -> Guides:
        """Of the same shots in the mirror."""
        flow = self.flow[:, :, :, ::-1] * np.array((-1, 1), np.float16)
        marks = np.where(_TURNED, -self.marks, self.marks)[..., _SWAPPED]
        return Guides(self.maps[:, :, :, ::-1], flow, marks)

    def mirrored_where(self, which: NDArray[np.bool_]) -> Guides:
        """The same with some of the shots in the mirror; which: [P]."""
        out = Guides(self.maps.copy(), self.flow.copy(), self.marks.copy())
        some = self[np.flatnonzero(which)].mirrored()
        out.maps[which], out.flow[which], out.marks[which] = some.maps, some.flow, some.marks
        return out

    def check(self, shots: int, frames: int, whole: int) -> None:
        """Raises ValueError where these are not of so many shots and frames, of ``whole`` that they have."""
        maps = (shots, frames, SIDE, SIDE, len(CHANNELS))
        flow = (shots, len(pairs(whole)), FLOW, FLOW, 2)
        marks = (shots, frames, len(MARKS))
        found = self.maps.shape, self.flow.shape, self.marks.shape
        if found != (maps, flow, marks) or self.maps.dtype != np.uint8:
            expected = ", ".join(map(str, (maps, flow, marks)))
            raise ValueError(f"guides: expected {expected}, got {', '.join(map(str, found))}")


def joined(parts: list[Guides]) -> Guides:
    """Guides of several sets of shots, one after the other."""
    maps, flow, marks = (
        np.concatenate(found) for found in zip(*((g.maps, g.flow, g.marks) for g in parts), strict=True)
    )
    return Guides(maps, flow, marks)


def pairs(frames: int) -> list[tuple[int, int]]:
    """Pairs of frames whose motion is told: neighbours, some further apart for slow movements, both ends."""
    near = [(i, i + 1) for i in range(frames - 1)]
    far = [(i, i + _APART) for i in range(0, frames - _APART, 2)]
    ends = [(0, frames - 1)] if frames > 2 else []
    return list(dict.fromkeys(near + far + ends))
