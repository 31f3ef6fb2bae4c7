"""Shading: every pixel of a visibility buffer to a colour, and to what the ink lines are drawn from.

Work in linear light, encode to sRGB at the end. ``edge`` keeps, per pixel, the surface in its high
half and the normal (octahedral, 8 + 8 bits) in its low half; 0xFFFF0000 is the backdrop.
"""

# mypy: ignore-errors
# Taichi reads annotations as kernel types and parses the bodies itself.

from functools import lru_cache
from types import SimpleNamespace

import taichi as ti

from ..film import FILM_RANGE, FILM_SIZE
from ..types import Style
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
    u16s,
    u32s,
    u64s,
    vec3,
)
from .light import BLOCK, above_floor, across, lit, unblocked
from .pattern import broad_pattern, glazed, grained, pattern

NOTHING = 0xFFFF0000
RUN = 16  # pixels; rows are worked through in aligned runs of them
ABRUPT = 0.05  # difference of key light over a few pixels, above which each is looked up
SHEET = 16  # numbers kept for each side of a triangle of the set


@ti.func
def pack_normal(n):
    """Octahedral encoding in 8 + 8 bits (Cigolle et al. 2014)."""
    s = 1.0 / ti.max(ti.abs(n.x) + ti.abs(n.y) + ti.abs(n.z), 1e-12)
    x = n.x * s
    y = n.y * s
    if n.z < 0:
        ox = (1.0 - ti.abs(y)) * (1.0 if x >= 0 else -1.0)
        y = (1.0 - ti.abs(x)) * (1.0 if y >= 0 else -1.0)
        x = ox
    qx = ti.cast((x * 0.5 + 0.5) * 254.0 + 0.5, ti.u32)
    qy = ti.cast((y * 0.5 + 0.5) * 254.0 + 0.5, ti.u32)
    return (qx << 8) | qy


@ti.func
def unpack_normal(bits):
    x = ti.cast((bits >> 8) & 0xFF, ti.f32) * (2.0 / 254.0) - 1.0
    y = ti.cast(bits & 0xFF, ti.f32) * (2.0 / 254.0) - 1.0
    z = 1.0 - ti.abs(x) - ti.abs(y)
    if z < 0:
        ox = (1.0 - ti.abs(y)) * (1.0 if x >= 0 else -1.0)
        y = (1.0 - ti.abs(x)) * (1.0 if y >= 0 else -1.0)
        x = ox
    return vec3(x, y, z).normalized()


@ti.func
def encode(light, table: ti.template()):
    """Linear 0..1 to packed 8-bit sRGB and luma, through the table of 4096."""
    r = ti.cast(ti.min(ti.max(light.x, 0.0), 1.0) * 4095.0 + 0.5, ti.i32)
    g = ti.cast(ti.min(ti.max(light.y, 0.0), 1.0) * 4095.0 + 0.5, ti.i32)
    b = ti.cast(ti.min(ti.max(light.z, 0.0), 1.0) * 4095.0 + 0.5, ti.i32)
    r8, g8, b8 = table[r], table[g], table[b]
    return r8 | (g8 << 8) | (b8 << 16) | (((r8 * 5 + g8 * 9 + b8 * 2) >> 4) << 24)


@ti.func
def exposed(light, film: ti.template()):
    """Scene light to sRGB in 256ths of a step, halves added for rounding: red, green, blue."""
    limit = ti.static(FILM_RANGE)
    scale = ti.static((FILM_SIZE - 1) / FILM_RANGE)
    return ti.Vector(
        [
            ti.cast(film[ti.cast(bounded(light.x, 0.0, limit) * scale + 0.5, ti.i32)], ti.i32),
            ti.cast(film[ti.cast(bounded(light.y, 0.0, limit) * scale + 0.5, ti.i32)], ti.i32),
            ti.cast(film[ti.cast(bounded(light.z, 0.0, limit) * scale + 0.5, ti.i32)], ti.i32),
        ]
    )


