"""Names and words in whatever capitals, and marks between the words of a sentence."""

from __future__ import annotations

import pytest
from test_as_people_say_it import told

from vdsl.emit.words import line_words
from vdsl.lang import Report, Source, check, parse
from vdsl.lang.ir import Storyboard
from vdsl.library import Catalog

HEAD = "{characters}\nscene s = apartment.kitchen at day\n"


def read(lines: str, *characters: str) -> tuple[Storyboard | None, Report]:
    people = "\n".join(f"character {name} = woman" for name in characters or ("anna", "ben"))
    script, report = parse(Source("x.vds", HEAD.format(characters=people) + lines + "\n"))
    return check(script, Catalog.for_script(script, report), report), report


def story(lines: str, *characters: str) -> Storyboard:
    board, report = read(lines, *characters)
    assert board is not None, [(d.code, d.label) for d in report.errors]
    return board


@pytest.mark.parametrize("line", ["(Anna walks to the door)", "(ANNA walk DOOR)", "(anna Walks to The Door)"])
def test_capitals_are_of_no_account(line: str) -> None:
    (beat,) = story(f"anna at chair\n{line}").lines[0].beats
    assert (beat.character, *told(beat)[:2]) == ("anna", "walk", "door")


def test_the_boards_have_the_words_as_written() -> None:
    board = story("anna at chair\n(Anna walks to the Door.)\n(She sits down)")
    assert [line_words(line, "s") for line in board.lines] == ["Anna walks to the Door.", "anna sits down"]


def test_somebody_is_named_so_wherever_a_name_may_stand() -> None:
    board = story("Anna at chair facing BEN\nBen at Door\n(Ben takes Anna's hand) / (static) focus ANNA")
    assert {p.character for p in board.scenes[0].placements} == {"anna", "ben"}
    assert board.lines[0].shots[0].focus.path == ("anna",)


def test_of_two_who_differ_by_capitals_each_is_who_they_are() -> None:
    board = story("anna at chair\nAnna at door\n(Anna waves)\n(anna nods)", "anna", "Anna")
    assert [line.beats[0].character for line in board.lines] == ["Anna", "anna"]
    _, report = read("anna at chair\nAnna at door\n(ANNA waves)", "anna", "Anna")
    assert [d.code for d in report.errors] == ["VDS065"]


def test_a_thing_keeps_its_small_letters() -> None:
    board = story("Rose at chair\nanna at door\n(anna smells the rose)\n(anna hugs Rose)", "Rose", "anna")
    one, two = (line.beats[0] for line in board.lines)
    assert one.target.kind == "object"
    assert two.target.path == ("Rose",)


def test_what_is_somebodys_is_so_in_capitals_too() -> None:
    people = ("Rose", "Mark")
    board = story("Rose at chair\nMark at door\n(Rose takes Mark's hand)\n(MARK'S HANDS TREMBLE)", *people)
    assert [(each.beats[0].character, each.beats[0].action) for each in board.lines] == [
        ("Rose", "hold-hands"),
        ("Mark", "tremble"),
    ]


@pytest.mark.parametrize(
    "line",
    ["(Ben nods while Anan waves)", "(Anna gives Bne the cup)", "(Anna nods and Bne waves)"],
)
def test_slips_of_names_in_capitals_are_told(line: str) -> None:
    _, report = read(f"Anna at chair\nBen at door\n{line}", "Anna", "Ben")
    assert report.errors


def test_a_small_word_that_says_how_is_nobody() -> None:
    board = story("Joy at chair\nanna at door\n(anna dances with joy)\n(anna dances with Joy)", "Joy", "anna")
    assert [line.beats[0].action for line in board.lines] == ["dance", "dance-with"]


def test_whose_view_it_is_may_have_any_capitals() -> None:
    board = story("anna at chair\nben at door\n(anna waves at ben) / (ots Ben)")
    assert board.lines[0].shots[0].whose == ("ben",)


