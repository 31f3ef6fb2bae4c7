"""Rows of pixels between shaded ones: what shows the same triangles takes its colours from those.

A picture is divided into bands of BAND rows; every third row of a band is shaded (:mod:`.shading`). Between
two of them a pixel that shows the triangle of both gets a colour in between, and one that shows the triangle
of the nearer one its colour; so does one that lies on the surface of both where that has one colour and bends
little, as on people, whose triangles are hardly larger than pixels. Only the pixels that are left are shaded
too, and those where the light jumps from row to row. No row has to do with another band: bands can be taken
over one by one (:mod:`.reuse`).
"""

# mypy: ignore-errors
# Taichi reads annotations as kernel types and parses the bodies itself.

import numpy as np
import taichi as ti
from numpy.typing import NDArray

from . import crew
from .geometry import i1, i2, nearness, triangle, u32s, u64s
from .paint import GLASS, GLOW, RUN, SHADE
from .spans import qv, uv

BAND = 16  # rows, one more than a multiple of APART
APART = 3  # rows from one that is shaded to the next
ABRUPT = 10  # difference of luma between two rows, of 255, above which what is between them is shaded
TURN = 24  # the same of either number of a packed normal
DEEP = 0.01  # metres a place lies beside the line from one row to the next, at most
EVERY = (1 << RUN) - 1


