"""What a camera is about: a person, a thing or a place, as points over time.

Assumes a performance on the shared skeleton. Guarantees the same set of landmarks for every kind of
subject, so that framing and measuring need not ask which it is.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from runtime.body.skeleton import JOINT, Skeleton

from .in_hand import Box

#: Points whose sight makes a subject visible, most telling first.
SIGHT = ("eyes", "chin", "pocket", "waist", "hand_l", "hand_r", "knees")


#: Metres over the floor somebody stands on by which one tells in which storey they are.
_OVER_FLOOR = 0.5
#: Height of what stands for a place, as a share of its diagonal. Up to so many metres a place is looked at
#: for its own sake; from so many on it is where its people are.
_SHARE, _SMALL, _LARGE = 0.36, 3.0, 5.0
#: Of people that far apart, and so many metres around them, what has to be shown is so tall, at most so many
#: metres.
_TALL, _AROUND, _TALLEST = 0.3, 3.0, 8.0


@dataclass(frozen=True, eq=False)
class Subject:
    """A subject over T frames.

    kind: ``person``, ``thing`` or ``place``; height: standing height of a person, metres
    position: float64 [T, 3], point on the floor below it (the paper's p); heading: float64 [T], radians
    landmarks: by name, float64 [T, 3]: top (of a hat or high hair), crown, hairline, brow, eyes, nose, chin,
        collar, pocket, waist, thigh, knees, feet, hand_l, hand_r
    face: float64 [T, 3], unit direction the face points; zero for what has none
    members: everybody a shot of several has to show, who acts first of all; () for a single one
    via: float64 [T, 3], the head over whose shoulder the camera looks, or the eyes it looks through
    via_face: float64 [T, 3], unit direction its face points
    company: of people everybody else who is about, of a place those who are ever in it
    bounds: of a place, its lower and its upper corner
    arms: float64 [T, 2, 3, 3], shoulder, elbow and wrist of the left arm and the right; None without any
    in_hand: what they hold
    """

    name: str
    kind: str
    height: float
    position: NDArray[np.float64]
    heading: NDArray[np.float64]
    landmarks: dict[str, NDArray[np.float64]]
    face: NDArray[np.float64]
    members: tuple[Subject, ...] = ()
    via: NDArray[np.float64] | None = None
    via_face: NDArray[np.float64] | None = None
    arms: NDArray[np.float64] | None = None
    in_hand: tuple[Box, ...] = ()
    company: tuple[Subject, ...] = ()
    bounds: tuple[tuple[float, ...], tuple[float, ...]] | None = None

    @property
    def frames(self) -> int:
        return len(self.position)

    @property
    def heads(self) -> dict[str, NDArray[np.float64]]:
        """Eyes of the members by name, float64 [T, 3] each; {} for a single one."""
        return {one.name: one.landmarks["eyes"] for one in self.members}

    @property
    def own(self) -> tuple[Subject, ...]:
        """The people it is; () for a thing or a place."""
        return self.members or ((self,) if self.kind == "person" else ())

    @property
    def everybody(self) -> tuple[Subject, ...]:
        """These, and who else is about."""
        return (*self.own, *self.company)

    @cached_property
    def floor(self) -> float:
        """Height of the lowest floor it is on."""
        return float(self.position[:, 2].min())

    def shifted(self, up: float) -> Subject:
        """The same so many metres higher."""
        if abs(up) < 1e-12:
            return self
        shift = np.array((0.0, 0.0, up))
        moved = {name: path + shift for name, path in self.landmarks.items()}
        members = tuple(one.shifted(up) for one in self.members)
        company = tuple(one.shifted(up) for one in self.company)
        via = None if self.via is None else self.via + shift
        arms = None if self.arms is None else self.arms + shift
        position = self.position + shift
        return replace(
            self,
            position=position,
            landmarks=moved,
            members=members,
            via=via,
            arms=arms,
            in_hand=tuple(box.shifted(up) for box in self.in_hand),
            company=company,
        )

    def holds(self, one: Subject) -> NDArray[np.bool_]:
        """Of a place, in which frames somebody stands in it, bool [T]."""
        low, high = (np.array(corner) for corner in self.bounds or ((-np.inf,) * 3, (np.inf,) * 3))
        at = one.position + np.array((0.0, 0.0, _OVER_FLOOR))
        return np.asarray(((at > low) & (at < high)).all(axis=1))

    def travel(self) -> float:
        """Metres from where it starts to the farthest it gets from there on the floor."""
        return float(np.linalg.norm(self.position[:, :2] - self.position[0, :2], axis=1).max())


def person(
    name: str,
    skeleton: Skeleton,
    world_from_joint: NDArray[np.floating],
    position: NDArray[np.float64],
    heading: NDArray[np.float64],
) -> Subject:
    """A performed character; landmarks are points of the bind pose carried by their joints."""
    world = np.asarray(world_from_joint)
    bind, h = skeleton.bind, skeleton.height
    eye = bind[JOINT["eye_l"]]
    head = (h - eye[2]) / 0.525  # chin to crown; the eyes lie a little below its middle
    chin = h - head
    skull = bind[JOINT["head"]][0]

    def carried(joint: str, x: float, z: float) -> NDArray[np.float64]:
        j = JOINT[joint]
        local = np.array((x, 0.0, z)) - bind[j]
        local[1] = 0.0
        turn, at = world[:, j, :3, :3].astype(np.float64), world[:, j, :3, 3]
        return np.asarray(turn @ local + at)

    def joints(*names: str) -> NDArray[np.float64]:
        return np.asarray(world[:, [JOINT[n] for n in names]][..., :3, 3].astype(np.float64).mean(axis=1))

    soles = world[:, [JOINT[n] for n in ("foot_l", "foot_r", "toe_l", "toe_r")]][..., :3, 3].astype(
        np.float64
    )
    feet = soles.mean(axis=1)
    feet[:, 2] = np.maximum(soles[:, :, 2].min(axis=1) - bind[JOINT["toe_l"]][2], np.asarray(position)[:, 2])
    landmarks = {
        "top": carried("head", skull, h + skeleton.above),
        "crown": carried("head", skull, h),
        "hairline": carried("head", eye[0], chin + 0.86 * head),
        "brow": carried("head", eye[0], chin + 0.60 * head),
        "eyes": joints("eye_l", "eye_r"),
        "nose": carried("head", eye[0], chin + 0.28 * head),
        "chin": carried("head", eye[0], chin),
        "collar": carried("chest", bind[JOINT["neck"]][0], chin - 0.065 * h),
        "pocket": carried("chest", bind[JOINT["chest"]][0], 0.715 * h),
        "waist": carried("spine", bind[JOINT["spine"]][0], 0.60 * h),
        "thigh": joints("thigh_l", "thigh_r", "shin_l", "shin_r"),
        "knees": joints("shin_l", "shin_r"),
        "feet": feet,
        "hand_l": joints("hand_l"),
        "hand_r": joints("hand_r"),
    }
    face = world[:, JOINT["head"], :3, 0].astype(np.float64)
    limbs = [[JOINT[f"{joint}_{side}"] for joint in ("upperarm", "forearm", "hand")] for side in "lr"]
    arms = world[:, limbs][..., :3, 3].astype(np.float64)
    place = np.asarray(position, float), np.asarray(heading, float)
    return Subject(name, "person", h, *place, landmarks, face, arms=arms)


def group(people: Sequence[Subject]) -> Subject:
    """Several people as one subject: halfway between them, from the highest crown to the lowest feet."""
    first = people[0]
    landmarks = {}
    for name in first.landmarks:
        points = np.stack([one.landmarks[name] for one in people])
        landmarks[name] = points.mean(axis=0)
        if name in ("top", "crown", "feet"):
            end = np.min if name == "feet" else np.max
            landmarks[name][:, 2] = end(points[..., 2], axis=0)
    face = np.mean([one.face for one in people], axis=0)
    face = face / np.maximum(np.linalg.norm(face, axis=1, keepdims=True), 0.5)
    return replace(
        first,
        height=max(one.height for one in people),
        position=np.mean([one.position for one in people], axis=0),
        landmarks=landmarks,
        face=face,
        members=tuple(people),
        arms=None,
        in_hand=(),
    )


def thing(
    name: str,
    low: NDArray[np.float64],
    high: NDArray[np.float64],
    facing: float = 0.0,
    floor: float = 0.0,
) -> Subject:
    """An object by its bounds over time; low, high: float64 [T, 3]; floor: height of that below it."""
    centre, size = (low + high) / 2, high - low
    tall = np.maximum(np.maximum(size[:, 2], np.linalg.norm(size[:, :2], axis=1) / 1.5), 0.12)
    return _box(name, "thing", centre, tall, np.full(len(low), facing), floor)


def place(name: str, low: tuple[float, ...], high: tuple[float, ...], frames: int) -> Subject:
    """A room or area as a whole, by its bounds on the floor plan."""
    span = float(np.hypot(high[0] - low[0], high[1] - low[1]))
    tall = float(np.clip(_SHARE * span, 1.8, _LARGE))
    centre = np.tile(((low[0] + high[0]) / 2, (low[1] + high[1]) / 2, low[2] + 0.9), (frames, 1))
    area = _box(name, "place", centre, np.full(frames, tall), np.zeros(frames), low[2])
    return replace(area, bounds=(low, high))


def peopled(area: Subject, people: Sequence[Subject]) -> Subject:
    """A place as it is shown with people in it: the larger it is, the nearer to them its middle, as nobody
    looks at the middle of a long street for its own sake; and as tall as it takes to have them all in it."""
    if not people:
        return area
    feet = np.array([one.position[:, :2].mean(axis=0) for one in people])
    low, high = feet.min(axis=0), feet.max(axis=0)
    near = float(np.clip((area.height - _SMALL) / (_LARGE - _SMALL), 0.0, 1.0))
    spread = float(np.hypot(*(high - low)))
    tall = max(area.height, near * min(_TALL * (spread + _AROUND), _TALLEST))
    centre = area.landmarks["eyes"].copy()
    centre[:, :2] += near * ((low + high) / 2 - centre[:, :2])
    whole = _box(area.name, area.kind, centre, np.full(area.frames, tall), area.heading, area.floor)
    return replace(whole, bounds=area.bounds)


def _box(
    name: str,
    kind: str,
    centre: NDArray[np.float64],
    tall: NDArray[np.float64],
    heading: NDArray[np.float64],
    floor: float,
) -> Subject:
    """A faceless subject: landmarks spread evenly from ``crown`` to ``feet``."""

    def at(share: float) -> NDArray[np.float64]:
        out = centre.copy()
        out[:, 2] += share * tall
        return out

    share = {"top": 0.5, "crown": 0.5, "hairline": 0.4, "brow": 0.2, "eyes": 0.0, "nose": 0.0, "chin": 0.0}
    share |= {
        "collar": 0.0,
        "pocket": 0.0,
        "waist": 0.0,
        "thigh": -0.1,
        "knees": 0.0,
        "feet": -0.5,
        "hand_l": 0.0,
    }
    share["hand_r"] = 0.0
    position = centre.copy()
    position[:, 2] = floor
    return Subject(
        name,
        kind,
        float(tall[0]),
        position,
        heading,
        {n: at(s) for n, s in share.items()},
        np.zeros_like(centre),
    )


def anchor(subject: Subject, upper: str, lower: str, fps: float) -> NDArray[np.float64]:
    """The path [T, 3] a camera of ``rig cinema`` holds on to: midway between two landmarks, smoothed.

    Steps and breaths (anything faster than about half a second) are taken out, so a camera that keeps
    its distance does not bob; sitting down and walking off stay in.
    """
    middle = (subject.landmarks[upper] + subject.landmarks[lower]) / 2
    sway = (subject.landmarks["eyes"] + subject.landmarks["waist"]) / 2
    path = np.column_stack([sway[:, :2], middle[:, 2]])
    return np.asarray(gaussian_filter1d(path, sigma=max(0.3 * fps, 0.5), axis=0, mode="nearest"))


def marks_at(one: Subject, names: Sequence[str], at: NDArray[np.int64]) -> NDArray[np.float64]:
    """Where some landmarks are in the frames ``at``, [F, K, 3]; not to be written to."""
    return _marks_at(one, tuple(names), tuple(at.tolist()))


@lru_cache(maxsize=512)  # asked for again for every few cameras
def _marks_at(one: Subject, names: tuple[str, ...], frames: tuple[int, ...]) -> NDArray[np.float64]:
    at = np.array(frames)
    found = np.stack([one.landmarks[name][at] for name in names], axis=1)
    found.flags.writeable = False
    return found
