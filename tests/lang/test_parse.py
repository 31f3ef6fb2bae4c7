# ruff: noqa: E501 (whole scripts in a line)
"""Text into syntax tree: shapes, places, layout, recovery."""

from __future__ import annotations

import pytest
from hypothesis import given, seed, settings
from hypothesis import strategies as st

from vdsl.lang import Report, Source, ast, parse
from vdsl.lang.parse import parse_definition


def read(text: str) -> tuple[tuple[ast.Statement, ...], list[tuple[str, str]]]:
    script, report = parse(Source("x.vds", text))
    return script.statements, [(d.code, d.span.text) for d in report.diagnostics]


def one(text: str) -> ast.Statement:
    statements, found = read(text)
    assert not found
    assert len(statements) == 1
    return statements[0]


def test_a_story_line_has_beats_options_and_cameras() -> None:
    story = one(
        '(anna pick up cup) + (ben wave) / (push|static close up *) lens 35..85mm, 4s, say "Hi # no"  # yes'
    )
    assert isinstance(story, ast.StoryNode)
    assert [[w.text for w in beat.words] for beat in story.beats] == [
        ["anna", "pick", "up", "cup"],
        ["ben", "wave"],
    ]
    (camera,) = story.cameras
    assert camera.words is not None
    assert [word.span.text for word in camera.words] == ["push|static", "close", "up", "*"]
    assert [(o.name.text, [v.span.text for v in o.values]) for o in camera.options] == [
        ("lens", ["35..85mm"]),
        ("4s" and "duration", ["4s"]),
        ("say", ['"Hi # no"']),
    ]


def test_camera_lines_belong_to_the_line_right_above() -> None:
    statements, found = read(
        "(a walk) / (static)\n  / (follow)\n# a note\n/ (arc)\n\n/ (pan wide)\n/ (tilt)\n(a wave)\n"
    )
    assert not found
    first, second, third, fourth = statements
    assert isinstance(first, ast.StoryNode)
    assert len(first.cameras) == 3
    assert isinstance(second, ast.StoryNode)
    assert not second.beats
    assert [len(s.cameras) for s in (second, third, fourth) if isinstance(s, ast.StoryNode)] == [1, 1, 0]


def test_a_camera_line_after_anything_else_stands_alone() -> None:
    statements, _ = read("scene a = b\n/ (pan wide)\n(a wave)\n")
    assert isinstance(statements[1], ast.StoryNode)
    assert not statements[1].beats


@pytest.mark.parametrize(
    ("text", "shape"),
    [
        ("width - 4cm", "(width - 4.0cm)"),
        ("a-b", "a-b"),
        ("-3cm", "-3.0cm"),
        ("-width", "-width"),
        ("1 + 2 * 3", "(1.0 + (2.0 * 3.0))"),
        ("(1 + 2) * 3", "((1.0 + 2.0) * 3.0)"),
        ("8 - 4 - 2", "((8.0 - 4.0) - 2.0)"),
        ("8 / 4 / 2", "((8.0 / 4.0) / 2.0)"),
        ("1 - -2", "(1.0 - -2.0)"),
    ],
)
def test_arithmetic_binds_as_it_should(text: str, shape: str) -> None:
    definition = one(f"prop p {{ box {text} }}")
    assert isinstance(definition, ast.Definition)
    values = definition.body[0].values
    assert len(values) == 1
    assert _shape(values[0]) == shape


def _shape(value: ast.Value) -> str:
    if isinstance(value, ast.Binary):
        return f"({_shape(value.left)} {value.op} {_shape(value.right)})"
    if isinstance(value, ast.Negate):
        return f"-{_shape(value.value)}"
    if isinstance(value, ast.Number):
        return f"{value.value}{value.unit or ''}"
    if isinstance(value, ast.Group):
        return _shape(value.items[0])
    assert isinstance(value, ast.Name)
    return value.text


def test_a_space_before_a_minus_and_none_after_begins_a_new_value() -> None:
    definition = one("prop p { box 1 -2 }")
    assert isinstance(definition, ast.Definition)
    assert [_shape(v) for v in definition.body[0].values] == ["1.0", "-2.0"]


def test_entries_nest_and_may_share_a_line() -> None:
    definition = one(
        "set s {\n  room k, at (0,\n      0)m {\n    place t = table(width 1m), turn 90deg { place c = cup, on top; spot x }\n  }\n}"
    )
    assert isinstance(definition, ast.Definition)
    (room,) = definition.body
    assert room.options[0].name.text == "at"
    assert room.body is not None
    (table,) = room.body
    assert isinstance(table.bound[0], ast.Call)
    assert table.body is not None
    assert [entry.head.text for entry in table.body] == ["place", "spot"]


