"""The checked storyboard: every name resolved, every default filled in, nothing left to look up.

Later stages read only this. Angles are radians, lengths metres, focal lengths mm, durations
seconds (exact fractions of frames are made later, from ``fps``).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TypeAlias

from .source import Span

#: An argument of a prop or cast call, evaluated: a number in metres / radians / seconds, or a word.
Argument: TypeAlias = float | str

MOVEMENTS = ("static", "follow", "push", "pull", "zoom-in", "zoom-out", "tilt-up", "tilt-down",
             "pan-left", "pan-right", "dolly-left", "dolly-right", "pedestal-up", "pedestal-down",
             "arc-left", "arc-right")  # fmt: skip
#: The nine families of the paper; a family stands for all its directions.
MOVEMENT_FAMILIES: dict[str, tuple[str, ...]] = {
    "static": ("static",),
    "follow": ("follow",),
    "push/pull": ("push", "pull"),
    "zoom": ("zoom-in", "zoom-out"),
    "tilt": ("tilt-up", "tilt-down"),
    "pan": ("pan-left", "pan-right"),
    "dolly": ("dolly-left", "dolly-right"),
    "pedestal": ("pedestal-up", "pedestal-down"),
    "arc": ("arc-left", "arc-right"),
}
#: Movements that are proposed where they are said; two of any may be joined, as in ``push+pan-left``.
FURTHER_MOVEMENTS = ("crane-up", "crane-down", "roll-left", "roll-right", "dolly-zoom-in", "dolly-zoom-out",
                     "handheld", "whip-pan-left", "whip-pan-right", "rack-focus")  # fmt: skip
#: The movement in which the focus goes from one to another.
RACK = "rack-focus"
SCALES = ("close-up", "medium", "full", "wide")
ANGLES = ("eye-level", "high-angle", "low-angle")
#: All sizes, from the closest; :data:`SCALES` are those that ``rig paper`` has, and so for the others.
SIZES = ("extreme-close-up", "big-close-up", "close-up", "medium-close-up", "medium", "cowboy", "medium-long",
         "full", "wide", "extreme-wide")  # fmt: skip
#: What a camera may be besides: over somebody's shoulder, through somebody's eyes, or of two and of all.
VIEWS = ("ots", "pov", "two-shot", "group")
ALL_ANGLES = (*ANGLES, "overhead", "worms-eye", "shoulder-level", "hip-level", "knee-level", "ground-level")


@dataclass(frozen=True)
class Character:
    """A member of the cast as the storyboard dresses them; ``arguments`` override the cast's defaults."""

    name: str
    cast: str
    arguments: tuple[tuple[str, Argument], ...]
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True)
class Target:
    """What a name resolved to.

    kind: ``object`` (path of an object, from the set's root), ``spot`` (an object's or room's path and,
        as last part, one of its spots), ``room``, ``character`` (path is the character's name alone) or,
        for the place of someone nobody placed, ``free`` (path is (): the first free spot of the scene)
    implied: whether it goes without saying, and is not written
    """

    kind: str
    path: tuple[str, ...]
    written: str
    span: Span = field(compare=False, repr=False)
    implied: bool = field(default=False, compare=False, repr=False)


@dataclass(frozen=True)
class Placement:
    """``anna at door facing window holding bag``: where a character is when the scene opens.

    holding: a thing of the set, or one that is :class:`Carried`; beside: at the side of ``at``, if that is
    somebody, rather than before them
    """

    character: str
    at: Target
    facing: Target | None
    posture: str  # standing | sitting | kneeling | crouching | lying
    span: Span = field(compare=False, repr=False)
    holding: Target | None = None
    beside: bool = False


@dataclass(frozen=True)
class Carried:
    """A thing somebody brings to a scene: it has no place in the set; as a target, its path is who and name.

    arguments: of the prop; held: in a hand when the scene opens; about: lying near them then. Else they have
    it with them, and it is not to be seen until an action needs it
    """

    who: str
    name: str
    prop: str
    arguments: tuple[tuple[str, Argument], ...] = ()
    held: bool = False
    about: bool = False

    @property
    def path(self) -> tuple[str, ...]:
        return (self.who, self.name)


