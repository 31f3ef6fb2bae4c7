"""Cast definitions: read, checked at their places, dressed, and the people of the library."""

from __future__ import annotations

import numpy as np
import pytest

from runtime.body.build import make_body
from runtime.body.pieces import PARTS
from runtime.body.spec import BodySpec
from vdsl.lang import ast
from vdsl.lang.definitions.cast import CastDef, read_cast
from vdsl.lang.definitions.looks import colour_of
from vdsl.lang.diagnostics import Report
from vdsl.lang.evaluate import evaluate_arguments
from vdsl.lang.parse import parse
from vdsl.lang.source import Source
from vdsl.library.loader import Catalog
from vdsl.stage.cast import body_spec

HEAD = "cast robot(height 1.7m, build thin, hair-color red, top navy)"


def read(text: str) -> tuple[CastDef | None, Report]:
    script, report = parse(Source("<test>", text))
    definition = next(s for s in script.statements if isinstance(s, ast.Definition))
    return read_cast(definition, report), report


def codes(report: Report) -> list[tuple[str, str, str | None]]:
    return [(d.code, d.span.text, d.suggestion) for d in report.errors]


def test_a_cast_member_is_parameters_and_entries() -> None:
    cast, report = read(HEAD + " {\n    body feminine\n    age 40\n    top-kind coat\n    shoes top\n}\n")
    assert not report.errors
    assert cast is not None
    spec = body_spec(cast, {"height": 1.9, "hair-color": "blond"})
    assert (spec.height, spec.femininity, spec.age, spec.top, spec.build) == (1.9, 1.0, 40.0, "coat", 0.1)
    assert spec.shoes_color == spec.top_color == colour_of("navy", "top")
    assert spec.hair_color == colour_of("blond", "hair-color")


def test_parameters_know_their_words() -> None:
    cast, _ = read(HEAD + " {\n}\n")
    assert cast is not None
    choices = {p.name: p.choices for p in cast.parameters}
    assert choices["height"] is None
    assert "thin" in (choices["build"] or ())
    assert "crimson" in (choices["top"] or ())
    assert "#c33a2b" in (choices["top"] or ())
    assert "crimsom" not in (choices["top"] or ())


@pytest.mark.parametrize(
    ("body", "code", "place", "suggestion"),
    [
        ("    tail red", "VDS160", "tail", None),
        ("    haircolor red", "VDS160", "haircolor", "hair-color"),
        ("    skin crimsn", "VDS026", "crimsn", None),
        ("    bottom turqoise", "VDS026", "turqoise", "turquoise"),
        ("    hair bobb", "VDS026", "bobb", "bob"),
        ("    age 400", "VDS161", "400", None),
        ("    build 3", "VDS161", "3", None),
        ("    hair bob\n    hair bun", "VDS023", "hair bun", None),
    ],
)
def test_mistakes_are_reported_at_their_places(
    body: str, code: str, place: str, suggestion: str | None
) -> None:
    cast, report = read(HEAD + " {\n" + body + "\n}\n")
    found = codes(report)
    assert [(c, p) for c, p, _ in found] == [(code, place)]
    if suggestion is not None:
        assert found[0][2] == suggestion
    assert cast is not None
    assert isinstance(body_spec(cast), BodySpec)  # its default stands in


def test_mistakes_in_the_head_are_reported_too() -> None:
    cast, report = read("cast x(height 9m, build fatt, top crimsoon, glasses 3) {\n}\n")
    assert [(c, p) for c, p, _ in codes(report)] == [
        ("VDS161", "9m"),
        ("VDS026", "fatt"),
        ("VDS026", "crimsoon"),
        ("VDS161", "3"),
    ]
    assert cast is not None
    assert body_spec(cast).height == BodySpec().height


