"""Further takes of a shot, drawn while the page is served, in the thread in which it draws its pictures.

Assumes a build of the script. Guarantees that the build stays whole whatever befalls the drawing, that a
script which has changed is not compiled by the way, and that drawing ends soon after the server does.
"""

from __future__ import annotations

import json
import shutil
import traceback
from collections.abc import Callable
from concurrent.futures import Executor
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..emit.folder import STATUS
from ..emit.page_view import MOST
from .further import STEP
from .options import Options, made_by
from .script import ScriptError

if TYPE_CHECKING:
    from .compile import Result, Workshop

#: Shots that may wait for their turn.
WAITING = 12
_STAGES = {"stage": "placing the scene", "propose": "trying cameras", "draw": "looking at them"}


class FurtherError(Exception):
    """No further takes of this shot can be drawn; the message says why."""


class _EndedError(Exception):
    """The server ends."""


@dataclass
class _Told:
    """How far a shot is. state: ``waiting``, ``drawing``, ``none`` or ``error``; message: in words"""

    state: str
    message: str


class Further:
    """Draws further takes, one shot after the other.

    turns: runs what draws, one at a time; stale: whether the script is another than the build's
    ending: whether the server is to end
    """

    def __init__(
        self,
        file: Path,
        build: Path,
        turns: Executor,
        stale: Callable[[], bool],
        ending: Callable[[], bool],
    ) -> None:
        self.file, self.build = file, build
        self._turns, self._stale, self._ending = turns, stale, ending
        self._told: dict[str, _Told] = {}
        self._workshop: Workshop | None = None

    def state(self) -> dict[str, dict[str, str]]:
        """By shot, what is being drawn or was in vain."""
        return {shot: {"state": t.state, "message": t.message} for shot, t in list(self._told.items())}

    def ask(self, shot: str) -> None:
        """Have further takes drawn; once is enough. Raises :class:`FurtherError`, with why not."""
        busy = [t for t in self._told.values() if t.state in ("waiting", "drawing")]
        if shot in self._told and self._told[shot] in busy:
            return
        known = self._takes(shot)
        if len(busy) >= WAITING:
            raise FurtherError("many shots are waiting for their turn already; ask again when they are drawn")
        self._told[shot] = _Told("waiting", "waits for its turn")
        self._turns.submit(self._drawn, shot, known)

    def _takes(self, shot: str) -> int:
        """How many takes the build has of a shot that there can be more of."""
        try:
            document = json.loads((self.build / "storyboard.json").read_text("utf-8"))
            found = next((s for s in document["shots"] if s["id"] == shot), None)
            draft = bool(document["draft"])
        except (OSError, ValueError, KeyError, TypeError):
            raise FurtherError("there is no build; compile the storyboard first") from None
        if found is None:
            raise FurtherError(f"the build has no shot `{shot}`")
        if draft:
            raise FurtherError("this is a draft; more takes can be drawn when its films are there")
        if self._stale():
            raise FurtherError("the script has changed since this build; compile it first")
        count = len(found["takes"])
        if not count:
            raise FurtherError("no camera can film this shot as its line asks")
        if count >= MOST:
            raise FurtherError(f"{MOST} takes are the most of a shot")
        return count

    def _drawn(self, shot: str, known: int) -> None:
        """In the thread that draws."""
        told = self._told[shot]
        try:
            result = self._compiled(shot, told)
            built = next(s for s in result.build.shots if s.shot.id == shot)
        except _EndedError:
            return
        except Exception as error:
            told.state, told.message = "error", self._why(error)
            return
        if len(built.takes) > known:
            del self._told[shot]
            return
        told.state = "none"
        told.message = (
            f"No other of the {built.proposals} proposals looks different. "
            "More of them, or another seed, may give some."
        )

    def _compiled(self, shot: str, told: _Told) -> Result:
        # Here: whoever never asks does not wait for the compiler.
        from .compile import Workshop, compile_file

        if self._workshop is None:
            self._workshop = Workshop()
        said: dict[str, Any] = made_by(self.build)  # the device too: what it drew is kept by it
        options = Options(**said, further=(shot,))
        progress = _Telling(told, self._ending)
        progress.begin("stage", 0, "")
        return compile_file(self.file, self.build, options, progress, self._workshop, self._keep_status)

    def _keep_status(self, stage: Path, result: Result) -> None:
        """What somebody who watches has told of the script goes on holding."""
        with suppress(OSError):
            shutil.copy2(self.build / STATUS, stage / STATUS)

    @staticmethod
    def _why(error: Exception) -> str:
        if isinstance(error, ScriptError):
            return f"the script or its lock has errors: {error}"
        if isinstance(error, OSError | MemoryError) or type(error).__name__ in ("RankerError", "DeviceError"):
            return str(error) or type(error).__name__
        traceback.print_exception(error)
        return f"a mistake of vdsc itself, told in its terminal: {type(error).__name__}"


class _Telling:
    """Puts progress in words, and leaves when the server ends."""

    def __init__(self, told: _Told, ending: Callable[[], bool]) -> None:
        self._told, self._ending, self._films = told, ending, 0

    def begin(self, stage: str, total: int, unit: str) -> None:
        if self._ending():
            raise _EndedError
        self._films += stage == "film"
        words = _STAGES.get(stage)
        if stage == "film":  # more than those wanted where what was filmed before is no longer kept
            words = f"filming {self._films} of {max(STEP, self._films)}"
        if words:
            self._told.state, self._told.message = "drawing", words

    def advance(self, stage: str, amount: int, seconds: float) -> None:
        if self._ending():
            raise _EndedError
