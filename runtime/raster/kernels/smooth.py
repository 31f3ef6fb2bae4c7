"""Smoothing: stair-steps beside marked pixels evened out, then bytes; and object ids."""

# mypy: ignore-errors
# Taichi reads annotations as kernel types and parses the bodies itself.

import taichi as ti

from .geometry import f1, i1, u8s, u32s
from .paint import RUN as BLOCK
from .paint import SMOOTH, decode, encode

i32s = ti.types.ndarray(ti.i32, ndim=1)
SEARCH = 9  # pixels looked along an edge, either way


@ti.func
def paired(a, b):
    """The bytes of two pixels, 48 bits."""
    return ti.cast(a & 0xFFFFFF, ti.u64) | (ti.cast(b & 0xFFFFFF, ti.u64) << 24)


@ti.func
def luma(c):
    return ti.cast(c >> 24, ti.i32)


@ti.func
def smoothed(x, y, at, width, height, src: ti.template(), linear: ti.template(), table: ti.template()):
    """A pixel blended over a stair-step edge by how far the true edge passes from its centre.

    Finds the direction of the luma edge through the pixel, walks along it to both ends, and takes the
    line between the ends as the true edge, as morphological anti-aliasing does (Reshetov 2009).
    """
    c = src[at]
    out = c
    if 0 < x < width - 1 and 0 < y < height - 1:
        m = luma(c)
        n, s = luma(src[at - width]), luma(src[at + width])
        w, e = luma(src[at - 1]), luma(src[at + 1])
        low = ti.min(m, n, s, w, e)
        high = ti.max(m, n, s, w, e)
        if high - low > 8 + high // 20:
            nw, ne = luma(src[at - width - 1]), luma(src[at - width + 1])
            sw, se = luma(src[at + width - 1]), luma(src[at + width + 1])
            flat = ti.abs(nw - 2 * w + sw) + 2 * ti.abs(n - 2 * m + s) + ti.abs(ne - 2 * e + se)
            steep = ti.abs(nw - 2 * n + ne) + 2 * ti.abs(w - 2 * m + e) + ti.abs(sw - 2 * s + se)
            along, across = 1, width
            before, after = n, s
            room_low, room_high = ti.min(SEARCH, x - 1), ti.min(SEARCH, width - 2 - x)
            if steep > flat:
                along, across = width, 1
                before, after = w, e
                room_low, room_high = ti.min(SEARCH, y - 1), ti.min(SEARCH, height - 2 - y)
            other = after
            if ti.abs(before - m) >= ti.abs(after - m):
                across = -across
                other = before
            jump = ti.abs(other - m)
            middle = m + other  # twice the luma on the edge
            q = at + across
            down, up = 0, 0
            end_down, end_up = 0, 0
            going = True
            while going and down < room_low:
                down += 1
                end_down = luma(src[at - down * along]) + luma(src[q - down * along]) - middle
                going = 2 * ti.abs(end_down) < jump
            going = True
            while going and up < room_high:
                up += 1
                end_up = luma(src[at + up * along]) + luma(src[q + up * along]) - middle
                going = 2 * ti.abs(end_up) < jump
            nearest = end_down if down < up else end_up
            share = 0.0
            # the edge bends over this pixel only if the nearer end turns to the other side
            if (nearest < 0) != (2 * m < middle):
                share = 0.5 - ti.cast(ti.min(down, up), ti.f32) / ti.cast(down + up, ti.f32)
            # single pixels sticking out
            around = (2 * (n + s + w + e) + nw + ne + sw + se) / 12.0
            lone = ti.min(ti.abs(around - m) / ti.cast(high - low, ti.f32), 1.0)
            lone = lone * lone * (3.0 - 2.0 * lone)
            share = ti.max(share, lone * lone * 0.6)
            if share > 0:
                a = decode(c, linear)
                out = encode(a + (decode(src[q], linear) - a) * share, table)
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
    return out


@ti.kernel
def smooth_rows(
    src: u32s,
    marks: i32s,
    level: i32s,
    linear: f1,
    table: u32s,
    final: u8s,
    views: ti.i32,
    width: ti.i32,
    height: ti.i32,
):
    """Final bytes of the picture, smoothed where something ends."""
    for line in range(views * height):
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
                    c = smoothed(x, y, at, width, height, src, linear, table)
                bits >>= 1
                final[3 * at] = ti.cast(c & 0xFF, ti.u8)
                final[3 * at + 1] = ti.cast((c >> 8) & 0xFF, ti.u8)
                final[3 * at + 2] = ti.cast((c >> 16) & 0xFF, ti.u8)


@ti.kernel
def smooth_words(
    src: u32s,
    marks: i32s,
    level: i32s,
    linear: f1,
    table: u32s,
    final: u32s,
    views: ti.i32,
    width: ti.i32,
    height: ti.i32,
):
    """As smooth_rows, for widths that four divides: four pixels are three words."""
    for line in range(views * height):
        y = line % height
        blocks = (width + BLOCK - 1) // BLOCK
        for b in range(blocks):
            if level[line * blocks + b] < SMOOTH:
                continue
            bits = near_marks(line, y, b, blocks, height, marks)
            for group in range((ti.min(BLOCK, width - b * BLOCK)) // 4):
                x = b * BLOCK + 4 * group
                at = line * width + x
                low = ti.u64(0)
                high = ti.u64(0)
                if (bits >> (4 * group)) & 15 == 0:
                    low = paired(src[at], src[at + 1])
                    high = paired(src[at + 2], src[at + 3])
                else:
                    for i in range(4):
                        c = src[at + i]
                        if (bits >> (4 * group + i)) & 1:
                            c = smoothed(x + i, y, at + i, width, height, src, linear, table)
                        if i < 2:
                            low |= ti.cast(c & 0xFFFFFF, ti.u64) << (24 * i)
                        else:
                            high |= ti.cast(c & 0xFFFFFF, ti.u64) << (24 * i - 48)
                word = at // 4 * 3
                final[word] = ti.cast(low, ti.u32)
                final[word + 1] = ti.cast(low >> 32, ti.u32) | ti.cast(high << 16, ti.u32)
                final[word + 2] = ti.cast(high >> 16, ti.u32)


@ti.kernel
def object_ids(edge: u32s, owner: i1, out: i32s, count: ti.i32):
    for i in range(count):
        s = ti.cast(edge[i] >> 16, ti.i32)
        out[i] = owner[s] if s != 0xFFFF else -1
