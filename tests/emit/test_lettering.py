"""Text on pictures in any script: the typeface that comes along, those of the machine, and what none has."""

from __future__ import annotations

import os
import unicodedata

import numpy as np
import pytest
from PIL import Image, ImageDraw

from vdsl.emit import lettering, typefaces
from vdsl.emit.typefaces import BOLD, REGULAR, Face, lacking, runs, shows

#: Samples that a machine needs a typeface for: with Debian's fonts-dejavu-core, fonts-wqy-microhei all pass.
OTHERS = {
    "Chinese": "早上的咖啡",
    "Japanese": "朝のコーヒー",
    "Korean": "아침 커피",
    "Hebrew": "קפה של בוקר",
    "Arabic": "قهوة الصباح",
}


def drawn(text: str, bold: bool = False) -> np.ndarray:
    """Ink of a line, float [H, W]."""
    image = Image.new("L", (400, 50), 0)
    lettering.write(ImageDraw.Draw(image), (200, 25), text, 28, "#ffffff", "mm", bold=bold)
    return np.asarray(image).astype(float)


@pytest.mark.parametrize(
    "text", ["déjà vu – “naïve” …", "Кухня, утро", "Πρωινός καφές", "Tiếng Việt", "ČŘŽ łśź", "1 → 2"]
)
def test_latin_greek_and_cyrillic_need_no_other_face(text: str) -> None:
    assert runs(text) == [(REGULAR, text)]
    assert runs(text, BOLD) == [(BOLD, text)]
    assert lacking(text) == ""


@pytest.mark.parametrize("script", OTHERS)
def test_other_scripts_are_written_in_a_face_of_the_machine(script: str) -> None:
    text = OTHERS[script]
    if lacking(text):
        assert not os.environ.get("VDS_EXPECT_FONTS"), f"no typeface of this machine has {script}"
        pytest.skip(f"no typeface of this machine has {script}")
    ((face, piece),) = runs(text)
    assert face not in (REGULAR, BOLD)
    assert piece == text  # in one piece, so that its order can be found
    assert shows(face, text.replace(" ", ""))
    ink = drawn(text)
    boxes = drawn("\U0010fffe" * len(text))
    assert ink.sum() > 2000
    assert np.abs(ink - boxes).sum() > 2000
    columns = np.flatnonzero(ink.any(0))
    assert abs((columns[0] + columns[-1]) / 2 - 200) < 6  # measured as it is drawn


def test_right_to_left_is_drawn_from_the_right() -> None:
    if lacking("אב"):
        pytest.skip("no typeface of this machine has Hebrew")
    both, first = drawn("אבבבבבב"), drawn("א")
    columns = np.flatnonzero(both.any(0))
    width = np.ptp(np.flatnonzero(first.any(0))) + 1
    end = both[:, columns[-1] - width + 1 : columns[-1] + 1]
    alone = first[:, np.flatnonzero(first.any(0))[0] :][:, :width]
    assert np.abs(end - alone).mean() < 12  # alef, the first letter, stands at the right end


def test_a_line_of_two_scripts_is_written_in_pieces(monkeypatch: pytest.MonkeyPatch) -> None:
    """One face has the letters that the other lacks; neither has all."""
    other = Face("other.ttf")
    has = {REGULAR: "abc", other: "αβγ"}
    monkeypatch.setattr(
        typefaces, "_shown", lambda face, letters: frozenset(c for c in letters if c in has[face])
    )
    monkeypatch.setattr(typefaces, "_faces", lambda wanted: (REGULAR, other))
    monkeypatch.setattr(typefaces, "_seen", lambda text: frozenset(text) - {" "})
    assert runs("ab αβ ca") == [(REGULAR, "ab "), (other, "αβ "), (REGULAR, "ca")]
    assert lacking("abαβж") == "ж"


def test_without_fontconfig_common_names_are_tried(monkeypatch: pytest.MonkeyPatch) -> None:
    if lacking("א"):
        pytest.skip("no typeface of this machine has Hebrew")
    monkeypatch.setattr(typefaces.shutil, "which", lambda name: None)
    typefaces._face_for.cache_clear()
    found = typefaces._face_for("א")
    typefaces._face_for.cache_clear()
    assert found is not None
    assert shows(found, "א")


def test_what_nothing_has_is_told_and_drawn_as_boxes() -> None:
    private = "\ue8ff\U000f1234"
    assert lacking(f"a {private} b") == private
    assert drawn(private).sum() > 0
    assert lettering.width(private, 20) > 0


def test_marks_stay_with_their_letters() -> None:
    decomposed = unicodedata.normalize("NFD", "é à")
    assert [face for face, _ in runs(decomposed)] == [REGULAR]


def test_bold_is_wider_and_measured_as_such() -> None:
    assert lettering.width("Morning coffee", 40, bold=True) > lettering.width("Morning coffee", 40)
    assert drawn("Morning", bold=True).sum() > drawn("Morning").sum()
    words = "a rather long line of words for a narrow column"
    for line in lettering.wrapped(words, 20, 120, 9, bold=True):
        assert lettering.width(line, 20, bold=True) <= 120
