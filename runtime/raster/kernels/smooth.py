"""Smoothing: stair-steps beside marked pixels evened out, then bytes; and object ids.

Finds the direction of the luma edge through a pixel, walks along it to both ends, and takes the line between
the ends as the true edge, as morphological anti-aliasing does (Reshetov 2009); where triangles tell where the
edge passes, they are believed instead (see ``edges``). ``smooth_rows`` goes pixel by pixel; ``smooth_runs``
does the same on the host, much of it by vectors of sixteen (see ``gather``), and gives the same bytes.
"""

# mypy: ignore-errors
# Taichi reads annotations as kernel types and parses the bodies itself.

import taichi as ti

from . import crew
from .edges import moved, scaled_down
from .gather import LANES, I, V, fv, iv
from .geometry import f1, greater, i1, lesser, u8s, u32s
from .paint import INK, NOTHING, SMOOTH, decode
from .paint import RUN as BLOCK

SEARCH = 9  # pixels looked along an edge, either way
LEAST = 0.004  # of a pixel that comes from others: less does not show
VISIBLE = 0.25  # of a step of luma: a smaller change is not made
TWO_STEPS, ONE_STEP = 0.32, 0.401  # more than the share of an edge whose nearer end is that far away
SCRATCH = 5  # vectors that a worker of smooth_runs needs
UPRIGHT, BACK = 1, 2  # an edge goes up and down; the pixel's other side is above it, or on its left

B = ti.types.vector(LANES, ti.u8)
bv = ti.types.ndarray(dtype=B, ndim=1)


@ti.func
def luma(c):
    return ti.cast(c >> 24, ti.i32)


@ti.func
def number(c):
    """The luma of a colour as it is compared with others."""
    return ti.cast(luma(c), ti.f32)


@ti.func
def distance(a, b):
    return ti.select(a < b, b - a, a - b)


@ti.func
def reencode(light, table: ti.template()):
    """paint.encode without the luma, for what is between 0 and 1."""
    r = table[ti.cast(light.x * 4095.0 + 0.5, ti.i32)]
    g = table[ti.cast(light.y * 4095.0 + 0.5, ti.i32)]
    b = table[ti.cast(light.z * 4095.0 + 0.5, ti.i32)]
    return r | (g << 8) | (b << 16)


@ti.func
def blended(c, other, share, linear: ti.template(), table: ti.template()):
    """Bytes of a colour with a share of another."""
    a = decode(c, linear)
    return reencode(a + (decode(other, linear) - a) * share, table)


@ti.func
def enough(high):
    """Least difference of the luma around a pixel from which on a stair-step shows."""
    return 8.0 + high * 0.05


@ti.func
def lone_share(n, s, w, e, nw, ne, sw, se, m, contrast, one):
    """How much is taken of the other side because a pixel stands out alone."""
    beside = 2.0 * (n + s + w + e) + nw + ne + sw + se
    lone = distance(beside, 12.0 * m) / (12.0 * contrast)
    lone = lesser(lone, one)
    lone = lone * lone * (3.0 - 2.0 * lone)
    return lone * lone * 0.6


@ti.func
def flatness(n, s, w, e, nw, ne, sw, se, m):
    """How much luma bends from row to row, and from column to column."""
    flat = distance(nw + sw, 2.0 * w) + 2.0 * distance(n + s, 2.0 * m) + distance(ne + se, 2.0 * e)
    steep = distance(nw + ne, 2.0 * n) + 2.0 * distance(w + e, 2.0 * m) + distance(sw + se, 2.0 * s)
    return flat, steep


