"""The naked body as fields: torso, arm, leg, foot and hand of the left half.

All sizes are shares of the height unless a limb's own length is named; the right half is the mirror
image, so every field here is meant for points with Y >= 0 (see :func:`runtime.body.field.mirrored`).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from .field import Field, Knot, ellipsoid, loft, round_cone, union, within
from .proportions import Proportions, make_skeleton, proportions
from .skeleton import JOINT, Skeleton
from .spec import BodySpec

#: Rows u (along), v (forward), w (outward) of the frames in which limbs are described.
ARM_FRAME = np.array([[0.0, 0.5**0.5, -(0.5**0.5)], [1.0, 0.0, 0.0], [0.0, 0.5**0.5, 0.5**0.5]])
LEG_FRAME = np.array([[0.0, 0.0, -1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
TORSO_FRAME = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
FOOT_FRAME = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]])


#: What large surfaces may have in triangles, and what the words of a spec add to that.
BUDGET = 6600
_WORN = ("hair", "facial_hair", "top", "bottom", "shoes", "hat", "neck", "over", "back")
_LOADS: dict[str, int] = {
    **dict.fromkeys(("bob", "curly", "afro"), 500), "wavy": 1300, "long": 900, "locs": 1300, "braids": 300,
    "ponytail": 300, "bun": 300, "pixie": 100,
    "long-beard": 1200, "beard": 600, "goatee": 400, "moustache": 100,
    **dict.fromkeys(("suit", "blazer", "coat", "uniform", "chef-jacket", "dress", "sweater"), 500),
    **dict.fromkeys(("lab-coat", "jacket", "hoodie", "kimono", "gown", "tunic", "robe"), 900),
    "tank": 300, "armour": 1600, "spacesuit": 2000,
    "overalls": 500, "skirt": 400, "pencil-skirt": 300, "long-skirt": 400, "shorts": 300, "boots": 500,
    **dict.fromkeys(("brimmed-hat", "straw-hat", "tricorn", "wizard-hat", "crown", "toque"), 700),
    **dict.fromkeys(("cap", "police-cap", "beanie", "beret", "helmet", "hard-hat", "fire-helmet"), 400),
    "tiara": 400,
    "hood": 1600, "veil": 2800, "knight-helmet": 1600, "space-helmet": 800,
    "tie": 150, "bow-tie": 150, "scarf": 250, "stethoscope": 250,
    "apron": 600, "vest": 900, "waistcoat": 1100, "backpack": 1100, "cape": 800,
}  # fmt: skip


@dataclass(frozen=True)
class Figure:
    """One person's measures at hand: spec, proportions, skeleton."""

    spec: BodySpec

    @cached_property
    def p(self) -> Proportions:
        return proportions(self.spec)

    @cached_property
    def skeleton(self) -> Skeleton:
        return make_skeleton(self.spec)

    def joint(self, name: str) -> NDArray[np.float64]:
        """Bind position of a joint, metres."""
        return self.skeleton.bind[JOINT[name]]

    @property
    def heavy(self) -> float:
        """Build relative to the average: about -0.4 .. 0.6."""
        return self.spec.build - 0.42

    @property
    def fem(self) -> float:
        """Grown-up femininity: children are shaped alike."""
        return self.spec.femininity * (1.0 - self.spec.youth)

    @cached_property
    def detail(self) -> float:
        """How finely large surfaces are made, about 0.6 .. 1: less where much is worn, to stay within the
        triangles a person may have."""
        load = sum(_LOADS.get(getattr(self.spec, k), 0) for k in _WORN)
        return float((BUDGET / (BUDGET + load)) ** 1.3)

    def level(self, share: float) -> float:
        """Height of a level of the torso: 0 is the hip joint, 1 the shoulder joint."""
        hip, shoulder = self.p.hip[1], self.p.shoulder[1]
        return hip + (shoulder - hip) * share

    def mix(self, masculine: float, feminine: float) -> float:
        return masculine + (feminine - masculine) * self.fem


