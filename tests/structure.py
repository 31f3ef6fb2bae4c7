"""The lists of files in docs/structure.md, made of what modules say of themselves.

``python tests/structure.py`` writes them anew after a module came, went or changed its first sentence.
"""

from __future__ import annotations

import ast
import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "structure.md"
HEADING = "## Every file\n"
PACKAGES = ("grammar", "runtime", "ranker", "vdsl")
#: Files that are no modules.
OTHERS = {
    "grammar/vds.lark": "The grammar.",
    "vdsl/emit/templates/page.html.j2": "The page: its head, its parts in order, the viewing room.",
    "vdsl/emit/templates/shot.html.j2": "One panel of the board.",
    "vdsl/emit/templates/library.html.j2": "Served: what there is to write with.",
    "vdsl/emit/templates/stage.html.j2": "Served: the scenes as they are placed.",
    "vdsl/emit/templates/base.css": "Colours, type and plain elements of every page.",
    "vdsl/emit/templates/page.css": "How the page is laid out.",
    "vdsl/emit/templates/print.css": "The page on paper.",
    "vdsl/emit/templates/theme.js": "Light and dark.",
    "vdsl/emit/templates/viewer.js": "The viewing room: a take frame by frame.",
    "vdsl/emit/templates/board.js": "The board: playing, takes, finding, keys.",
    "vdsl/emit/templates/live.js": "Served: choosing, and going along with what is compiled.",
    "vdsl/emit/templates/library.js": "Served: finding in the library, drawing on demand.",
}


def about(path: Path) -> str:
    """The first sentence of a module's docstring, as Markdown; "" where it has none."""
    said = ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or ""
    paragraph = " ".join(said.split("\n\n")[0].split())
    sentence = re.split(r"(?<=\.)\s", paragraph)[0]
    sentence = re.sub(r":\w+:`(?:~[\w.]*\.|\.)?([\w.]+)`", r"`\1`", sentence)
    return sentence.replace("``", "`").replace("|", "\\|")


def lists() -> str:
    """Everything below :data:`HEADING`: a table a folder; modules that are empty are left out."""
    found: dict[str, dict[str, str]] = {}
    for package in PACKAGES:
        for path in (ROOT / package).rglob("*.py"):
            if path.stat().st_size:
                folder = path.parent.relative_to(ROOT).as_posix()
                found.setdefault(folder, {})[path.name] = about(path)
    for name, words in OTHERS.items():
        folder, _, file = name.rpartition("/")
        found.setdefault(folder, {})[file] = words
    parts = []
    for folder, files in sorted(
        found.items(), key=lambda row: (PACKAGES.index(row[0].split("/")[0]), row[0])
    ):
        rows = "".join(f"| `{file}` | {words} |\n" for file, words in sorted(files.items()))
        parts.append(f"\n**`{folder}/`**\n\n| file | is |\n|---|---|\n{rows}")
    return "".join(parts)


if __name__ == "__main__":
    head, heading, _ = PAGE.read_text(encoding="utf-8").partition(HEADING)
    PAGE.write_text(head + heading + lists(), encoding="utf-8")
