"""Why a take ranks where it does, in a sentence: what sets it apart from its neighbours.

Assumes takes of one shot in the order of their scores, with their measures by name. Guarantees that the
most telling differences come first, and that what makes no difference to the score is not told.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from ..cinema.score import FLAW, PRIOR
from ..cinema.telling import advantages, compared, faults

_ORDINALS = ("first", "second", "third", "fourth", "fifth", "sixth", "seventh", "eighth", "ninth", "tenth")
_SAID = 2  # advantages in a sentence
_WORTH = 0.004  # points of the geometry score below which a difference is not told


@dataclass(frozen=True)
class TakeFacts:
    """One take as a build keeps it. camera: its words; achieved: as read off its track; None: not kept.

    logit, taste: what discriminator and taste say of it, log odds
    """

    rank: int
    score: float
    camera: dict[str, str]
    achieved: dict[str, str] | None
    measures: dict[str, float]
    params: dict[str, float | str]
    logit: float | None
    taste: float = 0.0

    @property
    def judged(self) -> dict[str, float]:
        """What was said of it besides its measures, by the names of the parts."""
        return {"logit": self.logit or 0.0, "taste": self.taste}


def gains_of(take: TakeFacts, other: TakeFacts) -> dict[str, float]:
    """Of each part, in log odds where the discriminator judged, in points of the geometry score else."""
    if take.logit is None or other.logit is None:
        return advantages(take.measures, other.measures)
    judged = {name: value - other.judged[name] for name, value in take.judged.items()}
    return advantages(take.measures, other.measures, judged, PRIOR, FLAW)


def phrases_of(
    take: TakeFacts, other: TakeFacts, gains: Mapping[str, float], better: bool, rival: str = ""
) -> list[str]:
    """What sets two takes apart, most telling first."""
    least = _WORTH if take.logit is None else _WORTH * PRIOR
    told = [p for p, gain in gains.items() if (gain if better else -gain) > least]
    told.sort(key=lambda p: -abs(gains[p]))
    mine, theirs = take.measures | take.judged, other.measures | other.judged
    return [compared(p, mine, theirs, better, rival if i == 0 else "") for i, p in enumerate(told)]


def sentence(takes: Sequence[TakeFacts], k: int) -> str:
    """``ranks first: steadier than take 2 and more lead room (0.18 against 0.09); take 3 cuts the feet``."""
    take = takes[k]
    place = _ORDINALS[k] if k < len(_ORDINALS) else f"number {k + 1}"
    if len(takes) == 1:
        wrong = faults(take.measures, take.camera["movement"])
        return "the only take" + (f": {_and(wrong[:_SAID])}" if wrong else "")
    rival = takes[1] if k == 0 else takes[k - 1]
    gains = gains_of(take, rival)
    first = phrases_of(take, rival, gains, k == 0, f"take {rival.rank}")
    second = phrases_of(take, rival, gains, k != 0)
    words = f"ranks {place}"
    if first:
        words += f": {_and(first[:_SAID])}"
    elif k:
        words += f": nearly as good as take {rival.rank}"
    else:
        words += f": by a hair before take {rival.rank}"
    if second:
        words += f", though {_and(second[:1])}"
    return "; ".join([words, *_others(takes, k)])


def _others(takes: Sequence[TakeFacts], k: int) -> list[str]:
    """Of the best take what is wrong with those after it; of any other what is wrong with itself."""
    wrong = faults(takes[k].measures, takes[k].camera["movement"])
    if k:
        return [f"it {_and(wrong[:_SAID])}"] if wrong else []
    out = []
    for other in takes[1:]:
        worse = [w for w in faults(other.measures, other.camera["movement"]) if w not in wrong]
        out += [f"take {other.rank} {worse[0]}"] if worse else []
    return out[:_SAID]


def _and(words: Sequence[str]) -> str:
    return " and ".join(words)
