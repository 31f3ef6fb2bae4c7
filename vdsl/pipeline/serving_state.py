"""What the served page is told: which build there is, what is chosen, and what is going on.

Assumes nothing of the files; one that is missing or half there counts as not there. Guarantees that the
same files give the same state, so that only what changed is told.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple, TypeVar, cast

import psutil

from ..lang import Report, read_source
from .lock import lock_path, read_lock
from .placing import find, placed
from .script import ScriptError

STATUS = "status.json"
#: Seconds by which the clocks of files and of processes may differ.
_DRIFT = 30.0
_QUIET = {"state": "done", "message": "", "diagnostics": []}


class _Built(NamedTuple):
    """Of a build: the digest of its script; by shot what its line depends on, and the keys of its takes."""

    script: str = ""
    depends: Mapping[str, str] = {}
    keys: Mapping[str, Sequence[str]] = {}


_NOTHING = _Built()
_T = TypeVar("_T")


class Watched:
    """A script, its lock and its build, looked at again and again; files are only read when they changed."""

    def __init__(self, file: Path, build: Path) -> None:
        self.file, self.build = file, build
        self._known: dict[Path, tuple[str, object]] = {}

    def state(self) -> dict[str, Any]:
        """``build``: changes with the build; ``choices``: shot id to take; ``stale``: whether the script is
        another than the build's; ``state``, ``message``, ``diagnostics``: of ``status.json``.
        """
        status = self._status()
        return {
            "build": _stamp(self.build / "storyboard.json") + _stamp(self.build / "index.html"),
            "choices": self.choices(),
            "stale": self.is_stale(),
            "state": str(status.get("state", "done")),
            "message": str(status.get("message") or ""),
            "diagnostics": status.get("diagnostics") or [],
        }

    def _status(self) -> dict[str, Any]:
        """What is being made, as ``vdsc watch`` tells it."""
        try:
            status = json.loads((self.build / STATUS).read_text("utf-8"))
        except (OSError, ValueError):
            return _QUIET
        known = isinstance(status, dict) and str(status.get("schema", "")).startswith("vds.status/")
        return status if known and _goes_on(status.get("process"), self.build / STATUS) else _QUIET

    def choices(self) -> dict[str, str]:
        """What is chosen, by shot: the take's key in the build where it is there, else as in the lock."""
        try:
            lock = read_lock(lock_path(self.file))
        except (ScriptError, OSError):
            return {}
        built = self._once(self.build / "storyboard.json", _read_build, _NOTHING)
        out = {}
        for shot, choice in placed(lock.choices, built.depends).items():
            keys = built.keys[shot]
            at = find(choice, keys)
            out[shot] = choice.key if at is None else keys[at]
        return out

    def is_stale(self) -> bool:
        """Whether the script is another than the build's."""
        script = self._once(self.file, self._script, "")
        built = self._once(self.build / "storyboard.json", _read_build, _NOTHING).script
        return bool(script and built and script != built)

    def _once(self, path: Path, read: Callable[[Path], _T], nothing: _T) -> _T:
        """What a file says, read anew when the file is another."""
        stamp = _stamp(path)
        known = self._known.get(path)
        if known is None or known[0] != stamp:
            known = (stamp, read(path) if stamp else nothing)
            self._known[path] = known
        return cast(_T, known[1])

    @staticmethod
    def _script(path: Path) -> str:
        try:
            source = read_source(path, Report())
        except OSError:
            return ""
        return hashlib.sha256(source.text.encode("utf-8", "surrogatepass")).hexdigest() if source else ""


def _goes_on(process: object, told: Path) -> bool:
    """Whether whoever wrote ``told`` still watches: one that was killed could not say that it stopped."""
    try:
        return (
            isinstance(process, int)
            and psutil.Process(process).create_time() <= told.stat().st_mtime + _DRIFT
        )
    except (psutil.Error, OSError, ValueError, OverflowError):
        return False


def _read_build(path: Path) -> _Built:
    try:
        document = json.loads(path.read_text("utf-8"))
        return _Built(
            str(document.get("script", "")),
            {shot["id"]: str(shot["depends"]) for shot in document["shots"]},
            {shot["id"]: [str(take["key"]) for take in shot["takes"]] for shot in document["shots"]},
        )
    except (OSError, ValueError, AttributeError, KeyError, TypeError):
        return _NOTHING


def _stamp(path: Path) -> str:
    """Another for every other content that is put in the file's place; "" where there is none."""
    try:
        found = path.stat()
    except OSError:
        return ""
    return f"{found.st_mtime_ns:x}.{found.st_size:x}.{found.st_ino:x};"