def planned(views: int, height: int) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """How the rows of ``views`` pictures are worked on.

    Returns which are shaded, int32 [L], and which lie between those, int32 [K, 4]: row, the shaded one above,
    the one below, and the weight of that, of 256.
    """
    row = np.arange(views * height, dtype=np.int32)
    y = row % height
    within = y % BAND
    whole = (within % APART == 0) | (y >= height // BAND * BAND)
    row, away = row[~whole], within[~whole] % APART
    above = row - away
    weight = (away * 256 + APART // 2) // APART
    return np.flatnonzero(whole).astype(np.int32), np.stack([row, above, above + APART, weight], 1).astype(
        np.int32
    )


@ti.func
def mixed(a, b, weight):
    """Packed colours in between, ``weight`` of 256 parts of the second."""
    share, rest = ti.cast(weight, ti.u32), ti.cast(256 - weight, ti.u32)
    low = (a & ti.u32(0x00FF00FF)) * rest + (b & ti.u32(0x00FF00FF)) * share + ti.u32(0x00800080)
    high = (
        ((a >> 8) & ti.u32(0x00FF00FF)) * rest + ((b >> 8) & ti.u32(0x00FF00FF)) * share + ti.u32(0x00800080)
    )
    return ((low >> 8) & ti.u32(0x00FF00FF)) | (high & ti.u32(0xFF00FF00))


@ti.func
def jumps(a, b, bent, bent_too):
    """Whether the light, or the way it faces, differs much between two pixels of the shaded rows."""
    apart = (a >> 24) - (b >> 24) + ti.u32(ABRUPT)
    turn = (bent & ti.u32(255)) - (bent_too & ti.u32(255)) + ti.u32(TURN)
    turn_too = (bent >> 8 & ti.u32(255)) - (bent_too >> 8 & ti.u32(255)) + ti.u32(TURN)
    return apart > ti.u32(2 * ABRUPT) or turn > ti.u32(2 * TURN) or turn_too > ti.u32(2 * TURN)


@ti.func
def on_surface(
    at,
    over,
    under,
    weight,
    vis: ti.template(),
    picture: ti.template(),
    edge: ti.template(),
    info: ti.template(),
    one_color: ti.template(),
):
    """Whether a pixel lies on the surface that is seen in the shaded rows over and under it, in one light."""
    out = False
    t = triangle(vis, at)
    if t >= 0:
        s, material = info[t, 0], info[t, 1] & 255
        e, f = edge[over], edge[under]
        if ti.cast(e >> 16, ti.i32) == s and ti.cast(f >> 16, ti.i32) == s and one_color[s] != 0:
            w, part = nearness(vis, at), ti.cast(weight, ti.f32) * (1.0 / 256.0)
            line = nearness(vis, over) + (nearness(vis, under) - nearness(vis, over)) * part
            out = ti.abs(w - line) < DEEP * w * w and material != GLASS and material != GLOW
            out = out and not jumps(picture[over], picture[under], e, f)
    return out


@ti.kernel
def match_runs(
    rows: i2,
    info: i2,
    one_color: i1,
    vis_at: u64s,
    picture_at: u32s,
    edge_at: u32s,
    vis: qv,
    picture: uv,
    edge: uv,
    solid: i1,
    level: i1,
    left: i1,
    runs: ti.i32,
    queue: i1,
    slots: ti.i32,
    host: ti.template(),
):
    """Colours of the rows in between, sixteen pixels at a time, where rows are ``runs`` whole runs.

    rows [K, 4]: as in :func:`planned`; left: bits of the pixels of each run that are still to be shaded
    vis_at, picture_at, edge_at: the memory of vis, picture and edge
    """
    for slot in range(slots):
        i = crew.task(slot, rows.shape[0], queue, host)
        if i < rows.shape[0]:
            lanes = ti.Vector([ti.i32(1 << lane) for lane in range(RUN)])
            nothing = lanes * 0
            weight = rows[i, 3]
            for run in range(runs):
                k = rows[i, 0] * runs + run
                if level[k] >= SHADE:
                    upper, lower = rows[i, 1] * runs + run, rows[i, 2] * runs + run
                    own = ti.cast(vis[k], ti.u32)
                    over, under = ti.cast(vis[upper], ti.u32), ti.cast(vis[lower], ti.u32)
                    a, b = picture[upper], picture[lower]
                    bent, bent_too = edge[upper], edge[lower]
                    apart = (a >> 24) - (b >> 24) + ti.u32(ABRUPT)
                    turn = (bent & ti.u32(255)) - (bent_too & ti.u32(255)) + ti.u32(TURN)
                    turn_too = (bent >> 8 & ti.u32(255)) - (bent_too >> 8 & ti.u32(255)) + ti.u32(TURN)
                    jumps = ti.select(apart > ti.u32(2 * ABRUPT), lanes, nothing)
                    jumps = ti.select(turn > ti.u32(2 * TURN), lanes, jumps)
                    jumps = ti.select(turn_too > ti.u32(2 * TURN), lanes, jumps)
                    one = ti.select(own == under, nothing, lanes)
                    lost = 0
                    if weight > 128:
                        lost = ti.select(own == under, ti.select(own == over, jumps, nothing), lanes).sum()
                    else:
                        lost = ti.select(own == over, ti.select(own == under, jumps, nothing), lanes).sum()
                    value = 0
                    if lost == 0:
                        value = solid[upper]
                        # at the border of two triangles either may fill it
                        if value != solid[lower] and ti.select(own == over, nothing, lanes).sum() != 0:
                            value = solid[lower] if one.sum() == 0 else 0
                    solid[k] = value
                    between = ti.select(own == under, mixed(a, b, weight), a)
                    picture[k] = ti.select(own == over, between, b)
                    between = ti.select(own == under, mixed(bent, bent_too, weight), bent)
                    edge[k] = ti.select(own == over, between, bent_too)
                    bits = lost
                    while bits != 0:
                        lane = 31 - ti.math.clz(bits)
                        bits ^= 1 << lane
                        at, high, low = k * RUN + lane, upper * RUN + lane, lower * RUN + lane
                        if on_surface(at, high, low, weight, vis_at, picture_at, edge_at, info, one_color):
                            lost ^= 1 << lane
                            picture_at[at] = mixed(picture_at[high], picture_at[low], weight)
                            edge_at[at] = mixed(edge_at[high], edge_at[low], weight)
                    left[k] = lost


@ti.kernel
def match_rows(
    rows: i2,
    info: i2,
    one_color: i1,
    vis: u64s,
    picture: u32s,
    edge: u32s,
    solid: i1,
    level: i1,
    left: i1,
    width: ti.i32,
    queue: i1,
    slots: ti.i32,
    host: ti.template(),
):
    """The same pixel by pixel."""
    runs = (width + RUN - 1) // RUN
    for slot in range(slots):
        i = crew.task(slot, rows.shape[0], queue, host)
        if i < rows.shape[0]:
            weight = rows[i, 3]
            for run in range(runs):
                k = rows[i, 0] * runs + run
                if level[k] >= SHADE:
                    upper, lower = rows[i, 1] * runs + run, rows[i, 2] * runs + run
                    not_upper, not_lower, lost, taken = 0, 0, 0, 0
                    for x in range(run * RUN, ti.min(width, run * RUN + RUN)):
                        bit = 1 << (x - run * RUN)
                        at = rows[i, 0] * width + x
                        over, under = rows[i, 1] * width + x, rows[i, 2] * width + x
                        t = triangle(vis, at)
                        a, b = picture[over], picture[under]
                        bent, bent_too = edge[over], edge[under]
                        above, below = t == triangle(vis, over), t == triangle(vis, under)
                        if not above:
                            not_upper |= bit
                        if not below:
                            not_lower |= bit
                        picture[at] = b
                        edge[at] = bent_too
                        if above:
                            picture[at] = mixed(a, b, weight) if below else a
                            edge[at] = mixed(bent, bent_too, weight) if below else bent
                        if above and below:
                            if jumps(a, b, bent, bent_too):
                                lost |= bit
                        elif not (below if weight > 128 else above):
                            lost |= bit
                            if on_surface(at, over, under, weight, vis, picture, edge, info, one_color):
                                taken |= bit
                                picture[at] = mixed(a, b, weight)
                                edge[at] = mixed(bent, bent_too, weight)
                    left[k] = lost & ~taken
                    value = 0
                    if lost == 0:
                        if not_upper == 0:
                            value = solid[upper]
                        elif not_lower == 0:
                            value = solid[lower]
                    solid[k] = value
