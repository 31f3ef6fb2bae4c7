"""What is worn on top of the clothes: neckwear, aprons and vests, belts, badges, packs and capes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from .anatomy import ARM_FRAME, Figure, leg_loft, trunk
from .field import Field, Points, Values, gradient, union
from .outfit import neck_radius, skirt_tail
from .pieces import Piece, hemmed, shade
from .sheets import Grid, cast, ellipsoid_patch, merged, on_chest, plate, strand
from .spec import Colour
from .surface import Patch, clip, compact

_BRASS: Colour = (0.80, 0.66, 0.32)
_DARK: Colour = (0.14, 0.14, 0.16)


def extras(f: Figure, upper: list[Piece]) -> list[Piece]:
    """Everything of the kind the spec asks for, laid on the top's pieces."""
    solid = upper[0].solid
    assert solid is not None
    spec, pieces = f.spec, []
    over = {"apron": _apron, "vest": _vest, "waistcoat": _waistcoat}.get(spec.over)
    if over is not None:
        pieces += over(f, solid, upper)
    neck = {"tie": _tie, "bow-tie": _bow_tie, "scarf": _scarf, "stethoscope": _stethoscope}.get(spec.neck)
    if neck is not None:
        pieces += neck(f, solid)
    back = {"backpack": _backpack, "cape": _cape}.get(spec.back)
    if back is not None:
        pieces += back(f, solid)
    if spec.belt:
        pieces += _belt(f, solid)
    if spec.badge:
        pieces += _badge(f, solid)
    return pieces


def _on_shirt(f: Figure, solid: Field) -> Field:
    """What neckwear lies on: the shirt in an open jacket."""
    jacket = f.spec.top in ("blazer", "suit", "coat", "jacket", "lab-coat")
    return trunk(f, 0.0066 * f.p.height, 0.10) if jacket else solid


def _tie(f: Figure, solid: Field) -> list[Piece]:
    h = f.p.height
    share = np.array([0.0, 0.10, 0.35, 0.65, 0.90, 1.0])
    wide = np.array([0.010, 0.011, 0.014, 0.018, 0.020, 0.002]) * h
    up = f.level(1.045) + (f.level(0.26) - f.level(1.045)) * share
    across = wide[:, None] * np.array([0.0, 0.55, 1.0])
    base = _on_shirt(f, solid)
    outer = on_chest(base, across, up, 0.006 * h)
    blade = plate(outer, outer - np.array([0.007 * h, 0.0, 0.0]), (-0.4, 0.0, f.level(0.6)))
    knot = ellipsoid_patch(outer[0, 0] + (0.002 * h, 0.0, 0.004 * h), (0.009 * h, 0.014 * h, 0.014 * h), 8, 5)
    return [
        Piece(blade, f.spec.accent_color, "neck", None, material="cloth"),
        Piece(knot, shade(f.spec.accent_color, 0.85), "neck", None, symmetry="whole"),
    ]


def _bow_tie(f: Figure, solid: Field) -> list[Piece]:
    h = f.p.height
    at = on_chest(_on_shirt(f, solid), np.array([0.0]), np.array([f.level(1.055)]), 0.006 * h)[0, 0]
    wing = np.array([[0.004, 0.0], [0.008, 0.010], [0.014, 0.028], [0.015, 0.042]]) * h
    line = at + np.stack([0.003 * h - 0.25 * wing[:, 1], wing[:, 1], 0.0 * wing[:, 0]], 1)
    bow = strand(line, wing[:, 0].tolist(), 6)
    knot = ellipsoid_patch(at + np.array([0.004 * h, 0.0, 0.0]), (0.008 * h, 0.009 * h, 0.009 * h), 8, 5)
    return [
        Piece(bow, f.spec.accent_color, "neck", None, symmetry="side", material="cloth"),
        Piece(knot, shade(f.spec.accent_color, 0.8), "neck", None, symmetry="whole"),
    ]


def _around_neck(f: Figure, wide: float, dip: float, count: int) -> Grid:
    """Points around the neck from front to back on the left, lower in front by ``dip``."""
    h, r = f.p.height, neck_radius(f) * wide
    turn = np.linspace(0.0, np.pi, count)
    y = r * np.sin(turn)
    y[[0, -1]] = 0.0
    up = f.level(1.15) + 0.010 * h - dip * h * (0.5 + 0.5 * np.cos(turn))
    return np.stack([f.joint("neck")[0] + 1.05 * r * np.cos(turn), y, up], 1)


