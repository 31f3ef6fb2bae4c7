"""Other programs' files as props, sets, people and clips.

Assumes definitions that :mod:`vdsl.lang.definitions.files` let pass. :func:`check_models` decodes every file
a script names, and reports what only that can tell; what is built afterwards relies on it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from runtime.body.build import Body
from runtime.formats import limits
from runtime.formats.boxes import Rect, column_boxes, floor_height, floors, surface_points
from runtime.formats.clips import read_clip
from runtime.formats.errors import ModelFileError
from runtime.formats.finish import piece_mesh
from runtime.formats.load import load_model
from runtime.formats.model import Fit, Piece, settled
from runtime.formats.person import read_person
from runtime.mesh import Mesh
from runtime.motion.types import Capture

from ..lang.definitions.files import (
    PERSON,
    FileActionDef,
    FileCastDef,
    FileDef,
    FilePropDef,
    FileSetDef,
    broken_file,
)
from ..lang.definitions.types import ModelFile
from ..lang.diagnostics import Report
from ..library import Catalog

#: Boxes that stand in for a prop and for a whole set, at most.
PROP_BOXES, SET_BOXES = 24, 300
#: What is lower than this above a set's floor is nothing to bump into, metres.
STEP_OVER = 0.12
#: Floor around a model that brings no ground of its own, metres.
APRON = 4.0


@dataclass(frozen=True, eq=False)
class FileProp:
    """A prop out of a file, on z = 0 around (0, 0): its mesh, solid boxes (low, high), and depth along Y."""

    mesh: Mesh
    boxes: tuple[tuple[NDArray[np.float64], NDArray[np.float64]], ...]


@dataclass(frozen=True, eq=False)
class FileSet:
    """A set out of a file, its floor at z = 0.

    things: name, mesh and solid boxes of each named thing; floors: where one walks
    own_ground: whether the file brings a ground to walk on
    """

    things: tuple[tuple[str, FileProp], ...]
    floors: tuple[Rect, ...]
    own_ground: bool


def check_models(catalog: Catalog, report: Report) -> None:
    """Decode every file of the script's definitions; what cannot be used is reported at its path."""
    for definition in catalog.files():
        try:
            _build(definition)
        except ModelFileError as error:
            broken_file(error, definition.model.span, report)


def _build(definition: FileDef) -> None:
    if isinstance(definition, FilePropDef):
        file_prop(definition.model)
    elif isinstance(definition, FileSetDef):
        file_set(definition.model)
    elif isinstance(definition, FileActionDef):
        file_motion(definition)
    elif isinstance(definition, FileCastDef):
        file_person(definition.model, definition.model.height or PERSON)


def file_prop(model: ModelFile) -> FileProp:
    """Raises :class:`ModelFileError`. Kept as long as the file is the same."""
    return _file_prop(model, _state(model))


def file_person(model: ModelFile, height: float) -> Body:
    """Raises :class:`ModelFileError`. Kept as long as the file is the same."""
    return _file_person(replace(model, height=height), _state(model))


@lru_cache(maxsize=16)
def _file_person(model: ModelFile, state: tuple[int, int]) -> Body:
    height = model.height or PERSON
    return read_person(Path(model.path), Path(model.folder), height, model.up, model.turn)


def file_motion(action: FileActionDef) -> Capture:
    """Raises :class:`ModelFileError`. Kept as long as the file is the same."""
    how = (action.clip, action.cut, action.times, action.stays)
    return _file_motion(action.model, how, _state(action.model))


@lru_cache(maxsize=16)
def _file_motion(
    model: ModelFile, how: tuple[str, tuple[float, float | None], int, bool], state: tuple[int, int]
) -> Capture:
    clip, cut, times, stays = how
    return read_clip(Path(model.path), Path(model.folder), clip, cut, model.up, model.turn, times, stays)


def file_set(model: ModelFile) -> FileSet:
    """Raises :class:`ModelFileError`. Kept as long as the file is the same."""
    return _file_set(model, _state(model))


