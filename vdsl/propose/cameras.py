"""Camera proposals: the subspaces of section 3.2 enumerated into a shot's budget, and what is thrown out.

Assumes performed story proposals and the world they play in. Guarantees that what is offered keeps to the
line's size and angle, stands in free space, sees its subject, and is the same for the same text and seed
whatever else was proposed before.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from runtime.body.skeleton import JOINT, Skeleton
from runtime.nav import level_at
from runtime.world import World, WorldObject

from ..cinema import rig_cinema, rig_paper
from ..cinema.measures import Measured, Takes, measure, samples
from ..cinema.score import geometry_scores
from ..cinema.sizes import Size, size_of
from ..cinema.space import Stage, nearby, stage_of
from ..cinema.subject import Subject, group, person, place, thing
from ..cinema.track import CameraTrack
from ..lang.ir import Shot, Target
from ..library import Catalog
from .drawing import Sample, draw, generator, nudged
from .rejection import REASONS, SOFT, no_room, reasons
from .shooting import Shooting, shoot
from .types import STILL, CameraProposal, ProposalGrid, StoryProposal

_ROUNDS = 8
_HOPE = 0.8  # of the share that was good so far: what is counted on in the next round
_MOST = 10  # candidates in one round, for each that is wanted
_FEW = 8  # with fewer takes than this, ones that only look less well are let back in
_MARGIN = 0.22  # radius of a person in somebody else's way, metres
_NECK = 0.09  # of one over whose shoulder one looks


@dataclass(frozen=True, eq=False)
class Filming:
    """What cameras need to know of a scene.

    skeletons: of everyone in it; fps: frames a second; rig: cinema or paper; aspect: picture width/height
    room: path of the room an establishing shot shows, () for the whole set
    catalog: where the actions of story lines are defined; cameras alone need none
    """

    world: World
    skeletons: Mapping[str, Skeleton]
    fps: float
    seed: int
    rig: str = "cinema"
    aspect: float = 16 / 9
    room: tuple[str, ...] = ()
    catalog: Catalog | None = None

    @property
    def sensor(self) -> tuple[float, float]:
        return (rig_paper if self.rig == "paper" else rig_cinema).sensor(self.aspect)


@dataclass(frozen=True, eq=False)
class _Batch:
    """Candidates of one story, measured: tracks [P], what was drawn, and why each is thrown out."""

    story: int
    azimuth: NDArray[np.int64]
    movement: NDArray[np.int64]
    shooting: Shooting
    measured: Measured
    scores: NDArray[np.float64]
    reason: NDArray[np.int64]


def propose_cameras(shot: Shot, stories: Sequence[StoryProposal], filming: Filming) -> ProposalGrid:
    """S · C proposals of a shot: ``shot.proposals`` of them where free space allows."""
    subjects = [subject_of(shot, story, filming) for story in stories]
    stages = [stage_of(filming.world, subject.position[[0, -1]]) for subject in subjects]
    name = subjects[0].name if subjects and subjects[0].kind == "person" else None
    batches: list[_Batch] = []
    rejected: Counter[str] = Counter()
    considered, good, wanted = 0, 0, shot.proposals
    few = min(_FEW, wanted)
    for number in range(_ROUNDS + 1):
        # a few more than are wanted: another round costs more than they do
        share = max(_HOPE * good / considered, 0.05) if considered else 0.75
        count = int(np.clip((wanted - good) / share, 16, _MOST * wanted))
        rng = generator(filming.seed, shot.id, f"cameras {number}")
        sample = draw(shot, len(stories), count, rng)
        if number == _ROUNDS:  # what the grid has no room for may have some beside it
            sample = nudged(sample, rng)
        considered += count
        for batch in _consider(shot, stories, subjects, stages, filming, sample, rejected):
            batches.append(batch)
            good += int((batch.reason < 0).sum())
            rejected.update(REASONS[k] for k in batch.reason[batch.reason >= 0])
        if good >= (wanted if number < _ROUNDS - 1 else few):
            break
    chosen = _choose(batches, wanted)
    let_in = [batches[b].reason[p] for b, p in chosen if batches[b].reason[p] >= 0]
    rejected.subtract(REASONS[k] for k in let_in)
    cameras = tuple(_proposal(i, batches[b], p, shot) for i, (b, p) in enumerate(chosen))
    counts = {k: v for k, v in sorted(rejected.items()) if v > 0}
    return ProposalGrid(shot.id, name, tuple(stories), cameras, considered, counts, len(let_in))


def subject_of(shot: Shot, story: StoryProposal, filming: Filming) -> Subject:
    """Whom or what the shot's cameras are about."""
    if shot.view in ("two-shot", "group"):
        everybody = _together(shot, story, filming)
        return everybody if everybody is not None else _focused(shot, story, filming)
    subject = _focused(shot, story, filming)
    owner = shot.whose[0] if shot.view and shot.whose else ""
    if owner not in story.performances or owner == subject.name:
        return subject
    return replace(subject, via=_person(owner, story, filming).landmarks["eyes"])


