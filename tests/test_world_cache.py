"""Built worlds on disk: the same as built anew, found again by content, mended when damaged."""

from __future__ import annotations

import shutil
from dataclasses import fields
from pathlib import Path

import numpy as np
import pytest

import vdsl.stage.cache as cache
from runtime.mesh import Mesh
from runtime.world import Hinge, Solids, World
from vdsl.lang.ast import Definition
from vdsl.lang.definitions.set import SetDef, read_set
from vdsl.lang.diagnostics import Report
from vdsl.lang.parse import parse_definition
from vdsl.lang.source import Source
from vdsl.library.loader import LIBRARY, Catalog
from vdsl.stage.cache import load_world
from vdsl.stage.world import build_world

TEXT = """set flat {
    room low, at (0, 0)m, size (5, 6, 2.6)m {
        door, wall south, at 2.6m, open 30deg
        stairs, at (0.62, 0.9)m, to high
        place fridge = fridge, wall north, at 3m
        place table = table, at (3, 2)m { place cup = cup, on top }
    }
    room high, at (0, 0, 2.85)m, size (5, 6, 2.4)m { window, wall west, at 3m }
}
"""


def definition(text: str = TEXT) -> SetDef:
    report = Report()
    parsed = parse_definition(Source("test.vds", text), "set", "flat", report)
    assert isinstance(parsed, Definition)
    found = read_set(parsed, report)
    assert found is not None
    assert not report.errors, report.diagnostics
    return found


def same(a: object, b: object) -> bool:
    if isinstance(a, np.ndarray):
        return isinstance(b, np.ndarray) and a.dtype == b.dtype and np.array_equal(a, b)
    if isinstance(a, tuple):
        return isinstance(b, tuple) and len(a) == len(b) and all(map(same, a, b))
    if isinstance(a, (Mesh, Hinge, Solids, World)) or hasattr(a, "world_from_object"):
        return type(a) is type(b) and all(same(getattr(a, f.name), getattr(b, f.name)) for f in fields(a))  # type: ignore[arg-type]
    return a == b


def test_a_world_from_disk_is_the_one_that_was_built(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    built = build_world(definition(), Catalog())
    assert same(load_world(definition(), Catalog(), cache=tmp_path), built)
    monkeypatch.setattr(cache, "build_world", None)  # from here on everything comes from disk
    assert same(load_world(definition(), Catalog(), cache=tmp_path), built)
    assert len(list(tmp_path.iterdir())) == 1


def test_what_it_is_made_of_decides(tmp_path: Path) -> None:
    load_world(definition(), Catalog(), cache=tmp_path)
    load_world(definition(TEXT.replace("(3, 2)m", "(3, 2.1)m")), Catalog(), cache=tmp_path)
    load_world(definition(), Catalog(), "dusk", cache=tmp_path)
    load_world(definition(), Catalog(), room=("high",), cache=tmp_path)
    report = Report()
    from vdsl.lang import parse

    script, _ = parse(
        Source("own.vds", "prop cup {\n    box (8cm, 8cm, 9cm)\n    grip (0, 0, 4cm)\n}\n"), report
    )
    load_world(definition(), Catalog.for_script(script, report), cache=tmp_path)
    assert len(list(tmp_path.glob("*.npz"))) == 5


def test_a_prop_of_the_library_that_changes_is_built_anew(tmp_path: Path) -> None:
    library = tmp_path / "library"
    for folder in ("props", "sets"):
        shutil.copytree(LIBRARY / folder, library / folder)
    before = load_world(definition(), Catalog(library=library), cache=tmp_path / "worlds")
    (library / "props" / "aaa.vds").write_text(
        "prop cup {\n    box (8cm, 8cm, 30cm)\n    grip (0, 0, 4cm)\n}\n"
    )
    after = load_world(definition(), Catalog(library=library), cache=tmp_path / "worlds")
    heights = [next(o for o in w.objects if o.path[-1] == "cup").high[2] for w in (before, after)]
    assert heights[1] > heights[0] + 0.1


def test_nothing_is_parsed_for_a_world_on_disk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    load_world(definition(), Catalog(), cache=tmp_path)
    catalog = Catalog()
    monkeypatch.setattr(catalog, "get", None)
    load_world(definition(), catalog, cache=tmp_path)


@pytest.mark.parametrize("harm", ["cut", "empty", "text", "arrays"])
def test_a_damaged_file_is_built_anew(tmp_path: Path, harm: str) -> None:
    built = load_world(definition(), Catalog(), cache=tmp_path)
    (path,) = tmp_path.iterdir()
    whole = path.read_bytes()
    if harm == "arrays":
        np.savez(path, **(cache.packed(built) | {"mesh_faces": built.mesh.faces + 10**6}))
    else:
        path.write_bytes({"cut": whole[: len(whole) // 2], "empty": b"", "text": b"not a world"}[harm])
    assert same(load_world(definition(), Catalog(), cache=tmp_path), built)
    with np.load(path) as data:
        assert "story" in data.files


def test_a_folder_that_cannot_be_written_is_no_error(tmp_path: Path) -> None:
    file = tmp_path / "file"
    file.write_text("in the way")
    assert load_world(definition(), Catalog(), cache=file).name == "flat"


def test_the_longest_unused_go_first(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cache, "MOST", 2)
    for time in ("dawn", "day", "dusk"):
        load_world(definition(), Catalog(), time, cache=tmp_path)
    assert len(list(tmp_path.iterdir())) == 2
