"""Skin weights as a smooth function of where a point lies in the bind pose.

Layers of cloth over the same spot get the same weights, so nothing underneath comes through when the
body bends. Weights belong to :data:`runtime.body.skeleton.PALETTE`; half joints take the middle of a
bend, which keeps elbows and knees full.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .anatomy import ARM_FRAME, Figure
from .field import Points, Values
from .head import Head, brow_share, corner_share, jaw_share, lid_shares, lip_share
from .skeleton import PALETTE

_COLUMN = {name: i for i, name in enumerate(PALETTE)}
_SWAP = np.array(
    [
        _COLUMN[n[:-2] + {"_l": "_r", "_r": "_l"}[n[-2:]]] if n[-2:] in ("_l", "_r") else _COLUMN[n]
        for n in PALETTE
    ]
)


def ramp(x: Values, low: float, high: float) -> Values:
    """A smooth step from 0 at ``low`` to 1 at ``high``."""
    t = np.clip((x - low) / (high - low), 0.0, 1.0)
    return t * t * (3.0 - 2.0 * t)


def body_weights(
    figure: Figure, points: Points, side_blend: float = 0.02, arms: bool = True, normals: Points | None = None
) -> NDArray[np.float64]:
    """Dense weights [N, len(PALETTE)] anywhere on body and clothes; rows sum to 1.

    normals: of the points; where arm and flank nearly touch they tell which of the two a point is on
    side_blend: half width, as a share of the height, of the change from left to right leg (more for skirts)
    """
    left = points[:, 1] >= 0
    folded = points.copy()
    folded[:, 1] = np.abs(folded[:, 1])
    facing = (
        None if normals is None else np.where(left[:, None], normals, normals * np.array([1.0, -1.0, 1.0]))
    )
    w = _half_weights(figure, folded, side_blend, arms, facing)
    return np.where(left[:, None], w, w[:, _SWAP])


def face_weights(figure: Figure, points: Points) -> NDArray[np.float64]:
    """As :func:`body_weights`, with jaw, lips, corners of the mouth, lids and brows."""
    w = body_weights(figure, points, arms=False)
    head = Head(figure)
    folded = head.units(points)
    left = folded[:, 1] >= 0
    folded[:, 1] = np.abs(folded[:, 1])
    skull = w[:, _COLUMN["head"]].copy()
    corner = corner_share(head, folded)
    jaw = jaw_share(head, folded) * (1 - corner)
    lip = lip_share(head, folded) * (1 - jaw) * (1 - corner)
    upper, lower = lid_shares(head, folded)
    inner, brow = brow_share(head, folded)
    brow = brow * (1 - upper)
    for name, share in (("jaw", jaw), ("lip", lip)):
        w[:, _COLUMN[name]] += share * skull
    middle = np.where(
        left, 0.5 + 0.5 * ramp(folded[:, 1], 0.0, 0.06), 0.5 - 0.5 * ramp(folded[:, 1], 0.0, 0.06)
    )
    sided = (
        ("mouth", corner, left), ("lid", upper, left), ("underlid", lower, left),
        ("brow", brow * (1 - inner), middle), ("browin", brow * inner, middle),
    )  # fmt: skip
    for name, share, on_left in sided:
        w[:, _COLUMN[f"{name}_l"]] += share * skull * on_left
        w[:, _COLUMN[f"{name}_r"]] += share * skull * (1 - on_left)
    w[:, _COLUMN["head"]] -= (jaw + lip + corner + upper + lower + brow) * skull
    return w


def brow_weights(figure: Figure, points: Points) -> NDArray[np.float64]:
    """Weights of a brow's hair along its length, of both sides."""
    folded = Head(figure).units(points)
    side = np.where(folded[:, 1] >= 0, "l", "r")
    folded[:, 1] = np.abs(folded[:, 1])
    inner = brow_share(Head(figure), folded)[0]
    w = np.zeros((len(points), len(PALETTE)))
    for s in "lr":
        w[:, _COLUMN[f"brow_{s}"]] = (1 - inner) * (side == s)
        w[:, _COLUMN[f"browin_{s}"]] = inner * (side == s)
    return w


def mouth_weights(figure: Figure, points: Points) -> NDArray[np.float64]:
    """Weights of what is inside the mouth: its dark back follows the jaw from the lips down, and at its
    sides the lips' corners."""
    head = Head(figure)
    p = head.units(points)
    w = np.zeros((len(points), len(PALETTE)))
    w[:, _COLUMN["jaw"]] = ramp(head.mouth_z + 0.02 - p[:, 2], 0.0, 0.06)
    w[:, _COLUMN["head"]] = 1.0 - w[:, _COLUMN["jaw"]]
    aside = ramp(np.abs(p[:, 1]) / head.mouth_half, 0.5, 1.0)[:, None]
    return w * (1.0 - aside) + face_weights(figure, points) * aside


