"""Work on two things at once: the next is made by a thread of its own while the last is used."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from typing import TypeVar

A = TypeVar("A")
B = TypeVar("B")


def one_ahead(make: Callable[[A], B], items: Iterable[A]) -> Iterator[tuple[A, B]]:
    """Every item with what is made of it, in order; one is made ahead, and they are made one at a time.

    What ``make`` raises is raised where its item would come.
    """
    waiting: tuple[A, Future[B]] | None = None
    with ThreadPoolExecutor(1) as worker:
        for item in items:
            upcoming = item, worker.submit(make, item)
            if waiting is not None:
                yield waiting[0], waiting[1].result()
            waiting = upcoming
        if waiting is not None:
            yield waiting[0], waiting[1].result()
