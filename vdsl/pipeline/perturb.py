"""Negatives for the discriminator: good tracks shaken about in the seven-number camera space.

"The negative samples come from a random perturbation in the camera action space" (the paper, section
3.3). Strength 0 changes nothing; 1 is gross.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ..cinema.track import CameraTrack, look_at_rotation

#: At strength 1: share of the subject's distance, radians of aim and roll, log of the focal length,
#: metres and radians of unsteadiness.
_SHIFT, _AIM, _ROLL, _FOCAL = 0.9, np.deg2rad(28.0), np.deg2rad(22.0), 0.8
_SHAKE_POSITION, _SHAKE_AIM = 0.18, np.deg2rad(9.0)
_LOWEST = 0.08  # metres above the floor
_WAVES = (1, 2, 3, 7, 11)  # of noise, in a take


def perturbation(strength: float, rng: np.random.Generator) -> Callable[[CameraTrack], CameraTrack]:
    """What puts some of a track's seven numbers off, by up to ``strength`` (0..1): all that is left to chance
    is drawn, and most of the work is still to do."""
    which = rng.random(5) < 0.55
    if not which.any():
        which[rng.integers(5)] = True
    shift, aim, roll, focal, shake = which * strength
    aside, wobble = _unit(rng), rng.random((len(_WAVES), 3))
    leans = _ROLL * roll * rng.choice((-1, 1)) * rng.uniform(0.5, 1)
    tilts = _AIM * aim * 0.7 * rng.choice((-1, 1)) * rng.uniform(0.4, 1)
    pans = _AIM * aim * rng.choice((-1, 1)) * rng.uniform(0.4, 1)
    judder = rng.random((len(_WAVES), 3))
    scale = np.exp(_FOCAL * focal * rng.choice((-1, 1)) * rng.uniform(0.4, 1))

    def of(track: CameraTrack) -> CameraTrack:
        frames = len(track.focal)
        reach = float(np.linalg.norm(track.look_at[0] - track.position[0]))
        position = track.position + shift * _SHIFT * reach * aside
        position = position + shake * _SHAKE_POSITION * _noise(wobble, frames)
        position[:, 2] = np.maximum(position[:, 2], _LOWEST)
        rotation = track.rotation.copy()
        rotation[:, 0] += leans
        rotation[:, 1] += tilts
        rotation[:, 2] += pans
        rotation[:, 1:] += shake * _SHAKE_AIM * _noise(judder, frames)[:, :2]
        return CameraTrack(position, rotation, track.focal * scale, track.look_at, track.sensor)

    return of


def mistyped(track: CameraTrack, rng: np.random.Generator) -> CameraTrack:
    """The track as one that does not show what was asked: a size between two, or a movement that is none.

    A lens that cuts through joints, a movement that turns round half-way, or one that wanders off its subject
    and onto it again.
    """
    kind = rng.integers(3)
    if kind == 0:
        focal = track.focal * np.exp(rng.choice((-1, 1)) * rng.uniform(0.28, 0.4))
        rotation = track.rotation.copy()
        rotation[:, 1] += rng.choice((-1, 1)) * rng.uniform(0.03, 0.07)
        return replace(track, rotation=rotation, focal=focal)
    frames = len(track.focal)
    t = np.linspace(0.0, 1.0, frames)
    turn = rng.uniform(0.4, 0.6)
    there = np.minimum(t / turn, (1 - t) / (1 - turn))
    if kind == 1:
        at = there * (frames - 1)
        rotation = np.unwrap(track.rotation, axis=0)
        position, rotation, focal = (_between(v, at) for v in (track.position, rotation, track.focal))
        moved = CameraTrack(position, rotation, focal, track.look_at, track.sensor)
        still = float(np.linalg.norm(np.ptp(track.position, axis=0))) + float(np.ptp(track.rotation[:, 2]))
        if still > 0.1:
            return moved
    aim = track.look_at - track.position
    across = np.cross(aim, (0.0, 0.0, 1.0))
    away = there[:, None] * across * rng.choice((-1, 1)) * rng.uniform(0.3, 0.6)
    turned = look_at_rotation(track.position, track.look_at + away)
    turned -= look_at_rotation(track.position, track.look_at)
    return replace(track, rotation=track.rotation + (turned + np.pi) % (2 * np.pi) - np.pi)


def _between(values: NDArray[np.float64], at: NDArray[np.float64]) -> NDArray[np.float64]:
    """Values [T, …] at moments between frames, in their straight way from one to the next: whole frames would
    judder."""
    first = np.minimum(at.astype(int), len(values) - 1)
    share = (at - first).reshape(-1, *[1] * (values.ndim - 1))
    return np.asarray(
        values[first] + share * (values[np.minimum(first + 1, len(values) - 1)] - values[first])
    )


def _unit(rng: np.random.Generator) -> NDArray[np.float64]:
    v = rng.normal(size=3)
    return np.asarray(v / np.linalg.norm(v))


def _noise(phases: NDArray[np.float64], frames: int) -> NDArray[np.float64]:
    """Band-limited noise [T, 3] of unit size: three slow waves and two quick ones, which begin at ``phases``
    [5, 3] of a turn."""
    t = np.arange(frames)[:, None] / max(frames, 1)
    waves = [np.sin(2 * np.pi * (k * t + phase)) / k**0.5 for k, phase in zip(_WAVES, phases, strict=True)]
    return np.asarray(sum(waves) / 2.0)
