"""The catalogue of camera styles: all read, all filmed as they say, listed and described."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from typer.testing import CliRunner

from vdsl.cinema.styles import SITUATIONS, Style, styles
from vdsl.cli import app
from vdsl.lang.ir import ALL_ANGLES, MOVEMENTS, SIZES, VIEWS
from vdsl.pipeline.catalogue import CELL, SHOWN, Catalogue, groups, pages
from vdsl.propose.cameras import subject_of
from vdsl.propose.promise import achieved

DOCS = Path(__file__).parents[2] / "docs" / "styles"


@pytest.fixture(scope="module")
def catalogue() -> Catalogue:
    return Catalogue("cpu")


def test_there_are_more_than_150_and_every_word_is_among_them() -> None:
    all_of_them = styles()
    assert len({(s.movement, s.size, s.angle, s.view, s.option) for s in all_of_them}) >= 150
    assert len({s.name for s in all_of_them}) == len(all_of_them)
    assert {s.movement for s in all_of_them} >= set(MOVEMENTS)
    assert {s.size for s in all_of_them} == set(SIZES)
    assert {s.angle for s in all_of_them} - {""} == set(ALL_ANGLES)
    assert {s.view.split(" ")[0] for s in all_of_them} - {""} == set(VIEWS)
    assert {s.situation for s in all_of_them} == set(SITUATIONS)


@pytest.mark.parametrize("group", [name for name, _ in groups()])
def test_every_style_is_filmed_as_it_says(group: str, catalogue: Catalogue) -> None:
    for style in dict(groups())[group]:
        shot, grid = catalogue.propose(style, 8)
        assert grid.let_in == 0, style.words
        assert len(grid.cameras) == 8, style.words
        assert (shot.movements, shot.scales) == ((style.movement,), (style.size,))
        assert shot.angles == (style.angle,) or not style.angle
        filming = catalogue.situation(style)[0].filming
        faithful = 0
        for camera in grid.cameras:
            found = achieved(camera, subject_of(shot, grid.story[camera.story], filming), filming.rig)
            kept = found.kept(camera) if style.angle else found.kept(camera) | {"angle": True}
            faithful += all(kept.values())
        assert faithful >= 6, style.words


def test_a_strip_shows_first_middle_and_last(catalogue: Catalogue) -> None:
    changes = {}
    for words in ("(push full eye-level)", "(static full eye-level)"):
        style = next(s for s in styles() if s.words == words)
        image = np.asarray(catalogue.strip(style, (96, 54)), float)
        assert image.shape == (54, SHOWN * 96 + 4 * (SHOWN - 1), 3)
        changes[style.movement] = np.abs(image[:, :96] - image[:, -96:]).mean()
    assert changes["push"] > 4.0 * changes["static"]


def test_the_pages_are_those_of_the_table_and_every_strip_is_there() -> None:
    for name, text in pages().items():
        assert (DOCS / name).read_text("utf-8") == text, "run `make styles`"
    drawn = {path.stem for path in (DOCS / "images").glob("*.jpg")}
    assert drawn == {style.name for style in styles()}
    assert sum(path.stat().st_size for path in (DOCS / "images").iterdir()) < 6_000_000
    with Image.open(DOCS / "images" / "push_medium_eye-level.jpg") as image:
        assert image.size == (SHOWN * CELL[0] + 4 * (SHOWN - 1), CELL[1])


Vdsc = Callable[..., str]


@pytest.fixture
def vdsc() -> Vdsc:
    def run(*arguments: str, fails: bool = False) -> str:
        result = CliRunner().invoke(app, ["assets", "styles", *arguments])
        assert (result.exit_code != 0) == fails
        return result.output

    return run


def test_they_are_listed_as_json(vdsc: Vdsc) -> None:
    told = json.loads(vdsc("--json"))
    assert told["schema"] == "vds.styles/1"
    assert len(told["styles"]) == len(styles())
    push = next(s for s in told["styles"] if s["words"] == "(push medium high-angle)")
    assert push["line"] == "(anna wave) / (push medium high-angle)"
    assert push["means"] == "the camera comes nearer; down to the waist; from above"
    assert "μ ∈ [0.5, 0.8]" in push["varies"]


def test_they_are_searched_and_shown_one_by_one(vdsc: Vdsc) -> None:
    found = vdsc("--search", "push low")
    assert "(push full low-angle)" in found
    assert "(pull full low-angle)" not in found
    assert "goes round its subject" in vdsc("arc-left medium low-angle")
    assert "did you mean `push_medium_eye-level`?" in vdsc("push_medium_eyelevel", fails=True)


def test_a_style_says_what_it_is_in_words() -> None:
    two = Style("push+pan-left", "close-up", "eye-level")
    assert two.means == "the camera comes nearer and turns left; down to the collar; level"
    assert two.line == "(anna wave) / (push+pan-left close-up eye-level)"
