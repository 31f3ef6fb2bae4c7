"""The shadow maps of moments: one of each person, one of what is not where the set puts it, one of what is.

A set is far larger than a person, so a map over all that could move would leave little of a person's shadow.
And were people together in one map, everybody's shadow would change as one of them walks off. So each has
a map of its own, of texels that are always the same size. Things that are where the set puts them lie in
*home* maps: these all lie the same way, and moments with the same things at home share one.

Assumes skinned moments. Guarantees that what falls into the light of a moment depends on its palette alone.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .device import Backend
from .loaded import Loaded

LARGE = 400  # rows of a picture from which on it is large
SHADOW = 320  # texels along the map of a person, for large pictures; half for small ones
TEXEL = 0.0084  # metres in large pictures, twice that in small ones: 2.6 metres, unless somebody needs more
HOME = 1024  # texels along a home map, for large pictures; half for small ones
OUT_OF_REACH = (1e6, 1e6, 100.0)  # frame of a map that is not there

Buffers = Callable[[str, tuple[int, ...], type], Any]


def texels_of(height: int) -> int:
    """Texels along the map of a person, for pictures of ``height`` rows."""
    return SHADOW if height > LARGE else SHADOW // 2


class Shadows:
    """The shadow maps of M moments, and of one more in which only what rests is there.

    each: own maps of a moment, of what is away from home and of each person; frame [(M + 1) each, 3], size,
    depth, coarse: these maps; home [M + 1]: the home map of each moment; home_frame [H, 3], home_size,
    home_depth, home_coarse: the home maps, all as in ``kernels/light.py``
    """

    def __init__(self, backend: Backend, buffer: Buffers) -> None:
        from .kernels import light  # only now: it imports taichi

        self._backend, self._buffer, self._light = backend, buffer, light
        self._members = np.zeros((0, 0), np.bool_)  # of the home maps that there are
        self._cast_for: tuple[Any, ...] = ()  # what they are of, and their size
        self._last_depth: Any = None
        self._changed: Any = None
        self.count, self.each, self.size, self.home_size = 1, 1, 1, 1

    def reserve(self, loaded: Loaded, moments: int, height: int, wanted: bool) -> None:
        """Buffers for ``moments``. wanted: whether there are to be any shadows; none are cast yet"""
        self.count, self._changed = moments, None
        self.size = texels_of(height) if wanted and len(loaded.casting.casters) else 1
        self.each = len(loaded.casting.runs) if self.size > 1 else 1
        home = HOME if height > LARGE else HOME // 2
        self.home_size = home if self.size > 1 and loaded.home.any else 1
        maps, summary = (moments + 1) * self.each, max(1, self._light.summary_size(self.size))
        self.frame = self._buffer("frame", (maps, 3), np.float32)
        self.depth = self._buffer("depth", (maps * self.size**2,), np.float32)
        self.coarse = self._buffer("coarse", (maps * summary,), np.float32)
        self._reserve_home(1)
        self.home = self._backend.upload(np.zeros(moments + 1, np.int32))
        if self._backend.on_host:
            self.frame[:] = OUT_OF_REACH
            if self.home_size == 1:
                self.home_frame[:] = OUT_OF_REACH

    def _reserve_home(self, maps: int) -> None:
        summary = max(1, self._light.summary_size(self.home_size))
        self.home_frame = self._buffer("home_frame", (maps, 3), np.float32)
        self.home_depth = self._buffer("home_depth", (maps * self.home_size**2,), np.float32)
        if self.home_depth is not self._last_depth:  # other memory, in which there is nothing yet
            self._last_depth, self._cast_for = self.home_depth, ()
        self.home_coarse = self._buffer("home_coarse", (maps * summary,), np.float32)

    def cast(
        self, loaded: Loaded, position: Any, palettes: NDArray[np.float32], rests: NDArray[np.int32] | None
    ) -> None:
        """Cast all maps. position: as in ``Moments``; rests: what of a palette is in the last moment, as it
        is in the first one; None for nothing"""
        if self.size == 1:
            return
        home = loaded.home.kept(palettes)
        own = ~home
        if self._backend.on_host:
            last = np.zeros(home.shape[1], np.bool_)
            last[[] if rests is None else rests] = True
            own, home = (np.concatenate([some, last & some[:1]]) for some in (own, home))
        source = np.append(np.arange(self.count), 0)[: len(own)].astype(np.int32)  # what rests is as at first
        self._cast_own(loaded, position, own, source)
        if self.home_size > 1:
            self._cast_home(loaded, position, home & loaded.home.casts, source)

    def _cast_own(
        self, loaded: Loaded, position: Any, member: NDArray[np.bool_], source: NDArray[np.int32]
    ) -> None:
        groups = np.arange(self.each, dtype=np.int32)
        of_group = member[:, None] & (loaded.casting.group == groups[:, None])
        maps = len(member) * self.each
        things = self._things(
            loaded,
            position,
            of_group.reshape(maps, -1),
            np.repeat(source, self.each),
            np.tile(groups, len(member)),
        )
        a, finest = loaded.arrays, TEXEL * SHADOW / self.size
        points = (a["points"], a["point_end"])
        self._light.fit(*things, *points, finest, self.size, maps, self.frame, *self._backend.crew(maps))
        self._cast(loaded, things, (self.frame, self.size, maps, self.depth), self.coarse, "blur")

    def _cast_home(
        self, loaded: Loaded, position: Any, member: NDArray[np.bool_], source: NDArray[np.int32]
    ) -> None:
        """Each home map once, and none if those that are there will do."""
        members, first, which = np.unique(member, axis=0, return_index=True, return_inverse=True)
        maps = len(members)
        self.home = self._backend.upload(which.reshape(-1).astype(np.int32))
        self._reserve_home(maps)
        frames = np.tile(np.array(loaded.home.frame(self.home_size), np.float32), (maps, 1))
        self.home_frame = self._backend.upload(frames)
        wanted = (loaded.home, self.home_size)
        if wanted == self._cast_for and np.array_equal(members, self._members):
            return
        things = self._things(loaded, position, members, source[first], np.zeros(maps, np.int32))
        target = (self.home_frame, self.home_size, maps, self.home_depth)
        self._cast(loaded, things, target, self.home_coarse, "home_blur")
        self._members, self._cast_for = members, wanted

    def _things(
        self,
        loaded: Loaded,
        position: Any,
        member: NDArray[np.bool_],
        source: NDArray[np.int32],
        group: NDArray[np.int32],
    ) -> tuple[Any, ...]:
        """What maps are of, as ``light.fit`` says it."""
        a, up = loaded.arrays, self._backend.upload
        return (position, a["basis"], a["entry"], up(member.astype(np.int32)), up(source), up(group))

    def _cast(
        self,
        loaded: Loaded,
        things: tuple[Any, ...],
        target: tuple[Any, int, int, Any],
        coarse: Any,
        spare: str,
    ) -> None:
        a, (_, size, maps, _) = loaded.arrays, target
        blur = self._buffer(spare, (maps * self._light.summary_size(size),), np.float32)
        casters = (a["faces"], a["casters"], a["runs"], loaded.static_vertices)
        self._light.cast_by(self._backend.crew(maps), *things, *casters, *target, blur, coarse)

    @property
    def maps(self) -> tuple[Any, ...]:
        """What kernels ask for that look into all of them."""
        homes = (self.home, self.home_frame, self.home_size, self.home_depth, self.home_coarse)
        return (self.frame, self.size, self.depth, self.coarse, self.each, *homes)

    @property
    def home_changed(self) -> Any:
        """As ``home_coarse``, of what lies in the light of a home map and not in that of the last moment.
        Host only."""
        if self._changed is None:
            self._changed = self.home_coarse
            if self.home_size > 1:
                light, maps = self._light, len(self._members)
                summary, blocks = light.summary_size(self.home_size), (self.home_size // light.FINE) ** 2
                self._changed = self._buffer("changed", (maps * summary,), np.float32)
                spare = self._buffer("differing", (maps * blocks,), np.float32)
                told = (self.home_depth, self.home_size, maps, int(self.home[self.count]))
                light.differing(*told, spare, self._changed, *self._backend.crew(maps))
        return self._changed
