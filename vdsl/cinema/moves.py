"""The nine movements of the paper (section 3.2, Shot Movement), for P cameras over T frames at once.

Every function takes the path the camera holds on to (the paper's p, [T, 3]) and the drawn variables, and
returns where the cameras are, what they look at, and their focal lengths. ``p̂ = p + offset`` is the point
looked at; ``dir(θ, φ) = (cos φ sin θ, sin φ sin θ, cos θ)``; ``w = w_λ(t/(T − 1))``. No camera goes lower
than :data:`FLOOR_CLEARANCE`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from .easing import clock, ease
from .framing import basis, direction
from .track import CameraTrack, look_at_rotation

Array = NDArray[np.float64]
Path3 = tuple[Array, Array, Array]

FLOOR_CLEARANCE = 0.15  # lowest height of a camera over the floor, metres


@dataclass(frozen=True, eq=False)
class Draw:
    """The variables of P cameras of one movement; all [P] unless said.

    r: metres at the first frame; theta, phi: radians at the first frame; focal: mm at the first frame
    offset: [P, 3], from the path to the point looked at
    lam: λ; mu: μ of push, pull and zoom; turn: radians turned by tilt, pan and arc, positive;
    travel: metres along a dolly or pedestal, positive
    before: share of a dolly's or pedestal's way that lies before the framed position (1: ends on it)
    key: 0 where the framing is of the first frame, 1 where of the last
    on: True where a tilt or pan ends on the subject
    kept: True where a tilt or pan is to have its subject in the picture all the time
    rise: metres the aim would be raised if the frame shrank to nothing: pushes, pulls and zooms raise it as
        the frame grows smaller, so that a head stays where it is in the picture; 0 for ``rig paper``
    """

    r: Array
    theta: Array
    phi: Array
    focal: Array
    offset: Array
    lam: Array
    mu: Array
    turn: Array
    travel: Array
    before: Array
    key: NDArray[np.int64]
    on: NDArray[np.bool_]
    kept: NDArray[np.bool_]
    rise: Array


#: +1 or −1 for the directions: pan left, tilt up, dolly right, pedestal up and arc right are positive.
SIGN = {
    "tilt-up": 1.0,
    "tilt-down": -1.0,
    "pan-left": 1.0,
    "pan-right": -1.0,
    "dolly-left": -1.0,
    "dolly-right": 1.0,
    "pedestal-up": 1.0,
    "pedestal-down": -1.0,
    "arc-left": -1.0,
    "arc-right": 1.0,
    "crane-up": 1.0,
    "crane-down": -1.0,
    "roll-left": -1.0,
    "roll-right": 1.0,
    "whip-pan-left": 1.0,
    "whip-pan-right": -1.0,
}


def _weights(path: Array, draw: Draw) -> Array:
    """w_λ(t/(T − 1)), [P, T]; of the few values of λ each is worked out once."""
    lam, which = np.unique(draw.lam, return_inverse=True)
    return np.asarray(ease(clock(len(path))[None, :], lam[:, None])[which])


def _at(path: Array, time: Array) -> Array:
    """Points of the path at times 0..1, between frames linearly: [P, T] -> [P, T, 3]."""
    index = np.arange(len(path), dtype=float)
    where = time * (len(path) - 1)
    return np.stack([np.interp(where, index, path[:, k]) for k in range(3)], axis=-1)


def _lifted(position: Array) -> Array:
    """Positions kept off the floor."""
    if position[..., 2].min(initial=np.inf) >= FLOOR_CLEARANCE:
        return position
    out = position.copy()
    np.maximum(out[..., 2], FLOOR_CLEARANCE, out=out[..., 2])
    return out


def _hold(values: Array, frames: int) -> Array:
    """[P, …] repeated over T frames: [P, T, …]."""
    return np.repeat(values[:, None], frames, axis=1)


def _framed(path: Array, draw: Draw) -> tuple[Array, Array]:
    """Camera and aim [P, 3] of the framing at the key frame."""
    aim = path[np.where(draw.key == 1, len(path) - 1, 0)] + draw.offset
    return _lifted(aim + draw.r[:, None] * direction(draw.theta, draw.phi)), aim


def static(path: Array, draw: Draw, sign: float) -> Path3:
    """Constant, framed on the subject's first or last position."""
    camera, aim = _framed(path, draw)
    n = len(path)
    return _hold(camera, n), _hold(aim, n), _hold(draw.focal, n)


def follow(path: Array, draw: Draw, sign: float) -> Path3:
    """``p̂(w) + r·dir``, looking at p̂(t)."""
    offset = draw.offset[:, None]
    arm = (draw.r[:, None] * direction(draw.theta, draw.phi))[:, None]
    lam, which = np.unique(draw.lam, return_inverse=True)
    eased = _at(path, ease(clock(len(path))[None, :], lam[:, None]))
    camera = _lifted(eased[which] + (offset + arm))
    return camera, path[None] + offset, _hold(draw.focal, len(path))


def lift(draw: Draw, factor: Array) -> Array:
    """How far the aim is raised, [P, T, 3], where the frame is ``factor`` [P, T] of what it is at first."""
    at_key = np.where(draw.key == 1, factor[:, -1], factor[:, 0])
    return np.asarray((draw.rise[:, None] * (1.0 - factor / at_key[:, None]))[..., None] * (0.0, 0.0, 1.0))


def push_pull(path: Array, draw: Draw, sign: float) -> Path3:
    """``r^t = ((μ − 1) w + 1) r^0`` around p̂(t), raised as it comes nearer."""
    factor = (draw.mu[:, None] - 1.0) * _weights(path, draw) + 1.0
    reach = factor * draw.r[:, None]
    aim = path[None] + draw.offset[:, None] + lift(draw, factor)
    camera = _lifted(aim + reach[..., None] * direction(draw.theta, draw.phi)[:, None])
    return camera, aim, _hold(draw.focal, len(path))


