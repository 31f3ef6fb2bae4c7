"""Measures a performed scene against what the work promises: feet, hands, eyes, joints and clearance.

:func:`measure` gives numbers for one person, :func:`violations` the ones that are out of bounds, in words.
Lengths are metres inside and centimetres in :class:`Measures`, angles degrees.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from runtime.body.skeleton import JOINT, Skeleton
from runtime.motion.types import SceneMotion
from runtime.world import World

Array = NDArray[np.float64]

SLIDE, SINK, HAND, GAZE = 2.0, 1.0, 3.0, 10.0  # cm, cm, cm, degrees
#: What people's joints do, degrees: (joint, axis) to lowest and highest. Elbows and knees by their bend,
#: the others by the angle away from straight, or the turn about the upright.
LIMITS: dict[str, tuple[float, float]] = {
    "elbow": (-2, 161), "knee": (-2, 163), "neck turn": (-90, 90), "neck nod": (-75, 70),
    "neck tilt": (-50, 50),
    "spine lean": (-45, 95), "spine side": (-42, 42), "spine twist": (-60, 60), "upper arm": (0, 182),
    "hip bend": (-45, 150),
}  # fmt: skip
BODY = 0.2  # metres: half a body's width, as paths keep clear of solid things


@dataclass(frozen=True)
class Measures:
    """The worst of one person: slide and sink (cm), hand (cm), gaze and joints (degrees, by name lowest and
    highest), clearance (metres to the nearest solid thing while going anywhere; None without a world)."""

    slide: float
    sink: float
    hand: float
    gaze: float
    joints: dict[str, tuple[float, float]]
    clearance: float | None


def measure(
    motion: SceneMotion, who: str, skeleton: Skeleton, fps: float = 24.0, world: World | None = None
) -> Measures:
    """Everything about one person."""
    clear = _clearance(motion, who, world) if world is not None else None
    slide, sink = _feet(motion, who, skeleton)
    return Measures(slide, sink, _hands(motion, who), _gaze(motion, who, fps), _joints(motion, who), clear)


def violations(measures: Measures) -> list[str]:
    """What is out of bounds, in words."""
    found = []
    bounds = (
        ("a planted foot slides", measures.slide, SLIDE, "cm"),
        ("a foot or knee goes under the floor", measures.sink, SINK, "cm"),
        ("a hand misses what it touches by", measures.hand, HAND, "cm"),
        ("the eyes miss what they look at by", measures.gaze, GAZE, "deg"),
    )
    for what, value, limit, unit in bounds:
        if value > limit:
            found.append(f"{what} {value:.1f} {unit} (at most {limit:g})")
    for name, (low, high) in measures.joints.items():
        least, most = LIMITS[name]
        if low < least or high > most:
            found.append(f"{name} goes from {low:.0f} to {high:.0f} deg (from {least:g} to {most:g})")
    if measures.clearance is not None and measures.clearance < -0.03:
        found.append(f"the body is {-100 * measures.clearance:.0f} cm inside something solid")
    return found


def sole_points(motion: SceneMotion, who: str, skeleton: Skeleton, side: str) -> dict[str, Array]:
    """Heel, ball and toe tip of a foot on its sole, each [T, 3]."""
    bind = skeleton.bind
    foot, toe = JOINT[f"foot_{side}"], JOINT[f"toe_{side}"]
    ball = bind[toe] - bind[foot]
    heel = np.array([-0.30 * ball[0], 0.0, -bind[foot][2]])
    under = np.array([0.0, 0.0, -bind[toe][2]])
    return {"heel": _point(motion, who, foot, heel), "ball": _point(motion, who, toe, under)}


def _point(motion: SceneMotion, who: str, joint: int, offset: Array) -> Array:
    matrix = motion.world_from_joint[who][:, joint].astype(np.float64)
    return np.asarray(matrix[:, :3, :3] @ offset + matrix[:, :3, 3])


def _feet(motion: SceneMotion, who: str, skeleton: Skeleton) -> tuple[float, float]:
    """Slide of planted feet and depth under the floor, cm."""
    touches = motion.touches[who]
    slide = sink = 0.0
    for k, side in enumerate("lr"):
        ground = touches.ground[k]
        for name, points in sole_points(motion, who, skeleton, side).items():
            above = points[:, 2] - ground
            sink = max(sink, float(-above.min()) if name == "heel" else float(-(above + 0.004).min()))
            on = touches.planted[k] & (above < 0.012)
            for a, b in _stretches(on):
                spread = points[a:b, :2] - points[a, :2]
                slide = max(slide, float(np.linalg.norm(spread, axis=1).max()))
        knee = motion.world_from_joint[who][:, JOINT[f"shin_{side}"], 2, 3].astype(np.float64)
        sink = max(sink, float((ground - knee).max()))
    return 100.0 * slide, 100.0 * max(sink, 0.0)


def _stretches(on: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Runs of True as (first, after the last)."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], on, [False]]).astype(int)))
    return [(int(a), int(b)) for a, b in edges.reshape(-1, 2)]


def _hands(motion: SceneMotion, who: str) -> float:
    """Farthest a palm is from where it is to be, cm."""
    touches = motion.touches[who]
    apart = np.linalg.norm(touches.palms - touches.goals, axis=-1)
    there = touches.hands > 0.995
    return 100.0 * float(apart[there].max()) if there.any() else 0.0


def _gaze(motion: SceneMotion, who: str, fps: float) -> float:
    """Farthest the eyes are off what they rest on, degrees; a third of a second is given to get there."""
    touches = motion.touches[who]
    settled = np.zeros(motion.frames, dtype=bool)
    wait = round(0.35 * fps)
    for a, b in _stretches(touches.gaze > 0.98):
        moved = np.linalg.norm(np.diff(touches.looked_at[a:b], axis=0), axis=1) * fps
        jumps = np.flatnonzero(moved > 2.0)
        start = a + wait + (int(jumps[-1]) + 1 if len(jumps) else 0)
        settled[start:b] = True
    if not settled.any():
        return 0.0
    eyes = [motion.world_from_joint[who][:, JOINT[f"eye_{s}"]].astype(np.float64) for s in "lr"]
    at = 0.5 * (eyes[0][:, :3, 3] + eyes[1][:, :3, 3])
    ahead = eyes[0][:, :3, 0]
    to = touches.looked_at - at
    to /= np.maximum(np.linalg.norm(to, axis=1, keepdims=True), 1e-9)
    off = np.degrees(np.arccos(np.clip((ahead * to).sum(axis=1), -1.0, 1.0)))
    return float(off[settled].max())


def _joints(motion: SceneMotion, who: str) -> dict[str, tuple[float, float]]:
    """Lowest and highest angle of each kind, degrees."""
    world = motion.world_from_joint[who].astype(np.float64)

    def local(joint: str, parent: str) -> Array:
        a, b = world[:, JOINT[parent], :3, :3], world[:, JOINT[joint], :3, :3]
        return np.asarray(np.swapaxes(a, -1, -2) @ b)

    def at(joint: str) -> Array:
        return np.asarray(world[:, JOINT[joint], :3, 3])

    found: dict[str, list[Array]] = {name: [] for name in LIMITS}
    for s in "lr":
        for name, (top, middle, end), sign in (
            ("elbow", (f"upperarm_{s}", f"forearm_{s}", f"hand_{s}"), 1.0),
            ("knee", (f"thigh_{s}", f"shin_{s}", f"foot_{s}"), 1.0),
        ):
            found[name].append(sign * _bend(at(middle) - at(top), at(end) - at(middle)))
        chest = world[:, JOINT["chest"], :3, :3]
        down = np.einsum("tji,tj->ti", chest, _unit(at(f"forearm_{s}") - at(f"upperarm_{s}")))
        found["upper arm"].append(np.degrees(np.arccos(np.clip(-down[:, 2], -1, 1))))
        hips = world[:, JOINT["hips"], :3, :3]
        thigh = np.einsum("tji,tj->ti", hips, _unit(at(f"shin_{s}") - at(f"thigh_{s}")))
        found["hip bend"].append(np.degrees(np.arctan2(thigh[:, 0], -thigh[:, 2])))
    head = local("head", "chest")
    found["neck turn"].append(np.degrees(np.arctan2(head[:, 1, 0], head[:, 0, 0])))
    found["neck nod"].append(np.degrees(np.arcsin(np.clip(-head[:, 2, 0], -1, 1))))
    found["neck tilt"].append(np.degrees(np.arctan2(-head[:, 2, 1], head[:, 2, 2])))
    spine = local("chest", "hips")
    found["spine lean"].append(np.degrees(np.arctan2(spine[:, 0, 2], spine[:, 2, 2])))
    found["spine side"].append(np.degrees(np.arcsin(np.clip(spine[:, 1, 2], -1, 1))))
    found["spine twist"].append(np.degrees(np.arctan2(spine[:, 1, 0], spine[:, 0, 0])))
    return {k: (float(np.min(v)), float(np.max(v))) for k, v in found.items()}


def _unit(v: Array) -> Array:
    return np.asarray(v / np.maximum(np.linalg.norm(v, axis=-1, keepdims=True), 1e-9))


def _bend(a: Array, b: Array) -> Array:
    return np.asarray(np.degrees(np.arccos(np.clip((_unit(a) * _unit(b)).sum(axis=-1), -1, 1))))


def _sat_on(motion: SceneMotion, who: str, world: World) -> set[int]:
    """Ids of what somebody sits or lies on in the end: they have to be inside it to get there."""
    seat = motion.end_actors[who].seat
    if seat is None:
        return set()
    return {
        o.id
        for o in world.objects
        for s in o.spots
        if s.name.startswith(("seat", "lie")) and np.linalg.norm(np.subtract(s.position, seat)) < 0.35
    }


def _clearance(motion: SceneMotion, who: str, world: World) -> float:
    """How far a body that goes somewhere keeps from solid things above knee height, metres."""
    solids = world.solids
    if len(solids.centre) == 0:
        return 10.0
    xy = motion.position[who][:, :2]
    stepping = ~motion.touches[who].planted.all(axis=0)
    going = stepping & (np.linalg.norm(np.gradient(xy, axis=0), axis=1) > 0.02)
    if not going.any():
        return 10.0
    feet = motion.position[who][:, 2]
    worst = 10.0
    own = _sat_on(motion, who, world)
    for centre, half, yaw, owner in zip(solids.centre, solids.half, solids.yaw, solids.object, strict=True):
        if int(owner) in own:
            continue
        low, high = centre[2] - half[2], centre[2] + half[2]
        level = (high > feet + 0.3) & (low < feet + 1.5) & going
        if not level.any():
            continue
        d = xy[level] - centre[:2]
        c, s = np.cos(yaw), np.sin(yaw)
        inside = np.abs(np.stack([d[:, 0] * c + d[:, 1] * s, -d[:, 0] * s + d[:, 1] * c], axis=1)) - half[:2]
        out = np.linalg.norm(np.maximum(inside, 0.0), axis=1) + np.minimum(inside.max(axis=1), 0.0)
        worst = min(worst, float(out.min()) - BODY)
    return worst
