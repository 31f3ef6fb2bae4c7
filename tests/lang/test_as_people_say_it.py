"""Story lines as people write them: whose something is, to whom it is given, and what goes without saying."""

from __future__ import annotations

import pytest

from vdsl.emit.words import line_words
from vdsl.lang import Report, Source, check, parse
from vdsl.lang.ir import Beat, Storyboard
from vdsl.library import Catalog

HEAD = "character anna = woman\ncharacter ben = man\nscene s = {set} at day\n"


def read(line: str, place: str = "apartment") -> tuple[Storyboard | None, Report]:
    script, report = parse(Source("x.vds", HEAD.format(set=place) + f"anna at door\nben at door\n{line}\n"))
    return check(script, Catalog.for_script(script, report), report), report


def beat(line: str, place: str = "apartment") -> Beat:
    board, report = read(line, place)
    assert board is not None, [d.label for d in report.errors]
    return board.lines[0].beats[0]


def told(found: Beat) -> tuple[str, str, str, str]:
    """Action, target, second target, and what is brought."""
    named = (t.path[-1] if t is not None else "" for t in (found.target, found.second, found.brought))
    target, second, brought = named
    return found.action, target, second, brought


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("(anna plays the guitar)", ("play-guitar", "", "", "guitar")),
        ("(anna brushes her teeth)", ("brush-teeth", "", "", "toothbrush")),
        ("(anna checks her watch)", ("check-watch", "", "", "")),
        ("(anna takes out her phone)", ("show", "phone", "", "")),
        ("(ben lights a cigarette)", ("smoke", "", "", "cigarette")),
        ("(ben points a gun at anna)", ("aim", "anna", "", "gun")),
        ("(ben takes a photo of anna)", ("photograph", "anna", "", "camera")),
        ("(anna calls ben)", ("call", "", "ben", "phone")),
        ("(anna gives ben a hug)", ("hug", "ben", "", "")),
        ("(ben gives anna a high five)", ("high-five", "anna", "", "")),
        ("(anna takes a look at the window)", ("look", "window", "", "")),
        ("(anna takes a bow)", ("bow", "", "", "")),
        ("(ben gives anna a push)", ("push-away", "anna", "", "")),
        ("(ben pulls anna along)", ("lead", "anna", "", "")),
        ("(ben touches anna)", ("pat", "anna", "", "")),
        ("(anna gives ben a drink)", ("give", "drink", "ben", "")),  # a thing too
        ("(ben drinks coffee)", ("drink", "coffee", "", "")),
        ("(anna throws the ball to ben)", ("throw", "ball", "ben", "")),
        ("(anna gives ben the cup)", ("give", "cup", "ben", "")),
        ("(anna shows ben some flowers)", ("show", "flowers", "ben", "")),
        ("(anna sits down)", ("sit", "", "", "")),
        ("(anna stops)", ("wait", "", "", "")),  # and makes no sign to nobody
        ("(anna stops ben)", ("stop", "ben", "", "")),
        ("(ben cooks)", ("cook", "stove", "", "pan")),
        ("(ben cooks dinner)", ("cook", "stove", "", "pan")),
        ("(anna writes a poem)", ("write", "desk", "", "pen")),
        ("(ben slams the door)", ("close", "door", "", "")),
        ("(anna looks through sink_window)", ("look", "sink_window", "", "")),
    ],
)
def test_lines_are_read_as_they_are_said(line: str, expected: tuple[str, str, str, str]) -> None:
    assert told(beat(line)) == expected


def test_what_a_word_stands_for_is_brought_as_that() -> None:
    board, _ = read("(ben drinks coffee)")
    assert board is not None
    assert [(thing.name, thing.prop) for thing in board.scenes[0].carried] == [("coffee", "cup")]


def test_what_the_scene_has_is_not_brought() -> None:
    board, _ = read("(ben drinks from the cup)")
    assert board is not None
    assert board.scenes[0].carried == ()


@pytest.mark.parametrize(
    ("line", "thing"),
    [("(anna picks up the violin)", "violin"), ("(ben looks at the letter)", "letter")],
)
def test_what_the_scene_has_not_is_put_about_with_a_warning(line: str, thing: str) -> None:
    board, report = read(line)
    assert board is not None
    assert [(d.code, d.span.text) for d in report.diagnostics] == [("VDS083", thing)]
    assert [(each.name, each.about, each.held) for each in board.scenes[0].carried] == [(thing, True, False)]


