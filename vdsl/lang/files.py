"""Reading script files: decoding, ``use``, and staying inside the project's folder.

A file that cannot be read by the machine raises :class:`OSError` for the caller to turn into exit
code 3; one whose contents are no text is a diagnostic.
"""

from __future__ import annotations

from pathlib import Path

from . import ast
from .diagnostics import Report
from .parse import parse
from .source import Source, Span

#: Larger scripts are refused; a feature film's is a hundredth of this.
LARGEST_FILE = 32 * 1024 * 1024


def read_source(path: Path, report: Report, shown: str | None = None) -> Source | None:
    """The text of a file, or None where it is no UTF-8 text (which is then in the report)."""
    with path.open("rb") as file:
        data = file.read(LARGEST_FILE + 1)
    name = str(path) if shown is None else shown
    empty = Source(name, "")
    if len(data) > LARGEST_FILE:
        report.error(
            "VDS014",
            Span(empty, 0, 0),
            label="this file is larger than 32 MiB",
            help="is it a script at all?",
        )
        return None
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        report.error(
            "VDS014",
            Span(empty, 0, 0),
            label=f"byte {error.start} (line {line}) is not UTF-8 text",
            help="save the script as UTF-8"
            if b"\0" not in data
            else "this looks like a binary file, not a script",
        )
        return None
    if "\0" in text:
        report.error("VDS014", Span(empty, 0, 0), label="this looks like a binary file, not a script")
        return None
    return Source(name, text)


def used_scripts(script: ast.Script, report: Report) -> tuple[ast.Script, ...]:
    """The scripts this one uses, and those they use, each once, in the order first named."""
    if not any(isinstance(s, ast.Use) for s in script.statements):
        return ()
    main = Path(script.source.name)
    folder = main.parent.resolve()
    seen = {main.resolve()}
    found: list[ast.Script] = []
    waiting = [(script, folder)]
    while waiting:
        current, base = waiting.pop(0)
        for statement in current.statements:
            if not isinstance(statement, ast.Use):
                continue
            path = inside_folder(statement.path, base, folder, "VDS016", report)
            if path is None or path in seen:
                continue
            seen.add(path)
            used = _read_used(path, statement.path, folder, main.parent, report)
            if used is not None:
                found.append(used)
                waiting.append((used, path.parent))
    return tuple(found)


def inside_folder(written: ast.Text, base: Path, folder: Path, code: str, report: Report) -> Path | None:
    """The path that is written, seen from ``base``, if it stays inside the project's folder (resolved).

    code: of what is said about a path that is none
    """
    try:
        path = (base / written.value).resolve()
        inside = path.is_relative_to(folder) and not Path(written.value).is_absolute()
    except (OSError, ValueError, RuntimeError):
        report.error(code, written.span, label="this is no usable path")
        return None
    if not inside:
        report.error(
            "VDS015",
            written.span,
            label="this path leaves the project's folder",
            help=f"files are looked for inside {folder}",
        )
        return None
    return path


def _read_used(path: Path, written: ast.Text, folder: Path, shown: Path, report: Report) -> ast.Script | None:
    name = str(shown / path.relative_to(folder))
    try:
        source = read_source(path, report, name)
    except OSError as error:
        near = sorted(p.name for p in path.parent.glob("*.vds"))[:8] if path.parent.is_dir() else []
        report.error(
            "VDS016",
            written.span,
            label=f"this file cannot be read: {error.strerror or error}",
            help=f"the folder has {', '.join(near)}" if near else None,
        )
        return None
    return None if source is None else parse(source, report)[0]
