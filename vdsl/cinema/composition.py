"""How what is filmed lies in the frame: size, headroom, lead room, thirds, and whether heads are whole.

One number a take, over the part of its time in which the subject is meant to be there: the window.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .framing import Array, stretch
from .sizes import CORE, PAPER_RADIUS
from .subject import Subject
from .takes import Bools, Picture, Takes, key_sample, mean_of, within
from .vectors import length

_NEARLY = 0.9  # share of a head in the frame that is as good as all of it
_UPRIGHT = 0.65  # share of what the size asks for that one who is seen upright fills at least
_BROAD = 0.27  # half of somebody's breadth with the arms and a little air, metres


def framing(
    takes: Takes, subject: Subject, at: NDArray[np.int64], picture: Picture
) -> tuple[dict[str, Array], Bools]:
    """Measures of where the landmarks are in the picture, and which are inside it [P, F, K]."""
    xy, window = picture.xy, takes.window
    inside = within(xy, picture.depth, 0.0)
    rows = np.arange(len(xy))
    upper = np.array([picture.names.index(s.upper) for s in takes.sizes])
    lower = np.array([picture.names.index(s.lower) for s in takes.sizes])
    top = np.array([s.top for s in takes.sizes])
    eyes = picture.of("eyes")
    core = np.array([picture.names.index(CORE[s.name]) for s in takes.sizes])
    heads = inside[:, :, picture.names.index("eyes")]
    both = heads & inside[rows, :, core]
    key = key_sample(takes, at)
    depth = np.maximum(picture.depth[:, :, picture.names.index("pocket")], 0.01)
    view = depth * takes.track.sensor[1] / takes.track.focal[:, at]
    drift = np.abs(np.log(view / view[rows, key][:, None]))
    error = np.zeros(len(xy))
    if takes.paper:
        asked = np.array([PAPER_RADIUS[s.name] for s in takes.sizes]) * subject.height
        error = np.abs(np.log(view[rows, key] / asked))
    crown, sole = xy[rows, :, upper, 1], xy[rows, :, lower, 1]
    whole = np.array([s.lower == "feet" for s in takes.sizes])
    share = np.array([s.share for s in takes.sizes])
    # seen from straight above, or lying: there is no line to be on, and the middle is where it belongs
    flat = ((sole - crown)[rows, key] < _UPRIGHT * share) & (not takes.paper) & (subject.kind == "person")
    over = np.where(flat[:, None], np.abs((crown + sole) / 2 - 0.5), np.abs(crown - top[:, None]))
    beside = np.abs(eyes[..., 1] - 1 / 3)
    beside = np.where(flat[:, None], np.maximum(np.abs(eyes[..., 1] - 0.5) - 1 / 6, 0.0), beside)
    return {
        "in_frame": mean_of(both, window),
        "size_error": error,
        "size_drift": np.where(window, drift, 0.0).max(axis=1),
        "headroom": np.clip(mean_of(crown, window), -1.0, 2.0),
        "headroom_error": np.minimum(mean_of(over, window), 2.0),
        "head_cut": _beyond(-crown, window),
        "head_cropped": broken(takes, subject, picture),
        "feet_cut": np.where(whole, _beyond(sole - 1.0, window), 0.0),
        "thirds_error": np.minimum(mean_of(beside, window), 2.0),
        "lead_room": _lead(takes, subject, at, eyes[..., 0]),
    }, inside


def size_error(
    takes: Takes,
    points: Array,
    names: list[str],
    camera: Array,
    axes: Array,
    key: NDArray[np.int64],
    at: NDArray[np.int64],
) -> Array:
    """|log| of what the size's stretch fills of the frame at the key sample, against its share: [P]."""
    upper, lower = (
        points[key, np.array([names.index(getattr(s, end)) for s in takes.sizes])]
        for end in ("upper", "lower")
    )
    focal = takes.track.focal[np.arange(len(key)), at[key]]
    filled = stretch(upper, lower, camera, axes, focal, takes.track.sensor)
    share = np.array([s.share for s in takes.sizes])
    return np.asarray(np.abs(np.log(np.maximum(filled, 1e-4) / share)))


def _beyond(over: Array, window: Bools) -> Array:
    """The most by which something is over a border of the frame while the window is open: [P, F] -> [P]."""
    return np.clip(np.where(window, over, 0.0).max(axis=1), 0.0, 2.0)


def broken(takes: Takes, subject: Subject, picture: Picture) -> Array:
    """How much a border of the frame cuts the head, or a side of it the body, at the first frame or the last,
    0..1: [P]."""
    return np.maximum(_cropped(takes, picture), _halved(takes, subject, picture))


def _cropped(takes: Takes, picture: Picture) -> Array:
    """0 where all of the head is in the frame or none, at the take's first frame and its last, 1 where half
    of it is; 0 for sizes that cut the head. [P]"""
    high = np.array((takes.track.sensor[0] / takes.track.sensor[1], 1.0))  # of the frame, in its heights
    crown, chin = (picture.of(name)[:, (0, -1)] * high for name in ("crown", "chin"))
    radius = np.maximum(length(crown - chin) / 2, 1e-6)[..., None]
    middle = (crown + chin) / 2
    out = np.clip((radius - middle) / (2 * radius), 0.0, 1.0)
    out = out + np.clip((middle + radius - high) / (2 * radius), 0.0, 1.0)
    inside = np.clip((1.0 - out), 0.0, 1.0).prod(axis=-1)
    inside = np.where(picture.depth[:, (0, -1)].min(axis=-1) > 0.05, np.minimum(inside / _NEARLY, 1.0), 0.0)
    whole = np.array([s.whole_head for s in takes.sizes])
    return np.where(whole, (4.0 * inside * (1.0 - inside)).max(axis=1), 0.0)


def _halved(takes: Takes, subject: Subject, picture: Picture) -> Array:
    """0 where all of somebody's breadth is in the frame or none, at the take's first frame and its last, 1
    where one of the frame's sides halves it; 0 for sizes that cut the head. [P]"""
    if subject.kind != "person":
        return np.zeros(len(picture.xy))
    x, y = np.moveaxis(picture.of("pocket")[:, (0, -1)], -1, 0)
    depth = picture.depth[:, (0, -1), picture.names.index("pocket")]
    focal = takes.track.focal[:, (0, -1)]
    half = _BROAD * focal / (takes.track.sensor[0] * np.maximum(depth, 0.05))
    inside = np.minimum(x + half, 1.0) - np.maximum(x - half, 0.0)
    share = np.where((depth > 0.05) & (y > 0.0) & (y < 1.0), np.clip(inside / (2 * half), 0.0, 1.0), 0.0)
    whole = np.array([s.whole_head for s in takes.sizes])
    return np.where(whole, (4.0 * share * (1.0 - share)).max(axis=1), 0.0)


def _lead(takes: Takes, subject: Subject, at: NDArray[np.int64], x: Array) -> Array:
    yaw = takes.track.rotation[:, at, 2]
    sideways = subject.face[None, at, 0] * np.sin(yaw) - subject.face[None, at, 1] * np.cos(yaw)
    return np.clip(mean_of(sideways * (1.0 - 2.0 * x), takes.window), -1.0, 1.0)