# level; front, back, side for men; front, back, side for women; middle forward; share of build
_TORSO = (
    (-0.22, 0.040, 0.046, 0.066, 0.040, 0.050, 0.072, 0.000, 0.5),
    (-0.05, 0.054, 0.064, 0.092, 0.053, 0.071, 0.101, 0.000, 0.6),
    (0.14, 0.054, 0.056, 0.090, 0.050, 0.056, 0.092, 0.001, 0.9),
    (0.35, 0.053, 0.049, 0.081, 0.045, 0.043, 0.070, 0.003, 1.0),
    (0.56, 0.059, 0.053, 0.090, 0.049, 0.049, 0.077, 0.002, 0.8),
    (0.74, 0.063, 0.058, 0.105, 0.052, 0.053, 0.086, -0.002, 0.5),
    (0.88, 0.055, 0.057, 0.104, 0.047, 0.051, 0.083, -0.006, 0.4),
    (1.00, 0.041, 0.047, 0.082, 0.036, 0.042, 0.070, -0.009, 0.3),
    (1.10, 0.029, 0.036, 0.052, 0.026, 0.032, 0.044, -0.009, 0.2),
    (1.22, 0.024, 0.030, 0.030, 0.021, 0.026, 0.025, -0.006, 0.2),
)


def torso_loft(f: Figure, grow: float = 0.0, ease: float = 0.0) -> Field:
    """The trunk from crotch to neck; ``grow`` adds thickness, ``ease`` fills the waist (loose cloth)."""
    h, heavy, youth = f.p.height, f.heavy, f.spec.youth
    lean = 0.0128 * h * f.p.stoop
    knots = []
    for at, mf, mb, ms, ff, fb, fs, middle, share in _TORSO:
        front, back, side = f.mix(mf, ff), f.mix(mb, fb), f.mix(ms, fs)
        waist = float(np.exp(-(((at - 0.32) / 0.26) ** 2)))
        belly = 1.0 + waist * (
            (1.5 if heavy > 0 else 0.5) * heavy + 0.16 * f.spec.eld + 0.12 * youth + 0.5 * ease
        )
        width = 1.0 + share * 0.62 * heavy + waist * (0.10 * youth + ease)
        stoop = f.p.stoop * float(np.exp(-(((at - 0.92) / 0.2) ** 2)))
        bend = lean * float(np.clip(at - 0.3, 0.0, 1.0)) / 0.7
        knots.append(
            Knot(
                f.level(at),
                h * front * belly * (1.0 + 0.35 * share * heavy),
                h * (back * (1.0 + 0.45 * share * heavy) + 0.010 * stoop),
                h * side * width * (1.0 - 0.04 * youth),
                v=h * middle + bend,
            )
        )
    return loft((0.0, 0.0, 0.0), TORSO_FRAME, knots, power=2.25, grow=grow)


def bust(f: Figure, grow: float = 0.0) -> list[tuple[Field, float]]:
    """Chest forms in front of the trunk's loft."""
    h, z = f.p.height, f.level(0.70)
    x = h * f.mix(0.047, 0.041)
    if f.fem > 0.6:
        r = h * (0.024 + 0.009 * f.fem + 0.016 * max(f.heavy, 0.0))
        c = (x - 0.1 * r, 0.041 * h, z)
        return [(ellipsoid(c, (r + grow, 1.06 * r + grow, 1.02 * r + grow)), 0.035 * h)]
    c = (x - 0.010 * h, 0.042 * h, f.level(0.78))
    return [(ellipsoid(c, (0.028 * h + grow, 0.046 * h + grow, 0.034 * h + grow)), 0.03 * h)]


def seat(f: Figure, grow: float = 0.0) -> list[tuple[Field, float]]:
    """The buttocks."""
    h = f.p.height
    r = h * (f.mix(0.047, 0.053) + 0.02 * f.heavy) * (1.0 - 0.1 * f.spec.youth)
    c = (-0.030 * h, 0.044 * h, f.level(-0.10))
    return [(ellipsoid(c, (r + grow, 0.95 * r + grow, 1.05 * r + grow)), 0.03 * h)]


