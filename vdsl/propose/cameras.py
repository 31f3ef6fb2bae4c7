"""Camera proposals: the subspaces of section 3.2 enumerated into a shot's budget, and what is thrown out.

Assumes performed story proposals and the world they play in. Guarantees that what is offered keeps to the
line's size and angle, stands in free space, sees its subject, and is the same for the same text and seed
whatever else was proposed before.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..cinema.flaws import gravity
from ..cinema.measures import Measured, measure
from ..cinema.score import geometry_scores
from ..cinema.sizes import Size, size_of
from ..cinema.space import Stage, nearby, stage_of
from ..cinema.subject import Subject
from ..cinema.takes import Pictures, Takes, samples
from ..cinema.track import CameraTrack
from ..lang.ir import Shot
from .candidates import Shooting
from .drawing import Sample, draw, generator, near, nudged, put_together
from .focusing import focused, unseen_racks
from .rejection import OFFERED, REASONS, no_room, reasons
from .shooting import shoot
from .subjects import Filming as Filming
from .subjects import company_of, foci_of, held_by
from .subjects import find_object as find_object
from .subjects import subject_of as subject_of
from .types import CameraProposal, ProposalGrid, StoryProposal

Array = NDArray[np.float64]

_ROUNDS = 8
_HOPE = 0.6  # of the share that was good so far: what is counted on in the next round
_LEAST, _MOST = 0.05, 12  # the least share counted on, and candidates in one round for each that is wanted
_RACKED = 3  # times as many where two have to be seen well, at the ends of a rack-focus
_FEW = 8  # with fewer takes than this, ones that only look less well are let back in
_HOPELESS = 3  # rounds after which, with as few takes as that, cameras are nudged
#: Where less than that share of what is wanted has no fault, it is looked for beside the best, so often, so
#: many at a time for each that is wanted, beside so many of them.
_FAULTLESS, _SEARCHES, _MORE, _BEST = 0.25, 3, 1.5, 12
_GLIMPSE = 0.2  # least share of the subject that is seen of what is let back in
_PLAIN = 1.5  # how many of its kind what has no fault may follow, more than what has one


@dataclass(frozen=True, eq=False)
class _Batch:
    """Candidates of one story, measured, in full those that may be offered: what was drawn,
    tracks [P], in which sampled frames they are meant to show their subject [P, F], why each is thrown out,
    and how grave all its faults together are."""

    sample: Sample
    shooting: Shooting
    window: NDArray[np.bool_]
    measured: Measured
    scores: NDArray[np.float64]
    reason: NDArray[np.int64]
    faults: NDArray[np.float64]


def propose_cameras(shot: Shot, stories: Sequence[StoryProposal], filming: Filming) -> ProposalGrid:
    """S · C proposals of a shot: ``shot.proposals`` of them where free space allows."""
    subjects = [subject_of(shot, story, filming) for story in stories]
    stages = [stage_of(filming.world, subject.position[[0, -1]]) for subject in subjects]
    name = subjects[0].name if subjects and subjects[0].kind == "person" else None
    batches: list[_Batch] = []
    rejected: Counter[str] = Counter()
    considered, wanted = 0, shot.proposals
    few = min(_FEW, wanted)
    hard = 1 if shot.focus_to is None else _RACKED
    free = shot.any_lens and filming.rig == "cinema"
    place = bool(subjects) and subjects[0].kind == "place"  # which has no heading

    def consider(sample: Sample) -> None:
        nonlocal considered
        considered += len(sample.story)
        lacking = few - _good(batches)
        batches.extend(_consider(shot, stories, subjects, stages, filming, sample, rejected, lacking))

    for number in range(_ROUNDS + 1):
        good = _good(batches)
        if good >= (wanted if number < _ROUNDS else few):
            break
        # a few more than are wanted: another round costs more than they do
        share = max(_HOPE * good / considered, _LEAST / hard) if considered else 0.75
        count = int(np.clip((wanted - good) / share, 16, hard * _MOST * wanted))
        rng = generator(filming.seed, shot.drawn_as, f"cameras {number}")
        sample = draw(shot, len(stories), count, rng, place)
        if number == _ROUNDS or (number >= _HOPELESS and good < few):
            sample = nudged(sample, rng, free)  # what the grid has no room for may have some beside it
        consider(sample)
    if filming.rig == "cinema":  # the paper's stand on its grid
        for number in range(_SEARCHES):
            best = _best(batches)
            plain = _faultless(batches)
            if best is None or plain >= _FAULTLESS * wanted:
                break
            if not number and not plain:  # perhaps off the grid, or by other lenses
                rng = generator(filming.seed, shot.drawn_as, "off the grid")
                beside = nudged(draw(shot, len(stories), int(_MORE * wanted), rng), rng, free)
                consider(replace(beside, reach=np.ones(len(beside.reach))))
                best = _best(batches) or best
            rng = generator(filming.seed, shot.drawn_as, f"beside the best {number}")
            consider(near(best.only(np.resize(np.arange(len(best.story)), int(_MORE * wanted))), rng))
    chosen = _choose(batches, wanted)
    let_in = [batches[b].reason[p] for b, p in chosen if batches[b].reason[p] >= 0]
    rejected.subtract(REASONS[k] for k in let_in)
    cameras = tuple(_proposal(i, batches[b], p, shot) for i, (b, p) in enumerate(chosen))
    counts = {k: v for k, v in sorted(rejected.items()) if v > 0}
    return ProposalGrid(shot.id, name, tuple(stories), cameras, considered, counts, len(let_in))


def _soft(batch: _Batch) -> NDArray[np.bool_]:
    """Which candidates [P] may be let back in where hardly anything else is left: of what they are about, at
    least a little is seen."""
    return np.asarray(
        OFFERED[batch.reason] & (batch.reason >= 0) & (batch.measured.values["visibility"] > _GLIMPSE)
    )


def _good(batches: Sequence[_Batch]) -> int:
    """How many candidates there are that are not thrown out."""
    return sum(int((b.reason < 0).sum()) for b in batches)


def _faultless(batches: Sequence[_Batch]) -> int:
    """How many of these have no fault either."""
    return sum(int(((b.reason < 0) & (b.faults == 0)).sum()) for b in batches)


def _best(batches: Sequence[_Batch]) -> Sample | None:
    """What was drawn for the best candidates there are, least faults first, or where none is good for those
    that only look less well; None where there are none of these either."""
    kept = [np.flatnonzero(b.reason < 0) for b in batches]
    if not sum(len(rows) for rows in kept):
        kept = [np.flatnonzero(_soft(b)) for b in batches]
    if not sum(len(rows) for rows in kept):
        return None
    faults = np.concatenate([b.faults[rows] for b, rows in zip(batches, kept, strict=True)])
    scores = np.concatenate([b.scores[rows] for b, rows in zip(batches, kept, strict=True)])
    drawn = put_together([b.sample.only(rows) for b, rows in zip(batches, kept, strict=True)])
    return drawn.only(np.lexsort((-scores, faults))[:_BEST])


def _consider(
    shot: Shot,
    stories: Sequence[StoryProposal],
    subjects: Sequence[Subject],
    stages: Sequence[Stage],
    filming: Filming,
    sample: Sample,
    rejected: Counter[str],
    lacking: int,
) -> list[_Batch]:
    """Shoot, measure and judge candidates; counts those to be thrown out in ``rejected``.

    lacking: how many good ones there have to be that none is let back in
    """
    out: list[_Batch] = []
    for s, subject in enumerate(subjects):
        rows = np.flatnonzero(sample.story == s)
        if not len(rows):
            continue
        left = lacking - _good(out)
        tried = try_cameras(shot, stories[s], subject, stages[s], filming, sample, rows, left)
        rejected.update(REASONS[k] for k in np.delete(tried.reason, tried.kept))
        if tried.measured is None:
            continue
        shooting, values = tried.shooting.only(tried.kept), tried.measured.values
        reason, drawn = tried.reason[tried.kept], sample.only(rows[shooting.order])
        faults = np.sum(list(gravity(values).values()), axis=0)
        scores = geometry_scores(values)
        out.append(_Batch(drawn, shooting, tried.window, tried.measured, scores, reason, faults))
        rejected.update(REASONS[k] for k in reason[reason >= 0])
    return out


@dataclass(frozen=True, eq=False)
class Tried:
    """Candidates of one story looked at.

    reason: [P] index into REASONS, −1 for the good ones; kept: those that have room
    measured: those alone, None where there are none; in full those that are good, and while too few are those
        that may be let back in
    window: the sampled frames in which those that have room are meant to show their subject
    """

    shooting: Shooting
    reason: NDArray[np.int64]
    kept: NDArray[np.int64]
    measured: Measured | None
    window: NDArray[np.bool_]


def try_cameras(
    shot: Shot,
    story: StoryProposal,
    subject: Subject,
    stage: Stage,
    filming: Filming,
    sample: Sample,
    rows: NDArray[np.int64],
    lacking: int = _FEW,
) -> Tried:
    """Shoot the sampled rows on one story; what has room is measured and judged.

    lacking: with how many good ones nothing will be let back in
    """
    shooting = shoot(shot, subject, sample, rows, filming.rig, filming.sensor, filming.fps)
    foci = foci_of(shot, subject, story, filming)
    shooting = focused(shooting, shot, foci, filming.fps)
    solids, at = filming.world.solids, samples(subject.frames)
    near = nearby(solids, shooting.track.position[:, at])
    reason = no_room(shooting, near, solids, stage, at)
    kept = np.flatnonzero(reason < 0)
    if not len(kept):
        return Tried(shooting, reason, kept, None, np.zeros((0, len(at)), bool))
    left = shooting.only(kept)
    window = left.window(at, subject)
    takes = _takes(shot, subject, left.track, left.scales, window, left.key, story, filming)
    takes = replace(takes, near=near.only(kept))

    def hopeful(first: Measured) -> NDArray[np.bool_]:
        """Note why each is thrown out; of what may be offered after all, all is to be measured."""
        found = reason[kept] = reasons(left, first, subject)
        enough = foci.end is None and (found < 0).sum() >= lacking  # of a rack some are still to go
        return found < 0 if enough else OFFERED[found]

    measured = measure(takes, subject, filming.world, filming.fps, hopeful)
    if foci.end is not None:
        held = held_by(shot, subject, story, filming, foci)
        lost = unseen_racks(left, foci, held, solids, measured.hidden, at)
        soft = OFFERED[reason[kept]]  # else they might be let back in
        reason[kept[lost & soft]] = REASONS.index("wrong_movement")
    return Tried(shooting, reason, kept, measured, window)


def measured_anew(
    shot: Shot,
    story: StoryProposal,
    filming: Filming,
    cameras: Sequence[CameraProposal],
    pictures: Pictures | None = None,
) -> list[CameraProposal]:
    """Cameras of one story with the measures and the hidden walls of the tracks they have now, whatever was
    done to these since they were proposed. pictures: what they show, if they were drawn"""
    if not cameras:
        return []
    subject, tracks = subject_of(shot, story, filming), [c.track for c in cameras]
    track = CameraTrack(
        np.stack([t.position for t in tracks]),
        np.stack([t.rotation for t in tracks]),
        np.stack([t.focal for t in tracks]),
        np.stack([t.look_at for t in tracks]),
        tracks[0].sensor,
    )
    window, key = np.stack([c.window for c in cameras]), np.array([c.key for c in cameras])
    takes = _takes(shot, subject, track, tuple(c.scale for c in cameras), window, key, story, filming)
    found = measure(replace(takes, pictures=pictures), subject, filming.world, filming.fps)
    scores = geometry_scores(found.values)
    return [
        replace(
            camera,
            hidden_walls=found.hidden[p],
            measures={k: float(v[p]) for k, v in found.values.items()} | {"geometry": float(scores[p])},
        )
        for p, camera in enumerate(cameras)
    ]


def _takes(
    shot: Shot,
    subject: Subject,
    track: CameraTrack,
    scales: Sequence[str],
    window: NDArray[np.bool_],
    key: NDArray[np.int64],
    story: StoryProposal,
    filming: Filming,
) -> Takes:
    sizes: tuple[Size, ...] = tuple(size_of(subject.kind, s) for s in scales)
    ignore = None
    if subject.kind == "thing" and shot.focus is not None:
        item = find_object(filming.world, shot.focus)
        ignore = item.id if item is not None else None
    others = company_of(shot, story, filming, subject)
    return Takes(
        track,
        sizes,
        window,
        key,
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
    faults = np.concatenate([b.faults for b in batches])
    plain = faults == 0
    pool = np.flatnonzero(reason < 0)
    if len(pool) < min(_FEW, wanted):
        soft = np.flatnonzero(np.concatenate([_soft(b) for b in batches]))
        soft = soft[np.lexsort((-scores[soft], faults[soft]))]
        pool = np.concatenate([pool, soft[: min(_FEW, wanted) - len(pool)]])
    keys = np.stack(
        [
            np.concatenate([b.sample.azimuth for b in batches]),
            np.concatenate([b.sample.story for b in batches]),
            np.concatenate([b.sample.movement for b in batches]),
            np.concatenate([b.shooting.strata for b in batches]),
        ],
        axis=1,
    )[pool]
    picked: list[int] = []
    taken = np.zeros(len(pool), bool)
    counts = [np.zeros(keys[:, k].max() + 1 if len(keys) else 1) for k in range(keys.shape[1])]
    for _ in range(min(wanted, len(pool))):
        crowd = sum(c[keys[:, k]] for k, c in enumerate(counts)) - 1.5 * scores[pool] - _PLAIN * plain[pool]
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
        story=int(batch.sample.story[row]),
        movement=batch.shooting.movements[row],
        scale=batch.shooting.scales[row],
        angle=batch.shooting.angles[row],
        params=batch.shooting.params(row, shot.roll),
        track=track.only(row),
        hidden_walls=batch.measured.hidden[row],
        unseen=shot.whose[0] if shot.view == "pov" and shot.whose else "",
        measures=values,
        window=batch.window[row],
        key=int(batch.shooting.key[row]),
    )
