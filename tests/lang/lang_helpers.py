"""What the tests of the language share."""

from __future__ import annotations

from small_catalog import SmallCatalog

from vdsl.lang import Report, Settings, Source, Storyboard, check, parse

HEAD = """\
character anna = woman
character ben = man
scene kitchen = apartment.kitchen
anna at door
ben at chair_2 sitting
"""


def checked(text: str, overrides: Settings | None = None) -> tuple[Storyboard | None, Report]:
    script, report = parse(Source("story.vds", text))
    return check(script, SmallCatalog(), report, overrides), report


def board(text: str, overrides: Settings | None = None) -> Storyboard:
    """The storyboard of a script that has no mistakes."""
    storyboard, report = checked(text, overrides)
    assert not report.errors, [(d.code, d.label) for d in report.errors]
    assert storyboard is not None
    return storyboard


def codes(text: str) -> list[str]:
    return [d.code for d in checked(text)[1].diagnostics]
