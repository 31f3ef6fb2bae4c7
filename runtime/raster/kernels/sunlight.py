"""Sunlight that falls through windows: patches on floors and walls of the set, laid over the shaded picture.

The key light of an interior is a film light that no wall keeps off; this is the sun itself, which comes in
through windows alone. It has a shadow map of its own, of all that is opaque in the set, and falls along the
key light, so that whoever stands in it throws the shadow that is there already.
"""

# mypy: ignore-errors
# Taichi reads annotations as kernel types and parses the bodies itself.

import taichi as ti

from . import crew
from .chart import DARK, LIT, MIXED, SHADOW_SHIFT, cell_at, kind_along
from .geometry import bounded, f1, f2, i1, i2, nearness, part3, row3, triangle, u8s, u32s, u64s, vec3
from .light import across, dimming, free_between, lifted, lit, lit_by_all
from .paint import RUN, SHADE, SHEET, decode, encode
from .rows import EVERY
from .sheet import shadow_class

GRAZING = 0.08  # cosine to the sun below which a surface takes none


@ti.kernel
def sunny(
    vertices: f2,
    normals: f2,
    faces: i2,
    light: f1,
    basis: f1,
    frame: f2,
    size: ti.i32,
    depth_map: f1,
    coarse: f1,
    count: ti.i32,
    sheet: f1,
):
    """How the sun falls on the first ``count`` triangles, where :func:`.chart.survey` looks for it: on the
    side that is turned to the sun."""
    for t in range(count):
        p = row3(vertices, faces[t, 0])
        n = row3(normals, faces[t, 0])
        facing = n.dot(vec3(light[0], light[1], light[2]))
        kind = DARK
        if ti.abs(facing) > GRAZING:
            if facing < 0:
                n = -n
            q1, q2 = row3(vertices, faces[t, 1]) - p, row3(vertices, faces[t, 2]) - p
            kind = shadow_class(p, q1, q2, n, basis, frame, size, depth_map, coarse)
        for i in range(2):
            sheet[(2 * t + i) * SHEET + 11] = ti.bit_cast(kind << SHADOW_SHIFT, ti.f32)


@ti.kernel
def keep(sheet: f1, begin: i1, side: i1, count: ti.i32, chart: u8s, whole: u8s):
    """The kind of each triangle; MIXED ones whose cells are all DARK are DARK."""
    for t in range(count):
        kind = ti.bit_cast(sheet[2 * t * SHEET + 11], ti.i32) >> SHADOW_SHIFT
        if kind == MIXED and side[t] > 1:
            kind = DARK
            for j in range(side[t]):
                for i in range(side[t] - j):
                    if chart[begin[t] + j * side[t] + i] != DARK:
                        kind = MIXED
        whole[t] = ti.cast(kind, ti.u8)


