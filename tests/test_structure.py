"""docs/structure.md lists every module, by the first sentence the module says of itself."""

from __future__ import annotations

import re

import pytest
from structure import HEADING, OTHERS, PACKAGES, PAGE, ROOT, about, lists

MODULES = [p for package in PACKAGES for p in sorted((ROOT / package).rglob("*.py")) if p.stat().st_size]


@pytest.mark.parametrize("path", MODULES, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_a_module_says_what_it_is(path):
    assert about(path).endswith("."), "a module begins with a sentence about itself"


def test_every_module_is_listed_as_it_says():
    listed = PAGE.read_text(encoding="utf-8").partition(HEADING)[2].splitlines()
    made = lists().splitlines()
    wrong = [row for row in made if row not in listed] + [row for row in listed if row not in made]
    assert not wrong, "python tests/structure.py writes the lists anew"
    assert listed == made


def test_files_that_are_named_are_there():
    """Paths in the other tables: whole ones, and names beside the path before them."""
    text = PAGE.read_text(encoding="utf-8").partition(HEADING)[0]
    whole = re.findall(r"`((?:grammar|runtime|ranker|vdsl|tests)/[\w/.*-]*)`", text)
    assert len(whole) > 25
    missing = [name for name in (*whole, *OTHERS) if not list(ROOT.glob(name))]
    assert not missing
