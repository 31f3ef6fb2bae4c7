"""What changes in the picture of a camera that does not move, and what can be taken over from the empty set.

Rows are worked on in runs of RUN pixels; a block is RUN runs one under the other. A run is drawn anew where
something moving is in it or beside it, or where its light may not be that of the empty set: where it is not
clear of the moment's shadow map or of what stands on the floor; and with it all runs of its band of rows,
which are shaded together. Around those runs lines are drawn anew, and
around these stair-steps are smoothed anew; everything else is copied. For the host, and rows of whole runs.
"""

# mypy: ignore-errors
# Taichi reads annotations as kernel types and parses the bodies itself.

import taichi as ti

from . import crew
from .chart import DARK, MIXED, SHADOW_SHIFT, cell_at
from .contact import above_floor, floor_cell
from .geometry import (
    f1,
    f2,
    f3,
    greater,
    i1,
    i2,
    item3,
    lesser,
    nearness,
    part3,
    triangle,
    u8s,
    u64s,
    vec3,
)
from .light import MANY, across, clear_over, lift_of
from .paint import DONE, INK, RUN, SHADE, SHEET, SMOOTH
from .rows import BAND
from .spans import uv

NOWHERE, SHADED, INKED, FINAL = 0, 1, 2, 4  # what is copied into a run
REACH = 9  # numbers kept of what a run sees: its bounds across the light, and over the floor
HIGH = (1, 3, 6, 8)  # those that are upper bounds
quads = ti.types.ndarray(dtype=ti.types.vector(4, ti.u32), ndim=1)


@ti.kernel
def reach_of(
    view: f2,
    vis: u64s,
    basis: f1,
    sheet: f1,
    static_faces: ti.i32,
    plot: f1,
    begin: i1,
    side: i1,
    chart: u8s,
    sunny: ti.i32,
    sun_begin: i1,
    sun_side: i1,
    sun_chart: u8s,
    sun_whole: u8s,
    faces: i2,
    static_vertices: ti.i32,
    normal: f3,
    position: f3,
    nobody: ti.i32,
    light: f1,
    floor: f1,
    tops: f1,
    columns: ti.i32,
    rows: ti.i32,
    views: ti.i32,
    width: ti.i32,
    height: ti.i32,
    reach: f1,
    queue: i1,
    slots: ti.i32,
    host: ti.template(),
):
    """Where what may change of each tile of an empty set (BAND rows of a run) lies in the light, the first
    pixel of its neighbour included: what no light reaches, no shadow darkens, and nothing stands on a wall.

    chart, sun_chart, sun_whole: how the set shades the key light, and the sun through windows, if it is
    ``sunny``; nobody: the moment in which the parts of the set that move are as they rest
    reach, REACH numbers a tile: light coordinates low x, high x, low y, high y, low z of what may be lit;
    then low x, high x, low y, high y in the world of what may be stood on. Low above high where nothing is.
    """
    runs = (width + RUN - 1) // RUN
    tiles = (height + BAND - 1) // BAND
    for slot in range(slots):
        task = crew.task(slot, views * tiles, queue, host)
        if task < views * tiles:
            n, top = task // tiles, (task % tiles) * BAND
            eye = part3(view, n, 0)
            step = part3(view, n, 3) / view[n, 12]
            for run in range(runs):
                low, high = vec3(1e30), vec3(-1e30)
                floor_low, floor_high = vec3(1e30), vec3(-1e30)
                for y in range(top, ti.min(height, top + BAND)):
                    first = (
                        part3(view, n, 9)
                        + part3(view, n, 6) * ((view[n, 15] - (y + 0.5)) / view[n, 13])
                        + step * (0.5 - view[n, 14])
                    )
                    line = n * height + y
                    for x in range(run * RUN, ti.min(width, run * RUN + RUN + 1)):
                        t = triangle(vis, line * width + x)
                        if t >= 0:
                            p = eye + (first + step * ti.cast(x, ti.f32)) * (
                                1.0 / nearness(vis, line * width + x)
                            )
                            lit, up = False, 0.0
                            if t >= static_faces:
                                lit = turned_to(
                                    t, eye, nobody, faces, static_vertices, position, normal, light
                                )
                            else:
                                row = 2 * t * SHEET
                                plane = vec3(sheet[row + 12], sheet[row + 13], sheet[row + 14])
                                if plane.dot(eye) < sheet[row + 15]:
                                    row += SHEET
                                up = sheet[row + 2]
                                lit = in_light(t, row, p, sheet, plot, begin, side, chart)
                                if sunny == 1 and not lit:
                                    lit = ti.cast(sun_whole[t], ti.i32) != DARK
                                    if lit and sun_side[t] > 1:
                                        lit = kind_at(t, p, plot, sun_begin, sun_side[t], sun_chart) != DARK
                            if lit:
                                q = across(basis, p)
                                low, high = ti.min(low, q), ti.max(high, q)
                            if up > 0.7 and may_be_stood_on(p, floor, tops, columns, rows):
                                floor_low, floor_high = ti.min(floor_low, p), ti.max(floor_high, p)
                at = (task * runs + run) * REACH
                for a in ti.static(range(2)):
                    reach[at + 2 * a] = low[a]
                    reach[at + 2 * a + 1] = high[a]
                    reach[at + 5 + 2 * a] = floor_low[a]
                    reach[at + 6 + 2 * a] = floor_high[a]
                reach[at + 4] = low.z


