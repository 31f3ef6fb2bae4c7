"""Pictures of what a storyboard may be made of: sets, props, cast and actions, and scenes as placed.

Assumes names that are in the catalog. Every function returns a picture as a Pillow image; what cannot be
drawn raises :class:`vdsl.pipeline.trial.NoTrialError` with the reason.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from runtime.body.skeleton import JOINT
from runtime.raster.types import Views
from runtime.world import World

from ..lang.definitions.prop import PropDef
from ..library import Catalog
from ..propose.story import propose, tell
from ..propose.types import StoryProposal
from ..stage.assemble import StagedScene, palettes
from .captions import grid, label, row, stacked, write_names, write_seen
from .compile import Act
from .eyes import Eye, around, entrances, eyes_camera, pose_eyes, straight_down
from .filming import Camerawork, first_frame
from .judging import GeometryJudge
from .trial import ACTOR, CAST, NoTrialError, Trial, floor_script, stage_script, try_action

#: Moments of an action's strip.
POSES = 8


class Studio:
    """Draws stills; keeps its renderer between them. ``camerawork``: somebody else's renderers."""

    def __init__(
        self,
        catalog: Catalog,
        device: str = "auto",
        style: str = "board",
        own: Path | None = None,
        camerawork: Camerawork | None = None,
    ):
        self.catalog = catalog
        self.own = own
        self.style = style
        self._camerawork = camerawork or Camerawork(device)

    # -- stills ------------------------------------------------------------------------------

    def stills(
        self,
        staged: StagedScene,
        eyes: Sequence[Eye],
        size: tuple[int, int],
        way: StoryProposal | None = None,
        frames: Sequence[int] | None = None,
        hidden: NDArray[np.bool_] | None = None,
    ) -> list[Image.Image]:
        """One picture for each eye, each of one frame of a performance (None: of the set at rest)."""
        frames = list(frames) if frames is not None else [0] * len(eyes)
        joints = {n: p.world_from_joint for n, p in way.performances.items()} if way else {}
        moments = palettes(staged, joints, way.props if way else {}, np.array(frames))
        if hidden is None:
            hidden = np.zeros((len(eyes), len(staged.world.walls)), bool)
        views = Views(eyes_camera(eyes, size), np.arange(len(eyes), dtype=np.int32), hidden)
        drawn = self._camerawork.stills(staged, self.style, moments, views, size)
        return [Image.fromarray(c) for c in drawn.color]

    # -- actions -----------------------------------------------------------------------------

    def action(
        self, name: str, cast: tuple[str, str] = CAST, cell: tuple[int, int] = (230, 280)
    ) -> Image.Image:
        """A strip of poses for each variant of an action."""
        trial = try_action(name, self.catalog, cast, self.own)
        rows = [self._strip(trial, way, cell) for way in trial.ways]
        heads = [f"{name} · {way.variant} · {way.frames / trial.act.filming.fps:.1f} s" for way in trial.ways]
        return stacked(list(zip(heads, rows, strict=True)))

    def actions(
        self, names: Sequence[str], cell: tuple[int, int] = (150, 190), poses: int = POSES
    ) -> Image.Image:
        """Many actions, one short strip each: their first variant."""
        rows = []
        for name in names:
            trial = try_action(name, self.catalog, CAST, self.own)
            rows.append((name, self._strip(trial, trial.ways[0], cell, poses)))
        return stacked(rows)

    def _strip(
        self, trial: Trial, way: StoryProposal, cell: tuple[int, int], poses: int = POSES
    ) -> Image.Image:
        frames = np.round(np.linspace(0.04, 0.96, poses) * (way.frames - 1)).astype(int)
        eyes = pose_eyes(trial, way, frames, cell)
        return row(self.stills(trial.staged, eyes, cell, way, frames.tolist()))

    # -- people ------------------------------------------------------------------------------

    def cast(self, names: Sequence[str], height: int = 560) -> Image.Image:
        """A line-up; of one person a turn-around."""
        cell = (round(height * 0.46), height)
        cells: list[tuple[str, str, Image.Image]] = []
        for name in names:
            act = stage_script(floor_script(cast=name), name, self.own)
            way = at_rest(act)
            turns = (-20, 70, 160) if len(names) == 1 else (-20,)
            eyes = [self._facing(act, turn) for turn in turns]
            for image in self.stills(act.staged, eyes, cell, way):
                cells.append(("" if len(cells) and len(names) == 1 else name, "", image))
        return grid(cells, min(len(cells), 8))

    def _facing(self, act: Act, turn: float = -20.0) -> Eye:
        """An eye on the whole of who stands there; turn: degrees from before them."""
        person = at_rest(act).performances[ACTOR]
        x, y, z = person.position[0]
        return around((x, y, z + 0.98), person.heading[0] + math.radians(turn), math.radians(86), 2.24, 70.0)

    def cast_row(self, names: Sequence[str], width: int) -> Image.Image:
        """People side by side without words, each in ``width`` pixels."""
        cell = (width * 2, round(width * 2 / 0.46))
        row = Image.new("RGB", (width * len(names), cell[1] // 2))
        for k, name in enumerate(names):
            act = stage_script(floor_script(cast=name), name, self.own)
            (image,) = self.stills(act.staged, [self._facing(act)], cell, at_rest(act))
            row.paste(image.resize((width, cell[1] // 2), Image.Resampling.LANCZOS), (width * k, 0))
        return row

    # -- props -------------------------------------------------------------------------------

    def props(self, names: Sequence[str], side: int = 300, columns: int = 6) -> Image.Image:
        """Props side by side, each filling its picture, with its size."""
        cells: list[tuple[str, str, Image.Image]] = []
        for name in names:
            prop = self.catalog.get("prop", name)
            if not isinstance(prop, PropDef):
                raise NoTrialError(f"there is no prop `{name}`")
            act, low, high = self._placed(name, 0.0)
            if low[2] < -0.005:  # it hangs on a wall or from a ceiling
                act, low, high = self._placed(name, -low[2])
            reach = float(np.linalg.norm(np.subtract(high, low)))
            aim = tuple((a + b) / 2 for a, b in zip(low, high, strict=True))
            eye = around(
                (aim[0], aim[1], aim[2]), math.radians(-62), math.radians(72), 0.98 * reach + 0.02, 60.0
            )
            (image,) = self.stills(act.staged, [eye], (side, side))
            cells.append(
                (name, " x ".join(f"{b - a:.2f}" for a, b in zip(low, high, strict=True)) + " m", image)
            )
        return grid(cells, min(columns, len(cells)))

    def _placed(self, name: str, up: float) -> tuple[Act, tuple[float, ...], tuple[float, ...]]:
        """A prop on a bare floor or above it, and its bounds."""
        height = f", up {up:.3f}m" if up else ""
        act = stage_script(floor_script(f"place it = {name}, at (6, 6)m{height}"), name, self.own)
        return act, *_bounds(act.staged.world, ("floor", "it"))

    # -- scenes ------------------------------------------------------------------------------

    def shot(self, act: Act, size: tuple[int, int]) -> Image.Image:
        """The first frame of the best take of a line's first shot, with names on what is seen."""
        shot = act.line.shots[0]
        grid = propose(act.line, shot, act.state, act.filming)
        if not grid.cameras:
            reasons = ", ".join(f"{n} {why.replace('_', ' ')}" for why, n in grid.rejected.items())
            raise NoTrialError(f"no camera could film this: {reasons}")
        camera = grid.cameras[int(np.argmax(GeometryJudge().scores(grid.cameras, None)))]
        way = next(s for s in grid.story if s.index == camera.story)
        joints = {n: p.world_from_joint for n, p in way.performances.items()}
        moments = palettes(act.staged, joints, way.props, np.array([0]))
        views = Views(first_frame(camera.track), np.zeros(1, np.int32), camera.hidden_walls[None])
        drawn = self._camerawork.stills(act.staged, self.style, moments, views, size, ids=True)
        assert drawn.ids is not None
        image = Image.fromarray(drawn.color[0])
        write_seen(image, drawn.ids[0], act.staged)
        return image

    # -- sets --------------------------------------------------------------------------------

    def set(self, name: str, time: str = "", width: int = 900) -> Image.Image:
        """A set from above with its names, and from where one comes in."""
        act = self._set(name, time)
        plan = self.plan(act.staged, width=width)
        size = (width, round(width * 9 / 16))
        views = self.stills(act.staged, entrances(act.staged.world), size)
        head = f"{name} · {act.staged.world.name}" + (f" · {time}" if time else "")
        return stacked([(head, plan), *[("", view) for view in views]])

    def sets(self, names: Sequence[str], time: str = "", width: int = 420) -> Image.Image:
        """Many sets, each from where one comes in."""
        cells: list[tuple[str, str, Image.Image]] = []
        for name in names:
            act = self._set(name, time)
            size = (width, round(width * 9 / 16))
            (view,) = self.stills(act.staged, entrances(act.staged.world, 1), size)
            cells.append((name, "", view))
        return grid(cells, min(3, len(cells)))

    def _set(self, name: str, time: str) -> Act:
        at = f" at {time}" if time else ""
        text = f'storyboard "set"\nscene s = {name}{at}\n\n/ (static wide)\n'
        return stage_script(text, name, self.own)

    def plan(
        self,
        staged: StagedScene,
        way: StoryProposal | None = None,
        width: int = 900,
        within: tuple[str, ...] = (),
    ) -> Image.Image:
        """From straight above, with names on rooms, things, spots and people; ``within`` a room's path."""
        eye, size = straight_down(_extent(staged.world, within), width)
        (image,) = self.stills(staged, [eye], size, way)
        write_names(image, eye, staged.world, within)
        for person, track in (way.performances if way else {}).items():
            x, y, z = track.world_from_joint[0][JOINT["head"], :3, 3].tolist()
            label(image, eye, (x, y, z), person)
        return image


def at_rest(act: Act) -> StoryProposal:
    """A line performed in one way."""
    return tell(act.state, act.line, act.filming, most=1).proposals[0]


def _bounds(world: World, path: tuple[str, ...]) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Bounds of an object with all its parts."""
    found = [o for o in world.objects if o.path[: len(path)] == path]
    low = tuple(min(o.low[i] for o in found) for i in range(3))
    high = tuple(max(o.high[i] for o in found) for i in range(3))
    return low, high


def _extent(world: World, within: tuple[str, ...]) -> tuple[float, float, float, float]:
    rooms = [o for o in world.objects if o.kind in ("room", "area")]
    rooms = [o for o in rooms if o.path == within] or rooms
    return (
        min(o.low[0] for o in rooms) - 0.2,
        min(o.low[1] for o in rooms) - 0.2,
        max(o.high[0] for o in rooms) + 0.2,
        max(o.high[1] for o in rooms) + 0.2,
    )
