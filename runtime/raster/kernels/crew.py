"""How threads share the tasks of a kernel: rows, views or moments.

Taichi gives each thread of the CPU one stretch of a parallel loop, and none of fewer than 512 turns. So a
loop over a few hundred rows is done by one thread, and where the lower half of a picture is harder than the
upper one, a thread waits for the other. Here the loop is over slots, so many that each thread's stretch would
do for all tasks, and in each slot the next task is drawn from a queue, until there are none left::

    for slot in range(slots):
        row = crew.task(slot, rows, queue, host)
        if row < rows:
            ...

One task a turn: what a turn needs of the stack is given back only when it ends. But a thread takes several
tasks from the queue at once, rows that lie together: what one of them has read, the next one finds in the
cache of its core. On a GPU there are as many slots as tasks, and no queue. ``Backend.crew`` gives the
arguments.
"""

# mypy: ignore-errors
# Taichi reads annotations as kernel types and parses the bodies itself.

import numpy as np
import taichi as ti
from numpy.typing import NDArray

NEVER = 1 << 30  # a task that there is not
STRETCH = 512  # turns of a parallel loop that Taichi gives a thread of the CPU at least
APART = 16  # numbers from the place of one thread in a queue to that of the next: a line of the cache
MOST, SHARES = 16, 16  # tasks taken at once; shares each thread takes at least, if there are enough


def queue_for(tasks: int, threads: int) -> NDArray[np.int32]:
    """A queue for one call: the next task, how many are taken at once, and for each thread its next task and
    the one after its last."""
    queue = np.zeros(APART * (1 + threads), np.int32)
    queue[1] = min(max(tasks // (threads * SHARES), 1), MOST)
    return queue


@ti.func
def task(slot, tasks, queue: ti.template(), host: ti.template()):
    """The task that is done in this slot; ``tasks`` or more if there is none."""
    drawn = slot
    if ti.static(host):
        own = APART * (1 + slot // ti.max(tasks, STRETCH))
        drawn = queue[own]
        if drawn == queue[own + 1]:
            drawn = NEVER
            if queue[0] < tasks:
                drawn = ti.atomic_add(queue[0], queue[1])
                queue[own + 1] = ti.min(drawn + queue[1], tasks)
        if drawn < tasks:
            queue[own] = drawn + 1
        else:
            drawn = NEVER
            queue[own + 1] = queue[own]
    return drawn
