"""What one person does in a clip, over its time: keys, reaches, grasps, gazes, steps and the like.

Data alone; times are shares of the clip's own part of the shot (0..1), after any walking, standing up or
picking up that has to come first. Metres and radians. Words are those of :mod:`.words`.
"""

from __future__ import annotations

from dataclasses import dataclass

Point = tuple[float, float, float]


@dataclass(frozen=True)
class Track:
    """Keys of one channel (see :mod:`runtime.motion.channels`): times 0..1 rising, values in radians,
    metres or shares. Interpolated by minimum-jerk eases, so the value rests on each key."""

    channel: str
    times: tuple[float, ...]
    values: tuple[float, ...]


@dataclass(frozen=True)
class Beat:
    """An oscillation on top of a channel: ``count`` swings of ``amplitude`` between start and end (0..1)."""

    channel: str
    amplitude: float
    count: float
    start: float
    end: float
    phase: float = 0.0


@dataclass(frozen=True)
class Reach:
    """A hand goes to a place: leaves at ``start``, is there from ``arrive`` to ``leave``, is back at ``end``.

    hand: one of :data:`.words.HANDS`; to: one of :data:`.words.REACHABLE`
    offset: metres ahead of, to the outside of and above the place, seen from the person
    palm: where the palm faces: ``side`` (inward), ``down``, ``up``, ``ahead`` (fingers up)
    shake: metres up and down while there, ``times`` times; along: metres along the held thing, for ``held``
    lead: what is to be there: the ``palm``, or the far end (``point``) of what the hand holds
    """

    hand: str
    to: str
    start: float
    arrive: float
    leave: float
    end: float
    offset: Point = (0.0, 0.0, 0.0)
    palm: str = "side"
    shake: float = 0.0
    times: float = 0.0
    along: float = 0.0
    lead: str = "palm"


@dataclass(frozen=True)
class Grasp:
    """At ``time`` the hand takes (``take``), lets go of (``put``) or hands over (``pass``) or
    throws (``throw``) a thing; ``send``: the target flies off from where it lies, as kicked."""

    kind: str
    hand: str
    time: float


@dataclass(frozen=True)
class Tilt:
    """The held thing tips towards the palm by ``angle``: from ``start`` on, fully ``arrive``..``leave``,
    upright again at ``end``."""

    hand: str
    angle: float
    start: float
    arrive: float
    leave: float
    end: float


@dataclass(frozen=True)
class Gaze:
    """Eyes, then head, then body turn to a place between start and end. share: how far the head follows."""

    to: str
    start: float
    end: float
    share: float = 0.7


@dataclass(frozen=True)
class Talk:
    """The jaw moves in syllables between start and end, with small nods and brows on the stresses."""

    start: float
    end: float
    loudness: float = 1.0


@dataclass(frozen=True)
class Drive:
    """A hinged or sliding part (``target`` or ``second``) moves to ``openness`` 0..1 between two times."""

    target: str
    openness: float
    start: float
    end: float


@dataclass(frozen=True)
class FootMove:
    """A foot (``left`` or ``right``) leaves the floor at ``start`` and lands at ``end``; the body follows.

    ahead, out: where it lands, metres before and to its own side of where it stood; turn: radians to the left
    lift: how much higher it is swung, metres
    """

    foot: str
    start: float
    end: float
    ahead: float = 0.0
    out: float = 0.0
    turn: float = 0.0
    lift: float = 0.0


@dataclass(frozen=True)
class Jump:
    """Off the floor from ``start`` to ``end``, ``height`` metres up (0: as the time in the air makes it).

    feet: ``both``, or the one foot that hops; ahead, aside (to the left): metres travelled; turn: radians
    tuck: metres the feet are drawn up below the body
    """

    feet: str
    start: float
    end: float
    height: float = 0.0
    ahead: float = 0.0
    aside: float = 0.0
    turn: float = 0.0
    tuck: float = 0.0


@dataclass(frozen=True)
class Timeline:
    """Everything one person does in a clip."""

    tracks: tuple[Track, ...] = ()
    beats: tuple[Beat, ...] = ()
    reaches: tuple[Reach, ...] = ()
    grasps: tuple[Grasp, ...] = ()
    tilts: tuple[Tilt, ...] = ()
    gazes: tuple[Gaze, ...] = ()
    talks: tuple[Talk, ...] = ()
    drives: tuple[Drive, ...] = ()
    steps: tuple[FootMove, ...] = ()
    jumps: tuple[Jump, ...] = ()
