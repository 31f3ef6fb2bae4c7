"""Pictures of what a storyboard may be made of: sets, props, cast and actions, and scenes as placed.

Assumes names that are in the catalog. Every function returns a picture as a Pillow image; what cannot be
drawn raises :class:`vdsl.pipeline.trial.NoTrialError` with the reason.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from runtime.body.skeleton import JOINT
from runtime.raster.types import Camera, Views
from runtime.world import World, WorldObject

from ..cinema.sight import clear_lines, distances
from ..cinema.track import camera_axes, look_at_rotation, project
from ..emit import lettering
from ..lang.definitions.prop import PropDef
from ..library import Catalog
from ..propose.story import propose, tell
from ..propose.types import StoryProposal
from ..stage.assemble import StagedScene, palettes
from .compile import Act
from .filming import Camerawork, first_frame
from .judging import GeometryJudge
from .trial import ACTOR, CAST, NoTrialError, Trial, floor_script, stage_script, try_action

PAPER, INK, QUIET = "#f6f3ec", "#1b1c1f", "#6f6a61"
#: Moments of an action's strip.
POSES = 8
_SENSOR = 24.0  # mm high, whatever the picture's shape
_MARGIN = 14


@dataclass(frozen=True)
class Eye:
    """Where a still is taken from: position and aim in metres, focal length in mm on a sensor 24 mm high."""

    position: tuple[float, float, float]
    aim: tuple[float, float, float]
    focal: float = 50.0


def around(
    aim: tuple[float, float, float], azimuth: float, polar: float, height: float, focal: float = 50.0
) -> Eye:
    """An eye that sees ``height`` metres at its aim, from an azimuth and a polar angle from +Z (radians)."""
    r = height * focal / _SENSOR
    offset = (
        r * math.cos(azimuth) * math.sin(polar),
        r * math.sin(azimuth) * math.sin(polar),
        r * math.cos(polar),
    )
    return Eye((aim[0] + offset[0], aim[1] + offset[1], max(aim[2] + offset[2], 0.08)), aim, focal)


class Studio:
    """Draws stills; keeps its renderer between them."""

    def __init__(self, catalog: Catalog, device: str = "auto", style: str = "board", own: Path | None = None):
        self.catalog = catalog
        self.own = own
        self.style = style
        self._camerawork = Camerawork(device)

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
        return _stacked(list(zip(heads, rows, strict=True)))

    def actions(self, names: Sequence[str], cell: tuple[int, int] = (150, 190)) -> Image.Image:
        """Many actions, one short strip each: their first variant."""
        rows = []
        for name in names:
            trial = try_action(name, self.catalog, CAST, self.own)
            rows.append((name, self._strip(trial, trial.ways[0], cell)))
        return _stacked(rows)

    def _strip(self, trial: Trial, way: StoryProposal, cell: tuple[int, int]) -> Image.Image:
        frames = np.round(np.linspace(0.04, 0.96, POSES) * (way.frames - 1)).astype(int)
        azimuths = np.array([_facing_us(trial, way, int(f)) for f in frames])
        choices = [[_pose_eye(trial, way, f, a + off, cell) for f, a in zip(frames, azimuths, strict=True)]
                   for off in (_TWO_SIDES if len(trial.people) > 1 else _SIDES)]  # fmt: skip
        eyes = max(choices, key=lambda eyes: _seen(trial, way, frames, eyes))
        return _row(self.stills(trial.staged, eyes, cell, way, frames.tolist()))

    # -- people ------------------------------------------------------------------------------

    def cast(self, names: Sequence[str], height: int = 560, turned: bool = False) -> Image.Image:
        """A line-up; of one person a turn-around."""
        cell = (round(height * 0.46), height)
        cells: list[tuple[str, str, Image.Image]] = []
        for name in names:
            act = stage_script(floor_script(cast=name), name, self.own)
            way = at_rest(act)
            person = way.performances[ACTOR]
            x, y, z = person.position[0]
            turns = (-20, 70, 160) if len(names) == 1 else (-20,)
            eyes = [
                around((x, y, z + 0.98), person.heading[0] + math.radians(t), math.radians(86), 2.24, 70.0)
                for t in turns
            ]
            for image in self.stills(act.staged, eyes, cell, way):
                cells.append(("" if len(cells) and len(names) == 1 else name, "", image))
        return _grid(cells, min(len(cells), 8))

    # -- props -------------------------------------------------------------------------------

    def props(self, names: Sequence[str], side: int = 300, columns: int = 6) -> Image.Image:
        """Props side by side, each filling its picture, with its size."""
        cells: list[tuple[str, str, Image.Image]] = []
        for name in names:
            prop = self.catalog.get("prop", name)
            if not isinstance(prop, PropDef):
                raise NoTrialError(f"there is no prop `{name}`")
            act = stage_script(floor_script(f"place it = {name}, at (6, 6)m"), name, self.own)
            low, high = _bounds(act.staged.world, ("floor", "it"))
            reach = float(np.linalg.norm(np.subtract(high, low)))
            aim = tuple((a + b) / 2 for a, b in zip(low, high, strict=True))
            eye = around(
                (aim[0], aim[1], aim[2]), math.radians(-62), math.radians(72), 0.98 * reach + 0.02, 60.0
            )
            (image,) = self.stills(act.staged, [eye], (side, side))
            cells.append(
                (name, " x ".join(f"{b - a:.2f}" for a, b in zip(low, high, strict=True)) + " m", image)
            )
        return _grid(cells, min(columns, len(cells)))

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
        _write_seen(image, drawn.ids[0], act.staged)
        return image

    # -- sets --------------------------------------------------------------------------------

    def set(self, name: str, time: str = "", width: int = 900) -> Image.Image:
        """A set from above with its names, and from where one comes in."""
        act = self._set(name, time)
        plan = self.plan(act.staged, width=width)
        size = (width, round(width * 9 / 16))
        views = self.stills(act.staged, entrances(act.staged.world), size)
        head = f"{name} · {act.staged.world.name}" + (f" · {time}" if time else "")
        return _stacked([(head, plan), *[("", view) for view in views]])

    def sets(self, names: Sequence[str], time: str = "", width: int = 420) -> Image.Image:
        """Many sets, each from where one comes in."""
        cells: list[tuple[str, str, Image.Image]] = []
        for name in names:
            act = self._set(name, time)
            size = (width, round(width * 9 / 16))
            (view,) = self.stills(act.staged, entrances(act.staged.world, 1), size)
            cells.append((name, "", view))
        return _grid(cells, min(3, len(cells)))

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
        world = staged.world
        x0, y0, x1, y1 = _extent(world, within)
        turned = (y1 - y0) > (x1 - x0) * 1.05
        span = ((y1 - y0), (x1 - x0)) if turned else ((x1 - x0), (y1 - y0))
        size = (width, max(200, round(width * (span[1] + 1.0) / (span[0] + 1.0))))
        size = (size[0] // 2 * 2, size[1] // 2 * 2)
        focal = 85.0
        away = (span[1] + 1.0) * focal / _SENSOR
        middle = ((x0 + x1) / 2, (y0 + y1) / 2)
        lean = 1e-4  # straight down has no horizon: a hair off it says which way is up
        off = (lean * away, 0.0) if turned else (0.0, -lean * away)
        eye = Eye((middle[0] + off[0], middle[1] + off[1], away), (*middle, 0.0), focal)
        (image,) = self.stills(staged, [eye], size, way)
        _write_names(image, eye, world, within)
        for person, track in (way.performances if way else {}).items():
            head = track.world_from_joint[0][JOINT["head"], :3, 3]
            _label(image, eye, (float(head[0]), float(head[1]), float(head[2])), person, "#b3392b", 20)
        return image


def at_rest(act: Act) -> StoryProposal:
    """A line performed in one way."""
    return tell(act.state, act.line, act.filming, most=1).proposals[0]


#: From where poses are drawn, off the direction a person faces at the end; of two people, off the line
#: between them. The first from which most is seen is taken.
_SIDES = tuple(math.radians(a) for a in (-38, 38, -72, 72, -110, 110, -150))
_TWO_SIDES = tuple(math.radians(a) for a in (-78, 78, -50, 50))
_SEEN_JOINTS = ("head", "chest", "hips", "hand_l", "hand_r", "shin_l", "shin_r")


def _facing_us(trial: Trial, way: StoryProposal, frame: int) -> float:
    people = [way.performances[name] for name in trial.people]
    if len(people) == 1:
        return float(people[0].heading[-1])
    a, b = (p.position[frame] for p in people)
    return math.atan2(b[1] - a[1], b[0] - a[0])


def _pose_eye(trial: Trial, way: StoryProposal, frame: int, azimuth: float, cell: tuple[int, int]) -> Eye:
    """As near as shows everybody, heads to feet."""
    people = [way.performances[name] for name in trial.people]
    points = np.concatenate([p.world_from_joint[frame][:, :3, 3] for p in people])
    low, high = points.min(0), points.max(0)
    aim = ((low[0] + high[0]) / 2, (low[1] + high[1]) / 2, max((low[2] + high[2]) / 2 + 0.04, 0.78))
    across = np.array([-math.sin(azimuth), math.cos(azimuth)])
    wide = float(np.ptp(points[:, :2] @ across)) + 0.55
    tall = max(2.0, float(high[2]) + 0.42 - min(float(low[2]), 0.0))
    return around(aim, azimuth, math.radians(82), max(tall, wide * cell[1] / cell[0]))


def _seen(trial: Trial, way: StoryProposal, frames: NDArray[np.int64], eyes: Sequence[Eye]) -> float:
    """Share of the actors' joints that nothing solid hides."""
    joints = [JOINT[name] for name in _SEEN_JOINTS]
    points = np.concatenate(
        [way.performances[name].world_from_joint[frames][..., :3, 3][:, joints] for name in trial.people],
        axis=1,
    ).astype(np.float64)
    camera = np.array([[eye.position for eye in eyes]])
    world = trial.staged.world
    hidden = np.zeros((1, len(world.walls)), bool)
    return round(float(clear_lines(world.solids, camera, points, hidden).mean()), 1)


