"""Where hands have to be: reaches of a plan's windows turned into palm tracks, layer over layer."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from runtime.body.skeleton import JOINT, Skeleton

from .channels import SIDED, Channels
from .curves import plateau, ramp
from .figure import Figure
from .hands import MIRROR, Hands
from .held import Held
from .partner import LIE, partner_place
from .places import body_place
from .rotations import blend, dot, norm, rot_y, rot_z, rot_zyx, turned, wrap
from .timeline import Reach

Array = NDArray[np.float64]
SIDE = {"l": 0, "r": 1}
#: Places on one's own body: joint, and how the palm lies there: fingers inward, fingers up, thumb over.
_LIE: dict[str, tuple[float, float, float]] = {
    "mouth": (1.05, 0.75, 0.0), "ear": (0.2, 1.5, 0.0), "chin": (0.75, 0.95, 0.2), "chest": (1.2, 0.15, 0.0),
    "hip": (1.0, -0.45, 0.5), "head": (0.8, 1.1, 0.9), "heart": (1.3, 0.2, 0.0), "belly": (1.3, 0.0, 0.0),
    "eyes": (1.1, 0.8, 0.0), "elbow": (1.4, 0.1, 0.2), "lap": (0.35, -0.15, 1.35), "front": (0.25, 0.0, 0.0),
    "floor": (0.25, -0.6, 0.0), "held": (0.5, 0.0, 0.0),
    "cheek": (0.55, 1.15, 0.15), "forehead": (1.1, 0.6, 0.3), "neck": (1.5, 0.5, 2.7),
    "shoulder": (1.35, 0.55, 0.5), "back": (1.35, -0.35, 0.0), "knee": (0.3, -0.5, 1.2),
    "thigh": (0.3, -0.7, 0.9),
}  # fmt: skip
#: What is added to that while the hand is empty: flat over the mouth, which a cup would be tipped into.
_EMPTY: dict[str, tuple[float, float, float]] = {"mouth": (0.4, -0.35, 0.0)}
#: Radians an elbow is bent by that holds a cup before one.
CARRYING = 1.42
_PALM = {"side": 0.0, "down": 1.45, "up": -1.3}
#: A palm held flat against what is before one, fingers up.
_FLAT = (-1.3, 1.2, 0.0)


@dataclass(frozen=True, eq=False)
class Layer:
    """A hand's wish: weight [T]; the place is a point [T, 3] or a body place; angles as in ``Hands.facing``.

    led: the thing of which a part, not the palm, is to be there: its ``rim``, ``spout``, ``foot`` or
        ``point``; with the place ``held``: the thing in the other hand
    shake: metres up [T]; other: whose body the place is on, and whether the two face each other
    """

    hand: int
    weight: Array
    place: Array | str
    offset: Array
    angles: tuple[float, float, float]
    led: tuple[Held, str] | None = None
    shake: Array | None = None
    other: tuple[Figure, bool] | None = None

    @property
    def place_of(self) -> str:
        """The word of the place, empty for a point in the world."""
        return self.place if isinstance(self.place, str) else ""


@dataclass(frozen=True, eq=False)
class Wield:
    """How held things point, and where hands are shifted to. All [2, T], shift [2, T, 3]: ahead, left, up."""

    weight: Array
    pitch: Array
    inward: Array
    roll: Array
    grip: Array
    shift: Array

    @staticmethod
    def of(channels: Channels) -> Wield:
        """As keys have it."""
        ahead, out, above = (
            channels.pair("hand", axis) + channels.pair("hand", axis + "+") for axis in SIDED["hand"]
        )
        weight, pitch, inward, roll, grip = (
            channels.pair("wield", axis) + channels.pair("wield", axis + "+") for axis in SIDED["wield"]
        )
        shift = np.stack([ahead, MIRROR * out, above], axis=-1)
        return Wield(weight, pitch, inward, roll, grip, shift)


class HandTracks:
    """All layers of one person, composed. Arrays are [2, T], left first.

    weight: how far the palm is drawn to its place, pull: to one the body leans for, close [T]: to one on
    somebody else's body; around: the arm goes around them
    turning: how far its orientation is; inward, pitch, tilt: that orientation
    carry: a thing is in the hand; grip: fingers closed
    bend: radians, of an elbow that carries; hang: how far its arm hangs, 0 (hand before one) to 1
    """

    def __init__(
        self,
        t: Array,
        yaw: Array,
        carry: Array,
        tilt: tuple[Array, Array],
        layers: list[Layer],
        skeleton: Skeleton,
        wield: Wield,
        bend: Array,
    ) -> None:
        shape = carry.shape
        self.bend, self.hang = bend, carry * (1.0 - bend / CARRYING)
        self.t, self.yaw, self.carry, self.layers, self.skeleton = t, yaw, carry, layers, skeleton
        self.wield = wield
        self.weight, self.pull = np.zeros(shape), np.zeros(shape)
        self.turning = carry.copy()
        self.inward = 0.55 - 0.45 * self.hang
        self.pitch = np.zeros(shape)
        roll = np.zeros(shape)
        self.grip = carry
        for layer in layers:
            k, w = layer.hand, layer.weight
            self.weight[k] = w + self.weight[k] * (1 - w)
            # places on the own body go with it: leaning would only chase them
            draws = layer.place_of in ("", "floor") or layer.other is not None
            self.pull[k] = w * draws + self.pull[k] * (1 - w)
            total = w + self.turning[k] * (1 - w)
            share = w / np.maximum(total, 1e-6)
            empty = _EMPTY.get(layer.place_of, (0.0, 0.0, 0.0))
            for track, angle, more in zip((self.inward, self.pitch, roll), layer.angles, empty, strict=True):
                track[k] += share * (angle + more * (1 - carry[k]) - track[k])
            self.turning[k] = total
        along, loose = np.zeros(shape), np.zeros(shape)
        for layer in layers:
            if isinstance(layer.place, str) and layer.place in ("ear", "mouth"):
                track = along if layer.place == "ear" else loose
                track[layer.hand] = np.maximum(track[layer.hand], layer.weight)
        lifted = self.pitch * carry * along  # a telephone goes with the hand, a cup stays upright in it
        self.pitch *= 1 - carry * (1 - np.maximum(along, loose))
        self.tilt = roll * (1 - carry) + tilt[0]
        self.lifted = lifted - tilt[1]  # how far what is held points up
        self.pitch = self.pitch - tilt[1] - 1.35 * self.hang * (1 - self.weight)  # fingers down
        self.reaching = bool(self.pull.any())
        others = [x.weight for x in layers if x.other is not None]
        self.close = np.max(others, axis=0) if others else np.zeros(len(t))
        self.around = np.zeros(shape)
        for layer in layers:
            if layer.place_of in ("partner.back", "partner.waist"):
                self.around[layer.hand] = np.maximum(self.around[layer.hand], layer.weight)

    @property
    def one_goes_with_the_other(self) -> bool:
        """Whether a hand goes to what the other holds while that is where its arm's angles have it."""
        held = (x for x in self.layers if x.place_of == "held" and x.led is not None)
        return any(bool((x.weight * (1 - self.weight[1 - x.hand]) > 1e-3).any()) for x in held)

    def position(self, figure: Figure, palms: Array | None = None) -> Array:
        """Palms' places [2, T, 3] for the torso as it is posed now.

        palms: [2, T, 3], where they come to be, if that is known: from there the other hand goes to what is
        held, else from where the one that holds is drawn to
        """
        out = figure.shoulders()
        total = np.zeros(self.weight.shape)
        cos, sin = np.cos(self.yaw), np.sin(self.yaw)
        shift = turned(rot_z(self.yaw)[None], self.wield.shift)
        for layer in sorted(self.layers, key=lambda x: x.place_of == "held"):
            k, w = layer.hand, layer.weight
            if layer.place_of == "held" and layer.led is not None:
                along = self._on_held(1 - k, layer.led[0], layer.offset)
                at = _slid((out if palms is None else palms)[1 - k], along, figure, k)
            else:
                at = _layer_place(layer, figure, self.yaw)
                ahead, outward, up = layer.offset
                left = outward * (1.0 - 2.0 * k)
                at = at + np.stack(
                    [ahead * cos - left * sin, ahead * sin + left * cos, np.full_like(cos, up)], axis=1
                )
                if layer.led is not None:
                    at = at - self._to_part(k, *layer.led)
            at = at + shift[k]
            if layer.shake is not None:
                at = at + layer.shake[:, None] * np.array([0.0, 0.0, 1.0])
            if layer.place_of not in ("", "floor", "held"):
                at = _at_arms_length(at, figure, k)
            over = w + total[k] * (1 - w)
            share = w / np.maximum(over, 1e-6)
            out[k] += share[:, None] * (at - out[k])
            total[k] = over
        return out

    def rotation(self, hands: Hands) -> Array:
        """Hands' rotations [2, T, 3, 3] as wished."""
        natural = hands.facing(self.yaw, self.inward, self.pitch, self.tilt)
        share = self.wield.weight
        if not share.any():
            return natural
        gripping = self._wielded() @ rot_y(self.wield.grip)
        return blend(natural, hands.turned_by(gripping), share)

    def _wielded(self) -> Array:
        """[2, T, 3, 3]: the frames, ahead along X, of what is wielded."""
        w = self.wield
        return np.asarray(rot_zyx(self.yaw[None] - MIRROR * w.inward, -w.pitch, MIRROR * w.roll))

    def _on_held(self, k: int, held: Held, offset: Array) -> Array:
        """[T, 3]: from the palm ``k`` to a place on what it holds: ahead along it, out, and above."""
        ahead, out, up = offset
        inside = held.ahead.T @ np.array([ahead, out * (2.0 * k - 1.0), up])
        return np.asarray(self.held_rotation(k, held) @ inside)

    def hand_yaw(self, k: int) -> Array:
        """Heading of a hand's fingers [T]."""
        return self.yaw - (1.0 - 2.0 * k) * self.inward[k]

    def _up(self, k: int) -> Array:
        """[T, 3, 3]: how a held thing stands."""
        m = 1.0 - 2.0 * k
        return rot_zyx(self.hand_yaw(k), -self.lifted[k], m * self.tilt[k])

    def _to_part(self, k: int, held: Held, part: str) -> Array:
        """[T, 3]: from the palm to a part of what is held; upright a spout comes in above its place."""
        turned = self.held_rotation(k, held)
        if part == "foot":
            return np.asarray(turned @ -held.grip)
        if part == "point":
            return np.asarray(turned @ held.point)
        if part == "rim":
            return np.asarray(turned @ held.rim)
        to = turned @ held.spout
        to[:, 2] -= (held.spout[2] + held.grip[2]) * np.maximum(turned[:, 2, 2], 0.0)
        return np.asarray(to)

    def held_rotation(self, k: int, held: Held) -> Array:
        """[T, 3, 3]: a thing's rotation if the hand obeys. What has a handle turns in the hand until it
        stands before the fingers."""
        since = int(np.clip(np.searchsorted(self.t, held.since), 0, len(self.t) - 1))
        yaw = float(self.hand_yaw(k)[since])
        turn = float(wrap(yaw - held.axis_yaw)) if held.handle or held.hangs else 0.0
        if held.hangs and abs(turn) > np.pi / 2:
            turn = float(wrap(turn + np.pi))  # either end of its handle may be ahead
        share = ramp(self.t, held.since, held.since + 0.6)
        natural = np.asarray(self._up(k) @ rot_z(turn * share - yaw) @ held.rotation)
        weight = self.wield.weight[k]
        return blend(natural, self._wielded()[k] @ held.ahead, weight) if weight.any() else natural


