"""Built worlds, kept on disk between runs by what they are made of.

A world is found again by the text of its set, of the script's own props in it and of all the library's props,
the hour, the room it is seen from and the code that builds it; none of it is parsed for that. Guarantees that
a file that is damaged or of another version is built anew, that two who write at once do not harm each other,
and that a disk that is full or may not be written is no error.
Sets and props out of other programs' files are always built.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Iterator
from dataclasses import asdict
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from platformdirs import user_cache_path

import runtime
import vdsl
from runtime.keeping import keep
from runtime.mesh import Mesh
from runtime.world import Hinge, Level, Light, Solids, Spot, Stairs, Wall, World, WorldObject

from ..lang.definitions.files import FileDef
from ..lang.definitions.placing import Placed, walk_placed
from ..lang.definitions.set import SetDef
from ..library import Catalog
from .world import build_world

#: Raised when the layout of the files changes.
VERSION = 1
#: So many worlds are kept; the longest unused ones go first.
MOST = 160
_MESH = ("vertices", "faces", "normals", "colors", "parts", "materials")
_SOLIDS = ("centre", "half", "yaw", "wall", "object")
_HINGE = ("pivot", "axis", "handle", "closed", "boxes")
#: What decides how a world is built.
_CODE = (
    "runtime/world.py",
    "runtime/shapes.py",
    "runtime/mesh.py",
    "runtime/materials.py",
    "vdsl/lang/evaluate.py",
)
_CODE_FOLDERS = ("vdsl/stage", "vdsl/lang/definitions")
Arrays = dict[str, NDArray[Any]]


def load_world(
    definition: SetDef,
    catalog: Catalog,
    time: str = "",
    room: tuple[str, ...] = (),
    cache: Path | None = None,
) -> World:
    """The world of a set as :func:`build_world` makes it, from disk where it was built before.

    cache: folder to use; None for the user's own
    """
    texts = _texts(definition, catalog)
    if texts is None:
        return build_world(definition, catalog, time, room)
    told = json.dumps([VERSION, _code(), texts, time or definition.time, list(room)])
    folder = user_cache_path("vdsl") / "worlds" if cache is None else cache
    path = folder / f"{hashlib.sha256(told.encode()).hexdigest()[:24]}.npz"
    found = _read(path)
    if found is None:
        found = build_world(definition, catalog, time, room)
        keep(path, packed(found), MOST)
    return found


def _texts(definition: SetDef, catalog: Catalog) -> tuple[str, ...] | None:
    """What the set and its props are written as; None where some of it is not text."""
    if isinstance(definition, FileDef):
        return None
    props = catalog.written("prop", dict.fromkeys(sorted(_props(definition))))
    return None if props is None else (definition.span.text, *props)


def _props(definition: SetDef) -> Iterator[str]:
    placed: list[Placed] = []
    for room in definition.rooms:
        yield from (opening.call.callee.text for opening in room.openings)
        placed += [*room.placed, *(p for platform in room.platforms for p in platform.placed)]
    yield from (item.prop for item, _ in walk_placed(tuple(placed)))


@lru_cache(maxsize=1)
def _code() -> str:
    """A digest of the sources that build worlds."""
    root = Path(vdsl.__file__).parents[1]
    files = [root / name for name in _CODE]
    for name in _CODE_FOLDERS:
        files += sorted((root / name).glob("*.py"))
    digest = hashlib.sha256()
    for file in files:
        digest.update(file.read_bytes() if file.is_file() else runtime.__name__.encode())
    return digest.hexdigest()


# --- files ----------------------------------------------------------------------------------


def _read(path: Path) -> World | None:
    """The world in a file; None where the file is missing, damaged or not one of ours."""
    try:
        with np.load(path, allow_pickle=False) as data:
            arrays = {name: data[name] for name in data.files}
        world = unpacked(arrays)
        os.utime(path)
    except Exception:  # a cache file may hold anything; numpy, zipfile and json raise many kinds for it
        return None
    return world if sound(world) else None


def sound(world: World) -> bool:
    """Whether the arrays of a world fit together."""
    faces, count = len(world.mesh.faces), len(world.mesh.vertices)
    meshes = [world.mesh, *(o.mesh for o in world.objects if o.mesh is not None)]
    return (
        len(world.mesh_object) == len(world.mesh_wall) == faces
        and all(len(getattr(m, a)) == len(m.faces) for m in meshes for a in ("colors", "parts", "materials"))
        and all(len(m.normals) == len(m.vertices) and np.isfinite(m.vertices).all() for m in meshes)
        and all(not len(m.faces) or (m.faces.min() >= 0 and m.faces.max() < len(m.vertices)) for m in meshes)
        and len({len(getattr(world.solids, a)) for a in _SOLIDS}) == 1
        and (count > 0 or faces == 0)
    )


def packed(world: World) -> Arrays:
    """A world as named arrays, none of them of objects."""
    out: Arrays = {f"mesh_{name}": getattr(world.mesh, name) for name in _MESH}
    out |= {"faces_object": world.mesh_object, "faces_wall": world.mesh_wall}
    out |= {f"solid_{name}": getattr(world.solids, name) for name in _SOLIDS}
    out["placement"] = np.array([o.world_from_object for o in world.objects]).reshape(-1, 4, 4)
    moving = [o for o in world.objects if o.mesh is not None]
    for name in _MESH:
        parts = [getattr(o.mesh, name) for o in moving]
        out[f"moving_{name}"] = np.concatenate(parts) if parts else getattr(world.mesh, name)[:0]
    hinged = [o.hinge for o in world.objects if o.hinge is not None]
    for name in _HINGE:
        rows = [getattr(h, name).ravel() for h in hinged]
        out[f"hinge_{name}"] = np.concatenate(rows) if rows else np.zeros(0)
    story = {
        "name": world.name,
        "objects": [_object_row(o) for o in world.objects],
        "walls": [asdict(w) for w in world.walls],
        "floors": world.floors,
        "levels": [asdict(level) for level in world.levels],
        "stairs": [asdict(s) for s in world.stairs],
        "light": asdict(world.light),
        "outdoor": world.outdoor,
    }
    out["story"] = np.frombuffer(json.dumps(story).encode(), np.uint8)
    return out


def _object_row(item: WorldObject) -> dict[str, Any]:
    mesh, hinge = item.mesh, item.hinge
    return {
        "path": item.path,
        "kind": item.kind,
        "spots": [[s.name, s.position, s.facing] for s in item.spots],
        "bounds": [item.low, item.high],
        "mesh": None if mesh is None else [len(mesh.vertices), len(mesh.faces)],
        "grip": item.grip,
        "ajar": item.ajar,
        "hinge": None
        if hinge is None
        else [hinge.kind, hinge.open, hinge.owner, hinge.way, len(hinge.boxes)],
    }


def unpacked(arrays: Arrays) -> World:
    """The world that :func:`packed` made arrays of."""
    story = json.loads(arrays["story"].tobytes())
    meshes = _Cursor({name: arrays[f"moving_{name}"] for name in _MESH})
    hinges = _Cursor({name: arrays[f"hinge_{name}"] for name in _HINGE})
    objects = [
        _object(k, row, arrays["placement"][k], meshes, hinges) for k, row in enumerate(story["objects"])
    ]
    light = {name: _tuples(value) for name, value in story["light"].items()}
    return World(
        story["name"],
        Mesh(*(arrays[f"mesh_{name}"] for name in _MESH)),
        arrays["faces_object"],
        arrays["faces_wall"],
        tuple(objects),
        Solids(*(arrays[f"solid_{name}"] for name in _SOLIDS)),
        tuple(Wall(**{k: _tuples(v) for k, v in wall.items()}) for wall in story["walls"]),
        _tuples(story["floors"]),
        Light(**light),
        story["outdoor"],
        tuple(Level(**{k: _tuples(v) for k, v in level.items()}) for level in story["levels"]),
        tuple(Stairs(**{k: _tuples(v) for k, v in flight.items()}) for flight in story["stairs"]),
    )


class _Cursor:
    """Takes rows off the front of several arrays."""

    def __init__(self, arrays: Arrays) -> None:
        self._arrays = arrays
        self._at = dict.fromkeys(arrays, 0)

    def take(self, name: str, count: int) -> NDArray[Any]:
        start = self._at[name]
        self._at[name] = start + count
        out = self._arrays[name][start : start + count]
        if len(out) != count:
            raise ValueError("a cache file that ends too soon")
        return out


def _object(
    number: int, row: dict[str, Any], matrix: NDArray[np.float64], meshes: _Cursor, hinges: _Cursor
) -> WorldObject:
    mesh = None
    if row["mesh"] is not None:
        vertices, faces = row["mesh"]
        counts = {"vertices": vertices, "normals": vertices}
        mesh = Mesh(*(meshes.take(name, counts.get(name, faces)) for name in _MESH))
    hinge = None
    if row["hinge"] is not None:
        kind, open_, owner, way, boxes = row["hinge"]
        sizes = {"pivot": 3, "axis": 3, "handle": 3, "closed": 16, "boxes": 6 * boxes}
        a = {name: hinges.take(name, size) for name, size in sizes.items()}
        closed, solid = a["closed"].reshape(4, 4), a["boxes"].reshape(-1, 2, 3)
        hinge = Hinge(kind, a["pivot"], a["axis"], open_, a["handle"], closed, owner, solid, way)
    low, high = row["bounds"]
    spots = tuple(Spot(name, _tuples(at), facing) for name, at, facing in row["spots"])
    return WorldObject(
        number, tuple(row["path"]), row["kind"], spots, _tuples(low), _tuples(high), matrix, mesh,
        None if row["grip"] is None else _tuples(row["grip"]), hinge, row["ajar"],
    )  # fmt: skip


def _tuples(value: Any) -> Any:
    """Lists, as JSON has them, as tuples all the way down."""
    return tuple(_tuples(v) for v in value) if isinstance(value, list) else value
