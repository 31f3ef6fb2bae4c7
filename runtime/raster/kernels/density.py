"""How much surface there is in each cell of a volume."""

# mypy: ignore-errors
# Taichi reads annotations as kernel types and parses the bodies itself.

import taichi as ti

d1 = ti.types.ndarray(ti.f64, ndim=1)
d3 = ti.types.ndarray(ti.f64, ndim=3)
i1 = ti.types.ndarray(ti.i32, ndim=1)
SIDES = 2  # lower and upper corners along the first axis: a thread each


@ti.func
def _add(p, low: d1, high: d1, cell: ti.f64, area: ti.f64, side, shape, cells, out: d1):
    """Share ``area`` at ``p`` out to four of the eight cells around, each in a volume of its own."""
    inside = True
    for a in ti.static(range(3)):
        inside = inside and p[a] > low[a] and p[a] < high[a]
    if inside:
        where = ti.Vector([(p[a] - low[a]) / cell for a in ti.static(range(3))], dt=ti.f64)
        base = ti.floor(where)
        part = where - base
        at = ti.cast(base, ti.i32)
        one = ti.cast(1.0, ti.f64)
        across = part[0] if side == 1 else one - part[0]
        for j, k in ti.static(ti.ndrange(2, 2)):
            share = across * (part[1] if j == 1 else one - part[1]) * (part[2] if k == 1 else one - part[2])
            index = ((at[0] + side) * shape[1] + at[1] + j) * shape[2] + at[2] + k
            out[((2 * side + j) * 2 + k) * cells + index] += share * area


@ti.kernel
def spread(
    corner: d3,
    area: d1,
    steps: i1,
    count: ti.i32,
    third: ti.f64,
    low: d1,
    high: d1,
    cell: ti.f64,
    nx: ti.i32,
    ny: ti.i32,
    nz: ti.i32,
    out: d1,
):
    """Add the area of ``count`` triangles to the cells that they pass, ``out`` [8, cells], one volume for
    each corner around a point.

    corner: [F, 3, 3], a corner and the edges from it; area: of each of the steps^2 small triangles it is
    cut into; third: 1/3. A volume is added up by one thread, in the order of the triangles: whoever adds up
    in that order gets the same bits.
    """
    ti.loop_config(block_dim=1)
    for side in range(SIDES):
        shape = ti.Vector([nx, ny, nz])
        for f in range(count):
            n = steps[f]
            a = ti.Vector([corner[f, 0, k] for k in ti.static(range(3))], dt=ti.f64)
            u = ti.Vector([corner[f, 1, k] for k in ti.static(range(3))], dt=ti.f64)
            v = ti.Vector([corner[f, 2, k] for k in ti.static(range(3))], dt=ti.f64)
            for turned in range(2):
                off = third * ti.cast(1 + turned, ti.f64)
                for i in range(n):
                    s = (ti.cast(i, ti.f64) + off) / ti.cast(n, ti.f64)
                    for j in range(n - i - turned):
                        t = (ti.cast(j, ti.f64) + off) / ti.cast(n, ti.f64)
                        _add(a + s * u + t * v, low, high, cell, area[f], side, shape, nx * ny * nz, out)
