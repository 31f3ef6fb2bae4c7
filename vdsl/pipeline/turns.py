"""Turns at what several runs may change: a lock, a build's folder.

Guarantees that a turn ends with the process that has it, however that ends. The files that stand for turns
are in the user's cache folder, so that nothing is left beside anybody's work.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from filelock import BaseFileLock, FileLock
from platformdirs import user_cache_path


@contextmanager
def one_at_a_time(path: Path) -> Iterator[None]:
    """Waits until nobody else is in such a block for the same path. Where no turn can be taken, goes on."""
    lock = _lock(path)
    taken = False
    if lock is not None:
        with suppress(OSError):
            lock.acquire()
            taken = True
    try:
        yield
    finally:
        if lock is not None and taken:
            lock.release()


def _lock(path: Path) -> BaseFileLock | None:
    name = hashlib.sha256(os.path.realpath(path).encode("utf-8", "surrogateescape")).hexdigest()[:24]
    folder = user_cache_path("vdsl") / "turns"
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError:
        return None
    return FileLock(folder / f"{name}.lock")
