"""Candidates to tracks: gives drawn variables their ranges, frames the subject, and moves the camera."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..cinema import rig_cinema, rig_paper
from ..cinema.angles import CINEMA_THETA, lens_height
from ..cinema.framing import FLAT, basis
from ..cinema.further import FURTHER, Part, combined
from ..cinema.moves import SIGN, Draw, families, family, of_camera, track_of
from ..cinema.sizes import Size, size_of
from ..cinema.subject import Subject, anchor
from ..cinema.subspaces import ASIDE, AZIMUTHS, FILM, LEAD, TRAVELS, mu_range, turn_range
from ..lang.ir import Shot
from .candidates import Shooting, joined
from .drawing import Sample
from .turns import columns, from_the_face, keep
from .views import eyes_track, over_shoulder, through_eyes

Array = NDArray[np.float64]

#: Long lenses need more room than most rooms have, and short ones stand too close to a face.
_SHORTER = {
    "extreme-close-up": 0.5,
    "big-close-up": 0.7,
    "medium-long": 1.5,
    "full": 2.0,
    "wide": 2.0,
    "extreme-wide": 3.0,
    "overhead": 3.0,
    "worms-eye": 2.0,
}


def shoot(
    shot: Shot,
    subject: Subject,
    sample: Sample,
    rows: NDArray[np.int64],
    rig: str,
    film: tuple[float, float],
    fps: float,
) -> Shooting:
    """Tracks of the sampled rows on one subject."""
    floor, subject = subject.floor, subject.shifted(-subject.floor)  # cameras are drawn above a floor at 0
    parts: list[Shooting] = []
    for m, movement in enumerate(shot.movements):
        for s, scale in enumerate(shot.scales):
            local = np.flatnonzero((sample.movement[rows] == m) & (sample.scale[rows] == s))
            if len(local):
                parts.append(_shoot_one(shot, subject, sample, rows, local, movement, scale, rig, film, fps))
    found = parts[0] if len(parts) == 1 else joined(parts)
    return _raised(replace(found, view=shot.view), floor)


def _raised(shooting: Shooting, floor: float) -> Shooting:
    """The same, above a floor at another height."""
    if abs(floor) < 1e-9:
        return shooting
    track, up = shooting.track, np.array((0.0, 0.0, floor))
    moved = replace(track, position=track.position + up, look_at=track.look_at + up)
    return replace(shooting, track=moved, floor=floor)


def _shoot_one(
    shot: Shot,
    subject: Subject,
    sample: Sample,
    rows: NDArray[np.int64],
    local: NDArray[np.int64],
    movement: str,
    scale: str,
    rig: str,
    film: tuple[float, float],
    fps: float,
) -> Shooting:
    """All candidates of one movement and one scale."""
    i = rows[local]
    words, last = of_camera(movement).split("+"), subject.frames - 1
    kind = family(words[0])
    keeps = rig == "cinema" and shot.view not in ("pov", "ots")
    on = from_the_face(sample.on[i], words, subject, sample.turn[i]) if keeps else sample.on[i]
    key, on = _keys(words, sample.key[i].copy(), on, rig, shot.view, asked_high(shot, sample, i))
    at = np.where(key == 1, last, 0)
    mu = _mu(words[0], sample.mu[i], rig)
    mu_too = _mu(words[-1], sample.mu[i][::-1], rig)
    angles = tuple(shot.angles[k] for k in sample.angle[i])
    bias = 1.5 if subject.kind == "place" else 1.0
    bend = np.array([bias * _SHORTER.get(scale, 1.0) * _SHORTER.get(a, 1.0) for a in angles])
    zooms = next((w for w in words if "zoom" in w), words[0])
    within = np.clip(sample.lens[i], 0.0, 1.0)
    beyond = sample.lens[i] - within  # of nudged cameras
    focal = _lens(shot, zooms, rig, within**bend + beyond, mu if zooms == words[0] else mu_too)
    relative: Array = np.asarray(sample.azimuth[i] * (2 * np.pi / AZIMUTHS), float)
    if rig == "cinema":
        relative = relative + (2 * sample.jitter[i] - 1) * np.radians(ASIDE)
    phi = subject.heading[at] + relative
    if rig == "paper":
        f = _framed_as_printed(subject, scale, angles, phi, focal)
    else:
        asked = np.array([CINEMA_THETA[a] for a in angles])
        side = columns(words, subject, asked, focal, film, on, sample.turn[i]) if keeps else None
        f = _framed(shot, subject, sample, i, scale, angles, at, on, asked, phi, focal, film, side, fps)
        for word, factor in zip(words, (mu, mu_too), strict=False):
            if family(word) in ("push", "pull"):
                f = replace(f, r=np.where(key == 1, f.r / factor, f.r))
    travel, before, key = _travel(subject, words[0], sample, i, f, film, key)
    above = np.array([a == "overhead" for a in angles])
    turn, kept = _turn(kind, sample.turn[i], rig, above), np.zeros(len(i), bool)
    draw = Draw(
        f.r, f.theta, f.phi, f.focal, f.offset, sample.lam[i], mu, turn, travel, before, key, on, kept, f.rise
    )
    travel, before, _ = _travel(subject, words[-1], sample, i, f, film, key)
    turn = _turn(family(words[-1]), 1.0 - sample.turn[i], rig, above)
    second = replace(draw, lam=sample.lam_too[i], mu=mu_too, turn=turn, travel=travel, before=before)
    if keeps:
        draw = keep(draw, words[0], words, subject, f.path, asked, film, sample.turn[i])
        if len(words) > 1:
            second = keep(second, words[-1], words, subject, f.path, asked, film, 1.0 - sample.turn[i])
    if shot.view == "pov" and subject.via is not None:
        track = eyes_track(subject, f.path, draw, film, shot.roll, kind == "follow", fps)
    elif len(words) > 1 or kind in FURTHER:
        parts = [Part(words[0], draw), Part(words[-1], second)][: len(words)]
        track = combined(parts, f.path, film, shot.roll, fps, sample.noise[i])
    else:
        track = track_of(words[0], f.path, draw, film, shot.roll)
    n = len(i)
    return Shooting(
        rig, track, local, (movement,) * n, (scale,) * n, angles, np.where(key == 1, last, 0), draw, second,
        f.lifted, relative, f.height,
    )  # fmt: skip


@dataclass(frozen=True, eq=False)
class _Framed:
    """Where cameras stand that have their subject framed.

    path: [T, 3], what they hold on to; r, theta, phi, focal, lifted, rise [P]; offset [P, 3]: as in Draw and
    Shooting; height: [P] metres of the paper's reference over the floor, 0 for ``rig cinema``
    """

    path: Array
    r: Array
    theta: Array
    phi: Array
    focal: Array
    offset: Array
    lifted: Array
    rise: Array
    height: Array


def _framed_as_printed(
    subject: Subject, scale: str, angles: tuple[str, ...], phi: Array, focal: Array
) -> _Framed:
    """``rig paper``."""
    height, none = rig_paper.reference_height(scale, subject.height), np.zeros(len(phi))
    path = subject.position + np.array((0.0, 0.0, height))
    r, theta = rig_paper.radius(scale, subject.height, focal), np.array([rig_paper.theta(a) for a in angles])
    offset = np.zeros((len(phi), 3))
    return _Framed(path, r, theta, phi, focal, offset, none, none, np.full(len(phi), height))


def _framed(
    shot: Shot,
    subject: Subject,
    sample: Sample,
    i: NDArray[np.int64],
    scale: str,
    angles: tuple[str, ...],
    at: NDArray[np.int64],
    on: NDArray[np.bool_],
    asked: Array,
    phi: Array,
    focal: Array,
    film: tuple[float, float],
    side: Array | None,
    fps: float,
) -> _Framed:
    """``rig cinema``: the size solved at the frames ``at`` for θ as ``asked``, or as eyes and shoulders ask.

    side: [P] columns of the picture subjects are put on, NaN where that is free
    """
    size = size_of(subject.kind, scale)
    path = anchor(subject, size.upper, size.lower, fps)
    levels, lead = _levels(subject, angles, at), sample.lead[i] * LEAD

    def framed(
        phi: Array, focal: Array, column: Array | None = None, down: Array | float = 0.0
    ) -> rig_cinema.Framing:
        polar = asked - np.where(asked == np.pi / 2, down, 0.0)
        return rig_cinema.frame(
            subject, size, path, at, polar, phi, focal, film, lead, shot.roll, levels, column
        )

    if shot.view == "pov" and subject.via is not None:
        found, phi, focal = through_eyes(subject, size, path, at, shot.lens, film)
    elif shot.view == "ots" and subject.via is not None:
        found, phi, focal = over_shoulder(
            subject, size, path, at, shot.lens, film, on, sample.travel[i], framed
        )
    else:
        found = framed(phi, focal, side)
    r = found.r * sample.reach[i]
    rise = _rise(subject, size, at, r * film[1] / focal, found.theta)
    return _Framed(path, r, found.theta, phi, focal, found.offset, found.lifted, rise, np.zeros(len(phi)))


def asked_high(shot: Shot, sample: Sample, i: NDArray[np.int64]) -> NDArray[np.int64]:
    """1 for cameras that look straight down, −1 for those that look steeply up, 0 for the others: [P]."""
    angles = np.array(shot.angles)[sample.angle[i]]
    return np.asarray((angles == "overhead").astype(int) - (angles == "worms-eye"))


def _keys(
    words: list[str],
    key: NDArray[np.int64],
    on: NDArray[np.bool_],
    rig: str,
    view: str,
    steep: NDArray[np.int64],
) -> tuple[NDArray[np.int64], NDArray[np.bool_]]:
    """Whether the first frame is framed or the last [P], and whether turns end on the subject."""
    kinds = families("+".join(words))
    on = on.copy()
    if "whip-pan" in kinds:
        on[:] = True
    for word in words:
        if word in ("tilt-up", "tilt-down"):  # never over the vertical
            up = word == "tilt-up"
            on = np.where(steep == (-1 if up else 1), True, np.where(steep == 0, on, False))
    if "crane" in kinds:  # it rises from its angle or sinks to it; to and from overhead, which is the top
        on = np.where(steep == 1, "crane-up" in words, "crane-down" in words)
    if kinds & {"zoom", "dolly-zoom"} or ("follow" in kinds and view != "pov"):
        key[:] = 0
        on = on & (not kinds & {"tilt", "pan", "crane"} or len(words) == 1)
    elif rig == "paper" and kinds != {"static"}:
        key[:] = 0
    if kinds & {"tilt", "pan", "whip-pan", "crane", "roll"} and (
        len(words) == 1 or not kinds & {"zoom", "dolly-zoom", "follow"}
    ):
        key[:] = on
    return key, on


def _mu(movement: str, u: Array, rig: str) -> Array:
    low, high = mu_range(movement, rig == "cinema")
    return low + (high - low) * u


def _turn(kind: str, u: Array, rig: str, above: NDArray[np.bool_]) -> Array:
    """Radians turned [P]; of arcs seen from above it takes more to be seen as one. Tilts and pans of ``rig
    cinema`` are as in the paper where :func:`~vdsl.propose.turns.keep` makes no others of them."""
    high = turn_range(kind, False)[1]
    cinema = rig == "cinema" and kind == "arc"
    least = np.where(above, turn_range(kind, cinema, True)[0], turn_range(kind, cinema)[0])
    return np.asarray(np.radians(least + (high - least) * u))


def _levels(subject: Subject, angles: tuple[str, ...], at: NDArray[np.int64]) -> Array | None:
    """Height [P] the lens is to have; NaN for angles that do not say it."""
    out = np.full(len(at), np.nan)
    for angle in set(angles):
        height = lens_height(angle, subject.landmarks, subject.floor, subject.kind)
        if height is not None:
            rows = np.array([a == angle for a in angles])
            out[rows] = np.broadcast_to(height, subject.frames)[at[rows]]
    return None if np.isnan(out).all() else out


def _lens(shot: Shot, movement: str, rig: str, u: Array, mu: Array) -> Array:
    """Focal lengths at the first frame, evenly in the logarithm, and beyond the range for u beyond 0..1;
    zooms end inside the films' range too."""
    low, high = shot.lens
    if rig == "paper":
        low = high = float(np.clip(rig_paper.FOCAL, low, high))
    bottom, top = np.full_like(u, low), np.full_like(u, high)
    if movement == "zoom-in":
        top = np.maximum(np.minimum(top, max(high, FILM[1]) * mu), bottom)
    elif movement == "dolly-zoom-in":
        bottom = np.minimum(np.maximum(bottom, min(low, FILM[0]) / mu), top)
    elif movement == "dolly-zoom-out":
        top = np.maximum(np.minimum(top, max(high, FILM[1]) / mu), bottom)
    elif movement == "zoom-out":
        bottom = np.minimum(np.maximum(bottom, min(low, FILM[0]) * mu), top)
    return np.asarray(bottom * (top / bottom) ** u)


