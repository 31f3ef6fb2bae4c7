"""Things people hold when a scene opens, and what actions are done with where nothing is named."""

from __future__ import annotations

import pytest

from vdsl.lang import Report, Source, check, parse
from vdsl.lang.ir import Carried, Storyboard
from vdsl.library import Catalog

HEAD = "character anna = woman\ncharacter ben = man\nscene kitchen = apartment.kitchen at day\n"


def read(lines: str) -> tuple[Storyboard | None, Report]:
    script, report = parse(Source("x.vds", HEAD + lines))
    board = check(script, Catalog.for_script(script, report), report)
    return board, report


def fine(lines: str) -> Storyboard:
    board, report = read(lines)
    assert board is not None, [d.label for d in report.errors]
    return board


def test_a_thing_of_the_scene_is_held_before_a_prop_of_that_name() -> None:
    board = fine("anna at door holding cup\nben at counter holding cup\n(anna wave)\n")
    anna, ben = board.scenes[0].placements
    assert anna.holding is not None
    assert anna.holding.path[-1] == "cup"
    assert anna.holding.path[0] == "kitchen"
    assert ben.holding is not None
    assert ben.holding.path == ("ben", "cup")
    assert board.scenes[0].carried == (Carried("ben", "cup", "cup", held=True),)


def test_of_two_in_the_scene_neither_is_meant_by_who_holds_one() -> None:
    board = fine("anna at door holding book\nben at counter holding coffee\n(anna wave)\n")
    assert board.scenes[0].carried == (
        Carried("anna", "book", "book", held=True),
        Carried("ben", "coffee", "cup", held=True),
    )


def test_what_is_held_may_be_said_in_numbers() -> None:
    board = fine('anna at door facing window holding bag(color "#223344", width 30cm)\n(anna wave)\n')
    (bag,) = board.scenes[0].carried
    assert dict(bag.arguments) == {"color": "#223344", "width": 0.3}
    assert board.scenes[0].placements[0].facing is not None


@pytest.mark.parametrize(
    ("line", "code", "place"),
    [
        ("anna at door holding fridge", "VDS081", "fridge"),
        ("anna at door holding car", "VDS081", "car"),
        ("anna at door holding umbrela", "VDS060", "umbrela"),
        ("anna at door holding bag(wide 3cm)", "VDS022", "wide"),
        ("anna at door holding bag holding cup", "VDS009", "holding cup"),
        ("anna at door holding", "VDS001", "holding"),
    ],
)
def test_what_cannot_be_held_is_told_at_its_place(line: str, code: str, place: str) -> None:
    _, report = read(line + "\n(anna wave)\n")
    assert [(d.code, d.span.text) for d in report.errors] == [(code, place)]


def test_actions_bring_what_they_are_done_with_once() -> None:
    board = fine("anna at door\nben at counter\n(anna phone)\n(anna wave)\n(anna text)\n(ben phone)\n")
    assert [thing.path for thing in board.scenes[0].carried] == [("anna", "phone"), ("ben", "phone")]
    assert not any(thing.held for thing in board.scenes[0].carried)
    brought = [beat.brought.path if beat.brought else None for line in board.lines for beat in line.beats]
    assert brought == [("anna", "phone"), None, ("anna", "phone"), ("ben", "phone")]


def test_what_is_in_a_hand_or_named_is_not_brought() -> None:
    board = fine(
        "anna at door holding bag\nben at counter\n"
        "(ben pick up cup)\n(ben drink)\n(ben phone)\n(anna take-bite)\n(anna drink cup)\n"
    )
    brought = [beat.brought.path if beat.brought else None for line in board.lines for beat in line.beats]
    # a cup in the hand is drunk from, but is no telephone; nobody bites into a bag because it is in the hand
    assert brought == [None, None, ("ben", "phone"), None, None]


def test_a_thing_of_the_kind_in_a_hand_is_what_it_is_done_with() -> None:
    board = fine("anna at door holding guitar\n(anna play guitar)\n")
    assert board.lines[0].beats[0].brought is not None
    assert board.lines[0].beats[0].brought.path == ("anna", "guitar")
    assert len(board.scenes[0].carried) == 1


def test_what_was_brought_has_a_name() -> None:
    board = fine(
        "anna at door\nben at counter\n"
        "(anna play guitar)\n(anna give guitar to ben)\n(ben take anna.guitar)\n"
    )
    given, taken = board.lines[1].beats[0], board.lines[2].beats[0]
    assert given.target is not None
    assert given.target.path == ("anna", "guitar")
    assert taken.target is not None
    assert taken.target.path == ("anna", "guitar")


def test_one_s_own_comes_before_that_of_the_scene() -> None:
    board = fine(
        "anna at door holding cup\nben at counter holding cup\n(ben put down cup)\n(anna put down cup)\n"
    )
    paths = [line.beats[0].target.path for line in board.lines if line.beats[0].target]
    assert paths[0] == ("ben", "cup")
    assert paths[1][0] == "kitchen"


def test_the_only_target_may_be_the_second_one() -> None:
    beat = fine("anna at door\nben at counter\n(anna toast to ben)\n").lines[0].beats[0]
    assert beat.target is None
    assert beat.second is not None
    assert beat.second.path == ("ben",)
    assert beat.brought is not None
    assert beat.brought.path == ("anna", "wine_glass")


def test_an_action_of_one_s_own_may_bring_a_prop_of_one_s_own() -> None:
    own = (
        "prop kazoo { cylinder 2cm, height 12cm; grip (0, 0, 6cm) }\n"
        "action play-kazoo { target optional object; needs target; brings kazoo; duration 2s\n"
        "reach right mouth, from 10%, at 30%, until 80%, back 100% }\n"
    )
    board = fine(own + "anna at door\n(anna play kazoo)\n")
    assert board.scenes[0].carried == (Carried("anna", "kazoo", "kazoo"),)


@pytest.mark.parametrize(("brings", "code"), [("kazu", "VDS115"), ("table", "VDS145")])
def test_an_action_brings_only_props_there_are(brings: str, code: str) -> None:
    own = f"action play {{ target optional object; needs target; brings {brings}; duration 2s }}\n"
    _, report = read(own + "anna at door\n(anna play)\n")
    assert code in [d.code for d in report.errors]


def test_an_action_that_needs_nothing_brings_nothing() -> None:
    _, report = read("action hum { duration 2s; brings cup }\nanna at door\n(anna hum)\n")
    assert [d.code for d in report.errors] == ["VDS145"]


@pytest.mark.parametrize("entry", ["someone", "alone"])
def test_an_action_is_another_one_only_of_those_there_are(entry: str) -> None:
    own = f"action nudge {{ target optional object character; {entry} wiat; duration 2s }}\n"
    _, report = read(own + "anna at door\n(anna nudge)\n")
    assert [d.code for d in report.errors][:1] == ["VDS071"]
    assert report.errors[0].fix == "wait"
