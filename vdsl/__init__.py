"""VDS: a text language and compiler for moving storyboards.

``vdsl.parse`` reads text, ``vdsl.check`` checks a file, ``vdsl.compile`` makes the whole film. Every
stage between is a function of its own: see ``vdsl.lang``, ``vdsl.stage``, ``vdsl.propose``,
``vdsl.pipeline`` and ``vdsl.emit``. Importing this package loads nothing until it is asked for.
"""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .lang import Report, Settings, Source, Storyboard, parse
    from .pipeline.compile import Result
    from .pipeline.script import Checked, ScriptError

    __version__: str

#: Where the names are that are looked up when they are first used.
_HOMES = {
    "Checked": ".pipeline.script",
    "Report": ".lang",
    "ScriptError": ".pipeline.script",
    "Settings": ".lang",
    "Source": ".lang",
    "Storyboard": ".lang",
    "parse": ".lang",
}
_PACKAGES = ("cinema", "emit", "lang", "library", "pipeline", "propose", "stage")


def __getattr__(name: str) -> Any:
    if name == "__version__":
        from importlib.metadata import PackageNotFoundError, version

        try:
            return version("vdsl")
        except PackageNotFoundError:  # run from a checkout that was never installed
            return "0+unknown"
    if name in _HOMES:
        return getattr(import_module(_HOMES[name], __name__), name)
    if name in _PACKAGES:
        return import_module(f".{name}", __name__)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *_HOMES, *_PACKAGES, "__version__"})


def check(path: str | Path, settings: Settings | None = None) -> Checked:
    """Read and check a script. Raises :class:`ScriptError` with every mistake, or OSError."""
    from .pipeline.script import load_storyboard

    return load_storyboard(Path(path), settings)


def compile(
    path: str | Path,
    out: str | Path | None = None,
    settings: Settings | None = None,
    *,
    device: str = "auto",
    rank: str = "discriminator",
    weights: Path | None = None,
    burn_in: bool = False,
    edit: bool = False,
    guides: str = "",
    arrows: bool = True,
) -> Result:
    """Compile a script into a folder of videos (default ``build/<name>``).

    settings: what wins over the script's header lines; device: auto, cpu, cuda or vulkan; rank:
    discriminator or geometry; edit: choose takes for the sequence; guides: what is drawn over every frame,
    such as ``safe,thirds,2.39`` (docs/overlays.md); arrows: show on the contact sheet what moves
    Raises ValueError for guides that are none, :class:`ScriptError`, OSError or :class:`ranker.RankerError`.
    """
    # Only now: parsing and checking must not wait for numpy, torch and taichi.
    from .emit.guides import guides_of
    from .lang import Settings
    from .pipeline.compile import compile_file
    from .pipeline.options import Options

    over = guides_of(guides)
    options = Options(
        settings or Settings(), device, rank, weights, burn_in, edit, guides=over, arrows=arrows
    )
    return compile_file(path, out, options)


__all__ = [
    "Checked",
    "Report",
    "ScriptError",
    "Settings",
    "Source",
    "Storyboard",
    "check",
    "compile",
    "parse",
]
