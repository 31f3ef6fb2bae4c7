"""Results that a process remembers by the contents of what they were made of.

A watched script is written again and again, and most of its shots are as they were. Assumes functions that
give the same for the same, and whose results nobody changes. Guarantees that nothing is remembered of values
that cannot be pickled, and no more than the results used last.
"""

from __future__ import annotations

import pickle
import threading
from collections import OrderedDict
from collections.abc import Callable
from functools import wraps
from hashlib import blake2b
from typing import ParamSpec, TypeVar

P = ParamSpec("P")
T = TypeVar("T")


def remembering(most: int) -> Callable[[Callable[P, T]], Callable[P, T]]:
    """Let a function remember its last ``most`` results, by the contents of its arguments.

    New objects that hold the same, arrays among them, count as the same. What it raises is not remembered.
    """

    def wrap(make: Callable[P, T]) -> Callable[P, T]:
        known: OrderedDict[bytes, T] = OrderedDict()
        lock = threading.Lock()

        @wraps(make)
        def call(*arguments: P.args, **named: P.kwargs) -> T:
            try:
                content = pickle.dumps((arguments, named), protocol=5)
            except (pickle.PicklingError, TypeError, AttributeError):
                return make(*arguments, **named)
            key = blake2b(content, digest_size=20).digest()
            with lock:
                if key in known:
                    known.move_to_end(key)
                    return known[key]
            made = make(*arguments, **named)
            with lock:
                known[key] = made
                if len(known) > most:
                    known.popitem(last=False)
            return made

        return call

    return wrap
