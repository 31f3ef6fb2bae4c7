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
from .geometry import bounded, f1, f2, f3, i1, i2, item3, part3, row3, u8s, u32s, u64s, vec3
from .light import BLOCK, lit, offset_point, unblocked
from .pattern import broad_pattern, glazed, pattern

NOTHING = 0xFFFF0000


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
def developed(light, film: ti.template()):
    """Scene light to packed 8-bit sRGB and luma, through the film's table."""
    limit = ti.static(FILM_RANGE)
    scale = ti.static((FILM_SIZE - 1) / FILM_RANGE)
    r8 = ti.cast(film[ti.cast(bounded(light.x, 0.0, limit) * scale + 0.5, ti.i32)], ti.u32)
    g8 = ti.cast(film[ti.cast(bounded(light.y, 0.0, limit) * scale + 0.5, ti.i32)], ti.u32)
    b8 = ti.cast(film[ti.cast(bounded(light.z, 0.0, limit) * scale + 0.5, ti.i32)], ti.u32)
    return r8 | (g8 << 8) | (b8 << 16) | (((r8 * 5 + g8 * 9 + b8 * 2) >> 4) << 24)


@ti.func
def soft_step(x, at, width):
    t = bounded((x - at) / width + 0.5, 0.0, 1.0)
    return t * t * (3.0 - 2.0 * t)


