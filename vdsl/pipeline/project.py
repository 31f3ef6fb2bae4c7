"""``vds.toml``: settings for all the storyboards beside it and below.

    size = "1280x720"          # as the header lines of a storyboard, which win over it
    takes = 5

    [compile]
    rank = "discriminator"     # as the options of vdsc compile, which win over it

Assumes nothing of the file. Guarantees settings that header lines could say, and options that the command
line could; anything else is an error at its place.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ..lang import Report, Settings, Source, Span, ast, parse
from ..lang.diagnostics import listing, nearest
from ..lang.settings import read_header
from .script import ScriptError

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

NAME = "vds.toml"
SETTINGS = ("fps", "size", "aspect", "seed", "rig", "style", "takes", "proposals", "aperture")
#: What ``[compile]`` may say: a list of words, yes and no, or degrees.
COMPILE: Mapping[str, tuple[str, ...] | type] = {
    "device": ("auto", "cpu", "cuda", "vulkan"),
    "rank": ("discriminator", "geometry"),
    "edit": bool,
    "burn-in": bool,
    "arrows": bool,
    "shutter": float,
}
_PLACE = re.compile(r"\(at line (\d+), column (\d+)\)")


@dataclass(frozen=True, eq=False)
class Project:
    """What a project says. settings: in place of header lines; compile: {option: value}; path: the file's"""

    settings: Settings = field(default_factory=Settings)
    compile: Mapping[str, Any] = field(default_factory=dict)
    path: Path | None = None


def project_of(script: Path) -> Project:
    """The nearest ``vds.toml`` beside a script or above it; an empty project where there is none.

    Raises :class:`ScriptError` for one that does not read, OSError where it cannot be opened.
    """
    folder = script.parent.absolute()
    for place in (folder, *folder.parents):
        path = place / NAME
        if path.is_file():
            return _read(path)
        if (place / ".git").exists():
            break
    return Project()


def _read(path: Path) -> Project:
    report = Report()
    shown = path.name if path.parent == Path.cwd() else str(path)
    source = Source(shown, path.read_bytes().decode("utf-8", "replace").replace("\r\n", "\n"))
    try:
        document = tomllib.loads(source.text)
    except tomllib.TOMLDecodeError as error:
        found = _PLACE.search(str(error))
        line = int(found[1]) - 1 if found else 0
        start = source.line_starts[min(line, len(source.line_starts) - 1)] + (
            int(found[2]) - 1 if found else 0
        )
        label = _PLACE.sub("", str(error)).strip()
        report.error("VDS313", Span(source, start, start + 1), label=label, help="this is no TOML")
        raise ScriptError(report) from None
    settings = _settings(document, source, report)
    compile = _compile(document.get("compile", {}), source, report)
    if report.has_errors:
        raise ScriptError(report)
    return Project(settings, compile, path)


def _settings(document: Mapping[str, Any], source: Source, report: Report) -> Settings:
    settings = Settings()
    for name, value in document.items():
        if name == "compile":
            continue
        if name not in SETTINGS:
            _unknown(name, (*SETTINGS, "compile"), source, report)
            continue
        heard = Report()
        script, _ = parse(Source(NAME, f"{name} {value}\n"), heard)
        if len(script.statements) == 1 and not isinstance(value, bool | list | dict):
            line = script.statements[0]
            if isinstance(line, ast.Header):
                read_header(line, settings, heard)
        if heard.has_errors or getattr(settings, name) is None:
            first = heard.errors[0] if heard.errors else None
            help = (first.help or first.label) if first else f"as the header line `{name}` of a storyboard"
            report.error("VDS313", _at(name, source), label=f"`{name}` cannot be this", help=help)
    return settings


def _compile(told: Any, source: Source, report: Report) -> dict[str, Any]:
    if not isinstance(told, dict):
        report.error("VDS313", _at("compile", source), label="`compile` is a table", help="write `[compile]`")
        return {}
    for name, value in told.items():
        allowed = COMPILE.get(name)
        if allowed is None:
            _unknown(name, tuple(COMPILE), source, report)
        elif isinstance(allowed, tuple) and value not in allowed:
            label = f"`{name}` cannot be this"
            report.error("VDS313", _at(name, source), label=label, help=f"it may be {listing(allowed)}")
        elif allowed is bool and not isinstance(value, bool):
            label = f"`{name}` cannot be this"
            report.error("VDS313", _at(name, source), label=label, help="it is true or false")
        elif allowed is float and (type(value) not in (int, float) or not 0 <= value <= 360):
            label = f"`{name}` cannot be this"
            help = "it is an angle in degrees from 0 to 360, such as 180"
            report.error("VDS313", _at(name, source), label=label, help=help)
    return dict(told)


def _unknown(name: str, known: tuple[str, ...], source: Source, report: Report) -> None:
    meant = nearest(name, known)
    report.error(
        "VDS313",
        _at(name, source),
        label=f"there is no setting `{name}`",
        help=f"settings here are {listing(known, 20, last='and')}",
        suggestion=meant,
        fix=meant,
    )


def _at(name: str, source: Source) -> Span:
    """The line that sets something."""
    found = re.search(rf'^[ \t]*(?:\[\s*)?"?{re.escape(name)}"?\b.*$', source.text, re.MULTILINE)
    return Span(source, found.start(), found.end()) if found else Span(source, 0, 0)
