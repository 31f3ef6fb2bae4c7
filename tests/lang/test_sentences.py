"""Lines of several clauses, commas and possessives: what is done, by whom and when, and what is left out."""

from __future__ import annotations

import random

import pytest
from test_as_people_say_it import read, told

from vdsl.emit.words import line_words


def done(line: str, place: str = "apartment") -> list[list[tuple[str, str, str]]]:
    """Of every line that a line is read as: who does what, to what."""
    board, report = read(line, place)
    assert board is not None, [d.label for d in report.errors]
    return [[(b.character, *told(b)[:2]) for b in each.beats] for each in board.lines]


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("(ben reads while anna cooks)", [("ben", "read", ""), ("anna", "cook", "stove")]),
        ("(ben cooks as she walks in)", [("ben", "cook", "stove"), ("anna", "enter", "middle")]),
        ("(ben sits down and anna stands up)", [("ben", "sit", ""), ("anna", "stand-up", "")]),
        ("(anna waves, ben nods)", [("anna", "wave", ""), ("ben", "nod", "")]),
        ("(anna sits down, and ben, annoyed, yawns)", [("anna", "sit", ""), ("ben", "yawn", "")]),
        ("(anna, ben wave)", [("anna", "wave", ""), ("ben", "wave", "")]),
        ("(anna and ben dance while they laugh)", [("anna", "dance", ""), ("ben", "dance", "")]),
        ("(ben cooks dinner while he talks)", [("ben", "cook", "stove")]),  # nobody does two things at once
    ],
)
def test_what_others_do_meanwhile(line: str, expected: list[tuple[str, str, str]]) -> None:
    assert done(line) == [expected]


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("(anna sits down, opens the fridge and yawns)", ["sit", "open", "yawn"]),
        ("(anna sits down, sighs, and looks up)", ["sit", "sigh", "look-up"]),
        ("(anna sits on the sofa watching the tv)", ["sit", "look"]),
        ("(ben puts the cup on the table, smiling)", ["put-down", "smile"]),
        ("(anna looks around before sitting down)", ["look-around", "sit"]),
        ("(ben yawns then sits down)", ["yawn", "sit"]),
        ("(ben sits down and rolls his eyes)", ["sit", "frown"]),
        ("(ben walks over and, without a word, hugs anna)", ["walk", "hug"]),
        ("(anna and ben sit down and start to laugh)", ["sit", "laugh"]),
    ],
)
def test_what_is_done_one_after_the_other(line: str, expected: list[str]) -> None:
    assert [beats[0][1] for beats in done(line)] == expected


def test_then_somebody_else_does_it() -> None:
    for line in ("(ben sits down, then anna sits down)", "(ben sits down and then anna sits down)"):
        assert done(line) == [[("ben", "sit", "")], [("anna", "sit", "")]], line


@pytest.mark.parametrize(
    ("line", "expected", "left"),
    [
        ("(ben sits on the sofa because he is tired)", ("ben", "sit", "sofa"), "because he is tired"),
        ("(ben dances like a robot)", ("ben", "dance", ""), "like a robot"),
        ("(anna walks in, out of breath)", ("anna", "enter", "middle"), "out of breath"),
        ("(anna, annoyed, rolls her eyes)", ("anna", "frown", ""), "annoyed"),
        ("(anna waits for the bus)", ("anna", "wait", ""), "for the bus"),
        ("(anna looks at ben without a word)", ("anna", "look", "ben"), "without a word"),
        ("(anna begs ben to put it away)", ("anna", "beg", "ben"), "to put it away"),
        ("(anna opens the door for ben)", ("anna", "open", "door"), "for ben"),
        ("(anna sleeps next to ben)", ("anna", "sleep", ""), "next to ben"),
    ],
)
def test_what_does_not_show_is_left_out_with_a_warning(
    line: str, expected: tuple[str, str, str], left: str
) -> None:
    board, report = read(line)
    assert board is not None, [d.label for d in report.errors]
    beat = board.lines[0].beats[0]
    assert (beat.character, *told(beat)[:2]) == expected
    assert [d.span.text for d in report.diagnostics if d.code == "VDS082"] == [left]


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("(anna takes ben's hand)", ("anna", "hold-hands", "ben")),
        ("(anna kisses ben's cheek)", ("anna", "kiss", "ben")),
        ("(anna picks up ben’s cup)", ("anna", "pick-up", "cup")),
        ("(anna's hands tremble)", ("anna", "tremble", "")),
        ("(her hands tremble)", ("anna", "tremble", "")),
        ("(ben opens the fridge's door)", ("ben", "open", "door")),
        ("(ben leans in to kiss anna)", ("ben", "kiss", "anna")),
        ("(anna turns to look at ben)", ("anna", "look", "ben")),
        ("(anna goes to sleep)", ("anna", "sleep", "")),
        ("(ben paces up and down)", ("ben", "pace", "")),
        ("(anna peeks inside)", ("anna", "peek", "")),
        ("(anna walk, counter)", ("anna", "walk", "counter")),
    ],
)
def test_whose_it_is_and_what_somebody_is_about_to_do(line: str, expected: tuple[str, str, str]) -> None:
    assert done(line) == [[expected]]


