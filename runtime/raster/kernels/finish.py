"""Finishing: ink lines from the edge buffer, then a smoothing of stair-steps, then bytes.

Pictures in between are packed sRGB with the luma in the fourth byte.
"""

# mypy: ignore-errors
# Taichi reads annotations as kernel types and parses the bodies itself.

from functools import lru_cache
from types import SimpleNamespace

import taichi as ti

from ..types import Style
from .geometry import f1, f2, i1, nearness, triangle, u8s, u32s, u64s, vec3
from .shading import NOTHING, encode, unpack_normal
from .shading import RUN as BLOCK

i32s = ti.types.ndarray(ti.i32, ndim=1)
TOUCH = 0.04  # metres
SEARCH = 9  # pixels looked along an edge, either way


@ti.func
def decode(c, table: ti.template()):
    return vec3(
        table[ti.cast(c & 0xFF, ti.i32)],
        table[ti.cast((c >> 8) & 0xFF, ti.i32)],
        table[ti.cast((c >> 16) & 0xFF, ti.i32)],
    )


@ti.func
def bend(e, f):
    """Cosine between two packed normals, 1 when they are obviously close."""
    out = 1.0
    if (e ^ f) & 0xFFFF:
        ex, ey = ti.cast((e >> 8) & 0xFF, ti.i32), ti.cast(e & 0xFF, ti.i32)
        fx, fy = ti.cast((f >> 8) & 0xFF, ti.i32), ti.cast(f & 0xFF, ti.i32)
        if ti.abs(ex - fx) + ti.abs(ey - fy) > 30:
            out = unpack_normal(e).dot(unpack_normal(f))
    return out


@ti.func
def line_weight(e, f, w, w_f, w_back, first_moving, owner: ti.template()):
    """How strongly the border from a pixel (e, 1/z = w) to a neighbour (f, w_f) is inked on the pixel's side.

    w_back: 1/z behind the pixel, from which its surface is extended to the neighbour
    """
    out = 0.0
    s = ti.cast(e >> 16, ti.i32)
    s_f = ti.cast(f >> 16, ti.i32)
    moves = s >= first_moving
    # a gap in metres, where this surface would be if it went on
    gap = (2.0 * w - w_back - w_f) / (w * w)
    allowed = 0.035 + 0.012 / w
    if s != s_f:
        if f == ti.u32(NOTHING):
            out = 1.0 if moves else 0.6
        else:
            # the nearer side; where the two touch, always the same one, or the line would jump across
            touching = ti.abs(w - w_f) < TOUCH * w * w
            if (touching and s > s_f) or (not touching and w > w_f):
                if owner[s] != owner[s_f]:
                    out = 1.0 if moves else (0.45 if touching else 0.6)
                elif moves:
                    out = 0.7 if touching else 0.95
                else:
                    out = 0.35 if touching else 0.5
                # one plane, two faces in it (boxes that overlap): which is seen is chance, so no line
                if not moves and touching and ti.abs(gap) < 0.003 and bend(e, f) > 0.98:
                    out = 0.0
    elif gap > allowed and w > w_f:
        out = 0.8 if moves else 0.45
    else:
        turn = bend(e, f)
        if turn < (0.35 if moves else 0.75) and gap > -allowed:
            out = 0.45 if moves else 0.3
    return out


@ti.func
def alone(x, y, at, width, height, vis: ti.template()):
    """Whether one triangle is at a pixel and all around it."""
    t = ti.cast(vis[at], ti.u32)
    out = x == 0 or t == ti.cast(vis[at - 1], ti.u32)
    out = out and (x == width - 1 or t == ti.cast(vis[at + 1], ti.u32))
    out = out and (y == 0 or t == ti.cast(vis[at - width], ti.u32))
    return out and (y == height - 1 or t == ti.cast(vis[at + width], ti.u32))


@ti.func
def even(x, y, at, width, height, moves, edge: ti.template(), vis: ti.template()):
    """Whether a pixel is obviously within a surface: quicker to find than how strong its lines are."""
    out = False
    if 1 < x < width - 2 and 1 < y < height - 2:
        e = edge[at]
        a, b, c, d = edge[at - 1], edge[at + 1], edge[at - width], edge[at + width]
        other = (e ^ a) | (e ^ b) | (e ^ c) | (e ^ d)
        if moves and height > 360:
            other |= (e ^ edge[at - 2]) | (e ^ edge[at + 2])
            other |= (e ^ edge[at - 2 * width]) | (e ^ edge[at + 2 * width])
        if other >> 16 == 0:
            w = nearness(vis, at)
            allowed = 0.03 * w * w
            across = 2 * w - nearness(vis, at - 1) - nearness(vis, at + 1)
            down = 2 * w - nearness(vis, at - width) - nearness(vis, at + width)
            out = ti.abs(across) < allowed and ti.abs(down) < allowed
            if out and other != 0:
                out = level(e, a) and level(e, b) and level(e, c) and level(e, d)
    return out


@ti.func
def level(e, f):
    """Whether two packed normals are obviously close."""
    x = ti.cast((e >> 8) & 0xFF, ti.i32) - ti.cast((f >> 8) & 0xFF, ti.i32)
    y = ti.cast(e & 0xFF, ti.i32) - ti.cast(f & 0xFF, ti.i32)
    return ti.abs(x) + ti.abs(y) <= 30


@ti.func
def paired(a, b):
    """The bytes of two pixels, 48 bits."""
    return ti.cast(a & 0xFFFFFF, ti.u64) | (ti.cast(b & 0xFFFFFF, ti.u64) << 24)


