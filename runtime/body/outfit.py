"""Clothes: shapes of their own a few millimetres off the body, cut exactly, with the thickness of a hem."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from .anatomy import ARM_FRAME, TORSO_FRAME, Figure, arm_loft, leg_loft, limb, trunk
from .field import Field, Knot, Points, Values, ellipsoid, loft, smooth_min, union
from .pieces import Piece, hemmed, parted, parted_all, shade
from .spec import Colour
from .surface import Patch, clip, half, polygonise, simplify


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


def along_arm(f: Figure, end: float) -> Field:
    """Cut across the left arm: negative above ``end`` metres from the shoulder, and near the trunk."""
    origin = f.joint("upperarm_l")

    def field(p: Points) -> Values:
        d = p - origin
        local = d @ ARM_FRAME.T
        on_arm = np.hypot(local[:, 1], local[:, 2]) < (0.046 * limb(f) + 0.016) * f.p.height
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
    y = f.p.shoulder[1] * 0.0 + (0.42 * h if arm else 0.26 * h)
    return (-0.24 * h, -0.03, low_z), (0.26 * h, y, high_z)


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


def surface_of(f: Figure, solid: Field, low_z: float, high_z: float, arm: bool, faces: int) -> Patch:
    """The left half of a garment's surface between two heights, ``arm`` telling whether it has a sleeve."""
    low, high = _box(f, low_z, high_z, arm)
    return half(simplify(polygonise(solid, low, high, 0.0075 * f.p.height / 1.7), faces, solid))


def top(f: Figure) -> list[Piece]:
    """What the spec's ``top`` is, left half."""
    makers = {
        "tshirt": _tshirt,
        "shirt": _shirt,
        "sweater": _sweater,
        "blazer": _blazer,
        "coat": _coat,
        "dress": _dress,
    }
    return makers.get(f.spec.top, _shirt)(f)


def _tshirt(f: Figure) -> list[Piece]:
    h, a = f.p.height, f.p.upper_arm
    end = (0.64 if f.fem < 0.5 else 0.50) * a
    solid = top_solid(f, 0.0090 * h, 0.10 + 0.06 * (1 - f.fem), sleeve(f, 0.0085 * h, end, 0.010 * h))
    hem = f.level(-0.02 - 0.06 * (1.0 - f.fem))
    patch = surface_of(f, solid, hem - 0.04 * h, f.level(1.35), True, 900)
    patch = clip(
        patch,
        both(
            both(above(hem), along_arm(f, end)), neckline(f, h * f.mix(0.030, 0.050), h * f.mix(0.004, 0.012))
        ),
    )
    return [hemmed(Piece(patch, f.spec.top_color, "top", solid, material="cloth"), 0.010 * h)]


def _long_sleeved(
    f: Figure, grow: float, ease: float, hem: float, collar: Field, wrist: float, faces: int = 900
) -> Piece:
    h = f.p.height
    end = (f.p.upper_arm + f.p.forearm) * wrist
    solid = top_solid(f, grow, ease, sleeve(f, grow * 0.85, end))
    patch = surface_of(f, solid, hem - 0.04 * h, f.level(1.35), True, faces)
    patch = clip(patch, both(both(above(hem), along_arm(f, end)), collar))
    return Piece(patch, f.spec.top_color, "top", solid, material="cloth")


def _bands(
    f: Figure, piece: Piece, hem: float, wrist: float, width: float, factor: float, part: str
) -> list[Piece]:
    """Cuffs and hem as bands of a shade of their own."""
    h, end = f.p.height, (f.p.upper_arm + f.p.forearm) * wrist
    colour = shade(piece.colour, factor)
    cuff = along_arm(f, end - width * h)
    pieces = parted(piece, lambda p: -cuff(p), colour, part)
    if hem > 0:
        low = parted(pieces[0], lambda p: p[:, 2] - hem - width * h, colour, part)
        pieces = [low[0], *pieces[1:], low[1]]
    return pieces


