"""What a story line is proposed as: performances to film, and cameras to film them with."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ..cinema.track import CameraTrack

#: The variant of a line on which nobody acts.
STILL = "still"


@dataclass(frozen=True, eq=False)
class Performance:
    """One character over one shot.

    world_from_joint: float32 [T, J, 4, 4]
    position: float64 [T, 3], the point on the floor below the character (the paper's p)
    heading: float64 [T], radians
    """

    world_from_joint: NDArray[np.float32]
    position: NDArray[np.float64]
    heading: NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class StoryProposal:
    """One way to act a line: s = (a_n, p_{n,m}) of the paper's section 3.1.

    variant: name of the clip variant; path: index m of the path (0 where nobody travels)
    frames: T; performances: by character name, everyone in the scene; props: by object id of the
    movable objects, float32 [T, 4, 4] world_from_object
    interest: float64 [T, 3] each, points besides the subject that make the action readable: the thing in
        hand, the person spoken to
    """

    index: int
    variant: str
    path: int
    frames: int
    performances: dict[str, Performance]
    props: dict[int, NDArray[np.float32]]
    interest: tuple[NDArray[np.float64], ...] = ()


@dataclass(frozen=True, eq=False)
class CameraProposal:
    """One camera on one story proposal.

    params: the drawn variables as numbers and words, written to the take's JSON
    hidden_walls: bool [W], wild walls not drawn in this take
    unseen: whose eyes it looks through, who is not drawn; "" for nobody
    measures: geometry measured from the track, by name (see vdsl.cinema.measures)
    window: bool [F] on the frames measured, when its subject is meant to be in the picture
    key: the frame its size is asked at
    """

    index: int
    story: int
    movement: str
    scale: str
    angle: str
    params: dict[str, float | str]
    track: CameraTrack
    hidden_walls: NDArray[np.bool_]
    unseen: str = ""
    measures: dict[str, float] = field(default_factory=dict)
    window: NDArray[np.bool_] = field(default_factory=lambda: np.zeros(0, bool))
    key: int = 0


@dataclass(frozen=True, eq=False)
class Advice:
    """Why a shot has no camera as its line says, in words, and words with which it would have some.

    faulty: there are some, but none without a fault
    """

    why: str
    instead: tuple[str, ...]
    faulty: bool = False


@dataclass(frozen=True, eq=False)
class ProposalGrid:
    """S · C proposals of one shot, and how many were thrown out for which reason.

    let_in: how many of the cameras do not quite keep to the line, but nothing better was left
    advice: where there is none that does
    """

    shot: str
    subject: str | None
    story: tuple[StoryProposal, ...]
    cameras: tuple[CameraProposal, ...]
    considered: int
    rejected: dict[str, int]
    let_in: int = 0
    advice: Advice | None = None
