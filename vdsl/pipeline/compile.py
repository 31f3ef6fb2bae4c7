"""The whole job: a ``.vds`` file in, ranked moving shots out.

The order of the passes is the order of :func:`compile_file`. Assumes nothing of the file; guarantees
that a script with errors writes nothing, and that a build folder holds a whole result or the last one.
"""

from __future__ import annotations

import resource
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from ..emit.build import write_build
from ..emit.burnin import BurnIn
from ..emit.folder import staged_build
from ..emit.report_json import write_report
from ..emit.types import CUT, Build, BuiltShot, BuiltTake, RunReport, Stage, Subject, TakeMedia
from ..emit.video import write_take
from ..lang import Report, Source, Span
from ..lang.diagnostics import listing
from ..lang.ir import Shot, Storyboard, StoryLine
from ..propose.cameras import Filming, subject_of
from ..propose.promise import achieved
from ..propose.state import SceneState, opening_state
from ..propose.story import advance, propose
from ..propose.types import CameraProposal, ProposalGrid, StoryProposal
from ..stage.assemble import StagedScene
from ..stage.models import check_models
from .edit import CANDIDATES, Edited, Reel, candidates, cut_findings, edited
from .filming import Camerawork
from .judging import DiscriminatorJudge, GeometryJudge, Judge
from .options import Options
from .progress import Progress, Silence, StageClock
from .script import Checked, ScriptError, load_storyboard
from .selection import choose_takes
from .staging import Stagehand
from .witness import Vetted, vet

#: Proposals drawn and judged at a time: bounds memory, and lets progress be seen.
_JUDGED_AT_ONCE = 16
_UNITS = {"stage": "lines", "propose": "proposals", "draw": "frames", "rank": "shots", "film": "frames"}


@dataclass(frozen=True, eq=False)
class Result:
    """What a compilation gave. warnings: found on the way; folder: where the build is; report: timings."""

    folder: Path
    build: Build
    warnings: Report
    report: RunReport


@dataclass(frozen=True, eq=False)
class Act:
    """A story line with the scene it plays in and the state it starts from."""

    line: StoryLine
    staged: StagedScene
    filming: Filming
    state: SceneState


def compile_file(
    path: str | Path,
    out: str | Path | None = None,
    options: Options | None = None,
    progress: Progress | None = None,
) -> Result:
    """Compile a script into a build folder (default ``build/<name>``).

    Raises :class:`~vdsl.pipeline.script.ScriptError` for a script with errors, OSError for a disk that
    refuses, :class:`ranker.RankerError` for weights that cannot be used.
    """
    started = perf_counter()
    options = options or Options()
    clock = StageClock(progress or Silence())
    path = Path(path)
    folder = Path(out) if out is not None else Path("build") / path.stem
    with clock.spent("check", 1, quiet=True):
        checked = _with_something_to_film(load_storyboard(path, options.settings))
    with staged_build(folder) as staging:
        acts = _stage_all(checked, clock)
        build = _film_all(checked.storyboard, acts, _judge(options, clock), options, staging, clock)
        _warn_of_poor_shots(build.shots, checked.report)
        with clock.spent("write", len(build.shots), quiet=True):
            write_build(staging, build)
        report = _report(perf_counter() - started, clock, options, tuple(t.text for t in build.trades))
        write_report(staging / "report.json", report)
    return Result(folder, build, checked.report, report)


def _stage_all(checked: Checked, clock: StageClock) -> list[Act]:
    lines = len(checked.storyboard.lines)
    clock.begin("stage", lines, _UNITS["stage"])
    with clock.spent("stage", lines, quiet=True):
        return stage_acts(checked, played=lambda seconds: clock.watcher.advance("stage", 1, seconds))


def _with_something_to_film(checked: Checked) -> Checked:
    """The storyboard, or ScriptError where there is no line in it."""
    if not checked.storyboard.lines:
        checked.report.error(
            "VDS191",
            Span(Source(checked.storyboard.source_name, ""), 0, 0),
            label="this file tells no story",
            help="add a scene and a line such as `(anna wave)`",
        )
        raise ScriptError(checked.report)
    return checked