@pytest.mark.parametrize(
    ("line", "code", "place"),
    [
        ("(anna open umbrella)", "VDS060", "umbrella"),  # nothing to be opened is brought
        ("(anna walk piano)", "VDS060", "piano"),  # nor what cannot be carried
        ("(anna gives ben the cupp)", "VDS060", "cupp"),
        ("(ben cooks stoev)", "VDS060", "stoev"),  # so like a name that it is one
        ("(anna throws the sofa2 to ben)", "VDS060", "sofa2"),
    ],
)
def test_what_is_wrong_is_told_all_the_same(line: str, code: str, place: str) -> None:
    _, report = read(line)
    assert [(d.code, d.span.text) for d in report.errors] == [(code, place)]


def test_of_several_alike_in_the_scene_the_first_is_taken_with_a_warning() -> None:
    board, report = read("(anna waters the plant)")
    assert board is not None
    warning = next(d for d in report.diagnostics if d.code == "VDS061")
    assert (warning.severity, warning.label) == (
        "warning",
        "`plant` could be any of 2: `living.plant` is taken",
    )
    assert board.lines[0].beats[0].target is not None
    _, report = read("(anna walk book)", "apartment.kitchen")  # those are in other rooms
    assert [d.code for d in report.errors] == ["VDS061"]


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("(ben walks in)", ("enter", "middle", "", "")),
        ("(anna storms out)", ("leave", "door", "", "")),
        ("(anna sits back down)", ("sit", "", "", "")),
        ("(anna starts to cry)", ("cry", "", "", "")),
        ("(anna is crying)", ("cry", "", "", "")),
        ("(anna keeps waving at ben)", ("wave", "ben", "", "")),
        ("(anna throws the ball away)", ("throw-away", "ball", "", "")),
        ("(ben picks the cup up again)", ("pick-up", "cup", "", "")),
        ("(anna folds her arms)", ("cross-arms", "", "", "")),
        ("(anna kisses ben on the cheek)", ("kiss", "ben", "", "")),
        ("(anna kisses him)", ("kiss", "ben", "", "")),
        ("(ben hugs her)", ("hug", "anna", "", "")),
        ("(ben takes her hand)", ("hold-hands", "anna", "", "")),
        ("(ben runs past)", ("run", "", "", "")),
        ("(anna stands in front of the fridge)", ("walk", "fridge", "", "")),
        ("(anna walks up to ben)", ("approach", "ben", "", "")),
        ("(ben hides behind the sofa)", ("hide", "sofa", "", "")),
        ("(ben sits across from anna)", ("sit", "anna", "", "")),
        ("(anna drops the cup on the floor)", ("drop", "cup", "", "")),
        ("(ben drinks a glass of water)", ("drink", "glass", "", "")),
        ("(anna slumps on the sofa)", ("sit", "sofa", "", "")),
        ("(anna points at the sky)", ("point", "", "", "")),
        ("(ben orders a pizza)", ("order", "", "", "")),
    ],
)
def test_what_stands_around_a_verb_says_what_it_is_or_nothing(
    line: str, expected: tuple[str, str, str, str]
) -> None:
    assert told(beat(line)) == expected


def test_pronouns_are_who_and_what_was_spoken_of_last() -> None:
    lines = "(carl waves at anna)\n(ben hugs her)\n(anna kisses him)\n(ben takes anna by the hand)"
    lines += "\n(anna blows carl a kiss)\n(ben picks up the cup)\n(ben gives it to carl)"
    lines += "\n(anna puts her arms around him)"
    board, report = read(f"character carl = man\ncarl at door\n{lines}")
    assert board is not None, [d.label for d in report.errors]
    assert [told(line.beats[0])[:3] for line in board.lines] == [
        ("wave", "anna", ""), ("hug", "anna", ""), ("kiss", "ben", ""), ("hold-hands", "anna", ""),
        ("blow-kiss", "carl", ""), ("pick-up", "cup", ""), ("give", "cup", "carl"), ("hug", "carl", ""),
    ]  # fmt: skip


