"""Shading: every pixel of a visibility buffer to a colour, and to what the ink lines are drawn from.

Works in linear light and encodes to sRGB at the end; patterns are put on later (pattern.py).
"""

# mypy: ignore-errors
# Taichi reads annotations as kernel types and parses the bodies itself.

from functools import lru_cache
from types import SimpleNamespace

import taichi as ti

from ..types import Style
from . import crew
from .ambient import area_near, sheltered, toned
from .chart import DARK, LIT, MIXED, SHADOW_SHIFT, cell_at, kind_along, survey
from .geometry import (
    bounded,
    f1,
    f2,
    f3,
    i1,
    i2,
    item3,
    nearness,
    part3,
    row3,
    triangle,
    u8s,
    u16s,
    u32s,
    u64s,
    vec3,
)
from .lamps import lamplight
from .light import ALL, across, dimming, free_between, lifted, lit, lit_by_all
from .paint import (
    GLASS,
    GLOW,
    NOTHING,
    RUN,
    SHADE,
    SHEET,
    backdrop,
    developed,
    exposed,
    pack_normal,
    packed,
    spread,
)
from .pattern import broad_pattern, glazed
from .rows import EVERY
from .sheet import fold_kernel

CLAY_DEPTH = 1.9  # how much deeper the corners are in clay
#: The air: from so many metres on it grows by so much a metre, and takes at most so much of the colour of
#: sets and of people.
CLEAR, THICKENS, HAZE_SET, HAZE_PEOPLE = 2.0, 0.04, 0.27, 0.12
ABRUPT = 0.05  # difference of key light over a few pixels, above which each is looked up