def _scarf(f: Figure, solid: Field) -> list[Piece]:
    h, colour = f.p.height, f.spec.accent_color
    roll = strand(_around_neck(f, 1.42, 0.040, 11), 0.021 * h, 7)
    up = np.linspace(f.level(1.0), f.level(0.66), 4)
    across = 0.030 * h + np.array([-0.016, 0.0, 0.016]) * h
    tail = on_chest(solid, across, up, 0.009 * h)
    end = plate(tail, tail - np.array([0.010 * h, 0.0, 0.0]), (-0.4, 0.0, f.level(0.8)))
    return [
        Piece(roll, colour, "neck", None, symmetry="side", material="cloth"),
        Piece(end, shade(colour, 0.88), "neck", None, symmetry="whole", material="cloth"),
    ]


def _stethoscope(f: Figure, solid: Field) -> list[Piece]:
    h, size = f.p.height, 0.0055 * f.p.height
    ring = _around_neck(f, 1.50, 0.02, 9)[3:]
    up = np.linspace(f.level(0.98), f.level(0.62), 6)
    across = np.array([0.046, 0.050, 0.048, 0.040, 0.022, 0.0])[:, None] * h
    hanging = on_chest(solid, across, up, 0.008 * h)[:, 0]
    tubes = strand(np.concatenate([ring[::-1], hanging]), size, 5)
    disc_at = on_chest(solid, np.array([0.0]), np.array([f.level(0.52)]), 0.008 * h)[0, 0]
    disc = ellipsoid_patch(disc_at, (0.006 * h, 0.015 * h, 0.015 * h), 10, 4)
    stem = strand(np.stack([hanging[-1], disc_at]), size, 5)
    return [
        Piece(tubes, f.spec.accent_color, "neck", None, symmetry="side"),
        Piece(stem, f.spec.accent_color, "neck", None, symmetry="whole"),
        Piece(disc, (0.72, 0.74, 0.77), "badge", None, symmetry="whole"),
    ]


# --- over the clothes -----------------------------------------------------------------------


def _apron(f: Figure, solid: Field, upper: list[Piece]) -> list[Piece]:
    """A bib, a skirt to the knees, ribbons round neck and waist."""
    h, colour = f.p.height, f.spec.accent_color
    whole = union(
        [(solid, 0.0), (leg_loft(f, 0.012 * h), 0.02 * h), (skirt_tail(f, f.p.knee, -0.10), 0.03 * h)]
    )
    levels = [f.level(x) for x in (0.80, 0.60, 0.40, 0.24, 0.05, -0.15)]
    up = np.array([*levels, 0.5 * (levels[-1] + f.p.knee), f.p.knee + 0.03 * h])
    wide = (
        np.array([0.046, 0.050, 0.058, 0.088, 0.098, 0.104, 0.106, 0.100])
        * h
        * (1.0 + 0.5 * max(f.heavy, 0.0))
    )
    outer = on_chest(whole, wide[:, None] * np.linspace(0.0, 1.0, 6), up, 0.008 * h)
    for row in range(1, len(up)):  # cloth hangs straight down from belly and chest
        outer[row, :, 0] = np.maximum(
            outer[row, :, 0], outer[row - 1, :, 0] - (0.010 if row > 3 else 0.02) * h
        )
    cloth = plate(outer, outer - np.array([0.010 * h, 0.0, 0.0]), (-0.5, 0.0, f.level(0.2)), back=True)
    pouch = on_chest(
        whole, np.linspace(0.0, 0.055, 4) * h, np.linspace(f.level(-0.10), f.level(0.12), 3), 0.020 * h
    )
    pocket = plate(pouch, pouch - np.array([0.012 * h, 0.0, 0.0]), (-0.5, 0.0, f.level(0.0)))
    loop = np.concatenate([[outer[0, -1] + (0.0, -0.004 * h, 0.0)], _around_neck(f, 1.38, 0.03, 9)[3:]])
    band = _round_waist(f, solid, f.level(0.24), 0.010, 0.003)
    return [
        Piece(cloth, colour, "over", None, rule="skirt", material="cloth"),
        Piece(pocket, shade(colour, 0.88), "pocket", None, rule="skirt", material="cloth"),
        Piece(strand(loop, 0.006 * h, 5), shade(colour, 0.88), "over", None, symmetry="side"),
        Piece(band, shade(colour, 0.88), "belt", None, material="cloth"),
    ]


