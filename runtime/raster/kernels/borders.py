"""Which pixels a line may be drawn on, and where something ends: sixteen pixels at a time, on the host.

Says of every pixel what ``ink.even`` and ``ink.alone`` say of it, operation by operation, row by row as it is
inked. Rows are whole runs. On vectors, see ``gather``; that lanes are moved to make neighbours of them
compiles to shuffles, and what is made of lanes has to be made within the loop over rows.
"""

# mypy: ignore-errors
# Taichi reads annotations as kernel types and parses the bodies itself.

import taichi as ti

from .gather import LANES, I
from .geometry import triangle
from .paint import INK, NOTHING
from .paint import RUN as BLOCK

TOUCH = 0.04  # metres
NEAR_PLANE = 0.5  # metres from the eye of planes that change their depth most from pixel to pixel
FOLD = 0.03  # of 1/z squared: where a surface ends before itself
HALF = LANES // 2
NO_SURFACE = NOTHING - (1 << 32)  # as a signed number
ALL = (1 << LANES) - 1
BOTH_ENDS = 3 << (LANES - 2)  # the bits of the last two pixels of a run


@ti.func
def slope(focal):
    """By how much 1/z changes from pixel to pixel at most, as of floors and ceilings seen at a slant; focal:
    in pixels."""
    return 1.0 / (NEAR_PLANE * focal)


@ti.func
def touch(before, w, w_f, after, slant):
    """Whether two surfaces touch between two pixels of 1/z ``w`` and ``w_f``: they are hardly apart, or no
    further than one of them goes from pixel to pixel. The same from either side.

    before, after: by how much 1/z of each changes along the row, 0 where that is not known; slant: the most
    that counts, of :func:`slope`
    """
    gap, allowed = w_f - w, TOUCH * w * w_f
    low, high = ti.min(before, after, 0.0) - allowed, ti.max(before, after, 0.0) + allowed
    return ti.abs(gap) < allowed or (low < gap < high and ti.abs(gap) < allowed + slant)


@ti.func
def quiet(k, b, y, blocks, height, width, solid: ti.template(), vis: ti.template()):
    """Whether one triangle of the set is in all of block ``k``, the ``b``-th of row ``y``, and around it."""
    whole = solid[k]
    out = (
        whole != 0
        and (y == 0 or solid[k - blocks] == whole)
        and (y == height - 1 or solid[k + blocks] == whole)
    )
    begin = (k - b) // blocks * width + b * BLOCK
    if out and b > 0:
        out = triangle(vis, begin - 1) + 1 == ti.max(whole, 0)
    if out and b < blocks - 1:
        out = triangle(vis, begin + BLOCK) + 1 == ti.max(whole, 0)
    return out


@ti.func
def even_lanes(a, b):
    """The lower halves of the 64-bit words in two vectors."""
    out = a
    for j in ti.static(range(HALF)):
        out[j] = a[2 * j]
        out[j + HALF] = b[2 * j]
    return out


@ti.func
def odd_lanes(a, b):
    """The upper halves of the 64-bit words in two vectors."""
    out = a
    for j in ti.static(range(HALF)):
        out[j] = a[2 * j + 1]
        out[j + HALF] = b[2 * j + 1]
    return out


@ti.func
def from_left(a, before, steps: ti.template()):
    """What is ``steps`` pixels to the left; before: the run on the left."""
    out = a
    for j in ti.static(range(LANES)):
        if ti.static(j < steps):
            out[j] = before[LANES - steps + j]
        else:
            out[j] = a[j - steps]
    return out


@ti.func
def from_right(a, after, steps: ti.template()):
    """What is ``steps`` pixels to the right; after: the run on the right."""
    out = a
    for j in ti.static(range(LANES)):
        if ti.static(j >= LANES - steps):
            out[j] = after[j - LANES + steps]
        else:
            out[j] = a[j + steps]
    return out


@ti.func
def magnitude(a):
    b = a * -1
    return ti.select(a < b, b, a)


@ti.func
def turned(e, f):
    """Sixteen times 1 where two packed normals are not obviously close, as ``ink.level``."""
    x = magnitude(((e >> 8) & 0xFF) - ((f >> 8) & 0xFF))
    y = magnitude((e & 0xFF) - (f & 0xFF))
    return ti.select(x + y > 30, I(1), I(0))


@ti.func
def lined(e, f, w, w_f, w_back, back, slant):
    """Sixteen times whether ``ink.line_weight`` may be above zero; back: what is behind a pixel; slant: see
    :func:`slope`."""
    nearer = ti.select(w > w_f, I(1), I(0))
    folded = ti.select(2.0 * w - w_back - w_f > 0.03 * w * w, nearer, I(0))
    folded = ti.select(((e ^ back) >> 16) == 0, folded, I(0)) | turned(e, f)
    return ti.select(((e ^ f) >> 16) == 0, folded, outlined(e, f, w, w_f, slant))


