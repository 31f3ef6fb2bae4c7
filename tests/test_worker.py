"""Work in a thread of its own: in order, bounded, and no failure lost."""

from __future__ import annotations

import threading
import time

import pytest

from runtime.worker import Worker


def test_work_is_done_in_order_and_all_of_it_at_the_end() -> None:
    done: list[int] = []
    with Worker(3) as worker:
        for k in range(20):
            worker.do(lambda k=k: done.append(k))  # type: ignore[misc]
    assert done == list(range(20))


def test_no_more_waits_than_was_said() -> None:
    go, handed_in = threading.Event(), 0

    def hand_in(worker: Worker) -> None:
        nonlocal handed_in
        for _ in range(8):
            worker.do(go.wait)
            handed_in += 1

    with Worker(3) as worker:
        asking = threading.Thread(target=hand_in, args=(worker,))
        asking.start()
        deadline = time.monotonic() + 10
        while handed_in < 3 and time.monotonic() < deadline:
            time.sleep(0.01)
        time.sleep(0.1)  # time enough for a fourth
        assert handed_in == 3
        go.set()
        asking.join()
    assert handed_in == 8


def test_a_failure_is_raised_where_more_is_handed_in_and_what_came_after_it_is_undone() -> None:
    said: list[str] = []
    with pytest.raises(OSError, match="full"), Worker(8) as worker:  # noqa: PT012
        held = threading.Event()
        worker.do(held.wait)
        worker.do(_full, lambda: said.append("undo first"))
        worker.do(lambda: said.append("second"), lambda: said.append("undo second"))
        held.set()
        with pytest.raises(OSError, match="full"):
            worker.wait()
        assert said == ["undo first", "undo second"]
        worker.do(lambda: said.append("third"))
    assert said == ["undo first", "undo second"]


def test_a_failure_nobody_asked_about_is_raised_at_the_end() -> None:
    worker = Worker(8)
    worker.do(_full)
    with pytest.raises(OSError, match="full"):
        worker.__exit__(None, None, None)


def test_an_error_around_it_is_the_one_raised_and_what_was_handed_in_is_done_first() -> None:
    done: list[str] = []
    with pytest.raises(KeyboardInterrupt), Worker(8) as worker:  # noqa: PT012
        worker.do(lambda: time.sleep(0.05))
        worker.do(lambda: done.append("work"))
        worker.undo(lambda: done.append("undone"))
        raise KeyboardInterrupt
    assert done == ["work", "undone"]


def _full() -> None:
    raise OSError("full")
