"""The whole job: a ``.vds`` file in, ranked moving shots out.

The order of the passes is the order of :func:`compile_file`. Assumes nothing of the file; guarantees
that a script with errors writes nothing, that a build folder holds a whole result or the last one, and that
what earlier runs kept gives the same build as making everything anew.
"""

from __future__ import annotations

import resource
import sys
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import partial
from itertools import islice
from pathlib import Path
from time import perf_counter

from runtime.video import FRAMES_WAITING
from runtime.worker import Worker

from ..emit.build import write_build
from ..emit.folder import staged_build
from ..emit.plan_ground import Ground, ground_of
from ..emit.report_json import write_report
from ..emit.timeline import start_of_next
from ..emit.types import CUT, Build, BuiltShot, BuiltTake, RunReport, Stage
from ..lang import Report, Settings, Source, Span
from ..lang.diagnostics import listing
from ..lang.ir import Shot, StoryLine, Transition
from ..propose.cameras import subject_of
from ..propose.promise import achieved
from ..propose.story import propose
from ..propose.types import ProposalGrid
from .acts import Act, Acts, Warm, stage_acts
from .cache import Cache
from .chosen import Choices, find_again, made_with
from .depends import digest, shot_digests
from .edit import Edited, Reel, cut_findings, edited
from .filming import Camerawork
from .further import wishes, with_further, write_wishes
from .glance import Screening
from .judging import DiscriminatorJudge, GeometryJudge, Judge
from .keys import code_digest, judge_digest
from .letters import warn_of_letters
from .lock import Choice, lock_path, read_lock
from .options import Options, options_document
from .packing import PackError, pack, unpack
from .parts import kept_parts
from .placing import find
from .progress import Progress, Silence, StageClock
from .project import project_of
from .script import Checked, ScriptError, load_storyboard
from .shooting import UNITS, Judged, Kept, Run, Shooting
from .tasting import digest_of, taste_of
from .turns import one_at_a_time

#: Proposals looked at to get ready.
_TRIED = 16

__all__ = ["Act", "Result", "Workshop", "compile_file", "peak_mib", "stage_acts"]


@dataclass(frozen=True, eq=False)
class Result:
    """What a compilation gave. warnings: found on the way; folder: where the build is; report: timings.

    further: how many takes were wanted of the shots of which there were to be further ones
    """

    folder: Path
    build: Build
    warnings: Report
    report: RunReport
    further: dict[str, int] = field(default_factory=dict)


@dataclass(eq=False)
class Workshop:
    """What a process keeps ready from one compilation to the next: renderers, the judge, staged scenes, and
    the proposals made last."""

    warm: Warm = field(default_factory=Warm)
    grids: dict[str, ProposalGrid] = field(default_factory=dict)
    _cameras: dict[str, Camerawork] = field(default_factory=dict)
    _judges: dict[tuple[str, str], Judge] = field(default_factory=dict)

    def camerawork(self, device: str) -> Camerawork:
        return self._cameras.setdefault(device, Camerawork(device))

    def judge(self, options: Options, clock: StageClock) -> Judge:
        """Loaded when somebody first has to judge. Raises :class:`ranker.RankerError`."""
        if options.rank == "geometry":
            return GeometryJudge()
        key = (judge_digest(options), options.device)
        if key not in self._judges:
            with clock.spent("load", 1, quiet=True):
                self._judges[key] = DiscriminatorJudge(options.weights, options.device, options.taste)
        return self._judges[key]


