"""The shadow maps of moments: a close one of people and what they handle, and one of what is where it is put.

A set is far larger than what its people do at a time, so a map over all that could move would leave little
of a person's shadow. Things that are where the set puts them lie in maps of their own, the *home* maps:
these all lie the same way, and moments with the same things at home share one.

Assumes skinned moments. Guarantees that what falls into the light of a moment depends on its palette alone.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .device import Backend
from .loaded import TEXEL, Loaded

SHADOW = 512  # texels along a moment's own map, for large pictures; half for small ones
HOME = 2  # times as many along a home map
LARGE = 400  # rows of a picture from which on it is large
OUT_OF_REACH = (1e6, 1e6, 100.0)  # frame of a map that is not there

Buffers = Callable[[str, tuple[int, ...], type], Any]


def texels_of(height: int) -> int:
    """Texels along a moment's own map, for pictures of ``height`` rows."""
    return SHADOW if height > LARGE else SHADOW // 2


class Shadows:
    """The shadow maps of M moments, and of one more in which only what rests is there.

    frame [M + 1, 3], size, depth, coarse: the moments' own maps; home [M + 1]: the home map of each;
    home_frame [H, 3], home_size, home_depth, home_coarse: these maps, as in ``kernels/light.py``
    """

    def __init__(self, backend: Backend, buffer: Buffers) -> None:
        from .kernels import light  # only now: it imports taichi

        self._backend, self._buffer, self._light = backend, buffer, light
        self._members = np.zeros((0, 0), np.bool_)  # of the home maps that there are
        self._cast_for: tuple[Any, ...] = ()  # what they are of, and their size
        self._last_depth: Any = None
        self._changed: Any = None
        self.count, self.size, self.home_size = 1, 1, 1

    def reserve(self, loaded: Loaded, moments: int, height: int, wanted: bool) -> None:
        """Buffers for ``moments``. wanted: whether there are to be any shadows; none are cast yet"""
        self.count, self._changed = moments, None
        self.size = texels_of(height) if wanted and len(loaded.scene.casters) else 1
        self.home_size = HOME * self.size if self.size > 1 and loaded.home.any else 1
        summary = max(1, self._light.summary_size(self.size))
        self.frame = self._buffer("frame", (moments + 1, 3), np.float32)
        self.depth = self._buffer("depth", ((moments + 1) * self.size**2,), np.float32)
        self.coarse = self._buffer("coarse", ((moments + 1) * summary,), np.float32)
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
        at_home = loaded.home.kept(palettes)
        own, home = ~at_home, at_home
        if self._backend.on_host:
            last = np.zeros(at_home.shape[1], np.bool_)
            last[[] if rests is None else rests] = True
            own = np.concatenate([own, last & own[:1]])
            home = np.concatenate([home, last & home[:1]])
        source = np.append(np.arange(self.count), 0)[: len(own)].astype(np.int32)  # what rests is as at first
        self._cast_own(loaded, position, own, source)
        if self.home_size > 1:
            self._cast_home(loaded, position, home, source)

    def _cast_own(
        self, loaded: Loaded, position: Any, member: NDArray[np.bool_], source: NDArray[np.int32]
    ) -> None:
        a, up, light, maps = loaded.arrays, self._backend.upload, self._light, len(member)
        crew = self._backend.crew
        things = (position, a["basis"], a["entry"], up(member.astype(np.int32)), up(source))
        vertices = loaded.scene.detail.vertices
        light.fit(*things, TEXEL, self.size, vertices, maps, self.frame, *crew(maps))
        self._cast(loaded, things, (self.frame, self.size, maps, self.depth), self.coarse)

    def _cast_home(
        self, loaded: Loaded, position: Any, member: NDArray[np.bool_], source: NDArray[np.int32]
    ) -> None:
        """Each home map once, and none if those that are there will do."""
        casting = member & loaded.home.casts
        members, first, which = np.unique(casting, axis=0, return_index=True, return_inverse=True)
        maps = len(members)
        self.home = self._backend.upload(which.reshape(-1).astype(np.int32))
        self._reserve_home(maps)
        wanted = (loaded.home, self.home_size)
        if wanted == self._cast_for and np.array_equal(members, self._members):
            return
        a, up = loaded.arrays, self._backend.upload
        frames = np.tile(np.array(loaded.home.frame(self.home_size), np.float32), (maps, 1))
        self.home_frame = up(frames)
        things = (position, a["basis"], a["entry"], up(members.astype(np.int32)), up(source[first]))
        target = (self.home_frame, self.home_size, maps, self.home_depth)
        self._cast(loaded, things, target, self.home_coarse)
        self._members, self._cast_for = members, wanted

    def _cast(
        self, loaded: Loaded, things: tuple[Any, ...], target: tuple[Any, int, int, Any], coarse: Any
    ) -> None:
        a, scene, (_, size, maps, _) = loaded.arrays, loaded.scene, target
        name = "blur" if size == self.size else "home_blur"
        blur = self._buffer(name, (maps * self._light.summary_size(size),), np.float32)
        casters = (a["faces"], a["casters"], scene.closed_casters, loaded.static_vertices)
        self._light.cast(*things, *casters, *target, blur, coarse, *self._backend.crew(maps))

    @property
    def maps(self) -> tuple[Any, ...]:
        """What kernels ask for that look into both."""
        homes = (self.home, self.home_frame, self.home_size, self.home_depth, self.home_coarse)
        return (self.frame, self.size, self.depth, self.coarse, *homes)

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