def stage_acts(
    checked: Checked, hand: Stagehand | None = None, played: Callable[[float], None] = lambda seconds: None
) -> list[Act]:
    """Every line in its scene with its opening state. Raises ScriptError for what cannot be played.

    hand: one that has built sets and bodies before; played: told of every line, with the seconds it took
    """
    storyboard, report = checked.storyboard, checked.report
    check_models(checked.catalog, report)
    if report.has_errors:
        raise ScriptError(report)
    hand = hand or Stagehand(checked.catalog)
    acts: list[Act] = []
    for number, scene in enumerate(storyboard.scenes):
        lines = [line for line in storyboard.lines if line.scene == number]
        if not lines:
            continue
        staged = hand.stage(scene, storyboard.characters, lines)
        skeletons = {name: body.skeleton for name, body in staged.bodies.items()}
        filming = Filming(
            staged.world,
            skeletons,
            storyboard.fps[0] / storyboard.fps[1],
            storyboard.seed,
            storyboard.rig,
            storyboard.size[0] / storyboard.size[1],
            scene.room,
            checked.catalog,
        )
        state = opening_state(scene, staged.world, skeletons, report)
        for line in lines:
            begun = perf_counter()
            acts.append(Act(line, staged, filming, state))
            state = advance(state, line, checked.catalog, filming, report)
            played(perf_counter() - begun)
    if report.has_errors:
        raise ScriptError(report)
    order = {id(line): i for i, line in enumerate(storyboard.lines)}
    return sorted(acts, key=lambda act: order[id(act.line)])


def _judge(options: Options, clock: StageClock) -> Judge:
    if options.rank == "geometry":
        return GeometryJudge()
    with clock.spent("load", 1, quiet=True):
        return DiscriminatorJudge(options.weights, options.device)


def _film_all(
    storyboard: Storyboard, acts: list[Act], judge: Judge, options: Options, folder: Path, clock: StageClock
) -> Build:
    """Propose, judge and film every shot, in order; one line's proposals are in memory at a time."""
    camerawork = Camerawork(options.device)
    plan = _edit(acts, judge, camerawork, clock) if options.edit else None
    reel, film, start = Reel(), list[BuiltShot](), 0
    joined: StoryLine | None = None  # the first shot of a line that has a take joins it to the last line
    for act, shot, grid in _proposed(acts, clock):
        scores = plan.scores[shot.id] if plan else _scores(grid, act, shot, judge, camerawork, clock)
        count = CANDIDATES if plan else shot.takes
        vetted = _vetted(grid, scores, count, act, shot, camerawork, clock)
        chosen = plan.takes[shot.id] if plan else choose_takes(grid.cameras, vetted.order, shot.takes)
        grid = vetted.counted(grid, chosen)
        reel.add(act.line, shot, grid, scores, chosen[:1], act.filming)
        run = (storyboard, options, folder, start)
        takes = tuple(
            _film(rank, i, scores, grid, act, shot, judge, camerawork, run, clock)
            for rank, i in enumerate(chosen, start=1)
        )
        film.append(_built(grid, act.line, shot, storyboard, takes, first=joined is not act.line))
        joined = act.line if takes else joined
        start += film[-1].frames
    continuity = cut_findings(reel.slots, [0] * len(reel.slots))
    trades = plan.trades if plan else ()
    return Build(storyboard, tuple(film), judge.name, continuity, options.edit, trades)


def _edit(acts: list[Act], judge: Judge, camerawork: Camerawork, clock: StageClock) -> Edited:
    """Propose and judge every shot, and choose takes for the sequence; only scores and edges are kept."""
    reel, scores, takes = Reel(), dict[str, NDArray[np.float64]](), dict[str, list[int]]()
    for act, shot, grid in _proposed(acts, clock):
        scores[shot.id] = found = _scores(grid, act, shot, judge, camerawork, clock)
        vetted = _vetted(grid, found, CANDIDATES, act, shot, camerawork, clock)
        takes[shot.id] = choose_takes(grid.cameras, vetted.order, shot.takes)
        some = candidates(grid.cameras, vetted.order, shot.takes, vetted.failed)
        reel.add(act.line, shot, grid, found, some, act.filming)
    with clock.spent("edit", len(reel.slots), quiet=True):
        return edited(reel.slots, scores, takes)


def _proposed(acts: list[Act], clock: StageClock) -> Iterator[tuple[Act, Shot, ProposalGrid]]:
    """Every shot in order, with what is proposed for it."""
    shots = [(act, shot) for act in acts for shot in act.line.shots]
    clock.begin("propose", sum(s.proposals for _, s in shots), _UNITS["propose"])
    for act, shot in shots:
        with clock.spent("propose", shot.proposals):
            grid = propose(act.line, shot, act.state, act.filming, advised=True)
        yield act, shot, grid