def beard_weights(figure: Figure, points: Points) -> NDArray[np.float64]:
    """A long beard: with the jaw at the chin, resting on the chest at its end."""
    low = ramp(-Head(figure).units(points)[:, 2], -0.05, 0.50)
    w = np.zeros((len(points), len(PALETTE)))
    for name, high, end in (("jaw", 0.7, 0.0), ("head", 0.3, 0.35), ("neck", 0.0, 0.25), ("chest", 0.0, 0.4)):
        w[:, _COLUMN[name]] = high + (end - high) * low
    return w


def tooth_weights(figure: Figure, points: Points) -> NDArray[np.float64]:
    """Upper teeth: on the skull, a little drawn along by the jaw so that they show when it opens."""
    w = np.zeros((len(points), len(PALETTE)))
    w[:, _COLUMN["head"]], w[:, _COLUMN["jaw"]] = 0.75, 0.25
    return w


def cape_weights(figure: Figure, points: Points) -> NDArray[np.float64]:
    """What hangs from the shoulders down the back: with chest and hips, below with the legs.

    Over a skirt it goes as the skirt does, else with the middle of both legs: so it stays behind whoever
    walks, is sat on by whoever sits and lies on the calves of whoever kneels.
    """
    z, h = points[:, 2], figure.p.height
    high = ramp(z, figure.level(0.55), figure.level(0.95))
    low = ramp(-z, -figure.level(0.45), -figure.level(0.0))
    skirted = figure.spec.top in ("dress", "gown", "robe", "kimono") or "skirt" in figure.spec.bottom
    w = body_weights(figure, points, side_blend=0.042 if skirted else 0.25, arms=False) * low[:, None]
    upper = 1.0 - low
    clavicle = 0.5 * high * ramp(np.abs(points[:, 1]), 0.04 * h, 0.10 * h)
    chest = upper * (0.4 + 0.6 * high)
    w[:, _COLUMN["chest"]] += chest * (1 - clavicle)
    w[:, _COLUMN["spine"]] += upper * 0.6 * (1 - high)
    w[:, _COLUMN["clavicle_l"]] += np.where(points[:, 1] > 0, clavicle, 0.0) * chest
    w[:, _COLUMN["clavicle_r"]] += np.where(points[:, 1] <= 0, clavicle, 0.0) * chest
    return w


def swapped(weights: NDArray[np.float64]) -> NDArray[np.float64]:
    """The weights of the mirror images of points."""
    return weights[:, _SWAP]


def rigid(name: str, count: int) -> NDArray[np.float64]:
    """Weights of points that hang on one joint alone."""
    w = np.zeros((count, len(PALETTE)))
    w[:, _COLUMN[name]] = 1.0
    return w


def strongest(weights: NDArray[np.float64], count: int = 4) -> tuple[NDArray[np.int32], NDArray[np.float32]]:
    """The ``count`` largest weights of each row: indices [N, count] and weights that sum to 1."""
    order = np.argsort(-weights, axis=1, kind="stable")[:, :count]
    top = np.take_along_axis(weights, order, axis=1)
    top = np.where(top < 0.004, 0.0, top)
    top /= top.sum(1, keepdims=True)
    return np.where(top > 0, order, order[:, :1]).astype(np.int32), top.astype(np.float32)


def _half_weights(
    f: Figure, p: Points, side_blend: float, arms: bool, normals: Points | None
) -> NDArray[np.float64]:
    w = np.zeros((len(p), len(PALETTE)))
    torso = _torso(f, p)
    legs = _leg(f, p)
    arm, share = _arm(f, p, normals) if arms else ({}, np.zeros(len(p)))
    h = f.p.height
    on_leg = sum(legs.values()) * (1.0 - share)
    side = 0.5 + 0.5 * ramp(p[:, 1], 0.0, side_blend * h)
    if side_blend < 0.03:  # below the crotch every leg is its own
        side = np.maximum(side, ramp(f.p.hip[1] - p[:, 2], 0.05 * h, 0.10 * h))
    for name, value in torso.items():
        w[:, _COLUMN[name]] += value * (1.0 - on_leg) * (1.0 - share)
    for name, value in legs.items():
        w[:, _COLUMN[f"{name}_l"]] += value * (1.0 - share) * side
        w[:, _COLUMN[f"{name}_r"]] += value * (1.0 - share) * (1.0 - side)
    for name, value in arm.items():
        w[:, _COLUMN[f"{name}_l"]] += value
    return w / w.sum(1, keepdims=True)