@ti.func
def in_light(
    t,
    row,
    p,
    sheet: ti.template(),
    plot: ti.template(),
    begin: ti.template(),
    side: ti.template(),
    chart: ti.template(),
):
    """Whether the key light may reach a place on a side of a triangle of the set, past all of the set."""
    flags = ti.bit_cast(sheet[row + 11], ti.i32)
    kind = flags >> SHADOW_SHIFT
    if kind == MIXED and (flags >> 8) & 1 == 1:
        kind = kind_at(t, p, plot, begin, side[t], chart)
    return sheet[row + 3] > 0 and kind != DARK


@ti.func
def turned_to(
    t,
    eye,
    m,
    faces: ti.template(),
    static_vertices,
    position: ti.template(),
    normal: ti.template(),
    light: ti.template(),
):
    """Whether any of a triangle that moves, as the eye sees it, is turned to the key light."""
    sun = vec3(light[0], light[1], light[2])
    a, b, c = faces[t, 0] - static_vertices, faces[t, 1] - static_vertices, faces[t, 2] - static_vertices
    p = item3(position, m, a)
    cross = (item3(position, m, b) - p).cross(item3(position, m, c) - p)
    side = -1.0 if cross.dot(p - eye) > 0 else 1.0
    most = -1.0
    for k in ti.static(range(3)):
        corner = faces[t, k] - static_vertices
        most = ti.max(most, side * item3(normal, m, corner).dot(sun))
    return most > 0


@ti.func
def kind_at(t, p, plot: ti.template(), begin: ti.template(), side, chart: ti.template()):
    """The kind of the cell that a place of a triangle lies in."""
    cell = cell_at(t, p, plot, side)
    return ti.cast(chart[begin[t] + cell[1] * side + cell[0]], ti.i32)


@ti.func
def may_be_stood_on(p, floor: ti.template(), tops: ti.template(), columns, rows):
    """Whether a place is at the height of the floor, or of what stands on it (:func:`.ambient.sheltered`)."""
    cell = floor_cell(p, floor, columns, rows)
    on_top = False
    if cell >= 0:
        on_top = ti.abs(p.z - tops[cell]) < 0.07
    return on_top or above_floor(p.z, floor) < 0.21


