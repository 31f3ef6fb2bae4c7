"""Eyes, blinks, talk and feelings: where a gaze goes over time, and how the face lives."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from .curves import delayed, plateau, ramp, smooth, wander
from .feelings import FEELINGS, Expression
from .figure import Mimic
from .types import Talk

Array = NDArray[np.float64]
#: How far eyes, head and chest turn, radians.
EYE_TURN, EYE_DOWN, HEAD_TURN, HEAD_NOD = 0.5, 0.4, 1.15, 0.65


@dataclass(frozen=True, eq=False)
class GazePull:
    """A direction to look, relative to the body: turn, down and weight [T], and the head's share."""

    turn: Array
    down: Array
    weight: Array
    share: float


@dataclass(frozen=True, eq=False)
class Look:
    """What the eyes, head and chest do: radians [T]."""

    eye_turn: Array
    eye_down: Array
    head_turn: Array
    head_nod: Array
    chest_twist: Array


def look(pulls: list[GazePull], frames: int, fps: float) -> Look:
    """Eyes lead the head by about a tenth of a second, the head leads the body; all within limits.

    Later pulls lie over earlier ones.
    """
    turn, down, share = np.zeros(frames), np.zeros(frames), np.full(frames, 0.6)
    for pull in pulls:
        turn = turn + pull.weight * (pull.turn - turn)
        down = down + pull.weight * (pull.down - down)
        share = share + pull.weight * (pull.share - share)
    turn = np.clip(turn, -1.95, 1.95)
    head = delayed(smooth(_soft(turn * share, HEAD_TURN), 0.11 * fps), 0.09 * fps)
    nod = delayed(smooth(_soft(down * share * 0.9, HEAD_NOD), 0.11 * fps), 0.09 * fps)
    far = np.sign(turn) * np.maximum(np.abs(turn) - 0.55, 0.0)
    chest = delayed(smooth(np.clip(0.42 * far, -0.5, 0.5), 0.16 * fps), 0.2 * fps)
    eyes = smooth(np.stack([turn, down], axis=1), 0.03 * fps)
    return Look(
        _soft(eyes[:, 0] - head - chest, EYE_TURN), _soft(eyes[:, 1] - nod, EYE_DOWN), head, nod, chest
    )  # fmt: skip


def _soft(x: Array, limit: float) -> Array:
    return np.asarray(limit * np.tanh(x / limit))


def blinks(t: Array, rng: np.random.Generator) -> Array:
    """Lids [T]: shut for about 0.15 s every two to six seconds."""
    out = np.zeros(len(t))
    at = rng.uniform(0.3, 3.0)
    while at < t[-1] + 0.2:
        out = np.maximum(out, plateau(t, at - 0.07, at, at + 0.03, at + 0.15))
        at += rng.uniform(1.8, 5.5)
    return out


@dataclass(frozen=True, eq=False)
class Speech:
    """Talking, [T]: jaw 0..1, nods and brows on the stresses."""

    jaw: Array
    nod: Array
    brow: Array
    tilt: Array


def speech(talks: list[tuple[Talk, float, float]], t: Array, fps: float, rng: np.random.Generator) -> Speech:
    """Syllables at four to six a second in phrases with breaths between; (talk, start, duration)."""
    jaw, nod, brow = (np.zeros(len(t)) for _ in range(3))
    for talk, start, duration in talks:
        begin, end = start + talk.start * duration, start + talk.end * duration
        at = begin
        while at < end - 0.12:
            phrase = min(end, at + rng.uniform(0.7, 1.8))
            while at < phrase - 0.1:
                length = rng.uniform(0.15, 0.26)
                height = talk.loudness * rng.uniform(0.25, 1.0)
                jaw = jaw + height * plateau(
                    t, at - 0.03, at + 0.4 * length, at + 0.45 * length, at + length + 0.03
                )
                if height > 0.75:
                    nod = nod + 0.07 * plateau(t, at - 0.08, at + 0.08, at + 0.1, at + 0.36)
                    brow = brow + 0.35 * plateau(t, at - 0.1, at + 0.05, at + 0.15, at + 0.4)
                at += length
            at = phrase + rng.uniform(0.12, 0.35)
    tilt = 0.05 * wander(t, rng, 2.3) * (ramp(jaw, 0.0, 0.1) if talks else 0.0)
    return Speech(np.clip(jaw, 0, 1), nod, np.clip(brow, 0, 1), smooth(tilt, 0.25 * fps))


#: Seconds a feeling takes to come over somebody, and to pass.
_COMES, _PASSES = 0.35, 0.6
#: Smiles this much pull at the lids and lips as a feeling would.
_OPEN_SMILE = 0.5


@dataclass(frozen=True, eq=False)
class Felt:
    """Every number of :class:`~runtime.motion.feelings.Expression`, each [T]."""

    values: dict[str, Array]

    def __getitem__(self, name: str) -> Array:
        return self.values[name]


def felt(feelings: list[tuple[str, float, float]], t: Array, rng: np.random.Generator) -> Felt:
    """Feelings (word, start, end in seconds) over the times ``t``; later ones lie over earlier ones.

    They swell and ebb a little, as nobody holds a face.
    """
    names = [f.name for f in fields(Expression)]
    calm = FEELINGS["neutral"]
    values = {name: np.full(len(t), float(getattr(calm, name))) for name in names}
    life = 1.0 + 0.10 * wander(t, rng, 2.7) if feelings else np.ones(len(t))
    for word, start, end in feelings:
        weight = plateau(t, start - _COMES, start, end, end + _PASSES) * life
        for name in names:
            values[name] = values[name] + weight * (getattr(FEELINGS[word], name) - values[name])
    return Felt(values)


def mimic(feeling: Felt, smile: Array, speech: Array) -> Mimic:
    """What a feeling, an action's own smile [T] and talking [T] ask of lids and lips."""
    grin = _OPEN_SMILE * np.clip(smile, 0.0, 1.0)
    return Mimic(
        lid=0.95 * np.minimum(feeling["lid"], 0.0),
        squint=np.maximum(feeling["squint"], grin),
        inner=feeling["inner"],
        wide=np.clip(feeling["wide"] + grin * (1.0 - np.abs(feeling["wide"])), -1.0, 1.0)
        * (1 - 0.35 * speech),
        sneer=np.clip(feeling["sneer"] + 0.4 * grin, 0.0, 1.0),
    )