def test_what_somebody_carries_is_theirs() -> None:
    """With two such things about, a possessive says which."""
    board, report = read("(anna plays guitar)\n(ben plays guitar)\n(anna picks up ben's guitar)")
    assert board is not None, report.errors
    assert board.lines[-1].beats[0].target is not None
    assert board.lines[-1].beats[0].target.path == ("ben", "guitar")


def test_who_goes_sits_or_stands_with_something_has_it_in_hand() -> None:
    for line, action in (
        ("(anna walks in with a heavy bucket)", "enter"),
        ("(anna sits down on the sofa with a book)", "sit"),
        ("(anna hurries in with a pile of books under her arm)", "hurry"),
    ):
        board, report = read(line)
        assert board is not None, report.errors
        beat = board.lines[0].beats[0]
        assert (beat.action, beat.brought and beat.brought.path[0]) == (action, "anna"), line
    board, report = read("(anna walks in with the newspaper)")  # which lies on the table
    assert board is not None
    assert board.lines[0].beats[0].brought is None
    assert [d.span.text for d in report.diagnostics] == ["with the newspaper"]


def test_what_no_prop_is_called_is_a_box() -> None:
    board, report = read("(anna picks up the harp)\n(anna gives her harp to ben)\n(he drops it)")
    assert board is not None, report.errors
    assert [(thing.name, thing.prop) for thing in board.scenes[0].carried] == [("harp", "stand_in")]
    assert [(d.code, d.span.text) for d in report.diagnostics] == [("VDS084", "harp")]
    assert board.lines[2].beats[0].target == board.lines[1].beats[0].target


@pytest.mark.parametrize(
    "line",
    [
        "(anna picks up the guittar)",  # a slip of the finger
        "(anna picks up the phnoe)",
        "(anna pick up harp)",  # no sentence: names are what the set has
        "(anna sits on the throne)",
        "(anna opens the trunk)",  # what is opened has to be there
        "(anna picks up the wall)",
        "(anna gives the cup to a stranger)",
    ],
)
def test_what_gets_no_box(line: str) -> None:
    _, report = read(line)
    assert report.diagnostics
    assert not [d for d in report.diagnostics if d.code == "VDS084"]


def test_pronouns_of_one_sentence() -> None:
    assert done("(anna takes some flowers and gives them to ben)")[1] == [("anna", "give", "flowers")]
    assert done("(ben waves)\n(she and ben laugh)")[1] == [("anna", "laugh", ""), ("ben", "laugh", "")]
    assert done("(ben nods and they walk)")[1:] == [[("anna", "walk", ""), ("ben", "walk", "")]]
    assert done("(ben helps anna sit down)") == [[("ben", "help-up", "anna")]]
    assert done("(ben grabs her by the collar)") == [[("ben", "grip", "anna")]]
    assert done("(anna pours him a drink)")[0][0][:2] == ("anna", "pour")


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("(while anna cooks, ben reads)", [[("ben", "read", ""), ("anna", "cook", "stove")]]),
        ("(when anna walks in, ben stands up)", [[("anna", "enter", "middle")], [("ben", "stand-up", "")]]),
        ("(after dinner, ben reads)", [[("ben", "read", "")]]),
        ("(suddenly ben jumps up)", [[("ben", "stand-up", "")]]),
    ],
)
def test_what_stands_before_who_acts(line: str, expected: list[list[tuple[str, str, str]]]) -> None:
    assert done(line) == expected


