"""The channels keys may move, and reading timelines into them.

A channel is ``part.axis`` or, for what there are two of, ``part_HAND.axis`` with HAND one of
:data:`runtime.motion.words.HANDS`. Positive means, in radians unless said otherwise:

body: lean (forward), side (to the left), twist (to the left), bow (from the hips, forward)
head: nod (down), turn (left), tilt (left);  eyes: turn (left), down;  lids: close 0..1
hips: drop, shift (left), forward (metres), turn (left)
arm: weight 0..1 how far the pose replaces the resting one; swing (forward), out (sideways), twist
    (inward), bend (elbow), wrist (towards the palm), side (towards the thumb), turn (palm down/back)
fingers: weight, curl 0..1, point 0..1, thumb 0..1 (stands off);  shoulder: up, forward
brow: up -1..1, knit 0..1;  mouth: smile -1..1;  jaw: open 0..1
foot: forward, out, lift (metres), pitch (heel up);  knees: spread
hand: ahead, out, above (metres): shifts the place the hand reaches to
wield: weight, and how what the hand holds points: pitch (up), inward, roll (its top to the middle), grip
    (between the fingers and the thing: 0 along them, about 1 as a hammer is held)
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from .curves import keyed, plateau, ramp, springy
from .timeline import Timeline

Array = NDArray[np.float64]

CENTRE = {
    "body": ("lean", "side", "twist", "bow"),
    "head": ("nod", "turn", "tilt"),
    "eyes": ("turn", "down"),
    "lids": ("close",),
    "hips": ("drop", "shift", "forward", "turn"),
    "mouth": ("smile",),
    "jaw": ("open",),
    "knees": ("spread",),
}
SIDED = {
    "arm": ("weight", "swing", "out", "twist", "bend", "wrist", "side", "turn"),
    "fingers": ("weight", "curl", "point", "thumb"),
    "shoulder": ("up", "forward"),
    "brow": ("up", "knit"),
    "foot": ("forward", "out", "lift", "pitch"),
    "hand": ("ahead", "out", "above"),
    "wield": ("weight", "pitch", "inward", "roll", "grip"),
}
#: Channels that change sign when an action is mirrored.
LATERAL = frozenset(
    {"body.side", "body.twist", "head.turn", "head.tilt", "eyes.turn", "hips.shift", "hips.turn"}
)
ARM = SIDED["arm"]
#: Parts whose keys are weighted poses.
POSED = ("arm", "fingers", "wield")
_SOFT = {"arm", "body", "head", "shoulder", "hips"}


class Channels:
    """Values of all channels over T frames: additive ones as [T], :data:`POSED` ones as weighted poses."""

    def __init__(self, frames: int) -> None:
        self._zero = np.zeros(frames)
        self._zeros = np.zeros((2, frames))
        self._values: dict[str, Array] = {}

    def __getitem__(self, name: str) -> Array:
        return self._values.get(name, self._zero)

    def pair(self, part: str, axis: str) -> Array:
        """[2, T]: left and right; not to be written to."""
        left, right = self[f"{part}_l.{axis}"], self[f"{part}_r.{axis}"]
        if left is self._zero and right is self._zero:
            return self._zeros
        return np.stack([left, right])

    def add(self, name: str, value: Array) -> None:
        self._values[name] = self._values[name] + value if name in self._values else value

    def put(self, part: str, side: str, pose: dict[str, Array]) -> None:
        """Lays a weighted pose of an arm or hand over what is there."""
        weight = pose["weight"]
        prefix = f"{part}_{side}."
        old = self[prefix + "weight"]
        for axis, value in pose.items():
            if axis != "weight":
                before = self[prefix + axis]
                share = np.where(old + weight > 1e-6, weight / np.maximum(old + weight, 1e-6), 0.0)
                self._values[prefix + axis] = before + (value - before) * np.maximum(share, weight)
        self._values[prefix + "weight"] = np.maximum(old, weight)

    def perform(
        self,
        timeline: Timeline,
        start: float,
        duration: float,
        t: Array,
        fps: float,
        hands: Mapping[str, str],
        until: float = np.inf,
    ) -> None:
        """Adds a clip's keys and beats, played from ``start`` for ``duration`` seconds; gone after
        ``until``."""
        u = (t - start) / max(duration, 1e-6)
        found: dict[str, Array] = {}
        for track in timeline.tracks:
            name = resolve(track.channel, hands)
            found[name] = keyed(track.times, track.values, u)
        for name in list(found):
            part = name.split(".")[0].split("_")[0]
            if part in _SOFT:
                wrist = name.endswith((".wrist", ".side", ".turn"))
                rate = 2.2 if wrist else 3.0
                found[name] = springy(found[name], fps, rate, 0.62, 0.03 if part == "arm" else 0.0)
        for beat in timeline.beats:
            name = resolve(beat.channel, hands)
            length = beat.end - beat.start
            fade = min(0.25 * length, 0.5 * length / max(beat.count, 1e-3))
            envelope = plateau(u, beat.start, beat.start + fade, beat.end - fade, beat.end)
            swing = np.sin(2 * np.pi * (beat.count * (u - beat.start) / max(length, 1e-6) + beat.phase))
            found[name] = found.get(name, self._zero) + beat.amplitude * envelope * swing
        if np.isfinite(until):
            left = 1.0 - ramp(t, until, until + 0.6)
            for name in found:
                if name.split(".")[0].partition("_")[0] not in POSED or name.endswith(".weight"):
                    found[name] = found[name] * left
        self._lay(found)

    def _lay(self, found: dict[str, Array]) -> None:
        poses: dict[tuple[str, str], dict[str, Array]] = {}
        for name, value in found.items():
            head, axis = name.split(".")
            part, _, side = head.partition("_")
            if part in POSED:
                poses.setdefault((part, side), {})[axis] = value
            else:
                self.add(name, value)
        for (part, side), pose in poses.items():
            weight = pose.get("weight")
            if weight is None:  # beats alone: a shiver on top of whatever the arm does
                for axis, value in pose.items():
                    self.add(f"{part}_{side}.{axis}+", value)
            else:
                self.put(part, side, {**pose, "weight": np.clip(weight, 0.0, 1.0)})


#: Arm poses away from which movements are bigger or smaller.
_HANGING = {"swing": 0.1, "out": 0.2, "twist": 0.2, "bend": 0.3}


def enlarged(timeline: Timeline, amount: float) -> Timeline:
    """The timeline with poses of trunk and arms and all beats bigger or smaller by a factor."""
    if amount == 1.0:
        return timeline
    tracks = []
    for track in timeline.tracks:
        head, axis = track.channel.split(".")
        part = head.partition("_")[0]
        rest = _HANGING.get(axis) if part == "arm" else 0.0 if part in ("body", "head", "shoulder") else None
        if rest is not None:
            values = tuple(rest + amount * (v - rest) for v in track.values)
            track = replace(track, values=values)
        tracks.append(track)
    beats = tuple(replace(b, amplitude=amount * b.amplitude) for b in timeline.beats)
    return replace(timeline, tracks=tuple(tracks), beats=beats)


def resolve(channel: str, hands: Mapping[str, str]) -> str:
    """``arm_near.swing`` to ``arm_l.swing``."""
    head, axis = channel.split(".")
    part, _, hand = head.partition("_")
    return f"{part}_{hands.get(hand, hand)}.{axis}" if hand else channel


def known(channel: str) -> bool:
    """Whether a channel exists (hand words left as they are)."""
    head, _, axis = channel.partition(".")
    part, _, hand = head.partition("_")
    return axis in (SIDED.get(part, ()) if hand else CENTRE.get(part, ()))
