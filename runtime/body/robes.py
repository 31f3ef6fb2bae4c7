"""Long clothes of one piece: dresses, gowns, robes, kimonos."""

from __future__ import annotations

import numpy as np

from .anatomy import Figure
from .collars import stand_up
from .field import Field
from .outfit import along_arm, garment, neckline, skirt_tail, sleeve_length
from .pieces import Piece, hemmed, parted, parted_all, shade


def _belted(
    f: Figure, piece: Piece, colour: tuple[float, float, float], half_height: float, at: float
) -> list[Piece]:
    """The piece with a belt of another colour around the waist."""
    waist, tall = f.level(at), half_height * f.p.height
    band: list[Field] = [lambda p: p[:, 2] - waist - tall, lambda p: waist - tall - p[:, 2]]
    return parted_all(piece, band, colour, "belt")


def dress(f: Figure) -> list[Piece]:
    """To the knees, with short sleeves."""
    h = f.p.height
    hem = f.p.knee + 0.012 * h
    end = 0.55 * f.p.upper_arm
    piece = garment(
        f, 0.0082 * h, 0.0, hem, end, neckline(f, 0.052 * h, 0.014 * h), flare=0.007 * h,
        tail=skirt_tail(f, hem, 0.30), rule="skirt", faces=1150,
    )  # fmt: skip
    return [hemmed(q, 0.010 * h) for q in _belted(f, piece, shade(f.spec.top_color, 0.72), 0.011, 0.38)]


def gown(f: Figure) -> list[Piece]:
    """To the floor, wide, with bare shoulders' edge and a sash."""
    h = f.p.height
    hem = 0.022 * h
    end = 0.42 * f.p.upper_arm
    piece = garment(
        f, 0.0078 * h, 0.0, hem, end, neckline(f, 0.062 * h, 0.022 * h), flare=0.010 * h,
        tail=skirt_tail(f, hem, 0.62), rule="skirt", faces=1250,
    )  # fmt: skip
    looks = _belted(f, piece, f.spec.accent_color, 0.014, 0.38)
    trim = parted(looks[1], lambda p: p[:, 2] - hem - 0.026 * h, f.spec.accent_color, "trim")
    return [hemmed(q, 0.010 * h) for q in [looks[0], *trim, *looks[2:]]]


def robe(f: Figure) -> list[Piece]:
    """To the ankles with wide sleeves; a stole in the accent colour runs down the front."""
    h = f.p.height
    hem = 0.052 * h
    line = neckline(f, 0.030 * h, -0.001 * h, 0.010 * h)
    piece = garment(
        f, 0.0130 * h, 0.10, hem, sleeve_length(f, 0.94), line, flare=0.030 * h,
        tail=skirt_tail(f, hem, 0.34), rule="skirt", faces=1300,
    )  # fmt: skip

    stole: list[Field] = [
        lambda p: p[:, 1] - 0.041 * h,
        lambda p: 0.012 * h - p[:, 1],
        lambda p: f.joint("neck")[0] - p[:, 0],
    ]
    *rest, band = parted_all(piece, stole, f.spec.accent_color, "trim")
    cuff = along_arm(f, sleeve_length(f, 0.86), 0.09)
    sleeve = parted(rest[0], lambda p: -cuff(p), shade(f.spec.top_color, 0.84), "over")
    pieces = [hemmed(sleeve[0], 0.011 * h), *rest[1:], band, hemmed(sleeve[1], 0.011 * h)]
    return [*pieces, *stand_up(f, f.spec.shirt_color, 0.022, part="shirt", until=0.7)]


def kimono(f: Figure) -> list[Piece]:
    """Crossed in front, with hanging sleeves and a broad sash."""
    h = f.p.height
    hem = 0.055 * h
    line = neckline(f, 0.070 * h, 0.004 * h, 0.004 * h, 1.0)
    piece = garment(
        f, 0.0120 * h, 0.04, hem, sleeve_length(f, 0.86), line, flare=0.034 * h,
        tail=skirt_tail(f, hem, -0.02), rule="skirt", faces=1250,
    )  # fmt: skip
    looks = _belted(f, piece, f.spec.accent_color, 0.034, 0.42)
    edge = neckline(f, 0.088 * h, 0.020 * h, -0.004 * h, 1.0)
    high = parted(looks[0], lambda p: -edge(p), shade(f.spec.shirt_color, 1.0), "trim")
    low = parted(
        looks[1], lambda p: np.maximum(p[:, 1] - 0.010 * h, -p[:, 0]), shade(f.spec.top_color, 0.8), "trim"
    )
    return [hemmed(q, 0.011 * h) for q in [*high, *low, *looks[2:]]]