def eyes_camera(eyes: Sequence[Eye], size: tuple[int, int]) -> Camera:
    """The eyes as a batch of cameras for pictures of a size."""
    position = np.array([e.position for e in eyes])
    rotation = look_at_rotation(position, np.array([e.aim for e in eyes]))
    return Camera(
        position.astype(np.float32),
        camera_axes(rotation).astype(np.float32),
        np.array([e.focal for e in eyes], np.float32),
        (_SENSOR * size[0] / size[1], _SENSOR),
    )


def entrances(world: World, most: int = 2) -> list[Eye]:
    """Eyes at the doors of a set (at the rims of open ground), looking over its largest places."""
    rooms = [o for o in world.objects if o.kind in ("room", "area")]
    rooms = sorted(rooms, key=lambda o: (o.spot("middle") is None, -_floor_area(o)))
    return [_entrance(world, room) for room in rooms[:most]]


def _entrance(world: World, room: WorldObject) -> Eye:
    """The place at a door or a rim from which most of a room is seen."""
    middle = next((s.position for s in room.spots if s.name == "middle"), room.centre)
    base = room.low[2]
    doors = [o for o in world.objects if o.kind in ("door", "doorway") and o.path[0] == room.path[0]]
    starts = [o.centre[:2] for o in doors] + _rims(room, 0.12)
    inward = [(x + 0.12 * (middle[0] - x), y + 0.12 * (middle[1] - y), base + 1.6) for x, y in starts]
    xs, ys = (
        np.linspace(0.2, 0.8, 5) * (b - a) + a for a, b in zip(room.low[:2], room.high[:2], strict=True)
    )
    ground = np.array([(x, y, base + z) for x in xs for y in ys for z in (0.6, 1.3)])
    eye = np.array(inward)[:, None]
    hidden = np.zeros((len(inward), len(world.walls)), bool)
    seen = clear_lines(world.solids, eye, ground[None], hidden).mean((1, 2))
    free = distances(world.solids, eye[:, 0]).min(1, initial=9.0) > 0.35
    far = np.linalg.norm(eye[:, 0, :2] - np.array(middle[:2]), axis=1)
    x, y, z = inward[int(np.argmax(seen * free + 0.004 * np.minimum(far, 12.0)))]
    return Eye((x, y, z), (middle[0], middle[1], base + 1.5), 20.0)


