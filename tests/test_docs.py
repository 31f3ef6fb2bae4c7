"""The documentation holds: links lead somewhere, and samples that are whole storyboards check."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from vdsl.lang import Report, Source, check, parse
from vdsl.lang.diagnostics import Diagnostic
from vdsl.library import Catalog

ROOT = Path(__file__).resolve().parents[1]
PAGES = (ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md")))
_LINK = re.compile(r"\]\(([^)\s]+)\)")
_SAMPLE = re.compile(r"^```vds\n(.*?)^```", re.MULTILINE | re.DOTALL)


def _samples() -> list[tuple[str, str]]:
    """(page and number, text) of every sample that is a storyboard or definitions, not a line or two."""
    found = []
    for page in PAGES:
        if page.name == "your-own.md":  # pieces of one file: test_your_own.py holds them together
            continue
        if page.name == "import.md":  # needs files beside it: formats/test_imports.py makes them
            continue
        for number, match in enumerate(_SAMPLE.finditer(page.read_text(encoding="utf-8")), start=1):
            text = match.group(1)
            if re.search(r"^(scene|set|prop|cast|action) ", text, re.MULTILINE):
                found.append((f"{page.name} {number}", text))
    return found


def _errors(name: str, text: str) -> tuple[Diagnostic, ...]:
    report = Report()
    script, _ = parse(Source(f"{name}.vds", text), report)
    check(script, Catalog.for_script(script, report), report)
    return report.errors


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_relative_links_lead_to_files(page: Path) -> None:
    links = [link.partition("#")[0] for link in _LINK.findall(page.read_text(encoding="utf-8"))]
    missing = [link for link in links if link and "://" not in link and not (page.parent / link).exists()]
    assert not missing


def test_there_are_samples() -> None:
    assert len(_samples()) >= 8


@pytest.mark.parametrize(("name", "text"), _samples(), ids=[name for name, _ in _samples()])
def test_samples_check(name: str, text: str) -> None:
    assert [f"line {e.span.line_number}: {e.label}" for e in _errors(name, text)] == []


def test_the_mistake_in_the_readme_is_told_as_it_says() -> None:
    from vdsl.cli.show import as_text

    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    (shown,) = re.findall(r"^```text\n(error\[.*?)^```", readme, re.MULTILINE | re.DOTALL)
    story = next(text for name, text in _samples() if name == "README.md 1")
    assert as_text(_errors("hello", story.replace("anna walk", "anna wlk"))) == shown.rstrip("\n")


def test_the_front_page_counts_what_the_library_has() -> None:
    catalog = Catalog()
    said = re.findall(r"\[(\d+) \w+\]\(docs/library/(\w+)\.md\)", (ROOT / "README.md").read_text("utf-8"))
    kinds = {"sets": "set", "props": "prop", "cast": "cast", "actions": "action"}
    assert {page: int(number) for number, page in said} == {
        page: len(catalog.names(kind)) for page, kind in kinds.items()
    }