def shoulders(f: Figure, grow: float = 0.0) -> list[tuple[Field, float]]:
    """Trapezius, collarbone and the cap of the shoulder."""
    h, k = f.p.height, limb(f)
    top = f.joint("upperarm_l")
    nape = f.joint("neck") + np.array([-0.010 * h, 0.012 * h, 0.022 * h])
    acromion = top + np.array([-0.004 * h, -0.016 * h, 0.004 * h])
    r = h * 0.026 * f.mix(1.0, 0.80)
    collar = [
        f.joint("neck") + np.array([0.026 * h, 0.012 * h, -0.006 * h]),
        top + np.array([0.014 * h, -0.02 * h, 0.008 * h]),
    ]
    return [
        (round_cone(nape, acromion, 0.9 * r + grow, r + grow), 0.035 * h),
        (round_cone(collar[0], collar[1], 0.010 * h + grow, 0.014 * h + grow), 0.025 * h),
        (ellipsoid(top + np.array([0.0, -0.002 * h, -0.003 * h]), 0.0335 * h * k + grow), 0.045 * h),
    ]


def limb(f: Figure) -> float:
    """Thickness of arms against an average man's."""
    return (1.0 + 0.42 * f.heavy) * f.mix(1.0, 0.83) * (1.0 - 0.06 * f.spec.youth) * (1.0 - 0.07 * f.spec.eld)


def arm_loft(f: Figure, grow: float = 0.0, until: float = 1.0) -> Field:
    """Shoulder to wrist, or to the share ``until`` of that way."""
    h, a, b, k = f.p.height, f.p.upper_arm, f.p.forearm, limb(f) * f.p.height
    wrist = 0.5 * k + 0.5 * h * f.mix(1.0, 0.86)
    rows = (
        (-0.050 * h, 0.008 * k, 0.008 * k, 0.008 * k, 0.008 * k, 0.0),
        (-0.036 * h, 0.024 * k, 0.024 * k, 0.022 * k, 0.024 * k, 0.0),
        (-0.012 * h, 0.033 * k, 0.033 * k, 0.031 * k, 0.034 * k, 0.0),
        (0.14 * a, 0.035 * k, 0.034 * k, 0.030 * k, 0.0365 * k, 0.0),
        (0.30 * a, 0.034 * k, 0.032 * k, 0.029 * k, 0.034 * k, 0.0),
        (0.55 * a, 0.0325 * k, 0.029 * k, 0.0275 * k, 0.028 * k, 0.001 * h),
        (0.85 * a, 0.0260 * k, 0.0255 * k, 0.0240 * k, 0.0240 * k, 0.0),
        (a, 0.0240 * k, 0.0255 * k, 0.0235 * k, 0.0235 * k, 0.0),
        (a + 0.22 * b, 0.0275 * k, 0.0255 * k, 0.0250 * k, 0.0255 * k, 0.001 * h),
        (a + 0.55 * b, 0.0232 * wrist, 0.0220 * wrist, 0.0205 * wrist, 0.0205 * wrist, 0.0),
        (a + 0.88 * b, 0.0178 * wrist, 0.0175 * wrist, 0.0142 * wrist, 0.0142 * wrist, 0.0),
        (a + 1.08 * b, 0.0180 * wrist, 0.0175 * wrist, 0.0130 * wrist, 0.0130 * wrist, 0.0),
    )
    knots = [Knot(at, fr, bk, inner, v=v, outer=outer) for at, fr, bk, inner, outer, v in rows]
    if until < 1.0:
        end = until * (a + b)
        knots = [q for q in knots if q.at < end - 0.02] + [_between(knots, end)]
    return loft(f.joint("upperarm_l"), ARM_FRAME, knots, power=2.1, grow=grow)


def _between(knots: list[Knot], at: float) -> Knot:
    names = ("front", "back", "side", "v", "w")
    places = [q.at for q in knots]
    values = {n: float(np.interp(at, places, [getattr(q, n) for q in knots])) for n in names}
    outer = float(np.interp(at, places, [q.side if q.outer is None else q.outer for q in knots]))
    return Knot(at, values["front"], values["back"], values["side"], values["v"], values["w"], outer)