@lru_cache(maxsize=8)
def shading_kernels(style: Style) -> SimpleNamespace:
    """The shading kernel of a style."""
    tones = style.tones
    shadows = style.shadows
    occlusion = style.occlusion
    deep = CLAY_DEPTH if style.clay else 1.0

    @ti.kernel
    def shade_rows(
        view: f2,
        moment: i1,
        vertices: f2,
        normals: f2,
        position: f3,
        normal: f3,
        faces: i2,
        color: f2,
        info: i2,
        sheet: f1,
        plot: f1,
        begin: i1,
        side: i1,
        chart: u8s,
        static_faces: ti.i32,
        static_vertices: ti.i32,
        light: f1,
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
        nx: ti.i32,
        ny: ti.i32,
        nz: ti.i32,
        volume_low: f1,
        values: f1,
        lamps: f1,
        floor: f1,
        tops: f1,
        columns: ti.i32,
        rows: ti.i32,
        ground: f1,
        film: u16s,
        lattice: f1,
        vis: u64s,
        picture: u32s,
        edge: u32s,
        solid: i1,
        level: i1,
        lines: i1,
        sparse: ti.i32,
        left: i1,
        width: ti.i32,
        height: ti.i32,
        queue: i1,
        slots: ti.i32,
        host: ti.template(),
    ):
        """light: sun 3, sun colour 3, sky 3, ground 3, horizon 3, zenith 3 (scene light)

        solid: the triangle + 1 of the set that fills each RUN of pixels alone, 0 for none,
        -1 for the backdrop; level: of each RUN, below SHADE what is there already
        lines: the rows to shade; sparse: whether only where ``left`` says so, bits of the pixels of each RUN,
        to which are added those that are shaded along with them
        """
        for slot in range(slots):
            j = crew.task(slot, lines.shape[0], queue, host)
            if j < lines.shape[0]:
                line = lines[j]
                runs = (width + RUN - 1) // RUN
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
                sun = vec3(light[0], light[1], light[2])
                sun_color = vec3(light[3], light[4], light[5])
                # people get a weaker light from over the camera's left shoulder: a back-lit face has form
                fill = (
                    part3(view, n, 6) * 0.6 - part3(view, n, 3) * 0.62 - part3(view, n, 9) * 0.5
                ).normalized()
                sky = vec3(light[6], light[7], light[8])
                under = vec3(light[9], light[10], light[11])
                horizon = vec3(light[12], light[13], light[14])
                zenith = vec3(light[15], light[16], light[17])
                corner = vec3(volume_low[0], volume_low[1], volume_low[2])
                # the row in light coordinates
                eye_l, first_l, step_l = across(basis, eye), across(basis, first), across(basis, step)
                h = home[m]
                home_texel, set_texel = 1.0 / home_frame[h, 2], 1.0 / set_frame[0, 2]
                last = -1
                p0, g1, g2 = vec3(0), vec3(0), vec3(0)
                n0, n1, n2 = vec3(0), vec3(0), vec3(0)
                n_l = vec3(0)
                base, ambient, direct = vec3(0), vec3(0), vec3(0)
                facing = 0.0
                shadow = MIXED
                mark = ti.u32(NOTHING)
                flat = True
                material = 0
                # light along a stretch of one triangle of the set: looked up at its ends, mixed in between
                shade, shade_end = 1.0, 1.0
                tone, tone_end = 1.0, 1.0
                haze, haze_end = 0.0, 0.0
                lamp, lamp_end = vec3(0), vec3(0)
                q_end = vec3(0)
                cell_end = ti.Vector([0, 0])
                kind, kind_end = MIXED, MIXED
                end_at = vec3(0)
                joined = False
                painted = False
                paint_end = ti.Vector([0, 0, 0])
                stretch = RUN if height > 400 else RUN // 2
                fine = 4 if height > 400 else 2
                whole = False
                todo = EVERY
                x = 0
                while x < width:
                    if x % RUN == 0:
                        done = True
                        while done and x < width:
                            run = line * runs + x // RUN
                            todo = left[run] if sparse == 1 else EVERY
                            done = level[run] < SHADE or todo == 0
                            if done:
                                x += RUN
                                joined = False
                        if x >= width:
                            break
                    at = line * width + x
                    t = triangle(vis, at)
                    if x % RUN == 0:
                        # the last one first: it is another's in most runs of several triangles
                        i = at + ti.min(RUN, width - x) - 1
                        while i > at and triangle(vis, i) == t:
                            i -= 1
                        whole = i == at
                        value = 0
                        if whole and t < static_faces:
                            value = t + 1 if t >= 0 else -1
                        solid[line * runs + x // RUN] = value
                    if sparse == 1 and (todo >> (x % RUN)) & 1 == 0:
                        # on to the next pixel that is left
                        joined = False
                        further = todo >> (x % RUN)
                        x += ti.math.popcnt((further & -further) - 1) if further != 0 else RUN - x % RUN
                        continue
                    stop = x + 1
                    limit = ti.min(width, (x | (stretch - 1)) + 1)  # stretch: a power of two
                    if sparse == 1:
                        limit = ti.min(limit, x // RUN * RUN + 32 - ti.math.clz(todo))
                    if whole:
                        stop = limit
                    else:
                        while stop < limit and triangle(vis, at + stop - x) == t:
                            stop += 1
                    if sparse == 1:
                        # written out: one thread has the row, and |= would be an atomic operation
                        bits = ((1 << (stop - x)) - 1) << (x % RUN)
                        left[line * runs + x // RUN] = left[line * runs + x // RUN] | bits
                    if t < 0:
                        last = -1
                        joined = False
                        near_end = backdrop(first + step * ti.cast(x, ti.f32), horizon, zenith, film)
                        far_end = backdrop(first + step * ti.cast(stop - 1, ti.f32), horizon, zenith, film)
                        spread(near_end, far_end, stop - 1 - x, ti.u32(NOTHING), at, stop - x, picture, edge)
                    elif t >= static_faces:
                        joined = False
                        if t != last:
                            last = t
                            base = row3(color, t)
                            a, b, c = faces[t, 0] - static_vertices, faces[t, 1] - static_vertices, 0
                            c = faces[t, 2] - static_vertices
                            p0 = item3(position, m, a)
                            q1 = item3(position, m, b) - p0
                            q2 = item3(position, m, c) - p0
                            n0 = item3(normal, m, a)
                            n1 = item3(normal, m, b) - n0
                            n2 = item3(normal, m, c) - n0
                            cross = q1.cross(q2)
                            # seen from behind: turn the normal to the eye
                            if cross.dot(p0 - eye) > 0:
                                n0, n1, n2 = -n0, -n1, -n2
                            inverse = 1.0 / ti.max(cross.norm_sqr(), 1e-20)
                            g1 = q2.cross(cross) * inverse
                            g2 = cross.cross(q1) * inverse
                            p0 -= eye
                            mark = ti.cast(info[t, 0], ti.u32) << 16
                            material = info[t, 1] & 255
                        # every few pixels are shaded, the rest lie between; of a few pixels, the middle one
                        short = stop - x <= fine
                        gap = spaced(stop - x, fine)
                        xx = stop - 1 if short else x
                        before = xx
                        paint = ti.Vector([0, 0, 0])
                        key_before = 0.0
                        more = True
                        while more:
                            i = at + xx - x
                            place = ti.cast(xx, ti.f32)
                            near = nearness(vis, i)
                            if short:
                                place = 0.5 * ti.cast(x + xx, ti.f32)
                                near = 0.5 * (near + nearness(vis, at))
                            ray = first + step * place
                            depth = 1.0 / near
                            d = ray * depth - p0
                            b1 = bounded(d.dot(g1), 0.0, 1.0)
                            b2 = bounded(d.dot(g2), 0.0, 1.0)
                            nn = n0 + n1 * b1 + n2 * b2
                            nn *= 1.0 / ti.sqrt(ti.max(nn.norm_sqr(), 1e-12))
                            out = vec3(0)
                            key_light = 0.0
                            if material == GLASS:
                                out = glazed(base, ray, eye + ray * depth)
                            elif material == GLOW:
                                out = base * 2.0 + 0.2
                            else:
                                key_light = toned(nn.dot(sun), tones)
                                if ti.static(shadows):  # noqa: SIM102
                                    if key_light > 0:
                                        q = eye_l + (first_l + step_l * place) * depth
                                        nn_l = across(basis, nn)
                                        key_light *= lit_by_all(
                                            q, nn_l, ALL, m, each, frame, size, depth_map, coarse
                                        )
                                        if key_light > 0:
                                            key_light *= lit(
                                                q + lifted(nn_l, home_texel),
                                                h,
                                                home_frame,
                                                home_size,
                                                home_depth,
                                                home_coarse,
                                            )
                                        if key_light > 0:
                                            key_light *= lit(
                                                q + lifted(nn_l, set_texel),
                                                0,
                                                set_frame,
                                                set_size,
                                                set_depth,
                                                set_coarse,
                                            )
                                if key_light < 0.42:
                                    key_light = ti.max(key_light, 0.42 * toned(nn.dot(fill), tones))
                                ambient = under + (sky - under) * (nn.z * 0.5 + 0.5)
                                if ti.static(style.clay):
                                    around = eye + ray * depth + nn * 0.24
                                    ambient *= 1.0 - deep * area_near(
                                        around, corner, volume_low[3], nx, ny, nz, values
                                    )
                                out = base * (ambient + sun_color * (0.08 + 0.92 * key_light))
                                out += base * lamplight(eye + ray * depth, nn, lamps)
                            out += (horizon - out) * (
                                bounded((depth - CLEAR) * THICKENS, 0.0, 1.0) * HAZE_PEOPLE
                            )
                            if xx > before + 1 and ti.abs(key_light - key_before) > ABRUPT:
                                xx = before + 1
                            else:
                                there = exposed(out, film)
                                if xx > before:
                                    spread(
                                        paint,
                                        there,
                                        xx - before,
                                        mark,
                                        at + before - x,
                                        xx - before,
                                        picture,
                                        edge,
                                    )
                                mark = (mark & ti.u32(0xFFFF0000)) | pack_normal(nn)
                                paint = there
                                key_before = key_light
                                before = xx
                                more = xx < stop - 1 and not short
                                xx = ti.min(xx + gap, stop - 1)
                        if short:
                            before = x
                        c = packed(paint)
                        for i in range(at + before - x, at + stop - x):
                            picture[i] = c
                            edge[i] = mark
                    else:
                        if t != last:
                            last = t
                            joined = False
                            row = 2 * t * SHEET
                            plane = vec3(sheet[row + 12], sheet[row + 13], sheet[row + 14])
                            behind = plane.dot(eye) < sheet[row + 15]
                            if behind:
                                row += SHEET
                            facing = sheet[row + 3]
                            mark = ti.bit_cast(sheet[row + 7], ti.u32)
                            n0 = vec3(sheet[row], sheet[row + 1], sheet[row + 2])
                            ambient = vec3(sheet[row + 4], sheet[row + 5], sheet[row + 6])
                            direct = vec3(sheet[row + 8], sheet[row + 9], sheet[row + 10])
                            flags = ti.bit_cast(sheet[row + 11], ti.i32)
                            flat = (flags >> 8) & 1
                            shadow = flags >> SHADOW_SHIFT
                            if shadow == DARK:
                                facing = 0.0
                            material = flags & 255
                            n_l = across(basis, n0)
                            base = row3(color, t)
                            if not flat:
                                a, b, c = faces[t, 0], faces[t, 1], faces[t, 2]
                                p0 = row3(vertices, a)
                                q1 = row3(vertices, b) - p0
                                q2 = row3(vertices, c) - p0
                                n1 = row3(normals, b)
                                n2 = row3(normals, c)
                                if behind:
                                    n1, n2 = -n1, -n2
                                n1 -= n0
                                n2 -= n0
                                cross = q1.cross(q2)
                                inverse = 1.0 / ti.max(cross.norm_sqr(), 1e-20)
                                g1 = q2.cross(cross) * inverse
                                g2 = cross.cross(q1) * inverse
                                p0 -= eye
                        if material == GLASS or material == GLOW:  # noqa: SIM109
                            joined = False
                            base = row3(color, t)
                            for xx in range(x, stop):
                                i = at + xx - x
                                ray = first + step * ti.cast(xx, ti.f32)
                                depth = 1.0 / nearness(vis, i)
                                out = base * 2.0 + 0.2
                                if material == GLASS:
                                    out = glazed(base, ray, eye + ray * depth)
                                out += (horizon - out) * (
                                    bounded((depth - CLEAR) * THICKENS, 0.0, 1.0) * HAZE_SET
                                )
                                picture[i] = developed(out, film)
                                edge[i] = mark
                        else:
                            # a stretch of one triangle: look its two ends up; where the
                            # triangle goes on, the end is the first pixel of the next stretch
                            goes_on = stop < width and triangle(vis, at + stop - x) == t
                            end = stop if goes_on else stop - 1
                            middle, lone = x, False
                            if end - x < fine and not goes_on and not (x > 0 and triangle(vis, at - 1) == t):
                                middle, end, lone = (x + end) // 2, x, True  # a few pixels have one light
                            begin_at = end_at
                            if joined:
                                shade, tone, haze, kind = shade_end, tone_end, haze_end, kind_end
                                lamp = lamp_end
                            q_begin, cell = q_end, cell_end
                            for k in range(2):
                                if (k == 0 and not joined) or (k == 1 and end > x):
                                    xx = middle if k == 0 else end
                                    depth = 1.0 / nearness(vis, at + xx - x)
                                    end_at = eye + (first + step * ti.cast(xx, ti.f32)) * depth
                                    if ti.static(occlusion):
                                        shade_end = sheltered(
                                            end_at,
                                            n0,
                                            m,
                                            corner,
                                            volume_low[3],
                                            nx,
                                            ny,
                                            nz,
                                            values,
                                            floor,
                                            tops,
                                            columns,
                                            rows,
                                            ground,
                                            deep,
                                        )
                                    nn = n0
                                    if not flat:
                                        d = end_at - eye - p0
                                        nn += n1 * bounded(d.dot(g1), 0.0, 1.0) + n2 * bounded(
                                            d.dot(g2), 0.0, 1.0
                                        )
                                        nn *= 1.0 / ti.sqrt(ti.max(nn.norm_sqr(), 1e-12))
                                    lamp_end = base * lamplight(end_at, nn, lamps)
                                    tone_end = broad_pattern(material, end_at, n0, lattice)
                                    if ti.static(shadows):  # noqa: SIM102
                                        if facing > 0:
                                            q_end = eye_l + (first_l + step_l * ti.cast(xx, ti.f32)) * depth
                                            kind_end = shadow
                                            if shadow == MIXED and flat:
                                                cell_end = cell_at(t, end_at, plot, side[t])
                                                kind_end = chart[
                                                    begin[t] + cell_end[1] * side[t] + cell_end[0]
                                                ]
                                    haze_end = bounded((depth - CLEAR) * (THICKENS * HAZE_SET), 0.0, HAZE_SET)
                                    if k == 0:
                                        begin_at = end_at
                                        q_begin, cell = q_end, cell_end
                                        shade, tone, haze, kind = shade_end, tone_end, haze_end, kind_end
                                        lamp = lamp_end
                            # whether nothing that moves, and nothing of the set, can be in the light
                            dim, home_clear, own_clear = 0, True, True
                            key = facing
                            if ti.static(shadows):  # noqa: SIM102
                                if facing > 0:
                                    # one kind of cell all the way?
                                    between = kind
                                    if kind != kind_end:
                                        between = MIXED
                                    elif shadow == MIXED and kind != MIXED:
                                        between = kind_along(
                                            t, begin_at, end_at, cell, cell_end, plot, begin, side[t], chart
                                        )
                                    if between == DARK:
                                        key = 0.0
                                    else:
                                        own_clear = between == LIT
                                        dim = dimming(q_begin, q_end, n_l, m, each, frame, size, coarse)
                                        off = lifted(n_l, home_texel)
                                        home_clear = free_between(
                                            q_begin + off, q_end + off, h, home_frame, home_size, home_coarse
                                        )
                            if flat and dim == 0 and home_clear and own_clear:
                                start = paint_end
                                if not (joined and painted):
                                    start = exposed(
                                        quiet(ambient + lamp, direct, key, shade, tone, haze, horizon), film
                                    )
                                paint_end = start
                                if end > x:
                                    paint_end = exposed(
                                        quiet(
                                            ambient + lamp_end,
                                            direct,
                                            key,
                                            shade_end,
                                            tone_end,
                                            haze_end,
                                            horizon,
                                        ),
                                        film,
                                    )
                                spread(start, paint_end, end - x, mark, at, stop - x, picture, edge)
                                painted = True
                            else:
                                painted = False
                                share = 1.0 / ti.cast(ti.max(end - x, 1), ti.f32)
                                step_shade = (shade_end - shade) * share
                                step_tone = (tone_end - tone) * share
                                step_haze = (haze_end - haze) * share
                                step_lamp = (lamp_end - lamp) * share
                                xx = middle
                                before = middle
                                same = x
                                gap = spaced(stop - x, fine)
                                paint = ti.Vector([0, 0, 0])
                                key_before = 0.0
                                more = True
                                while more:
                                    i = at + xx - x
                                    ray = first + step * ti.cast(xx, ti.f32)
                                    depth = 1.0 / nearness(vis, i)
                                    nn = n0
                                    nn_l = n_l
                                    key_light = facing
                                    if not flat:
                                        d = ray * depth - p0
                                        b1 = bounded(d.dot(g1), 0.0, 1.0)
                                        b2 = bounded(d.dot(g2), 0.0, 1.0)
                                        nn = n0 + n1 * b1 + n2 * b2
                                        nn *= 1.0 / ti.sqrt(ti.max(nn.norm_sqr(), 1e-12))
                                        key_light = toned(nn.dot(sun), tones) if shadow != DARK else 0.0
                                        ambient = base * (under + (sky - under) * (nn.z * 0.5 + 0.5))
                                        if ti.static(shadows):
                                            nn_l = across(basis, nn)
                                    if ti.static(shadows):  # noqa: SIM102
                                        if key_light > 0 and not (dim == 0 and home_clear and own_clear):
                                            q = eye_l + (first_l + step_l * ti.cast(xx, ti.f32)) * depth
                                            if dim != 0:
                                                key_light *= lit_by_all(
                                                    q, nn_l, dim, m, each, frame, size, depth_map, coarse
                                                )
                                            if key_light > 0 and not home_clear:
                                                key_light *= lit(
                                                    q + lifted(nn_l, home_texel),
                                                    h,
                                                    home_frame,
                                                    home_size,
                                                    home_depth,
                                                    home_coarse,
                                                )
                                            if key_light > 0 and not own_clear:
                                                key_light *= lit(
                                                    q + lifted(nn_l, set_texel),
                                                    0,
                                                    set_frame,
                                                    set_size,
                                                    set_depth,
                                                    set_coarse,
                                                )
                                    if flat and key_light == key_before and x < xx < stop - 1 and not lone:
                                        same = xx
                                        xx = ti.min(xx + gap, stop - 1)
                                    else:
                                        if same > before:
                                            along = ti.cast(same - x, ti.f32)
                                            there = exposed(
                                                quiet(
                                                    ambient + lamp + step_lamp * along,
                                                    direct,
                                                    key_before,
                                                    shade + step_shade * along,
                                                    tone + step_tone * along,
                                                    haze + step_haze * along,
                                                    horizon,
                                                ),
                                                film,
                                            )
                                            steps = same - before
                                            spread(
                                                paint,
                                                there,
                                                steps,
                                                mark,
                                                at + before - x,
                                                steps,
                                                picture,
                                                edge,
                                            )
                                            paint = there
                                            before = same
                                        if xx > before + 1 and ti.abs(key_light - key_before) > ABRUPT:
                                            # the edge of a shadow: pixel by pixel
                                            xx = before + 1
                                        else:
                                            along = ti.cast(xx - x, ti.f32)
                                            there = exposed(
                                                quiet(
                                                    ambient + lamp + step_lamp * along,
                                                    direct,
                                                    key_light,
                                                    shade + step_shade * along,
                                                    tone + step_tone * along,
                                                    haze + step_haze * along,
                                                    horizon,
                                                ),
                                                film,
                                            )
                                            if xx > before:
                                                steps = xx - before
                                                spread(
                                                    paint,
                                                    there,
                                                    steps,
                                                    mark,
                                                    at + before - x,
                                                    steps,
                                                    picture,
                                                    edge,
                                                )
                                            paint = there
                                            if not flat:
                                                mark = (mark & ti.u32(0xFFFF0000)) | pack_normal(nn)
                                            key_before = key_light
                                            before = xx
                                            more = xx < stop - 1 and not lone
                                            xx = ti.min(xx + gap, stop - 1)
                                c = packed(paint)
                                for i in range(at if lone else at + before - x, at + stop - x):
                                    picture[i] = c
                                    edge[i] = mark
                            joined = goes_on
                    x = stop

    @ti.func
    def spaced(count, most):
        """How far apart the pixels are that are looked up of ``count``, about ``most``, evenly."""
        steps = ti.max((count - 1) // most, 1)
        return (count - 1 + steps - 1) // steps

    @ti.func
    def quiet(ambient, direct, key_light, shade, tone, haze, horizon):
        """Light of a point of the set."""
        out = (ambient * shade + direct * (0.3 + 0.7 * key_light * (0.7 + 0.3 * shade))) * tone
        return out + (horizon - out) * haze

    return SimpleNamespace(rows=shade_rows, fold=fold_kernel(style), survey=survey, RUN=RUN, SHEET=SHEET)