def test_a_pronoun_is_somebody_it_can_mean() -> None:
    lines = "(anna gives ben the cup)\n(carl hugs her)\n(ben looks at carl)\n(anna kisses him again)"
    lines += "\n(ben looks at her again)\n(anna opens kitchen.door)\n(ben closes it)\n(ben looks at carl)"
    board, report = read(f"character carl = man\ncarl at door\n{lines}")
    assert board is not None, [d.label for d in report.errors]
    assert [told(line.beats[0])[:2] for line in board.lines] == [
        ("give", "cup"), ("hug", "anna"), ("look", "carl"), ("kiss", "carl"), ("look", "anna"),
        ("open", "door"), ("close", "door"), ("look", "carl"),
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("(anna backs away from ben)", ("back-away", "ben", "", "")),
        ("(anna steps back to the door)", ("back-away", "door", "", "")),
        ("(anna walks away from ben)", ("back-away", "ben", "", "")),
        ("(they look at each other)", ("look", "ben", "", "")),
    ],
)
def test_particles_of_a_verb_are_no_prepositions(line: str, expected: tuple[str, str, str, str]) -> None:
    assert told(beat(line)) == expected


@pytest.mark.parametrize(
    ("line", "action"),
    [
        ("(anna leans against the wall)", "lean-against"),
        ("(anna leans up against the wall)", "lean-against"),
        ("(anna leans with her back against the wall)", "lean-against"),
        ("(ben leans on the wall)", "lean-against"),
        ("(anna sits with her back against the wall)", "sit-against"),
        ("(anna slides down the wall)", "sit-against"),
    ],
)
def test_one_leans_against_the_nearest_wall(line: str, action: str) -> None:
    assert told(beat(line)) == (action, "", "", "")


def test_a_wall_is_nothing_that_something_else_is_done_to() -> None:
    for line in ("(anna hits the wall)", "(anna walks to the wall)", "(anna sits down by the wall)"):
        board, report = read(line)
        assert board is not None
        assert board.lines[0].beats[0].target is None
        assert [d.code for d in report.diagnostics] == ["VDS085"], line


def test_only_what_is_mutual_is_done_to_each_other() -> None:
    for line in ("(they order)", "(they listen)", "(they shout)"):
        board, _ = read(line)
        assert board is not None
        assert [told(b)[1] for b in board.lines[0].beats] == ["", ""], line


def test_who_looks_away_from_somebody_does_not_look_at_them() -> None:
    for line in ("(anna looks away from ben)", "(anna turns away from ben)"):
        board, _ = read(line)
        assert board is None or told(board.lines[0].beats[0])[:2] == ("look-down", ""), line


def test_what_is_there_is_named_and_part_of_no_verb() -> None:
    """`phone` beside `look at` is the phone on the desk; `look at phone` is what is done with one's own."""
    assert told(beat("(anna looks at the phone)", "office")) == ("look", "phone", "", "")
    assert told(beat("(anna picks up the phone)", "office")) == ("pick-up", "phone", "", "")
    assert told(beat("(anna talks on the phone)", "office")) == ("phone", "phone", "", "")


def test_one_thing_after_the_other_is_two_lines_filmed_alike() -> None:
    text = (
        "(ben sits down and reads the newspaper) / (static medium) 4s\n"
        "(she picks up the cup and slowly gives it to ben)\n"
        "(anna and ben laugh and wave)\n"
        "(they wave and laugh and clap) / (static full)\n"
    )
    board, report = read(text)
    assert board is not None, report.errors
    found = [(line_words(line, ""), [b.character for b in line.beats]) for line in board.lines]
    both = ["anna", "ben"]
    assert found == [
        ("ben sits down", ["ben"]),
        ("ben reads the newspaper", ["ben"]),
        ("anna picks up the cup", ["anna"]),
        ("anna gives it to ben", ["anna"]),
        ("anna and ben laugh", both),
        ("anna and ben wave", both),
        ("they wave", both),
        ("they laugh", both),
        ("they clap", both),
    ]
    assert [shot.scales for line in board.lines[:2] for shot in line.shots] == [("medium",)] * 2
    first, second = (line.shots[0].duration for line in board.lines[:2])
    assert first == 4.0 != second
    assert [b.target.path[-1] for b in board.lines[3].beats if b.target] == ["cup"]


