"""Why a camera is not offered."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from runtime.world import Solids

from ..cinema.angles import lens_height, shows
from ..cinema.bodies import limbs
from ..cinema.measures import Measured
from ..cinema.moves import FLOOR_CLEARANCE, families
from ..cinema.space import Nearby, Stage, clearance, to_people
from ..cinema.subject import Subject
from ..cinema.vectors import dot, length
from .candidates import Shooting

#: In the order they are asked; a candidate is counted under the first that holds.
REASONS = (
    "below_floor",
    "in_wall",
    "in_object",
    "in_person",
    "through_ceiling",
    "too_far_outside",
    "subject_out_of_frame",
    "subject_hidden",
    "wrong_view",
    "wrong_movement",
    "wrong_size",
    "wrong_angle",
    "too_fast",
    "missing_backdrop",
)
#: What may be let pass where hardly anything else is left: the take does what its line says, only less well.
SOFT = tuple(
    REASONS.index(r)
    for r in (
        "subject_hidden",
        "subject_out_of_frame",
        "too_fast",
        "missing_backdrop",
    )
)
#: The same by a reason's number, the last of -1: for all that may be offered.
OFFERED = np.array([*(number in SOFT for number in range(len(REASONS))), True])

_IN_WALL = 0.06  # metres to a wall's box, drawn or not
_NEAR_WALL = 0.2  # metres to a wall that is drawn
_NEAR_OBJECT = 0.3
_NEAR_PERSON = 0.12  # to a pillar 0.22 m thick
_NEAR_FACE = 0.22
_NEAR_BODY = 0.04  # to trunk, head or arms of whom it films
_OUTSIDE = 3.0
_ABOVE = 1.6  # metres over a ceiling
#: Movements that change the size, and those that keep it and the subject all the time.
_RESIZE = {"push", "pull", "zoom", "tilt", "pan", "whip-pan"}
_KEEP = {"follow", "arc", "crane", "dolly-zoom", "handheld", "roll"}
#: What comes nearer or goes back straight, and what leaves it so.
_STRAIGHT, _BESIDES = {"push", "pull", "dolly-zoom"}, {"roll", "static"}
_FASTEST, _TURNS = 5.0, 130.0  # metres and degrees a second
_GROUND = 0.45  # metres over the floor of a lens that lies on the ground


def no_room(
    shooting: Shooting, near: Nearby, solids: Solids, stage: Stage, at: NDArray[np.int64]
) -> NDArray[np.int64]:
    """What can be said before anything is looked at: index into :data:`REASONS` [P], −1 to go on.

    near: the boxes near the cameras at the frames ``at``
    """
    camera = shooting.track.position[:, at]
    none = np.zeros((len(camera), 0), bool)
    room = clearance(solids, near, none)
    ceiling = stage.ceiling if stage.ceiling is not None else np.inf
    return _first(
        {
            "below_floor": camera[..., 2].min(axis=1) < shooting.floor + FLOOR_CLEARANCE - 1e-6,
            "in_wall": room.wall < _IN_WALL,
            "in_object": room.object < _NEAR_OBJECT * _arm(shooting),
            "through_ceiling": _through(camera[..., 2], ceiling),
            "too_far_outside": stage.outside(camera) > _OUTSIDE,
        },
        len(camera),
    )


def _through(height: NDArray[np.float64], ceiling: float) -> NDArray[np.bool_]:
    """[P]: the camera is in the ceiling, passes it, or is far above it. Seen from above it is not drawn."""
    low, high = height.min(axis=1), height.max(axis=1)
    return np.asarray((high > ceiling - 0.1) & ((low < ceiling + 0.05) | (high > ceiling + _ABOVE)))


def _arm(shooting: Shooting) -> float:
    """The paper's close-ups stand within arm's reach; eyes come as near to things as heads do."""
    return 0.5 if shooting.rig == "paper" or shooting.view == "pov" else 1.0


def _first(asked: dict[str, NDArray[np.bool_]], count: int) -> NDArray[np.int64]:
    out = np.full(count, -1)
    for reason in reversed(REASONS):
        if reason in asked:
            out[asked[reason]] = REASONS.index(reason)
    return out


def reasons(shooting: Shooting, measured: Measured, subject: Subject) -> NDArray[np.int64]:
    """Index into :data:`REASONS` of every candidate that has room [P], −1 for those to keep."""
    v, track = measured.values, shooting.track
    paper = shooting.rig == "paper"
    own = length(track.position - subject.landmarks["eyes"][None]).min(axis=1)
    moving = np.array([bool(families(m) & _RESIZE) for m in shooting.movements])
    whips = np.array(["whip-pan" in families(m) for m in shooting.movements])
    moving |= shooting.view == "pov"  # its owner goes nearer, or farther
    slides = np.array([bool(families(m) & {"dolly", "pedestal"}) for m in shooting.movements])
    keeps = np.array([families(m) <= _KEEP for m in shooting.movements])
    drift = np.where(moving, 0.0, v["size_drift"])
    holds = np.where(keeps & (not paper), 0.45, 0.9)
    walked = float(np.linalg.norm(np.diff(subject.position, axis=0), axis=1).sum())
    asked = {
        "in_wall": measured.shown < _NEAR_WALL * _arm(shooting),
        "in_person": (measured.people < _NEAR_PERSON) | ((own < _NEAR_FACE) & (subject.kind == "person")),
        "subject_out_of_frame": v["in_frame"] < np.where(keeps, 0.85, 0.5 if walked > 0.5 else 0.7),
        "subject_hidden": (v["visibility"] < 0.6)
        | (v["ends_visible"] < 0.4)
        | (v["head_visible"] < 0.5)
        | (v["foreground"] > 0.5),
        "wrong_view": v["view"] < 0.7,
        "wrong_movement": _does_not_move(shooting, v),
        "wrong_size": (v["size_error"] > np.where(slides & (not paper), 0.1, 0.6 if paper else 0.19))
        | (drift > holds),
        "wrong_angle": _wrong_angle(shooting, v, subject),
        "too_fast": (v["speed"] > _FASTEST) | ((v["angular_speed"] > _TURNS) & ~whips),
        "missing_backdrop": v["backdrop_gap"] > 0.12,
    }
    out = _first(asked, len(shooting.movements))
    left = np.flatnonzero(OFFERED[out])  # it takes longer: asked of those that may be offered
    bodies = [limb for one in subject.own for limb in limbs(one)]
    out[left[to_people(track.position[left], bodies) < _NEAR_BODY]] = REASONS.index("in_person")
    return out


def _does_not_move(shooting: Shooting, v: Mapping[str, NDArray[np.float64]]) -> NDArray[np.bool_]:
    """Pedestals and cranes that floor or zenith leave hardly any way; pushes and pulls that are not seen, or
    that the floor bends; pairs whose parts undo each other."""
    if shooting.rig == "paper":
        return np.zeros(len(shooting.movements), bool)
    track = shooting.track
    kinds = [families(m) for m in shooting.movements]
    pedestals, cranes = (np.array([kind in each for each in kinds]) for kind in ("pedestal", "crane"))
    nears = np.array([bool({"push", "pull"} & each) for each in kinds])
    risen = np.abs(track.position[:, -1, 2] - track.position[:, 0, 2])
    away = length(track.position - track.look_at)
    nearer = np.abs(away[:, -1] - away[:, 0])
    straight = np.array([bool(each & _STRAIGHT) and each <= _STRAIGHT | _BESIDES for each in kinds])
    arm = (track.position - track.look_at) / away[..., None]
    bent = np.arccos(np.clip(dot(arm[:, 0], arm[:, -1]), -1.0, 1.0))
    pairs = np.array([len(each) > 1 for each in kinds])
    grazes = track.position[..., 2].min(axis=1) < shooting.floor + FLOOR_CLEARANCE + 1e-6
    view = away.max(axis=1) * track.sensor[1] / track.focal.min(axis=1)
    turned = np.ptp(track.rotation[..., 1], axis=1)
    return np.asarray(
        (pedestals & (risen < np.maximum(0.1, 0.27 * view)))
        | (cranes & (turned < np.radians(10.0)))
        | (straight & (bent > np.radians(3.0)))
        | (nears & pairs & grazes & (np.ptp(track.position[..., 2], axis=1) > 0.03 * away[:, 0]))
        | (pedestals & nears & (grazes | (v["elevation"] > 60.0)))  # from above they are the same
        | (nears & (nearer < np.maximum(0.025, 0.04 * away[:, 0])))
    )


def _wrong_angle(
    shooting: Shooting, values: Mapping[str, NDArray[np.float64]], subject: Subject
) -> NDArray[np.bool_]:
    """Whether the key frame's angle is not the asked one; raised cameras may look up less."""
    out = np.zeros(len(shooting.angles), bool)
    if shooting.rig == "paper":
        return out
    asked = np.array(shooting.angles)
    elevation, height = np.radians(values["elevation"]), values["height"]
    lies = (height < _GROUND) & (elevation < -np.radians(1.0))
    for angle in set(shooting.angles):
        level = lens_height(angle, subject.landmarks, subject.floor, subject.kind)
        if level is not None:
            level = np.broadcast_to(level, subject.frames)[shooting.key] - subject.floor
        shown = shows(angle, elevation, height, level)
        if angle in ("low-angle", "worms-eye"):
            shown |= lies
        out |= (asked == angle) & ~shown
    return out