@dataclass(frozen=True)
class Scene:
    """``scene kitchen = apartment.kitchen at dusk``; ``room`` is the path inside the set, () for all of it.

    placements: everyone who is placed or named in the scene, each once
    carried: what people bring, what is in a hand at first before the rest
    """

    name: str
    set: str
    room: tuple[str, ...]
    time: str  # dawn | day | dusk | night
    placements: tuple[Placement, ...]
    span: Span = field(compare=False, repr=False)
    carried: tuple[Carried, ...] = ()


@dataclass(frozen=True)
class Beat:
    """One ``(char do sth)``; several joined by ``+`` run at once.

    manner: how it is done (a word of :data:`runtime.motion.manner.MANNERS`), "" where nothing was said
    brought: what it is done with where the line names nothing: a thing somebody has about them, or in a hand
    who: where the script says who acts, if not at the beginning of ``span``
    ways: the action's variants that the line's words name; () for any
    said: what the boards say of it where it is not what is shown
    about: the thing that it is about where nobody acts, and that the camera is on unless told otherwise
    """

    character: str
    action: str
    target: Target | None
    second: Target | None
    span: Span = field(compare=False, repr=False)
    manner: str = ""
    brought: Target | None = None
    who: Span | None = field(default=None, compare=False, repr=False)
    ways: tuple[str, ...] = ()
    said: str = field(default="", compare=False)
    about: Target | None = None


@dataclass(frozen=True)
class Shot:
    """One camera on one story line, or on the scene alone.

    id: stable when lines are inserted or removed elsewhere
    movements, scales, angles: what may be proposed, canonical words; one entry where it was said
    lens: focal length range in mm, any_lens: whether the line says none; ease: λ choices
    duration: seconds or None for the action's own
    focus: the character or object the camera is about; None only where nobody is in the scene
    speed: action speed factor (1 as recorded)
    feelings: what shows on faces, as (character, word of :data:`runtime.motion.feelings.FEELINGS`)
    focus_to: whom or what the focus goes to, of a ``rack-focus``
    aperture: f-number of the final frames, 0 where everything is sharp
    view: one of :data:`VIEWS`, or ""; whose: over whose shoulder (``ots``) or through whose eyes (``pov``),
        or who is to be in the picture first (``two-shot``, ``group``)
    drawn: the id it would have without its name; "" for the same
    """

    id: str
    line: int  # 1-based, for people
    movements: tuple[str, ...]
    scales: tuple[str, ...]
    angles: tuple[str, ...]
    lens: tuple[float, float]
    ease: tuple[float, ...]
    duration: float | None
    roll: float
    focus: Target | None
    say: str | None
    note: str | None
    proposals: int
    takes: int
    speed: float
    style: str
    span: Span = field(compare=False, repr=False)
    feelings: tuple[tuple[str, str], ...] = ()
    view: str = ""
    whose: tuple[str, ...] = ()
    drawn: str = ""

    @property
    def drawn_as(self) -> str:
        """By what its cameras and performances are drawn at random: not by its name."""
        return self.drawn or self.id

    focus_to: Target | None = None
    aperture: float = 0.0
    any_lens: bool = False


@dataclass(frozen=True)
class Transition:
    """How a line joins the one before it: cut, dissolve, fade-out, fade-in or wipe; seconds.

    out: for a ``fade-in`` after a ``fade-out``, the seconds the line before takes to fade out
    """

    kind: str
    duration: float
    out: float = 0.0


@dataclass(frozen=True)
class StoryLine:
    """What happens, and the cameras on it. No beats: an establishing shot of the scene.

    transition: how this line joins the one before it
    """

    scene: int
    beats: tuple[Beat, ...]
    shots: tuple[Shot, ...]
    transition: Transition
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True)
class Storyboard:
    """A whole checked script. ``fps`` is (numerator, denominator); ``size`` is even pixels.

    ending: the fade-out after the last line, if there is one
    """

    title: str
    fps: tuple[int, int]
    size: tuple[int, int]
    seed: int
    rig: str  # cinema | paper
    style: str
    characters: tuple[Character, ...]
    scenes: tuple[Scene, ...]
    lines: tuple[StoryLine, ...]
    source_name: str
    ending: Transition | None = None
