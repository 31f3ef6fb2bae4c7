"""Shading: every pixel of a visibility buffer to a colour, and to what the ink lines are drawn from.

Work in linear light, encode to sRGB at the end. ``edge`` keeps, per pixel, the surface in its high
half and the normal (octahedral, 8 + 8 bits) in its low half; 0xFFFF0000 is the backdrop.
"""

from functools import lru_cache
from types import SimpleNamespace

import taichi as ti

from ..types import Style
from .geometry import f1, f2, f3, i1, i2, item3, part3, row3, u32s, u64s, vec3

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
def soft_step(x, at, width):
    t = ti.min(ti.max((x - at) / width + 0.5, 0.0), 1.0)
    return t * t * (3.0 - 2.0 * t)


@lru_cache(maxsize=8)
def shading_kernels(style: Style) -> SimpleNamespace:
    """The shading kernel of a style."""
    tones = style.tones

    @ti.func
    def toned(x):
        """Light 0..1 in soft steps."""
        out = ti.max(x, 0.0)
        if ti.static(tones == 2):
            out = soft_step(x, 0.22, 0.08)
        elif ti.static(tones >= 3):
            out = 0.0
            for k in ti.static(range(tones - 1)):
                out += soft_step(x, 0.08 + 0.5 * k / (tones - 2), 0.07 + 0.05 * k)
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
        table: u32s,
        vis: u64s,
        picture: u32s,
        edge: u32s,
        views: ti.i32,
        width: ti.i32,
        height: ti.i32,
    ):
        """light: sun 3, sun colour 3, sky 3, ground 3, horizon 3, zenith 3 (linear)"""
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
            sky = vec3(light[6], light[7], light[8])
            ground = vec3(light[9], light[10], light[11])
            horizon = vec3(light[12], light[13], light[14])
            zenith = vec3(light[15], light[16], light[17])
            last = -1
            p0, g1, g2 = vec3(0), vec3(0), vec3(0)
            n0, n1, n2 = vec3(0), vec3(0), vec3(0)
            base = vec3(0)
            surface = ti.u32(0)
            flat = False
            moves = False
            for x in range(width):
                at = line * width + x
                key = vis[at]
                ray = first + step * ti.cast(x, ti.f32)
                out = vec3(0)
                mark = ti.u32(NOTHING)
                if key == 0:
                    up = ray.z / ray.norm()
                    out = horizon + (zenith - horizon) * ti.min(ti.max(up * 1.6, 0.0), 1.0)
                else:
                    t = ti.cast(ti.cast(key, ti.u32), ti.i32) - 1
                    depth = 1.0 / ti.bit_cast(ti.cast(key >> 32, ti.u32), ti.f32)
                    if t != last:
                        last = t
                        a, b, c = faces[t, 0], faces[t, 1], faces[t, 2]
                        moves = t >= static_faces
                        q1, q2 = vec3(0), vec3(0)
                        if moves:
                            p0 = item3(position, m, a - static_vertices)
                            q1 = item3(position, m, b - static_vertices) - p0
                            q2 = item3(position, m, c - static_vertices) - p0
                            n0 = item3(normal, m, a - static_vertices)
                            n1 = item3(normal, m, b - static_vertices) - n0
                            n2 = item3(normal, m, c - static_vertices) - n0
                        else:
                            p0 = row3(vertices, a)
                            q1 = row3(vertices, b) - p0
                            q2 = row3(vertices, c) - p0
                            n0 = row3(normals, a)
                            n1 = row3(normals, b) - n0
                            n2 = row3(normals, c) - n0
                        cross = q1.cross(q2)
                        inverse = 1.0 / ti.max(cross.norm_sqr(), 1e-20)
                        g1 = q2.cross(cross) * inverse
                        g2 = cross.cross(q1) * inverse
                        # seen from behind: turn the normal to the eye
                        if cross.dot(p0 - eye) > 0:
                            n0, n1, n2 = -n0, -n1, -n2
                        base = row3(color, t)
                        surface = ti.cast(info[t, 0], ti.u32) << 16
                        flat = (info[t, 1] >> 8) & 1
                    where = eye + ray * depth
                    nn = n0
                    if not flat:
                        d = where - p0
                        b1 = ti.min(ti.max(d.dot(g1), 0.0), 1.0)
                        b2 = ti.min(ti.max(d.dot(g2), 0.0), 1.0)
                        nn = (n0 + n1 * b1 + n2 * b2).normalized(1e-12)
                    lit = toned(nn.dot(sun))
                    out = base * (ground + (sky - ground) * (nn.z * 0.5 + 0.5) + sun_color * lit)
                    mark = surface | pack_normal(nn)
                picture[at] = encode(out, table)
                edge[at] = mark

    return SimpleNamespace(rows=shade_rows)