@ti.func
def outlined(e, f, w, w_f, slant):
    """The same where the surfaces differ; ``ink.draw`` asks :func:`touch`, which says so more seldom."""
    nearer = ti.select(w > w_f, I(1), I(0))
    later = ti.select(((e >> 16) & 0xFFFF) > ((f >> 16) & 0xFFFF), I(1), I(0))
    between = ti.select(magnitude(w - w_f) < TOUCH * w * w_f + slant, later | nearer, nearer)
    return ti.select(f == NO_SURFACE, I(1), between)


@ti.func
def broadened(e, f, g, w, w_g, slant):
    """Where a broad line of a surface that moves may come from the pixel beside it; g: the one after f."""
    same = ti.select(((e ^ f) >> 16) == 0, I(1), I(0))
    return ti.select(((e ^ g) >> 16) != 0, same, I(0)) & outlined(f, g, w, w_g, slant)


@ti.func
def ended(differs, e, f, w, v, behind, beyond):
    """Sixteen times what ``edges.border`` says of two neighbours: whether a surface ends between them, and
    whether it bends there. behind, beyond: 1/z of those next to them"""
    fold = ti.select(2.0 * w - behind - v > FOLD * w * w, ti.select(w > v, I(1), I(0)), I(0))
    fold |= ti.select(2.0 * v - beyond - w > FOLD * v * v, ti.select(v > w, I(1), I(0)), I(0))
    ends = ti.select(((e ^ f) >> 16) != 0, I(1), fold)
    bends = ti.select(ends != 0, I(0), turned(e, f))
    return ti.select(differs != 0, ends, I(0)), ti.select(differs != 0, bends, I(0))


@ti.func
def bits_of(a, b, powers):
    """A word with a bit for each lane of ``a`` that is not zero, and from bit 16 on for each of ``b``."""
    chosen = ti.select(a != 0, powers, I(0)) | ti.select(b != 0, powers << LANES, I(0))
    out = 0
    for j in ti.static(range(LANES)):
        out |= chosen[j]
    return out