def test_an_unknown_name_is_still_told_with_how_to_add_it() -> None:
    _, report = read("anna at chair\n(The waiter walks in)")
    (error,) = report.errors
    assert (error.code, error.span.text) == ("VDS065", "waiter")
    assert "character waiter = woman`, or `man`" in error.help


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("(anna stops. She turns around… and smiles!)", ["wait", "turn", "smile"]),
        ("(anna sits down; she sighs)", ["sit", "sigh"]),
        ("(anna walks in — slowly)", ["enter"]),
        ("(anna takes the cup - and drinks)", ["pick-up", "drink"]),
        ("(anna picks up 3 cups)", ["pick-up"]),
        ("(Anna waits for 3 seconds)", ["wait"]),
        ("(Anna – slowly – opens the fridge)", ["open"]),
        ("(She stops. Turns. Silence.)", ["wait", "turn"]),
        ("(Footsteps; anna ducks)", ["duck"]),
    ],
)
def test_marks_between_words(line: str, expected: list[str]) -> None:
    assert [each.beats[0].action for each in story(f"anna at chair\n{line}").lines] == expected


@pytest.mark.parametrize(
    ("line", "action", "say"),
    [
        ('(anna says "Hello there." to ben)', "talk", "Hello there."),
        ('(anna "Hi!")', "talk", "Hi!"),
        ('(anna: "Hi!")', "talk", "Hi!"),
        ('(anna waves "Hi!") + (ben waves "Oh.")', "wave", "Hi! Oh."),
        ('(anna and ben "Hi!")', "talk", "Hi!"),
        ('(anna to ben: "Hi!")', "talk", "Hi!"),
        ('(anna waves "Hi!") say "Bye."', "wave", "Hi! Bye."),
        ('(anna waves "Hi!") / (static) say "Bye."', "wave", "Bye."),
    ],
)
def test_what_is_said_may_stand_in_the_line(line: str, action: str, say: str) -> None:
    (found,) = story(f"anna at chair\nben at door\n{line}").lines
    assert (found.beats[0].action, found.shots[0].say) == (action, say)


def test_each_says_what_stands_with_what_they_do() -> None:
    board = story('anna at chair\nben at door\n(Anna waves and says "Hi", Ben says "Ho.")')
    told_as = [(line_words(line, "s"), line.shots[0].say) for line in board.lines]
    assert told_as == [("Anna waves", None), ('Anna says "Hi"', "Hi"), ('Ben says "Ho."', "Ho.")]


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ('(Anna says "Hi" and waves.)', [("talk", "Hi"), ("wave", None)]),
        ('(Anna says "Hi", hugs Ben and says "Bye".)', [("talk", "Hi"), ("hug", None), ("talk", "Bye")]),
        ('(Anna: "Go!" Ben: "No.")', [("talk", "Go!"), ("talk", "No.")]),
        ('(Anna says "Go!" Ben leaves.)', [("talk", "Go!"), ("leave", None)]),
        ('(Ben angrily: "No!")', [("talk", "No!")]),
    ],
)
def test_who_says_what(line: str, expected: list[tuple[str, str | None]]) -> None:
    board = story(f"anna at chair\nben at door\n{line}")
    assert [(each.beats[0].action, each.shots[0].say) for each in board.lines] == expected


def test_in_a_sentence_of_its_own_she_is_who_acted_last() -> None:
    people = ("Rose", "Grace")
    board = story("Rose at chair\nGrace at door\n(Rose walks to Grace. She nods.)", *people)
    assert [each.beats[0].character for each in board.lines] == ["Rose", "Rose"]


def test_a_name_like_a_small_word_keeps_no_sentence_from_being_shown() -> None:
    board = story("Andy at chair\n(Andy opens the fridge and yodels at the kettle.)", "Andy")
    assert [each.beats[0].action for each in board.lines] == ["open", "look"]


def test_captions_have_all_words() -> None:
    board = story("anna at chair\nben at door\n(Slowly, Ben turns around.)\n(Anna is hugged by Ben.)")
    words = [line_words(line, "s") for line in board.lines]
    assert words == ["Slowly, Ben turns around.", "Anna is hugged by Ben."]
    board = story('anna at chair\nben at door\n(Ben says "What?" and Anna laughs)')
    assert [line_words(line, "s") for line in board.lines] == ['Ben says "What?" + Anna laughs']