def compile_file(
    path: str | Path,
    out: str | Path | None = None,
    options: Options | None = None,
    progress: Progress | None = None,
    workshop: Workshop | None = None,
    finish: Callable[[Path, Result], None] = lambda stage, result: None,
) -> Result:
    """Compile a script into a build folder (default ``build/<name>``).

    workshop: kept from compilations before; finish: called with the whole build before it is put in its place
    Raises :class:`~vdsl.pipeline.script.ScriptError` for a script or a lock with errors, OSError for a disk
    that refuses, :class:`ranker.RankerError` for weights that cannot be used.
    """
    started = perf_counter()
    path, workshop = Path(path), workshop or Workshop()
    options = with_taste(options or Options(), path)
    clock = StageClock(progress or Silence())
    folder = Path(out) if out is not None else Path("build") / path.stem
    cache = Cache(kept=options.cache)
    with clock.spent("check", 1, quiet=True):
        checked, choices = _checked(path, options)
        warn_of_letters(checked.storyboard, checked.report)
    with staged_build(folder, one_at_a_time) as staging, Worker(FRAMES_WAITING) as worker:
        known = wishes(folder, choices.depends)
        wanted = with_further(known, options.further, checked.storyboard, choices.depends)
        if options.further:  # else they are carried over as they are by then
            write_wishes(staging, wanted)
        acts = _played(checked, cache, workshop, clock)
        run = Run(
            checked.storyboard,
            options,
            staging,
            acts,
            cache,
            workshop.camerawork(options.device),
            partial(workshop.judge, options, clock),
            clock,
            worker,
            {shot: wish.takes for shot, wish in wanted.items()},
            workshop.grids,
        )
        build = _Filming(run, choices).build()
        _warn_of_poor_shots(build.shots, checked.report)
        with clock.spent("write", len(build.shots), quiet=True):
            write_build(staging, build, kept_parts(cache), worker.wait)
        report = _report(perf_counter() - started, clock, run, tuple(t.text for t in build.trades))
        write_report(staging / "report.json", report)
        asked = {shot: wanted[shot].takes for shot in options.further if shot in wanted}
        result = Result(folder, build, checked.report, report, asked)
        finish(staging, result)
    cache.tidy()
    return result


def prepare(path: Path, options: Options, workshop: Workshop) -> None:
    """Have ready what compiling a changed script takes: its scenes, a renderer, the judge.

    Raises what :func:`compile_file` raises.
    """
    clock = StageClock(Silence())
    options = with_taste(options, path)
    checked, _ = _checked(path, options)
    acts = _played(checked, Cache(kept=options.cache), workshop, clock)
    camerawork = workshop.camerawork(options.device)
    for line in checked.storyboard.lines:
        act = acts.act(line)
        for shot in line.shots[:1]:
            grid = propose(line, replace(shot, proposals=_TRIED), act.state, act.filming)
            for camera in grid.cameras[:1]:
                story = next(s for s in grid.story if s.index == camera.story)
                size = checked.storyboard.size
                for _ in islice(camerawork.take_frames(act.staged, shot.style, story, camera, size), 1):
                    camerawork.judge_ids(act.staged, shot.style, grid.story, (camera,), (96, 54))
                achieved(camera, subject_of(shot, story, act.filming), act.filming.rig)
            if grid.cameras and options.rank != "geometry":
                judge = partial(workshop.judge, options, clock)
                looks = Screening(act.staged, shot, act.filming, grid, camerawork, judge, clock)
                for glance in (looks.judge().glances, None):
                    looks.look(range(len(grid.cameras)), glance)
        break
    workshop.judge(options, clock)


def with_taste(options: Options, script: Path) -> Options:
    """The options with the taste found with a script, where none is given and pictures are judged."""
    if options.taste is not None or options.rank == "geometry":
        return options
    return replace(options, taste=taste_of(script))


def _checked(path: Path, options: Options) -> tuple[Checked, Choices]:
    """The storyboard and what is chosen for it; ScriptError where there is no line in it."""
    lock = read_lock(lock_path(path))
    defaults = project_of(path).settings
    defaults.complete(Settings(seed=lock.seed))
    checked = load_storyboard(path, options.settings, defaults)
    if not checked.storyboard.lines:
        checked.report.error(
            "VDS191",
            Span(Source(checked.storyboard.source_name, ""), 0, 0),
            label="this file tells no story",
            help="add a scene and a line such as `(anna wave)`",
        )
        raise ScriptError(checked.report)
    depends = shot_digests(checked.storyboard, checked.catalog)
    return checked, Choices(lock, depends, checked.report)


def _played(checked: Checked, cache: Cache, workshop: Workshop, clock: StageClock) -> Acts:
    lines = len(checked.storyboard.lines)
    clock.begin("stage", lines, UNITS["stage"])
    with clock.spent("stage", lines, quiet=True):
        acts = Acts(
            checked,
            cache,
            code_digest(),
            warm=workshop.warm,
            played=lambda seconds: clock.watcher.advance("stage", 1, seconds),
        )
        acts.play()
    return acts


