"""Tops drawn over the head or buttoned up: T-shirts, shirts, sweaters, hoodies, scrubs, tunics."""

from __future__ import annotations

import numpy as np

from .anatomy import Figure, arm_loft, trunk
from .collars import collar
from .field import Field, Points, Values, ellipsoid, round_cone, smooth_min, union
from .outfit import (
    above,
    along_arm,
    both,
    garment,
    neckline,
    skirt_tail,
    sleeve,
    sleeve_length,
    surface_of,
    top_solid,
)
from .pieces import Piece, hemmed, parted, shade
from .sheets import on_chest, plate
from .spec import Colour
from .surface import clip, half, polygonise, simplify


def tshirt(f: Figure) -> list[Piece]:
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


def bands(
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


def shirt(f: Figure) -> list[Piece]:
    h = f.p.height
    hem = f.level(-0.05)
    piece = garment(
        f, 0.0078 * h, 0.14, hem, sleeve_length(f, 0.97), neckline(f, 0.040 * h, -0.004 * h, 0.012 * h)
    )
    pieces = bands(f, piece, 0.0, 0.97, 0.030, 0.90, "trim")
    placket = parted(
        pieces[0],
        lambda p: np.maximum(p[:, 1] - 0.0085 * h, 0.02 - p[:, 0]),
        shade(piece.colour, 0.93),
        "trim",
    )
    return [hemmed(q, 0.009 * h) for q in [*placket, *pieces[1:]]] + collar(f, piece.solid, piece.colour)


def sweater(f: Figure) -> list[Piece]:
    h = f.p.height
    hem = f.level(-0.06)
    piece = garment(
        f, 0.0120 * h, 0.16, hem, sleeve_length(f, 0.97), neckline(f, 0.024 * h, 0.001 * h, 0.008 * h)
    )
    pieces = bands(f, piece, hem, 0.97, 0.028, 0.84, "trim")
    line = neckline(f, 0.036 * h, 0.013 * h, -0.004 * h)
    ring = parted(pieces[0], lambda p: -line(p), shade(piece.colour, 0.84), "trim")
    return [hemmed(q, 0.013 * h) for q in [*ring, *pieces[1:]]]


def tank(f: Figure) -> list[Piece]:
    """No sleeves, wide at the neck."""
    h = f.p.height
    hem = f.level(-0.02 - 0.06 * (1.0 - f.fem))
    line = neckline(f, 0.060 * h, 0.020 * h)
    piece = garment(f, 0.0070 * h, 0.06, hem, 0.10 * f.p.upper_arm, line)
    shoulder = f.joint("upperarm_l")

    def armhole(p: Points) -> Values:
        """Negative outside: beyond a line from the armpit up over the shoulder."""
        inner = 0.80 * shoulder[1] + 0.30 * np.clip(f.level(0.80) - p[:, 2], -0.02 * h, 0.2 * h)
        return p[:, 1] - inner

    patch = clip(piece.patch, lambda p: np.where(p[:, 2] > f.level(0.62), armhole(p), -0.05))
    return [
        hemmed(Piece(patch, piece.colour, "top", piece.solid, material="cloth"), 0.009 * h),
        _shoulders(f),
    ]


def _shoulders(f: Figure) -> Piece:
    """The skin from the chest up over the left shoulder, which other tops cover."""
    h = f.p.height
    body, limb_ = trunk(f), arm_loft(f)
    solid: Field = lambda p: smooth_min(body(p), limb_(p), 0.026 * h)  # noqa: E731
    end = 0.30 * f.p.upper_arm
    patch = surface_of(f, solid, f.level(0.50), f.level(1.35), True, 460)
    patch = clip(
        patch, both(both(above(f.level(0.56)), along_arm(f, end)), lambda p: p[:, 2] - f.level(1.08))
    )
    return Piece(patch, f.spec.skin, "skin", solid)


def hoodie(f: Figure) -> list[Piece]:
    """A sweater with a hood lying on the back and a pocket in front."""
    h = f.p.height
    pieces = sweater(f)
    solid = pieces[0].solid
    assert solid is not None
    nape = np.array([f.joint("neck")[0], 0.0, f.level(1.09)])
    roll = union(
        [
            (
                round_cone(
                    nape + np.array([-0.050 * h, 0.0, 0.0]),
                    nape + np.array([-0.028 * h, 0.042 * h, 0.008 * h]),
                    0.032 * h,
                    0.026 * h,
                ),
                0.0,
            ),
            (
                round_cone(
                    nape + np.array([-0.028 * h, 0.042 * h, 0.008 * h]),
                    nape + np.array([0.026 * h, 0.046 * h, -0.020 * h]),
                    0.024 * h,
                    0.010 * h,
                ),
                0.02 * h,
            ),
            (
                ellipsoid(nape + np.array([-0.062 * h, 0.0, -0.030 * h]), (0.026 * h, 0.050 * h, 0.045 * h)),
                0.03 * h,
            ),
        ]
    )
    pieces.append(blob(roll, nape, 0.11 * h, shade(f.spec.top_color, 0.9), 300))
    width = np.linspace(0.0, 1.0, 5) * 0.066 * h
    up = np.linspace(f.level(0.06), f.level(0.27), 4)
    across = width[None] * np.linspace(1.0, 0.66, 4)[:, None]
    pieces.append(patch_on(solid, across, up, 0.006 * h, shade(f.spec.top_color, 0.86)))
    return pieces


def scrubs(f: Figure) -> list[Piece]:
    """Short wide sleeves, a V-neck, a breast pocket."""
    h = f.p.height
    hem = f.level(-0.10)
    line = neckline(f, 0.062 * h, 0.004 * h, 0.004 * h, 1.0)
    piece = garment(f, 0.0100 * h, 0.20, hem, 0.74 * f.p.upper_arm, line, flare=0.012 * h)
    edge = neckline(f, 0.074 * h, 0.014 * h, -0.002 * h, 1.0)
    pieces = [
        hemmed(q, 0.010 * h) for q in parted(piece, lambda p: -edge(p), shade(piece.colour, 0.84), "trim")
    ]
    assert piece.solid is not None
    across = 0.050 * h + np.array([-0.020, 0.0, 0.020]) * h
    up = np.linspace(f.level(0.60), f.level(0.72), 3)
    pocket = patch_on(piece.solid, across, up, 0.005 * h, shade(piece.colour, 0.88))
    return [*pieces, Piece(pocket.patch, pocket.colour, "pocket", None, symmetry="whole", material="cloth")]


def tunic(f: Figure) -> list[Piece]:
    """To the middle of the thighs, full, its edges in the accent colour."""
    h = f.p.height
    hem = f.level(-0.42)
    line = neckline(f, 0.050 * h, 0.002 * h, 0.006 * h, 1.2)
    tail = skirt_tail(f, hem - 0.10 * h, 0.10)
    piece = garment(
        f, 0.0095 * h, 0.10, hem, sleeve_length(f, 0.93), line, tail=tail, rule="skirt", faces=1000,
        flare=0.004 * h,
    )  # fmt: skip
    colour = f.spec.accent_color
    pieces = parted(piece, lambda p: p[:, 2] - hem - 0.022 * h, colour, "trim")
    edge = neckline(f, 0.066 * h, 0.013 * h, -0.004 * h, 1.2)
    pieces = [*parted(pieces[0], lambda p: -edge(p), colour, "trim"), pieces[1]]
    cuff = along_arm(f, sleeve_length(f, 0.86), 0.06)
    pieces = [*parted(pieces[0], lambda p: -cuff(p), colour, "trim"), *pieces[1:]]
    return [hemmed(q, 0.010 * h) for q in pieces]


def blob(shape: Field, middle: Points, size: float, colour: Colour, faces: int) -> Piece:
    """A soft thing that goes with the clothes: the left half of a solid around a point."""
    low = np.array([middle[0] - size, -0.03, middle[2] - size])
    patch = half(simplify(polygonise(shape, low, middle + size, 0.006), faces, shape))
    return Piece(patch, colour, "trim", shape, material="cloth")


def patch_on(solid: Field, across: Points, up: Points, lift: float, colour: Colour) -> Piece:
    """A pocket on the chest of a garment: the left half."""
    outer, under = on_chest(solid, across, up, lift), on_chest(solid, across, up, -0.002)
    return Piece(plate(outer, under, (-0.3, 0.0, float(up.mean()))), colour, "pocket", None, material="cloth")
