"""The grammar of VDS: ``vds.lark`` and the LALR parser made from it.

Building the tables takes a moment, so they are kept in the user's cache folder, under a name made
from the grammar and the versions of everything that reads them. A cache that is missing, foreign or
broken is built anew; one that cannot be written is done without.
"""

from __future__ import annotations

import hashlib
import os
import sys
import tempfile
from collections.abc import Callable
from functools import lru_cache
from pathlib import Path
from typing import BinaryIO

import lark

GRAMMAR_FILE = Path(__file__).with_name("vds.lark")

#: One start rule for each kind of logical line.
STARTS = (
    "storyboard",
    "header",
    "use",
    "character",
    "scene",
    "placement",
    "transition",
    "story",
    "cameras",
    "definition_head",
    "definition_file",
    "entry",
)


def build_parser() -> lark.Lark:
    """The parser, made from the grammar file without looking at any cache."""
    return lark.Lark(
        GRAMMAR_FILE.read_text(encoding="utf-8"),
        parser="lalr",
        lexer="contextual",
        start=list(STARTS),
        propagate_positions=True,
        maybe_placeholders=False,
        keep_all_tokens=False,
    )


@lru_cache(maxsize=1)
def parser() -> lark.Lark:
    """The parser, from the cache where there is one."""
    path = _cache_path()
    try:
        with path.open("rb") as file:
            return lark.Lark.load(file)
    except Exception:  # whatever is wrong with a cache, the grammar itself is at hand
        built = build_parser()
    keep(path, built.save)
    return built


def cache_folder() -> Path:
    """The user's folder for what is kept between runs."""
    # platformdirs is not asked: its import costs more than the parser's, and this is all it would say
    if base := os.environ.get("VDSL_CACHE"):
        return Path(base)
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA", tempfile.gettempdir())) / "vdsl" / "Cache"
    if sys.platform == "darwin":
        return Path("~/Library/Caches/vdsl").expanduser()
    return Path(os.environ.get("XDG_CACHE_HOME") or "~/.cache").expanduser() / "vdsl"


def _cache_path() -> Path:
    key = hashlib.sha256(GRAMMAR_FILE.read_bytes())
    key.update(f"{lark.__version__} {sys.version} {STARTS}".encode())
    return cache_folder() / f"grammar-{key.hexdigest()[:16]}.bin"


def keep(path: Path, save: Callable[[BinaryIO], object]) -> None:
    """Write a file of the cache by ``save``, in one step; a cache that cannot be written is no error."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(dir=path.parent)
        try:
            with os.fdopen(handle, "wb") as file:
                save(file)
            os.replace(name, path)
        except BaseException:
            os.unlink(name)
            raise
    except OSError:
        return
