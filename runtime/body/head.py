"""The head as fields: skull, jaw, features, and the outlines along which the face is cut into parts.

Everything is in *head units*: the origin under the pivot of the head at the chin's height, 1 is chin to
crown, X forward. :class:`Head` turns metres into head units and back.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .anatomy import Figure, neck, shoulders, torso_loft
from .field import Field, Points, Values, carve, ellipsoid, monotone, round_cone, smooth_min, union, within

_EAR = np.array([-0.030, 0.332, 0.465])
_LEAN = np.linalg.qr(np.array([[0.94, -0.33, -0.13], [0.30, 0.93, -0.17], [0.18, 0.12, 0.98]]))
_EAR_LEAN = _LEAN[0].T * np.sign(np.diag(_LEAN[1]))[:, None]
#: Styles that fall over the ears.
EARS_COVERED = ("bob", "long")


@dataclass(frozen=True)
class Head:
    """Where a figure's head is and how its features are shaped."""

    figure: Figure

    @property
    def unit(self) -> float:
        """Metres per head unit."""
        return self.figure.p.head

    @property
    def origin(self) -> NDArray[np.float64]:
        return np.array([self.figure.joint("head")[0], 0.0, self.figure.p.chin])

    def units(self, points: Points) -> Points:
        """Head units of points in metres, [N, 3]."""
        return (points - self.origin) / self.unit

    def metres(self, points: Points) -> Points:
        """Metres of points in head units, [N, 3]."""
        return points * self.unit + self.origin

    def field(self, shape: Field) -> Field:
        """A field in metres of one in head units."""
        return lambda p: shape(self.units(p)) * self.unit

    # --- measures of the face ------------------------------------------------------

    @property
    def fem(self) -> float:
        return self.figure.fem

    @property
    def soft(self) -> float:
        """1 for a child's soft face, else femininity's share."""
        return max(self.figure.spec.youth, 0.7 * self.fem)

    @property
    def eye(self) -> NDArray[np.float64]:
        """Centre of the left eyeball, head units."""
        return self.units(self.figure.joint("eye_l")[None])[0]

    eye_radius = 0.098
    mouth_z = 0.205

    @property
    def mouth_half(self) -> float:
        return 0.132 - 0.010 * self.soft


def skull(head: Head) -> Field:
    """Cranium, face and jaw without features; half space Y >= 0 suffices."""
    f, soft = head.figure, head.soft
    youth, eld, plump = f.spec.youth, f.spec.eld, max(f.heavy, -0.3)
    jaw = 0.226 - 0.050 * soft + 0.05 * plump
    chin = 0.078 - 0.022 * soft
    cranium = ellipsoid((-0.045, 0.0, 0.625), (0.425, 0.325 + 0.012 * youth, 0.375))
    face = ellipsoid((0.095, 0.0, 0.415), (0.272, 0.262 - 0.012 * soft + 0.02 * plump, 0.400))
    parts = [
        (cranium, 0.0),
        (face, 0.12),
        (round_cone((0.235, 0.0, 0.085), (0.225, 0.045, 0.09), chin + 0.005, chin), 0.10),
        (round_cone((0.215, 0.05, 0.10), (0.02, jaw - 0.055, 0.235), 0.065, 0.075), 0.10),
        (ellipsoid((0.215, 0.158, 0.345), (0.115, 0.095 - 0.02 * eld, 0.095)), 0.08),
        (round_cone((0.315, 0.05, 0.565), (0.265, 0.19, 0.565), 0.045, 0.038), 0.06),
    ]
    if plump > 0.15:
        parts.append((ellipsoid((0.12, 0.0, 0.03), (0.16, 0.15, 0.06 + 0.05 * plump)), 0.12))
    return union(parts)


