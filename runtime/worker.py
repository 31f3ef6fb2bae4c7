"""Work done in order in one thread of its own, while whoever asks for it goes on.

Assumes work that lets other threads run meanwhile, as encoders do. Guarantees that no more than a given
number of pieces wait, that a failure is raised where the next piece is handed in or at the end, that what was
handed in is done even where the block around it ends in an error, and that nothing runs after that block.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from threading import Semaphore
from types import TracebackType

Work = Callable[[], object]


def _nothing() -> None:
    """What is undone of work that leaves nothing behind."""


class Worker:
    """Use as a context manager; it waits at the end. waiting: pieces of work at most, with the one begun.

    Everything here is called from one thread.
    """

    def __init__(self, waiting: int) -> None:
        self._room = Semaphore(waiting)
        self._thread = ThreadPoolExecutor(max_workers=1)
        self._failure: BaseException | None = None

    def do(self, work: Work, undo: Work = _nothing) -> None:
        """Hand in work; waits while there is no room. Raises what failed before.

        undo: done in its place once it, or anything before it, has failed; more than once, perhaps
        """
        self._room.acquire()
        if self._failure is not None:
            self._room.release()
            raise self._failure
        self._thread.submit(self._done, work, undo)

    def undo(self, undo: Work) -> None:
        """Have something undone once all is done that was handed in before, whether that fails or not."""
        self._thread.submit(undo)

    def wait(self) -> None:
        """Until all is done that was handed in. Raises what failed."""
        self._thread.submit(_nothing).result()
        if self._failure is not None:
            raise self._failure

    def _done(self, work: Work, undo: Work) -> None:
        try:
            if self._failure is not None:
                undo()
                return
            try:
                work()
            except BaseException as error:  # raised again by whoever hands in work
                self._failure = error
                undo()
        finally:
            self._room.release()

    def __enter__(self) -> Worker:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._thread.shutdown(wait=True)
        if kind is None and self._failure is not None:
            raise self._failure
