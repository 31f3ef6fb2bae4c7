"""What the documents say, and that docs/output.md says what they hold."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import emit_film as f
import numpy as np
import pytest

from vdsl.cinema.measures import MEASURES
from vdsl.emit.build import write_build
from vdsl.emit.documents import dump, rounded
from vdsl.emit.report_json import report_document, write_report
from vdsl.emit.types import RunReport, Stage, Trade
from vdsl.lang.ir import Transition

DOCS = Path(__file__).parents[2] / "docs" / "output.md"
REPORT = RunReport(
    12.5, (Stage("render", 2.0, 300, "frames"), Stage("check", 0.0)), 3, 4, 900.0, "cpu", ("a",)
)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("build")
    write_build(path, film(path))
    write_report(path / "report.json", REPORT)
    return path


def film(path: Path) -> Any:
    two = f.line(("anna", "give", "cup", "ben"), ("ben", "wave"))
    shots = [
        f.built(path, "s1", story=two, say="Hi"),
        f.built(path, "s2", 14, 150, Transition("dissolve", 0.25)),
    ]
    trades = (Trade("s2", 2, 3, 0.81, 0.86, ("line", "jump")),)
    return f.film(shots, continuity=(f.crossing("s1", "s2"),), trades=trades)


def read(path: Path) -> Any:
    return json.loads(path.read_text("utf-8"))


def test_storyboard_names_files_that_exist(folder: Path) -> None:
    board = read(folder / "storyboard.json")
    assert board["schema"] == "vds.storyboard/1"
    assert (board["fps"], board["size"], board["seed"]) == ([24, 1], [128, 72], 7)
    takes = [t for s in board["shots"] for t in s["takes"]]
    assert len(takes) == 4
    assert all((folder / t[k]).stat().st_size > 100 for t in takes for k in ("video", "poster", "track"))
    for name in ("index.html", "animatic.mp4", "sheet.png", "report.json"):
        assert (folder / name).stat().st_size > 100


def test_storyboard_tells_the_story(folder: Path) -> None:
    first, second = read(folder / "storyboard.json")["shots"]
    assert first["story"] == {"char": "anna", "do": "give", "target": "cup", "second": "ben"}
    assert first["together"] == [{"char": "ben", "do": "wave", "target": None, "second": None}]
    assert first["text"] == "anna give cup to ben + ben wave"
    assert first["camera"] == {"movement": "push", "scale": "medium", "angle": "eye-level"}
    assert first["asked"]["movement"] == ["push", "pull"]
    assert (first["start"], first["frames"], second["start"], second["frames"]) == (0, 12, 6, 14)
    assert second["enter"] == first["leave"] == {"kind": "dissolve", "frames": 6}
    assert first["takes"][0]["measures"] == {"clearance": 0.333333, "headroom": None, "visibility": 0.98}
    assert first["rejected"] == {"hidden": 2, "wall": 5}


def test_storyboard_tells_what_cuts_break_and_what_was_traded(folder: Path) -> None:
    board = read(folder / "storyboard.json")
    (found,) = board["continuity"]
    assert (found["rule"], found["severity"], found["cut"], found["shots"]) == (
        "line",
        "fault",
        [1, 2],
        ["s1", "s2"],
    )
    assert (found["degrees"], found["text"]) == (41.2, "cut 1→2 crosses the line by 41° (anna–ben)")
    (trade,) = board["trades"]
    assert board["edited"] is True
    assert trade["text"] == (
        "shot 2: take 3 instead of 1 (score 0.81 instead of 0.86) keeps the line and avoids a jump cut"
    )
    page = (folder / "index.html").read_text("utf-8")
    assert found["text"] in page
    assert trade["text"] in page


def test_track_holds_the_camera_in_metres_and_degrees(folder: Path) -> None:
    track = read(folder / "shots" / "s1" / "take-2.json")
    source = f.track(12)
    assert (track["schema"], track["frames"], track["fps"], track["rig"]) == (
        "vds.track/1",
        12,
        [24, 1],
        "cinema",
    )
    np.testing.assert_allclose(track["camera"]["position"], source.position, atol=1e-9)
    np.testing.assert_allclose(np.deg2rad(track["camera"]["rotation_deg"]), source.rotation, atol=1e-9)
    np.testing.assert_allclose(track["camera"]["focal_mm"], source.focal)
    assert np.shape(track["camera"]["look_at"]) == (12, 3)
    assert track["params"] == {"easing": "slow-in", "lambda": 10.0, "r": round(1 / 3, 12)}
    assert track["subject"]["name"] == "anna"
    assert np.shape(track["subject"]["position"]) == (12, 3)


def test_same_film_same_bytes(tmp_path: Path, folder: Path) -> None:
    write_build(tmp_path, film(tmp_path))
    found = (p.relative_to(folder) for p in folder.rglob("*") if p.is_file())
    names = sorted(p for p in found if p.name != "report.json" and p.suffix != ".mp4")
    assert len(names) == 11
    assert [n for n in names if (folder / n).read_bytes() != (tmp_path / n).read_bytes()] == []


def test_report_counts_rates() -> None:
    report = report_document(REPORT)
    assert [s["per_second"] for s in report["stages"]] == [150.0, None]
    assert report["cache"] == {"hits": 3, "misses": 4}
    assert report["versions"]["numpy"] == np.__version__


def test_numbers_print_one_way() -> None:
    assert str(rounded(-1e-12, 9)) == "0.0"
    assert rounded(float("inf"), 3) is None
    assert dump({"a": [[1, 2], [3, 4]], "b": []}) == '{\n "a": [\n  [1, 2],\n  [3, 4]\n ],\n "b": []\n}\n'
    assert json.loads(dump({"é\ud800": "日本"})) == {"é?": "日本"}


def fields(value: Any, prefix: str = "") -> set[str]:
    """Paths of all fields, ``shots[].takes[].rank``; values of free-form maps are not fields."""
    free = (
        "params",
        "arguments",
        "measures",
        "numbers",
        "rejected",
        "versions",
        "movements",
        "scales",
        "angles",
        "characters",
        "scenes",
    )
    out: set[str] = set()
    if isinstance(value, dict):
        for key, inner in value.items():
            path = f"{prefix}{key}"
            out |= {path} | (set() if key in free and isinstance(inner, dict) else fields(inner, path + "."))
    elif isinstance(value, list) and value and isinstance(value[0], dict):
        out |= fields(value[0], prefix[:-1] + "[].")
    return out


def test_documented_measures_are_the_measures() -> None:
    section = DOCS.read_text("utf-8").split("## Measures of a take", 1)[1].split("\n## ", 1)[0]
    documented = re.findall(r"^\| `([^`]+)` \|", section, re.MULTILINE)
    assert documented == [*dict.fromkeys(documented)]
    assert set(documented) == {*MEASURES, "picture_visibility", "geometry"}


@pytest.mark.parametrize(
    ("schema", "name"),
    [
        ("vds.storyboard/1", "storyboard.json"),
        ("vds.track/1", "shots/s1/take-1.json"),
        ("vds.report/1", "report.json"),
    ],
)
def test_documented_fields_are_the_fields(folder: Path, schema: str, name: str) -> None:
    document = read(folder / name)
    assert document["schema"] == schema
    if "shots" in document:  # the first shot has every field filled in
        document["shots"][0]["enter"] = document["shots"][1]["enter"]
    section = DOCS.read_text("utf-8").split(f"`{schema}`", 1)[1].split("\n## ", 1)[0]
    documented = set(re.findall(r"^\| `([^`]+)` \|", section, re.MULTILINE))
    assert documented == fields(document)
