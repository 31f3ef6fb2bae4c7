"""Options of a compilation: from the command line, else from the project's ``vds.toml``, else as they are."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from .check import USAGE, stop

if TYPE_CHECKING:
    from ..pipeline.options import Options


def options_of(file: Path, **said: Any) -> Options:
    """The options of a run for a script; ``None`` is what nobody said.

    Raises :class:`~vdsl.pipeline.script.ScriptError` for a ``vds.toml`` that does not read.
    """
    from ..pipeline.options import Options
    from ..pipeline.project import project_of

    told = project_of(file).compile
    for called, value in told.items():
        name = called.replace("-", "_")
        if said.get(name) is None:
            said[name] = value
    try:
        return Options(**{name: value for name, value in said.items() if value is not None})
    except ValueError as error:
        stop(str(error), USAGE)
