"""Sentences that cannot be acted as they are written: as much of them as can is shown, and it is told."""

from __future__ import annotations

import pytest
from test_as_people_say_it import read, told

from vdsl.emit.words import line_words

SITS = [("sit", ""), ("laugh", ""), ("drink", "")]


def shown(line: str, place: str = "apartment.kitchen") -> tuple[list[tuple[str, str, str]], list[str]]:
    """Who does what to what of each line, and the warnings that something else is shown."""
    board, report = read(line, place)
    assert board is not None, [d.label for d in report.errors]
    beats = [beat for each in board.lines for beat in each.beats]
    labels = [d.label for d in report.diagnostics if d.code == "VDS085"]
    return [(beat.character, *told(beat)[:2]) for beat in beats], labels


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("(anna marinates the fridge)", ("anna", "look", "fridge")),  # no such action
        ("(anna yodels)", ("anna", "wait", "")),
        ("(anna flambles ben)", ("anna", "look", "ben")),
        ("(ben wrestles with the fridge)", ("ben", "look", "fridge")),  # done to somebody
        ("(ben nods thanks)", ("ben", "nod", "")),  # nothing is called so
        ("(anna's jaw drops)", ("anna", "wait", "")),
        ("(anna doesn't move)", ("anna", "wait", "")),
        ("(anna bites her lip)", ("anna", "bite-nails", "")),
        ("(they sit down on the chair and eat up)", ("anna", "sit", "chair")),
    ],
)
def test_as_much_is_shown_as_can_be(line: str, expected: tuple[str, str, str]) -> None:
    assert shown(line)[0][0] == expected


def test_it_is_told_what_is_shown_and_why() -> None:
    board, report = read("(anna marinates the fridge)", "apartment.kitchen")
    (warning,) = [d for d in report.diagnostics if d.code == "VDS085"]
    assert warning.label == "this is shown as `anna look at fridge`"
    assert "no action is called `marinates`" in warning.help
    assert warning.span.text == "(anna marinates the fridge)"
    assert line_words(board.lines[0], "s") == "anna marinates the fridge"


@pytest.mark.parametrize(
    ("line", "told"),
    [
        ("(anna sits down and yodels)", "no action is called `yodels`; `vdsc assets actions"),
        ("(anna waves and milk)", "nothing is called `milk` here; `vdsc assets props"),
        ("(anna waves and the blorb)", "nothing is called `blorb` here; `vdsc assets props"),
    ],
)
def test_a_verb_after_and_is_no_thing(line: str, told: str) -> None:
    _, report = read(line, "apartment.kitchen")
    (warning,) = [d for d in report.diagnostics if d.code == "VDS085"]
    assert told in warning.help


@pytest.mark.parametrize(
    ("line", "code"),
    [
        ("(anna wlaks to the door)", "VDS071"),  # letters changed places
        ("(anna opens the frigde)", "VDS060"),
        ("(anna yodel)", "VDS071"),  # the short form has to be right
        ("(anna walk chiar)", "VDS060"),
        ("(anna hugs)", "VDS072"),
        ("(crala walks to the door)", "VDS065"),
        ("(the waiter walks in)", "VDS065"),
        ("(anna wslks to the door)", "VDS071"),
        ("(the kettel whistles)", "VDS060"),
        ("(anna hugs carl)", "VDS060"),
        ("(anna waves at Bob)", "VDS060"),
        ("(the police arrive)", "VDS065"),
        ("(John's phone rings)", "VDS065"),
    ],
)
def test_slips_and_short_lines_stay_errors(line: str, code: str) -> None:
    board, report = read(line, "apartment.kitchen")
    if line == "(anna hugs)":  # with the only other one
        assert board is not None
        return
    assert code in [d.code for d in report.errors], [d.label for d in report.diagnostics]


@pytest.mark.parametrize(
    ("line", "expected", "about"),
    [
        ("(the phone rings)", "phone", "phone"),
        ("(The kettle starts to whistle)", "kettle", "kettle"),
        ("(the phone on the table rings)", "phone", "phone"),
        ("(a dog barks)", "", None),
        ("(the phone doesn't ring)", "phone", "phone"),
        ("(a loud bang from outside)", "", None),
        ("(a dog runs in)", "", None),
        ("(the cups fall)", "cup", "cup"),
        ("(The cup fell)", "cup", "cup"),
        ("(anna's phone rings)", "phone", "phone"),
        ("(it’s raining)", "", None),
        ("(there's a knock at the door)", "", None),
        ("(nobody moves)", "", None),
        ("(the floor creaks)", "", None),
    ],
)
def test_what_things_do_is_a_shot_of_them(line: str, expected: str, about: str | None) -> None:
    board, report = read(line, "apartment")
    assert board is not None, [d.label for d in report.errors]
    (found,) = board.lines
    assert line_words(found, "s") == line[1:-1]
    focus = found.shots[0].focus
    assert (focus.path[-1] if focus is not None and focus.kind == "object" else None) == about


