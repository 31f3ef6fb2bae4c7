"""Kernels to call in tests: Taichi needs real annotations, and so a file without postponed ones."""

# mypy: ignore-errors

import taichi as ti

from runtime.raster.kernels.light import lit

f1, i1 = ti.types.ndarray(ti.f32, ndim=1), ti.types.ndarray(ti.i32, ndim=1)
f2 = ti.types.ndarray(ti.f32, ndim=2)


@ti.kernel
def scaled(a: f1, by: ti.f32, plus: ti.i32, twice: ti.template(), out: f1):
    for i in range(a.shape[0]):
        out[i] = a[i] * by + plus
        if ti.static(twice):
            out[i] *= 2


@ti.kernel
def total(a: i1) -> ti.i32:
    found = 0
    for i in range(a.shape[0]):
        found += a[i]
    return found


@ti.data_oriented
class Counter:
    def __init__(self, step):
        self.step = step

    @ti.kernel
    def stepped(self, x: ti.i32) -> ti.i32:
        return x + self.step


@ti.kernel
def light_at(at: f2, frame: f2, size: ti.i32, depth: f1, coarse: f1, out: f1):
    for i in range(at.shape[0]):
        out[i] = lit(ti.Vector([at[i, 0], at[i, 1], at[i, 2]]), 0, frame, size, depth, coarse)


@ti.func
def halved(x):
    return x / unheard_of  # noqa: F821


@ti.kernel
def lost(x: ti.f32) -> ti.f32:
    return halved(halved(x))


@ti.func
def grown(x, by: ti.template()):
    out = x
    for k in ti.static(range(by)):
        out += ti.static(k if by > 2 else 10)
    return out


@ti.kernel
def grown_twice(x: ti.i32) -> ti.i32:
    return grown(grown(x, 2), 4)


@ti.func
def powers(x, n: ti.template()):
    out = x
    if ti.static(n > 0):
        out = out + powers(x, n - 1) * x
    return out


@ti.kernel
def polynomial(x: ti.i32) -> ti.i32:
    return powers(x, 3)


@ti.kernel
def highest() -> ti.u64:
    return ti.u64(0xFFFFFFFFFFFFFFFF)


@ti.kernel
def beyond() -> ti.i32:
    return 0x1FFFFFFFF
