# ruff: noqa: E501 (whole scripts in a line)
"""Scripts without mistakes into storyboards: what names mean, what defaults are, what ids are."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from hypothesis import given, seed, settings
from hypothesis import strategies as st
from lang_helpers import HEAD, board, checked, codes
from small_catalog import SmallCatalog

from vdsl.lang import Report, Settings, Source, check, ir, parse
from vdsl.lang.codes import CODES
from vdsl.lang.ids import slug
from vdsl.lang.words import CAMERA_WORDS


def only(text: str) -> ir.Shot:
    """The one shot of one story line."""
    ((shot,),) = (line.shots for line in board(HEAD + text).lines)
    return shot


# -- defaults --------------------------------------------------------------------------------


def test_everything_has_a_default() -> None:
    b = board(HEAD + "(anna wave)\n")
    assert (b.title, b.fps, b.size, b.seed, b.rig, b.style) == (
        "story",
        (24, 1),
        (1280, 720),
        0,
        "cinema",
        "board",
    )
    shot = b.lines[0].shots[0]
    assert (shot.movements, shot.scales, shot.angles) == (
        ir.MOVEMENTS,
        ("close-up", "medium", "full"),
        ir.ANGLES,
    )
    assert (shot.lens, shot.ease, shot.duration, shot.roll) == ((30.0, 80.0), (0.1, 1.0, 10.0), None, 0.0)
    assert (shot.proposals, shot.takes, shot.speed, shot.style) == (80, 5, 1.0, "board")
    assert (shot.say, shot.note) == (None, None)
    assert shot.focus is not None
    assert (shot.focus.kind, shot.focus.path) == ("character", ("anna",))
    assert b.lines[0].transition == ir.Transition("cut", 0.0)


def test_headers_and_what_overrides_them() -> None:
    head = 'storyboard "T"\nfps 23.976\nsize 1920x1080\naspect 2.39\nseed 7\nrig paper\nstyle ink\ntakes 3\nproposals 60\n'
    b = board(head + HEAD + "(anna wave) proposals 10\n(anna wave)\n")
    assert (b.title, b.fps, b.size, b.seed, b.rig, b.style) == (
        "T",
        (24000, 1001),
        (1920, 804),
        7,
        "paper",
        "ink",
    )
    assert [line.shots[0].proposals for line in b.lines] == [10, 60]
    assert b.lines[0].shots[0].takes == 3
    over = board(head + HEAD + "(anna wave)\n", Settings(seed=0, proposals=12, rig="cinema", fps=(25, 1)))
    assert (over.seed, over.rig, over.fps, over.lines[0].shots[0].proposals) == (0, "cinema", (25, 1), 12)


@pytest.mark.parametrize(
    ("written", "fps"),
    [
        ("24", (24, 1)),
        ("29.97", (30000, 1001)),
        ("24000/1001", (24000, 1001)),
        ("60", (60, 1)),
        ("25", (25, 1)),
    ],
)
def test_frame_rates_are_exact(written: str, fps: tuple[int, int]) -> None:
    assert board(f"fps {written}\n{HEAD}(anna wave)\n").fps == fps


def test_frames_count_at_the_scripts_rate() -> None:
    b = board(f"fps 25\n{HEAD}(anna wave) 50f\ndissolve 5f\n(anna wave) 1.5s\n")
    assert [line.shots[0].duration for line in b.lines] == [2.0, 1.5]
    assert b.lines[1].transition == ir.Transition("dissolve", 0.2)


# -- names -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("written", "kind", "path"),
    [
        ("counter", "object", ("kitchen", "counter")),
        ("cup", "object", ("kitchen", "table", "cup")),
        ("table.cup", "object", ("kitchen", "table", "cup")),
        ("window", "object", ("kitchen", "window")),  # the scene's own, not one of the other rooms'
        ("table", "object", ("kitchen", "table")),
        ("sofa", "object", ("living", "sofa")),  # outward
        ("living", "room", ("living",)),
        ("living.lamp", "object", ("living", "lamp")),
        ("apartment.bedroom.lamp", "object", ("bedroom", "lamp")),
        ("middle", "spot", ("kitchen", "middle")),
        ("chair_2.seat", "spot", ("kitchen", "chair_2", "seat")),
        ("kitchen", "room", ("kitchen",)),
        ("ben", "character", ("ben",)),
    ],
)
def test_names_mean_the_nearest(written: str, kind: str, path: tuple[str, ...]) -> None:
    target = board(HEAD + f"(anna walk {written})\n").lines[0].beats[0].target
    assert target is not None
    assert (target.kind, target.path, target.written) == (kind, path, written)


def test_an_ambiguous_name_lists_what_it_could_be() -> None:
    _, report = checked(HEAD + "(anna walk lamp)\n")
    (found,) = report.errors
    assert found.help == "say which: apartment.living.lamp or apartment.bedroom.lamp"
    assert found.suggestion == "living.lamp"


@pytest.mark.parametrize(
    ("words", "action", "target", "second"),
    [
        ("pick up cup", "pick-up", "cup", None),
        ("pick-up the cup", "pick-up", "cup", None),
        ("stand up", "stand-up", None, None),
        ("look at ben", "look", "ben", None),
        ("give cup to ben", "give", "cup", "ben"),
        ("give the cup to ben", "give", "cup", "ben"),
        ("put down cup on the counter", "put-down", "cup", "counter"),
    ],
)
def test_beats_are_read_forgivingly(words: str, action: str, target: str | None, second: str | None) -> None:
    (beat,) = board(HEAD + f"(anna {words})\n").lines[0].beats
    found = (beat.action, beat.target and beat.target.path[-1], beat.second and beat.second.path[-1])
    assert found == (action, target, second)


def test_two_words_may_be_one_name() -> None:
    (line,) = board("character a = woman\nscene s = street\na at bench\n(a run to the bus stop)\n").lines
    assert line.beats[0].target is not None
    assert line.beats[0].target.path == ("pavement", "bus_stop")


def test_scenes_places_and_people() -> None:
    b = board(
        HEAD
        + "(anna wave)\nscene two = street at dusk\nanna at bus_stop facing bench\n(anna wave)\nscene kitchen\n(ben wave)\n"
    )
    assert [(s.set, s.room, s.time) for s in b.scenes] == [
        ("apartment", ("kitchen",), "day"),
        ("street", (), "dusk"),
        ("apartment", ("kitchen",), "day"),
    ]
    anna, ben = b.scenes[0].placements
    assert (anna.posture, ben.posture, ben.at.path) == ("standing", "sitting", ("kitchen", "chair_2"))
    assert b.scenes[1].placements[0].facing is not None
    assert b.scenes[1].placements[0].facing.path == ("pavement", "bench")
    (free,) = b.scenes[2].placements
    assert (free.character, free.at.kind) == ("ben", "free")
    assert [line.scene for line in b.lines] == [0, 1, 2]


def test_characters_are_dressed() -> None:
    b = board("character anna = woman(height 1.7m, hair long)\n" + HEAD.partition("\n")[2] + "(ben wave)\n")
    assert b.characters[0].arguments == (("height", 1.7), ("hair", "long"))


# -- cameras ---------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "written",
    ["push close-up eye-level", "push closeup eye", "dolly-in CU eye level", "push in close up Eye-Level", "eye close_up push",
     "truck in close shot eye"],
)  # fmt: skip
def test_camera_words_are_forgiving(written: str) -> None:
    shot = only(f"(anna wave) / ({written})\n")
    assert (shot.movements, shot.scales, shot.angles) == (("push",), ("close-up",), ("eye-level",))


def test_wildcards_choices_and_what_is_left_out() -> None:
    shot = only("(anna wave) / (tilt up|pan * eye|low)\n")
    assert shot.movements == ("tilt-up", "pan-left", "pan-right")
    assert shot.scales == ("close-up", "medium", "full")
    assert shot.angles == ("eye-level", "low-angle")
    assert only("(anna wave) / (* full)\n").scales == ("full",)
    assert only("(anna wave) / lens 50mm\n").lens == (50.0, 50.0)


def test_every_camera_word_stands_for_words_there_are() -> None:
    known = {"movement": (*ir.MOVEMENTS, *ir.FURTHER_MOVEMENTS), "scale": ir.SIZES, "angle": ir.ALL_ANGLES}
    known |= {"view": ir.VIEWS, "lean": ("dutch",)}
    for word, meaning in CAMERA_WORDS.items():
        assert set(meaning.words) <= set(known[meaning.slot]), word
    for slot, words in known.items():
        assert {w for m in CAMERA_WORDS.values() if m.slot == slot for w in m.words} == set(words)


def test_an_establishing_shot_is_wide_and_follows_nobody() -> None:
    b = board(HEAD + "\n/\t(* * high) 3s\n(anna wave)\n\nscene s = street\n/ (pan)\n")
    first, last = b.lines[0], b.lines[2]
    assert first.beats == ()
    assert first.shots[0].scales == ("wide", "full")
    assert "follow" not in first.shots[0].movements
    assert first.shots[0].duration == 3.0
    assert first.shots[0].focus is not None
    assert last.shots[0].focus is None


def test_options_of_the_line_hold_for_all_its_cameras() -> None:
    (line,) = board(
        HEAD + '(anna wave) say "Hi", 4s / (static) ease slow-in\n/ (arc) 2s, focus ben, roll -12deg\n'
    ).lines
    assert [s.say for s in line.shots] == ["Hi", "Hi"]
    assert [s.duration for s in line.shots] == [4.0, 2.0]
    assert line.shots[0].ease == (10.0,)
    assert line.shots[1].roll == pytest.approx(math.radians(-12))
    assert line.shots[1].focus is not None
    assert line.shots[1].focus.path == ("ben",)


def test_manner_and_feelings_are_read() -> None:
    b = board(HEAD + "(anna walk briskly to counter)\n(anna drunk wave)\n(anna wave)\n")
    assert [line.beats[0].manner for line in b.lines] == ["briskly", "drunk", ""]
    assert b.lines[0].beats[0].target is not None
    b = board(
        HEAD + "(anna wave) feeling sad\n    / (static) feeling angry, feeling ben afraid\n    / (push)\n"
    )
    first, second = b.lines[0].shots
    assert first.feelings == (("anna", "angry"), ("ben", "afraid"))
    assert second.feelings == (("anna", "sad"),)  # of the line, for all its cameras


@pytest.mark.parametrize("posture", ["standing", "kneeling", "crouching", "lying"])
def test_people_are_placed_in_postures(posture: str) -> None:
    head = HEAD.replace("anna at door", f"anna at door {posture}", 1)
    assert head != HEAD
    (scene,) = board(head + "(anna wave)\n").scenes
    assert scene.placements[0].posture == posture


def test_transitions_join_a_line_to_the_one_before() -> None:
    b = board(
        HEAD
        + "fade-in 2s\n(anna wave)\nfade-out 1s\nfade-in 0.5s\n(anna wave)\nwipe\n(anna wave)\nfade-out\n"
    )
    assert [line.transition for line in b.lines] == [
        ir.Transition("fade-in", 2.0),
        ir.Transition("fade-in", 0.5, 1.0),
        ir.Transition("wipe", 0.5),
    ]
    assert b.ending == ir.Transition("fade-out", 1.0)


# -- ids -------------------------------------------------------------------------------------

LINES = ["(anna walk counter) / (follow full eye)", "(anna wave)", "(ben wave) / (static)\n/ (arc)", "\n/ (pan wide high)\n",
         "(anna give cup to ben) + (ben wave)", "(ben stand up)"]  # fmt: skip


def ids(lines: list[str]) -> list[str]:
    return [shot.id for line in board(HEAD + "\n".join(lines) + "\n").lines for shot in line.shots]


def test_ids_say_what_the_shot_shows() -> None:
    assert ids(LINES) == [
        "kitchen-anna-walk-counter",
        "kitchen-anna-wave",
        "kitchen-ben-wave-static",
        "kitchen-ben-wave-arc",
        "kitchen-establishing",
        "kitchen-anna-give-cup-ben-ben-wave",
        "kitchen-ben-stand-up",
    ]
    assert ids(["(anna wave)", "(anna wave)"]) == ["kitchen-anna-wave", "kitchen-anna-wave--2"]


@pytest.mark.parametrize("gone", range(len(LINES)))
def test_ids_stay_when_other_lines_go(gone: int) -> None:
    kept = LINES[:gone] + LINES[gone + 1 :]
    lost = ids([LINES[gone], "(anna wave)"])[:-1]
    assert ids(kept) == [each for each in ids(LINES) if each not in lost]


@pytest.mark.parametrize("at", range(len(LINES) + 1))
def test_ids_stay_when_a_line_comes(at: int) -> None:
    new = "(ben look window)"
    more = ids([*LINES[:at], new, *LINES[at:]])
    assert [each for each in more if each != "kitchen-ben-look-window"] == ids(LINES)


@seed(3)
@settings(max_examples=150, deadline=None)
@given(st.lists(st.text(max_size=60), min_size=1, max_size=4))
def test_slugs_name_folders(words: list[str]) -> None:
    name = slug(words)
    assert name
    assert name == slug(words)
    assert len(name.encode()) <= 72
    assert not set(name) & set('/\\:*?"<>|\x00 .')
    assert "--" not in name
    assert name == name.casefold() or not name.isascii()


# -- the rest --------------------------------------------------------------------------------


def test_a_file_of_definitions_only_is_fine() -> None:
    b = board("prop a { box (1, 1, 1)m }\n")
    assert b.lines == ()


def test_used_files_bring_their_characters_and_stay_inside(tmp_path: Path) -> None:
    (tmp_path / "project").mkdir()
    (tmp_path / "outside.vds").write_text("character zed = man\n")
    (tmp_path / "project" / "common.vds").write_text(
        'use "story.vds"\ncharacter anna = woman\ncharacter bad = womn\n'
    )
    (tmp_path / "project" / "link.vds").symlink_to(tmp_path / "outside.vds")
    story = tmp_path / "project" / "story.vds"
    story.write_text(
        'use "common.vds"\nuse "link.vds"\nscene k = apartment.kitchen\nanna at door\n(anna wave)\n'
    )
    script, report = parse(Source(str(story), story.read_text()))
    check(script, SmallCatalog(), report)
    assert [(d.code, Path(d.span.source.name).name) for d in report.errors] == [
        ("VDS064", "common.vds"),
        ("VDS015", "story.vds"),
    ]


@seed(11)
@settings(max_examples=150, deadline=None)
@given(st.lists(st.sampled_from([*HEAD.split(), "(", ")", "/", "walk", "give", "cup", "to", "\n", "\n", "*", "|", "lens", "50mm", ",", "4s",
                                                "follow", "full", "+", "+", "dissolve", "facing", "fps", "24", '"x"', "say"]), max_size=40))  # fmt: skip
def test_checking_never_raises(words: list[str]) -> None:
    storyboard, report = checked(HEAD + " ".join(words))
    assert (storyboard is None) == report.has_errors


# -- the table of codes ------------------------------------------------------------------------

OWN = sorted(code for code in CODES if code < "VDS100")
FIRST = ("storyboard", "fps", "size", "aspect", "seed", "rig", "style", "takes", "proposals")


def _as_story(example: str) -> str:
    """An example among what it takes for granted."""
    lines = example.split("\n")
    head = [line for line in lines if line.split(" ")[0] in FIRST]
    rest = [line for line in lines if line not in head]
    return "\n".join([*head, "character carl = man", HEAD, *rest, "(anna wave)", ""])


@pytest.mark.parametrize("code", [c for c in OWN if CODES[c].wrong])
def test_the_wrong_example_gets_its_code(code: str) -> None:
    from vdsl.library import Catalog

    text = _as_story(CODES[code].wrong)
    script, report = parse(Source("x.vds", text))
    check(script, SmallCatalog(), report)
    if code not in [d.code for d in report.diagnostics]:  # found by whoever reads definitions
        Catalog.for_script(script, report)
    assert code in [d.code for d in report.diagnostics]


@pytest.mark.parametrize("code", [c for c in OWN if CODES[c].right])
def test_the_right_example_is_right(code: str) -> None:
    from vdsl.library import Catalog

    text = _as_story(CODES[code].right)
    script, report = parse(Source("x.vds", text))
    Catalog.for_script(script, report)
    check(script, SmallCatalog(), report)
    assert code not in [d.code for d in report.diagnostics]
    assert not report.errors, [(d.code, d.label, d.span.text) for d in report.errors]


def test_codes_are_well_formed() -> None:
    for code, row in CODES.items():
        assert len(code) == 6
        assert row.title[0].islower() or row.title.startswith(("MCS", "`"))
        assert row.why.endswith((".", ")")) or "\n" in row.why
    assert codes(HEAD + "(anna wave)\n") == []
    assert isinstance(Report().diagnostics, tuple)


def test_codes_name_all_that_is_known() -> None:
    from vdsl.lang import options
    from vdsl.lang.definitions.looks import FEATURES
    from vdsl.lang.ir import FURTHER_MOVEMENTS, MOVEMENTS

    for name in FEATURES:
        assert f" {name}" in CODES["VDS160"].why, name
    for movement in (*MOVEMENTS, *FURTHER_MOVEMENTS):
        family = movement.removesuffix("-in").rsplit("-left")[0].rsplit("-right")[0]
        family = family.removesuffix("-out").removesuffix("-up").removesuffix("-down")
        assert family in CODES["VDS040"].why, movement
    for option in {*options._READERS, "focus", "feeling"} - {"duration"}:
        assert option in CODES["VDS050"].why, option