def _floor_area(room: WorldObject) -> float:
    return (room.high[0] - room.low[0]) * (room.high[1] - room.low[1])


def _rims(room: WorldObject, inset: float) -> list[tuple[float, float]]:
    """Points a little inside a room's corners and the middles of its sides."""
    (x0, y0), (x1, y1) = room.low[:2], room.high[:2]
    shares = (inset, 0.5, 1 - inset)
    return [(x0 + a * (x1 - x0), y0 + b * (y1 - y0)) for a in shares for b in shares if (a, b) != (0.5, 0.5)]


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


# --- words on pictures ----------------------------------------------------------------------


def _write_names(image: Image.Image, eye: Eye, world: World, within: tuple[str, ...]) -> None:
    taken: list[tuple[float, float, float, float]] = []
    things = [o for o in world.objects if not within or o.path[: len(within)] == within]
    for thing in sorted(things, key=lambda o: (o.kind not in ("room", "area"), len(o.path), -_floor_area(o))):
        if thing.kind in ("wall", "part"):
            continue
        room = thing.kind in ("room", "area")
        text = thing.path[-1].upper() if room else thing.path[-1]
        x, y, _ = thing.centre
        _label(image, eye, (x, y, thing.high[2] if not room else thing.low[2]), text, INK if room else QUIET,
               17 if room else 12, taken)  # fmt: skip
        for spot in thing.spots if room else ():
            _label(image, eye, spot.position, "· " + spot.name, "#2f6f8f", 12, taken)