def _overlaid(upper: list[Piece], outline: Field, lift: float, colour: Colour) -> list[Piece]:
    """A sleeveless layer over the top: its own surface within an outline, a little further out."""
    pieces = []
    upper_solid = upper[0].solid
    assert upper_solid is not None
    for piece in upper:
        if piece.solid is not upper_solid or piece.symmetry != "half":
            continue
        surface = np.abs(upper_solid(piece.patch.vertices)) < 0.004  # leaves out its hems
        patch = clip(
            compact(Patch(piece.patch.vertices, piece.patch.faces[surface[piece.patch.faces].all(1)])),
            outline,
        )
        if not len(patch.faces):
            continue
        slope = gradient(upper_solid, patch.vertices)
        slope[np.abs(patch.vertices[:, 1]) < 1e-9, 1] = 0.0
        slope /= np.maximum(np.linalg.norm(slope, axis=1, keepdims=True), 1e-9)
        moved = replace(
            piece, patch=Patch(patch.vertices + lift * slope, patch.faces), colour=colour, part="over"
        )
        pieces.append(hemmed(moved, 0.6 * lift))
    return pieces


def _sleeveless(f: Figure, low: float, neck: float, sharp: float) -> Field:
    """Negative within a vest: above ``low``, inside the armholes, below a neckline ``neck`` metres deep."""
    h, shoulder = f.p.height, f.joint("upperarm_l")
    top = f.level(1.10)

    def field(p: Points) -> Values:
        arm = p[:, 1] - 0.86 * shoulder[1] - 0.35 * np.clip(f.level(0.80) - p[:, 2], -0.02 * h, 0.2 * h)
        u, v, w = ((p - shoulder) @ ARM_FRAME.T).T
        sleeve = (u > 0.07 * h) & (np.hypot(v, w) < 0.075 * h)
        arm = np.where(p[:, 2] > f.level(0.58), arm, np.where(sleeve & (p[:, 1] > 0.12 * h), 0.05, -0.05))
        deep = np.clip((p[:, 2] - (top - neck)) / neck, 0.0, 1.3)
        open_ = np.where(
            (p[:, 0] > f.joint("neck")[0]) & (deep > 0), 0.062 * h * deep**sharp - p[:, 1], -0.05
        )
        return np.maximum(np.maximum(arm, open_), np.maximum(low - p[:, 2], p[:, 2] - top - 0.012 * h))

    return field


def _vest(f: Figure, solid: Field, upper: list[Piece]) -> list[Piece]:
    """High visibility: an open neck and two pale bands."""
    h = f.p.height
    outline, colour = _sleeveless(f, f.level(-0.03), 0.16 * h, 1.0), f.spec.accent_color
    pieces = _overlaid(upper, outline, 0.009 * h, colour)
    bands = []
    for at in (0.18, 0.46):
        band = _round_waist(f, solid, f.level(at), 0.013, 0.013)
        bands.append(Piece(band, (0.93, 0.92, 0.78), "belt", None))
    return [*pieces, *bands]


def _waistcoat(f: Figure, solid: Field, upper: list[Piece]) -> list[Piece]:
    outline = _sleeveless(f, f.level(0.02), 0.24 * f.p.height, 0.9)
    pieces = _overlaid(upper, outline, 0.006 * f.p.height, f.spec.accent_color)
    levels = np.array([f.level(x) for x in (0.08, 0.20, 0.32)])
    points = on_chest(solid, np.array([0.0]), levels, 0.009 * f.p.height)[:, 0]
    dots = merged([ellipsoid_patch(p, (0.003, 0.005 * f.p.height, 0.005 * f.p.height), 6, 3) for p in points])
    return [*pieces, Piece(dots, _BRASS, "badge", None, symmetry="whole")]


# --- around and behind --------------------------------------------------------------------------


