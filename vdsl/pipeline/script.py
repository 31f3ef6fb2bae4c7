"""A file into a checked storyboard and the definitions it draws on."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from ..lang import Diagnostic, Report, Settings, Source, Storyboard, check, parse, read_source
from ..library import Catalog


class ScriptError(Exception):
    """The script has errors; ``report`` holds all of them, and the warnings."""

    def __init__(self, report: Report) -> None:
        self.report = report
        count = len(report.errors)
        files = {Path(d.span.source.name).name for d in report.errors}
        where = files.pop() if len(files) == 1 else "the script"
        super().__init__(f"{count} error{'s' if count != 1 else ''} in {where}")

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        return self.report.diagnostics


@dataclass(frozen=True, eq=False)
class Checked:
    """A storyboard without errors, the definitions it draws on, and the warnings so far.

    ``report`` goes on collecting: later stages find what only a built world can show.
    """

    storyboard: Storyboard
    catalog: Catalog
    report: Report


def load_storyboard(
    path: Path, overrides: Settings | None = None, defaults: Settings | None = None
) -> Checked:
    """Read, parse and check a script.

    overrides: settings that win over the script's header lines; defaults: those that hold where it says none
    Raises :class:`ScriptError`, or OSError where the file cannot be read.
    """
    report = Report()
    source = read_source(path, report)
    if source is None:
        raise ScriptError(report)
    return check_source(source, report, overrides, defaults=defaults)


def check_source(
    source: Source,
    report: Report | None = None,
    overrides: Settings | None = None,
    definitions: Path | None = None,
    defaults: Settings | None = None,
) -> Checked:
    """The same from text in memory; definitions: a script whose definitions it may use."""
    report = Report() if report is None else report
    script, _ = parse(source, report)
    also = read_source(definitions, report) if definitions is not None else None
    catalog = Catalog.for_script(script, report, parse(also, report)[0] if also is not None else None)
    storyboard = check(script, catalog, report, overrides, defaults)
    if storyboard is None:
        raise ScriptError(report)
    return Checked(storyboard, catalog, report)