def zoom(path: Array, draw: Draw, sign: float) -> Path3:
    """Stands where the first frame is framed; ``f^t = f^0 / ((μ − 1) w + 1)``; looks at p̂(t), raised."""
    camera = _lifted(path[0] + draw.offset + draw.r[:, None] * direction(draw.theta, draw.phi))
    factor = (draw.mu[:, None] - 1.0) * _weights(path, draw) + 1.0
    aim = path[None] + draw.offset[:, None] + lift(draw, factor)
    return _hold(camera, len(path)), aim, draw.focal[:, None] / factor


def _turned(path: Array, draw: Draw, sign: float, horizontal: bool) -> Path3:
    camera, aim = _framed(path, draw)
    level = look_at_rotation(camera, aim)
    w = _weights(path, draw)
    angle = sign * draw.turn[:, None] * np.where(draw.on[:, None], w - 1.0, w)
    pitch = level[:, None, 1] + (0.0 if horizontal else angle)
    yaw = level[:, None, 2] + (angle if horizontal else 0.0)
    ahead = np.stack(
        np.broadcast_arrays(np.cos(pitch) * np.cos(yaw), np.cos(pitch) * np.sin(yaw), np.sin(pitch)), -1
    )
    position = _hold(camera, len(path))
    reach = np.linalg.norm(aim - camera, axis=-1)
    return position, position + reach[:, None, None] * ahead, _hold(draw.focal, len(path))


def tilt(path: Array, draw: Draw, sign: float) -> Path3:
    """Pitch turns by ±turn·(w − 1) towards the subject, or ±turn·w away from it."""
    return _turned(path, draw, sign, horizontal=False)


def pan(path: Array, draw: Draw, sign: float) -> Path3:
    """Yaw turns by ±turn·(w − 1) towards the subject, or ±turn·w away from it."""
    return _turned(path, draw, sign, horizontal=True)


def _carried(path: Array, draw: Draw, axis: Array) -> Path3:
    """From ``K − before·travel·axis`` to ``K + (1 − before)·travel·axis``, with a fixed direction."""
    camera, aim = _framed(path, draw)
    way = draw.travel[:, None] * axis
    start = _lifted(camera - draw.before[:, None] * way)
    end = _lifted(camera + (1.0 - draw.before[:, None]) * way)
    position = start[:, None] + _weights(path, draw)[..., None] * (end - start)[:, None]
    return position, position + (aim - camera)[:, None], _hold(draw.focal, len(path))


def dolly(path: Array, draw: Draw, sign: float) -> Path3:
    """Horizontal, along the picture's right."""
    return _carried(path, draw, sign * basis(draw.theta, draw.phi)[0])


def pedestal(path: Array, draw: Draw, sign: float) -> Path3:
    """Vertical."""
    return _carried(path, draw, np.tile((0.0, 0.0, sign), (len(draw.r), 1)))


def arc(path: Array, draw: Draw, sign: float) -> Path3:
    """``φ^t = φ ± turn·(w − k)`` around p̂(t)."""
    phi = draw.phi[:, None] + sign * draw.turn[:, None] * (_weights(path, draw) - (draw.key == 1)[:, None])
    theta = np.broadcast_to(draw.theta[:, None], phi.shape)
    aim = path[None] + draw.offset[:, None]
    return _lifted(aim + draw.r[:, None, None] * direction(theta, phi)), aim, _hold(draw.focal, len(path))


#: The function of each family.
MOVES: dict[str, Callable[[Array, Draw, float], Path3]] = {
    "static": static,
    "follow": follow,
    "push": push_pull,
    "pull": push_pull,
    "zoom": zoom,
    "tilt": tilt,
    "pan": pan,
    "dolly": dolly,
    "pedestal": pedestal,
    "arc": arc,
}


_TWO_WORDS = ("dolly-zoom", "whip-pan", "rack-focus")
#: The movement of the lens alone: the camera does what it does besides, or stands.
RACK = "rack-focus"


@lru_cache(maxsize=1024)  # asked for every candidate
def family(movement: str) -> str:
    """``pan`` for ``pan-left``, ``dolly-zoom`` for ``dolly-zoom-in``; ``push+pan`` for ``push+pan-left``."""
    if "+" in movement:
        return "+".join(family(part) for part in movement.split("+"))
    return next((name for name in _TWO_WORDS if movement.startswith(name)), movement.split("-")[0])


@lru_cache(maxsize=1024)
def families(movement: str) -> frozenset[str]:
    """The families of all that a camera does at once."""
    return frozenset(family(part) for part in of_camera(movement).split("+"))


def of_camera(movement: str) -> str:
    """What the camera does in a movement, without what the lens does."""
    return "+".join(part for part in movement.split("+") if part != RACK) or "static"


def track_of(
    movement: str, path: Array, draw: Draw, sensor: tuple[float, float], roll: float = 0.0
) -> CameraTrack:
    """The tracks [P, T, …] of one movement; the horizon is level but for ``roll`` radians.

    Yaw runs on without jumps of a full turn.
    """
    position, look_at, focal = MOVES[family(movement)](path, draw, SIGN.get(movement, 1.0))
    look_at = np.broadcast_to(look_at, position.shape).copy()
    rotation = look_at_rotation(position, look_at, roll)
    yaw = rotation[..., 2]
    if np.abs(np.diff(yaw, axis=-1)).max(initial=0.0) > np.pi:
        rotation[..., 2] = np.unwrap(yaw, axis=-1)
    return CameraTrack(position, rotation, focal, look_at, sensor)
