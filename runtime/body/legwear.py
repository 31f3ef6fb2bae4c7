"""Clothes below the waist: trousers, shorts, skirts and shoes, and the legs where they show."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from .anatomy import LEG_FRAME, Figure, leg_loft, shoe, trunk
from .field import Field, Knot, loft, smooth_min, union
from .outfit import above, both, skirt_tail, surface_of
from .pieces import Piece, hemmed, parted, shade
from .surface import clip, polygonise, simplify


def trouser_leg(f: Figure, grow: float) -> Field:
    """The left leg of trousers: the leg's own shape above, straight from the knee down."""
    h, a, b = f.p.height, f.p.hip[1] - f.p.knee, f.p.knee - f.p.ankle
    k = h * (1.0 + 0.35 * f.heavy)
    c = k * f.mix(1.0, 0.90)
    straight = loft(
        f.joint("thigh_l"),
        LEG_FRAME,
        [
            Knot(0.10 * a, 0.040 * c, 0.040 * c, 0.036 * c),
            Knot(0.80 * a, 0.0375 * c, 0.0385 * c, 0.0355 * c),
            Knot(a + 0.20 * b, 0.0335 * c, 0.0420 * c, 0.0365 * c),
            Knot(a + 0.60 * b, 0.0305 * c, 0.0375 * c, 0.0330 * c),
            Knot(a + 1.10 * b, 0.0315 * c, 0.0355 * c, 0.0325 * c),
        ],
    )
    return union([(leg_loft(f, grow), 0.0), (straight, 0.02 * h)])


def bottom(f: Figure) -> list[Piece]:
    """What the spec's ``bottom`` is, left half; a dress needs none."""
    h = f.p.height
    if f.spec.top == "dress":
        return []
    if f.spec.bottom == "skirt":
        return _skirt(f)
    grow = 0.0042 * h
    body, leg = trunk(f, grow, 0.0, chest=False), trouser_leg(f, grow)
    solid = lambda p: smooth_min(body(p), leg(p), 0.03 * h)  # noqa: E731
    shorts = f.spec.bottom == "shorts"
    if shorts:
        wide = loft(
            f.joint("thigh_l"),
            LEG_FRAME,
            [
                Knot(0.08 * h, 0.040 * h, 0.040 * h, 0.038 * h),
                Knot(0.26 * h, 0.052 * h, 0.052 * h, 0.047 * h),
            ],
        )
        inner = solid
        solid = lambda p: smooth_min(inner(p), wide(p), 0.02 * h)  # noqa: E731
    low = f.p.knee + 0.035 * h if shorts else 0.56 * f.p.ankle
    waist = f.level(0.14)
    patch = surface_of(f, solid, low - 0.04 * h, waist + 0.05 * h, False, 650)
    patch = clip(patch, both(above(low, 0.06), lambda p: p[:, 2] - waist))
    piece = Piece(patch, f.spec.bottom_color, "bottom", solid, rule="legs", material="cloth")
    return [hemmed(piece, 0.010 * h)]


def _skirt(f: Figure) -> list[Piece]:
    h = f.p.height
    hem, waist = f.p.knee + 0.02 * h, f.level(0.36)
    body, tail = trunk(f, 0.004 * h, 0.0, chest=False), skirt_tail(f, hem, 0.16)
    solid = lambda p: smooth_min(body(p), tail(p), 0.02 * h)  # noqa: E731
    patch = surface_of(f, solid, hem - 0.04 * h, waist + 0.05 * h, False, 550)
    patch = clip(patch, both(above(hem), lambda p: p[:, 2] - waist))
    return [
        hemmed(Piece(patch, f.spec.bottom_color, "bottom", solid, rule="skirt", material="cloth"), 0.010 * h)
    ]


def shoes(f: Figure) -> list[Piece]:
    """The left shoe with its sole."""
    h, solid = f.p.height, shoe(f)
    n, y = f.p.foot, f.p.hip[0]
    patch = polygonise(solid, (-0.35 * n, y - 0.3 * n, -0.004), (0.85 * n, y + 0.3 * n, 0.12 * h), 0.0055)
    patch = simplify(patch, 250, solid)
    upper = Piece(patch, f.spec.shoes_color, "shoes", solid, rule="legs", symmetry="side")
    sole = 0.22 * f.p.ankle
    dark = shade(f.spec.shoes_color, 0.55) if sum(f.spec.shoes_color) > 0.9 else (0.72, 0.70, 0.66)
    if _legs_show(f):
        line = 0.80 * f.p.ankle
        keep = clip(patch, lambda p: p[:, 2] - line - 0.12 * np.abs(p[:, 0] + 0.02 * n))
        upper = hemmed(replace(upper, patch=keep), 0.008 * h)
    return parted(upper, lambda p: p[:, 2] - sole, dark, "sole")


def _legs_show(f: Figure) -> bool:
    return f.spec.top == "dress" or f.spec.bottom in ("skirt", "shorts")


def bare_legs(f: Figure) -> list[Piece]:
    """The left leg's skin where clothes leave it free."""
    if not _legs_show(f):
        return []
    h, solid = f.p.height, leg_loft(f)
    top_z = f.p.knee + 0.10 * h
    patch = polygonise(solid, (-0.1 * h, 0.0, 0.3 * f.p.ankle), (0.1 * h, 0.14 * h, top_z), 0.0065)
    return [Piece(simplify(patch, 420, solid), f.spec.skin, "skin", solid, rule="legs", symmetry="side")]