def face(head: Head) -> Field:
    """The whole head's skin: skull with sockets, lids, nose and lips; the ears are solids of their own."""
    soft, eld = head.soft, head.figure.spec.eld
    ex, ey, ez = head.eye
    solid = carve(skull(head), ellipsoid((ex + 0.16, ey, ez + 0.005), (0.085, 0.125, 0.072)), 0.07)
    lids = ellipsoid((ex, ey, ez), head.eye_radius + 0.014)
    nose = 1.0 - 0.16 * soft + 0.10 * eld
    tip = (0.335 + 0.095 * nose, 0.0, 0.335 + 0.02 * soft)
    bridge = round_cone((0.338, 0.0, 0.515), tip, 0.024, 0.034 * nose)
    wing = ellipsoid((0.352 + 0.022 * nose, 0.046 * nose, 0.318 + 0.015 * soft), (0.042, 0.030 * nose, 0.032))
    m, half = head.mouth_z, head.mouth_half
    upper = round_cone((0.352, 0.0, m + 0.030), (0.300, half * 0.85, m + 0.006), 0.028, 0.014)
    lower = round_cone((0.345, 0.0, m - 0.030), (0.300, half * 0.75, m - 0.010), 0.032, 0.014)
    parts = [(solid, 0.0), (lids, 0.035), (bridge, 0.045), (ellipsoid(tip, 0.044 * nose), 0.03), (wing, 0.02)]
    parts += [(upper, 0.035), (lower, 0.030)]
    whole = union(parts)
    groove = round_cone((0.41, 0.0, m), (0.33, half * 1.02, m + 0.002), 0.012, 0.008)
    nostril = ellipsoid((0.375 + 0.02 * nose, 0.026 * nose, 0.292 + 0.012 * soft), (0.026, 0.013, 0.012))
    whole = carve(carve(whole, groove, 0.02), nostril, 0.012)
    return whole


def ear(head: Head) -> Field:
    """The left ear: an upright shell leaning back, with a bowl."""
    size = 1.0 + 0.10 * head.figure.spec.eld
    shell = ellipsoid(_EAR, (0.066 * size, 0.027, 0.105 * size), _EAR_LEAN)
    lobe = ellipsoid(_EAR + np.array([0.014, -0.014, -0.070]), (0.028, 0.018, 0.030))
    return carve(union([(shell, 0.0), (lobe, 0.03)]), ear_bowl(head), 0.012)


def ear_bowl(head: Head, grow: float = 0.0) -> Field:
    """What is hollow of the left ear. grow: how much wider"""
    return ellipsoid(
        _EAR + np.array([0.018, 0.026, 0.012]), np.array([0.036, 0.020, 0.062]) + grow, _EAR_LEAN
    )


# --- outlines: negative inside -------------------------------------------------------


def eye_lines(head: Head, grow: float = 0.0, lift: float = 0.0) -> list[Field]:
    """The almond of the left eye, seen from the front, as what is inside all of these; ``grow`` widens it,
    ``lift`` raises the upper line."""
    ex, ey, ez = head.eye
    spec = head.figure.spec
    wide = 0.088 + grow
    up = 0.043 + 0.009 * head.soft + 0.006 * spec.youth - 0.014 * spec.eld + grow
    down = 0.038 + 0.006 * spec.youth + grow

    def place(p: Points) -> tuple[Values, Values]:
        a = (np.abs(p[:, 1]) - ey) / wide
        return a, p[:, 2] - ez - 0.010 * a

    def upper(p: Points) -> Values:
        a, b = place(p)
        arch = 1.0 - np.abs(a + 0.12) ** 2.3
        return b - (up + lift * np.clip(0.45 + 0.75 * a, 0.15, 1.0)) * arch

    def lower(p: Points) -> Values:
        a, b = place(p)
        return -b - down * (1.0 - np.abs(a - 0.05) ** 2.2)

    return [upper, lower, lambda p: ex + 0.03 - p[:, 0]]


def eye_region(head: Head) -> Field:
    """A tube that goes back from the front around the left eye."""
    ex, ey, ez = head.eye

    def field(p: Points) -> Values:
        around = np.hypot((np.abs(p[:, 1]) - ey) / 0.125, (p[:, 2] - ez) / 0.10) - 1.0
        return np.maximum(0.1 * around, ex - 0.03 - p[:, 0])

    return field