@ti.kernel
def widen(reach: f1, views: ti.i32, width: ti.i32, height: ti.i32, wide: f1):
    """Where each block of an empty set lies, as :func:`reach_of` says it of tiles."""
    runs = (width + RUN - 1) // RUN
    bands = (height + RUN - 1) // RUN
    tiles = (height + BAND - 1) // BAND
    each = ti.static(RUN // BAND)
    for task in range(views * bands):
        n, band = task // bands, task % bands
        for run in range(runs):
            to = (task * runs + run) * REACH
            for a in ti.static(range(REACH)):
                far = ti.static(a in HIGH)
                best = -1e30 if far else 1e30
                for tile in range(band * each, ti.min(tiles, band * each + each)):
                    own = reach[((n * tiles + tile) * runs + run) * REACH + a]
                    best = greater(best, own) if far else lesser(best, own)
                wide[to + a] = best


@ti.func
def shaded(at, m, reach: ti.template(), frame: ti.template(), size, coarse: ti.template()):
    """Whether anything of a shadow map may be in the light of a tile."""
    out = False
    if reach[at] <= reach[at + 1]:
        lift = lift_of(1.0 / frame[m, 2])
        low = vec3(reach[at], reach[at + 2], reach[at + 4]) - lift
        high = vec3(reach[at + 1], reach[at + 3], 0.0) + lift
        out = not clear_over(low, high, m, frame, size, coarse)
    return out


@ti.func
def differs(ground: ti.template(), at, rest, cells):
    """Whether what stands in a cell of the floor, or over it, is not what rests there."""
    return ground[at] != ground[rest] or ground[at + cells] != ground[rest + cells]


@ti.func
def stood_on(
    at,
    m,
    rest,
    bounds: ti.template(),
    reach: ti.template(),
    floor: ti.template(),
    columns,
    rows,
    ground: ti.template(),
):
    """Whether anything stands on the floor, or on furniture, where a run is, but for what does in moment
    ``rest``."""
    out = False
    if reach[at + 5] <= reach[at + 6]:
        wide, deep = ti.cast(columns, ti.f32), ti.cast(rows, ti.f32)
        left = greater((reach[at + 5] - floor[0]) * floor[2] - 1.5, 0.0)
        right = lesser((reach[at + 6] - floor[0]) * floor[2] + 1.5, wide - 1)
        low = greater((reach[at + 7] - floor[1]) * floor[2] - 1.5, 0.0)
        high = lesser((reach[at + 8] - floor[1]) * floor[2] + 1.5, deep - 1)
        if left <= right and low <= high:
            i0, i1_ = (
                ti.max(ti.cast(left, ti.i32), bounds[m, 0]),
                ti.min(ti.cast(right, ti.i32), bounds[m, 1]),
            )
            j0, j1 = ti.max(ti.cast(low, ti.i32), bounds[m, 2]), ti.min(ti.cast(high, ti.i32), bounds[m, 3])
            if i0 > i1_ or j0 > j1:
                out = False
            elif (i1_ - i0 + 1) * (j1 - j0 + 1) > 4 * MANY:
                out = True
            else:
                for j in range(j0, j1 + 1):
                    for i in range(i0, i1_ + 1):
                        cell = (2 * m * rows + j) * columns + i
                        still = (2 * rest * rows + j) * columns + i
                        if differs(ground, cell, still, rows * columns):
                            out = True
    return out


@ti.kernel
def find(
    moment: i1,
    empty: i1,
    vis: u64s,
    empty_vis: u64s,
    touched: i1,
    reach: f1,
    wide: f1,
    frame: f2,
    size: ti.i32,
    coarse: f1,
    maps: ti.i32,
    home: i1,
    home_frame: f2,
    home_size: ti.i32,
    home_changed: f1,
    floor: f1,
    columns: ti.i32,
    rows: ti.i32,
    ground: f1,
    rest: ti.i32,
    bounds: i2,
    box: i2,
    views: ti.i32,
    width: ti.i32,
    height: ti.i32,
    level: i1,
    block: i1,
    queue: i1,
    slots: ti.i32,
    host: ti.template(),
):
    """Which runs are drawn anew, all of a tile or none: their level is SHADE, others' DONE.

    block: 1 where one of its runs is
    frame, size, coarse: the moments' own shadow maps, ``maps`` of one moment; home, home_changed: the home
    map of each moment, and what lies in its light and not in that of moment ``rest``
    empty: of each view, the picture of the empty set that it goes by, -1 for none; touched: of each run,
    whether something that moves may be in it; box [views, 4]: columns and rows in which there may be
    glass that moves
    """
    runs = (width + RUN - 1) // RUN
    bands = (height + RUN - 1) // RUN
    tiles = (height + BAND - 1) // BAND
    each = ti.static(RUN // BAND)
    for slot in range(slots):
        task = crew.task(slot, views * bands, queue, host)
        if task < views * bands:
            n, band = task // bands, task % bands
            m, s = moment[n], empty[n]
            for run in range(runs):
                some = 0
                clear = False  # whether the light of the whole block is that of the empty set
                if s >= 0:
                    at = ((s * bands + band) * runs + run) * REACH
                    clear = not stood_on(at, m, rest, bounds, wide, floor, columns, rows, ground)
                    for k in range(m * maps, m * maps + maps):
                        if clear:
                            clear = not shaded(at, k, wide, frame, size, coarse)
                    if clear and home[m] != home[rest]:
                        clear = not shaded(at, home[m], wide, home_frame, home_size, home_changed)
                for tile in range(band * each, ti.min(tiles, band * each + each)):
                    bottom = ti.min(height, tile * BAND + BAND)
                    x = run * RUN
                    anew = s < 0
                    for y in range(tile * BAND, bottom):
                        k = (n * height + y) * runs + run
                        here, there = (n * height + y) * width, (s * height + y) * width
                        if not anew and touched[k] != 0:
                            i = x
                            while i < width and i < x + RUN and not anew:
                                anew = vis[here + i] != empty_vis[there + i]
                                i += 1
                        # the last pixel of the run before and the first of the next one have a say
                        if not anew and run > 0 and touched[k - 1] != 0:
                            anew = vis[here + x - 1] != empty_vis[there + x - 1]
                        if not anew and run < runs - 1 and touched[k + 1] != 0:
                            anew = vis[here + x + RUN] != empty_vis[there + x + RUN]
                        if box[n, 2] <= y < box[n, 3] and x < box[n, 1] and x + RUN > box[n, 0]:
                            anew = True
                    if not anew and not clear:
                        at = ((s * tiles + tile) * runs + run) * REACH
                        anew = stood_on(at, m, rest, bounds, reach, floor, columns, rows, ground)
                        for k in range(m * maps, m * maps + maps):
                            if not anew:
                                anew = shaded(at, k, reach, frame, size, coarse)
                        if not anew and home[m] != home[rest]:
                            anew = shaded(at, home[m], reach, home_frame, home_size, home_changed)
                    for y in range(tile * BAND, bottom):
                        level[(n * height + y) * runs + run] = SHADE if anew else DONE
                    if anew:
                        some = 1
                block[task * runs + run] = some


@ti.kernel
def settle(
    block: i1,
    whole: ti.i32,
    views: ti.i32,
    width: ti.i32,
    height: ti.i32,
    level: i1,
    source: i1,
    queue: i1,
    slots: ti.i32,
    host: ti.template(),
):
    """The levels of all runs, and in ``source`` what is copied into each: SHADED, INKED or FINAL colours.

    whole: all pictures are to be complete before they are smoothed, for what is laid over them
    """
    runs = (width + RUN - 1) // RUN
    bands = (height + RUN - 1) // RUN
    for slot in range(slots):
        task = crew.task(slot, views * bands, queue, host)
        if task < views * bands:
            n, band = task // bands, task % bands
            for run in range(runs):
                away = 4  # blocks to the nearest that is drawn anew
                for j in range(ti.max(band - 3, 0), ti.min(bands, band + 4)):
                    for i in range(ti.max(run - 3, 0), ti.min(runs, run + 4)):
                        if block[(n * bands + j) * runs + i] == 1:
                            away = ti.min(away, ti.max(ti.abs(j - band), ti.abs(i - run)))
                for y in range(band * RUN, ti.min(height, band * RUN + RUN)):
                    k = (n * height + y) * runs + run
                    source[k] = NOWHERE
                    if level[k] != SHADE:
                        if away <= 1:
                            level[k] = INK
                            source[k] = SHADED
                        elif away == 2 or whole == 1:
                            level[k] = SMOOTH
                            source[k] = INKED
                        else:
                            source[k] = INKED + FINAL if away == 3 else FINAL


@ti.kernel
def take_over(
    empty: i1,
    source: i1,
    empty_shaded: uv,
    empty_edge: uv,
    empty_solid: i1,
    empty_inked: uv,
    empty_marks: i1,
    empty_final: quads,
    picture: uv,
    edge: uv,
    solid: i1,
    marks: i1,
    final: quads,
    views: ti.i32,
    runs: ti.i32,
    height: ti.i32,
    queue: i1,
    slots: ti.i32,
    host: ti.template(),
):
    """Copy from the empty sets what :func:`settle` said. Rows are whole runs."""
    for slot in range(slots):
        line = crew.task(slot, views * height, queue, host)
        if line < views * height:
            begin = line * runs
            there = (empty[line // height] * height + line % height) * runs
            for run in range(runs):
                what = source[begin + run]
                k, from_k = begin + run, there + run
                if what != NOWHERE and what != FINAL:
                    edge[k] = empty_edge[from_k]
                    solid[k] = empty_solid[from_k]
                    if what == SHADED:
                        picture[k] = empty_shaded[from_k]
                    else:
                        picture[k] = empty_inked[from_k]
                        marks[k] = empty_marks[from_k]
                if what >= FINAL:
                    for i in ti.static(range(3)):
                        final[3 * k + i] = empty_final[3 * from_k + i]
