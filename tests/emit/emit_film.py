"""A small made-up film for the tests of vdsl.emit: flat pictures, straight tracks."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from vdsl.cinema.continuity import Finding
from vdsl.cinema.track import CameraTrack
from vdsl.emit.types import CUT, Build, BuiltShot, BuiltTake, CutFinding, Subject, Trade, Walk
from vdsl.emit.video import write_take
from vdsl.lang.ir import Beat, Character, Scene, Shot, Storyboard, StoryLine, Target, Transition
from vdsl.lang.source import Source, Span
from vdsl.propose.promise import Achieved
from vdsl.propose.types import Advice, CameraProposal

SIZE, FPS = (128, 72), (24, 1)
SPAN = Span(Source("story.vds", "x"), 0, 1)


def pictures(count: int, shade: int) -> Iterator[np.ndarray]:
    """Frames of one colour with a bar that grows, so that order can be told."""
    for i in range(count):
        frame = np.full((SIZE[1], SIZE[0], 3), shade, np.uint8)
        frame[60:, : 4 * (i + 1)] = (250, 250, 250)
        yield frame


def shot(name: str, say: str | None = None, note: str | None = None) -> Shot:
    target = Target("character", ("anna",), "anna", SPAN)
    return Shot(
        name, 4, ("push", "pull"), ("medium",), ("eye-level",), (35.0, 80.0), (1.0,), None, 0.0, target, say,
        note, 80, 2, 1.0, "board", SPAN,
    )  # fmt: skip


def line(*beats: tuple[str, ...]) -> StoryLine:
    made = []
    for name, action, *rest in beats:
        targets = [Target("object", (r,), r, SPAN) for r in rest] + [None, None]
        made.append(Beat(name, action, targets[0], targets[1], SPAN))
    return StoryLine(0, tuple(made), (), CUT, SPAN)


def track(frames: int) -> CameraTrack:
    t = np.linspace(0, 1, frames)
    position = np.stack([1 + t / 3, -2 * t, np.full(frames, 1.6)], -1)
    rotation = np.stack([np.zeros(frames), -0.1 * t, np.pi / 3 + t], -1)
    return CameraTrack(position, rotation, np.full(frames, 50.0), np.zeros((frames, 3)), (36.0, 20.25))


def take(folder: Path, name: str, rank: int, frames: int, shade: int) -> BuiltTake:
    measures = {"visibility": 0.98, "headroom": float("nan"), "clearance": 1 / 3}
    camera = CameraProposal(
        7 * rank, rank - 1, "push", "medium", "eye-level", {"r": 1 / 3, "lambda": 10.0, "easing": "slow-in"},
        track(frames), np.zeros(0, bool), measures=measures,
    )  # fmt: skip
    subject = Subject("anna", 1.68, np.zeros((frames, 3)))
    media = write_take(folder, name, rank, pictures(frames, shade), frames, FPS)
    way = np.stack([np.linspace(0, 2, frames), np.full(frames, 0.5), np.zeros(frames)], -1)
    people = (
        Walk("anna", way, np.zeros(frames), way + np.array([0, 0, 1.5])),
        Walk("ben", way[:1].repeat(frames, 0) + 1, np.ones(frames), way[:1].repeat(frames, 0) + 1.5),
    )
    achieved = Achieved("push", "medium", "eye-level")
    return BuiltTake(rank, 0.9 - rank / 10, camera, "calm", subject, media, achieved, 1.5, people=people)


def built(
    folder: Path,
    name: str,
    frames: int = 12,
    shade: int = 90,
    transition: Transition = CUT,
    story: StoryLine | None = None,
    takes: int = 2,
    **said: str,
) -> BuiltShot:
    story = story or line(("anna", "walk", "counter"))
    made = tuple(take(folder, name, k + 1, frames, shade) for k in range(takes))
    return BuiltShot(
        shot(name, **said),
        story,
        "kitchen",
        transition,
        made,
        4,
        20,
        80,
        {"wall": 5, "hidden": 2},
        Advice("the hall is 1.2 m wide", ("medium", "lens 24mm")),
    )


def crossing(before: str, after: str) -> CutFinding:
    """The first cut, over the line."""
    found = Finding("line", 41.2, {"before": 30.0, "after": -41.2}, "crosses the line by 41° (anna–ben)")
    return CutFinding((before, after), (1, 2), found)


def film(
    shots: Sequence[BuiltShot],
    title: str = "Morning coffee",
    continuity: tuple[CutFinding, ...] = (),
    trades: tuple[Trade, ...] = (),
) -> Build:
    scene = Scene("kitchen", "apartment", ("kitchen",), "day", (), SPAN)
    anna = Character("anna", "woman", (), SPAN)
    board = Storyboard(title, FPS, SIZE, 7, "cinema", "board", (anna,), (scene,), (), "story.vds")
    return Build(board, tuple(shots), continuity=continuity, edited=bool(trades), trades=trades)