def _shirt(f: Figure) -> list[Piece]:
    h = f.p.height
    hem = f.level(-0.05)
    piece = _long_sleeved(f, 0.0078 * h, 0.14, hem, neckline(f, 0.040 * h, -0.004 * h, 0.012 * h), 0.97)
    pieces = _bands(f, piece, 0.0, 0.97, 0.030, 0.90, "trim")
    placket = parted(
        pieces[0],
        lambda p: np.maximum(p[:, 1] - 0.0085 * h, 0.02 - p[:, 0]),
        shade(piece.colour, 0.93),
        "trim",
    )
    return [hemmed(q, 0.009 * h) for q in [*placket, *pieces[1:]]] + _collar(f, piece.colour)


def _collar(f: Figure, colour: Colour, drop: float = 1.0) -> list[Piece]:
    """A turned-down shirt collar: a sloping band around the neck with points in front.

    drop: how far it comes down, less under a jacket
    """
    h = f.p.height
    z, x = f.level(1.165), f.joint("neck")[0] + 0.002 * h
    r = h * f.mix(0.040, 0.0335) * (1.0 + 0.35 * f.heavy)
    solid = loft(
        (x, 0.0, z),
        TORSO_FRAME,
        [
            Knot(-0.085 * h, 3.00 * r, 2.10 * r, 2.50 * r),
            Knot(-0.050 * h, 2.30 * r, 1.75 * r, 2.25 * r),
            Knot(-0.020 * h, 1.60 * r, 1.34 * r, 1.56 * r),
            Knot(0.006 * h, 1.16 * r, 1.14 * r, 1.14 * r, v=-0.002 * h),
            Knot(0.034 * h, 0.96 * r, 1.02 * r, 0.98 * r, v=-0.004 * h),
        ],
    )

    def cut(p: Points) -> Values:
        dx, y, dz = p[:, 0] - x, np.abs(p[:, 1]), p[:, 2] - z
        up = dz - (0.022 * h - 0.42 * dx)
        front = np.clip(dx / (0.04 * h), 0.0, 1.5)
        tip = 0.024 * h * drop * front * np.exp(-(((y - 0.027 * h) / (0.015 * h)) ** 2))
        low = 0.035 * h if drop >= 1.0 else 0.020 * h
        down = -low - 0.30 * np.clip(dx, 0.0, 1.0) * drop - tip - dz
        open_ = np.where(dx > 0, 0.004 * h + np.maximum(0.010 * h - 0.35 * dx - dz, 0.0) * 0.75 - y, -1.0)
        wide = y - (0.16 if drop >= 1.0 else 0.047) * h
        return np.maximum(np.maximum(np.maximum(up, down), open_), wide)

    patch = polygonise(
        solid, (x - 0.1 * h, -0.03, z - 0.10 * h), (x + 0.12 * h, 0.1 * h, z + 0.05 * h), 0.0045
    )
    patch = clip(half(simplify(patch, 420, solid)), cut)
    return [hemmed(Piece(patch, shade(colour, 1.10), "trim", solid, material="cloth"), 0.010 * h)]


def _sweater(f: Figure) -> list[Piece]:
    h = f.p.height
    hem = f.level(-0.06)
    piece = _long_sleeved(f, 0.0120 * h, 0.16, hem, neckline(f, 0.024 * h, 0.001 * h, 0.008 * h), 0.97)
    pieces = _bands(f, piece, hem, 0.97, 0.028, 0.84, "trim")
    line = neckline(f, 0.036 * h, 0.013 * h, -0.004 * h)
    ring = parted(pieces[0], lambda p: -line(p), shade(piece.colour, 0.84), "trim")
    return [hemmed(q, 0.013 * h) for q in [*ring, *pieces[1:]]]


