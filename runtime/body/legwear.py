"""Clothes below the waist: trousers, skirts, overalls, shoes and boots, and the legs where they show."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from .anatomy import LEG_FRAME, Figure, leg_loft, shoe, trunk
from .armour import rings
from .field import Field, Knot, Points, Values, loft, smooth_min, union
from .outfit import above, both, knee, skirt_tail, surface_of
from .pieces import Piece, hemmed, parted, parted_all, shade
from .sheets import ellipsoid_patch, on_chest, plate, strand
from .spec import Colour
from .surface import clip, polygonise, simplify

#: Tops that need nothing below the waist; those of them that reach the floor.
ONE_PIECE = ("dress", "gown", "robe", "kimono")
FLOOR_LONG = ("gown", "robe", "kimono")
_BRASS: Colour = (0.80, 0.66, 0.32)


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
    """What the spec's ``bottom`` is, left half; clothes of one piece need none."""
    if f.spec.top in ONE_PIECE:
        return []
    if f.spec.top == "armour":
        return _greaves(f, _trousers(f))
    if f.spec.bottom in ("skirt", "long-skirt", "pencil-skirt"):
        return _skirt(f)
    pieces = _trousers(f)
    return [*pieces, *_bib(f)] if f.spec.bottom == "overalls" else pieces


def _trousers(f: Figure) -> list[Piece]:
    h = f.p.height
    suit = f.spec.top == "spacesuit"
    grow = (0.0190 if suit else 0.0042) * h
    over = f.spec.bottom == "overalls" and not suit  # worn over the shirt
    body = trunk(f, 0.0175 * h, 0.20, chest=False) if over else trunk(f, grow, 0.0, chest=False)
    leg = trouser_leg(f, 0.008 * h if over else grow)
    low_ring, high_ring = 0.55 * f.p.knee, 0.5 * (f.p.knee + f.p.hip[1])

    def solid(p: Points) -> Values:
        folds = rings(p[:, 2], (low_ring, f.p.knee, high_ring), 0.006 * h, 0.014 * h) if suit else 0.0
        return np.asarray(smooth_min(body(p), leg(p), 0.03 * h) - folds)

    shorts = f.spec.bottom == "shorts" and not suit
    shape: Field = solid
    if shorts:
        wide = loft(
            f.joint("thigh_l"),
            LEG_FRAME,
            [
                Knot(0.08 * h, 0.040 * h, 0.040 * h, 0.038 * h),
                Knot(0.26 * h, 0.052 * h, 0.052 * h, 0.047 * h),
            ],
        )
        shape = lambda p: smooth_min(solid(p), wide(p), 0.02 * h)  # noqa: E731
    low = f.p.knee + 0.035 * h if shorts else 0.56 * f.p.ankle
    if f.spec.shoes == "boots" and not shorts:
        low = boot_top(f) - 0.025 * h
    waist = f.level(0.34 if f.spec.bottom == "overalls" else 0.14)
    patch = surface_of(f, shape, low - 0.04 * h, waist + 0.05 * h, False, 650, legs=True)
    patch = clip(patch, both(above(low, 0.06 if f.spec.shoes != "boots" else 0.0), lambda p: p[:, 2] - waist))
    piece = Piece(
        patch, f.spec.bottom_color, "over" if over else "bottom", shape, rule="legs", material="cloth"
    )
    return [hemmed(piece, 0.010 * h)]


def _bib(f: Figure) -> list[Piece]:
    """The bib of overalls and its straps, over whatever the top is."""
    h, colour = f.p.height, f.spec.bottom_color
    body = trunk(f, 0.0175 * h, 0.20)
    up = np.array([f.level(x) for x in (0.28, 0.44, 0.60, 0.74)])
    wide = np.array([0.092, 0.066, 0.054, 0.050]) * h * (1.0 + 0.4 * max(f.heavy, 0.0))
    outer = on_chest(body, wide[:, None] * np.linspace(0.0, 1.0, 5), up, 0.004 * h)
    bib = plate(outer, outer - np.array([0.012 * h, 0.0, 0.0]), (-0.4, 0.0, f.level(0.5)))
    y = np.array([0.046, 0.052, 0.056]) * h
    ahead = on_chest(body, y[:, None], np.array([f.level(x) for x in (0.73, 0.88, 0.98)]), 0.004 * h)[:, 0]
    behind = on_chest(
        body, np.array([0.056, 0.046, 0.030])[:, None] * h,
        np.array([f.level(x) for x in (0.98, 0.80, 0.36)]),
        0.004 * h, -1.0,
    )[:, 0]  # fmt: skip
    crest = 0.5 * (ahead[-1] + behind[0])
    crest[2] = max(ahead[-1, 2], behind[0, 2]) + 0.022 * h
    strap = strand(np.concatenate([ahead, crest[None], behind]), 0.009 * h, 5)
    buckle = ellipsoid_patch(ahead[0], (0.006 * h, 0.010 * h, 0.010 * h), 6, 4)
    return [
        Piece(bib, colour, "over", None, material="cloth"),
        Piece(strap, shade(colour, 0.85), "belt", None, symmetry="side"),
        Piece(buckle, _BRASS, "badge", None, symmetry="side"),
    ]


