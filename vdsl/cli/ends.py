"""How the process ends when it is not by itself: asked to stop, or nobody takes what it prints.

Only the command's own entry uses this: whoever calls :data:`vdsl.cli.app` or the Python API keeps the
signal handlers they have.
"""

from __future__ import annotations

import contextlib
import errno
import os
import signal
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from types import FrameType
from typing import NoReturn

from .check import MACHINE

#: What asks politely: a service manager, a batch queue, a closed terminal.
_REQUESTS = ("SIGTERM", "SIGHUP")


@contextlib.contextmanager
def ends_told() -> Iterator[None]:
    """Requests to stop clean up as Ctrl-C does (exit code 130); output nobody takes is told (3)."""
    if not os.environ.get("HOME"):  # a service may have none, and Taichi aborts without
        os.environ["HOME"] = _home()
    for name in _REQUESTS:
        number = getattr(signal, name, None)
        if number is not None and signal.getsignal(number) is signal.SIG_DFL:  # nohup stays nohup
            signal.signal(number, _stop)
    try:
        try:
            yield
        finally:
            for stream in (sys.stdout, sys.stderr):
                if stream is not None:
                    stream.flush()
    except OSError as error:
        gone = error.errno == errno.EPIPE  # whoever read our output has left, as in `vdsc … | head`
        with contextlib.suppress(OSError):
            if not gone:
                os.write(2, f"vdsc: cannot write the output: {error.strerror or error}\n".encode())
        _silence()
        sys.exit(1 if gone else MACHINE)


def _home() -> str:
    try:
        return str(Path.home())
    except RuntimeError:  # nobody this machine knows
        return tempfile.gettempdir()


def _stop(number: int, frame: FrameType | None) -> NoReturn:
    raise KeyboardInterrupt


def _silence() -> None:
    """Drop what is still buffered, so that leaving does not fail again."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    for stream in (sys.stdout, sys.stderr):
        with contextlib.suppress(OSError, ValueError, AttributeError):
            os.dup2(nowhere, stream.fileno())