@ti.func
def area_near(p, low, inverse, nx, ny, nz, values: ti.template()):
    """Trilinear sample of the occlusion volume, 0 outside."""
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
            out = soft_step(x, 0.22, 0.08)
        elif ti.static(tones >= 3):
            out = 0.0
            for k in ti.static(range(tones - 1)):
                out += soft_step(x, 0.10 + 0.42 * k / (tones - 2), 0.06 + 0.05 * k)
            out /= tones - 1
        return out

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
        film: u8s,
        vis: u64s,
        picture: u32s,
        edge: u32s,
        views: ti.i32,
        width: ti.i32,
        height: ti.i32,
    ):
        """light: sun 3, sun colour 3, sky 3, ground 3, horizon 3, zenith 3 (scene light)"""
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
            last = -1
            p0, g1, g2 = vec3(0), vec3(0), vec3(0)
            n0, n1, n2 = vec3(0), vec3(0), vec3(0)
            base, ambient = vec3(0), vec3(0)
            facing = 0.0
            mark = ti.u32(NOTHING)
            flat = False
            moves = False
            material = 0
            slant = 0.0
            # light along a stretch of one triangle of the set: its ends are looked up, the rest lies between
            shade, shade_end = 1.0, 1.0
            tone, tone_end = 1.0, 1.0
            haze, haze_end = 0.0, 0.0
            free, free_end = False, False
            end_at = vec3(0)
            joined = False
            stretch = 16 if height > 400 else 8
            x = 0
            while x < width:
                at = line * width + x
                key = vis[at]
                stop = x + 1
                if key == 0:
                    last = -1
                    joined = False
                    ray = first + step * ti.cast(x, ti.f32)
                    up = ray.z / ray.norm()
                    picture[at] = developed(
                        horizon + (zenith - horizon) * ti.min(ti.max(up * 1.6, 0.0), 1.0), film
                    )
                    edge[at] = ti.u32(NOTHING)
                else:
                    t = ti.cast(ti.cast(key, ti.u32), ti.i32) - 1
                    if t != last:
                        last = t
                        joined = False
                        a, b, c = faces[t, 0], faces[t, 1], faces[t, 2]
                        flat = (info[t, 1] >> 8) & 1
                        material = info[t, 1] & 255
                        base = row3(color, t)
                        moves = t >= static_faces
                        q1, q2 = vec3(0), vec3(0)
                        if moves:
                            p0 = item3(position, m, a - static_vertices)
                            q1 = item3(position, m, b - static_vertices) - p0
                            q2 = item3(position, m, c - static_vertices) - p0
                            n0 = item3(normal, m, a - static_vertices)
                            if not flat:
                                n1 = item3(normal, m, b - static_vertices) - n0
                                n2 = item3(normal, m, c - static_vertices) - n0
                        else:
                            p0 = row3(vertices, a)
                            q1 = row3(vertices, b) - p0
                            q2 = row3(vertices, c) - p0
                            n0 = row3(normals, a)
                            if not flat:
                                n1 = row3(normals, b) - n0
                                n2 = row3(normals, c) - n0
                        cross = q1.cross(q2)
                        # seen from behind: turn the normal to the eye
                        if cross.dot(p0 - eye) > 0:
                            n0, n1, n2 = -n0, -n1, -n2
                        if not flat:
                            inverse = 1.0 / ti.max(cross.norm_sqr(), 1e-20)
                            g1 = q2.cross(cross) * inverse
                            g2 = cross.cross(q1) * inverse
                        facing = toned(n0.dot(sun))
                        ambient = under + (sky - under) * (n0.z * 0.5 + 0.5)
                        mark = (ti.cast(info[t, 0], ti.u32) << 16) | pack_normal(n0)
                        if material != 0 and not moves:
                            # a pixel's width on the surface at 1 m, tamed at grazing angles
                            ray = first + step * ti.cast(x, ti.f32)
                            cosine = ti.abs(cross.dot(ray)) / ti.max(ray.norm() * cross.norm(), 1e-12)
                            slant = 1.0 / (ti.max(ti.sqrt(cosine), 0.15) * view[n, 13])
                    clear = moves or not shadows
                    step_shade, step_tone = 0.0, 0.0
                    step_light = vec3(0)
                    light_now = vec3(0)
                    even = False
                    if not moves and material != 7 and material != 8:
                        # a stretch of one triangle: look its two ends up, the rest lies between
                        end = x
                        last_x = ti.min(width - 1, x + stretch)
                        while end < last_x and ti.cast(vis[at + end - x + 1], ti.u32) == ti.cast(key, ti.u32):
                            end += 1
                        begin_at = vec3(0)
                        if joined:
                            shade, tone, free = shade_end, tone_end, free_end
                            begin_at = end_at
                        scale = 0.0
                        for k in range(2):
                            if (k == 0 and not joined) or (k == 1 and end > x):
                                xx = x if k == 0 else end
                                depth = 1.0 / ti.bit_cast(ti.cast(vis[at + xx - x] >> 32, ti.u32), ti.f32)
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
                                    q = offset_point(basis, end_at, n0, m, frame)
                                    q_set = offset_point(basis, end_at, n0, 0, set_frame)
                                    free_end = unblocked(q, m, frame, size, coarse) and unblocked(
                                        q_set, 0, set_frame, set_size, set_coarse
                                    )
                                haze_end = bounded((depth - 2.0) * 0.0144, 0.0, 0.36)
                                if k == 0:
                                    begin_at = end_at
                                    shade, tone, free = shade_end, tone_end, free_end
                                    haze = haze_end
                        joined = end > x
                        if joined:
                            stop = end
                            scale = 1.0 / ti.cast(end - x, ti.f32)
                            step_shade = (shade_end - shade) * scale
                            step_tone = (tone_end - tone) * scale
                        reach = (end_at - begin_at).norm()
                        if ti.static(shadows):
                            clear = facing == 0 or (
                                free
                                and (free_end or not joined)
                                and reach * ti.max(frame[m, 2], set_frame[0, 2]) < BLOCK
                            )
                        even = flat and clear and (material == 0 or material >= 10)
                        if even:
                            fill_light = 0.3 + 0.7 * facing * (0.7 + 0.3 * shade)
                            light_now = base * (ambient * shade + sun_color * fill_light) * tone
                            light_now += (horizon - light_now) * haze
                            if joined:
                                fill_light = 0.3 + 0.7 * facing * (0.7 + 0.3 * shade_end)
                                there = base * (ambient * shade_end + sun_color * fill_light) * tone_end
                                there += (horizon - there) * haze_end
                                step_light = (there - light_now) * scale
                        haze = haze_end
                    if even:
                        for i in range(at, at + stop - x):
                            picture[i] = developed(light_now, film)
                            edge[i] = mark
                            light_now += step_light
                    else:
                        for xx in range(x, stop):
                            i = at + xx - x
                            ray = first + step * ti.cast(xx, ti.f32)
                            depth = 1.0 / ti.bit_cast(ti.cast(vis[i] >> 32, ti.u32), ti.f32)
                            where = eye + ray * depth
                            nn = n0
                            if not flat:
                                d = where - p0
                                b1 = bounded(d.dot(g1), 0.0, 1.0)
                                b2 = bounded(d.dot(g2), 0.0, 1.0)
                                nn = n0 + n1 * b1 + n2 * b2
                                nn *= 1.0 / ti.sqrt(ti.max(nn.norm_sqr(), 1e-12))
                                mark = (mark & ti.u32(0xFFFF0000)) | pack_normal(nn)
                                facing = toned(nn.dot(sun))
                                ambient = under + (sky - under) * (nn.z * 0.5 + 0.5)
                            out = vec3(0)
                            if material == 7:
                                out = glazed(base, ray, where)
                            elif material == 8:
                                out = base * 2.0 + 0.2
                            else:
                                key_light = facing
                                if ti.static(shadows):  # noqa: SIM102
                                    if key_light > 0 and (moves or not clear):
                                        q = offset_point(basis, where, nn, m, frame)
                                        key_light *= lit(q, m, frame, size, depth_map, coarse)
                                        q = offset_point(basis, where, nn, 0, set_frame)
                                        key_light *= lit(q, 0, set_frame, set_size, set_depth, set_coarse)
                                albedo = base
                                if moves:
                                    key_light = ti.max(key_light, 0.42 * toned(nn.dot(fill)))
                                    out = albedo * (ambient + sun_color * (0.08 + 0.92 * key_light))
                                else:
                                    if material != 0:
                                        albedo *= tone * pattern(material, where, nn, depth * slant)
                                    key_light = 0.3 + 0.7 * key_light * (0.7 + 0.3 * shade)
                                    out = albedo * (ambient * shade + sun_color * key_light)
                                    shade += step_shade
                                    tone += step_tone
                            far = bounded((depth - 2.0) * 0.04, 0.0, 1.0)
                            far *= 0.15 if moves else 0.36
                            out += (horizon - out) * far
                            picture[i] = developed(out, film)
                            edge[i] = mark
                x = stop

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
        near = area_near(where + nn * 0.24, corner, inverse, nx, ny, nz, values)
        out = 1.0 - 0.27 * (1.0 - ti.exp(-1.3 * ti.max(near - 0.38, 0.0)))
        if nn.z > 0.7 and where.z < 0.2:
            out *= 1.0 - 0.5 * (1.0 - ti.exp(-1.6 * standing_near(where, m, floor, columns, rows, ground)))
        return out

    return SimpleNamespace(rows=shade_rows)
