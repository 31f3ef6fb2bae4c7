"""Triangles on the screen into visibility buffers: sixteen rows, then sixteen pixels at a time, on the host.

Same arithmetic as ``geometry.fill``, operation by operation: same buffers to the last bit. On vectors, see
``gather``.
"""

# mypy: ignore-errors
# Taichi reads annotations as kernel types and parses the bodies itself.

import taichi as ti

from . import crew
from .gather import BUNDLE, CORNERS, EVEN, LANE_BITS, LANES, TAGS, I, V, fv, iv
from .geometry import FAINTEST, NEAR, f1, greater, i1, i2, lesser, u32s, u64s

uv = ti.types.ndarray(dtype=ti.types.vector(LANES, ti.u32), ndim=1)
qv = ti.types.ndarray(dtype=ti.types.vector(LANES, ti.u64), ndim=1)


@ti.func
def pixels(x, limit):
    """geometry.to_pixel of sixteen numbers, kept between 0 and ``limit``."""
    x = ti.select(x < 0.0, V(0.0), x)
    x = ti.select(x > limit + 1.0, V(limit + 1.0), x) - 0.5
    whole = (x + EVEN) - EVEN
    whole = ti.select(whole < x, whole + 1.0, whole)
    return ti.select(whole > limit, V(limit), whole)