@ti.func
def edge_share(x, y, at, width, height, kind, m, other, src: ti.template()):
    """How much of the pixel is on the other side of the edge, half a pixel at most.

    kind: UPRIGHT, BACK; m, other: luma of the pixel and of the one across the edge
    """
    share = 0.0
    upright = kind & UPRIGHT != 0
    along = ti.select(upright, width, 1)
    across = ti.select(upright, 1, width)
    across = ti.select(kind & BACK != 0, -across, across)
    place = ti.select(upright, y, x)
    length = ti.select(upright, height, width)
    room_low, room_high = lesser(SEARCH, place - 1), lesser(SEARCH, length - 2 - place)
    jump, middle = distance(other, m), m + other  # twice the luma on the edge
    # the edge goes on while twice what is above and below it is within [least, least + span)
    least, span = 2 * middle - jump + 1, ti.cast(2 * jump - 1, ti.u32)
    # both ways at once: the nearer end says whether the edge bends over this pixel
    room = lesser(room_low, room_high)
    step, p, q = 0, at, at
    low, high = middle, middle
    low_ended, high_ended = 0, 0
    while step < room and (low_ended | high_ended) == 0:
        step += 1
        p -= along
        q += along
        low = luma(src[p]) + luma(src[p + across])
        high = luma(src[q]) + luma(src[q + across])
        low_ended = ti.select(ti.cast(2 * low - least, ti.u32) >= span, 1, 0)
        high_ended = ti.select(ti.cast(2 * high - least, ti.u32) >= span, 1, 0)
    low_ended |= ti.select(step == room_low, 1, 0)
    high_ended |= ti.select(step == room_high, 1, 0)
    nearest = ti.select(high_ended == 1, high, low)
    if (nearest < middle) != (2 * m < middle) and (low_ended & high_ended) == 0:
        room = ti.select(high_ended == 1, room_low, room_high)
        p = ti.select(high_ended == 1, p, q)
        along = ti.select(high_ended == 1, -along, along)
        far = step
        ended = 0
        while far < room and ended == 0:
            far += 1
            p += along
            beside = luma(src[p]) + luma(src[p + across])
            ended = ti.select(ti.cast(2 * beside - least, ti.u32) >= span, 1, 0)
        share = 0.5 - ti.cast(step, ti.f32) / ti.cast(step + far, ti.f32)
    return share


@ti.func
def other_side(at, width, kind):
    """The pixel across the edge."""
    away = ti.select(kind & UPRIGHT != 0, 1, width)
    return at + ti.select(kind & BACK != 0, -away, away)


@ti.func
def moving(e, first_moving):
    """Whether what is seen in a pixel of the edge buffer moves."""
    return ti.cast(e >> 16, ti.i32) >= first_moving and e != ti.u32(NOTHING)


@ti.func
def drawn_to_edges(
    x,
    y,
    at,
    width,
    height,
    moves,
    src: ti.template(),
    edges: ti.template(),
    fine,
    linear: ti.template(),
    table: ti.template(),
):
    """A pixel moved with the edges near it, and whether these are known; fine: 0 if none are."""
    a, b, c, d = 0.0, 0.0, 0.0, 0.0
    beside, upright = False, False
    if fine != 0:
        # lines of what moves are up to two pixels wide
        reach = 2 if moves else 1
        a, b, beside = moved(at, 1, 0, x, width - 1 - x, reach, edges)
        c, d, upright = moved(at, width, 8, y, height - 1 - y, reach, edges)
    out = src[at]
    if a + b + c + d > LEAST:
        own = decode(out, linear)
        q = scaled_down(a, b, c, d)
        mixed = own
        if a > 0:
            mixed += (decode(src[at - 1], linear) - own) * (a * q)
        if b > 0:
            mixed += (decode(src[at + 1], linear) - own) * (b * q)
        if c > 0:
            mixed += (decode(src[at - width], linear) - own) * (c * q)
        if d > 0:
            mixed += (decode(src[at + width], linear) - own) * (d * q)
        out = reencode(mixed, table)
    return out, beside or upright


