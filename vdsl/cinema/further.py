"""Movements beyond the paper's, and two at once: cranes, rolls, dolly zooms, hand-held and whip pans.

Every part of a movement changes what a camera is made of (distance, azimuth, elevation, focal length, a
shift, a turn of its own, a shake), each by its own easing; parts add up, so any two go together. All is said
relative to the key frame, where the framing holds whatever the parts are.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .easing import clock, ease
from .framing import basis, direction
from .moves import FLOOR_CLEARANCE, SIGN, Draw, family, lift
from .track import CameraTrack, look_at_rotation

Array = NDArray[np.float64]

#: Families of this module; those of :mod:`.moves` may be parts too.
FURTHER = ("crane", "roll", "dolly-zoom", "handheld", "whip-pan")
#: Of these the camera stays by where the subject is at the key frame. A roll goes where what it is joined to
#: does; by itself it goes with the subject.
_FIXED = ("static", "zoom", "tilt", "pan", "dolly", "pedestal", "whip-pan")
WHIP_AT, WHIP_SECONDS = 0.2, 0.3  # middle of a whip, share of the take; how long it lasts
_ZENITH = np.radians(4.0)  # how near to straight down a crane comes
_SHAKE, _SWAY = 0.008, np.radians(0.28)  # hand-held: metres and radians, root mean square
_BAND = (0.5, 2.4)  # hertz
_TONES = 6  # sines of a shake


@dataclass(frozen=True, eq=False)
class Part:
    """One of the movements going on at once: its word (with its direction), and what was drawn for it."""

    movement: str
    draw: Draw


def combined(
    parts: Sequence[Part],
    path: Array,
    film: tuple[float, float],
    roll: float,
    fps: float,
    seeds: NDArray[np.int64],
) -> CameraTrack:
    """Tracks [P, T, …] of movements at once; r, θ, φ and focal length are those of the first part's draw.

    path: [T, 3], what the cameras hold on to; seeds: [P], of hand-held shakes
    """
    draw, frames = parts[0].draw, len(path)
    kinds = [family(part.movement) for part in parts]
    last = np.where(draw.key == 1, frames - 1, 0)
    others = [kind for kind in kinds if kind != "roll"]
    fixed = bool(others) and all(kind in _FIXED for kind in others)
    held = np.broadcast_to(path[last][:, None] if fixed else path[None], (len(last), frames, 3))
    r, theta, phi, focal = (
        np.repeat(v[:, None], frames, axis=1) for v in (draw.r, draw.theta, draw.phi, draw.focal)
    )
    shift = np.zeros((len(last), frames, 3))
    turn = np.zeros((len(last), frames, 3))  # of roll, pitch, yaw
    glance = np.zeros((len(last), frames, 3))  # of what is looked at alone
    for part, kind in zip(parts, kinds, strict=True):
        d, sign = part.draw, SIGN.get(part.movement, 1.0)
        w = np.asarray(ease(clock(frames)[None], d.lam[:, None]))
        since = w - (draw.key == 1)[:, None]  # 0 at the key frame
        if kind in ("push", "pull", "dolly-zoom"):
            factor = (d.mu[:, None] - 1.0) * w + 1.0
            r = r * factor
            if kind == "dolly-zoom":
                focal = focal * factor
            else:
                shift = shift + lift(d, factor)
        elif kind == "zoom":
            factor = (d.mu[:, None] - 1.0) * w + 1.0
            focal, glance = focal / factor, lift(d, factor)
        elif kind == "arc":
            phi = phi + sign * d.turn[:, None] * since
        elif kind == "crane":
            theta = theta - sign * _room(d, draw, path[last], sign)[:, None] * since
        elif kind in ("dolly", "pedestal"):
            axis = basis(draw.theta, draw.phi)[0] if kind == "dolly" else np.array([[0.0, 0.0, 1.0]])
            shift = shift + ((w - d.before[:, None]) * sign * d.travel[:, None])[..., None] * axis[:, None]
        elif kind in ("tilt", "pan", "roll", "whip-pan"):
            axis_of = {"roll": 0, "tilt": 1}.get(kind, 2)
            eased = whip(frames, fps)[None] if kind == "whip-pan" else w
            turn[..., axis_of] += sign * d.turn[:, None] * (eased - d.on[:, None])
    aim = held + draw.offset[:, None]
    position = aim + r[..., None] * direction(theta, phi) + shift
    position[..., 2] = np.maximum(position[..., 2], FLOOR_CLEARANCE)
    return _turned(position, aim + shift + glance, turn, focal, film, roll, kinds, draw, fps, seeds)


def _turned(
    position: Array,
    aim: Array,
    turn: Array,
    focal: Array,
    film: tuple[float, float],
    roll: float,
    kinds: Sequence[str],
    draw: Draw,
    fps: float,
    seeds: NDArray[np.int64],
) -> CameraTrack:
    """The cameras looking at their aim, turned away from it and shaken."""
    frames = position.shape[1]
    rotation = look_at_rotation(position, aim, roll)
    rotation[..., 2] = np.unwrap(rotation[..., 2], axis=-1)
    rotation = rotation + turn
    if "handheld" in kinds:
        noise = shakes(seeds, frames, fps)
        noise = noise - noise[np.arange(len(seeds)), np.where(draw.key == 1, frames - 1, 0)][:, None]
        position = position + _SHAKE * noise[..., :3]
        position[..., 2] = np.maximum(position[..., 2], FLOOR_CLEARANCE)
        rotation[..., 1:] += _SWAY * noise[..., 3:]
    reach = np.linalg.norm(aim - position, axis=-1)
    pitch, yaw = rotation[..., 1], rotation[..., 2]
    ahead = np.stack([np.cos(pitch) * np.cos(yaw), np.cos(pitch) * np.sin(yaw), np.sin(pitch)], axis=-1)
    return CameraTrack(position, rotation, focal, position + reach[..., None] * ahead, film)


def _room(part: Draw, draw: Draw, held: Array, sign: float) -> Array:
    """How far a crane's θ may turn [P]: neither past the zenith nor under the floor."""
    turn = part.turn
    rises = np.where(draw.key == 1, -sign, sign) > 0  # away from the key frame
    up = np.maximum(draw.theta - _ZENITH, 0.0)
    sink = (FLOOR_CLEARANCE - held[:, 2] - draw.offset[:, 2]) / np.maximum(draw.r, 1e-6)
    down = np.maximum(np.arccos(np.clip(sink, -1.0, 1.0)) - draw.theta, 0.0)
    return np.asarray(np.minimum(turn, np.where(rises, up, down)))


