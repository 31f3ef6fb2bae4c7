"""Why no camera does what a line says, and what would work instead: computed from the place, not canned.

Assumes a shot none of whose candidates survived, or none without a fault. Guarantees that every alternative
named has survivors, or some without a fault, among a few candidates of its own.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from runtime.world import WorldObject

from ..cinema.flaws import flaws_by_measure, gravity
from ..cinema.sight import blockers
from ..cinema.space import nearby, stage_of
from ..cinema.subject import SIGHT, Subject
from ..cinema.takes import samples
from ..cinema.telling import FAULTY
from ..lang.ir import ALL_ANGLES, ANGLES, SCALES, SIZES, Shot
from .cameras import Filming, Tried, subject_of, try_cameras
from .drawing import draw, generator
from .rejection import REASONS
from .types import Advice, CameraProposal, StoryProposal

_STEPS = 5  # sizes nearer or farther that still are the same shot, more or less
_TRIED = 48  # candidates of an alternative
_TRIED_FOR_FAULTS = 96  # the same, where they are to be without a fault
_WAYS = 3  # in which a line is played that are looked at
_LENSES = (50.0, 35.0, 24.0, 18.0)
_LONGER = (85.0, 100.0, 135.0, 200.0)
_NO_ROOM = ("in_wall", "in_object", "too_far_outside", "through_ceiling", "below_floor")


def advise(
    shot: Shot, story: StoryProposal, filming: Filming, others: Sequence[StoryProposal] = ()
) -> Advice:
    """Look at what is in the way; try every other size and angle, shorter lenses, and standing still.

    others: more ways the line may be played, in which an alternative may hold where the first has no room
    """
    failed = _Failed(shot, story, subject_of(shot, story, filming), filming, _try(shot, story, filming, 192))
    ways = (story, *others[: _WAYS - 1])
    instead = tuple(_instead(shot, partial(_works, ways=ways, filming=filming), filming))
    return Advice(_why(failed), instead or tuple(_together(shot, ways, filming)))


def is_faultless(camera: CameraProposal) -> bool:
    """Whether film grammar finds no fault in a camera."""
    return not any(bool(found) for found in flaws_by_measure(camera.measures).values())


def advise_on_faults(
    shot: Shot, story: StoryProposal, filming: Filming, cameras: Sequence[CameraProposal]
) -> Advice:
    """Of a shot of which no take is without a fault: the commonest one, and words with which some are."""
    names = {name for camera in cameras for name in camera.measures}
    values = {name: np.array([camera.measures[name] for camera in cameras]) for name in names}
    common = max(flaws_by_measure(values).items(), key=lambda item: int(item[1].sum()))[0]
    whom = subject_of(shot, story, filming).name.replace("_", " ")
    works = partial(_works, ways=(story,), filming=filming, faultless=True)
    return Advice(FAULTY[common].format(whom=whom), tuple(_instead(shot, works, filming)), faulty=True)


def _try(shot: Shot, story: StoryProposal, filming: Filming, count: int = _TRIED) -> Tried:
    subject = subject_of(shot, story, filming)
    stage = stage_of(filming.world, subject.position[[0, -1]])
    sample = draw(shot, 1, count, generator(filming.seed, shot.drawn_as, "advice"))
    return try_cameras(shot, story, subject, stage, filming, sample, np.arange(count))


# --- what would work --------------------------------------------------------------------------


def _works(shot: Shot, ways: Sequence[StoryProposal], filming: Filming, faultless: bool = False) -> bool:
    """Whether a few candidates have survivors; faultless: such as have no fault either."""
    if not faultless:
        return any(bool((_try(shot, way, filming).reason < 0).any()) for way in ways)
    for way in ways:
        tried = _try(shot, way, filming, _TRIED_FOR_FAULTS)
        if tried.measured is not None:
            grave = np.sum(list(gravity(tried.measured.values).values()), axis=0)
            if bool(((tried.reason[tried.kept] < 0) & (grave == 0)).any()):
                return True
    return False


def _together(shot: Shot, ways: Sequence[StoryProposal], filming: Filming) -> Iterator[str]:
    """The nearest size that has survivors of a camera that stands still, where no word alone helps."""
    if "static" in shot.movements:
        return
    asked = [SIZES.index(s) for s in shot.scales]
    known = (s for s in (SCALES if filming.rig == "paper" else SIZES) if s not in shot.scales)
    for size in sorted(known, key=lambda s: min(abs(SIZES.index(s) - k) for k in asked)):
        if _works(replace(shot, movements=("static",), scales=(size,)), ways, filming):
            yield f"static {size}"
            return


def _instead(shot: Shot, works: Callable[[Shot], bool], filming: Filming) -> Iterator[str]:
    """Words that work where they stand in the line instead; of each kind the nearest first."""
    paper = filming.rig == "paper"
    known, angles = (SCALES, ANGLES) if paper else (SIZES, ALL_ANGLES)
    asked = [SIZES.index(s) for s in shot.scales]
    steps = {s: min(abs(SIZES.index(s) - k) for k in asked) for s in known if s not in shot.scales}
    sizes = sorted((s for s in steps if steps[s] <= _STEPS), key=lambda s: steps[s])
    shorter = [] if paper else [f for f in _LENSES if f < shot.lens[0] - 1.0]
    if shot.view in ("ots", "pov"):  # whose place is given
        shorter += [f for f in _LONGER if f > shot.lens[1] + 1.0]
    kinds: tuple[tuple[int, list[tuple[str, Shot]]], ...] = (
        (2, [(s, replace(shot, scales=(s,))) for s in sizes]),
        (1, [(a, replace(shot, angles=(a,))) for a in angles if a not in shot.angles]),
        (1, [(f"lens {f:.0f}mm", replace(shot, lens=(f, f))) for f in shorter]),
        (1, [("static", replace(shot, movements=("static",)))] if "static" not in shot.movements else []),
    )
    for most, options in kinds:
        worked = (words for words, other in options if works(other))
        yield from (words for _, words in zip(range(most), worked, strict=False))


# --- why --------------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class _Failed:
    """A shot, and candidates of it none of which survived."""

    shot: Shot
    story: StoryProposal
    subject: Subject
    filming: Filming
    tried: Tried

    @property
    def counts(self) -> Counter[str]:
        return Counter(REASONS[k] for k in self.tried.reason if k >= 0)

    @property
    def shown(self) -> str:
        """``a wide eye-level shot``."""
        one = [words[0] for words in (self.shot.scales, self.shot.angles) if len(words) == 1]
        text = " ".join([*one, "shot"])
        return f"{'an' if text[0] in 'aeiou' else 'a'} {text}"

    @property
    def whom(self) -> str:
        name = self.subject.name.replace("_", " ")
        return name if self.subject.kind == "person" else f"the {name}"

    def item(self, found: Counter[int]) -> str:
        """``the cupboard``: the object found most often; empty for none."""
        for number, _ in found.most_common():
            item = next((o for o in self.filming.world.objects if o.id == number), None)
            if item is not None and item.kind not in ("room", "area"):
                return f"the {_plain(item)}"
        return ""


def _plain(item: WorldObject) -> str:
    return item.path[-1].replace("_", " ")


def _why(failed: _Failed) -> str:
    """The commonest reason, with what it comes from."""
    counts = failed.counts
    if not counts:
        return "hardly any camera keeps to these words"
    if 2 * sum(counts[r] for r in _NO_ROOM) > sum(counts.values()):
        return _cramped(failed)
    reason = counts.most_common(1)[0][0]
    return _TOLD[reason](failed) if reason in _TOLD else f"the commonest fault is {reason.replace('_', ' ')}"


def _cramped(failed: _Failed) -> str:
    """``the corridor is 1.2 m wide, and a wide eye-level shot stands 4.1 m away or more``."""
    counts = failed.counts
    shooting, rows = failed.tried.shooting, np.arange(len(failed.tried.reason))
    track, key = shooting.track, shooting.key  # nearer along the way does not count
    least = float(np.linalg.norm(track.position[rows, key] - track.look_at[rows, key], axis=-1).min())
    away = f"{failed.shown} stands {least:.1f} m away or more"
    inside = failed.item(_stood_in(failed))
    if inside and counts["in_object"] > counts["too_far_outside"] + counts["in_wall"]:
        return f"{inside} stands where the camera would: {away}"
    name, width = _room(failed.subject, failed.filming)
    return f"the {name} is {width:.1f} m wide, and {away}"


def _room(subject: Subject, filming: Filming) -> tuple[str, float]:
    """Name and least width in metres of the room the subject is in."""
    x, y, z = subject.position[0] + np.array((0.0, 0.0, 0.1))
    around = [
        (min(o.high[0] - o.low[0], o.high[1] - o.low[1]), _plain(o))
        for o in filming.world.objects
        if o.kind in ("room", "area")
        and o.low[0] <= x <= o.high[0]
        and o.low[1] <= y <= o.high[1]
        and o.low[2] - 0.2 <= z <= o.high[2] + 0.2
    ]
    if around:
        width, name = min(around)
        return name, width
    floors = np.array(filming.world.floors or ((-2.0, -2.0, 2.0, 2.0),))
    return "set", float((floors[:, 2:].max(axis=0) - floors[:, :2].min(axis=0)).min())


def _stood_in(failed: _Failed) -> Counter[int]:
    """How many cameras stand in each thing, or right beside it."""
    solids = failed.filming.world.solids
    at = samples(failed.subject.frames)
    near = nearby(solids, failed.tried.shooting.track.position[:, at])
    owners = solids.object[near.box[(near.away < 0.3) & (solids.wall[near.box] < 0)]]
    return Counter(int(owner) for owner in owners)


def _hidden(failed: _Failed) -> str:
    middle = failed.subject.frames // 2
    bad = failed.tried.reason == REASONS.index("subject_hidden")
    points = np.stack([failed.subject.landmarks[name][middle] for name in SIGHT])
    cameras = failed.tried.shooting.track.position[bad][:, middle]
    before = failed.item(Counter(blockers(failed.filming.world.solids, cameras, points)))
    return f"{failed.shown} sees {before or 'somebody else'} before {failed.whom}"


def _fast(failed: _Failed) -> str:
    step = np.linalg.norm(np.diff(failed.tried.shooting.track.position, axis=1), axis=-1)
    speed = float(np.median(step.max(axis=1))) * failed.filming.fps
    return f"the camera would go {speed:.1f} m/s, or turn too fast"


def _in_person(failed: _Failed) -> str:
    return f"{failed.shown} stands where somebody is"


def _out_of_frame(failed: _Failed) -> str:
    return f"{failed.whom} leaves the frame of {failed.shown}, going {failed.subject.travel():.1f} m"


def _wrong_view(failed: _Failed) -> str:
    """Over a shoulder: how far the two are apart, and what the lenses make of it; else who is not seen."""
    shot, subject = failed.shot, failed.subject
    if subject.via is None:
        return f"{failed.shown} does not show everybody at its first and last frame"
    apart = float(np.linalg.norm(subject.via - subject.landmarks["eyes"], axis=1).min())
    low, high = shot.lens
    lens = f"lens {low:.0f}mm" if high - low < 1.0 else f"lenses of {low:.0f} to {high:.0f} mm"
    who = shot.whose[0] if shot.whose else "the other"
    shown = failed.shown.partition(" ")[2]
    return f"{failed.whom} is {apart:.1f} m from {who}, and {lens} put no {shown} over that shoulder"


def _no_backdrop(failed: _Failed) -> str:
    return f"{failed.shown} has no wall left behind {failed.whom}"


_TOLD: dict[str, Callable[[_Failed], str]] = {
    "subject_hidden": _hidden,
    "too_fast": _fast,
    "in_person": _in_person,
    "subject_out_of_frame": _out_of_frame,
    "missing_backdrop": _no_backdrop,
    "wrong_view": _wrong_view,
}
