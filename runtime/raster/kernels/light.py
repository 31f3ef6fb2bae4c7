"""Light: shadow maps of the set and of every moment.

A shadow map keeps, per texel of a plane across the light, the greatest distance towards the light.
``coarse`` keeps the greatest and the least value around each block of FINE x FINE texels, and the greatest
around each of BLOCK x BLOCK: most points are nearer to the light than all of those, or behind them, and
need no further look.
"""

# mypy: ignore-errors
# Taichi reads annotations as kernel types and parses the bodies itself.

from typing import Any

import taichi as ti

from . import crew
from .geometry import bounded, f1, f2, f3, greater, i1, i2, item3, lesser, to_pixel, vec3

BLOCK, BLOCK_BITS = 8, 3  # shifting is quicker than dividing what might be negative
FINE, FINE_BITS = 4, 2
NOWHERE = -1e9
FAR_OFF = 1e6  # metres, corner of a map that is not there
MASK = 30  # maps of a moment that are told apart, but for one
ALL = (1 << (MASK + 1)) - 1
ROUNDING = 1e-5  # of weights that sum to one
MANY = 256  # blocks of a map that are looked at for one place


@ti.func
def lift_of(texel):
    """How far points are lifted off their surface before a shadow map of that texel is asked, metres."""
    return 0.01 + 1.8 * texel


@ti.func
def rise_of(texel):
    """And how far towards the light."""
    return 0.004 + 0.4 * texel


@ti.func
def lifted(normal, texel):
    """By how much points are lifted off their surface, in light coordinates, before a shadow map of that
    texel is asked. normal: in light coordinates"""
    return normal * lift_of(texel) + vec3(0, 0, rise_of(texel))


@ti.func
def across(basis: ti.template(), p):
    """Light coordinates of a point: two across, one towards the light."""
    return vec3(
        basis[0] * p.x + basis[1] * p.y + basis[2] * p.z,
        basis[3] * p.x + basis[4] * p.y + basis[5] * p.z,
        basis[6] * p.x + basis[7] * p.y + basis[8] * p.z,
    )


