"""What the geometry knows of a take, as numbers the discriminator can be taught to see.

A clip that is only called good or bad says little; what makes it so, how far the eyes are off the third, how
much of the face is seen, how fast the camera turns, is known of every drawn take. Assumes a measured camera.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite

import numpy as np
from numpy.typing import NDArray

from ..cinema.flaws import flaws_by_measure
from ..cinema.subject import Subject, marks_at
from ..cinema.takes import samples
from ..cinema.track import CameraTrack, project
from ..cinema.vectors import dot
from ..propose.types import CameraProposal
from .designer import appeal, qualities

#: Measures that are heavy-tailed: their square root is taught.
_LONG = ("jerk", "speed", "angular_speed")
#: Measures that are not taught: what is told of them would be hardly more than what
#: is told of the criterion, or they are in none.
_UNTAUGHT = ("gesture_lost",)
#: The least that the designer's criteria are taken for: their logarithms are taught, which add up to appeal.
_WORST = 0.05
#: Points of a subject whose place in the frame is taught; half frames from its middle, no further than this.
_POINTS, _FAR = ("crown", "eyes", "chin", "waist", "feet"), 3.0


def hints_of(cameras: Sequence[CameraProposal]) -> list[dict[str, float]]:
    """Of each its measures, which of them are faults, how good it is by each of the designer's criteria and
    by all of them, and the camera's own motion, by name; names that begin with ``right`` change their sign in
    a mirrored picture.

    Motion is from the first frame to the last: turns in radians, ways as a share of the distance to what is
    aimed at, in the camera's first axes.
    """
    if not cameras:
        return []
    measures = {k: np.array([camera.measures[k] for camera in cameras], float) for k in cameras[0].measures}
    found = {k: v for k, v in measures.items() if k not in _UNTAUGHT}
    found |= {f"fault_{k}": v.astype(float) for k, v in flaws_by_measure(measures).items()}
    good = qualities(measures) | {"all": appeal(measures)}
    found |= {f"good_{k}": np.log(np.maximum(v, _WORST)) for k, v in good.items()}
    found |= {k: np.maximum(found[k], 0.0) ** 0.5 for k in _LONG if k in found}
    out = []
    for k, camera in enumerate(cameras):
        told = {name: float(v[k]) for name, v in found.items()} | _motion(camera.track)
        out.append({name: round(v, 4) for name, v in sorted(told.items()) if isfinite(v)})
    return out


def _motion(track: CameraTrack) -> dict[str, float]:
    """How a camera goes, turns and zooms, and how it looks."""
    distance = np.maximum(np.linalg.norm(track.look_at - track.position, axis=-1), 0.2)
    way = track.axes[0] @ (track.position[-1] - track.position[0]) / distance[0]
    turn = track.rotation[-1] - track.rotation[0]
    turned = (turn + np.pi) % (2 * np.pi) - np.pi
    seen = np.log(track.focal / distance)  # how large what is aimed at appears
    return {
        "right_way": float(way[0]),
        "up_way": float(way[1]),
        "forward_way": float(way[2]),
        "right_roll": float(track.rotation[:, 0].mean()),
        "right_rolling": float(turned[0]),
        "pitch": float(track.rotation[:, 1].mean()),
        "tilting": float(turned[1]),
        "right_panning": float(-turned[2]),
        "zooming": float(np.log(track.focal[-1] / track.focal[0])),
        "growing": float(seen[-1] - seen[0]),
        "nearness": float(seen.mean()),
        "lens": float(np.log(track.focal.mean())),
        "distance": float(np.log(distance.mean())),
        "unsteady": float(np.abs(np.diff(track.rotation, 2, axis=0)).mean() ** 0.5),
    }


def frame_hints_of(
    cameras: Sequence[CameraProposal], subject: Subject, at: NDArray[np.int64]
) -> list[dict[str, list[float]]]:
    """What the geometry knows of some frames ``at`` of takes of one performance, of each by name a number for
    each frame; signs as above.

    Where the subject's points lie (half frames from the middle, to the right and to the top; NaN behind the
    camera), how large it is, how it faces the camera, and how the camera looks.
    """
    tracks = [camera.track for camera in cameras]
    if not tracks:
        return []
    position, rotation, focal, axes = (
        np.stack([of[at] for of in values])
        for values in (
            [track.position for track in tracks],
            [track.rotation for track in tracks],
            [track.focal for track in tracks],
            [track.axes for track in tracks],
        )
    )
    points = marks_at(subject, _POINTS, at)
    xy, depth = project(points, position, axes, focal, tracks[0].sensor)
    place = (2.0 * xy - 1.0) * (1.0, -1.0)
    place = np.where((depth > 0.05)[..., None], np.clip(place, -_FAR, _FAR), np.nan)
    found: dict[str, NDArray[np.float64]] = {}
    for k, name in enumerate(_POINTS):
        found[f"right_{name}"], found[name] = place[..., k, 0], place[..., k, 1]
    away = np.maximum(np.linalg.norm(subject.landmarks["waist"][at] - position, axis=-1), 0.2)
    face = subject.face[at]
    found |= {
        "size": np.log(focal / away),
        "distance": np.log(away),
        "lens": np.log(focal),
        "right_face": dot(face, axes[..., 0, :]),
        "face": -dot(face, axes[..., 2, :]),
        "pitch": rotation[..., 1],
        "right_roll": rotation[..., 0],
        "over": np.clip(position[..., 2] - subject.landmarks["eyes"][at, 2], -_FAR, _FAR),
    }
    told = [(name, values.tolist()) for name, values in sorted(found.items())]
    return [{name: [round(x, 4) for x in values[k]] for name, values in told} for k in range(len(cameras))]


def meant(camera: CameraProposal, at: NDArray[np.int64]) -> list[int]:
    """1 where the subject is meant to be in the picture of the frames ``at``, else 0, as it is at the nearest
    of those that are measured."""
    measured = samples(len(camera.track.position))
    return [int(camera.window[np.abs(measured - frame).argmin()]) for frame in at]
