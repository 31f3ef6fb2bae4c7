"""How threads share the tasks of a kernel: rows, views or moments.

Taichi gives each thread of the CPU one stretch of a parallel loop, and none of fewer than 512 turns. So a
loop over a few hundred rows is done by one thread, and where the lower half of a picture is harder than the
upper one, a thread waits for the other. Here the loop is over slots, so many that each thread's stretch would
do for all tasks, and in each slot the next task is drawn from a queue, until there are none left::

    for slot in range(slots):
        row = crew.task(slot, rows, queue, host)
        if row < rows:
            ...

One task a turn: what a turn needs of the stack is given back only when it ends. On a GPU there are as many
slots as tasks, and no queue. ``Backend.crew`` gives the arguments.
"""

# mypy: ignore-errors
# Taichi reads annotations as kernel types and parses the bodies itself.

import taichi as ti

NEVER = 1 << 30  # a task that there is not


@ti.func
def task(slot, tasks, queue: ti.template(), host: ti.template()):
    """The task that is done in this slot; ``tasks`` or more if there is none."""
    drawn = slot
    if ti.static(host):
        drawn = NEVER
        if queue[0] < tasks:
            drawn = ti.atomic_add(queue[0], 1)
    return drawn