def lips(head: Head) -> list[Field]:
    """Outline of both lips: what is inside all of these."""
    m, half = head.mouth_z, head.mouth_half
    full = 0.66 + 0.26 * head.fem - 0.25 * head.figure.spec.eld

    def upper(p: Points) -> Values:
        a = np.abs(p[:, 1]) / half
        bow = 0.040 * full * (1.0 - a**1.7) * (1.0 - 0.22 * np.exp(-((a / 0.16) ** 2)))
        return p[:, 2] - m - 0.010 * a**2 - bow

    def lower(p: Points) -> Values:
        a = np.abs(p[:, 1]) / half
        return m + 0.010 * a**2 - p[:, 2] - 0.047 * full * (1.0 - np.minimum(a / 0.92, 1.3) ** 2.2)

    return [upper, lower, lambda p: 0.16 - p[:, 0]]


def mouth(head: Head) -> list[Field]:
    """The slit between the lips, which opens with jaw and upper lip: inside all of these."""
    m, half = head.mouth_z, head.mouth_half

    def edge(sign: float) -> Field:
        def field(p: Points) -> Values:
            a = np.abs(p[:, 1]) / (half * 0.94)
            return sign * (p[:, 2] - m - 0.009 * a**2) - 0.0078 * (1.0 - a**2.4)

        return field

    return [edge(1.0), edge(-1.0), lambda p: 0.16 - p[:, 0]]


def under_jaw(head: Head) -> Field:
    """The shadow a head always has on its neck: from the edge of the jaw down, a bow below the chin that
    rises to the sides."""
    edge = side_line(
        ((0.40, 0.025), (0.29, 0.022), (0.20, 0.045), (0.10, 0.100), (0.02, 0.165), (-0.06, 0.26))
    )

    def field(p: Points) -> Values:
        jaw = edge(np.clip(p[:, 0], -0.06, 0.40))
        bow = -0.20 + 0.30 * (p[:, 1] / 0.20) ** 2
        return np.maximum(np.maximum(p[:, 2] - jaw, bow - p[:, 2]), -0.05 - p[:, 0])

    return field


def under_nose(head: Head) -> list[Field]:
    """The underside of the nose, nostrils among it: what is inside all of these."""
    top = 0.318 + 0.018 * head.soft
    return [
        lambda p: p[:, 2] - top + 0.18 * np.abs(p[:, 1]),
        lambda p: 0.272 - p[:, 2],
        lambda p: 0.347 - p[:, 0],
        lambda p: np.abs(p[:, 1]) - 0.075,
    ]


def nose_region(head: Head) -> Field:
    """A ball around the underside of the nose."""
    return ellipsoid((0.40, 0.0, 0.297), (0.12, 0.12, 0.065 + 0.01 * head.soft))


def jaw_share(head: Head, p: Points) -> Values:
    """How far the skin at points in head units follows the jaw, 0..1."""
    m, half = head.mouth_z, head.mouth_half
    a = np.abs(p[:, 1]) / half
    line = m + 0.010 * np.minimum(a, 1.5) ** 2
    sharp = np.clip(1.0 - (a - 0.75) / 0.5, 0.0, 1.0)
    width = 0.075 - 0.069 * sharp * sharp * (3 - 2 * sharp)
    drop = np.clip((line - p[:, 2]) / width * 0.5 + 0.5, 0.0, 1.0)
    front = np.clip((p[:, 0] + 0.02) / 0.16, 0.0, 1.0)
    under = np.clip((p[:, 2] + 0.10) / 0.10, 0.0, 1.0)
    return drop * drop * (3 - 2 * drop) * front * front * (3 - 2 * front) * under


def corner_share(head: Head, p: Points) -> Values:
    """How far the skin follows the left corner of the mouth, 0..1."""
    d = p - np.array([0.30, head.mouth_half * 0.95, head.mouth_z + 0.012])
    across = np.where((d[:, 2] < -0.012) & (d[:, 1] < 0), 0.036, 0.058)
    high = np.where(d[:, 2] > 0, 0.085, 0.060)
    return 0.90 * np.exp(-((d[:, 0] / 0.12) ** 2) - (d[:, 1] / across) ** 2 - (d[:, 2] / high) ** 2)


