"""Tilts and pans that keep their subject in the picture: how far they may turn, and from where to where.

The paper turns by 30° to 60° onto the subject or off it, so a picture that a lens of 50 mm takes begins or
ends without anybody. Most of those drawn here pass over one who stays, from one side of the picture to the
other; go along with one who walks their way; or go up to the face from the body, and down from it. The others
are as in the paper, for lines in which something is to be found, or left. Assumes ``rig cinema``.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ..cinema.framing import direction
from ..cinema.moves import SIGN, Draw, family
from ..cinema.subject import Subject
from ..cinema.subspaces import LEAST_TURN, turn_range
from ..cinema.track import look_at_rotation

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]
Film = tuple[float, float]

#: Share of the tilts and pans that keep their subject.
_KEEPING = 0.75
#: How far off the middle one may get whom a pan passes over, share of half the picture; of several, each; and
#: from the middle where the camera goes somewhere meanwhile.
_OFF, _OFF_TOGETHER, _OFF_ON_THE_WAY = 0.5, 0.25, 0.75
_STANDS = {"pan", "tilt", "roll", "zoom", "static"}  # movements of a camera that stays where it is
#: Least turns, degrees, of those that go with another movement, and with a change of the lens, which hides
#: small ones.
_LEAST_WITH, _LEAST_WITH_ZOOM = 14.0, 20.0
_MOST = 75.0  # degrees of a pan along with one who walks
#: Degrees a tilt may always turn, though it leaves the knees: of a whole figure there is always something. No
#: more from above or below, where bodies are not looked up and down.
_BODY = 15.0
_STAYS = 1.2  # metres of somebody who hardly moves: a step or two, or lying down
_LEVEL = np.radians(35.0)  # above or below which bodies are not looked up and down


def from_the_face(on: Bools, words: list[str], subject: Subject, u: Array) -> Bools:
    """Whether turns [P] of the movements ``words`` end on the subject: tilts that keep a person go up to the
    face and down from it.

    u: [P] in 0..1, what turns are drawn from
    """
    for word, drawn in _each(words, u):
        if family(word) == "tilt" and subject.kind == "person":
            on = np.where(drawn < _KEEPING, word == "tilt-up", on)
    return on


def columns(
    words: list[str], subject: Subject, theta: Array, focal: Array, film: Film, on: Bools, u: Array
) -> Array:
    """Columns [P] of the picture, 0..1, that subjects are put on whom pans pass over; NaN for the others.

    theta, focal: [P], as asked for; on: [P], whether turns end where the subject is framed; u: [P] in 0..1
    """
    out = np.full(len(focal), np.nan)
    for word, drawn in _each(words, u):
        if family(word) == "pan" and _stands(words):
            turn, kept = _passing(words, subject, theta, focal, film, drawn)
            side = SIGN[word] * np.where(on, 1.0, -1.0) * np.tan(turn / 2) * focal / film[0]
            out = np.where(kept, 0.5 + side, out)
    return out


def keep(
    draw: Draw,
    word: str,
    words: list[str],
    subject: Subject,
    path: Array,
    theta: Array,
    film: Film,
    u: Array,
) -> Draw:
    """Candidates [P] of the movement ``word`` (one of ``words`` made at once), most of them with turns that
    keep the subject.

    path: [T, 3] the anchor's; theta: [P] as asked for, before anything raised the camera
    u: [P] in 0..1, what turns are drawn from
    """
    kind = family(word)
    if kind == "pan" and subject.travel() > _STAYS:
        if len(words) > 1:
            return draw
        most = _along(draw, path, SIGN[word])
        turn = most * (0.9 + 0.2 * u / _KEEPING)
        kept = (u < _KEEPING) & (turn > np.radians(LEAST_TURN)) & (turn < np.radians(_MOST))
    elif kind == "pan":
        turn, kept = _passing(words, subject, theta, draw.focal, film, u)
    elif kind == "tilt" and subject.kind == "person":
        level = np.abs(theta - np.pi / 2) < _LEVEL
        most = np.where(level, _down_the_body(draw, subject, path, SIGN[word]), np.radians(_BODY))
        turn, kept = _spread(words, most, u)
    else:
        return draw
    low, high = np.radians(turn_range(kind, cinema=False))
    far = low + (high - low) * np.clip((u - _KEEPING) / (1.0 - _KEEPING), 0.0, 1.0)
    return replace(draw, turn=np.where(kept, turn, far), kept=kept)


def _each(words: list[str], u: Array) -> list[tuple[str, Array]]:
    """Movements made at once, and what the turns of each are drawn from."""
    return [(words[0], u), (words[-1], 1.0 - u)][: len(words)]


def _stands(words: list[str]) -> bool:
    return {family(word) for word in words} <= _STANDS


def _spread(words: list[str], most: Array, u: Array) -> tuple[Array, Bools]:
    """Radians [P] from the least that is seen to ``most`` [P], and which of them keep their subject."""
    least = np.radians(LEAST_TURN)
    if len(words) > 1:
        least = np.radians(_LEAST_WITH_ZOOM if any("zoom" in word for word in words) else _LEAST_WITH)
    kept = (u < _KEEPING) & (most > least)
    return least + np.maximum(most - least, 0.0) * np.minimum(u / _KEEPING, 1.0), kept


def _passing(
    words: list[str], subject: Subject, theta: Array, focal: Array, film: Film, u: Array
) -> tuple[Array, Bools]:
    """Radians [P] from the subject at one side of the picture to it at the other, or from the middle to one
    side where the camera goes somewhere meanwhile; and where that keeps it."""
    off, half = _OFF_TOGETHER if len(subject.members) > 1 else _OFF, film[0] / 2 / focal
    most = 2 * np.arctan(off * half) if _stands(words) else np.arctan(off / _OFF * _OFF_ON_THE_WAY * half)
    turn, kept = _spread(words, most, u)
    flat = np.abs(theta - np.pi / 2) < _LEVEL
    return turn, kept & flat & (subject.travel() <= _STAYS)


def _camera(draw: Draw, path: Array) -> tuple[Array, Array]:
    """Where it stands, and what it looks at where the subject is framed, [P, 3] each."""
    aim = path[np.where(draw.key == 1, len(path) - 1, 0)] + draw.offset
    return aim + draw.r[:, None] * direction(draw.theta, draw.phi), aim


def _down_the_body(draw: Draw, subject: Subject, path: Array, sign: float) -> Array:
    """Radians [P] from what is framed to the knees."""
    camera, aim = _camera(draw, path)
    knees = np.broadcast_to(subject.landmarks["knees"][0 if sign > 0 else -1], aim.shape)
    pitches = [look_at_rotation(camera, point)[..., 1] for point in (aim, knees)]
    return np.maximum(pitches[0] - pitches[1], np.radians(_BODY))


def _along(draw: Draw, path: Array, sign: float) -> Array:
    """Radians [P] the subject goes about the camera, in the pan's direction; less than 0 against it."""
    camera, _ = _camera(draw, path)
    first, last = (path[k] + draw.offset - camera for k in (0, -1))
    turned = np.arctan2(last[:, 1], last[:, 0]) - np.arctan2(first[:, 1], first[:, 0])
    return np.asarray(sign * ((turned + np.pi) % (2 * np.pi) - np.pi))
