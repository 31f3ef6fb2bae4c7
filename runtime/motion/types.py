"""What motion takes and gives: actors, tasks, clips and the performed scene.

Metres, radians, seconds, Z up, heading 0 is +X and counter-clockwise. A clip is data alone: the
engine knows mechanisms (keys, gait, reach, take, release, tilt, seat, gaze), never names of actions.
Hands are ``l`` and ``r``. Times inside a clip are fractions of its own part of the shot (0..1), after
any walking, standing up or picking up that has to come first.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from runtime.body.skeleton import Skeleton
from runtime.world import Hinge, Stairs

from .timeline import Timeline

Point = tuple[float, float, float]


@dataclass(frozen=True)
class ActorState:
    """Where and how a person is between two shots.

    position: point on the floor below the hips; heading: radians
    kept: the pose that stays from the action before
    posture: one of :data:`.words.POSTURES`; ``floor`` sits on the ground, ``lying`` is on the back (the head
        away from the heading), ``prone`` on the belly
    seat: middle of the surface sat or lain on
    held: (hand, object id) for each thing in a hand
    """

    position: Point
    heading: float
    posture: str = "standing"
    seat: Point | None = None
    held: tuple[tuple[str, int], ...] = ()
    kept: Kept | None = None


@dataclass(frozen=True)
class Kept:
    """An action whose last pose stays: a lean goes on into the next shot.

    since: seconds before the shot at which its timeline began; duration: seconds it took
    hands: hand words to ``l`` / ``r``; partner: the other person's name
    """

    timeline: Timeline
    since: float
    duration: float
    hands: tuple[tuple[str, str], ...]
    target: TargetPoint | None
    second: TargetPoint | None
    partner: str | None


@dataclass(frozen=True, eq=False)
class Actor:
    skeleton: Skeleton
    state: ActorState


@dataclass(frozen=True)
class TargetPoint:
    """What an action is aimed at, in the world.

    position: contact point: a grip, the top a thing is put on, a person's hand height
    gaze: where one looks when looking at it; object: its id where it is a movable thing
    facing: heading a person takes to use it; seat: middle of the seat's surface, if it can be sat on
    character: the person's name, if it is one
    bed: middle of the surface, and heading of the head on it, if it can be lain on
    """

    position: Point
    gaze: Point
    object: int | None = None
    facing: float | None = None
    seat: Point | None = None
    character: str | None = None
    bed: tuple[Point, float] | None = None


@dataclass(frozen=True, eq=False)
class PropState:
    """A movable thing: float64 [4, 4] world_from_object, its grip in object coordinates, and who holds it.

    home: where it stood before it was taken, and is put back to where no other place is named
    hinge: how it moves, for a part of something (which cannot be carried); open: how far it is open, 0..1
    """

    world_from_object: NDArray[np.float64]
    grip: Point
    holder: tuple[str, str | None] | None = None
    home: Point | None = None
    hinge: Hinge | None = None
    open: float = 0.0

    @property
    def stands(self) -> Point | None:
        """Where it stands, or last stood; None for a thing that has been held all along."""
        if self.holder is not None:
            return self.home
        x, y, z = (float(v) for v in self.world_from_object[:3, 3])
        return (x, y, z)


# --- clips --------------------------------------------------------------------------------


@dataclass(frozen=True)
class GaitStyle:
    """What is particular about a way of walking. Metres (for a person of 1.7 m) and radians.

    lift: how much higher feet are swung; bounce: up and down at every step; sway: from side to side
    lean: forward; crouch: lower; arms: factor on their swing; width: factor on the distance of the feet
    limp: share by which the left leg is spared; toes: 0..1, on tiptoe; stiff: 0..1, no roll of the foot
    facing: where the face looks on the way: ``ahead``, ``back``, ``left`` or ``right``
    """

    lift: float = 0.0
    bounce: float = 0.0
    sway: float = 0.0
    lean: float = 0.0
    crouch: float = 0.0
    arms: float = 1.0
    width: float = 1.0
    limp: float = 0.0
    toes: float = 0.0
    stiff: float = 0.0
    facing: str = "ahead"


@dataclass(frozen=True)
class Variant:
    """One way to do an action.

    duration: seconds of the clip's own part; tempo and amplitude are already worked in
    stride: factor on the step length and the time between steps of walking there: (length, time)
    gait: what is particular about walking there
    partner: what the other person of the action does meanwhile (empty: goes on idling)
    """

    name: str
    duration: float
    timeline: Timeline
    partner: Timeline = field(default_factory=Timeline)
    stride: tuple[float, float] = (1.0, 1.0)
    gait: GaitStyle = field(default_factory=GaitStyle)


@dataclass(frozen=True, eq=False)
class Capture:
    """Motion captured elsewhere, on our joints, as if its first frame stood over the origin facing +X.

    turns: float32 [N, J, 3, 3], of each joint in the world from the bind pose; known: bool [J], joints it has
    root: float64 [N, 3], the hips, in lengths of the leg (hips to ankle)
    """

    fps: float
    turns: NDArray[np.float32]
    known: NDArray[np.bool_]
    root: NDArray[np.float64]


@dataclass(frozen=True)
class ActionClip:
    """An action ready to be performed.

    travel: ``none``, ``walk``, ``run``, ``skip`` or ``crawl``: how one gets there when a path is given
    seat: ``down`` sits on the target's seat, ``up`` stands up, ``keep`` leaves the posture as it is
    needs: ``target``/``second``/``any``: that thing has to be in a hand first; ``none``
    faces: what the body turns to before it begins: ``target``, ``second``, ``away`` or ``none``
    lead: whether the clip also plays while walking there (a talk on the way) rather than after it
    feeling: what shows on the face, a word of :data:`runtime.motion.feelings.FEELINGS`, or ""
    posture: one of :data:`.words.POSTURES` taken before the clip's own part, "" to stay as one is
    posture_time: seconds it takes (0: as long as it naturally does); rises: stands up again afterwards
    apart: metres between the two people of the action, 0 for talking distance; hold: the last pose stays
    needs_hand: ``left`` or ``right`` where what it needs has to be in that hand, "" for either
    capture: motion that the body goes through in the clip's own part
    goes: whether one gets to the target first even where the clip's own part needs nothing from it
    roams: whether it is to go somewhere, even where no target says where to
    against: metres from what the back is against to the feet, 0 where it is against nothing
    """

    name: str
    variants: tuple[Variant, ...]
    travel: str = "walk"
    seat: str = "keep"
    needs: str = "none"
    faces: str = "none"
    turn: float = 0.0
    lead: bool = False
    feeling: str = ""
    posture: str = ""
    posture_time: float = 0.0
    rises: bool = False
    apart: float = 0.0
    needs_hand: str = ""
    hold: bool = False
    capture: Capture | None = None
    goes: bool = False
    roams: bool = False
    against: float = 0.0

    def variant(self, name: str) -> Variant:
        """The variant of that name, or the first."""
        return next((v for v in self.variants if v.name == name), self.variants[0])


# --- performing ---------------------------------------------------------------------------


@dataclass(frozen=True)
class Passage:
    """A door opened on the way: where one stands for it, with which heading, and where its handle is."""

    object: int
    place: Point
    heading: float
    handle: Point


@dataclass(frozen=True, eq=False)
class Task:
    """What one person is asked to do.

    variant: name of one of the clip's; path: float64 [K, 2] floor points from where the person is, or None
    arrive_heading: heading to end the path with; None: as the path ends, or facing the target
    speed: 1 as designed, 1.5 half as fast again; duration: seconds of the whole shot to fill, or None
    fetch: float64 [K, 2] way to the thing the clip needs in a hand, walked before ``path`` (which then starts
        where this ends); no points at all: it is taken from here, before going; None: it is taken on arrival
    fetch_heading: heading to take it with
    manner: how it is done, a word of :data:`runtime.motion.manner.MANNERS`, or ""
    stairs: flights of the set, on whose treads feet are set
    passages: doors that are shut on these ways, in their order; each lies on one of them
    """

    clip: ActionClip
    variant: str = ""
    path: NDArray[np.float64] | None = None
    arrive_heading: float | None = None
    target: TargetPoint | None = None
    second: TargetPoint | None = None
    speed: float = 1.0
    duration: float | None = None
    fetch: NDArray[np.float64] | None = None
    fetch_heading: float | None = None
    manner: str = ""
    stairs: tuple[Stairs, ...] = ()
    passages: tuple[Passage, ...] = ()


@dataclass(frozen=True, eq=False)
class Touches:
    """What one person touches and looks at, as intended; for whoever measures how well it came out.

    planted: bool [2, T], left foot first: stands still on something; ground: [2, T] height of that
    hands: [2, T], 1 while a palm is to be at its goal [2, T, 3]; palms: [2, T, 3], where it is
    gaze: [T], 1 while the eyes are on what is looked at [T, 3]
    """

    planted: NDArray[np.bool_]
    ground: NDArray[np.float64]
    hands: NDArray[np.float64]
    goals: NDArray[np.float64]
    palms: NDArray[np.float64]
    gaze: NDArray[np.float64]
    looked_at: NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class SceneMotion:
    """Everybody over one shot.

    frames: T; world_from_joint: per actor float32 [T, J, 4, 4]
    position: per actor float64 [T, 3], floor point below the hips; heading: per actor float64 [T]
    props: by object id, float32 [T, 4, 4] world_from_object
    end_actors, end_props: the state the next shot begins with
    touches: per actor, what is touched and looked at
    """

    frames: int
    world_from_joint: dict[str, NDArray[np.float32]]
    position: dict[str, NDArray[np.float64]]
    heading: dict[str, NDArray[np.float64]]
    props: dict[int, NDArray[np.float32]]
    end_actors: dict[str, ActorState]
    end_props: dict[int, PropState]
    touches: dict[str, Touches]
