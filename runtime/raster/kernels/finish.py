"""Finishing: ink lines from the edge buffer, then a smoothing of stair-steps, then bytes."""

from functools import lru_cache
from types import SimpleNamespace

import taichi as ti

from ..types import Style
from .geometry import f1, i1, u32s, u64s, vec3

u8s = ti.types.ndarray(ti.u8, ndim=1)


@lru_cache(maxsize=8)
def finish_kernels(style: Style) -> SimpleNamespace:
    """The finishing kernels of a style."""

    @ti.kernel
    def bytes_out(picture: u32s, out: u8s, count: ti.i32):
        for i in range(count):
            c = picture[i]
            out[3 * i] = ti.cast(c & 0xFF, ti.u8)
            out[3 * i + 1] = ti.cast((c >> 8) & 0xFF, ti.u8)
            out[3 * i + 2] = ti.cast((c >> 16) & 0xFF, ti.u8)

    @ti.kernel
    def object_ids(edge: u32s, surface_object: i1, out: ti.types.ndarray(ti.i32, ndim=1), count: ti.i32):
        for i in range(count):
            s = ti.cast(edge[i] >> 16, ti.i32)
            out[i] = surface_object[s] if s != 0xFFFF else -1

    return SimpleNamespace(bytes_out=bytes_out, object_ids=object_ids)