@pytest.mark.parametrize(
    ("line", "done"),
    [
        ("(anna trips and falls)", ["fall-down"]),
        ("(anna and ben kiss and hug)", ["kiss", "hug"]),
        ("(ben stops and then runs away)", ["wait", "run"]),
        ("(anna stands up and starts to cry)", ["stand-up", "cry"]),
        ("(anna looks at the cup and picks it up)", ["look", "pick-up"]),
        ("(they sit down and drink)", ["sit", "drink"]),
        ("(anna has a look around)", ["look-around"]),
        ("(anna takes a quick look at ben)", ["look"]),
    ],
)
def test_what_is_done_one_after_the_other(line: str, done: list[str]) -> None:
    board, report = read(line)
    assert board is not None, [d.label for d in report.errors]
    assert [each.beats[0].action for each in board.lines] == done


def test_no_glass_stands_about_where_a_line_means_the_water() -> None:
    text = "character anna = woman\nscene s = beach\nanna at middle\n(anna looks at the water)\n"
    script, report = parse(Source("x.vds", text))
    check(script, Catalog.for_script(script, report), report)
    told_of = {d.code: d.label for d in report.diagnostics}
    assert told_of["VDS085"] == "this is shown as `anna looks at`"
    assert "VDS083" not in told_of


def test_they_all_do_both() -> None:
    board, _ = read("character carl = man\ncarl at door\n(they all laugh and clap)")
    assert board is not None
    assert [[b.character for b in line.beats] for line in board.lines] == [["anna", "ben", "carl"]] * 2


@pytest.mark.parametrize(
    ("line", "shown"),
    [
        ("(ben takes a punch from anna)", ("wait", "")),  # who takes one does not hit
        ("(anna carries bags and boxes)", ("wait", "")),
        ("(anna slowly picks up the cup and box)", ("pick-up", "cup")),
    ],
)
def test_what_would_be_misread_is_told(line: str, shown: tuple[str, str]) -> None:
    board, report = read(line)
    assert board is not None
    assert [told(b)[:2] for each in board.lines for b in each.beats] == [shown]
    assert "VDS085" in [d.code for d in report.diagnostics]


def test_what_is_so_like_a_name_that_it_is_one_is_an_error() -> None:
    _, report = read("(ben sits on the stoev)")
    assert [(d.code, d.suggestion) for d in report.errors] == [("VDS060", "stove")]


def test_what_lies_about_is_what_an_action_needs() -> None:
    board, _ = read("(anna looks at the guitar)\n(anna plays guitar)")
    assert board is not None
    look, play = (line.beats[0] for line in board.lines)
    assert look.target == play.target
    assert play.brought is None


def test_two_targets_are_no_two_things_done() -> None:
    _, report = read("character carl = man\ncarl at door\n(carl looks at anna and ben)")
    (warning,) = report.diagnostics
    assert warning.help is not None
    assert warning.help.endswith("`(carl looks at anna)` `(carl looks at ben)`")
    for line in ("(anna picks up the cup and saucer)", "(ben walks to the door and window)"):
        board, report = read(line)
        assert board is not None
        assert len(board.lines) == 1, line
        assert [d.code for d in report.diagnostics] == ["VDS085"], line


def test_two_who_are_named_are_each_of_them_or_do_it_to_each_other() -> None:
    three = "character carl = man\ncarl at door\n"
    for line, expected in (
        ("(anna and carl walk to the counter)", [("anna", "walk", "counter"), ("carl", "walk", "counter")]),
        ("(anna and carl talk)", [("anna", "talk", "carl"), ("carl", "talk", "anna")]),
        ("(ben and carl look at each other)", [("ben", "look", "carl"), ("carl", "look", "ben")]),
        ("(ben and carl hug)", [("ben", "hug", "carl")]),
        ("(ben and carl look at her)", [("ben", "look", "anna"), ("carl", "look", "anna")]),
        (
            "(anna and ben and carl laugh)",
            [("anna", "laugh", ""), ("ben", "laugh", ""), ("carl", "laugh", "")],
        ),
    ):
        board, report = read(three + line)
        assert board is not None, report.errors
        found = [
            (b.character, b.action, "" if b.target is None else b.target.path[-1])
            for b in board.lines[0].beats
        ]
        assert found == expected, line
    for line, code in (
        ("(anna and bob wave)", "VDS065"),
        ("(anna and ben)", "VDS070"),
        ("(anna and anna wave)", "VDS076"),
    ):
        _, report = read(line)
        assert [d.code for d in report.errors] == [code], line


