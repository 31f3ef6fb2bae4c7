"""The subspaces cameras are drawn from: of each style what is fixed, what is free, and on what grid.

Section 3.2 of the paper as data, with the ranges of its section 4.1. Proposals take their ranges from here
(:mod:`vdsl.propose.shooting`, :mod:`vdsl.propose.drawing`), and ``vdsc why --space`` shows them.
"""

from __future__ import annotations

from dataclasses import dataclass

from .moves import RACK, family, of_camera

#: Azimuths φ of a fixed scale, evenly around the subject's heading (section 4.1).
AZIMUTHS = 8
#: How far a camera of ``rig cinema`` may stand off its azimuth, degrees.
ASIDE = 9.0
#: The same where two have to be in the picture, at the ends of a rack-focus, and of a place, whose people
#: look anywhere: half way to the next azimuth.
ALL_AROUND = 180.0 / AZIMUTHS
#: How far off the middle one who looks sideways may be put, share of the frame's width (``rig cinema``).
LEAD = 0.13
#: Focal lengths of films, mm (section 3.2).
FILM = (30.0, 80.0)
#: μ of what comes nearer, and of what goes away: below 1.05 nothing would be seen to move (section 4.1).
INWARDS, OUTWARDS = (0.5, 0.8), (1.05, 1.2)
#: Least degrees of an arc of ``rig cinema``: with less to go round there is room in more rooms, and time.
_LEAST_ARC = 60.0
_SEEN = 1.1  # least μ outwards of ``rig cinema``: less hardly reads as going back
#: A dolly zoom's: more, as it is the background that has to be seen to change.
_DOLLY_ZOOM = {"dolly-zoom-in": (0.5, 0.65), "dolly-zoom-out": (1.55, 2.15)}
#: Degrees turned (section 4.1 for the paper's).
TURNS = {
    "tilt": (30.0, 60.0),
    "pan": (30.0, 60.0),
    "arc": (90.0, 120.0),
    "crane": (18.0, 36.0),
    "roll": (15.0, 40.0),
    "whip-pan": (60.0, 100.0),
}
#: The least of a tilt or pan of ``rig cinema`` that keeps its subject in the picture, degrees.
LEAST_TURN = 12.0
#: Ways as shares of what the frame shows at the subject: a dolly's of its width, a pedestal's of its height.
TRAVELS = {"dolly": (0.22, 0.42), "pedestal": (0.28, 0.5)}
#: Shares of a dolly's or pedestal's way that lie before the framed position.
BEFORE = (0.0, 0.5, 1.0)
_TO_MU = ("push", "pull", "zoom", "dolly-zoom")


@dataclass(frozen=True)
class Variable:
    """A free variable. grid: the values it takes, or (): any from low to high; unit "" for a plain number."""

    symbol: str
    name: str
    unit: str
    low: float = 0.0
    high: float = 0.0
    grid: tuple[float | str, ...] = ()

    def __str__(self) -> str:
        """``μ ∈ [0.5, 0.8]``, ``λ ∈ {0.1, 1, 10}``."""
        unit = f" {self.unit}" if self.unit else ""
        if self.grid:
            values = ", ".join(v if isinstance(v, str) else f"{v:g}" for v in self.grid)
            return f"{self.symbol} ∈ {{{values}}}{unit}"
        return f"{self.symbol} ∈ [{self.low:g}, {self.high:g}]{unit}"


@dataclass(frozen=True)
class Subspace:
    """What a movement at a size and an angle is drawn from.

    fixed: (symbol, what it is held to) of everything that is not drawn; free: in the order they are drawn
    """

    fixed: tuple[tuple[str, str], ...]
    free: tuple[Variable, ...]


def mu_range(movement: str, cinema: bool = True) -> tuple[float, float]:
    """μ of pushes, pulls, zooms and dolly zooms."""
    if movement in _DOLLY_ZOOM:
        return _DOLLY_ZOOM[movement]
    if movement in ("push", "zoom-in"):
        return INWARDS
    return (_SEEN, OUTWARDS[1]) if cinema else OUTWARDS