def _write_seen(image: Image.Image, ids: NDArray[np.int32], staged: StagedScene) -> None:
    """Names on people and things where they are seen."""
    people = {number: name for name, number in staged.object_ids.items()}
    draw = ImageDraw.Draw(image, "RGBA")
    taken: list[tuple[float, float, float, float]] = []
    numbers, counts = np.unique(ids[ids >= 0], return_counts=True)
    for number in sorted(numbers, key=lambda k: (k not in people, -counts[numbers == k][0])):
        who = people.get(int(number))
        thing = staged.world.objects[number] if who is None else None
        if thing is not None and (thing.kind in ("room", "area", "wall", "part") or len(thing.path) > 3):
            continue
        rows, columns = np.nonzero(ids == number)
        if len(rows) < 40:
            continue
        y = float(rows.min()) + 12 if who else float(np.median(rows))
        x = float(np.median(columns[rows < rows.min() + 40])) if who else float(np.median(columns))
        text = who or (thing.path[-1] if thing else "")
        _tag(draw, (x, y), text, "#b3392b" if who else QUIET, 18 if who else 12, taken)


def _tag(
    draw: ImageDraw.ImageDraw,
    at: tuple[float, float],
    text: str,
    colour: str,
    size: int,
    taken: list[tuple[float, float, float, float]] | None = None,
) -> None:
    """A word on a pale ground; left out where it would cover another."""
    half = lettering.width(text, size) / 2
    box = (at[0] - half - 2, at[1] - size * 0.6, at[0] + half + 2, at[1] + size * 0.6)
    if taken is not None:
        if any(box[0] < b[2] and b[0] < box[2] and box[1] < b[3] and b[1] < box[3] for b in taken):
            return
        taken.append(box)
    draw.rectangle(box, fill=(255, 253, 247, 190))
    lettering.write(draw, at, text, size, colour, anchor="mm")


def _label(
    image: Image.Image,
    eye: Eye,
    point: tuple[float, float, float],
    text: str,
    colour: str,
    size: int,
    taken: list[tuple[float, float, float, float]] | None = None,
) -> None:
    """A name at a point of the world; left out where it would cover another."""
    position = np.array(eye.position)
    axes = camera_axes(look_at_rotation(position, np.array(eye.aim)))
    sensor = (_SENSOR * image.width / image.height, _SENSOR)
    at, depth = project(np.array([point], float), position, axes, np.array(eye.focal), sensor)
    if depth[0] <= 0:
        return
    x, y = float(at[0, 0]) * image.width, float(at[0, 1]) * image.height
    _tag(ImageDraw.Draw(image, "RGBA"), (x, y), text, colour, size, taken)


# --- sheets ---------------------------------------------------------------------------------


def _row(images: Iterable[Image.Image]) -> Image.Image:
    images = list(images)
    sheet = Image.new("RGB", (sum(i.width + 4 for i in images) - 4, max(i.height for i in images)), PAPER)
    x = 0
    for image in images:
        sheet.paste(image, (x, 0))
        x += image.width + 4
    return sheet


def _stacked(rows: Sequence[tuple[str, Image.Image]]) -> Image.Image:
    """Rows of pictures below each other, each under its words."""
    width = max(image.width for _, image in rows) + 2 * _MARGIN
    height = _MARGIN + sum(image.height + (30 if head else 0) + 8 for head, image in rows)
    sheet = Image.new("RGB", (width, height), PAPER)
    draw = ImageDraw.Draw(sheet)
    y = _MARGIN
    for head, image in rows:
        if head:
            lettering.write(draw, (_MARGIN, y), lettering.shortened(head, 18, width - 2 * _MARGIN), 18, INK)
            y += 30
        sheet.paste(image, (_MARGIN, y))
        y += image.height + 8
    return sheet


def _grid(cells: Sequence[tuple[str, str, Image.Image]], columns: int) -> Image.Image:
    """Pictures in rows, each over its name and a further word."""
    w, h = cells[0][2].size
    step_w, step_h = w + _MARGIN, h + 46
    rows = -(-len(cells) // columns)
    sheet = Image.new("RGB", (columns * step_w + _MARGIN, rows * step_h + _MARGIN), PAPER)
    draw = ImageDraw.Draw(sheet)
    for k, (name, more, image) in enumerate(cells):
        x, y = _MARGIN + k % columns * step_w, _MARGIN + k // columns * step_h
        sheet.paste(image, (x, y))
        lettering.write(draw, (x + 2, y + h + 4), lettering.shortened(name, 16, w), 16, INK)
        lettering.write(draw, (x + 2, y + h + 23), lettering.shortened(more, 12, w), 12, QUIET)
    return sheet
