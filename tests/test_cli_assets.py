"""``vdsc assets`` and ``vdsc preview`` as a writer meets them."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from typer.testing import CliRunner, Result

from vdsl.cli import app
from vdsl.library import Catalog

OWN = """\
storyboard "Own"
# A thing to sit on.
prop pouf(size 40cm) {
    cylinder size / 2, height 35cm, at (0, 0, 0), color crimson
    spot seat, at (0, 0, 35cm), facing -90deg
}
action salaam {
    group gesture
    example "anna salaam"
    duration 1.6s
    at 40% { body bow 25deg; arm right swing 40deg, bend 100deg }
}
character anna = woman
scene kitchen = apartment.kitchen
anna at door facing window
(anna salaam)
"""


def vdsc(*arguments: str | Path) -> Result:
    return CliRunner().invoke(app, [str(a) for a in arguments])


@pytest.fixture
def own(tmp_path: Path) -> Path:
    path = tmp_path / "own.vds"
    path.write_text(OWN)
    return path


# -- lists -----------------------------------------------------------------------------------


def test_the_overview_counts_every_kind() -> None:
    result = vdsc("assets")
    assert result.exit_code == 0
    counts = dict(re.findall(r"(\d+) (sets|props|cast|actions)", result.stdout)[i][::-1] for i in range(4))
    catalog = Catalog()
    kinds = {"sets": "set", "props": "prop", "cast": "cast", "actions": "action"}
    assert {k: int(n) for k, n in counts.items()} == {k: len(catalog.names(v)) for k, v in kinds.items()}


@pytest.mark.parametrize(
    ("kind", "name", "keys"),
    [
        ("sets", "apartment", {"places", "time", "outdoor"}),
        ("props", "table", {"parameters", "spots", "parts", "movable"}),
        ("cast", "woman", {"parameters"}),
        ("actions", "pour", {"target", "variants", "example", "props", "group"}),
    ],
)
def test_json_is_a_list_of_objects_with_names(kind: str, name: str, keys: set[str]) -> None:
    rows = json.loads(vdsc("assets", kind, "--json").stdout)
    assert [row["name"] for row in rows] == sorted(row["name"] for row in rows)
    (row,) = (row for row in rows if row["name"] == name)
    assert keys <= row.keys()
    assert json.loads(vdsc("assets", kind, name, "--json").stdout) == [row]


def test_search_wants_every_word() -> None:
    names = [row["name"] for row in json.loads(vdsc("assets", "actions", "--json", "-s", "give cup").stdout)]
    assert "give" in names
    assert "walk" not in names
    assert json.loads(vdsc("assets", "actions", "--json", "-s", "nosuchword").stdout) == []


def test_one_set_shows_its_tree_with_spots() -> None:
    text = vdsc("assets", "sets", "apartment").stdout
    assert re.search(r"^kitchen \(room\): middle$", text, re.MULTILINE)
    assert re.search(r"^  table: .*top", text, re.MULTILINE)
    assert "morning light" in text  # what the comment above the definition says
    assert vdsc("assets", "sets", "apartment.kitchen").stdout == text  # as scenes are written


def test_names_are_forgiven_and_suggested() -> None:
    assert vdsc("assets", "actions", "Pick Up").exit_code == 0
    result = vdsc("assets", "sets", "ofice")
    assert result.exit_code == 2
    assert "did you mean `office`" in result.stderr


def test_a_scripts_own_definitions_count(own: Path) -> None:
    assert vdsc("assets", "props", "pouf").exit_code == 2
    result = vdsc("assets", "props", "pouf", "--file", own)
    assert result.exit_code == 0
    assert "A thing to sit on." in result.stdout
    assert "size" in result.stdout


# -- pictures --------------------------------------------------------------------------------


def varied(path: Path) -> bool:
    """Whether something is to be seen."""
    picture = np.asarray(Image.open(path).convert("L"), float)
    return bool(picture.std() > 8)


def test_an_own_action_is_drawn_pose_by_pose(own: Path, tmp_path: Path) -> None:
    out = tmp_path / "salaam.png"
    result = vdsc("assets", "actions", "salaam", "--file", own, "--preview", out)
    assert result.exit_code == 0, result.stderr
    assert varied(out)
    strip = np.asarray(Image.open(out).convert("L"), float)[50:320]
    first, middle = strip[:, 14:244], strip[:, 14 + 3 * 234 : 14 + 3 * 234 + 230]
    assert np.abs(first - middle).mean() > 1.0  # she bows


@pytest.mark.parametrize(
    ("kind", "name"), [("props", "cup"), ("cast", "chef"), ("sets", "office"), ("props", "pouf")]
)
def test_pictures_of_each_kind(kind: str, name: str, own: Path, tmp_path: Path) -> None:
    out = tmp_path / "p.png"
    result = vdsc("assets", kind, name, "--file", own, "--preview", out)
    assert result.exit_code == 0, result.stderr
    assert varied(out)


def test_what_cannot_be_drawn_says_why(own: Path, tmp_path: Path) -> None:
    own.write_text(OWN.replace('    example "anna salaam"\n', ""))
    result = vdsc("assets", "actions", "salaam", "--file", own, "--preview", tmp_path / "x.png")
    assert result.exit_code == 2
    assert "has no example" in result.stderr
    result = vdsc("assets", "props", "cup", "--preview", tmp_path / "no" / "x.png")
    assert result.exit_code == 3


# -- scenes ----------------------------------------------------------------------------------


def test_a_scene_from_above_and_by_a_camera(own: Path, tmp_path: Path) -> None:
    top, camera = tmp_path / "top.png", tmp_path / "camera.png"
    assert vdsc("preview", own, "-o", top).exit_code == 0
    result = vdsc("preview", own, "--from", "(static wide high-angle)", "--scene", "kitchen", "-o", camera)
    assert result.exit_code == 0, result.stderr
    assert varied(top)
    assert Image.open(camera).size == (1280, 720)
    assert varied(camera)


def test_preview_tells_wrong_scenes_and_cameras(own: Path, tmp_path: Path) -> None:
    result = vdsc("preview", own, "--scene", "kitchn")
    assert result.exit_code == 2
    assert "did you mean `kitchen`" in result.stderr
    result = vdsc("preview", own, "--from", "(statik wide)", "-o", tmp_path / "x.png")
    assert result.exit_code == 1
    assert "statik" in result.stdout + result.stderr
    assert not (tmp_path / "x.png").exists()