@ti.func
def smoothed(
    x,
    y,
    at,
    width,
    height,
    moves,
    src: ti.template(),
    edges: ti.template(),
    fine,
    linear: ti.template(),
    table: ti.template(),
):
    """A pixel blended over an edge by how far the true edge passes from its centre."""
    c = src[at]
    out = c
    if 0 < x < width - 1 and 0 < y < height - 1:
        m = number(c)
        n, s = number(src[at - width]), number(src[at + width])
        w, e = number(src[at - 1]), number(src[at + 1])
        low = lesser(lesser(lesser(n, s), lesser(w, e)), m)
        high = greater(greater(greater(n, s), greater(w, e)), m)
        if high - low > enough(high):
            out, known = drawn_to_edges(x, y, at, width, height, moves, src, edges, fine, linear, table)
            if not known:
                out = c
                nw, ne = number(src[at - width - 1]), number(src[at - width + 1])
                sw, se = number(src[at + width - 1]), number(src[at + width + 1])
                share = lone_share(n, s, w, e, nw, ne, sw, se, m, high - low, 1.0)
                flat, steep = flatness(n, s, w, e, nw, ne, sw, se, m)
                kind = UPRIGHT if steep > flat else 0
                before, after = ti.select(steep > flat, w, n), ti.select(steep > flat, e, s)
                other = after
                if distance(before, m) >= distance(after, m):
                    kind |= BACK
                    other = before
                own, beyond = ti.cast(m, ti.i32), ti.cast(other, ti.i32)
                share = greater(share, edge_share(x, y, at, width, height, kind, own, beyond, src))
                if share * distance(other, m) > VISIBLE:
                    out = blended(c, src[other_side(at, width, kind)], share, linear, table)
    return out


@ti.func
def near_marks(line, y, b, blocks, height, marks: ti.template()):
    """Bits of the pixels of a block that are marked or have a marked neighbour."""
    out = 0
    for i in ti.static(range(-1, 2)):
        if 0 <= b + i < blocks:
            k = line * blocks + b + i
            bits = marks[k]
            if y > 0:
                bits |= marks[k - blocks]
            if y < height - 1:
                bits |= marks[k + blocks]
            if ti.static(i == 0):
                out |= bits | (bits << 1) | (bits >> 1)
            elif ti.static(i < 0):
                out |= bits >> (BLOCK - 1)
            else:
                out |= bits << (BLOCK - 1)
    return out & ((1 << BLOCK) - 1)


@ti.kernel
def smooth_rows(
    first_moving: ti.i32,
    edge: u32s,
    edges: i1,
    fine: ti.i32,
    src: u32s,
    marks: i1,
    level: i1,
    linear: f1,
    table: u32s,
    final: u8s,
    views: ti.i32,
    width: ti.i32,
    height: ti.i32,
    queue: i1,
    slots: ti.i32,
    host: ti.template(),
):
    """Final bytes of the picture, smoothed where something ends."""
    for slot in range(slots):
        line = crew.task(slot, views * height, queue, host)
        if line < views * height:
            y = line % height
            blocks = (width + BLOCK - 1) // BLOCK
            for b in range(blocks):
                if level[line * blocks + b] < SMOOTH:
                    continue
                bits = near_marks(line, y, b, blocks, height, marks)
                for x in range(b * BLOCK, ti.min(width, b * BLOCK + BLOCK)):
                    at = line * width + x
                    c = src[at]
                    if bits & 1:
                        moves = moving(edge[at], first_moving)
                        c = smoothed(x, y, at, width, height, moves, src, edges, fine, linear, table)
                    bits >>= 1
                    final[3 * at] = ti.cast(c & 0xFF, ti.u8)
                    final[3 * at + 1] = ti.cast((c >> 8) & 0xFF, ti.u8)
                    final[3 * at + 2] = ti.cast((c >> 16) & 0xFF, ti.u8)


@ti.func
def from_left(row, first):
    """A row moved to the right by a pixel, with a number before it."""
    out = V(0.0)
    out[0] = first
    for k in ti.static(range(LANES - 1)):
        out[k + 1] = row[k]
    return out