def turn_range(kind: str, cinema: bool = True, above: bool = False) -> tuple[float, float]:
    """Degrees that a family turns. above: seen from overhead, where less of an arc is not seen as one"""
    low, high = TURNS.get(kind, TURNS["pan"])
    least = {"tilt": LEAST_TURN, "pan": LEAST_TURN, "arc": low if above else _LEAST_ARC} if cinema else {}
    return least.get(kind, low), high


def subspace(
    movement: str,
    scale: str,
    angle: str,
    lens: tuple[float, float],
    lam: tuple[float, ...],
    rig: str = "cinema",
    view: str = "",
    place: bool = False,
) -> Subspace:
    """Of a movement, or of two at once (``push+pan-left``). place: whose subject is a place

    lens: the line's range in mm; lam: its choices of λ; view: over a shoulder and through eyes, where the
    camera stands and with which lens follows from the two people
    """
    parts, cinema = of_camera(movement).split("+"), rig == "cinema"
    fixed = [
        ("p", "the subject, by a smoothed path" if cinema else f"the subject, at the height of {scale}"),
        ("r", f"solved so that {scale} fills the frame" if cinema else f"the share of h that {scale} has"),
        ("θ", f"{angle}, raised where it would be under the floor"),
        ("roll", "as the line says"),
    ]
    by_people = view in ("ots", "pov")
    if by_people:
        fixed[0:2] = [("p", "whom one sees"), ("r, φ, f", "by where the two stand")]
    degrees = tuple(360.0 * k / AZIMUTHS for k in range(AZIMUTHS))
    around = Variable("φ", "azimuth off the subject's heading", "°", grid=degrees)
    free: list[Variable] = [] if by_people else [around]
    if cinema and not by_people:
        aside = ALL_AROUND if place or RACK in movement.split("+") else ASIDE
        free += [
            Variable("Δφ", "off that azimuth", "°", -aside, aside),
            Variable("f", "focal length at the first frame", "mm", *lens, _only(lens)),
            Variable("lead", "off the middle, towards where nobody looks", "of the width", 0.0, LEAD),
        ]
    if not cinema:
        fixed.append(("f", "50 mm, or the nearest the line allows"))
    if of_camera(movement) not in ("static", "handheld"):
        free.append(Variable("λ", "easing", "", grid=lam))
    if len(parts) > 1:
        free.append(Variable("λ′", "easing of the second movement", "", grid=lam))
    if RACK in movement.split("+"):
        fixed.append(("s", "from the eyes or middle of one to those of the other"))
        free.append(Variable("λ″", "easing of the focus", "", grid=lam))
    own = [v for part in parts for v in _own(part, family(part), cinema, angle == "overhead")]
    return Subspace(tuple(fixed), (*free, *dict.fromkeys(own)))


def _only(lens: tuple[float, float]) -> tuple[float, ...]:
    """The grid of a line that names one lens."""
    return lens[:1] if lens[0] == lens[1] else ()


def _own(movement: str, kind: str, cinema: bool, above: bool) -> list[Variable]:
    """The variables a movement has besides those that all have."""
    ends = Variable("k", "frame the framing is of", "", grid=("start", "end"))
    out = [ends] if kind == "static" or (cinema and kind not in ("zoom", "follow", "tilt", "pan")) else []
    if kind in _TO_MU:
        out.append(
            Variable("μ", "distance, or width of the frame, at the end", "", *mu_range(movement, cinema))
        )
    if kind in TURNS:
        out.append(Variable("turn", "angle turned", "°", *turn_range(kind, cinema, above)))
    if kind in ("tilt", "pan"):
        out.append(Variable("ending", "on the subject, or off it", "", grid=("on", "off")))
    if kind in TRAVELS:
        of = "of the frame's width" if kind == "dolly" else "of the frame's height"
        out.append(Variable("way", "length of the way", of, *TRAVELS[kind]))
        out.append(Variable("before", "share of the way before the framing", "", grid=BEFORE))
    return out
