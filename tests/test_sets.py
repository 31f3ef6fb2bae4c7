"""Sets and props in text: what they read as, and what is said of mistakes in them."""

from __future__ import annotations

import math
import re
from pathlib import Path

import pytest

from vdsl.lang.definitions.colours import COLOURS, colour
from vdsl.lang.definitions.prop import PropDef, read_prop
from vdsl.lang.definitions.set import SetDef, check_set, read_set
from vdsl.lang.definitions.types import SetNode
from vdsl.lang.diagnostics import Report
from vdsl.lang.parse import parse_definition
from vdsl.lang.source import Source
from vdsl.library.loader import Catalog

CATALOG = Catalog()
TABLE_ROOM = "set s {{\n  room r, size (4, 3, 2.6)m {{\n    {}\n  }}\n}}"


def prop(text: str, name: str = "p") -> tuple[PropDef, Report]:
    report = Report()
    definition = parse_definition(Source("test.vds", text), "prop", name, report)
    assert definition is not None
    found = read_prop(definition, report)
    assert found is not None
    return found, report


def a_set(text: str) -> tuple[SetDef | None, Report]:
    report = Report()
    definition = parse_definition(Source("test.vds", text), "set", "s", report)
    assert definition is not None
    found = read_set(definition, report)
    if found is not None:
        check_set(found, CATALOG, report)
    return found, report


def codes(report: Report) -> list[str]:
    return [d.code for d in report.errors]


def find(node: SetNode, path: tuple[str, ...]) -> SetNode:
    for name in path:
        node = next(child for child in node.children if child.name == name)
    return node


# --- props ----------------------------------------------------------------------------


def test_arithmetic_and_parameters() -> None:
    box_line = "box (width / 2, width - 40cm, 2 * (width + 10cm)), at (-width / n, 0, 3cm)"
    p, report = prop("prop p(width 1m, n 2) {\n" + box_line + "\n}")
    assert not report.errors
    box = p.shape().primitives[0]
    assert box.size == pytest.approx((0.5, 0.6, 2.2))
    assert box.at == pytest.approx((-0.5, 0, 0.03))
    other = p.shape({"width": 2.0, "n": 4.0}).primitives[0]
    assert other.size == pytest.approx((1.0, 1.6, 4.2))
    assert other.at == pytest.approx((-0.5, 0, 0.03))


def test_repeat_counts_and_nests() -> None:
    p, report = prop("prop p {\n repeat i 3 {\n repeat j 2 { sphere 1cm, at (i * 1m, j * 1m, 0) }\n }\n}")
    assert not report.errors
    assert [s.at for s in p.shape().primitives] == [(i, j, 0) for i in range(3) for j in range(2)]


def test_spots_grip_and_solids() -> None:
    p, report = prop(
        "prop p(top oak) {\n box (1, 1, 1)m, color top\n spot top, at (0, 0, 1)m\n"
        " spot stand, at (0, -1, 0)m, facing 90deg\n spot stand, at (0, 1, 0)m\n"
        " grip (0, 0, 5cm)\n solid no\n}"
    )
    assert not report.errors
    assert p.spots == ("top", "stand")
    assert p.movable
    shape = p.shape()
    assert shape.solids == ()
    assert shape.grip == pytest.approx((0, 0, 0.05))
    assert [s.facing for s in shape.spots] == [None, pytest.approx(math.pi / 2), None]
    assert shape.primitives[0].color == pytest.approx(colour("oak"))


def test_a_part_with_no_size_left_is_left_out() -> None:
    p, report = prop("prop p(width 1m) {\n box (width, 1m, 1m)\n box (width - 50cm, 1m, 1m)\n}")
    assert not report.errors
    assert len(p.shape().primitives) == 2
    assert len(p.shape({"width": 0.4}).primitives) == 1


