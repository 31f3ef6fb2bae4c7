"""Captured motion played by a body: fitted to its proportions, feet planted, blended in and out.

:func:`fitted` does what can be done without a place: the pose of every frame for one skeleton, and where its
feet stand. A foot that is low and slow stands: it is put where it is on the whole and does not move until it
is lifted; in between it goes as captured, led from one place to the next. :func:`play` lays a placed capture
over a posed figure.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter1d

from runtime.body.skeleton import JOINT, PARENTS, Skeleton, forward_kinematics

from .curves import ease, ramp, smooth
from .feet import Feet, Step, ankle_positions, rolled
from .figure import SIDES, Figure
from .rotations import blend, quaternion, rot_z, turned, unwrapped
from .types import Capture

Array = NDArray[np.float64]
#: Seconds of blending from what was before, and to what comes after.
BLEND_IN, BLEND_OUT = 0.45, 0.35
#: A foot stands where it is this slow and its sole this near the floor; nearer where it is not still, as
#: captured feet rarely come down to the floor all the way (metres, metres a second, at 1.7 m).
SLOW, NEAR, NEARER = 0.5, 0.075, 0.03
#: Seconds: gaps between two standings of a foot that are none, and standings too short to be any.
GAP, SHORT = 0.07, 0.09


@dataclass(frozen=True, eq=False)
class Fitted:
    """A capture on one skeleton, over N frames, as if it began over the origin on a floor at 0, facing +X.

    turns: [N, J, 3, 3] in the world, of known joints; hips: [N, 3]; yaw: [N], where the hips face
    place [2, N, 3] (x, y, yaw of the flat foot), pitch, lift [2, N], standing: bool [2, N]; knees: [2, N, 3],
    where knees point
    """

    fps: float
    turns: Array
    known: NDArray[np.bool_]
    hips: Array
    yaw: Array
    place: Array
    pitch: Array
    lift: Array
    standing: NDArray[np.bool_]
    knees: Array

    @property
    def seconds(self) -> float:
        return (len(self.hips) - 1) / self.fps

    def at(self, share: Array) -> tuple[NDArray[np.int64], Array]:
        """Frames before the given shares of the whole, and how far it is to the next."""
        frame = np.clip(share, 0.0, 1.0) * (len(self.hips) - 1)
        first = np.minimum(frame.astype(np.int64), len(self.hips) - 2)
        return first, frame - first


@dataclass(frozen=True, eq=False)
class Replay:
    """A fitted capture in its place: from ``start`` for ``duration`` seconds, at (x, y) on ``floor``."""

    fitted: Fitted
    start: float
    duration: float
    at: tuple[float, float]
    heading: float
    floor: float

    def way(self, rate: float) -> tuple[Array, Array]:
        """Floor points below the hips [K, 3] and headings [K] at ``rate`` a second."""
        share = np.linspace(0.0, 1.0, max(2, int(np.ceil(self.duration * rate)) + 1))
        xyz = self.placed(_between(self.fitted.hips, *self.fitted.at(share)))
        xyz[:, 2] = self.floor
        return xyz, self.heading + _between(self.fitted.yaw, *self.fitted.at(share))

    def steps(self) -> list[Step]:
        """The steps the feet take, from standing as before to how they stand when it is over."""
        out = []
        frame = self.duration / (len(self.fitted.hips) - 1)
        for foot in (0, 1):
            lift = self.start
            stands = runs(self.fitted.standing[foot])
            for a, b in (*stands, (len(self.fitted.hips) - 1, len(self.fitted.hips))):
                land = max(self.start + a * frame, lift + 0.1, self.start + 0.9 * BLEND_IN)
                land = min(land, self.start + self.duration)
                if land - lift < 0.05:
                    continue
                out.append(Step(foot, lift, land, self._foot(foot, a), ground=self.floor))
                lift = max(land, self.start + b * frame)
        return out

    def _foot(self, foot: int, frame: int) -> tuple[float, float, float]:
        """Where a foot is (x, y, yaw) at a frame of the capture."""
        x, y, yaw = self.fitted.place[foot, frame]
        at = self.placed(np.array([[x, y, 0.0]]))[0]
        return (float(at[0]), float(at[1]), float(yaw + self.heading))

    def placed(self, points: Array) -> Array:
        c, s = np.cos(self.heading), np.sin(self.heading)
        x, y = points[..., 0], points[..., 1]
        return np.stack(
            [self.at[0] + c * x - s * y, self.at[1] + s * x + c * y, self.floor + points[..., 2]], axis=-1
        )


def fitted(capture: Capture, skeleton: Skeleton) -> Fitted:
    """The capture on a body of other proportions."""
    frames, bind = len(capture.turns), skeleton.bind
    leg = float(bind[JOINT["hips"]][2] - bind[JOINT["foot_l"]][2])
    turns = capture.turns.astype(np.float64)
    full = _filled(turns, capture.known)
    hips = capture.root * leg
    world = forward_kinematics(skeleton, _local(full), hips)
    ankles = np.stack([world[:, JOINT[f"foot_{s}"], :3, 3] for s in SIDES])
    ahead = np.stack([world[:, JOINT[f"foot_{s}"], :3, 0] for s in SIDES])
    yaw = unwrapped(np.arctan2(ahead[..., 1], ahead[..., 0]))
    pitch = np.clip(np.arcsin(np.clip(-ahead[..., 2], -1, 1)), -0.6, 1.4)
    back, up = rolled(skeleton, pitch)
    place = np.stack([ankles[..., 0] - back * np.cos(yaw), ankles[..., 1] - back * np.sin(yaw), yaw], axis=-1)
    lift = ankles[..., 2] - bind[JOINT["foot_l"]][2] - up
    ground = float(np.percentile(lift.min(axis=0), 10))
    lift, hips = lift - ground, hips - np.array([0.0, 0.0, ground])
    standing = np.stack([_standing(place[k], lift[k], capture.fps, skeleton.height / 1.7) for k in (0, 1)])
    for k in (0, 1):
        place[k], lift[k] = _locked(place[k], lift[k], standing[k])
    ankle, _ = ankle_positions(skeleton, _feet(place, pitch, lift, standing, np.zeros((2, frames))))
    hip = np.stack([world[:, JOINT[f"thigh_{s}"], :3, 3] for s in SIDES]) - np.array([0.0, 0.0, ground])
    hips = (
        hips
        - np.array([0.0, 0.0, 1.0])
        * _lowered(hip, ankle, standing, leg_length(skeleton), capture.fps)[:, None]
    )
    face = full[:, JOINT["hips"], :, 0]
    facing = smooth(unwrapped(np.arctan2(face[:, 1], face[:, 0])), 0.12 * capture.fps)
    knees = np.stack(
        [world[:, JOINT[f"shin_{s}"], :3, 0] + world[:, JOINT[f"thigh_{s}"], :3, 0] for s in SIDES]
    )
    return Fitted(capture.fps, turns, capture.known, hips, facing, place, pitch, lift, standing, knees)


def leg_length(skeleton: Skeleton) -> float:
    """From hip joint to ankle, straight."""
    thigh, shin, foot = (skeleton.bind[JOINT[f"{n}_l"]] for n in ("thigh", "shin", "foot"))
    return float(np.linalg.norm(shin - thigh) + np.linalg.norm(foot - shin))


def _filled(turns: Array, known: NDArray[np.bool_]) -> Array:
    """World turns of all joints: those not known go with their parents."""
    out = turns.copy()
    for j, parent in enumerate(PARENTS):
        if not known[j] and parent >= 0:
            out[:, j] = out[:, parent]
    return out


def _local(world: Array) -> Array:
    out = world.copy()
    for j, parent in enumerate(PARENTS):
        if parent >= 0:
            out[:, j] = np.swapaxes(world[:, parent], -1, -2) @ world[:, j]
    return out


# --- feet -----------------------------------------------------------------------------


def _standing(place: Array, lift: Array, fps: float, scale: float) -> NDArray[np.bool_]:
    """[N]: low and slow, without gaps and moments that are none."""
    speed = np.linalg.norm(np.gradient(place[:, :2], axis=0), axis=1) * fps
    speed = smooth(speed, 0.03 * fps)
    still = np.clip(1.0 - speed / (0.7 * SLOW * scale), 0.0, 1.0)
    low = (lift < (NEARER + (NEAR - NEARER) * still) * scale) & (speed < SLOW * scale)
    for value, seconds in ((False, GAP), (True, SHORT)):
        for a, b in runs(low == value):
            inside = a > 0 and b < len(low)
            if b - a < seconds * fps and (inside or value):
                low[a:b] = not value
    return np.asarray(low)


def runs(on: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Stretches of True as (first, after the last)."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], on, [False]]).astype(int)))
    return [(int(a), int(b)) for a, b in edges.reshape(-1, 2)]


def _locked(place: Array, lift: Array, standing: NDArray[np.bool_]) -> tuple[Array, Array]:
    """A foot that does not move while it stands, and in between goes from one standing to the next."""
    found = runs(standing)
    if not found:
        return place, np.maximum(lift, 0.0)
    shift = np.zeros((len(place), 4))  # x, y, yaw, lift
    frames = np.arange(len(place))
    raw = np.concatenate([place, lift[:, None]], axis=1)
    stops = [np.array([*np.median(place[a:b], axis=0), 0.0]) for a, b in found]
    edges, moved = [], []
    for (a, b), stop in zip(found, stops, strict=True):
        edges += [a, b - 1]
        moved += [stop - raw[a], stop - raw[b - 1]]
    first, last = edges[0], edges[-1]
    shift[:first], shift[last:] = moved[0], moved[-1]
    for k in range(len(edges) - 1):
        a, b = edges[k], edges[k + 1]
        share = ease((frames[a : b + 1] - a) / max(b - a, 1))[:, None]
        shift[a : b + 1] = moved[k] + share * (moved[k + 1] - moved[k])
    out = raw + shift
    for (a, b), stop in zip(found, stops, strict=True):
        out[a:b] = stop
    return out[:, :3], np.maximum(out[:, 3], 0.0)


def _lowered(hip: Array, ankle: Array, standing: NDArray[np.bool_], leg: float, fps: float) -> Array:
    """[N]: how far the hips come down so that standing feet are within reach."""
    flat = np.linalg.norm((ankle - hip)[..., :2], axis=-1)
    highest = ankle[..., 2] + np.sqrt(np.maximum((0.997 * leg) ** 2 - flat**2, (0.3 * leg) ** 2))
    over = np.where(standing, np.maximum(hip[..., 2] - highest, 0.0), 0.0).max(axis=0)
    wide = max(3, round(0.16 * fps))
    return smooth(maximum_filter1d(over, wide), 0.25 * wide)


def _feet(place: Array, pitch: Array, lift: Array, standing: NDArray[np.bool_], ground: Array) -> Feet:
    air = np.where(standing, 0.0, 1.0)
    return Feet(place=place, pitch=pitch, lift=lift, air=air, run=np.zeros_like(air), ground=ground)


# --- playing --------------------------------------------------------------------------


def play(replay: Replay, figure: Figure, feet: Feet, t: Array) -> tuple[slice, NDArray[np.bool_]]:
    """Poses the figure over the frames of the replay; ``feet``: how they stand without it.

    Returns those frames, and which feet stand in them, bool [2, n].
    """
    inside = np.flatnonzero((t >= replay.start) & (t <= replay.start + replay.duration))
    if len(inside) < 2:
        return slice(0, 0), np.zeros((2, 0), bool)
    own = slice(int(inside[0]), int(inside[-1]) + 1)
    part = Figure(figure.skeleton, own.stop - own.start)
    part.rotation[:], part.position[:] = figure.rotation[own], figure.position[own]
    fit, since = replay.fitted, t[own] - replay.start
    first, share = fit.at(since / replay.duration)
    weight = ramp(since, 0.0, BLEND_IN) * (1.0 - ramp(since, replay.duration - BLEND_OUT, replay.duration))
    _lay(part, replay, first, share, weight)
    standing = _stand(part, replay, _sliced(feet, own), (first, share), since, weight)
    figure.rotation[own], figure.position[own] = part.rotation, part.position
    return own, standing


def _lay(part: Figure, replay: Replay, first: NDArray[np.int64], share: Array, weight: Array) -> None:
    """All but the legs, from the hips up: local turns drawn to the captured ones."""
    fit = replay.fitted
    base = _local(part.rotation)
    turns = rot_z(np.array(replay.heading)) @ _turns_between(fit.turns, first, share)
    captured = base.copy()
    world = part.rotation.copy()
    for j, parent in enumerate(PARENTS):
        if fit.known[j]:
            world[:, j] = turns[:, j]
            captured[:, j] = (
                world[:, j] if parent < 0 else np.swapaxes(world[:, parent], -1, -2) @ world[:, j]
            )
        elif parent >= 0:
            world[:, j] = world[:, parent] @ base[:, j]
    local = base.copy()
    for joint in np.flatnonzero(fit.known):
        local[:, joint] = blend(base[:, joint], captured[:, joint], weight)
    hips = replay.placed(_between(fit.hips, first, share))
    root = part.position[:, 0] + weight[:, None] * (hips - part.position[:, 0])
    placed = forward_kinematics(part.skeleton, local, root)
    part.rotation[:], part.position[:] = placed[..., :3, :3], placed[..., :3, 3]


def _stand(
    part: Figure, replay: Replay, base: Feet, at: tuple[NDArray[np.int64], Array], since: Array, weight: Array
) -> NDArray[np.bool_]:
    """Legs to where the feet are: as they stand without the replay, then as captured, then without again."""
    fit = replay.fitted
    first, share = at
    place = np.stack([_between(fit.place[k], first, share) for k in (0, 1)])
    lift, pitch = (np.stack([_between(x[k], first, share) for k in (0, 1)]) for x in (fit.lift, fit.pitch))
    xy = replay.placed(np.concatenate([place[..., :2], np.zeros_like(lift)[..., None]], axis=-1))
    goal = np.concatenate([xy[..., :2], place[..., 2:] + replay.heading], axis=-1)
    goal[..., 2] = (
        base.place[..., 2] + np.remainder(goal[..., 2] - base.place[..., 2] + np.pi, 2 * np.pi) - np.pi
    )
    goal[..., 2] = unwrapped(goal[..., 2])
    half = 0.55 * BLEND_IN
    over = np.stack([ease(np.clip((since - d) / half, 0, 1)) for d in (0.0, BLEND_IN - half)])
    over = over * (1.0 - ramp(since, replay.duration - BLEND_OUT, replay.duration))
    apart = np.linalg.norm(goal[..., :2] - base.place[..., :2], axis=-1)
    begun = np.stack([np.clip((since - d) / half, 0, 1) for d in (0.0, BLEND_IN - half)])
    step = np.sin(np.pi * begun) ** 2 * np.clip(apart[:, :1] / 0.1, 0.0, 1.0) * 0.05
    mixed = Feet(
        place=base.place + over[..., None] * (goal - base.place),
        pitch=base.pitch + over * (pitch - base.pitch),
        lift=base.lift * (1 - over) + over * lift + step,
        air=base.air,
        run=base.run,
        ground=np.full_like(lift, replay.floor),
    )
    ankle, toes = ankle_positions(part.skeleton, mixed)
    hips = part.hip_joints()
    pull = ankle - hips
    far = np.linalg.norm(pull, axis=-1, keepdims=True)
    ankle = hips + pull * np.minimum(1.0, 0.9995 * leg_length(part.skeleton) / np.maximum(far, 1e-6))
    knees = turned(
        rot_z(np.array(replay.heading)), np.stack([_between(fit.knees[k], first, share) for k in (0, 1)])
    )
    spread = np.full_like(lift, 0.1)
    part.legs(ankle, mixed.place[..., 2], mixed.pitch, toes, spread, (weight, knees * weight[:, None]))
    stands = fit.standing[:, first] & fit.standing[:, np.minimum(first + 1, len(fit.hips) - 1)]
    free = (since > BLEND_IN + 0.05) & (since < replay.duration - BLEND_OUT)
    return np.asarray(stands & free)


def _sliced(feet: Feet, own: slice) -> Feet:
    return Feet(feet.place[:, own], feet.pitch[:, own], feet.lift[:, own], feet.air[:, own], feet.run[:, own],
                feet.ground[:, own])  # fmt: skip


def _between(values: Array, first: NDArray[np.int64], share: Array) -> Array:
    """Values [N, …] at frames ``first + share``."""
    part = share.reshape(-1, *([1] * (values.ndim - 1)))
    return np.asarray(values[first] * (1 - part) + values[first + 1] * part)


def _turns_between(turns: Array, first: NDArray[np.int64], share: Array) -> Array:
    """Rotations [n, J, 3, 3] at frames ``first + share`` of [N, J, 3, 3], by the shorter way."""
    a, b = quaternion(turns[first]), quaternion(turns[first + 1])
    b = np.where((a * b).sum(-1, keepdims=True) < 0, -b, b)
    q = a + share[:, None, None] * (b - a)
    w, x, y, z = np.moveaxis(q / np.linalg.norm(q, axis=-1, keepdims=True), -1, 0)
    out = np.empty((*w.shape, 3, 3))
    out[..., 0, 0], out[..., 0, 1], out[..., 0, 2] = (
        1 - 2 * (y * y + z * z),
        2 * (x * y - w * z),
        2 * (x * z + w * y),
    )
    out[..., 1, 0], out[..., 1, 1], out[..., 1, 2] = (
        2 * (x * y + w * z),
        1 - 2 * (x * x + z * z),
        2 * (y * z - w * x),
    )
    out[..., 2, 0], out[..., 2, 1], out[..., 2, 2] = (
        2 * (x * z - w * y),
        2 * (y * z + w * x),
        1 - 2 * (x * x + y * y),
    )
    return out
