"""Lets a process end when the one that started it does, however that ended.

Assumes that standard input is a pipe whose other end only the starter holds. Guarantees an interrupt, as by
Ctrl-C, when it closes, and an end ten seconds later to whatever does not heed that.
"""

from __future__ import annotations

import os
import signal
import sys
import threading
import time

_PATIENCE = 10.0


def end_with_starter() -> None:
    """Watch standard input from now on, in a thread of its own."""

    def mind() -> None:
        while sys.stdin.buffer.read(1):
            pass
        os.kill(os.getpid(), signal.SIGINT)
        time.sleep(_PATIENCE)
        os._exit(1)

    threading.Thread(target=mind, daemon=True).start()
