"""Sunlight that falls through windows: patches on floors and walls of the set, laid over the shaded picture.

The key light of an interior is a film light that no wall keeps off; this is the sun itself, which comes in
through windows alone. It has a shadow map of its own, of all that is opaque in the set, and falls along the
key light, so that whoever stands in it throws the shadow that is there already.
"""

# mypy: ignore-errors
# Taichi reads annotations as kernel types and parses the bodies itself.

import taichi as ti

from .ambient import lift_of, rise_of
from .chart import DARK, LIT, MIXED, SHADOW_SHIFT, cell_at
from .geometry import bounded, f1, f2, i1, i2, nearness, part3, row3, triangle, u8s, u32s, u64s, vec3
from .light import across, lit
from .paint import RUN, SHADE, SHEET, decode, encode
from .sheet import shadow_class

STEP = 4  # pixels between places of which it is asked whether any sun may be near
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
    picture: u32s,
    views: ti.i32,
    width: ti.i32,
    height: ti.i32,
):
    """Lighten ``picture`` where the sun falls on the set. sun: how much, for red, green and blue"""
    for line in range(views * height):
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
        texel, set_texel = 1.0 / frame[m, 2], 1.0 / set_frame[0, 2]
        towards = vec3(light[0], light[1], light[2])
        warm = vec3(sun[0], sun[1], sun[2])
        runs = (width + RUN - 1) // RUN
        x = 0
        while x < width:
            at = line * width + x
            t = triangle(vis, at)
            kind = DARK
            if 0 <= t < static_faces and level[line * runs + x // RUN] >= SHADE:
                kind = ti.cast(whole[t], ti.i32)
            stop = ti.min((x // STEP + 1) * STEP, width)
            if kind == DARK and triangle(vis, line * width + stop - 1) == t:
                x = stop  # most of a picture
            else:
                if kind != DARK:
                    row = 2 * t * SHEET
                    plane = vec3(sheet[row + 12], sheet[row + 13], sheet[row + 14])
                    nn = vec3(sheet[row], sheet[row + 1], sheet[row + 2])
                    if plane.dot(eye) < sheet[row + 15]:
                        nn = -nn
                    facing = nn.dot(towards)
                    if facing > GRAZING:
                        p = eye + (first + step * ti.cast(x, ti.f32)) / nearness(vis, at)
                        if kind == MIXED and side[t] > 1:
                            cell = cell_at(t, p, plot, side[t])
                            kind = ti.cast(chart[begin[t] + cell[1] * side[t] + cell[0]], ti.i32)
                        amount = ti.cast(kind != DARK, ti.f32)
                        if amount > 0:
                            q, n_l = across(basis, p), across(basis, nn)
                            if kind != LIT:
                                at_set = q + n_l * lift_of(set_texel) + vec3(0, 0, rise_of(set_texel))
                                amount = lit(at_set, 0, set_frame, set_size, set_depth, set_coarse)
                            if amount > 0:
                                here = q + n_l * lift_of(texel) + vec3(0, 0, rise_of(texel))
                                amount *= lit(here, m, frame, size, depth_map, coarse)
                            if amount > 0:
                                color = decode(picture[at], linear)
                                gain = warm * (amount * bounded(0.3 + 0.8 * facing, 0.0, 1.0))
                                picture[at] = encode(color + color * gain * (1.2 - color), table)
                x += 1