def _rise(subject: Subject, size: Size, at: NDArray[np.int64], view: Array, theta: Array) -> Array:
    """Metres over the aim at which the size's headroom is [P], of people upright in a view that many metres
    high; 0 for the others, whose middle stays in the middle."""
    drop = subject.landmarks[size.upper][at] - subject.landmarks[size.lower][at]
    stands = drop[:, 2] > FLAT * np.linalg.norm(drop, axis=1)
    upright = stands & (np.sin(theta) > 0.85) & (subject.kind == "person")
    return np.where(upright, (0.5 - size.top) * view / np.maximum(np.sin(theta), 0.5), 0.0)


def _travel(
    subject: Subject,
    movement: str,
    sample: Sample,
    i: NDArray[np.int64],
    framed: _Framed,
    film: tuple[float, float],
    key: NDArray[np.int64],
) -> tuple[Array, Array, NDArray[np.int64]]:
    """Length, share before the framing, and key of dollies and pedestals: along with one who walks that
    way, else a part of what the picture shows."""
    u, before = sample.travel[i], sample.before[i]
    kind, view = family(movement), framed.r / framed.focal
    if kind == "dolly":
        along = SIGN[movement] * basis(np.full_like(framed.phi, np.pi / 2), framed.phi)[0]
        walked = ((subject.position[-1] - subject.position[0]) * along).sum(-1)
        with_it = walked > 0.5
        travel = np.clip(_between("dolly", u) * view * film[0], 0.3, 3.0)
        travel = np.where(with_it, walked * (0.85 + 0.2 * u), travel)
        return travel, np.where(with_it, np.where(key == 1, 1.0, 0.0), before), key
    if kind == "pedestal":
        return np.clip(_between("pedestal", u) * view * film[1], 0.2, 2.0), before, key
    return np.zeros_like(u), before, key


def _between(kind: str, u: Array) -> Array:
    low, high = TRAVELS[kind]
    return low + (high - low) * u