def _torso(f: Figure, p: Points) -> dict[str, Values]:
    h, head = f.p.height, f.p.head
    z = p[:, 2]
    spine, chest, neck = (f.joint(n)[2] for n in ("spine", "chest", "neck"))
    a = ramp(z, spine - 0.055 * h, spine + 0.055 * h)
    b = ramp(z, chest - 0.06 * h, chest + 0.06 * h)
    c = ramp(z - 0.25 * np.abs(p[:, 1]), neck - 0.016 * h, neck + 0.030 * h)
    tilt = z - (f.p.chin + 0.06 * head) + 0.9 * (p[:, 0] - f.joint("head")[0])
    d = ramp(tilt, -0.14 * head, 0.10 * head)
    shoulder = f.joint("upperarm_l")
    clavicle = ramp(p[:, 1], 0.25 * shoulder[1], 0.85 * shoulder[1]) * ramp(z, f.level(0.72), f.level(1.0))
    upper = b * (1 - c)
    return {
        "hips": 1 - a,
        "spine": a * (1 - b),
        "chest": a * upper * (1 - clavicle),
        "clavicle_l": a * upper * clavicle,
        "neck": a * b * c * (1 - d),
        "head": a * b * c * d,
    }


def _leg(f: Figure, p: Points) -> dict[str, Values]:
    h, (y, hip), knee, ankle = f.p.height, f.p.hip, f.p.knee, f.p.ankle
    z = p[:, 2]
    s = hip - z + 0.35 * np.clip(p[:, 1] - y, -0.06 * h, 0.06 * h)
    m1, m2 = ramp(s, -0.060 * h, 0.012 * h), ramp(s, -0.010 * h, 0.065 * h)
    k1, k2 = ramp(knee - z, -0.040 * h, 0.004 * h), ramp(knee - z, -0.004 * h, 0.040 * h)
    foot = ramp(ankle - z + 0.25 * p[:, 0], -0.030 * h, 0.004 * h)
    toe_x = f.joint("toe_l")[0]
    toe = ramp(p[:, 0], toe_x - 0.10 * f.p.foot, toe_x + 0.08 * f.p.foot) * foot
    return {
        "half-hip": m1 - m2,
        "thigh": m2 * (1 - k1),
        "half-knee": m2 * (k1 - k2),
        "shin": m2 * k2 * (1 - foot),
        "foot": m2 * k2 * (foot - toe),
        "toe": m2 * k2 * toe,
    }


def _arm(f: Figure, p: Points, normals: Points | None) -> tuple[dict[str, Values], Values]:
    """Shares of the left arm's joints, and their sum."""
    h, a, b, k = f.p.height, f.p.upper_arm, f.p.forearm, f.p.hand
    d = p - f.joint("upperarm_l")
    u, v, w = (d @ ARM_FRAME.T).T
    room = 0.055 * h * ramp(u, 0.6 * a, a + 0.5 * b)  # wide sleeves, where the arm is clear of the trunk
    near = 1.0 - ramp(np.hypot(v, w) - room, 0.064 * h, 0.094 * h)
    if normals is not None:
        towards = normals @ ARM_FRAME[2]
        flank = ramp(towards, -0.20, 0.35) * ramp(-w, 0.002 * h, 0.016 * h) * ramp(u, 0.03 * h, 0.06 * h)
        near = near * (1.0 - flank * (1.0 - ramp(u, 0.85 * a, 1.05 * a)))
    s = 0.978 * d[:, 1] - 0.208 * d[:, 2]
    m1, m2 = ramp(s, -0.022 * h, 0.026 * h) * near, ramp(s, 0.010 * h, 0.066 * h) * near
    e1, e2 = ramp(u, a - 0.036 * h, a + 0.003 * h), ramp(u, a - 0.003 * h, a + 0.036 * h)
    t = ramp(u, a + 0.15 * b, a + 0.90 * b)
    wrist = ramp(u, a + b - 0.018 * h, a + b + 0.014 * h)
    x, y, z = (u - a - b) / k, v / k, w / k
    fingers, tips = ramp(x, 0.43, 0.56), ramp(x, 0.68, 0.77)
    axis = np.array([0.485, 0.275, -0.07])
    q = np.stack([x - 0.10, y - 0.09, z + 0.045], 1)
    along = np.clip(q @ axis / (axis @ axis), 0.0, 1.0)
    off = np.linalg.norm(q - along[:, None] * axis, axis=1)
    thumb = ramp(along, 0.08, 0.42) * (1 - ramp(off, 0.085, 0.13)) * ramp(y + 0.25 * along, 0.16, 0.28)
    index = ramp(y - 0.1035 - 0.05 * np.clip(x - 0.46, 0.0, 0.5), -0.006, 0.006)
    palm = wrist * (1 - thumb)
    return {
        "half-shoulder": m1 - m2,
        "upperarm": m2 * (1 - e1),
        "half-elbow": m2 * (e1 - e2),
        "forearm": m2 * e2 * (1 - t) * (1 - wrist),
        "twist": m2 * e2 * t * (1 - wrist),
        "hand": m2 * e2 * palm * (1 - fingers),
        "fingers": m2 * e2 * palm * (fingers - fingers * tips) * (1 - index),
        "fingertips": m2 * e2 * palm * fingers * tips * (1 - index),
        "index": m2 * e2 * palm * (fingers - fingers * tips) * index,
        "indextip": m2 * e2 * palm * fingers * tips * index,
        "thumb": m2 * e2 * wrist * thumb,
    }, m1