@pytest.mark.parametrize("end", ["\n", "\r\n"])
@pytest.mark.parametrize("mark", ["", "\ufeff"])
def test_line_ends_and_byte_order_marks_do_not_matter(end: str, mark: str) -> None:
    lines = [
        'storyboard "Größe"',
        "",
        "(Zoë wave)  / (static)  # hier",
        "  / (arc)",
        "",
        "/ (pan)",
        "prop p {",
        " box 1m",
        "}",
        "",
    ]
    plain, _ = read("\n".join(lines))
    other, found = read(mark + end.join(lines))
    assert not found
    assert other == plain
    assert [s.span.text.replace("\r", "") for s in other] == [s.span.text for s in plain]


def test_spans_are_where_things_are() -> None:
    text = "fps 24\n\ncharacter anna = woman(height 1.68m)\n(anna walk chair_2.seat) / (static) roll -12deg\n"
    statements, _ = read(text)
    character, story = statements[1], statements[2]
    assert isinstance(character, ast.CharacterLine)
    assert isinstance(character.cast, ast.Call)
    assert character.cast.callee.span.text == "woman"
    assert character.cast.arguments[0].span.text == "height 1.68m"
    assert isinstance(story, ast.StoryNode)
    assert story.beats[0].words[2].span.text == "chair_2.seat"
    assert story.cameras[0].options[0].values[0].span.text == "-12deg"
    assert story.span.line_number == 4


def test_one_bad_line_is_one_error_and_the_rest_is_read() -> None:
    good = "(anna wave)\n"
    for bad in (
        "(anna walk,\n",
        "(anna walk\n",
        "huh\n",
        '(anna say "x\n',
        "anna at\n",
        "scene =\n",
        "walk)\n",
        "prop\n",
    ):
        statements, found = read(good + bad + good)
        assert len(found) == 1, (bad, found)
        assert len(statements) == 2, bad


def test_a_bad_entry_does_not_hide_its_neighbours() -> None:
    statements, found = read(
        "prop p {\n  box 1m\n  box ,\n  room {\n    bad = \n    spot x\n  }\n  sphere 1m\n}\n(a wave)\n"
    )
    definition = statements[0]
    assert isinstance(definition, ast.Definition)
    assert [entry.head.text for entry in definition.body] == ["box", "room", "sphere"]
    assert len(found) == 2
    assert len(statements) == 2


def test_one_definition_of_a_file_can_be_read_alone() -> None:
    report = Report()
    source = Source("x", "prop a { box 1m }\nprop a-b { box 2m }\nprop b(width 1m) { box width }\n")
    found = parse_definition(source, "prop", "b", report)
    assert found is not None
    assert found.parameters[0].name.text == "width"
    assert parse_definition(source, "prop", "c", report) is None
    assert not report.diagnostics


PIECES = st.sampled_from(
    ["(", ")", "{", "}", '"', "/", "|", "*", ",", ";", "=", "+", "-", "..", ".", "#", "\n", "\r\n", " ", "\t", "anna", "at", "scene",
     "character", "storyboard", "prop", "set", "action", "cast", "use", "fps", "size", "cut", "dissolve", "box", "24", "4s", "1.5m", "3deg",
     "12f", "0", "é", "猫", "\ufeff", "\\", '"x"', "woman(", ")m", "lens", "say", "follow", "close up", "“", "'", "\x00", "\x1b[31m"]
)  # fmt: skip


@seed(7)
@settings(max_examples=300, deadline=None)
@given(
    st.lists(PIECES, max_size=40).map(" ".join)
    | st.lists(PIECES, max_size=40).map("".join)
    | st.text(max_size=80)
)
def test_no_text_raises_and_every_finding_has_a_place(text: str) -> None:
    script, report = parse(Source("x", text))
    for d in report.diagnostics:
        assert 0 <= d.span.start <= d.span.end <= len(text)
    for statement in script.statements:
        assert 0 <= statement.span.start < statement.span.end <= len(text)
    assert [d.span.start for d in report.diagnostics] == sorted(d.span.start for d in report.diagnostics)


@pytest.mark.parametrize(
    "text",
    ["(" * 50_000, "{" * 3_000, "}" * 3_000, '"' * 50_000, "(anna " + "walk " * 10_000 + ")", "prop p { box " + "-" * 15_000 + "1 }",
     "prop p { box " + "1 + " * 4_000 + "1 }", "prop p(" + "\n(a" * 2_000, "a" * 100_000],
)  # fmt: skip
def test_monstrous_lines_are_reported_not_choked_on(text: str) -> None:
    _, report = parse(Source("x", text))
    assert report.has_errors
