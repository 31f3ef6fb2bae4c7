"""Hard and bulky suits: plate armour over mail, and a space suit with its rings."""

from __future__ import annotations

import numpy as np

from .anatomy import ARM_FRAME, Figure, arm_point, leg_loft, limb, trunk
from .field import Field, Points, Values, smooth_min
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
from .pieces import Piece, hemmed, parted, parted_all, shade
from .sheets import ellipsoid_patch, on_chest, plate
from .spec import Colour
from .surface import Patch, clip, cull

_MAIL: Colour = (0.36, 0.38, 0.42)


def armour(f: Figure) -> list[Piece]:
    """A cuirass with skirt plates, pauldrons and cops over a coat of mail."""
    h, steel = f.p.height, f.spec.top_color
    hem = f.level(-0.30)
    mail = garment(
        f, 0.0105 * h, 0.05, hem, sleeve_length(f, 0.97), neckline(f, 0.026 * h, -0.001 * h, 0.010 * h),
        tail=skirt_tail(f, hem - 0.06 * h, 0.02), rule="skirt", faces=820,
    )  # fmt: skip
    breast = _breast(f)
    hidden = cull(mail.patch, lambda p: np.maximum(breast(p), p[:, 2] - f.level(0.55)), 0.003)
    mail = Piece(hidden, _MAIL, "top", mail.solid, rule="skirt", material="cloth")
    fore = along_arm(f, f.p.upper_arm + 0.22 * f.p.forearm, 0.05)
    looks = parted(mail, lambda p: -fore(p), shade(steel, 0.92), "plate")
    pieces = [hemmed(q, 0.010 * h) for q in looks]
    pieces += [_cuirass(f), *_cops(f)]
    middle = f.level(0.62)
    for wide, tall in ((0.010, 0.075), (0.038, 0.011)):
        at = middle + (0.022 * h if wide > tall else 0.0)
        bar = on_chest(
            breast, np.linspace(0.0, wide, 3) * h, np.linspace(at - tall * h, at + tall * h, 5), 0.004 * h
        )
        cross = plate(bar, bar - np.array([0.008, 0.0, 0.0]), (-0.3, 0.0, middle))
        pieces.append(Piece(cross, f.spec.accent_color, "badge", None))
    return pieces


def _breast(f: Figure) -> Field:
    h = f.p.height
    body, leg = trunk(f, 0.0220 * h, 0.10), leg_loft(f, 0.0220 * h)  # all around the mail
    skirt = skirt_tail(f, f.level(-0.30) - 0.06 * h, 0.10)

    def field(p: Points) -> Values:
        keel = 0.010 * h * np.exp(-((p[:, 1] / (0.03 * h)) ** 2)) * np.clip((p[:, 0] - 0.02) / 0.05, 0.0, 1.0)
        lames = (
            0.004
            * h
            * np.sin((p[:, 2] - f.level(0.25)) * 2 * np.pi / (0.045 * h))
            * (p[:, 2] < f.level(0.25))
        )
        below = smooth_min(skirt(p) - 0.010 * h, leg(p), 0.03 * h)
        return smooth_min(body(p), below, 0.02 * h) - keel - lames

    return field


def _cuirass(f: Figure) -> Piece:
    """Breastplate, backplate and lames to below the hips, left half."""
    h = f.p.height
    solid = _breast(f)
    low = f.level(-0.17)
    shoulder = f.joint("upperarm_l")
    patch = surface_of(f, solid, low - 0.04 * h, f.level(1.2), False, 620, 0.0088)

    def armhole(p: Points) -> Values:
        inner = 0.92 * shoulder[1] + 0.35 * np.clip(f.level(0.80) - p[:, 2], -0.02 * h, 0.2 * h)
        return np.where(p[:, 2] > f.level(0.60), p[:, 1] - inner, -0.05)

    patch = clip(clip(patch, both(above(low), armhole)), neckline(f, 0.030 * h, 0.010 * h, 0.0))
    return hemmed(Piece(patch, f.spec.top_color, "plate", solid, rule="skirt"), 0.012 * h)