def lip_share(head: Head, p: Points) -> Values:
    """How far the skin follows the upper lip, 0..1; the jaw's share is not taken off."""
    m, half = head.mouth_z, head.mouth_half
    across = np.clip(1.0 - (np.abs(p[:, 1]) / (1.1 * half)) ** 4, 0.0, 1.0)
    up = np.clip(1.0 - (p[:, 2] - m - 0.02) / 0.085, 0.0, 1.0)
    return across * up * up * (3 - 2 * up) * np.clip((p[:, 0] - 0.20) / 0.10, 0.0, 1.0)


def lid_shares(head: Head, p: Points) -> tuple[Values, Values]:
    """How far the skin at the edges of the left eye's opening follows the upper and the lower lid."""
    _, ey, ez = head.eye
    a = (p[:, 1] - ey) / 0.094
    across = np.clip(1.0 - a * a, 0.0, 1.0) * np.clip((p[:, 0] - 0.15) / 0.08, 0.0, 1.0)
    b = p[:, 2] - ez
    up = np.clip(1.0 - (b - 0.048) / 0.055, 0.0, 1.0) * np.clip(b / 0.02, 0.0, 1.0)
    down = np.clip(1.0 + (b + 0.042) / 0.075, 0.0, 1.0) * np.clip(-b / 0.02, 0.0, 1.0)
    return 0.72 * across**0.6 * up * up * (3 - 2 * up), 0.75 * across**0.6 * down * down * (3 - 2 * down)


def brow_share(head: Head, p: Points) -> tuple[Values, Values]:
    """Along the left brow: how near its inner end a point is, 1 to 0, and how far skin follows it."""
    _, ey, ez = head.eye
    t = (p[:, 1] - ey + 0.098) / 0.190
    inner = np.clip(1.0 - 1.35 * t, 0.0, 1.0)
    d = p[:, 2] - ez - 0.120
    near = np.exp(-((d / np.where(d > 0, 0.085, 0.045)) ** 2)) * np.clip((1.25 - t) / 0.4, 0.0, 1.0)
    return inner * inner * (3 - 2 * inner), 0.5 * near * np.clip((p[:, 0] - 0.12) / 0.12, 0.0, 1.0)


def brow_line(head: Head, count: int = 9) -> Points:
    """Middle line of the left brow on the front of the skin, inner end first, head units [count, 3]."""
    t = np.linspace(0.0, 1.0, count)
    soft = head.soft
    _, ey, ez = head.eye
    y = ey - 0.098 + 0.190 * t
    z = ez + 0.098 + 0.012 * soft + 0.030 * np.sin(np.pi * np.minimum(t * 1.05, 1.0) ** 1.25) - 0.018 * t
    return on_front(face(head), y, z)


def on_front(shape: Field, y: Values, z: Values) -> Points:
    """The foremost points of a shape at given (y, z), by bisection from the front."""
    low, high = np.full(len(y), 0.0), np.full(len(y), 0.62)
    for _ in range(14):  # to 4e-5, a hundredth of a millimetre
        middle = (low + high) / 2
        inside = shape(np.stack([middle, y, z], 1)) < 0
        low, high = np.where(inside, middle, low), np.where(inside, high, middle)
    return np.stack([low, y, z], 1)


def side_line(points: tuple[tuple[float, float], ...]) -> Callable[[Values], Values]:
    """A curve z(x) through points of falling x, as hairlines are drawn."""
    ordered = sorted(points)
    return monotone([x for x, _ in ordered], [z for _, z in ordered])


def with_neck(head: Head) -> Field:
    """Skin of head and neck in metres, made for the half space Y >= 0."""
    f = head.figure
    low, high = head.metres(np.array([[0.0, 0.0, -0.20], [0.0, 0.0, 1.16]]))
    top = within(head.field(face(head)), (low + high) / 2, 0.85 * head.unit)
    column = neck(f)
    base = union([(torso_loft(f), 0.0), *shoulders(f)])

    def field(p: Points) -> Values:
        throat = smooth_min(column(p), base(p), 0.03 * f.p.height)
        return smooth_min(top(p), throat, 0.016 * f.p.height)

    return field
