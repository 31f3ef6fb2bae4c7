"""The gallery in ``docs/gallery``: every set of the library by day and by night in the looks, and the cases
a picture may go wrong at. ``python -m vdsl.pipeline.gallery docs/gallery`` draws it, ``--only NAME`` a part.

Assumes the library and :mod:`vdsl.pipeline.gallery_cases`. Guarantees that pictures depend on these alone,
and that the index names every picture it draws.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
from PIL import Image

from runtime.world import Spot, World, WorldObject

from ..cinema.sight import distances
from ..library import Catalog
from ..propose.cameras import propose_cameras
from ..propose.story import tell
from .captions import grid
from .compile import Act
from .eyes import Eye, entrances, floor_area
from .filming import Camerawork
from .gallery_cases import CASES, CAST, Case
from .judging import GeometryJudge
from .preview import Studio, at_rest
from .trial import NoTrialError, stage_script

POSTER = "poster"
LOOKS = ("board", "clay", "ink")
TIMES = ("day", "night")
#: Pixels of a set's picture.
CELL = (400, 225)
#: Pictures are drawn larger and shown smaller, save where their true size is the point.
_FINER = 2
_SHRINK = Image.Resampling.LANCZOS
#: What the poster shows: sets with the hour, and people of the library.
_POSTER_SETS = (
    ("medieval_hall", "day"), ("station_platform", "day"), ("city_street", "night"),
    ("cafe", "day"), ("forest", "day"), ("hospital", "day"),
    ("beach", "day"), ("classroom", "day"), ("restaurant", "night"),
)  # fmt: skip
_POSTER_CAST = ("detective", "chef", "nurse", "old_woman", "astronaut", "girl", "knight", "pirate")
_POSTER_COLUMNS, _GAP, _PAPER = 3, 6, (246, 243, 235)
_NEAR = 6.0  # metres from the eye to the first person, at most
_WHOLE = 3.4  # metres; who is nearer does not fit into the picture
_REACHED = 1.0  # metres from somebody to what they may look at, at least
_ASIDE = math.radians(35)  # from the eye to where they look
_SMALL = 15.0  # metres; who is farther off is a speck
#: How far beside the first the second stands at least, not to hide behind the other, and at most.
_CLEAR, _BESIDE = math.radians(7), math.radians(40)
_SETS = """
## Sets

