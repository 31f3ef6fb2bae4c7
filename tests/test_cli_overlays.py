"""Overlays as a writer asks for them: guides and the strip on frames of a build, and letters nobody has."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from typer.testing import CliRunner, Result

import vdsl
from vdsl.cli import app
from vdsl.emit.guides import Guides
from vdsl.lang import Source
from vdsl.pipeline.letters import warn_of_letters
from vdsl.pipeline.options import Options
from vdsl.pipeline.script import check_source

STORY = """\
storyboard "Over"
size 320x180
proposals 4
takes 1

character anna = woman

scene kitchen = apartment.kitchen
anna at door facing window

(anna wave)  / (static full eye-level) 1s
"""


def vdsc(*arguments: object) -> Result:
    return CliRunner().invoke(app, [str(a) for a in arguments])


@pytest.fixture
def story(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "story.vds").write_text(STORY)
    return tmp_path / "story.vds"


def poster(folder: Path) -> np.ndarray:
    (path,) = folder.glob("shots/*/take-1.jpg")
    return np.asarray(Image.open(path).convert("RGB")).astype(float)


def test_a_build_with_guides_and_a_strip_and_one_without(story: Path) -> None:
    plain = ("compile", story, "--rank", "geometry", "--device", "cpu")
    assert vdsc(*plain, "-o", "plain").exit_code == 0
    drawn = vdsc(*plain, "--guides", "4:3,cross", "--burn-in", "-o", "drawn")
    assert drawn.exit_code == 0, drawn.output
    one, two = poster(Path("plain")), poster(Path("drawn"))
    edge = (320 - 240) // 2
    for side in (slice(0, edge - 2), slice(-edge + 2, None)):
        assert two[:150, side].mean() < 0.3 * one[:150, side].mean()
    centre = np.s_[20:80, edge + 10 : -edge - 10]
    assert np.abs(one[centre] - two[centre]).mean() < 6
    strip = two[-14:, :120].mean(-1)
    assert (strip > 170).any()  # letters
    assert np.median(strip) < 90  # on the strip
    assert (Path("plain") / "plans" / "1.svg").is_file()


def test_the_sheet_can_be_had_without_arrows(story: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[Options] = []

    def compile_file(path: Path, out: Path | None, options: Options, progress: object = None) -> None:
        asked.append(options)
        raise KeyboardInterrupt

    monkeypatch.setattr("vdsl.pipeline.compile.compile_file", compile_file)
    assert vdsc("compile", story, "--no-arrows").exit_code == 130
    assert vdsc("compile", story).exit_code == 130
    with pytest.raises(KeyboardInterrupt):
        vdsl.compile(story, arrows=False)
    assert [options.arrows for options in asked] == [False, True, False]


def test_guides_that_are_none_are_refused_at_once(story: Path) -> None:
    result = vdsc("compile", story, "--guides", "halves")
    assert result.exit_code == 2
    assert "is no guide" in result.stderr
    with pytest.raises(ValueError, match="is no guide"):
        vdsl.compile(story, guides="halves")
    assert not Path("build").exists()


def test_python_asks_for_guides_as_well(story: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[Options] = []
    monkeypatch.setattr(
        "vdsl.pipeline.compile.compile_file", lambda path, out, options: asked.append(options)
    )
    vdsl.compile(story, guides="safe,2.39", burn_in=True)
    assert asked == [Options(burn_in=True, guides=Guides(safe=True, mask=2.39))]


def test_letters_that_no_typeface_has_are_told_once(story: Path) -> None:
    text = STORY.replace("1s", '1s, say "\U000f1234 and \U000f1235", note "\U000f1234"')
    checked = check_source(Source("story.vds", text))
    warn_of_letters(checked.storyboard, checked.report)
    (found,) = (d for d in checked.report.diagnostics if d.code == "VDS330")
    assert "\U000f1234 \U000f1235" in found.label
    assert "apt install" in (found.help or "")
    plain = check_source(Source("story.vds", STORY.replace("1s", '1s, say "Déjà vu – Утро"')))
    warn_of_letters(plain.storyboard, plain.report)
    assert not plain.report.diagnostics