@ti.func
def packed(paint):
    """Colours of :func:`exposed` to packed 8-bit sRGB and luma."""
    c = paint >> 8
    luma = (c.x * 5 + c.y * 9 + c.z * 2) >> 4
    return ti.cast(c.x | (c.y << 8) | (c.z << 16) | (luma << 24), ti.u32)


@ti.func
def developed(light, film: ti.template()):
    """Scene light to packed 8-bit sRGB and luma, through the film's table."""
    return packed(exposed(light, film))


@ti.func
def spread(begin, end, steps, mark, at, count, picture: ti.template(), edge: ti.template()):
    """Fill ``count`` pixels with colours evenly between two (of :func:`exposed`), ``steps`` pixels apart.

    Two colours go into one number, 8.8 bits each, so that one addition moves both.
    """
    luma = (begin.x * 5 + begin.y * 9 + begin.z * 2) >> 4
    outer = ti.cast(begin.x | (begin.z << 16), ti.u32)
    inner = ti.cast(begin.y | (luma << 16), ti.u32)
    outer_step = 0
    inner_step = 0
    if steps > 1:
        luma_end = (end.x * 5 + end.y * 9 + end.z * 2) >> 4
        share = 1.0 / ti.cast(steps, ti.f32)
        outer_step = part_of(end.x - begin.x, share) + (part_of(end.z - begin.z, share) << 16)
        inner_step = part_of(end.y - begin.y, share) + (part_of(luma_end - luma, share) << 16)
    for i in range(at, at + count):
        picture[i] = ((outer >> 8) & ti.u32(0x00FF00FF)) | (inner & ti.u32(0xFF00FF00))
        edge[i] = mark
        outer += ti.cast(outer_step, ti.u32)
        inner += ti.cast(inner_step, ti.u32)


@ti.func
def part_of(whole, share):
    return ti.cast(ti.cast(whole, ti.f32) * share, ti.i32)


@ti.func
def soft_step(x, at, steepness):
    t = bounded((x - at) * steepness + 0.5, 0.0, 1.0)
    return t * t * (3.0 - 2.0 * t)


@ti.func
def area_near(p, low, inverse, nx, ny, nz, values: ti.template()):
    """Trilinear sample of the occlusion volume: the light kept off, 0 outside."""
    x, y, z = (p.x - low.x) * inverse, (p.y - low.y) * inverse, (p.z - low.z) * inverse
    out = 0.0
    if 0 <= x < nx - 1 and 0 <= y < ny - 1 and 0 <= z < nz - 1:
        i, j, k = ti.cast(x, ti.i32), ti.cast(y, ti.i32), ti.cast(z, ti.i32)
        x -= i
        y -= j
        z -= k
        at = (i * ny + j) * nz + k
        a = values[at] + (values[at + 1] - values[at]) * z
        b = values[at + nz] + (values[at + nz + 1] - values[at + nz]) * z
        at += ny * nz
        c = values[at] + (values[at + 1] - values[at]) * z
        d = values[at + nz] + (values[at + nz + 1] - values[at + nz]) * z
        a += (b - a) * y
        c += (d - c) * y
        out = a + (c - a) * x
    return out


@ti.func
def standing_near(p, m, floor: ti.template(), columns, rows, ground: ti.template()):
    """Bilinear sample of what stands on the floor."""
    x = (p.x - floor[0]) * floor[2] - 0.5
    y = (p.y - floor[1]) * floor[2] - 0.5
    out = 0.0
    if 0 <= x < columns - 1 and 0 <= y < rows - 1:
        i, j = ti.cast(x, ti.i32), ti.cast(y, ti.i32)
        x -= i
        y -= j
        at = m * rows * columns + j * columns + i
        a = ground[at] + (ground[at + 1] - ground[at]) * x
        b = ground[at + columns] + (ground[at + columns + 1] - ground[at + columns]) * x
        out = a + (b - a) * y
    return out