def _round_waist(f: Figure, solid: Field, at: float, tall: float, lift: float) -> Patch:
    """A band around the trunk at a height; ``tall``, its half height, and ``lift``, its distance, are shares
    of the body's height."""
    h = f.p.height
    turn = np.linspace(0.0, np.pi, 17)
    rows = []
    for up in (at - tall * h, at + tall * h):
        way = np.stack([np.cos(turn), np.sin(turn), 0.0 * turn], 1)
        way[[0, -1], 1] = 0.0
        start = np.array([0.0, 0.0, up]) + 0.26 * h * way
        points = cast(solid, start, -way, 0.25 * h)
        rows.append(points + lift * h * way)
    outer = np.stack(rows)
    under = outer - (lift + 0.002) * h * np.stack([np.cos(turn), np.sin(turn), 0.0 * turn], 1)
    under[:, [0, -1], 1] = 0.0
    return plate(outer, under, (0.0, 0.0, at))


def _belt(f: Figure, solid: Field) -> list[Piece]:
    h = f.p.height
    long = f.spec.top in ("coat", "uniform", "tunic", "robe", "armour", "lab-coat", "shirt", "sweater")
    at = f.level(0.22) if long else f.level(0.10)
    colour = _DARK if sum(f.spec.shoes_color) > 1.9 else shade(f.spec.shoes_color, 0.9)
    front = on_chest(
        solid, np.linspace(0.0, 0.014, 3) * h, np.linspace(at - 0.014 * h, at + 0.014 * h, 3), 0.009 * h
    )
    buckle = plate(front, front - np.array([0.008 * h, 0.0, 0.0]), (-0.3, 0.0, at))
    return [
        Piece(_round_waist(f, solid, at, 0.0125, 0.006), colour, "belt", None),
        Piece(buckle, _BRASS, "badge", None),
    ]


def _badge(f: Figure, solid: Field) -> list[Piece]:
    h = f.p.height
    at = on_chest(solid, np.array([0.052 * h]), np.array([f.level(0.76)]), 0.006 * h)[0, 0]
    shield = ellipsoid_patch(at, (0.004 * h, 0.013 * h, 0.016 * h), 6, 4)
    return [Piece(shield, f.spec.accent_color, "badge", None, symmetry="whole")]


def _backpack(f: Figure, solid: Field) -> list[Piece]:
    """A pack between shoulders and hips with straps over the shoulders; stiff and large on a space suit."""
    h, space = f.p.height, f.spec.top == "spacesuit"
    colour = f.spec.top_color if space else f.spec.accent_color
    tall, wide, deep = (0.135, 0.098, 0.062) if space else (0.118, 0.078, 0.056)
    middle_z = f.level(0.62)
    back = on_chest(solid, np.array([0.0]), np.array([middle_z]), 0.0, -1.0)[0, 0]
    centre = back + np.array([-0.50 * deep * h, 0.0, 0.0])
    polar, turn = np.linspace(0.0, np.pi, 9)[:, None], np.linspace(0.0, np.pi, 13)
    box = lambda v: np.sign(v) * np.abs(v) ** 0.45  # noqa: E731
    unit = np.stack(
        [
            box(np.sin(polar)) * box(np.cos(turn)),
            box(np.sin(polar)) * box(np.sin(turn)),
            box(np.cos(polar)) + 0 * turn,
        ],
        -1,
    )
    unit[:, [0, -1], 1] = 0.0
    unit[[0, -1], :, 1] = 0.0
    grid = centre + unit * np.array([deep, wide, tall]) * h
    pack = plate(grid, grid, centre)
    size = np.array([deep, wide, tall])
    flap = plate(centre + unit[:4] * (size + 0.006) * h, centre + unit[:4] * size * h, centre)
    z = np.array([0.98, 1.03, 1.0, 0.86, 0.66, 0.46])
    y = np.array([0.050, 0.058, 0.062, 0.066, 0.068, 0.074]) * h
    ahead = on_chest(solid, y[2:, None], np.array([f.level(v) for v in z[2:]]), 0.004 * h)[:, 0]
    behind = on_chest(solid, y[:1, None], np.array([f.level(z[0])]), 0.004 * h, -1.0)[:, 0]
    crest = cast(
        solid, np.array([[f.joint("upperarm_l")[0], y[1], f.level(1.0) + 0.12 * h]]), (0, 0, -1.0), 0.25 * h
    )
    way = _halved(np.concatenate([behind, crest, ahead])[:, None], 6)
    way = _kept_off(solid, way, np.full(way.shape[:2], 0.003 * h))[:, 0]
    strap = strand(way, 0.011 * h, 5)
    return [
        Piece(pack, colour, "pack", None, rule="chest", material="plain" if space else "cloth"),
        Piece(flap, shade(colour, 0.82), "trim", None, rule="chest"),
        Piece(strap, shade(colour, 0.72), "belt", None, symmetry="side"),
    ]


