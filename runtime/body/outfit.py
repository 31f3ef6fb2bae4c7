"""What clothes are made of: sleeves, hems, necklines, skirts; shapes a few millimetres off the body."""

from __future__ import annotations

import numpy as np

from .anatomy import ARM_FRAME, TORSO_FRAME, Figure, arm_loft, arm_point, leg_loft, limb, trunk
from .field import Field, Knot, Points, Values, loft, smooth_min, union
from .pieces import Piece
from .surface import Bend, Patch, clip, half, polygonise, simplify


def sleeve(f: Figure, grow: float, end: float, flare: float = 0.0) -> Field:
    """The left sleeve, ``end`` metres down the arm, its solid running a little beyond the cut."""
    origin, thick = f.joint("upperarm_l"), arm_loft(f, grow)
    if flare <= 0.0:
        return thick
    h = f.p.height
    cone = loft(
        origin,
        ARM_FRAME,
        [
            Knot(0.06 * h, 0.030 * h, 0.030 * h, 0.028 * h),
            Knot(end + 0.03 * h, 0.028 * h + flare, 0.028 * h + flare, 0.026 * h + flare),
        ],
    )
    return union([(thick, 0.0), (cone, 0.02)])


def along_arm(f: Figure, end: float, wide: float = 0.030) -> Field:
    """Cut across the left arm: negative above ``end`` metres from the shoulder, and near the trunk.

    wide: how far off the arm cloth may be, as a share of the height
    """
    origin = f.joint("upperarm_l")

    def field(p: Points) -> Values:
        d = p - origin
        local = d @ ARM_FRAME.T
        on_arm = np.hypot(local[:, 1], local[:, 2]) < (0.046 * limb(f) + wide) * f.p.height
        return np.where(on_arm, local[:, 0] - end, -0.1)

    return field


def above(z: float, slope: float = 0.0) -> Field:
    """Cut keeping what is above ``z``; ``slope`` tilts it up towards the front."""
    return lambda p: z - p[:, 2] + slope * p[:, 0]


def both(a: Field, b: Field) -> Field:
    return lambda p: np.maximum(a(p), b(p))


def neckline(f: Figure, depth: float, air: float = 0.0, lift: float = 0.0, sharp: float = 2.0) -> Field:
    """Cut keeping what is outside a collar line around the neck.

    depth: how far the opening reaches down in front, metres; air: distance from the neck; lift: raises
    the line all round; sharp: 2 for a round front, 1 for a V
    """
    h = f.p.height
    x, z = f.joint("neck")[0], f.level(1.085) + lift
    radius = h * f.mix(0.0395, 0.0325) * (1.0 + 0.35 * f.heavy) + air
    back = (0.010 if lift <= 0.0 else 0.003) * h

    def field(p: Points) -> Values:
        front = np.clip((p[:, 0] - x + 0.012 * h) / (0.040 * h), 0.0, 1.0)
        reach = back + (depth - back) * front * front * (3 - 2 * front)
        open_up = radius + (0.75 if air > 0 else 0.35) * np.clip(p[:, 2] - z, 0.0, 0.03 * h)
        across = np.hypot(p[:, 1], np.clip(x - p[:, 0], 0.0, 1.0) * 0.7) / open_up
        down = np.clip(z + 0.012 * h * (1 - front) - p[:, 2], 0.0, None) / reach
        return (1.0 - (across**sharp + down**sharp) ** (1.0 / sharp)) * radius

    return field


def _box(
    f: Figure, low_z: float, high_z: float, arm: bool
) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
    h = f.p.height
    y = 0.42 * h if arm else 0.26 * h
    return (-0.27 * h, -0.03, low_z), (0.29 * h, y, high_z)


def top_solid(f: Figure, grow: float, ease: float, sleeves: Field) -> Field:
    """Trunk and left sleeve of a garment."""
    h, grow = f.p.height, max(grow, 0.010)
    body, leg = trunk(f, grow, ease), leg_loft(f, grow)
    low, high = f.level(0.90), f.level(1.05)

    def field(p: Points) -> Values:
        hug = np.clip((p[:, 2] - low) / (high - low), 0.0, 1.0) * (
            grow - 0.007
        )  # cloth lies close at the neck
        return smooth_min(smooth_min(body(p), leg(p), 0.03 * h), sleeves(p), 0.026 * h) + hug

    return field