def arm_point(f: Figure, along: float, forward: float = 0.0, outward: float = 0.0) -> NDArray[np.float64]:
    """A point in the left arm's frame, metres from the shoulder joint."""
    return f.joint("upperarm_l") + np.array([along, forward, outward]) @ ARM_FRAME


# share of the hand across it at the knuckles, at the tip; length from knuckle to tip; radius
_FINGERS = (
    (0.155, 0.190, 0.455, 1.00),
    (0.052, 0.064, 0.505, 1.04),
    (-0.052, -0.064, 0.465, 1.0),
    (-0.150, -0.192, 0.355, 0.90),
)


def hand(f: Figure) -> Field:
    """Palm, four fingers slightly bent and spread, thumb."""
    k, wrist = f.p.hand, f.p.upper_arm + f.p.forearm
    thick = f.mix(1.0, 0.90) * (1.0 + 0.15 * f.heavy) * (1.0 + 0.05 * f.spec.youth)

    def at(u: float, v: float, w: float) -> NDArray[np.float64]:
        return arm_point(f, wrist + u * k, v * k, w * k)

    t = thick * k
    palm = loft(
        f.joint("upperarm_l"),
        ARM_FRAME,
        [
            Knot(wrist - 0.10 * k, 0.12 * t, 0.12 * t, 0.09 * t),
            Knot(wrist + 0.02 * k, 0.145 * t, 0.145 * t, 0.092 * t),
            Knot(wrist + 0.22 * k, 0.185 * t, 0.195 * t, 0.092 * t, w=-0.005 * k),
            Knot(wrist + 0.42 * k, 0.205 * t, 0.200 * t, 0.074 * t, w=-0.004 * k),
            Knot(wrist + 0.54 * k, 0.170 * t, 0.175 * t, 0.045 * t, w=-0.006 * k),
        ],
        power=2.4,
    )
    thumb = [
        at(0.10, 0.09, -0.045),
        at(0.30, 0.255, -0.085),
        at(0.46, 0.335, -0.105),
        at(0.585, 0.365, -0.115),
    ]
    parts = [(palm, 0.0), (round_cone(thumb[0], thumb[1], 0.085 * t, 0.068 * t), 0.05 * k)]
    parts += [(round_cone(thumb[1], thumb[2], 0.064 * t, 0.056 * t), 0.02 * k)]
    parts += [(round_cone(thumb[2], thumb[3], 0.056 * t, 0.046 * t), 0.02 * k)]
    fingers: Field | None = None
    for base, tip, length, size in _FINGERS:
        r = 0.0535 * t * size
        way = [0.46, 0.46 + 0.46 * length, 0.46 + 0.75 * length, 0.46 + length]
        across = np.interp(way, [way[0], way[-1]], [base, tip])
        bend = [-0.002, -0.020, -0.052, -0.098]
        c = [at(u, v, w) for u, v, w in zip(way, across, bend, strict=True)]
        one = union(
            [
                (round_cone(c[0], c[1], 1.04 * r, 0.98 * r), 0.0),
                (round_cone(c[1], c[2], 0.98 * r, 0.92 * r), 0.012 * k),
                (round_cone(c[2], c[3], 0.92 * r, 0.78 * r), 0.012 * k),
            ]
        )
        fingers = one if fingers is None else union([(fingers, 0.0), (one, 0.012 * k)])
    assert fingers is not None
    return union([*parts, (fingers, 0.045 * k)])


def arm(f: Figure) -> Field:
    """The bare left arm with its hand."""
    k = f.p.hand
    fist = within(hand(f), arm_point(f, f.p.upper_arm + f.p.forearm + 0.45 * k), 0.80 * k)
    return union([(arm_loft(f), 0.0), (fist, 0.05 * k)])