class _Filming:
    """Judges and films all shots in their order."""

    def __init__(self, run: Run, choices: Choices) -> None:
        self.run, self.choices = run, choices
        self.crew = Shooting(run)
        self._quick: Shooting | None = None
        if run.options.draft:
            quick = replace(run.options, rank="geometry", edit=False)
            self._quick = Shooting(replace(run, options=quick, judge=GeometryJudge, further={}))

    def build(self) -> Build:
        """The whole film, its takes in the run's folder."""
        run, board = self.run, self.run.storyboard
        plan = self._edit() if run.options.edit and self._quick is None else None
        reel, film, waiting = Reel(), list[BuiltShot](), 0
        joined: StoryLine | None = None  # the first shot of a line that has a take joins it to the last line
        for line, shot in [(each, shot) for each in board.lines for shot in each.shots]:
            transition = CUT if joined is line else line.transition
            crew, judged = self._judged(line, shot)
            picked = self._picked(crew, line, shot, judged)
            order = [i for i in (plan.takes[shot.id] if plan else judged.takes) if i in judged.kept]
            shown = [(crew, judged.kept[i]) for i in order]
            if picked is not None:
                shown = [picked, *(s for s in shown if s[1].key != picked[1].key)]
                shown = shown[: max(shot.takes, len(judged.takes))]
            if shown:
                best = shown[0][1]
                reel.add(line, shot, [best.camera.index], [best.score], [best.ends])
            else:
                reel.add(line, shot, [], [], [])
            start = partial(start_of_next, tuple(film), transition)
            takes = self._takes(line, shot, shown, picked is not None, lambda n, s=start: s(n, board.fps))  # type: ignore[misc]
            waiting += len(takes) < len(shown) and self._quick is None
            rejected = judged.rejected_for(order)
            film.append(self._built(line, shot, judged, takes, rejected, transition))
            joined = line if takes else joined
        by_lines = run.options.rank == "geometry"
        taste = None if by_lines else run.options.taste
        return Build(
            board,
            tuple(film),
            GeometryJudge.name if by_lines else DiscriminatorJudge.name,
            cut_findings(reel.slots, [0] * len(reel.slots)),
            run.options.edit,
            plan.trades if plan else (),
            made_with(),
            any(take.media.sketched for shot in film for take in shot.takes),
            waiting,
            grounds=self._grounds(),
            arrows=run.options.arrows,
            taste=digest_of(taste) if taste is not None else None,
        )

    def _judged(self, line: StoryLine, shot: Shot) -> tuple[Shooting, Judged]:
        """A shot's proposals in order; in a draft in the order of their geometry, where no other is known."""
        if self._quick is None:
            return self.crew, self.crew.judged(line, shot)
        known = self.crew.judged_before(line, shot)
        if known is not None:
            return self.crew, known
        return self._quick, self._quick.judged(line, replace(shot, takes=1))

    def _edit(self) -> Edited:
        """Judge every shot, and choose takes for the sequence; one that somebody chose stays."""
        reel, takes = Reel(), dict[str, list[int]]()
        for line in self.run.storyboard.lines:
            for shot in line.shots:
                judged = self.crew.judged(line, shot)
                picked = self._picked(self.crew, line, shot, judged)
                some = [picked[1]] if picked else [judged.kept[i] for i in judged.some]
                places = [0] if picked else judged.some
                reel.add(line, shot, places, [k.score for k in some], [k.ends for k in some])
                takes[shot.id] = list(judged.takes)
        with self.run.clock.spent("edit", len(reel.slots), quiet=True):
            return edited(reel.slots, takes)

    # -- what somebody chose -------------------------------------------------------------------

    def _picked(
        self, crew: Shooting, line: StoryLine, shot: Shot, judged: Judged
    ) -> tuple[Shooting, Kept] | None:
        """The chosen take of a shot, and who films it; None where none is chosen, or it is lost."""
        choice = self.choices.of(shot)
        if choice is None:
            return None
        at = find(choice, judged.keys)
        if at is not None:
            kept = judged.kept.get(at) or crew.one(line, shot, choice.key, lambda grid: at)
            if kept is not None:
                return crew, kept
        elif self.choices.same_line(shot, choice):
            found = self._proposed_again(crew, line, shot, choice)
            if found is not None:
                return found
        self.choices.lost(shot, choice)
        return None

    def _proposed_again(
        self, crew: Shooting, line: StoryLine, shot: Shot, choice: Choice
    ) -> tuple[Shooting, Kept] | None:
        """A choice among as many proposals, with the seed and under the id, as when it was chosen.

        What it was drawn under then is certain where the shot has the same id and no name of its own.
        """
        surely = shot.id == choice.shot and not shot.drawn
        other = crew if choice.seed == self.run.storyboard.seed else Shooting(crew.run, choice.seed)
        for drawn in dict.fromkeys((shot.drawn_as, choice.shot)):
            as_chosen = replace(shot, proposals=choice.proposals, drawn=drawn)
            kept = other.one(line, as_chosen, choice.key, lambda grid: find_again(choice, grid, surely))
            if kept is not None:
                return other, kept
        return None

    # -- filming -------------------------------------------------------------------------------

    def _takes(
        self,
        line: StoryLine,
        shot: Shot,
        shown: list[tuple[Shooting, Kept]],
        picked: bool,
        start: Callable[[int], int],
    ) -> tuple[BuiltTake, ...]:
        """The takes of a shot, best first; in a draft a still of the best one, if any has no film yet, or
        its judge has not chosen.

        Where first takes are wanted, of a shot with films still to be made the first one alone.
        """
        quick = self._quick is not None or self.run.options.firsts
        if quick and not all(
            crew is not self._quick and crew.film_is_kept(line, shot, kept) for crew, kept in shown
        ):
            if self._quick is not None:
                crew, kept = shown[0]
                return (crew.sketch(line, shot, kept, picked),)
            shown = shown[:1]
        return tuple(
            crew.film(line, shot, kept, rank, picked and rank == 1, start)
            for rank, (crew, kept) in enumerate(shown, start=1)
        )

    def _built(
        self,
        line: StoryLine,
        shot: Shot,
        judged: Judged,
        takes: tuple[BuiltTake, ...],
        rejected: dict[str, int],
        transition: Transition,
    ) -> BuiltShot:
        return BuiltShot(
            shot=shot,
            line=line,
            scene=self.run.storyboard.scenes[line.scene].name,
            transition=transition,
            takes=takes,
            story_proposals=judged.story_proposals,
            camera_proposals=judged.camera_proposals,
            proposals=len(judged.keys),
            rejected=rejected,
            advice=judged.advice,
            depends=self.choices.depends[shot.id],
        )

    def _grounds(self) -> tuple[Ground, ...]:
        """Every scene's place from above, for plans; of a scene in which nothing happens an empty one."""
        out = []
        for number, scene in enumerate(self.run.storyboard.scenes):
            found = self.run.acts.scene(number)
            if found is None:
                out.append(Ground(scene.name, "", (0, 0, 5, 5), (), (), ()))
                continue
            text, staged = found
            key = digest("ground", code_digest(), text, scene.name)
            ground = _read_ground(self.run.cache.read(key))
            if ground is None:
                ground = ground_of(staged().world, scene.room, scene.name)
                self.run.cache.put(key, {"value": pack(ground)})
            out.append(ground)
        return tuple(out)


