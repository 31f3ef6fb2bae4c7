"""Definitions as they were parsed, kept on disk between runs: reading them takes about a third of the time.

For the library's, of which a script names a few dozen and a training set asks for all. Assumes that the same
text is parsed the same way by the same code. Guarantees that a file that is damaged, foreign or of other code
is passed over, that reading one calls nothing but the classes of the syntax tree, that two who write at once
do not harm each other, and that a disk that refuses costs time alone.
"""

from __future__ import annotations

import copyreg
import hashlib
import io
import pickle
import sys
from collections.abc import Callable
from contextlib import suppress
from functools import lru_cache
from pathlib import Path
from typing import Any

import lark

import grammar

from . import ast, source
from .diagnostics import Report
from .parse import parse_definition
from .source import Source

#: So many are kept; the longest unused go first.
MOST = 4096
#: What parses, besides the grammar.
_CODE = ("ast.py", "build.py", "layout.py", "parse.py", "source.py")
_DIGEST = hashlib.sha256().digest_size
_pruned: set[Path] = set()


def parsed(
    text: Source, kind: str, name: str, start: int, end: int, folder: Path | None = None
) -> tuple[ast.Definition | None, Report]:
    """A definition as :func:`vdsl.lang.parse.parse_definition` finds it between two offsets, from disk where
    it was parsed before; and what was wrong with it, of which nothing is kept.

    folder: to keep it in; None for the user's own
    """
    report = Report()
    if (code := _code()) is None:
        return parse_definition(text, kind, name, report, start, end), report
    key = hashlib.sha256(f"{code}\0{kind}\0{name}\0{start}\0{text.text[start:end]}".encode())
    path = (folder or grammar.cache_folder() / "definitions") / f"{key.hexdigest()[:32]}.bin"
    found = _read(path, text)
    if found is None:
        found = parse_definition(text, kind, name, report, start, end)
        if found is not None and not report.diagnostics:
            _write(path, found)
    return found, report


@lru_cache(maxsize=1)
def _code() -> str | None:
    """A digest of what parses; None where that is not in files."""
    told = hashlib.sha256(f"{sys.version} {lark.__version__}".encode())
    own = (Path(__file__).with_name(name) for name in _CODE)
    for file in (grammar.GRAMMAR_FILE, Path(grammar.__file__), *own):
        if not file.is_file():
            return None
        told.update(file.read_bytes())
    return told.hexdigest()


# --- files --------------------------------------------------------------------------------------------------


def _here() -> Source:
    """In a file, the text it is of."""
    raise pickle.UnpicklingError("a definition without its text")


class _Reader(pickle.Unpickler):
    """Makes nodes of a syntax tree over a text, and nothing else."""

    def __init__(self, file: io.BytesIO, text: Source) -> None:
        super().__init__(file)
        self._text = text

    def find_class(self, module: str, name: str) -> Callable[..., Any]:
        if (module, name) == (__name__, _here.__name__):
            return lambda: self._text
        known = {ast.__name__: ast, source.__name__: source}.get(module)
        found = getattr(known, name, None)
        if not isinstance(found, type) or found.__module__ != module:
            raise pickle.UnpicklingError(f"{module}.{name} is no node of a syntax tree")
        return found


def _read(path: Path, text: Source) -> ast.Definition | None:
    try:
        told = path.read_bytes()
        packed = told[_DIGEST:]
        if hashlib.sha256(packed).digest() != told[:_DIGEST]:
            return None
        found = _Reader(io.BytesIO(packed), text).load()
    except Exception:  # whatever is wrong with a file, the text itself is at hand
        return None
    return found if isinstance(found, ast.Definition) else None


def _write(path: Path, definition: ast.Definition) -> None:
    packed = io.BytesIO()
    writer = pickle.Pickler(packed, pickle.HIGHEST_PROTOCOL)
    writer.dispatch_table = {**copyreg.dispatch_table, Source: lambda _: (_here, ())}
    with suppress(RecursionError):
        writer.dump(definition)
        content = packed.getvalue()
        _prune(path.parent)
        grammar.keep(path, lambda file: file.write(hashlib.sha256(content).digest() + content))


def _prune(folder: Path) -> None:
    """Once in a process, remove what is too much, finished or not."""
    if folder in _pruned:
        return
    _pruned.add(folder)
    with suppress(OSError):  # another may be at it too
        kept = sorted(folder.glob("*"), key=lambda p: p.stat().st_atime)
        for old in kept[: max(len(kept) - MOST, 0)]:
            old.unlink(missing_ok=True)
