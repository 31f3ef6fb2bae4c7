"""Ink: lines where object, part, depth or normal change, and a mark where something ends.

Reads the edge buffer (see paint.py) and the visibility buffer; draws into the packed picture.
"""

# mypy: ignore-errors
# Taichi reads annotations as kernel types and parses the bodies itself.

from functools import lru_cache
from types import SimpleNamespace

import taichi as ti

from ..types import Style
from . import crew
from .borders import find_borders, quiet, slope, touch
from .gather import fv, iv
from .geometry import f1, f2, i1, nearness, u32s, u64s, vec3
from .paint import INK, NOTHING, decode, encode, unpack_normal
from .paint import RUN as BLOCK

i32s = ti.types.ndarray(ti.i32, ndim=1)
EVERY = (1 << BLOCK) - 1
CREASE = 0.45  # how strongly a crease of what moves is inked
PLANE = 0.003  # metres by which two faces in one plane may be apart


@ti.func
def level(e, f):
    """Whether two packed normals are obviously close."""
    x = ti.cast((e >> 8) & 0xFF, ti.i32) - ti.cast((f >> 8) & 0xFF, ti.i32)
    y = ti.cast(e & 0xFF, ti.i32) - ti.cast(f & 0xFF, ti.i32)
    return ti.abs(x) + ti.abs(y) <= 30


@ti.func
def bends(e, f, cosine):
    """Whether the angle between two packed normals is wider than that of a cosine above 0."""
    out = False
    if not level(e, f):
        n, m = unpack_normal(e), unpack_normal(f)
        along = n.dot(m)
        # compared squared, as normals of any length do
        out = along <= 0.0 or along * along < cosine * cosine * n.norm_sqr() * m.norm_sqr()
    return out


@ti.func
def slack(w):
    """By how much 1/z may leave the line of a surface at 1/z = ``w`` before it ends there, before itself."""
    return (0.035 * w + 0.012) * w


@ti.func
def line_weight(e, f, w, w_f, w_back, touching, first_moving, owner: ti.template()):
    """How strongly the border from a pixel (e, 1/z = w) to a neighbour (f, w_f) is inked on the pixel's side.

    w_back: 1/z behind the pixel, from which its surface is extended to the neighbour; touching: whether the
    two touch where they are of two surfaces
    """
    out = 0.0
    s = ti.cast(e >> 16, ti.i32)
    s_f = ti.cast(f >> 16, ti.i32)
    moves = s >= first_moving
    # a gap in metres, where this surface would be if it went on, both times w squared
    gap = 2.0 * w - w_back - w_f
    allowed = slack(w)
    if s != s_f:
        if f == ti.u32(NOTHING):
            out = 1.0 if moves else 0.6
        else:
            # the nearer side; where the two touch, always the same one, or the line would jump across
            if (touching and s > s_f) or (not touching and w > w_f):
                if owner[s] != owner[s_f]:
                    out = 1.0 if moves else (0.45 if touching else 0.6)
                elif moves:
                    out = 0.7 if touching else 0.95
                else:
                    out = 0.35 if touching else 0.5
                # one plane, two faces in it (boxes that overlap): which is seen is chance, so no line
                if not moves and touching and ti.abs(gap) < PLANE * w * w and not bends(e, f, 0.98):
                    out = 0.0
    elif gap > allowed and w > w_f:
        out = 0.8 if moves else 0.45
    elif gap > -allowed and bends(e, f, 0.35 if moves else 0.75):
        out = CREASE if moves else 0.3
    return out


@ti.func
def apart(e, f):
    """Whether two packed pixels are of two surfaces, or of two facets of one."""
    return (e ^ f) >> 16 != 0 or not level(e, f)


@ti.func
def of_sliver(at, q, step, side, edge: ti.template(), vis: ti.template()):
    """Whether the line between a pixel of the set and another is one of a facet a pixel wide.

    One sample a pixel meets such a facet by chance, and its line would come and go as dashes: a crease needs
    two pixels on either side; and past a step of some millimetres what lies in one plane is without one.
    step, side: from pixel to pixel across the line and along it; all around both there are pixels
    """
    d, e, f, g = edge[at - step], edge[at], edge[q], edge[q + step]
    beside, other = edge[q - side], edge[q + side]
    thin = apart(f, beside) and apart(f, other)
    out = False
    if (e ^ f) >> 16 == 0:
        w, w_f = nearness(vis, at), nearness(vis, q)
        ends = 2.0 * w - nearness(vis, at - step) - w_f > slack(w) and w > w_f
        thin |= apart(d, e) or apart(f, g) or (apart(e, edge[at - side]) and apart(e, edge[at + side]))
        out = thin and not ends
    elif thin:
        out = not apart(e, beside) or not apart(e, other)
    elif (f ^ g) >> 16 == 0 and not level(f, g):
        w = nearness(vis, at)
        gap = 3.0 * w - 2.0 * nearness(vis, at - step) - nearness(vis, q + step)
        out = ti.abs(gap) < PLANE * w * w and not bends(e, g, 0.98)
    return out