@pytest.mark.parametrize(
    ("line", "code", "suggestion"),
    [
        ("box (1, 1, 1)m, color crimsn", "VDS100", "crimson"),
        ("box (1, 0, 1)m", "VDS101", None),
        ("box (1, 1)m", "VDS032", None),
        ("box (1, 1, 1)", "VDS020", None),
        ("box (1, 1, 1)m, colour red", "VDS030", "color"),
        ("box (1, 1, 1)m, material woood", "VDS026", "wood"),
        ("bx (1, 1, 1)m", "VDS033", "box"),
        ("cylinder 1cm", "VDS029", None),
        ("repeat i 2.5 { box (1, 1, 1)m }", "VDS102", None),
        ("extrude, outline ((0, 0), (1, 0))m, height 1m", "VDS103", None),
        ("lathe, profile ((0, 0, 0), (1, 1, 1))m", "VDS103", None),
        ("cylinder 1cm, height 1m, along up", "VDS104", None),
        ("box (widht, 1m, 1m)", "VDS027", "width"),
        ("box (1m / 0, 1m, 1m)", "VDS028", None),
        ("box (1, 1, 1)m, turn 1m", "VDS021", None),
        ("solid maybe", "VDS026", None),
    ],
)
def test_mistakes_in_a_prop(line: str, code: str, suggestion: str | None) -> None:
    _, report = prop("prop p(width 1m) {\n box (1, 1, 1)m\n " + line + "\n}")
    assert code in codes(report)
    found = next(d for d in report.errors if d.code == code)
    assert found.span.line_number == 3
    if suggestion:
        assert found.suggestion == suggestion


def test_colours() -> None:
    assert colour("#fff") == (1.0, 1.0, 1.0)
    assert colour("#000080") == pytest.approx((0, 0, 128 / 255))
    assert colour("no-colour") is None
    assert colour("#12345") is None
    assert len(COLOURS) > 60
    assert all(colour(word) is not None for word in COLOURS)


# --- sets -------------------------------------------------------------------------------


def test_the_tree_of_names() -> None:
    s, report = a_set(
        "set s {\n time dusk\n room r, size (4, 3, 2.6)m {\n"
        "  door, wall west, at 1m\n  window, wall north, at 2m\n  spot middle, at (2, 1)m\n"
        "  place t = table(width 1m), at (2, 1)m { place c = cup, on top\n spot edge, at (0, 0, 1)m }\n }\n}"
    )
    assert not report.errors
    assert s is not None
    assert s.time == "dusk"
    assert not s.outdoor
    room = find(s.root, ("r",))
    assert (room.kind, room.spots) == ("room", ("middle",))
    assert find(s.root, ("r", "door")).kind == "part"
    table = find(s.root, ("r", "t"))
    assert (table.kind, table.prop, table.spots) == ("object", "table", ("edge",))
    assert find(table, ("c",)).prop == "cup"


def test_repeat_numbers_names() -> None:
    body = "repeat i 3 { place tree = tree, at (i * 2m, 1m) }"
    s, report = a_set("set s {\n area a, size (9, 9)m {\n" + body + "\n }\n}")
    assert not report.errors
    assert s is not None
    assert s.outdoor
    assert [n.name for n in find(s.root, ("a",)).children] == ["tree", "tree_2", "tree_3"]


@pytest.mark.parametrize(
    ("line", "code", "suggestion"),
    [
        ("place t = tabel, at (1, 1)m", "VDS115", "table"),
        ("place t = table(widht 1m), at (1, 1)m", "VDS022", "width"),
        ("place t = table(width -1m), at (1, 1)m", "VDS101", None),
        ("place t = table(width 2), at (1, 1)m", "VDS020", None),
        ("place t = table(color okk), at (1, 1)m", "VDS100", "oak"),
        ("place t = table, at (1, 1)m, trun 90deg", "VDS030", "turn"),
        ("place t = table, at (1, 1)m { place c = cup, on tpo }", "VDS116", "top"),
        ("place t = table, at (1, 1)", "VDS020", None),
        ("place t = table, wall north", "VDS029", None),
        ("place t = table, wall nroth, at 1m", "VDS026", "north"),
        ("door, wall north, at 0.2m", "VDS113", None),
        ("door, wall north, at 2m, height 2.7m", "VDS113", None),
        ("door, wall north, at 2m, to bath", "VDS114", None),
        ("door, at 2m", "VDS029", None),
        ("windw, wall north, at 2m", "VDS033", "window"),
    ],
)
def test_mistakes_in_a_set(line: str, code: str, suggestion: str | None) -> None:
    _, report = a_set(TABLE_ROOM.format(line))
    assert code in codes(report)
    found = next(d for d in report.errors if d.code == code)
    assert found.span.line_number == 3
    if suggestion:
        assert found.suggestion == suggestion


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("set s { }", "VDS111"),
        ("set s {\n room r, floor wood { }\n}", "VDS029"),
        ("set s {\n room r, size (4, -3, 2)m { }\n}", "VDS101"),
        ("set s {\n room r, size (4, 3, 2)m { }\n room r, at (4, 0)m, size (4, 3, 2)m { }\n}", "VDS112"),
        ("set s {\n rom r, size (4, 3, 2)m { }\n}", "VDS033"),
        ("set s {\n time noon\n room r, size (4, 3, 2)m { }\n}", "VDS026"),
        ("set s(width 2m) {\n room r, size (4, 3, 2)m { }\n}", "VDS110"),
        ("set s {\n area a, size (4, 3)m { door, wall west, at 1m }\n}", "VDS033"),
    ],
)
def test_mistakes_in_the_frame_of_a_set(text: str, code: str) -> None:
    _, report = a_set(text)
    assert code in codes(report)