@lru_cache(maxsize=8)
def shading_kernels(style: Style) -> SimpleNamespace:
    """The shading kernel of a style."""
    tones = style.tones
    shadows = style.shadows
    occlusion = style.occlusion

    @ti.func
    def toned(x):
        """Light 0..1 in soft steps."""
        out = ti.max(x, 0.0)
        if ti.static(tones == 2):
            out = soft_step(x, 0.22, 12.5)
        elif ti.static(tones >= 3):
            out = 0.0
            for k in ti.static(range(tones - 1)):
                out += soft_step(x, 0.10 + 0.42 * k / (tones - 2), ti.static(1.0 / (0.06 + 0.05 * k)))
            out *= ti.static(1.0 / (tones - 1))
        return out

    @ti.kernel
    def fold(
        vertices: f2,
        normals: f2,
        faces: i2,
        color: f2,
        info: i2,
        light: f1,
        count: ti.i32,
        sheet: f1,
    ):
        """What shading needs of the first ``count`` triangles (the set), seen from the front and from behind.

        sheet, SHEET numbers a triangle and side: normal 3, light from the key, colour under the ambient
        light 3, mark of the edge buffer (bits), colour under the full key 3, material | flags (bits),
        plane 4: unit normal, and its offset
        """
        for i in range(2 * count):
            t = i // 2
            p = row3(vertices, faces[t, 0])
            cross = (row3(vertices, faces[t, 1]) - p).cross(row3(vertices, faces[t, 2]) - p)
            plane = cross / ti.max(cross.norm(), 1e-20)
            n = row3(normals, faces[t, 0]) * (1.0 - 2.0 * (i % 2))
            base = row3(color, t)
            sky = vec3(light[6], light[7], light[8])
            under = vec3(light[9], light[10], light[11])
            ambient = base * (under + (sky - under) * (n.z * 0.5 + 0.5))
            direct = base * vec3(light[3], light[4], light[5])
            mark = (ti.cast(info[t, 0], ti.u32) << 16) | pack_normal(n)
            at = i * SHEET
            for a in ti.static(range(3)):
                sheet[at + a] = n[a]
                sheet[at + 4 + a] = ambient[a]
                sheet[at + 8 + a] = direct[a]
                sheet[at + 12 + a] = plane[a]
            sheet[at + 3] = toned(n.dot(vec3(light[0], light[1], light[2])))
            sheet[at + 7] = ti.bit_cast(mark, ti.f32)
            sheet[at + 11] = ti.bit_cast(info[t, 1], ti.f32)
            sheet[at + 15] = plane.dot(p)

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
        nx: ti.i32,
        ny: ti.i32,
        nz: ti.i32,
        volume_low: f1,
        values: f1,
        floor: f1,
        columns: ti.i32,
        rows: ti.i32,
        ground: f1,
        film: u16s,
        vis: u64s,
        picture: u32s,
        edge: u32s,
        solid: i1,
        views: ti.i32,
        width: ti.i32,
        height: ti.i32,
    ):
        """light: sun 3, sun colour 3, sky 3, ground 3, horizon 3, zenith 3 (scene light)

        solid: the triangle + 1 of the set that fills each RUN of pixels alone, 0 for none,
        -1 for the backdrop
        """
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
            sun = vec3(light[0], light[1], light[2])
            sun_color = vec3(light[3], light[4], light[5])
            # people get a weaker light from over the camera's left shoulder, so that a back-lit face has form
            fill = (part3(view, n, 6) * 0.6 - part3(view, n, 3) * 0.62 - part3(view, n, 9) * 0.5).normalized()
            sky = vec3(light[6], light[7], light[8])
            under = vec3(light[9], light[10], light[11])
            horizon = vec3(light[12], light[13], light[14])
            zenith = vec3(light[15], light[16], light[17])
            corner = vec3(volume_low[0], volume_low[1], volume_low[2])
            # the row in light coordinates, and how far points are lifted off their surface for each map
            eye_l, first_l, step_l = across(basis, eye), across(basis, first), across(basis, step)
            texel, set_texel = 1.0 / frame[m, 2], 1.0 / set_frame[0, 2]
            lift, set_lift = 0.01 + 1.8 * texel, 0.01 + 1.8 * set_texel
            rise, set_rise = 0.004 + 0.4 * texel, 0.004 + 0.4 * set_texel
            open_reach = 1.5 * BLOCK * ti.min(texel, set_texel)
            last = -1
            p0, g1, g2 = vec3(0), vec3(0), vec3(0)
            n0, n1, n2 = vec3(0), vec3(0), vec3(0)
            n_l = vec3(0)
            base, ambient, direct = vec3(0), vec3(0), vec3(0)
            facing = 0.0
            mark = ti.u32(NOTHING)
            flat = True
            material = 0
            slant = 0.0
            # light along a stretch of one triangle of the set: its ends are looked up, the rest lies between
            shade, shade_end = 1.0, 1.0
            tone, tone_end = 1.0, 1.0
            haze, haze_end = 0.0, 0.0
            free, free_end = False, False
            end_at = vec3(0)
            joined = False
            painted = False
            paint_end = ti.Vector([0, 0, 0])
            stretch = RUN if height > 400 else RUN // 2
            fine = 4 if height > 400 else 2
            whole = False
            x = 0
            while x < width:
                at = line * width + x
                t = triangle(vis, at)
                if x % RUN == 0:
                    mixed = ti.u32(0)
                    for i in range(at + 1, at + ti.min(RUN, width - x)):
                        mixed |= ti.cast(vis[i], ti.u32) ^ ti.cast(t + 1, ti.u32)
                    whole = mixed == 0
                    value = 0
                    if whole and t < static_faces:
                        value = t + 1 if t >= 0 else -1
                    solid[line * ((width + RUN - 1) // RUN) + x // RUN] = value
                stop = x + 1
                limit = ti.min(width, (x // stretch + 1) * stretch)
                if whole:
                    stop = limit
                else:
                    while stop < limit and triangle(vis, at + stop - x) == t:
                        stop += 1
                if t < 0:
                    last = -1
                    joined = False
                    begin = backdrop(first + step * ti.cast(x, ti.f32), horizon, zenith, film)
                    end = backdrop(first + step * ti.cast(stop - 1, ti.f32), horizon, zenith, film)
                    spread(begin, end, stop - 1 - x, ti.u32(NOTHING), at, stop - x, picture, edge)
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
                    # every few pixels are shaded, the rest lie between
                    xx = x
                    before = x
                    paint = ti.Vector([0, 0, 0])
                    key_before = 0.0
                    more = True
                    while more:
                        i = at + xx - x
                        ray = first + step * ti.cast(xx, ti.f32)
                        depth = 1.0 / nearness(vis, i)
                        d = ray * depth - p0
                        b1 = bounded(d.dot(g1), 0.0, 1.0)
                        b2 = bounded(d.dot(g2), 0.0, 1.0)
                        nn = n0 + n1 * b1 + n2 * b2
                        nn *= 1.0 / ti.sqrt(ti.max(nn.norm_sqr(), 1e-12))
                        out = vec3(0)
                        key_light = 0.0
                        if material == 7:
                            out = glazed(base, ray, eye + ray * depth)
                        elif material == 8:
                            out = base * 2.0 + 0.2
                        else:
                            key_light = toned(nn.dot(sun))
                            if ti.static(shadows):  # noqa: SIM102
                                if key_light > 0:
                                    q = eye_l + (first_l + step_l * ti.cast(xx, ti.f32)) * depth
                                    nn_l = across(basis, nn)
                                    key_light *= lit(
                                        q + nn_l * lift + vec3(0, 0, rise), m, frame, size, depth_map, coarse
                                    )
                                    if key_light > 0:
                                        key_light *= lit(
                                            q + nn_l * set_lift + vec3(0, 0, set_rise),
                                            0,
                                            set_frame,
                                            set_size,
                                            set_depth,
                                            set_coarse,
                                        )
                            if key_light < 0.42:
                                key_light = ti.max(key_light, 0.42 * toned(nn.dot(fill)))
                            ambient = under + (sky - under) * (nn.z * 0.5 + 0.5)
                            out = base * (ambient + sun_color * (0.08 + 0.92 * key_light))
                        out += (horizon - out) * (bounded((depth - 2.0) * 0.04, 0.0, 1.0) * 0.15)
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
                            more = xx < stop - 1
                            xx = ti.min(xx + fine, stop - 1)
                    picture[at + before - x] = packed(paint)
                    edge[at + before - x] = mark
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
                        kind = ti.bit_cast(sheet[row + 11], ti.i32)
                        flat = (kind >> 8) & 1
                        material = kind & 255
                        n_l = across(basis, n0)
                        if not flat:
                            base = row3(color, t)
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
                        if grained(material):
                            # a pixel's width on the surface at 1 m, tamed at grazing angles
                            ray = first + step * ti.cast(x, ti.f32)
                            cosine = ti.abs(plane.dot(ray)) / ray.norm()
                            slant = 1.0 / (ti.max(ti.sqrt(cosine), 0.15) * view[n, 13])
                    if material == 7 or material == 8:
                        joined = False
                        base = row3(color, t)
                        for xx in range(x, stop):
                            i = at + xx - x
                            ray = first + step * ti.cast(xx, ti.f32)
                            depth = 1.0 / nearness(vis, i)
                            out = base * 2.0 + 0.2
                            if material == 7:
                                out = glazed(base, ray, eye + ray * depth)
                            out += (horizon - out) * (bounded((depth - 2.0) * 0.04, 0.0, 1.0) * 0.36)
                            picture[i] = developed(out, film)
                            edge[i] = mark
                    else:
                        # a stretch of one triangle: look its two ends up, the rest lies between; where the
                        # triangle goes on, the end is the first pixel of the next stretch
                        goes_on = stop < width and triangle(vis, at + stop - x) == t
                        end = stop if goes_on else stop - 1
                        if end == x + 1 and not goes_on:
                            end = x  # two pixels have one light
                        begin_at = end_at
                        if joined:
                            shade, tone, haze, free = shade_end, tone_end, haze_end, free_end
                        for k in range(2):
                            if (k == 0 and not joined) or (k == 1 and end > x):
                                xx = x if k == 0 else end
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
                                        columns,
                                        rows,
                                        ground,
                                    )
                                tone_end = broad_pattern(material, end_at, n0)
                                if ti.static(shadows):
                                    q = eye_l + (first_l + step_l * ti.cast(xx, ti.f32)) * depth
                                    free_end = unblocked(
                                        q + n_l * lift + vec3(0, 0, rise), m, frame, size, coarse
                                    ) and unblocked(
                                        q + n_l * set_lift + vec3(0, 0, set_rise),
                                        0,
                                        set_frame,
                                        set_size,
                                        set_coarse,
                                    )
                                haze_end = bounded((depth - 2.0) * 0.0144, 0.0, 0.36)
                                if k == 0:
                                    begin_at = end_at
                                    shade, tone, haze, free = shade_end, tone_end, haze_end, free_end
                        clear = True
                        if ti.static(shadows):
                            clear = facing == 0 or (
                                free and free_end and (end_at - begin_at).norm() < open_reach
                            )
                        if flat and clear and not grained(material):
                            begin = paint_end
                            if not (joined and painted):
                                begin = exposed(
                                    quiet(ambient, direct, facing, shade, tone, haze, horizon), film
                                )
                            paint_end = begin
                            if end > x:
                                paint_end = exposed(
                                    quiet(ambient, direct, facing, shade_end, tone_end, haze_end, horizon),
                                    film,
                                )
                            spread(begin, paint_end, end - x, mark, at, stop - x, picture, edge)
                            painted = True
                        else:
                            painted = False
                            share = 1.0 / ti.cast(ti.max(end - x, 1), ti.f32)
                            step_shade = (shade_end - shade) * share
                            step_tone = (tone_end - tone) * share
                            step_haze = (haze_end - haze) * share
                            rough = grained(material)
                            xx = x
                            before = x
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
                                    key_light = toned(nn.dot(sun))
                                    ambient = base * (under + (sky - under) * (nn.z * 0.5 + 0.5))
                                    if ti.static(shadows):
                                        nn_l = across(basis, nn)
                                if ti.static(shadows):  # noqa: SIM102
                                    if key_light > 0 and not clear:
                                        q = eye_l + (first_l + step_l * ti.cast(xx, ti.f32)) * depth
                                        key_light *= lit(
                                            q + nn_l * lift + vec3(0, 0, rise),
                                            m,
                                            frame,
                                            size,
                                            depth_map,
                                            coarse,
                                        )
                                        if key_light > 0:
                                            key_light *= lit(
                                                q + nn_l * set_lift + vec3(0, 0, set_rise),
                                                0,
                                                set_frame,
                                                set_size,
                                                set_depth,
                                                set_coarse,
                                            )
                                if xx > before + 1 and ti.abs(key_light - key_before) > ABRUPT:
                                    # the edge of a shadow: pixel by pixel
                                    xx = before + 1
                                else:
                                    if rough:
                                        # the pixels after the last one looked up, this one included
                                        key_step = 0.0
                                        begin = xx
                                        if xx > before:
                                            begin = before + 1
                                            key_step = (key_light - key_before) / ti.cast(xx - before, ti.f32)
                                        for j in range(begin, xx + 1):
                                            along = first + step * ti.cast(j, ti.f32)
                                            z = 1.0 / ti.bit_cast(
                                                ti.cast(vis[at + j - x] >> 32, ti.u32), ti.f32
                                            )
                                            strong = tone * pattern(material, eye + along * z, nn, z * slant)
                                            out = quiet(
                                                ambient,
                                                direct,
                                                key_light - key_step * ti.cast(xx - j, ti.f32),
                                                shade,
                                                strong,
                                                haze,
                                                horizon,
                                            )
                                            shade += step_shade
                                            haze += step_haze
                                            picture[at + j - x] = developed(out, film)
                                            edge[at + j - x] = mark
                                    else:
                                        along = ti.cast(xx - x, ti.f32)
                                        there = exposed(
                                            quiet(
                                                ambient,
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
                                        paint = there
                                    if not flat:
                                        mark = (mark & ti.u32(0xFFFF0000)) | pack_normal(nn)
                                    key_before = key_light
                                    before = xx
                                    more = xx < stop - 1
                                    xx = ti.min(xx + fine, stop - 1)
                            if not rough:
                                picture[at + before - x] = packed(paint)
                                edge[at + before - x] = mark
                        joined = goes_on
                x = stop

    @ti.func
    def quiet(ambient, direct, key_light, shade, tone, haze, horizon):
        """Light of a point of the set."""
        out = (ambient * shade + direct * (0.3 + 0.7 * key_light * (0.7 + 0.3 * shade))) * tone
        return out + (horizon - out) * haze

    @ti.func
    def backdrop(ray, horizon, zenith, film: ti.template()):
        up = ray.z / ray.norm()
        return exposed(horizon + (zenith - horizon) * ti.min(ti.max(up * 1.6, 0.0), 1.0), film)

    @ti.func
    def sheltered(
        where,
        nn,
        m,
        corner,
        inverse,
        nx,
        ny,
        nz,
        values: ti.template(),
        floor: ti.template(),
        columns,
        rows,
        ground: ti.template(),
    ):
        """Share of the ambient light that reaches a point of the set."""
        out = 1.0 - area_near(where + nn * 0.24, corner, inverse, nx, ny, nz, values)
        if nn.z > 0.7 and above_floor(where.z, floor) < 0.2:
            out *= 1.0 - 0.5 * (1.0 - ti.exp(-1.6 * standing_near(where, m, floor, columns, rows, ground)))
        return out

    return SimpleNamespace(rows=shade_rows, fold=fold, RUN=RUN, SHEET=SHEET)
