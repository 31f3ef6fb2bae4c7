"""``vdsc assets styles``: movement, size, angle and view put together, what each means and what varies."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from ..lang.diagnostics import nearest
from .check import USAGE, stop

if TYPE_CHECKING:
    from ..cinema.styles import Style

SCHEMA = "vds.styles/1"


def list_styles(name: str, search: str, json_out: bool, preview: Path | None, device: str) -> None:
    """List the styles in which all words of ``search`` occur, or show the one of that name, or draw them."""
    found = _named(name) if name else _searched(search)
    if preview is not None:
        _draw(found, preview, device)
    elif json_out:
        document = {"schema": SCHEMA, "styles": [_plain(style) for style in found]}
        print(json.dumps(document, ensure_ascii=False, indent=2))
    elif name:
        for head, text in (("as in", found[0].line), ("means", found[0].means)):
            print(f"{head:6} {text}")
        for number, text in enumerate(found[0].varies):
            print(f"{'' if number else 'varies':6} {text}")
    else:
        _print_table(found)
        print(f"{len(found)} styles; `vdsc assets styles NAME` shows one in full")


def first_words(search: str) -> tuple[int, str]:
    """How many there are, and some of them, for the overview."""
    found = _searched(search)
    return len(found), ", ".join(style.words for style in found[:3]) + (" …" if len(found) > 3 else "")


def _searched(search: str) -> list[Style]:
    from ..cinema.styles import styles

    words = search.casefold().split()
    return [s for s in styles() if all(w in f"{s.name} {s.words} {s.means}".casefold() for w in words)]


def _named(name: str) -> list[Style]:
    from ..cinema.styles import styles

    known = {_folded(style.name): style for style in styles()}
    style = known.get(_folded(name))
    if style is None:
        meant = nearest(_folded(name), known)
        hint = f"; did you mean `{known[meant].name}`?" if meant else ""
        stop(f"there is no style `{name}`{hint} (`vdsc assets styles` lists them)", USAGE)
    return [style]


def _folded(name: str) -> str:
    """A name, or its words as in a line, whatever joins them."""
    return name.casefold().translate(str.maketrans("_ ", "--", "()/"))


def _plain(style: Style) -> dict[str, object]:
    return {
        "name": style.name,
        "words": style.words,
        "movement": style.movement,
        "size": style.size,
        "angle": style.angle or None,
        "view": style.view or None,
        "option": style.option or None,
        "group": style.group,
        "means": style.means,
        "varies": list(style.varies),
        "line": style.line,
    }


def _print_table(found: list[Style]) -> None:
    from rich.console import Console
    from rich.table import Table

    table = Table(box=None, pad_edge=False, header_style="bold")
    for head in ("style", "means"):
        table.add_column(head, no_wrap=head == "style", overflow="fold")
    for style in found:
        table.add_row(style.words, style.means)
    Console(width=None if sys.stdout.isatty() else 400).print(table)


def _draw(found: list[Style], out: Path, device: str) -> None:
    from .failures import failures_told

    if not found:
        stop("nothing to draw", USAGE)
    with failures_told(out):
        from ..pipeline.catalogue import Catalogue

        Catalogue(device).sheet(found).save(out)
    print(out)