@ti.kernel
def paint(
    corner: f1,
    tag: i1,
    counts: i2,
    extent: i1,
    most: ti.i32,
    line: fv,
    number: f1,
    depth: fv,
    owner: iv,
    bits: uv,
    owners: uv,
    keep: ti.template(),
    empty: i1,
    empty_bits: uv,
    empty_owners: uv,
    touched: i1,
    vis: qv,
    bit: u32s,
    one: u32s,
    vis_one: u64s,
    even: ti.template(),
    views: ti.i32,
    width: ti.i32,
    height: ti.i32,
    rows: ti.i32,
    queue: i1,
    slots: ti.i32,
    workers: ti.i32,
):
    """Fill the visibility buffers from what :func:`gather` found, ``rows`` rows of a view at a time.

    line, number: scratch [workers * 3], the same memory; depth, owner: scratch of each worker, rows of whole
    LANES; bits, owners and bit, one: the same memory
    keep: whether these are empty sets, to be kept in ``empty_bits`` and ``empty_owners``; others begin from
    the ``empty`` [views] set of that number, and note the groups they touch, or with nothing where it is -1
    even: whether LANES divides the width; then ``vis`` is written, else ``vis_one``, the same memory
    """
    for slot in range(slots):
        worker = slot // (slots // workers)
        lanes = V(0.0)
        for k in ti.static(range(LANES)):
            lanes[k] = float(k)
        groups = (width + LANES - 1) // LANES
        limit = ti.cast(width, ti.f32)
        bands = (height + rows - 1) // rows
        own = worker * rows * groups
        task = crew.task(slot, views * bands, queue, True)
        if task < views * bands:
            n = task // bands
            y_from = (task % bands) * rows
            y_to = ti.min(height, y_from + rows)
            begin = -1
            if ti.static(not keep):
                begin = empty[n]
            if begin >= 0 and ti.static(not keep):
                begin = (begin * height + y_from) * groups
                for i in range((y_to - y_from) * groups):
                    touched[(n * height + y_from) * groups + i] = 0
                    bits[own + i] = empty_bits[begin + i]
                    owners[own + i] = empty_owners[begin + i]
            else:
                for i in range(own, own + (y_to - y_from) * groups):
                    depth[i] = V(0.0)
                    owner[i] = I(0)
            over = begin >= 0
            mark = (n * height + y_from) * groups - own
            bundles = (2 * most + BUNDLE - 1) // BUNDLE * n
            for bundle in range((counts[n, 0] + BUNDLE - 1) // BUNDLE):
                at = (bundles + bundle) * 2
                if extent[at] >= y_to or extent[at + 1] <= y_from:
                    continue
                bundle_end = ti.min(counts[n, 0], bundle * BUNDLE + BUNDLE)
                for k in range(n * 2 * most + bundle * BUNDLE, n * 2 * most + bundle_end):
                    y = ti.max(tag[k * TAGS + 1], y_from)
                    y_end = ti.min(tag[k * TAGS + 2], y_to)
                    if y >= y_end:
                        continue
                    at = k * CORNERS
                    ax, ay, az = corner[at], corner[at + 1], corner[at + 2]
                    bx, by, bz = corner[at + 3], corner[at + 4], corner[at + 5]
                    cx, cy, cz = corner[at + 6], corner[at + 7], corner[at + 8]
                    t = tag[k * TAGS]
                    planar = t < 0
                    t = ti.abs(t)
                    plane_x, plane_y, plane_z = az, bz, cz
                    if ay > by:
                        ax, bx = bx, ax
                        ay, by = by, ay
                        az, bz = bz, az
                    if by > cy:
                        bx, cx = cx, bx
                        by, cy = cy, by
                        bz, cz = cz, bz
                    if ay > by:
                        ax, bx = bx, ax
                        ay, by = by, ay
                        az, bz = bz, az
                    abx, aby, abz = bx - ax, by - ay, bz - az
                    acx, acy, acz = cx - ax, cy - ay, cz - az
                    bcx, bcy = cx - bx, cy - by
                    det = abx * acy - acx * aby
                    if det != 0:
                        inverse = 1.0 / det
                        slope_x = (abz * acy - acz * aby) * inverse
                        slope_y = (acz * abx - abz * acx) * inverse
                        least = lesser(lesser(az, bz), cz)
                        nearest = greater(greater(az, bz), cz)
                        known_x, known_y, known_z = ax, ay, az
                        if planar:
                            slope_x, slope_y = plane_x, plane_y
                            known_x, known_y, known_z = 0.0, 0.0, plane_z
                            least, nearest = FAINTEST, 1.0 / NEAR
                        long = acx / acy
                        upper = abx / aby if aby > 0 else 0.0
                        lower = bcx / bcy if bcy > 0 else 0.0
                        while y < y_end:
                            # sixteen rows at once: where spans begin and end, 1/z before the first pixel
                            centre = ti.cast(y, ti.f32) + lanes + 0.5
                            xa = ax + (centre - ay) * long
                            xb = ti.select(
                                centre >= by, bx + (centre - by) * lower, ax + (centre - ay) * upper
                            )
                            line[3 * worker] = pixels(ti.select(xa < xb, xa, xb), limit)
                            line[3 * worker + 1] = pixels(ti.select(xa > xb, xa, xb), limit)
                            line[3 * worker + 2] = (
                                known_z + (centre - known_y) * slope_y + (0.5 - known_x) * slope_x
                            )
                            start = own + (y - y_from) * groups
                            for j in range(3 * worker * LANES, 3 * worker * LANES + ti.min(LANES, y_end - y)):
                                from_x, to_x = number[j], number[j + LANES]
                                if from_x < to_x:
                                    row = number[j + 2 * LANES]
                                    g = ti.cast(from_x, ti.i32) >> LANE_BITS
                                    g_end = (ti.cast(to_x, ti.i32) + LANES - 1) >> LANE_BITS
                                    while g < g_end:
                                        if ti.static(not keep):  # noqa: SIM102
                                            if over:
                                                touched[mark + start + g] = 1
                                        xs = ti.cast(g << LANE_BITS, ti.f32) + lanes
                                        w = row + xs * slope_x
                                        w = ti.select(w < least, V(least), w)
                                        w = ti.select(w > nearest, V(nearest), w)
                                        w = ti.select(xs < from_x, V(-1.0), w)
                                        w = ti.select(xs >= to_x, V(-1.0), w)
                                        old, before = depth[start + g], owner[start + g]
                                        tie = ti.select(before < t, I(t), before)
                                        after = ti.select(w > old, I(t), before)
                                        owner[start + g] = ti.select(w == old, tie, after)
                                        depth[start + g] = ti.select(w > old, w, old)
                                        g += 1
                                start += groups
                            y += LANES
            if ti.static(keep):
                begin = (n * height + y_from) * groups
                for i in range((y_to - y_from) * groups):
                    empty_bits[begin + i] = bits[own + i]
                    empty_owners[begin + i] = owners[own + i]
            if ti.static(even):
                base = (n * height + y_from) * groups
                for i in range((y_to - y_from) * groups):
                    vis[base + i] = (ti.cast(bits[own + i], ti.u64) << 32) | ti.cast(owners[own + i], ti.u64)
            else:
                for yy in range(y_to - y_from):
                    base = (n * height + y_from + yy) * width
                    start = (own + yy * groups) * LANES
                    for x in range(width):
                        vis_one[base + x] = (ti.cast(bit[start + x], ti.u64) << 32) | ti.cast(
                            one[start + x], ti.u64
                        )
