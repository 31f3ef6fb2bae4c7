"""Camera words as people type them: understood, or answered with the word that is meant."""

from __future__ import annotations

import pytest

from vdsl.lang import Report, Source
from vdsl.pipeline.script import ScriptError, check_source

STORY = """\
storyboard "Words"
character anna = woman
character ben = man
scene street = suburb_street
anna at bus_stop facing ben
ben at bus_stop.bench facing anna
(ben talk anna) / ({})
"""

UNDERSTOOD = {
    "closeup": ("scales", "close-up"),
    "CU": ("scales", "close-up"),
    "close up": ("scales", "close-up"),
    "MCU": ("scales", "medium-close-up"),
    "ECU": ("scales", "extreme-close-up"),
    "WS": ("scales", "wide"),
    "wide shot": ("scales", "wide"),
    "long shot": ("scales", "wide"),
    "establishing shot": ("scales", "wide"),
    "master": ("scales", "wide"),
    "mid shot": ("scales", "medium"),
    "headshot": ("scales", "close-up"),
    "American shot": ("scales", "cowboy"),
    "plan américain": ("scales", "cowboy"),
    "bust": ("scales", "medium-close-up"),
    "knee shot": ("scales", "medium-long"),
    "tracking shot": ("movements", "follow"),
    "track left": ("movements", "dolly-left"),
    "truck left": ("movements", "dolly-left"),
    "boom up": ("movements", "pedestal-up"),
    "jib down": ("movements", "crane-down"),
    "push in": ("movements", "push"),
    "dolly out": ("movements", "pull"),
    "steadicam": ("movements", "follow"),
    "panning left": ("movements", "pan-left"),
    "orbit right": ("movements", "arc-right"),
    "hand held": ("movements", "handheld"),
    "focus pull": ("movements", "rack-focus"),
    "lock-off": ("movements", "static"),
    "bird's-eye": ("angles", "overhead"),
    "birds-eye view": ("angles", "overhead"),
    "top shot": ("angles", "overhead"),
    "worm's-eye": ("angles", "worms-eye"),
    "hi angle": ("angles", "high-angle"),
    "from below": ("angles", "low-angle"),
    "low level": ("angles", "ground-level"),
}
VIEWS = {
    "OTS": "ots",
    "over the shoulder": "ots",
    "POV": "pov",
    "point of view": "pov",
    "two shot": "two-shot",
}
ANSWERED = {
    "crash zoom medium": "zoom-in",
    "slow push in medium": "push",
    "drone wide": "crane-up",
    "aerial wide": "overhead",
    "static insert": "extreme-close-up",
    "static reaction shot": "close-up",
    "Nahaufnahme static": "close-up",
    "gros plan static": "close-up",
    "primer plano static": "close-up",
    "push medim": "medium",
    "statik medium": "static",
    "zom-in medium": "zoom-in",
    "static bird's eye": "overhead",
    "static worm's eye": "worms-eye",
    "static 2-shot": "two-shot",
    "360 medium": "arc",
}


def read(words: str) -> Report:
    report = Report()
    try:
        check_source(Source("words.vds", STORY.format(words)), report)
    except ScriptError as error:
        return error.report
    return report


@pytest.mark.parametrize("words", UNDERSTOOD)
def test_words_of_the_trade_are_understood(words: str) -> None:
    slot, meant = UNDERSTOOD[words]
    board = check_source(Source("words.vds", STORY.format(words)), Report()).storyboard
    assert getattr(board.lines[0].shots[0], slot) == (meant,)


@pytest.mark.parametrize("words", VIEWS)
def test_views_are_understood(words: str) -> None:
    board = check_source(Source("words.vds", STORY.format(f"static {words}")), Report()).storyboard
    assert board.lines[0].shots[0].view == VIEWS[words]


@pytest.mark.parametrize("words", ["dutch tilt", "Dutch angle", "canted"])
def test_leaning_pictures_are_understood(words: str) -> None:
    board = check_source(Source("words.vds", STORY.format(f"static medium {words}")), Report()).storyboard
    assert board.lines[0].shots[0].roll > 0.1


@pytest.mark.parametrize("words", ANSWERED)
def test_others_are_answered_with_what_is_meant(words: str) -> None:
    (error,) = read(words).errors
    assert ANSWERED[words] in (error.suggestion, error.fix)
    assert error.help


@pytest.mark.parametrize(
    ("behind", "shown"),
    [("ots anna", "`/ (ots anna static medium)`"), ("close-up", "`/ (static close-up eye-level)`")],
)
def test_camera_words_after_the_parenthesis_are_shown_where_they_belong(behind: str, shown: str) -> None:
    with pytest.raises(ScriptError) as told:
        check_source(Source("words.vds", f"{STORY.format('static medium').rstrip()} {behind}\n"), Report())
    (found,) = told.value.report.diagnostics
    assert (found.code, shown in str(found.help)) == ("VDS050", True)


def test_a_view_that_the_paper_has_not_is_one_error_with_its_name() -> None:
    text = STORY.replace("character anna", "rig paper\ncharacter anna").format("static medium ots ben")
    with pytest.raises(ScriptError) as caught:
        check_source(Source("words.vds", text), Report())
    assert [d.code for d in caught.value.report.errors] == ["VDS046"]