@ti.kernel
def lay_sun(
    view: f2,
    moment: i1,
    sheet: f1,
    light: f1,
    sun: f1,
    basis: f1,
    set_frame: f2,
    set_size: ti.i32,
    set_depth: f1,
    set_coarse: f1,
    frame: f2,
    size: ti.i32,
    depth_map: f1,
    coarse: f1,
    each: ti.i32,
    home: i1,
    home_frame: f2,
    home_size: ti.i32,
    home_depth: f1,
    home_coarse: f1,
    plot: f1,
    begin: i1,
    side: i1,
    chart: u8s,
    whole: u8s,
    static_faces: ti.i32,
    linear: f1,
    table: u32s,
    vis: u64s,
    level: i1,
    solid: i1,
    picture: u32s,
    lines: i1,
    sparse: ti.i32,
    left: i1,
    width: ti.i32,
    height: ti.i32,
    queue: i1,
    slots: ti.i32,
    host: ti.template(),
):
    """Lighten ``picture`` where the sun falls on the set. sun: how much, for red, green and blue

    lines: the rows to work on; sparse: whether only the pixels that ``left`` says (as in shading)
    """
    for slot in range(slots):
        j = crew.task(slot, lines.shape[0], queue, host)
        if j < lines.shape[0]:
            line = lines[j]
            n = line // height
            y = line % height
            m = moment[n]
            eye = part3(view, n, 0)
            step = part3(view, n, 3) / view[n, 12]
            first = (
                part3(view, n, 9)
                + part3(view, n, 6) * ((view[n, 15] - (y + 0.5)) / view[n, 13])
                + step * (0.5 - view[n, 14])
            )
            h = home[m]
            home_texel, set_texel = 1.0 / home_frame[h, 2], 1.0 / set_frame[0, 2]
            towards = vec3(light[0], light[1], light[2])
            warm = vec3(sun[0], sun[1], sun[2])
            runs = (width + RUN - 1) // RUN
            last, side_t = -1, 1
            of_all = DARK  # kind of the last triangle, as it is seen
            n_l, home_off, set_off, gain = vec3(0), vec3(0), vec3(0), vec3(0)
            for run in range(runs):
                filled = solid[line * runs + run]  # by a triangle of the set alone
                todo = left[line * runs + run] if sparse == 1 else EVERY
                some = level[line * runs + run] >= SHADE and todo != 0 and filled >= 0
                if some and filled > 0:
                    some = whole[filled - 1] != DARK
                x = run * RUN
                limit = ti.min(x + RUN, width) if some else x
                while x < limit:
                    at = line * width + x
                    t = triangle(vis, at)
                    stop = limit if filled > 0 else x + 1
                    while stop < limit and triangle(vis, at + stop - x) == t:
                        stop += 1
                    bits = ((1 << (stop - x)) - 1) << (x % RUN)
                    if t != last and todo & bits != 0:
                        last = t
                        of_all = DARK
                        if 0 <= t < static_faces:
                            of_all = ti.cast(whole[t], ti.i32)
                        if of_all != DARK:
                            row = 2 * t * SHEET
                            plane = vec3(sheet[row + 12], sheet[row + 13], sheet[row + 14])
                            nn = vec3(sheet[row], sheet[row + 1], sheet[row + 2])
                            if plane.dot(eye) < sheet[row + 15]:
                                nn = -nn
                            facing = nn.dot(towards)
                            if facing > GRAZING:
                                side_t = side[t]
                                n_l = across(basis, nn)
                                home_off, set_off = lifted(n_l, home_texel), lifted(n_l, set_texel)
                                gain = warm * bounded(0.3 + 0.8 * facing, 0.0, 1.0)
                            else:
                                of_all = DARK
                    if t == last and of_all != DARK and todo & bits != 0:
                        kind = of_all
                        p = eye + (first + step * ti.cast(x, ti.f32)) / nearness(vis, at)
                        end = eye + (first + step * ti.cast(stop - 1, ti.f32)) / nearness(
                            vis, at + stop - 1 - x
                        )
                        celled = kind == MIXED and side_t > 1
                        if celled:
                            cell, cell_end = cell_at(t, p, plot, side_t), cell_at(t, end, plot, side_t)
                            kind = kind_along(t, p, end, cell, cell_end, plot, begin, side_t, chart)
                        if kind != DARK:
                            q, q_end = across(basis, p), across(basis, end)
                            dim = dimming(q, q_end, n_l, m, each, frame, size, coarse)
                            home_clear = free_between(
                                q + home_off, q_end + home_off, h, home_frame, home_size, home_coarse
                            )
                            for xx in range(x, stop):
                                i = at + xx - x
                                amount = ti.cast((todo >> (xx % RUN)) & 1, ti.f32)
                                if amount > 0 and not (dim == 0 and home_clear and kind == LIT):
                                    p = eye + (first + step * ti.cast(xx, ti.f32)) / nearness(vis, i)
                                    here = kind
                                    if kind == MIXED and celled:
                                        cell = cell_at(t, p, plot, side_t)
                                        here = ti.cast(chart[begin[t] + cell[1] * side_t + cell[0]], ti.i32)
                                    q = across(basis, p)
                                    if here == DARK:
                                        amount = 0.0
                                    elif here == MIXED:
                                        amount = lit(
                                            q + set_off, 0, set_frame, set_size, set_depth, set_coarse
                                        )
                                    if amount > 0 and dim != 0:
                                        amount *= lit_by_all(
                                            q, n_l, dim, m, each, frame, size, depth_map, coarse
                                        )
                                    if amount > 0 and not home_clear:
                                        amount *= lit(
                                            q + home_off, h, home_frame, home_size, home_depth, home_coarse
                                        )
                                if amount > 0:
                                    color = decode(picture[i], linear)
                                    picture[i] = encode(color + color * gain * amount * (1.2 - color), table)
                    x = stop