def test_a_colour_nobody_knows_is_a_diagnostic_where_a_character_is_made() -> None:
    cast = Catalog().get("cast", "woman")
    assert cast is not None
    script, report = parse(Source("<test>", "character anna = woman(top crimsom, hair bob)\n"))
    line = script.statements[-1]
    assert isinstance(line, ast.CharacterLine)
    assert isinstance(line.cast, ast.Call)
    found = evaluate_arguments(line.cast.arguments, cast.parameters, {}, report, "woman")
    assert codes(report) == [("VDS026", "crimsom", "crimson")]
    assert found == {"hair": "bob"}


def test_the_examples_of_the_language_work() -> None:
    catalog = Catalog()
    woman, man = catalog.get("cast", "woman"), catalog.get("cast", "man")
    assert isinstance(woman, CastDef)
    assert isinstance(man, CastDef)
    anna = body_spec(woman, {"height": 1.68, "hair": "bob", "top": "crimson"})
    ben = body_spec(man, {"build": "heavy", "top": "navy"})
    assert (anna.height, anna.hair, anna.top_color) == (1.68, "bob", colour_of("crimson", "top"))
    assert ben.build > 0.9
    assert anna.femininity > ben.femininity


def test_the_library_has_people_of_different_kinds() -> None:
    report = Report()
    catalog = Catalog(report)
    names = catalog.names("cast")
    assert {"woman", "man", "girl", "boy", "old_man", "old_woman"} <= set(names)
    specs = {}
    for name in names:
        cast = catalog.get("cast", name)
        assert isinstance(cast, CastDef)
        specs[name] = body_spec(cast)
    assert not report.errors
    assert len({s.key() for s in specs.values()}) == len(specs)
    assert specs["girl"].youth > 0.9
    assert specs["old_man"].eld > 0.9
    assert max(s.height for s in specs.values()) - min(s.height for s in specs.values()) > 0.4


def test_the_library_has_people_of_many_kinds_who_can_wear_anything() -> None:
    catalog = Catalog()
    names = set(catalog.names("cast"))
    assert len(names) >= 40
    assert {
        *(
            "police_officer",
            "doctor",
            "nurse",
            "chef",
            "waiter",
            "soldier",
            "knight",
            "astronaut",
            "firefighter",
        ),
        *(
            "builder",
            "judge",
            "priest",
            "nun",
            "king",
            "queen",
            "princess",
            "pirate",
            "wizard",
            "farmer",
            "toddler",
        ),
    } <= names
    casts = [c for c in (catalog.get("cast", n) for n in sorted(names)) if isinstance(c, CastDef)]
    specs = [body_spec(c) for c in casts]
    assert {s.femininity >= 0.5 for s in specs} == {True, False}
    assert len({s.skin for s in specs}) >= 8
    assert len({s.hat for s in specs}) >= 12
    assert len({s.top for s in specs}) >= 18
    for cast in casts:
        dressed = body_spec(cast, {"hat": "cap", "neck": "scarf", "accent": "gold"})
        assert (dressed.hat, dressed.neck, dressed.accent_color) == (
            "cap",
            "scarf",
            colour_of("gold", "accent"),
        )


def test_a_feature_may_have_the_name_of_a_word() -> None:
    """`shirt` is a kind of top and the colour under a jacket: the word is not taken for the parameter."""
    cast, report = read("cast x(height 1.7m) {\n    top-kind shirt\n    shirt cream\n    belt yes\n}\n")
    assert not report.errors
    assert cast is not None
    assert body_spec(cast).top == "shirt"
    assert body_spec(cast).belt


@pytest.mark.parametrize("name", Catalog().names("cast"))
def test_everybody_in_the_library_builds(name: str) -> None:
    cast = Catalog().get("cast", name)
    assert isinstance(cast, CastDef)
    body = make_body(body_spec(cast))
    assert 5_000 <= len(body.mesh.faces) <= 13_000
    assert np.allclose(body.weights.sum(1), 1.0, atol=1e-5)
    low, high = body.mesh.vertices.min(0), body.mesh.vertices.max(0)
    assert -0.02 < low[2] < 0.02
    assert body.spec.height - 0.03 < high[2] < 1.22 * body.spec.height
    assert body.mesh.parts.max() < len(PARTS)