def test_they_are_both_or_do_it_to_each_other() -> None:
    board, _ = read("(they laugh)")
    assert board is not None
    assert [(b.character, b.action) for b in board.lines[0].beats] == [("anna", "laugh"), ("ben", "laugh")]
    assert told(beat("(they shake hands)")) == ("shake-hands", "ben", "", "")
    for line in ("(they talk)", "(they chat)", "(they look at each other)"):
        board, _ = read(line)
        assert board is not None
        assert [(b.character, told(b)[1]) for b in board.lines[0].beats] == [
            ("anna", "ben"),
            ("ben", "anna"),
        ]


def acts(lines: str) -> list[tuple[str, str, str]]:
    """Who does what, to whom, in all lines."""
    board, report = read(lines)
    assert board is not None, [d.label for d in report.errors]
    return [
        (b.character, b.action, "" if b.target is None else b.target.path[-1])
        for line in board.lines
        for b in line.beats
    ]


THREE = "character carl = man\ncarl at door\n"


def test_who_acts_may_be_said_by_a_pronoun() -> None:
    assert acts("(anna waves)\n(she laughs)\n(ben waves)\n(he nods)\n(she nods)") == [
        ("anna", "wave", ""),
        ("anna", "laugh", ""),
        ("ben", "wave", ""),
        ("ben", "nod", ""),
        ("anna", "nod", ""),
    ]
    # who acted last comes before who was spoken of last
    assert acts(THREE + "(ben hugs anna)\n(he waves at carl)\n(he laughs)")[2] == ("ben", "laugh", "")
    assert acts(THREE + "(anna hugs carl)\n(he laughs)")[1] == ("carl", "laugh", "")
    assert acts("(she waves)")[0][0] == "anna"  # nobody else may be meant
    assert acts(THREE + "(carl gives ben the cup)\n(they laugh)")[1:] == [
        ("ben", "laugh", ""),
        ("carl", "laugh", ""),
    ]
    assert acts(THREE + "(everybody laughs)") == [(name, "laugh", "") for name in ("anna", "ben", "carl")]
    assert acts(THREE + "(they all look at anna)") == [("ben", "look", "anna"), ("carl", "look", "anna")]
    assert acts("(they laugh)\n" + THREE + "(they wave)\n(he nods)")[2:] == [
        ("anna", "wave", ""),
        ("ben", "wave", ""),
        ("ben", "nod", ""),
    ]
    for line in ("(they laugh)", "(he laughs)", "(we laugh)"):
        board, report = read(THREE + line)
        assert board is None
        assert [d.code for d in report.errors] == ["VDS065"], line
        assert report.errors[0].help == "say who by name, of anna, ben and carl"


def test_what_a_thing_is_like_and_how_something_is_done_is_left_out() -> None:
    """With a warning where it would be seen."""
    for line, expected, left in (
        ("(anna opens the heavy old window)", ("anna", "open", "window"), ["`heavy old` is left out"]),
        ("(ben drinks a hot coffee)", ("ben", "drink", "coffee"), ["`hot` is left out"]),
        ("(anna peeks at ben over the table)", ("anna", "peek", "ben"), ["`over the table` is left out"]),
        ("(anna walks to the kitchen window)", ("anna", "walk", "window"), []),
        ("(anna sits down with a heavy sigh)", ("anna", "sit", ""), []),
        ("(ben laughs to himself for a long time)", ("ben", "laugh", ""), []),
        ("(anna nods again and again)", ("anna", "nod", ""), []),
        ("(ben washes his greasy hands)", ("ben", "wash", "sink"), []),
        ("(anna reads the old books)", ("anna", "read", "book"), ["`old` is left out"]),
        ("(ben gives anna a bunch of roses)", ("ben", "give", "rose"), []),
        ("(anna looks loudly at him)", ("anna", "look", "ben"), []),
        (
            "(anna gives ben a letter under the table)",
            ("anna", "give", "letter"),
            ["`under the table` is left out"],
        ),
    ):
        board, report = read(line)
        assert board is not None, (line, [d.label for d in report.errors])
        found = board.lines[0].beats[0]
        target = "" if found.target is None else found.target.path[-1].split(".")[-1]
        assert (found.character, found.action) == expected[:2], line
        assert target.startswith(expected[2]), (line, target)
        assert [d.label for d in report.diagnostics if d.code == "VDS082"] == left, line
    for line, code in (
        ("(anna pour cup table)", "VDS073"),  # two names, and no word for what the table is like
        ("(anna picks up the cup to the table)", "VDS085"),  # that would be seen
    ):
        _, report = read(line)
        assert code in [d.code for d in report.diagnostics], line


