"""Compiles a script whenever it, or what it draws on, is saved: a draft, then first takes, then the others.

One process stays: renderers, judge and staged scenes are kept from one compilation to the next. Assumes that
nobody else compiles into the folder meanwhile (who does, loses nothing). Guarantees that the folder holds the
last good build, that ``status.json`` in it says what is going on, and that a save during a compilation
starts it anew.
"""

from __future__ import annotations

import json
import os
import threading
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager, suppress
from dataclasses import dataclass, replace
from pathlib import Path

from watchfiles import Change
from watchfiles import watch as changes_in

from ranker.errors import RankerError
from runtime.formats.outline import FIGURES, MODELS, MOTIONS
from runtime.raster.device import DeviceError

from ..emit.folder import write_text
from ..lang import Report
from ..library.loader import BESIDE
from .compile import Result, Workshop, compile_file, prepare
from .findings import finding
from .lock import lock_path
from .options import Options
from .progress import Progress, Silence
from .project import NAME as PROJECT
from .script import ScriptError, load_storyboard
from .tasting import NAME as TASTE

SCHEMA = "vds.status/1"
STATUS = "status.json"
#: Milliseconds of quiet after a change, and the longest that changes are waited for.
_STEP, _DEBOUNCE = 40, 300
#: Kinds of files that a script may draw on: others beside it, models and motions, and what these consist of.
_DRAWN_ON = frozenset({".vds", *MODELS, *FIGURES, *MOTIONS, *BESIDE})


@dataclass(frozen=True, eq=False)
class News:
    """What happened. state: ``building``, ``draft``, ``firsts``, ``done`` or ``error``

    revision: counts the builds
    message: in words; result: of a build that is in its place now; report: what was found wrong
    """

    state: str
    revision: int
    message: str
    result: Result | None = None
    report: Report | None = None


class _SupersededError(Exception):
    """The script was saved while it was compiled."""


Watchers = Callable[[], AbstractContextManager[Progress]]


@contextmanager
def _silent() -> Iterator[Progress]:
    yield Silence()


def watch(
    file: Path,
    out: Path | None = None,
    wanted: Callable[[], Options] = Options,
    told: Callable[[News], None] = lambda news: None,
    watching: Watchers = _silent,
    stop: threading.Event | None = None,
) -> None:
    """Compile a script now and after every change, until ``stop`` is set or the process is interrupted.

    wanted: the options, asked for anew every time; a ScriptError from there is told as a mistake
    told: hears of every build and every mistake; watching: gives whoever is told of a compilation's progress
    Raises OSError and the like only where nothing can go on: the script cannot be watched.
    """
    loop = _Loop(Path(file), out, wanted, told, watching, stop or threading.Event())
    loop.run()


class _Loop:
    def __init__(
        self,
        file: Path,
        out: Path | None,
        wanted: Callable[[], Options],
        told: Callable[[News], None],
        watching: Watchers,
        stop: threading.Event,
    ) -> None:
        self.file, self.wanted, self.told, self.watching, self.stop = file, wanted, told, watching, stop
        self.folder = out if out is not None else Path("build") / file.stem
        self.workshop = Workshop()
        self.saved = threading.Event()
        self.revision = _revision(self.folder)
        self._state = "done"
        self._readied = False

    def run(self) -> None:
        try:
            self._follow()
        finally:
            self._write(self._state, "stopped")

    def _follow(self) -> None:
        with _Ears(self.file, self.folder, self.saved) as ears:
            while not self.stop.is_set():
                self.saved.clear()
                try:
                    self._compile()
                    ears.listen_to(self._folders())
                    self._get_ready()
                except _SupersededError:
                    continue
                while not self.saved.wait(0.2) and not self.stop.is_set():
                    pass

    # -- compiling -----------------------------------------------------------------------------

    def _compile(self) -> None:
        self._write("building", "compiling")
        try:
            options = self.wanted()
            result = self._made(replace(options, draft=True))
            if result.build.draft or options.edit:
                result = self._made(replace(options, firsts=True))
            if result.build.waiting:
                self._made(options)
        except ScriptError as error:
            self._wrong(str(error), error.report)
        except OSError as error:
            self._wrong(f"{error.filename}: {error.strerror}" if error.filename else str(error))
        except (RankerError, DeviceError, MemoryError) as error:
            self._wrong(str(error) or type(error).__name__)

    def _made(self, options: Options) -> Result:
        """One build, in its place."""

        def finish(stage: Path, result: Result) -> None:
            state = _state(result)
            self._write(state, _summary(result), result.warnings, self.revision + 1, stage)

        with self.watching() as progress:
            stepping = _Stepping(progress, self.saved)
            result = compile_file(self.file, self.folder, options, stepping, self.workshop, finish)
        self.revision += 1
        self._state = _state(result)
        self.told(News(self._state, self.revision, _summary(result), result, result.warnings))
        return result

    def _wrong(self, message: str, report: Report | None = None) -> None:
        self._write("error", message, report)
        self.told(News("error", self.revision, message, report=report))

    def _get_ready(self) -> None:
        """Load what the first change will need, while nobody waits."""
        if not self._readied and not self.saved.is_set():
            self._readied = True
            with suppress(ScriptError, RankerError, DeviceError, OSError, MemoryError):
                prepare(self.file, self.wanted(), self.workshop)

    # -- telling -------------------------------------------------------------------------------

    def _write(
        self,
        state: str,
        message: str,
        report: Report | None = None,
        revision: int | None = None,
        folder: Path | None = None,
    ) -> None:
        """Write ``status.json``. A disk that refuses keeps nobody from working."""
        place = folder or self.folder
        found = [finding(d) for d in report.diagnostics] if report is not None else []
        document = {
            "schema": SCHEMA,
            "state": state,
            "revision": self.revision if revision is None else revision,
            "message": message,
            "diagnostics": found,
            "process": os.getpid(),
        }
        with suppress(OSError):
            place.mkdir(parents=True, exist_ok=True)
            write_text(place / STATUS, json.dumps(document, indent=1) + "\n")

    def _folders(self) -> set[Path]:
        """Folders of all files the script draws on; of a script with mistakes, its own."""
        folders = {self.file.parent.absolute()}
        with suppress(ScriptError, OSError):
            folders |= {p.parent for p in load_storyboard(self.file).catalog.paths()}
        folders |= {p for p in self.file.absolute().parents if (p / PROJECT).is_file()}
        return {f.absolute() for f in folders if f.is_dir()}