def summary_size(size: int) -> int:
    """Numbers in ``coarse`` for each map of size x size texels."""
    return 2 * (size // FINE) ** 2 + (size // BLOCK) ** 2


@ti.kernel
def fit(
    position: f3,
    basis: f1,
    entry: i1,
    member: i2,
    source: i1,
    group: i1,
    points: i1,
    point_end: i1,
    finest: ti.f32,
    size: ti.i32,
    maps: ti.i32,
    frame: f2,
    queue: i1,
    slots: ti.i32,
    host: ti.template(),
):
    """The frame [maps, 3] of each map: its corner across the light, and texels a metre; out of reach for one
    of nothing.

    entry: what moves each vertex; member [maps, P]: 1 for what a map is of; source, group: the moment that
    each map is of, and the group of things; points: vertices that throw shadows, group by group; point_end:
    where those of each group end
    The corner lies on whole texels and the scale on half octaves, so that the map does not swim.
    """
    for slot in range(slots):
        m = crew.task(slot, maps, queue, host)
        if m < maps:
            low = vec3(1e30)
            high = vec3(-1e30)
            g = group[m]
            begin = 0
            if g > 0:
                begin = point_end[g - 1]
            for i in range(begin, point_end[g]):
                v = points[i]
                if member[m, entry[v]] != 0:
                    q = across(basis, item3(position, source[m], v))
                    low = ti.min(low, q)
                    high = ti.max(high, q)
            if low.x > high.x:
                frame[m, 0], frame[m, 1], frame[m, 2] = FAR_OFF, FAR_OFF, 100.0
            else:
                extent = ti.max(high.x - low.x, high.y - low.y, 1e-3)
                texel = finest
                while texel * (size - 8) < extent:
                    texel *= ti.sqrt(2.0)
                frame[m, 0] = (ti.floor(low.x / texel) - 3) * texel
                frame[m, 1] = (ti.floor(low.y / texel) - 3) * texel
                frame[m, 2] = 1.0 / texel


@ti.kernel
def cast(
    position: f3,
    basis: f1,
    entry: i1,
    member: i2,
    source: i1,
    group: i1,
    faces: i2,
    casters: i1,
    runs: i2,
    offset: ti.i32,
    frame: f2,
    size: ti.i32,
    maps: ti.i32,
    depth: f1,
    spare: f1,
    coarse: f1,
    queue: i1,
    slots: ti.i32,
    host: ti.template(),
):
    """Draw the casters into each map (see :func:`fit`), and the coarse map of it; nothing where it is out of
    reach.

    casters: triangles, group by group; runs [G, 3]: where those of each begin, where those of closed shells
    end, which come first (what of these faces away from the light has something above it that faces it), and
    where all of them end
    """
    for slot in range(slots):
        m = crew.task(slot, maps, queue, host)
        if m < maps and frame[m, 0] < FAR_OFF:
            base = m * size * size
            for i in range(size * size):
                depth[base + i] = NOWHERE
            g = group[m]
            low, high = ti.Vector([size, size]), ti.Vector([0, 0])
            for i in range(runs[g, 0], runs[g, 2]):
                closed = i < runs[g, 1]
                begin, end = draw(
                    position,
                    basis,
                    entry,
                    member,
                    source,
                    faces,
                    offset,
                    frame,
                    depth,
                    True,
                    size,
                    casters[i],
                    closed,
                    m,
                )
                low, high = ti.min(low, begin), ti.max(high, end)
            summarise(depth, size, spare, coarse, m, low, high)


@ti.kernel
def cast_atomic(
    position: f3,
    basis: f1,
    entry: i1,
    member: i2,
    source: i1,
    group: i1,
    faces: i2,
    casters: i1,
    runs: i2,
    offset: ti.i32,
    frame: f2,
    size: ti.i32,
    maps: ti.i32,
    depth: f1,
    spare: f1,
    coarse: f1,
):
    """The same as :func:`cast`, a thread a triangle and then a block, for machines of many threads."""
    for i in range(maps * size * size):
        depth[i] = NOWHERE
    for task in range(maps * casters.shape[0]):
        m, i = task // casters.shape[0], task % casters.shape[0]
        g = group[m]
        if frame[m, 0] < FAR_OFF and runs[g, 0] <= i < runs[g, 2]:
            closed = i < runs[g, 1]
            draw(
                position,
                basis,
                entry,
                member,
                source,
                faces,
                offset,
                frame,
                depth,
                False,
                size,
                casters[i],
                closed,
                m,
            )
    for i in range(maps * (size // FINE) * (size // FINE)):
        blocks = (size // FINE) * (size // FINE)
        within_fine(depth, size, spare, i // blocks, i % blocks)
    for i in range(maps * (size // FINE) * (size // FINE)):
        blocks = (size // FINE) * (size // FINE)
        around_fine(size, spare, coarse, i // blocks, i % blocks)
    for i in range(maps * (size // BLOCK) * (size // BLOCK)):
        blocks = (size // BLOCK) * (size // BLOCK)
        around_coarse(size, coarse, i // blocks, i % blocks)


def cast_by(crew_of_maps: tuple[Any, int, bool], *told: Any) -> None:
    """Draw casters into maps as the machine does it best. crew_of_maps: ``Backend.crew`` of as many maps;
    told: what :func:`cast` asks for before it"""
    if crew_of_maps[2]:
        cast(*told, *crew_of_maps)
    else:
        cast_atomic(*told)


@ti.kernel
def differing(
    depth: f1,
    size: ti.i32,
    maps: ti.i32,
    other: ti.i32,
    spare: f1,
    changed: f1,
    queue: i1,
    slots: ti.i32,
    host: ti.template(),
):
    """The greatest height around each coarse block of what is in a map and not in the ``other`` one of them;
    all lie the same way.

    changed: as ``coarse``, of which only that is written; spare: a number for each fine block of each map
    """
    for slot in range(slots):
        m = crew.task(slot, maps, queue, host)
        if m < maps:
            blocks = size // FINE
            own = m * blocks * blocks
            for i in range(blocks * blocks):
                spare[own + i] = NOWHERE
            for y in range(size):
                row = own + (y // FINE) * blocks
                for x in range(size):
                    z = depth[(m * size + y) * size + x]
                    there = depth[(other * size + y) * size + x]
                    if z != there:
                        at = row + x // FINE
                        spare[at] = greater(spare[at], greater(z, there))
            wide = size // BLOCK
            last = m * coarse_size(size) + 2 * blocks * blocks
            for j in range(wide):
                for i in range(wide):
                    most = NOWHERE
                    for y in range(ti.max(0, 2 * j - 2), ti.min(blocks, 2 * j + 4)):
                        for x in range(ti.max(0, 2 * i - 2), ti.min(blocks, 2 * i + 4)):
                            most = greater(most, spare[own + y * blocks + x])
                    changed[last + j * wide + i] = most


@ti.func
def draw(
    position: ti.template(),
    basis: ti.template(),
    entry: ti.template(),
    member: ti.template(),
    source: ti.template(),
    faces: ti.template(),
    offset,
    frame: ti.template(),
    depth: ti.template(),
    alone: ti.template(),
    size,
    t,
    closed,
    m,
):
    """Draw triangle ``t`` into map ``m`` if it is of it; what faces away from the light only if it is of no
    closed shell. Returns the texels it may be in: the first, and the one after the last, across and along."""
    low, high = ti.Vector([size, size]), ti.Vector([0, 0])
    first = faces[t, 0] - offset
    if member[m, entry[first]] != 0:
        a = on_map(position, source[m], first, basis, frame, m)
        b = on_map(position, source[m], faces[t, 1] - offset, basis, frame, m)
        c = on_map(position, source[m], faces[t, 2] - offset, basis, frame, m)
        towards = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y)
        if towards > 0 or not closed:
            stamp(depth, alone, m * size * size, size, a, b, c)
            least, most = ti.min(a, b, c), ti.max(a, b, c)
            for k in ti.static(range(2)):
                # bounded as whole numbers: what is none may be any of those
                low[k] = ti.min(ti.max(ti.cast(least[k] - 1.0, ti.i32), 0), size)
                high[k] = ti.min(ti.max(ti.cast(most[k] + 1.0, ti.i32), 0), size)
    return low, high


@ti.func
def summarise(depth: ti.template(), size, spare: ti.template(), coarse: ti.template(), m, low, high):
    """The greatest and the least height around each fine block of a map, and the greatest around coarse
    ones. low, high: between which texels anything was drawn"""
    blocks, wide, begin = size // FINE, size // BLOCK, m * coarse_size(size)
    for i in range(begin, begin + coarse_size(size)):
        coarse[i] = NOWHERE
    for i in range(begin, begin + 2 * blocks * blocks):
        spare[i] = NOWHERE
    x0, y0 = low.x // FINE, low.y // FINE
    x1, y1 = ti.min(blocks, high.x // FINE + 1), ti.min(blocks, high.y // FINE + 1)
    for j in range(y0, y1):
        for i in range(x0, x1):
            within_fine(depth, size, spare, m, j * blocks + i)
    for j in range(ti.max(0, y0 - 1), ti.min(blocks, y1 + 1)):
        for i in range(ti.max(0, x0 - 1), ti.min(blocks, x1 + 1)):
            around_fine(size, spare, coarse, m, j * blocks + i)
    for j in range(ti.max(0, y0 // 2 - 2), ti.min(wide, y1 // 2 + 2)):
        for i in range(ti.max(0, x0 // 2 - 2), ti.min(wide, x1 // 2 + 2)):
            around_coarse(size, coarse, m, j * wide + i)


@ti.func
def within_fine(depth: ti.template(), size, spare: ti.template(), m, block):
    """The greatest and the least height in a fine block of map ``m``."""
    blocks = size // FINE
    i, j, begin = block % blocks, block // blocks, m * coarse_size(size)
    least, most = 1e9, NOWHERE
    for y in range(j * FINE, j * FINE + FINE):
        for x in range(i * FINE, i * FINE + FINE):
            z = depth[(m * size + y) * size + x]
            least, most = lesser(z, least), greater(z, most)
    spare[begin + block] = most
    spare[begin + blocks * blocks + block] = least


@ti.func
def around_fine(size, spare: ti.template(), coarse: ti.template(), m, block):
    """The same of a fine block and those around it."""
    blocks = size // FINE
    i, j, begin = block % blocks, block // blocks, m * coarse_size(size)
    low = begin + blocks * blocks
    least, most = 1e9, NOWHERE
    for y in range(ti.max(0, j - 1), ti.min(blocks, j + 2)):
        for x in range(ti.max(0, i - 1), ti.min(blocks, i + 2)):
            least = lesser(least, spare[low + y * blocks + x])
            most = greater(most, spare[begin + y * blocks + x])
    coarse[begin + block] = most
    coarse[low + block] = least


@ti.func
def around_coarse(size, coarse: ti.template(), m, block):
    """The greatest height around a coarse block: it is two by two fine ones, and what is around it is four by
    four of what is around those."""
    blocks, wide = size // FINE, size // BLOCK
    i, j, begin = block % wide, block // wide, m * coarse_size(size)
    most = NOWHERE
    for y in range(ti.max(0, 2 * j - 1), ti.min(blocks, 2 * j + 3)):
        for x in range(ti.max(0, 2 * i - 1), ti.min(blocks, 2 * i + 3)):
            most = greater(most, coarse[begin + y * blocks + x])
    coarse[begin + 2 * blocks * blocks + block] = most


@ti.func
def coarse_size(size):
    """How many numbers :func:`summarise` keeps of a map."""
    return 2 * (size // FINE) * (size // FINE) + (size // BLOCK) * (size // BLOCK)


@ti.func
def on_map(position: ti.template(), moment, v, basis: ti.template(), frame: ti.template(), m):
    """A vertex in map ``m``: texels across, metres towards the light."""
    q = across(basis, item3(position, moment, v))
    return vec3((q.x - frame[m, 0]) * frame[m, 2], (q.y - frame[m, 1]) * frame[m, 2], q.z)


@ti.func
def stamp(depth: ti.template(), alone: ti.template(), base, size, a, b, c):
    """Keep the greatest height of one triangle in a map; corners are (x, y, height). alone: whether no other
    thread draws into it"""
    if a.y > b.y:
        a, b = b, a
    if b.y > c.y:
        b, c = c, b
    if a.y > b.y:
        a, b = b, a
    y0 = ti.max(0, ti.cast(to_pixel(a.y), ti.i32))
    y1 = ti.min(size, ti.cast(to_pixel(c.y), ti.i32))
    ab = b - a
    ac = c - a
    bc = c - b
    det = ab.x * ac.y - ac.x * ab.y
    if y0 < y1 and det != 0:
        slope_x = (ab.z * ac.y - ac.z * ab.y) / det
        slope_y = (ac.z * ab.x - ab.z * ac.x) / det
        least = ti.min(a.z, b.z, c.z)
        most = ti.max(a.z, b.z, c.z)
        long = ac.x / ac.y
        upper = ab.x / ab.y if ab.y > 0 else 0.0
        lower = bc.x / bc.y if bc.y > 0 else 0.0
        for y in range(y0, y1):
            centre = ti.cast(y, ti.f32) + 0.5
            xa = a.x + (centre - a.y) * long
            xb = a.x + (centre - a.y) * upper
            if centre >= b.y:
                xb = b.x + (centre - b.y) * lower
            x0 = ti.max(0, ti.cast(to_pixel(ti.min(xa, xb)), ti.i32))
            x1 = ti.min(size, ti.cast(to_pixel(ti.max(xa, xb)), ti.i32))
            row = a.z + (centre - a.y) * slope_y + (0.5 - a.x) * slope_x
            start = base + y * size
            for x in range(x0, x1):
                w = ti.min(ti.max(row + ti.cast(x, ti.f32) * slope_x, least), most)
                if ti.static(alone):
                    if w > depth[start + x]:
                        depth[start + x] = w
                else:
                    ti.atomic_max(depth[start + x], w)


@ti.func
def free_between(a, b, m, frame: ti.template(), size, coarse: ti.template()):
    """Whether nothing within a block of the way between two light coordinates can be in its light."""
    out = True
    if size > 1:
        ax, ay = (a.x - frame[m, 0]) * frame[m, 2], (a.y - frame[m, 1]) * frame[m, 2]
        bx, by = (b.x - frame[m, 0]) * frame[m, 2], (b.y - frame[m, 1]) * frame[m, 2]
        edge = ti.cast(size, ti.f32)
        low, high = ti.cast(-BLOCK, ti.f32), edge + BLOCK
        beside = (ax < low and bx < low) or (ay < low and by < low)
        beside = beside or (ax > high and bx > high) or (ay > high and by > high)
        if not beside:
            blocks, fine = size >> BLOCK_BITS, size >> FINE_BITS
            begin = m * coarse_size(size) + 2 * fine * fine
            z = lesser(a.z, b.z)
            steps = ti.cast(greater(ti.abs(bx - ax), ti.abs(by - ay)) * (1.0 / 12.0), ti.i32) + 1
            share = 1.0 / ti.cast(steps, ti.f32)
            k = 0
            while k <= steps and out:
                part = share * ti.cast(k, ti.f32)
                x, y = ax + (bx - ax) * part, ay + (by - ay) * part
                if low <= x <= high and low <= y <= high:
                    # beyond the border there is nothing, but on the way to the next place there may be
                    i = ti.cast(bounded(x, 0.0, edge - 1), ti.i32) >> BLOCK_BITS
                    j = ti.cast(bounded(y, 0.0, edge - 1), ti.i32) >> BLOCK_BITS
                    out = z >= coarse[begin + j * blocks + i]
                k += 1
    return out


@ti.func
def dimming(a, b, normal, m, each, frame: ti.template(), size, coarse: ti.template()):
    """By which of the ``each`` maps of a moment the light between two light coordinates of a surface may be
    kept off: bits, the last one for all from MASK on."""
    out = 0
    for k in range(each):
        n = m * each + k
        off = lifted(normal, 1.0 / frame[n, 2])
        if not free_between(a + off, b + off, n, frame, size, coarse):
            out |= 1 << ti.min(k, MASK)
    return out


@ti.func
def lit_by_all(
    q,
    normal,
    dim,
    m,
    each,
    frame: ti.template(),
    size,
    depth: ti.template(),
    coarse: ti.template(),
):
    """Share of the light that reaches light coordinates of a surface past those maps of a moment that
    ``dim`` says (see :func:`dimming`)."""
    out = 1.0
    for k in range(each):
        if (dim >> ti.min(k, MASK)) & 1 == 1 and out > 0:
            n = m * each + k
            out *= lit(q + lifted(normal, 1.0 / frame[n, 2]), n, frame, size, depth, coarse)
    return out


@ti.func
def clear_over(low, high, m, frame: ti.template(), size, coarse: ti.template()):
    """Whether nothing can be in the light of all that lies between two light coordinates, as far as
    that can be said from MANY blocks."""
    out = True
    if size > 1:
        left, right = (
            ti.floor((low.x - frame[m, 0]) * frame[m, 2]),
            ti.floor((high.x - frame[m, 0]) * frame[m, 2]),
        )
        below, above = (
            ti.floor((low.y - frame[m, 1]) * frame[m, 2]),
            ti.floor((high.y - frame[m, 1]) * frame[m, 2]),
        )
        edge = ti.cast(size + BLOCK, ti.f32)
        if right >= -BLOCK - 1 and left <= edge + 1 and above >= -BLOCK - 1 and below <= edge + 1:
            # beyond its border there is nothing; what a block says is of what is around it, too
            last = ti.cast(size - 1, ti.f32)
            left, below = bounded(left, 0.0, last), bounded(below, 0.0, last)
            right, above = bounded(right, 0.0, last), bounded(above, 0.0, last)
            blocks, fine = size >> BLOCK_BITS, size >> FINE_BITS
            begin = m * coarse_size(size) + 2 * fine * fine
            i0, i1_ = ti.cast(left, ti.i32) >> BLOCK_BITS, ti.cast(right, ti.i32) >> BLOCK_BITS
            j0, j1 = ti.cast(below, ti.i32) >> BLOCK_BITS, ti.cast(above, ti.i32) >> BLOCK_BITS
            if (i1_ - i0 + 1) * (j1 - j0 + 1) > MANY:
                out = False
            else:
                for j in range(j0, j1 + 1):
                    for i in range(i0, i1_ + 1):
                        if low.z < coarse[begin + j * blocks + i]:
                            out = False
    return out


@ti.func
def lit(q, m, frame: ti.template(), size, depth: ti.template(), coarse: ti.template()):
    """Share of the light that reaches light coordinates ``q``: 4 x 4 comparisons under a B-spline."""
    out = 1.0
    x = (q.x - frame[m, 0]) * frame[m, 2] - 0.5
    y = (q.y - frame[m, 1]) * frame[m, 2] - 0.5
    if 2 <= x < size - 4 and 2 <= y < size - 4:
        i = ti.cast(x, ti.i32)
        j = ti.cast(y, ti.i32)
        blocks = size >> FINE_BITS
        block = m * coarse_size(size) + (j >> FINE_BITS) * blocks + (i >> FINE_BITS)
        if q.z < coarse[block + blocks * blocks]:
            out = 0.0
        elif q.z < coarse[block]:
            fx = x - i
            fy = y - j
            wx = spline(fx)
            wy = spline(fy)
            at = m * size * size + (j - 1) * size + i - 1
            blocked = 0.0
            for b in ti.static(range(4)):
                row = 0.0
                for a in ti.static(range(4)):
                    row += wx[a] if depth[at + b * size + a] > q.z else 0.0
                blocked += row * wy[b]
            # the weights sum to one but for rounding: what all of them keep the light off has none
            out = 1.0 - blocked if blocked < ti.static(1.0 - ROUNDING) else 0.0
    return out


@ti.func
def spline(t):
    """Weights of the uniform cubic B-spline."""
    s = 1.0 - t
    return ti.Vector(
        [
            s * s * s / 6.0,
            (4.0 - 6.0 * t * t + 3.0 * t * t * t) / 6.0,
            (4.0 - 6.0 * s * s + 3.0 * s * s * s) / 6.0,
            t * t * t / 6.0,
        ]
    )