@ti.func
def from_right(row, last):
    """A row moved to the left by a pixel, with a number after it."""
    out = V(0.0)
    for k in ti.static(range(LANES - 1)):
        out[k] = row[k + 1]
    out[LANES - 1] = last
    return out


@ti.func
def numbers(colors, slot, bits: ti.template(), of_bits: ti.template()):
    """The luma of sixteen colours, as :func:`number`; casts of vectors do not compile, but memory does it.

    bits, of_bits: the same memory
    """
    # the lowest bits of 2^23 count ones; a slot is read once a turn, as what is read twice is not read anew
    bits[slot] = (colors >> 24) & 255 | 0x4B000000
    return of_bits[slot] - 8388608.0


@ti.func
def any_bits(row):
    """Bits of all sixteen numbers together."""
    out = 0
    for k in ti.static(range(LANES)):
        out |= row[k]
    return out


@ti.func
def pack(k, from_bytes: ti.template(), to_bytes: ti.template()):
    """The colours of a run without what is in their fourth byte: four vectors become three."""
    for i in ti.static(range(3)):
        out = B(0)
        for q in ti.static(range(4)):
            given = from_bytes[4 * k + q]
            for j in ti.static(range(LANES)):
                if ti.static((LANES * i + j) // 12 == q):
                    out[j] = given[ti.static((LANES * i + j) % 12 // 3 * 4 + (LANES * i + j) % 3)]
        to_bytes[3 * k + i] = out


@ti.kernel
def smooth_runs(
    first_moving: ti.i32,
    edge: u32s,
    edges: i1,
    fine: ti.i32,
    told: i1,
    src: u32s,
    row: iv,
    quarter: bv,
    marks: i1,
    level: i1,
    linear: f1,
    table: u32s,
    scratch: fv,
    bits_of: iv,
    found: f1,
    final: u8s,
    third: bv,
    views: ti.i32,
    width: ti.i32,
    height: ti.i32,
    queue: i1,
    slots: ti.i32,
    workers: ti.i32,
):
    """As smooth_rows, for widths that LANES divides.

    told: three words of each run that was inked, the last one a bit for each pixel that moves (``borders``)
    row, quarter: the memory of ``src``; third: that of ``final``; scratch, bits_of, found: SCRATCH vectors of
    each worker, the same memory
    """
    for slot in range(slots):
        bit = I(0)
        for k in ti.static(range(LANES)):
            bit[k] = 1 << k
        own = SCRATCH * (slot // (slots // workers))
        runs = width // LANES
        last = views * height * width - 1
        line = crew.task(slot, views * height, queue, True)
        if line < views * height:
            y = line % height
            for b in range(runs):
                k = line * runs + b
                if level[k] < SMOOTH:
                    continue
                pack(k, quarter, third)
                bits = 0
                if 0 < y < height - 1:
                    bits = near_marks(line, y, b, runs, height, marks)
                    bits &= 0xFFFE if b == 0 else 0xFFFF
                    bits &= 0x7FFF if b == runs - 1 else 0xFFFF
                if bits == 0:
                    continue
                begin = k * LANES
                m = numbers(row[k], own, bits_of, scratch)
                n = numbers(row[k - runs], own + 1, bits_of, scratch)
                s = numbers(row[k + runs], own + 2, bits_of, scratch)
                w = from_left(m, number(src[begin - 1]))
                e = from_right(m, number(src[begin + LANES]))
                low = lesser(lesser(lesser(n, s), lesser(w, e)), m)
                high = greater(greater(greater(n, s), greater(w, e)), m)
                bits &= any_bits(ti.select(high - low > enough(high), bit, I(0)))
                if bits == 0:
                    continue
                nw = from_left(n, number(src[ti.max(begin - width - 1, 0)]))
                ne = from_right(n, number(src[begin - width + LANES]))
                sw = from_left(s, number(src[begin + width - 1]))
                se = from_right(s, number(src[ti.min(begin + width + LANES, last)]))
                alone = lone_share(n, s, w, e, nw, ne, sw, se, m, high - low, V(1.0))
                flat, steep = flatness(n, s, w, e, nw, ne, sw, se, m)
                before, after = ti.select(steep > flat, w, n), ti.select(steep > flat, e, s)
                back = distance(before, m) - distance(after, m)
                other = ti.select(back >= 0.0, before, after)
                jump, middle = distance(other, m), m + other
                # the first step along the edge says of most pixels that there is nothing to walk for
                low_other = ti.select(back >= 0.0, nw, ti.select(steep > flat, ne, sw))
                high_other = ti.select(back >= 0.0, ti.select(steep > flat, sw, ne), se)
                end_low = ti.select(steep > flat, n, w) + low_other
                end_high = ti.select(steep > flat, s, e) + high_other
                low_ended = ti.select(2.0 * distance(end_low, middle) >= jump, I(1), I(0))
                high_ended = ti.select(2.0 * distance(end_high, middle) >= jump, I(1), I(0))
                nearest = ti.select(2.0 * distance(end_high, middle) >= jump, end_high, end_low)
                sides = ti.select(nearest < middle, I(1), I(0)) + ti.select(2.0 * m < middle, I(1), I(0))
                # one end, and the edge bends over the pixel; or none yet
                walk = ti.select(low_ended + high_ended + 2 * sides == 3, bit, I(0))
                walk = ti.select(alone < ONE_STEP, walk, I(0))
                further = ti.select(low_ended + high_ended == 0, bit, I(0))
                walk |= ti.select(alone < TWO_STEPS, further, I(0))
                walks = any_bits(walk)
                # near the border of the picture edges may end where they begin
                if y < 2 or y > height - 3:
                    walks = 0xFFFF
                walks |= 2 if b == 0 else 0
                walks |= 0x4000 if b == runs - 1 else 0
                seen = any_bits(ti.select(alone * jump > VISIBLE, bit, I(0)))
                scratch[own + 3] = alone
                of = ti.select(steep > flat, V(UPRIGHT), V(0.0)) + ti.select(back >= 0.0, V(BACK), V(0.0))
                scratch[own + 4] = of + m * 4.0 + other * 1024.0
                stepped = walks | seen
                here_moves = told[3 * k + 2]
                if level[k] < INK and fine != 0:
                    here_moves = 0
                    for i in range(LANES):
                        if moving(edge[begin + i], first_moving):
                            here_moves |= 1 << i
                while bits != 0:
                    i = 31 - ti.math.clz(bits)
                    bits ^= 1 << i
                    at = begin + i
                    x = b * LANES + i
                    moves = (here_moves >> i) & 1 == 1
                    c, known = drawn_to_edges(x, y, at, width, height, moves, src, edges, fine, linear, table)
                    if not known:
                        c = src[at]
                        if (stepped >> i) & 1:
                            much = found[(own + 3) * LANES + i]
                            what = ti.cast(found[(own + 4) * LANES + i], ti.i32)
                            here, beyond = (what >> 2) & 255, what >> 10
                            if (walks >> i) & 1:
                                share = edge_share(x, y, at, width, height, what, here, beyond, src)
                                much = greater(much, share)
                            if much * ti.cast(distance(beyond, here), ti.f32) > VISIBLE:
                                c = blended(c, src[other_side(at, width, what)], much, linear, table)
                    final[3 * at] = ti.cast(c & 0xFF, ti.u8)
                    final[3 * at + 1] = ti.cast((c >> 8) & 0xFF, ti.u8)
                    final[3 * at + 2] = ti.cast((c >> 16) & 0xFF, ti.u8)


@ti.kernel
def object_ids(edge: u32s, owner: i1, out: ti.types.ndarray(ti.i32, ndim=1), count: ti.i32):
    for i in range(count):
        s = ti.cast(edge[i] >> 16, ti.i32)
        out[i] = owner[s] if s != 0xFFFF else -1