def _state(result: Result) -> str:
    return "draft" if result.build.draft else "firsts" if result.build.waiting else "done"


def _summary(result: Result) -> str:
    shots = result.build.shots
    waiting = sum(any(t.media.sketched for t in s.takes) for s in shots)
    if result.build.draft:
        return f"draft: {waiting} of {len(shots)} shots are being filmed"
    if result.build.waiting:
        return (
            f"the film is there; other takes of {result.build.waiting} of {len(shots)} shots are being filmed"
        )
    return f"{len(shots)} {'shot' if len(shots) == 1 else 'shots'} in {result.report.seconds:.1f} s"


def _revision(folder: Path) -> int:
    """How many builds were counted before."""
    try:
        return int(json.loads((folder / STATUS).read_text("utf-8"))["revision"])
    except (OSError, ValueError, KeyError, TypeError):
        return 0


class _Stepping:
    """Passes progress on, and leaves a compilation whose script was saved meanwhile."""

    def __init__(self, watcher: Progress, saved: threading.Event) -> None:
        self._watcher, self._saved = watcher, saved

    def begin(self, stage: str, total: int, unit: str) -> None:
        if self._saved.is_set():
            raise _SupersededError
        self._watcher.begin(stage, total, unit)

    def advance(self, stage: str, amount: int, seconds: float) -> None:
        self._watcher.advance(stage, amount, seconds)
        if self._saved.is_set():
            raise _SupersededError


class _Ears:
    """Hears of changes in folders, in a thread of its own."""

    def __init__(self, file: Path, build: Path, saved: threading.Event) -> None:
        self._file, self._build, self._saved = file.absolute(), build.absolute(), saved
        self._folders: set[Path] = set()
        self._thread: threading.Thread | None = None
        self._enough = threading.Event()

    def __enter__(self) -> _Ears:
        self.listen_to({self._file.parent})
        return self

    def __exit__(self, *error: object) -> None:
        self._deaf()

    def listen_to(self, folders: set[Path]) -> None:
        """Listen in these folders from now on; what was heard before stays heard."""
        if folders == self._folders:
            return
        old = (self._thread, self._enough)
        self._folders, self._enough = folders, threading.Event()
        self._thread = threading.Thread(target=self._listen, args=(folders, self._enough), daemon=True)
        self._thread.start()
        if old[0] is not None:
            old[1].set()
            old[0].join()

    def _listen(self, folders: set[Path], enough: threading.Event) -> None:
        heard = changes_in(
            *folders,
            watch_filter=self._matters,
            step=_STEP,
            debounce=_DEBOUNCE,
            recursive=False,
            stop_event=enough,
            rust_timeout=500,
            raise_interrupt=False,
        )
        for _ in heard:
            self._saved.set()

    def _matters(self, change: Change, path: str) -> bool:
        """The script, its lock, the project's settings and taste, and what a script may draw on: nothing that
        somebody else keeps writing there, as a log."""
        name = Path(path).name
        if Path(path) == self._build or Path(path).is_dir():  # a build put in its place beside the script
            return False
        if name in (self._file.name, lock_path(self._file).name, PROJECT, TASTE):
            return True
        return not name.startswith(".") and Path(name).suffix.lower() in _DRAWN_ON

    def _deaf(self) -> None:
        self._enough.set()
        if self._thread is not None:
            self._thread.join()
