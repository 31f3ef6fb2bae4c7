"""Which movement a take makes, read off its track and its subject's way, whatever was asked for.

Assumes one camera over T frames and the subject it films. Guarantees that nothing drawn for the take is
looked at, nor the point it was aimed at: where the optical axes meet beside the subject is found again. A
track may truly bear more than one name (a dolly along with one who walks is a follow too); all are told.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from .moves import family
from .subject import Subject
from .track import CameraTrack, camera_axes
from .vectors import dot

Array = NDArray[np.float64]

_NEAR_AXIS = np.radians(8.0)  # of the axes that are taken to point at the subject
_TIE = 0.05  # how much an axis' own evidence has to weigh against the subject's middle
#: Between which landmarks the point filmed may lie.
_PARTS = (("eyes", "nose"), ("collar", "collar"), ("pocket", "pocket"), ("eyes", "waist"), ("waist", "waist"),
          ("waist", "knees"))  # fmt: skip
_TRUNK = _PARTS.index(("eyes", "waist"))
_MEETS = np.radians(40.0)  # between axes from which the point is known by itself
_THROUGH, _FLAT = (
    0.015,
    0.4,
)  # how near to it they pass, share of the distance; least length on the floor plan
_STILL, _SHAKEN = 0.02, 0.06  # metres within which a camera stands still, and one held by hand
_TURN, _LEAN = np.radians(10.0), np.radians(5.0)  # least of a pan or tilt, and of a roll
_AFTER = np.radians(3.0)  # within which a camera keeps pointing where it pointed
_ZOOMS, _NEARS = 0.03, 0.035  # least of a change of focal length and of distance, as logarithms
_RISES, _ROUND = np.radians(7.0), np.radians(55.0)  # least of a crane and of an arc
_OVER = np.radians(75.0)  # least of an arc seen from overhead
_ASIDE = 0.07  # least of a dolly, metres for each metre of distance
_UP = 0.25  # least of a pedestal, share of the height of what is seen; less goes with coming nearer
_ASKEW = 0.25  # the same for each metre of coming nearer or going back, whose direction is not known better
_ABOVE = np.radians(65.0)  # over which rising and going back are the same
_QUICK, _WOBBLE = 31, 1.5e-3  # frames of a wobble; least of one: metres, and twice radians, root mean square
_SHORT = 300  # frames of a take
_STEPS = 7.2  # frames over which steps are evened
_TRAVELS = 0.3  # metres of somebody who goes
#: What goes along with its subject by itself, and so needs not be called a follow besides.
_ALONG = {"push", "pull", "arc", "crane", "dolly-zoom", "handheld", "roll"}


def read_movement(track: CameraTrack, subject: Subject) -> tuple[str, ...]:
    """All that the movement of a track may be called, the likeliest first: ``("pan-left+push",)``.

    Parts of two at once (or more) stand in the order of the alphabet.
    """
    seen = _Seen.of(track, subject)
    turns, others = _turns(seen), _lenses(seen) | ({"handheld"} if seen.shaken else set())
    straight = _slides(seen)
    rolls = any(turn.startswith("roll") for turn in turns)
    found = [_named(others | turns | (moves - {"follow"} if rolls else moves)) for moves in _ways(seen)]
    if straight:
        found.insert(0, _named(others | straight | {turn for turn in turns if turn.startswith("roll")}))
    if seen.overhead:
        found += [f.replace("pull", "pedestal-up").replace("push", "pedestal-down") for f in found]
    if found[0] == "static" and not seen.travels:
        found.append("follow")
    elif found[0] == "follow" and not seen.travels:
        found.append("static")
    return tuple(dict.fromkeys(found))


def canonical(movement: str) -> str:
    """A movement as :func:`read_movement` would tell it: without what another part does anyway."""
    parts = set(movement.split("+"))
    parts.discard("rack-focus")  # the lens turns, not the camera
    if len(parts) > 1:
        parts.discard("static")
        if {family(part) for part in parts} & _ALONG:
            parts.discard("follow")
    return _named(parts)


def _named(parts: set[str]) -> str:
    return "+".join(sorted(parts)) if parts else "static"


@dataclass(frozen=True, eq=False)
class _Seen:
    """A track without its shake, and where its subject is from it.

    position, rotation [T, 3], focal [T]; high: of the sensor, mm; path: [T, 3] of the point filmed; best: the
    frame at which the camera points at it best; shaken: whether there was a shake; still: whether it stays
    travels: whether the subject goes somewhere
    """

    position: Array
    rotation: Array
    focal: Array
    high: float
    path: Array
    best: int
    shaken: bool
    still: bool
    travels: bool

    @staticmethod
    def of(track: CameraTrack, subject: Subject) -> _Seen:
        shaken = _shakes(track)
        position, rotation = track.position, track.rotation
        if shaken:
            position, rotation = _trend(position), _trend(rotation)
        ahead = camera_axes(rotation)[:, 2] if shaken else track.axes[:, 2]
        path, best = _filmed(position, rotation, ahead, subject)
        still = float(np.linalg.norm(np.ptp(position, axis=0))) < (_SHAKEN if shaken else _STILL)
        middle = (subject.landmarks["eyes"] + subject.landmarks["waist"])[:, :2] / 2
        travels = float(np.linalg.norm(middle - middle[0], axis=1).max()) > _TRAVELS
        return _Seen(position, rotation, track.focal, track.sensor[1], path, best, shaken, still, travels)

    @property
    def overhead(self) -> bool:
        """Whether it looks straight down, where rising and going back are the same."""
        return bool(self.rotation[self.best, 1] < -_ABOVE)

    def about(self, pivot: Array) -> tuple[Array, Array, Array]:
        """Logarithm of the distance, azimuth and elevation [T] of the camera about points [T, 3]."""
        v = self.position - pivot
        flat = np.hypot(v[:, 0], v[:, 1])
        azimuth = np.unwrap(np.arctan2(v[:, 1], v[:, 0]))
        return np.log(np.maximum(np.hypot(flat, v[:, 2]), 1e-3)), azimuth, np.arctan2(v[:, 2], flat)

    @cached_property
    def about_path(self) -> tuple[Array, Array, Array]:
        """The same about the point filmed."""
        return self.about(self.path)

    @cached_property
    def off_subject(self) -> tuple[Array, Array]:
        """How far the camera points to the left of the point filmed, and over it, at every frame, radians."""
        _, azimuth, elevation = self.about_path
        return np.unwrap(self.rotation[:, 2] - azimuth), self.rotation[:, 1] + elevation


def _filmed(position: Array, rotation: Array, ahead: Array, subject: Subject) -> tuple[Array, int]:
    """The point filmed [T, 3] and the frame at which the camera points at it best: of the points that go
    with a part of the subject that nearest to the optical axes which point at it."""
    parts = _parts_of(subject)
    misses = _miss(position, ahead, parts)
    chosen = int(misses.min(axis=1).argmin())
    miss, trunk = misses[chosen], parts[_TRUNK]
    path = np.column_stack([trunk[:, :2], parts[chosen][:, 2]])
    path[:, :2] += (parts[chosen] - trunk)[int(miss.argmin()), :2]  # a head turns faster than one goes
    path = gaussian_filter1d(path, _STEPS, axis=0, mode="nearest")
    pivot = _crossing(position, ahead, path)
    if pivot is not None:
        return pivot, int(miss.argmin())
    near = miss < max(_NEAR_AXIS, 1.25 * float(miss.min()))
    off = np.eye(3) - ahead[near][:, :, None] * ahead[near][:, None, :]
    beside = (off @ (position - path)[near][..., None])[..., 0].sum(axis=0)
    meets = float(np.ptp(rotation[near, 2])) > _MEETS  # else all that is known is where the axes pass
    tie = (0.1 * _TIE if meets else _TIE) * near.sum()
    shift = np.linalg.solve(off.sum(axis=0) + tie * np.eye(3), beside)
    return path + shift, int(miss.argmin())


@lru_cache(maxsize=16)
def _parts_of(subject: Subject) -> Array:
    """The points [P, T, 3] of which one is filmed; its takes are mostly read one after the other."""
    marks = subject.landmarks
    return np.stack([(marks[a] + marks[b]) / 2 for a, b in _PARTS])


def _crossing(position: Array, ahead: Array, path: Array) -> Array | None:
    """The point [T, 3] which goes with ``path`` and through which, on the floor plan, all optical axes pass;
    None where they do not, are too much alike, or look down too steeply."""
    flat = np.linalg.norm(ahead[:, :2], axis=1)
    if flat.min() < _FLAT:
        return None
    way = ahead[:, :2] / flat[:, None]
    if np.ptp(np.unwrap(np.arctan2(way[:, 1], way[:, 0]))) < _MEETS:
        return None
    off = np.eye(2) - way[:, :, None] * way[:, None, :]
    to = path[:, :2] - position[:, :2]
    beside = np.linalg.solve(off.sum(axis=0), -(off @ to[..., None])[..., 0].sum(axis=0))
    to = to + beside
    away = (to * way).sum(axis=1)
    missed = np.abs(to[:, 0] * way[:, 1] - to[:, 1] * way[:, 0])
    if away.min() < 0.1 or (missed > _THROUGH * away).any():
        return None
    over = position[:, 2] + away * ahead[:, 2] / flat - path[:, 2]
    return path + np.array([*beside, float(np.median(over))])


def _miss(position: Array, ahead: Array, path: Array) -> Array:
    """Angle [..., T] between optical axis and direction to points [..., T, 3]."""
    to = path - position
    cosine = (to * ahead).sum(axis=-1) / np.maximum(np.linalg.norm(to, axis=-1), 1e-6)
    return np.asarray(np.arccos(np.clip(cosine, -1.0, 1.0)))


def _trend(values: Array) -> Array:
    t = np.linspace(-1.0, 1.0, len(values))
    fit = np.polynomial.polynomial.polyfit(t, values, min(5, max(len(t) - 2, 0)))
    return np.asarray(np.polynomial.polynomial.polyval(t, fit).T)


def _shakes(track: CameraTrack) -> bool:
    """A wobble of millimetres and tenths of a degree, quicker than any eased way."""
    found = np.column_stack([track.position, track.rotation[:, 1:] * 2.0])
    window = min(_QUICK, 2 * ((len(found) - 1) // 2) - 1)
    if window < 5:
        return False
    rest = found - _evened(found, window)
    turns = (np.diff(np.sign(np.diff(rest, axis=0)), axis=0) != 0).sum(axis=0)
    strong = (rest.std(axis=0) > _WOBBLE) & (turns >= len(found) / 11)
    steep = np.abs(track.rotation[:, 1]).max() > _ABOVE  # where a yaw wobbles by itself
    return bool(strong[3:].all() and strong[:3].sum() >= (3 if steep else 2))


def _evened(values: Array, window: int) -> Array:
    """Values [T, K] through a filter of Savitzky and Golay. It is linear: of short takes, of which there are
    many, its matrix is kept."""
    from scipy.signal import savgol_filter  # only now: it takes a third of a second to import

    if len(values) > _SHORT:
        return np.asarray(savgol_filter(values, window, 3, axis=0, mode="interp"))
    return _filter(len(values), window) @ values


@lru_cache(maxsize=16)
def _filter(frames: int, window: int) -> Array:
    from scipy.signal import savgol_filter

    return np.asarray(savgol_filter(np.eye(frames), window, 3, axis=0, mode="interp"))


def _change(values: Array) -> float:
    return float(values[-1] - values[0])


def _way(word: str, change: float, up: str, down: str) -> str:
    return f"{word}-{up if change > 0 else down}"


def _turns(seen: _Seen) -> set[str]:
    """Pans, tilts and rolls: turns that neither come from looking at the subject nor cancel its own ways."""
    out = set()
    roll, pitch, yaw = seen.rotation.T
    if abs(_change(roll)) > _LEAN:
        out.add(_way("roll", _change(roll), "right", "left"))
    aside, over = seen.off_subject
    zooms = abs(np.log(seen.focal[-1] / seen.focal[0])) > _ZOOMS
    away, orbits = seen.about_path[1], False
    if seen.still and abs(_change(yaw)) > np.radians(45.0) and not zooms:
        step = np.abs(np.diff(yaw))
        if step.max() > 4.0 * step.mean() and step.max() > np.radians(2.0):
            return {_way("whip-pan", _change(yaw), "left", "right")}
    if not seen.still:
        orbits = abs(_change(away)) > _ROUND
    for word, turned, own, up, down in (
        ("pan", yaw, aside, "left", "right"),
        ("tilt", pitch, over, "up", "down"),
    ):
        if seen.still and zooms and np.ptp(own) < max(_AFTER, 0.35 * float(np.ptp(turned))):
            continue  # only turns after its subject
        if word == "pan" and seen.overhead and not seen.still:  # it turns about the vertical, or all the more
            own = turned if abs(_change(turned)) < _OVER else np.zeros(2)
        change = _change(own) if orbits and word == "pan" else _change(turned)
        least = _TURN if seen.overhead or not (zooms or (orbits and word == "pan")) else 1.8 * _TURN
        if abs(change) > least and (seen.still or abs(_change(own)) > _TURN):
            out.add(_way(word, change, up, down))
    return out


def _lenses(seen: _Seen) -> set[str]:
    """Zooms and dolly zooms."""
    longer = np.log(seen.focal / seen.focal[0])
    if abs(longer[-1]) < _ZOOMS:
        return set()
    if not seen.still and _compensates(seen):
        return {_way("dolly-zoom", longer[-1], "out", "in")}
    return {_way("zoom", longer[-1], "in", "out")}


def _compensates(seen: _Seen) -> bool:
    """Whether the camera moves along its axis so that what it films keeps its size."""
    arm = seen.position - seen.path
    away = float(np.linalg.norm(arm[0]))
    gone, longer = arm @ (arm[0] / away) - away, seen.focal / seen.focal[0] - 1.0
    depth = float(gone @ longer / max(float(longer @ longer), 1e-9))
    rest = np.abs(gone - depth * longer).max()
    return bool(abs(longer[-1]) > 0.1 and 0.6 < depth / away < 1.6 and rest < 0.06 * depth)


def _ways(seen: _Seen) -> list[set[str]]:
    """What the way of the camera may be called: as one goes with its subject, and as one in the world."""
    if seen.still:
        return [set()]
    parallel = max(np.ptp(seen.rotation[:, 1]), np.ptp(seen.rotation[:, 2])) < _AFTER / 2
    loyal = max(map(np.ptp, seen.off_subject)) < 2 * _AFTER
    here = np.broadcast_to(seen.path[seen.best], seen.path.shape)
    along, beside = _moves(seen, seen.path), _moves(seen, here)
    if _goes_with(seen):
        along = {"follow"} if seen.travels and not seen.shaken else set()
    if loyal:
        return [along, beside] if parallel else [along]
    return [beside, along] if parallel else [along, beside]


def _slides(seen: _Seen) -> set[str]:
    """A dolly or a pedestal, and the turns on its way, of a camera that goes straight aside or up."""
    moved = seen.position[-1] - seen.position[0]
    away = float(np.linalg.norm(seen.position[seen.best] - seen.path[seen.best]))
    far = float(np.linalg.norm(moved))
    along = (seen.position - seen.position[0]) @ (moved / max(far, 1e-9))
    off = seen.position - seen.position[0] - along[:, None] * moved / max(far, 1e-9)
    if far < _ASIDE * away or np.linalg.norm(off, axis=1).max() > 0.02 * far + 0.005:
        return set()
    _, pitch, yaw = seen.rotation.T
    right = (moved[0] * np.sin(yaw) - moved[1] * np.cos(yaw)) / far
    aside = float(right[np.abs(right).argmax()])
    if abs(moved[2]) > 0.995 * far:
        found = {_way("pedestal", moved[2], "up", "down")}
    elif abs(moved[2]) < 0.03 * far and abs(aside) > 0.995:
        found = {_way("dolly", aside, "right", "left")}
    else:
        return set()
    for word, turned, up, down in (("pan", yaw, "left", "right"), ("tilt", pitch, "up", "down")):
        if abs(_change(turned)) > _TURN:
            found.add(_way(word, _change(turned), up, down))
    return found


def _goes_with(seen: _Seen) -> bool:
    """Whether every place of the camera is one of its subject's, carried over."""
    best = np.inf
    for start in (0, -1):
        arm = seen.position[start] - seen.path[start]
        own = seen.path + arm
        square = dot(own, own) - 2.0 * seen.position @ own.T  # of the distance, but for what each place adds
        gap = np.sqrt(np.maximum(square.min(axis=1) + dot(seen.position, seen.position), 0.0).max())
        best = min(best, float(gap) / max(float(np.linalg.norm(arm)), 0.3))
    return best < 0.05