def _skirt(f: Figure) -> list[Piece]:
    h = f.p.height
    hem, wide = {
        "skirt": (f.p.knee + 0.02 * h, 0.16),
        "pencil-skirt": (f.p.knee + 0.03 * h, -0.12),
        "long-skirt": (0.06 * h, 0.40),
    }[f.spec.bottom]
    waist = f.level(0.36)
    body, tail = trunk(f, 0.004 * h, 0.0, chest=False), skirt_tail(f, hem, wide)
    solid = lambda p: smooth_min(body(p), tail(p), 0.02 * h)  # noqa: E731
    patch = surface_of(f, solid, hem - 0.04 * h, waist + 0.05 * h, False, 550 if hem > 0.1 * h else 700)
    patch = clip(patch, both(above(hem), lambda p: p[:, 2] - waist))
    return [
        hemmed(Piece(patch, f.spec.bottom_color, "bottom", solid, rule="skirt", material="cloth"), 0.010 * h)
    ]


def _greaves(f: Figure, legs: list[Piece]) -> list[Piece]:
    """Trousers with steel below the knees and on the thighs."""
    h, steel = f.p.height, f.spec.top_color
    knee = f.p.knee
    cloth = legs[0]
    low = parted(cloth, lambda p: p[:, 2] - knee + 0.02 * h, steel, "plate")
    band: list[Field] = [lambda p: p[:, 2] - knee - 0.17 * h, lambda p: knee + 0.03 * h - p[:, 2]]
    thigh = parted_all(low[0], band, steel, "plate")
    cop = ellipsoid_patch(
        f.joint("shin_l") + np.array([0.020 * h, 0.0, 0.004 * h]), (0.030 * h, 0.038 * h, 0.042 * h), 9, 6
    )
    return [
        *thigh,
        low[1],
        Piece(cop, shade(steel, 1.12), "plate", None, rule="half-knee_l", symmetry="side"),
    ]


def boot_top(f: Figure) -> float:
    """Height of the top of boots."""
    return 0.66 * f.p.knee


def _boot(f: Figure, foot: Field) -> Field:
    """A shoe with a shaft around the lower leg."""
    h = f.p.height
    shaft = union([(leg_loft(f, 0.010 * h), 0.0), (trouser_leg(f, 0.006 * h), 0.02 * h)])
    bulk = 0.010 * h if f.spec.top == "spacesuit" else 0.0
    return lambda p: smooth_min(foot(p), np.maximum(shaft(p) - bulk, 0.5 * f.p.ankle - p[:, 2]), 0.03 * h)


def shoes(f: Figure) -> list[Piece]:
    """The left shoe or boot with its sole."""
    h, solid = f.p.height, shoe(f)
    n, y = f.p.foot, f.p.hip[0]
    boots = f.spec.shoes == "boots"
    top_z, part = 0.12 * h, "shoes"
    if boots:
        solid = _boot(f, solid)
        top_z = boot_top(f) + 0.03 * h
    patch = polygonise(
        solid,
        (-0.35 * n, y - 0.3 * n, -0.004),
        (0.85 * n, y + 0.3 * n, top_z),
        0.0055 * (1.25 if boots else 1.0),
    )
    patch = simplify(patch, round(f.detail * (360 if boots else 250)), solid)
    upper = Piece(patch, f.spec.shoes_color, part, solid, rule="legs", symmetry="side")
    sole = 0.22 * f.p.ankle
    dark = shade(f.spec.shoes_color, 0.55) if sum(f.spec.shoes_color) > 0.9 else (0.72, 0.70, 0.66)
    if boots:
        line = boot_top(f)
        upper = hemmed(
            replace(upper, patch=clip(patch, lambda p: p[:, 2] - line - 0.15 * p[:, 0])), 0.012 * h
        )
    elif _legs_show(f):
        line = 0.80 * f.p.ankle
        keep = clip(patch, lambda p: p[:, 2] - line - 0.12 * np.abs(p[:, 0] + 0.02 * n))
        upper = hemmed(replace(upper, patch=keep), 0.008 * h)
    return parted(upper, lambda p: p[:, 2] - sole, dark, "sole")


def _legs_show(f: Figure) -> bool:
    if f.spec.top in ("armour", "spacesuit"):
        return False
    return f.spec.top in ONE_PIECE or f.spec.bottom in ("skirt", "shorts", "long-skirt", "pencil-skirt")


def bare_legs(f: Figure) -> list[Piece]:
    """The left leg's skin where clothes leave it free; hose under what reaches the floor."""
    if not _legs_show(f):
        return []
    h, solid = f.p.height, leg_loft(f)
    long = f.spec.top in FLOOR_LONG or f.spec.bottom == "long-skirt"
    top_z = f.p.knee + (-0.06 if long else 0.065) * h
    low = boot_top(f) - 0.02 * h if f.spec.shoes == "boots" else 0.3 * f.p.ankle
    patch = polygonise(solid, (-0.1 * h, 0.0, low), (0.1 * h, 0.14 * h, top_z), 0.0065)
    colour = f.spec.skin if not long or f.spec.top == "gown" else shade(f.spec.shoes_color, 0.9)
    patch = simplify(patch, 200 if long else 440, solid, (knee(f),))
    return [Piece(patch, colour, "skin", solid, rule="legs", symmetry="side")]