def _person(name: str, story: StoryProposal, filming: Filming) -> Subject:
    acted = story.performances[name]
    return person(name, filming.skeletons[name], acted.world_from_joint, acted.position, acted.heading)


def _together(shot: Shot, story: StoryProposal, filming: Filming) -> Subject | None:
    """Two people, or all, as one subject: those of the line first, then who is nearest to them."""
    first = [name for name in shot.whose if name in story.performances]
    if shot.focus is not None and shot.focus.path[-1] in story.performances:
        first.insert(0, shot.focus.path[-1])
    people = {name: _person(name, story, filming) for name in story.performances}
    if not people:
        return None
    middle = people[(first or list(people))[0]].position.mean(axis=0)
    away = {n: float(np.linalg.norm(p.position.mean(axis=0) - middle)) for n, p in people.items()}
    by_distance = sorted(people, key=lambda name: away[name])
    order = list(dict.fromkeys((*first, *by_distance)))
    return group([people[name] for name in (order[:2] if shot.view == "two-shot" else order)])


def _focused(shot: Shot, story: StoryProposal, filming: Filming) -> Subject:
    focus = shot.focus
    if focus is None or _establishes(shot, story):
        return _room_subject(filming, story.frames)
    if focus.kind == "character" and focus.path[-1] in story.performances:
        return _person(focus.path[-1], story, filming)
    item = find_object(filming.world, focus)
    return (
        _room_subject(filming, story.frames) if item is None else _thing_subject(item, story, filming.world)
    )


def _establishes(shot: Shot, story: StoryProposal) -> bool:
    """Whether a shot in which nobody acts shows the place: it is wide, and nobody was named as its focus."""
    named = shot.focus is not None and shot.focus.span.text == shot.focus.written
    return story.variant == STILL and not named and set(shot.scales) <= {"extreme-wide", "wide", "full"}


def find_object(world: World, target: Target) -> WorldObject | None:
    """The object a target names, or the one its spot belongs to: the longest path that matches."""
    paths = {item.path: item for item in world.objects}
    for end in range(len(target.path), 0, -1):
        if target.path[:end] in paths:
            return paths[target.path[:end]]
    return None


def _room_subject(filming: Filming, frames: int) -> Subject:
    item = next((o for o in filming.world.objects if o.path == filming.room and filming.room), None)
    if item is not None:
        return place(item.path[-1], item.low, item.high, frames)
    floors = np.array(filming.world.floors or ((-2.0, -2.0, 2.0, 2.0),))
    low, high = floors[:, :2].min(axis=0), floors[:, 2:].max(axis=0)
    return place(filming.world.name, (*low.tolist(), 0.0), (*high.tolist(), 2.6), frames)


def _thing_subject(item: WorldObject, story: StoryProposal, world: World) -> Subject:
    name = item.path[-1]
    low, high = (np.tile(corner, (story.frames, 1)) for corner in (item.low, item.high))
    if item.kind in ("room", "area"):
        return replace(place(name, item.low, item.high, story.frames), name=name)
    moved = story.props.get(item.id)
    if moved is not None:
        shift = moved[:, :3, 3].astype(float) - item.world_from_object[:3, 3]
        low, high = low + shift, high + shift
    stand = item.spot("stand")
    facing = 0.0 if stand is None or stand.facing is None else stand.facing + np.pi
    x, y, _ = item.centre
    floor = world.storeys[level_at(world, (x, y, item.low[2]))].height
    return thing(name, low, high, facing, floor)


def _consider(
    shot: Shot,
    stories: Sequence[StoryProposal],
    subjects: Sequence[Subject],
    stages: Sequence[Stage],
    filming: Filming,
    sample: Sample,
    rejected: Counter[str],
) -> list[_Batch]:
    """Shoot, measure and judge candidates; counts those without room in ``rejected``."""
    out = []
    for s, subject in enumerate(subjects):
        rows = np.flatnonzero(sample.story == s)
        if not len(rows):
            continue
        tried = try_cameras(shot, stories[s], subject, stages[s], filming, sample, rows)
        rejected.update(REASONS[k] for k in np.delete(tried.reason, tried.kept))
        if tried.measured is None:
            continue
        shooting = tried.shooting.only(tried.kept)
        out.append(
            _Batch(
                s,
                sample.azimuth[rows][shooting.order],
                sample.movement[rows][shooting.order],
                shooting,
                tried.measured,
                geometry_scores(tried.measured.values),
                tried.reason[tried.kept],
            )
        )
    return out


@dataclass(frozen=True, eq=False)
class Tried:
    """Candidates of one story looked at.

    reason: [P] index into REASONS, −1 for the good ones; kept: those that have room; measured: those alone,
    None where there are none
    """

    shooting: Shooting
    reason: NDArray[np.int64]
    kept: NDArray[np.int64]
    measured: Measured | None