@lru_cache(maxsize=8)
def finish_kernels(style: Style) -> SimpleNamespace:
    """The finishing kernels of a style."""
    outline = style.outline

    @ti.func
    def inked(
        x,
        y,
        at,
        width,
        height,
        weight,
        first_moving,
        picture: ti.template(),
        edge: ti.template(),
        vis: ti.template(),
        owner: ti.template(),
        one_color: ti.template(),
        linear: ti.template(),
        table: ti.template(),
    ):
        """Give a pixel its share of ink; returns whether something ends here.

        weight: width in pixels of a line 1 m away
        """
        e = edge[at]
        s = ti.cast(e >> 16, ti.i32)
        moves = s >= first_moving and e != ti.u32(NOTHING)
        marked = True
        near_line = True
        if moves:
            near_line = not even(x, y, at, width, height, True, edge, vis)
            marked = near_line or one_color[s] == 0
        else:
            marked = not alone(x, y, at, width, height, vis)
            near_line = (
                marked and e != ti.u32(NOTHING) and not even(x, y, at, width, height, False, edge, vis)
            )
        if near_line:
            left = at - 1 if x > 0 else at
            right = at + 1 if x < width - 1 else at
            above = at - width if y > 0 else at
            below = at + width if y < height - 1 else at
            w = nearness(vis, at)
            broad = ti.min(ti.max(weight * w, 1.0), ti.max(1.0, height / 360.0))
            ring = ti.Vector([left, right, above, below])
            ink = 0.0
            for k in ti.static(range(4)):
                q = ring[k]
                back = ring[k ^ 1]
                w_q = nearness(vis, q)
                w_back = nearness(vis, back)
                f = edge[q]
                if back == at or ((e ^ edge[back]) >> 16) != 0:
                    w_back = w - (w_q - w) if (e ^ f) >> 16 == 0 else w
                if e != f or ti.abs(2 * w - w_back - w_q) > 0.03 * w * w:
                    ink = ti.max(ink, line_weight(e, f, w, w_q, w_back, first_moving, owner))
                if moves and broad > 1.0 and ink < 0.9:
                    far = 2 * q - at
                    inside = True
                    if ti.static(k == 0):
                        inside = x > 1
                    elif ti.static(k == 1):
                        inside = x < width - 2
                    elif ti.static(k == 2):
                        inside = y > 1
                    else:
                        inside = y < height - 2
                    if inside and (e ^ f) >> 16 == 0:
                        g = edge[far]
                        if (e ^ g) >> 16 != 0:
                            share = ti.min(broad - 1.0, 1.0)
                            ink = ti.max(
                                ink,
                                share * line_weight(f, g, w_q, nearness(vis, far), w, first_moving, owner),
                            )
            if ink > 0:
                marked = True
                c = decode(picture[at], linear)
                # people: near black, a little of their colour; sets: a deeper shade of their own tint
                line = c * 0.06 + vec3(0.006, 0.005, 0.009)
                if not moves:
                    line = c * 0.22 + vec3(0.02, 0.018, 0.022)
                    ink *= ti.min(1.0, 0.35 + 2.6 * w)
                else:
                    ink *= ti.min(1.0, 0.5 + 5.0 * w)
                picture[at] = encode(c + (line - c) * ink, table)
        return marked

    @ti.kernel
    def ink_rows(
        view: f2,
        picture: u32s,
        edge: u32s,
        vis: u64s,
        solid: i32s,
        owner: i1,
        one_color: i1,
        first_moving: ti.i32,
        linear: f1,
        table: u32s,
        marks: i32s,
        views: ti.i32,
        width: ti.i32,
        height: ti.i32,
    ):
        """Ink the picture in place, and mark in each block, a bit a pixel, where something ends.

        one_color: whether all of a surface is one colour, so that only its border needs smoothing;
        solid: the triangle of the set that fills each block alone, 0 for none, -1 for the backdrop
        """
        for line in range(views * height):
            weight = 0.0065 * view[line // height, 13]
            y = line % height
            blocks = (width + BLOCK - 1) // BLOCK
            for b in range(blocks):
                k = line * blocks + b
                whole = solid[k]
                quiet = (
                    whole != 0
                    and (y == 0 or solid[k - blocks] == whole)
                    and (y == height - 1 or solid[k + blocks] == whole)
                )
                if quiet and b > 0:
                    quiet = ti.cast(ti.cast(vis[line * width + b * BLOCK - 1], ti.u32), ti.i32) == ti.max(
                        whole, 0
                    )
                if quiet and b < blocks - 1:
                    quiet = triangle(vis, line * width + b * BLOCK + BLOCK) + 1 == ti.max(whole, 0)
                bits = 0
                if not quiet:
                    for i in range(ti.min(BLOCK, width - b * BLOCK)):
                        x = b * BLOCK + i
                        at = line * width + x
                        marked = False
                        if ti.static(outline):
                            marked = inked(
                                x,
                                y,
                                at,
                                width,
                                height,
                                weight,
                                first_moving,
                                picture,
                                edge,
                                vis,
                                owner,
                                one_color,
                                linear,
                                table,
                            )
                        else:
                            marked = not alone(x, y, at, width, height, vis)
                        if marked:
                            bits |= 1 << i
                marks[k] = bits

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

    return SimpleNamespace(
        ink_rows=ink_rows, smooth_rows=smooth_rows, smooth_words=smooth_words, object_ids=object_ids
    )