def _layer_place(layer: Layer, figure: Figure, yaw: Array) -> Array:
    """[T, 3]: a layer's place, before it is shifted."""
    if not isinstance(layer.place, str):
        return layer.place
    if layer.other is not None:
        return partner_place(layer.other[0], layer.place.partition(".")[2], layer.hand, layer.other[1])
    return body_place(figure, layer.place, layer.hand, yaw)


@dataclass(frozen=True, eq=False)
class Contacts:
    """What :meth:`Performer.arms` needs of contacts."""

    tracks: HandTracks


def _slid(grip: Array, along: Array, figure: Figure, k: int) -> Array:
    """The place ``along`` [T, 3] from the other hand's ``grip`` [T, 3] on what that holds; where the arm is
    too short for it, the farthest along that it is long enough for, or else the nearest."""
    limit = 0.93 * figure.arm_length
    off = grip - figure.shoulders()[k]
    a, b = dot(along, along), dot(off, along)
    room = np.maximum(b * b - a * (dot(off, off) - limit**2), 0.0)
    share = np.clip((np.sqrt(room) - b) / np.maximum(a, 1e-9), 0.0, 1.0)
    return np.asarray(grip + share[:, None] * along)


def _at_arms_length(at: Array, figure: Figure, k: int) -> Array:
    """A place [T, 3], drawn in to where the arm ends: the body cannot lean for what goes along with it."""
    shoulder = figure.shoulders()[k]
    way = at - shoulder
    far = norm(way)
    return np.asarray(
        shoulder + way * np.minimum(1.0, 0.97 * figure.arm_length / np.maximum(far, 1e-6))[:, None]
    )