def _scores(
    grid: ProposalGrid, act: Act, shot: Shot, judge: Judge, camerawork: Camerawork, clock: StageClock
) -> NDArray[np.float64]:
    """The judge's score of every proposal of a shot, [P]."""
    if not judge.looks or not grid.cameras:
        return judge.scores(grid.cameras, None) if grid.cameras else np.zeros(0)
    count = len(grid.cameras)
    clock.begin("draw", 8 * count, _UNITS["draw"])
    clock.begin("rank", count, _UNITS["rank"])
    parts = []
    for begin in range(0, count, _JUDGED_AT_ONCE):
        cameras = grid.cameras[begin : begin + _JUDGED_AT_ONCE]
        with clock.spent("draw", 8 * len(cameras)):
            frames = camerawork.judge_frames(act.staged, shot.style, grid.story, cameras)
        with clock.spent("rank", len(cameras)):
            parts.append(judge.scores(cameras, frames))
    return np.concatenate(parts)


def _vetted(
    grid: ProposalGrid,
    scores: NDArray[np.float64],
    count: int,
    act: Act,
    shot: Shot,
    camerawork: Camerawork,
    clock: StageClock,
) -> Vetted:
    """The proposals that may be kept, looked at in small pictures."""
    with clock.spent("vet", 1, quiet=True):
        return vet(grid, scores, count, (act.staged, shot, act.filming), camerawork)


def _film(
    rank: int,
    chosen: int,
    scores: NDArray[np.float64],
    grid: ProposalGrid,
    act: Act,
    shot: Shot,
    judge: Judge,
    camerawork: Camerawork,
    run: tuple[Storyboard, Options, Path, int],
    clock: StageClock,
) -> BuiltTake:
    """Draw and encode one take."""
    storyboard, options, folder, start = run
    camera = grid.cameras[chosen]
    story = next(s for s in grid.story if s.index == camera.story)
    strip = None
    if options.burn_in:
        strip = BurnIn(shot.id, rank, camera.movement, storyboard.fps, camera.track.focal, start)
    clock.begin("film", story.frames, _UNITS["film"])
    with clock.spent("film", story.frames):
        frames = camerawork.take_frames(act.staged, shot.style, story, camera, storyboard.size)
        media: TakeMedia = write_take(folder, shot.id, rank, frames, story.frames, storyboard.fps, strip)
    score = float(scores[chosen])
    return BuiltTake(
        rank,
        score,
        camera,
        story.variant,
        _subject(grid, act, story),
        media,
        achieved(camera, subject_of(shot, story, act.filming), act.filming.rig),
        judge.logit(camera, score),
    )


def _subject(grid: ProposalGrid, act: Act, story: StoryProposal) -> Subject | None:
    if grid.subject is None:
        return None
    height = act.staged.bodies[grid.subject].skeleton.height
    return Subject(grid.subject, height, story.performances[grid.subject].position)


def _built(
    grid: ProposalGrid,
    line: StoryLine,
    shot: Shot,
    storyboard: Storyboard,
    takes: tuple[BuiltTake, ...],
    first: bool,
) -> BuiltShot:
    return BuiltShot(
        shot=shot,
        line=line,
        scene=storyboard.scenes[line.scene].name,
        transition=line.transition if first else CUT,
        takes=takes,
        story_proposals=len(grid.story),
        camera_proposals=_cameras_each(grid.cameras),
        proposals=len(grid.cameras),
        rejected=grid.rejected,
        advice=grid.advice,
    )


def _cameras_each(cameras: tuple[CameraProposal, ...]) -> int:
    """The most cameras any one story proposal was given: the paper's C."""
    counts = np.bincount([c.story for c in cameras]) if cameras else np.zeros(1, int)
    return int(counts.max())


def _warn_of_poor_shots(shots: tuple[BuiltShot, ...], report: Report) -> None:
    for built in shots:
        if built.advice is None and built.takes:
            continue
        reasons = ", ".join(f"{n} {why.replace('_', ' ')}" for why, n in built.rejected.items())
        why = built.advice.why if built.advice else ""
        instead = built.advice.instead if built.advice else ()
        report.warn(
            "VDS192" if built.takes else "VDS190",
            built.shot.span,
            label="; ".join(part for part in (why, f"rejected: {reasons}" if reasons else "") if part),
            help=f"try {listing(f'`{words}`' for words in instead)}"
            if instead
            else "no other size, angle or lens helps here: try another place, or another focus",
        )


def _report(seconds: float, clock: StageClock, options: Options, notes: tuple[str, ...]) -> RunReport:
    stages = tuple(
        Stage(name, spent, clock.units.get(name, 0), _UNITS.get(name, ""))
        for name, spent in clock.seconds.items()
    )
    return RunReport(seconds, stages, peak_mib=peak_mib(), device=options.device, notes=notes)


def peak_mib() -> float:
    """Peak resident memory of this process so far, MiB."""
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak / (1024 * 1024) if sys.platform == "darwin" else peak / 1024
