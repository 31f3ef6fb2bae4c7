"""How fast the stages are on this machine, measured on a real script.

Every figure is the median of a few repetitions after one that warms up kernels and caches; the whole
compilation runs once, as its own process, as a user would start it.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from statistics import median
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from ranker.guides import joined
from runtime.video import write_video

from ..propose.story import propose
from ..propose.types import CameraProposal, ProposalGrid
from .compile import Act, stage_acts
from .filming import SEGMENTS, Camerawork, Seen
from .glance import Scored, Screening
from .guides import about_of
from .judging import DiscriminatorJudge
from .progress import Silence, StageClock
from .script import load_storyboard

SCHEMA = "vds.bench/1"
_REPEATS = 3
_SHOTS = 4  # shots of the script that the single stages are measured on
_SIZE = (1280, 720)
_JUDGED = 48  # proposals of each of those shots that are drawn for the judge


@dataclass(frozen=True)
class Figures:
    """Rates per second, seconds, and MiB; None for what was not measured."""

    proposals_per_s: float
    rank_frames_per_s: float
    render_720p_per_s: float
    render_encode_720p_per_s: float
    ranked_shots_per_s: float | None
    chosen_from_per_s: float | None
    check_seconds: float
    demo_seconds: float | None
    demo_peak_mib: float | None

    def document(self) -> dict[str, float | str | None]:
        return {"schema": SCHEMA, **asdict(self)}


def measure(
    script: Path, device: str = "auto", whole: bool = True, said: Callable[[str], None] = lambda what: None
) -> Figures:
    """Measure every stage on ``script``; ``said`` hears what is being measured. See :class:`Figures`."""
    said("vdsc check")
    check_seconds = median(_command_seconds("check", str(script)) for _ in range(_REPEATS))
    checked = load_storyboard(script)
    acts = [a for a in stage_acts(checked) if a.line.beats][:_SHOTS]
    said("proposals")
    proposals, grids = _proposals(acts)
    camerawork = Camerawork(device)
    said("frames for ranking")
    rank_frames, seen = _rank_frames(acts, grids, camerawork)
    said("frames at 720p")
    render, encoded = _takes(acts, grids, camerawork)
    said("the discriminator")
    judge = _judge(device)
    shots = _ranked(judge, tuple(c for g in grids for c in g.cameras[:_JUDGED]), seen) if judge else None
    chosen = _chosen(judge, acts, grids, camerawork) if judge else None
    seconds, peak = None, None
    if whole:
        said("a whole compilation")
        seconds, peak = _whole(script, device)
    return Figures(proposals, rank_frames, render, encoded, shots, chosen, check_seconds, seconds, peak)


def _rate(work: Callable[[], int]) -> float:
    """Units per second: the median of a few runs after one to warm up."""
    work()
    rates = []
    for _ in range(_REPEATS):
        start = perf_counter()
        count = work()
        rates.append(count / (perf_counter() - start))
    return median(rates)


def _proposals(acts: list[Act]) -> tuple[float, list[ProposalGrid]]:
    grids: list[ProposalGrid] = []

    def work() -> int:
        grids.clear()
        for act in acts:
            grids.append(propose(act.line, act.line.shots[0], act.state, act.filming))
        return sum(len(g.cameras) for g in grids)

    return _rate(work), grids


def _rank_frames(acts: list[Act], grids: list[ProposalGrid], camerawork: Camerawork) -> tuple[float, Seen]:
    """A line at a time, as in a compilation; loading the scene is part of it."""
    drawn: list[Seen] = []

    def work() -> int:
        drawn.clear()
        for act, grid in zip(acts, grids, strict=True):
            cameras, shot = grid.cameras[:_JUDGED], act.line.shots[0]
            about = [about_of(shot, grid, act.filming, act.staged)] * len(cameras)
            drawn.append(camerawork.judge_frames(act.staged, "board", grid.story, cameras, about=about))
        return SEGMENTS * sum(len(d.frames) for d in drawn)

    rate = _rate(work)
    guides = joined([d.guides for d in drawn if d.guides is not None])
    return rate, Seen(np.concatenate([d.frames for d in drawn]), guides)


def _takes(acts: list[Act], grids: list[ProposalGrid], camerawork: Camerawork) -> tuple[float, float]:
    def frames(k: int) -> Iterator[NDArray[np.uint8]]:
        grid = grids[k]
        story = next(s for s in grid.story if s.index == grid.cameras[0].story)
        short = replace(story, frames=min(story.frames, 48))
        return camerawork.take_frames(acts[k].staged, "board", short, grid.cameras[0], _SIZE)

    def render() -> int:
        return sum(1 for k in range(len(acts)) for _ in frames(k))

    def encode() -> int:
        with tempfile.TemporaryDirectory() as folder:
            return sum(write_video(Path(folder) / f"{k}.mp4", frames(k), (24, 1)) for k in range(len(acts)))

    return _rate(render), _rate(encode)


def _judge(device: str) -> DiscriminatorJudge | None:
    from ranker import RankerError

    try:
        return DiscriminatorJudge(None, device)
    except RankerError:
        return None


def _ranked(judge: DiscriminatorJudge, cameras: tuple[CameraProposal, ...], seen: Seen) -> float:
    """Full looks alone, at frames drawn before."""
    some = Seen(seen.frames[:32], None if seen.guides is None else seen.guides[:32])

    def work() -> int:
        judge.scores(cameras[:32], some)
        return len(some.frames)

    return _rate(work)


def _chosen(
    judge: DiscriminatorJudge, acts: list[Act], grids: list[ProposalGrid], camerawork: Camerawork
) -> float:
    """All it takes to find the best proposals of a line: drawing, a glance at all, full looks at some."""

    def work() -> int:
        for act, grid in zip(acts, grids, strict=True):
            shot, clock = act.line.shots[0], StageClock(Silence())
            screening = Screening(act.staged, shot, act.filming, grid, camerawork, lambda: judge, clock)
            Scored.of(screening).look_at_best()
        return sum(len(grid.cameras) for grid in grids)

    return _rate(work)


def _command(*arguments: str) -> list[str]:
    return [sys.executable, "-c", "from vdsl.cli import main; main()", *arguments]


def _command_seconds(*arguments: str) -> float:
    start = perf_counter()
    subprocess.run(_command(*arguments), stdout=subprocess.DEVNULL, check=True)
    return perf_counter() - start


def _whole(script: Path, device: str) -> tuple[float, float]:
    """Seconds and peak resident MiB of one ``vdsc compile``."""
    with tempfile.TemporaryDirectory() as folder:
        out = str(Path(folder) / "out")
        start = perf_counter()
        child = subprocess.Popen(
            _command("compile", str(script), "-o", out, "--device", device), stdout=subprocess.DEVNULL
        )
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
        if child.returncode != 0:
            raise RuntimeError(f"vdsc compile ended with {child.returncode}")
        return perf_counter() - start, usage.ru_maxrss / 1024
