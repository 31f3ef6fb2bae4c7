"""Definitions kept as they were parsed: read back the same, and none the worse for a file that is not one."""

from __future__ import annotations

import hashlib
import os
import pickle
from pathlib import Path

import pytest

from vdsl.lang import kept
from vdsl.lang.ast import Definition
from vdsl.lang.parse import parse_definition
from vdsl.lang.source import Source

STOOL = """# a stool, and what stands on it
prop stool(height 45cm) {
  box (40cm, 40cm, height - 2 * 1cm), at (0, 0, height/2), color oak
  spot seat at (0, 0, height)
}
"""


def stool(folder: Path, text: str = STOOL) -> tuple[Definition | None, Source]:
    source = Source("stool.vds", text)
    found, report = kept.parsed(source, "prop", "stool", 0, len(text), folder)
    assert (found is None) == bool(report.diagnostics)
    return found, source


def no_more(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(kept, "parse_definition", lambda *_: pytest.fail("it was kept"))


def test_a_definition_is_read_back_as_it_was_parsed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    parsed, _ = stool(tmp_path)
    no_more(monkeypatch)
    found, source = stool(tmp_path)
    assert found == parsed
    assert found is not None
    assert found is not parsed
    assert found.span.source is source
    assert found.body[0].values[0].span.source is source


def test_another_text_or_place_is_parsed_anew(tmp_path: Path) -> None:
    stool(tmp_path)
    for text in (STOOL.replace("45", "50"), "\n" + STOOL):
        found, source = stool(tmp_path, text)
        assert found is not None
        assert found.span.source is source
        assert found.span.text.startswith("prop stool")
    assert len(list(tmp_path.iterdir())) == 3


def test_other_code_parses_anew(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    stool(tmp_path)
    monkeypatch.setattr(kept, "_code", lambda: "another")
    stool(tmp_path)
    assert len(list(tmp_path.iterdir())) == 2


def test_what_has_mistakes_is_reported_every_time(tmp_path: Path) -> None:
    wrong = Source("stool.vds", STOOL.replace("40cm, 40cm", "40cm 40cm,,"))
    for _ in range(2):
        _, report = kept.parsed(wrong, "prop", "stool", 0, len(wrong.text), tmp_path / "wrong")
        assert report.diagnostics
    assert not (tmp_path / "wrong").exists()


def sealed(content: bytes) -> bytes:
    return hashlib.sha256(content).digest() + content


@pytest.mark.parametrize("junk", [b"", b"junk", pickle.dumps(None), pickle.dumps([1, 2])])
def test_a_damaged_file_is_passed_over(tmp_path: Path, junk: bytes) -> None:
    parsed, _ = stool(tmp_path)
    (file,) = tmp_path.iterdir()
    whole = file.read_bytes()
    changed = whole.replace(b"oak", b"ash")
    assert changed != whole
    for damaged in (junk, sealed(junk), whole[: len(whole) // 2], changed):
        file.write_bytes(damaged)
        assert stool(tmp_path)[0] == parsed
        assert file.read_bytes() == whole


class Harm:
    def __reduce__(self) -> tuple[object, ...]:
        return os.mkdir, ("harm",)


def test_a_file_runs_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    parsed, _ = stool(tmp_path / "kept")
    (file,) = (tmp_path / "kept").iterdir()
    file.write_bytes(sealed(pickle.dumps(Harm())))
    assert stool(tmp_path / "kept")[0] == parsed
    assert not (tmp_path / "harm").exists()


def test_a_folder_that_refuses_costs_nothing(tmp_path: Path) -> None:
    (tmp_path / "kept").write_text("a file")
    source = Source("stool.vds", STOOL)
    found, _ = stool(tmp_path / "kept")
    report = kept.Report()
    assert found == parse_definition(source, "prop", "stool", report, 0, len(STOOL))


def test_the_longest_unused_go(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(kept, "MOST", 2)
    for k in range(4):
        (tmp_path / f"{k}.bin").write_bytes(b"")
        os.utime(tmp_path / f"{k}.bin", (k, k))
    stool(tmp_path)
    assert {path.name for path in tmp_path.iterdir()} >= {"2.bin", "3.bin"}
    assert len(list(tmp_path.iterdir())) == 3