def _blazer(f: Figure, hem_level: float = -0.22, skirt: float = 0.0) -> list[Piece]:
    h = f.p.height
    hem = f.level(hem_level) if skirt <= 0 else f.p.knee + 0.02 * h
    grow, ease = 0.0150 * h, 0.16
    end = (f.p.upper_arm + f.p.forearm) * 0.96
    solid = top_solid(f, grow, ease, sleeve(f, 0.0098 * h, end))
    nape = f.joint("neck") + np.array([-0.013 * h, 0.0, f.level(1.06) - f.joint("neck")[2]])
    roll = ellipsoid(nape, (0.038 * h, 0.035 * h, 0.034 * h))
    cloth_solid = solid
    solid = lambda p: smooth_min(cloth_solid(p), roll(p), 0.02 * h)  # noqa: E731
    if skirt > 0:
        body, tail = solid, skirt_tail(f, hem)
        solid = lambda p: smooth_min(body(p), tail(p), 0.05 * h)  # noqa: E731
    patch = surface_of(f, solid, hem - 0.04 * h, f.level(1.35), True, 850)
    patch = clip(
        patch, both(both(above(hem, 0.05), along_arm(f, end)), neckline(f, 0.030 * h, -0.003 * h, 0.012 * h))
    )
    button = f.level(0.36)
    opening, lapel = _front(f, button, 0.0), _front(f, button, 0.042 * h)
    cloth = Piece(clip(patch, opening, keep_outside=True), f.spec.top_color, "top", solid, material="cloth")
    pieces = parted(
        cloth,
        lambda p: np.maximum(lapel(p), button + 0.012 * h - p[:, 2]),
        shade(f.spec.top_color, 1.12),
        "trim",
    )
    shown = [hemmed(_shirt_front(f), 0.009 * h)]
    collar = [replace(q, part="shirt") for q in _collar(f, f.spec.shirt_color, 0.35)]
    return [hemmed(q, 0.011 * h) for q in pieces] + shown + collar


def _shirt_front(f: Figure) -> Piece:
    """What an open jacket shows of the shirt under it."""
    h = f.p.height
    low, high = f.level(-0.05), f.level(1.35)
    solid = trunk(f, 0.0066 * h, 0.10)
    patch = polygonise(solid, (-0.1 * h, -0.03, low), (0.2 * h, 0.10 * h, high), 0.0075 * h / 1.7)
    patch = half(simplify(patch, 260, solid))
    cut, shown = neckline(f, 0.040 * h, -0.004 * h, 0.012 * h), _front(f, f.level(0.36), 0.016 * h)
    patch = clip(patch, both(cut, shown))
    return Piece(patch, f.spec.shirt_color, "shirt", solid, material="cloth")


def _front(f: Figure, button: float, margin: float) -> Field:
    """The open front of a jacket: a wedge from the button up to the collar and a slit below it."""
    h = f.p.height

    def field(p: Points) -> Values:
        up = np.clip((p[:, 2] - button) / (f.level(1.13) - button), 0.0, 1.3)
        down = np.clip((button - p[:, 2]) / (0.25 * h), 0.0, 1.0)
        width = 0.036 * h * up**0.85 + 0.018 * h * down**1.5 + 0.0015 * h
        return np.maximum(
            p[:, 1] - width - margin * np.minimum(up * 2.2, 1.0), f.joint("neck")[0] + 0.004 * h - p[:, 0]
        )

    return field


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


def _coat(f: Figure) -> list[Piece]:
    return _blazer(f, skirt=1.0)


def _dress(f: Figure) -> list[Piece]:
    h = f.p.height
    hem = f.p.knee + 0.012 * h
    end = 0.55 * f.p.upper_arm
    body, tail = top_solid(f, 0.0060 * h, 0.0, sleeve(f, 0.007 * h, end, 0.007 * h)), skirt_tail(f, hem, 0.30)
    solid = lambda p: smooth_min(body(p), tail(p), 0.02 * h)  # noqa: E731
    patch = surface_of(f, solid, hem - 0.04 * h, f.level(1.35), True, 1200)
    patch = clip(patch, both(both(above(hem), along_arm(f, end)), neckline(f, 0.052 * h, 0.014 * h)))
    piece = Piece(patch, f.spec.top_color, "top", solid, rule="skirt", material="cloth")
    waist = f.level(0.38)
    band: list[Field] = [lambda p: p[:, 2] - waist - 0.011 * h, lambda p: waist - 0.011 * h - p[:, 2]]
    belt = parted_all(piece, band, shade(f.spec.top_color, 0.72), "belt")
    return [hemmed(q, 0.010 * h) for q in belt]
