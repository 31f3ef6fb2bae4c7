"""How fast pictures are drawn on this machine: against OpenGL on the same processor, and in numbers.

Works on the first story line of a script that a camera can film. What is compared is drawn in turns in one
run, so that a busy machine slows both: believe ratios before rates. A rate is the median of its turns.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass, replace
from functools import partial
from pathlib import Path
from statistics import median
from time import perf_counter, process_time
from typing import Any

import numpy as np
from numpy.typing import NDArray

from runtime.mesh import join
from runtime.raster.renderer import Renderer
from runtime.raster.types import STYLES, Camera, RenderScene, Views
from runtime.video import write_video

from ..propose.story import propose
from ..propose.types import CameraProposal, StoryProposal
from .acts import Act, stage_acts
from .filming import Camerawork, not_drawn, story_palettes
from .llvmpipe import LlvmpipeDrawer, NoOpenGLError
from .script import load_storyboard
from .steadiness import panned, steadiness

SCHEMA = "vds.bench-render/1"
LARGE, SMALL = (1280, 720), (224, 224)
_LARGE_FRAMES, _SMALL_FRAMES = 12, 64
_BEHIND = 400.0  # metres behind the camera at which triangles are out of every frame

Turn = Callable[[], int]
Said = Callable[[str], None]


@dataclass(frozen=True)
class Row:
    """One line of the table. value: in ``unit``; busy_ms: processor time a frame, where that says something;
    ratio: to the same drawn by OpenGL; None for what was not measured"""

    key: str
    what: str
    unit: str
    value: float | None
    busy_ms: float | None = None
    ratio: float | None = None


@dataclass(frozen=True)
class RenderFigures:
    """The table. rival: what OpenGL says it draws with, or why it does not; triangles: of the scene"""

    rows: tuple[Row, ...]
    rival: str
    triangles: int

    def document(self) -> dict[str, Any]:
        rows = {row.key: {k: v for k, v in asdict(row).items() if k != "key"} for row in self.rows}
        return {"schema": SCHEMA, "triangles": self.triangles, "rival": self.rival, "rows": rows}


@dataclass(frozen=True, eq=False)
class Case:
    """A take to draw: moments of a scene and the cameras that look at them, one for each frame."""

    scene: RenderScene
    palettes: NDArray[np.float32]
    views: Views

    def only(self, count: int) -> Case:
        """The first ``count`` frames, over and over where there are fewer."""
        index = np.arange(count) % len(self.views.moment)
        camera = self.views.camera
        some = replace(
            camera,
            position=camera.position[index],
            axes=camera.axes[index],
            focal=camera.focal[index],
            focus=None,
            aperture=0.0,
        )
        return replace(self, views=Views(some, self.views.moment[index], self.views.hidden[index]))

    def held(self) -> Case:
        """The same with a camera that stays as it is in the first frame."""
        camera, still = self.views.camera, np.zeros(len(self.views.moment), int)
        held = replace(
            camera,
            position=camera.position[still],
            axes=camera.axes[still],
            focal=camera.focal[still],
        )
        return replace(self, views=replace(self.views, camera=held))


def measure_render(
    script: Path, device: str = "auto", seconds: float = 4.0, said: Said = lambda what: None
) -> RenderFigures:
    """Measure on ``script``; seconds: for each thing compared. Raises as a compilation does."""
    act, story, moving, fixed = filmable(script)
    cases = {"moving": case_of(act, story, moving), "fixed": case_of(act, story, fixed)}
    said("plain shading against OpenGL")
    rows, rival = _against_opengl(cases["moving"], device, seconds)
    said("the board style")
    rows += _board(cases, device, seconds)
    said("encoding")
    rows += _encoded(act, story, moving, device, seconds)
    said("what frames and triangles cost")
    rows += _growth(cases["moving"], device, seconds)
    said("steadiness")
    rows.append(_steady(cases["fixed"], device))
    said("start-up")
    rows += _start_up(device)
    scene = cases["moving"].scene
    return RenderFigures(tuple(rows), rival, len(scene.static.faces) + len(scene.skinned.faces))


def filmable(script: Path) -> tuple[Act, StoryProposal, CameraProposal, CameraProposal]:
    """The first line with people that can be filmed, with the proposal whose camera moves most and least."""
    for act in stage_acts(load_storyboard(script)):
        if not act.line.beats or not act.line.shots:
            continue
        grid = propose(act.line, act.line.shots[0], act.state, act.filming)
        if not grid.cameras:
            continue
        story = next(s for s in grid.story if s.index == grid.cameras[0].story)
        cameras = sorted((c for c in grid.cameras if c.story == story.index), key=_travel)
        return act, story, cameras[-1], cameras[0]
    raise ValueError(f"{script}: no line in it can be filmed")


def _travel(camera: CameraProposal) -> float:
    return float(np.ptp(camera.track.position, axis=0).sum() + np.ptp(camera.track.rotation, axis=0).sum())


def case_of(act: Act, story: StoryProposal, camera: CameraProposal) -> Case:
    frames = np.arange(min(story.frames, _SMALL_FRAMES))
    hidden = np.repeat(not_drawn(act.staged, camera)[None], len(frames), axis=0)
    track = camera.track
    poses = Camera(
        track.position[frames].astype(np.float32),
        track.axes[frames].astype(np.float32),
        track.focal[frames].astype(np.float32),
        track.sensor,
    )
    views = Views(poses, np.arange(len(frames), dtype=np.int32), hidden)
    return Case(act.staged.render, story_palettes(act.staged, story, frames), views)


def in_turns(turns: dict[str, Turn], seconds: float) -> dict[str, tuple[float, float]]:
    """Frames a second and milliseconds of processor a frame of each, taking turns after one to warm up."""
    found: dict[str, list[tuple[float, float]]] = {name: [] for name in turns}
    for turn in turns.values():
        turn()
    until = perf_counter() + seconds
    while perf_counter() < until or len(next(iter(found.values()))) < 3:
        for name, turn in turns.items():
            wall, busy = perf_counter(), process_time()
            count = turn()
            found[name].append((count / (perf_counter() - wall), (process_time() - busy) / count * 1000))
    return {name: (median(r for r, _ in got), median(b for _, b in got)) for name, got in found.items()}


def _ours(drawer: Renderer, case: Case, size: tuple[int, int]) -> Turn:
    return lambda: len(drawer.render(case.palettes, case.views, size).color)


def _theirs(drawer: LlvmpipeDrawer, case: Case, size: tuple[int, int]) -> int:
    return sum(1 for _ in drawer.sheets(case.views, size))


def _one_by_one(drawer: Renderer, case: Case, size: tuple[int, int]) -> Turn:
    camera, none = case.views.camera, np.zeros(1, np.int32)
    singles = []
    for k, moment in enumerate(case.views.moment):
        at = slice(k, k + 1)
        pose = replace(camera, position=camera.position[at], axes=camera.axes[at], focal=camera.focal[at])
        singles.append((case.palettes[moment : moment + 1], Views(pose, none, case.views.hidden[at])))
    return lambda: sum(len(drawer.render(moment, view, size).color) for moment, view in singles)


def _against_opengl(case: Case, device: str, seconds: float) -> tuple[list[Row], str]:
    """Plain smooth shading at 720p, and at 224 x 224 one by one and in batches."""
    drawer = Renderer(device, STYLES["plain"])
    drawer.load(case.scene)
    rival: LlvmpipeDrawer | None = None
    try:
        rival = LlvmpipeDrawer(case.scene, STYLES["plain"], case.palettes)
        name = rival.name
    except NoOpenGLError as error:  # the rest can be measured
        name = f"not measured ({error})"
    rows = []
    large, small = case.only(_LARGE_FRAMES), case.only(_SMALL_FRAMES)
    for key, what, some, size, batch in (
        ("plain_720p", "plain, 1280 x 720", large, LARGE, True),
        ("plain_224_single", "plain, 224 x 224, one by one", small, SMALL, False),
        ("plain_224_batch", "plain, 224 x 224, in batches", small, SMALL, True),
    ):
        turns = {"ours": (_ours if batch else _one_by_one)(drawer, some, size)}
        if rival is not None:
            turns["theirs"] = partial(_theirs, rival, some, size)
        found = in_turns(turns, seconds)
        ours, theirs = found["ours"], found.get("theirs")
        rows.append(Row(key, what, "frames/s", *ours, ours[0] / theirs[0] if theirs else None))
        if theirs:
            rows.append(Row(f"opengl_{key}", "  the same by OpenGL, one by one", "frames/s", *theirs))
    return rows, name


def _board(cases: dict[str, Case], device: str, seconds: float) -> list[Row]:
    drawer = Renderer(device, STYLES["board"])
    drawer.load(cases["moving"].scene)
    turns = {
        "board_720p": _ours(drawer, cases["moving"].only(_LARGE_FRAMES), LARGE),
        "board_720p_fixed": _ours(drawer, cases["moving"].only(_LARGE_FRAMES).held(), LARGE),
        "board_224": _ours(drawer, cases["moving"].only(_SMALL_FRAMES), SMALL),
    }
    names = {
        "board_720p": "board, 1280 x 720, moving camera",
        "board_720p_fixed": "board, 1280 x 720, fixed camera",
        "board_224": "board, 224 x 224, in batches",
    }
    found = in_turns(turns, 3 * seconds)
    return [Row(key, names[key], "frames/s", *found[key]) for key in turns]


def _encoded(
    act: Act, story: StoryProposal, camera: CameraProposal, device: str, seconds: float
) -> list[Row]:
    """A take as it is filmed: acted, drawn, read back and encoded at once."""
    camerawork = Camerawork(device)
    short = replace(story, frames=min(story.frames, 48))

    def frames() -> Iterator[NDArray[np.uint8]]:
        return camerawork.take_frames(act.staged, "board", short, camera, LARGE)

    with tempfile.TemporaryDirectory() as folder:
        turns = {
            "drawn": lambda: sum(1 for _ in frames()),
            "encoded": lambda: write_video(Path(folder) / "take.mp4", frames(), (24, 1)),
        }
        found = in_turns(turns, 2 * seconds)
    return [
        Row("take_720p", "a take, acted and drawn", "frames/s", *found["drawn"]),
        Row("take_720p_encoded", "a take, acted, drawn and encoded", "frames/s", *found["encoded"]),
    ]


def _growth(case: Case, device: str, seconds: float) -> list[Row]:
    """What more frames and triangles outside the frame cost."""
    plain, crowded = (Renderer(device, STYLES["board"]) for _ in range(2))
    plain.load(case.scene)
    crowded.load(_crowded(case))
    few, many = case.only(_SMALL_FRAMES // 8), case.only(_SMALL_FRAMES)
    found = in_turns(
        {
            "few": _ours(plain, few, SMALL),
            "many": _ours(plain, many, SMALL),
            "crowded": _ours(crowded, many, SMALL),
        },
        seconds,
    )
    longer = found["few"][0] / found["many"][0]
    larger = found["many"][0] / found["crowded"][0]
    return [
        Row("frames_8_times", "time a frame, of 64 against of 8 frames", "times", longer),
        Row("outside_4_times", "time a frame, with the set again 3 times outside", "times", larger),
    ]


def _crowded(case: Case) -> RenderScene:
    """The scene with its set three times more, far behind the first camera."""
    scene, camera = case.scene, case.views.camera
    copies = [scene.static]
    for k in range(3):
        away = np.eye(4)
        away[:3, 3] = -camera.axes[0, 2] * (_BEHIND + 50.0 * k)
        copies.append(scene.static.transformed(away))
    return replace(
        scene,
        static=join(copies),
        static_object=np.tile(scene.static_object, 4),
        static_wall=np.tile(scene.static_wall, 4),
    )


def _steady(case: Case, device: str) -> Row:
    drawer = Renderer(device, STYLES["board"])
    drawer.load(case.scene)
    found = steadiness(
        drawer, case.palettes[0], panned(case.only(1).views.camera, 8, 0.125), case.views.hidden[0], LARGE
    )
    return Row("unsteady", "pixels that change on a slow pan", "%", 100 * found.share)


#: Says so when the picture is there: taking Taichi apart at the end is no part of it.
_FIRST = """
import sys
from vdsl.pipeline.bench_first import first_picture
first_picture(sys.argv[1])
print("there", flush=True)
"""


def _start_up(device: str) -> list[Row]:
    """Seconds from starting a process to its first picture, with the kernels kept and without."""
    rows = []
    with tempfile.TemporaryDirectory() as empty:
        for key, what, env in (
            ("start_warm", "start to first picture, kernels kept", {}),
            ("start_cold", "start to first picture, nothing kept yet", {"XDG_CACHE_HOME": empty}),
        ):
            times = []
            for _ in range(3 if not env else 1):
                begun = perf_counter()
                command = [sys.executable, "-c", _FIRST, device]
                quiet, heard = subprocess.DEVNULL, subprocess.PIPE
                with subprocess.Popen(
                    command, env=os.environ | env, stdout=heard, stderr=quiet, text=True
                ) as process:
                    assert process.stdout is not None
                    there = process.stdout.readline()
                    times.append(perf_counter() - begun)
                if process.returncode or not there:
                    raise subprocess.CalledProcessError(process.returncode, command)
            rows.append(Row(key, what, "s", min(times)))
    return rows
