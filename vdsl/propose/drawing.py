"""Draws the free variables of cameras: stratified, seeded, independent of the order of execution."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace

import numpy as np
from numpy.typing import NDArray

from ..cinema.subspaces import ALL_AROUND, ASIDE, AZIMUTHS, BEFORE, FILM
from ..lang.ir import Shot


def generator(seed: int, shot: str, purpose: str) -> np.random.Generator:
    """The stream of one purpose: the same whatever else has been drawn before."""
    key = hashlib.sha256(f"{seed}\0{shot}\0{purpose}".encode()).digest()
    return np.random.default_rng(np.frombuffer(key, np.uint32))


@dataclass(frozen=True, eq=False)
class Sample:
    """N candidates, every variable spread evenly over its range on its own and shuffled against the others.

    story, movement, scale, angle: int [N] indices into what the shot allows; azimuth: int [N], 0..7
    lam: λ [N]; key: 0 start or 1 end; on: bool; before: 0, 0.5 or 1
    lam_too: λ [N] of the second of two movements at once; noise: [N], seeds of hand-held shakes
    reach: [N], the distance as a share of the solved one; 1 but where cameras are nudged
    the rest [N] in 0..1, to be spread over their ranges: lens, mu, turn, travel, lead, jitter (lens and
        jitter beyond that range where cameras are nudged)
    """

    story: NDArray[np.int64]
    movement: NDArray[np.int64]
    scale: NDArray[np.int64]
    angle: NDArray[np.int64]
    azimuth: NDArray[np.int64]
    lam: NDArray[np.float64]
    key: NDArray[np.int64]
    on: NDArray[np.bool_]
    before: NDArray[np.float64]
    lens: NDArray[np.float64]
    mu: NDArray[np.float64]
    turn: NDArray[np.float64]
    travel: NDArray[np.float64]
    lead: NDArray[np.float64]
    jitter: NDArray[np.float64]
    reach: NDArray[np.float64]
    lam_too: NDArray[np.float64]
    noise: NDArray[np.int64]

    def only(self, rows: NDArray[np.int64]) -> Sample:
        """Some of the candidates, in the order of ``rows`` [M]; a row may be there several times."""
        return Sample(*(getattr(self, f.name)[rows] for f in fields(Sample)))


def put_together(parts: Sequence[Sample]) -> Sample:
    """Several samples as one."""
    return Sample(*(np.concatenate([getattr(p, f.name) for p in parts]) for f in fields(Sample)))


def draw(shot: Shot, stories: int, count: int, rng: np.random.Generator, all_around: bool = False) -> Sample:
    """``count`` candidates for a shot over so many story proposals. all_around: from between the azimuths
    too, as where two have to be seen at the ends of a rack-focus"""

    def pick(n: int) -> NDArray[np.int64]:
        blocks = np.tile(np.arange(n), (math.ceil(count / n), 1))
        return np.asarray(rng.permuted(blocks, axis=1).ravel()[:count]) if n > 1 else np.zeros(count, int)

    def spread() -> NDArray[np.float64]:
        return np.asarray((rng.permutation(count) + rng.random(count)) / count)

    return Sample(
        story=pick(stories),
        movement=pick(len(shot.movements)),
        scale=pick(len(shot.scales)),
        angle=pick(len(shot.angles)),
        azimuth=pick(AZIMUTHS),
        lam=np.asarray(shot.ease, float)[pick(len(shot.ease))],
        key=pick(2),
        on=pick(2).astype(bool),
        before=np.array(BEFORE)[pick(3)],
        lens=spread(),
        mu=spread(),
        turn=spread(),
        travel=spread(),
        lead=spread(),
        jitter=0.5 + (_ASIDE if all_around or shot.focus_to is not None else 1.0) * (spread() - 0.5),
        reach=np.ones(count),
        lam_too=np.asarray(shot.ease, float)[pick(len(shot.ease))],
        noise=rng.integers(2**31, size=count),
    )


#: How far nudged cameras, those of a place, and of a rack-focus, stand off their azimuth: times the usual
#: way, to half way to the next one. Nudged ones go by shares of the solved distance, well within what
#: ``wrong_size`` allows.
_ASIDE = ALL_AROUND / ASIDE
_NEARER, _FARTHER = 0.91, 1.1
#: Lenses, mm, that nudged cameras may have where the line says none: with the shortest a room is shown from
#: within, with the longest a detail from where there is room; and the shares of those that have such.
_SHORTEST, _LONGEST = 21.0, 135.0
_SHORT, _LONG = 0.3, 0.2


def nudged(sample: Sample, rng: np.random.Generator, free: bool) -> Sample:
    """The same candidates for where the usual ones found no room: between the azimuths, from a little
    nearer or farther, with shorter lenses; free: also with lenses that films seldom have"""
    count = len(sample.story)
    reach = _NEARER * (_FARTHER / _NEARER) ** rng.random(count)
    around = bool((np.abs(sample.jitter - 0.5) > 0.5).any())  # they were drawn from all around
    aside = sample.jitter if around else 0.5 + _ASIDE * (sample.jitter - 0.5)
    lens = sample.lens**2
    if free:
        least, most = (math.log(f / FILM[0]) / math.log(FILM[1] / FILM[0]) for f in (_SHORTEST, _LONGEST))
        kind, far = rng.random(count), rng.random(count)
        lens = np.where(
            kind < _SHORT, least * far, np.where(kind > 1 - _LONG, 1.0 + (most - 1.0) * far, lens)
        )
    return replace(sample, jitter=aside, reach=reach, lens=lens)


#: How far a camera that is looked for near another one may be off it (one standard deviation): degrees around
#: the subject, and shares of the range of what else is drawn; and how often it has another easing.
_AROUND, _BESIDE, _OTHER_EASE = 9.0, 0.15, 0.3


def near(sample: Sample, rng: np.random.Generator) -> Sample:
    """As many candidates, each a little off one of ``sample``: what is in words and whole numbers, and the
    distance, is kept."""

    def beside(values: NDArray[np.float64]) -> NDArray[np.float64]:
        moved = values + rng.normal(0.0, _BESIDE, len(values))
        return np.clip(moved, np.minimum(values, 0.0), np.maximum(values, 1.0))

    def eased(lam: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.where(rng.random(len(lam)) < _OTHER_EASE, rng.permutation(lam), lam)

    aside = sample.jitter + rng.normal(0.0, _AROUND / (2 * ASIDE), len(sample.jitter))
    return replace(
        sample,
        jitter=np.clip(aside, 0.5 - 0.5 * _ASIDE, 0.5 + 0.5 * _ASIDE),
        lens=beside(sample.lens),
        mu=beside(sample.mu),
        turn=beside(sample.turn),
        travel=beside(sample.travel),
        lead=beside(sample.lead),
        lam=eased(sample.lam),
        lam_too=eased(sample.lam_too),
    )