def _halved(grid: Points, rows: int) -> Points:
    """A grid [R, C, 3] with another row between each two of its first ``rows``."""
    head = np.stack([grid[: rows - 1], (grid[: rows - 1] + grid[1:rows]) / 2], 1)
    return np.concatenate([head.reshape(-1, *grid.shape[1:]), grid[rows - 1 :]])


def _kept_off(solid: Field, grid: Points, gap: Values) -> Points:
    """Points [R, C, 3] moved out until they are ``gap`` [R, C] metres off a solid's surface."""
    points = grid.reshape(-1, 3).copy()
    middle = points[:, 1] < 1e-9
    for _ in range(3):
        slope = gradient(solid, points)
        slope[middle, 1] = 0.0
        slope /= np.maximum(np.linalg.norm(slope, axis=1, keepdims=True), 1e-9)
        points += slope * np.clip(gap.reshape(-1) - solid(points), 0.0, 0.05)[:, None]
    return points.reshape(grid.shape)


def _cape(f: Figure, solid: Field) -> list[Piece]:
    """From the shoulders down the back to the calves."""
    h, colour = f.p.height, f.spec.accent_color
    shoulder = f.joint("upperarm_l")[1]
    share = np.linspace(0.0, 1.0, 7)
    up = np.array(
        [
            f.level(1.02),
            f.level(0.90),
            f.level(0.66),
            f.level(0.30),
            f.level(-0.10),
            f.p.knee,
            0.55 * f.p.knee,
        ]
    )
    half_wide = np.array([0.92, 1.06, 1.10, 1.12, 1.25, 1.5, 1.6]) * shoulder
    across = half_wide[:, None] * share
    out = on_chest(solid, across, up, 0.016 * h, -1.0)
    edge = share**2
    out[0, :, 0] += 0.055 * h * edge
    out[1, :, 0] = np.minimum(out[1, :, 0], 0.0) + 0.01 * h * edge
    flow = np.minimum.accumulate(out[..., 0], axis=0)
    flow[3:] = np.minimum(flow[3:], flow[2].mean() - np.array([0.01, 0.03, 0.05, 0.06])[:, None] * h)
    folds = (
        0.012 * h * np.cos(3.5 * np.pi * share) * np.clip((f.level(0.8) - up) / (0.4 * h), 0.0, 1.0)[:, None]
    )
    out[2:, :, 0] = np.clip(flow[2:], -0.20 * h, 0.0) + folds[2:]
    above = np.stack(
        [out[0, :, 0] + 0.026 * h * (1 - edge), out[0, :, 1], np.full(len(share), f.level(1.0) + 0.14 * h)], 1
    )
    out[0] = cast(solid, above, (0.0, 0.0, -1.0), 0.26 * h) + np.array([0.0, 0.0, 0.008 * h])
    out = _halved(out, 3)
    out = _kept_off(solid, out, (0.011 + 0.016 * np.clip((f.level(0.5) - out[..., 2]) / (0.2 * h), 0, 1)) * h)
    under = out + np.array([0.008 * h, 0.0, 0.0])
    clasp = strand(np.concatenate([[out[0, -1]], _around_neck(f, 1.55, 0.05, 7)[:4][::-1]]), 0.009 * h, 5)
    return [
        Piece(
            plate(out, under, (0.4, 0.0, f.level(0.3)), back=True),
            colour,
            "cape",
            None,
            rule="cape",
            material="cloth",
        ),
        Piece(clasp, shade(colour, 0.8), "belt", None, symmetry="side"),
    ]
