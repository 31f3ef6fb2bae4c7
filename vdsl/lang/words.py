"""The words of the camera: what each may be called, and what it stands for.

Canonical words are those of :mod:`vdsl.lang.ir`. Words are compared folded: lower case, ``_`` and
spaces as ``-``. The longest run of words wins, so ``tilt up`` is one word.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from . import ir
from .english import PAST

PAPER_SCALES = ("close-up", "medium", "full")


@dataclass(frozen=True)
class Meaning:
    """What a word means: its slot (movement, scale or angle) and the canonical words it stands for."""

    slot: str
    words: tuple[str, ...]


_MOVEMENTS: dict[str, str] = {
    "static": "static still fixed locked locked-off lock-off hold stationary",
    "follow": "follow following track tracking follow-shot tracking-shot steadicam gimbal",
    "push": "push push-in dolly-in truck-in track-in move-in",
    "pull": "pull pull-out pull-back push-out dolly-out truck-out track-out move-out",
    "zoom-in": "zoom-in",
    "zoom-out": "zoom-out",
    "zoom-in|zoom-out": "zoom",
    "tilt-up": "tilt-up tilting-up",
    "tilt-down": "tilt-down tilting-down",
    "tilt-up|tilt-down": "tilt",
    "pan-left": "pan-left panning-left",
    "pan-right": "pan-right panning-right",
    "pan-left|pan-right": "pan panning",
    "dolly-left": "dolly-left truck-left crab-left slide-left track-left tracking-left",
    "dolly-right": "dolly-right truck-right crab-right slide-right track-right tracking-right",
    "dolly-left|dolly-right": "dolly truck crab slide",
    "pedestal-up": "pedestal-up boom-up ped-up rise",
    "pedestal-down": "pedestal-down boom-down ped-down",
    "pedestal-up|pedestal-down": "pedestal boom ped",
    "arc-left": "arc-left orbit-left",
    "arc-right": "arc-right orbit-right",
    "arc-left|arc-right": "arc orbit around circle circling",
    "crane-up": "crane-up jib-up crane-rise",
    "crane-down": "crane-down jib-down",
    "crane-up|crane-down": "crane jib crane-shot",
    "roll-left": "roll-left",
    "roll-right": "roll-right",
    "roll-left|roll-right": "roll",
    "dolly-zoom-in": "dolly-zoom-in",
    "dolly-zoom-out": "dolly-zoom-out",
    "dolly-zoom-in|dolly-zoom-out": "dolly-zoom dollyzoom zolly vertigo trombone contra-zoom",
    "handheld": "handheld hand-held hand-held-shot handheld-camera shaky",
    "whip-pan-left": "whip-pan-left whip-left swish-pan-left",
    "whip-pan-right": "whip-pan-right whip-right swish-pan-right",
    "whip-pan-left|whip-pan-right": "whip-pan whip swish-pan swish",
    "rack-focus": "rack-focus rack rackfocus racking pull-focus focus-pull shift-focus",
}
_SCALES: dict[str, str] = {
    "extreme-close-up": "extreme-close-up ecu xcu extreme-closeup extreme-close extreme-close-shot detail",
    "big-close-up": "big-close-up bcu big-closeup big-close tight-close-up choker",
    "close-up": "close-up closeup close cu close-shot headshot head-shot",
    "medium-close-up": "medium-close-up mcu medium-closeup medium-close mid-close-up bust bust-shot",
    "medium": "medium ms mid medium-shot mid-shot waist waist-shot",
    "cowboy": "cowboy cowboy-shot american american-shot plan-americain plan-américain thigh-shot",
    "medium-long": "medium-long mls mws medium-long-shot medium-wide medium-wide-shot knee-shot",
    "full": "full fs full-shot full-body full-figure",
    "wide": "wide ws ls long wide-shot long-shot establishing establishing-shot master master-shot",
    "extreme-wide": "extreme-wide ews els extreme-wide-shot extreme-long extreme-long-shot very-wide",
}
_ANGLES: dict[str, str] = {
    "eye-level": "eye-level eye eyelevel level eyes eye-height",
    "high-angle": "high-angle high highangle hi-angle from-above",
    "low-angle": "low-angle low lowangle from-below",
    "overhead": "overhead overhead-shot birds-eye bird-eye birdseye birds-eye-view top-down top-shot"
    " gods-eye",
    "worms-eye": "worms-eye worm-eye wormseye worms-eye-view",
    "shoulder-level": "shoulder-level shoulder shoulder-height",
    "hip-level": "hip-level hip hip-height waist-level cowboy-level",
    "knee-level": "knee-level knee knee-height",
    "ground-level": "ground-level ground ground-height floor-level low-level",
}
_VIEWS: dict[str, str] = {
    "ots": "ots over-the-shoulder over-shoulder over-the-shoulder-of over-shoulder-of over",
    "pov": "pov point-of-view pov-of point-of-view-of through-the-eyes-of subjective",
    "two-shot": "two-shot twoshot 2-shot two",
    "group": "group group-shot everybody three-shot",
}
_LEANS = "dutch dutch-angle dutch-tilt canted canted-angle oblique"
#: Words that lean the picture, and by how many degrees.
DUTCH = 12.0
#: The nearest word of the paper to each that the paper has not: what ``rig paper`` suggests, and what the
#: discriminator, which knows the paper's words, is told.
NEAREST: dict[str, str] = {
    "extreme-close-up": "close-up",
    "big-close-up": "close-up",
    "medium-close-up": "close-up",
    "cowboy": "medium",
    "medium-long": "full",
    "extreme-wide": "wide",
    "overhead": "high-angle",
    "worms-eye": "low-angle",
    "shoulder-level": "eye-level",
    "hip-level": "eye-level",
    "knee-level": "low-angle",
    "ground-level": "low-angle",
    "crane-up": "pedestal-up",
    "crane-down": "pedestal-down",
    "roll-left": "static",
    "roll-right": "static",
    "dolly-zoom-in": "push",
    "dolly-zoom-out": "pull",
    "handheld": "follow",
    "whip-pan-left": "pan-left",
    "whip-pan-right": "pan-right",
    "rack-focus": "static",
}
#: What people say that is no word of the camera: what to say instead, and how.
INSTEAD: dict[str, tuple[str, str]] = {
    "crash-zoom": ("zoom-in", "a zoom is as fast as its shot is short: `(zoom-in medium) 1s`"),
    "snap-zoom": ("zoom-in", "a zoom is as fast as its shot is short: `(zoom-in medium) 1s`"),
    "slow-push": ("push", "a push is as slow as its shot is long: `(push medium) 8s`"),
    "slow-push-in": ("push", "a push is as slow as its shot is long: `(push medium) 8s`"),
    "slow-zoom": ("zoom-in", "a zoom is as slow as its shot is long: `(zoom-in medium) 8s`"),
    "drone": ("crane-up", "a camera high above: `crane-up`, or the angle `overhead`"),
    "drone-shot": ("crane-up", "a camera high above: `crane-up`, or the angle `overhead`"),
    "aerial": ("overhead", "a camera high above: the angle `overhead`, or `crane-up`"),
    "aerial-shot": ("overhead", "a camera high above: the angle `overhead`, or `crane-up`"),
    "insert": ("extreme-close-up", "a thing fills the picture: `(static extreme-close-up) focus cup`"),
    "insert-shot": ("extreme-close-up", "a thing fills the picture: `(static extreme-close-up) focus cup`"),
    "reaction": ("close-up", "whoever reacts is the focus: `(static close-up) focus ben`"),
    "reaction-shot": ("close-up", "whoever reacts is the focus: `(static close-up) focus ben`"),
    "nahaufnahme": ("close-up", "the words of the camera are English"),
    "grossaufnahme": ("close-up", "the words of the camera are English"),
    "halbnah": ("medium", "the words of the camera are English"),
    "halbtotale": ("full", "the words of the camera are English"),
    "totale": ("wide", "the words of the camera are English"),
    "gros-plan": ("close-up", "the words of the camera are English"),
    "plan-large": ("wide", "the words of the camera are English"),
    "plan-moyen": ("full", "the words of the camera are English"),
    "primer-plano": ("close-up", "the words of the camera are English"),
    "plano-general": ("wide", "the words of the camera are English"),
    "plano-medio": ("medium", "the words of the camera are English"),
}
#: Medium close shot, often mistaken for cowboy; taken as what it means.
MEDIUM_CLOSE_SHOT = ("mcs", "medium-close-up")


def _table() -> dict[str, Meaning]:
    found: dict[str, Meaning] = {}
    for slot, words in (
        ("movement", _MOVEMENTS),
        ("scale", _SCALES),
        ("angle", _ANGLES),
        ("view", _VIEWS),
        ("lean", {"dutch": _LEANS}),
    ):
        for canonical, aliases in words.items():
            for alias in aliases.split():
                found[alias] = Meaning(slot, tuple(canonical.split("|")))
    found[MEDIUM_CLOSE_SHOT[0]] = Meaning("scale", (MEDIUM_CLOSE_SHOT[1],))
    return found


#: Every word the camera understands, folded.
CAMERA_WORDS: dict[str, Meaning] = _table()

#: What ``*`` and an omitted word stand for.
ANY: dict[str, tuple[str, ...]] = {
    "movement": ir.MOVEMENTS,
    "scale": PAPER_SCALES,
    "angle": ir.ANGLES,
}

EASES: dict[str, float] = {"slow-in": 10.0, "slow-out": 0.1, "linear": 1.0, "ease-in": 10.0, "ease-out": 0.1}
SPEEDS: dict[str, float] = {"slow": 0.7, "calm": 0.85, "normal": 1.0, "brisk": 1.3, "fast": 1.6}
TIMES = ("dawn", "day", "dusk", "night")
STYLES = ("board", "clay", "ink")
RIGS = ("cinema", "paper")
PREPOSITIONS = (
    "to", "at", "with", "from", "in", "into", "on", "onto", "of", "out", "off", "through", "toward",
    "towards", "for", "about", "against", "beside", "near", "by", "up", "down", "behind", "before", "under",
    "over", "around", "across", "opposite", "past", "along", "inside", "after", "between", "above", "below",
)  # fmt: skip
#: Those that say no more than where something is done, if that is all an action has to do with it.
WHERE = (
    "in", "on", "through", "against", "beside", "near", "by", "behind", "before", "under", "over", "around",
    "across", "opposite", "past", "along", "inside", "between", "above", "below",
)  # fmt: skip
#: What they begin is hardly ever what is done, but whence, why or by what.
BESIDES = ("from", "for", "about", "of", "with")
#: What is done there may be done near somebody, though it is not done to them.
BY_SOMEBODY = ("beside", "near", "by", "behind", "before", "opposite", "around", "between")
#: What they begin is where something ends up: that would be seen.
WHITHER = ("to", "into", "onto", "toward", "towards")
#: Words before a name that say nothing here: articles, and whose it is.
ARTICLES = (
    "the", "a", "an", "some", "her", "his", "their", "its", "my", "your", "our", "this", "that", "these",
    "those",
)  # fmt: skip


def plain_forms(verb: str) -> tuple[str, ...]:
    """What a verb in the third person may be the form of: ``walks`` of ``walk``, ``pushes``, ``carries``;
    one in ``ing``: ``crying``, ``waving``, ``sitting``; and a past: ``waved``, ``stopped``, ``ran``."""
    forms = [PAST[verb]] if verb in PAST else []
    if verb.endswith("ed"):
        stem = verb[:-2]
        forms += [stem, f"{stem}e", *([stem[:-1]] if stem[-2:-1] == stem[-1:] else [])]
        forms += [f"{verb[:-3]}y"] if verb.endswith("ied") else []
    if verb.endswith("ing"):
        stem = verb[:-3]
        forms += [stem, f"{stem}e", *([stem[:-1]] if stem[-2:-1] == stem[-1:] else [])]
    if verb.endswith("ies"):
        forms.append(f"{verb[:-3]}y")
    if verb.endswith("es"):
        forms.append(verb[:-2])
    if verb.endswith("s") and not verb.endswith("ss"):
        forms.append(verb[:-1])
    return tuple(form for form in forms if len(form) > 1)


def counts_under(word: str, name: str) -> bool:
    """Whether things are no more than counted under a word: ``desk_2`` under ``desk``."""
    return re.fullmatch(rf"{re.escape(word)}_\d+", name) is not None


def fold(word: str) -> str:
    """A word as the tables have it."""
    folded = re.sub(r"\s*\+\s*", "+", word.casefold()).replace("_", "-").replace(" ", "-")
    return folded.replace("'", "").replace("’", "")


def paper_word(word: str) -> str:
    """The word of the paper that is nearest to a canonical one; of two movements at once the first one's."""
    first = word.split("+")[0]
    return NEAREST.get(first, first)


def meaning(word: str) -> Meaning | None:
    """What a folded word means, or two movements joined by ``+``; None for what is no word of the camera."""
    if "+" not in word:
        return CAMERA_WORDS.get(word)
    parts = [CAMERA_WORDS.get(part) for part in word.split("+")]
    if len(parts) != 2 or any(part is None or part.slot != "movement" for part in parts):
        return None
    first, second = (part.words for part in parts if part is not None)
    return Meaning("movement", tuple(f"{a}+{b}" for a in first for b in second))