def _cops(f: Figure) -> list[Piece]:
    """Pauldrons and elbow cops, going half way with their joints."""
    h, steel, k = f.p.height, f.spec.top_color, limb(f)
    shoulder = f.joint("upperarm_l")
    dome = ellipsoid_patch((0.0, 0.0, 0.0), (0.054 * h * k, 0.050 * h * k, 0.046 * h * k), 10, 7)
    upper = dome.vertices + shoulder + np.array([0.004 * h, 0.012 * h, 0.006 * h])
    lower = 0.90 * dome.vertices + arm_point(f, 0.055 * h)
    elbow = ellipsoid_patch(
        arm_point(f, f.p.upper_arm, -0.006 * h), (0.041 * h * k, 0.040 * h * k, 0.041 * h * k), 10, 7
    )
    return [
        Piece(Patch(upper, dome.faces), steel, "plate", None, rule="half-shoulder_l", symmetry="side"),
        Piece(Patch(lower, dome.faces), shade(steel, 0.86), "trim", None, rule="upperarm_l", symmetry="side"),
        Piece(elbow, shade(steel, 1.12), "plate", None, rule="half-elbow_l", symmetry="side"),
    ]


def rings(along: Values, places: tuple[float, ...], high: float, width: float) -> Values:
    """Thickness of raised rings at ``places`` of a coordinate, metres."""
    total = np.zeros(len(along))
    for at in places:
        total += high * np.exp(-(((along - at) / width) ** 2))
    return total


def spacesuit(f: Figure) -> list[Piece]:
    """Bulky, in folds between rings, with a control box on the chest."""
    h = f.p.height
    places = tuple(f.p.upper_arm * x for x in (0.35, 0.62, 0.90)) + tuple(
        f.p.upper_arm + f.p.forearm * x for x in (0.25, 0.50)
    )
    base = top_solid(f, 0.0260 * h, 0.25, _puffed(f, places))
    hem = f.level(-0.16)
    patch = surface_of(f, base, hem - 0.04 * h, f.level(1.35), True, 1000)
    end = sleeve_length(f, 0.98)
    line = neckline(f, 0.024 * h, 0.002 * h, 0.012 * h)
    patch = clip(patch, both(both(above(hem), along_arm(f, end, 0.06)), line))
    piece = Piece(patch, f.spec.top_color, "top", base, material="cloth")
    grey = shade(f.spec.top_color, 0.70)

    cuff = along_arm(f, end - 0.030 * h, 0.06)
    looks = parted(piece, lambda p: -cuff(p), grey, "trim")
    waist = f.level(-0.10)
    band: list[Field] = [lambda p: p[:, 2] - waist - 0.016 * h, lambda p: waist - 0.016 * h - p[:, 2]]
    looks = [*parted_all(looks[0], band, f.spec.accent_color, "belt"), looks[1]]
    across, up = np.linspace(0.0, 0.052, 3) * h, np.linspace(f.level(0.42), f.level(0.66), 3)
    box = on_chest(base, across, up, 0.0)
    front_x = float(box[..., 0].max()) + 0.022 * h
    outer = box.copy()
    outer[..., 0] = front_x
    pack = Piece(plate(outer, box, (-0.3, 0.0, float(up.mean()))), grey, "pack", None)
    dots = on_chest(base, np.array([0.030 * h]), np.array([f.level(0.48), f.level(0.57)]), 0.0).reshape(-1, 3)
    dots[:, 0] = front_x
    lights = [
        Piece(ellipsoid_patch(p, (0.004, 0.009 * h, 0.009 * h), 6, 3), c, "badge", None, symmetry="whole")
        for p, c in zip(dots, (f.spec.accent_color, (0.25, 0.45, 0.75)), strict=True)
    ]
    return [*[hemmed(q, 0.014 * h) for q in looks], pack, *lights]


def _puffed(f: Figure, places: tuple[float, ...]) -> Field:
    """A sleeve in folds."""
    thick = sleeve(f, 0.0200 * f.p.height, 0.0)
    origin = f.joint("upperarm_l")

    def field(p: Points) -> Values:
        u = ((p - origin) @ ARM_FRAME.T)[:, 0]
        return thick(p) - rings(u, places, 0.0055 * f.p.height, 0.014 * f.p.height)

    return field