def test_a_camera_may_still_be_on_somebody() -> None:
    board, _ = read("(the phone rings) / (push close-up) focus ben", "apartment")
    assert board is not None
    assert board.lines[0].shots[0].focus.path == ("ben",)


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("(the door opens and ben walks in)", [["anna look door"], ["ben enter middle"]]),
        ("(The phone rings. Ben answers it.)", [["anna look phone"], ["ben answer phone"]]),
        ("(When the phone rings, Ben answers it)", [["anna look phone"], ["ben answer phone"]]),
        ("(Anna drops the cup. It shatters.)", [["anna drop cup"], ["anna look cup"]]),
        ("(ben knocks. the door opens)", [["ben knock door"], ["ben look door"]]),
        ("(ben waves) + (the phone rings)", [["ben wave ", "anna look phone"]]),
        ("(the phone rings) + (the kettle whistles)", [["anna look phone", "ben look kettle"]]),
        ("(Suddenly, the phone rings.)", [["anna look phone"]]),
        ("(anna opens the door and the windows)", [["anna open door"]]),  # of which nothing is done
        ("(ben's phone rings and he answers it)", [["ben look phone"], ["ben answer phone"]]),
    ],
)
def test_what_things_do_among_what_people_do(line: str, expected: list[list[str]]) -> None:
    board, report = read(line)
    assert board is not None, [d.label for d in report.errors]
    found = [[" ".join((b.character, *told(b)[:2])) for b in each.beats] for each in board.lines]
    assert found == expected


@pytest.mark.parametrize("line", ["(anna doesn’t move)", "(anna is not sitting)", "(ben never laughs)"])
def test_what_is_not_done_is_not_shown(line: str) -> None:
    done, labels = shown(line)
    assert [action for _, action, _ in done] == ["wait"]
    assert labels == [f"this is shown as `{done[0][0]} wait`"]


def test_verbs_that_nobody_can_act_are_no_slips_of_others() -> None:
    for verb in ("flies", "hates it", "loses her balance", "wins", "sinks", "weaves a basket", "chews gum"):
        board, report = read(f"(anna {verb})")
        assert board is not None, [d.label for d in report.errors]


@pytest.mark.parametrize("line", ["(anna walked to the door)", "(anna opened the door)", "(ben sat down)"])
def test_the_past_is_as_good(line: str) -> None:
    board, report = read(line)
    assert board is not None, [d.label for d in report.errors]
    assert not [d for d in report.diagnostics if d.code == "VDS085"]


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("(Anna is kissed by Ben.)", [("ben", "kiss", "anna")]),  # who does it is said last
        ("(Ben is hugged.)", [("ben", "wait", "")]),
        ("(Ben saw the fridge.)", [("ben", "look", "fridge")]),  # and did not saw it
        ("(Ben left.)", [("ben", "leave", "door")]),
        ("(Anna was crying.)", [("anna", "cry", "")]),
        ("(Anna lay down)", [("anna", "lie-down", "")]),
        ("(A nervous Anna walks in.)", [("anna", "enter", "middle")]),
        ("(She's crying.)", [("anna", "cry", "")]),
        ("(Anna's sitting on the chair.)", [("anna", "sit", "chair")]),
        ("(anna leaves crying)", [("anna", "leave", "door")]),
        ("(Anna speaks French.)", [("anna", "talk", "")]),
        ("(Anna doesn't look at Ben and leaves.)", [("anna", "look", "ben"), ("anna", "leave", "door")]),
        ("(Anna sits down, laughs and drinks.)", [("anna", a, t) for a, t in SITS]),
        ("(Anna counts to 10.)", [("anna", "count", "")]),
        ("(Ben jumps as the kettle whistles.)", [("ben", "jump", ""), ("ben", "look", "kettle")]),
    ],
)
def test_what_people_write(line: str, expected: list[tuple[str, str, str]]) -> None:
    assert shown(line)[0] == expected


def test_nobody_is_brought_in_by_what_somebody_else_does() -> None:
    for line in ("(Ben stands up and the waiter leaves.)", "(Ben sits down, and the doctor comes in.)"):
        _, report = read(line)
        assert "VDS065" in [d.code for d in report.errors], line


@pytest.mark.parametrize(
    ("line", "help"),
    [
        ("(anna at fridge)", "`anna at fridge` without parentheses says where somebody is from the start"),
        (
            "(clara walks to the fridge)",
            "characters are anna and ben; a line `character clara = woman`, or `man`, makes one more",
        ),
        ("(anan walks to the fridge)", "characters are anna and ben"),
        ("(sideways walks to the fridge)", "characters are anna and ben"),
    ],
)
def test_what_is_wrong_says_how_it_is_said(line: str, help: str) -> None:
    _, report = read(line, "apartment.kitchen")
    assert help in [d.help for d in report.errors]