def test_what_is_numbered_is_found_by_its_word_and_a_kind_by_its_own() -> None:
    board, report = read("(anna walks to desk)\n(ben looks at the printer)", "office")
    assert board is not None
    assert board.lines[0].beats[0].target is not None
    assert board.lines[0].beats[0].target.path[-1] == "desk_1"
    assert [(d.code, d.severity) for d in report.diagnostics] == [("VDS061", "warning")]


def test_several_do_it_to_somebody_else_and_whom_is_the_same_for_all() -> None:
    assert (
        acts(THREE + "(anna and ben hug carl)\n(they hug carl)")
        == [
            ("anna", "hug", "carl"),
            ("ben", "hug", "carl"),
        ]
        * 2
    )
    assert acts(THREE + "(ben waves)\n(they all look at him)")[1:] == [
        ("anna", "look", "ben"),
        ("carl", "look", "ben"),
    ]
    assert acts(THREE + "(anna and ben look at him)") == [("anna", "look", "carl"), ("ben", "look", "carl")]
    assert acts("(they look at ben)") == [("anna", "look", "ben")]
    for line in ("(all)", "(everybody)", "(they all)"):
        board, report = read(line)
        assert board is None, line
        assert report.errors, line


def test_who_is_meant_does_not_hang_on_later_lines() -> None:
    board, report = read("(they laugh)\n(he waves)\n" + THREE.split("\n")[0] + "\n(carl walks in)")
    assert board is not None, report.errors
    assert [b.character for line in board.lines for b in line.beats] == ["anna", "ben", "ben", "carl"]


def test_what_is_no_adverb_and_no_adjective_is_told() -> None:
    for line, code in (
        ("(anna waves at molly)", "VDS085"),
        ("(anna walks to emily)", "VDS085"),
        ("(anna shows bne the cup)", "VDS073"),
        ("(anna puts her hand on his shoulder)", "VDS085"),
        ("(ben pats his pockets)", "VDS085"),
    ):
        _, report = read("(ben waves)\n" + line)
        assert code in [d.code for d in report.diagnostics], line
    for line, expected in (
        ("(anna puts the hat on her head)", ("anna", "put-on", "hat")),
        ("(anna dances with joy)", ("anna", "dance", "")),
        ("(anna stretches out her arms)", ("anna", "stretch", "")),
        ("(anna carries the cup behind her)", ("anna", "carry", "cup")),
        ("(anna reads the letter one last time)", ("anna", "read", "letter")),
    ):
        assert acts(line) == [expected], line
    assert acts("(anna and ben join hands)") == [("anna", "hold-hands", "ben")]


@pytest.mark.parametrize(
    ("line", "done"),
    [
        ("(anna quickly and quietly opens the door)", ["open"]),
        ("(anna opens the door slowly and carefully)", ["open"]),
        ("(anna softly and then loudly sings)", ["sing"]),
        ("(anna waves slowly but surely at ben)", ["wave"]),
        ("(anna sits down quietly and slowly reads)", ["sit", "read"]),
        ("(anna walks quickly and sits down)", ["walk", "sit"]),
    ],
)
def test_and_between_manners_joins_nothing_that_is_done(line: str, done: list[str]) -> None:
    board, report = read(line)
    assert board is not None, [d.label for d in report.errors]
    assert not report.errors
    assert [each.beats[0].action for each in board.lines] == done