Anna stands in each, and Ben beside her where there is a place, so that its size can be told.
"""
_HEAD = (
    "<!-- Made by `make gallery`; not edited by hand. -->\n\n# Gallery\n\nWhat the renderer draws, as it "
    "draws it (twice as large as shown here, but for the thumbnails): the cases that tell a good picture "
    "from a bad one, then every set of the library by day and by night in the three looks "
    "(`style board`, `clay`, `ink`).\n"
)

Drawing = Callable[[], Image.Image]


class Gallery:
    """Draws the gallery's pictures; keeps its renderers between them.

    scale: of the pictures' size, for looking closely
    """

    def __init__(self, catalog: Catalog, device: str = "auto", scale: float = 1.0) -> None:
        self.catalog = catalog
        self._scale = scale
        self._camerawork = Camerawork(device)

    def pictures(self) -> Iterator[tuple[str, Drawing]]:
        """Every picture by name, yet to be drawn."""
        for case in CASES:
            yield case.name, partial(self.case, case)
        for name in self.catalog.names("set"):
            yield f"set-{name}", partial(self.set, name)
        yield POSTER, self.poster

    def case(self, case: Case) -> Image.Image:
        """The shots of a case in its looks, as a grid."""
        size, finer = self._sized(case.size), self._sized(case.size, 1 if case.true_size else _FINER)
        pairs = [(look, shot) for look in case.looks for shot in case.shots]
        if case.columns == len(case.looks):  # a column for each look
            pairs = [(look, shot) for shot in case.shots for look in case.looks]
        drawn = [self.shot(shot.script, look, finer, shot.at).resize(size, _SHRINK) for look, shot in pairs]
        cells = [
            (shot.label, look if len(case.looks) > 1 else "", image)
            for (look, shot), image in zip(pairs, drawn, strict=True)
        ]
        return grid(cells, case.columns)

    def shot(self, script: str, look: str, size: tuple[int, int], at: float = 0.5) -> Image.Image:
        """One frame of the best take by geometry of a script's last line; at: 0..1 of its length."""
        act = stage_script(script, "gallery", line=-1)
        shot = act.line.shots[0]
        told = tell(act.state, act.line, act.filming, shot=shot)
        cameras = propose_cameras(shot, told.proposals, act.filming).cameras
        if not cameras:
            raise NoTrialError(f"no camera could film this:\n{script}")
        camera = cameras[int(np.argmax(GeometryJudge().scores(cameras, None)))]
        story = next(s for s in told.proposals if s.index == camera.story)
        frame = np.array([round(at * (story.frames - 1))])
        drawn = self._camerawork.frames_at(act.staged, look, story, camera, size, frame)
        return Image.fromarray(drawn[0])

    def set(self, name: str) -> Image.Image:
        """A set with two people in it: a row by day, one by night, a column for each look."""
        cells = []
        for time in TIMES:
            act, eye = self._peopled(name, time)
            way = at_rest(act)
            for look in LOOKS:
                studio = Studio(self.catalog, style=look, camerawork=self._camerawork)
                (image,) = studio.stills(act.staged, [eye], self._sized(CELL, _FINER), way)
                cells.append((f"{name} · {time}", look, image.resize(self._sized(CELL), _SHRINK)))
        return grid(cells, len(LOOKS))

    def poster(self) -> Image.Image:
        """Some sets and people of the library on one sheet, without words."""
        (width, height), studio = self._sized(CELL), Studio(self.catalog, camerawork=self._camerawork)
        rows = -(-len(_POSTER_SETS) // _POSTER_COLUMNS)
        across = _POSTER_COLUMNS * (width + _GAP) - _GAP
        people = studio.cast_row(_POSTER_CAST, across // len(_POSTER_CAST))
        sheet = Image.new("RGB", (across, rows * (height + _GAP) + people.height), _PAPER)
        for k, (name, time) in enumerate(_POSTER_SETS):
            act, eye = self._peopled(name, time)
            (image,) = studio.stills(act.staged, [eye], self._sized(CELL, _FINER), at_rest(act))
            row, column = divmod(k, _POSTER_COLUMNS)
            at = column * (width + _GAP), row * (height + _GAP)
            sheet.paste(image.resize((width, height), _SHRINK), at)
        sheet.paste(people, (0, rows * (height + _GAP)))
        return sheet

    def _peopled(self, name: str, time: str) -> tuple[Act, Eye]:
        """The set with Anna and Ben on spots of its largest place, and an eye at its entrance."""
        head = f'storyboard "set"\n{CAST}\nscene s = {name} at {time}\n'
        line = "\n/ (static wide)\n"
        bare = stage_script(head + line, name)
        room = _largest(bare.staged.world.objects)
        (eye,) = entrances(bare.staged.world, 1)
        eye = nearer(eye, room.spots[0].position if room.spots else eye.aim, bare.staged.world)
        spots = _apart(eye, room)
        said = [
            f"{who} at {'.'.join((*room.path, spot.name))}{_facing(eye, spot, bare.staged.world)}\n"
            for who, spot in zip(("anna", "ben"), spots, strict=False)
        ]
        return (stage_script(head + "".join(said) + line, name) if said else bare), eye

    def _sized(self, size: tuple[int, int], finer: int = 1) -> tuple[int, int]:
        return round(size[0] * self._scale) * finer, round(size[1] * self._scale) * finer


def _largest(objects: Sequence[WorldObject]) -> WorldObject:
    """The place a set is entered at, as :func:`~vdsl.pipeline.eyes.entrances` has it."""
    rooms = [o for o in objects if o.kind in ("room", "area")]
    return min(rooms, key=lambda o: (o.spot("middle") is None, -floor_area(o)))


def _apart(eye: Eye, room: WorldObject) -> list[Spot]:
    """A room's first spot, and the one that is seen farthest beside it, if one is in the picture, clear of
    the first and neither too near nor too far to be seen whole."""
    if len(room.spots) < 2:
        return list(room.spots)
    turns = [math.atan2(s.position[1] - eye.position[1], s.position[0] - eye.position[0]) for s in room.spots]
    beside = [abs(math.remainder(turn - turns[0], math.tau)) for turn in turns]
    away = [math.dist(s.position[:2], eye.position[:2]) for s in room.spots]
    seen = [
        angle if _CLEAR < angle < _BESIDE and _WHOLE < far < _SMALL else 0.0
        for angle, far in zip(beside, away, strict=True)
    ]
    return [room.spots[0], room.spots[int(np.argmax(seen))]] if max(seen) > 0 else [room.spots[0]]


def _facing(eye: Eye, spot: Spot, world: World) -> str:
    """Words by which who stands on a spot turns a little beside the eye, to a thing that is there: a face is
    seen, and it looks at something. Nothing where there is none such."""
    x, y = spot.position[:2]
    to_eye = math.atan2(eye.position[1] - y, eye.position[0] - x)
    turns = {}
    for item in world.objects:
        across, along = (item.low[0] + item.high[0]) / 2 - x, (item.low[1] + item.high[1]) / 2 - y
        if item.kind not in ("room", "area", "part", "stairs") and math.hypot(across, along) > _REACHED:
            turn = abs(math.remainder(math.atan2(along, across) - to_eye, math.tau))
            turns[".".join(item.path)] = abs(turn - _ASIDE)
    best = min(turns, key=lambda path: turns[path], default="")
    return f" facing {best}" if best and turns[best] < _ASIDE else ""


def nearer(eye: Eye, person: tuple[float, float, float], world: World) -> Eye:
    """The eye as near to a person as :data:`_NEAR`, or as what stands there allows."""
    start, end = np.array(eye.position), np.array([person[0], person[1], eye.position[2]])
    away = float(np.linalg.norm(end - start))
    if away <= _NEAR:
        return eye
    steps = start + np.linspace(1 - _NEAR / away, 0, 8)[:, None] * (end - start)
    free = distances(world.solids, steps).min(1, initial=9.0) > 0.6
    x, y, z = steps[int(np.argmax(free))]
    return replace(eye, position=(float(x), float(y), float(z)))


def index(catalog: Catalog) -> str:
    """The gallery's page."""
    parts = [_HEAD, f"\n![Some sets and people of the library]({POSTER}.jpg)\n"]
    for case in CASES:
        parts.append(f"\n## {case.title}\n\n{case.about}\n\n![{case.title}]({case.name}.jpg)\n")
    parts.append(_SETS)
    for name in sorted(catalog.names("set")):
        parts.append(f"\n### {name}\n\n![{name} by day and by night in three looks](set-{name}.jpg)\n")
    return "".join(parts)


def main() -> None:
    """Draw the gallery, or what is asked for of it."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("folder", type=Path)
    parser.add_argument("--only", nargs="+", default=(), metavar="NAME", help="pictures, such as set-cafe")
    parser.add_argument("--scale", type=float, default=1.0, help="of the pictures' size")
    parser.add_argument("--png", action="store_true", help="PNG instead of JPEG")
    given = parser.parse_args()
    given.folder.mkdir(parents=True, exist_ok=True)
    gallery = Gallery(Catalog(), scale=given.scale)
    for name, drawing in gallery.pictures():
        if given.only and name not in given.only:
            continue
        path = given.folder / f"{name}.{'png' if given.png else 'jpg'}"
        drawing().save(path, quality=74, optimize=True)
        print(path, flush=True)
    if not given.only:
        (given.folder / "README.md").write_text(index(gallery.catalog), encoding="utf-8")


if __name__ == "__main__":
    main()
