"""Every row of the table of malformed lines, told by its own example."""

from __future__ import annotations

import pytest

from vdsl.lang import Source, parse
from vdsl.lang.syntax_errors import FORMS, RULES, Rule


def _script(rule: Rule) -> str:
    """The example as a line of its kind."""
    if "entry" in rule.starts:
        return f"prop p {{\n{rule.example}\n}}\n"
    if "definition_head" in rule.starts:
        return f"{rule.example} {{\n}}\n"
    return rule.example + "\n"


@pytest.mark.parametrize("rule", RULES, ids=[rule.example for rule in RULES])
def test_example_gets_its_own_message(rule: Rule) -> None:
    _, report = parse(Source("x.vds", _script(rule)))
    found = [(d.code, d.label, d.span.text) for d in report.diagnostics]
    assert found == [("VDS001", rule.label, rule.marked)]


@pytest.mark.parametrize("start", sorted(FORMS))
def test_the_form_shown_as_right_is_right(start: str) -> None:
    form = FORMS[start].split(", size")[0].split(" or ")[0].split(", dissolve")[0].replace("…", "")
    form = f"prop p {{\n{form}\n}}" if start == "entry" else form
    script, report = parse(Source("x.vds", form + "\n"))
    assert not report.diagnostics
    assert len(script.statements) == 1


def test_a_name_alone_is_told_what_to_say_of_it() -> None:
    _, report = parse(Source("x.vds", "anna\nanna walk door\n"))
    alone, acts = report.diagnostics
    assert alone.code == acts.code == "VDS013"
    assert alone.span.text == "anna"
    assert "`anna at door`" in (alone.help or "")
    assert acts.fix == "(anna walk door)"


@pytest.mark.parametrize(
    ("line", "meant"),
    [
        ('anna: "What a night."', '(anna talk) say "What a night."'),
        ("anna: What a night.", '(anna talk) say "What a night."'),
        ('anna "What a night."', '(anna talk) say "What a night."'),
        ("INT. KITCHEN - NIGHT", None),
        ('"What a night."', None),
        ("Title: Rain", 'storyboard "Rain"'),
        ("Author: J. Doe", "# Author: J. Doe"),
    ],
)
def test_who_writes_a_screenplay_is_told_how_it_is_said_here(line: str, meant: str | None) -> None:
    _, report = parse(Source("x.vds", line + "\n"))
    (found,) = report.diagnostics
    assert (found.code, found.fix) == ("VDS013", meant)
    shown = {"INT.": "`scene kitchen", "Title:": "`storyboard", "Author:": "comment"}
    assert shown.get(line.split()[0], ") say") in (found.help or "")
    if meant:
        _, report = parse(Source("x.vds", meant + "\n"))
        assert not report.diagnostics