def test_words_choose_among_the_ways_to_do_it() -> None:
    for line, ways in (
        ("(anna kisses ben on the cheek)", ("cheek",)),
        ("(anna kisses ben)", ()),
        ("(anna pats ben's back)", ("back",)),
        ("(anna pats ben on the shoulder)", ("plain",)),
        ("(anna gives the cup to ben with both hands)", ("both-hands",)),
    ):
        board, report = read(line)
        assert board is not None, report.errors
        assert board.lines[0].beats[0].ways == ways, line


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("(anna sits down, then)", [[("anna", "sit", "")]]),
        ("(anna back away from ben)", [[("anna", "back-away", "ben")]]),
        (
            "(anna closes that window and leaves)",
            [[("anna", "close", "window")], [("anna", "leave", "door")]],
        ),
        ("(anna picks up that cup)", [[("anna", "pick-up", "cup")]]),
        ("(anna give ben ring)", [[("anna", "give", "ring")]]),
        ("(anna serve ben drink)", [[("anna", "serve", "drink")]]),
        ("(anna and ben's hands tremble)", [[("anna", "tremble", ""), ("ben", "tremble", "")]]),
        ("(slowly anna opens the door)", [[("anna", "open", "door")]]),
        ("(slowly and quietly anna opens the door)", [[("anna", "open", "door")]]),
        ("(slowly, quietly, anna opens the door)", [[("anna", "open", "door")]]),
        ("(very slowly but surely, anna opens the door)", [[("anna", "open", "door")]]),
        ("(on the sofa, ben sleeps)", [[("ben", "sleep", "sofa")]]),
        (
            "(both sit down, then leave)",
            [[(w, "sit", "") for w in ("anna", "ben")], [(w, "leave", "door") for w in ("anna", "ben")]],
        ),
        (
            "(they laugh, then ben leaves)",
            [[("anna", "laugh", ""), ("ben", "laugh", "")], [("ben", "leave", "door")]],
        ),
        ("(she smiles and he nods)", [[("anna", "smile", ""), ("ben", "nod", "")]]),
        ("(anna gives the cup to ben and he drinks)", [[("anna", "give", "cup")], [("ben", "drink", "")]]),
        (
            "(ben sits down because he is tired, then anna leaves)",
            [[("ben", "sit", "")], [("anna", "leave", "door")]],
        ),
        ("(ben dances like a robot, and anna laughs)", [[("ben", "dance", ""), ("anna", "laugh", "")]]),
        ("(anna tells ben to leave, then sits down)", [[("anna", "talk", "ben")], [("anna", "sit", "")]]),
    ],
)
def test_what_was_misread_once(line: str, expected: list[list[tuple[str, str, str]]]) -> None:
    assert done(line) == expected


def test_what_others_do_is_not_done_by_who_acts() -> None:
    for line in (
        "(anna looks at ben sitting on the sofa)",
        "(anna watches ben cooking)",
        "(anna gives ben the cup, then the phone)",
        "(anna walks in, a phone in her hand)",
        "(anna sits down after opening the fridge)",
    ):
        assert len(done(line)) == 1, line
        _, report = read(line)
        assert "VDS082" in [d.code for d in report.diagnostics], line


@pytest.mark.parametrize(
    ("line", "slip"),
    [
        ("(anna kisses bne's hand)", "bne's"),
        ("(anna slaps carl's face)", "carl's"),
        ("(anna sits down, opns the fridge and leaves)", "opns"),
        ("(ben reads while ana cooks)", "ana"),
        ("(anna waves, bne nods)", "bne"),
        ("(anna sits down while ben coks)", "coks"),
        ("(anna picks up the table.cupp)", "table.cupp"),
    ],
)
def test_slips_are_told_at_their_place(line: str, slip: str) -> None:
    _, report = read(line)
    assert slip in [d.span.text for d in report.errors]


def test_any_words_are_read_or_told() -> None:
    """Whatever stands between the parentheses, nothing is raised."""
    vocabulary = [
        "anna",
        "ben",
        "she",
        "they",
        "all",
        "him",
        "it",
        "while",
        "as",
        "when",
        "then",
        "and",
        ",",
        "to",
        "with",
        "the",
        "a",
        "cup",
        "door",
        "walks",
        "sits",
        "down",
        "opens",
        "looks",
        "smiling",
        "ben's",
        "her",
        "hand",
        "slowly",
        "back",
        "away",
        "before",
        "after",
        "because",
        "like",
        "who",
        "gives",
        "each",
        "other",
        "is",
        "starts",
        "goes",
        "on",
    ]
    rng = random.Random(7)
    for _ in range(150):
        said = [
            rng.choice(("anna", "she", "they", "the", "when")),
            *(rng.choice(vocabulary) for _ in range(rng.randint(0, 8))),
        ]
        read(f"({' '.join(said)})")


def test_an_unknown_verb_after_and_is_told_by_itself() -> None:
    _, report = read("(anna sits down and frobnicates the door)")
    (warning,) = report.diagnostics
    assert (warning.code, warning.label) == ("VDS085", "this is shown as `anna look at door`")
    assert warning.span.text.startswith("frobnicates")


@pytest.mark.parametrize(
    "line",
    [
        "(anna looks at bne's cup)",
        "(anna walks to the doro because it rings)",  # a slip of the finger in what is done
        "(anna picks up the cupp from ben)",
        "(anna waves at bne)",
        "(anna, ben)",
    ],
)
def test_slips_of_the_finger_are_errors_all_the_same(line: str) -> None:
    board, report = read(line)
    assert report.errors, board


def test_each_part_is_told_in_its_own_words() -> None:
    told_as = {
        "(ben reads while anna cooks)": ["ben reads + anna cooks"],
        "(ben sits down, then anna sits down)": ["ben sits down", "anna sits down"],
        "(her hands tremble)": ["anna's hands tremble"],
        "(anna, annoyed, rolls her eyes)": ["anna, annoyed, rolls her eyes"],
    }
    for line, expected in told_as.items():
        board, report = read(line)
        assert board is not None, report.errors
        assert [line_words(each, "") for each in board.lines] == expected
