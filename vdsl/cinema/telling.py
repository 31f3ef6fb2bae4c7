"""Measures in words: what each is, what is good about it, and in what one take is better than another.

Assumes the measures of :mod:`vdsl.cinema.measures`, by name. Guarantees that what is said adds up: the
points of the parts, less the penalties, are the geometry score.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from .flaws import CRITERIA, gravity
from .score import PENALTIES, WEIGHTS, geometry_score, parts

Measures = Mapping[str, float]


@dataclass(frozen=True)
class Note:
    """A measure for people: its unit, what is good about it, and between which values it is so."""

    unit: str
    good: str
    low: float
    high: float


_ANY = float("inf")
#: Of every measure; shares are of one, 1 is all.
NOTES = {
    "visibility": Note("share", "nothing hides the subject", 0.9, 1.0),
    "picture_visibility": Note("share", "nothing hides the subject in the picture", 0.85, 1.0),
    "ends_visible": Note("share", "nothing hides it at the first frame or the last", 0.8, 1.0),
    "head_visible": Note("share", "the head is seen all the time", 0.9, 1.0),
    "in_frame": Note("share", "head and middle stay in the frame", 0.9, 1.0),
    "size_error": Note("log", "the size is the one asked for", 0.0, 0.1),
    "size_drift": Note("log", "the size holds", 0.0, 0.25),
    "headroom": Note("frame height", "a little air over the head", 0.02, 0.3),
    "headroom_error": Note("frame height", "as much air as the size wants", 0.0, 0.06),
    "head_cut": Note("frame height", "the head is not cut", 0.0, 0.02),
    "head_cropped": Note("share", "no border runs through head or body at the start or the end", 0.0, 0.3),
    "feet_cut": Note("frame height", "the feet are not cut", 0.0, 0.02),
    "view": Note("share", "everybody the view is of is seen", 0.9, 1.0),
    "lead_room": Note("−1..1", "more room ahead of the face than behind", -0.02, 1.0),
    "thirds_error": Note("frame height", "the eyes are on the upper third", 0.0, 0.12),
    "interest": Note("share", "what is acted on, or with whom, is seen too", 0.6, 1.0),
    "empty": Note("share", "there is always something to see", 0.0, 0.05),
    "walk_missed": Note("share", "little of the walk is missed", 0.0, 0.3),
    "act_missed": Note("share", "little of what they do is missed", 0.0, 0.3),
    "hands_missed": Note("share", "little of what hands do is missed", 0.0, 0.5),
    "gesture_lost": Note("share", "what hands do stands out from the body", 0.0, 0.7),
    "face_covered": Note("share", "nothing of theirs, and nothing they hold, is before the face", 0.0, 0.1),
    "legible": Note("share", "the face is read: seen, turned to the camera, large", 0.5, 1.0),
    "heads": Note("share", "all heads are seen", 0.75, 1.0),
    "together": Note("share", "heads are apart from each other", 0.0, 0.3),
    "hands_shown": Note("share", "a hand is seen", 0.5, 1.0),
    "company_cut": Note("share", "others are whole, with air around them", 0.0, 0.5),
    "foreground": Note("share", "nothing near is in the way", 0.0, 0.1),
    "face": Note("cosine", "the face is turned to the camera", 0.0, 1.0),
    "clearance": Note("m", "the camera has room around it", 0.5, _ANY),
    "speed": Note("m/s", "the camera is not hurried", 0.0, 2.0),
    "angular_speed": Note("°/s", "it turns calmly", 0.0, 45.0),
    "jerk": Note("m/s³", "it moves evenly", 0.0, 15.0),
    "horizon": Note("°", "the horizon is as asked", 0.0, 0.1),
    "backdrop_gap": Note("share", "no wall is missing behind", 0.0, 0.05),
    "floor_gap": Note("share", "the floor reaches to the picture's border", 0.0, 0.15),
    "height": Note("m", "how high over the floor the camera is", 0.0, _ANY),
    "elevation": Note("°", "how far the camera looks down", -90.0, 90.0),
}
#: Of every part of the score: what the better take has, what the worse one, and the measure to quote.
_COMPARED = {
    "legible": ("the face is read better", "the face is read less well", "legible"),
    "heads": ("more heads are seen", "fewer heads are seen", "heads"),
    "apart": ("heads run together less", "heads run together more", "together"),
    "hands": ("more of the hands", "less of the hands", "hands_shown"),
    "visibility": ("less hidden", "more hidden", "visibility"),
    "in_frame": ("the subject stays longer in the frame", "the subject leaves the frame more", "in_frame"),
    "framing": ("better framed", "not so well framed", "in_frame"),
    "headroom": ("headroom nearer to the size's", "headroom farther from the size's", "headroom"),
    "lead_room": ("more lead room", "less lead room", "lead_room"),
    "thirds": ("eyes nearer the upper third", "eyes farther from the upper third", "thirds_error"),
    "clearance": ("more room around the camera", "less room around the camera", "clearance"),
    "steadiness": ("steadier", "less steady", "angular_speed"),
    "backdrop_gap": ("less wall missing behind", "more wall missing behind", "backdrop_gap"),
    "floor_gap": ("less to see of where the set ends", "more to see of where the set ends", "floor_gap"),
    "face_covered": (
        "arms, and what they hold, less before the face",
        "arms, or what they hold, more before the face",
        "face_covered",
    ),
    "foreground": ("less in the way", "more in the way", "foreground"),
    "empty": ("less empty", "emptier", "empty"),
    "company_cut": ("others less cut off", "others more cut off", "company_cut"),
    "logit": ("liked better by the ranker", "liked less by the ranker", "logit"),
    "taste": ("more to your taste", "less to your taste", "taste"),
}

#: Of every measure that may be a fault: what is wrong then.
FAULTY = {
    "visibility": "something hides {whom}",
    "head_visible": "the head is hidden for part of it",
    "ends_visible": "something hides {whom} at the first frame or the last",
    "face": "{whom} is seen from behind",
    "in_frame": "{whom} leaves the frame",
    "view": "not everybody is seen whom the view is of",
    "lead_room": "there is little room ahead of the face",
    "clearance": "the camera has hardly any room",
    "foreground": "something near is in the way",
    "face_covered": "an arm, the chest, or what {whom} holds, is before the face",
    "backdrop_gap": "a wall is missing behind",
    "walk_missed": "much of the walk is missed",
    "act_missed": "what {whom} does is over when the camera comes to it",
    "head_cut": "the head is cut",
    "feet_cut": "the feet are cut",
    "head_cropped": "a border runs through head or body at the start or the end",
    "size_error": "the size is not quite the one asked for",
    "empty": "there is nothing to see for a while",
    "company_cut": "somebody else is seen without their head",
    "headroom_error": "there is too much or too little air over the head",
    "thirds_error": "the eyes are far off the upper third",
    "jerk": "the camera jerks",
    "speed": "the camera goes too fast",
}


def is_good(name: str, value: float) -> bool:
    """Whether a measure is within what its note calls good."""
    note = NOTES[name]
    return note.low - 1e-9 <= value <= note.high + 1e-9


@dataclass(frozen=True)
class Term:
    """One addend of the geometry score. value: 0..1, best 1; points: value times weight, before penalties."""

    part: str
    value: float
    weight: float

    @property
    def points(self) -> float:
        return self.value * self.weight


def terms(measures: Measures) -> tuple[Term, ...]:
    """What adds to the geometry score, in its order."""
    values = parts(measures)
    return tuple(Term(name, float(values[name]), weight) for name, weight in WEIGHTS.items())


def penalties(measures: Measures) -> dict[str, float]:
    """What the score is multiplied by, each 1 where nothing is wrong."""
    return {name: 1.0 - share * float(measures[name]) for name, share in PENALTIES.items()}


def advantages(
    measures: Measures,
    other: Measures,
    judged: Mapping[str, float] | None = None,
    scale: float = 1.0,
    flaw: float = 0.0,
) -> dict[str, float]:
    """By how much each part puts one take before another, largest first; negative where it is behind.

    In points of the geometry score times ``scale``, and ``flaw`` times the gravity of faults in every
    criterion; judged: by how much the discriminator (``logit``) and the writer's ``taste`` put it before
    """
    a, b = terms(measures), terms(other)
    pa, pb = penalties(measures), penalties(other)
    kept = (geometry_score(measures) + geometry_score(other)) / 2
    total = max((sum(t.points for t in a) + sum(t.points for t in b)) / 2, 1e-9)
    out = {x.part: scale * (x.points - y.points) * kept / total for x, y in zip(a, b, strict=True)}
    out |= {name: scale * kept * (pa[name] - pb[name]) / max((pa[name] + pb[name]) / 2, 1e-9) for name in pa}
    here, there = gravity(measures), gravity(other)
    for name in CRITERIA if flaw else ():
        out[name] = out.get(name, 0.0) + flaw * (float(there[name]) - float(here[name]))
    out |= judged or {}
    return dict(sorted(out.items(), key=lambda item: -item[1]))


def compared(part: str, measures: Measures, other: Measures, better: bool, rival: str = "") -> str:
    """``more lead room than take 2 (0.18 against 0.09)``; both may hold what was judged too."""
    more, less, quoted = _COMPARED[part]
    if part == "steadiness" and abs(measures["angular_speed"] - other["angular_speed"]) < 2.0:
        quoted = "jerk" if abs(measures["speed"] - other["speed"]) < 0.1 else "speed"
    words = more if better else less
    if rival:
        words += f" than {rival}"
    one, two = number(quoted, measures[quoted]), number(quoted, other[quoted])
    return words if one == two else f"{words} ({one} against {two})"


def number(name: str, value: float) -> str:
    """A measure as people read it: shares in percent, the rest with its unit."""
    unit = NOTES[name].unit if name in NOTES else ""
    if unit == "share":
        return f"{100 * value:.0f} %"
    if unit in ("", "−1..1", "cosine", "log", "frame height"):
        return f"{value:.2f}".replace("-", "−")
    return f"{value:.1f} {unit}".replace("-", "−").replace(" °", "°")


def faults(measures: Measures, movement: str) -> tuple[str, ...]:
    """What is plainly wrong with a take, worst first, as ``cuts the feet``."""
    m = measures
    near = movement in ("push", "zoom-in")  # meant to come so near that something is cut
    seen, covered = number("visibility", m["visibility"]), number("foreground", m["foreground"])
    asked = (
        (m["visibility"] < 0.8, f"hides part of the subject ({seen} seen)"),
        (m["feet_cut"] > 0.15 and not near, "cuts the feet"),
        (m["head_cut"] > 0.02 and not near, "cuts the head"),
        (m["face"] < -0.4, "sees the back of the head"),
        (m["walk_missed"] > 0.5, f"misses {number('walk_missed', m['walk_missed'])} of the walk"),
        (m["act_missed"] > 0.5, f"misses {number('act_missed', m['act_missed'])} of what they do"),
        (
            m["face_covered"] > 0.4,
            f"has an arm, or what they hold, before {number('face_covered', m['face_covered'])} of the face",
        ),
        (m["company_cut"] > 0.5, "shows somebody else without their head"),
        (m["foreground"] > 0.2, f"has something near over {covered} of the picture"),
        (m["backdrop_gap"] > 0.1, "misses a wall behind the subject"),
        (m["floor_gap"] > 0.25, "shows where the set ends"),
        (m["lead_room"] < -0.3, f"leaves no room ahead of the face ({number('lead_room', m['lead_room'])})"),
        (m["angular_speed"] > 70.0, f"turns fast ({number('angular_speed', m['angular_speed'])})"),
        (m["speed"] > 3.0, f"moves fast ({number('speed', m['speed'])})"),
        (m["clearance"] < 0.2, f"stands only {number('clearance', m['clearance'])} from something"),
    )
    return tuple(words for holds, words in asked if holds)
