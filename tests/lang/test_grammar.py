"""The grammar's parser: cached on disk, and none the worse for a cache that is broken or cannot be."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

import grammar


@pytest.fixture
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    monkeypatch.setenv("VDSL_CACHE", str(tmp_path / "cache"))
    grammar.parser.cache_clear()
    yield tmp_path / "cache"
    grammar.parser.cache_clear()


def works() -> bool:
    grammar.parser.cache_clear()
    return grammar.parser().parse("(anna walk door) / (static)", start="story").data == "story"


def test_the_parser_is_kept_and_read_again(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert works()
    (kept,) = cache.iterdir()
    assert kept.stat().st_size > 1000
    monkeypatch.setattr(grammar, "build_parser", lambda: pytest.fail("it was kept"))
    assert works()


@pytest.mark.parametrize("junk", [b"", b"junk", b"\x80\x04N.", b"\x80\x04}\x94."])
def test_a_broken_cache_is_made_anew(cache: Path, junk: bytes) -> None:
    assert works()
    (kept,) = cache.iterdir()
    kept.write_bytes(junk)
    assert works()
    assert len(kept.read_bytes()) > 1000


def test_a_cache_that_cannot_be_written_is_done_without(cache: Path) -> None:
    cache.write_text("a file where the folder should be")
    assert works()


def test_every_start_is_a_rule_of_the_grammar() -> None:
    text = grammar.GRAMMAR_FILE.read_text(encoding="utf-8")
    assert all(f"\n{start} " in text for start in grammar.STARTS)