def reach_layer(
    reach: Reach,
    hand: int,
    window: tuple[float, float],
    t: Array,
    place: Array | str,
    start: tuple[Array, float, Skeleton],
    led: tuple[Held, str] | None,
    extra: Array,
    fingers: float | None = None,
    other: tuple[Figure, bool] | None = None,
) -> Layer:
    """A reach as a layer.

    window: start and duration in seconds; start: (root xy, heading, skeleton) on arrival
    fingers: heading of the fingers that suits a handle, taken where a hand can do it
    other: whose body the place is on, if it is somebody else's
    """
    begin, duration = window
    times = [begin + x * duration for x in (reach.start, reach.arrive, reach.leave, reach.end)]
    stays = reach.end >= 1.0 and reach.leave >= 1.0
    weight = ramp(t, times[0], times[1]) if stays else plateau(t, *times)
    tilt = _PALM.get(reach.palm, 0.0)
    if isinstance(place, str):
        inward, pitch, over = LIE[place.partition(".")[2]] if other is not None else _LIE[place]
        angles = (inward, pitch, over + tilt)
    else:
        xy, heading, skeleton = start
        m = 1.0 - 2.0 * hand
        there = int(np.clip(np.searchsorted(t, times[1]), 0, len(t) - 1))
        place = within_reach(place, xy, heading, skeleton, there)
        shoulder = skeleton.bind[JOINT["upperarm_l"]]
        at = place[there]
        side = xy + m * shoulder[1] * np.array([-np.sin(heading), np.cos(heading)])
        bearing = float(wrap(np.arctan2(at[1] - side[1], at[0] - side[0]) - heading))
        if fingers is not None and -0.7 < -m * wrap(fingers - heading) < 1.3:
            bearing = float(wrap(fingers - heading))
        low = np.clip((0.62 * shoulder[2] - at[2]) / 0.6, 0.0, 1.0)
        angles = (float(np.clip(-m * bearing, -0.7, 1.3)), -0.9 * float(low), tilt)
    if reach.palm == "ahead":
        angles = _FLAT
    shake = None
    if reach.shake:
        u = np.clip((t - times[1]) / max(times[2] - times[1], 1e-6), 0.0, 1.0)
        shake = reach.shake * np.sin(2.0 * np.pi * reach.times * u)
    return Layer(hand, weight, place, np.array(reach.offset) + extra, angles, led, shake, other)


def within_reach(place: Array, xy: Array, heading: float, skeleton: Skeleton, there: int) -> Array:
    """The place [T, 3], or where it is out of reach in frame ``there``, what one would reach to instead."""
    at = place[there, :2] - xy
    distance, bearing = float(np.hypot(*at)), float(wrap(np.arctan2(at[1], at[0]) - heading))
    far = min(distance, 0.72 * skeleton.height)
    turn = float(np.clip(bearing, -1.75, 1.75))
    if distance - far < 1e-6 and abs(bearing - turn) < 1e-6:
        return place
    angle = heading + turn
    shift = xy + far * np.array([np.cos(angle), np.sin(angle)]) - place[there, :2]
    return place + np.array([shift[0], shift[1], 0.0])


def holding_weight(t: Array, spans: list[tuple[float, float]]) -> Array:
    """[T]: 1 while something is in the hand; spans are (taken, let go) in seconds."""
    out = np.zeros(len(t))
    for taken, gone in spans:
        out = np.maximum(out, ramp(t, taken - 0.12, taken + 0.4) * (1.0 - ramp(t, gone - 0.06, gone + 0.4)))
    return out
