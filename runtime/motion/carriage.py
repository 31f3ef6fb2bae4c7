"""How a body is carried over time: low postures mixed, gait styles and manners, and what jumping asks of it.

Assumes a planned :class:`~runtime.motion.route.Route`. Everything is [T] (limbs [2, T]), metres and radians;
all of it is nought for somebody who stands or walks plainly.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .curves import plateau, ramp, smooth, wander
from .feet import Feet
from .hands import MIRROR
from .manner import Manner
from .postures import Row
from .route import Route
from .trail import Flight, Leg, Stance

Array = NDArray[np.float64]


class Low:
    """The mixture of low postures: ``share`` of them against standing, and their numbers, weighted by it.

    tilt: of the trunk, forward; looks: how far down "ahead" is for the eyes (on hands and knees one looks up)
    hip: height of the hip joints in the world; poles: [2, T, 3], where knees point, in the world
    palms: share of postures with planted palms, and how high; knees: share with hands resting on the knees
    balance: how far the trunk leans forward on top between standing and the floor
    """

    def __init__(self, route: Route, t: Array, yaw: Array) -> None:
        names, weights = _mix(route.stances, t)
        rows: list[Row | None] = [None if n == "standing" else route.row(n) for n in names]
        zero = np.zeros(len(t))

        def mixed(value: str) -> Array:
            parts = (w * getattr(r, value) for r, w in zip(rows, weights, strict=True) if r is not None)
            return np.asarray(sum(parts, zero))

        self.share = np.asarray(sum((w for r, w in zip(rows, weights, strict=True) if r is not None), zero))
        self.any = bool(self.share.max() > 0)
        self.pitch, self.lean, self.nod, self.swing = (mixed(v) for v in ("pitch", "lean", "nod", "swing"))
        self.tilt = self.pitch + self.lean
        self.looks = np.where(self.tilt < 0.0, self.tilt, 0.25 * self.tilt)
        self.balance = _balance(route.stances, t)
        beds = [s.ground for s in route.stances]
        bed = beds[-1] if beds else 0.0
        self.hip = mixed("hip") + self.share * bed
        self.palms, self.palms_up, self.knees = zero.copy(), zero.copy(), zero.copy()
        self.poles = np.zeros((2, len(t), 3))
        for r, w in zip(rows, weights, strict=True):
            if r is None:
                continue
            if r.palms is not None:
                self.palms = self.palms + w
                self.palms_up = np.maximum(self.palms_up, bed + r.palms[2])
            self.knees = self.knees + w * (r.on == "knee")
            for k, (ahead, out, up) in enumerate(r.poles):
                left = out * MIRROR[k]
                c, s = np.cos(yaw), np.sin(yaw)
                self.poles[k] += w[:, None] * np.stack(
                    [ahead * c - left * s, ahead * s + left * c, np.full_like(c, up)], axis=1
                )


def _mix(stances: list[Stance], t: Array) -> tuple[list[str], list[Array]]:
    """Names of postures, and the weight [T] of each; they add up to one."""
    names, weights = ["standing"], [np.ones(len(t))]
    for stance in stances:
        share = ramp(t, stance.start, stance.end)
        weights = [w * (1.0 - share) for w in weights]
        names.append(stance.name)
        weights.append(share)
    return names, weights


def _balance(stances: list[Stance], t: Array) -> Array:
    """How far forward the trunk leans on top [T] while one slowly sits down on the floor or gets up from it:
    over the feet, as long as they carry."""
    out, before = np.zeros(len(t)), "standing"
    for stance in stances:
        takes = stance.end - stance.start
        if {before, stance.name} == {"standing", "floor"} and takes > 1.3:
            first, last = stance.start + 0.05 * takes, stance.end - 0.05 * takes
            middle = 0.5 * (first + last)
            out = out + 0.7 * plateau(t, first, middle - 0.05 * takes, middle + 0.05 * takes, last)
        before = stance.name
    return out


class Style:
    """Gait styles over the stretches walked in them, with the manner and the flights of jumps.

    lean, nod, side, roll, drop, rise: of trunk, head, hips; arms: factor on their swing; bend: of elbows
    up, forward: of the shoulders; fling: forward swing of arms in a jump; loll: of the head (turn, tilt)
    """

    def __init__(
        self, route: Route, manner: Manner, feet: Feet, t: Array, fps: float, rng: np.random.Generator
    ) -> None:
        zero = np.zeros(len(t))
        scale = route.skeleton.height / 1.7
        self.up, self.forward, self.bend = manner.up, manner.forward, manner.bend
        self.lean, self.nod = zero + manner.lean, zero + manner.nod
        self.drop, self.rise, self.side, self.roll = zero + manner.crouch * scale, zero, zero, zero
        self.arms, self.fling = np.ones(len(t)), zero
        self.loll = (zero, zero)
        if manner.sway > 0:
            self.side = self.side + manner.sway * wander(t, rng, 2.8)
            self.roll = self.roll + 0.3 * manner.sway * wander(t, rng, 3.4)
        if manner.loose > 0:
            self.loll = (manner.loose * wander(t, rng, 1.9), manner.loose * wander(t, rng, 2.3))
        for leg in route.legs:
            self._walk(leg, feet, t, fps, scale)
        for flight in route.flights:
            self._fly(flight, t, route.skeleton.height)

    def _walk(self, leg: Leg, feet: Feet, t: Array, fps: float, scale: float) -> None:
        style = leg.style
        on = plateau(t, leg.start - 0.25, leg.start + 0.45, leg.end - 0.5, leg.end + 0.2)
        left = smooth(feet.air[1], 0.04 * fps)  # standing on the left
        right = smooth(feet.air[0], 0.04 * fps)
        self.lean = self.lean + on * style.lean
        self.arms = self.arms * (1.0 + on * (style.arms - 1.0))
        self.roll = self.roll + on * style.sway * (left - right)
        self.side = self.side + on * (0.5 * style.sway * (left - right) + 0.2 * style.limp * left)
        limping = 0.045 * style.limp * left
        self.drop = self.drop + on * scale * (style.crouch + limping + 0.5 * style.bounce)
        self.rise = self.rise + on * scale * style.bounce * (left + right)
        self.nod = self.nod + on * (0.12 * style.limp * left - 0.6 * style.lean)

    def _fly(self, flight: Flight, t: Array, height: float) -> None:
        u = np.clip((t - flight.start) / (flight.end - flight.start), 0.0, 1.0)
        self.rise = self.rise + flight.height * 4.0 * u * (1.0 - u)
        deep = height * min(0.03 + 0.28 * flight.height, 0.13)
        before = plateau(t, flight.start - 0.5, flight.start - 0.16, flight.start - 0.14, flight.start + 0.02)
        after = plateau(t, flight.end - 0.05, flight.end + 0.13, flight.end + 0.16, flight.end + 0.55)
        self.drop = self.drop + deep * (before + after)
        self.lean = self.lean + 2.2 * deep / height * (before + 0.8 * after)
        power = min(flight.height / 0.25, 1.0)
        self.fling = self.fling + power * (-0.7 * before + 0.9 * plateau(
            t, flight.start - 0.12, flight.start + 0.1, flight.end - 0.1, flight.end + 0.3))  # fmt: skip
