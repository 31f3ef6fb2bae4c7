"""Eyes, blinks, talk and feelings: where a gaze goes over time, and how the face lives."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from .curves import delayed, plateau, ramp, smooth, wander
from .feelings import FEELINGS, Expression
from .figure import Mimic
from .rotations import rot_zy, turned, unit, unwrapped, wrap
from .timeline import Talk

Array = NDArray[np.float64]
#: How far eyes, head and chest turn, radians.
EYE_TURN, EYE_DOWN, HEAD_TURN, HEAD_NOD = 0.62, 0.52, 1.25, 0.95


@dataclass(frozen=True, eq=False)
class GazePull:
    """A direction to look, relative to the body: turn, down and weight [T], and the head's share.

    point: the place in the world that is looked at [T, 3], where it is one
    """

    turn: Array
    down: Array
    weight: Array
    share: float
    point: Array | None = None


@dataclass(frozen=True, eq=False)
class Look:
    """What the head and chest do, radians [T], and where the eyes are to go.

    turn, down: direction for the eyes, relative to the body; point: [T, 3] what they look at in the world, by
        the weight ``fixed`` [T]
    """

    turn: Array
    down: Array
    point: Array
    fixed: Array
    head_turn: Array
    head_nod: Array
    chest_twist: Array


def look(pulls: list[GazePull], frames: int, fps: float) -> Look:
    """Eyes lead the head by about a tenth of a second, the head leads the body; all within limits.

    Later pulls lie over earlier ones.
    """
    turn, down, share = np.zeros(frames), np.zeros(frames), np.full(frames, 0.6)
    point, fixed = np.zeros((frames, 3)), np.zeros(frames)
    for pull in pulls:
        if pull.point is not None:
            over = pull.weight / np.maximum(pull.weight + fixed * (1.0 - pull.weight), 1e-6)
            point = point + over[:, None] * (pull.point - point)
        fixed = fixed * (1.0 - pull.weight) + (pull.weight if pull.point is not None else 0.0)
        turn = turn + pull.weight * (pull.turn - turn)
        down = down + pull.weight * (pull.down - down)
        share = share + pull.weight * (pull.share - share)
    turn = np.clip(turn, -1.95, 1.95)
    beyond = np.clip((np.abs(turn) - 1.7) / 0.2, 0.0, 1.0) + np.clip((np.abs(down) - 1.25) / 0.2, 0.0, 1.0)
    fixed = fixed * (1.0 - np.clip(beyond, 0.0, 1.0))
    head = delayed(smooth(_share(turn, share, EYE_TURN, HEAD_TURN), 0.11 * fps), 0.09 * fps)
    nod = delayed(smooth(_share(down, 0.9 * share, EYE_DOWN, HEAD_NOD), 0.11 * fps), 0.09 * fps)
    far = np.sign(turn) * np.maximum(np.abs(turn) - 0.55, 0.0)
    chest = delayed(smooth(np.clip(0.42 * far, -0.5, 0.5), 0.16 * fps), 0.2 * fps)
    eyes = smooth(np.stack([turn, down], axis=1), 0.03 * fps)
    return Look(eyes[:, 0], eyes[:, 1], point, smooth(fixed, 0.03 * fps), head, nod, chest)


def eye_angles(look: Look, body: Array, head: Array, eye: Array) -> tuple[Array, Array]:
    """Turn and down of the eyes in the head [T], within their limits; arguments as of :func:`eye_way`."""
    turn, down = eye_way(look, body, head, eye)
    return _limited(turn, EYE_TURN), _limited(down, EYE_DOWN)


def beyond_eyes(look: Look, body: Array, head: Array, eye: Array, fps: float) -> tuple[Array, Array]:
    """Turn and down [T] that are left for the head to do, of a look the eyes cannot follow from it."""
    out = []
    for angle, limit in zip(eye_way(look, body, head, eye), (EYE_TURN, EYE_DOWN), strict=True):
        over = np.sign(angle) * np.maximum(np.abs(angle) - 0.7 * limit, 0.0)
        out.append(smooth(np.clip(over, -0.5, 0.5) * look.fixed, 0.08 * fps))
    return out[0], out[1]


def eye_way(look: Look, body: Array, head: Array, eye: Array) -> tuple[Array, Array]:
    """Turn and down in the head [T] of what is looked at.

    body, head: rotations [T, 3, 3] of what the look is relative to and of the head
    eye: [T, 3] between the eyes
    """
    flat = np.cos(look.down)
    along = np.stack([flat * np.cos(look.turn), flat * np.sin(look.turn), -np.sin(look.down)], axis=1)
    free = turned(np.swapaxes(head, -1, -2) @ body, along)
    fixed = unit(turned(np.swapaxes(head, -1, -2), look.point - eye))
    way = free + look.fixed[:, None] * (fixed - free)
    turn = np.arctan2(way[:, 1], way[:, 0])
    return turn, np.arctan2(-way[:, 2], np.hypot(way[:, 0], way[:, 1]))


def _limited(x: Array, limit: float) -> Array:
    """Exact up to four fifths of the limit, then creeping towards it."""
    knee = 0.8 * limit
    over = np.maximum(np.abs(x) - knee, 0.0)
    eased = np.minimum(np.abs(x), knee) + (limit - knee) * np.tanh(over / (limit - knee))
    return np.asarray(np.sign(x) * eased)


def _share(angle: Array, share: Array, eyes: float, limit: float) -> Array:
    """What the head does of an angle: its share, more where the eyes alone could not do the rest."""
    size = np.abs(angle)
    return _limited(np.sign(angle) * np.maximum(size * share, size - 0.75 * eyes), limit)


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


def relative_gaze(eye: Array, yaw: Array, tilt: Array, point: Array) -> tuple[Array, Array]:
    """Turn to the left and down [T] from ``eye`` [T, 3] to ``point`` [(T,) 3], against a trunk that faces
    ``yaw`` and is tipped forward by ``tilt``."""
    d = point - eye
    if tilt.any():
        d = turned(np.swapaxes(rot_zy(yaw, tilt), -1, -2), d)
        yaw = np.zeros_like(yaw)
    turn = wrap(np.arctan2(d[..., 1], d[..., 0]) - yaw)
    return unwrapped(turn), np.arctan2(-d[..., 2], np.hypot(d[..., 0], d[..., 1]))


def fade(t: Array, start: float, end: float, lead: float = 0.35) -> Array:
    """A gaze's weight: quickly there, quickly gone."""
    return ramp(t, start, start + lead) * (1.0 - ramp(t, end - 0.5 * lead, end + 0.5 * lead))