def _state(model: ModelFile) -> tuple[int, int]:
    try:
        found = Path(model.path).stat()
    except OSError:
        return (0, 0)
    return (found.st_mtime_ns, found.st_size)


@lru_cache(maxsize=32)
def _file_prop(model: ModelFile, state: tuple[int, int]) -> FileProp:
    pieces = settled(load_model(Path(model.path), Path(model.folder)), _fit(model))
    return FileProp(piece_mesh(pieces, limits.PROP_TRIANGLES), tuple(_boxes(pieces, PROP_BOXES)))


@lru_cache(maxsize=4)
def _file_set(model: ModelFile, state: tuple[int, int]) -> FileSet:
    pieces = settled(load_model(Path(model.path), Path(model.folder)), _fit(model), centred=False)
    vertices, faces = _joined(pieces)
    points, normals = surface_points(vertices, faces, 0.1)
    height = floor_height(points, normals)
    ground: list[Rect] = []
    if height is not None:
        down = np.array([0.0, 0.0, height])
        ground = floors(points - down, normals)
        pieces = tuple(Piece(p.name, p.vertices - down, p.faces, p.colors, p.glass, p.glow) for p in pieces)
    area = sum((x1 - x0) * (y1 - y0) for x0, y0, x1, y1 in ground)
    own = area >= 2.0
    if not own:
        (x0, y0), (x1, y1) = vertices[:, :2].min(0) - APRON, vertices[:, :2].max(0) + APRON
        ground = [(float(x0), float(y0), float(x1), float(y1))]
    names = list(dict.fromkeys(p.name for p in pieces))
    total = sum(len(p.faces) for p in pieces)
    things = []
    for name in names:
        group = [p for p in pieces if p.name == name]
        share = sum(len(p.faces) for p in group) / total
        mesh = piece_mesh(group, max(64, int(limits.SET_TRIANGLES * share)))
        boxes = _boxes(group, max(4, int(SET_BOXES * share)), STEP_OVER)
        things.append((name, FileProp(mesh, tuple(boxes))))
    return FileSet(tuple(things), tuple(ground), own)


def on_ground(definition: FileSetDef, scenery: FileSet) -> FileSetDef:
    """The set with its ground where the file has it; what it places stays where it is in the file's axes."""
    box = np.array(scenery.floors)
    (x0, y0), (x1, y1) = box[:, :2].min(0).tolist(), box[:, 2:].max(0).tolist()
    (ground,) = definition.rooms
    placed = tuple(
        replace(p, at=(p.at[0] - x0, p.at[1] - y0)) if p.wall is None else p for p in ground.placed
    )
    spots = tuple(replace(s, at=(s.at[0] - x0, s.at[1] - y0, s.at[2])) for s in ground.spots)
    size = (x1 - x0, y1 - y0, ground.size[2])
    moved = replace(ground, at=(x0, y0, 0.0), size=size, placed=placed, spots=spots)
    return replace(definition, rooms=(moved,))


def _fit(model: ModelFile) -> Fit:
    return Fit(model.up, model.turn, model.scale, model.height, model.length, model.width)


def _joined(pieces: list[Piece] | tuple[Piece, ...]) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    offsets = np.cumsum([0, *(len(p.vertices) for p in pieces[:-1])])
    faces = [p.faces.astype(np.int64) + o for p, o in zip(pieces, offsets, strict=True)]
    return np.concatenate([p.vertices for p in pieces]), np.concatenate(faces)


def _boxes(
    pieces: list[Piece] | tuple[Piece, ...], most: int, above: float = -np.inf
) -> list[tuple[NDArray[np.float64], NDArray[np.float64]]]:
    vertices, faces = _joined(pieces)
    used = vertices[faces.ravel()]
    cell = max(0.1, float(np.ptp(used[:, :2], axis=0).max()) / 14.0)
    return column_boxes(vertices, faces, cell, most, above)
