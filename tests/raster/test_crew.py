"""Tasks of kernels are shared out: each is done once, whether threads draw them from a queue or not."""

# No annotations from the future: Taichi reads them as kernel types.

import numpy as np
import pytest
import taichi as ti

from runtime.raster.device import start

start("cpu")
from runtime.raster.kernels import crew  # noqa: E402 - its functions want Taichi started
from runtime.raster.kernels.crew import MOST, STRETCH  # noqa: E402
from runtime.raster.kernels.geometry import i1  # noqa: E402


@ti.kernel
def tally(done: i1, order: i1, queue: i1, slots: ti.i32, host: ti.template()):  # type: ignore[no-untyped-def,valid-type]
    for slot in range(slots):
        task = crew.task(slot, done.shape[0], queue, host)
        if task < done.shape[0]:
            done[task] += 1
            order[slot] = task


@pytest.mark.parametrize("tasks", [1, 2, STRETCH - 1, STRETCH, STRETCH + 1, 5 * STRETCH])
def test_every_task_is_done_once(tasks: int) -> None:
    queue, slots, host = start("cpu").crew(tasks)
    assert host
    done, order = np.zeros(tasks, np.int32), np.full(slots, -1, np.int32)
    tally(done, order, queue, slots, host)
    assert (done == 1).all()
    threads = start("cpu").threads
    assert slots >= threads * STRETCH  # or Taichi would leave a thread without work
    assert np.bincount(order[order >= 0], minlength=tasks).max() == 1


def test_tasks_that_lie_together_are_done_by_one_thread() -> None:
    tasks = 5 * STRETCH
    queue, slots, host = start("cpu").crew(tasks)
    done, order = np.zeros(tasks, np.int32), np.full(slots, -1, np.int32)
    tally(done, order, queue, slots, host)
    threads = start("cpu").threads
    by = np.full(tasks, -1)  # the thread that did each task
    for thread, mine in enumerate(order.reshape(threads, -1)):
        by[mine[mine >= 0]] = thread
    together = by[: tasks // MOST * MOST].reshape(-1, MOST)
    assert (together == together[:, :1]).all()


def test_on_a_gpu_every_slot_has_its_task() -> None:
    done, order = np.zeros(700, np.int32), np.full(700, -1, np.int32)
    tally(done, order, np.zeros(1, np.int32), 700, False)
    assert (order == np.arange(700)).all()
    assert (done == 1).all()