@ti.func
def find_borders(
    line,
    vis: ti.template(),
    vis_word: ti.template(),
    vis_number: ti.template(),
    edge: ti.template(),
    solid: ti.template(),
    level: ti.template(),
    first_moving,
    slant,
    outline: ti.template(),
    telling,
    found: ti.template(),
    kinds: ti.template(),
    marks: ti.template(),
    runs,
    height,
):
    """Where lines may be in a row, and where something ends.

    vis, vis_word, vis_number: the same memory, a run is two vectors; marks: of each run, a bit for each
    pixel at which something ends; found, three words of a run: a bit for each pixel that may have a line
    towards its left, from bit 16 on its right neighbour; above, below; and one for each pixel that moves.
    Where a surface that moves has several colours is not looked at. kinds, two words of a run, if
    ``telling``: a bit for each pixel between which and the one on its right a surface ends, from bit 16 on
    where one bends; the same of the pixel below.
    """
    powers = I(0)
    for j in ti.static(range(LANES)):
        powers[j] = 1 << j
    y = line % height
    up = runs if y > 0 else 0
    down = runs if y < height - 1 else 0
    for b in range(runs):
        k = line * runs + b
        if level[k] < INK:
            continue
        ends, moving, beside, upright = 0, 0, 0, 0
        to_right, to_below = 0, 0
        if not quiet(k, b, y, runs, height, runs * LANES, solid, vis):
            left = 1 if b > 0 else 0
            right = 1 if b < runs - 1 else 0
            t = even_lanes(vis_word[2 * k], vis_word[2 * k + 1])
            # at the border of the picture the pixel itself stands for the one beside it
            before, after = vis_word[2 * (k - left) + 1], vis_word[2 * (k + right)]
            t_left = from_left(t, t, 1)
            t_left[0] = before[LANES - 2] if b > 0 else t[0]
            t_right = from_right(t, t, 1)
            t_right[LANES - 1] = after[0] if b < runs - 1 else t[LANES - 1]
            t_above = even_lanes(vis_word[2 * (k - up)], vis_word[2 * (k - up) + 1])
            t_below = even_lanes(vis_word[2 * (k + down)], vis_word[2 * (k + down) + 1])
            other_t = (t ^ t_left) | (t ^ t_right) | (t ^ t_above) | (t ^ t_below)
            e = edge[k]
            moves = ti.select(((e >> 16) & 0xFFFF) >= first_moving, I(1), I(0))
            moves = ti.select(e != NO_SURFACE, moves, I(0))
            ends = bits_of(other_t, moves, powers)
            moving = (ends >> LANES) & ALL
            ends &= ALL
            if ti.static(outline):  # noqa: SIM102
                if (ends | moving) != 0:
                    e_before, e_after = edge[k - left], edge[k + right]
                    e_left, e_right = from_left(e, e_before, 1), from_right(e, e_after, 1)
                    e_above, e_below = edge[k - up], edge[k + down]
                    other = (e ^ e_left) | (e ^ e_right) | (e ^ e_above) | (e ^ e_below)
                    broad = moving != 0 and height > 360
                    far_up = up + (runs if y > 1 else 0)
                    far_down = down + (runs if y < height - 2 else 0)
                    e_left2, e_right2 = from_left(e, e_before, 2), from_right(e, e_after, 2)
                    e_above2, e_below2 = edge[k - far_up], edge[k + far_down]
                    if broad:
                        wide = (e ^ e_left2) | (e ^ e_right2) | (e ^ e_above2) | (e ^ e_below2)
                        other |= ti.select(moves != 0, wide, I(0))
                    w = odd_lanes(vis_number[2 * k], vis_number[2 * k + 1])
                    w_before, w_after = vis_number[2 * (k - left) + 1], vis_number[2 * (k + right)]
                    w_left, w_right = from_left(w, w, 1), from_right(w, w, 1)
                    w_left[0] = w_before[LANES - 1]
                    w_right[LANES - 1] = w_after[1]
                    w_above = odd_lanes(vis_number[2 * (k - up)], vis_number[2 * (k - up) + 1])
                    w_below = odd_lanes(vis_number[2 * (k + down)], vis_number[2 * (k + down) + 1])
                    if telling == 1:
                        behind = w_left
                        behind[0] = w_before[LANES - 1] if b > 0 else w[0]
                        beyond = from_right(w_right, w_right, 1)
                        beyond[LANES - 2] = w_right[LANES - 1] if b < runs - 1 else w[LANES - 1]
                        beyond[LANES - 1] = w_after[3]
                        some, bent = ended(t ^ t_right, e, e_right, w, w_right, behind, beyond)
                        to_right = bits_of(some, bent, powers)
                        lower = odd_lanes(vis_number[2 * (k + far_down)], vis_number[2 * (k + far_down) + 1])
                        some, bent = ended(t ^ t_below, e, e_below, w, w_below, w_above, lower)
                        to_below = bits_of(some, bent, powers)
                    allowed = 0.03 * w * w
                    across = magnitude(2.0 * w - w_left - w_right)
                    along = magnitude(2.0 * w - w_above - w_below)
                    near = ti.select((other >> 16) != 0, I(1), I(0))
                    near |= ti.select(across < allowed, I(0), I(1))
                    near |= ti.select(along < allowed, I(0), I(1))
                    near |= turned(e, e_left) | turned(e, e_right)
                    near |= turned(e, e_above) | turned(e, e_below)
                    here = bits_of(near, e ^ NO_SURFACE, powers)
                    something = (here >> LANES) & ALL
                    # ``ink.even`` says nothing of the two pixels at the border of the picture
                    rim = (3 if b == 0 else 0) | (BOTH_ENDS if b == runs - 1 else 0)
                    if y < 2 or y >= height - 2:
                        rim = ALL
                    here = (here & ALL) | rim
                    still = ends & ~moving
                    ends = still | (here & moving)
                    here &= something & (still | moving)
                    if here != 0:
                        left_of = lined(e, e_left, w, w_left, w_right, e_right, slant)
                        right_of = lined(e, e_right, w, w_right, w_left, e_left, slant)
                        over = lined(e, e_above, w, w_above, w_below, e_below, slant)
                        under = lined(e, e_below, w, w_below, w_above, e_above, slant)
                        if broad and (here & moving) != 0:
                            w_left2 = from_left(w_left, w_left, 1)
                            w_left2[0] = w_before[LANES - 3]
                            w_right2 = from_right(w_right, w_right, 1)
                            w_right2[LANES - 1] = w_after[3]
                            w_above2 = odd_lanes(
                                vis_number[2 * (k - far_up)], vis_number[2 * (k - far_up) + 1]
                            )
                            w_below2 = odd_lanes(
                                vis_number[2 * (k + far_down)], vis_number[2 * (k + far_down) + 1]
                            )
                            left_of |= moves & broadened(e, e_left, e_left2, w_left, w_left2, slant)
                            right_of |= moves & broadened(e, e_right, e_right2, w_right, w_right2, slant)
                            over |= moves & broadened(e, e_above, e_above2, w_above, w_above2, slant)
                            under |= moves & broadened(e, e_below, e_below2, w_below, w_below2, slant)
                        here |= here << LANES
                        rim = (rim | rim << LANES) & here
                        beside = (bits_of(left_of, right_of, powers) & here) | rim
                        upright = (bits_of(over, under, powers) & here) | rim
        found[3 * k] = beside
        found[3 * k + 1] = upright
        found[3 * k + 2] = moving
        if telling == 1:
            kinds[2 * k], kinds[2 * k + 1] = to_right, to_below
        marks[k] = ends