def whip(frames: int, fps: float) -> Array:
    """How far a whip pan has come at every frame, 0..1 [T]: still, a sweep, still."""
    share = min(WHIP_SECONDS * fps / max(frames - 1, 1), 0.8)
    t = np.clip((clock(frames) - WHIP_AT) / share + 0.5, 0.0, 1.0)
    return np.asarray(t**3 * (10.0 - 15.0 * t + 6.0 * t**2))


def shakes(seeds: NDArray[np.int64], frames: int, fps: float) -> Array:
    """Band-limited noise of unit strength [P, T, 5], the same for the same seeds."""
    time = np.arange(frames) / fps
    out = np.empty((len(seeds), frames, 5))
    edges = np.geomspace(*_BAND, _TONES + 1)
    for p, seed in enumerate(seeds):
        rng = np.random.default_rng(int(seed))
        hertz = edges[:-1] + rng.random((5, _TONES)) * np.diff(edges)
        phase = 2 * np.pi * rng.random((5, _TONES))
        strength = hertz**-0.25
        tones = np.sin(2 * np.pi * hertz[..., None] * time + phase[..., None]) * strength[..., None]
        out[p] = (tones.sum(axis=1) / np.sqrt((strength**2).sum(axis=1, keepdims=True) / 2)).T
    return out