def test_a_door_leads_to_the_room_behind_it() -> None:
    door = "room a, size (4, 3, 2.6)m {{ door, wall {}, at 1.5m, to b }}"
    text = "set s {{\n " + door + "\n room b, at (4, 0)m, size (3, 3, 2.6)m {{ }}\n}}"
    assert not codes(a_set(text.format("east"))[1])
    assert codes(a_set(text.format("west"))[1]) == ["VDS114"]


def test_a_name_taken_twice_shows_the_first() -> None:
    _, report = a_set(TABLE_ROOM.format("place t = table, at (1, 1)m\n place t = chair, at (2, 1)m"))
    found = next(d for d in report.errors if d.code == "VDS112")
    assert found.span.line_number == 4
    assert found.notes[0][0].line_number == 3


# --- the library ------------------------------------------------------------------------


def test_the_library_has_no_mistakes() -> None:
    report = Report()
    catalog = Catalog(report)
    for name in catalog.names("prop"):
        assert isinstance(catalog.get("prop", name), PropDef), name
    for name in catalog.names("set"):
        definition = catalog.get("set", name)
        assert isinstance(definition, SetDef), name
        check_set(definition, catalog, report)
    assert [(d.span, d.label) for d in report.diagnostics] == []
    assert len(catalog.names("prop")) >= 35
    assert {"apartment", "suburb_street", "office"} <= set(catalog.names("set"))


def test_what_stories_count_on() -> None:
    apartment = CATALOG.get("set", "apartment")
    assert isinstance(apartment, SetDef)
    kitchen = find(apartment.root, ("kitchen",))
    for name in ("door", "window", "counter", "table", "chair_1", "chair_2", "fridge", "stove", "sink"):
        find(kitchen, (name,))
    find(kitchen, ("counter", "cup"))
    find(kitchen, ("counter", "coffee_pot"))
    street = CATALOG.get("set", "suburb_street")
    assert isinstance(street, SetDef)
    find(street.root, ("pavement", "bus_stop", "bench"))
    movable = [n for n in CATALOG.names("prop") if getattr(CATALOG.get("prop", n), "movable", False)]
    assert {
        "cup",
        "mug",
        "coffee_pot",
        "bottle",
        "book",
        "phone",
        "plate",
        "bag",
        "laptop",
        "ball",
        "newspaper",
    } <= set(movable)


# --- the reference ----------------------------------------------------------------------

DOCS = Path(__file__).parent.parent / "docs" / "sets.md"


def test_the_reference_lists_all_colours() -> None:
    text = DOCS.read_text(encoding="utf-8")
    for word in COLOURS:
        assert re.search(rf"(?<![\w-]){word}(?![\w-])", text), word


def test_the_examples_of_the_reference_read() -> None:
    blocks = re.findall(r"```vds\n(.*?)```", DOCS.read_text(encoding="utf-8"), re.DOTALL)
    heads = [re.match(r"(prop|set) (\w+)", block) for block in blocks]
    assert [head[1] for head in heads if head].count("set") >= 2
    report = Report()
    for block, head in zip(blocks, heads, strict=True):
        assert head is not None, block
        definition = parse_definition(Source("sets.md", block), head[1], head[2], report)
        assert definition is not None
        found = read_prop(definition, report) if head[1] == "prop" else read_set(definition, report)
        assert found is not None
        if isinstance(found, SetDef):
            check_set(found, CATALOG, report)
    assert not report.diagnostics
