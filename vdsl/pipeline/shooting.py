"""Shots judged and filmed, or taken from what earlier runs kept: proposals, scores, takes and their films.

Assumes lines that are played (:mod:`vdsl.pipeline.acts`). Guarantees the same results whether they were kept
or are made now; nothing is staged, proposed, drawn or judged where all that is wanted was kept. One shot's
proposals are in memory at a time.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from runtime.body.skeleton import JOINT
from runtime.worker import Worker

from ..emit.burnin import BurnIn
from ..emit.stills import read_keys, write_keys, write_stills
from ..emit.types import BuiltTake, Subject, TakeMedia, Walk
from ..emit.video import take_paths, write_take
from ..lang.ir import Shot, Storyboard, StoryLine
from ..propose.cameras import subject_of
from ..propose.promise import Achieved, achieved
from ..propose.story import propose
from ..propose.types import Advice, CameraProposal, Performance, ProposalGrid, StoryProposal
from .acts import Act, Acts
from .cache import Cache
from .chosen import keys_of
from .depends import digest, shot_text
from .edit import CANDIDATES, Ends, candidates, ends_of
from .filming import Camerawork
from .glance import Scored, Screening
from .judging import Judge, Opinion
from .keys import code_digest, judge_digest, options_digest
from .options import Options
from .packing import PackError, pack, unpack
from .progress import StageClock
from .selection import choose_takes, further_takes
from .witness import best, counted, vet

T = TypeVar("T")
UNITS = {"stage": "lines", "propose": "proposals", "draw": "frames", "rank": "frames", "film": "frames"}
_KEYS = "keys.png"


@dataclass(frozen=True, eq=False)
class Kept:
    """All that is known of a proposal that may be shown, but its pictures.

    frames: its length; people: everybody in the scene; ends: as a cut sees it
    proposals, drawn: of the shot as it was proposed
    """

    key: str
    score: float
    camera: CameraProposal
    variant: str
    path: int
    frames: int
    subject: Subject | None
    achieved: Achieved
    opinion: Opinion
    people: tuple[Walk, ...]
    ends: Ends
    proposals: int
    drawn: str


#: Shots whose proposals are kept ready at a time.
_GRIDS = 2


@dataclass(frozen=True, eq=False)
class Judged:
    """A shot proposed, judged and looked at.

    takes: indices of the proposals that are kept, best first; some: of those an edit chooses from
    failed: of those that do not do, why; kept: all about takes and some, by index
    keys: of all proposals; rejected: before the failed ones were counted
    story_proposals, camera_proposals: S and C
    """

    takes: tuple[int, ...]
    some: tuple[int, ...]
    failed: dict[int, str]
    kept: dict[int, Kept]
    keys: tuple[str, ...]
    rejected: dict[str, int]
    story_proposals: int
    camera_proposals: int
    advice: Advice | None

    def rejected_for(self, shown: Sequence[int]) -> dict[str, int]:
        """What was rejected, where these are shown."""
        return counted(self.rejected, self.failed, shown)


@dataclass(frozen=True, eq=False)
class Run:
    """What shots are made with. judge: asked for when somebody has to judge

    worker: encodes films beside all else; a film is in the folder once its work is done
    further: how many takes are wanted in all of shots of which there are to be more, by their ids
    grids: proposals made last, by their keys; they may go from one run to the next
    """

    storyboard: Storyboard
    options: Options
    folder: Path
    acts: Acts
    cache: Cache
    camerawork: Camerawork
    judge: Callable[[], Judge]
    clock: StageClock
    worker: Worker
    further: Mapping[str, int] = field(default_factory=dict)
    grids: dict[str, ProposalGrid] = field(default_factory=dict)


class Shooting:
    """Judges and films the shots of a run. seed: another than the storyboard's, for takes chosen with it"""

    def __init__(self, run: Run, seed: int | None = None) -> None:
        self.run = run
        self.seed = run.storyboard.seed if seed is None else seed
        self._options = options_digest(run.options)
        self._judge = judge_digest(run.options)

    # -- judging -------------------------------------------------------------------------------

    def judged(self, line: StoryLine, shot: Shot) -> Judged:
        """The shot's proposals in order, with the further takes that are wanted of it."""
        found = self._judged_once(self._judged_key(line, shot), lambda: self._judged_now(line, shot))
        more = self._more(shot)
        if not more:
            return found
        key = self._further_key(line, shot)
        return self._judged_once(key, lambda: self._further_now(line, shot, found, more))

    def judged_before(self, line: StoryLine, shot: Shot) -> Judged | None:
        """The same where it was kept, else None."""
        key = self._further_key(line, shot) if self._more(shot) else self._judged_key(line, shot)
        return self._read(key, Judged)

    def _judged_once(self, key: str, judge: Callable[[], Judged]) -> Judged:
        found = self._read(key, Judged)
        if found is None:
            found = judge()
            self._keep(key, found)
        return found

    def _more(self, shot: Shot) -> int:
        """How many takes are wanted beyond what the shot asks for."""
        return max(0, self.run.further.get(shot.id, 0) - shot.takes)

    def one(
        self, line: StoryLine, shot: Shot, chosen: str, find: Callable[[ProposalGrid], int | None]
    ) -> Kept | None:
        """Of the shot as it is given, the proposal that was chosen by its key and is found by somebody."""
        key = digest("one", self._base(line, shot), self._judge, shot.proposals, chosen)
        kept = self._read(key, Kept)
        if kept is None:
            grid = self._proposed(line, shot)
            at = find(grid)
            if at is None:
                return None
            act = self._act(line)
            kept = self._kept(line, shot, act, grid, self._scores(grid, act, line, shot), (at,))[at]
            self._keep(key, kept)
        return kept

    def _act(self, line: StoryLine) -> Act:
        act = self.run.acts.act(line)
        if act.filming.seed == self.seed:
            return act
        return replace(act, filming=replace(act.filming, seed=self.seed))

    def _judged_now(self, line: StoryLine, shot: Shot) -> Judged:
        act, grid = self._act(line), self._proposed(line, shot)
        scores = self._scores(grid, act, line, shot)
        scores.look_at_best()
        edit, scene = self.run.options.edit, (act.staged, shot, act.filming)
        count = CANDIDATES if edit else shot.takes
        while True:  # until all that is kept was looked at in full
            with self.run.clock.spent("vet", 1, quiet=True):
                vetted = vet(grid, scores.order, best(grid, count), scene, self.run.camerawork)
            takes = choose_takes(grid.cameras, vetted.order, shot.takes)
            failed = tuple(vetted.failed)
            some = candidates(grid.cameras, vetted.order, shot.takes, failed) if edit else takes[:1]
            indices = tuple(dict.fromkeys((*takes, *some)))
            if not scores.look(indices):
                break
        self._keep_scores(line, shot, scores)
        return Judged(
            tuple(takes),
            tuple(some),
            vetted.failed,
            self._kept(line, shot, act, grid, scores, indices),
            tuple(keys_of(grid)),
            dict(grid.rejected),
            len(grid.story),
            _cameras_each(grid.cameras),
            grid.advice,
        )

    def _further_now(self, line: StoryLine, shot: Shot, known: Judged, count: int) -> Judged:
        """What is known of a shot, with up to so many further takes behind those that it has: the next best
        that look like none before them, and are what their line says."""
        act, grid = self._act(line), self._proposed(line, shot)
        scores, scene = self._scores(grid, act, line, shot), (act.staged, shot, act.filming)
        scores.look_at_best()

        def chosen(order: NDArray[np.float64], failed: Collection[int]) -> list[int]:
            return further_takes(grid.cameras, order, known.takes, {*known.failed, *failed}, count)

        while True:  # until all that is kept was looked at in full
            with self.run.clock.spent("vet", 1, quiet=True):
                vetted = vet(grid, scores.order, chosen, scene, self.run.camerawork)
            found = chosen(vetted.order, vetted.failed)
            if not scores.look(found):
                break
        kept = self._kept(line, shot, act, grid, scores, found)
        return replace(
            known,
            takes=(*known.takes, *found),
            failed={**known.failed, **vetted.failed},
            kept={**known.kept, **kept},
        )

    def _proposed(self, line: StoryLine, shot: Shot) -> ProposalGrid:
        key, grids = digest(self._base(line, shot), shot.proposals), self.run.grids
        if key not in grids:
            self.run.clock.begin("propose", shot.proposals, UNITS["propose"])
            act = self._act(line)
            with self.run.clock.spent("propose", shot.proposals):
                made = propose(line, shot, act.state, act.filming, advised=True)
            if len(grids) >= _GRIDS:  # those of one shot are asked for several times, one after the other
                grids.clear()
            grids[key] = made
        return grids[key]

    def _scores(self, grid: ProposalGrid, act: Act, line: StoryLine, shot: Shot) -> Scored:
        """The judge's scores of the proposals of a shot; of those not looked at before by a glance."""
        if not grid.cameras or self.run.options.rank == "geometry":
            some = self.run.judge().scores(grid.cameras, None) if grid.cameras else np.zeros(0)
            return Scored.full(some, grid.cameras)
        run = self.run
        screening = Screening(act.staged, shot, act.filming, grid, run.camerawork, run.judge, run.clock)
        found = self._read(self._scores_key(line, shot), dict)
        if found is not None and len(found["first"]) == len(grid.cameras):
            return Scored(lambda: found["first"], screening.look, found["known"], found["measures"])
        return Scored.of(screening)

    def _keep_scores(self, line: StoryLine, shot: Shot, scores: Scored) -> None:
        if self.run.options.rank != "geometry" and len(scores.first):
            known = {"first": scores.first, "known": scores.known, "measures": scores.measures}
            self._keep(self._scores_key(line, shot), known)

    def _kept(
        self,
        line: StoryLine,
        shot: Shot,
        act: Act,
        grid: ProposalGrid,
        scores: Scored,
        indices: Sequence[int],
    ) -> dict[int, Kept]:
        """What is known of some proposals, which are looked at in full."""
        scores.look(indices)
        stories = {s.index: s for s in grid.story}
        keys, ends = keys_of(grid), ends_of(line, shot, grid, indices, act.filming)
        judge = self.run.judge
        out = {}
        for i, edge in zip(indices, ends, strict=True):
            camera = grid.cameras[i]  # with what vetting noted, which a full look does not measure
            camera = replace(camera, measures={**camera.measures, **scores.measures[i]})
            story, score = stories[camera.story], scores.known[i]
            out[i] = Kept(
                keys[i],
                score,
                camera,
                story.variant,
                story.path,
                story.frames,
                _subject(grid, act, story),
                achieved(camera, subject_of(shot, story, act.filming), act.filming.rig),
                judge().opinion(camera, score),
                tuple(walk_of(name, way) for name, way in story.performances.items()),
                edge,
                shot.proposals,
                shot.drawn_as,
            )
        return out

    # -- filming -------------------------------------------------------------------------------

    def film(
        self, line: StoryLine, shot: Shot, kept: Kept, rank: int, chosen: bool, start: Callable[[int], int]
    ) -> BuiltTake:
        """A take with its film and still in the build's folder, once the run's worker is done.

        start: gives the take's first frame in the film by its length; asked where that is in the picture
        """
        strip = None
        if self.run.options.burn_in:
            camera, fps = kept.camera, self.run.storyboard.fps
            strip = BurnIn(shot.id, rank, camera.movement, fps, camera.track.focal, start(kept.frames))
        media = self._filmed(line, shot, kept, rank, strip)
        return _take(kept, rank, media, chosen)

    def film_is_kept(self, line: StoryLine, shot: Shot, kept: Kept) -> bool:
        """Whether a take's film need not be made; never where its place in the film is in the picture."""
        return not self.run.options.burn_in and self.run.cache.has(self._film_key(line, shot, kept, None))

    def _filmed(self, line: StoryLine, shot: Shot, kept: Kept, rank: int, strip: BurnIn | None) -> TakeMedia:
        """The files of a take, which may still be in the making."""
        folder, cache = self.run.folder, self.run.cache
        video, poster, _ = take_paths(folder, shot.id, rank)
        keys = folder / "shots" / shot.id / f".{rank}-{_KEYS}"
        key = self._film_key(line, shot, kept, strip)
        if not cache.take(key, {"take.mp4": video, "take.jpg": poster, _KEYS: keys}):
            self.run.clock.begin("film", kept.frames, UNITS["film"])

            def keep(media: TakeMedia) -> None:
                write_keys(keys, media.keys)
                cache.put(key, {"take.mp4": video, "take.jpg": poster, _KEYS: keys})
                keys.unlink()

            with self.run.clock.spent("film", kept.frames):  # told only when it is sure to be kept
                media = self._draw(line, shot, kept, rank, strip, keep)
            return replace(media, keys=media.keys if rank == 1 else ())
        shown = read_keys(keys) if rank == 1 else ()
        keys.unlink()
        return TakeMedia(video, poster, kept.frames, shown)

    def _draw(
        self,
        line: StoryLine,
        shot: Shot,
        kept: Kept,
        rank: int,
        strip: BurnIn | None,
        keep: Callable[[TakeMedia], None],
    ) -> TakeMedia:
        """Draw one take; it is encoded and kept while the next one is drawn."""
        run, act = self.run, self.run.acts.act(line)
        story = self._story(line, shot, kept)
        size, fps = run.storyboard.size, run.storyboard.fps
        frames = run.camerawork.take_frames(
            act.staged, shot.style, story, kept.camera, size, run.options.shutter
        )
        return write_take(
            run.folder,
            shot.id,
            rank,
            frames,
            story.frames,
            fps,
            strip,
            run.options.guides,
            keyed=True,
            worker=run.worker,
            finished=keep,
        )

    def sketch(self, line: StoryLine, shot: Shot, kept: Kept, chosen: bool) -> BuiltTake:
        """A take as three pictures, without a film."""
        run, act = self.run, self.run.acts.act(line)
        story = self._story(line, shot, kept)
        with run.clock.spent("sketch", 1, quiet=True):
            media = write_stills(
                run.folder,
                shot.id,
                story.frames,
                lambda at: run.camerawork.frames_at(
                    act.staged, shot.style, story, kept.camera, run.storyboard.size, at
                ),
                run.options.guides,
            )
        return _take(kept, 1, media, chosen)

    def _story(self, line: StoryLine, shot: Shot, kept: Kept) -> StoryProposal:
        """The performance a take is filmed of."""
        as_proposed = replace(shot, proposals=kept.proposals, drawn=kept.drawn)
        grid = self._proposed(line, as_proposed)
        return next(s for s in grid.story if s.index == kept.camera.story)

    # -- keys ----------------------------------------------------------------------------------

    def _base(self, line: StoryLine, shot: Shot) -> str:
        seen = self.run.acts.seen(line)
        return digest(code_digest(), self._options, seen, shot_text(shot), shot.drawn_as, self.seed)

    def _scores_key(self, line: StoryLine, shot: Shot) -> str:
        return digest("scores", self._base(line, shot), self._judge, shot.proposals)

    def _judged_key(self, line: StoryLine, shot: Shot) -> str:
        how = (self._judge, shot.proposals, shot.takes, self.run.options.edit)
        return digest("judged", self._base(line, shot), how)

    def _further_key(self, line: StoryLine, shot: Shot) -> str:
        return digest("further", self._judged_key(line, shot), self._more(shot))

    def _film_key(self, line: StoryLine, shot: Shot, kept: Kept, strip: BurnIn | None) -> str:
        camera = replace(kept.camera, index=0, measures={})
        marks = [shot.id, strip.take, strip.start] if strip is not None else []
        seen = (self.run.options.guides, self.run.options.shutter)
        track = digest(pack(camera).hex())
        return digest("film", self._base(line, shot), track, kept.variant, kept.path, marks, seen)

    def _read(self, key: str, kind: type[T]) -> T | None:
        data = self.run.cache.read(key)
        if data is None:
            return None
        try:
            value = unpack(data)
        except PackError:
            return None
        return value if isinstance(value, kind) else None

    def _keep(self, key: str, value: object) -> None:
        with suppress(PackError):  # what cannot be kept is made again
            self.run.cache.put(key, {"value": pack(value)})


def _take(kept: Kept, rank: int, media: TakeMedia, chosen: bool) -> BuiltTake:
    return BuiltTake(
        rank,
        kept.score,
        kept.camera,
        kept.variant,
        kept.subject,
        media,
        kept.achieved,
        kept.opinion.logit,
        kept.opinion.taste,
        kept.key,
        chosen,
        kept.people,
    )


def walk_of(name: str, way: Performance) -> Walk:
    """Where somebody goes in a performance."""
    head = way.world_from_joint[:, JOINT["head"], :3, 3].astype(np.float64)
    return Walk(name, way.position, way.heading, head)


def _subject(grid: ProposalGrid, act: Act, story: StoryProposal) -> Subject | None:
    if grid.subject is None:
        return None
    height = act.staged.bodies[grid.subject].skeleton.height
    return Subject(grid.subject, height, story.performances[grid.subject].position)


def _cameras_each(cameras: tuple[CameraProposal, ...]) -> int:
    """The most cameras any one story proposal was given: the paper's C."""
    counts = np.bincount([c.story for c in cameras]) if cameras else np.zeros(1, int)
    return int(counts.max())