def try_cameras(
    shot: Shot,
    story: StoryProposal,
    subject: Subject,
    stage: Stage,
    filming: Filming,
    sample: Sample,
    rows: NDArray[np.int64],
) -> Tried:
    """Shoot the sampled rows on one story; what has room is measured and judged."""
    shooting = shoot(shot, subject, sample, rows, filming.rig, filming.sensor, filming.fps)
    solids, at = filming.world.solids, samples(subject.frames)
    near = nearby(solids, shooting.track.position[:, at])
    reason = no_room(shooting, near, solids, stage, at)
    kept = np.flatnonzero(reason < 0)
    if not len(kept):
        return Tried(shooting, reason, kept, None)
    left = shooting.only(kept)
    takes = replace(_takes(shot, subject, left, story, filming), near=near.only(kept))
    measured = measure(takes, subject, filming.world, filming.fps)
    reason[kept] = reasons(left, measured, subject)
    return Tried(shooting, reason, kept, measured)


def _takes(shot: Shot, subject: Subject, shooting: Shooting, story: StoryProposal, filming: Filming) -> Takes:
    sizes: tuple[Size, ...] = tuple(size_of(subject.kind, s) for s in shooting.scales)
    ignore = None
    if subject.kind == "thing" and shot.focus is not None:
        item = find_object(filming.world, shot.focus)
        ignore = item.id if item is not None else None
    others = []
    seen = {subject.name, *subject.heads, *(shot.whose if shot.view == "pov" else ())}
    for name, acted in story.performances.items():
        if name not in seen:
            joints = acted.world_from_joint
            crown = joints[:, JOINT["head"], :3, 3].astype(float) + np.array((0.0, 0.0, 0.12))
            foot = joints[:, JOINT["hips"], :3, 3].astype(float)
            foot[:, 2] = acted.position[:, 2]
            shoulder = shot.view == "ots" and name in shot.whose
            others.append((foot, crown, _NECK if shoulder else _MARGIN))
    window = shooting.window(samples(subject.frames), subject.frames)
    return Takes(
        shooting.track,
        sizes,
        window,
        shooting.key,
        shot.roll,
        filming.rig == "paper",
        tuple(others),
        ignore,
        story.interest,
        view=shot.view,
    )


def _choose(batches: Sequence[_Batch], wanted: int) -> list[tuple[int, int]]:
    """Up to ``wanted`` candidates as (batch, row): varied first, better ones before worse ones."""
    reason = np.concatenate([b.reason for b in batches]) if batches else np.zeros(0, int)
    if not len(reason):
        return []
    where = [(i, p) for i, b in enumerate(batches) for p in range(len(b.reason))]
    scores = np.concatenate([b.scores for b in batches])
    pool = np.flatnonzero(reason < 0)
    if len(pool) < min(_FEW, wanted):
        soft = np.flatnonzero(np.isin(reason, SOFT))
        soft = soft[np.argsort(-scores[soft], kind="stable")]
        pool = np.concatenate([pool, soft[: min(_FEW, wanted) - len(pool)]])
    keys = np.stack(
        [
            np.concatenate([b.azimuth for b in batches]),
            np.concatenate([np.full(len(b.reason), b.story) for b in batches]),
            np.concatenate([b.movement for b in batches]),
            np.concatenate([b.shooting.strata for b in batches]),
        ],
        axis=1,
    )[pool]
    picked: list[int] = []
    taken = np.zeros(len(pool), bool)
    counts = [np.zeros(keys[:, k].max() + 1 if len(keys) else 1) for k in range(keys.shape[1])]
    for _ in range(min(wanted, len(pool))):
        crowd = sum(c[keys[:, k]] for k, c in enumerate(counts)) - 1.5 * scores[pool]
        best = int(np.where(taken, np.inf, crowd).argmin())
        taken[best] = True
        picked.append(int(pool[best]))
        for k, c in enumerate(counts):
            c[keys[best, k]] += 1
    return sorted(where[i] for i in picked)


def _proposal(index: int, batch: _Batch, row: int, shot: Shot) -> CameraProposal:
    track = batch.shooting.track
    values = {k: float(v[row]) for k, v in batch.measured.values.items()}
    values["geometry"] = float(batch.scores[row])
    return CameraProposal(
        index=index,
        story=batch.story,
        movement=batch.shooting.movements[row],
        scale=batch.shooting.scales[row],
        angle=batch.shooting.angles[row],
        params=batch.shooting.params(row, shot.roll),
        track=CameraTrack(
            track.position[row], track.rotation[row], track.focal[row], track.look_at[row], track.sensor
        ),
        hidden_walls=batch.measured.hidden[row],
        unseen=shot.whose[0] if shot.view == "pov" and shot.whose else "",
        measures=values,
    )