def _moves(seen: _Seen, pivot: Array) -> set[str]:
    """Pushes, pulls, arcs, cranes, dollies and pedestals about a pivot [T, 3]."""
    reach, azimuth, elevation = seen.about_path if pivot is seen.path else seen.about(pivot)
    turned = _change(seen.rotation[:, 2] if seen.overhead else azimuth)
    risen, nearer = _change(elevation), -_change(reach)
    pitch = seen.rotation[:, 1]
    away = float(np.exp(reach[seen.best]))
    low = -float(pitch[seen.best])
    moved = (seen.position[-1] - pivot[-1]) - (seen.position[0] - pivot[0])
    out: set[str] = set()
    followed = abs(risen + _change(pitch)) < 0.4 * abs(risen)
    if abs(risen) > _RISES and followed:
        out.add(_way("crane", risen, "up", "down"))
    if abs(turned) > (_OVER if seen.overhead else _ROUND):
        out.add(_way("arc", turned, "right", "left"))
        up = float(moved[2]) + np.sin(low) * float(np.exp(reach[0]) - np.exp(reach[-1]))
        slid = nearer
    else:
        yaw = seen.rotation[seen.best, 2]
        aside = float(moved[0] * np.sin(yaw) - moved[1] * np.cos(yaw))
        ahead = float(moved[0] * np.cos(yaw) + moved[1] * np.sin(yaw))
        needs = -ahead * np.tan(-pitch if abs(_change(pitch)) > _TURN else np.array([low]))  # of any it sees
        up = float(moved[2] - np.clip(moved[2], needs.min(), needs.max()))  # more than coming nearer needs
        slid = (-float(moved[2]) if seen.overhead else ahead / np.cos(low)) / away
        if abs(aside) > max(_ASIDE * away, _ASKEW * abs(ahead)):
            out.add(_way("dolly", aside, "right", "left"))
            slid = slid if abs(ahead) > 0.5 * abs(aside) else 0.0
    if abs(risen) < _RISES or not followed:
        view = float((np.exp(reach) * seen.high / seen.focal).max())
        unsure = abs(_change(pitch)) > _TURN and abs(nearer) > 0.1  # which way it comes nearer
        if abs(up) > (1.3 if unsure else 1.0) * _UP * view and not seen.overhead:
            out.add(_way("pedestal", up, "up", "down"))
        if out and not {family(word) for word in out} & {"arc", "crane"}:  # slides lengthen the way
            nearer = slid
    least = 2.5 * _NEARS if abs(turned) > _ROUND else _NEARS
    if abs(nearer) > least and not any(word.startswith("dolly-zoom") for word in _lenses(seen)):
        out.add("push" if nearer > 0 else "pull")
    return out
