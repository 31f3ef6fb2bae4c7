"""Parts of the animatic that are encoded again, transitions and fades, kept between runs.

Assumes films that are not written to any more. Guarantees that a part goes by the contents of its films and
by where they stand to each other: the same films joined the same way are encoded once.
"""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from ..emit.timeline import Placed
from ..emit.video import WritePart, write_part
from .cache import Cache
from .depends import digest
from .keys import code_digest

_FILM = "part.mp4"


def kept_parts(cache: Cache) -> WritePart:
    """Writes parts, or takes them out of the cache."""

    def part_to(path: Path, shots: Sequence[tuple[Path, Placed]], fps: tuple[int, int]) -> None:
        first = shots[0][1].start
        films = [hashlib.sha256(film.read_bytes()).hexdigest() for film, _ in shots]
        places = [replace(place, start=place.start - first) for _, place in shots]
        key = digest("part", code_digest(), films, places, fps)
        if not cache.take(key, {_FILM: path}):
            write_part(path, shots, fps)
            cache.put(key, {_FILM: path})

    return part_to