@ti.func
def island(at, width, edge: ti.template()):
    """Whether a pixel shows a facet that none of its neighbours shows; all around it there are pixels."""
    e = edge[at]
    out = apart(e, edge[at - 1]) and apart(e, edge[at + 1])
    return out and apart(e, edge[at - width]) and apart(e, edge[at + width])


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


@lru_cache(maxsize=8)
def ink_kernels(style: Style) -> SimpleNamespace:
    """The inking kernels of a style."""
    outline = style.outline
    hatch = style.hatch

    @ti.func
    def draw(
        x,
        y,
        at,
        ways,
        width,
        height,
        weight,
        slant,
        first_moving,
        picture: ti.template(),
        edge: ti.template(),
        vis: ti.template(),
        owner: ti.template(),
        linear: ti.template(),
        table: ti.template(),
    ):
        """Give a pixel its share of ink.

        ways: a bit for each neighbour towards which there may be a line: left, right, above, below; weight:
        width in pixels of a line 1 m away
        """
        e = edge[at]
        s = ti.cast(e >> 16, ti.i32)
        moves = s >= first_moving and e != ti.u32(NOTHING)
        w = nearness(vis, at)
        broad = ti.min(ti.max(weight * w, 1.0), ti.max(1.0, height / 360.0))
        ink = 0.0
        for k in range(4):
            if (ways >> k) & 1:
                # how many pixels there are that way, and the other way
                place, size = (x, width) if k < 2 else (y, height)
                ahead = size - 1 - place if k & 1 else place
                behind = size - 1 - ahead
                step = (1 if k < 2 else width) * (1 if k & 1 else -1)
                q = at + step if ahead > 0 else at
                back = at - step if behind > 0 else at
                w_q = nearness(vis, q)
                w_back = nearness(vis, back)
                f = edge[q]
                touching = False
                if (e ^ f) >> 16 != 0 and f != ti.u32(NOTHING):
                    before, after = 0.0, 0.0
                    if behind > 0 and (e ^ edge[back]) >> 16 == 0:
                        before = w - w_back
                    if ahead > 1 and (f ^ edge[q + step]) >> 16 == 0:
                        after = nearness(vis, q + step) - w_q
                    touching = touch(before, w, w_q, after, slant)
                if behind == 0 or ((e ^ edge[back]) >> 16) != 0:
                    w_back = w - (w_q - w) if (e ^ f) >> 16 == 0 else w
                if e != f or ti.abs(2 * w - w_back - w_q) > 0.03 * w * w:
                    strong = line_weight(e, f, w, w_q, w_back, touching, first_moving, owner)
                    inside = 1 < x < width - 2 and 1 < y < height - 2
                    if strong > ink and inside and f != ti.u32(NOTHING):
                        if not moves:
                            if of_sliver(at, q, step, width if k < 2 else 1, edge, vis):
                                strong = 0.0
                        elif strong <= CREASE and (e ^ f) >> 16 == 0:  # noqa: SIM102
                            # of a triangle of skin that comes through another here and there
                            if island(at, width, edge) or island(q, width, edge):
                                strong = 0.0
                    ink = ti.max(ink, strong)
                if moves and broad > 1.0 and ink < 0.9 and ahead > 1 and (e ^ f) >> 16 == 0:
                    g = edge[q + step]
                    if (e ^ g) >> 16 != 0:
                        share = ti.min(broad - 1.0, 1.0)
                        far, after = nearness(vis, q + step), 0.0
                        if ahead > 2 and (g ^ edge[q + 2 * step]) >> 16 == 0:
                            after = nearness(vis, q + 2 * step) - far
                        touching = touch(w_q - w, w_q, far, after, slant)
                        ink = ti.max(
                            ink, share * line_weight(f, g, w_q, far, w, touching, first_moving, owner)
                        )
        if ink > 0:
            c = decode(picture[at], linear)
            if ti.static(hatch):
                ink = ti.min(1.0, ink * (1.15 if moves else 1.7))
            # people: near black, a little of their colour; sets: a deeper shade of their own tint
            line = c * 0.06 + vec3(0.006, 0.005, 0.009)
            if not moves:
                line = c * 0.22 + vec3(0.02, 0.018, 0.022)
                ink *= ti.min(1.0, ti.static(0.62 if hatch else 0.35) + 2.6 * w)
            else:
                ink *= ti.min(1.0, 0.5 + 5.0 * w)
            if ti.static(hatch):
                line = vec3(0.006 if moves else 0.09)
            picture[at] = encode(c + (line - c) * ink, table)

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
        level: i32s,
        views: ti.i32,
        width: ti.i32,
        height: ti.i32,
        queue: i1,
        slots: ti.i32,
        host: ti.template(),
    ):
        """Ink the picture in place, and mark in each block, a bit a pixel, where something ends.

        one_color: whether all of a surface is one colour, so that only its border needs smoothing;
        solid: the triangle of the set that fills each block alone, 0 for none, -1 for the backdrop
        """
        for slot in range(slots):
            line = crew.task(slot, views * height, queue, host)
            if line < views * height:
                focal = view[line // height, 13]
                weight, slant = 0.0065 * focal, slope(focal)
                y = line % height
                blocks = (width + BLOCK - 1) // BLOCK
                for b in range(blocks):
                    k = line * blocks + b
                    if level[k] < INK:
                        continue
                    bits = 0
                    if not quiet(k, b, y, blocks, height, width, solid, vis):
                        for i in range(ti.min(BLOCK, width - b * BLOCK)):
                            x = b * BLOCK + i
                            at = line * width + x
                            marked = False
                            if ti.static(outline):
                                e = edge[at]
                                s = ti.cast(e >> 16, ti.i32)
                                near = False
                                if s >= first_moving and e != ti.u32(NOTHING):
                                    near = not even(x, y, at, width, height, True, edge, vis)
                                    marked = near or one_color[s] == 0
                                else:
                                    marked = not alone(x, y, at, width, height, vis)
                                    near = marked and e != ti.u32(NOTHING)
                                    if near:
                                        near = not even(x, y, at, width, height, False, edge, vis)
                                if near:
                                    draw(
                                        x,
                                        y,
                                        at,
                                        15,
                                        width,
                                        height,
                                        weight,
                                        slant,
                                        first_moving,
                                        picture,
                                        edge,
                                        vis,
                                        owner,
                                        linear,
                                        table,
                                    )
                            else:
                                marked = not alone(x, y, at, width, height, vis)
                            if marked:
                                bits |= 1 << i
                    marks[k] = bits

    @ti.kernel
    def ink_runs(
        view: f2,
        picture: u32s,
        edge: u32s,
        vis: u64s,
        vis_word: iv,
        vis_number: fv,
        edge_word: iv,
        solid: i32s,
        owner: i1,
        one_color: i1,
        first_moving: ti.i32,
        linear: f1,
        table: u32s,
        telling: ti.i32,
        found: i32s,
        kinds: i32s,
        marks: i32s,
        level: i32s,
        views: ti.i32,
        width: ti.i32,
        height: ti.i32,
        queue: i1,
        slots: ti.i32,
    ):
        """As ink_rows, for rows of whole runs, on the host: where lines may be is found for sixteen pixels at
        a time (:func:`borders.find_borders`), and these drawn while the row is at hand.

        vis_word, vis_number, edge_word: the memory of ``vis`` and of ``edge``
        """
        for slot in range(slots):
            line = crew.task(slot, views * height, queue, True)
            if line < views * height:
                focal = view[line // height, 13]
                weight, slant = 0.0065 * focal, slope(focal)
                y = line % height
                blocks = width // BLOCK
                find_borders(
                    line,
                    vis,
                    vis_word,
                    vis_number,
                    edge_word,
                    solid,
                    level,
                    first_moving,
                    slant,
                    outline,
                    telling,
                    found,
                    kinds,
                    marks,
                    blocks,
                    height,
                )
                if ti.static(outline):
                    for b in range(blocks):
                        k = line * blocks + b
                        if level[k] < INK:
                            continue
                        beside, upright, moving = found[3 * k], found[3 * k + 1], found[3 * k + 2]
                        lines = (beside | beside >> BLOCK | upright | upright >> BLOCK) & EVERY
                        others = moving & ~lines
                        while lines != 0:
                            i = 31 - ti.math.clz(lines)
                            lines ^= 1 << i
                            x = b * BLOCK + i
                            two, four = beside >> i & 0x10001, upright >> i & 0x10001
                            ways = (two | two >> 15) & 3 | ((four | four >> 15) & 3) << 2
                            draw(
                                x,
                                y,
                                line * width + x,
                                ways,
                                width,
                                height,
                                weight,
                                slant,
                                first_moving,
                                picture,
                                edge,
                                vis,
                                owner,
                                linear,
                                table,
                            )
                        if others != 0:
                            bits, last, many = marks[k], -1, False
                            while others != 0:
                                i = 31 - ti.math.clz(others)
                                others ^= 1 << i
                                s = ti.cast(edge[line * width + b * BLOCK + i] >> 16, ti.i32)
                                if s != last:
                                    last, many = s, one_color[s] == 0
                                if many:
                                    bits |= 1 << i
                            marks[k] = bits

    return SimpleNamespace(rows=ink_rows, runs=ink_runs)