def surface_of(
    f: Figure,
    solid: Field,
    low_z: float,
    high_z: float,
    arm: bool,
    faces: int,
    step: float = 0.0120,
    legs: bool = False,
) -> Patch:
    """The left half of a garment's surface between two heights.

    arm, legs: whether it has a sleeve, and legs
    step: of the grid it is found on, metres for somebody 1.7 m tall; less for what is fluted
    """
    low, high = _box(f, low_z, high_z, arm)
    patch = polygonise(solid, low, high, step * f.p.height / 1.7)
    bent = (elbow(f),) * arm + (knee(f),) * legs
    return half(simplify(patch, round(f.detail * faces), solid, bent))


def elbow(f: Figure) -> Bend:
    """Where the left sleeve bends."""
    (x, y, z), (u, v, w), h = arm_point(f, f.p.upper_arm), ARM_FRAME[0], f.p.height
    return Bend((x, y, z), (u, v, w), 0.054 * h, 0.080 * h, 0.012 * h)


def knee(f: Figure) -> Bend:
    """Where the left leg bends."""
    h = f.p.height
    return Bend((0.0, f.p.hip[0], f.p.knee), (0.0, 0.0, 1.0), 0.058 * h, 0.090 * h, 0.012 * h)


def garment(
    f: Figure,
    grow: float,
    ease: float,
    hem: float,
    end: float,
    neck_line: Field,
    *,
    flare: float = 0.0,
    slope: float = 0.0,
    tail: Field | None = None,
    faces: int = 880,
    rule: str = "body",
) -> Piece:
    """A top without its trimmings.

    grow, ease: thickness and fullness; hem: height of its lower edge; end: length of the sleeves, metres
    flare: how far these open; tail: what hangs below the waist
    """
    solid = top_solid(f, grow, ease, sleeve(f, 0.85 * grow, end, flare))
    if tail is not None:
        body = solid
        solid = lambda p: smooth_min(body(p), tail(p), 0.03 * f.p.height)  # noqa: E731
    step = 0.0120 if tail is None else 0.0150
    patch = surface_of(f, solid, hem - 0.04 * f.p.height, f.level(1.35), True, faces, step)
    patch = clip(
        patch, both(both(above(hem, slope), along_arm(f, end, 0.03 + flare / f.p.height)), neck_line)
    )
    return Piece(patch, f.spec.top_color, "top", solid, rule=rule, material="cloth")


def neck_radius(f: Figure) -> float:
    """About the neck's, metres: what collars go around."""
    return f.p.height * f.mix(0.040, 0.0335) * (1.0 + 0.35 * f.heavy)


def sleeve_length(f: Figure, share: float) -> float:
    """Metres down the arm; 1 is the wrist."""
    return (f.p.upper_arm + f.p.forearm) * share


def skirt_tail(f: Figure, hem: float, wide: float = 0.0) -> Field:
    """The skirt of a coat or dress from the waist down past ``hem``."""
    h = f.p.height
    k = 1.0 + 0.5 * f.heavy
    waist, hip = f.level(0.38), f.level(-0.04)
    side = h * f.mix(0.098, 0.108) * k
    drop = hem - 0.05 * h
    return loft(
        (0.0, 0.0, 0.0),
        TORSO_FRAME,
        [
            Knot(drop, side * (0.98 + wide), side * (0.92 + wide), side * (1.18 + wide)),
            Knot(
                (hip + drop) / 2,
                0.80 * side * (1 + 0.6 * wide),
                0.85 * side * (1 + 0.6 * wide),
                side * (1.12 + 0.5 * wide),
            ),
            Knot(hip, 0.66 * side, 0.82 * side, 1.06 * side),
            Knot(f.level(0.16), 0.60 * side, 0.62 * side, 0.95 * side),
            Knot(waist, 0.50 * side * f.mix(1.05, 0.9), 0.48 * side, 0.80 * side * f.mix(1.05, 0.86)),
        ],
        power=2.15,
    )
