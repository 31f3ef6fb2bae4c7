# ruff: noqa: E501 (lists of words)
"""The reference in ``docs``: its scripts read, and it names every word there is."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

import pytest
from lang_helpers import HEAD

from runtime.materials import MATERIALS
from runtime.motion.words import BODY_PLACES, GAZES, HANDS
from vdsl.lang import Report, Source, ast, check, ir, parse, words
from vdsl.lang.definitions.looks import FEATURES
from vdsl.lang.definitions.prop import ENTRIES
from vdsl.lang.definitions.set import ROOM_ENTRIES, SET_ENTRIES
from vdsl.lang.definitions.timeline import CENTRE, SIDED
from vdsl.lang.options import _READERS as OPTIONS
from vdsl.lang.parse import STATEMENTS
from vdsl.library import Catalog
from vdsl.pipeline.reference import pages

DOCS = Path(__file__).parents[2] / "docs"
PAGES = ("language.md", "sets.md", "cast.md", "actions.md")
TEXT = "\n".join((DOCS / page).read_text(encoding="utf-8") for page in PAGES if (DOCS / page).exists())
SAMPLES = re.findall(r"```vds\n(.*?)```", TEXT, re.DOTALL)
EXTRA = "character carl = man\ncharacter zoe = woman\n"


@pytest.mark.parametrize("sample", SAMPLES, ids=[s.split("\n")[0] for s in SAMPLES])
def test_samples_have_no_mistakes(sample: str) -> None:
    report = Report()
    script, _ = parse(Source("sample.vds", sample), report)
    Catalog.for_script(script, report)
    assert script.statements
    if any(isinstance(s, ast.SceneLine) for s in script.statements):
        check(script, Catalog.for_script(script, report), report)
    assert not report.errors, [(d.code, d.label, d.span.text) for d in report.errors]


@pytest.mark.parametrize(
    "listed",
    [STATEMENTS, OPTIONS, ir.SCALES, ir.ANGLES, ir.MOVEMENTS, words.EASES.keys() - {"ease-in", "ease-out"}, words.SPEEDS, words.STYLES, words.TIMES,
     words.RIGS, ENTRIES, MATERIALS, SET_ENTRIES, ROOM_ENTRIES, FEATURES, CENTRE, SIDED, HANDS, GAZES, BODY_PLACES],
)  # fmt: skip
def test_every_word_is_in_the_reference(listed: object) -> None:
    assert isinstance(listed, dict | tuple | set)
    missing = [
        w for w in listed if w != "duration" and not re.search(rf"(?<![\w-]){re.escape(w)}(?![\w-])", TEXT)
    ]
    assert not missing


@cache
def made_pages() -> dict[str, str]:
    return pages(Catalog())


@pytest.mark.parametrize("page", ["sets.md", "props.md", "cast.md", "actions.md"])
def test_the_librarys_pages_are_made_of_it(page: str) -> None:
    """`make reference` brings them up to date."""
    assert (DOCS / "library" / page).read_text(encoding="utf-8") == made_pages()[page]


def test_the_library_reads_without_a_finding() -> None:
    report = Report()
    catalog = Catalog(report)
    for kind in ("set", "prop", "cast", "action"):
        assert len(catalog.names(kind)) >= {"set": 24, "prop": 90, "cast": 24, "action": 130}[kind]
        for name in catalog.names(kind):
            definition = catalog.get(kind, name)
            assert definition is not None
            assert definition.name == name
    assert not report.diagnostics, [(d.code, str(d.span), d.label) for d in report.diagnostics]


def test_own_definitions_come_before_the_librarys() -> None:
    report = Report()
    script, _ = parse(
        Source("x.vds", "prop cup { box (1, 1, 1)m\n spot mine, at (0, 0, 0) }\n" + HEAD + EXTRA), report
    )
    catalog = Catalog.for_script(script, report)
    assert getattr(catalog.get("prop", "cup"), "spots", None) == ("mine",)
    assert catalog.names("prop").count("cup") == 1
    source = catalog.source_of("prop", "cup")
    assert source is not None
    assert source.name == "x.vds"


def test_a_sets_unknown_props_are_found_in_the_script_itself() -> None:
    report = Report()
    text = "set home { room k, at (0, 0)m, size (4, 3, 2.6)m { place t = tabel, at (1, 1)m } }\n"
    Catalog.for_script(parse(Source("x.vds", text), report)[0], report)
    assert [(d.code, d.span.text, d.suggestion) for d in report.diagnostics] == [("VDS115", "tabel", "table")]