def _read_ground(data: bytes | None) -> Ground | None:
    try:
        found = unpack(data) if data is not None else None
    except PackError:
        return None
    return found if isinstance(found, Ground) else None


def _warn_of_poor_shots(shots: tuple[BuiltShot, ...], report: Report) -> None:
    for built in shots:
        if built.advice is None and built.takes:
            continue
        reasons = ", ".join(f"{n} {why.replace('_', ' ')}" for why, n in built.rejected.items())
        why = built.advice.why if built.advice else ""
        instead = built.advice.instead if built.advice else ()
        faulty = built.advice is not None and built.advice.faulty
        counted = f"rejected: {reasons}" if reasons and not faulty else ""
        label = "; ".join(part for part in (why, counted) if part)
        report.warn(
            "VDS193" if faulty else "VDS192" if built.takes else "VDS190",
            built.shot.span,
            label=f"no take is without a fault; in most {label}" if faulty else label,
            help=f"try {listing(f'`{words}`' for words in instead)}"
            if instead
            else "no other size, angle or lens helps here: try another place, or another focus",
        )


def _report(seconds: float, clock: StageClock, run: Run, notes: tuple[str, ...]) -> RunReport:
    stages = tuple(
        Stage(name, spent, clock.units.get(name, 0), UNITS.get(name, ""))
        for name, spent in clock.seconds.items()
    )
    cache, device = run.cache, run.options.device
    said = options_document(run.options)
    return RunReport(seconds, stages, cache.hits, cache.misses, peak_mib(), device, notes, said)


def peak_mib() -> float:
    """Peak resident memory of this process so far, MiB."""
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak / (1024 * 1024) if sys.platform == "darwin" else peak / 1024