def leg_loft(f: Figure, grow: float = 0.0) -> Field:
    """Hip to ankle, bare."""
    h, a, b = f.p.height, f.p.hip[1] - f.p.knee, f.p.knee - f.p.ankle
    k = h * (1.0 + 0.40 * f.heavy) * (1.0 - 0.06 * f.spec.eld)
    t, c = k * f.mix(1.0, 1.05), k * f.mix(1.0, 0.90) * (1.0 - 0.04 * f.spec.youth)
    rows = (
        (-0.100 * h, 0.006 * t, 0.006 * t, 0.006 * t, 0.006 * t, 0.0),
        (-0.080 * h, 0.026 * t, 0.026 * t, 0.028 * t, 0.028 * t, 0.0),
        (-0.030 * h, 0.045 * t, 0.050 * t, 0.044 * t, 0.046 * t, 0.0),
        (0.14 * a, 0.051 * t, 0.053 * t, 0.045 * t, 0.047 * t, 0.0),
        (0.50 * a, 0.045 * t, 0.045 * t, 0.039 * t, 0.041 * t, 0.002 * h),
        (0.84 * a, 0.0335 * c, 0.0340 * c, 0.0315 * c, 0.0315 * c, 0.002 * h),
        (a, 0.0330 * c, 0.0300 * c, 0.0300 * c, 0.0300 * c, 0.003 * h),
        (a + 0.10 * b, 0.0295 * c, 0.0330 * c, 0.0295 * c, 0.0295 * c, 0.001 * h),
        (a + 0.30 * b, 0.0265 * c, 0.0395 * c, 0.0325 * c, 0.0330 * c, -0.001 * h),
        (a + 0.60 * b, 0.0215 * c, 0.0290 * c, 0.0245 * c, 0.0245 * c, -0.003 * h),
        (a + 0.86 * b, 0.0175 * c, 0.0205 * c, 0.0180 * c, 0.0180 * c, -0.003 * h),
        (a + 1.04 * b, 0.0195 * c, 0.0225 * c, 0.0195 * c, 0.0195 * c, -0.002 * h),
    )
    knots = [Knot(at, fr, bk, inner, v=v, outer=outer) for at, fr, bk, inner, outer, v in rows]
    return loft(f.joint("thigh_l"), LEG_FRAME, knots, grow=grow)


def shoe(f: Figure) -> Field:
    """A shoe with a flat sole, around the ankle joint's axis."""
    n, z, y = f.p.foot, f.p.ankle, f.p.hip[0]
    wide = n * f.mix(1.0, 0.92) * (1.0 + 0.1 * f.heavy)
    middle = 0.30 * z
    rows = (
        (-0.275, 0.20, 0.060, 0.060),
        (-0.255, 0.55, 0.092, 0.092),
        (-0.16, 0.78, 0.128, 0.126),
        (-0.02, 0.85, 0.128, 0.122),
        (0.12, 0.72, 0.140, 0.112),
        (0.30, 0.46, 0.168, 0.134),
        (0.50, 0.30, 0.178, 0.158),
        (0.64, 0.23, 0.150, 0.146),
        (0.73, 0.14, 0.098, 0.104),
        (0.765, 0.04, 0.050, 0.056),
    )
    knots = [Knot(x * n, up * z, middle, inner * wide, outer=outer * wide) for x, up, outer, inner in rows]
    body = loft((0.0, y + 0.004 * f.p.height, middle), FOOT_FRAME, knots, power=2.5)
    ankle = round_cone((-0.01 * n, y, 0.5 * z), (-0.012 * n, y, 1.5 * z), 0.135 * wide, 0.120 * wide)
    return union([(body, 0.0), (ankle, 0.10 * n)])


def neck(f: Figure, grow: float = 0.0) -> Field:
    """From the pit of the throat to under the skull."""
    h, head = f.p.height, f.p.head
    r = h * f.mix(0.0335, 0.0268) * (1.0 + 0.35 * f.heavy) * (1.0 - 0.10 * f.spec.youth)
    low = f.joint("neck") + np.array([0.004 * h, 0.0, -0.030 * h])
    high = f.joint("head") + np.array([-0.06 * head, 0.0, 0.05 * head])
    return round_cone(low, high, 1.10 * r + grow, 0.98 * r + grow)


def trunk(f: Figure, grow: float = 0.0, ease: float = 0.0, chest: bool = True) -> Field:
    """Torso with shoulders, without limbs and head."""
    parts = [(torso_loft(f, grow, ease), 0.0), *shoulders(f, grow), *seat(f, grow)]
    if chest:
        parts += bust(f, grow)
    return union(parts)
