"""Comparing two storyboards: every shot accounted for, and what changed in words."""

from __future__ import annotations

from dataclasses import fields

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from vdsl.emit.words import beat_words
from vdsl.lang import Source
from vdsl.lang.ir import Shot, Storyboard
from vdsl.pipeline.compare import compare
from vdsl.pipeline.script import check_source

HEAD = """storyboard "Two"
character anna = woman(height 1.68m)
character ben = man
scene kitchen = apartment.kitchen at day
anna at door facing window
ben at chair_2 sitting
"""
LINES = (
    "(anna walk counter) / (follow full eye-level)",
    '(ben greet anna) / (static close-up eye-level) say "You are up early."',
    "(anna pick up cup) / (tilt up medium eye-level)",
    "(anna walk ben) / (arc full eye-level)",
    "(ben wave) / (static medium eye-level)",
)


def board(*lines: str, head: str = HEAD) -> Storyboard:
    return check_source(Source("story.vds", head + "\n".join(lines) + "\n")).storyboard


def told(before: Storyboard, after: Storyboard) -> list[str]:
    found = compare(before, after)
    return [c.text for c in found.board] + [s.text for s in found.changed]


def test_the_same_storyboard_is_the_same() -> None:
    found = compare(board(*LINES), board(*LINES))
    assert found.equal
    assert [s.status for s in found.shots] == ["same"] * 5


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("close-up", "medium", "close-up → medium"),
        ("eye-level)", "high-angle)", "eye-level → high-angle"),
        ("static", "push", "static → push"),
        ("eye-level)", "eye-level) lens 35mm", "lens any → 35 mm"),
        ("eye-level)", "eye-level) 3s", "length none → 3 s"),
        ("eye-level)", "eye-level) roll 4deg", "roll none → 4°"),
        ("You are up early.", "Morning.", "“You are up early.” → “Morning.”"),
        ("greet anna", "wave", "ben greet anna → ben wave"),
        ("eye-level)", "eye-level) focus anna", "focus ben → anna"),
    ],
)
def test_what_changed_is_said_in_words(old: str, new: str, said: str) -> None:
    other = (
        LINES[1].replace(") say", f"){new.partition(')')[2]}, say") if new.startswith("eye-level) ") else None
    )
    other = other or LINES[1].replace(old, new)
    (line,) = told(board(*LINES), board(LINES[0], other, *LINES[2:]))
    assert line.startswith("shot 2: ")
    assert said in line


def test_several_changes_of_a_shot_stand_in_one_line() -> None:
    other = "(anna walk window) / (follow medium eye-level) lens 50mm"
    assert told(board(*LINES), board(other, *LINES[1:])) == [
        "shot 1: anna walk counter → window; full → medium; lens any → 50 mm"
    ]


def test_shots_come_and_go() -> None:
    found = compare(
        board(*LINES), board(*LINES[:2], *LINES[3:], "(anna sit chair_1) / (static wide high-angle)")
    )
    assert [s.status for s in found.shots] == ["same", "same", "removed", "same", "same", "added"]
    assert found.changed[0].text == "shot 3 removed: anna pick up cup, tilt-up medium eye-level"
    assert found.changed[1].text.startswith("shot 5 added: anna sit")


def test_a_line_put_elsewhere_has_moved_and_nothing_else_has() -> None:
    found = compare(board(*LINES), board(LINES[4], *LINES[:4]))
    assert [s.status for s in found.shots] == ["moved", "same", "same", "same", "same"]
    assert found.changed[0].text == "shot 1: moved from 5 to 1"


def test_moved_and_changed_says_both() -> None:
    (line,) = told(board(*LINES), board(LINES[4].replace("medium", "full"), *LINES[:4]))
    assert line == "shot 1: moved from 5 to 1; medium → full"


def test_one_of_two_equal_lines_removed_is_one_removed() -> None:
    """The second of two equal lines has an id with a number: taking the first away renames it."""
    twice = (LINES[4], LINES[0], LINES[4])
    found = compare(board(*twice), board(*twice[1:]))
    assert sorted(s.status for s in found.shots) == ["removed", "same", "same"]


def test_what_somebody_holds_is_told_and_what_goes_without_saying_is_not() -> None:
    head = HEAD.replace("facing window", "facing window holding bag")
    found = told(board(*LINES), board(*LINES, head=head))
    assert found[0].endswith("anna at door facing window holding bag; ben at chair_2 sitting")
    (beat,), (said,) = (board(line).lines[0].beats for line in ("(ben enters)", "(ben enters the middle)"))
    assert beat.target is not None
    assert (beat_words(beat), beat_words(said)) == ("ben enters", "ben enters the middle")


def test_cast_scene_and_settings_are_told() -> None:
    head = HEAD.replace("1.68m", "1.75m").replace("at day", "at dusk").replace('"Two"', '"Three"\nseed 4')
    assert told(board(*LINES), board(*LINES, head=head)) == [
        "title Two → Three",
        "seed 0 → 4",
        "character anna woman (height 1.68) → woman (height 1.75)",
        "scene kitchen apartment.kitchen at day; anna at door facing window; ben at chair_2 sitting → "
        "apartment.kitchen at dusk; anna at door facing window; ben at chair_2 sitting",
    ]


@settings(max_examples=25, deadline=None)
@given(
    st.lists(st.integers(0, 4), min_size=1, max_size=6), st.lists(st.integers(0, 4), min_size=1, max_size=6)
)
def test_every_shot_is_accounted_for_once(one: list[int], two: list[int]) -> None:
    before, after = board(*(LINES[i] for i in one)), board(*(LINES[i] for i in two))
    found = compare(before, after)
    assert sorted(s.before.number for s in found.shots if s.before) == list(range(1, len(one) + 1))
    assert [s.after.number for s in found.shots if s.after] == list(range(1, len(two) + 1))
    same = sum(s.before is not None and s.after is not None and not s.changes for s in found.shots)
    assert same == sum(
        min(one.count(i), two.count(i)) for i in range(5)
    )  # never told as changed what is there
    assert found.equal == (one == two)


def test_everything_a_shot_says_is_compared() -> None:
    """A new option of shots must be told of in `vdsl/pipeline/facts.py`, or listed here as not compared."""
    told = {
        "movements", "scales", "angles", "lens", "any_lens", "ease", "duration", "roll", "focus", "say",
        "note", "proposals", "takes", "speed", "style", "feelings", "view", "whose", "focus_to", "aperture",
    }  # fmt: skip
    place = {"id", "line", "span", "drawn"}
    assert {f.name for f in fields(Shot)} == told | place
